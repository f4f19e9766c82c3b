//! Limits of the shafts of motors, in the `[robot]` table.

use super::{ReadResult, Reader, Value};
use cplan_check::decimal::Decimal;
use cplan_check::domain::Range;
use cplan_check::interval::Interval;
use num_bigint::Sign;

/// The part of the table `drives` that limits joint values.
pub struct Drives {
    /// Turns of the elbow's motor for each turn of joint 1.
    pub ratio: Decimal,
    /// Enclosures of the least and the greatest values that the motors allow: of joint 1, and of the sum `ratio q1 + q2`.
    pub limits: Option<[[Range; 2]; 2]>,
}

impl Reader<'_> {
    pub(super) fn drives(&self, value: &Value) -> ReadResult<Option<Drives>> {
        let with_ratio = |ratio: i32| Some(Drives { ratio: Decimal::whole(ratio), limits: None });
        if let Some(preset) = value.get_ref().as_str() {
            return match preset {
                "standard_scara" => Ok(with_ratio(1)),
                "direct" => Ok(with_ratio(0)),
                _ => self.error(value, "unknown drives"),
            };
        }
        let (mut ratio, mut on_link) = (Decimal::whole(1), false);
        let mut gear = [Decimal::whole(1), Decimal::whole(1)];
        let mut zero = gear.each_ref().map(|_| [Decimal::whole(0), Decimal::whole(0)]);
        let mut ends: [Option<[Range; 2]>; 2] = [None, None];
        for (key, value) in self.table(value)? {
            match &**key.get_ref() {
                "elbow" => {
                    on_link = match &*self.text(value)? {
                        "base" => false,
                        "link" => true,
                        _ => return self.error(value, "expected \"base\" or \"link\""),
                    };
                }
                "ratio" => ratio = self.number(value)?,
                "gear" => gear = self.pair(value, |n| self.number(n))?,
                "zero" => zero = self.pair(value, |q| self.quantity(q))?,
                "motors" => {
                    for (key, value) in self.table(value)? {
                        match &**key.get_ref() {
                            "lower" => ends[0] = Some(self.pair(value, |q| self.quantity(q))?),
                            "upper" => ends[1] = Some(self.pair(value, |q| self.quantity(q))?),
                            // These keys do not affect the positions of shapes.
                            "velocity" | "acceleration" | "jerk" | "effort" => {}
                            other => {
                                return self
                                    .error(value, &format!("the checker does not know the key {other} of motors"));
                            }
                        }
                    }
                }
                other => return self.error(value, &format!("the checker does not know the key {other} of drives")),
            }
        }
        let ratio = if on_link { Decimal::whole(0) } else { ratio };
        let [lower, upper] = ends;
        let limits = match (lower, upper) {
            (Some(lower), Some(upper)) => {
                let of = |k: usize| limits(&gear[k], &zero[k], [&lower[k], &upper[k]]);
                let (Some(first), Some(second)) = (of(0), of(1)) else {
                    return self.error(value, "a gear of 0");
                };
                Some([first, second])
            }
            (None, None) => None,
            _ => return self.error(value, "motors need both lower and upper limits"),
        };
        Ok(Some(Drives { ratio, limits }))
    }
}

/// Returns the limits of a joint value, or of the sum, that follow from limits of the shaft. `None` if the gear ratio is 0.
fn limits(gear: &Decimal, zero: &Range, ends: [&Range; 2]) -> Option<[Range; 2]> {
    let is_one = *gear == Decimal::whole(1) && zero.iter().all(|zero| zero.sign() == Sign::NoSign);
    if is_one {
        return Some(ends.map(Range::clone));
    }
    let turns_forward = match gear.sign() {
        Sign::NoSign => return None,
        sign => sign == Sign::Plus,
    };
    let size = Interval::from(gear).abs();
    let [lower, upper] = ends.map(|end| {
        let turned = &Interval::enclosing(end) - &Interval::enclosing(zero);
        (if turns_forward { turned } else { -&turned }).divided(&size).ends()
    });
    Some(if turns_forward { [lower, upper] } else { [upper, lower] })
}
