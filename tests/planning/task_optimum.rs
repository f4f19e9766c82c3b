//! The choice of IK solutions and order, compared with a trial of all choices.

use cplan::engine::task::{TaskAnswer, plan, rest_to_rest};
use cplan::engine::{Method, Options};
use cplan::geometry::{Point, Pose, Vector};
use cplan::model::{
    Action, Arm, Goal, Heights, Holding, Item, JointType, Object, Shape, Step, Task, ToolValues, Workspace,
    equivalent_values, inverse,
};
use cplan::motion::Drive;
use cplan::space::{Configuration, JointRange};
use cplan_testkit::arms::{arm, joint, link};
use cplan_testkit::scenes::{obstacle, q};
use cplan_testkit::shapes::{disc, rectangle};
use std::collections::BTreeMap;

fn options() -> Options {
    Options { drive: Drive { period: 0.1, ..Drive::default() }, ..Method::Visibility.into() }
}

fn plan_task(task: &Task) -> TaskAnswer {
    plan(task, &options(), &mut |_| {})
}

/// Returns an arm of two bars among three obstacles of the same height.
fn cell(limits: [[f64; 2]; 2]) -> (Arm, Workspace) {
    let turn = JointType::Revolute { sign: 1.0 };
    let [one, two] = limits.map(|[lower, upper]| JointRange::Interval { lower, upper });
    let arm = arm(
        [joint("shoulder", turn, one), joint("elbow", turn, two)],
        [link("upper", vec![rectangle(0.0, 1.0, -0.05, 0.05)]), link("fore", vec![rectangle(0.0, 0.8, -0.05, 0.05)])],
        Vector::new(1.0, 0.0),
        Point::new(0.8, 0.0),
    );
    let pieces = [disc(Point::new(1.2, 0.5), 0.08), disc(Point::new(-0.6, 1.2), 0.1), rectangle(0.3, 0.6, -1.3, -1.1)];
    let obstacles = pieces.into_iter().map(|piece| obstacle("post", piece)).collect();
    (arm, Workspace { name: "cell".into(), obstacles, clearance: 0.0, preferences: Vec::new() })
}

/// Returns a flat object far below the arm, which nothing can hit.
fn distant_object(name: &str, at: Point) -> Object {
    let below = Heights { lower: -1.0, upper: -0.9 };
    Object {
        name: name.into(),
        shape: Shape::Circle { center: Point::zeros(), radius: 1e-3 },
        pieces: vec![disc(Point::zeros(), 1e-3)],
        heights: below,
        lift: 0.0,
        holding: Holding::Level,
        at: Pose::new(at, 0.0),
        trajectory: None,
        mass: 0.0,
        presence: None,
    }
}

fn step(action: Action, number: usize) -> Step {
    let (place, tool) = (String::new(), ToolValues::default());
    Step { action, number, cycle: 1, place, speed: 1.0, dwell: 0.25, tool, elevation: 0.0, elbow: None }
}

/// Returns a task without obstacles at the height of its objects, with pairs of picks and places in fixed or free
/// order.
fn task(limits: [[f64; 2]; 2], spots: &[[Point; 2]], free: bool) -> Task {
    let (arm, mut workspace) = cell(limits);
    // The objects are below the posts.
    workspace.obstacles.iter_mut().for_each(|o| o.heights = Heights { lower: -0.5, upper: 0.5 });
    let objects = spots.iter().enumerate().map(|(i, [from, _])| distant_object(&format!("thing {i}"), *from)).collect();
    let pair = |(object, [_, to]): (usize, &[Point; 2])| {
        let pick = Action::Pick { object, grasp: Point::zeros(), supports: Vec::new(), when: Vec::new() };
        [step(pick, 2 * object + 1), step(Action::Place { at: *to, angle: None, supports: Vec::new() }, 2 * object + 2)]
    };
    let pairs: Vec<[Step; 2]> = spots.iter().enumerate().map(pair).collect();
    let mut items =
        if free { vec![Item::AnyOrder(pairs)] } else { pairs.into_iter().flatten().map(Item::Step).collect() };
    let home = q(0.0, 0.3);
    items.push(Item::Step(step(Action::Move(Goal::Joints(home)), 2 * spots.len() + 1)));
    let workspace = workspace.into();
    Task { arm, workspace, objects, start: home, items, wrist: None, stroke: None, start_tool: ToolValues::default() }
}

