//! The data that templates get.

use crate::joint_value::{JointValue, MARK};
use crate::moves::{Move, MoveKind, ProgramStep};
use crate::program::Program;
use crate::signals::signals_of;
use cplan_text::{plain_line, round_down, short};
use minijinja::context;
use minijinja::value::Value;

/// Unit to which angles of motors are rounded, degrees.
const MOTOR_UNIT: f64 = 1e-4;

/// Returns a name as one line without the characters of marks, so that it can stand in a comment.
fn clean(name: &str) -> String {
    plain_line(name).replace(MARK, "?")
}

impl Program {
    /// Returns all data of the program.
    pub(crate) fn data(&self) -> Value {
        let steps: Vec<Value> = self.steps.iter().map(step).collect();
        let mut last_step = usize::MAX;
        let moves = self.moves.iter().enumerate().map(|(target, one)| {
            let is_first = std::mem::replace(&mut last_step, one.step) != one.step;
            self.target(target, one, &steps[one.step], is_first)
        });
        let moves = Value::from(moves.collect::<Vec<_>>());
        let joints = self.joints.iter().map(|joint| {
            let unit = if joint.slides { "mm" } else { "deg" };
            context! { name => clean(&joint.name), unit, moves => !joint.is_held() }
        });
        context! { head => self.head(), joints => Value::from(joints.collect::<Vec<_>>()), moves, steps }
    }

    fn head(&self) -> Value {
        let mut statement = vec![
            "The arm must stand at the first target when the program begins.".to_owned(),
            format!("The path is {}.", self.guarantee()),
            "The controller chooses speeds and times; these are not certified.".to_owned(),
        ];
        if let Some(other) = &self.interlocked_with {
            let other = clean(other);
            statement.push(format!(
                "With the signals, the arm keeps apart from {other}, whichever program is late. \
                 All signals must be off before either program begins."
            ));
        }
        if self.needs_wrist {
            statement.push(
                "The program does not turn the wrist. The controller must keep the orientation of objects.".to_owned(),
            );
        }
        let files =
            self.digests.iter().map(|[name, digest]| context! { name => clean(name), sha256 => digest.as_str() });
        context! {
            robot => clean(&self.robot),
            world => clean(&self.world),
            targets => self.moves.len(),
            length => short(self.length),
            clearance => round_down(1e3 * self.clearance, 3),
            tolerance => self.tolerance.to_string(),
            statement,
            has_signals => self.interlocked_with.is_some(),
            files => Value::from(files.collect::<Vec<_>>()),
            version => env!("CARGO_PKG_VERSION"),
        }
    }

    fn target(&self, target: usize, one: &Move, step: &Value, is_first: bool) -> Value {
        let values = self.joints.iter().zip(&one.values).enumerate();
        let values = values.map(|(index, (joint, value))| JointValue::new(target, index, joint, *value));
        let joints: Vec<Value> = values.map(Value::from_object).collect();
        let names = self.joints.iter().map(|joint| joint.name.as_str());
        let in_degrees = |angle: f64| (angle.to_degrees() / MOTOR_UNIT).round() * MOTOR_UNIT;
        let motors = self.motors.map(|motors| motors.angles(one.drives.planned.into()).map(in_degrees));
        let kind = match one.kind {
            MoveKind::Start => "start",
            MoveKind::Travel => "travel",
            MoveKind::Turn => "turn",
            MoveKind::Lower => "lower",
            MoveKind::Raise => "raise",
        };
        context! {
            number => target + 1,
            kind,
            step => step.clone(),
            begins_step => is_first,
            joint => Value::from_pairs(names.zip(joints.iter().cloned())),
            joints,
            motors => motors.map(|angles| Value::from(angles.to_vec())),
            speed => self.steps[one.step].speed,
            grip => one.grip,
            dwell => one.dwell,
            signals => signals_of(target, one),
            quill => short(1e3 * one.drives.stroke),
        }
    }
}

fn step(step: &ProgramStep) -> Value {
    let ProgramStep { number, cycle, action, text, object, carried, speed } = step;
    context! {
        number => *number,
        cycle => *cycle,
        action => *action,
        text => clean(text),
        object => object.as_deref().map(clean),
        carried => carried.as_deref().map(clean),
        speed => *speed,
    }
}

/// Returns a name as an identifier of programming languages: letters, digits and underscores, at most 32 characters.
pub(crate) fn identifier(name: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric();
    let name: String = name.chars().take(30).map(|c| if is_plain(c) { c } else { '_' }).collect();
    if name.starts_with(|c: char| c.is_ascii_alphabetic()) { name } else { format!("p_{name}") }
}
