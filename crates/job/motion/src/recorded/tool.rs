//! Heights and shapes of the arm while other joints than the two planned ones move.
//!
//! To prove that a span of time is free, a lifted part counts with all heights from its least to its greatest, and a part that a
//! wrist turns counts with all orientations between its least and its greatest angle. A contact is reported only if heights meet,
//! with the orientation of the part, at one moment.

use super::cover::cover_about;
use crate::{Place, Span};
use cplan_geometry::{Convex, Point};
use cplan_handling::{ArchScene, HeldEffect, HeldMotion, Piece};
use cplan_judge::Deviation;
use cplan_model::{Heights, OutlineSource, Pair, Part, Scene};
use std::borrow::Cow;

/// A part is round if its centre is within this distance of its axis of rotation, metres. It covers rounding.
const AXIS_TOLERANCE: f64 = 1e-9;

/// A joint that moves although it is fixed in the scene.
struct MovingJoint {
    pieces: Vec<Piece>,
    /// The fixed value of the joint, and the direction of increasing values.
    rest: f64,
    sign: f64,
}

impl MovingJoint {
    fn new(HeldMotion { joint, values, .. }: &HeldMotion, sign: f64) -> Self {
        Self { pieces: values.pieces(), rest: joint.value, sign }
    }

    /// Returns bounds on the joint's values during a span, relative to its fixed value.
    fn extent(&self, span: Span) -> [f64; 2] {
        let (middle, deviation) = span.deviation(&self.pieces);
        let half = match deviation {
            Deviation::Box([half, _]) => half,
            Deviation::Tube(chord, [half, _]) => chord[0].abs() + half,
            Deviation::Along(chord) => chord[0].abs(),
        };
        let value = self.sign * (middle[0] - self.rest);
        [value - half, value + half]
    }
}

/// A joint that lifts some bodies.
struct Lift<'a> {
    joint: MovingJoint,
    bodies: &'a [String],
    lifts_payload: bool,
}

impl<'a> Lift<'a> {
    fn new(motion: &'a HeldMotion, sign: f64) -> Self {
        let HeldMotion { joint, lifts_payload, .. } = motion;
        Self { joint: MovingJoint::new(motion, sign), bodies: &joint.bodies, lifts_payload: *lifts_payload }
    }

    fn lifts(&self, body: &str) -> bool {
        self.bodies.iter().any(|lifted| lifted == body)
    }
}

/// Returns heights after lifts by the joints that carry the body. Each joint comes with bounds on its lift, in metres relative to
/// its fixed value.
fn lifted<'l>(
    heights: Heights,
    lifts: impl Iterator<Item = (&'l Lift<'l>, [f64; 2])>,
    carries: impl Fn(&Lift) -> bool,
) -> Heights {
    lifts.filter(|(lift, _)| carries(lift)).fold(heights, |heights, (_, extent)| heights.lifted(extent))
}

/// Returns the heights, after these lifts, of a bar of which one end moves with the tip.
fn lifted_bar<'l>(heights: Heights, lifts: impl Iterator<Item = (&'l Lift<'l>, [f64; 2])>) -> Heights {
    lifts.fold(heights, |heights, (_, extent)| heights.and(heights.lifted(extent)))
}

/// A part of link 2 that a joint turns.
struct Turn {
    /// Index of the part.
    part: usize,
    /// The part's shape at the joint's fixed value.
    shape: Convex,
    axis: Point,
    joint: MovingJoint,
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

/// A scene in which joints move that were fixed.
pub(super) struct ToolMotion<'a> {
    lifts: Vec<Lift<'a>>,
    /// Index, among the parts of link 2, of the bar from joint 2 to the tip, if there is one. One end of it moves with the tip.
    bar: Option<usize>,
    turns: Vec<Turn>,
    /// The scene with parts at the heights of the fixed joints.
    still: Cow<'a, Scene>,
    /// The scene with parts at all heights that they take during the motion, and with all pairs that meet at some of them.
    swept: Cow<'a, Scene>,
}

