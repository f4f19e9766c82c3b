//! The limits that determine the speed of a motion.

use cplan_handling::{Derivative, Piece};
use cplan_model::Arm;
use cplan_motion::Trajectory;

/// A limit counts as reached from this share of it.
pub const REACHED_SHARE: f64 = 0.98;

/// Speed of a joint at rest, as a share of its limit.
const REST_SHARE: f64 = 1e-9;

/// A limit that a motion reaches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ActiveLimit {
    /// The tip's speed along the line.
    TipSpeed,
    /// The speed of the joint with this index.
    JointSpeed(usize),
    /// The acceleration of the joint with this index.
    JointAcceleration(usize),
    /// The jerk of the joint with this index.
    JointJerk(usize),
    /// The speed of the wrist.
    WristSpeed,
    /// The acceleration of the wrist.
    WristAcceleration,
    /// No limit.
    None,
}

/// A stretch of time during which the motion reaches one limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// Its beginning, seconds.
    pub from: f64,
    /// Its end, seconds.
    pub to: f64,
    /// The limit.
    pub limit: ActiveLimit,
}

/// Returns the limit that each piece of a motion reaches: the greatest value on the piece is within two per cent of the bound.
/// `tip_limits` has the greatest speed of the tip on each piece, in metres per second; `None` if it is not limited.
///
/// If a piece reaches several limits, speeds take precedence over accelerations, and accelerations over jerks: at top speed, a
/// higher acceleration would not help. Among limits of one kind, the one with the greatest share counts.
pub fn active_limits(arm: &Arm, pieces: &[Piece], tip_limits: &[Option<f64>]) -> Vec<ActiveLimit> {
    pieces.iter().zip(tip_limits).map(|(piece, tip)| active_limit(arm, piece, *tip)).collect()
}

/// Adds the limits of a wrist to those of a motion. The wrist's values are the first components of the pieces `wrist`; `most` has
/// its top speed and greatest acceleration. Limits have the order of [`active_limits`], with the wrist after the joints.
pub fn with_wrist(limits: Vec<ActiveLimit>, wrist: &[Piece], most: [f64; 2]) -> Vec<ActiveLimit> {
    let reaches = |piece: &Piece, of: Derivative, most: f64| {
        piece.critical(of, 0).any(|u| piece.derivative(of, u)[0].abs() >= REACHED_SHARE * most)
    };
    let limit = |(known, piece): (ActiveLimit, &Piece)| match known {
        ActiveLimit::TipSpeed | ActiveLimit::JointSpeed(_) => known,
        _ if reaches(piece, Derivative::Velocity, most[0]) => ActiveLimit::WristSpeed,
        ActiveLimit::JointAcceleration(_) => known,
        _ if reaches(piece, Derivative::Acceleration, most[1]) => ActiveLimit::WristAcceleration,
        _ => known,
    };
    limits.into_iter().zip(wrist).map(limit).collect()
}

fn active_limit(arm: &Arm, piece: &Piece, tip_limit: Option<f64>) -> ActiveLimit {
    let greatest = |of: Derivative, joint: usize| {
        piece.critical(of, joint).map(|u| piece.derivative(of, u)[joint].abs()).fold(0.0, f64::max)
    };
    let of_joint = |of: Derivative, limit: fn(usize) -> ActiveLimit, bound: &dyn Fn(usize) -> Option<f64>| {
        let share = |joint: usize| Some((greatest(of, joint) / bound(joint)?, limit(joint)));
        [share(0), share(1)]
    };
    let joints = &arm.joints;
    let tip = tip_limit.map(|limit| {
        let speed = [0.0, 0.5, 1.0].map(|u| tip_speed(arm, piece, u)).into_iter().fold(0.0, f64::max);
        (speed / limit, ActiveLimit::TipSpeed)
    });
    let [first, second] = of_joint(Derivative::Velocity, ActiveLimit::JointSpeed, &|k| Some(joints[k].velocity));
    let accelerations =
        of_joint(Derivative::Acceleration, ActiveLimit::JointAcceleration, &|k| Some(joints[k].acceleration));
    let jerks = of_joint(Derivative::Jerk, ActiveLimit::JointJerk, &|k| joints[k].jerk);
    let kinds: [&[Option<(f64, ActiveLimit)>]; 3] = [&[tip, first, second], &accelerations, &jerks];
    let reached = |kind: &&[Option<(f64, ActiveLimit)>]| {
        let all = kind.iter().flatten().filter(|(share, _)| *share >= REACHED_SHARE);
        all.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, limit)| *limit)
    };
    kinds.iter().find_map(reached).unwrap_or(ActiveLimit::None)
}

/// Returns the speed of the tip at the parameter `u` (0 to 1) of a piece, metres per second.
pub fn tip_speed(arm: &Arm, piece: &Piece, u: f64) -> f64 {
    let velocity = piece.derivative(Derivative::Velocity, u);
    let [first, second] = arm.jacobian(1, arm.tip, piece.at(u));
    (first * velocity[0] + second * velocity[1]).norm()
}

/// Joins neighbouring pieces that reach the same limit. A stretch shorter than `shortest` seconds gets the limit of the stretch
/// before it, and the first one that of the stretch after it.
pub fn stretches(pieces: &[Piece], limits: &[ActiveLimit], shortest: f64) -> Vec<Stretch> {
    let mut joined: Vec<Stretch> = Vec::new();
    for (piece, &limit) in pieces.iter().zip(limits) {
        match joined.last_mut() {
            Some(last) if last.limit == limit => last.to = piece.to,
            _ => joined.push(Stretch { from: piece.from, to: piece.to, limit }),
        }
    }
    let mut visible: Vec<Stretch> = Vec::new();
    for stretch in joined {
        let is_short = stretch.to - stretch.from < shortest;
        match visible.last_mut() {
            Some(last) if is_short || last.limit == stretch.limit => last.to = stretch.to,
            Some(last) if last.to - last.from < shortest => *last = Stretch { from: last.from, ..stretch },
            _ => visible.push(stretch),
        }
    }
    visible
}

/// Returns the times, in seconds, at which both joints rest: the ends of the motion, and stops in between.
pub fn stops(trajectory: &Trajectory) -> Vec<f64> {
    let rests = |velocity: &[f64; 2]| velocity.iter().all(|speed| speed.abs() <= REST_SHARE);
    let at_rest = trajectory.time.iter().zip(&trajectory.velocity).filter(|(_, velocity)| rests(velocity));
    let mut times: Vec<f64> = at_rest.map(|(time, _)| *time).collect();
    times.dedup_by(|later, earlier| *later - *earlier < 1e-6);
    times
}
