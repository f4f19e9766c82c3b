//! The verdict on a recorded motion or task.

use super::claims::false_claims;
use super::ends::{END_TOLERANCE, endpoint_errors};
use super::findings::{self, ExceededLimits, Judgement, MotionFindings};
use super::margins::margins;
use super::replay::{misplaced_joints, replay};
use cplan_dynamics::Torques;
use cplan_handling::{Claims, HeldMotion, RecordedStep, Recording, Task, TimedScene};
use cplan_model::Scene;
use cplan_motion::recorded::{
    CollisionCheck, check_collision, check_collision_with, limit_violations, motor_violations, torque_violations,
};
use cplan_robot::InputError;
use cplan_world::{AllJoints, LoadedRecording, LoadedScene, Overrides, Rules};

/// Judges a recording. It must lead from the start to the goal of the world, or of `overrides`. If `anywhere` is true,
/// it may begin and end at any configuration. A recording with steps is judged as the world's task.
///
/// # Errors
/// Overrides that do not suit the world, and steps that an arm of this kind cannot do.
pub fn verify(
    loaded: &LoadedScene,
    recorded: &LoadedRecording,
    overrides: &Overrides,
    anywhere: bool,
) -> Result<MotionFindings, InputError> {
    let read = recorded.steps.as_ref().map(|_| loaded.clone().resolve(overrides, Rules::Recording)).transpose()?;
    if let Some((task, scene)) = read.as_ref().and_then(|read| Some((read.task.as_ref()?, read.problem.scene()))) {
        return verify_task(loaded, (task, scene), recorded, overrides);
    }
    let LoadedRecording { recording, held, claims, unjudged, .. } = recorded;
    let nothing = Claims::default();
    let claims = claims.as_ref().unwrap_or(&nothing);
    let mut findings =
        judge_motion(loaded, (recording, held), claims, overrides, anywhere, general_notes(loaded, recorded))?
            .with_faults(Judgement::Undecided, unjudged.clone());
    if findings.verdict == Judgement::Free {
        findings.margins = Some(margins(loaded, recording, held, findings.collisions.clearance));
    }
    Ok(findings.leaving(claims))
}

/// Judges a recording as a task of a robot. `scene` is that of the arm without a load. A recording without steps is one that
/// lacks all of them.
///
/// # Errors
/// Overrides that do not suit the world.
pub fn verify_task(
    loaded: &LoadedScene,
    task: (&Task, &Scene),
    recorded: &LoadedRecording,
    overrides: &Overrides,
) -> Result<MotionFindings, InputError> {
    let LoadedRecording { recording, steps, all_joints, claims, .. } = recorded;
    let nothing = Claims::default();
    let claims = claims.as_ref().unwrap_or(&nothing);
    let record = (recording, steps.as_deref().unwrap_or_default(), all_joints.as_ref());
    let findings = judge_task(loaded, task, record, claims, overrides, general_notes(loaded, recorded))?;
    Ok(findings.leaving(claims))
}

/// Returns notes about the world, the file, turns between samples, and limits that are assumed.
fn general_notes(loaded: &LoadedScene, LoadedRecording { recording, notes, .. }: &LoadedRecording) -> Vec<String> {
    let turns = describe_jumps(&loaded.scene, recording);
    let assumed = recording.times().map(|_| loaded.robot.assumptions(loaded.scene.arm())).unwrap_or_default();
    loaded.world.notes.iter().chain(notes).cloned().chain(turns).chain(assumed).collect()
}

