//! That no motion is shorter than some length.
//!
//! Walls are straight segments of configurations all along which a shape is too near a part of an obstacle. A shortest way past
//! them goes straight from corner to corner, which are ends of walls. Each corner gets a *potential*: no way from the start is claimed to
//! reach it sooner. It remains to be seen that a straight leg that no wall crosses is at least as long as the potential grows along it.

use crate::arm::{self, Mover};
use crate::certificate::{Bound, Certificate, Metric, Wall, rectangles};
use crate::contacts::{Contacts, Pair};
use crate::decimal::Decimal;
use crate::domain::{Axis, Rectangle, within};
use crate::ends::{End, FEW_PARTS};
use crate::error::{CheckError, Input};
use crate::interval::{BITS, Interval, Point, minus, twice};
use crate::robot::{Arm, Motion};
use crate::world::World;
use num_bigint::{BigInt, Sign};
use std::cell::Cell;
use std::collections::BTreeMap;
use std::fmt;
use std::ops::RangeInclusive;

/// Looks along a wall at the most.
const MOST_LOOKS: usize = 20_000;

/// How often a wall is halved at the most.
const MOST_CUTS: u32 = 60;

/// Copies of walls, on all turns that a way of the length can reach, at the most.
const MOST_COPIES: usize = 200_000;

/// That no motion from the start to a configuration is shorter than a length.
pub fn no_shorter(arm: &Arm, world: &World, certificate: &Certificate) -> Result<String, CheckError> {
    let Some(bound) = &certificate.bound else {
        return Err(CheckError::in_file(Input::Certificate, "it has no bound"));
    };
    let start = End::start(certificate, world)?;
    let stuck = certificate.boxes.as_deref().unwrap_or_default();
    let boxes = rectangles(stuck)?;
    let (goals, to) = match &bound.to {
        Some([a, b]) => {
            let at = arm.configuration("bound", &[[a.clone(), a.clone()], [b.clone(), b.clone()]])?;
            (vec![at], format!(" ({a}, {b})"))
        }
        None => {
            let goal = End::goal(certificate, world)?;
            let is_stuck = |part: &Rectangle| boxes.iter().any(|stuck| within(part, stuck));
            (goal.region(arm)?.places(arm, FEW_PARTS, is_stuck), format!(" the goal{}", goal.named(arm)))
        }
    };
    bound.metric.is_a_norm()?;
    let axes = arm.joints.each_ref().map(|joint| &joint.axis);
    let plane = Plane::new(bound, axes, &start.configuration(arm)?, &goals)?;
    plane.legs_are_long(&plane.corners(bound, axes)?)?;
    let contacts = Contacts::new(arm, world, certificate, certificate.clearance(world)?)?;
    contacts.hold(arm, stuck, &boxes)?;
    for (number, wall) in bound.walls.iter().enumerate() {
        if !closes(arm, wall, &contacts.pair(wall.shape, wall.part, || format!("wall {number}"))?) {
            return CheckError::fails(format!("wall {number}: along it the shape can come off the part"));
        }
    }
    let [first, second] = arm.joints.each_ref().map(|joint| &joint.name);
    let (start, clearance, length) = (start.named(arm), certificate.clearance(world)?, &bound.length);
    let metric = &bound.metric;
    Ok(format!(
        "no motion of \"{first}\" and \"{second}\" from the start{start} to{to} with clearance {clearance} is shorter than {length}{metric}"
    ))
}

