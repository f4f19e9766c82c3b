//! Robots from the numbers of a data sheet, for `cplan init`.

use super::arm_numbers::ArmNumbers;
use super::failure::Failure;
use super::init::Kind;
use crate::options::positive;
use clap::Args;

/// Numbers that data sheets state.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Data sheet")]
pub struct DataSheet {
    /// Lengths of both links, from axis to axis and from there to the tip, metres (rr, scara); distance of the tip from the
    /// axis with the ram drawn in, metres (rp).
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_parser = positive)]
    pub links: Vec<f64>,
    /// Travel of the quill, metres (scara).
    #[arg(long, value_name = "METRES", value_parser = positive)]
    pub stroke: Option<f64>,
    /// Ranges of both joints: 130 is from -130 to 130 degrees; for a sliding joint, 0.8 is from 0 to 0.8 metres.
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_parser = positive)]
    pub limits: Vec<f64>,
    /// Top speeds of both joints, degrees or metres per second.
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_parser = positive)]
    pub speeds: Vec<f64>,
}

/// Largest length and largest range of a joint. Larger numbers are mistakes, such as millimetres for metres.
const MAX_LENGTH: f64 = 100.0;
const MAX_DEGREES: f64 = 3600.0;

impl DataSheet {
    /// Returns true if no number is given.
    pub fn is_empty(&self) -> bool {
        self.links.is_empty() && self.stroke.is_none() && self.limits.is_empty() && self.speeds.is_empty()
    }

    /// Returns the numbers of an arm: those of the data sheet, and the usual ones of this kind for the others.
    ///
    /// # Errors
    /// Numbers that this kind of arm does not have, a wrong count of them, and numbers that cannot be metres or degrees.
    pub fn numbers(&self, kind: Kind) -> Result<ArmNumbers, Failure> {
        let usual = ArmNumbers::of(kind);
        let numbers = ArmNumbers {
            links: self.links(kind, usual.links)?,
            stroke: self.stroke(kind, usual.stroke)?,
            limits: both("limits", &self.limits, kind)?.unwrap_or(usual.limits),
            speeds: both("speeds", &self.speeds, kind)?.unwrap_or(usual.speeds),
        };
        for (k, turns) in kind.turns().into_iter().enumerate() {
            let (most, unit) = if turns { (MAX_DEGREES, "degrees") } else { (MAX_LENGTH, "metres") };
            let limit = if turns { numbers.limits[k].to_degrees() } else { numbers.limits[k] };
            if limit > most {
                return Err(Failure::Usage(format!("--limits: number {} is in {unit}, and at most {most}", k + 1)));
            }
        }
        if numbers.links.iter().chain([&numbers.stroke]).any(|length| *length > MAX_LENGTH) {
            return Err(Failure::Usage(format!("--links and --stroke are in metres, and at most {MAX_LENGTH}")));
        }
        Ok(numbers)
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

/// Returns the numbers of an option for both joints, in radians if a joint turns. `None` without any.
fn both(name: &str, given: &[f64], kind: Kind) -> Result<Option<[f64; 2]>, Failure> {
    let turns = kind.turns();
    match *given {
        [] => Ok(None),
        [first, second] => {
            let given = [first, second];
            Ok(Some([0, 1].map(|k| if turns[k] { given[k].to_radians() } else { given[k] })))
        }
        _ => Err(Failure::Usage(format!("--{name} needs two numbers separated by a comma, such as 130,145"))),
    }
}
