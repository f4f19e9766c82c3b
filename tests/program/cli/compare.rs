//! `cplan compare` for many problems, and the files that it writes.

use super::*;
use cplan::input::{Overrides, load};

/// A closed pocket for `planar_2r`, with these limits.
const CLOSED: &str = "[robot]\nlimits = { shoulder = [-1.0, 1.0], elbow = [-1.0, 1.0] }\n[start]\njoints = [-0.9, 0.0]\n\
                      [goal]\njoints = [0.9, 0.0]\n[[obstacle]]\nname = \"wall\"\npolyline = [[0.3, 0.0], [1.5, 0.0]]\n";

/// Writes a suite of two worlds.
fn suite(place: &Place) {
    let robot = shipped("robots/planar_2r.urdf");
    std::fs::create_dir(place.path("worlds")).unwrap();
    place.write("worlds/open.toml", FREE);
    place.write("worlds/closed.toml", CLOSED);
    let problem = |world: &str| format!("[[problem]]\nrobot = \"{robot}\"\nworld = \"{world}\"\n");
    place.write(
        "worlds/suite.toml",
        format!("name = \"two worlds\"\n{}{}", problem("open.toml"), problem("closed.toml")),
    );
}

/// Returns the result without times and memory.
fn without_costs(mut json: Value) -> Value {
    fn clean(value: &mut Value) {
        match value {
            Value::Object(map) => {
                for key in ["time", "memory", "build", "query", "certify", "total"] {
                    map.remove(key);
                }
                map.values_mut().for_each(clean);
            }
            Value::Array(all) => all.iter_mut().for_each(clean),
            _ => {}
        }
    }
    clean(&mut json);
    // The summary mentions times, too.
    json.as_object_mut().unwrap().remove("summary");
    json
}

const QUICK: &str = "--planner visibility --planner wavefront --cells 64 --quiet";

#[test]
fn suites_list_every_problem_with_every_planner() {
    let place = Place::new();
    suite(&place);
    let json = place.run(&["compare", "--suite", "worlds"], &format!("{QUICK} --json")).succeeds_silently().json();
    assert_eq!(json["title"], "two worlds");
    let outcomes = |problem: usize| -> Vec<&str> {
        let rows = json["problems"][problem]["planners"].as_array().unwrap();
        rows.iter().map(|row| row["outcome"].as_str().unwrap()).collect()
    };
    assert_eq!((outcomes(0), outcomes(1)), (vec!["found"; 2], vec!["infeasible"; 2]));
    for planner in json["planners"].as_array().unwrap() {
        let counts = ["found", "infeasible", "unknown", "total"].map(|key| planner[key].as_u64().unwrap());
        assert_eq!(counts, [1, 1, 0, 2]);
        assert_eq!(planner["distributions"]["total"]["n"], 2);
        assert_eq!(planner["distributions"]["over_optimum"]["n"], 1);
    }
    // The robot suits all worlds of the folder. The manifest is not a world.
    let folder = place
        .run(&["compare", &shipped("robots/planar_2r.urdf"), "--suite", "worlds"], &format!("{QUICK} --json"))
        .exits(0);
    let folder = folder.json();
    let names: Vec<&str> =
        folder["problems"].as_array().unwrap().iter().map(|p| p["problem"].as_str().unwrap()).collect();
    assert_eq!((names, folder["title"].as_str()), (vec!["closed", "open"], Some("worlds")));
    // Reads a manifest by its own name, and writes the tables.
    place.run(&["compare", "--suite", "worlds/suite.toml"], QUICK).exits(0).says(&[
        "two worlds\n",
        "outcomes\n",
        "total [ms]\n",
        "2 problems: 1 with a certified path, 1 proven infeasible",
    ]);
}

