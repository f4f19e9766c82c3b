//! The world as text.

use super::args::ImportArgs;
use super::obstacles::{ImportedObstacle, rounded};
use crate::text::plain_line;
use cplan_drawing::Geometry;
use std::fmt::Write;

/// Number of points per line of the file.
const POINTS_PER_LINE: usize = 6;

/// Returns the text of the world file: head, start and goal, obstacles.
pub(super) fn text(args: &ImportArgs, taken: &[ImportedObstacle], notes: &[String]) -> String {
    let file = args.drawing.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let mut text = format!("# {}, by `cplan import`. Lengths in metres, angles in radians.\n", plain_line(&file));
    // Writing to a string cannot fail.
    let _ = writeln!(text, "# Curves are replaced by chords, at most {} m away from them.", args.tolerance);
    for note in notes {
        let _ = writeln!(text, "# Note: {}", plain_line(note));
    }
    let _ = writeln!(text, "name = {}", quoted(&args.title()));
    let query = &args.query;
    if let Some(clearance) = query.clearance {
        let _ = writeln!(text, "clearance = {clearance:?}");
    }
    match &query.start {
        Some(start) => {
            let _ = writeln!(text, "\n[start]\njoints = {}", start.in_toml());
        }
        None => text += "\n# The arm's initial joint values:\n#[start]\n#joints = [0.0, 0.0]\n",
    }
    match (&query.goal, &query.goal_tip) {
        (Some(goal), _) => {
            let _ = writeln!(text, "\n[goal]\njoints = {}", goal.in_toml());
        }
        (None, Some(tip)) => {
            let _ = writeln!(text, "\n[goal]\ntip = {:?}", [tip.0.x, tip.0.y]);
            if let Some(elbow) = query.elbow {
                let _ = writeln!(text, "elbow = \"{}\"", elbow.name());
            }
        }
        (None, None) => text += "\n# The goal; or joints = [q1, q2]:\n#[goal]\n#tip = [0.3, 0.2]\n",
    }
    taken.iter().for_each(|taken| text += &obstacle(taken));
    text
}

fn obstacle(ImportedObstacle { name, shape }: &ImportedObstacle) -> String {
    let mut text = format!("\n# {}", plain_line(&shape.kind));
    if let Some(line) = shape.line {
        let _ = write!(text, ", line {line}");
    }
    if let Some(layer) = &shape.layer {
        let _ = write!(text, ", layer \"{}\"", plain_line(layer));
    }
    let _ = writeln!(text, "\n[[obstacle]]\nname = {}", quoted(name));
    match &shape.geometry {
        Geometry::Polygon { outer, holes } => {
            let _ = writeln!(text, "polygon = {}", points(outer));
            if !holes.is_empty() {
                let holes: Vec<String> = holes.iter().map(|hole| points(hole)).collect();
                let _ = writeln!(text, "holes = [{}]", holes.join(", "));
            }
        }
        Geometry::Polyline(wall) => {
            let _ = writeln!(text, "polyline = {}", points(wall));
        }
        Geometry::Circle { center, radius } => {
            let _ = writeln!(text, "circle = {{ center = {center:?}, radius = {radius:?} }}");
        }
    }
    if let Some(frame) = shape.frame {
        let _ = writeln!(text, "at = {:?}", frame.at);
        if frame.angle != 0.0 {
            let _ = writeln!(text, "angle = {:?}", frame.angle);
        }
    }
    if let Some(height) = shape.height {
        let _ = writeln!(text, "height = {:?}", height.map(rounded));
    }
    text
}

/// Returns points in lines of moderate length.
fn points(points: &[[f64; 2]]) -> String {
    let lines: Vec<String> = points
        .chunks(POINTS_PER_LINE)
        .map(|line| line.iter().map(|point| format!("{point:?}")).collect::<Vec<_>>().join(", "))
        .collect();
    match &lines[..] {
        [line] => format!("[{line}]"),
        _ => format!("[\n  {},\n]", lines.join(",\n  ")),
    }
}

/// Returns a name as a TOML string, in quotes.
fn quoted(name: &str) -> String {
    toml::Value::from(name).to_string()
}
