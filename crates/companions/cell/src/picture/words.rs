//! The answer in a sentence, and its key figures.

use super::Answer;
use super::motions::{ShownMotions, met, pairs_of_links};
use crate::{Coordination, Refutation};
use cplan_model::Outcome;
use cplan_text::{counted, length_down, percent};

/// Least total wait, seconds, that the sentence states.
const MIN_STATED_WAIT: f64 = 0.005;

/// Clearance, metres, below which no machine keeps two arms apart.
const TIGHT_CLEARANCE: f64 = 1e-3;

/// A key figure: name, value, meaning, and `warning` or nothing.
pub type Card = [String; 4];

impl Answer<'_> {
    /// Returns the answer in one sentence, with the waits.
    pub fn headline(&self) -> String {
        [self.sentence()].into_iter().chain(self.waits_in_words()).collect::<Vec<_>>().join("; ")
    }

    /// Returns the answer in one sentence.
    pub fn sentence(&self) -> String {
        let names = self.names();
        match &self.plan.outcome {
            Outcome::Found(found) => {
                let proven = match self.gap(found) {
                    Some(gap) => format!("proven within {} of the least time", percent(gap)),
                    None => "certified".to_owned(),
                };
                let done = if found.steps.iter().all(Vec::is_empty) { "arrive" } else { "finish their steps" };
                format!("Both arms {done} after {:.3} s, {proven}", found.duration)
            }
            Outcome::Infeasible(Refutation::Alone { arm, .. }) => {
                format!("No motions: {} cannot reach its goal, even without {}", names[*arm], names[1 - *arm])
            }
            Outcome::Infeasible(Refutation::Step { arm, failed }) => {
                format!(
                    "No motions: {} cannot do step {}, even without {}",
                    names[*arm],
                    failed.step.number,
                    names[1 - *arm]
                )
            }
            Outcome::Infeasible(Refutation::Starts { contact, .. }) => {
                format!("No motions: at the starts, {}", contact.replace('"', ""))
            }
            Outcome::Infeasible(Refutation::Goals { .. }) => {
                "No motions: the arms collide at every pair of goals".to_owned()
            }
            Outcome::Infeasible(Refutation::Boxes(_)) => {
                "No motions: on every route to their goals, the arms collide".to_owned()
            }
            Outcome::Unknown(why) => format!("Not known: {why}"),
        }
    }

    /// Returns the proven upper bound on how much longer the cycle is than the least possible one, as a fraction.
    fn gap(&self, found: &Coordination) -> Option<f64> {
        let bound = self.plan.lower_bound.filter(|bound| *bound > 0.0)?;
        Some((found.duration / bound - 1.0).max(0.0))
    }

    /// States which arm waits for which, and for how long: `right waits 0.20 s for left`. Empty without motions.
    pub fn waits_in_words(&self) -> Vec<String> {
        let names = self.names();
        let Outcome::Found(found) = &self.plan.outcome else { return Vec::new() };
        let total = |arm: usize| found.waits[arm].iter().map(|wait| wait.to - wait.from).sum::<f64>();
        let waiting = (0..2).filter(|arm| total(*arm) >= MIN_STATED_WAIT);
        waiting.map(|arm| format!("{} waits {:.2} s for {}", names[arm], total(arm), names[1 - arm])).collect()
    }

    /// Returns the key figures.
    pub fn cards(&self) -> Vec<Card> {
        let Outcome::Found(found) = &self.plan.outcome else { return self.cards_without_motions() };
        let mut cards = vec![card("cycle", format!("{:.3} s", found.duration), "until both arms are at their goals")];
        if let Some((gap, bound)) = self.gap(found).zip(self.plan.lower_bound) {
            let bound = (1e3 * bound).floor() / 1e3;
            let note = format!("proven: no motions of both take less than {bound:.3} s");
            cards.push(card("over the least time", format!("at most {}", percent(gap)), &note));
        }
        let kept = match found.clearance {
            distance if distance.is_finite() => format!("at least {}", length_down(distance)),
            _ => "any distance".to_owned(),
        };
        let is_required = self.scenes()[0].workspace().clearance > 0.0;
        cards.push(match found.clearance {
            distance if distance < TIGHT_CLEARANCE && !is_required => {
                let [name, value, note, _] =
                    card("between the arms", kept, "because none was required; --clearance requires more");
                [name, value, note, "warning".to_owned()]
            }
            distance if distance.is_finite() => card("between the arms", kept, "proven, for clocks within the skew"),
            _ => card("between the arms", kept, "no links of both can meet"),
        });
        cards.push(card("skew", format!("{} ms", (1e3 * self.skew).round()), "by which the two clocks may differ"));
        let (value, note) = match &found.interlocks {
            None => ("none found".to_owned(), "the motions are safe for clocks within the skew"),
            Some(signals) if signals.is_empty() => ("none".to_owned(), "needed: the motions are safe for all clocks"),
            Some(signals) => (signals.len().to_string(), "make the motions safe for all clocks"),
        };
        cards.push(card("signals", value, note));
        cards
    }

    fn cards_without_motions(&self) -> Vec<Card> {
        let names = self.names();
        let (mut cards, pairs) = (Vec::new(), pairs_of_links(self.cell));
        let between = pairs.between([0, 0]);
        match &self.plan.outcome {
            Outcome::Infeasible(Refutation::Boxes(proof)) => {
                let note = "of colliding configurations, in the space of all four joints";
                cards.push(card("proof", counted(proof.boxes.len(), "box"), note));
            }
            Outcome::Infeasible(Refutation::Starts { .. }) => {
                if let Some((distance, pair)) = met(between, self.starts()) {
                    let what = between.describe(pair, names).replace('"', "");
                    let (name, value) = match distance {
                        depth if depth <= 0.0 => ("overlap", length_down(-depth)),
                        _ => ("distance", length_down(distance)),
                    };
                    cards.push(card(name, value, &format!("at the starts: {what}")));
                }
            }
            _ => {}
        }
        if let Some((time, pair)) = ShownMotions::of(self, &pairs).and_then(|motions| motions.first_contact(between)) {
            let what = between.describe(pair, names).replace('"', "");
            let note = format!("{what}, if both take their fastest paths at once");
            cards.push(card("first collision", format!("at {time:.3} s"), &note));
        }
        for (arm, alone) in self.plan.alone.iter().enumerate() {
            if let Some(duration) = alone.as_ref().and_then(|alone| alone.duration) {
                let note = format!("its fastest motion without {}", names[1 - arm]);
                cards.push(card(&format!("{} alone", names[arm]), format!("{duration:.3} s"), &note));
            }
        }
        cards
    }
}

fn card(name: &str, value: String, note: &str) -> Card {
    [name.to_owned(), value, note.to_owned(), String::new()]
}
