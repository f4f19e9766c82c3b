//! The arm among its obstacles by brute force, with its own kinematics and distances. It shares no code with the library, except
//! the types of its input.

use crate::solid::{Solid, V, add, dot, norm, rotate, sub};
use cplan::model::{Carrier, JointType, Scene};
use cplan::space::{Configuration, Path};

/// A part of a link and the obstacles that it can hit.
struct MovingObstacle {
    /// Index of the link, 0 or 1. The index 2 stands for link 2 with joint 1 at zero, which can hit obstacles on link 1.
    link: usize,
    solid: Solid,
    obstacles: Vec<u16>,
    /// Bounds on the speed of the part's points, per unit of each joint's speed.
    speed: V,
}

/// A moving part and an obstacle, given by their numbers.
pub type Meeting = (u16, u16);

/// The world as the oracle sees it.
pub struct Oracle {
    motions: [JointType; 2],
    base: V,
    offset: V,
    movers: Vec<MovingObstacle>,
    obstacles: Vec<Solid>,
    clearance: f64,
    /// Lower and upper value of each axis, and true if it is a circle.
    pub axes: [(f64, f64, bool); 2],
}

/// Bounds for one meeting over a box of configurations.
pub struct Bounds {
    /// Lower bound on the room.
    pub least: f64,
    /// Upper bound on the room.
    pub most: f64,
}

/// The arm at a configuration.
pub struct Posture {
    frames: [(V, V); 3],
    /// The last placed moving part.
    placed: Option<(u16, Solid)>,
}

impl Oracle {
    /// Returns the arm and the obstacles of a scene.
    pub fn new(scene: &Scene) -> Self {
        let arm = scene.arm();
        let axes = [0, 1].map(|k| {
            let axis = arm.topology().ranges[k];
            let (lower, upper) = axis.domain();
            (lower, upper, axis.is_circle())
        });
        let motions = [arm.joints[0].joint_type, arm.joints[1].joint_type];
        let turns = motions.map(|m| matches!(m, JointType::Revolute { .. }));
        let offset = [arm.offset.x, arm.offset.y];
        let travel = axes[1].0.abs().max(axes[1].1.abs());
        let mut obstacles = Vec::new();
        let mut heights = Vec::new();
        for obstacle in &scene.workspace().obstacles {
            for piece in &obstacle.pieces {
                obstacles.push(Solid::new(piece));
                heights.push(obstacle.heights);
            }
        }
        let standing = obstacles.len();
        for own in &arm.self_obstacles {
            obstacles.push(Solid::new(&own.obstacle.pieces[0]));
            heights.push(own.obstacle.heights);
        }
        let mut movers = Vec::new();
        for (link, l) in arm.links.iter().enumerate() {
            for part in &l.parts {
                let solid = Solid::new(&part.shape);
                let from_base = match (link, turns[1]) {
                    (0, _) => solid.reach,
                    (_, true) => norm(offset) + solid.reach,
                    (_, false) => norm(offset) + travel + solid.reach,
                };
                let first = if turns[0] { from_base } else { 1.0 };
                let second = match (link, turns[1]) {
                    (0, _) => 0.0,
                    (_, true) => solid.reach,
                    (_, false) => 1.0,
                };
                let meets = |i: &u16| {
                    part.heights.lower <= heights[usize::from(*i)].upper
                        && heights[usize::from(*i)].lower <= part.heights.upper
                };
                let hits = |i: &u16, carrier: Carrier| {
                    let own = &arm.self_obstacles[usize::from(*i) - standing];
                    let overlap = part.heights.lower < own.obstacle.heights.upper
                        && own.obstacle.heights.lower < part.heights.upper;
                    own.carrier == carrier && overlap && !own.ignored.contains(&part.body)
                };
                let own = || standing as u16..obstacles.len() as u16;
                let stand = own().filter(|i| hits(i, Carrier::Base));
                let all = (0..standing as u16).filter(meets).chain(stand).collect();
                movers.push(MovingObstacle { link, solid, obstacles: all, speed: [first, second] });
                let carried: Vec<u16> = own().filter(|i| link == 1 && hits(i, Carrier::FirstJoint)).collect();
                if !carried.is_empty() {
                    movers.push(MovingObstacle { link: 2, solid, obstacles: carried, speed: [0.0, second] });
                }
            }
        }
        let base = [arm.base.x, arm.base.y];
        Self { motions, base, offset, movers, obstacles, clearance: scene.workspace().clearance, axes }
    }

