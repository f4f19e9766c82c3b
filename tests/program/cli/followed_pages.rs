//! Pictures and pages of lines that the tip follows: compared with the written samples, by the tests' own kinematics.

use super::*;
/// Follows a line and returns the data of its page. Writes the motion to `m.csv` and the picture to `m.svg`.
fn page(place: &Place, world: &str, text: &str, options: &str, code: i32) -> Value {
    place.write("line.gcode", text);
    let options = format!("{options} --picture m.html --picture m.svg --output m.csv --quiet");
    place.run(&["follow", &shipped("robots/planar_2r.urdf"), world, "line.gcode"], &options).exits(code);
    let page = place.read("m.html");
    let data = page.split("<script id=\"view\" type=\"application/json\">").nth(1).unwrap();
    serde_json::from_str(data.split("</script>").next().unwrap()).unwrap()
}

/// Returns the rows of the motion: time, positions and velocities.
fn rows(place: &Place) -> Vec<[f64; 5]> {
    let csv = place.read("m.csv");
    let row = |line: &str| {
        let fields: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
        <[f64; 5]>::try_from(fields).unwrap()
    };
    csv.lines().skip(1).map(row).collect()
}

/// Returns the joint values on the cubic between two rows.
fn between(a: &[f64; 5], b: &[f64; 5], u: f64) -> [f64; 2] {
    let h = b[0] - a[0];
    [1, 2].map(|k| {
        let (v, w) = (1.0 - u, u);
        let bezier = [a[k], a[k] + h * a[k + 2] / 3.0, b[k] - h * b[k + 2] / 3.0, b[k]];
        v * v * v * bezier[0] + 3.0 * v * v * w * bezier[1] + 3.0 * v * w * w * bezier[2] + w * w * w * bezier[3]
    })
}

#[test]
fn the_page_states_the_measured_distance_from_the_line() {
    let place = Place::new();
    let world = shipped("workspaces/follow/engraving.toml");
    // With a small tolerance, the tip leaves a straight line by less than the page's digits show.
    let data = page(&place, &world, "G21 G0 X1100 Y-150\nG1 X1200 F3000\n", "--tolerance 2mm", 0);
    let motion = &data["line"]["motion"];
    let rows = rows(&place);
    let mut farthest = 0.0_f64;
    for pair in rows.windows(2) {
        for k in 0..=16 {
            let [_, y] = tip(between(&pair[0], &pair[1], f64::from(k) / 16.0));
            farthest = farthest.max((y + 0.15).abs());
        }
    }
    let [time, offset] = [0, 1].map(|k| number(&motion["farthest"][k]));
    assert!(farthest > 1e-7 && (offset.abs() - farthest).abs() < 0.05 * farthest, "{offset} {farthest}");
    let next = rows.iter().position(|row| row[0] >= time).unwrap().max(1);
    let [a, b] = [&rows[next - 1], &rows[next]];
    let there = tip(between(a, b, (time - a[0]) / (b[0] - a[0])));
    // The line leads to the right, so its left side is above.
    assert!((there[1] + 0.15 - offset).abs() < 1e-8, "{there:?} {offset}");
    assert!(offset.abs() <= number(&motion["deviation"]) && number(&motion["deviation"]) <= 2e-3);
    let bins = motion["deviations"].as_array().unwrap();
    let most = bins.iter().flat_map(|bin| [0, 1].map(|k| number(&bin[k]).abs())).fold(0.0, f64::max);
    assert!((most - (offset.abs() / 2e-3 * 1000.0).round()).abs() < 1.5, "{most}");
}

