//! Self-collision: the pairs of links that the planner keeps apart, and the layers into which it cuts their meshes.
//!
//! A link is an obstacle for all links that a joint further along the chain moves. There are two exceptions: links that the world
//! allows to touch it, and single shapes that provably meet in every configuration, such as neighbours at their joint.

use super::bodies::Bodies;
use super::chain::Chain;
use super::document::Document;
use super::shapes::PlacedShape;
use super::solid::MIN_LAYER_THICKNESS;
use super::tree::Tree;
use crate::error::{Diagnostic, quoted};
use cplan_geometry::{Convex, Point, hull};
use cplan_judge::permanent_contacts;
use cplan_model::{Arm, Carrier, Growth, Obstacle, Pair, Part, Scene, SelfObstacle, Shape, Workspace};
use std::collections::{BTreeMap, BTreeSet};
use urdf_rs::JointType;

/// The part of the robot to which a link belongs, determined by the last joint that moves it.
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
        is_enabled && are_apart && !self.allowed.contains(&(a, b))
    }

    /// Returns the heights, ascending, at which a link's meshes are cut into layers: the lower and upper ends of the shapes from
    /// which the planner keeps the link apart.
    pub fn cuts(&self, link: usize, all: &[PlacedShape]) -> Vec<f64> {
        let others = all.iter().filter(|other| self.keeps_apart(link, other.link));
        let mut cuts: Vec<f64> = others.flat_map(|other| [other.heights.lower, other.heights.upper]).collect();
        cuts.sort_by(f64::total_cmp);
        cuts.dedup_by(|b, a| *b - *a <= MIN_LAYER_THICKNESS);
        cuts
    }

    /// Lists the robot's own links as obstacles for links further along the chain. Each layer of a mesh is an obstacle, and names
    /// the links that may touch it.
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
                let obstacle =
                    Obstacle { name, shape: Shape::Pieces, pieces: vec![piece], heights, growth: Growth::default() };
                let ignored = self.ignored(link);
                let permanent = Default::default();
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
}

/// Ignores contact between shapes that meet in every configuration, and names these shapes. Here, a mesh with all its layers is
/// one shape: meshes of neighbours enclose the axis of their joint, but single layers may not.
pub(super) fn ignore_permanent_contact(arm: &mut Arm) -> Option<String> {
    if arm.self_obstacles.is_empty() {
        return None;
    }
    let (whole, parts_of, obstacles_of) = uncut(arm);
    let scene = Scene::trusted(whole, Workspace::new([]));
    let permanent = permanent_contacts(&scene);
    for pair in &permanent {
        let link = pair.link.min(1);
        for layer in &obstacles_of[pair.obstacle] {
            arm.self_obstacles[*layer].permanent[link].extend(&parts_of[link][pair.part]);
        }
    }
    let named = named(&scene, &permanent);
    let note = || format!("contact is ignored between shapes that meet in every configuration: {}", named.join(", "));
    (!named.is_empty()).then(note)
}

/// The numbers of the layers of each uncut shape.
type Layers = Vec<Vec<usize>>;

/// Returns the arm in which convex hulls of whole meshes replace their layers. Also returns the layers of each part of each link,
/// and those of the self obstacles.
fn uncut(arm: &Arm) -> (Arm, [Layers; 2], Layers) {
    let mut whole = arm.clone();
    let parts_of = whole.links.each_mut().map(|link| {
        let mut layers = Layers::new();
        for (number, part) in std::mem::take(&mut link.parts).into_iter().enumerate() {
            // A bar has the same number as the link's first shape. Bars are round; layers of meshes are polygons.
            let is_polygon = |shape: &Convex| shape.radius() == 0.0;
            let is_same = |known: &&mut Part| {
                let is_named_alike = (&known.body, known.number) == (&part.body, part.number);
                is_named_alike && is_polygon(&known.shape) && is_polygon(&part.shape)
            };
            match link.parts.last_mut().filter(|known| is_same(known)) {
                Some(known) => {
                    known.shape = joined(&known.shape, &part.shape);
                    known.heights = known.heights.and(part.heights);
                    layers.last_mut().expect("one for each part").push(number);
                }
                None => {
                    link.parts.push(part);
                    layers.push(vec![number]);
                }
            }
        }
        layers
    });
    let mut obstacles_of = Layers::new();
    for (number, own) in std::mem::take(&mut whole.self_obstacles).into_iter().enumerate() {
        let is_same =
            |known: &&mut SelfObstacle| (&known.obstacle.name, known.number) == (&own.obstacle.name, own.number);
        match whole.self_obstacles.last_mut().filter(|known| is_same(known)) {
            Some(known) => {
                known.obstacle.pieces[0] = joined(&known.obstacle.pieces[0], &own.obstacle.pieces[0]);
                known.obstacle.heights = known.obstacle.heights.and(own.obstacle.heights);
                obstacles_of.last_mut().expect("one for each obstacle").push(number);
            }
            None => {
                whole.self_obstacles.push(own);
                obstacles_of.push(vec![number]);
            }
        }
    }
    (whole, parts_of, obstacles_of)
}

/// Returns the convex hull of two layers of a mesh.
fn joined(a: &Convex, b: &Convex) -> Convex {
    let corners: Vec<Point> = a.core().iter().chain(b.core()).copied().collect();
    Convex::trusted(hull(&corners), a.radius().max(b.radius()))
}

/// Names the links of pairs of shapes, or the shapes if only some shapes of two links are in the pairs.
fn named(scene: &Scene, permanent: &[Pair]) -> Vec<String> {
    let links = |pair: &Pair| (scene.obstacle_name(*pair), scene.link(*pair).parts[pair.part].body.as_str());
    let mut by_links: BTreeMap<_, Vec<&Pair>> = BTreeMap::new();
    scene.pairs().iter().for_each(|pair| by_links.entry(links(pair)).or_default().push(pair));
    let mut names = Vec::new();
    for ((fixed, moving), pairs) in by_links {
        let of_links: Vec<&Pair> = pairs.iter().copied().filter(|pair| permanent.contains(pair)).collect();
        if of_links.len() == pairs.len() {
            names.push(format!("\"{fixed}\" and \"{moving}\""));
            continue;
        }
        let number = |pair: &&Pair| {
            let own = scene.self_obstacle(pair.obstacle).expect("a link of the robot");
            [own.number, scene.link(**pair).parts[pair.part].number].map(|number| number + 1)
        };
        let shapes: BTreeSet<[usize; 2]> = of_links.iter().map(number).collect();
        names
            .extend(shapes.into_iter().map(|[a, b]| format!("shape {a} of \"{fixed}\" and shape {b} of \"{moving}\"")));
    }
    names
}

/// Returns the group of a URDF link. `None` if the last joint that moves it is not in the arm.
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
