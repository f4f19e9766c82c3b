//! Plans a task of picks and places, and prints its events with their times.
//!
//! ```text
//! cargo run --release --example pick_and_place -- robots/scara.urdf workspaces/tasks/table_mission.toml
//! ```

use cplan::Outcome;
use cplan::engine::task::Event;
use cplan::{Options, Problem, plan};
use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1).map(PathBuf::from);
    let urdf = args.next().unwrap_or_else(|| "robots/scara.urdf".into());
    let world = args.next().unwrap_or_else(|| "workspaces/tasks/table_mission.toml".into());
    let problem = Problem::load(urdf, world)?;

    // The planner chooses IK solutions, grips and turns of the wrist together, for the least total time.
    let plan = plan(&problem, &Options::default())?;
    let (task, answer) = plan.task().ok_or("the world has no steps")?;

    // For an infeasible task, these are the steps before the one that fails.
    for leg in &answer.legs {
        let step = &leg.step;
        let (number, what) = (step.number, step.action.describe(&task.objects));
        println!("{:7.3} s to {:7.3} s  step {number}, {what}; {:.4} m free", leg.begin, leg.end(), leg.clearance());
        let object = |object: usize| &task.objects[object].name;
        match leg.event.zip(leg.event_time()) {
            Some((Event::Grasp { object: k }, time)) => println!("{time:7.3} s             \"{}\" is taken", object(k)),
            Some((Event::Release { object: k, pose }, time)) => {
                let at = pose.translation;
                println!("{time:7.3} s             \"{}\" is left at ({:.3}, {:.3}) m", object(k), at.x, at.y);
            }
            None => {}
        }
    }
    match &answer.outcome {
        Outcome::Found(_) => {
            // All motions as one trajectory. The arm stands still between steps.
            if let Some(trajectory) = plan.trajectory() {
                println!("{} samples, {:.3} s in all", trajectory.time.len(), trajectory.duration());
            }
            println!("no sequence of motions takes less than {:.3} s: proven", answer.lower_bound);
        }
        Outcome::Infeasible(why) => println!("step {} cannot be done: {:?}", why.step.number, why.reasons),
        Outcome::Unknown(why) => println!("step {}: unknown whether it can be done", why.step.number),
    }
    Ok(())
}
