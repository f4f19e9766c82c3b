//! Areas in which preferences apply.

use cplan::cspace::{Grid, Proves, ZonedGrid};
use cplan::geometry::{Point, SimplePolygon};
use cplan::model::{Arm, Preference, Region, Workspace};
use cplan::space::JointRange;
use cplan_testkit::arms::rr;
use cplan_testkit::scenes::{placed, q};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

fn rectangle([x0, x1]: [f64; 2], [y0, y1]: [f64; 2]) -> SimplePolygon {
    SimplePolygon::new([(x0, y0), (x1, y0), (x1, y1), (x0, y1)].map(|(x, y)| Point::new(x, y)).to_vec()).unwrap()
}

fn preference(name: &str, region: Region) -> Preference {
    Preference { name: name.into(), region, epsilon: 0.5, direction: None }
}

fn torus() -> Arm {
    rr([JointRange::Circle; 2])
}

proptest! {
    #![proptest_config(cplan_cases::cases(256))]

    /// Checks that a rectangle of angles applies if it contains some copy of the configuration.
    #[test]
    fn a_region_of_angles_holds_for_every_copy(
        first in (-10.0..10.0_f64, 0.1..5.0_f64),
        second in (-10.0..10.0_f64, 0.1..5.0_f64),
        at in [-PI..PI, -PI..PI],
    ) {
        let region = Region::Configurations(rectangle([first.0, first.0 + first.1], [second.0, second.0 + second.1]));
        let within = |value: f64, (from, width): (f64, f64)| (value - from).rem_euclid(TAU) <= width;
        let expected = within(at[0], first) && within(at[1], second);
        prop_assert_eq!(preference("p", region).holds_at(&torus(), q(at[0], at[1])), expected);
    }

    /// Checks that a region of the workspace applies if it contains the tip.
    #[test]
    fn a_region_of_the_workspace_holds_for_the_tip(at in [-PI..PI, -PI..PI], corner in [-2.0..1.0_f64, -2.0..1.0_f64]) {
        let arm = torus();
        let region = Region::Tip(rectangle([corner[0], corner[0] + 1.0], [corner[1], corner[1] + 1.0]));
        // Both joints turn counter-clockwise, the elbow first.
        let (upper, fore) = (arm.offset.x, arm.tip.x);
        prop_assert_eq!((arm.offset.y, arm.tip.y), (0.0, 0.0));
        let sum = at[0] + at[1];
        let tip = [upper * at[0].cos() + fore * sum.cos(), upper * at[0].sin() + fore * sum.sin()];
        let depth = [0, 1].map(|k| (tip[k] - arm.base[k] - corner[k]).min(corner[k] + 1.0 - tip[k]));
        prop_assume!(depth[0].abs() > 1e-9 && depth[1].abs() > 1e-9);
        let expected = depth[0] > 0.0 && depth[1] > 0.0;
        prop_assert_eq!(preference("p", region).holds_at(&arm, q(at[0], at[1])), expected);
    }
}

#[test]
fn the_last_of_overlapping_regions_counts() {
    let arm = torus();
    let topology = arm.topology();
    let preferences = vec![
        preference("wide", Region::Configurations(rectangle([0.0, 2.0], [0.0, 2.0]))),
        preference("narrow", Region::Configurations(rectangle([1.0, 2.0], [1.0, 2.0]))),
    ];
    let scene = placed(arm, Workspace { name: "w".into(), obstacles: Vec::new(), clearance: 0.0, preferences });
    let grid = Grid { topology, proves: Proves::Sampled, cells: [64, 64], blocked: vec![false; 64 * 64] };
    let zoned = ZonedGrid::new(grid, &scene);
    let name = |a: f64, b: f64| zoned.zone(zoned.grid.locate(q(a, b))).map(|zone| zone.name.as_str());
    assert_eq!(name(0.5, 0.5), Some("wide"));
    assert_eq!(name(1.5, 0.5), Some("wide"));
    assert_eq!(name(1.5, 1.5), Some("narrow"));
    assert_eq!(name(-0.5, 0.5), None);
}
