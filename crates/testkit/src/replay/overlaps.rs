//! Strokes and turns of the tool that overlap with motions, from closed forms.

use super::{World, state};
use cplan::engine::task::Leg;
use cplan::model::{Action, JointType, Task};
use cplan::motion::Trajectory;

/// A turn: its angles and its duration.
pub(super) type Turn = ([f64; 2], f64);

/// The turns of the wrist with which a motion may overlap: that after the previous step, and its own.
pub(super) struct MotionTurns {
    /// The turn, and the time from the departure to its end.
    before: Option<(Turn, f64)>,
    /// The turn, and the time from its beginning to the arrival.
    own: Option<(Turn, f64)>,
    seconds: f64,
}

impl MotionTurns {
    pub(super) fn new(leg: &Leg, before: Option<Turn>) -> Self {
        let places = matches!(leg.step.action, Action::Place { .. });
        let own = leg.turn.filter(|_| places).map(|(turn, seconds)| ([turn.from, turn.to], seconds));
        Self {
            before: before.map(|turn| (turn, leg.overlap.turn_after_departure)),
            own: own.map(|turn| (turn, leg.overlap.turn_before_arrival)),
            seconds: leg.timed.trajectory.duration(),
        }
    }

    /// Returns the times, seconds, by which strokes and turns overlap with both ends of the motion.
    pub(super) fn ends(&self, [raising, lowering]: [f64; 2], seconds: f64) -> Result<[f64; 2], String> {
        let both = [(self.before, raising), (self.own, lowering)].map(|(turn, stroke)| match turn {
            // The tool turns only while it is raised.
            Some(((_, duration), overlap)) => {
                if stroke > 0.0 && (stroke - (overlap - duration)).abs() > 1e-9 {
                    Err(())
                } else {
                    Ok(overlap)
                }
            }
            None => Ok(stroke),
        });
        let [Ok(departure), Ok(arrival)] = both else { return Err("the tool turns while it is lowered".into()) };
        if departure < 0.0 || arrival < 0.0 || departure + arrival > seconds + 1e-9 {
            return Err(format!("turns and strokes overlap for {departure} and {arrival} s"));
        }
        Ok([departure, arrival])
    }

    /// Iterates over the turns, each with the time of the motion at which it begins.
    pub(super) fn begins(&self) -> impl Iterator<Item = (Turn, f64)> {
        let before = self.before.map(|(turn, overlap)| (turn, overlap - turn.1));
        before.into_iter().chain(self.own.map(|(turn, overlap)| (turn, self.seconds - overlap)))
    }

    /// Gives the payload the orientation that it has at a time of the motion.
    pub(super) fn hold(&self, world: &mut World, at: f64) {
        for (([from, to], seconds), begin) in self.begins() {
            let share = world.turned_share(([from, to], seconds), at - begin);
            world.hold(from + (to - from) * share);
        }
    }

    /// Gives the payload the orientation before the motion's own turn, which is also checked at rest.
    pub(super) fn hold_at_rest(&self, world: &mut World) {
        if let Some((([from, _], _), _)) = self.own {
            world.hold(from);
        }
    }

    /// Checks the limits of the wrist at a time of a turn, during which the wrist also compensates the rotation of link 2.
    pub(super) fn limits(&self, task: &Task, t: &Trajectory, at: f64) -> Result<(), String> {
        const STEP: f64 = 1e-5;
        for (([from, to], seconds), begin) in self.begins() {
            let wrist = task.wrist.ok_or("there is no wrist")?;
            // Numerical derivatives need a neighbourhood without changes of acceleration. Their tolerance is wide.
            if at - begin < 2.0 * STEP || at - begin > seconds - 2.0 * STEP || at < STEP || at > self.seconds - STEP {
                continue;
            }
            let rate = |time: f64| {
                let (_, velocity) = state(t, time);
                let link = |k: usize| match task.arm.joints[k].joint_type {
                    JointType::Revolute { sign } => sign * velocity[k],
                    JointType::Prismatic { .. } => 0.0,
                };
                let share = |time: f64| turned_share(task, ([from, to], seconds), time - begin);
                (to - from) * (share(time + STEP) - share(time - STEP)) / (2.0 * STEP) - link(0) - link(1)
            };
            if rate(at).abs() > wrist.velocity * 1.001 + 1e-3 {
                return Err(format!("the wrist turns at {} rad/s", rate(at)));
            }
            let acceleration = (rate(at + STEP) - rate(at - STEP)) / (2.0 * STEP);
            let before = (rate(at) - rate(at - STEP)) / STEP;
            let after = (rate(at + STEP) - rate(at)) / STEP;
            // Where the acceleration changes, this is a mean of both sides.
            if before.abs().min(after.abs()).min(acceleration.abs()) > wrist.acceleration * 1.001 + 1e-2 {
                return Err(format!("the wrist accelerates at {acceleration} rad/s2"));
            }
        }
        Ok(())
    }
}

