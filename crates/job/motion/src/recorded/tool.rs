//! Heights and shapes of the arm while joints other than the two planned ones move.
//!
//! During a span of time, a lifted part counts with all its heights from the least to the greatest. This is enough to
//! prove that a span is free. A contact is reported only if the heights meet at one moment. A part that a wrist turns
//! counts with all its orientations from the least angle to the greatest, and with that of the moment for a contact.

use super::cover::cover_about;
use crate::{Place, Span};
use cplan_geometry::{Convex, Point};
use cplan_handling::{ArchScene, HeldEffect, HeldMotion, Piece};
use cplan_judge::Deviation;
use cplan_model::{Heights, OutlineSource, Pair, Part, Scene};
use std::borrow::Cow;

/// Greatest distance of the centre of a round part from its axis of rotation, metres. It allows for rounding.
const AXIS_TOLERANCE: f64 = 1e-9;

/// A joint that lifts some bodies.
struct Lift<'a> {
    pieces: Vec<Piece>,
    /// The value of the joint in the scene that holds it still, and the direction of increasing values.
    rest: f64,
    sign: f64,
    bodies: &'a [String],
    lifts_payload: bool,
}

impl Lift<'_> {
    /// Returns bounds on the joint's lift during a span, in metres relative to the held value.
    fn extent(&self, span: Span) -> [f64; 2] {
        extent(&self.pieces, span, (self.rest, self.sign))
    }
}

/// Returns bounds on the values of a joint during a span, relative to `rest` and multiplied by `sign`.
fn extent(pieces: &[Piece], span: Span, (rest, sign): (f64, f64)) -> [f64; 2] {
    let (middle, deviation) = span.deviation(pieces);
    let half = match deviation {
        Deviation::Box([half, _]) => half,
        Deviation::Tube(chord, [half, _]) => chord[0].abs() + half,
        Deviation::Along(chord) => chord[0].abs(),
    };
    let value = sign * (middle[0] - rest);
    [value - half, value + half]
}

/// A part of link 2 that a joint turns.
struct Turn {
    /// Index of the part.
    part: usize,
    /// The part's shape while the joint is at its held value.
    shape: Convex,
    axis: Point,
    pieces: Vec<Piece>,
    /// The held value of the joint, and the direction of increasing values.
    rest: f64,
    sign: f64,
}

/// Shapes of the parts that a joint turns, at a moment or during a span.
#[derive(Default)]
pub(super) struct TurnedShapes(Vec<(usize, Convex)>);

impl TurnedShapes {
    /// Returns the shape of a pair's part. `None` if it does not turn.
    pub fn of(&self, pair: Pair) -> Option<&Convex> {
        self.0.iter().find(|(part, _)| pair.link > 0 && *part == pair.part).map(|(_, shape)| shape)
    }
}

/// The arm's scene while joints move that the scene holds still.
pub(super) struct ToolMotion<'a> {
    lifts: Vec<Lift<'a>>,
    /// Index among link 2's parts of the bar from joint 2 to the tip, if it has one. One end of a bar moves with the tip.
    bar: Option<usize>,
    turns: Vec<Turn>,
    /// The scene with parts at the heights of the held joints.
    still: Cow<'a, Scene>,
    /// The scene with parts at all heights that they take during the motion, and with the pairs that meet at some of
    /// them.
    swept: Cow<'a, Scene>,
}

impl<'a> ToolMotion<'a> {
    /// Creates a scene in which these joints move.
    pub fn new(scene: &Scene, motions: &'a [HeldMotion]) -> Self {
        let mut lifts = Vec::new();
        let mut turns = Vec::new();
        for HeldMotion { joint, values, lifts_payload } in motions {
            match joint.effect {
                HeldEffect::Lifts { sign } => {
                    let (pieces, lifts_payload) = (values.pieces(), *lifts_payload);
                    lifts.push(Lift { pieces, rest: joint.value, sign, bodies: &joint.bodies, lifts_payload });
                }
                HeldEffect::Turns { axis, sign } => {
                    let turned = |(part, own): (usize, &Part)| {
                        let is_turned = joint.bodies.contains(&own.body) && !is_round(&own.shape, axis);
                        let (shape, pieces) = (own.shape.clone(), values.pieces());
                        is_turned.then_some(Turn { part, shape, axis, pieces, rest: joint.value, sign })
                    };
                    turns.extend(scene.own_parts(1).iter().enumerate().filter_map(turned));
                }
                HeldEffect::Unjudged { .. } => {}
            }
        }
        let all = |part: &mut Part| {
            for lift in lifts.iter().filter(|lift| lift.bodies.contains(&part.body)) {
                part.heights = part.heights.lifted(lift.extent(Span::all(lift.pieces.len())));
            }
        };
        let swept = scene.reshaped(all, |obstacle| obstacle.pieces.clone());
        let all_pieces = |lift: &Lift| lift.extent(Span::all(lift.pieces.len()));
        let swept = match scene.attachment() {
            Some(attachment) => {
                let carrying = lifts.iter().filter(|lift| lift.lifts_payload);
                let heights = carrying.fold(attachment.heights, |heights, lift| heights.lifted(all_pieces(lift)));
                swept.with_attached_heights(heights)
            }
            None => swept,
        };
        let swept = swept.with_self_heights(|link, heights| {
            let carried = lifts.iter().filter(|lift| lift.bodies.iter().any(|body| body == link));
            carried.fold(heights, |heights, lift| heights.lifted(all_pieces(lift)))
        });
        let bar = bar_of(scene).filter(|_| !lifts.is_empty());
        let swept = match bar {
            Some(bar) => swept.changed(|arm, _| {
                let heights = &mut arm.links[1].parts[bar].heights;
                *heights = lifts.iter().fold(*heights, |heights, lift| heights.and(heights.lifted(all_pieces(lift))));
            }),
            None => swept,
        };
        Self { lifts, bar, turns, still: Cow::Owned(scene.clone()), swept: Cow::Owned(swept) }
    }