#[test]
fn errors_in_a_suite_are_reported_at_once() {
    let place = Place::new();
    suite(&place);
    let refused = |content: &str, parts: &[&str]| {
        place.write("worlds/suite.toml", content);
        place.run(&["compare", "--suite", "worlds"], "").refused(1, parts);
    };
    let robot = shipped("robots/planar_2r.urdf");
    refused("[[problem]]\nrobot = 3\n", &["suite.toml: line 2", "string", "robot = 3"]);
    refused("[[problem]]\nrobot = \"a\"\nwordl = \"b\"\n", &["line 3", "unknown key `wordl`", "`world`"]);
    refused("[[problem]]\nrobot = \"a\"\n", &["missing key `world`"]);
    refused("name = \"x\"\n", &["lists no problem", "hint: add a [[problem]]"]);
    refused(
        "[[problem]]\nrobot = \"absent.urdf\"\nworld = \"open.toml\"\n[[problem]]\nrobot = \"a.urdf\"\nworld = \"b.toml\"\n",
        &["line 2", "no file worlds/absent.urdf", "worlds/a.urdf", "worlds/b.toml", "relative to the manifest"],
    );
    // Reports the diagnostics of all worlds together, each with its file and place.
    place.write("worlds/open.toml", "[start]\njoints = [9.0, 0.0]\n[goal]\njoints = [0.0, 0.0]\n");
    place.write("worlds/closed.toml", "[start]\njoints = [0.0, 0.0]\n");
    let two = format!(
        "[[problem]]\nrobot = \"{robot}\"\nworld = \"open.toml\"\n[[problem]]\nrobot = \"{robot}\"\nworld = \"closed.toml\"\n"
    );
    refused(&two, &["open.toml: line 2", "outside the joint limits", "closed.toml: there is no goal", "hint:"]);
    place.write("worlds/closed.toml", "obstcle = 1\n");
    refused(&two, &["closed.toml: line 1", "unknown key `obstcle`"]);
    std::fs::remove_file(place.path("worlds/suite.toml")).unwrap();
    place.run(&["compare", "--suite", "worlds"], "").refused(1, &["has no suite.toml", "compare URDF --suite worlds"]);
    place.run(&["compare", "--suite", "absent"], "").refused(1, &["absent", "cannot be read"]);
    std::fs::create_dir(place.path("empty")).unwrap();
    place
        .run(&["compare", &robot, "--suite", "empty"], "")
        .refused(1, &["empty: the folder contains no world", "hint:"]);
}

/// Checks that worlds which cannot be run do not prevent others from being run. All tables and the exit code count
/// them.
#[test]
fn a_suite_goes_on_without_the_worlds_that_cannot_be_run() {
    let place = Place::new();
    suite(&place);
    let robot = shipped("robots/planar_2r.urdf");
    place.write("worlds/blocked.toml", "[start]\njoints = [9.0, 0.0]\n[goal]\njoints = [0.0, 0.0]\n");
    place.write("worlds/broken.toml", "obstcle = 1\n");
    let problems = ["open", "blocked", "broken", "absent"]
        .map(|name| format!("[[problem]]\nrobot = \"{robot}\"\nworld = \"{name}.toml\"\n"));
    place.write("worlds/suite.toml", problems.concat());
    let options = format!("{QUICK} --output runs.csv --output report.html");
    let text = place.run(&["compare", "--suite", "worlds"], &options).exits(1);
    text.says(&["refused  problems", "blocked was not run: ", "broken was not run: ", "absent was not run: "]);
    let counted = |line: &&str| line.split_whitespace().skip(1).eq(["1", "0", "0", "3", "4"]);
    assert!(text.stdout.lines().any(|line| counted(&line)), "{}", text.stdout);
    let csv = place.read("runs.csv");
    let width = csv.lines().next().unwrap().split(',').count();
    let refused: Vec<&str> = csv.lines().filter(|line| line.contains(",refused,")).collect();
    assert_eq!(refused.len(), 3, "{csv}");
    assert!(
        refused.iter().all(|line| line.split('"').next().unwrap().matches(',').count() == width - 1),
        "{refused:?}"
    );
    assert!(place.read("report.html").contains("(3 more not run)"));
    let json = place.run(&["compare", "--suite", "worlds"], &format!("{QUICK} --json")).exits(1);
    let json = json.json();
    let kinds: Vec<&str> = json["refused"].as_array().unwrap().iter().map(|r| r["kind"].as_str().unwrap()).collect();
    assert_eq!((json["problems"].as_array().unwrap().len(), kinds.len()), (1, 3));
    assert!(kinds.contains(&"start") && kinds.contains(&"input"), "{kinds:?}");
    // Random queries need no start, but free space.
    place.write("worlds/blocked.toml", "clearance = 50\n[[obstacle]]\ncircle = { center = [9, 9], radius = 1 }\n");
    let drawn = place.run(&["compare", "--suite", "worlds"], &format!("{QUICK} --json --queries 2"));
    let drawn = drawn.json();
    assert_eq!((drawn["problems"].as_array().unwrap().len(), drawn["refused"].as_array().unwrap().len()), (2, 3));
}

