//! The search for the margins of a motion.

use super::bodies::{Bodies, BodyNames, SceneBodies};
use super::{BodyMargin, ErrorKind, Margin, Margins, Tolerance};
use crate::{Place, Span};
use cplan_handling::{Piece, TimedScene};
use cplan_interrupt::checkpoint;
use cplan_judge::{ArmErrors, Deviation, Drift, Posture, SeparationBound, SpanPair};
use cplan_model::{Arm, Pair, Scene};

/// A lower bound is accepted if it is at least this share of the least value that was seen.
const TIGHTNESS: f64 = 0.96;

/// Number of places that are sampled first.
const INITIAL_SAMPLES: usize = 32;

/// Greatest number of these samples on one piece.
const SAMPLES_PER_PIECE: usize = 4;

/// Number of checks of a pair of shapes on a span after which every bound is accepted. They take some seconds.
const MAX_CHECKS: usize = 5_000_000;

/// Number of times that the range of an error is halved. The error is then known to within a hundredth.
const ERROR_HALVINGS: u32 = 7;

/// Number of times that an error is halved before it is considered zero.
const MOST_ERROR_HALVINGS: usize = 64;

/// A stretch of a motion in one scene.
#[derive(Debug, Clone, Copy)]
pub struct MotionStretch<'a> {
    /// The scene. The trajectories of its moving obstacles begin with the stretch.
    pub scene: TimedScene<'a>,
    /// The motion; at least one piece.
    pub pieces: &'a [Piece],
    /// Offset of the pieces' times, seconds.
    pub begin: f64,
    /// Greatest difference in each joint between the pieces and other readings of the motion, radians or metres.
    pub beside: f64,
    /// Distance that is already proven for all pairs, metres; 0 if none is.
    pub known: f64,
}

/// A value with a lower bound.
#[derive(Debug, Clone, Copy)]
struct Limit {
    /// The least value that was seen.
    seen: f64,
    /// The least of the accepted bounds.
    proven: f64,
    place: Option<Margin>,
}

impl Limit {
    fn new(seen: f64) -> Self {
        Self { seen, proven: f64::INFINITY, place: None }
    }

    /// Records a value at a place. Returns true if it is the least so far.
    fn see(&mut self, value: f64, place: Margin) -> bool {
        let is_less = value < self.seen;
        if is_less {
            (self.seen, self.place) = (value, Some(place));
        }
        is_less
    }

    /// Records an accepted bound.
    fn accept(&mut self, bound: f64) {
        self.proven = self.proven.min(bound);
    }

    /// Returns the least bound that is accepted.
    fn target(&self) -> f64 {
        TIGHTNESS * self.seen
    }

    fn margin(&self) -> Option<Margin> {
        // A bound may be below zero by a rounding error.
        let size = self.proven.min(self.seen).max(0.0);
        self.place.map(|place| Margin { size, ..place })
    }
}

/// The open questions about a pair of shapes on a span: a bit for the distance, and one for each kind of error.
#[derive(Clone, Copy)]
struct OpenPair {
    pair: Pair,
    open: u8,
}

/// The bit of the distance. The bits of the kinds of errors follow.
const DISTANCE: u8 = 1;

/// A search for the margins of a motion, stretch by stretch.
pub struct MarginSearch<'a> {
    arm: &'a Arm,
    kinds: Vec<ErrorKind>,
    bodies: Bodies,
    /// For each body, its distance from others.
    distances: Vec<Limit>,
    /// For each kind of error, its size.
    errors: Vec<Limit>,
    checks: usize,
}

/// A pair of shapes on a span of a stretch.
struct Look<'p> {
    posture: &'p Posture<'p>,
    deviation: Deviation,
    during: SpanPair<'p>,
    /// The bodies of the pair: the obstacle, and the part of the arm or the payload.
    bodies: [usize; 2],
    /// The deviations of the motion from the configuration of the posture.
    beside: Deviation,
    known: f64,
    /// The place of the posture on the motion. `None` if the posture is not on the motion.
    place: Option<Margin>,
}

impl Look<'_> {
    /// Returns true if the pair is proven to be apart in the whole span, despite these errors.
    fn is_apart(&self, errors: &ArmErrors) -> bool {
        self.posture.is_apart_with_errors(self.during, self.deviation, errors, self.known)
    }

    /// Returns true if the pair is proven to be apart in the middle of the span, despite these errors.
    fn is_apart_in_middle(&self, errors: &ArmErrors) -> bool {
        let drift = self.during.drift.map(|drift| Drift { half: 0.0, ..*drift });
        let during = SpanPair { drift: drift.as_ref(), ..self.during };
        self.posture.is_apart_with_errors(during, self.beside, errors, self.known)
    }

    /// Returns a lower bound on the distance over the whole deviation. A bound of at least `enough` need not be the greatest.
    fn bound(&self, enough: f64) -> SeparationBound {
        let bound = self.posture.bound_during(self.during, self.deviation, |_| enough);
        SeparationBound { least: bound.least.max(self.known), ..bound }
    }
}

