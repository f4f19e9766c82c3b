//! Any bytes as a world, for an arm with limits and for one that turns without end.
#![no_main]

#[path = "files.rs"]
mod files;
#[path = "shipped.rs"]
mod shipped;

use cplan::input::{Overrides, load};
use files::Files;
use libfuzzer_sys::fuzz_target;
use shipped::shipped;
use std::sync::LazyLock;

static FILES: LazyLock<Files> = LazyLock::new(Files::new);

fuzz_target!(|bytes: &[u8]| {
    let world = FILES.write("world.toml", bytes);
    for robot in ["robots/planar_2r_continuous.urdf", "robots/gantry.urdf"] {
        match load(&shipped(robot), &world, &Overrides::default()) {
            Ok(loaded) => {
                let problem = loaded.problem;
                assert!(!problem.goals.is_empty());
                for q in problem.goals.iter().chain([&problem.start]) {
                    assert!(q.iter().all(|v| v.is_finite()));
                    assert!(problem.scene.clearance(*q) > 0.0, "an end is not free");
                }
            }
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
});
