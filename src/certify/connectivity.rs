//! Is there a path at all? Proof that there is none, or a path, by subdivision.

use super::boxes::{Cell, State, Subdivision};
use crate::model::{Pair, Scene};
use crate::space::{Configuration, Path};
use std::collections::VecDeque;

/// A box of configurations in which one and the same pair is too near everywhere.
#[derive(Debug, Clone, PartialEq)]
pub struct StuckBox {
    /// Which configurations.
    pub cell: Cell,
    /// Which shapes.
    pub pair: Pair,
}

/// Proof that no motion leads from the start to any goal: what the stuck boxes leave of the domain does not connect
/// them. Only [`connectivity`] makes one.
#[derive(Debug, Clone, PartialEq)]
pub struct Disconnection {
    stuck: Vec<StuckBox>,
}

impl Disconnection {
    /// The stuck boxes.
    #[must_use]
    pub fn stuck(&self) -> &[StuckBox] {
        &self.stuck
    }
}

/// The answer of [`connectivity`].
#[derive(Debug, Clone, PartialEq)]
pub enum Connectivity {
    /// There is no path: proven.
    Disconnected(Disconnection),
    /// A path through free boxes.
    Connected(Path),
    /// Neither, when this many boxes were reached or could not be told apart any more.
    Undecided {
        /// Number of boxes looked at.
        boxes: usize,
    },
}

/// Decides whether a motion that keeps more than zero and at least `clearance` from every obstacle leads from `start`
/// to one of `goals`, with at most `max_boxes` boxes.
///
/// Soft subdivision search (Wang, Chiang, Yap 2015): boxes are free, stuck or mixed. While free and mixed boxes together
/// connect start and goal, the mixed ones on the connection with the fewest of them are halved. If they do not connect,
/// there is no path; if free ones alone do, there is one.
#[must_use]
pub fn connectivity(
    scene: &Scene,
    start: Configuration,
    goals: &[Configuration],
    clearance: f64,
    max_boxes: usize,
) -> Connectivity {
    let mut boxes = Subdivision::new(scene, clearance);
    loop {
        let ends: Vec<u32> = goals.iter().filter_map(|&g| boxes.locate(g)).collect();
        let connection = boxes.locate(start).and_then(|from| fewest_mixed(&boxes, from, &ends));
        let Some(connection) = connection else {
            return Connectivity::Disconnected(Disconnection { stuck: stuck(&boxes) });
        };
        let mixed: Vec<u32> = connection.iter().copied().filter(|&b| is_mixed(&boxes, b)).collect();
        if mixed.is_empty() {
            return Connectivity::Connected(path_through(&boxes, scene, &connection, start, goals));
        }
        let mut progress = false;
        for index in mixed {
            progress |= boxes.split(index);
        }
        if !progress || boxes.nodes.len() > max_boxes {
            return Connectivity::Undecided { boxes: boxes.nodes.len() };
        }
    }
}

fn is_mixed(boxes: &Subdivision, index: u32) -> bool {
    matches!(boxes.nodes[index as usize].state, State::Mixed(_))
}

fn stuck(boxes: &Subdivision) -> Vec<StuckBox> {
    let of = |node: &super::boxes::Node| match node.state {
        State::Stuck(pair) => Some(StuckBox { cell: node.cell, pair }),
        _ => None,
    };
    boxes.nodes.iter().filter_map(of).collect()
}

/// The chain of adjacent free and mixed boxes from `from` to one of `ends` with the fewest mixed ones: breadth-first
/// search in which free boxes cost nothing.
fn fewest_mixed(boxes: &Subdivision, from: u32, ends: &[u32]) -> Option<Vec<u32>> {
    const NONE: u32 = u32::MAX;
    let mut cost = vec![u32::MAX; boxes.nodes.len()];
    let mut parent = vec![NONE; boxes.nodes.len()];
    let mut queue = VecDeque::from([(0, from)]);
    cost[from as usize] = 0;
    while let Some((so_far, index)) = queue.pop_front() {
        if so_far > cost[index as usize] {
            continue;
        }
        if ends.contains(&index) {
            let mut chain = vec![index];
            let mut at = index;
            while parent[at as usize] != NONE {
                at = parent[at as usize];
                chain.push(at);
            }
            chain.reverse();
            return Some(chain);
        }
        for &next in &boxes.nodes[index as usize].neighbors {
            let step = u32::from(is_mixed(boxes, next));
            if so_far + step < cost[next as usize] {
                cost[next as usize] = so_far + step;
                parent[next as usize] = index;
                if step == 0 { queue.push_front((so_far, next)) } else { queue.push_back((so_far + 1, next)) }
            }
        }
    }
    None
}

/// The path through the middles of the shared sides of a chain of free boxes: straight within each box, which is convex.
fn path_through(
    boxes: &Subdivision,
    scene: &Scene,
    chain: &[u32],
    start: Configuration,
    goals: &[Configuration],
) -> Path {
    let topology = scene.arm.topology();
    // What to add to values in the fundamental domain to continue the path from `start`.
    let mut lift = start - topology.wrap(start);
    let mut waypoints = vec![start];
    for pair in chain.windows(2) {
        let [a, b] = [pair[0], pair[1]].map(|i| boxes.nodes[i as usize].cell);
        let Some((shift, middle)) = a.shared_side(&b, &topology) else { continue };
        waypoints.push(middle + lift);
        lift += shift;
    }
    let last = boxes.nodes[chain[chain.len() - 1] as usize].cell;
    let goal = goals.iter().map(|&g| topology.wrap(g)).find(|&g| last.contains(g));
    waypoints.extend(goal.map(|g| g + lift));
    Path::new(waypoints)
}
