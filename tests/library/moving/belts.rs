//! Random tasks among moving obstacles, in which objects are picked while they move. The tests replay them with
//! computations of their own.

use cplan::engine::task::{Event, Leg, TaskAnswer};
use cplan::geometry::{Point, Pose, Vector};
use cplan::model::{
    Action, Arm, Goal, Heights, Holding, Item, JointType, MovingObstacle, Object, Obstacle, ObstacleTrajectory, Scene,
    Shape, Step, Stop, Task, TimedWorkspace, ToolValues, Workspace,
};
use cplan::space::Configuration;
use cplan_cases::dice::Dice;
use cplan_testkit::moving::{mover, obstacle_at, position};
use cplan_testkit::scenes::placed;
use cplan_testkit::shapes::{disc, rectangle};
use cplan_testkit::solid::{Solid, V, add, norm, rotate, sub};
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
        Item::Step(Step { action, number, cycle: 1, place, speed, dwell, tool, elevation: 0.0 })
    };
    let items = items.into_iter().zip(1..).map(&mut step).collect();
    let task =
        Task { arm, workspace, objects, start, items, wrist: None, stroke: None, start_tool: ToolValues::default() };
    task.check().ok().map(|_| task)
}

/// Returns a place that the tip can reach. In most cases, it also is one where the arm is free of static obstacles.
fn somewhere(dice: &mut Dice, still: &Scene) -> Point {
    let axes = still.arm().topology().ranges.map(|range| range.domain());
    let mut draw = || {
        let first = dice.within(axes[0].0, axes[0].1);
        Configuration::new(first, dice.within(axes[1].0, axes[1].1))
    };
    let tries: Vec<Configuration> = (0..20).map(|_| draw()).collect();
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
    }
}

/// A frame: cosine and sine of its turn, and its origin.
type Frame = (V, V);

fn compose(a: Frame, b: Frame) -> Frame {
    (rotate(b.0, a.0), add(a.1, rotate(b.1, a.0)))
}

fn inverse(a: Frame) -> Frame {
    let turn = [a.0[0], -a.0[1]];
    (turn, rotate([-a.1[0], -a.1[1]], turn))
}

/// Returns the frames of both links and of the tip.
pub fn frames(arm: &Arm, q: V) -> [Frame; 3] {
    let joint = |k: usize| match arm.joints[k].joint_type {
        JointType::Revolute { sign } => ([(sign * q[k]).cos(), (sign * q[k]).sin()], [0.0; 2]),
        JointType::Prismatic { direction } => ([1.0, 0.0], [direction.x * q[k], direction.y * q[k]]),
    };
    let still = |p: V| ([1.0, 0.0], p);
    let first = compose(still([arm.base.x, arm.base.y]), joint(0));
    let second = compose(compose(first, still([arm.offset.x, arm.offset.y])), joint(1));
    let tip = compose(second, still([arm.tip.x, arm.tip.y]));
    [first, second, ([1.0, 0.0], tip.1)]
}

/// Returns the frame of an object on its trajectory, from its stops.
pub fn pose_on_trajectory(object: &Object, time: f64) -> Frame {
    let Some(trajectory) = object.trajectory.clone() else {
        let angle = object.at.rotation.angle();
        return ([angle.cos(), angle.sin()], [object.at.translation.x, object.at.translation.y]);
    };
    // The object's pose follows from two of its points.
    let pieces = vec![disc(Point::zeros(), 0.1), disc(Point::new(1.0, 0.0), 0.1)];
    let points = Obstacle { name: String::new(), shape: Shape::Pieces, pieces, heights: Heights::ALL };
    let placed = obstacle_at(&MovingObstacle { obstacle: points, trajectory }, time).pieces;
    let [origin, beside] = [0, 1].map(|k| [placed[k].core()[0].x, placed[k].core()[0].y]);
    (sub(beside, origin), origin)
}

/// The poses of the objects during a task.
pub struct Replayed<'a> {
    task: &'a Task,
    lies: Vec<Option<Frame>>,
    moving: Vec<bool>,
    /// The carried object, the index of the body that carries it (link 2 or the tip), and the object's frame relative
    /// to that body.
    held: Option<(usize, usize, Frame)>,
    released: Option<usize>,
}

/// Returns the least distance between the arm with its payload and shapes that these must not touch, minus the
/// clearance. Also describes the moment at which it occurs. All motions of an answer are covered, and the times when
/// the arm waits between them. If the arm cannot continue, it may touch the object that it has just released.
///
/// # Errors
/// The difference from the requested task, in words.
pub fn replayed(task: &Task, answer: &TaskAnswer, looks: usize) -> Result<(f64, String), String> {
    let mut world = Replayed {
        task,
        lies: task
            .objects
            .iter()
            .map(|object| object.trajectory.is_none().then(|| pose_on_trajectory(object, 0.0)))
            .collect(),
        moving: task.objects.iter().map(|object| object.trajectory.is_some()).collect(),
        held: None,
        released: None,
    };
    let (mut least, mut clock, mut q) = ((f64::INFINITY, String::new()), 0.0, task.start);
    for leg in &answer.legs {
        let say = |what: String| format!("step {}: {what}", leg.step.number);
        let trajectory = &leg.timed.trajectory;
        if (leg.begin - clock).abs() > 1e-9 || (Configuration::from(trajectory.position[0]) - q).amax() > 1e-12 {
            return Err(say(format!("begins at {} s, not at {clock} s where the arm is", leg.begin)));
        }
        let mut see = |(room, what): (f64, String), time: f64| {
            if room < least.0 {
                least = (room, format!("step {} at {time} s: {what}", leg.step.number));
            }
        };
        let picked = if let Action::Pick { object, .. } = leg.step.action { Some(object) } else { None };
        for sample in 0..trajectory.time.len() - 1 {
            for k in 0..looks {
                let (time, q) = position(trajectory, sample, k as f64 / looks as f64);
                see(world.room_at([q[0], q[1]], leg.begin + time, [picked, None]), leg.begin + time);
            }
        }
        q = trajectory.position[trajectory.time.len() - 1].into();
        let arrival = leg.begin + trajectory.duration();
        see(world.room_at([q[0], q[1]], arrival, [picked, None]), arrival);
        let before = world.released;
        world.finish(leg, [q[0], q[1]], arrival).map_err(say)?;
        clock = arrival + leg.step.dwell;
        let goes_on = answer.failed().is_none() || !std::ptr::eq(leg, &answer.legs[answer.legs.len() - 1]);
        for k in (0..=10).take_while(|_| goes_on) {
            let time = arrival + leg.step.dwell * f64::from(k) / 10.0;
            see(world.room_at([q[0], q[1]], time, [None, before]), time);
        }
    }
    Ok(least)
}

