//! Drawings become worlds that can be planned in.

use super::{Place, shipped};
use serde_json::Value;

fn cell() -> String {
    shipped("workspaces/drawings/cell.dxf")
}

/// A DXF in millimetres of these entities: words in turn are codes and values.
fn dxf(entities: &str) -> String {
    let all = format!("0 SECTION 2 HEADER 9 $INSUNITS 70 4 0 ENDSEC 0 SECTION 2 ENTITIES {entities} 0 ENDSEC 0 EOF");
    all.split_whitespace().map(|word| format!("{word}\n")).collect()
}

fn world(place: &Place, file: &str) -> toml::Table {
    toml::from_str(&place.read(file)).unwrap()
}

/// Names of the obstacles.
fn names(world: &toml::Table) -> Vec<&str> {
    world["obstacle"].as_array().unwrap().iter().map(|obstacle| obstacle["name"].as_str().unwrap()).collect()
}

#[test]
fn a_cell_by_cad_is_planned_in() {
    let place = Place::new();
    let done = place.run(
        &["import", &cell()],
        "--layer fence --layer conveyor --layer feeder --height feeder=-0.5:0.5 --output cell.toml --picture cell.svg \
         --start=-1.2,-1.5 --goal-tip 1,0.5",
    );
    assert_eq!((done.code, done.stderr.as_str()), (0, ""), "{}", done.stdout);
    let made = world(&place, "cell.toml");
    assert_eq!(names(&made), ["conveyor", "fence", "feeder 1", "feeder 2", "feeder 3", "feeder 4"]);
    let heights: Vec<_> =
        made["obstacle"].as_array().unwrap().iter().map(|o| o.get("height").map(ToString::to_string)).collect();
    let [on_belt, of_feeder] = ["[0.0, 0.9]", "[-0.5, 0.5]"].map(|text| Some(text.to_owned()));
    assert_eq!(heights, [on_belt, None, of_feeder.clone(), of_feeder.clone(), of_feeder.clone(), of_feeder]);
    let picture = place.read("cell.svg");
    assert!(picture.contains("<svg") && picture.contains("conveyor") && picture.contains("feeder 4"), "{picture}");
    for part in [
        "6 obstacles",
        "extent     x -1.500 to 2.400 m, y -1.500 to 1.500 m",
        "TEXT: left out",
        "HATCH: left out",
        "cell.toml",
    ] {
        assert!(done.stdout.contains(part), "{part} is not in {}", done.stdout);
    }
    let planned = place.run(&[shipped("robots/planar_2r.urdf"), "cell.toml".into()], "--json").json();
    assert_eq!(planned["status"], "found");
}

#[test]
fn without_a_file_the_world_is_printed() {
    let place = Place::new();
    let done = place.run(&["import", &cell()], "--layer old --quiet");
    assert_eq!((done.code, done.stderr.as_str()), (0, ""));
    let world: toml::Table = toml::from_str(&done.stdout).unwrap();
    assert_eq!(names(&world), ["old"]);
    assert!(world.get("start").is_none() && done.stdout.contains("#[start]"));
    let told = place.run(&["import", &cell()], "--json").json();
    assert_eq!((&told["status"], told["obstacles"].as_array().unwrap().len()), (&Value::from("imported"), 9));
    assert_eq!(
        (&told["obstacles"][1]["kind"], &told["obstacles"][1]["height"][1]),
        (&"LWPOLYLINE".into(), &0.9.into())
    );
    toml::from_str::<toml::Table>(told["world"].as_str().unwrap()).unwrap();
    let notes: Vec<&str> = told["notes"].as_array().unwrap().iter().map(|note| note.as_str().unwrap()).collect();
    assert!(notes.contains(&"layer \"old\" is switched off: left out, --layer takes it (line 3186)"), "{notes:?}");
}

#[test]
fn scaled_then_turned_then_moved() {
    let place = Place::new();
    place.write("two.dxf", dxf("0 LINE 8 a 10 100 20 0 11 100 21 50 0 CIRCLE 8 a 10 300 20 100 40 20 39 10"));
    let done =
        place.run(&["import", "two.dxf"], "--scale 2 --turn 90deg --move 1,-0.25 --height a=0:1 --output w.toml");
    assert_eq!(done.code, 0, "{}", done.stderr);
    let made = world(&place, "w.toml");
    assert_eq!(made["obstacle"][0]["polyline"].to_string(), "[[1.0, -0.05], [0.9, -0.05]]");
    assert_eq!(made["obstacle"][1]["circle"].to_string(), "{ center = [0.8, 0.35], radius = 0.04 }");
    // A height that is said is meant as it is; one of the drawing grows with it.
    assert_eq!(made["obstacle"][0]["height"].to_string(), "[0.0, 1.0]");
    place.run(&["import", "two.dxf"], "--scale 2 --unit cm --output w.toml");
    let made = world(&place, "w.toml");
    assert_eq!(made["obstacle"][1]["height"].to_string(), "[0.0, 0.2]");
    assert_eq!(made["obstacle"][1]["circle"]["radius"].to_string(), "0.4");
}

