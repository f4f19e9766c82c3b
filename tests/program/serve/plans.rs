//! Plans of pages: the latest counts, slow ones stop, and the saved world is the planned one.

use super::client::Page;
use super::server::{Server, shipped};
use super::{shelf_moved, shelf_page, shelf_state};
use serde_json::{Value, json};
use std::process::Command;

const WORLD: &str = "workspaces/shelf.toml";

/// A plan that takes many seconds.
const SLOW: &str = "harmonic --cells 2048";

fn is_certified(answer: &Value) -> bool {
    answer["verdict"] == "found" && answer["certified"] == true && answer["error"].is_null()
}

#[test]
fn the_built_in_cell_needs_no_files() {
    let mut page = Page::open(&Server::start(&["--with", "wavefront"]));
    assert_eq!(page.world["options"], "wavefront");
    assert!(page.world["obstacles"].as_array().unwrap().len() > 3);
    let server = Server::start(&[]);
    page = Page::open(&server);
    let answer = page.plan(None, "visibility");
    assert!(is_certified(&answer), "{answer}");
    assert!(answer["figures"]["duration"].as_f64().unwrap() > 0.0);
    assert!(answer["figures"]["lower_bound"].as_f64().unwrap() <= answer["figures"]["length"].as_f64().unwrap());
}

#[test]
fn an_obstacle_in_the_way_changes_the_path_which_stays_certified() {
    let (_server, mut page) = shelf_page();
    let length = |answer: &Value| answer["figures"]["length"].as_f64().unwrap();
    let before = page.plan(None, "visibility");
    let aside = page.plan(Some(shelf_state(shelf_moved([0.6, 0.0]))), "visibility");
    assert!(is_certified(&before) && is_certified(&aside));
    assert!(length(&aside) < length(&before) - 0.1, "out of the way the path is shorter");
    assert_ne!(before["view"]["paths"], aside["view"]["paths"]);
    let back = page.plan(Some(shelf_state(shelf_moved([0.0, 0.0]))), "visibility");
    assert_eq!(back["view"], before["view"], "back in its place all is as before");
}

#[test]
fn every_planner_answers_while_dragging_and_after() {
    let (_server, mut page) = shelf_page();
    for planner in page.world["planners"].clone().as_array().unwrap() {
        let planner = planner.as_str().unwrap();
        let answer = page.plan(None, planner);
        assert!(is_certified(&answer), "{planner}: {answer}");
        assert!(answer["view"]["clock"].is_object() && answer["toml"].is_string(), "{planner}");
        let id = page.post(Some(shelf_state(shelf_moved([0.0, 0.01]))), false, planner);
        let quick = page.answer(id);
        // On a slow machine, the time limit of a drag may be exceeded.
        assert!(
            is_certified(&quick) || quick["reason"].as_str().unwrap().contains("not decided in the available time"),
            "{planner}: {quick}"
        );
        assert!(quick["view"]["clock"].is_null() && quick["toml"].is_null(), "{planner}");
    }
}

#[test]
fn the_last_place_of_a_drag_is_answered_and_answers_come_in_order() {
    let (_server, mut page) = shelf_page();
    let mut last = 0;
    for step in 0..200 {
        let by = [0.002 * f64::from(step), 0.0];
        last = page.post(Some(shelf_state(shelf_moved(by))), step == 199, "visibility");
    }
    let mut heard = Vec::new();
    let answer = loop {
        let message = page.next();
        heard.push(message["id"].as_u64().unwrap());
        if message["id"] == last && message["done"] == true {
            break message;
        }
    };
    assert!(heard.windows(2).all(|pair| pair[0] <= pair[1]), "{heard:?}");
    assert!(is_certified(&answer), "{answer}");
    assert_eq!(answer["view"], page.plan(Some(shelf_state(shelf_moved([0.002 * 199.0, 0.0]))), "visibility")["view"]);
}

#[test]
fn a_slow_plan_is_stopped_by_the_next() {
    let server = Server::planar("workspaces/crowd.toml", &["--time-limit", "3600"]);
    let mut page = Page::open(&server);
    let slow = page.post(None, true, SLOW);
    // Its configuration space is sent at once, while its plan is in progress.
    let first = page.next();
    assert_eq!((&first["id"], &first["done"]), (&json!(slow), &json!(false)));
    assert!(!first["view"]["worlds"][0]["c_obstacles"].as_array().unwrap().is_empty());
    let quick = page.post(None, true, "visibility");
    loop {
        let message = page.next();
        assert_eq!(message["id"], quick, "nothing more is heard of the slow one");
        if message["done"] == true {
            assert!(is_certified(&message));
            break;
        }
    }
    // Closing a page stops its plan, so another plan can start at once.
    page.post(None, true, SLOW);
    drop(page);
    assert!(is_certified(&Page::open(&server).plan(None, "visibility")));
}

#[test]
fn time_is_limited() {
    let server = Server::planar("workspaces/crowd.toml", &["--time-limit", "0.05"]);
    let mut page = Page::open(&server);
    let answer = page.plan(None, SLOW);
    assert_eq!(answer["verdict"], "unknown");
    assert!(answer["reason"].as_str().unwrap().contains("not decided within 0.05 s"), "{answer}");
    assert!(answer["view"].is_object() && answer["certified"] == false);
}

