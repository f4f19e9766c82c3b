//! The planar reduction from a chain of joints in space to an arm in the plane. Each of its stages can fail on its own.

use super::advice;
use super::bodies::{Bodies, Outlines};
use super::chain::Chain;
use super::document::Document;
use super::limits::{Limits, Range, Rates};
use super::pairing;
use super::plane::{self, SpatialAxis, project};
use super::self_collision::{Group, group, ignore_permanent_contact};
use super::tree::{self, Tree};
use crate::RobotReport;
use crate::error::{Diagnostic, InputError};
use crate::settings::RobotSettings;
use cplan_dynamics::keep_efforts;
use cplan_geometry::Point;
use cplan_model::space::JointRange;
use cplan_model::{Arm, Dynamics, Joint, Plane};
use nalgebra::Isometry3;

/// A chain and the poses of its links.
pub(super) struct Reduction<'a> {
    pub document: &'a Document,
    pub tree: &'a Tree,
    pub settings: RobotSettings<'a>,
    pub chain: &'a Chain,
    /// Poses of all links in the root frame, with the two arm joints at 0 and the others at their constant values.
    pub poses: Vec<Isometry3<f64>>,
}

/// Range, top speed, acceleration limit and jerk limit of one of the two joints.
pub(super) struct Bounds {
    pub range: JointRange,
    pub rates: Rates,
}

impl<'a> Reduction<'a> {
    pub fn new(document: &'a Document, tree: &'a Tree, settings: RobotSettings<'a>, chain: &'a Chain) -> Self {
        Self { document, tree, settings, chain, poses: tree.poses(&document.robot, &chain.values) }
    }

    /// Returns the two joints' axes in the root frame.
    pub fn axes(&self) -> [SpatialAxis<'a>; 2] {
        self.chain.joints.map(|j| {
            let joint = &self.document.robot.joints[j];
            let direction = (self.poses[self.tree.child[j]] * tree::axis(joint)).into_inner();
            SpatialAxis { name: &joint.name, revolute: joint.joint_type != urdf_rs::JointType::Prismatic, direction }
        })
    }

    /// Returns the plane of motion.
    pub fn plane(&self) -> Result<Plane, InputError> {
        self.common_plane().map_err(|message| {
            let place = &self.document.joints[self.chain.joints[1]];
            let at = place.axis.as_ref().unwrap_or(&place.at);
            let table = pairing::without_joints(self.settings.table);
            let settings = RobotSettings { table: &table, ..self.settings };
            let planar = pairing::planar(self.document, self.tree, settings);
            let choose = if planar.is_empty() {
                "this robot has no such pair".to_owned()
            } else {
                format!("in the world file: {}", pairing::choices(self.document, &planar))
            };
            let rule = "cplan plans for two joints that turn about parallel axes or slide in one plane";
            let axes = self.chain.joints.iter().filter_map(|&joint| advice::missing_axis(self, joint));
            let help: Vec<String> = axes.chain([format!("{rule}: {choose}")]).collect();
            self.document.diagnostic_at(at, message).help(help.join("; ")).into()
        })
    }

    /// Returns the plane of motion. In contrast to [`Reduction::plane`], the error is only the reason.
    pub fn common_plane(&self) -> Result<Plane, String> {
        plane::common_plane(self.axes())
    }

    /// Returns the limits of the two joints. The error reports all missing limits together.
    pub fn bounds(&self) -> Result<[Bounds; 2], InputError> {
        let limits = Limits { document: self.document, settings: self.settings };
        let mut diagnostics = Vec::new();
        let bounds = self.chain.joints.map(|j| match (limits.planned_range(j), limits.rates(j)) {
            (Ok(range), Ok(rates)) => Some(Bounds { range, rates }),
            (range, rates) => {
                diagnostics.extend(range.err().into_iter().chain(rates.err()));
                None
            }
        });
        let [Some(first), Some(second)] = bounds else { return Err(InputError::of(diagnostics)) };
        let mut bounds = [first, second];
        self.limit_by_motors(&mut bounds)?;
        Ok(bounds)
    }

    /// Returns true if a URDF link is fixed.
    pub fn is_fixed(&self, link: usize) -> bool {
        group(self.document, self.tree, self.chain, link) == Some(Group::Fixed)
    }

    /// Returns both links' outlines.
    pub fn outlines(&self, plane: &Plane) -> Result<Outlines, InputError> {
        let &Self { document, tree, settings, chain, ref poses } = self;
        Bodies { document, tree, chain, settings, plane, poses }.outlines()
    }

