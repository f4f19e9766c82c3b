//! Stored problems and plans. They are the same after writing and reading, and the reader refuses problems that nobody
//! could plan.

use cplan::engine::{Searches, StoredPlan, restored};
use cplan::geometry::{Convex, Pose};
use cplan::input::RobotReport;
use cplan::model::{Heights, MotionProblem, Scene, Task};
use cplan::{Arm, Obstacle, Options, Outcome, Plan, Planner, Problem, Status, Workspace, plan};
use cplan_testkit::shipped;
use serde_json::{Value, json};

/// Returns every shipped world with the robot that it names, in the order of their names.
fn shipped_problems() -> Vec<(String, Problem)> {
    let worlds = shipped::worlds("").into_iter().chain(shipped::worlds("tasks"));
    let problems: Vec<_> = worlds.map(|world| (world.name.clone(), world.problem())).collect();
    assert!(problems.len() >= 40, "only {} worlds", problems.len());
    problems
}

fn world(name: &str) -> Problem {
    shipped::world(name).problem()
}

/// Returns the data as JSON, as in a file.
fn value(data: &impl serde::Serialize) -> Value {
    serde_json::from_str(&serde_json::to_string(data).unwrap()).unwrap()
}

/// Returns the plan that a text stores.
fn read(text: &str) -> Result<Plan, Box<dyn std::error::Error>> {
    let stored: StoredPlan = serde_json::from_str(text)?;
    Ok(restored(&stored)?)
}

/// Returns the error for a stored plan.
fn refusal_of(stored: Value) -> String {
    read(&stored.to_string()).expect_err("a plan that no planning makes").to_string()
}

/// Returns data in which the value at `pointer` is replaced.
fn changed(valid: &Value, pointer: &str, other: Value) -> Value {
    let mut changed = valid.clone();
    *changed.pointer_mut(pointer).unwrap_or_else(|| panic!("there is no {pointer}")) = other;
    changed
}

/// Returns the error for a plan in which the value at `pointer` is replaced.
fn refusal(valid: &Value, pointer: &str, other: Value) -> String {
    refusal_of(changed(valid, pointer, other))
}

#[test]
fn every_shipped_problem_is_read_as_it_was_written() {
    for (name, problem) in shipped_problems() {
        let text = serde_json::to_string(&problem).unwrap();
        let read: Problem = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(serde_json::to_string(&read).unwrap(), text, "{name}");
        assert!(read.scene() == problem.scene() && read.motion() == problem.motion(), "{name}");
        // The files that were read are no part of the data.
        let robot = RobotReport { files: Vec::new(), ..problem.robot().clone() };
        assert!(read.task() == problem.task() && *read.robot() == robot, "{name}");
        assert_eq!(read.notes(), problem.notes(), "{name}");
        assert_eq!(format!("{:?}", read.scene()), format!("{:?}", problem.scene()), "{name}: bit for bit");
    }
}

#[test]
fn every_shipped_plan_is_read_as_it_was_written() {
    for (name, problem) in shipped_problems() {
        // The times differ from run to run, so they are not compared.
        let made = plan(&problem, &Options { timings: true, ..Options::default() }).unwrap();
        let text = serde_json::to_string(&made).unwrap();
        let read = read(&text).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!((read.status(), read.options()), (made.status(), made.options()), "{name}");
        assert_eq!(read.trajectory(), made.trajectory(), "{name}");
        assert_eq!(serde_json::to_string(&read).unwrap(), text, "{name}");
    }
}

#[test]
fn a_program_without_a_search_refuses_its_problems_by_name() {
    let again = |problem: &Problem| {
        let made = plan(problem, &Options::default()).unwrap();
        let stored: StoredPlan = serde_json::from_value(value(&made)).unwrap();
        stored.planned_again(Searches::NONE).map(|plan| plan.status()).map_err(|error| error.to_string())
    };
    assert_eq!(again(&world("shelf")), Ok(Status::Found));
    assert_eq!(again(&world("tasks/tray")), Err("this program was built without tasks".to_owned()));
    assert_eq!(again(&world("moving/gate")), Err("this program was built without moving obstacles".to_owned()));
}