/// Returns all IK solutions within the limits that put the tip somewhere.
fn ik_solutions(arm: &Arm, at: Point) -> Vec<Configuration> {
    let mut all = Vec::new();
    for branch in inverse(arm, at, Configuration::zeros()).branches {
        for first in equivalent_values(arm.joints[0].range, true, branch[0]) {
            all.extend(
                equivalent_values(arm.joints[1].range, true, branch[1]).into_iter().map(|second| q(first, second)),
            );
        }
    }
    all
}

/// Returns the duration of the fastest sequence through layers of IK solutions, in seconds. Tries all orders of the
/// pairs.
fn least_duration(
    start: Configuration,
    layers: &[[Vec<Configuration>; 2]],
    orders: &[Vec<usize>],
    mut seconds: impl FnMut(Configuration, Configuration) -> f64,
) -> f64 {
    let mut best = f64::INFINITY;
    for order in orders {
        let mut stops: Vec<&[Configuration]> =
            order.iter().flat_map(|&pair| layers[pair].each_ref().map(Vec::as_slice)).collect();
        let home = [start];
        stops.push(&home);
        // Each sequence is tried separately, like the digits of a counter.
        let count: usize = stops.iter().map(|stop| stop.len()).product();
        for index in 0..count {
            let (mut rest, mut at, mut sum) = (index, start, 0.0);
            for stop in &stops {
                let to = stop[rest % stop.len()];
                rest /= stop.len();
                sum += seconds(at, to) + 0.25;
                at = to;
            }
            best = f64::min(best, sum);
        }
    }
    best
}

fn orders(count: usize) -> Vec<Vec<usize>> {
    if count == 0 {
        return vec![Vec::new()];
    }
    let shorter = orders(count - 1);
    let insert = |order: &Vec<usize>| {
        (0..count).map(|at| [&order[..at], &[count - 1], &order[at..]].concat()).collect::<Vec<_>>()
    };
    shorter.iter().flat_map(insert).collect()
}

/// Returns places that the tip can reach, spread by the golden section.
fn spots(seed: u32, count: usize, arm: &Arm) -> Vec<[Point; 2]> {
    let mut turn = f64::from(seed) * 0.377;
    let mut next = || {
        turn += 0.618_033_988_75;
        let (a, b) = ((turn % 1.0) * 4.0 - 2.0, ((turn * 1.7) % 1.0) * 3.2 - 1.6);
        arm.tip_at(q(a, b))
    };
    (0..count).map(|_| [next(), next()]).collect()
}

/// Returns true if the task is done, and it is proven that no other choice is faster.
fn is_exact(answer: &TaskAnswer) -> bool {
    answer.outcome.found().is_some_and(|motion| motion.exact)
}

