//! Random arms among a few large obstacles. They are stored as numbers, from which the files are written.

use cplan::model::Scene;
use cplan_cases::dice::Dice;
use cplan_testkit::problems::scene_of_texts;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::fmt::Write;

pub type V = [f64; 2];

/// For each plane, the root axes of its two coordinates and of its normal, and the sign of the normal for which
/// coordinates and normal form a right-handed system.
pub const PLANES: [([usize; 3], f64); 3] = [([0, 1, 2], 1.0), ([0, 2, 1], -1.0), ([1, 2, 0], 1.0)];

/// Number of draws until a configuration is free.
const TRIES: usize = 200;

/// A problem in numbers. Lengths are in metres.
#[derive(Debug, Clone)]
pub struct Drawn {
    /// Index into [`PLANES`].
    pub plane: usize,
    pub joints: [Joint; 2],
    /// Origin of each joint in the plane, relative to the joint before it, and heights of the joints (`heights`).
    pub origins: [V; 2],
    pub heights: [f64; 2],
    pub solids: [Vec<Solid>; 2],
    /// True if the solids are `<visual>` shapes, because the links have no collision geometry.
    pub visual: bool,
    /// The tip relative to the second joint. `None` if it is at that joint.
    pub tip: Option<V>,
    /// Angle of each axis off the plane's normal, or of each slide off the plane, radians. Exported files have such
    /// deviations from exact directions.
    pub tilts: V,
    /// Position and orientation of the robot.
    pub at: V,
    pub angle: f64,
    pub obstacles: Vec<Obstacle>,
    pub clearance: f64,
    pub start: V,
    pub goal: Goal,
    /// Unit of all lengths.
    pub scale: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    Joints(V),
    Tip(V),
}

#[derive(Debug, Clone, Copy)]
pub struct Joint {
    pub slides: bool,
    /// Revolute joint: 1 if it turns to the left, -1 if to the right. Prismatic joint: the angle of its direction.
    pub way: f64,
    /// Least and greatest value. `None` if the joint is continuous.
    pub range: Option<V>,
}

/// A solid of the URDF, in its coordinates.
#[derive(Debug, Clone, Copy)]
pub struct Solid {
    pub kind: Kind,
    pub at: [f64; 3],
    pub rpy: [f64; 3],
}

#[derive(Debug, Clone, Copy)]
pub enum Kind {
    Box([f64; 3]),
    Cylinder(V),
    Capsule(V),
    Sphere(f64),
}

#[derive(Debug, Clone)]
pub struct Obstacle {
    pub outline: Outline,
    pub at: V,
    pub angle: f64,
    pub height: Option<V>,
}

#[derive(Debug, Clone)]
pub enum Outline {
    Rings(Vec<Vec<V>>),
    Polyline(Vec<V>),
    Circle(V, f64),
}

impl Drawn {
    /// Draws an arm of a kind, 0 to 3: RR, RP, PR, PP. The caller chooses the start and the goal.
    pub fn new(dice: &mut Dice, kind: u64) -> Self {
        let scale = 10_f64.powf(dice.within(-3.0, 3.0));
        let plane = dice.below(3);
        let joint = |dice: &mut Dice, slides: bool| {
            let (lower, upper) = (dice.within(-0.9, 0.1) * scale, dice.within(0.3, 1.2) * scale);
            let turns = [dice.within(-3.3, -0.5), dice.within(0.5, 3.3)];
            let way = if dice.chance(0.7) { 1.0 } else { -1.0 };
            let direction = if dice.chance(0.3) { FRAC_PI_2 } else { dice.within(-PI, PI) };
            match slides {
                true => Joint { slides, way: direction, range: Some([lower, upper]) },
                false => Joint { slides, way, range: dice.chance(0.6).then_some(turns) },
            }
        };
        let joints = [joint(dice, kind >= 2), joint(dice, kind % 2 == 1)];
        let length = dice.within(0.3, 1.0) * scale;
        let aside = if dice.chance(0.5) { 0.0 } else { dice.within(-0.2, 0.2) * scale };
        let base = if dice.chance(0.5) { [0.0; 2] } else { [dice.within(-1.0, 1.0) * scale, 0.3 * scale] };
        let heights = [dice.within(-0.1, 0.1) * scale, dice.within(0.0, 0.2) * scale];
        let solids = [0, 1].map(|_| (0..1 + dice.below(2)).map(|_| solid(dice, plane, length, scale)).collect());
        let reach = 2.2 * length;
        let obstacles = (0..1 + dice.below(5)).map(|_| obstacle(dice, base, reach, scale)).collect();
        let is_placed = dice.chance(0.3);
        // The tilts have their own dice, so that all other draws stay unchanged.
        let mut own = Dice::new(scale.to_bits());
        let tilts = if own.chance(0.3) { [0, 1].map(|_| own.within(-4e-4, 4e-4)) } else { [0.0; 2] };
        let tip = [dice.within(0.2, 1.0) * length, if dice.chance(0.7) { 0.0 } else { 0.1 * length }];
        Self {
            plane,
            joints,
            origins: [base, [length, aside]],
            heights,
            solids,
            visual: dice.chance(0.15),
            tilts,
            tip: dice.chance(0.8).then_some(if dice.chance(0.2) { [length, 0.0] } else { tip }),
            at: if is_placed { [dice.within(-3.0, 3.0) * scale, dice.within(-3.0, 3.0) * scale] } else { [0.0; 2] },
            angle: if is_placed { dice.within(-4.0, 4.0) } else { 0.0 },
            obstacles,
            clearance: if dice.chance(0.25) { dice.within(0.0, 0.05) * scale } else { 0.0 },
            start: [0.0; 2],
            goal: Goal::Joints([0.0; 2]),
            scale,
        }
    }

