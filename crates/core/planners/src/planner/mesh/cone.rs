//! Cones of lines of sight that cross the triangulation from edge to edge.

use super::corners::{Corner, Tangency};
use super::{Mesh, next, previous};
use cplan_geometry::{Orientation, Point, orientation};
use cplan_model::space::Segment;

/// A ray that bounds a cone, given by the directed line on which it lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    /// A point of the line.
    pub from: Point,
    /// Another point of the line, in its direction.
    pub to: Point,
}

impl Bound {
    /// Returns the side of the line on which `p` lies; exact.
    #[inline]
    pub fn side(&self, p: Point) -> Orientation {
        orientation(self.from, self.to, p)
    }

    /// Returns true if the line's direction points to greater abscissae, or straight up.
    fn is_forward(&self) -> bool {
        (self.to.x, self.to.y) > (self.from.x, self.from.y)
    }
}

/// All rays from a root between a ray to the `right` and a ray to the `left`. The angle between these two is positive
/// and less than half a turn. The rays leave a triangle through the half-edge `edge`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cone {
    /// The half-edge through which the rays leave the triangle.
    pub edge: u32,
    /// The clockwise bound.
    pub right: Bound,
    /// The counter-clockwise bound.
    pub left: Bound,
}

impl Cone {
    /// Returns true if the direction of any ray in the cone points to greater abscissae, or straight up.
    fn is_forward(&self) -> bool {
        self.right.is_forward() || self.left.is_forward()
    }

    /// Returns true if `p` lies on one of the rays, or on a ray's extension backwards beyond the root.
    fn is_on_ray(&self, p: Point) -> bool {
        self.right.side(p) != Orientation::Clockwise && self.left.side(p) != Orientation::CounterClockwise
    }

    /// Returns the part of a segment on the rays or their extensions backwards. `None` if there is none. Exact for a point.
    pub fn part(&self, segment: &Segment) -> Option<Segment> {
        if segment.is_point() {
            return self.is_on_ray(segment.ends()[0]).then_some(*segment);
        }
        segment.left_of(self.right.from, self.right.to)?.left_of(self.left.to, self.left.from)
    }
}

/// The crossing of a cone and the triangle beyond its edge.
#[derive(Debug, Clone, Copy)]
pub struct Crossing {
    /// The half-edge of the triangle through which the cone enters.
    pub entry: u32,
    /// The half-edge that begins at the corner opposite the entry. `None` if the root does not see that corner.
    pub seen: Option<u32>,
    /// The cone or cones that leave the triangle.
    pub beyond: ConeContinuation,
}

/// The continuation of a cone beyond a triangle.
#[derive(Debug, Clone, Copy)]
pub enum ConeContinuation {
    /// The whole cone leaves through this half-edge, on one side of the corner opposite the entry.
    Through(u32),
    /// The corner lies on a bound of the cone, and the cone continues on one side of it.
    One(Cone),
    /// The corner lies within the cone, which continues to the right and to the left of it.
    Two(Cone, Cone),
}

/// The view from a root through one edge of a triangle that contains the root or has it as a corner.
#[derive(Debug, Clone, Copy)]
pub struct Successor {
    /// The cone through the edge.
    pub cone: Cone,
    /// Half-edges that begin at the right and the left end of the edge. `None` for an end that is not seen.
    pub seen: [Option<u32>; 2],
}

/// The directions in which a search looks from a corner.
#[derive(Debug, Clone, Copy)]
pub enum ViewDirections {
    /// All directions of free space.
    Around,
    /// The directions between a ray to the right and one to the left, less than half a turn apart.
    Between(Bound, Bound),
}

impl Corner {
    /// Returns the directions in which a shortest path from `p` may continue after this corner, from straight ahead to
    /// along the obstacle. `None` if the line from `p` enters the obstacle.
    pub fn directions_after_turn(&self, p: Point) -> Option<ViewDirections> {
        let ahead = Bound { from: p, to: self.at };
        match self.tangency(p) {
            Tangency::None => None,
            Tangency::Left => Some(ViewDirections::Between(ahead, self.line_towards(self.left))),
            Tangency::Right => Some(ViewDirections::Between(self.line_towards(self.right), ahead)),
            Tangency::Both => Some(ViewDirections::Around),
        }
    }

    /// Returns the directions of lines through the corner that do not enter the obstacle there.
    pub fn tangents(&self) -> impl Iterator<Item = ViewDirections> {
        let away = |from: Point| Bound { from, to: self.at };
        let gazes = match orientation(self.at, self.right, self.left) {
            Orientation::Collinear => [Some(ViewDirections::Around), None],
            _ => [
                Some(ViewDirections::Between(self.line_towards(self.right), away(self.left))),
                Some(ViewDirections::Between(away(self.right), self.line_towards(self.left))),
            ],
        };
        gazes.into_iter().flatten()
    }

    fn line_towards(&self, to: Point) -> Bound {
        Bound { from: self.at, to }
    }
}

impl Mesh {
    /// Follows a cone from `root` into the triangle beyond its edge; `None` if the edge is a wall. Exact.
    #[inline]
    pub fn cross(&self, root: Point, cone: &Cone) -> Option<Crossing> {
        let entry = self.twin(cone.edge)?;
        let (onwards, back) = (next(entry), previous(entry));
        let corner = self.origin(back);
        let from_right = cone.right.side(corner);
        if from_right == Orientation::Clockwise {
            return Some(Crossing { entry, seen: None, beyond: ConeContinuation::Through(back) });
        }
        let from_left = cone.left.side(corner);
        if from_left == Orientation::CounterClockwise {
            return Some(Crossing { entry, seen: None, beyond: ConeContinuation::Through(onwards) });
        }
        let ray = Bound { from: root, to: corner };
        let right = Cone { edge: onwards, right: cone.right, left: ray };
        let left = Cone { edge: back, right: ray, left: cone.left };
        let beyond = match (from_right, from_left) {
            (Orientation::Collinear, _) => ConeContinuation::One(left),
            (_, Orientation::Collinear) => ConeContinuation::One(right),
            _ => ConeContinuation::Two(right, left),
        };
        Some(Crossing { entry, seen: Some(back), beyond })
    }

