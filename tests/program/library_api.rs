//! The library's entry point: the output of `plan` equals that of the program, byte for byte.

use crate::cli::Place;
use crate::cli::shipped;
use cplan::PlanOutput as _;
use cplan::engine::Method;
use cplan::engine::explain::{MotionQuestion, TIME_LIMIT, explain, with_explanation};
use cplan::geometry::{Convex, SimplePolygon, penetration_depth, polygon_test};
use cplan::{
    Arm, Configuration, Criterion, Obstacle, Options, Outcome, Plan, PlanError, Planner, Point, Problem, Refutation,
    Status, Workspace, plan,
};

/// Robots, worlds, and the expected status of each: motions, a proof, tasks.
const WORLDS: [(&str, &str, Status); 5] = [
    ("robots/planar_2r.urdf", "workspaces/shelf.toml", Status::Found),
    ("robots/scara.urdf", "workspaces/scara_cell.toml", Status::Found),
    ("robots/planar_2r.urdf", "workspaces/singular_closed.toml", Status::Infeasible),
    ("robots/scara.urdf", "workspaces/tasks/table_mission.toml", Status::Found),
    ("robots/planar_2r.urdf", "workspaces/u_trap.toml", Status::Found),
];

/// Returns the page of an infeasible problem with its explanation.
fn page_with_explanation(plan: &Plan) -> String {
    let question = MotionQuestion::from(plan.motion().unwrap().0);
    let explanation = explain(&question.with_time_limit(TIME_LIMIT), &Options::default());
    let view = with_explanation(plan.view_with_replay(), &explanation);
    String::from_utf8(cplan::output::PictureFormat::Html.bytes(&view).unwrap()).unwrap()
}

#[test]
fn the_program_writes_what_the_library_gives() {
    for (robot, world, status) in WORLDS {
        let (robot, world) = (shipped(robot), shipped(world));
        let place = Place::new();
        let outputs = "--quiet --output a.json --output a.csv --output a.yaml --picture a.svg --picture a.html";
        let done = place.run(&[&robot, &world], outputs);
        let made = plan(&Problem::load(&robot, &world).unwrap(), &Options::default()).unwrap();
        assert_eq!(made.status(), status, "{world}");
        assert_eq!(done.code, if status == Status::Found { 0 } else { 3 }, "{world}: {}", done.stderr);
        for file in ["a.json", "a.csv", "a.yaml", "a.svg", "a.html"] {
            let (theirs, ours) = (place.path(file), place.path(&format!("library_{file}")));
            let saved = made.save(&ours);
            assert_eq!(saved.is_ok(), theirs.exists(), "{world}: {file}");
            if theirs.exists() {
                // On a page of an infeasible problem, the program also shows the command that explains it.
                let theirs = std::fs::read_to_string(&theirs).unwrap();
                let hint = theirs.find(",[\"hint\",").filter(|_| file.ends_with(".html"));
                let theirs = hint.map_or(theirs.clone(), |at| {
                    let end = at + theirs[at..].find(']').unwrap() + 1;
                    theirs[..at].to_owned() + &theirs[end..]
                });
                assert_eq!(hint.is_some(), file.ends_with(".html") && status == Status::Infeasible, "{world}: {file}");
                let ours = match hint {
                    // It also explains the problem there.
                    Some(_) => page_with_explanation(&made),
                    None => std::fs::read_to_string(&ours).unwrap(),
                };
                assert!(theirs == ours, "{world}: {file}");
            }
        }
        assert_eq!(made.to_json(), place.read("a.json"), "{world}");
        assert_eq!(made.svg(), place.read("a.svg"), "{world}");
        let output = place.run(&[&robot, &world], "").stdout;
        // The times differ, and only the program knows the names of the files for its hint.
        let is_shared = |line: &&str| !line.starts_with("time ") && !line.starts_with("hint ");
        let lines = |text: &str| text.lines().filter(is_shared).map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(lines(&made.summary()), lines(&output), "{world}");
        assert!(lines(&output).len() > 4 && output.starts_with("result "), "{output}");
    }
}

