//! `cplan verify` for the motions of two arms in one cell.

use super::{VerifyArgs, cell_proof, cell_steps, text};
use crate::cli::cell::skew_or_default;
use crate::cli::exit::{DONE, REFUTED, UNKNOWN};
use crate::cli::failure::Failure;
use crate::cli::sinks;
use crate::engine::findings::{Judgement, MotionFindings, verify};
use crate::input::{self, LoadedRecording, Source, read_recording};
use crate::output::{Line, configuration, format_columns};
use crate::text::{chosen_length, length, length_down};
use cplan_cell::{BetweenFinding, Cell, NearPlace, ToolTimes, judge_between, judge_steps};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Rounding of a stated distance, metres.
const ROUNDING: f64 = 1e-9;

/// Returns true if the first file of the command line is a cell: no robot's file ends in .toml.
pub fn is_cell(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"))
}

/// The judged motions of both arms.
struct Judged {
    cell: Cell,
    recorded: [LoadedRecording; 2],
    findings: [MotionFindings; 2],
    between: BetweenFinding,
    skew: f64,
    /// Differences from the steps of the cell that no arm has alone.
    step_faults: Vec<String>,
    /// False statements of the file about both arms.
    faults: Vec<String>,
}

/// Motions that were read.
struct Motions {
    recorded: [LoadedRecording; 2],
    /// The result of `cplan cell` that they are from. `None` for one file of each arm.
    stated: Option<Value>,
    /// For each arm, the times at which its tool acts in each step. Empty without steps.
    tools: [Vec<ToolTimes>; 2],
}

/// Judges the motions of both arms: each among the obstacles, and both between the arms.
///
/// # Errors
/// Bad input and I/O, and options that do not apply to cells.
pub fn run(args: &VerifyArgs) -> Result<u8, Failure> {
    refuse_other_options(args)?;
    let settings = &args.settings;
    let clearance = settings.clearance;
    let cell = Cell::load(&Source::read(&args.files.urdf)?, &|path| input::robot(path).read(), clearance)?;
    for arm in &cell.arms {
        let warnings = arm.problem.robot().warnings.iter();
        warnings.for_each(|warning| args.print.print_status(&format!("warning: {}: {warning}", arm.name)));
    }
    if let Some(code) = cell_proof::run(args, &cell)? {
        return Ok(code);
    }
    let skew = skew_or_default(args.skew);
    let Motions { mut recorded, stated, tools } = recordings(args, &cell)?;
    if settings.unwrap {
        for (recorded, arm) in recorded.iter_mut().zip(&cell.arms) {
            let topology = arm.problem.scene().arm().topology();
            recorded.recording = recorded.recording.clone().unwrapped(&topology);
        }
    }
    for (recorded, arm) in recorded.iter().zip(&cell.arms) {
        if recorded.recording.times().is_none() {
            let message = format!("the motion of {} has no times, but two arms need one clock", arm.name);
            return Err(Failure::Refused(format!(
                "{message}\n  hint: write a column or a member with times in seconds"
            )));
        }
    }
    let steps = judge_steps(&cell, recorded.each_ref(), tools.each_ref().map(Vec::as_slice), skew)?;
    let (mut step_faults, mut faults) = (vec![], vec![]);
    let (findings, between) = match steps {
        Some(steps) => {
            // Other steps have other times.
            if let Some(stated) = stated.as_ref().filter(|_| steps.is_whole) {
                faults.extend(cell_steps::false_statements(&cell, stated, &steps));
            }
            step_faults = steps.faults;
            (steps.arms, steps.between)
        }
        None => {
            let of =
                |arm: usize| verify(&cell.arms[arm].loaded, &recorded[arm], &settings.overrides(), settings.anywhere);
            let motions = recorded.each_ref().map(|recorded| recorded.recording.pieces());
            ([of(0)?, of(1)?], judge_between(&cell, motions, skew))
        }
    };
    faults.extend(stated.and_then(|stated| false_distance(&stated, &between, skew)));
    let judged = Judged { cell, recorded, findings, between, skew, step_faults, faults };
    let code = match judged.verdict() {
        Judgement::Free => DONE,
        Judgement::Undecided => UNKNOWN,
        _ => REFUTED,
    };
    args.print.report(code, || sinks::pretty(&judged.json()), || judged.summary())?;
    Ok(code)
}

/// Refuses options that do not apply to cells.
fn refuse_other_options(args: &VerifyArgs) -> Result<(), Failure> {
    let settings = &args.settings;
    let given = [
        ("--start", settings.start.is_some()),
        ("--goal", settings.goal.is_some()),
        ("--goal-tip", settings.goal_tip.is_some()),
        ("--calibration", settings.calibration.is_some()),
        ("--topic", settings.topic.is_some()),
        ("--torque", settings.torque),
        ("--plan", args.plan.is_some()),
        ("--picture", !args.picture.is_empty()),
        ("--certificate", args.certificate.is_some()),
        ("--xacro-arg", !args.files.xacro_args.is_empty()),
    ];
    match given.iter().find(|(_, is_given)| *is_given) {
        Some((option, _)) => Err(Failure::Usage(format!("{option} does not apply to the motions of a cell"))),
        None => Ok(()),
    }
}

