//! The margins of a plan: displacements of bodies, and errors of the arm's model, for which its motion stays free.

use super::plan::{Detail, Plan};
use cplan_geometry::Convex;
use cplan_handling::{Piece, Task, TimedScene};
use cplan_legs::{Event, Leg, TaskAnswer};
use cplan_model::space::{Configuration, Path};
use cplan_model::{Additions, Grip, Scene};
use cplan_motion::{BLEND_TOLERANCE, BodyNames, MarginSearch, Margins, MotionStretch, TimedMotion, Trajectory};
use std::collections::BTreeSet;
use std::sync::Arc;

impl Plan {
    /// Returns the margins of the motion, computed at the first call; none without a motion.
    ///
    /// They apply to the trajectory, and to the path with stops at its corners.
    pub fn margins(&self) -> &Margins {
        self.margins.get_or_init(|| match self.detail() {
            Detail::Motion { problem, answer } => answer.outcome.found().map_or_else(Margins::default, |motion| {
                let scene = problem.scene();
                let names = BodyNames { fixed: scene.workspace().obstacles.len(), ..BodyNames::default() };
                let mut search = MarginSearch::new(scene.arm(), names);
                examine(&mut search, self.problem().timed(), &motion.timed, 0.0);
                search.margins()
            }),
            Detail::Task { task, answer } if answer.outcome.found().is_some() => of_task(task, answer),
            Detail::Task { .. } => Margins::default(),
        })
    }
}

/// Returns the margins of the motion of a task.
fn of_task(task: &Task, answer: &TaskAnswer) -> Margins {
    let objects = task.objects.iter().map(|object| object.name.clone()).collect();
    let names = BodyNames { fixed: task.workspace.fixed.obstacles.len(), objects };
    let mut search = MarginSearch::new(&task.arm, names);
    // Repetitions share their motions.
    let mut examined = BTreeSet::new();
    let motion = |leg: &Leg| (Arc::as_ptr(&leg.scene), Arc::as_ptr(&leg.timed));
    for (k, leg) in answer.legs.iter().enumerate() {
        let (before, next) = (k.checked_sub(1).map(|k| &answer.legs[k]), answer.legs.get(k + 1));
        let neighbours = [before, Some(leg), next].map(|leg| leg.map(motion));
        if !(task.has_moving_obstacles() || examined.insert(neighbours)) {
            continue;
        }
        let trajectories = task.trajectories_since(&leg.moving, leg.begin);
        examine(&mut search, TimedScene { scene: &leg.scene, trajectories: &trajectories }, &leg.timed, leg.begin);
        if task.has_moving_obstacles() {
            let q = leg.path().goal();
            let rest = [Piece::line(leg.arrival(), next.map_or(leg.end(), |next| next.begin), q, q)];
            for during in [Some(leg), next].into_iter().flatten() {
                let trajectories = task.trajectories_since(&during.moving, leg.arrival());
                let scene = TimedScene { scene: &during.scene, trajectories: &trajectories };
                search.examine(&MotionStretch { scene, pieces: &rest, begin: 0.0, beside: 0.0, known: 0.0 });
            }
        }
        for stretch in tool_stretches(task, [before, Some(leg), next]) {
            let (scene, pieces) = (TimedScene::from(&stretch.scene), &stretch.pieces[..]);
            let (begin, known) = (stretch.begin, stretch.known);
            search.examine(&MotionStretch { scene, pieces, begin, beside: 0.0, known });
        }
    }
    search.margins()
}

/// A stretch of a task during which the tool is lowered or turned. Its scene has all heights and angles that the tool takes.
struct ToolStretch {
    scene: Scene,
    pieces: Vec<Piece>,
    /// Time from the beginning of the task to the beginning of the pieces, seconds.
    begin: f64,
    /// Distance that is proven for the heights and angles of each moment, metres.
    known: f64,
}

/// Returns the stretches of a step during which the tool is lowered or turned. `legs` are those of the previous step, of this
/// step, and of the next one.
fn tool_stretches(task: &Task, legs: [Option<&Leg>; 3]) -> Vec<ToolStretch> {
    let [before, Some(leg), next] = legs else { return Vec::new() };
    let depth = |value: f64| task.stroke.as_ref().map_or(0.0, |stroke| stroke.depth_at(value));
    let mut stretches = Vec::new();
    let mut at_rest_in = |scene: Scene, (q, begin): (Configuration, f64), known: f64| {
        stretches.push(ToolStretch { scene, pieces: vec![at_rest(q)], begin, known });
    };
    if let Some(raising) = leg.raising {
        let scene = lowered(task, leg, (&[depth(raising.lowered)], &[0.0]), |additions| {
            let picked = leg.step.action.picked().map(|object| task.obstacle_number_among(&leg.moving, object));
            additions.allowed_contacts.retain(|number| Some(*number) != picked);
        });
        at_rest_in(scene, (leg.path().start(), leg.begin), raising.clearance);
    }
    let arrival = (leg.path().goal(), leg.arrival());
    let holding = if matches!(leg.event, Some(Event::Grasp { .. })) { next.unwrap_or(leg) } else { leg };
    let turned = leg.turn.map(|(turn, _)| turn);
    if leg.stroke.is_some() || matches!(leg.event, Some(Event::Release { .. })) {
        let depths: Vec<f64> = leg.stroke.iter().map(|stroke| depth(stroke.lowered)).collect();
        let scene = lowered(task, holding, (&depths, &[leg.step.elevation]), |additions| {
            let grip = additions.attachment.as_mut().map(|attachment| &mut attachment.grip);
            if let (Some(Grip::Level { angle, .. }), Some(turn)) = (grip, turned) {
                *angle = if std::ptr::eq(holding, leg) { turn.to } else { turn.from };
            }
            if leg.event.is_none() {
                additions.allowed_contacts.clear();
            }
        });
        at_rest_in(scene, arrival, leg.stroke.map_or(0.0, |stroke| stroke.clearance));
    }
    if let Some(turn) = turned {
        at_rest_in(turning(&holding.scene), arrival, turn.clearance);
    }
    let (overlap, pieces) = (leg.overlap, leg.timed.trajectory.pieces());
    let mut during = |scene: &dyn Fn() -> Scene, [departure, arrival]: [f64; 2]| {
        let end = leg.timed.trajectory.duration() - arrival;
        let pieces: Vec<Piece> =
            pieces.iter().filter(|piece| piece.from < departure || piece.to > end).copied().collect();
        if departure.max(arrival) > 0.0 && !pieces.is_empty() {
            stretches.push(ToolStretch { scene: scene(), pieces, begin: leg.begin, known: overlap.clearance });
        }
    };
    let strokes = [before.and_then(|leg| leg.stroke), leg.raising, leg.stroke].into_iter().flatten();
    let depths: Vec<f64> = strokes.map(|stroke| depth(stroke.lowered)).collect();
    let lower = || {
        let elevations = [before.unwrap_or(leg).step.elevation, leg.step.elevation];
        lowered(task, leg, (&depths, &elevations), |additions| {
            let is_raised = |number: &usize| {
                let heights = leg.scene.obstacle(*number).heights;
                leg.scene.own_parts(1).iter().any(|part| part.heights.meet(heights))
            };
            additions.allowed_contacts.retain(is_raised);
        })
    };
    during(&lower, [overlap.raising, overlap.lowering]);
    during(&|| turning(&leg.scene), [overlap.turn_after_departure, overlap.turn_before_arrival]);
    stretches
}

