//! Addresses of numbers in world files and URDFs: `world.obstacle.post.at[0]`, `urdf.joint.elbow.origin.xyz[0]`.

use cplan_text::metres;
use std::fmt;
use std::ops::Range;
use strsim::levenshtein;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

/// A step of an address such as `obstacle.shelf.at[0]`, which leads to a value in a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Step {
    /// The name of a key, element or attribute, or of a named table or element.
    Name(String),
    /// The index of an entry, from 0.
    Number(usize),
}

impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Name(name) => write!(f, "\"{name}\""),
            Self::Number(number) => write!(f, "[{number}]"),
        }
    }
}

/// Parses `a.b."c d"[2]`.
///
/// # Errors
/// The syntax error.
pub(super) fn steps(text: &str) -> Result<Vec<Step>, String> {
    let mut steps = Vec::new();
    let mut rest = text;
    loop {
        let (name, after) = match rest.strip_prefix('"') {
            Some(quoted) => quoted.split_once('"').ok_or_else(|| format!("{text}: a quotation mark is not closed"))?,
            None => rest.split_at(rest.find(['.', '[', '"']).unwrap_or(rest.len())),
        };
        if name.is_empty() {
            return Err(format!("{text}: a name is missing"));
        }
        steps.push(Step::Name(name.to_owned()));
        rest = after;
        while let Some(inside) = rest.strip_prefix('[') {
            let (digits, after) = inside.split_once(']').ok_or_else(|| format!("{text}: a bracket is not closed"))?;
            let number = digits.trim().parse().map_err(|_| format!("{text}: [{digits}] is not a number from 0 on"))?;
            steps.push(Step::Number(number));
            rest = after;
        }
        match rest.strip_prefix('.') {
            Some(after) => rest = after,
            None if rest.is_empty() => return Ok(steps),
            None => return Err(format!("{text}: after a name comes a dot or a bracket, not {rest}")),
        }
    }
}

/// A number in the text of a file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FoundNumber {
    /// Position of the number, in bytes.
    pub at: Range<usize>,
    /// True if the number is an integer in the file, as counts must be.
    pub is_whole: bool,
}

/// Keys that a world file may omit for a robot or an obstacle, with their default values.
const DEFAULT_KEYS: [(&str, &str); 2] = [("at", "[0.0, 0.0]"), ("angle", "0.0")];

/// Returns the text of a world in which the number at an address is written out. Returns the same text unless the
/// number is an omitted default of a robot or an obstacle.
pub(super) fn written_out(text: &str, steps: &[Step]) -> String {
    let (table, key) = match steps {
        [Step::Name(robot), Step::Name(key), ..] if robot == "robot" => (&steps[..1], key),
        [Step::Name(obstacle), _, Step::Name(key), ..] if obstacle == "obstacle" => (&steps[..2], key),
        _ => return text.to_owned(),
    };
    let Some((_, silent)) = DEFAULT_KEYS.iter().find(|(silent, _)| silent == key) else { return text.to_owned() };
    // TOML has several forms of tables. Take the first insertion after which the address leads to a number.
    let candidates = [
        insert_into_table(text, table, key, silent),
        append_table(text, table, key, silent),
        insert_dotted_key(text, table, key, silent),
    ];
    let written = candidates.into_iter().flatten().find(|text| in_world(text, steps).is_ok());
    written.filter(|_| in_world(text, steps).is_err()).unwrap_or_else(|| text.to_owned())
}

/// Inserts a key at the beginning of its table. `None` if the table has no header and is not inline.
fn insert_into_table(text: &str, table: &[Step], key: &str, silent: &str) -> Option<String> {
    let document = DeTable::parse(text).ok()?;
    let (_, at) = descend(document.get_ref(), document.span(), table).ok()?;
    let opening = &text[at.start..];
    let (end, written) = match opening.chars().next()? {
        '{' if opening[1..].trim_start().starts_with('}') => (1, format!(" {key} = {silent} ")),
        '{' => (1, format!(" {key} = {silent},")),
        _ => (opening.find('\n').map_or(opening.len(), |end| end + 1), format!("{key} = {silent}\n")),
    };
    let (before, after) = text.split_at(at.start + end);
    let break_before = if before.ends_with(['\n', '{']) { "" } else { "\n" };
    Some(format!("{before}{break_before}{written}{after}"))
}