#[test]
fn options_are_read_as_they_were_written() {
    for method in cplan::engine::Method::ALL {
        let options = Options { jerk: Some([Some(200.0), None]), ..Options::from(method) };
        assert_eq!(options.drive.blend, f64::INFINITY);
        let read: Options = serde_json::from_str(&serde_json::to_string(&options).unwrap()).unwrap();
        assert_eq!(read, options);
    }
    let shelf = world("shelf");
    let made = plan(&shelf, &Options::from(Planner::named("trapezoid".parse().unwrap()))).unwrap();
    let read = read(&value(&made).to_string()).unwrap();
    assert_eq!(read.to_json(), made.to_json());
}

#[test]
fn infinite_heights_and_the_sign_of_zero_are_kept() {
    let mut post = Obstacle::circle("post", [1.2, -0.0], 0.1).unwrap();
    post.heights = Heights { lower: f64::NEG_INFINITY, upper: 0.3 };
    let world = Workspace::new([post]);
    let problem = Problem::new(Arm::rr([1.0, 0.8], 0.06).unwrap(), world, [2.0, 0.1 + 0.2], [-2.0, -0.3]).unwrap();
    let written = value(&problem);
    assert_eq!(
        written.pointer("/asked/motion/scene/workspace/obstacles/0/heights"),
        Some(&json!({"lower": "-inf", "upper": 0.3}))
    );
    let read: Problem = serde_json::from_value(written).unwrap();
    let post = &read.scene().workspace().obstacles[0];
    assert_eq!((post.heights.lower, post.pieces[0].core()[0].y.is_sign_negative()), (f64::NEG_INFINITY, true));
    assert_eq!(read.motion().unwrap().start()[1].to_bits(), (0.1_f64 + 0.2).to_bits());
}

#[test]
fn changed_results_are_refused_with_their_place() {
    let made = plan(&world("shelf"), &Options::default()).unwrap();
    assert!(matches!(made.outcome(), Outcome::Found(_)));
    let valid = value(&made);
    // The straight line from start to goal leads through the shelf.
    let ends = json!([valid["result"]["path"][0], valid["result"]["path"].as_array().unwrap().last().unwrap()]);
    for (place, other, part) in [
        ("/result/path", ends, "result.path has 2 entries, but planning gives"),
        ("/result/path/1/0", json!(0.5), "result.path[1][0] is 0.5, but planning gives"),
        ("/result/status", json!("infeasible"), "result.status is \"infeasible\", but planning gives \"found\""),
        ("/result/trajectory/velocity/3/1", json!(9.0), "result.trajectory.velocity[3][1]"),
        ("/result/clearance", json!(0.5), "result.clearance is 0.5"),
        // With a faster joint, the motion would differ.
        ("/problem/asked/motion/scene/arm/joints/0/velocity", json!(50.0), "result."),
        ("/options/drive/period", json!(0.02), "result."),
    ] {
        let refused = refusal(&valid, place, other);
        assert!(refused.contains(part), "{place}: {refused}");
    }
    for (place, field) in [("/result", "clearance"), ("/problem/asked/motion", "start"), ("/options", "levels")] {
        let mut tampered = valid.clone();
        tampered.pointer_mut(place).unwrap().as_object_mut().unwrap().remove(field).unwrap();
        let refused = refusal_of(tampered);
        assert!(refused.contains(field) && refused.contains("missing"), "{refused}");
    }
}

#[test]
fn an_infeasible_problem_cannot_be_made_found() {
    let closed = plan(&world("singular_closed"), &Options::default()).unwrap();
    assert_eq!(closed.status(), Status::Infeasible);
    let valid = value(&closed);
    assert!(refusal(&valid, "/result/status", json!("found")).contains("result.status"));
    assert!(refusal(&valid, "/result/proof", json!([])).contains("result.proof"));
}

