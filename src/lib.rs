//! cplan plans motions of planar two-joint arms in configuration space. There are three answers: a path whose whole
//! continuous motion is *certified* free of collision, a *proof* that there is no path, or "unknown" at the resolution
//! that was tried. No answer depends only on samples.
//!
//! # The pipeline
//!
//! ```text
//!  arm.urdf   world.toml
//!      \        /
//!      [input]            files -> MotionProblem, or one error with file, line and help
//!          |
//!       [model]           Arm + Workspace = Scene; which pairs of shapes can meet
//!          |
//!      [cspace]           C-obstacles: Regions (polygons) or Grid (cells), with what they prove
//!          |
//! [field] [planner]       visibility graph, trapezoids, wavefront, harmonic field -> a proposed path
//!          |    [proofs]  slabs and boxes: proofs that there is no path, bounds on the shortest
//!          |     /
//!       [check]           the judge: certifies motions, checks proofs
//!          |
//!      [motion]           timing under limits on velocity, acceleration, jerk; JSON, CSV, ROS 2, MCAP
//!          |
//!      [engine]           plan, certify, refine: Found, Infeasible or Unknown; tasks as sequences of motions
//!          |
//!  [view] [compare]       pictures and tables, pure functions of results
//!          |
//!        [cli]
//! ```
//!
//! All of these use [`geometry`] (exact predicates, convex shapes, Minkowski differences) and [`space`]
//! (configurations, and the only code that wraps configurations on circles).
//!
//! Long loops can be stopped from outside, see [`interrupt`].
//!
//! Crates import only crates below them. The judge imports only geometry and the model, so it is independent of
//! planners and searches. A test checks this.
//!
//! # Conventions
//!
//! Lengths are metres, angles radians, times seconds. A configuration is the pair of joint values, base to tip. Paths
//! have unwrapped values: on a path across the seam of a circle, values continue beyond the seam. Touching is contact.
//! The same input gives the same output, byte for byte, except for optional computing times.
#![forbid(unsafe_code)]

#[cfg(feature = "program")]
pub mod cli;
mod planning;
mod robots;
pub use cplan_compare as compare;
pub use cplan_explore as explore;
pub use cplan_geometry as geometry;
pub use cplan_interrupt as interrupt;
#[cfg(feature = "live")]
pub use cplan_live as live;
pub use cplan_motion as motion;
#[cfg(feature = "program")]
use cplan_options as options;
#[cfg(feature = "program")]
use cplan_parallel as parallel;
pub use cplan_planners::cspace;
#[cfg(feature = "program")]
pub use cplan_programs as programs;
pub use cplan_proofs as proofs;
#[cfg(feature = "study")]
pub use cplan_study as study;
#[cfg(feature = "program")]
use cplan_text as text;
pub use cplan_view as view;
pub use cplan_view::output;
pub use engine::{Criterion, NamedJoints, Options, Plan, PlanError, Planner, Problem, ProblemError, Refutation};
pub use geometry::Point;
pub use input::InputError;
pub use model::{Arm, Joint, Link, Obstacle, Outcome, Status, Workspace};
pub use nalgebra;
pub use output::PlanOutput;
pub use planning::plan;
pub use space::Configuration;

/// Data of a problem: the arm, its workspace, and their scene; also tasks, the robot's other joints, masses and
/// torques, and a sensor.
pub mod model {
    pub use cplan_dynamics::{Torques, TorquesAt, keep_efforts};
    pub use cplan_handling::*;
    pub use cplan_model::*;
    pub use cplan_robot::AssumedLimits;
    pub use cplan_world::{Mount, Sensor};
}

/// Configurations and motions, and the topology of the configuration space.
pub mod space {
    pub use cplan_handling::{
        Derivative, INTERPOLATION, Interpolation, Piece, Recording, RecordingError, SMOOTH_INTERPOLATION, State,
    };
    pub use cplan_model::space::*;
    pub use cplan_motion::{BLEND_TOLERANCE, Blend, BlendedPath, Stretch};
}

/// Independent checks: certifies paths, and checks proofs, bounds and recorded motions.
pub mod check {
    pub use cplan_judge::*;
    pub use cplan_motion::recorded::*;
    pub use cplan_motion::{CertifiedCurve, Place, Rounding, Span, blend};
    pub use cplan_recordings::*;
}

/// Input: reads robots, worlds, maps and recordings. Returns problems, or errors with file, line and help.
pub mod input {
    pub use super::robots::robot;
    pub use cplan_robot::*;
    pub use cplan_world::load;
    pub use cplan_world::*;

    /// Allows worlds to name SVG drawings as lines, in the whole process. The program calls this at its start.
    #[cfg(feature = "program")]
    pub fn read_svg_lines() {
        cplan_toolpath::read_svg_by(cplan_drawing::read_line);
    }
}

/// Plans problems: the solver of a single motion, motions among moving obstacles, tasks, and explanations.
pub mod engine {
    pub use super::planning::{plan, plan_with, restored};
    pub use cplan_engine::*;
    pub use cplan_explain as explain;
    pub use cplan_explain::{Access, MAX_PLACES, Reach, Solution, reach, reach_section};
    pub use cplan_motion::{Timing, Wait};
    pub use cplan_solver::*;

    /// Verdicts on configurations, and on recorded motions and tasks, as data.
    pub mod findings {
        pub use cplan_engine::findings::*;
        pub use cplan_recordings::*;
    }

    /// Plans tasks as sequences of certified motions.
    pub mod task {
        pub use cplan_engine::MessageError;
        pub use cplan_legs::*;
        pub use cplan_tasks::{plan, raising_at_start, replay, rest_to_rest};
    }
}

/// Planners: pure functions that propose a path through a space for a query.
pub mod planner {
    pub use cplan_fields::{EquationChoice, FieldChoice, FieldPlanner, RELATIVE_TOLERANCE, field_domain};
    pub use cplan_harmonic::Harmonic;
    pub use cplan_planners::planner::*;
    pub use cplan_roadmaps::{Prm, PrmMap, Triangles, TrianglesMap, Voronoi, VoronoiMap};
}

/// Waves over the cells of a grid, and potential fields on a grid.
pub mod field {
    pub use cplan_fields::*;
    pub use cplan_harmonic::follow::*;
    pub use cplan_harmonic::*;
    pub use cplan_multigrid as multigrid;
    pub use cplan_planners::planner::grid_path::Place;
    pub use cplan_planners::waves::{FreeCells, Move, Neighborhood, StepLabels, UNREACHED, search};
}

/// Makes the GPU available to fields, as [`field::Device::Gpu`]. The program and [`plan`] do this themselves. It is
/// necessary only for relaxations alone.
#[cfg(feature = "gpu")]
pub fn bring_gpu() {
    field::Device::bring_gpu(cplan_gpu::shared);
}

/// Compiles and runs the README's example as a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
