//! Published robots. Each one plans in a small world, or is refused for the right reason.
//!
//! The files are not part of the project, so these tests are ignored by default.

use cplan::input::{Overrides, load_scene};
use cplan::model::OutlineSource::{self, Bar, Collision, Visual};
use cplan::{Options, Problem};
use cplan_check_files::check_files;
use cplan_testkit::reference::published;
use std::path::Path;

enum Outcome {
    /// Outcome of a robot that loads: kind of the arm, sources of the two outlines, and the tip's link.
    Loads(&'static str, [OutlineSource; 2], &'static str),
    /// Outcome of a robot that is refused: parts of the message.
    Refused(&'static [&'static str]),
}
use Outcome::{Loads, Refused};

const UNSET: &str = "limits = { joint1 = [-3.0, 3.0], joint2 = [-2.5, 2.5] }
                     velocity = { joint1 = 2.0, joint2 = 2.0 }";

/// Returns file, table `[robot]` and expected outcome of each case.
fn table() -> Vec<(&'static str, String, Outcome)> {
    let row = |file, robot: &str, outcome| (file, robot.to_owned(), outcome);
    vec![
        row(
            "bullet_pantilt",
            "",
            Refused(&["one common plane", "\"pan_joint\" turns about (0, 0, 1)", "90.00 degrees"]),
        ),
        row("bullet_test_joints_mb", "", Loads("RR", [Collision; 2], "DOF_Snodo2")),
        row("bullet_two_joint_w_fixed", "", Loads("RR", [Collision; 2], "link_23_cyl")),
        row("bullet_two_joint_wo_fixed", "", Loads("RR", [Collision; 2], "link_23_cyl")),
        row("dobot_mg400", "", Refused(&["4 movable joints", "\"j2_2\" mimics \"j2\"", "parallelogram", "joints = ["])),
        row(
            "dobot_mg400",
            "joints = [\"j2\", \"j3\"]",
            Refused(&["line ", "joint \"j3_1\" mimics joint \"j2\"", "parallelogram"]),
        ),
        row("drake_acrobot", "velocity = { shoulder = 8.0, elbow = 8.0 }", Loads("RR", [Collision; 2], "lower_link")),
        row("drake_acrobot", "", Loads("RR", [Collision; 2], "lower_link")),
        row(
            "drake_double_pendulum",
            "velocity = { shaft1 = 8.0, shaft2 = 8.0 }",
            Refused(&["links \"link1\" and \"link2\" have neither", "bar = 0.05"]),
        ),
        row(
            "drake_double_pendulum",
            "velocity = { shaft1 = 8.0, shaft2 = 8.0 }\nbar = 0.05",
            Loads("RR", [Bar; 2], "link2"),
        ),
        row("drake_pendulum_1dof", "", Refused(&["two joints", "only one movable joint, \"theta\" (continuous)"])),
        row("gepetto_asr_twodof", "", Refused(&["line ", "qb_c_flange_m.dae", "does not exist", "bar = "])),
        row("gepetto_asr_twodof", "bar = 0.03", Loads("RR", [Bar; 2], "Tip")),
        row(
            "gepetto_double_pendulum",
            "",
            Refused(&["joint \"joint1\" has no range", "limits = { joint1 = [-3.1, 3.1] }"]),
        ),
        row("gepetto_double_pendulum", UNSET, Refused(&["link1.stl\" does not exist", "ROS_PACKAGE_PATH"])),
        row("gepetto_double_pendulum", &format!("{UNSET}\nbar = 0.02"), Loads("RR", [Bar; 2], "link2")),
        row(
            "gepetto_double_pendulum_continuous",
            "velocity = { joint1 = 2.0, joint2 = 2.0 }\nbar = 0.02",
            Loads("RR", [Bar; 2], "link2"),
        ),
        row("gepetto_double_pendulum_simple", UNSET, Loads("RR", [Collision; 2], "link3")),
        row("icube_scara", "", Loads("RR", [Collision; 2], "tool0")),
        row("icube_scara", "joints = [\"joint1\", \"joint2\"]", Loads("RR", [Collision; 2], "tool0")),
        row("kawasaki_duaro1", "", Refused(&["8 movable joints", "\"upper_joint1\" (revolute)"])),
        row(
            "kawasaki_duaro1",
            "joints = [\"upper_joint1\", \"upper_joint2\"]\ntip = \"upper_link_j4\"\nbar = 0.06",
            Loads("RR", [Bar; 2], "upper_link_j4"),
        ),
        row("roma_scara", "", Refused(&["3 movable joints", "\"arm1_joint_Gelenk\" (revolute)"])),
        row(
            "roma_scara",
            "joints = [\"arm1_joint_Gelenk\", \"arm2_joint\"]",
            Refused(&["line ", "joint \"arm3_joint_box\" mimics joint \"arm1_joint_Gelenk\""]),
        ),
        row("ros2_control_rrbot", "", Loads("RR", [Collision; 2], "tool_link")),
        row("sorydi3_scara", "", Loads("RR", [Visual; 2], "tmp43")),
        row("sorydi3_scara", "joints = [\"theta1\", \"theta2\"]", Loads("RR", [Visual; 2], "tmp43")),
        row("sorydi3_theta_rho_RP", "", Loads("RP", [Visual; 2], "L2")),
        row("sorydi3_theta_theta_2R", "", Loads("RR", [Visual; 2], "L2")),
        row("yao_scara_solidworks", "", Refused(&["link2.STL\" does not exist"])),
        row(
            "yao_scara_solidworks",
            "joints = [\"joint2\", \"joint3\"]\ntip = \"link4\"\nfixed = { joint1 = -0.1 }\nbar = 0.04",
            Loads("RR", [Bar; 2], "link4"),
        ),
        row(
            "yao_scara_solidworks",
            "joints = [\"joint1\", \"joint2\"]",
            Refused(&["not perpendicular", "slides along (0, 0, -1)"]),
        ),
    ]
}

