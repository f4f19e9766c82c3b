//! The sentences of an explanation: the obstacles in the way, and the changes that open a path.

use super::{
    BlockedEnd, Change, ChangeContext, ChangeKind, Explanation, FoundExplanation, InfeasibleExplanation, Saving,
};
use cplan_blockers::{BlockingSet, Element, End, Side};
use cplan_model::{Elbow, Joint, Obstruction, Outcome, Scene};
use cplan_text::{fixed, headline_length, headline_number, joined, length_down, length_up};
use cplan_view::output::names::{
    MAX_NAMED, blame_in_words, body_name, capitalized, is_or_are, joint_name, obstacle_name, part_name, subject,
};

/// Largest angle, in degrees, between the direction of a move and one of the eight directions that have words.
const DIRECTION_TOLERANCE: f64 = 1.0;

/// Words for the eight directions, counter-clockwise from the first coordinate.
const DIRECTIONS: [&str; 8] =
    ["right", "up and right", "up", "up and left", "left", "down and left", "down", "down and right"];

/// Returns the reason in everyday words: `The front wall is in the way.`
pub fn headline(explanation: &Explanation) -> String {
    let scene = explanation.question.scene();
    match &explanation.outcome {
        Outcome::Unknown(_) => "It is unknown whether there is a path.".into(),
        Outcome::Found(found) => headline_of_found(scene, found, explanation.is_stopped),
        Outcome::Infeasible(closed) => headline_of_infeasible(scene, closed),
    }
}

fn headline_of_found(scene: &Scene, found: &FoundExplanation, is_stopped: bool) -> String {
    let names: Vec<String> = found.savings.iter().map(|saving| subject(scene, saving.element)).collect();
    match names.len() {
        0 if is_stopped => "There is a path.".into(),
        0 => "There is a path, and no single obstacle or limit makes it longer.".into(),
        1 => capitalized(&format!("{} makes the path longer.", names[0])),
        n if n <= MAX_NAMED => capitalized(&format!("{} each make the path longer.", joined(&names))),
        n => format!("{n} things each make the path longer."),
    }
}

fn headline_of_infeasible(scene: &Scene, closed: &InfeasibleExplanation) -> String {
    if let Some(out) = &closed.out_of_reach {
        return format!("The goal is out of reach{}.", Elbow::describe(out.elbow));
    }
    if !closed.ends.is_empty() {
        return headline_of_ends(scene, &closed.ends);
    }
    let sets: Vec<&BlockingSet> = closed.sets.iter().filter(|set| !set.blockers.is_empty()).collect();
    let Some((first, more)) = sets.split_first() else {
        return "There is no path. cplan did not find which obstacles or limits block it.".into();
    };
    let also = match more {
        [] => String::new(),
        [one] => {
            let names: Vec<String> = one.elements().into_iter().map(|element| subject(scene, element)).collect();
            format!(", and so {} {}", is_or_are(names.len()), joined(&names))
        }
        _ => format!(", and so are {} further sets of obstacles", more.len()),
    };
    format!("{}{also}.", blame(scene, first))
}

/// Names the elements of a set that are in the way, without a full stop.
fn blame(scene: &Scene, set: &BlockingSet) -> String {
    capitalized(&blame_in_words(scene, set))
}

/// Describes the defects of the start and of the first goal.
fn headline_of_ends(scene: &Scene, ends: &[BlockedEnd]) -> String {
    let first = |end: End| ends.iter().find(move |one| one.end == end);
    let said = [first(End::Start), first(End::Goal)].into_iter().flatten().map(|end| describe_end(scene, end));
    said.collect::<Vec<_>>().join(" ")
}

fn describe_end(scene: &Scene, blocked: &BlockedEnd) -> String {
    let scene = blocked.scene(scene);
    let end = if blocked.end == End::Start { "start" } else { "goal" };
    let beyond: Vec<String> =
        (0..2).filter(|&k| blocked.beyond[k] > 0.0).map(|k| joint_name(&scene.arm().joints[k])).collect();
    if !beyond.is_empty() {
        return format!("The {end} is beyond the limits of {}.", joined(&beyond));
    }
    if blocked.hits.is_empty() && blocked.beyond_motor(scene.arm()).is_some() {
        return format!("The {end} is beyond the range of the elbow's motor.");
    }
    let touching: Vec<&Obstruction> = blocked.hits.iter().filter(|hit| hit.touches).collect();
    let (hits, verb) =
        if touching.is_empty() { (blocked.hits.iter().collect(), "is too close to") } else { (touching, "hits") };
    let mut obstacles: Vec<String> = hits.iter().map(|hit| obstacle_name(scene, hit.contact.pair.obstacle)).collect();
    obstacles.dedup();
    let who = match hits[..] {
        [only] if blocked.standing.is_some() => body_name(scene, only.contact.pair),
        [only] => part_name(scene, only),
        _ => "the arm".into(),
    };
    let what = if obstacles.len() > MAX_NAMED { format!("{} obstacles", obstacles.len()) } else { joined(&obstacles) };
    let when = blocked.standing.as_ref().map_or_else(String::new, |standing| format!(" {},", standing.when));
    format!("At the {end},{when} {who} {verb} {what}.")
}

