//! The URDF as data: links and joints, with their places in the file.

use super::attributes::{Attributes, children};
use super::foreign;
use crate::error::{Diagnostic, InputError};
use crate::source::Source;
use nalgebra::{Isometry3, Matrix3, Unit, Vector3};
use roxmltree::Node;
use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};
use std::ops::Range;
use std::path::PathBuf;

/// The valid part of a URDF: all numbers are finite, every element has its attributes, and names are unique. Invalid
/// elements are omitted, each with a diagnostic.
#[derive(Debug)]
pub(super) struct Document {
    pub source: Source,
    /// Paths of the meshes that were read so far.
    pub meshes: RefCell<Vec<PathBuf>>,
    /// Name of the robot, which can be empty.
    pub name: String,
    pub links: Vec<Link>,
    pub joints: Vec<Joint>,
    /// Number of elements other than links and joints, by name.
    pub others: BTreeMap<String, usize>,
    /// Defects of single elements. A robot with defects can be inspected, but not planned for.
    pub diagnostics: Vec<Diagnostic>,
    /// True if no defect concerns joints or names. Then the kinematics are those of the file.
    pub tree_is_sound: bool,
}

/// A link.
#[derive(Debug)]
pub(super) struct Link {
    pub name: String,
    pub visual: Vec<Shape>,
    pub collision: Vec<Shape>,
    /// Zero if the file gives no complete one, which is frequent; only torques need it.
    pub inertial: Inertial,
    /// Place of the link in the file.
    pub at: Range<usize>,
}

impl Link {
    /// Returns true if the link has shapes, collision or visual.
    pub fn has_shapes(&self) -> bool {
        !self.collision.is_empty() || !self.visual.is_empty()
    }
}

/// A shape of a link.
#[derive(Debug)]
pub(super) struct Shape {
    /// Pose in the frame of the link.
    pub pose: Isometry3<f64>,
    pub geometry: Geometry,
    /// Place of the geometry in the file.
    pub at: Range<usize>,
}

/// The geometry of a shape. Its sizes are positive, or all zero.
#[derive(Debug)]
pub(super) enum Geometry {
    Box([f64; 3]),
    Cylinder { radius: f64, length: f64 },
    Capsule { radius: f64, length: f64 },
    Sphere { radius: f64 },
    Mesh { filename: String, scale: [f64; 3] },
}

/// Mass and inertia of a link.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Inertial {
    /// Pose of the centre of mass in the frame of the link.
    pub pose: Isometry3<f64>,
    pub mass: f64,
    pub inertia: Matrix3<f64>,
}

/// A type of joints.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum JointType {
    Revolute,
    Continuous,
    Prismatic,
    Fixed,
    Floating,
    Planar,
    Spherical,
}

impl JointType {
    /// All types of the URDF specification.
    pub const ALL: [Self; 7] =
        [Self::Revolute, Self::Continuous, Self::Prismatic, Self::Fixed, Self::Floating, Self::Planar, Self::Spherical];

    /// Returns the type as URDF names it.
    pub fn name(self) -> String {
        format!("{self:?}").to_lowercase()
    }
}

/// A joint.
#[derive(Debug)]
pub(super) struct Joint {
    pub name: String,
    pub joint_type: JointType,
    /// Pose at the value 0, in the frame of the parent link.
    pub pose: Isometry3<f64>,
    pub parent: LinkName,
    pub child: LinkName,
    pub axis: Unit<Vector3<f64>>,
    /// Place of the axis in the file, if it is given.
    pub axis_at: Option<Range<usize>>,
    pub limit: Limit,
    /// The soft limits with their place. `None` if they are absent, or if both are 0, which exporters write for missing
    /// limits.
    pub soft_limits: Option<(Range<usize>, [f64; 2])>,
    pub mimic: Option<Mimic>,
    /// Place of the joint in the file.
    pub at: Range<usize>,
}

impl Joint {
    /// Returns true if one value determines the pose of the joint, and can change.
    pub fn is_movable(&self) -> bool {
        matches!(self.joint_type, JointType::Revolute | JointType::Continuous | JointType::Prismatic)
    }

    /// Returns true if the joint slides.
    pub fn slides(&self) -> bool {
        self.joint_type == JointType::Prismatic
    }

    /// Returns the unit of the joint's values.
    pub fn unit(&self) -> &'static str {
        if self.slides() { "m" } else { "rad" }
    }
}

/// The name of a link at a joint.
#[derive(Debug)]
pub(super) struct LinkName {
    pub link: String,
    pub at: Range<usize>,
}