/// Whether a shape and a part are seen to overlap all along a wall: it is halved until each piece is, as a box, or there were too many looks.
///
/// A shape that only slides along the wall overlaps another at a convex set of places: then its ends are enough.
fn closes(arm: &Arm, wall: &Wall, &Pair { body, part, beside }: &Pair) -> bool {
    let [from, to] = [&wall.from, &wall.to].map(|end| end.each_ref().map(Interval::from));
    let along = minus(&to, &from);
    let cell = |from, along, k, cuts| arm::Cell::of_segment(from, along, k, cuts).beside(beside);
    let mover = Mover::new(arm, body);
    let turns = |k: usize| wall.from[k] != wall.to[k] && matches!(arm.joints[k].motion, Motion::Turn(_));
    if !(0..=body.link).any(turns) {
        let still = [0, 1].map(|_| Interval::whole(0));
        return [from, to].iter().all(|end| mover.overlaps(part, &cell(end, &still, 0, 0)));
    }
    let (mut left, mut last) = (vec![(0, 0)], 0);
    for _ in 0..MOST_LOOKS {
        let Some((k, cuts)) = left.pop() else { return true };
        // What is much longer than the piece before is not looked at.
        if cuts + 1 >= last && mover.overlaps(part, &cell(&from, &along, k, cuts)) {
            last = cuts;
        } else if cuts < MOST_CUTS {
            left.extend([2 * k + 1, 2 * k].map(|k| (k, cuts + 1)));
        } else {
            return false;
        }
    }
    false
}

/// A place in the plane of the metric, whose units make lengths those of the metric.
#[derive(Clone)]
struct Place {
    at: Point,
    /// The same in coarser units, from a little below to a little above.
    coarse: [[i64; 2]; 2],
    /// The value of joint 1 as it is written, and the turns from there, if it is one number.
    line: Option<Line>,
}

/// Configurations with one value of joint 1.
type Line = (Decimal, i64);

/// Places are at most so far from the origin, in coarse units: products of differences are exact in 128 bits.
const FARTHEST: i64 = 1 << 58;

/// Coarse units, of `2^-40`, are `2^COARSER` times as long.
const COARSER: u32 = BITS - 40;

/// A wall as it is met on some turn of each joint.
struct Copy {
    wall: usize,
    turns: [i64; 2],
    ends: [Place; 2],
}

/// Walls on a line that overlap one another, from end to end, and where walls end within that come from either side.
struct Run {
    ends: [Interval; 2],
    beside: [Vec<Interval>; 2],
}

/// An end of a wall at which ways may turn.
struct Corner {
    name: (usize, usize, [i64; 2]),
    at: Place,
    /// No way from there to a goal is shorter.
    rest: BigInt,
    /// No way from the start is claimed to be shorter; where nothing is claimed, the length less the rest.
    potential: Option<BigInt>,
}

/// All that ways of some length meet.
struct Plane<'a> {
    metric: &'a Metric,
    length: Interval,
    start: Place,
    /// By the least value of joint 1.
    copies: Vec<Copy>,
    /// How far a wall reaches along joint 1 at most, in coarse units.
    widest: i64,
    runs: BTreeMap<Line, Vec<Run>>,
    goals: Vec<Place>,
}

