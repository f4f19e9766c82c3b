//! A study as one page of HTML: the answer, heat maps, charts of two measures with their Pareto fronts, the best and
//! the worst layouts, and the reasons why others fail. A script draws the layout that the reader points at, and marks
//! it in all maps, charts and tables.

use super::Study;
use super::answer::{self, Shown, label, measured, with_unit};
use super::drawings::Drawings;
use super::measure::Measure;
use super::parameter::{Parameter, Values};
use super::pictures::inline;
use super::row::{Ending, Row};
use super::shades::{Shades, scale};
use super::summary::{Summary, format_value};
use cplan_compare::page::{Axis, Frame, collapsible_section, figure, foot, frame, head, number, section, table};
use cplan_compare::{Align, Column, Picture, Table};
use cplan_text::{counted, markup};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};

/// Largest number of parameters for which each pair has a map.
const MAX_MAPPED_PARAMETERS: usize = 4;
/// Number of cells of a map along an axis whose parameter is drawn, or has more than [`MAX_LISTED_CELLS`] values.
const CELLS_PER_AXIS: usize = 24;
/// Largest number of listed values that each have their own cell.
const MAX_LISTED_CELLS: usize = 48;
/// Largest number of points in a chart.
const MAX_CHART_POINTS: usize = 4000;

impl Study {
    /// Returns the page for these rows, with pictures of some layouts. The same rows give the same bytes.
    pub fn html(&self, rows: &[Row], pictures: &[Picture]) -> String {
        let summary = Summary::new(self, rows);
        let names: Vec<&str> = self.parameters.iter().map(|parameter| parameter.name.as_str()).collect();
        let subtitle = format!("{} \u{b7} {} over {}", self.name, counted(rows.len(), "layout"), names.join(", "));
        let mut linked = BTreeSet::new();
        let mut html = head(&answer::title(self, &summary, rows), &subtitle, STYLE, true);
        let is_best = |picture: &&Picture| picture.title.starts_with("best: ") && summary.best().is_some();
        let best = pictures.first().filter(is_best);
        html += &answer::section(self, &summary, rows, best);
        html += &self.maps(&summary, rows, &mut linked);
        html += &self.fronts(&summary, rows, &mut linked);
        if summary.best().is_some() {
            html += &section("Best layouts", &table(&summary.best_table()));
        }
        html += &section("Outcomes", &self.outcomes(&summary));
        html += &pictures_section(&pictures[usize::from(best.is_some())..]);
        linked.extend(summary.best_rows().map(|row| row.layout));
        html += &self.script(&summary, rows, &linked);
        html + &foot(METHOD_NOTE)
    }

    /// Returns the script that links maps, charts and tables, with its data: the layouts that the page shows in several places.
    fn script(&self, summary: &Summary, rows: &[Row], linked: &BTreeSet<usize>) -> String {
        let shown = || rows.iter().filter(|row| linked.contains(&row.layout));
        let fact = |name: &str, text: String| json!([name, text]);
        let described = |row: &Row| {
            let values = self.parameters.iter().zip(&row.values);
            let mut facts: Vec<Value> =
                values.map(|(p, value)| fact(&p.name, with_unit(*value, p.unit.as_deref()))).collect();
            let results = self.measures.iter().zip(&row.measured);
            facts.extend(results.filter_map(|(m, value)| Some(fact(label(*m), measured(*m, (*value)?)))));
            facts.extend(row.reason.iter().map(|reason| fact("why", reason.clone())));
            json!({
                "ending": row.ending.name(),
                "fits": row.fits,
                "facts": facts,
                "command": answer::command(self, row.layout),
            })
        };
        let layouts: BTreeMap<usize, Value> = shown().map(|row| (row.layout, described(row))).collect();
        let data = json!({
            "best": summary.best().map(|best| best.layout),
            "layouts": layouts,
            "drawings": Drawings::new(self, shown()).to_json(),
        });
        // Only `<` could begin the tag that ends the script.
        let data = data.to_string().replace('<', "\\u003c");
        format!("<script id=\"study\" type=\"application/json\">{data}</script>\n<script>\n{SCRIPT}</script>\n")
    }

