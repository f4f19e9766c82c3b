//! `cplan study` from outside: rows, how to reproduce them, refused input.

use super::*;
use std::collections::BTreeSet;
use std::process::Stdio;
use std::time::{Duration, Instant};

/// A world whose second obstacle is moved to several places, some in the start.
const WORLD: &str = "[[obstacle]]\nname = \"shelf\"\npolygon = [[1.15, 0.18], [1.6, 0.18], [1.6, 0.3], [1.15, 0.3]]\n\
                     [[obstacle]]\nname = \"crate\"\nat = [0.65, -1.45]\npolygon = [[-0.15, -0.15], [0.15, -0.15], [0.15, 0.15], [-0.15, 0.15]]\n";

fn study(place: &Place, head: &str, parameters: &str) -> String {
    place.write("world.toml", format!("{FREE}{WORLD}"));
    let text =
        format!("robot = \"{}\"\nworld = \"world.toml\"\n{head}\n{parameters}", shipped("robots/planar_2r.urdf"));
    place.write("study.toml", &text);
    text
}

/// A parameter for the crate's place, in steps and drawn.
const CRATE: &str = "[[parameter]]\nname = \"x\"\nsets = \"world.obstacle.crate.at[0]\"\nfrom = -1.5\nto = 1.5\nsteps = 4\n\
                     [[parameter]]\nname = \"y\"\nsets = [\"world.obstacle.crate.at[1]\"]\nfrom = -1.5\nto = 1.5\ndraw = \"latin\"\n";

fn run(place: &Place, options: &str) -> Done {
    place.run(&["study", "study.toml"], options)
}

/// Returns the rows of a table, by column.
fn rows(csv: &str) -> Vec<Vec<(String, String)>> {
    let mut lines = csv.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    lines
        .map(|line| names.iter().zip(fields(line)).map(|(name, field)| ((*name).to_owned(), field)).collect())
        .collect()
}

/// Returns the fields of a line; some are in quotation marks.
fn fields(line: &str) -> Vec<String> {
    let (mut fields, mut is_quoted, mut before) = (vec![String::new()], false, ',');
    for c in line.chars() {
        // Two quotation marks in a row inside quotation marks are one.
        let is_second = c == '"' && before == '"' && !is_quoted && !line.starts_with("\"\"");
        before = c;
        match c {
            '"' if is_second => {
                fields.last_mut().unwrap().push('"');
                is_quoted = true;
            }
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => fields.push(String::new()),
            c => fields.last_mut().unwrap().push(c),
        }
    }
    fields
}

fn field<'a>(row: &'a [(String, String)], name: &str) -> &'a str {
    &row.iter().find(|(column, _)| column == name).unwrap().1
}

#[test]
fn each_row_agrees_with_planning_in_the_files_of_its_layout() {
    let place = Place::new();
    // Layouts that the study would refuse can be planned separately.
    study(&place, "draws = 5\nseed = 3\noverlap = true", CRATE);
    let done = run(&place, "--output t.csv --jobs 2 --json").exits(0);
    let rows = rows(&place.read("t.csv"));
    assert_eq!(rows.len(), 20);
    let mut endings = [0; 4];
    for (number, row) in rows.iter().enumerate() {
        assert_eq!(field(row, "layout"), number.to_string());
        let written = run(&place, &format!("--layout {number} --output l.toml --output l.urdf"));
        assert_eq!((written.code, written.stdout.as_str()), (0, ""), "{}", written.stderr);
        let [x, y]: [f64; 2] = ["x", "y"].map(|name| field(row, name).parse().unwrap());
        assert!(place.read("l.toml").contains(&format!("at = [{x:?}, {y:?}]")), "{}", place.read("l.toml"));
        let alone = place.run(&["l.urdf", "l.toml"], "--json");
        let result: Value = serde_json::from_str(&alone.stdout).unwrap();
        let outcome = field(row, "outcome");
        let codes = [("found", 0), ("refused", 1), ("infeasible", 3), ("unknown", 4)];
        let kind = codes.iter().position(|(name, _)| *name == outcome).unwrap();
        assert_eq!(alone.code, codes[kind].1, "{row:?} {}", alone.stderr);
        endings[kind] += 1;
        let number = |name: &str| field(row, name).parse::<f64>().ok();
        for name in ["length", "clearance", "duration"] {
            assert_eq!(number(name), result[name].as_f64(), "{name} of {row:?}");
        }
        assert_eq!(number("lower_bound"), result["optimum"]["lower_bound"].as_f64());
        let reason = if outcome == "refused" { &result["message"] } else { &result["reason"] };
        assert!(reason.as_str().unwrap_or_default().starts_with(field(row, "reason")), "{row:?} {reason}");
    }
    assert!(endings[0] > 5 && endings[1] > 0, "{endings:?}");
    let summary: Value = serde_json::from_str(&done.stdout).unwrap();
    assert_eq!(
        (&summary["outcomes"]["found"], &summary["outcomes"]["refused"]),
        (&endings[0].into(), &endings[1].into())
    );
}

