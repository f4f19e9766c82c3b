//! The picture of a line and its motion.

use super::Answered;
use super::words::{exclusions, facts, figures, headline};
use crate::draw::{LineView, Picture, View};
use crate::model::{Goal, Outcome, Scene};
use crate::output::{contours, title_of};
use crate::space::{Configuration, JointRange, Path};
use cplan_follow::Followed;

/// Greatest distance between the line and its chords in pictures, metres, as a share of the arm's reach.
const DRAWN_TOLERANCE: f64 = 2e-5;

/// Returns the picture: the line, the motion or the place without one, and the configuration space.
pub fn view(answered: &Answered) -> View {
    let scene = &answered.loaded.scene;
    let found = answered.answer.found();
    let path: Option<&Path> = found.map(|found| found.timed.curve.straight().path());
    let shown = found.map_or_else(Vec::new, |found| facts(answered, found));
    let picture = Picture {
        title: vec![headline(answered), title_of(scene)],
        status: answered.answer.status().name().into(),
        ending: Some(answered.answer.status()),
        facts: shown.into_iter().map(|(name, value)| [name.to_owned(), value]).collect(),
        paths: path.map(|path| (String::new(), path)).into_iter().collect(),
        trajectory: found.map(|found| &found.timed.trajectory),
        c_obstacles: &contours(scene),
        ..Picture::new(scene, start(answered))
    };
    View::of_picture(&picture).with_figures(figures(answered)).with_line(line(answered, scene))
}

fn line(answered: &Answered, scene: &Scene) -> LineView {
    let strokes = answered.line.outlines(DRAWN_TOLERANCE * scene.arm().reach());
    let strokes = strokes.into_iter().map(|stroke| stroke.into_iter().map(Into::into).collect()).collect();
    let at = match answered.answer {
        Followed::Infeasible(infeasible) => Some(infeasible.place.point),
        _ => None,
    };
    LineView { strokes, at }
}

/// Returns the first configuration of the motion. Without a motion, returns the one that is excluded, the world's start,
/// or else the one nearest to zero.
fn start(answered: &Answered) -> Configuration {
    let arm = answered.loaded.scene.arm();
    let excluded = match answered.answer {
        Outcome::Found(found) => return found.timed.curve.straight().path().start(),
        Outcome::Infeasible(infeasible) => exclusions(infeasible).first(),
        Outcome::Unknown(_) => None,
    };
    let stated = match answered.loaded.stated_ends()[0] {
        Some(Goal::Joints(q)) => Some(q),
        _ => None,
    };
    let q = excluded.map(|exclusion| Configuration::from(exclusion.q)).or(stated).unwrap_or_default();
    Configuration::from_fn(|k, _| match arm.joints[k].range {
        JointRange::Circle => q[k],
        JointRange::Interval { lower, upper } => q[k].clamp(lower, upper),
    })
}
