//! Preference files: a `2D-Map` file of goal rectangles and of rectangles that a field planner prefers or avoids.
//!
//! ```text
//! 2D-Map
//! LineMinPos: -1000 -1000
//! LineMaxPos: 1000 1000
//! NumGoal: 1
//! GOAL
//! 400 400 500 500
//! NumPoint: 1
//! POINTS
//! -200 -200 200 200 0.5
//! END
//! ```

use super::map_text::MapText;
use cplan_geometry::Point;
use cplan_robot::InputError;
use std::path::Path;

/// A preference file in its own unit, which is usually the millimetre.
#[derive(Debug, Clone, PartialEq)]
pub struct PreferenceMap {
    /// `LineMinPos` and `LineMaxPos`: lower left and upper right corner. All rectangles lie between them. They may
    /// differ from those of the line map.
    pub bounds: [Point; 2],
    /// The alternative goals, at least one: lower left and upper right corners of rectangles, which may be points.
    pub goals: Vec<[Point; 2]>,
    /// The preferred and avoided rectangles, in the order of the file.
    pub rectangles: Vec<PreferenceRectangle>,
}

/// A rectangle that a field planner prefers or avoids.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PreferenceRectangle {
    /// Lower left and upper right corner. The area of the rectangle is not zero.
    pub corners: [Point; 2],
    /// Strength of the preference: the value of epsilon in the field's equation there.
    pub epsilon: f64,
}

impl PreferenceMap {
    /// Reads a file. Rectangles may be given by any two opposite corners.
    ///
    /// # Errors
    /// The errors of [`super::LineMap::read`], a file without a goal, and a preference rectangle without area.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        let mut text = MapText::read(path)?;
        let bounds = text.bounds()?;
        let (count, at) = text.count("NumGoal")?;
        if count == 0 {
            let diagnostic = text.source.diagnostic_at(at.clone(), "NumGoal is 0, but a plan needs a goal");
            return Err(diagnostic.help("give a goal rectangle").into());
        }
        text.word("GOAL")?;
        let list = text.list_before::<4>((count, at), "NumGoal", "a goal rectangle", "NumPoint")?;
        let goals = list.iter().map(|goal| text.corners(&goal.values, &goal.at, &bounds).map(sorted_corners));
        let goals = goals.collect::<Result<_, _>>()?;
        let announced = text.count("NumPoint")?;
        text.word("POINTS")?;
        let list = text.list::<5>(announced, "NumPoint", "a rectangle and its epsilon", "END")?;
        text.end()?;
        let mut rectangles = Vec::with_capacity(list.len());
        for line in list {
            let corners = sorted_corners(text.corners(&line.values, &line.at, &bounds)?);
            if (0..2).any(|k| corners[0][k] == corners[1][k]) {
                let diagnostic = text.source.diagnostic_at(line.at, "the rectangle has no area");
                return Err(diagnostic.help("give two opposite corners").into());
            }
            rectangles.push(PreferenceRectangle { corners, epsilon: line.values[4] });
        }
        Ok(Self { bounds, goals, rectangles })
    }
}

/// Returns the lower left and the upper right corner of the rectangle with these opposite corners.
fn sorted_corners([a, b]: [Point; 2]) -> [Point; 2] {
    [a.inf(&b), a.sup(&b)]
}