#[test]
fn each_obstacle_has_a_name_of_its_own() {
    let place = Place::new();
    let disc = |layer: &str| format!("0 CIRCLE 8 {layer} 10 {} 20 0 40 1 ", 10 * layer.len());
    place.write("discs.dxf", dxf(&["0", "a", "post", "a", "0", "a-2"].map(disc).concat()));
    assert_eq!(place.run(&["import", "discs.dxf"], "--output w.toml --quiet").code, 0);
    let made = world(&place, "w.toml");
    assert_eq!(names(&made), ["obstacle 1", "a 1", "post", "a 2", "obstacle 2", "a-2"]);
}

#[test]
fn names_with_line_breaks_stay_in_their_comments() {
    let place = Place::new();
    let layer = "x\n[[obstacle]]\nname = \"ghost\"\ncircle = { center = [0.0, 0.0], radius = 1.0 }\n#\u{1b}";
    let feature = serde_json::json!({
        "type": "Feature", "properties": { "name": "a\nb\"c", "layer": layer },
        "geometry": { "type": "Polygon", "coordinates": [[[3, 3], [4, 3], [4, 4], [3, 3]]] },
    });
    place.write("lines.geojson", feature.to_string());
    let done = place.run(&["import", "lines.geojson"], "--output w.toml");
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert_eq!(names(&world(&place, "w.toml")), ["a\nb\"c"]);
    let comment = "# Polygon, layer \"x\\n[[obstacle]]\\nname = ";
    assert!(place.read("w.toml").lines().any(|line| line.starts_with(comment)), "{}", place.read("w.toml"));
    assert!(done.stdout.contains("layer      x\\n[[obstacle]]"), "{}", done.stdout);
}

#[test]
fn what_a_frozen_layer_brings_in_is_left_out_by_its_name() {
    let place = Place::new();
    let layers =
        "0 SECTION 2 TABLES 0 TABLE 2 LAYER 0 LAYER 2 cold 70 1 62 7 0 LAYER 2 off 70 0 62 -7 0 ENDTAB 0 ENDSEC";
    let block = "0 SECTION 2 BLOCKS 0 BLOCK 2 pin 10 0 20 0 0 CIRCLE 8 0 10 0 20 0 40 1 0 CIRCLE 8 on 10 5 20 0 40 1 0 ENDBLK 0 ENDSEC";
    let inserts = "0 INSERT 8 off 2 pin 10 0 20 0 0 INSERT 8 cold 2 pin 10 0 20 100";
    let text = format!("{layers} {block} 0 SECTION 2 ENTITIES {inserts} 0 ENDSEC 0 EOF");
    place.write("pins.dxf", text.split_whitespace().map(|word| format!("{word}\n")).collect::<String>());
    let taken = |options: &str| {
        let done = place.run(&["import", "pins.dxf"], &format!("{options} --output w.toml"));
        assert_eq!(done.code, 0, "{}", done.stderr);
        (world(&place, "w.toml")["obstacle"].as_array().unwrap().len(), done.stdout)
    };
    let told = ["off", "cold"].map(|layer| format!("layer \"{layer}\" is switched off: left out"));
    for (options, count, is_told) in [
        ("", 1, [true, true]),
        ("--layer on", 1, [false, true]),
        ("--layer cold", 2, [false; 2]),
        ("--layer pin", 4, [false; 2]),
    ] {
        let (taken, said) = taken(options);
        assert_eq!((taken, told.clone().map(|note| said.contains(&note))), (count, is_told), "{options}: {said}");
    }
}

