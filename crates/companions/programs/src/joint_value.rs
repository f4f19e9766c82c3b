//! Joint values in templates: numbers with a mark that names their target, so that the written digits can be read back.

use crate::moves::ProgramJoint;
use cplan_model::space::JointRange;
use cplan_text::fixed;
use minijinja::value::{Enumerator, Object, Value};
use minijinja::{Error, ErrorKind};
use std::fmt;
use std::sync::Arc;

/// Characters around a written value: mark, digits. They are for private use, so no controller's program has them.
pub(crate) const MARK: [char; 3] = ['\u{e000}', '\u{e001}', '\u{e002}'];

/// Decimals of values in degrees and millimetres, unless the template chooses others.
const DECIMALS: usize = 4;

/// Decimals of values in radians and metres.
const DECIMALS_OF_URDF: usize = 7;

/// Largest number of decimals. Doubles have no more.
const MAX_DECIMALS: usize = 15;

/// Returns the value of a joint, radians or metres, for a written number.
pub(crate) fn value_of(written: f64, zero: f64, scale: f64) -> f64 {
    (written - zero) * scale
}

/// The value of a joint at a target.
#[derive(Debug, Clone)]
pub(crate) struct JointValue {
    target: usize,
    joint: usize,
    name: Arc<str>,
    /// The value, radians or metres.
    value: f64,
    slides: bool,
    range: Option<JointRange>,
    /// True if it is written in radians or metres instead of degrees or millimetres.
    in_urdf_units: bool,
    /// The written number is `sign * x + zero`, where `x` is the value in its unit.
    sign: f64,
    zero: f64,
    decimals: Option<usize>,
}

impl JointValue {
    pub fn new(target: usize, index: usize, joint: &ProgramJoint, value: f64) -> Self {
        let ProgramJoint { name, slides, range, .. } = joint;
        Self {
            target,
            joint: index,
            name: name.as_str().into(),
            value,
            slides: *slides,
            range: *range,
            in_urdf_units: false,
            sign: 1.0,
            zero: 0.0,
            decimals: None,
        }
    }

    /// Returns the factor from written numbers to radians or metres.
    fn scale(&self) -> f64 {
        self.sign
            * match (self.in_urdf_units, self.slides) {
                (true, _) => 1.0,
                (false, true) => 1e-3,
                (false, false) => 1_f64.to_radians(),
            }
    }

    /// Returns the digits. If rounding leads out of the joint's limits, the last digit changes by one.
    fn digits(&self) -> String {
        let decimals = self.decimals.unwrap_or(if self.in_urdf_units { DECIMALS_OF_URDF } else { DECIMALS });
        let exact = self.value / self.scale() + self.zero;
        let step = 10_f64.powi(-i32::try_from(decimals).unwrap_or(0));
        let texts = [0.0, -step, step].map(|by| fixed(exact + by, decimals));
        let is_within = |text: &&String| {
            let written = text.parse().map_or(f64::NAN, |written| value_of(written, self.zero, self.scale()));
            self.range.is_none_or(|range| range.contains(written))
        };
        texts.iter().find(is_within).unwrap_or(&texts[0]).clone()
    }

    /// Returns the value of a template that is a joint value.
    fn of(value: &Value, filter: &str) -> Result<Self, Error> {
        let message = || format!("{filter} needs a joint value, such as move.joints[0]");
        value.downcast_object_ref::<Self>().cloned().ok_or_else(|| Error::new(ErrorKind::InvalidOperation, message()))
    }
}

impl Object for JointValue {
    fn get_value(self: &Arc<Self>, key: &Value) -> Option<Value> {
        let in_urdf_units = || Self { in_urdf_units: true, sign: 1.0, zero: 0.0, decimals: None, ..(**self).clone() };
        match key.as_str()? {
            "name" => Some(Value::from(&*self.name)),
            "unit" => Some(Value::from(if self.slides { "mm" } else { "deg" })),
            "urdf" => Some(Value::from_object(in_urdf_units())),
            _ => None,
        }
    }

    fn enumerate(self: &Arc<Self>) -> Enumerator {
        Enumerator::Str(&["name", "unit", "urdf"])
    }

    fn render(self: &Arc<Self>, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Self { target, joint, zero, .. }, [open, middle, close]) = (&**self, MARK);
        write!(f, "{open}{target},{joint},{zero},{}{middle}{}{close}", self.scale(), self.digits())
    }
}

/// Returns the joint value with this number of decimals.
pub(crate) fn digits(value: &Value, decimals: usize) -> Result<Value, Error> {
    if decimals > MAX_DECIMALS {
        let message = format!("digits needs a number of decimals from 0 to {MAX_DECIMALS}");
        return Err(Error::new(ErrorKind::InvalidOperation, message));
    }
    Ok(Value::from_object(JointValue { decimals: Some(decimals), ..JointValue::of(value, "digits")? }))
}

/// Returns the joint value with the opposite sign, for a controller whose joint turns in the other direction.
pub(crate) fn negated(value: &Value) -> Result<Value, Error> {
    let value = JointValue::of(value, "negated")?;
    Ok(Value::from_object(JointValue { sign: -value.sign, zero: -value.zero, ..value }))
}

/// Returns the joint value plus a number, for a controller whose joint has another zero.
pub(crate) fn plus(value: &Value, zero: f64) -> Result<Value, Error> {
    let value = JointValue::of(value, "plus")?;
    Ok(Value::from_object(JointValue { zero: value.zero + zero, ..value }))
}
