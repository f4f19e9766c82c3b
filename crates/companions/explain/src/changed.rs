//! The world after a change.

use super::change::{Change, ChangeContext, ChangeKind, middle, shrunk_pieces};
use cplan_blockers::{BlockingSet, Element, MotionQuestion};
use cplan_geometry::{Convex, Point, Pose, Vector};
use cplan_model::{Obstacle, Scene, Shape};

impl Change {
    /// Returns the question with this change. `set` is the blocking set to which the change belongs. If the change was
    /// tried with that set only, all other elements are removed.
    pub fn apply(&self, question: &MotionQuestion, set: &BlockingSet) -> MotionQuestion {
        let rest = match self.among {
            ChangeContext::World => question.clone(),
            ChangeContext::Set => question.without(&set.others(question)),
        };
        match self.element {
            Element::Obstacle { number } => match self.changed_obstacle(question.scene()) {
                Some(changed) => rest.rebuilt(|_, workspace| workspace.obstacles[number].clone_from(&changed)),
                None => rest,
            },
            Element::Link { .. } | Element::Motor => rest,
            Element::Limit { joint, side } => rest.with_wider(joint, side, self.by.opens),
            Element::Clearance => {
                let clearance = (question.scene().workspace().greatest_clearance() - self.by.opens).max(0.0);
                rest.with_clearance_at_most(clearance)
            }
        }
    }

    /// Returns the obstacle after the change. `None` if the change is not of an obstacle.
    pub fn changed_obstacle(&self, scene: &Scene) -> Option<Obstacle> {
        let Element::Obstacle { number } = self.element else { return None };
        let obstacle = scene.workspace().obstacles.get(number)?;
        let (shape, pieces) = match self.cure {
            ChangeKind::Moved { direction } => {
                let pose = Pose::translation(Vector::from(direction) * self.by.opens);
                (obstacle.shape.at(&pose), obstacle.pieces.iter().map(|piece| piece.at(&pose)).collect())
            }
            ChangeKind::Eroded => {
                let pieces = shrunk_pieces(obstacle, self.by.opens);
                let shrunk = Obstacle { pieces, ..obstacle.clone() };
                (shape_of(&shrunk.real_pieces()), shrunk.pieces)
            }
            ChangeKind::Scaled { to } => {
                let center = middle(obstacle)?.0;
                (scaled(&obstacle.shape, center, to), shrunk_pieces(obstacle, self.by.opens))
            }
            ChangeKind::Widened | ChangeKind::Lowered => return None,
        };
        Some(Obstacle { shape, pieces, ..obstacle.clone() })
    }
}

/// Returns the shape of the world file that consists of exactly these pieces, if there is one.
fn shape_of(pieces: &[Convex]) -> Shape {
    match pieces {
        [piece] if piece.core().len() == 1 => Shape::Circle { center: piece.core()[0], radius: piece.radius() },
        [piece] if piece.core().len() > 2 && piece.radius() == 0.0 => Shape::Polygon(piece.core().to_vec()),
        _ => Shape::Pieces,
    }
}

fn scaled(shape: &Shape, center: Point, share: f64) -> Shape {
    let moved = |p: &Point| center + (p - center) * share;
    let all = |points: &[Point]| points.iter().map(moved).collect();
    match shape {
        Shape::Polygon(corners) => Shape::Polygon(all(corners)),
        Shape::Circle { center, radius } => Shape::Circle { center: moved(center), radius: radius * share },
        Shape::Polyline(points) => Shape::Polyline(all(points)),
        Shape::Pieces => Shape::Pieces,
    }
}
