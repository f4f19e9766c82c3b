//! Certificates of random worlds, and falsified ones.
//!
//! Every proof of infeasibility has a certificate that the checker accepts. The arms are of all kinds, in all planes,
//! moved and turned, from millimetres to a kilometre. The obstacles have heights, the problems a clearance, and the
//! goals are joint values or places of the tip. The checker refuses each falsified certificate, or it is still true. An
//! oracle decides that, and shares no code with the checker or the library.
//!
//! Every run tries some of both. The campaigns of some 10 000 worlds and of 1 000 000 falsified certificates are
//!
//! ```sh
//! CPLAN_TIMES=150 cargo test --profile quick --test planning certificates_of_random_worlds -- --nocapture
//! CPLAN_TIMES=2500 cargo test --profile quick --test planning falsified_certificates -- --nocapture
//! ```

mod drawn;
mod followed_lines;
mod motions;
pub mod oracle;
mod tasks;

use cplan::engine::Method;
use cplan::input::Overrides;
use cplan::model::Status;
use cplan::{Options, plan};
use cplan_cases::dice::Dice;
use cplan_cases::slips::slipped;
use cplan_cases::{seeds, times, uses_default_cases};
use cplan_check_files::{CheckError, check};
use cplan_testkit::problems::problem_of_texts;
use drawn::{Drawn, Goal, Kind, Outline};
use serde_json::{Value, json};
use std::time::{Duration, Instant};

/// Kinds of arms: RR, RP, PR, PP.
const KINDS: u64 = 4;

/// Number of pairs of start and goal per world.
const ENDS: usize = 3;

/// Number of boxes above which these tests do not falsify a certificate: that would take long and show nothing new.
const MAX_BOXES: usize = 30;

/// Least number of certificates that are falsified.
const FEWEST: usize = 3;

/// Largest number of seeds whose certificates are falsified.
const MAX_SEEDS: usize = 240;

/// An infeasible problem and its certificate.
struct InfeasibleExplanation {
    drawn: Drawn,
    certificate: String,
}

#[derive(Debug, Default)]
struct Tally {
    worlds: usize,
    infeasible: [usize; KINDS as usize],
    tips: usize,
    boxes: usize,
    largest: usize,
    /// Number of arms with oblique cylinders.
    oblique: usize,
    /// Certificates that the checker refused, with the reasons.
    failed: Vec<String>,
    checking: Duration,
}

/// Plans in a world between several starts and goals. Returns the infeasible problems, with their valid certificates.
fn closed(seed: u64, tally: &mut Tally) -> Vec<InfeasibleExplanation> {
    let mut dice = Dice::new(seed.wrapping_mul(0x2545_F491_4F6C_DD1D));
    let kind = seed % KINDS;
    let mut drawn = Drawn::new(&mut dice, kind);
    let urdf = drawn.urdf();
    let Some(scene) = drawn.scene() else { return Vec::new() };
    let mut found = Vec::new();
    for _ in 0..ENDS {
        let mut free = || drawn.free(&mut dice, &scene, 1e-9);
        let (Some(start), Some(goal)) = (free(), free()) else { continue };
        drawn.start = start;
        drawn.goal = if dice.chance(0.6) { Goal::Joints(goal) } else { Goal::Tip(drawn.tip(goal)) };
        let world = drawn.world(true);
        let Ok(problem) = problem_of_texts(&urdf, &world) else { continue };
        tally.worlds += 1;
        let options = if dice.chance(0.1) { Options::default() } else { Method::First.into() };
        let answer = plan(&problem, &options).unwrap();
        if answer.status() != Status::Infeasible {
            continue;
        }
        let certificate = answer.certificate(&Overrides::default(), None).unwrap();
        let begun = Instant::now();
        let judged = check(&urdf, &world, &certificate);
        tally.checking += begun.elapsed();
        let count = certificate.matches("\"lower\"").count();
        if let Err(why) = judged {
            tally.failed.push(format!("seed {seed}, {count} boxes: {why}\n{urdf}\n{world}"));
            continue;
        }
        tally.infeasible[kind as usize] += 1;
        tally.oblique += usize::from(drawn.has_oblique_cylinder());
        tally.tips += usize::from(matches!(drawn.goal, Goal::Tip(_)));
        tally.boxes += count;
        tally.largest = tally.largest.max(certificate.len());
        found.push(InfeasibleExplanation { drawn: drawn.clone(), certificate });
    }
    found
}

