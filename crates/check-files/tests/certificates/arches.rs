//! Certificates of tasks in which the tool is lowered and raised while the arm moves.

use crate::common::gantry::{GANTRY, KNOTS, judge_steps};
use crate::common::verdict::{Verdict, fails, holds, refused};
#[allow(dead_code, reason = "other tests use more of it")]
use cplan_cases as random;
use cplan_cases::dice::Dice;

/// Depth of the strokes, which is the lift of the block.
const DEPTH: f64 = 0.3;

/// Duration of the strokes, seconds.
const DURATION: f64 = 0.4;

/// The block at (1, 1). It is 0.4 m by 0.2 m, and reaches from the ground to a height.
fn block(height: f64) -> String {
    format!(
        "[[object]]\nname = \"block\"\nat = [1, 1]\nheight = [0, {height}]\nlift = {DEPTH}\n\
         polygon = [[-0.2, -0.1], [0.2, -0.1], [0.2, 0.1], [-0.2, 0.1]]\n"
    )
}

/// Obstacle across the path, from one place and height to another.
fn fence([from, to]: [f64; 2], [low, high]: [f64; 2]) -> String {
    format!(
        "[[obstacle]]\nheight = [{low}, {high}]\npolygon = [[{from}, 0.95], [{to}, 0.95], [{to}, 1.05], [{from}, 1.05]]\n"
    )
}

/// The world with the robot's table, objects and obstacles.
fn world(robot: &str, content: &str) -> String {
    format!(
        "[robot]\njoints = [\"x\", \"y\"]\npayload = \"level\"\nstroke = {{ joint = \"z\" }}\nwrist = {{ velocity = 1 }}\n{robot}\n\
         [start]\njoints = [0, 1]\n{content}\
         [[step]]\npick = \"block\"\n[[step]]\nplace = {{ at = [3, 1] }}\n[[step]]\nmove = {{ joints = [5, 1] }}\n"
    )
}

/// A stroke that begins at a time, in a single cubic.
fn stroke(begin: f64, [from, to]: [f64; 2]) -> String {
    format!("[[{begin}, {from}, 0], [{}, {to}, 0]]", begin + DURATION)
}

fn lowering(begin: f64) -> String {
    format!(", \"lowering\": {}", stroke(begin, [0.0, DEPTH]))
}

fn raising(begin: f64) -> String {
    format!(", \"raising\": {}", stroke(begin, [DEPTH, 0.0]))
}

/// Checks a certificate for a world. `more` are further members of each step. Returns the exit code and the message.
fn judge_in(urdf: &str, world: &str, more: &[&str]) -> Verdict {
    let step = |k: usize| format!("{{\"step\": {}, \"knots\": [{}, {}]{}}}", k + 1, 2 * k, 2 * k + 1, more[k]);
    let steps: Vec<String> = (0..more.len()).map(step).collect();
    let knots = if more.len() == 2 { KNOTS.split(", [5").next().unwrap() } else { KNOTS };
    judge_steps(urdf, world, knots, &steps.join(", "))
}

/// Checks a certificate for the low block among obstacles.
fn judge(content: &str, more: [&str; 3]) -> Verdict {
    judge_in(GANTRY, &world("", &format!("{}{content}", block(0.05))), &more)
}

/// Returns the share of a stroke's duration after which it has gone a share of its length.
fn share_of_duration(of_length: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if middle * middle * (3.0 - 2.0 * middle) < of_length { low = middle } else { high = middle }
    }
    low
}

#[test]
fn strokes_may_overlap_with_motions() {
    let (down, up) = (lowering(0.9), raising(1.8));
    let place = format!("{}{}", lowering(2.9), raising(3.7));
    let both = format!("{down}{up}");
    for more in [[&*both, &*place, ""], [&*both, "", ""], [&*down, &*place, ""], ["", &*lowering(2.9), ""]] {
        holds(judge("", more));
    }
}

