//! Limits on the torques of the joints.

use super::sample::{TimingError, Trajectory};
use super::tip::Part;
use crate::recorded::torque_samples;
use cplan_dynamics::{Curvature, LimitedTorque, Rates, Torques};
use cplan_handling::Piece;
use cplan_model::Scene;
use cplan_model::space::{Configuration, Path};

/// Fraction of an effort by which the torque may be overestimated on a part of a curve. It determines how finely curves are cut.
const TORQUE_STEP: f64 = 0.01;

/// Number of parts into which a straight stretch is cut to find one acceleration and one speed that are safe on all of
/// it.
const PARTS_PER_STRETCH: u32 = 64;

/// Fraction of the effort, beyond that against gravity, for the acceleration on such a part. The rest is for the speed.
const ACCELERATION_SHARE: f64 = 0.5;

/// Least share of an effort that is assumed to remain beside gravity.
const MIN_REMAINING_EFFORT: f64 = 1e-12;

/// A torque between two samples of a motion may exceed those at the samples by this fraction of an effort.
const SAMPLED_TORQUE_TOLERANCE: f64 = 2e-4;

/// The same fraction during the search for a motion.
const SEARCHED_TORQUE_TOLERANCE: f64 = 2e-3;

/// Greatest number of parts into which a leg is cut to check that the arm can be held everywhere on it.
const MAX_LEG_PARTS: f64 = 1e5;

/// Limits on the torques of an arm's joints: their efforts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TorqueLimit<'a> {
    /// Torques of the arm with its payload, and its efforts.
    pub torques: Torques<'a>,
    /// Fraction of the efforts, beyond those against gravity, that motions may use.
    pub share: f64,
}

/// The torques along a part of a curve whose parameter has the squared speed `z`: for each joint
/// `inertial z' / 2 + bent z + holding`. Each factor is linear between its values at both ends, up to an error.
struct TorquesOnPart {
    ends: [TorqueFactors; 2],
    off: Curvature,
}

/// The three factors of [`TorquesOnPart`] at one place.
struct TorqueFactors {
    inertial: Configuration,
    bent: Configuration,
    holding: Configuration,
}

impl<'a> TorqueLimit<'a> {
    /// Returns the limit for the scene's arm with its load. `None` if motions need not respect efforts.
    pub fn of(scene: &'a Scene) -> Option<Self> {
        Some(Self { torques: Torques::limited(scene)?, share: 1.0 })
    }

    fn on(&self, part: &Part) -> TorquesOnPart {
        let rates = Rates {
            first: [0, 1].map(|k| {
                let of_third = part.third[k].abs() * part.half * part.half / 2.0;
                part.slope[k].abs() + part.bend[k].abs() * part.half + of_third
            }),
            second: [0, 1].map(|k| part.bend[k].abs() + part.third[k].abs() * part.half),
            third: [0, 1].map(|k| part.third[k].abs()),
        };
        let curvature = self.torques.curvature(part.middle, part.half, &rates);
        // Deviation from a chord over the whole part, whose length is `2 half`.
        let off = |curvature: [f64; 2], share: f64| curvature.map(|c| c * part.half * part.half / (2.0 * share));
        let at = |by: f64| {
            let [q, slope, bend] = part.at(by);
            let here = self.torques.at(q);
            let bent = here.inertial(bend) + here.centrifugal(slope);
            TorqueFactors {
                inertial: here.inertial(slope) / self.share,
                bent: bent / self.share,
                holding: here.holding(),
            }
        };
        TorquesOnPart {
            ends: [at(-part.half), at(part.half)],
            off: Curvature {
                inertial: off(curvature.inertial, self.share),
                bent: off(curvature.bent, self.share),
                holding: off(curvature.holding, 1.0),
            },
        }
    }

