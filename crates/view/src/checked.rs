//! A checked configuration: the arm there, its contacts, and the nearest free configuration.

use super::arm::{self, GHOST_LOOK, UNREACHED_LOOK};
use super::axes::Frame;
use super::chart::Chart;
use super::figure::{Item, Pen, Style};
use super::key::{Key, Sign};
use super::view::WorldView;
use cplan_core::model::Arm;
use cplan_core::space::Configuration;
use cplan_engine::findings::{ConfigurationFindings, PairFinding};
use cplan_theme::{GRAY, INFEASIBLE, WHITE};
use serde::Serialize;

/// Radius of the mark of a contact, in pixels.
const CONTACT_RADIUS: f64 = 4.0;

/// A checked configuration.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CheckedView {
    /// Joint values.
    at: [f64; 2],
    /// True if the configuration is not free.
    is_blocked: bool,
    /// Places of contact in the plane: corners that lie in the other shape, and crossings of sides.
    contacts: Vec<[f64; 2]>,
    /// The nearest free configuration. `None` if the configuration is free, or if the search found none.
    #[serde(skip_serializing_if = "Option::is_none")]
    nearest_free: Option<[f64; 2]>,
}

impl CheckedView {
    /// Returns the configurations at which the arm is drawn.
    pub fn drawn_arms(&self) -> impl Iterator<Item = Configuration> {
        self.nearest_free.into_iter().chain(self.is_blocked.then_some(self.at)).map(Configuration::from)
    }

    /// Returns the places of contact in the plane.
    pub fn contacts(&self) -> &[[f64; 2]] {
        &self.contacts
    }
}

impl From<&ConfigurationFindings> for CheckedView {
    fn from(findings: &ConfigurationFindings) -> Self {
        let places = |pair: &PairFinding| -> Vec<[f64; 2]> {
            let corners = pair.link_corners_inside.iter().chain(&pair.obstacle_corners_inside).map(|corner| corner.at);
            corners.chain(pair.crossing_sides.iter().filter_map(|&[mine, other]| crossing(mine, other))).collect()
        };
        Self {
            at: findings.configuration,
            is_blocked: !findings.free,
            contacts: findings.contacts.iter().flat_map(places).collect(),
            nearest_free: findings.nearest_free.as_ref().map(|nearest| nearest.configuration),
        }
    }
}

impl CheckedView {
    /// Returns true if the configuration is not free.
    pub(crate) fn is_blocked(&self) -> bool {
        self.is_blocked
    }
}

/// Returns the point in which two sides cross, up to rounding. `None` for parallel sides.
fn crossing([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> Option<[f64; 2]> {
    let minus = |p: [f64; 2], q: [f64; 2]| [p[0] - q[0], p[1] - q[1]];
    let cross = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
    let (along, other) = (minus(b, a), minus(d, c));
    let part = cross(minus(c, a), other) / cross(along, other);
    part.is_finite().then(|| [a[0] + part * along[0], a[1] + part * along[1]])
}

/// Draws the arm in red if it is not free, the nearest free configuration as a ghost, and the contacts.
#[must_use]
pub fn in_workspace(checked: &CheckedView, of: &Arm, world: &WorldView, frame: &Frame) -> Vec<Item> {
    let payload = world.payload.as_ref();
    let mut items = Vec::new();
    if let Some(q) = checked.nearest_free {
        items.extend(arm::items(frame, of, payload, q.into(), &GHOST_LOOK));
    }
    if checked.is_blocked {
        items.extend(arm::items(frame, of, payload, checked.at.into(), &UNREACHED_LOOK));
    }
    items.extend(checked.contacts.iter().map(|&[x, y]| contact_marker(frame.at(x, y))));
    items
}

/// Draws the mark of a contact.
pub fn contact_marker(at: [f64; 2]) -> Item {
    Item::Disc(at, CONTACT_RADIUS, Style::line(WHITE, 1.2).filled(INFEASIBLE))
}

/// Draws the nearest free configuration.
#[must_use]
pub fn in_cspace(checked: &CheckedView, chart: &Chart) -> Option<Item> {
    let style = Style::line(GRAY, 2.0).filled(WHITE);
    checked.nearest_free.map(|q| Item::Disc(chart.place(q.into()), 5.0, style))
}

/// Returns the legend of the marks.
#[must_use]
pub fn keys(checked: &CheckedView) -> Vec<Key> {
    let line = |color, text: &str| (Sign::Line(Pen { color, width: 2.0, dash: &[] }), text.to_owned());
    let blocked = checked.is_blocked.then(|| line(INFEASIBLE, "the arm, not free"));
    let contact = (!checked.contacts.is_empty()).then(|| (Sign::Contact, "contact".to_owned()));
    let nearest = checked.nearest_free.map(|_| line(GRAY, "nearest free configuration"));
    blocked.into_iter().chain(contact).chain(nearest).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_cross_where_their_lines_meet() {
        assert_eq!(crossing([[0.0, 0.0], [2.0, 2.0]], [[0.0, 2.0], [2.0, 0.0]]), Some([1.0, 1.0]));
        assert_eq!(crossing([[0.0, 0.0], [1.0, 0.0]], [[0.0, 1.0], [1.0, 1.0]]), None);
    }
}
