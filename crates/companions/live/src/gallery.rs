//! Worlds and puzzles that a page can open.

use super::Files;
use serde::Serialize;
use std::collections::BTreeMap;
use std::time::Duration;

/// A world to open.
#[derive(Debug, Serialize)]
struct Choice {
    /// Name of the world in the page's address.
    name: &'static str,
    title: &'static str,
    /// Name of the robot, one of [`ROBOTS`].
    robot: &'static str,
    world: &'static str,
    puzzle: Option<Puzzle>,
}

/// A puzzle in a world. The page decides from the program's answer whether it is solved.
#[derive(Debug, Serialize)]
struct Puzzle {
    text: &'static str,
    verdict: &'static str,
    /// The part of the world that the user may change: the positions of the `obstacles`, or the `clearance`.
    free: &'static str,
    /// Length that the path must have in a solution. It is a proven lower bound. `None` if the length does not matter.
    length: Option<f64>,
    /// Least clearance that the user must set, in metres. `None` if clearance does not matter.
    clearance: Option<f64>,
}

const ROBOTS: [(&str, &str); 7] = [
    ("gantry", include_str!("../../../../robots/gantry.urdf")),
    ("planar_2r", include_str!("../../../../robots/planar_2r.urdf")),
    ("planar_2r_continuous", include_str!("../../../../robots/planar_2r_continuous.urdf")),
    ("polar", include_str!("../../../../robots/polar.urdf")),
    ("rail_arm", include_str!("../../../../robots/rail_arm.urdf")),
    ("scara", include_str!("../../../../robots/scara.urdf")),
    ("l_forearm", include_str!("../../../../robots/l_forearm.urdf")),
];

const CHOICES: [Choice; 14] = [
    world("shelf", "a shelf", "planar_2r", include_str!("../../../../workspaces/shelf.toml")),
    world("workbench", "a workbench", "planar_2r", include_str!("../../../../workspaces/workbench.toml")),
    world("crowd", "a crowd of discs", "planar_2r", include_str!("../../../../workspaces/crowd.toml")),
    world("cell", "a SCARA cell", "scara", include_str!("../../../../workspaces/scara_cell.toml")),
    world("maze", "a maze for a gantry", "gantry", include_str!("../../../../workspaces/gantry_maze.toml")),
    world("hook", "a bent forearm", "l_forearm", include_str!("../../../../workspaces/l_hook.toml")),
    world("gate", "a gate for a ram", "polar", include_str!("../../../../workspaces/polar_gate.toml")),
    world("no_path", "no path", "planar_2r_continuous", include_str!("../../../../workspaces/no_path.toml")),
    Choice {
        puzzle: Some(Puzzle::of("infeasible", "Close the gap: move the walls until it is proven that no path exists.")),
        ..world("close", "1: close the gap", "rail_arm", include_str!("puzzles/slot.toml"))
    },
    Choice {
        puzzle: Some(Puzzle {
            length: Some(5.5),
            ..Puzzle::of(
                "found",
                "Block the short route, but not the long one: the shortest path must be proven longer than 5.5.",
            )
        }),
        ..world("round", "2: the long way round", "planar_2r_continuous", include_str!("puzzles/round.toml"))
    },
    Choice {
        puzzle: Some(Puzzle::of(
            "infeasible",
            "Both joints turn without limits: block both directions with the two posts.",
        )),
        ..world(
            "both",
            "3: both ways round",
            "planar_2r_continuous",
            include_str!("../../../../workspaces/torus_open.toml"),
        )
    },
    Choice {
        puzzle: Some(Puzzle::of("found", "It is proven that the head cannot leave the ring: open a path for it.")),
        ..world("ring", "4: break the ring", "gantry", include_str!("../../../../workspaces/annulus_closed.toml"))
    },
    Choice {
        puzzle: Some(Puzzle::of(
            "found",
            "The elbow's limits keep the arm from passing the pole: move the pole so that the arm can pass it.",
        )),
        ..world("pole", "5: round the pole", "planar_2r", include_str!("../../../../workspaces/limits_closed.toml"))
    },
    Choice {
        puzzle: Some(Puzzle {
            free: "clearance",
            clearance: Some(NARROW_SLOT_CLEARANCE),
            ..Puzzle::of(
                "found",
                "Move nothing: find the largest clearance with which a path exists, to a tenth of a millimetre.",
            )
        }),
        ..world("berth", "6: a wide berth", "planar_2r", include_str!("../../../../workspaces/narrow_slot.toml"))
    },
];

/// Clearance slightly below the largest one with a path through the narrow slot, in metres.
const NARROW_SLOT_CLEARANCE: f64 = 0.0341;

