//! Regions that fields prefer or avoid: dashed, since one may pass.

use super::axes::Frame;
use super::color::Rgb;
use super::copies::Window;
use super::figure::{Item, Pen, Style, chain};
use super::legend::{Key, Sign};
use crate::geometry::SimplePolygon;
use crate::model::{Preference, Region};
use crate::space::Configuration;

/// Of regions with a positive epsilon.
const AVOIDED: Rgb = Rgb(0xc4, 0x6a, 0x1d);
/// Of the others.
const PREFERRED: Rgb = Rgb(0x2b, 0x7a, 0x78);
const DASH: &[f64] = &[7.0, 4.0];

/// Those of the workspace.
#[must_use]
pub fn in_workspace(preferences: &[Preference], frame: &Frame) -> Vec<Item> {
    let regions = preferences.iter().filter_map(|preference| match &preference.region {
        Region::Tip(polygon) => Some(item(preference, polygon, &[Configuration::zeros()], frame)),
        Region::Configurations(_) => None,
    });
    regions.collect()
}

/// Those of the configuration space, with their copies on circles.
#[must_use]
pub fn in_cspace(preferences: &[Preference], frame: &Frame, window: &Window) -> Vec<Item> {
    let regions = preferences.iter().filter_map(|preference| match &preference.region {
        Region::Configurations(polygon) => {
            let shifts = window.shifts(polygon.corners().iter().map(|corner| &corner.coords));
            Some(item(preference, polygon, &shifts, frame))
        }
        Region::Tip(_) => None,
    });
    regions.collect()
}

/// What the dashes mean.
#[must_use]
pub fn keys(preferences: &[Preference]) -> Vec<Key> {
    let line = |color| Sign::Line(Pen { color, width: 1.4, dash: DASH });
    let any = |positive: bool| preferences.iter().any(|preference| (preference.epsilon > 0.0) == positive);
    let avoided = any(true).then(|| (line(AVOIDED), "region, epsilon above 0".to_owned()));
    avoided.into_iter().chain(any(false).then(|| (line(PREFERRED), "region, epsilon below 0".to_owned()))).collect()
}

fn item(preference: &Preference, polygon: &SimplePolygon, shifts: &[Configuration], frame: &Frame) -> Item {
    let color = if preference.epsilon > 0.0 { AVOIDED } else { PREFERRED };
    let copy = |shift: &Configuration| {
        let corners = polygon.corners().iter();
        chain(corners.map(|p| frame.at(p.x + shift[0], p.y + shift[1])).collect::<Vec<_>>(), true)
    };
    let steps = shifts.iter().flat_map(copy).collect();
    Item::Outline(steps, Style::line(color, 1.4).dashed(DASH))
}
