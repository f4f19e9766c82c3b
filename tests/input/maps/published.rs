//! The room-sized gantry in published line maps.

use super::robot;
use cplan::Outcome;
use cplan::engine::{Method, solve};
use cplan::geometry::Point;
use cplan::input::{LineMap, Overrides, PreferenceMap, load};
use cplan::model::{MotionProblem, Preference, Region, Shape};
use cplan_testkit::reference::published;

/// Reads the problem of a world that names a map and a preference file by absolute paths.
fn problem(data: &std::path::Path, map: usize, preferences: usize, start: [f64; 2]) -> MotionProblem {
    let folder = tempfile::tempdir().unwrap();
    let world = folder.path().join("world.toml");
    let [map, preferences] =
        [format!("map{map}.map"), format!("preference{preferences}.map")].map(|name| data.join(name));
    let text = format!(
        "[start]\njoints = {start:?}\n[map]\nfile = {map:?}\npreferences = {preferences:?}\nheight = [0.0, 3.0]\n"
    );
    std::fs::write(&world, text).unwrap();
    load(robot(), &world, &Overrides::default()).unwrap_or_else(|e| panic!("{e}")).problem
}

#[test]
#[ignore = "needs the published data that CPLAN_REFERENCE names"]
fn the_maps_have_the_lines_that_are_printed() {
    let data = published("data");
    for (map, lines, half) in [(1, 36, 20000.0), (2, 10, 25000.0), (3, 15, 10000.0)] {
        let map = LineMap::read(&data.join(format!("map{map}.map"))).unwrap();
        assert_eq!(map.lines.len(), lines);
        assert_eq!(map.bounds[1].x, half);
    }
    // The rectangles of the letters and of the room become chains, because consecutive lines join.
    let chains = |map: usize| LineMap::read(&data.join(format!("map{map}.map"))).unwrap().chains().len();
    assert_eq!([1, 2, 3].map(chains), [5, 2, 5]);
    for (file, goal) in [(1, [-19500.0, -19500.0, -19000.0, -19000.0]), (2, [-3000.0, -3000.0, -1000.0, -1000.0])] {
        let map = PreferenceMap::read(&data.join(format!("preference{file}.map"))).unwrap();
        let goals: Vec<_> = map.goals.iter().map(|[a, b]| [a.x, a.y, b.x, b.y]).collect();
        assert_eq!(goals, [goal]);
        let epsilons: Vec<f64> = map.rectangles.iter().map(|r| r.epsilon).collect();
        assert_eq!(epsilons, [0.5, 0.5, -0.5, -0.5, 0.5]);
    }
}

#[test]
#[ignore = "needs the published data that CPLAN_REFERENCE names"]
fn the_gantry_finds_paths_in_all_three_maps() {
    let data = published("data");
    // Map 1 has its goal in the lower left corner. Maps 2 and 3 have it in the middle, where map 1 has a wall.
    for (map, preferences, start) in [(1, 1, [-9.0, 9.0]), (2, 2, [22.0, -22.0]), (3, 2, [8.0, -8.0])] {
        let problem = problem(&data, map, preferences, start);
        for method in Method::ALL {
            let answer = solve(&problem, &method.into(), &mut |_| {});
            let Outcome::Found(path) = &answer.outcome else { panic!("map {map}, {method}: {:?}", answer.history) };
            assert_eq!(path.path().start(), problem.start());
            let topology = problem.scene().arm().topology();
            assert!(problem.goals().contains(&topology, path.path().goal(), 1e-9), "map {map}, {method}");
            assert!(path.clearance() > 0.0);
        }
    }
}

#[test]
#[ignore = "needs the published data that CPLAN_REFERENCE names"]
fn no_path_leads_out_of_a_letter() {
    let data = published("data");
    let problem = problem(&data, 1, 1, [-9.0, 6.5]);
    for method in Method::ALL {
        let answer = solve(&problem, &method.into(), &mut |_| {});
        assert!(matches!(answer.outcome, Outcome::Infeasible(_)), "{method}: {:?}", answer.history);
    }
}

/// Checks that the worlds in `workspaces/maps` have the printed lines and rectangles. On map 2, the source spreads its
/// preference file over the whole map. On map 3, two of the rectangles are inside the map.
#[test]
#[ignore = "needs the published data that CPLAN_REFERENCE names"]
fn the_shipped_maps_are_the_printed_ones() {
    let data = published("data");
    let rounded = |point: Point| [point.x, point.y].map(|x| (1000.0 * x).round() as i64);
    for (world, map, preferences, scale) in [("leon", 1, 1, 1.0), ("rings", 2, 2, 1.25), ("pillars", 3, 2, 1.0)] {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("workspaces/maps").join(world);
        let problem = load(robot(), &path.with_extension("toml"), &Overrides::default()).unwrap().problem;
        let workspace = problem.scene().workspace();
        let mut shipped: Vec<[[i64; 2]; 2]> = Vec::new();
        for obstacle in &workspace.obstacles {
            let Shape::Polyline(points) = &obstacle.shape else { panic!("{world}: {}", obstacle.name) };
            shipped.extend(points.windows(2).map(|ends| [rounded(ends[0]), rounded(ends[1])]));
        }
        let printed = LineMap::read(&data.join(format!("map{map}.map"))).unwrap();
        let mut expected: Vec<[[i64; 2]; 2]> =
            printed.lines.iter().map(|line| line.map(|end| rounded(end / 1000.0))).collect();
        for lines in [&mut shipped, &mut expected] {
            lines.iter_mut().for_each(|line| line.sort_unstable());
            lines.sort_unstable();
        }
        assert_eq!(shipped, expected, "{world}");
        let wishes = PreferenceMap::read(&data.join(format!("preference{preferences}.map"))).unwrap();
        let placed = |corners: [Point; 2]| corners.map(|corner| rounded(corner * (scale / 1000.0)));
        let limits = problem.scene().arm().topology().ranges.map(|range| (1000.0 * range.domain().1).round() as i64);
        let in_map =
            |corners: &[[i64; 2]; 2]| (0..2).all(|k| corners[0][k] >= -limits[k] && corners[1][k] <= limits[k]);
        let rectangles = wishes.rectangles.iter().map(|rectangle| (placed(rectangle.corners), rectangle.epsilon));
        let expected: Vec<_> = rectangles.filter(|(corners, _)| in_map(corners)).collect();
        let region = |preference: &Preference| match &preference.region {
            Region::Tip(polygon) => {
                let corners = polygon.corners();
                let low = corners.iter().fold(corners[0], |low, corner| low.inf(corner));
                let high = corners.iter().fold(corners[0], |high, corner| high.sup(corner));
                ([rounded(low), rounded(high)], preference.epsilon)
            }
            Region::Configurations(_) => panic!("{world}: {}", preference.name),
        };
        assert_eq!(workspace.preferences.iter().map(region).collect::<Vec<_>>(), expected, "{world}");
        let goals = problem.goals().pieces().iter().flat_map(|piece| piece.ends()).map(rounded);
        let goals: Vec<[i64; 2]> = goals.collect();
        let hull = [0, 1].map(|k| {
            [0, 1].map(|end| {
                let values = goals.iter().map(|goal| goal[k]);
                if end == 0 { values.min().unwrap() } else { values.max().unwrap() }
            })
        });
        let [low, high] = placed(wishes.goals[0]);
        assert_eq!(hull, [[low[0], high[0]], [low[1], high[1]]], "{world}");
    }
}
