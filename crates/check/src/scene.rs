//! Shapes that are carried, among obstacles.

use crate::curve::Piece;
use crate::error::CheckError;
use crate::free::{Chain, Edge, Open, Side, Solid, guard, keep_off};
use crate::interval::Point;
use crate::obstacle::Obstacle;
use crate::overlap::Shape;
use std::rc::Rc;

/// A shape that is carried.
pub struct Part<'a> {
    /// Its name, in words.
    pub name: String,
    /// How far it has to keep, in words.
    pub keeps: &'a str,
    /// Its shape.
    pub solid: &'a Solid,
    /// Of each obstacle, whether they can meet.
    pub meets: Vec<bool>,
}

/// An obstacle in its place, or on its way.
pub struct Present {
    /// The obstacle.
    pub obstacle: Obstacle,
    /// What shapes keep off, to keep off it.
    pub edges: Vec<Edge>,
}

impl Present {
    /// An obstacle as what moves by a chain sees it.
    ///
    /// # Errors
    /// As [`Obstacle::sides`].
    pub fn new(chain: &Chain, obstacle: Obstacle) -> Result<Self, CheckError> {
        let edge = |side: Shape| match &obstacle.course {
            None => Edge::Still(Side::new(chain, &side)),
            Some(course) => Edge::Moving(side, Rc::clone(course)),
        };
        let edges = obstacle.sides()?.into_iter().map(edge).collect();
        Ok(Self { obstacle, edges })
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
    obstacles: &[Option<Present>],
) -> Result<(), CheckError> {
    let (mut edges, mut owners) = (Vec::new(), Vec::new());
    for (number, present) in obstacles.iter().enumerate() {
        for edge in present.iter().flat_map(|present| &present.edges) {
            edges.push(edge);
            owners.push(number);
        }
    }
    let mut pairs = Vec::new();
    for (number, part) in parts.iter().enumerate() {
        pairs.extend((0..edges.len()).filter(|edge| part.meets[owners[*edge]]).map(|edge| [number, edge]));
    }
    let called = |number: usize| match &obstacles[number] {
        Some(present) => present.obstacle.called(number),
        None => format!("obstacle {number}"),
    };
    let solids: Vec<&Solid> = parts.iter().map(|part| part.solid).collect();
    // Where what joint 1 carries is, seen from what joint 2 carries, depends on joint 2 alone.
    let is_carried = |number: usize| obstacles[number].as_ref().is_some_and(|present| present.obstacle.is_carried());
    let (turning, standing) = pairs.into_iter().partition(|[_, edge]| is_carried(owners[*edge]));
    let of_second: Vec<Piece> = pieces.iter().map(Piece::of_second).collect();
    let kept = keep_off(chain, pieces, (&solids, &edges), standing)
        .and_then(|()| keep_off(chain, &of_second, (&solids, &edges), turning));
    kept.map_err(|Open { knot, solid, edge }| {
        let Part { name, keeps, .. } = &parts[solid];
        CheckError::Fails(format!(
            "from knot {knot} to the next {name} is not shown to stay {keeps} {}",
            called(owners[edge])
        ))
    })?;
    // Off all borders all the time, it is inside an obstacle if it is at first.
    let time = &pieces[0].time[0];
    for part in parts {
        let corner = part.solid.corner_at(chain, from);
        for (number, present) in obstacles.iter().enumerate().filter(|(number, _)| part.meets[*number]) {
            let surrounds = |present: &Present| present.obstacle.at_time(time).surrounds(&corner, &guard());
            if present.as_ref().is_some_and(|present| surrounds(present) != Some(false)) {
                return CheckError::fails(format!("{} is inside {}", part.name, called(number)));
            }
        }
    }
    Ok(())
}
