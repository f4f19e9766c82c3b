//! Start and goal: within the limits, free, and for a goal of the tip every posture that reaches it.

use super::error::{Defect, InputError};
use super::world::WorldGoal;
use super::{Loaded, LoadedScene, Overrides, clearance as checked_clearance};
use crate::geometry::Point;
use crate::model::{Goal, Problem, Scene, inverse, within};
use crate::space::{Axis, Configuration};
use std::ops::Range;

/// Where a value was given: on the command line, or in the world file.
enum Place<'a> {
    Option(&'static str),
    World(&'a LoadedScene, Range<usize>),
}

impl Place<'_> {
    fn defect(&self, message: String) -> Defect {
        match self {
            Place::Option(name) => Defect::new(*name, message),
            Place::World(loaded, at) => loaded.world.source.defect_at(at.clone(), message),
        }
    }
}

impl LoadedScene {
    /// Puts start and goal into the scene: the command line's, else the world file's.
    ///
    /// # Errors
    /// When either is missing, outside the joint limits, in contact with an obstacle or nearer to one than the
    /// clearance, or when no posture puts the tip at the goal. The message says which link hits which obstacle and how
    /// deep.
    pub fn problem(mut self, overrides: &Overrides) -> Result<Loaded, InputError> {
        if let Some(clearance) = overrides.clearance {
            self.scene.workspace.clearance = checked_clearance(clearance)?;
        }
        let (start, place) = self.start(overrides)?;
        self.require("the start", start, &place)?;
        let (goal, place) = self.goal(overrides)?;
        let mut notes = Vec::new();
        let goals = match goal {
            Goal::Joints(q) => {
                self.require("the goal", q, &place)?;
                vec![q]
            }
            Goal::Tip(tip) => self.postures(tip, start, &place, &mut notes)?,
        };
        Ok(Loaded { problem: Problem { scene: self.scene, start, goal, goals }, robot: self.robot, notes })
    }

    fn start(&self, overrides: &Overrides) -> Result<(Configuration, Place<'_>), InputError> {
        if let Some(values) = &overrides.start {
            return Ok((values.resolve(&self.scene.arm.joints, "--start")?, Place::Option("--start")));
        }
        match &self.world.start {
            Some((values, at)) => Ok((Configuration::from(*values), Place::World(self, at.clone()))),
            None => Err(self.missing("start", "[start] joints = [q1, q2] in the world file, or --start q1,q2").into()),
        }
    }

    fn goal(&self, overrides: &Overrides) -> Result<(Goal, Place<'_>), InputError> {
        match (&overrides.goal, &overrides.goal_tip) {
            (Some(_), Some(_)) => {
                let defect = Defect::new("--goal and --goal-tip", "both give a goal");
                return Err(defect.cure("give one of them").into());
            }
            (Some(values), None) => {
                let q = values.resolve(&self.scene.arm.joints, "--goal")?;
                return Ok((Goal::Joints(q), Place::Option("--goal")));
            }
            (None, Some(tip)) => return Ok((Goal::Tip(tip.0), Place::Option("--goal-tip"))),
            (None, None) => {}
        }
        match &self.world.goal {
            Some((WorldGoal::Joints(values), at)) => {
                Ok((Goal::Joints(Configuration::from(*values)), Place::World(self, at.clone())))
            }
            Some((WorldGoal::Tip(tip), at)) => Ok((Goal::Tip(*tip), Place::World(self, at.clone()))),
            None => {
                let cure =
                    "[goal] joints = [q1, q2] or tip = [x, y] in the world file, or --goal q1,q2, or --goal-tip x,y";
                Err(self.missing("goal", cure).into())
            }
        }
    }

    fn missing(&self, what: &str, cure: &str) -> Defect {
        self.world.source.defect(format!("there is no {what}")).cure(cure)
    }

    fn require(&self, what: &str, q: Configuration, place: &Place) -> Result<(), Defect> {
        let outside = beyond_limits(&self.scene, q);
        if !outside.is_empty() {
            let message = format!("{what} is outside the joint limits: {}", outside.join("; "));
            return Err(place
                .defect(message)
                .cure("choose values within, or override [robot] limits in the world file"));
        }
        let hits = obstructions(&self.scene, q);
        if !hits.is_empty() {
            let message = format!("{what} ({}) is not free: {}", describe(&self.scene, q), hits.join("; "));
            return Err(place.defect(message).cure(cure_for_contact(&self.scene)));
        }
        Ok(())
    }