impl<'a> Plane<'a> {
    fn new(bound: &'a Bound, axes: [&Axis; 2], start: &Rectangle, goals: &[Rectangle]) -> Result<Self, CheckError> {
        let metric = &bound.metric;
        let length = Interval::from(&bound.length);
        let too_long = || CheckError::Fails(format!("the length {} leads past too much", bound.length));
        let from = Place::new(metric, start, [0, 0]).ok_or_else(too_long)?;
        // The copies of a rectangle that ways get to.
        let copies = |rectangle: &Rectangle| -> Option<Vec<([i64; 2], Place)>> {
            let turns = [0, 1].map(|k| {
                let Axis::Circle = axes[k] else { return Some(0..=0) };
                let (turn, value) =
                    (metric.scaled(k, &twice(Interval::pi())), metric.scaled(k, &Interval::around(&rectangle[k])));
                // One more on either side, for rounding.
                let least = (&from.at[k].lower - &length.upper - &value.upper) / &turn.lower - 1;
                let most = (&from.at[k].upper + &length.upper - &value.lower) / &turn.lower + 1;
                Some(i64::from(i32::try_from(least).ok()?)..=i64::from(i32::try_from(most).ok()?))
            });
            let [first, second] = turns;
            let (first, second) = (first?, second?);
            let count = |range: &RangeInclusive<i64>| range.end().abs_diff(*range.start()).saturating_add(1);
            if count(&first).saturating_mul(count(&second)) > MOST_COPIES as u64 {
                return None;
            }
            let pairs = first.flat_map(|a| second.clone().map(move |b| [a, b]));
            pairs.map(|turns| Some((turns, Place::new(metric, rectangle, turns)?))).collect()
        };
        let mut walls = Vec::new();
        for (number, wall) in bound.walls.iter().enumerate() {
            let whole =
                [0, 1].map(|k| [(&wall.from[k]).min(&wall.to[k]).clone(), (&wall.from[k]).max(&wall.to[k]).clone()]);
            for (turns, _) in copies(&whole).ok_or_else(too_long)? {
                let end = |at: &[Decimal; 2]| Place::new(metric, &at.each_ref().map(|v| [v.clone(), v.clone()]), turns);
                let (Some(a), Some(b)) = (end(&wall.from), end(&wall.to)) else { return Err(too_long()) };
                walls.push(Copy { wall: number, turns, ends: [a, b] });
            }
            if walls.len() > MOST_COPIES {
                return Err(too_long());
            }
        }
        let mut everywhere = Vec::new();
        for goal in goals {
            everywhere.extend(copies(goal).ok_or_else(too_long)?.into_iter().map(|(_, place)| place));
        }
        walls.sort_by_key(Copy::begins);
        let widest = walls.iter().map(|copy| copy.stops() - copy.begins()).max().unwrap_or(0);
        let runs = runs(&walls);
        Ok(Self { metric, length, start: from, copies: walls, widest, runs, goals: everywhere })
    }

    /// The corners that a way of less than the length may turn at.
    fn corners(&self, bound: &Bound, axes: [&Axis; 2]) -> Result<Vec<Corner>, CheckError> {
        let mut potentials = BTreeMap::new();
        for (number, potential) in bound.potentials.iter().enumerate() {
            let value = Interval::from(&potential.value).upper;
            if potential.wall >= bound.walls.len() || potential.end > 1 {
                return CheckError::fails(format!("potential {number} is at a wall or an end that is not there"));
            }
            if potentials.insert((potential.wall, potential.end, potential.turns), value).is_some() {
                return CheckError::fails(format!("potential {number} is at a corner that has one"));
            }
        }
        let mut corners = Vec::new();
        for copy in &self.copies {
            let wall = &bound.walls[copy.wall];
            for (end, values) in [&wall.from, &wall.to].into_iter().enumerate() {
                let at = &copy.ends[end];
                let is_outside = |k: usize| match axes[k] {
                    Axis::Line([low, high]) => values[k] <= *low || values[k] >= *high,
                    Axis::Circle => false,
                };
                let runs = at.line.as_ref().and_then(|line| self.runs.get(line));
                let is_within = |run: &Run| below(&run.ends[0], &at.at[1]) && below(&at.at[1], &run.ends[1]);
                if is_outside(0) || is_outside(1) || runs.is_some_and(|runs| runs.iter().any(is_within)) {
                    continue;
                }
                let rest = self.goals.iter().map(|goal| self.metric.between(&at.at, &goal.at)).min();
                let Some(rest) = rest else { continue };
                if self.metric.between(&self.start.at, &at.at) + &rest >= self.length.upper {
                    continue;
                }
                let name = (copy.wall, end, copy.turns);
                let potential = potentials.remove(&name).filter(|value| value + &rest < self.length.lower);
                corners.push(Corner { name, at: at.clone(), rest, potential });
            }
        }
        Ok(corners)
    }

