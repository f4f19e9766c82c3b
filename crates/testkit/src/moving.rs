//! Random worlds with moving obstacles, whose poses the tests compute themselves.

use crate::oracle::Oracle;
use crate::shapes::{disc, rectangle};
use crate::world::{KINDS, world};
use cplan::geometry::{Convex, Point, Vector};
use cplan::model::{
    Arm, Growth, Heights, MovingObstacle, Obstacle, ObstacleTrajectory, Scene, Shape, Stop, TimedWorkspace, Workspace,
};
use cplan::motion::Trajectory;
use cplan::space::{Configuration, GoalSet};
use cplan::{Problem, ProblemError};
use cplan_cases::dice::Dice;

/// A world with moving obstacles.
pub struct Moving {
    /// The kind of arm and the seed, for messages.
    pub name: String,
    /// The arm.
    pub arm: Arm,
    workspace: TimedWorkspace,
    start: Configuration,
    goals: GoalSet,
}

impl Moving {
    /// Returns the world of a kind of arm and a seed. `None` if it has no free start. `movers` is the number of moving obstacles;
    /// with `None`, it is random.
    pub fn drawn(kind: &str, seed: u64, movers: Option<u64>) -> Option<Self> {
        let standing = world(kind, seed)?;
        let mut dice = Dice::new(seed.wrapping_mul(0x9e37_79b9).wrapping_add(u64::from(kind.as_bytes()[1])));
        let (start, goals) = (standing.start(), standing.goals().clone());
        let (arm, workspace) = standing.into_scene().into_parts();
        let mut workspace = TimedWorkspace::from(workspace);
        workspace.fixed.obstacles.truncate(5);
        let reach = arm.reach();
        // Halfway along the motion, obstacles are most likely to block it.
        let halfway = arm.tip_at((start + goals.pieces()[0].ends()[0]) / 2.0);
        let count = movers.unwrap_or_else(|| 2 + dice.below(4));
        workspace.movers = (0..count).map(|_| mover(&mut dice, arm.base, reach, halfway)).collect();
        let drawn = Self { name: format!("{kind} {seed}"), arm, workspace, start, goals };
        drawn.problem_among(drawn.workspace.clone()).ok().map(|_| drawn)
    }

    /// Returns the worlds of these seeds, for all kinds.
    pub fn all(seeds: std::ops::Range<u64>) -> impl Iterator<Item = Self> {
        seeds.flat_map(|seed| KINDS.iter().filter_map(move |kind| Self::drawn(kind, seed, None)))
    }

    fn problem_among(&self, workspace: TimedWorkspace) -> Result<Problem, ProblemError> {
        Problem::new(self.arm.clone(), workspace, self.start, self.goals.clone())
    }

    /// Returns the problem among the moving obstacles.
    pub fn problem(&self) -> Problem {
        self.problem_among(self.workspace.clone()).expect("a problem")
    }

    /// Returns the problem without moving obstacles.
    pub fn static_problem(&self) -> Problem {
        self.problem_among(TimedWorkspace { movers: Vec::new(), ..self.workspace.clone() }).expect("a problem")
    }

    /// Returns the distance to the nearest obstacle at a time, minus the clearance.
    pub fn room(&self, q: Configuration, time: f64) -> f64 {
        self.frozen(&self.workspace.fixed.obstacles, time).room(q)
    }

    /// Returns the moving obstacles at a time, without the static ones.
    pub fn movers_at(&self, time: f64) -> Oracle {
        self.frozen(&[], time)
    }

    fn frozen(&self, standing: &[Obstacle], time: f64) -> Oracle {
        let moved = self.workspace.movers.iter().map(|mover| obstacle_at(mover, time));
        let obstacles = standing.iter().cloned().chain(moved);
        let workspace = Workspace { clearance: self.workspace.fixed.clearance, ..Workspace::new(obstacles) };
        Oracle::new(&Scene::new(self.arm.clone(), workspace).expect("a scene"))
    }

    /// Returns the same world with obstacles that move between their stops faster by the factor `times`.
    pub fn sped_up(mut self, times: f64) -> Self {
        for mover in &mut self.workspace.movers {
            let first = mover.trajectory.stops()[0].time;
            let sooner = |stop: &Stop| Stop { time: first + (stop.time - first) / times, ..*stop };
            let stops = mover.trajectory.stops().iter().map(sooner).collect();
            mover.trajectory = ObstacleTrajectory::new(stops, mover.trajectory.velocity()).expect("a trajectory");
        }
        self
    }

    /// Returns, for each moving obstacle and each interval between its stops, the beginning, the end, and the greatest speed of
    /// its points, in m/s.
    pub fn speeds(&self) -> Vec<[f64; 3]> {
        let of = |mover: &MovingObstacle| {
            let pieces = mover.obstacle.pieces.iter();
            let reach = pieces.map(|piece| piece.reach_from(Point::zeros())).fold(0.0, f64::max);
            let stops = mover.trajectory.stops();
            let leg = |ends: &[Stop]| {
                let [a, b] = [ends[0], ends[1]];
                let gone = (b.at - a.at).norm() + (b.angle - a.angle).abs() * reach;
                [a.time, b.time, gone / (b.time - a.time)]
            };
            let last = [stops[stops.len() - 1].time, f64::INFINITY, mover.trajectory.velocity().norm()];
            stops.windows(2).map(leg).chain([last]).collect::<Vec<_>>()
        };
        self.workspace.movers.iter().flat_map(of).collect()
    }