/// Tests the block above a fence of height 0.2. It must not be lower than 0.2 while it is above the fence.
#[test]
fn the_payload_has_the_heights_of_each_moment() {
    // The block has passed the fence at 2.925 s, and reaches it at 2.075 s.
    let (behind, before) = (fence([2.6, 2.65], [0.1, 0.2]), fence([1.35, 1.4], [0.1, 0.2]));
    let down = 2.925 - DURATION * share_of_duration(1.0 / 3.0);
    let up = 2.075 - DURATION * share_of_duration(2.0 / 3.0);
    holds(judge(&behind, ["", &lowering(down + 1e-6), ""]));
    fails(judge(&behind, ["", &lowering(down - 1e-6), ""]), "during a stroke, ");
    holds(judge(&before, [&raising(up - 1e-6), "", ""]));
    fails(judge(&before, [&raising(up + 1e-6), "", ""]), "during a stroke, ");
    // A fence below all heights of these moments does not matter.
    holds(judge(&fence([2.6, 2.65], [0.0, 0.05]), ["", &lowering(2.7), ""]));
    fails(judge(&fence([2.6, 2.65], [0.0, 0.05]), ["", &lowering(2.6), ""]), "the payload");
}

/// Tests obstacles whose borders the block does not touch when it descends.
#[test]
fn the_payload_does_not_descend_around_an_obstacle() {
    let wide = |x: f64, begin: f64| {
        let post = format!("[[obstacle]]\nheight = [0.1, 0.2]\ncircle = {{ center = [{x}, 1], radius = 0.001 }}\n");
        let block = block(0.05).replace("0.2, ", "0.9, ").replace("-0.1]", "-0.5]").replace("0.1]", "0.5]");
        judge_in(GANTRY, &world("", &format!("{block}{post}")), &["", &lowering(begin), ""])
    };
    holds(wide(2.05, 2.95));
    fails(wide(2.05, 2.7), "during a stroke, ");
    fails(wide(2.5, 2.7), "during a stroke, obstacle 0 is inside the payload");
    let above_plate = |low: f64, high: f64| {
        let plate = format!("[[obstacle]]\nheight = [{low}, {high}]\npolygon = [[2, -3], [6, -3], [6, 5], [2, 5]]\n");
        judge(&plate, ["", &lowering(2.7), ""])
    };
    holds(above_plate(-0.2, -0.1));
    fails(above_plate(0.1, 0.2), "during a stroke, the payload is inside obstacle 0");
}

#[test]
fn the_tool_has_the_heights_of_each_moment() {
    // The ball is past the fence at 0.79 s. Its lower end is at 0.49, and 0.09 lower at the top of the fence.
    let fence = fence([0.72, 0.78], [0.3, 0.4]);
    let down = 0.79 - DURATION * share_of_duration(0.09 / DEPTH);
    holds(judge(&fence, [&lowering(down + 1e-6), "", ""]));
    fails(judge(&fence, [&lowering(down - 1e-6), "", ""]), "link \"quill\", collision 0");
    // Upwards is the direction of greater values if the axis says so.
    let upward = GANTRY.replace("0 0 -1", "0 0 1").replace("lower=\"0\" upper=\"1\"", "lower=\"-1\" upper=\"0\"");
    let with = |begin: f64, lowered: f64| {
        let down = format!(", \"lowering\": {}", stroke(begin, [0.0, lowered]));
        judge_in(&upward, &world("", &format!("{}{fence}", block(0.05))), &[&down, "", ""])
    };
    holds(with(down + 1e-6, -DEPTH));
    fails(with(down - 1e-6, -DEPTH), "link \"quill\", collision 0");
    fails(with(down + 1e-6, DEPTH), "the raised to the lowered height");
}

