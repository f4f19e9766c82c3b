//! Places where a wall begins, grows, splits or merges suddenly, as at the tip of a C-obstacle. Slices near such a jump
//! improve the bound more than slices where walls change smoothly.

use super::closed::Wall;
use super::strips::{MIN_STRIP_WIDTH, PORTAL_TOLERANCE, Strips};
use cplan_geometry::Point;
use cplan_model::Pair;
use std::f64::consts::TAU;

/// A wall jumps if at least this share of its change over a strip occurs in one half of the strip. At a smooth tip, the share is
/// smaller.
const MIN_JUMP_SHARE: f64 = 0.85;

/// Returns the change of walls between two slices: the sum of the changes of their ends. Infinite if the numbers of walls differ.
fn change(there: &[[f64; 2]], beyond: &[[f64; 2]]) -> f64 {
    if there.len() != beyond.len() {
        return f64::INFINITY;
    }
    let ends = there.as_flattened().iter().zip(beyond.as_flattened());
    ends.map(|(a, b)| (a - b).abs()).sum()
}

impl Strips<'_> {
    /// Returns values of joint 1, ascending, that approach a place where a wall jumps. The place is between `closed`, where the
    /// pair makes the wall, and `until`. Bisection locates it up to `width`. Returns nothing if the wall changes smoothly.
    fn towards_jump(&mut self, number: usize, [closed, until]: [f64; 2], wall: [f64; 2], width: f64) -> Vec<f64> {
        let (mut with, mut without) = (closed, until);
        let (mut there, mut beyond) = (vec![wall], self.walls_about(number, until, wall));
        let mut cuts = Vec::new();
        while (without - with).abs() > width.max(MIN_STRIP_WIDTH) {
            let middle = f64::midpoint(with, without);
            let between = self.walls_about(number, middle, wall);
            let (near, far) = (change(&there, &between), change(&between, &beyond));
            let greater = f64::max(near, far);
            if greater.is_finite() && greater <= MIN_JUMP_SHARE * (near + far) {
                // There is no jump, or it is so near that the rest counts as smooth.
                break;
            }
            cuts.push(middle);
            if near > far { (without, beyond) = (middle, between) } else { (with, there) = (middle, between) }
        }
        cuts.sort_unstable_by(f64::total_cmp);
        cuts
    }

    /// Returns the walls of a pair at `q1` that meet a given wall.
    fn walls_about(&mut self, number: usize, q1: f64, wall: [f64; 2]) -> Vec<[f64; 2]> {
        let round = self.topology().ranges[1].is_circle();
        let middle = f64::midpoint(wall[0], wall[1]);
        let near = |at: &Wall| {
            let turns = if round { ((middle - f64::midpoint(at.lower, at.upper)) / TAU).round() * TAU } else { 0.0 };
            [at.lower + turns, at.upper + turns]
        };
        let walls = self.closed.walls_of(number, q1);
        walls.iter().map(near).filter(|at| at[0] <= wall[1] && wall[0] <= at[1]).collect()
    }

    /// Returns the values of joint 1 at which to cut a strip because a path in it enters a wall of a pair. They approach the
    /// jumps of the wall on either side.
    pub fn towards_jumps(&mut self, index: usize, pair: Pair, at: Point, width: f64) -> Vec<f64> {
        let Some(number) = self.closed.number(pair) else { return Vec::new() };
        let walls = self.walls_about(number, at.x, [at.y; 2]);
        let &[wall] = walls.as_slice() else { return Vec::new() };
        let [from, to] = self.ends(index);
        let mut cuts = self.towards_jump(number, [at.x, from], wall, width);
        cuts.extend(self.towards_jump(number, [at.x, to], wall, width));
        cuts
    }

    /// Returns the values of joint 1 at which to cut a strip because a wall ends in it. The wall contains `q2` on the slice after
    /// the strip, or before it if `after` is false. Returns nothing if the wall continues through the strip.
    pub fn towards_tip(&mut self, index: usize, after: bool, q2: f64, width: f64) -> Vec<f64> {
        let [from, to] = self.ends(index);
        let (with, without) = if after { (to, from) } else { (from, to) };
        let round = self.topology().ranges[1].is_circle();
        let ends_here = |end: f64| {
            let off = if round { (end - q2) - ((end - q2) / TAU).round() * TAU } else { end - q2 };
            off.abs() <= PORTAL_TOLERANCE
        };
        let walls = self.closed.walls(with);
        let ending = walls.iter().find(|wall| ends_here(wall.lower) || ends_here(wall.upper));
        ending.map_or_else(Vec::new, |wall| {
            self.towards_jump(wall.pair, [with, without], [wall.lower, wall.upper], width)
        })
    }
}
