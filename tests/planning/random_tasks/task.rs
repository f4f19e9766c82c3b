//! Random tasks, the same for the same seed: all kinds of arms, rigid and level payloads, objects on supports.

use cplan::geometry::{Convex, Point, Pose, Vector, hull};
use cplan::model::{
    Action, Arch, Goal, Heights, Holding, Item, Object, Obstacle, Part, Shape, Step, Stroke, Task, ToolJoint,
    ToolValues, Workspace, Wrist,
};
use cplan::space::{Configuration, JointRange};
use cplan_cases::dice::Dice;
use cplan_testkit::arms::all_kinds;
use cplan_testkit::scenes::{self, clutter, obstacle, placed};
use cplan_testkit::shapes::{convex, disc};
use std::f64::consts::{PI, TAU};

pub fn task(seed: u64) -> Task {
    let mut dice = Dice::new(seed.wrapping_mul(0x2545_F491_4F6C_DD1D));
    let kinds = all_kinds();
    let arm = kinds[dice.below(kinds.len())].clone();
    let clearance = if dice.chance(0.2) { dice.within(0.0, 0.01) } else { 0.0 };
    let mut obstacles: Vec<_> = Vec::new();
    for (i, piece) in clutter().into_iter().enumerate() {
        if dice.chance(0.4) {
            obstacles.push(obstacle(&format!("o{i}"), piece));
        }
    }
    let workspace = Workspace { name: "random".into(), obstacles, clearance, preferences: Vec::new() };
    // Places that the tip can reach: forward kinematics of random configurations, most of them free of static
    // obstacles.
    let still = placed(arm.clone(), workspace.clone());
    let anywhere = |dice: &mut Dice| {
        let tries: Vec<Configuration> = (0..20).map(|_| scenes::anywhere(dice, still.arm())).collect();
        let free = tries.iter().find(|q| still.obstructions(**q).is_empty());
        *free.filter(|_| dice.chance(0.9)).unwrap_or(&tries[0])
    };
    let count = 1 + dice.below(3);
    let mut objects = Vec::new();
    for i in 0..count {
        let (shape, pieces) = outline(&mut dice);
        let at = arm.tip_at(anywhere(&mut dice));
        let holding = if dice.chance(0.5) { Holding::Rigid } else { Holding::Level };
        objects.push(Object {
            name: format!("part {i}"),
            shape,
            pieces,
            heights: if dice.chance(0.3) { Heights { lower: 0.0, upper: 0.05 } } else { Heights::ALL },
            // The object is carried at exactly the height at which others end.
            lift: if dice.chance(0.3) { 0.05 } else { 0.0 },
            holding,
            at: Pose::new(at, dice.within(-PI, PI)),
            trajectory: None,
            mass: 0.0,
            presence: None,
        });
    }
    // Somewhere free among all objects.
    let all: Vec<_> = objects.iter().map(|object| Some(object.at.into())).collect();
    let mut task = Task {
        arm,
        workspace: workspace.into(),
        objects,
        start: Configuration::zeros(),
        items: Vec::new(),
        wrist: Some(Wrist { velocity: 3.0, acceleration: 12.0, jerk: None, turns_on_the_way: false, joint: None }),
        stroke: None,
        start_tool: ToolValues::default(),
    };
    let scene = task.scene(&all, &[], None, []);
    task.start = (0..500).map(|_| anywhere(&mut dice)).find(|q| scene.obstructions(*q).is_empty()).unwrap_or_default();
    if !scene.obstructions(task.start).is_empty() {
        // No start is free, so the task gets no obstacles.
        task.workspace.fixed.obstacles.clear();
    }
    let fixed = task.workspace.fixed.obstacles.len();
    let mut number = 0;
    let mut step = |action: Action, dice: &mut Dice| {
        number += 1;
        Step {
            action,
            number,
            cycle: 1,
            place: String::new(),
            speed: if dice.chance(0.2) { dice.within(0.2, 1.0) } else { 1.0 },
            dwell: if dice.chance(0.5) { dice.within(0.0, 0.5) } else { 0.0 },
            tool: ToolValues::default(),
            elevation: 0.0,
            elbow: None,
        }
    };
    let mut pairs = Vec::new();
    for object in 0..count {
        let mut supports = || (0..fixed).filter(|_| dice.chance(0.2)).collect::<Vec<usize>>();
        let (from, onto) = (supports(), supports());
        let grasp = if dice.chance(0.3) { Point::new(dice.within(-0.05, 0.05), 0.02) } else { Point::zeros() };
        let pick = step(Action::Pick { object, grasp, supports: from, when: Vec::new() }, &mut dice);
        let at = task.arm.tip_at(anywhere(&mut dice));
        let level = task.objects[object].holding == Holding::Level;
        let angle = (level && dice.chance(0.5)).then(|| dice.within(-TAU, TAU));
        let place = step(Action::Place { at, angle, supports: onto }, &mut dice);
        pairs.push([pick, place]);
    }
    if dice.chance(0.4) {
        task.items.push(Item::AnyOrder(pairs));
    } else {
        for [pick, place] in pairs {
            task.items.push(Item::Step(pick));
            if dice.chance(0.3) {
                let tip = task.arm.tip_at(anywhere(&mut dice));
                task.items.push(Item::Step(step(Action::Move(Goal::Tip(tip)), &mut dice)));
            }
            task.items.push(Item::Step(place));
        }
    }
    if dice.chance(0.5) {
        task.items.push(Item::Step(step(Action::Move(Goal::Joints(task.start)), &mut dice)));
    }
    task
}

