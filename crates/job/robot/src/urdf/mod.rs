//! Reduces a URDF to a planar two-joint arm.
//!
//! The joints' axes and all link frames are computed in the root frame at the zero configuration: the two joints are at 0, the
//! others at their values in `[robot] fixed`. Then they are projected onto the common plane of motion.
//!
//! ```text
//! Document (valid elements, diagnostics) -> Tree -> Chain (two joints, tip) -> Reduction -> Plane, Bounds, Outlines
//!     -> Arm
//! ```
//!
//! [`load`] stops at the first stage that fails. [`survey`] continues as far as possible and reports all defects.

mod advice;
mod attributes;
mod bodies;
mod chain;
mod document;
mod drives;
mod effects;
mod foreign;
mod held;
mod ignored;
mod limits;
mod masses;
mod mesh;
mod pairing;
mod plane;
mod reduction;
mod self_collision;
mod shapes;
mod help;
mod solid;
mod survey;
mod tool;
mod tree;

pub use survey::survey;

use crate::error::InputError;
use crate::report::RobotReport;
use crate::settings::RobotSettings;
use crate::source::Source;
use cplan_model::Arm;
use document::Document;
use reduction::Reduction;
use std::collections::BTreeSet;
use std::path::Path;
use tree::Tree;

/// Returns the meshes that can be found from a robot's file but not from the file `other`, which has the same text.
pub fn meshes_elsewhere(robot: &Source, other: &Path) -> Vec<String> {
    let (Ok(here), Ok(xml)) = (robot.anchor(), roxmltree::Document::parse(robot.text())) else { return Vec::new() };
    let named =
        xml.descendants().filter(|node| node.has_tag_name("mesh")).filter_map(|node| node.attribute("filename"));
    let place = |name: &str, urdf: &Path| mesh::find(name, urdf).ok().and_then(|path| path.canonicalize().ok());
    let is_lost = |name: &&str| place(name, here).is_some_and(|path| place(name, other) != Some(path));
    let names: BTreeSet<&str> = named.filter(is_lost).collect();
    names.into_iter().map(str::to_owned).collect()
}

/// Reads a URDF and reduces it to the arm that the settings choose.
///
/// # Errors
/// Files that are damaged or not URDF, robots without a planar two-joint arm, missing limits, and meshes that cannot be read.
pub fn load(source: Source, settings: RobotSettings) -> Result<(Arm, RobotReport), InputError> {
    let document = Document::read(source)?;
    InputError::check(document.diagnostics.clone())?;
    let tree = Tree::build(&document)?;
    let chain = chain::choose(&document, &tree, settings)?;
    let reduction = Reduction::new(&document, &tree, settings, &chain);
    masses::check(settings)?;
    let plane = reduction.plane()?;
    let bounds = reduction.bounds()?;
    let outlines = reduction.outlines(&plane)?;
    let joints = reduction.robot_joints(&plane)?;
    let (arm, mut report, unknown) = reduction.arm(plane, bounds, outlines);
    report.warnings.extend(advice::warnings(&reduction, &arm));
    unknown.filter(|_| settings.table.dynamics).map_or(Ok(()), Err)?;
    Ok((arm, RobotReport { joints, files: document.files(), ..report }))
}
