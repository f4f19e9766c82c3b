//! Continuous collision check of a recorded motion, which finds the first contact.

use super::encounter::{CollisionCheck, Encounter, Moment, Touch};
use super::tool::{ToolMotion, TurnedShapes};
use crate::{Place, Span};
use cplan_geometry::Separation;
use cplan_handling::{ArchScene, HeldMotion, Piece, Recording, TimedScene};
use cplan_interrupt::checkpoint;
use cplan_judge::{Deviation, Drift, Posture, SpanPair};
use cplan_model::{Contact, Pair, Scene};
use std::borrow::Cow;

/// Least ratio of the proven clearance to the true one, as for [`super::certify`].
const TIGHTNESS: f64 = 0.9;

/// Greatest number of checks of a pair of shapes on a span. They take some seconds.
const MAX_EVALUATIONS: usize = 20_000_000;

/// Greatest number of checks after the first undecided span. From then on, the motion cannot be proven free, but may still be
/// found to collide. A motion that slides along an obstacle has very many undecided spans.
const EVALUATIONS_AFTER_UNDECIDED: usize = 200_000;

/// Number of configurations, evenly spread over the pieces, that are sampled before the search. They show how near the motion
/// comes to obstacles, and thus how finely it must be examined.
const INITIAL_SAMPLES: usize = 1024;

/// Every so many samples, one is taken in the first pass.
const COARSE_STRIDE: usize = 32;

/// The deviation of a single configuration from itself.
const NO_DEVIATION: Deviation = Deviation::Box([0.0; 2]);

/// Checks the whole motion, in order of time, for all pairs of shapes that can meet. Their distance must be positive and at least
/// `clearance` metres. For joint limits, see [`super::limit_violations`].
///
/// A tube around its chord encloses a span within one piece: in each joint, a curve deviates from its chord by at most an eighth
/// of its greatest second derivative times the squared width. The box around the control points encloses a span of several
/// pieces. If [`Posture::bound`] does not decide a span, both halves are examined. So a motion of many samples costs little if no
/// obstacle is near. After a contact is found, only earlier spans are examined.
///
/// Moving obstacles move by the recording's clock, from its first sample on. Without times, they are not checked.
pub fn check_collision<'a>(scene: impl Into<TimedScene<'a>>, recording: &Recording, clearance: f64) -> CollisionCheck {
    let scene = scene.into();
    let (pairs, pieces) = (all_pairs(scene, recording), recording.pieces());
    searched(|required| Search::new(scene, &pairs, &pieces, required), clearance)
}

/// Does the same as [`check_collision`] while other joints move that are fixed in the scene, such as a tool's. Parts have the
/// heights and angles that these joints give them at each moment. Carried objects follow only joints that lift them
/// ([`HeldMotion::lifts_payload`]).
pub fn check_collision_with(
    scene: TimedScene,
    recording: &Recording,
    held: &[HeldMotion],
    clearance: f64,
) -> CollisionCheck {
    let tool = ToolMotion::new(scene.scene, held);
    let pairs = all_pairs(TimedScene { scene: tool.scene(), ..scene }, recording);
    check_with_tool(scene, recording, (&tool, &pairs), clearance)
}

/// Does the same as [`check_collision_with`] for a stroke of the tool, but only for pairs that cannot meet while the tool is
/// raised.
pub(super) fn check_stroke(
    scene: &ArchScene,
    recording: &Recording,
    held: &HeldMotion,
    clearance: f64,
) -> CollisionCheck {
    let timed = TimedScene { scene: &scene.raised, trajectories: &[] };
    check_with_tool(timed, recording, (&ToolMotion::of_stroke(scene, held), &scene.lowered_pairs), clearance)
}

fn check_with_tool(
    scene: TimedScene,
    recording: &Recording,
    (tool, pairs): (&ToolMotion, &[Pair]),
    clearance: f64,
) -> CollisionCheck {
    let pieces = recording.pieces();
    let scene = TimedScene { scene: tool.scene(), ..scene };
    searched(|required| Search { tool: Some(tool), ..Search::new(scene, pairs, &pieces, required) }, clearance)
}

