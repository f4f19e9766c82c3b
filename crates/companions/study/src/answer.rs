//! The answer of a study, at the top of its page: the best layout in words, how much better it is than others, its
//! picture, and the command that writes it.

use super::Study;
use super::measure::{Measure, Objective};
use super::parameter::Parameter;
use super::pictures::inline;
use super::row::{Ending, Row};
use super::summary::{Summary, format_value};
use cplan_compare::Picture;
use cplan_text::{counted, for_a_shell, length, length_down, markup, percent};

/// Formats a value with its unit for readers: millimetres below a metre, degrees instead of radians, at most five
/// significant digits.
pub fn with_unit(value: f64, unit: Option<&str>) -> String {
    let minus = |text: String| text.replace('-', "\u{2212}");
    let without_zeros = |text: &str| match text.contains('.') && !text.contains('e') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text.to_owned(),
    };
    let short = || without_zeros(&format_value(value));
    minus(match unit {
        Some("m") => {
            let text = length(value);
            text.split_once(' ').map_or(text.clone(), |(number, unit)| format!("{} {unit}", without_zeros(number)))
        }
        Some("s") => format!("{value:.2} s"),
        Some("rad") => format!("{:.1}\u{b0}", value.to_degrees()),
        Some(unit) => format!("{} {unit}", short()),
        None => short(),
    })
}

/// A quantity on an axis: its title with the unit, and its values in that unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    /// Name and unit.
    pub title: String,
    origin: f64,
    factor: f64,
}

impl Shown {
    /// Chooses the unit for values in a range: millimetres if all are below a metre, and degrees instead of radians.
    pub fn new(name: &str, unit: Option<&str>, range: [f64; 2]) -> Self {
        let greatest = range[0].abs().max(range[1].abs());
        let (unit, factor) = match unit {
            Some("m") if greatest < 1.0 => (Some("mm"), 1e3),
            Some("rad") => (Some("\u{b0}"), 180.0 / std::f64::consts::PI),
            other => (other, 1.0),
        };
        let title = unit.map_or_else(|| name.to_owned(), |unit| format!("{name} ({unit})"));
        Self { title, origin: 0.0, factor }
    }

    /// Chooses the unit of a measure for values in a range.
    pub fn of(measure: Measure, range: [f64; 2]) -> Self {
        match measure {
            Measure::OverBound => Self { title: format!("{} (%)", label(measure)), origin: 1.0, factor: 100.0 },
            _ => Self::new(label(measure), measure.unit(), range),
        }
    }

    /// Returns a value in the unit of the title.
    pub fn value(&self, value: f64) -> f64 {
        (value - self.origin) * self.factor
    }
}

/// Returns the name of a measure for readers.
pub fn label(measure: Measure) -> &'static str {
    match measure {
        Measure::OverBound => "over the bound",
        Measure::LowerBound => "lower bound",
        _ => measure.name(),
    }
}

/// Formats a value of a measure with its unit for readers. Excess lengths are rounded up, and proven clearances down.
pub fn measured(measure: Measure, value: f64) -> String {
    match measure {
        Measure::OverBound => percent(value - 1.0),
        Measure::Clearance if value > 0.0 && value.is_finite() => length_down(value),
        _ => with_unit(value, measure.unit()),
    }
}

/// Returns the section with the answer. `picture` shows the best layout.
pub fn section(study: &Study, summary: &Summary, rows: &[Row], picture: Option<&Picture>) -> String {
    let mut text = format!("<h2 class=\"headline\">{}</h2>\n", markup(&headline(study, summary)));
    if let (Some(best), Some(objective)) = (summary.best(), study.objective) {
        text += &format!("<p class=\"figure\">{}</p>\n", advantage(study, objective, best, rows));
    }
    text += &counts(summary);
    for (parameter, value, at) in summary.range_ends() {
        let (name, value) = (&parameter.name, with_unit(value, parameter.unit.as_deref()));
        let edge = format!("The best {name}, {value}, is {at} its range; a wider range may hold a better layout.");
        text += &format!("<p class=\"sub\">{}</p>\n", markup(&edge));
    }
    if let Some(best) = summary.best() {
        let command = markup(&command(study, best.layout));
        text +=
            &format!("<p>This command writes the layout:</p>\n<pre class=\"command\" tabindex=\"0\">{command}</pre>\n");
    }
    let shown = picture.map_or_else(String::new, |Picture { title, svg }| {
        let drawing = inline(svg, "answer", &format!("{}: workspace", markup(title)));
        format!("<figure class=\"picture\" tabindex=\"0\">{drawing}</figure>\n")
    });
    format!("<section class=\"answer card\" aria-label=\"Answer\">\n{text}{shown}</section>\n")
}

/// Returns the title of the page: how many layouts have a motion, and the best value of the objective with its layout.
pub fn title(study: &Study, summary: &Summary, rows: &[Row]) -> String {
    let [found, ..] = summary.tally();
    let all = counted(rows.len(), "layout");
    let fits = rows.iter().filter(|row| row.fits).count();
    let count = match fits {
        _ if found == 0 => format!("None of {all} has a motion"),
        _ if fits < found => format!("{found} of {all} have a motion, and {fits} meet the conditions"),
        _ => format!("{found} of {all} have a motion"),
    };
    let Some((best, objective)) = summary.best().zip(study.objective) else { return count };
    let value = measured(objective.measure, objective.cost(study.cost(best)));
    let values = best.values.iter().zip(&study.parameters);
    let place: Vec<String> = values.map(|(x, p)| format!("{} {}", p.name, with_unit(*x, p.unit.as_deref()))).collect();
    format!("{count}; the best, {}, has {} {value}", place.join(", "), label(objective.measure))
}

