//! Robots in space, compared with separate floating-point kinematics: planes along any directions, frames turned by
//! angles and quaternions, held joints, and joints that mimic these.

use crate::common::verdict::found;
use cplan_cases as random;
use cplan_cases::dice::Dice;
use cplan_check_files::{CheckError, check};

type V = [f64; 3];
type Turn = [V; 3];

fn dot(a: V, b: V) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

fn plus(a: V, b: V, by: f64) -> V {
    [0, 1, 2].map(|k| a[k] + by * b[k])
}

fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(v: V) -> V {
    v.map(|c| c / dot(v, v).sqrt())
}

fn turned(turn: &Turn, v: V) -> V {
    [0, 1, 2].map(|k| dot(turn[k], v))
}

fn turned_back(turn: &Turn, v: V) -> V {
    [0, 1, 2].map(|k| (0..3).map(|i| turn[i][k] * v[i]).sum())
}

fn compose(a: &Turn, b: &Turn) -> Turn {
    let columns = [0, 1, 2].map(|k| turned(a, [0, 1, 2].map(|i| b[i][k])));
    [0, 1, 2].map(|i| columns.map(|column| column[i]))
}

fn vector(dice: &mut Dice, size: f64) -> V {
    [0; 3].map(|_| dice.within(-size, size))
}

/// Returns a random rotation, and the attribute of an origin that states it. The angles are at most `most`.
fn turn(dice: &mut Dice, most: f64) -> (Turn, String) {
    if most > 1.0 && dice.chance(0.5) {
        let q = [0; 4].map(|_| dice.within(-2.0, 2.0));
        let size = q.iter().map(|c| c * c).sum::<f64>().sqrt();
        let [x, y, z, w] = q.map(|c| c / size);
        let spun = |v: V| plus(plus(v, cross([x, y, z], v), 2.0 * w), cross([x, y, z], cross([x, y, z], v)), 2.0);
        let columns = [spun([1.0, 0.0, 0.0]), spun([0.0, 1.0, 0.0]), spun([0.0, 0.0, 1.0])];
        let [a, b, c, d] = q;
        return ([0, 1, 2].map(|i| columns.map(|column| column[i])), format!("quat_xyzw=\"{a} {b} {c} {d}\""));
    }
    let [r, p, y] = vector(dice, most);
    let about = |axis: usize, angle: f64| -> Turn {
        let (s, c) = angle.sin_cos();
        let [i, j] = [(axis + 1) % 3, (axis + 2) % 3];
        let mut rows = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        (rows[i][i], rows[i][j], rows[j][i], rows[j][j]) = (c, -s, s, c);
        rows
    };
    (compose(&compose(&about(2, y), &about(1, p)), &about(0, r)), format!("rpy=\"{r} {p} {y}\""))
}
/// A random arm, with its URDF and its world.
struct Drawn {
    urdf: String,
    world: String,
    /// Origins of the joints, and the tip, with both joints at 0.
    at: [[f64; 2]; 3],
    /// For each joint: the direction of its slide in the plane, or the sign of its rotation.
    joints: [Result<[f64; 2], f64>; 2],
}

