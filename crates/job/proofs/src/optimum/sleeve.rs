//! Finds the portals that a path passes among strips that were cut after the path was found.

use super::strips::{Cell, Strips};
use cplan_geometry::Point;
use cplan_model::space::Portal;

/// Returns a free interval of joint 2 on a slice as a portal. `ahead` is true if joint 1 grows along the path there.
fn portal(slice: f64, [lower, upper]: [f64; 2], ahead: bool) -> Portal {
    let (left, right) = if ahead { (upper, lower) } else { (lower, upper) };
    Portal { left: Point::new(slice, left), right: Point::new(slice, right) }
}

impl Strips<'_> {
    /// Returns the portals that a path passes, in order. On a new slice, chooses the portal nearest to the path among those that
    /// the previous cell reaches. Returns `None` if these portals do not lead to the path's end.
    ///
    /// Where the path turns back around the end of a wall, the portals follow the wall to its current end.
    pub fn sleeve(&mut self, corners: &[Point]) -> Option<Vec<Portal>> {
        let goal = *corners.last()?;
        let (mut at, mut ahead, mut sleeve) = (corners[0], None, Vec::new());
        for ends in corners.windows(2) {
            let (from, to) = (ends[0], ends[1]);
            if from.x == to.x {
                let onwards = ahead.take()?;
                at = self.around_end(at, to, onwards, &mut sleeve)?;
                continue;
            }
            let onwards = *ahead.insert(from.x < to.x);
            loop {
                let (slice, cell) = self.next(at, onwards)?;
                let x = self.q1(slice);
                if x != to.x && (x < to.x) != onwards || x == goal.x && to == goal {
                    break;
                }
                let y = from.y + (to.y - from.y) * ((x - from.x) / (to.x - from.x));
                let free = self.free_in(slice, y, cell, onwards)?;
                sleeve.push(portal(x, free, onwards));
                at = Point::new(x, y.clamp(free[0], free[1]));
                if x == to.x {
                    break;
                }
            }
        }
        let (slice, cell) = self.next(at, ahead?)?;
        let (from, to) = if ahead? { (slice - 1, slice) } else { (slice, slice + 1) };
        let [from, to] = [from, to].map(|slice| self.q1(slice));
        let [lower, upper] = cell.at((goal.x - from) / (to - from));
        (from <= goal.x && goal.x <= to && lower <= goal.y && goal.y <= upper).then_some(sleeve)
    }

    /// Adds the portals of a path between two places on a slice that goes around the end of a wall. They lead along one side of
    /// the wall to its end, and back along the other. Returns the place where the path is then. `None` if the wall has no end,
    /// because it extends around a whole turn of a joint.
    fn around_end(&mut self, from: Point, to: Point, ahead: bool, sleeve: &mut Vec<Portal>) -> Option<Point> {
        let slice = self.strips_at(to.x).last().copied().filter(|slice| self.q1(*slice) == to.x && from.x == to.x)?;
        let mut sides = [from, to];
        let mut back = vec![portal(to.x, self.free_around(slice, to.y)?, !ahead)];
        while let [Some(there), Some(beside)] = sides.map(|side| self.next(side, ahead)) {
            let (slice, x) = (there.0, self.q1(there.0));
            let [Some(first), Some(second)] = [(sides[0], there.1), (sides[1], beside.1)]
                .map(|(side, cell)| self.free_in(slice, side.y, cell, ahead))
            else {
                break;
            };
            if first == second {
                break;
            }
            sleeve.push(portal(x, first, ahead));
            back.push(portal(x, second, !ahead));
            let nearest = |y: f64, free: [f64; 2]| Point::new(x, y.clamp(free[0], free[1]));
            sides = [nearest(sides[0].y, first), nearest(sides[1].y, second)];
            if back.len() > self.count() {
                return None;
            }
        }
        sleeve.extend(back.into_iter().rev());
        Some(to)
    }

    /// Returns the next slice of a path from a place, and the cell in between.
    fn next(&mut self, from: Point, ahead: bool) -> Option<(i64, Cell)> {
        let around = self.strips_at(from.x);
        let strip = *if ahead { around.last() } else { around.first() }?;
        let ends = [self.q1(strip), self.q1(strip + 1)];
        let cell = self.cell(strip, (from.x - ends[0]) / (ends[1] - ends[0]), from.y)?;
        Some((if ahead { strip + 1 } else { strip }, cell))
    }

    /// Returns the free interval nearest to `q2` on the slice through which a path leaves a cell.
    fn free_in(&mut self, slice: i64, q2: f64, cell: Cell, ahead: bool) -> Option<[f64; 2]> {
        let [lower, upper] = cell.at(if ahead { 1.0 } else { 0.0 });
        self.nearest_free(slice, q2, |portal| lower <= portal.lower && portal.upper <= upper)
    }
}
