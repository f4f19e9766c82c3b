//! A checked configuration: the arm in it, its contacts, and the nearest free configuration.

use super::arm::{self, GHOST_LOOK, UNREACHED_LOOK};
use super::axes::Frame;
use super::chart::Chart;
use super::figure::{Item, Pen, Step, Style};
use super::key::{Key, Sign};
use super::output::checked_words;
use super::view::WorldView;
use cplan_engine::findings::{ConfigurationFindings, PairFinding};
use cplan_geometry::Convex;
use cplan_model::space::Configuration;
use cplan_model::{Arm, Contact, Scene};
use cplan_theme::{GRAY, INFEASIBLE, INK, WHITE};
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
    /// Places of contact in the plane: corners of one shape within the other, and crossings of sides.
    contacts: Vec<[f64; 2]>,
    /// The nearest free configuration. `None` if the configuration is free, or if the search found none.
    #[serde(skip_serializing_if = "Option::is_none")]
    nearest_free: Option<[f64; 2]>,
    /// The shortest line to the obstacles. `None` if the arm touches one, or if no obstacle exists.
    #[serde(skip_serializing_if = "Option::is_none")]
    nearest: Option<DistanceView>,
    /// Key figures: name, value and meaning of each.
    cards: Vec<[String; 3]>,
}

/// The shortest line from the arm to the obstacles.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct DistanceView {
    /// A point of the arm, and one of an obstacle.
    ends: [[f64; 2]; 2],
    /// The distance in words.
    text: String,
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
            nearest: None,
            cards: Vec::new(),
        }
    }
}

impl CheckedView {
    /// Returns the view of these findings about a scene, with key figures and the shortest line to the obstacles.
    pub fn new(scene: &Scene, findings: &ConfigurationFindings) -> Self {
        let q = findings.configuration.into();
        // A level payload in the gripper has derived shapes; pictures show the original ones.
        let scene = &*scene.drawn();
        let nearest = scene.closest(q).filter(|near| near.separation.distance > 0.0 && !scene.is_attached(near.pair));
        let nearest = nearest.map(|near| DistanceView {
            ends: shortest_line(scene, q, &near),
            text: checked_words::distance(near.separation.distance, findings.required),
        });
        Self { nearest, cards: checked_words::cards(scene, findings), ..Self::from(findings) }
    }

    /// Returns true if the configuration is not free.
    pub(crate) fn is_blocked(&self) -> bool {
        self.is_blocked
    }
}

/// Returns the nearest points of two shapes that are apart, the arm's first.
fn shortest_line(scene: &Scene, q: Configuration, near: &Contact) -> [[f64; 2]; 2] {
    let part = scene.part(near.pair).at(&scene.arm().pose(near.pair.link, q));
    let piece = scene.piece(near.pair);
    let corners = |shape: &Convex| shape.core().iter().map(|p| [p.x, p.y]).collect::<Vec<_>>();
    let (mine, others) = (corners(&part), corners(piece));
    let [from, to] = nearest_points(&mine, &others);
    let along = near.separation.direction;
    let moved = |p: [f64; 2], by: f64| [p[0] + by * along.x, p[1] + by * along.y];
    [moved(from, part.radius()), moved(to, -piece.radius())]
}

/// Returns the nearest points of two convex polygons that are apart. At least one of the points is a corner.
pub fn nearest_points(a: &[[f64; 2]], b: &[[f64; 2]]) -> [[f64; 2]; 2] {
    let sides = |of: &[[f64; 2]]| (0..of.len()).map(|i| [of[i], of[(i + 1) % of.len()]]).collect::<Vec<_>>();
    let from_corners = |corners: &[[f64; 2]], of: &[[f64; 2]]| {
        let sides = sides(of);
        let pairs = corners.iter().flat_map(|&p| sides.iter().map(move |&side| [p, foot(p, side)]));
        pairs.collect::<Vec<_>>()
    };
    let ours = from_corners(a, b);
    let theirs = from_corners(b, a).into_iter().map(|[p, q]| [q, p]);
    let length = |[p, q]: &[[f64; 2]; 2]| (p[0] - q[0]).hypot(p[1] - q[1]);
    ours.into_iter().chain(theirs).min_by(|p, q| length(p).total_cmp(&length(q))).unwrap_or_default()
}

/// Returns the point on a side that is nearest to `p`.
fn foot(p: [f64; 2], [a, b]: [[f64; 2]; 2]) -> [f64; 2] {
    let along = [b[0] - a[0], b[1] - a[1]];
    let square = along[0] * along[0] + along[1] * along[1];
    let part = ((p[0] - a[0]) * along[0] + (p[1] - a[1]) * along[1]) / square;
    let part = if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 };
    [a[0] + part * along[0], a[1] + part * along[1]]
}

/// Returns the point where the lines through two sides cross, up to rounding. `None` if they are parallel.
fn crossing([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> Option<[f64; 2]> {
    let minus = |p: [f64; 2], q: [f64; 2]| [p[0] - q[0], p[1] - q[1]];
    let cross = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
    let (along, other) = (minus(b, a), minus(d, c));
    let part = cross(minus(c, a), other) / cross(along, other);
    part.is_finite().then(|| [a[0] + part * along[0], a[1] + part * along[1]])
}

/// Draws the arm in red if it is not free, the nearest free configuration as a ghost, and the contacts.
pub fn in_workspace(checked: &CheckedView, of: &Arm, world: &WorldView, frame: &Frame) -> Vec<Item> {
    let payload = world.payload.as_ref();
    let mut items = Vec::new();
    if let Some(q) = checked.nearest_free {
        items.extend(arm::items(frame, of, payload, q.into(), &GHOST_LOOK));
    }
    if checked.is_blocked {
        items.extend(arm::items(frame, of, payload, checked.at.into(), &UNREACHED_LOOK));
    }
    if let Some(DistanceView { ends: [from, to], .. }) = &checked.nearest {
        let steps = vec![Step::Move(frame.at(from[0], from[1])), Step::Line(frame.at(to[0], to[1]))];
        items.push(Item::Outline(steps, Style::line(INK, 2.0)));
    }
    items.extend(checked.contacts.iter().map(|&[x, y]| contact_marker(frame.at(x, y))));
    items
}

/// Draws the mark of a contact.
pub fn contact_marker(at: [f64; 2]) -> Item {
    Item::Disc(at, CONTACT_RADIUS, Style::line(WHITE, 1.2).filled(INFEASIBLE))
}

/// Draws the nearest free configuration.
pub fn in_cspace(checked: &CheckedView, chart: &Chart) -> Option<Item> {
    let style = Style::line(GRAY, 2.0).filled(WHITE);
    checked.nearest_free.map(|q| Item::Disc(chart.place(q.into()), 5.0, style))
}

/// Returns the legend of the marks.
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
    fn the_nearest_points_of_polygons_are_on_their_sides() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let point = [[3.0, 0.25]];
        assert_eq!(nearest_points(&square, &point), [[1.0, 0.25], [3.0, 0.25]]);
        assert_eq!(nearest_points(&point, &square), [[3.0, 0.25], [1.0, 0.25]]);
    }

    #[test]
    fn sides_cross_where_their_lines_meet() {
        assert_eq!(crossing([[0.0, 0.0], [2.0, 2.0]], [[0.0, 2.0], [2.0, 0.0]]), Some([1.0, 1.0]));
        assert_eq!(crossing([[0.0, 0.0], [1.0, 0.0]], [[0.0, 1.0], [1.0, 1.0]]), None);
    }
}
