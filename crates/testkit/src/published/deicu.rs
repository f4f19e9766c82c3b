//! Tables 17, 18 and 19 of L. E. Deicu, *Planejadores de caminho baseados em campos potenciais* (UFRGS, Porto Alegre
//! 2012): sweeps of twelve algorithms on three line maps, before preferences apply and in total.

use super::line_maps::Scene;
use super::row::{Claim, Count};
use Claim::{Close, Match, Unmatched};
use cplan::field::{Difference, Equation, Factor, Lines, Measure, Order, Precision, Relaxation, Scan, Stopping, relax};
use std::error::Error;

/// The scales of the tables: numbers of cells along each axis.
pub const SCALES: [usize; 2] = [100, 250];

/// The counts of one map. Arrays of four have an entry for each of [`RELAXATIONS`], and arrays of two for each of
/// [`SCALES`].
pub struct Table {
    /// Number of the table in the source, and the part of the map that was used.
    pub title: &'static str,
    /// The world of the map in `workspaces/maps`.
    world: &'static str,
    /// The obstacle that was left out. `None` if all were used.
    without: Option<&'static str>,
    before: [[(usize, Claim); 2]; 4],
    /// Counts with preferences, and with altered ones ("BVP 2").
    after: [[[(usize, Claim); 2]; 4]; 2],
    /// Notes.
    pub notes: &'static [&'static str],
}

/// The names of the relaxations. The source calls them "simples" and "simultâneo".
pub const RELAXATIONS: [&str; 4] = ["GS simple", "GS simultaneous", "SOR simple", "SOR simultaneous"];

/// Returns the settings of a relaxation. Lines have increasing `x`. Values of Gauss-Seidel are `float`s; with doubles, the counts
/// on 250 x 250 cells are 8928, 8931, 5572, 5575. Over-relaxed values are doubles, because `float`s never settle among
/// preferences. They must be clamped to 0..1; otherwise, the first stage takes 230 sweeps on map 1 instead of 147.
fn relaxation(of: usize) -> Relaxation {
    let order = if of.is_multiple_of(2) { Order::Lines(Scan::ROWS) } else { Order::Corners(Lines::Rows) };
    match of {
        0 | 1 => Relaxation::gauss_seidel(order).with_precision(Precision::Single),
        _ => Relaxation::sor(Factor::Formula, order).clamped([0.0, 1.0]),
    }
}

/// Returns the stopping rule: the sum of all changes in a sweep must fall below 0.01. All published counts are below these limits
/// on the number of sweeps; over-relaxation with preferences may not converge at all.
fn stopping(of: usize) -> Stopping {
    Stopping { measure: Measure::SumOfChange, below: 0.01, max_sweeps: if of < 2 { 30_000 } else { 3_000 } }
}

/// Numbers of sweeps of the harmonic stage and of both stages. `None` if a stage does not converge.
pub type Sweeps = [Option<usize>; 2];

/// Relaxes the fields for one line of a table, and returns the numbers of sweeps. `of` is an index into
/// [`RELAXATIONS`].
pub fn measure(scene: &Scene, cells: usize, of: usize, altered: bool) -> Sweeps {
    let relaxation = relaxation(of);
    // The sign of the altered form is that of the source's equation, `- epsilon v grad p`, not of its algorithm; that of the
    // other form is the algorithm's.
    let sign = if altered { -1.0 } else { 1.0 };
    let epsilon = scene.epsilon(cells).into_iter().map(|epsilon| sign * epsilon).collect();
    let equation = match altered {
        true => Equation::AlteredPreference { epsilon },
        false => Equation::Preference { epsilon, difference: Difference::Central },
    };
    let field = relax(&scene.domain(cells), &equation, &relaxation, &stopping(of));
    let stages = field.map(|field| field.stages).unwrap_or_default();
    let first = stages.first().filter(|stage| stage.converged).map(|stage| stage.sweeps);
    let second = stages.get(1).filter(|stage| stage.converged).map(|stage| stage.sweeps);
    [first, first.zip(second).map(|(first, second)| first + second)]
}

