//! Files that the URDF and the world refer to: pictures, line maps and meshes, compared with equivalent inline
//! descriptions.

use crate::common::robots::{gantry, two_bars};
use crate::common::verdict::{Verdict, done, fails, fails_with, found, holds, judge, refused, verdict};
use cplan_cases as random;
use cplan_cases::dice::Dice;
use cplan_check_files::{CheckError, Input, check, check_files};
use std::path::{Path, PathBuf};

const BOXES: [&str; 2] = [r#"<box size="1.0 0.1 0.1"/>"#, r#"<box size="0.8 0.1 0.2"/>"#];

/// Returns the arm of two bars with these geometries.
fn arm([upper, fore]: [&str; 2]) -> String {
    let arm = two_bars().replace(r#"<box size="1.0 0.1 0.1"/>"#, upper).replace(r#"<box size="0.8 0.1 0.1"/>"#, fore);
    arm.replace(r#"xyz="0.4 0 0""#, r#"xyz="0.4 0 0" rpy="0.3 0 0""#)
}

/// A separate folder for each test.
struct Place(PathBuf);

impl Place {
    fn new(name: &str) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("files_{name}"));
        std::fs::create_dir_all(&folder).unwrap();
        let place = Self(folder);
        place.write("arm.urdf", arm(BOXES));
        place
    }

    fn write(&self, file: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.0.join(file), content).unwrap();
    }

    fn judge(&self, world: &str, certificate: &str) -> Verdict {
        self.write("world.toml", world);
        self.write("c.json", certificate);
        let [urdf, world, certificate] = ["arm.urdf", "world.toml", "c.json"].map(|file| self.0.join(file));
        verdict(check_files(&urdf, &world, &certificate))
    }

    fn is_free(&self, world: &str, motion: &str) -> bool {
        let (code, why) = self.judge(world, motion);
        assert_ne!(code, 1, "{world}: {why}");
        code == 0
    }

    /// Asserts that a world is refused, with a message that has this part.
    #[track_caller]
    fn refuses(&self, world: &str, part: &str) {
        refused(self.judge(world, &straight_certificate([0.0; 2], [1.0; 2])), part);
    }
}

