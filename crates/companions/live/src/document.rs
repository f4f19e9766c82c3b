//! The text of a world, edited as the page requests. Comments, names, heights and unknown keys are preserved.

use super::protocol::{Begin, End, Form, JointLimits, MAX_CORNERS, MAX_OBSTACLES, Pair, Piece, State};
use cplan_text::metres;
use std::collections::BTreeSet;
use toml_edit::{Array, ArrayOfTables, DocumentMut, InlineTable, Item, Table, TableLike, Value, value};

/// A TOML text and its parsed content, which need not be a valid world.
#[derive(Debug, Clone)]
pub struct Document {
    text: String,
    toml: DocumentMut,
}

impl Document {
    /// Parses a text. `None` if it is not TOML. The reader of worlds then reports the reason.
    pub fn parse(text: &str) -> Option<Self> {
        Some(Self { text: text.to_owned(), toml: text.parse().ok()? })
    }

    /// Returns the current text, with all edits.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the files that the text names.
    pub fn files(&self) -> BTreeSet<String> {
        let map = self.toml.get("map").and_then(Item::as_table_like);
        let of_map = ["file", "preferences"].into_iter().filter_map(|key| map?.get(key)?.as_str());
        let tables = self.obstacles().unwrap_or_default();
        let images = tables.iter().filter_map(|table| table.get("image")?.as_str());
        of_map.chain(images).map(str::to_owned).collect()
    }

    /// Returns the tables `[[obstacle]]`. `None` if they are not tables.
    fn obstacles(&self) -> Option<ArrayOfTables> {
        match self.toml.get("obstacle") {
            None => Some(ArrayOfTables::new()),
            Some(item) => item.clone().into_array_of_tables().ok(),
        }
    }

    /// Splits the obstacles into static and moving ones. The page shows moving obstacles but cannot change them.
    fn by_motion(&self) -> Option<(Vec<Table>, Vec<Table>)> {
        Some(self.obstacles()?.into_iter().partition(|table| !table.contains_key("motion")))
    }

    /// Returns the joint values of the start. `None` if the text has none.
    pub fn start(&self) -> Option<Pair> {
        pair(self.toml.get("start")?.get("joints"))
    }

    /// Returns the goal, if the text has one.
    pub fn goal(&self) -> Option<End> {
        let goal = self.toml.get("goal")?;
        pair(goal.get("joints")).map(End::Joints).or_else(|| pair(goal.get("tip")).map(End::Tip))
    }

    /// Returns the shapes of the static obstacles, in order. `None` for a shape that the page cannot change.
    pub fn forms(&self) -> Vec<Option<Form>> {
        self.by_motion().unwrap_or_default().0.iter().map(form).collect()
    }

    /// Returns the text with the changes that make it match the state of the page. A text that already matches remains
    /// unchanged.
    ///
    /// # Errors
    /// The reason, if the state is too large, or refers to obstacles that the text does not have.
    pub fn changed(&self, state: &State, start: Option<Pair>) -> Result<String, String> {
        let corners: usize = state.obstacles.iter().flat_map(|piece| &piece.shape).map(Form::corners).sum();
        if state.obstacles.len() > MAX_OBSTACLES || corners > MAX_CORNERS {
            return Err(format!(
                "too many obstacles or corners: the live page allows {MAX_OBSTACLES} obstacles with {MAX_CORNERS} corners in all, but there are {} with {corners}",
                state.obstacles.len()
            ));
        }
        let mut toml = self.toml.clone();
        let mut touched = self.change_obstacles(&mut toml, &state.obstacles)?;
        let clearance = toml.get("clearance").and_then(number).unwrap_or(0.0);
        if clearance != state.clearance {
            set_value(toml.as_table_mut(), "clearance", value(state.clearance));
            touched = true;
        }
        for limits in &state.limits {
            touched |= change_limits(&mut toml, limits)?;
        }
        let joints = start.or(match state.start {
            Some(Begin::Joints { joints }) => Some(joints),
            _ => None,
        });
        touched |= joints.is_some_and(|q| change_place(&mut toml, "start", "joints", q));
        touched |= match state.goal {
            Some(End::Joints(q)) => change_place(&mut toml, "goal", "joints", q),
            Some(End::Tip(p)) => change_place(&mut toml, "goal", "tip", p),
            None => false,
        };
        Ok(if touched { toml.to_string() } else { self.text.clone() })
    }