fn judge_motion(
    loaded: &LoadedScene,
    (recording, held): (&Recording, &[HeldMotion]),
    claims: &Claims,
    overrides: &Overrides,
    anywhere: bool,
    mut notes: Vec<String>,
) -> Result<MotionFindings, InputError> {
    if loaded.is_task() && !loaded.has_steps() {
        notes.push(
            "the motion must begin and end with the values that the world states for the tool's joints; speeds of the tool are not judged, because the file has no steps"
                .into(),
        );
    }
    if loaded.has_steps() {
        notes.push(
            "the world has steps, but the file has none: one motion without a payload is judged, with all objects at their initial positions; to judge the steps, verify a task's result in .json"
                .into(),
        );
        notes.extend(
            (!held.is_empty())
                .then(|| "the motion with the moving tool is judged only among obstacles, without objects".into()),
        );
    }
    let scene = &loaded.scene;
    let (start, goals) = if anywhere { (None, Vec::new()) } else { loaded.ends(overrides)? };
    notes.push(match (start.is_some(), !goals.is_empty()) {
        (true, true) => format!("the motion must begin at the start and end at the goal, each within {END_TOLERANCE}"),
        (true, false) => {
            format!("the motion must begin at the start, within {END_TOLERANCE}; there is no goal")
        }
        (false, true) => {
            format!("the motion must end at the goal, within {END_TOLERANCE}; there is no start")
        }
        (false, false) => "start and goal of the motion are not judged".into(),
    });
    let has_moving_obstacles = !loaded.trajectories.is_empty();
    if has_moving_obstacles {
        notes.push("moving obstacles start with the first sample of the recording".into());
    }
    let untold = [
        (has_moving_obstacles && recording.times().is_none())
            .then_some("obstacles move, but the file has no times: whether the motion hits them is unknown"),
        (Torques::limited(scene).is_some() && recording.velocities().is_none())
            .then_some("efforts are limited, but the file has no velocities: torques are unknown"),
        (Torques::limited(scene).is_some() && !held.is_empty())
            .then_some("efforts are limited, but joints of the tool move: torques are unknown"),
    ];
    let clearance = scene.workspace().clearance;
    let with_tool = |scene: TimedScene| match held {
        [] => check_collision(scene, recording, clearance),
        held => check_collision_with(scene, recording, held, clearance),
    };
    // During steps, the tool moves down to objects, so the moving tool is judged without objects. The arm with its tool
    // at rest is judged with them.
    let without_objects;
    let (checked, collision_check) = if loaded.has_steps() && !held.is_empty() {
        without_objects = loaded.without_objects();
        let (scene_without, trajectories) = &without_objects;
        let among_objects = check_collision(loaded.timed(), recording, clearance);
        let lowered = with_tool(TimedScene { scene: scene_without, trajectories });
        worse((scene, among_objects), (scene_without, lowered))
    } else {
        (scene, with_tool(loaded.timed()))
    };
    let collision_check = match collision_check {
        // Shapes that are enlarged for errors may touch although no robot within the errors collides.
        CollisionCheck::Collision { deepest, .. } if loaded.world.has_errors() => {
            let certain = TimedScene { scene: &scene.inner(), ..loaded.timed() };
            let is_collision =
                matches!(check_collision(certain, recording, clearance), CollisionCheck::Collision { .. });
            if is_collision { collision_check } else { CollisionCheck::Undecided(deepest) }
        }
        _ => collision_check,
    };
    let mut broken = limit_violations(&scene.arm().joints, recording);
    broken.extend(motor_violations(scene.arm(), recording));
    broken.extend(torque_violations(scene, recording));
    let broken = ExceededLimits::new(&scene.arm().joints, &broken, &loaded.robot.assumed);
    let findings = MotionFindings::new(checked, recording, &collision_check, broken, notes);
    let misses = endpoint_errors(scene.arm(), recording, start, &goals);
    let tool_misses = if anywhere { Vec::new() } else { tool_errors(loaded, recording, held)? };
    let false_claims = false_claims(loaded.timed(), recording, claims, &collision_check);
    let findings = findings.with_faults(Judgement::Undecided, untold.into_iter().flatten().collect());
    let findings = findings.with_faults(Judgement::Ends, misses).with_faults(Judgement::Ends, tool_misses);
    Ok(findings.with_faults(Judgement::Claims, false_claims))
}

