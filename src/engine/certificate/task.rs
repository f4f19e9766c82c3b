//! Evidence for a task: besides the motion which part of it does which step, and how the wrist turns what is carried. Where all objects
//! are then follows from the world.

use super::contacts::Contacts;
use super::{Evidence, Stuck, lines, stuck_about, tells_apart};
use crate::check::StuckBox;
use crate::engine::task::{RefutedCase, StepReport, refuted};
use crate::engine::{Options, Verdict, solve};
use crate::geometry::{Convex, Point, Vector};
use crate::model::{MotionProblem, RecordedStep, Scene, Task};
use crate::space::{Configuration, Segment};
use serde_json::{Value, json};
use std::iter;

/// The steps of a planned task, whose motion is among the results.
pub(super) fn steps(steps: &[StepReport]) -> (&'static str, String) {
    let step = |step: &StepReport| {
        let turn = step.turn.as_ref().map(|turn| turn.to - turn.from);
        done(step.step, [step.first_sample, step.last_sample].map(Option::unwrap_or_default), turn)
    };
    ("steps", lines(&steps.iter().map(step).collect::<Vec<_>>()))
}

/// The steps of a recorded task.
pub(super) fn steps_of_recording(steps: &[RecordedStep]) -> (&'static str, String) {
    let step = |step: &RecordedStep| {
        let knots = [*step.samples.start(), *step.samples.end()];
        done(step.number, knots, step.turn.map(|turn| turn.to - turn.from))
    };
    ("steps", lines(&steps.iter().map(step).collect::<Vec<_>>()))
}

fn done(step: usize, knots: [usize; 2], turn: Option<f64>) -> Value {
    match turn {
        None => json!({ "step": step, "knots": knots }),
        Some(turn) => json!({ "step": step, "knots": knots, "turn": turn }),
    }
}

/// By which share objects are taken for smaller than they are, so that evidence has room for rounding of how they lie and hang.
const SMALLER: f64 = 1e-6;

/// IK solutions that a checker finds less well, by [`tells_apart`], have none: it looks at 2 000 parts.
const NEARLY_STRETCHED: f64 = 0.005;

/// What [`tells_apart`] is at the most.
const MOST_TOLD: f64 = 0.25;

/// Half the sides of the rectangles that hold IK solutions where the joints move the tip across each other, as shares of the joints' ranges. A
/// checker finds them to a part in 10^12, ...
const ABOUT_IK_SOLUTIONS: f64 = 1e-10;

/// ... and less well those where something is let go of that was taken in one of these rectangles.
const AFTER_ANOTHER: f64 = 1e-8;

/// ... and where something is picked again that was turned then.
const AFTER_TURNING: f64 = 1e-6;

/// That the steps up to one cannot be done, case by case; none where the proof is of a kind that the checker does not know.
pub(super) fn cases(task: &Task, last: usize) -> Option<Evidence> {
    let mut smaller = task.clone();
    smaller.objects.iter_mut().flat_map(|object| &mut object.pieces).for_each(|piece| *piece = shrunk(piece));
    let (empty, arm) = (Scene::trusted(task.arm.clone(), task.workspace.clone()), &task.arm);
    let told_of = |case: &RefutedCase| case.from.map_or(MOST_TOLD, |q| tells_apart(arm, q));
    let are_told = |cases: &[RefutedCase]| cases.iter().all(|case| told_of(case) >= NEARLY_STRETCHED);
    let cases = refuted(&smaller, last, &mut rule_out, &are_told)?;
    // Where something is let go of is known as well as where it was taken.
    let carrying = cases.iter().filter(|case| case.scene.payload().is_some());
    let taken = MOST_TOLD / carrying.map(told_of).fold(MOST_TOLD, f64::min);
    let mut contacts = Contacts::new(&empty);
    let mut all = Vec::new();
    for case in &cases {
        let RefutedCase { step, after, from, turned, scene, stuck, lowered } = case;
        let share = match (scene.payload(), turned.is_empty()) {
            (Some(_), true) => ABOUT_IK_SOLUTIONS,
            // Where it is picked depends on how it lies.
            (Some(_), false) => AFTER_TURNING * taken,
            (None, _) => AFTER_ANOTHER * taken,
        };
        let told = told_of(case);
        let ranges = arm.topology().ranges.map(|range| range.domain());
        let about = |q: Configuration, share: f64| {
            [0, 1].map(|k| {
                let room = share * (ranges[k].1 - ranges[k].0);
                [q[k] - room, q[k] + room]
            })
        };
        let from = from.map(|q| about(q, share * MOST_TOLD / told));
        // As these were when something was carried from and to them.
        let shares = [ABOUT_IK_SOLUTIONS, AFTER_ANOTHER * taken];
        let ends = |ends: &[Configuration; 2]| {
            [0, 1].map(|k| about(ends[k], shares[k] * MOST_TOLD / tells_apart(arm, ends[k])))
        };
        let turned: Vec<_> = turned.iter().map(ends).collect();
        let mut case = json!({ "step": step });
        let lowered =
            lowered.iter().filter(|(_, stuck)| !stuck.is_empty()).map(|(scene, stuck)| ("lowered", scene, stuck));
        for (name, scene, stuck) in iter::once(("boxes", scene, stuck)).chain(lowered) {
            contacts = contacts.among(scene);
            let boxes: Vec<Stuck> = stuck.iter().map(|stuck| contacts.stuck(stuck)).collect();
            case[name] = json!(boxes);
        }
        after.iter().for_each(|after| case["after"] = json!(after));
        from.iter().for_each(|from| case["from"] = json!(from));
        if !turned.is_empty() {
            case["turned"] = json!(turned);
        }
        all.push(case);
    }
    Some(contacts.named().into_iter().chain([("cases", lines(&all))]).collect())
}

/// What rules out a motion: its ends are not free, or colliding configurations separate them.
fn rule_out(scene: &Scene, ends: [Configuration; 2]) -> Option<Vec<StuckBox>> {
    // A checker moves corners in its own way.
    let scene = &*scene.certainly_pressed();
    let is_free = |q: &Configuration| scene.obstructions(*q).is_empty();
    if let Some(end) = ends.iter().find(|end| !is_free(end)) {
        let at = Segment::new(*end, *end);
        return stuck_about(scene, &at).map(|stuck| vec![stuck]);
    }
    let problem = MotionProblem::trusted(scene.clone(), ends[0], ends[1]);
    match solve(&problem, &Options { bounded: false, ..Options::default() }, &mut |_| {}).verdict {
        Verdict::Infeasible(proof) => Some(proof.stuck().to_vec()),
        Verdict::Found(_) | Verdict::Unknown(_) => None,
    }
}

/// A little smaller, about its middle.
fn shrunk(piece: &Convex) -> Convex {
    let core = piece.core();
    let middle = core.iter().map(|p| p.coords).sum::<Vector>() / core.len() as f64;
    let keeps = 1.0 - SMALLER;
    piece.mapped(|p| Point::from(middle + (p.coords - middle) * keeps), piece.radius() * keeps)
}
