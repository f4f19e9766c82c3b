//! The answer in words.

use super::Answered;
use crate::model::{Arm, Outcome};
use crate::output::{format_columns, title_of};
use crate::text::{counted, length, length_down, length_up};
use crate::view::KeyFigures;
use cplan_follow::{Cause, Exclusion, Found, Infeasible, Place};

/// Returns the summary on stdout.
pub fn summary(answered: &Answered) -> String {
    let scene = &answered.loaded.scene;
    let mut lines = vec![("result", result(answered))];
    match answered.answer {
        Outcome::Found(found) => lines.extend(facts(answered, found)),
        Outcome::Infeasible(infeasible) => {
            lines.extend(exclusions(infeasible).iter().map(|e| (solution(e), at_place(e, answered))));
        }
        Outcome::Unknown(_) => {}
    }
    lines.extend(answered.placed.as_ref().map(|placed| ("placed", placed.describe())));
    lines.push(("line", line(answered)));
    if answered.args.verbose {
        lines.extend(pieces(answered).into_iter().map(|text| ("", text)));
    }
    let wrist = answered.wrist.and_then(|wrist| wrist.note.as_ref());
    // The robot was read with the wrist at rest.
    let held = answered.wrist.map(|wrist| format!("joint \"{}\" is held at", wrist.joint));
    let is_true = |note: &&String| held.as_ref().is_none_or(|held| !note.starts_with(held));
    let steps = answered
        .loaded
        .has_steps()
        .then(|| "`cplan follow` ignores the world's steps; `cplan plan` plans them".to_owned());
    let notes = answered
        .line
        .notes()
        .iter()
        .chain(answered.loaded.robot.notes.iter().filter(is_true))
        .chain(wrist)
        .chain(&steps);
    lines.extend(notes.map(|note| ("note", note.clone())));
    format!("{}\n{}", title_of(scene), format_columns(&lines))
}

/// Returns the answer in one line.
pub fn result(answered: &Answered) -> String {
    match answered.answer {
        Outcome::Found(found) => {
            format!("found and certified: the tip is at most {} from the line", length_up(found.deviation))
        }
        Outcome::Infeasible(infeasible) => format!("infeasible: {}; proven", infeasible.describe()),
        Outcome::Unknown(why) => format!("unknown: {why}"),
    }
}

/// Returns the title of pictures.
pub fn headline(answered: &Answered) -> String {
    match answered.answer {
        Outcome::Found(found) => format!("The tip follows the line within {}", length_up(found.deviation)),
        Outcome::Infeasible(infeasible) => format!("No motion follows the line: {}", infeasible.describe()),
        Outcome::Unknown(_) => "No motion along the line was found".into(),
    }
}

/// Returns the key figures of a motion.
pub fn figures(answered: &Answered) -> KeyFigures {
    match answered.answer {
        Outcome::Found(found) => KeyFigures {
            duration: Some(found.timed.trajectory.duration()),
            clearance: Some(found.timed.curve.clearance()).filter(|clearance| clearance.is_finite()),
            ..KeyFigures::default()
        },
        _ => KeyFigures::default(),
    }
}

/// Returns the IK solutions that are excluded.
pub fn exclusions(infeasible: &Infeasible) -> &[Exclusion] {
    match &infeasible.cause {
        Cause::OutOfReach { .. } | Cause::TooLarge { .. } => &[],
        Cause::Excluded(list) | Cause::NoChange(list) => list,
    }
}

/// Returns the name of an exclusion's IK solution.
fn solution(exclusion: &Exclusion) -> &'static str {
    if exclusion.solution == 0 { "solution 1" } else { "solution 2" }
}

fn at_place(exclusion: &Exclusion, answered: &Answered) -> String {
    format!("{} at {}", exclusion.describe(&answered.loaded.scene), exclusion.place)
}

fn line(answered: &Answered) -> String {
    let pieces = answered.line.pieces();
    let travels = pieces.iter().filter(|piece| piece.is_travel).count();
    let travels = if travels > 0 { format!(", {} of them travels", travels) } else { String::new() };
    let (length, count) = (length(answered.line.length()), counted(pieces.len(), "piece"));
    format!("{length} in {count}{travels}; tolerance {}", crate::text::chosen_length(answered.tolerance))
}

/// Returns names and values of the facts about a motion.
pub fn facts(answered: &Answered, found: &Found) -> Vec<(&'static str, String)> {
    let trajectory = &found.timed.trajectory;
    let samples = counted(trajectory.time.len(), "sample");
    let mut facts = vec![("motion", format!("{:.3} s, {samples}", trajectory.duration()))];
    let clearance = found.timed.curve.clearance();
    let from = found.timed.curve.nearest().map(|nearest| answered.loaded.scene.describe(nearest.contact.pair));
    facts.push(match from {
        Some(pair) if clearance.is_finite() => {
            ("clearance", format!("{} proven; closest: {pair}", length_down(clearance)))
        }
        _ => ("clearance", "no obstacle within reach".into()),
    });
    if let Some((wrist, deviation)) = answered.wrist.zip(found.tool_deviation) {
        facts.push(("wrist", wrist.fact(deviation)));
    }
    if !found.changes.is_empty() {
        let places: Vec<String> = found.changes.iter().map(Place::to_string).collect();
        let count = counted(found.changes.len(), "change");
        let shown = if answered.args.verbose { places.join(", ") } else { places[0].clone() };
        facts.push(("solutions", format!("{count} of the IK solution; the first at {shown}")));
    }
    facts
}

/// Returns a description of each piece of the line.
fn pieces(answered: &Answered) -> Vec<String> {
    use cplan_toolpath::Curve;
    let describe = |piece: &cplan_toolpath::Piece| {
        let kind = match (piece.is_travel, &piece.curve) {
            (true, _) => "travel",
            (_, Curve::Line { .. }) => "straight",
            (_, Curve::Arc { .. }) => "arc",
            (_, Curve::Cubic(_)) => "curve",
        };
        let [x, y] = piece.curve.end();
        let speed = piece.speed.map_or_else(String::new, |speed| format!(" at {speed} m/s"));
        format!("line {}: {kind} of {} to {x:.4}, {y:.4}{speed}", piece.source.line, length(piece.curve.length()))
    };
    answered.line.pieces().iter().map(describe).collect()
}

/// Returns the names of the joints.
pub fn joints(arm: &Arm) -> [&str; 2] {
    arm.joints.each_ref().map(|joint| joint.name.as_str())
}