    /// Returns the conditions on the squared speeds `z0` and `z1` at both ends of a part, as rows `[a, b]` with
    /// `a z0 + b z1 <= 1`. The squared speed is linear in between. `used` is the share of the efforts that may be used.
    ///
    /// With linear factors, a torque is a quadratic polynomial along the part. It is within its limit if its Bernstein
    /// coefficients are.
    pub(super) fn rows(&self, part: &Part, used: f64) -> Vec<[f64; 2]> {
        let TorquesOnPart { ends: [first, last], off } = self.on(part);
        let mut rows = Vec::new();
        for limited in self.torques.limited_torques() {
            let effort = limited.effort;
            let [off_inertial, off_bent, off_holding] =
                [off.inertial, off.bent, off.holding].map(|off| limited.bound(off));
            for sign in [1.0, -1.0] {
                let [i0, b0, h0] = [first.inertial, first.bent, first.holding].map(|x| sign * limited.of(x));
                let [i1, b1, h1] = [last.inertial, last.bent, last.holding].map(|x| sign * limited.of(x));
                let coefficients = [
                    (i0, [b0, 0.0], h0),
                    ((i0 + i1) / 2.0, [b1 / 2.0, b0 / 2.0], (h0 + h1) / 2.0),
                    (i1, [0.0, b1], h1),
                ];
                for (inertial, bent, holding) in coefficients {
                    let room = (used * effort - holding - off_holding).max(MIN_REMAINING_EFFORT * effort);
                    // The inertial factor deviates in the less favourable direction.
                    for inertial in [inertial + off_inertial, inertial - off_inertial] {
                        // z' over the part's length, halved.
                        let rising = inertial / (4.0 * part.half);
                        let row = [bent[0] + off_bent - rising, bent[1] + off_bent + rising];
                        rows.push(row.map(|c| c / room));
                    }
                }
            }
        }
        rows
    }

    /// Returns true if a part is so long that its torques are known only roughly.
    pub(super) fn is_coarse(&self, part: &Part, [z0, z1]: [f64; 2]) -> bool {
        let off = self.on(part).off;
        let rising = (z1 - z0).abs() / (4.0 * part.half);
        let unknown = |k: usize| off.inertial[k] * rising + off.bent[k] * z0.max(z1) + off.holding[k];
        let unknown = [unknown(0), unknown(1)];
        self.torques.limited_torques().any(|limited| limited.bound(unknown) > TORQUE_STEP * limited.effort)
    }

    /// Returns a speed and an acceleration along a straight stretch that are both safe everywhere on it.
    pub(super) fn safe(&self, from: Configuration, to: Configuration) -> [f64; 2] {
        let (offset, count) = (to - from, f64::from(PARTS_PER_STRETCH));
        let length = offset[0].hypot(offset[1]);
        let mut safe = [f64::INFINITY; 2];
        for i in 0..PARTS_PER_STRETCH {
            let TorquesOnPart { ends, off } = self.on(&Part {
                middle: from + offset * ((f64::from(i) + 0.5) / count),
                slope: offset / length,
                bend: Configuration::zeros(),
                third: Configuration::zeros(),
                half: length / (2.0 * count),
            });
            let both = |limited| ends.iter().map(move |end| (limited, end));
            for (limited, end) in self.torques.limited_torques().flat_map(both) {
                let effort = limited.effort;
                let greatest = |factor: Configuration, off: [f64; 2]| limited.of(factor).abs() + limited.bound(off);
                let room = effort - limited.of(end.holding).abs() - limited.bound(off.holding);
                let room = room.max(MIN_REMAINING_EFFORT * effort);
                let squared = (1.0 - ACCELERATION_SHARE) * room / greatest(end.bent, off.bent);
                let pull = ACCELERATION_SHARE * room / greatest(end.inertial, off.inertial);
                safe = [safe[0].min(squared.sqrt()), safe[1].min(pull)];
            }
        }
        safe
    }

    /// Returns an acceleration for each joint. If the accelerations of both joints change by these at once, no torque changes by
    /// more than its effort.
    pub(super) fn accelerations(&self) -> [f64; 2] {
        let inertia = self.torques.greatest_inertia();
        let share =
            |k: usize, limited: LimitedTorque| limited.effort / (2.0 * limited.bound([inertia[0][k], inertia[1][k]]));
        [0, 1].map(|k| self.torques.limited_torques().map(|limited| share(k, limited)).fold(f64::INFINITY, f64::min))
    }

    /// Returns the factor by which accelerating torques on pieces of a motion may exceed the efforts that remain beside gravity.
    /// `None` if they are proven not to exceed them.
    pub(super) fn excess(&self, pieces: &[Piece]) -> Option<f64> {
        let mut excess = 1.0_f64;
        for look in pieces.iter().flat_map(|piece| torque_samples(&self.torques, piece, SEARCHED_TORQUE_TOLERANCE)) {
            for limited in self.torques.limited_torques() {
                let (effort, off) = (limited.effort, limited.bound(look.off));
                if limited.of(look.torque).abs() + off > effort {
                    let left = effort - limited.of(look.holding).abs() - off;
                    let moves = limited.of(look.torque - look.holding).abs();
                    excess = excess.max(moves / left.max(MIN_REMAINING_EFFORT * effort));
                }
            }
        }
        (excess > 1.0).then_some(excess)
    }

