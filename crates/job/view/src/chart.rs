//! A frame in joint space.

use super::axes::{Frame, Unit};
use super::copies::Window;
use super::figure::{Item, Rect, Step, Style, chain};
use super::view::{Chain, ContourView};
use cplan_geometry::cross;
use cplan_model::space::{Configuration, Topology};
use cplan_model::{Arm, Joint};

/// Both axes have the same scale if the joints are of one kind and the ratio of their ranges is at most this.
const MAX_ONE_SCALE_RATIO: f64 = 2.2;

/// A frame of the page that shows the whole joint space of an arm.
#[derive(Debug, Clone, Copy)]
pub struct Chart {
    /// Frame on the page.
    pub frame: Frame,
    /// Units of the axes.
    pub units: [Unit; 2],
    /// Topology of the joint space: which joints wrap around.
    pub topology: Topology,
    /// Part of joint space in which paths are drawn. Paths that cross seams have copies.
    pub paths: Window,
    /// Part of joint space in which obstacles are drawn. They have a copy for each turn of a revolute joint.
    pub obstacles: Window,
}

impl Chart {
    /// Creates the chart in this part of the page.
    pub fn new(arm: &Arm, area: Rect) -> Self {
        let topology = arm.topology();
        let ranges = topology.ranges.map(|axis| axis.domain());
        let units = units(arm);
        let frame = Frame::fitted(area, ranges[0], ranges[1], one_scale(arm).is_some());
        let paths = Window { ranges, repeats: topology.ranges.map(|axis| axis.is_circle()) };
        // A revolute link meets an obstacle again after each turn, even if the joint has limits.
        let obstacles = Window { ranges, repeats: units.map(|u| u == Unit::Degrees) };
        Self { frame, units, topology, paths, obstacles }
    }

    /// Returns for each axis whether its sides are seams, where the space continues on the opposite side.
    pub fn seams(&self) -> [bool; 2] {
        self.paths.repeats
    }

    /// Returns the place of a configuration on the page.
    pub fn place(&self, q: Configuration) -> [f64; 2] {
        let q = self.topology.wrap(q);
        self.frame.at(q[0], q[1])
    }

    /// Returns the outline of a path, cut at the seams.
    pub fn outline(&self, path: &[Configuration]) -> Vec<Step> {
        let pieces = self.paths.pieces(path);
        pieces.into_iter().flat_map(|p| chain(p.iter().map(|q| self.frame.at(q[0], q[1])), false)).collect()
    }

    /// Returns a closed outline, with copies on circles like those of paths.
    pub fn polygon(&self, Chain(corners): &Chain) -> Vec<Step> {
        self.copies(corners, &self.paths)
    }

    fn copies(&self, corners: &[Configuration], window: &Window) -> Vec<Step> {
        let copy = |s: Configuration| chain(corners.iter().map(move |q| self.frame.at(q[0] + s[0], q[1] + s[1])), true);
        window.shifts(corners).into_iter().flat_map(copy).collect()
    }

    /// Returns contours and their copies as one outline. If the style draws the pen below the fill, it looks like the outline of
    /// their union.
    pub fn c_obstacle<'a>(&self, contours: impl Iterator<Item = &'a ContourView>, style: Style) -> Item {
        let mut steps = Vec::new();
        for Chain(contour) in contours.map(|c| &c.contour) {
            let twice: f64 = (0..contour.len()).map(|i| cross(contour[i], contour[(i + 1) % contour.len()])).sum();
            let mut ordered = contour.clone();
            // The non-zero rule unites only contours of the same orientation.
            if twice < 0.0 {
                ordered.reverse();
            }
            steps.extend(self.copies(&ordered, &self.obstacles));
        }
        Item::Outline(steps, style)
    }
}

/// Returns the units of the axes.
fn units(arm: &Arm) -> [Unit; 2] {
    [0, 1].map(|k| if arm.joints[k].joint_type.is_revolute() { Unit::Degrees } else { Unit::Meters })
}

/// Returns the ratio of height to width of the chart of the whole joint space. `None` if its axes should have different scales.
pub fn one_scale(arm: &Arm) -> Option<f64> {
    let [width, height] = arm.topology().ranges.map(|axis| axis.extent());
    let [first, second] = units(arm);
    (first == second && width <= MAX_ONE_SCALE_RATIO * height && height <= MAX_ONE_SCALE_RATIO * width)
        .then(|| height / width)
}

/// Returns the titles of the axes.
pub fn titles(arm: &Arm) -> [String; 2] {
    [0, 1].map(|k| title(&arm.joints[k]))
}

fn title(joint: &Joint) -> String {
    let name = super::figure::shortened(&joint.name, 14.0, 260.0);
    match (joint.joint_type.is_revolute(), joint.range.is_circle()) {
        (true, true) => format!("{name}, wraps around"),
        (true, false) => name,
        (false, _) => format!("{name} (m)"),
    }
}
