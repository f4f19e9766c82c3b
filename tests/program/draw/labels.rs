//! Names in the pictures of all shipped worlds: none lies on an arm, on a marker or on another name, and each name of an
//! obstacle lies within its shape, touches it, or has a line that ends on it.

use cplan::PlanOutput as _;
use cplan::engine::Method;
use cplan::geometry::{Convex, separation};
use cplan::view::svg;
use cplan::{Options, Point, Problem, plan};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Left, top, right and lower side of a box, in pixels.
type Sides = [f64; 4];

/// Items of a picture.
#[derive(Debug, Default)]
struct Items {
    names: Vec<(String, Sides)>,
    markers: Vec<Sides>,
    /// Corners of the outlines of arms.
    arms: Vec<Vec<[f64; 2]>>,
    /// Lines from names to shapes.
    leaders: Vec<[[f64; 2]; 2]>,
    /// The first panel, which shows the workspace.
    panel: Option<Sides>,
}

const INK: &str = "#22262b";
const WHITE: &str = "#ffffff";
const PALE: &str = "#a3aab2";
const GRAY: &str = "#5c636b";
/// Colours of the outlines of arms: at the ends of a motion, and where the arm gets stuck.
const ARM_LINES: [&str; 2] = [INK, "#c22e2e"];

/// Returns the worlds of a folder, each with its robot.
fn worlds(folder: &str) -> Vec<[PathBuf; 2]> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(root.join(folder)).unwrap().map(|file| file.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "toml"));
    files.sort();
    let with_robot = |file: PathBuf| {
        let text = std::fs::read_to_string(&file).unwrap();
        let robot = text.lines().find_map(|line| line.strip_prefix("# robot:"))?.trim().to_owned();
        Some([root.join(format!("robots/{robot}.urdf")), file])
    };
    files.into_iter().filter_map(with_robot).collect()
}

fn corners(outline: &str) -> Vec<[f64; 2]> {
    let steps = outline.split_inclusive(['M', 'L', 'A', 'Z']).map(|step| step.trim_end_matches(['M', 'L', 'A', 'Z']));
    let corner = |step: &str| {
        let numbers: Vec<f64> = step.split(' ').filter_map(|number| number.parse().ok()).collect();
        numbers.last_chunk().copied()
    };
    steps.filter_map(corner).collect()
}

fn sides(corners: &[[f64; 2]]) -> Sides {
    let ends = |k: usize| {
        let values = corners.iter().map(|corner| corner[k]);
        (values.clone().fold(f64::MAX, f64::min), values.fold(f64::MIN, f64::max))
    };
    let (x, y) = (ends(0), ends(1));
    [x.0, y.0, x.1, y.1]
}

fn items(text: &str) -> Items {
    let tree = roxmltree::Document::parse(text).unwrap();
    let mut items = Items::default();
    for node in tree.descendants() {
        let number = |name: &str| node.attribute(name).unwrap().parse::<f64>().unwrap();
        let [stroke, fill] = ["stroke", "fill"].map(|name| node.attribute(name).unwrap_or_default());
        match node.tag_name().name() {
            // Only names have a pale line around their letters.
            "text" if !stroke.is_empty() && node.has_attribute("textLength") => {
                let (x, y, half) = (number("x"), number("y"), number("textLength") / 2.0);
                items.names.push((node.text().unwrap().trim().to_owned(), [x - half, y - 9.0, x + half, y + 2.0]));
            }
            "circle" if number("r") > 3.0 && [INK, WHITE].contains(&fill) => {
                let (x, y, r) = (number("cx"), number("cy"), number("r"));
                items.markers.push([x - r, y - r, x + r, y + r]);
            }
            "rect" if items.panel.is_none() && node.parent_element().is_some_and(|of| of.has_tag_name("clipPath")) => {
                let (x, y) = (number("x"), number("y"));
                items.panel = Some([x, y, x + number("width"), y + number("height")]);
            }
            "path" if stroke == GRAY && number("stroke-width") == 1.0 && !node.has_attribute("stroke-dasharray") => {
                if let [from, to] = corners(node.attribute("d").unwrap())[..] {
                    items.leaders.push([from, to]);
                }
            }
            "path" => {
                let corners = corners(node.attribute("d").unwrap());
                let is_union = node.has_attribute("paint-order");
                if is_union && ARM_LINES.contains(&stroke) && [WHITE, PALE].contains(&fill) {
                    items.arms.push(corners);
                } else if corners.len() == 4 && [INK, WHITE].contains(&fill) && !is_union {
                    let [left, top, right, bottom] = sides(&corners);
                    if (right - left - (bottom - top)).abs() < 0.1 && right - left < 15.0 {
                        items.markers.push([left, top, right, bottom]);
                    }
                }
            }
            _ => {}
        }
    }
    items
}

fn meet(a: &Sides, b: &Sides) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

/// Returns true if a corner of the arm lies in the box, or a corner or the middle of the box in the arm.
fn covers_arm(place: &Sides, arm: &[[f64; 2]]) -> bool {
    let [left, top, right, bottom] = *place;
    let is_in_box = |[x, y]: &[f64; 2]| (left..=right).contains(x) && (top..=bottom).contains(y);
    let is_in_arm = |x: f64, y: f64| {
        let crossings = (0..arm.len()).filter(|&i| {
            let (a, b) = (arm[i], arm[(i + 1) % arm.len()]);
            (a[1] <= y) != (b[1] <= y) && x < a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1])
        });
        crossings.count() % 2 == 1
    };
    let middle = [f64::midpoint(left, right), f64::midpoint(top, bottom)];
    let spots = [[left, top], [right, top], [left, bottom], [right, bottom], middle];
    arm.iter().any(is_in_box) || spots.iter().any(|[x, y]| is_in_arm(*x, *y))
}

