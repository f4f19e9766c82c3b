//! Shortest paths among random disjoint polygons: cplan's triangulation and visibility graph beside polyanya's mesh.
//! The polygons and queries are written to a file, for peers in other languages.

use crate::Result;
use crate::rounds::Rounds;
use cplan::cspace::Regions;
use cplan::geometry::Point;
use cplan::planner::{Proposal, Planner, Query, Visibility};
use cplan::space::Configuration;
use cplan_cases::dice::Dice;
use cplan_testkit::roadmap::star_crowd;
use glam::{Vec2, vec2};
use polyanya::{Mesh, Triangulation};
use serde_json::{Value, json};

/// Number of queries per map.
const QUERIES: usize = 32;

/// Returns pairs of free places in the window.
fn queries(regions: &Regions) -> Vec<[Configuration; 2]> {
    let mut random = Dice::new(7);
    let free = |q: &Configuration| regions.free.iter().any(|polygon| polygon.contains(*q));
    let mut place = || loop {
        let [x, y] = regions.window.map(|(low, high)| random.within(low, high));
        let q = Configuration::new(x, y);
        if free(&q) {
            return q;
        }
    };
    (0..QUERIES).map(|_| [place(), place()]).collect()
}

fn single(p: Point) -> Vec2 {
    vec2(p.x as f32, p.y as f32)
}

/// Returns polyanya's mesh of triangles. If `is_merged`, merges neighbouring ones to polygons, as its documentation
/// recommends.
fn mesh(regions: &Regions, is_merged: bool) -> Mesh {
    let free = &regions.free[0];
    let outer: Vec<Vec2> = free.outer.iter().copied().map(single).collect();
    let mut triangulation = Triangulation::from_outer_edges(&outer);
    triangulation.add_obstacles(free.holes.iter().map(|hole| hole.iter().copied().map(single).collect::<Vec<_>>()));
    let mut mesh = triangulation.as_navmesh();
    if is_merged {
        mesh.merge_polygons();
    }
    mesh.bake();
    mesh
}

/// Returns the length of polyanya's path. The path that polyanya returns lacks the start; its first waypoint is the
/// first corner.
fn polyanya_length(mesh: &Mesh, [from, to]: &[Configuration; 2]) -> Option<f64> {
    let path = mesh.path(single(*from), single(*to))?;
    Some(f64::from(path.length))
}

fn cplan_length(
    regions: &Regions,
    map: &<Visibility as Planner>::Map,
    &[start, goal]: &[Configuration; 2],
) -> Option<f64> {
    match Visibility::default().query(regions, map, &Query { start, goals: goal.into() }).outcome {
        Proposal::Found(path) => Some(path.length()),
        Proposal::NoPath | Proposal::GaveUp(_) => None,
    }
}

pub fn run(corners: usize, rounds: usize, file: &str) -> Result<Value> {
    let regions = star_crowd(&mut Dice::new(1), corners / 10);
    let queries = queries(&regions);
    let mut times = Rounds::default();
    let (mut ours, mut theirs, mut arcs) = (Vec::new(), [Vec::new(), Vec::new()], 0);
    for _ in 0..rounds {
        let map = times.time("cplan build", || Visibility::default().build(&regions));
        arcs = times.time("cplan all arcs", || map.arcs()).len();
        ours = times.time("cplan queries", || queries.iter().map(|q| cplan_length(&regions, &map, q)).collect());
        for (k, name) in ["polyanya", "polyanya merged"].into_iter().enumerate() {
            let mesh = times.time(&format!("{name} build"), || mesh(&regions, k == 1));
            let lengths = || queries.iter().map(|query| polyanya_length(&mesh, query)).collect::<Vec<_>>();
            theirs[k] = times.time(&format!("{name} queries"), lengths);
        }
    }
    let holes: Vec<Vec<[f64; 2]>> =
        regions.free[0].holes.iter().map(|hole| hole.iter().map(|p| [p.x, p.y]).collect()).collect();
    let asked: Vec<[[f64; 2]; 2]> = queries.iter().map(|pair| pair.map(|q| [q[0], q[1]])).collect();
    std::fs::write(file, json!({"polygons": holes, "queries": asked}).to_string())?;
    Ok(json!({
        "times": times.into_json(),
        "queries": QUERIES,
        "arcs": arcs,
        "cplan": ours,
        "polyanya": theirs[0],
        "polyanya merged": theirs[1],
    }))
}