#[test]
fn rows_do_not_depend_on_the_number_of_jobs_or_on_measures() {
    let place = Place::new();
    let all = "draws = 6\nmeasure = [\"length\", \"over_bound\", \"duration\"]";
    study(&place, all, CRATE);
    let files = "--output t.csv --output t.html --output t.json --quiet";
    let bytes = |jobs: usize| {
        let done = run(&place, &format!("{files} --jobs {jobs}"));
        assert_eq!((done.code, done.stdout.as_str(), done.stderr.as_str()), (0, "", ""));
        ["t.csv", "t.html", "t.json"].map(|file| std::fs::read(place.path(file)).unwrap())
    };
    let one = bytes(1);
    assert_eq!(one, bytes(3));
    let page = String::from_utf8(one[1].clone()).unwrap();
    has(&page, &["Maps", "Trade-offs", "Best layouts", "y by x", "best: layout"]);
    // Lengths alone need no trajectory, and are the same.
    study(&place, "draws = 6\nmeasure = [\"length\", \"over_bound\"]", CRATE);
    run(&place, "--output u.csv --quiet").exits(0);
    let [with, without] = ["t.csv", "u.csv"].map(|file| rows(&place.read(file)));
    for (with, without) in with.iter().zip(&without) {
        for name in ["outcome", "reason", "length", "over_bound"] {
            assert_eq!(field(with, name), field(without, name), "{with:?}");
        }
    }
}

#[cfg(not(feature = "parquet"))]
#[test]
fn a_program_without_parquet_says_so_before_any_work() {
    let place = Place::new();
    study(&place, "draws = 6", CRATE);
    for table in ["t.parquet", "t.PARQUET"] {
        let done = run(&place, &format!("--output t.csv --output {table}"));
        done.refused(1, &[table, "built without Parquet", ".csv", "--features parquet"]);
        assert!(!place.path("t.csv").exists() && !place.path("t.csv.part").exists());
    }
    // A layout has no table.
    run(&place, "--layout 1 --output t.parquet").refused(2, &["a layout is written as .toml (world) or .urdf"]);
}

