//! Lower bounds on the remaining time of a task, ignoring obstacles.

use super::ik_solutions::{goal_ik_solutions, ik_solutions};
use super::least_time::{least_line_time, least_time};
use super::state::Progress;
use super::stroke::{least_raising_at_start, least_rest, least_without_strokes, most_overlap, stroke_depth};
use cplan_geometry::{Point, Pose};
use cplan_handling::{Action, Holding, Item, Object, Step, Task};
use cplan_model::Arm;
use cplan_model::space::Configuration;
use nalgebra::Rotation2;

/// The target of a step, at which the arm stops.
#[derive(Debug, Clone)]
pub(super) struct Stop {
    /// All IK solutions at the target. `None` if there are infinitely many, or if earlier steps determine them.
    pub ik_solutions: Option<Vec<Configuration>>,
    pub speed: f64,
    /// Lower bound on the duration of the motion to the stop, from the speed of the tip alone, in seconds.
    least_travel: f64,
    /// Longest overlaps of strokes with the motion to the stop, at its beginning and its end, in seconds.
    overlaps: [f64; 2],
    /// Least time of the dwell and the stroke at the stop, in seconds.
    dwell: f64,
}

impl Stop {
    /// Returns the number of configurations at the stop; 1 if they are unknown.
    fn count(&self) -> usize {
        self.ik_solutions.as_ref().map_or(1, Vec::len)
    }

    /// Returns the configuration of the stop with this index. `None` if the configurations are unknown.
    fn at(&self, place: usize) -> Option<Configuration> {
        self.ik_solutions.as_ref().map(|ik_solutions| ik_solutions[place])
    }

    /// Returns a lower bound on the duration of the motion to a configuration of the stop, plus its dwell, in seconds.
    fn seconds(&self, arm: &Arm, from: Option<Configuration>, place: usize) -> f64 {
        let of_joints = from.zip(self.at(place)).map_or(0.0, |(from, to)| least_time(arm, from, to, self.speed));
        let travel = of_joints.max(self.least_travel);
        least_without_strokes(travel, self.overlaps) + self.dwell
    }
}

/// The stops of an item of a task.
#[derive(Debug, Clone)]
pub(super) enum Stops {
    /// The stop of a step.
    One(Stop),
    /// The stops of each pair: pick and place.
    Pairs(Vec<[Stop; 2]>),
    /// The item involves no motion.
    Nothing,
}

/// Lower bound on the time from an item to the end of the task, in seconds.
#[derive(Debug, Clone)]
enum RemainingSeconds {
    /// After a step, for each configuration at its stop.
    One(Vec<f64>),
    /// Within a group in any order.
    Pairs(Table),
    /// From the beginning of a group that is too large for a table, for any configuration of the arm.
    Many(f64),
    Nothing,
}

/// Largest number of pairs of a group for which all subsets are tabulated. The table then has some hundred thousand
/// numbers.
const MAX_TABULATED_PAIRS: usize = 12;

/// Lower bounds on the time from within a group to the end of the task, in seconds. They are indexed by the set of
/// pairs that are done (one bit each), the last of these pairs, and the configuration at its stop.
#[derive(Debug, Clone)]
struct Table {
    /// Bounds after the pick of a pair. The pair then counts as done.
    picked: Vec<Vec<Vec<f64>>>,
    /// Bounds after the place step of the last pair that is done.
    placed: Vec<Vec<Vec<f64>>>,
}

/// Lower bounds on the time from any state to the end of a task, over all IK solutions and orders.
pub(super) struct Heuristic<'a> {
    arm: &'a Arm,
    stops: Vec<Stops>,
    after: Vec<RemainingSeconds>,
}

