//! The mission: no robot ever hits anything, and each leg ends as it is reported.

use super::plain::{gap, least_gap};
use cplan::field::Stopping;
use cplan::{Point, explore};
use cplan_testkit::mobile::floor::Floor;
use cplan_testkit::mobile::forces::Ending;
use cplan_testkit::mobile::mission::{Leg, by_fields, by_forces, explored, followed, planners, way};
use cplan_testkit::mobile::{TARGETS, fields};
use cplan_testkit::published::{alves, row};

fn floor(name: &str) -> Floor {
    Floor::load(&format!("explore/{name}.toml")).unwrap_or_else(|e| panic!("{e}"))
}

/// Checks that the robot is at each goal that is reported as reached. If a robot was trapped, its reported distance
/// from the goal must be the least one on its way.
fn check(floor: &Floor, legs: &[Leg], stop: f64, what: &str) {
    assert_eq!(legs.len(), TARGETS.len());
    for (leg, (name, target)) in legs.iter().zip(TARGETS) {
        let what = format!("{what}, to {name}");
        assert!(least_gap(&floor.scene, &leg.way) > 0.0, "{what}: it is in something");
        let distances: Vec<f64> = leg.way.iter().map(|p| (Point::from(target) - p).norm()).collect();
        let (last, best) = (distances[distances.len() - 1], distances.iter().copied().fold(f64::INFINITY, f64::min));
        match leg.ending {
            Ending::Reached => assert!(last <= stop, "{what}: {last} m before it"),
            // The least distance is recorded once per cycle, and each time that it has fallen by 1 cm.
            Ending::Trapped(short) => {
                assert!(best > stop * 0.9 && short - best < 0.1 && short >= best, "{what}: {short}, {best}")
            }
            Ending::OnObstacle => assert!(last > stop, "{what}: {last}"),
        }
        let length: f64 = leg.way.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
        assert!((length - leg.length).abs() < 0.01 * leg.length + 0.01, "{what}: {length}, {}", leg.length);
    }
}

fn reached_targets(legs: &[Leg]) -> Vec<bool> {
    legs.iter().map(|leg| leg.ending == Ending::Reached).collect()
}

#[test]
fn forces_arrive_in_the_hall_and_are_trapped_in_the_house() {
    let (hall, house) = (floor("hall"), floor("house"));
    let [in_hall, in_house] = [&hall, &house].map(|floor| followed(floor, 300.0).0);
    for (known, what) in [(None, "unknown hall"), (Some(&in_hall), "hall")] {
        let mended = by_forces(&hall, known, true);
        check(&hall, &mended, 0.01, what);
        assert_eq!(reached_targets(&mended), [true; 4], "{what}");
        assert!(mended.iter().all(|leg| leg.refused == 0), "{what}: it pushes against something");
    }
    // The method as printed marks the bin as an obstacle while the robot stands at it.
    let printed = by_forces(&hall, None, false);
    check(&hall, &printed, 0.01, "unknown hall, as printed");
    assert_eq!(reached_targets(&printed), [true, true, false, true]);
    assert_eq!(printed[2].ending, Ending::OnObstacle);
    for (known, what) in [(None, "unknown house"), (Some(&in_house), "house")] {
        let mended = by_forces(&house, known, true);
        check(&house, &mended, 0.01, what);
        assert!(matches!(mended[0].ending, Ending::Trapped(short) if short > 5.0), "{what}: {:?}", mended[0].ending);
    }
}

/// Checks fields on the map that the follower draws, as in the source: cells that were not seen are solid. The number
/// of sweeps is close to the published one.
#[test]
fn fields_on_the_followers_map_take_about_the_published_sweeps_and_lead_to_the_targets() {
    let hall = floor("hall");
    let (map, _) = followed(&hall, 300.0);
    let is_solid = |k: usize| fields::is_solid(&map, k);
    let ratios: Vec<f64> = alves::rows_among(&is_solid)
        .iter()
        .map(|(_, count): &(_, row::Count)| count.measured.unwrap() / count.published)
        .collect();
    assert!(ratios.len() == 6 && ratios.iter().all(|ratio| (0.85..1.05).contains(ratio)), "{ratios:?}");
    let legs = by_fields(&hall, &|leg| Some(alves::harmonic(TARGETS[leg].1, &is_solid, &alves::STOPPING)?.values));
    check(&hall, &legs, 0.5, "harmonic");
    assert_eq!(reached_targets(&legs), [true; 4]);
}

/// Checks that around furniture, a field with the published tolerance leads nowhere, and a field with a smaller
/// tolerance leads to the target. The controller may circle about the target, slightly too far away to have reached it.
#[test]
fn around_furniture_the_published_tolerance_is_too_coarse() {
    let house = floor("house");
    let (map, _) = followed(&house, 300.0);
    let is_solid = |k: usize| fields::is_solid(&map, k);
    let [published, further] = [1e-8, 1e-26].map(|below| {
        let stopping = Stopping { below, ..alves::STOPPING };
        let legs = by_fields(&house, &|leg| Some(alves::harmonic(TARGETS[leg].1, &is_solid, &stopping)?.values));
        check(&house, &legs, 0.5, "harmonic");
        legs
    });
    assert_eq!(reached_targets(&published), [false, false, true, false]);
    assert_eq!(reached_targets(&further), [false, true, true, true]);
    for legs in [&published, &further] {
        assert!(matches!(legs[0].ending, Ending::Trapped(short) if short < 0.7), "{:?}", legs[0].ending);
    }
}

/// Checks cplan's own method with two of its planners. Each leg is checked every centimetre.
#[test]
fn the_explorer_reaches_every_target_of_both_rooms() {
    for name in ["hall", "house"] {
        let floor = floor(name);
        for (planner, choice) in planners().into_iter().filter(|(name, _)| ["shortest", "harmonic"].contains(name)) {
            let legs = explored(&floor, choice).unwrap_or_else(|e| panic!("{e}"));
            for ((scene, leg), (target, at)) in legs.iter().zip(TARGETS) {
                let what = format!("{name}, {planner}, to {target}");
                assert_eq!(leg.ending, explore::Ending::Reached, "{what}");
                let way = way(leg);
                assert!((way[way.len() - 1] - Point::from(at)).norm() < 1e-9, "{what}: it ends elsewhere");
                for pair in way.windows(2) {
                    let steps = ((pair[1] - pair[0]).norm() / 0.01).ceil().max(1.0);
                    let place = |k: usize| pair[0] + (pair[1] - pair[0]) * (k as f64 / steps);
                    assert!((0..=steps as usize).all(|k| gap(scene, place(k)) > 0.0), "{what}: it is in something");
                }
            }
        }
    }
}