#[test]
fn certificates_of_random_worlds_hold() {
    let mut tally = Tally::default();
    for seed in seeds(24) {
        for InfeasibleExplanation { drawn, certificate } in closed(seed, &mut tally) {
            let read: Value = serde_json::from_str(&certificate).unwrap();
            assert_eq!(oracle::false_claim(&drawn, &read), None, "seed {seed}: the oracle");
        }
    }
    let failed = std::mem::take(&mut tally.failed);
    let count = failed.len();
    println!("{tally:?}");
    let first: Vec<String> = failed.into_iter().take(3).collect();
    assert!(count == 0, "{count} do not hold, among them\n{}", first.join("\n"));
    assert!(!uses_default_cases() || tally.infeasible.iter().sum::<usize>() > 3 && tally.tips > 0, "{tally:?}");
}

/// Changes something in the certificate, or in the files against which it is checked.
fn falsify(dice: &mut Dice, InfeasibleExplanation { drawn, certificate }: &InfeasibleExplanation) -> (Drawn, Value) {
    let (mut drawn, mut value): (Drawn, Value) = (drawn.clone(), serde_json::from_str(certificate).unwrap());
    let scale = drawn.scale;
    let moved = |dice: &mut Dice, x: f64, unit: f64| match dice.below(6) {
        0 => x.next_up(),
        1 => x.next_down(),
        2 => x + dice.within(-1e-9, 1e-9) * unit,
        3 => x + dice.within(-0.05, 0.05) * unit,
        4 => x + dice.within(-1.0, 1.0) * unit,
        _ => -x,
    };
    let units = drawn.joints.map(|joint| if joint.slides { scale } else { 1.0 });
    for _ in 0..1 + dice.below(2) {
        let count = value["boxes"].as_array().unwrap().len();
        if count == 0 {
            break;
        }
        let (number, other) = (dice.below(count), dice.below(count));
        let (k, end) = (dice.below(2), ["lower", "upper"][dice.below(2)]);
        let parts = value["parts"].as_array().unwrap().len();
        let shapes = value["shapes"].as_array().unwrap().len();
        match dice.below(18) {
            0 => _ = value["boxes"].as_array_mut().unwrap().remove(number),
            1..=3 => {
                let x = value["boxes"][number][end][k].as_f64().unwrap();
                value["boxes"][number][end][k] = json!(moved(dice, x, units[k]));
            }
            4 => {
                let [low, high] = ["lower", "upper"].map(|end| value["boxes"][number][end][k].clone());
                (value["boxes"][number]["lower"][k], value["boxes"][number]["upper"][k]) = (high, low);
            }
            5 => {
                for end in ["lower", "upper"] {
                    value["boxes"][number][end][k] = value["boxes"][other][end][k].clone();
                }
            }
            // Refers to another shape or part, or to one that does not exist.
            6 => value["boxes"][number]["shape"] = json!(dice.below(shapes + 1)),
            7 => value["boxes"][number]["part"] = json!(dice.below(parts + 1)),
            8 => {
                let link = ["base", "upper", "fore", "tool", "none"][dice.below(5)];
                let kind = ["collision", "visual"][dice.below(2)];
                value["shapes"][dice.below(shapes)] = json!({ "link": link, kind: dice.below(3) });
            }
            9 => value["parts"][dice.below(parts)]["obstacle"] = json!(dice.below(drawn.obstacles.len() + 1)),
            10 => {
                let part = dice.below(parts);
                let Some(corners) = value["parts"][part]["corners"].as_array_mut().filter(|c| !c.is_empty()) else {
                    continue;
                };
                let n = corners.len();
                let (i, j) = (dice.below(n), dice.below(n));
                match dice.below(5) {
                    0 => _ = corners.remove(i),
                    1 => corners.swap(i, j),
                    2 => corners.insert(i, corners[j].clone()),
                    3 => corners.extend_from_within(..),
                    _ => {
                        let x = corners[i][k].as_f64().unwrap();
                        corners[i][k] = json!(moved(dice, x, scale));
                    }
                }
            }
            11 => value["clearance"] = json!(dice.within(0.0, 0.1) * scale),
            12 => {
                let ends = drawn.joints.map(|joint| {
                    let [low, high] = joint.range.unwrap_or([-4.0, 4.0]);
                    dice.within(low, high)
                });
                match dice.below(3) {
                    0 => value["start"] = json!(ends),
                    1 => value["goal"] = json!(ends),
                    _ => value["goal_tip"] = json!(drawn.tip(ends)),
                }
            }
            13 | 14 => {
                let obstacle = dice.below(drawn.obstacles.len());
                let obstacle = &mut drawn.obstacles[obstacle];
                match dice.below(4) {
                    0 => obstacle.at[k] = moved(dice, obstacle.at[k], scale),
                    1 => obstacle.angle = moved(dice, obstacle.angle, 1.0),
                    2 => obstacle.height = Some([0.3 * scale, 0.4 * scale]),
                    _ => match &mut obstacle.outline {
                        Outline::Circle(_, radius) => *radius *= dice.within(0.0, 1.2),
                        Outline::Polyline(points) => points[0][k] = moved(dice, points[0][k], scale),
                        Outline::Rings(rings) => rings[0][0][k] = moved(dice, rings[0][0][k], scale),
                    },
                }
            }
            15 => {
                let link = dice.below(2);
                let solid = &mut drawn.solids[link][0];
                match &mut solid.kind {
                    Kind::Box(size) => size[k] *= dice.within(0.3, 1.1),
                    Kind::Cylinder([radius, _]) | Kind::Capsule([radius, _]) | Kind::Sphere(radius) => {
                        *radius *= dice.within(0.3, 1.1);
                    }
                }
            }
            16 => match dice.below(3) {
                0 => {
                    if let Some(range) = &mut drawn.joints[k].range {
                        let end = dice.below(2);
                        range[end] = moved(dice, range[end], units[k]);
                    }
                }
                1 => drawn.origins[1][k] = moved(dice, drawn.origins[1][k], scale),
                _ => drawn.angle = moved(dice, drawn.angle, 1.0),
            },
            // A box with new values.
            _ => {
                let mut more = value["boxes"][number].clone();
                more[end][k] = json!(moved(dice, more[end][k].as_f64().unwrap(), units[k]));
                value["boxes"].as_array_mut().unwrap().push(more);
            }
        }
    }
    (drawn, value)
}