/// Appends a table `[robot]` with the key, for a robot that has no keys of its own.
fn append_table(text: &str, table: &[Step], key: &str, silent: &str) -> Option<String> {
    (table.len() == 1).then(|| format!("{}\n\n[robot]\n{key} = {silent}\n", text.trim_end()))
}

/// Inserts a dotted key `robot.KEY`, for a robot whose other keys are dotted.
fn insert_dotted_key(text: &str, table: &[Step], key: &str, silent: &str) -> Option<String> {
    (table.len() == 1).then(|| format!("robot.{key} = {silent}\n{text}"))
}

/// A value in a TOML document.
enum DeRef<'a> {
    Table(&'a DeTable<'a>),
    Array(&'a DeArray<'a>),
    Value(&'a DeValue<'a>),
}

fn value_with_span<'a>(value: &'a Spanned<DeValue<'a>>) -> (DeRef<'a>, Range<usize>) {
    let seen = match value.get_ref() {
        DeValue::Table(table) => DeRef::Table(table),
        DeValue::Array(array) => DeRef::Array(array),
        other => DeRef::Value(other),
    };
    (seen, value.span())
}

/// Returns the value to which the steps lead. In a list of tables, a name selects the table with this `name`.
fn descend<'a>(root: &'a DeTable<'a>, at: Range<usize>, steps: &[Step]) -> Result<(DeRef<'a>, Range<usize>), String> {
    let mut here = (DeRef::Table(root), at);
    for step in steps {
        let next = match (&here.0, step) {
            (DeRef::Table(table), Step::Name(name)) => table.get(name.as_str()),
            (DeRef::Array(array), Step::Number(number)) => array.get(*number),
            (DeRef::Array(array), Step::Name(name)) => {
                let mut named = array.iter().filter(|entry| is_named(entry.get_ref(), name));
                let first = named.next();
                if named.next().is_some() {
                    return Err(format!("several are named \"{name}\": choose one by its number, as in [0]"));
                }
                first
            }
            _ => None,
        };
        here = value_with_span(next.ok_or_else(|| missing(&here.0, step))?);
    }
    Ok(here)
}

fn is_named(value: &DeValue, name: &str) -> bool {
    let DeValue::Table(table) = value else { return false };
    table.get("name").and_then(|given| given.get_ref().as_str()).is_some_and(|given| given == name)
}

fn missing(here: &DeRef, step: &Step) -> String {
    let there = match here {
        DeRef::Table(table) => table.keys().map(|key| key.get_ref().to_string()).collect::<Vec<_>>().join(", "),
        DeRef::Array(array) => {
            let name = |entry: &Spanned<DeValue>| match entry.get_ref() {
                DeValue::Table(table) => table.get("name").and_then(|name| name.get_ref().as_str().map(str::to_owned)),
                _ => None,
            };
            let names: Vec<String> = array.iter().filter_map(name).collect();
            let numbered = format!("[0] to [{}]", array.len().saturating_sub(1));
            if names.is_empty() { numbered } else { format!("{}, or {numbered}", names.join(", ")) }
        }
        DeRef::Value(_) => return format!("there is no {step}: this is a single value, not a table or list"),
    };
    format!("there is no {step}; there is {there}")
}

/// Returns the number at an address in a world file.
///
/// # Errors
/// The reason, if there is no number.
pub(super) fn in_world(text: &str, steps: &[Step]) -> Result<FoundNumber, String> {
    let document = DeTable::parse(text).map_err(|error| error.message().to_owned())?;
    match descend(document.get_ref(), document.span(), steps)? {
        (DeRef::Value(DeValue::Float(_)), at) => Ok(FoundNumber { at, is_whole: false }),
        (DeRef::Value(DeValue::Integer(_)), at) => Ok(FoundNumber { at, is_whole: true }),
        // An angle such as "30deg", or a length such as "20 mm".
        (DeRef::Value(DeValue::String(text)), at) if text.trim_end().ends_with("deg") || metres(text).is_ok() => {
            Ok(FoundNumber { at, is_whole: false })
        }
        (DeRef::Array(_), _) => Err("it is a list: name an entry, as in [0]".into()),
        (DeRef::Table(_), _) => Err("it is a table: name a key".into()),
        _ => Err("it is not a number".into()),
    }
}

