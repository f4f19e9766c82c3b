//! The sequence of attempts to follow a line.

use crate::merge::{Merged, Merging};
use crate::motion::{Driver, Motion};
use crate::nodes::{Division, MAX_NODES, Nodes};
use crate::proof::{self, Infeasible, Prover};
use crate::search::{Route, Search};
use crate::sheets::Sheets;
use crate::wrist::{Turns, WristAlong};
use crate::{FollowError, Found, MIN_TOLERANCE, Settings};
use cplan_deviation::{Kinematics, Line, Place};
use cplan_geometry::Point;
use cplan_handling::ToolAngle;
use cplan_model::space::Configuration;
use cplan_model::{Outcome, Scene};
use cplan_text::{chosen_length, length, metres};

/// Shares of the tolerance for straight motions in joint space, and also for blends. They are tried in this order until
/// the motion is proven to be within the tolerance. Where the line is smooth, both deviations have the same direction
/// and do not add up, so each may use more than half of the tolerance.
const SHARES: [f64; 3] = [0.7, 0.28, 0.11];

/// Share of the tolerance by which a place may be out of reach. It is then replaced by the nearest place in reach.
pub(crate) const SLACK_SHARE: f64 = 0.25;

/// Shares of the tolerance for lines that are farther out of reach in places: the first for motions between nodes, the
/// second for the distance of these places from the reach.
const OUTER_SHARES: [[f64; 2]; 2] = [[0.97, 0.9], [0.999, 0.995]];

/// Length up to which a piece is tiny, and greatest deviation of merged pieces, as a share of the tolerance.
const MERGED_SHARE: f64 = 0.1;

/// Greatest change of a piece's heading by merging, as a share of the tolerance of the tool's angle.
const MERGED_TURN_SHARE: f64 = 0.1;

/// Factor by which the deviation of parts is reduced for a proof, if the nodes of the search give none. The number of
/// nodes grows with the root of this factor.
const PROOF_FINENESS: f64 = 64.0;

/// Number of parts of each piece for a proof, unless there would be too many nodes. Long parts may be blocked in the middle.
const PROOF_PARTS: usize = 64;

/// Factor by which the tolerance is reduced if no motion is proven to be within it.
const TOLERANCE_FACTOR: f64 = 0.1;

/// Factors for the tolerance that the hint recommends, in the order in which they are tried.
const WIDER_FACTORS: [f64; 3] = [2.0, 5.0, 20.0];

/// Number of routes that are tried until the wrist stays within its range.
const WRIST_ROUTES: u32 = 8;

/// Greatest number of nodes of a line that is divided more finely for a proof.
const MAX_COARSE_NODES: usize = 20_000;

/// The input of a motion along a line.
#[derive(Clone, Copy)]
pub(crate) struct Follower<'a> {
    pub scene: &'a Scene,
    pub kinematics: &'a Kinematics<'a>,
    /// The line of the file.
    pub line: &'a Line<'a>,
    pub settings: &'a Settings,
    /// The configurations at which the motion begins and ends. `None` if any IK solutions may be used.
    pub ends: Option<[Configuration; 2]>,
}

/// The result of one attempt.
#[expect(clippy::large_enum_variant, reason = "one exists at a time")]
enum Attempt {
    Found(Found),
    /// A motion that is not proven to be within the tolerance. It has the position of the tip where the bound on the
    /// distance is greatest, or `None` if only the angle of the tool is unproven.
    TooFar(Option<Point>),
    NoRoute(Stuck),
    TooLong,
}

/// The place that no route reaches.
struct Stuck {
    place: Place,
    /// True if the range of the wrist is the reason.
    is_wrist: bool,
    /// Distance of the place from the reach of the tip, metres; 0 if it is within reach.
    out_of_reach: f64,
}