    /// That no potential grows along a leg by more than the leg is long, unless a wall bars it.
    ///
    /// # Errors
    /// The leg along which one does.
    fn legs_are_long(&self, corners: &[Corner]) -> Result<(), CheckError> {
        let claimed: Vec<BigInt> = corners
            .iter()
            .map(|corner| corner.potential.clone().unwrap_or_else(|| &self.length.upper - &corner.rest))
            .collect();
        let sources = corners.iter().filter_map(|c| Some((&c.at, c.potential.as_ref()?, Some(c.name))));
        let none = BigInt::ZERO;
        for (at, potential, name) in sources.chain([(&self.start, &none, None)]) {
            // A wall that bars one leg bars many others from there.
            let latest = Cell::new(0);
            let bars = |to: &Place| self.bars(at, to, &latest);
            let from = || name.map_or_else(|| "the start".to_owned(), called);
            for goal in &self.goals {
                if !self.is_long(at, goal, &(&self.length.upper - potential)) && !bars(goal) {
                    return CheckError::fails(format!("from {} no wall bars the way to a goal", from()));
                }
            }
            for (corner, claimed) in corners.iter().zip(&claimed) {
                if !self.is_long(at, &corner.at, &(claimed - potential)) && !bars(&corner.at) {
                    let message = "the potential grows by more than the way is long, and no wall bars it";
                    return CheckError::fails(format!("from {} to {}: {message}", from(), called(corner.name)));
                }
            }
        }
        Ok(())
    }

    /// Whether a leg is at least so long.
    fn is_long(&self, from: &Place, to: &Place, length: &BigInt) -> bool {
        if length.sign() != Sign::Plus {
            return true;
        }
        // Coarse units first: most legs are much longer.
        let Ok(coarse) = i64::try_from((length >> COARSER) + 1) else { return false };
        let [x, y] = [0, 1].map(|k| {
            let ([a, b], [c, d]) = (from.coarse[k], to.coarse[k]);
            i128::from((c - b).max(a - d).max(0))
        });
        let square = i128::from(coarse).saturating_mul(coarse.into());
        let is_long = if self.metric.is_greatest() { x.max(y) >= coarse.into() } else { x * x + y * y >= square };
        is_long || self.metric.is_at_least(&from.at, &to.at, length)
    }

    /// Whether walls bar every straight leg from a place to any in a rectangle: one that it goes through, from one side to the other, or
    /// those beside it that leave no side to pass along.
    fn bars(&self, from: &Place, to: &Place, latest: &Cell<usize>) -> bool {
        if self.copies.get(latest.get()).is_some_and(|copy| copy.crosses(from, to)) {
            return true;
        }
        let [low, high] = [from.coarse[0][0].min(to.coarse[0][0]), from.coarse[0][1].max(to.coarse[0][1])];
        let first = self.copies.partition_point(|copy| copy.begins() < low - self.widest);
        let last = self.copies.partition_point(|copy| copy.begins() <= high);
        let near = &self.copies[first..last.max(first)];
        // What bars a leg is near its beginning, as a rule.
        let crosses = |copy: &Copy| copy.crosses(from, to);
        let is_onward = from.coarse[0][0] <= to.coarse[0][0];
        if let Some(at) = if is_onward { near.iter().position(crosses) } else { near.iter().rposition(crosses) } {
            latest.set(first + at);
            return true;
        }
        let Some(runs) = from.line.as_ref().filter(|_| from.line == to.line).and_then(|line| self.runs.get(line))
        else {
            return false;
        };
        let [a, b] = [&from.at[1], &to.at[1]];
        let is_passed = |y: &&Interval| below(a, y) && below(y, b) || below(b, y) && below(y, a);
        runs.iter().any(|run| run.beside.iter().all(|side| side.iter().any(|y| is_passed(&y))))
    }
}