/// Returns the certificate of a straight motion.
fn straight_certificate(from: [f64; 2], to: [f64; 2]) -> String {
    let ([a, b], [c, d]) = (from, to);
    let ends = format!(r#""start": [{a}, {b}], "goal": [{c}, {d}],"#);
    found(&ends, r#""linear""#, &format!("[0, {a}, {b}], [1, {c}, {d}]"))
}

fn motion(dice: &mut Dice) -> String {
    let mut q = || [0; 2].map(|_| dice.within(-2.8, 2.8));
    straight_certificate(q(), q())
}
const YAML: &str = "# a map\nimage: \"map.pgm\"\nresolution: 0.4 # metres\norigin: [-1.2, -1, 0.3]\nnegate: 0\noccupied_thresh: 0.65\n\
                    free_thresh: 0.196\n";

/// Tests that pictures with random pixels allow the same motions as individual squares.
#[test]
fn a_picture_is_its_dark_squares() {
    let place = Place::new("picture");
    place.write("map.yaml", YAML);
    let mut free = 0;
    for seed in random::seeds(20) {
        let mut random = Dice::new(seed);
        let (width, height, most) = (1 + random.below(6), 1 + random.below(6), [1, 9, 255, 300][random.below(4)]);
        let shades: Vec<usize> =
            (0..width * height).map(|_| if random.below(4) == 0 { random.below(most + 1) } else { most }).collect();
        let is_text = random.below(2) == 0;
        let mut picture =
            format!("P{}\n# shades\n{width} {height}\n{most}\n", if is_text { 2 } else { 5 }).into_bytes();
        for shade in &shades {
            match (is_text, most > 255) {
                (true, _) => picture.extend(format!("{shade}\n").bytes()),
                (false, true) => picture.extend([(shade >> 8) as u8, *shade as u8]),
                (false, false) => picture.push(*shade as u8),
            }
        }
        place.write("map.pgm", &picture);
        // Pixels that are not light are solid, or those that are dark.
        let unknown = ["", "unknown = \"solid\"\n", "unknown = \"free\"\n"][random.below(3)];
        let is_solid = |shade: usize| {
            let dark = 1000 * (most - shade);
            if unknown.contains("free") { dark > 650 * most } else { dark >= 196 * most }
        };
        let pose = "at = [0.1, -0.2]\nangle = 0.5\n";
        let one = format!("[[obstacle]]\nimage = \"map.yaml\"\n{unknown}{pose}");
        let mut many = String::new();
        for (k, _) in shades.iter().enumerate().filter(|(_, shade)| is_solid(**shade)) {
            // The picture's frame within the obstacle's frame, computed by hand: both turn about their own corner.
            let corner = |x: usize, y: usize| {
                let (x, y, (sine, cosine)) = (0.4 * x as f64, 0.4 * y as f64, 0.3f64.sin_cos());
                [-1.2 + cosine * x - sine * y, -1.0 + sine * x + cosine * y]
            };
            let (x, y) = (k % width, height - 1 - k / width);
            let ring = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
            many += &format!("[[obstacle]]\npolygon = {ring:?}\n{pose}");
        }
        for _ in 0..4 {
            let motion = motion(&mut random);
            let verdicts = [&one, &many].map(|world| place.is_free(world, &motion));
            assert_eq!(verdicts[0], verdicts[1], "seed {seed}: {motion}");
            free += u64::from(verdicts[0]);
        }
    }
    assert!((random::times(8)..random::times(76)).contains(&free), "{free}");
}

/// Tests maps of map savers. They write 205 for unseen cells, together with a threshold that would make them free. They
/// also add keys of their own.
#[test]
fn unseen_cells_are_solid_for_any_free_thresh() {
    let place = Place::new("unseen");
    let yaml = YAML.replace("0.196", "0.25").replace("0.4", "10").replace("[-1.2, -1, 0.3]", "[-5, -5, 0]");
    let motion = straight_certificate([0.0, 0.5], [0.5, 1.0]);
    for (shade, most, negate, is_solid) in
        [(205, 255, 0, true), (206, 255, 0, false), (52_685, 65_535, 0, true), (50, 255, 1, true), (49, 255, 1, false)]
    {
        let negate = format!("negate: {negate}\nmap_type: occupancy");
        place.write("map.yaml", yaml.replace("negate: 0", &negate));
        place.write("map.pgm", format!("P2 1 1 {most} {shade}"));
        let free =
            |unknown| place.is_free(&format!("[[obstacle]]\nimage = \"map.yaml\"\nunknown = \"{unknown}\"\n"), &motion);
        assert_eq!([free("solid"), free("free")], [!is_solid, true], "{shade} of {most}");
    }
}

/// Tests boxes among pictures. The parts are rectangles of solid squares.
#[test]
fn a_part_of_a_picture_is_a_rectangle_of_solid_squares() {
    let place = Place::new("part");
    place.write("map.yaml", YAML.replace("0.3]", "0]").replace("[-1.2, -1,", "[0.2, -0.4,"));
    place.write("map.pgm", "P2 3 2 1 0 0 1 0 0 0");
    let of = |corners: &str| {
        place.judge(
            "start.joints = [1, 0]\ngoal.joints = [-1, 0]\nobstacle = [{ image = \"map.yaml\" }]",
            &format!(
                r#"{{"format": "cplan certificate 1", "answer": "infeasible", "shapes": [{{"link": "upper", "collision": 0}}],
                    "parts": [{{"obstacle": 0, "corners": {corners}}}],
                    "boxes": [{{"lower": [-0.1, -3], "upper": [0.1, 3], "shape": 0, "part": 0}}]}}"#
            ),
        )
    };
    for held in [
        "[[0.2, -0.4], [1, -0.4], [1, 0.4], [0.2, 0.4]]",
        // Any order, and approximate values.
        "[[1.01, 0.39], [0.21, 0.41], [1.0, -0.4], [0.2, -0.4]]",
    ] {
        holds(of(held));
    }
    let wrong = "rectangle of solid squares";
    for (corners, why) in [
        ("[[0.2, -0.4], [1.4, -0.4], [1.4, 0.4], [0.2, 0.4]]", wrong),
        ("[[-0.2, -0.4], [1, -0.4], [1, 0.4], [-0.2, 0.4]]", wrong),
        ("[[0.2, -0.4], [1, -0.4], [1, 0.4]]", wrong),
        ("[[0.2, -0.4], [1, -0.4], [0.6, 0.4], [0.2, 0.4]]", wrong),
        ("[[0.2, 0], [1, 0], [1, 0], [0.2, 0]]", wrong),
        ("[[0.2, 1e30], [1, 0], [1, 0], [0.2, 0]]", wrong),
        ("[[0.6, -0.4], [1.4, -0.4], [1.4, 0], [0.6, 0]]", "box 0"),
    ] {
        fails(of(corners), why);
    }
}

