//! The dialects of G-code that machines with their own kinematics read.

use std::fmt;

/// A firmware, as far as its programs and its travels differ from others.
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

    /// Returns true if the firmware may play a travel (G0) without segments: Marlin and RepRapFirmware with SCARA
    /// kinematics move the joints straight from its beginning to its end. Such travels must also be free in this motion.
    pub fn travels_by_joints(self) -> bool {
        matches!(self, Dialect::Marlin | Dialect::Duet)
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
