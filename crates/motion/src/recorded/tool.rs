//! Heights and shapes of the arm while joints other than the two planned ones move.
//!
//! During a span of time, a lifted part counts with all its heights from the least to the greatest. This is enough to
//! prove that a span is free. A contact is reported only if the heights meet at one moment. A part that a wrist turns
//! counts as the disc that it sweeps about the wrist's axis. A contact of such a disc is reported only if the part is a
//! disc itself.

use crate::{Place, Span};
use cplan_core::check::Deviation;
use cplan_core::model::{Heights, Pair, Part, Scene};
use cplan_geometry::{Convex, Point};
use cplan_handling::{HeldEffect, HeldMotion, Piece};

/// Greatest distance of the centre of a round part from its axis of rotation, metres. It allows for rounding.
const AXIS_TOLERANCE: f64 = 1e-9;

/// A joint that lifts some bodies.
struct Lift<'a> {
    pieces: Vec<Piece>,
    /// The value of the joint in the scene that holds it still, and the direction of increasing values.
    rest: f64,
    sign: f64,
    bodies: &'a [String],
}

impl Lift<'_> {
    /// Returns bounds on the joint's lift during a span, in metres relative to the held value.
    fn extent(&self, span: Span) -> [f64; 2] {
        let (middle, deviation) = span.deviation(&self.pieces);
        let half = match deviation {
            Deviation::Box([half, _]) => half,
            Deviation::Tube(chord, [half, _]) => chord[0].abs() + half,
            Deviation::Along(chord) => chord[0].abs(),
        };
        let lift = self.sign * (middle[0] - self.rest);
        [lift - half, lift + half]
    }
}

/// The arm's scene while joints move that the scene holds still.
pub(super) struct ToolMotion<'a> {
    lifts: Vec<Lift<'a>>,
    /// The scene with parts at the heights of the held joints, and with discs in place of parts that turn.
    still: Scene,
    /// The scene with parts at all heights that they take during the motion, and with the pairs that meet at some of
    /// them.
    swept: Scene,
    /// For each part of both links, true if its shape covers more than the part, as a disc for a turning part does.
    covers: [Vec<bool>; 2],
}

impl<'a> ToolMotion<'a> {
    /// Creates a scene in which these joints move.
    pub fn new(scene: &Scene, motions: &'a [HeldMotion]) -> Self {
        let mut lifts = Vec::new();
        let mut turns: Vec<(Point, &[String])> = Vec::new();
        for HeldMotion { joint, values } in motions {
            match joint.effect {
                HeldEffect::Lifts { sign } => {
                    lifts.push(Lift { pieces: values.pieces(), rest: joint.value, sign, bodies: &joint.bodies });
                }
                HeldEffect::Turns { axis } => turns.push((axis, &joint.bodies)),
                HeldEffect::Unjudged { .. } => {}
            }
        }
        let axis_of = |part: &Part| turns.iter().find(|(_, bodies)| bodies.contains(&part.body)).map(|(axis, _)| *axis);
        let is_cover = |part: &Part| axis_of(part).is_some_and(|axis| !is_round(&part.shape, axis));
        let covers = scene.arm().links.each_ref().map(|link| link.parts.iter().map(is_cover).collect());
        let turned = |part: &mut Part| {
            if let Some(axis) = axis_of(part).filter(|axis| !is_round(&part.shape, *axis)) {
                (part.shape, part.inner) = (swept_disc(&part.shape, axis), None);
            }
        };
        let all = |part: &mut Part| {
            turned(part);
            for lift in lifts.iter().filter(|lift| lift.bodies.contains(&part.body)) {
                part.heights = part.heights.lifted(lift.extent(Span::all(lift.pieces.len())));
            }
        };
        let [still, swept] = [
            scene.reshaped(turned, |obstacle| obstacle.pieces.clone()),
            scene.reshaped(all, |obstacle| obstacle.pieces.clone()),
        ];
        let swept = swept.with_self_heights(|link, heights| {
            let carried = lifts.iter().filter(|lift| lift.bodies.iter().any(|body| body == link));
            carried.fold(heights, |heights, lift| heights.lifted(lift.extent(Span::all(lift.pieces.len()))))
        });
        Self { lifts, still, swept, covers }
    }

    /// Returns the scene with all pairs that meet at some time.
    pub fn scene(&self) -> &Scene {
        &self.swept
    }

    /// Returns bounds on the lift of each joint during a span.
    pub fn extents(&self, span: Span) -> Vec<[f64; 2]> {
        self.lifts.iter().map(|lift| lift.extent(span)).collect()
    }

    /// Returns the heights of a pair's part with these lifts, and those of its obstacle.
    fn heights(&self, pair: Pair, extents: &[[f64; 2]]) -> [Heights; 2] {
        let part = &self.still.link(pair).parts[pair.part];
        let lifted = |link: &String, heights: Heights| {
            let lifts = self.lifts.iter().zip(extents).filter(|(lift, _)| lift.bodies.contains(link));
            lifts.fold(heights, |heights, (_, extent)| heights.lifted(*extent))
        };
        let obstacle = self.still.obstacle(pair.obstacle);
        let is_own = self.still.self_obstacle(pair.obstacle).is_some();
        let of_obstacle = if is_own { lifted(&obstacle.name, obstacle.heights) } else { obstacle.heights };
        [lifted(&part.body, part.heights), of_obstacle]
    }

    /// Returns true if the heights of a pair may meet with lifts within these bounds.
    pub fn may_meet(&self, pair: Pair, extents: &[[f64; 2]]) -> bool {
        let [part, obstacle] = self.heights(pair, extents);
        part.meet(obstacle)
    }

    /// Returns true if at a moment the heights of a pair certainly meet, and its part is exact.
    pub fn certainly_meets(&self, pair: Pair, (piece, share): Place) -> bool {
        let is_cover = self.covers[pair.link.min(1)].get(pair.part).is_some_and(|is_cover| *is_cover);
        let [part, obstacle] = self.heights(pair, &self.extents(Span::Part(piece, share, share)));
        !is_cover && part.definitely_meet(obstacle)
    }
}

/// Returns true if a shape is a disc about an axis, unchanged by rotation.
fn is_round(shape: &Convex, axis: Point) -> bool {
    shape.core().iter().all(|corner| (corner - axis).norm() <= AXIS_TOLERANCE)
}

/// Returns the disc about an axis that a shape sweeps.
fn swept_disc(shape: &Convex, axis: Point) -> Convex {
    let farthest = shape.core().iter().map(|corner| (corner - axis).norm()).fold(0.0, f64::max);
    Convex::trusted(vec![axis], (farthest + shape.radius()) * (1.0 + 4.0 * f64::EPSILON))
}
