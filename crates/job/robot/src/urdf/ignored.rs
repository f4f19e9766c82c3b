//! Parts of a URDF that the planner ignores, with reasons.

use super::chain::is_movable;
use super::document::Document;
use super::reduction::Reduction;
use crate::error::quoted;
use cplan_model::{Link, OutlineSource};
use cplan_text::counted;

/// Lists elements that are neither links nor joints.
pub(super) fn elements(document: &Document) -> Vec<String> {
    let names: Vec<String> = document.others.iter().map(|(name, count)| format!("{count} <{name}>")).collect();
    if names.is_empty() {
        return Vec::new();
    }
    vec![format!("elements other than links and joints: {}", names.join(", "))]
}

/// Lists links that do not move, and joints whose values do not matter to the arm.
pub(super) fn beside_the_arm(reduction: &Reduction) -> Vec<String> {
    let Reduction { document, tree, chain, .. } = reduction;
    let mut ignored = Vec::new();
    let has_shapes = |link: &urdf_rs::Link| link.collision.len() + link.visual.len() > 0;
    let solid = document.robot.links.iter().enumerate().filter(|(_, link)| has_shapes(link));
    let (still, beside): (Vec<_>, Vec<_>) = solid
        .filter(|(l, _)| !tree.carries(chain.joints[0], *l))
        .map(|(l, link)| (reduction.is_fixed(l), link.name.as_str()))
        .partition(|(is_fixed, _)| *is_fixed);
    let names = |links: Vec<(bool, &str)>| quoted(links.into_iter().map(|(_, name)| name.to_owned()));
    if !still.is_empty() && !reduction.settings.table.own_body_is_obstacle() {
        ignored.push(format!("links that do not move, because of [robot] own_body = false: {}", names(still)));
    }
    if !beside.is_empty() {
        ignored.push(format!(
            "links that other joints move: {}; they are obstacles only if the world lists them",
            names(beside)
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

/// Lists links whose visual geometry is ignored because they have collision geometry.
pub(super) fn visuals(reduction: &Reduction, links: &[Link; 2]) -> Vec<String> {
    let Reduction { document, tree, chain, .. } = reduction;
    let mut ignored = Vec::new();
    for (index, link) in links.iter().enumerate().filter(|(_, link)| link.source == OutlineSource::Collision) {
        let mine =
            |l: &usize| tree.carries(chain.joints[index], *l) && (index == 1 || !tree.carries(chain.joints[1], *l));
        let is_used = |l: &usize| link.parts.iter().any(|p| p.is_visual && p.body == document.robot.links[*l].name);
        let unused = (0..document.robot.links.len()).filter(|l| mine(l) && !is_used(l));
        let shapes: usize = unused.map(|l| document.robot.links[l].visual.len()).sum();
        if shapes > 0 {
            let shapes = counted(shapes, "visual shape");
            ignored.push(format!("{shapes} of link \"{}\", which has collision geometry", link.name));
        }
    }
    ignored
}

/// Returns true if a joint is in the arm, carries it, or is carried by it.
pub(super) fn concerns_the_arm(reduction: &Reduction, joint: usize) -> bool {
    let Reduction { tree, chain, .. } = reduction;
    tree.carries(joint, tree.child[chain.joints[1]]) || tree.carries(chain.joints[0], tree.child[joint])
}
