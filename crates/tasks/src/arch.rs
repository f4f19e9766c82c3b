//! Arch motions: the tool is raised while the arm already moves, and lowered before the arm arrives.
//!
//! The motion of the arm stays the same. Only the strokes are shifted into it, as far as both are proven free at the
//! heights of each moment. So the joints keep their limits, and a motion that needs the raised tool waits for it.

use super::state::{Candidate, State};
use super::stroke::{ToolStroke, stroke_seconds};
use cplan_handling::{ArchScene, Recording, Stroke, Task};
use cplan_motion::recorded::{CollisionCheck, StrokeDuringMotion, seconds_to_rise};
use cplan_motion::{TimedMotion, round_down};
use cplan_movers::recordings;

/// Number of halvings in the search for the longest overlap. The overlap is then within a 64th of the stroke's
/// duration.
const HALVINGS: usize = 6;

/// The parts of a motion during which the tool is raised after the last step, or lowered for the next one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// Time from the departure of the arm to the end of the raising, in seconds.
    pub raising: f64,
    /// Time from the beginning of the lowering to the arrival of the arm, in seconds.
    pub lowering: f64,
    /// Proven lower bound on the distance to obstacles during both, in metres. Infinite if no obstacle is within reach.
    pub clearance: f64,
}

impl Overlap {
    /// No overlap: the arm is at rest during strokes.
    pub const NONE: Self = Self { raising: 0.0, lowering: 0.0, clearance: f64::INFINITY };

    /// Returns the time that both overlaps save, in seconds.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.raising + self.lowering
    }
}

/// The strokes that may overlap with a motion.
struct Strokes<'a> {
    stroke: &'a Stroke,
    scene: ArchScene,
    /// Duration of the motion, in seconds.
    seconds: f64,
    /// Depth from which the tool rises. `None` if it is already raised.
    rises_from: Option<f64>,
    /// Depth to which the tool is lowered. `None` if it stays raised until the arm rests.
    sinks_to: Option<f64>,
}

impl Strokes<'_> {
    /// Returns the longest overlap at a height that the world allows, in seconds.
    fn longest(&self, depth: Option<f64>, least_height: f64) -> f64 {
        let allowed = |depth| stroke_seconds(self.stroke, depth) - seconds_to_rise(self.stroke, depth, least_height);
        round_down(depth.map_or(0.0, allowed).min(self.seconds))
    }

    fn during(&self, ends: [f64; 2], begin: f64) -> StrokeDuringMotion<'_> {
        let Self { scene, stroke, .. } = self;
        StrokeDuringMotion { scene, stroke, ends, begin }
    }

    /// Returns the raising whose last `overlap` seconds are in the motion.
    fn raising(&self, overlap: f64) -> Option<StrokeDuringMotion<'_>> {
        let depth = self.rises_from.filter(|_| overlap > 0.0)?;
        let ends = [self.stroke.lowered(depth), self.stroke.joint.rest];
        Some(self.during(ends, overlap - stroke_seconds(self.stroke, depth)))
    }

    /// Returns the lowering whose first `overlap` seconds are in the motion.
    fn lowering(&self, overlap: f64) -> Option<StrokeDuringMotion<'_>> {
        let depth = self.sinks_to.filter(|_| overlap > 0.0)?;
        let ends = [self.stroke.joint.rest, self.stroke.lowered(depth)];
        Some(self.during(ends, self.seconds - overlap))
    }
}

/// Returns the overlap of strokes with the motion to a candidate's target. `stroke` is the one at the target.
pub(super) fn overlap(
    task: &Task,
    from: &State,
    candidate: &Candidate,
    motion: &TimedMotion,
    stroke: Option<&ToolStroke>,
) -> Overlap {
    let Some((tool, arch)) = task.stroke.as_ref().and_then(|tool| Some((tool, tool.arch?))) else {
        return Overlap::NONE;
    };
    let depth = |object: usize| tool.depth(&task.objects[object]);
    let sinks_to = candidate.event.filter(|_| stroke.is_some() && !candidate.turns_before_stroke());
    let touched = from.released.into_iter().chain(candidate.step.action.picked());
    let (rises_from, sinks_to) = (from.rising.map(depth), sinks_to.map(|event| depth(event.object())));
    let deepest = rises_from.into_iter().chain(sinks_to).fold(0.0, f64::max);
    let strokes = Strokes {
        stroke: tool,
        scene: task.arch_scene((tool, deepest), &from.poses, from.held.as_ref(), touched),
        seconds: motion.trajectory.duration(),
        rises_from,
        sinks_to,
    };
    let Some([cubic, quartic]) = recordings(&motion.trajectory) else { return Overlap::NONE };
    let required = task.workspace.fixed.clearance;
    let is_free =
        |stroke: Option<StrokeDuringMotion>, motion: &Recording| stroke.is_none_or(|s| s.keeps(motion, required));
    let most = [strokes.longest(strokes.rises_from, arch.rise), strokes.longest(strokes.sinks_to, arch.fall)];
    let mut raising = longest_free(most[0], |overlap| is_free(strokes.raising(overlap), &cubic));
    let mut lowering = longest_free(most[1], |overlap| is_free(strokes.lowering(overlap), &cubic));
    let excess = raising + lowering - strokes.seconds;
    if excess > 0.0 {
        // The tool is raised completely before it is lowered.
        raising = round_down(raising - excess * raising / (raising + lowering)).max(0.0);
        lowering = round_down(strokes.seconds - raising).min(lowering);
    }
    let mut clearance = f64::INFINITY;
    match clearance_during(strokes.raising(raising), motion, &[&cubic, &quartic]) {
        Some(found) => clearance = clearance.min(found),
        None => raising = 0.0,
    }
    match clearance_during(strokes.lowering(lowering), motion, &[&cubic, &quartic]) {
        Some(found) => clearance = clearance.min(found),
        None => lowering = 0.0,
    }
    Overlap { raising, lowering, clearance }
}

/// Returns a proven lower bound, in metres, on the distance to obstacles during a stroke, for both interpolations of a
/// motion. Infinite if there is no stroke. Returns `None` if the motion is not proven free.
fn clearance_during(
    stroke: Option<StrokeDuringMotion>,
    motion: &TimedMotion,
    [cubic, quartic]: &[&Recording; 2],
) -> Option<f64> {
    let Some(stroke) = stroke else { return Some(f64::INFINITY) };
    // Usually the strokes keep as far from obstacles as the raised tool, which is quick to prove.
    let of_motion = motion.curve.clearance();
    let clearance = |recording: &Recording| {
        if of_motion.is_finite() && stroke.keeps(recording, of_motion) {
            return Some(of_motion);
        }
        match stroke.check(recording) {
            None => Some(f64::INFINITY),
            Some(CollisionCheck::Free { clearance, .. }) => Some(clearance),
            Some(_) => None,
        }
    };
    // Without blends, both interpolations are the same motion.
    let is_curved = motion.curve.curve().radii().iter().any(|radius| *radius > 0.0);
    let of_cubic = clearance(cubic)?;
    if is_curved { Some(of_cubic.min(clearance(quartic)?)) } else { Some(of_cubic) }
}

/// Returns the longest overlap up to `most` seconds that is free, within the accuracy of [`HALVINGS`].
fn longest_free(most: f64, is_free: impl Fn(f64) -> bool) -> f64 {
    if most <= 0.0 || is_free(most) {
        return most.max(0.0);
    }
    let (mut free, mut blocked) = (0.0, most);
    for _ in 0..HALVINGS {
        let middle = round_down((free + blocked) / 2.0);
        if is_free(middle) { free = middle } else { blocked = middle }
    }
    free
}