/// The runs of upright walls, with the ends of others in them.
fn runs(copies: &[Copy]) -> BTreeMap<Line, Vec<Run>> {
    let mut runs: BTreeMap<Line, Vec<Run>> = BTreeMap::new();
    for Copy { ends: [a, b], .. } in copies {
        if let (Some(line), true) = (&a.line, a.line == b.line) {
            let mut ends = [a.at[1].clone(), b.at[1].clone()];
            if ends[1].lower < ends[0].lower {
                ends.reverse();
            }
            runs.entry(line.clone()).or_default().push(Run { ends, beside: [vec![], vec![]] });
        }
    }
    for list in runs.values_mut() {
        list.sort_by(|a, b| a.ends[0].lower.cmp(&b.ends[0].lower));
        let mut merged: Vec<Run> = Vec::new();
        for run in list.drain(..) {
            match merged.last_mut() {
                Some(last) if below(&run.ends[0], &last.ends[1]) => {
                    if last.ends[1].lower < run.ends[1].lower {
                        last.ends[1] = run.ends[1].clone();
                    }
                }
                _ => merged.push(run),
            }
        }
        *list = merged;
    }
    for Copy { ends: [a, b], .. } in copies {
        for (end, other) in [(a, b), (b, a)] {
            let side = match (below(&other.at[0], &end.at[0]), below(&end.at[0], &other.at[0])) {
                (true, _) => 0,
                (_, true) => 1,
                _ => continue,
            };
            let list = end.line.as_ref().and_then(|line| runs.get_mut(line));
            let is_within = |run: &&mut Run| below(&run.ends[0], &end.at[1]) && below(&end.at[1], &run.ends[1]);
            if let Some(run) = list.and_then(|list| list.iter_mut().find(is_within)) {
                run.beside[side].push(end.at[1].clone());
            }
        }
    }
    runs
}

impl Place {
    /// The copy of a rectangle on some turns; none where that is too far away.
    fn new(metric: &Metric, rectangle: &Rectangle, turns: [i64; 2]) -> Option<Self> {
        let at = [0, 1].map(|k| {
            let turns = Interval::exactly(BigInt::from(2 * turns[k]) << BITS);
            metric.scaled(k, &(&Interval::around(&rectangle[k]) + &(Interval::pi() * &turns)))
        });
        let coarse = |n: BigInt| i64::try_from(n).ok().filter(|n| n.abs() < FARTHEST);
        let both =
            at.each_ref().map(|value| Some([coarse(&value.lower >> COARSER)?, coarse((&value.upper >> COARSER) + 1)?]));
        let [first, second] = both;
        let line = (rectangle[0][0] == rectangle[0][1]).then(|| (rectangle[0][0].clone(), turns[0]));
        Some(Self { at, coarse: [first?, second?], line })
    }

    /// On which side of the line through two others it certainly is; 0 if neither.
    fn side(&self, a: &Self, b: &Self) -> i8 {
        // Coarse middles are off by less than two units, so differences by less than four.
        let middle = |place: &Self| place.coarse.map(|[low, high]| (low + high) / 2);
        let wide = |place: &Self| place.coarse.iter().any(|[low, high]| high - low > 2);
        let ([ax, ay], [bx, by], [px, py]) = (middle(a), middle(b), middle(self));
        let (ux, uy, vx, vy) = (bx - ax, by - ay, px - ax, py - ay);
        let product = |a: i64, b: i64| i128::from(a) * i128::from(b);
        let area = product(ux, vy) - product(uy, vx);
        let error = product(8, ux.abs() + uy.abs() + vx.abs() + vy.abs() + 8);
        if area.abs() > error && ![a, b, self].into_iter().any(wide) {
            return if area > 0 { 1 } else { -1 };
        }
        if self.coarse == a.coarse && self.at == a.at || self.coarse == b.coarse && self.at == b.at {
            return 0;
        }
        let (a, b, p) = (&a.at, &b.at, &self.at);
        let area = &(&(&b[0] - &a[0]) * &(&p[1] - &a[1])) - &(&(&b[1] - &a[1]) * &(&p[0] - &a[0]));
        match (area.lower.sign(), area.upper.sign()) {
            (Sign::Plus, _) => 1,
            (_, Sign::Minus) => -1,
            _ => 0,
        }
    }

    /// Whether it certainly is on one side of the line through two others, and another place on the other.
    fn is_opposite(&self, other: &Self, a: &Self, b: &Self) -> bool {
        let side = self.side(a, b);
        side != 0 && other.side(a, b) == -side
    }
}

