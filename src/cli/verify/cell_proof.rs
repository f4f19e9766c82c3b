//! `cplan verify` for an answer of `cplan cell` that no motions of both arms exist.

use super::VerifyArgs;
use crate::cli::exit::INFEASIBLE;
use crate::cli::failure::Failure;
use crate::cli::sinks;
use crate::input::Source;
use crate::output::format_columns;
use crate::text::{chosen_length, counted};
use cplan_cell::{Cell, Proof};
use serde::Deserialize;
use serde_json::{Value, json};

/// Judges the proof in the file, if the file is an infeasible answer. Otherwise returns `None`.
///
/// # Errors
/// I/O, a file without a proof, a proof that does not hold, and options that do not apply to proofs.
pub fn run(args: &VerifyArgs, cell: &Cell) -> Result<Option<u8>, Failure> {
    if args.trajectory.is_some() {
        return Ok(None);
    }
    let source = Source::read_recording(&args.files.world)?;
    let Ok(mut answer) = serde_json::from_str::<Value>(source.text()) else { return Ok(None) };
    if answer["status"] != "infeasible" {
        return Ok(None);
    }
    refuse_other_options(args)?;
    let fail = |message: String, hint: &str| Failure::Input(source.diagnostic(message).help(hint).into());
    if cell.has_steps() {
        let message = "the arms of the cell have steps, but `cplan verify` judges only proofs about arms without steps";
        return Err(fail(message.into(), "`cplan cell` plans the cell again, with the same answer"));
    }
    let proof = Proof::deserialize(answer["proof"].take());
    let proof = proof.map_err(|error| {
        fail(format!("has no proof: {error}"), "write the answer with `cplan cell CELL --output cell.json`")
    })?;
    let required = cell.arms[0].problem.scene().workspace().clearance;
    if let Some(stated) = answer["clearance"].as_f64().filter(|stated| *stated > required) {
        let [own, other] = [stated, required].map(chosen_length);
        let message = format!("the proof is for a clearance of {own}, but the cell requires {other}");
        return Err(fail(message, &format!("add --clearance {stated}")));
    }
    proof.check(cell).map_err(|why| {
        let hint = "the file is for another cell, or was changed; `cplan cell CELL --output cell.json` writes a proof";
        fail(format!("the proof does not hold: {why}"), hint)
    })?;
    let statement = statement(&proof, cell);
    let report = || sinks::pretty(&json!({ "verdict": "infeasible", "proof": statement }));
    let lines = [("result", "infeasible: proven".to_owned()), ("proof", statement.clone())];
    args.print.report(INFEASIBLE, report, || format!("{}\n{}", cell.name, format_columns(&lines)))?;
    Ok(Some(INFEASIBLE))
}

/// Refuses options about motions.
fn refuse_other_options(args: &VerifyArgs) -> Result<(), Failure> {
    let settings = &args.settings;
    let given = [("--skew", args.skew.is_some()), ("--anywhere", settings.anywhere), ("--unwrap", settings.unwrap)];
    match given.iter().find(|(_, is_given)| *is_given) {
        Some((option, _)) => Err(Failure::Usage(format!("{option} does not apply to the proof of a cell"))),
        None => Ok(()),
    }
}

/// Returns the proven statement.
fn statement(proof: &Proof, cell: &Cell) -> String {
    let of = |count: usize| format!("{} of colliding configurations", counted(count, "box"));
    match proof {
        Proof::Alone { arm, boxes } => {
            format!("{} separate the start of {arm} from every goal, even without the other arm", of(boxes.len()))
        }
        Proof::Starts { .. } => {
            let [one, two] = cell.arms.each_ref().map(|arm| &arm.name);
            format!("{one} and {two} collide at their starts")
        }
        Proof::Goals { pairs, .. } => match pairs.len() {
            1 => "the arms collide at their goals".into(),
            count => format!("the arms collide at all {count} pairs of goals"),
        },
        Proof::Boxes(proof) => {
            format!("{} in the space of all four joints separate the starts from the goals", of(proof.boxes.len()))
        }
    }
}