    /// Returns all pairs that can meet.
    pub fn meetings(&self) -> impl Iterator<Item = Meeting> + '_ {
        self.movers.iter().enumerate().flat_map(|(m, mover)| mover.obstacles.iter().map(move |&o| (m as u16, o)))
    }

    /// Returns the arm at a configuration.
    pub fn posture(&self, q: V) -> Posture {
        let [first, second] = self.frames(q);
        let [_, as_link_1_has_it] = self.frames([0.0, q[1]]);
        Posture { frames: [first, second, as_link_1_has_it], placed: None }
    }

    /// Returns the rotation and the origin of both links.
    fn frames(&self, q: V) -> [(V, V); 2] {
        let mut turn = [1.0, 0.0];
        let mut place = self.base;
        [0, 1].map(|k| {
            if k == 1 {
                place = add(place, rotate(self.offset, turn));
            }
            match self.motions[k] {
                JointType::Revolute { sign } => turn = rotate([(sign * q[k]).cos(), (sign * q[k]).sin()], turn),
                JointType::Prismatic { direction } => {
                    place = add(place, rotate([direction.x * q[k], direction.y * q[k]], turn));
                }
            }
            (turn, place)
        })
    }

    /// Returns the least and the greatest room of a meeting while each joint deviates by up to `half`. The room is the excess of
    /// the distance over the required clearance.
    pub fn bounds(&self, posture: &mut Posture, (m, o): Meeting, half: V) -> Bounds {
        let mover = &self.movers[usize::from(m)];
        let solid = self.placed(posture, m);
        let obstacle = &self.obstacles[usize::from(o)];
        let second = half[1] * mover.speed[1];
        let first = match (self.motions[0], mover.link) {
            (JointType::Revolute { .. }, 1) => {
                // Only the second joint changes this distance from the base.
                let out = solid.corners().iter().map(|&p| norm(sub(p, self.base))).fold(0.0, f64::max);
                (out + second).min(mover.speed[0])
            }
            _ => mover.speed[0],
        };
        let motion = half[0] * first + second;
        let least = solid.roughly(obstacle) - self.clearance - motion;
        if least > 0.0 {
            return Bounds { least, most: f64::INFINITY };
        }
        let room = solid.distance(obstacle) - self.clearance;
        Bounds { least: room - motion, most: room + motion }
    }

    fn placed<'a>(&self, posture: &'a mut Posture, m: u16) -> &'a Solid {
        let mover = &self.movers[usize::from(m)];
        if posture.placed.as_ref().is_none_or(|(known, _)| *known != m) {
            let (turn, place) = posture.frames[mover.link];
            posture.placed = Some((m, mover.solid.placed(turn, place)));
        }
        &posture.placed.as_ref().expect("just placed").1
    }

    /// Returns the distance to the nearest obstacle minus the required clearance.
    pub fn room(&self, q: Configuration) -> f64 {
        self.room_up_to(q, f64::INFINITY)
    }

    /// Returns the distance to the nearest obstacle minus the required clearance, but at most `most`.
    fn room_up_to(&self, q: Configuration, most: f64) -> f64 {
        let mut posture = self.posture([q[0], q[1]]);
        let mut least = most;
        for (m, mover) in self.movers.iter().enumerate() {
            let solid = *self.placed(&mut posture, m as u16);
            for &o in &mover.obstacles {
                let obstacle = &self.obstacles[usize::from(o)];
                if solid.roughly(obstacle) - self.clearance < least {
                    least = least.min(solid.distance(obstacle) - self.clearance);
                }
            }
        }
        least
    }

    /// Returns a bound on the speed of any point while the joints move by `d` in unit time.
    pub fn speed(&self, d: Configuration) -> f64 {
        self.movers.iter().map(|m| dot(m.speed, [d[0].abs(), d[1].abs()])).fold(0.0, f64::max)
    }

    /// Finds a configuration on the path with less room than `proven`, in steps of `step`. A step is longer only if the distance
    /// proves that nothing is skipped.
    pub fn violation(&self, path: &Path, proven: f64, step: f64) -> Option<(Configuration, f64)> {
        let mut worst = None;
        for (a, b) in path.segments().chain([(path.goal(), path.goal())]) {
            let d = b - a;
            let (length, speed) = (d.norm(), self.speed(d));
            let mut t = 0.0;
            loop {
                let at = a + d * t;
                let room = self.room_up_to(at, proven + speed);
                if room < proven {
                    worst = Some((at, room));
                }
                if t >= 1.0 || length == 0.0 {
                    break;
                }
                let safe = if speed > 0.0 { 0.9 * (room - proven) / speed } else { 1.0 };
                t = (t + safe.max(step / length)).min(1.0);
            }
        }
        worst
    }
}
