//! Shortest lengths of a point robot on maps of square cells, as others published them: maps (`.map`) and scenarios
//! (`.scen`) in the formats of movingai.com, and lengths per query (`.csv`) as EHL writes them.

use crate::roadmap::Board;
use cplan::cspace::Regions;
use cplan::planner::{Planner, Proposal, Query, Visibility};
use cplan::space::Configuration;
use std::fmt::{Display, Formatter};
use std::path::Path;
use std::time::{Duration, Instant};

/// Greatest relative difference of lengths that agree.
const TOLERANCE: f64 = 1e-6;

/// EHL writes lengths above this if there is no path.
const NO_PATH: f64 = 1e17;

/// A query, and the published length of its shortest path.
pub struct PublishedQuery {
    /// First place of the path.
    pub start: Configuration,
    /// Last place of the path.
    pub goal: Configuration,
    /// Length in cells. `None` if the source found no path.
    pub length: Option<f64>,
}

/// Two lengths that differ by more than the tolerance. `None` means that there is no path.
pub struct Difference {
    /// Number of the query in its file, from 0.
    pub number: usize,
    /// Published length.
    pub published: Option<f64>,
    /// Length of our path.
    pub ours: Option<f64>,
}

/// Result for the queries of one map or of several.
#[derive(Default)]
pub struct Lengths {
    /// Number of queries.
    pub queries: usize,
    /// Queries whose lengths differ.
    pub differences: Vec<Difference>,
    /// Time of each query.
    pub times: Vec<Duration>,
    /// Time in which the meshes were built.
    pub build: Duration,
}

impl Lengths {
    /// Adds the result of another map.
    pub fn add(&mut self, other: Self) {
        self.queries += other.queries;
        self.differences.extend(other.differences);
        self.times.extend(other.times);
        self.build += other.build;
    }

    /// Returns the median time of a query.
    pub fn median_time(&self) -> Duration {
        let mut times = self.times.clone();
        times.sort_unstable();
        times.get(times.len() / 2).copied().unwrap_or_default()
    }

    /// Counts the differences in which our path is shorter, longer or missing. A path is shorter than none.
    pub fn kinds(&self) -> [usize; 3] {
        let length = |length: Option<f64>| length.unwrap_or(f64::INFINITY);
        let count = |holds: &dyn Fn(&Difference) -> bool| self.differences.iter().filter(|d| holds(d)).count();
        [
            count(&|d| length(d.ours) < length(d.published)),
            count(&|d| d.ours.is_some_and(|ours| ours > length(d.published))),
            count(&|d| d.ours.is_none()),
        ]
    }
}

impl Display for Lengths {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let [shorter, longer, none] = self.kinds();
        let agreeing = self.queries - self.differences.len();
        write!(f, "{agreeing} of {} lengths agree", self.queries)?;
        write!(f, "; ours is shorter {shorter} times, longer {longer} times, and missing {none} times; ")?;
        write!(f, "{:.1} us per query (median), built in {:.1?}", self.median_time().as_secs_f64() * 1e6, self.build)
    }
}

/// Returns the free cells of a `.map`. The board is square; cells beyond the map are blocked. Rows of the map are
/// rows of increasing y.
///
/// # Errors
/// A message with the number of the line, if the text is not such a map.
pub fn board(map: &str) -> Result<Board, String> {
    let size = |key: &str| {
        let value = map.lines().take(4).find_map(|line| line.strip_prefix(key)?.trim().parse::<usize>().ok());
        value.ok_or_else(|| format!("no line \"{key} N\" among the first four lines"))
    };
    let (width, height) = (size("width")?, size("height")?);
    let rows: Vec<&str> = map.lines().skip(4).map(str::trim_end).collect();
    if rows.len() < height {
        return Err(format!("{} rows instead of {height}", rows.len()));
    }
    let n = width.max(height);
    let mut free = vec![false; n * n];
    for (y, row) in rows.iter().take(height).enumerate() {
        if row.len() != width {
            return Err(format!("line {}: {} cells instead of {width}", y + 5, row.len()));
        }
        for (x, cell) in row.bytes().enumerate() {
            // The format counts swamps as free, too: they only slow down.
            free[x * n + y] = matches!(cell, b'.' | b'G' | b'S');
        }
    }
    Ok(Board { size: n, free })
}

