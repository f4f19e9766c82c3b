//! Shapes the motions of both arms at once, so that they end early.
//!
//! The motion of each joint is a quadratic spline: its acceleration is constant in each of [`INTERVALS`] intervals of the same
//! length. The unknowns are the control points of all four joints and the squared length of an interval. So limits of
//! accelerations are linear, limits of speeds are convex, and only distances are not. An interior-point method shortens
//! the motion: barriers keep it within the limits and at its distances, and their weight falls. Each step minimises a
//! quadratic model. The result is the best motion near the given one. It is a proposal, which others certify.

mod distances;
mod model;

use crate::between::Between;
use crate::joint_tree::JointRoute;
use cplan_interrupt::checkpoint;
use cplan_judge::certify;
use cplan_model::space::{Configuration, JointRange, Path};
use cplan_motion::{Drive, Rounding, TimedMotion, TorqueLimit, Trajectory, nanoseconds, round_up, seconds};
use model::{Model, barrier};

/// Number of intervals of a motion. The least duration from rest to rest in an odd number of intervals is larger by their
/// inverse square.
const INTERVALS: usize = 32;

/// The stages: the weight of the barriers, and the share of the known duration above which a motion is given up after the
/// stage. The duration exceeds the local optimum by about the weight.
const STAGES: [(f64, f64); 3] = [(0.1, f64::INFINITY), (0.03, 1.12), (0.01, 1.0)];

/// Greatest number of steps in a stage.
const MAX_STEPS: usize = 8;

/// Gain of a step at which a stage ends, as a share of the duration.
const ACCEPTED_GAIN: f64 = 1e-3;

/// Greatest change of a control point in a step, radians or metres, and of the squared interval, as a share of it.
const MAX_CHANGE: [f64; 2] = [0.4, 0.5];

/// Greatest number of halvings of a step.
const MAX_HALVINGS: usize = 8;

/// Share by which the first motion is slower than its limits allow. Barriers need room.
const FIRST_SLOWNESS: f64 = 0.2;

/// Distance up to which a barrier keeps links apart, as a share of the reach of the arms.
const BARRIER_RANGE: f64 = 0.1;

/// Distance from the limit of a joint up to which a barrier keeps it away, radians or metres.
const LIMIT_RANGE: f64 = 0.1;

/// Distance to keep at samples in addition to the clearance, as a share of the reach of the arms. Between samples, the arms
/// come nearer.
const MARGIN: f64 = 0.004;

/// Greatest margin as a share of the room at the start and at the goal.
const END_MARGIN_SHARE: f64 = 0.3;

/// Share of accelerations and speeds that stays unused because of rounding.
const RESERVE: f64 = 1e-6;

/// A motion of both arms.
#[derive(Debug, Clone)]
pub(crate) struct Shape {
    /// Control points: the values of the joints of the first arm, then those of the second. The first two are the start, and
    /// the last two the goal.
    controls: Vec<[f64; 4]>,
    /// Length of an interval, seconds.
    interval: f64,
}

/// Shapes motions.
pub(crate) struct Shaping<'a> {
    between: &'a Between<'a>,
    /// Seconds by which the clocks may differ.
    skew: f64,
    /// Distance to keep in addition to the clearance, metres.
    margin: f64,
    greatest_margin: f64,
    /// Range of the barriers around links, metres.
    range: f64,
    velocity: [f64; 4],
    acceleration: [f64; 4],
    joint_ranges: [[f64; 2]; 4],
}

impl Shape {
    /// Returns the duration, seconds.
    fn duration(&self) -> f64 {
        INTERVALS as f64 * self.interval
    }

    /// Returns the number of the unknown of a control point of a joint. `None` for the start and the goal.
    fn unknown(control: usize, joint: usize) -> Option<usize> {
        (2..INTERVALS).contains(&control).then(|| 4 * (control - 2) + joint)
    }

    /// Returns the motion after a step.
    fn after(&self, (step, last): &(Vec<f64>, f64), share: f64) -> Self {
        let mut next = self.clone();
        next.interval *= (1.0 + last * share).sqrt();
        for (k, by) in step.iter().enumerate() {
            next.controls[2 + k / 4][k % 4] += by * share;
        }
        next
    }
}

