//! Line maps and preference files, as an independent program wrote them, and with errors.

use super::{assert_refused, folder, problem_in, world_in};
use cplan::geometry::Point;
use cplan::input::{LineMap, PreferenceMap};
use cplan::model::{MotionProblem, Preference, Region, Shape};
use cplan_testkit::scenes::q;
use cplan_testkit::shapes::wall;
use proptest::prelude::*;

const MAP: &str = "2D-Map\nLineMinPos: -2000 -1000\nLineMaxPos: 2000 1000\nNumLines: 3\nLINES\n\
    -500 -500 500 -500\n500 500 500 -500\n-1500 0 -1000 0\nDATA\n";
const PREFERENCES: &str = "2D-Map\nLineMinPos: -3000 -3000\nLineMaxPos: 3000 3000\nNumGoal: 1\nGOAL\n\
    1500 700 1000 900\nNumPoint: 2\nPOINTS\n0 0 -200 +100 0.5\n-1000 -900 0 -600 -0.25\nEND\n";
const WORLD: &str = "[start]\njoints = [-1.0, 0.5]\n[map]\nfile = \"room.map\"\npreferences = \"wishes.map\"\n";

fn files(map: &str, preferences: &str, world: &str) -> tempfile::TempDir {
    folder(&[("room.map", map.as_bytes()), ("wishes.map", preferences.as_bytes()), ("world.toml", world.as_bytes())])
}

