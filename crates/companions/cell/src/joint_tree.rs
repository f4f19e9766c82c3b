//! Paths of both arms at once: two trees of configurations with four joints, one from the starts and one from the goals
//! (RRT-Connect: Kuffner, LaValle 2000). Edges are certified.

use crate::between::Between;
use cplan_interrupt::checkpoint;
use cplan_judge::{CertifiedPath, Deviation, StraightMotions, certify};
use cplan_model::space::{Configuration, Path, SplitMix64};

/// Greatest number of samples.
const MAX_SAMPLES: usize = 4000;

/// Longest edge, in seconds at the joints' top speeds.
const STEP: f64 = 0.15;

/// Time that a corner costs, as a share of the time in which the joints reach their top speed.
const CORNER_SHARE: f64 = 0.5;

/// Distances between the arms to keep in addition to their clearance, as shares of their reach: one for each search, in
/// turn. Rounded corners and clocks that differ need room.
const MARGINS: [f64; 4] = [0.05, 0.02, 0.0, 0.1];

/// Greatest number of halvings of an edge before it counts as blocked.
const MAX_HALVINGS: u32 = 12;

/// A configuration of both arms.
type Both = [Configuration; 2];

/// A tree. Each node has the number of its parent, except the root.
struct Tree(Vec<(Both, Option<usize>)>);

/// Tests edges, and measures distances.
struct Space<'a> {
    between: &'a Between<'a>,
    /// Distance to keep between the arms, metres.
    required: f64,
    alone: [StraightMotions<'a>; 2],
}

/// A route of both arms: waypoints in four joints. Both arms move at once, straight from each waypoint to the next.
#[derive(Debug, Clone)]
pub(crate) struct JointRoute {
    waypoints: Vec<Both>,
    /// For each waypoint, the time from the start at top speed, seconds.
    times: Vec<f64>,
}

impl JointRoute {
    /// Returns the time along the route at top speed, seconds.
    pub fn time(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// Returns the configurations at a time from the start, at top speed.
    pub fn at(&self, time: f64) -> Both {
        let next = self.times.partition_point(|at| *at < time).clamp(1, self.times.len() - 1);
        let (from, to) = (self.times[next - 1], self.times[next]);
        let share = if to > from { ((time - from) / (to - from)).clamp(0.0, 1.0) } else { 1.0 };
        let ends = [self.waypoints[next - 1], self.waypoints[next]];
        [0, 1].map(|arm| ends[0][arm] + (ends[1][arm] - ends[0][arm]) * share)
    }

    /// Returns the path of each arm. `None` if it is not certified.
    pub fn paths(&self, between: &Between) -> Option<[CertifiedPath; 2]> {
        let path = |arm: usize| {
            let path = Path::new(self.waypoints.iter().map(|both| both[arm]).collect());
            certify(between.scenes[arm], path).ok()
        };
        Some([path(0)?, path(1)?])
    }
}

/// Returns a route from the starts to the goals that is proven to be free, after this number of attempts to shorten it. It depends on the seed.
/// Returns `None` if the search fails.
pub(crate) fn joint_route(
    between: &Between,
    starts: Both,
    goals: Both,
    seed: u64,
    shortcuts: usize,
) -> Option<JointRoute> {
    let alone = between.scenes.map(|scene| StraightMotions::new(scene, between.clearance));
    let reach = between.scenes.map(|scene| scene.arm().reach()).into_iter().fold(0.0, f64::max);
    let margin = MARGINS[seed as usize % MARGINS.len()] * reach;
    // At their starts and goals, the arms may be nearer to each other.
    let room = [starts, goals].map(|both| {
        let placed = [0, 1].map(|arm| between.at_rest(arm, both[arm]));
        between.distance(placed.each_ref(), f64::INFINITY).least - between.clearance
    });
    let required = between.clearance + margin.min(room[0] / 2.0).min(room[1] / 2.0).max(0.0);
    let space = Space { between, required, alone };
    let mut random = SplitMix64::new(seed);
    let mut trees = [Tree(vec![(starts, None)]), Tree(vec![(goals, None)])];
    let mut route = None;
    for sample in 0..MAX_SAMPLES {
        checkpoint();
        let grown = sample % 2;
        let target = [0, 1].map(|arm| random.configuration(&between.scenes[arm].arm().topology()));
        let Some(reached) = space.extend(&mut trees[grown], target) else { continue };
        let goal = trees[grown].0[reached].0;
        let mut at = None;
        // The other tree grows towards the new node as far as it can.
        while let Some(next) = space.extend(&mut trees[1 - grown], goal) {
            checkpoint();
            at = Some(next);
            if space.distance(trees[1 - grown].0[next].0, goal) == 0.0 {
                break;
            }
        }
        if let Some(met) = at.filter(|&at| space.distance(trees[1 - grown].0[at].0, goal) == 0.0) {
            let ends = if grown == 0 { [reached, met] } else { [met, reached] };
            let mut nodes = trees[0].route_to(ends[0]);
            nodes.reverse();
            nodes.extend(trees[1].route_to(ends[1]).into_iter().skip(1));
            route = Some(nodes);
            break;
        }
    }
    let mut route = space.unwrapped(route?);
    space.shorten(&mut route, &mut random, shortcuts);
    let mut times = vec![0.0];
    for ends in route.windows(2) {
        times.push(times[times.len() - 1] + space.straight_time(ends[0], ends[1]));
    }
    if route.len() == 1 {
        (route, times) = (vec![route[0]; 2], vec![0.0; 2]);
    }
    Some(JointRoute { waypoints: route, times })
}

impl Tree {
    /// Returns the configurations from a node to the root.
    fn route_to(&self, node: usize) -> Vec<Both> {
        let mut route = Vec::new();
        let mut at = Some(node);
        while let Some(node) = at {
            route.push(self.0[node].0);
            at = self.0[node].1;
        }
        route
    }
}

impl Space<'_> {
    /// Returns the displacements of both arms from one configuration to another.
    fn displacements(&self, from: Both, to: Both) -> Both {
        [0, 1].map(|arm| self.between.scenes[arm].arm().topology().displacement(from[arm], to[arm]))
    }

