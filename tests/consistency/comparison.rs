//! Comparison of all commands for one case.

use super::program::{Done, Folder};
use super::worlds::Case;
use cplan_check_files::check;
use serde_json::{Value, json};

/// The words of results and the exit codes of `plan`, `explain` and `follow`.
const CODES: [(&str, i32); 4] = [("found", 0), ("error", 1), ("infeasible", 3), ("unknown", 4)];

/// A case with the answer of `plan`, and all contradictions to it.
struct Comparison<'a> {
    case: &'a Case,
    folder: &'a Folder,
    plan: Done,
    status: &'static str,
    contradictions: Vec<String>,
}

impl Comparison<'_> {
    /// Records a contradiction unless `agrees`.
    fn require(&mut self, agrees: bool, what: &str, done: &Done) {
        if !agrees {
            self.contradictions.push(format!("{what}\n{}", done.transcript));
        }
    }

    /// Returns the kind of the error with which `plan` refuses the world: `start`, `goal` or `input`.
    fn error_kind(&self) -> Option<String> {
        (self.status == "error").then(|| self.plan.json()["kind"].as_str().unwrap_or_default().to_owned())
    }

    /// Compares `explain`: its exit code is that of `plan`, except that it explains a blocked start or goal.
    fn compare_explain(&mut self) {
        let done = self.folder.run("explain robot.urdf world.toml --json --time 0.5");
        let is_blocked_end = match self.error_kind().as_deref() {
            Some("start") => true,
            Some("goal") => !self.case.has_tool && !self.case.has_steps,
            _ => false,
        };
        let expected = if is_blocked_end { 3 } else { self.plan.code };
        self.require(done.code == expected, &format!("explain ends with {}, not {expected}", done.code), &done);
        let status = done.json()["status"].clone();
        let word = CODES.iter().find(|(_, code)| *code == done.code).map(|(word, _)| *word);
        self.require(status.as_str() == word, "explain prints another status", &done);
    }

    /// Compares `check` at both ends of the motion.
    fn compare_check(&mut self) {
        let is_free = |folder: &Folder, [a, b]: [f64; 2]| {
            let done = folder.run(&format!("check robot.urdf world.toml --at={a:?},{b:?} --json"));
            (done.json()["free"] == true, done)
        };
        let (is_start_free, done) = is_free(self.folder, self.case.start);
        match self.error_kind().as_deref() {
            // The start of a tool may be blocked while it is lowered.
            Some("start") => {
                self.require(self.case.has_tool || !is_start_free, "check says that the start is free", &done)
            }
            Some(_) => {}
            None => self.require(is_start_free, "check says that the start is not free", &done),
        }
        let Some(goal) = self.case.goal else { return };
        let (is_goal_free, done) = is_free(self.folder, goal);
        match self.error_kind().as_deref() {
            Some("goal") => self.require(!is_goal_free, "check says that the goal is free", &done),
            Some(_) => {}
            None if self.status == "found" || !self.case.has_tool => {
                self.require(is_goal_free, "check says that the goal is not free", &done);
            }
            None => {}
        }
    }

    /// Compares `verify` of all files that `plan` has written.
    fn compare_verify(&mut self) {
        if self.status != "found" {
            return;
        }
        // Tables have no steps.
        let files: &[&str] = if self.case.has_steps { &["m.json"] } else { &["m.json", "m.csv", "m.yaml", "m.mcap"] };
        for file in files {
            let done = self.folder.run(&format!("verify robot.urdf world.toml {file} --json"));
            self.require(done.code == 0, &format!("verify of {file} ends with {}", done.code), &done);
        }
    }

    /// Compares the independent checker. Infeasible tasks have no certificate.
    fn compare_checker(&mut self) {
        let is_stated = self.status == "found" || self.status == "infeasible" && !self.is_task();
        let Some(certificate) = self.folder.read("c.json") else {
            self.contradictions.extend(is_stated.then(|| format!("no certificate\n{}", self.plan.transcript)));
            return;
        };
        if let Err(error) = check(&self.case.urdf, &self.case.world, &certificate) {
            self.contradictions.push(format!("the checker: {error}\n{}", self.plan.transcript));
        }
    }

    fn is_task(&self) -> bool {
        self.case.has_steps || self.case.has_tool
    }

    /// Compares `study` of this one layout.
    fn compare_study(&mut self) {
        let clearance = self.case.world.lines().find_map(|line| line.strip_prefix("clearance = ")).unwrap_or("0.0");
        self.folder.write(
            "study.toml",
            &format!(
                "robot = \"robot.urdf\"\nworld = \"world.toml\"\noverlap = true\n[[parameter]]\nname = \"stated clearance\"\n\
                 sets = \"world.clearance\"\nfrom = {clearance}\nto = {clearance}\nsteps = 1\n"
            ),
        );
        let done = self.folder.run("study study.toml --json --quiet");
        let expected = if self.status == "error" { "refused" } else { self.status };
        // A study refuses a world that is invalid in every layout.
        let is_invalid = self.error_kind().as_deref() == Some("input") && done.code == 1;
        let agrees = is_invalid || done.code == 0 && done.json()["outcomes"][expected] == 1;
        self.require(agrees, &format!("study does not say {expected}"), &done);
    }

    /// Compares `batch` with this one problem.
    fn compare_batch(&mut self) {
        let line = json!({ "urdf": "robot.urdf", "world": "world.toml" });
        self.folder.write("batch.jsonl", &line.to_string());
        let done = self.folder.run("batch batch.jsonl --fields status,length");
        let (batch, plan): (Value, Value) = (done.json(), self.plan.json());
        let agrees = ["status", "kind", "length"].iter().all(|key| batch[key] == plan[key]);
        self.require(agrees, "batch has another answer", &done);
    }
}

