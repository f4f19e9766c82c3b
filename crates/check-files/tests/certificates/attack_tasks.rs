//! Compares random certificates of tasks with a floating-point oracle that shares no code with the checker. The oracle
//! repeats the steps with its own kinematics, and densely samples every motion and turn. A certificate that holds must
//! be right up to a small margin. A certificate that is right by more than the margin must hold. There are honest
//! certificates, falsified ones, and arbitrary ones.

use crate::common::plane::{P, bar, links, minus, plus, tip, turned};
use crate::common::robots::{LIMIT, two_bars};
use crate::common::verdict::done;
use cplan_cases as random;
use cplan_cases::dice::Dice;
use cplan_check_files::{CheckError, check};
use std::fmt::Write;

/// Number of samples of a motion or a turn.
const SAMPLES: u32 = 300;

/// Greatest margin, in either direction, at which the oracle does not decide whether a claim is true.
const HAIR: f64 = 2e-3;

/// Maximum error at the ends, and maximum penetration of supports: 1e-4 of a reach of 1.8 m, measured to the corners of
/// the bar.
const MISSED: f64 = 1e-5;
const PRESSED: f64 = 1.8016e-4;

/// A position and an orientation.
#[derive(Clone, Copy, Debug)]
struct Pose {
    at: P,
    angle: f64,
}

impl Pose {
    fn of(self, p: P) -> P {
        plus(self.at, turned(p, self.angle))
    }

    fn compose(self, inner: Pose) -> Pose {
        Pose { at: self.of(inner.at), angle: self.angle + inner.angle }
    }

    fn relative_to(self, other: Pose) -> Pose {
        Pose { at: turned(minus(other.at, self.at), -self.angle), angle: other.angle - self.angle }
    }
}

/// A convex shape: corners and a radius.
#[derive(Clone, Debug)]
struct Shape {
    corners: Vec<P>,
    radius: f64,
}

impl Shape {
    fn at(&self, pose: Pose) -> Shape {
        Shape { corners: self.corners.iter().map(|p| pose.of(*p)).collect(), radius: self.radius }
    }

    fn text(&self) -> String {
        match self.corners[..] {
            [center] => format!("circle = {{ center = {center:?}, radius = {:?} }}", self.radius),
            [_, _] => format!("polyline = {:?}", self.corners),
            _ => format!("polygon = {:?}", self.corners),
        }
    }

    /// Makes a disc, a wall, or a polygon with some corners on a circle.
    fn random(dice: &mut Dice, size: f64, walls: bool) -> Shape {
        let around = |dice: &mut Dice, n: u32| {
            let first = dice.within(0.0, 6.0);
            let corner =
                |k: u32| turned([size * 1.2, 0.0], first + std::f64::consts::TAU * f64::from(k) / f64::from(n));
            Shape { corners: (0..n).map(corner).collect(), radius: 0.0 }
        };
        match dice.below(if walls { 4 } else { 3 }) {
            0 => Shape { corners: vec![[0.0, 0.0]], radius: size },
            1 => around(dice, 3),
            2 => around(dice, 4),
            _ => around(dice, 2),
        }
    }
}

/// Returns the signed distance of convex shapes. It is the greatest gap over the normals of their sides and the
/// directions from corner to corner.
fn distance(a: &Shape, b: &Shape) -> f64 {
    let mut normals = Vec::new();
    for shape in [a, b] {
        let n = shape.corners.len();
        normals.extend((0..n).map(|k| {
            let [x, y] = minus(shape.corners[(k + 1) % n], shape.corners[k]);
            [y, -x]
        }));
    }
    normals.extend(a.corners.iter().flat_map(|p| b.corners.iter().map(|q| minus(*q, *p))));
    let apart = |n: P| {
        let size = n[0].hypot(n[1]);
        let along = |p: &P| (p[0] * n[0] + p[1] * n[1]) / size;
        let most =
            |shape: &Shape, sign: f64| shape.corners.iter().map(|p| sign * along(p)).fold(f64::NEG_INFINITY, f64::max);
        if size < 1e-12 {
            f64::NEG_INFINITY
        } else {
            [1.0, -1.0].map(|s| -most(b, -s) - most(a, s)).into_iter().fold(f64::NEG_INFINITY, f64::max)
        }
    };
    normals.into_iter().map(apart).fold(f64::NEG_INFINITY, f64::max) - a.radius - b.radius
}

