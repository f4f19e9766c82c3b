//! Obstacles of the suite: five kinds of worlds of convex polygons, in a rectangle that the arm reaches.

use super::{V, rounded};
use cplan_cases::dice::Dice;
use std::f64::consts::{PI, TAU};

/// Kinds of worlds.
pub const WORLDS: [&str; 5] = ["boxes", "polygons", "walls", "slots", "rings"];

/// Draws the obstacles of a world of a kind, between two corners.
pub fn obstacles(dice: &mut Dice, world: &str, [low, high]: [V; 2]) -> Vec<Vec<V>> {
    let place = |dice: &mut Dice| [0, 1].map(|k| dice.within(low[k], high[k]));
    match world {
        "boxes" => (0..4 + dice.below(7))
            .map(|_| {
                let size = [dice.within(0.05, 0.3), dice.within(0.05, 0.3)];
                bar(place(dice), dice.within(-PI, PI), size)
            })
            .collect(),
        "polygons" => (0..4 + dice.below(7)).map(|_| polygon(dice, place)).collect(),
        "walls" => (0..3 + dice.below(5))
            .map(|_| bar(place(dice), dice.within(-PI, PI), [dice.within(0.2, 0.6), 0.005]))
            .collect(),
        "slots" => (0..2 + dice.below(3)).flat_map(|_| slot(dice, place)).collect(),
        _ => (0..1 + dice.below(2)).flat_map(|_| ring(dice, place)).collect(),
    }
}

/// Returns a rectangle around a place, turned by an angle, with these half lengths of its sides.
fn bar(center: V, angle: f64, [along, across]: V) -> Vec<V> {
    let (sine, cosine) = angle.sin_cos();
    let corner = |[x, y]: V| [center[0] + x * cosine - y * sine, center[1] + x * sine + y * cosine].map(rounded);
    [[-along, -across], [along, -across], [along, across], [-along, across]].map(corner).to_vec()
}

/// Draws a convex polygon with three to seven corners on a circle, counter-clockwise.
fn polygon(dice: &mut Dice, place: impl Fn(&mut Dice) -> V) -> Vec<V> {
    let (center, radius, count) = (place(dice), dice.within(0.08, 0.35), 3 + dice.below(5));
    let part = TAU / f64::from(count);
    let mut corner = |k: i32| {
        // One corner in each equal part of the circle, and never two close together.
        let angle = part * (f64::from(k) + dice.within(0.0, 0.7));
        [center[0] + radius * angle.cos(), center[1] + radius * angle.sin()].map(rounded)
    };
    (0..count).map(&mut corner).collect()
}

/// Draws two long blocks in one line, with a gap of 5 mm to 30 cm between them.
fn slot(dice: &mut Dice, place: impl Fn(&mut Dice) -> V) -> [Vec<V>; 2] {
    let (center, angle) = (place(dice), dice.within(-PI, PI));
    let (gap, length, width) = (dice.within(0.005, 0.3), dice.within(0.2, 0.7), dice.within(0.01, 0.1));
    [-1.0, 1.0].map(|side| {
        let away = side * (length + gap / 2.0);
        bar([center[0] + away * angle.cos(), center[1] + away * angle.sin()], angle, [length, width])
    })
}

/// Draws a ring of bars around a place. In half of the rings, one bar is missing.
fn ring(dice: &mut Dice, place: impl Fn(&mut Dice) -> V) -> Vec<Vec<V>> {
    let (center, radius, count) = (place(dice), dice.within(0.2, 1.1), 6 + dice.below(7));
    let first = usize::from(dice.chance(0.5));
    let (turn, part) = (dice.within(-PI, PI), TAU / count as f64);
    let side = |k: usize| {
        let angle = turn + part * k as f64;
        let middle = [center[0] + radius * angle.cos(), center[1] + radius * angle.sin()];
        bar(middle, angle + PI / 2.0, [radius * (part / 2.0).tan() + 0.01, 0.01])
    };
    (first..count).map(side).collect()
}