/// Returns a task among obstacles of several heights, for an arm whose tool is lowered at picks and places.
pub fn with_arches(seed: u64) -> Task {
    const DEPTH: f64 = 0.15;
    let mut task = task(seed);
    let mut dice = Dice::new(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15));
    let mut heights = |obstacle: &mut Obstacle| {
        let upper = [0.04, 0.1, 0.16, 0.25, 0.5][dice.below(5)];
        obstacle.heights = Heights { lower: if dice.chance(0.2) { upper - 0.03 } else { 0.0 }, upper };
    };
    task.workspace.fixed.obstacles.iter_mut().for_each(&mut heights);
    let high = Heights { lower: 0.3, upper: 0.4 };
    task.arm.links.iter_mut().flat_map(|link| &mut link.parts).for_each(|part| part.heights = high);
    task.arm.links[1].parts.push(Part {
        shape: disc(task.arm.tip, 0.02),
        inner: None,
        padding: 0.0,
        number: 0,
        is_visual: false,
        heights: Heights { lower: DEPTH + 0.05, upper: 0.3 },
        body: "tool".into(),
    });
    // Posts beside the objects, over which the tool and its load pass only when they are raised.
    for object in &task.objects {
        let (sin, cos) = dice.within(-PI, PI).sin_cos();
        let post = disc(object.at.translation + Vector::new(cos, sin) * 0.16, 0.04);
        let post = Obstacle { heights: Heights { lower: 0.0, upper: 0.14 }, ..obstacle("post", post) };
        let number = task.workspace.fixed.obstacles.len();
        task.workspace.fixed.obstacles.push(Obstacle { name: format!("post {number}"), ..post });
    }
    for object in &mut task.objects {
        (object.heights, object.lift) = (Heights { lower: 0.0, upper: 0.05 }, DEPTH);
    }
    let joint = ToolJoint {
        name: "quill".into(),
        rest: 0.0,
        sign: 1.0,
        range: JointRange::Interval { lower: -DEPTH, upper: 0.0 },
        direction: 0.0,
    };
    let arch =
        Arch { rise: if dice.chance(0.3) { 0.05 } else { 0.0 }, fall: if dice.chance(0.3) { 0.03 } else { 0.0 } };
    let (velocity, acceleration, bodies) = (0.6, 4.0, vec!["tool".into()]);
    // With another travel than the lift, the load's height during strokes is known only within bounds.
    let travel = dice.chance(0.3).then_some(0.8 * DEPTH);
    task.stroke = Some(Stroke { joint, travel, velocity, acceleration, jerk: None, bodies, arch: Some(arch) });
    task
}

/// Returns a task in which the wrist turns objects while the arm moves, with or without strokes. All objects are level,
/// and are placed at angles.
pub fn with_turns(seed: u64) -> Task {
    let mut task = if seed.is_multiple_of(3) { task(seed) } else { with_arches(seed) };
    let mut dice = Dice::new(seed.wrapping_mul(0xD1B5_4A32_D192_ED03));
    let mut turn = |step: &mut Step| {
        if let Action::Place { angle, .. } = &mut step.action {
            *angle = angle.or(dice.chance(0.8).then(|| dice.within(-TAU, TAU)));
        }
    };
    for item in &mut task.items {
        match item {
            Item::Step(step) => turn(step),
            Item::AnyOrder(pairs) => pairs.iter_mut().flatten().for_each(&mut turn),
            Item::Renew(_) => {}
        }
    }
    task.objects.iter_mut().for_each(|object| object.holding = Holding::Level);
    let quick = dice.within(1.0, 6.0);
    task.wrist = Some(Wrist {
        velocity: 3.0 * quick,
        acceleration: 12.0 * quick,
        jerk: None,
        turns_on_the_way: true,
        joint: None,
    });
    task
}

fn outline(dice: &mut Dice) -> (Shape, Vec<Convex>) {
    let size = dice.within(0.01, 0.05);
    if dice.chance(0.3) {
        let center = Point::new(dice.within(-0.02, 0.02), 0.0);
        return (Shape::Circle { center, radius: size }, vec![disc(center, size)]);
    }
    let spot = |dice: &mut Dice| Vector::new(dice.within(-2.0, 2.0), dice.within(-1.0, 1.0)) * size;
    let corners = hull(&(0..5).map(|_| spot(dice)).collect::<Vec<_>>());
    (Shape::Polygon(corners.clone()), vec![convex(corners, 0.0)])
}
