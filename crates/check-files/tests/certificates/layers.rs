//! Meshes are cut in layers at the heights of the links that they must not hit.

use crate::common::scara::{LIMITS, QUILL, folded, folding_certificate, scara, world};
use crate::common::verdict::{Verdict, fails_with, found, holds, verdict};
use cplan_check_files::check_files;
use std::path::{Path, PathBuf};

/// A separate folder for each test.
struct Place(PathBuf);

/// Blocks, each by its corners with the least and the greatest coordinates.
type Blocks<'a> = &'a [[[f32; 3]; 2]];

/// Returns the sides of blocks by their corners.
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

    fn judge(&self, urdf: &str, world: &str, certificate: &str) -> Verdict {
        let files = [("arm.urdf", urdf), ("world.toml", world), ("c.json", certificate)];
        let [urdf, world, certificate] = files.map(|(file, content)| {
            std::fs::write(self.0.join(file), content).unwrap();
            self.0.join(file)
        });
        verdict(check_files(&urdf, &world, &certificate))
    }
}

/// A base with a foot that is wider than the column on it.
const FOOTED: Blocks = &[[[-0.4, -0.4, 0.0], [0.4, 0.4, 0.125]], [[-0.0625, -0.0625, 0.125], [0.0625, 0.0625, 0.25]]];

fn of_mesh(lowest: f64, file: &str) -> String {
    let urdf = scara(lowest).replacen("<box size=\"0.4 0.3 0.3\"/>", &format!("<mesh filename=\"{file}\"/>"), 1);
    urdf.replacen("<origin xyz=\"0 0 0.15\"/>", "", 1)
}

