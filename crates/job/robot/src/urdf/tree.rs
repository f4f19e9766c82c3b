//! The tree of links and joints, and the poses of the links.

use super::document::Document;
use crate::error::{Diagnostic, InputError, quoted};
use nalgebra::{Isometry3, Translation3, Unit, UnitQuaternion, Vector3};
use std::collections::HashMap;
use std::ops::Range;
use urdf_rs::JointType;

/// The links of a URDF as a tree. Links and joints are given by their indices in the file. In Drake's files, the root may be a
/// link `world` that the file does not declare; its index follows those of the other links.
#[derive(Debug)]
pub(super) struct Tree {
    /// Names of the links, in the order of the file.
    pub links: Vec<String>,
    /// For each joint, the link that carries it (`parent`) and the link that it carries (`child`).
    pub parent: Vec<usize>,
    pub child: Vec<usize>,
    /// The joint above each link. `None` for the root.
    pub above: Vec<Option<usize>>,
    /// The only link without a joint above it.
    pub root: usize,
    /// True if the root is a link `world` that the file does not declare.
    pub implicit_world: bool,
    /// Links from the root downwards; all descendants of a link come directly after it.
    order: Vec<usize>,
    /// For each link, the range of `order` that contains the link and its descendants.
    stretch: Vec<Range<usize>>,
    /// Number of joints above each link.
    depth: Vec<usize>,
}

/// The only link that may be used as a root without being declared.
const WORLD_LINK: &str = "world";

impl Tree {
    /// Builds the tree. Linear in the number of joints.
    ///
    /// # Errors
    /// Missing links, links below two joints, cycles, or several roots. The error has all defects of one kind.
    pub fn build(document: &Document) -> Result<Self, InputError> {
        let mut links: Vec<String> = document.robot.links.iter().map(|l| l.name.clone()).collect();
        let declared = links.len();
        let (parent, child) = endpoints(document, &mut links)?;
        let above = joints_above(document, &links, &child)?;
        let roots: Vec<usize> = (0..links.len()).filter(|l| above[*l].is_none()).collect();
        let order = downwards(&roots, links.len(), &parent, &child);
        let mut reached = vec![false; links.len()];
        order.iter().for_each(|&link| reached[link] = true);
        if let Some(stray) = reached.iter().position(|reached| !reached) {
            return Err(cycle(document, stray, &above, &parent).into());
        }
        match roots.as_slice() {
            [root] => {
                let (root, implicit_world) = (*root, links.len() > declared);
                let mut depth = vec![0; links.len()];
                let mut stretch = vec![0..0; links.len()];
                for (at, &link) in order.iter().enumerate() {
                    depth[link] = above[link].map_or(0, |joint| depth[parent[joint]] + 1);
                    stretch[link] = at..at + 1;
                }
                for &link in order.iter().rev() {
                    if let Some(joint) = above[link] {
                        stretch[parent[joint]].end = stretch[parent[joint]].end.max(stretch[link].end);
                    }
                }
                Ok(Self { links, parent, child, above, root, implicit_world, order, stretch, depth })
            }
            _ => Err(several_roots(document, &links, &roots).into()),
        }
    }

    /// Returns the index of a link.
    pub fn link(&self, name: &str) -> Option<usize> {
        self.links.iter().position(|l| l == name)
    }

    /// Returns the number of joints from the root to a link.
    pub fn depth(&self, link: usize) -> usize {
        self.depth[link]
    }

    /// Returns a link and all its ancestors up to the root.
    pub fn ancestors(&self, link: usize) -> Vec<usize> {
        std::iter::successors(Some(link), |&link| self.above[link].map(|joint| self.parent[joint])).collect()
    }

    /// Returns true if `joint` moves `link`. `O(1)`.
    pub fn carries(&self, joint: usize, link: usize) -> bool {
        self.stretch[self.child[joint]].contains(&self.stretch[link].start)
    }

    /// Returns the pose of every link in the root frame, for these values of the joints. `O(links)`.
    pub fn poses(&self, robot: &urdf_rs::Robot, values: &[f64]) -> Vec<Isometry3<f64>> {
        let mut poses = vec![Isometry3::identity(); self.links.len()];
        for link in &self.order {
            if let Some(j) = self.above[*link] {
                let joint = &robot.joints[j];
                poses[*link] = poses[self.parent[j]] * isometry(&joint.origin) * motion(joint, values[j]);
            }
        }
        poses
    }
}

/// Converts a URDF pose: fixed-axis roll, pitch, yaw, then the translation.
pub(super) fn isometry(pose: &urdf_rs::Pose) -> Isometry3<f64> {
    let [roll, pitch, yaw] = pose.rpy.0;
    let [x, y, z] = pose.xyz.0;
    Isometry3::from_parts(Translation3::new(x, y, z), UnitQuaternion::from_euler_angles(roll, pitch, yaw))
}

/// Returns the joint's axis in its own frame. The document has refused zero axes.
pub(super) fn axis(joint: &urdf_rs::Joint) -> Unit<Vector3<f64>> {
    Unit::new_normalize(Vector3::from(joint.axis.xyz.0))
}

