//! The arm in one configuration, with its payload.

use super::axes::Frame;
use super::figure::{Item, Step, Style};
use super::shapes::union;
use super::view::PayloadView;
use cplan_geometry::Convex;
use cplan_model::Arm;
use cplan_model::space::Configuration;
use cplan_theme::{ACCENT, GRAY, INFEASIBLE, INK, PALE, Rgb, WHITE};

/// Colours and line widths with which an arm is drawn.
pub struct ArmStyle {
    fill: Rgb,
    line: Rgb,
    width: f64,
    opacity: f64,
    joints: bool,
    /// True if names must not lie on the arm. If false, they only avoid its outline, because the arm covers too much of the
    /// panel.
    blocks: bool,
}

impl ArmStyle {
    /// Returns true if names must not lie on the arm.
    pub fn blocks(&self) -> bool {
        self.blocks
    }

    /// Returns this style for a small drawing, with thin lines and without joints.
    #[must_use]
    pub fn thin(&self) -> Self {
        Self { width: 0.5 * self.width, joints: false, ..*self }
    }
}

/// The arm at the start of the motion.
pub const START_LOOK: ArmStyle =
    ArmStyle { fill: WHITE, line: INK, width: 1.4, opacity: 0.9, joints: true, blocks: true };
/// The arm at the goal.
pub const GOAL_LOOK: ArmStyle =
    ArmStyle { fill: PALE, line: INK, width: 1.4, opacity: 0.9, joints: true, blocks: true };
/// The arm at a goal that no motion reaches.
pub const UNREACHED_LOOK: ArmStyle =
    ArmStyle { fill: WHITE, line: INFEASIBLE, width: 1.2, opacity: 0.6, joints: false, blocks: true };
/// The arm at its current configuration.
pub const CURRENT_LOOK: ArmStyle =
    ArmStyle { fill: WHITE, line: ACCENT, width: 2.0, opacity: 1.0, joints: true, blocks: true };
/// The arm at a configuration along the path.
pub const GHOST_LOOK: ArmStyle =
    ArmStyle { fill: cplan_theme::GHOST, line: GRAY, width: 0.8, opacity: 0.7, joints: false, blocks: false };

/// Returns the shapes of the arm and of its payload at `q`.
pub fn placed_shapes(arm: &Arm, payload: Option<&PayloadView>, q: Configuration) -> Vec<Convex> {
    let links = arm.links.iter().zip(arm.poses(q));
    let parts = links.flat_map(|(link, pose)| link.parts.iter().map(move |part| part.shape.at(&pose)));
    let held = payload.into_iter().flat_map(|held| {
        let pose = held.grip.pose(arm, q);
        held.pieces.iter().map(move |piece| piece.0.at(&pose))
    });
    parts.chain(held).collect()
}

/// Draws the arm at `q`: first its outline, then the payload in the object's colour.
pub fn items(frame: &Frame, arm: &Arm, payload: Option<&PayloadView>, q: Configuration, look: &ArmStyle) -> Vec<Item> {
    let body = Style::line(look.line, 2.0 * look.width).filled(look.fill).faded(look.opacity);
    let links = arm.links.iter().zip(arm.poses(q));
    let mut items: Vec<Item> =
        links.map(|(link, pose)| union(frame, link.parts.iter().map(|part| part.shape.at(&pose)), body)).collect();
    if let Some(PayloadView { color, pieces, grip, .. }) = payload {
        let pose = grip.pose(arm, q);
        let style = Style::line(color.darker(0.25), 2.0 * look.width).filled(color.lighter(0.25));
        items.push(union(frame, pieces.iter().map(|piece| piece.0.at(&pose)), style.faded(look.opacity)));
    }
    if look.joints {
        let [base, elbow, tip] = [arm.base, arm.elbow_at(q[0]), arm.tip_at(q)].map(|p| frame.at(p.x, p.y));
        let axis = Style::line(look.line, 1.0).faded(0.7);
        items.push(Item::Outline(vec![Step::Move(base), Step::Line(elbow), Step::Line(tip)], axis));
        items.push(Item::Disc(base, 5.0, Style::fill(INK)));
        items.push(Item::Disc(elbow, 3.5, Style::fill(INK)));
        items.push(Item::Disc(tip, 3.0, Style::line(INK, 1.4).filled(WHITE)));
    }
    items
}