/// Checks that the motion planned for these files has a valid certificate.
fn is_certified(urdf: &Path, world: &Path, certificate: &Path) {
    let problem = Problem::load(urdf, world).unwrap();
    let plan = cplan::plan(&problem, &Options::default()).unwrap();
    std::fs::write(certificate, plan.certificate(&Overrides::default(), None).unwrap()).unwrap();
    let report = check_files(urdf, world, certificate).unwrap_or_else(|why| panic!("{}: {why}", urdf.display()));
    println!("  {report}");
}

#[test]
#[ignore = "needs the published data that CPLAN_REFERENCE names"]
fn published_robots_plan_or_are_refused_with_the_reason() {
    let folder = published("urdf");
    let work = tempfile::tempdir().unwrap();
    for (file, robot, outcome) in table() {
        let urdf = folder.join(format!("{file}.urdf"));
        let world = work.path().join("world.toml");
        // Start and goal are within the limits of every robot, and no robot reaches the obstacle.
        std::fs::write(
            &world,
            format!("[robot]\n{robot}\n[start]\njoints = [0.3, 0.4]\n[goal]\njoints = [0.5, 0.3]\n[[obstacle]]\ncircle = {{ center = [90, 0], radius = 1 }}\n"),
        )
        .unwrap();
        let loaded = load_scene(&urdf, &world);
        match (loaded, outcome) {
            (Ok(loaded), Loads(kind, sources, tip)) => {
                println!("{file} [{robot}]: loads\n  {}", loaded.robot.notes.join("\n  "));
                let arm = loaded.scene.arm();
                assert_eq!(arm.kind(), kind, "{file}");
                assert_eq!([arm.links[0].source, arm.links[1].source], sources, "{file}");
                assert_eq!(arm.tip_name, tip, "{file}");
                let loaded = loaded.problem(&Overrides::default()).unwrap_or_else(|e| panic!("{file}: {e}"));
                assert_eq!(loaded.problem.goals().pieces().len(), 1, "{file}");
                is_certified(&urdf, &world, &work.path().join("c.json"));
            }
            (Err(error), Refused(parts)) => {
                println!("{file} [{robot}]: refused\n{error}");
                for part in parts.iter().chain(&[file]) {
                    assert!(error.to_string().contains(part), "{file}: no \"{part}\" in: {error}");
                }
            }
            (Ok(_), Refused(_)) => panic!("{file} [{robot}] loads, but should be refused"),
            (Err(error), Loads(..)) => panic!("{file} [{robot}] should load: {error}"),
        }
    }
}

/// Checks the tutorial robot, which has an offset mount, tilted boxes and stacked heights. Its dimensions at the zero
/// configuration are known.
#[test]
#[ignore = "needs the published data that CPLAN_REFERENCE names"]
fn the_tutorial_scara_has_the_known_dimensions() {
    let folder = published("urdf");
    let work = tempfile::tempdir().unwrap();
    let world = work.path().join("world.toml");
    std::fs::write(&world, "[robot]\njoints = [\"joint1\", \"joint2\"]\n").unwrap();
    let arm = load_scene(folder.join("icube_scara.urdf"), &world).unwrap().scene.into_parts().0;
    assert!((arm.offset - cplan::geometry::Vector::new(0.425, 0.0)).norm() < 1e-12);
    // The tool extends 0.11 m along a z axis that was turned by 3.14, not by pi.
    let roll: f64 = 314.0 / 100.0;
    let aside = -0.11 * roll.sin();
    assert!((arm.tip - cplan::geometry::Vector::new(0.345, aside)).norm() < 1e-12);
    let tool = arm.links[1].parts.iter().find(|p| p.body == "link3").unwrap();
    // 0.05 + 0.4 + 0.05 + 0.05 - 0.11 up to the lowered slide, whose cylinder then points up.
    assert!((tool.heights.lower - 0.44).abs() < 1e-3 && (tool.heights.upper - 0.94).abs() < 1e-3, "{:?}", tool.heights);
}