/// Uniform straight motion from one time and pose to the next, and then at a constant velocity.
#[derive(Clone, Debug)]
struct ObstacleTrajectory {
    stops: Vec<(f64, Pose)>,
    velocity: P,
}

impl ObstacleTrajectory {
    fn still(pose: Pose) -> ObstacleTrajectory {
        ObstacleTrajectory { stops: vec![(0.0, pose)], velocity: [0.0; 2] }
    }

    fn at(&self, time: f64) -> Pose {
        let after = self.stops.iter().position(|(stop, _)| *stop > time).unwrap_or(self.stops.len());
        let (begin, from) = self.stops[after.saturating_sub(1)];
        match self.stops.get(after) {
            _ if after == 0 => from,
            None => Pose { at: [0, 1].map(|k| from.at[k] + self.velocity[k] * (time - begin)), ..from },
            Some((end, to)) => {
                let between = |from: f64, to: f64| from + (to - from) * (time - begin) / (end - begin);
                let at = [0, 1].map(|k| between(from.at[k], to.at[k]));
                Pose { at, angle: between(from.angle, to.angle) }
            }
        }
    }

    fn text(&self) -> String {
        let stop =
            |(time, Pose { at, angle }): &(f64, Pose)| format!("{{ time = {time:?}, at = {at:?}, angle = {angle:?} }}");
        let stops: Vec<String> = self.stops.iter().map(stop).collect();
        format!("motion = {{ stops = [{}], velocity = {:?} }}", stops.join(", "), self.velocity)
    }

    /// Makes a random motion that passes a pose at a time.
    fn past(dice: &mut Dice, time: f64, pose: Pose, turns: bool) -> ObstacleTrajectory {
        let velocity = turned([dice.within(0.0, 0.6), 0.0], dice.within(-3.0, 3.0));
        let spin = if turns && dice.chance(0.5) { dice.within(-1.0, 1.0) } else { 0.0 };
        let then = |at: f64| Pose {
            at: [0, 1].map(|k| pose.at[k] + velocity[k] * (at - time)),
            angle: pose.angle + spin * (at - time),
        };
        let from = dice.within(0.0, 2.0);
        match dice.below(if spin == 0.0 { 2 } else { 1 }) {
            0 => {
                let until = from.max(time) + dice.within(0.5, 9.0);
                ObstacleTrajectory {
                    stops: [from.min(time), until].map(|at| (at, then(at))).to_vec(),
                    velocity: [0.0; 2],
                }
            }
            _ => ObstacleTrajectory { stops: vec![(0.0, then(0.0))], velocity },
        }
    }
}

#[derive(Clone, Debug)]
enum Action {
    Pick(usize),
    Place(P, Option<f64>),
    Move(P),
}

#[derive(Clone, Debug)]
struct Object {
    shape: Shape,
    at: Pose,
    /// Its motion until it is picked, if it moves.
    trajectory: Option<ObstacleTrajectory>,
    is_level: bool,
    /// True if it may touch the first obstacle.
    rests: bool,
}

/// A world, and a claim about it.
#[derive(Clone, Debug)]
struct Claim {
    obstacles: Vec<Shape>,
    movers: Vec<(Shape, ObstacleTrajectory)>,
    objects: Vec<Object>,
    clearance: f64,
    start: P,
    actions: Vec<Action>,
    is_free: bool,
    /// The executed steps. Each has its number, the knots of its path to the end of the motion, and the turn after it.
    steps: Vec<(usize, Vec<P>, Option<f64>)>,
}

fn poses(q: P) -> [Pose; 2] {
    links(q).map(|(at, angle)| Pose { at, angle })
}

