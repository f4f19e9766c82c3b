//! Checks that an object presses into its support no deeper than allowed, even with its corners.

use super::{options, task};
use cplan::engine::task::plan;
use cplan_testkit::replay;

/// Checks a former defect. With a clearance of 1 cm, a pentagon is picked beside the disc that supports it. Shrinking
/// the pentagon by the clearance and growing it again used to round off its corners. So one corner was carried through
/// the disc's rim, 0.46 mm deep.
#[test]
fn a_corner_is_carried_through_no_support() {
    let task = task::task(134_591_390_155_048);
    let answer = plan(&task, &options(), &mut |_| {});
    replay::replay(&task, &answer, answer.failed().is_none()).unwrap();
}