    /// Creates a motion of the joint that lowers the tool, in scenes that are already known.
    pub fn of_stroke(scene: &'a ArchScene, HeldMotion { joint, values, lifts_payload }: &'a HeldMotion) -> Self {
        let ArchScene { raised, swept, .. } = scene;
        let sign = if let HeldEffect::Lifts { sign } = joint.effect { sign } else { 0.0 };
        let (pieces, lifts_payload) = (values.pieces(), *lifts_payload);
        let lifts = vec![Lift { pieces, rest: joint.value, sign, bodies: &joint.bodies, lifts_payload }];
        let (still, swept) = (Cow::Borrowed(raised), Cow::Borrowed(swept));
        Self { lifts, bar: bar_of(raised), turns: Vec::new(), still, swept }
    }

    /// Returns the scene with all pairs that meet at some time.
    pub fn scene(&self) -> &Scene {
        &self.swept
    }

    /// Returns shapes that contain the turning parts at all times of a span.
    pub fn shapes_during(&self, span: Span) -> TurnedShapes {
        let cover = |turn: &Turn| {
            let angles = extent(&turn.pieces, span, (turn.rest, turn.sign));
            (turn.part, cover_about(turn.axis, &turn.shape, angles))
        };
        TurnedShapes(self.turns.iter().map(cover).collect())
    }

    /// Returns the shapes of the turning parts at a moment.
    pub fn shapes_at(&self, (piece, share): Place) -> TurnedShapes {
        let turned = |turn: &Turn| {
            let angle = turn.sign * (turn.pieces[piece].at(share)[0] - turn.rest);
            (turn.part, cover_about(turn.axis, &turn.shape, [angle; 2]))
        };
        TurnedShapes(self.turns.iter().map(turned).collect())
    }

    /// Returns bounds on the lift of each joint during a span.
    pub fn extents(&self, span: Span) -> Vec<[f64; 2]> {
        self.lifts.iter().map(|lift| lift.extent(span)).collect()
    }

    /// Returns the heights of a pair's part with these lifts, and those of its obstacle.
    fn heights(&self, pair: Pair, extents: &[[f64; 2]]) -> [Heights; 2] {
        let part = &self.still.link(pair).parts[pair.part];
        let lifts_part = |lift: &Lift| match self.still.is_attached(pair) {
            true => lift.lifts_payload,
            false => lift.bodies.contains(&part.body),
        };
        let lifts = || self.lifts.iter().zip(extents);
        let of_part = if self.is_bar(pair) {
            lifts().fold(part.heights, |heights, (_, extent)| heights.and(heights.lifted(*extent)))
        } else {
            let carrying = lifts().filter(|(lift, _)| lifts_part(lift));
            carrying.fold(part.heights, |heights, (_, extent)| heights.lifted(*extent))
        };
        let lifted = |link: &String, heights: Heights| {
            let carrying = lifts().filter(|(lift, _)| lift.bodies.contains(link));
            carrying.fold(heights, |heights, (_, extent)| heights.lifted(*extent))
        };
        let obstacle = self.still.obstacle(pair.obstacle);
        let is_own = self.still.self_obstacle(pair.obstacle).is_some();
        let of_obstacle = if is_own { lifted(&obstacle.name, obstacle.heights) } else { obstacle.heights };
        [of_part, of_obstacle]
    }

    /// Returns true if a pair's part is the bar from joint 2 to the tip.
    fn is_bar(&self, pair: Pair) -> bool {
        pair.link == 1 && self.bar == Some(pair.part)
    }

    /// Returns true if the heights of a pair may meet with lifts within these bounds.
    pub fn may_meet(&self, pair: Pair, extents: &[[f64; 2]]) -> bool {
        let [part, obstacle] = self.heights(pair, extents);
        if self.still.is_attached(pair) { part.object_may_meet(obstacle) } else { part.meet(obstacle) }
    }

    /// Returns true if at a moment the heights of a pair certainly meet, and its part is no bar.
    pub fn certainly_meets(&self, pair: Pair, (piece, share): Place) -> bool {
        let [part, obstacle] = self.heights(pair, &self.extents(Span::Part(piece, share, share)));
        let meet = match self.still.is_attached(pair) {
            _ if self.still.self_obstacle(pair.obstacle).is_some() => part.overlap(obstacle),
            true => part.object_definitely_meets(obstacle),
            false => part.definitely_meet(obstacle),
        };
        !self.is_bar(pair) && meet
    }
}

/// Returns the index of the bar from joint 2 to the tip among link 2's parts, or `None` without a bar.
fn bar_of(scene: &Scene) -> Option<usize> {
    let is_bar = scene.arm().links[1].source == OutlineSource::Bar;
    scene.own_parts(1).len().checked_sub(1).filter(|_| is_bar)
}

/// Returns true if a shape is a disc about an axis, unchanged by rotation.
fn is_round(shape: &Convex, axis: Point) -> bool {
    shape.core().iter().all(|corner| (corner - axis).norm() <= AXIS_TOLERANCE)
}
