//! Pictures and pages of an answer about a cell: both arms, the diagram of their times, and a row of time for each arm.

mod figure;
mod motions;
mod objects;
mod page;
mod rows;
mod words;

use crate::{Cell, CellPlan};
use cplan_geometry::Convex;
use cplan_model::space::Configuration;
use cplan_model::{Carrier, Obstacle, Scene};
use cplan_theme::{ACCENT, PROOF, Rgb};
use cplan_view::{Frame, bounding_box};
use motions::ShownMotions;
use objects::ShownObject;

/// Colours of the arms.
const ARM_COLORS: [Rgb; 2] = [ACCENT, PROOF];

/// Share of an arm's colour that the regions which it passes first lose.
const REGION_PALENESS: f64 = 0.72;

/// Number of times at which the arms are within the picture.
const FRAME_TIMES: usize = 40;

/// Margin around the cell, as a share of its size.
const MARGIN: f64 = 0.04;

/// An answer about a cell, to be shown as a picture or a page.
#[derive(Debug, Clone, Copy)]
pub struct Answer<'a> {
    /// The cell.
    pub cell: &'a Cell,
    /// The answer about it.
    pub plan: &'a CellPlan,
    /// Difference of the clocks for which the motions are certified, seconds.
    pub skew: f64,
    /// Facts about the answer: names and values. The first one is the result in words.
    pub facts: &'a [(&'static str, String)],
}

impl Answer<'_> {
    fn scenes(&self) -> [&Scene; 2] {
        self.cell.arms.each_ref().map(|arm| arm.problem.scene())
    }

    fn names(&self) -> [&str; 2] {
        self.cell.arms.each_ref().map(|arm| arm.name.as_str())
    }

    fn starts(&self) -> [Configuration; 2] {
        self.cell.arms.each_ref().map(|arm| arm.problem.query().start())
    }

    /// Iterates over the obstacles of the cell, without the bases of the robots and without objects that the arms can move.
    fn obstacles(&self) -> impl Iterator<Item = &Obstacle> {
        let [one, two] = self.scenes();
        let all = &one.workspace().obstacles;
        // The bases of the second robot are the last obstacles of the first arm.
        let bases = if self.cell.is_one_robot { 0 } else { bases(two).count() };
        let objects = self.tasks().into_iter().flatten().next().map_or(&[][..], |task| &task.objects);
        let can_move = |obstacle: &&Obstacle| objects.iter().any(|object| object.name == obstacle.name);
        all[..all.len() - bases].iter().filter(move |obstacle| !can_move(obstacle))
    }

    /// Returns the least and greatest coordinates of the cell and the whole motions, with a margin.
    fn extent(&self, motions: Option<&ShownMotions>) -> [(f64, f64); 2] {
        let mut shapes: Vec<Convex> = self.obstacles().flat_map(|obstacle| obstacle.pieces.clone()).collect();
        shapes.extend(self.objects(motions).iter().flat_map(ShownObject::shapes));
        for (arm, scene) in self.scenes().into_iter().enumerate() {
            shapes.extend(bases(scene).flat_map(|base| base.pieces.clone()));
            shapes.extend(arm_shapes(scene, self.starts()[arm]));
            if let Some(motions) = motions {
                let times = (0..=FRAME_TIMES).map(|k| motions.duration * k as f64 / FRAME_TIMES as f64);
                shapes.extend(times.flat_map(|time| arm_shapes(scene, motions.place(arm, time))));
            }
        }
        let sides = bounding_box(&shapes);
        let size = sides.iter().map(|(low, high)| high - low).fold(f64::MIN_POSITIVE, f64::max);
        sides.map(|(low, high)| (low - MARGIN * size, high + MARGIN * size))
    }
}

/// Returns the links of an arm's robot that never move.
fn bases(scene: &Scene) -> impl Iterator<Item = &Obstacle> {
    let own = scene.arm().self_obstacles.iter().filter(|own| own.carrier == Carrier::Base);
    own.map(|own| &own.obstacle)
}

/// Returns the shapes of an arm at a configuration: those of its first link, then those of its second.
fn arm_shapes(scene: &Scene, q: Configuration) -> Vec<Convex> {
    let poses = scene.arm().poses(q);
    let links = scene.arm().links.iter().zip(poses);
    links.flat_map(|(link, pose)| link.parts.iter().map(move |part| part.shape.at(&pose))).collect()
}

/// Returns the axes of the diagram: the time for which each arm has moved on its path, without its waits.
fn time_frame(motions: &ShownMotions, rect: cplan_view::figure::Rect) -> Frame {
    let [x, y] = [0, 1].map(|arm| (0.0, motions.moved(arm, motions.duration).max(1e-3)));
    Frame::fitted(rect, x, y, false)
}
