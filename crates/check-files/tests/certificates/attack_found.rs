//! Falsified certificates of motions. Each must be refused, or the motion must still be free. A floating-point oracle
//! that shares no code with the checker decides this: it samples the motion by its own power series, and measures
//! distances of sides and corners.

use crate::common::plane::{P, bar_at, distance_to_segment, segment_distance};
use crate::common::robots::{LIMIT, two_bars};
use crate::common::verdict::found;
use cplan_cases as random;
use cplan_cases::dice::Dice;
use cplan_check_files::{CheckError, check};

const START: [f64; 2] = [-1.0, 0.2];
const GOAL: [f64; 2] = [1.0, -0.3];

/// Number of samples per piece.
const SAMPLES: u32 = 200;

/// Number of samples per piece in tests where the motion between samples matters.
const FINE: u32 = 4_000;

/// A time, followed by values, velocities and accelerations.
type Knot = [f64; 7];

/// A claim that a motion is free of the obstacles: a ring, a bent wall and a disc.
#[derive(Clone, Debug)]
struct Claim {
    way: usize,
    knots: Vec<Knot>,
    clearance: f64,
    ring: Vec<P>,
    wall: Vec<P>,
    center: P,
    radius: f64,
}

const WAYS: [&str; 4] = ["linear", "cubic", "quartic", "quintic"];

impl Claim {
    /// Returns a true claim: a motion with some knots, of a slow and a swinging joint, among obstacles that it avoids.
    fn random_true(random: &mut Dice) -> Self {
        loop {
            let count = 2 + random.below(5);
            let mut knots: Vec<Knot> = (0..count)
                .map(|k| {
                    let t = k as f64 / (count - 1) as f64;
                    let q1 = START[0] + (GOAL[0] - START[0]) * t;
                    let q2 = START[1] + (GOAL[1] - START[1]) * t + random.within(-1.5, 2.5) * t * (1.0 - t) * 4.0;
                    let speed = |random: &mut Dice| random.within(-1.0, 1.0);
                    [t * 2.0, q1, q2, speed(random), speed(random), speed(random), speed(random)]
                })
                .collect();
            knots[0][1..3].copy_from_slice(&START);
            knots[count - 1][1..3].copy_from_slice(&GOAL);
            let around = |random: &mut Dice| {
                let (angle, far) = (random.within(-3.0, 3.0), random.within(0.3, 2.2));
                [far * angle.cos(), far * angle.sin()]
            };
            let near = |random: &mut Dice, [x, y]: P| [x + random.within(-0.4, 0.4), y + random.within(-0.4, 0.4)];
            let [a, b] = [around(random), around(random)];
            let claim = Self {
                way: random.below(4),
                knots,
                clearance: [0.0, 0.01][random.below(2)],
                // Five corners in any order. The ring may cross itself, and then covers the points that it surrounds an
                // odd number of times.
                ring: (0..5).map(|_| near(random, a)).collect(),
                wall: (0..3).map(|_| near(random, b)).collect(),
                center: around(random),
                radius: random.within(0.05, 0.3),
            };
            if claim.keeps_limits(1e-3) && claim.distance(SAMPLES) > claim.clearance + 1e-4 {
                return claim;
            }
        }
    }

    fn falsify(&mut self, random: &mut Dice) {
        let (number, other) = (random.below(self.knots.len()), random.below(self.knots.len()));
        let column = 1 + random.below(6);
        match random.below(10) {
            0 if self.knots.len() > 2 => _ = self.knots.remove(number),
            1 => {
                let (a, b) = (self.knots[number][column], self.knots[other][column]);
                (self.knots[number][column], self.knots[other][column]) = (b, a);
            }
            2 => self.knots[number][column] += random.within(-0.5, 0.5),
            3 => self.knots[number][1 + random.below(2)] += random.within(-3e-5, 3e-5),
            4 => self.knots[number][3 + random.below(4)] *= random.within(-3.0, 5.0),
            5 => self.knots[number][0] += random.within(-0.3, 0.3),
            6 => self.way = random.below(4),
            7 => self.clearance = self.distance(SAMPLES).max(0.0) * random.within(0.8, 1.2),
            8 => self.center = [self.center[0] + random.within(-0.3, 0.3), self.center[1] + random.within(-0.3, 0.3)],
            _ => self.ring[random.below(5)] = [random.within(-2.0, 2.0), random.within(-2.0, 2.0)],
        }
    }

    fn judge(&self) -> Result<String, CheckError> {
        let world = format!(
            "start.joints = {START:?}\ngoal.joints = {GOAL:?}\nclearance = {:?}\n[[obstacle]]\npolygon = {:?}\n\
             [[obstacle]]\npolyline = {:?}\n[[obstacle]]\ncircle = {{ center = {:?}, radius = {:?} }}\n",
            self.clearance, self.ring, self.wall, self.center, self.radius
        );
        let columns = [3, 5, 7, 7][self.way];
        let knots: Vec<String> = self.knots.iter().map(|knot| format!("{:?}", &knot[..columns])).collect();
        let certificate = found("", &format!("{:?}", WAYS[self.way]), &knots.join(","));
        check(&two_bars(), &world, &certificate)
    }