    /// Every posture that puts the tip at `tip`, within the limits and free.
    fn postures(
        &self,
        tip: Point,
        start: Configuration,
        place: &Place,
        notes: &mut Vec<String>,
    ) -> Result<Vec<Configuration>, Defect> {
        let scene = &self.scene;
        let arm = &scene.arm;
        let solved = inverse(arm, tip, start);
        let at = format!("({}, {})", tip.x, tip.y);
        if solved.branches.is_empty() {
            let message = format!(
                "the goal {at} m is out of reach of the tip \"{}\", whatever the joint limits: it is {:.4} m from joint \"{}\"{}",
                arm.tip_name,
                (tip - arm.base).norm(),
                arm.joints[0].name,
                reach(scene)
            );
            return Err(place
                .defect(message)
                .cure("choose a point nearer by; coordinates are metres in the arm's plane"));
        }
        if let Some(joint) = solved.free {
            let name = &arm.joints[joint].name;
            notes.push(format!(
                "the tip reaches {at} whatever the value of joint \"{name}\"; the goal takes it as at the start, {}",
                start[joint]
            ));
        }
        let mut goals = Vec::new();
        let mut blocked = Vec::new();
        for branch in &solved.branches {
            let copies = [0, 1].map(|i| within(arm.joints[i].axis, arm.joints[i].motion.is_revolute(), branch[i]));
            if copies.iter().any(Vec::is_empty) {
                let nearest = Configuration::from_fn(|i, _| copies[i].first().copied().unwrap_or(branch[i]));
                blocked.push(format!("({}): {}", describe(scene, nearest), beyond_limits(scene, nearest).join("; ")));
                continue;
            }
            for first in &copies[0] {
                for second in &copies[1] {
                    let q = Configuration::new(*first, *second);
                    let hits = obstructions(scene, q);
                    if hits.is_empty() {
                        goals.push(q);
                    } else {
                        blocked.push(format!("({}): {}", describe(scene, q), hits.join("; ")));
                    }
                }
            }
        }
        if goals.is_empty() {
            let message = format!("no posture that puts the tip at {at} is allowed and free: {}", blocked.join("; "));
            return Err(place.defect(message).cure(cure_for_contact(scene)));
        }
        notes.extend(blocked.into_iter().map(|b| format!("a posture with the tip at {at} is ruled out: {b}")));
        Ok(goals)
    }
}

/// The joint values in words: `shoulder -0.9 rad, elbow 0.4 rad`.
fn describe(scene: &Scene, q: Configuration) -> String {
    let value = |i: usize| format!("{} {} {}", scene.arm.joints[i].name, rounded(q[i]), scene.arm.joints[i].unit());
    format!("{}, {}", value(0), value(1))
}

/// Six decimals are plenty for people.
fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6 + 0.0
}

fn beyond_limits(scene: &Scene, q: Configuration) -> Vec<String> {
    let mut outside = Vec::new();
    for (joint, value) in scene.arm.joints.iter().zip(q.iter()) {
        if let Axis::Interval { lower, upper } = joint.axis
            && !joint.axis.contains(*value)
        {
            let unit = joint.unit();
            // Unrounded when rounding would hide the excess.
            let shown = if joint.axis.contains(rounded(*value)) { *value } else { rounded(*value) };
            outside.push(format!(
                "joint \"{}\" at {shown} {unit} exceeds its limits [{lower}, {upper}] {unit}",
                joint.name
            ));
        }
    }
    outside
}

/// Why `q` is not free, in words, the worst pair of shapes for each link and obstacle.
fn obstructions(scene: &Scene, q: Configuration) -> Vec<String> {
    scene.obstructions(q).iter().map(|obstruction| scene.explain(obstruction)).collect()
}

fn cure_for_contact(scene: &Scene) -> &'static str {
    if scene.workspace.clearance > 0.0 {
        "move it away from the obstacle, or ask for less clearance"
    } else {
        "move it away from the obstacle (touching counts as contact)"
    }
}

/// What an arm with two revolute joints reaches, for messages.
fn reach(scene: &Scene) -> String {
    let arm = &scene.arm;
    if arm.kind() != "RR" {
        return String::new();
    }
    let (upper, lower) = (arm.offset.norm(), arm.tip.coords.norm());
    format!(", the tip reaches from {:.4} to {:.4} m", (upper - lower).abs(), upper + lower)
}
