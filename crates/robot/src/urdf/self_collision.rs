//! Self-collision: the pairs of links that the planner keeps apart, and the layers in which it cuts their meshes.
//!
//! A link is an obstacle for the links that a joint further along the chain moves. Exceptions are its neighbours in the
//! chain, those that the world allows to meet it, and those that meet it in every configuration.

use super::bodies::Bodies;
use super::chain::Chain;
use super::document::Document;
use super::shapes::PlacedShape;
use super::solid::MIN_LAYER_THICKNESS;
use super::tree::Tree;
use crate::error::{Diagnostic, quoted};
use cplan_core::model::{Arm, Carrier, Obstacle, Scene, SelfObstacle, Shape, Workspace};
use cplan_core::space::Configuration;
use cplan_geometry::separation;
use std::collections::BTreeSet;
use urdf_rs::JointType;

/// Number of values of each joint at which links are placed, to find links that touch in every configuration.
const SAMPLES_PER_JOINT: usize = 32;

/// The part of the robot to which a link belongs. The last joint that moves the link determines it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Group {
    /// Links that neither arm joint moves.
    Fixed,
    First,
    Second,
}

/// Pairs of URDF links that the planner keeps apart.
pub(super) struct SelfCollision<'a> {
    bodies: &'a Bodies<'a>,
    /// The group of each URDF link. `None` if a joint outside the arm moves it.
    groups: Vec<Option<Group>>,
    /// URDF links that have a shape.
    solid: BTreeSet<usize>,
    /// Pairs whose contact the world allows, each in both orders.
    allowed: BTreeSet<(usize, usize)>,
}

impl<'a> SelfCollision<'a> {
    /// Determines the pairs. `solid` are the URDF links that have a shape.
    ///
    /// # Errors
    /// Names of links in the world that the robot does not have.
    pub fn new(bodies: &'a Bodies<'a>, solid: BTreeSet<usize>) -> Result<Self, Diagnostic> {
        let groups = (0..bodies.document.robot.links.len())
            .map(|link| group(bodies.document, bodies.tree, bodies.chain, link))
            .collect();
        let mut allowed = BTreeSet::new();
        for pair in bodies.settings.table.ignore_contact.iter().flatten() {
            let names = pair.get_ref();
            let mut found = Vec::new();
            for name in names {
                match bodies.document.robot.links.iter().position(|link| link.name == *name.get_ref()) {
                    Some(link) => found.push(link),
                    None => {
                        let message = format!("[robot] ignore_contact: the robot has no link \"{}\"", name.get_ref());
                        let help = format!(
                            "the links are {}",
                            quoted(bodies.document.robot.links.iter().map(|link| link.name.as_str()))
                        );
                        return Err(bodies.settings.source.diagnostic_at(name.span(), message).help(help));
                    }
                }
            }
            let [a, b] = found[..] else {
                let message = format!("[robot] ignore_contact: a pair of links needs two names, not {}", names.len());
                let help = "ignore_contact = [[\"base_link\", \"forearm\"]]";
                return Err(bodies.settings.source.diagnostic_at(pair.span(), message).help(help));
            };
            allowed.extend([(a, b), (b, a)]);
        }
        Ok(Self { bodies, groups, solid, allowed })
    }

    /// Returns true if the planner keeps two URDF links apart.
    fn keeps_apart(&self, a: usize, b: usize) -> bool {
        let is_enabled = self.bodies.settings.table.own_body_is_obstacle();
        let are_apart = self.groups[a].zip(self.groups[b]).is_some_and(|(a, b)| a != b);
        is_enabled && are_apart && !self.allowed.contains(&(a, b)) && !self.are_neighbors(a, b)
    }

    /// Returns true if no link with a shape lies between two links in the tree.
    fn are_neighbors(&self, a: usize, b: usize) -> bool {
        let [above_a, above_b] = [a, b].map(|link| self.bodies.tree.ancestors(link));
        let common = above_a.iter().rev().zip(above_b.iter().rev()).take_while(|(a, b)| a == b).count();
        let between = |above: &[usize]| above[..above.len() - common].iter().skip(1).copied().collect::<Vec<_>>();
        // If one link carries the other, it is their last common link.
        let top = above_a[above_a.len() - common];
        let middle = (top != a && top != b).then_some(top);
        !between(&above_a).into_iter().chain(between(&above_b)).chain(middle).any(|link| self.solid.contains(&link))
    }

    /// Returns the heights at which a link's meshes are cut into layers, in ascending order. They are the lower and
    /// upper ends of the shapes from which the planner keeps the link apart.
    pub fn cuts(&self, link: usize, all: &[PlacedShape]) -> Vec<f64> {
        let others = all.iter().filter(|other| self.keeps_apart(link, other.link));
        let mut cuts: Vec<f64> = others.flat_map(|other| [other.heights.lower, other.heights.upper]).collect();
        cuts.sort_by(f64::total_cmp);
        cuts.dedup_by(|b, a| *b - *a <= MIN_LAYER_THICKNESS);
        cuts
    }

