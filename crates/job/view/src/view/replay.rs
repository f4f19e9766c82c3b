//! The replay: animated phases of the planner's search.

use super::content::View;
use super::numbers::{Chain, RoundingSteps};
use super::phase::{MotionReplayView, PhaseView, RoundView, ShowsView};
use super::trace::TraceView;
use super::waves::{self, Waves};
use super::world::WorldView;
use cplan_legs::TaskReplay;
use cplan_model::space::{Configuration, Topology};
use cplan_solver::{Phase, Replay, Shows, SlabBoxes, Sweeps};

/// Shortest and longest duration of a phase, in seconds. Between them, the duration is `SECONDS_PER_ROOT` times the square root
/// of the number of events.
const PHASE_SECONDS: [f64; 2] = [1.2, 2.2];
const SECONDS_PER_ROOT: f64 = 0.1;

/// Duration, in seconds, of a phase in which a search proves a bound: usually, and while the bound rises.
const PROOF_SECONDS: [f64; 2] = [4.0, 6.0];

/// Longest duration of all phases together, in seconds. Few people would watch for longer.
const MAX_REPLAY_SECONDS: f64 = 6.0;

/// Largest size of all replays of a task on a page, in bytes. Motions beyond this size have no replay.
const MAX_REPLAY_BYTES: usize = 200_000;

/// Largest number of slab boxes in all motions of a task together.
const MAX_BOXES: usize = 5_000;

/// Widths of boxes as fractions of a joint's range. If there are more than `MAX_BOXES` boxes, the replay omits those narrower
/// than the first of these widths that suffices.
const BOX_WIDTH_LIMITS: [f64; 4] = [1.0 / 512.0, 1.0 / 256.0, 1.0 / 128.0, 1.0 / 64.0];

impl PhaseView {
    /// Returns all phases of a replay.
    pub fn all(replay: &Replay, topology: &Topology, trace: Option<&TraceView>, grain: RoundingSteps) -> Vec<Self> {
        let seconds =
            |phase: &Phase| (SECONDS_PER_ROOT * (phase.events as f64).sqrt()).clamp(PHASE_SECONDS[0], PHASE_SECONDS[1]);
        let time_scale = (MAX_REPLAY_SECONDS / replay.phases.iter().map(seconds).sum::<f64>()).min(1.0);
        // The captions of a proof's phases are whole sentences to read.
        let is_proof = replay.phases.iter().any(|phase| matches!(phase.shows, Shows::Bound { .. }));
        let read = |phase: &Phase| match phase.shows {
            Shows::Bound { .. } => PROOF_SECONDS[1],
            _ => PROOF_SECONDS[0],
        };
        let rounded = |seconds: f64| (seconds * 100.0).round() / 100.0;
        let lasts = |phase| if is_proof { read(phase) } else { rounded(time_scale * seconds(phase)) };
        let replayed = |phase| Self::new(phase, lasts(phase), topology, trace, grain);
        replay.phases.iter().map(replayed).collect()
    }

    fn new(phase: &Phase, seconds: f64, topology: &Topology, trace: Option<&TraceView>, grain: RoundingSteps) -> Self {
        let corners = |boxes: &[[Configuration; 2]]| grain.configurations(boxes.iter().flatten());
        let shows = match &phase.shows {
            Shows::Nodes => ShowsView::Nodes,
            Shows::Edges => ShowsView::Edges,
            Shows::Cells { swept } => ShowsView::Cells { swept: *swept },
            Shows::Channel => ShowsView::Channel,
            Shows::Expanded => ShowsView::Expanded,
            Shows::First(path) => ShowsView::First { points: grain.configurations(path.waypoints()) },
            Shows::Bound { rounds, unit } => ShowsView::Bound {
                unit,
                rounds: rounds
                    .iter()
                    .map(|round| RoundView {
                        lower: round.lower,
                        points: grain.configurations(&round.path),
                        slices: round
                            .slices
                            .iter()
                            .map(|&q1| grain.configuration(Configuration::new(q1, 0.0))[0])
                            .collect(),
                    })
                    .collect(),
            },
            Shows::Slices => ShowsView::Slices,
            Shows::Wave => ShowsView::Wave,
            Shows::Levels => ShowsView::Levels,
            Shows::Boxes => {
                let order = match trace {
                    Some(TraceView::Boxes { free, stuck, mixed, .. }) => {
                        coarse_to_fine([free, stuck, mixed], topology, [1.0; 2])
                    }
                    _ => Vec::new(),
                };
                ShowsView::Boxes { order }
            }
            Shows::Slabs(SlabBoxes { free, stuck, mixed }) => {
                let [free, stuck, mixed] = [free, stuck, mixed].map(|boxes| corners(boxes));
                // The size counts only the slab's width, so all boxes of a slab appear together.
                let order = coarse_to_fine([&free, &stuck, &mixed], topology, [1.0, 0.0]);
                ShowsView::Slabs { free, stuck, mixed, order }
            }
            Shows::Sweeps(sweeps) => ShowsView::Sweeps { frames: frames(sweeps) },
            Shows::Own(path) => ShowsView::Own { points: grain.configurations(path.waypoints()) },
            Shows::Path => ShowsView::Path,
            Shows::Proof => ShowsView::Proof,
        };
        Self { caption: phase.caption.clone(), events: phase.events, seconds, length: phase.length, shows }
    }
}

