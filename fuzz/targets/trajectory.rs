//! Any bytes as a recorded motion, by all three readers.
#![no_main]

use cplan::check::limit_violations;
use cplan::input::{LoadedScene, load_recording, load_scene};
use cplan_fuzz::{Files, shipped};
use libfuzzer_sys::fuzz_target;
use std::sync::LazyLock;

static FILES: LazyLock<Files> = LazyLock::new(Files::empty);
static SCENE: LazyLock<LoadedScene> = LazyLock::new(|| {
    load_scene(&shipped("robots/planar_2r.urdf"), &shipped("workspaces/shelf.toml")).expect("shipped files are good")
});

fuzz_target!(|bytes: &[u8]| {
    for name in ["motion.json", "motion.csv", "motion.yaml"] {
        let file = FILES.write(name, bytes);
        match load_recording(&file, &SCENE) {
            Ok(loaded) => {
                let recording = loaded.recording;
                assert!(!recording.positions().is_empty());
                assert!(recording.positions().iter().all(|q| q.iter().all(|v| v.is_finite())));
                assert!(recording.times().is_none_or(|t| t.windows(2).all(|w| w[0] < w[1])));
                let topology = SCENE.scene.arm().topology();
                let _ = (recording.turns(&topology), recording.clone().unwrapped(&topology));
                let _ = limit_violations(&SCENE.scene.arm().joints, &recording);
            }
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
});
