//! The arm as pages get it: all data that place it in any configuration.

use super::numbers::{RoundingSteps, with_shape};
use crate::{Object, chart, object};
use cplan_geometry::{Convex, cross};
use cplan_model::space::Configuration;
use cplan_model::{Arm, JointType, Part, Plane, Scene};
use nalgebra::Vector3;
use serde::{Serialize, Serializer};

/// Returns a scene's arm without its payload.
pub fn empty_handed(scene: &Scene, grain: RoundingSteps) -> Arm {
    let mut arm = scene.arm().clone();
    for (k, link) in arm.links.iter_mut().enumerate() {
        let part = |part: &Part| Part { shape: grain.shape(&part.shape).0, ..part.clone() };
        link.parts = scene.own_parts(k).iter().map(part).collect();
    }
    arm
}

/// Serialises an arm for pages. `sign` of a revolute joint is +1 or -1; `direction` is that of a prismatic joint. `torque` is the
/// effort limit, if motions respect it. Numbers are not rounded, because pages multiply and add them.
pub fn document<S: Serializer>(arm: &Arm, serializer: S) -> Result<S::Ok, S::Error> {
    let part = |part: &Part| with_shape(object!("body": part.body), &part.shape);
    let link = |k: usize| {
        let link = &arm.links[k];
        object!("name": link.name, "parts": link.parts.iter().map(part).collect::<Vec<_>>())
    };
    let joint = |k: usize| {
        let joint = &arm.joints[k];
        let (sign, direction) = match joint.joint_type {
            JointType::Revolute { sign } => (Some(sign), None),
            JointType::Prismatic { direction } => (None, Some(direction)),
        };
        object!(
            "name": joint.name,
            "unit": joint.unit(),
            "sign": sign,
            "direction": direction,
            "domain": joint.range.domain(),
            "circle": joint.range.is_circle(),
            "velocity": joint.velocity,
            "acceleration": joint.acceleration,
            "torque": arm.dynamics.filter(|dynamics| dynamics.limits).map(|dynamics| dynamics.effort[k]),
        )
    };
    let document = object!(
        "name": arm.name,
        "kind": arm.kind(),
        "joints": [joint(0), joint(1)],
        "one_scale": chart::one_scale(arm).is_some(),
        "links": [link(0), link(1)],
        "base": arm.base,
        "offset": arm.offset,
        "tip": arm.tip,
        // The region that the tip cannot leave.
        "reach": with_shape(Object::default(), &reach_shape(arm)),
        "plane": titles(&arm.plane),
    );
    document.serialize(serializer)
}

/// Returns the names of the plane's coordinates: those of the root frame's axes, if they are parallel to them.
pub fn titles(plane: &Plane) -> [String; 2] {
    const NEARLY_PARALLEL_COSINE: f64 = 0.9999;
    let name = |v: Vector3<f64>, other: &str| {
        let axis = ["x", "y", "z"].into_iter().zip(v.iter()).find(|(_, part)| **part > NEARLY_PARALLEL_COSINE);
        format!("{} (m)", axis.map_or(other, |(name, _)| name))
    };
    [name(plane.u, "u"), name(plane.v, "v")]
}

/// Returns a region that the tip can never leave. If joint 1 is revolute, it is a disc about the base with the tip's greatest
/// distance as its radius. Otherwise, it contains the places that prismatic joints reach, grown by the reach of link 2 if joint 2
/// is revolute.
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