#[test]
fn data_that_no_constructor_makes_is_refused() {
    let valid = value(&plan(&world("shelf"), &Options::default()).unwrap());
    let scene = "/problem/asked/motion/scene";
    for (place, other, why) in [
        ("/problem/asked/motion/start/0".to_owned(), json!(100.0), "outside the limits"),
        ("/problem/asked/motion/start/0".to_owned(), Value::Null, "null"),
        ("/problem/asked/motion/start".to_owned(), json!(["NaN", 0.0]), "invalid type"),
        ("/problem/asked/motion/goals".to_owned(), json!([]), "no goal"),
        (format!("{scene}/workspace/clearance"), json!(-1.0), "clearance must be from 0 to"),
        (format!("{scene}/workspace/obstacles/0/heights/lower"), json!("NaN"), "\"inf\""),
        (format!("{scene}/workspace/obstacles/0/heights"), json!({"lower": 1.0, "upper": 0.0}), "the heights from"),
        (format!("{scene}/workspace/obstacles/0/pieces/0/radius"), json!(-0.1), "radius"),
        (format!("{scene}/workspace/obstacles/0/pieces/0/core"), json!([]), "no corner"),
        (
            format!("{scene}/workspace/obstacles/0/pieces/0/core"),
            json!([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]),
            "does not turn left",
        ),
        (format!("{scene}/arm/joints/0/velocity"), json!(0.0), "positive and finite"),
        (format!("{scene}/arm/plane/u"), json!([1.0, 1.0, 0.0]), "plane's vectors"),
        // Otherwise intervals would be repeated without end.
        (format!("{scene}/arm/joints/1/range/interval/upper"), json!(1e8), "at most 1000 rad apart"),
        // Predicates would overflow.
        (format!("{scene}/arm/tip"), json!([1e200, 0.0]), "within 1e15 m"),
        (format!("{scene}/workspace/obstacles/0/pieces/0/radius"), json!(1e200), "within 1e15 m"),
        ("/problem/robot/joints/joints/0/driver".to_owned(), json!({"planned": 2}), "the planned joints are 0 and 1"),
        ("/options/levels".to_owned(), json!(0), "levels"),
        ("/options/planner".to_owned(), json!("magic"), "no planner is called"),
    ] {
        let refused = refusal(&valid, &place, other);
        assert!(refused.contains(why), "{place}: {refused}");
    }
    assert!(serde_json::from_str::<StoredPlan>("{").unwrap_err().is_eof());
    assert!(serde_json::from_str::<Problem>("[]").unwrap_err().is_data());
}

#[test]
fn drawn_shapes_equal_judged_shapes() {
    let disc = json!({"circle": {"center": [-1.0, 1.0], "radius": 0.1}});
    let far = json!({"polygon": [[0.0, 0.0], [1e200, -1e200], [1e300, 1e250], [0.0, 1e180]]});
    for (name, shape, other) in [
        ("shelf", "/asked/motion/scene/workspace/obstacles/0", &disc),
        ("shelf", "/asked/motion/scene/workspace/obstacles/0", &far),
        ("tasks/table_mission", "/asked/task/workspace/obstacles/0", &disc),
        ("tasks/table_mission", "/asked/task/objects/0", &disc),
    ] {
        let problem = world(name);
        let output = changed(&value(&problem), &format!("{shape}/shape"), other.clone());
        let read: Problem = serde_json::from_value(output).unwrap();
        let [honest, read] = [value(&problem), value(&read)].map(|data| data.pointer(shape).unwrap().clone());
        assert_eq!(read["shape"], json!("pieces"), "{name}");
        assert!(honest["shape"] != read["shape"] && honest["pieces"] == read["pieces"], "{name}");
    }
}

