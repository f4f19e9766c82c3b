//! All paths of a planner on one configuration space.

use super::markup::{chart, text, upright_text};
use cplan_text::{counted, markup};
use cplan_theme::PlannerPen;

/// A configuration space, and the paths that each planner found in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Overlay {
    /// Title of the world.
    pub title: String,
    /// Names of the joints, with their units.
    pub joints: [String; 2],
    /// Lower and upper value of each joint.
    pub window: [(f64, f64); 2],
    /// For each axis, true if it is a circle, on which everything repeats after a turn.
    pub circles: [bool; 2],
    /// Contours of the blocked region, in unwrapped values.
    pub blocked: Vec<Vec<[f64; 2]>>,
    /// Paths of each planner, in unwrapped values.
    pub planners: Vec<(String, Vec<Vec<[f64; 2]>>)>,
    /// Colour of each planner.
    pub pens: Vec<PlannerPen>,
    /// A note that states which paths are shown. `None` if all are shown.
    pub note: Option<String>,
}

/// Width and height of a panel's plot, in pixels.
const PANEL_SIZE: f64 = 220.0;
/// Room left of the plot and below it, for the names of the joints, in pixels.
const NAME_MARGIN: f64 = 18.0;

/// Draws one panel per planner. `id` distinguishes this overlay's blocked region from others in the page.
pub fn panels(overlay: &Overlay, id: usize) -> String {
    let mut html = String::from("<div class=\"panels\">\n");
    for (i, (name, paths)) in overlay.planners.iter().enumerate() {
        let (label, count) = (markup(name), counted(paths.len(), "path"));
        html += &format!("<figure><figcaption>{label} <small>{count}</small></figcaption>\n");
        html += &chart([PANEL_SIZE + NAME_MARGIN; 2], &format!("Paths of {name}"));
        html += &format!("<svg x=\"{NAME_MARGIN}\" y=\"0\" width=\"{PANEL_SIZE}\" height=\"{PANEL_SIZE}\">\n");
        html += &format!("<rect class=\"free\" width=\"{PANEL_SIZE}\" height=\"{PANEL_SIZE}\"/>\n");
        if i == 0 {
            let data = lines(overlay, &overlay.blocked, true);
            html += &format!("<path id=\"blocked{id}\" class=\"blocked\" d=\"{data}\"/>\n");
        } else {
            html += &format!("<use class=\"blocked\" href=\"#blocked{id}\"/>\n");
        }
        let color = overlay.pens.get(i).map_or_else(|| "ink".to_owned(), |pen| pen.name());
        let data = lines(overlay, paths, false);
        html += &format!("<path class=\"way\" style=\"color: var(--{color})\" d=\"{data}\"/>\n</svg>\n");
        html += text("tick", [NAME_MARGIN + PANEL_SIZE / 2.0, PANEL_SIZE + 14.0], &overlay.joints[0]).trim_end();
        html += &upright_text(PANEL_SIZE / 2.0, &overlay.joints[1]);
        html += "</svg></figure>\n";
    }
    html + "</div>\n"
}

/// Returns the data of one SVG path for all lines. On circles, it has all copies that reach into the window.
fn lines(overlay: &Overlay, lines: &[Vec<[f64; 2]>], closed: bool) -> String {
    let mut data = String::new();
    for line in lines {
        let shifts = [0, 1].map(|k| shifts(overlay, line, k));
        for first in &shifts[0] {
            for second in &shifts[1] {
                trace(overlay, line, [*first, *second], closed, &mut data);
            }
        }
    }
    data
}

/// Returns the shifts of a line along an axis with which its copies reach into the window; only 0 on an interval.
fn shifts(overlay: &Overlay, line: &[[f64; 2]], axis: usize) -> Vec<f64> {
    if !overlay.circles[axis] {
        return vec![0.0];
    }
    let (lower, upper) = overlay.window[axis];
    let turn = upper - lower;
    let least = line.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
    let greatest = line.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max);
    let from = ((lower - greatest) / turn).ceil() as i64;
    let to = ((upper - least) / turn).floor() as i64;
    (from..=to).map(|k| k as f64 * turn).collect()
}

fn trace(overlay: &Overlay, line: &[[f64; 2]], shift: [f64; 2], closed: bool, data: &mut String) {
    let pixel = |p: &[f64; 2], axis: usize| {
        let (lower, upper) = overlay.window[axis];
        let share = (p[axis] + shift[axis] - lower) / (upper - lower);
        // A tenth of a pixel is precise enough, and halves the size.
        format!("{:.1}", PANEL_SIZE * if axis == 0 { share } else { 1.0 - share })
    };
    let mut last = None;
    for p in line {
        let place = (pixel(p, 0), pixel(p, 1));
        if last.as_ref() == Some(&place) {
            continue;
        }
        data.push_str(if last.is_none() { "M" } else { "L" });
        data.push_str(&format!("{} {}", place.0, place.1));
        last = Some(place);
    }
    if closed {
        data.push('Z');
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn overlay(circles: [bool; 2]) -> Overlay {
        Overlay {
            title: "t".to_owned(),
            joints: ["a".to_owned(), "b".to_owned()],
            window: [(-1.0, 1.0), (0.0, 4.0)],
            circles,
            blocked: Vec::new(),
            planners: Vec::new(),
            pens: Vec::new(),
            note: None,
        }
    }

    #[test]
    fn lines_across_a_seam_come_in_again() {
        let line = vec![[0.5, 1.0], [1.5, 1.0]];
        assert_eq!(lines(&overlay([false; 2]), std::slice::from_ref(&line), false), "M165.0 165.0L275.0 165.0");
        let twice = lines(&overlay([true, false]), &[line], false);
        assert_eq!(twice, "M-55.0 165.0L55.0 165.0M165.0 165.0L275.0 165.0");
        let around = lines(&overlay([true, true]), &[vec![[-3.0, 0.5], [3.0, 0.5]]], false);
        // From -3 to 3, over a turn from -1 to 1: three copies cross it, and two touch an end.
        assert_eq!(around.matches('M').count(), 5, "{around}");
    }

    #[test]
    fn points_in_one_pixel_are_merged() {
        let dense: Vec<[f64; 2]> = (0..1000).map(|i| [f64::from(i) * 1e-7, 1.0]).collect();
        assert_eq!(lines(&overlay([false; 2]), &[dense], true), "M110.0 165.0Z");
    }
}
