//! The proven distance between a line and a motion in polynomial pieces.
//!
//! Let a part of the motion lead the tip from `A` to `B`, and a part of the line lead from `P` to `Q`. The tip's path deviates
//! from the chord `A B` by at most an eighth of its second derivative across the chord, and the part of the line deviates from
//! `P Q` by at most an eighth of its second derivative. Suppose that the tip never moves backwards along `A B`. Then one point
//! can pass along each part, from its beginning to its end, such that the distance between both points is at most the greater of
//! `|A P|` and `|B Q|`, plus the two deviations. (This bounds the Fréchet distance, which respects the order of points.) If the
//! tip may move backwards, an eighth of the second derivative along `A B` is added. A part whose bound is too large is halved.
//!
//! The second derivative of the tip is `J q'' + H(q', q')`, with the Jacobian `J` and the Hessian `H` of the arm's kinematics.
//! [`Kinematics`] bounds the change of both along a part, so the result is valid between samples as well.

use crate::free_space::{FreeSpace, Part};
use crate::kinematics::Kinematics;
use crate::line::Line;
use cplan_geometry::{Point, Vector, perpendicular};
use cplan_handling::{Derivative, Piece};
use cplan_model::space::Configuration;
use cplan_toolpath::Curve;

/// Allowance for rounding, as a share of the lengths in the computation.
const ROUNDING: f64 = 1e-13;

/// In the free-space diagram, parts of the motion and of the line may deviate from their chords by this share of the tolerance.
const FINEST_SHARE: f64 = 1.0 / 32.0;

/// Greatest number of parts of a curve of the line in the diagram.
const MAX_PARTS: f64 = 4096.0;

/// Precision of the moment that belongs to a place in the diagram: a distance along the motion, as a share of the tolerance.
const MOMENT_SHARE: f64 = 1e-3;

/// Greatest number of steps in the search for this moment.
const MOMENT_STEPS: u32 = 40;

/// Number of times that a piece of the motion is halved for the diagram.
const MAX_PART_HALVINGS: u32 = 8;

/// Number of times that a part of the motion is halved before its bound is accepted.
const MAX_HALVINGS: u32 = 10;

/// Number of Newton steps in the search for the place nearest to a corner. Any place gives a valid bound, and the nearest one
/// gives the best.
const CORNER_STEPS: u32 = 3;

/// The next piece is considered within this distance of a corner, as a multiple of the tolerance. The tip cuts a corner of a few
/// degrees this far before it.
const LOOKAHEAD_TOLERANCES: f64 = 100.0;

/// The next piece must be nearer than the present one by at least this share of the tolerance. Where the line returns on itself,
/// both are equally near up to the deviation of the tip.
const SWITCH_SHARE: f64 = 0.1;

/// A line, an arm, and the tolerance within which bounds should be proven.
#[derive(Clone, Copy)]
pub struct Deviation<'a> {
    /// The arm.
    pub kinematics: &'a Kinematics<'a>,
    /// The line.
    pub line: &'a Line<'a>,
    /// The bound that the caller needs, metres. Greater bounds are refined.
    pub tolerance: f64,
    /// The places on the line where motions begin and end.
    pub ends: [Foot; 2],
}

/// A place on the line: a piece and its parameter.
#[derive(Debug, Clone, Copy)]
pub struct Foot {
    /// Index of the piece.
    pub piece: usize,
    /// The piece's parameter, from 0 to 1.
    pub u: f64,
}

/// A motion and a line, paired place by place.
pub struct Pairing {
    /// Moments of the motion, each with its place on the line: at the ends of the motion's pieces, and at the corners of the
    /// line. A moment is a piece of the motion plus the share of its duration. Neither moments nor places ever decrease.
    pub pairs: Vec<(f64, Foot)>,
    /// For each piece of the motion, an upper bound on its distance from the line, metres.
    pub bounds: Vec<f64>,
}

impl<'a> Deviation<'a> {
    /// Creates the deviation from a whole line.
    pub fn of_line(kinematics: &'a Kinematics<'a>, line: &'a Line<'a>, tolerance: f64) -> Self {
        let ends = [Foot { piece: 0, u: 0.0 }, Foot { piece: line.pieces.len() - 1, u: 1.0 }];
        Self { kinematics, line, tolerance, ends }
    }
}