/// Returns the worse of two checks of a motion, each with its scene. A collision is worst, then an undecided check,
/// then the smaller clearance.
fn worse<'s>(one: (&'s Scene, CollisionCheck), other: (&'s Scene, CollisionCheck)) -> (&'s Scene, CollisionCheck) {
    let rank = |(_, check): &(&Scene, CollisionCheck)| match check {
        CollisionCheck::Collision { .. } => (0, 0.0),
        CollisionCheck::Undecided(_) => (1, 0.0),
        CollisionCheck::Free { clearance, .. } => (2, *clearance),
    };
    if rank(&other) < rank(&one) { other } else { one }
}

/// Describes the differences between recorded and stated values of the tool's joints at both ends of a motion. A joint
/// without values in the file has its default value.
fn tool_errors(loaded: &LoadedScene, recording: &Recording, held: &[HeldMotion]) -> Result<Vec<String>, InputError> {
    if !loaded.is_task() || loaded.has_steps() {
        return Ok(Vec::new());
    }
    let joints = &loaded.robot.joints;
    let last = recording.positions().len() - 1;
    let mut errors = Vec::new();
    for (tool, (sample, what)) in loaded.tool_values()?.into_iter().zip([(0, "begins"), (last, "ends")]) {
        let stroke = joints.stroke.as_ref().map(|stroke| (&stroke.joint, stroke.lowered(tool.depth)));
        for (joint, asked) in stroke.into_iter().chain(joints.wrist.as_ref().zip(tool.wrist)) {
            let moved = held.iter().find(|moved| moved.joint.name == joint.name);
            let is = moved.map_or(joint.rest, |moved| moved.values.positions()[sample][0]);
            if (is - asked).abs() > END_TOLERANCE {
                errors.push(format!("joint \"{}\" {what} at {is}, not at {asked}", joint.name));
            }
        }
    }
    Ok(errors)
}

fn judge_task(
    loaded: &LoadedScene,
    (task, scene): (&Task, &Scene),
    (recording, steps, all_joints): (&Recording, &[RecordedStep], Option<&AllJoints>),
    claims: &Claims,
    overrides: &Overrides,
    mut notes: Vec<String>,
) -> Result<MotionFindings, InputError> {
    notes.push(
        "judged: whether each step is a step of the world, in an allowed order; its motion, with its payload and with all objects where they are at that time; limits, grasps, places, turns and rests; and what the file states about steps and events. Not judged: margins of tasks"
            .into(),
    );
    let replay = replay(task, recording, steps);
    let assumed = &loaded.robot.assumed;
    let (findings, tools) = findings::judge_steps(task, scene, assumed, (recording, steps), replay, claims, notes);
    let Some(AllJoints { joints, held }) = all_joints else { return Ok(findings) };
    let misplaced = misplaced_joints(task, &loaded.robot.joints, recording, (steps, &tools), joints);
    if misplaced.is_empty() || loaded.has_steps() {
        return Ok(findings.with_faults(Judgement::Task, misplaced));
    }
    // The file states the motion of the tool twice. Judge the motion of all joints like that of any other file.
    let Some(held) = held else { return Ok(findings.with_faults(Judgement::Task, misplaced)) };
    let judged = judge_motion(loaded, (&joints.arm, held), &Claims::default(), overrides, false, Vec::new())?;
    let mut findings = findings.with_faults(Judgement::Task, misplaced).with_faults(Judgement::Ends, judged.faults);
    if judged.verdict == Judgement::Collision {
        (findings.verdict, findings.collisions) = (judged.verdict, judged.collisions);
    }
    Ok(findings)
}

/// Describes steps between samples that look like jumps because angles were wrapped. `None` if there are none.
fn describe_jumps(scene: &Scene, recording: &Recording) -> Option<String> {
    let turns = recording.turns(&scene.arm().topology());
    let &(sample, k) = turns.first()?;
    let joint = &scene.arm().joints[k];
    let step = recording.positions()[sample + 1][k] - recording.positions()[sample][k];
    let others = match turns.len() {
        1 => String::new(),
        n => format!(" ({} such steps more)", n - 1),
    };
    Some(format!(
        "from sample {sample} to {}, joint \"{}\" turns by {}, and this whole turn is checked{others}; if the file keeps angles within one turn, use --unwrap",
        sample + 1,
        joint.name,
        joint.format_value(step)
    ))
}
