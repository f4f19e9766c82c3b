//! Changes the shape of a path so that the motion along it is faster.
//!
//! The shortest path touches the obstacles that it goes around, so its corners can hardly be rounded. If a corner moves away from
//! the obstacle by a small distance, the arm passes it several times as fast, while the path becomes longer only by about the
//! square of the distance.

use super::sample::TimedMotion;
use cplan_judge::{CertifiedPath, StraightMotions, certify};
use cplan_model::Scene;
use cplan_model::space::{Configuration, Path};

/// Distances by which all corners are first moved away from obstacles, as fractions of the greatest distance.
const LIFT_SHARES: [f64; 8] = [1.0 / 128.0, 1.0 / 64.0, 1.0 / 32.0, 1.0 / 16.0, 1.0 / 8.0, 1.0 / 4.0, 1.0 / 2.0, 1.0];

/// First and last distance by which single corners are moved, as fractions of the greatest distance.
const CORNER_STEPS: [f64; 2] = [1.0 / 8.0, 1.0 / 512.0];

/// Largest number of paths with single moved corners that are tried.
const MAX_TRIES: usize = 240;

/// Number of times that the distance of a corner with blocked legs is halved before the corner stays in place.
const MAX_LIFT_HALVINGS: u32 = 6;

pub(super) struct ShapeSearch<'a, F> {
    scene: &'a Scene,
    motions: StraightMotions<'a>,
    /// Returns the fastest motion along a path, or `None` if it takes longer than the given seconds.
    drive: F,
}

impl<'a, F: Fn(&CertifiedPath, f64) -> Option<TimedMotion>> ShapeSearch<'a, F> {
    pub fn new(scene: &'a Scene, drive: F) -> Self {
        Self { scene, motions: StraightMotions::new(scene, scene.workspace().clearance), drive }
    }

    /// Searches for a motion faster than `best`: along a path, and along paths with all corners moved away from obstacles by up
    /// to `most`.
    pub fn lifted(&self, path: &CertifiedPath, most: f64, best: &mut TimedMotion) {
        self.replace_if_faster(path, best);
        if path.path().waypoints().len() < 3 {
            return;
        }
        for path in LIFT_SHARES.iter().filter_map(|lift| self.moved_off_obstacles(path, lift * most)) {
            self.replace_if_faster(&path, best);
        }
    }

    /// Searches for a motion faster than `best` by a pattern search that moves or removes single corners. The first distance is a
    /// fraction of `most`.
    pub fn refined(&self, most: f64, best: &mut TimedMotion) {
        let [mut step, last] = CORNER_STEPS.map(|share| share * most);
        let mut left = MAX_TRIES;
        while step >= last {
            let mut improved = false;
            let mut w = 1;
            while w + 1 < best.curve.curve().path().waypoints().len() {
                let q = best.curve.curve().path().waypoints().to_vec();
                let ahead = (q[w + 1] - q[w - 1]).try_normalize(0.0).unwrap_or_else(Configuration::zeros);
                let out = outward(&q, w);
                for offset in [Some(out), Some(-out), Some(ahead), Some(-ahead), None] {
                    if left == 0 {
                        return;
                    }
                    let Some(moved) = self.with_changed_corner(&q, w, offset.map(|offset| offset * step)) else {
                        continue;
                    };
                    left -= 1;
                    if self.replace_if_faster(&moved, best) {
                        improved = true;
                        break;
                    }
                }
                w += 1;
            }
            if !improved {
                step /= 2.0;
            }
        }
    }

    /// Returns a path with one of its corners moved or removed, if it is free.
    fn with_changed_corner(&self, q: &[Configuration], w: usize, by: Option<Configuration>) -> Option<CertifiedPath> {
        let mut moved = q.to_vec();
        let is_free = match by {
            Some(by) => {
                moved[w] += by;
                self.motions.is_free(moved[w - 1], moved[w]) && self.motions.is_free(moved[w], moved[w + 1])
            }
            None => {
                moved.remove(w);
                self.motions.is_free(moved[w - 1], moved[w])
            }
        };
        is_free.then(|| certify(self.scene, Path::new(moved)).ok()).flatten()
    }

    /// Replaces `best` by the motion along a path if that is faster. Returns true if it does.
    fn replace_if_faster(&self, path: &CertifiedPath, best: &mut TimedMotion) -> bool {
        let faster = (self.drive)(path, best.trajectory.duration());
        let is_faster = faster.is_some();
        if let Some(faster) = faster {
            *best = faster;
        }
        is_faster
    }

    /// Returns a path with its corners moved away from obstacles, each as far as its legs remain free.
    fn moved_off_obstacles(&self, path: &CertifiedPath, by: f64) -> Option<CertifiedPath> {
        let q = path.path().waypoints();
        let mut lifts: Vec<f64> = (0..q.len()).map(|w| if w == 0 || w + 1 == q.len() { 0.0 } else { by }).collect();
        for round in 0..=MAX_LIFT_HALVINGS {
            let at = |w: usize| if lifts[w] > 0.0 { q[w] + outward(q, w) * lifts[w] } else { q[w] };
            let moved: Vec<Configuration> = (0..q.len()).map(at).collect();
            let is_moved = |w: usize| lifts[w - 1] > 0.0 || lifts[w] > 0.0;
            let barred: Vec<usize> =
                (1..q.len()).filter(|&w| is_moved(w) && !self.motions.is_free(moved[w - 1], moved[w])).collect();
            if barred.is_empty() {
                return certify(self.scene, Path::new(moved)).ok();
            }
            let share = if round + 1 < MAX_LIFT_HALVINGS { 0.5 } else { 0.0 };
            barred.iter().for_each(|&w| (lifts[w - 1], lifts[w]) = (share * lifts[w - 1], share * lifts[w]));
        }
        None
    }
}

/// Returns the unit direction away from the obstacle at an inner corner; zero if the path does not turn there.
fn outward(q: &[Configuration], w: usize) -> Configuration {
    let [before, after] = [q[w] - q[w - 1], q[w + 1] - q[w]].map(|leg| leg / leg[0].hypot(leg[1]));
    (before - after).try_normalize(1e-6).unwrap_or_else(Configuration::zeros)
}
