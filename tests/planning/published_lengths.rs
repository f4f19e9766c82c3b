//! Lengths on a map of cells against a visibility graph of its own: all pairs of corners, tested against all blocked
//! cells.

use cplan::geometry::Point;
use cplan_testkit::published::grid_lengths::{board, compare, free_space, queries};
use cplan_testkit::roadmap::{Board, brute_force_length, points, rectangle};

const MAP: &str = "\
type octile
height 8
width 12
map
............
..@@....T...
..@@....TT..
....@.......
.@....@@@@..
.@..@.@..@..
....@....@..
......@.....
";

/// Starts and goals on corners of cells. The second query passes between two blocked cells that touch in a corner.
const ENDS: [[f64; 4]; 6] = [
    [0.0, 0.0, 12.0, 8.0],
    [2.0, 4.0, 6.0, 1.0],
    [8.0, 5.0, 11.0, 0.0],
    [1.0, 7.0, 10.0, 2.0],
    [7.0, 7.0, 3.0, 0.0],
    [0.0, 3.0, 0.0, 3.0],
];

/// Half the diagonal of the diamonds that close the corners in which two blocked cells touch.
const DIAMOND: f64 = 1e-8;

/// Returns the blocked cells of the map and around it, each pair of neighbours as one more rectangle, and a diamond
/// around each corner in which only two of them touch. The oracle's obstacles are open, so a path may not run along
/// the common side of two of them.
fn blocked(board: &Board, [width, height]: [i32; 2]) -> Vec<Vec<Point>> {
    let is_blocked = |x: i32, y: i32| !board.is_free(x, y) || x >= width || y >= height;
    let block = |x: i32, y: i32, columns: i32, rows: i32| {
        let [x, y, to_x, to_y] = [x, y, x + columns, y + rows].map(f64::from);
        rectangle((x, to_x), (y, to_y))
    };
    let mut obstacles = Vec::new();
    for (x, y) in (-1..=width).flat_map(|x| (-1..=height).map(move |y| (x, y))) {
        let [here, right, above, beyond] = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| is_blocked(x + i, y + j));
        obstacles.extend(here.then(|| block(x, y, 1, 1)));
        obstacles.extend((here && right).then(|| block(x, y, 2, 1)));
        obstacles.extend((here && above).then(|| block(x, y, 1, 2)));
        if here == beyond && right == above && here != right {
            let (u, v) = (f64::from(x + 1), f64::from(y + 1));
            obstacles.push(points(&[(u + DIAMOND, v), (u, v + DIAMOND), (u - DIAMOND, v), (u, v - DIAMOND)]));
        }
    }
    obstacles
}

/// Writes the scenario and the lengths as the published files have them.
fn files(lengths: &[f64]) -> [String; 2] {
    let scenario = ENDS.iter().map(|[x, y, to_x, to_y]| format!("1\tsmall.map\t12\t8\t{x}\t{y}\t{to_x}\t{to_y}\t0\n"));
    let rows = lengths.iter().enumerate().map(|(k, length)| format!("small,{k},0.1,{length:.8},2\n"));
    [
        "version 1\n".to_owned() + &scenario.collect::<String>(),
        "Map,Query Number,Time,Distance,Path Length\n".to_owned() + &rows.collect::<String>(),
    ]
}

#[test]
fn lengths_on_a_map_of_cells_are_those_of_a_visibility_graph() {
    let board = board(MAP).unwrap();
    let obstacles = blocked(&board, [12, 8]);
    let length = |[x, y, to_x, to_y]: [f64; 4]| {
        brute_force_length(&obstacles, (-1.0, 13.0), Point::new(x, y), Point::new(to_x, to_y)).expect("a path")
    };
    let mut lengths = ENDS.map(length);
    let regions = free_space(&board);
    let compared = |lengths: &[f64]| {
        let [scenario, rows] = files(lengths);
        compare(&regions, &queries(&scenario, &rows).unwrap())
    };
    let all = compared(&lengths);
    assert_eq!((all.queries, all.kinds()), (6, [0, 0, 0]), "{all}");
    // A length that is wrong by a hundred-thousandth is noticed.
    lengths[3] *= 1.0 + 1e-5;
    assert_eq!(compared(&lengths).kinds(), [1, 0, 0]);
    // The source's sign for "no path", where there is one.
    lengths[3] = 1e18;
    assert_eq!(compared(&lengths).kinds(), [1, 0, 0]);
}

#[test]
fn files_that_do_not_correspond_are_refused() {
    let [scenario, rows] = files(&[1.0; 6]);
    let short = rows.rsplit_once("small,5").unwrap().0;
    let cases = [
        (queries(&scenario, short).err(), "6 queries, but 5 lengths"),
        (queries(&scenario, &rows.replace(",3,", ",4,")).err(), "query 3"),
        (queries(&scenario.replace("\t2\t4\t", "\ttwo\t4\t"), &rows).err(), "query 1"),
        (board(&MAP.replace(".@....@@@@..", ".@....@@@@.")).err(), "line 9: 11 cells instead of 12"),
        (board(&MAP.replace("width 12", "width")).err(), "no line \"width N\""),
    ];
    for (error, part) in cases {
        assert!(error.as_ref().is_some_and(|error| error.contains(part)), "{part}: {error:?}");
    }
}