/// Returns the verdict of a search with a required clearance. If the motion violates the clearance, but no contact was seen, the
/// same search without a clearance decides about contact.
fn searched<'a>(search: impl Fn(f64) -> Search<'a>, clearance: f64) -> CollisionCheck {
    let mut found = search(clearance).of_whole_motion();
    if let CollisionCheck::Collision { deepest, touch: touch @ Touch::Undecided, .. } = &mut found {
        let (nearest, decided) = match search(0.0).of_whole_motion() {
            CollisionCheck::Free { nearest, .. } => (nearest, Touch::Excluded),
            CollisionCheck::Collision { deepest, .. } => (Some(deepest), Touch::Proven),
            CollisionCheck::Undecided(nearest) => (Some(nearest), Touch::Undecided),
        };
        let distance = |encounter: &Encounter| encounter.contact.separation.distance;
        (*deepest, *touch) = (nearest.filter(|it| distance(it) < distance(deepest)).unwrap_or(*deepest), decided);
    }
    found
}

/// Greatest number of checks of a pair of shapes on a span in [`keeps_during_stroke`]. They take a few milliseconds.
const TRIAL_EVALUATIONS: usize = 4_000;

/// Returns true if the pairs of [`check_stroke`] are proven to keep a clearance during a stroke of the tool. Faster than
/// [`check_stroke`], because it gives up at the first contact and after few checks.
pub(super) fn keeps_during_stroke(scene: &ArchScene, recording: &Recording, held: &HeldMotion, clearance: f64) -> bool {
    let tool = ToolMotion::of_stroke(scene, held);
    let pieces = recording.pieces();
    let timed = TimedScene { scene: tool.scene(), trajectories: &[] };
    let search = Search { tool: Some(&tool), ..Search::new(timed, &scene.lowered_pairs, &pieces, clearance) };
    search.trial(TRIAL_EVALUATIONS).is_free()
}

/// Returns a proven lower bound, positive and at least `clearance` metres, on the distance of all pairs of a scene along a
/// motion. `None` at the first contact, or if `budget` checks do not suffice for a proof.
pub(super) fn proven_clearance(scene: &Scene, recording: &Recording, clearance: f64, budget: usize) -> Option<f64> {
    let pieces = recording.pieces();
    let timed = TimedScene { scene, trajectories: &[] };
    Search::new(timed, scene.pairs(), &pieces, clearance).trial(budget).clearance()
}

/// Returns the pairs with static obstacles and, if the recording has times, those with moving obstacles.
fn all_pairs<'a>(scene: TimedScene<'a>, recording: &Recording) -> Cow<'a, [Pair]> {
    let moving = if recording.times().is_some() { scene.moving_pairs() } else { &[] };
    let standing = scene.scene.pairs();
    if moving.is_empty() { standing.into() } else { [standing, moving].concat().into() }
}

/// Checks a motion only for moving obstacles, by the recording's clock from its first sample on. A [`crate::CertifiedCurve`] is
/// free of static obstacles; if it passes this check, too, the motion is certified in time.
pub fn certify_in_time(scene: TimedScene, recording: &Recording, clearance: f64) -> CollisionCheck {
    let pieces = recording.pieces();
    Search::new(scene, scene.moving_pairs(), &pieces, clearance).of_whole_motion()
}

/// Returns the first encounter with a moving obstacle that is too close, or may be. `None` if the motion is free. Does not
/// compute the clearance, so it is much faster than [`certify_in_time`].
pub fn first_moving_contact(scene: TimedScene, recording: &Recording, clearance: f64) -> Option<Encounter> {
    let pieces = recording.pieces();
    let mut search = Search::new(scene, scene.moving_pairs(), &pieces, clearance);
    search.tightness = 0.0;
    search.run();
    match search.verdict() {
        CollisionCheck::Collision { first, .. } | CollisionCheck::Undecided(first) => Some(first),
        CollisionCheck::Free { .. } => None,
    }
}

