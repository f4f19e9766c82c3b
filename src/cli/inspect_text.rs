//! The report on a robot as text.

use crate::input::{
    Inspection, JointEntry, LimitEntry, LimitSource, LinkEntry, MotorEntry, OutlineEntry, PairEntry, RateEntry,
    RateSource, Role, SelfObstacleEntry,
};
use crate::model::Motors;
use crate::text::{Columns, counted};

/// Largest number of pairs of joints for which the report states why they do not form an arm. Further reasons are similar.
const MAX_SHOWN_REFUSALS: usize = 12;

/// Returns the whole report.
pub fn text(report: &Inspection) -> String {
    let mut lines = Columns::default();
    let count: usize = report.errors.iter().map(|e| e.diagnostics().len()).sum();
    lines.add(
        "result",
        &match count {
            0 => "planning with this robot is possible".to_owned(),
            1 => "planning with this robot is not possible: see the defect".to_owned(),
            n => format!("planning with this robot is not possible: see the {n} defects"),
        },
    );
    let name = report.robot.as_deref().unwrap_or("(no name)");
    lines.add("robot", &format!("{name}, {}", report.urdf));
    lines.add(
        "world",
        report.world.as_deref().unwrap_or("none given, so no world chooses joints, holds them or changes their limits"),
    );
    match &report.root {
        Some(root) => tree(&mut lines, report, root, 0),
        None => report.joints.iter().for_each(|j| lines.add("joints", &branch(report, j))),
    }
    for joint in report.joints.iter().filter(|j| j.axis.is_some()) {
        lines.add("movable", &movable(report, joint));
    }
    if let Some(entry) = &report.motors {
        motors(&mut lines, report, entry);
    }
    pairs(&mut lines, report);
    if let Some([first, second]) = &report.chosen {
        let how = if report.assumed { "; chosen by default, as the first pair that forms a planar arm" } else { "" };
        lines.add("chosen", &format!("\"{first}\" and \"{second}\"{how}"));
    }
    if let Some(plane) = &report.plane {
        lines.add("plane", plane.words.trim_start_matches("plane: "));
    }
    report.outlines.iter().for_each(|o| outline(&mut lines, o));
    report.self_obstacles.iter().for_each(|own| self_obstacle(&mut lines, own));
    if let (Some(reach), Some(tip)) = (&report.reach, &report.tip) {
        let [x, y] = reach.tip;
        lines.add("tip", &format!("origin of link \"{tip}\", at ({x:.4}, {y:.4}) m with both joints at zero"));
        if let Some([least, most]) = reach.distances {
            lines.add("reach", &format!("without joint limits, the tip is {least:.4} to {most:.4} m from joint 1"));
        }
        lines.add(
            "reach",
            &format!("all parts are within {:.4} m of joint 1, if sliding joints are at zero", reach.outline),
        );
    }
    report.ignored.iter().for_each(|i| lines.add("ignored", i));
    report.warnings.iter().for_each(|w| lines.add("warning", w));
    for diagnostic in report.errors.iter().flat_map(|e| e.diagnostics()) {
        diagnostic.to_string().lines().for_each(|line| lines.add("defect", line));
    }
    if let Some(help) = &report.help {
        lines.add(
            "remedy",
            "with these entries in the world file, cplan can read the robot (the numbers are examples):",
        );
        lines.add("remedy", "[robot]");
        help.lines().for_each(|line| lines.add("remedy", line));
    }
    lines.into_text()
}

/// Adds a link and all links below it, indented by depth.
fn tree(lines: &mut Columns, report: &Inspection, link: &str, depth: usize) {
    if depth == 0 {
        lines.add("tree", &describe_link(report, link));
    }
    for joint in report.joints.iter().filter(|j| j.parent == link) {
        lines.add("tree", &format!("{}{}", "  ".repeat(depth + 1), branch(report, joint)));
        tree(lines, report, &joint.child, depth + 1);
    }
}

