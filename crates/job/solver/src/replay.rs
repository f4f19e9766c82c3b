//! Replays of a planner's run in phases, for animated pages and pictures.
//!
//! Most of the data is in the run's [`Trace`], in chronological order, and a phase states which part of it to show. Runs do not
//! keep the final boxes of slabs, the values of a field between sweeps, and the path before it was pulled taut. The replay
//! computes these again, so plans without a replay have no extra cost.

use super::admission::Ends;
use super::bound::{Bound, motions};
use super::decision::decide;
use super::ladder::FIRST_BOXES;
use super::{Answer, BoundedPath, Options, Space, solve};
use cplan_fields::{Device, FieldChoice, Measure, RELATIVE_TOLERANCE, Stopping, field_domain, relax_watched};
use cplan_model::space::{Configuration, Path};
use cplan_model::{MotionProblem, Outcome};
use cplan_planners::cspace::ZonedGrid;
use cplan_planners::planner::{CellKind, GraphKind, Note, PathKind, Proposal, Size, Trace};
use cplan_proofs::{BoundRound, Occupancy, bound_rounds, slab_boxes};
use cplan_text::{counted, fixed, percent, round_down};

/// The replay of a planner's run.
#[derive(Debug, Clone, PartialEq)]
pub struct Replay {
    /// Phases in order. A phase remains visible after its end, except boxes and values that are computed only for the replay.
    pub phases: Vec<Phase>,
}

/// A part of a replay.
#[derive(Debug, Clone, PartialEq)]
pub struct Phase {
    /// Description of the phase, in one line.
    pub caption: String,
    /// The content of the phase.
    pub shows: Shows,
    /// Number of events, at least one.
    pub events: usize,
    /// Length of the certified path that is known at the end of the phase. `None` if there is no path, or if its length has not
    /// changed.
    pub length: Option<f64>,
}

/// The content of a phase, shown event by event. A variant without a field stands for a part of the drawn [`Trace`], in the
/// trace's order.
#[derive(Debug, Clone, PartialEq)]
pub enum Shows {
    /// Configurations, in the order in which edges reach them.
    Nodes,
    /// Edges of a graph.
    Edges,
    /// Cells of a decomposition.
    Cells {
        /// True if a line sweeps over the cells, from the left.
        swept: bool,
    },
    /// The cells of the channel.
    Channel,
    /// The nodes that a search of a graph expanded.
    Expanded,
    /// The first certified path, from which the search for a shorter one begins.
    First(Path),
    /// The rounds in which the lower bound on the length rises.
    Bound {
        /// The rounds, in their order.
        rounds: Vec<BoundRound>,
        /// Unit of the lengths.
        unit: &'static str,
    },
    /// Slices that the path crosses.
    Slices,
    /// Cells of a grid, in the order of their labels or of their expansion.
    Wave,
    /// Equipotentials from the goal outwards.
    Levels,
    /// The boxes of the trace, coarse to fine.
    Boxes,
    /// Boxes of slabs, coarse to fine.
    Slabs(SlabBoxes),
    /// Values of a field between its sweeps.
    Sweeps(Sweeps),
    /// The answer's path before it was pulled taut.
    Own(Path),
    /// The answer's path.
    Path,
    /// The boxes of the proof.
    Proof,
}

/// Boxes that cover the configuration space, the largest first. Each has its lower and its upper corner.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SlabBoxes {
    /// Boxes that are free throughout.
    pub free: Vec<[Configuration; 2]>,
    /// Boxes that collide throughout.
    pub stuck: Vec<[Configuration; 2]>,
    /// Boxes that are undecided.
    pub mixed: Vec<[Configuration; 2]>,
}

/// A field after some of its sweeps, at some cells of the grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweeps {
    /// Number of cells of each frame along the two axes.
    pub cells: [usize; 2],
    /// For each frame, the number of sweeps so far, and the natural logarithms of the values; minus infinity if a value is still
    /// zero.
    pub frames: Vec<(usize, Vec<f64>)>,
}

/// Largest number of slabs in a replay. In scenes with few enough pairs of shapes, they take some tens of milliseconds.
const MAX_REPLAY_SLABS: usize = 2_000;
const MAX_REPLAY_PAIRS: usize = 4096;