/// Tests that the walls of a line map are polylines in metres, and so is its frame. The goal is in the middle of its
/// rectangle.
#[test]
fn a_line_map_is_its_walls() {
    let place = Place::new("walls");
    let map = "2D-Map\nLineMinPos: -30 -25\nLineMaxPos: 30 25\nNumLines: 5\nLINES\n# a hook\n10 5 10 15\n10 15 5 15\n10 5 20 5\n\
               # a point, and another wall\n-15 10 -15 10\n-15 -10 -5 -10\nDATA\n";
    place.write("room.map", map);
    place.write(
        "wishes.map",
        "2D-Map\nLineMinPos: 0 0\nLineMaxPos: 9 9\nNumGoal: 1\nGOAL\n-28 -1 -26 3\nNumPoint: 0\nPOINTS\nEND\n",
    );
    let world = "[map]\nfile = \"room.map\"\npreferences = \"wishes.map\"\nscale = 0.1\noffset = [0.2, -0.1]\n";
    let same = "[[obstacle]]\npolyline = [[0.7, 1.4], [1.2, 1.4], [1.2, 0.4], [2.2, 0.4]]\n\
                [[obstacle]]\ncircle = { center = [-1.3, 0.9], radius = 1e-20 }\n\
                [[obstacle]]\npolyline = [[-1.3, -1.1], [-0.3, -1.1]]\n\
                [[obstacle]]\npolygon = [[-2.8, -2.6], [3.2, -2.6], [3.2, 2.4], [-2.8, 2.4]]\n\
                holes = [[[-2.8, -2.6], [3.2, -2.6], [3.2, 2.4], [-2.8, 2.4]]]\n";
    let mut free = 0;
    for seed in random::seeds(60) {
        let motion = motion(&mut Dice::new(seed));
        let verdicts = [world, same].map(|world| place.is_free(world, &motion));
        assert_eq!(verdicts[0], verdicts[1], "seed {seed}: {motion}");
        free += u64::from(verdicts[0]);
    }
    assert!((random::times(4)..random::times(56)).contains(&free), "{free}");
    // Obstacles are chains of walls, with the frame last.
    let named = |obstacle: usize, part: &str| {
        let certificate = format!(
            r#"{{"format": "cplan certificate 1", "answer": "infeasible", "start": [1, 0],
                "parts": [{{"obstacle": {obstacle}{part}}}], "shapes": [], "boxes": []}}"#
        );
        place.judge(world, &certificate)
    };
    // The tip does not reach as far as the goal, so only the parts are checked.
    let goal = place.judge(world, &straight_certificate([0.0; 2], [0.0; 2]).replace(", \"goal\": [0, 0]", ""));
    fails(goal, "misses the goal");
    fails(named(4, ""), "part 0: obstacle 4 does not exist");
    fails(named(3, ", \"corners\": [[-2.8, -2.6], [3.2, 2.4]]"), "part 0, of obstacle 3: the corners");
    // Steps override the goal of the preferences.
    let moving = format!("{world}[[step]]\nmove = {{ joints = [0, 0] }}\n");
    let goal = place.judge(&moving, &straight_certificate([0.0; 2], [0.0; 2]).replace(", \"goal\": [0, 0]", ""));
    refused(goal, "there is no goal");
    // Walls have names, so that they can support objects.
    for (name, is_one) in [
        ("room, lines 1 to 3", true),
        ("room, line 4", true),
        ("room, line 5", true),
        ("room, frame", true),
        ("room, line 1", false),
        ("room, lines 4 to 5", false),
    ] {
        let object = format!(
            "[[object]]\nname = \"nut\"\nat = [1, 1]\ncircle = {{ center = [0, 0], radius = 0.1 }}\nsupports = [\"{name}\"]\n\
             [[step]]\npick = \"nut\"\n"
        );
        let (code, why) = place.judge(&(world.to_owned() + &object), &straight_certificate([0.0; 2], [0.0; 2]));
        let is_refused = code == 1 && why.contains("no obstacle and no object of this name");
        assert_eq!(is_refused, !is_one, "{name}");
    }
    for (broken, part) in [
        (map.replace("NumLines: 5", "NumLines: 6"), "as many lines as NumLines says"),
        (map.replace("DATA", ""), "at its end: expected"),
        (map.replace("10 15 5", "10 15"), "line 8: expected"),
        (map.replace("2D", "3D"), "line 1: expected 2D-Map"),
        (format!("{map}1"), "nothing after DATA"),
    ] {
        place.write("room.map", broken);
        place.refuses(world, part);
    }
    place.refuses("[map]\nfile = \"none.map\"", "none.map cannot be read");
    place.refuses("[map]\nscale = 1", "the map has no file");
}

