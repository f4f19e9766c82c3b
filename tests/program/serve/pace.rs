//! The page follows dragged objects, however many obstacles there are.

use super::client::Page;
use super::shelf_page;
use cplan_cases::plane::distance_to_segment;
use serde_json::{Value, json};
use std::time::Duration;

/// Number of obstacles of the crowd.
const MANY: usize = 300;

/// Answers per second that a page should get during a drag.
const WANTED: f64 = 10.0;

/// Number of answers that the test waits for.
const ANSWERS: u32 = 30;

const START: [f64; 2] = [-0.9, 0.4];
const GOAL: [f64; 2] = [1.55, -0.35];

/// Returns small pentagons everywhere in the reach of `planar_2r`, except near the arm at its start and goal.
fn crowd() -> Vec<Vec<[f64; 2]>> {
    let links = |[q1, q2]: [f64; 2]| {
        let elbow = [q1.cos(), q1.sin()];
        let tip = [elbow[0] + 0.8 * (q1 + q2).cos(), elbow[1] + 0.8 * (q1 + q2).sin()];
        [[[0.0, 0.0], elbow], [elbow, tip]]
    };
    let place = |k: usize| {
        // The golden angle spreads the obstacles evenly.
        let (radius, angle) = (1.3 + 0.6 * (k as f64 * 0.754_877).fract(), k as f64 * 2.399_963);
        [radius * angle.cos(), radius * angle.sin()]
    };
    let is_apart =
        |p: &[f64; 2]| [START, GOAL].into_iter().flat_map(links).all(|link| distance_to_segment(*p, link) > 0.14);
    let corner = |[x, y]: [f64; 2], i: usize| {
        let angle = i as f64 * std::f64::consts::TAU / 5.0;
        [x + 0.01 * angle.cos(), y + 0.01 * angle.sin()]
    };
    (0..).map(place).filter(is_apart).take(MANY).map(|p| (0..5).map(|i| corner(p, i)).collect()).collect()
}

fn text(crowd: &[Vec<[f64; 2]>]) -> String {
    let obstacles: String =
        crowd.iter().map(|corners| format!("[[obstacle]]\npolygon = {}\n", json!(corners))).collect();
    format!("[start]\njoints = {START:?}\n[goal]\njoints = {GOAL:?}\n{obstacles}")
}

/// Returns the state in which the first obstacle has been dragged by this distance.
fn dragged_state(crowd: &[Vec<[f64; 2]>], by: f64) -> Value {
    let piece = |(k, corners): (usize, &Vec<[f64; 2]>)| {
        let by = if k == 0 { by } else { 0.0 };
        let corners: Vec<_> = corners.iter().map(|[x, y]| [x + by, y + by]).collect();
        json!({ "from": k, "polygon": corners })
    };
    json!({
        "obstacles": crowd.iter().enumerate().map(piece).collect::<Vec<_>>(),
        "start": { "joints": START },
        "goal": { "joints": GOAL },
        "clearance": 0.0,
    })
}

/// Returns the CPU time that a process has used so far. Returns `None` if the system does not report it.
fn cpu_time(process: u32) -> Option<Duration> {
    let stat = std::fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    // Behind the name in brackets: state, then eleven others, then ticks in user and system mode, a hundred per second.
    let ticks: Vec<u64> = stat.rsplit(')').next()?.split_whitespace().skip(11).take(2).flat_map(str::parse).collect();
    Some(Duration::from_millis(10 * ticks.iter().sum::<u64>()))
}

#[test]
fn three_hundred_obstacles_are_followed_ten_times_a_second() {
    let (server, mut page) = shelf_page();
    let crowd = crowd();
    let answer = page.load(&text(&crowd));
    assert!(answer["verdict"].is_string(), "{answer}");
    let before = cpu_time(server.child.id());
    for step in 1..=ANSWERS {
        // Like the page: sends the next place after an answer.
        let by = 1e-4 * f64::from(step);
        let id = page.post(Some(dragged_state(&crowd, by)), false, "visibility");
        let answer = page.answer(id);
        let world = &answer["view"]["worlds"][0];
        let seen = world["obstacles"][0]["outline"]["polygon"][0].as_f64().unwrap();
        assert!((seen - crowd[0][0][0] - by).abs() < 1e-4, "the obstacle is where it was dragged to");
        assert!(world["c_obstacles"].as_array().unwrap().len() >= MANY / 2, "with the configuration space");
        assert!(answer["certified"] == false || !answer["view"]["paths"].as_array().unwrap().is_empty());
    }
    // The server's CPU time does not depend on other load of the machine.
    if let Some((after, before)) = cpu_time(server.child.id()).zip(before) {
        let each = (after - before).as_secs_f64() * 1e3 / f64::from(ANSWERS);
        assert!(each * WANTED <= 1e3, "{each:.0} ms of computing for an answer");
    }
}

#[test]
fn caches_between_answers_change_nothing() {
    let (server, mut page) = shelf_page();
    let crowd = crowd()[..40].to_vec();
    page.load(&text(&crowd));
    let drop = |state: &mut Value, k: usize| state["obstacles"].as_array_mut().unwrap().remove(k);
    let mut steps = vec![dragged_state(&crowd, 0.01), dragged_state(&crowd, 0.02)];
    // Fewer obstacles, another order, the same again, and another clearance.
    let mut fewer = dragged_state(&crowd, 0.03);
    drop(&mut fewer, 17);
    let first = drop(&mut fewer, 0);
    steps.push(fewer.clone());
    fewer["obstacles"].as_array_mut().unwrap().push(first);
    steps.push(fewer.clone());
    steps.push(dragged_state(&crowd, 0.02));
    fewer["clearance"] = json!(0.002);
    steps.push(fewer);
    for (k, state) in steps.into_iter().enumerate() {
        page.post(Some(state.clone()), false, "visibility");
        let kept = page.plan(Some(state.clone()), "visibility");
        // A page that has only the text.
        let mut other = Page::open(&server);
        let anew = other.load(kept["toml"].as_str().unwrap());
        assert!(kept["view"].is_object() && kept["view"] == anew["view"], "step {k}");
    }
}
