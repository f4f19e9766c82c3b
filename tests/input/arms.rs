//! Loaded arms, compared with full kinematics in space. Outlines are compared with projected samples, and inverse with
//! forward kinematics.

use cplan::geometry::{Point, separation};
use cplan::input::{InputError, LoadedScene, load_scene};
use cplan::model::{Arm, Freedom, OutlineSource, Part, inverse};
use cplan::space::{Configuration, JointRange};
use cplan_testkit::shapes::{convex, disc};
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use std::fs;

fn load_arm(urdf: &str, robot: &str) -> LoadedScene {
    let folder = tempfile::tempdir().unwrap();
    let (u, w) = (folder.path().join("arm.urdf"), folder.path().join("world.toml"));
    fs::write(&u, urdf).unwrap();
    fs::write(&w, format!("[robot]\n{robot}\n")).unwrap();
    load_scene(&u, &w).unwrap_or_else(|e| panic!("{e}\n{urdf}"))
}

/// Returns a rotation about a unit axis by Rodrigues' formula.
fn rotation(axis: Vector3<f64>, angle: f64) -> Matrix3<f64> {
    let k = axis.cross_matrix();
    Matrix3::identity() + k * angle.sin() + k * k * (1.0 - angle.cos())
}

fn rpy([r, p, y]: [f64; 3]) -> Matrix3<f64> {
    rotation(Vector3::z(), y) * rotation(Vector3::y(), p) * rotation(Vector3::x(), r)
}

/// A joint of the test's own kinematics.
#[derive(Debug, Clone, Copy)]
struct TestJoint {
    revolute: bool,
    xyz: [f64; 3],
    rpy: [f64; 3],
    axis: [f64; 3],
}

impl TestJoint {
    fn xml(&self, name: &str, parent: &str, child: &str) -> String {
        let t = |v: [f64; 3]| format!("{} {} {}", v[0], v[1], v[2]);
        let kind = if self.revolute { "revolute" } else { "prismatic" };
        format!(
            r#"<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>
            <origin xyz="{}" rpy="{}"/><axis xyz="{}"/><limit lower="-3" upper="3" velocity="1"/></joint>"#,
            t(self.xyz),
            t(self.rpy),
            t(self.axis)
        )
    }

    /// Returns the frame of the child from that of the parent.
    fn step(&self, (r, p): (Matrix3<f64>, Vector3<f64>), q: f64) -> (Matrix3<f64>, Vector3<f64>) {
        let p = p + r * Vector3::from(self.xyz);
        let r = r * rpy(self.rpy);
        let axis = Vector3::from(self.axis).normalize();
        if self.revolute { (r * rotation(axis, q), p) } else { (r, p + r * axis * q) }
    }
}

const TIP: [f64; 3] = [0.3, -0.2, 0.5];

fn urdf(joints: [TestJoint; 2]) -> String {
    format!(
        r#"<robot name="t"><link name="base"/>{}<link name="one"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
        {}<link name="two"/><joint name="end" type="fixed"><parent link="two"/><child link="tip"/><origin xyz="{} {} {}"/></joint><link name="tip"/></robot>"#,
        joints[0].xml("a", "base", "one"),
        joints[1].xml("b", "one", "two"),
        TIP[0],
        TIP[1],
        TIP[2]
    )
}

