//! Errors of the robot and the world that must not make a motion collide, and clearances of single obstacles.

use super::{ReadResult, Reader, Value, length_with_unit};
use cplan_check::arm::{Arm, Joint, Motion};
use cplan_check::decimal::Decimal;
use cplan_check::interval::{Interval, Point, length, minus};
use cplan_check::obstacle::Obstacle;
use cplan_check::world::World;
use cplan_check::{CheckError, Input};
use num_bigint::BigInt;

/// Greatest errors, as the file or the certificate states them.
#[derive(Default)]
pub struct Calibration {
    /// Displacement of the base, and its rotation about joint 1.
    base: Option<[Decimal; 2]>,
    /// Change of each link's length.
    links: Option<[Decimal; 2]>,
    /// Offsets of the zeros of prismatic joints, and of revolute joints.
    zeros: Option<[Decimal; 2]>,
    /// Displacement of obstacles.
    obstacles: Option<[Decimal; 2]>,
}

/// Reads the errors of a length and of an angle: `0.5 mm, 0.05deg`. The angle is rounded up.
fn errors(text: &str) -> Result<[Decimal; 2], String> {
    let mut errors = [Decimal::whole(0), Decimal::whole(0)];
    for item in text.split(',').map(str::trim) {
        if let Some(number) = item.strip_suffix("rad") {
            errors[1] = Decimal::read(number.trim_end())?;
        } else if let Some(number) = item.strip_suffix("deg") {
            let [_, most] = (&Interval::from(&Decimal::read(number.trim_end())?) * &Interval::pi().over(180)).ends();
            errors[1] = most;
        } else {
            errors[0] = length_with_unit(item)
                .ok_or_else(|| format!("\"{item}\" is not a length with a unit, such as 0.5 mm"))?;
        }
    }
    match errors.iter().any(|error| *error < Decimal::whole(0)) {
        true => Err("an error is negative".into()),
        false => Ok(errors),
    }
}

impl Reader<'_> {
    fn errors(&self, value: &Value) -> ReadResult<[Decimal; 2]> {
        match value.get_ref().as_str() {
            Some(text) => errors(text).or_else(|why| self.error(value, &why)),
            None => Ok([self.number(value)?, Decimal::whole(0)]),
        }
    }

    pub(super) fn length_error(&self, value: &Value) -> ReadResult<Decimal> {
        self.errors(value).map(|[length, _]| length)
    }

    /// Reads `[robot] calibration`.
    pub(super) fn calibration(&self, value: &Value) -> ReadResult<Calibration> {
        let mut calibration = Calibration::default();
        for (key, value) in self.table(value)? {
            let Some(stated) = calibration.stated(key.get_ref()) else {
                return self
                    .error(value, &format!("the checker does not know the key {} of a calibration", key.get_ref()));
            };
            *stated = Some(self.errors(value)?);
        }
        Ok(calibration)
    }
}

impl Calibration {
    fn stated(&mut self, key: &str) -> Option<&mut Option<[Decimal; 2]>> {
        match key {
            "base" => Some(&mut self.base),
            "links" => Some(&mut self.links),
            "zeros" => Some(&mut self.zeros),
            "obstacles" => Some(&mut self.obstacles),
            _ => None,
        }
    }

    /// Replaces errors by those that a certificate states: `base=0.0005m,0.001rad; links=0.0002m`.
    ///
    /// # Errors
    /// A text of another form.
    pub fn replace(&mut self, text: &str, world: &mut World) -> Result<(), CheckError> {
        let wrong = |why: String| CheckError::in_file(Input::Certificate, format!("calibration: {why}"));
        for item in text.split(';').map(str::trim) {
            let (key, value) = item.split_once('=').ok_or_else(|| wrong(format!("\"{item}\" has no key")))?;
            let stated = self.stated(key).ok_or_else(|| wrong(format!("\"{key}\" is unknown")))?;
            *stated = Some(errors(value).map_err(wrong)?);
            if key == "obstacles" {
                world.obstacles.iter_mut().chain(&mut world.movers).for_each(|obstacle| obstacle.stated[1] = None);
            }
        }
        Ok(())
    }