impl Claim {
    /// Returns a claim with random starts and targets of objects. They are carried straight in joint space, or past a
    /// knot or two beside the line.
    fn random(dice: &mut Dice) -> Claim {
        let q = |dice: &mut Dice| [dice.within(-2.0, 2.0), dice.within(-2.5, 2.5)];
        let start = q(dice);
        let is_free = dice.chance(0.3);
        let (mut objects, mut actions, mut steps, mut from) = (Vec::new(), Vec::new(), Vec::new(), start);
        let mut way = |dice: &mut Dice, to: P| {
            let mut knots = vec![from];
            if dice.chance(0.3) {
                knots.push([0, 1].map(|k| (from[k] + to[k]) / 2.0 + dice.within(-0.2, 0.2)));
            }
            knots.push(to);
            from = to;
            knots
        };
        let count = 1 + dice.below(2_usize);
        for object in 0..count {
            let ends = [q(dice), q(dice)];
            let at = Pose { at: tip(ends[0]), angle: dice.within(-3.0, 3.0) };
            let is_level = dice.chance(0.5);
            let (size, rests) = (dice.within(0.02, 0.1), dice.chance(0.3));
            objects.push(Object { shape: Shape::random(dice, size, false), at, trajectory: None, is_level, rests });
            let turn = (is_level && dice.chance(0.4)).then(|| dice.within(-3.0, 3.0));
            let angle = turn.map(|turn| at.angle + turn);
            actions.extend([Action::Pick(object), Action::Place(tip(ends[1]), angle)]);
            let early = dice.chance(0.5);
            steps.push((2 * object + 1, way(dice, ends[0]), turn.filter(|_| early)));
            steps.push((2 * object + 2, way(dice, ends[1]), turn.filter(|_| !early)));
        }
        if !is_free && dice.chance(0.5) {
            let to = q(dice);
            actions.push(Action::Move(to));
            steps.push((actions.len(), way(dice, to), None));
        }
        let obstacle = |dice: &mut Dice| {
            let pose = Pose { at: turned([dice.within(0.4, 2.0), 0.0], dice.within(-3.1, 3.1)), angle: 0.0 };
            let size = dice.within(0.02, 0.15);
            Shape::random(dice, size, true).at(pose)
        };
        let obstacles = (0..1 + dice.below(3)).map(|_| obstacle(dice)).collect();
        let clearance = if dice.chance(0.3) { dice.within(0.0, 0.03) } else { 0.0 };
        Claim { obstacles, movers: Vec::new(), objects, clearance, start, actions, is_free, steps }
    }

    /// Returns the earliest time at which the motion of each step begins: knots are a second apart, and the arm rests
    /// for a second between steps.
    fn begins(&self) -> Vec<f64> {
        let mut time = 0.0;
        let begin = |(_, way, _): &(usize, Vec<P>, Option<f64>)| {
            time += way.len() as f64;
            time - way.len() as f64
        };
        self.steps.iter().map(begin).collect()
    }

    /// Makes some objects arrive on their own trajectories, and adds moving obstacles. In such a world the wrist turns
    /// nothing.
    fn set_in_motion(&mut self, dice: &mut Dice) {
        let picked: Vec<f64> =
            self.begins().iter().zip(&self.steps).map(|(begin, (_, way, _))| begin + way.len() as f64 - 1.0).collect();
        for (number, _, turn) in &mut self.steps {
            *turn = None;
            if let Action::Place(_, angle) = &mut self.actions[*number - 1] {
                *angle = None;
            }
        }
        for (time, (number, ..)) in picked.iter().zip(&self.steps) {
            if let Action::Pick(object) = self.actions[number - 1]
                && dice.chance(0.5)
            {
                let object = &mut self.objects[object];
                object.trajectory = Some(ObstacleTrajectory::past(dice, *time, object.at, !object.is_level));
            }
        }
        for _ in 0..1 + dice.below(2) {
            let pose = Pose { at: turned([dice.within(0.4, 1.9), 0.0], dice.within(-3.1, 3.1)), angle: 0.0 };
            let (size, time) = (dice.within(0.02, 0.2), dice.within(0.0, 8.0));
            self.movers.push((Shape::random(dice, size, true), ObstacleTrajectory::past(dice, time, pose, true)));
        }
    }