#[test]
fn outlines_that_are_none_are_taken_as_what_they_surround() {
    let place = Place::new();
    // A bow tie, a loop that retraces itself, and a room around both.
    place.write(
        "odd.dxf",
        dxf("0 LWPOLYLINE 8 tie 70 1 10 0 20 0 10 100 20 100 10 100 20 0 10 0 20 100 \
        0 LWPOLYLINE 8 loop 70 1 10 200 20 0 10 300 20 0 10 300 20 50 10 300 20 0 \
        0 LWPOLYLINE 8 room 70 1 10 -500 20 -500 10 500 20 -500 10 500 20 500 10 -500 20 500"),
    );
    let done = place.run(&["import", "odd.dxf"], "--output w.toml");
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert_eq!(names(&world(&place, "w.toml")), ["tie 1", "tie 2", "loop", "room"]);
    for part in [
        "outlines that cross or touch themselves: what they go round is solid (line 16)",
        "outlines that surround nothing: taken as thin walls (line 38)",
        "--walls makes a wall of it",
    ] {
        assert!(done.stdout.contains(part), "{part} is not in {}", done.stdout);
    }
    let done = place.run(&["import", "odd.dxf"], "--walls room --output w.toml");
    assert!(!done.stdout.contains("--walls"), "{}", done.stdout);
    let made = world(&place, "w.toml");
    assert_eq!(made["obstacle"][3]["polyline"].as_array().unwrap().len(), 5);
}

#[test]
fn what_is_wrong_is_said_with_its_place_and_cure() {
    let place = Place::new();
    place.write("text.dxf", dxf("0 TEXT 8 a 1 hello"));
    place.write("nan.dxf", dxf("0 CIRCLE 8 a 10 nan 20 0 40 1"));
    place.write("far.dxf", dxf("0 CIRCLE 8 a 10 1e15 20 0 40 1"));
    place.write("high.dxf", dxf("0 CIRCLE 8 a 10 1 20 0 39 1e300 40 1"));
    place.write("one.dxf", dxf("0 CIRCLE 8 a 10 1 20 0 40 1"));
    place.write("tiny.geojson", r#"{"type": "Polygon", "coordinates": [[[0, 0], [1e-10, 0], [0, 1e-10], [0, 0]]]}"#);
    place.write("cut.dxf", &dxf("0 CIRCLE 8 a 10 1 20 0 40 1")[..60]);
    place.write("broken.svg", "<svg>\n<g>\n</svg>");
    place.write("broken.json", "{ \"type\":\n 3");
    let refused = |file: &str, options: &str, parts: &[&str]| {
        place.run(&["import", file], options).refused(1, parts);
    };
    refused(
        "text.dxf",
        "--output w.toml",
        &["text.dxf: nothing of this drawing is an obstacle; TEXT: left out", "cure: draw outlines"],
    );
    refused("nan.dxf", "", &["nan.dxf: line 20, column 1: group 10 needs a number", "cure: "]);
    refused(
        "far.dxf",
        "",
        &["far.dxf: line 16, column 1: CIRCLE has a coordinate of 1.00e12 m (at most 1e6)", "--move"],
    );
    refused("high.dxf", "", &["high.dxf: line 16, column 1: CIRCLE has a height of 1.00e297 m (at most 1e6)"]);
    let done = place.run(&["import", "tiny.geojson"], "");
    done.refused(1, &["nothing of this drawing is an obstacle", "what has no extent: left out"]);
    assert!(!done.stderr.contains("taken as"), "{}", done.stderr);
    refused("cut.dxf", "", &["cut.dxf: line ", "ends in the middle"]);
    refused("broken.svg", "", &["broken.svg: line 3", "no well-formed XML"]);
    refused("broken.json", "", &["broken.json: line 2", "no JSON"]);
    refused("none.dxf", "", &["none.dxf: cannot be read", "cure: "]);
    refused("one.dxf", "--layer b", &["--layer: the drawing has nothing called \"b\"", "cure: the drawing has \"a\""]);
    refused("one.dxf", "--output no/w.toml", &["there is no folder"]);
    assert!(!place.path("w.toml").exists());
    for (file, options, part) in [
        ("one.step", "", "must end in .dxf, .svg, .geojson or .json"),
        ("one.dxf", "--output w.json", "must end in .toml"),
        ("one.dxf", "--height a=1", "NAME=LOW:HIGH"),
        ("one.dxf", "--height a=1:0", "lower end"),
        ("one.dxf", "--height a=0:1e300", "NAME=LOW:HIGH"),
        ("one.dxf", "--scale 0", "more than 0"),
        ("one.dxf", "--unit feet", "none of the units mm, cm"),
    ] {
        place.run(&["import", file], options).refused(2, &[part]);
    }
    let error = serde_json::from_str::<Value>(&place.run(&["import", "nan.dxf"], "--json").stdout).unwrap();
    assert_eq!((&error["file"], &error["line"]), (&"nan.dxf".into(), &20.into()));
    place.run(&["import", "broken.svg"], "--picture broken.svg").refused(1, &["the output broken.svg is the input"]);
}
