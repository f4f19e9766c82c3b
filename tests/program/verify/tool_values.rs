//! Motions with values of the tool's joints at start and goal, compared with dense samples of all four joints.

use super::*;
use cplan::engine::Options;
use cplan::input::{Overrides, Rules, load_scene};
use cplan::{Problem, plan};
use cplan_cases::dice::Dice;
use cplan_check_files::check;
use std::fmt::Write;

/// Lengths of both links, metres.
const LENGTHS: [f64; 2] = [0.3, 0.25];
/// Half the width of both links, metres.
const HALF_WIDTH: f64 = 0.03;
/// Heights of both links, metres.
const LINKS: [[f64; 2]; 2] = [[0.3, 0.35], [0.4, 0.45]];
/// Radius of the quill, metres.
const QUILL: f64 = 0.02;
/// Heights of the raised quill, metres.
const RAISED: [f64; 2] = [0.25, 0.5];
/// Top speeds of the four joints, rad/s and m/s.
const SPEEDS: [f64; 4] = [4.0, 6.0, 0.8, 12.0];
/// Accelerations of the four joints, rad/s2 and m/s2.
const ACCELERATIONS: [f64; 4] = [16.0, 24.0, 8.0, 60.0];
/// Jerks of the quill and the wrist if they are limited, m/s3 and rad/s3. At the first one, the quill never reaches its
/// acceleration.
const JERKS: [[f64; 2]; 2] = [[60.0, 300.0], [400.0, 2000.0]];

/// Returns the URDF of a SCARA whose shapes are boxes and a cylinder.
fn robot() -> String {
    let joint = |name: &str, kind: &str, parent: &str, child: &str, x: f64, range: [f64; 2], speed: f64| {
        format!(
            "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>\
             <origin xyz=\"{x} 0 0\"/><axis xyz=\"0 0 1\"/>\
             <limit lower=\"{}\" upper=\"{}\" effort=\"50\" velocity=\"{speed}\"/></joint>",
            range[0], range[1]
        )
    };
    let bar = |name: &str, length: f64, [low, high]: [f64; 2]| {
        format!(
            "<link name=\"{name}\"><collision><origin xyz=\"{} 0 {}\"/><geometry><box size=\"{length} {} {}\"/></geometry>\
             </collision></link>",
            length / 2.0,
            (low + high) / 2.0,
            2.0 * HALF_WIDTH,
            high - low
        )
    };
    let quill = format!(
        "<link name=\"quill\"><collision><origin xyz=\"0 0 {}\"/><geometry><cylinder radius=\"{QUILL}\" length=\"{}\"/>\
         </geometry></collision></link>",
        (RAISED[0] + RAISED[1]) / 2.0,
        RAISED[1] - RAISED[0]
    );
    [
        "<robot name=\"four\"><link name=\"base\"/>".to_owned(),
        bar("inner", LENGTHS[0], LINKS[0]),
        bar("outer", LENGTHS[1], LINKS[1]),
        quill,
        "<link name=\"flange\"/>".to_owned(),
        joint("one", "revolute", "base", "inner", 0.0, [-2.8, 2.8], SPEEDS[0]),
        joint("two", "revolute", "inner", "outer", LENGTHS[0], [-2.6, 2.6], SPEEDS[1]),
        joint("three", "prismatic", "outer", "quill", LENGTHS[1], [-0.3, 0.05], SPEEDS[2]),
        joint("four", "revolute", "quill", "flange", 0.0, [-6.0, 6.0], SPEEDS[3]),
        "</robot>".to_owned(),
    ]
    .concat()
}

/// Returns the position of the tip.
fn tip([one, two, ..]: [f64; 4]) -> [f64; 2] {
    let at = |of: fn(f64) -> f64| LENGTHS[0] * of(one) + LENGTHS[1] * of(one + two);
    [at(f64::cos), at(f64::sin)]
}

/// A post on the floor.
struct Post {
    at: [f64; 2],
    radius: f64,
    height: [f64; 2],
}

/// A motion from rest to rest: values of the four joints at both ends, among posts.
struct Query {
    posts: Vec<Post>,
    ends: [[f64; 4]; 2],
    arch: &'static str,
    /// Limits on the jerks of the quill and the wrist.
    jerks: Option<[f64; 2]>,
}