/// Returns the answer in one sentence.
fn headline(study: &Study, summary: &Summary) -> String {
    let Some(best) = summary.best() else {
        return match summary.tally() {
            [0, ..] => "No layout has a motion".into(),
            _ if study.objective.is_none() => "The layouts are not ranked, because the study has no objective".into(),
            _ => "No layout meets the conditions".into(),
        };
    };
    let values = best.values.iter().zip(&study.parameters);
    let value = |(value, parameter): (&f64, &Parameter)| with_unit(*value, parameter.unit.as_deref());
    if let Some((subject, axes)) = common_subject(&study.parameters) {
        let places: Vec<String> = values.zip(axes).map(|(pair, axis)| format!("{axis} = {}", value(pair))).collect();
        return format!("Put the {subject} at {}", places.join(", "));
    }
    let choices: Vec<String> = values.map(|pair| format!("{} = {}", pair.1.name, value(pair))).collect();
    format!("Choose {}", choices.join(", "))
}

/// Returns the common subject of parameters that are coordinates, and the names of the coordinates. For `base x` and
/// `base y`, these are `base` and `x`, `y`. `None` for other parameters.
fn common_subject(parameters: &[Parameter]) -> Option<(&str, Vec<&str>)> {
    let split: Option<Vec<(&str, &str)>> = parameters.iter().map(|p| p.name.rsplit_once(' ')).collect();
    let split = split?;
    let (subject, _) = *split.first()?;
    let is_place = split.iter().all(|(of, axis)| *of == subject && ["x", "y"].contains(axis));
    is_place.then(|| (subject, split.into_iter().map(|(_, axis)| axis).collect()))
}

/// Describes the best value, and its advantage over the median of the layouts that fit.
fn advantage(study: &Study, objective: Objective, best: &Row, rows: &[Row]) -> String {
    let mut costs: Vec<f64> = rows.iter().map(|row| study.cost(row)).filter(|cost| cost.is_finite()).collect();
    costs.sort_by(f64::total_cmp);
    let value = objective.cost(study.cost(best));
    let name = markup(label(objective.measure));
    let shown = format!("<strong>{} {name}</strong>", markup(&measured(objective.measure, value)));
    let median = objective.cost(costs[costs.len() / 2]);
    let better = (median - value).abs() / median.abs();
    if costs.len() < 2 || !better.is_finite() {
        return shown;
    }
    let percent = if better < 0.01 { format!("{:.1} %", 100.0 * better) } else { format!("{:.0} %", 100.0 * better) };
    let median = markup(&measured(objective.measure, median));
    format!("{shown}: {percent} better than the median of the {} layouts that fit ({median})", costs.len())
}

/// Describes the numbers of layouts by their ending.
fn counts(summary: &Summary) -> String {
    let sign = |ending: Ending| match ending {
        Ending::Found => ("o-found", "\u{2713}"),
        Ending::Infeasible => ("o-infeasible", "\u{2715}"),
        Ending::Unknown => ("o-unknown", "?"),
        Ending::Refused => ("o-unknown", "\u{2013}"),
    };
    let count = |(ending, count): (Ending, usize)| {
        let (class, sign) = sign(ending);
        format!(
            "<li class=\"{class}\"><span class=\"sign\" aria-hidden=\"true\">{sign}</span> <strong>{count}</strong> {}</li>\n",
            ending.name()
        )
    };
    let all: String = Ending::ALL.into_iter().zip(summary.tally()).map(count).collect();
    format!("<ul class=\"counts\" aria-label=\"Outcomes\">\n{all}</ul>\n")
}

/// Returns the command that writes a layout.
pub fn command(study: &Study, layout: usize) -> String {
    let file = for_a_shell(&study.source.name());
    match layout < study.count() {
        true => format!("cplan study {file} --layout {layout} --output layout_{layout}.toml"),
        // Layouts of the search have no number that the program can look up.
        false => format!("cplan study {file} --output best.toml"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_have_units_that_readers_know() {
        assert_eq!(with_unit(-0.2, Some("m")), "\u{2212}200 mm");
        assert_eq!(with_unit(1.8518, Some("s")), "1.85 s");
        assert_eq!(with_unit(std::f64::consts::PI, Some("rad")), "180.0\u{b0}");
        assert_eq!(with_unit(1.5, None), "1.5");
        assert_eq!(with_unit(12.0, Some("kg")), "12 kg");
    }

    #[test]
    fn axes_have_the_units_of_the_text() {
        let shown = |unit, range| {
            let shown = Shown::new("x", unit, range);
            (shown.title.clone(), shown.value(range[1]))
        };
        assert_eq!(shown(Some("m"), [-0.5, 0.25]), ("x (mm)".to_owned(), 250.0));
        assert_eq!(shown(Some("m"), [-0.5, 2.0]), ("x (m)".to_owned(), 2.0));
        assert_eq!(shown(Some("kg"), [0.0, 2.0]), ("x (kg)".to_owned(), 2.0));
        assert_eq!(shown(None, [0.0, 2.0]), ("x".to_owned(), 2.0));
        let over = Shown::of(Measure::OverBound, [1.0, 1.25]);
        assert_eq!((over.title.as_str(), over.value(1.25)), ("over the bound (%)", 25.0));
        assert_eq!(measured(Measure::OverBound, 1.25), "25.00 %");
        assert_eq!(measured(Measure::Clearance, 0.000_736_9), "0.736 mm");
    }

    #[test]
    fn shell_words_are_quoted() {}
}
