//! Numbers of cells along the axes of a grid.

use super::planner_errors::wrong_number;
use super::setting::ALLOWED_CELLS;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// Numbers of cells along the axes of joint 1 and joint 2. As text, `256` or `128x512`; in JSON, a number or a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "CellCountsForm", into = "CellCountsForm")]
pub struct CellCounts(pub [usize; 2]);

#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(untagged)]
enum CellCountsForm {
    Each(usize),
    Pair([usize; 2]),
}

impl CellCounts {
    /// Returns the same count for both axes.
    pub fn square(n: usize) -> Self {
        Self([n; 2])
    }

    /// Describes the first count that is out of range, in words. `None` if both are valid.
    pub fn error(self) -> Option<String> {
        self.0.into_iter().find_map(|n| wrong_number("cells", n, &ALLOWED_CELLS))
    }
}

impl From<CellCountsForm> for CellCounts {
    fn from(written: CellCountsForm) -> Self {
        match written {
            CellCountsForm::Each(n) => Self::square(n),
            CellCountsForm::Pair(counts) => Self(counts),
        }
    }
}

impl From<CellCounts> for CellCountsForm {
    fn from(CellCounts(counts): CellCounts) -> Self {
        if counts[0] == counts[1] { Self::Each(counts[0]) } else { Self::Pair(counts) }
    }
}

impl fmt::Display for CellCounts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self([a, b]) = self;
        if a == b { write!(f, "{a}") } else { write!(f, "{a}x{b}") }
    }
}

impl FromStr for CellCounts {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let cure = || {
            let (least, most) = (ALLOWED_CELLS.start(), ALLOWED_CELLS.end());
            format!(
                "{text} is not a number from {least} to {most}, or two such numbers, one per joint, such as 128x512"
            )
        };
        let count = |text: &str| text.parse::<usize>().ok().filter(|n| ALLOWED_CELLS.contains(n)).ok_or_else(cure);
        match text.split_once('x') {
            None => Ok(Self::square(count(text)?)),
            Some((a, b)) => Ok(Self([count(a)?, count(b)?])),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cell_counts_are_one_number_or_two() {
        let of = |text: &str| text.parse::<CellCounts>();
        assert_eq!(of("256"), Ok(CellCounts([256, 256])));
        assert_eq!(of("128x512"), Ok(CellCounts([128, 512])));
        for text in ["", "x", "7", "128x", "128x4096", "128x64x32", "-8", "12.5", "128 x 512"] {
            assert!(of(text).unwrap_err().contains("is not a number from 8 to 2048"), "{text}");
        }
        for counts in [CellCounts([9, 9]), CellCounts([8, 2048])] {
            assert_eq!(of(&counts.to_string()), Ok(counts));
            let written = serde_json::to_string(&counts).unwrap();
            assert_eq!(serde_json::from_str::<CellCounts>(&written).unwrap(), counts);
        }
        // Equal counts are written as one number, for compatibility with older files.
        assert_eq!(serde_json::to_string(&CellCounts::square(64)).unwrap(), "64");
        assert_eq!(CellCounts([8, 7]).error(), Some("cells: 7 must be from 8 to 2048".to_owned()));
    }
}
