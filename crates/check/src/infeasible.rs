//! Checks certificates with the answer "infeasible": there is no motion.

use crate::arm::Arm;
use crate::certificate::{Certificate, rectangles};
use crate::contacts::Contacts;
use crate::domain::Rectangle;
use crate::ends::{End, MAX_ENCLOSED_PARTS};
use crate::error::CheckError;
use crate::sweep::Reached;
use crate::world::World;

/// Checks that collision boxes separate the start from the goal, so that no motion connects them.
pub fn infeasible(arm: &Arm, world: &World, certificate: &Certificate) -> Result<String, CheckError> {
    let (start, goal) = (End::start(certificate, world)?, End::goal(certificate, world)?);
    let clearance = certificate.clearance(world)?;
    let stuck = certificate.boxes.as_deref().unwrap_or_default();
    let boxes = rectangles(stuck)?;
    let beyond = arm.sum.iter().flat_map(|sum| sum.outside(&arm.domain, &boxes));
    let closed: Vec<Rectangle> = boxes.iter().cloned().chain(beyond).collect();
    let Some(reached) = Reached::new(&arm.domain, &closed, &start.configuration(arm)?) else {
        return CheckError::fails("there are too many gaps between the boxes for the checker");
    };
    if !goal.places(arm, MAX_ENCLOSED_PARTS, |part| !reached.meets(part))?.is_empty() {
        return CheckError::fails("the boxes do not separate the goal from the start");
    }
    Contacts::new(arm, world, certificate, clearance)?.check_boxes(arm, stuck, &boxes)?;
    let [first, second] = arm.joints.each_ref().map(|joint| &joint.name);
    let [start, goal] = [start, goal].map(|end| end.named(arm));
    Ok(format!(
        "no motion of \"{first}\" and \"{second}\" leads from the start{start} to the goal{goal} with clearance {clearance}"
    ))
}
