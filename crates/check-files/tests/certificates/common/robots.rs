//! Robots of two joints.

/// Returns the URDF of two bars of 1 m and 0.8 m, 0.1 m wide, at one height. The tip is at the end of the second bar.
/// Turning joints turn about z, sliding ones slide along x and y.
pub fn bars(first: &str, second: &str) -> String {
    format!(
        r#"<robot name="r">
  <link name="base"/>
  <joint name="a" type="{first}">
    <parent link="base"/> <child link="upper"/> <axis xyz="{}"/> <limit lower="-2.9" upper="2.9"/>
  </joint>
  <link name="upper">
    <collision> <origin xyz="0.5 0 0"/> <geometry> <box size="1.0 0.1 0.1"/> </geometry> </collision>
  </link>
  <joint name="b" type="{second}">
    <parent link="upper"/> <child link="fore"/> <origin xyz="1 0 0"/> <axis xyz="{}"/> <limit lower="-2.9" upper="2.9"/>
  </joint>
  <link name="fore">
    <collision> <origin xyz="0.4 0 0"/> <geometry> <box size="0.8 0.1 0.1"/> </geometry> </collision>
  </link>
  <joint name="t" type="fixed"> <parent link="fore"/> <child link="tool"/> <origin xyz="0.8 0 0"/> </joint>
  <link name="tool"/>
</robot>"#,
        if first == "prismatic" { "1 0 0" } else { "0 0 1" },
        if second == "prismatic" { "0 1 0" } else { "0 0 1" },
    )
}

/// Returns the URDF of [`bars`] that turn.
pub fn two_bars() -> String {
    bars("revolute", "revolute")
}

/// Limit of both joints of [`bars`] in either direction.
pub const LIMIT: f64 = 2.9;

/// Returns the URDF of a gantry with the tip at the joints' values, and one shape at the tip.
pub fn gantry([lower, upper]: [i32; 2], shape: &str) -> String {
    format!(
        r#"<robot name="g">
  <link name="base"/>
  <joint name="x" type="prismatic">
    <parent link="base"/> <child link="bridge"/> <axis xyz="1 0 0"/> <limit lower="{lower}" upper="{upper}"/>
  </joint>
  <link name="bridge"/>
  <joint name="y" type="prismatic">
    <parent link="bridge"/> <child link="head"/> <axis xyz="0 1 0"/> <limit lower="{lower}" upper="{upper}"/>
  </joint>
  <link name="head"> <collision> <geometry> <{shape}/> </geometry> </collision> </link>
</robot>"#
    )
}
