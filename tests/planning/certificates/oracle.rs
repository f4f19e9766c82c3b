//! Decides whether a certificate is true, as far as samples in floating point show. It has its own kinematics,
//! projections, distances, inverse kinematics and flood fill.

use super::drawn::{Drawn, Goal, Joint, Kind, Outline, PLANES, Solid, V};
use cplan_cases::plane::{cross, distance_to_segment, minus, plus, polygon_distance, sides, turned};
use cplan_testkit::flood::Cells;
use cplan_testkit::solid::dot;
use serde_json::Value;
use std::f64::consts::{PI, TAU};

/// Allowance for rounding, as a fraction of lengths and angles.
const ROUNDING: f64 = 1e-9;

/// A configuration counts as inside a cell if it is at least this far from the sides, as a fraction of the domain.
const INSIDE: f64 = 1e-6;

/// The tip counts as being at a place within this distance, as a fraction of lengths. The checker's tolerance is
/// greater.
const REACHED: f64 = 1e-13;

/// Number of samples of a box along each joint.
const SAMPLES: usize = 3;

impl Joint {
    fn moved(&self, p: V, value: f64) -> V {
        if self.slides {
            plus(p, [value * self.way.cos(), value * self.way.sin()])
        } else {
            turned(p, self.way * value)
        }
    }

    fn domain(&self) -> V {
        self.range.unwrap_or([-PI, PI])
    }
}

impl Drawn {
    /// Returns the position in the world of a point that link 0 or 1 carries.
    fn world_position(&self, link: usize, p: V, q: V) -> V {
        let p = if link == 1 { plus(self.origins[1], self.joints[1].moved(p, q[1])) } else { p };
        let root = plus(self.origins[0], self.joints[0].moved(p, q[0]));
        plus(self.at, turned(root, self.angle))
    }

    pub fn tip(&self, q: V) -> V {
        self.world_position(1, self.tip.unwrap_or_default(), q)
    }
}

/// All points within a radius of the convex hull of some points. The heights are those of the whole body.
struct Body {
    points: Vec<V>,
    radius: f64,
    heights: V,
}

/// Returns the space that a solid covers, or a little more, as seen from its joint.
fn body(drawn: &Drawn, link: usize, Solid { kind, at, rpy }: &Solid) -> Body {
    let [roll, pitch, yaw] = rpy.map(f64::sin_cos);
    let placed = |[x, y, z]: [f64; 3]| {
        let (y, z) = (roll.1 * y - roll.0 * z, roll.0 * y + roll.1 * z);
        let (x, z) = (pitch.1 * x + pitch.0 * z, -pitch.0 * x + pitch.1 * z);
        let (x, y) = (yaw.1 * x - yaw.0 * y, yaw.0 * x + yaw.1 * y);
        [x + at[0], y + at[1], z + at[2]]
    };
    let sides = [-0.5, 0.5];
    let (points, radius): (Vec<[f64; 3]>, f64) = match kind {
        Kind::Box([x, y, z]) => {
            let corners =
                sides.iter().flat_map(|i| sides.iter().flat_map(move |j| sides.map(|k| [i * x, j * y, k * z])));
            (corners.collect(), 0.0)
        }
        Kind::Cylinder([radius, length]) => {
            const CORNERS: u32 = 64;
            let around = |k: u32| TAU * f64::from(k) / f64::from(CORNERS);
            let out = radius / (PI / f64::from(CORNERS)).cos();
            let circle = |z: f64| (0..CORNERS).map(move |k| [out * around(k).cos(), out * around(k).sin(), z]);
            (sides.iter().flat_map(|side| circle(side * length)).collect(), 0.0)
        }
        Kind::Capsule([radius, length]) => (sides.iter().map(|side| [0.0, 0.0, side * length]).collect(), *radius),
        Kind::Sphere(radius) => (vec![[0.0; 3]], *radius),
    };
    let [u, v, n] = PLANES[drawn.plane].0;
    let points: Vec<[f64; 3]> = points.into_iter().map(placed).collect();
    let height: f64 = drawn.heights[..=link].iter().sum();
    let [low, high] = [f64::min, f64::max].map(|most| points.iter().map(|p| p[n]).reduce(most).unwrap());
    let heights = [height + low - radius, height + high + radius];
    Body { points: hull(points.iter().map(|p| [p[u], p[v]]).collect()), radius, heights }
}