/// The limits of a joint. All are 0 or `None` if the file gives none.
#[derive(Debug, Default)]
pub(super) struct Limit {
    pub lower: f64,
    pub upper: f64,
    pub effort: f64,
    /// 0 if the given one is not a number.
    pub velocity: Option<f64>,
    /// Part of URDF 1.2, and also read in older files.
    pub acceleration: Option<f64>,
    /// Place in the file, if there is a `<limit>`.
    pub at: Option<Range<usize>>,
}

/// The rule by which a joint follows another one.
#[derive(Debug)]
pub(super) struct Mimic {
    pub joint: String,
    pub multiplier: f64,
    pub offset: f64,
    pub at: Range<usize>,
}

impl Document {
    /// Reads a URDF.
    ///
    /// # Errors
    /// A file that is not XML, or is xacro or SDF. [`Document::diagnostics`] collects all other defects that can be found
    /// without the tree of links.
    pub fn read(source: Source) -> Result<Self, InputError> {
        foreign::without_entities(&source)?;
        let options = roxmltree::ParsingOptions { allow_dtd: true, ..roxmltree::ParsingOptions::default() };
        let xml = roxmltree::Document::parse_with_options(source.text(), options);
        let xml = xml.map_err(|error| foreign::malformed(&source, &error))?;
        let root = xml.root_element();
        foreign::recognize(&source, root)?;
        let mut document = Self {
            source: source.clone(),
            meshes: RefCell::default(),
            name: root.attribute("name").unwrap_or("").to_owned(),
            links: Vec::new(),
            joints: Vec::new(),
            others: BTreeMap::new(),
            diagnostics: Vec::new(),
            tree_is_sound: true,
        };
        document.read_elements(root);
        Ok(document)
    }

    fn read_elements(&mut self, root: Node) {
        let unlimited = version(root) >= (1, 2);
        // The position of the first element with each name.
        let mut names: HashMap<(&str, &str), usize> = HashMap::new();
        for node in root.children().filter(|n| is_urdf_element(*n, root)) {
            let kind = node.tag_name().name();
            if kind != "link" && kind != "joint" {
                *self.others.entry(kind.to_owned()).or_default() += 1;
                continue;
            }
            let Some(name) = node.attribute("name").filter(|n| !n.trim().is_empty()) else {
                self.refuse_element(node, format!("a <{kind}> has no name"), "give it a unique name");
                continue;
            };
            if let Some(&first) = names.get(&(kind, name)) {
                let first = self.source.position(first).line;
                let message = format!("a second {kind} is named \"{name}\"; the first is on line {first}");
                self.refuse_element(node, message, "rename one of them");
                continue;
            }
            names.insert((kind, name), node.range().start);
            if kind == "link" {
                let link = self.link(node, name);
                self.links.push(link);
            } else {
                let before = self.diagnostics.len();
                let joint = self.joint(node, name, unlimited);
                self.joints.extend(joint);
                self.tree_is_sound &= self.diagnostics.len() == before;
            }
        }
        if self.links.is_empty() && self.diagnostics.is_empty() {
            self.diagnostics.push(
                self.source
                    .diagnostic("the robot has no link")
                    .help("add a <link name=\"...\"> for each body, and the joints between them"),
            );
        }
    }

    fn link(&mut self, link: Node, name: &str) -> Link {
        self.attributes(&format!("link \"{name}\"")).finite_everywhere(link);
        let [visual, collision] = ["visual", "collision"]
            .map(|kind| children(link, kind).filter_map(|node| self.shape(node, kind, name)).collect());
        let inertial = children(link, "inertial").next().and_then(inertial).unwrap_or_default();
        Link { name: name.to_owned(), visual, collision, inertial, at: tag(link) }
    }

    fn shape(&mut self, node: Node, kind: &str, link: &str) -> Option<Shape> {
        let what = format!("link \"{link}\", {kind}");
        let mut attributes = self.attributes(&what);
        let pose = attributes.origin(node);
        let geometry = attributes.only(node, "geometry", true)?;
        let (shape, geometry) = attributes.geometry(geometry)?;
        Some(Shape { pose, geometry, at: tag(shape) })
    }