/// Generates arms of all kinds in planes of all directions. The frame of the second joint is only turned about the
/// normal.
fn arms() -> impl Strategy<Value = [TestJoint; 2]> {
    let number = -1.0..1.0f64;
    let triple = || [number.clone(), number.clone(), number.clone()];
    let mount = prop_oneof![
        Just([0.0; 3]),
        Just([std::f64::consts::FRAC_PI_2, 0.0, 0.0]),
        Just([0.0, -std::f64::consts::FRAC_PI_2, 0.0]),
        Just([std::f64::consts::PI, 0.0, 0.3]),
        triple()
    ];
    (mount, triple(), triple(), number.clone(), any::<[bool; 2]>(), any::<[bool; 2]>(), [-3.0..3.0f64, 0.5..2.5])
        .prop_map(|(mount, xyz1, xyz2, yaw, revolute, flip, heading)| {
            let axis = |i: usize| {
                let turn = [0.0, 0.0, if flip[i] { -1.2 } else { 1.0 }];
                // The slides are in the frame's (x, y) plane. Their headings differ, so that they are never parallel.
                let angle = heading[0] + if i == 1 { heading[1] - yaw } else { 0.0 };
                if revolute[i] { turn } else { [angle.cos(), angle.sin(), 0.0] }
            };
            [
                TestJoint { revolute: revolute[0], xyz: xyz1, rpy: mount, axis: axis(0) },
                TestJoint { revolute: revolute[1], xyz: xyz2, rpy: [0.0, 0.0, yaw], axis: axis(1) },
            ]
        })
}

proptest! {
    #![proptest_config(cplan_cases::cases(128))]

    #[test]
    fn planar_kinematics_are_the_spatial_ones_projected(joints in arms(), q in [-3.0..3.0f64, -3.0..3.0]) {
        let arm = load_arm(&urdf(joints), "").scene.into_parts().0;
        prop_assert!((arm.plane.u.cross(&arm.plane.v).dot(&arm.plane.normal).abs() - 1.0).abs() < 1e-12);
        let q = Configuration::from(q);
        let one = joints[0].step((Matrix3::identity(), Vector3::zeros()), q[0]);
        let two = joints[1].step(one, q[1]);
        let project = |x: Vector3<f64>| Point::new(x.dot(&arm.plane.u), x.dot(&arm.plane.v));
        let tip = project(two.1 + two.0 * Vector3::from(TIP));
        prop_assert!((arm.tip_at(q) - tip).norm() < 1e-9, "{:?} against {tip:?}, kind {}", arm.tip_at(q), arm.kind());
        // A ball about link 1's origin is a disc about its projection, for every pose.
        let disc = arm.links[0].parts[0].shape.at(&arm.pose(0, q));
        prop_assert!((disc.core()[0] - project(one.1)).norm() < 1e-9);
    }

    #[test]
    fn inverse_kinematics_put_the_tip_back(joints in arms(), q in [-3.0..3.0f64, -3.0..3.0]) {
        let arm = load_arm(&urdf(joints), "").scene.into_parts().0;
        let q = Configuration::from(q);
        let target = arm.tip_at(q);
        let solved = inverse(&arm, target, Configuration::zeros());
        prop_assert!(!solved.branches.is_empty() && solved.branches.len() <= 2);
        for branch in &solved.branches {
            prop_assert!((arm.tip_at(*branch) - target).norm() < 1e-9);
        }
        // The solutions include the configuration from which the target was computed, up to whole turns.
        let turns = |i: usize| if arm.joints[i].joint_type.is_revolute() { JointRange::Circle } else { JointRange::Interval { lower: -9.0, upper: 9.0 } };
        let near = |b: &Configuration| (0..2).all(|i| turns(i).displacement(q[i], b[i]).abs() < 1e-4);
        prop_assert!(solved.branches.iter().any(near), "{q:?} not in {:?}", solved.branches);
    }

    #[test]
    fn outlines_hold_the_projected_solid_and_little_more(
        shape in 0..4usize, r in [-3.0..3.0f64, -3.0..3.0, -3.0..3.0], right in any::<bool>(), seed in any::<u64>()
    ) {
        // Some angles are right angles.
        let r = if right { r.map(|a| a.round() * std::f64::consts::FRAC_PI_2) } else { r };
        let (xml, points) = solid(shape, seed);
        let urdf = urdf_with(&format!("<origin xyz=\"0.1 0.2 0.3\" rpy=\"{} {} {}\"/><geometry>{xml}</geometry>", r[0], r[1], r[2]));
        let arm = load_arm(&urdf, "").scene.into_parts().0;
        let part = &arm.links[0].parts[0];
        let placed: Vec<Vector3<f64>> = points.iter().map(|p| Vector3::new(0.1, 0.2, 0.3) + rpy(r) * p).collect();
        for p in &placed {
            let inside = separation(&part.shape, &disc(Point::new(p.x, p.y), 0.0)).distance;
            prop_assert!(inside < 2e-9, "{inside} outside");
            prop_assert!(part.heights.lower - 1e-9 <= p.z && p.z <= part.heights.upper + 1e-9);
        }
        // The outline may exceed the sampled solid by the error of sampling and by the stated bound.
        for i in 0..64 {
            let a = f64::from(i) * std::f64::consts::TAU / 64.0;
            let d = nalgebra::Vector2::new(a.cos(), a.sin());
            let outline = part.shape.core().iter().map(|p| p.dot(&d)).fold(f64::MIN, f64::max) + part.shape.radius();
            let sampled = placed.iter().map(|p| p.xy().dot(&d)).fold(f64::MIN, f64::max);
            prop_assert!(outline - sampled < 0.005 * RADIUS + SAMPLING, "excess {}", outline - sampled);
            // The inner outline, which proofs use, is within the solid and only slightly smaller.
            let inner = part.inner.as_ref().unwrap_or(&part.shape);
            let support = inner.core().iter().map(|p| p.dot(&d)).fold(f64::MIN, f64::max) + inner.radius();
            if shape == CYLINDER {
                let (axis, half) = (rpy(r) * Vector3::z(), length(seed) / 2.0);
                let along = axis.xy().dot(&d);
                let exact = 0.1 * d.x + 0.2 * d.y + half * along.abs() + RADIUS * (1.0 - along * along).sqrt();
                prop_assert!(support < exact + 1e-9, "{} outside", support - exact);
                prop_assert!(outline > exact - 1e-9 && outline - support < 0.01 * RADIUS + 1e-9, "{}", outline - support);
            } else {
                prop_assert_eq!(support, outline);
            }
        }
    }
}

