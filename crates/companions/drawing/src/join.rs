//! Joins curves whose ends meet, two at a time.

use crate::Point;
use std::collections::HashMap;

/// A chain of one or more open curves.
#[derive(Debug, PartialEq)]
pub(crate) struct Chain {
    /// Indices of the curves, in order along the chain.
    pub curves: Vec<usize>,
    /// Points of the chain. The last point is omitted if it equals the first.
    pub points: Vec<Point>,
    pub is_closed: bool,
    /// Greatest gap between the ends of two joined curves.
    pub gap: f64,
}

/// The places where curves end. Ends that are nearer to each other than `reach` have the same place.
struct Places {
    reach: f64,
    cells: HashMap<[i64; 2], Vec<usize>>,
    at: Vec<Point>,
}

impl Places {
    fn find(&mut self, p: Point) -> usize {
        let cell = p.map(|x| (x / self.reach).floor() as i64);
        for dx in -1..=1 {
            for dy in -1..=1 {
                let neighbor = [cell[0].saturating_add(dx), cell[1].saturating_add(dy)];
                let known = self.cells.get(&neighbor).into_iter().flatten();
                if let Some(&place) = known.into_iter().find(|&&i| distance(self.at[i], p) <= self.reach) {
                    return place;
                }
            }
        }
        self.at.push(p);
        self.cells.entry(cell).or_default().push(self.at.len() - 1);
        self.at.len() - 1
    }
}

fn distance(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Joins curves at places where exactly two curves end. Where more curves end, the connection is ambiguous. Each curve
/// must have at least two points.
pub(crate) fn joined(curves: &[Vec<Point>], reach: f64) -> Vec<Chain> {
    let mut places = Places { reach, cells: HashMap::new(), at: Vec::new() };
    let ends: Vec<[usize; 2]> =
        curves.iter().map(|curve| [curve[0], curve[curve.len() - 1]].map(|p| places.find(p))).collect();
    let mut at_place: Vec<Vec<usize>> = vec![Vec::new(); places.at.len()];
    for (curve, ends) in ends.iter().enumerate() {
        ends.iter().for_each(|&place| at_place[place].push(curve));
    }
    let mut is_used = vec![false; curves.len()];
    let mut chains = Vec::new();
    // First follow chains from their free ends. The remaining curves form closed loops.
    let is_end = |curve: usize| ends[curve].iter().position(|&place| at_place[place].len() != 2);
    let starts = (0..curves.len()).filter_map(|curve| Some((curve, is_end(curve)?)));
    for (first, side) in starts.chain((0..curves.len()).map(|curve| (curve, 0))) {
        if !is_used[first] {
            chains.push(chain(curves, &ends, &at_place, &mut is_used, first, side));
        }
    }
    chains.sort_by_key(|chain| chain.curves.iter().min().copied());
    chains
}

/// Follows the chain from one end of a curve.
fn chain(
    curves: &[Vec<Point>],
    ends: &[[usize; 2]],
    at_place: &[Vec<usize>],
    is_used: &mut [bool],
    first: usize,
    side: usize,
) -> Chain {
    let begin = ends[first][side];
    let (mut curve, mut place) = (first, begin);
    let mut chain = Chain { curves: Vec::new(), points: Vec::new(), is_closed: false, gap: 0.0 };
    loop {
        is_used[curve] = true;
        chain.curves.push(curve);
        let is_backward = ends[curve][0] != place;
        let mut points: Vec<Point> = curves[curve].clone();
        if is_backward {
            points.reverse();
        }
        if let Some(&last) = chain.points.last() {
            chain.gap = chain.gap.max(distance(last, points[0]));
            points.remove(0);
        }
        chain.points.extend(points);
        place = if is_backward { ends[curve][0] } else { ends[curve][1] };
        curve = match at_place[place][..] {
            [other, _] if !is_used[other] => other,
            [_, other] if !is_used[other] => other,
            _ => break,
        };
    }
    // A line and its way back enclose no area.
    if place == begin && at_place[place].len() == 2 && chain.points.len() > 3 {
        let last = chain.points.pop().expect("two points or more");
        chain.gap = chain.gap.max(distance(last, chain.points[0]));
        chain.is_closed = true;
    }
    chain
}
