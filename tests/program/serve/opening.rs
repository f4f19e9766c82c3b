//! Pages that provide arm and world, like those opened by a link.

use super::client::Page;
use super::server::{Server, shipped};
use serde_json::{Value, json};

const SHELF: &str = "workspaces/shelf.toml";
const GANTRY: &str = include_str!("../../../robots/gantry.urdf");
const RING: &str = include_str!("../../../workspaces/annulus_closed.toml");
const OPEN_RING: &str = include_str!("../../../workspaces/annulus_open.toml");

fn ring() -> Value {
    json!({ "urdf": GANTRY, "world": RING, "options": "trapezoid" })
}

#[test]
fn a_page_begins_with_the_files_that_it_sends() {
    let server = Server::planar(SHELF, &[]);
    let (mut page, mut other) = (Page::open(&server), Page::open(&server));
    let own = page.world.clone();
    assert!(own["robot"].as_str().unwrap().contains("RR") && own["options"] == "shortest", "{own}");
    assert!(own["urdf"].as_str().unwrap().contains("<robot name=\"planar_2r\""));
    let world = page.begin(&ring());
    assert_eq!(
        (&world["urdf"], &world["toml"], &world["options"]),
        (&json!(GANTRY), &json!(RING), &json!("trapezoid"))
    );
    assert_eq!(page.plan(None, "shortest")["verdict"], "infeasible");
    // This affects only that page, until it returns to the server's files.
    assert_eq!(other.plan(None, "shortest")["verdict"], "found");
    let again = page.begin(&Value::Null);
    assert_eq!((&again["toml"], &again["urdf"]), (&own["toml"], &own["urdf"]));
    assert_eq!(page.plan(None, "shortest")["verdict"], "found");
}

#[test]
fn files_that_a_page_sends_name_no_other_files() {
    let server = Server::start(&[&shipped("robots/room_gantry.urdf"), &shipped("workspaces/store_room.toml")]);
    let mut page = Page::open(&server);
    assert_eq!(page.world["urdf"], Value::Null, "no link holds its map");
    let own = page.world["toml"].as_str().unwrap().to_owned();
    let mut refused = |key: &str, text: &str, part: &str| {
        let mut files = ring();
        files[key] = json!(text);
        let output = page.begin(&files);
        let error = output["error"].as_str().unwrap_or_else(|| panic!("no error: {output}"));
        assert!(error.contains(part), "{part}: {error}");
    };
    let no_file = "this text is not in a file";
    // Even the server's own files are refused.
    for world in [own.as_str(), "[[obstacle]]\nimage = \"/etc/passwd\"\n", "[map]\nfile = \"/etc/passwd\"\n"] {
        refused("world", world, no_file);
    }
    let mesh = GANTRY.replacen("<box", "<mesh filename=\"/etc/passwd\"/><box", 1);
    refused("urdf", &mesh, "/etc/passwd");
    refused("urdf", "<robot", "robot.urdf");
    refused("world", "name = ", "world.toml: line 1");
    assert_eq!(page.plan(None, "shortest")["verdict"], "found", "it goes on with what it had");
}

#[test]
fn a_page_has_no_more_time_than_the_server_gives() {
    let server = Server::planar(SHELF, &["--time-limit", "0.05"]);
    let mut page = Page::open(&server);
    // The problem is feasible, because a proof would end it sooner.
    page.begin(&json!({ "urdf": GANTRY, "world": OPEN_RING, "options": "trapezoid" }));
    let answer = page.plan(None, "harmonic --cells 1024");
    assert!(answer["verdict"] == "unknown" && answer["reason"].as_str().unwrap().contains("0.05 s"), "{answer}");
}
