//! From a URDF to a planar two-joint arm.
//!
//! The joints' axes and all link frames are computed in the root frame at the zero configuration (the two joints at 0,
//! the others where `[robot] fixed` holds them), then projected on the common plane of motion.

mod attributes;
mod bodies;
mod chain;
mod document;
mod foreign;
mod limits;
mod mesh;
mod plane;
mod solid;
mod tree;

use super::RobotReport;
use super::error::InputError;
use super::world::World;
use crate::geometry::Point;
use crate::model::{Arm, Joint};
use document::Document;
use limits::Limits;
use nalgebra::Isometry3;
use plane::{SpatialAxis, project};
use std::path::Path;
use tree::Tree;

/// Reads a URDF and reduces it to the arm that the world's `[robot]` table chooses.
///
/// # Errors
/// Broken or foreign files, robots that are no planar two-joint arm, unset limits, meshes that cannot be read.
pub(super) fn load(path: &Path, world: &World) -> Result<(Arm, RobotReport), InputError> {
    let document = Document::read(path)?;
    let tree = Tree::build(&document)?;
    let chain = chain::choose(&document, &tree, world)?;
    let poses = tree.poses(&document.robot, &chain.values);

    let axes = chain.joints.map(|j| {
        let joint = &document.robot.joints[j];
        let direction = (poses[tree.child[j]] * tree::axis(joint)).into_inner();
        SpatialAxis { name: &joint.name, revolute: joint.joint_type != urdf_rs::JointType::Prismatic, direction }
    });
    let plane = plane::common_plane(axes).map_err(|message| {
        let place = &document.joints[chain.joints[1]];
        let at = place.axis.as_ref().unwrap_or(&place.at);
        document.defect_at(at, message).cure(
            "cplan plans for two joints that turn about parallel axes or slide in one plane: choose such a pair with \
             [robot] joints in the world file",
        )
    })?;

    let mut report = RobotReport { notes: vec![plane::describe(&plane, &tree.links[tree.root])], ..Default::default() };
    if tree.implicit_world {
        report.notes.push("link \"world\" is not declared in the URDF; taken as the root".into());
    }
    report.notes.push(format!("tip: origin of link \"{}\"", tree.links[chain.tip]));
    report.notes.extend(chain.notes.iter().cloned());
    report.held = chain.held.iter().map(|&j| (document.robot.joints[j].name.clone(), chain.values[j])).collect();

    let limits = Limits { document: &document, world };
    let mut defects = Vec::new();
    let mut joints = Vec::new();
    for (j, axis) in chain.joints.into_iter().zip(axes) {
        match (limits.planned_range(j), limits.rates(j)) {
            (Ok(range), Ok(rates)) => {
                report.notes.extend(rates.note);
                joints.push(Joint {
                    name: axis.name.to_owned(),
                    motion: plane::motion_in(&plane, axis),
                    axis: range,
                    velocity: rates.velocity,
                    acceleration: rates.acceleration,
                });
            }
            (range, rates) => defects.extend(range.err().into_iter().chain(rates.err())),
        }
    }
    InputError::check(defects)?;
    let Ok(joints) = <[Joint; 2]>::try_from(joints) else {
        return Err(document.source.defect("two joints are needed").into());
    };

    let bodies =
        bodies::Bodies { document: &document, tree: &tree, chain: &chain, world, plane: &plane, poses: &poses };
    let outlines = bodies.outlines()?;
    report.notes.extend(outlines.notes);
    report.warnings.extend(outlines.warnings);

    let at = |pose: &Isometry3<f64>| -> Point { project(&plane, &pose.translation.vector) };
    let [base, elbow] = chain.joints.map(|j| at(&poses[tree.child[j]]));
    let arm = Arm {
        name: document.robot.name.clone(),
        joints,
        links: outlines.links,
        base,
        offset: elbow - base,
        tip: Point::from(at(&poses[chain.tip]) - elbow),
        tip_name: tree.links[chain.tip].clone(),
        plane,
    };
    Ok((arm, report))
}