    fn outcomes(&self, summary: &Summary) -> String {
        let lines: Vec<&str> = OUTCOME_HEADINGS.to_vec();
        let columns = lines
            .into_iter()
            .zip([Align::Left, Align::Right, Align::Left])
            .map(|(name, align)| Column::new(name, align));
        let tally = Ending::ALL.into_iter().zip(summary.tally()).filter(|(_, count)| *count > 0);
        let mut rows: Vec<Vec<Option<String>>> =
            tally.map(|(ending, count)| vec![Some(ending.name().into()), Some(count.to_string()), None]).collect();
        for (ending, reason, count) in summary.reasons().into_iter().take(MAX_REASONS) {
            rows.push(vec![Some(format!("\u{2026} {}", ending.name())), Some(count.to_string()), Some(reason)]);
        }
        // The reasons are sentences, so the table may wrap them.
        table(&Table { columns: columns.collect(), rows }).replacen("<table", "<table class=\"words\"", 1)
    }

    /// Draws a map for each pair of parameters. A cell shows whether a motion exists, and the best value of the objective.
    fn maps(&self, summary: &Summary, rows: &[Row], linked: &mut BTreeSet<usize>) -> String {
        let mapped = self.parameters.len().min(MAX_MAPPED_PARAMETERS);
        let pairs = (0..mapped).flat_map(|a| (a + 1..mapped).map(move |b| [a, b]));
        let maps: String = pairs.map(|pair| self.map(summary, rows, pair, linked)).collect();
        if maps.is_empty() {
            return maps;
        }
        let what = self.objective.map_or_else(String::new, |objective| {
            format!("The colour shows the {objective} of the layouts in a cell, of those that meet the conditions; ")
        });
        let key = |(color, text): (&str, &str)| {
            format!(
                "<li><svg viewBox=\"0 0 12 12\"><rect width=\"12\" height=\"12\" fill=\"{color}\"/></svg> {text}</li>\n"
            )
        };
        let keys: String = MAP_LEGEND.into_iter().map(key).collect();
        let note = format!(
            "<p class=\"sub\">{what}the cross is the best of all.</p>\n<ul class=\"key signs\">\n{keys}</ul>\n"
        );
        let pointed = "<div class=\"pointed card\" hidden></div>\n";
        section("Map", &format!("{note}<div class=\"linked\">\n<div class=\"maps\">\n{maps}</div>\n{pointed}</div>\n"))
    }

    fn map(&self, summary: &Summary, rows: &[Row], [a, b]: [usize; 2], linked: &mut BTreeSet<usize>) -> String {
        let bins = [a, b].map(|k| Bins::of(&self.parameters[k]));
        let mut cells = vec![Cell::default(); bins[0].count * bins[1].count];
        for row in rows {
            let [i, j] = [(a, &bins[0]), (b, &bins[1])].map(|(k, bins)| bins.place(row.values[k]));
            cells[j * bins[0].count + i].add(row, self.cost(row));
        }
        let shades = Shades::new(cells.iter().filter_map(|cell| cell.cost).collect());
        let shown = [(a, &bins[0]), (b, &bins[1])].map(|(k, bins)| {
            let Parameter { name, unit, values } = &self.parameters[k];
            (Shown::new(name, unit.as_deref(), values.range()), bins)
        });
        let axes = shown.each_ref().map(|(shown, bins)| Axis::between(shown.value(bins.from), shown.value(bins.to)));
        let titles = shown.each_ref().map(|(shown, _)| shown.title.clone());
        let Frame { mut svg, place } = frame(axes, titles.each_ref().map(String::as_str), "Map");
        let corner = |i: f64, j: f64| place([i / bins[0].count as f64, j / bins[1].count as f64]);
        for (number_of, cell) in cells.iter().enumerate() {
            let (i, j) = ((number_of % bins[0].count) as f64, (number_of / bins[0].count) as f64);
            let ([left, bottom], [right, top]) = (corner(i, j), corner(i + 1.0, j + 1.0));
            let Some((color, text)) = cell.color_and_label(&shades) else { continue };
            let Some((.., layout)) = cell.shown else { continue };
            linked.insert(layout);
            let [x, y, width, height] = [left, top, right - left, bottom - top].map(number);
            let title = markup(&text);
            svg += &format!(
                "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" fill=\"{color}\" data-layout=\"{layout}\" data-cell=\"{i},{j}\"><title>{title}</title></rect>\n"
            );
        }
        if let Some(best) = summary.best() {
            let share = |k: usize, of: usize| axes[k].place(shown[k].0.value(best.values[of]));
            let [x, y] = place([share(0, a), share(1, b)]).map(number);
            let cross = format!("M{x} {y}m-6 -6l12 12m0 -12l-12 12");
            svg += &format!(
                "<g class=\"best\"><title>best: layout {}</title><path class=\"halo\" d=\"{cross}\"/><path d=\"{cross}\"/></g>\n",
                best.layout
            );
        }
        let title = format!("{} by {}", self.parameters[b].name, self.parameters[a].name);
        let scale = self.objective.map_or_else(String::new, |objective| scale(objective, &shades));
        figure(&title, &(svg + "</svg>\n" + &scale))
    }

