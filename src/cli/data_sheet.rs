//! Robots from the numbers of a data sheet, for `cplan init`.

use super::arm_numbers::ArmNumbers;
use super::failure::Failure;
use super::headings::DATA_SHEET;
use super::init::Kind;
use crate::options::{Word, positive, word};
use clap::Args;

/// Numbers that data sheets state.
#[derive(Debug, Clone, Args)]
pub struct DataSheet {
    /// Lengths of both links, from axis to axis and from there to the tip, metres (rr, scara); distance of the tip from the
    /// axis with the ram drawn in, metres (rp).
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_parser = positive, help_heading = DATA_SHEET)]
    pub links: Vec<f64>,
    /// Travel of the quill, metres (scara).
    #[arg(long, value_name = "METRES", value_parser = positive, help_heading = DATA_SHEET)]
    pub stroke: Option<f64>,
    /// Ranges of both joints: 130 is from -130 to 130 degrees; for a sliding joint, 0.8 is from 0 to 0.8 metres.
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_parser = positive, help_heading = DATA_SHEET)]
    pub limits: Vec<f64>,
    /// Top speeds of both joints, degrees or metres per second.
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_parser = positive, help_heading = DATA_SHEET)]
    pub speeds: Vec<f64>,
    /// Mounting of the motors (rr, scara).
    #[arg(long, value_parser = word(DRIVES), value_name = "NAME", help_heading = DATA_SHEET)]
    pub drives: Option<&'static str>,
}

/// Motors of two joints that turn, by the names of the key `drives` in world files.
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

    /// Returns the numbers of an arm: those of the data sheet, and the usual ones of this kind for the others.
    ///
    /// # Errors
    /// Numbers that this kind of arm does not have, a wrong count of them, and numbers that cannot be metres or degrees.
    pub fn numbers(&self, kind: Kind) -> Result<ArmNumbers, Failure> {
        let usual = ArmNumbers::of(kind);
        let [limits, speeds] = [both("limits", &self.limits)?, both("speeds", &self.speeds)?];
        for (k, turns) in kind.turns().into_iter().enumerate() {
            let (range, unit) = if turns { (DEGREES, "degrees") } else { (LENGTHS, "metres") };
            check("limits", limits.map(|limits| limits[k]), range, unit)?;
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
            limits: limits.map_or(usual.limits, in_radians),
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
            (_, 0) => Err(Failure::Usage(format!("--links: {} has none; --limits are its travels", kind.name()))),
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
fn both(name: &str, given: &[f64]) -> Result<Option<[f64; 2]>, Failure> {
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