#[test]
fn strokes_are_smooth_and_lead_from_end_to_end() {
    let with = |knots: &str| judge("", ["", &format!(", \"lowering\": {knots}"), ""]);
    holds(with("[[2.9, 0, 0], [3.1, 0.15, 1.2], [3.3, 0.3, 0]]"));
    holds(with("[[2.9, 1e-10, 0], [3.3, 0.2999999999, 0]]"));
    for (knots, part) in [
        ("[[2.9, 0, 0], [3.3, 0.299, 0]]", "the raised to the lowered height"),
        ("[[2.9, 0, 0], [3.3, 0.300000002, 0]]", "the raised to the lowered height"),
        ("[[2.9, 0.000000002, 0], [3.3, 0.3, 0]]", "the raised to the lowered height"),
        ("[[2.9, 0, 0], [3.3, -0.3, 0]]", "the raised to the lowered height"),
        ("[[2.9, 0.3, 0], [3.3, 0, 0]]", "the raised to the lowered height"),
        ("[[2.9, 0, 0.1], [3.3, 0.3, 0]]", "do not begin and end at rest"),
        ("[[2.9, 0, 0], [3.3, 0.3, 1e-300]]", "do not begin and end at rest"),
        ("[[2.9, 0, 0], [3.3, 0, 0]]", "do not begin and end at rest"),
        ("[[2.9, 0, 0], [3, 0.2, 0], [3.1, 0.1, 0], [3.3, 0.3, 0]]", "turn back after knot 1"),
        ("[[2.9, 0, 0], [3.1, 0.15, -0.01], [3.3, 0.3, 0]]", "turn back after knot 0"),
        ("[[2.9, 0, 0], [3.1, 0.15, 3], [3.3, 0.3, 0]]", "turn back after knot 0"),
        ("[[2.9, 0, 0], [2.9, 0.15, 0], [3.3, 0.3, 0]]", "time of knot 1 is not after"),
        ("[[3.3, 0, 0], [2.9, 0.3, 0]]", "time of knot 1 is not after"),
        ("[[2.9, 0, 0]]", "fewer than two knots"),
        ("[]", "fewer than two knots"),
    ] {
        fails(with(knots), part);
    }
    for knots in ["[[2.9, 0], [3.3, 0.3]]", "3", "[[2.9, 0, 0, 0], [3.3, 0.3, 0, 0]]"] {
        refused(with(knots), "this is not a certificate");
    }
}

#[test]
fn the_tool_is_raised_between_strokes() {
    let slow = |name: &str, begin: f64, ends: [f64; 2], end: f64| {
        format!(", \"{name}\": [[{begin}, {}, 0], [{end}, {}, 0]]", ends[0], ends[1])
    };
    let with = |up: f64, down: f64| judge("", [&raising(up), &slow("lowering", down, [0.0, DEPTH], 3.1), ""]);
    let part = "not completely raised between the two strokes";
    holds(with(2.0, 2.4));
    // So much earlier the tool is less than a nanometre below its raised position.
    holds(with(2.0, 2.399999));
    fails(with(2.0, 2.3999), part);
    fails(with(1.9, 2.2), part);
    // The whole stroke is within the motion between the steps.
    holds(judge("", [&slow("raising", 1.9, [DEPTH, 0.0], 3.0), "", ""]));
    fails(judge("", [&slow("raising", 1.9, [DEPTH, 0.0], 3.1), "", ""]), part);
    holds(judge("", ["", &slow("lowering", 2.0, [0.0, DEPTH], 3.1), ""]));
    fails(judge("", ["", &slow("lowering", 1.9, [0.0, DEPTH], 3.1), ""]), part);
}

#[test]
fn the_arm_rests_while_the_tool_is_lowered() {
    let with = |dwell: &str, pick: String| {
        let world =
            world("", &block(0.05)).replacen("pick = \"block\"", &format!("pick = \"block\"\ndwell = {dwell}"), 1);
        judge_in(GANTRY, &world, &[&pick, "", ""])
    };
    let both = |down: f64, up: f64| format!("{}{}", lowering(down), raising(up));
    holds(with("0.5", both(0.9, 1.8)));
    holds(with("0.5", both(0.9, 1.7999995)));
    fails(with("0.5", both(0.9, 1.79999)), "the tool is not lowered for 0.5 s");
    fails(with("0", both(0.9, 1.2)), "the tool is not lowered for 0 s");
    fails(with("0", raising(0.9)), "the tool is not lowered for 0 s");
    holds(with("0.7", lowering(0.9)));
    fails(with("0.71", lowering(0.9)), "the tool is not lowered for 0.71 s");
    fails(with("0", lowering(0.5)), "the lowering does not end");
    fails(with("0", raising(2.1)), "the raising does not begin");
    // A double may be off by its last digit.
    holds(with("0", lowering(0.5999999999)));
    fails(with("0", lowering(0.59999)), "the lowering does not end");
    holds(with("0", raising(2.0000000001)));
    fails(with("0", raising(2.00001)), "the raising does not begin");
    let late = ", \"lowering\": [[0.9, 0, 0], [2.1, 0.3, 0]]";
    fails(with("0", late.to_owned()), "the tool is not lowered for 0 s");
}