impl<'a> MarginSearch<'a> {
    /// Creates a search for the motion of an arm.
    pub fn new(arm: &'a Arm, names: BodyNames) -> Self {
        let kinds = ErrorKind::all(arm);
        let errors = kinds.iter().map(|kind| Limit::new(kind.largest(arm))).collect();
        Self { arm, kinds, bodies: Bodies::new(names), distances: Vec::new(), errors, checks: 0 }
    }

    /// Examines a stretch of the motion, with shapes that are not grown. Ignores permitted contacts, such as those of a payload
    /// with its supports.
    pub fn examine(&mut self, stretch: &MotionStretch) {
        let scene = &*stretch.scene.scene.drawn();
        let stretch = &MotionStretch { scene: TimedScene { scene, ..stretch.scene }, ..*stretch };
        let bodies = self.bodies.of(scene);
        self.distances.resize(self.bodies.all.len(), Limit::new(f64::INFINITY));
        let all = (1 << (self.kinds.len() + 1)) - 1;
        let pairs = scene.pairs().iter().chain(stretch.scene.moving_pairs());
        let pairs = pairs.filter(|pair| !is_on_support(scene, **pair));
        let pairs: Vec<OpenPair> = pairs.map(|&pair| OpenPair { pair, open: all }).collect();
        let count = stretch.pieces.len();
        let samples = INITIAL_SAMPLES.min(SAMPLES_PER_PIECE * count);
        for sample in 0..samples {
            let along = (sample * count) as f64 / samples as f64;
            let (piece, share) = (along as usize, along.fract());
            self.sample(stretch, &bodies, (piece, share), &pairs);
        }
        let mut stack = vec![(Span::all(count), pairs)];
        while let Some((span, mut pairs)) = stack.pop() {
            checkpoint();
            let halves = span.halves().filter(|_| self.checks < MAX_CHECKS);
            self.judge(stretch, &bodies, span, &mut pairs, halves.is_none());
            if let Some([first, second]) = halves.filter(|_| !pairs.is_empty()) {
                stack.extend([(second, pairs.clone()), (first, pairs)]);
            }
        }
    }

    /// Returns the margins of all stretches.
    pub fn margins(self) -> Margins {
        let limits = self.bodies.all.into_iter().zip(&self.distances);
        let mut bodies: Vec<BodyMargin> =
            limits.map(|((kind, name), limit)| BodyMargin { name, kind, margin: limit.margin() }).collect();
        // Places refer to bodies by number.
        let mut order: Vec<usize> = (0..bodies.len()).collect();
        order.sort_by_key(|&body| bodies[body].kind);
        let mut numbers = vec![0; order.len()];
        order.iter().enumerate().for_each(|(new, &old)| numbers[old] = new);
        let renumbered = |margin: Margin| Margin { bodies: margin.bodies.map(|body| numbers[body]), ..margin };
        bodies.sort_by_key(|body| body.kind);
        bodies.iter_mut().for_each(|body| body.margin = body.margin.map(renumbered));
        let tolerance = |(of, limit): (ErrorKind, &Limit)| Tolerance { of, margin: limit.margin().map(renumbered) };
        let tolerances = self.kinds.into_iter().zip(&self.errors).map(tolerance).collect();
        Margins { bodies, tolerances, lacks_times: false }
    }

    /// Samples the distances of pairs at a place. Skips pairs that cannot be nearer than others of both bodies.
    fn sample(&mut self, stretch: &MotionStretch, bodies: &SceneBodies, place: Place, pairs: &[OpenPair]) {
        let posture = Posture::new(stretch.scene.scene, stretch.pieces[place.0].at(place.1));
        let beside = Deviation::Box([stretch.beside; 2]);
        for &OpenPair { pair, .. } in pairs {
            let drift = stretch.scene.drift(pair, stretch.pieces, [place; 2]);
            let during = SpanPair { pair, part: None, drift: drift.as_ref() };
            let look = look(stretch, bodies, (&posture, beside), during, Some(place));
            let seen = look.bodies.map(|body| self.distances[body].seen);
            if posture.disc_bound_during(during, beside) < seen[0].max(seen[1])
                && self.record(&look, look.bound(f64::NEG_INFINITY).here.distance)
            {
                (0..self.kinds.len()).for_each(|kind| self.improve(&look, kind));
            }
        }
    }