#[test]
fn a_study_that_is_killed_goes_on_and_ends_with_the_same_bytes() {
    let place = Place::new();
    study(&place, "draws = 60\n[search]\nlayouts = 40", CRATE);
    run(&place, "--output whole.csv --quiet").exits(0);
    let mut killed = place.command();
    killed.args(["study", "study.toml", "--output", "t.csv", "--quiet", "--jobs", "1"]);
    let mut killed = killed.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let part = place.path("t.csv.part");
    let lines = || std::fs::read_to_string(&part).map_or(0, |text| text.lines().count());
    let begun = Instant::now();
    while lines() < 20 && begun.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(1));
    }
    killed.kill().unwrap();
    killed.wait().unwrap();
    let kept = lines();
    assert!(kept >= 20 && !place.path("t.csv").exists(), "{kept} lines");
    // The last line is incomplete.
    let mut text = read(&part);
    text.truncate(text.len() - 7);
    std::fs::write(&part, &text).unwrap();
    run(&place, "--output t.csv --jobs 2").exits(0).warns(&["continues the stopped study after"]);
    assert_eq!(place.read("t.csv"), place.read("whole.csv"));
    assert!(!part.exists());
    // Rows of another study are neither used nor lost.
    std::fs::write(&part, &text).unwrap();
    study(&place, "draws = 61", CRATE);
    run(&place, "--output t.csv").refused(1, &["t.csv.part contains rows of another study", "--fresh"]);
    assert_eq!(read(&part), text);
    run(&place, "--output t.csv --fresh --quiet").exits(0);
    assert_eq!(rows(&place.read("t.csv")).len(), 244);
    // Another kind of file is not overwritten either.
    place.write("t.csv.part", "somebody's notes");
    for fresh in ["", " --fresh"] {
        run(&place, &format!("--output t.csv{fresh}")).refused(1, &["another study"]);
        assert_eq!(place.read("t.csv.part"), "somebody's notes");
    }
}

#[test]
fn the_search_finds_better_layouts_and_lists_the_tried_ones() {
    let place = Place::new();
    let base = "[[parameter]]\nname = \"x\"\nunit = \"m\"\nsets = \"world.robot.at[0]\"\nfrom = -0.3\nto = 0.3\nsteps = 4\n\
                [[parameter]]\nname = \"y\"\nsets = \"world.robot.at[1]\"\nfrom = -0.3\nto = 0.3\nsteps = 4\n";
    let head = "measure = [\"length\", \"clearance\"]\nobjective = \"least length\"\noptions = [\"--clearance=0.003\"]\nconditions = [\"clearance >= 0.002\"]\n[search]\nlayouts = 60";
    study(&place, head, base);
    let done = run(&place, "--output t.csv --output best.toml --output best.urdf --json").exits(0);
    let summary: Value = serde_json::from_str(&done.stdout).unwrap();
    let rows = rows(&place.read("t.csv"));
    // The search does not plan a layout again: of its 60, only the different ones count.
    assert!(rows.len() > 66 && rows.len() <= 76, "{}", rows.len());
    let places: BTreeSet<[String; 2]> =
        rows.iter().map(|row| ["x", "y"].map(|name| field(row, name).to_owned())).collect();
    assert_eq!(places.len(), rows.len());
    let fits = |row: &&Vec<(String, String)>| field(row, "fits") == "true";
    let least = |rows: &[Vec<(String, String)>]| {
        let lengths = rows.iter().filter(fits).map(|row| field(row, "length").parse::<f64>().unwrap());
        lengths.fold(f64::INFINITY, f64::min)
    };
    assert!(least(&rows[16..]) < least(&rows[..16]), "{} {}", least(&rows[16..]), least(&rows[..16]));
    assert_eq!(summary["best"]["measured"]["length"].as_f64(), Some(least(&rows)));
    for row in rows.iter().filter(fits) {
        assert!(field(row, "clearance").parse::<f64>().unwrap() >= 0.002);
    }
    let tried = &summary["search"];
    let counted: u64 =
        ["found", "infeasible", "unknown", "refused"].iter().map(|name| tried[name].as_u64().unwrap()).sum();
    assert_eq!(counted as usize, rows.len() - 16);
    // The files of the best layout, planned by the command that they name, give the values of its row and of the
    // summary.
    let command = place.read("best.toml").lines().nth(1).unwrap().strip_prefix("# cplan ").unwrap().to_owned();
    assert_eq!(command, "best.urdf best.toml --clearance=0.003");
    let alone: Value =
        serde_json::from_str(&place.run(&command.split(' ').collect::<Vec<_>>(), "--json").stdout).unwrap();
    assert_eq!(alone["length"], summary["best"]["measured"]["length"]);
    let output = run(&place, "--output best.toml").stdout;
    has(
        &output,
        &[
            &format!("to plan layout {}: cplan ", summary["best"]["layout"]),
            "planar_2r.urdf best.toml --clearance=0.003\n",
        ],
    );
    run(&place, "--output u.csv --jobs 1 --quiet").exits(0);
    assert_eq!(place.read("t.csv"), place.read("u.csv"));
}

