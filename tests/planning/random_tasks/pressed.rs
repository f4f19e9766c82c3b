//! What rests on something presses into it no deeper than is promised, also with its corners.

use super::{options, replay, task};
use cplan::engine::task::plan;

/// A clearance of 1 cm, and a pentagon that is picked beside the disc that supports it: made smaller by the clearance and grown
/// again its corners were rounded off, and so one of them was carried through the disc's rim, 0.46 mm deep.
#[test]
fn a_corner_is_carried_through_no_support() {
    let task = task::task(134_591_390_155_048);
    let answer = plan(&task, &options(), &mut |_| {});
    replay::replay(&task, &answer, answer.failed().is_none()).unwrap();
}
