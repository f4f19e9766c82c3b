//! The comparison of two polygons, as text.

use super::findings::{CornerFinding, Findings, PartFinding, PolygonFinding};
use crate::text::{Columns, counted, first_lines, short};

/// Largest number of corners of a polygon that the report lists.
const MAX_LISTED_CORNERS: usize = 16;

/// Returns the report.
pub fn text(findings: &Findings) -> String {
    let mut columns = Columns::default();
    columns.add("result", &verdict(findings));
    columns.add("A", &polygon("a", &findings.a));
    columns.add("B", &polygon("b", &findings.b));
    add(&mut columns, "A in B", inside("a", &findings.a_corners_in_b), "no corner of A is in B");
    add(&mut columns, "B in A", inside("b", &findings.b_corners_in_a), "no corner of B is in A");
    let [sides_of_a, sides_of_b] = [&findings.a, &findings.b].map(|polygon| polygon.corners.len());
    let crossing = findings
        .crossing_sides
        .iter()
        .map(|crossing| format!("{} crosses {}", side("a", crossing.a, sides_of_a), side("b", crossing.b, sides_of_b)));
    add(&mut columns, "crossing", crossing.collect(), "no side of A crosses a side of B");
    add(&mut columns, "B - A", findings.difference.iter().map(part).collect(), "");
    for note in &findings.notes {
        columns.add("note", note);
    }
    columns.into_text()
}

/// Returns the result in words.
pub fn verdict(findings: &Findings) -> String {
    match findings.depth {
        None => format!("A and B are {} apart; the origin is outside B - A", number(findings.distance)),
        Some(0.0) => "A and B touch; the origin is on the boundary of B - A".to_owned(),
        Some(depth) => {
            let bound = if findings.depth_is_exact { "" } else { "at least " };
            format!("A and B meet; penetration depth: {bound}{} (depth of the origin in B - A)", number(depth))
        }
    }
}

/// Adds lines with a key, or the line `none` if there are no lines.
fn add(columns: &mut Columns, key: &str, lines: Vec<String>, none: &str) {
    let lines = if lines.is_empty() { vec![none.to_owned()] } else { lines };
    for (i, line) in first_lines(lines, |more| format!("and {more} more (--json lists all)")).iter().enumerate() {
        columns.add(if i == 0 { key } else { "" }, line);
    }
}

fn polygon(name: &str, PolygonFinding { corners, convex }: &PolygonFinding) -> String {
    let shape = if *convex { "convex" } else { "not convex" };
    let corner = |(i, at): (usize, &[f64; 2])| format!("{name}{} {}", i + 1, point(at));
    match corners.len() {
        count if count > MAX_LISTED_CORNERS => format!("{}, {shape}", counted(count, "corner")),
        _ => format!("{}; {shape}", corners.iter().enumerate().map(corner).collect::<Vec<_>>().join(", ")),
    }
}

fn inside(name: &str, corners: &[CornerFinding]) -> Vec<String> {
    let line = |CornerFinding { corner, at, depth }: &CornerFinding| match depth {
        0.0 => format!("{name}{corner} {} is on the boundary", point(at)),
        depth => format!("{name}{corner} {} is {} inside", point(at), number(*depth)),
    };
    corners.iter().map(line).collect()
}

fn side(name: &str, number: usize, count: usize) -> String {
    format!("{name}{number}-{name}{}", number % count + 1)
}

fn part(PartFinding { corners, of }: &PartFinding) -> String {
    if corners.len() > MAX_LISTED_CORNERS {
        return counted(corners.len(), "corner");
    }
    let corner = |(at, [j, i]): (&[f64; 2], &[usize; 2])| format!("b{j} - a{i} = {}", point(at));
    corners.iter().zip(of).map(corner).collect::<Vec<_>>().join(", ")
}

fn point([x, y]: &[f64; 2]) -> String {
    format!("({}, {})", number(*x), number(*y))
}

/// Formats a number with six significant digits.
fn number(value: f64) -> String {
    (short(value) + 0.0).to_string()
}
