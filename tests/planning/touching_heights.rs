//! Heights of the arm that touch those of an obstacle are a contact, and all commands give this answer.

use cplan::engine::Method;
use cplan::input::Overrides;
use cplan::model::Status;
use cplan::{Options, plan};
use cplan_check_files::check;
use cplan_testkit::judged::{Question, judge};
use cplan_testkit::problems::problem_of_texts;

/// Middles and thicknesses of link 2, and tops of the obstacle below it. Their heights touch, and few of the sums are exact
/// in doubles.
const TOUCHING: [[f64; 3]; 6] =
    [[0.35, 0.1, 0.3], [0.3, 0.2, 0.2], [0.8, 0.2, 0.7], [0.15, 0.06, 0.12], [1.1, 0.6, 0.8], [0.45, 0.22, 0.34]];

/// Returns an arm whose link 2 is a bar about the height `middle`.
fn arm(middle: f64, thickness: f64) -> String {
    let bar = |name: &str, middle: f64, thickness: f64| {
        format!(
            "<link name=\"{name}\"><collision><origin xyz=\"0.2 0 {middle}\"/><geometry><box size=\"0.4 0.02 {thickness}\"/>\
             </geometry></collision></link>"
        )
    };
    let joint = |name: &str, kind: &str, parent: &str, child: &str, x: f64| {
        format!(
            "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>\
             <origin xyz=\"{x} 0 0\"/><axis xyz=\"0 0 1\"/><limit lower=\"-2.5\" upper=\"2.5\" effort=\"1\" velocity=\"2\"/></joint>"
        )
    };
    [
        "<robot name=\"t\"><link name=\"base\"/>".to_owned(),
        bar("upper", 2.0, 0.02),
        bar("fore", middle, thickness),
        "<link name=\"tip\"/>".to_owned(),
        joint("j1", "revolute", "base", "upper", 0.0),
        joint("j2", "revolute", "upper", "fore", 0.4),
        joint("t", "fixed", "fore", "tip", 0.4),
        "</robot>".to_owned(),
    ]
    .concat()
}

/// Returns a world in which link 2 must pass an obstacle, or pass over it.
fn world(top: f64) -> String {
    format!(
        "[start]\njoints = [-1.0, 0.2]\n[goal]\njoints = [1.0, 0.2]\n\
         [[obstacle]]\npolygon = [[0.35, -0.1], [0.6, -0.1], [0.6, 0.1], [0.35, 0.1]]\nheight = [0.0, {top}]\n"
    )
}

#[test]
fn touching_heights_are_a_proven_contact() {
    for [middle, thickness, top] in TOUCHING {
        for (gap, status, verdict) in [(0.0, Status::Infeasible, "collision"), (1e-6, Status::Found, "free")] {
            let (urdf, world) = (arm(middle, thickness), world(top - gap));
            let problem = problem_of_texts(&urdf, &world).unwrap();
            let answer = plan(&problem, &Options::from(Method::First)).unwrap();
            let at = format!("{middle} {thickness} {top} {gap}");
            assert_eq!(answer.status(), status, "{at}");
            let certificate = answer.certificate(&Overrides::default(), None).unwrap();
            let checked = check(&urdf, &world, &certificate);
            assert!(checked.is_ok(), "{at}: {:?}", checked.err());

            let folder = tempfile::tempdir().unwrap();
            let [robot, file, motion] = ["arm.urdf", "world.toml", "motion.csv"].map(|name| folder.path().join(name));
            std::fs::write(&robot, &urdf).unwrap();
            std::fs::write(&file, &world).unwrap();
            std::fs::write(&motion, "time,j1,j2\n0,-1,0.2\n1,0,0.2\n2,1,0.2\n").unwrap();
            let findings = judge(&robot, &file, &motion, &Question::default()).unwrap();
            assert_eq!(findings["verdict"], verdict, "{at}");
            let is_free = problem.scene().obstructions(cplan::Configuration::new(0.0, 0.2)).is_empty();
            assert_eq!(is_free, verdict == "free", "{at}");
        }
    }
}

/// A proof about touching heights must not hold for heights that are apart.
#[test]
fn proofs_about_touching_heights_fail_for_heights_that_are_apart() {
    for [middle, thickness, top] in TOUCHING {
        let urdf = arm(middle, thickness);
        let problem = problem_of_texts(&urdf, &world(top)).unwrap();
        let answer = plan(&problem, &Options::from(Method::First)).unwrap();
        let certificate = answer.certificate(&Overrides::default(), None).unwrap();
        let apart = check(&urdf, &world(top - 1e-8), &certificate);
        assert!(format!("{apart:?}").contains("passes over or under the obstacle"), "{apart:?}");
    }
}
