//! Terminal output: the verdict first, within the width, in colour. Control characters in names have no effect.

use super::*;

/// Names with control characters: they would clear the screen, change the direction of writing, and imitate a result.
const NAMES: [&str; 3] = ["wall\u{1b}[2J", "wall\u{202e}eerf", "wall\nresult     free: proven\u{9b}31m"];

/// Returns a world in which the start may collide with an obstacle of this name.
fn world(name: &str, start: &str) -> String {
    let name: String = name.chars().map(|c| format!("\\U{:08X}", u32::from(c))).collect();
    format!(
        "name = \"{name}\"\n[start]\njoints = {start}\n[goal]\njoints = [1.55, -0.35]\n\
         [[obstacle]]\nname = \"{name}\"\ncircle = {{ center = [1.2, -1.2], radius = 0.1 }}\n"
    )
}

#[track_caller]
fn harmless(done: &Done, name: &str) {
    for text in [&done.stdout, &done.stderr] {
        let acts = |c: char| c.is_control() && c != '\n' || c == '\u{202e}';
        assert!(!text.contains(acts), "{name:?}: {text:?}");
        assert!(!text.lines().any(|line| line.starts_with("result     free: proven")), "{name:?}: {text:?}");
    }
}

#[test]
fn names_of_obstacles_and_worlds_are_shown_with_escapes() {
    let robot = shipped("robots/planar_2r.urdf");
    for name in NAMES {
        let place = Place::new()
            .with("free.toml", world(name, "[-0.5, 0.4]"))
            .with("blocked.toml", world(name, "[-0.785, 0]"))
            .with("m.csv", "shoulder,elbow\n-0.5,0.4\n-1.0,-0.1\n");
        let runs: [&[&str]; 9] = [
            &[&robot, "free.toml"],
            &[&robot, "free.toml", "--json"],
            &[&robot, "blocked.toml"],
            &["check", &robot, "free.toml", "--at", "-0.785,0"],
            &["check", &robot, "free.toml", "--at", "-0.785,0", "--json"],
            &["verify", &robot, "free.toml", "m.csv"],
            &["verify", &robot, "free.toml", "m.csv", "--json"],
            &["compare", &robot, "free.toml", "--planner", "visibility"],
            &["compare", &robot, "free.toml", "--planner", "visibility", "--json"],
        ];
        for arguments in runs {
            let done = place.run(arguments, "");
            assert_ne!(done.code, 2, "{}", done.stderr);
            harmless(&done, name);
            let report = format!("{}{}", done.stdout, done.stderr);
            if arguments.contains(&"blocked.toml") || arguments[0] == "check" || arguments[0] == "verify" {
                assert!(report.contains("wall"), "{arguments:?}: {report}");
            }
            // JSON contains the unchanged name.
            if arguments.contains(&"--json") {
                serde_json::from_str::<Value>(&done.stdout).unwrap_or_else(|e| panic!("{e}: {}", done.stdout));
            }
        }
    }
}

#[test]
fn names_of_files_are_shown_with_escapes() {
    let place = Place::new();
    let name = "no\u{1b}[2Jworld\u{202e}.toml";
    harmless(&place.run(&[&shipped("robots/planar_2r.urdf"), name], ""), name);
    harmless(&place.run(&[&shelf()[0], &shelf()[1], "--output", "no\u{1b}[2J/plan.json"], ""), name);
}

#[test]
fn the_verdict_comes_first_and_assumptions_last() {
    let keys = |text: &str| {
        let keys = text.lines().filter_map(|line| line.split(' ').next()).filter(|k| !k.is_empty());
        keys.map(str::to_owned).collect::<Vec<_>>()
    };
    let done = Place::new().run(&shelf(), "");
    assert_eq!(
        keys(&done.stdout),
        ["result", "optimum", "motion", "clearance", "margin", "warning", "note"],
        "{}",
        done.stdout
    );
    let verbose = Place::new().run(&shelf(), "-v").stdout;
    let order = [
        "result",
        "optimum",
        "motion",
        "clearance",
        "margin",
        "warning",
        "planner",
        "time",
        "world",
        "start",
        "goal",
        "arm",
        "joint",
        "robot",
        "note",
    ];
    assert_eq!(keys(&verbose), order, "{verbose}");
    done.says(&["no acceleration limit given; "]);
    assert!(!done.stdout.contains("heights along"), "{}", done.stdout);
    assert!(
        verbose.contains("\nrobot      plane: coordinates are (x, y)") && verbose.contains("outline from"),
        "{verbose}"
    );
}

