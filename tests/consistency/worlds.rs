//! Random robots and worlds as files: motions of two and of four joints.

use cplan_cases::dice::Dice;
use std::f64::consts::PI;
use std::fmt::Write;

/// A robot (URDF) with a world.
pub struct Case {
    pub urdf: String,
    pub world: String,
    /// The start as the world states it.
    pub start: [f64; 2],
    /// The goal, if the world states joint values.
    pub goal: Option<[f64; 2]>,
    /// True if the world has steps.
    pub has_steps: bool,
    /// True if the tool's joints move.
    pub has_tool: bool,
    /// The line for `cplan follow`, in TOML.
    pub line: Option<String>,
}

/// The robot of worlds whose tool is lowered, and the lengths of its links in metres.
pub const SCARA: &str = include_str!("../../robots/scara.urdf");
pub const SCARA_LINKS: [f64; 2] = [0.3, 0.25];

/// Draws joint values, within the limits of both shipped robots.
pub fn joints(dice: &mut Dice) -> [f64; 2] {
    [dice.within(-2.3, 2.3), dice.within(-2.5, 2.5)]
}

/// Returns obstacles of all shapes within a distance of the base.
pub fn obstacles(dice: &mut Dice, count: usize, reach: f64, heights: Option<f64>) -> String {
    placed_obstacles(dice, count, reach, heights, |x| x)
}

/// Does the same as [`obstacles`], with rounded coordinates.
fn placed_obstacles(
    dice: &mut Dice,
    count: usize,
    reach: f64,
    heights: Option<f64>,
    rounded: impl Fn(f64) -> f64,
) -> String {
    let mut text = String::new();
    for number in 0..count {
        let (distance, angle) = (reach * dice.within(0.25, 1.1), dice.within(-PI, PI));
        let [x, y] = [distance * angle.cos(), distance * angle.sin()].map(&rounded);
        let size = rounded(reach * dice.within(0.02, 0.16)).max(0.01);
        let shape = match dice.below(4_u64) {
            0 => format!("circle = {{ center = [{x}, {y}], radius = {size} }}"),
            1 => {
                format!("polyline = [[{x}, {y}], [{}, {}]]", x + 3.0 * size, rounded(y + dice.within(-3.0, 3.0) * size))
            }
            2 => format!("polygon = [[{x}, {y}], [{}, {y}], [{}, {}]]", x + 2.0 * size, x + size, y + 2.0 * size),
            _ => format!(
                "polygon = [[{x}, {y}], [{0}, {y}], [{0}, {1}], [{x}, {1}]]",
                x + size,
                y + rounded(dice.within(0.5, 3.0) * size).max(0.01)
            ),
        };
        let height = heights.filter(|_| dice.chance(0.8)).map_or_else(String::new, |most| {
            let low = if dice.chance(0.3) { dice.within(0.0, most) } else { 0.0 };
            format!("height = [{low}, {}]\n", low + dice.within(0.1, 0.8) * most)
        });
        writeln!(text, "[[obstacle]]\nname = \"o{number}\"\n{shape}\n{height}").unwrap();
    }
    text
}

/// Returns a post that the first link meets between two of its angles, or no post.
fn post_between(dice: &mut Dice, length: f64, [from, to]: [f64; 2]) -> String {
    if dice.chance(0.6) {
        return String::new();
    }
    let (angle, distance) = (from + dice.within(0.3, 0.7) * (to - from), length * dice.within(0.4, 0.9));
    let [x, y] = [distance * angle.cos(), distance * angle.sin()];
    format!("[[obstacle]]\nname = \"post\"\ncircle = {{ center = [{x}, {y}], radius = {} }}\n", 0.05 * length)
}