#[test]
fn tasks_that_no_world_can_state_are_refused() {
    let mission = world("tasks/table_mission");
    let valid = value(&mission);
    let first = "/asked/task/items/0";
    let refused = |pointer: &str, other: Value| {
        serde_json::from_value::<Problem>(changed(&valid, pointer, other)).expect_err(pointer).to_string()
    };
    let task: &Task = mission.task().unwrap();
    assert!(task.check().is_ok());
    let place = json!({"step": {"action": {"place": {"at": [0.1, 0.1], "angle": null, "supports": []}}, "number": 1, "cycle": 1,
        "place": "x:1:1", "speed": 1.0, "dwell": 0.0}});
    let items = |item: Value| {
        let mut items = valid["asked"]["task"]["items"].as_array().unwrap().clone();
        items.insert(0, item);
        json!(items)
    };
    let mut long = valid.pointer(first).unwrap().clone();
    long["step"]["dwell"] = json!(1e300);
    let name = json!(task.workspace.fixed.obstacles[0].name);
    for (pointer, other, part) in [
        (first, place, "the tool carries none"),
        (first, long, "the dwell from 0"),
        ("/asked/task/objects/0/lift", json!(-1.0), "lift"),
        ("/asked/task/objects/0/mass", json!(-1.0), "mass"),
        ("/asked/task/objects/0/at/rotation", json!([2.0, 0.0]), "pose must be finite"),
        ("/asked/task/objects/0/name", name, "has this name"),
        ("/asked/task/start", json!([100.0, 0.0]), "outside the limits"),
        ("/asked/task/items", json!([]), "no steps"),
        ("/asked/task/items", items(json!({"renew": [99]})), "renewed"),
        ("/asked/task/items", items(json!({"any_order": []})), "is empty"),
    ] {
        let refused = refused(pointer, other);
        assert!(refused.contains(part), "{pointer}: {refused}");
    }
}

#[test]
fn corners_that_rounding_has_bent_are_read() {
    let flat = [[0.0, 0.0], [0.1, 0.0], [0.7, 0.0], [1.0, 0.0], [1.0, 0.3], [0.0, 0.3]];
    let shape = Convex::new(flat.map(Into::into).to_vec(), 0.01).unwrap();
    for turn in 0..100 {
        let moved = shape.at(&Pose::new([0.3, -0.2].into(), 0.1 * f64::from(turn)));
        let read: Convex = serde_json::from_str(&serde_json::to_string(&moved).unwrap()).unwrap();
        assert_eq!(read, moved);
    }
    let bent = r#"{"core": [[0.0, 0.0], [0.5, 0.000001], [1.0, 0.0], [1.0, 0.3]], "radius": 0.0}"#;
    let refused = |text: &str| serde_json::from_str::<Convex>(text).unwrap_err().to_string();
    assert!(refused(bent).contains("does not turn left at corner"), "{}", refused(bent));
    let there_and_back = r#"{"core": [[0.0, 0.0], [0.6, 0.0], [0.4, 0.0], [1.0, 0.0], [1.0, 0.3]], "radius": 0.0}"#;
    assert!(refused(there_and_back).contains("does not turn left at corner"), "{}", refused(there_and_back));
}

#[test]
fn a_scene_with_a_payload_is_data_too() {
    let made = plan(&world("tasks/table_mission"), &Options::default()).unwrap();
    let legs = &made.task().unwrap().1.legs;
    let leg = legs.iter().find(|leg| leg.carried.is_some()).unwrap();
    let read: Scene = serde_json::from_str(&serde_json::to_string(&*leg.scene).unwrap()).unwrap();
    assert!(read == *leg.scene);
    let ends = [leg.timed.curve.curve().path().start(), leg.timed.curve.curve().path().goal()];
    let motion = MotionProblem::new(read, ends[0], ends[1]).unwrap();
    let again: MotionProblem = serde_json::from_str(&serde_json::to_string(&motion).unwrap()).unwrap();
    assert!(again == motion);
    // Otherwise the payload would shrink.
    let half = json!({"rigid": {"rotation": [0.5, 0.0], "translation": [0.0, 0.0]}});
    let halved = changed(&serde_json::to_value(&*leg.scene).unwrap(), "/attachment/grip", half);
    assert!(serde_json::from_value::<Scene>(halved).unwrap_err().to_string().contains("its position on link 2"));
}