/// Smallest width of a box in a replay, as a share of the joint's range. Narrower boxes would be thinner than a pixel.
const MIN_BOX_WIDTH: f64 = 1.0 / 1024.0;

/// Largest number of rounds of the bound in a replay.
const MAX_ROUNDS: usize = 12;

/// Number of frames in the replay of a field.
const FIELD_FRAMES: usize = 24;
/// Number of cells of each frame along an axis.
const FRAME_CELLS: usize = 48;

impl Replay {
    /// Computes the replay of an answer to a problem with these options.
    pub fn new<F: AsRef<BoundedPath>>(problem: &MotionProblem, options: &Options, answer: &Answer<F>) -> Self {
        let mut phases = Phases(Vec::new());
        let bound = answer.outcome.found().and_then(|found| stated_bound(problem, found.as_ref()));
        phases.of_trace(problem, options, answer, bound);
        match &answer.outcome {
            Outcome::Found(found) => phases.of_path(problem, options, answer, found.as_ref()),
            Outcome::Infeasible(proof) => phases.add(
                proof.collision_boxes().len(),
                format!(
                    "{} of colliding configurations {} start and goal: there is no path",
                    boxes(proof.collision_boxes().len()),
                    if proof.collision_boxes().len() == 1 { "separates" } else { "separate" }
                ),
                Shows::Proof,
            ),
            Outcome::Unknown(_) => {}
        }
        Self { phases: phases.0 }
    }
}

/// Returns the bound on the length of a path; `None` among moving obstacles, which the bound ignores.
fn stated_bound(problem: &MotionProblem, found: &BoundedPath) -> Option<Bound> {
    found.bound.filter(|_| problem.scene().loose_obstacles().is_empty())
}

fn boxes(count: usize) -> String {
    if count == 1 { "1 box".into() } else { format!("{count} boxes") }
}

struct Phases(Vec<Phase>);

impl Phases {
    /// Adds a phase, unless it has no events.
    fn add(&mut self, events: usize, caption: impl Into<String>, shows: Shows) {
        if events > 0 {
            self.0.push(Phase { caption: caption.into(), shows, events, length: None });
        }
    }

