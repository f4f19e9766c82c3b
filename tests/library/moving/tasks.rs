//! Tasks among moving obstacles. Answers are free at all times, pick objects where they are at that time, and end
//! hardly later than those of brute force.

use super::belts::drawn;
use cplan::engine::task::plan;
use cplan::geometry::{Point, Vector};
use cplan::model::{
    Action, Arm, Heights, Holding, Item, Object, Obstacle, ObstacleTrajectory, Outcome, Shape, Step, Task, ToolValues,
    Workspace,
};
use cplan::space::Configuration;
use cplan::{Options, Status};
use cplan_cases::dice::Dice;
use cplan_cases::{seeds, uses_default_cases};
use cplan_testkit::replay::{frames, pose_on_trajectory, replay};
use cplan_testkit::shapes::disc;
use cplan_testkit::solid::{Solid, V};
use cplan_testkit::world::KINDS;
use std::f64::consts::{PI, TAU};

#[test]
fn task_motions_are_free_and_pick_present_objects() {
    let (mut found, mut infeasible, mut unknown, mut waited) = (0, 0, 0, 0);
    for seed in seeds(8) {
        for task in KINDS.iter().filter_map(|kind| drawn(kind, seed)) {
            let answer = plan(&task, &Options::default(), &mut |_| ());
            let name = format!("{} {seed}", task.arm.joints.each_ref().map(|joint| joint.name.clone()).concat());
            match answer.outcome.status() {
                Status::Found => {
                    found += 1;
                    waited += usize::from(
                        answer
                            .outcome
                            .found()
                            .and_then(|motion| motion.timing.as_ref())
                            .is_some_and(|timing| !timing.waits.is_empty()),
                    );
                    replay(&task, &answer, true).unwrap_or_else(|what| panic!("{name}: {what}"));
                    assert!(answer.lower_bound <= answer.duration() + 1e-9, "{name}");
                }
                Status::Infeasible => infeasible += 1,
                Status::Unknown => {
                    unknown += 1;
                    // The steps before the failing one are free, too.
                    replay(&task, &answer, false).unwrap_or_else(|what| panic!("{name}: {what}"));
                }
            }
        }
    }
    println!("{found} found, {waited} with waits, {infeasible} infeasible, {unknown} unknown");
    assert!(!uses_default_cases() || (found > 8 && waited > 3), "{found} found, {waited} with waits");
}

/// Step between the departures and moments that brute force tries, in seconds.
const STEP: f64 = 0.02;

/// Distance that brute force keeps from all obstacles, in metres. The tip moves less in half a step.
const APART: f64 = 3e-2;

/// Returns a task with a single pick from a belt by an arm of two bars, with some posts nearby.
fn single_pick(seed: u64) -> Task {
    let mut dice = Dice::new(seed ^ 0xbe17);
    let arm = Arm::rr([1.0, 0.8], 0.06).expect("an arm");
    let spot = |dice: &mut Dice, radii: [f64; 2]| {
        let (angle, radius) = (dice.within(-PI, PI), dice.within(radii[0], radii[1]));
        Point::new(radius * angle.cos(), radius * angle.sin())
    };
    let posts = (0..dice.below(4_usize)).map(|number| {
        let at = spot(&mut dice, [0.5, 1.8]);
        Obstacle::circle(&format!("post {number}"), at.into(), 0.06).expect("a circle")
    });
    let workspace = Workspace::new(posts.collect::<Vec<_>>());
    let (near, angle) = (spot(&mut dice, [0.5, 1.6]), dice.within(-PI, PI));
    let velocity = Vector::new(angle.cos(), angle.sin()) * dice.within(0.1, 0.6);
    let from = near - velocity * dice.within(0.5, 4.0);
    let trajectory = ObstacleTrajectory::conveyor(from.into(), velocity.into()).expect("a trajectory");
    let object = Object {
        name: "bottle".into(),
        shape: Shape::Pieces,
        pieces: vec![disc(Point::zeros(), 0.04)],
        heights: Heights::ALL,
        lift: 0.0,
        holding: Holding::Rigid,
        at: trajectory.pose(0.0),
        trajectory: Some(trajectory),
        mass: 0.0,
        presence: None,
    };
    let action = Action::Pick { object: 0, grasp: Point::zeros(), supports: Vec::new(), when: Vec::new() };
    let place = String::new();
    let step = Step {
        action,
        number: 1,
        cycle: 1,
        place,
        speed: 1.0,
        dwell: 0.0,
        tool: ToolValues::default(),
        elevation: 0.0,
        elbow: None,
    };
    let start = Configuration::new(dice.within(-PI, PI), dice.within(-PI, PI));
    let workspace = workspace.into();
    Task {
        arm,
        workspace,
        objects: vec![object],
        start,
        items: vec![Item::Step(step)],
        wrist: None,
        stroke: None,
        start_tool: ToolValues::default(),
    }
}

#[test]
fn a_pick_is_hardly_later_than_brute_force_finds() {
    let (mut compared, mut later) = (0, 0.0_f64);
    for seed in seeds(4) {
        let task = single_pick(seed);
        if task.check().is_err() {
            continue;
        }
        let answer = plan(&task, &Options::default(), &mut |_| ());
        let Some(least) = earliest_pick(&task) else { continue };
        compared += 1;
        assert_eq!(answer.outcome.status(), Status::Found, "seed {seed}: picked at {least} s by brute force");
        let end = answer.duration();
        later = later.max(end - least);
        assert!(end <= least + 3.0 * STEP, "seed {seed}: at {end} s, brute force at {least} s");
    }
    println!("{compared} compared, {later} s later at the most");
    assert!(!uses_default_cases() || compared > 1, "{compared} compared");
}

