//! The arm: enough of it to put it into any configuration.

use super::super::workspace;
use super::round::Grain;
use crate::geometry::Convex;
use crate::model::{Joint, JointType, Scene};
use serde::Serialize;

/// A rounded convex polygon.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ShapeView {
    /// Corners of the core, one coordinate after the other.
    core: Vec<f64>,
    radius: f64,
}

impl ShapeView {
    pub fn new(shape: &Convex, grain: Grain) -> Self {
        Self { core: grain.points(shape.core()), radius: grain.length(shape.radius()) }
    }
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct JointView {
    name: String,
    /// `rad` or `m`.
    unit: &'static str,
    /// +1 or -1 of one that turns.
    #[serde(skip_serializing_if = "Option::is_none")]
    sign: Option<f64>,
    /// Direction of one that slides.
    #[serde(skip_serializing_if = "Option::is_none")]
    direction: Option<[f64; 2]>,
    /// Least and greatest value shown.
    domain: [f64; 2],
    /// Whether the ends of the domain are one.
    circle: bool,
    velocity: f64,
    acceleration: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct LinkView {
    name: String,
    parts: Vec<PartView>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct PartView {
    body: String,
    #[serde(flatten)]
    shape: ShapeView,
}

/// The arm, empty-handed: see [`crate::model::Arm`] for the kinematics.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ArmView {
    name: String,
    kind: &'static str,
    joints: [JointView; 2],
    links: [LinkView; 2],
    base: [f64; 2],
    offset: [f64; 2],
    tip: [f64; 2],
    /// Names of the plane's coordinates.
    plane: [String; 2],
}

impl ArmView {
    pub fn new(scene: &Scene, grain: Grain) -> Self {
        let arm = scene.arm();
        let link = |k: usize| {
            let part = |part: &crate::model::Part| PartView {
                body: part.body.clone(),
                shape: ShapeView::new(&part.shape, grain),
            };
            LinkView { name: arm.links[k].name.clone(), parts: scene.own_parts(k).iter().map(part).collect() }
        };
        Self {
            name: arm.name.clone(),
            kind: arm.kind(),
            joints: arm.joints.each_ref().map(joint),
            links: [link(0), link(1)],
            base: [arm.base.x, arm.base.y],
            offset: [arm.offset.x, arm.offset.y],
            tip: [arm.tip.x, arm.tip.y],
            plane: workspace::titles(&arm.plane),
        }
    }
}

/// Unrounded: what comes of these numbers is multiplied and added up.
fn joint(joint: &Joint) -> JointView {
    let (sign, direction) = match joint.joint_type {
        JointType::Revolute { sign } => (Some(sign), None),
        JointType::Prismatic { direction } => (None, Some([direction.x, direction.y])),
    };
    JointView {
        name: joint.name.clone(),
        unit: joint.unit(),
        sign,
        direction,
        domain: joint.range.domain().into(),
        circle: joint.range.is_circle(),
        velocity: joint.velocity,
        acceleration: joint.acceleration,
    }
}