struct Search<'a> {
    scene: TimedScene<'a>,
    /// The pairs to check. Pairs with moving obstacles come last.
    pairs: &'a [Pair],
    pieces: &'a [Piece],
    required: f64,
    /// Changes of heights and shapes during the motion.
    tool: Option<&'a ToolMotion<'a>>,
    /// A lower bound on a distance is accepted if it is at least this share of the least distance so far.
    tightness: f64,
    /// Least of the accepted bounds, metres.
    proven: f64,
    /// Encounter with the least distance so far.
    least: Option<Encounter>,
    /// The earliest contact so far, and its place.
    hit: Option<(Place, Encounter)>,
    /// The earliest undecided span so far, and the nearest pair there.
    open: Option<(Place, Encounter)>,
    evaluations: usize,
    /// Number of checks after which spans are not halved further.
    budget: usize,
    /// True if the search may end once the motion is not proven free.
    is_trial: bool,
}

impl<'a> Search<'a> {
    fn new(scene: TimedScene<'a>, pairs: &'a [Pair], pieces: &'a [Piece], required: f64) -> Self {
        Self {
            scene,
            pairs,
            pieces,
            required,
            tool: None,
            tightness: TIGHTNESS,
            proven: f64::INFINITY,
            least: None,
            hit: None,
            open: None,
            evaluations: 0,
            budget: MAX_EVALUATIONS,
            is_trial: false,
        }
    }

    /// Samples the whole motion. Skips stretches in which no pair can be in contact, or nearer than the nearest so far.
    fn sample_motion(&mut self) {
        let count = self.pieces.len();
        let (stride, shares) = (count.div_ceil(INITIAL_SAMPLES), INITIAL_SAMPLES.div_ceil(count));
        let place = |look: usize| (look / shares * stride, (look % shares) as f64 / shares as f64);
        let looks = count.div_ceil(stride) * shares;
        // A few samples come first, because short distances found early make most others irrelevant.
        for look in (0..looks).step_by(COARSE_STRIDE) {
            self.sample_pairs(place(look), self.pairs);
        }
        let mut open = vec![(0, looks, self.pairs.to_vec())];
        while let Some((from, to, mut pairs)) = open.pop() {
            if to - from == 1 {
                self.sample_pairs(place(from), &pairs);
                continue;
            }
            let span = Span::between(place(from), place(to - 1));
            let (middle, deviation) = span.deviation(self.pieces);
            self.keep_meeting(span, &mut pairs);
            let posture = Posture::new(self.scene.scene, middle);
            let [begins, ends] = span.ends();
            let turned = self.shapes_during(span);
            pairs.retain(|&pair| {
                let drift = self.drift(pair, begins, ends);
                let during = SpanPair { pair, part: turned.of(pair), drift: drift.as_ref() };
                let enough = |_| self.required.max(self.least_distance());
                self.may_be_closest(posture.disc_bound_during(during, deviation))
                    && self.may_be_closest(posture.bound_during(during, deviation, enough).least)
            });
            if !pairs.is_empty() {
                let half = from.midpoint(to);
                open.extend([(half, to, pairs.clone()), (from, half, pairs)]);
            }
        }
        self.sample_pairs((count - 1, 1.0), self.pairs);
    }

    /// Samples some pairs at a place. Skips pairs whose enclosing discs are far apart.
    fn sample_pairs(&mut self, place: Place, pairs: &[Pair]) {
        let posture = Posture::new(self.scene.scene, self.pieces[place.0].at(place.1));
        let turned = self.shapes_at(place);
        for &pair in pairs {
            if !self.certainly_meets(pair, place) {
                continue;
            }
            let drift = self.drift(pair, place, place);
            let at_place = SpanPair { pair, part: turned.of(pair), drift: drift.as_ref() };
            if self.may_be_closest(posture.disc_bound_during(at_place, NO_DEVIATION)) {
                self.record_distance(place, Contact { pair, separation: here(&posture, at_place) });
            }
        }
    }