#[test]
fn worlds_with_steps_are_omitted_with_a_note() {
    let place = Place::new();
    std::fs::create_dir(place.path("worlds")).unwrap();
    place.write("worlds/free.toml", FREE);
    let step = "[start]\njoints = [-0.9, 0.4]\n[[step]]\nmove = { joints = [0.0, 0.0] }\n";
    place.write("worlds/task.toml", step);
    let robot = shipped("robots/planar_2r.urdf");
    let done = place.run(&["compare", &robot, "--suite", "worlds"], "--planner trapezoid --json").exits(0);
    done.warns(&["note: worlds/task.toml is left out: it has steps"]);
    let json = done.json();
    assert_eq!((json["problems"].as_array().unwrap().len(), json["left_out"].as_array().unwrap().len()), (1, 1));
    let moving = "[[obstacle]]\ncircle = { center = [5, 0], radius = 0.1 }\nmotion = { velocity = [1, 0] }\n";
    place.write("worlds/moving.toml", format!("{FREE}{moving}"));
    let done = place.run(&["compare", &robot, "--suite", "worlds"], "--planner trapezoid --json").exits(0);
    done.warns(&["moving.toml is left out: it has moving obstacles or objects"]);
    std::fs::remove_file(place.path("worlds/moving.toml")).unwrap();
    std::fs::remove_file(place.path("worlds/free.toml")).unwrap();
    place
        .run(&["compare", &robot, "--suite", "worlds"], "")
        .refused(1, &["task.toml", "it has steps, not a goal", "hint:"]);
    place
        .run(&["compare", &robot, "worlds/task.toml"], "--queries 3")
        .refused(1, &["task.toml", "has steps, not a goal"]);
}

#[test]
fn random_queries_are_free_and_follow_from_the_seed() {
    let place = Place::new();
    let [urdf, world] = shelf();
    let run = |options: &str| {
        place
            .run(&["compare", &urdf, &world], &format!("{QUICK} --json --clearance 0.02 {options}"))
            .succeeds_silently()
            .json()
    };
    let six = run("--queries 6 --seed 5");
    assert_eq!((six["queries"].as_u64(), six["seed"].as_u64()), (Some(6), Some(5)));
    let problem = load(&urdf, world.as_ref(), &Overrides::default()).unwrap().problem;
    let scene = problem.scene();
    let problems = six["problems"].as_array().unwrap();
    for problem in problems {
        for end in ["start", "goal"] {
            let [a, b] = [0, 1].map(|k| problem[end][k].as_f64().unwrap());
            let q = cplan::space::Configuration::new(a, b);
            assert!(scene.arm().topology().contains(q) && scene.clearance(q) > 0.02, "{problem}");
        }
        let bound = problem["lower_bound"].as_f64().unwrap();
        for row in problem["planners"].as_array().unwrap() {
            assert!(row["length"].as_f64().unwrap() >= bound && row["clearance"].as_f64().unwrap() >= 0.02, "{row}");
        }
    }
    assert_eq!(without_costs(run("--queries 6 --seed 5 --jobs 3")), without_costs(six.clone()));
    let four = run("--queries 4 --seed 5");
    assert_eq!(four["problems"][3]["start"], six["problems"][3]["start"]);
    assert_ne!(run("--queries 1 --seed 6")["problems"][0]["start"], six["problems"][0]["start"]);
    // The world's own start and goal are ignored; without free space there are no queries.
    place.write("bare.toml", "[[obstacle]]\ncircle = { center = [1.2, 0.9], radius = 0.1 }\n");
    place.run(&["compare", &urdf, "bare.toml"], "--queries 2 --planner trapezoid --quiet").exits(0);
    place
        .run(&["compare", &urdf, "bare.toml"], "--queries 2 --clearance 99")
        .refused(1, &["--queries", "clearance of 99 m"]);
    let usage = [("--seed 3", "--queries"), ("--queries 0", "1..=100000"), ("--queries 2 --start 0,0", "--start")];
    for (options, part) in usage {
        place.run(&["compare", &urdf, &world], options).refused(2, &[part]);
    }
    place.run(&["compare", &urdf, &world, "--suite", "worlds"], "").refused(2, &["--suite"]);
    place.run(&["compare", &urdf], "").refused(2, &["WORLD"]);
}