const RADIUS: f64 = 0.2;
/// Largest error, in metres, of samples of a circle of radius 0.2: the distance of the chords between 96 samples round
/// a circle, and between 48 down to the pole, with room for both together.
const SAMPLING: f64 = 6e-4;

const CYLINDER: usize = 1;

/// Returns the length of a solid, in metres.
fn length(seed: u64) -> f64 {
    0.1 + (seed % 7) as f64 * 0.15
}

/// Returns a solid as URDF and as points of its surface.
fn solid(shape: usize, seed: u64) -> (String, Vec<Vector3<f64>>) {
    let length = length(seed);
    let ring = |radius: f64, z: f64| {
        (0..96).map(move |i| {
            let a = f64::from(i) * std::f64::consts::TAU / 96.0;
            Vector3::new(radius * a.cos(), radius * a.sin(), z)
        })
    };
    let ball = |z: f64| {
        (0..=48).flat_map(move |i| {
            let b = f64::from(i) * std::f64::consts::PI / 48.0;
            ring(RADIUS * b.sin(), z + RADIUS * b.cos())
        })
    };
    match shape {
        0 => {
            let corner = |i: u8| {
                let s = |bit: u8| if i & bit == 0 { -0.5 } else { 0.5 };
                Vector3::new(s(1) * length, s(2) * 0.3, s(4) * 0.1)
            };
            (format!("<box size=\"{length} 0.3 0.1\"/>"), (0..8).map(corner).collect())
        }
        CYLINDER => {
            let points = ring(RADIUS, length / 2.0).chain(ring(RADIUS, -length / 2.0)).collect();
            (format!("<cylinder radius=\"{RADIUS}\" length=\"{length}\"/>"), points)
        }
        2 => (format!("<sphere radius=\"{RADIUS}\"/>"), ball(0.0).collect()),
        _ => {
            let points = ball(length / 2.0).chain(ball(-length / 2.0)).collect();
            (format!("<capsule radius=\"{RADIUS}\" length=\"{length}\"/>"), points)
        }
    }
}