impl<'a> Heuristic<'a> {
    /// Computes the bounds. Takes `O(n b^2)` for `n` steps with `b` IK solutions each. For a group of `k` pairs up to
    /// [`MAX_TABULATED_PAIRS`], it finds the best order and takes `O(2^k k^2 b^2)`. For a larger group, the bound is
    /// weaker. It assumes that each pick is reached from the nearest place. It omits the longest of these motions,
    /// because the first pick needs none.
    pub fn new(task: &'a Task) -> Self {
        let stops = stops(task);
        let mut heuristic = Self { arm: &task.arm, after: vec![RemainingSeconds::Nothing; stops.len()], stops };
        for item in (0..heuristic.stops.len()).rev() {
            heuristic.after[item] = match &heuristic.stops[item] {
                Stops::One(stop) => RemainingSeconds::One(
                    (0..stop.count()).map(|place| heuristic.from(stop.at(place), item + 1)).collect(),
                ),
                Stops::Pairs(pairs) if pairs.len() <= MAX_TABULATED_PAIRS => {
                    RemainingSeconds::Pairs(heuristic.table(pairs, item))
                }
                Stops::Pairs(pairs) => RemainingSeconds::Many(heuristic.at_least(pairs, item)),
                Stops::Nothing => RemainingSeconds::Nothing,
            };
        }
        heuristic
    }

    /// Returns a lower bound on the time from a configuration to the end of the task, in seconds. Infinite if a target
    /// is out of reach.
    pub fn remaining(&self, q: Configuration, progress: Progress) -> f64 {
        let Progress { item, done, carried_pair } = progress;
        match (self.stops.get(item), self.after.get(item), carried_pair) {
            (Some(Stops::Pairs(pairs)), Some(RemainingSeconds::Pairs(table)), Some(pair)) => {
                let done = done as usize | 1 << pair;
                self.bound_over(&pairs[pair][1], Some(q), &table.placed[done][pair])
            }
            (Some(Stops::Pairs(pairs)), Some(RemainingSeconds::Pairs(table)), None) => {
                self.next_pair(pairs, table, Some(q), done as usize)
            }
            _ => self.from(Some(q), item),
        }
    }

    /// Returns a lower bound on the time from the beginning of an item to the end of the task, in seconds.
    fn from(&self, q: Option<Configuration>, item: usize) -> f64 {
        match (self.stops.get(item), self.after.get(item)) {
            (Some(Stops::One(stop)), Some(RemainingSeconds::One(after))) => self.bound_over(stop, q, after),
            (Some(Stops::Pairs(pairs)), Some(RemainingSeconds::Pairs(table))) => self.next_pair(pairs, table, q, 0),
            (Some(Stops::Pairs(_)), Some(RemainingSeconds::Many(least))) => *least,
            (Some(_), _) => self.from(q, item + 1),
            (None, _) => 0.0,
        }
    }

    /// Returns the least bound over all configurations of a stop. `after` has the bounds after the stop, one per
    /// configuration.
    fn bound_over(&self, stop: &Stop, q: Option<Configuration>, after: &[f64]) -> f64 {
        let by = |(place, after): (usize, &f64)| stop.seconds(self.arm, q, place) + after;
        after.iter().enumerate().map(by).fold(f64::INFINITY, f64::min)
    }

    /// Returns the least bound over all pairs that are not done yet.
    fn next_pair(&self, pairs: &[[Stop; 2]], table: &Table, q: Option<Configuration>, done: usize) -> f64 {
        let open = (0..pairs.len()).filter(|pair| done & (1 << pair) == 0);
        let by = |pair: usize| self.bound_over(&pairs[pair][0], q, &table.picked[done | 1 << pair][pair]);
        open.map(by).fold(f64::INFINITY, f64::min)
    }

