//! The way up a potential between the cells: steepest ascent of its piecewise linear interpolation.

use super::potential::Scaled;
use super::{Component, Potential};
use crate::interrupt::checkpoint;

/// Row and column of a cell on the unbounded lattice: on a circle counted on.
pub type Place = [i64; 2];

/// A point in units of cells; centres of cells are whole numbers.
pub type LatticePoint = [f64; 2];

/// Crossings this near to a centre (in cells) are taken to be at the centre: far above rounding, far below what matters
/// to a path.
const SNAP: f64 = 1e-9;

/// A polyline of steepest ascent and the goal that it comes to.
#[derive(Debug, Clone, PartialEq)]
pub struct Streamline {
    /// From the given point to one in the goal's cell.
    pub points: Vec<LatticePoint>,
    /// Position of the goal.
    pub goal: usize,
    /// Where it is.
    pub place: Place,
}

/// The potential between the cells: linear on triangles of centres, 0 at walls.
///
/// Four neighbouring centres make two triangles, divided along the diagonal that goes to a wall if there is one. So a wall
/// is at an acute corner of its triangle, or another wall is: the points of the triangle that lie in free cells are then
/// convex, and the gradient never leads from there into the wall's cell. (With `x` towards the wall from the right angle,
/// where the value is `c >= 0`, the slope in `x` is `-c`, and the wall's cell begins at `x = 1/2`.)
pub struct Interpolated<'a, F> {
    component: &'a Component,
    potential: &'a Potential,
    /// The position at a place; none for walls and beyond limits.
    at: F,
}

/// Where a path is.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Spot {
    Center(Place),
    /// On the side from the first corner of a triangle to the second, at this part of it.
    Side(Place, Place, f64),
}

impl<'a, F: Fn(Place) -> Option<usize>> Interpolated<'a, F> {
    /// `at` tells the position at a place of the lattice.
    pub fn new(component: &'a Component, potential: &'a Potential, at: F) -> Self {
        Self { component, potential, at }
    }

    /// The polyline of steepest ascent from a point in a free cell until it is in a goal's cell. Its value increases all
    /// along (it may stay the same only along a side between two equal values, from where no triangle leads up), and it
    /// stays in free cells.
    ///
    /// Nothing if there is a local maximum elsewhere, which cannot be where the potential
    /// [navigates](Potential::navigates). A few points a cell.
    #[must_use]
    pub fn ascend(&self, from: LatticePoint) -> Option<Streamline> {
        let mut points = vec![from];
        let mut spot = self.enter(from)?;
        // Each triangle is passed once, but for rounding.
        for _ in 0..=MOST_STEPS * self.component.len() {
            checkpoint();
            points.push(point(spot));
            if let Some((goal, place)) = self.arrived(spot) {
                return Some(Streamline { points, goal, place });
            }
            spot = match spot {
                Spot::Center(place) => self.leave_center(place)?,
                Spot::Side(a, b, t) => self.leave_side(a, b, t)?,
            };
        }
        None
    }

    /// The goal in whose cell a spot lies.
    fn arrived(&self, spot: Spot) -> Option<(usize, Place)> {
        let nearest = match spot {
            Spot::Center(place) => place,
            Spot::Side(a, b, t) => {
                if t <= 0.5 {
                    a
                } else {
                    b
                }
            }
        };
        (self.at)(nearest).filter(|&position| position < self.component.goals).map(|goal| (goal, nearest))
    }

    fn is_wall(&self, place: Place) -> bool {
        (self.at)(place).is_none()
    }

    /// Values at three places, as doubles of a common scale.
    fn values(&self, places: [Place; 3]) -> [f64; 3] {
        let values = places.map(|place| (self.at)(place).map(|position| self.potential.at(position)));
        let exponent = values.iter().flatten().map(|value| value.exponent).max().unwrap_or(0);
        values.map(|value| value.map_or(0.0, |value: Scaled| value.mantissa_at(exponent)))
    }

