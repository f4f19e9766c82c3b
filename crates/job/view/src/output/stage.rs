//! The scene of a recording: the arm's links, obstacles and objects, and their poses over time.

use cplan_engine::Plan;
use cplan_geometry::Pose;
use cplan_handling::{Task, TimedScene};
use cplan_legs::{Event, Leg, TaskAnswer, TimedTurn};
use cplan_model::space::Configuration;
use cplan_model::{Grip, Obstacle, Part};
use cplan_motion::{Body, Solid, Stage};
use cplan_theme::{GRAY, INK, Rgb, obstacle as obstacle_color};

/// Index of the arm's first link among the bodies of the recording. Index 0 is the workspace.
const FIRST_LINK: usize = 1;
/// Index of the first object among the bodies of the recording.
const FIRST_OBJECT: usize = 3;

/// Returns the bodies and their poses during the motion. `None` without a motion.
pub(super) fn stage(plan: &Plan) -> Option<Stage> {
    let (arm, trajectory) = (plan.arm(), plan.trajectory()?);
    let TimedScene { scene, trajectories } = plan.problem().timed();
    // Objects are separate bodies.
    let task = plan.problem().task();
    let [objects, movers] = task.map_or([0, usize::MAX], |task| [task.objects.len(), task.workspace.movers.len()]);
    let obstacles = &scene.workspace().obstacles;
    let obstacles = &obstacles[..obstacles.len() - objects];
    let mut stage = Stage {
        plane: arm.plane,
        bodies: vec![Body {
            name: "workspace".into(),
            solids: obstacles.iter().enumerate().map(placed_solid).collect(),
        }],
        poses: vec![(0.0, 0, Pose::identity(), 0.0)],
        size: arm.reach(),
    };
    for (number, link) in arm.links.iter().enumerate() {
        // A payload is a separate body, not a part of the arm.
        stage.bodies.push(of_link(&link.name, scene.own_parts(number)));
    }
    for (&time, &q) in trajectory.time.iter().zip(&trajectory.position) {
        let poses = arm.poses(q.into());
        let moved = poses.into_iter().enumerate().map(|(link, pose)| (time, FIRST_LINK + link, pose, 0.0));
        stage.poses.extend(moved);
    }
    if let Some((task, answer)) = plan.task() {
        with_objects(&mut stage, task, answer, &trajectory.time);
    }
    let movers = scene.loose_obstacles().iter().take(movers).map(|loose| &loose.obstacle).zip(trajectories);
    for (number, (obstacle, path)) in movers.enumerate() {
        let solid = placed_solid((obstacles.len() + number, obstacle));
        let body = stage.bodies.len();
        stage.bodies.push(Body { name: format!("moving/{}", obstacle.name), solids: vec![solid] });
        stage.poses.extend(trajectory.time.iter().map(|&time| (time, body, path.pose(time), 0.0)));
    }
    stage.poses.sort_by(|a, b| a.0.total_cmp(&b.0));
    Some(stage)
}

/// Adds the objects with their poses over time. An object is at its initial place or on its trajectory, then carried, then at the
/// place where it is released.
fn with_objects(stage: &mut Stage, task: &Task, answer: &TaskAnswer, times: &[f64]) {
    for (number, object) in task.objects.iter().enumerate() {
        let of_all = task.obstacle_number(number);
        let solid = Solid {
            name: object.name.clone(),
            color: parts_of(obstacle_color(of_all)),
            pieces: object.pieces.iter().map(|piece| (piece.clone(), object.heights)).collect(),
        };
        stage.bodies.push(Body { name: format!("object/{}", object.name), solids: vec![solid] });
        stage.poses.push((0.0, FIRST_OBJECT + number, object.at, 0.0));
        if let Some(trajectory) = &object.trajectory {
            let grasped = |leg: &Leg| leg.event_time().filter(|_| leg.event == Some(Event::Grasp { object: number }));
            let until = answer.legs.iter().find_map(grasped).unwrap_or(f64::INFINITY);
            let moves = times.iter().filter(|&&time| 0.0 < time && time <= until);
            stage.poses.extend(moves.map(|&time| (time, FIRST_OBJECT + number, trajectory.pose(time), 0.0)));
        }
    }
    let turns = TimedTurn::all(task, &answer.legs);
    for leg in &answer.legs {
        if let (Some(object), Some(payload)) = (leg.carried, leg.scene.attachment()) {
            let lift = task.objects[object].lift;
            let motion = &leg.timed.trajectory;
            stage.poses.extend(motion.time.iter().zip(&motion.position).map(|(&time, &q)| {
                let mut grip = payload.grip;
                if let (Grip::Level { angle, .. }, Some(turned)) =
                    (&mut grip, TimedTurn::angle_of(&turns, object, leg.begin + time))
                {
                    *angle = turned;
                }
                (leg.begin + time, FIRST_OBJECT + object, grip.pose(&task.arm, Configuration::from(q)), lift)
            }));
        }
        if let (Some(Event::Release { object, pose }), Some(time)) = (leg.event, leg.event_time()) {
            stage.poses.push((time, FIRST_OBJECT + object, pose, leg.step.elevation));
        }
    }
}

fn placed_solid((number, obstacle): (usize, &Obstacle)) -> Solid {
    Solid {
        name: obstacle.name.clone(),
        color: parts_of(obstacle_color(number)),
        pieces: obstacle.pieces.iter().map(|piece| (piece.clone(), obstacle.heights)).collect(),
    }
}

fn of_link(name: &str, parts: &[Part]) -> Body {
    let pieces = parts.iter().map(|part| (part.shape.clone(), part.heights)).collect();
    let color = parts_of(INK.mixed(GRAY, 0.5));
    Body { name: format!("link/{name}"), solids: vec![Solid { name: name.to_owned(), color, pieces }] }
}

fn parts_of(Rgb(red, green, blue): Rgb) -> [f32; 3] {
    [red, green, blue].map(|part| f32::from(part) / 255.0)
}
