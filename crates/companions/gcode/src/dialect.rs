//! The dialects of G-code that machines with their own kinematics read.

use cplan_toolpath::Source;
use std::fmt;

/// A firmware, with its own rules for programs and travels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Dialect {
    /// Marlin with SCARA kinematics.
    #[default]
    Marlin,
    /// Klipper.
    Klipper,
    /// RepRapFirmware on Duet boards.
    Duet,
    /// FluidNC.
    FluidNc,
    /// Grbl.
    Grbl,
    /// LinuxCNC.
    LinuxCnc,
}

impl Dialect {
    /// All dialects.
    pub const ALL: [Self; 6] = [Self::Marlin, Self::Klipper, Self::Duet, Self::FluidNc, Self::Grbl, Self::LinuxCnc];

    /// Returns the name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Dialect::Marlin => "marlin",
            Dialect::Klipper => "klipper",
            Dialect::Duet => "duet",
            Dialect::FluidNc => "fluidnc",
            Dialect::Grbl => "grbl",
            Dialect::LinuxCnc => "linuxcnc",
        }
    }

    /// Returns true if the firmware may play a travel (G0) without segments: Marlin and RepRapFirmware with SCARA kinematics
    /// move the joints straight from its beginning to its end. So such travels must be free in this motion, too.
    pub fn travels_by_joints(self) -> bool {
        matches!(self, Dialect::Marlin | Dialect::Duet)
    }

    /// Returns the default of the least length of segments, metres: `SCARA_MIN_SEGMENT_LENGTH` in Marlin, the T of M669
    /// in RepRapFirmware. `None` for firmwares that do not divide lines by a number of segments per second.
    pub fn least_segment(self) -> Option<f64> {
        match self {
            Dialect::Marlin => Some(0.5e-3),
            Dialect::Duet => Some(0.2e-3),
            _ => None,
        }
    }

    /// Returns the dialect that a program names in a comment, or that alone has some word of the program, with the
    /// first such line. `None` if there is no such line, or if the program names several dialects.
    pub fn of_program(text: &str) -> Option<(Self, Source)> {
        let of_line = |line: &str| -> Vec<Self> {
            let at = line.find([';', '(']).unwrap_or(line.len());
            let (code, comment) = (line[..at].trim(), line[at..].to_ascii_lowercase());
            let words: Vec<&str> = comment.split(|c: char| !c.is_ascii_alphanumeric()).collect();
            let is_named = |own: &Self| own.names().iter().any(|name| words.contains(name));
            let mut found: Vec<Self> = Self::ALL.into_iter().filter(is_named).collect();
            found.extend(Self::of_code(code).filter(|own| !found.contains(own)));
            found
        };
        let (found, line) =
            text.lines().zip(1..).map(|(line, k)| (of_line(line), k)).find(|(found, _)| !found.is_empty())?;
        (found.len() == 1).then(|| (found[0], Source::of_line(line)))
    }

    /// Returns the words of comments that name the firmware. Slicers write `;FLAVOR:RepRap` for RepRapFirmware.
    fn names(self) -> &'static [&'static str] {
        match self {
            Dialect::Marlin => &["marlin", "marlin2"],
            Dialect::Klipper => &["klipper"],
            Dialect::Duet => &["duet", "reprapfirmware", "reprap"],
            Dialect::FluidNc => &["fluidnc"],
            Dialect::Grbl => &["grbl"],
            Dialect::LinuxCnc => &["linuxcnc", "emc2"],
        }
    }

    /// Returns the dialect whose words a line has: commands with long names of Klipper, settings of Grbl (`$H`), and `%` or
    /// names of subroutines of LinuxCNC.
    fn of_code(code: &str) -> Option<Self> {
        let name = code.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).next().unwrap_or_default();
        let is_command = name.len() > 2 && name.chars().all(|c| c.is_ascii_alphabetic() || c == '_');
        match code.chars().next()? {
            '$' => Some(Dialect::Grbl),
            '%' => Some(Dialect::LinuxCnc),
            'o' | 'O' if code[1..].trim_start().starts_with('<') => Some(Dialect::LinuxCnc),
            _ if is_command => Some(Dialect::Klipper),
            _ => None,
        }
    }

    /// Returns a text as a comment.
    pub fn comment(self, text: &str) -> String {
        match self {
            Dialect::Marlin | Dialect::Klipper | Dialect::Duet => format!("; {text}"),
            Dialect::FluidNc | Dialect::Grbl | Dialect::LinuxCnc => format!("({text})"),
        }
    }
}

impl fmt::Display for Dialect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
