//! Robots from the numbers of a data sheet, for `cplan init`.

use super::arm_numbers::ArmNumbers;
use super::failure::Failure;
use super::headings::DATA_SHEET;
use super::init::Kind;
use crate::options::{Word, finite, positive, word};
use clap::Args;

/// The range of a joint, in degrees or metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// `None` for minus the upper end of a revolute joint, and for 0 of a prismatic one.
    lower: Option<f64>,
    upper: f64,
}

/// Parses the range of a joint, such as 130 or -100:130.
fn range(text: &str) -> Result<Range, String> {
    let Some((lower, upper)) = text.split_once(':') else {
        return positive(text).map(|upper| Range { lower: None, upper });
    };
    let range = Range { lower: Some(finite(lower)?), upper: finite(upper)? };
    match range {
        Range { lower: Some(lower), upper } if lower < 0.0 && upper > 0.0 => Ok(range),
        _ => Err("a range must contain 0, such as -100:130".to_owned()),
    }
}

/// Returns the URDF of the SCARA that `cplan init --kind scara` writes for these numbers, in metres, radians and
/// radians per second. `None` stands for the number of the arm without a data sheet.
///
/// # Errors
/// Numbers that cannot be those of a SCARA.
pub fn scara_urdf(
    links: Option<[f64; 2]>,
    stroke: Option<f64>,
    limits: Option<[(f64, f64); 2]>,
    speeds: Option<[f64; 2]>,
) -> Result<String, Failure> {
    let sheet = DataSheet {
        links: links.iter().flatten().copied().collect(),
        stroke,
        limits: { limits.iter().flatten() }
            .map(|(lower, upper)| Range { lower: Some(lower.to_degrees()), upper: upper.to_degrees() })
            .collect(),
        speeds: speeds.iter().flatten().map(|speed| speed.to_degrees()).collect(),
        drives: None,
    };
    let numbers = sheet.numbers(Kind::Scara).map_err(|failure| match failure {
        Failure::Usage(message) => Failure::Usage(message.trim_start_matches("--").to_owned()),
        other => other,
    })?;
    Ok(numbers.urdf(Kind::Scara))
}

/// Numbers that data sheets state.
#[derive(Debug, Clone, Args)]
pub struct DataSheet {
    /// For rr and scara: lengths of both links, from axis to axis and from the second axis to the tip, metres. For rp:
    /// distance of the tip from the axis when the ram is drawn in, metres.
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_parser = positive, help_heading = DATA_SHEET)]
    pub links: Vec<f64>,
    /// Travel of the quill, metres (scara).
    #[arg(long, value_name = "METRES", value_parser = positive, help_heading = DATA_SHEET)]
    pub stroke: Option<f64>,
    /// Ranges of both joints: 130 means -130 to 130 degrees, and -100:130 means -100 to 130 degrees; for a sliding
    /// joint, 0.8 means 0 to 0.8 metres.
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_parser = range, allow_hyphen_values = true, help_heading = DATA_SHEET)]
    pub limits: Vec<Range>,
    /// Top speeds of both joints, degrees or metres per second.
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_parser = positive, help_heading = DATA_SHEET)]
    pub speeds: Vec<f64>,
    /// Mounting of the motors (rr, scara).
    #[arg(long, value_parser = word(DRIVES), value_name = "NAME", help_heading = DATA_SHEET)]
    pub drives: Option<&'static str>,
}

/// Motors of two revolute joints, by the names of the key `drives` in world files.
const DRIVES: [Word<&str>; 2] = [
    ("standard_scara", "standard_scara", "The elbow's motor is mounted on the base, and a belt leads to the elbow"),
    ("direct", "direct", "The elbow's motor is mounted on the upper arm"),
];

/// Least and largest lengths in metres, ranges in degrees, and speeds in metres or degrees per second. Other numbers are
/// mistakes, such as millimetres for metres.
const LENGTHS: [f64; 2] = [1e-3, 100.0];
const DEGREES: [f64; 2] = [0.1, 3600.0];
const SPEEDS: [f64; 2] = [1e-3, 1e5];

impl DataSheet {
    /// Returns true if no number is given.
    pub fn is_empty(&self) -> bool {
        let is_plain = self.stroke.is_none() && self.drives.is_none();
        is_plain && self.links.is_empty() && self.limits.is_empty() && self.speeds.is_empty()
    }