    /// Returns the time after which nothing moves near the arm.
    pub fn horizon(&self) -> f64 {
        self.workspace.movers.iter().flat_map(|m| m.trajectory.stops()).map(|stop| stop.time).fold(0.0, f64::max) + 8.0
    }
}

/// Returns an obstacle that comes and goes, parks, passes by, or turns.
pub fn mover(dice: &mut Dice, base: Point, reach: f64, halfway: Point) -> MovingObstacle {
    let size = dice.within(0.05, 0.25);
    let piece = match dice.below(3) {
        0 => disc(Point::new(dice.within(-0.1, 0.1), 0.0), size),
        1 => rectangle(-size, size, -size / 2.0, size / 2.0),
        _ => rectangle(0.0, 3.0 * size, -0.02, 0.02),
    };
    let mut place = || {
        let (angle, radius) = (dice.within(-3.2, 3.2), reach * dice.within(0.4, 1.3));
        base + Vector::new(angle.cos(), angle.sin()) * radius
    };
    let mut places: Vec<Point> = (0..4).map(|_| place()).collect();
    if dice.chance(0.6) {
        places[1] = halfway;
    }
    let trajectory = match dice.below(4) {
        0 => {
            let speed = Vector::new(dice.within(-0.5, 0.5), dice.within(-0.5, 0.5));
            ObstacleTrajectory::conveyor(places[0].into(), speed.into())
        }
        kind => {
            let mut time = if dice.chance(0.5) { 0.0 } else { dice.within(0.0, 2.0) };
            let count = 2 + dice.below(3);
            let mut stops = Vec::new();
            for k in 0..count {
                let at = if kind == 1 { places[k % 2] } else { places[k] };
                let angle = if kind == 3 { dice.within(-2.0, 2.0) } else { 0.0 };
                stops.push(Stop { time, at, angle });
                time += dice.within(0.3, 3.0);
            }
            ObstacleTrajectory::new(stops, Vector::zeros())
        }
    };
    let name = "mover".into();
    let obstacle =
        Obstacle { name, shape: Shape::Pieces, pieces: vec![piece], heights: Heights::ALL, growth: Growth::default() };
    MovingObstacle { obstacle, trajectory: trajectory.expect("a trajectory") }
}

/// Returns a moving obstacle at its pose, from its stops.
pub fn obstacle_at(mover: &MovingObstacle, time: f64) -> Obstacle {
    let stops = mover.trajectory.stops();
    let (first, last) = (stops[0], stops[stops.len() - 1]);
    let (place, angle) = if time <= first.time {
        (first.at, first.angle)
    } else if time >= last.time {
        (last.at + mover.trajectory.velocity() * (time - last.time), last.angle)
    } else {
        let next = stops.iter().position(|stop| stop.time > time).expect("before the last");
        let [a, b] = [stops[next - 1], stops[next]];
        let share = (time - a.time) / (b.time - a.time);
        (a.at + (b.at - a.at) * share, a.angle + (b.angle - a.angle) * share)
    };
    let (sin, cos) = angle.sin_cos();
    let moved = |p: &Point| Point::new(place.x + cos * p.x - sin * p.y, place.y + sin * p.x + cos * p.y);
    let pieces = mover.obstacle.pieces.iter();
    let pieces = pieces
        .map(|piece| Convex::new(piece.core().iter().map(moved).collect(), piece.radius()).expect("a convex shape"));
    Obstacle { pieces: pieces.collect(), ..mover.obstacle.clone() }
}

/// Returns position, velocity and acceleration at a time after a sample, in seconds, by the polynomial of degree four that the
/// JSON defines.
pub fn state_between(trajectory: &Trajectory, sample: usize, t: f64) -> [Configuration; 3] {
    let row = |rows: &[[f64; 2]], k: usize| Configuration::from(rows[k]);
    let (p, v, a) =
        (row(&trajectory.position, sample), row(&trajectory.velocity, sample), row(&trajectory.acceleration, sample));
    let h = trajectory.time[sample + 1] - trajectory.time[sample];
    // The terms of degree three and four supply these differences at the end of the interval.
    let e = row(&trajectory.position, sample + 1) - p - v * h - a * (h * h / 2.0);
    let f = row(&trajectory.velocity, sample + 1) - v - a * h;
    let (c, d) = ((e * 4.0 - f * h) / h.powi(3), (f * h - e * 3.0) / h.powi(4));
    [
        p + v * t + a * (t * t / 2.0) + c * t.powi(3) + d * t.powi(4),
        v + a * t + c * (3.0 * t * t) + d * (4.0 * t.powi(3)),
        a + c * (6.0 * t) + d * (12.0 * t * t),
    ]
}

/// Returns time and configuration at a fraction `share` of the interval after a sample.
pub fn position(trajectory: &Trajectory, sample: usize, share: f64) -> (f64, Configuration) {
    let t = share * (trajectory.time[sample + 1] - trajectory.time[sample]);
    (trajectory.time[sample] + t, state_between(trajectory, sample, t)[0])
}