/// Returns the static scene of a step with the tool and its payload at all heights down to these depths, metres.
fn lowered(
    task: &Task,
    leg: &Leg,
    (depths, elevations): (&[f64], &[f64]),
    change: impl FnOnce(&mut Additions),
) -> Scene {
    let mut additions = Additions { loose: Vec::new(), ..leg.scene.additions().clone() };
    let (arm, workspace) = Scene::clone(&leg.scene).into_parts();
    let arm = match &task.stroke {
        Some(stroke) => stroke.swept(&arm, depths),
        None => arm,
    };
    if let Some((attachment, object)) = additions.attachment.as_mut().zip(leg.carried) {
        let object = &task.objects[object];
        attachment.heights = if task.stroke.is_some() {
            object.handled_heights(elevations.iter().copied())
        } else {
            object.heights_at(elevations[0])
        };
    }
    change(&mut additions);
    Scene::with_trusted(arm, workspace, additions)
}

/// Returns a scene in which each part of a level payload is a disc about the tip that covers all its angles.
fn turning(scene: &Scene) -> Scene {
    scene.with_attachment(|attachment| {
        if let Grip::Level { point, .. } = attachment.grip {
            for part in &mut attachment.parts {
                part.shape = Convex::trusted(vec![point], part.shape.reach_from(point));
            }
        }
    })
}

/// Examines a motion that begins at `begin`, in seconds, and the straight path that it follows.
fn examine(search: &mut MarginSearch, timed: TimedScene, motion: &TimedMotion, begin: f64) {
    let (path, trajectory) = (motion.curve.straight().path(), &motion.trajectory);
    let pieces = Some(trajectory.pieces()).filter(|pieces| !pieces.is_empty());
    let pieces = pieces.unwrap_or_else(|| vec![at_rest(path.start())]);
    let of_rounding = motion.curve.radii().iter().copied().fold(0.0, f64::max);
    let beside = BLEND_TOLERANCE * motion.curve.curve().greatest_half().max(of_rounding);
    search.examine(&MotionStretch { scene: timed, pieces: &pieces, begin, beside, known: 0.0 });
    // The times of the straight path are only approximately those of the motion, so moving obstacles are left out.
    let (scene, pieces) = (TimedScene::from(timed.scene), straight(path, trajectory));
    search.examine(&MotionStretch { scene, pieces: &pieces, begin, beside: 0.0, known: 0.0 });
}

fn at_rest(q: Configuration) -> Piece {
    Piece::line(0.0, 0.0, q, q)
}

/// Returns the pieces of a path, at least one. The time of a waypoint is that at which the trajectory is at the same share of its
/// length.
fn straight(path: &Path, trajectory: &Trajectory) -> Vec<Piece> {
    let along = |steps: &mut dyn Iterator<Item = f64>| {
        let sum = |length: &mut f64, step: f64| {
            *length += step;
            Some(*length)
        };
        [0.0].into_iter().chain(steps.scan(0.0, sum)).collect::<Vec<f64>>()
    };
    let moved = along(
        &mut trajectory
            .position
            .windows(2)
            .map(|ends| (Configuration::from(ends[1]) - Configuration::from(ends[0])).norm()),
    );
    let lengths = along(&mut path.segments().map(|(from, to)| (to - from).norm()));
    let [whole, length] = [&moved, &lengths].map(|lengths| lengths[lengths.len() - 1]);
    let time = |waypoint: usize| {
        let at = moved.partition_point(|moved| moved * length < lengths[waypoint] * whole);
        trajectory.time.get(at).copied().unwrap_or(0.0)
    };
    let pieces = path.segments().enumerate().map(|(k, (from, to))| Piece::line(time(k), time(k + 1), from, to));
    let pieces: Vec<Piece> = pieces.collect();
    if pieces.is_empty() { vec![at_rest(path.start())] } else { pieces }
}
