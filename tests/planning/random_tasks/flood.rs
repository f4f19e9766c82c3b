//! Scenes with payloads, compared with a flood fill that computes its own distances. Cells that are entirely free
//! connect, and cells that are entirely blocked separate.

use super::replay::World;
use super::task;
use cplan::Outcome;
use cplan::engine::{Method, Options, solve};
use cplan::geometry::Point;
use cplan::model::{Grip, Holding, Payload, Task};
use cplan::space::Configuration;
use cplan_cases::dice::Dice;
use cplan_cases::{seeds, times};
use cplan_testkit::problems::motion_problem;

/// Cells along each axis.
const CELLS: usize = 150;

#[derive(Clone, Copy, PartialEq)]
enum Cell {
    Free,
    Mixed,
    Blocked,
}

struct Bitmap {
    cells: Vec<Cell>,
    axes: [(f64, f64, bool); 2],
}

impl Bitmap {
    fn new(task: &Task, world: &World) -> Self {
        let axes = task.arm.topology().ranges.map(|axis| {
            let (lower, upper) = axis.domain();
            (lower, upper, axis.is_circle())
        });
        let sizes = axes.map(|(lower, upper, _)| (upper - lower) / CELLS as f64);
        let speeds = world.speeds();
        let bound = (speeds[0] * sizes[0] + speeds[1] * sizes[1]) / 2.0;
        let cell = |index: usize| {
            let at = [index % CELLS, index / CELLS];
            let q = [0, 1].map(|k| axes[k].0 + sizes[k] * (at[k] as f64 + 0.5));
            match world.room(q) {
                [surely, _] if surely > bound => Cell::Free,
                [_, perhaps] if perhaps < -bound => Cell::Blocked,
                _ => Cell::Mixed,
            }
        };
        Self { cells: (0..CELLS * CELLS).map(cell).collect(), axes }
    }

    fn locate(&self, q: Configuration) -> usize {
        let at = [0, 1].map(|k| {
            let (lower, upper, circle) = self.axes[k];
            let share = (q[k] - lower) / (upper - lower);
            let share = if circle { share.rem_euclid(1.0) } else { share };
            ((share * CELLS as f64) as usize).min(CELLS - 1)
        });
        at[1] * CELLS + at[0]
    }

    /// Returns true if two configurations are connected through cells of some kinds, corners included.
    fn connects(&self, from: Configuration, to: Configuration, through: &[Cell]) -> bool {
        let (from, to) = (self.locate(from), self.locate(to));
        let mut seen = vec![false; self.cells.len()];
        let mut open = vec![from];
        while let Some(cell) = open.pop() {
            if !through.contains(&self.cells[cell]) || std::mem::replace(&mut seen[cell], true) {
                continue;
            }
            for (dx, dy) in [(1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1)] {
                let corner = dx != 0 && dy != 0;
                if corner && !through.contains(&Cell::Mixed) {
                    continue;
                }
                let at = [(cell % CELLS) as i64 + dx, (cell / CELLS) as i64 + dy];
                let wrapped = [0, 1].map(|k| if self.axes[k].2 { at[k].rem_euclid(CELLS as i64) } else { at[k] });
                if wrapped.iter().all(|k| (0..CELLS as i64).contains(k)) {
                    open.push(wrapped[1] as usize * CELLS + wrapped[0] as usize);
                }
            }
        }
        seen[to]
    }
}

#[test]
fn payloads_are_judged_like_a_flood_fill() {
    let (mut found, mut infeasible, mut decisive) = (0_u64, 0_u64, 0_u64);
    for seed in seeds(40) {
        let task = task::task(seed);
        let mut dice = Dice::new(seed.wrapping_add(1_000_000));
        // The object is attached to the arm as if picked at the start.
        let object = dice.below(task.objects.len());
        let supports: Vec<usize> = (0..task.workspace.fixed.obstacles.len()).filter(|_| dice.chance(0.2)).collect();
        let mut at = task.objects.clone();
        let tip = task.arm.tip_at(task.start);
        at[object].at.translation = tip;
        let task = Task { objects: at, ..task };
        let world = World::at_first(&task).carrying(object, [task.start[0], task.start[1]], supports.clone());
        let lies = task.objects[object].at;
        let grip = match task.objects[object].holding {
            Holding::Rigid => Grip::rigid(&task.arm, task.start, &lies),
            Holding::Level => Grip::Level { angle: lies.rotation.angle(), point: Point::zeros() },
        };
        let payload = Payload { object, grip, supports };
        let poses: Vec<_> =
            task.objects.iter().enumerate().map(|(i, o)| (i != object).then_some(o.at.into())).collect();
        let scene = task.scene(&poses, &[], Some(&payload), []);
        let topology = task.arm.topology();
        let mut free = || {
            let draw = || {
                Configuration::from_fn(|k, _| {
                    let (lower, upper) = topology.ranges[k].domain();
                    dice.within(lower, upper)
                })
            };
            std::iter::repeat_with(draw).take(100).find(|q| world.room([q[0], q[1]])[0] > 1e-6)
        };
        let (Some(start), Some(goal)) = (free(), free()) else { continue };
        assert!(scene.obstructions(start).is_empty(), "seed {seed}: {:?} is free", start);
        let bitmap = Bitmap::new(&task, &world);
        let surely = bitmap.connects(start, goal, &[Cell::Free]);
        let perhaps = bitmap.connects(start, goal, &[Cell::Free, Cell::Mixed]);
        decisive += u64::from(surely || !perhaps);
        let problem = motion_problem(scene, start, goal);
        let options = Options { levels: 4, boxes: 20_000, bounded: false, ..Method::Visibility.into() };
        match solve(&problem, &options, &mut |_| {}).outcome {
            Outcome::Found(_) => {
                found += 1;
                assert!(perhaps, "seed {seed}: found, but the flood does not get there");
            }
            Outcome::Infeasible(_) => {
                infeasible += 1;
                assert!(!surely, "seed {seed}: infeasible, but the flood gets there");
            }
            Outcome::Unknown(_) => {}
        }
    }
    println!("{found} found, {infeasible} infeasible, {decisive} decided by the flood");
    let count = times(40);
    assert!(
        found * 4 > count && infeasible * 12 > count && decisive * 2 > count,
        "{found} found, {infeasible} infeasible, {decisive} decided of {count}"
    );
}