#[test]
fn every_file_is_written_or_none() {
    let place = Place::new();
    suite(&place);
    let files = ["r.md", "r.csv", "r.json", "r.html", "r.log"];
    let outputs: String = files.iter().map(|file| format!(" --output {file}")).collect();
    place.run(&["compare", "--suite", "worlds"], &format!("{QUICK}{outputs}")).succeeds_silently();
    assert!(place.read("r.md").starts_with("# two worlds\n"));
    let csv = place.read("r.csv");
    let columns: Vec<usize> = csv.lines().map(|line| line.split(',').count()).collect();
    assert_eq!(columns, [columns[0]; 5], "{csv}");
    let json = place.json("r.json");
    assert_eq!(json["problems"].as_array().unwrap().len(), 2);
    assert!(place.read("r.log").ends_with("\n.\n"));
    check_knots(&place.read("r.html"));
    for (options, code, part) in [
        ("--output new.txt", 2, ".md, .csv, .json, .html or .log"),
        ("--output new.md --output new.md", 1, "are the same file"),
        ("--output new.md --output absent/new.md", 1, "the folder absent does not exist"),
        ("--markdown --csv", 2, "--csv"),
        ("--jobs 0", 2, "1..=1024"),
        ("--picture new.svg", 2, "--picture"),
    ] {
        place.run(&["compare", "--suite", "worlds"], options).refused(code, &[part]);
    }
    assert!(!place.path("new.md").exists());
}

/// Checks that HTML is also XML, as our pages must be. Returns the number of figures.
fn check_knots(html: &str) -> usize {
    let body = html.strip_prefix("<!DOCTYPE html>\n").expect("a page");
    let document = roxmltree::Document::parse(body).unwrap_or_else(|e| panic!("{e}: {html}"));
    for node in document.descendants() {
        assert!(
            node.tag_name().name() != "script" || node.attributes().len() == 0,
            "the only script is within the page"
        );
        for attribute in node.attributes() {
            // Pictures are data URIs, in which a name space is only a name.
            let is_data = attribute.value().starts_with("data:image/svg+xml,");
            assert!(is_data || !attribute.value().contains("//"), "{attribute:?}: no page but this one");
        }
    }
    document.descendants().filter(|node| node.tag_name().name() == "figure").count()
}

#[test]
fn odd_names_stay_names_in_the_page() {
    let place = Place::new();
    let odd = format!("name = '<b>&\"]]>'\n{FREE}");
    place.write("odd.toml", odd);
    let files = ["compare".into(), shipped("robots/planar_2r.urdf"), "odd.toml".into()];
    place.run(&files, &format!("{QUICK} --output page.html --output page.log --output page.md")).exits(0);
    let html = place.read("page.html");
    assert!(html.contains("&lt;b&gt;&amp;&quot;]]&gt;") && !html.contains("<b>"));
    assert_eq!(check_knots(&html), 2);
    place.run(&files, &format!("{QUICK} --queries 3 --output page.html")).exits(0);
    let html = place.read("page.html");
    assert!(check_knots(&html) >= 5 && html.contains("id=\"blocked0\""));
}

#[test]
fn one_problem_is_reported_in_all_formats() {
    let place = Place::new();
    let [urdf, world] = shelf();
    let markdown = place.run(&["compare", &urdf, &world], &format!("{QUICK} --markdown"));
    assert!(markdown.stdout.starts_with("| planner"), "{}", markdown.stdout);
    let json = place.run(&["compare", &urdf, &world], &format!("{QUICK} --json")).json();
    for row in json["planners"].as_array().unwrap() {
        let [ratio, over] = ["ratio", "over_optimum"].map(|key| row[key].as_f64().unwrap());
        assert!(over >= ratio && row["memory"].as_u64().unwrap() > 1000, "{row}");
        assert!(row["time"]["total"].as_f64().unwrap() >= row["time"]["query"].as_f64().unwrap());
    }
    let parallel = place.run(&["compare", &urdf, &world], "--planner trapezoid --planner wavefront --jobs 2 --json");
    parallel.warns(&["memory is reported only with --jobs 1"]);
    assert!(parallel.json()["planners"][0]["memory"].is_null());
}