    /// Returns the scene of the arm among its obstacles. `None` if the arm is impossible: slides along one line, and the like.
    pub fn scene(&self) -> Option<Scene> {
        scene_of_texts(&self.urdf(), &self.world(false)).ok().map(|loaded| loaded.scene)
    }

    /// Draws a configuration that is farther from obstacles than the clearance by this distance.
    pub fn free(&self, dice: &mut Dice, scene: &Scene, room: f64) -> Option<V> {
        (0..TRIES).find_map(|_| {
            let q = self.joints.map(|joint| {
                let [low, high] = joint.range.unwrap_or([-3.2, 3.2]);
                dice.within(low, high)
            });
            (scene.clearance(q.into()) > scene.workspace().clearance + room).then_some(q)
        })
    }

    pub fn has_oblique_cylinder(&self) -> bool {
        let is_oblique = |solid: &Solid| matches!(solid.kind, Kind::Cylinder(_)) && solid.rpy.iter().all(|a| *a != 0.0);
        self.solids.iter().flatten().any(is_oblique)
    }

    /// Returns a vector of the plane and a height in the coordinates of the URDF.
    fn xyz(&self, [u, v]: V, n: f64) -> String {
        let mut xyz = [0.0; 3];
        for (axis, value) in PLANES[self.plane].0.into_iter().zip([u, v, n]) {
            xyz[axis] = value;
        }
        spaced(&xyz)
    }

    pub fn urdf(&self) -> String {
        let mut text = "<robot name=\"drawn\">\n<link name=\"base\"/>\n".to_owned();
        let names = ["base", "upper", "fore"];
        for k in 0..2 {
            let Joint { slides, way, range } = self.joints[k];
            let axis = if slides {
                self.xyz([way.cos(), way.sin()], self.tilts[k])
            } else {
                self.xyz([0.6 * self.tilts[k], -0.8 * self.tilts[k]], way * PLANES[self.plane].1)
            };
            let kind = if slides { "prismatic" } else { range.map_or("continuous", |_| "revolute") };
            let limit = range.map_or(String::new(), |[lower, upper]| {
                format!("<limit lower=\"{lower:?}\" upper=\"{upper:?}\" velocity=\"1\" effort=\"1\"/>")
            });
            let origin = self.xyz(self.origins[k], self.heights[k]);
            let (parent, child) = (names[k], names[k + 1]);
            let _ = writeln!(
                text,
                "<joint name=\"j{k}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>\
                 <origin xyz=\"{origin}\"/><axis xyz=\"{axis}\"/>{limit}</joint>\n<link name=\"{child}\">"
            );
            let tag = if self.visual { "visual" } else { "collision" };
            for solid in &self.solids[k] {
                let geometry = match solid.kind {
                    Kind::Box(size) => format!("<box size=\"{}\"/>", spaced(&size)),
                    Kind::Cylinder([radius, length]) => {
                        format!("<cylinder radius=\"{radius:?}\" length=\"{length:?}\"/>")
                    }
                    Kind::Capsule([radius, length]) => {
                        format!("<capsule radius=\"{radius:?}\" length=\"{length:?}\"/>")
                    }
                    Kind::Sphere(radius) => format!("<sphere radius=\"{radius:?}\"/>"),
                };
                let (xyz, rpy) = (spaced(&solid.at), spaced(&solid.rpy));
                let _ = writeln!(
                    text,
                    "<{tag}><origin xyz=\"{xyz}\" rpy=\"{rpy}\"/><geometry>{geometry}</geometry></{tag}>"
                );
            }
            text += "</link>\n";
        }
        if let Some(tip) = self.tip {
            let xyz = self.xyz(tip, 0.0);
            let _ = writeln!(
                text,
                "<link name=\"tool\"/><joint name=\"t\" type=\"fixed\"><parent link=\"fore\"/><child link=\"tool\"/>\
                 <origin xyz=\"{xyz}\"/></joint>"
            );
        }
        text + "</robot>\n"
    }

