//! Help, completions and manual pages: every example in them is a valid command.

use super::*;
use cplan::engine::Method;

/// Examples that the test only parses, because they would run too long or without end, or need a file that has to be
/// built.
const ONLY_READ: [&str; 4] = ["cplan serve", "--suite", "--queries", "--engine"];

/// Returns the commands that the help lists.
pub fn commands(place: &Place) -> Vec<String> {
    let help = place.run(&["--help"], "").stdout;
    let listed = help.split("\n\nStart:\n").nth(1).expect("a list of commands").split("\n\nArguments:").next().unwrap();
    let names: Vec<String> = listed
        .lines()
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "))
        .filter_map(|line| line.split_whitespace().next())
        .map(str::to_owned)
        .collect();
    assert!(names.len() > 8, "{names:?}");
    names
}

/// Returns the words of a command line without quotes, and without redirections or pipes.
pub fn words(line: &str) -> Vec<String> {
    let mut words = Vec::new();
    for (i, part) in line.split('"').enumerate() {
        if i % 2 == 1 {
            words.push(part.to_owned());
        } else {
            words.extend(part.split_whitespace().map(str::to_owned));
        }
    }
    let end = words.iter().position(|word| [">", ">>", "|"].contains(&word.as_str()));
    words.truncate(end.unwrap_or(words.len()));
    words
}

/// Copies the files of a shipped folder, with its subfolders.
pub fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy(&entry.path(), &target);
        } else {
            std::fs::copy(entry.path(), target).unwrap();
        }
    }
}

#[test]
fn every_command_has_examples_and_they_run() {
    let place = Place::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for folder in ["robots", "workspaces"] {
        copy(&root.join(folder), &place.path(folder));
    }
    place.write("recorded.csv", "time,shoulder,elbow\n0,-0.9,0.4\n1,-1.0,0.5\n");
    place.write("planned.csv", "time,shoulder,elbow\n0,-0.9,0.4\n1,-1.0,0.5\n");
    place.write("turns.csv", "time,shoulder,elbow\n0,0.0,3.1\n1,0.0,-3.1\n");
    std::fs::create_dir_all(place.path("results/mine")).unwrap();
    place.write("results/mine/shelf.csv", "time,shoulder,elbow\n0,-0.9,0.4\n1,-1.0,0.5\n");
    place.write("problems.jsonl", r#"{"urdf": "robots/planar_2r.urdf", "world": "workspaces/shelf.toml"}"#);
    let mut helps = vec![("main".to_owned(), place.run(&["--help"], "").stdout)];
    for name in commands(&place) {
        helps.push((name.clone(), place.run(&[name.as_str(), "--help"], "").stdout));
    }
    let mut ran = 0;
    for (name, help) in &helps {
        assert!(help.contains("Exit codes:"), "{name}: no exit codes");
        let help = help.replace("\\\n", " ");
        let examples: Vec<&str> = help.lines().filter_map(|line| line.strip_prefix("  cplan ")).collect();
        assert!(!examples.is_empty(), "{name}: no examples");
        for example in examples {
            if ONLY_READ.iter().any(|part| format!("cplan {example}").contains(part)) {
                continue;
            }
            let done = place.run(&words(example), "");
            assert!([0, 3].contains(&done.code), "{name}: {example}: {} {}", done.code, done.stderr);
            assert!(!done.stderr.contains("error"), "{name}: {example}: {}", done.stderr);
            // Removes the files of one example, so that they do not affect the next command.
            for file in ["plan.json", "plan.html"] {
                let _ = std::fs::remove_file(place.path(file));
            }
            let _ = std::fs::remove_dir_all(place.path("cell"));
            let _ = std::fs::remove_dir_all(place.path("wider"));
            ran += 1;
        }
    }
    assert!(ran >= 30, "only {ran} examples");
}

#[test]
fn completions_know_commands_options_and_values() {
    let place = Place::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let done = place.run(&["completions", shell], "").succeeds_silently();
        done.says(&["planner", "goal-tip", "recheck", "completions"]);
        // The generators for the other two shells list no values.
        for part in ["visibility", "subdivision", "astar", "scara", "gauss-seidel"] {
            let has_values = ["bash", "zsh", "fish"].contains(&shell);
            assert!(!has_values || done.stdout.contains(part), "{shell}: no {part}");
        }
    }
    place.run(&["completions", "csh"], "").refused(2, &["bash, elvish, fish, powershell, zsh"]);
    let bash = place.run(&["completions", "bash"], "").stdout;
    let planner = bash.split("--planner)\n").nth(1).expect("values of --planner").lines().next().unwrap();
    assert!(planner.contains(&format!("compgen -W \"{}\"", Method::ALL.map(Method::name).join(" "))), "{planner}");
    let output = bash.split("--output)\n").nth(1).expect("values of --output").split(";;").next().unwrap();
    assert!(output.contains("compgen -f"), "{output}");
    let dir = bash.split("--dir)\n").nth(1).expect("values of --dir").split(";;").next().unwrap();
    assert!(dir.contains("compgen -d") || dir.contains("-o plusdirs"), "{dir}");
}