    /// Grows the arm and the obstacles by the errors, and by clearances of single obstacles beyond the required one.
    /// Returns true if there are errors.
    ///
    /// # Errors
    /// An obstacle that could not be read.
    pub fn grow(&self, arm: &mut Arm, world: &mut World, clearance: &Decimal) -> Result<bool, CheckError> {
        let zero = || [Decimal::whole(0), Decimal::whole(0)];
        let of = |stated: &Option<[Decimal; 2]>| stated.clone().unwrap_or_else(zero).each_ref().map(Interval::from);
        let ([shift, turn], [links, _], zeros) = (of(&self.base), of(&self.links), of(&self.zeros));
        let [displacement, _] = of(&self.obstacles);
        let lengths = Lengths::of(arm);
        let displacements = lengths.displacements(&links, &zeros, &arm.joints);
        let robot_errs = [&shift, &turn, &links, &zeros[0], &zeros[1]].iter().any(|error| !error.is_whole(0));
        let most = &(&lengths.reach + &displacements[1]) + &shift;
        let base = arm.base.clone();
        let mut has_errors = robot_errs;
        for obstacle in world.obstacles.iter_mut().chain(&mut world.movers) {
            let [own, displaced] = obstacle.stated.each_ref().map(|stated| stated.as_ref().map(Interval::from));
            let displaced = displaced.unwrap_or_else(|| displacement.clone());
            has_errors |= !displaced.is_whole(0);
            let (least, none) = (Interval::from(clearance), Interval::whole(0));
            let own = own.filter(|own| own.lower > least.upper).unwrap_or_else(|| least.clone());
            let beyond = if own == least { none } else { &own - &least };
            let required = &(&beyond + &shift) + &displaced;
            let lever = match turn.is_whole(0) {
                true => Interval::whole(0),
                false => {
                    farthest(obstacle, &base)?.filter(|far| far.upper < (&most + &own).upper).unwrap_or(&most + &own)
                }
            };
            obstacle.grown = [required.clone(), &required + &(&turn * &lever)];
        }
        for shape in arm.shapes.iter_mut() {
            shape.around.shape = shape.around.shape.clone().grown(&displacements[shape.around.link]);
        }
        arm.own.iter_mut().filter(|own| own.is_carried()).for_each(|own| own.grown[1] = links.clone());
        if has_errors {
            arm.notes += "; this holds for all robots and worlds within the stated errors";
        }
        Ok(has_errors)
    }
}

/// Upper bounds on lengths of an arm.
struct Lengths {
    /// Greatest distances of the points of both links from their joints.
    links: [Interval; 2],
    /// Greatest distance between joints 1 and 2.
    between: Interval,
    /// Greatest distance of any point from the position of joint 1 at zero.
    reach: Interval,
}

impl Lengths {
    fn of(arm: &Arm) -> Self {
        let link = |number: usize| {
            let own = arm.shapes.iter().map(|shape| &shape.around).filter(|around| around.link == number);
            let points = own.flat_map(|around| around.shape.points.iter().map(|p| &length(p) + &around.shape.radius));
            Interval::exact(points.map(|far| far.upper).max().unwrap_or_default())
        };
        let slide = |joint: &Joint| match (&joint.motion, &joint.within) {
            (Motion::Slide(_), Some(ends)) => {
                let ends = ends.each_ref().map(|end| Interval::from(end).magnitude());
                Interval::exact(ends.into_iter().max().unwrap_or_default() + 1)
            }
            _ => Interval::whole(0),
        };
        let links = [link(0), link(1)];
        let between = &length(&arm.offset) + &slide(&arm.joints[1]);
        let second = &between + &links[1];
        let far = if second.upper > links[0].upper { &second } else { &links[0] };
        let reach = far + &slide(&arm.joints[0]);
        Self { links, between, reach }
    }

    /// Returns bounds on the displacements of points of both links, relative to the base, by errors of lengths and
    /// zeros. `docs/certificate_checks.md` derives these bounds.
    fn displacements(&self, error: &Interval, [slides, turns]: &[Interval; 2], joints: &[Joint; 2]) -> [Interval; 2] {
        let zero = |joint: &Joint, lever: &Interval| match joint.motion {
            Motion::Turn(_) => turns * lever,
            Motion::Slide(_) => slides.clone(),
        };
        let twice = error + error;
        let first = error + &zero(&joints[0], &(&self.links[0] + error));
        let from_base = &(&self.between + &self.links[1]) + &twice;
        let second = &twice + &zero(&joints[0], &from_base);
        [first, &second + &zero(&joints[1], &(&self.links[1] + error))]
    }
}

/// Returns the greatest distance of a point of an obstacle from a place. `None` for a moving obstacle.
fn farthest(obstacle: &Obstacle, from: &Point) -> Result<Option<Interval>, CheckError> {
    if obstacle.trajectory.is_some() {
        return Ok(None);
    }
    let sides = obstacle.sides()?;
    let far = |p: &Point, radius: &Interval| (&length(&minus(p, from)) + radius).upper;
    let all = sides.iter().flat_map(|side| side.points.iter().map(|p| far(p, &side.radius)));
    Ok(Some(Interval::exact(all.max().unwrap_or(BigInt::ZERO))))
}
