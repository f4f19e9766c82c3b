//! Conclusions of a study in words. Each needs the support of the figures.

use super::Family;
use super::best::Better;
use super::measure::Measure;
use super::sign::sign_test;
use super::spread::Spread;
use super::study::Study;
use cplan_model::Status;
use cplan_planners::planner::PathKind;
use cplan_text::{counted, percent};
use cplan_view::output::names::capitalized;

/// A side is called better if the p-value of the sign test is at most this.
const SIGNIFICANCE_LEVEL: f64 = 0.05;

/// Values count as equal if they differ by at most this fraction of them.
const EQUALITY_TOLERANCE: f64 = 1e-6;

/// Least number of problems for a conclusion. With five, even five wins have a p-value of 1/16, which is not significant.
const MIN_PROBLEMS: usize = 6;

/// The measures by which planners are compared. Each has two phrases (for the better of two sides, and for the best of several),
/// the measure in words, and a flag that is true if a greater value is better.
const COMPARED_MEASURES: [(Measure, [&str; 2], &str); 5] = [
    (Measure::OverOptimum, ["found the shorter paths", "found the shortest paths"], "length over the proven optimum"),
    (Measure::Clearance, ["kept the greater clearance", "kept the greatest clearance"], "clearance in millimetres"),
    (Measure::Duration, ["led to the faster motions", "led to the fastest motions"], "motion in seconds"),
    (Measure::Total, ["answered sooner", "answered soonest"], "time to the verdict in milliseconds"),
    (Measure::Memory, ["needed less memory", "needed the least memory"], "memory in MiB"),
];

/// One planner, or several that are compared as a group.
struct Side {
    name: String,
    planners: Vec<usize>,
}

/// Returns the conclusions, one paragraph each: the number of problems with an outcome, the distance to the proven bound, and for
/// each pair of families the lengths, clearances, times and sizes.
///
/// Each planner represents its family with its usual path. The effect of pulling paths taut is reported separately. If there is
/// only one family, single planners are compared. A side is called better only if the sign test supports this at 5 %. The test
/// counts the problems in which all sides have values.
pub fn words(study: &Study) -> Vec<String> {
    let mut words = vec![outcomes(study)];
    words.extend(optimum(study));
    words.extend(describe_taut_effect(study));
    let sides = sides(study);
    if sides.len() > 1 {
        words.extend(COMPARED_MEASURES.iter().filter_map(|aspect| describe_aspect(study, &sides, *aspect)));
    }
    words
}

fn outcomes(study: &Study) -> String {
    let [found, infeasible, open] = study.outcome_counts();
    let all = counted(study.comparisons.len(), "problem");
    let mut text = format!("{all}: {found} with a certified path, {infeasible} proven infeasible, {open} unknown.");
    let unknown: Vec<String> = study
        .planners()
        .iter()
        .enumerate()
        .filter_map(|(i, name)| Some((name, study.tally(i)[2])).filter(|(_, n)| *n > 0))
        .map(|(name, n)| format!("{n} unknown to {name}"))
        .collect();
    if unknown.is_empty() {
        text += " Every planner answered all of them.";
    } else {
        text += &format!(" Of them, {}.", unknown.join(", "));
    }
    text
}

/// Describes how near the best paths of all planners come to the proven lower bound.
fn optimum(study: &Study) -> Option<String> {
    let excess = |c: &super::Comparison| Some(c.best()? / c.bound? - 1.0);
    let spread = Spread::of(study.comparisons.iter().filter_map(excess))?;
    Some(format!(
        "The shortest path found is at most {} longer than the optimum (median of the proven gaps; the largest is {}), on {}.",
        percent(spread.median),
        percent(spread.max),
        counted(spread.n, "problem")
    ))
}

/// Describes the effect of pulling each planner's own path taut, for problems with both paths.
fn describe_taut_effect(study: &Study) -> Option<String> {
    let sentences = study.planners().into_iter().enumerate().filter_map(|(i, name)| {
        let pairs =
            || study.runs(i).filter_map(|(_, row)| Some((row.of_kind(PathKind::Own)?, row.of_kind(PathKind::Taut)?)));
        let length = Spread::of(pairs().map(|(own, taut)| taut.0 / own.0).filter(|r| r.is_finite()))?;
        let parts = pairs().filter_map(|(own, taut)| Some(taut.1? / own.1?)).filter(|r| r.is_finite());
        let clearance = Spread::of(parts).map_or_else(String::new, |s| format!(", clearance {:.2}", s.median));
        Some(format!("{name} length {:.2}{clearance} ({})", length.median, counted(length.n, "problem")))
    });
    let sentences: Vec<String> = sentences.collect();
    let conclusions = "Taut path relative to the planner's own path (median)";
    (!sentences.is_empty()).then(|| format!("{conclusions}: {}.", sentences.join("; ")))
}

