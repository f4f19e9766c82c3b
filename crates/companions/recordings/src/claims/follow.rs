//! Checks whether a motion follows a path.

use cplan_handling::Recording;
use cplan_model::space::{Configuration, Path};
use cplan_motion::distance_to_leg;

/// Largest deviation of a motion from its path, in each joint, radians or metres. It is a thousand times the rounding
/// errors, and equals the tolerance of blends.
pub(super) const PATH_TOLERANCE: f64 = 1e-6;

const SAMPLES_PER_PIECE: u8 = 4;

/// Samples the motion, and checks that it follows a path from beginning to end. `radius` is the greatest radius of
/// rounded corners that the result states. Within `radius` of a corner, the motion may deviate by up to `radius / 2`.
/// `None` means that corners are not rounded.
///
/// # Errors
/// A description of the deviation.
pub(super) fn follows(path: &Path, recording: &Recording, radius: Option<f64>) -> Result<(), String> {
    let q = path.waypoints();
    let longest = path.segments().map(|(a, b)| (b - a).norm()).fold(0.0, f64::max);
    let largest = q.iter().map(|q| q.amax()).fold(0.0, f64::max);
    let radius = radius.map_or(0.0, |radius| radius.clamp(0.0, longest));
    let rounding = PATH_TOLERANCE + largest * f64::EPSILON * 16.0;
    // The middle of a parabola is halfway between its corner and the middle of its ends.
    let within = rounding + radius / 2.0;
    let inner = q.get(1..q.len().saturating_sub(1)).unwrap_or_default();
    let last = q.len().saturating_sub(2);
    let off = |at: Configuration, leg: usize| distance_to_leg(at, q[leg], q[(leg + 1).min(q.len() - 1)]);
    // Where legs lie close to each other, or turn back, the motion may be on any of them.
    let (mut legs, mut before) = (vec![0], q[0]);
    for (sample, piece) in recording.pieces().iter().enumerate() {
        for look in 0..=SAMPLES_PER_PIECE {
            let at = piece.at(f64::from(look) / f64::from(SAMPLES_PER_PIECE));
            // A corner may be passed between two samples, but only if it is near.
            let near = 2.0 * within + (at - before).norm();
            let (mut found, mut next): (Vec<usize>, usize) = (Vec::new(), 0);
            for &leg in &legs {
                // Skip a leg that an earlier one already covers.
                if leg >= next {
                    let passed = q[leg + 1..].iter().take_while(|corner| (*corner - at).norm() <= near).count();
                    next = (leg + passed).min(last) + 1;
                    found.extend((leg..next).filter(|leg| off(at, *leg) <= within));
                }
            }
            if found.is_empty() {
                let off = (0..=last).map(|leg| off(at, leg)).fold(f64::INFINITY, f64::min);
                return Err(format!(
                    "the motion does not follow the path: after sample {sample} the arm is at ({}, {}), {off:.6} from the path",
                    at[0], at[1]
                ));
            }
            let is_off = found.iter().all(|leg| off(at, *leg) > rounding);
            let from_corner = inner.iter().map(|corner| (corner - at).norm()).fold(f64::INFINITY, f64::min);
            if is_off && from_corner > radius + rounding {
                return Err(format!(
                    "the motion leaves the path after sample {sample} at ({}, {}), {from_corner:.6} from the nearest corner, but `blends` states that corners are rounded within {radius:.6}",
                    at[0], at[1]
                ));
            }
            (legs, before) = (found, at);
        }
    }
    let first = legs.last().map_or(0, |leg| leg + 1);
    if let Some(missed) = q[first..].iter().find(|corner| (*corner - before).norm() > within) {
        return Err(format!(
            "the motion does not follow the path to the end: it does not reach ({}, {})",
            missed[0], missed[1]
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_followed(by: &[[f64; 2]], path: &[[f64; 2]], radius: Option<f64>) -> bool {
        let all = |at: &[[f64; 2]]| at.iter().map(|q| Configuration::from(*q)).collect::<Vec<_>>();
        let motion = Recording::new(all(by), None, None).unwrap();
        follows(&Path::new(all(path)), &motion, radius).is_ok()
    }

    /// Tests a joint that moves 100 m and turns back, while the other joint moves by less than the tolerance of cut
    /// corners.
    #[test]
    fn legs_that_turn_back_are_followed_to_the_end() {
        let path = [[0.0, 0.0], [1.0, 100.0], [1.6, 60.0], [5.0, 60.0]];
        assert!(is_followed(&path, &path, Some(4.0)));
        assert!(is_followed(&[path[0], [0.98, 98.0], [1.03, 98.0], path[2], path[3]], &path, Some(4.0)));
        // This motion joins the second leg only at its end.
        assert!(!is_followed(&[path[0], [0.99, 99.0], [1.01, 99.3], path[2], path[3]], &path, Some(4.0)));
        for short in [&path[..2], &path[..3], &[path[0], [0.5, 50.0], path[2], path[3]]] {
            assert!(!is_followed(short, &path, Some(4.0)), "{short:?}");
        }
        assert!(is_followed(&path, &path, None) && !is_followed(&[path[0], [0.99, 99.0], path[3]], &path, None));
    }
}
