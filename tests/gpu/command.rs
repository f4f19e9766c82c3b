//! The option `--on gpu` of the program.

use serde_json::Value;
use std::process::Command;

/// The two environment variables that state where Vulkan looks for drivers. The tests set them to a place without
/// drivers.
const DRIVERS: [&str; 2] = ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"];
const NOWHERE: &str = "/nowhere/driver.json";

fn cplan(world: &str, options: &str) -> Command {
    let root = env!("CARGO_MANIFEST_DIR");
    let mut command = Command::new(env!("CARGO_BIN_EXE_cplan"));
    command.current_dir(root).arg("robots/planar_2r.urdf").arg(format!("workspaces/{world}.toml"));
    command.args(options.split_whitespace());
    command
}

#[test]
#[ignore = "needs a Vulkan driver: .ci/gpu"]
fn fields_of_a_gpu_are_followed_and_certified() {
    let options = "--planner harmonic --cells 64 --relaxation gauss-seidel --tolerance 1e-4";
    let run = |on: &str| -> Value {
        let done = cplan("shelf", &format!("{options} {on} --json")).output().unwrap();
        assert_eq!(done.status.code(), Some(0), "{}", String::from_utf8_lossy(&done.stderr));
        serde_json::from_slice(&done.stdout).unwrap()
    };
    let (gpu, cpu) = (run("--on gpu"), run("--order red-black"));
    assert_eq!(gpu["certified"], true);
    assert!(gpu["field"]["on"].as_str().is_some_and(|name| !name.is_empty()), "{}", gpu["field"]);
    assert_eq!((gpu["field"]["order"].as_str(), &cpu["field"]["on"]), (Some("red-black"), &Value::Null));
    assert_eq!(gpu["field"]["converged"], true);
    // Both fields are the same up to rounding, so the curves along them have the same length.
    let [a, b] = [&gpu, &cpu].map(|result| result["length"].as_f64().unwrap());
    assert!((a - b).abs() < 1e-2 * b, "{a} {b}");
    assert_eq!(run("--on gpu")["path"], gpu["path"], "the same each time");
}

#[test]
#[ignore = "needs a Vulkan driver: .ci/gpu"]
fn the_summary_names_the_adapter() {
    let done = cplan("shelf", "--planner harmonic --cells 64 --on gpu --verbose").output().unwrap();
    let text = String::from_utf8_lossy(&done.stdout).split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(text.contains("harmonic; gauss-seidel, red-black; on "), "{text}");
}

#[test]
#[cfg(target_os = "linux")]
#[ignore = "needs a Vulkan loader: .ci/gpu"]
fn a_missing_driver_gives_a_hint() {
    let mut command = cplan("shelf", "--planner harmonic --on gpu");
    DRIVERS.iter().for_each(|name| _ = command.env(name, NOWHERE));
    let done = command.output().unwrap();
    let text = String::from_utf8_lossy(&done.stderr);
    assert_eq!(done.status.code(), Some(1), "{text}");
    assert!(text.contains("--on gpu: no GPU can be used") && text.contains("hint: install a driver"), "{text}");
}