/// Reads the motions of both arms: one file for each, or a result of `cplan cell`.
fn recordings(args: &VerifyArgs, cell: &Cell) -> Result<Motions, Failure> {
    let first = &args.files.world;
    let names = cell.arms.each_ref().map(|arm| arm.name.as_str());
    if let Some(second) = &args.trajectory {
        if cell.has_steps() {
            let message = format!("{}: the arms have steps, but a motion alone does not state any", first.display());
            let hint = "verify the result of a whole cell: `cplan cell --output cell.json`";
            return Err(Failure::Refused(format!("{message}\n  hint: {hint}")));
        }
        let read = |arm: usize, path: &PathBuf| input::load_recording(path, &cell.arms[arm].loaded);
        return Ok(Motions { recorded: [read(0, first)?, read(1, second)?], stated: None, tools: [vec![], vec![]] });
    }
    let source = Source::read_recording(first)?;
    let wrong = |what: String| {
        let hint = match cell.has_steps() {
            true => "verify the result of `cplan cell --output cell.json` for this cell".to_owned(),
            false => format!(
                "give the motions of {} and {}, or the result of `cplan cell --output cell.json`",
                names[0], names[1]
            ),
        };
        Failure::Input(source.diagnostic(what).help(hint).into())
    };
    let result: Value =
        serde_json::from_str(source.text()).map_err(|error| wrong(format!("is no result of `cplan cell`: {error}")))?;
    let read = |arm: usize| {
        let motion = result["arms"].as_array().and_then(|arms| arms.iter().find(|one| one["name"] == names[arm]));
        let motion = motion.filter(|motion| motion["trajectory"].is_object());
        let motion = motion.ok_or_else(|| wrong(format!("has no motion of arm \"{}\"", names[arm])))?;
        let members = ["joints", "trajectory", "clearance"].map(|key| (key.to_owned(), motion[key].clone()));
        let mut members: serde_json::Map<String, Value> = members.into_iter().collect();
        members.insert("status".into(), json!("found"));
        let mut tools = Vec::new();
        if cell.has_steps() {
            let steps = cell_steps::read(motion).map_err(|what| wrong(format!("arm \"{}\": {what}", names[arm])))?;
            members.insert("steps".into(), steps.0);
            tools = steps.1;
        }
        let text = Value::Object(members).to_string();
        let name = format!("{}, arm \"{}\"", first.display(), names[arm]);
        let mut recorded = read_recording(&Source::in_memory(name, text), &cell.arms[arm].loaded)?;
        // The text has no other members.
        recorded.claims.iter_mut().for_each(|claims| claims.unjudged.clear());
        Ok::<_, Failure>((recorded, tools))
    };
    let ((one, own), (two, other)) = (read(0)?, read(1)?);
    Ok(Motions { recorded: [one, two], stated: Some(result), tools: [own, other] })
}

/// Returns the statement of a result about the distance of the arms, if it is false.
fn false_distance(stated: &Value, between: &BetweenFinding, skew: f64) -> Option<String> {
    let BetweenFinding::Free { nearest: Some(nearest), .. } = between else { return None };
    let claimed = stated["clearance_between"].as_f64().filter(|claimed| *claimed > nearest.distance + ROUNDING)?;
    // A result is about its own skew.
    let is_same = stated["skew"].as_f64().is_some_and(|stated| stated >= skew);
    let [claimed, seen] = [claimed, nearest.distance].map(length);
    is_same.then(|| {
        let when = when(nearest.times);
        format!("the file states that the arms keep {claimed}, but they are only {seen} apart {when}")
    })
}

fn when([one, two]: [f64; 2]) -> String {
    if one == two { format!("at {one:.6} s") } else { format!("at {one:.6} s and {two:.6} s") }
}

impl Judged {
    /// Returns the worst verdict.
    fn verdict(&self) -> Judgement {
        let between = match &self.between {
            BetweenFinding::Free { .. } if self.faults.is_empty() => Judgement::Free,
            BetweenFinding::Free { .. } => Judgement::Claims,
            BetweenFinding::TooNear { .. } => Judgement::Collision,
            BetweenFinding::Undecided => Judgement::Undecided,
        };
        let steps = if self.step_faults.is_empty() { Judgement::Free } else { Judgement::Task };
        self.findings.iter().map(|findings| findings.verdict).fold(between.max(steps), Judgement::max)
    }

