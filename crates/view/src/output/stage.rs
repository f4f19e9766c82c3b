//! The scene of a recording: the arm's links, obstacles and objects, and their places over time.

use cplan_engine::{Detail, Plan};
use cplan_geometry::Pose;
use cplan_handling::{ObstacleTrajectory, Task};
use cplan_model::space::Configuration;
use cplan_model::{Grip, Obstacle, Part};
use cplan_motion::{Body, Solid, Stage};
use cplan_tasks::{Event, Leg, TaskAnswer, TimedTurn};
use cplan_theme::{GRAY, INK, Rgb, obstacle as obstacle_color};

/// Index of the first link among the bodies of the recording. The workspace has index 0.
const FIRST_LINK: usize = 1;
/// Index of the first object among the bodies of the recording.
const FIRST_OBJECT: usize = 3;

/// Returns the bodies and their poses during the motion; `None` if there is no motion.
pub(super) fn stage(plan: &Plan) -> Option<Stage> {
    let (arm, trajectory) = (plan.arm(), plan.trajectory()?);
    let obstacles = match plan.detail() {
        Detail::Motion { problem, .. } => &problem.scene().workspace().obstacles,
        Detail::Task { task, .. } => &task.workspace.fixed.obstacles,
    };
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
        // A payload is a body of its own, so it is not among the parts of the arm.
        let parts = match plan.detail() {
            Detail::Motion { problem, .. } => problem.scene().own_parts(number),
            Detail::Task { .. } => &link.parts,
        };
        stage.bodies.push(of_link(&link.name, parts));
    }
    for (&time, &q) in trajectory.time.iter().zip(&trajectory.position) {
        let poses = arm.poses(q.into());
        let moved = poses.into_iter().enumerate().map(|(link, pose)| (time, FIRST_LINK + link, pose, 0.0));
        stage.poses.extend(moved);
    }
    match plan.detail() {
        Detail::Motion { problem, .. } => {
            let loose = problem.scene().loose_obstacles().iter().map(|loose| &loose.obstacle);
            with_movers(&mut stage, obstacles.len(), loose.zip(plan.problem().timed().trajectories), &trajectory.time);
        }
        Detail::Task { task, answer } => {
            with_objects(&mut stage, task, answer, &trajectory.time);
            let movers = task.workspace.movers.iter().map(|mover| (&mover.obstacle, &mover.trajectory));
            with_movers(&mut stage, obstacles.len(), movers, &trajectory.time);
        }
    }
    stage.poses.sort_by(|a, b| a.0.total_cmp(&b.0));
    Some(stage)
}

/// Adds moving obstacles, which are numbered after the static ones. Each gets a pose for each of `times`.
fn with_movers<'a>(
    stage: &mut Stage,
    standing: usize,
    movers: impl Iterator<Item = (&'a Obstacle, &'a ObstacleTrajectory)>,
    times: &[f64],
) {
    for (number, (obstacle, trajectory)) in movers.enumerate() {
        let solid = placed_solid((standing + number, obstacle));
        let body = stage.bodies.len();
        stage.bodies.push(Body { name: format!("moving/{}", obstacle.name), solids: vec![solid] });
        stage.poses.extend(times.iter().map(|&time| (time, body, trajectory.pose(time), 0.0)));
    }
}

/// Adds the objects with their poses over time. They are at their initial places or on their trajectories, then
/// carried, then at the places where they are released.
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
            stage.poses.push((time, FIRST_OBJECT + object, pose, 0.0));
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