/// Returns the names of obstacles in the workspace that are neither at their shapes nor joined to them, and the number of
/// names that were checked. `view` is the model that pages have.
fn misplaced(view: &Value, items: &Items) -> (Vec<String>, usize) {
    /// Greatest distance in pixels. Pictures round to a hundredth of a pixel.
    const TOUCH: f64 = 5.1;
    let number = |value: &Value| value.as_f64().unwrap();
    let Some([left, top, right, bottom]) = items.panel else { return (Vec::new(), 0) };
    let ranges = [0, 1].map(|k| [0, 1].map(|end| number(&view["frame"][k][end])));
    let scale =
        (0..2).map(|k| [right - left, bottom - top][k] / (ranges[k][1] - ranges[k][0])).fold(f64::MAX, f64::min);
    let middle = [0, 1].map(|k| f64::midpoint(ranges[k][0], ranges[k][1]));
    let point = |[x, y]: [f64; 2]| {
        let from_middle = [x - f64::midpoint(left, right), f64::midpoint(top, bottom) - y];
        Point::new(middle[0] + from_middle[0] / scale, middle[1] + from_middle[1] / scale)
    };
    let shape = |piece: &Value| {
        let core: Vec<f64> = piece["core"].as_array().unwrap().iter().map(number).collect();
        Convex::trusted(core.chunks(2).map(|p| Point::new(p[0], p[1])).collect(), number(&piece["radius"]))
    };
    let obstacles = view["worlds"][0]["obstacles"].as_array().unwrap();
    let (mut wrong, mut count) = (Vec::new(), 0);
    for (name, place) in &items.names {
        if place[0] > right {
            continue;
        }
        let named = (0..obstacles.len()).filter(|&index| obstacles[index]["name"] == name[..]);
        let pieces = named.flat_map(|index| {
            let own = obstacles[index]["own"].as_u64().unwrap() as usize;
            obstacles[index]["pieces"].as_array().unwrap()[..own].iter().map(shape).collect::<Vec<_>>()
        });
        let pieces: Vec<Convex> = pieces.collect();
        if pieces.is_empty() {
            continue;
        }
        // The placer's box is wider than the letters.
        let [x0, y0, x1, y1] = [place[0] - 3.0, place[1] - 2.5, place[2] + 3.0, place[3] + 1.5];
        let own = Convex::trusted([[x0, y1], [x1, y1], [x1, y0], [x0, y0]].map(point).to_vec(), 0.0);
        let is_near =
            |of: &Convex, limit: f64| pieces.iter().any(|piece| separation(of, piece).distance * scale <= limit);
        let begins = |[from, _]: &&[[f64; 2]; 2]| {
            (x0 - 0.1..=x1 + 0.1).contains(&from[0]) && (y0 - 0.1..=y1 + 0.1).contains(&from[1])
        };
        let is_joined = items.leaders.iter().find(begins).map(|[_, to]| is_near(&Convex::point(point(*to)), 0.1));
        if !is_joined.unwrap_or_else(|| is_near(&own, TOUCH)) {
            wrong.push(name.clone());
        }
        count += 1;
    }
    (wrong, count)
}

fn check(folder: &str, least: usize, least_checked: usize) {
    let (mut count, mut checked) = (0, 0);
    for [robot, world] in worlds(folder) {
        let name = world.file_stem().unwrap().to_string_lossy().into_owned();
        let Ok(problem) = Problem::load(&robot, &world) else { continue };
        let Ok(plan) = plan(&problem, &Options::from(Method::Visibility)) else { continue };
        let view = plan.view();
        let items = items(&svg(&view));
        let (wrong, of_obstacles) = misplaced(&serde_json::to_value(&view).unwrap(), &items);
        assert!(wrong.is_empty(), "{name}: not at their shapes: {wrong:?}");
        checked += of_obstacles;
        let Items { names, markers, arms, .. } = items;
        for (i, (text, place)) in names.iter().enumerate() {
            let other = names[i + 1..].iter().find(|(_, other)| meet(place, other));
            assert!(other.is_none(), "{name}: \"{text}\" covers {other:?}");
            assert!(!markers.iter().any(|marker| meet(place, marker)), "{name}: \"{text}\" covers a marker");
            assert!(!arms.iter().any(|arm| covers_arm(place, arm)), "{name}: \"{text}\" covers the arm");
        }
        count += names.len();
    }
    assert!(count >= least, "{folder}: {count} names");
    assert!(checked >= least_checked, "{folder}: {checked} names of obstacles");
}

#[test]
fn names_in_pictures_of_motions_are_at_their_shapes() {
    check("workspaces", 100, 50);
}

#[test]
fn names_in_pictures_of_tasks_cover_nothing() {
    check("workspaces/tasks", 60, 0); // The names are those of steps.
}

#[test]
fn names_in_pictures_of_moving_obstacles_are_at_their_shapes() {
    check("workspaces/moving", 30, 4);
}