#[test]
fn options_are_those_of_the_command_line() {
    let (robot, world) = (shipped("robots/planar_2r.urdf"), shipped("workspaces/shelf.toml"));
    let problem = Problem::load(&robot, &world).unwrap();
    let named = |name: &str| Planner::named(name.parse().unwrap());
    let criterion = Criterion::Weighted([1.0, 0.5]);
    for (words, planner) in [
        ("--planner first", named("first")),
        ("--planner wavefront --cells 128", named("wavefront").with_cells(128)),
        ("--planner trapezoid --path own", named("trapezoid").with_path(cplan::planner::PathKind::Own)),
        ("--planner harmonic", named("harmonic")),
        ("--metric weighted --weights 1,0.5 --gap 0.01", named("shortest").with_criterion(criterion).with_gap(0.01)),
    ] {
        let output = Place::new().run(&[&robot, &world], &format!("{words} --json"));
        let made = plan(&problem, &Options { planner, ..Options::default() }).unwrap();
        assert_eq!(output.stdout, made.to_json(), "{words}");
    }
}

#[test]
fn a_plan_is_a_value() {
    fn is_value<T: Send + Sync + Clone>() {}
    is_value::<Plan>();
    is_value::<Problem>();
    is_value::<Options>();
}

#[test]
fn an_outcome_is_one_of_three() {
    let load = |world: &str| Problem::load(shipped("robots/planar_2r.urdf"), shipped(world)).unwrap();
    let found = plan(&load("workspaces/shelf.toml"), &Options::default()).unwrap();
    let Outcome::Found(motion) = found.outcome() else { panic!("shelf has a path") };
    assert!(motion.duration() > 1.0 && found.trajectory() == Some(motion));
    let closed = plan(&load("workspaces/singular_closed.toml"), &Options::default()).unwrap();
    let Outcome::Infeasible(Refutation::Motion(proof)) = closed.outcome() else { panic!("it is closed") };
    assert!(!proof.collision_boxes().is_empty() && closed.trajectory().is_none());
    // A single attempt with eight cells finds nothing, and a wave proves nothing.
    let coarse = Options { planner: Planner::named(Method::Wavefront).with_cells(8), levels: 1, ..Options::default() };
    let unknown = plan(&load("workspaces/shelf.toml"), &coarse).unwrap();
    assert!(matches!(unknown.outcome(), Outcome::Unknown(why) if !why.is_empty()), "{:?}", unknown.status());
}

#[test]
fn invalid_input_is_refused_by_name() {
    let problem = Problem::load(shipped("robots/planar_2r.urdf"), shipped("workspaces/shelf.toml")).unwrap();
    let shortest = Planner::named(Method::Shortest);
    let plain = Options::default();
    let mut options = vec![
        ("levels", Options { levels: 0, ..plain }),
        ("levels", Options { levels: 13, ..plain }),
        ("gap", Options { planner: shortest.with_gap(f64::NAN), ..plain }),
        ("gap", Options { planner: shortest.with_gap(0.0), ..plain }),
        ("margin", Options { planner: shortest.with_margin(-1e-3), ..plain }),
        ("margin", Options { planner: shortest.with_margin(f64::NAN), ..plain }),
        ("jerk", Options { jerk: Some([Some(-1.0), None]), ..plain }),
    ];
    let weights = Planner::named(Method::Visibility).with_criterion(Criterion::Weighted([1.0, -1.0]));
    options.push(("weights", Options { planner: weights, ..plain }));
    for period in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let mut wrong = plain;
        wrong.drive.period = period;
        options.push(("period", wrong));
    }
    for (name, options) in options {
        let refused = plan(&problem, &options).expect_err(name);
        assert!(matches!(&refused, PlanError::Options(why) if why.contains(name)), "{name}: {refused}");
    }
    let task = Problem::load(shipped("robots/scara.urdf"), shipped("workspaces/tasks/table_mission.toml")).unwrap();
    let refused = plan(&task, &Options { planner: shortest.with_gap(0.01), ..plain }).expect_err("a gap of a task");
    assert!(refused.to_string().contains("--gap does not apply to worlds with steps"), "{refused}");
}

#[test]
fn files_that_cannot_be_written_are_refused() {
    let problem = Problem::load(shipped("robots/planar_2r.urdf"), shipped("workspaces/singular_closed.toml")).unwrap();
    let made = plan(&problem, &Options::default()).unwrap();
    let place = Place::new();
    for (file, part) in [("a.txt", "must end in"), ("a.csv", "no trajectory"), ("missing/a.json", "missing")] {
        let refused = made.save(place.path(file)).expect_err(file);
        assert!(refused.to_string().contains(part), "{file}: {refused}");
        assert!(!place.path(file).exists());
    }
}

