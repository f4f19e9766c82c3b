//! Drawings become worlds in which one can plan.

use super::*;
fn cell() -> String {
    shipped("workspaces/drawings/cell.dxf")
}

/// Returns a DXF in millimetres with these entities. The words are alternately codes and values.
fn dxf(entities: &str) -> String {
    let all = format!("0 SECTION 2 HEADER 9 $INSUNITS 70 4 0 ENDSEC 0 SECTION 2 ENTITIES {entities} 0 ENDSEC 0 EOF");
    all.split_whitespace().map(|word| format!("{word}\n")).collect()
}

fn world(place: &Place, file: &str) -> toml::Table {
    toml::from_str(&place.read(file)).unwrap()
}

/// Returns the names of the obstacles.
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
    done.says(&["6 obstacles", "extent     x -1.500 to 2.400 m, y -1.500 to 1.500 m", "cell.toml"]);
    // Objects on other layers were not requested.
    assert!(!done.stdout.contains("left out"), "{}", done.stdout);
    let planned = place.run(&[shipped("robots/planar_2r.urdf"), "cell.toml".into()], "--json").json();
    assert_eq!(planned["status"], "found");
}

#[test]
fn without_a_file_the_world_is_printed() {
    let place = Place::new();
    let done = place.run(&["import", &cell()], "--layer old --quiet").succeeds_silently();
    let world: toml::Table = toml::from_str(&done.stdout).unwrap();
    assert_eq!(names(&world), ["old"]);
    assert!(world.get("start").is_none() && done.stdout.contains("#[start]"));
    let message = place.run(&["import", &cell()], "--json").json();
    assert_eq!((&message["status"], message["obstacles"].as_array().unwrap().len()), (&Value::from("imported"), 9));
    assert_eq!(
        (&message["obstacles"][1]["kind"], &message["obstacles"][1]["height"][1]),
        (&"LWPOLYLINE".into(), &0.9.into())
    );
    toml::from_str::<toml::Table>(message["world"].as_str().unwrap()).unwrap();
    let notes: Vec<&str> = message["notes"].as_array().unwrap().iter().map(|note| note.as_str().unwrap()).collect();
    assert!(notes.contains(&"layer \"old\" is switched off and left out; --layer imports it (line 2102)"), "{notes:?}");
}

#[test]
fn drawings_are_scaled_then_turned_then_moved() {
    let place =
        Place::new().with("two.dxf", dxf("0 LINE 8 a 10 100 20 0 11 100 21 50 0 CIRCLE 8 a 10 300 20 100 40 20 39 10"));
    place.run(&["import", "two.dxf"], "--scale 2 --turn 90deg --move 1,-0.25 --height a=0:1 --output w.toml").exits(0);
    let made = world(&place, "w.toml");
    assert_eq!(made["obstacle"][0]["polyline"].to_string(), "[[1.0, -0.05], [0.9, -0.05]]");
    assert_eq!(made["obstacle"][1]["circle"].to_string(), "{ center = [0.8, 0.35], radius = 0.04 }");
    // A specified height is used unchanged; a height of the drawing is scaled with it.
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
    place.run(&["import", "discs.dxf"], "--output w.toml --quiet").exits(0);
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
    let done = place.run(&["import", "lines.geojson"], "--output w.toml").exits(0);
    assert_eq!(names(&world(&place, "w.toml")), ["a\nb\"c"]);
    let comment = "# Polygon, layer \"x\\n[[obstacle]]\\nname = ";
    assert!(place.read("w.toml").lines().any(|line| line.starts_with(comment)), "{}", place.read("w.toml"));
    done.says(&["layer      x\\n[[obstacle]]"]);
}

