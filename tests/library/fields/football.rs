//! The match of `examples/robot_football`: no robot hits another, and the printed facts about its fields are true.

use cplan::field::{Difference, Solver};
use cplan_testkit::football::measure::{Case, Kind, Run, cases, run, run_after_every_frame, sor};
use cplan_testkit::football::page;
use cplan_testkit::football::play::{self, Frame, Match};

fn played(seed: u64, frames: usize) -> (Match, Vec<Frame>) {
    let mut game = Match::new(seed).unwrap();
    let frames = (0..frames).map(|_| game.next_frame().unwrap()).collect();
    (game, frames)
}

/// Diameter of the disc around a robot of 7.5 cm x 7.5 cm, in centimetres.
const TOGETHER: f64 = 7.5 * std::f64::consts::SQRT_2 / 2.0;

#[test]
fn no_robot_runs_into_another_or_off_the_field() {
    let mut nearest = f64::INFINITY;
    for seed in [1, 2] {
        let (_, frames) = played(seed, 90);
        for pair in frames.windows(2) {
            for part in 0..=8 {
                let along = f64::from(part) / 8.0;
                let at = [0, 1, 2, 3, 4, 5].map(|robot| {
                    let [from, to] = [pair[0].robots[robot], pair[1].robots[robot]];
                    [0, 1].map(|k| from[k] + along * (to[k] - from[k]))
                });
                for a in 0..6 {
                    // Lines at 10 cm and 160 cm of 170 cm, 0 cm and 130 cm; the first cell's centre is at 1 cm.
                    let [x, y] = at[a].map(|cells| 2.0 * cells + 1.0);
                    let reach = TOGETHER;
                    assert!(x - reach >= 10.0 && x + reach <= 160.0, "seed {seed}: robot {a} at {x} cm");
                    assert!(y - reach >= 0.0 && y + reach <= 130.0, "seed {seed}: robot {a} at {y} cm");
                    for b in 0..a {
                        let distance = (at[a][0] - at[b][0]).hypot(at[a][1] - at[b][1]);
                        assert!(distance > TOGETHER, "seed {seed}: robots {a} and {b}: {distance} cells");
                        nearest = nearest.min(distance);
                    }
                }
            }
            for robot in 0..6 {
                let [from, to] = [pair[0].robots[robot], pair[1].robots[robot]];
                let way = (to[0] - from[0]).hypot(to[1] - from[1]);
                assert!(way <= play::REACH + 1e-9, "seed {seed}: robot {robot} goes {way} cells in a frame");
            }
        }
    }
    assert!(nearest < TOGETHER + 1.0, "they never met: nothing was tried");
}

#[test]
fn a_match_follows_from_its_seed() {
    let [(a, first), (b, again), (_, other)] = [played(3, 12), played(3, 12), played(4, 12)];
    assert_eq!((first.as_slice(), a.score), (again.as_slice(), b.score));
    assert_ne!(first[0].robots, other[0].robots);
}

#[test]
fn the_last_frame_is_a_better_start_than_nothing() {
    let (_, frames) = played(1, 24);
    for case in cases() {
        let moments: Vec<_> = frames.iter().map(|frame| case.kind.moment(frame)).collect();
        let warm = run(moments.iter().skip(12), &case, 1e-6, false).unwrap();
        let standing = run(moments.iter().skip(12).step_by(4), &case, 1e-6, true).unwrap();
        assert!(standing.fields == 3 && warm.fields == 12, "{standing:?}");
        let [warm, standing] = [warm, standing].map(|run: Run| run.mean_sweeps());
        // Multigrid solves a harmonic field in one step, whatever the initial values.
        let is_direct = (case.kind, case.solver) == (Kind::Harmonic, Solver::Multigrid);
        assert!(
            0.0 < warm && (warm < standing || is_direct),
            "{:?} {:?}: {warm} and {standing}",
            case.kind,
            case.solver
        );
        if case.solver == Solver::Multigrid {
            assert!(standing < 16.0, "{:?}: {standing}", case.kind);
        }
    }
}

#[test]
fn fields_take_one_sweep_where_nothing_new_is_seen() {
    let (_, frames) = played(1, 20);
    let case = Case { kind: Kind::LocallyOriented, difference: Difference::Central, solver: sor(1.0), published: None };
    let share = |times: usize| run_after_every_frame(&frames, times, &case).unwrap().share_at_once();
    assert!(share(1) < 0.2, "{}", share(1));
    assert!((0.8..0.9).contains(&share(6)), "{}", share(6));
}

#[test]
fn the_page_has_every_frame_and_loads_nothing() {
    let mut game = Match::new(1).unwrap();
    let mut film = page::Film::default();
    for _ in 0..6 {
        let frame = game.next_frame().unwrap();
        film.add_frame(&frame, game.fields(), game.score);
    }
    let page = film.page(1);
    let data = page.split("type=\"application/json\">").nth(1).and_then(|rest| rest.split("</script>").next()).unwrap();
    let data: serde_json::Value = serde_json::from_str(data).unwrap();
    assert_eq!((data["frames"].as_array().unwrap().len(), data["fields"].as_array().unwrap().len()), (6, 2));
    let robots = data["frames"][5][0].as_array().unwrap();
    assert_eq!(robots.len(), 14);
    // One letter per arrow, for rows 1, 4, .. 82 and columns 1, 4, .. 64.
    assert_eq!(data["fields"][1][0][2][0].as_str().unwrap().len(), 28 * 22);
    // The font is part of the page.
    let page = page.replace("url(data:font/woff2;base64,", "");
    assert!(["http:", "https:", "src=", "href=", "@import", "url("].iter().all(|word| !page.contains(word)));
}