/// Returns an arm that turns about z, whose first link has this collision geometry.
fn urdf_with(collision: &str) -> String {
    format!(
        r#"<robot name="t"><link name="base"/><joint name="a" type="continuous"><parent link="base"/><child link="one"/><axis xyz="0 0 1"/><limit velocity="1"/></joint>
        <link name="one"><collision>{collision}</collision></link>
        <joint name="b" type="continuous"><parent link="one"/><child link="two"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/><limit velocity="1"/></joint><link name="two"/></robot>"#
    )
}

/// Reads an arm whose first link is a mesh of this content.
fn load_mesh(name: &str, content: impl AsRef<[u8]>, scale: &str) -> Result<LoadedScene, InputError> {
    let folder = tempfile::tempdir().unwrap();
    let [urdf, world] = ["arm.urdf", "world.toml"].map(|file| folder.path().join(file));
    fs::write(&world, "").unwrap();
    fs::write(folder.path().join(name), content).unwrap();
    let mesh = format!("<geometry><mesh filename=\"{name}\" scale=\"{scale}\"/></geometry>");
    fs::write(&urdf, urdf_with(&mesh)).unwrap();
    load_scene(&urdf, &world)
}

/// Returns the outline of a mesh.
fn part(mesh: Result<LoadedScene, InputError>) -> Part {
    mesh.unwrap_or_else(|e| panic!("{e}")).scene.arm().links[0].parts[0].clone()
}

#[test]
fn stl_meshes_count_by_their_convex_hull_in_text_and_binary() {
    let vertices = [[0.0f32, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.5]];
    let vertex = |v: &[f32; 3]| format!("vertex {} {} {}\n", v[0], v[1], v[2]);
    let text = format!(
        "solid t\nfacet normal 0 0 1\nouter loop\n{}endloop\nendfacet\nendsolid t\n",
        vertices.iter().map(vertex).collect::<String>()
    );
    // A binary file whose header begins like that of a text file, as some exporters write them.
    let mut binary = b"solid exported".to_vec();
    binary.resize(80, b' ');
    binary.extend(1u32.to_le_bytes());
    binary.extend([0u8; 12]);
    binary.extend(vertices.iter().flatten().flat_map(|c| c.to_le_bytes()));
    binary.extend([0u8; 2]);
    for (name, content) in [("text.stl", text.as_bytes()), ("binary.STL", &binary)] {
        let part = part(load_mesh(name, content, "0.1 -0.1 1"));
        assert!((part.shape.area() - 0.01).abs() < 1e-8, "{name}: {:?}", part.shape);
        assert!(part.shape.core().iter().all(|p| p.y <= 0.0));
        assert_eq!((part.heights.lower, part.heights.upper), (0.0, 0.5));
    }
    let error = load_mesh("short.stl", [0u8; 90], "1 1 1").unwrap_err().to_string();
    assert!(error.contains("does not match the number of triangles"), "{error}");
}

/// A triangle in centimetres. Its node is turned and moved within another node, which maps (x, y, z) to (1 - y, x, z)
/// metres.
const COLLADA: &str = r##"<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit name="centimeter" meter="0.01"/><up_axis>Z_UP</up_axis></asset>
  <library_geometries><geometry id="g"><mesh>
    <source id="p"><float_array id="a" count="9">0 1 0 0 -1 0 1 1 0.5</float_array>
      <technique_common><accessor source="#a" count="3" stride="3"/></technique_common></source>
    <source id="n"><float_array count="3">7 7 7</float_array></source>
    <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
    <triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>
  <library_nodes><node id="inner"><matrix>100 0 0 0 0 100 0 0 0 0 100 0 0 0 0 1</matrix><instance_geometry url="#g"/></node></library_nodes>
  <library_visual_scenes><visual_scene id="s"><node><translate>100 0 0</translate><rotate>0 0 1 90</rotate>
    <instance_node url="#inner"/></node></visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>"##;

