//! Regions that fields prefer or avoid. They are dashed, since the arm may pass through them.

use super::axes::Frame;
use super::chart::Chart;
use super::figure::{Item, Pen, Step, Style, chain};
use super::key::{Key, Sign};
use super::view::RegionView;
use cplan_theme::{AVOIDED, PREFERRED};

const OUTLINE_DASH: &[f64] = &[7.0, 4.0];

/// Draws the regions of the workspace.
pub fn in_workspace(regions: &[RegionView], frame: &Frame) -> Vec<Item> {
    let corners = |region: &RegionView| chain(region.corners.0.iter().map(|p| frame.at(p[0], p[1])), true);
    regions.iter().filter(|region| !region.joints).map(|region| item(region, corners(region))).collect()
}

/// Draws the regions of the configuration space, with copies on axes that are circles.
pub fn in_cspace(regions: &[RegionView], chart: &Chart) -> Vec<Item> {
    regions.iter().filter(|region| region.joints).map(|r| item(r, chart.polygon(&r.corners))).collect()
}

/// Returns the legend of the regions.
pub fn keys(regions: &[RegionView]) -> Vec<Key> {
    let line = |color| Sign::Line(Pen { color, width: 1.4, dash: OUTLINE_DASH });
    let any = |positive: bool| regions.iter().any(|region| (region.epsilon > 0.0) == positive);
    let avoided = any(true).then(|| (line(AVOIDED), "region, epsilon above 0".to_owned()));
    avoided.into_iter().chain(any(false).then(|| (line(PREFERRED), "region, epsilon below 0".to_owned()))).collect()
}

fn item(region: &RegionView, steps: Vec<Step>) -> Item {
    let color = if region.epsilon > 0.0 { AVOIDED } else { PREFERRED };
    Item::Outline(steps, Style::line(color, 1.4).dashed(OUTLINE_DASH))
}
