//! One contract for all planners: their promises, on scenes in the representation that each works on.
//!
//! The library's own builders turn a scene into the space that a planner works on, so arms of all kinds, intervals and
//! circles take part. Distances on the scene alone decide whether a path is free.

use cplan::cspace::{Grid, Proves, Regions, ZonedGrid, outer_grid, regions, sampled_grid};
use cplan::field::search::Ties;
use cplan::field::{
    Device, Difference, Direction, Factor, Limits, Lines, Measure, Neighborhood, Order, Relaxation, Stencil,
};
use cplan::geometry::{Convex, Point, Vector};
use cplan::model::{JointType, Scene};
use cplan::planner::{
    EquationChoice, FieldChoice, FieldPlanner, FieldQuantity, GridSearch, Harmonic, PathKind, Planner, Prm, Proposal,
    Query, RoadmapSearch, Run, SearchOrder, Size, Trace, Trapezoid, Triangles, Visibility, Voronoi, Wavefront,
};
use cplan::space::{Configuration, JointRange, Metric, Path};
use cplan_testkit::arms::{self, all_kinds, arm, joint, link, rr};
use cplan_testkit::scenes::{q, scene};
use cplan_testkit::shapes::{disc, rectangle, wall};
use std::f64::consts::TAU;

/// A function that plans in a scene, in the representation that a planner needs.
type Plan = fn(&Spaces, &Query) -> Run;

/// The representations of a scene, which all planners share.
struct Spaces {
    /// Free space as polygons. Obstacles are grown by a margin far below the room in the scenes here.
    polygons: Regions,
    /// Cells from slabs that are narrower than the passages in the scenes here.
    cells: Grid,
    /// The same number of cells, by collision checks at their centres. The obstacles are grown by the arm's motion
    /// within a cell.
    sampled: Grid,
    /// The same cells with the scene's preferences.
    zoned: ZonedGrid,
}

impl Spaces {
    fn new(scene: &Scene, query: &Query) -> Self {
        let cells = outer_grid(scene, [96, 96], 0.0);
        let Proves::Outer { margin } = cells.proves else { unreachable!("an outer grid") };
        Self {
            polygons: regions(scene, 1e-3, query.start, 1),
            sampled: sampled_grid(scene, [96, 96], margin),
            zoned: ZonedGrid::new(cells.clone(), scene),
            cells,
        }
    }
}

