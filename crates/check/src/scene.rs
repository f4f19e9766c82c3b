//! Checks that moving shapes keep away from obstacles along a motion.

use crate::curve::Piece;
use crate::error::CheckError;
use crate::free::{Chain, Edge, EvidenceGap, Side, Solid, check_distances, guard};
use crate::interval::Point;
use crate::obstacle::Obstacle;
use crate::overlap::Shape;
use std::rc::Rc;

/// A shape that the arm moves.
pub struct Part<'a> {
    /// Name for messages.
    pub name: String,
    /// Required distance from obstacles, in words for messages.
    pub keeps: &'a str,
    /// Shape of the part.
    pub solid: &'a Solid,
    /// For each obstacle, true if the part can collide with it.
    pub meets: Vec<bool>,
}

/// An obstacle with its edges, prepared for checks.
pub struct PlacedObstacle {
    /// The obstacle.
    pub obstacle: Obstacle,
    /// Edges from which shapes must keep away.
    pub edges: Vec<Edge>,
}

impl PlacedObstacle {
    /// Prepares an obstacle for checks against shapes that move with a chain.
    ///
    /// # Errors
    /// Same as [`Obstacle::sides`].
    pub fn new(chain: &Chain, obstacle: Obstacle) -> Result<Self, CheckError> {
        let edge = |side: Shape| match &obstacle.trajectory {
            None => Edge::Still(Side::new(chain, &side)),
            Some(trajectory) => Edge::Moving(side, Rc::clone(trajectory)),
        };
        let edges = obstacle.sides()?.into_iter().map(edge).collect();
        Ok(Self { obstacle, edges })
    }
}

/// Checks along consecutive pieces of a motion that all parts keep away from all obstacles with which they can collide.
/// `from` is the first configuration. `None` stands for an obstacle that is absent during these pieces.
///
/// # Errors
/// The first stretch, part and obstacle for which this is not shown.
pub fn check_parts_clear(
    chain: &Chain,
    pieces: &[Piece],
    from: &Point,
    parts: &[Part],
    obstacles: &[Option<PlacedObstacle>],
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
    // Parts that joint 2 carries move relative to obstacles that joint 1 carries. This motion depends only on joint 2.
    let is_carried = |number: usize| obstacles[number].as_ref().is_some_and(|present| present.obstacle.is_carried());
    let (turning, standing) = pairs.into_iter().partition(|[_, edge]| is_carried(owners[*edge]));
    let of_second: Vec<Piece> = pieces.iter().map(Piece::of_second).collect();
    let kept = check_distances(chain, pieces, (&solids, &edges), standing)
        .and_then(|()| check_distances(chain, &of_second, (&solids, &edges), turning));
    kept.map_err(|EvidenceGap { knot, solid, edge }| {
        let Part { name, keeps, .. } = &parts[solid];
        CheckError::Fails(format!("after knot {knot}, {name} is not proven to stay {keeps} {}", called(owners[edge])))
    })?;
    // A part that never touches the border of an obstacle can be inside only if it is inside at the beginning.
    let time = &pieces[0].time[0];
    for part in parts {
        let corner = part.solid.corner_at(chain, from);
        for (number, present) in obstacles.iter().enumerate().filter(|(number, _)| part.meets[*number]) {
            let surrounds = |present: &PlacedObstacle| present.obstacle.at_time(time).surrounds(&corner, &guard());
            if present.as_ref().is_some_and(|present| surrounds(present) != Some(false)) {
                return CheckError::fails(format!("{} is inside {}", part.name, called(number)));
            }
        }
    }
    Ok(())
}
