//! Tests that accelerations are those of the line. The oracle plays the written samples, and computes how the tip accelerates by
//! its own kinematics: not at all on a straight line at constant speed, and towards the centre on an arc.

use super::{BARS, check, found, scene_of, stroke};
use cplan_cases::dice::Dice;
use cplan_follow::Settings;
use cplan_testkit::follow_oracle::{Bars, Point, State, played};
use cplan_toolpath::{Curve, Piece, Toolpath};
use std::f64::consts::TAU;

/// Distance from the ends of a piece up to which corners count, metres.
const BESIDE: f64 = 2e-3;

/// Speed from which the tip counts as at its top speed, as a share of it.
const TOP_SHARE: f64 = 0.995;

/// Time before and after a state for which the tip has to be at its top speed, seconds: ramps end gently.
const AROUND: f64 = 0.02;

/// Returns velocity and acceleration of the tip.
fn motion_of_tip(bars: &Bars, state: &State) -> [Point; 2] {
    let State { position, velocity, acceleration, .. } = state;
    let mut motion = [[0.0; 2]; 2];
    for (length, joints) in bars.lengths.into_iter().zip([1, 2]) {
        let sum = |row: &Point| row[..joints].iter().sum::<f64>();
        let (sin, cos) = sum(position).sin_cos();
        let (turn, gain) = (sum(velocity), sum(acceleration));
        for (k, [along, across]) in [[cos, -sin], [sin, cos]].into_iter().enumerate() {
            motion[0][k] += length * turn * across;
            motion[1][k] += length * (gain * across - turn * turn * along);
        }
    }
    motion
}

/// Returns the least distance of a point from a piece without its ends, and the acceleration that a tip with a speed has
/// there, metres and seconds.
fn expected(curve: &Curve, [x, y]: Point, speed: f64) -> (f64, Point) {
    match *curve {
        Curve::Line { from, to } => {
            let along = [to[0] - from[0], to[1] - from[1]];
            let length = along[0].hypot(along[1]);
            let share = ((x - from[0]) * along[0] + (y - from[1]) * along[1]) / length / length;
            let beside = BESIDE / length;
            let share = share.clamp(beside, 1.0 - beside);
            ((x - from[0] - share * along[0]).hypot(y - from[1] - share * along[1]), [0.0; 2])
        }
        Curve::Arc { center, radius, from, by, .. } => {
            let away = [x - center[0], y - center[1]];
            let distance = away[0].hypot(away[1]);
            let turned = (by.signum() * (away[1].atan2(away[0]) - from)).rem_euclid(TAU);
            let beside = BESIDE / radius;
            let is_on = (beside..by.abs() - beside).contains(&turned);
            let pull = -speed * speed / radius / distance;
            (if is_on { (distance - radius).abs() } else { 1.0 }, away.map(|d| pull * d))
        }
        Curve::Cubic(_) => unreachable!("lines and arcs only"),
    }
}

/// Checks the accelerations at top speed on each piece. Returns the time at top speed, seconds.
fn check_accelerations(bars: &Bars, line: &Toolpath, speed: f64, states: &[State], most: f64) -> f64 {
    let mut time = 0.0;
    let speed_of = |state: &State| {
        let [velocity, _] = motion_of_tip(bars, state);
        velocity[0].hypot(velocity[1])
    };
    let speeds: Vec<f64> = states.iter().map(speed_of).collect();
    let is_at_top = |at: f64| {
        let index = |at: f64| states.partition_point(|state| state.time < at);
        let around = index(at - AROUND)..index(at + AROUND);
        speeds[around].iter().all(|fast| *fast >= TOP_SHARE * speed)
    };
    for (pair, &fast) in states.windows(2).zip(&speeds) {
        let state = &pair[0];
        let [_, acceleration] = motion_of_tip(bars, state);
        assert!(fast <= speed * (1.0 + 1e-9), "{fast} at {state:?}");
        let pieces = line.pieces().iter().map(|piece| expected(&piece.curve, bars.tip(state.position), fast));
        let (off, expected) = pieces.min_by(|a, b| a.0.total_cmp(&b.0)).expect("a piece");
        if off > 1e-5 || fast < TOP_SHARE * speed || !is_at_top(state.time) {
            continue;
        }
        time += pair[1].time - state.time;
        let excess = (acceleration[0] - expected[0]).hypot(acceleration[1] - expected[1]);
        assert!(excess < most, "the tip accelerates by {acceleration:?} instead of {expected:?} at {state:?}");
    }
    time
}

