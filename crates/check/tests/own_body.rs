//! The robot's own body: links that stand still are in the way of those that move, in layers where they are meshes.

use cplan_check::{CheckError, check, check_files};
use std::path::{Path, PathBuf};

/// The base is 0.4 m by 0.3 m and 0.3 m high. The upper arm is on it, the forearm on that, with a quill that reaches down to a height.
fn scara(lowest: f64) -> String {
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

/// A link beside the base.
fn beside(scara: &str, kind: &str, shape: &str) -> String {
    let joint = format!(
        r#"<joint name="c" type="{kind}"> <parent link="base"/> <child link="box"/> <limit lower="-1" upper="1"/> </joint>"#
    );
    scara.replace("</robot>", &format!("{joint} <link name=\"box\"> {shape} </link> </robot>"))
}

fn world(robot: &str) -> String {
    format!("[robot]\n{robot}\n[start]\njoints = [-1, 0]\n[goal]\njoints = [-1, 2.8]\n")
}

/// Folds the arm: the quill comes to the axis of the base as near as 0.17 m.
fn folded(extra: &str) -> String {
    format!(
        r#"{{"format": "cplan certificate 1", "answer": "found", {extra}
            "motion": {{"interpolation": ["linear"], "knots": [[0, -1, 0], [1, -1, 2.8]]}}}}"#
    )
}

/// By its exit code, and what is said.
fn told(verdict: Result<String, CheckError>) -> (i32, String) {
    match verdict {
        Ok(said) => (0, said),
        Err(CheckError::Fails(why)) => (3, why),
        Err(CheckError::Input { message, .. }) => (1, message),
    }
}

fn judged(urdf: &str, robot: &str, certificate: &str) -> (i32, String) {
    told(check(urdf, &world(robot), certificate))
}

#[track_caller]
fn holds((code, said): (i32, String)) -> String {
    assert_eq!(code, 0, "{said}");
    said
}

#[track_caller]
fn fails((code, said): (i32, String), parts: &[&str]) {
    assert!(code == 3 && parts.iter().all(|part| said.contains(part)), "{code} {said}");
}

const HIT: [&str; 3] = ["from knot 0", "link \"quill\", collision 0", "link \"base\", collision 0"];

