//! The URDF as a document. `roxmltree` reads it for positions and diagnostics, `urdf-rs` for its contents.
//!
//! `urdf-rs` has no line numbers, accepts `NaN` and invalid vectors, and rejects files because of irrelevant elements (an
//! `<inertial>` without inertia, a `<limit>` without velocity, stray text). So all relevant elements are checked first, and
//! `urdf-rs` reads a copy of the document with only these elements.

use super::attributes::{Attributes, children};
use super::foreign;
use crate::error::{Diagnostic, InputError};
use crate::source::Source;
use roxmltree::Node;
use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};
use std::fmt::Write;
use std::ops::Range;
use std::path::PathBuf;

/// The valid part of a URDF: all numbers are finite, every element has its attributes, and names are unique. Each invalid element
/// is omitted, with a diagnostic.
#[derive(Debug)]
pub(super) struct Document {
    pub source: Source,
    /// Paths of the meshes that were read so far.
    pub meshes: RefCell<Vec<PathBuf>>,
    pub robot: urdf_rs::Robot,
    /// Positions of the links, in the order of `robot.links`.
    pub links: Vec<LinkPlace>,
    /// Positions of the joints, in the order of `robot.joints`.
    pub joints: Vec<JointPlace>,
    /// Number of elements other than links and joints, by name.
    pub others: BTreeMap<String, usize>,
    /// Defects of single elements. A robot with defects can be inspected, but planning refuses it.
    pub diagnostics: Vec<Diagnostic>,
    /// True if no defect concerns joints or names, so that the kinematics are those of the file.
    pub tree_is_sound: bool,
}

/// Positions of a link and its shapes in the file.
#[derive(Debug)]
pub(super) struct LinkPlace {
    pub at: Range<usize>,
    pub visual: Vec<Range<usize>>,
    pub collision: Vec<Range<usize>>,
}

/// Positions of a joint and its parts in the file, and the stated limits.
#[derive(Debug)]
pub(super) struct JointPlace {
    pub at: Range<usize>,
    pub axis: Option<Range<usize>>,
    pub parent: Range<usize>,
    pub child: Range<usize>,
    pub limit: Option<Range<usize>>,
    pub mimic: Option<Range<usize>>,
    /// Position of the `safety_controller`. `None` if it lacks a soft limit, or if both are 0, which exporters write
    /// for missing limits.
    pub soft_limits: Option<Range<usize>>,
    /// True if the limit gives a `velocity`.
    pub has_velocity: bool,
    /// The `acceleration` of the limit. It belongs to URDF 1.2. This reader also accepts it in older files, where `urdf-rs`
    /// ignores it.
    pub acceleration: Option<f64>,
}

impl Document {
    /// Reads a URDF.
    ///
    /// # Errors
    /// A file that is not XML, is xacro or SDF, or has no valid content. Other defects that can be found without the tree of
    /// links are in [`Document::diagnostics`].
    pub fn read(source: Source) -> Result<Self, InputError> {
        foreign::without_entities(&source)?;
        let options = roxmltree::ParsingOptions { allow_dtd: true, ..roxmltree::ParsingOptions::default() };
        let xml = roxmltree::Document::parse_with_options(source.text(), options);
        let xml = xml.map_err(|error| foreign::malformed(&source, &error))?;
        let root = xml.root_element();
        foreign::recognize(&source, root)?;

        let mut reader = Reader {
            source: &source,
            diagnostics: Vec::new(),
            copy: String::new(),
            others: BTreeMap::default(),
            tree_is_sound: true,
        };
        let (links, joints) = reader.robot(root);
        let Reader { diagnostics, copy, others, tree_is_sound, .. } = reader;
        match urdf_rs::read_from_string(&copy) {
            Ok(robot) => Ok(Self {
                robot,
                links,
                joints,
                others,
                diagnostics,
                tree_is_sound,
                source,
                meshes: RefCell::default(),
            }),
            Err(error) => {
                InputError::check(diagnostics)?;
                let diagnostic = source.diagnostic(format!("cannot be read as URDF: {error}"));
                Err(diagnostic.help("check_urdf (package liburdfdom-tools) may report more").into())
            }
        }
    }