    /// Changes the obstacles to match those of the page. Returns true if anything changed.
    fn change_obstacles(&self, toml: &mut DocumentMut, pieces: &[Piece]) -> Result<bool, String> {
        let (before, moving) = self.by_motion().ok_or("obstacles in the text must be [[obstacle]] tables")?;
        let same = pieces.len() == before.len()
            && pieces.iter().zip(&before).enumerate().all(|(i, (piece, table))| {
                let keeps = |shape: &Form| form(table).as_ref() == Some(shape);
                piece.from == Some(i) && piece.shape.as_ref().is_none_or(keeps) && !renames(table, piece)
            });
        if same {
            return Ok(false);
        }
        let mut after = ArrayOfTables::new();
        // Tables are written in the order of their positions. A table without a position follows the previous table.
        let last = before.iter().chain(&moving).filter_map(Table::position).max();
        let places: Vec<_> = before.iter().map(Table::position).collect();
        for (k, piece) in pieces.iter().enumerate() {
            let mut table = match piece.from {
                Some(from) => before.get(from).cloned().ok_or(format!("the text has no obstacle {}", from + 1))?,
                None => Table::new(),
            };
            if let Some(shape) = piece.shape.as_ref().filter(|shape| form(&table).as_ref() != Some(*shape)) {
                for key in ["polygon", "circle", "polyline"] {
                    if key != key_of(shape) {
                        table.remove(key);
                    }
                }
                set_value(&mut table, key_of(shape), Item::Value(written(shape)));
            }
            if let Some(name) = piece.name.as_ref().filter(|_| renames(&table, piece)) {
                set_value(&mut table, "name", value(name));
                if piece.from.is_none() {
                    table.sort_values_by(|a, _, b, _| (a.get() != "name").cmp(&(b.get() != "name")));
                }
            }
            if piece.from.is_none() {
                table.decor_mut().set_prefix("\n");
            }
            table.set_position(places.get(k).copied().flatten().or(last));
            after.push(table);
        }
        moving.into_iter().for_each(|table| after.push(table));
        if after.is_empty() {
            toml.remove("obstacle");
        } else {
            toml.insert("obstacle", Item::ArrayOfTables(after));
        }
        Ok(true)
    }
}

/// Returns true if the piece and the table have different names. The page calls an obstacle without a name by its
/// number.
fn renames(table: &Table, piece: &Piece) -> bool {
    piece.name.as_deref().is_some_and(|name| table.get("name").and_then(Item::as_str) != Some(name))
}

/// Sets the value of a key. Comments around the old value are preserved.
fn set_value(table: &mut dyn TableLike, key: &str, item: Item) {
    match (table.get_mut(key).and_then(Item::as_value_mut), item) {
        (Some(old), Item::Value(mut new)) => {
            *new.decor_mut() = old.decor().clone();
            *old = new;
        }
        (_, item) => {
            table.insert(key, item);
        }
    }
}

/// Writes `key = [a, b]` as the only content of the table `name`. Returns true if the text changes.
fn change_place(toml: &mut DocumentMut, name: &str, key: &str, [a, b]: Pair) -> bool {
    let other = if key == "joints" { "tip" } else { "joints" };
    let now = toml.get(name).and_then(Item::as_table_like);
    if now.is_some_and(|table| pair(table.get(key)) == Some([a, b]) && table.get(other).is_none()) {
        return false;
    }
    let new = Value::from(Array::from_iter([a, b]));
    match toml.get_mut(name).and_then(Item::as_table_like_mut) {
        Some(table) => {
            table.remove(other);
            if key == "joints" {
                // Joint values determine the side of the elbow.
                table.remove("elbow");
            }
            set_value(table, key, Item::Value(new));
        }
        None => {
            let mut table = Table::new();
            table.insert(key, Item::Value(new));
            table.decor_mut().set_prefix("\n");
            toml.insert(name, Item::Table(table));
        }
    }
    true
}

