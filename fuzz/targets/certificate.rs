//! Reads any bytes as a certificate: among obstacles without a path, with a path, among moving obstacles, and of a task
//! on a belt.
#![no_main]

use cplan_check_files::{CheckError, check};
use cplan_fuzz::shipped;
use libfuzzer_sys::fuzz_target;
use std::sync::LazyLock;

/// Returns the texts of a robot and a world.
fn texts(robot: &str, world: &str) -> [String; 2] {
    [format!("robots/{robot}.urdf"), format!("workspaces/{world}.toml")]
        .map(|file| std::fs::read_to_string(shipped(&file)).expect("shipped files are there"))
}

static CLOSED: LazyLock<[String; 2]> = LazyLock::new(|| texts("planar_2r_continuous", "no_path"));
static OPEN: LazyLock<[String; 2]> = LazyLock::new(|| texts("planar_2r", "limits_open"));

static MOVING: LazyLock<[[String; 2]; 2]> =
    LazyLock::new(|| ["moving/crossing", "moving/belt_stop"].map(|world| texts("planar_2r", world)));

fuzz_target!(|text: &str| {
    let judged = |[urdf, world]: &[String; 2]| match check(urdf, world, text) {
        Ok(proven) => Some(proven),
        Err(CheckError::Fails(why)) => Some(why).filter(String::is_empty),
        Err(CheckError::Input { message, .. }) => Some(message).filter(String::is_empty),
    };
    assert_ne!(judged(&CLOSED), Some(String::new()), "no reason");
    for files in MOVING.iter() {
        assert_ne!(judged(files), Some(String::new()), "no reason");
    }
    if let Some(proven) = judged(&OPEN).filter(|proven| proven.starts_with("no motion of ")) {
        // Only with ends, a clearance or a line of its own, which may be written with escapes.
        assert!(
            ["\"start\"", "\"goal", "\"clearance\"", "\"line\"", "\\u"].iter().any(|own| text.contains(own)),
            "{proven:?}"
        );
    }
});