#[test]
fn meshes_of_collada_and_obj_are_those_of_stl() {
    let obj = "# by hand\no triangle\nv 9 9 9\nv 0 0 0\nv 2 0 0 1.0\nvn 0 0 1\nv 0 1 0.5\nf 2/1/1 3//1 -1\n";
    for (mesh, text) in [("t.obj", obj), ("t.dae", COLLADA)] {
        let part = part(load_mesh(mesh, text, "0.1 -0.1 1"));
        assert!((part.shape.area() - 0.01).abs() < 1e-12, "{mesh}: {:?}", part.shape);
        assert!(part.shape.core().iter().all(|p| p.y <= 1e-12 && p.x >= -1e-12), "{mesh}: {:?}", part.shape);
        assert!((part.heights.lower.abs(), part.heights.upper) <= (1e-12, 0.5), "{mesh}: {:?}", part.heights);
    }
    let spoilt = |this: &str, that: &str| COLLADA.replace(this, that);
    for (mesh, text, message) in [
        ("t.obj", "v 0 0 0\nf 1 2 3\n".to_owned(), "line 2: vertex \"2\" is not defined"),
        ("t.obj", "v 0 0\n".to_owned(), "line 1: a vertex needs three numbers"),
        ("t.obj", "v 0 0 0\n".to_owned(), "no face"),
        ("t.obj", "v 0 nan 0\nf 1 1 1\n".to_owned(), "not finite"),
        ("t.dae", "<svg/>".to_owned(), "not Collada"),
        ("t.dae", "<COLLADA>".to_owned(), "not well-formed XML"),
        ("t.dae", spoilt("0.01", "-1"), "not a positive number"),
        ("t.dae", spoilt("0 1 0 0 -1", "0 1 x 0 -1"), "\"x\" is not a number"),
        ("t.dae", spoilt("0 1 0 0 -1", "0 1 0 0"), "numbers for positions"),
        ("t.dae", spoilt("url=\"#g\"", "url=\"#none\""), "a geometry that does not exist"),
        ("t.dae", spoilt("<instance_geometry url=\"#g\"/>", "<instance_node url=\"#inner\"/>"), "contains itself"),
        ("t.dae", "<COLLADA/>".to_owned(), "no mesh"),
        ("t.3ds", String::new(), "only meshes in STL, Collada (.dae) and OBJ"),
    ] {
        let error = load_mesh(mesh, &text, "0.1 -0.1 1").unwrap_err().to_string();
        assert!(error.contains(message) && error.contains("hint: "), "{message}: {error}");
    }
}

/// Checks files of exporters that omit some elements and write others first. Such a file has no scene that shows
/// anything. Then geometries keep their coordinates, in centimetres.
#[test]
fn collada_without_a_scene_and_with_a_comment_first() {
    let area = |text: String| part(load_mesh("t.dae", text, "1 1 1")).shape.area();
    let whole = area(COLLADA.to_owned());
    assert!((whole - 1.0).abs() < 1e-12, "{whole}");
    let comment = format!("<!-- made by -->\n<!-- a program -->\n{COLLADA}");
    assert_eq!(area(comment), whole);
    for nothing in [
        COLLADA.replace("<instance_node url=\"#inner\"/>", ""),
        COLLADA
            .replace("<scene><instance_visual_scene url=\"#s\"/></scene>", "")
            .replace("visual_scene", "hidden_scene"),
    ] {
        assert!((area(nothing) - 1e-4).abs() < 1e-16);
    }
}