/// Every type that implements `Planner`, with settings that change its paths.
const PLANNERS: [(&str, Plan); 26] = [
    (Visibility::NAME, |spaces, query| reproducible_run(&Visibility::default(), &spaces.polygons, query)),
    ("visibility, weighted", |spaces, query| {
        let metric = Metric::Weighted { weights: [1.0, 0.6] };
        reproducible_run(&Visibility { metric, ..Visibility::default() }, &spaces.polygons, query)
    }),
    ("visibility, travel time", |spaces, query| {
        let metric = Metric::Time { speeds: [1.0, 1.5], sum: None };
        reproducible_run(&Visibility { metric, ..Visibility::default() }, &spaces.polygons, query)
    }),
    ("visibility, Dijkstra backward", |spaces, query| {
        reproducible_run(&Visibility { search: BACKWARD, ..Visibility::default() }, &spaces.polygons, query)
    }),
    ("trapezoid, taut", |spaces, query| reproducible_run(&Trapezoid::default(), &spaces.polygons, query)),
    ("trapezoid, own", |spaces, query| {
        reproducible_run(&Trapezoid { path: PathKind::Own, ..Trapezoid::default() }, &spaces.polygons, query)
    }),
    ("trapezoid, Dijkstra backward", |spaces, query| {
        reproducible_run(&Trapezoid { search: BACKWARD, ..Trapezoid::default() }, &spaces.polygons, query)
    }),
    ("triangles, taut", |spaces, query| reproducible_run(&Triangles::default(), &spaces.polygons, query)),
    ("triangles, own", |spaces, query| {
        reproducible_run(&Triangles { path: PathKind::Own, ..Triangles::default() }, &spaces.polygons, query)
    }),
    (Voronoi::NAME, |spaces, query| reproducible_run(&Voronoi::default(), &spaces.polygons, query)),
    ("voronoi, taut", |spaces, query| {
        reproducible_run(&Voronoi { path: PathKind::Taut, ..Voronoi::default() }, &spaces.polygons, query)
    }),
    ("voronoi, Dijkstra backward", |spaces, query| {
        reproducible_run(&Voronoi { search: BACKWARD, ..Voronoi::default() }, &spaces.polygons, query)
    }),
    (Prm::NAME, |spaces, query| reproducible_run(&Prm::default(), &spaces.polygons, query)),
    ("prm, samples, Dijkstra backward", |spaces, query| {
        reproducible_run(&Prm { path: PathKind::Own, search: BACKWARD, ..Prm::default() }, &spaces.polygons, query)
    }),
    ("wavefront, cells", |spaces, query| {
        reproducible_run(&Wavefront { path: PathKind::Own, ..Wavefront::default() }, &spaces.cells, query)
    }),
    ("wavefront, shortcut", |spaces, query| reproducible_run(&Wavefront::default(), &spaces.cells, query)),
    ("wavefront, 8 neighbours", |spaces, query| {
        let neighborhood = Neighborhood::Eight;
        reproducible_run(&Wavefront { neighborhood, path: PathKind::Own, ..Wavefront::default() }, &spaces.cells, query)
    }),
    ("wavefront, A*, 8 neighbours", |spaces, query| {
        let (search, neighborhood) = (GridSearch::AStar, Neighborhood::Eight);
        let planner = Wavefront { search, neighborhood, path: PathKind::Own, ..Wavefront::default() };
        reproducible_run(&planner, &spaces.cells, query)
    }),
    ("wavefront, A* from the start", |spaces, query| {
        let (search, ties) = (GridSearch::AStar, Ties::First);
        let planner = Wavefront { search, ties, forward: true, path: PathKind::Own, ..Wavefront::default() };
        reproducible_run(&planner, &spaces.cells, query)
    }),
    ("wavefront, iterative deepening from the start", |spaces, query| {
        let search = GridSearch::IterativeDeepening;
        let planner = Wavefront { search, forward: true, path: PathKind::Own, ..Wavefront::default() };
        reproducible_run(&planner, &spaces.cells, query)
    }),
    ("wavefront, sampled", |spaces, query| {
        reproducible_run(&Wavefront { path: PathKind::Own, ..Wavefront::default() }, &spaces.sampled, query)
    }),
    ("harmonic, sampled", |spaces, query| reproducible_run(&Harmonic { path: PathKind::Own }, &spaces.sampled, query)),
    ("harmonic, cells", |spaces, query| reproducible_run(&Harmonic { path: PathKind::Own }, &spaces.cells, query)),
    ("harmonic, taut", |spaces, query| reproducible_run(&Harmonic { path: PathKind::Taut }, &spaces.cells, query)),
    ("oriented, relaxed", |spaces, query| {
        let direction = Direction::of([1.0, 0.5]).expect("not zero");
        let equation = EquationChoice::Oriented { direction, epsilon: 0.1, difference: Difference::Upwind };
        reproducible_run(&relaxed(equation), &spaces.zoned, query)
    }),
    ("altered preferences, relaxed", |spaces, query| {
        let equation = EquationChoice::AlteredPreference { elsewhere: 0.05 };
        reproducible_run(&relaxed(equation), &spaces.zoned, query)
    }),
];

/// Search for a shortest path with settings that differ from all defaults.
const BACKWARD: RoadmapSearch = RoadmapSearch { order: SearchOrder::Dijkstra, backward: true };

/// Returns true if a run reports that there is no path. A planner that draws samples gives up instead, because samples
/// prove nothing.
fn is_no_path(name: &str, run: &Run) -> bool {
    match &run.outcome {
        Proposal::NoPath => !name.starts_with(Prm::NAME),
        Proposal::GaveUp(reason) => {
            name.starts_with(Prm::NAME) && reason == "the roadmap of 500 samples does not connect start and goal"
        }
        Proposal::Found(_) => false,
    }
}