impl Copy {
    /// Where it begins along joint 1, in coarse units, ...
    fn begins(&self) -> i64 {
        self.ends[0].coarse[0][0].min(self.ends[1].coarse[0][0])
    }

    /// ... and where it ends.
    fn stops(&self) -> i64 {
        self.ends[0].coarse[0][1].max(self.ends[1].coarse[0][1])
    }

    /// Whether every straight leg from a place to any in a rectangle goes through its inside, from one side to the other.
    fn crosses(&self, from: &Place, to: &Place) -> bool {
        let [a, b] = &self.ends;
        let apart = |k: usize| {
            let ends = |place: &Place| place.coarse[k];
            ends(a)[0].min(ends(b)[0]) > ends(from)[1].max(ends(to)[1])
                || ends(a)[1].max(ends(b)[1]) < ends(from)[0].min(ends(to)[0])
        };
        !apart(0) && !apart(1) && from.is_opposite(to, a, b) && a.is_opposite(b, from, to)
    }
}

/// Whether the first is certainly below the second.
fn below(a: &Interval, b: &Interval) -> bool {
    a.upper < b.lower
}

/// How far two rectangles are from each other along each axis, at least.
fn apart(a: &Point, b: &Point) -> [BigInt; 2] {
    [0, 1].map(|k| (&b[k].lower - &a[k].upper).max(&a[k].lower - &b[k].upper).max(BigInt::ZERO))
}

/// An end of a wall, for messages.
fn called((wall, end, turns): (usize, usize, [i64; 2])) -> String {
    let end = ["begins", "ends"][end];
    match turns {
        [0, 0] => format!("where wall {wall} {end}"),
        [first, second] => format!("where wall {wall} {end}, {first} and {second} turns on"),
    }
}

impl fmt::Display for Metric {
    /// What follows on a length.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Euclidean => Ok(()),
            Self::Weights([a, b]) => write!(f, ", with the joints' values times {a} and {b}"),
            Self::Speeds([a, b]) => write!(f, " s, at speeds of the joints of no more than {a} and {b}"),
        }
    }
}

impl Metric {
    fn is_a_norm(&self) -> Result<(), CheckError> {
        let (Self::Weights(factors) | Self::Speeds(factors)) = self else { return Ok(()) };
        let is_positive = |factor: &Decimal| Interval::from(factor).lower.sign() == Sign::Plus;
        // Whole turns have to be of some length.
        let tells = |k: usize| self.scaled(k, &Interval::whole(1)).lower.sign() == Sign::Plus;
        if factors.iter().all(is_positive) && tells(0) && tells(1) {
            return Ok(());
        }
        CheckError::fails("the metric's weights or speeds are not greater than 0, or too great")
    }

    /// Whether lengths are the greatest entry's; or else they are the root of the sum of squares.
    fn is_greatest(&self) -> bool {
        matches!(self, Self::Speeds(_))
    }

    /// A joint's value in the units of the metric.
    fn scaled(&self, joint: usize, value: &Interval) -> Interval {
        match self {
            Self::Euclidean => value.clone(),
            Self::Weights(weights) => value * &Interval::from(&weights[joint]),
            Self::Speeds(speeds) => value.divided(&Interval::from(&speeds[joint])),
        }
    }

    /// No way from one place to any in a rectangle is shorter than this.
    fn between(&self, a: &Point, b: &Point) -> BigInt {
        let [x, y] = apart(a, b);
        if self.is_greatest() { x.max(y) } else { crate::interval::length(&[x, y].map(Interval::exactly)).lower }
    }

    /// Whether no way from one place to any in a rectangle is shorter than a length above 0.
    fn is_at_least(&self, a: &Point, b: &Point, length: &BigInt) -> bool {
        let [x, y] = apart(a, b);
        if self.is_greatest() { x.max(y) >= *length } else { &x * &x + &y * &y >= length * length }
    }
}