fn motion(joint: &urdf_rs::Joint, value: f64) -> Isometry3<f64> {
    match joint.joint_type {
        JointType::Revolute | JointType::Continuous => {
            Isometry3::from_parts(Translation3::identity(), UnitQuaternion::from_axis_angle(&axis(joint), value))
        }
        JointType::Prismatic => {
            Isometry3::from_parts((axis(joint).into_inner() * value).into(), UnitQuaternion::identity())
        }
        // These joints stay at the origins of their frames. Arms that would move with one of them are refused elsewhere.
        JointType::Fixed | JointType::Floating | JointType::Planar | JointType::Spherical => Isometry3::identity(),
    }
}

fn endpoints(document: &Document, links: &mut Vec<String>) -> Result<(Vec<usize>, Vec<usize>), InputError> {
    let joints = &document.robot.joints;
    let declared = links.len();
    let implicit = !links.iter().any(|l| l == WORLD_LINK)
        && joints.iter().any(|j| j.parent.link == WORLD_LINK)
        && !joints.iter().any(|j| j.child.link == WORLD_LINK);
    if implicit {
        links.push(WORLD_LINK.to_owned());
    }
    let mut numbers = HashMap::new();
    for (number, link) in links.iter().enumerate() {
        numbers.entry(link.as_str()).or_insert(number);
    }
    let mut diagnostics = Vec::new();
    let mut find = |name: &str, j: usize, role: &str, at| {
        numbers.get(name).copied().unwrap_or_else(|| {
            let message = format!("joint \"{}\": its {role} link \"{name}\" does not exist", joints[j].name);
            let help = format!(
                "declare <link name=\"{name}\"/> or correct the name; the links are {}",
                quoted(&links[..declared])
            );
            diagnostics.push(document.diagnostic_at(at, message).help(help));
            0
        })
    };
    let parent =
        (0..joints.len()).map(|j| find(&joints[j].parent.link, j, "parent", &document.joints[j].parent)).collect();
    let child = (0..joints.len()).map(|j| find(&joints[j].child.link, j, "child", &document.joints[j].child)).collect();
    InputError::check(diagnostics)?;
    Ok((parent, child))
}

fn joints_above(document: &Document, links: &[String], child: &[usize]) -> Result<Vec<Option<usize>>, InputError> {
    let mut above: Vec<Option<usize>> = vec![None; links.len()];
    let mut diagnostics = Vec::new();
    for (j, link) in child.iter().enumerate() {
        match above[*link] {
            None => above[*link] = Some(j),
            Some(first) => {
                let other = &document.robot.joints[first].name;
                let message = format!(
                    "link \"{}\" is the child of two joints, \"{other}\" (line {}) and this one, so the robot is not a tree",
                    links[*link],
                    document.joint_line(first)
                );
                let help =
                    "give one of the joints its own child link; closed chains (parallelogram, delta) are not supported";
                diagnostics.push(document.diagnostic_at(&document.joints[j].child, message).help(help));
            }
        }
    }
    InputError::check(diagnostics)?;
    Ok(above)
}

/// Returns the links from the roots downwards: each link comes before its descendants.
fn downwards(roots: &[usize], links: usize, parent: &[usize], child: &[usize]) -> Vec<usize> {
    let mut below = vec![Vec::new(); links];
    for (&parent, &child) in parent.iter().zip(child) {
        below[parent].push(child);
    }
    let mut order = Vec::with_capacity(links);
    let mut waiting: Vec<usize> = roots.iter().rev().copied().collect();
    while let Some(link) = waiting.pop() {
        order.push(link);
        waiting.extend(below[link].iter().rev());
    }
    order
}

fn cycle(document: &Document, stray: usize, above: &[Option<usize>], parent: &[usize]) -> Diagnostic {
    // From a link that no root reaches, the way upwards must enter a cycle.
    let mut seen = Vec::new();
    let mut passed = vec![false; parent.len()];
    let mut joint = above[stray];
    while let Some(j) = joint.filter(|&j| !std::mem::replace(&mut passed[j], true)) {
        seen.push(j);
        joint = above[parent[j]];
    }
    let from = joint.and_then(|j| seen.iter().position(|s| *s == j)).unwrap_or(0);
    let ring: Vec<&str> = seen[from..].iter().map(|j| document.robot.joints[*j].name.as_str()).collect();
    let message =
        format!("the joints {} form a cycle: each one carries the parent link of the one before", quoted(&ring));
    document
        .diagnostic_at(&document.joints[seen[from]].at, message)
        .help("give one of these joints another parent link, so that the links form a tree")
}

fn several_roots(document: &Document, links: &[String], roots: &[usize]) -> Diagnostic {
    let message = format!(
        "the robot has several root links (links that are no joint's child), but needs exactly one: {}",
        quoted(roots.iter().map(|r| &links[*r]))
    );
    let at = roots.iter().filter_map(|r| document.links.get(*r)).nth(1).or(document.links.first());
    let diagnostic = match at {
        Some(place) => document.diagnostic_at(&place.at, message),
        None => document.source.diagnostic(message),
    };
    diagnostic.help("connect these links by fixed joints, or remove those that are not used")
}
