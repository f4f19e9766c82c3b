//! The conclusion of a study in one sentence.

use super::best::Better;
use super::comparison::Comparison;
use super::recommendation::Purpose;
use super::study::Study;
use cplan_model::Status;
use cplan_text::{counted, length_down, percent};

/// Values count as equal if they differ by at most this fraction of them.
const EQUALITY_TOLERANCE: f64 = 1e-6;

impl Study {
    /// Returns the conclusion in one sentence: about the paths if there is one problem, otherwise about the number of problems in
    /// which each planner is best. Names of planners are between backticks.
    pub fn conclusion(&self) -> String {
        match &self.comparisons[..] {
            [] => "No problem was run.".to_owned(),
            [only] => only.conclusion(),
            _ => self.conclusion_of_many(),
        }
    }

    /// Returns the answer in a short sentence, for the title of a page. Names of planners are between backticks.
    pub fn headline(&self) -> String {
        if let [only] = &self.comparisons[..] {
            return only.headline();
        }
        let ([found, ..], all) = (self.outcome_counts(), counted(self.comparisons.len(), "problem"));
        match self.most_recommended(Purpose::Shortest) {
            Some((planner, wins)) => {
                let name = self.planners()[planner];
                format!("{found} of {all} have a certified path; `{name}` has the shortest in {wins}")
            }
            None => format!("None of {all} has a certified path"),
        }
    }

    fn conclusion_of_many(&self) -> String {
        let [found, infeasible, open] = self.outcome_counts();
        let all = counted(self.comparisons.len(), "problem");
        if found == 0 {
            return format!("None of {all} has a certified path: {infeasible} proven infeasible, {open} unknown.");
        }
        let claim = |purpose: Purpose, what: &str| {
            let (planner, wins) = self.most_recommended(purpose)?;
            Some(format!("`{}` {what} {wins}", self.planners()[planner]))
        };
        let claims = [
            claim(Purpose::Shortest, "has the shortest path in"),
            claim(Purpose::Safest, "the greatest clearance in"),
            claim(Purpose::Quickest, "the quickest answer in"),
        ];
        let claims: Vec<String> = claims.into_iter().flatten().collect();
        format!("Of {} with a certified path, {}.", counted(found, "problem"), claims.join(", "))
    }

    /// Returns the number of problems in which a planner is the best for a purpose, or equal to the best.
    pub fn wins(&self, planner: usize, purpose: Purpose) -> usize {
        let is_best = |comparison: &&Comparison| {
            let value = |row: usize| comparison.rows.get(row).and_then(|row| purpose.value(row));
            let best = comparison.recommended(purpose).and_then(value);
            value(planner).zip(best).is_some_and(|(own, best)| {
                own == best || (own - best).abs() <= EQUALITY_TOLERANCE * own.abs().max(best.abs())
            })
        };
        self.comparisons.iter().filter(is_best).count()
    }

    /// Returns the planner that is the best for a purpose in most problems, and the number of these problems. `None` if no
    /// planner found a path.
    pub fn most_recommended(&self, purpose: Purpose) -> Option<(usize, usize)> {
        let wins: Vec<usize> = (0..self.planners().len()).map(|planner| self.wins(planner, purpose)).collect();
        let best = Better::More.first_best(wins.iter().map(|&wins| (wins > 0).then_some(wins as f64)))?;
        Some((best, wins[best]))
    }
}

impl Comparison {
    /// Returns the answer in a short sentence: how near the shortest path is to the optimum, and how long the path is that
    /// was found first.
    fn headline(&self) -> String {
        let best = |purpose| self.recommended(purpose).map(|row| &self.rows[row]);
        let Some(shortest) = best(Purpose::Shortest) else { return self.conclusion() };
        let name = &shortest.planner;
        let near = self.over_optimum(shortest).map_or_else(
            || format!("`{name}` has the shortest path"),
            |ratio| format!("`{name}` is within {} of the optimum, proven", percent(ratio - 1.0)),
        );
        let Some(quickest) = best(Purpose::Quickest) else { return near };
        if std::ptr::eq(quickest, shortest) {
            return format!("{near}, and has the quickest answer");
        }
        let longer = self.ratio(quickest).map_or(0.0, |ratio| ratio - 1.0);
        let length = match longer > EQUALITY_TOLERANCE {
            true => format!("{} longer", percent(longer)),
            false => "as short".to_owned(),
        };
        format!("{near}; the quickest answer, by `{}`, is {length}", quickest.planner)
    }

