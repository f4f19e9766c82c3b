//! The animation of a view: first how the planner found its answer, then the motion of the arm.

use super::figure::Figure;
use super::view::View;
use super::{legend, page};

/// Time between two pictures, in hundredths of a second: nearly 17 pictures per second.
pub const FRAME_DELAY: u16 = 6;

/// Shortest and longest time, in seconds, that an animation takes for the motion. Shorter motions are slowed down, longer ones
/// are sped up.
const MOTION_TIMES: [f64; 2] = [2.0, 3.5];

/// Longest time for which an animation shows the planner's run, in seconds.
const MAX_REPLAY_SECONDS: f64 = 6.0;

/// Time for which the last picture of a phase is shown, in hundredths of a second.
const PHASE_DELAY: u16 = 36;
/// Time for which the arm is shown at the end of its motion, in hundredths of a second: long enough to see the goal.
const GOAL_DELAY: u16 = 80;
/// Time for which the last picture of the animation is shown, in hundredths of a second.
const END_DELAY: u16 = 200;

/// A moment of the animation. Its picture is shown for `delay` hundredths of a second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    kind: MomentKind,
    pub delay: u16,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum MomentKind {
    /// A moment of the planner's run: the index of the phase, and the fraction of it that has been shown.
    Thinking(usize, f64),
    /// A moment of the motion: the time since its start, in seconds.
    Moving(f64),
    /// The last picture: the complete view, as in a still picture.
    Still,
}

/// Returns the moments of a view, in order. The last one shows the complete view.
pub fn moments(view: &View) -> Vec<Moment> {
    let mut moments = Vec::new();
    let frames = |seconds: f64| (seconds * 100.0 / f64::from(FRAME_DELAY)).round().max(1.0) as usize;
    let total: f64 = view.replay.iter().map(|phase| phase.seconds).sum();
    let time_scale = (MAX_REPLAY_SECONDS / total).min(1.0);
    for (phase, now) in view.replay.iter().enumerate() {
        let count = frames(now.seconds * time_scale);
        let shown = (1..=count).map(|k| MomentKind::Thinking(phase, k as f64 / count as f64));
        moments.extend(shown.map(|kind| Moment { kind, delay: FRAME_DELAY }));
        moments.last_mut().into_iter().for_each(|moment| moment.delay = PHASE_DELAY);
    }
    if let Some(duration) = view.duration() {
        let count = frames(duration.clamp(MOTION_TIMES[0], MOTION_TIMES[1]));
        let shown = (0..=count).map(|k| MomentKind::Moving(duration * k as f64 / count as f64));
        moments.extend(shown.map(|kind| Moment { kind, delay: FRAME_DELAY }));
        moments.last_mut().into_iter().for_each(|moment| moment.delay = GOAL_DELAY);
    }
    moments.push(Moment { kind: MomentKind::Still, delay: END_DELAY });
    moments
}

pub fn figure(view: &View, moment: Moment) -> Figure {
    let shown = match moment.kind {
        MomentKind::Thinking(phase, part) => &view.at_replay_moment(phase, part),
        MomentKind::Moving(time) => &view.moving(time),
        MomentKind::Still => view,
    };
    page::explained(shown, legend::keys(view))
}
