//! Pictures as the sources draw them: trapezoids, numbers of waves, flow lines.

use super::*;

fn drawn(place: &Place, files: &[String; 2], options: &str) -> String {
    place.run(files, &format!("{options} --picture picture.svg --output cspace.json")).exits(0);
    place.read("picture.svg")
}

fn texts(picture: &str) -> Vec<&str> {
    let texts = picture.split("<text").skip(1).filter_map(|text| text.split_once('>')?.1.split_once("</text>"));
    texts.map(|(text, _)| text.trim()).collect()
}

fn space(place: &Place) -> Value {
    let spaces = place.json("cspace.json");
    spaces["spaces"][0].clone()
}

fn values(list: &Value) -> Vec<[f64; 2]> {
    serde_json::from_value(list.clone()).unwrap()
}

/// Compares pictures of trapezoids with figures 6.11 and 6.12 of the course. Formerly, only cells wider than five
/// pixels had outlines.
#[test]
fn all_trapezoids_are_outlined_and_the_channels_points_are_marked() {
    let place = Place::new();
    let picture = drawn(&place, &shelf(), "--planner trapezoid --path own");
    let cells = space(&place)["cells"]["corners"].as_array().unwrap().len();
    // Closed pieces of the outlines in the colour of cells.
    let of = |path: &&str| path.contains("stroke=\"#7d8fa6\"");
    let closed: usize = picture.split("<path").filter(of).map(|path| path.matches('Z').count()).sum();
    assert!(cells > 100 && closed >= cells, "{closed} of {cells}");

    let picture = drawn(&place, &maze(), "--planner trapezoid --path own");
    for text in ["Q1", "C2", "Q2", "centres of cells (C)", "middles of doors (Q)"] {
        assert!(texts(&picture).contains(&text), "{text}");
    }
    let space = space(&place);
    let [centers, middles] = ["centers", "middles"].map(|key| values(&space["cells"][key]));
    assert_eq!(
        (centers.len(), middles.len() + 1),
        (space["cells"]["channel"].as_array().unwrap().len(), centers.len())
    );
}

/// Checks the simpler path of the course, section 6.3.2. It visits the middles of all portals. It visits the centre of
/// a cell only between portals on one line.
#[test]
fn the_path_of_middles_has_a_centre_only_between_collinear_portals() {
    let place = Place::new();
    drawn(&place, &maze(), "--planner trapezoid --path middles");
    let space = space(&place);
    let [centers, middles] = ["centers", "middles"].map(|key| values(&space["cells"][key]));
    let mut expected = values(&serde_json::json!([space["start"]]));
    let mut spared = 0;
    for (k, &middle) in middles.iter().enumerate() {
        if k > 0 && middles[k - 1][0] == middle[0] {
            expected.push(centers[k]);
        } else {
            spared += usize::from(k > 0);
        }
        expected.push(middle);
    }
    expected.push(values(&space["goals"][0])[0]);
    assert_eq!(values(&space["paths"][0]["waypoints"]), expected);
    assert!(spared > 0);
    let result = place.run(&maze(), "--planner trapezoid --path middles --json --quiet").json();
    assert_eq!((&result["path_kind"], &result["certified"]), (&"middles".into(), &true.into()));
    place.run(&maze(), "--planner triangles --path middles").refused(2, &["--path middles needs --planner trapezoid"]);
}

/// Checks a path around the end of a bar: the channel enters a cell and leaves it by the same vertical.
#[test]
fn portals_on_one_vertical_have_the_centre_of_their_cell_between_them() {
    let place = Place::new();
    let world = "[start]\njoints = [0.2, 0.2]\n[goal]\njoints = [0.2, 1.3]\n\
                 [[obstacle]]\nname = \"bar\"\npolygon = [[-0.2, 0.7], [1.0, 0.7], [1.0, 0.8], [-0.2, 0.8]]\nheight = [0.0, 0.3]\n";
    place.write("world.toml", world);
    let files = [shipped("robots/gantry.urdf"), "world.toml".to_owned()];
    drawn(&place, &files, "--margin 0 --planner trapezoid --path middles");
    let waypoints = values(&space(&place)["paths"][0]["waypoints"]);
    assert_eq!(waypoints.len(), 5, "{waypoints:?}");
    assert!(waypoints[1][0] == waypoints[3][0] && waypoints[2][0] > waypoints[1][0], "{waypoints:?}");
}

/// Compares the numbers in a picture of cells with figure 6.14 of the course.
#[test]
fn cells_of_a_coarse_grid_have_the_numbers_of_the_wave() {
    let place = Place::new();
    let picture = drawn(&place, &maze(), "--planner wavefront --cells 16 --path own");
    let space = space(&place);
    assert_eq!(space["grid"]["shape"], serde_json::json!([16, 16]));
    let steps: Vec<Option<f64>> = serde_json::from_value(space["grid"]["values"].clone()).unwrap();
    for step in steps.iter().flatten() {
        let count = |value: f64| steps.iter().flatten().filter(|&&s| s == value).count();
        let shown = texts(&picture).iter().filter(|text| **text == step.to_string()).count();
        assert!(shown >= count(*step), "{step}: {shown}");
    }
    let fine = drawn(&place, &maze(), "--planner wavefront --cells 64 --path own");
    assert!(!texts(&fine).contains(&"37"));
}