/// Writes a study of top speeds of the first joint.
fn speed_study(place: &Place, values: &str) {
    let [urdf, _] = shelf().map(read);
    let joint = urdf.split("<joint name=\"").nth(1).unwrap().split('"').next().unwrap();
    let parameter =
        format!("[[parameter]]\nname = \"speed\"\nsets = \"urdf.joint.{joint}.limit.velocity\"\n{values}\n");
    study(place, "measure = [\"duration\"]", &parameter);
}

#[test]
fn robots_vary_as_well_as_worlds() {
    let place = Place::new();
    speed_study(&place, "values = [0.5, 1.0, 2.0]");
    run(&place, "--output t.csv --quiet").exits(0);
    let times: Vec<f64> =
        rows(&place.read("t.csv")).iter().map(|row| field(row, "duration").parse().unwrap()).collect();
    assert!(times[0] > times[1] && times[1] > times[2], "{times:?}");
    // A layout has its own robot, in a separate file.
    let report = run(&place, "--layout 1 --output one.toml").stderr;
    assert!(report.contains("--output one.urdf writes it"), "{report}");
    let report = run(&place, "--layout 1 --output one.toml --output one.urdf").stderr;
    assert!(!report.contains("note:"), "{report}");
}

#[test]
fn failed_layouts_have_rows_and_a_study_may_have_no_best_layout() {
    let place = Place::new();
    // The world has no preferred region, and the field needs some.
    let field = "options = [\"--planner=harmonic\", \"--field=bvp\"]\nmeasure = [\"length\"]";
    study(&place, field, &CRATE.replace("draw = \"latin\"", "steps = 2"));
    run(&place, "--output t.csv --quiet").exits(0);
    for row in rows(&place.read("t.csv")) {
        assert_eq!(
            field_of(&row),
            ("refused", "--field bvp needs [[preference]] regions in the world file, or --epsilon")
        );
    }
    study(&place, "conditions = [\"duration <= 0.01\"]\ndraws = 3", CRATE);
    let done = run(&place, "--output t.csv --output best.toml --json").exits(0);
    done.warns(&["best.toml is not written, because no layout meets the conditions"]);
    assert!(!place.path("best.toml").exists() && rows(&place.read("t.csv")).len() == 12);
    assert_eq!(done.json()["best"], Value::Null);
}

fn field_of(row: &[(String, String)]) -> (&str, &str) {
    (field(row, "outcome"), field(row, "reason"))
}

#[test]
fn two_runs_do_not_share_their_rows() {
    let place = Place::new();
    study(&place, "draws = 3", CRATE);
    let kept = std::fs::File::create(place.path("t.csv.part")).unwrap();
    kept.lock().unwrap();
    run(&place, "--output t.csv").refused(1, &["t.csv.part: another process is running this study"]);
    drop(kept);
    run(&place, "--output t.csv --quiet").exits(0);
    // A run does not use its own study as rows either.
    std::fs::rename(place.path("study.toml"), place.path("u.csv.part")).unwrap();
    place.run(&["study", "u.csv.part"], "--output u.csv --fresh").refused(1, &["is the input"]);
}

