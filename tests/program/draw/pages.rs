//! Pages: self-contained, deterministic, finite, and the same results as the pictures.

use super::{configuration, plain_picture, planar_scene, torus};
use cplan::check::certify;
use cplan::cspace::c_obstacles;
use cplan::geometry::Point;
use cplan::model::Status;
use cplan::motion::Drive;
use cplan::planner::{CellKind, ChannelPoints, FieldQuantity, GraphKind, Trace};
use cplan::proofs::{Connectivity, connectivity};
use cplan::space::Path;
use cplan::view::{AxesFrame, Picture, View, page};
use cplan_testkit::problems::{Benchmark, benchmark};
use nalgebra::Vector3;
use serde_json::Value;

/// Checks the rules for every page, and returns the page's data. Writes the page to a file if `CPLAN_PICTURES` is set.
pub fn inspected(name: &str, view: &View) -> Value {
    let text = page(view);
    if let Some(folder) = std::env::var_os("CPLAN_PICTURES") {
        std::fs::write(std::path::Path::new(&folder).join(format!("{name}.html")), &text).unwrap();
    }
    assert_eq!(text, page(view), "writing twice gives the same bytes");
    // The font is part of the page.
    let loaded = text.replace("url(data:font/woff2;base64,", "");
    for outside in ["http:", "https:", "src=", "href=", "@import", "url(", "fetch(", "import("] {
        assert!(!loaded.contains(outside), "{name}: {outside} would need a network");
    }
    let data =
        text.split("<script id=\"view\" type=\"application/json\">").nth(1).and_then(|t| t.split("</script>").next());
    let data = data.expect("a page holds its data");
    assert!(!data.contains('<'), "{name}: nothing in the data can end its script");
    let value: Value = serde_json::from_str(data).unwrap();
    assert_eq!(value, serde_json::from_str::<Value>(&view.json()).unwrap());
    no_holes(name, "", &value);
    value
}

/// Checks that only values that may be missing are null. Infinite or undefined numbers would be null in JSON.
fn no_holes(name: &str, key: &str, value: &Value) {
    match value {
        Value::Null => assert!(["clock", "path"].contains(&key), "{name}: {key} is null"),
        Value::Array(items) => items.iter().for_each(|item| no_holes(name, key, item)),
        Value::Object(fields) => fields.iter().for_each(|(key, item)| no_holes(name, key, item)),
        _ => {}
    }
}

/// Returns the pairs of numbers in a flat list.
fn pairs(list: &Value) -> Vec<[f64; 2]> {
    let numbers: Vec<f64> = list.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    numbers.chunks(2).map(|pair| [pair[0], pair[1]]).collect()
}

fn near(found: &[[f64; 2]], expected: impl IntoIterator<Item = [f64; 2]>) {
    let expected: Vec<[f64; 2]> = expected.into_iter().collect();
    assert_eq!(found.len(), expected.len());
    for (a, b) in found.iter().zip(&expected) {
        assert!((a[0] - b[0]).abs() < 1e-4 && (a[1] - b[1]).abs() < 1e-4, "{a:?} for {b:?}");
    }
}

