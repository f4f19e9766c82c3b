//! Values of joints and angles as the world file has them: `0.5`, or `"30deg"`.

use super::error::Diagnostic;
use super::source::Source;
use super::world::{Number, Reader};
use cplan_core::model::Joint;
use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;
use std::ops::Range;
use toml::Spanned;

/// A joint's value or an angle: in radians or metres, whether it was written so or in degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantity {
    /// Radians or metres.
    pub value: f64,
    /// Written in degrees, so that it is no length.
    pub in_degrees: bool,
}

/// A value and where it stands.
pub(super) type Written = Spanned<Quantity>;

impl<'de> Deserialize<'de> for Quantity {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(QuantityVisitor)
    }
}

struct QuantityVisitor;

impl Visitor<'_> for QuantityVisitor {
    type Value = Quantity;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a number, or an angle such as \"30deg\"")
    }

    fn visit_f64<E>(self, value: f64) -> Result<Quantity, E> {
        Ok(Quantity { value, in_degrees: false })
    }

    fn visit_i64<E>(self, value: i64) -> Result<Quantity, E> {
        Ok(Quantity { value: value as f64, in_degrees: false })
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Quantity, E> {
        let wrong = || E::custom(format!("expected a number, or an angle such as \"30deg\", found \"{text}\""));
        let degrees = text.trim().strip_suffix("deg").ok_or_else(wrong)?;
        let degrees: f64 = degrees.trim_end().parse().map_err(|_| wrong())?;
        Ok(Quantity { value: degrees.to_radians(), in_degrees: true })
    }
}

/// Values of both joints, base to tip, and where those stand that are in degrees.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct JointPair {
    pub values: [f64; 2],
    pub degrees: [Option<Range<usize>>; 2],
}

impl JointPair {
    /// Refuses degrees of joints that slide.
    ///
    /// # Errors
    /// At the first such value.
    pub fn check(&self, source: &Source, joints: &[Joint; 2]) -> Result<(), Diagnostic> {
        for (joint, at) in joints.iter().zip(&self.degrees) {
            if let Some(at) = at.as_ref().filter(|_| !joint.joint_type.is_revolute()) {
                let message = format!("joint \"{}\" slides: its value cannot be in degrees", joint.name);
                return Err(source
                    .diagnostic_at(at.clone(), message)
                    .help("write its value in metres, without \"deg\""));
            }
        }
        Ok(())
    }
}

impl Reader<'_> {
    /// An angle, or a joint's value.
    pub fn quantity(&self, written: &Written, what: &str) -> Result<f64, Diagnostic> {
        self.finite(&Number::new(written.span(), written.get_ref().value), what)
    }

    /// Values of both joints.
    pub fn joint_pair(&self, written: &Spanned<Vec<Written>>, what: &str) -> Result<JointPair, Diagnostic> {
        let [a, b] = &written.get_ref()[..] else {
            let message = format!("{what}: expected two numbers, found {}", written.get_ref().len());
            return Err(self.source.diagnostic_at(written.span(), message).help("joints = [q1, q2], base to tip"));
        };
        let values = [self.quantity(a, what)?, self.quantity(b, what)?];
        Ok(JointPair { values, degrees: [a, b].map(|w| w.get_ref().in_degrees.then(|| w.span())) })
    }
}