/// Returns the replay without its narrowest slab boxes. It has at most `most` boxes, if one of the widths in [`BOX_WIDTH_LIMITS`]
/// suffices.
fn with_fewer_boxes(replay: &Replay, topology: &Topology, most: usize) -> Replay {
    let extents = topology.ranges.map(|axis| axis.extent());
    let mut replay = replay.clone();
    for phase in &mut replay.phases {
        let Shows::Slabs(SlabBoxes { free, stuck, mixed }) = &mut phase.shows else { continue };
        for narrow in BOX_WIDTH_LIMITS {
            if free.len() + stuck.len() + mixed.len() <= most {
                break;
            }
            let is_wide =
                |[lower, upper]: &[Configuration; 2]| (0..2).all(|k| upper[k] - lower[k] >= narrow * extents[k]);
            for boxes in [&mut *free, &mut *stuck, &mut *mixed] {
                boxes.retain(is_wide);
            }
        }
    }
    replay
}

/// Returns the indices of the boxes in the order of display: from large to small, and boxes of one size from left to right. The
/// size is the number of halvings of the sides, weighted by axis.
fn coarse_to_fine(kinds: [&Chain; 3], topology: &Topology, weights: [f64; 2]) -> Vec<usize> {
    let extents = topology.ranges.map(|axis| axis.extent());
    let level = |[lower, upper]: [Configuration; 2]| {
        let halved = |k: usize| weights[k] * (extents[k] / (upper[k] - lower[k]).max(f64::MIN_POSITIVE)).log2();
        (halved(0) + halved(1)).round() as i64
    };
    let boxes: Vec<[Configuration; 2]> = kinds.iter().flat_map(|chain| chain.pairs()).collect();
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    let key = |&at: &usize| (level(boxes[at]), boxes[at][0]);
    order.sort_by(|a, b| {
        let ((one, p), (other, q)) = (key(a), key(b));
        one.cmp(&other).then(p[0].total_cmp(&q[0])).then(p[1].total_cmp(&q[1]))
    });
    order
}

/// Converts values to levels, which divide the range between the least and the greatest value of the last frame.
fn frames(sweeps: &Sweeps) -> Vec<(usize, Waves)> {
    let finite = |values: &[f64]| values.iter().copied().filter(|value| value.is_finite()).fold(0.0, f64::min);
    let least = sweeps.frames.last().map_or(0.0, |(_, values)| finite(values)).min(-f64::MIN_POSITIVE);
    let part = |value: &f64| value.is_finite().then(|| (value / least).clamp(0.0, 1.0));
    let levels = |values: &[f64]| values.iter().map(|value| waves::letter(part(value))).collect();
    sweeps.frames.iter().map(|(sweep, values)| (*sweep, Waves::of_levels(sweeps.cells, levels(values)))).collect()
}

impl View {
    /// Adds the phases of the planner's search for each motion of a task, as long as their size is allowed.
    #[must_use]
    pub fn with_task_replay(mut self, replay: &TaskReplay) -> Self {
        let (grain, topology) = (RoundingSteps::of(&self.arm), self.arm.topology());
        let most = MAX_BOXES / replay.motions.len().max(1);
        let mut left = MAX_REPLAY_BYTES;
        for replayed in &replay.motions {
            let trace = replayed.trace.as_ref().and_then(|trace| TraceView::new(trace, &topology, grain));
            let phases =
                PhaseView::all(&with_fewer_boxes(&replayed.replay, &topology, most), &topology, trace.as_ref(), grain);
            let scale = trace.as_ref().and_then(TraceView::scale);
            let view = MotionReplayView { trace, scale, phases };
            // Numbers and strings can always be serialised.
            let bytes = serde_json::to_string(&view).map_or(usize::MAX, |json| json.len());
            let Some(room) = left.checked_sub(bytes) else { break };
            left = room;
            self.replays.push(view);
        }
        for (motion, &replayed) in self.motions.iter_mut().zip(&replay.legs) {
            motion.replay = Some(replayed).filter(|&replayed| replayed < self.replays.len());
        }
        self
    }