#[test]
fn insertions_on_a_frozen_layer_are_omitted_with_its_name() {
    let place = Place::new();
    let layers =
        "0 SECTION 2 TABLES 0 TABLE 2 LAYER 0 LAYER 2 cold 70 1 62 7 0 LAYER 2 off 70 0 62 -7 0 ENDTAB 0 ENDSEC";
    let block = "0 SECTION 2 BLOCKS 0 BLOCK 2 pin 10 0 20 0 0 CIRCLE 8 0 10 0 20 0 40 1 0 CIRCLE 8 on 10 5 20 0 40 1 0 ENDBLK 0 ENDSEC";
    let inserts = "0 INSERT 8 off 2 pin 10 0 20 0 0 INSERT 8 cold 2 pin 10 0 20 100";
    let text = format!("{layers} {block} 0 SECTION 2 ENTITIES {inserts} 0 ENDSEC 0 EOF");
    place.write("pins.dxf", text.split_whitespace().map(|word| format!("{word}\n")).collect::<String>());
    let taken = |options: &str| {
        let done = place.run(&["import", "pins.dxf"], &format!("{options} --output w.toml")).exits(0);
        (world(&place, "w.toml")["obstacle"].as_array().unwrap().len(), done.stdout)
    };
    let message = ["off", "cold"].map(|layer| format!("layer \"{layer}\" is switched off and left out"));
    for (options, count, is_told) in [
        ("", 1, [true, true]),
        ("--layer on", 1, [false, true]),
        ("--layer cold", 2, [false; 2]),
        ("--layer pin", 4, [false; 2]),
    ] {
        let (taken, output) = taken(options);
        assert_eq!(
            (taken, message.clone().map(|note| output.contains(&note))),
            (count, is_told),
            "{options}: {output}"
        );
    }
}

#[test]
fn self_crossing_outlines_become_the_area_that_they_surround() {
    let place = Place::new();
    // The drawing has a bow tie, a loop that retraces itself, and a room around both.
    place.write(
        "odd.dxf",
        dxf("0 LWPOLYLINE 8 tie 70 1 10 0 20 0 10 100 20 100 10 100 20 0 10 0 20 100 \
        0 LWPOLYLINE 8 loop 70 1 10 200 20 0 10 300 20 0 10 300 20 50 10 300 20 0 \
        0 LWPOLYLINE 8 room 70 1 10 -500 20 -500 10 500 20 -500 10 500 20 500 10 -500 20 500"),
    );
    let done = place.run(&["import", "odd.dxf"], "--output w.toml").exits(0);
    assert_eq!(names(&world(&place, "w.toml")), ["tie 1", "tie 2", "loop", "room"]);
    done.says(&[
        "outlines that cross or touch themselves: the enclosed area is solid (line 16)",
        "outlines that enclose no area: imported as thin walls (line 38)",
        "\"room\" is solid and encloses everything else; --walls room makes it a wall, --without room leaves it out (line 60)",
    ]);
    let done = place.run(&["import", "odd.dxf"], "--walls room --output w.toml");
    assert!(!done.stdout.contains("--walls"), "{}", done.stdout);
    let made = world(&place, "w.toml");
    assert_eq!(made["obstacle"][3]["polyline"].as_array().unwrap().len(), 5);
}

/// Returns a drawing with two layers. WALLS has three squares and a ring of two polygons, and FEEDER has a disc.
fn hall() -> String {
    let square = |x: f64| {
        let [a, b] = [x, x + 100.0];
        format!("0 LWPOLYLINE 8 WALLS 70 1 10 {a} 20 200 10 {b} 20 200 10 {b} 20 300 10 {a} 20 300 ")
    };
    let texts = "0 TEXT 8 WALLS 1 a 0 HATCH 8 FEEDER 0 TEXT 8 FEEDER 1 b ";
    dxf(&(square(200.0) + &square(400.0) + &square(600.0) + texts + "0 CIRCLE 8 FEEDER 10 500 20 0 40 50"))
}

