//! Random and falsified certificates about lines. Each one that holds must be true by an oracle in floating point that
//! shares no code with the checker: dense samples of motion and line (discrete Fréchet distance), and IK solutions at
//! samples of a disc.

use crate::common::plane::{HALF_WIDTH, LENGTHS, P, distance, links, minus, plus, tip, turned};
use crate::common::robots::{LIMIT, two_bars};
use crate::common::verdict::{Verdict, fails, holds as is_accepted, judge, refused};
use cplan_cases as random;
use cplan_cases::dice::Dice;

/// Number of samples of a motion between two knots, and of a piece of a line.
const SAMPLES: u32 = 200;

fn mix(a: P, b: P, u: f64) -> P {
    [0, 1].map(|k| a[k] + (b[k] - a[k]) * u)
}

/// A piece of a line: straight, a cubic Bezier curve, or an arc with its radius, direction, angle and growth.
#[derive(Clone, Debug)]
enum Piece {
    Straight([P; 2]),
    Cubic([P; 4]),
    Arc(P, [f64; 4]),
}

impl Piece {
    fn at(&self, u: f64) -> P {
        match self {
            Self::Straight([a, b]) => mix(*a, *b, u),
            Self::Cubic(control) => {
                let weights = [(1.0 - u).powi(3), 3.0 * u * (1.0 - u).powi(2), 3.0 * u * u * (1.0 - u), u.powi(3)];
                [0, 1].map(|k| (0..4).map(|i| weights[i] * control[i][k]).sum())
            }
            Self::Arc([x, y], [radius, from, by, growth]) => {
                let (angle, radius) = (from + by * u, radius + growth * u);
                [x + radius * angle.cos(), y + radius * angle.sin()]
            }
        }
    }

    /// Moves the points of the piece. Arcs move as a whole.
    fn moved(&mut self, first: P, last: P) {
        let by = |p: &mut P, by: P| *p = plus(*p, by);
        match self {
            Self::Straight([a, b]) | Self::Cubic([a, _, _, b]) => {
                by(a, first);
                by(b, last);
            }
            Self::Arc(center, _) => by(center, last),
        }
    }