/// Checks that the program uses the requested number of cells, or finds no path and states that number as the reason.
#[test]
fn coarse_grids_are_kept_or_refused_with_the_reason() {
    let place = Place::new();
    let done = place.run(&shelf(), "--planner wavefront --cells 16 --quiet --json --output cspace.json").exits(4);
    assert_eq!(space(&place)["grid"]["shape"], serde_json::json!([16, 16]));
    let reason = done.json()["reason"].as_str().unwrap().to_owned();
    assert!(reason.contains("16 x 16 cells") && reason.ends_with("more --cells or --levels may find one"), "{reason}");
    let more = place.run(&shelf(), "--planner wavefront --cells 16 --levels 6 --verbose").exits(0);
    more.says(&["32 x 32, because 16 x 16 cells show no certified path"]);
    // The option does not affect planners without cells.
    place.run(&shelf(), "--planner visibility --cells 16 --quiet").exits(0);
}

/// Compares pictures of flow lines with figures 34 and 35 of Deicu's text.
#[test]
fn flow_lines_are_drawn_if_requested() {
    let place = Place::new();
    let of = |lines: &str| drawn(&place, &shelf(), &format!("--planner harmonic --cells 48 {lines}"));
    let usual = of("");
    assert_eq!(usual, of("--field-lines equipotentials"));
    let [flow, both] = ["flow", "both"].map(|lines| of(&format!("--field-lines {lines}")));
    let has = |picture: &str| ["equipotentials", "flow lines"].map(|text| texts(picture).contains(&text));
    assert_eq!([has(&usual), has(&flow), has(&both)], [[true, false], [false, true], [true, true]]);
    // Lines begin at 16 x 16 places, except for those within obstacles. Each has an arrowhead.
    let heads = flow
        .split("<path")
        .filter(|path| path.contains("fill=\"#0072b2\""))
        .map(|path| path.matches('Z').count())
        .sum::<usize>();
    assert!((100..=256).contains(&heads), "{heads}");
}

/// Checks that a dark picture has the same items as a light one, and differs in colours alone.
#[test]
fn dark_pictures_differ_in_their_colors_alone() {
    let place = Place::new();
    let [light, dark] = ["", "--theme dark"].map(|theme| drawn(&place, &shelf(), theme));
    assert_eq!(light, drawn(&place, &shelf(), "--theme light"));
    differ_in_their_colors_alone("plan", &light, &dark);
}

/// Checks one picture of each command that draws.
#[test]
fn every_command_draws_dark_pictures() {
    let place = Place::new();
    let [robot, world] = shelf();
    place.run(&shelf(), "--output plan.csv --quiet").exits(0);
    let of = |words: &str| -> Vec<String> {
        words.split(' ').map(|word| word.replace("ROBOT", &robot).replace("WORLD", &world)).collect()
    };
    let (closed, drawing) = (shipped("workspaces/no_path.toml"), shipped("workspaces/drawings/cell.dxf"));
    for (words, options) in [
        (of("check ROBOT WORLD"), "--at 0,0"),
        (of("inspect ROBOT WORLD"), ""),
        (of("reach ROBOT WORLD"), ""),
        (vec!["explain".to_owned(), robot.clone(), closed], ""),
        (of("verify ROBOT WORLD plan.csv"), ""),
        (of("compare ROBOT WORLD"), "--planner shortest --planner visibility"),
        (of("converge ROBOT WORLD"), "--cells 12"),
        (of("explore ROBOT WORLD"), ""),
        (vec!["import".to_owned(), drawing], "--output cell.toml"),
    ] {
        let [light, dark] = ["light", "dark"].map(|theme| {
            let done = place.run(&words, &format!("{options} --picture {theme}.svg --theme {theme}"));
            assert!([0, 3].contains(&done.code), "{words:?}: {}", done.stderr);
            place.read(&format!("{theme}.svg"))
        });
        differ_in_their_colors_alone(&words[0], &light, &dark);
    }
}

/// Checks that both pictures have the same items, and that nothing of the dark one is left white.
fn differ_in_their_colors_alone(command: &str, light: &str, dark: &str) {
    let colors = |picture: &str| -> Vec<String> {
        picture.split("\"#").skip(1).filter_map(|rest| Some(rest.get(..6)?.to_owned())).collect()
    };
    let without_colors = |picture: &str| {
        colors(picture).iter().fold(picture.to_owned(), |text, color| text.replace(&format!("\"#{color}"), "\"#"))
    };
    assert_eq!(without_colors(light), without_colors(dark), "{command}");
    // The background is the first colour.
    assert_eq!([&colors(light)[0], &colors(dark)[0]], ["ffffff", "16191d"], "{command}");
    assert!(!colors(dark).contains(&"ffffff".to_owned()), "{command}: nothing is left white");
}