impl Query {
    fn random(dice: &mut Dice) -> Self {
        let post = |dice: &mut Dice| {
            let (distance, angle) = (dice.within(0.15, 0.55), dice.within(-3.1, 3.1));
            let low = if dice.chance(0.3) { dice.within(0.0, 0.3) } else { 0.0 };
            Post {
                at: [distance * angle.cos(), distance * angle.sin()],
                radius: dice.within(0.02, 0.06),
                height: [low, low + dice.within(0.05, 0.3)],
            }
        };
        let mut posts: Vec<Post> = (0..1 + dice.below(6_u64)).map(|_| post(dice)).collect();
        let mut end = || {
            let depth = if dice.chance(0.8) { -dice.within(0.01, 0.25) } else { 0.0 };
            [dice.within(-2.7, 2.7), dice.within(-2.5, 2.5), depth, dice.within(-5.0, 5.0)]
        };
        let ends = [end(), end()];
        // A post below the raised tool.
        let below = dice.below(8_u64);
        if below < 2 {
            posts.push(Post { at: tip(ends[below as usize]), radius: 0.02, height: [0.0, 0.2] });
        }
        let arch = match dice.below(4_u64) {
            0 => "arch = false",
            1 => "arch = { rise = 0.02, fall = 0.03 }",
            _ => "",
        };
        let jerks = JERKS.get(dice.below(5_u64) as usize).copied();
        Self { posts, ends, arch, jerks }
    }

    fn world(&self) -> String {
        let end = |name: &str, [one, two, stroke, wrist]: [f64; 4]| {
            format!("[{name}]\njoints = [{one}, {two}]\nstroke = {stroke}\nwrist = {wrist}\n")
        };
        let mut text = format!(
            "[robot]\njoints = [\"one\", \"two\"]\n{}\nacceleration = {{ one = {}, two = {} }}\n\
             stroke = {{ joint = \"three\", acceleration = {} }}\n\
             wrist = {{ joint = \"four\", velocity = {}, acceleration = {} }}\n",
            self.arch, ACCELERATIONS[0], ACCELERATIONS[1], ACCELERATIONS[2], SPEEDS[3], ACCELERATIONS[3]
        );
        if let Some([quill, wrist]) = self.jerks {
            writeln!(text, "jerk = {{ three = {quill}, four = {wrist} }}").unwrap();
        }
        text += &end("start", self.ends[0]);
        text += &end("goal", self.ends[1]);
        for Post { at: [x, y], radius, height: [low, high] } in &self.posts {
            writeln!(
                text,
                "[[obstacle]]\ncircle = {{ center = [{x}, {y}], radius = {radius} }}\nheight = [{low}, {high}]"
            )
            .unwrap();
        }
        text
    }

    /// Returns the distance between the arm and the nearest post at its height. Negative if they overlap.
    fn distance(&self, [one, two, stroke, _]: [f64; 4]) -> f64 {
        let elbow = [LENGTHS[0] * one.cos(), LENGTHS[0] * one.sin()];
        let tip = tip([one, two, stroke, 0.0]);
        let mut least = f64::INFINITY;
        for Post { at, radius, height } in &self.posts {
            let meets = |[low, high]: [f64; 2]| low <= height[1] && height[0] <= high;
            let bars = [([0.0; 2], one, LENGTHS[0], LINKS[0]), (elbow, one + two, LENGTHS[1], LINKS[1])];
            for (from, angle, length, heights) in bars {
                let [x, y] = [at[0] - from[0], at[1] - from[1]];
                let (along, across) = (x * angle.cos() + y * angle.sin(), y * angle.cos() - x * angle.sin());
                let outside = [(-along).max(along - length), across.abs() - HALF_WIDTH];
                let beyond = outside.map(|value| value.max(0.0));
                if meets(heights) {
                    let inside = outside[0].max(outside[1]).min(0.0);
                    least = least.min(beyond[0].hypot(beyond[1]) + inside - radius);
                }
            }
            if meets(RAISED.map(|height| height + stroke)) {
                least = least.min((at[0] - tip[0]).hypot(at[1] - tip[1]) - QUILL - radius);
            }
        }
        least
    }

