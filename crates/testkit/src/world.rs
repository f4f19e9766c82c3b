//! Random worlds, determined by a seed: all kinds of arms among touching, thin and pointed obstacles.

use crate::oracle::Oracle;
use crate::problems::motion_problem;
use crate::scenes::placed;
use crate::shapes::{convex, disc, wall};
use cplan::geometry::{Convex, Point, Vector};
use cplan::model::{
    Arm, Growth, Heights, Joint, JointType, Link, MotionProblem, Obstacle, OutlineSource, Part, Scene, SelfObstacle,
    Shape, Workspace,
};
use cplan::space::{Configuration, GoalSet, JointRange};
use cplan_cases::dice::Dice;
use std::f64::consts::{PI, TAU};

/// The four kinds of arms.
pub const KINDS: [&str; 4] = ["RR", "RP", "PR", "PP"];

/// Returns the world of a seed for a kind of arm. `None` if it lacks two free configurations.
pub fn world(kind: &str, seed: u64) -> Option<MotionProblem> {
    drawn(kind, seed, |_, _| Vec::new())
}

/// Returns the same world, with the robot's own links as further obstacles.
pub fn drawn(kind: &str, seed: u64, body: impl Fn(&mut Dice, &Arm) -> Vec<SelfObstacle>) -> Option<MotionProblem> {
    let mut dice = Dice::new(seed.wrapping_mul(0x2545_F491_4F6C_DD1D) ^ u64::from(kind.as_bytes()[0]) << 8);
    let mut arm = arm(&mut dice, kind);
    arm.self_obstacles = body(&mut dice, &arm);
    let clearance = if dice.chance(0.25) { dice.within(0.0, 0.05) } else { 0.0 };
    let reach = arm.reach() + 0.3;
    let count = 5 + dice.below(26);
    let mut obstacles = Vec::new();
    while obstacles.len() < count as usize {
        obstacles.extend(obstacle(&mut dice, reach, arm.base));
    }
    let workspace = Workspace { name: "random".into(), obstacles, clearance, preferences: Vec::new() };
    let scene = placed(arm, workspace);
    let start = free(&mut dice, &scene)?;
    let count = 1 + dice.below(3);
    let goals: Vec<Configuration> = (0..count).filter_map(|_| free(&mut dice, &scene)).collect();
    (!goals.is_empty()).then(|| motion_problem(scene, start, goals.into_iter().collect::<GoalSet>()))
}

fn arm(dice: &mut Dice, kind: &str) -> Arm {
    let mut joint = |which: char| {
        let (motion, axis) = if which == 'R' {
            let sign = if dice.chance(0.3) { -1.0 } else { 1.0 };
            let axis = match dice.below(4) {
                0 | 1 => JointRange::Circle,
                2 => JointRange::Interval { lower: dice.within(-3.0, -0.5), upper: dice.within(0.5, 3.0) },
                _ => JointRange::Interval { lower: dice.within(-2.0 * PI, -PI), upper: dice.within(PI, 1.5 * PI) },
            };
            (JointType::Revolute { sign }, axis)
        } else {
            let angle = if dice.chance(0.3) { dice.below(4) as f64 * PI / 2.0 } else { dice.within(-PI, PI) };
            let direction = Vector::new(angle.cos(), angle.sin());
            let axis = JointRange::Interval { lower: dice.within(-0.9, 0.1), upper: dice.within(0.3, 1.2) };
            (JointType::Prismatic { direction }, axis)
        };
        Joint { name: which.to_string(), joint_type: motion, range: axis, velocity: 1.0, acceleration: 1.0, jerk: None }
    };
    let mut letters = kind.chars();
    let joints = [letters.next().unwrap_or('R'), letters.next().unwrap_or('R')].map(&mut joint);
    let length = dice.within(0.3, 1.0);
    let offset = Vector::new(length, if dice.chance(0.5) { 0.0 } else { dice.within(-0.2, 0.2) });
    let links = [link(dice, "first", length), link(dice, "second", length)];
    let base = if dice.chance(0.5) { Point::zeros() } else { Point::new(dice.within(-1.0, 1.0), 0.3) };
    Arm { name: "random".into(), base, offset, tip: Point::new(0.5, 0.0), ..Arm::new(joints, links, [0.0; 2]) }
}

fn rectangle(x0: f64, x1: f64, y0: f64, y1: f64, radius: f64) -> Convex {
    convex(vec![Point::new(x0, y0), Point::new(x1, y0), Point::new(x1, y1), Point::new(x0, y1)], radius)
}

