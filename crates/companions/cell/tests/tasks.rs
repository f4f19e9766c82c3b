//! Cells whose arms have steps, against a dense replay in time with kinematics of its own: two SCARAs whose bodies are
//! capsules at heights, and objects that are discs.

use cplan_cases::dice::Dice;
use cplan_cases::plane::segment_distance;
use cplan_cell::{Cell, CellPlan, Coordination, Settings, StepTimes, plan_cell};
use cplan_model::Outcome;
use cplan_robot::Source;
use std::fmt::Write as _;

/// Lengths of the links of `robots/scara.urdf`, metres.
const LENGTHS: [f64; 2] = [0.3, 0.25];

/// Distance between the bases of both robots, metres.
const BETWEEN_BASES: f64 = 0.8;

/// Height by which objects are lifted, and by which the quill is lowered, metres.
const LIFT: f64 = 0.1;

const OBJECT_HEIGHT: f64 = 0.02;
const OBJECT_RADIUS: f64 = 0.012;
const CLEARANCE: f64 = 0.003;
const DWELL: f64 = 0.1;

/// Bodies whose heights overlap by less, metres, do not meet.
const TOUCHING: f64 = 1e-6;

/// Number of times of a replay per second.
const SAMPLES_PER_SECOND: f64 = 150.0;

/// Tolerance of distances and places, metres.
const TOLERANCE: f64 = 1e-6;

type Place = [f64; 2];