/// Returns a certificate that turns the arm past a post.
fn turned() -> String {
    found(r#""start": [-0.5, 0], "goal": [0.5, 0],"#, r#""linear""#, "[0, -0.5, 0], [1, 0.5, 0]")
}

/// Tests that the quill passes above the foot, beside the column. The convex hull of the whole base would block it.
#[test]
fn meshes_are_cut_in_layers() {
    let place = Place::new("layers");
    place.write("base", FOOTED);
    for file in ["base.stl", "base_text.stl", "base.obj"] {
        let fold = |lowest: f64, robot: &str| place.judge(&of_mesh(lowest, file), &world(robot), &folded(""));
        // The base is cut at the lower end of the quill.
        holds(fold(0.2, ""));
        holds(fold(0.13, ""));
        fails_with(fold(0.12, ""), &["link \"quill\", collision 0", "link \"base\", collision 0, layer 1"]);
        fails_with(fold(0.05, ""), &["layer 1"]);
        // The upper corners of the foot belong to both layers if the cut is at their height.
        fails_with(fold(0.125, ""), &["layer 1"]);
        holds(fold(0.05, "own_body = false"));
        fails_with(fold(0.05, "ignore_contact = [[\"base\", \"fore\"]]"), &["layer 1"]);
    }
}

/// Tests that proofs name a layer by a height in it.
#[test]
fn proofs_name_layers() {
    let place = Place::new("named");
    place.write("base", FOOTED);
    let shut = |lowest: f64, part: &str| {
        place.judge(&of_mesh(lowest, "base.stl"), &world(LIMITS), &folding_certificate(QUILL, part))
    };
    let own = |height: &str| format!(r#"{{"own": "base", "collision": 0{height}}}"#);
    holds(shut(0.05, &own(r#", "height": 0.1"#)));
    fails_with(shut(0.05, &own("")), &["has several layers: choose one by its"]);
    fails_with(shut(0.05, &own(r#", "height": 0.03"#)), &["passes over or under"]);
    fails_with(shut(0.05, &own(r#", "height": 0.3"#)), &["no collision shape 0"]);
    fails_with(shut(0.2, &own(r#", "height": 0.22"#)), &["does not touch"]);
    // A quill above the base does not cut it.
    fails_with(shut(0.3, &own("")), &["passes over or under"]);
    // Neither does one that also reaches below it.
    holds(shut(-0.1, &own("")));
    holds(shut(-0.1, &own(r#", "height": 0.1"#)));
}

/// Tests that moving links are cut at the heights of the base. The layers also apply to obstacles of the world.
#[test]
fn layers_also_apply_to_obstacles() {
    let place = Place::new("moving");
    // A bar with a quill at its end, as one mesh.
    place.write("fore", &[[[-0.05, -0.05, 0.0], [0.45, 0.05, 0.1]], [[0.4, -0.05, -0.4], [0.45, 0.05, 0.0]]]);
    let (before, after) =
        scara(0.4).split_once("<link name=\"fore\">").map(|(a, b)| (a.to_owned(), b.to_owned())).unwrap();
    let (_, after) = after.split_once("</link>").unwrap();
    let fore = r#"<collision> <geometry> <mesh filename="fore.obj"/> </geometry> </collision>"#;
    let urdf = format!("{before}<link name=\"fore\">{fore}</link>{after}");
    // The bar passes above the post. The convex hull of bar and quill would hit it.
    let post = "[[obstacle]]\ncircle = { center = [0.7, 0], radius = 0.05 }\nheight = [0, 0.25]\n";
    let low = urdf.replacen("0.4 0.3 0.3", "0.1 0.1 0.3", 1);
    let among = |robot: &str, post: &str| place.judge(&low, &format!("{}{post}", world(robot)), &turned());
    holds(among("", post));
    fails_with(among("", &post.replace("0.7,", "0.9,")), &["link \"fore\", collision 0, layer 0", "obstacle 0"]);
    fails_with(among("own_body = false", post), &["link \"fore\", collision 0 is", "obstacle 0"]);
    // Between the base and the upper arm's top, bar and quill are one layer.
    fails_with(among("", &post.replace("0.25]", "0.31]")), &["layer", "obstacle 0"]);
}

/// Tests that moving links are also cut at each other's heights: the upper arm at the lower end of the quill.
#[test]
fn links_that_move_cut_each_other() {
    let place = Place::new("each_other");
    // An arm, and behind the shoulder a tail that is lower.
    place.write("upper", &[[[0.0, -0.05, -0.1], [0.55, 0.05, 0.1]], [[-0.3, -0.05, -0.1], [0.0, 0.05, 0.0]]]);
    let urdf = |lowest: f64| {
        let urdf = scara(lowest).replacen("<box size=\"0.6 0.1 0.2\"/>", "<mesh filename=\"upper.stl\"/>", 1);
        urdf.replacen("<origin xyz=\"0.25 0 0\"/>", "", 1)
    };
    let post = "[[obstacle]]\ncircle = { center = [-0.25, 0], radius = 0.05 }\nheight = [0.38, 0.44]\n";
    let among = |lowest: f64, robot: &str| place.judge(&urdf(lowest), &format!("{}{post}", world(robot)), &turned());
    let hit = ["link \"upper\", collision 0", "obstacle 0"];
    holds(among(0.36, ""));
    // Cuts outside the mesh, or none.
    fails_with(among(0.2, ""), &hit);
    fails_with(among(0.36, "ignore_contact = [[\"quill\", \"upper\"]]"), &hit);
    fails_with(among(0.36, "own_body = false"), &hit);
}

/// Tests that faces scaled to other units give the same layers.
#[test]
fn layers_are_scaled() {
    let place = Place::new("scaled");
    let scaled: Vec<[[f32; 3]; 2]> =
        FOOTED.iter().map(|block| block.map(|corner| corner.map(|c| c * 1024.0))).collect();
    place.write("base", &scaled);
    let urdf = |lowest: f64| of_mesh(lowest, "base.stl\" scale=\"0.0009765625 0.0009765625 0.0009765625");
    holds(place.judge(&urdf(0.13), &world(""), &folded("")));
    fails_with(place.judge(&urdf(0.12), &world(""), &folded("")), &["layer 1"]);
}