/// Rewrites the same numbers in another notation, in a text that is still JSON.
fn with_other_notation(dice: &mut Dice, text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find(|c: char| c.is_ascii_digit() || c == '-') {
        out += &rest[..at];
        rest = &rest[at..];
        let end = rest.find(|c: char| !(c.is_ascii_digit() || "+-.eE".contains(c))).unwrap_or(rest.len());
        let (number, after) = rest.split_at(end);
        rest = after;
        // Counts stay integers, and there is no second exponent.
        let is_plain = number.contains('.') && !number.contains('e');
        out += &match dice.below(if is_plain { 4 } else { 1 }) {
            0 => number.to_owned(),
            1 => format!("{number}000"),
            2 => format!("{number}e+0"),
            _ => {
                let (whole, fraction) = number.split_once('.').unwrap();
                let (sign, whole) = whole.strip_prefix('-').map_or(("", whole), |whole| ("-", whole));
                let digits = [whole, fraction].concat();
                let digits = digits.trim_start_matches('0');
                format!("{sign}{}E-{}", if digits.is_empty() { "0" } else { digits }, fraction.len())
            }
        };
    }
    out + rest
}

/// Returns a text that resembles a certificate only vaguely.
fn invalid_text(dice: &mut Dice, text: &str) -> String {
    let at = dice.below(text.len());
    let number = |dice: &mut Dice| {
        let all = [
            "1e999999999",
            "-1e999999999",
            "1e-999999999",
            "1e1099",
            "-1e1099",
            "1e-1099",
            "NaN",
            "null",
            "true",
            "-0",
            "0e0",
            "[[[[[[[[",
            "{}",
            "\"0.1\"",
            "1e+5",
            "00.1",
            ".5",
            "18446744073709551616",
            "1.0",
        ];
        all[dice.below(all.len())].to_owned()
    };
    match dice.below(6) {
        0 => text[..at].to_owned(),
        1 => "[".repeat(dice.below(200_000)),
        2 => text.replacen(": [", &format!(": {}", "[".repeat(dice.below(5000))), 1 + dice.below(40)),
        3 => {
            // Finds the number that begins next, or the rest of one.
            let Some(from) = text[at..].find(|c: char| c.is_ascii_digit()).map(|n| n + at) else {
                return String::new();
            };
            let to = text[from..]
                .find(|c: char| !(c.is_ascii_digit() || ".e-".contains(c)))
                .map_or(text.len(), |n| n + from);
            format!("{}{}{}", &text[..from], number(dice), &text[to..])
        }
        4 => text.replacen("\"lower\"", "\"lower\": [0, 0], \"lower\"", 1 + dice.below(3)),
        _ => slipped(dice, text),
    }
}