fn sides(study: &Study) -> Vec<Side> {
    let Some(first) = study.comparisons.first() else { return Vec::new() };
    let of = |family| first.rows.iter().enumerate().filter(move |(_, row)| row.family == family).map(|(i, _)| i);
    let mut sides: Vec<Side> = Family::ALL
        .into_iter()
        .map(|family| Side { name: family.name().to_owned(), planners: of(family).collect() })
        .filter(|side| !side.planners.is_empty())
        .collect();
    if sides.len() < 2 {
        let one = |(i, row): (usize, &super::Row)| Side { name: row.planner.clone(), planners: vec![i] };
        sides = first.rows.iter().enumerate().map(one).collect();
    }
    sides
}

/// Compares sides by one measure. `None` if there is no problem in which all sides have values.
fn describe_aspect(
    study: &Study,
    sides: &[Side],
    (measure, better, what): (Measure, [&str; 2], &str),
) -> Option<String> {
    let more = measure.better() == Better::More;
    let best =
        |values: &mut dyn Iterator<Item = f64>| if more { values.reduce(f64::max) } else { values.reduce(f64::min) };
    // The best value of each side, for each problem in which all sides have one. A run without a path or a proof has no value.
    let values: Vec<Vec<f64>> = study
        .comparisons
        .iter()
        .filter_map(|c| {
            let of = |side: &Side| {
                let rows = side.planners.iter().filter_map(|&i| c.rows.get(i));
                let settled = rows.filter(|row| row.outcome != Status::Unknown);
                best(&mut settled.filter_map(|row| measure.of(c, row)))
            };
            sides.iter().map(of).collect::<Option<Vec<f64>>>()
        })
        .collect();
    let medians = (0..sides.len()).map(|i| Spread::of(values.iter().map(|v| v[i])).map(|s| s.median));
    let medians: Vec<String> = sides
        .iter()
        .zip(medians.collect::<Option<Vec<f64>>>()?)
        .map(|(side, median)| format!("{} {}", side.name, measure.format(median)))
        .collect();
    let wins = |a: usize, b: usize| {
        let wins = values.iter().filter(|v| {
            let apart = if more { v[a] - v[b] } else { v[b] - v[a] };
            apart > EQUALITY_TOLERANCE * v[a].abs().max(v[b].abs())
        });
        wins.count()
    };
    let figures = format!(
        "Median {what}: {} (of {} that all sides answered, each side with its best planner).",
        medians.join(", "),
        counted(values.len(), "problem")
    );
    if values.len() < MIN_PROBLEMS {
        return Some(figures);
    }
    let others = |i: usize| (0..sides.len()).filter(move |&k| k != i);
    let beats = |i: usize, k: usize| wins(i, k) > wins(k, i) && sign_test(wins(i, k), wins(k, i)) < SIGNIFICANCE_LEVEL;
    let winner = (0..sides.len()).find(|&i| others(i).all(|k| beats(i, k)));
    let word = better[usize::from(sides.len() > 2)];
    let score = |i: usize, k: usize| {
        let (won, lost) = (wins(i, k), wins(k, i));
        let p = sign_test(won, lost);
        let p = if p < 0.001 { format!("{p:.0e}") } else { format!("{p:.3}") };
        format!("better than {} in {won}, worse in {lost} (p = {p})", sides[k].name)
    };
    let name = |i: usize| capitalized(&sides[i].name);
    Some(match winner {
        Some(i) => {
            let scores: Vec<String> = others(i).map(|k| score(i, k)).collect();
            format!("{} {word}. {figures} {}: {}.", name(i), name(i), scores.join("; "))
        }
        None => {
            let pairs = (0..sides.len()).flat_map(|i| (i + 1..sides.len()).map(move |k| (i, k)));
            let scores: Vec<String> = pairs.map(|(i, k)| format!("{}: {}.", name(i), score(i, k))).collect();
            format!("These problems do not show which side {word}. {figures} {}", scores.join(" "))
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Comparison, OtherPath, Row};

    /// Returns a problem with a roadmap planner and a field planner, with these lengths over a bound of 1 and these
    /// times.
    fn problem(lengths: [Option<f64>; 2], totals: [f64; 2]) -> Comparison {
        let row = |i: usize, name: &str, family| Row {
            length: lengths[i],
            total: Some(totals[i]),
            ..Row::new(name, family, if lengths[i].is_some() { Status::Found } else { Status::Unknown })
        };
        Comparison {
            problem: "p".to_owned(),
            length_unit: "rad".to_owned(),
            query: None,
            bound: Some(1.0),
            rows: vec![row(0, "visibility", Family::Roadmap), row(1, "wavefront", Family::Field)],
        }
    }

    fn study(comparisons: Vec<Comparison>) -> Study {
        Study { title: String::new(), sampling: None, comparisons, left_out: Vec::new(), refused: Vec::new() }
    }

    #[test]
    fn clear_wins_are_claimed_with_their_figures() {
        let mut all: Vec<Comparison> = (0..9).map(|_| problem([Some(1.01), Some(1.2)], [0.002, 0.001])).collect();
        all.push(problem([Some(1.0), None], [0.002, 0.5]));
        let words = words(&study(all));
        assert_eq!(
            words[0],
            "10 problems: 10 with a certified path, 0 proven infeasible, 0 unknown. Of them, 1 unknown to wavefront."
        );
        assert_eq!(
            words[1],
            "The shortest path found is at most 1.00 % longer than the optimum (median of the proven gaps; the largest is \
             1.00 %), on 10 problems."
        );
        assert_eq!(
            words[2],
            "Roadmaps found the shorter paths. Median length over the proven optimum: roadmaps 1.0100, fields 1.2000 \
             (of 9 problems that all sides answered, each side with its best planner). Roadmaps: better than fields in \
             9, worse in 0 (p = 0.004)."
        );
        assert!(words[3].starts_with("Fields answered sooner."), "{}", words[3]);
        assert_eq!(words.len(), 4, "clearance, motion and memory are missing: the text omits them");
    }

    #[test]
    fn insignificant_differences_are_not_claimed() {
        // Five wins and a draw: p = 1/16.
        let mut six: Vec<Comparison> = (0..5).map(|_| problem([Some(1.0), Some(1.1)], [1.0, 1.0])).collect();
        six.push(problem([Some(1.0), Some(1.0)], [1.0, 1.0]));
        let conclusions = words(&study(six.clone()));
        let claim = "These problems do not show which side found the shorter paths.";
        assert!(conclusions[2].starts_with(claim), "{}", conclusions[2]);
        assert!(conclusions[2].contains("better than fields in 5, worse in 0 (p = 0.062)"), "{}", conclusions[2]);
        assert!(conclusions[3].contains("in 0, worse in 0 (p = 1.000)"), "{}", conclusions[3]);
        six.pop();
        let figures = "Median length over the proven optimum: roadmaps 1.0000, fields 1.1000 (of 5 problems that \
                       all sides answered, each side with its best planner).";
        assert_eq!(words(&study(six))[2], figures, "too few problems: figures, and no claim");
    }

    #[test]
    fn swapping_sides_swaps_the_winner() {
        let all: Vec<Comparison> = (0..9).map(|_| problem([Some(1.2), Some(1.01)], [1.0, 2.0])).collect();
        let words = words(&study(all));
        assert!(words[2].starts_with("Fields found the shorter paths."), "{}", words[2]);
        assert!(words[3].starts_with("Roadmaps answered sooner."), "{}", words[3]);
    }

    #[test]
    fn planners_of_one_family_are_compared_one_by_one() {
        let mut all: Vec<Comparison> = (0..9).map(|_| problem([Some(1.1), Some(1.01)], [1.0, 2.0])).collect();
        all.iter_mut().for_each(|c| c.rows[0].family = Family::Field);
        assert!(words(&study(all))[2].starts_with("Wavefront found the shorter paths."));
    }

    #[test]
    fn the_effect_of_pulling_taut_is_reported() {
        let mut all: Vec<Comparison> = (0..9).map(|_| problem([Some(1.0), Some(1.5)], [1.0, 2.0])).collect();
        for row in all.iter_mut().map(|comparison| &mut comparison.rows[1]) {
            (row.planner, row.path_kind, row.clearance) = ("harmonic".to_owned(), PathKind::Own, Some(0.04));
            row.other_path = Some(OtherPath { length: 1.0, clearance: Some(0.01) });
        }
        let words = words(&study(all));
        let pulled = "Taut path relative to the planner's own path (median): harmonic length 0.67, \
                      clearance 0.25 (9 problems).";
        assert_eq!(words[2], pulled);
        assert!(words[3].starts_with("Roadmaps found the shorter paths.") && words[3].contains("fields 1.5000"));
    }

    #[test]
    fn an_empty_study_does_not_panic() {
        assert_eq!(words(&study(Vec::new())).len(), 1);
        let alone = Comparison { rows: Vec::new(), ..problem([None; 2], [1.0; 2]) };
        assert_eq!(words(&study(vec![alone])).len(), 1);
    }
}
