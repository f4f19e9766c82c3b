//! Cells of two arms, as files for `cplan cell`: random ones, and a fixed set of a hundred.

use crate::dice::Dice;
use std::f64::consts::{FRAC_PI_2, PI};

/// A cell of the set.
#[derive(Debug, Clone)]
pub struct CellCase {
    /// Number and kind, such as `007_crossing`.
    pub name: String,
    /// The kind of cell.
    pub kind: &'static str,
    /// The cell file.
    pub text: String,
}

/// A generator of random cells, which returns `None` for draws without a cell. The text is the folder of the robots.
type Generator = fn(&mut Dice, &str) -> Option<String>;

/// The kinds of cells in the set, each with its number of cells.
const KINDS: [(&str, usize, Generator); 7] = [
    ("crossing", 30, crossing),
    ("swap", 18, swap),
    ("column", 15, column),
    ("loader", 15, loader),
    ("same_goal", 8, same_goal),
    ("no_room", 8, no_room),
    ("walled", 6, walled),
];

/// Robots of the set: files in the folder `robots` of the repository.
pub const ROBOTS: [&str; 4] = ["scara.urdf", "planar_2r.urdf", "dual_scara.urdf", "gantry.urdf"];

/// Seed of the set.
const SEED: u64 = 2024;

/// Lengths of the links of `scara.urdf`, metres, and the limits of its joints, radians.
const LENGTHS: [f64; 2] = [0.3, 0.25];
const LIMITS: [f64; 2] = [2.44, 2.61];

/// The table `robot` of a SCARA whose quill is lowered.
const SCARA: &str = "{ joints = [\"axis_1\", \"axis_2\"], tip = \"flange\", fixed = { axis_3 = -0.15 } }";

/// Returns the set of cells, the same in every run. `robots` is the folder of the robots, relative to the cell files.
pub fn cell_set(robots: &str) -> Vec<CellCase> {
    let mut cells = Vec::new();
    for (stream, (kind, count, generator)) in KINDS.into_iter().enumerate() {
        let mut random = Dice::new(SEED + stream as u64);
        for _ in 0..count {
            let text = std::iter::repeat_with(|| generator(&mut random, robots)).flatten().next();
            let name = format!("{:03}_{kind}", cells.len() + 1);
            let text = format!("name = \"{name}\"\n{}", text.unwrap_or_default());
            cells.push(CellCase { name, kind, text });
        }
    }
    cells
}

/// An arm of a cell file.
struct Arm<'a> {
    name: &'a str,
    /// The robot's file.
    urdf: String,
    base: [f64; 2],
    angle: f64,
    /// The table `robot`, or nothing.
    robot: &'a str,
    start: [f64; 2],
    /// The table `goal`.
    goal: String,
}

impl Arm<'_> {
    fn text(&self) -> String {
        let Self { name, urdf, base, angle, robot, start, goal } = self;
        let robot = if robot.is_empty() { String::new() } else { format!("robot = {robot}\n") };
        format!(
            "\n[[arm]]\nname = \"{name}\"\nurdf = \"{urdf}\"\nbase = {{ at = {base:?}, angle = {angle:?} }}\n{robot}start = {{ \
             joints = {start:?} }}\ngoal = {goal}\n"
        )
    }
}

/// Returns two SCARAs that face each other, each from the start to the goal of the tip, or `None` if a place is out of reach.
fn two_scaras(
    robots: &str,
    apart: f64,
    starts: [[f64; 2]; 2],
    goals: [[f64; 2]; 2],
    sides: [f64; 2],
) -> Option<String> {
    let mut text = String::new();
    for (k, name) in ["left", "right"].into_iter().enumerate() {
        let (base, angle) = if k == 0 { ([0.0, 0.0], 0.0) } else { ([apart, 0.0], PI) };
        let start = joints_at(base, angle, starts[k], sides[k])?;
        joints_at(base, angle, goals[k], 1.0).or(joints_at(base, angle, goals[k], -1.0))?;
        let (urdf, goal) = (format!("{robots}/scara.urdf"), format!("{{ tip = {:?} }}", goals[k]));
        text += &Arm { name, urdf, base, angle, robot: SCARA, start, goal }.text();
    }
    Some(text)
}

/// Returns joint values within the limits that put the tip of a SCARA at a place, with the elbow on one side.
fn joints_at(base: [f64; 2], angle: f64, tip: [f64; 2], side: f64) -> Option<[f64; 2]> {
    let (sin, cos) = angle.sin_cos();
    let [x, y] = [tip[0] - base[0], tip[1] - base[1]];
    let [x, y] = [cos * x + sin * y, cos * y - sin * x];
    let [a, b] = LENGTHS;
    let bend = (x * x + y * y - a * a - b * b) / (2.0 * a * b);
    let elbow = side * (bend.abs() < 1.0).then(|| bend.acos())?;
    let shoulder = y.atan2(x) - (b * elbow.sin()).atan2(a + b * elbow.cos());
    let joints = [(shoulder + PI).rem_euclid(2.0 * PI) - PI, elbow];
    (joints[0].abs() < LIMITS[0] && joints[1].abs() < LIMITS[1]).then_some(joints)
}

fn side(random: &mut Dice) -> f64 {
    if random.chance(0.5) { 1.0 } else { -1.0 }
}

/// Returns two SCARAs that cross the middle of a table in opposite directions.
pub fn crossing(random: &mut Dice, robots: &str) -> Option<String> {
    let apart = random.within(0.6, 0.95);
    let mut tip = |side: f64| [apart / 2.0 + random.within(-0.12, 0.12), side * random.within(0.08, 0.3)];
    let (starts, goals) = ([tip(-1.0), tip(1.0)], [tip(1.0), tip(-1.0)]);
    let sides = [0, 1].map(|_| side(random));
    two_scaras(robots, apart, starts, goals, sides)
}