    /// Returns the paths of the files that were read so far, including meshes.
    pub fn files(&self) -> Vec<PathBuf> {
        self.source.files().into_iter().chain(self.meshes.borrow().iter().cloned()).collect()
    }

    /// Creates a diagnostic at a place of the file.
    pub fn diagnostic_at(&self, at: &Range<usize>, message: impl Into<String>) -> Diagnostic {
        self.source.diagnostic_at(at.clone(), message)
    }

    /// Creates a diagnostic about a joint, with its name before the message.
    pub fn joint_diagnostic(&self, joint: usize, message: &str) -> Diagnostic {
        self.diagnostic_at(&self.joints[joint].at, format!("joint \"{}\" {message}", self.robot.joints[joint].name))
    }

    /// Returns the line of a joint, for messages.
    pub fn joint_line(&self, joint: usize) -> usize {
        self.source.position(self.joints[joint].at.start).line
    }
}

/// Returns the text of an `<inertial>` element for `urdf-rs`. `None` if the element is incomplete, as is common; only torques
/// need it.
fn inertial(node: Node) -> Option<String> {
    const INERTIA_ATTRIBUTES: [&str; 6] = ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"];
    let mass = numbers(children(node, "mass").next()?, "value", 1)?;
    let inertia = children(node, "inertia").next()?;
    let mut copy = "<inertial>".to_owned();
    if let Some(origin) = children(node, "origin").next() {
        copy += "<origin";
        for name in ["xyz", "rpy"].into_iter().filter(|name| origin.has_attribute(*name)) {
            let _ = write!(copy, " {name}=\"{}\"", numbers(origin, name, 3)?);
        }
        copy += "/>";
    }
    let _ = write!(copy, "<mass value=\"{mass}\"/><inertia");
    for name in INERTIA_ATTRIBUTES {
        let moment = if inertia.has_attribute(name) { numbers(inertia, name, 1)? } else { "0" };
        let _ = write!(copy, " {name}=\"{moment}\"");
    }
    copy += "/></inertial>";
    Some(copy)
}

/// Returns the text of an attribute that consists of `count` finite numbers. `None` if it does not.
fn numbers<'a>(node: Node<'a, '_>, name: &str, count: usize) -> Option<&'a str> {
    let text = node.attribute(name)?;
    let numbers: Option<Vec<f64>> = text.split_whitespace().map(|word| word.parse().ok()).collect();
    numbers.filter(|numbers| numbers.len() == count && numbers.iter().all(|x| x.is_finite())).map(|_| text.trim())
}

struct Reader<'a> {
    source: &'a Source,
    diagnostics: Vec<Diagnostic>,
    copy: String,
    others: BTreeMap<String, usize>,
    tree_is_sound: bool,
}