    /// Returns the least distance while the quill is lowered at one end.
    fn lowering(&self, [one, two, stroke, wrist]: [f64; 4]) -> f64 {
        let at = |k: u32| self.distance([one, two, stroke * f64::from(k) / 100.0, wrist]);
        (0..=100).map(at).fold(f64::INFINITY, f64::min)
    }
}

/// The four joints over time: times in seconds, values and velocities.
struct Played {
    time: Vec<f64>,
    rows: Vec<[[f64; 4]; 2]>,
}

impl Played {
    /// Returns the longest time between two samples, seconds.
    fn longest(&self) -> f64 {
        self.time.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max)
    }

    fn of(result: &Value) -> Self {
        let all = &result["all_joints"];
        assert_eq!(all["joints"], json!(["one", "two", "three", "four"]));
        let rows = |of: &str| -> Vec<[f64; 4]> { serde_json::from_value(all[of].clone()).unwrap() };
        let rows = rows("position").into_iter().zip(rows("velocity")).map(|(q, v)| [q, v]).collect();
        Self { time: serde_json::from_value(all["time"].clone()).unwrap(), rows }
    }

    /// Returns the values, velocities and accelerations at dense times, joined by cubics.
    fn dense(&self) -> Vec<[[f64; 4]; 3]> {
        let mut all = Vec::new();
        for k in 1..self.time.len() {
            let span = self.time[k] - self.time[k - 1];
            let [[p, v], [q, w]] = [self.rows[k - 1], self.rows[k]];
            for step in 0..=8 {
                let u = f64::from(step) / 8.0;
                let of = |j: usize| {
                    let (a, b) = (span * v[j], span * w[j]);
                    // Coefficients of the cubic in the share of the span.
                    let c = [p[j], a, 3.0 * (q[j] - p[j]) - 2.0 * a - b, 2.0 * (p[j] - q[j]) + a + b];
                    let value = ((c[3] * u + c[2]) * u + c[1]) * u + c[0];
                    let rate = (3.0 * c[3] * u + 2.0 * c[2]) * u + c[1];
                    [value, rate / span, (6.0 * c[3] * u + 2.0 * c[2]) / (span * span)]
                };
                let columns = [of(0), of(1), of(2), of(3)];
                all.push([0, 1, 2].map(|row| columns.map(|column| column[row])));
            }
        }
        all
    }
}

/// Returns the least time for a distance from rest to rest.
fn least_seconds(distance: f64, speed: f64, acceleration: f64) -> f64 {
    match speed * speed / acceleration < distance {
        true => distance / speed + speed / acceleration,
        false => 2.0 * (distance / acceleration).sqrt(),
    }
}

/// Checks a found motion and its bound. Returns its duration.
fn check_found(query: &Query, result: &Value, seed: u64) -> f64 {
    let duration = check_motion(query, result, seed);
    // Each joint needs at least its own least time.
    let [from, to] = query.ends;
    let own = |j: usize| least_seconds((to[j] - from[j]).abs(), SPEEDS[j], ACCELERATIONS[j]);
    let strokes: f64 = [from, to].map(|end| least_seconds(end[2].abs(), SPEEDS[2], ACCELERATIONS[2])).iter().sum();
    let bound = own(0).max(own(1)).max(own(3)).max(strokes);
    let stated = result["lower_bound"].as_f64().unwrap();
    assert!(stated <= duration + 1e-9 && stated >= bound - 1e-6, "seed {seed}: {bound} {stated} {duration}");
    duration
}