#[test]
fn the_least_heights_of_the_world_are_kept() {
    let with = |arch: &str, more: [&str; 3]| judge_in(GANTRY, &world(arch, &block(0.05)), &more);
    let strokes = ["", &*format!("{}{}", lowering(2.9), raising(3.8)), ""];
    for arch in ["", "arch = true", "arch = {}", "arch = { rise = 0.1, fall = 0.2 }", "arch.rise = 0"] {
        holds(with(arch, strokes));
    }
    holds(with("arch = false", [""; 3]));
    fails(with("arch = false", strokes), "requires the arm to rest during strokes");
    // A quarter of its duration after its beginning, the tool is 0.046875 m lower. After half of it, it has risen by half.
    holds(with("arch = { fall = 0.253125, rise = 0.15 }", strokes));
    holds(with("arch = { fall = 0.2531250005, rise = 0.1500000005 }", strokes));
    fails(with("arch = { fall = 0.25312501 }", strokes), "arrives with the tool lower than 0.25312501 m");
    fails(with("arch = { rise = 0.15000001 }", strokes), "departs before the tool has risen by 0.15000001 m");
    refused(with("arch = 3", strokes), "expected a table");
    refused(with("arch = { rise = -0.1 }", strokes), "negative");
    refused(with("arch = { fall = -1e-9 }", [""; 3]), "negative");
    refused(with("arch = { height = 0.1 }", strokes), "does not know the key height of [robot] arch");
    // Without a stroke there are no heights. A switch says whether the wrist turns during motions.
    let without = |arch: &str| {
        let world = world(arch, &block(0.05)).replace("stroke = { joint = \"z\" }\n", "");
        [judge_in(GANTRY, &world, &[""; 3]), judge_in(GANTRY, &world.replace("wrist =", "# "), &[""; 3])]
    };
    holds(without("arch = true")[0].clone());
    refused(without("arch = true")[1].clone(), "needs a joint that lowers the tool");
    refused(without("arch = { rise = 0.1 }")[0].clone(), "needs a joint that lowers the tool");
}

#[test]
fn strokes_belong_to_picks_and_places() {
    let plain = world("", &block(0.05));
    let (down, up) = (lowering(2.9), raising(3.7));
    fails(judge("", ["", "", &*lowering(4.9)]), "neither picks nor places");
    fails(judge("", ["", "", &*raising(4.9)]), "neither picks nor places");
    let without = plain.replace("stroke = { joint = \"z\" }\n", "");
    fails(judge_in(GANTRY, &without, &["", &down, ""]), "no joint that lowers the tool");
    let two_steps = plain.split("[[step]]\nmove").next().unwrap();
    holds(judge_in(GANTRY, two_steps, &["", &down]));
    fails(judge_in(GANTRY, two_steps, &["", &up]), "but the task ends");
    // The wrist turns the block before it is lowered, and after it is raised.
    let turned = plain.replace("at = [3, 1] }", "at = [3, 1], angle = 1 }");
    let turn = ", \"turn\": 1";
    let part = "the wrist turns in between";
    let place = |more: &str| judge_in(GANTRY, &turned, &["", &format!("{turn}{more}"), ""]);
    holds(place(&up));
    fails(place(&down), part);
    let pick = |more: &str| judge_in(GANTRY, &turned, &[&format!("{turn}{more}"), "", ""]);
    holds(pick(&lowering(0.9)));
    fails(pick(&raising(1.7)), part);
}