#[test]
fn errors_in_a_study_have_a_place_and_a_hint() {
    let place = Place::new();
    let x = "[[parameter]]\nname = \"x\"\nsets = \"world.obstacle.crate.at[0]\"\nfrom = 0\nto = 1\n";
    // Each row has a line of the head, changes to the parameter, lines after it, and the message.
    let table = r#"
 =>  => draw = "latin" => does not state the number of draws ... draws = 1000
 =>  =>  => line 4, column 1 ... parameter "x" needs values, steps or draw ... from, to and steps
 =>  => steps = 1 => line 9 ... the number of steps from 0 to 1 is 1 ... use 2 to a million steps
 =>  => steps = 200000000 => the number of steps from 0 to 1 is 200000000 ... use 2 to a million steps
 =>  => draw = "sobol" => "uniform" or "latin", not "sobol"
 => to = 1 -> to = 0 => draw = "latin" => the range from 0 to 0 has only one value ... write values = [0]
 => from = 0 -> from = "9deg" => steps = 2 => values in degrees do not fit world.obstacle.crate.at[0], which is not an angle ... line 7
 => from = 0 -> from = 2 => steps = 2 => 2 is more than 1
 => crate.at -> box.at => steps = 2 => world.obstacle.box.at[0]: there is no "box" ... shelf, crate ... line 6
 => world.obstacle.crate.at[0] -> robot.at[0] => steps = 2 => an address must begin with world. or urdf.
options = ["--planer=first"] =>  => steps = 2
    => options: unexpected argument '--planer' found; tip: a similar argument exists: '--planner'
options = ["--picture=x.svg"] =>  => steps = 2
    => options: --picture does not apply here, because it is about files or printed output
    ... name output files on the command line of `cplan study`
options = ["--planner=nobody"] =>  => steps = 2 => line 3 ... nobody
draws = 5 =>  => steps = 3 => line 3 ... no parameter is drawn
measure = ["speed"] =>  => steps = 2 => line 3 ... "speed" is not a measure; measures are length
conditions = ["length < 3"] =>  => steps = 2 => is not a condition ... clearance >= 0.01
size = 3 =>  => steps = 2 => line 3 ... unknown key `size`
"#;
    let table = table.replace("\n    ", " ");
    let mut cases: Vec<[String; 3]> = Vec::new();
    for row in table.lines().skip(1) {
        let fields: Vec<&str> = row.split(" => ").collect();
        let [head, change, rest, pattern] = fields[..] else { panic!("{row}") };
        let (from, to) = change.split_once(" -> ").unwrap_or_default();
        let parameter = if from.is_empty() { x.to_owned() } else { x.replace(from, to) };
        cases.push([head.to_owned(), format!("{parameter}{rest}\n"), pattern.to_owned()]);
    }
    let several = "[[parameter]]\nname = \"x\"\nsets = [\"world.obstacle.crate.at[0]\", \"world.obstacle.shelves.at[0]\"]\nvalues = [1]\n";
    let shelves =
        "line 6, column 39 ... no \"shelves\" ... world.obstacle.shelf.at[0] is a number that exists in the file";
    let twice = format!("{x}steps = 2\n{x}steps = 2\n");
    cases.push(["", several, shelves].map(str::to_owned));
    cases.push(["", &twice, "another column \"x\""].map(str::to_owned));
    cases.push(["", "", "the study has no parameters ... [[parameter]]"].map(str::to_owned));
    for [head, parameters, pattern] in cases {
        study(&place, &head, &parameters);
        run(&place, "--output t.csv").refused(1, &pattern.split(" ... ").collect::<Vec<_>>());
        assert!(!place.path("t.csv").exists() && !place.path("t.csv.part").exists());
    }
    place.write("study.toml", "robot = \"none.urdf\"\nworld = \"world.toml\"\n");
    run(&place, "").refused(1, &["line 1, column 9", "none.urdf", "relative to the study"]);
    place.write("study.toml", "world = \"world.toml\"\n");
    run(&place, "").refused(1, &["study.toml", "does not name a robot", "robot = \"arm.urdf\""]);
    study(&place, "", &format!("{x}steps = 2\n"));
    run(&place, "--output t.pdf").refused(2, &[".csv, .parquet, .html or .json"]);
    run(&place, "--layout 2").refused(1, &["the study has 2 layouts, numbered from 0"]);
    run(&place, "--layout 1 --output t.csv").refused(2, &["a layout is written as .toml (world) or .urdf"]);
    run(&place, "--output study.toml").refused(1, &["is the input"]);
}

