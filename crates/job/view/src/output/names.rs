//! Names of obstacles, links, joints and limits in sentences, and the sentence about what is in the way.

use cplan_blockers::{BlockingSet, Element, Side};
use cplan_model::{Arm, Joint, Obstruction, Pair, Scene};
use cplan_text::{chosen_length, joined};

/// Largest number of obstacles that a sentence names. If there are more, it states their number.
pub const MAX_NAMED: usize = 3;

/// Says that the elements of a set are in the way, as part of a sentence: `the front wall is in the way`.
pub fn blame_in_words(scene: &Scene, set: &BlockingSet) -> String {
    let elements = set.elements();
    let obstacles: Vec<String> = elements
        .iter()
        .filter(|element| element.obstacle().is_some())
        .map(|&element| subject(scene, element))
        .collect();
    let mut joints: Vec<usize> = elements
        .iter()
        .filter_map(|element| if let Element::Limit { joint, .. } = element { Some(*joint) } else { None })
        .collect();
    joints.dedup();
    let mut parts = Vec::new();
    match obstacles.len() {
        0 => {}
        n if n <= MAX_NAMED => parts.push(format!("{} {} in the way", joined(&obstacles), is_or_are(n))),
        n => parts.push(format!("{n} obstacles together are in the way")),
    }
    parts.extend(short_joints(scene.arm(), &joints));
    parts.extend(
        elements.contains(&Element::Motor).then(|| "the elbow\u{2019}s motor cannot turn far enough".to_owned()),
    );
    let text = parts.join(", and ");
    let clearance = chosen_length(scene.workspace().clearance);
    match (elements.contains(&Element::Clearance), text.is_empty()) {
        (false, _) => text,
        (true, true) => format!("a clearance of {clearance} excludes every path"),
        (true, false) => format!("with a clearance of {clearance}, {text}"),
    }
}

/// Says that the ranges of these joints are too small.
fn short_joints(arm: &Arm, joints: &[usize]) -> Option<String> {
    let names: Vec<String> = joints.iter().map(|&joint| joint_name(&arm.joints[joint])).collect();
    let all_turn = joints.iter().all(|&joint| arm.joints[joint].joint_type.is_revolute());
    let all_slide = joints.iter().all(|&joint| !arm.joints[joint].joint_type.is_revolute());
    let verb = match (all_turn, all_slide) {
        (true, _) => "turn",
        (_, true) => "slide",
        _ => "move",
    };
    (!names.is_empty()).then(|| format!("{} cannot {verb} far enough", joined(&names)))
}

/// Names an element as the subject of a sentence: `the front wall`, `the upper limit of the elbow`.
pub fn subject(scene: &Scene, element: Element) -> String {
    match element {
        Element::Obstacle { number } => obstacle_name(scene, number),
        Element::Link { number } => {
            format!("the robot\u{2019}s own {}", noun("link", &scene.obstacle(number).name).trim_start_matches("the "))
        }
        Element::Limit { joint, side } => {
            let which = if side == Side::Lower { "lower" } else { "upper" };
            format!("the {which} limit of {}", joint_name(&scene.arm().joints[joint]))
        }
        Element::Motor => "the range of the elbow\u{2019}s motor".into(),
        Element::Clearance => format!("the clearance of {}", chosen_length(scene.workspace().clearance)),
    }
}

/// Names an obstacle, or a link of the robot that other links can hit.
pub fn obstacle_name(scene: &Scene, number: usize) -> String {
    let kind = if scene.self_obstacles().contains(&number) { "link" } else { "obstacle" };
    noun(kind, &scene.obstacle(number).name)
}

/// Names a joint.
pub fn joint_name(joint: &Joint) -> String {
    noun("joint", &joint.name)
}

/// Names the part of the arm in an obstruction.
pub fn part_name(scene: &Scene, hit: &Obstruction) -> String {
    part_of_pair(scene, hit.contact.pair)
}

/// Names the part of the arm in a pair of shapes.
pub fn part_of_pair(scene: &Scene, pair: Pair) -> String {
    let link = scene.link(pair);
    if scene.is_attached(pair) { noun("payload", &link.parts[pair.part].body) } else { noun("link", &link.name) }
}

/// Names the body of the robot that has the part of a pair, or the payload.
pub fn body_name(scene: &Scene, pair: Pair) -> String {
    noun(if scene.is_attached(pair) { "payload" } else { "link" }, &scene.link(pair).parts[pair.part].body)
}

/// Returns a name in a sentence. If the name consists of ordinary words, it has an article, otherwise quotation marks and the
/// kind: `the front wall`, `obstacle "o1"`.
pub fn noun(kind: &str, name: &str) -> String {
    let is_word =
        |word: &str| !word.is_empty() && word.chars().all(|letter| letter.is_alphabetic() && letter.is_lowercase());
    match name.split([' ', '_', '-']).all(is_word) && name.chars().count() > 1 {
        true => format!("the {}", name.replace('_', " ")),
        false => format!("{kind} \"{name}\""),
    }
}

/// Returns the text with a capital first letter.
pub fn capitalized(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Returns the verb that fits a number of subjects.
pub fn is_or_are(count: usize) -> &'static str {
    if count == 1 { "is" } else { "are" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ordinary_words_have_an_article() {
        assert_eq!([noun("obstacle", "front wall"), noun("link", "upper_arm")], ["the front wall", "the upper arm"]);
        assert_eq!([noun("obstacle", "o1"), noun("obstacle", "Vice")], ["obstacle \"o1\"", "obstacle \"Vice\""]);
    }
}