fn branch(report: &Inspection, joint: &JointEntry) -> String {
    let above = if report.root.is_some() { String::new() } else { format!("\"{}\" - ", joint.parent) };
    let JointEntry { name, kind, line, child, .. } = joint;
    format!("{above}{name} ({kind}, line {line}) - {}", describe_link(report, child))
}

fn describe_link(report: &Inspection, name: &str) -> String {
    let Some(LinkEntry { collision, visual, .. }) = report.links.iter().find(|l| l.name == name) else {
        return format!("\"{name}\" (not declared)");
    };
    match (collision, visual) {
        (0, 0) => format!("\"{name}\""),
        _ => format!("\"{name}\" ({collision} collision, {visual} visual)"),
    }
}

fn unit(joint: &JointEntry) -> &'static str {
    if joint.slides { "m" } else { "rad" }
}

fn movable(report: &Inspection, joint: &JointEntry) -> String {
    let mut words = vec![match (joint.role, joint.value) {
        (Role::Moves, _) => {
            let second = report.chosen.as_ref().is_some_and(|c| c[1] == joint.name);
            format!("moves, joint {}", if second { 2 } else { 1 })
        }
        (Role::Held, Some(value)) => format!("held at {value} {}", unit(joint)),
        (Role::Follows, Some(value)) => format!("follows, held at {value} {}", unit(joint)),
        (Role::Ignored, _) => "ignored: the arm does not depend on it".into(),
        _ => "not decided".into(),
    }];
    if let Some(leader) = &joint.mimics {
        words.push(format!("mimics \"{leader}\""));
    }
    match (joint.direction, joint.axis) {
        (Some(d), _) => words.push(format!("axis {} in the root frame", vector(d))),
        (None, Some(a)) => words.push(format!("axis {} in its own frame", vector(a))),
        (None, None) => {}
    }
    words.extend(joint.limits.map(|l| range(joint, l)));
    words.push(rate(joint, "top speed", "/s", joint.velocity));
    if joint.velocity.is_some() {
        words.push(rate(joint, "acceleration", "/s2", joint.acceleration));
    }
    if joint.jerk.is_some() {
        words.push(rate(joint, "jerk", "/s3", joint.jerk));
    }
    format!("{} ({}): {}", joint.name, joint.kind, words.join("; "))
}

fn range(joint: &JointEntry, limits: LimitEntry) -> String {
    let source = match limits.source {
        LimitSource::Urdf => "URDF",
        LimitSource::Soft => "URDF, narrowed by the soft limits",
        LimitSource::World => "world file",
        LimitSource::Continuous => return "no limits: continuous".into(),
        LimitSource::Unset => return "range unset".into(),
    };
    let [lower, upper] = limits.range.unwrap_or_default();
    let degrees = if joint.slides {
        String::new()
    } else {
        format!(" = {:.1} to {:.1} deg", lower.to_degrees(), upper.to_degrees())
    };
    format!("{lower} to {upper} {}{degrees} ({source})", unit(joint))
}

fn rate(joint: &JointEntry, what: &str, per: &str, rate: Option<RateEntry>) -> String {
    let Some(RateEntry { value, source }) = rate else { return format!("{what} unset") };
    let source = match source {
        RateSource::Urdf => "URDF",
        RateSource::World => "world file",
        RateSource::Default => "default; not specified",
    };
    format!("{what} {value} {}{per} ({source})", unit(joint))
}

