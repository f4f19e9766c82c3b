//! Links of the robot to which evidence refers as parts.

use super::{Evident, PART_HINT};
use crate::arm::Arm;
use crate::certificate::PartName;
use crate::error::{CheckError, Input};
use crate::shapes::{Outline, named};

/// Finds the shape, or the layer of a shape, of a link that is an obstacle for other links.
///
/// # Errors
/// If the name is incomplete, or if no shape that is checked for collisions has this name.
pub fn part(arm: &Arm, name: &PartName) -> Result<Evident, CheckError> {
    let (link, kind, number) = match (&name.own, name.collision, name.visual, &name.corners) {
        (Some(link), Some(number), None, None) => (link, "collision", number),
        (Some(link), None, Some(number), None) => (link, "visual", number),
        _ => return Err(CheckError::in_file(Input::Certificate, PART_HINT)),
    };
    let own = named(&arm.bases, (link, kind, number), name.height.as_ref())?;
    let within = &own.within;
    Ok((Some(own.owner()), within.shape.clone(), within.inset_heights(Outline::Within)))
}