impl<'a> Shaping<'a> {
    /// Returns `None` if the arms have limits that shapes do not consider: of jerks, torques, motors, or the
    /// speed of the tip, or stops at corners.
    pub fn new(between: &'a Between<'a>, drive: Drive, skew: f64) -> Option<Self> {
        let arms = between.scenes.map(|scene| scene.arm());
        let has_torques = drive.torque || between.scenes.iter().any(|scene| TorqueLimit::of(scene).is_some());
        let is_limited = arms.iter().any(|arm| arm.limits_jerks() || arm.motors.is_some());
        if drive.blend == 0.0 || drive.tip_speed.is_some() || has_torques || is_limited {
            return None;
        }
        let joint = |k: usize| &arms[k / 2].joints[k % 2];
        let joint_range = |k: usize| match joint(k).range {
            JointRange::Interval { lower, upper } => [lower, upper],
            JointRange::Circle => [f64::NEG_INFINITY, f64::INFINITY],
        };
        let reach = arms.map(|arm| arm.reach()).into_iter().fold(0.0, f64::max);
        Some(Self {
            between,
            skew,
            margin: MARGIN * reach,
            greatest_margin: MARGIN * reach,
            range: BARRIER_RANGE * reach,
            velocity: [0, 1, 2, 3].map(|k| joint(k).velocity),
            acceleration: [0, 1, 2, 3].map(|k| joint(k).acceleration),
            joint_ranges: [0, 1, 2, 3].map(joint_range),
        })
    }

    /// Returns the shortest motion that is found from one along a route. `None` if it is not shorter than `before`, seconds.
    pub fn along(&mut self, route: &JointRoute, before: f64) -> Option<Shape> {
        let ends = [route.at(0.0), route.at(route.time())];
        let room = ends.map(|both| self.room(both)).into_iter().fold(f64::INFINITY, f64::min);
        self.margin = self.greatest_margin.min(END_MARGIN_SHARE * room);
        let place = |share: f64| {
            // The arms accelerate up to the middle.
            let gone = if share < 0.5 { 2.0 * share * share } else { 1.0 - 2.0 * (1.0 - share) * (1.0 - share) };
            let [a, b] = route.at(gone * route.time());
            [a[0], a[1], b[0], b[1]]
        };
        let control = |i: usize| match i {
            0 | 1 => place(0.0),
            _ if i >= INTERVALS => place(1.0),
            _ => place((i as f64 - 0.5) / INTERVALS as f64),
        };
        let first = Shape { controls: (0..INTERVALS + 2).map(control).collect(), interval: 1.0 };
        let mut first = self.at_its_limits(first);
        // Arms that rest need some time as well.
        first.interval = (first.interval * (1.0 + FIRST_SLOWNESS)).max(1e-6);
        let shape = self.at_its_limits(self.shortened(first, before)?);
        (shape.interval > 0.0 && shape.duration() < before).then_some(shape)
    }

    /// Returns the motion with the least interval that the limits allow.
    fn at_its_limits(&self, mut shape: Shape) -> Shape {
        let mut least = 0.0_f64;
        for w in shape.controls.windows(3) {
            for (j, (acceleration, velocity)) in self.acceleration.iter().zip(&self.velocity).enumerate() {
                let bend = (w[2][j] - 2.0 * w[1][j] + w[0][j]).abs() / acceleration;
                least = least.max(bend.sqrt()).max((w[2][j] - w[1][j]).abs() / velocity);
            }
        }
        shape.interval = least * (1.0 + RESERVE);
        shape
    }

    /// Shortens a motion that keeps its limits and distances. Returns `None` if the given motion does not, and if the result seems
    /// to be slower than `before`.
    fn shortened(&self, mut shape: Shape, before: f64) -> Option<Shape> {
        for (share, slower) in STAGES {
            let weight = share / (12 * INTERVALS) as f64;
            let reference = shape.interval;
            let mut damping = 0.0;
            let (mut value, mut model) = self.model(&shape, weight, reference)?;
            for _ in 0..MAX_STEPS {
                checkpoint();
                let next = model.step(damping).and_then(|step| self.improved(&shape, &step, weight, reference, value));
                let Some((next, cost, next_model)) = next else {
                    damping = (10.0_f64 * damping).max(1e-2);
                    continue;
                };
                let gain = value - cost;
                (shape, value, model) = (next, cost, next_model);
                damping *= 0.2;
                if gain < ACCEPTED_GAIN {
                    break;
                }
            }
            if shape.duration() > slower * before {
                return None;
            }
        }
        Some(shape)
    }

    /// Returns the motion after a step or a part of it, with its cost and model. `None` if the cost does not fall.
    fn improved(
        &self,
        shape: &Shape,
        step: &(Vec<f64>, f64),
        weight: f64,
        reference: f64,
        value: f64,
    ) -> Option<(Shape, f64, Model)> {
        let largest = step.0.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let first = (MAX_CHANGE[0] / largest).min(MAX_CHANGE[1] / step.1.abs()).min(1.0);
        (0..MAX_HALVINGS).find_map(|halvings| {
            let next = shape.after(step, first * 0.5_f64.powi(halvings as i32));
            let (cost, model) = self.model(&next, weight, reference)?;
            (cost < value).then_some((next, cost, model))
        })
    }