/// Returns the queries of a `.scen` with the lengths of the `.csv` beside it. Their lines must correspond.
///
/// # Errors
/// A message with the number of the line, if a text has another format or the texts do not correspond.
pub fn queries(scenario: &str, lengths: &str) -> Result<Vec<PublishedQuery>, String> {
    let lines: Vec<&str> = scenario.lines().skip(1).filter(|line| !line.trim().is_empty()).collect();
    let rows: Vec<&str> = lengths.lines().skip(1).filter(|line| !line.trim().is_empty()).collect();
    if lines.len() != rows.len() {
        return Err(format!("{} queries, but {} lengths", lines.len(), rows.len()));
    }
    let query = |(number, (line, row)): (usize, (&&str, &&str))| {
        let wrong = |text: &str| format!("query {number}: \"{text}\" has another format");
        let places: Option<Vec<f64>> = line.split_whitespace().skip(4).take(4).map(|word| word.parse().ok()).collect();
        let Some([x, y, to_x, to_y]) = places.as_deref() else { return Err(wrong(line)) };
        let fields: Vec<&str> = row.split(',').collect();
        let length = fields.get(3).and_then(|field| field.trim().parse().ok());
        let is_numbered = fields.get(1).is_some_and(|field| field.trim() == number.to_string());
        let length: f64 = length.filter(|_| is_numbered).ok_or_else(|| wrong(row))?;
        let length = (length < NO_PATH).then_some(length);
        Ok(PublishedQuery { start: Configuration::new(*x, *y), goal: Configuration::new(*to_x, *to_y), length })
    };
    lines.iter().zip(&rows).enumerate().map(query).collect()
}

/// Returns the free space of a board, as polygons with integer corners.
pub fn free_space(board: &Board) -> Regions {
    board.regions([[1, 0], [0, 1]], || false)
}

/// Plans all queries, and compares the lengths with the published ones.
pub fn compare(regions: &Regions, queries: &[PublishedQuery]) -> Lengths {
    let (planner, begin) = (Visibility::default(), Instant::now());
    let map = planner.build(regions);
    let mut lengths = Lengths { queries: queries.len(), build: begin.elapsed(), ..Lengths::default() };
    for (number, query) in queries.iter().enumerate() {
        let begin = Instant::now();
        let run = planner.query(regions, &map, &Query { start: query.start, goals: query.goal.into() });
        lengths.times.push(begin.elapsed());
        let ours = match run.outcome {
            Proposal::Found(path) => Some(path.length()),
            Proposal::NoPath | Proposal::GaveUp(_) => None,
        };
        let agrees = match (ours, query.length) {
            (Some(ours), Some(published)) => (ours - published).abs() <= TOLERANCE * published,
            (ours, published) => ours == published,
        };
        if !agrees {
            lengths.differences.push(Difference { number, published: query.length, ours });
        }
    }
    lengths
}

/// Compares the lengths of one map in a folder with `maps`, `scenarios` and `results`.
///
/// # Errors
/// A message with the file, if one of the three files is missing or has another format.
pub fn compare_files(folder: &Path, name: &str) -> Result<Lengths, String> {
    let read = |file: String| std::fs::read_to_string(folder.join(&file)).map_err(|error| format!("{file}: {error}"));
    let map = read(format!("maps/{name}.map"))?;
    let board = board(&map).map_err(|error| format!("maps/{name}.map: {error}"))?;
    let [scenario, lengths] = [read(format!("scenarios/{name}.map.scen"))?, read(format!("results/{name}.csv"))?];
    let queries = queries(&scenario, &lengths).map_err(|error| format!("results/{name}.csv: {error}"))?;
    Ok(compare(&free_space(&board), &queries))
}
