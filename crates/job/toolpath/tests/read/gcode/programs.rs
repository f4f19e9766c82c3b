//! Programs move by move: travels at both ends, places that the file does not state, and the words of each line.

use super::near;
use cplan_toolpath::{Program, ProgramMove, read_program};

fn moves(text: &str) -> Program {
    read_program(text.as_bytes(), None).expect("a program")
}

#[test]
fn travels_at_both_ends_belong_to_a_program() {
    let program = moves("G21 G90\nG0 X10 Y10\nG0 X20\nG1 Y20\nG1 Y20\nG0 X0 Y0\nM2\n%\n");
    let ends: Vec<_> = program.moves.iter().map(|own| (own.piece.is_travel, own.piece.curve.end())).collect();
    assert_eq!(ends, [(true, [0.02, 0.01]), (false, [0.02, 0.02]), (true, [0.0, 0.0])]);
    assert_eq!(program.unstated.iter().map(|source| source.line).collect::<Vec<_>>(), [2]);
    let unstated = read_program(b"G21\nG0 X1 Y1\n", None).expect_err("an error").message;
    assert_eq!(unstated, "the file does not state where its moves begin");
    assert_eq!(read_program(b"G21\nG4 P1\n", None).expect_err("an error").message, "the file has no line");
    assert_eq!(read_program(b"G0 X1 Y1\nG1 X2\nM2\nG1 X9\n", None).expect_err("an error").line, Some(4));
    assert_eq!(read_program(b"G21\nG0 X0 Y0\nG0 X1e9\n", None).expect_err("an error").line, Some(3));
}

#[test]
fn homing_is_allowed_and_makes_the_place_unknown() {
    let text =
        "G28\nG0 X1 Y1\nG1 X2\nG28 X0\nG0 X5 Y5\nG1 X6\n$H\nG0 X7 Y7\nG1 X8\nG53 G0 X0 Y0\nG0 X8 Y8\nG28 Z0\nG1 X9\n";
    let program = moves(text);
    assert_eq!(program.unstated.iter().map(|source| source.line).collect::<Vec<_>>(), [2, 5, 8, 11]);
    let starts: Vec<_> = program.moves.iter().map(|own| own.piece.curve.start()).collect();
    assert!(starts.iter().zip([1.0, 5.0, 7.0, 8.0]).all(|(start, x)| near(*start, [x / 1e3; 2])), "{starts:?}");
    assert!(program.notes.iter().any(|note| note.contains("G28 (3), G53 (1)")), "{:?}", program.notes);
    let known = read_program(text.as_bytes(), Some([0.1, 0.2])).expect("a program");
    assert!(known.unstated.is_empty() && known.moves.len() == program.moves.len() + 4);
    assert!([0, 2, 4, 6].iter().all(|k| near(known.moves[*k].piece.curve.start(), [0.1, 0.2])), "{:?}", known.moves);
}

#[test]
fn a_move_states_its_modes_and_words() {
    let text =
        "G21 G90\nG0 X0 Y0 Z1\nG92 X5\n G0 X 10.5 Y-2 Z3 F9\nG91\nG1 y2 Z-1\nG20 G90 G0 X0 ; inch\nG28 Z0\nG0 X1 Z5\n";
    let program = moves(text);
    let word = |own: &ProgramMove, k: usize| {
        let range = own.modes.words[k].clone()?;
        let line = text.lines().nth(own.piece.source.line - 1)?;
        Some(line.chars().collect::<Vec<_>>()[range].iter().collect::<String>())
    };
    let words: Vec<_> = program.moves.iter().map(|own| [0, 1, 2].map(|k| word(own, k).unwrap_or_default())).collect();
    assert_eq!(words, [["X 10.5", "Y-2", "Z3"], ["", "y2", "Z-1"], ["X0", "", ""], ["X1", "", "Z5"]]);
    let modes = program.moves.iter().map(|own| (own.modes.unit, own.modes.is_relative)).collect::<Vec<_>>();
    assert_eq!(modes, [(1e-3, false), (1e-3, true), (0.0254, false), (0.0254, false)]);
    assert!(program.moves.iter().all(|own| near(own.modes.origin, [-0.005, 0.0])));
    // The height is unknown after homing.
    let rises: Vec<_> = program.moves.iter().map(|own| own.modes.rise.map(|rise| (rise * 1e6).round() / 1e3)).collect();
    assert_eq!(rises, [Some(2.0), Some(-1.0), None, None]);
}