/// Asks all commands about a case, and returns the status of `plan` or `follow`, and the contradictions.
pub fn compare(case: &Case) -> (&'static str, Vec<String>) {
    let folder = Folder::new();
    folder.write("robot.urdf", &case.urdf);
    folder.write("world.toml", &case.world);
    let outputs = "--json --output m.json --output m.csv --output m.yaml --certificate c.json";
    let plan = match &case.line {
        Some(line) => {
            folder.write("line.toml", line);
            folder.run(&format!("follow robot.urdf world.toml line.toml {outputs}"))
        }
        None => folder.run(&format!("robot.urdf world.toml {outputs} --output m.mcap")),
    };
    let status = CODES.iter().find(|(_, code)| *code == plan.code).map(|(word, _)| *word);
    let status = status.unwrap_or_else(|| panic!("{}", plan.transcript));
    let mut comparison = Comparison { case, folder: &folder, plan, status, contradictions: Vec::new() };
    let stated = comparison.plan.json()["status"].clone();
    if stated != status {
        comparison.contradictions.push(format!("status and exit code differ\n{}", comparison.plan.transcript));
    }
    if case.line.is_some() {
        compare_line(&mut comparison);
    } else {
        comparison.compare_explain();
        comparison.compare_check();
        comparison.compare_verify();
        comparison.compare_checker();
        comparison.compare_study();
        comparison.compare_batch();
    }
    (status, comparison.contradictions)
}

/// Compares the files of `follow`: `verify`, and the checker, which judges proofs, too.
fn compare_line(comparison: &mut Comparison) {
    if comparison.status == "found" {
        for file in ["m.json", "m.csv", "m.yaml"] {
            let done = comparison.folder.run(&format!("verify robot.urdf world.toml {file} --anywhere --json"));
            comparison.require(done.code == 0, &format!("verify of {file} ends with {}", done.code), &done);
        }
    }
    if comparison.status == "found" || comparison.folder.read("c.json").is_some() {
        comparison.compare_checker();
    }
}