impl Drawn {
    fn new(dice: &mut Dice, kind: u64) -> Self {
        let slides = [kind / 2 == 1, kind % 2 == 1];
        // A mounting on a wall, or one that is level up to tolerances.
        let most = if dice.chance(0.3) { 3e-4 } else { 3.0 };
        let (mounting, mounted) = turn(dice, most);
        let base = vector(dice, 0.5);
        // Axes in the frame of the mounting: along its z, or perpendicular to it.
        let axis_of = |dice: &mut Dice, slides: bool| {
            let angle = dice.within(-3.0, 3.0);
            let way = if dice.chance(0.7) { 1.0 } else { -1.0 };
            if slides { [angle.cos(), angle.sin(), 0.0] } else { [0.0, 0.0, way] }
        };
        let axes = [axis_of(dice, slides[0]), axis_of(dice, slides[1])];
        let (elbow_turn, elbow_turned) = turn(dice, 3.0);
        let [elbow, tip, hold, follow] = [vector(dice, 1.0), vector(dice, 0.8), vector(dice, 1.0), vector(dice, 1.0)];
        let [held, by, more] = [dice.within(-0.5, 0.5), dice.within(-2.0, 2.0), dice.within(-0.2, 0.2)];
        let own = turned_back(&elbow_turn, axes[1]);
        let text = |v: V| format!("{} {} {}", v[0], v[1], v[2]);
        let kind = |k: usize| if slides[k] { "prismatic" } else { "continuous" };
        let range = |k: usize| if slides[k] { r#"<limit lower="-3" upper="3" velocity="1" effort="1"/>"# } else { "" };
        let urdf = format!(
            r#"<robot name="r" version="1.1"> <link name="world"/>
            <joint name="a" type="{}"> <parent link="world"/> <child link="l1"/> <origin xyz="{}" {mounted}/> <axis xyz="{}"/> {} </joint>
            <link name="l1"/>
            <joint name="held" type="prismatic"> <parent link="l1"/> <child link="l1b"/> <axis xyz="{}"/>
              <limit lower="-1" upper="1" velocity="1" effort="1"/> </joint> <link name="l1b"/>
            <joint name="follows" type="prismatic"> <parent link="l1b"/> <child link="l1c"/> <axis xyz="{}"/>
              <limit lower="-9" upper="9" velocity="1" effort="1"/> <mimic joint="held" multiplier="{by}" offset="{more}"/> </joint>
            <link name="l1c"/>
            <joint name="b" type="{}"> <parent link="l1c"/> <child link="l2"/> <origin xyz="{}" {elbow_turned}/> <axis xyz="{}"/> {} </joint>
            <link name="l2"> <collision> <origin xyz="{}"/> <geometry> <sphere radius="0.1"/> </geometry> </collision> </link>
            <joint name="t" type="fixed"> <parent link="l2"/> <child link="tip"/> <origin xyz="{}"/> </joint> <link name="tip"/> </robot>"#,
            kind(0),
            text(base),
            text(axes[0]),
            range(0),
            text(hold),
            text(follow),
            kind(1),
            text(elbow),
            text(own),
            range(1),
            text(tip),
            text(tip),
        );
        let world = format!("[robot]\njoints = [\"a\", \"b\"]\nfixed = {{ held = {held} }}\n");
        // Everything in the root frame.
        let axes = axes.map(|axis| turned(&mounting, axis));
        let shifts = plus(plus([0.0; 3], unit(hold), held), unit(follow), by * held + more);
        let second = plus(base, turned(&mounting, plus(elbow, shifts, 1.0)), 1.0);
        let tip = plus(second, turned(&mounting, turned(&elbow_turn, tip)), 1.0);
        let [u, v] = coordinates(axes, slides);
        let flat = |p: V| [dot(p, u), dot(p, v)];
        let joint = |k: usize| match slides[k] {
            true => {
                let [x, y] = flat(axes[k]);
                Ok([x, y].map(|c| c / x.hypot(y)))
            }
            false => Err(dot(axes[k], cross(u, v)).signum()),
        };
        Self { urdf, world, at: [base, second, tip].map(flat), joints: [joint(0), joint(1)] }
    }

    fn tip(&self, q: [f64; 2]) -> [f64; 2] {
        let [base, elbow, tip] = self.at;
        let mut p = tip;
        for k in [1, 0] {
            let about = [base, elbow][k];
            p = match self.joints[k] {
                Ok([x, y]) => [p[0] + q[k] * x, p[1] + q[k] * y],
                Err(sign) => {
                    let (s, c) = (sign * q[k]).sin_cos();
                    let [x, y] = [p[0] - about[0], p[1] - about[1]];
                    [about[0] + c * x - s * y, about[1] + s * x + c * y]
                }
            };
        }
        p
    }
}

/// Returns the directions of the plane's coordinates in the root frame.
fn coordinates(axes: [V; 2], slides: [bool; 2]) -> [V; 2] {
    let normal = match slides {
        [false, _] => axes[0],
        [true, false] => axes[1],
        [true, true] => unit(cross(axes[0], axes[1])),
    };
    let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for (axis, coordinates) in [(z, [x, y]), (y, [x, z]), (x, [y, z])] {
        if dot(normal, axis).abs() > 1.0 - 5e-7 {
            return coordinates;
        }
    }
    let along = if normal[0].abs() < 0.9 { x } else { y };
    let first = unit(plus(along, normal, -dot(normal, along)));
    [first, cross(normal, first)]
}

#[test]
fn robots_are_where_their_kinematics_have_them() {
    let (mut free, mut hit) = (0, 0);
    for seed in random::seeds(200) {
        let mut dice = Dice::new(seed);
        let drawn = Drawn::new(&mut dice, seed % 4);
        let q = [dice.within(-2.9, 2.9), dice.within(-2.9, 2.9)];
        let [x, y] = drawn.tip(q);
        let (angle, radius) = (dice.within(-3.0, 3.0), dice.within(0.01, 0.3));
        // Slightly nearer or farther than the sum of the radii.
        let apart = 10_f64.powf(dice.within(-9.0, -1.0)) * if dice.chance(0.5) { 1.0 } else { -1.0 };
        let far = 0.1 + radius + apart;
        let [a, b] = [x + far * angle.cos(), y + far * angle.sin()];
        let (first, second) = (q[0], q[1]);
        let report = |tip: [f64; 2], circle: &str| {
            let world = format!("start.joints = [{first}, {second}]\ngoal.tip = [{}, {}]\n{circle}", tip[0], tip[1]);
            let certificate = found("", r#""linear""#, &format!("[0, {first}, {second}]"));
            check(&drawn.urdf, &format!("{world}\n{}", drawn.world), &certificate)
        };
        let circle = format!("obstacle = [{{ circle = {{ center = [{a}, {b}], radius = {radius} }} }}]");
        match report([x, y], &circle) {
            Ok(words) => assert!(apart > 0.0 && words.contains("within 1e-"), "seed {seed}: {apart}: {words}"),
            Err(CheckError::Fails(why)) => {
                assert!(apart < 0.0 && why.contains("obstacle"), "seed {seed}: {apart}: {why}")
            }
            Err(why) => panic!("seed {seed}: {why}\n{}", drawn.urdf),
        }
        *if apart > 0.0 { &mut free } else { &mut hit } += 1;
        let missed = report([x + 2e-5, y], "");
        assert!(matches!(missed, Err(CheckError::Fails(_))), "seed {seed}: {missed:?}");
    }
    assert!(free > 0 && hit > 0, "{free} {hit}");
}

/// Tests that axes that differ by more than the tolerance of equal directions form no plane.
#[test]
fn joints_without_a_common_plane_are_refused() {
    let arm = |second: &str, kind: &str| {
        let urdf = format!(
            r#"<robot name="r"> <link name="l0"/>
            <joint name="a" type="continuous"> <parent link="l0"/> <child link="l1"/> <axis xyz="0 0 1"/> </joint> <link name="l1"/>
            <joint name="b" type="{kind}"> <parent link="l1"/> <child link="l2"/> <axis xyz="{second}"/> <limit lower="-1" upper="1"/> </joint>
            <link name="l2"> <collision> <geometry> <sphere radius="0.1"/> </geometry> </collision> </link> </robot>"#
        );
        let certificate = found("", r#""linear""#, "[0, 0, 0]");
        check(&urdf, "start.joints = [0, 0]\ngoal.joints = [0, 0]", &certificate)
    };
    for (second, kind, is_one) in [
        ("0 0.00099 1", "revolute", true),
        ("0 0.00101 1", "revolute", false),
        ("1 0 0.00099", "prismatic", true),
        ("1 0 0.00101", "prismatic", false),
        ("0 0 1", "prismatic", false),
    ] {
        match arm(second, kind) {
            Ok(report) => {
                assert!(is_one && report.contains("up to 1e-3 rad off the assumed common plane"), "{second}: {report}")
            }
            Err(why) => assert!(!is_one && why.to_string().contains("common plane"), "{second}: {why}"),
        }
    }
}
