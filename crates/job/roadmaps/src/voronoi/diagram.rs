//! The Voronoi diagram of the sites on the boundary of free space.

use super::bisector::Bisector;
use super::cell::{Arc, border};
use super::chord_graph::MIN_CHORD_CLEARANCE;
use super::site::{CONTACT_DISTANCE, Site};
use cplan_geometry::{Bounds, BoxTree, Point};
use cplan_interrupt::checkpoint;
use cplan_model::space::{Configuration, JointRange, Segment};
use cplan_planners::cspace::Regions;
use cplan_planners::planner::mesh::Mesh;
use std::f64::consts::{PI, TAU};

/// Greatest distance between a chord and its parabola, radians or metres.
const MAX_SAG: f64 = 1e-3;

/// Greatest distance between a chord and its parabola, as a fraction of the distance from the boundary. It keeps chords off the
/// boundary.
const MAX_SAG_SHARE: f64 = 0.01;

/// A straight piece of the diagram, or a chord of a parabola.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Chord {
    pub ends: Segment,
    /// Distance of the chord from its two sites, at its nearest point.
    pub width: f64,
}

/// The diagram over all of an interval, and over one turn of a circle, since all turns are alike.
#[derive(Debug, Clone)]
pub(super) struct Diagram {
    /// The sites in this range, with sides cut at its ends, then copies of sites around it.
    sites: Vec<Site>,
    /// For each site, the index of its original, and the whole turns of both joints by which it is moved.
    originals: Vec<(usize, [i32; 2])>,
    lower: [f64; 2],
    ranges: [JointRange; 2],
    /// Upper bound on the distance of a configuration from the boundary.
    most: f64,
    pub chords: Vec<Chord>,
}

impl Diagram {
    /// Builds the diagram. `O(n m)` for `n` sites, each with `m` others within twice the greatest distance from the boundary.
    pub fn new(space: &Regions, mesh: &Mesh) -> Self {
        let ranges = space.topology.ranges;
        let part = [0, 1].map(|k| {
            let middle = 0.5 * (space.window[k].0 + space.window[k].1);
            if ranges[k].is_circle() { (middle - PI, middle + PI) } else { (f64::NEG_INFINITY, f64::INFINITY) }
        });
        let (lower, upper) = (part.map(|p| p.0), part.map(|p| p.1));
        let within = |ends: [Point; 2]| Segment::new(ends[0], ends[1]).within(lower, upper);
        let sides = mesh.walls().filter_map(within).filter(|side| !side.is_point());
        let mut sites: Vec<Site> = sides.map(|side| Site::side(side.ends()[0], side.ends()[1])).collect();
        let is_here = |p: Point| (0..2).all(|k| lower[k] <= p[k] && p[k] <= upper[k]);
        sites.extend(mesh.corners().iter().filter(|corner| is_here(corner.at)).map(Site::corner));
        let count = sites.len();
        let most = farthest(space);
        let around = [0, 1].map(|k| if ranges[k].is_circle() { (2.0 * most / TAU).ceil() as i32 } else { 0 });
        let turns = (-around[0]..=around[0]).flat_map(|i| (-around[1]..=around[1]).map(move |j| [i, j]));
        let mut originals: Vec<(usize, [i32; 2])> = (0..count).map(|site| (site, [0; 2])).collect();
        for turns in turns.filter(|turns| *turns != [0; 2]) {
            for site in 0..count {
                let copy = sites[site].turned(turns.map(f64::from));
                let is_near = |k: usize| {
                    copy.at[k].min(copy.to[k]) <= upper[k] + 2.0 * most
                        && copy.at[k].max(copy.to[k]) >= lower[k] - 2.0 * most
                };
                if is_near(0) && is_near(1) {
                    sites.push(copy);
                    originals.push((site, turns));
                }
            }
        }
        let mut diagram = Self { sites, originals, lower, ranges, most, chords: Vec::new() };
        diagram.chords = diagram.drawn(count);
        diagram
    }

    /// Returns all chords of the cells of the first `count` sites, each chord once.
    fn drawn(&self, count: usize) -> Vec<Chord> {
        let bounds = |site: &Site| [site.at.inf(&site.to), site.at.sup(&site.to)];
        let tree = BoxTree::new(self.sites.iter().map(bounds).collect());
        let mut chords = Vec::new();
        for number in 0..count {
            let site = &self.sites[number];
            for arc in self.cell(&tree, number, bounds(site)) {
                let (other, turns) = self.originals[arc.bisector.other];
                // Of two sites, a side is preferred to a corner, because its parabolas are polynomials; otherwise the lower
                // number is.
                if number < other || (number == other && turns > [0; 2]) {
                    chord(site, &self.sites[arc.bisector.other], &arc, [arc.from, arc.to], &mut chords);
                }
            }
        }
        chords
    }

    /// Returns the border of a site's cell. Uses only nearby sites, after proving that the others have no effect.
    fn cell(&self, tree: &BoxTree, number: usize, bounds: Bounds) -> Vec<Arc> {
        let most = self.most;
        let site = &self.sites[number];
        let extent = site.range[1] - site.range[0];
        let mut reach = extent.min(most);
        loop {
            let grow = Configuration::repeat(2.0 * reach);
            let mut near = Vec::new();
            tree.meeting(&[bounds[0] - grow, bounds[1] + grow], &mut near);
            near.retain(|&other| other as usize != number);
            let between = |&other: &u32| Bisector::between(site, &self.sites[other as usize], other as usize);
            let bisectors: Vec<_> = near.iter().flat_map(between).collect();
            let arcs = border(site, &self.sites, &bisectors);
            let greatest = arcs.iter().map(Arc::greatest).fold(0.0, f64::max);
            let covered: f64 = arcs.iter().map(|arc| arc.to - arc.from).sum();
            let is_closed = greatest.is_finite() && covered > extent * (1.0 - 1e-6);
            if (is_closed && greatest <= reach) || reach >= most {
                return arcs;
            }
            reach = if is_closed { greatest.min(most) } else { (4.0 * reach).min(most) };
        }
    }