#[test]
fn a_plan_is_shown_unchanged() {
    let scene = planar_scene();
    let contours = c_obstacles(&scene, 2e-3, 2e-3);
    let path = Path::new(vec![configuration(1.6, 0.3), configuration(1.75, 0.5), configuration(1.85, 0.2)]);
    let timed = Drive::default().along(&scene, &certify(&scene, path.clone()).unwrap(), 1.0).unwrap();
    let goals = [path.goal().into()];
    let picture = Picture {
        title: vec!["plan </script><script>alert(1)</script>".to_owned()],
        ending: Some(Status::Found),
        facts: vec![["length".to_owned(), "0.9 rad".to_owned()]],
        start: path.start(),
        paths: vec![("by hand".to_owned(), &path)],
        trajectory: Some(&timed.trajectory),
        c_obstacles: &contours,
        ..plain_picture(&scene, &goals)
    };
    let value = inspected("page_plan", &View::of_picture(&picture));
    assert_eq!(value["ending"], "found");
    assert_eq!(value["facts"][0][1], "0.9 rad");
    near(&pairs(&value["paths"][0]["points"]), path.waypoints().iter().map(|q| [q[0], q[1]]));
    near(&pairs(&value["clock"]["position"]), timed.trajectory.position.iter().copied());
    assert_eq!(value["clock"]["time"].as_array().unwrap().len(), timed.trajectory.time.len());
    let world = &value["worlds"][0];
    let names: Vec<&str> = world["obstacles"].as_array().unwrap().iter().map(|o| o["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["shelf", "post <1>", "fence & gate"]);
    let drawn = world["c_obstacles"].as_array().unwrap();
    assert_eq!(drawn.len(), contours.len());
    for (shown, contour) in drawn.iter().zip(&contours) {
        assert_eq!((&shown["obstacle"], &shown["link"]), (&contour.obstacle.into(), &contour.link.into()));
        near(&pairs(&shown["contour"]), contour.contour.iter().map(|p| [p.x, p.y]));
    }
    // All pairs, none twice.
    let ranges = world["pairs"].as_array().unwrap().iter().map(|range| (range[4].as_u64().unwrap(), range[3].as_u64()));
    assert_eq!(ranges.map(|(end, first)| (end - first.unwrap()) as usize).sum::<usize>(), scene.pairs().len());
}

/// Checks that every block of cells is drawn with its least label. Blocks that stick out are marked.
#[test]
fn a_wavefront_is_written_in_letters() {
    let scene = planar_scene();
    let n = 400;
    let labels: Vec<u32> = (0..n * n).map(|k| if k / n < 100 { u32::MAX } else { (k / n - 100) as u32 }).collect();
    let trace = Trace::Wavefront { cells: [n; 2], labels, expanded: Vec::new(), forward: false, estimates: None };
    let picture = Picture { trace: Some(&trace), ending: Some(Status::Unknown), ..plain_picture(&scene, &[]) };
    let value = inspected("page_wavefront", &View::of_picture(&picture));
    let seen = &value["worlds"][0]["trace"];
    assert_eq!((seen["kind"].as_str(), seen["farthest"].as_u64()), (Some("wavefront"), Some(299)));
    let blocks: Vec<usize> = seen["blocks"].as_array().unwrap().iter().map(|x| x.as_u64().unwrap() as usize).collect();
    assert_eq!(blocks, [134, 134]);
    assert!((seen["extent"][0].as_f64().unwrap() - 402.0 / 400.0).abs() < 1e-4);
    let letters = seen["levels"].as_str().unwrap();
    let column = |i: usize| &letters[i * blocks[1]..(i + 1) * blocks[1]];
    // Cells 99 and 100 share block 33: it was reached.
    assert!(column(32).chars().all(|c| c == '.') && column(33).chars().all(|c| c == 'A'));
    assert!(column(133).chars().all(|c| c == '/'), "the farthest have the last letter");
}

#[test]
fn other_traces_keep_their_parts() {
    let scene = torus();
    let shown = |trace: &Trace| {
        let picture = Picture { trace: Some(trace), ..plain_picture(&scene, &[]) };
        let mut value = inspected("page_trace", &View::of_picture(&picture));
        value["worlds"][0]["trace"].take()
    };
    let roadmap =
        shown(&Trace::Roadmap { edges: vec![[configuration(0.0, 0.5), configuration(1.0, -0.25)]], whole: false });
    assert_eq!(roadmap, serde_json::json!({ "kind": "roadmap", "edges": [0.0, 0.5, 1.0, -0.25], "whole": false }));
    let roads = Trace::Roads {
        edges: vec![[configuration(0.0, 0.5), configuration(1.0, -0.25)]],
        expanded: vec![configuration(1.0, -0.25), configuration(0.0, 0.5)],
        kind: GraphKind::Roadmap,
    };
    let output =
        serde_json::json!({ "kind": "roads", "edges": [0.0, 0.5, 1.0, -0.25], "expanded": [1.0, -0.25, 0.0, 0.5] });
    assert_eq!(shown(&roads), output);
    let picture = Picture { trace: Some(&roads), ..plain_picture(&scene, &[]) };
    let svg = cplan::view::svg(&View::of_picture(&picture));
    assert!(["roadmap", "expanded first", "expanded last"].iter().all(|key| svg.contains(key)), "{svg}");
    let cell = vec![configuration(0.0, 0.0), configuration(1.0, 0.0), configuration(0.0, 1.0)];
    let channel = shown(&Trace::Channel {
        kind: CellKind::Triangles,
        cells: vec![cell].into(),
        channel: vec![0],
        points: ChannelPoints::default(),
        expanded: Vec::new(),
    });
    assert_eq!((&channel["cells"][0][2], &channel["channel"][0]), (&1.0.into(), &0.into()));
    assert!(channel.get("expanded").is_none(), "a search that is not to be seen: {channel}");
    let boxes = shown(&Trace::Boxes {
        free: vec![[configuration(0.0, 0.0), configuration(1.0, 2.0)]],
        stuck: vec![],
        mixed: vec![],
    });
    assert_eq!(boxes["free"], serde_json::json!([0.0, 0.0, 1.0, 2.0]));
    // The field rises to the middle: rings, and lines that run inwards.
    let n = 64;
    let place = |k: usize| (k as f64 + 0.5) / n as f64 * std::f64::consts::TAU - std::f64::consts::PI;
    let height = |k: usize| -(place(k / n).powi(2) + place(k % n).powi(2));
    let field = shown(&Trace::field([n; 2], FieldQuantity::Logarithm, (0..n * n).map(height).collect::<Vec<_>>()));
    let first = &field["levels"][0];
    assert!(first["part"].as_f64().unwrap() < 0.1);
    let radii = pairs(&first["lines"][0]).into_iter().map(|q| q[0].hypot(q[1]));
    let (least, most) = radii.fold((f64::INFINITY, 0.0_f64), |(a, b), r| (a.min(r), b.max(r)));
    assert!(most - least < 0.05, "a ring has one radius: {least} to {most}");
    let flow = field["flow"].as_array().unwrap();
    assert!(flow.len() > 200, "{} lines of flow", flow.len());
    for line in flow.iter().map(pairs) {
        let [from, to] = [line[0], line[line.len() - 1]].map(|q| q[0].hypot(q[1]));
        assert!(to < from && to < 0.4, "{line:?}");
    }
    let nothing = Trace::field([2, 2], FieldQuantity::Logarithm, vec![f64::NEG_INFINITY; 4]);
    assert!(shown(&nothing).is_null(), "a field without values has nothing to show");
}

#[test]
fn a_proof_is_shown_where_it_is() {
    let (scene, start, goal) = benchmark(Benchmark::T);
    let Connectivity::Disconnected(claim) = connectivity(&scene, start, &goal.into(), 0.0, 100_000) else {
        panic!("walls of link 1 close the way")
    };
    let proof = claim.checked(&scene, start, &goal.into(), 0.0).expect("the proof holds");
    let corners = proof.collision_boxes().iter().flat_map(|stuck| [stuck.cell.lower, stuck.cell.upper]).flatten();
    let corners: Vec<f64> = corners.collect();
    let picture = Picture { proof: Some(&proof), ending: Some(Status::Infeasible), ..plain_picture(&scene, &[]) };
    let value = inspected("page_proof", &View::of_picture(&picture));
    let shown: Vec<f64> = value["worlds"][0]["proof"].as_array().unwrap().iter().filter_map(Value::as_f64).collect();
    assert_eq!(shown.len(), corners.len());
    assert!(shown.iter().zip(&corners).all(|(a, b)| (a - b).abs() < 1e-4), "{shown:?} {corners:?}");
    assert_eq!((&value["ending"], &value["clock"]), (&"infeasible".into(), &Value::Null));
}

#[test]
fn an_arm_is_shown_with_its_frames() {
    let scene = planar_scene();
    let frame = AxesFrame {
        name: "tool0".to_owned(),
        at: Point::new(0.5, -0.25),
        axes: [Vector3::x(), Vector3::y(), Vector3::z()],
    };
    let picture = Picture { title: vec!["posture".to_owned()], ..Picture::new(&scene, configuration(0.5, 0.5)) };
    let view = View::of_arm(&picture, &[frame]);
    let value = inspected("page_posture", &view);
    assert_eq!(value["frames"][0]["at"], serde_json::json!([0.5, -0.25]));
    assert_eq!(value["frames"][0]["axes"][2], serde_json::json!([0.0, 0.0, 1.0]));
    assert_eq!(value["start"], serde_json::json!([0.5, 0.5]));
    // Its pictures have its name, and no configuration space.
    let words = super::words(&super::inspected("posture", &view));
    assert!(words.contains("tool0") && !words.contains("Configuration space"), "{words}");
}