impl Table {
    /// Returns the printed number of sweeps for a relaxation (index into [`RELAXATIONS`]) and a scale (index into [`SCALES`]).
    /// Stage 0 is without preferences. Stages 1 and 2 have totals, with preferences and with altered ones.
    pub fn published(&self, of: usize, stage: usize, scale: usize) -> usize {
        match stage {
            0 => self.before[of][scale].0,
            stage => self.after[stage - 1][of][scale].0,
        }
    }
}

/// Reads the map of a table.
///
/// # Errors
/// Defects of the files.
pub fn scene(table: &Table) -> Result<Scene, Box<dyn Error>> {
    Scene::read(table.world, table.without)
}

/// A line of a table: algorithm, scale, counts before preferences, and total counts with preferences, if there are any.
pub struct Line {
    algorithm: String,
    cells: usize,
    before: Count,
    after: Option<Count>,
}

impl Line {
    /// Iterates over the pairs of published and measured numbers in the line.
    pub fn counts(&self) -> impl Iterator<Item = &Count> {
        std::iter::once(&self.before).chain(&self.after)
    }
}

impl std::fmt::Display for Line {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let after = self.after.map(|count| count.to_string()).unwrap_or_default();
        write!(f, "{:<23} {:>3}  {:<36} {after}", self.algorithm, self.cells, self.before.to_string())
    }
}

/// Returns all lines of a table at these scales (indices into [`SCALES`]).
pub fn lines(table: &Table, scene: &Scene, scales: &[usize]) -> Vec<Line> {
    // Each algorithm is a separate task. Its harmonic stage is also the first stage of the preferences after it.
    let tasks = scales.iter().flat_map(|&scale| (0..8).map(move |task| (scale, task % 4, task / 4)));
    let results: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = tasks
            .map(|(scale, of, altered)| {
                let run = move || measure(scene, SCALES[scale], of, altered == 1);
                (scale, of, altered, scope.spawn(run))
            })
            .collect();
        threads.into_iter().map(|(scale, of, altered, t)| (scale, of, altered, t.join().expect("no panic"))).collect()
    });
    let line = |name: &str, scale: usize, of: usize, before: Option<usize>, after: Option<Count>| {
        let before = Count::of_sweeps(table.published(of, 0, scale), before, table.before[of][scale].1);
        Line { algorithm: format!("{name} {}", RELAXATIONS[of]), cells: SCALES[scale], before, after }
    };
    let harmonic = results.iter().filter(|(_, _, altered, _)| *altered == 0);
    let mut lines: Vec<Line> =
        harmonic.map(|&(scale, of, _, [first, _])| line("HFPP", scale, of, first, None)).collect();
    for &(scale, of, altered, [first, both]) in &results {
        let claim = table.after[altered][of][scale].1;
        let after = Count::of_sweeps(table.published(of, 1 + altered, scale), both, claim);
        lines.push(line(["BVP", "BVP 2"][altered], scale, of, first, Some(after)));
    }
    lines
}

