//! Words that are followed, listed or refused.

use super::{ends, near, program, refused};
use cplan_toolpath::{Format, Placement, read};

/// The ends of a line that goes 10 mm to the right, and the notes.
fn notes(before: &str) -> Vec<String> {
    let path = program(&format!("{before}\nG21 G90\nG0 X0 Y0\nG1 X10 F600\n"));
    assert!(path.pieces().len() == 1 && near(path.end(), [0.01, 0.0]), "{before}");
    path.notes().to_vec()
}

#[test]
fn words_without_an_effect_are_listed_in_one_note() {
    let text = "%\nO1000 (PART (LEFT) SIDE)\nN5 G17 G40 G49 G54 G61 G64 P0.05 G80 G94*71\n$H\n$X\n?\nT1 M6 (pen)\nS1000 M3\n\
        G43 H1 Z5\nG28 G91 Z0\nG90\nG53 Z0\nM117 Hello (world; *G1 X5\nM203 X200 Y200\nSET_VELOCITY_LIMIT ACCEL=500\n\
        START_PRINT\nG92 E0\nG1 Z-1 E0.5 F100\nM9\n/G1 X5 Y5";
    let listed = "words without effect on the line: $H (1), $X (1), /, left out (1), ? (1), E (2), G17 (1), G28 (1), G40 (1), \
        G43 (1), G49 (1), G53 (1), G54 (1), G61 (1), G64 (1), G94 (1), H (1), M117 (1), M203 (1), M3 (1), M6 (1), M9 (1), O (1), \
        P (1), S (1), SET_VELOCITY_LIMIT (1), START_PRINT (1), T (1), Z (4 heights)";
    assert_eq!(notes(text), [listed]);
    assert_eq!(notes("M3\nM5\nM3"), ["words without effect on the line: M3 (2), M5 (1)"]);
    assert_eq!(notes("; only\n(comments)\n%\nN7"), Vec::<String>::new());
}

#[test]
fn klippers_commands_are_listed() {
    let path = program("G21 G90\nSET_VELOCITY_LIMIT ACCEL=500\nG0 X10 Y10\nG1 X20 F1000\n");
    assert!(path.pieces().len() == 1 && near(path.end(), [0.02, 0.01]));
    assert_eq!(path.notes(), ["words without effect on the line: SET_VELOCITY_LIMIT (1)"]);
}

/// After G92 the line continues from where the tip is, and the coordinates count from the new origin.
#[test]
fn g92_moves_the_origin_and_not_the_tip() {
    let text = "G21 G90\nG0 X10 Y10\nG1 X50 F600\nG92 X0 Y0 (here is the new origin)\nG1 X20 Y0\nG1 X20 Y20\n";
    assert_eq!(ends(text), [[50.0, 10.0], [70.0, 10.0], [70.0, 30.0]]);
    assert!(program(text).notes().is_empty());
    let both = "G21 G90\nG0 X10 Y10\nG1 X50\nG92 X0\nG1 X1 Y11\nG92 X7 Y7\nG1 X8\nG92.2\nG1 X60 Y12\nG92.3\nG1 X8 Y7\nG92.1\nG1 X0 Y0";
    assert_eq!(ends(both), [[50.0, 10.0], [51.0, 11.0], [52.0, 11.0], [60.0, 12.0], [52.0, 11.0], [0.0, 0.0]]);
    // Relative moves do not depend on the origin, but G92 does not depend on relative moves either.
    assert_eq!(ends("G21 G90\nG0 X10 Y10\nG91\nG92 X0 Y0\nG1 X5\nG90\nG1 X0"), [[15.0, 10.0], [10.0, 10.0]]);
    // A program may begin with the coordinates of the tip.
    assert_eq!(ends("G21\nG92 X5 Y7 Z0\nG1 X10"), [[10.0, 7.0]]);
    let unstated = refused("G21\nG92 X5 Y7\nG1 X10\nG92.1\nG1 X11");
    assert_eq!(
        (unstated.line, unstated.to_string().as_str()),
        (Some(4), "G92.1 returns to an origin that the file does not state")
    );
    assert_eq!(refused("G0 X0 Y0\nG92\nG1 X1").to_string(), "G92 has no coordinates");
}