/// Returns a field that is relaxed until it leads to the goal.
fn relaxed(equation: EquationChoice) -> FieldPlanner {
    let field = FieldChoice::Relaxed {
        equation,
        relaxation: Relaxation::sor(Factor::Formula, Order::Corners(Lines::Rows)).guarded(),
        measure: Measure::SumOfChange,
        tolerance: 1e-2,
        max_sweeps: 10_000,
        on: Device::Cpu,
        stencil: Stencil::Square,
        initial: cplan::field::Initial::High,
    };
    FieldPlanner { field, limits: Limits::High, escape: None, path: PathKind::Taut }
}

/// Returns the run of a planner. Checks that it depends only on the input.
fn reproducible_run<P: Planner>(planner: &P, space: &P::Space, query: &Query) -> Run {
    let map = planner.build(space);
    let run = planner.query(space, &map, query);
    assert_eq!(run, planner.query(space, &map, query), "a second query of one map");
    assert_eq!(run, planner.query(space, &planner.build(space), query), "a second map");
    run
}

/// Returns the path of a run that must have one, after checks that hold for every path.
fn path(name: &str, scene: &Scene, query: &Query, run: &Run) -> Path {
    let Proposal::Found(path) = &run.outcome else { panic!("{name}: {:?}", run.outcome) };
    let topology = scene.arm().topology();
    assert_eq!(path.start(), query.start, "{name}");
    let is_copy = |axis: JointRange, goal: f64, end: f64| {
        let turns = ((end - goal) / TAU).round();
        end == goal || axis.is_circle() && (end - goal - turns * TAU).abs() < 1e-12
    };
    let ends = |goal: Configuration| (0..2).all(|k| is_copy(topology.ranges[k], goal[k], path.goal()[k]));
    assert!(query.goals.points().any(ends), "{name} ends at {}", path.goal());
    for (a, b) in path.segments() {
        let steps = ((b - a).norm() / 1e-3).ceil();
        for k in 0..=steps as usize {
            let at = a + (b - a) * (k as f64 / steps);
            assert!(topology.contains(at), "{name} leaves the limits at {at}");
            assert!(scene.clearance(at) > 0.0, "{name} collides at {at}");
        }
    }
    path.clone()
}

fn query(start: Configuration, goals: &[Configuration]) -> Query {
    Query { start, goals: goals.iter().copied().collect() }
}

fn range(lower: f64, upper: f64) -> JointRange {
    JointRange::Interval { lower, upper }
}

/// Returns a gantry that carries a disc of radius 0.05 m over `[-1, 1]^2`: configurations are the disc's centres.
fn gantry(obstacles: Vec<Convex>) -> Scene {
    scene(arms::gantry([-1.0, 1.0], vec![disc(Point::zeros(), 0.05)]), obstacles)
}

/// Returns a polar arm with a disc of radius 0.05 m at its end, 0.5 to 1.5 m from the joint, and a wall beyond 1 m in
/// one direction.
fn polar(turn: JointRange) -> Scene {
    let joints = [
        joint("turn", JointType::Revolute { sign: 1.0 }, turn),
        joint("reach", JointType::Prismatic { direction: Vector::x() }, range(0.5, 1.5)),
    ];
    let links = [link("turret", vec![]), link("tool", vec![disc(Point::zeros(), 0.05)])];
    scene(arm(joints, links, Vector::zeros(), Point::zeros()), vec![wall(Point::zeros(), Point::new(2.0, 0.0))])
}

#[test]
fn paths_lead_from_the_start_to_a_goal_through_free_space() {
    let problems = [
        (gantry(vec![rectangle(-0.4, 0.4, -0.5, 0.6)]), query(q(-0.8, 0.0), &[q(0.8, 0.1)])),
        (polar(JointRange::Circle), query(q(0.5, 1.2), &[q(-0.5, 0.7)])),
        (
            scene(rr([JointRange::Circle, JointRange::Circle]), vec![rectangle(0.7, 0.9, 0.4, 0.8)]),
            query(q(0.0, 0.0), &[q(1.5, 0.3)]),
        ),
    ];
    for (scene, query) in &problems {
        let spaces = Spaces::new(scene, query);
        for (name, plan) in PLANNERS {
            let path = path(name, scene, query, &plan(&spaces, query));
            assert!(path.length() > 0.0, "{name}");
        }
    }
}

