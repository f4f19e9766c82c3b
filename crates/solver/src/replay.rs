//! How a planner came to its answer, told again in phases: for pages and pictures that move.
//!
//! Most of it lies in the run's [`Trace`], in the order in which it came about; a phase says which part of it is shown. What no run
//! keeps is found once more when somebody asks for the replay: the boxes that slabs end with, values of a field between its sweeps, the path
//! before it was pulled taut. So plans that nobody watches cost what they did.

use super::admission::Ends;
use super::ladder::FIRST_BOXES;
use super::{Answer, BoundedPath, Options, Space, solve};
use cplan_core::cspace::ZonedGrid;
use cplan_core::model::{MotionProblem, Outcome};
use cplan_core::planner::{CellKind, GraphKind, Note, PathKind, Proposal, Size, Trace};
use cplan_core::space::{Configuration, Path};
use cplan_fields::{Device, Measure, RELATIVE_TOLERANCE, Stopping, relax_watched};
use cplan_fields::{FieldChoice, field_domain};
use cplan_proofs::{Occupancy, slab_boxes};
use cplan_text::{counted, percent};

/// How a planner came to its answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Replay {
    /// One after the other; what one has shown stays, but for boxes and values that are found again for the replay alone.
    pub phases: Vec<Phase>,
}

/// A part of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Phase {
    /// What happens, in a line.
    pub caption: String,
    /// What is shown of it.
    pub shows: Shows,
    /// How many things come one after the other; more than none.
    pub events: usize,
}

/// What a phase shows, bit by bit. Without data of its own it is a part of the drawn [`Trace`], in its order.
#[derive(Debug, Clone, PartialEq)]
pub enum Shows {
    /// Configurations, as the edges come to them.
    Nodes,
    /// Edges of a graph.
    Edges,
    /// Cells of a decomposition.
    Cells {
        /// Whether a line sweeps over them, from the left.
        swept: bool,
    },
    /// The cells of the channel.
    Channel,
    /// Where a search of a graph came.
    Expanded,
    /// Slices that the path passes.
    Slices,
    /// Cells of a grid, by their labels or as they were expanded.
    Wave,
    /// Equipotentials from the goal outwards.
    Levels,
    /// The boxes of the trace, coarse to fine.
    Boxes,
    /// Boxes of slabs, coarse to fine.
    Slabs(SlabBoxes),
    /// Values of a field between its sweeps.
    Sweeps(Sweeps),
    /// A path that is not the answer's: before it was pulled taut.
    Own(Path),
    /// The answer's path.
    Path,
    /// The boxes of the proof.
    Proof,
}

/// Boxes that cover the configuration space: lower and upper corner of each, the largest first.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SlabBoxes {
    /// No collision anywhere in them.
    pub free: Vec<[Configuration; 2]>,
    /// Collision everywhere in them.
    pub stuck: Vec<[Configuration; 2]>,
    /// Neither is known.
    pub mixed: Vec<[Configuration; 2]>,
}

/// A field between its sweeps, at some cells of the grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweeps {
    /// How many there are along each axis.
    pub cells: [usize; 2],
    /// After how many sweeps, and the values: natural logarithms, minus infinity where nothing has come yet.
    pub frames: Vec<(usize, Vec<f64>)>,
}

/// Slabs that are looked at for a replay at most, and pairs of shapes: some tens of milliseconds' worth.
const SLABS: usize = 2_000;
const PAIRS: usize = 4096;

/// Boxes narrower than this share of the joint's range are left out: less than a pixel.
const INVISIBLE: f64 = 1.0 / 1024.0;

/// Frames of a field, and cells of each along an axis.
const FRAMES: usize = 24;
const CELLS: usize = 48;

impl Replay {
    /// The replay of an answer to a problem that was asked with these options.
    #[must_use]
    pub fn new<F: AsRef<BoundedPath>>(problem: &MotionProblem, options: &Options, answer: &Answer<F>) -> Self {
        let mut phases = Phases(Vec::new());
        phases.of_trace(problem, options, answer);
        match &answer.outcome {
            Outcome::Found(found) => phases.of_path(problem, options, answer, found.as_ref()),
            Outcome::Infeasible(proof) => phases.add(
                proof.stuck().len(),
                format!(
                    "{} of colliding configurations separate start and goal: there is no path",
                    boxes(proof.stuck().len())
                ),
                Shows::Proof,
            ),
            Outcome::Unknown(_) => {}
        }
        Self { phases: phases.0 }
    }
}

fn boxes(count: usize) -> String {
    if count == 1 { "1 box".into() } else { format!("{count} boxes") }
}

struct Phases(Vec<Phase>);

impl Phases {
    /// Another phase, unless nothing happens in it.
    fn add(&mut self, events: usize, caption: impl Into<String>, shows: Shows) {
        if events > 0 {
            self.0.push(Phase { caption: caption.into(), shows, events });
        }
    }