    /// Whether the square with its least corner at `[i, j]` is divided from there to `[i + 1, j + 1]`, rather than along the
    /// other diagonal.
    fn rises(&self, [i, j]: Place) -> bool {
        if self.is_wall([i, j]) || self.is_wall([i + 1, j + 1]) {
            true
        } else if self.is_wall([i + 1, j]) || self.is_wall([i, j + 1]) {
            false
        } else {
            // Alternating, so that no direction is preferred.
            (i + j).rem_euclid(2) == 0
        }
    }

    /// The third corners of both triangles at a side.
    fn opposite(&self, a: Place, b: Place) -> [Place; 2] {
        let d = [b[0] - a[0], b[1] - a[1]];
        if d[0] != 0 && d[1] != 0 {
            return [[a[0], b[1]], [b[0], a[1]]];
        }
        [-1, 1].map(|side| {
            // The corners of the square on this side that lie across from a and b.
            let n = [d[1].abs() * side, d[0].abs() * side];
            let (beside_a, beside_b) = ([a[0] + n[0], a[1] + n[1]], [b[0] + n[0], b[1] + n[1]]);
            let least = [0, 1].map(|k| a[k].min(beside_b[k]));
            let a_is_on_rising = (a[0] - least[0] + a[1] - least[1]) % 2 == 0;
            if self.rises(least) == a_is_on_rising { beside_b } else { beside_a }
        })
    }

