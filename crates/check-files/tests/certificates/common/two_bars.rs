//! An arm for tests.

/// URDF of two bars of 1 m and 0.8 m, 0.1 m wide, at one height. The tip is at the end of the second bar.
pub const TWO_BARS: &str = r#"<robot name="r">
  <link name="base"/>
  <joint name="a" type="revolute">
    <parent link="base"/> <child link="upper"/> <axis xyz="0 0 1"/> <limit lower="-2.9" upper="2.9"/>
  </joint>
  <link name="upper">
    <collision> <origin xyz="0.5 0 0"/> <geometry> <box size="1.0 0.1 0.1"/> </geometry> </collision>
  </link>
  <joint name="b" type="revolute">
    <parent link="upper"/> <child link="fore"/> <origin xyz="1 0 0"/> <axis xyz="0 0 1"/> <limit lower="-2.9" upper="2.9"/>
  </joint>
  <link name="fore">
    <collision> <origin xyz="0.4 0 0"/> <geometry> <box size="0.8 0.1 0.1"/> </geometry> </collision>
  </link>
  <joint name="t" type="fixed"> <parent link="fore"/> <child link="tool"/> <origin xyz="0.8 0 0"/> </joint>
  <link name="tool"/>
</robot>"#;

/// Limit of both joints in either direction, radians.
pub const LIMIT: f64 = 2.9;