#[test]
fn options_take_the_names_that_the_world_gives() {
    let place = Place::new().with("hall.dxf", hall());
    let made = |options: &[&str]| {
        place.run(&[&["import", "hall.dxf"], options].concat(), "--output w.toml").exits(0);
        world(&place, "w.toml")
    };
    let kinds = |made: &toml::Table| -> Vec<String> {
        let kind = |o: &toml::Value| ["polygon", "polyline", "circle"].into_iter().find(|key| o.get(key).is_some());
        made["obstacle"].as_array().unwrap().iter().map(|o| kind(o).unwrap().to_owned()).collect()
    };
    assert_eq!(names(&made(&[])), ["WALLS 1", "WALLS 2", "WALLS 3", "FEEDER"]);
    // One obstacle is a wall, the others are solid. The circle is also a wall, with sufficiently accurate chords.
    let walls = made(&["--walls", "WALLS 2", "--walls", "feeder"]);
    assert_eq!(kinds(&walls), ["polygon", "polyline", "polygon", "polyline"]);
    for p in walls["obstacle"][3]["polyline"].as_array().unwrap() {
        let [x, y] = [0, 1].map(|k| p[k].as_float().unwrap());
        assert!(((x - 0.5).hypot(y) - 0.05).abs() < 1e-8, "{p}");
    }
    // The remaining obstacles keep their names if others are omitted.
    assert_eq!(names(&made(&["--without", "walls"])), ["FEEDER"]);
    let some = made(&["--without", "WALLS 1", "--height", "WALLS 3=0:2"]);
    assert_eq!(names(&some), ["WALLS 2", "WALLS 3", "FEEDER"]);
    assert!(some["obstacle"][0].get("height").is_none() && some["obstacle"][1].get("height").is_some());
    assert_eq!(names(&made(&["--layer", "WALLS 3"])), ["WALLS 3"]);
    place
        .run(&["import", "hall.dxf", "--without", "WALLS 4"], "")
        .refused(1, &["--without: the drawing has no layer or part \"WALLS 4\""]);
}

