//! Input with a hundred or a thousand times as many corners, links or pixels as anybody draws. A small machine's memory
//! suffices to answer it. Results are those for the same shapes stated by a few numbers.

use super::*;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::process::Command;

/// Memory that a run may use, in KiB, including memory that is reserved but not used.
const MEMORY: u32 = 1 << 20;

fn toml_list(points: impl IntoIterator<Item = [f64; 2]>) -> String {
    points.into_iter().fold(String::new(), |mut list, [x, y]| {
        let _ = write!(list, "[{x:?}, {y:?}], ");
        list
    })
}

fn ring(count: usize, center: [f64; 2], radius: impl Fn(usize) -> f64) -> Vec<[f64; 2]> {
    let corner = |k: usize| {
        let angle = k as f64 / count as f64 * TAU;
        [center[0] + radius(k) * angle.cos(), center[1] + radius(k) * angle.sin()]
    };
    (0..count).map(corner).collect()
}

fn polygon(corners: Vec<[f64; 2]>) -> String {
    format!("[[obstacle]]\npolygon = [{}]\n", toml_list(corners))
}

fn polyline(points: Vec<[f64; 2]>) -> String {
    format!("[[obstacle]]\npolyline = [{}]\n", toml_list(points))
}

/// Returns the program's result for an arm among obstacles. The program may use at most [`MEMORY`].
fn plan_among(urdf: &str, obstacles: &str, options: &str) -> Value {
    let place = Place::new().with("world.toml", format!("{FREE}{obstacles}"));
    let output = Command::new("sh")
        .args(["-c", &format!("ulimit -v {MEMORY} && exec \"$0\" \"$@\""), env!("CARGO_BIN_EXE_cplan"), urdf])
        .arg(place.path("world.toml"))
        .args(["--json", "--quiet"])
        .args(options.split_whitespace())
        .output()
        .unwrap();
    assert!(
        output.status.code().is_some_and(|code| code == 0 || code == 3),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).unwrap()
}

fn arm() -> String {
    shipped("robots/planar_2r.urdf")
}

fn number(answer: &Value, key: &str) -> f64 {
    answer[key].as_f64().unwrap_or_else(|| panic!("{key}: {}", answer[key]))
}

/// Checks that a found path is certified, and that its length lies between its proven lower bound and `most`.
fn is_found_within(answer: &Value, most: f64) {
    assert_eq!((&answer["status"], &answer["certified"]), (&"found".into(), &true.into()));
    let (length, least) = (number(answer, "length"), number(&answer["optimum"], "lower_bound"));
    assert!(least <= length && length <= most, "{least} {length} {most}");
}

#[test]
fn a_star_of_20_000_corners_out_of_reach_is_no_obstacle() {
    let star = polygon(ring(20_000, [50.0, 50.0], |k| if k % 2 == 0 { 2.0 } else { 1.0 }));
    let (answer, empty) = (plan_among(&arm(), &star, ""), plan_among(&arm(), "", ""));
    assert_eq!(answer["path"], empty["path"]);
}

#[test]
fn a_polygon_of_5000_corners_around_a_circle_is_passed_like_the_circle() {
    let (center, radius) = ([1.2, 0.3], 0.15);
    let disc = plan_among(&arm(), "[[obstacle]]\ncircle = { center = [1.2, 0.3], radius = 0.15 }\n", "");
    let answer = plan_among(&arm(), &polygon(ring(5000, center, |_| radius)), "");
    is_found_within(&answer, number(&disc, "length") * 1.01);
    // The circle contains the polygon, so no path around it is shorter than the polygon's lower bound.
    assert!(number(&answer["optimum"], "lower_bound") <= number(&disc, "length"));
    assert!(number(&disc["optimum"], "lower_bound") <= number(&answer, "length") * (1.0 + 1e-4));
    let other = plan_among(&arm(), &polygon(ring(5000, center, |_| radius)), "--planner subdivision");
    assert!(number(&answer["optimum"], "lower_bound") <= number(&other, "length"));
}

#[test]
fn a_polyline_of_10_000_points_is_passed_like_one_of_100() {
    let wave = |count: usize| {
        let point = |k: usize| {
            let t = k as f64 / (count - 1) as f64;
            [1.0 + 0.3 * t, 0.2 + 0.1 * (9.0 * t).sin()]
        };
        polyline((0..count).map(point).collect())
    };
    let (rough, fine) = (plan_among(&arm(), &wave(100), ""), plan_among(&arm(), &wave(10_000), ""));
    is_found_within(&fine, number(&rough, "length") * 1.01);
    assert!(number(&rough["optimum"], "lower_bound") <= number(&fine, "length") * 1.001);
}

/// Returns numbers that look random, in `[-1, 1)`.
fn noise(k: usize) -> f64 {
    (k as f64 * 0.618_033_988_749 + (k as f64 * 0.013).sin() * 17.0).rem_euclid(1.0) * 2.0 - 1.0
}

/// Checks a star, a polygon like the outline of a scanned object, in which each corner deviates at random, and a wall
/// that crosses itself thousands of times. The exact C-obstacles of its pieces cross each other millions of times.
#[test]
fn thousands_of_corners_are_passed_like_the_circle_or_the_band_around_them() {
    let circle = "[[obstacle]]\ncircle = { center = [1.2, 0.3], radius = 0.2 }\n";
    let star = polygon(ring(4000, [1.2, 0.3], |k| if k % 2 == 0 { 0.2 } else { 0.1 }));
    let scan = polygon(ring(6000, [1.2, 0.3], |k| 0.19 + 0.01 * noise(k)));
    let point = |k: usize| [1.0 + 0.3 * k as f64 / 5000.0, 0.25 + 0.05 * (k % 2) as f64 + 0.02 * noise(k)];
    let zigzag = polyline((0..5000).map(point).collect());
    let band = polygon(vec![[1.0, 0.23], [1.3, 0.23], [1.3, 0.32], [1.0, 0.32]]);
    for (obstacle, around, ratio) in [(star, circle, 1.01), (scan, circle, 1.06), (zigzag, &band, 1.06)] {
        let around = plan_among(&arm(), around, "");
        is_found_within(&plan_among(&arm(), &obstacle, ""), number(&around, "length") * ratio);
    }
}