#[test]
fn the_shipped_suite_names_the_robot_of_each_workspace() {
    let folder = shipped("workspaces");
    let text = std::fs::read_to_string(format!("{folder}/suite.toml")).unwrap();
    let mut named: Vec<(String, String)> = Vec::new();
    for problem in text.split("[[problem]]").skip(1) {
        let value =
            |key: &str| problem.lines().find_map(|l| l.strip_prefix(&format!("{key} = "))).unwrap().trim_matches('"');
        named.push((value("world").to_owned(), value("robot").to_owned()));
    }
    let mut stated = Vec::new();
    for entry in std::fs::read_dir(&folder).unwrap() {
        let file = entry.unwrap().path();
        let name = file.file_name().unwrap().to_str().unwrap().to_owned();
        if name.ends_with(".toml") && name != "suite.toml" {
            let text = read(&file);
            let robot = text.lines().find_map(|l| l.strip_prefix("# robot: ")).unwrap().trim().to_owned();
            stated.push((name, format!("../robots/{robot}.urdf")));
        }
    }
    stated.sort();
    assert_eq!(named, stated);
}

#[test]
fn a_planner_with_a_gap_is_run_until_it_is_within() {
    let place = Place::new();
    let robot = shipped("robots/planar_2r.urdf");
    let world = shipped("workspaces/shelf.toml");
    let rows = |with: &str| {
        let args = ["compare", &robot, &world, "--planner", "visibility", "--with", with];
        let json = place.run(&args, "--quiet --json").json();
        let rows = json["planners"].as_array().unwrap();
        let over = |row: &Value| row["over_optimum"].as_f64().unwrap() - 1.0;
        [over(&rows[0]), over(&rows[1])]
    };
    let [plain, close] = rows("visibility --gap 1e-4");
    assert!(plain > 1e-3 && close <= 1e-4, "{plain} {close}");
    let [_, close] = rows("shortest --gap 1e-6");
    assert!(close <= 1e-6, "{close}");
}

/// Checks long names of variants. If there is too little room, their common part is left out, and the differences
/// remain.
#[test]
fn pictures_and_charts_distinguish_variants() {
    let place = Place::new();
    let oriented = |epsilon: &str, direction: &str| {
        [
            "--with".to_owned(),
            format!("wavefront --search astar --space sampled --neighbors {epsilon} --cells {direction}"),
        ]
    };
    let mut words = vec!["compare".to_owned()];
    words.extend(shelf());
    let variants = [oriented("4", "32"), oriented("8", "32"), oriented("8", "48")];
    words.extend(variants.iter().flatten().cloned());
    place.run(&words, "--planner first --quiet --picture paths.svg --output all.html --output all.csv").exits(0);
    let svg = place.read("paths.svg");
    let texts: Vec<String> = {
        let document = roxmltree::Document::parse(&svg).unwrap();
        document.descendants().filter_map(|node| node.text()).map(|text| text.trim().to_owned()).collect()
    };
    let csv = place.read("all.csv");
    for [_, variant] in &variants {
        let short = variant.replace("--search astar --space sampled ", "");
        let key = texts.iter().find(|text| text.starts_with(&format!("{short}: ")));
        // The text has the length, and nothing is cut off.
        assert!(key.is_some_and(|key| key.ends_with(" rad")), "{short}: {texts:?}");
        assert!(csv.contains(variant.as_str()), "tables have all words: {csv}");
    }
    let page = place.read("all.html");
    for name in ["wavefront --neighbors 8 --cells 32", "wavefront --neighbors 8 --cells 48", "first"] {
        assert!(page.contains(&format!("<span class=\"name\">{name}</span>")), "{name}");
    }
}

