//! Strokes of the tool that overlap with a recorded motion.

use super::state::{State, lowering_seconds};
use super::{CollisionCheck, Fault, TIME_TOLERANCE};
use crate::recorded::{StrokeDuringMotion, seconds_to_rise};
use cplan_core::model::Scene;
use cplan_handling::{RecordedStep, Recording, Task};

/// A stroke that overlaps with a motion, and by how many seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PartialStroke {
    /// The object for which the tool is lowered.
    pub object: usize,
    /// Time that the stroke and the motion share, seconds.
    pub overlap: f64,
}

/// The overlaps of a motion with the raising of the tool before it, and with its lowering at the end.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Overlaps {
    pub raising: Option<PartialStroke>,
    pub lowering: Option<PartialStroke>,
}

impl Overlaps {
    /// Creates the overlaps of a step's motion. `raising` is that of the step before.
    pub fn new(raising: Option<PartialStroke>, recorded: &RecordedStep, object: Option<usize>) -> Self {
        let overlap = recorded.overlap.before_arrival;
        let lowering = object.filter(|_| overlap > 0.0).map(|object| PartialStroke { object, overlap });
        Self { raising, lowering }
    }

    fn all(&self) -> impl Iterator<Item = PartialStroke> {
        self.raising.into_iter().chain(self.lowering)
    }

    /// Returns the faults of the overlaps: the world forbids them, the tool is lower than the world allows, or it is not
    /// raised completely during the motion.
    pub fn faults(&self, task: &Task, seconds: f64) -> Vec<Fault> {
        let Some(arch) = task.stroke.as_ref().and_then(|stroke| stroke.arch) else {
            return if self.all().next().is_some() { vec![Fault::NoArch] } else { Vec::new() };
        };
        let shared: f64 = self.all().map(|stroke| stroke.overlap).sum();
        let mut faults = Vec::new();
        if shared > seconds + TIME_TOLERANCE {
            faults.push(Fault::NotRaised { shared, seconds });
        }
        for (stroke, height) in [(self.raising, arch.rise), (self.lowering, arch.fall)] {
            let (Some(PartialStroke { object, overlap }), Some(tool)) = (stroke, &task.stroke) else { continue };
            let depth = tool.depth(&task.objects[object]);
            let most = lowering_seconds(task, object) - seconds_to_rise(tool, depth, height);
            if overlap > most + TIME_TOLERANCE {
                faults.push(Fault::TooLow { overlap, most: most.max(0.0) });
            }
        }
        faults
    }

    /// Checks a motion while the tool is raised or lowered during it. Returns the first check that does not find the
    /// motion free, with its scene, or else the least clearance. `None` if nothing overlaps, or if the overlaps keep the
    /// `clearance` of the motion with the raised tool.
    pub fn check(
        &self,
        task: &Task,
        state: &State,
        motion: &Recording,
        picked: Option<usize>,
        clearance: f64,
    ) -> Option<(Scene, CollisionCheck)> {
        let tool = task.stroke.as_ref()?;
        let times = motion.times()?;
        let depth = |stroke: PartialStroke| tool.depth(&task.objects[stroke.object]);
        let deepest = self.all().map(depth).fold(0.0, f64::max);
        let scene = state.arch_scene(task, (tool, deepest), picked);
        let during = |stroke: PartialStroke, is_raising: bool| {
            let lowered = tool.lowered(depth(stroke));
            let seconds = lowering_seconds(task, stroke.object);
            let (ends, begin) = match is_raising {
                true => ([lowered, tool.joint.rest], times[0] + stroke.overlap - seconds),
                false => ([tool.joint.rest, lowered], times[times.len() - 1] - stroke.overlap),
            };
            let stroke = StrokeDuringMotion { scene: &scene, stroke: tool, ends, begin };
            let keeps = clearance.is_finite() && stroke.keeps(motion, clearance);
            if keeps { None } else { stroke.check(motion) }
        };
        let of = |stroke: Option<PartialStroke>, is_raising| stroke.and_then(|stroke| during(stroke, is_raising));
        let checks = of(self.raising, true).into_iter().chain(of(self.lowering, false));
        let worse = |a: CollisionCheck, b: CollisionCheck| match (a, b) {
            (CollisionCheck::Free { clearance: least, .. }, CollisionCheck::Free { clearance, .. }) => {
                if least <= clearance { a } else { b }
            }
            (CollisionCheck::Free { .. }, _) => b,
            _ => a,
        };
        let mut check = checks.reduce(worse)?;
        // The check has more samples than the recording.
        let number = |time: f64| times.partition_point(|sample| *sample <= time).saturating_sub(1);
        let renumber = |encounter: &mut super::super::Encounter| {
            encounter.moment.sample = number(encounter.moment.time);
        };
        match &mut check {
            CollisionCheck::Free { nearest, .. } => nearest.iter_mut().for_each(renumber),
            CollisionCheck::Collision { first, deepest, .. } => [first, deepest].into_iter().for_each(renumber),
            CollisionCheck::Undecided(nearest) => renumber(nearest),
        }
        Some((scene.swept, check))
    }
}