impl Replayed<'_> {
    /// Returns the distance at a time to shapes that must not be touched, minus the clearance. Link 2 may touch the
    /// objects in `touched`.
    fn room_at(&self, q: V, time: f64, touched: [Option<usize>; 2]) -> (f64, String) {
        let Task { arm, workspace: TimedWorkspace { fixed, movers }, objects, .. } = self.task;
        let Workspace { obstacles, clearance, .. } = fixed;
        let frames = frames(arm, q);
        // Obstacles with their heights, and the number of the object.
        let moved: Vec<Obstacle> = movers.iter().map(|mover| obstacle_at(mover, time)).collect();
        let of = |obstacle: &Obstacle| {
            let heights = obstacle.heights;
            obstacle.pieces.iter().map(|piece| (None, Solid::new(piece), heights)).collect::<Vec<_>>()
        };
        let mut others: Vec<(Option<usize>, Solid, Heights)> = obstacles.iter().chain(&moved).flat_map(of).collect();
        for (number, object) in objects.iter().enumerate() {
            let Some(frame) = self.moving[number].then(|| pose_on_trajectory(object, time)).or(self.lies[number])
            else {
                continue;
            };
            let placed = |piece| (Some(number), Solid::new(piece).placed(frame.0, frame.1), object.heights);
            others.extend(object.pieces.iter().map(placed));
        }
        let may = |number: Option<usize>| number.is_some() && [touched[0], touched[1], self.released].contains(&number);
        let mut least = (f64::INFINITY, String::new());
        let mut meet = |body: &Solid, heights: Heights, link: Option<usize>| {
            for (place, (number, other, at)) in others.iter().enumerate() {
                let room = body.distance(other) - clearance;
                let meets = heights.lower <= at.upper && at.lower <= heights.upper;
                if meets && room < least.0 && !(link == Some(1) && may(*number)) {
                    least = (room, format!("{link:?} and number {place}, object {number:?}"));
                }
            }
        };
        for (link, l) in arm.links.iter().enumerate() {
            let (turn, place) = frames[link];
            l.parts.iter().for_each(|p| meet(&Solid::new(&p.shape).placed(turn, place), p.heights, Some(link)));
        }
        if let Some((object, by, frame)) = self.held {
            let (turn, place) = compose(frames[by], frame);
            let object = &objects[object];
            object.pieces.iter().for_each(|p| meet(&Solid::new(p).placed(turn, place), object.heights, None));
        }
        least
    }

    /// Applies the event at the end of a motion.
    fn finish(&mut self, leg: &Leg, q: V, time: f64) -> Result<(), String> {
        let frames = frames(&self.task.arm, q);
        let tip = frames[2].1;
        let near = |what: &str, a: V, b: V| {
            let off = norm(sub(a, b));
            if off < 1e-7 { Ok(()) } else { Err(format!("{what} is {off} m from where it was to be")) }
        };
        self.released = None;
        match &leg.step.action {
            Action::Move(Goal::Tip(target)) => near("the tip", tip, [target.x, target.y])?,
            Action::Move(Goal::Joints(_) | Goal::Area(_)) | Action::Follow(_) => (),
            Action::Pick { object, grasp, when, .. } => {
                let thing = &self.task.objects[*object];
                let moves = std::mem::take(&mut self.moving[*object]);
                if moves && !when.is_empty() && !when.iter().any(|[from, to]| (from - 1e-6..=to + 1e-6).contains(&time))
                {
                    return Err(format!("picked at {time} s"));
                }
                let lies = if moves {
                    pose_on_trajectory(thing, time)
                } else {
                    self.lies[*object].take().ok_or("it is nowhere")?
                };
                near("the tip", tip, compose(lies, ([1.0, 0.0], [grasp.x, grasp.y])).1)?;
                let by = if thing.holding == Holding::Level { 2 } else { 1 };
                self.held = Some((*object, by, compose(inverse(frames[by]), lies)));
            }
            Action::Place { at, .. } => {
                let (object, by, frame) = self.held.take().ok_or("nothing is held")?;
                let lies = compose(frames[by], frame);
                near("the object", lies.1, [at.x, at.y])?;
                self.lies[object] = Some(lies);
                self.released = Some(object);
                if !matches!(leg.event, Some(Event::Release { object: other, .. }) if other == object) {
                    return Err("something else is let go of".into());
                }
            }
        }
        Ok(())
    }
}