    /// What the planner saw.
    fn of_trace<F>(&mut self, problem: &MotionProblem, options: &Options, answer: &Answer<F>) {
        let graph = match answer.run.size {
            Size::Graph { nodes, .. } => nodes,
            _ => 0,
        };
        match &*answer.drawn() {
            Trace::Roadmap { edges, whole } => {
                let caption = if *whole {
                    "The reduced visibility graph: corner by corner, straight ways to what it sees"
                } else {
                    "The reduced visibility graph, as far as the search looked at it"
                };
                self.add(edges.len(), caption, Shows::Edges);
            }
            Trace::Roads { edges, expanded, kind } => {
                if let GraphKind::Samples = kind {
                    let caption = format!("Random free configurations: {}", counted(graph, "node"));
                    self.add(edges.len(), caption, Shows::Nodes);
                    self.add(
                        edges.len(),
                        "Each is joined to its neighbours by straight motions, if they are free",
                        Shows::Edges,
                    );
                } else {
                    let name = match kind.visibility() {
                        Some(graph) => format!("{} visibility graph", graph.name()),
                        None => "roadmap".to_owned(),
                    };
                    self.add(edges.len(), format!("The {name}: {}", counted(edges.len(), "edge")), Shows::Edges);
                }
                self.add(expanded.len(), "The search: where it came, one after the other", Shows::Expanded);
            }
            Trace::Channel { kind, cells, channel, expanded, .. } => {
                let caption = match kind {
                    CellKind::Triangles => format!("Free space in {}", counted(cells.len(), "triangle")),
                    CellKind::Trapezoids => {
                        format!("A line sweeps free space and leaves {}", counted(cells.len(), "trapezoid"))
                    }
                };
                let swept = *kind == CellKind::Trapezoids;
                self.add(cells.len(), caption, Shows::Cells { swept });
                self.add(expanded.len(), "The search from cell to cell", Shows::Expanded);
                let caption = format!("A channel of {} from start to goal", counted(channel.len(), "cell"));
                self.add(channel.len(), caption, Shows::Channel);
            }
            Trace::Slices { free } => {
                self.of_slabs(problem);
                let caption = format!(
                    "The shortest way passes {}, where what is free is known exactly",
                    counted(free.len(), "slice")
                );
                self.add(free.len(), caption, Shows::Slices);
            }
            Trace::Boxes { free, stuck, mixed } => {
                let count = free.len() + stuck.len() + mixed.len();
                let caption = format!("{}, coarse to fine: free ones green, undecided ones yellow", boxes(count));
                self.add(count, caption, Shows::Boxes);
            }
            Trace::Wavefront { labels, expanded, forward, .. } => {
                let reached = labels.iter().filter(|&&label| label != u32::MAX).count();
                if expanded.is_empty() {
                    self.add(
                        reached,
                        format!("A wave from the goal comes to {}", counted(reached, "cell")),
                        Shows::Wave,
                    );
                } else {
                    let begins = if *forward { "start" } else { "goal" };
                    let caption =
                        format!("The search begins at the {begins} and expands {}", counted(expanded.len(), "cell"));
                    self.add(expanded.len(), caption, Shows::Wave);
                }
            }
            trace @ (Trace::Field { .. } | Trace::Harmonic { .. } | Trace::Potential { .. }) => {
                self.of_sweeps(problem, options, answer);
                let cells = match trace {
                    Trace::Potential { heights, .. } => heights.iter().filter(|height| height.is_finite()).count(),
                    _ => trace.logarithms().map_or(0, |(_, ln)| ln.iter().filter(|ln| ln.is_finite()).count()),
                };
                self.add(cells, "Equipotentials of the field, from the goal outwards", Shows::Levels);
            }
        }
    }

    /// The slabs that say whether there is a path.
    fn of_slabs(&mut self, problem: &MotionProblem) {
        let scene = problem.scene();
        if scene.pairs().len() > PAIRS {
            return;
        }
        let clearance = scene.workspace().clearance;
        let all = slab_boxes(scene, problem.start(), problem.goals(), clearance, SLABS);
        let extents = scene.arm().topology().ranges.map(|axis| axis.extent());
        let sides = |(cell, _): &(cplan_core::check::Cell, Occupancy)| {
            [0, 1].map(|k| (cell.upper[k] - cell.lower[k]) / extents[k])
        };
        let mut seen: Vec<_> = all.into_iter().filter(|one| sides(one).iter().all(|&side| side >= INVISIBLE)).collect();
        // Slabs of a level are equally wide; stable, so that those of one level go from left to right.
        seen.sort_by_key(|one| (1.0 / sides(one)[0]).log2().round() as i64);
        let mut found = SlabBoxes::default();
        for (cell, occupancy) in &seen {
            let kind = match occupancy {
                Occupancy::Free => &mut found.free,
                Occupancy::Stuck => &mut found.stuck,
                Occupancy::Mixed => &mut found.mixed,
            };
            kind.push([cell.lower.into(), cell.upper.into()]);
        }
        let caption = "Slabs of joint 1, halved where it matters: free green, undecided yellow";
        self.add(seen.len(), caption, Shows::Slabs(found));
    }