/// Tests the ball above a tall block, which it meets only while it is lowered.
#[test]
fn the_lowered_tool_touches_objects_only_at_rest() {
    let tall = world("", &block(0.25));
    let with = |urdf: &str, more: [&str; 3]| judge_in(urdf, &tall, &more);
    let early = ", \"lowering\": [[0.6, 0, 0], [1, 0.3, 0]]";
    holds(with(GANTRY, [&lowering(0.9), "", ""]));
    fails(with(GANTRY, [early, "", ""]), "during a stroke, link \"quill\", collision 0");
    // At departure, the ball has risen by 0.047 m or by 0.253 m. It is above the block after 0.06 m.
    holds(with(GANTRY, ["", &raising(3.7), ""]));
    let up = 4.0 - DURATION * share_of_duration(0.06 / DEPTH);
    holds(with(GANTRY, ["", &raising(up - 1e-6), ""]));
    fails(with(GANTRY, ["", &raising(up + 1e-6), ""]), "link \"quill\", collision 0");
    // A head at the height of the block touches it while the tool is raised.
    let low_head = GANTRY.replace("0 0 1\"/> <geometry> <box", "0 0 0.1\"/> <geometry> <box");
    holds(with(&low_head, [early, &raising(3.9), ""]));
}

/// Tests a block that is renewed while the tool still rises from its old place.
#[test]
fn renewed_objects_count_at_both_places_while_the_tool_rises() {
    let steps = |up: f64| {
        let up = raising(up);
        format!(
            r#"{{"step": 1, "knots": [0, 1]}}, {{"step": 2, "knots": [2, 3]{up}}},
            {{"step": 1, "knots": [4, 5]}}, {{"step": 2, "knots": [6, 7]}}"#
        )
    };
    let knots = "[0, 0, 1], [1, 1, 1], [2, 1, 1], [3, 3, 1], [4, 3, 1], [5, 1, 1], [6, 1, 1], [7, 3, 1]";
    let with = |at: f64, up: f64| {
        let renewed = block(0.25).replace("name", "renew = true\nname");
        let world = world("", &format!("{renewed}[task]\nrepeat = 2\n"));
        let world = world.split("[[step]]\nmove").next().unwrap().replace("[3, 1]", &format!("[{at}, 1]"));
        judge_steps(GANTRY, &world, &knots.replace("3, 1]", &format!("{at}, 1]")), &steps(up))
    };
    holds(with(3.0, 3.7));
    fails(with(3.0, 3.9), "link \"quill\", collision 0");
    // The new block overlaps the old one, so the tool is above both.
    holds(with(1.1, 3.7));
    fails(with(1.1, 3.9), "link \"quill\", collision 0");
}

/// Tests a tool that is lowered less than the block. It is not known where the block is meanwhile, so it counts at all
/// its heights.
#[test]
fn objects_that_do_not_follow_the_tool_have_all_heights() {
    let with = |travel: f64, begin: f64| {
        let stroke = format!("stroke = {{ joint = \"z\", travel = {travel} }}");
        let content = format!("{}{}", block(0.05), fence([2.6, 2.65], [0.1, 0.2]));
        let world = world("", &content).replace("stroke = { joint = \"z\" }", &stroke);
        let down = format!(", \"lowering\": [[{begin}, 0, 0], [{}, {travel}, 0]]", begin + DURATION);
        judge_in(GANTRY, &world, &["", &down, ""])
    };
    holds(with(0.3, 2.9));
    holds(with(0.30, 2.9));
    fails(with(0.2, 2.924), "the payload");
    holds(with(0.2, 2.926));
    fails(with(0.1, 2.924), "the payload");
}

#[test]
fn moving_obstacles_allow_no_arches() {
    let mover =
        "[[obstacle]]\ncircle = { center = [0, 0], radius = 0.1 }\nat = [50, 50]\nmotion = { velocity = [1, 0] }\n";
    fails(judge(mover, ["", &lowering(2.9), ""]), "among moving obstacles");
}

/// Gap between two intervals; negative if they overlap.
fn gap(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[1]).max(b[0] - a[1])
}

/// Random strokes and fences.
struct Arches {
    /// Begin and duration of the strokes that lower the tool at 1 s and at 3 s.
    lowerings: [[f64; 2]; 2],
    /// Begin and duration of the strokes that raise the tool after 2 s and after 4 s. The second one is not in use.
    raising: [f64; 2],
    /// Ranges of each fence: along the path, and of heights.
    fences: Vec<[[f64; 2]; 2]>,
}