    /// Returns masses and efforts of an arm.
    ///
    /// # Errors
    /// The values that the file lacks.
    fn dynamics(&self, arm: &Arm, assumed: [bool; 2]) -> Result<Dynamics, Diagnostic> {
        let &Self { document, tree, settings, chain, ref poses } = self;
        let efforts = self.motor_efforts()?;
        Bodies { document, tree, chain, settings, plane: &arm.plane, poses }.dynamics(arm, assumed, efforts)
    }

    /// Assembles the arm. Also returns the reason if masses and efforts are unknown.
    pub fn arm(&self, plane: Plane, bounds: [Bounds; 2], outlines: Outlines) -> (Arm, RobotReport, Option<Diagnostic>) {
        let mut report = RobotReport {
            geometry: vec![plane::describe(&plane, &self.tree.links[self.tree.root])],
            ..Default::default()
        };
        if self.tree.implicit_world {
            report.notes.push("link \"world\" is not declared in the URDF; it counts as the root".into());
        }
        report.geometry.push(format!("tip: origin of link \"{}\"", self.tree.links[self.chain.tip]));
        report.notes.extend(plane::deviation(&plane, self.axes()));
        report.notes.extend(self.chain.notes.iter().cloned());
        let held = |&j: &usize| (self.document.robot.joints[j].name.clone(), self.chain.values[j]);
        report.held = self.chain.held.iter().map(held).collect();
        report.held_joints = self.held_joints(&plane);
        let limits = Limits { document: self.document, settings: self.settings };
        for (j, bounds) in self.chain.joints.into_iter().zip(&bounds) {
            if let Ok(Range::Taken(_, note)) = limits.range(j) {
                report.notes.push(note);
            }
            let name = &self.document.robot.joints[j].name;
            if bounds.rates.assumed.velocity {
                report.assumed.velocity.insert(name.clone(), bounds.rates.velocity);
            }
            // Acceleration limits are not needed if efforts limit the motion.
            if bounds.rates.assumed.acceleration && !self.settings.table.dynamics {
                report.assumed.acceleration.insert(name.clone(), bounds.rates.acceleration);
            }
        }
        let units = self.axes().map(|axis| (axis.name, if axis.revolute { "rad" } else { "m" }));
        report.notes.extend(report.assumed.notes(units));
        report.geometry.extend(outlines.geometry);
        report.notes.extend(outlines.notes);
        report.warnings.extend(outlines.warnings);

        let assumed = bounds.each_ref().map(|bounds| bounds.rates.assumed.acceleration);
        let [base, elbow] = self.chain.joints.map(|j| self.at(&plane, self.tree.child[j]));
        let [first, second] = self.axes();
        let [a, b] = bounds;
        let joint = |axis: SpatialAxis, bounds: Bounds| Joint {
            name: axis.name.to_owned(),
            joint_type: plane::joint_type_in(&plane, axis),
            range: bounds.range,
            velocity: bounds.rates.velocity,
            acceleration: bounds.rates.acceleration,
            jerk: bounds.rates.jerk,
        };
        let mut arm = Arm {
            name: self.document.robot.name.clone(),
            joints: [joint(first, a), joint(second, b)],
            links: outlines.links,
            base,
            offset: elbow - base,
            tip: self.at(&plane, self.chain.tip) - elbow,
            tip_name: self.tree.links[self.chain.tip].clone(),
            plane,
            dynamics: None,
            motors: self.motors().unwrap_or_default(),
            self_obstacles: outlines.self_obstacles,
        };
        report.geometry.extend(arm.motors.as_ref().map(|motors| self.describe_motors(motors)));
        report.notes.extend(ignore_permanent_contact(&mut arm));
        let unknown = match self.dynamics(&arm, assumed) {
            Ok(dynamics) => {
                arm.dynamics = Some(dynamics);
                None
            }
            Err(diagnostic) => Some(diagnostic),
        };
        if self.settings.table.dynamics {
            keep_efforts(&mut arm);
        }
        let described = |diagnostic: &Diagnostic| {
            let help = diagnostic.help.as_ref().map(|help| format!("; {help}"));
            diagnostic.message.clone() + &help.unwrap_or_default()
        };
        report.no_dynamics = unknown.as_ref().map(described);
        (arm, report, unknown)
    }

    /// Returns the origin of a link's frame in plane coordinates.
    pub fn at(&self, plane: &Plane, link: usize) -> Point {
        project(plane, &self.poses[link].translation.vector)
    }
}