    /// Returns a lower bound for a group in any order and all items after it, in seconds.
    fn at_least(&self, pairs: &[[Stop; 2]], item: usize) -> f64 {
        let least = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::INFINITY, f64::min);
        let travel = |from: &Stop, to: &Stop| {
            let of = |at: usize| least(&mut (0..to.count()).map(|place| to.seconds(self.arm, from.at(at), place)));
            least(&mut (0..from.count()).map(of))
        };
        let mut times: Vec<f64> = (0..pairs.len())
            .map(|pair| {
                let others = (0..pairs.len()).filter(|other| *other != pair);
                least(&mut others.map(|other| travel(&pairs[other][1], &pairs[pair][0])))
            })
            .collect();
        times.sort_by(f64::total_cmp);
        times.pop();
        let carried: f64 = pairs.iter().map(|[pick, place]| travel(pick, place)).sum();
        let ends = pairs.iter().flat_map(|[_, place]| (0..place.count()).map(|at| place.at(at)));
        let onward = least(&mut ends.map(|end| self.from(end, item + 1)));
        // The omitted motion includes the dwell at the first pick, so the least dwell is added.
        let dwell = pairs.iter().map(|[pick, _]| pick.dwell).fold(f64::INFINITY, f64::min);
        times.iter().sum::<f64>() + dwell + carried + onward
    }

    fn table(&self, pairs: &[[Stop; 2]], item: usize) -> Table {
        let all = (1_usize << pairs.len()) - 1;
        let empty = || vec![vec![Vec::new(); pairs.len()]; all + 1];
        let mut table = Table { picked: empty(), placed: empty() };
        for done in (1..=all).rev() {
            for pair in (0..pairs.len()).filter(|pair| done & (1 << pair) != 0) {
                let [pick, place] = &pairs[pair];
                let onward = |at: usize| match done == all {
                    true => self.from(place.at(at), item + 1),
                    false => self.next_pair(pairs, &table, place.at(at), done),
                };
                let placed: Vec<f64> = (0..place.count()).map(onward).collect();
                let picked = (0..pick.count()).map(|at| self.bound_over(place, pick.at(at), &placed)).collect();
                (table.placed[done][pair], table.picked[done][pair]) = (placed, picked);
            }
        }
        table
    }
}

/// The part of an object's pose that does not depend on IK solutions.
#[derive(Clone, Copy)]
struct KnownPose {
    at: Point,
    angle: Option<f64>,
}

impl KnownPose {
    /// Returns the position of a point of the object, if it is known.
    fn place_of(&self, point: Point) -> Option<Point> {
        if point == Point::zeros() {
            return Some(self.at);
        }
        self.angle.map(|angle| self.at + Rotation2::new(angle) * point)
    }
}

impl From<&Object> for KnownPose {
    fn from(object: &Object) -> Self {
        let pose: &Pose = &object.at;
        Self { at: pose.translation, angle: Some(pose.rotation.angle()) }
    }
}

/// Returns the stops of all items.
pub(super) fn stops(task: &Task) -> Vec<Stops> {
    // The place where a moving object will be picked is unknown.
    let lies = |object: &Object| object.trajectory.is_none().then(|| KnownPose::from(object));
    let mut lies: Vec<Option<KnownPose>> = task.objects.iter().map(lies).collect();
    let mut held = None;
    // The longest overlap at the beginning of the next motion.
    let mut rising = least_raising_at_start(task, |depth| most_overlap(task, Some(depth)));
    let mut stop = |step: &Step, rising: &mut f64, lies: &mut [Option<KnownPose>]| {
        let object = match step.action {
            Action::Pick { object, .. } => Some(object),
            Action::Place { .. } => held.map(|(object, _)| object),
            Action::Move(_) | Action::Follow(_) => None,
        };
        let dwell = least_rest(task, step, object);
        let sinking = most_overlap(task, stroke_depth(task, step, object));
        let overlaps = [std::mem::replace(rising, sinking), sinking];
        let least_travel = least_line_time(step);
        Stop { ik_solutions: targets(task, step, lies, &mut held), speed: step.speed, least_travel, overlaps, dwell }
    };
    let of = |item: &Item| match item {
        Item::Step(step) => Stops::One(stop(step, &mut rising, &mut lies)),
        Item::AnyOrder(pairs) => {
            // Any of the pairs may come before another, or before the next item.
            let objects =
                pairs.iter().map(|[pick, _]| most_overlap(task, stroke_depth(task, pick, pick.action.picked())));
            let most = objects.fold(rising, f64::max);
            let mut stops = |[pick, place]: &[Step; 2]| {
                let mut before = most;
                [pick, place].map(|step| stop(step, &mut before, &mut lies))
            };
            let stops = Stops::Pairs(pairs.iter().map(&mut stops).collect());
            rising = most;
            stops
        }
        Item::Renew(objects) => {
            objects.iter().for_each(|&object| lies[object] = Some(KnownPose::from(&task.objects[object])));
            Stops::Nothing
        }
    };
    task.items.iter().map(of).collect()
}