/// Checks a found motion. Returns its duration.
fn check_motion(query: &Query, result: &Value, seed: u64) -> f64 {
    let played = Played::of(result);
    let dense = played.dense();
    let [first, last] = [played.rows[0], played.rows[played.rows.len() - 1]];
    for (is, asked) in [(first, query.ends[0]), (last, query.ends[1])] {
        assert!(is[1] == [0.0; 4], "seed {seed}: {is:?}");
        assert!((0..4).all(|j| (is[0][j] - asked[j]).abs() < 1e-9), "seed {seed}: {is:?} {asked:?}");
    }
    for [q, v, a] in &dense {
        assert!(query.distance(*q) > -1e-9, "seed {seed}: {q:?} {}", query.distance(*q));
        for j in 0..4 {
            assert!(v[j].abs() <= SPEEDS[j] * (1.0 + 1e-6), "seed {seed}: joint {j}: {v:?}");
            assert!(a[j].abs() <= ACCELERATIONS[j] * (1.0 + 1e-3), "seed {seed}: joint {j}: {a:?}");
        }
    }
    assert!(dense.iter().any(|[q, ..]| q[2].abs() < 1e-9), "seed {seed}: the tool is never raised");
    let duration = result["duration"].as_f64().unwrap();
    assert!((duration - played.time[played.time.len() - 1]).abs() < 1e-9, "seed {seed}");
    if let Some(jerks) = query.jerks {
        for pair in dense.windows(2).filter(|pair| pair[0] != pair[1]) {
            // Between dense samples, the acceleration changes by at most the jerk times the time.
            let span = played.longest() / 8.0;
            for (j, jerk) in [2, 3].into_iter().zip(jerks) {
                let change = (pair[1][2][j] - pair[0][2][j]).abs();
                assert!(
                    change <= jerk * span * (1.0 + 1e-3) + 1e-2 * ACCELERATIONS[j],
                    "seed {seed}: joint {j}: {change}"
                );
            }
        }
    }
    duration
}

/// The robot and the world of a query, in a folder.
struct Files {
    place: Place,
    robot: PathBuf,
    world: PathBuf,
}

impl Files {
    fn new() -> Self {
        let place = Place::new().with("four.urdf", robot());
        let [robot, world] = ["four.urdf", "world.toml"].map(|file| place.path(file));
        Self { place, robot, world }
    }

    /// Returns the result of a world. `None` if its start is refused.
    fn plan(&self, query: &Query, seed: u64) -> Option<Value> {
        self.place.write("world.toml", query.world());
        match load_scene(&self.robot, &self.world).and_then(|scene| scene.resolve(&Overrides::default(), Rules::Plan)) {
            Ok(_) => Some(plan_result(&self.robot, &self.world, "")),
            Err(error) => {
                let least = query.lowering(query.ends[0]);
                assert!(least < 1e-3, "seed {seed}: {least}: {error}");
                assert!(error.to_string().contains("is not free"), "seed {seed}: {error}");
                None
            }
        }
    }

    /// Checks that the certificate of a found motion holds.
    fn check_certificate(&self, seed: u64) {
        let problem = Problem::load(&self.robot, &self.world).unwrap();
        let plan = plan(&problem, &Options::default()).unwrap();
        let certificate = plan.certificate(&Overrides::default(), None).unwrap();
        let world = self.place.read("world.toml");
        let held = check(&robot(), &world, &certificate);
        assert!(held.is_ok(), "seed {seed}: {:?}\n{world}", held.err());
    }

    fn findings(&self, result: &Value) -> Value {
        super::findings(&[self.robot.clone(), self.world.clone()], "result.json", result.to_string())
    }
}

#[test]
fn motions_of_four_joints_have_no_false_answer() {
    let files = Files::new();
    let (mut found, mut limited, mut faster, mut lowered, mut refused) = (0, 0, 0, 0, 0);
    for seed in cplan_cases::seeds(150) {
        let query = Query::random(&mut cplan_cases::dice(seed));
        let Some(result) = files.plan(&query, seed) else {
            refused += 1;
            continue;
        };
        if result["status"] == "found" {
            found += 1;
            limited += u32::from(query.jerks.is_some());
            let duration = check_found(&query, &result, seed);
            let findings = files.findings(&result);
            assert_eq!(findings["verdict"], "free", "seed {seed}: {findings:#}");
            if found % 4 == 0 {
                files.check_certificate(seed);
            }
            let resting = Query { arch: "arch = false", ..query };
            let other = files.plan(&resting, seed).unwrap();
            let resting = other["duration"].as_f64().unwrap();
            assert!(duration <= resting + 1e-6, "seed {seed}: {duration} {resting}");
            faster += u32::from(duration < resting - 1e-6);
        } else if result.to_string().contains("while the tool is lowered") {
            lowered += 1;
            assert!(query.lowering(query.ends[1]) < 1e-3, "seed {seed}: {result:#}");
        }
    }
    let counts = [found, limited, faster, lowered, refused];
    assert!(found > 20 && limited > 10 && faster > 5 && lowered > 2 && refused > 2, "{counts:?}");
}

