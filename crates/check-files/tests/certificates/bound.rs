//! Lower bounds written by hand, and falsified ones.

use crate::common::robots::{gantry, two_bars};
use crate::common::verdict::{code, fails, holds, judge};
use cplan_cases as random;
use cplan_cases::dice::Dice;

/// Returns the URDF of a square of 1 m that slides over 10 m by 10 m.
fn square() -> String {
    gantry([0, 10], r#"box size="1 1 1""#)
}

/// World with a wall from below the floor up to y = 7. The square passes it where y >= 7.5, for x from 3.5 to 6.5.
const WORLD: &str = "start.joints = [1, 1]\ngoal.joints = [9, 1]\n\
                     obstacle = [{ polygon = [[4, -1], [6, -1], [6, 7], [4, 7]] }]";

/// A wall of configurations from one to another, with the claimed potential at its upper end.
type Wall = ([f64; 2], [f64; 2], Option<f64>);
type Walls = Vec<Wall>;

fn certificate(length: f64, metric: &str, walls: &Walls) -> String {
    let wall = |(from, to, _): &Wall| format!(r#"{{"from": {from:?}, "to": {to:?}, "shape": 0, "part": 0}}"#);
    let potential = |(wall, (.., value)): (usize, &Wall)| {
        value.map(|value| format!(r#"{{"wall": {wall}, "end": 1, "value": {value}}}"#))
    };
    let closed = walls.iter().map(wall).collect::<Vec<_>>().join(", ");
    let potentials = walls.iter().enumerate().filter_map(potential).collect::<Vec<_>>().join(", ");
    format!(
        r#"{{"format": "cplan certificate 1", "answer": "no_shorter",
             "shapes": [{{"link": "head", "collision": 0}}],
             "parts": [{{"obstacle": 0, "corners": [[4, -1], [6, -1], [6, 7], [4, 7]]}}],
             "bound": {{"to": [9, 1], "length": {length}, "metric": {metric}, "walls": [{closed}], "potentials": [{potentials}]}}}}"#
    )
}

const EUCLIDEAN: &str = r#""euclidean""#;

/// Returns a bound and the walls that prove it. The bound is the length of the path over the corners (3.6, 7.4) and
/// (6.4, 7.4), reduced slightly.
fn length_and_walls() -> (f64, Walls) {
    let rise = 2.6_f64.hypot(6.4);
    let walls = vec![([3.6, -1.0], [3.6, 7.4], Some(rise - 1e-9)), ([6.4, -1.0], [6.4, 7.4], Some(rise + 2.8 - 2e-9))];
    (2.0 * rise + 2.8 - 3e-9, walls)
}

#[test]
fn paths_around_a_wall_are_bounded_by_its_corners() {
    let (length, walls) = length_and_walls();
    let of = |length: f64, walls: &Walls| code(&square(), WORLD, &certificate(length, EUCLIDEAN, walls));
    assert_eq!(
        holds(judge(&square(), WORLD, &certificate(16.5, EUCLIDEAN, &walls))),
        "no motion of \"x\" and \"y\" from the start to (9, 1) with clearance 0 is shorter than 16.5"
    );
    assert_eq!(of(length, &walls), 0);
    assert_eq!(of(length + 1e-8, &walls), 3, "this is the length of the last leg");
    // Without walls only the straight path is known; with one wall, the path around that.
    assert_eq!((of(8.0, &vec![]), of(8.001, &vec![])), (0, 3));
    let past = 2.6_f64.hypot(6.4);
    let one = vec![([3.6, -1.0], [3.6, 7.4], Some(past - 1e-9))];
    let shorter = past + 5.4_f64.hypot(6.4) - 1e-8;
    assert_eq!((of(shorter, &one), of(shorter + 1e-7, &one)), (0, 3));
    // A potential that is too high. One that is at least the length minus the rest has no effect, and is accepted.
    for change in [1e-6, 1.0] {
        for (k, code) in [(0, 3), (1, 0)] {
            let mut other = walls.clone();
            other[k].2 = other[k].2.map(|value| value + change);
            assert_eq!(of(length, &other), code, "{k} {change}");
        }
    }
    // A wall that extends to where the square is free.
    for (k, x, y) in [(0, 3.6, 7.51), (0, 3.49, 7.4), (1, 6.51, 7.4)] {
        let mut other = walls.clone();
        (other[k].0[0], other[k].1) = (x, [x, y]);
        let why = format!("wall {k}: the shape does not touch the part along the whole wall");
        fails(judge(&square(), WORLD, &certificate(1.0, EUCLIDEAN, &other)), &why);
    }
    // Only the limit of y blocks the path below the floor.
    let higher = square().replacen(r#"lower="0""#, r#"lower="-9""#, 2);
    assert_eq!(code(&higher, WORLD, &certificate(length, EUCLIDEAN, &walls)), 3);
}

#[test]
fn other_metrics_measure_their_own_lengths() {
    let (_, mut walls) = length_and_walls();
    // With half the weight for y: 2.6 and 3.2, and so on.
    let rise = 2.6_f64.hypot(3.2);
    (walls[0].2, walls[1].2) = (Some(rise - 1e-9), Some(rise + 2.8 - 2e-9));
    let of = |length: f64, metric: &str, walls: &Walls| code(&square(), WORLD, &certificate(length, metric, walls));
    let length = 2.0 * rise + 2.8 - 3e-9;
    let weights = r#"{"weights": [1, 0.5]}"#;
    assert_eq!((of(length, weights, &walls), of(length + 1e-8, weights, &walls)), (0, 3));
    assert_eq!(of(length, EUCLIDEAN, &walls), 0, "Euclidean ways are longer still");
    // Seconds at 1 and 2 m/s: 3.2, 2.8 and 3.2.
    (walls[0].2, walls[1].2) = (Some(3.2 - 1e-9), Some(6.0 - 2e-9));
    let speeds = r#"{"speeds": [1, 2]}"#;
    assert_eq!((of(9.2 - 3e-9, speeds, &walls), of(9.2 + 1e-8, speeds, &walls)), (0, 3));
    for wrong in [r#"{"weights": [1, 0]}"#, r#"{"speeds": [-1, 2]}"#] {
        assert_eq!(of(1.0, wrong, &walls), 3, "{wrong}");
    }
    assert_eq!(of(1.0, r#""taxi""#, &walls), 1);
}

/// Tests a bar of 1 m on a continuous joint, and a rod that slides out of its end. On the circle, paths lead around
/// both sides.
#[test]
fn paths_on_a_circle_lead_round_both_sides() {
    let arm = r#"<robot name="p">
  <link name="base"/>
  <joint name="q" type="continuous"> <parent link="base"/> <child link="bar"/> <axis xyz="0 0 1"/> </joint>
  <link name="bar"> <collision> <origin xyz="0.5 0 0"/> <geometry> <box size="1 0.2 0.1"/> </geometry> </collision> </link>
  <joint name="d" type="prismatic">
    <parent link="bar"/> <child link="rod"/> <axis xyz="1 0 0"/> <limit lower="-1" upper="1"/>
  </joint>
  <link name="rod"/>
</robot>"#;
    // A post that the bar cannot pass: at q = 0, and at q = 3 for the other direction.
    let world = |posts: &str| format!("start.joints = [-1, 0]\ngoal.joints = [1.5, 0]\nobstacle = [{posts}]");
    let post = "{ circle = { center = [0.9, 0.0], radius = 0.05 } }";
    let certificate = |length: f64| {
        format!(
            r#"{{"format": "cplan certificate 1", "answer": "no_shorter", "shapes": [{{"link": "bar", "collision": 0}}],
                 "parts": [{{"obstacle": 0}}],
                 "bound": {{"to": [1.5, 0], "length": {length}, "walls": [{{"from": [0, -1], "to": [0, 1], "shape": 0, "part": 0}}], "potentials": []}}}}"#
        )
    };
    let round = std::f64::consts::TAU - 2.5;
    assert_eq!(code(arm, &world(post), &certificate(round - 1e-9)), 0);
    assert_eq!(code(arm, &world(post), &certificate(round + 1e-9)), 3);
    // The same wall, written a whole turn further.
    let turned = certificate(round - 1e-9)
        .replace("[0, -1]", "[6.283185307179586, -1]")
        .replace("[0, 1]", "[6.283185307179586, 1]");
    assert_eq!(code(arm, &world(post), &turned), 0);
    // Even extreme lengths must be refused.
    for length in ["1e9", "1e300", "-1"] {
        let of = certificate(1.0).replace(r#""length": 1,"#, &format!(r#""length": {length},"#));
        assert_eq!(code(arm, &world(post), &of), if length == "-1" { 0 } else { 3 }, "{length}");
    }
}

/// Tests random walls, potentials and lengths. A bound that the checker accepts must not exceed the true optimum, which
/// leads over the two corners of the C-obstacle.
#[test]
fn bounds_above_the_optimum_are_refused() {
    let optimum = 2.0 * 2.5_f64.hypot(6.5) + 3.0;
    let (mut held, mut longest) = (0, 0.0_f64);
    for seed in random::seeds(300) {
        let mut random = Dice::new(seed);
        let (length, mut walls) = length_and_walls();
        let length = length * random.within(0.9, 1.1);
        for (from, to, potential) in &mut walls {
            let x = from[0] + random.within(-0.2, 0.2);
            (from[0], *to) = (x, [x + random.within(-0.1, 0.1), 7.4 + random.within(-0.3, 0.2)]);
            *potential =
                potential.map(|value| value * random.within(0.9, 1.05)).filter(|_| random.within(0.0, 1.0) < 0.9);
        }
        if code(&square(), WORLD, &certificate(length, EUCLIDEAN, &walls)) == 0 {
            assert!(length <= optimum, "{length}: {walls:?}");
            (held, longest) = (held + 1, longest.max(length));
        }
    }
    assert!(held > random::times(10) && longest > 0.9 * optimum, "{held} {longest}");
}

/// Returns the URDF of two bars of 1 m. The second collides.
fn arm() -> String {
    let short = two_bars().replacen("collision", "lamp", 2).replace("size=\"0.8", "size=\"1");
    short.replace("0.4 0 0", "0.5 0 0").replace("0.8 0 0", "1 0 0")
}

/// Tests a goal for the tip at (1, 1). The elbow is at (1, 0) or at (0, 1), with the joint values (0, pi/2) or (pi/2,
/// -pi/2).
#[test]
fn bounds_to_a_tip_position_hold_for_all_ik_solutions() {
    let world = |place: &str| {
        format!(
            "start.joints = [0, 1]\ngoal.tip = {place}\nobstacle = [{{ circle = {{ center = [1, 0.5], radius = 0.1 }} }}]"
        )
    };
    let certificate = |length: f64, boxes: &str| {
        format!(
            r#"{{"format": "cplan certificate 1", "answer": "no_shorter", {boxes}
                 "shapes": [{{"link": "fore", "collision": 0}}], "parts": [{{"obstacle": 0}}],
                 "bound": {{"length": {length}, "walls": [], "potentials": []}}}}"#
        )
    };
    let of = |place: &str, length: f64, boxes: &str| code(&arm(), &world(place), &certificate(length, boxes));
    let quarter = std::f64::consts::FRAC_PI_2;
    let (near, far) = (quarter - 1.0, quarter.hypot(quarter + 1.0));
    assert_eq!((of("[1, 1]", near - 1e-9, ""), of("[1, 1]", near + 1e-9, "")), (0, 3));
    // The nearer solution is inside the disc.
    let about = |half: f64| {
        format!(
            r#""boxes": [{{"lower": [{}, {}], "upper": [{half}, {}], "shape": 0, "part": 0}}],"#,
            -half,
            quarter - half,
            quarter + half
        )
    };
    let stuck = about(0.02);
    assert_eq!((of("[1, 1]", far - 1e-9, &stuck), of("[1, 1]", far + 1e-9, &stuck)), (0, 3));
    assert_eq!(of("[1, 1]", near, &about(0.1)), 3, "it comes off the disc there");
    assert_eq!(of("[1, 1]", far - 1e-9, &about(1e-14)), 3, "the box is no larger than what is not known");
    let report = holds(judge(&arm(), &world("[1, 1]"), &certificate(3.0, &stuck)));
    assert_eq!(
        report,
        "no motion of \"a\" and \"b\" from the start to the goal, a position of the tip \"tool\", with clearance 0 is shorter than 3"
    );
    // Stretched out, the two solutions become one, which is known less precisely. Out of reach there is no path at all.
    assert_eq!((of("[2, 0]", 0.8, ""), of("[2, 0]", 1.0 + 1e-9, ""), of("[2.1, 0]", 100.0, "")), (0, 3, 0));
    // With the tip on the first axis, the first joint is free, and the second is at half a turn, outside the limits.
    assert_eq!(of("[0, 0]", 100.0, ""), 0);
    let wide = arm().replace("2.9", "3.2");
    let of = |length: f64| code(&wide, &world("[0, 0]"), &certificate(length, ""));
    let near = 2.0 * quarter - 1.0;
    assert_eq!((of(near - 0.4), of(near + 1e-9)), (0, 3));
    // With an explicit target, boxes are not allowed.
    let report = certificate(1.0, &stuck).replace("\"length\"", "\"to\": [1, 1], \"length\"");
    assert_eq!(code(&arm(), &world("[1, 1]"), &report), 1);
}