    /// Returns the time from one configuration to another at top speed, seconds.
    fn distance(&self, from: Both, to: Both) -> f64 {
        let by = self.displacements(from, to);
        let time = |arm: usize| {
            let joints = &self.between.scenes[arm].arm().joints;
            (by[arm][0].abs() / joints[0].velocity).max(by[arm][1].abs() / joints[1].velocity)
        };
        time(0).max(time(1))
    }

    /// Grows a tree from its nearest node towards a target, by one edge at most as long as the step. Returns the new node.
    fn extend(&self, tree: &mut Tree, target: Both) -> Option<usize> {
        let distances = tree.0.iter().map(|(at, _)| self.distance(*at, target));
        let (nearest, distance) = distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
        if distance == 0.0 {
            return None;
        }
        let from = tree.0[nearest].0;
        let by = self.displacements(from, target);
        let share = (STEP / distance).min(1.0);
        let to = if share == 1.0 { target } else { [0, 1].map(|arm| from[arm] + by[arm] * share) };
        let ends = [0, 1].map(|arm| from[arm] + by[arm] * share);
        self.is_free(from, ends).then(|| {
            // Nodes are within one turn, as samples are.
            let wrapped = [0, 1].map(|arm| self.between.scenes[arm].arm().topology().wrap(to[arm]));
            tree.0.push((wrapped, Some(nearest)));
            tree.0.len() - 1
        })
    }

    /// Returns true if the straight motion of both arms at once is proven to be free.
    fn is_free(&self, from: Both, to: Both) -> bool {
        self.are_apart(from, to)
            && (0..2).all(|arm| from[arm] == to[arm] || self.alone[arm].is_free(from[arm], to[arm]))
    }

    /// Returns true if the arms are proven to keep their clearance along a straight motion of both at once.
    fn are_apart(&self, from: Both, to: Both) -> bool {
        let mut open = vec![(0.0, 1.0, 0)];
        while let Some((low, high, halvings)) = open.pop() {
            let (middle, half) = (f64::midpoint(low, high), (high - low) / 2.0);
            let placed = [0, 1].map(|arm| {
                let by = to[arm] - from[arm];
                self.between.placed(arm, from[arm] + by * middle, Deviation::Along(by * half))
            });
            let required = self.required;
            let distance = self.between.distance(placed.each_ref(), required);
            if distance.least > 0.0 && distance.least >= required {
                continue;
            }
            let is_hit = distance.here.is_some_and(|(here, _)| here <= required);
            if is_hit || halvings == MAX_HALVINGS {
                return false;
            }
            open.extend([(low, middle, halvings + 1), (middle, high, halvings + 1)]);
        }
        true
    }