    /// Returns the cost of a motion, and its model. The last unknown of the model is the squared interval, relative to its value.
    /// Returns `None` if the motion violates a limit or a distance.
    fn model(&self, shape: &Shape, weight: f64, reference: f64) -> Option<(f64, Model)> {
        let (c, count) = (&shape.controls, 4 * (INTERVALS - 2));
        let shift = (self.skew / shape.interval).ceil().min(INTERVALS as f64) as usize;
        let mut model = Model::new(count, (4 * (shift + 3) - 1).min(count - 1));
        // The square of the interval, relative to the reference.
        let square = (shape.interval / reference).powi(2);
        let mut value = 0.5 * square;
        model.last_gradient = 0.5 * square;
        for (i, j) in (2..c.len()).flat_map(|i| (0..4).map(move |j| (i, j))) {
            // Derivatives of a multiple of control points by the unknowns.
            let entries = |factors: &[(usize, f64)], unit: f64| -> Vec<(usize, f64)> {
                let entry = |&(k, factor): &(usize, f64)| Some((Shape::unknown(k, j)?, factor / unit));
                factors.iter().filter_map(entry).collect()
            };
            let unit = self.acceleration[j] * reference * reference;
            let bend = (c[i][j] - 2.0 * c[i - 1][j] + c[i - 2][j]) / unit;
            for sign in [1.0, -1.0] {
                let room = square - sign * bend;
                if room <= 0.0 {
                    return None;
                }
                value -= weight * room.ln();
                let entries = entries(&[(i, 1.0), (i - 1, -2.0), (i - 2, 1.0)], -sign * unit);
                model.add(-weight / room, weight / (room * room), &entries, square);
            }
            let unit = self.velocity[j] * reference;
            let by = (c[i][j] - c[i - 1][j]) / unit;
            let room = square - by * by;
            if room <= 0.0 {
                return None;
            }
            value -= weight * room.ln();
            let mut entries = entries(&[(i, 1.0), (i - 1, -1.0)], unit);
            model.add(0.0, 2.0 * weight / room, &entries, 0.0);
            entries.iter_mut().for_each(|(_, rate)| *rate *= -2.0 * by);
            model.add(-weight / room, weight / (room * room), &entries, square);
            let Some(unknown) = Shape::unknown(i, j) else { continue };
            let [lower, upper] = self.joint_ranges[j];
            for (room, sign) in [(upper - c[i][j], -1.0), (c[i][j] - lower, 1.0)] {
                if room < LIMIT_RANGE {
                    let [cost, slope, curvature] = barrier(room / LIMIT_RANGE)?.map(|term| weight * term);
                    value += cost;
                    model.add(slope, curvature, &[(unknown, sign / LIMIT_RANGE)], 0.0);
                }
            }
        }
        value += self.add_distances(shape, weight, &mut model)?;
        Some((value, model))
    }

    /// Returns the motion of each arm, certified among the obstacles. `None` if no certificate is found.
    pub fn certified(&self, shape: &Shape) -> Option<[TimedMotion; 2]> {
        Some([self.certified_arm(shape, 0)?, self.certified_arm(shape, 1)?])
    }

    fn certified_arm(&self, shape: &Shape, arm: usize) -> Option<TimedMotion> {
        let scene = self.between.scenes[arm];
        let configuration = |c: &[f64; 4]| Configuration::new(c[2 * arm], c[2 * arm + 1]);
        let c: Vec<Configuration> = shape.controls.iter().map(configuration).collect();
        // The motion lies between its control points.
        let topology = scene.arm().topology();
        if c.iter().any(|c| topology.violated_limit(*c).is_some()) {
            return None;
        }
        let step = nanoseconds(round_up(shape.interval));
        let h = seconds(step);
        let mut trajectory = Trajectory::default();
        // Adding 0 turns the minus zero of a joint at rest into zero.
        let row = |v: Configuration| [v[0] + 0.0, v[1] + 0.0];
        let mut greatest = 0.0_f64;
        for k in 0..=INTERVALS {
            let bend = c.get(k + 2).map_or(Configuration::zeros(), |next| next - c[k + 1] * 2.0 + c[k]);
            greatest = greatest.max(bend.norm());
            trajectory.time.push(seconds(step * k as u64));
            trajectory.position.push(row((c[k] + c[k + 1]) / 2.0));
            trajectory.velocity.push(row((c[k + 1] - c[k]) / h));
            trajectory.acceleration.push(row(bend / (h * h)));
        }
        let path = Path::new(trajectory.position.iter().map(|q| (*q).into()).collect());
        let path = certify(scene, path).ok()?;
        // A parabola leaves its chord by an eighth of its bend.
        let count = path.path().waypoints().len();
        let radii = (0..count).map(|k| if k == 0 || k + 1 == count { 0.0 } else { greatest / 4.0 }).collect();
        let rounding = Rounding::new(scene, &path, scene.workspace().clearance);
        Some(TimedMotion { curve: rounding.certified(radii, &trajectory.pieces())?, trajectory })
    }
}
