//! Reads the lines of steps. Straight lines and arcs are read exactly. Other lines come from the certificate.

use super::{ReadResult, Reader, Value};
use cplan_check::decimal::Decimal;
use cplan_check::elbow::Elbow;
use cplan_check::interval::{Interval, Point, sum, times, turned};
use cplan_check::obstacle::point;
use cplan_check_line::StepLine;
use num_bigint::Sign;

/// Number of decimals of the default tolerance of a line: `10^-5` m.
const DEFAULT_TOLERANCE_DECIMALS: u32 = 5;

/// Keys that define the form of a line.
const FORMS: [&str; 4] = ["points", "arc", "spline", "file"];

/// Other keys of a line. The checker judges neither the speed nor the angle of the tool. Shapes that turn with the
/// wrist count as discs, so they are free at any angle.
const MANNERS: [&str; 10] =
    ["radius", "speed", "tolerance", "unit", "scale", "turn", "move", "wrist", "wrist_tolerance", "elbow"];

/// A line that a step of the world requires.
pub struct WorldLine {
    /// Greatest distance between the tip and the line, metres.
    pub tolerance: Decimal,
    /// True if the world requires an angle of the tool.
    pub has_tool_angle: bool,
    /// The side of the elbow all along the line. `None` if either side will do.
    pub elbow: Option<Elbow>,
    /// The form of the line. `None` if the checker does not read it.
    form: Option<Form>,
}

/// The form of a line, at its place in the plane.
enum Form {
    /// Straight lines between points.
    Straight(Vec<Point>),
    /// An arc from the first point through the second one to the third one.
    Arc(Box<[Point; 3]>),
}

impl WorldLine {
    /// Returns true if the checker reads the form of the line.
    pub fn is_known(&self) -> bool {
        self.form.is_some()
    }

    /// Returns true if the certificate's line agrees with this one: it has the same form, or the checker does not read the form.
    pub fn allows(&self, line: &StepLine) -> bool {
        match &self.form {
            None => true,
            Some(Form::Straight(points)) => line.joins(points),
            Some(Form::Arc(points)) => line.is_arc_through(points),
        }
    }
}

impl Reader<'_> {
    /// Reads the table `follow` of a step.
    pub(super) fn line(&self, value: &Value) -> ReadResult<WorldLine> {
        let table = self.table(value)?;
        if let Some((key, _)) =
            table.iter().find(|(key, _)| ![&FORMS[..], &MANNERS].concat().contains(&&**key.get_ref()))
        {
            return self.error(value, &format!("the checker does not know the key {} of a line", key.get_ref()));
        }
        let given: Vec<&str> = FORMS.into_iter().filter(|form| table.contains_key(*form)).collect();
        let [form] = given[..] else {
            return self.error(value, "a line needs exactly one of `points`, `arc`, `spline` and `file`");
        };
        for (key, of) in [("unit", "file"), ("radius", "points")] {
            if form != of && table.contains_key(key) {
                return self.error(value, &format!("only a line with `{of}` has a `{key}`"));
            }
        }
        let number = |key: &str| table.get(key).map(|value| self.number(value)).transpose();
        let length = |key: &str| table.get(key).map(|value| self.length(value)).transpose();
        let tolerance = length("tolerance")?.unwrap_or(Decimal::power_of_ten(DEFAULT_TOLERANCE_DECIMALS));
        if tolerance.sign() != Sign::Plus {
            return self.error(value, "the tolerance of a line must be positive");
        }
        let scale = number("scale")?.as_ref().map_or(Interval::whole(1), Interval::from);
        let angle =
            table.get("turn").map_or(Ok(Interval::whole(0)), |q| Ok(Interval::enclosing(&self.quantity(q)?)))?;
        let turn = angle.sin_cos();
        let shift = table.get("move").map(|at| self.pair(at, |n| self.length(n))).transpose()?;
        let shift = shift.as_ref().map_or([0, 0].map(Interval::whole), point);
        let points = || {
            let corners = self.corners(&table[form])?;
            ReadResult::Ok(
                corners.iter().map(|p| sum(&shift, &turned(&times(&point(p), &scale), &turn))).collect::<Vec<_>>(),
            )
        };
        let is_round = length("radius")?.is_some_and(|radius| radius.sign() != Sign::NoSign);
        let form = match form {
            "points" if !is_round => Some(Form::Straight(points()?)),
            "arc" => match <[Point; 3]>::try_from(points()?) {
                Ok(points) => Some(Form::Arc(Box::new(points))),
                Err(_) => return self.error(value, "an arc needs three points"),
            },
            _ => None,
        };
        Ok(WorldLine { tolerance, has_tool_angle: table.contains_key("wrist"), elbow: self.elbow(table)?, form })
    }
}