#[test]
fn every_kind_of_arm_is_planned_for() {
    for arm in all_kinds() {
        let kind = arm.kind();
        let scene = scene(arm, vec![disc(Point::new(0.5, 1.1), 0.08)]);
        // Two configurations on either side of the obstacle, with room.
        let query = query(q(-0.3, 0.1), &[q(0.6, 0.4)]);
        assert!(
            scene.clearance(query.start) > 0.05 && query.goals.points().all(|goal| scene.clearance(goal) > 0.05),
            "{kind}"
        );
        let spaces = Spaces::new(&scene, &query);
        for (name, plan) in PLANNERS {
            path(&format!("{name} ({kind})"), &scene, &query, &plan(&spaces, &query));
        }
    }
}

#[test]
fn the_trace_and_size_are_those_of_the_representation() {
    let scene = gantry(vec![rectangle(-0.4, 0.4, -0.5, 0.6)]);
    let query = query(q(-0.8, 0.0), &[q(0.8, 0.1)]);
    let spaces = Spaces::new(&scene, &query);
    for (name, plan) in PLANNERS {
        let run = plan(&spaces, &query);
        let fits = match (&run.trace, run.size) {
            (Trace::Roadmap { edges: drawn, whole: false }, Size::Graph { edges, .. }) => drawn.len() == edges,
            (Trace::Roads { edges: drawn, expanded, .. }, Size::Graph { nodes, edges }) => {
                drawn.len() == edges && !expanded.is_empty() && expanded.len() <= nodes
            }
            (Trace::Channel { cells, channel, expanded, .. }, Size::Graph { nodes, .. }) => {
                let is_told = name.starts_with(Triangles::NAME) || name.ends_with("backward");
                is_told != expanded.is_empty()
                    && cells.len() == nodes
                    && !channel.is_empty()
                    && channel.iter().all(|&cell| cell < nodes)
            }
            (Trace::Wavefront { cells, labels: drawn, .. }, Size::Grid { cells: reached, .. }) => {
                drawn.len() == cells[0] * cells[1]
                    && drawn.iter().filter(|&&label| label != u32::MAX).count() == reached
            }
            (Trace::Wavefront { cells, labels: drawn, .. }, Size::Search { expanded, labeled }) => {
                drawn.len() == cells[0] * cells[1]
                    && drawn.iter().filter(|&&label| label != u32::MAX).count() == labeled
                    && expanded <= labeled
            }
            (Trace::Wavefront { labels: drawn, expanded, .. }, Size::Deepening { rounds, expansions, labeled }) => {
                drawn.iter().filter(|&&label| label != u32::MAX).count() == labeled
                    && rounds > 0
                    && expansions >= expanded.len()
            }
            (
                Trace::Field { cells, quantity: FieldQuantity::Logarithm, values },
                Size::Windows { cells: reached, .. } | Size::Grid { cells: reached, .. },
            ) => values.len() == cells[0] * cells[1] && values.iter().filter(|p| p.is_finite()).count() == reached,
            _ => false,
        };
        assert!(fits, "{name}: {:?}", run.size);
    }
}

#[test]
fn a_start_at_the_goal_is_a_path_that_stays_there() {
    let scene = gantry(vec![rectangle(-0.4, 0.4, -0.5, 0.6)]);
    for at in [q(-0.8, 0.0), q(1.0, 1.0), q(-1.0, 0.3)] {
        let query = query(at, &[q(0.8, 0.8), at]);
        let spaces = Spaces::new(&scene, &query);
        for (name, plan) in PLANNERS {
            assert_eq!(path(name, &scene, &query, &plan(&spaces, &query)).waypoints(), [at], "{name}");
        }
    }
}

#[test]
fn a_wall_from_limit_to_limit_is_no_path() {
    let scene = gantry(vec![rectangle(-0.1, 0.1, -1.1, 1.1)]);
    let query = query(q(-0.8, 0.0), &[q(0.8, 0.1), q(0.7, -0.5)]);
    let spaces = Spaces::new(&scene, &query);
    for (name, plan) in PLANNERS {
        assert!(is_no_path(name, &plan(&spaces, &query)), "{name}");
    }
}

