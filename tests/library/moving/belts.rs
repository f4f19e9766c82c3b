//! Random tasks among moving obstacles, in which objects are picked while they move.

use cplan::geometry::{Point, Pose, Vector};
use cplan::model::{
    Action, Goal, Heights, Holding, Item, Object, ObstacleTrajectory, Scene, Shape, Step, Stop, Task, TimedWorkspace,
    ToolValues,
};
use cplan::space::Configuration;
use cplan_cases::dice::Dice;
use cplan_testkit::moving::mover;
use cplan_testkit::scenes::{anywhere, placed};
use cplan_testkit::shapes::{disc, rectangle};
use cplan_testkit::world::world;

/// Returns a task for a kind of arm and a seed. `None` if this seed gives no task.
pub fn drawn(kind: &str, seed: u64) -> Option<Task> {
    let standing = world(kind, seed)?;
    let mut dice = Dice::new(seed.wrapping_mul(0x51_7cc1_b727).wrapping_add(u64::from(kind.as_bytes()[1])));
    let start = standing.start();
    let (arm, mut workspace) = standing.into_scene().into_parts();
    workspace.obstacles.truncate(dice.below(4));
    let count = 1 + dice.below(2_usize);
    let still = placed(arm.clone(), workspace.clone());
    let mut workspace = TimedWorkspace::from(workspace);
    workspace.movers = (0..dice.below(3_usize))
        .map(|_| {
            let halfway = somewhere(&mut dice, &still);
            mover(&mut dice, arm.base, arm.reach(), halfway)
        })
        .collect();
    let level = dice.chance(0.3) && !workspace.movers.iter().any(|mover| mover.trajectory.turns());
    let objects = (0..count).map(|number| object(&mut dice, &still, number, level)).collect();
    let mut items = Vec::new();
    for object in 0..count {
        let grasp = if dice.chance(0.3) { Point::new(0.03, 0.01) } else { Point::zeros() };
        items.push(Action::Pick { object, grasp, supports: Vec::new(), when: Vec::new() });
        if dice.chance(0.3) {
            items.push(Action::Move(Goal::Tip(somewhere(&mut dice, &still))));
        }
        items.push(Action::Place { at: somewhere(&mut dice, &still), angle: None, supports: Vec::new() });
    }
    let mut step = |(action, number)| {
        let speed = if dice.chance(0.2) { dice.within(0.4, 1.0) } else { 1.0 };
        let dwell = if dice.chance(0.5) { dice.within(0.0, 0.4) } else { 0.0 };
        let (place, tool) = (String::new(), ToolValues::default());
        Item::Step(Step { action, number, cycle: 1, place, speed, dwell, tool, elevation: 0.0, elbow: None })
    };
    let items = items.into_iter().zip(1..).map(&mut step).collect();
    let task =
        Task { arm, workspace, objects, start, items, wrist: None, stroke: None, start_tool: ToolValues::default() };
    task.check().ok().map(|_| task)
}

/// Returns a place that the tip can reach. In most cases, it also is one where the arm is free of static obstacles.
fn somewhere(dice: &mut Dice, still: &Scene) -> Point {
    let tries: Vec<Configuration> = (0..20).map(|_| anywhere(dice, still.arm())).collect();
    still.arm().tip_at(*tries.iter().find(|q| still.clearance(**q) > 0.1).unwrap_or(&tries[0]))
}

/// Returns an object that passes a place within reach, or that lies there.
fn object(dice: &mut Dice, still: &Scene, number: usize, level: bool) -> Object {
    let size = dice.within(0.02, 0.06);
    let piece =
        if dice.chance(0.5) { disc(Point::zeros(), size) } else { rectangle(-size, size, -size / 2.0, size / 2.0) };
    let (place, angle) = (somewhere(dice, still), dice.within(-1.0, 1.0));
    let direction = dice.within(-3.2, 3.2);
    let speed = Vector::new(direction.cos(), direction.sin()) * dice.within(0.03, 0.25) * still.arm().reach();
    let from = place - speed * dice.within(2.0, 9.0);
    let stop = |time: f64, at: Point, angle: f64| Stop { time, at, angle };
    let trajectory = match dice.below(4_usize) {
        0 => None,
        1 if !level => {
            // The object comes, stops, turns and leaves.
            let stops = vec![stop(1.0, from, angle), stop(4.0, place, angle + 0.5), stop(5.5, place, angle + 0.5)];
            Some(ObstacleTrajectory::new(stops, speed).expect("a trajectory"))
        }
        _ => Some(ObstacleTrajectory::new(vec![stop(0.0, from, angle)], speed).expect("a trajectory")),
    };
    let at = trajectory.as_ref().map_or_else(|| Pose::new(place, angle), |trajectory| trajectory.pose(0.0));
    Object {
        name: format!("part {number}"),
        shape: Shape::Pieces,
        pieces: vec![piece],
        heights: Heights::ALL,
        lift: 0.0,
        holding: if level { Holding::Level } else { Holding::Rigid },
        at,
        trajectory,
        mass: 0.0,
        presence: None,
    }
}