    /// Returns the error that a torque exceeds its effort. A motor's torque is stated at its shaft.
    fn too_heavy(&self, limited: &LimitedTorque, at: Configuration, torque: f64) -> TimingError {
        let (joints, motors) = (&self.torques.arm.joints, self.torques.arm.motors);
        let gear = motors.filter(|_| limited.joint.is_none()).map_or(1.0, |motors| motors.gear[0].abs());
        let (drive, unit) = match limited.joint.map(|k| &joints[k]) {
            Some(joint) => (format!("joint \"{}\"", joint.name), joint.effort_unit()),
            None => ("motor 1".to_owned(), "N m"),
        };
        let (torque, effort) = (torque.abs() / gear, limited.effort / gear);
        TimingError::TooHeavy { drive, at: at.into(), torque, effort, unit }
    }

    /// Checks that the torques of a motion are within the efforts.
    ///
    /// # Errors
    /// The first place where they may exceed the efforts.
    pub(super) fn check(&self, pieces: &[Piece]) -> Result<(), TimingError> {
        for piece in pieces {
            for look in torque_samples(&self.torques, piece, SAMPLED_TORQUE_TOLERANCE) {
                let exceeds =
                    |limited: &LimitedTorque| limited.of(look.torque).abs() + limited.bound(look.off) > limited.effort;
                if let Some(limited) = self.torques.limited_torques().find(exceeds) {
                    return Err(self.too_heavy(&limited, piece.at(look.u), limited.of(look.torque)));
                }
            }
        }
        Ok(())
    }

    /// Returns the torques at the samples.
    pub fn along_trajectory(&self, trajectory: &Trajectory) -> Vec<[f64; 2]> {
        let at = |i: usize| {
            let [q, v, a] =
                [&trajectory.position, &trajectory.velocity, &trajectory.acceleration].map(|row| row[i].into());
            // Adding 0 turns minus zeros into zeros.
            <[f64; 2]>::from(self.torques.torque(q, v, a)).map(|torque| torque + 0.0)
        };
        (0..trajectory.time.len()).map(at).collect()
    }

    /// Checks that the efforts of an arm suffice to hold it, with its load, at a configuration. Does nothing if motions need not
    /// respect efforts.
    ///
    /// # Errors
    /// The joint whose effort is too small.
    pub fn check_holding_at(scene: &'a Scene, q: Configuration) -> Result<(), TimingError> {
        Self::of(scene).map_or(Ok(()), |own| own.check_holding(q))
    }

    /// Returns the torque limit of a scene, after checking that the arm can be held against gravity along a whole path. `None` if
    /// motions need not respect efforts.
    ///
    /// # Errors
    /// A place where the arm needs more than a joint's effort.
    pub(super) fn along_path(scene: &'a Scene, path: &Path) -> Result<Option<Self>, TimingError> {
        let own = Self::of(scene);
        own.iter().try_for_each(|own| own.check_holding_along(path))?;
        Ok(own)
    }

    fn check_holding(&self, at: Configuration) -> Result<(), TimingError> {
        let holding = self.torques.at(at).holding();
        match self.torques.limited_torques().find(|limited| limited.of(holding).abs() >= limited.effort) {
            Some(limited) => Err(self.too_heavy(&limited, at, limited.of(holding))),
            None => Ok(()),
        }
    }

    /// Checks that the arm can be held against gravity along a whole path.
    fn check_holding_along(&self, path: &Path) -> Result<(), TimingError> {
        for (from, to) in path.segments() {
            let (offset, half) = ((to - from) / 2.0, 1.0);
            let zero = Configuration::zeros();
            let whole = Part { middle: from + offset, slope: offset, bend: zero, third: zero, half };
            let off = self.on(&whole).off.holding;
            // The error of chords falls with the square of their length.
            let limited = self.torques.limited_torques();
            let share = limited.map(|own| own.bound(off) / (TORQUE_STEP * own.effort)).fold(1.0, f64::max);
            let count = share.sqrt().ceil().min(MAX_LEG_PARTS);
            for i in 0..=count as u32 {
                self.check_holding(from + offset * (2.0 * f64::from(i) / count))?;
            }
        }
        Ok(())
    }
}
