//! Invalid requests are answered with a message, and the page continues.

use super::client::Page;
use super::server::Server;
use super::{shelf_moved, shelf_page, shelf_state};
use serde_json::json;

fn error_of(answer: &serde_json::Value) -> &str {
    answer["error"].as_str().unwrap_or_else(|| panic!("no error: {answer}"))
}

#[test]
fn large_requests_are_refused() {
    let server = Server::start(&[]);
    let body = "x".repeat(1 << 20);
    let length = body.len();
    let post = server.raw(&format!("POST / HTTP/1.1\r\nHost: HOST\r\nContent-Length: {length}\r\n\r\n{body}"));
    assert_eq!(post.status(), 413);
    let head = server.raw(&format!("GET / HTTP/1.1\r\nHost: HOST\r\nX: {body}\r\n\r\n"));
    assert_eq!(head.status(), 431);
    let mut page = Page::open(&server);
    let text = "#".repeat(2 << 20);
    assert!(page.is_refused(&json!({ "do": "load", "id": 1, "text": text, "options": "visibility" }).to_string()));
    assert_eq!(Page::open(&server).plan(None, "visibility")["verdict"], "found");
}

#[test]
fn invalid_requests_are_answered() {
    let server = Server::start(&[]);
    let mut page = Page::open(&server);
    for nonsense in ["", "{", "[]", "{\"do\":\"stop\"}", "{\"do\":\"plan\"}", &"[".repeat(100_000)] {
        page.send(nonsense);
        let answer = page.next();
        assert!(answer["kind"] == "failed" && error_of(&answer).starts_with("not a valid request"), "{answer}");
    }
    assert_eq!(page.plan(None, "visibility")["verdict"], "found");
}

#[test]
fn a_bad_text_is_explained_and_the_last_good_one_stays() {
    let (_server, mut page) = shelf_page();
    let base = page.base;
    for (text, parts) in [
        ("name = ", &["shelf.toml: line 1"][..]),
        ("nam = \"x\"", &["unknown key", "^^^"]),
        ("[[obstacle]]\npolygon = [[0, 0], [1, 1], [1, 0], [0, 1]]\n", &["line 2", "not a simple polygon"]),
        ("[[obstacle]]\ncircle = { center = [0, 0], radius = -1 }\n", &["radius must be positive"]),
        ("[map]\nfile = \"store_room.map\"\n", &["\"store_room.map\"", "cplan serve with this world"]),
        ("[[obstacle]]\nimage = \"../workspaces/den.yaml\"\n", &["den.yaml"]),
        ("obstacle = [{ image = \"den.yaml\" }]\n", &["den.yaml"]),
    ] {
        let answer = page.load(text);
        assert_eq!(answer["kind"], "failed", "{text}");
        for part in parts {
            assert!(error_of(&answer).contains(part), "{part}: {answer}");
        }
    }
    assert_eq!(page.base, base);
    let answer = page.plan(Some(shelf_state(json!({ "from": 0 }))), "visibility");
    assert_eq!((&answer["verdict"], &answer["certified"]), (&json!("found"), &json!(true)));
}

#[test]
fn a_start_in_an_obstacle_is_explained_and_drawn() {
    let (_server, mut page) = shelf_page();
    let blocking = json!({ "from": 0, "circle": { "center": [0.6, -0.6], "radius": 0.2 } });
    for is_final in [false, true] {
        let id = page.post(Some(shelf_state(blocking.clone())), is_final, "visibility");
        let answer = page.answer(id);
        // The message refers to the visible scene, because the page's user knows of no file.
        let error = error_of(&answer);
        assert!(error.starts_with("The start is blocked: link \"upper_arm\" is "), "{error}");
        assert!(error.contains(" deep in \"shelf\"") && !error.contains("line") && !error.contains(".toml"), "{error}");
        assert_eq!((&answer["about"], &answer["blocked"][0]["at"]), (&json!("start"), &json!([-0.9, 0.4])));
        let hit = &answer["blocked"][0]["hits"][0];
        assert!(hit["obstacle"] == 0 && hit["distance"].as_f64().unwrap() < -0.01, "{hit}");
        assert!(answer["verdict"].is_null() && answer["certified"] == false, "{answer}");
        let world = &answer["view"]["worlds"][0];
        assert!(!world["c_obstacles"].as_array().unwrap().is_empty(), "the page shows where it is");
        assert_eq!(answer["view"]["paths"], json!([]));
    }
    assert_eq!(page.plan(Some(shelf_state(shelf_moved([0.0, 0.0]))), "visibility")["verdict"], "found");
}

#[test]
fn invalid_states_are_refused() {
    let (_server, mut page) = shelf_page();
    let crossed = json!({ "from": 0, "polygon": [[1.0, 0.0], [1.5, 0.5], [1.5, 0.0], [1.0, 0.5]] });
    let flat = json!({ "from": 0, "polygon": [[1.0, 0.0], [1.5, 0.5]] });
    for (obstacles, part) in [
        (json!([{ "from": 9 }]), "no obstacle 10"),
        (json!([crossed]), "not a simple polygon"),
        (json!([flat]), "not a simple polygon"),
        (json!(vec![json!({ "from": 0 }); 2000]), "the live page allows 1000"),
        (json!([{ "from": 0, "polygon": vec![[0.0, 0.0]; 30_000] }]), "20000 corners"),
        (json!([{ "name": "empty" }]), "exactly one shape"),
    ] {
        let mut state = shelf_state(json!({ "from": 0 }));
        state["obstacles"] = obstacles;
        let answer = page.plan(Some(state), "visibility");
        assert!(error_of(&answer).contains(part), "{part}: {answer}");
    }
    for (options, part) in
        [("fastest", "[possible values: shortest"), ("harmonic --gap 0.1", "--gap needs"), ("", "<PLANNER>")]
    {
        let answer = page.plan(None, options);
        assert!(error_of(&answer).contains(part), "{part}: {answer}");
    }
    let mut stale = shelf_state(json!({ "from": 0 }));
    stale["clearance"] = json!(-1.0);
    assert!(error_of(&page.plan(Some(stale), "visibility")).contains("must not be negative"));
    page.base += 1;
    assert!(error_of(&page.plan(None, "visibility")).contains("about world 2"));
    page.base -= 1;
    assert_eq!(page.plan(None, "visibility")["verdict"], "found");
}
