//! A study as a benchmark log in OMPL's format, from which its `ompl_benchmark_statistics.py` makes a database for Planner Arena.
//!
//! Mark Moll, Ioan Sucan, Lydia Kavraki, *Benchmarking motion planning algorithms* (2015). OMPL's documentation has the grammar
//! ("How to benchmark planners"). A log has one experiment: here it is the study, with the names of the problems as its setup.
//! Its runs are the problems.

use super::row::Row;
use super::study::Study;
use super::{Comparison, Family};
use cplan_model::Status;

/// Words of OMPL for the state of a planner, in the order of its `PlannerStatus`.
const OMPL_STATUS_WORDS: [&str; 10] = [
    "Unknown status",
    "Invalid start",
    "Invalid goal",
    "Unrecognized goal type",
    "Timeout",
    "Approximate solution",
    "Exact solution",
    "Crash",
    "Abort",
    "Infeasible",
];

/// Computes the value of a column from the number of a run (from 1), its problem and its row.
type Value = fn(usize, &Comparison, &Row) -> Option<String>;

/// The properties of each run: first those that OMPL's planners also have, with OMPL's names and units (seconds, megabytes of a
/// million bytes), then those that only cplan has.
const RUN_PROPERTIES: [(&str, Value); 18] = [
    ("time REAL", |_, _, row| real(row.total)),
    ("memory REAL", |_, _, row| real(row.memory.map(|bytes| bytes as f64 / 1e6))),
    ("status ENUM", |_, _, row| Some(status(row.outcome).to_string())),
    ("solved BOOLEAN", |_, _, row| flag(row.outcome == Status::Found)),
    ("approximate solution BOOLEAN", |_, _, _| flag(false)),
    ("correct solution BOOLEAN", |_, _, row| (row.outcome == Status::Found).then(|| "1".to_owned())),
    ("solution length REAL", |_, _, row| real(row.length)),
    ("solution clearance REAL", |_, _, row| real(row.clearance)),
    ("solution segments INTEGER", |_, _, row| row.pieces.map(|n| n.to_string())),
    ("graph states INTEGER", |_, _, row| row.counts()[0].map(|n| n.to_string())),
    ("graph motions INTEGER", |_, _, row| row.counts()[1].map(|n| n.to_string())),
    ("problem INTEGER", |number, _, _| Some(number.to_string())),
    ("proven infeasible BOOLEAN", |_, _, row| flag(row.outcome == Status::Infeasible)),
    ("length over proven optimum REAL", |_, comparison, row| real(comparison.over_optimum(row))),
    ("motion time REAL", |_, _, row| real(row.duration)),
    ("build time REAL", |_, _, row| real(row.build)),
    ("query time REAL", |_, _, row| real(row.query)),
    ("certify time REAL", |_, _, row| real(row.certify)),
];

fn real(value: Option<f64>) -> Option<String> {
    value.filter(|v| v.is_finite()).map(|v| v.to_string())
}

fn flag(value: bool) -> Option<String> {
    Some(u8::from(value).to_string())
}

fn status(outcome: Status) -> usize {
    match outcome {
        Status::Found => 6,
        Status::Infeasible => 9,
        Status::Unknown => 0,
    }
}

impl Study {
    /// Writes the log of a benchmark in OMPL's format. `started` is date and time in words, `seconds` the total duration. The
    /// limits of time and memory are 0, because planners had none. The machine is not named.
    pub fn to_arena_log(&self, started: &str, seconds: f64) -> String {
        let mut log = format!("cplan version {}\n", env!("CARGO_PKG_VERSION"));
        log += &format!("Experiment {}\n0 experiment properties\nRunning on localhost\n", word(&self.title));
        log += &format!("Starting at {}\n<<<|\n{}\n", line(started), line(&self.title));
        for (i, comparison) in self.comparisons.iter().enumerate() {
            log += &format!("problem {}: {} [{}]\n", i + 1, line(&comparison.problem), line(&comparison.length_unit));
        }
        log += &format!("|>>>\n{} is the random seed\n", self.sampling.map_or(0, |sampling| sampling.seed));
        log += &format!("0 seconds per run\n0 MB per run\n{} runs per planner\n", self.comparisons.len());
        log += &format!(
            "{seconds} seconds spent to collect the data\n1 enum type\nstatus|{}\n",
            OMPL_STATUS_WORDS.join("|")
        );
        log += &format!("{} planners\n", self.planners().len());
        for (i, name) in self.planners().into_iter().enumerate() {
            log += &self.planner_log(i, name);
        }
        log
    }