    /// Draws a chart of the objective against each other measure, with the layouts on the Pareto front.
    fn fronts(&self, summary: &Summary, rows: &[Row], linked: &mut BTreeSet<usize>) -> String {
        let Some(objective) = self.objective else { return String::new() };
        let others = self.measures.iter().filter(|measure| **measure != objective.measure);
        let of = |row: &Row, measure: Measure| self.column(measure).and_then(|column| row.measured[column]);
        let mut charts = String::new();
        // Dots of the charts so far. A chart with the same dots as an earlier one is omitted.
        let mut drawn: Vec<Vec<[f64; 2]>> = Vec::new();
        for other in others {
            let pair = [objective.measure, *other];
            let point = |row: &Row| Some([of(row, pair[0])?, of(row, pair[1])?]);
            let fitting = rows.iter().filter(|row| row.fits);
            let (layouts, points): (Vec<usize>, Vec<[f64; 2]>) =
                fitting.filter_map(|row| Some((row.layout, point(row)?))).unzip();
            let ranges = [0, 1].map(|k| {
                let values = points.iter().map(|point| point[k]).filter(|value| value.is_finite());
                [values.clone().fold(f64::INFINITY, f64::min), values.fold(f64::NEG_INFINITY, f64::max)]
            });
            let shown = [0, 1].map(|k| Shown::of(pair[k], ranges[k]));
            let axis = |k: usize| Axis::over(points.iter().map(|point| shown[k].value(point[k])), None);
            let (Some(first), Some(second)) = (axis(0), axis(1)) else { continue };
            let axes = [first, second];
            let places = |point: [f64; 2]| [0, 1].map(|k| axes[k].place(shown[k].value(point[k])));
            let dots: Vec<[f64; 2]> = points.iter().map(|point| places(*point)).collect();
            if drawn.iter().any(|earlier| are_alike(earlier, &dots)) {
                continue;
            }
            let titles = shown.each_ref().map(|shown| shown.title.clone());
            let Frame { mut svg, place } = frame(axes, titles.each_ref().map(String::as_str), "Chart");
            let dot = |at: [f64; 2], radius: &str, layout: usize| {
                let [x, y] = place(at).map(number);
                format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" data-layout=\"{layout}\"/>")
            };
            let stride = dots.len().div_ceil(MAX_CHART_POINTS).max(1);
            svg += "<g class=\"p0 dot\">";
            dots.iter().zip(&layouts).step_by(stride).for_each(|(at, layout)| svg += &dot(*at, "1.5", *layout));
            svg += "</g>\n<g class=\"p1 only\">";
            for (row, point) in summary.pareto(pair).into_iter().filter_map(|row| Some((row, point(row)?))) {
                linked.insert(row.layout);
                let texts = [0, 1].map(|k| format!("{} {}", label(pair[k]), measured(pair[k], point[k])));
                let text = format!("layout {}: {}", row.layout, texts.join(", "));
                svg += &format!("<g><title>{}</title>{}</g>", markup(&text), dot(places(point), "4", row.layout));
            }
            charts += &figure(&format!("{} against {}", label(pair[1]), label(pair[0])), &(svg + "</g></svg>\n"));
            drawn.push(dots);
        }
        if charts.is_empty() {
            return charts;
        }
        let note = "<p class=\"sub\">Each dot is a layout that fits. No layout is better than a large dot in both measures.</p>\n";
        section("Trade-offs", &format!("{note}<div class=\"charts\">\n{charts}</div>\n"))
    }
}

/// Colour of a cell in which all layouts are proven infeasible.
const INFEASIBLE_COLOR: &str = "var(--infeasible)";
/// Colour of a cell in which some layouts have a motion, but none satisfies the conditions.
const UNFIT_COLOR: &str = "var(--unknown)";
/// Colour of a cell in which no layout has a motion, for various reasons.
const NO_MOTION_COLOR: &str = "var(--undecided)";

/// Legend of a map: colours other than those of the objective.
const MAP_LEGEND: [(&str, &str); 3] = [
    (UNFIT_COLOR, "a motion that does not meet the conditions"),
    (INFEASIBLE_COLOR, "proven infeasible, in all layouts"),
    (NO_MOTION_COLOR, "nothing to plan, or unknown"),
];

/// Largest distance at which two dots of a chart count as one, as a fraction of the chart.
const DOT_DISTANCE: f64 = 0.01;