/// Writes the limits of a joint into the table `robot.limits`. Returns true if the text changes.
///
/// # Errors
/// The text has something else in the place of these tables.
fn change_limits(toml: &mut DocumentMut, JointLimits { joint, range }: &JointLimits) -> Result<bool, String> {
    let not_a_table = || "the text's [robot] limits are not a table".to_owned();
    let robot = toml.entry("robot").or_insert_with(|| {
        let mut table = Table::new();
        table.decor_mut().set_prefix("\n");
        Item::Table(table)
    });
    let robot = robot.as_table_like_mut().ok_or_else(not_a_table)?;
    let limits = robot.entry("limits").or_insert_with(|| Item::Value(InlineTable::new().into()));
    let limits = limits.as_table_like_mut().ok_or_else(not_a_table)?;
    if pair(limits.get(joint)) == Some(*range) {
        return Ok(false);
    }
    limits.insert(joint, Item::Value(Value::from(Array::from_iter(*range))));
    Ok(true)
}

fn key_of(shape: &Form) -> &'static str {
    match shape {
        Form::Polygon(_) => "polygon",
        Form::Circle { .. } => "circle",
        Form::Polyline(_) => "polyline",
    }
}

fn written(shape: &Form) -> Value {
    let points = |points: &[Pair]| points.iter().map(|&[x, y]| Array::from_iter([x, y])).collect::<Array>();
    match shape {
        Form::Polygon(corners) | Form::Polyline(corners) => Value::from(points(corners)),
        Form::Circle { center, radius } => {
            let mut table = InlineTable::new();
            table.insert("center", Array::from_iter(*center).into());
            table.insert("radius", (*radius).into());
            Value::from(table)
        }
    }
}

/// Returns the shape of an obstacle's table. `None` unless it has exactly one shape that the page can change.
fn form(table: &Table) -> Option<Form> {
    // In a frame of its own, the obstacle's points are not world coordinates.
    if table.contains_key("at") || table.contains_key("angle") {
        return None;
    }
    let corners = |key: &str| -> Option<Vec<Pair>> {
        table.get(key)?.as_array()?.iter().map(|p| pair_of(p.as_array()?)).collect()
    };
    let circle = || {
        let circle = table.get("circle")?.as_table_like()?;
        Some(Form::Circle { center: pair(circle.get("center"))?, radius: number(circle.get("radius")?)? })
    };
    let mut forms = corners("polygon").map(Form::Polygon).into_iter().chain(circle());
    let first = forms.next().or_else(|| corners("polyline").map(Form::Polyline));
    let shapes = ["polygon", "circle", "polyline", "image"].into_iter().filter(|key| table.contains_key(key)).count();
    first.filter(|_| shapes == 1 && !table.contains_key("holes"))
}

fn pair(item: Option<&Item>) -> Option<Pair> {
    pair_of(item?.as_array()?)
}

fn pair_of(array: &Array) -> Option<Pair> {
    let degrees =
        |x: &Value| x.as_str()?.trim().strip_suffix("deg")?.trim_end().parse::<f64>().ok().map(f64::to_radians);
    let mut numbers = array.iter().map(|x| {
        x.as_float().or_else(|| x.as_integer().map(|i| i as f64)).or_else(|| degrees(x)).or_else(|| length(x.as_str()))
    });
    match (numbers.next(), numbers.next(), numbers.next()) {
        (Some(Some(a)), Some(Some(b)), None) => Some([a, b]),
        _ => None,
    }
}

fn number(item: &Item) -> Option<f64> {
    item.as_float().or_else(|| item.as_integer().map(|i| i as f64)).or_else(|| length(item.as_str()))
}