    /// Adds the phases that show the planner's trace.
    fn of_trace<F>(&mut self, problem: &MotionProblem, options: &Options, answer: &Answer<F>, bound: Option<Bound>) {
        let graph = match answer.run.size {
            Size::Graph { nodes, .. } => nodes,
            _ => 0,
        };
        match &*answer.drawn() {
            Trace::Roadmap { edges, whole } => {
                let caption = if *whole {
                    "The reduced visibility graph: straight motions between corners that see each other"
                } else {
                    "The part of the reduced visibility graph that the search examined"
                };
                self.add(edges.len(), caption, Shows::Edges);
            }
            Trace::Roads { edges, expanded, kind } => {
                if let GraphKind::Samples = kind {
                    let caption = format!("Random free configurations: {}", counted(graph, "node"));
                    self.add(edges.len(), caption, Shows::Nodes);
                    self.add(
                        edges.len(),
                        "Straight motions join each configuration to its neighbours, if they are free",
                        Shows::Edges,
                    );
                } else {
                    let name = match kind.visibility() {
                        Some(graph) => format!("{} visibility graph", graph.name()),
                        None => "roadmap".to_owned(),
                    };
                    self.add(edges.len(), format!("The {name}: {}", counted(edges.len(), "edge")), Shows::Edges);
                }
                self.add(
                    expanded.len(),
                    "The search: configurations in the order in which it reaches them",
                    Shows::Expanded,
                );
            }
            Trace::Channel { kind, cells, channel, expanded, .. } => {
                let caption = match kind {
                    CellKind::Triangles => format!("Free space in {}", counted(cells.len(), "triangle")),
                    CellKind::Trapezoids => {
                        format!("A sweep line divides free space into {}", counted(cells.len(), "trapezoid"))
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
                bound.iter().for_each(|bound| self.of_bound(problem, options, bound));
                let caption = format!(
                    "The path is pulled taut through {}, in which free space is known exactly",
                    counted(free.len(), "slice")
                );
                self.add(free.len(), caption, Shows::Slices);
            }
            Trace::Boxes { free, stuck, mixed } => {
                let count = free.len() + stuck.len() + mixed.len();
                let caption = format!("{}, coarse to fine: free, colliding and undecided", boxes(count));
                self.add(count, caption, Shows::Boxes);
            }
            Trace::Wavefront { labels, expanded, forward, .. } => {
                let reached = labels.iter().filter(|&&label| label != u32::MAX).count();
                if expanded.is_empty() {
                    self.add(
                        reached,
                        format!("A wave from the goal reaches {}", counted(reached, "cell")),
                        Shows::Wave,
                    );
                } else {
                    let begins = if *forward { "start" } else { "goal" };
                    let caption =
                        format!("The search begins at the {begins} and expands {}", counted(expanded.len(), "cell"));
                    self.add(expanded.len(), caption, Shows::Wave);
                }
            }
            Trace::Field { values, .. } => {
                self.of_sweeps(problem, options, answer);
                let cells = values.iter().filter(|value| value.is_finite()).count();
                self.add(cells, "Equipotentials of the field, from the goal outwards", Shows::Levels);
            }
        }
    }

    /// Adds the phase with the slabs that decide whether a path exists.
    fn of_slabs(&mut self, problem: &MotionProblem) {
        let scene = problem.scene();
        if scene.pairs().len() > MAX_REPLAY_PAIRS {
            return;
        }
        let clearance = scene.workspace().clearance;
        let all = slab_boxes(scene, problem.start(), problem.goals(), clearance, MAX_REPLAY_SLABS);
        let extents = scene.arm().topology().ranges.map(|axis| axis.extent());
        let sides =
            |(cell, _): &(cplan_judge::Cell, Occupancy)| [0, 1].map(|k| (cell.upper[k] - cell.lower[k]) / extents[k]);
        let mut seen: Vec<_> =
            all.into_iter().filter(|one| sides(one).iter().all(|&side| side >= MIN_BOX_WIDTH)).collect();
        // Slabs of one level have the same width. The sort is stable, so they stay in order from left to right.
        seen.sort_by_key(|one| (1.0 / sides(one)[0]).log2().round() as i64);
        let mut found = SlabBoxes::default();
        for (cell, occupancy) in &seen {
            let kind = match occupancy {
                Occupancy::Free => &mut found.free,
                Occupancy::Colliding => &mut found.stuck,
                Occupancy::Undecided => &mut found.mixed,
            };
            kind.push([cell.lower.into(), cell.upper.into()]);
        }
        let caption = "Strips of values of joint 1 are halved until their free parts connect start and goal";
        self.add(seen.len(), caption, Shows::Slabs(found));
    }

    /// Adds the phases that enclose the optimum: the first path, then the rising lower bound.
    fn of_bound(&mut self, problem: &MotionProblem, options: &Options, bound: &Bound) {
        let unit = problem.scene().arm().unit_in(bound.metric);
        if let Outcome::Found(first) = decide(problem, options.boxes.min(FIRST_BOXES)) {
            let (path, length) = (first.path(), bound.metric.length(first.path()));
            let caption = format!(
                "A first path through the free parts, of length {} {unit}: certified, but not the shortest",
                fixed(length, 4)
            );
            self.add(path.waypoints().len(), caption, Shows::First(path.clone()));
            self.0.iter_mut().last().into_iter().for_each(|phase| phase.length = Some(length));
        }
        let mut rounds = bound_rounds(&motions(problem, bound.metric), bound.upper, bound.gap());
        if rounds.len() > MAX_ROUNDS {
            // The first rounds improve the bound the most.
            let last = rounds.pop();
            rounds.truncate(MAX_ROUNDS - 1);
            rounds.extend(last);
        }
        // This search began with other slices, so it may prove slightly more than the stated bound.
        rounds.iter_mut().for_each(|round| round.lower = round.lower.min(bound.lower));
        rounds.iter_mut().last().into_iter().for_each(|last| last.lower = bound.lower);
        let caption = format!(
            "No path is shorter than the line around known walls; more strips raise it to {} {unit}",
            round_down(bound.lower, 4)
        );
        self.add(rounds.len(), caption, Shows::Bound { rounds, unit });
    }

    /// Adds the phase with the field after some of its sweeps, if the field is relaxed on the CPU.
    fn of_sweeps<F>(&mut self, problem: &MotionProblem, options: &Options, answer: &Answer<F>) {
        let Some(found) = sweeps(problem, options, answer) else { return };
        let caption = format!("The field, sweep by sweep: {} in all", found.frames.last().map_or(0, |frame| frame.0));
        self.add(found.frames.len(), caption, Shows::Sweeps(found));
    }

    /// Adds the phases with the path as the planner found it and with the final path.
    fn of_path<F>(&mut self, problem: &MotionProblem, options: &Options, answer: &Answer<F>, found: &BoundedPath) {
        let path = found.path();
        let own = (answer.path_kind == PathKind::Taut && answer.method.has_own_path())
            .then(|| own_path(problem, options, answer));
        let own = own.flatten().filter(|own| own.waypoints() != path.waypoints());
        let bound = stated_bound(problem, found);
        let caption = match (&own, bound, answer.path_kind) {
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
        if let (Some(phase), Some(bound)) = (self.0.last_mut(), bound) {
            phase.length = Some(bound.upper);
        }
    }
}

/// Returns the path before it is pulled taut, by planning again with the planner's own kind of path in the space of the answer.
fn own_path<F>(problem: &MotionProblem, options: &Options, answer: &Answer<F>) -> Option<Path> {
    let levels = answer.history.len() + 1;
    let planner = options.planner.with_path(PathKind::Own);
    let boxes = if let Space::Scene = answer.space { options.boxes } else { options.boxes.min(FIRST_BOXES) };
    match solve(problem, &Options { planner, levels, boxes, ..*options }, &mut |_| ()).run.outcome {
        Proposal::Found(path) => Some(path),
        Proposal::NoPath | Proposal::GaveUp(_) => None,
    }
}

/// Relaxes the field once more, and samples it between sweeps.
fn sweeps<F>(problem: &MotionProblem, options: &Options, answer: &Answer<F>) -> Option<Sweeps> {
    let planner = options.planner.field()?;
    let FieldChoice::Relaxed {
        equation,
        relaxation,
        measure,
        tolerance,
        max_sweeps,
        on: Device::Cpu,
        stencil,
        initial,
    } = planner.field
    else {
        return None;
    };
    let (Space::Grid(grid), Size::Grid { sweeps: total, .. }) = (&answer.space, answer.run.size) else { return None };
    let query = Ends::new(problem, &**grid).query;
    let domain = field_domain(grid, &query, planner.limits).ok()?.with_beta(stencil.beta(grid)).with_initial(initial);
    let equation = equation.on(&ZonedGrid::new((**grid).clone(), problem.scene()), stencil).ok()?;
    let stopping = Stopping { measure, below: tolerance, max_sweeps };
    let shape = domain.cells();
    let step = shape.map(|n| n.div_ceil(FRAME_CELLS).max(1));
    let cells = [0, 1].map(|k| shape[k].div_ceil(step[k]));
    let sampled = |values: &[f64]| {
        let at = (0..cells[0]).flat_map(|i| (0..cells[1]).map(move |j| i * step[0] * shape[1] + j * step[1]));
        at.map(|cell| values[cell].max(0.0).ln()).collect::<Vec<f64>>()
    };
    // The first sweeps change the most, so frames become rarer later.
    let wanted = |k: usize| (total as f64).powf(k as f64 / (FIELD_FRAMES - 1) as f64).round() as usize;
    let (mut frames, mut earlier, mut seen) = (Vec::new(), 0, 0);
    let watch = &mut |watched: cplan_fields::SweepSnapshot| {
        if watched.sweep == 0 {
            earlier = seen;
            return;
        }
        seen = earlier + watched.sweep;
        if frames.len() < FIELD_FRAMES && (seen >= wanted(frames.len()) || seen == total) {
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
