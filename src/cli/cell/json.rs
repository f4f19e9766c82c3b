//! The answer about a cell as JSON.

use super::Answered;
use crate::model::Outcome;
use crate::space::Configuration;
use cplan_cell::{Cell, CellArm, Coordination, HandoverTimes, Proof, Refutation, StepTimes};
use serde_json::{Value, json};

impl Answered<'_> {
    /// Returns the answer.
    pub fn json(&self) -> Value {
        let Self { args, cell, plan, .. } = self;
        let found = plan.outcome.found();
        let arms: Vec<Value> = cell.arms.iter().enumerate().map(|(k, arm)| self.arm(k, arm, found)).collect();
        let mut answer = json!({
            "status": plan.status().name(),
            "name": cell.name,
            "arms": arms,
            "duration": found.map(|found| found.duration),
            "lower_bound": plan.lower_bound,
            "gap": found.zip(plan.lower_bound).filter(|(_, bound)| *bound > 0.0).map(|(found, bound)| found.duration / bound - 1.0),
            "skew": args.skew,
            "clearance": cell.arms[0].problem.scene().workspace().clearance,
            "clearance_between": found.map(|found| finite(found.clearance)),
            "nearest": found.and_then(|found| found.nearest).map(|place| json!({ "times": place.times, "distance": place.distance })),
            "interlocks": found.map(|found| self.interlocks(found)),
            "interpolation": "cubic",
            "handovers": found.map(|found| found.handovers.iter().map(|times| handover(cell, times)).collect::<Vec<_>>()),
            "assignment": plan.assignment.as_ref().map(|names| assignment(cell, names)),
            "tried": plan.tried,
        });
        match &plan.outcome {
            Outcome::Found(_) => {}
            Outcome::Infeasible(proof) => answer["proof"] = self.proof(proof),
            Outcome::Unknown(why) => answer["reason"] = json!(why),
        }
        answer
    }

    fn arm(&self, k: usize, CellArm { name, problem, .. }: &CellArm, found: Option<&Coordination>) -> Value {
        let alone = self.plan.alone[k].as_ref().filter(|alone| alone.duration.is_some());
        let alone = alone.map(|alone| json!({ "duration": alone.duration, "lower_bound": alone.lower_bound }));
        let mut arm = json!({
            "name": name,
            "robot": problem.scene().arm().name,
            "joints": problem.scene().arm().joints.each_ref().map(|joint| joint.name.as_str()),
            "start": row(problem.query().start()),
            "alone": alone,
        });
        if let Some(found) = found {
            let motion = &found.motions[k];
            let trajectory = &motion.trajectory;
            arm["clearance"] = json!(finite(motion.curve.clearance()));
            arm["path"] =
                json!(motion.curve.straight().path().waypoints().iter().copied().map(row).collect::<Vec<_>>());
            arm["waits"] = json!(found.waits[k]);
            if self.cell.has_steps() {
                arm["steps"] = json!(found.steps[k].iter().map(step).collect::<Vec<_>>());
            }
            arm["trajectory"] = json!({
                "time": trajectory.time,
                "position": trajectory.position,
                "velocity": trajectory.velocity,
            });
        }
        arm
    }

    fn interlocks(&self, found: &Coordination) -> Value {
        let named = |arm: usize| &self.cell.arms[arm].name;
        let place = |arm: usize, time: f64, signal: usize| {
            let mut place = json!({ "time": time, "position": row(found.place(arm, time)) });
            if let Some(programs) = self.programs {
                place["target"] = json!(programs.target(signal, arm));
            }
            place
        };
        let interlocks = found.interlocks.as_ref().map(|interlocks| {
            let one = |(number, interlock): (usize, &cplan_cell::Interlock)| {
                let sets = 1 - interlock.waits;
                json!({
                    "signal": number + 1,
                    "waits": named(interlock.waits),
                    "at": place(interlock.waits, interlock.at, number + 1),
                    "sets": named(sets),
                    "after": place(sets, interlock.set, number + 1),
                })
            };
            interlocks.iter().enumerate().map(one).collect::<Vec<_>>()
        });
        json!(interlocks)
    }

    fn proof(&self, refutation: &Refutation) -> Value {
        match refutation {
            Refutation::Step { arm, failed } => json!({
                "kind": "step",
                "arm": self.cell.arms[*arm].name,
                "step": failed.step.number,
                "place": failed.step.place,
                "reasons": failed.reasons,
            }),
            Refutation::Starts { contact, parts: None } => json!({ "kind": "starts", "contact": contact }),
            _ => json!(Proof::of(refutation, self.cell)),
        }
    }
}

/// Returns for each arm the objects that it moves, of those that either arm may move.
pub fn assignment(cell: &Cell, names: &[Vec<String>; 2]) -> Value {
    let one = |(arm, names): (&CellArm, &Vec<String>)| (arm.name.clone(), json!(names));
    Value::Object(cell.arms.iter().zip(names).map(one).collect())
}

/// Returns a handover with its times.
pub fn handover(cell: &Cell, HandoverTimes { object, giver, placed, taken }: &HandoverTimes) -> Value {
    let [gives, takes] = [*giver, 1 - giver].map(|arm| &cell.arms[arm].name);
    json!({ "object": object, "gives": gives, "placed": placed, "takes": takes, "taken": taken })
}

/// Returns a step with its times.
pub fn step(step: &StepTimes) -> Value {
    let [before, after] = step.lowered;
    json!({
        "step": step.number,
        "file_step": step.file_step,
        "cycle": step.cycle,
        "action": step.action,
        "object": step.object,
        "raising": step.raising.zip(before).map(|(begin, lowered)| json!({ "begin": begin, "lowered": lowered })),
        "begin": step.begin,
        "arrival": step.arrival,
        "turn": step.turn.map(|turn| json!({ "from": turn.from, "to": turn.to, "seconds": turn.seconds })),
        "stroke": after.map(|lowered| json!({ "lowered": lowered })),
        "wrist": step.wrist.map(|wrist| {
            json!({ "from": wrist.from, "to": wrist.to, "begin": wrist.begin, "seconds": wrist.seconds })
        }),
        "event": step.event,
        "end": step.end,
    })
}

fn row(q: Configuration) -> [f64; 2] {
    [q[0], q[1]]
}

/// Returns a distance. `None` if no links can meet.
fn finite(distance: f64) -> Option<f64> {
    Some(distance).filter(|distance| distance.is_finite())
}