    /// Adds the planner's replay.
    #[must_use]
    pub fn with_replay(mut self, replay: &Replay) -> Self {
        let (grain, trace) = (RoundingSteps::of(&self.arm), self.first_world().trace.as_ref());
        self.replay = PhaseView::all(replay, &self.arm.topology(), trace, grain);
        self
    }

    /// Returns the view at a moment of the replay: the fraction `part` of the phase has been shown.
    pub fn at_replay_moment(&self, phase: usize, part: f64) -> Self {
        let mut view = self.clone();
        let now = &self.replay[phase];
        let shown = |is: fn(&ShowsView) -> bool| match self.replay.iter().position(|phase| is(&phase.shows)) {
            Some(at) if at == phase => part,
            Some(at) if at > phase => 0.0,
            _ => 1.0,
        };
        // The number of lines in the title does not change, so nothing moves when the motion begins.
        view.title.rotate_right(1);
        view.title[0].clone_from(&now.caption);
        view.status.clear();
        let world = &mut view.worlds[0];
        world.proof = shown_items(&world.proof, 2, shown(|shows| *shows == ShowsView::Proof));
        restrict(world, now, part, &shown);
        view.paths = match &now.shows {
            ShowsView::Own { points } => vec![self.paths[0].grey_line(beginning_of(points, part))],
            ShowsView::First { points } => vec![self.paths[0].first_line(beginning_of(points, part))],
            ShowsView::Bound { rounds, .. } => {
                // In the first half of a round, its line grows.
                let shown = part * rounds.len() as f64;
                let number = (shown as usize).min(rounds.len() - 1);
                let points = &rounds[number].points;
                let grown = beginning_of_any(points, (2.0 * (shown - number as f64)).min(1.0));
                grown.map(|points| self.paths[0].bound_line(points)).into_iter().collect()
            }
            ShowsView::Path => {
                let own = self.replay.iter().find_map(|phase| match &phase.shows {
                    ShowsView::Own { points } => Some(self.paths[0].grey_line(points.clone())),
                    _ => None,
                });
                let path = self.paths[0].drawn_through(beginning_of(&self.paths[0].points, part));
                own.into_iter().chain([path]).collect()
            }
            _ => Vec::new(),
        };
        for panel in &mut view.still.panels {
            panel.paths = (0..view.paths.len()).collect();
        }
        view
    }
}

/// Reduces the trace of a world to what has been shown so far.
fn restrict(world: &mut WorldView, now: &PhaseView, part: f64, shown: &dyn Fn(fn(&ShowsView) -> bool) -> f64) {
    let edges = || shown(|shows| *shows == ShowsView::Edges);
    let expanded_part = || shown(|shows| *shows == ShowsView::Expanded);
    let Some(trace) = &mut world.trace else { return };
    match (&now.shows, trace) {
        (ShowsView::Slabs { free, stuck, mixed, order }, trace) => *trace = cut([free, stuck, mixed], order, part),
        (ShowsView::Sweeps { frames }, TraceView::Field { levels, values, .. }) => {
            levels.clear();
            *values = frames
                .get((part * frames.len() as f64).ceil() as usize - usize::from(part > 0.0))
                .map(|frame| frame.1.clone());
        }
        (_, TraceView::Roadmap { edges: all, .. }) => *all = shown_items(all, 2, edges()),
        (_, TraceView::Slices { free }) => *free = shown_items(free, 2, shown(|shows| *shows == ShowsView::Slices)),
        (_, TraceView::Channel { cells, channel, centers, middles, expanded, sweep }) => {
            // Later cells keep their places in the list, but have no corners yet.
            let count = count(cells.len(), shown(|shows| matches!(shows, ShowsView::Cells { .. })));
            cells[count..].iter_mut().for_each(|cell| cell.0.clear());
            *sweep = match now.shows {
                ShowsView::Cells { swept: true } => cells[..count].last().map(least_first_value),
                _ => None,
            };
            channel.truncate(self::count(channel.len(), shown(|shows| *shows == ShowsView::Channel)));
            centers.0.truncate(channel.len());
            middles.0.truncate(channel.len().saturating_sub(1));
            *expanded = shown_items(expanded, 1, expanded_part());
        }
        (ShowsView::Nodes, TraceView::Roads { edges, expanded, .. }) => {
            *expanded = shown_items(&Chain(edges.0.chunks_exact(2).map(|ends| ends[0]).collect()), 1, part);
            edges.0.clear();
        }
        (_, TraceView::Roads { edges: all, expanded, .. }) => {
            (*all, *expanded) = (shown_items(all, 2, edges()), shown_items(expanded, 1, expanded_part()));
        }
        (ShowsView::Boxes { order }, trace @ TraceView::Boxes { .. }) => {
            if let TraceView::Boxes { free, stuck, mixed, .. } = &*trace {
                *trace = cut([free, stuck, mixed], order, part);
            }
        }
        (ShowsView::Wave, TraceView::Wavefront(waves)) => *waves = waves.up_to(part),
        (_, TraceView::Field { levels, .. }) => {
            levels.truncate(count(levels.len(), shown(|shows| *shows == ShowsView::Levels)));
        }
        (_, TraceView::Wavefront(_) | TraceView::Boxes { .. }) => {}
    }
}