    fn text(&self) -> String {
        match self {
            Self::Straight(ends) => format!(r#"{{"straight": {ends:?}}}"#),
            Self::Cubic(control) => format!(r#"{{"cubic": {control:?}}}"#),
            Self::Arc(center, [radius, from, by, growth]) => {
                let growth = if *growth == 0.0 { String::new() } else { format!(r#", "growth": {growth:?}"#) };
                format!(
                    r#"{{"arc": {{"center": {center:?}, "radius": {radius:?}, "from": {from:?}, "by": {by:?}{growth}}}}}"#
                )
            }
        }
    }
}

/// Returns the arc through three points, if they are not nearly on a line and the arc is at most half a circle. If the
/// centre is displaced by `aside`, it is a spiral between the outer points, near the middle one.
fn arc(a: P, b: P, c: P, aside: P) -> Option<Piece> {
    let [u, v] = [b, c].map(|p| [p[0] - a[0], p[1] - a[1]]);
    let twice = 2.0 * (u[0] * v[1] - u[1] * v[0]);
    let [uu, vv] = [u, v].map(|w| w[0] * w[0] + w[1] * w[1]);
    if twice.abs() < 0.02 * vv {
        return None;
    }
    let away = [(v[1] * uu - u[1] * vv) / twice, (u[0] * vv - v[0] * uu) / twice];
    let center = [a[0] + away[0] + aside[0], a[1] + away[1] + aside[1]];
    let angle = |p: P| (p[1] - center[1]).atan2(p[0] - center[0]);
    let turn = (angle(c) - angle(a)).rem_euclid(std::f64::consts::TAU);
    let by = if twice > 0.0 { turn } else { turn - std::f64::consts::TAU };
    (by.abs() < std::f64::consts::PI).then(|| {
        let radii = [a, c].map(|p| distance(p, center));
        Piece::Arc(center, [radii[0], angle(a), by, if aside == [0.0; 2] { 0.0 } else { radii[1] - radii[0] }])
    })
}

/// The claim that a motion follows a line.
#[derive(Clone, Debug)]
struct Followed {
    is_cubic: bool,
    /// A time, then values and velocities.
    knots: Vec<[f64; 5]>,
    pieces: Vec<Piece>,
    places: Vec<P>,
    tolerance: f64,
}

impl Followed {
    /// Returns the joint values at a share of the time after a knot.
    fn at(&self, knot: usize, u: f64) -> P {
        let [a, b] = [knot, knot + 1].map(|k| self.knots[k]);
        let h = b[0] - a[0];
        [1, 2].map(|k| match self.is_cubic {
            false => a[k] + (b[k] - a[k]) * u,
            true => {
                let [p, q, v, w] = [a[k], b[k], a[k + 2] * h, b[k + 2] * h];
                (1.0 + 2.0 * u) * (1.0 - u).powi(2) * p
                    + u * (1.0 - u).powi(2) * v
                    + u * u * (3.0 - 2.0 * u) * q
                    + u * u * (u - 1.0) * w
            }
        })
    }

    /// Returns a motion of a few knots, and a line near the path of its tip. Some places are inside of pieces.
    fn random(dice: &mut Dice) -> Self {
        let (mut q, mut time) = ([dice.within(-1.5, 1.5), dice.within(0.5, 2.0)], 0.0);
        let mut knots = Vec::new();
        for _ in 0..2 + dice.below(4) {
            let rates = [0, 1].map(|_| dice.within(-0.6, 0.6));
            knots.push([time, q[0], q[1], rates[0], rates[1]]);
            let h = dice.within(0.1, 0.5);
            time += h;
            q = [0, 1].map(|k| (q[k] + h * (rates[k] + dice.within(-0.4, 0.4))).clamp(-2.5, 2.5));
        }
        let is_cubic = dice.chance(0.7);
        let mut claim = Self { is_cubic, knots, pieces: vec![], places: vec![[0.0, 0.0]], tolerance: 0.0 };
        let parts = 1 + dice.below(3);
        let noise = 10_f64.powf(dice.within(-5.0, -2.5));
        let moments: Vec<(usize, f64)> = (0..claim.knots.len() - 1)
            .flat_map(|knot| (1..=parts).map(move |part| (knot, part as f64 / parts as f64)))
            .collect();
        let off = |dice: &mut Dice, p: P| p.map(|c| c + noise * dice.within(-1.0, 1.0));
        let mut from = off(dice, tip(claim.at(0, 0.0)));
        let mut begin = 0;
        for (end, &(knot, share)) in moments.iter().enumerate() {
            let moment = knot as f64 + share;
            let is_last = end + 1 == moments.len();
            // Some straight pieces belong to two parts of the motion.
            if !is_last && begin == end && dice.chance(0.2) {
                claim.places.push([moment, claim.pieces.len() as f64 + dice.within(0.45, 0.55)]);
                continue;
            }
            let to = off(dice, tip(claim.at(knot, share)));
            let low = if knot as f64 == moment - share && share > 1.0 / parts as f64 {
                share - 1.0 / parts as f64
            } else {
                0.0
            };
            let middle = tip(claim.at(knot, f64::midpoint(low, share)));
            let piece = match dice.below(3) {
                0 if begin == end => {
                    let aside = if dice.chance(0.5) { off(dice, [0.0; 2]) } else { [0.0; 2] };
                    arc(from, middle, to, aside).filter(|piece| distance(piece.at(1.0), to) < 1e-9)
                }
                1 if begin == end => {
                    let step = 1e-6;
                    let [a, b] = [low, share - step].map(|u| {
                        let [p, q] = [u, u + step].map(|u| tip(claim.at(knot, u)));
                        [0, 1].map(|k| (q[k] - p[k]) / step * (share - low) / 3.0)
                    });
                    Some(Piece::Cubic([from, [from[0] + a[0], from[1] + a[1]], [to[0] - b[0], to[1] - b[1]], to]))
                }
                _ => None,
            };
            claim.pieces.push(piece.unwrap_or(Piece::Straight([from, to])));
            claim.places.push([moment, claim.pieces.len() as f64]);
            (from, begin) = (to, end + 1);
        }
        claim.tolerance = claim.paired() * dice.within(0.5, 2.0) + 1e-6;
        claim
    }

    /// Returns the greatest distance between the tip and the line if both pass at constant rates from place to place.
    fn paired(&self) -> f64 {
        let span = |pair: &[P]| {
            let ([a, u], [b, v]) = (pair[0], pair[1]);
            let (knot, piece) = (a.floor() as usize, u.floor() as usize);
            let off = |k: u32| {
                let s = f64::from(k) / f64::from(SAMPLES);
                let share = a + (b - a) * s - knot as f64;
                distance(tip(self.at(knot, share)), self.pieces[piece].at(u + (v - u) * s - piece as f64))
            };
            (0..=SAMPLES).map(off).fold(0.0, f64::max)
        };
        self.places.windows(2).map(span).fold(0.0, f64::max)
    }

    /// Returns true if motion and line can be passed together within the tolerance, up to the distance between samples.
    fn is_true(&self) -> bool {
        let samples = |count: usize, at: &dyn Fn(usize, f64) -> P| -> Vec<P> {
            let one = |k: u32| f64::from(k) / f64::from(SAMPLES);
            (0..count).flat_map(|i| (0..=SAMPLES).map(move |k| (i, one(k)))).map(|(i, u)| at(i, u)).collect()
        };
        let tips = samples(self.knots.len() - 1, &|knot, u| tip(self.at(knot, u)));
        let line = samples(self.pieces.len(), &|piece, u| self.pieces[piece].at(u));
        let step = |points: &[P]| points.windows(2).map(|pair| distance(pair[0], pair[1])).fold(0.0, f64::max);
        let most = self.tolerance + step(&tips).max(step(&line)) + 1e-9;
        let mut reached = vec![false; line.len()];
        for (i, a) in tips.iter().enumerate() {
            let mut before = false;
            for (j, b) in line.iter().enumerate() {
                let here = reached[j];
                let comes = (i == 0 && j == 0) || here || before || (j > 0 && reached[j - 1]);
                before = here;
                reached[j] = comes && distance(*a, *b) <= most;
            }
        }
        reached[line.len() - 1]
    }

    fn text(&self) -> String {
        let columns = if self.is_cubic { 5 } else { 3 };
        let knots: Vec<&[f64]> = self.knots.iter().map(|knot| &knot[..columns]).collect();
        let pieces: Vec<String> = self.pieces.iter().map(Piece::text).collect();
        let reading = if self.is_cubic { "cubic" } else { "linear" };
        format!(
            r#"{{"format": "cplan certificate 1", "answer": "found",
                "line": {{"tolerance": {:?}, "pieces": [{}], "places": {:?}}},
                "motion": {{"interpolation": ["{reading}"], "knots": {knots:?}}}}}"#,
            self.tolerance,
            pieces.join(", "),
            self.places
        )
    }

    /// Changes the claim in one respect.
    fn falsify(&mut self, dice: &mut Dice) {
        let size = self.tolerance * 10_f64.powf(dice.within(-1.0, 1.0));
        let by = [0, 1].map(|_| dice.within(-size, size));
        let piece = dice.below(self.pieces.len());
        let place = dice.below(self.places.len());
        match dice.below(8) {
            0 => self.tolerance *= dice.within(0.1, 1.0),
            1 => {
                let knot = dice.below(self.knots.len());
                (0..2).for_each(|k| self.knots[knot][1 + k] += by[k]);
            }
            2 => {
                let knot = dice.below(self.knots.len());
                (0..2).for_each(|k| self.knots[knot][3 + k] += 10.0 * by[k]);
            }
            3 => {
                // The place where two pieces meet moves, so the line stays joined.
                self.pieces[piece].moved([0.0; 2], by);
                if let Some(next) = self.pieces.get_mut(piece + 1) {
                    next.moved(by, [0.0; 2]);
                }
            }
            4 => self.pieces.swap(piece, 0),
            5 => self.places[place][0] += dice.within(-0.3, 0.3),
            6 => self.places[place][1] += dice.within(-0.3, 0.3),
            _ => drop(self.places.remove(place)),
        }
    }
}

/// Returns true if a certificate holds in a world.
fn holds(world: &str, text: &str) -> bool {
    let (code, why) = judge(&two_bars(), world, text);
    assert_ne!(code, 1, "{why}: {text}");
    code == 0
}

#[test]
fn motions_along_lines_hold_only_if_they_are_true() {
    let (mut held, mut loose, mut missed, mut refused) = (0, 0, 0, 0);
    let seeds = random::seeds(250);
    let count = seeds.end - seeds.start;
    for seed in seeds {
        let mut dice = random::dice(seed);
        let claim = Followed::random(&mut dice);
        let is_loose = claim.tolerance > 1.2 * claim.paired();
        let honest = holds("", &claim.text());
        assert!(!honest || claim.is_true(), "{seed}: {claim:?}");
        (held, loose) = (held + u64::from(honest), loose + u64::from(is_loose));
        missed += u64::from(is_loose && !honest);
        for _ in 0..4 {
            let mut false_claim = claim.clone();
            false_claim.falsify(&mut dice);
            let holds = holds("", &false_claim.text());
            assert!(!holds || false_claim.is_true(), "{seed}: {false_claim:?}");
            refused += u64::from(!holds);
        }
    }
    println!("{held} of {count} hold; {missed} of {loose} with room do not; {refused} falsified ones are refused");
    // Where a cubic has a loop, the checker may choose places from which it cannot continue.
    assert!(missed * 100 <= loose, "{missed} of {loose}");
    assert!(loose * 3 > count && held < count && refused > 2 * count, "{loose}, {held}, {refused} of {count}");
}

/// Returns both IK solutions of a place that the tip reaches.
fn solutions([x, y]: P) -> Vec<P> {
    let [a, b] = LENGTHS;
    let cosine = (x * x + y * y - a * a - b * b) / (2.0 * a * b);
    if cosine.abs() > 1.0 {
        return vec![];
    }
    [1.0, -1.0]
        .map(|side| {
            let q2 = side * cosine.acos();
            [y.atan2(x) - (b * q2.sin()).atan2(a + b * q2.cos()), q2]
        })
        .into_iter()
        .map(|q| q.map(|v| (v + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI))
        .collect()
}

/// Returns the distance of a disc's centre from each bar.
fn distances(q: P, center: P) -> P {
    [0, 1].map(|link| {
        let (from, angle) = links(q)[link];
        let [along, across] = turned(minus(center, from), -angle);
        (along - along.clamp(0.0, LENGTHS[link])).hypot((across.abs() - HALF_WIDTH).max(0.0))
    })
}

/// The claim that no motion passes a place of a line, because its IK solutions collide with discs.
#[derive(Clone, Debug)]
struct Excluded {
    place: P,
    tolerance: f64,
    discs: Vec<(P, f64)>,
    /// The middle of a box, half of its sides, the bar and the disc.
    boxes: Vec<(P, P, usize, usize)>,
}

impl Excluded {
    /// Returns a claim that is usually true: a disc on a bar of each IK solution within the limits.
    fn random(dice: &mut Dice) -> Self {
        let (far, angle) = (dice.within(0.3, 1.75), dice.within(-3.1, 3.1));
        let place = [far * angle.cos(), far * angle.sin()];
        let tolerance = 10_f64.powf(dice.within(-5.0, -2.0));
        let mut claim = Self { place, tolerance, discs: vec![], boxes: vec![] };
        for q in solutions(place).into_iter().filter(|q| q.iter().all(|v| v.abs() < LIMIT + 0.1)) {
            let (bar, share) = (dice.below(2), dice.within(0.3, 0.9));
            let (joint, angle) = links(q)[bar];
            let at = plus(joint, turned([share * LENGTHS[bar], 0.0], angle));
            let half = 10_f64.powf(dice.within(-3.0, -1.3));
            claim.boxes.push((q, [half, half * dice.within(0.5, 1.5)], bar, claim.discs.len()));
            claim.discs.push((at, dice.within(0.01, 0.1)));
        }
        claim
    }

    fn falsify(&mut self, dice: &mut Dice) {
        let chosen = dice.below(self.boxes.len().max(1));
        match dice.below(5) {
            0 => self.tolerance *= 10_f64.powf(dice.within(0.0, 2.0)),
            1 if !self.boxes.is_empty() => drop(self.boxes.remove(chosen)),
            2 if !self.boxes.is_empty() => (0..2).for_each(|k| self.boxes[chosen].0[k] += dice.within(-0.05, 0.05)),
            3 if !self.boxes.is_empty() => {
                self.discs[chosen].0 = self.discs[chosen].0.map(|c| c + dice.within(-0.2, 0.2))
            }
            _ => self.place = self.place.map(|c| c + dice.within(-0.05, 0.05)),
        }
    }

    /// Returns true if all IK solutions at samples of the disc of the tolerance collide, or are outside the limits.
    fn is_true(&self) -> bool {
        let is_free = |q: &P| {
            let hits = |(center, radius): &(P, f64)| distances(*q, *center).iter().any(|d| *d <= radius + 1e-9);
            q.iter().all(|v| v.abs() < LIMIT - 1e-9) && !self.discs.iter().any(hits)
        };
        let point = |k: u32| {
            let (far, angle) = (self.tolerance * f64::from(k % 5) / 4.0, f64::from(k) * 2.399);
            [self.place[0] + far * angle.cos(), self.place[1] + far * angle.sin()]
        };
        !(0..200).flat_map(|k| solutions(point(k))).any(|q| is_free(&q))
    }

    fn world(&self) -> String {
        let disc = |(center, radius): &(P, f64)| {
            format!("[[obstacle]]\ncircle = {{ center = {center:?}, radius = {radius:?} }}\n")
        };
        self.discs.iter().map(disc).collect()
    }

    fn text(&self) -> String {
        let parts: Vec<String> = (0..self.discs.len()).map(|k| format!(r#"{{"obstacle": {k}}}"#)).collect();
        let one = |(middle, half, bar, disc): &(P, P, usize, usize)| {
            let [lower, upper] = [-1.0, 1.0].map(|side| [0, 1].map(|k| middle[k] + side * half[k]));
            format!(r#"{{"lower": {lower:?}, "upper": {upper:?}, "shape": {bar}, "part": {disc}}}"#)
        };
        let boxes: Vec<String> = self.boxes.iter().map(one).collect();
        let [x, y] = self.place;
        format!(
            r#"{{"format": "cplan certificate 1", "answer": "infeasible",
                "line": {{"tolerance": {:?}, "pieces": [{{"straight": [[0.1, 0.1], {:?}]}}], "stretch": [1, 1]}},
                "shapes": [{{"link": "upper", "collision": 0}}, {{"link": "fore", "collision": 0}}],
                "parts": [{}], "boxes": [{}]}}"#,
            self.tolerance,
            [x, y],
            parts.join(", "),
            boxes.join(", ")
        )
    }
}

#[test]
fn excluded_places_hold_only_if_they_are_true() {
    let (mut held, mut refused) = (0, 0);
    let seeds = random::seeds(120);
    let count = seeds.end - seeds.start;
    for seed in seeds {
        let mut dice = random::dice(seed);
        let claim = Excluded::random(&mut dice);
        let honest = holds(&claim.world(), &claim.text());
        assert!(!honest || claim.is_true(), "{seed}: {claim:?}");
        held += u64::from(honest);
        for _ in 0..4 {
            let mut false_claim = claim.clone();
            false_claim.falsify(&mut dice);
            let holds = holds(&false_claim.world(), &false_claim.text());
            assert!(!holds || false_claim.is_true(), "{seed}: {false_claim:?}");
            refused += u64::from(!holds);
        }
    }
    println!("{held} of {count} hold; {refused} falsified ones are refused");
    assert!(held * 4 > count && refused * 2 > count, "{held}, {refused} of {count}");
}

/// An arc about the first joint, near full reach: at its beginning a disc excludes one solution, and at its end another
/// disc excludes the other one. Between them the solutions stay apart, which a checker with square cells cannot show.
#[test]
fn solutions_that_cannot_be_changed_near_full_reach_are_excluded() {
    let [from, by] = [0.35, 1.4];
    for radius in [1.2, 1.7, 1.79, 1.798] {
        let at = |angle: f64| [radius * angle.cos(), radius * angle.sin()];
        // The solution with the second joint on the right of the tip, and the one with it on the left.
        let right = solutions(at(from)).into_iter().find(|q| q[1] > 0.0).expect("a solution");
        let left = solutions(at(from + by)).into_iter().find(|q| q[1] < 0.0).expect("a solution");
        // The discs are beside the first bar, on the outer sides.
        let disc = |angle: f64| {
            format!("[[obstacle]]\ncircle = {{ center = [{:?}, {:?}], radius = 0.02 }}\n", angle.cos(), angle.sin())
        };
        let world = disc(right[0] - 0.04) + &disc(left[0] + 0.04);
        let of = |q: P, part: usize| {
            let [lower, upper] = [-1e-3, 1e-3].map(|off| q.map(|value| value + off));
            format!(r#"{{"lower": {lower:?}, "upper": {upper:?}, "shape": 0, "part": {part}}}"#)
        };
        let text = |boxes: &[String]| {
            format!(
                r#"{{"format": "cplan certificate 1", "answer": "infeasible",
                    "line": {{"tolerance": 0.00001, "pieces": [{}], "stretch": [0, 1]}},
                    "shapes": [{{"link": "upper", "collision": 0}}],
                    "parts": [{{"obstacle": 0}}, {{"obstacle": 1}}], "boxes": [{}]}}"#,
                Piece::Arc([0.0; 2], [radius, from, by, 0.0]).text(),
                boxes.join(", ")
            )
        };
        let boxes = [of(right, 0), of(left, 1)];
        assert!(holds(&world, &text(&boxes)), "{radius}");
        for only in &boxes {
            assert!(!holds(&world, &text(std::slice::from_ref(only))), "{radius}: one solution is left");
        }
        // Both boxes exclude the same solution.
        let again = solutions(at(from + by)).into_iter().find(|q| q[1] > 0.0).expect("a solution");
        let same = disc(right[0] - 0.04) + &disc(again[0] + 0.04);
        assert!(!holds(&same, &text(&[of(right, 0), of(again, 1)])), "{radius}: the other solution is left");
    }
}

/// A line straight away from the first joint: the tip reaches 1.8 m, and not less than 0.2 m.
#[test]
fn places_out_of_reach_need_no_boxes() {
    let text = |end: &str, tolerance: &str, stretch: &str| {
        format!(
            r#"{{"format": "cplan certificate 1", "answer": "infeasible", "boxes": [],
                "line": {{"tolerance": {tolerance}, "pieces": [{{"straight": [[0.6, 0], [{end}, 0]]}}], "stretch": {stretch}}}}}"#
        )
    };
    for (end, tolerance, stretch, is_out) in [
        ("1.9", "0.099", "[1, 1]", true),
        ("1.9", "0.1", "[1, 1]", false),
        ("1.9", "0.001", "[0.5, 1]", true),
        ("1.9", "0.001", "[0.5, 0.5]", false),
        ("0.1", "0.0999", "[1, 1]", true),
        // Within its limits, the tip does not come nearer than 0.294 m.
        ("0.1", "0.193", "[1, 1]", true),
        ("0.1", "0.195", "[1, 1]", false),
        ("1.9", "0.099", "[1, 2]", false),
        ("1.9", "0.099", "[1, 0.5]", false),
    ] {
        assert_eq!(holds("", &text(end, tolerance, stretch)), is_out, "{end} {tolerance} {stretch}");
    }
}

/// Returns the claim about a motion along a short straight line, with some members replaced.
fn simple(replace: &[(&str, &str)]) -> Verdict {
    let [a, b] = [solutions([1.2, 0.0])[0], solutions([1.2, 0.001])[0]];
    let mut text = format!(
        r#"{{"format": "cplan certificate 1", "answer": "found",
            "line": {{"tolerance": 0.0001, "pieces": [{{"straight": [[1.2, 0], [1.2, 0.001]]}}], "travels": [0],
                "places": [[0, 0], [1, 1]]}},
            "motion": {{"interpolation": ["linear"], "knots": [[0, {}, {}], [1, {}, {}]]}}}}"#,
        a[0], a[1], b[0], b[1]
    );
    for (from, to) in replace {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    judge(&two_bars(), "", &text)
}