    /// Returns the claim with one change, large or small.
    fn falsified(&self, dice: &mut Dice) -> Claim {
        let mut other = self.clone();
        let size = 10_f64.powf(dice.within(-9.0, -0.5));
        let n = other.steps.len();
        let step = dice.below(n);
        match dice.below(if other.movers.is_empty() { 9 } else { 12 }) {
            0 => drop(other.steps.remove(step)),
            1 => other.steps.swap(step, dice.below(n)),
            2 => other.steps[step].0 = 1 + dice.below(n),
            3 => {
                // The next path begins where this one ends.
                let by = [dice.within(-size, size), dice.within(-size, size)];
                let last = other.steps[step].1.len() - 1;
                other.steps[step].1[last] = plus(other.steps[step].1[last], by);
                if let Some((_, knots, _)) = other.steps.get_mut(step + 1) {
                    knots[0] = plus(knots[0], by);
                }
            }
            4 => other.steps[step].1[0][0] += size,
            // Another place, an earlier or later time, or a turn of the wrist.
            9 | 10 => {
                let moving = other.objects.iter_mut().filter_map(|object| object.trajectory.as_mut());
                let mut trajectories: Vec<&mut ObstacleTrajectory> =
                    other.movers.iter_mut().map(|(_, trajectory)| trajectory).chain(moving).collect();
                let k = dice.below(trajectories.len());
                let sign = if dice.chance(0.5) { 1.0 } else { -1.0 };
                let along = dice.below(2_usize);
                for (time, pose) in &mut trajectories[k].stops {
                    if dice.chance(0.5) {
                        pose.at[along] += sign * size;
                    } else {
                        *time += size;
                    }
                }
                trajectories[k].stops.sort_by(|a, b| a.0.total_cmp(&b.0));
            }
            11 => other.movers[0].1.velocity[0] += size,
            5 => other.steps[step].2 = Some(dice.within(-3.0, 3.0)),
            6 => other.steps[step].2 = other.steps[step].2.map(|turn| turn + size),
            7 => {
                let object = dice.below(other.objects.len());
                other.objects[object].at.at[dice.below(2_usize)] += size;
            }
            _ => other.objects[0].at.angle += size,
        }
        other
    }

    fn world(&self) -> String {
        let mut text = format!(
            "clearance = {:?}\nrobot.wrist = {{ velocity = 1.0 }}\nstart.joints = {:?}\n{}",
            self.clearance,
            self.start,
            if self.is_free { "task.order = \"free\"\n" } else { "" }
        );
        for obstacle in &self.obstacles {
            let _ = writeln!(text, "[[obstacle]]\n{}", obstacle.text());
        }
        for (shape, trajectory) in &self.movers {
            let _ = writeln!(text, "[[obstacle]]\n{}\n{}", shape.text(), trajectory.text());
        }
        for (number, Object { shape, at, trajectory, is_level, rests }) in self.objects.iter().enumerate() {
            let payload = if *is_level { "level" } else { "rigid" };
            let supports = if *rests { "\nsupports = [\"obstacle 1\"]" } else { "" };
            let Pose { at, angle } = at;
            let _ = writeln!(
                text,
                "[[object]]\nname = \"o{number}\"\n{}\nat = {at:?}\nangle = {angle:?}\npayload = \"{payload}\"{supports}",
                shape.text()
            );
            if let Some(trajectory) = trajectory {
                let _ = writeln!(text, "{}", trajectory.text());
            }
        }
        for action in &self.actions {
            let _ = match action {
                Action::Pick(object) => writeln!(text, "[[step]]\npick = \"o{object}\""),
                Action::Place(at, None) => writeln!(text, "[[step]]\nplace = {{ at = {at:?} }}"),
                Action::Place(at, Some(angle)) => {
                    writeln!(text, "[[step]]\nplace = {{ at = {at:?}, angle = {angle:?} }}")
                }
                Action::Move(q) => writeln!(text, "[[step]]\nmove = {{ joints = {q:?} }}"),
            };
        }
        text
    }

    fn certificate(&self) -> String {
        let (mut knots, mut steps) = (Vec::new(), Vec::new());
        for (number, way, turn) in &self.steps {
            let (first, last) = (knots.len(), knots.len() + way.len() - 1);
            for q in way {
                knots.push(format!("[{}, {:?}, {:?}]", knots.len(), q[0], q[1]));
            }
            let turn = turn.map_or(String::new(), |turn| format!(", \"turn\": {turn:?}"));
            steps.push(format!("{{\"step\": {number}, \"knots\": [{first}, {last}]{turn}}}"));
        }
        done(&knots.join(", "), &steps.join(", "))
    }