#[test]
fn obstacles_overlap_only_where_the_world_allows_it() {
    let place = Place::new();
    // The shelf is from 1.15 to 1.6 and from 0.18 to 0.3, and the crate extends 0.15 around its place: at 1.0, 0.03 and
    // 0.45 they touch.
    let crate_about = "[[parameter]]\nname = \"x\"\nsets = \"world.obstacle.crate.at[0]\"\nvalues = [0.9, 1.0, 1.05, 1.3]\n\
                       [[parameter]]\nname = \"y\"\nsets = \"world.obstacle.crate.at[1]\"\nvalues = [0.0, 0.03, 0.1, 0.44, 0.45, 0.6]\n";
    study(&place, "measure = [\"length\"]", crate_about);
    let done = run(&place, "--output t.csv");
    let inside = rows(&place.read("t.csv"));
    let mut count = 0;
    for row in &inside {
        let [x, y]: [f64; 2] = ["x", "y"].map(|name| field(row, name).parse().unwrap());
        let overlaps = x > 1.01 && y > 0.04 && y < 0.445;
        assert_eq!(field_of(row) == ("refused", "\"crate\" overlaps \"shelf\""), overlaps, "{row:?}");
        count += usize::from(overlaps);
    }
    assert_eq!((inside.len(), count), (24, 4));
    done.says(&["         4  refused: \"crate\" overlaps \"shelf\"\n"]);
    // Low things are below the shelf.
    let low = format!("{FREE}{WORLD}").replace("name = \"crate\"", "name = \"crate\"\nheight = [0.0, 0.1]");
    place.write("world.toml", low.replace("name = \"shelf\"", "name = \"shelf\"\nheight = [0.1, 0.3]"));
    run(&place, "--output t.csv").exits(0);
    assert!(!place.read("t.csv").contains("overlaps"));
    // A study may want it.
    study(&place, "measure = [\"length\"]\noverlap = true", crate_about);
    run(&place, "--output t.csv").exits(0);
    assert!(!place.read("t.csv").contains("overlaps"));
}

#[test]
fn the_page_distinguishes_what_colours_mean() {
    let place = Place::new();
    let base = CRATE.replace("draw = \"latin\"", "steps = 5");
    let page = |head: &str| {
        study(&place, head, &base);
        let done = run(&place, "--output t.html").exits(0);
        (place.read("t.html"), done.stdout)
    };
    // Of two measures with equal plots against the objective, one is shown.
    let (html, _) = page("measure = [\"duration\", \"length\", \"lower_bound\"]");
    assert!(html.contains("length against duration") && !html.contains("lower bound against"));
    has(
        &html,
        &[
            "Scale of colours",
            ">duration (s)</text>",
            "<title>best: layout ",
            "fill=\"var(--undecided)\"",
            "<table class=\"words\">",
        ],
    );
    // Cells of layouts with a motion that is too long are neither grey nor in the colour of a proof.
    let unfit = "fill=\"var(--unknown)\" data-layout=";
    assert!(!html.contains(unfit));
    let (html, _) = page("conditions = [\"duration <= 0.01\"]");
    assert!(html.contains(unfit) && html.contains("a motion that does not meet the conditions"));
    assert!(!html.contains("<title>best: layout "));
}

#[test]
fn a_best_layout_at_the_end_of_a_range_is_noted() {
    let place = Place::new();
    let speed = |values: &str| {
        speed_study(&place, values);
        run(&place, "")
    };
    let edge = "the best speed is 1, and its range ends at 1: a wider range may give a better layout\n";
    speed("from = 0.5\nto = 1\nsteps = 3").says(&[edge]);
    assert!(!speed("values = [0.5, 1]").stdout.contains("a wider range"));
}

#[test]
fn a_search_plans_in_no_layout_twice() {
    let place = Place::new();
    let listed = CRATE.replace("from = -1.5\nto = 1.5\ndraw = \"latin\"", "values = [-1.45, 1.2]");
    let listed = listed.replace("from = -1.5\nto = 1.5\nsteps = 4", "values = [-1, 0.65, 1]");
    study(&place, "[search]\nlayouts = 40", &listed);
    let done = run(&place, "--output t.csv").exits(0);
    assert_eq!(rows(&place.read("t.csv")).len(), 6);
    done.says(&["the search found no new layout to try"]);
}