#[test]
fn malformed_lines_are_refused_with_a_reason() {
    let proven = is_accepted(simple(&[]));
    assert!(proven.contains("a line of 1 piece, 1 of them travels, from (1.200000, 0.000000) to"), "{proven}");
    let travel = r#""travels": [0]"#;
    for (from, to, why) in [
        (travel, r#""travels": [1]"#, "must be numbers of pieces"),
        (travel, r#""travels": [0, 0]"#, "must be numbers of pieces"),
        (travel, r#""colour": [0]"#, "unknown field `colour`"),
        (r#""motion""#, r#""goal": [0, 0], "motion""#, "cannot have a start, a goal"),
        (r#""motion""#, r#""steps": [], "motion""#, "cannot have a start, a goal"),
        (r#"[{"straight": [[1.2, 0], [1.2, 0.001]]}]"#, "[]", "has no pieces"),
        ("straight", "crooked", "unknown variant `crooked`"),
        ("0.0001", "0", "the tolerance must be above 0"),
    ] {
        refused(simple(&[(from, to)]), why);
    }
    for (from, to, why) in [
        (r#""motion""#, r#""joints": ["b", "a"], "motion""#, "the second joint carries the first; swap"),
        ("[1, 1]]", "[1, 0.9]]", "are not the ends of the motion"),
        ("[[0, 0], ", "[[0, 0.1], ", "are not the ends of the motion"),
        ("[1, 1]]", "[0.6, 0.5], [0.5, 0.6], [1, 1]]", "places[2] goes back"),
        ("[1, 1]]", "[0.5, 0.6], [0.6, 0.5], [1, 1]]", "places[2] goes back"),
        ("[1, 1]]", "[0.5, 0], [0.5, 1], [1, 1]]", "not proven to stay within"),
        ("0.001]]}", "0.001]]}, {\"straight\": [[1.3, 0], [1.2, 0]]}", "piece 1 of the line does not begin"),
    ] {
        fails(simple(&[(from, to)]), why);
    }
    is_accepted(simple(&[(r#""motion""#, r#""joints": ["a", "b"], "motion""#)]));
    // A rest of the tip and one of the line are allowed if both are within the tolerance.
    is_accepted(simple(&[("0.0001", "0.0006"), ("[1, 1]]", "[0.5, 0], [0.5, 1], [1, 1]]")]));
}
