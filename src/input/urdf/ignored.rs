//! What of a URDF the planner takes no account of, and why.

use super::chain::is_movable;
use super::document::Document;
use super::reduction::Reduction;
use crate::input::error::quoted;
use crate::model::{Link, OutlineSource};
use crate::text::counted;

/// Elements that are neither links nor joints.
pub(super) fn elements(document: &Document) -> Vec<String> {
    let names: Vec<String> = document.others.iter().map(|(name, count)| format!("{count} <{name}>")).collect();
    if names.is_empty() {
        return Vec::new();
    }
    vec![format!("elements that are neither links nor joints: {}", names.join(", "))]
}

/// Links that do not move, and joints that the arm does not depend on.
pub(super) fn beside_the_arm(reduction: &Reduction) -> Vec<String> {
    let Reduction { document, tree, chain, .. } = reduction;
    let mut ignored = Vec::new();
    let still: Vec<&str> = document
        .robot
        .links
        .iter()
        .enumerate()
        .filter(|(l, link)| {
            let shapes = link.collision.len() + link.visual.len();
            shapes > 0 && !tree.carries(chain.joints[0], *l)
        })
        .map(|(_, link)| link.name.as_str())
        .collect();
    if !still.is_empty() {
        ignored.push(format!(
            "geometry of links that the arm does not move: {}; no obstacle unless the world lists it",
            quoted(still)
        ));
    }
    let beside: Vec<&str> = document
        .robot
        .joints
        .iter()
        .enumerate()
        .filter(|(j, joint)| is_movable(joint) && !concerns_the_arm(reduction, *j))
        .map(|(_, joint)| joint.name.as_str())
        .collect();
    if !beside.is_empty() {
        ignored.push(format!("joints that neither carry the arm nor are carried by it: {}", quoted(beside)));
    }
    ignored
}

/// Visual geometry where collision geometry does.
pub(super) fn visuals(reduction: &Reduction, links: &[Link; 2]) -> Vec<String> {
    let Reduction { document, tree, chain, .. } = reduction;
    let mut ignored = Vec::new();
    for (index, link) in links.iter().enumerate().filter(|(_, link)| link.source == OutlineSource::Collision) {
        let mine =
            |l: &usize| tree.carries(chain.joints[index], *l) && (index == 1 || !tree.carries(chain.joints[1], *l));
        let shapes: usize =
            (0..document.robot.links.len()).filter(mine).map(|l| document.robot.links[l].visual.len()).sum();
        if shapes > 0 {
            let shapes = counted(shapes, "visual shape");
            ignored.push(format!("{shapes} of link \"{}\": it has collision geometry", link.name));
        }
    }
    ignored
}

/// Whether a joint is one of the two, carries them or is carried by them.
pub(super) fn concerns_the_arm(reduction: &Reduction, joint: usize) -> bool {
    let Reduction { tree, chain, .. } = reduction;
    tree.carries(joint, tree.child[chain.joints[1]]) || tree.carries(chain.joints[0], tree.child[joint])
}
