//! The coordination diagram: the times of one arm along its motion against those of the other, and the rectangles in which
//! the arms are not proven to be apart.

use crate::between::{Between, Placed, Swept};
use crate::curve::Curve;
use crate::stage::StagePairs;
use cplan_interrupt::checkpoint;
use cplan_motion::Span;
use std::collections::HashMap;
use std::rc::Rc;

/// A rectangle of the diagram in which the arms are not proven to keep their clearance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rectangle {
    /// For each arm, the times at which the rectangle begins and ends, seconds.
    pub times: [[f64; 2]; 2],
    /// For each arm, the leg to which it belongs.
    pub legs: [usize; 2],
    /// True if the arms are proven to be too near to each other in the whole rectangle.
    pub is_collision: bool,
}

/// A span of one arm's motion, with its links.
#[derive(Clone)]
struct Side {
    span: Span,
    placed: Rc<Placed>,
    swept: Rc<Swept>,
}

/// The spans of both arms in one pair of legs. Each is computed once.
struct Sides<'a, 'b> {
    between: &'a Between<'b>,
    curves: [&'a Curve; 2],
    known: [HashMap<SpanKey, Side>; 2],
}

/// The places at which a span begins and ends, with the shares as bits.
type SpanKey = [(usize, u64); 2];

impl Sides<'_, '_> {
    fn get(&mut self, arm: usize, span: Span) -> Side {
        let (between, curve) = (self.between, self.curves[arm]);
        let side = || {
            let (middle, deviation) = curve.deviation(span);
            let placed = Rc::new(between.placed(arm, middle, deviation));
            Side { span, placed, swept: Rc::new(between.swept(arm, middle, deviation)) }
        };
        let key = span.ends().map(|(piece, share)| (piece, share.to_bits()));
        self.known[arm].entry(key).or_insert_with(side).clone()
    }
}

/// Returns the rectangles in which two motions are not proven to keep the clearance, and `margin` metres more. The links of
/// each arm move by at most `resolution` metres within a rectangle, unless a collision is proven in all of it.
pub(crate) fn rectangles(pairs: &StagePairs, curves: [&Curve; 2], margin: f64, resolution: f64) -> Vec<Rectangle> {
    let required = pairs.clearance() + margin;
    let mut found = Vec::new();
    for (one, two) in (0..curves[0].legs()).flat_map(|one| (0..curves[1].legs()).map(move |two| (one, two))) {
        let legs = [one, two];
        let between = pairs.between([0, 1].map(|arm| curves[arm].stage(legs[arm])));
        let mut sides = Sides { between, curves, known: [HashMap::new(), HashMap::new()] };
        let mut open = vec![[0, 1].map(|arm| sides.get(arm, curves[arm].leg(legs[arm])))];
        while let Some(both) = open.pop() {
            checkpoint();
            let placed = both.each_ref().map(|side| &*side.placed);
            let least = between.distance(placed, required).least;
            if least > 0.0 && least >= required {
                continue;
            }
            let moves = placed.map(Placed::farthest_motion);
            let is_collision = between.surely_collide(both.each_ref().map(|side| &*side.swept));
            let order = if moves[0] >= moves[1] { [0, 1] } else { [1, 0] };
            let halves = order.into_iter().filter(|arm| moves[*arm] > resolution && !is_collision);
            let halves = halves.filter_map(|arm| Some((arm, both[arm].span.halves()?))).next();
            match halves {
                Some((arm, halves)) => open.extend(halves.map(|span| {
                    let mut both = both.clone();
                    both[arm] = sides.get(arm, span);
                    both
                })),
                None => {
                    let times = [0, 1].map(|arm| curves[arm].times(both[arm].span));
                    found.push(Rectangle { times, legs, is_collision });
                }
            }
        }
    }
    found
}