#[test]
fn help_fits_80_columns_and_lists_planner_options_in_one_place() {
    let place = Place::new();
    for name in commands(&place).iter().map(String::as_str).chain([""]) {
        let words: Vec<&str> = [name, "--help"].into_iter().filter(|word| !word.is_empty()).collect();
        let help = place.run(&words, "").stdout;
        let wide: Vec<&str> = help.lines().filter(|line| line.chars().count() > 80).collect();
        assert!(wide.is_empty(), "{name}: {wide:?}");
        assert_eq!(help.contains("--neighbors <N>"), name == "planners", "{name}");
        let sections = help.lines().filter(|line| line.ends_with(':') && !line.starts_with(' ')).collect::<Vec<_>>();
        assert_eq!(sections.contains(&"Resolution:"), ["planners", "compare"].contains(&name), "{name}: {sections:?}");
    }
    let compare = place.run(&["compare", "--help"], "").stdout;
    let output = compare.split("\nOutput:\n").nth(1).expect("a section for output");
    assert!(output.contains("--output <FILE>") && output.contains("--wide"), "{compare}");
}

/// Returns fish's completions of a command line. Returns `None` if fish is not installed.
fn fish_completions(place: &Place, line: &str) -> Option<Vec<String>> {
    let script = format!("source cplan.fish; complete -C '{line}'");
    let mut fish = std::process::Command::new("fish");
    fish.args(["--no-config", "-c", &script]).current_dir(place.path("")).env("HOME", place.path(""));
    let report = String::from_utf8(fish.output().ok()?.stdout).expect("UTF-8");
    Some(report.lines().filter_map(|line| line.split('\t').next()).map(str::to_owned).collect())
}

#[test]
fn fish_completes_after_any_arguments() {
    let place = Place::new();
    let script = place.run(&["completions", "fish"], "").stdout;
    // Options are also offered after the files of `cplan URDF WORLD`. Only subcommands must be the first word.
    assert!(!script.contains("needs_command\" -l") && !script.contains("needs_command\" -s"), "{script}");
    for rule in [
        "$__fish_cplan_commands\" -l planner",
        "subcommand completions\" -f -a \"zsh\"",
        "subcommand help\" -f -a \"study\"",
    ] {
        assert!(script.contains(rule), "{rule}");
    }
    place.write("cplan.fish", &script);
    place.write("arm.urdf", "");
    for (line, has, lacks) in [
        ("cplan ", "compare", "visibility"),
        ("cplan ", "arm.urdf", "--planner"),
        ("cplan arm.urdf world.toml --pl", "--planner", "arm.urdf"),
        ("cplan arm.urdf world.toml --planner ", "visibility", "arm.urdf"),
        ("cplan --planner ", "visibility", "compare"),
        ("cplan compare arm.urdf world.toml --wi", "--wide", "--goal-tip"),
        ("cplan completions ", "fish", "arm.urdf"),
        ("cplan help ", "study", "arm.urdf"),
    ] {
        let Some(offered) = fish_completions(&place, line) else {
            eprintln!("there is no fish here: its script was read, but not run");
            return;
        };
        let offers = |word: &str| offered.iter().any(|offered| offered == word);
        assert!(offers(has) && !offers(lacks), "{line}: {offered:?}");
    }
}

#[test]
fn manual_pages_agree_with_the_help() {
    let place = Place::new();
    let main = place.run(&["man"], "").stdout;
    assert!(main.contains(".TH cplan 1"), "{main}");
    let written = place.run(&["man", "pages/man1"], "").succeeds_silently();
    let mut pages: Vec<&str> = written.stdout.lines().collect();
    let mut expected: Vec<String> = commands(&place).iter().map(|name| format!("pages/man1/cplan-{name}.1")).collect();
    expected.push("pages/man1/cplan.1".into());
    pages.sort_unstable();
    expected.sort_unstable();
    assert_eq!(pages, expected);
    assert_eq!(place.read("pages/man1/cplan.1"), main);
    for page in pages {
        let text = place.read(page);
        for section in ["NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "EXIT STATUS", "EXAMPLES"] {
            assert!(text.lines().any(|l| l.replace('"', "") == format!(".SH {section}")), "{page}: no {section}");
        }
        // An example is on a separate line, between the requests that switch filling off and on.
        let examples = text.split(".SH \"EXAMPLES\"\n").nth(1).unwrap();
        assert!(examples.contains(".EX\ncplan "), "{page}: {examples}");
        assert_eq!(text.matches("\n.EX\n").count(), text.matches("\n.EE\n").count(), "{page}");
    }
    // Existing pages are overwritten.
    place.run(&["man", "pages/man1"], "").exits(0);
    place.write("file", "");
    place.run(&["man", "file"], "").refused(1, &["cannot make the folder file"]);
}