/// Heights that touch are no contact within a robot; with obstacles they are.
#[test]
fn a_base_is_hit_and_passed_over() {
    let fold = |lowest: f64| judged(&scara(lowest), "", &folded(""));
    fails(fold(0.1), &HIT);
    fails(fold(0.2999), &HIT);
    for over in [0.3, 0.31] {
        holds(fold(over));
    }
    // An obstacle in the place of the base, as high.
    let bare = scara(0.3).replacen("<collision>", "<lamp>", 1).replacen("</collision>", "</lamp>", 1);
    let block = "[[obstacle]]\npolygon = [[-0.2, -0.15], [0.2, -0.15], [0.2, 0.15], [-0.2, 0.15]]\n";
    let among = |heights: &str| told(check(&bare, &format!("{}{block}{heights}", world("")), &folded("")));
    fails(among("height = [0, 0.3]"), &["obstacle 0"]);
    // The upper arm is higher than 0.25 m, and no neighbour of an obstacle.
    holds(among("height = [0, 0.24]"));
    // Where it folds less it stays off, by less than a clearance.
    let turned = |extra: &str| judged(&scara(0.1), "", &folded(extra).replace("2.8]]", "2.2]]"));
    holds(turned(r#""goal": [-1, 2.2],"#));
    fails(turned(r#""goal": [-1, 2.2], "clearance": 0.3,"#), &HIT);
}

/// The base moves with the robot.
#[test]
fn a_base_stands_where_the_world_puts_the_robot() {
    for at in ["", "at = [3, -2]", "at = [3, -2]\nangle = \"70deg\""] {
        fails(judged(&scara(0.1), at, &folded("")), &HIT);
        holds(judged(&scara(0.31), at, &folded("")));
    }
}

#[test]
fn the_world_says_which_links_may_meet() {
    let said = |robot: &str| judged(&scara(0.1), robot, &folded(""));
    holds(said("own_body = false"));
    fails(said("own_body = true"), &HIT);
    for pair in ["[\"base\", \"quill\"]", "[\"quill\", \"base\"]"] {
        holds(said(&format!("ignore_contact = [{pair}]")));
    }
    fails(said("ignore_contact = [[\"base\", \"fore\"], [\"upper\", \"quill\"]]"), &HIT);
    for (robot, part) in [
        ("ignore_contact = [[\"base\", \"hand\"]]", "no link \"hand\""),
        ("ignore_contact = [[\"base\"]]", "a list of two"),
        ("ignore_contact = [[\"base\", 1]]", "expected a text"),
        ("own_body = 1", "true or false"),
    ] {
        let (code, why) = said(robot);
        assert!(code == 1 && why.contains(part), "{robot}: {why}");
    }
}

/// The upper arm is in the base all the time, as neighbours are. What has no shape is between none.
#[test]
fn neighbours_may_meet() {
    let sunk = scara(0.31).replacen("size=\"0.4 0.3 0.3\"", "size=\"0.4 0.3 0.6\"", 1);
    // Up to 0.45 m high it is in the way of quill and upper arm, and not of the forearm.
    fails(judged(&sunk, "", &folded("")), &["link \"quill\""]);
    holds(judged(&sunk, "ignore_contact = [[\"base\", \"quill\"]]", &folded("")));
    let higher = sunk.replacen("0.4 0.3 0.6", "0.4 0.3 0.62", 1);
    let ignored = "ignore_contact = [[\"base\", \"quill\"]]";
    fails(judged(&higher, ignored, &folded("")), &["link \"fore\", collision 0", "link \"base\""]);
    // Without its shape nothing is between base and forearm.
    let bare = higher.replacen("size=\"0.6 0.1 0.2\"", "size=\"0 0 0\"", 1);
    holds(judged(&bare, ignored, &folded("")));
    // A link beside the base is no neighbour of the upper arm, because the base is between.
    let shape =
        r#"<collision> <origin xyz="0.1 -0.2 0.35"/> <geometry> <sphere radius="0.05"/> </geometry> </collision>"#;
    fails(judged(&beside(&scara(0.31), "fixed", shape), "", &folded("")), &["link \"upper\"", "link \"box\""]);
    // Where a joint of its own moves it, it is not known to be there.
    holds(judged(&beside(&scara(0.31), "prismatic", shape), "joints = [\"a\", \"b\"]", &folded("")));
}

/// The visual shapes of a link count where it has no others, whatever other links have; what is not read of the base is said to be left out.
#[test]
fn each_link_has_its_visual_shapes_by_itself() {
    let of = |link: &str, urdf: &str| {
        let (before, after) = urdf.split_once(&format!("<link name=\"{link}\">")).unwrap();
        let (own, after) = after.split_once("</link>").unwrap();
        format!("{before}<link name=\"{link}\">{}</link>{after}", own.replace("collision", "visual"))
    };
    let seen = of("quill", &of("base", &scara(0.1)));
    fails(judged(&seen, "", &folded("")), &["link \"quill\", visual 0", "link \"base\", visual 0"]);
    let both = seen.replace(
        "<link name=\"quill\">",
        "<link name=\"quill\"> <collision> <geometry> <sphere radius=\"0.01\"/> </geometry> </collision>",
    );
    // Of the quill there is a small ball left, 0.05 m above the plate that the robot stands on.
    fails(judged(&both, "", &folded("")), &["link \"quill\", collision 0"]);
    holds(judged(&both.replace("<sphere radius=\"0.01\"/>", "<box size=\"0 0 0\"/>"), "own_body = false", &folded("")));
    let unread = |link: &str, kind: &str, urdf: &str| {
        let mesh = format!("<{kind}> <geometry> <mesh filename=\"none.stl\"/> </geometry> </{kind}>");
        urdf.replace(&format!("<link name=\"{link}\">"), &format!("<link name=\"{link}\">{mesh}"))
    };
    let said = holds(judged(&unread("base", "collision", &scara(0.31)), "", &folded("")));
    assert!(said.contains("collision of link \"base\" is left out"), "{said}");
    // The other shape of the base is still there.
    fails(judged(&unread("base", "collision", &scara(0.1)), "", &folded("")), &HIT);
    let said = holds(judged(&unread("quill", "visual", &of("quill", &scara(0.31))), "", &folded("")));
    assert!(said.contains("visual of link \"quill\" is left out"), "{said}");
    let (code, why) = judged(&unread("quill", "collision", &scara(0.31)), "", &folded(""));
    assert!(code == 1 && why.contains("other files"), "{why}");
}

/// A certificate may say that links always meet; where its motion begins they have to.
#[test]
fn a_pair_that_does_not_meet_is_not_ignored() {
    let ignored = r#""ignored": [["base", "quill"]],"#;
    let why = "not seen to meet where the motion begins";
    fails(judged(&scara(0.1), "", &folded(ignored)), &["\"base\" and \"quill\"", why]);
    let plate = scara(0.1).replacen("size=\"0.4 0.3 0.3\"", "size=\"4 4 0.3\"", 1);
    fails(judged(&plate, "", &folded("")), &HIT);
    for pair in [ignored, r#""ignored": [["quill", "base"]],"#] {
        let said = holds(judged(&plate, "", &folded(pair)));
        assert!(
            said.contains("and \"quill\" is taken to be meant") || said.contains("and \"base\" is taken to be meant"),
            "{said}"
        );
    }
    let below = plate.replacen("xyz=\"0 0 0.15\"", "xyz=\"0 0 -0.1\"", 1);
    fails(judged(&below, "", &folded(ignored)), &[why]);
    fails(judged(&plate, "", &folded(r#""ignored": [["base", "hand"]],"#)), &[why]);
    fails(judged(&plate, "", &folded(r#""ignored": [["fore", "quill"]],"#)), &[why]);
}

/// The elbow cannot be folded past where the quill is in a round base, whatever the shoulder does.
fn shut(shape: &str, part: &str) -> String {
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

const LIMITS: &str = "limits = { a = [-0.5, 0.5] }";
const QUILL: &str = r#"{"link": "quill", "collision": 0}"#;
const BASE: &str = r#"{"own": "base", "collision": 0}"#;

fn round(lowest: f64) -> String {
    scara(lowest).replacen("<box size=\"0.4 0.3 0.3\"/>", "<cylinder radius=\"0.3\" length=\"0.3\"/>", 1)
}

#[test]
fn proofs_name_links_that_stand_still() {
    let certificate = shut(QUILL, BASE);
    holds(judged(&round(0.1), LIMITS, &certificate));
    holds(judged(&round(0.1), &format!("{LIMITS}\nat = [1, 1]\nangle = 2"), &certificate));
    holds(judged(
        &round(0.1).replacen("collision", "visual", 2),
        LIMITS,
        &certificate.replace("base\", \"collision", "base\", \"visual"),
    ));
    for (lowest, robot, shape, part, why) in [
        (0.3, "", QUILL, BASE, "passes over or under"),
        (0.1, "own_body = false", QUILL, BASE, "no collision shape number 0"),
        (0.1, "ignore_contact = [[\"quill\", \"base\"]]", QUILL, BASE, "may meet link \"base\""),
        (0.1, "", r#"{"link": "upper", "collision": 0}"#, BASE, "may meet link \"base\""),
        (0.1, "", QUILL, r#"{"own": "base", "collision": 1}"#, "no collision shape number 1"),
        (0.1, "", QUILL, r#"{"own": "base", "visual": 0}"#, "no visual shape"),
        (0.1, "", QUILL, r#"{"own": "fore", "collision": 0}"#, "link \"fore\" has no"),
        (0.1, "", QUILL, r#"{"obstacle": 0}"#, "no obstacle 0"),
    ] {
        fails(judged(&round(lowest), &format!("{LIMITS}\n{robot}"), &shut(shape, part)), &[why]);
    }
    for part in [
        "{}",
        r#"{"own": "base"}"#,
        r#"{"own": "base", "obstacle": 0}"#,
        r#"{"own": "base", "collision": 0, "corners": []}"#,
    ] {
        let (code, why) = judged(&round(0.1), LIMITS, &shut(QUILL, part));
        assert_eq!(code, 1, "{part}: {why}");
    }
    // A smaller base leaves way.
    let small = round(0.1).replacen("radius=\"0.3\"", "radius=\"0.2\"", 1);
    fails(judged(&small, LIMITS, &certificate), &["can come off"]);
}

/// A folder of its own for each test, with blocks as meshes.
struct Place(PathBuf);

/// Blocks, each by its corners with the least and the greatest coordinates.
type Blocks<'a> = &'a [[[f32; 3]; 2]];

/// The corners of blocks, and the sides as four of them.
fn sides(blocks: Blocks) -> Vec<[[f32; 3]; 4]> {
    let side = |[low, high]: &[[f32; 3]; 2], axis: usize, end: usize| {
        [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[u, v]| {
            let mut corner = [0.0; 3];
            for (k, which) in [(axis, end), ((axis + 1) % 3, u), ((axis + 2) % 3, v)] {
                corner[k] = [low, high][which][k];
            }
            corner
        })
    };
    let six = |block| (0..6).map(move |k| side(block, k / 2, k % 2));
    blocks.iter().flat_map(six).collect()
}

impl Place {
    fn new(name: &str) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("own_body_{name}"));
        std::fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    /// Writes blocks as `name.stl`, `name_text.stl` and `name.obj`.
    fn write(&self, name: &str, blocks: Blocks) {
        let sides = sides(blocks);
        let triangles = sides.iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect::<Vec<_>>();
        let mut bytes = vec![0; 80];
        bytes.extend((triangles.len() as u32).to_le_bytes());
        let mut text = "solid\n".to_owned();
        for triangle in &triangles {
            bytes.extend([0; 12]);
            bytes.extend(triangle.iter().flat_map(|corner| corner.iter()).flat_map(|c| c.to_le_bytes()));
            bytes.extend([0; 2]);
            let corners: String = triangle.iter().map(|[x, y, z]| format!("vertex {x} {y} {z}\n")).collect();
            text += &format!("facet normal 0 0 1\nouter loop\n{corners}endloop\nendfacet\n");
        }
        let vertices: String = sides.iter().flatten().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
        let faces: String =
            (0..sides.len()).map(|k| 4 * k).map(|k| format!("f {} {} {} {}\n", k + 1, k + 2, k + 3, k + 4)).collect();
        std::fs::write(self.0.join(format!("{name}.stl")), bytes).unwrap();
        std::fs::write(self.0.join(format!("{name}_text.stl")), text + "endsolid\n").unwrap();
        std::fs::write(self.0.join(format!("{name}.obj")), vertices + &faces).unwrap();
    }

    fn judged(&self, urdf: &str, world: &str, certificate: &str) -> (i32, String) {
        let files = [("arm.urdf", urdf), ("world.toml", world), ("c.json", certificate)];
        let [urdf, world, certificate] = files.map(|(file, content)| {
            std::fs::write(self.0.join(file), content).unwrap();
            self.0.join(file)
        });
        told(check_files(&urdf, &world, &certificate))
    }
}

/// A base with a foot that is wider than the column on it.
const FOOTED: Blocks = &[[[-0.4, -0.4, 0.0], [0.4, 0.4, 0.125]], [[-0.0625, -0.0625, 0.125], [0.0625, 0.0625, 0.25]]];

fn of_mesh(lowest: f64, file: &str) -> String {
    let urdf = scara(lowest).replacen("<box size=\"0.4 0.3 0.3\"/>", &format!("<mesh filename=\"{file}\"/>"), 1);
    urdf.replacen("<origin xyz=\"0 0 0.15\"/>", "", 1)
}

/// The quill passes over the foot, and beside the column: the hull of the whole base would be in its way.
#[test]
fn meshes_are_cut_in_layers() {
    let place = Place::new("layers");
    place.write("base", FOOTED);
    for file in ["base.stl", "base_text.stl", "base.obj"] {
        let fold = |lowest: f64, robot: &str| place.judged(&of_mesh(lowest, file), &world(robot), &folded(""));
        // The lower end of the quill is where the base is cut.
        holds(fold(0.2, ""));
        holds(fold(0.13, ""));
        fails(fold(0.12, ""), &["link \"quill\", collision 0", "link \"base\", collision 0, layer 1"]);
        fails(fold(0.05, ""), &["layer 1"]);
        // What is as high as the corners of the foot is at both sides of the cut.
        fails(fold(0.125, ""), &["layer 1"]);
        holds(fold(0.05, "own_body = false"));
        fails(fold(0.05, "ignore_contact = [[\"base\", \"fore\"]]"), &["layer 1"]);
    }
    // At its full height it is in the way of the upper arm, were that no neighbour of it.
    let (code, why) =
        place.judged(&of_mesh(0.2, "base.obj"), &world(""), &folded(r#""ignored": [["upper", "base"]],"#));
    assert!(code == 3 && why.contains("not seen to meet"), "{why}");
}

/// A layer goes by a height in it.
#[test]
fn proofs_name_layers() {
    let place = Place::new("named");
    place.write("base", FOOTED);
    let shut = |lowest: f64, part: &str| place.judged(&of_mesh(lowest, "base.stl"), &world(LIMITS), &shut(QUILL, part));
    let own = |height: &str| format!(r#"{{"own": "base", "collision": 0{height}}}"#);
    holds(shut(0.05, &own(r#", "height": 0.1"#)));
    fails(shut(0.05, &own("")), &["has several layers: it needs a height"]);
    fails(shut(0.05, &own(r#", "height": 0.03"#)), &["passes over or under"]);
    fails(shut(0.05, &own(r#", "height": 0.3"#)), &["no collision shape number 0"]);
    fails(shut(0.2, &own(r#", "height": 0.22"#)), &["can come off"]);
    // Higher than the base all of it is one layer.
    fails(shut(0.3, &own("")), &["passes over or under"]);
    // Lower than the base, too: then nothing cuts it, and its height says no more.
    holds(shut(-0.1, &own("")));
    holds(shut(-0.1, &own(r#", "height": 0.1"#)));
}

/// Links that move are cut where the base begins and ends, for obstacles as well.
#[test]
fn layers_are_those_for_obstacles_too() {
    let place = Place::new("moving");
    // A bar, and at its end a quill that is as wide and reaches down.
    place.write("fore", &[[[-0.05, -0.05, 0.0], [0.45, 0.05, 0.1]], [[0.4, -0.05, -0.4], [0.45, 0.05, 0.0]]]);
    let (before, after) =
        scara(0.4).split_once("<link name=\"fore\">").map(|(a, b)| (a.to_owned(), b.to_owned())).unwrap();
    let (_, after) = after.split_once("</link>").unwrap();
    let fore = r#"<collision> <geometry> <mesh filename="fore.obj"/> </geometry> </collision>"#;
    let urdf = format!("{before}<link name=\"fore\">{fore}</link>{after}");
    // Stretched out, the bar is above the post all the time; the hull of bar and quill is not.
    let post = "[[obstacle]]\ncircle = { center = [0.7, 0], radius = 0.05 }\nheight = [0, 0.25]\n";
    let turned = r#"{"format": "cplan certificate 1", "answer": "found", "start": [-0.5, 0], "goal": [0.5, 0],
        "motion": {"interpolation": ["linear"], "knots": [[0, -0.5, 0], [1, 0.5, 0]]}}"#;
    let low = urdf.replacen("0.4 0.3 0.3", "0.1 0.1 0.3", 1);
    let among = |robot: &str, post: &str| place.judged(&low, &format!("{}{post}", world(robot)), turned);
    holds(among("", post));
    fails(among("", &post.replace("0.7,", "0.9,")), &["link \"fore\", collision 0, layer 0", "obstacle 0"]);
    fails(among("own_body = false", post), &["link \"fore\", collision 0 is", "obstacle 0"]);
    // Higher than the base the quill is in the same layer as the bar.
    fails(among("", &post.replace("0.25]", "0.31]")), &["layer 1", "obstacle 0"]);
}

/// What is carried is kept apart from all links that stand still.
#[test]
fn what_is_carried_stays_off_the_base() {
    let base = r#"<link name="base"> <collision> <origin xyz="2 0.87 0"/> <geometry> <sphere radius="0.04"/> </geometry> </collision> </link>"#;
    let gantry = format!(
        r#"<robot name="g"> {base}
  <joint name="x" type="prismatic">
    <parent link="base"/> <child link="bridge"/> <axis xyz="1 0 0"/> <limit lower="-9" upper="9"/>
  </joint>
  <link name="bridge"> <collision> <geometry> <box size="0.02 0.02 0.02"/> </geometry> </collision> </link>
  <joint name="y" type="prismatic">
    <parent link="bridge"/> <child link="head"/> <axis xyz="0 1 0"/> <limit lower="-9" upper="9"/>
  </joint>
  <link name="head"> <collision> <geometry> <box size="0.1 0.1 0.1"/> </geometry> </collision> </link> </robot>"#
    );
    let carried = |size: &str, robot: &str| {
        let world = format!(
            "robot = {{ payload = \"level\", wrist = {{ velocity = 1 }}, {robot} }}\nstart.joints = [0, 1]\n[[object]]\nname = \"block\"\nat = [1, 1]\n\
             polygon = [[-0.2, -{size}], [0.2, -{size}], [0.2, 0.1], [-0.2, 0.1]]\nheight = [0.02, 0.04]\n\
             [[step]]\npick = \"block\"\n[[step]]\nplace = {{ at = [3, 1] }}\n"
        );
        let certificate = r#"{"format": "cplan certificate 1", "answer": "found",
            "steps": [{"step": 1, "knots": [0, 1]}, {"step": 2, "knots": [2, 3]}],
            "motion": {"interpolation": ["linear"], "knots": [[0, 0, 1], [1, 1, 1], [2, 1, 1], [3, 3, 1]]}}"#;
        told(check(&gantry, &world, certificate))
    };
    holds(carried("0.08", ""));
    fails(carried("0.1", ""), &["step 2", "what is carried", "link \"base\", collision 0"]);
    holds(carried("0.1", "own_body = false"));
    fails(carried("0.1", "ignore_contact = [[\"base\", \"head\"]]"), &["what is carried"]);
}

/// A bar stands in for a link, and is kept apart as that.
#[test]
fn bars_are_kept_apart() {
    let bare = scara(0.2).replacen("<collision>", "<lamp>", 4).replacen("</collision>", "</lamp>", 4);
    let base = bare
        .replacen("lamp>", "collision>", 1)
        .replacen("</lamp>", "</collision>", 1)
        .replace("0.45 0 -0.45", "0.45 0 0");
    let high = |height: &str| base.replacen("0.4 0.3 0.3", height, 1);
    // The bar of the forearm is 0.4 m to 0.5 m high, and goes to the quill.
    fails(judged(&high("0.4 0.3 0.7"), "bar = 0.05", &folded("")), &["the bar of link \"fore\"", "link \"base\""]);
    holds(judged(&high("0.4 0.3 0.4"), "bar = 0.05", &folded("")));
}