    /// The triangles at a centre, by their other corners.
    fn around(&self, place: Place) -> impl Iterator<Item = [Place; 2]> + '_ {
        [[1, 1], [1, -1], [-1, 1], [-1, -1]].into_iter().flat_map(move |[di, dj]| {
            let [i, j] = place;
            let (one, two, across) = ([i + di, j], [i, j + dj], [i + di, j + dj]);
            let least = [i.min(i + di), j.min(j + dj)];
            let divided_here = self.rises(least) == (di == dj);
            let triangles =
                if divided_here { [Some([one, across]), Some([across, two])] } else { [Some([one, two]), None] };
            triangles.into_iter().flatten()
        })
    }

    /// The gradient on a triangle in units of the sides from its first corner, and its length.
    fn gradient(&self, corners: [Place; 3]) -> ([f64; 2], f64) {
        let [a, b, c] = corners;
        let [u, v, w] = self.values(corners);
        let side = |to: Place| [(to[0] - a[0]) as f64, (to[1] - a[1]) as f64];
        let (s, t) = (side(b), side(c));
        let twice_area = cross(s, t);
        let (rise_s, rise_t) = (v - u, w - u);
        let g = [0, 1].map(|k| {
            let l = 1 - k;
            let turned = if k == 0 { 1.0 } else { -1.0 };
            turned * (rise_s * t[l] - rise_t * s[l]) / twice_area
        });
        ([cross(g, t) / twice_area, cross(s, g) / twice_area], g[0].hypot(g[1]))
    }

    /// From a centre through the triangle or along the side that is the steepest.
    fn leave_center(&self, place: Place) -> Option<Spot> {
        let position = (self.at)(place)?;
        let scale = self.potential.at(position);
        let mut best: Option<(f64, Spot)> = None;
        let mut offer = |slope: f64, spot: Spot| {
            if best.is_none_or(|(steepest, _)| slope > steepest) {
                best = Some((slope, spot));
            }
        };
        for [b, c] in self.around(place) {
            let exponent = self.scale_of([place, b, c]) - scale.exponent;
            let common = |slope: f64| Scaled { mantissa: slope, exponent }.mantissa_at(0);
            let [u, v, w] = self.values([place, b, c]);
            for (end, value) in [(b, v), (c, w)] {
                if value > u {
                    offer(common((value - u) / distance(place, end)), Spot::Center(end));
                }
            }
            let ([s, t], slope) = self.gradient([place, b, c]);
            if s > 0.0 && t > 0.0 {
                offer(common(slope), side(b, c, t / (s + t)));
            }
        }
        best.map(|(_, spot)| spot)
    }

    fn scale_of(&self, places: [Place; 3]) -> i32 {
        let exponents = places.iter().filter_map(|&place| (self.at)(place)).map(|p| self.potential.at(p).exponent);
        exponents.max().unwrap_or(0)
    }

    /// From a side into the triangle that rises from it, the steeper of two, or along it.
    fn leave_side(&self, a: Place, b: Place, t: f64) -> Option<Spot> {
        let [one, two] = self.opposite(a, b).map(|c| {
            let ([along, inward], slope) = self.gradient([a, b, c]);
            (c, along, inward, Scaled { mantissa: slope, exponent: self.scale_of([a, b, c]) })
        });
        let steeper = |x: Scaled, y: Scaled| {
            x.mantissa_at(x.exponent.max(y.exponent)) > y.mantissa_at(x.exponent.max(y.exponent))
        };
        let into = match (one.2 > 0.0, two.2 > 0.0) {
            (true, true) => Some(if steeper(two.3, one.3) { two } else { one }),
            (true, false) => Some(one),
            (false, true) => Some(two),
            (false, false) => None,
        };
        let Some((c, along, inward, _)) = into else {
            let [u, v, _] = self.values([a, b, a]);
            return Some(Spot::Center(if v > u { b } else { a }));
        };
        // To the side from a, or to that from b, whichever comes first.
        let to_first = if along < 0.0 { t / -along } else { f64::INFINITY };
        let to_second = if along + inward > 0.0 { (1.0 - t) / (along + inward) } else { f64::INFINITY };
        let at = to_first.min(to_second) * inward;
        Some(if to_first < to_second { side(a, c, at) } else { side(b, c, at) })
    }

    /// The first spot on the boundary of the triangle around a point.
    fn enter(&self, from: LatticePoint) -> Option<Spot> {
        let least = from.map(|x| x.floor() as i64);
        let [x, y] = [from[0] - least[0] as f64, from[1] - least[1] as f64];
        let [i, j] = least;
        // The right angle first; distances from there along both sides.
        let (corner, one, two, p) = match (self.rises(least), x > y, x + y > 1.0) {
            (true, true, _) => ([i + 1, j], [i, j], [i + 1, j + 1], [1.0 - x, y]),
            (true, false, _) => ([i, j + 1], [i + 1, j + 1], [i, j], [x, 1.0 - y]),
            (false, _, false) => ([i, j], [i + 1, j], [i, j + 1], [x, y]),
            (false, _, true) => ([i + 1, j + 1], [i, j + 1], [i + 1, j], [1.0 - x, 1.0 - y]),
        };
        let weights = [1.0 - p[0] - p[1], p[0], p[1]];
        let corners = [corner, one, two];
        for k in 0..3 {
            let (l, m) = ((k + 1) % 3, (k + 2) % 3);
            if weights[k] >= 1.0 - SNAP {
                return Some(Spot::Center(corners[k]));
            }
            if weights[k] <= SNAP && weights[l] > SNAP && weights[m] > SNAP {
                return Some(side(corners[l], corners[m], weights[m]));
            }
        }
        let ([s, t], _) = self.gradient(corners);
        let rates = [-(s + t), s, t];
        let steps = [0, 1, 2].map(|k| if rates[k] < 0.0 { weights[k] / -rates[k] } else { f64::INFINITY });
        let k = (0..3).min_by(|&a, &b| steps[a].total_cmp(&steps[b]))?;
        if !steps[k].is_finite() {
            // A level triangle: any corner that is no wall will do.
            return corners.into_iter().find(|&corner| !self.is_wall(corner)).map(Spot::Center);
        }
        let (l, m) = ((k + 1) % 3, (k + 2) % 3);
        Some(side(corners[l], corners[m], weights[m] + steps[k] * rates[m]))
    }
}

/// Steps a cell after which an ascent is given up.
const MOST_STEPS: usize = 16;

/// A spot on a side, or the end that it is at.
fn side(a: Place, b: Place, t: f64) -> Spot {
    if t <= SNAP {
        Spot::Center(a)
    } else if t >= 1.0 - SNAP {
        Spot::Center(b)
    } else {
        Spot::Side(a, b, t)
    }
}

fn point(spot: Spot) -> LatticePoint {
    match spot {
        Spot::Center(place) => place.map(|x| x as f64),
        Spot::Side(a, b, t) => [0, 1].map(|k| a[k] as f64 + t * (b[k] - a[k]) as f64),
    }
}

fn distance(a: Place, b: Place) -> f64 {
    ((a[0] - b[0]) as f64).hypot((a[1] - b[1]) as f64)
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}
