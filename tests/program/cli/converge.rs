//! `cplan converge`.

use super::*;
use std::collections::BTreeMap;

/// Returns files with a coarse grid, so that debug builds finish soon.
fn files() -> Vec<String> {
    let mut words = vec!["converge".to_owned()];
    words.extend(shelf());
    words.extend(["--cells".to_owned(), "20".to_owned()]);
    words
}

#[test]
fn the_tables_fit_a_terminal_and_agree_with_the_json() {
    let place = Place::new();
    let done = place.run(&files(), "").exits(0);
    assert!(done.stdout.lines().all(|line| line.chars().count() <= 80), "{}", done.stdout);
    done.warns(&["harmonic: relaxations ..."]);
    let quiet = place.run(&files(), "--quiet");
    assert_eq!((quiet.code, quiet.stdout.as_str(), quiet.stderr.as_str()), (0, "", ""));
    let json = place.run(&files(), "--json --quiet").json();
    let relaxations = json["relaxations"].as_array().unwrap();
    assert_eq!(relaxations.len(), 24);
    for entry in relaxations {
        let (equation, sweeps) = (entry["equation"].as_str().unwrap(), entry["sweeps"].as_u64().unwrap());
        let name = entry["relaxation"].as_str().unwrap();
        let order = entry["order"].as_str().unwrap_or(name);
        let line = done.stdout.lines().find(|line| {
            let relaxation = line.strip_prefix(equation).unwrap_or_default().trim_start();
            relaxation.starts_with(name) && relaxation.contains(order)
        });
        let line = line.unwrap_or_else(|| panic!("{equation}, {name}, {order}: {}", done.stdout));
        assert!(line.split_whitespace().any(|word| word == sweeps.to_string()), "{line}: {sweeps}");
        let samples = entry["samples"]["sweep"].as_array().unwrap();
        assert_eq!((samples[0].as_u64(), samples.last().unwrap().as_u64()), (Some(1), Some(sweeps)));
        let lengths = entry["samples"].as_object().unwrap().values().map(|list| list.as_array().unwrap().len());
        assert!(lengths.into_iter().all(|length| length == samples.len()));
    }
}

#[test]
fn files_hold_one_measurement_the_same_each_time() {
    let place = Place::new();
    let outputs = "--output a.csv --output a.json --picture a.svg --picture a.html --quiet";
    place.run(&files(), outputs).exits(0);
    let kept = ["a.csv", "a.json", "a.svg", "a.html"].map(|file| (file, place.read(file)));
    place.run(&files(), outputs).exits(0);
    for (file, content) in &kept {
        assert!(place.read(file) == *content, "{file} differs");
    }
    let json: Value = serde_json::from_str(&kept[1].1).unwrap();
    // CSV: each line has as many cells as columns, with the samples of the JSON.
    let mut lines = csv_lines(&kept[0].1);
    let header = lines.remove(0);
    let mut sweeps: BTreeMap<[String; 4], Vec<(u64, String)>> = BTreeMap::new();
    for cells in &lines {
        assert_eq!(cells.len(), header.len(), "{cells:?}");
        let key = [&cells[1], &cells[2], &cells[3], &cells[4]].map(String::clone);
        if cells[0] == "error" {
            sweeps.entry(key).or_default().push((cells[7].parse().unwrap(), cells[11].clone()));
        }
    }
    assert_eq!(sweeps.len(), 24);
    for entry in json["relaxations"].as_array().unwrap() {
        let key = ["equation", "relaxation", "order"].map(|k| entry[k].as_str().unwrap_or_default().to_owned());
        let [equation, relaxation, order] = key;
        let found = &sweeps[&[equation, relaxation, order, entry["factor"].to_string().replace(".0", "")]];
        let expected: Vec<u64> =
            entry["samples"]["sweep"].as_array().unwrap().iter().map(|s| s.as_u64().unwrap()).collect();
        assert_eq!(found.iter().map(|f| f.0).collect::<Vec<_>>(), expected);
        assert_eq!(found.last().unwrap().1, entry["ending"].as_str().unwrap());
        assert!(found[..found.len() - 1].iter().all(|f| f.1.is_empty()));
    }
    for series in ["factor", "epsilon"] {
        assert!(lines.iter().filter(|cells| cells[0] == series).count() > 60, "{series}");
    }
    let svg = roxmltree::Document::parse(&kept[2].1).unwrap();
    let titles = svg.descendants().filter(|n| n.attribute("font-size") == Some("14")).count();
    assert_eq!(titles, 6, "three equations, two factors and epsilon");
    // The factors of weighted Jacobi increase up to the first one that does not converge.
    for scan in json["weights"].as_array().unwrap() {
        let points = scan["points"].as_array().unwrap();
        let (last, before) = points.split_last().unwrap();
        assert!(before.iter().all(|point| point["ending"] == "converged") && last["ending"] != "converged", "{scan}");
        assert!(scan["best"]["factor"].as_f64().unwrap() >= 0.9, "{scan}");
    }
    assert!(lines.iter().filter(|cells| cells[0] == "weight" && cells[2] == "weighted-jacobi").count() > 30);
    assert!(!kept[2].1.contains("NaN"));
    assert!(kept[3].1.contains("<svg") || kept[3].1.contains("data:image/svg+xml"));
}