/// Draws a motion of an arm with two joints of any kind.
pub fn motion(dice: &mut Dice) -> Case {
    // Round numbers make shapes touch exactly.
    let is_round = dice.chance(0.3);
    let rounded = |x: f64| if is_round { (10.0 * x).round() / 10.0 } else { x };
    let kinds = [dice.chance(0.3 + 0.5 * f64::from(u8::from(is_round))), dice.chance(0.3)];
    let lengths = [dice.within(0.4, 1.0), dice.within(0.3, 0.9)].map(rounded);
    let mut urdf = String::from("<robot name=\"drawn\"><link name=\"base\"/>");
    let mut ranges = [[0.0; 2]; 2];
    for (k, [parent, child]) in [["base", "upper"], ["upper", "fore"]].into_iter().enumerate() {
        let continues = !kinds[k] && dice.chance(0.3);
        let (kind, axis) = match (kinds[k], continues) {
            (true, _) => ("prismatic", if k == 0 { "1 0 0" } else { "0 1 0" }),
            (false, true) => ("continuous", "0 0 1"),
            (false, false) => ("revolute", "0 0 1"),
        };
        ranges[k] = match kinds[k] {
            true => [dice.within(-0.8, -0.1), dice.within(0.1, 0.9)].map(rounded),
            false => [dice.within(-3.1, -1.0), dice.within(1.0, 3.1)],
        };
        let [lower, upper] = ranges[k];
        let from = if k == 0 { 0.0 } else { lengths[0] };
        let limit = if continues { String::new() } else { format!("lower=\"{lower}\" upper=\"{upper}\"") };
        let (length, width) = (lengths[k], rounded(dice.within(0.02, 0.12)).max(0.02));
        let shape = match dice.below(3_u64) {
            0 => format!("<box size=\"{length} {width} 0.1\"/>"),
            1 => format!("<cylinder radius=\"{}\" length=\"0.1\"/>", 0.4 * length),
            _ => format!("<box size=\"{length} {} 0.1\"/>", 0.5 * width),
        };
        write!(
            urdf,
            "<joint name=\"j{k}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>\
             <origin xyz=\"{from} 0 {}\"/><axis xyz=\"{axis}\"/><limit {limit} velocity=\"1\" effort=\"1\"/></joint>\
             <link name=\"{child}\"><collision><origin xyz=\"{} 0 0\"/><geometry>{shape}</geometry></collision></link>",
            0.15 * k as f64,
            length / 2.0
        )
        .unwrap();
    }
    urdf += "</robot>";
    let draw = |dice: &mut Dice| ranges.map(|[lower, upper]| rounded(dice.within(lower, upper)));
    let (start, goal) = (draw(dice), draw(dice));
    let clearance = if dice.chance(0.3) { dice.within(0.0, 0.03) } else { 0.0 };
    let clearance = if is_round && clearance > 0.0 { 0.1 } else { clearance };
    let mut world = format!("clearance = {clearance:?}\nstart.joints = {start:?}\n");
    let is_place = dice.chance(0.3);
    let [distance, angle] = [dice.within(0.2, 1.6), dice.within(-PI, PI)];
    let [x, y] = [distance * angle.cos(), distance * angle.sin()];
    let stated = match is_place {
        true if dice.chance(0.3) => format!("goal.areas = [[[{x}, {y}], [{}, {}]]]", x + 0.1, y + 0.05),
        true => format!("goal.tip = [{x}, {y}]"),
        false => format!("goal.joints = {goal:?}"),
    };
    writeln!(world, "{stated}").unwrap();
    let count = dice.below(6_usize);
    world += &placed_obstacles(dice, count, 1.5, None, rounded);
    world += &post_between(dice, lengths[0], [start[0], goal[0]]);
    if dice.chance(0.4) {
        writeln!(world, "[robot]\njerk = {{ j0 = 20.0, j1 = {} }}", dice.within(5.0, 200.0)).unwrap();
    }
    let goal = (!is_place).then_some(goal);
    Case { urdf, world, start, goal, has_steps: false, has_tool: false, line: None }
}

/// Draws a motion of four joints: start and goal state the heights of the quill and the angles of the wrist.
pub fn four_joints(dice: &mut Dice) -> Case {
    let (start, goal) = (joints(dice), joints(dice));
    let end = |dice: &mut Dice, name: &str, q: [f64; 2]| {
        let stroke = if dice.chance(0.8) { format!("stroke = {}\n", -dice.within(0.0, 0.15)) } else { String::new() };
        let wrist = if dice.chance(0.5) { format!("wrist = {}\n", dice.within(-4.0, 4.0)) } else { String::new() };
        format!("[{name}]\njoints = {q:?}\n{stroke}{wrist}")
    };
    let ends = end(dice, "start", start) + &end(dice, "goal", goal);
    let count = 1 + dice.below(6_usize);
    let table = scara_table(dice, "");
    let posts = obstacles(dice, count, 0.55, Some(0.2)) + &post_between(dice, SCARA_LINKS[0], [start[0], goal[0]]);
    let world = format!("clearance = 0.0\n{ends}{table}{posts}");
    Case { urdf: SCARA.into(), world, start, goal: Some(goal), has_steps: false, has_tool: true, line: None }
}

/// Returns the table of the SCARA with its tool.
pub fn scara_table(dice: &mut Dice, more: &str) -> String {
    let arch = if dice.chance(0.3) { "arch = false\n" } else { "" };
    format!(
        "[robot]\njoints = [\"axis_1\", \"axis_2\"]\ntip = \"flange\"\nstroke = {{ joint = \"axis_3\" }}\n\
         wrist = {{ joint = \"axis_4\", velocity = 20.0 }}\n{arch}{more}"
    )
}