const fn world(name: &'static str, title: &'static str, robot: &'static str, world: &'static str) -> Choice {
    Choice { name, title, robot, world, puzzle: None }
}

impl Puzzle {
    const fn of(verdict: &'static str, text: &'static str) -> Self {
        Self { text, verdict, free: "obstacles", length: None, clearance: None }
    }
}

/// The gallery, as the page reads it.
#[derive(Debug, Serialize)]
pub struct Gallery {
    /// Initial files and time limit of a plan, in seconds, for a page with the program inside. `None` for a page that a
    /// server serves.
    alone: Option<(Files, f64)>,
    robots: BTreeMap<&'static str, &'static str>,
    choices: [Choice; 14],
}

impl Gallery {
    /// Creates the gallery of a page. `alone` has the initial files and the time limit of a page with the program
    /// inside. It is `None` for a page that a server serves.
    pub fn new(alone: Option<(Files, Duration)>) -> Self {
        let alone = alone.map(|(files, time)| (files, time.as_secs_f64()));
        Self { alone, robots: BTreeMap::from(ROBOTS), choices: CHOICES }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_engine::{Plan, Problem, plan};
    use cplan_robot::Source;
    use cplan_solver::Options;
    use cplan_tasks::SEARCHES;
    use cplan_world::{Overrides, scene_from};
    use std::collections::BTreeSet;

    /// A solution of each puzzle, as replacements of parts of the world's text.
    const SOLUTIONS: [(&str, &[[&str; 2]]); 6] = [
        ("close", &[["[0.02, -0.9], [0.02, -0.12], [0.0, -0.12]", "[0.02, -0.75], [0.02, 0.03], [0.0, 0.03]"]]),
        ("round", &[["[0.7, -1.5]", "[0.7, 0.0]"]]),
        ("both", &[["[-1.25, 0.1]", "[-1.02, 0.1]"]]),
        (
            "ring",
            &[
                ["[[1.3234, 0.6161], [1.4157, 0.5778]", "[[1.8234, 0.6161], [1.9157, 0.5778]"],
                ["[1.4157, 0.9222], [1.3234, 0.8839]]", "[1.9157, 0.9222], [1.8234, 0.8839]]"],
            ],
        ),
        ("pole", &[["[0.0, 1.4]", "[0.0, 1.6]"]]),
        ("berth", &[["[start]", "clearance = 0.0341\n[start]"]]),
    ];

    fn plan_world(choice: &Choice, world: &str) -> Plan {
        let robot = BTreeMap::from(ROBOTS)[choice.robot];
        let scene = scene_from(Source::in_memory("arm.urdf", robot), Source::in_memory(choice.name, world)).unwrap();
        let problem = Problem::of_scene(scene, &Overrides::default()).unwrap();
        plan(&problem, &Options::default(), SEARCHES, &mut |_| ()).unwrap()
    }

    /// Judges a solution as the page does.
    fn is_solved(puzzle: &Puzzle, plan: &Plan) -> bool {
        let Some((problem, answer)) = plan.motion() else { return false };
        let bound = answer.bound().map_or(0.0, |bound| bound.lower);
        let clearance = problem.scene().workspace().clearance;
        plan.status().name() == puzzle.verdict
            && puzzle.length.is_none_or(|length| bound >= length)
            && puzzle.clearance.is_none_or(|least| clearance >= least)
    }

    #[test]
    fn every_world_opens_and_every_puzzle_is_unsolved_until_it_is_solved() {
        let names: BTreeSet<&str> = CHOICES.iter().map(|choice| choice.name).collect();
        assert_eq!(names.len(), CHOICES.len());
        let mut solutions = BTreeMap::from(SOLUTIONS);
        for choice in &CHOICES {
            let first = plan_world(choice, choice.world);
            let Some(puzzle) = &choice.puzzle else { continue };
            assert!(!is_solved(puzzle, &first), "{} is solved from the beginning", choice.name);
            let put = |world: String, [from, to]: &[&str; 2]| {
                assert!(world.contains(from), "{}: {from}", choice.name);
                world.replace(from, to)
            };
            let changes = solutions.remove(choice.name).expect("a solution");
            let world = changes.iter().fold(choice.world.to_owned(), put);
            assert!(is_solved(puzzle, &plan_world(choice, &world)), "{} is not solved", choice.name);
        }
        assert!(solutions.is_empty(), "{solutions:?}");
    }

    #[test]
    fn a_path_exists_at_the_stated_clearance_and_not_above() {
        let choice = CHOICES.iter().find(|choice| choice.name == "berth").unwrap();
        let wider = choice.world.replace("[start]", "clearance = 0.0342\n[start]");
        assert_eq!(plan_world(choice, &wider).status().name(), "infeasible");
    }
}