    /// Calls `meet` with each triangle that the root sees in a cone, and with the part of the cone that enters it.
    /// Exact; linear in the number of triangles crossed.
    pub fn visit_visible_triangles(&self, root: Point, cone: Cone, mut meet: impl FnMut(&Crossing, &Cone)) {
        let mut stack = vec![cone];
        while let Some(mut cone) = stack.pop() {
            while let Some(crossing) = self.cross(root, &cone) {
                meet(&crossing, &cone);
                cone = match crossing.beyond {
                    ConeContinuation::Through(edge) => Cone { edge, ..cone },
                    ConeContinuation::One(only) => only,
                    ConeContinuation::Two(right, left) => {
                        stack.push(left);
                        right
                    }
                };
            }
        }
    }

    /// Calls `see` with the half-edges that begin at the corners that the root sees in a cone, in no particular order.
    /// Skips cones that have no forward ray (see `is_forward`). Exact; linear in the number of triangles crossed.
    pub fn visit_visible_corners(&self, root: Point, cone: Cone, stack: &mut Vec<Cone>, mut see: impl FnMut(u32)) {
        stack.extend(Some(cone).filter(Cone::is_forward));
        while let Some(mut cone) = stack.pop() {
            while let Some(entry) = self.twin(cone.edge) {
                let (onwards, back) = (next(entry), previous(entry));
                let corner = self.origin(back);
                let from_right = cone.right.side(corner);
                if from_right == Orientation::Clockwise {
                    cone.edge = back;
                    continue;
                }
                let from_left = cone.left.side(corner);
                if from_left == Orientation::CounterClockwise {
                    cone.edge = onwards;
                    continue;
                }
                see(back);
                let ray = Bound { from: root, to: corner };
                let left = Cone { edge: back, right: ray, left: cone.left };
                if from_left == Orientation::Clockwise && !self.is_wall(back) && left.is_forward() {
                    stack.push(left);
                }
                cone = Cone { edge: onwards, right: cone.right, left: ray };
                if from_right == Orientation::Collinear || !cone.is_forward() {
                    break;
                }
            }
        }
    }

    /// Returns the view from a corner through the triangles around it, from right to left. Each end of an edge occurs once.
    pub fn successors(&self, corner: &Corner, gaze: ViewDirections) -> impl Iterator<Item = Successor> + '_ {
        let root = corner.at;
        let mut spoke = Some(corner.first);
        let mut last_seen = None;
        // Between two rays that coincide, nothing new is visible.
        if let ViewDirections::Between(right, left) = gaze
            && !is_left_of(right, left, root)
        {
            spoke = None;
        }
        std::iter::from_fn(move || {
            loop {
                let h = spoke?;
                spoke = self.twin(previous(h));
                let Some(mut successor) = self.successor(root, next(h), gaze) else { continue };
                if last_seen == Some(h) {
                    successor.seen[0] = None;
                }
                last_seen = successor.seen[1].and(spoke);
                return Some(successor);
            }
        })
    }

    /// Returns the view through an edge opposite the root; `None` if no part of the edge lies in the directions of
    /// `gaze`.
    fn successor(&self, root: Point, edge: u32, gaze: ViewDirections) -> Option<Successor> {
        let ends = [edge, next(edge)];
        let [x, y] = ends.map(|h| Bound { from: root, to: self.origin(h) });
        let ViewDirections::Between(right, left) = gaze else {
            return Some(Successor { cone: Cone { edge, right: x, left: y }, seen: ends.map(Some) });
        };
        let [right_to_x, right_to_y] = [x, y].map(|ray| right.side(ray.to));
        let [left_to_x, left_to_y] = [x, y].map(|ray| left.side(ray.to));
        let begins_within = right_to_x != Orientation::Clockwise && left_to_x == Orientation::Clockwise;
        let holds_right = right_to_x != Orientation::CounterClockwise && right_to_y == Orientation::CounterClockwise;
        if !begins_within && !holds_right {
            return None;
        }
        let ends_within = left_to_y != Orientation::CounterClockwise;
        let cone =
            Cone { edge, right: if begins_within { x } else { right }, left: if ends_within { y } else { left } };
        Some(Successor { cone, seen: [begins_within.then_some(ends[0]), ends_within.then_some(ends[1])] })
    }

    /// Returns the view from a point of a triangle, borders included, through the triangle's edges.
    pub fn successors_within(&self, triangle: u32, p: Point) -> impl Iterator<Item = Successor> + '_ {
        (3 * triangle..3 * triangle + 3).filter_map(move |edge| {
            let ends = [edge, next(edge)];
            let [x, y] = ends.map(|h| self.origin(h));
            (orientation(x, y, p) == Orientation::CounterClockwise).then(|| {
                let [right, left] = [x, y].map(|to| Bound { from: p, to });
                Successor { cone: Cone { edge, right, left }, seen: ends.map(Some) }
            })
        })
    }
}

/// Returns true if the ray `left` from `root` is strictly to the left of the ray `right`. The angle between them must
/// be less than half a turn.
fn is_left_of(right: Bound, left: Bound, root: Point) -> bool {
    if left.to == root {
        // The root is at the end of this ray's line, so test its other point, and reverse the sign.
        right.side(left.from) == Orientation::Clockwise
    } else {
        right.side(left.to) == Orientation::CounterClockwise
    }
}
