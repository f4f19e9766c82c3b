//! Any bytes as a robot: loaded beside a world that asks for nothing, and examined.
#![no_main]

use cplan::input::{inspect, load_scene};
use cplan_fuzz::Files;
use libfuzzer_sys::fuzz_target;
use std::sync::LazyLock;

static FILES: LazyLock<Files> = LazyLock::new(Files::empty);

fuzz_target!(|bytes: &[u8]| {
    let robot = FILES.write("robot.urdf", bytes);
    let world = FILES.write("world.toml", b"[[obstacle]]\ncircle = { center = [0.5, 0.5], radius = 0.1 }\n");
    let inspection = inspect(&robot, Some(&world));
    match load_scene(&robot, &world) {
        Ok(loaded) => {
            assert!(
                inspection.is_plannable(),
                "loads, yet the inspection says that it does not: {:?}",
                inspection.errors
            );
            assert!(loaded.scene.arm().reach() > 0.0);
            for part in loaded.scene.arm().links.iter().flat_map(|l| &l.parts) {
                assert!(!part.shape.core().is_empty() && part.shape.radius().is_finite());
                assert!(part.shape.core().iter().all(|p| p.x.is_finite() && p.y.is_finite()));
            }
            let _ = loaded.scene.clearance(loaded.scene.arm().topology().ranges.map(|a| a.domain().0).into());
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
    let _ = inspect(&robot, None);
});
