//! Random tasks as files: picks, places and lines for the tip.

use super::worlds::{Case, SCARA, SCARA_LINKS, joints, obstacles, scara_table};
use cplan_cases::dice::Dice;
use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Write;

/// The robot of worlds with lines, and the lengths of its links in metres.
const PLANAR: &str = include_str!("../../robots/planar_2r.urdf");
const PLANAR_LINKS: [f64; 2] = [1.0, 0.8];

/// Returns the position of the tip.
fn tip(links: [f64; 2], [a, b]: [f64; 2]) -> [f64; 2] {
    [links[0] * a.cos() + links[1] * (a + b).cos(), links[0] * a.sin() + links[1] * (a + b).sin()]
}

/// Draws picks and places of a SCARA that lowers its tool.
pub fn picks(dice: &mut Dice) -> Case {
    let start = joints(dice);
    let level = if dice.chance(0.6) { "payload = \"level\"\n" } else { "" };
    let clearance = if dice.chance(0.3) { dice.within(0.0, 0.003) } else { 0.0 };
    let table = scara_table(dice, level);
    let mut world = format!("clearance = {clearance:?}\n[start]\njoints = {start:?}\n{table}");
    let (is_free, is_renewed) = (dice.chance(0.3), dice.chance(0.3));
    match (is_free, is_renewed) {
        (true, _) => world += "[task]\norder = \"free\"\n",
        (false, true) => world += "[task]\nrepeat = 2\n",
        (false, false) => {}
    }
    let renew = if is_renewed && !is_free { "renew = true\n" } else { "" };
    let count = 1 + dice.below(3_usize);
    let lift = dice.within(0.02, 0.16);
    let mut steps = String::new();
    for number in 0..count {
        let place = |dice: &mut Dice| tip(SCARA_LINKS, joints(dice));
        let ([x, y], [to_x, to_y]) = (place(dice), place(dice));
        let angle = if dice.chance(0.3) { format!(", angle = {}", dice.within(-PI, PI)) } else { String::new() };
        let angle = if level.is_empty() { String::new() } else { angle };
        write!(
            world,
            "[[object]]\nname = \"part {number}\"\ncircle = {{ center = [0.0, 0.0], radius = {} }}\nat = [{x}, {y}]\n\
             height = [0.0, 0.02]\nlift = {lift}\n{renew}",
            dice.within(0.004, 0.02)
        )
        .unwrap();
        write!(steps, "[[step]]\npick = \"part {number}\"\n[[step]]\nplace = {{ at = [{to_x}, {to_y}]{angle} }}\n")
            .unwrap();
        // A rim beside the place, which the lowered tool may hit.
        if dice.chance(0.4) {
            let beside = dice.within(-0.04, 0.03);
            write!(
                world,
                "[[obstacle]]\nname = \"rim {number}\"\npolygon = [[{0}, {1}], [{2}, {1}], [{2}, {3}], [{0}, {3}]]\n\
                 height = [0.0, {4}]\n",
                to_x + beside,
                to_y - 0.01,
                to_x + beside + 0.02,
                to_y + 0.01,
                dice.within(0.01, 0.06)
            )
            .unwrap();
        }
    }
    let obstacle_count = dice.below(4_usize);
    world += &obstacles(dice, obstacle_count, 0.55, Some(0.3));
    if !is_free && dice.chance(0.4) {
        write!(steps, "[[step]]\nmove = {{ joints = {:?} }}\n", joints(dice)).unwrap();
    }
    Case { urdf: SCARA.into(), world: world + &steps, start, goal: None, has_steps: true, has_tool: true, line: None }
}

/// Draws the corners of a line as points of the plane, and a post near the line or none.
fn corners(dice: &mut Dice) -> (String, String) {
    let (distance, angle) = (dice.within(0.4, 1.75), dice.within(-PI, PI));
    let middle = [distance * angle.cos(), distance * angle.sin()];
    let size = dice.within(0.02, 0.3);
    let count = 2 + dice.below(4_u64);
    let corner = |dice: &mut Dice| {
        format!("[{}, {}]", middle[0] + size * dice.within(-1.0, 1.0), middle[1] + size * dice.within(-1.0, 1.0))
    };
    let corners = (0..count).map(|_| corner(dice)).collect::<Vec<_>>().join(", ");
    let (near, radius) = (size * dice.within(0.0, 1.5), size * dice.within(0.1, 0.4));
    let post = format!(
        "[[obstacle]]\nname = \"post\"\ncircle = {{ center = [{}, {}], radius = {radius} }}\n",
        middle[0] + near,
        middle[1]
    );
    (corners, if dice.chance(0.5) { post } else { String::new() })
}

/// Draws a planar arm that carries an object along lines.
pub fn line_steps(dice: &mut Dice) -> Case {
    let start = [dice.within(-2.5, 2.5), FRAC_PI_2 * dice.within(0.3, 1.2)];
    let count = dice.below(4_usize);
    let posts = obstacles(dice, count, 1.7, None);
    let mut world = format!("clearance = 0.0\n[start]\njoints = {start:?}\n{posts}");
    let mut steps = String::new();
    let carries = dice.chance(0.4);
    let place = |dice: &mut Dice| tip(PLANAR_LINKS, joints(dice));
    if carries {
        let [x, y] = place(dice);
        write!(world, "[[object]]\nname = \"pen\"\ncircle = {{ center = [0, 0], radius = 0.04 }}\nat = [{x}, {y}]\n")
            .unwrap();
        steps += "[[step]]\npick = \"pen\"\n";
    }
    let (corners, post) = corners(dice);
    world += &post;
    write!(steps, "[[step]]\nfollow = {{ points = [{corners}], tolerance = 1e-3 }}\n").unwrap();
    if carries {
        let [x, y] = place(dice);
        write!(steps, "[[step]]\nplace = {{ at = [{x}, {y}] }}\n").unwrap();
    }
    Case { urdf: PLANAR.into(), world: world + &steps, start, goal: None, has_steps: true, has_tool: false, line: None }
}

/// Draws a line for `cplan follow`.
pub fn line(dice: &mut Dice) -> Case {
    let count = dice.below(4_usize);
    let (corners, post) = corners(dice);
    let world = obstacles(dice, count, 1.7, None) + &post;
    let line = Some(format!("points = [{corners}]\ntolerance = 1e-3\n"));
    Case { urdf: PLANAR.into(), world, start: [0.0; 2], goal: None, has_steps: false, has_tool: false, line }
}
