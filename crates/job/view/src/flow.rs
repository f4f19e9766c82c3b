//! The lines that pictures draw through a field.

use super::chart::Chart;
use super::figure::{Item, Pen, Step, Style, chain};
use super::key::{Key, Sign};
use super::view::{Chain, LevelView};
use cplan_theme::{ACCENT, PALE};

/// The lines of a field that pictures show.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FieldLines {
    /// Lines of equal potential.
    #[default]
    Equipotentials,
    /// Lines of steepest ascent, each with an arrow.
    Flow,
    /// Both kinds.
    Both,
}

impl FieldLines {
    fn has_levels(self) -> bool {
        self != Self::Flow
    }

    fn has_flow(self) -> bool {
        self != Self::Equipotentials
    }

    /// Returns the legend of the lines.
    pub fn keys(self) -> Vec<Key> {
        let line = |color| Sign::Line(Pen { color, width: 1.0, dash: &[] });
        let levels = self.has_levels().then(|| (line(cplan_theme::scale(0.5)), "equipotentials".to_owned()));
        let flow = self.has_flow().then(|| (line(ACCENT), "flow lines".to_owned()));
        levels.into_iter().chain(flow).collect()
    }

    /// Draws the lines of a field.
    pub fn items(self, levels: &[LevelView], flow: &[Chain], chart: &Chart) -> Vec<Item> {
        let line = |Chain(line): &Chain| chain(line.iter().map(|q| chart.frame.at(q[0], q[1])), false);
        let mut items = Vec::new();
        if self.has_levels() {
            let style = |part| Style::line(cplan_theme::scale(part).mixed(PALE.darker(0.4), 0.15), 1.1);
            let set = |set: &LevelView| Item::Outline(set.lines.iter().flat_map(line).collect(), style(set.part));
            items.extend(levels.iter().map(set));
        }
        if self.has_flow() {
            items.push(Item::Outline(flow.iter().flat_map(line).collect(), Style::line(ACCENT, 0.8).faded(0.8)));
            items.push(Item::Outline(flow.iter().flat_map(|line| arrow(line, chart)).collect(), Style::fill(ACCENT)));
        }
        items
    }
}

fn arrow(Chain(line): &Chain, chart: &Chart) -> Vec<Step> {
    let Some(at) = line.len().checked_sub(2).map(|last| last.min(3)) else { return Vec::new() };
    let [a, b]: [[f64; 2]; 2] = [line[at], line[at + 1]].map(|q| chart.frame.at(q[0], q[1]));
    let angle = (b[1] - a[1]).atan2(b[0] - a[0]);
    let corner = |(r, turn): (f64, f64)| [b[0] + r * (angle + turn).cos(), b[1] + r * (angle + turn).sin()];
    let [tip, left, right] = [(6.0, 0.0), (4.0, 2.5), (4.0, -2.5)].map(corner);
    vec![Step::Move(tip), Step::Line(left), Step::Line(right), Step::Close]
}
