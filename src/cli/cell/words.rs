//! The answer about a cell in words.

use super::Answered;
use crate::model::Outcome;
use crate::motion::Wait;
use crate::output::format_columns;
use crate::text::{counted, fixed, length_down, percent};
use cplan_cell::{CellArm, Coordination, HandoverTimes, Interlock, Refutation, StepTimes};

/// Greatest number of interlocks and attempts in the summary.
const MAX_SHOWN: usize = 8;

impl Answered<'_> {
    /// Returns the summary.
    pub fn summary(&self) -> String {
        format!("{}\n{}", self.cell.name, format_columns(&self.facts()))
    }

    /// Returns the facts: the result, figures of the motions or attempts, and notes.
    pub fn facts(&self) -> Vec<(&'static str, String)> {
        let Self { args, cell, plan, .. } = self;
        let mut lines = vec![("result", self.result())];
        if let Some(found) = plan.outcome.found() {
            lines.push(("cycle", self.cycle(found)));
            let between = match found.clearance {
                clearance if clearance.is_finite() => format!("at least {}", length_down(clearance)),
                _ => "no links can meet".into(),
            };
            let clocks = if args.skew > 0.0 {
                format!(", for clocks that differ by up to {} s", args.skew)
            } else {
                String::new()
            };
            lines.push(("between", format!("{between}{clocks}")));
            for (arm, names) in cell.arms.iter().zip(plan.assignment.iter().flatten()) {
                lines.push((
                    "objects",
                    format!("{}: {}", arm.name, if names.is_empty() { "none".into() } else { names.join(", ") }),
                ));
            }
            for (arm, steps) in cell.arms.iter().zip(&found.steps) {
                lines.extend(steps.iter().map(|step| ("step", format!("{} {}", arm.name, done(step)))));
            }
            lines.extend(found.handovers.iter().map(|handover| ("handover", self.handover(handover))));
            for (arm, waits) in cell.arms.iter().zip(&found.waits) {
                lines.extend(waits.iter().map(|wait| ("wait", format!("{} {}", arm.name, waiting(arm, wait)))));
            }
            match &found.interlocks {
                None => {
                    lines.push(("signals", "cplan found no signals that make the motions safe for every skew".into()))
                }
                Some(interlocks) if interlocks.is_empty() => {
                    lines.push(("signals", "none needed: the motions are safe for every skew".into()));
                }
                Some(interlocks) => {
                    let shown = interlocks.iter().take(MAX_SHOWN).enumerate();
                    lines.extend(shown.map(|(k, interlock)| ("signal", self.interlock(k + 1, interlock, found))));
                }
            }
        } else {
            lines.extend(plan.tried.iter().take(MAX_SHOWN).map(|tried| ("tried", tried.clone())));
        }
        lines.extend(self.programs.iter().flat_map(|programs| programs.lines(cell)));
        let [one, two] = cell
            .arms
            .each_ref()
            .map(|arm| arm.problem.robot().notes.iter().chain(arm.problem.notes()).collect::<Vec<_>>());
        let of_both = |note: &&String| one.contains(note) && two.contains(note);
        lines.extend(one.iter().filter(|note| of_both(note)).map(|note| ("note", format!("both arms: {note}"))));
        for (arm, notes) in cell.arms.iter().zip([&one, &two]) {
            let own = notes.iter().filter(|note| !of_both(note));
            lines.extend(own.map(|note| ("note", format!("{}: {note}", arm.name))));
        }
        lines
    }

    /// Returns the answer in one line.
    fn result(&self) -> String {
        let names = self.cell.arms.each_ref().map(|arm| arm.name.as_str());
        match &self.plan.outcome {
            Outcome::Found(_) => "found: both motions are certified, among the obstacles and between the arms".into(),
            Outcome::Infeasible(proof) => match proof {
                Refutation::Alone { arm, .. } => {
                    format!(
                        "infeasible: {} cannot reach its goal, even without {}; proven",
                        names[*arm],
                        names[1 - *arm]
                    )
                }
                Refutation::Step { arm, failed } => format!(
                    "infeasible: {} cannot do step {} ({}), even without {}; proven",
                    names[*arm],
                    failed.step.number,
                    failed.step.place,
                    names[1 - *arm]
                ),
                Refutation::Starts { contact, .. } => {
                    format!("infeasible: the arms cannot be at their starts together: {contact}; proven")
                }
                Refutation::Goals { contact, .. } => {
                    format!("infeasible: the arms collide at every pair of goals, for example {contact}; proven")
                }
                Refutation::Boxes(proof) => {
                    let count = counted(proof.boxes.len(), "box");
                    format!(
                        "infeasible: the arms cannot both reach their goals without a collision; proven with {count} of colliding configurations in the space of all four joints"
                    )
                }
            },
            Outcome::Unknown(why) => format!("unknown: {why}"),
        }
    }

    fn cycle(&self, found: &Coordination) -> String {
        let bound = self.plan.lower_bound.filter(|bound| *bound > 0.0);
        let bound = bound.map_or(String::new(), |bound| {
            format!(", at most {} above the least possible", percent((found.duration / bound - 1.0).max(0.0)))
        });
        format!("{:.3} s{bound}", found.duration)
    }

    fn handover(&self, HandoverTimes { object, giver, placed, taken }: &HandoverTimes) -> String {
        let [gives, takes] = [*giver, 1 - giver].map(|arm| &self.cell.arms[arm].name);
        format!("\"{object}\": {gives} has placed it at {placed:.3} s, {takes} takes it from {taken:.3} s on")
    }

    fn interlock(&self, number: usize, interlock: &Interlock, found: &Coordination) -> String {
        let (waits, sets) = (interlock.waits, 1 - interlock.waits);
        let name = |arm: usize| &self.cell.arms[arm].name;
        let place = |arm: usize, time: f64| {
            let q = found.place(arm, time);
            let target = self.programs.map(|programs| format!(", target {}", programs.target(number, arm)));
            format!("{}, {time:.3} s{}", joints(&self.cell.arms[arm], q.into()), target.unwrap_or_default())
        };
        format!(
            "{} waits for signal {number} at {}; {} sets it after {}",
            name(waits),
            place(waits, interlock.at),
            name(sets),
            place(sets, interlock.set)
        )
    }
}

/// Describes a step.
fn done(StepTimes { number, action, begin, end, .. }: &StepTimes) -> String {
    format!("{number}: {action}, from {begin:.3} s to {end:.3} s")
}

fn waiting(arm: &CellArm, Wait { from, to, at }: &Wait) -> String {
    let place = if *from == 0.0 { "at its start".into() } else { format!("at {}", joints(arm, *at)) };
    format!("{place} from {from:.3} s to {to:.3} s")
}

/// Formats joint values: `(0.300, 1.200) rad`, `(0.300 m, 1.200 rad)`.
fn joints(arm: &CellArm, q: [f64; 2]) -> String {
    let [a, b] = q.map(|value| fixed(value, 3));
    match arm.problem.scene().arm().joints.each_ref().map(|joint| joint.unit()) {
        [first, second] if first == second => format!("({a}, {b}) {first}"),
        [first, second] => format!("({a} {first}, {b} {second})"),
    }
}
