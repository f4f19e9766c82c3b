//! Corridors exactly one cell wide, through the whole program. A pen on two slides moves among walls without thickness.

use super::*;
use cplan_cases::mazes;
use std::fmt::Write;

/// Side of a cell along each slide, metres. It is less along the first slide, because an outer grid grows walls by half
/// of that in all directions.
const SIDE: [f64; 2] = [0.006, 0.01];

/// Returns the middle of a row or column, rounded to tenths of a millimetre, which is exact.
fn middle(axis: usize, at: usize) -> String {
    format!("{:.4}", (at as f64 + 0.5) * SIDE[axis])
}

/// Returns a world whose walls lead through the middles of the blocked cells, from end to end of each run of two or
/// more cells.
fn world(n: usize, blocked: &[bool], goal: usize) -> String {
    let joints = |cell: usize| format!("[{}, {}]", middle(0, cell / n), middle(1, cell % n));
    let mut text = format!("[start]\njoints = {}\n[goal]\njoints = {}\n", joints(0), joints(goal));
    for along in [0, 1] {
        let cell = |line: usize, at: usize| if along == 1 { [line, at] } else { [at, line] };
        let is_blocked = |line: usize, at: usize| {
            let [i, j] = cell(line, at);
            blocked[i * n + j]
        };
        for line in (1..n).step_by(2) {
            let mut at = 0;
            while at < n {
                let from = at;
                while at < n && is_blocked(line, at) {
                    at += 1;
                }
                if at > from + 1 {
                    let [[a, b], [c, d]] = [cell(line, from), cell(line, at - 1)];
                    let ends = [[middle(0, a), middle(1, b)], [middle(0, c), middle(1, d)]];
                    let [[a, b], [c, d]] = ends;
                    writeln!(text, "[[obstacle]]\npolyline = [[{a}, {b}], [{c}, {d}]]").unwrap();
                }
                at += 1;
            }
        }
    }
    text
}

fn pen(n: usize) -> String {
    let [x, y] = SIDE.map(|side| side * n as f64);
    format!(
        r#"<robot name="plotter"><link name="base"/>
        <joint name="x" type="prismatic"><parent link="base"/><child link="carriage"/><axis xyz="1 0 0"/>
        <limit lower="0" upper="{x}" effort="1" velocity="1"/></joint><link name="carriage"/>
        <joint name="y" type="prismatic"><parent link="carriage"/><child link="pen"/><axis xyz="0 1 0"/>
        <limit lower="0" upper="{y}" effort="1" velocity="1"/></joint>
        <link name="pen"><collision><geometry><cylinder radius="0.0005" length="0.1"/></geometry></collision></link>
        </robot>"#
    )
}

/// Checks that the planner finds the path at once, with a certificate, and visits all cells of the corridors.
fn is_solved(n: usize, blocked: &[bool], goal: usize) {
    let place = Place::new().with("pen.urdf", pen(n)).with("walls.toml", world(n, blocked, goal));
    place
        .run(
            &["pen.urdf", "walls.toml"],
            &format!("--planner harmonic --cells {n} --levels 1 --period 0.1 --quiet --output path.json"),
        )
        .exits(0);
    let result: serde_json::Value = place.json("path.json");
    let free = blocked.iter().filter(|&&blocked| !blocked).count();
    assert_eq!(result["size"]["cells"], free);
    assert!(result["clearance"].as_f64().unwrap() > 0.0);
}

#[test]
fn a_spiral_of_a_hundred_thousand_cells_is_solved() {
    let (blocked, inner) = mazes::spiral(451);
    is_solved(451, &blocked, inner);
}

#[test]
fn a_maze_of_201_x_201_cells_is_solved() {
    is_solved(201, &mazes::maze(201, 0), 201 * 201 - 1);
}

/// Checks a maze with more than a hundred thousand walls.
#[test]
fn a_maze_of_501_x_501_cells_is_solved() {
    is_solved(501, &mazes::maze(501, 0), 501 * 501 - 1);
}
