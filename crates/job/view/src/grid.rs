//! The panels of configuration spaces, side by side.

use super::chart::{self, Chart};
use super::cspace;
use super::figure::{Anchor, Item, Rect, bold, label, shortened};
use super::view::{PanelView, View};
use cplan_model::Arm;
use cplan_theme::{GRAY, INK};

/// Gap between columns, for the values at the ends of the axes, and gap between rows, for titles, in pixels.
const PANEL_GAPS: [f64; 2] = [40.0, 64.0];
/// Greatest height of two panels one below the other, in pixels.
const MAX_STACKED_HEIGHT: f64 = 640.0;
/// Ratio of height to width of a panel whose axes have different scales.
const PANEL_PROPORTION: f64 = 0.8;

/// The arrangement of the panels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Number of panels.
    count: usize,
    columns: usize,
    /// Width and height of a panel, in pixels.
    size: [f64; 2],
    width: f64,
}

impl Grid {
    /// Arranges the panels in the number of columns that makes them most legible in this width.
    pub fn new(count: usize, arm: &Arm, width: f64) -> Self {
        let proportion = chart::one_scale(arm).unwrap_or(PANEL_PROPORTION).clamp(0.5, 1.2);
        let room = |columns: usize| (width - PANEL_GAPS[0] * (columns - 1) as f64) / columns as f64;
        // Two low panels are larger one below the other.
        let below = ((MAX_STACKED_HEIGHT - PANEL_GAPS[1]) / 2.0 / proportion).min(room(1));
        let (columns, side) = match count {
            0..=1 => (1, room(1).min(530.0)),
            2 if below > room(2) => (1, below),
            2..=6 => (2, room(2)),
            _ => (3, room(3)),
        };
        Self { count, columns, size: [side, side * proportion], width }
    }

    /// Returns the height of all panels, from the upper side of the first to the lower side of the last, in pixels.
    pub fn height(&self) -> f64 {
        let rows = self.count.div_ceil(self.columns) as f64;
        rows * (self.size[1] + PANEL_GAPS[1]) - PANEL_GAPS[1]
    }

    fn area(&self, index: usize, [left, top]: [f64; 2]) -> Rect {
        let [width, height] = self.size;
        let (column, row) = ((index % self.columns) as f64, (index / self.columns) as f64);
        let used = self.columns as f64 * (width + PANEL_GAPS[0]) - PANEL_GAPS[0];
        let x = left + (self.width - used) / 2.0 + column * (width + PANEL_GAPS[0]);
        Rect { x, y: top + row * (height + PANEL_GAPS[1]), width, height }
    }

    /// Draws the panels. Only the leftmost panels, and the lowest of each column, have values at their axes. All panels share the
    /// titles of the axes.
    pub fn items(&self, view: &View, panels: &[&PanelView], left_out: usize, corner: [f64; 2]) -> Vec<Item> {
        let arm = &view.arm;
        let mut items = Vec::new();
        let charts: Vec<Chart> = (0..panels.len()).map(|index| Chart::new(arm, self.area(index, corner))).collect();
        for (index, (panel, chart)) in panels.iter().zip(&charts).enumerate() {
            items.extend(cspace::items(view, panel, chart));
            items.extend(title(panel, chart.frame.rect));
            let values = [index + self.columns >= panels.len(), index % self.columns == 0];
            items.extend(chart.frame.tick_marks(chart.units, values));
        }
        let (Some(first), Some(last)) = (charts.first(), charts.last()) else { return items };
        let columns = &charts[..self.columns.min(charts.len())];
        let right = columns.last().map_or(first.frame.rect.right(), |chart| chart.frame.rect.right());
        let Rect { x, y, .. } = first.frame.rect;
        let around = Rect { x, y, width: right - x, height: last.frame.rect.bottom() - y };
        items.extend(first.frame.titles(around, first.units, chart::titles(arm)));
        if left_out > 0 {
            let text = format!("{left_out} further configuration spaces are not shown");
            let at = [around.x + around.width / 2.0, around.bottom() + 60.0];
            items.push(label(at, text, 13.0, Anchor::Middle, GRAY));
        }
        items
    }
}

fn title(panel: &PanelView, frame: Rect) -> [Item; 2] {
    const TITLE_SIZE: f64 = 15.0;
    const SUBTITLE_SIZE: f64 = 13.0;
    let middle = frame.x + frame.width / 2.0;
    let text = |text: &str, size: f64| shortened(text, size * 1.05, frame.width);
    [
        bold([middle, frame.y - 26.0], text(&panel.title, TITLE_SIZE), TITLE_SIZE, Anchor::Middle, INK),
        label([middle, frame.y - 9.0], text(&panel.subtitle, SUBTITLE_SIZE), SUBTITLE_SIZE, Anchor::Middle, GRAY),
    ]
}