    /// Returns the same configurations with values that continue across the seams of circles.
    fn unwrapped(&self, route: Vec<Both>) -> Vec<Both> {
        let mut unwrapped: Vec<Both> = Vec::with_capacity(route.len());
        for both in route {
            let lifted = match unwrapped.last() {
                None => both,
                Some(last) => [0, 1].map(|arm| self.between.scenes[arm].arm().topology().lift(both[arm], last[arm])),
            };
            unwrapped.push(lifted);
        }
        unwrapped
    }

    /// Returns the place on a route at a time since its beginning, at top speed, and the number of the waypoint before it.
    fn place(&self, route: &[Both], mut time: f64) -> (usize, Both) {
        for (k, ends) in route.windows(2).enumerate() {
            let lasts = self.straight_time(ends[0], ends[1]);
            if time <= lasts {
                let share = if lasts > 0.0 { time / lasts } else { 0.0 };
                return (k, [0, 1].map(|arm| ends[0][arm] + (ends[1][arm] - ends[0][arm]) * share));
            }
            time -= lasts;
        }
        (route.len() - 2, route[route.len() - 1])
    }

    /// Returns the time of a straight motion at top speed, without turns around circles, seconds.
    fn straight_time(&self, from: Both, to: Both) -> f64 {
        let time = |arm: usize| {
            let (joints, by) = (&self.between.scenes[arm].arm().joints, to[arm] - from[arm]);
            (by[0].abs() / joints[0].velocity).max(by[1].abs() / joints[1].velocity)
        };
        time(0).max(time(1))
    }

    /// Returns the time along a route at top speed, seconds.
    fn route_time(&self, route: &[Both]) -> f64 {
        route.windows(2).map(|ends| self.straight_time(ends[0], ends[1])).sum()
    }

    /// Estimates the duration along a route, seconds. At each waypoint, the arms lose a share of the time in which they reach
    /// top speed.
    fn cost(&self, route: &[Both]) -> f64 {
        let ramp = |arm: usize| {
            let joints = &self.between.scenes[arm].arm().joints;
            joints.iter().map(|joint| joint.velocity / joint.acceleration).fold(0.0, f64::max)
        };
        self.route_time(route) + CORNER_SHARE * ramp(0).max(ramp(1)) * route.len() as f64
    }

    /// Shortens a route: replaces parts of it by straight motions of both arms, or of one arm while the other moves as before.
    fn shorten(&self, route: &mut Vec<Both>, random: &mut SplitMix64, attempts: usize) {
        for attempt in 0..attempts {
            checkpoint();
            let whole = self.route_time(route);
            if route.len() < 3 || whole == 0.0 {
                return;
            }
            let times = [random.unit() * whole, random.unit() * whole];
            let (first, from) = self.place(route, times[0].min(times[1]));
            let (last, to) = self.place(route, times[0].max(times[1]));
            if first == last {
                continue;
            }
            let middle = &route[first + 1..=last];
            let part: Vec<Both> = [from].into_iter().chain(middle.iter().copied()).chain([to]).collect();
            let known = self.cost(&part);
            let replaced =
                if attempt % 3 == 0 { vec![from, to] } else { self.with_one_straight(&part, attempt % 3 - 1) };
            if self.cost(&replaced) < known && replaced.windows(2).all(|ends| self.is_free(ends[0], ends[1])) {
                route.splice(first + 1..=last, replaced);
            }
        }
    }

    /// Returns a part of a route on which one arm moves straight, and the other as before.
    fn with_one_straight(&self, part: &[Both], arm: usize) -> Vec<Both> {
        let (from, to) = (part[0][arm], part[part.len() - 1][arm]);
        let other = 1 - arm;
        let joints = &self.between.scenes[other].arm().joints;
        let time = |a: Configuration, b: Configuration| {
            ((b - a)[0].abs() / joints[0].velocity).max((b - a)[1].abs() / joints[1].velocity)
        };
        let mut gone = vec![0.0];
        for ends in part.windows(2) {
            gone.push(gone[gone.len() - 1] + time(ends[0][other], ends[1][other]));
        }
        let whole = gone[gone.len() - 1];
        let share = |k: usize| if whole > 0.0 { gone[k] / whole } else { k as f64 / (part.len() - 1) as f64 };
        let moved = |(k, both): (usize, &Both)| {
            let mut both = *both;
            both[arm] = if k + 1 == part.len() { to } else { from + (to - from) * share(k) };
            both
        };
        part.iter().enumerate().map(moved).collect()
    }
}