    /// Returns the copy of a point in the diagram's range, and the turns that lead back to the point.
    fn at_home(&self, p: Point) -> (Point, [f64; 2]) {
        let turns =
            [0, 1].map(|k| if self.ranges[k].is_circle() { ((p[k] - self.lower[k]) / TAU).floor() } else { 0.0 });
        (moved(p, turns.map(|turn| -turn)), turns)
    }

    /// Returns the point where the line from `p`, away from the nearest site, meets the diagram (O'Dunlaing, Yap 1985). Linear in
    /// the number of sites.
    pub fn retracted(&self, p: Point) -> Option<Point> {
        let (home, turns) = self.at_home(p);
        let distance = |site: &Site| (home - site.nearest(home)).norm();
        let nearest = self.sites.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        let from = nearest.nearest(home);
        let displacement = home - from;
        // On the boundary, any ray of the site serves.
        let ray = if displacement.norm() > CONTACT_DISTANCE {
            (from, displacement.normalize())
        } else {
            (home, nearest.ray(0.5 * (nearest.range[0] + nearest.range[1])).1)
        };
        let others = self.sites.iter().filter(|site| !std::ptr::eq(*site, nearest));
        let height = others.map(|site| site.limit(ray)).fold(f64::INFINITY, f64::min);
        height.is_finite().then(|| moved(ray.0 + ray.1 * height, turns))
    }

    /// Returns the distance of a free segment from the boundary. Linear in the number of sites and in the segment's length.
    pub fn clearance(&self, a: Point, b: Point) -> f64 {
        // Long segments are halved, because copies of sites exist only within twice the greatest distance around the range.
        if (b - a).norm() > self.most {
            let middle = a + (b - a) / 2.0;
            return self.clearance(a, middle).min(self.clearance(middle, b));
        }
        let (home, _) = self.at_home(a);
        let there = home + (b - a);
        self.sites.iter().map(|site| site.distance(home, there)).fold(f64::INFINITY, f64::min)
    }

    /// Iterates over all chords in a window, including their copies.
    pub fn repeated(&self, window: [(f64, f64); 2]) -> impl Iterator<Item = Chord> + '_ {
        let (lower, upper) = (window.map(|w| w.0), window.map(|w| w.1));
        self.chords.iter().flat_map(move |chord| {
            let [a, b] = chord.ends.ends();
            let turns = [0, 1].map(|k| match self.ranges[k] {
                JointRange::Interval { .. } => 0..=0,
                JointRange::Circle => {
                    let turns = |value: f64| (value / TAU).ceil() as i32;
                    turns(lower[k] - a[k].max(b[k]))..=-turns(a[k].min(b[k]) - upper[k])
                }
            });
            let [first, second] = turns;
            first.flat_map(move |i| second.clone().map(move |j| [f64::from(i), f64::from(j)])).filter_map(
                move |turns| {
                    let ends = chord.ends.turned(turns).within(lower, upper)?;
                    (!ends.is_point()).then_some(Chord { ends, ..*chord })
                },
            )
        })
    }
}

/// Returns an upper bound on the distance of a configuration from the boundary: on an interval, a limit is nearer; on two
/// circles, a copy of any site is.
fn farthest(space: &Regions) -> f64 {
    let extents = [0, 1].map(|k| space.window[k].1 - space.window[k].0);
    let circles = space.topology.ranges.map(JointRange::is_circle);
    let half = |k: usize| 0.5 * extents[k];
    match circles {
        [true, true] => PI.hypot(PI),
        [true, false] => half(1),
        [false, true] => half(0),
        [false, false] => half(0).min(half(1)),
    }
}

/// Returns a point moved by whole turns.
fn moved(p: Point, turns: [f64; 2]) -> Point {
    Segment::point(p).turned(turns).ends()[0]
}

/// Appends chords of an arc, which is halved until they are accurate enough.
fn chord(site: &Site, other: &Site, arc: &Arc, [from, to]: [f64; 2], chords: &mut Vec<Chord>) {
    let heights = [from, to].map(|t| arc.bisector.height(t));
    if !(heights[0] + heights[1]).is_finite() {
        return;
    }
    // Narrower passages are not used. Where a corner almost touches a side, rounding errors dominate heights.
    if arc.bisector.sag(to - from) > MAX_SAG.min(MAX_SAG_SHARE * heights[0].min(heights[1])).max(MIN_CHORD_CLEARANCE) {
        checkpoint();
        let middle = 0.5 * (from + to);
        if from < middle && middle < to {
            chord(site, other, arc, [from, middle], chords);
            return chord(site, other, arc, [middle, to], chords);
        }
    }
    let place = |t: f64, height: f64| match site.end(t) {
        // Corners of free space stay exact, because rounded ones may be outside free space.
        Some(corner) if height < CONTACT_DISTANCE => corner,
        _ => {
            let (at, direction) = site.ray(t);
            at + direction * height
        }
    };
    let [a, b] = [place(from, heights[0]), place(to, heights[1])];
    let width = site.distance(a, b).min(other.distance(a, b));
    chords.push(Chord { ends: Segment::new(a, b), width });
}