/// The tables as printed.
pub const TABLES: [Table; 3] = [
    Table {
        title: "Table 17: map 1, preference file 1",
        world: "leon",
        without: None,
        before: [
            [(1408, Match), (8924, Close(0.1))],
            [(1411, Match), (8929, Close(0.1))],
            [(124, Close(3.0)), (355, Close(3.0))],
            [(194, Unmatched), (512, Close(3.0))],
        ],
        after: [
            [
                [(1495, Close(1.0)), (9821, Close(1.0))],
                [(1502, Close(1.0)), (9838, Close(1.0))],
                [(181, Close(3.0)), (569, Close(3.0))],
                [(237, Close(3.0)), (783, Unmatched)],
            ],
            [
                [(1542, Match), (10373, Close(0.1))],
                [(1551, Close(0.1)), (10393, Close(0.1))],
                [(270, Unmatched), (679, Close(3.0))],
                [(310, Unmatched), (686, Unmatched)],
            ],
        ],
        notes: NOTES_1,
    },
    Table {
        title: "Table 18: map 2, preference file 2",
        world: "rings",
        without: None,
        before: [
            [(884, Match), (5572, Match)],
            [(887, Match), (5575, Match)],
            [(166, Close(3.0)), (434, Close(3.0))],
            [(189, Close(3.0)), (477, Unmatched)],
        ],
        after: [
            [
                [(919, Unmatched), (5840, Unmatched)],
                [(923, Unmatched), (5846, Unmatched)],
                [(238, Unmatched), (669, Unmatched)],
                [(242, Unmatched), (676, Unmatched)],
            ],
            [
                [(1100, Match), (7352, Close(0.1))],
                [(1106, Match), (7363, Close(0.1))],
                [(266, Close(3.0)), (876, Unmatched)],
                [(277, Close(3.0)), (886, Unmatched)],
            ],
        ],
        notes: NOTES_2,
    },
    Table {
        title: "Table 19: map 3 without its last four lines (the kite), preference file 2 in the map's bounds",
        world: "pillars",
        without: Some("kite"),
        before: [
            [(2287, Close(0.2)), (14369, Close(0.2))],
            [(2292, Close(0.2)), (14360, Close(0.2))],
            [(189, Unmatched), (471, Unmatched)],
            [(270, Unmatched), (750, Unmatched)],
        ],
        after: [
            [
                [(2689, Unmatched), (18816, Unmatched)],
                [(2707, Unmatched), (18866, Unmatched)],
                [(279, Unmatched), (731, Unmatched)],
                [(366, Unmatched), (1565, Unmatched)],
            ],
            [
                [(2914, Unmatched), (22134, Unmatched)],
                [(2939, Unmatched), (22156, Unmatched)],
                [(288, Unmatched), (841, Unmatched)],
                [(378, Unmatched), (1312, Unmatched)],
            ],
        ],
        notes: NOTES_3,
    },
];

/// The method of all three tables.
pub const METHOD: &[&str] = &[
    "Cell = floor((x - min) / (max - min) n), walls by Bresenham, outermost cells walls, obstacles 1, free cells from 0; the",
    "goal rectangle with its last cells, preference rectangles without; stop when the sum of |change| is below 0.01.",
    "GS: values kept as floats. SOR: factor of the text, values brought back into 0..1, the preference added without the factor.",
    "BVP: p = h + epsilon / 8 d, as in the algorithm. BVP 2: p = h - epsilon / 4 d, the sign of the equation (that of the",
    "algorithm gives 1512 for 1542). The text's rule, |sum of this sweep - sum of the last|, has no constant that fits.",
];

const NOTES_1: &[&str] = &[
    "Preference file 1 was used, not 2: with 2 the GS rows before preferences are the same at 100 cells, but SOR takes 147 and",
    "191, and BVP 2 in all 1456 and 1461 sweeps.",
    "Unmatched: single SOR counts. Tried: factors of n - 2, n - 1, n + 1, n / 2 cells and given ones from 1.5 to 1.995; no",
    "clamp, clamps at the greatest neighbour, reflection, GS beside walls; all corner orders; floats.",
];

const NOTES_2: &[&str] = &[
    "Unmatched: BVP, whose preferences add 35 sweeps in the source and 179 here. Tried: both signs, rectangles with their last",
    "cells, each subset of them, mirrored and transposed; gradients normalised otherwise, from one-sided differences, with",
    "swapped or negated components; a factor of 1/4 or 1/16. SOR on 250 cells: as for map 1; floats give 431 and 485.",
];

const NOTES_3: &[&str] = &[
    "The map as printed gives 1404 to 1611 sweeps of GS (file 2), 1719 (file 1): it is not the map that was measured. Without",
    "its last four lines GS comes close; what follows from other walls (SOR, preferences) does not match.",
    "Tried: both preference files, either file's bounds; some subsets of up to four lines left out, with SOR as the measure.",
];