    /// The field after some of its sweeps, where it is relaxed on the CPU.
    fn of_sweeps<F>(&mut self, problem: &MotionProblem, options: &Options, answer: &Answer<F>) {
        let Some(found) = sweeps(problem, options, answer) else { return };
        let caption = format!("The field, sweep by sweep: {} in all", found.frames.last().map_or(0, |frame| frame.0));
        self.add(found.frames.len(), caption, Shows::Sweeps(found));
    }

    /// The path as it was found, and as it is.
    fn of_path<F>(&mut self, problem: &MotionProblem, options: &Options, answer: &Answer<F>, found: &BoundedPath) {
        let path = found.path();
        let own = (answer.path_kind == PathKind::Taut && answer.method.has_own_path())
            .then(|| own_path(problem, options, answer));
        let own = own.flatten().filter(|own| own.waypoints() != path.waypoints());
        let caption = match (&own, found.bound, answer.path_kind) {
            (Some(_), ..) => "The path, pulled taut and certified".to_owned(),
            (None, Some(bound), _) => {
                format!("The path: certified, at most {} longer than the shortest", percent(bound.gap()))
            }
            (None, None, _) => "The path, certified".to_owned(),
        };
        if let Some(own) = own {
            self.add(own.waypoints().len(), "The path as the planner found it", Shows::Own(own));
        }
        self.add(path.waypoints().len(), caption, Shows::Path);
    }
}

/// The path before it is pulled taut: the planner is asked for its own, in the space of the answer.
fn own_path<F>(problem: &MotionProblem, options: &Options, answer: &Answer<F>) -> Option<Path> {
    let levels = answer.history.len() + 1;
    let planner = options.planner.with_path(PathKind::Own);
    let boxes = if let Space::Scene = answer.space { options.boxes } else { options.boxes.min(FIRST_BOXES) };
    match solve(problem, &Options { planner, levels, boxes, ..*options }, &mut |_| ()).run.outcome {
        Proposal::Found(path) => Some(path),
        Proposal::NoPath | Proposal::GaveUp(_) => None,
    }
}

/// Relaxes the field once more, watching it.
fn sweeps<F>(problem: &MotionProblem, options: &Options, answer: &Answer<F>) -> Option<Sweeps> {
    let planner = options.planner.field()?;
    let FieldChoice::Relaxed { equation, relaxation, measure, tolerance, max_sweeps, on: Device::Cpu, stencil } =
        planner.field
    else {
        return None;
    };
    let (Space::Grid(grid), Size::Grid { sweeps: total, .. }) = (&answer.space, answer.run.size) else { return None };
    let query = Ends::new(problem, &**grid).query;
    let domain = field_domain(grid, &query, planner.limits).ok()?.with_beta(stencil.beta(grid));
    let equation = equation.on(&ZonedGrid::new((**grid).clone(), problem.scene()), stencil).ok()?;
    let stopping = Stopping { measure, below: tolerance, max_sweeps };
    let shape = domain.cells();
    let step = shape.map(|n| n.div_ceil(CELLS).max(1));
    let cells = [0, 1].map(|k| shape[k].div_ceil(step[k]));
    let sampled = |values: &[f64]| {
        let at = (0..cells[0]).flat_map(|i| (0..cells[1]).map(move |j| i * step[0] * shape[1] + j * step[1]));
        at.map(|cell| values[cell].max(0.0).ln()).collect::<Vec<f64>>()
    };
    // The first sweeps change the most: frames lie ever farther apart.
    let wanted = |k: usize| (total as f64).powf(k as f64 / (FRAMES - 1) as f64).round() as usize;
    let (mut frames, mut earlier, mut seen) = (Vec::new(), 0, 0);
    let watch = &mut |watched: cplan_fields::Watched| {
        if watched.sweep == 0 {
            earlier = seen;
            return;
        }
        seen = earlier + watched.sweep;
        if frames.len() < FRAMES && (seen >= wanted(frames.len()) || seen == total) {
            frames.push((seen, sampled(watched.values)));
        }
    };
    let field = relax_watched(&domain, &equation, &relaxation, &stopping, domain.start(), watch).ok()?;
    if let Some(Note::Continued { .. }) = answer.run.note {
        let finely = Stopping { measure: Measure::GreatestRelativeChange, below: RELATIVE_TOLERANCE, ..stopping };
        relax_watched(&domain, &equation, &relaxation, &finely, field.values, watch).ok()?;
    }
    Some(Sweeps { cells, frames })
}
