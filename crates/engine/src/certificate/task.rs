//! Evidence for a task: besides the motion which part of it does which step, and how the wrist turns what is carried. Where all objects
//! are then follows from the world.

use super::contacts::Contacts;
use super::{Evidence, NoCertificate, Stuck, lines, stuck_about, tells_apart};
use crate::task::{RefutedCase, StepReport, Turned, refuted};
use crate::{Options, Verdict, solve};
use cplan_core::check::StuckBox;
use cplan_core::model::{
    Action, Arm, Joint, MotionProblem, Object, Payload, RecordedStep, Scene, Step, Task, taken_off,
};
use cplan_core::space::{Configuration, Segment};
use cplan_geometry::{Convex, can_be_drawn_in, corner_to_corner, stays_convex};
use serde_json::{Value, json};
use std::collections::BTreeSet;
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

/// Room for how objects lie and hang is this many times what is known of it at most: a checker encloses it step by step.
const ENCLOSED: f64 = 4.0;

/// Proofs about objects that are taken for smaller may begin elsewhere: they are looked for again with room for that at most so often.
const MOST_LOOKS: usize = 3;

/// IK solutions that a checker finds less well, by [`tells_apart`], have none: it looks at 2 000 parts.
const NEARLY_STRETCHED: f64 = 0.005;

/// What [`tells_apart`] is at the most.
const MOST_TOLD: f64 = 0.25;

/// Half the sides of the rectangles that hold IK solutions where the joints move the tip across each other, as shares of the joints' ranges. A
/// checker finds them to a part in 10^12, ...
const ABOUT_IK_SOLUTIONS: f64 = 1e-10;

/// ... and so much less well those that depend on where the arm was in one of these rectangles.
const AFTER_ANOTHER: f64 = 100.0;

/// That the steps up to one cannot be done, case by case; none where the proof is of a kind that the checker does not know.
pub(super) fn cases(task: &Task, last: usize) -> Option<Evidence> {
    let arm = &task.arm;
    let are_told = |cases: &[RefutedCase]| cases.iter().all(|case| told_of(arm, case) >= NEARLY_STRETCHED);
    // Of what presses into supports the parts of a piece have each its own corners.
    let mut parts = task.clone();
    for object in pressed(task) {
        parts.objects[object].pieces = corner_to_corner(&task.objects[object].pieces).concat();
    }
    let mut room = 0.0_f64;
    for _ in 0..MOST_LOOKS {
        let cases = refuted(&parts, last, room, &mut rule_out, &are_told)?;
        let known = Known::new(task, &cases);
        let needed = ENCLOSED * cases.iter().map(|case| known.moves(case)).fold(0.0, f64::max);
        if parts.objects.iter().all(|object| needed <= taken_off(&object.pieces, room)) {
            return Some(written(task, &cases, &known));
        }
        room = 2.0 * needed;
    }
    None
}

/// What tells where an arm is before a case from beside it.
fn told_of(arm: &Arm, case: &RefutedCase) -> f64 {
    case.from.map_or(MOST_TOLD, |q| tells_apart(arm, q))
}

/// Objects that rest on something where a step takes or places them.
fn pressed(task: &Task) -> BTreeSet<usize> {
    let mut picked = None;
    let rests = |step: &Step| {
        picked = step.action.picked().or(picked);
        let (Action::Pick { supports, .. } | Action::Place { supports, .. }) = &step.action else { return None };
        picked.filter(|_| !supports.is_empty())
    };
    task.steps().filter_map(rests).collect()
}

/// Whether a checker can move the corners of all that rests on something inwards; and, for proofs about it, name their corners.
///
/// # Errors
/// [`NoCertificate::Outline`].
pub(super) fn checkable(task: &Task, is_proof: bool) -> Result<(), NoCertificate> {
    let allowance = Payload::penetration_allowance(&task.arm);
    for object in pressed(task) {
        let Object { name, pieces, .. } = &task.objects[object];
        if !can_be_drawn_in(pieces, allowance) || (is_proof && !stays_convex(pieces, allowance)) {
            return Err(NoCertificate::Outline(name.clone()));
        }
    }
    Ok(())
}

/// How well a checker knows where the arm is before cases.
struct Known<'a> {
    task: &'a Task,
    /// As [`Known::let_go`] has it, of what is not told to be turned: as well known as where it was taken, for which the worst of all cases stands.
    untold: f64,
    /// The farthest from joint 1, or from where it is grasped, that anything of an object gets.
    farthest: [f64; 2],
}

impl<'a> Known<'a> {
    fn new(task: &'a Task, cases: &[RefutedCase]) -> Self {
        let arm = &task.arm;
        let carrying = cases.iter().filter(|case| case.scene.payload().is_some());
        let untold = AFTER_ANOTHER * ABOUT_IK_SOLUTIONS * MOST_TOLD
            / carrying.map(|case| told_of(arm, case)).fold(MOST_TOLD, f64::min);
        let pieces = task.objects.iter().flat_map(|object| &object.pieces);
        let beyond = |piece: &Convex| piece.core().iter().map(|p| p.coords.norm()).fold(0.0, f64::max) + piece.radius();
        let size = pieces.map(beyond).fold(0.0, f64::max);
        Self { task, untold, farthest: [arm.reach() + 2.0 * size, 2.0 * size] }
    }