/// Checks an arm with two bars and continuous joints. Only the stretched arm reaches the wall.
#[test]
fn an_arm_and_a_world_in_code() {
    let arm = || Arm::rr([1.0, 0.5], 0.1).unwrap();
    let wall = || Obstacle::polygon("wall", [[1.2, -0.2], [1.6, -0.2], [1.6, 0.2], [1.2, 0.2]]).unwrap();
    let world = || Workspace::new([wall(), Obstacle::circle("post", [-0.4, 0.9], 0.1).unwrap()]);
    let problem = Problem::new(arm(), world(), [0.8, 0.0], [-0.8, 0.0]).unwrap();
    let made = plan(&problem, &Options::default()).unwrap();
    let Outcome::Found(motion) = made.outcome() else { panic!("the arm can fold") };
    let reached = motion.position.last().unwrap();
    assert!((reached[0] + 0.8).abs() < 1e-9 && reached[1].abs() < 1e-9, "{reached:?}");
    // The stretched arm cannot pass the wall: link 2 has to fold, so the path is longer than the straight one.
    assert!(made.length().unwrap() > 1.6 + 1e-3);
    let blocked = Problem::new(arm(), world(), [0.0, 0.0], [-0.8, 0.0]).expect_err("in the wall");
    assert!(blocked.to_string().contains("wall"), "{blocked}");
    for (lengths, width, message) in [
        ([1.0, f64::NAN], 0.1, "the length is NaN, but must be finite and greater than 0"),
        ([f64::INFINITY, 1.0], 0.1, "the length is inf, but must be finite and greater than 0"),
        ([1.0, 1.0], -0.1, "its radius is -0.05"),
    ] {
        assert_eq!(Arm::rr(lengths, width).unwrap_err().to_string(), message);
    }
    assert_eq!(Obstacle::polyline("none", []).unwrap_err().to_string(), "it has no corner");
    let point = Obstacle::polyline("pin", [[0.5, 0.0]]).unwrap();
    assert!(Problem::new(arm(), Workspace::new([point]), [0.0, 0.0], [1.0, 0.0]).is_err(), "a point is solid");
    let round = Configuration::new(0.0, 0.0);
    assert_eq!(Problem::new(arm(), Workspace::new([]), round, round).unwrap().motion().unwrap().start(), round);
}

/// Checks contact, depth and difference of squares, which have closed forms.
#[test]
fn predicates_and_differences_in_code() {
    let square = |x: f64, y: f64, half: f64| {
        let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
        Convex::new(corners.map(|[dx, dy]| Point::new(x + dx, y + dy)).to_vec(), 0.0).unwrap()
    };
    let (mut apart, mut together) = (0, 0);
    for (i, j) in (0..15).flat_map(|i| (0..15).map(move |j| (i, j))) {
        let (x, y, half) = (0.21 * f64::from(i) - 1.45, 0.19 * f64::from(j) - 1.33, 0.1037 + 0.0203 * f64::from(i + j));
        let (a, b) = (square(0.0, 0.0, 0.5), square(x, y, half));
        let depth = 0.5 + half - x.abs().max(y.abs());
        let meet = depth > 0.0;
        *(if meet { &mut together } else { &mut apart }) += 1;
        assert_eq!(polygon_test(&a, &b).meet, meet, "{x} {y} {half}");
        let found = penetration_depth(&a, &b);
        let [dx, dy] = [x, y].map(|offset| (offset.abs() - 0.5 - half).max(0.0));
        let expected = if meet { depth } else { -dx.hypot(dy) };
        assert!((found - expected).abs() < 1e-12, "{x} {y} {half}: {found} {expected}");
        let difference = SimplePolygon::new(b.minkowski_difference(&a).core().to_vec()).unwrap();
        assert!((difference.area() - (1.0 + 2.0 * half).powi(2)).abs() < 1e-9);
        assert_eq!(difference.contains(Point::zeros()), meet, "{x} {y} {half}");
    }
    assert!(apart > 20 && together > 20, "{apart} {together}");
}
