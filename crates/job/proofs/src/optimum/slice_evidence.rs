//! Collects evidence for a checker: the walls and barriers that close paths shorter than a bound.

use super::closed::Wall as FoundWall;
use super::strips::Strips;
use crate::evidence::{Barrier, Slice, Wall};
use cplan_geometry::OrderedF64;
use cplan_judge::{Deviation, Posture};
use cplan_model::space::Configuration;
use cplan_model::{Pair, Scene};

impl Strips<'_> {
    /// Returns all examined slices, with their walls and barriers. If link 1 collides throughout a strip, walls close both of its
    /// slices completely.
    pub fn evidence(&self, scene: &Scene) -> Vec<Slice> {
        let pairs = self.closed.by_number();
        let (bottom, top) = self.topology().ranges[1].domain();
        let count = self.strips.len();
        let round = self.topology().ranges[0].is_circle();
        let whole = |q1: f64| deepest(scene, q1).map(|pair| Wall { lower: bottom, upper: top, pair });
        let mut slices: Vec<Slice> = (0..count)
            .map(|number| {
                let strip = &self.strips[number];
                let before = number.checked_sub(1).or(round.then_some(count - 1));
                let closed = strip.closed || before.is_some_and(|before| self.strips[before].closed);
                let mut walls = found_closed(strip.walls.as_deref().unwrap_or(&[]), &pairs);
                walls.extend(whole(strip.from).filter(|_| closed));
                let found = strip.barriers.as_deref().unwrap_or(&[]);
                let barriers = found.iter().map(|&(ends, number)| Barrier { ends, pair: pairs[number] }).collect();
                Slice { q1: strip.from, walls, barriers }
            })
            .collect();
        if let Some(strip) = self.strips.last().filter(|_| !round) {
            let mut walls = found_closed(&self.last, &pairs);
            walls.extend(whole(strip.to).filter(|_| strip.closed));
            slices.push(Slice { q1: strip.to, walls, barriers: Vec::new() });
        }
        slices
    }
}

fn found_closed(walls: &[FoundWall], pairs: &[Pair]) -> Vec<Wall> {
    walls.iter().map(|wall| Wall { lower: wall.lower, upper: wall.upper, pair: pairs[wall.pair] }).collect()
}

/// Returns the pair of link 1 that overlaps most at a value of joint 1.
fn deepest(scene: &Scene, q1: f64) -> Option<Pair> {
    let posture = Posture::new(scene, Configuration::new(q1, scene.arm().joints[1].range.domain().0));
    let distance = |pair: &Pair| OrderedF64(posture.bound(*pair, Deviation::Box([0.0; 2])).here.distance);
    scene.pairs().iter().filter(|pair| pair.link == 0).min_by_key(|pair| distance(pair)).copied()
}