    fn joint(&mut self, joint: Node, name: &str, unlimited: bool) -> Option<Joint> {
        let what = format!("joint \"{name}\"");
        let mut attributes = self.attributes(&what);
        attributes.finite_everywhere(joint);
        let joint_type = attributes.joint_type(joint);
        let pose = attributes.origin(joint);
        let [parent, child] = ["parent", "child"].map(|end| attributes.only(joint, end, true));
        let [parent, child] = [parent, child].map(|end| {
            let end = end?;
            Some(LinkName { link: attributes.text(end, "link")?.to_owned(), at: tag(end) })
        });
        let moves = joint_type.is_some_and(|kind| kind != JointType::Fixed && kind != JointType::Floating);
        let axis = attributes.only(joint, "axis", false).filter(|_| moves);
        let axis = axis.and_then(|axis| Some((attributes.direction(axis)?, tag(axis))));
        let limit = attributes.only(joint, "limit", false);
        // From URDF 1.2 on, a missing limit means that there is no limit. Before, it means 0.
        let absent = if unlimited { [f64::NEG_INFINITY, f64::INFINITY] } else { [0.0; 2] };
        let is_ranged = matches!(joint_type, Some(JointType::Revolute | JointType::Prismatic));
        let limit = limit.map_or_else(Limit::default, |limit| attributes.limit(limit, absent, is_ranged));
        let mimic = attributes.only(joint, "mimic", false).and_then(|mimic| attributes.mimic(mimic));
        let soft = attributes.only(joint, "safety_controller", false);
        let soft_limits = soft.and_then(|soft| Some((tag(soft), attributes.soft_limits(soft)?)));
        let (axis, axis_at) = axis.map_or((Vector3::x_axis(), None), |(axis, at)| (axis, Some(at)));
        let (name, at) = (name.to_owned(), tag(joint));
        let (joint_type, parent, child) = (joint_type?, parent?, child?);
        Some(Joint { name, joint_type, pose, parent, child, axis, axis_at, limit, soft_limits, mimic, at })
    }

    fn attributes<'s>(&'s mut self, what: &'s str) -> Attributes<'s> {
        Attributes { source: &self.source, diagnostics: &mut self.diagnostics, what }
    }

    fn refuse_element(&mut self, node: Node, message: String, help: &str) {
        self.diagnostics.push(self.source.diagnostic_at(tag(node), message).help(help));
        self.tree_is_sound = false;
    }

    /// Returns the paths of the files that were read so far, which are those of the text and the meshes.
    pub fn files(&self) -> Vec<PathBuf> {
        self.source.files().into_iter().chain(self.meshes.borrow().iter().cloned()).collect()
    }

    /// Creates a diagnostic at a place of the file.
    pub fn diagnostic_at(&self, at: &Range<usize>, message: impl Into<String>) -> Diagnostic {
        self.source.diagnostic_at(at.clone(), message)
    }

    /// Creates a diagnostic about a joint, with its name before the message.
    pub fn joint_diagnostic(&self, joint: usize, message: &str) -> Diagnostic {
        let joint = &self.joints[joint];
        self.diagnostic_at(&joint.at, format!("joint \"{}\" {message}", joint.name))
    }

    /// Returns the line of a joint, for messages.
    pub fn joint_line(&self, joint: usize) -> usize {
        self.source.position(self.joints[joint].at.start).line
    }
}

/// Returns mass and inertia. `None` if the element is incomplete.
fn inertial(node: Node) -> Option<Inertial> {
    let [mass] = numbers(children(node, "mass").next()?, "value")?;
    let inertia = children(node, "inertia").next()?;
    let [mut xyz, mut rpy] = [[0.0; 3]; 2];
    if let Some(origin) = children(node, "origin").next() {
        for (name, values) in [("xyz", &mut xyz), ("rpy", &mut rpy)] {
            if origin.has_attribute(name) {
                *values = numbers(origin, name)?;
            }
        }
    }
    let moment = |name| if inertia.has_attribute(name) { numbers(inertia, name) } else { Some([0.0]) };
    let [[xx], [xy], [xz]] = [moment("ixx")?, moment("ixy")?, moment("ixz")?];
    let [[yy], [yz], [zz]] = [moment("iyy")?, moment("iyz")?, moment("izz")?];
    let inertia = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    Some(Inertial { pose: isometry(xyz, rpy), mass, inertia })
}

/// Returns the finite numbers of an attribute. `None` if it has others.
fn numbers<const N: usize>(node: Node, name: &str) -> Option<[f64; N]> {
    let numbers =
        node.attribute(name)?.split_whitespace().map(|word| word.parse().ok().filter(|x: &f64| x.is_finite()));
    numbers.collect::<Option<Vec<f64>>>()?.try_into().ok()
}

/// Returns the pose of an `<origin>`.
pub(super) fn isometry([x, y, z]: [f64; 3], [roll, pitch, yaw]: [f64; 3]) -> Isometry3<f64> {
    let turn = nalgebra::UnitQuaternion::from_euler_angles(roll, pitch, yaw);
    Isometry3::from_parts(nalgebra::Translation3::new(x, y, z), turn)
}

/// Returns the position of the first line of the opening tag, where messages put the caret.
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