#[test]
fn g90_1_makes_the_centers_of_arcs_coordinates() {
    let circle = |text: &str| {
        let path = program(text);
        let [piece] = path.pieces() else { panic!("one piece") };
        let (start, half) = (path.start(), piece.curve.at(0.5));
        [start, half].map(|point| point.map(|x| (x * 1e9).round() / 1e6))
    };
    let opposite = [[60.0, 50.0], [40.0, 50.0]];
    assert_eq!(circle("G21 G90 G90.1\nG0 X60 Y50\nG2 X60 Y50 I50 J50 F600\n"), opposite);
    assert_eq!(circle("G21 G90 G90.1\nG0 X60 Y50\nG91.1\nG2 X60 Y50 I-10 J0\n"), opposite);
    // Centres count from the origin of G92.
    assert_eq!(circle("G21 G90.1\nG0 X60 Y50\nG92 X0 Y0\nG2 X0 Y0 I-10 J0\n"), opposite);
    let error = refused("G90.1\nG0 X60 Y50\nG2 X60 Y50 I50");
    assert_eq!(error.to_string(), "G2 has only one coordinate of the centre");
}

#[test]
fn dwells_are_stops_of_their_time() {
    let dwells = |text: &str| -> Vec<Option<f64>> { program(text).pieces().iter().map(|piece| piece.dwell).collect() };
    let line = |dwell: &str| format!("G21 G90\nG0 X10 Y10\nG1 X20 F600\n{dwell}\nG1 X30\n");
    for (dwell, seconds) in
        [("G4 P0.5", 0.5), ("G04 S2", 2.0), ("G4 X2", 2.0), ("G4 U3", 3.0), ("G4 P0", 0.0), ("G4", 0.0), ("G4 F1", 1.0)]
    {
        assert_eq!(dwells(&line(dwell)), [Some(seconds), None], "{dwell}");
    }
    assert_eq!(program(&line("G4 X2")).notes(), ["1 stop of 2 s in all (G4)"]);
    assert_eq!(program(&line("G4 P2")).notes(), ["1 stop of 2 s in all (G4); P counts seconds"]);
    // In programs for the firmware of printers and plotters, P counts milliseconds.
    let plotter = program(&line("M300 S30\nG4 P150\nG4 P50"));
    assert_eq!(plotter.pieces()[0].dwell.map(|seconds| (seconds * 1e6).round()), Some(200_000.0));
    assert_eq!(plotter.notes()[0], "1 stop of 0.2 s in all (G4); P counts milliseconds");
    // The tip rests at both ends of the line anyway. A dwell after a move without a length is after the one before.
    let text = "G21\nG0 X0 Y0\nG4 S1\nG1 X5\nG1 X5\nG4 S2\nG1 X6\nG4 S4\nG0 X0";
    assert_eq!(dwells(text)[0], Some(2.0));
    assert_eq!(
        program(text).notes()[1],
        "1 stop of 2 s in all (G4); stops (G4) before and after the line, 5 s in all, are left out"
    );
    for (dwell, message) in [
        ("G4 P-1", "P-1 is not a time from 0 to 86400 s"),
        ("G4 P1 X5", "X5 is a second time for this dwell"),
        ("G4 P1 Y5", "Y5 belongs to a move, but this line is a dwell"),
    ] {
        let error = refused(&line(dwell));
        assert_eq!((error.line, error.to_string().as_str()), (Some(4), message));
    }
}