    /// Returns true if a pair with at least this distance may be in contact, or nearer than all pairs before.
    fn may_be_closest(&self, apart: f64) -> bool {
        apart <= 0.0 || apart < self.required || apart < self.least_distance()
    }

    /// Removes from `pairs` those whose heights do not meet during a span.
    fn keep_meeting(&self, span: Span, pairs: &mut Vec<Pair>) {
        if let Some(tool) = self.tool {
            let extents = tool.extents(span);
            pairs.retain(|pair| tool.may_meet(*pair, &extents));
        }
    }

    fn shapes_during(&self, span: Span) -> TurnedShapes {
        self.tool.map_or_else(TurnedShapes::default, |tool| tool.shapes_during(span))
    }

    fn shapes_at(&self, place: Place) -> TurnedShapes {
        self.tool.map_or_else(TurnedShapes::default, |tool| tool.shapes_at(place))
    }

    /// Returns true if the shapes of a pair are exact at a place, and their heights meet there.
    fn certainly_meets(&self, pair: Pair, place: Place) -> bool {
        self.tool.is_none_or(|tool| tool.certainly_meets(pair, place))
    }

    /// Returns the least sampled distance.
    fn least_distance(&self) -> f64 {
        self.least.map_or(f64::INFINITY, |e| e.contact.separation.distance)
    }

    /// Returns the motion of the obstacle of a pair between two places, if it moves.
    fn drift(&self, pair: Pair, from: Place, to: Place) -> Option<Drift> {
        self.scene.drift(pair, self.pieces, [from, to])
    }

    /// Records a sampled distance.
    fn record_distance(&mut self, place: Place, contact: Contact) {
        let distance = contact.separation.distance;
        let encounter = Encounter { moment: Moment::new(place.0, &self.pieces[place.0], place.1), contact };
        // Of equally near places, the earliest counts.
        let rank = |of: &Encounter| (of.contact.separation.distance, of.moment.time);
        let nearer = |than: &Encounter| rank(&encounter) < rank(than);
        if self.least.as_ref().is_none_or(nearer) {
            self.least = Some(encounter);
        }
        let is_hit = distance <= 0.0 || distance < self.required;
        let earlier = |(known, than): &(Place, Encounter)| place < *known || (place == *known && nearer(than));
        if is_hit && self.hit.as_ref().is_none_or(earlier) {
            self.hit = Some((place, encounter));
        }
    }

    /// Returns true if a lower bound is good enough. Once a contact has been found, any bound that excludes contact is.
    fn is_good_enough(&self, bound: f64) -> bool {
        let is_tight = self.tightness > 0.0 && self.hit.is_none();
        let target = if is_tight { (self.tightness * self.least_distance()).max(self.required) } else { self.required };
        bound > 0.0 && bound >= target
    }

    /// Examines all spans in order of time, each with its undecided pairs.
    fn run(&mut self) {
        let mut stack = vec![(Span::all(self.pieces.len()), self.pairs.to_vec())];
        while let Some((span, mut pairs)) = stack.pop() {
            checkpoint();
            if self.hit.as_ref().is_some_and(|(place, _)| span.start() >= *place) {
                continue;
            }
            self.judge(span, &mut pairs);
            if self.is_trial && (self.hit.is_some() || self.open.is_some()) {
                return;
            }
            if pairs.is_empty() {
                continue;
            }
            match span.halves().filter(|_| self.evaluations < self.budget) {
                Some([first, second]) => stack.extend([(second, pairs.clone()), (first, pairs)]),
                None => self.leave_open(span, &pairs),
            }
        }
    }