/// Returns the share of a turn that is completed at a time after its beginning: the fastest motion, stretched in time.
pub(super) fn turned_share(task: &Task, ([from, to], seconds): Turn, since: f64) -> f64 {
    let distance = (to - from).abs();
    let Some(wrist) = &task.wrist else { return 0.0 };
    let (v, a) = (wrist.velocity, wrist.acceleration);
    let least = if distance <= v * v / a { 2.0 * (distance / a).sqrt() } else { distance / v + v / a };
    let stretch = seconds / least;
    let (v, a) = (v / stretch, a / stretch / stretch);
    let since = since.clamp(0.0, seconds);
    let ramp = (v / a).min(seconds / 2.0);
    let done = if since < ramp {
        a * since * since / 2.0
    } else if since > seconds - ramp {
        distance - a * (seconds - since).powi(2) / 2.0
    } else {
        a * ramp * ramp / 2.0 + a * ramp * (since - ramp)
    };
    (done / distance).clamp(0.0, 1.0)
}

/// Returns the depth to which the tool is lowered at the end of a leg, metres.
pub(super) fn depth_of(task: &Task, leg: &Leg) -> f64 {
    let stroke = task.stroke.as_ref().filter(|_| leg.stroke.is_some());
    let Some((stroke, event)) = stroke.zip(leg.event) else { return 0.0 };
    stroke.travel.unwrap_or(task.objects[event.object()].lift)
}

/// Returns the duration of a stroke over a distance, seconds, by the formula for constant acceleration.
pub(super) fn stroke_time(task: &Task, distance: f64) -> f64 {
    let Some(stroke) = &task.stroke else { return 0.0 };
    let (v, a) = (stroke.velocity, stroke.acceleration);
    if distance <= v * v / a { 2.0 * (distance / a).sqrt() } else { distance / v + v / a }
}

/// Returns the distance, metres, that a stroke has covered at a time after its beginning.
pub(super) fn stroke_height(task: &Task, distance: f64, since: f64) -> f64 {
    let Some(stroke) = &task.stroke else { return 0.0 };
    let (whole, a) = (stroke_time(task, distance), stroke.acceleration);
    let since = since.clamp(0.0, whole);
    let ramp = (stroke.velocity / a).min(whole / 2.0);
    if since < ramp {
        a * since * since / 2.0
    } else if since > whole - ramp {
        distance - a * (whole - since).powi(2) / 2.0
    } else {
        a * ramp * ramp / 2.0 + a * ramp * (since - ramp)
    }
}

/// Checks that the tool is completely raised during a motion, and as high as the task requires at its ends.
pub(super) fn check_overlaps(task: &Task, seconds: f64, ends: [(f64, f64); 2]) -> Result<(), String> {
    let [(_, raising), (_, lowering)] = ends;
    if raising + lowering > seconds + 1e-9 || raising < 0.0 || lowering < 0.0 {
        return Err(format!("overlaps of {raising} and {lowering} s in {seconds} s"));
    }
    let arch = task.stroke.as_ref().and_then(|stroke| stroke.arch);
    for (k, (depth, overlap)) in ends.into_iter().enumerate().filter(|(_, (_, overlap))| *overlap > 0.0) {
        let arch = arch.ok_or("the arm moves during a stroke")?;
        let reached = stroke_height(task, depth, stroke_time(task, depth) - overlap);
        let least = [arch.rise, arch.fall][k];
        if reached < least - 1e-6 {
            return Err(format!("the tool is {reached} m high when the arm moves, {least} m are required"));
        }
    }
    Ok(())
}
