//! The choice of the two planned joints, the values of the other joints, and the tip link.

use super::document::Document;
use super::held::HeldValues;
use super::pairing::{self, ImpliedPair};
use super::tree::Tree;
use crate::Spanned;
use crate::error::{Diagnostic, InputError, quoted};
use crate::settings::RobotSettings;
use urdf_rs::JointType;

/// The choices that reduce a robot to a two-joint arm, as indices of links and joints in the file.
#[derive(Debug)]
pub(super) struct Chain {
    /// The two arm joints, base to tip.
    pub joints: [usize; 2],
    /// The link whose origin is the tip.
    pub tip: usize,
    /// Value of every joint; 0 for the two arm joints.
    pub values: Vec<f64>,
    /// The other movable joints whose values matter to the arm. They are kept fixed.
    pub held: Vec<usize>,
    /// Notes about these joints.
    pub notes: Vec<String>,
}

/// Chooses joints, values and tip.
///
/// # Errors
/// Ambiguous joints, a first joint that does not carry the second, and other joints that would have to move with them.
pub(super) fn choose(document: &Document, tree: &Tree, settings: RobotSettings) -> Result<Chain, InputError> {
    let chooser = Chooser { document, tree, settings };
    chooser.names_exist()?;
    let ImpliedPair { joints, reason } = chooser.joints()?;
    let mut chain = with_joints(document, tree, settings, joints)?;
    if !reason.is_empty() {
        let [first, second] = joints.map(|j| document.robot.joints[j].name.as_str());
        let note =
            format!("cplan plans for the joints \"{first}\" and \"{second}\"{reason}; choose others by [robot] joints");
        chain.notes.insert(0, note);
    }
    Ok(chain)
}

/// Returns the chain of two joints, the first of which carries the second.
///
/// # Errors
/// Other joints that would have to move with them, and a tip or fixed values of the world that do not fit them.
pub(super) fn with_joints(
    document: &Document,
    tree: &Tree,
    settings: RobotSettings,
    joints: [usize; 2],
) -> Result<Chain, InputError> {
    let chooser = Chooser { document, tree, settings };
    chooser.independent(joints)?;
    let tip = chooser.tip(joints)?;
    let HeldValues { values, held, notes } = chooser.values(joints)?;
    Ok(Chain { joints, tip, values, held, notes })
}

/// Returns true if the rest of the world's `[robot]` table fits these two joints.
pub(super) fn admits(document: &Document, tree: &Tree, settings: RobotSettings, joints: [usize; 2]) -> bool {
    Chooser { document, tree, settings }.names_exist().is_ok() && with_joints(document, tree, settings, joints).is_ok()
}

/// Returns the two joints that the world names, or the only two that can move. `None` if neither applies.
pub(super) fn joints(document: &Document, tree: &Tree, settings: RobotSettings) -> Option<[usize; 2]> {
    Chooser { document, tree, settings }.joints().ok().map(|evident| evident.joints)
}

/// Returns all pairs of independent joints whose first joint carries the second; base first.
pub(super) fn pairs(document: &Document, tree: &Tree) -> Vec<[usize; 2]> {
    let joints = &document.robot.joints;
    let mut movable: Vec<usize> =
        (0..joints.len()).filter(|j| is_movable(&joints[*j]) && joints[*j].mimic.is_none()).collect();
    movable.sort_by_key(|j| tree.depth(tree.child[*j]));
    let carried = |a: usize| movable.iter().filter(move |b| tree.carries(a, tree.parent[**b])).map(move |b| [a, *b]);
    movable.iter().flat_map(|a| carried(*a)).collect()
}

/// The choice of joints, with checks of its validity.
pub(super) struct Chooser<'a> {
    pub document: &'a Document,
    pub tree: &'a Tree,
    pub settings: RobotSettings<'a>,
}

/// Returns true if a joint has a single value that can change.
pub(super) fn is_movable(joint: &urdf_rs::Joint) -> bool {
    matches!(joint.joint_type, JointType::Revolute | JointType::Continuous | JointType::Prismatic)
}

/// Returns the type as written in the file.
pub(super) fn type_name(joint: &urdf_rs::Joint) -> String {
    format!("{:?}", joint.joint_type).to_lowercase()
}