    /// Removes from `pairs` those that are proven to keep their distance in the whole span.
    fn judge(&mut self, span: Span, pairs: &mut Vec<Pair>) {
        self.keep_meeting(span, pairs);
        let (middle, deviation) = span.deviation(self.pieces);
        let posture = Posture::new(self.scene.scene, middle);
        let [from, to] = span.ends();
        let (turned, at_middle) = (self.shapes_during(span), self.shapes_at(span.middle()));
        pairs.retain(|&pair| {
            let certainly_meets = self.certainly_meets(pair, span.middle());
            // An inexact shape may be nearer than the true one, so its distance is not compared with sampled distances.
            let suffices = |search: &Self, bound: f64| match certainly_meets {
                true => search.is_good_enough(bound),
                false => bound > 0.0 && bound >= search.required,
            };
            let drift = self.drift(pair, from, to);
            let during = SpanPair { pair, part: turned.of(pair), drift: drift.as_ref() };
            self.evaluations += 1;
            if drift.is_some() {
                let apart = posture.disc_bound_during(during, deviation);
                if suffices(self, apart) {
                    self.proven = self.proven.min(apart);
                    return false;
                }
            }
            let bounded = posture.bound_during(during, deviation, |_| f64::INFINITY);
            if let Span::Part(index, from, to) = span
                && certainly_meets
            {
                let separation = match at_middle.of(pair) {
                    Some(part) => here(&posture, SpanPair { part: Some(part), ..during }),
                    None => bounded.here,
                };
                self.record_distance((index, (from + to) / 2.0), Contact { pair, separation });
            }
            let free = suffices(self, bounded.least);
            if free {
                self.proven = self.proven.min(bounded.least);
            }
            !free
        });
    }

    /// Handles a span that is not proven free and cannot be halved, by examining its ends.
    fn leave_open(&mut self, span: Span, pairs: &[Pair]) {
        let mut nearest: Option<Encounter> = None;
        for place in span.ends() {
            let at = self.pieces[place.0].at(place.1);
            let posture = Posture::new(self.scene.scene, at);
            let turned = self.shapes_at(place);
            for &pair in pairs {
                let drift = self.drift(pair, place, place);
                let separation = here(&posture, SpanPair { pair, part: turned.of(pair), drift: drift.as_ref() });
                let contact = Contact { pair, separation };
                if self.certainly_meets(pair, place) {
                    self.record_distance(place, contact);
                }
                if nearest.is_none_or(|n| separation.distance < n.contact.separation.distance) {
                    nearest = Some(Encounter { moment: Moment::new(place.0, &self.pieces[place.0], place.1), contact });
                }
            }
        }
        if let (None, Some(nearest)) = (&self.open, nearest) {
            self.open = Some((span.start(), nearest));
            self.budget = self.budget.min(self.evaluations + EVALUATIONS_AFTER_UNDECIDED);
        }
    }

    /// Decides with at most `budget` checks, without a tight bound. Stops at the first place that is not free.
    fn trial(mut self, budget: usize) -> CollisionCheck {
        (self.tightness, self.budget, self.is_trial) = (0.0, budget, true);
        self.run();
        self.verdict()
    }

    /// Samples and examines the whole motion.
    fn of_whole_motion(mut self) -> CollisionCheck {
        self.sample_motion();
        self.run();
        self.verdict()
    }

    fn verdict(self) -> CollisionCheck {
        match (self.hit, self.open, self.least) {
            (Some((place, first)), open, least) => {
                let from = open.map_or(place, |(from, _)| if from < place { from } else { place });
                let free_until = self.pieces[from.0].time(from.1);
                let deepest = least.unwrap_or(first);
                let is_touching = deepest.contact.separation.distance <= 0.0;
                let touch = if is_touching { Touch::Proven } else { Touch::Undecided };
                CollisionCheck::Collision { first, free_until, deepest, touch }
            }
            (None, Some((_, nearest)), _) => CollisionCheck::Undecided(nearest),
            (None, None, nearest) => CollisionCheck::Free { clearance: self.proven, nearest },
        }
    }
}

/// Returns the distance of a pair at a moment.
fn here(posture: &Posture, pair: SpanPair) -> Separation {
    posture.bound_during(pair, NO_DEVIATION, |_| f64::NEG_INFINITY).here
}