    /// Half the sides of a rectangle about a configuration, a share of the joints' ranges where the joints move the tip across each other.
    fn sides(&self, q: Configuration, share: f64) -> [f64; 2] {
        let told = tells_apart(&self.task.arm, q);
        self.task.arm.topology().ranges.map(|range| {
            let (lower, upper) = range.domain();
            share * (MOST_TOLD / told) * (upper - lower)
        })
    }

    /// Such a share where something is picked after others have been turned: that depends on how it lies.
    fn picked(&self, object: usize, turned: &[Turned]) -> f64 {
        let Some(last) = turned.iter().rposition(|turned| turned.object == object) else { return ABOUT_IK_SOLUTIONS };
        self.less_well(self.let_go(&turned[..=last]), turned[last].carried[1])
    }

    /// Such a share where the last of these has been let go of.
    fn let_go(&self, turned: &[Turned]) -> f64 {
        let Some((last, before)) = turned.split_last() else { return ABOUT_IK_SOLUTIONS };
        self.less_well(self.picked(last.object, before), last.carried[0])
    }

    /// Such a share where that depends on where the arm was at a configuration.
    fn less_well(&self, share: f64, q: Configuration) -> f64 {
        AFTER_ANOTHER * share * MOST_TOLD / tells_apart(&self.task.arm, q)
    }

    /// The sides where the arm is before a case.
    fn before(&self, case: &RefutedCase) -> Option<[f64; 2]> {
        let share = match case.held.filter(|_| case.scene.payload().is_some()) {
            Some(object) => self.picked(object, &case.turned),
            None => self.let_go(&case.turned).max(self.untold),
        };
        case.from.map(|q| self.sides(q, share))
    }

    /// The sides where the arm took and let go of all that has been turned.
    fn turned(&self, case: &RefutedCase) -> Vec<[[f64; 2]; 2]> {
        let ends = |(k, turned): (usize, &Turned)| {
            let shares = [self.picked(turned.object, &case.turned[..k]), self.let_go(&case.turned[..=k])];
            [0, 1].map(|end| self.sides(turned.carried[end], shares[end]))
        };
        case.turned.iter().enumerate().map(ends).collect()
    }

    /// How far what lies and hangs in a case may be from where it is taken to be, metres.
    fn moves(&self, case: &RefutedCase) -> f64 {
        let by = |sides: [f64; 2], far: f64| {
            let moved = |(joint, side): (&Joint, f64)| if joint.joint_type.is_revolute() { side * far } else { side };
            self.task.arm.joints.iter().zip(sides).map(moved).sum::<f64>()
        };
        let [from_joint, from_grasp] = self.farthest;
        let hanging = self.before(case).filter(|_| case.scene.payload().is_some()).map_or(0.0, |s| by(s, from_joint));
        // Where it is let go of is known: it is but turned about that.
        let turned = self.turned(case).into_iter().flatten().map(|sides| by(sides, from_grasp)).sum::<f64>();
        hanging + turned
    }
}

/// Cases as they are written.
fn written(task: &Task, cases: &[RefutedCase], known: &Known) -> Evidence {
    let empty = Scene::trusted(task.arm.clone(), task.workspace.clone());
    let about = |q: Configuration, sides: [f64; 2]| [0, 1].map(|k| [q[k] - sides[k], q[k] + sides[k]]);
    let mut contacts = Contacts::new(&empty);
    let mut all = Vec::new();
    for case in cases {
        let RefutedCase { step, after, from, turned, scene, stuck, lowered, .. } = case;
        let mut entry = json!({ "step": step });
        let lowered =
            lowered.iter().filter(|(_, stuck)| !stuck.is_empty()).map(|(scene, stuck)| ("lowered", scene, stuck));
        for (name, scene, stuck) in iter::once(("boxes", scene, stuck)).chain(lowered) {
            contacts = contacts.among(scene);
            let boxes: Vec<Stuck> = stuck.iter().flat_map(|stuck| contacts.stuck(stuck)).collect();
            entry[name] = json!(boxes);
        }
        after.iter().for_each(|after| entry["after"] = json!(after));
        from.iter().zip(known.before(case)).for_each(|(q, sides)| entry["from"] = json!(about(*q, sides)));
        if !turned.is_empty() {
            let ends = |(turned, sides): (&Turned, [[f64; 2]; 2])| [0, 1].map(|k| about(turned.carried[k], sides[k]));
            entry["turned"] = json!(turned.iter().zip(known.turned(case)).map(ends).collect::<Vec<_>>());
        }
        all.push(entry);
    }
    contacts.named().into_iter().chain([("cases", lines(&all))]).collect()
}

/// What rules out a motion: its ends are not free, or colliding configurations separate them.
fn rule_out(scene: &Scene, ends: [Configuration; 2]) -> Option<Vec<StuckBox>> {
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
