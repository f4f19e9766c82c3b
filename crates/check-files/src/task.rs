//! Checks certificates with the answer "found" and with steps: a motion executes a task.

mod lines;
mod order;
mod replay;
mod stroke;

use crate::robot::Robot;
use crate::world::WorldFile;
use cplan_check::certificate::{Certificate, ExecutedStep};
use cplan_check::decimal::Decimal;
use cplan_check::ends::{End, missed};
use cplan_check::motion::check_knots;
use cplan_check::{CheckError, Input};
use num_bigint::Sign;
use order::{Order, rest_durations};
use replay::Replay;

/// Number of decimals of the tolerance of rests: the arm may rest for `10^-6` s less than required.
const REST_TOLERANCE_DECIMALS: u32 = 6;

/// Checks that a motion executes all steps of a task.
pub fn check_motion(
    robot: &Robot,
    file: &WorldFile,
    certificate: &Certificate,
    done: &[ExecutedStep],
) -> Result<String, CheckError> {
    let (arm, world) = (&robot.arm, &file.world);
    let clearance = certificate.clearance(world)?;
    let wrong = |input: Input, message: &str| Err(CheckError::in_file(input, message));
    let Some(task) = &file.task else { return wrong(Input::World, "it has no steps") };
    if certificate.goal.is_some() || certificate.goal_tip.is_some() || certificate.bound.is_some() {
        return wrong(Input::Certificate, "a task's certificate cannot have a goal or a bound");
    }
    let Some(motion) = &certificate.motion else { return wrong(Input::Certificate, "it has no motion") };
    check_knots(&motion.interpolation, &motion.knots)?;
    let start = End::start(certificate, world)?.reached(arm, &motion.knots[0])?;
    let mut order = Order { left: done.iter().enumerate().peekable(), renewed: Vec::new(), matched: Vec::new() };
    order.group(&task.steps)?;
    if let Some((index, done)) = order.left.next() {
        return CheckError::fails(format!("steps[{index}] is step {}, but the world has no further steps", done.step));
    }
    let steps = order.matched;
    let stands = rest_durations(motion, &steps)?;
    let mut replay = Replay::new(robot, world, task, motion, clearance)?;
    for (index, step) in steps.iter().enumerate() {
        let number = step.step.number;
        if motion.knots[step.done.knots[1]].iter().skip(3).take(2).any(|rate| rate.sign() != Sign::NoSign) {
            return CheckError::fails(format!(
                "steps[{index}], step {number}: the arm still moves at the end of the step"
            ));
        }
        replay.step(step, &steps[index + 1..]).map_err(|error| match error {
            CheckError::Fails(why) => CheckError::Fails(format!("steps[{index}], step {number}: {why}")),
            other => other,
        })?;
        if &stands[index] + &Decimal::power_of_ten(REST_TOLERANCE_DECIMALS) < step.step.dwell {
            let dwell = &step.step.dwell;
            return CheckError::fails(format!(
                "after steps[{index}], step {number}, the arm does not rest for {dwell} s"
            ));
        }
    }
    let [first, second] = arm.joints.each_ref().map(|joint| &joint.name);
    let within = missed("target", &replay.off)?;
    let count = if steps.len() == 1 { "the step".to_owned() } else { format!("all {} steps", steps.len()) };
    Ok(format!(
        "a motion of \"{first}\" and \"{second}\" does {count} from the start{start} on{within} with clearance {clearance} ({}){}",
        motion.in_words(),
        lines::in_words(&steps)?
    ))
}
