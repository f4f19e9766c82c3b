//! The times at which a moving object may be picked: the keys `at` and `window` of a pick.

use super::group::When;
use super::reader::Reader;
use cplan_handling::{MAX_STOP_TIME, Object};
use cplan_robot::{Diagnostic, Lengths, Numbers, Spanned};
use std::ops::Range;

/// A position within this distance of an axis counts as on the axis, in metres. People write positions with this precision.
const ON_AXIS_DISTANCE: f64 = 1e-3;

/// The keys of a pick about its time.
pub(super) struct PickTimes<'a> {
    /// Position of the object's origin at the pick.
    pub at: Option<&'a Lengths>,
    /// The earliest and the latest time of the pick.
    pub window: Option<&'a Numbers>,
}

impl PickTimes<'_> {
    /// Returns the times at which the object may be picked; `None` if the step leaves them open.
    ///
    /// # Errors
    /// An object that does not move, a point that it does not pass, and an invalid or missed window.
    pub fn read(&self, reader: &Reader, object: &Object) -> Result<Option<When>, Diagnostic> {
        let Some(stated) = self.at.map(Spanned::span).or(self.window.map(Spanned::span)) else {
            return Ok(None);
        };
        let name = &object.name;
        let refuse =
            |at: Range<usize>, message: String, help: &str| Err(reader.source.diagnostic_at(at, message).help(help));
        let Some(trajectory) = &object.trajectory else {
            let message = format!("object \"{name}\" does not move, so its pick cannot have `at` or `window`");
            return refuse(stated, message, "remove `at` and `window`, or give the object a motion");
        };
        let mut times = vec![[0.0, MAX_STOP_TIME]];
        if let Some(at) = self.at {
            times = trajectory.passes(reader.point(at, "pick, at")?, ON_AXIS_DISTANCE);
            times.iter_mut().flatten().for_each(|time| *time = time.min(MAX_STOP_TIME));
            if times.is_empty() {
                let message = format!("object \"{name}\" does not pass this point");
                return refuse(
                    at.span(),
                    message,
                    "choose a point within a millimetre of the path of the object's origin",
                );
            }
        }
        if let Some(window) = self.window {
            let [from, to] = reader.number_pair(window, "window")?;
            if !(0.0 <= from && from <= to) {
                let message = format!("window [{from}, {to}] is invalid");
                return refuse(
                    window.span(),
                    message,
                    "write two times in seconds since the task's beginning, the earlier one first, both 0 or more",
                );
            }
            let passed = times.clone();
            times.iter_mut().for_each(|[begins, ends]| (*begins, *ends) = (begins.max(from), ends.min(to)));
            times.retain(|[begins, ends]| begins <= ends);
            if times.is_empty() {
                let passes: Vec<String> = passed.iter().map(|[time, _]| format!("{time:.3} s")).collect();
                let message =
                    format!("object \"{name}\" is at this place at {}, outside the window", passes.join(", "));
                return refuse(window.span(), message, "choose another window, or another place");
            }
        }
        Ok(Some(When { times, at: stated }))
    }
}
