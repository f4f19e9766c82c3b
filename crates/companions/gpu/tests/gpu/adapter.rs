//! Tests of opening an adapter, with and without a driver.

use cplan_gpu::{Gpu, GpuError};
use std::process::Command;

/// The variable that states where Vulkan looks for drivers. The tests set it to a path without drivers.
const DRIVERS: &str = "VK_DRIVER_FILES";
const NOWHERE: &str = "/nowhere/driver.json";

#[test]
#[ignore = "needs a Vulkan driver: .ci/gpu"]
fn an_adapter_is_found_where_drivers_are() {
    match std::env::var(DRIVERS).as_deref() {
        Ok(NOWHERE) => {
            let error = Gpu::open().expect_err("no drivers");
            assert!(matches!(error, GpuError::NoAdapter(_)), "{error}");
            let text = error.to_string();
            assert!(text.contains("no GPU can be used") && text.contains("hint: install a driver"), "{text}");
        }
        _ => assert!(!Gpu::open().expect("a driver").adapter().is_empty()),
    }
}

/// Runs the test above in a process that finds no drivers.
#[test]
#[cfg(target_os = "linux")]
#[ignore = "needs a Vulkan loader: .ci/gpu"]
fn missing_drivers_give_a_hint() {
    let mut again = Command::new(std::env::current_exe().unwrap());
    again.args(["--include-ignored", "--exact", "adapter::an_adapter_is_found_where_drivers_are"]);
    // The older name of the variable goes first where a loader knows both.
    let done = again.env(DRIVERS, NOWHERE).env("VK_ICD_FILENAMES", NOWHERE).output().unwrap();
    let text = String::from_utf8_lossy(&done.stdout);
    assert!(done.status.success() && text.contains("1 passed"), "{text}{}", String::from_utf8_lossy(&done.stderr));
}
