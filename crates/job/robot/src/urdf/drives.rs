//! Motors of the joints. Their limits become limits of joints, and of the sum of both joint values.

use super::limits::MissingRates;
use super::reduction::{Bounds, Reduction};
use crate::Spanned;
use crate::drives::{DrivesTable, DrivesValue, MotorTable};
use crate::error::{Diagnostic, InputError};
use crate::quantity::{Numbers, Written};
use cplan_model::space::JointRange;
use cplan_model::{Motors, assumed_acceleration};
use std::ops::Range;

const EXAMPLE: &str =
    "drives = { elbow = \"base\", motors = { velocity = [3.0, 4.0] } }, or drives = \"standard_scara\"";

/// Greatest absolute value of angles, gears and rates.
const LARGEST: f64 = 1e6;

/// The limits that one motor imposes on joint 1, joint 2, or their sum.
#[derive(Debug, Clone, Copy, Default)]
struct MotorLimits {
    range: Option<[f64; 2]>,
    velocity: Option<f64>,
    acceleration: Option<f64>,
    jerk: Option<f64>,
    /// Greatest torque of the motor, without its gear.
    effort: Option<f64>,
}

impl Reduction<'_> {
    /// Returns the motors that the world file describes.
    pub(super) fn motors(&self) -> Result<Option<Motors>, Diagnostic> {
        let Some(given) = &self.settings.table.drives else { return Ok(None) };
        let (motors, [first, elbow]) = self.read_drives(given)?;
        if motors.ratio == 0.0 {
            return Ok(Some(motors));
        }
        let MotorLimits { range, velocity, acceleration, jerk, .. } = elbow;
        Ok(Some(Motors { range, velocity, acceleration, jerk, effort: first.effort, ..motors }))
    }

    /// Returns the efforts of both joints according to the efforts of the motors.
    pub(super) fn motor_efforts(&self) -> Result<[Option<f64>; 2], Diagnostic> {
        let Some(given) = &self.settings.table.drives else { return Ok([None; 2]) };
        let (motors, limits) = self.read_drives(given)?;
        let [first, second] = limits.map(|limit| limit.effort);
        Ok([first.zip(second).map(|(first, second)| first + motors.ratio.abs() * second), second])
    }

    /// Applies the limits of motors to the joints. The sum of both joint values has the limits in [`Motors`].
    pub(super) fn limit_by_motors(&self, bounds: &mut [Bounds; 2]) -> Result<(), InputError> {
        let Some(given) = &self.settings.table.drives else { return Ok(()) };
        let (motors, [first, elbow]) = self.read_drives(given)?;
        let refuse = |message: String| -> InputError {
            self.diagnostic(given.span(), message).help("change the limits of the motors or of the joints").into()
        };
        let [one, two] = bounds;
        let names = self.chain.joints.map(|j| &self.document.robot.joints[j].name);
        let empty = |name: &str| refuse(format!("no value of joint \"{name}\" is within the limits of its motor"));
        one.limit(first).ok_or_else(|| empty(names[0]))?;
        if motors.ratio == 0.0 {
            return two.limit(elbow).ok_or_else(|| empty(names[1]));
        }
        let [low, high] = match (elbow.range, one.range) {
            (None, _) => [f64::NEG_INFINITY, f64::INFINITY],
            (Some([lower, upper]), JointRange::Interval { lower: low, upper: high }) => {
                let turned = [motors.ratio * low, motors.ratio * high];
                [lower - turned[0].max(turned[1]), upper - turned[0].min(turned[1])]
            }
            // Motors have both limits or none, so joint 1 has limits if the motors do.
            (Some(_), JointRange::Circle) => return Err(refuse("joint 1 needs limits".into())),
        };
        if elbow.range.is_some() {
            two.limit(MotorLimits { range: Some([low, high]), ..MotorLimits::default() })
                .ok_or_else(|| empty(names[1]))?;
        }
        // Limits of motors replace the defaults of joint 2.
        let together = |a: Option<f64>, b: f64| a.map(|limit| limit + motors.ratio.abs() * b);
        let assumed = two.rates.assumed;
        if let Some(velocity) = together(elbow.velocity, one.rates.velocity).filter(|_| assumed.velocity) {
            two.rates.velocity = velocity;
            two.rates.acceleration =
                if assumed.acceleration { assumed_acceleration(velocity) } else { two.rates.acceleration };
            two.rates.assumed.velocity = false;
        }
        if let Some(acceleration) =
            together(elbow.acceleration, one.rates.acceleration).filter(|_| assumed.acceleration)
        {
            two.rates.acceleration = acceleration;
            two.rates.assumed.acceleration = false;
        }
        Ok(())
    }

    /// Describes the motors for people.
    pub(super) fn describe_motors(&self, motors: &Motors) -> String {
        let [first, second] = self.chain.joints.map(|j| &self.document.robot.joints[j].name);
        match motors.ratio {
            0.0 => format!("drives: each motor turns its own joint, {first} and {second}"),
            1.0 => format!("drives: the elbow's motor is mounted on the base and turns {first} + {second}"),
            ratio => format!("drives: the elbow's motor is mounted on the base and turns {ratio} {first} + {second}"),
        }
    }

    fn diagnostic(&self, at: Range<usize>, message: impl AsRef<str>) -> Diagnostic {
        self.settings.source.diagnostic_at(at, format!("[robot] drives: {}", message.as_ref()))
    }

    /// Reads the motors without the limits of the sum, and the limits of what each motor turns.
    fn read_drives(&self, given: &Spanned<DrivesValue>) -> Result<(Motors, [MotorLimits; 2]), Diagnostic> {
        if let Some(axis) = self.axes().into_iter().find(|axis| !axis.revolute) {
            let message = format!("joint \"{}\" slides, but both joints must turn", axis.name);
            return Err(self
                .diagnostic(given.span(), message)
                .help("remove `drives`; limit the joints by velocity = { NAME = .. }"));
        }
        let table = match given.get_ref() {
            DrivesValue::Table(table) => table,
            DrivesValue::Preset(name) => match name.as_str() {
                "standard_scara" => return Ok((Motors::with_ratio(1.0), Default::default())),
                "direct" => return Ok((Motors::with_ratio(0.0), Default::default())),
                other => {
                    let message = format!("\"{other}\" is unknown");
                    return Err(self
                        .diagnostic(given.span(), message)
                        .help("\"standard_scara\", \"direct\", or a table"));
                }
            },
        };
        let mut read = Motors::with_ratio(self.ratio(table)?);
        if let Some(gear) = &table.gear {
            read.gear = self.pair(gear, "gear")?;
            if let Some(k) = read.gear.iter().position(|gear| gear.abs() < 1.0 / LARGEST) {
                let message = format!("the gear of motor {} must be from 1e-6 to 1e6 in magnitude", k + 1);
                return Err(self.diagnostic(gear.span(), message).help("gear = [5.0, -5.0]"));
            }
        }
        if let Some(zero) = &table.zero {
            read.zero = self.angles(zero, "zero")?;
        }
        let limits = table.motors.as_ref().map(|motors| self.motor_limits(motors, &read)).transpose()?;
        Ok((read, limits.unwrap_or_default()))
    }

    fn ratio(&self, table: &DrivesTable) -> Result<f64, Diagnostic> {
        let ratio = table.ratio.as_ref().map(|ratio| self.settings.source.finite(ratio, "[robot] drives, ratio"));
        let ratio = ratio.transpose()?;
        match table.elbow.as_ref().map(|elbow| (elbow, elbow.get_ref().as_str())) {
            None | Some((_, "base")) => Ok(ratio.unwrap_or(1.0)),
            Some((_, "link")) if ratio.is_none_or(|ratio| ratio == 0.0) => Ok(0.0),
            Some((elbow, "link")) => {
                let message = "elbow = \"link\" cannot have a ratio";
                Err(self.diagnostic(elbow.span(), message).help("remove `ratio`, or write elbow = \"base\""))
            }
            Some((elbow, other)) => {
                let message = format!("elbow is \"{other}\"");
                Err(self.diagnostic(elbow.span(), message).help("elbow = \"base\", or elbow = \"link\""))
            }
        }
    }

    fn motor_limits(&self, table: &MotorTable, motors: &Motors) -> Result<[MotorLimits; 2], Diagnostic> {
        let angles = |given: &Option<Spanned<Vec<Written>>>, name: &str| {
            given.as_ref().map(|angles| self.angles(angles, name)).transpose()
        };
        let (lower, upper) = (angles(&table.lower, "lower")?, angles(&table.upper, "upper")?);
        let range = match (lower, upper) {
            (None, None) => None,
            (Some(lower), Some(upper)) => Some([0, 1].map(|k| {
                let ends = [lower[k], upper[k]].map(|end| (end - motors.zero[k]) / motors.gear[k]);
                if motors.gear[k] > 0.0 { ends } else { [ends[1], ends[0]] }
            })),
            (Some(_), None) | (None, Some(_)) => {
                let at = table.lower.as_ref().or(table.upper.as_ref()).map_or(0..0, Spanned::span);
                return Err(self
                    .diagnostic(at, "motors need both lower and upper limits")
                    .help("motors = { lower = [\"-180deg\", \"-60deg\"], upper = [\"180deg\", \"60deg\"] }"));
            }
        };
        if let Some(k) = range.and_then(|range| range.iter().position(|[lower, upper]| lower >= upper)) {
            let at = table.lower.as_ref().map_or(0..0, Spanned::span);
            let message = format!("the lower limit of motor {} is not below the upper one", k + 1);
            return Err(self.diagnostic(at, message).help("write the lower number first"));
        }
        let positive = |given: &Option<Numbers>, name: &str| match given {
            None => Ok(None),
            Some(numbers) => match self.pair(numbers, name)? {
                limits if limits.iter().all(|limit| *limit > 0.0) => Ok(Some(limits)),
                _ => {
                    let message = format!("motors, {name}: both numbers must be above 0");
                    Err(self.diagnostic(numbers.span(), message).help("in radians, seconds and N m"))
                }
            },
        };
        let (velocity, acceleration) =
            (positive(&table.velocity, "velocity")?, positive(&table.acceleration, "acceleration")?);
        let (jerk, effort) = (positive(&table.jerk, "jerk")?, positive(&table.effort, "effort")?);
        Ok([0, 1].map(|k| {
            let gear = motors.gear[k].abs();
            let driven = |rates: Option<[f64; 2]>| rates.map(|rates| rates[k] / gear);
            MotorLimits {
                range: range.map(|range| range[k]),
                velocity: driven(velocity),
                acceleration: driven(acceleration),
                jerk: driven(jerk),
                // A gear that reduces speed multiplies torque.
                effort: effort.map(|effort| effort[k] * gear),
            }
        }))
    }

    fn pair(&self, numbers: &Numbers, name: &str) -> Result<[f64; 2], Diagnostic> {
        let what = format!("[robot] drives, {name}");
        let values = numbers.get_ref().iter().map(|number| self.settings.source.finite(number, &what));
        let values = values.collect::<Result<Vec<f64>, Diagnostic>>()?;
        self.both(&values, numbers.span(), name)
    }

    fn angles(&self, angles: &Spanned<Vec<Written>>, name: &str) -> Result<[f64; 2], Diagnostic> {
        let values: Vec<f64> = angles.get_ref().iter().map(|angle| angle.get_ref().value).collect();
        if values.iter().any(|value| !value.is_finite()) {
            return Err(self.diagnostic(angles.span(), format!("{name} must be finite")).help(EXAMPLE));
        }
        self.both(&values, angles.span(), name)
    }

    fn both(&self, values: &[f64], at: Range<usize>, name: &str) -> Result<[f64; 2], Diagnostic> {
        let [first, second] = *values else {
            let message = format!("{name} has {} numbers, but there are two motors", values.len());
            return Err(self.diagnostic(at, message).help(EXAMPLE));
        };
        if let Some(large) = values.iter().find(|value| value.abs() > LARGEST) {
            let message = format!("{name} contains {large:e}, but numbers must be from -1e6 to 1e6");
            return Err(self.diagnostic(at, message).help(EXAMPLE));
        }
        Ok([first, second])
    }
}

impl Bounds {
    /// Applies the limits of the joint's motor. `None` if no joint value remains.
    fn limit(&mut self, motor: MotorLimits) -> Option<()> {
        if let Some([least, greatest]) = motor.range {
            let (lower, upper) = match self.range {
                JointRange::Interval { lower, upper } => (lower.max(least), upper.min(greatest)),
                JointRange::Circle => (least, greatest),
            };
            self.range = JointRange::Interval { lower, upper };
            (lower < upper).then_some(())?;
        }
        let MissingRates { velocity, acceleration } = self.rates.assumed;
        if let Some(limit) = motor.velocity {
            self.rates.velocity = if velocity { limit } else { self.rates.velocity.min(limit) };
            if acceleration {
                self.rates.acceleration = assumed_acceleration(self.rates.velocity);
            }
            self.rates.assumed.velocity = false;
        }
        if let Some(limit) = motor.acceleration {
            self.rates.acceleration = if acceleration { limit } else { self.rates.acceleration.min(limit) };
            self.rates.assumed.acceleration = false;
        }
        if let Some(limit) = motor.jerk {
            self.rates.jerk = Some(self.rates.jerk.map_or(limit, |jerk| jerk.min(limit)));
        }
        Some(())
    }
}
