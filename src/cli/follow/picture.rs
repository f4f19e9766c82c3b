//! The picture of a line and its motion.

use super::Answered;
use super::words::{exclusions, facts, figures, headline};
use crate::input::LoadedScene;
use crate::model::{Goal, Outcome, Scene};
use crate::output::{contours, title_of};
use crate::space::{Configuration, JointRange, Path};
use crate::view::{LineSettings, LineView, Picture, View};
use cplan_follow::{Exclusion, Followed};

/// Returns the picture: the line, its motion or the place where it fails, and the configuration space.
pub fn view(answered: &Answered) -> View {
    let scene = &answered.loaded.scene;
    let found = answered.answer.found();
    let path: Option<&Path> = found.map(|found| found.timed.curve.straight().path());
    let shown = found.map_or_else(Vec::new, |found| facts(answered, found));
    let picture = Picture {
        title: [headline(answered), title_of(scene)].into_iter().chain(reasons(answered)).collect(),
        status: answered.answer.status().name().into(),
        ending: Some(answered.answer.status()),
        facts: shown.into_iter().map(|(name, value)| [name.to_owned(), value]).collect(),
        paths: path.map(|path| (String::new(), path)).into_iter().collect(),
        trajectory: found.map(|found| &found.timed.trajectory),
        c_obstacles: &contours(scene),
        ..Picture::new(scene, start(answered))
    };
    let view = View::of_picture(&picture).with_figures(figures(answered)).with_line(line(answered, scene));
    match answered.wrist.zip(found) {
        Some((wrist, found)) => view.with_tool(scene.arm(), &wrist.along.joint, &found.timed.trajectory),
        None => view,
    }
}

/// Returns a sentence about each excluded IK solution.
fn reasons(answered: &Answered) -> Vec<String> {
    let Followed::Infeasible(infeasible) = answered.answer else { return Vec::new() };
    let scene = &answered.loaded.scene;
    let reason =
        |exclusion: &Exclusion| format!("IK solution {}: {}", exclusion.solution + 1, exclusion.describe(scene));
    exclusions(infeasible).iter().map(reason).collect()
}

/// Returns the line with its motion, or with the place where it cannot be followed.
fn line(answered: &Answered, scene: &Scene) -> LineView {
    let given = answered.line;
    let view = LineView::new(scene, given, answered.tolerance);
    match answered.answer {
        Followed::Found(found) => {
            let settings = LineSettings {
                tolerance: answered.tolerance,
                speed: answered.speed,
                wrist: answered.wrist.map(|wrist| [wrist.along.velocity, wrist.along.acceleration]),
            };
            let known = (found.deviation, !found.changes.is_empty());
            view.with_motion(scene, given, &found.timed.trajectory, settings, known)
        }
        Followed::Infeasible(infeasible) => {
            let excluded = exclusions(infeasible).iter().map(|exclusion| exclusion.q.into());
            view.infeasible_at(infeasible.place.point, excluded.collect())
        }
        Followed::Unknown(_) => view,
    }
}

/// Returns the first configuration of the motion. Without a motion, returns an excluded configuration, or else that of
/// [`resting`].
fn start(answered: &Answered) -> Configuration {
    let excluded = match answered.answer {
        Outcome::Found(found) => return found.timed.curve.straight().path().start(),
        Outcome::Infeasible(infeasible) => exclusions(infeasible).first(),
        Outcome::Unknown(_) => None,
    };
    resting(answered.loaded, excluded.map(|exclusion| Configuration::from(exclusion.q)))
}

/// Returns a configuration within the limits for the picture: the given one, the world's start, or else the one nearest to zero.
pub fn resting(loaded: &LoadedScene, q: Option<Configuration>) -> Configuration {
    let stated = match loaded.stated_ends()[0] {
        Some(Goal::Joints(q)) => Some(q),
        _ => None,
    };
    let q = q.or(stated).unwrap_or_default();
    Configuration::from_fn(|k, _| match loaded.scene.arm().joints[k].range {
        JointRange::Circle => q[k],
        JointRange::Interval { lower, upper } => q[k].clamp(lower, upper),
    })
}