/// Between two lowered places, with a post below the raised tool.
fn example() -> Query {
    let post = Post { at: [0.5, 0.0], radius: 0.05, height: [0.0, 0.2] };
    Query { posts: vec![post], ends: [[0.4, 0.3, -0.1, 0.5], [-0.6, -0.3, -0.15, -1.0]], arch: "", jerks: None }
}

/// Draws motions without posts. All four joints may move at the same time there, so the longest of their own least times is
/// the duration of a motion, and no bound may exceed it. If both heights are on the same side of the raised position, the
/// bound is about motions that raise the tool.
#[test]
fn no_bound_exceeds_the_duration_of_a_stroke_through_the_raised_position() {
    let files = Files::new();
    for seed in cplan_cases::seeds(12) {
        let mut dice = cplan_cases::dice(seed);
        let query = Query { posts: Vec::new(), arch: "", ..Query::random(&mut dice) };
        let mut ends = query.ends;
        ends[0][2] = dice.within(0.005, 0.05);
        ends[1][2] = -dice.within(0.005, 0.25);
        if dice.chance(0.5) {
            let [first, last] = &mut ends;
            std::mem::swap(&mut first[2], &mut last[2]);
        }
        // The arm hardly moves, so the stroke takes the longest.
        ends[1][0] = ends[0][0] + 0.01;
        let query = Query { ends, jerks: None, ..query };
        let result = files.plan(&query, seed).unwrap();
        let duration = check_motion(&query, &result, seed);
        let [from, to] = query.ends;
        let own = (0..4).map(|j| least_seconds((to[j] - from[j]).abs(), SPEEDS[j], ACCELERATIONS[j]));
        let possible = own.fold(0.0, f64::max);
        let stated = result["lower_bound"].as_f64().unwrap();
        assert!(stated <= possible && stated > 0.99 * possible, "seed {seed}: {stated} {possible} {duration}");
        // This world demands a stop.
        let resting = files.plan(&Query { arch: "arch = false", ..query }, seed).unwrap();
        let strokes: f64 = [from, to].map(|end| least_seconds(end[2].abs(), SPEEDS[2], ACCELERATIONS[2])).iter().sum();
        assert!(resting["lower_bound"].as_f64().unwrap() >= strokes - 1e-6, "seed {seed}");
    }
}

/// Draws goals that differ from the start by rounding. Such joints must not move at all. Also draws goals to which the arm
/// moves for some microseconds, during which the wrist must keep its limits.
#[test]
fn moves_below_rounding_are_dropped() {
    let files = Files::new();
    for seed in cplan_cases::seeds(24) {
        let mut dice = cplan_cases::dice(seed);
        let mut start = Query::random(&mut dice).ends[0];
        (start[2], start[3]) = (0.0, dice.within(-4.0, 4.0));
        let is_rounding = dice.chance(0.5);
        let by = 10_f64.powf(if is_rounding { dice.within(-17.0, -13.0) } else { dice.within(-11.0, -8.0) });
        let mut goal = start.map(|value| value + if dice.chance(0.5) { by } else { -by });
        if !is_rounding {
            goal[2] = start[2];
        }
        goal[3] = start[3] + dice.within(0.5, 1.5);
        let query = Query { posts: Vec::new(), ends: [start, goal], arch: "", jerks: None };
        let result = files.plan(&query, seed).unwrap();
        let duration = check_motion(&query, &result, seed);
        assert_eq!(files.findings(&result)["verdict"], "free", "seed {seed}");
        files.check_certificate(seed);
        let turning = least_seconds(goal[3] - start[3], SPEEDS[3], ACCELERATIONS[3]);
        if is_rounding {
            assert!((duration - turning).abs() < 1e-8, "seed {seed}: {by}: {duration} {turning}");
            assert_eq!(result["length"], 0.0, "seed {seed}: {by}");
        }
        // The same goal, as the position of the tip.
        let [x, y] = tip(start);
        let joints = format!("joints = [{}, {}]\nstroke = {}", goal[0], goal[1], goal[2]);
        let world = query.world().replace(&joints, &format!("tip = [{x}, {y}]"));
        assert!(world.contains("tip = "), "{world}");
        files.place.write("world.toml", world);
        let result = plan_result(&files.robot, &files.world, "");
        let duration =
            check_motion(&Query { ends: [start, [start[0], start[1], 0.0, goal[3]]], ..query }, &result, seed);
        assert!((duration - turning).abs() < 1e-8, "seed {seed}: {duration} {turning}");
    }
}