impl Arches {
    fn random(dice: &mut Dice) -> Self {
        let mut lowering = |arrival: f64| {
            let before = dice.within(0.02, 0.45);
            [arrival - before, before + dice.within(0.0, 0.4)]
        };
        let lowerings = [lowering(1.0), lowering(3.0)];
        let after = dice.within(0.02, 0.45);
        let before = dice.within(0.0, 0.4);
        let raising = [2.0 - before, before + after];
        let fence = |dice: &mut Dice| {
            let (at, low) = (dice.within(0.3, 3.4), dice.within(0.0, 0.5));
            [[at, at + dice.within(0.02, 0.2)], [low, low + dice.within(0.01, 0.1)]]
        };
        let fences = (0..=dice.below(2)).map(|_| fence(dice)).collect();
        Self { lowerings, raising, fences }
    }

    fn judge(&self) -> Verdict {
        let fences: String = self.fences.iter().map(|[along, heights]| fence(*along, *heights)).collect();
        let stroke = |name: &str, [begin, duration]: [f64; 2], [from, to]: [f64; 2]| {
            format!(", \"{name}\": [[{begin}, {from}, 0], [{}, {to}, 0]]", begin + duration)
        };
        let [pick, place] = self.lowerings.map(|lowering| stroke("lowering", lowering, [0.0, DEPTH]));
        let pick = format!("{pick}{}", stroke("raising", self.raising, [DEPTH, 0.0]));
        judge(&fences, [&pick, &place, ""])
    }

    /// Returns the depth of the tool at a time while the arm moves.
    fn depth(&self, time: f64) -> f64 {
        let share = |[begin, duration]: [f64; 2]| {
            let share = ((time - begin) / duration).clamp(0.0, 1.0);
            share * share * (3.0 - 2.0 * share)
        };
        let [pick, place] = self.lowerings;
        DEPTH * if time < 1.5 { share(pick) } else { (1.0 - share(self.raising)).max(share(place)) }
    }

    /// Returns the least distance between a moving shape and a fence, of samples. It is the greater one of the gaps
    /// along the path and between the heights. Negative if a sample collides.
    fn margin(&self) -> f64 {
        let mut margin = f64::INFINITY;
        for sample in 0..=10_000 {
            let time = f64::from(sample) / 2000.0;
            let at = match time {
                ..1.0 => time,
                ..2.0 => 1.0,
                ..3.0 => 1.0 + 2.0 * (time - 2.0),
                ..4.0 => 3.0,
                _ => 3.0 + 2.0 * (time - 4.0),
            };
            // While the arm rests, the tool moves through all heights. While it moves, it must be free at the raised
            // height, too.
            let rests = (1.0..=2.0).contains(&time) || (3.0..=4.0).contains(&time);
            let depth = if time > 4.0 { 0.0 } else { self.depth(time) };
            let depths = if rests { vec![[0.0, DEPTH]] } else { vec![[0.0; 2], [depth; 2]] };
            let ball = ([at - 0.01, at + 0.01], [0.49, 0.51]);
            let block = ([at - 0.2, at + 0.2], [DEPTH, DEPTH + 0.05]);
            let carries = (1.0..=4.0).contains(&time);
            for (along, [low, high]) in std::iter::once(ball).chain(carries.then_some(block)) {
                for [least, most] in &depths {
                    let heights = [low - most, high - least];
                    let gaps = self.fences.iter().map(|fence| gap(along, fence[0]).max(gap(heights, fence[1])));
                    margin = gaps.fold(margin, f64::min);
                }
            }
        }
        margin
    }
}

/// Compares random strokes among random fences with dense samples.
#[test]
fn random_strokes_are_free_as_samples_are() {
    let (mut free, mut blocked) = (0, 0);
    for seed in random::seeds(300) {
        let arches = Arches::random(&mut Dice::new(seed));
        let margin = arches.margin();
        let (code, report) = arches.judge();
        if margin > 2e-3 {
            assert_eq!(code, 0, "{seed}: {margin}: {report}");
            free += 1;
        } else if margin < -2e-3 {
            assert_eq!(code, 3, "{seed}: {margin}: {report}");
            blocked += usize::from(report.contains("during a stroke"));
        }
    }
    assert!(free > 20 && blocked > 5, "{free} are free, {blocked} collide only during a stroke");
}
