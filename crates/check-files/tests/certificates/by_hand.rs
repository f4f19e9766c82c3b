//! The certificate on the documentation page that a few lines of Python write.

use crate::common::verdict::{fails, holds, judge};
use std::path::Path;
use std::process::Command;

#[test]
fn the_certificate_of_the_page_holds() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let read = |path: &str| std::fs::read_to_string(root.join(path)).unwrap();
    let page = read("docs/certificate_format.md");
    let code = page.split("```python\n").nth(1).and_then(|rest| rest.split("```").next()).expect("an example");
    let code = code.replace("open(\"by_hand.json\", \"w\")", "open(1, \"w\")");
    let done = match Command::new("python3").args(["-c", &code]).output() {
        Ok(done) => done,
        // Tests the Python code only if Python is available.
        Err(error) => return assert_eq!(error.kind(), std::io::ErrorKind::NotFound),
    };
    let certificate = String::from_utf8(done.stdout).unwrap();
    let judged = |certificate: &str| {
        judge(&read("robots/planar_2r_continuous.urdf"), &read("workspaces/no_path.toml"), certificate)
    };
    let report = holds(judged(&certificate));
    assert!(page.contains(&format!("by_hand.json\nholds: {report}\n")), "{report}");
    let wider = certificate.replace("0.08", "0.18");
    assert_ne!(wider, certificate);
    fails(judged(&wider), "");
}