    /// Samples the motion.
    fn samples(&self, count: u32) -> impl Iterator<Item = P> {
        self.knots.windows(2).flat_map(move |pair| {
            let (a, b) = (pair[0], pair[1]);
            let h = b[0] - a[0];
            (0..=count).map(move |i| {
                let t = h * f64::from(i) / f64::from(count);
                [0, 1].map(|joint| {
                    let of = |knot: &Knot| [knot[1 + joint], knot[3 + joint], knot[5 + joint]];
                    let ([p, v, a], [q, w, b]) = (of(&a), of(&b));
                    // The terms that the end requires beyond value, velocity and acceleration at the beginning.
                    match self.way {
                        0 => p + (q - p) * t / h,
                        1 => {
                            let (e, f) = (q - p - v * h, w - v);
                            p + v * t
                                + (3.0 * e / h.powi(2) - f / h) * t.powi(2)
                                + (f / h.powi(2) - 2.0 * e / h.powi(3)) * t.powi(3)
                        }
                        2 => {
                            let (e, f) = (q - p - v * h - a * h * h / 2.0, w - v - a * h);
                            let series =
                                (4.0 * e - f * h) / h.powi(3) * t.powi(3) + (f * h - 3.0 * e) / h.powi(4) * t.powi(4);
                            p + v * t + a * t * t / 2.0 + series
                        }
                        _ => {
                            let (e, f, g) = (q - p - v * h - a * h * h / 2.0, w - v - a * h, b - a);
                            let c = (10.0 * e - 4.0 * f * h + g * h * h / 2.0) / h.powi(3);
                            let d = (-15.0 * e + 7.0 * f * h - g * h * h) / h.powi(4);
                            let k = (6.0 * e - 3.0 * f * h + g * h * h / 2.0) / h.powi(5);
                            p + v * t + a * t * t / 2.0 + c * t.powi(3) + d * t.powi(4) + k * t.powi(5)
                        }
                    }
                })
            })
        })
    }

    fn keeps_limits(&self, room: f64) -> bool {
        self.samples(SAMPLES).all(|q| q.iter().all(|value| value.abs() <= LIMIT - room))
    }

    /// Returns the least distance of the samples from the obstacles; negative inside the ring or the disc.
    fn distance(&self, count: u32) -> f64 {
        let round =
            |points: &[P]| (0..points.len()).map(|i| [points[i], points[(i + 1) % points.len()]]).collect::<Vec<_>>();
        let ring = round(&self.ring);
        let sides: Vec<[P; 2]> = ring.iter().copied().chain(self.wall.windows(2).map(|w| [w[0], w[1]])).collect();
        let mut least = f64::INFINITY;
        for q in self.samples(count) {
            for shape in 0..2 {
                let bar = bar_at(q, shape);
                let edges = round(&bar);
                for edge in &edges {
                    for side in &sides {
                        least = least.min(segment_distance(*edge, *side));
                    }
                    least = least.min(distance_to_segment(self.center, *edge) - self.radius);
                }
                if surrounds(bar[0], &ring)
                    || surrounds(self.center, &edges)
                    || sides.iter().any(|side| surrounds(side[0], &edges))
                {
                    least = -1.0;
                }
            }
        }
        least
    }

    /// Returns true if the certificate's statement is true, up to rounding.
    fn is_true(&self) -> bool {
        let last = self.knots.len() - 1;
        let meets = |knot: &Knot, end: P| (0..2).all(|k| (knot[1 + k] - end[k]).abs() <= 1.0000001e-5);
        self.knots.windows(2).all(|k| k[0][0] < k[1][0])
            && meets(&self.knots[0], START)
            && meets(&self.knots[last], GOAL)
            && self.keeps_limits(-1e-9)
            && self.distance(SAMPLES) > self.clearance - 1e-9
    }
}

/// Returns true if a ring, which may cross itself, surrounds a point an odd number of times. It counts the sides that a
/// ray to the right crosses.
fn surrounds(p: P, ring: &[[P; 2]]) -> bool {
    let crossed = ring
        .iter()
        .filter(|[a, b]| (a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + (b[0] - a[0]) * (p[1] - a[1]) / (b[1] - a[1]));
    crossed.count() % 2 == 1
}

#[test]
fn falsified_certificates_are_refused_or_still_true() {
    let (mut held, mut refused) = (0, 0);
    for seed in random::seeds(120) {
        let mut random = Dice::new(seed);
        let mut claim = Claim::random_true(&mut random);
        // A motion that comes too near between two samples is not an honest claim.
        if seed % 4 == 0 && claim.distance(FINE) > claim.clearance + 1e-6 {
            claim.judge().unwrap_or_else(|why| panic!("seed {seed}: {why}\n{claim:?}"));
        }
        for _ in 0..=random.below(2) {
            claim.falsify(&mut random);
        }
        match claim.judge() {
            Ok(_) => {
                assert!(claim.is_true(), "seed {seed}: {claim:?}");
                held += 1;
            }
            Err(CheckError::Fails(_)) => refused += 1,
            Err(error) => panic!("seed {seed}: {error}"),
        }
    }
    assert!(held > random::times(15) && refused > random::times(20), "{held} held, {refused} refused");
}