#[test]
fn words_that_would_change_the_line_are_refused_together() {
    let text = "G21 G18\nG0 X0 Y0\nG41 D1\nG1 X5 F100\nG42\nG1 X6\nG68 X0 Y0 R45\nG81 Z-1 R1\nX5\nG81 Z-2\nG93\nG95\nG96 S5\nG1 X9";
    let error = refused(text);
    assert_eq!((error.line, error.column), (Some(1), Some(5)));
    let expected = "G18 changes the plane of arcs (line 1); G41 offsets the line by the tool's radius (line 3); \
        G42 offsets the line by the tool's radius (line 5); G68 moves, turns, scales or mirrors the coordinates (line 7); \
        G81 is a cycle of several moves (lines 8, 10); G93 changes the meaning of F (line 11); \
        G95 changes the meaning of F (line 12); G96 changes the meaning of F (line 13)";
    assert_eq!(error.to_string(), expected);
    let many = format!("G0 X0 Y0\n{}", "G81 Z-1\n".repeat(12));
    assert_eq!(refused(&many).to_string(), "G81 is a cycle of several moves (lines 2, 3, 4, 5, 6, 7, 8, 9 and 4 more)");
    // Hints never offer to remove a word that draws.
    for word in
        ["G18", "G19", "G41", "G42", "G68", "G81", "G93", "G95", "G96", "G5", "G33", "A90", "G92", "G90.1", "G4 P-1"]
    {
        let error = refused(&format!("G0 X0 Y0\n{word}\nG1 X5 I1"));
        assert!(!error.hint.is_empty() && !error.hint.contains("remove"), "{word}: {}", error.hint);
    }
}

#[test]
fn places_of_the_machine_are_refused_and_heights_are_not() {
    let error = refused("G21\nG28\nG0 X0 Y0\nG1 X5\nG53 G0 X0\nG1 X6\nG28 X Y\nM30");
    let place = "moves to a place of the machine, which the file does not state";
    assert_eq!(error.to_string(), format!("G28 {place} (lines 2, 7); G53 {place} (line 5)"));
    let expected = "remove this line; nothing is drawn before or after it; write a move (G0) to that place, in the \
        coordinates of the file";
    assert_eq!(error.hint, expected);
    assert_eq!(ends("G21\nG0 X0 Y0\nG1 X5\nG53 G0 Z0\nG28 Z\nG1 X6"), [[5.0, 0.0], [6.0, 0.0]]);
}

#[test]
fn other_systems_of_coordinates_are_refused_after_the_first_move() {
    assert_eq!(ends("G21 G55\nG0 X0 Y0\nG55 G1 X5"), [[5.0, 0.0]]);
    let error = refused("G21 G54\nG0 X0 Y0\nG1 X5\nG55\nG1 X6");
    assert_eq!(error.to_string(), "G55 selects a coordinate system whose origin the file does not state");
}