/// Returns the position of the value at an address of a TOML document. `None` if there is no such value.
pub(super) fn entry_in(text: &str, steps: &[Step]) -> Option<Range<usize>> {
    let document = DeTable::parse(text).ok()?;
    descend(document.get_ref(), document.span(), steps).ok().map(|(_, at)| at)
}

/// Returns true if the value at an address may be an angle: an angle of a frame, or a value of a joint.
pub(super) fn is_angle(address: &str) -> bool {
    const ANGLE_KEYS: [&str; 7] = ["angle", "joints", "fixed", "limits", "rpy", "lower", "upper"];
    let steps = steps(address).unwrap_or_default();
    let mut names = steps.iter().rev().filter_map(|step| match step {
        Step::Name(name) => Some(name.as_str()),
        Step::Number(_) => None,
    });
    // The last part of the address may be the name of a joint.
    names.by_ref().take(2).any(|name| ANGLE_KEYS.contains(&name))
}

/// Returns the addresses of all numbers of a world file, without the prefix `world.`. Includes omitted defaults.
pub(super) fn all_in_world(text: &str) -> Vec<String> {
    let mut found = vec!["robot.at[0]".to_owned(), "robot.at[1]".to_owned(), "robot.angle".to_owned()];
    if let Ok(document) = DeTable::parse(text) {
        numbers_of_table(document.get_ref(), "", &mut found);
    }
    found
}

fn numbers_of_table(table: &DeTable, path: &str, found: &mut Vec<String>) {
    for (key, value) in table {
        let dot = if path.is_empty() { "" } else { "." };
        numbers_of(value.get_ref(), &format!("{path}{dot}{}", quoted(key.get_ref())), found);
    }
}

fn numbers_of(value: &DeValue, path: &str, found: &mut Vec<String>) {
    match value {
        DeValue::Table(table) => numbers_of_table(table, path, found),
        DeValue::Array(array) => {
            for (number, entry) in array.iter().enumerate() {
                let DeValue::Table(table) = entry.get_ref() else {
                    numbers_of(entry.get_ref(), &format!("{path}[{number}]"), found);
                    continue;
                };
                let name = table.get("name").and_then(|name| name.get_ref().as_str());
                let entry = name.map_or_else(|| format!("{path}[{number}]"), |name| format!("{path}.{}", quoted(name)));
                if path == "obstacle" {
                    found.extend(["at[0]", "at[1]", "angle"].map(|silent| format!("{entry}.{silent}")));
                }
                numbers_of_table(table, &entry, found);
            }
        }
        DeValue::Float(_) | DeValue::Integer(_) => found.push(path.to_owned()),
        _ => {}
    }
}

fn quoted(name: &str) -> String {
    if name.contains([' ', '.', '[']) { format!("\"{name}\"") } else { name.to_owned() }
}

/// Returns the addresses of all numbers of a URDF, without the prefix `urdf.`.
pub(super) fn all_in_urdf(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    if let Ok(document) = roxmltree::Document::parse(text) {
        numbers_of_element(document.root_element(), "", &mut found);
    }
    found
}

fn numbers_of_element(element: roxmltree::Node, path: &str, found: &mut Vec<String>) {
    for attribute in element.attributes() {
        let words: Vec<&str> = attribute.value().split_whitespace().collect();
        let numbers = words.iter().enumerate().filter(|(_, word)| word.parse::<f64>().is_ok());
        let entry = |k: usize| if words.len() > 1 { format!("[{k}]") } else { String::new() };
        found.extend(numbers.map(|(k, _)| format!("{path}{}{}", attribute.name(), entry(k))));
    }
    for child in element.children().filter(roxmltree::Node::is_element) {
        let tag = child.tag_name().name();
        let mut twins = element.children().filter(|twin| twin.has_tag_name(tag));
        let which = match child.attribute("name").filter(|_| ["joint", "link"].contains(&tag)) {
            Some(name) => format!(".{}", quoted(name)),
            None if twins.clone().count() > 1 => format!("[{}]", twins.position(|twin| twin == child).unwrap_or(0)),
            None => String::new(),
        };
        numbers_of_element(child, &format!("{path}{tag}{which}."), found);
    }
}

