//! Shapes that are carried, among obstacles.

use crate::curve::Piece;
use crate::error::CheckError;
use crate::free::{Chain, Open, Side, Solid, guard, keep_off};
use crate::interval::Point;
use crate::world::Obstacle;

/// A shape that is carried.
pub struct Part<'a> {
    /// What it is called, and how far it has to keep, in words.
    pub name: &'a str,
    pub keeps: &'a str,
    pub solid: &'a Solid,
    /// Of each obstacle, whether they can meet.
    pub meets: Vec<bool>,
}

/// An obstacle in its place.
pub struct Standing {
    pub obstacle: Obstacle,
    pub sides: Vec<Side>,
}

impl Standing {
    /// An obstacle as what moves by a chain sees it.
    ///
    /// # Errors
    /// As [`Obstacle::sides`].
    pub fn new(chain: &Chain, obstacle: Obstacle) -> Result<Self, CheckError> {
        let sides = obstacle.sides()?.iter().map(|side| Side::new(chain, side)).collect();
        Ok(Self { obstacle, sides })
    }
}

/// That all parts keep off all obstacles that they can meet on pieces that follow one another; `from` is where they begin. Obstacles
/// that are none have their numbers.
///
/// # Errors
/// The first stretch, part and obstacle of which it is not shown.
pub fn stay_off(
    chain: &Chain,
    pieces: &[Piece],
    from: &Point,
    parts: &[Part],
    obstacles: &[Option<Standing>],
) -> Result<(), CheckError> {
    let (mut sides, mut sided) = (Vec::new(), Vec::new());
    for (number, standing) in obstacles.iter().enumerate() {
        for side in standing.iter().flat_map(|standing| &standing.sides) {
            sides.push(side);
            sided.push(number);
        }
    }
    let mut pairs = Vec::new();
    for (number, part) in parts.iter().enumerate() {
        pairs.extend((0..sides.len()).filter(|side| part.meets[sided[*side]]).map(|side| [number, side]));
    }
    let solids: Vec<&Solid> = parts.iter().map(|part| part.solid).collect();
    keep_off(chain, pieces, (&solids, &sides), pairs).map_err(|Open { knot, solid, side }| {
        let Part { name, keeps, .. } = parts[solid];
        CheckError::Fails(format!(
            "from knot {knot} to the next {name} is not shown to stay {keeps} obstacle {}",
            sided[side]
        ))
    })?;
    // Off all borders all the time, it is inside an obstacle if it is at first.
    for part in parts {
        let corner = part.solid.corner_at(chain, from);
        for (number, standing) in obstacles.iter().enumerate().filter(|(number, _)| part.meets[*number]) {
            let surrounds = |standing: &Standing| standing.obstacle.surrounds(&corner, &guard());
            if standing.as_ref().is_some_and(|standing| surrounds(standing) != Some(false)) {
                return CheckError::fails(format!("{} is inside obstacle {number}", part.name));
            }
        }
    }
    Ok(())
}