    /// Removes from `pairs` the questions that are decided on a span, and pairs without open questions. If the span is the last
    /// one, accepts any bound.
    fn judge(
        &mut self,
        stretch: &MotionStretch,
        bodies: &SceneBodies,
        span: Span,
        pairs: &mut Vec<OpenPair>,
        is_last: bool,
    ) {
        let (middle, deviation) = span.deviation(stretch.pieces);
        let deviation = deviation.widened(stretch.beside);
        let posture = Posture::new(stretch.scene.scene, middle);
        let [from, to] = span.ends();
        // The middle of the box around several pieces is not on the motion.
        let place = Some(span.middle()).filter(|_| matches!(span, Span::Part(..)));
        pairs.retain_mut(|OpenPair { pair, open }| {
            self.checks += 1;
            let drift = stretch.scene.drift(*pair, stretch.pieces, [from, to]);
            let during = SpanPair { pair: *pair, part: None, drift: drift.as_ref() };
            let look = look(stretch, bodies, (&posture, deviation), during, place);
            if *open & DISTANCE > 0 && self.decides_distance(&look, is_last) {
                *open &= !DISTANCE;
            }
            for kind in 0..self.kinds.len() {
                let bit = DISTANCE << (kind + 1);
                if *open & bit > 0 && self.decides_error(&look, kind, is_last) {
                    *open &= !bit;
                }
            }
            *open > 0
        });
    }

    /// Returns true if the bound on the distance of a pair is accepted.
    fn decides_distance(&mut self, look: &Look, is_last: bool) -> bool {
        let target =
            |search: &Self| look.bodies.map(|body| search.distances[body].target()).into_iter().fold(0.0, f64::max);
        let apart = look.posture.disc_bound_during(look.during, look.deviation).max(look.known);
        let mut least = apart;
        if apart <= 0.0 || apart < target(self) {
            let bound = look.bound(target(self));
            self.record(look, bound.here.distance);
            least = bound.least;
        }
        let is_accepted = is_last || (least > 0.0 && least >= target(self));
        if is_accepted {
            look.bodies.iter().for_each(|&body| self.distances[body].accept(least));
        }
        is_accepted
    }

    /// Returns true if the bound on the size of an error is accepted.
    fn decides_error(&mut self, look: &Look, kind: usize, is_last: bool) -> bool {
        let errors = |search: &Self, size: f64| search.kinds[kind].errors(search.arm, size);
        let mut size = self.errors[kind].target();
        if !look.is_apart(&errors(self, size)) {
            self.improve(look, kind);
            let tried = std::mem::replace(&mut size, self.errors[kind].target());
            if size == tried || !look.is_apart(&errors(self, size)) {
                if !is_last {
                    return false;
                }
                let halved = std::iter::successors(Some(size), |size| Some(size / 2.0)).take(MOST_ERROR_HALVINGS);
                size = { halved }.find(|&size| look.is_apart(&errors(self, size))).unwrap_or(0.0);
            }
        }
        self.errors[kind].accept(size);
        true
    }

    /// Records the distance of a pair at a place of the motion. Returns true if it is the least so far for one of its bodies.
    fn record(&mut self, look: &Look, distance: f64) -> bool {
        let off = look.posture.farthest_motion(look.during.pair, look.beside);
        let distance = (distance - off).max(look.known);
        let Some(place) = look.place else { return false };
        let mut is_less = false;
        for body in look.bodies {
            is_less |= self.distances[body].see(distance, place);
        }
        is_less
    }

    /// Reduces the size of an error to the largest one that keeps a pair apart at a place of the motion.
    fn improve(&mut self, look: &Look, kind: usize) {
        let Some(place) = look.place else { return };
        let is_apart = |size: f64| look.is_apart_in_middle(&self.kinds[kind].errors(self.arm, size));
        let [mut free, mut open] = [0.0, self.errors[kind].seen];
        if is_apart(open) {
            return;
        }
        for _ in 0..ERROR_HALVINGS {
            let middle = (free + open) / 2.0;
            *(if is_apart(middle) { &mut free } else { &mut open }) = middle;
        }
        self.errors[kind].see(open, place);
    }
}

/// Returns a pair on a span of a stretch, with the place of the posture if it is on the motion.
fn look<'p>(
    stretch: &MotionStretch,
    bodies: &SceneBodies,
    (posture, deviation): (&'p Posture<'p>, Deviation),
    during: SpanPair<'p>,
    place: Option<Place>,
) -> Look<'p> {
    let bodies = bodies.of(during.pair);
    let place = place.map(|(piece, share)| {
        let time = stretch.begin + stretch.pieces[piece].time(share);
        Margin { size: 0.0, at: posture.configuration(), time, bodies }
    });
    let beside = Deviation::Box([stretch.beside; 2]);
    Look { posture, deviation, during, bodies, beside, known: stretch.known, place }
}

/// Returns true if a pair consists of a payload and one of its supports, which may touch.
fn is_on_support(scene: &Scene, pair: Pair) -> bool {
    let attached = || pair.part.checked_sub(scene.own_parts(1).len());
    let part = |attached: usize| scene.attachment()?.parts.get(attached);
    scene.is_attached(pair) && attached().and_then(part).is_some_and(|part| part.on_supports)
}