/// Writes paths of two planners for the shelf: one that is free, one that collides.
fn recorded_paths(place: &Place) -> f64 {
    let found = place.run(&shelf(), "--planner first --json --quiet").json();
    let (path, joints) = (&found["path"], &found["joints"]);
    for folder in ["careful", "straight"] {
        std::fs::create_dir_all(place.path(&format!("paths/{folder}"))).unwrap();
    }
    place.write("paths/careful/shelf.json", json!({"joints": joints, "path": path}).to_string());
    place.write("paths/straight/shelf.csv", "shoulder,elbow\n-0.9,0.4\n1.55,-0.35\n");
    place.write("paths/notes.txt", "not a folder");
    found["length"].as_f64().unwrap()
}

#[test]
fn paths_of_others_are_rows() {
    let place = Place::new();
    let length = recorded_paths(&place);
    let [urdf, world] = shelf();
    let words = "--planner shortest --paths paths --quiet";
    let json = place.run(&["compare", &urdf, &world], &format!("{words} --json --output all.html")).exits(0).json();
    let rows = json["planners"].as_array().unwrap();
    let names: Vec<_> =
        rows.iter().map(|row| (row["planner"].as_str().unwrap(), row["outcome"].as_str().unwrap())).collect();
    assert_eq!(names, [("shortest", "found"), ("careful", "found"), ("straight", "unknown")]);
    assert!((rows[1]["length"].as_f64().unwrap() - length).abs() < 1e-9, "{}", rows[1]);
    let over = length / json["lower_bound"].as_f64().unwrap();
    assert!((rows[1]["over_optimum"].as_f64().unwrap() - over).abs() < 1e-9, "{}", rows[1]);
    // The clearance is that of `verify`.
    let verified = place.run(&["verify", &urdf, &world, "paths/careful/shelf.json"], "--json").json();
    assert_eq!(rows[1]["clearance"], verified["clearance"]);
    assert!(
        rows[2]["reason"].as_str().unwrap().contains("collides: link \"forearm\" and obstacle \"shelf\""),
        "{}",
        rows[2]
    );
    assert!(place.read("all.html").contains("other programs"));
    place.run(&["compare", &urdf, &world], words).exits(0).says(&["careful", "straight"]);
}

#[test]
fn paths_of_suites_and_of_random_queries_have_the_names_of_their_problems() {
    let place = Place::new();
    suite(&place);
    std::fs::create_dir_all(place.path("paths/mine")).unwrap();
    place.write("paths/mine/open.csv", "shoulder,elbow\n-0.9,0.4\n1.55,-0.35\n");
    place.write("paths/mine/closed.csv", "shoulder,elbow\n-0.9,0\n0.9,0\n");
    let options = "--planner visibility --cells 64 --quiet --json --paths paths";
    let json = place.run(&["compare", "--suite", "worlds"], options).exits(0).json();
    let mine = |problem: usize| &json["problems"][problem]["planners"][1];
    assert_eq!((&mine(0)["outcome"], &mine(1)["outcome"]), (&json!("found"), &json!("unknown")));
    assert!(mine(1)["reason"].as_str().unwrap().contains("collides"), "{}", mine(1));
    // Random queries: the file of the second one is missing, and the first is not a path to its goal.
    let [urdf, world] = shelf();
    place.write("paths/mine/shelf_1.csv", "shoulder,elbow\n-0.9,0.4\n-0.9,0.5\n");
    let json = place.run(&["compare", &urdf, &world], &format!("{options} --queries 2")).exits(0).json();
    let reason = |problem: usize| json["problems"][problem]["planners"][1]["reason"].as_str().unwrap().to_owned();
    assert!(reason(0).contains("start") && reason(1).contains("no file paths/mine/shelf_2.csv"), "{json}");
}

#[test]
fn defective_paths_are_named() {
    let place = Place::new();
    recorded_paths(&place);
    let [urdf, world] = shelf();
    place.write("paths/straight/shelf.csv", "shoulder,elbow\n-0.9,x\n");
    let json =
        place.run(&["compare", &urdf, &world], "--planner shortest --paths paths --quiet --json").exits(0).json();
    let reason = json["planners"][2]["reason"].as_str().unwrap();
    assert!(reason.contains("shelf.csv: line 2") && !reason.contains('\n'), "{reason}");
    place.run(&["compare", &urdf, &world], "--paths none").refused(1, &["--paths none", "cannot be read", "hint"]);
    place.run(&["compare", &urdf, &world], "--paths paths/careful").refused(1, &["has no folder", "mine/shelf.csv"]);
}
