//! Files with a slip of the pen, by the hundred: read or refused with place and cure, never a panic, never a long wait.

use cplan::input::{InputError, Overrides, Source, load_recording, scene_from};
use std::time::{Duration, Instant};

/// SplitMix64 (Steele, Lea, Flood 2014).
struct Dice(u64);

impl Dice {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) % n as u64) as usize
    }
}

/// What numbers become.
const NUMBERS: [&str; 16] = [
    "0",
    "-0",
    "1",
    "-1",
    "1e308",
    "-1e308",
    "1e-320",
    "nan",
    "inf",
    "-inf",
    "1e16",
    "\"30deg\"",
    "[]",
    "{}",
    "0x7f",
    "",
];
/// What is put in anywhere.
const BITS: [&str; 18] =
    ["[", "]", "{", "}", "\"", "<", ">", "/", "=", ",", "#", "\n", "\0", "\u{e4}", "[[", "]]", ";", "\t"];

/// The text with a few slips.
fn slipped(dice: &mut Dice, text: &str) -> String {
    let mut text: Vec<char> = text.chars().collect();
    for _ in 0..1 + dice.below(3) {
        let n = text.len().max(1);
        let at = dice.below(n).min(text.len());
        let insert = |text: &mut Vec<char>, at: usize, bit: &str| {
            text.splice(at..at, bit.chars());
        };
        match dice.below(7) {
            // A number becomes another.
            0 | 1 => {
                let is_number = |c: &char| c.is_ascii_digit() || matches!(c, '.' | '-');
                let starts: Vec<usize> =
                    (0..text.len()).filter(|&i| is_number(&text[i]) && (i == 0 || !is_number(&text[i - 1]))).collect();
                if let Some(&start) = starts.get(dice.below(starts.len().max(1))) {
                    let end = start + text[start..].iter().take_while(|c| is_number(c)).count();
                    let bit = NUMBERS[dice.below(NUMBERS.len())];
                    text.splice(start..end, bit.chars());
                }
            }
            2 => insert(&mut text, at, BITS[dice.below(BITS.len())]),
            3 => {
                let end = (at + 1 + dice.below(8)).min(text.len());
                text.drain(at..end);
            }
            // A line again, or away.
            4 | 5 => {
                let lines: Vec<String> = text.iter().collect::<String>().lines().map(str::to_owned).collect();
                let k = dice.below(lines.len().max(1));
                let twice = dice.below(2);
                let again = lines
                    .iter()
                    .enumerate()
                    .flat_map(|(i, line)| vec![line.clone(); if i == k { 2 * twice } else { 1 }]);
                text = again.collect::<Vec<_>>().join("\n").chars().collect();
            }
            _ => text.truncate(at.max(1)),
        }
    }
    text.into_iter().collect()
}

const ARM: &str = include_str!("../../src/cli/starter/rr.urdf");

const WORLD: &str = r#"name = "cell"
clearance = 0.0
[robot]
tip = "tool0"
limits = { elbow = ["-120deg", 2.1] }
velocity = { elbow = 1.0 }
[start]
joints = [-0.9, 0.5]
[goal]
tip = [0.3, 0.6]
[[obstacle]]
name = "frame"
polygon = [[1.0, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0], [1.0, 1.0]]
holes = [[[1.2, 1.2], [1.8, 1.2], [1.5, 1.8]]]
[[obstacle]]
polygon = [[[3, 3], [4, 3], [4, 4], [3, 4]], [[3, 3], [3.5, 3.2], [3.2, 3.5]]]
height = [0.0, 0.2]
[[obstacle]]
circle = { center = [0.1, -0.7], radius = 0.05 }
[[obstacle]]
polyline = [[-0.5, -0.8], [-0.5, -0.8], [-0.5, 0.8]]
[[preference]]
epsilon = 0.1
polygon = [[0.2, 0.3], [0.5, 0.3], [0.5, 0.6]]
"#;

/// So long may the reading of a small file take, on a machine that is busy.
const PATIENCE: Duration = Duration::from_secs(20);

fn is_helpful(error: &InputError, text: &str) {
    assert!(!error.defects().is_empty());
    for defect in error.defects() {
        assert!(!defect.message.is_empty() && !defect.origin.is_empty(), "{defect}\n{text}");
    }
}

#[test]
fn slips_in_worlds_and_robots_are_read_or_refused() {
    let (mut read, mut refused) = (0, 0);
    let mut dice = Dice(13);
    for k in 0..1500 {
        let (urdf, world) = match k % 2 {
            0 => (ARM.to_owned(), slipped(&mut dice, WORLD)),
            _ => (slipped(&mut dice, ARM), WORLD.to_owned()),
        };
        let started = Instant::now();
        let scene = scene_from(Source::in_memory("arm.urdf", &*urdf), Source::in_memory("world.toml", &*world));
        let loaded = scene.and_then(|scene| match scene.has_steps() {
            true => Ok(()),
            false => scene.problem(&Overrides::default()).map(|_| ()),
        });
        assert!(started.elapsed() < PATIENCE, "{urdf}{world}");
        match loaded {
            Ok(()) => read += 1,
            Err(error) => {
                refused += 1;
                is_helpful(&error, if k % 2 == 0 { &world } else { &urdf });
            }
        }
    }
    assert!(read > 100 && refused > 500, "{read} {refused}");
}

#[test]
fn slips_in_tables_are_read_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene_from(Source::in_memory("arm.urdf", ARM), Source::in_memory("world.toml", WORLD)).unwrap();
    let table =
        "# logged\ntime;shoulder;elbow;elbow_velocity\n0;-0.9;0.5;0\n1;-0.8;0.4;0.1\n1;-0.8;0.4;0.1\n2;-0.7;0.4;0\n";
    let mut dice = Dice(14);
    let (mut read, mut refused) = (0, 0);
    for _ in 0..600 {
        let table = slipped(&mut dice, table);
        let path = folder.path().join("m.csv");
        std::fs::write(&path, &table).unwrap();
        match load_recording(&path, &scene) {
            Ok(loaded) => {
                read += 1;
                assert!(loaded.recording.times().is_none_or(|times| times.windows(2).all(|w| w[0] < w[1])), "{table}");
            }
            Err(error) => {
                refused += 1;
                is_helpful(&error, &table);
            }
        }
    }
    assert!(read > 50 && refused > 100, "{read} {refused}");
}