/// Returns the arm with a mesh as its forearm. The mesh is a prism over a polygon with `corners` corners that surrounds
/// the forearm of the file.
fn with_mesh(place: &Place, corners: usize) -> String {
    let mut stl = vec![0; 80];
    let rim = ring(corners, [0.0, 0.0], |_| 1.0);
    let at = |k: usize, z: f32| {
        let [x, y] = rim[k % corners];
        [0.4 * x as f32, 0.05 * y as f32, z]
    };
    let triangles: Vec<[[f32; 3]; 3]> = (0..corners)
        .flat_map(|k| [[at(k, 0.0), at(k + 1, 0.0), at(k, 0.05)], [at(k, 0.05), at(k + 1, 0.0), at(k + 1, 0.05)]])
        .collect();
    stl.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        stl.extend([0; 12]);
        stl.extend(triangle.iter().flatten().flat_map(|c| c.to_le_bytes()));
        stl.extend([0; 2]);
    }
    place.write("fore.stl", stl);
    let mesh = ("<box size=\"0.8 0.1 0.1\"/>", "<mesh filename=\"fore.stl\"/>");
    place.write("mesh.urdf", planar_2r(&[mesh]));
    place.path("mesh.urdf").display().to_string()
}

#[test]
fn a_mesh_with_an_outline_of_720_corners_is_a_link_like_others() {
    let place = Place::new();
    let post = "[[obstacle]]\ncircle = { center = [1.2, 0.3], radius = 0.15 }\n";
    let rough = plan_among(&with_mesh(&place, 60), post, "");
    let fine = plan_among(&with_mesh(&place, 720), post, "");
    is_found_within(&fine, number(&rough, "length") * 1.02);
    assert!(number(&rough["optimum"], "lower_bound") <= number(&fine, "length") * 1.001);
}

/// Returns a robot whose arm carries a chain of further links.
fn long_chain(links: usize) -> String {
    let mut urdf = r#"<robot name="chain"><link name="base"/><link name="l0"/><link name="l1"><collision><geometry>
<box size="0.1 0.1 0.1"/></geometry></collision></link>
<joint name="shoulder" type="continuous"><parent link="base"/><child link="l0"/><axis xyz="0 0 1"/><limit velocity="2" effort="1"/></joint>
<joint name="elbow" type="continuous"><parent link="l0"/><child link="l1"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/><limit velocity="2" effort="1"/></joint>
"#
    .to_owned();
    for k in 2..links {
        let above = k - 1;
        let _ = writeln!(
            urdf,
            "<link name=\"l{k}\"/><joint name=\"j{k}\" type=\"fixed\"><parent link=\"l{above}\"/><child link=\"l{k}\"/></joint>"
        );
    }
    urdf + "</robot>"
}

#[test]
fn a_robot_of_20_000_links_in_a_row_is_read() {
    let place = Place::new().with("chain.urdf", long_chain(20_000));
    let answer = plan_among(&place.path("chain.urdf").display().to_string(), "", "");
    assert_eq!(answer["status"], "found");
}

#[test]
fn a_robot_with_20_000_broken_joints_is_refused_with_the_first_of_them() {
    let done = Place::new()
        .with("chain.urdf", long_chain(20_000).replace("parent link=\"l", "parent link=\"no_l"))
        .with("world.toml", FREE)
        .run(&["chain.urdf", "world.toml"], "");
    done.refused(1, &["no_l2", "more"]);
    assert!(done.stderr.len() < 40_000, "{} bytes", done.stderr.len());
}

/// Checks ten thousand obstacles out of reach. The optimum is within the same gap as without them. Proofs refer to
/// obstacles by their numbers among all obstacles.
#[test]
fn shapes_out_of_reach_change_nothing() {
    let place = Place::new();
    let far: String = (0..10_100)
        .map(|k| {
            let [x, y] = [2.0 + 0.01 * f64::from(k % 100), 2.0 + 0.01 * f64::from(k / 100)];
            let [right, top] = [x + 0.009, y + 0.009];
            format!("[[obstacle]]\npolygon = [[{x}, {y}], [{right}, {y}], [{x}, {top}]]\n")
        })
        .collect();
    for (robot, world, code) in [("planar_2r", "shelf", 0), ("planar_2r_continuous", "no_path", 3)] {
        let robot = shipped(&format!("robots/{robot}.urdf"));
        let own = read(shipped(&format!("workspaces/{world}.toml")));
        let (before, after) = own.split_at(own.find("[[obstacle]]").unwrap());
        let plan = |name: &str, text: String| {
            place.write(name, text);
            place.certified(&robot, name, "--quiet --json", code).0.json()
        };
        let [alone, among] = [plan("own.toml", own.clone()), plan("all.toml", format!("{before}{far}{after}"))];
        assert_eq!(alone["length"], among["length"], "{world}");
        assert_eq!(alone["optimum"]["lower_bound"], among["optimum"]["lower_bound"], "{world}");
    }
}