/// Returns the time of the earliest pick. The arm departs at some time, moves straight, and waits for the object.
/// Returns `None` if there is no such pick within ten seconds.
fn earliest_pick(task: &Task) -> Option<f64> {
    (1..500).map(|k| f64::from(k) * STEP).find(|&moment| {
        let place = pose_on_trajectory(&task.objects[0], moment).1;
        postures(task, place).into_iter().any(|to| {
            let lasts = straight_duration(task, to);
            let mut departures = (0..).map(|k| k as f64 * STEP).take_while(|departs| departs + lasts <= moment);
            departures.any(|departs| is_free(task, to, [departs, lasts, moment]))
        })
    })
}

/// Returns both IK solutions at a place, by the law of cosines. From the start, joint 1 takes the shorter direction.
fn postures(task: &Task, [x, y]: V) -> Vec<V> {
    let (a, b) = (task.arm.offset.norm(), task.arm.tip.norm());
    let cosine = (x * x + y * y - a * a - b * b) / (2.0 * a * b);
    if cosine.abs() >= 1.0 {
        return Vec::new();
    }
    let start = [task.start[0], task.start[1]];
    let near = |angle: f64, to: f64| to + (angle - to + PI).rem_euclid(TAU) - PI;
    [cosine.acos(), -cosine.acos()]
        .map(|elbow| {
            let shoulder = y.atan2(x) - (b * elbow.sin()).atan2(a + b * elbow.cos());
            [near(shoulder, start[0]), near(elbow, start[1])]
        })
        .into()
}

/// Returns the duration of the straight motion to a configuration. Both joints move together, each within its limits.
fn straight_duration(task: &Task, to: V) -> f64 {
    let (velocity, acceleration) = limits(task, to);
    if acceleration <= velocity * velocity {
        2.0 / acceleration.sqrt()
    } else {
        1.0 / velocity + velocity / acceleration
    }
}

/// Returns the greatest speed and acceleration of a straight motion, as fractions of its length per second and per
/// second squared.
fn limits(task: &Task, to: V) -> (f64, f64) {
    let share = |k: usize, limit: f64| limit / (to[k] - task.start[k]).abs();
    let least = |of: &dyn Fn(usize) -> f64| of(0).min(of(1));
    let joint = |k: usize| &task.arm.joints[k];
    (least(&|k| share(k, joint(k).velocity)), least(&|k| share(k, joint(k).acceleration)))
}

/// Returns true if the arm touches nothing until the pick: at the start, during the motion, and while it waits.
fn is_free(task: &Task, to: V, [departs, lasts, moment]: [f64; 3]) -> bool {
    let (velocity, acceleration) = limits(task, to);
    let ramp = (velocity / acceleration).min(lasts / 2.0);
    let done = |time: f64| {
        let peak = acceleration * ramp;
        if time < ramp {
            acceleration * time * time / 2.0
        } else if time < lasts - ramp {
            peak * (time - ramp / 2.0)
        } else {
            1.0 - acceleration * (lasts - time).powi(2) / 2.0
        }
    };
    (0..=(moment / STEP) as usize).all(|k| {
        let time = k as f64 * STEP;
        let share = done((time - departs).clamp(0.0, lasts));
        let q = [0, 1].map(|k| task.start[k] + (to[k] - task.start[k]) * share);
        let (frames, _) = frames(&task.arm, q);
        let bar = |link: usize| task.arm.links[link].parts.iter().map(move |part| (link, Solid::new(&part.shape)));
        let mut bodies = bar(0).chain(bar(1)).map(|(link, body)| (link, body.placed(frames[link].0, frames[link].1)));
        let posts: Vec<Solid> = task.workspace.fixed.obstacles.iter().map(|post| Solid::new(&post.pieces[0])).collect();
        let bottle = pose_on_trajectory(&task.objects[0], time);
        let bottle = Solid::new(&task.objects[0].pieces[0]).placed(bottle.0, bottle.1);
        let is_apart = k < (moment / STEP) as usize || posts.iter().all(|post| bottle.distance(post) > APART);
        is_apart
            && bodies.all(|(link, body)| {
                posts.iter().all(|post| body.distance(post) > APART) && (link == 1 || body.distance(&bottle) > APART)
            })
    })
}

/// Checks an object that never comes within reach, and a task that is infeasible even without moving obstacles.
#[test]
fn infeasible_tasks_among_moving_obstacles_have_proofs() {
    let mut task = single_pick(0);
    task.workspace.fixed.obstacles.clear();
    task.objects[0].trajectory = Some(ObstacleTrajectory::conveyor([2.0, -3.0], [0.0, 0.5]).expect("a trajectory"));
    task.objects[0].at = task.objects[0].trajectory.as_ref().expect("a trajectory").pose(0.0);
    let answer = plan(&task, &Options::default(), &mut |_| ());
    let Outcome::Infeasible(why) = &answer.outcome else { panic!("{:?}", answer.outcome) };
    assert!(why.reasons[0].contains("\"bottle\" is not within the arm's reach"), "{:?}", why.reasons);
    // The object passes within reach, but not at that time.
    task.objects[0].trajectory = Some(ObstacleTrajectory::conveyor([1.0, -3.0], [0.0, 0.5]).expect("a trajectory"));
    let found = plan(&task, &Options::default(), &mut |_| ());
    assert_eq!(found.failed(), None);
    let Item::Step(Step { action: Action::Pick { when, .. }, .. }) = &mut task.items[0] else { panic!("a pick") };
    *when = vec![[0.0, 1.0]];
    assert_eq!(plan(&task, &Options::default(), &mut |_| ()).outcome.status(), Status::Infeasible);
}