/// Largest number of known addresses that are searched for a hint. Maps and drawings may have more.
const MAX_COMPARED_ADDRESSES: usize = 10_000;

pub(super) fn nearest(address: &str, known: Vec<String>) -> Option<String> {
    known.into_iter().take(MAX_COMPARED_ADDRESSES).min_by_key(|known| levenshtein(address, known))
}

/// Returns the number at an address in a URDF. The address consists of tags of elements, an attribute, and the index of
/// the number in it. A name follows the tags `joint` and `link`.
///
/// # Errors
/// The reason, if there is no number.
pub(super) fn in_urdf(text: &str, steps: &[Step]) -> Result<FoundNumber, String> {
    let document = roxmltree::Document::parse(text).map_err(|error| error.to_string())?;
    let mut here = document.root_element();
    let mut steps = steps.iter().peekable();
    while let Some(step) = steps.next() {
        let Step::Name(name) = step else { return Err(format!("there is no {step} in <{}>", here.tag_name().name())) };
        if let Some(attribute) = here.attribute_node(name.as_str()) {
            let number = match (steps.next(), steps.next()) {
                (None, _) => 0,
                (Some(Step::Number(number)), None) => *number,
                (Some(step), _) => return Err(format!("there is no {step} in an attribute")),
            };
            let range = attribute.range_value();
            let words = entries(&text[range.clone()]);
            let at = words.get(number).ok_or_else(|| format!("{name} has {} entries", words.len()))?;
            let at = range.start + at.start..range.start + at.end;
            text[at.clone()].parse::<f64>().map_err(|_| format!("{} is not a number", &text[at.clone()]))?;
            return Ok(FoundNumber { at, is_whole: false });
        }
        let mut children = here.children().filter(|child| child.has_tag_name(name.as_str()));
        let which = match steps.peek() {
            Some(Step::Number(number)) => children.nth(*number).map(|child| (child, true)),
            Some(Step::Name(wanted)) if ["joint", "link"].contains(&name.as_str()) => {
                children.find(|child| child.attribute("name") == Some(wanted.as_str())).map(|child| (child, true))
            }
            _ => {
                let first = children.next();
                let others = children.count();
                if others > 0 {
                    return Err(format!("there are {} <{name}>: choose one, as in {name}[0]", others + 1));
                }
                first.map(|child| (child, false))
            }
        };
        let (child, is_chosen) = which.ok_or_else(|| {
            let chosen = steps.peek().map_or_else(String::new, |step| format!(" {step}"));
            let tags: Vec<&str> = here.children().filter(|c| c.is_element()).map(|c| c.tag_name().name()).collect();
            let attributes: Vec<&str> = here.attributes().map(|a| a.name()).collect();
            let there = [attributes, tags].concat().join(", ");
            format!("there is no {name}{chosen} in <{}>, which has {there}", here.tag_name().name())
        })?;
        if is_chosen {
            steps.next();
        }
        here = child;
    }
    Err("it is an element: name an attribute".into())
}

