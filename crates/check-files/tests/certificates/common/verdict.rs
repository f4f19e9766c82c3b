//! Verdicts of the checker: the exit codes of `cplan-check`, with the messages.

use cplan_check_files::{CheckError, check};

pub type Verdict = (i32, String);

pub fn verdict(judged: Result<String, CheckError>) -> Verdict {
    match judged {
        Ok(report) => (0, report),
        Err(CheckError::Fails(why)) => (3, why),
        Err(CheckError::Input { message, .. }) => (1, message),
    }
}

pub fn judge(urdf: &str, world: &str, certificate: &str) -> Verdict {
    verdict(check(urdf, world, certificate))
}

pub fn code(urdf: &str, world: &str, certificate: &str) -> i32 {
    judge(urdf, world, certificate).0
}

/// Returns a certificate of a motion with further members, whose knots are joined as `reading` says.
pub fn found(members: &str, reading: &str, knots: &str) -> String {
    format!(
        r#"{{"format": "cplan certificate 1", "answer": "found", {members}
        "motion": {{"interpolation": [{reading}], "knots": [{knots}]}}}}"#
    )
}

/// Returns a certificate of a task's steps, with straight motions.
pub fn done(knots: &str, steps: &str) -> String {
    found(&format!(r#""steps": [{steps}],"#), r#""linear""#, knots)
}

/// Asserts that a certificate holds, and returns the message.
#[track_caller]
pub fn holds((code, report): Verdict) -> String {
    assert_eq!(code, 0, "{report}");
    report
}

#[track_caller]
fn ends((code, report): Verdict, expected: i32, parts: &[&str]) {
    assert!(code == expected && parts.iter().all(|part| report.contains(part)), "{code} {report}, not {parts:?}");
}

/// Asserts that a certificate fails, with a message that has this part.
#[track_caller]
pub fn fails(verdict: Verdict, part: &str) {
    ends(verdict, 3, &[part]);
}

/// Asserts that a certificate fails, with a message that has all of these parts.
#[track_caller]
pub fn fails_with(verdict: Verdict, parts: &[&str]) {
    ends(verdict, 3, parts);
}

/// Asserts that the input is refused, with a message that has this part.
#[track_caller]
pub fn refused(verdict: Verdict, part: &str) {
    ends(verdict, 1, &[part]);
}

/// Asserts that a certificate holds, or fails with a message that has this part.
#[track_caller]
pub fn agrees(verdict: Verdict, is_free: bool, part: &str) {
    if is_free { drop(holds(verdict)) } else { fails(verdict, part) }
}