/// Describes the motors, and the remaining joint values where motors narrow the limits of joints.
fn motors(lines: &mut Columns, report: &Inspection, entry: &MotorEntry) {
    let in_degrees = |[lower, upper]: [f64; 2]| {
        let [from, to] = [lower, upper].map(f64::to_degrees);
        format!("{lower:.4} to {upper:.4} rad = {from:.1} to {to:.1} deg")
    };
    let mut words = vec![entry.words.trim_start_matches("drives: ").to_owned()];
    let Motors { range, velocity, acceleration, jerk, .. } = entry.motors;
    words.extend(range.map(in_degrees));
    let rates = [("top speed", "rad/s", velocity), ("acceleration", "rad/s2", acceleration), ("jerk", "rad/s3", jerk)];
    words.extend(rates.iter().filter_map(|(what, unit, rate)| Some(format!("{what} {} {unit}", (*rate)?))));
    lines.add("motors", &words.join("; "));
    let joints =
        report.chosen.iter().flatten().filter_map(|name| report.joints.iter().find(|joint| joint.name == *name));
    for (joint, range) in joints.zip(entry.ranges) {
        let own = joint.limits.and_then(|limits| limits.range);
        if let Some(range) = range.filter(|range| own != Some(*range)) {
            lines.add("motors", &format!("they leave \"{}\" {}", joint.name, in_degrees(range)));
        }
    }
}

fn pairs(lines: &mut Columns, report: &Inspection) {
    let pairs = &report.pairs;
    let line = |p: &PairEntry| {
        let verdict = if p.planar { "a planar arm" } else { "no" };
        let reason = p.reason.trim_start_matches("plane: ");
        format!("[\"{}\", \"{}\"] {}: {verdict}: {reason}", p.joints[0], p.joints[1], p.kind)
    };
    pairs.iter().filter(|p| p.planar).for_each(|p| lines.add("pairs", &line(p)));
    let refused: Vec<&PairEntry> = pairs.iter().filter(|p| !p.planar).collect();
    refused.iter().take(MAX_SHOWN_REFUSALS).for_each(|p| lines.add("pairs", &line(p)));
    if refused.len() > MAX_SHOWN_REFUSALS {
        lines.add("pairs", &format!("and {} more that do not form a planar arm", refused.len() - MAX_SHOWN_REFUSALS));
    }
    if pairs.is_empty() {
        // Directions in the root frame are known only if the links form a tree.
        let tried = report.joints.iter().all(|j| j.axis.is_none() || j.direction.is_some());
        let none = "no joint that moves independently carries another such joint";
        lines.add("pairs", if tried { none } else { "not tried, because the joints or their tree have defects" });
    }
}

fn outline(lines: &mut Columns, outline: &OutlineEntry) {
    let OutlineEntry { link, source, parts, area, heights, bodies } = outline;
    let from = match *source {
        "none" => "none: this link has no geometry and cannot collide".to_owned(),
        "bar" => format!("a bar, as the world file requests; {} of {area:.6} m2 in all", counted(*parts, "part")),
        source => format!("from {source} geometry; {} of {area:.6} m2 in all", counted(*parts, "part")),
    };
    let heights = heights.map_or(String::new(), |[lower, upper]| format!("; heights {lower:.4} to {upper:.4} m"));
    lines.add("outline", &format!("\"{link}\": {from}{heights}"));
    for body in bodies.iter().filter(|b| bodies.len() > 1 || b.link != *link) {
        lines.add(
            "outline",
            &format!("  of it \"{}\": {}, {:.6} m2", body.link, counted(body.parts, "part"), body.area),
        );
    }
}

fn self_obstacle(lines: &mut Columns, own: &SelfObstacleEntry) {
    let SelfObstacleEntry { link, moves, heights: [lower, upper], ignored } = own;
    let hit_by = if *moves { "link 2" } else { "both links" };
    let free: Vec<String> = ignored.iter().map(|link| format!("\"{link}\"")).collect();
    let except = if free.is_empty() { String::new() } else { format!(", except {}", free.join(", ")) };
    lines.add("own body", &format!("\"{link}\": an obstacle for {hit_by}{except}; heights {lower:.4} to {upper:.4} m"));
}

fn vector(d: [f64; 3]) -> String {
    let [x, y, z] = d.map(|c| (c * 1e4).round() / 1e4 + 0.0);
    format!("({x}, {y}, {z})")
}