/// Returns the number of changes of the acceleration's sign, for each joint. Accelerations below a thousandth of the limit do not count.
fn sign_changes(states: &[State], limit: f64) -> [usize; 2] {
    [0, 1].map(|k| {
        let signs = states.iter().map(|state| state.acceleration[k]).filter(|a| a.abs() > 1e-3 * limit);
        let signs: Vec<bool> = signs.map(|a| a > 0.0).collect();
        signs.windows(2).filter(|pair| pair[0] != pair[1]).count()
    })
}

#[test]
fn a_straight_cut_has_the_accelerations_of_its_geometry() {
    let scene = scene_of(BARS, 3.0, vec![]);
    let curve = Curve::Line { from: [0.9, -0.5], to: [0.9, 0.7] };
    let line = Toolpath::new(vec![Piece { speed: Some(0.3), ..stroke(curve, 1) }]).expect("a line");
    let motion = found(&scene, &line, &Settings::default());
    check(&BARS, &scene, &line, &Settings::default(), &motion);
    let states = played(&BARS, &motion.timed.trajectory, 1e-4);
    let time = check_accelerations(&BARS, &line, 0.3, &states, 2e-3);
    assert!(time > 0.9 * motion.timed.trajectory.duration(), "{time}");
    // Of the ramps at both ends, and of the joints on the line: the shoulder slows down once it has passed the middle.
    let limited = states.windows(2).filter(|pair| pair[0].acceleration.iter().any(|a| a.abs() > 9.0));
    let limited: f64 = limited.map(|pair| pair[1].time - pair[0].time).sum();
    assert!(limited < 0.1, "{limited}");
    let changes = sign_changes(&states, 10.0);
    assert!(changes.iter().all(|count| *count <= 3), "{changes:?}");
}

/// Returns a line of straight and round pieces, each at least 5 cm long, within reach.
fn line(dice: &mut Dice, bars: &Bars, speed: f64) -> Option<Toolpath> {
    let [least, most] = [(bars.lengths[0] - bars.lengths[1]).abs() + 0.15, bars.lengths[0] + bars.lengths[1] - 0.1];
    let is_inside = |[x, y]: Point| (least..most).contains(&x.hypot(y));
    let mut at = [dice.within(least, most), 0.0];
    let mut pieces = Vec::new();
    for k in 0..4 {
        let curve = if dice.chance(0.5) {
            let (length, angle) = (dice.within(0.05, 0.3), dice.within(0.0, TAU));
            Curve::Line { from: at, to: [at[0] + length * angle.cos(), at[1] + length * angle.sin()] }
        } else {
            let (radius, from) = (dice.within(0.03, 0.15), dice.within(0.0, TAU));
            let center = [at[0] - radius * from.cos(), at[1] - radius * from.sin()];
            let by = dice.within(2.0, 5.0) * if dice.chance(0.5) { 1.0 } else { -1.0 };
            Curve::Arc { center, radius, from, by, growth: 0.0 }
        };
        if !(0..=20).all(|k| is_inside(curve.at(f64::from(k) / 20.0))) {
            return None;
        }
        at = curve.at(1.0);
        pieces.push(Piece { speed: Some(speed), ..stroke(curve, k + 1) });
    }
    Some(Toolpath::new(pieces).expect("a line"))
}

#[test]
fn random_cuts_have_the_accelerations_of_their_geometry() {
    let (mut total, mut at_top) = (0.0, 0.0);
    for seed in cplan_cases::seeds(20) {
        let mut dice = cplan_cases::dice(seed);
        let bars = Bars { lengths: [dice.within(0.5, 1.2), dice.within(0.4, 1.2)], width: 0.05 };
        let speed = dice.within(0.05, 0.25);
        let Some(line) = line(&mut dice, &bars, speed) else { continue };
        let scene = scene_of(bars, 6.5, vec![]);
        let settings = Settings { tolerance: [1e-5, 5e-5][(seed % 2) as usize], ..Settings::default() };
        let motion = found(&scene, &line, &settings);
        check(&bars, &scene, &line, &settings, &motion);
        let states = played(&bars, &motion.timed.trajectory, 5e-4);
        // A fiftieth of the tip's acceleration at the joints' greatest ones.
        at_top += check_accelerations(&bars, &line, speed, &states, 0.2);
        total += motion.timed.trajectory.duration();
    }
    assert!(total > 5.0 && at_top > 0.4 * total, "{at_top} of {total} s at top speed");
}