/// A random object.
#[derive(Debug, Clone)]
struct Object {
    at: Place,
    to: Place,
    role: Role,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Role {
    /// The arm moves the object.
    Own(usize),
    /// The arm places the object at this place, and the other one takes it.
    Given(usize, Place),
    /// Either arm moves it.
    Shared,
}

/// A segment with a radius and heights.
#[derive(Debug, Clone)]
struct Capsule {
    name: String,
    ends: [Place; 2],
    radius: f64,
    heights: [f64; 2],
}

fn capsule(name: &str, ends: [Place; 2], radius: f64, heights: [f64; 2]) -> Capsule {
    Capsule { name: name.to_owned(), ends, radius, heights }
}

/// Returns the distance of two capsules. Infinite if their heights do not overlap.
fn distance(a: &Capsule, b: &Capsule) -> f64 {
    if a.heights[0] > b.heights[1] - TOUCHING || b.heights[0] > a.heights[1] - TOUCHING {
        return f64::INFINITY;
    }
    segment_distance(a.ends, b.ends) - a.radius - b.radius
}

/// Returns elbow and tip of an arm.
fn kinematics(arm: usize, q: Place) -> [Place; 3] {
    let (base, turned) = if arm == 0 { ([0.0, 0.0], 0.0) } else { ([BETWEEN_BASES, 0.0], std::f64::consts::PI) };
    let step = |from: Place, angle: f64, length: f64| [from[0] + length * angle.cos(), from[1] + length * angle.sin()];
    let elbow = step(base, turned + q[0], LENGTHS[0]);
    [base, elbow, step(elbow, turned + q[0] + q[1], LENGTHS[1])]
}

/// Returns the configuration at a time, from the cubics through positions and velocities.
fn configuration(found: &Coordination, arm: usize, time: f64) -> Place {
    let motion = &found.motions[arm].trajectory;
    let last = motion.time.len() - 1;
    let k = motion.time.partition_point(|at| *at <= time).clamp(1, last.max(1)) - 1;
    if last == 0 || time >= motion.time[last] {
        return motion.position[last];
    }
    let span = motion.time[k + 1] - motion.time[k];
    let u = ((time - motion.time[k]) / span).clamp(0.0, 1.0);
    [0, 1].map(|joint| {
        let [a, b] = [motion.position[k][joint], motion.position[k + 1][joint]];
        let [v, w] = [motion.velocity[k][joint] * span, motion.velocity[k + 1][joint] * span];
        let (u2, u3) = (u * u, u * u * u);
        a * (2.0 * u3 - 3.0 * u2 + 1.0) + v * (u3 - 2.0 * u2 + u) + b * (3.0 * u2 - 2.0 * u3) + w * (u3 - u2)
    })
}

/// Returns the distance by which the quill is lowered at a time.
fn depth(steps: &[StepTimes], time: f64) -> f64 {
    let lowered = steps.iter().filter_map(|step| {
        let event = step.event?;
        let stroke = step.end - event - DWELL;
        let share =
            if time <= event { 1.0 - (event - time) / stroke } else { 1.0 - (time - event - DWELL).max(0.0) / stroke };
        Some(LIFT * share.clamp(0.0, 1.0))
    });
    lowered.fold(0.0, f64::max)
}

/// The times at which an arm grasps and releases an object.
fn handled(found: &Coordination, arm: usize, name: &str) -> Option<[f64; 2]> {
    let own: Vec<f64> = found.steps[arm]
        .iter()
        .filter(|step| step.object.as_deref() == Some(name))
        .filter_map(|step| step.event)
        .collect();
    <[f64; 2]>::try_from(own).ok()
}

/// Replays motions, and returns the least distance of bodies of different arms.
fn replay(found: &Coordination, objects: &[Object], skew: f64, what: &str) -> f64 {
    let mut least = f64::INFINITY;
    let count = (found.duration * SAMPLES_PER_SECOND).ceil() as usize;
    for k in 0..=count {
        for shift in [-skew, 0.0, skew] {
            let time = found.duration * k as f64 / count as f64;
            let clocks = [time, (time + shift).max(0.0)];
            let mut bodies = [0, 1].map(|arm| {
                let [base, elbow, tip] = kinematics(arm, configuration(found, arm, clocks[arm]));
                let low = 0.18 - depth(&found.steps[arm], clocks[arm]);
                vec![
                    capsule("inner arm", [base, elbow], 0.055, [0.195, 0.265]),
                    capsule("outer arm", [elbow, tip], 0.05, [0.27, 0.43]),
                    capsule("quill", [tip, tip], 0.01, [low, low + 0.22]),
                    capsule("flange", [tip, tip], 0.02, [low, low + 0.01]),
                ]
            });
            let mut handed: Vec<Capsule> = Vec::new();
            for (number, object) in objects.iter().enumerate() {
                let name = format!("part {number}");
                let times = [0, 1].map(|arm| handled(found, arm, &name));
                let carried =
                    (0..2).find(|arm| times[*arm].is_some_and(|[a, b]| a <= clocks[*arm] && clocks[*arm] < b));
                let lies = |at: Place| capsule(&name, [at, at], OBJECT_RADIUS, [0.0, OBJECT_HEIGHT]);
                if let Some(arm) = carried {
                    let tip = bodies[arm][2].ends[0];
                    let up = LIFT - depth(&found.steps[arm], clocks[arm]);
                    bodies[arm].push(capsule(&name, [tip, tip], OBJECT_RADIUS, [up, up + OBJECT_HEIGHT]));
                    continue;
                }
                let is_done = |arm: usize| times[arm].is_some_and(|[_, b]| b <= clocks[arm]);
                match object.role {
                    Role::Given(giver, place) => match (is_done(giver), is_done(1 - giver)) {
                        (false, _) => bodies[giver].push(lies(object.at)),
                        (true, false) => handed.push(lies(place)),
                        (true, true) => bodies[1 - giver].push(lies(object.to)),
                    },
                    Role::Own(_) | Role::Shared => {
                        let arm = usize::from(times[0].is_none());
                        bodies[arm].push(lies(if is_done(arm) { object.to } else { object.at }));
                    }
                }
            }
            for (a, b) in bodies[0].iter().flat_map(|a| bodies[1].iter().map(move |b| (a, b))) {
                let here = distance(a, b);
                assert!(here >= CLEARANCE - TOLERANCE, "{what}: {} and {} at {clocks:?}: {here}", a.name, b.name);
                least = least.min(here);
            }
            // Grippers may touch an object that is handed over, but nothing else may.
            for (lies, body) in handed.iter().flat_map(|lies| bodies.iter().flatten().map(move |body| (lies, body))) {
                let here = distance(lies, body);
                let may_touch = ["outer arm", "quill", "flange"].contains(&body.name.as_str());
                assert!(may_touch || here >= CLEARANCE - TOLERANCE, "{what}: {} and {}: {here}", lies.name, body.name);
            }
        }
    }
    least
}

/// Checks that every object is picked where it lies and placed where it shall be, in order.
fn check_places(found: &Coordination, objects: &[Object], skew: f64, what: &str) {
    let is_at = |arm: usize, time: f64, place: Place| {
        let tip = kinematics(arm, configuration(found, arm, time))[2];
        (tip[0] - place[0]).hypot(tip[1] - place[1]) < TOLERANCE
    };
    for (number, object) in objects.iter().enumerate() {
        let times = [0, 1].map(|arm| handled(found, arm, &format!("part {number}")));
        match (object.role, times) {
            (Role::Given(giver, place), [Some(_), Some(_)]) => {
                let [[pick, put], [take, last]] = [times[giver].unwrap(), times[1 - giver].unwrap()];
                assert!(is_at(giver, pick, object.at) && is_at(giver, put, place), "{what}: part {number}");
                assert!(is_at(1 - giver, take, place) && is_at(1 - giver, last, object.to), "{what}: part {number}");
                assert!(put + skew < take, "{what}: part {number} is taken before it is placed");
            }
            (Role::Own(_) | Role::Shared, [Some([pick, put]), None] | [None, Some([pick, put])]) => {
                let arm = usize::from(times[0].is_none());
                assert!(object.role == Role::Shared || object.role == Role::Own(arm), "{what}: part {number}");
                assert!(is_at(arm, pick, object.at) && is_at(arm, put, object.to), "{what}: part {number}");
            }
            other => panic!("{what}: part {number}: {other:?}"),
        }
    }
    for (arm, steps) in found.steps.iter().enumerate() {
        assert!(steps.windows(2).all(|two| two[0].end <= two[1].begin + 1e-9), "{what}: steps of arm {arm} overlap");
        assert!(steps.iter().all(|step| step.begin <= step.arrival && step.arrival <= step.end), "{what}: {steps:?}");
    }
}

/// Returns the text of a cell with these objects.
fn cell_text(starts: [Place; 2], objects: &[Object], free: [bool; 2]) -> String {
    let robot = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../robots/scara.urdf");
    let mut text = format!("name = \"random\"\nclearance = {CLEARANCE}\n");
    let transfer = |table: &str, number: usize, from: &str, to: Place| {
        format!(
            "[[{table}]]\npick = \"part {number}\"\n{from}dwell = {DWELL}\n[[{table}]]\nplace = {{ at = {to:?} }}\ndwell = {DWELL}\n"
        )
    };
    for (arm, name) in ["left", "right"].into_iter().enumerate() {
        let base = if arm == 0 { "" } else { "base = { at = [0.8, 0.0], angle = \"180deg\" }\n" };
        let order = if free[arm] { "task = { order = \"free\" }\n" } else { "" };
        let _ = write!(
            text,
            "[[arm]]\nname = \"{name}\"\nurdf = \"{robot}\"\n{base}robot = {{ joints = [\"axis_1\", \"axis_2\"], tip = \"flange\", \
             payload = \"level\", wrist = {{ joint = \"axis_4\", velocity = 41.888 }}, stroke = {{ joint = \"axis_3\", acceleration = 10.0 }} }}\n\
             start = {{ joints = {:?} }}\n",
            starts[arm]
        );
        let mut own = String::new();
        for (number, object) in objects.iter().enumerate() {
            own += &match object.role {
                Role::Own(of) if of == arm => transfer("arm.step", number, "", object.to),
                Role::Given(giver, place) if giver == arm => transfer("arm.step", number, "", place),
                Role::Given(giver, _) if giver != arm => {
                    let from = format!("from = \"{}\"\n", ["left", "right"][giver]);
                    transfer("arm.step", number, &from, object.to)
                }
                _ => String::new(),
            };
        }
        // Without a goal, an arm would stay at its last place.
        let _ = writeln!(text, "goal = {{ joints = {:?} }}", starts[arm]);
        text += if own.is_empty() { "" } else { order };
        text += &own;
    }
    for (number, object) in objects.iter().enumerate() {
        if object.role == Role::Shared {
            text += &transfer("step", number, "", object.to);
        }
        let _ = write!(
            text,
            "[[object]]\nname = \"part {number}\"\ncircle = {{ center = [0.0, 0.0], radius = {OBJECT_RADIUS} }}\nat = {:?}\n\
             height = [0.0, {OBJECT_HEIGHT}]\nlift = {LIFT}\n",
            object.at
        );
    }
    text
}

/// Returns random objects that are apart from each other, wherever they are.
fn random_objects(dice: &mut Dice) -> Vec<Object> {
    let mut places: Vec<Place> = Vec::new();
    let mut place = |dice: &mut Dice, arm: Option<usize>| loop {
        let x = match arm {
            Some(0) => dice.within(0.1, 0.5),
            Some(_) => BETWEEN_BASES - dice.within(0.1, 0.5),
            None => dice.within(0.34, 0.46),
        };
        let at = [x, dice.within(-0.3, 0.3)];
        if places.iter().all(|other| (at[0] - other[0]).hypot(at[1] - other[1]) > 0.05) {
            places.push(at);
            return at;
        }
    };
    let mut object = |dice: &mut Dice| {
        let arm = dice.below(2_usize);
        match dice.below(4_u32) {
            0 => Object { at: place(dice, Some(arm)), to: place(dice, Some(arm)), role: Role::Own(arm) },
            1 | 2 => {
                let nest = place(dice, None);
                Object { at: place(dice, Some(arm)), to: place(dice, Some(1 - arm)), role: Role::Given(arm, nest) }
            }
            _ => Object { at: place(dice, None), to: place(dice, None), role: Role::Shared },
        }
    };
    (0..2 + dice.below(2_usize)).map(|_| object(dice)).collect()
}

fn planned(text: &str, skew: f64) -> Option<CellPlan> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("cell.toml");
    std::fs::write(&path, text).unwrap();
    let cell = Cell::load(&Source::read(&path).unwrap(), &Source::read, None).ok()?;
    let settings = Settings { skew, ..Settings::default() };
    Some(plan_cell(&cell, &settings, &mut |_| ()).unwrap())
}