    /// Returns the conclusion in one sentence, with names of planners between backticks.
    pub fn conclusion(&self) -> String {
        let count = |outcome| self.rows.iter().filter(|row| row.outcome == outcome).count();
        let (found, all) = (count(Status::Found), self.rows.len());
        let best = |purpose| self.recommended(purpose).map(|row| &self.rows[row]);
        let (Some(shortest), Some(safest)) = (best(Purpose::Shortest), best(Purpose::Safest)) else {
            return match count(Status::Infeasible) {
                0 => format!("None of {} found a path or a proof that there is none.", counted(all, "planner")),
                proved => format!("There is no path: {proved} of {} proved it.", counted(all, "planner")),
            };
        };
        let who = match found {
            _ if all == 1 => format!("`{}` found a path", shortest.planner),
            _ if found == all => format!("All {all} planners found a path"),
            _ => format!("{found} of {all} planners found a path"),
        };
        let over = |row| self.over_optimum(row).map(|ratio| percent(ratio - 1.0));
        let near = over(shortest).map_or_else(
            || format!("`{}` has the shortest", shortest.planner),
            |over| format!("`{}` comes within {over} of the optimum", shortest.planner),
        );
        let clearance = |row: &super::Row| match row.clearance {
            Some(metres) => format!("keeps {} from obstacles", length_down(metres)),
            None => "has no obstacle within reach".to_owned(),
        };
        if found == 1 {
            let near = over(shortest).map_or_else(String::new, |over| format!(" is within {over} of the optimum and"));
            return format!("{who}, which{near} {}.", clearance(shortest));
        }
        if std::ptr::eq(shortest, safest) {
            return format!(
                "{who}: that of `{}` is both the shortest and the safest, and {}.",
                shortest.planner,
                clearance(safest)
            );
        }
        // If there is a bound, the same number as in the table.
        let longer = over(safest)
            .map(|over| format!(", with a path at most {over} longer than the optimum"))
            .or_else(|| Some(format!(", with a path {} longer than the shortest", percent(self.ratio(safest)? - 1.0))));
        format!("{who}: {near}, and `{}` {}{}.", safest.planner, clearance(safest), longer.unwrap_or_default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Family, Row};

    fn comparison(rows: &[(&str, Option<f64>, f64)]) -> Comparison {
        let row = |&(name, length, clearance): &(&str, Option<f64>, f64)| Row {
            length,
            clearance: length.map(|_| clearance),
            total: length,
            ..Row::new(name, Family::Exact, if length.is_some() { Status::Found } else { Status::Unknown })
        };
        Comparison {
            problem: "p".to_owned(),
            length_unit: "rad".to_owned(),
            query: None,
            bound: Some(1.0),
            rows: rows.iter().map(row).collect(),
        }
    }

    #[test]
    fn one_problem_has_the_shortest_and_the_safest() {
        let all = comparison(&[("a", Some(1.25), 0.001), ("b", Some(2.5), 0.12045), ("c", Some(1.5), 0.05)]);
        assert_eq!(
            all.conclusion(),
            "All 3 planners found a path: `a` comes within 25.00 % of the optimum, and `b` keeps 120.4 mm from \
             obstacles, with a path at most 150.00 % longer than the optimum."
        );
        let some = comparison(&[("a", Some(1.25), 0.12), ("b", None, 0.0), ("c", Some(1.5), 0.05)]);
        assert_eq!(
            some.conclusion(),
            "2 of 3 planners found a path: that of `a` is both the shortest and the safest, and keeps 120.0 mm from \
             obstacles."
        );
        let one = comparison(&[("a", Some(1.25), 0.12)]);
        assert_eq!(
            one.conclusion(),
            "`a` found a path, which is within 25.00 % of the optimum and keeps 120.0 mm from obstacles."
        );
    }

    #[test]
    fn titles_state_the_answer() {
        let study = |comparisons| Study {
            title: String::new(),
            sampling: None,
            comparisons,
            left_out: Vec::new(),
            refused: Vec::new(),
        };
        let headline = |rows: &[(&str, Option<f64>, f64)], totals: &[f64]| {
            let mut comparison = comparison(rows);
            comparison.rows.iter_mut().zip(totals).for_each(|(row, total)| row.total = Some(*total));
            study(vec![comparison]).headline()
        };
        let rows = [("a", Some(1.25), 0.1), ("b", Some(1.5), 0.1)];
        assert_eq!(
            headline(&rows, &[1.0, 2.0]),
            "`a` is within 25.00 % of the optimum, proven, and has the quickest answer"
        );
        assert_eq!(
            headline(&rows, &[2.0, 1.0]),
            "`a` is within 25.00 % of the optimum, proven; the quickest answer, by `b`, is 20.00 % longer"
        );
        let equal = [("a", Some(1.25), 0.1), ("b", Some(1.25), 0.1)];
        assert_eq!(
            headline(&equal, &[2.0, 1.0]),
            "`a` is within 25.00 % of the optimum, proven; the quickest answer, by `b`, is as short"
        );
        let none = comparison(&[("a", None, 0.0)]);
        assert_eq!(study(vec![none.clone()]).headline(), none.conclusion());
        let many = study(vec![comparison(&rows), none.clone()]);
        assert_eq!(many.headline(), "1 of 2 problems have a certified path; `a` has the shortest in 1");
        assert_eq!(study(vec![none.clone(), none]).headline(), "None of 2 problems has a certified path");
    }

    #[test]
    fn without_a_path_the_answer_comes_first() {
        let mut none = comparison(&[("a", None, 0.0), ("b", None, 0.0)]);
        assert_eq!(none.conclusion(), "None of 2 planners found a path or a proof that there is none.");
        none.rows[1].outcome = Status::Infeasible;
        assert_eq!(none.conclusion(), "There is no path: 1 of 2 planners proved it.");
    }

    #[test]
    fn many_problems_count_wins() {
        let comparisons = vec![
            comparison(&[("a", Some(1.25), 0.001), ("b", Some(2.5), 0.12045)]),
            comparison(&[("a", Some(1.25), 0.001), ("b", Some(1.25), 0.1)]),
            comparison(&[("a", None, 0.0), ("b", None, 0.0)]),
        ];
        let study =
            Study { title: String::new(), sampling: None, comparisons, left_out: Vec::new(), refused: Vec::new() };
        assert_eq!([0, 1].map(|planner| study.wins(planner, Purpose::Shortest)), [2, 1]);
        assert_eq!(
            study.conclusion(),
            "Of 2 problems with a certified path, `a` has the shortest path in 2, `b` the greatest clearance in 2, `a` the \
             quickest answer in 2."
        );
    }
}