fn point(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

/// Checks that segments are equal up to rounding.
fn assert_near(found: &[[Point; 2]], expected: &[[Point; 2]]) {
    let near = |(a, b): (&[Point; 2], &[Point; 2])| (0..2).all(|k| (a[k] - b[k]).norm() < 1e-9);
    assert!(found.len() == expected.len() && found.iter().zip(expected).all(near), "{found:?}");
}

/// Returns the segments of all pieces, lower end first, sorted.
fn segments(pieces: impl Iterator<Item = [Point; 2]>) -> Vec<[[f64; 2]; 2]> {
    let mut all: Vec<[[f64; 2]; 2]> =
        pieces.map(|[a, b]| [[a.x, a.y], [b.x, b.y]]).map(|[a, b]| if a <= b { [a, b] } else { [b, a] }).collect();
    all.sort_by(|a, b| a.partial_cmp(b).unwrap());
    all
}

proptest! {
    #![proptest_config(cplan_cases::cases(200))]

    #[test]
    fn maps_are_read_as_written_and_chained_without_loss(
        lines in prop::collection::vec([-3..4_i32, -3..4, -3..4, -3..4], 0..40),
        space in prop::sample::select(vec![" ", "\t", "  \t "]),
        end in prop::sample::select(vec!["\n", "\r\n", "\n\n# a remark\n", " \r\n"]),
    ) {
        let mut text = ["2D-Map", "LineMinPos:_-3_-3", "LineMaxPos:_3_3", &format!("NumLines:_{}", lines.len()), "LINES", ""]
            .join(end).replace('_', space);
        for l in &lines {
            text += &format!("{space}{}{space}{}{space}{}{space}{}.0{end}", l[0], l[1], l[2], l[3]);
        }
        let folder = folder(&[("room.map", format!("{text}DATA").as_bytes())]);
        let map = LineMap::read(&folder.path().join("room.map")).unwrap();
        let written: Vec<[Point; 2]> = lines
            .iter()
            .map(|l| [point(l[0].into(), l[1].into()), point(l[2].into(), l[3].into())])
            .collect();
        prop_assert_eq!(&map.lines, &written);
        prop_assert_eq!(map.bounds, [point(-3.0, -3.0), point(3.0, 3.0)]);

        let chains = map.chains();
        let sides = chains.iter().flat_map(|c| c.points.windows(2).map(|w| [w[0], w[1]]));
        let with_length = written.iter().copied().filter(|[a, b]| a != b);
        prop_assert_eq!(segments(sides), segments(with_length));
        // A line without length is a point. It may be part of a chain.
        for (i, [a, b]) in written.iter().enumerate() {
            let chain = chains.iter().find(|c| c.lines[0] <= i && i <= c.lines[1]).unwrap();
            prop_assert!(chain.points.contains(a) && chain.points.contains(b));
        }
        let numbered = chains.iter().flat_map(|c| c.lines[0]..=c.lines[1]);
        prop_assert!(numbered.eq(0..written.len()), "{chains:?}");
    }
}

/// Returns the lower left and the upper right corner of a preference's rectangle for the tip.
fn ends(preference: &Preference) -> [Point; 2] {
    let Region::Tip(polygon) = &preference.region else { panic!("{preference:?}") };
    let corners = polygon.corners();
    assert_eq!(corners.len(), 4);
    [corners[0], corners[2]]
}

#[test]
fn a_world_has_the_walls_of_its_map_in_metres() {
    let world = world_in(&files(MAP, PREFERENCES, WORLD)).unwrap();
    let obstacles = &world.workspace.fixed.obstacles;
    let names: Vec<&str> = obstacles.iter().map(|o| o.name.as_str()).collect();
    assert_eq!(names, ["room, lines 1 to 2", "room, line 3", "room, frame"]);
    let first = vec![point(-0.5, -0.5), point(0.5, -0.5), point(0.5, 0.5)];
    assert_eq!(obstacles[0].shape, Shape::Polyline(first));
    assert_eq!(obstacles[1].pieces, [wall(point(-1.5, 0.0), point(-1.0, 0.0))]);
    assert_eq!(obstacles[2].pieces.len(), 4);
    assert_eq!(obstacles[2].pieces[1], wall(point(2.0, -1.0), point(2.0, 1.0)));

    let epsilons: Vec<f64> = world.workspace.fixed.preferences.iter().map(|p| p.epsilon).collect();
    assert_eq!(epsilons, [0.5, -0.25]);
    assert_eq!(ends(&world.workspace.fixed.preferences[0]), [point(-0.2, 0.0), point(0.0, 0.1)]);
    assert_eq!(world.workspace.fixed.preferences[1].name, "wishes, rectangle 2");

    let world = WORLD.replace("file =", "scale = 1.0\noffset = [10, -20]\nframe = false\nheight = [0, 3]\nfile =");
    let world = world_in(&files(MAP, PREFERENCES, &world)).unwrap();
    let obstacles = &world.workspace.fixed.obstacles;
    assert_eq!(obstacles.len(), 2);
    assert_eq!(obstacles[1].pieces, [wall(point(-1490.0, -20.0), point(-990.0, -20.0))]);
    assert!(obstacles.iter().all(|o| o.heights.lower == 0.0 && o.heights.upper == 3.0));
    assert_eq!(ends(&world.workspace.fixed.preferences[1]), [point(-990.0, -920.0), point(10.0, -620.0)]);
}

#[test]
fn goal_rectangles_are_areas_unless_the_world_has_a_goal() {
    let low = WORLD.replace("file =", "height = [0, 3]\nfile =");
    let problem = problem_in(&files(MAP, PREFERENCES, &low)).unwrap().problem;
    let sides = |problem: &MotionProblem| -> Vec<[Point; 2]> {
        let arm = problem.scene().arm();
        problem.goals().pieces().iter().map(|piece| piece.ends().map(|q| arm.tip_at(q))).collect()
    };
    let rim = [point(1.0, 0.7), point(1.5, 0.7), point(1.5, 0.9), point(1.0, 0.9)];
    // The upper side is nearer to the frame than the radius of the mast.
    let expected = [[rim[0], rim[1]], [rim[1], rim[2]], [rim[3], rim[0]]];
    assert_near(&sides(&problem), &expected);
    // Of two goals, one is enough. A goal can be a point.
    let two = PREFERENCES
        .replace("NumGoal: 1", "NumGoal: 2")
        .replace("1500 700 1000 900", "1500 700 1000 900\n-1200 -800 -1200 -800");
    let problem = problem_in(&files(MAP, &two, &low)).unwrap().problem;
    assert_near(&sides(&problem), &[&expected[..], &[[point(-1.2, -0.8); 2]]].concat());
    // A goal that is blocked is left out, with a note.
    let walled = two.replace("-1200 -800 -1200 -800", "500 0 500 0");
    let loaded = problem_in(&files(MAP, &walled, &low)).unwrap();
    assert_near(&sides(&loaded.problem), &expected);
    assert!(loaded.notes.iter().any(|note| note.starts_with("a goal is ruled out: ")), "{:?}", loaded.notes);
    let own = format!("{low}[goal]\njoints = [-1.2, -0.4]\n");
    let problem = problem_in(&files(MAP, PREFERENCES, &own)).unwrap().problem;
    assert_eq!(*problem.goals(), q(-1.2, -0.4).into());
    // The error about a blocked goal has the position at which the world names the file.
    let walled = PREFERENCES.replace("1500 700 1000 900", "500 -400 500 400");
    assert_refused(problem_in(&files(MAP, &walled, &low)), &["world.toml: line 6", "wishes.map", "room, lines 1 to 2"]);
}

#[test]
fn a_line_without_length_is_a_point_and_solid() {
    let map = MAP.replace("-1500 0 -1000 0", "-1000 500 -1000 500");
    let low = WORLD.replace("file =", "height = [0, 3]\nfile =");
    assert_refused(problem_in(&files(&map, PREFERENCES, &low)), &["the start", "room, line 3"]);
}

#[test]
fn malformed_maps_are_refused_with_their_line() {
    for (from, to, parts) in [
        ("2D-Map", "3D-Map", &["line 1", "expected \"2D-Map\"", "hint"][..]),
        (MAP, "", &["ends too early: \"2D-Map\" is expected"]),
        ("LineMinPos: -2000 -1000\n", "", &["line 2", "expected \"LineMinPos:\" and 2 numbers"]),
        ("-2000 -1000", "-2000", &["line 2", "expected 2 numbers, found 1"]),
        ("-2000 -1000", "-2000 -1000 0", &["line 2", "found 3"]),
        ("-2000 -1000", "-2000 west", &["line 2, column 19", "\"west\" is not a finite number"]),
        ("-2000 -1000", "-2000 nan", &["line 2, column 19", "not a finite number"]),
        ("-2000 -1000", "-2000 -1e999", &["line 2", "not a finite number"]),
        ("-2000 -1000", "2000 -1000", &["line 3", "not above LineMinPos", "lower left"]),
        ("-2000 -1000", "-2e300 -1000", &["world.toml: line 4", "scale"]),
        ("NumLines: 3", "NumLines: 4", &["line 4", "NumLines says 4, but 3 follow", "hint"]),
        ("NumLines: 3", "NumLines: 2", &["line 4", "NumLines says 2, but 3 follow"]),
        ("NumLines: 3", "NumLines: 2.5", &["line 4", "2.5 is not a number of lines"]),
        ("NumLines: 3", "NumLines: -1", &["line 4", "-1 is not a number"]),
        ("NumLines: 3", "NumLines: 1e30", &["line 4", "not a number of lines"]),
        ("NumLines: 3", "NumLines 3", &["line 4", "expected \"NumLines:\""]),
        ("LINES\n", "", &["line 5", "expected \"LINES\""]),
        ("500 -500\n-1500", "500\n-1500", &["line 7", "expected 4 numbers, found 3"]),
        ("-1500 0", "-1500 zero", &["line 8, column 7", "\"zero\""]),
        ("-1500 0", "-1500 inf", &["line 8, column 7", "finite"]),
        ("-1500 0", "-2500 0", &["line 8", "(-2500, 0) lies outside", "widen"]),
        ("DATA\n", "", &["the file ends too early: a line or \"DATA\" is expected here"]),
        ("DATA\n", "END\n", &["line 9", "\"END\""]),
        ("DATA\n", "DATA\n1 2\n", &["line 10", "follows the end of the map"]),
    ] {
        assert!(MAP.contains(from), "{from}");
        assert_refused(world_in(&files(&MAP.replacen(from, to, 1), PREFERENCES, WORLD)), parts);
    }
    let folder = folder(&[("room.map", &b"2D-Map\n\xff"[..])]);
    assert_refused(LineMap::read(&folder.path().join("room.map")), &["room.map", "not UTF-8"]);
}

#[test]
fn malformed_preferences_are_refused_with_their_line() {
    for (from, to, parts) in [
        ("NumGoal: 1", "NumGoal: 2", &["wishes.map: line 4", "NumGoal says 2, but 1 follow"][..]),
        ("NumGoal: 1", "NumGoal: 0", &["line 4", "NumGoal is 0"]),
        ("1500 700 1000 900", "1500 700", &["line 6", "expected 4 numbers, found 2"]),
        ("1500 700 1000 900", "1500 700 1000 9000", &["line 6", "outside the bounds"]),
        ("1500 700 1000 900\n", "1500 700 1000 900\n0 0 1 1\n", &["line 4", "NumGoal says 1, but 2 follow"]),
        ("NumPoint: 2", "NumPoint: 3", &["line 7", "NumPoint says 3, but 2 follow"]),
        ("+100 0.5", "+100", &["line 9", "expected 5 numbers, found 4"]),
        ("+100 0.5", "+100 nan", &["line 9, column 15", "finite"]),
        ("+100 0.5", "0 0.5", &["line 9", "no area"]),
        ("END\n", "DATA\n", &["line 11", "\"END\""]),
        ("END\n", "END\nEND\n", &["line 12", "follows the end of the map"]),
    ] {
        assert!(PREFERENCES.contains(from), "{from}");
        assert_refused(world_in(&files(MAP, &PREFERENCES.replacen(from, to, 1), WORLD)), parts);
    }
    let file = files(MAP, &PREFERENCES.replace("1500 700 1000 900", "7 8 7 8"), WORLD);
    let map = PreferenceMap::read(&file.path().join("wishes.map")).unwrap();
    assert_eq!(map.goals, [[point(7.0, 8.0); 2]], "a goal may be a point");
}

#[test]
fn tables_that_define_no_map_are_refused() {
    for (from, to, parts) in [
        ("room.map", "attic.map", &["world.toml: line 4, column 8", "map: there is no file", "attic.map"][..]),
        ("wishes.map", "attic.map", &["line 5", "preferences: there is no file"]),
        ("file = \"room.map\"\n", "", &["line 3", "missing key `file`"]),
        ("file", "scale = 0\nfile", &["line 4, column 9", "map scale must be positive", "millimetres"]),
        ("file", "scale = nan\nfile", &["line 4", "finite"]),
        ("file", "scale = 1000\nfile", &["line 5", "extends to 2e6 m", "`scale`"]),
        ("file", "offset = [1]\nfile", &["line 4", "two numbers, found 1"]),
        ("file", "height = [1, 0]\nfile", &["line 4", "is empty"]),
        ("file", "walls = true\nfile", &["line 4", "unknown key `walls`"]),
    ] {
        assert!(WORLD.contains(from), "{from}");
        assert_refused(world_in(&files(MAP, PREFERENCES, &WORLD.replacen(from, to, 1))), parts);
    }
}
