//! Hints for values of the wrong type in a world file.

/// Keys, each with the form of its value. `robot.joints` means this key in the table `[robot]`. A key without a table applies to
/// all other tables.
const KEY_FORMS: [(&str, &str); 33] = [
    ("start", "[start] joints = [q1, q2], or tip = [x, y]"),
    ("goal", "[goal] joints = [q1, q2], or tip = [x, y]"),
    ("robot.joints", "joints = [\"first\", \"second\"], base to tip"),
    ("robot.tip", "tip = \"name of a link\""),
    ("robot", "write a table: [robot], then its keys, such as joints = [\"first\", \"second\"]"),
    ("joints", "joints = [q1, q2], numbers or angles such as \"30deg\", base to tip"),
    ("tip", "tip = [x, y], metres"),
    ("fixed", "fixed = { NAME = value }"),
    ("limits", "limits = { NAME = [lower, upper] }"),
    ("velocity", "velocity = { NAME = value }"),
    ("acceleration", "acceleration = { NAME = value }"),
    ("jerk", "jerk = { NAME = value }"),
    ("bar", "bar = 0.05, metres"),
    ("obstacle", "[[obstacle]] with one of polygon, circle, polyline, image"),
    ("polygon", "polygon = [[x, y], [x, y], [x, y]]"),
    ("holes", "holes = [[[x, y], [x, y], [x, y]]]"),
    ("polyline", "polyline = [[x, y], [x, y]]"),
    ("circle", "circle = { center = [x, y], radius = r }"),
    ("center", "center = [x, y]"),
    ("radius", "radius = r, metres"),
    (
        "motion",
        "motion = { velocity = [vx, vy] }, or { stops = [{ time = 0, at = [x, y] }, { time = 2, at = [x, y] }] }",
    ),
    ("stops", "stops = [{ time = 0, at = [x, y] }, { time = 2, at = [x, y], angle = a }], seconds and metres"),
    ("time", "time = t, seconds since the arm's motion begins"),
    ("height", "height = [lower, upper], metres"),
    ("pallet.height", "height = 0.02, metres"),
    ("step.height", "height = 0.02, metres"),
    ("step.steps.height", "height = 0.02, metres"),
    ("clearance", "clearance = 0.01, metres"),
    ("name", "name = \"words\""),
    ("image", "image = \"map.yaml\""),
    ("map", "write a table: [map] file = \"walls.map\""),
    ("object", "[[object]] with name, at, and one of polygon and circle"),
    ("step", "[[step]] with pick = \"NAME\", place = { at = [x, y] } or move = { joints = [q1, q2] }"),
];

/// The hint for a key that has no entry in [`KEY_FORMS`].
const DEFAULT_HINT: &str =
    "`cplan init` writes a world with every key explained; `cplan schema` prints the schema for editors";

/// Returns the hint for an error at the byte `at` of a world file: the form of the value of the key at this place.
pub(super) fn help(text: &str, at: usize) -> &'static str {
    let before = &text[..char_boundary(text, at)];
    let line_start = before.rfind('\n').map_or(0, |i| i + 1);
    let line_end = text[line_start..].find('\n').map_or(text.len(), |i| line_start + i);
    let line = text[line_start..line_end].trim();
    // The key is on the line of the error, possibly in an inline table.
    let written = &text[line_start.min(before.len())..line_end];
    let reach = before.len() - line_start.min(before.len());
    let key_of = |part: &str| {
        let key = part.trim_end().rsplit(|c: char| !(c.is_alphanumeric() || c == '_' || c == '-')).next().unwrap_or("");
        key.to_owned()
    };
    let header = |line: &str| Some(line.trim().trim_start_matches('[').split(']').next()?.trim().to_owned());
    let table = before.lines().rev().find(|line| line.trim_start().starts_with('[') && !line.contains('='));
    let table = table.and_then(header).unwrap_or_default();
    let key = if line.starts_with('[') && !line.contains('=') {
        header(line).unwrap_or_default()
    } else {
        // If the line has several keys, the last one that begins at or before the error counts.
        let mut keys = written.match_indices('=').filter(|(i, _)| *i <= reach || !written[..*i].contains('='));
        keys.next_back().map(|(i, _)| key_of(&written[..i])).unwrap_or_default()
    };
    let form = |key: &str| KEY_FORMS.iter().find(|(name, _)| *name == key).map(|(_, form)| *form);
    form(&format!("{table}.{key}")).or_else(|| form(&key)).unwrap_or(DEFAULT_HINT)
}

/// Returns the last boundary between characters at or before a byte.
fn char_boundary(text: &str, at: usize) -> usize {
    (0..=at.min(text.len())).rev().find(|i| text.is_char_boundary(*i)).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hints_follow_the_key_at_the_place() {
        let of = |text: &str, mark: &str| help(text, text.find(mark).unwrap());
        assert!(of("[start]\njoints = {}\n", "{}").starts_with("joints = [q1, q2]"));
        assert!(of("start = [1, 2]\n", "[1").starts_with("[start]"));
        assert!(of("[robot]\njoints = 3\n", "3").starts_with("joints = [\"first\""));
        assert!(of("[[obstacle]]\ncircle = { center = 5, radius = 1 }\n", "5").starts_with("center"));
        assert!(
            of("[[obstacle]]\ncircle = { center = [5, 5], radius = \"\u{e4}\" }\n", "\"\u{e4}").starts_with("radius")
        );
        assert_eq!(of("[start]\nangle = 3\n", "3"), DEFAULT_HINT);
        assert_eq!(help("", 9), DEFAULT_HINT);
    }
}