#[test]
fn no_motion_of_random_tasks_collides() {
    let (mut found, mut handovers, mut waits) = (0, 0, 0);
    for seed in cplan_cases::seeds(40) {
        let mut dice = Dice::new(seed);
        let objects = random_objects(&mut dice);
        let starts = [0, 1].map(|_| [dice.within(0.8, 1.8), dice.within(0.3, 1.2)]);
        let skew = [0.0, 0.02, 0.2][dice.below(3_usize)];
        let text = cell_text(starts, &objects, [dice.chance(0.3), dice.chance(0.3)]);
        let Some(plan) = planned(&text, skew) else { continue };
        let what = format!("seed {seed}");
        match &plan.outcome {
            Outcome::Found(motion) => {
                let least = replay(motion, &objects, skew, &what);
                check_places(motion, &objects, skew, &what);
                assert!(motion.clearance <= least + TOLERANCE, "{what}: {} {least}", motion.clearance);
                let bound = plan.lower_bound.unwrap();
                assert!(bound <= motion.duration + 1e-9, "{what}: {bound} {}", motion.duration);
                found += 1;
                handovers += motion.handovers.len();
                waits += motion.waits.iter().map(Vec::len).sum::<usize>();
            }
            Outcome::Infeasible(_) | Outcome::Unknown(_) => {
                if std::env::var("SHOW").is_ok() {
                    eprintln!("{what}: {skew} {starts:?} {objects:?}\n{:#?}", plan.tried);
                }
            }
        }
    }
    if cplan_cases::uses_default_cases() {
        assert!(found >= 10 && handovers >= 5 && waits >= 8, "{found} {handovers} {waits}");
    }
}