#[test]
fn scaled_meshes_must_be_within_a_range() {
    let stl = "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 2 0 0\nvertex 0 1 0.5\nendloop\nendfacet\nendsolid t\n";
    let obj = "v 0 0 0\nv 2 0 0\nv 0 1 0.5\nf 1 2 3\n";
    let far = obj.replace('2', "1e300").replace("f 1 1e300", "f 1 2");
    let spread = COLLADA.replace("<matrix>100", "<matrix>1e300");
    for (mesh, text, scale, message) in [
        ("t.stl", stl, "1e300 1 1", "too large: (2.0, 0.0, 0.0) with scale=\"1e300 1.0 1.0\" (at most 1e6 m)"),
        ("t.obj", obj, "1 1e300 1", "too large: (0.0, 1.0, 0.5)"),
        ("t.obj", obj, "1e308 1 1", "too large: (2.0, 0.0, 0.0)"),
        ("t.obj", &far, "1 1 1", "too large: (1e300, 0.0, 0.0)"),
        ("t.obj", &obj.replace('2', "1e999").replace("f 1 1e999", "f 1 2"), "1 1 1", "not finite: (inf, 0.0, 0.0)"),
        ("t.dae", COLLADA, "1 1 1e300", "too large"),
        ("t.dae", &spread, "1 1 1", "too large"),
    ] {
        let error = load_mesh(mesh, text, scale).unwrap_err().to_string();
        assert!(error.contains("arm.urdf: line 2, column ") && error.contains(mesh), "{error}");
        assert!(error.contains(message) && error.contains("hint: give the scale"), "{message}: {error}");
    }
    // The scale brings a distant shape near.
    assert!(load_mesh("t.obj", far.replace("1e300", "2e9"), "1e-9 1 1").is_ok());
}

#[test]
fn lines_of_obj_go_on_after_a_backslash() {
    let shape = |text: &str| part(load_mesh("t.obj", text, "1 1 1")).shape;
    let plain = shape("v 0 0 0\nv 2 0 0\nv 0 1 0.5\nf 1 2 3\n");
    let folded = "# of C:\\meshes\\\nv 0 \\\n 0 0\nv 2 0 0\nv \\ \r\n0\\\r\n1 0.5\nf 1 2 \\\n\\\n3\\";
    assert_eq!(shape(folded), plain);
    let error = load_mesh("t.obj", "v 0 0 \\\n0\nv 0 \\\nf 1 1 1\n", "1 1 1").unwrap_err().to_string();
    assert!(error.contains("line 3: a vertex needs three numbers"), "{error}");
}

#[test]
fn a_speed_that_is_all_but_infinite_makes_no_infinite_acceleration() {
    let joints = ["a", "b"].map(|name| format!("{name} = 1e308")).join(", ");
    let arm =
        load_arm(&urdf_with("<geometry><sphere radius=\"0.1\"/></geometry>"), &format!("velocity = {{ {joints} }}"));
    assert!(arm.scene.arm().joints.iter().any(|joint| joint.velocity == 1e308));
    assert!(arm.scene.arm().joints.iter().all(|joint| joint.acceleration.is_finite()));
}

#[test]
fn a_bar_stands_in_only_where_it_is_asked_for() {
    let bare = urdf_with("<geometry><cylinder radius=\"0\" length=\"0\"/></geometry>");
    let loaded = load_arm(&bare, "bar = 0.05");
    let arm: &Arm = loaded.scene.arm();
    assert_eq!(arm.links[0].source, OutlineSource::Bar);
    assert_eq!(arm.links[0].parts[0].shape, convex(vec![Point::zeros(), Point::new(1.0, 0.0)], 0.05));
    assert!(loaded.robot.notes.iter().any(|n| n.contains("size zero are ignored (in \"one\")")));
    let half = load_arm(&urdf_with("<geometry><sphere radius=\"0.1\"/></geometry>"), "");
    assert_eq!(half.scene.arm().links[1].source, OutlineSource::None);
    assert!(half.robot.warnings[0].contains("link 2 \"two\" has no geometry"));
}