/// Returns two long arms that share a slot: each starts where the other has to go. On the shortest paths they block each
/// other, but one can make room.
fn swap(random: &mut Dice, robots: &str) -> Option<String> {
    let apart = random.within(1.25, 1.34);
    let arm = |random: &mut Dice, name: &str, side: f64| {
        let bend = random.within(0.95, 1.15);
        let goal = [side * random.within(0.1, 0.16), -side * random.within(0.8, 0.92)];
        let (urdf, goal) = (format!("{robots}/planar_2r.urdf"), format!("{{ tip = {goal:?} }}"));
        let (base, angle) = ([-side * apart, 0.0], if side > 0.0 { 0.0 } else { PI });
        Arm { name, urdf, base, angle, robot: "", start: [bend, -bend], goal }.text()
    };
    Some(arm(random, "left", 1.0) + &arm(random, "right", -1.0))
}

/// Returns two arms on one column.
fn column(random: &mut Dice, robots: &str) -> Option<String> {
    let mut arm = |name: &str, [from, to]: [[f64; 2]; 2]| {
        let mut joints = |[first, last]: [f64; 2]| [random.within(first, last), random.within(-0.6, 0.6)];
        let (start, goal) = (joints(from), format!("{{ joints = {:?} }}", joints(to)));
        let robot = format!("{{ joints = [\"{name}_1\", \"{name}_2\"], tip = \"{name}_tool\" }}");
        let urdf = format!("{robots}/dual_scara.urdf");
        Arm { name, urdf, base: [0.0, 0.0], angle: 0.0, robot: &robot, start, goal }.text()
    };
    Some(arm("lower", [[0.8, 1.8], [-0.4, 0.3]]) + &arm("upper", [[-0.6, 0.1], [-2.4, -1.2]]))
}

/// Returns a gantry that has put a part down and leaves, and a SCARA that comes to the part.
fn loader(random: &mut Dice, robots: &str) -> Option<String> {
    let (reach, angle) = (random.within(0.3, 0.5), random.within(0.4, 1.9));
    let part = [1.0 + reach * angle.cos(), reach * angle.sin()];
    let away = [random.within(0.1, 1.9), random.within(0.75, 1.4)];
    let (urdf, goal) = (format!("{robots}/gantry.urdf"), format!("{{ joints = {away:?} }}"));
    let gantry = Arm { name: "loader", urdf, base: [0.0, 0.0], angle: 0.0, robot: "", start: part, goal };
    let start = [-random.within(0.9, 1.5), -random.within(0.3, 1.0)];
    joints_at([1.0, 0.0], 0.0, part, 1.0)?;
    let (urdf, goal) = (format!("{robots}/scara.urdf"), format!("{{ tip = {part:?} }}"));
    let scara = Arm { name: "scara", urdf, base: [1.0, 0.0], angle: 0.0, robot: SCARA, start, goal };
    Some(gantry.text() + &scara.text())
}

/// Returns two SCARAs whose goals are one place.
fn same_goal(random: &mut Dice, robots: &str) -> Option<String> {
    let apart = random.within(0.7, 0.95);
    let goal = [apart / 2.0 + random.within(-0.03, 0.03), random.within(-0.2, 0.2)];
    let mut tip = |side: f64| [apart / 2.0 + side * random.within(0.15, 0.25), side * random.within(0.2, 0.3)];
    let starts = [tip(-1.0), tip(1.0)];
    two_scaras(robots, apart, starts, [goal; 2], [1.0, 1.0])
}

/// Returns two long arms that cannot pass, because their elbows hardly turn.
fn no_room(random: &mut Dice, robots: &str) -> Option<String> {
    let apart = random.within(1.17, 1.21);
    let turn = random.within(25.5, 27.0).to_radians();
    let robot = "{ limits = { shoulder = [\"-30deg\", \"30deg\"], elbow = [\"-8deg\", \"8deg\"] } }";
    let arm = |name: &str, at: f64, angle: f64| {
        let (urdf, goal) = (format!("{robots}/planar_2r.urdf"), format!("{{ joints = [{turn:?}, 0.0] }}"));
        Arm { name, urdf, base: [at, 0.0], angle, robot, start: [-turn, 0.0], goal }.text()
    };
    Some(arm("left", -apart, 0.0) + &arm("right", apart, PI))
}

/// Returns two SCARAs. A closed wall surrounds the goal of the left one.
fn walled(random: &mut Dice, robots: &str) -> Option<String> {
    let apart = random.within(0.8, 0.95);
    let goal = [random.within(0.25, 0.35), random.within(0.2, 0.35)];
    let starts = [[0.35, -0.25], [apart - 0.35, -0.25 + random.within(-0.05, 0.0)]];
    let goals = [goal, [apart - 0.3, 0.3 + random.within(0.0, 0.1)]];
    let corner = |k: u32| {
        let (sin, cos) = (f64::from(k) * FRAC_PI_2 + 0.3).sin_cos();
        [goal[0] + 0.06 * cos, goal[1] + 0.06 * sin]
    };
    let wall: Vec<[f64; 2]> = (0..5).map(|k| corner(k % 4)).collect();
    let arms = two_scaras(robots, apart, starts, goals, [1.0, 1.0])?;
    Some(format!("{arms}\n[[obstacle]]\nname = \"box\"\npolyline = {wall:?}\nheight = [0.0, 0.15]\n"))
}