    fn planner_log(&self, planner: usize, name: &str) -> String {
        let family = self.runs(planner).next().map_or("", |(_, row)| Family::name(row.family));
        let mut log = format!("{}\n1 common properties\nfamily = {family}\n", line(name));
        log += &format!("{} properties for each run\n", RUN_PROPERTIES.len());
        for (property, _) in RUN_PROPERTIES {
            log += &format!("{property}\n");
        }
        log += &format!("{} runs\n", self.runs(planner).count());
        for (i, (comparison, row)) in self.runs(planner).enumerate() {
            for (_, value) in RUN_PROPERTIES {
                log += &format!("{}; ", value(i + 1, comparison, row).unwrap_or_default());
            }
            log.push('\n');
        }
        log + ".\n"
    }
}

/// Returns the text on one line, changed so that readers cannot mistake it for a mark of the format.
fn line(text: &str) -> String {
    let clean: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let clean = clean.trim();
    if clean.starts_with(['<', '|', '.']) { format!("'{clean}'") } else { clean.to_owned() }
}

/// Converts the text to a single word, as the name of an experiment.
fn word(text: &str) -> String {
    let word = text.split(|c: char| c.is_whitespace() || c.is_control()).filter(|part| !part.is_empty());
    let word = word.collect::<Vec<_>>().join("_");
    if word.is_empty() { "cplan".to_owned() } else { word }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Sampling;

    /// The contents of a log, parsed by its grammar.
    struct Log {
        experiment: String,
        seed: u64,
        planners: Vec<Planner>,
    }

    struct Planner {
        name: String,
        /// Names and types of the properties.
        properties: Vec<(String, String)>,
        /// Values of each run, in the order of the properties.
        runs: Vec<Vec<Option<f64>>>,
    }

    /// Reads the grammar of OMPL's documentation, and refuses all that `ompl_benchmark_statistics.py` refuses.
    struct Reader<'a>(std::str::Lines<'a>);

    impl<'a> Reader<'a> {
        fn line(&mut self) -> &'a str {
            self.0.next().expect("the log ends too early")
        }

        /// Reads a line that ends in `end`, and returns the text before it.
        fn line_up_to(&mut self, end: &str) -> &'a str {
            let line = self.line();
            line.strip_suffix(end).unwrap_or_else(|| panic!("{line:?} does not end in {end:?}"))
        }

        fn rest_after(&mut self, begin: &str) -> &'a str {
            let line = self.line();
            line.strip_prefix(begin).unwrap_or_else(|| panic!("{line:?} does not begin with {begin:?}"))
        }

        fn count(&mut self, end: &str) -> usize {
            self.line_up_to(end).parse().unwrap()
        }

        fn log(text: &'a str) -> Log {
            let mut reader = Reader(text.lines());
            let version = reader.line().split_once(" version ").expect("library and version");
            assert!(!version.0.contains(' ') && !version.1.is_empty());
            let experiment = reader.rest_after("Experiment ").to_owned();
            assert!(!experiment.contains(char::is_whitespace), "the last word of the line is read only");
            assert_eq!(reader.count(" experiment properties"), 0);
            reader.rest_after("Running on ");
            reader.rest_after("Starting at ");
            assert_eq!(reader.line(), "<<<|");
            while !reader.line().starts_with("|>>>") {}
            let seed = reader.line_up_to(" is the random seed").parse().unwrap();
            for end in [" seconds per run", " MB per run"] {
                assert!(reader.line_up_to(end).parse::<f64>().unwrap() >= 0.0);
            }
            let runs = reader.count(" runs per planner");
            assert!(reader.line_up_to(" seconds spent to collect the data").parse::<f64>().unwrap() >= 0.0);
            assert_eq!(reader.count(" enum type"), 1);
            assert_eq!(reader.line().split('|').count(), 11);
            let planners = (0..reader.count(" planners")).map(|_| reader.planner(runs)).collect();
            assert_eq!(reader.0.next(), None, "nothing follows");
            Log { experiment, seed, planners }
        }

        fn planner(&mut self, runs: usize) -> Planner {
            let name = self.line().to_owned();
            for _ in 0..self.count(" common properties") {
                assert!(self.line().contains(" = "));
            }
            let property = |line: &str| {
                let (name, kind) = line.rsplit_once(' ').unwrap();
                assert!(["BOOLEAN", "INTEGER", "REAL", "ENUM"].contains(&kind), "{line}");
                (name.replace(' ', "_"), kind.to_owned())
            };
            let count = self.count(" properties for each run");
            let properties: Vec<_> = (0..count).map(|_| property(self.line())).collect();
            assert_eq!(self.count(" runs"), runs);
            let run = |line: &str| {
                let mut values: Vec<&str> = line.split("; ").collect();
                assert_eq!(values.pop(), Some(""), "each value is followed by its mark");
                assert_eq!(values.len(), count, "{line}");
                values.iter().map(|v| (!v.is_empty()).then(|| v.parse().unwrap())).collect()
            };
            let runs = (0..runs).map(|_| run(self.line())).collect();
            assert_eq!(self.line(), ".");
            Planner { name, properties, runs }
        }
    }

    fn study(title: &str, problem: &str, planner: &str) -> Study {
        let found = Row {
            length: Some(2.5),
            pieces: Some(3),
            total: Some(0.25),
            memory: Some(2_000_000),
            ..Row::new(planner, Family::Roadmap, Status::Found)
        };
        let stuck = Row { length: Some(f64::NAN), ..Row::new(planner, Family::Roadmap, Status::Infeasible) };
        let comparison = |row| Comparison {
            problem: problem.to_owned(),
            length_unit: "rad".to_owned(),
            query: None,
            bound: Some(2.0),
            rows: vec![row],
        };
        let sampling = Some(Sampling { queries: 2, seed: u64::MAX });
        let comparisons = vec![comparison(found), comparison(stuck)];
        Study { title: title.to_owned(), sampling, comparisons, left_out: Vec::new(), refused: Vec::new() }
    }

    #[test]
    fn the_log_keeps_to_the_grammar() {
        let text = study("shelf: planar_2r", "shelf", "visibility").to_arena_log("2026-01-02 03:04:05 UTC", 0.5);
        let log = Reader::log(&text);
        assert_eq!((log.experiment.as_str(), log.seed), ("shelf:_planar_2r", u64::MAX));
        let Planner { name, properties, runs } = &log.planners[0];
        assert_eq!((name.as_str(), runs.len()), ("visibility", 2));
        let value = |run: usize, name: &str| runs[run][properties.iter().position(|p| p.0 == name).unwrap()];
        let names = ["time", "memory", "status", "solved", "solution_length", "solution_segments", "problem"];
        assert_eq!(names.map(|name| value(0, name)), [0.25, 2.0, 6.0, 1.0, 2.5, 3.0, 1.0].map(Some));
        assert_eq!(value(0, "length_over_proven_optimum"), Some(1.25));
        assert_eq!(names.map(|n| value(1, n)), [None, None, Some(9.0), Some(0.0), None, None, Some(2.0)]);
        assert_eq!(value(1, "proven_infeasible"), Some(1.0));
    }

    #[test]
    fn no_name_breaks_the_format() {
        for odd in ["|>>>", "<<<|\n|>>>\n", ".", "a\nb; c", "", "  ", "7 planners\n7"] {
            let log = Reader::log(&study(odd, odd, odd).to_arena_log(odd, 0.0)).planners;
            assert_eq!((log.len(), log[0].runs.len()), (1, 2), "{odd:?}");
        }
    }

    #[test]
    fn an_empty_study_makes_a_log() {
        let none = Study {
            title: String::new(),
            sampling: None,
            comparisons: Vec::new(),
            left_out: Vec::new(),
            refused: Vec::new(),
        };
        assert!(Reader::log(&none.to_arena_log("", 0.0)).planners.is_empty());
    }
}
