//! What is known of the orders in which a group can be done.

use super::super::legs::{Blockers, Refusal};

/// One pair before another in the order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Before(pub usize, pub usize);

/// A condition that an order has to meet: all of one of the alternatives.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Condition {
    alternatives: Vec<Vec<Before>>,
}

impl Condition {
    /// Of these alternatives; none if one of them asks for nothing.
    pub fn of(alternatives: impl IntoIterator<Item = Vec<Before>>) -> Option<Self> {
        let mut all: Vec<Vec<Before>> = Vec::new();
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

    /// What has to be otherwise so that `pair` can be done: after exactly the pairs that are `done`, it could not, for these
    /// reasons. `pair_of` says which pair moves an obstacle.
    ///
    /// What bars the way in one IK solution, or from one place, need not do so from another: it is learned, not proven. Where
    /// nothing is learned from a reason, the pair is to come sooner or later than just here.
    pub fn learned(pair: usize, done: &[bool], refusals: &[Refusal], pair_of: impl Fn(usize) -> Option<usize>) -> Self {
        let elsewhere = |other: usize| if done[other] { Before(pair, other) } else { Before(other, pair) };
        let mut alternatives = Vec::new();
        for refusal in refusals {
            match &refusal.blockers {
                // All of them have to be gone; what no other pair moves stays.
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

    /// Whether an order meets it, by the place of each pair in it.
    pub fn holds(&self, places: &[usize]) -> bool {
        self.alternatives.iter().any(|all| all.iter().all(|Before(first, then)| places[*first] < places[*then]))
    }

    /// The pairs that it is about.
    pub fn pairs(&self) -> impl Iterator<Item = usize> + '_ {
        self.alternatives.iter().flatten().flat_map(|&Before(first, then)| [first, then])
    }
}