    /// Returns the world file, with or without start and goal.
    pub fn world(&self, has_ends: bool) -> String {
        let mut text = format!("clearance = {:?}\n", self.clearance);
        if has_ends {
            let _ = writeln!(text, "start.joints = {:?}", self.start);
            let _ = match self.goal {
                Goal::Joints(goal) => writeln!(text, "goal.joints = {goal:?}"),
                Goal::Tip(tip) => writeln!(text, "goal.tip = {tip:?}"),
            };
        }
        // The oracle knows only obstacles of the world; `own_bodies` attacks the robot's own body.
        text += "robot.own_body = false\n";
        if (self.at, self.angle) != ([0.0; 2], 0.0) {
            let _ = writeln!(text, "robot.at = {:?}\nrobot.angle = {:?}", self.at, self.angle);
        }
        for Obstacle { outline, at, angle, height } in &self.obstacles {
            let _ = writeln!(text, "[[obstacle]]\nat = {at:?}\nangle = {angle:?}");
            if let Some(height) = height {
                let _ = writeln!(text, "height = {height:?}");
            }
            let _ = match outline {
                Outline::Rings(rings) => writeln!(text, "polygon = {rings:?}"),
                Outline::Polyline(points) => writeln!(text, "polyline = {points:?}"),
                Outline::Circle(center, radius) => {
                    writeln!(text, "circle = {{ center = {center:?}, radius = {radius:?} }}")
                }
            };
        }
        text
    }
}

fn spaced(numbers: &[f64]) -> String {
    numbers.iter().map(|n| format!("{n:?}")).collect::<Vec<_>>().join(" ")
}

/// Draws a bar along the plane's first coordinate, an upright or oblique one, or a ball.
fn solid(dice: &mut Dice, plane: usize, length: f64, scale: f64) -> Solid {
    let width = dice.within(0.02, 0.12) * scale;
    let axes = PLANES[plane].0;
    let mut at = [0.0; 3];
    at[axes[0]] = length / 2.0;
    if dice.chance(0.3) {
        at[axes[1]] = dice.within(-0.2, 0.2) * scale;
        at[axes[2]] = dice.within(-0.2, 0.2) * scale;
    }
    let along = if plane == 2 { [-FRAC_PI_2, 0.0, 0.0] } else { [0.0, FRAC_PI_2, 0.0] };
    let any = [0, 1, 2].map(|_| dice.within(-2.0, 2.0));
    match dice.below(8) {
        0..=3 => {
            let mut size = [width; 3];
            size[axes[0]] = length;
            let rpy = if dice.chance(0.3) { any.map(|angle| 0.2 * angle) } else { [0.0; 3] };
            Solid { kind: Kind::Box(size), at, rpy }
        }
        4 => Solid { kind: Kind::Cylinder([width, length]), at, rpy: along },
        5 => Solid { kind: Kind::Cylinder([2.0 * width, length]), at, rpy: any },
        6 => Solid { kind: Kind::Capsule([width, length]), at, rpy: along },
        _ => Solid { kind: Kind::Sphere(2.0 * width), at, rpy: [0.0; 3] },
    }
}

fn obstacle(dice: &mut Dice, base: V, reach: f64, scale: f64) -> Obstacle {
    let (angle, radius) = (dice.within(-PI, PI), reach * dice.within(0.05, 1.0).sqrt());
    let place = [base[0] + radius * angle.cos(), base[1] + radius * angle.sin()];
    let is_placed = dice.chance(0.3);
    let (at, center) = if is_placed { (place, [0.0; 2]) } else { ([0.0; 2], place) };
    let size = dice.within(0.05, 0.8) * scale;
    let about = |x: f64, y: f64| [center[0] + x * size, center[1] + y * size];
    let around = |n: u64, turn: f64, flat: f64| -> Vec<V> {
        (0..n).map(|k| turn + TAU * k as f64 / n as f64).map(|t| about(t.cos(), flat * t.sin())).collect()
    };
    let outline = match dice.below(7) {
        0 | 1 => {
            let far = dice.within(1.0, 3.0);
            let (s, c) = (angle + dice.within(-0.7, 0.7)).sin_cos();
            Outline::Polyline(vec![about(-0.3 * c, -0.3 * s), about(far * c, far * s)])
        }
        2 => Outline::Polyline((0..4).map(|_| about(dice.within(-1.0, 1.0), dice.within(-1.0, 1.0))).collect()),
        3 => Outline::Circle(center, size / 2.0),
        4 => Outline::Rings(vec![around(3 + dice.below(5), dice.within(0.0, TAU), dice.within(0.2, 1.0))]),
        5 => Outline::Rings(vec![
            [[0, 0], [3, 0], [3, 1], [1, 1], [1, 3], [0, 3]]
                .map(|[x, y]| about(f64::from(x) / 3.0, f64::from(y) / 3.0))
                .to_vec(),
        ]),
        _ => {
            let hole = around(4, 0.3, 1.0).into_iter();
            let shrunk = |[x, y]: V| [center[0] + 0.6 * (x - center[0]), center[1] + 0.6 * (y - center[1])];
            Outline::Rings(vec![around(5, 0.0, 1.0), hole.map(shrunk).collect()])
        }
    };
    let height = dice.chance(0.2).then_some([-0.05 * scale, dice.within(0.0, 0.2) * scale]);
    Obstacle { outline, at, angle: if is_placed { dice.within(-PI, PI) } else { 0.0 }, height }
}