/// Returns a length that a text states with its unit, in metres.
fn length(text: Option<&str>) -> Option<f64> {
    metres(text?).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "\
# A world.
name = \"w\" # its name
clearance = 0

[start]
joints = [0, 1.5] # here

[goal]
tip = [1.0, 2.0]

# The first.
[[obstacle]]
name = \"a\"
polygon = [[0, 0], [1, 0], [0, 1]] # three corners
height = [0, 1]

[[obstacle]] # the second
circle = { center = [3.0, 4.0], radius = 0.5 }

[[obstacle]]
image = \"map.yaml\"
";

    fn document() -> Document {
        Document::parse(TEXT).unwrap()
    }

    fn state(pieces: Vec<Piece>) -> State {
        State {
            obstacles: pieces,
            start: Some(Begin::Joints { joints: [0.0, 1.5] }),
            goal: Some(End::Tip([1.0, 2.0])),
            clearance: 0.0,
            limits: Vec::new(),
        }
    }

    fn kept_piece(from: usize) -> Piece {
        Piece { from: Some(from), ..Piece::default() }
    }

    #[test]
    fn obstacles_with_their_own_frame_are_not_editable() {
        let forms = |text: &str| Document::parse(text).unwrap().forms();
        let disc = "[[obstacle]]\ncircle = { center = [1, 2], radius = 0.5 }\n";
        assert!(forms(disc)[0].is_some());
        assert_eq!(forms(&format!("{disc}at = [1, 0]\n")), [None]);
        assert_eq!(forms(&format!("{disc}angle = 0.5\n")), [None]);
    }

    #[test]
    fn equal_content_changes_no_byte() {
        let document = document();
        let forms = document.forms();
        let pieces = forms.into_iter().enumerate().map(|(i, shape)| Piece { shape, ..kept_piece(i) }).collect();
        assert_eq!(document.changed(&state(pieces), None).unwrap(), TEXT);
    }

    #[test]
    fn a_moved_corner_changes_that_shape_and_nothing_else() {
        let moved = Form::Polygon(vec![[0.0, 0.0], [1.25, 0.0], [0.0, 1.0]]);
        let text = document()
            .changed(&state(vec![Piece { shape: Some(moved), ..kept_piece(0) }, kept_piece(1), kept_piece(2)]), None);
        let expected = TEXT.replace("[[0, 0], [1, 0], [0, 1]]", "[[0.0, 0.0], [1.25, 0.0], [0.0, 1.0]]");
        assert_eq!(text.unwrap(), expected);
    }

    #[test]
    fn obstacles_come_and_go() {
        let wall =
            Piece { name: Some("wall".into()), shape: Some(Form::Polyline(vec![[0.0, 0.0], [1.0, 1.0]])), from: None };
        let text = document().changed(&state(vec![kept_piece(1), wall]), None).unwrap();
        let after = Document::parse(&text).unwrap();
        let wall = Form::Polyline(vec![[0.0, 0.0], [1.0, 1.0]]);
        assert_eq!(after.forms(), [Some(Form::Circle { center: [3.0, 4.0], radius: 0.5 }), Some(wall)]);
        assert!(text.ends_with("\n[[obstacle]]\nname = \"wall\"\npolyline = [[0.0, 0.0], [1.0, 1.0]]\n"), "{text}");
        assert!(text.starts_with("# A world.\nname = \"w\" # its name\n"), "{text}");
        let none = document().changed(&state(Vec::new()), None).unwrap();
        assert!(!none.contains("obstacle"), "{none}");
    }

    #[test]
    fn places_change_their_kind() {
        let state = State {
            start: Some(Begin::Joints { joints: [0.25, 1.5] }),
            goal: Some(End::Joints([0.5, 0.75])),
            clearance: 0.125,
            ..state(vec![kept_piece(0), kept_piece(1), kept_piece(2)])
        };
        let text = document().changed(&state, None).unwrap();
        let expected = TEXT
            .replace("clearance = 0", "clearance = 0.125")
            .replace("[0, 1.5] # here", "[0.25, 1.5] # here")
            .replace("tip = [1.0, 2.0]", "joints = [0.5, 0.75]");
        assert_eq!(text, expected);
        let sided = TEXT.replace("tip = [1.0, 2.0]", "tip = [1.0, 2.0]\nelbow = \"left\"");
        assert_eq!(Document::parse(&sided).unwrap().changed(&state, None).unwrap(), expected);
    }

    #[test]
    fn limits_are_written_for_the_robot() {
        let limits = vec![JointLimits { joint: "elbow".into(), range: [-1.5, 1.5] }];
        let state = State { limits: limits.clone(), ..state(vec![kept_piece(0), kept_piece(1), kept_piece(2)]) };
        let text = document().changed(&state, None).unwrap();
        let again = Document::parse(&text).unwrap();
        assert_eq!(pair(again.toml["robot"]["limits"].get("elbow")), Some([-1.5, 1.5]), "{text}");
        let table = Document::parse("[robot.limits]\nelbow = [0, 1] # here\n").unwrap();
        let state = State { start: None, goal: None, limits, ..self::state(Vec::new()) };
        assert_eq!(
            pair(Document::parse(&table.changed(&state, None).unwrap()).unwrap().toml["robot"]["limits"].get("elbow")),
            Some([-1.5, 1.5])
        );
    }

    #[test]
    fn missing_tables_are_added_to_the_text() {
        let empty = Document::parse("").unwrap();
        let disc = Piece { shape: Some(Form::Circle { center: [1.0, 0.0], radius: 0.5 }), ..Piece::default() };
        let text = empty.changed(&state(vec![disc]), None).unwrap();
        let again = Document::parse(&text).unwrap();
        assert_eq!(again.forms().len(), 1);
        assert_eq!(pair(again.toml["start"].get("joints")), Some([0.0, 1.5]));
        assert_eq!(pair(again.toml["goal"].get("tip")), Some([1.0, 2.0]));
    }

    /// Tests that the page's indices count only static obstacles, and that moving obstacles remain unchanged.
    #[test]
    fn moving_obstacles_are_not_editable() {
        let cart = "[[obstacle]]\ncircle = { center = [0, 0], radius = 0.1 }\nmotion = { velocity = [0.1, 0] }\n";
        let text = format!("{cart}[[obstacle]]\ncircle = {{ center = [1, 2], radius = 0.5 }}\n");
        let document = Document::parse(&text).unwrap();
        let disc = |x: f64| Form::Circle { center: [x, 2.0], radius: 0.5 };
        assert_eq!(document.forms(), [Some(disc(1.0))]);
        let piece = Piece { from: Some(0), name: None, shape: Some(disc(3.0)) };
        let state = State { start: None, goal: None, ..state(vec![piece]) };
        let moved = document.changed(&state, None).unwrap();
        assert_eq!(moved, text.replace("[1, 2]", "[3.0, 2.0]"));
    }

    #[test]
    fn inline_obstacles_are_obstacles() {
        let inline = Document::parse("obstacle = [{ polygon = [[0, 0], [1, 0], [0, 1]] }]\n").unwrap();
        assert_eq!(inline.forms().len(), 1);
        let text = inline.changed(&state(vec![kept_piece(0), kept_piece(0)]), None).unwrap();
        assert_eq!(Document::parse(&text).unwrap().forms().len(), 2, "{text}");
    }

    #[test]
    fn too_large_changes_and_missing_files_are_refused() {
        let error = document().changed(&state(vec![kept_piece(3)]), None).unwrap_err();
        assert_eq!(error, "the text has no obstacle 4");
        let error = document().changed(&state(vec![kept_piece(0); MAX_OBSTACLES + 1]), None).unwrap_err();
        assert!(error.contains("the live page allows 1000 obstacles"), "{error}");
    }

    #[test]
    fn the_files_of_a_world_include_those_of_its_map() {
        assert_eq!(document().files().into_iter().collect::<Vec<_>>(), ["map.yaml"]);
        let map = Document::parse("map = { file = \"a.map\", preferences = \"b.map\" }").unwrap();
        assert_eq!(map.files().into_iter().collect::<Vec<_>>(), ["a.map", "b.map"]);
    }
}