impl Reader<'_> {
    fn robot(&mut self, root: Node) -> (Vec<LinkPlace>, Vec<JointPlace>) {
        // `urdf-rs` validates only from version 1.2 on, without positions. These checks apply to all versions. `quat_xyzw` exists
        // from version 1.1 on.
        let unlimited = version(root) >= (1, 2);
        let _ = write!(
            self.copy,
            "<robot name=\"{}\" version=\"1.1\">",
            escape_attribute(root.attribute("name").unwrap_or(""))
        );
        let mut links = Vec::new();
        let mut joints = Vec::new();
        // Position of the first element with each name.
        let mut names: HashMap<(&str, &str), usize> = HashMap::new();
        for node in root.children().filter(|n| is_urdf_element(*n, root)) {
            let kind = node.tag_name().name();
            if kind != "link" && kind != "joint" {
                *self.others.entry(kind.to_owned()).or_default() += 1;
                continue;
            }
            let Some(name) = node.attribute("name").filter(|n| !n.trim().is_empty()) else {
                self.diagnostic(node, format!("a <{kind}> has no name"), "give it a unique name");
                self.tree_is_sound = false;
                continue;
            };
            if let Some(&first) = names.get(&(kind, name)) {
                let first = self.source.position(first).line;
                let message = format!("a second {kind} is named \"{name}\"; the first is on line {first}");
                self.diagnostic(node, message, "rename one of them");
                self.tree_is_sound = false;
                continue;
            }
            names.insert((kind, name), node.range().start);
            if kind == "link" {
                links.push(self.link(node, name));
            } else {
                let before = self.diagnostics.len();
                joints.extend(self.joint(node, name, unlimited));
                self.tree_is_sound &= self.diagnostics.len() == before;
            }
        }
        self.copy.push_str("</robot>");
        if links.is_empty() && self.diagnostics.is_empty() {
            self.diagnostics.push(
                self.source
                    .diagnostic("the robot has no link")
                    .help("add a <link name=\"...\"> for each body, and the joints between them"),
            );
        }
        (links, joints)
    }

    fn link(&mut self, link: Node, name: &str) -> LinkPlace {
        self.attributes(&format!("link \"{name}\"")).finite_everywhere(link);
        let mut place = LinkPlace { at: tag(link), visual: Vec::new(), collision: Vec::new() };
        let _ = write!(self.copy, "<link name=\"{}\">", escape_attribute(name));
        for kind in ["visual", "collision"] {
            for node in children(link, kind) {
                if let Some(at) = self.shape(node, kind, name) {
                    if kind == "visual" { place.visual.push(at) } else { place.collision.push(at) }
                }
            }
        }
        if let Some(copy) = children(link, "inertial").next().and_then(inertial) {
            self.copy.push_str(&copy);
        }
        self.copy.push_str("</link>");
        place
    }

    fn shape(&mut self, node: Node, kind: &str, link: &str) -> Option<Range<usize>> {
        let what = format!("link \"{link}\", {kind}");
        let mut attributes = self.attributes(&what);
        let origin = attributes.origin(node);
        let geometry = attributes.only(node, "geometry", true)?;
        let shape = attributes.geometry(geometry)?;
        let _ = write!(self.copy, "<{kind}>{origin}<geometry>");
        self.copy_element(shape, &["size", "radius", "length", "filename", "scale"]);
        let _ = write!(self.copy, "</geometry></{kind}>");
        Some(tag(shape))
    }

    fn joint(&mut self, joint: Node, name: &str, unlimited: bool) -> Option<JointPlace> {
        let what = format!("joint \"{name}\"");
        let mut attributes = self.attributes(&what);
        attributes.finite_everywhere(joint);
        let kind = attributes.joint_type(joint);
        let origin = attributes.origin(joint);
        let parent = attributes.only(joint, "parent", true);
        let child = attributes.only(joint, "child", true);
        let parent_link = parent.and_then(|n| attributes.text(n, "link"));
        let child_link = child.and_then(|n| attributes.text(n, "link"));
        let moves = kind.is_some_and(|k| k != "fixed" && k != "floating");
        let axis = attributes.only(joint, "axis", false).filter(|axis| moves && attributes.direction(*axis));
        let limit = attributes.only(joint, "limit", false);
        // In URDF 1.2, a missing limit means that there is no limit; in older versions, it means 0.
        let [low, high] = if unlimited { [f64::NEG_INFINITY, f64::INFINITY] } else { [0.0; 2] };
        let [lower, upper, velocity, acceleration] = match limit {
            Some(limit) => attributes.limit(limit, [low, high], matches!(kind, Some("revolute" | "prismatic"))),
            None => [None; 4],
        };
        let mimic = attributes.only(joint, "mimic", false);
        if let Some(mimic) = mimic {
            attributes.text(mimic, "joint");
            attributes.number(mimic, "multiplier");
            attributes.number(mimic, "offset");
        }
        let safety = attributes.only(joint, "safety_controller", false);
        let soft = safety.and_then(|s| attributes.soft_limits(s));

        let (kind, parent, child, parent_link, child_link) = (kind?, parent?, child?, parent_link?, child_link?);
        let _ = write!(self.copy, "<joint name=\"{}\" type=\"{kind}\">{origin}", escape_attribute(name));
        let _ = write!(self.copy, "<parent link=\"{}\"/>", escape_attribute(parent_link));
        let _ = write!(self.copy, "<child link=\"{}\"/>", escape_attribute(child_link));
        if let Some(axis) = axis {
            self.copy_element(axis, &["xyz"]);
        }
        if limit.is_some() {
            let _ = write!(
                self.copy,
                "<limit lower=\"{}\" upper=\"{}\" velocity=\"{}\" effort=\"{}\"/>",
                lower.unwrap_or(low),
                upper.unwrap_or(high),
                velocity.unwrap_or(0.0),
                limit.and_then(|limit| limit.attribute("effort")?.trim().parse::<f64>().ok()).unwrap_or(0.0)
            );
        }
        if let Some(mimic) = mimic {
            self.copy_element(mimic, &["joint", "multiplier", "offset"]);
        }
        if let Some([lower, upper]) = soft {
            let soft = format!("soft_lower_limit=\"{lower}\" soft_upper_limit=\"{upper}\"");
            let _ = write!(self.copy, "<safety_controller k_velocity=\"0\" {soft}/>");
        }
        self.copy.push_str("</joint>");
        Some(JointPlace {
            at: tag(joint),
            axis: axis.map(tag),
            parent: tag(parent),
            child: tag(child),
            limit: limit.map(tag),
            has_velocity: limit.is_some_and(|limit| limit.has_attribute("velocity")),
            mimic: mimic.map(tag),
            soft_limits: soft.and(safety).map(tag),
            acceleration,
        })
    }

    /// Copies an element, with only the attributes that `urdf-rs` should read.
    fn copy_element(&mut self, node: Node, keep: &[&str]) {
        let _ = write!(self.copy, "<{}", node.tag_name().name());
        for attribute in node.attributes().filter(|a| keep.contains(&a.name())) {
            let _ = write!(self.copy, " {}=\"{}\"", attribute.name(), escape_attribute(attribute.value()));
        }
        self.copy.push_str("/>");
    }

    fn attributes<'s>(&'s mut self, what: &'s str) -> Attributes<'s> {
        Attributes { source: self.source, diagnostics: &mut self.diagnostics, what }
    }

    fn diagnostic(&mut self, node: Node, message: String, help: &str) {
        self.diagnostics.push(self.source.diagnostic_at(tag(node), message).help(help));
    }
}

/// Returns the position of the first line of the opening tag, below which messages put the caret.
pub(super) fn tag(node: Node) -> Range<usize> {
    let range = node.range();
    let text = &node.document().input_text()[range.clone()];
    let end = text.find(['>', '\n']).map_or(range.end, |i| range.start + i + 1);
    range.start..end
}

/// Returns true for URDF elements. Elements of other namespaces, such as `<drake:joint>`, are not.
fn is_urdf_element(node: Node, root: Node) -> bool {
    node.is_element() && node.tag_name().namespace() == root.tag_name().namespace()
}

fn version(root: Node) -> (u32, u32) {
    let parse = |v: &str| {
        let (major, minor) = v.trim().split_once('.')?;
        Some((major.parse().ok()?, minor.parse().ok()?))
    };
    root.attribute("version").and_then(parse).unwrap_or((1, 0))
}

/// Escapes text for an XML attribute.
pub(super) fn escape_attribute(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}