    /// Returns the numbers of an arm: those of the data sheet, and usual ones of this kind of arm for all others.
    ///
    /// # Errors
    /// Numbers that this kind of arm does not have, a wrong count of them, and numbers that cannot be metres or degrees.
    pub fn numbers(&self, kind: Kind) -> Result<ArmNumbers, Failure> {
        let usual = ArmNumbers::of(kind);
        let (limits, speeds) = (both("limits", &self.limits)?, both("speeds", &self.speeds)?);
        for (k, turns) in kind.turns().into_iter().enumerate() {
            let (range, unit) = if turns { (DEGREES, "degrees") } else { (LENGTHS, "metres") };
            let limit = limits.map(|limits| limits[k]);
            check("limits", limit.map(|limit| limit.upper), range, unit)?;
            if let Some(lower) = limit.and_then(|limit| limit.lower) {
                if !turns {
                    let message =
                        format!("--limits: joint {} slides, beginning at 0; give only its travel, such as 0.8", k + 1);
                    return Err(Failure::Usage(message));
                }
                check("limits", Some(lower), [-range[1], -range[0]], unit)?;
            }
            check("speeds", speeds.map(|speeds| speeds[k]), SPEEDS, &format!("{unit} per second"))?;
        }
        self.links.iter().try_for_each(|&length| check("links", Some(length), LENGTHS, "metres"))?;
        check("stroke", self.stroke, LENGTHS, "metres")?;
        let turns = kind.turns();
        if self.drives.is_some() && turns != [true; 2] {
            return Err(Failure::Usage(format!("--drives needs two joints that turn, not {}", kind.name())));
        }
        let in_radians = |given: [f64; 2]| [0, 1].map(|k| if turns[k] { given[k].to_radians() } else { given[k] });
        Ok(ArmNumbers {
            links: self.links(kind, usual.links)?,
            stroke: self.stroke(kind, usual.stroke)?,
            lower: limits.map_or(usual.lower, |limits| {
                let lower = |k: usize| limits[k].lower.unwrap_or(if turns[k] { -limits[k].upper } else { 0.0 });
                in_radians([lower(0), lower(1)])
            }),
            limits: limits.map_or(usual.limits, |limits| in_radians(limits.map(|limit| limit.upper))),
            speeds: speeds.map_or(usual.speeds, in_radians),
            drives: self.drives,
        })
    }

    fn links(&self, kind: Kind, usual: [f64; 2]) -> Result<[f64; 2], Failure> {
        let count = usual.iter().filter(|length| **length > 0.0).count();
        match (self.links.as_slice(), count) {
            ([], _) => Ok(usual),
            (&[first], 1) => Ok([first, 0.0]),
            (&[first, second], 2) => Ok([first, second]),
            (_, 0) => Err(Failure::Usage(format!(
                "--links does not apply to {}, which has no links; --limits states its travels",
                kind.name()
            ))),
            (given, _) => Err(Failure::Usage(format!("--links: {} needs {count}, not {}", kind.name(), given.len()))),
        }
    }

    fn stroke(&self, kind: Kind, usual: f64) -> Result<f64, Failure> {
        match self.stroke {
            Some(_) if usual == 0.0 => {
                Err(Failure::Usage(format!("--stroke needs --kind scara: {} has no quill", kind.name())))
            }
            given => Ok(given.unwrap_or(usual)),
        }
    }
}

/// Returns the numbers of an option for both joints. `None` without any.
fn both<T: Copy>(name: &str, given: &[T]) -> Result<Option<[T; 2]>, Failure> {
    match *given {
        [] => Ok(None),
        [first, second] => Ok(Some([first, second])),
        _ => Err(Failure::Usage(format!("--{name} needs two numbers separated by a comma, such as 130,145"))),
    }
}

/// Refuses a number outside its range.
fn check(name: &str, given: Option<f64>, [least, most]: [f64; 2], unit: &str) -> Result<(), Failure> {
    match given.filter(|given| !(least..=most).contains(given)) {
        None => Ok(()),
        Some(given) => Err(Failure::Usage(format!("--{name} {given} is not from {least} to {most} {unit}"))),
    }
}