fn hull(mut points: Vec<V>) -> Vec<V> {
    points.sort_by(|a, b| a.partial_cmp(b).unwrap());
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let half = |points: &mut dyn Iterator<Item = &V>| {
        let mut chain: Vec<V> = Vec::new();
        for &p in points {
            while let [.., a, b] = chain[..]
                && cross(minus(b, a), minus(p, a)) <= 0.0
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut ring = half(&mut points.iter());
    ring.extend(half(&mut points.iter().rev()));
    ring
}

/// Reads two numbers, clamped so that their squares are finite.
fn pair(value: &Value) -> Option<V> {
    Some([value.get(0)?.as_f64()?, value.get(1)?.as_f64()?].map(|x| x.clamp(-1e100, 1e100)))
}

/// Describes a false statement of a certificate. Returns `None` for a true certificate. The certificate must have the form
/// that the checker accepts.
pub fn false_claim(drawn: &Drawn, certificate: &Value) -> Option<String> {
    let clearance = certificate["clearance"].as_f64().unwrap_or(drawn.clearance);
    let boxes: Vec<[V; 2]> = certificate["boxes"]
        .as_array()?
        .iter()
        .map(|b| [pair(&b["lower"]).unwrap(), pair(&b["upper"]).unwrap()])
        .collect();
    for (number, (entry, [lower, upper])) in certificate["boxes"].as_array()?.iter().zip(&boxes).enumerate() {
        let shape = &certificate["shapes"][entry["shape"].as_u64()? as usize];
        let part = &certificate["parts"][entry["part"].as_u64()? as usize];
        let link = match shape["link"].as_str() {
            Some("upper") => 0,
            Some("fore") => 1,
            _ => return Some(format!("box {number}: {shape} is no link")),
        };
        let named = shape[if drawn.visual { "visual" } else { "collision" }].as_u64();
        let Some(solid) = named.and_then(|n| drawn.solids[link].get(n as usize)) else {
            return Some(format!("box {number}: there is no {shape}"));
        };
        let body = body(drawn, link, solid);
        let (corners, radius) = match part_of(drawn, part) {
            Ok(part) => part,
            Err(why) => return Some(format!("box {number}: {part} {why}")),
        };
        let heights = drawn.obstacles[part["obstacle"].as_u64()? as usize].height;
        let room = ROUNDING * drawn.scale;
        if heights.is_some_and(|[low, high]| body.heights[1] < low - room || high < body.heights[0] - room) {
            return Some(format!("box {number}: at other heights"));
        }
        for [i, j] in (0..SAMPLES * SAMPLES).map(|n| [n % SAMPLES, n / SAMPLES]) {
            let at = |k: usize, n: usize| lower[k] + (upper[k] - lower[k]) * n as f64 / (SAMPLES - 1) as f64;
            let q = [at(0, i), at(1, j)];
            let points: Vec<V> = body.points.iter().map(|p| drawn.world_position(link, *p, q)).collect();
            let apart = polygon_distance(&points, &corners) - body.radius - radius - clearance;
            // Far from the origin, coordinates are less exact.
            let size = points.iter().chain(&corners).flatten().fold(drawn.scale, |most, x| most.max(x.abs()));
            if apart > ROUNDING * size {
                return Some(format!("box {number}: apart by {apart} at {q:?}"));
            }
        }
    }
    connection(drawn, certificate, &boxes)
}

/// Returns a part of an obstacle in its place in the world. Returns an error if the obstacle has no such part.
fn part_of(drawn: &Drawn, part: &Value) -> Result<(Vec<V>, f64), &'static str> {
    let number = part["obstacle"].as_u64().ok_or("names no obstacle")? as usize;
    let obstacle = drawn.obstacles.get(number).ok_or("is of an obstacle that is not there")?;
    let placed = |p: &V| plus(obstacle.at, turned(*p, obstacle.angle));
    let given: Vec<V> = part["corners"].as_array().map_or(Vec::new(), |c| c.iter().filter_map(pair).collect());
    let nearest = |corners: Vec<V>| -> Vec<V> {
        let off = |p: &V, c: &V| (p[0] - c[0]).hypot(p[1] - c[1]);
        let near = |p: &V| *corners.iter().min_by(|a, b| off(p, a).total_cmp(&off(p, b))).unwrap();
        given.iter().map(near).collect()
    };
    match &obstacle.outline {
        Outline::Circle(center, radius) => Ok((vec![placed(center)], *radius)),
        Outline::Polyline(points) => {
            let points: Vec<V> = points.iter().map(placed).collect();
            let named = nearest(points.clone());
            let is_side = points.windows(2).any(|side| named == side || named.iter().rev().eq(side));
            if is_side { Ok((named, 0.0)) } else { Err("is no side") }
        }
        Outline::Rings(rings) => {
            let rings: Vec<Vec<V>> = rings.iter().map(|ring| ring.iter().map(placed).collect()).collect();
            let named = hull(nearest(rings.concat()));
            if named.len() < 3 {
                return Err("has no area");
            }
            // Points of all its triangles are in the polygon, or on its border.
            let is_in = |p: V| {
                let crosses = |&[a, b]: &[V; 2]| {
                    (a[1] <= p[1]) != (b[1] <= p[1]) && (cross(minus(b, a), minus(p, a)) > 0.0) == (b[1] > a[1])
                };
                let sides = || rings.iter().flat_map(|ring| sides(ring));
                let size = named.iter().flatten().fold(drawn.scale, |most, x| most.max(x.abs()));
                sides().filter(crosses).count() % 2 == 1
                    || sides().any(|side| distance_to_segment(p, side) < ROUNDING * size)
            };
            let inner = (2..named.len()).flat_map(|k| {
                let [a, b, c] = [named[0], named[k - 1], named[k]];
                (0..=8).flat_map(move |i| {
                    (0..=8 - i).map(move |j| {
                        let [s, t] = [i, j].map(|n| f64::from(n) / 8.0);
                        [0, 1].map(|x| a[x] + s * (b[x] - a[x]) + t * (c[x] - a[x]))
                    })
                })
            });
            let all = inner.collect::<Vec<V>>();
            if all.into_iter().all(is_in) { Ok((named, 0.0)) } else { Err("is not within the obstacle") }
        }
    }
}

/// Describes how a path leads past the boxes from the start to a goal. Returns `None` if the boxes block all paths.
fn connection(drawn: &Drawn, certificate: &Value, boxes: &[[V; 2]]) -> Option<String> {
    let given = match (pair(&certificate["goal"]), pair(&certificate["goal_tip"])) {
        (Some(goal), _) => Goal::Joints(goal),
        (None, Some(tip)) => Goal::Tip(tip),
        (None, None) => drawn.goal,
    };
    let goals = match given {
        Goal::Joints(goal) => vec![goal],
        Goal::Tip(tip) => reaching(drawn, tip),
    };
    let start = pair(&certificate["start"]).unwrap_or(drawn.start);
    let (domain, circles) = (drawn.joints.map(|joint| joint.domain()), drawn.joints.map(|joint| joint.range.is_none()));
    let reached = reached_past(boxes, domain, circles, start, &goals);
    reached.map(|goal| format!("the goal {goal:?} is connected with the start"))
}

/// Returns a goal to which a path leads from the start past boxes of configurations, if there is one: a flood over the
/// cells between the ends of the boxes. Ends that are not well inside a cell do not count.
pub fn reached_past(boxes: &[[V; 2]], domain: [V; 2], circles: [bool; 2], start: V, goals: &[V]) -> Option<V> {
    let ends = [0, 1].map(|k| {
        let inside = |x: &f64| domain[k][0] < *x && *x < domain[k][1];
        let mut ends: Vec<f64> = boxes.iter().flat_map(|b| [b[0][k], b[1][k]]).filter(inside).collect();
        ends.extend(domain[k]);
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        ends
    });
    let cells = Cells { count: ends.each_ref().map(|ends| ends.len() - 1), circles };
    let mut closed = vec![false; cells.count[0] * cells.count[1]];
    for corners in boxes {
        let place =
            |k: usize, corner: usize| ends[k].partition_point(|end| *end < corners[corner][k]).min(cells.count[k]);
        for i in place(0, 0)..place(0, 1) {
            (place(1, 0)..place(1, 1)).for_each(|j| closed[i * cells.count[1] + j] = true);
        }
    }
    // Finds the cell that contains a configuration well within, if there is one.
    let cell = |q: V| {
        let found = [0, 1].map(|k| {
            let [low, high] = domain[k];
            let value = if circles[k] { low + (q[k] - low).rem_euclid(high - low) } else { q[k] };
            let at = ends[k].partition_point(|e| *e <= value);
            let is_inside = at > 0 && at <= cells.count[k];
            let room = INSIDE * (high - low);
            (is_inside && value - ends[k][at - 1] > room && ends[k][at] - value > room).then(|| at - 1)
        });
        Some(found[0]? * cells.count[1] + found[1]?)
    };
    let start = cell(start).filter(|&start| !closed[start])?;
    let reached = cells.flood([start], |_, next| !closed[next]);
    goals.iter().copied().find(|goal| cell(*goal).is_some_and(|cell| reached[cell]))
}

/// Returns configurations that put the tip at a place, by Newton's method from many starts, damped where joints have no
/// effect.
fn reaching(drawn: &Drawn, tip: V) -> Vec<V> {
    const SEEDS: usize = 12;
    let domain = drawn.joints.map(|joint| joint.domain());
    let units = drawn.joints.map(|joint| if joint.slides { drawn.scale } else { 1.0 });
    let mut found = Vec::new();
    for [i, j] in (0..SEEDS * SEEDS).map(|n| [n % SEEDS, n / SEEDS]) {
        let mut q = [0, 1].map(|k| {
            let share = ([i, j][k] as f64 + 0.5) / SEEDS as f64;
            domain[k][0] + (domain[k][1] - domain[k][0]) * share
        });
        for _ in 0..60 {
            let off = minus(tip, drawn.tip(q));
            let step = 1e-6;
            let column = |k: usize| {
                let [mut more, mut less] = [q, q];
                more[k] += step * units[k];
                less[k] -= step * units[k];
                minus(drawn.tip(more), drawn.tip(less)).map(|d| d / (2.0 * step))
            };
            let [a, b] = [column(0), column(1)];
            // (J^T J + damping) d = J^T off.
            let damping = 1e-12 * drawn.scale * drawn.scale;
            let (aa, ab, bb) = (dot(a, a) + damping, dot(a, b), dot(b, b) + damping);
            let right = [dot(a, off), dot(b, off)];
            let determinant = aa * bb - ab * ab;
            q[0] += (right[0] * bb - right[1] * ab) / determinant * units[0];
            q[1] += (aa * right[1] - ab * right[0]) / determinant * units[1];
        }
        let off = minus(tip, drawn.tip(q));
        let is_within = (0..2).all(|k| drawn.joints[k].range.is_none_or(|[low, high]| low <= q[k] && q[k] <= high));
        if q.iter().all(|v| v.is_finite()) && is_within && off[0].hypot(off[1]) < REACHED * drawn.scale {
            found.push(q);
        }
    }
    found
}