/// Returns a sentence about the proof behind the headline. Empty if there is nothing to add.
pub fn evidence(explanation: &Explanation) -> String {
    match &explanation.outcome {
        Outcome::Unknown(reason) => capitalized(&format!("{reason}.")),
        Outcome::Found(found) => found.answer.bound().map_or_else(String::new, |bound| {
            let gap = cplan_text::percent(bound.gap());
            format!(
                "The shortest path has length {}; it is proven to be at most {gap} longer than the optimum.",
                explanation.question.scene().arm().format_length(bound.upper)
            )
        }),
        Outcome::Infeasible(closed) => {
            let Some(set) = closed.sets.iter().find(|set| !set.blockers.is_empty()) else { return String::new() };
            evidence_of(explanation.question.scene(), set)
        }
    }
}

/// Returns a sentence about the proof that a set blocks all motions, and about the need of its elements.
fn evidence_of(scene: &Scene, set: &BlockingSet) -> String {
    let boxes = set.proof.as_ref().map(|proof| match proof.collision_boxes().len() {
        1 => " by 1 collision box".into(),
        n => format!(" by {n} collision boxes"),
    });
    let names: Vec<String> = set.elements().into_iter().map(|element| subject(scene, element)).collect();
    let blame = if names.len() > MAX_NAMED {
        "nothing else is in the way".to_owned()
    } else {
        format!("only {} {} in the way", joined(&names), is_or_are(names.len()))
    };
    let need = match (names.len(), set.is_irreducible()) {
        (1, true) => " With nothing in the way, there is a certified path.",
        (_, true) => " Without any one of them, there is a certified path.",
        (1, false) => "",
        (_, false) => " Perhaps fewer of them block it, too.",
    };
    format!("Even if {blame}, there is no path (proven{}).{need}", boxes.unwrap_or_default())
}

/// Returns a change as an instruction: `Move it 614 mm right`. `is_only` is true if "it" can only mean the changed
/// obstacle. The number is rounded so that the change is large enough.
pub fn instruction(scene: &Scene, change: &Change, is_only: bool) -> String {
    let opens = change.by.opens;
    let what = || match change.element {
        Element::Obstacle { number } if !is_only => obstacle_name(scene, number),
        _ => "it".to_owned(),
    };
    match change.cure {
        _ if leaves_nothing(scene, change) => format!("Remove {}", what()),
        ChangeKind::Moved { direction } => {
            format!("Move {} {} {}", what(), headline_length(opens, true), direction_in_words(direction))
        }
        ChangeKind::Eroded => format!("Shrink {} by {} on all sides", what(), headline_length(opens, true)),
        ChangeKind::Scaled { to } => format!("Shrink {} to {} %", what(), headline_number(100.0 * to, false)),
        ChangeKind::Widened => match change.element {
            Element::Limit { joint, side } => {
                let joint = &scene.arm().joints[joint];
                let which = if side == Side::Lower { "lower" } else { "upper" };
                let to = limit_after(joint, side, opens);
                format!(
                    "Widen the {which} limit of {} to {}",
                    joint_name(joint),
                    headline_value(joint, to, side == Side::Upper)
                )
            }
            _ => String::new(),
        },
        ChangeKind::Lowered => {
            let to = (scene.workspace().greatest_clearance() - opens).max(0.0);
            format!("Lower the clearance to {}", headline_length(to, false))
        }
    }
}

/// Returns the amount with which there is a path, and that without one: `613.6 mm opens a path, certified` and `613.0
/// mm does not, proven`. A move or an erosion is described by its distance, another change by the value after it.
pub fn bounds(scene: &Scene, set: &BlockingSet, change: &Change) -> [String; 2] {
    let (opens, closed) = (change.by.opens, change.by.closed);
    let [open, shut] = match (change.cure, change.element) {
        (ChangeKind::Scaled { to }, _) => {
            let most = opens / (1.0 - to);
            [
                format!("{} %", cplan_text::round_down(100.0 * to, 1)),
                format!("{} %", cplan_text::round_up(100.0 * (1.0 - closed / most), 1)),
            ]
        }
        (ChangeKind::Widened, Element::Limit { joint, side }) => {
            let (joint, is_upper) = (&scene.arm().joints[joint], side == Side::Upper);
            [
                precise_value(joint, limit_after(joint, side, opens), is_upper),
                precise_value(joint, limit_after(joint, side, closed), !is_upper),
            ]
        }
        (ChangeKind::Lowered, _) => {
            let clearance = scene.workspace().greatest_clearance();
            [positive_down((clearance - opens).max(0.0)), length_up(clearance - closed)]
        }
        _ => [length_up(opens), positive_down(closed)],
    };
    let open = if leaves_nothing(scene, change) { shrinking(change, &open) } else { open };
    [format!("{open} opens a path, certified"), format!("{shut} does not, proven{}", context(scene, set, change))]
}

