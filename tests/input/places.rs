//! Robots and obstacles that the world file places, compared with geometry that is written at that place.

use cplan::geometry::Point;
use cplan::input::{LoadedScene, Overrides, Source, scene_from};
use cplan::model::Shape;
use cplan::space::Configuration;
use cplan::{Options, Problem, plan};

const ROBOTS: [&str; 5] = ["planar_2r", "slide_arm", "polar", "gantry", "l_forearm"];

/// A translation (`AT`, metres) and a turn (`ANGLE`, radians) by which robots and worlds are moved.
const AT: [f64; 2] = [0.4, -1.3];
const ANGLE: f64 = 0.7;

fn placed([x, y]: [f64; 2]) -> [f64; 2] {
    let (sin, cos) = ANGLE.sin_cos();
    [AT[0] + cos * x - sin * y, AT[1] + sin * x + cos * y]
}

fn near(a: Point, b: [f64; 2]) -> bool {
    (a - Point::from(b)).norm() < 1e-12
}

fn scene(robot: &str, world: &str) -> LoadedScene {
    let file = format!("{}/robots/{robot}.urdf", env!("CARGO_MANIFEST_DIR"));
    let urdf = std::fs::read_to_string(file).unwrap();
    scene_from(Source::in_memory("arm.urdf", urdf), Source::in_memory("w.toml", world))
        .unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn a_robot_stands_where_the_world_puts_it() {
    for robot in ROBOTS {
        let own = scene(robot, "");
        let there = scene(robot, &format!("[robot]\nat = [{}, {}]\nangle = {ANGLE}\n", AT[0], AT[1]));
        let [own, there] = [own.scene.arm(), there.scene.arm()];
        for q in [[0.0, 0.0], [0.3, 0.2], [-0.9, 0.1]].map(|[a, b]| Configuration::new(a, b)) {
            let tip = own.tip_at(q);
            assert!(near(there.tip_at(q), placed([tip.x, tip.y])), "{robot}");
            for (link, (own_link, link_there)) in own.links.iter().zip(&there.links).enumerate() {
                for (part, part_there) in own_link.parts.iter().zip(&link_there.parts) {
                    for (p, p_there) in part.shape.core().iter().zip(part_there.shape.core()) {
                        let corner = own.pose(link, q).point(*p);
                        assert!(near(there.pose(link, q).point(*p_there), placed([corner.x, corner.y])), "{robot}");
                    }
                    assert_eq!(part.shape.radius(), part_there.shape.radius());
                }
            }
        }
    }
}

/// Checks that the plan stays the same if robot and obstacles are moved together, and that a placed obstacle equals one
/// whose corners are written at that place.
#[test]
fn robots_moved_with_their_world_plan_alike() {
    let ends = "[start]\njoints = [-0.9, 0.4]\n[goal]\njoints = [1.55, -0.35]\n";
    let shelf = [[1.15, 0.18], [1.6, 0.18], [1.6, 0.3], [1.15, 0.3]];
    let corners = |points: [[f64; 2]; 4]| points.map(|[x, y]| format!("[{x:?}, {y:?}]")).join(", ");
    let own = format!("{ends}[[obstacle]]\npolygon = [{}]\n", corners(shelf));
    let place = format!("at = [{:?}, {:?}]\nangle = {ANGLE:?}\n", AT[0], AT[1]);
    let robot = format!("[robot]\n{place}");
    let by_frame = format!("{ends}{robot}[[obstacle]]\n{place}polygon = [{}]\n", corners(shelf));
    let by_corners = format!("{ends}{robot}[[obstacle]]\npolygon = [{}]\n", corners(shelf.map(placed)));
    let planned = |world: &str| {
        let problem = Problem::of_scene(scene("planar_2r", world), &Overrides::default()).unwrap();
        plan(&problem, &Options::default()).unwrap()
    };
    let [own, by_frame, by_corners] = [own, by_frame, by_corners].map(|world| planned(&world));
    for moved in [&by_frame, &by_corners] {
        let [length, own_length] = [moved, &own].map(|plan| plan.length().unwrap());
        assert!((length - own_length).abs() < 1e-3 * own_length, "{length} {own_length}");
        let [clear, own_clear] = [moved, &own].map(|plan| plan.clearance().unwrap());
        assert!((clear - own_clear).abs() < 1e-3, "{clear} {own_clear}");
    }
    assert!((by_frame.length().unwrap() - by_corners.length().unwrap()).abs() < 1e-9);
}

#[test]
fn all_shapes_of_obstacles_can_be_put_somewhere() {
    let place = format!("at = [{:?}, {:?}]\nangle = \"90deg\"\n", AT[0], AT[1]);
    let world = format!(
        "[[obstacle]]\n{place}circle = {{ center = [1.0, 0.5], radius = 0.2 }}\n[[obstacle]]\n{place}polyline = [[0, 0], [1, 0]]\n\
         [[obstacle]]\n{place}polygon = [[[0, 0], [2, 0], [2, 2], [0, 2]], [[0.5, 0.5], [1, 0.5], [1, 1]]]\n"
    );
    let scene = scene("planar_2r", &world);
    let obstacles = &scene.scene.workspace().obstacles;
    // A quarter turn takes (x, y) to (-y, x).
    let turned = |[x, y]: [f64; 2]| [AT[0] - y, AT[1] + x];
    match [&obstacles[0].shape, &obstacles[1].shape] {
        [Shape::Circle { center, radius }, Shape::Polyline(points)] => {
            assert!(near(*center, turned([1.0, 0.5])) && *radius == 0.2);
            assert!(near(points[0], AT) && near(points[1], turned([1.0, 0.0])));
        }
        other => panic!("{other:?}"),
    }
    let covers = |p: [f64; 2]| {
        let point = cplan::geometry::Convex::disc(Point::from(turned(p)), 0.0).unwrap();
        obstacles[2].pieces.iter().any(|piece| cplan::geometry::separation(piece, &point).distance <= 0.0)
    };
    assert!(covers([1.5, 1.5]) && covers([0.2, 1.9]) && !covers([0.9, 0.7]) && !covers([2.1, 0.5]));
}

#[test]
fn a_robot_made_in_code_can_be_put_somewhere_but_not_read_otherwise() {
    let arm = cplan::Arm::rr([1.0, 0.8], 0.06).unwrap();
    let at =
        |robot: &str| cplan::input::scene_of(arm.clone(), Source::in_memory("w.toml", format!("[robot]\n{robot}\n")));
    let there = at("at = [1.0, 2.0]").unwrap();
    assert_eq!(there.scene.arm().tip_at(Configuration::new(0.0, 0.0)), Point::new(2.8, 2.0));
    assert!(
        at("at = [1.0, 2.0]\nbar = 0.1")
            .unwrap_err()
            .to_string()
            .contains("may have only `at`, `angle` and `calibration`")
    );
    assert!(at("at = [1.0]").unwrap_err().to_string().contains("expected two numbers, found 1"));
}