    /// Lists the robot's own links as obstacles for the links further along the chain: one obstacle per layer of a mesh.
    /// Each names the links that may touch it.
    pub fn obstacles(&self, all: &[PlacedShape]) -> Vec<SelfObstacle> {
        if !self.bodies.settings.table.own_body_is_obstacle() {
            return Vec::new();
        }
        let mut obstacles = Vec::new();
        for shape in all {
            let &PlacedShape { link, number, is_visual, .. } = shape;
            let carrier = match self.groups[link] {
                Some(Group::Fixed) => Carrier::Base,
                Some(Group::First) if self.solid.iter().any(|other| self.is_hit_by(link, *other)) => {
                    Carrier::FirstJoint
                }
                _ => continue,
            };
            for (piece, heights) in shape.solid.layers(&shape.pose, self.bodies.plane, &self.cuts(link, all)) {
                let name = self.bodies.document.robot.links[link].name.clone();
                let obstacle = Obstacle { name, shape: Shape::Pieces, pieces: vec![piece], heights };
                let ignored = self.ignored(link);
                let permanent = Vec::new();
                obstacles.push(SelfObstacle { carrier, obstacle, number, is_visual, ignored, permanent });
            }
        }
        obstacles
    }

    /// Returns true if the planner keeps a link apart from one further along the chain.
    fn is_hit_by(&self, link: usize, other: usize) -> bool {
        self.groups[link] < self.groups[other] && self.keeps_apart(link, other)
    }

    /// Lists the links further along the chain whose contact with a link is ignored.
    fn ignored(&self, link: usize) -> Vec<String> {
        let further = |other: &usize| self.groups[link] < self.groups[*other];
        let ignored = self.solid.iter().copied().filter(|other| further(other) && !self.keeps_apart(link, *other));
        ignored.map(|other| self.bodies.document.robot.links[other].name.clone()).collect()
    }

    /// Describes the neighbours whose contact is ignored.
    pub fn notes(&self) -> Vec<String> {
        let neighbors: Vec<String> =
            self.pairs().filter(|(a, b)| self.are_neighbors(*a, *b)).map(|p| self.named(p)).collect();
        let is_enabled = self.bodies.settings.table.own_body_is_obstacle();
        let note = format!("contact of links that are neighbours is ignored: {}", neighbors.join(", "));
        if is_enabled && !neighbors.is_empty() { vec![note] } else { Vec::new() }
    }

    /// Iterates over pairs of solid links of different groups.
    fn pairs(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let all = self.solid.iter().copied().filter(|&link| self.groups[link].is_some());
        all.clone()
            .flat_map(move |a| all.clone().map(move |b| (a, b)))
            .filter(|&(a, b)| self.groups[a] < self.groups[b])
    }

    fn named(&self, (a, b): (usize, usize)) -> String {
        let name = |link: usize| &self.bodies.document.robot.links[link].name;
        format!("\"{}\" and \"{}\"", name(a), name(b))
    }
}

/// Ignores the contact of links that touch in every configuration, and names them. The arm is placed at
/// [`SAMPLES_PER_JOINT`] values of each joint within its limits.
pub(super) fn ignore_permanent_contact(arm: &mut Arm) -> Option<String> {
    if arm.self_obstacles.is_empty() {
        return None;
    }
    let scene = Scene::trusted(arm.clone(), Workspace::new([]));
    let names = |pair: &cplan_core::model::Pair| {
        let moving = &scene.link(*pair).parts[pair.part].body;
        (scene.obstacle_name(*pair).to_owned(), moving.clone())
    };
    let mut permanent: BTreeSet<(String, String)> = scene.pairs().iter().map(names).collect();
    let value = |joint: usize, number: usize| {
        let (lower, upper) = scene.arm().joints[joint].range.domain();
        lower + (upper - lower) * (number as f64 + 0.5) / SAMPLES_PER_JOINT as f64
    };
    for number in 0..SAMPLES_PER_JOINT * SAMPLES_PER_JOINT {
        if permanent.is_empty() {
            return None;
        }
        let poses = scene
            .arm()
            .pair_poses(Configuration::new(value(0, number / SAMPLES_PER_JOINT), value(1, number % SAMPLES_PER_JOINT)));
        let of_permanent = scene.pairs().iter().filter(|pair| permanent.contains(&names(pair)));
        let meet = of_permanent
            .filter(|&&pair| separation(&scene.part(pair).at(&poses[pair.link]), scene.piece(pair)).distance <= 0.0);
        permanent = meet.map(names).collect();
    }
    for own in &mut arm.self_obstacles {
        let of_this = permanent.iter().filter(|(fixed, _)| *fixed == own.obstacle.name);
        own.permanent.extend(of_this.map(|(_, moving)| moving.clone()));
    }
    let named: Vec<String> = permanent.iter().map(|(fixed, moving)| format!("\"{fixed}\" and \"{moving}\"")).collect();
    Some(format!("contact of links that meet in every configuration is ignored: {}", named.join(", ")))
}

/// Returns the group of a URDF link. `None` if the last joint that moves it is outside the arm.
pub(super) fn group(document: &Document, tree: &Tree, chain: &Chain, link: usize) -> Option<Group> {
    let [first, second] = chain.joints;
    if tree.carries(second, link) {
        return Some(Group::Second);
    }
    if tree.carries(first, link) {
        return Some(Group::First);
    }
    let moves = |joint: usize| document.robot.joints[joint].joint_type != JointType::Fixed;
    let is_beside =
        |&above: &usize| tree.above[above].is_some_and(|joint| moves(joint) && !tree.carries(joint, tree.child[first]));
    (!tree.ancestors(link).iter().any(is_beside)).then_some(Group::Fixed)
}