impl<'a> ToolMotion<'a> {
    /// Creates a scene in which these joints move.
    pub fn new(scene: &Scene, motions: &'a [HeldMotion]) -> Self {
        let mut lifts = Vec::new();
        let mut turns = Vec::new();
        for motion in motions {
            match motion.joint.effect {
                HeldEffect::Lifts { sign } => lifts.push(Lift::new(motion, sign)),
                HeldEffect::Turns { axis, sign } => {
                    let turned = |(part, own): (usize, &Part)| {
                        let is_turned = motion.joint.bodies.contains(&own.body) && !is_round(&own.shape, axis);
                        let (shape, joint) = (own.shape.clone(), MovingJoint::new(motion, sign));
                        is_turned.then_some(Turn { part, shape, axis, joint })
                    };
                    turns.extend(scene.own_parts(1).iter().enumerate().filter_map(turned));
                }
                HeldEffect::Unjudged { .. } => {}
            }
        }
        let whole = || lifts.iter().map(|lift| (lift, lift.joint.extent(Span::all(lift.joint.pieces.len()))));
        let all = |part: &mut Part| part.heights = lifted(part.heights, whole(), |lift| lift.lifts(&part.body));
        let swept = scene.reshaped(all, |obstacle| obstacle.pieces.clone());
        let swept = match scene.attachment() {
            Some(attachment) => {
                swept.with_attached_heights(lifted(attachment.heights, whole(), |lift| lift.lifts_payload))
            }
            None => swept,
        };
        let swept = swept.with_self_heights(|link, heights| lifted(heights, whole(), |lift| lift.lifts(link)));
        let bar = bar_of(scene).filter(|_| !lifts.is_empty());
        let swept = match bar {
            Some(bar) => swept.changed(|arm, _| {
                let heights = &mut arm.links[1].parts[bar].heights;
                *heights = lifted_bar(*heights, whole());
            }),
            None => swept,
        };
        Self { lifts, bar, turns, still: Cow::Owned(scene.clone()), swept: Cow::Owned(swept) }
    }

    /// Creates a motion of the joint that lowers the tool, in known scenes.
    pub fn of_stroke(scene: &'a ArchScene, motion: &'a HeldMotion) -> Self {
        let ArchScene { raised, swept, .. } = scene;
        let sign = if let HeldEffect::Lifts { sign } = motion.joint.effect { sign } else { 0.0 };
        let (still, swept) = (Cow::Borrowed(raised), Cow::Borrowed(swept));
        Self { lifts: vec![Lift::new(motion, sign)], bar: bar_of(raised), turns: Vec::new(), still, swept }
    }

    /// Returns the scene with all pairs that meet at some time.
    pub fn scene(&self) -> &Scene {
        &self.swept
    }

    /// Returns shapes that contain the turning parts at all times of a span.
    pub fn shapes_during(&self, span: Span) -> TurnedShapes {
        self.shapes(|joint| joint.extent(span))
    }

    /// Returns the shapes of the turning parts at a moment.
    pub fn shapes_at(&self, (piece, share): Place) -> TurnedShapes {
        self.shapes(|joint| [joint.sign * (joint.pieces[piece].at(share)[0] - joint.rest); 2])
    }

    /// Returns shapes that contain the turning parts at all angles between the bounds that `angles` returns.
    fn shapes(&self, angles: impl Fn(&MovingJoint) -> [f64; 2]) -> TurnedShapes {
        let cover = |turn: &Turn| (turn.part, cover_about(turn.axis, &turn.shape, angles(&turn.joint)));
        TurnedShapes(self.turns.iter().map(cover).collect())
    }

    /// Returns bounds on the lift of each joint during a span.
    pub fn extents(&self, span: Span) -> Vec<[f64; 2]> {
        self.lifts.iter().map(|lift| lift.joint.extent(span)).collect()
    }

    /// Returns the heights of a pair's part with these lifts, and those of its obstacle.
    fn heights(&self, pair: Pair, extents: &[[f64; 2]]) -> [Heights; 2] {
        let part = &self.still.link(pair).parts[pair.part];
        let is_attached = self.still.is_attached(pair);
        let lifts_part = |lift: &Lift| if is_attached { lift.lifts_payload } else { lift.lifts(&part.body) };
        let lifts = || self.lifts.iter().zip(extents.iter().copied());
        let of_part = match self.is_bar(pair) {
            true => lifted_bar(part.heights, lifts()),
            false => lifted(part.heights, lifts(), lifts_part),
        };
        let obstacle = self.still.obstacle(pair.obstacle);
        let is_own = self.still.self_obstacle(pair.obstacle).is_some();
        let of_obstacle = lifted(obstacle.heights, lifts(), |lift| is_own && lift.lifts(&obstacle.name));
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

    /// Returns true if at a moment the heights of a pair certainly meet. False if its part is a bar.
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

/// Returns the scene with the arm's parts at all heights and angles that other joints give them during a motion.
pub fn swept_by_tool(scene: &Scene, held: &[HeldMotion]) -> Scene {
    let tool = ToolMotion::new(scene, held);
    let turned = tool.shapes(|joint| joint.extent(Span::all(joint.pieces.len())));
    tool.swept.changed(|arm, _| {
        for (part, cover) in turned.0 {
            arm.links[1].parts[part].shape = cover;
        }
    })
}

/// Returns the index of the bar from joint 2 to the tip among link 2's parts, or `None` without a bar.
fn bar_of(scene: &Scene) -> Option<usize> {
    let is_bar = scene.arm().links[1].source == OutlineSource::Bar;
    scene.own_parts(1).len().checked_sub(1).filter(|_| is_bar)
}

/// Returns true if a shape is a disc about an axis, so that rotations do not change it.
fn is_round(shape: &Convex, axis: Point) -> bool {
    shape.core().iter().all(|corner| (corner - axis).norm() <= AXIS_TOLERANCE)
}