impl Deviation<'_> {
    /// Pairs a motion with the line. `O(n)` for `n` pieces if each place of the line is near only those moments that belong to
    /// it; more if a bound exceeds the tolerance.
    pub fn pairing(&self, pieces: &[Piece]) -> Pairing {
        let advanced = self.with_bounds(pieces, self.advanced(pieces));
        if advanced.bounds.iter().all(|bound| *bound <= self.tolerance) {
            return advanced;
        }
        let space = self.free_space(pieces);
        let Ok(places) = space.pairs() else { return advanced };
        let mut latest = 0.0_f64;
        let pairs = places.into_iter().map(|(part, share, foot)| {
            let part = &space.motion[part];
            latest = latest.max(part.piece as f64 + self.moment(&pieces[part.piece], part, share));
            (latest, foot)
        });
        self.with_bounds(pieces, pairs.collect())
    }

    /// Returns the share of a piece of the motion at which the tip has covered `share` of the chord of `part`.
    fn moment(&self, piece: &Piece, part: &Part, share: f64) -> f64 {
        let Part { shares, ends: [a, b], .. } = *part;
        let (along, square) = (b - a, (b - a).norm_squared());
        if share <= 0.0 || share >= 1.0 || square <= 0.0 {
            return if share >= 1.0 { shares[1] } else { shares[0] };
        }
        let finest = MOMENT_SHARE * self.tolerance / square.sqrt();
        let [mut low, mut high] = [(shares[0], -share), (shares[1], 1.0 - share)];
        let mut u = shares[0];
        for step in 0..MOMENT_STEPS {
            // Interpolation and halving alternate, so that the search always ends soon.
            let part = if step % 2 == 0 { -low.1 / (high.1 - low.1) } else { 0.5 };
            u = low.0 + part * (high.0 - low.0);
            let ahead = (self.tip(piece, u) - a).dot(&along) / square - share;
            if ahead.abs() <= finest {
                break;
            }
            *(if ahead < 0.0 { &mut low } else { &mut high }) = (u, ahead);
        }
        u
    }

    /// Returns an upper bound, metres, on the distance between the line and each piece of a motion: the bounds of
    /// [`Self::pairing`].
    pub fn of_pieces(&self, pieces: &[Piece]) -> Vec<f64> {
        self.pairing(pieces).bounds
    }

    /// Pairs each moment with the next near place on the line. These may be the wrong places near a hairpin narrower than the
    /// tolerance, or near a piece much shorter than the tolerance.
    fn advanced(&self, pieces: &[Piece]) -> Vec<(f64, Foot)> {
        let [mut foot, last] = self.ends;
        let mut pairs = vec![(0.0, foot)];
        let Some(first) = pieces.first() else { return pairs };
        let mut begin = self.tip(first, 0.0);
        for (k, piece) in pieces.iter().enumerate() {
            let end = self.tip(piece, 1.0);
            let from = foot;
            foot = if k + 1 == pieces.len() { last } else { self.advance(foot, end, (end - begin).norm()) };
            let (mut share, mut tip) = (0.0, begin);
            for corner in from.piece..foot.piece {
                share = self.nearest(piece, share, [tip, end], self.curve(corner).end().into());
                tip = self.tip(piece, share);
                pairs.push((k as f64 + share, Foot { piece: corner, u: 1.0 }));
            }
            pairs.push(((k + 1) as f64, foot));
            begin = end;
        }
        pairs
    }

    fn with_bounds(&self, pieces: &[Piece], pairs: Vec<(f64, Foot)>) -> Pairing {
        let mut bounds = vec![0.0_f64; pieces.len()];
        let Some(first) = pieces.first() else { return Pairing { pairs, bounds } };
        let mut tip = self.tip(first, 0.0);
        for pair in pairs.windows(2) {
            let [(begin, from), (end, to)] = [pair[0], pair[1]];
            let own = (begin as usize).min(pieces.len() - 1);
            let shares = [begin, end].map(|moment| (moment - own as f64).clamp(0.0, 1.0));
            // After a corner, the next curve begins at its first end.
            let start = if from.piece == to.piece { from.u } else { 0.0 };
            let tips = [tip, self.tip(&pieces[own], shares[1])];
            let bound = self.of_part(&pieces[own], (shares, tips), to.piece, [start, to.u], 0);
            bounds[own] = bounds[own].max(bound);
            tip = tips[1];
        }
        Pairing { pairs, bounds }
    }

    /// Returns the free-space diagram of a motion and the line.
    fn free_space(&self, pieces: &[Piece]) -> FreeSpace {
        let finest = FINEST_SHARE * self.tolerance;
        let mut motion = Vec::with_capacity(pieces.len());
        for (k, piece) in pieces.iter().enumerate() {
            self.divide(piece, k, [0.0, 1.0], finest, &mut motion);
        }
        let mut line = Vec::new();
        for piece in self.ends[0].piece..=self.ends[1].piece {
            let from = if piece == self.ends[0].piece { self.ends[0].u } else { 0.0 };
            let to = if piece == self.ends[1].piece { self.ends[1].u } else { 1.0 };
            let curve = self.curve(piece);
            let count = (sag(curve, [from, to]) / finest).sqrt().ceil().clamp(1.0, MAX_PARTS);
            let share = |k: u32| if f64::from(k) < count { from + (to - from) * f64::from(k) / count } else { to };
            line.extend((0..count as u32).map(|k| {
                let shares = [share(k), share(k + 1)];
                Part { piece, shares, ends: shares.map(|u| curve.at(u).into()), off: sag(curve, shares) }
            }));
        }
        FreeSpace { motion, line, tolerance: self.tolerance }
    }

    /// Appends the parts of a piece of the motion that are close enough to their chords.
    fn divide(&self, piece: &Piece, number: usize, shares: [f64; 2], finest: f64, parts: &mut Vec<Part>) {
        let mut open = vec![(shares, 0)];
        while let Some((shares, halvings)) = open.pop() {
            let ends = shares.map(|u| self.tip(piece, u));
            let off = self.off_chord(piece, shares, ends);
            if off <= finest || halvings >= MAX_PART_HALVINGS {
                parts.push(Part { piece: number, shares, ends, off });
            } else {
                let middle = (shares[0] + shares[1]) / 2.0;
                open.extend([[middle, shares[1]], [shares[0], middle]].map(|half| (half, halvings + 1)));
            }
        }
    }

    /// Returns an upper bound on the distance between the line and the tip of a resting arm, metres.
    pub fn at_rest(&self, q: Configuration) -> f64 {
        self.of_pieces(&[Piece::line(0.0, 1.0, q, q)]).into_iter().fold(0.0, f64::max)
    }

    pub(crate) fn tip(&self, piece: &Piece, u: f64) -> Point {
        self.kinematics.arm.tip_at(piece.at(u))
    }

    pub(crate) fn curve(&self, piece: usize) -> &Curve {
        self.line.curve(piece)
    }

    fn gap(&self, piece: usize, u: f64, tip: Point) -> f64 {
        gap(self.line, piece, u, tip)
    }

    /// Returns the place on the line for the next position of the tip, which is `step` metres away.
    fn advance(&self, from: Foot, tip: Point, step: f64) -> Foot {
        advance(self.line, self.tolerance, [from, self.ends[1]], tip, step)
    }

    /// Returns a share of a piece, at least `least`, at which the tip is near a corner. `a` and `b` are the tip's positions at
    /// `least` and at the end of the piece.
    fn nearest(&self, piece: &Piece, least: f64, [a, b]: [Point; 2], corner: Point) -> f64 {
        let (chord, duration) = (b - a, piece.to - piece.from);
        let share = if chord.norm() > 0.0 { (corner - a).dot(&chord) / chord.norm_squared() } else { 0.0 };
        let mut u = (least + (1.0 - least) * share).clamp(least, 1.0);
        for _ in 0..CORNER_STEPS {
            let q = piece.at(u);
            let slope = self.kinematics.velocity(q, piece.derivative(Derivative::Velocity, u) * duration);
            if slope.norm() > 0.0 {
                let off = corner - self.kinematics.arm.tip_at(q);
                u = (u + off.dot(&slope) / slope.norm_squared()).clamp(least, 1.0);
            }
        }
        u
    }

    /// Returns the bound for a part of a piece and a part of a curve, given by shares and parameters.
    fn of_part(
        &self,
        piece: &Piece,
        (u, tips): ([f64; 2], [Point; 2]),
        curve: usize,
        w: [f64; 2],
        halvings: u32,
    ) -> f64 {
        let ends = self.gap(curve, w[0], tips[0]).max(self.gap(curve, w[1], tips[1]));
        let sag = sag(self.curve(curve), w);
        let scale = self.kinematics.arm.base.norm() + tips[0].norm() + self.kinematics.arm.reach();
        let bound = ends + sag + self.off_chord(piece, u, tips) + ROUNDING * scale;
        // Halving reduces everything except the distances of the ends.
        let is_useful = bound > self.tolerance && ends < self.tolerance;
        if !is_useful || halvings >= MAX_HALVINGS {
            return bound;
        }
        let middle = (u[0] + u[1]) / 2.0;
        let tip = self.tip(piece, middle);
        let foot = self.curve(curve).nearest([tip.x, tip.y], w[0]).min(w[1]);
        let first = ([u[0], middle], [tips[0], tip]);
        let second = ([middle, u[1]], [tip, tips[1]]);
        let bound = self.of_part(piece, first, curve, [w[0], foot], halvings + 1);
        bound.max(self.of_part(piece, second, curve, [foot, w[1]], halvings + 1))
    }

    /// Returns a bound on the Fréchet distance between the tip's path on a part of a piece and its chord.
    fn off_chord(&self, piece: &Piece, [from, to]: [f64; 2], [a, b]: [Point; 2]) -> f64 {
        let (length, chord) = (to - from, b - a);
        let middle = (from + to) / 2.0;
        let q = piece.at(middle);
        let duration = piece.to - piece.from;
        // Derivatives by the share of the part, from 0 to 1.
        let rate = |of: Derivative, u: f64, order: i32| piece.derivative(of, u) * (duration * length).powi(order);
        let bend = rate(Derivative::Acceleration, middle, 2);
        let bend_change = (rate(Derivative::Acceleration, to, 2) - rate(Derivative::Acceleration, from, 2)).abs() / 2.0;
        let slope = rate(Derivative::Velocity, middle, 1);
        // Within half of the part, the slope changes by at most this.
        let slope_change = (bend.abs() + bend_change) / 2.0;
        let beside = (slope.abs() + slope_change) / 2.0;
        let kinematics = self.kinematics;
        // H(q', q') for the slope in the middle, and the terms with its change.
        let curved = kinematics.bend(q, beside, slope, slope)
            + 2.0 * kinematics.bend_within(q, beside, slope, slope_change)
            + kinematics.bend_within(q, beside, slope_change, slope_change);
        let changes = kinematics.motion_within(q, beside, bend_change)
            + kinematics.bend_within(q, beside, beside, bend.abs())
            + curved;
        let pushed = kinematics.velocity(q, bend);
        let Some(along) = (chord.norm() > 0.0).then(|| chord / chord.norm()) else {
            return (pushed.norm() + changes) / 8.0;
        };
        let across: Vector = perpendicular(along);
        let [lengthwise, sideways] = [along, across].map(|n| n.dot(&pushed).abs() + changes);
        // At the ends of the part, the slope along the chord may be less by half of its derivative.
        let is_forward = along.dot(&kinematics.velocity(q, slope)) >= lengthwise / 2.0;
        sideways / 8.0 + if is_forward { 0.0 } else { lengthwise / 8.0 }
    }
}