/// Compares the files of single steps with the rest at their ends. Both worlds have strokes that follow each other within a
/// nanosecond.
#[test]
fn files_of_steps_begin_and_end_at_rest() {
    let robot = "[robot]\njoints = [\"axis_1\", \"axis_2\"]\ntip = \"flange\"\nfixed = { axis_3 = -0.06 }\n";
    let lowered = "stroke = { joint = \"axis_3\", jerk = 50.0 }\n[start]\njoints = [-1.2, 1.4]\nstroke = -0.0103\n\
                   [[step]]\nmove = { joints = [-0.5, 1.2] }\n";
    let carried = "stroke = { joint = \"axis_3\" }\n[start]\njoints = [-1.2, 1.4]\n[[object]]\nname = \"part\"\n\
                   polygon = [[-0.03, -0.01], [0.03, -0.01], [0.03, 0.01], [-0.03, 0.01]]\nheight = [0.057, 0.077]\n\
                   lift = 0.042\nat = [0.25, -0.1525]\n[[step]]\npick = \"part\"\n[[step]]\n\
                   place = { at = [0.25, 0.1525] }\n[[step]]\nmove = { joints = [-0.5, 1.2] }\n";
    let (place, urdf) = (Place::new(), root("robots/scara.urdf").display().to_string());
    for (content, steps) in [(lowered, 1), (carried, 3)] {
        place.run_in(&urdf, [robot, content].concat(), "--per-step --quiet --output plan.csv").exits(0);
        for step in 1..=steps {
            let rows = place.table(&format!("plan-{step:03}.csv"));
            let [first, .., last] = &rows[..] else { panic!("{rows:?}") };
            assert_eq!(first[0], 0.0);
            for row in [first, last] {
                assert_eq!(row[5..9], [0.0; 4], "step {step}: {row:?}");
            }
        }
    }
}

#[test]
fn tampered_results_are_refused() {
    let files = Files::new();
    let result = files.plan(&example(), 0).unwrap();
    assert_eq!(files.findings(&result)["verdict"], "free");
    let step = &result["steps"][0];
    let number = |value: &Value| value.as_f64().unwrap();
    let (raising, lowering) = (number(&step["raising"]["after_departure"]), number(&step["stroke"]["before_arrival"]));
    assert!(raising > 0.0 && lowering > 0.0, "{step:#}");
    let changes: [(&str, Value, &str); 10] = [
        ("/raising/lowered", json!(-0.12), "lowered to -0.12 m before the motion"),
        ("/stroke/lowered", json!(-0.12), "lowered to -0.12 m after the motion"),
        ("/raising", Value::Null, "lowered to no value before the motion"),
        ("/raising/after_departure", json!(raising - 0.02), "stands still"),
        ("/stroke/before_arrival", json!(lowering - 0.02), "stands still"),
        ("/wrist/from", json!(0.4), "the wrist turns from 0.4"),
        ("/wrist/to", json!(-0.9), "to -0.9 rad"),
        ("/wrist/seconds", json!(0.1), "needs"),
        ("/wrist/begin", json!(0.5), "the step ends"),
        ("/wrist", Value::Null, "the wrist does not turn to -1 rad"),
    ];
    for (member, value, words) in changes {
        let mut changed = result.clone();
        *changed.pointer_mut(&format!("/steps/0{member}")).unwrap() = value;
        let findings = files.findings(&changed);
        assert!(findings["verdict"] != "free" && findings.to_string().contains(words), "{member}: {findings:#}");
    }
    // A post that only the lowered tool meets, at the start and at the goal.
    for end in example().ends {
        let post = Post { at: tip(end), radius: 0.01, height: [0.0, 0.2] };
        let blocked = Query { posts: vec![post], ..example() };
        files.place.write("world.toml", blocked.world());
        let findings = files.findings(&result);
        assert_eq!(findings["verdict"], "collision", "{findings:#}");
    }
}