impl Chooser<'_> {
    pub(super) fn all(&self) -> &[urdf_rs::Joint] {
        &self.document.robot.joints
    }

    pub(super) fn joint(&self, name: &str) -> Option<usize> {
        self.all().iter().position(|j| j.name == name)
    }

    pub(super) fn in_world<T>(&self, place: &Spanned<T>, message: String) -> Diagnostic {
        self.settings.source.diagnostic_at(place.span(), message)
    }

    /// Returns a movable joint that the world file names.
    pub(super) fn named(&self, name: &Spanned<String>, table: &str) -> Result<usize, Diagnostic> {
        let movable = || quoted(self.all().iter().filter(|j| is_movable(j)).map(|j| &j.name));
        let help = || format!("the movable joints are {}", movable());
        let Some(index) = self.joint(name.get_ref()) else {
            let message = format!("[robot] {table}: the robot has no joint \"{}\"", name.get_ref());
            return Err(self.in_world(name, message).help(help()));
        };
        let joint = &self.all()[index];
        if !is_movable(joint) {
            let message = format!("[robot] {table}: joint \"{}\" is of type {}", joint.name, type_name(joint));
            return Err(self.in_world(name, message).help(help()));
        }
        Ok(index)
    }

    fn names_exist(&self) -> Result<(), InputError> {
        let robot = &self.settings.table;
        let keys = |table, names: Vec<&Spanned<String>>| -> Vec<Diagnostic> {
            names.into_iter().filter_map(|n| self.named(n, table).err()).collect()
        };
        let mut diagnostics = keys("fixed", robot.fixed.keys().collect());
        diagnostics.extend(keys("limits", robot.limits.keys().collect()));
        diagnostics.extend(keys("velocity", robot.velocity.keys().collect()));
        diagnostics.extend(keys("acceleration", robot.acceleration.keys().collect()));
        diagnostics.extend(keys("jerk", robot.jerk.keys().collect()));
        diagnostics.extend(keys("effort", robot.effort.keys().collect()));
        InputError::check(diagnostics)
    }

    /// Returns the two joints, and the reason for choosing them. The reason is empty if the world names them, or if no other
    /// joints can move.
    fn joints(&self) -> Result<ImpliedPair, Diagnostic> {
        let implied = |joints: [usize; 2]| ImpliedPair { joints, reason: String::new() };
        let ImpliedPair { joints: pair, reason } = match &self.settings.table.joints {
            Some(names) => match names.get_ref().as_slice() {
                [a, b] => implied([self.named(a, "joints")?, self.named(b, "joints")?]),
                other => {
                    let message = format!("[robot] joints: {} joints are named, but exactly two must be", other.len());
                    return Err(self.in_world(names, message).help("joints = [\"first\", \"second\"], base to tip"));
                }
            },
            None => self.implied_pair()?,
        };
        let [a, b] = pair;
        if self.tree.carries(a, self.tree.parent[b]) {
            return Ok(ImpliedPair { joints: pair, reason });
        }
        let (first, second) = (&self.all()[a].name, &self.all()[b].name);
        let swapped = self.tree.carries(b, self.tree.parent[a]);
        match &self.settings.table.joints {
            None if swapped => Ok(implied([b, a])),
            Some(names) if swapped => {
                let message =
                    format!("[robot] joints: the order is wrong, because joint \"{second}\" carries joint \"{first}\"");
                Err(self.in_world(names, message).help(format!("swap them: joints = [\"{second}\", \"{first}\"]")))
            }
            names => {
                let message = if a == b {
                    format!("joint \"{first}\" is named twice")
                } else {
                    format!("joints \"{first}\" and \"{second}\" are on different branches: neither carries the other")
                };
                let diagnostic = match names {
                    Some(names) => self.in_world(names, format!("[robot] joints: {message}")),
                    None => self.document.source.diagnostic(message),
                };
                Err(diagnostic.help("choose two joints of one chain, base to tip"))
            }
        }
    }

    /// Returns the joints that move independently of others.
    fn candidates(&self) -> Vec<usize> {
        (0..self.all().len()).filter(|j| is_movable(&self.all()[*j]) && self.all()[*j].mimic.is_none()).collect()
    }

    fn implied_pair(&self) -> Result<ImpliedPair, Diagnostic> {
        let candidates = self.candidates();
        if let [a, b] = candidates[..] {
            return Ok(ImpliedPair { joints: [a, b], reason: String::new() });
        }
        let list: Vec<String> = candidates
            .iter()
            .map(|j| format!("\"{}\" ({})", self.all()[*j].name, type_name(&self.all()[*j])))
            .collect();
        let mimics: Vec<String> = self
            .all()
            .iter()
            .filter_map(|j| j.mimic.as_ref().map(|m| format!("\"{}\" mimics \"{}\"", j.name, m.joint)))
            .collect();
        let coupled = if mimics.is_empty() {
            String::new()
        } else {
            format!(
                "; also, {}: cplan refuses links that mimic joints couple (a parallelogram or other linkage), because such an arm is no serial two-joint arm",
                mimics.join(", ")
            )
        };
        if candidates.len() < 2 {
            let what = match list.first() {
                None => "no movable joint".to_owned(),
                Some(only) => format!("only one movable joint, {only}"),
            };
            let message = format!("cplan plans for two joints, but the robot has {what}{coupled}");
            return Err(self
                .document
                .source
                .diagnostic(message)
                .help("use a robot with two joints that move in one plane"));
        }
        if candidates.len() > pairing::MAX_TRIED_JOINTS {
            let message =
                format!("the robot has {} movable joints; which two should cplan plan for?{coupled}", candidates.len());
            let help = "name two joints of one chain in the world file: [robot] joints = [\"first\", \"second\"]; all other joints stand still";
            return Err(self.document.source.diagnostic(message).help(help));
        }
        let planar = pairing::planar(self.document, self.tree, self.settings);
        if let Some(evident) = pairing::implied_pair(self.document, self.tree, &planar) {
            return Ok(evident);
        }
        let count = candidates.len();
        let list = list.join(", ");
        if planar.is_empty() {
            let message = format!(
                "no two of the robot's {count} movable joints move in one plane, as cplan requires: {list}{coupled}"
            );
            let help =
                "use a robot with two joints that move in one plane; `cplan inspect` gives the reason for each pair";
            return Err(self.document.source.diagnostic(message).help(help));
        }
        let message = format!("the robot has {count} movable joints; which two should cplan plan for? {list}{coupled}");
        let help = format!(
            "name two joints of one chain in the world file: {}; all other joints stand still (at `fixed` values)",
            pairing::choices(self.document, &planar)
        );
        Err(self.document.source.diagnostic(message).help(help))
    }

    /// Checks that the two joints are independent:
    /// - Neither mimics another joint.
    /// - No joint that carries the arm, belongs to it or moves shapes mimics one of them.
    /// - No joint with several degrees of freedom is in the arm or carries it.
    fn independent(&self, chosen: [usize; 2]) -> Result<(), Diagnostic> {
        let reason = "an arm with coupled joints (a parallelogram or other linkage) is no serial two-joint arm";
        for j in chosen {
            if let Some(mimic) = &self.all()[j].mimic {
                let message = format!("mimics joint \"{}\", so it cannot move on its own: {reason}", mimic.joint);
                return Err(self.mimic_diagnostic(j, &message));
            }
        }
        for (j, joint) in self.all().iter().enumerate() {
            let carried = self.tree.carries(chosen[0], self.tree.child[j]);
            if matches!(joint.joint_type, JointType::Floating | JointType::Planar | JointType::Spherical)
                && (carried || self.tree.carries(j, self.tree.child[chosen[1]]))
            {
                let message =
                    format!("is of type {}, so one value does not determine the pose of its link", type_name(joint));
                return Err(self
                    .document
                    .joint_diagnostic(j, &message)
                    .help("make this joint fixed, or choose joints above it"));
            }
            // A joint outside the arm matters if it moves links that can collide.
            let matters = || carried || self.tree.carries(j, self.tree.child[chosen[0]]) || self.has_shapes(j);
            if joint.mimic.is_none() || !matters() {
                continue;
            }
            let leader = self.leader(j)?;
            if chosen.contains(&leader) {
                let leader = &self.all()[leader].name;
                let message = format!("mimics joint \"{leader}\", so more than two joints of the arm move: {reason}");
                return Err(self.mimic_diagnostic(j, &message));
            }
        }
        Ok(())
    }

    /// Returns true if a joint carries a link with shapes.
    pub(super) fn has_shapes(&self, joint: usize) -> bool {
        let links = self.document.robot.links.iter().enumerate().filter(|(link, _)| self.tree.carries(joint, *link));
        links.map(|(_, link)| link).any(|link| !link.collision.is_empty() || !link.visual.is_empty())
    }

    pub(super) fn mimic_diagnostic(&self, joint: usize, message: &str) -> Diagnostic {
        let place = &self.document.joints[joint];
        let message = format!("joint \"{}\" {message}", self.all()[joint].name);
        self.document
            .diagnostic_at(place.mimic.as_ref().unwrap_or(&place.at), message)
            .help("choose joints that no mimic joint depends on; if the coupling does not matter, make the joint fixed in a copy of the file")
    }

    fn tip(&self, joints: [usize; 2]) -> Result<usize, Diagnostic> {
        let below: Vec<usize> = (0..self.tree.links.len()).filter(|l| self.tree.carries(joints[1], *l)).collect();
        if let Some(name) = &self.settings.table.tip {
            return match self.tree.link(name.get_ref()) {
                Some(link) if below.contains(&link) => Ok(link),
                found => {
                    let message = match found {
                        None => format!("[robot] tip: the robot has no link \"{}\"", name.get_ref()),
                        Some(_) => format!(
                            "[robot] tip: link \"{}\" is not carried by the second joint, \"{}\"",
                            name.get_ref(),
                            self.all()[joints[1]].name
                        ),
                    };
                    let links = quoted(below.iter().map(|l| &self.tree.links[*l]));
                    Err(self.in_world(name, message).help(format!("the links that it carries are {links}")))
                }
            };
        }
        // The deepest link below joint 2; among equals, the first one in the file.
        let depth = |l: &usize| (self.tree.depth(*l), std::cmp::Reverse(*l));
        Ok(below.into_iter().max_by_key(depth).unwrap_or(self.tree.child[joints[1]]))
    }
}

/// Returns the unit of a joint's value.
pub(super) fn unit(joint: &urdf_rs::Joint) -> &'static str {
    if joint.joint_type == JointType::Prismatic { "m" } else { "rad" }
}
