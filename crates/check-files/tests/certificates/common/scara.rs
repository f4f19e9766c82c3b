//! A SCARA that can fold its quill into its base.

use super::verdict::found;

/// Returns the URDF of a SCARA. The base is 0.4 m by 0.3 m and 0.3 m high, and stands at height 0. The quill reaches
/// down to the height `lowest`.
pub fn scara(lowest: f64) -> String {
    format!(
        r#"<robot name="scara">
  <link name="base"> <collision> <origin xyz="0 0 0.15"/> <geometry> <box size="0.4 0.3 0.3"/> </geometry> </collision> </link>
  <joint name="a" type="revolute">
    <parent link="base"/> <child link="upper"/> <origin xyz="0 0 0.35"/> <axis xyz="0 0 1"/> <limit lower="-2.9" upper="2.9"/>
  </joint>
  <link name="upper"> <collision> <origin xyz="0.25 0 0"/> <geometry> <box size="0.6 0.1 0.2"/> </geometry> </collision> </link>
  <joint name="b" type="revolute">
    <parent link="upper"/> <child link="fore"/> <origin xyz="0.5 0 0.1"/> <axis xyz="0 0 1"/> <limit lower="-2.9" upper="2.9"/>
  </joint>
  <link name="fore"> <collision> <origin xyz="0.2 0 0.05"/> <geometry> <box size="0.5 0.1 0.1"/> </geometry> </collision> </link>
  <joint name="t" type="fixed"> <parent link="fore"/> <child link="quill"/> <origin xyz="0.45 0 -0.45"/> </joint>
  <link name="quill">
    <collision> <origin xyz="0 0 {}"/> <geometry> <cylinder radius="0.02" length="{}"/> </geometry> </collision>
  </link>
</robot>"#,
        0.25 + lowest / 2.0,
        0.5 - lowest,
    )
}

/// Returns a world with these lines in `[robot]`. The arm folds from its start to its goal.
pub fn world(robot: &str) -> String {
    format!("[robot]\n{robot}\n[start]\njoints = [-1, 0]\n[goal]\njoints = [-1, 2.8]\n")
}

/// Returns a certificate that folds the arm. The quill ends 0.17 m from the axis of the base.
pub fn folded(extra: &str) -> String {
    found(extra, r#""linear""#, "[0, -1, 0], [1, -1, 2.8]")
}

/// Returns a certificate that the elbow cannot fold beyond 2.65 rad. Its evidence: from there on, the shape overlaps
/// the part for all values of the shoulder within [`LIMITS`].
pub fn folding_certificate(shape: &str, part: &str) -> String {
    let stuck = |k: i32| {
        let [low, high] = [k, k + 1].map(|k| f64::from(k) / 10.0);
        format!(r#"{{"lower": [{low}, 2.64], "upper": [{high}, 2.66], "shape": 0, "part": 0}}"#)
    };
    let boxes: Vec<String> = (-6..6).map(stuck).collect();
    format!(
        r#"{{"format": "cplan certificate 1", "answer": "infeasible", "start": [-0.1, 0], "goal": [-0.1, 2.8],
            "shapes": [{shape}], "parts": [{part}], "boxes": [{}]}}"#,
        boxes.join(",")
    )
}

/// Limits of the shoulder, as a line for `[robot]`.
pub const LIMITS: &str = "limits = { a = [-0.5, 0.5] }";
/// The quill as a shape of a certificate.
pub const QUILL: &str = r#"{"link": "quill", "collision": 0}"#;
