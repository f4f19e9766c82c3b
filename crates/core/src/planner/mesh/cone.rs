//! Cones of sight, edge by edge through the triangles.

use super::corners::{Corner, Tangency};
use super::{Mesh, next, previous};
use crate::space::Segment;
use cplan_geometry::{Orientation, Point, orientation};

/// A ray from a root, as a directed line through it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    /// A point of the line, from which it is directed.
    pub from: Point,
    /// Another point, ahead of the first.
    pub to: Point,
}

impl Bound {
    /// Returns the side of the line on which `p` lies; exact.
    #[inline]
    pub fn side(&self, p: Point) -> Orientation {
        orientation(self.from, self.to, p)
    }

    /// Returns true if it points to a greater abscissa, or straight up.
    fn is_forward(&self) -> bool {
        (self.to.x, self.to.y) > (self.from.x, self.from.y)
    }
}

/// All rays from a root between a ray to the `right` and one to the `left`, which are less than half a turn but not
/// zero apart. The rays leave a triangle through its half-edge `edge`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cone {
    /// The half-edge through which the rays leave the triangle.
    pub edge: u32,
    /// The ray that bounds them clockwise.
    pub right: Bound,
    /// The ray that bounds them counter-clockwise.
    pub left: Bound,
}

impl Cone {
    /// Returns true if any ray points to a greater abscissa, or straight up.
    fn is_forward(&self) -> bool {
        self.right.is_forward() || self.left.is_forward()
    }

    /// Returns true if `p` lies on one of the rays or on the line of one before the root.
    fn holds(&self, p: Point) -> bool {
        self.right.side(p) != Orientation::Clockwise && self.left.side(p) != Orientation::CounterClockwise
    }

    /// Returns the part of a segment that lies on the rays or on their lines before the root; exact for a point.
    pub fn part(&self, segment: &Segment) -> Option<Segment> {
        if segment.is_point() {
            return self.holds(segment.ends()[0]).then_some(*segment);
        }
        segment.left_of(self.right.from, self.right.to)?.left_of(self.left.to, self.left.from)
    }
}

/// The crossing of a cone and the triangle behind its edge.
#[derive(Debug, Clone, Copy)]
pub struct Crossing {
    /// The half-edge by which it enters.
    pub entry: u32,
    /// The half-edge that begins at the corner ahead, if the root sees that.
    pub seen: Option<u32>,
    /// The continuation of the cone.
    pub beyond: ConeContinuation,
}

/// The continuation of a cone behind a triangle.
#[derive(Debug, Clone, Copy)]
pub enum ConeContinuation {
    /// The whole cone continues through this edge, past the corner ahead.
    Through(u32),
    /// The cone continues on one side of the corner, which lies on one of its bounds.
    One(Cone),
    /// The cone continues to the right of the corner and to the left of it.
    Two(Cone, Cone),
}

/// The view of a triangle from a root at one of its corners, or within it.
#[derive(Debug, Clone, Copy)]
pub struct Successor {
    /// The cone through an edge that the root does not lie on.
    pub cone: Cone,
    /// Half-edges that begin at the right and the left end of that edge, if they are seen.
    pub seen: [Option<u32>; 2],
}

/// Directions to look in from a corner.
#[derive(Debug, Clone, Copy)]
pub enum ViewDirections {
    /// All directions of free space.
    Around,
    /// Directions from a ray to the right to one to the left, less than half a turn apart.
    Between(Bound, Bound),
}

impl Corner {
    /// Returns the directions in which a shortest path from `p` may continue that turns at this corner: from straight
    /// ahead to along the obstacle. `None` if the line from `p` enters the obstacle.
    pub fn beyond(&self, p: Point) -> Option<ViewDirections> {
        let ahead = Bound { from: p, to: self.at };
        match self.tangency(p) {
            Tangency::None => None,
            Tangency::Left => Some(ViewDirections::Between(ahead, self.along(self.left))),
            Tangency::Right => Some(ViewDirections::Between(self.along(self.right), ahead)),
            Tangency::Both => Some(ViewDirections::Around),
        }
    }

    /// Returns the directions of lines through the corner that do not enter the obstacle there.
    pub fn tangents(&self) -> impl Iterator<Item = ViewDirections> {
        let away = |from: Point| Bound { from, to: self.at };
        let gazes = match orientation(self.at, self.right, self.left) {
            Orientation::Collinear => [Some(ViewDirections::Around), None],
            _ => [
                Some(ViewDirections::Between(self.along(self.right), away(self.left))),
                Some(ViewDirections::Between(away(self.right), self.along(self.left))),
            ],
        };
        gazes.into_iter().flatten()
    }

    fn along(&self, to: Point) -> Bound {
        Bound { from: self.at, to }
    }
}

impl Mesh {
    /// Follows a cone from `root` into the next triangle; `None` at a wall. Exact.
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

    /// Calls `meet` with each triangle that is seen from a root in a cone, together with the part of the cone there.
    /// Time in the number of triangles crossed; exact.
    pub fn look(&self, root: Point, cone: Cone, mut meet: impl FnMut(&Crossing, &Cone)) {
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

    /// Calls `see` with the half-edges that begin at the corners seen from a root in a cone, in no particular order.
    /// Leaves out corners in cones that lead back. Time in the number of triangles crossed; exact.
    pub fn look_forward(&self, root: Point, cone: Cone, stack: &mut Vec<Cone>, mut see: impl FnMut(u32)) {
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

    /// Returns the view from a corner into the triangles around it, from right to left, each end of an edge once.
    pub fn successors(&self, corner: &Corner, gaze: ViewDirections) -> impl Iterator<Item = Successor> + '_ {
        let root = corner.at;
        let mut spoke = Some(corner.first);
        let mut last_seen = None;
        // Between two rays that coincide nothing new is visible.
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

    /// Returns the view through an edge opposite to the root, if any of it lies within the gaze.
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

    /// Returns the view from any point of a triangle, borders included, through its edges.
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

/// Returns true if the ray `left` from `root` is strictly to the left of the ray `right`. The rays are less than half a
/// turn apart.
fn is_left_of(right: Bound, left: Bound, root: Point) -> bool {
    if left.to == root {
        // It points away from its origin.
        right.side(left.from) == Orientation::Clockwise
    } else {
        right.side(left.to) == Orientation::CounterClockwise
    }
}