    /// Returns the least distance in excess of the required one, metres. If it is negative, the claim is false. It is
    /// minus infinity if an object is missing or not at its place.
    fn margin(&self) -> f64 {
        let wrong = f64::NEG_INFINITY;
        let mut margin = f64::INFINITY;
        let at_first =
            |object: &Object| Some(object.trajectory.clone().unwrap_or(ObstacleTrajectory::still(object.at)));
        let mut lies: Vec<Option<ObstacleTrajectory>> = self.objects.iter().map(at_first).collect();
        let mut held: Option<(usize, Pose)> = None;
        let mut released = None;
        let mut at = self.start;
        let mut left: Vec<usize> = (1..=self.actions.len()).collect();
        let pose = |object: usize, grip: Pose, q: P| match self.objects[object].is_level {
            true => Pose { at: tip(q), angle: 0.0 }.compose(grip),
            false => poses(q)[1].compose(grip),
        };
        // Distance of a payload from things that it must not touch.
        let carried = |object: usize, pose: Pose, time: f64, lies: &[Option<ObstacleTrajectory>]| {
            let own = self.objects[object].shape.at(pose);
            let fixed = self.obstacles.iter().enumerate().map(|(k, obstacle)| {
                let apart = distance(&own, obstacle);
                if k == 0 && self.objects[object].rests { apart + PRESSED } else { apart - self.clearance }
            });
            let others =
                self.objects.iter().zip(lies).filter_map(|(other, on)| Some(other.shape.at(on.as_ref()?.at(time))));
            let others = others.chain(self.movers.iter().map(|(shape, trajectory)| shape.at(trajectory.at(time))));
            fixed.chain(others.map(|other| distance(&own, &other) - self.clearance)).fold(f64::INFINITY, f64::min)
        };
        let scene = |q: P,
                     time: f64,
                     held: &Option<(usize, Pose)>,
                     lies: &[Option<ObstacleTrajectory>],
                     allowed: [Option<usize>; 2]| {
            let mut least = f64::INFINITY;
            for (link, pose) in poses(q).into_iter().enumerate() {
                let own = Shape { corners: bar(link).to_vec(), radius: 0.0 }.at(pose);
                for obstacle in &self.obstacles {
                    least = least.min(distance(&own, obstacle) - self.clearance);
                }
                for (shape, trajectory) in &self.movers {
                    least = least.min(distance(&own, &shape.at(trajectory.at(time))) - self.clearance);
                }
                for (other, on) in lies.iter().enumerate() {
                    if let Some(on) = on.as_ref().filter(|_| link == 0 || !allowed.contains(&Some(other))) {
                        least = least.min(distance(&own, &self.objects[other].shape.at(on.at(time))) - self.clearance);
                    }
                }
            }
            held.map_or(least, |(object, grip)| least.min(carried(object, pose(object, grip, q), time, lies)))
        };
        let any_moves = |lies: &[Option<ObstacleTrajectory>]| {
            !self.movers.is_empty() || lies.iter().flatten().any(|on| on.stops.len() > 1 || on.velocity != [0.0; 2])
        };
        let begins = self.begins();
        for (index, (number, way, turn)) in self.steps.iter().enumerate() {
            // Pairs in any order, or all steps in their own order.
            let is_next = match (self.is_free, held) {
                (true, None) => left.contains(number) && number % 2 == 1,
                (true, Some((object, _))) => *number == 2 * object + 2,
                _ => left.first() == Some(number),
            };
            if !is_next || minus(way[0], at).iter().any(|off| off.abs() > if index == 0 { MISSED } else { 0.0 }) {
                return wrong;
            }
            left.retain(|other| other != number);
            let action = &self.actions[number - 1];
            let target = if let Action::Pick(object) = action { Some(*object) } else { None };
            let begin = begins[index];
            // Before the motion, the arm rests where the last step left it.
            let stands = [if index == 0 { way[0] } else { at }, way[0]];
            for (number, piece) in [&stands[..]].into_iter().chain(way.windows(2)).enumerate() {
                for k in 0..=SAMPLES {
                    let t = f64::from(k) / f64::from(SAMPLES);
                    let q = [0, 1].map(|k| piece[0][k] + t * (piece[1][k] - piece[0][k]));
                    if q.iter().any(|q| q.abs() > LIMIT) {
                        return wrong;
                    }
                    let time = (begin + number as f64 - 1.0 + t).max(0.0);
                    margin = margin.min(scene(q, time, &held, &lies, [target, released]));
                }
            }
            at = way[way.len() - 1];
            let time = begin + way.len() as f64 - 1.0;
            let before = released;
            if let Action::Pick(object) = action {
                let Some(lying) = lies[*object].take().map(|on| on.at(time)) else { return wrong };
                if minus(tip(at), lying.at).iter().fold(0.0, |a: f64, b| a.hypot(*b)) > MISSED {
                    return wrong;
                }
                let from = if self.objects[*object].is_level { Pose { at: tip(at), angle: 0.0 } } else { poses(at)[1] };
                held = Some((*object, from.relative_to(lying)));
                released = None;
            }
            if let Some(by) = turn {
                if any_moves(&lies) {
                    return wrong;
                }
                // An object keeps its orientation if its place requires none.
                let may_turn = |object: usize| {
                    self.objects[object].is_level && matches!(self.actions[2 * object + 1], Action::Place(_, Some(_)))
                };
                let Some((object, grip)) = held.as_mut().filter(|(object, _)| may_turn(*object)) else {
                    return wrong;
                };
                let of = |angle: f64| Pose { at: [0.0, 0.0], angle }.compose(*grip);
                for k in 0..=SAMPLES {
                    let angle = by * f64::from(k) / f64::from(SAMPLES);
                    margin = margin.min(carried(*object, pose(*object, of(angle), at), time, &lies));
                }
                *grip = of(*by);
            }
            match action {
                Action::Pick(_) => {}
                Action::Place(to, angle) => {
                    let Some((object, grip)) = held.take() else { return wrong };
                    let lying = pose(object, grip, at);
                    let off = angle.map_or(0.0, |angle| 2.0 * ((lying.angle - angle) / 2.0).sin().abs());
                    if minus(lying.at, *to).iter().fold(0.0, |a: f64, b| a.hypot(*b)).max(off) > MISSED {
                        return wrong;
                    }
                    (lies[object], released) = (Some(ObstacleTrajectory::still(lying)), Some(object));
                }
                Action::Move(to) => {
                    if minus(at, *to).iter().any(|off| off.abs() > MISSED) {
                        return wrong;
                    }
                    released = None;
                }
            }
            if index + 1 == self.steps.len() {
                margin = margin.min(scene(at, time, &held, &lies, [before, released]));
            }
        }
        if left.is_empty() { margin } else { wrong }
    }
}