/// Tests the order of indices: the file's own obstacles, the walls of the map, then the objects at their initial poses.
#[test]
fn obstacles_are_numbered_before_walls_and_objects() {
    let place = Place::new("numbers");
    place.write("one.map", "2D-Map\nLineMinPos: 0 0\nLineMaxPos: 9 9\nNumLines: 1\nLINES\n-3 5 3 5\nDATA\n");
    let world = "start.joints = [2, 0]\ngoal.joints = [-1, 0]\n\
                 [[object]]\nname = \"block\"\nat = [0.5, 0]\ncircle = { center = [0, 0], radius = 0.3 }\n\
                 [map]\nfile = \"one.map\"\nscale = 0.1\nframe = false\n\
                 [[obstacle]]\npolyline = [[0.3, 0.3], [0.3, -0.3]]\n\
                 [[step]]\nmove = { joints = [-1, 0] }\n";
    let infeasible = |at: f64, part: &str| {
        let (low, high) = (at - 0.01, at + 0.01);
        let certificate = format!(
            r#"{{"format": "cplan certificate 1", "answer": "infeasible", "shapes": [{{"link": "upper", "collision": 0}}],
                "parts": [{{"obstacle": {part}}}],
                "boxes": [{{"lower": [{low}, -3], "upper": [{high}, 3], "shape": 0, "part": 0}}]}}"#
        );
        place.judge(world, &certificate)
    };
    holds(infeasible(0.0, "0, \"corners\": [[0.3, 0.3], [0.3, -0.3]]"));
    holds(infeasible(0.0, "2"));
    let wall = "\"corners\": [[-0.3, 0.5], [0.3, 0.5]]";
    holds(infeasible(1.56, &format!("1, {wall}")));
    for part in ["1", &format!("0, {wall}"), "3"] {
        fails(infeasible(0.0, part), "");
    }
}

/// Tests that an object given as an image collides exactly where the polygon of its solid squares does.
#[test]
fn a_picture_is_carried_as_its_squares_are() {
    let place = Place::new("carried");
    place.write("arm.urdf", gantry([-9, 9], "sphere radius=\"0.05\""));
    place.write("map.yaml", YAML.replace("[-1.2, -1, 0.3]", "[-0.4, -0.2, 0]"));
    place.write("map.pgm", "P2 3 2 1 0 0 1 0 1 1");
    let steps = r#"{"step": 1, "knots": [0, 1]}, {"step": 2, "knots": [2, 3]}"#;
    let motion = done("[0, 0, 1], [1, 1, 1], [2, 1, 1], [3, 3, 1]", steps);
    let shapes =
        ["image = \"map.yaml\"", "polygon = [[-0.4, -0.2], [0, -0.2], [0, 0.2], [0.4, 0.2], [0.4, 0.6], [-0.4, 0.6]]"];
    let mut free = 0;
    for seed in random::seeds(30) {
        let mut random = Dice::new(seed);
        let (x, y) = (random.within(0.5, 4.0), random.within(0.5, 2.0));
        let verdicts = shapes.map(|shape| {
            let world = format!(
                "robot.payload = \"level\"\nstart.joints = [0, 1]\n[[object]]\nname = \"block\"\nat = [1, 1]\nangle = 0.2\n{shape}\n\
                 [[step]]\npick = \"block\"\n[[step]]\nplace = {{ at = [3, 1] }}\n\
                 [[obstacle]]\ncircle = {{ center = [{x}, {y}], radius = 0.02 }}\n"
            );
            place.is_free(&world, &motion)
        });
        assert_eq!(verdicts[0], verdicts[1], "seed {seed}: {x} {y}");
        free += u64::from(verdicts[0]);
    }
    assert!((random::times(3)..random::times(27)).contains(&free), "{free}");
}