#[test]
fn an_infeasible_world_comes_with_its_proof() {
    let (_server, mut page) = shelf_page();
    let text = std::fs::read_to_string(shipped("workspaces/singular_closed.toml")).unwrap();
    let answer = page.load(&text);
    assert_eq!((&answer["verdict"], &answer["certified"]), (&json!("infeasible"), &json!(false)), "{answer}");
    assert!(!answer["view"]["worlds"][0]["proof"].as_array().unwrap().is_empty());
}

#[test]
fn the_saved_world_is_the_planned_one() {
    let (server, mut page) = shelf_page();
    let mut state = shelf_state(shelf_moved([-0.05, 0.02]));
    let disc = json!({ "name": "disc", "circle": { "center": [-0.4, 0.9], "radius": 0.07 } });
    state["obstacles"].as_array_mut().unwrap().push(disc);
    state["start"] = json!({ "joints": [-0.8, 0.3] });
    state["goal"] = json!({ "tip": [0.4, 1.5] });
    state["clearance"] = json!(0.005);
    let planned = page.plan(Some(state.clone()), "visibility");
    assert!(is_certified(&planned), "{planned}");
    let (name, toml) = page.download(Some(state.clone()), "visibility", "toml").unwrap();
    assert_eq!((name.as_str(), toml.as_slice()), ("world.toml", planned["toml"].as_str().unwrap().as_bytes()));
    let text = String::from_utf8(toml).unwrap();
    // Comments and unchanged parts are preserved.
    let before = std::fs::read_to_string(shipped(WORLD)).unwrap();
    let comments =
        |text: &str| text.lines().filter(|line| line.starts_with('#')).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(comments(&text), comments(&before));

    let mut other = Page::open(&server);
    let again = other.load(&text);
    assert_eq!(again["view"], planned["view"]);
    assert_eq!(other.world["goal"], json!({ "tip": [0.4, 1.5] }));

    // The main job has the same result for the file, byte for byte.
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("shelf.toml"), &text).unwrap();
    let main = Command::new(env!("CARGO_BIN_EXE_cplan"))
        .args([shipped("robots/planar_2r.urdf").as_str(), "shelf.toml", "--json"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    let (_, json) = page.download(Some(state), "shortest", "json").unwrap();
    assert_eq!(String::from_utf8(json).unwrap().trim_end(), String::from_utf8(main.stdout).unwrap().trim_end());
}

#[test]
fn results_and_pictures_are_files() {
    let (_server, mut page) = shelf_page();
    for (format, begins) in [("json", "{"), ("csv", "time,"), ("yaml", ""), ("svg", "<"), ("html", "<!DOCTYPE html>")] {
        let (name, content) = page.download(None, "wavefront", format).unwrap();
        assert_eq!(name, format!("plan.{format}"));
        let content = String::from_utf8(content).unwrap();
        assert!(content.len() > 1000 && content.starts_with(begins), "{format}: {}", &content[..40]);
    }
    let refused = page.download(None, "visibility", "exe").unwrap_err();
    assert!(refused.contains(".json, .csv, .yaml"), "{refused}");
    page.load(&std::fs::read_to_string(shipped("workspaces/singular_closed.toml")).unwrap());
    let refused = page.download(None, "visibility", "csv").unwrap_err();
    assert!(refused.contains("no trajectory"), "{refused}");
}

#[test]
fn the_start_follows_the_tip() {
    let (_server, mut page) = shelf_page();
    let mut state = shelf_state(json!({ "from": 0 }));
    // The links are 1 m and 0.8 m long.
    let tip = |q: [f64; 2]| [q[0].cos() + 0.8 * (q[0] + q[1]).cos(), q[0].sin() + 0.8 * (q[0] + q[1]).sin()];
    let near = [-0.9, 0.4];
    let wanted = tip([-0.85, 0.45]);
    state["start"] = json!({ "tip": wanted, "near": near });
    let answer = page.plan(Some(state.clone()), "visibility");
    assert!(is_certified(&answer), "{answer}");
    let start: [f64; 2] = serde_json::from_value(answer["start"].clone()).unwrap();
    assert!((start[0] + 0.85).abs() < 1e-9 && (start[1] - 0.45).abs() < 1e-9, "{start:?}");
    assert!(answer["toml"].as_str().unwrap().contains(&format!("[{}, {}]", start[0], start[1])));
    // The place is out of reach: the arm stretches towards it.
    state["start"] = json!({ "tip": [3.0, -3.0], "near": near });
    let answer = page.plan(Some(state), "visibility");
    let start: [f64; 2] = serde_json::from_value(answer["start"].clone()).unwrap();
    assert!(start[1].abs() < 0.01, "stretched: {start:?}");
}

#[test]
fn a_task_is_shown_unchanged() {
    let files = [shipped("robots/scara.urdf"), shipped("workspaces/tasks/slot_level.toml")];
    let server = Server::start(&[&files[0], &files[1]]);
    let mut page = Page::open(&server);
    assert_eq!(page.world["has_steps"], true);
    let answer = page.plan(None, "visibility");
    assert!(is_certified(&answer), "{answer}");
    assert!(answer["view"]["motions"].as_array().unwrap().len() > 1);
    let refused = page.plan(Some(shelf_state(json!({ "from": 0 }))), "visibility");
    assert!(refused["error"].as_str().unwrap().contains("can only be changed in its text"), "{refused}");
}