/// The speed of the file limits the line, and the acceleration of a joint the beginning and the end.
#[test]
fn the_page_states_which_limit_is_reached_where() {
    let place = Place::new();
    let world = shipped("workspaces/follow/engraving.toml");
    let data = page(&place, &world, "G21 G0 X1100 Y-150\nG1 X1300 F30000\n", "", 0);
    let motion = &data["line"]["motion"];
    let names: Vec<&str> =
        motion["limits"].as_array().unwrap().iter().map(|limit| limit[0].as_str().unwrap()).collect();
    let rows = rows(&place);
    let mut from = 0.0;
    let mut limited = 0.0;
    for stretch in motion["stretches"].as_array().unwrap() {
        let (to, name) = (number(&stretch[0]), names[stretch[1].as_u64().unwrap() as usize]);
        let inside: Vec<_> = rows.windows(2).filter(|pair| from <= pair[0][0] && pair[1][0] <= to).collect();
        let speed = |pair: &[[f64; 5]]| {
            let [a, b] = [&pair[0], &pair[1]].map(|row| tip([row[1], row[2]]));
            (b[0] - a[0]).hypot(b[1] - a[1]) / (pair[1][0] - pair[0][0])
        };
        let fast = inside.iter().filter(|pair| speed(pair) > 0.97 * 0.5).count();
        if name == "speed limit of the tip" {
            assert!(fast * 10 >= inside.len() * 9, "{fast} of {}", inside.len());
            limited += to - from;
        } else {
            assert!(name.starts_with("acceleration limit of ") || name.starts_with("no limit"), "{name}");
            assert!(fast * 2 <= inside.len().max(2), "{name}: {fast} of {}", inside.len());
        }
        from = to;
    }
    let duration = rows[rows.len() - 1][0];
    assert!((from - duration).abs() < 1e-4, "the stretches cover the motion");
    assert!(limited > 0.5 * duration && limited < 0.95 * duration, "{limited} of {duration}");
    assert_eq!(motion["stops"].as_array().unwrap().len(), 2);
    let picture = place.read("m.svg");
    has(
        &picture,
        &[
            "Speed of the tip, coloured by the limit that it reaches",
            "Greatest deviation from the line, magnified",
            "off the line (mm)",
        ],
    );
}

#[test]
fn both_solutions_of_the_shipped_plate_are_drawn() {
    let place = Place::new();
    let world = shipped("workspaces/follow/engraving.toml");
    let plate = read(shipped("workspaces/follow/plate.gcode"));
    let line = &page(&place, &world, &plate, "", 0)["line"];
    let parts = line["solutions"].as_array().unwrap();
    for part in parts {
        let points: Vec<f64> = part["points"].as_array().unwrap().iter().map(number).collect();
        for q in points.chunks(2) {
            let [x, y] = tip([q[0], q[1]]);
            assert!((1.1 - 1e-4..1.3 + 1e-4).contains(&x) && (-0.15 - 1e-4..0.15 + 1e-4).contains(&y), "{x} {y}");
            // The clamp excludes the solution with the elbow above.
            assert_eq!(part["excluded"], q[1] < 0.0, "{q:?}");
        }
    }
    let names: Vec<&str> = line["names"].as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
    assert_eq!(names, ["IK solution 1, used", "IK solution 2, excluded"]);
    let focus = [0, 1].map(|k| [0, 1].map(|end| number(&line["focus"]["ranges"][k][end])));
    assert!(focus[0][0] < 1.1 && 1.3 < focus[0][1] && focus[0][1] - focus[0][0] < 0.6, "{focus:?}");
    let picture = place.read("m.svg");
    has(&picture, &["IK solution 1, used", "IK solution 2, excluded", "speed limit of the tip"]);
}

#[test]
fn an_infeasible_line_is_drawn_with_its_excluded_solutions() {
    let place = Place::new();
    let wall = |name: &str, low: f64, high: f64| {
        format!(
            "[[obstacle]]\nname = \"{name}\"\npolygon = [[0.2, {low}], [1.0, {low}], [1.0, {high}], [0.2, {high}]]\n"
        )
    };
    place.write("world.toml", &(wall("above", 0.3, 0.6) + &wall("below", -0.6, -0.3)));
    let data = page(&place, "world.toml", "G21 G0 X1000 Y-100\nG1 Y100\n", "", 3);
    let excluded = data["line"]["excluded"].as_array().unwrap();
    assert_eq!(excluded.len(), 2);
    for q in excluded {
        let [x, y] = tip([0, 1].map(|k| number(&q[k])));
        assert!((x - 1.0).hypot(y + 0.1) < 1e-4, "{q}");
    }
    assert!(data["line"]["motion"].is_null() && data["line"]["focus"].is_null());
    for file in ["m.html", "m.svg"] {
        let text = place.read(file).replace("&quot;", "\"").replace("\\\"", "\"");
        has(&text, &["hits obstacle \"above\"", "hits obstacle \"below\""]);
    }
}