#[test]
fn notes_are_about_selected_elements_only() {
    let place = Place::new().with("hall.dxf", hall());
    let message = |options: &str| {
        let message = place.run(&["import", "hall.dxf"], &format!("{options} --json")).json();
        message["notes"].as_array().unwrap().iter().map(|note| note.as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(message(""), ["TEXT: left out (2 times, first in line 82)", "HATCH: left out (line 88)"]);
    assert_eq!(message("--layer FEEDER"), ["HATCH: left out (line 88)", "TEXT: left out (line 92)"]);
    assert_eq!(message("--layer walls"), ["TEXT: left out (line 82)"]);
    assert_eq!(message("--without walls"), ["HATCH: left out (line 88)", "TEXT: left out (line 92)"]);
}

#[test]
fn shapes_of_nested_blocks_have_their_places() {
    let place = Place::new();
    // The drawing has a triangle and a disc around the base point (1, 1), in a block that is mirrored, scaled by 2 and
    // turned by 90 degrees.
    let block = "0 SECTION 2 BLOCKS 0 BLOCK 2 unit 10 1 20 1 0 LWPOLYLINE 8 0 70 1 10 1 20 1 10 101 20 1 10 1 20 51 \
                 0 CIRCLE 8 0 10 201 20 1 40 10 0 ENDBLK \
                 0 BLOCK 2 pair 10 0 20 0 0 INSERT 8 0 2 unit 10 0 20 0 0 INSERT 8 0 2 unit 10 0 20 100 50 90 0 ENDBLK 0 ENDSEC";
    let insert = "0 INSERT 8 fix 2 pair 10 500 20 600 41 2 42 -2 50 90 0 CIRCLE 8 fix 10 -500 20 0 40 10";
    let text = format!("{block} 0 SECTION 2 ENTITIES {insert} 0 ENDSEC 0 EOF");
    place.write("units.dxf", text.split_whitespace().map(|word| format!("{word}\n")).collect::<String>());
    place.run(&["import", "units.dxf"], "--move 1,0 --turn 90deg --output w.toml").exits(0);
    let made = world(&place, "w.toml");
    assert_eq!(names(&made), ["pair 1", "pair 2", "pair 3", "pair 4", "fix"]);
    let shown = |i: usize, key: &str| made["obstacle"][i].get(key).map(ToString::to_string);
    for i in 0..4 {
        // (0.5, 0.6) turned by 90 degrees is (-0.6, 0.5).
        assert_eq!(shown(i, "at").as_deref(), Some("[0.4, 0.5]"));
        let angle = made["obstacle"][i]["angle"].as_float().unwrap();
        assert!((angle - std::f64::consts::PI).abs() < 1e-12, "{angle}");
    }
    // Twice as large and upside down, but not turned.
    let own = |i: usize| {
        let corners = made["obstacle"][i]["polygon"].as_array().unwrap();
        corners.iter().map(|p| [0, 1].map(|k| (p[k].as_float().unwrap() * 1e6).round() / 1e6 + 0.0)).collect::<Vec<_>>()
    };
    assert_eq!(own(0), [[0.0, 0.0], [0.2, 0.0], [0.0, -0.1]]);
    assert_eq!(shown(1, "circle").as_deref(), Some("{ center = [0.4, 0.0], radius = 0.02 }"));
    assert_eq!(own(2), [[0.0, -0.2], [0.0, -0.4], [-0.1, -0.2]]);
    assert_eq!((shown(4, "at"), shown(4, "circle")), (None, Some("{ center = [1.0, -0.5], radius = 0.01 }".into())));
}

#[test]
fn probable_mistakes_are_noted_with_a_hint() {
    let place = Place::new();
    let message = |entities: &str, options: &str| {
        place.write("w.dxf", dxf(entities));
        let message = place.run(&["import", "w.dxf"], &format!("{options} --json")).json();
        message["notes"].as_array().unwrap().iter().map(|note| note.as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    let base = "0 LWPOLYLINE 8 robot 70 1 10 -50 20 -50 10 50 20 -50 10 50 20 50 10 -50 20 50 ";
    let post = "0 CIRCLE 8 post 10 500 20 0 40 20 ";
    let reach = "0 CIRCLE 8 reach 10 0 20 0 40 700 ";
    let over = "\"robot\" covers (0, 0), the place of the arm's base; --without robot leaves it out, \
                --move moves the drawing (line 16)";
    assert_eq!(message(&format!("{base}{post}"), ""), [over]);
    assert_eq!(message(&format!("{base}{post}"), "--without robot"), [""; 0]);
    assert_eq!(message(&format!("{base}{post}"), "--move 0.2,0"), [""; 0]);
    let around = "\"reach\" is solid and encloses everything else; --walls reach makes it a wall, --without reach leaves it out (line 16)";
    assert_eq!(message(&format!("{reach}{post}"), ""), [around]);
    assert_eq!(message(&format!("{post}0 CIRCLE 8 post 10 900 20 0 40 20 "), ""), [""; 0]);
    // A tray with two pockets, beside a post: the pockets are solid, as the tray is.
    let tray = "0 LWPOLYLINE 8 tray 70 1 10 200 20 200 10 400 20 200 10 400 20 300 10 200 20 300 ";
    let pockets = "0 CIRCLE 8 pocket 10 250 20 250 40 20 0 CIRCLE 8 pocket 10 350 20 250 40 20 ";
    let beside = "0 CIRCLE 8 post 10 900 20 0 40 20 ";
    let solid = "\"tray\" is solid and contains \"pocket 1\" and 1 other; --walls tray makes \"tray\" a wall with a free inside \
                 (line 16)";
    assert_eq!(message(&format!("{tray}{pockets}{beside}"), ""), [solid]);
    assert_eq!(message(&format!("{tray}{pockets}{beside}"), "--walls tray"), [""; 0]);
    // Beside an outline, within its bounds only.
    let corner = "0 LWPOLYLINE 8 corner 70 1 10 200 20 200 10 400 20 200 10 400 20 220 10 220 20 220 10 220 20 400 10 200 20 400 ";
    let near = "0 CIRCLE 8 near 10 300 20 300 40 20 ";
    assert_eq!(message(&format!("{corner}{near}{beside}"), ""), [""; 0]);
    let wide = |width: &str| format!("the whole drawing is {width} wide; if this is wrong, state its unit by --unit");
    let two = format!("{post}0 CIRCLE 8 post 10 900 20 0 40 20 ");
    assert_eq!(message(&two, "--unit m"), [wide("440 m")]);
    assert_eq!(message(&two, "--unit um"), [wide("0.440 mm")]);
    // The main job and `inspect` report it, too.
    place.run(&["import", "w.dxf"], "--unit m --start 0,1 --goal 1,0.5 --output far.toml").exits(0);
    let robot = shipped("robots/planar_2r.urdf");
    let planned = place.run(&[robot.as_str(), "far.toml"], "");
    let part = "no obstacle is within reach: the nearest is 480.0000 m from joint 1";
    assert!(planned.code == 0 && planned.stderr.contains(part), "{}", planned.stderr);
    place.run(&["inspect", robot.as_str(), "far.toml"], "").says(&[part]);
    place.run(&["import", "w.dxf"], "--start 0,1 --goal 1,0.5 --output near.toml").exits(0);
    let report = place.run(&["inspect", robot.as_str(), "near.toml"], "");
    assert!(!report.stdout.contains("no obstacle is within"), "{}", report.stdout);
}

#[test]
fn a_picture_hides_no_shape_behind_names() {
    let place = Place::new();
    // Small obstacles come first, then one below all of them; two layers.
    let disc = |i: usize| format!("0 CIRCLE 8 pins 10 {} 20 {} 40 20 ", 100 * (i % 5), 100 * (i / 5));
    let plate = "0 LWPOLYLINE 8 plate 70 1 10 -60 20 -60 10 460 20 -60 10 460 20 460 10 -60 20 460";
    place.write("tray.dxf", dxf(&((0..24).map(disc).collect::<String>() + plate)));
    place.run(&["import", "tray.dxf"], "--output w.toml --picture w.svg").exits(0);
    let picture = place.read("w.svg");
    let xml = roxmltree::Document::parse(&picture).unwrap();
    let texts: Vec<&str> =
        xml.descendants().filter(|node| node.is_text()).filter_map(|node| node.text()).map(str::trim).collect();
    for i in 1..=24 {
        assert!(texts.contains(&format!("pins {i}").as_str()), "pins {i} is not in {texts:?}");
    }
    // The legend has a sample for each layer, and the plate's own name.
    assert_eq!(["pins", "plate"].map(|name| texts.iter().filter(|text| **text == name).count()), [1, 2]);
    // The plate, in the second colour, is drawn before all discs, which share the first.
    let filled = |node: &roxmltree::Node| node.attribute("fill").map(str::to_owned);
    let drawn: Vec<_> = xml.descendants().filter(|node| ["circle", "path"].contains(&node.tag_name().name())).collect();
    let first = drawn.iter().position(|node| node.tag_name().name() == "circle").unwrap();
    assert!(drawn[..first].iter().any(|node| filled(node).as_deref() == Some("#d98c99")), "{picture}");
    let discs: std::collections::HashSet<_> =
        drawn.iter().filter(|node| node.tag_name().name() == "circle").filter_map(filled).collect();
    assert_eq!(discs.len(), 1, "{discs:?}");
}

#[test]
fn errors_state_their_place_and_a_hint() {
    let place = Place::new()
        .with("text.dxf", dxf("0 TEXT 8 a 1 hello"))
        .with("nan.dxf", dxf("0 CIRCLE 8 a 10 nan 20 0 40 1"))
        .with("far.dxf", dxf("0 CIRCLE 8 a 10 1e15 20 0 40 1"))
        .with("high.dxf", dxf("0 CIRCLE 8 a 10 1 20 0 39 1e300 40 1"))
        .with("one.dxf", dxf("0 CIRCLE 8 a 10 1 20 0 40 1"))
        .with("tiny.geojson", r#"{"type": "Polygon", "coordinates": [[[0, 0], [1e-10, 0], [0, 1e-10], [0, 0]]]}"#)
        .with("cut.dxf", &dxf("0 CIRCLE 8 a 10 1 20 0 40 1")[..60])
        .with("broken.svg", "<svg>\n<g>\n</svg>")
        .with("broken.json", "{ \"type\":\n 3");
    let refused = |file: &str, options: &str, parts: &[&str]| {
        place.run(&["import", file], options).refused(1, parts);
    };
    refused(
        "text.dxf",
        "--output w.toml",
        &["text.dxf: this drawing contains no obstacle; TEXT: left out", "hint: draw outlines"],
    );
    refused("one.dxf", "--without a", &["this drawing contains no obstacle", "hint: use fewer --without options"]);
    refused("nan.dxf", "", &["nan.dxf: line 20, column 1: group 10 needs a number", "hint: "]);
    refused(
        "far.dxf",
        "",
        &["far.dxf: line 16, column 1: CIRCLE has a coordinate of 1.00e12 m (at most 1e6 is allowed)", "--move"],
    );
    refused(
        "high.dxf",
        "",
        &["high.dxf: line 16, column 1: CIRCLE has a height of 1.00e297 m (at most 1e6 is allowed)"],
    );
    let done = place.run(&["import", "tiny.geojson"], "");
    done.refused(1, &["this drawing contains no obstacle", "parts without length or area: left out"]);
    assert!(!done.stderr.contains("taken as"), "{}", done.stderr);
    refused("cut.dxf", "", &["cut.dxf: line ", "ends in the middle"]);
    refused("broken.svg", "", &["broken.svg: line 3", "not well-formed XML"]);
    refused("broken.json", "", &["broken.json: line 2", "not JSON"]);
    refused("none.dxf", "", &["none.dxf: cannot be read", "hint: "]);
    refused("one.dxf", "--layer b", &["--layer: the drawing has no layer or part \"b\"", "hint: choose one of \"a\""]);
    refused("one.dxf", "--output no/w.toml", &["the folder no does not exist"]);
    assert!(!place.path("w.toml").exists());
    for (file, options, part) in [
        ("one.step", "", "must end in .dxf, .svg, .geojson or .json"),
        ("one.dxf", "--output w.json", "must end in .toml"),
        ("one.dxf", "--height a=1", "NAME=LOW:HIGH"),
        ("one.dxf", "--height a=1:0", "lower end"),
        ("one.dxf", "--height a=0:1e300", "NAME=LOW:HIGH"),
        ("one.dxf", "--scale 0", "greater than 0"),
        ("one.dxf", "--unit feet", "the units are mm, cm"),
    ] {
        place.run(&["import", file], options).refused(2, &[part]);
    }
    let error = serde_json::from_str::<Value>(&place.run(&["import", "nan.dxf"], "--json").stdout).unwrap();
    assert_eq!((&error["file"], &error["line"]), (&"nan.dxf".into(), &20.into()));
    place.run(&["import", "broken.svg"], "--picture broken.svg").refused(1, &["the output broken.svg is the input"]);
}

/// Checks a map with projected coordinates, as surveys and GIS use them. With the options that the hint suggests, the
/// world of the map is suitable for planning.
#[test]
fn projected_coordinates_are_moved_as_the_hint_says() {
    let place = Place::new();
    let square = "[[[500123.5, 5400456.25], [500124.5, 5400456.25], [500124.5, 5400457.25], [500123.5, 5400456.25]]]";
    place.write("site.geojson", format!(r#"{{"type": "Polygon", "coordinates": {square}}}"#));
    for before in ["", " --turn 30deg", " --move 3,4"] {
        let refused = place.run(&["import", "site.geojson"], &format!("--json{before}")).json();
        let cure = refused["cure"].as_str().unwrap();
        let hint = cure.split("--move ").nth(1).unwrap().split(' ').next().unwrap().to_owned();
        let turn = before.trim().strip_prefix("--turn").map_or(String::new(), |turn| format!(" --turn{turn}"));
        let options = format!("--output w.toml --move {hint}{turn}");
        place.run(&["import", "site.geojson"], &options).exits(0);
        let made = world(&place, "w.toml");
        let corner = made["obstacle"][0]["polygon"][0].as_array().unwrap();
        assert!(corner.iter().all(|x| x.as_float().unwrap().abs() < 2.0), "{corner:?}");
        std::fs::remove_file(place.path("w.toml")).unwrap();
    }
    // No move helps if the drawing itself is too large.
    place.write("site.geojson", r#"{"type": "LineString", "coordinates": [[0, 0], [5e6, 0]]}"#);
    let cure = place.run(&["import", "site.geojson"], "--json").json()["cure"].to_string();
    assert!(cure.contains("--unit") && !cure.contains("--move"), "{cure}");
}

/// Options leave parts out by their size in the world, after scaling and turning; walls, circles and blocks alike.
#[test]
fn parts_are_left_out_by_size() {
    // A tray of 100 mm, a pocket of 30 by 20 mm, a screw of 6 mm, and a wall of 50 mm.
    let drawing = dxf("0 LWPOLYLINE 8 tray 90 4 70 1 10 0 20 0 10 100 20 0 10 100 20 80 10 0 20 80 \
         0 LWPOLYLINE 8 pocket 90 4 70 1 10 10 20 10 10 40 20 10 10 40 20 30 10 10 20 30 \
         0 CIRCLE 8 screw 10 60 20 60 40 3 0 LINE 8 wall 10 200 20 0 11 200 21 50");
    let place = Place::new().with("tray.dxf", drawing);
    for (words, expected, note) in [
        ("", &["tray", "pocket", "screw", "wall"][..], ""),
        ("--min-size 0.03", &["tray", "pocket", "wall"], "parts smaller than 0.03 m: left out (line"),
        ("--min-size 0.0301", &["tray", "wall"], "parts smaller than 0.0301 m: left out (2 times, first in line"),
        ("--max-size 0.06", &["pocket", "screw", "wall"], "parts larger than 0.06 m: left out (line"),
        ("--min-size 0.01 --max-size 0.04", &["pocket"], "parts larger than 0.04 m"),
        ("--min-size 0.03 --scale 10", &["tray", "pocket", "screw", "wall"], ""),
        ("--min-size 0.03 --turn 90deg --walls tray", &["tray", "pocket", "wall"], "parts smaller"),
        ("--min-size 0.03 --layer screw --layer tray", &["tray"], "parts smaller"),
    ] {
        let done = place.run(&["import", "tray.dxf", "--output", "w.toml"], words).exits(0);
        assert_eq!(names(&world(&place, "w.toml")), expected, "{words}");
        assert!(
            done.stdout.contains(note) && done.stdout.contains("left out") != note.is_empty(),
            "{words}: {}",
            done.stdout
        );
    }
    place.run(&["import", "tray.dxf"], "--min-size 2").refused(1, &["this drawing contains no obstacle", "--min-size"]);
    place
        .run(&["import", "tray.dxf"], "--min-size 2 --max-size 1")
        .refused(2, &["--min-size 2 is larger than --max-size 1"]);
    place.run(&["import", "tray.dxf"], "--min-size 0").refused(2, &["greater than 0"]);
}