/// Returns all IK solutions of a step, or `None` if they are unknown. Updates the pose of the step's object.
fn targets(
    task: &Task,
    step: &Step,
    lies: &mut [Option<KnownPose>],
    held: &mut Option<(usize, Point)>,
) -> Option<Vec<Configuration>> {
    let arm = &task.arm;
    let tip_to = |target: Option<Point>| {
        let reach = ik_solutions(arm, arm.tip, (target?, step.required_elbow()), task.start);
        reach.all.then_some(reach.configurations)
    };
    match &step.action {
        Action::Move(goal) => {
            let reach = goal_ik_solutions(arm, goal, task.start);
            reach.all.then_some(reach.configurations)
        }
        Action::Follow(line) => tip_to(Some(line.path.end().into())),
        Action::Pick { object, grasp, .. } => {
            *held = Some((*object, *grasp));
            tip_to(lies[*object]?.place_of(*grasp))
        }
        Action::Place { at, angle, .. } => {
            let (object, grasp) = held.take()?;
            let turned = match task.objects[object].holding {
                Holding::Level => angle.or(lies[object]?.angle),
                Holding::Rigid => None,
            };
            // The same expression as in the state, so that both values are equal bit for bit.
            let exact = turned.map(|angle| Pose::new(*at, angle).point(grasp));
            let placed = KnownPose { at: *at, angle: turned };
            lies[object] = Some(placed);
            tip_to(exact.or_else(|| placed.place_of(grasp)))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_geometry::Vector;
    use cplan_model::space::JointRange;
    use cplan_model::{Joint, JointType, Link, OutlineSource, Plane};
    use nalgebra::Vector3;
    use proptest::prelude::*;

    fn arm() -> Arm {
        let joint = |name: &str| Joint {
            name: name.into(),
            joint_type: JointType::Revolute { sign: 1.0 },
            range: JointRange::Circle,
            velocity: 2.0,
            acceleration: 9.0,
            jerk: None,
        };
        let link = |name: &str| Link { name: name.into(), parts: Vec::new(), source: OutlineSource::None };
        Arm {
            name: "arm".into(),
            joints: [joint("a"), joint("b")],
            links: [link("a"), link("b")],
            base: Point::zeros(),
            offset: Vector::new(1.0, 0.0),
            tip: Point::new(0.7, 0.0),
            tip_name: "tip".into(),
            plane: Plane { u: Vector3::x(), v: Vector3::y(), normal: Vector3::z() },
            dynamics: None,
            motors: None,
            self_obstacles: Vec::new(),
        }
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(64))]

        /// Tests that the bound for large groups is at most the least time over all orders.
        #[test]
        fn the_bound_of_a_large_group_is_a_bound(
            spots in prop::collection::vec(((0.4..1.6f64, -3.0..3.0f64), (0.4..1.6f64, -3.0..3.0f64)), 2..7),
            dwells in prop::collection::vec((0.0..1.0f64, 0.0..1.0f64), 7),
        ) {
            let arm = arm();
            let stop = |(radius, angle): (f64, f64), dwell| Stop {
                ik_solutions: Some(ik_solutions(&arm, arm.tip, (Point::new(radius * angle.cos(), radius * angle.sin()), None), Configuration::zeros()).configurations),
                speed: 1.0,
                least_travel: 0.0,
                overlaps: [0.0; 2],
                dwell,
            };
            let pairs: Vec<[Stop; 2]> = spots.iter().zip(&dwells).map(|((a, b), (c, d))| [stop(*a, *c), stop(*b, *d)]).collect();
            let home = stop((1.2, 0.3), 0.1);
            let mut heuristic = Heuristic {
                arm: &arm,
                after: vec![RemainingSeconds::Nothing, RemainingSeconds::One(vec![0.0; home.count()])],
                stops: vec![Stops::Pairs(pairs.clone()), Stops::One(home)],
            };
            let least = heuristic.at_least(&pairs, 0);
            heuristic.after[0] = RemainingSeconds::Pairs(heuristic.table(&pairs, 0));
            let best = heuristic.from(Some(Configuration::new(0.3, -1.0)), 0);
            prop_assert!(least <= best + 1e-12, "{least} {best}");
            prop_assert!(least > 0.0);
        }
    }
}