#[test]
fn limits_come_from_the_world_then_the_soft_ones_then_the_hard_ones() {
    let limit = |lower, upper| JointRange::Interval { lower, upper };
    let joint = TestJoint { revolute: true, xyz: [1.0, 0.0, 0.0], rpy: [0.0; 3], axis: [0.0, 0.0, 1.0] };
    let hard = urdf([joint; 2]);
    let soft = hard.replacen(
        "</joint>",
        "<safety_controller soft_lower_limit=\"-1\" soft_upper_limit=\"9\" k_velocity=\"1\"/></joint>",
        1,
    );
    assert_eq!(load_arm(&hard, "").scene.arm().joints[0].range, limit(-3.0, 3.0));
    assert_eq!(load_arm(&soft, "").scene.arm().joints[0].range, limit(-1.0, 3.0));
    let world =
        load_arm(&soft, "limits = { a = [-9, 9] }\nvelocity = { a = 3 }\nacceleration = { b = 7 }\njerk = { b = 90 }")
            .scene
            .into_parts()
            .0;
    assert_eq!(world.joints[0].range, limit(-9.0, 9.0));
    assert_eq!(
        (world.joints[0].velocity, world.joints[0].acceleration, world.joints[1].acceleration),
        (3.0, 12.0, 7.0)
    );
    assert_eq!(world.joints.map(|joint| joint.jerk), [None, Some(90.0)]);
    let newer = hard.replacen("velocity=\"1\"", "velocity=\"1\" acceleration=\"5\"", 1);
    assert_eq!(load_arm(&newer, "").scene.arm().joints[0].acceleration, 5.0);
    let turning = urdf_with("<geometry><sphere radius=\"0.1\"/></geometry>");
    assert!(load_arm(&turning, "").scene.arm().joints[0].range.is_circle());
    assert_eq!(load_arm(&turning, "limits = { a = [-1, 1] }").scene.arm().joints[0].range, limit(-1.0, 1.0));
}

/// Loads an RR arm in the (x, y) plane. Both links are 1 m long, so that the tip can reach the base.
fn folding() -> LoadedScene {
    let joint = |x: f64| TestJoint { revolute: true, xyz: [x, 0.0, 0.0], rpy: [0.0; 3], axis: [0.0, 0.0, 1.0] };
    let text = urdf([joint(0.0), joint(1.0)]).replace("0.3 -0.2 0.5", "1 0 0");
    load_arm(&text, "limits = { a = [-9, 9], b = [-3.2, 3.2] }")
}

#[test]
fn where_a_joint_does_not_matter_the_preferred_value_is_taken() {
    let arm = folding().scene.into_parts().0;
    let folded = inverse(&arm, Point::zeros(), Configuration::new(0.7, 0.2));
    assert_eq!(folded.free, Some(Freedom::Joint(0)));
    assert_eq!((folded.branches.len(), folded.branches[0][0]), (1, 0.7));
    assert!((folded.branches[0][1].abs() - std::f64::consts::PI).abs() < 1e-9);
    let stretched = inverse(&arm, Point::new(0.0, 2.0), Configuration::zeros());
    assert_eq!((stretched.branches.len(), stretched.free), (1, None));
    assert!(inverse(&arm, Point::new(0.0, 2.0 + 1e-6), Configuration::zeros()).branches.is_empty());
}

#[test]
fn a_goal_of_the_tip_counts_every_turn_within_the_limits() {
    let overrides = cplan::input::Overrides {
        start: Some("0,0.5".parse().unwrap()),
        goal_tip: Some("1,1".parse().unwrap()),
        ..Default::default()
    };
    let problem = folding().problem(&overrides).unwrap().problem;
    // Elbow up: 0 and -+2 pi; elbow down: pi/2, pi/2 + 2 pi and pi/2 - 2 pi.
    let mut first: Vec<f64> = problem.goals().points().map(|q| q[0]).collect();
    first.sort_by(f64::total_cmp);
    let pi = std::f64::consts::PI;
    let expected = [-2.0 * pi, -1.5 * pi, 0.0, 0.5 * pi, 2.0 * pi, 2.5 * pi];
    assert_eq!(first.len(), expected.len(), "{first:?}");
    for (q, e) in first.iter().zip(expected) {
        assert!((q - e).abs() < 1e-9, "{first:?}");
    }
    for q in problem.goals().points() {
        assert!((problem.scene().arm().tip_at(q) - Point::new(1.0, 1.0)).norm() < 1e-9);
    }
}