#[test]
fn exactly_the_true_certificates_hold() {
    check_random_claims(false);
}

#[test]
fn exactly_the_true_certificates_in_time_hold() {
    check_random_claims(true);
}

fn check_random_claims(in_time: bool) {
    let (mut all, mut right, mut false_ones, mut still_true) = (0, 0, 0, 0);
    for seed in random::seeds(150) {
        let mut dice = Dice::new(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        let mut honest = Claim::random(&mut dice);
        if in_time {
            honest.set_in_motion(&mut dice);
        }
        let margin = honest.margin();
        // Most random claims collide. Judge only some of these.
        if margin < -HAIR && !dice.chance(0.1) {
            continue;
        }
        for round in 0..4 {
            let claim = if round == 0 { honest.clone() } else { honest.falsified(&mut dice) };
            let margin = claim.margin();
            let judged = check(&two_bars(), &claim.world(), &claim.certificate());
            assert!(
                !matches!(judged, Err(CheckError::Input { .. })),
                "seed {seed}, {round}: {judged:?}\n{}",
                claim.world()
            );
            let what =
                || format!("seed {seed}, {round}: {margin} {judged:?}\n{}\n{}", claim.world(), claim.certificate());
            match &judged {
                Ok(_) => assert!(margin > -1e-9, "{}", what()),
                Err(_) => assert!(margin < HAIR, "{}", what()),
            }
            all += 1;
            right += usize::from(round == 0 && judged.is_ok());
            false_ones += usize::from(round > 0 && judged.is_err());
            still_true += usize::from(round > 0 && judged.is_ok());
        }
    }
    println!("{all} certificates: {right} right, {false_ones} falsified and refused, {still_true} true still");
    if random::uses_default_cases() {
        assert!(right > 15 && false_ones > 30 && still_true > 20, "{right} {false_ones} {still_true}");
    }
}
