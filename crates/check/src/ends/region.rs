//! All configurations in which motions may begin or end.

use super::End;
use crate::arm::{Arm, Motion};
use crate::decimal::Decimal;
use crate::domain::{Range, Rectangle};
use crate::error::{CheckError, Input};
use crate::interval::{Interval, Point};
use crate::polygon::Corner;
use crate::world::Goal;

/// Maximum number of rectangles that cover the configurations for a tip position, in a proof that there is no motion.
pub const MAX_ENCLOSED_PARTS: usize = 2000;

/// Maximum number of rectangles that cover the configurations for a tip position, in a proof that no motion is shorter.
/// Such a proof needs only a rough cover.
pub const MAX_LOCATED_PARTS: usize = 500;

impl End {
    /// Returns an enclosure of the start or goal, if it is a configuration.
    ///
    /// # Errors
    /// If it is a tip position, or if values are outside the limits.
    pub fn configuration(&self, arm: &Arm) -> Result<Rectangle, CheckError> {
        match &self.at {
            Goal::Joints(values) => arm.configuration(self.what, values),
            Goal::Tip(..) | Goal::Areas(_) => {
                let message = format!(
                    "the {} is a position of the tip, but the checker judges such proofs only for joint values",
                    self.what
                );
                Err(CheckError::in_file(Input::World, message))
            }
        }
    }

    /// Returns rectangles that cover all configurations at which a motion may begin or end. Configurations that
    /// `is_left_out` excludes need not be covered. There are at most `most` rectangles for each tip position.
    ///
    /// # Errors
    /// If values are outside the limits.
    pub fn places(
        &self,
        arm: &Arm,
        most: usize,
        is_left_out: impl Fn(&Rectangle) -> bool,
    ) -> Result<Vec<Rectangle>, CheckError> {
        let tips: Vec<Point> = match &self.at {
            Goal::Joints(values) => {
                let place = arm.configuration(self.what, values)?;
                return Ok(if is_left_out(&place) { Vec::new() } else { vec![place] });
            }
            Goal::Tip(at, elbow) => {
                elbow.map_or(Ok(()), |elbow| elbow.of_arm(arm))?;
                let excludes = |part: &Rectangle| elbow.is_some_and(|elbow| elbow.excludes(arm, &part[1]));
                let tip = at.each_ref().map(Interval::from);
                return Ok(arm.places(&tip, most, |part| is_left_out(part) || excludes(part)));
            }
            Goal::Areas(areas) => areas.iter().map(|area| arm.area(area)).collect(),
        };
        Ok(tips.iter().flat_map(|tip| arm.places(tip, most, &is_left_out)).collect())
    }
}

impl Arm {
    /// Returns the tip positions that a goal rectangle stands for, given its opposite corners. If both joints are
    /// prismatic, these are all positions in it. Otherwise it is the centre.
    pub fn area(&self, [a, b]: &[Corner; 2]) -> Point {
        if self.joints.iter().any(|joint| !matches!(joint.motion, Motion::Slide(_))) {
            return [0, 1].map(|k| Interval::from(&Decimal::middle(&a[k], &b[k])));
        }
        [0, 1].map(|k| {
            let range = if a[k] <= b[k] { [a[k].clone(), b[k].clone()] } else { [b[k].clone(), a[k].clone()] };
            Interval::enclosing(&range)
        })
    }

    /// Returns an enclosure of a configuration, shifted by whole turns into the domain.
    ///
    /// # Errors
    /// If the configuration is outside the limits.
    pub fn configuration(&self, what: &str, values: &[Range; 2]) -> Result<Rectangle, CheckError> {
        let wrapped = |k: usize| {
            let name = &self.joints[k].name;
            let outside = || format!("the {what}'s joint \"{name}\" is outside its limits, or at half a turn");
            let within = self.domain.wrapped(k, &values[k]);
            within.ok_or_else(|| CheckError::in_file(Input::World, outside()))
        };
        Ok([wrapped(0)?, wrapped(1)?])
    }
}