/// Returns the least value of joint 1 in a cell.
fn least_first_value(cell: &Chain) -> f64 {
    cell.0.iter().map(|corner| corner[0]).fold(f64::INFINITY, f64::min)
}

/// Returns how many of `all` items are visible after the fraction `part` of the phase.
fn count(all: usize, part: f64) -> usize {
    ((all as f64 * part).round() as usize).min(all)
}

/// Returns the visible items. Each item consists of `each` configurations.
fn shown_items(chain: &Chain, each: usize, part: f64) -> Chain {
    Chain(chain.0[..each * count(chain.0.len() / each, part)].to_vec())
}

/// Returns all boxes after the fraction `part` of the replay. Boxes that are decided later count as undecided.
fn cut(kinds: [&Chain; 3], order: &[usize], part: f64) -> TraceView {
    let boxes: Vec<[Configuration; 2]> = kinds.iter().flat_map(|chain| chain.pairs()).collect();
    let ends = [kinds[0].0.len() / 2, (kinds[0].0.len() + kinds[1].0.len()) / 2];
    let mut found: [Vec<Configuration>; 4] = Default::default();
    let there = count(order.len(), part);
    for (place, &at) in order.iter().enumerate() {
        let kind = if place >= there { 3 } else { ends.iter().filter(|&&end| at >= end).count() };
        found[kind].extend(boxes[at]);
    }
    let [free, stuck, mixed, rest] = found.map(Chain);
    TraceView::Boxes { free, stuck, mixed, rest }
}

/// Does the same as [`beginning_of`]; `None` without points.
fn beginning_of_any(points: &Chain, part: f64) -> Option<Chain> {
    (!points.0.is_empty()).then(|| beginning_of(points, part))
}

/// Returns the beginning of a path: the fraction `part` of its length.
fn beginning_of(points: &Chain, part: f64) -> Chain {
    let lengths = || points.0.windows(2).map(|ends| (ends[1] - ends[0]).norm());
    let mut left = part * lengths().sum::<f64>();
    let mut there = vec![points.0[0]];
    for (ends, length) in points.0.windows(2).zip(lengths()) {
        if length > left {
            there.push(ends[0] + (ends[1] - ends[0]) * (left / length));
            break;
        }
        left -= length;
        there.push(ends[1]);
    }
    Chain(there)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chain(numbers: &[f64]) -> Chain {
        Chain(numbers.chunks(2).map(|q| Configuration::new(q[0], q[1])).collect())
    }

    #[test]
    fn a_path_grows_by_its_length() {
        let path = chain(&[0.0, 0.0, 1.0, 0.0, 1.0, 3.0]);
        assert_eq!(beginning_of(&path, 0.0), chain(&[0.0, 0.0, 0.0, 0.0]));
        assert_eq!(beginning_of(&path, 0.5), chain(&[0.0, 0.0, 1.0, 0.0, 1.0, 1.0]));
        assert_eq!(beginning_of(&path, 1.0), path);
    }

    #[test]
    fn boxes_that_are_not_there_yet_are_undecided() {
        let free = chain(&[0.0, 0.0, 1.0, 1.0]);
        let stuck = chain(&[1.0, 0.0, 2.0, 1.0]);
        let mixed = chain(&[2.0, 0.0, 3.0, 1.0]);
        let TraceView::Boxes { free: f, stuck: s, mixed: m, rest } = cut([&free, &stuck, &mixed], &[2, 0, 1], 0.4)
        else {
            panic!("boxes")
        };
        assert_eq!((m, f.0.len(), s.0.len(), rest.0.len()), (mixed, 0, 0, 4));
    }
}
