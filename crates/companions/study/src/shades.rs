//! Colours of the costs on a map.

use super::answer::Shown;
use super::measure::Objective;
use super::summary::format_value;
use cplan_compare::page::{chart, number, text};
use cplan_theme::Rgb;

/// Left end and width of the colour scale, in pixels, as for the map above it.
const SCALE_EXTENT: [f64; 2] = [78.0, 368.0];
/// Number of colours of the scale.
const SCALE_SHADES: usize = 64;

/// Number of parts of the scale. Each has a tick at both ends.
const SCALE_PARTS: usize = 4;

/// Costs of the cells of a map. Colours follow the ranks of the costs: in a typical study, a few layouts are far worse
/// than the others, so that colours by value would be the same for most cells.
pub struct Shades(Vec<f64>);

impl Shades {
    pub fn new(mut costs: Vec<f64>) -> Self {
        costs.sort_by(f64::total_cmp);
        Self(costs)
    }

    /// Returns the number of steps from the least to the greatest cost.
    fn last(&self) -> usize {
        self.0.len().saturating_sub(1)
    }

    fn differ(&self) -> bool {
        self.0.first() < self.0.last()
    }

    /// Returns the colour of a cost. Equal costs have the colour of their middle rank.
    pub fn color(&self, cost: f64) -> Rgb {
        let [below, up_to] = [self.0.partition_point(|c| *c < cost), self.0.partition_point(|c| *c <= cost)];
        let rank = (below + up_to).saturating_sub(1) as f64 / 2.0;
        cplan_theme::scale(if self.differ() { 1.0 - rank / self.last() as f64 } else { 1.0 })
    }
}

/// Draws the colour scale from the best to the worst cost, with the quartiles as ticks. Returns an empty text if all
/// costs are equal, or some are infinite.
pub fn scale(objective: Objective, shades: &Shades) -> String {
    if !shades.differ() || shades.0.iter().any(|cost| !cost.is_finite()) {
        return String::new();
    }
    let [left, width] = SCALE_EXTENT;
    let shade_width = width / SCALE_SHADES as f64;
    let value = |part: usize| objective.cost(shades.0[(part * shades.last() + SCALE_PARTS / 2) / SCALE_PARTS]);
    let [first, last] = [value(0), value(SCALE_PARTS)];
    let shown = Shown::of(objective.measure, [first.min(last), first.max(last)]);
    let mut svg = chart([460.0, 52.0], "Scale of colours");
    for k in 0..SCALE_SHADES {
        // Rectangles overlap slightly, so that no seams are visible.
        let [x, width] = [left + shade_width * k as f64, shade_width + 0.3].map(number);
        let color = cplan_theme::scale(1.0 - (k as f64 + 0.5) / SCALE_SHADES as f64);
        svg += &format!("<rect x=\"{x}\" y=\"2\" width=\"{width}\" height=\"12\" fill=\"{color}\"/>");
    }
    // The best value is on the left, both for least and for greatest.
    for part in 0..=SCALE_PARTS {
        let at = left + width * part as f64 / SCALE_PARTS as f64;
        svg += &text("tick", [at, 29.0], &format_value(shown.value(value(part))));
    }
    let title = format!("{}; a quarter of the cells between two numbers", shown.title);
    svg + &text("tick", [left + width / 2.0, 46.0], &title) + "</svg>\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter of the cells has the colours of a quarter of the scale, even if one cost is far above the others.
    #[test]
    fn colours_follow_ranks() {
        let shades = Shades::new(vec![1.0, 1.1, 1.2, 1.3, 100.0]);
        let expected = [1.0, 0.75, 0.5, 0.25, 0.0].map(cplan_theme::scale);
        assert_eq!([1.0, 1.1, 1.2, 1.3, 100.0].map(|cost| shades.color(cost)), expected);
    }

    #[test]
    fn equal_costs_share_a_colour() {
        let shades = Shades::new(vec![2.0, 1.0, 2.0, 3.0, 2.0]);
        assert_eq!([1.0, 2.0, 3.0].map(|cost| shades.color(cost)), [1.0, 0.5, 0.0].map(cplan_theme::scale));
        assert_eq!(Shades::new(vec![2.0, 2.0]).color(2.0), cplan_theme::scale(1.0));
    }
}
