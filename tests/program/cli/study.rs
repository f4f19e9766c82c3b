//! `cplan study`, from outside: rows, how they come about again, what is refused.

use super::{Done, FREE, Place, shelf, shipped};
use serde_json::Value;
use std::process::Stdio;
use std::time::{Duration, Instant};

/// A world whose second obstacle is moved about, into the start and away.
const WORLD: &str = "[[obstacle]]\nname = \"shelf\"\npolygon = [[1.15, 0.18], [1.6, 0.18], [1.6, 0.3], [1.15, 0.3]]\n\
                     [[obstacle]]\nname = \"crate\"\nat = [0.65, -1.45]\npolygon = [[-0.15, -0.15], [0.15, -0.15], [0.15, 0.15], [-0.15, 0.15]]\n";

fn study(place: &Place, head: &str, parameters: &str) -> String {
    place.write("world.toml", format!("{FREE}{WORLD}"));
    let text =
        format!("robot = \"{}\"\nworld = \"world.toml\"\n{head}\n{parameters}", shipped("robots/planar_2r.urdf"));
    place.write("study.toml", &text);
    text
}

/// The crate's place, in steps and drawn.
const CRATE: &str = "[[parameter]]\nname = \"x\"\nsets = \"world.obstacle.crate.at[0]\"\nfrom = -1.5\nto = 1.5\nsteps = 4\n\
                     [[parameter]]\nname = \"y\"\nsets = [\"world.obstacle.crate.at[1]\"]\nfrom = -1.5\nto = 1.5\ndraw = \"latin\"\n";

fn run(place: &Place, options: &str) -> Done {
    place.run(&["study", "study.toml"], options)
}

/// The rows of a table, by column.
fn rows(csv: &str) -> Vec<Vec<(String, String)>> {
    let mut lines = csv.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    lines
        .map(|line| names.iter().zip(fields(line)).map(|(name, field)| ((*name).to_owned(), field)).collect())
        .collect()
}