/// Draws a bar, a hammer, a hook, an offset plate, a capsule, a wire, or an almost empty link.
fn link(dice: &mut Dice, name: &str, length: f64) -> Link {
    let width = dice.within(0.01, 0.08);
    let shapes = match dice.below(7) {
        0 | 1 => vec![rectangle(0.0, length, -width, width, 0.0)],
        2 => vec![
            rectangle(0.0, length, -width, width, 0.0),
            rectangle(length - width, length + width, -3.0 * width, 4.0 * width, 0.0),
        ],
        3 => vec![
            rectangle(-0.1, length, -width, width, 0.0),
            rectangle(length - 0.05, length, width, 0.3, 0.0),
            disc(Point::new(length, 0.3), width),
        ],
        4 => vec![rectangle(0.2, 0.2 + length / 2.0, 0.1, 0.1 + 2.0 * width, 0.0)],
        5 => vec![convex(vec![Point::new(0.0, 0.0), Point::new(length, 0.0)], width)],
        _ if dice.chance(0.5) => vec![wall(Point::new(0.0, 0.0), Point::new(length, 0.1))],
        _ => {
            let radius = if dice.chance(0.5) { 0.0 } else { width };
            vec![disc(Point::new(length, 0.0), radius)]
        }
    };
    let lower = dice.within(0.0, 0.2);
    let parts = shapes
        .into_iter()
        .map(|shape| Part {
            shape,
            inner: None,
            padding: 0.0,
            number: 0,
            is_visual: false,
            heights: Heights { lower, upper: lower + 0.1 },
            body: name.into(),
        })
        .collect();
    Link { name: name.into(), parts, source: OutlineSource::Collision }
}

/// Draws one obstacle, or several that touch.
pub fn obstacle(dice: &mut Dice, reach: f64, base: Point) -> Vec<Obstacle> {
    let (angle, radius) = (dice.within(-PI, PI), reach * dice.within(0.02, 1.0).sqrt());
    let center = base + Vector::new(angle.cos(), angle.sin()) * radius;
    let size = dice.within(0.02, 0.3);
    let polygon = |dice: &mut Dice, center: Point| {
        let n = 3 + dice.below(5);
        let (turn, flat) = (dice.within(0.0, TAU), dice.within(0.2, 1.0));
        let corner = |k| {
            let t = turn + TAU * k as f64 / n as f64;
            center + Vector::new(size * t.cos(), size * flat * t.sin())
        };
        convex((0..n).map(corner).collect(), 0.0)
    };
    let pieces = match dice.below(9) {
        0..=2 => vec![polygon(dice, center)],
        3 => vec![disc(center, size / 2.0)],
        4 => {
            let t = dice.within(0.0, TAU);
            vec![wall(center, center + Vector::new(t.cos(), t.sin()) * 3.0 * size)]
        }
        5 => vec![disc(center, 0.0)],
        6 => {
            // A bent wall.
            let mut corner = || center + Vector::new(dice.within(-size, size), dice.within(-size, size));
            let points: Vec<Point> = (0..4).map(|_| corner()).collect();
            points.windows(2).map(|w| wall(w[0], w[1])).collect()
        }
        7 => {
            // Two walls that leave a passage.
            let gap = dice.within(0.0, 0.15);
            let [x, y] = [center.x, center.y];
            vec![
                rectangle(x, x + size, y + gap, y + gap + size, 0.0),
                rectangle(x, x + size, y - gap - size, y - gap, 0.0),
            ]
        }
        _ => {
            // Lattice squares that share a side and a corner.
            let at = |k: f64| (k * 5.0).round() / 5.0;
            let [x, y] = [at(center.x), at(center.y)];
            vec![
                rectangle(x, x + 0.2, y, y + 0.2, 0.0),
                rectangle(x + 0.2, x + 0.4, y, y + 0.2, 0.0),
                rectangle(x + 0.4, x + 0.6, y + 0.2, y + 0.4, 0.0),
            ]
        }
    };
    let heights = if dice.chance(0.2) { Heights { lower: 0.15, upper: 0.25 } } else { Heights::ALL };
    let obstacle = |piece: Convex| Obstacle {
        name: "o".into(),
        shape: Shape::Polygon(piece.core().to_vec()),
        pieces: vec![piece],
        heights,
        growth: Growth::default(),
    };
    if dice.chance(0.3) {
        vec![Obstacle { pieces: pieces.clone(), ..obstacle(pieces[0].clone()) }]
    } else {
        pieces.into_iter().map(obstacle).collect()
    }
}

/// Draws a free configuration: anywhere, on a limit, beyond a turn, or next to an obstacle.
fn free(dice: &mut Dice, scene: &Scene) -> Option<Configuration> {
    let oracle = Oracle::new(scene);
    let topology = scene.arm().topology();
    let mut blocked = None;
    let mut found = None;
    for _ in 0..200 {
        let q = Configuration::from_fn(|k, _| {
            let (lower, upper) = topology.ranges[k].domain();
            match dice.below(40) {
                0 => lower,
                1 => upper,
                _ => dice.within(lower, upper),
            }
        });
        if oracle.room(q) <= 1e-9 {
            blocked = Some(q);
        } else if found.is_none() {
            found = Some(q);
        }
        if found.is_some() && (blocked.is_some() || dice.chance(0.5)) {
            break;
        }
    }
    let mut q = found?;
    if let Some(mut far) = blocked.filter(|_| dice.chance(0.3)) {
        // Bisects towards the obstacle, to a room that is drawn from 1e-6 to 1e-2.
        let near = 10_f64.powf(dice.within(-6.0, -2.0));
        for _ in 0..60 {
            let middle = (q + far) / 2.0;
            if oracle.room(middle) > near { q = middle } else { far = middle }
        }
    }
    for k in 0..2 {
        if topology.ranges[k].is_circle() && dice.chance(0.1) {
            q[k] += TAU * (dice.below(5) as f64 - 2.0);
        }
    }
    (oracle.room(q) > 1e-9).then_some(q)
}