#[test]
fn other_words_are_refused_by_name_with_their_place() {
    let cases = [
        ("G0 X0 Y0\nG5 X1", 2, 1, "G5 draws a curve that cplan does not read"),
        ("G0 X0 Y0\nG123 X1", 2, 1, "G123 is not a word that cplan knows"),
        ("G0 X0 Y0\nG1 X1 A90", 2, 7, "A turns the tool"),
        ("G0 X0 Y0\nG1 X1 U9", 2, 7, "U moves an axis that the arm does not have"),
        ("G0 X0 Y0\nG1 X", 2, 4, "the letter X has no number"),
        ("G0 X0 Y0\nG1 X1 #2", 2, 7, "# stands for a computed number"),
        ("G0 X0 Y0\nG1 X[1+2]", 2, 4, "X stands for a computed number"),
        ("G0 X0 Y0\nO100 call", 2, 1, "O repeats, skips or calls lines"),
        ("G0 X0 Y0\nWHILE [#1 LT 2] DO1", 2, 1, "O repeats, skips or calls lines"),
        ("G0 X0 Y0\nM98 P100", 2, 1, "M98 repeats, skips or calls lines"),
        ("G0 X0 Y0\nG1 X1 L5", 2, 7, "L repeats the line"),
        ("G0 X0 Y0\nG2 X1 I0.5 K1", 2, 12, "K is part of an arc in another plane"),
        ("G0 X0 Y0\nG2 X1 I0.5 P2", 2, 12, "P2 gives an arc several turns"),
        ("G0 X0 Y0\nSET_GCODE_OFFSET X=5", 2, 1, "SET_GCODE_OFFSET moves, turns, scales or mirrors the coordinates"),
        ("G0 X0 Y0\nG10 L20 P1 X0", 2, 1, "G10 moves, turns, scales or mirrors the coordinates"),
        ("G0 X0 Y0\nG1 X1e-05", 2, 4, "X1 has an exponent, and numbers of G-code have none"),
        ("G0 X0 Y0\nG1 X1E-05", 2, 4, "X1 has an exponent, and numbers of G-code have none"),
        ("G0 X0 Y0\nG1 X1.2.3", 2, 4, "X1.2.3 has no valid number"),
        ("G0 X0 Y0\nG1 X1 =2", 2, 7, "\"=\" is not a word of G-code that cplan reads"),
        ("G0 X0 (start", 1, 7, "this comment is not closed"),
        ("G0 G1 X0", 1, 4, "G1 and G0 contradict each other on this line"),
        ("G0 X0 X1", 1, 7, "X1 and X0 contradict each other on this line"),
        ("G0 N5 X0", 1, 4, "N5 is not at the start of its line"),
        ("X1", 1, 1, "X1 has no kind of move"),
        ("G0 X0 Y0\nG80\nX1", 3, 1, "X1 has no kind of move"),
        ("G3 X1 I1", 1, 1, "G3 is the first move, but the file does not state where the tip is before it"),
        ("G0 X0 Y0 F0", 1, 10, "F0 is not a speed"),
        ("G0 X0 Y0\nG1 X1 I2", 2, 7, "I2 belongs to an arc, but this is a straight move"),
    ];
    for (text, line, column, message) in cases {
        let error = refused(text);
        assert_eq!((error.line, error.column), (Some(line), Some(column)), "{text}: {error}");
        assert_eq!(error.to_string(), message, "{text}");
        assert!(!error.hint.is_empty(), "{text}");
    }
}

#[test]
fn a_second_percent_sign_ends_the_program() {
    assert_eq!(ends("%\nG21 G0 X0 Y0\nG1 X5\n%\nG1 X9"), [[5.0, 0.0]]);
    assert_eq!(ends("G21 G90 G90 G0X0Y0\nG1X5E0.5\nG1Y-.5E1\n"), [[5.0, 0.0], [5.0, -0.5]]);
    let windows = read(b"G21\r\nG0 X0 Y0\r\nG1 X5\r\n", Format::GCode, &Placement::default()).expect("a line");
    assert!(near(windows.end(), [0.005, 0.0]));
}

/// The tip comes from a place that the file does not state, so the first move is not part of the line.
#[test]
fn the_first_move_leads_to_the_line() {
    let text = "G21 G90\nG1 Z2 F100\nG1 X5 Y6 F600\nG1 X7\n";
    assert_eq!(ends(text), [[7.0, 6.0]]);
    let note = "the first move (G1, line 3) is left out, because the file does not state where it begins";
    assert_eq!(program(text).notes(), [note, "words without effect on the line: Z (1 height)"]);
    let unstated = |text: &str| program(text).notes()[0].clone();
    assert_eq!(unstated("G21\nG0 X5\nG1 X7"), "the file does not state Y of the line's beginning: read as 0");
    assert_eq!(
        unstated("G21 G91\nG0 X5 Y5\nG1 X7"),
        "the file does not state X and Y of the line's beginning: read as 0"
    );
    assert_eq!(program("G21\nG92 Y2\nG0 X5\nG1 X7").notes(), Vec::<String>::new());
    let hint = refused("G21\nG1 X7").hint;
    assert_eq!(hint, "add at least one move (G1) after the first move, which only states where the line begins");
}
