//! The reachable places of the tip in pictures and pages: cells of the workspace, and IK solutions in the configuration space.

use super::{Access, Origin, Reach, Solution};
use cplan_model::Arm;
use cplan_theme::{OCCUPIED, REACHED, REACHED_TWICE, Rgb, UNKNOWN, UNREACHABLE, role_or_hex};
use cplan_view::{CellLayer, Object, RoundingSteps, Section, object};

/// Script that shows the section in a page.
const SCRIPT: &str = include_str!("reach.js");

/// Colour and meaning of each kind of cell: one free solution, several, proven unreachable, colliding, unknown.
const CELL_KINDS: [(Rgb, &str); 5] = [
    (REACHED, "the tip can reach it, with one IK solution"),
    (REACHED_TWICE, "with several solutions"),
    (UNREACHABLE, "free, but proven out of reach"),
    (OCCUPIED, "not free"),
    (UNKNOWN, "unknown"),
];

fn style_index(access: Access, count: usize) -> usize {
    match (access, count) {
        (Access::Reachable, 1) => 0,
        (Access::Reachable, _) => 1,
        (Access::Unreachable, _) => 2,
        (Access::Blocked, _) => 3,
        (Access::Unknown, _) => 4,
    }
}

/// Returns the section that shows where the tip of this arm can go.
pub fn reach_section(reach: &Reach, arm: &Arm) -> Section {
    let color = |index: usize| CELL_KINDS[index].0;
    let is_there = |kind: &usize| reach.best().any(|(_, access, count)| style_index(access, count) == *kind);
    let kinds = (0..CELL_KINDS.len()).filter(is_there);
    Section {
        script: SCRIPT,
        start: Some("home"),
        cells: Some(cells(reach)),
        dots: free(reach).map(|solution| (solution.joints, color(style_index(solution.access, 2)))).collect(),
        legend: kinds.map(|kind| (color(kind), CELL_KINDS[kind].1.to_owned())).collect(),
        layers: &["access"],
        ..Section::of_data("reach", &document(reach, RoundingSteps::of(arm)))
    }
}

fn cells(reach: &Reach) -> CellLayer {
    let [columns, rows] = reach.size;
    let mut colors = vec![None; columns * rows];
    for (place, access, count) in reach.best() {
        colors[place % columns * rows + place / columns] = Some(style_index(access, count));
    }
    let palette = CELL_KINDS.map(|(color, _)| color).to_vec();
    CellLayer { corner: reach.corner.into(), side: reach.cell, size: reach.size, palette, colors }
}

fn free(reach: &Reach) -> impl Iterator<Item = &Solution> {
    reach.places.iter().flatten().filter(|solution| solution.access != Access::Blocked)
}

/// Returns the reachable places for pages. `cells` has a character for the kind of each cell, row by row from the lowest row; a
/// dot means that the cell is out of reach. `counts` has a character for the number of its IK solutions. `access` has the kind
/// of each solution, `1` if a motion reaches it. `origins` has the beginning of the straight motion to it: the index of another
/// solution, `-2 - r` for the end of route `r`, or -1 if there is no certified motion. Routes begin at home.
fn document(reach: &Reach, grain: RoundingSteps) -> Object {
    let letter = |access, count| char::from(b'0' + style_index(access, count) as u8);
    let mut cells = vec!['.'; reach.places.len()];
    for (place, access, count) in reach.best() {
        cells[place] = letter(access, count);
    }
    // A solution with a free joint represents infinitely many. Otherwise, there are only a few per cell.
    let count = |solutions: &Vec<Solution>| char::from(b'0' + solutions.len().min(9) as u8);
    let origin = |origin: &Option<Origin>| match *origin {
        None => -1,
        Some(Origin::Route(route)) => -2 - route as i64,
        Some(Origin::Solution(number)) => number as i64,
    };
    object!(
        "corner": reach.corner,
        "cell": reach.cell,
        "size": reach.size,
        "colors": CELL_KINDS.map(|(color, _)| role_or_hex(color)),
        "cells": cells.into_iter().collect::<String>(),
        "counts": reach.places.iter().map(count).collect::<String>(),
        "solutions": grain.configurations(reach.solutions().map(|solution| &solution.joints)),
        "access": reach.solutions().map(|solution| letter(solution.access, 2)).collect::<String>(),
        "origins": reach.motions.origins.iter().map(origin).collect::<Vec<_>>(),
        "routes": reach.motions.routes.iter().map(|route| grain.configurations(route)).collect::<Vec<_>>(),
    )
}