/// Splits each line into cells; names may hold a comma within quotes.
fn csv_lines(text: &str) -> Vec<Vec<String>> {
    let cells = |line: &str| {
        let mut cells = vec![String::new()];
        let mut quoted = false;
        for c in line.chars() {
            match c {
                '"' => quoted = !quoted,
                ',' if !quoted => cells.push(String::new()),
                c => cells.last_mut().unwrap().push(c),
            }
        }
        cells
    };
    text.lines().map(cells).collect()
}

/// Relaxes with `converge` and with the planner, and compares the numbers of sweeps.
#[test]
fn over_relaxation_takes_as_many_sweeps_as_in_a_plan() {
    let place = Place::new();
    let cells = "--cells 32 --measure relative --quiet --json";
    let json = place.run(&[vec!["converge".to_owned()], shelf().to_vec()].concat(), cells).json();
    for order in ["rows", "corners", "red-black"] {
        let all = json["relaxations"].as_array().unwrap().iter();
        let of =
            |entry: &&Value| entry["equation"] == "harmonic" && entry["relaxation"] == "sor" && entry["order"] == order;
        let counted = all.clone().find(of).unwrap()["sweeps"].clone();
        let options = format!("--planner harmonic --levels 1 --relaxation sor --order {order} {cells}");
        assert_eq!(place.run(&shelf(), &options).json()["size"]["sweeps"], counted, "{order}");
    }
}

#[test]
fn each_axis_may_have_its_own_number_of_cells() {
    let place = Place::new();
    let words = [vec!["converge".to_owned()], shelf().to_vec()].concat();
    let json = place.run(&words, "--cells 32x16 --quiet --json").json();
    assert_eq!(json["cells"], serde_json::json!([32, 16]));
    place.run(&words, "--cells 32x16 --quiet --output a.json").exits(0);
    let low = place.run(&words, "--cells 32x16 --initial low --quiet --json").json();
    let sweeps = |json: &Value, k: usize| json["relaxations"][k]["sweeps"].as_u64().unwrap();
    assert!((0..8).all(|k| sweeps(&low, k) > sweeps(&json, k)), "values far from the goal fall for a long time");
}

