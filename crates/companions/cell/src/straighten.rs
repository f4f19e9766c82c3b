//! Removes corners of coordinated paths. Arms that stop at each corner are the faster, the fewer corners their paths have.

use crate::coordinate::{Coordination, Coordinator};
use cplan_judge::{CertifiedPath, certify};
use cplan_model::space::Path;
use cplan_motion::TimingError;

/// Greatest number of attempts. Each coordinates both paths again.
const MAX_ATTEMPTS: usize = 60;

/// Returns a coordination along paths with fewer corners that ends earlier, or the given one.
///
/// Each attempt removes successive corners of one arm: first many of them at once, then fewer.
///
/// # Errors
/// A path that cannot be timed.
pub(crate) fn with_fewer_corners(
    coordinator: &Coordinator,
    mut best: Coordination,
) -> Result<Coordination, TimingError> {
    let paths = |best: &Coordination| best.motions.each_ref().map(|motion| motion.curve.straight().clone());
    let corners = |path: &CertifiedPath| path.path().waypoints().len().saturating_sub(2);
    let mut attempts = 0;
    let mut size = paths(&best).iter().map(corners).max().unwrap_or(0);
    while size > 0 {
        let mut is_better = false;
        for arm in 0..2 {
            let mut first = 1;
            while first <= corners(&paths(&best)[arm]) && attempts < MAX_ATTEMPTS {
                attempts += 1;
                let mut tried = paths(&best);
                let shorter = without(&tried[arm], first, size);
                first += size;
                let Ok(shorter) = certify(coordinator.pairs.scenes()[arm], shorter) else { continue };
                tried[arm] = shorter;
                if let Ok(found) = coordinator.along(tried.each_ref(), best.duration)? {
                    (best, is_better) = (found, true);
                    first -= size;
                }
            }
        }
        if !is_better || attempts >= MAX_ATTEMPTS {
            size /= 2;
        }
    }
    Ok(best)
}

/// Returns a path without up to `count` successive corners. The first corner has the number 1.
fn without(path: &CertifiedPath, first: usize, count: usize) -> Path {
    let waypoints = path.path().waypoints();
    let end = (first + count).min(waypoints.len() - 1);
    Path::new(waypoints[..first].iter().chain(&waypoints[end..]).copied().collect())
}
