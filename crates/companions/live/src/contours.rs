//! Contours of C-obstacles. They are cached between answers, because only one or two obstacles change at a time.

use cplan_geometry::Convex;
use cplan_model::{Arm, Heights, Obstacle, Scene, Workspace};
use cplan_planners::cspace::CObstacle;
use cplan_view::output;
use std::cell::RefCell;

/// A cache of C-obstacle contours. The contours of an obstacle depend only on the arm, the clearance and the obstacle's
/// pieces.
#[derive(Default)]
pub struct Contours {
    known: RefCell<Known>,
}

#[derive(Default)]
struct Known {
    /// The arm and the clearance to which all entries belong.
    of: Option<(Arm, f64)>,
    /// Entries in the order of the obstacles of the last scene.
    entries: Vec<Entry>,
    /// Contours of links that other links can hit, each with the number of its obstacle.
    own: Vec<CObstacle>,
}

#[derive(Clone)]
struct Entry {
    pieces: Vec<Convex>,
    heights: Heights,
    /// Contours of the obstacle. They do not depend on its index.
    contours: Vec<CObstacle>,
}

impl Entry {
    fn matches(&self, obstacle: &Obstacle) -> bool {
        self.heights == obstacle.heights && self.pieces == obstacle.pieces
    }
}

impl Contours {
    /// Returns the contours for pictures of a scene without payload, obstacle by obstacle. Computes only the contours
    /// of obstacles that are not in the last scene.
    pub fn of(&self, scene: &Scene) -> Vec<CObstacle> {
        let obstacles = &scene.workspace().obstacles;
        let of = Some((scene.arm().clone(), scene.workspace().clearance));
        let found = {
            let mut known = self.known.borrow_mut();
            if known.of != of {
                *known = Known { of, entries: Vec::new(), own: own(scene) };
            }
            known.found(obstacles)
        };
        let missing: Vec<usize> = (0..obstacles.len()).filter(|&k| found[k].is_none()).collect();
        // The computation may be interrupted at any time, so it must not borrow the cache.
        let mut made = trace_contours(scene, &missing).into_iter();
        let entries: Vec<Entry> = found.into_iter().filter_map(|entry| entry.or_else(|| made.next())).collect();
        let numbered = |(number, entry): (usize, &Entry)| {
            let numbered = |contour: &CObstacle| CObstacle { obstacle: number, ..contour.clone() };
            entry.contours.iter().map(numbered).collect::<Vec<_>>()
        };
        let mut contours: Vec<CObstacle> = entries.iter().enumerate().flat_map(numbered).collect();
        let mut known = self.known.borrow_mut();
        known.entries = entries;
        let first = scene.self_obstacles().start;
        contours.extend(known.own.iter().map(|own| CObstacle { obstacle: first + own.obstacle, ..own.clone() }));
        contours
    }
}

impl Known {
    /// Finds the cached entry of each obstacle. If obstacles appeared or disappeared, the others have moved by one or
    /// two positions.
    fn found(&self, obstacles: &[Obstacle]) -> Vec<Option<Entry>> {
        let mut next = 0;
        let mut one = |obstacle: &Obstacle| {
            let there = self.entries.iter().skip(next).position(|entry| entry.matches(obstacle))? + next;
            next = there + 1;
            Some(self.entries[there].clone())
        };
        obstacles.iter().map(&mut one).collect()
    }
}

/// Computes the contours of the links that other links can hit.
fn own(scene: &Scene) -> Vec<CObstacle> {
    if scene.arm().self_obstacles.is_empty() {
        return Vec::new();
    }
    let workspace = Workspace { obstacles: Vec::new(), ..scene.workspace().clone() };
    output::contours(&Scene::trusted(scene.arm().clone(), workspace))
}

/// Computes the contours of some obstacles, one entry for each.
fn trace_contours(scene: &Scene, wanted: &[usize]) -> Vec<Entry> {
    let obstacles: Vec<Obstacle> = wanted.iter().map(|&k| scene.workspace().obstacles[k].clone()).collect();
    let entry = |o: &Obstacle| Entry { pieces: o.pieces.clone(), heights: o.heights, contours: Vec::new() };
    let mut entries: Vec<Entry> = obstacles.iter().map(entry).collect();
    let workspace = Workspace { obstacles, preferences: Vec::new(), ..scene.workspace().clone() };
    let arm = Arm { self_obstacles: Vec::new(), ..scene.arm().clone() };
    for contour in output::contours(&Scene::trusted(arm, workspace)) {
        entries[contour.obstacle].contours.push(contour);
    }
    entries
}