/// File format of a mesh.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Format {
    Bytes,
    Text,
    Obj,
    Collada,
}

/// Returns a box as triangles.
fn block(size: [f32; 3], format: Format) -> Vec<u8> {
    let corner = |k: usize| [0, 1, 2].map(|i| if k >> i & 1 == 0 { -size[i] / 2.0 } else { size[i] / 2.0 });
    let spaced = |k: usize, by: [f32; 3]| {
        let corner = corner(k);
        [0, 1, 2].map(|i| format!("{:e}", corner[i] + by[i])).join(" ")
    };
    let faces = [[0, 1, 3], [0, 3, 2], [4, 5, 7], [4, 7, 6], [0, 2, 4], [1, 3, 5], [2, 6, 4], [3, 7, 5]];
    let triangles = faces.map(|face| face.map(corner));
    if format == Format::Obj {
        // A far vertex that belongs to no face.
        let vertices: String = (0..8).map(|k| format!("v {}\n", spaced(k, [0.0; 3]))).collect();
        let faces: String = faces.iter().map(|[a, b, c]| format!("f {} -{} {}/7/7\n", a + 1, 9 - b, c + 1)).collect();
        return format!("# a block\n{vertices}v 99 99 99\n{faces}").into_bytes();
    }
    if format == Format::Collada {
        // The axes differ in the file, and a transformation moves the mesh elsewhere. A far vertex belongs to no
        // triangle.
        let numbers: Vec<String> = (0..8).map(|k| spaced(k, [0.25, 0.5, -0.5])).chain(["99 99 99".into()]).collect();
        let indices: Vec<String> = faces.iter().flatten().map(|corner| format!("0 {corner}")).collect();
        return format!(
            r##"<COLLADA> <asset> <unit meter="0.5"/> </asset>
            <geometry id="g"> <mesh>
              <source id="s"> <float_array id="a"><!-- x, y, z -->{}</float_array> <technique_common>
                <accessor source="#a" count="9" stride="3"> <param name="X"/> <param name="Y"/> <param name="Z"/> </accessor>
              </technique_common> </source>
              <vertices id="w"> <input semantic="POSITION" source="#s"/> </vertices>
              <triangles count="8"> <input semantic="NORMAL" offset="0"/> <input semantic="VERTEX" source="#w" offset="1"/>
                <p>{}</p> </triangles>
            </mesh> </geometry>
            <node id="n"> <translate>-0.25 -0.5 0.5</translate> <instance_geometry url="#g"/> </node>
            <visual_scene id="v"> <node> <scale>2 2 2</scale> <rotate>0 0 9 90</rotate>
              <matrix>0 1 0 0 -1 0 0 0 0 0 1 0 0 0 0 1</matrix> <instance_node url="#n"/> </node> </visual_scene>
            <scene> <instance_visual_scene url="#v"/> </scene> </COLLADA>"##,
            numbers.join(" "),
            indices.join(" ")
        )
        .into_bytes();
    }
    if format == Format::Bytes {
        let mut bytes = b"solid in name only".to_vec();
        bytes.resize(80, 0);
        bytes.extend((triangles.len() as u32).to_le_bytes());
        for triangle in triangles {
            bytes.extend([0; 12]);
            bytes.extend(triangle.iter().flatten().flat_map(|c| c.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        return bytes;
    }
    let facet = |t: &[[f32; 3]; 3]| {
        let vertices: Vec<String> = t.iter().map(|[x, y, z]| format!("vertex {x:e} {y} {z}")).collect();
        format!("facet normal 0 0 1\nouter loop\n{}\nendloop\nendfacet\n", vertices.join("\n"))
    };
    format!("solid block\n{}endsolid block\n", triangles.iter().map(facet).collect::<String>()).into_bytes()
}

/// Tests that a mesh is replaced by its convex hull. The hull of a box is the box. The sizes are exact in single
/// precision.
#[test]
fn a_mesh_is_its_hull() {
    let place = Place::new("mesh");
    let sizes = [[1.0, 0.125, 0.125], [0.75, 0.125, 0.25]];
    let boxes = sizes.map(|[x, y, z]: [f32; 3]| format!("<box size=\"{x} {y} {z}\"/>"));
    std::fs::create_dir_all(place.0.join("package/meshes")).unwrap();
    let world = "robot.own_body = false\n[[obstacle]]\npolygon = [[0.7, 0.9], [1.2, 0.8], [1, 1.3]]\nheight = [-0.1, 0.15]\n[[obstacle]]\n\
                 circle = { center = [-0.9, -0.9], radius = 0.2 }\n[[obstacle]]\npolyline = [[0.5, -1.6], [0.3, -1.9]]\nheight = [0.1, 1]\n";
    let mut free = 0;
    let ends =
        [Format::Bytes, Format::Text, Format::Obj, Format::Collada].into_iter().zip(["STL", "stl", "obj", "dae"]);
    for (format, end) in ends {
        let [upper, fore] = [format!("package/meshes/upper.{end}"), format!("fore.{end}")];
        place.write(&upper, block(sizes[0], format));
        place.write(&fore, block(sizes[1].map(|c| 1000.0 * c), format));
        let meshes = [
            format!(r#"<mesh filename="package://{upper}"/>"#),
            format!(r#"<mesh filename="{fore}" scale="0.001 -0.001 0.001"/>"#),
        ];
        let meshes = meshes.each_ref().map(String::as_str);
        for seed in random::seeds(60) {
            let motion = motion(&mut Dice::new(seed));
            let verdicts = [arm(boxes.each_ref().map(String::as_str)), arm(meshes)].map(|urdf| {
                place.write("arm.urdf", urdf);
                place.is_free(world, &motion)
            });
            assert_eq!(verdicts[0], verdicts[1], "seed {seed}: {motion}");
            free += u64::from(verdicts[0]);
        }
    }
    assert!((random::times(20)..random::times(220)).contains(&free), "{free}");
    for (file, content, part) in [
        ("fore.stl", &b"solid x vertex 1 2"[..], "not an STL file"),
        ("fore.stl", b"solid x", "not an STL file"),
        ("fore.stl", b"solid x\nendsolid x", "no corners"),
        ("fore.stl", b"solid vertex 1 2 3\nendsolid", "no corners"),
        (
            "fore.stl",
            b"solid\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3e99\nvertex 1 2 3\nvertex 1 2 4\nendloop\nendfacet\nendsolid",
            "not finite",
        ),
        (
            "fore.stl",
            b"solid\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3\nvertex 1 2 3\nvertex 1 2 4\nendloop\nendfacet",
            "not an STL file",
        ),
        ("fore.stl", b"PK", "not an STL file"),
        ("fore.obj", b"v 1 2\nf 1", "three numbers"),
        ("fore.obj", b"f 1 2 3\nv 1 2 3", "is not defined before it"),
        ("fore.obj", b"v 1 2 3\nf 1 -2", "is not defined before it"),
        ("fore.obj", b"v 1 2 3\n", "no corners"),
        ("fore.dae", b"<html/>", "not Collada"),
        ("fore.dae", b"<COLLADA/>", "no mesh"),
        ("fore.dae", b"<COLLADA><asset><unit meter=\"0\"/></asset></COLLADA>", "is not a positive length"),
        (
            "fore.dae",
            b"<COLLADA><visual_scene><node id=\"n\"><instance_node url=\"#n\"/></node></visual_scene></COLLADA>",
            "contains itself",
        ),
        ("fore.dae", b"<COLLADA><visual_scene><node><lookat>0</lookat></node></visual_scene></COLLADA>", "<lookat>"),
        (
            "fore.dae",
            b"<COLLADA><visual_scene><instance_geometry url=\"#g\"/></visual_scene></COLLADA>",
            "is not in the file",
        ),
    ] {
        place.write(file, content);
        place.write("arm.urdf", arm([BOXES[0], &format!("<mesh filename=\"{file}\"/>")]));
        place.refuses(world, part);
    }
    for (mesh, part) in [
        ("fore.ply", "reads only meshes in STL, OBJ and Collada"),
        ("none.stl", "does not exist"),
        ("package://none/a.stl", "does not exist"),
    ] {
        place.write("arm.urdf", arm([BOXES[0], &format!("<mesh filename=\"{mesh}\"/>")]));
        place.refuses(world, part);
    }
}

#[test]
fn invalid_pictures_are_refused() {
    let place = Place::new("refused");
    let world = "obstacle = [{ image = \"map.yaml\" }]";
    place.write("map.pgm", "P2 1 1 1 0");
    for (from, to, part) in [
        ("map.pgm", "none.pgm", "none.pgm cannot be read"),
        ("resolution: 0.4", "resolution: 0", "resolution positive"),
        ("resolution: 0.4", "resolution: 1e-300", "resolution positive"),
        ("0.65", "0.1", "free_thresh not the greater"),
        ("0.65", "x", "\"x\" is not a decimal number"),
        ("[-1.2, -1, 0.3]", "[-1.2, -1]", "origin must be a list"),
        ("[-1.2, -1, 0.3]", "", "origin must be a list"),
        ("negate: 0", "negate: 2", "negate is neither"),
        ("negate: 0\n", "", "negate"),
        ("negate: 0", "negate: 0\nmode: raw", "trinary and scale"),
        ("negate: 0", "negate: 0\nnegate: 0", "duplicate mapping key: negate"),
        ("negate: 0", "colour: 0", "negate"),
    ] {
        place.write("map.yaml", YAML.replace(from, to));
        place.refuses(world, part);
    }
    place.write("map.yaml", YAML);
    for (picture, part) in [
        (&b"\x89PNG"[..], "unexpected end"),
        (b"GIF89a", "only PGM"),
        (b"P2 2 1 1 0", "ends early"),
        (b"P2 1 1 1 0 0", "continues after the last pixel"),
        (b"P2 1 1 1 2", "is above maxval"),
        (b"P2 1 1 0 0", "maxval is 0"),
        (b"P2 0 1 1", "the picture is empty or too large"),
        (b"P2 99999999999 99999999999 1", "too large"),
        (b"P5 2 2 255\nabc", "ends early"),
        (b"P5 1 1 255\nabc", "continues after the last pixel"),
        (b"P5 ", "is not a number"),
        (b"P5", "the header of the picture is not valid"),
        (b"P23 3 1", "the header of the picture is not valid"),
    ] {
        place.write("map.pgm", picture);
        place.refuses(world, part);
    }
    // Texts have no other files beside them. This does not matter if nothing refers to the picture.
    let text = format!("start.joints = [0, 0]\ngoal.joints = [1, 0]\n{world}");
    let one = |certificate: &str| check(&arm(BOXES), &text, certificate);
    let motion = straight_certificate([0.0; 2], [1.0, 0.0]);
    assert!(matches!(one(&motion), Err(CheckError::Input { input: Input::World, .. })));
    let nothing =
        r#"{"format": "cplan certificate 1", "answer": "infeasible", "shapes": [], "parts": [], "boxes": []}"#;
    fails(verdict(one(nothing)), "");
}

/// Tests that digests bind a certificate to its files. The digests here were computed by `sha256sum`.
#[test]
fn digests_are_of_the_files_themselves() {
    let of = |digests: &str| {
        let certificate = straight_certificate([0.0; 2], [1.0; 2]).replacen('{', &format!("{{{digests},"), 1);
        judge(&arm(BOXES), "name = \"w\"\n", &certificate)
    };
    let world = "0b9a8b8a";
    fails_with(of(&format!("\"world\": \"{world}\"")), &["another world", world]);
    holds(of(&format!("\"world\": \"{WORLD_DIGEST}\", \"others\": []")));
    holds(of(&format!("\"world\": \"{}\"", WORLD_DIGEST.to_uppercase())));
    fails(of(&format!("\"urdf\": \"{WORLD_DIGEST}\"")), "");
    refused(of("\"world\": 7"), "");
    // If the certificate lists other files, all files in use must be among them.
    let place = Place::new("digests");
    place.write("map.pgm", "P2 1 1 1 1\n");
    place.write("map.yaml", YAML);
    let of = |others: &str| {
        let certificate =
            straight_certificate([0.0; 2], [1.0; 2]).replacen('{', &format!("{{\"others\": {others},"), 1);
        place.judge("obstacle = [{ image = \"map.yaml\" }]", &certificate)
    };
    fails(of("[]"), "map.yaml");
    fails(of(&format!("[\"{YAML_DIGEST}\"]")), "map.pgm");
    holds(of(&format!("[\"{PICTURE_DIGEST}\", \"{YAML_DIGEST}\"]")));
}

const WORLD_DIGEST: &str = "207c0e720147753bd6c80e3fd9dd46384e4d1605d612d2e115c2567d2a3a81b3";
const YAML_DIGEST: &str = "7f79ebd3f81f4c41ccddd40751f86032f6b8c85f51fefdf28b2326c8b55bdd5c";
const PICTURE_DIGEST: &str = "4eccf4a9ff7386194b6c726b72219d047c04ff3dd63c142edabaf540ca799329";
