//! A gantry that lowers its tool, and hand-made certificates of its tasks.

use super::verdict::{Verdict, done, judge};

/// URDF of a gantry with the tip at the joints' values. Its quill has a ball at height 0.5, and greater values of its
/// joint are lower. All other shapes are above it.
pub const GANTRY: &str = r#"<robot name="g">
  <link name="base"/>
  <joint name="x" type="prismatic">
    <parent link="base"/> <child link="bridge"/> <axis xyz="1 0 0"/> <limit lower="-9" upper="9"/>
  </joint>
  <link name="bridge"/>
  <joint name="y" type="prismatic">
    <parent link="bridge"/> <child link="head"/> <axis xyz="0 1 0"/> <limit lower="-9" upper="9"/>
  </joint>
  <link name="head"> <collision> <origin xyz="0 0 1"/> <geometry> <box size="0.1 0.1 0.1"/> </geometry> </collision> </link>
  <joint name="z" type="prismatic">
    <parent link="head"/> <child link="quill"/> <origin xyz="0 0 0.5"/> <axis xyz="0 0 -1"/> <limit lower="0" upper="1"/>
  </joint>
  <link name="quill"> <collision> <geometry> <sphere radius="0.01"/> </geometry> </collision> </link>
</robot>"#;

/// The arm picks the block at 1 s, departs at 2 s, places the block at 3 s, departs at 4 s, and stops at 5 s.
pub const KNOTS: &str = "[0, 0, 1], [1, 1, 1], [2, 1, 1], [3, 3, 1], [4, 3, 1], [5, 5, 1]";

/// Checks a certificate with these knots and steps.
pub fn judge_steps(urdf: &str, world: &str, knots: &str, steps: &str) -> Verdict {
    judge(urdf, world, &done(knots, steps))
}