#[test]
fn goals_that_cannot_be_reached_are_passed_over_for_one_that_can() {
    let scene = gantry(vec![rectangle(-0.1, 0.1, -1.1, 1.1), rectangle(-0.9, -0.5, 0.4, 0.8)]);
    let (beyond, inside, free) = (q(0.5, 0.1), q(-0.7, 0.6), q(-0.4, -0.8));
    for goals in [[beyond, inside, free], [free, beyond, inside], [inside, free, beyond]] {
        let query = query(q(-0.8, 0.0), &goals);
        let spaces = Spaces::new(&scene, &query);
        for (name, plan) in PLANNERS {
            assert_eq!(path(name, &scene, &query, &plan(&spaces, &query)).goal(), free, "{name}");
        }
    }
}

#[test]
fn the_nearer_of_two_goals_is_taken() {
    let scene = gantry(vec![]);
    let query = query(q(-0.8, 0.0), &[q(0.8, 0.0), q(-0.5, 0.2), q(0.3, -0.6)]);
    // All except one: along the Voronoi diagram, a wider passage is preferred to a shorter path.
    let spaces = Spaces::new(&scene, &query);
    for (name, plan) in PLANNERS.iter().filter(|(name, _)| !name.starts_with(Voronoi::NAME)) {
        assert_eq!(path(name, &scene, &query, &plan(&spaces, &query)).goal(), q(-0.5, 0.2), "{name}");
    }
}

#[test]
fn queries_without_a_free_end_are_given_up_with_the_reason() {
    let scene = gantry(vec![rectangle(-0.4, 0.4, -0.5, 0.6)]);
    let (free, inside, outside) = (q(-0.8, 0.0), q(0.0, 0.0), q(3.0, 0.0));
    let hopeless = [
        (query(inside, &[free]), "start"),
        (query(outside, &[free]), "start"),
        (query(free, &[inside]), "goal"),
        (query(free, &[outside]), "goal"),
        (query(free, &[inside, outside]), "goal"),
        (query(free, &[]), "no goal"),
    ];
    for (query, word) in &hopeless {
        let spaces = Spaces::new(&scene, query);
        for (name, plan) in PLANNERS {
            let Proposal::GaveUp(reason) = plan(&spaces, query).outcome else {
                panic!("{name}: not given up: {query:?}")
            };
            assert!(reason.contains(word), "{name}: {reason}");
        }
    }
}

#[test]
fn a_circle_is_gone_round_through_its_seam_and_an_interval_is_not() {
    // The goal is on the other side of the wall at 0, beyond pi.
    let (start, goal) = (q(2.5, 1.0), q(-2.5, 0.8));
    let query = query(start, &[goal]);
    // Limits at pi close one direction, the wall the other one.
    let scenes = [polar(JointRange::Circle), polar(range(-3.1, 3.1))];
    let [circle, interval] = scenes.each_ref().map(|scene| Spaces::new(scene, &query));
    for (name, plan) in PLANNERS {
        let end = path(name, &scenes[0], &query, &plan(&circle, &query)).goal();
        assert!((end - q(TAU - 2.5, 0.8)).norm() < 1e-12 && end[1] == 0.8, "{name} ends at {end}");
        assert!(is_no_path(name, &plan(&interval, &query)), "{name}");
    }
}

#[test]
fn on_an_interval_longer_than_a_turn_a_pose_a_turn_away_is_another_goal() {
    let mut long = polar(range(-1.0, 7.5));
    long = scene(long.into_parts().0, vec![]);
    let query = query(q(0.5, 1.0), &[q(0.5 + TAU, 1.0)]);
    let spaces = Spaces::new(&long, &query);
    for (name, plan) in PLANNERS {
        let path = path(name, &long, &query, &plan(&spaces, &query));
        assert_eq!(Some(path.goal()), query.goals.points().next(), "{name}");
        assert!(path.length() >= TAU - 1e-9, "{name}");
    }
}
