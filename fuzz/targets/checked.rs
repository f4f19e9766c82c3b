//! Reads any bytes as each of the files that `cplan-check` reads in addition to the certificate: a robot, a world,
//! meshes, a picture, its description and a line map.
#![no_main]

use cplan_check_files::check_files;
use cplan_fuzz::{Files, shipped};
use libfuzzer_sys::fuzz_target;
use std::sync::LazyLock;

/// All valid files.
static FILES: LazyLock<Files> = LazyLock::new(|| {
    let files = Files::empty();
    let urdf = std::fs::read_to_string(shipped("robots/planar_2r.urdf")).expect("shipped files are there");
    files.write("arm.urdf", urdf.as_bytes());
    files.write("certificate.json", CERTIFICATE.as_bytes());
    files.write("free.toml", b"[robot]\nfixed = { wrist = 0.1 }\nlimits = { a = [0, 1] }\nbar = 0.1\n");
    files.write("seen.toml", b"[[obstacle]]\nimage = \"seen.yaml\"\n");
    files.write("seen.yaml", YAML.as_bytes());
    files.write("said.toml", b"[[obstacle]]\nimage = \"any.yaml\"\n");
    files.write("walls.toml", b"[map]\nfile = \"any\"\n");
    files.write("pixel.pgm", b"P2 1 1 1 0");
    for format in ["stl", "obj", "dae"] {
        let mesh =
            format!("<mesh filename=\"any.{format}\" scale=\"1 2 3\"/></geometry></collision><collision><geometry><");
        files.write(&format!("{format}.urdf"), urdf.replacen("<box ", &format!("{mesh}box "), 1).as_bytes());
    }
    files
});

const CERTIFICATE: &str = r#"{ "format": "cplan certificate 1", "answer": "found", "start": [0.1, 0.2], "goal": [0.1, 0.2],
    "motion": { "interpolation": ["linear"], "knots": [[0, 0.1, 0.2]] } }"#;

const YAML: &str =
    "image: any\nresolution: 0.1\norigin: [9, 0, 0.5]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.2\n";

fuzz_target!(|bytes: &[u8]| {
    let any = ["any", "any.urdf", "any.toml", "any.yaml", "any.stl", "any.obj", "any.dae"]
        .map(|name| FILES.write(name, bytes));
    let folder = any[0].parent().expect("in a folder");
    let certificate = folder.join("certificate.json");
    let judged = |robot: &str, world: &str| match check_files(&folder.join(robot), &folder.join(world), &certificate) {
        Ok(report) => report,
        Err(why) => why.to_string(),
    };
    for (robot, world) in [
        ("any.urdf", "free.toml"),
        ("arm.urdf", "any.toml"),
        ("arm.urdf", "seen.toml"),
        ("arm.urdf", "said.toml"),
        ("arm.urdf", "walls.toml"),
        ("stl.urdf", "free.toml"),
        ("obj.urdf", "free.toml"),
        ("dae.urdf", "free.toml"),
    ] {
        assert!(!judged(robot, world).is_empty(), "{robot}, {world}: no reason");
    }
});