/// Returns the checker's answer: it accepts the certificate, refuses it, or does not understand it. The last two are
/// `Err`.
fn check_answer(urdf: &str, world: &str, certificate: &str) -> Result<(), bool> {
    match check(urdf, world, certificate) {
        Ok(_) => Ok(()),
        Err(CheckError::Fails(_)) => Err(true),
        Err(CheckError::Input { .. }) => Err(false),
    }
}

#[test]
fn falsified_certificates_are_refused_or_true() {
    let (mut tally, mut pool) = (Tally::default(), Vec::new());
    // Only some worlds are infeasible, so more are tried until there are enough certificates to falsify.
    let drawn = seeds(24);
    for seed in drawn.start.. {
        if seed - drawn.start >= (MAX_SEEDS as u64).min(drawn.end - drawn.start) && pool.len() >= FEWEST {
            break;
        }
        pool.extend(
            closed(seed, &mut tally).into_iter().filter(|c| c.certificate.matches("\"lower\"").count() <= MAX_BOXES),
        );
    }
    let (mut held, mut failed, mut input, mut spelled) = (0_u64, 0_u64, 0_u64, 0_u64);
    let mut count = |judged: Result<(), bool>| match judged {
        Ok(()) => held += 1,
        Err(true) => failed += 1,
        Err(false) => input += 1,
    };
    for seed in seeds(760) {
        let mut dice = Dice::new(seed ^ 0xfa15e);
        let closed = &pool[dice.below(pool.len())];
        match dice.below(20) {
            0 => {
                let text = with_other_notation(&mut dice, &closed.certificate);
                let answer = check_answer(&closed.drawn.urdf(), &closed.drawn.world(true), &text);
                assert_eq!(answer, Ok(()), "seed {seed}: {text}");
                spelled += 1;
            }
            1..=3 => {
                let text = invalid_text(&mut dice, &closed.certificate);
                let answer = check_answer(&closed.drawn.urdf(), &closed.drawn.world(true), &text);
                if answer.is_ok() {
                    // The text may have numbers that are no doubles.
                    let near = text.replace("e1099", "e99").replace("e-1099", "e-99");
                    let value = serde_json::from_str(&near).unwrap();
                    assert_eq!(oracle::false_claim(&closed.drawn, &value), None, "seed {seed}: {text}");
                }
                count(answer);
            }
            // The meaning of these files is no longer known.
            4 => {
                let (urdf, world) = (closed.drawn.urdf(), closed.drawn.world(true));
                let (urdf, world) = match dice.below(2) {
                    0 => (slipped(&mut dice, &urdf), world),
                    _ => (urdf, slipped(&mut dice, &world)),
                };
                count(check_answer(&urdf, &world, &closed.certificate).and(Err(false)));
            }
            _ => {
                let (drawn, value) = falsify(&mut dice, closed);
                let (urdf, world, text) = (drawn.urdf(), drawn.world(true), value.to_string());
                let answer = check_answer(&urdf, &world, &text);
                if answer.is_ok() {
                    assert_eq!(oracle::false_claim(&drawn, &value), None, "seed {seed}:\n{urdf}\n{world}\n{text}");
                }
                count(answer);
            }
        }
    }
    println!(
        "{} certificates; falsified: {held} hold and are true, {failed} fail, {input} are bad input; {spelled} in other words hold",
        pool.len()
    );
    assert!(
        !uses_default_cases() || held > times(8) && failed > times(16) && input > times(8),
        "{held} {failed} {input}"
    );
}