/// Returns true if the change makes an obstacle so small that it vanishes.
pub(super) fn leaves_nothing(scene: &Scene, change: &Change) -> bool {
    let shrinks = matches!(change.cure, ChangeKind::Eroded | ChangeKind::Scaled { .. });
    shrinks && change.changed_obstacle(scene).is_some_and(|obstacle| obstacle.pieces.is_empty())
}

/// Describes the shrinking of an obstacle by the amount `by`, or that nothing of it is left.
fn shrinking(change: &Change, by: &str) -> String {
    match change.cure {
        ChangeKind::Scaled { .. } => format!("shrinking it to {by}"),
        _ => format!("shrinking it by {by} on all sides, until nothing is left,"),
    }
}

/// Formats a length that is not negative, rounded down.
fn positive_down(metres: f64) -> String {
    if metres == 0.0 { "0 mm".into() } else { length_down(metres) }
}

/// States which other elements were in the way when a change was tried, unless all of them were.
fn context(scene: &Scene, set: &BlockingSet, change: &Change) -> String {
    if change.among == ChangeContext::World {
        return String::new();
    }
    let others: Vec<String> = set
        .elements()
        .into_iter()
        .filter(|&other| other != change.element)
        .map(|other| subject(scene, other))
        .collect();
    if others.is_empty() {
        return ", with nothing else in the way".into();
    }
    format!(", with only {} in the way", joined(&others))
}

/// Returns the instruction to remove an element that makes the path longer, and the effect.
pub fn removal(scene: &Scene, saving: &Saving, length: f64) -> [String; 2] {
    let name = subject(scene, saving.element);
    let instruction = match saving.element {
        Element::Obstacle { .. } | Element::Link { .. } | Element::Limit { .. } | Element::Motor => {
            format!("Remove {name}")
        }
        Element::Clearance => "Require no clearance".into(),
    };
    let share = headline_number(100.0 * saving.at_least / length, false);
    let effect = format!(
        "the path is at least {share} % shorter, proven: {} instead of {}",
        fixed(saving.length, 4),
        scene.arm().format_length(length)
    );
    [instruction, effect]
}

/// Returns the end of a joint's range after a change.
fn limit_after(joint: &Joint, side: Side, by: f64) -> f64 {
    let (lower, upper) = joint.range.domain();
    if side == Side::Lower { lower - by } else { upper + by }
}

fn headline_value(joint: &Joint, value: f64, up: bool) -> String {
    if !joint.joint_type.is_revolute() {
        return headline_length(value, up);
    }
    let tenths = 10.0 * value.to_degrees();
    let rounded = if up { (tenths - 1e-6).ceil() } else { (tenths + 1e-6).floor() };
    format!("{}\u{b0}", rounded / 10.0)
}

/// Formats a value of a joint with two decimals of a degree, or in millimetres.
fn precise_value(joint: &Joint, value: f64, up: bool) -> String {
    let round = if up { cplan_text::round_up } else { cplan_text::round_down };
    if joint.joint_type.is_revolute() {
        return format!("{}\u{b0}", round(value.to_degrees(), 2));
    }
    if value.abs() < 1.0 { format!("{} mm", round(1e3 * value, 1)) } else { format!("{} m", round(value, 4)) }
}

/// Returns the direction of a move in words. Adds the angle in degrees unless the direction is one of the eight that have words.
fn direction_in_words([x, y]: [f64; 2]) -> String {
    let degrees = y.atan2(x).to_degrees().rem_euclid(360.0);
    let eighth = (degrees / 45.0).round();
    let word = DIRECTIONS[eighth as usize % DIRECTIONS.len()];
    if (degrees - 45.0 * eighth).abs() <= DIRECTION_TOLERANCE {
        return word.into();
    }
    // The nearest word and the angle, counter-clockwise from the first coordinate.
    format!("{word}, at {}\u{b0}", fixed(degrees, 0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_have_words() {
        let toward = |degrees: f64| direction_in_words([degrees.to_radians().cos(), degrees.to_radians().sin()]);
        assert_eq!([0.0, 90.0, 180.4, 315.0].map(toward), ["right", "up", "left", "down and right"]);
        assert_eq!([30.0, -90.0, 359.6].map(toward), ["up and right, at 30\u{b0}", "down", "right"]);
    }
}
