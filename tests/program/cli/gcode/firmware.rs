//! Programs that firmwares run differently: they are refused, or their moves are not judged.

use super::super::{Place, shipped};

/// Programs with the dialects that refuse them, and a part of the message. Other dialects find them free.
const REFUSED: [(&str, &[&str], &str); 13] = [
    (
        "G90\nG0 X240 Y265\n/G1 Y280\nG1 Y275\n",
        &["marlin", "grbl", "linuxcnc"],
        "some machines run and others leave out",
    ),
    (
        "G90\nG0 X240 Y265\nG1 Y275\nM2\nG1 X0 Y250\n",
        &["marlin", "klipper", "grbl"],
        "follows the end of the program (line 4)",
    ),
    (
        "%\nG90\nG0 X240 Y265\nG1 Y275\n%\nG1 X0 Y250\n",
        &["marlin", "fluidnc"],
        "follows the end of the program (line 5)",
    ),
    ("G90\nG0 X240 Y265\n; note\rG1 X0 Y250\nG1 Y275\n", &["marlin", "duet"], "a carriage return"),
    ("G90 G0 X240 Y265\nG1 Y275\n", &["marlin", "klipper"], "G0 is not the first command of the line"),
    ("G0 X240 Y265\nG91\nG21 G90\nG1 X240 Y275\n", &["marlin"], "G90 is not the first command of the line"),
    ("G0 X240 Y265\nX240 Y275\n", &["marlin", "klipper"], "X240 is in a line without a command"),
    ("G0 X240 Y265\ng1 y275\n", &["marlin"], "g1 is in lower case"),
    ("G0 X240 Y265\n(note) G1 Y275\n", &["marlin", "klipper"], "not know comments in parentheses"),
    ("G0 X240 Y265\nG1 Y275 (F900)\n", &["marlin", "klipper"], "not know comments in parentheses"),
    ("G0 X240 Y265\nM3 G1 Y275\n", &["klipper"], "G1 is not the first command of the line"),
    ("G91\nG1 X240 Y265\nG1 Y10\n", &["marlin", "duet"], "--home"),
    ("G90\nG0 X240\nG1 X250\n", &["marlin", "grbl"], "does not state where its moves begin"),
];

/// Judges a program on the tray of `labels.toml`, and returns the exit code and the message.
fn check(text: &str, options: &str) -> (i32, String) {
    let place = Place::new();
    place.write("job.gcode", text);
    let files = ["robots/scara.urdf", "workspaces/gcode/labels.toml"].map(shipped);
    let done = place.run(&["gcode", &files[0], &files[1], "job.gcode", "--check"], options);
    (done.code, done.stdout + &done.stderr)
}

#[test]
fn programs_that_firmwares_run_differently_are_refused() {
    for (text, dialects, expected) in REFUSED {
        for dialect in dialects {
            let (code, message) = check(text, &format!("--dialect {dialect}"));
            assert!(code == 1 && message.contains(expected), "{dialect}: {text}: {code} {message}");
        }
    }
}

#[test]
fn programs_that_a_firmware_runs_as_written_are_judged() {
    for (text, dialect) in [
        ("G90 G0 X240 Y265\nG1 Y275\n", "grbl"),
        ("G0 X240 Y265\nX240 Y275\n", "linuxcnc"),
        ("g0 x240 y265\ng1 y275\n", "klipper"),
        ("(note) G0 X240 Y265\nG1 Y275 (F900)\n", "fluidnc"),
        ("G21 G90 ; G1 X0\nG0 X240 Y265 (pen up)\nM117 G1 X0\nG1 Y275\nM2\n", "marlin"),
        ("G0 X240 Y265\r\nG1 Y275\r\n%\r\n", "duet"),
    ] {
        let (code, message) = check(text, &format!("--dialect {dialect}"));
        assert!(code == 0 && message.contains("proven"), "{dialect}: {text}: {code} {message}");
    }
}

#[test]
fn displacements_are_judged_from_a_stated_place_only() {
    let text = "G91\nG1 X5\nG1 Y5\n";
    let (code, message) = check(text, "--home 0.24,0.265");
    assert!(code == 0 && message.contains("2 drawing moves"), "{message}");
    // One coordinate is stated in line 1, the other in line 3.
    let (code, message) = check("G0 X240\nG1 X245\nG0 Y265\nG1 X240\n", "");
    assert!(code == 0 && message.contains("1 drawing move,") && message.contains("lines 1, 2, 3"), "{message}");
}