/// Returns the positions of the words of a text, in bytes.
fn entries(text: &str) -> Vec<Range<usize>> {
    let start = |word: &str| word.as_ptr() as usize - text.as_ptr() as usize;
    text.split_whitespace().map(|word| start(word)..start(word) + word.len()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const WORLD: &str = "goal = { joints = [0.5, \"30deg\"] }\n\n[[obstacle]]\nname = \"a post\"\ncircle = { center = [1, 2.5], radius = 0.1 }\n\n[[obstacle]]\nname = \"b\"\nat = [3.0, 4.0]\npolyline = [[0, 0], [1, 0]]\n";

    fn number(address: &str) -> Result<String, String> {
        let steps = steps(address)?;
        let text = written_out(WORLD, &steps);
        in_world(&text, &steps).map(|found| text[found.at].to_owned())
    }

    #[test]
    fn worlds_are_addressed_by_key_name_and_number() {
        assert_eq!(number("goal.joints[0]").as_deref(), Ok("0.5"));
        assert_eq!(number("goal.joints[1]").as_deref(), Ok("\"30deg\""));
        assert_eq!(number("obstacle.\"a post\".circle.center[1]").as_deref(), Ok("2.5"));
        assert_eq!(number("obstacle[1].at[1]").as_deref(), Ok("4.0"));
        assert_eq!(number("obstacle.b.polyline[1][0]").as_deref(), Ok("1"));
        assert_eq!(number("goal.joints"), Err("it is a list: name an entry, as in [0]".into()));
        assert_eq!(number("obstacle.c.at[0]"), Err("there is no \"c\"; there is a post, b, or [0] to [1]".into()));
        assert_eq!(number("goal.tip[0]"), Err("there is no \"tip\"; there is joints".into()));
        let twins = WORLD.replace("\"b\"", "\"a post\"");
        let several = in_world(&twins, &steps("obstacle.\"a post\".circle.radius").unwrap());
        assert_eq!(several, Err("several are named \"a post\": choose one by its number, as in [0]".into()));
        assert_eq!(number("goal..joints"), Err("goal..joints: a name is missing".into()));
    }

    #[test]
    fn default_values_are_written_out() {
        for (address, key) in
            [("obstacle.\"a post\".at[1]", "at"), ("obstacle.b.angle", "angle"), ("robot.at[0]", "at")]
        {
            assert_eq!(number(address).as_deref(), Ok("0.0"), "{address}");
            let text = written_out(WORLD, &steps(address).unwrap());
            assert!(text.parse::<toml::Table>().is_ok_and(|table| table.to_string() != WORLD), "{key}: {text}");
        }
        let inline = "robot = { tip = \"t\" }\n";
        assert_eq!(written_out(inline, &steps("robot.at[0]").unwrap()), "robot = { at = [0.0, 0.0], tip = \"t\" }\n");
        let dotted = "robot.tip = \"t\"\n";
        assert_eq!(written_out(dotted, &steps("robot.angle").unwrap()), "robot.angle = 0.0\nrobot.tip = \"t\"\n");
        let below = "[robot.velocity]\nshoulder = 1.0\n";
        let written = written_out(below, &steps("robot.at[0]").unwrap());
        assert_eq!(written, "[robot.velocity]\nshoulder = 1.0\n\n[robot]\nat = [0.0, 0.0]\n");
        let last = "[[obstacle]]";
        assert_eq!(written_out(last, &steps("obstacle[0].angle").unwrap()), "[[obstacle]]\nangle = 0.0\n");
    }

    #[test]
    fn urdfs_are_addressed_by_tag_name_and_attribute() {
        let text = "<robot name='r'><link name='l'><collision><geometry><box size='1 2 3'/></geometry></collision><collision><geometry>\
                    <sphere radius='0.5'/></geometry></collision></link><joint name='j'><origin xyz='0.1  0.2 0.3'/></joint></robot>";
        let number = |address: &str| in_urdf(text, &steps(address)?).map(|found| &text[found.at]);
        assert_eq!(number("joint.j.origin.xyz[1]"), Ok("0.2"));
        assert_eq!(number("link.l.collision[1].geometry.sphere.radius"), Ok("0.5"));
        assert_eq!(number("link.l.collision[0].geometry.box.size[2]"), Ok("3"));
        assert_eq!(
            number("joint.k.origin.xyz[1]").unwrap_err(),
            "there is no joint \"k\" in <robot>, which has name, link, joint"
        );
        assert_eq!(number("joint.j.origin.xyz[3]"), Err("xyz has 3 entries".into()));
        let several = "there are 2 <collision>: choose one, as in collision[0]";
        assert_eq!(number("link.l.collision.geometry.box.size[2]"), Err(several.into()));
        assert_eq!(number("joint.j"), Err("it is an element: name an attribute".into()));
        assert_eq!(number("joint.j.name"), Err("j is not a number".into()));
    }
}
