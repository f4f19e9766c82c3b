//! Certificates for robots as tools export them, and maps as tools write them: the checker accepts the same files as
//! the program.

use super::certificates::without_digests;
use super::*;

/// An arm with two bars of 1 m and 0.8 m. The words in braces are placeholders for what differs between cases.
const ARM: &str = r#"<robot name="r" {version}>
<link name="base"/>
<joint name="j1" type="revolute">
  <parent link="base"/> <child link="l1"/> {mounting} <axis xyz="{axis}"/> {limit} {soft}
</joint>
<link name="l1"> {upper} </link>
<joint name="j2" type="revolute">
  <parent link="l1"/> <child link="l2"/> <origin xyz="1 0 0" {turned}/> <axis xyz="{second}"/>
  <limit lower="-2" upper="2" velocity="1" effort="1"/>
</joint>
<link name="l2"> <collision> <origin xyz="0.4 0 0"/> <geometry> <box size="0.8 0.1 0.1"/> </geometry> </collision> </link>
<joint name="flange" type="fixed"> <parent link="l2"/> <child link="tool"/> <origin xyz="0.8 0 0"/> </joint>
<link name="tool"/>
{more}
</robot>"#;

/// Default values of the placeholders.
const USUAL: [(&str, &str); 9] = [
    ("{version}", ""),
    ("{mounting}", ""),
    ("{axis}", "0 0 1"),
    ("{limit}", r#"<limit lower="-3" upper="3" velocity="1" effort="1"/>"#),
    ("{soft}", ""),
    ("{upper}", r#"<collision> <origin xyz="0.5 0 0"/> <geometry> <box size="1 0.1 0.1"/> </geometry> </collision>"#),
    ("{turned}", ""),
    ("{second}", "0 0 1"),
    ("{more}", ""),
];

/// A world with discs that leave the upper arm little room in either direction. Start and goal are between them.
const WORLD: &str = "[start]\njoints = [0.0, 0.0]\n[goal]\njoints = [0.2, 0.5]\n\
                     [[obstacle]]\ncircle = { center = [0.38, 0.32], radius = 0.1 }\n\
                     [[obstacle]]\ncircle = { center = [0.38, -0.32], radius = 0.1 }\n\
                     [[obstacle]]\ncircle = { center = [-0.5, 0.0], radius = 0.1 }\n";

/// A robot or a world in the form in which some tool or person writes it.
#[derive(Default)]
struct Case<'a> {
    what: &'a str,
    robot: &'a [(&'a str, &'a str)],
    /// Text before and after the rest of the world.
    world: [&'a str; 2],
    files: &'a [(&'a str, &'a [u8])],
    /// Expected part of the checker's report on motions.
    report: &'a str,
}

impl Case<'_> {
    fn written(&self, place: &Place) {
        let replaced = |text: String, (from, to): &(&str, &str)| text.replace(from, to);
        let urdf = self.robot.iter().chain(&USUAL).fold(ARM.to_owned(), replaced);
        assert!(!urdf.contains('{'), "{urdf}");
        place.write("arm.urdf", urdf);
        self.files.iter().for_each(|(name, content)| place.write(name, content));
    }

    fn world(&self) -> String {
        [self.world[0], WORLD, self.world[1]].join("\n")
    }

    /// Checks that the program's certificates of a motion and of a proof hold, and that they fail in a world with
    /// another obstacle.
    fn is_certified(&self) {
        let place = Place::new();
        self.written(&place);
        let judged = |world: &str, certificate: &str| {
            place.write("other.toml", world);
            place.write("c.json", certificate);
            place.judged(["arm.urdf", "other.toml", "c.json"])
        };
        let planned = |world: &str, code: i32| {
            place.run_in("arm.urdf", world, "--quiet --certificate c.json").exits(code);
            place.read("c.json")
        };
        let open = self.world();
        let closed = open.replace("[0.2, 0.5]", "[1.5, 0.5]");
        let motion = planned(&open, 0);
        let report = judged(&open, &motion).unwrap_or_else(|why| panic!("{}: {why}", self.what));
        assert!(report.contains("leads from the start") && report.contains(self.report), "{}: {report}", self.what);
        let proof = planned(&closed, 3);
        judged(&closed, &proof).unwrap_or_else(|why| panic!("{}: {why}", self.what));
        // The elbow is at the expected place in the plane's coordinates.
        let blocked = format!("{open}\n[[obstacle]]\ncircle = {{ center = [1.0, 0.0], radius = 0.01 }}\n");
        for (world, certificate) in [(&blocked, &motion), (&open, &proof)] {
            let other = judged(world, &without_digests(certificate));
            assert!(matches!(other, Err(CheckError::Fails(_))), "{}: {other:?}", self.what);
        }
    }
}

/// Checks frames that are turned by rounded angles, axes that are slightly off, and planes that are not along axes.
#[test]
fn frames_and_axes_written_by_exporters_are_certified() {
    for (what, robot, report) in [
        ("upright", &[("{mounting}", r#"<origin rpy="1.5708 0 0"/>"#)][..], "up to 1e-5 rad"),
        ("roughly upright", &[("{mounting}", r#"<origin rpy="1.57 0 0"/>"#)], "up to 1e-3 rad"),
        ("upright in all digits", &[("{mounting}", r#"<origin rpy="1.5707963267948966 0 0"/>"#)], "read as"),
        ("upside down", &[("{mounting}", r#"<origin rpy="3.14159 0 0"/>"#)], "up to 1e-5 rad"),
        ("an axis in single precision", &[("{axis}", "-1.19e-5 0 0.9999")], "up to 1e-4 rad"),
        ("a second axis that is off", &[("{second}", "0 4e-4 1")], "up to 1e-3 rad"),
        ("an elbow turned over", &[("{turned}", r#"rpy="3.14159 0 0""#), ("{second}", "0 0 -1")], "up to 1e-5"),
        ("an oblique plane", &[("{axis}", "0 1 1"), ("{second}", "0 3 3")], "read as"),
        ("a quaternion", &[("{mounting}", r#"<origin quat_xyzw="0 0 0 2"/>"#)], "read as"),
        ("an upright quaternion", &[("{mounting}", r#"<origin quat_xyzw="0.70710678 0 0 0.70710678"/>"#)], "leads"),
    ] {
        Case { what, robot, report, ..Case::default() }.is_certified();
    }
}

const ENDLESS: &str = r#"<limit lower="-1e16" upper="1e16" velocity="1" effort="1"/>"#;

/// Checks limits that are soft, infinite or missing, and joints that are held or mimic others.
#[test]
fn missing_limits_and_fixed_joints_are_certified() {
    let finger = |limit: &str, rest: &str| {
        format!(
            r#"<joint name="g" type="prismatic"> <parent link="l2"/> <child link="f1"/> <origin xyz="0.7 0 0"/> <axis xyz="0 1 0"/>
               {limit} </joint> <link name="f1"> <collision> <geometry> <box size="0.1 0.02 0.05"/> </geometry> </collision> </link> {rest}"#
        )
    };
    let limit = r#"<limit lower="0.02" upper="0.1" velocity="1" effort="1"/>"#;
    let mimic = r#"<joint name="h" type="prismatic"> <parent link="l2"/> <child link="f2"/> <origin xyz="0.7 0 0"/> <axis xyz="0 -1 0"/>
        <limit lower="0" upper="0.1" velocity="1" effort="1"/> <mimic joint="g" multiplier="1.5" offset="0.01"/> </joint>
        <link name="f2"> <collision> <geometry> <box size="0.1 0.02 0.05"/> </geometry> </collision> </link>"#;
    let soft = r#"<safety_controller soft_lower_limit="0.03" soft_upper_limit="0.05" k_velocity="1"/>"#;
    let unset = r#"<limit lower="0" upper="0" velocity="1" effort="1"/>"#;
    let [follows, held, loose] = [finger(limit, mimic), finger(&format!("{limit} {soft}"), ""), finger(unset, "")];
    let spun = finger(limit, "").replace("prismatic", "revolute").replace("0 1 0", "1 0 0");
    let two = ["[robot]\njoints = [\"j1\", \"j2\"]", ""];
    for (what, robot, world) in [
        (
            "soft limits",
            &[("{soft}", r#"<safety_controller soft_lower_limit="-2.5" soft_upper_limit="2.5" k_velocity="1"/>"#)][..],
            ["", ""],
        ),
        (
            "no soft limits",
            &[("{soft}", r#"<safety_controller soft_lower_limit="0" soft_upper_limit="0" k_velocity="1"/>"#)],
            ["", ""],
        ),
        ("a velocity's gain", &[("{soft}", r#"<safety_controller k_velocity="1"/>"#)], ["", ""]),
        ("limits without end", &[("{limit}", ENDLESS)], ["", ""]),
        (
            "infinite limits",
            &[("{limit}", r#"<limit velocity="1" effort="1"/>"#), ("{version}", "version=\"1.2\"")],
            ["", ""],
        ),
        ("a finger that mimics another", &[("{more}", &follows)], two),
        ("a finger held by soft limits", &[("{more}", &held)], two),
        ("a finger without limits", &[("{more}", &loose)], two),
        ("two joints of three in a plane", &[("{more}", &spun)], ["", ""]),
    ] {
        Case { what, robot, world, ..Case::default() }.is_certified();
    }
    // The motion is within the limits, but beyond the soft ones.
    let place = Place::new();
    let robot = [("{soft}", r#"<safety_controller soft_lower_limit="-2.5" soft_upper_limit="0.1" k_velocity="1"/>"#)];
    let case = Case { robot: &robot, ..Case::default() };
    case.written(&place);
    place.write("world.toml", case.world());
    place.write(
        "c.json",
        r#"{"format": "cplan certificate 1", "answer": "found",
            "motion": {"interpolation": ["linear"], "knots": [[0, 0, 0], [1, 0.2, 0.5]]}}"#,
    );
    let report = place.judged(["arm.urdf", "world.toml", "c.json"]);
    assert!(matches!(&report, Err(CheckError::Fails(why)) if why.contains("leaves its limits")), "{report:?}");
}

/// Checks corners on a line between others (in place or turned), starts and goals at half a turn, and starts and goals
/// that are beyond a limit only by rounding.
#[test]
fn numbers_that_are_no_doubles_are_certified() {
    for (what, obstacle) in [
        ("four on a line", "polygon = [[3.1, 0.1], [3.2, 0.2], [3.3, 0.3], [3.6, 0.0]]"),
        (
            "an L of equal arms",
            "polygon = [[0, 0], [0.6, 0], [0.6, 0.3], [0.3, 0.3], [0.3, 0.6], [0, 0.6]]\nat = [3.3, 0.3]",
        ),
        (
            "one on a side, turned",
            "polygon = [[0, 0], [0.2, 0], [0.4, 0], [0.4, 0.4], [0, 0.4]]\nat = [-0.7, -0.6]\nangle = \"45deg\"",
        ),
        (
            "a T, turned",
            "polygon = [[0, 0], [0.6, 0], [0.6, 0.2], [0.4, 0.2], [0.4, 0.6], [0.2, 0.6], [0.2, 0.2], [0, 0.2]]\nat = [-0.9, 0.2]\nangle = 0.3",
        ),
    ] {
        let after = format!("[[obstacle]]\n{obstacle}\n");
        Case { what, world: ["", &after], ..Case::default() }.is_certified();
    }
    // The part that a proof names has such corners.
    let flat = "polygon = [[0.2, 0.3], [0.3, 0.3], [0.4, 0.3], [0.4, 0.5], [0.2, 0.5]]";
    let circle = "circle = { center = [0.38, 0.32], radius = 0.1 }";
    for (what, robot, from, to) in [
        ("a side of two", &[][..], circle, flat),
        (
            "a side of two, turned",
            &[],
            circle,
            "polygon = [[0, 0], [0.1, 0], [0.2, 0], [0.2, 0.2], [0, 0.2]]\nat = [0.3, 0.25]\nangle = 0.7",
        ),
        ("half a turn", &[("{limit}", ENDLESS)], "[0.0, 0.0]", "[\"360deg\", 0.0]"),
        (
            "a limit but for rounding",
            &[("{limit}", r#"<limit lower="-1.047197551" upper="1.570796327"/>"#)],
            "[0.2, 0.5]",
            "[\"11.459155902616466deg\", 0.5]",
        ),
    ] {
        let place = Place::new();
        let case = Case { what, robot, ..Case::default() };
        case.written(&place);
        for (goal, code) in [("[0.2, 0.5]", 0), ("[1.5, 0.5]", 3)] {
            let world = case.world().replace("[0.2, 0.5]", goal).replace(from, to);
            place.write("world.toml", world);
            place.certified("arm.urdf", "world.toml", "", code);
        }
    }
    let place = Place::new();
    let limit = [("{limit}", r#"<limit lower="-1.570796326" upper="1.570796326"/>"#)];
    for (limit, ends, code) in [
        (&limit[..], ["\"-90deg\", 0", "\"-80deg\", 0"], 0),
        (&limit, ["\"-90deg\", 0", "\"90deg\", 0"], 3),
        (&[("{limit}", ENDLESS)], ["\"180deg\", 1.7", "3.0, 1.7"], 0),
        (&[("{limit}", ENDLESS)], ["\"-540deg\", 1.7", "0, 0"], 3),
    ] {
        Case { robot: limit, ..Case::default() }.written(&place);
        let world =
            WORLD.replace("0.0, 0.0", ends[0]).replace("0.2, 0.5", ends[1]).replace("[-0.5, 0.0]", "[-0.5, 0.3]");
        place.write("world.toml", world);
        place.certified("arm.urdf", "world.toml", "", code);
    }
}

/// Checks links that a wrist turns. Some of them cover a disc together, and a smaller one at all angles of the wrist.
/// The program refuses a link away from the wrist's axis, and one that mimics a joint of the arm or the tool.
#[test]
fn other_moving_joints_are_certified() {
    let place = Place::new();
    let bar = |at: &str| {
        format!(
            r#"<joint name="w" type="revolute"> <parent link="tool"/> <child link="gripper"/> <axis xyz="0 0 1"/>
               <limit lower="-3" upper="3" velocity="1" effort="1"/> </joint>
               <link name="gripper"> <collision> <origin xyz="{at}"/> <geometry> <box size="0.02 0.3 0.02"/> </geometry> </collision> </link>"#
        )
    };
    let task = |post: f64| {
        format!(
            "[robot]\njoints = [\"j1\", \"j2\"]\npayload = \"level\"\nwrist = {{ joint = \"w\", velocity = 3.0 }}\n[start]\njoints = [0.0, 0.0]\n\
             [[step]]\nmove = {{ joints = [0.2, 0.5] }}\n[[obstacle]]\ncircle = {{ center = [{post}, 0.0], radius = 0.01 }}\n"
        )
    };
    let run = |more: &str, world: &str| {
        Case { robot: &[("{more}", more)], ..Case::default() }.written(&place);
        place.write("world.toml", world);
        place.run(&["arm.urdf", "world.toml"], "--quiet --certificate c.json")
    };
    let judged = || place.judged(["arm.urdf", "world.toml", "c.json"]);
    // The post is 0.1 m ahead of a gripper whose ends are 0.15 m from the axis, and now at the sides.
    run(&bar("0 0 0"), &task(1.9)).exits(1).warns(&["not free"]);
    run(&bar("0 0 0"), &task(2.0)).exits(0);
    judged().unwrap();
    place.write("world.toml", task(1.9));
    let certificate = without_digests(&place.read("c.json"));
    place.write("c.json", certificate);
    assert!(matches!(judged(), Err(CheckError::Fails(_))), "{:?}", judged());
    let beside = run(&bar("0.1 0 0"), &task(2.5)).exits(1);
    beside.warns(&["turns with the wrist"]);
    assert!(matches!(judged(), Err(CheckError::Input { message, .. }) if message.contains("turns with the wrist")));
    // One bar is beside the base and turns like the arm, another is above the arm, and one mimics the wrist.
    for (parent, leader, world) in
        [("base", "j1", WORLD), ("l1", "j2", WORLD), ("gripper", "w", &task(2.5)), ("base", "w", &task(2.5))]
    {
        let more = format!(
            r#"{} <joint name="f" type="revolute"> <parent link="{parent}"/> <child link="blade"/> <axis xyz="0 0 1"/> <mimic joint="{leader}"/>
               <limit lower="-9" upper="9" velocity="1" effort="1"/> </joint>
               <link name="blade"> <collision> <geometry> <box size="4 0.1 0.1"/> </geometry> </collision> </link>"#,
            bar("0 0 0")
        );
        let joints =
            if world == WORLD { format!("[robot]\njoints = [\"j1\", \"j2\"]\n{WORLD}") } else { world.to_owned() };
        run(&more, &joints).exits(1).warns(&["mimic"]);
        place.write(
            "c.json",
            r#"{"format": "cplan certificate 1", "answer": "found", "start": [0, 0], "goal": [0, 0],
                "motion": {"interpolation": ["linear"], "knots": [[0, 0, 0]]}}"#,
        );
        let report = judged();
        assert!(
            matches!(&report, Err(CheckError::Input { message, .. }) if message.contains("mimic")),
            "{parent}: {report:?}"
        );
    }
}

const OBJ: &str = "# a bar\nv 500 50 50\nv -500 50 50\nv -500 -50 50\nv 500 -50 50\nv 500 50 -50\nv -500 50 -50\nv 500 -50 -50\n\
                   v -500 -50 -50\nv 9000 0 0\nf 1/1/1 2//2 3 4\nf -5 -4 -3 \\\n -2\n";

const COLLADA: &str = r##"<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset> <unit name="millimetre" meter="0.001"/> <up_axis>Z_UP</up_axis> </asset>
  <library_geometries> <geometry id="bar"> <mesh>
    <source id="at"> <float_array id="numbers" count="12">50 500 50 -50 500 50 -50 -500 -50 50 -500 -50</float_array>
      <technique_common> <accessor source="#numbers" count="4" stride="3"/> </technique_common> </source>
    <vertices id="v"> <input semantic="POSITION" source="#at"/> </vertices>
    <polylist count="1"> <input semantic="VERTEX" source="#v" offset="0"/> <vcount>4</vcount> <p>0 1 2 3</p> </polylist>
  </mesh> </geometry> </library_geometries>
  <library_visual_scenes> <visual_scene id="scene">
    <node> <rotate>0 0 1 -90</rotate> <scale>1 1 2</scale> <instance_geometry url="#bar"/> </node>
  </visual_scene> </library_visual_scenes>
  <scene> <instance_visual_scene url="#scene"/> </scene>
</COLLADA>"##;

#[test]
fn meshes_and_their_substitutes_are_certified() {
    let mesh = |name: &str| {
        format!(
            r#"<collision> <origin xyz="0.5 0 0"/> <geometry> <mesh filename="{name}" scale="{0} {0} {0}"/> </geometry> </collision>"#,
            if name.ends_with("obj") { "0.001" } else { "1" }
        )
    };
    let bar = ["[robot]\nbar = 0.05", ""];
    let [obj, dae, none] = ["bar.obj", "bar.dae", "none.stl"].map(mesh);
    // The mesh has so many corners that its outline is split.
    let rim =
        (0..1500).map(|k| f64::from(k) * std::f64::consts::TAU / 1500.0).map(|t| (500.0 * t.cos(), 60.0 * t.sin()));
    let rim: String = rim.map(|(x, y)| format!("v {x} {y} 0\n")).collect();
    let face: String = (1..=1500).map(|k| format!(" {k}")).collect();
    let round = format!("{rim}f{face}\n");
    let two = ["-1 -0.05 -0.05", "0.05 -0.05 0.05", "0.05 0.05 0.05"].map(|first| {
        let facet = format!("facet normal 0 0 1\nouter loop\nvertex {first}\nvertex -0.5 0.05 0\nvertex 0.5 -0.05 0\nendloop\nendfacet\n");
        format!("solid vertex of a bar\n{}endsolid\n", facet.replace("-1 -0.05", "0.5 0.05"))
    });
    let stl = mesh("two.stl");
    // A mesh beside a shape that is read.
    let both = format!("{none} {}", USUAL[5].1);
    for (what, upper, world, files, report) in [
        ("a mesh in OBJ", &obj, ["", ""], ("bar.obj", OBJ.as_bytes()), ""),
        ("a mesh of several solids", &stl, ["", ""], ("two.stl", two.concat().as_bytes()), ""),
        ("a mesh with many corners", &obj, ["", ""], ("bar.obj", round.as_bytes()), ""),
        ("a mesh in Collada", &dae, ["", ""], ("bar.dae", COLLADA.as_bytes()), ""),
        ("a bar for a mesh", &none, bar, ("none", b"".as_slice()), "a bar replaces it"),
        ("a bar for one of two", &both, bar, ("none", b""), "none.stl"),
        ("a bar for no shape", &String::new(), bar, ("none", b""), "read as"),
    ] {
        Case { what, robot: &[("{upper}", upper)], world, files: &[files], report }.is_certified();
    }
}

/// Description of a picture of 3 by 3 pixels with one dark pixel.
const MAP: &str =
    "image: map.pgm\nresolution: 0.1\norigin: [0.6, -0.65, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.2\n";

/// Returns a PNG of four equal pixels, without compression.
fn png(color: [u8; 4]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 2, 2);
    encoder.set_color(png::ColorType::Rgba);
    let white = [255; 4];
    encoder.write_header().unwrap().write_image_data(&[white, color, white, white].concat()).unwrap();
    bytes
}

#[test]
fn maps_written_by_tools_are_certified() {
    let pgm = b"P2\n3 3\n255\n255 255 255\n255 0 255\n255 255 255\n";
    let [in_lines, in_png] = [
        MAP.replace("[0.6, -0.65, 0.0]", "\n- 0.6\n- -0.65\n- 0.0"),
        MAP.replace("map.pgm", "map.png").replace("negate: 0", "negate: false\nmode: trinary"),
    ];
    let map = ["", "[[obstacle]]\nimage = \"map.yaml\"\n"];
    let [dark, see_through] = [[0, 90, 0, 255], [255, 255, 255, 9]].map(png);
    for (what, yaml, picture) in [
        ("a list in lines", &in_lines, ("map.pgm", &pgm[..])),
        ("a dark pixel in colour", &in_png, ("map.png", &dark)),
        ("a pixel that one can see through", &in_png, ("map.png", &see_through)),
    ] {
        Case { what, world: map, files: &[("map.yaml", yaml.as_bytes()), picture], ..Case::default() }.is_certified();
    }
    // The shade 51 is a fifth of 255, which is the limit of free pixels. A pixel of exactly that shade is unknown, and
    // solid.
    let place = Place::new();
    Case { files: &[("map.yaml", MAP.as_bytes()), ("map.pgm", b"P2 1 1 255 204")], ..Case::default() }.written(&place);
    let on_it = "[start]\njoints = [-0.75, 0.0]\n[goal]\njoints = [0.0, 0.0]\n[[obstacle]]\nimage = \"map.yaml\"\n";
    place.run_in("arm.urdf", on_it, "--quiet").exits(1).warns(&["the start"]);
}

/// Checks a world with a start at a place of the tip, and with numbers in other bases.
#[test]
fn worlds_in_all_common_notations_are_certified() {
    let tip = WORLD.replace("joints = [0.0, 0.0]", "tip = [1.8, 0.0]");
    let place = Place::new();
    Case { ..Case::default() }.written(&place);
    for (goal, code) in [("[0.2, 0.5]", 0), ("[1.5, 0.5]", 3)] {
        let world = format!("clearance = 0x0\n{}", tip.replace("[0.2, 0.5]", goal).replace("1.8, 0.0", "1.7, 0.3"));
        place.write("world.toml", world);
        has(&place.certified("arm.urdf", "world.toml", "", code).1, &["from the start ("]);
    }
}