#[test]
fn angles_may_be_in_degrees() {
    let place = Place::new();
    let angle = "[[parameter]]\nname = \"a\"\nsets = \"world.obstacle.crate.angle\"\nvalues = [0, \"90deg\"]\n";
    study(&place, "", angle);
    run(&place, "--output t.csv").exits(0);
    let turned = &rows(&place.read("t.csv"))[1];
    assert_eq!(field(turned, "a").parse::<f64>().unwrap(), std::f64::consts::FRAC_PI_2);
}

#[cfg(unix)]
#[test]
fn ctrl_c_reports_the_stored_rows() {
    let place = Place::new();
    study(&place, "draws = 2000", CRATE);
    let mut stopped = place.command();
    stopped.args(["study", "study.toml", "--output", "t.csv", "--quiet", "--jobs", "1"]);
    let stopped = stopped.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let part = place.path("t.csv.part");
    let lines = || std::fs::read_to_string(&part).map_or(0, |text| text.lines().count());
    let begun = Instant::now();
    while lines() < 20 && begun.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(1));
    }
    let sent = std::process::Command::new("kill").args(["-INT", &stopped.id().to_string()]).status().unwrap();
    assert!(sent.success());
    let done = stopped.wait_with_output().unwrap();
    let report = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(130), "{report}");
    let kept = report.split("stopped: ").nth(1).unwrap().split(' ').next().unwrap().parse::<usize>().unwrap();
    assert!(
        kept > 0 && report.contains(" of 8000 rows are in t.csv.part; the same command continues from there"),
        "{report}"
    );
    // The file also has a line that names the study of the rows.
    assert!(lines() > kept, "{} {kept}", lines());
}

/// Checks that the legend of a picture explains the slices that a path passes only if there is a path.
#[test]
fn pictures_explain_what_they_show() {
    let place = Place::new();
    let legend = |files: [&str; 2], code: i32| {
        place.run(&files.map(shipped), "--picture p.svg --quiet").exits(code);
        place.read("p.svg").contains("slices that the path passes")
    };
    assert!(!legend(["robots/planar_2r_continuous.urdf", "workspaces/no_path.toml"], 3));
    assert!(legend(["robots/planar_2r.urdf", "workspaces/shelf.toml"], 0));
}

/// Checks that a layout in which an obstacle blocks the world's own start or goal has a row, and that the unchanged
/// files have one, too.
#[test]
fn layouts_have_rows_where_the_base_has_a_blocked_start_or_goal() {
    let place = Place::new();
    let robot = shipped("robots/planar_2r.urdf");
    let parameter = "[[parameter]]\nname = \"x\"\nsets = \"world.obstacle.crate.at[0]\"\nvalues = [1.0, 3.0]\n";
    let at_home = [
        ("start", "start.joints = [0, 0]\ngoal.joints = [1.2, 0.3]\n"),
        ("goal", "start.joints = [1.2, 0.3]\ngoal.joints = [0, 0]\n"),
    ];
    let tip = ("IK solution", "start.joints = [1.2, 0.3]\ngoal.tip = [1.0, 0.0]\n");
    for (blocked, ends) in at_home.into_iter().chain([tip]) {
        let world = format!(
            "{ends}[[obstacle]]\nname = \"crate\"\nat = [1.0, 0.0]\npolygon = [[-0.15, -0.15], [0.15, -0.15], [0.15, 0.15], [-0.15, 0.15]]\n"
        );
        place.write("world.toml", world);
        place.write("study.toml", format!("robot = \"{robot}\"\nworld = \"world.toml\"\n{parameter}"));
        run(&place, "--output t.csv --output t.html --output best.toml").exits(0);
        let rows = rows(&place.read("t.csv"));
        assert_eq!(rows.len(), 2, "{ends}");
        assert_eq!((field(&rows[0], "outcome"), field(&rows[1], "outcome")), ("refused", "found"), "{ends}");
        assert!(field(&rows[0], "reason").contains(blocked), "{ends}: {}", field(&rows[0], "reason"));
    }
}