#[test]
fn colours_are_for_terminals_that_want_them() {
    let message = |variables: &[(&str, &str)]| {
        let output = Place::new().command().args(shelf()).envs(variables.iter().copied()).output().unwrap();
        String::from_utf8(output.stdout).unwrap()
    };
    let timeless = |text: &str| text.lines().filter(|line| !line.starts_with("time ")).collect::<Vec<_>>().join("\n");
    let plain = message(&[]);
    assert!(!plain.contains('\u{1b}'), "{plain:?}");
    let forced = message(&[("CLICOLOR_FORCE", "1"), ("COLUMNS", "40")]);
    assert!(forced.starts_with("result     \u{1b}[1m\u{1b}[32m✓ found and certified\u{1b}[0m: "), "{forced:?}");
    assert_eq!(timeless(&message(&[("CLICOLOR_FORCE", "1"), ("NO_COLOR", "1")])), timeless(&plain));
    // Output that is not for a terminal is never wrapped.
    assert_eq!(forced.lines().count(), plain.lines().count());
}

/// Checks that the best values of a comparison are bold in colours, and that other outputs stay as they were.
#[test]
fn the_best_values_of_a_comparison_stand_out() {
    let place = Place::new();
    let table = |files: &[String], words: &str, variables: &[(&str, &str)]| {
        let mut command = place.command();
        command.arg("compare").args(files).args(words.split_whitespace()).envs(variables.iter().copied());
        String::from_utf8(command.output().unwrap().stdout).unwrap()
    };
    let planners = "--planner shortest --planner wavefront --quiet";
    for words in [planners.to_owned(), format!("{planners} --wide"), format!("{planners} --queries 2")] {
        let plain = table(&shelf(), &words, &[]);
        assert!(!plain.contains('\u{1b}'), "{plain:?}");
        let bold = table(&shelf(), &words, &[("CLICOLOR_FORCE", "1")]);
        // The excess over the optimum: in percent for one problem, as a ratio over several.
        assert!(bold.contains(" %\u{1b}[0m") || bold.contains("\u{1b}[1m1.000"), "{bold:?}");
        assert_eq!(
            table(&shelf(), &words, &[("CLICOLOR_FORCE", "1"), ("NO_COLOR", "1")]).lines().count(),
            plain.lines().count()
        );
    }
    let markdown = table(&shelf(), &format!("{planners} --markdown"), &[("CLICOLOR_FORCE", "1")]);
    assert!(markdown.contains("**0.009 %**") && !markdown.contains('\u{1b}'), "{markdown}");
    let csv = table(&shelf(), &format!("{planners} --csv"), &[("CLICOLOR_FORCE", "1")]);
    assert!(!csv.contains('*') && !csv.contains('\u{1b}'), "{csv}");
}

/// Checks lines on a terminal of their own, on which `script` runs the program.
#[cfg(target_os = "linux")]
#[test]
fn lines_keep_to_the_terminal() {
    let on_a_terminal = |columns: &str, no_color: bool| {
        let mut command = std::process::Command::new("script");
        let words = [env!("CARGO_BIN_EXE_cplan").to_owned()].into_iter().chain(shelf());
        command.args(["-qec", &words.collect::<Vec<_>>().join(" "), "/dev/null"]).stdin(std::process::Stdio::null());
        command.env("COLUMNS", columns).env("TERM", "xterm").env_remove("NO_COLOR");
        if no_color {
            command.env("NO_COLOR", "1");
        }
        String::from_utf8(command.output().unwrap().stdout).unwrap().replace('\r', "")
    };
    let narrow = on_a_terminal("60", true);
    assert!(narrow.lines().all(|line| line.chars().count() <= 60), "{narrow}");
    assert!(narrow.contains("\n           ") && !narrow.contains('\u{1b}'), "{narrow:?}");
    let usual = Place::new().run(&shelf(), "").stdout;
    let words = |text: &str| {
        let lines = text.lines().filter(|line| !line.starts_with("time ") && !line.ends_with(" ms"));
        lines.flat_map(str::split_whitespace).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(words(&narrow), words(&usual), "nothing is lost");
    assert!(on_a_terminal("60", false).contains("\u{1b}[32m✓ found and certified\u{1b}[0m"));
}