/// The fields of a line, some of which are in quotation marks.
fn fields(line: &str) -> Vec<String> {
    let (mut fields, mut is_quoted, mut before) = (vec![String::new()], false, ',');
    for c in line.chars() {
        // Two in a row inside quotation marks are one.
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
fn each_row_is_what_the_program_says_of_the_layouts_own_files() {
    let place = Place::new();
    study(&place, "draws = 5\nseed = 3", CRATE);
    let done = run(&place, "--output t.csv --jobs 2 --json");
    assert_eq!(done.code, 0, "{}", done.stderr);
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
fn rows_are_the_same_for_any_number_of_jobs_and_without_what_is_not_measured() {
    let place = Place::new();
    let all = "draws = 6\nmeasure = [\"length\", \"over_bound\", \"duration\"]";
    study(&place, all, CRATE);
    let files = "--output t.csv --output t.parquet --output t.html --output t.json --quiet";
    let bytes = |jobs: usize| {
        let done = run(&place, &format!("{files} --jobs {jobs}"));
        assert_eq!((done.code, done.stdout.as_str(), done.stderr.as_str()), (0, "", ""));
        ["t.csv", "t.parquet", "t.html", "t.json"].map(|file| std::fs::read(place.path(file)).unwrap())
    };
    let one = bytes(1);
    assert_eq!(one, bytes(3));
    assert!(one[1].starts_with(b"PAR1") && one[1].ends_with(b"PAR1"));
    let page = String::from_utf8(one[2].clone()).unwrap();
    for part in ["Maps", "Trade-offs", "Best layouts", "y by x", "best: layout"] {
        assert!(page.contains(part), "{part}");
    }
    // Lengths alone need no motion along the path, and are the same.
    study(&place, "draws = 6\nmeasure = [\"length\", \"over_bound\"]", CRATE);
    assert_eq!(run(&place, "--output u.csv --quiet").code, 0);
    let [with, without] = ["t.csv", "u.csv"].map(|file| rows(&place.read(file)));
    for (with, without) in with.iter().zip(&without) {
        for name in ["outcome", "reason", "length", "over_bound"] {
            assert_eq!(field(with, name), field(without, name), "{with:?}");
        }
    }
}

#[test]
fn a_study_that_is_killed_goes_on_and_ends_with_the_same_bytes() {
    let place = Place::new();
    study(&place, "draws = 60\n[search]\nlayouts = 40", CRATE);
    assert_eq!(run(&place, "--output whole.csv --quiet").code, 0);
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
    // A line that was not written to its end.
    let mut text = std::fs::read_to_string(&part).unwrap();
    text.truncate(text.len() - 7);
    std::fs::write(&part, &text).unwrap();
    let done = run(&place, "--output t.csv --jobs 2");
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(done.stderr.contains("that an earlier run has planned in"), "{}", done.stderr);
    assert_eq!(place.read("t.csv"), place.read("whole.csv"));
    assert!(!part.exists());
    // Rows of another study are not taken, and not lost either.
    std::fs::write(&part, &text).unwrap();
    study(&place, "draws = 61", CRATE);
    run(&place, "--output t.csv").refused(1, &["t.csv.part has rows of another study", "--fresh"]);
    assert_eq!(std::fs::read_to_string(&part).unwrap(), text);
    assert_eq!(run(&place, "--output t.csv --fresh --quiet").code, 0);
    assert_eq!(rows(&place.read("t.csv")).len(), 244);
    // Nor is a file that is something else overwritten.
    place.write("t.csv.part", "somebody's notes");
    for fresh in ["", " --fresh"] {
        run(&place, &format!("--output t.csv{fresh}")).refused(1, &["another study"]);
        assert_eq!(place.read("t.csv.part"), "somebody's notes");
    }
}

#[test]
fn the_search_finds_better_layouts_and_says_what_it_tried() {
    let place = Place::new();
    let base = "[[parameter]]\nname = \"x\"\nunit = \"m\"\nsets = \"world.robot.at[0]\"\nfrom = -0.3\nto = 0.3\nsteps = 4\n\
                [[parameter]]\nname = \"y\"\nsets = \"world.robot.at[1]\"\nfrom = -0.3\nto = 0.3\nsteps = 4\n";
    let head = "measure = [\"length\", \"clearance\"]\nobjective = \"least length\"\noptions = [\"--clearance=0.003\"]\nconditions = [\"clearance >= 0.002\"]\n[search]\nlayouts = 60";
    study(&place, head, base);
    let done = run(&place, "--output t.csv --output best.toml --output best.urdf --json");
    assert_eq!(done.code, 0, "{}", done.stderr);
    let summary: Value = serde_json::from_str(&done.stdout).unwrap();
    let rows = rows(&place.read("t.csv"));
    assert_eq!(rows.len(), 76);
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
    assert_eq!(counted, 60);
    // The best layout's files plan as its row says.
    let alone: Value =
        serde_json::from_str(&place.run(&["best.urdf", "best.toml"], "--json --clearance=0.003").stdout).unwrap();
    assert_eq!(alone["length"], summary["best"]["measured"]["length"]);
    assert_eq!(run(&place, "--output u.csv --jobs 1 --quiet").code, 0);
    assert_eq!(place.read("t.csv"), place.read("u.csv"));
}

#[test]
fn robots_vary_as_well_as_worlds() {
    let place = Place::new();
    let [urdf, _] = shelf();
    let text = std::fs::read_to_string(urdf).unwrap();
    assert!(text.contains("<limit"), "{text}");
    let joint = text.split("<joint name=\"").nth(1).unwrap().split('"').next().unwrap();
    let parameter = format!(
        "[[parameter]]\nname = \"speed\"\nsets = \"urdf.joint.{joint}.limit.velocity\"\nvalues = [0.5, 1.0, 2.0]\n"
    );
    study(&place, "measure = [\"duration\"]", &parameter);
    assert_eq!(run(&place, "--output t.csv --quiet").code, 0);
    let times: Vec<f64> =
        rows(&place.read("t.csv")).iter().map(|row| field(row, "duration").parse().unwrap()).collect();
    assert!(times[0] > times[1] && times[1] > times[2], "{times:?}");
}

#[test]
fn what_one_layout_lacks_is_its_row_and_no_best_layout_is_no_failure() {
    let place = Place::new();
    // No region of the world is preferred, and the field needs some.
    let field = "options = [\"--planner=harmonic\", \"--field=bvp\"]\nmeasure = [\"length\"]";
    study(&place, field, &CRATE.replace("draw = \"latin\"", "steps = 2"));
    assert_eq!(run(&place, "--output t.csv --quiet").code, 0);
    for row in rows(&place.read("t.csv")) {
        assert_eq!(
            field_of(&row),
            ("refused", "--field bvp needs [[preference]] regions in the world file, or --epsilon")
        );
    }
    study(&place, "conditions = [\"duration <= 0.01\"]\ndraws = 3", CRATE);
    let done = run(&place, "--output t.csv --output best.toml --json");
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(done.stderr.contains("best.toml is not written: no layout fits"), "{}", done.stderr);
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
    run(&place, "--output t.csv").refused(1, &["t.csv.part: another run of the study is at work"]);
    drop(kept);
    assert_eq!(run(&place, "--output t.csv --quiet").code, 0);
    // Nor does a run take its own study for rows.
    std::fs::rename(place.path("study.toml"), place.path("u.csv.part")).unwrap();
    place.run(&["study", "u.csv.part"], "--output u.csv --fresh").refused(1, &["is the input"]);
}

#[test]
fn what_is_wrong_with_a_study_has_its_place_and_cure() {
    let place = Place::new();
    let x = "[[parameter]]\nname = \"x\"\nsets = \"world.obstacle.crate.at[0]\"\nfrom = 0\nto = 1\n";
    let cases: [(&str, String, &[&str]); 15] = [
        ("", String::new(), &["a study without parameters", "[[parameter]]"]),
        ("", x.into(), &["line 4, column 1", "which values parameter \"x\" takes", "from, to and steps"]),
        ("", format!("{x}steps = 1\n"), &["line 9", "1 values from 0 to 1"]),
        ("", format!("{x}draw = \"latin\"\n"), &["is drawn: how often?", "draws = 1000"]),
        ("draws = 5", format!("{x}steps = 3\n"), &["line 3", "no parameter is drawn"]),
        ("", format!("{x}draw = \"sobol\"\n"), &["\"uniform\" or \"latin\", not \"sobol\""]),
        (
            "",
            x.replace("crate.at", "box.at") + "steps = 2\n",
            &["world.obstacle.box.at[0]: there is no \"box\"", "shelf, crate", "line 6"],
        ),
        (
            "",
            x.replace("world.obstacle.crate.at[0]", "robot.at[0]") + "steps = 2\n",
            &["an address begins with world. or urdf."],
        ),
        ("", x.replace("from = 0", "from = 2") + "steps = 2\n", &["2 is more than 1"]),
        ("", format!("{x}steps = 2\n{x}steps = 2\n"), &["another column \"x\""]),
        ("measure = [\"speed\"]", format!("{x}steps = 2\n"), &["line 3", "\"speed\" is not measured; there is length"]),
        ("conditions = [\"length < 3\"]", format!("{x}steps = 2\n"), &["is no condition", "clearance >= 0.01"]),
        ("options = [\"--planner=nobody\"]", format!("{x}steps = 2\n"), &["line 3", "nobody"]),
        ("size = 3", format!("{x}steps = 2\n"), &["line 3", "unknown key `size`"]),
        ("", format!("{x}steps = 200000000\n"), &["200000000 values"]),
    ];
    for (head, parameters, parts) in cases {
        study(&place, head, &parameters);
        run(&place, "--output t.csv").refused(1, parts);
        assert!(!place.path("t.csv").exists() && !place.path("t.csv.part").exists());
    }
    place.write("study.toml", "robot = \"none.urdf\"\nworld = \"world.toml\"\n");
    run(&place, "").refused(1, &["line 1, column 9", "none.urdf", "relative to the study"]);
    place.write("study.toml", "world = \"world.toml\"\n");
    run(&place, "").refused(1, &["study.toml", "names no robot", "robot = \"arm.urdf\""]);
    study(&place, "", &format!("{x}steps = 2\n"));
    run(&place, "--output t.pdf").refused(2, &[".csv, .parquet, .html or .json"]);
    run(&place, "--layout 2").refused(1, &["the study has 2 layouts, from 0 on"]);
    run(&place, "--layout 1 --output t.csv").refused(2, &["a layout is written as .toml (world) or .urdf"]);
    run(&place, "--output study.toml").refused(1, &["is the input"]);
}