#[test]
fn divergence_is_reported() {
    let place = Place::new();
    let done = place.run(&files(), "--epsilon 30 --direction 1,1 --json --quiet").exits(0);
    let json = done.json();
    let of = |equation: &str, relaxation: &str| {
        let all = json["relaxations"].as_array().unwrap().iter();
        let of = all.filter(|e| e["equation"] == equation && e["relaxation"] == relaxation);
        of.map(|e| e["ending"].as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(of("oriented, central", "jacobi"), ["diverged"]);
    assert!(of("oriented, central", "gauss-seidel").iter().all(|ending| ending != "converged"));
    assert_eq!(of("oriented, upwind", "gauss-seidel"), ["converged"; 3]);
    assert!(!done.stdout.contains("NaN"));
    place.run(&files(), "--epsilon 30 --direction 1,1 --quiet --output a.csv").exits(0);
    assert!(csv_lines(&place.read("a.csv")).iter().any(|c| c[2] == "jacobi" && c[11] == "diverged"));
}

#[test]
fn regions_of_the_world_are_relaxed_too() {
    let place = Place::new();
    let region = "[[preference]]\nname = \"bay\"\nepsilon = 1\nconfigurations = [[0, 0], [1, 0], [0, 1]]\n";
    place.write("world.toml", format!("{FREE}{region}"));
    let urdf = shipped("robots/planar_2r.urdf");
    let json = place.run(&["converge", urdf.as_str(), "world.toml"], "--cells 16 --json --quiet").json();
    let of = |names: &[&str]| -> Vec<&Value> {
        let all = json["relaxations"].as_array().unwrap().iter();
        all.filter(|entry| names.contains(&entry["equation"].as_str().unwrap())).collect()
    };
    let two_stages = of(&["bvp", "bvp2"]);
    assert_eq!(two_stages.len(), 16);
    for entry in two_stages {
        // Compares the last sweep of the harmonic field with the next one, whose changes are much larger.
        let (leap, samples) = (&entry["leap"], &entry["samples"]);
        let at = samples["sweep"].as_array().unwrap().iter().position(|sweep| *sweep == leap["sweep"]).unwrap();
        assert_eq!(samples["sweep"][at + 1], leap["sweep"].as_u64().unwrap() + 1);
        assert_eq!(
            (&samples["squared_change"][at], &samples["squared_change"][at + 1]),
            (&leap["before"], &leap["after"])
        );
        assert!(leap["after"].as_f64() > leap["before"].as_f64(), "{leap}");
        assert_eq!(leap["sweep"].as_u64().unwrap() + leap["more"].as_u64().unwrap(), entry["sweeps"].as_u64().unwrap());
        let stages: Vec<u64> =
            entry["samples"]["stage"].as_array().unwrap().iter().map(|s| s.as_u64().unwrap()).collect();
        assert!(stages.is_sorted() && stages.contains(&0) && stages.contains(&1), "{stages:?}");
        assert!(entry["samples"]["error"].as_array().unwrap().iter().all(Value::is_null));
    }
    // Locally oriented fields have one stage, an exact solution for comparison, and the requested direction.
    let local = of(&["local, central", "local, upwind"]);
    assert_eq!(local.len(), 16);
    assert!(local.iter().all(|entry| entry["leap"].is_null() && entry["samples"]["error"][0].is_number()));
    let text = place.run(&["converge", urdf.as_str(), "world.toml"], "--cells 16");
    assert!(text.stdout.lines().all(|line| line.chars().count() <= 80), "{}", text.stdout);
    text.says(&["where preferences begin: squared changes"]);
    let turned =
        place.run(&["converge", urdf.as_str(), "world.toml"], "--cells 16 --json --quiet --direction 0,-1").json();
    assert_ne!(turned["relaxations"], json["relaxations"]);
}

#[test]
fn bad_input_gives_one_error() {
    let place = Place::new();
    for (options, code, parts) in [
        ("--cells 4", 2, ["from 8 to 256", ""]),
        ("--cells 1000", 2, ["from 8 to 256", ""]),
        ("--cells 80x257", 2, ["one per joint, such as 80x40", ""]),
        ("--direction 0,0", 2, ["not both 0", ""]),
        ("--epsilon nan", 2, ["finite", ""]),
        ("--tolerance 0", 2, ["greater than 0", ""]),
        ("--order spiral", 2, ["red-black", ""]),
        ("--measure norm", 2, ["squares", ""]),
        ("--output a.txt", 2, ["a.txt", ".csv or .json"]),
        ("--picture a.pdf", 2, ["a.pdf", ".svg, .png, .gif or .html"]),
        ("--output a.json --output ./a.json", 1, ["the same file", ""]),
        ("--output nowhere/a.csv", 1, ["nowhere", ""]),
    ] {
        let mut words = vec!["converge".to_owned()];
        words.extend(shelf());
        place.run(&words, options).refused(code, &parts);
    }
    let urdf = shipped("robots/scara.urdf");
    let task = shipped("workspaces/tasks/kitting_cell.toml");
    place.run(&["converge", &urdf, &task], "").refused(1, &["a world with steps", "hint: "]);
    place.run(&["converge", "no.urdf", "no.toml"], "").refused(1, &["no.toml: cannot be read"]);
    let coarse = place.run(&["converge", &urdf, &shipped("workspaces/scara_cell.toml")], "--cells 16 --quiet");
    coarse.refused(1, &["16 x 16 cells", "hint: more --cells"]);
    // If one file cannot be written, the program writes none.
    let mut words = files();
    words.extend(["--output", "b.csv", "--picture", "nowhere/b.svg"].map(str::to_owned));
    place.run(&words, "").refused(1, &["nowhere"]);
    assert!(!place.path("b.csv").exists());
}