#[test]
fn the_fastest_of_all_ik_solutions_and_orders_is_found() {
    let (mut free_differs, mut compared) = (0, 0);
    for seed in 0..24 {
        // Wide limits: IK solutions come with copies by whole turns.
        let limits = if seed % 3 == 0 { [[-3.5, 3.5], [-2.6, 2.6]] } else { [[-2.6, 2.6], [-2.2, 1.4]] };
        let (arm, _) = cell(limits);
        let spots = spots(seed, 3, &arm);
        let mut durations = Vec::new();
        for free in [false, true] {
            let task = task(limits, &spots, free);
            let answer = plan_task(&task);
            let layers: Vec<[Vec<Configuration>; 2]> =
                spots.iter().map(|pair| pair.map(|at| ik_solutions(&task.arm, at))).collect();
            let orders = if free { orders(3) } else { vec![vec![0, 1, 2]] };
            let mut known = BTreeMap::new();
            let alone = |from: Configuration, to: Configuration| {
                let key = [from[0], from[1], to[0], to[1]].map(f64::to_bits);
                *known.entry(key).or_insert_with(|| {
                    let there = Step { dwell: 0.0, ..step(Action::Move(Goal::Joints(to)), 1) };
                    let blocked = |q: Configuration| {
                        let poses: Vec<_> = task.objects.iter().map(|o| Some(o.at.into())).collect();
                        let scene = task.scene(&poses, &[], None, []);
                        !scene.obstructions(q).is_empty()
                    };
                    if blocked(from) || blocked(to) {
                        return f64::INFINITY;
                    }
                    let single = plan_task(&Task { start: from, items: vec![Item::Step(there)], ..task.clone() });
                    if single.failed().is_none() { single.duration() } else { f64::INFINITY }
                })
            };
            let expected = least_duration(task.start, &layers, &orders, alone);
            if expected.is_infinite() {
                assert_ne!(answer.failed(), None, "seed {seed}");
                continue;
            }
            compared += 1;
            assert_eq!(answer.failed(), None, "seed {seed}");
            assert!(is_exact(&answer), "seed {seed}");
            assert!((answer.duration() - expected).abs() < 1e-9, "seed {seed}: {} for {expected}", answer.duration());
            durations.push(answer.duration());
            let joints = &task.arm.joints;
            let bare = |from: Configuration, to: Configuration| {
                let of = |k: usize| rest_to_rest((to[k] - from[k]).abs(), joints[k].velocity, joints[k].acceleration);
                of(0).max(of(1))
            };
            let bound = least_duration(task.start, &layers, &orders, bare);
            assert!((answer.lower_bound - bound).abs() < 1e-6, "seed {seed}: {} for {bound}", answer.lower_bound);
            assert!(answer.lower_bound <= bound, "seed {seed}: rounding is on the safe side");
        }
        if let [fixed, free] = durations[..] {
            assert!(free <= fixed + 1e-9, "seed {seed}");
            free_differs += usize::from(free < fixed - 1e-3);
        }
    }
    assert!(compared >= 20 && free_differs >= 5, "{compared} compared, in {free_differs} the order matters");
}

/// Checks a group of more than ten pairs, whose order a local search finds. It is better than many random orders, and
/// its bound holds.
#[test]
fn a_large_group_gets_a_good_order() {
    let limits = [[-2.9, 2.9], [-2.6, 2.6]];
    let (arm, _) = cell(limits);
    let free = |at: &Point| {
        let empty = task(limits, &[], false);
        let scene = empty.workspace.clone().scene(empty.arm.clone()).expect("a scene");
        ik_solutions(&arm, *at).iter().any(|q| scene.obstructions(*q).is_empty())
    };
    let spots: Vec<[Point; 2]> = spots(3, 30, &arm).into_iter().filter(|pair| pair.iter().all(free)).take(12).collect();
    assert_eq!(spots.len(), 12);
    let ours = plan_task(&task(limits, &spots, true));
    assert_eq!(ours.failed(), None);
    assert!(!is_exact(&ours) && ours.lower_bound < ours.duration());
    let some = plan_task(&task(limits, &spots[..4], true));
    assert!(is_exact(&some) && some.lower_bound < ours.lower_bound, "more to do takes longer");
    let mut order: Vec<usize> = (0..12).collect();
    for round in 0..12_usize {
        for i in (1..12).rev() {
            order.swap(i, (round * 7 + i * i * 5 + 3) % (i + 1));
        }
        let drawn: Vec<[Point; 2]> = order.iter().map(|&i| spots[i]).collect();
        let theirs = plan_task(&task(limits, &drawn, false));
        assert_eq!(theirs.failed(), None);
        assert!(ours.duration() < theirs.duration(), "{} and {}", ours.duration(), theirs.duration());
    }
}