fn gap(line: &Line, piece: usize, u: f64, tip: Point) -> f64 {
    (Point::from(line.curve(piece).at(u)) - tip).norm()
}

/// Returns the place on a line that is near the next position of the tip, which is `step` metres away and deviates from the line
/// by at most `tolerance`, metres. The place is between `from` and `last`, so it never moves backwards. `O(1)` unless whole
/// pieces are passed.
pub fn advance(line: &Line, tolerance: f64, [from, last]: [Foot; 2], tip: Point, step: f64) -> Foot {
    let near = |piece: usize, least: f64| line.curve(piece).nearest([tip.x, tip.y], least);
    let mut foot = Foot { u: near(from.piece, from.u), ..from };
    let ahead = 2.0 * step + LOOKAHEAD_TOLERANCES * tolerance;
    while foot.piece < last.piece {
        let curve = line.curve(foot.piece);
        // The chord is no longer than the rest of the curve, and quick to compute.
        if (Point::from(curve.at(foot.u)) - Point::from(curve.end())).norm() > ahead {
            break;
        }
        let left = if foot.u >= 1.0 { 0.0 } else { curve.length() - curve.length_to(foot.u) };
        if left > ahead {
            break;
        }
        let next = Foot { piece: foot.piece + 1, u: near(foot.piece + 1, 0.0) };
        let [here, there] = [foot, next].map(|f| gap(line, f.piece, f.u, tip));
        let is_ahead = there < here - SWITCH_SHARE * tolerance || (foot.u >= 1.0 && there <= here);
        if !is_ahead || line.curve(next.piece).length_to(next.u) > ahead {
            break;
        }
        foot = next;
    }
    foot
}

/// Returns a bound on the distance of a part of a curve from its chord, at equal shares of the parameter, metres.
pub fn sag(curve: &Curve, [from, to]: [f64; 2]) -> f64 {
    curve.bend_between([from, to]) * (to - from) * (to - from) / 8.0
}
