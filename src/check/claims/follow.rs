//! Whether a motion follows a path.

use crate::space::{Configuration, Path, Recording};

/// How far a motion may be off what it follows, in each joint, radians or metres: a thousand times what rounding makes of
/// either, and the hair by which blends may be missed.
pub(super) const NEAR: f64 = 1e-6;

/// Places at which each piece of the motion is looked at.
const LOOKS: u8 = 4;

/// Whether a motion goes along a path from its beginning to its end, no farther off it than cut corners are: half of the
/// greatest `radius` stated, none without a statement. Looked at in places all over the motion.
///
/// # Errors
/// In words.
pub(super) fn follows(path: &Path, recording: &Recording, radius: Option<f64>) -> Result<(), String> {
    let q = path.waypoints();
    let longest = path.segments().map(|(a, b)| (b - a).norm()).fold(0.0, f64::max);
    let largest = q.iter().map(|q| q.amax()).fold(0.0, f64::max);
    // The middle of a parabola is halfway between its corner and the middle of its ends.
    let within = NEAR + largest * f64::EPSILON * 16.0 + radius.map_or(0.0, |radius| radius.clamp(0.0, longest) / 2.0);
    let last = q.len().saturating_sub(2);
    let (mut leg, mut before) = (0, q[0]);
    for (sample, piece) in recording.pieces().iter().enumerate() {
        for look in 0..=LOOKS {
            let at = piece.at(f64::from(look) / f64::from(LOOKS));
            let off = |leg: usize| to_leg(at, q[leg], q[(leg + 1).min(q.len() - 1)]);
            let found = (leg..=last).find(|leg| off(*leg) <= within);
            // Corners may be passed between two places, but only nearby.
            let stride = within + (at - before).norm();
            let passed = |next: usize| q[leg + 1..=next].iter().all(|corner| (corner - at).norm() <= stride + within);
            match found {
                Some(next) if next == leg || passed(next) => leg = next,
                _ => {
                    let off = (0..=last).map(off).fold(f64::INFINITY, f64::min);
                    return Err(format!(
                        "the motion does not follow it: after sample {sample} it is at ({}, {}), {off:.6} from it",
                        at[0], at[1]
                    ));
                }
            }
            before = at;
        }
    }
    if let Some(missed) = q[leg..].iter().skip(1).find(|corner| (*corner - before).norm() > within) {
        return Err(format!("the motion does not follow it to the end: not to ({}, {})", missed[0], missed[1]));
    }
    Ok(())
}

/// Distance of a configuration from a straight piece.
fn to_leg(at: Configuration, from: Configuration, to: Configuration) -> f64 {
    let (along, off) = (to - from, at - from);
    let length2 = along.norm_squared();
    let share = if length2 > 0.0 { (along.dot(&off) / length2).clamp(0.0, 1.0) } else { 0.0 };
    (off - along * share).norm()
}