    fn json(&self) -> Value {
        let place = |place: &NearPlace| {
            json!({
                "times": place.times,
                "configurations": place.at.map(|q| [q[0], q[1]]),
                "distance": place.distance,
                "links": place.links,
                "point": place.point,
            })
        };
        let between = match &self.between {
            BetweenFinding::Free { clearance, nearest } => json!({
                "verdict": "free",
                "clearance": Some(*clearance).filter(|clearance| clearance.is_finite()),
                "nearest": nearest.as_ref().map(place),
            }),
            BetweenFinding::TooNear { first, nearest } => {
                json!({ "verdict": "collision", "first": place(first), "nearest": place(nearest) })
            }
            BetweenFinding::Undecided => json!({ "verdict": "undecided" }),
        };
        let arms = self.cell.arms.iter().zip(&self.findings);
        let arms: Vec<Value> = arms.map(|(arm, findings)| json!({ "name": arm.name, "findings": findings })).collect();
        json!({
            "verdict": self.verdict().word(),
            "skew": self.skew,
            "required": self.required(),
            "between": between,
            "faults": self.step_faults.iter().chain(&self.faults).collect::<Vec<_>>(),
            "arms": arms,
        })
    }

    fn required(&self) -> f64 {
        self.cell.arms[0].problem.scene().workspace().clearance
    }

    fn summary(&self) -> String {
        let mut lines = vec![("result", self.result())];
        lines.extend(self.between());
        lines.extend(self.step_faults.iter().map(|fault| ("task", fault.clone())));
        lines.extend(self.faults.iter().map(|fault| ("fault", fault.clone())));
        let mut summary = format!("{}\n{}", self.cell.name, format_columns(&lines));
        for (arm, (recorded, findings)) in self.cell.arms.iter().zip(self.recorded.iter().zip(&self.findings)) {
            let own = text::summary(arm.problem.scene().arm(), &recorded.recording, findings);
            summary += &format!("\n{}\n{own}", arm.name);
        }
        summary
    }

    fn result(&self) -> String {
        let required = self.required();
        let kept = if required > 0.0 { format!(" by {}", chosen_length(required)) } else { String::new() };
        let names = self.cell.arms.each_ref().map(|arm| arm.name.as_str());
        let wrong: Vec<&str> = names
            .iter()
            .zip(&self.findings)
            .filter(|(_, findings)| findings.verdict != Judgement::Free)
            .map(|(name, _)| *name)
            .collect();
        let of_arms = || format!("the motion of {} is not accepted; see below", wrong.join(" and that of "));
        match (&self.between, self.verdict()) {
            (_, Judgement::Free) => {
                let what = if self.cell.has_steps() { "all steps" } else { "both whole motions" };
                format!("free{kept}: {what}, among the obstacles and between the arms, proven")
            }
            (BetweenFinding::TooNear { nearest, .. }, _) if nearest.distance <= 0.0 => {
                "collision of the arms: proven".into()
            }
            (BetweenFinding::TooNear { nearest, .. }, _) => {
                let [least, required] = [nearest.distance, required].map(length);
                format!("the arms are too near to each other, {least} instead of the required {required}: proven")
            }
            (_, Judgement::Task) if wrong.is_empty() => "not the steps of the cell".into(),
            (_, Judgement::Undecided) if wrong.is_empty() => "undecided between the arms".into(),
            (_, Judgement::Claims) if wrong.is_empty() => "free, but values stated in the file are wrong".into(),
            _ => of_arms(),
        }
    }

    /// Returns the lines about the arms between each other.
    fn between(&self) -> Vec<Line> {
        let clocks = match self.skew > 0.0 {
            true => format!(", for clocks that differ by up to {} s", self.skew),
            false => String::new(),
        };
        let at = |place: &NearPlace| {
            let [x, y] = place.point;
            let of = |arm: usize| {
                let own = self.cell.arms[arm].problem.scene().arm();
                format!("{}: {}", self.cell.arms[arm].name, configuration(own, place.at[arm]))
            };
            let depth = match place.distance {
                distance if distance > 0.0 => format!("{} apart", length(distance)),
                distance => format!("{} deep", length(-distance)),
            };
            format!("{} {}, {depth}, near ({x:.3}, {y:.3}) m; {}; {}", place.links, when(place.times), of(0), of(1))
        };
        match &self.between {
            BetweenFinding::Free { clearance, .. } if clearance.is_infinite() => {
                vec![("between", "no links can meet".into())]
            }
            BetweenFinding::Free { clearance, nearest } => {
                let seen = nearest.as_ref().map(|nearest| format!("; least seen: {}", at(nearest))).unwrap_or_default();
                vec![("between", format!("at least {}{clocks}{seen}", length_down(*clearance)))]
            }
            BetweenFinding::TooNear { first, nearest } => {
                vec![("too near", format!("first {}", at(first))), ("", format!("most {}", at(nearest)))]
            }
            BetweenFinding::Undecided => vec![("undecided", format!("whether the arms keep apart{clocks}"))],
        }
    }
}
