//! Scenes with payloads, compared with a flood fill that computes its own distances. Cells that are entirely free
//! connect, and cells that are entirely blocked separate.

use super::task;
use cplan::Outcome;
use cplan::engine::{Method, Options, solve};
use cplan::geometry::Point;
use cplan::model::{Grip, Holding, Payload, Task};
use cplan::space::Configuration;
use cplan_cases::dice::Dice;
use cplan_cases::{seeds, times};
use cplan_testkit::flood::Cells;
use cplan_testkit::problems::motion_problem;
use cplan_testkit::replay::World;
use cplan_testkit::scenes::anywhere;
use cplan_testkit::solid::V;

/// Cells along each axis.
const CELLS: usize = 150;

#[derive(Clone, Copy, PartialEq)]
enum Cell {
    Free,
    Mixed,
    Blocked,
}

/// The cells of joint space, and what is known of each.
struct Bitmap {
    cells: Cells,
    domain: [V; 2],
    kinds: Vec<Cell>,
}

impl Bitmap {
    fn new(task: &Task, world: &World) -> Self {
        let axes = task.arm.topology().ranges;
        let cells = Cells { count: [CELLS; 2], circles: axes.map(|axis| axis.is_circle()) };
        let domain: [V; 2] = axes.map(|axis| axis.domain().into());
        let speeds = world.speeds();
        let bound: f64 = (0..2).map(|k| speeds[k] * (domain[k][1] - domain[k][0]) / CELLS as f64 / 2.0).sum();
        let kind = |cell: usize| match world.room(cells.middle(domain, cell)) {
            [surely, _] if surely > bound => Cell::Free,
            [_, perhaps] if perhaps < -bound => Cell::Blocked,
            _ => Cell::Mixed,
        };
        Self { cells, domain, kinds: (0..CELLS * CELLS).map(kind).collect() }
    }

    /// Returns true if two configurations are connected through cells of some kinds.
    fn connects(&self, from: Configuration, to: Configuration, through: &[Cell]) -> bool {
        let [from, to] = [from, to].map(|q| self.cells.locate(self.domain, q.into()));
        let passes = |cell: usize| through.contains(&self.kinds[cell]);
        self.cells.flood(passes(from).then_some(from), |_, next| passes(next))[to]
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
        let mut free = || {
            std::iter::repeat_with(|| anywhere(&mut dice, &task.arm))
                .take(100)
                .find(|q| world.room([q[0], q[1]])[0] > 1e-6)
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
