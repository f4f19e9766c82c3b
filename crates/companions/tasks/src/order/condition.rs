//! Conditions on the orders in which a group can be done.

use super::super::refusal::{Blockers, Refusal};

/// A requirement on an order: the first pair comes before the second.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Precedence(pub usize, pub usize);

/// A condition on orders, made of alternatives. An order satisfies it if it satisfies all requirements of at least one
/// alternative.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Condition {
    alternatives: Vec<Vec<Precedence>>,
}

impl Condition {
    /// Creates a condition from alternatives. `None` if one of them requires nothing, so that every order satisfies it.
    pub fn of(alternatives: impl IntoIterator<Item = Vec<Precedence>>) -> Option<Self> {
        let mut all: Vec<Vec<Precedence>> = Vec::new();
        for mut alternative in alternatives {
            alternative.sort_unstable();
            alternative.dedup();
            if alternative.is_empty() {
                return None;
            }
            if !all.contains(&alternative) {
                all.push(alternative);
            }
        }
        all.sort();
        Some(Self { alternatives: all })
    }

    /// Derives a condition from the reasons why `pair` could not be done after exactly the pairs that are `done`.
    /// `pair_of` returns the pair that moves an obstacle.
    ///
    /// Such a condition is not proven. An obstacle that blocks the path to one IK solution, or from one place, may not
    /// block others. If the reasons name no obstacle of another pair, the condition is only that the pair comes earlier
    /// or later in the order.
    pub fn from_refusals(
        pair: usize,
        done: &[bool],
        refusals: &[Refusal],
        pair_of: impl Fn(usize) -> Option<usize>,
    ) -> Self {
        let elsewhere = |other: usize| if done[other] { Precedence(pair, other) } else { Precedence(other, pair) };
        let mut alternatives = Vec::new();
        for refusal in refusals {
            match &refusal.blockers {
                // All of these obstacles must be elsewhere. Those that no other pair moves remain.
                Blockers::AtEnd(blockers) => {
                    let others: Option<Vec<usize>> =
                        blockers.iter().map(|&blocker| pair_of(blocker).filter(|&other| other != pair)).collect();
                    alternatives.extend(others.map(|others| others.into_iter().map(elsewhere).collect::<Vec<_>>()));
                }
                Blockers::OnTheWay(blockers) => {
                    let others = blockers.iter().filter_map(|&blocker| pair_of(blocker)).filter(|&other| other != pair);
                    alternatives.extend(others.map(|other| vec![elsewhere(other)]));
                }
                Blockers::Unknown => {}
            }
        }
        alternatives.retain(|alternative| !alternative.is_empty());
        if alternatives.is_empty() {
            alternatives = (0..done.len()).filter(|&other| other != pair).map(|other| vec![elsewhere(other)]).collect();
        }
        Self::of(alternatives).unwrap_or(Self { alternatives: Vec::new() })
    }

    /// Returns true if an order satisfies the condition. `places` has the position of each pair in the order.
    pub fn holds(&self, places: &[usize]) -> bool {
        self.alternatives.iter().any(|all| all.iter().all(|Precedence(first, then)| places[*first] < places[*then]))
    }

    /// Returns the pairs that the condition involves.
    pub fn pairs(&self) -> impl Iterator<Item = usize> + '_ {
        self.alternatives.iter().flatten().flat_map(|&Precedence(first, then)| [first, then])
    }
}
