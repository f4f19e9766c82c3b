//! Bands: intervals of `q1` in which link 1 collides, whatever `q2` is.

use super::slab::{CLOSED_FORM_ERROR, is_collision};
use cplan_geometry::{Vector, merge_in_place};
use cplan_judge::{Cell, CollisionBox, Deviation, Posture};
use cplan_model::{Contacts, on_axis};

/// Positions at which a wall of configurations is sought, as shares of the interval of `q1` in which a pair collides. Shapes
/// usually overlap most in the middle.
const WALL_POSITIONS: [f64; 5] = [0.5, 0.25, 0.75, 0.1, 0.9];

/// A stretch of joint 1's domain in which link 1 has one state.
pub(super) struct Stretch {
    pub from: f64,
    pub to: f64,
    pub kind: Kind,
}

/// State of link 1 over a stretch.
pub(super) enum Kind {
    /// Link 1 keeps its distance everywhere in the stretch.
    Free,
    /// Over some width within the stretch, link 1 is provably too near an obstacle, so no path crosses the stretch.
    Wall(CollisionBox),
    /// It is not decided whether link 1 keeps its distance.
    Unknown,
}

/// Splits the domain of joint 1 into stretches, ascending. `O(n log n)` for `n` contacts of link 1.
pub(super) fn bands(contacts: &Contacts, clearance: f64) -> Vec<Stretch> {
    let scene = contacts.scene();
    let joint = &scene.arm().joints[0];
    let (lower, upper) = joint.range.domain();
    let mut of_pairs: Vec<(usize, [f64; 2])> = Vec::new();
    let mut arcs = Vec::new();
    for index in 0..contacts.second_link_pairs().start {
        arcs.clear();
        let hits = contacts.first_link(index, clearance + CLOSED_FORM_ERROR, &mut arcs);
        on_axis(joint, hits, &arcs, |interval| of_pairs.push((index, interval)));
    }
    let mut merged: Vec<[f64; 2]> = of_pairs.iter().map(|p| p.1).collect();
    merge_in_place(&mut merged);
    let mut stretches = Vec::with_capacity(2 * merged.len() + 1);
    let mut at = lower;
    for band in merged {
        if band[0] > at {
            stretches.push(Stretch { from: at, to: band[0], kind: Kind::Free });
        }
        let within = of_pairs.iter().filter(|(_, i)| band[0] <= i[0] && i[1] <= band[1]);
        let wall = within.filter_map(|(index, interval)| wall(contacts, clearance, *index, *interval)).next();
        // A band may be a single value, where shapes graze or at the end of the domain.
        if band[0] < band[1] || wall.is_none() {
            stretches.push(Stretch { from: band[0], to: band[1], kind: wall.map_or(Kind::Unknown, Kind::Wall) });
        }
        at = band[1];
    }
    if at < upper || stretches.is_empty() {
        stretches.push(Stretch { from: at, to: upper, kind: Kind::Free });
    }
    stretches
}

/// Finds a collision box of a pair within an interval of `q1` in which the pair is too near. The box is as high as the domain.
fn wall(contacts: &Contacts, clearance: f64, index: usize, [from, to]: [f64; 2]) -> Option<CollisionBox> {
    let scene = contacts.scene();
    let (pair, lever) = (scene.pairs()[index], contacts.lever(index));
    let (bottom, top) = scene.arm().joints[1].range.domain();
    WALL_POSITIONS.iter().find_map(|share| {
        let middle = from + (to - from) * share;
        let posture = Posture::new(scene, Vector::new(middle, (bottom + top) / 2.0));
        let depth = clearance - posture.greatest(pair, Deviation::Box([0.0, 0.0]));
        // Half of the width that the depth allows. The other half is a margin for rounding in the checker.
        let half = (depth / lever / 2.0).min(middle - from).min(to - middle);
        let cell = Cell { lower: [middle - half, bottom], upper: [middle + half, top] };
        let stands = cell.lower[0] < cell.upper[0] && bottom < top;
        (stands && is_collision(scene, pair, &cell, clearance)).then_some(CollisionBox { cell, pair })
    })
}
