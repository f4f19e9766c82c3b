//! Reads the targets back from the text that a template has written.

use crate::joint_value::{MARK, value_of};
use crate::program::Program;
use crate::signals::{SignalUse, is_signal, signal_mark};

/// The text of a program, and the targets that its digits state.
#[derive(Debug, Clone)]
pub struct Written {
    /// The text.
    pub text: String,
    /// Values of all joints at each target, radians or metres. Joints that the plan holds and the text omits have the plan's
    /// values.
    pub targets: Vec<Vec<f64>>,
}

/// A number in the text, with the joint and the target to which it belongs.
struct Number<'a> {
    target: usize,
    joint: usize,
    digits: &'a str,
    value: f64,
}

impl<'a> Number<'a> {
    /// Reads the text between two marks. `None` if the template has changed it.
    fn read(mark: &str, digits: &'a str) -> Option<Self> {
        let mut parts = mark.split(',');
        let (target, joint) = (parts.next()?.parse().ok()?, parts.next()?.parse().ok()?);
        let (zero, scale) = (parts.next()?.parse().ok()?, parts.next()?.parse().ok()?);
        let value = value_of(digits.trim().parse().ok()?, zero, scale);
        value.is_finite().then_some(Self { target, joint, digits, value })
    }
}

impl Written {
    /// Removes the marks from a text, and reads the targets.
    ///
    /// # Errors
    /// The reason, for people, if the text does not have each joint of each target once, with the targets in order.
    pub(crate) fn read(program: &Program, rendered: &str) -> Result<Self, String> {
        let [open, middle, close] = MARK;
        let (mut text, mut targets) = (String::with_capacity(rendered.len()), Vec::new());
        let mut target: Vec<Option<f64>> = vec![None; program.joints.len()];
        // Number of the target's signals that are written.
        let mut signals = 0;
        let mut parts = rendered.split(open);
        text.push_str(parts.next().unwrap_or_default());
        for part in parts {
            let marked = part.split_once(close).and_then(|(number, rest)| Some((number.split_once(middle)?, rest)));
            let Some(((mark, digits), rest)) = marked else {
                return Err("the template writes only a part of a joint value".into());
            };
            if is_signal(mark) {
                complete(program, targets.len(), &target)?;
                let next = signal(program, targets.len(), signals);
                if next.map(|next| signal_mark(targets.len(), next)).as_deref() != Some(mark) {
                    let place = program.describe(targets.len());
                    return Err(format!("the template writes signal {digits} in the wrong place: after {place}"));
                }
                signals += 1;
                text.push_str(digits);
                text.push_str(rest);
                continue;
            }
            let number = Number::read(mark, digits).filter(|number| number.joint < target.len());
            let Some(number) = number else {
                return Err(format!("the template changes the digits of a joint value: {digits:?} is not a number"));
            };
            if number.target == targets.len() + 1 {
                check_signals(program, targets.len(), signals)?;
                targets.push(complete(program, targets.len(), &target)?);
                (signals, target) = (0, vec![None; target.len()]);
            }
            let expected = program.describe(targets.len());
            if number.target != targets.len() {
                return Err(format!(
                    "the template writes target {} too early: {expected} must come first",
                    number.target + 1
                ));
            }
            if target[number.joint].replace(number.value).is_some() {
                let name = &program.joints[number.joint].name;
                return Err(format!("the template writes joint \"{name}\" of {expected} twice"));
            }
            let joins = |c: char, letters: &str| c.is_ascii_digit() || letters.contains(c);
            if text.ends_with(|c| joins(c, "+-.")) || rest.starts_with(|c| joins(c, ".eE")) {
                return Err(format!(
                    "the template puts a digit, sign, point or exponent directly beside a joint value of {expected}"
                ));
            }
            text.push_str(number.digits);
            text.push_str(rest);
        }
        check_signals(program, targets.len(), signals)?;
        targets.push(complete(program, targets.len(), &target)?);
        if targets.len() < program.moves.len() {
            return Err(format!("the template does not write {}", program.describe(targets.len())));
        }
        if text.contains(MARK) {
            return Err("the template contains the private-use characters U+E000 to U+E002; remove them".into());
        }
        Ok(Self { text, targets })
    }
}

fn signal(program: &Program, target: usize, number: usize) -> Option<(usize, SignalUse)> {
    program.moves.get(target)?.signals.get(number).copied()
}

/// Checks that the text has all signals of a target.
fn check_signals(program: &Program, target: usize, written: usize) -> Result<(), String> {
    match signal(program, target, written) {
        Some((number, _)) => {
            Err(format!("the template does not write signal {number} after {}", program.describe(target)))
        }
        None => Ok(()),
    }
}

/// Returns the values of all joints at a target.
fn complete(program: &Program, target: usize, written: &[Option<f64>]) -> Result<Vec<f64>, String> {
    let value = |(index, written): (usize, &Option<f64>)| match written {
        Some(value) => Ok(*value),
        None if program.joints[index].is_held() => Ok(program.moves[target].values[index]),
        None => {
            let name = &program.joints[index].name;
            Err(format!("the template does not write joint \"{name}\" of {}", program.describe(target)))
        }
    };
    written.iter().enumerate().map(value).collect()
}