impl Follower<'_> {
    /// Searches for a motion, with decreasing shares of the tolerance, until a motion is proven to be within the
    /// tolerance. If no sequence of IK solutions is found, `prove` searches for a proof. `option` formulates the option
    /// that sets a tolerance, for the hint.
    pub fn run<P: From<Infeasible>>(
        &self,
        prove: &dyn Fn(&Prover, &Search) -> Option<P>,
        option: &dyn Fn(&str, f64) -> String,
    ) -> Result<Outcome<Found, P>, FollowError> {
        let is_tangent = |wrist: WristAlong| matches!(wrist.guide.angle, ToolAngle::Tangent(_));
        if self.is_smooth() && self.settings.wrist.is_some_and(is_tangent) {
            return Err(FollowError::TangentWithJerk);
        }
        let mut farthest = None;
        for share in SHARES {
            match self.attempt(self.division(share))? {
                Attempt::Found(found) => return Ok(Outcome::Found(found)),
                Attempt::TooFar(excess) => farthest = farthest.or(Some(excess)),
                Attempt::NoRoute(stuck) if farthest.is_none() => {
                    return Ok(match self.without_route(stuck, prove)? {
                        Outcome::Unknown(why) => Outcome::Unknown(self.advised(why, option)?),
                        known => known,
                    });
                }
                Attempt::NoRoute(_) => break,
                Attempt::TooLong => {
                    let why = format!("the line needs more than {MAX_NODES} parts; split the line into several");
                    return Ok(Outcome::Unknown(self.advised(why, option)?));
                }
            }
        }
        if let Some(found) = self.within_less()? {
            return Ok(Outcome::Found(found));
        }
        let why = match farthest {
            Some(Some(tip)) => {
                let ([x, y], within) = ([1e3 * tip.x, 1e3 * tip.y], length(self.settings.tolerance));
                format!("the motion near ({x:.1}, {y:.1}) mm is not proven to stay within {within} of the line")
            }
            _ => "the tool is not proven to keep its angle along the line".into(),
        };
        Ok(Outcome::Unknown(self.advised(why, option)?))
    }

    /// Returns the reason of an unknown answer. If a motion is found with a greater tolerance, adds this tolerance as a hint.
    fn advised(&self, why: String, option: &dyn Fn(&str, f64) -> String) -> Result<String, FollowError> {
        Ok(match self.wider_tolerance()? {
            Some((text, tolerance)) => format!("{why}; a motion is found with {}", option(&text, tolerance)),
            None => why,
        })
    }

    /// Returns true if jerks are limited.
    fn is_smooth(&self) -> bool {
        self.scene.arm().limits_jerks()
    }

    /// Returns the division of the line for a share of the tolerance.
    fn division(&self, share: f64) -> Division {
        let tolerance = self.settings.tolerance;
        let turn = share * self.settings.greatest_turn();
        let is_even = self.settings.wrist.is_some() || self.is_smooth();
        Division { deviation: share * tolerance, slack: SLACK_SHARE * tolerance, least_parts: 1, turn, is_even }
    }

    /// Searches for a motion within smaller tolerances, because a motion may be proven to be within the given tolerance
    /// only if it is planned with a smaller one.
    fn within_less(&self) -> Result<Option<Found>, FollowError> {
        let smaller = Settings { tolerance: TOLERANCE_FACTOR * self.settings.tolerance, ..*self.settings };
        if smaller.tolerance < MIN_TOLERANCE {
            return Ok(None);
        }
        let finer = Follower { settings: &smaller, ..*self };
        match finer.attempt(finer.division(SHARES[0]))? {
            Attempt::Found(found) => Ok(Some(found)),
            Attempt::TooFar(_) => finer.within_less(),
            Attempt::NoRoute(_) | Attempt::TooLong => Ok(None),
        }
    }

    /// Returns a greater tolerance with which a motion is found, as text and in metres.
    fn wider_tolerance(&self) -> Result<Option<(String, f64)>, FollowError> {
        for factor in WIDER_FACTORS {
            let text = chosen_length(factor * self.settings.tolerance).replace(' ', "");
            let Ok(tolerance) = metres(&text) else { continue };
            let wider = Settings { tolerance, ..*self.settings };
            let wider = Follower { settings: &wider, ..*self };
            if let Attempt::Found(_) = wider.attempt(wider.division(SHARES[0]))? {
                return Ok(Some((text, tolerance)));
            }
        }
        Ok(None)
    }

    /// Plans and judges one motion.
    fn attempt(&self, division: Division) -> Result<Attempt, FollowError> {
        let Self { scene, kinematics, line: written, settings, ends } = *self;
        let tolerance = settings.tolerance;
        let turn = match settings.wrist.map(|wrist| wrist.guide) {
            Some(guide) if matches!(guide.angle, ToolAngle::Tangent(_)) => MERGED_TURN_SHARE * guide.tolerance,
            _ => f64::INFINITY,
        };
        let size = MERGED_SHARE * (tolerance - division.slack).min(division.deviation);
        let merged = &Merged::new(written, Merging { size, turn });
        let line = &Line::of(&merged.pieces);
        let Some(nodes) = &Nodes::new(kinematics, line, Some(&merged.joints), division) else {
            return Ok(Attempt::TooLong);
        };
        let sheets = Sheets::new(kinematics, nodes, settings.elbow);
        let mut search = Search::new(scene, (kinematics, line), nodes, &sheets, division, ends);
        let (route, turns) = match self.route(&mut search, (line, nodes)) {
            Ok(found) => found,
            Err(out_of_range) => {
                // The search knows the last node that it reached. The next one is where it fails.
                let next = (search.furthest.get() + usize::from(search.has_begun())).min(nodes.nodes.len() - 1);
                let place = merged.place(written, &out_of_range.unwrap_or(nodes.nodes[next].place));
                let out_of_reach = kinematics.distance_out_of_reach(place.point).max(0.0);
                return Ok(Attempt::NoRoute(Stuck { place, is_wrist: out_of_range.is_some(), out_of_reach }));
            }
        };
        let driver = Driver { scene, kinematics, written, line, merged, nodes, settings, blend: division.deviation };
        let Motion { timed, deviation, tool, farthest } = driver.motion(&route, turns.as_ref())?;
        let keeps_angle = tool.zip(settings.wrist).is_none_or(|(off, wrist)| off <= wrist.guide.tolerance);
        if deviation > tolerance || !keeps_angle {
            return Ok(Attempt::TooFar((deviation > tolerance).then_some(farthest)));
        }
        let place = |w: &usize| merged.place(written, &nodes.nodes[route.nodes[*w]].place);
        let (changes, waypoints) = (route.changes.iter().map(place).collect(), route.nodes.len());
        Ok(Attempt::Found(Found { timed, deviation, changes, waypoints, tool_deviation: tool }))
    }

    /// Returns the answer if no route reaches a place: a motion along the border of the reach, a proof, or the reason.
    fn without_route<P: From<Infeasible>>(
        &self,
        stuck: Stuck,
        prove: &dyn Fn(&Prover, &Search) -> Option<P>,
    ) -> Result<Outcome<Found, P>, FollowError> {
        let Self { scene, kinematics, line, settings, ends } = *self;
        let (tolerance, division) = (settings.tolerance, self.division(SHARES[0]));
        let Some(nodes) = &Nodes::new(kinematics, line, None, division) else {
            return Ok(Outcome::Unknown(stuck.describe(tolerance)));
        };
        if let Some(infeasible) = proof::out_of_reach(kinematics, nodes, tolerance) {
            return Ok(Outcome::Infeasible(infeasible.into()));
        }
        let mut last = stuck;
        for [deviation, slack] in OUTER_SHARES.map(|shares| shares.map(|share| share * tolerance)) {
            if last.out_of_reach <= SLACK_SHARE * tolerance {
                break;
            }
            match self.attempt(Division { deviation, slack, ..division })? {
                Attempt::Found(found) => return Ok(Outcome::Found(found)),
                Attempt::NoRoute(stuck) => last = stuck,
                Attempt::TooFar(_) | Attempt::TooLong => {}
            }
        }
        let (inner, sheets) = (&*scene.inner(), &Sheets::new(kinematics, nodes, settings.elbow));
        let search = Search::new(scene, (kinematics, line), nodes, sheets, division, ends);
        let prover = Prover { scene, inner, kinematics, line, nodes, sheets, tolerance, wrist: settings.wrist };
        Ok(match prove(&prover, &search) {
            Some(proven) => Outcome::Infeasible(proven),
            None => Outcome::Unknown(last.describe(tolerance)),
        })
    }

    /// Returns a cheap certified route on which the wrist's joint stays within its range, with the values of this joint.
    ///
    /// # Errors
    /// No such route was found. If the wrist is the reason, the error is the first place where it would leave its
    /// range.
    fn route(
        &self,
        search: &mut Search,
        (line, nodes): (&Line, &Nodes),
    ) -> Result<(Route, Option<Turns>), Option<Place>> {
        let mut stuck = None;
        for _ in 0..WRIST_ROUTES {
            let Some(route) = search.route() else { break };
            let Some(wrist) = self.settings.wrist else { return Ok((route, None)) };
            match wrist.turns(self.scene.arm(), line, nodes, &route) {
                Ok(turns) => return Ok((route, Some(turns))),
                Err(waypoint) => {
                    stuck = stuck.or(Some(nodes.nodes[route.nodes[waypoint]].place));
                    if !search.close_before(&route, waypoint) {
                        break;
                    }
                }
            }
        }
        Err(stuck)
    }

    /// Searches for a proof with a finer division of the line.
    pub fn prove_finely(&self, prover: &Prover) -> Option<Infeasible> {
        if prover.nodes.nodes.len() > MAX_COARSE_NODES {
            return None;
        }
        let division = self.division(SHARES[0]);
        let least_parts = (MAX_COARSE_NODES / self.line.pieces.len()).clamp(1, PROOF_PARTS) as u32;
        let turn = self.settings.greatest_turn();
        let finer = Division { deviation: division.deviation / PROOF_FINENESS, least_parts, turn, ..division };
        let nodes = &Nodes::new(self.kinematics, self.line, None, finer)?;
        let sheets = &Sheets::new(self.kinematics, nodes, self.settings.elbow);
        let finer = Prover { nodes, sheets, ..*prover };
        proof::out_of_reach(self.kinematics, nodes, self.settings.tolerance).or_else(|| finer.prove())
    }
}

impl Stuck {
    fn describe(&self, tolerance: f64) -> String {
        let place = self.place;
        if self.is_wrist {
            return format!(
                "the wrist would leave its range at {place}; neither another motion nor a proof of infeasibility was found"
            );
        }
        if self.out_of_reach > 0.0 {
            let [by, within] = [self.out_of_reach, tolerance].map(length);
            return format!(
                "{place} is {by} out of reach; neither a motion within {within} of it nor a proof of infeasibility was found"
            );
        }
        format!("neither a free motion past {place} nor a proof of infeasibility was found")
    }
}
