//! The texts of the course, and the files for its figures, embedded in the program.

use crate::input::Source;
use cplan_course::Chapter;
use std::path::Path;

/// The chapters, in their order.
pub const CHAPTERS: [Chapter; 7] = [
    Chapter {
        name: "c_obstacles",
        text: include_str!("../../../docs/c_obstacles.md"),
        aim: "How an obstacle becomes a set of joint values that the arm must avoid.",
    },
    Chapter {
        name: "roadmaps",
        text: include_str!("../../../docs/roadmaps.md"),
        aim: "How a graph of collision-free motions turns planning into a search for a shortest path.",
    },
    Chapter {
        name: "cells",
        text: include_str!("../../../docs/cells.md"),
        aim: "How free space is divided into simple cells, and how a path through them is pulled taut.",
    },
    Chapter {
        name: "waves",
        text: include_str!("../../../docs/waves.md"),
        aim: "How a wave over a grid, and A*, find a path with the fewest moves.",
    },
    Chapter {
        name: "fields",
        text: include_str!("../../../docs/fields.md"),
        aim: "Potentials that lead to the goal without a search, and the local minima of others.",
    },
    Chapter {
        name: "proofs",
        text: include_str!("../../../docs/proofs.md"),
        aim: "Certified motions, and boxes that prove that no path exists.",
    },
    Chapter {
        name: "tasks",
        text: include_str!("../../../docs/tasks.md"),
        aim: "How picking, carrying and placing change the configuration space from step to step.",
    },
];

/// The pictures of the chapters that no live figure replaces.
pub const PICTURES: [(&str, &str); 19] = [
    ("course/astar.svg", include_str!("../../../docs/pictures/course/astar.svg")),
    ("course/boxes.svg", include_str!("../../../docs/pictures/course/boxes.svg")),
    ("course/harmonic.svg", include_str!("../../../docs/pictures/course/harmonic.svg")),
    ("course/minimum.svg", include_str!("../../../docs/pictures/course/minimum.svg")),
    ("course/minkowski.svg", include_str!("../../../docs/pictures/course/minkowski.svg")),
    ("course/payload.svg", include_str!("../../../docs/pictures/course/payload.svg")),
    ("course/pieces.svg", include_str!("../../../docs/pictures/course/pieces.svg")),
    ("course/probabilistic.svg", include_str!("../../../docs/pictures/course/probabilistic.svg")),
    ("course/slice.svg", include_str!("../../../docs/pictures/course/slice.svg")),
    ("course/solutions.svg", include_str!("../../../docs/pictures/course/solutions.svg")),
    ("course/torus.svg", include_str!("../../../docs/pictures/course/torus.svg")),
    ("course/trapezoids.svg", include_str!("../../../docs/pictures/course/trapezoids.svg")),
    ("course/turning.svg", include_str!("../../../docs/pictures/course/turning.svg")),
    ("course/visibility.svg", include_str!("../../../docs/pictures/course/visibility.svg")),
    ("course/voronoi.svg", include_str!("../../../docs/pictures/course/voronoi.svg")),
    ("course/wave.svg", include_str!("../../../docs/pictures/course/wave.svg")),
    ("khatib_blocked.svg", include_str!("../../../docs/pictures/khatib_blocked.svg")),
    ("khatib_cured.svg", include_str!("../../../docs/pictures/khatib_cured.svg")),
    ("khatib_trapped.svg", include_str!("../../../docs/pictures/khatib_trapped.svg")),
];

/// The robot and the world of the laboratory.
pub const LAB: [&str; 2] = ["robots/planar_2r.urdf", "workspaces/workbench.toml"];

/// The robots and worlds of the live figures, by their paths in the chapters.
const FILES: [(&str, &str); 8] = [
    ("robots/planar_2r.urdf", include_str!("../../../robots/planar_2r.urdf")),
    ("robots/planar_2r_continuous.urdf", include_str!("../../../robots/planar_2r_continuous.urdf")),
    ("robots/rrbot_vertical.urdf", include_str!("../../../robots/rrbot_vertical.urdf")),
    ("workspaces/no_path.toml", include_str!("../../../workspaces/no_path.toml")),
    ("workspaces/shelf.toml", include_str!("../../../workspaces/shelf.toml")),
    ("workspaces/tasks/tower.toml", include_str!("../../../workspaces/tasks/tower.toml")),
    ("workspaces/u_trap.toml", include_str!("../../../workspaces/u_trap.toml")),
    ("workspaces/workbench.toml", include_str!("../../../workspaces/workbench.toml")),
];

/// Returns an embedded robot or world.
///
/// # Panics
/// If the file is not embedded: a chapter names it in the command of its figure.
pub fn source(path: &str) -> Source {
    let (_, text) = FILES.iter().find(|(name, _)| *name == path).unwrap_or_else(|| panic!("{path} is not embedded"));
    Source::in_memory(Path::new(path), (*text).to_owned())
}
