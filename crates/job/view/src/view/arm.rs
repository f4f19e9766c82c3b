//! The arm in the document: all data needed to place it in any configuration.

use super::numbers::{RoundingSteps, ShapeView};
use crate::chart;
use cplan_geometry::{Convex, cross};
use cplan_model::space::Configuration;
use cplan_model::{Arm, JointType, Part, Plane, Scene};
use nalgebra::Vector3;
use serde::{Serialize, Serializer};

#[derive(Serialize)]
struct JointView<'a> {
    name: &'a str,
    /// Unit: `rad` or `m`.
    unit: &'static str,
    /// Sign of a revolute joint: +1 or -1. `None` for a prismatic joint.
    #[serde(skip_serializing_if = "Option::is_none")]
    sign: Option<f64>,
    /// Direction of a prismatic joint. `None` for a revolute joint.
    #[serde(skip_serializing_if = "Option::is_none")]
    direction: Option<[f64; 2]>,
    /// Least and greatest value on the axis.
    domain: [f64; 2],
    /// True if the joint is a circle, so that both ends of the domain are the same position.
    circle: bool,
    velocity: f64,
    acceleration: f64,
    /// Effort limit. `None` if motions need not respect it.
    #[serde(skip_serializing_if = "Option::is_none")]
    torque: Option<f64>,
}

#[derive(Serialize)]
struct LinkView<'a> {
    name: &'a str,
    parts: Vec<PartView<'a>>,
}

#[derive(Serialize)]
struct PartView<'a> {
    body: &'a str,
    #[serde(flatten)]
    shape: ShapeView,
}

/// The arm as pages read it; see [`Arm`] for the kinematics.
#[derive(Serialize)]
struct ArmView<'a> {
    name: &'a str,
    kind: &'static str,
    joints: [JointView<'a>; 2],
    /// True if both axes of the configuration space have the same scale.
    one_scale: bool,
    links: [LinkView<'a>; 2],
    base: [f64; 2],
    offset: [f64; 2],
    tip: [f64; 2],
    /// Region that the tip can never leave.
    reach: ShapeView,
    /// Names of the plane's coordinates.
    plane: [String; 2],
}

/// Returns a scene's arm without its payload.
pub fn empty_handed(scene: &Scene, grain: RoundingSteps) -> Arm {
    let mut arm = scene.arm().clone();
    for (k, link) in arm.links.iter_mut().enumerate() {
        let part = |part: &Part| Part { shape: grain.shape(&part.shape).0, ..part.clone() };
        link.parts = scene.own_parts(k).iter().map(part).collect();
    }
    arm
}

/// Serialises an arm for pages.
pub fn document<'a, S: Serializer>(arm: &'a Arm, serializer: S) -> Result<S::Ok, S::Error> {
    let link = |k: usize| {
        let part = |part: &'a Part| PartView { body: &part.body, shape: ShapeView(part.shape.clone()) };
        LinkView { name: &arm.links[k].name, parts: arm.links[k].parts.iter().map(part).collect() }
    };
    let document = ArmView {
        name: &arm.name,
        kind: arm.kind(),
        joints: [0, 1].map(|k| joint(arm, k)),
        one_scale: chart::one_scale(arm).is_some(),
        links: [link(0), link(1)],
        base: [arm.base.x, arm.base.y],
        offset: [arm.offset.x, arm.offset.y],
        tip: [arm.tip.x, arm.tip.y],
        reach: ShapeView(reach_shape(arm)),
        plane: titles(&arm.plane),
    };
    document.serialize(serializer)
}

/// Returns a joint for pages. Its numbers are not rounded, because pages multiply and add them.
fn joint(arm: &Arm, k: usize) -> JointView<'_> {
    let joint = &arm.joints[k];
    let (sign, direction) = match joint.joint_type {
        JointType::Revolute { sign } => (Some(sign), None),
        JointType::Prismatic { direction } => (None, Some([direction.x, direction.y])),
    };
    JointView {
        name: &joint.name,
        unit: joint.unit(),
        sign,
        direction,
        domain: joint.range.domain().into(),
        circle: joint.range.is_circle(),
        velocity: joint.velocity,
        acceleration: joint.acceleration,
        torque: arm.dynamics.filter(|dynamics| dynamics.limits).map(|dynamics| dynamics.effort[k]),
    }
}

/// Returns the names of the plane's coordinates: those of the root frame's axes if they are parallel to them.
pub fn titles(plane: &Plane) -> [String; 2] {
    const NEARLY_PARALLEL_COSINE: f64 = 0.9999;
    let name = |v: Vector3<f64>, other: &str| {
        let axis = ["x", "y", "z"].into_iter().zip(v.iter()).find(|(_, part)| **part > NEARLY_PARALLEL_COSINE);
        format!("{} (m)", axis.map_or(other, |(name, _)| name))
    };
    [name(plane.u, "u"), name(plane.v, "v")]
}

/// Returns a region that the tip can never leave. If joint 1 is revolute, it is the disc of the tip's greatest distance
/// from the base. Otherwise it is the set of places that the prismatic joints reach, grown by the reach of a revolute
/// second link.
pub fn reach_shape(arm: &Arm) -> Convex {
    let topology = arm.topology();
    let [first, second] = topology.ranges.map(|axis| axis.domain());
    if arm.joints[0].joint_type.is_revolute() {
        const REACH_STEPS: usize = 720;
        let at = |i: usize| second.0 + (second.1 - second.0) * i as f64 / REACH_STEPS as f64;
        let distance = |i: usize| (arm.tip_at(Configuration::new(first.0, at(i))) - arm.base).norm();
        return Convex::trusted(vec![arm.base], (0..=REACH_STEPS).map(distance).fold(0.0, f64::max));
    }
    match arm.joints[1].joint_type {
        JointType::Revolute { .. } => {
            Convex::trusted(vec![arm.elbow_at(first.0), arm.elbow_at(first.1)], arm.tip.norm())
        }
        JointType::Prismatic { .. } => {
            let tip = |q1, q2| arm.tip_at(Configuration::new(q1, q2));
            let mut corners =
                vec![tip(first.0, second.0), tip(first.1, second.0), tip(first.1, second.1), tip(first.0, second.1)];
            if cross(corners[1] - corners[0], corners[2] - corners[1]) < 0.0 {
                corners.reverse();
            }
            Convex::trusted(corners, 0.0)
        }
    }
}
