//! The floor of a room, whose obstacles stop a robot's rays and body.

use crate::root;
use cplan::cspace::c_obstacles;
use cplan::input::{self, InputError};
use cplan::model::{Scene, Status};
use cplan::nalgebra::Vector2;
use cplan::space::Path;
use cplan::view::{Picture, View, svg};
use cplan::{Configuration, Point};

/// A world of cplan, with the sides of its obstacles for simulated sensors.
pub struct Floor {
    /// The obstacles, and a gantry (`robots/mobile_robot.urdf`) whose configurations are the positions of the robot.
    pub scene: Scene,
    sides: Vec<[Point; 2]>,
    discs: Vec<(Point, f64)>,
}

impl Floor {
    /// Loads a shipped world of the mobile robot.
    ///
    /// # Errors
    /// Defects of the world.
    pub fn load(world: &str) -> Result<Self, InputError> {
        Self::of_robot("mobile_robot", world)
    }

    /// Loads a shipped world of another gantry robot.
    ///
    /// # Errors
    /// Defects of the world.
    pub fn of_robot(robot: &str, world: &str) -> Result<Self, InputError> {
        let urdf = root().join("robots").join(robot).with_extension("urdf");
        let loaded = input::load_scene(urdf, &root().join("workspaces").join(world))?;
        Ok(Self::new(loaded.scene))
    }

    /// Returns the floor of a scene.
    pub fn new(scene: Scene) -> Self {
        let (mut sides, mut discs) = (Vec::new(), Vec::new());
        for piece in scene.workspace().obstacles.iter().flat_map(|obstacle| &obstacle.pieces) {
            match piece.core() {
                [center] => discs.push((*center, piece.radius())),
                [a, b] => sides.push([*a, *b]),
                corners => sides.extend((0..corners.len()).map(|k| [corners[k], corners[(k + 1) % corners.len()]])),
            }
        }
        Self { scene, sides, discs }
    }

    /// Returns the length of a ray to the first obstacle, in metres, or `most` if that is less.
    pub fn range(&self, from: Point, angle: f64, most: f64) -> f64 {
        let ray = Vector2::new(angle.cos(), angle.sin());
        let side = |[a, b]: &[Point; 2]| {
            let (along, to) = (b - a, a - from);
            let turn = ray.perp(&along);
            // The intersection of ray and side, as fractions of their lengths. A ray along a side intersects the adjacent sides.
            let (t, s) = (to.perp(&along) / turn, to.perp(&ray) / turn);
            (t >= 0.0 && (0.0..=1.0).contains(&s)).then_some(t)
        };
        let disc = |(center, radius): &(Point, f64)| {
            let to = center - from;
            let (near, off) = (to.dot(&ray), to.perp(&ray));
            let half = (radius * radius - off * off).sqrt();
            (near - half >= 0.0).then_some(near - half)
        };
        let hits = self.sides.iter().filter_map(side).chain(self.discs.iter().filter_map(disc));
        hits.fold(most, f64::min)
    }

    /// Returns the distance between the robot's body and the nearest obstacle, in metres; negative if they overlap.
    pub fn gap(&self, at: Point) -> f64 {
        self.scene.clearance(Configuration::new(at.x, at.y))
    }

    /// Draws the floor with paths, as SVG.
    pub fn picture(&self, title: &str, goals: &[[f64; 2]], ways: &[(String, Vec<Point>)]) -> String {
        let fineness = 1e-3 * self.scene.arm().reach();
        let outlines = c_obstacles(&self.scene, fineness, fineness);
        let paths: Vec<(String, Path)> =
            ways.iter().map(|(name, way)| (name.clone(), Path::new(way.clone()))).collect();
        let start = paths.first().map_or(Configuration::new(0.0, 0.0), |(_, path)| path.start());
        let goals: Vec<_> = goals.iter().map(|&goal| cplan::space::Segment::point(goal.into())).collect();
        svg(&View::of_picture(&Picture {
            title: vec![title.to_owned()],
            ending: Some(Status::Found),
            goals: &goals,
            paths: paths.iter().map(|(name, path)| (name.clone(), path)).collect(),
            c_obstacles: &outlines,
            ..Picture::new(&self.scene, start)
        }))
    }
}