fn are_alike(a: &[[f64; 2]], b: &[[f64; 2]]) -> bool {
    let near = |(a, b): (&[f64; 2], &[f64; 2])| (0..2).all(|k| (a[k] - b[k]).abs() <= DOT_DISTANCE);
    a.len() == b.len() && a.iter().zip(b).all(near)
}

const OUTCOME_HEADINGS: [&str; 3] = ["outcome", "layouts", "why"];

/// Largest number of reasons that are listed.
const MAX_REASONS: usize = 12;

/// Styles of this page, after those of all reports.
const STYLE: &str = include_str!("assets/study.css");

/// The script that links maps, charts and tables.
const SCRIPT: &str = include_str!("assets/study.js");

const METHOD_NOTE: &str = "Every layout was planned separately. <em>Found</em>: the whole continuous motion is \
                           certified free of collision. <em>Infeasible</em>: proven. <em>Refused</em>: there is \
                           nothing to plan, because start or goal is not free or out of reach, or a value is not \
                           valid. Reasons are shown without their numbers, so layouts that fail for the same reason \
                           count together.";

/// Returns the section with pictures of layouts. The first picture is unfolded.
fn pictures_section(pictures: &[Picture]) -> String {
    let picture = |(number, Picture { title, svg }): (usize, &Picture)| {
        let title = markup(title);
        let drawing = inline(svg, &format!("picture-{number}"), &format!("{title}: workspace and configuration space"));
        let shown = format!("<figure class=\"picture\" tabindex=\"0\">{drawing}</figure>\n");
        if number == 0 { format!("<h3>{title}</h3>\n{shown}") } else { collapsible_section(&title, &shown) }
    };
    let all: String = pictures.iter().enumerate().map(picture).collect();
    if all.is_empty() { all } else { section("Pictures", &all) }
}

/// Division of a parameter's values into the cells along an axis.
struct Bins {
    from: f64,
    to: f64,
    count: usize,
}

impl Bins {
    fn of(parameter: &Parameter) -> Self {
        let [from, to] = parameter.values.range();
        match &parameter.values {
            // Each value is in the middle of its cell.
            Values::Stepped { count, .. } if *count <= MAX_LISTED_CELLS && to > from => {
                let half = (to - from) / (count - 1) as f64 / 2.0;
                Self { from: from - half, to: to + half, count: *count }
            }
            _ if to > from => Self { from, to, count: CELLS_PER_AXIS },
            _ => Self { from: from - 0.5, to: to + 0.5, count: 1 },
        }
    }

    fn place(&self, value: f64) -> usize {
        let share = (value - self.from) / (self.to - self.from);
        ((share * self.count as f64).max(0.0) as usize).min(self.count - 1)
    }
}

/// The results of the layouts in a cell.
#[derive(Debug, Clone, Copy, Default)]
struct Cell {
    layouts: usize,
    infeasible: usize,
    refused: usize,
    found: usize,
    fitting: usize,
    cost: Option<f64>,
    /// Rank, cost and number of the layout that represents the cell: the best one that fits, or else one with the best ending.
    shown: Option<(usize, f64, usize)>,
}

impl Cell {
    fn add(&mut self, row: &Row, cost: f64) {
        let ending = row.ending;
        let rank = if cost.is_finite() { 0 } else { 1 + ending as usize };
        if self.shown.is_none_or(|(best, least, _)| (rank, cost) < (best, least)) {
            self.shown = Some((rank, cost, row.layout));
        }
        self.layouts += 1;
        self.infeasible += usize::from(ending == Ending::Infeasible);
        self.refused += usize::from(ending == Ending::Refused);
        self.found += usize::from(ending == Ending::Found);
        if cost.is_finite() {
            self.fitting += 1;
            self.cost = Some(self.cost.map_or(cost, |best| best.min(cost)));
        }
    }

    /// Returns the colour and the description of a cell. `None` for a cell without layouts.
    fn color_and_label(&self, shades: &Shades) -> Option<(String, String)> {
        if self.layouts == 0 {
            return None;
        }
        let best = self.cost.map_or_else(String::new, |cost| format!(", best {}", format_value(cost.abs())));
        let Self { layouts, found, fitting, infeasible, refused, .. } = self;
        let layouts = counted(*layouts, "layout");
        let text = format!(
            "{layouts}: {found} with a motion, {fitting} fit, {infeasible} infeasible, {refused} refused{best}"
        );
        let color = match self.cost {
            Some(cost) => shades.color(cost).to_string(),
            None if self.found > 0 => UNFIT_COLOR.to_owned(),
            None if self.infeasible == self.layouts => INFEASIBLE_COLOR.to_owned(),
            None => NO_MOTION_COLOR.to_owned(),
        };
        Some((color, text))
    }
}
