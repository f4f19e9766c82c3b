//! The world file's `[[step]]` and `[task]`: reads steps and groups of steps.

use super::goal_table::GoalTable;
use super::group::{Body, Group, Leaf, LeafAction, Node};
use super::line_table::LineTable;
use super::object::{MovableObject, NameList, Names};
use super::pallet::Pallets;
use super::pick_times::PickTimes;
use super::reader::Reader;
#[cfg(test)]
use super::schema::*;
use super::table::Table;
use cplan_geometry::Pose;
use cplan_handling::ToolValues;
use cplan_model::{Elbow, Goal};
use cplan_robot::{Cursor, Diagnostic, Length, Lengths, Number, Numbers, Spanned, Written, toml_table};
use std::collections::BTreeSet;
use std::ops::Range;

toml_table! {
    /// A step or a group of steps: exactly one of pick, place, move, follow, transfer and steps.
    #[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields, rename = "step", extend(
        "oneOf" = [
            { "required": ["pick"] }, { "required": ["place"] }, { "required": ["move"] }, { "required": ["follow"] },
            { "required": ["transfer"] }, { "required": ["steps"] }
        ],
        "dependencies" = {
            "grasp": ["pick"], "supports": ["pick"], "elbow": ["pick"], "at": ["pick"], "window": ["pick"], "repeat": ["steps"], "order": ["steps"]
        },
    )))]
    pub(super) struct StepTable {
        /// Name of the object to pick.
        pick: Option<Spanned<String>>,
        /// Where to place the carried object.
        #[cfg_attr(test, schemars(with = "Option<PlaceTable>"))]
        place: Option<Table<PlaceTable>>,
        /// Goal of a motion, with or without a carried object.
        #[cfg_attr(test, schemars(with = "Option<GoalTable>"))]
        r#move: Option<Spanned<Table<GoalTable>>>,
        /// A line for the tip, with or without a carried object. It counts as two steps: a move to the beginning of the
        /// line, and the line.
        #[cfg_attr(test, schemars(with = "Option<LineTable>"))]
        follow: Option<Spanned<Table<LineTable>>>,
        /// Picks and places that move all objects on a pallet to the places of another, one after the other.
        #[cfg_attr(test, schemars(with = "Option<TransferTable>"))]
        transfer: Option<Table<TransferTable>>,
        /// A group of steps. The speed and dwell of the group are the defaults for its steps.
        #[cfg_attr(test, schemars(length(min = 1)))]
        steps: Option<Vec<Spanned<StepTable>>>,
        /// For a pick: the point of the object to which the tip moves, in the object's frame, m; by default the `grasp` of the object.
        #[cfg_attr(test, schemars(with = "Option<LengthPair>"))]
        grasp: Option<Lengths>,
        /// For a pick: obstacles and objects that the object may touch; by default the `supports` of the object.
        supports: Option<NameList>,
        /// For a pick: side of the elbow, seen from joint 1 towards the tip; by default either.
        #[cfg_attr(test, schemars(with = "Option<ElbowSide>"))]
        elbow: Option<Spanned<String>>,
        /// For the pick of a moving object: position of its origin at the pick, m; by default its position at the
        /// earliest possible pick.
        #[cfg_attr(test, schemars(with = "Option<LengthPair>"))]
        at: Option<Lengths>,
        /// For the pick of a moving object: the earliest and the latest time of the pick, s; by default any time.
        #[cfg_attr(test, schemars(with = "Option<NumberPair>"))]
        window: Option<Numbers>,
        /// For a group: number of repetitions of its steps.
        #[cfg_attr(test, schemars(range(min = 1)))]
        repeat: Option<Spanned<i64>>,
        /// For a group of picks and places: "free" lets cplan choose the fastest order of the pairs; by default
        /// "fixed".
        #[cfg_attr(test, schemars(with = "Option<DoneIn>"))]
        order: Option<Spanned<String>>,
        /// Share of the joints' top speeds, above 0 and at most 1; by default 1.
        #[cfg_attr(test, schemars(with = "Option<Share>"))]
        speed: Option<Number>,
        /// Time for which the arm stands still at the end, s; by default 0.
        #[cfg_attr(test, schemars(with = "Option<NotNegative>"))]
        dwell: Option<Number>,
    }
}

impl StepTable {
    /// Returns the number of actions that the table states.
    fn actions(&self) -> usize {
        let given = [
            self.pick.is_some(),
            self.place.is_some(),
            self.r#move.is_some(),
            self.follow.is_some(),
            self.transfer.is_some(),
            self.steps.is_some(),
        ];
        given.into_iter().filter(|given| *given).count()
    }
}

toml_table! {
    /// A place for an object: a point, or a place of a pallet.
    #[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields, rename = "place", extend("oneOf" = [{ "required": ["at"] }, { "required": ["on"] }])))]
    struct PlaceTable {
        /// Position for the object's origin, m.
        #[cfg_attr(test, schemars(with = "Option<LengthPair>"))]
        at: Option<Lengths>,
        /// Place of a pallet for the object's origin: "NAME 2,3".
        on: Option<Spanned<String>>,
        /// Angle of a level payload at this place, rad; by default unchanged.
        angle: Option<Written>,
        /// Obstacles and objects that the object may touch at this place; by default the `supports` of the object.
        supports: Option<NameList>,
        /// Height of the object's bottom at this place, along the plane's normal, m; by default the height of the
        /// pallet, or else the height at which the object was picked.
        height: Option<Length>,
        /// Side of the elbow at this place, seen from joint 1 towards the tip; by default either.
        #[cfg_attr(test, schemars(with = "Option<ElbowSide>"))]
        elbow: Option<Spanned<String>>,
    }

    /// Moves all objects from one pallet to another, row by row: the first object to the first place, and so on.
    #[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields, rename = "transfer"))]
    struct TransferTable {
        /// Name of the objects, without row and column.
        objects: Spanned<String>,
        /// Name of the pallet to which they are moved. It must have as many places as there are objects.
        to: Spanned<String>,
        /// Angle of level payloads at the places, rad; by default unchanged.
        angle: Option<Written>,
        /// Obstacles and objects that the moved objects may touch at their new places; by default the `supports` of the
        /// objects.
        supports: Option<NameList>,
        /// Side of the elbow at all picks and places, seen from joint 1 towards the tip; by default either.
        #[cfg_attr(test, schemars(with = "Option<ElbowSide>"))]
        elbow: Option<Spanned<String>>,
    }

    /// Settings that apply to all steps.
    #[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields, rename = "task"))]
    pub(super) struct TaskTable {
        /// Number of repetitions of the steps; by default one.
        #[cfg_attr(test, schemars(range(min = 1)))]
        repeat: Option<Spanned<i64>>,
        /// For picks and places: "free" lets cplan choose the fastest order of the pairs; by default "fixed".
        #[cfg_attr(test, schemars(with = "Option<DoneIn>"))]
        order: Option<Spanned<String>>,
        /// Share of the joints' top speeds, above 0 and at most 1; by default 1.
        #[cfg_attr(test, schemars(with = "Option<Share>"))]
        speed: Option<Number>,
        /// Time for which the arm stands still at the end of each step, s; by default 0.
        #[cfg_attr(test, schemars(with = "Option<NotNegative>"))]
        dwell: Option<Number>,
    }
}

/// Largest number of steps of a task, with repetitions counted. A robot would need days for them.
const MAX_STEPS: usize = 100_000;

/// The coordinates of a line's start are rounded to multiples of this, in metres. It exceeds the rounding errors of arcs, and is
/// far below all tolerances.
const PICOMETRE: f64 = 1e-12;

/// Speed and dwell of steps that state none.
#[derive(Clone, Copy)]
struct Pace {
    speed: f64,
    dwell: f64,
}

/// The keys of a group, except its steps.
struct Manner<'a> {
    repeat: Option<&'a Spanned<i64>>,
    order: Option<&'a Spanned<String>>,
}

/// Reads the tables of steps.
pub(super) struct StepReader<'a> {
    reader: &'a Reader<'a>,
    pallets: &'a Pallets<'a>,
    names: &'a Names<'a>,
    objects: &'a [MovableObject],
    cursor: Cursor<'a>,
    file: String,
    /// Number of steps that have been read.
    count: usize,
}

impl<'a> StepReader<'a> {
    pub fn new(
        reader: &'a Reader<'a>,
        pallets: &'a Pallets<'a>,
        names: &'a Names<'a>,
        objects: &'a [MovableObject],
    ) -> Self {
        Self { reader, pallets, names, objects, cursor: reader.source.cursor(), file: reader.source.name(), count: 0 }
    }

    /// Returns all steps of the file, at least one.
    ///
    /// # Errors
    /// Steps without exactly one action; misplaced keys; invalid values; unknown objects and supports; groups in free order that
    /// contain other actions than picks and places; more than [`MAX_STEPS`] steps.
    pub fn all(mut self, tables: &[Spanned<StepTable>], task: Option<&TaskTable>) -> Result<Group, Diagnostic> {
        let pace = Pace { speed: 1.0, dwell: 0.0 };
        let pace = task.map_or(Ok(pace), |t| self.read_pace(pace, t.speed.as_ref(), t.dwell.as_ref()))?;
        let manner =
            Manner { repeat: task.and_then(|t| t.repeat.as_ref()), order: task.and_then(|t| t.order.as_ref()) };
        let at = tables.first().map_or(0..0, Spanned::span);
        self.group(tables, &manner, pace, at)
    }

    fn group(
        &mut self,
        tables: &[Spanned<StepTable>],
        manner: &Manner,
        pace: Pace,
        at: Range<usize>,
    ) -> Result<Group, Diagnostic> {
        let source = self.reader.source;
        if tables.is_empty() {
            let diagnostic = source.diagnostic_at(at, "this group has no steps");
            return Err(diagnostic.help("give it [[step.steps]], or remove it"));
        }
        let repeat = manner.repeat.map_or(Ok(1), |repeat| {
            usize::try_from(*repeat.get_ref()).ok().filter(|n| *n > 0).ok_or_else(|| {
                let message = format!("`repeat` must be 1 or more, is {}", repeat.get_ref());
                source.diagnostic_at(repeat.span(), message).help("remove the key if the steps are not repeated")
            })
        })?;
        let nodes = tables.iter().map(|table| self.nodes(table, pace)).collect::<Result<Vec<_>, _>>()?;
        let nodes: Vec<Node> = nodes.into_iter().flatten().collect();
        let at = manner.repeat.map_or(at, Spanned::span);
        let length = nodes.iter().map(Node::length).fold(0, usize::saturating_add).saturating_mul(repeat);
        if length > MAX_STEPS {
            let message = format!("the repetitions make {length} steps (at most {MAX_STEPS})");
            return Err(source.diagnostic_at(at, message).help("repeat them less often"));
        }
        let renewed = nodes.iter().flat_map(|node| self.renewed(node)).collect();
        let body = match manner.order.map(|order| (order.get_ref().as_str(), order.span())) {
            None | Some(("fixed", _)) => Body::InOrder(nodes),
            Some(("free", _)) => Body::AnyOrder(self.pairs(nodes)?),
            Some((other, at)) => {
                let message = format!("an order is \"fixed\" or \"free\", not \"{other}\"");
                return Err(source.diagnostic_at(at, message).help("order = \"free\", or leave it out"));
            }
        };
        Ok(Group { body, repeat, at, renewed, length })
    }

    fn renewed(&self, node: &Node) -> Vec<usize> {
        match node {
            Node::Step(Leaf { action: LeafAction::Pick { object, .. }, .. }) if self.objects[*object].is_renewed => {
                vec![*object]
            }
            Node::Step(_) => Vec::new(),
            Node::Group(group) => group.renewed.iter().copied().collect(),
        }
    }

    /// Returns the pairs of pick and place of a group in free order.
    fn pairs(&self, nodes: Vec<Node>) -> Result<Vec<[Leaf; 2]>, Diagnostic> {
        let source = self.reader.source;
        let help = "a group in free order has the steps pick, place, pick, place, and so on; put other steps before or after the group";
        let mut picked = BTreeSet::new();
        let mut pairs = Vec::new();
        let mut nodes = nodes.into_iter();
        while let Some(first) = nodes.next() {
            let pick = match first {
                Node::Step(pick @ Leaf { action: LeafAction::Pick { .. }, .. }) => pick,
                other => return Err(source.diagnostic_at(other.at(), "this step must be a pick").help(help)),
            };
            let place = match nodes.next() {
                Some(Node::Step(place @ Leaf { action: LeafAction::Place { .. }, .. })) => place,
                Some(other) => return Err(source.diagnostic_at(other.at(), "this step must be a place").help(help)),
                None => return Err(source.diagnostic_at(pick.at, "this pick has no place after it").help(help)),
            };
            if let LeafAction::Pick { object, .. } = pick.action
                && !picked.insert(object)
            {
                let name = &self.objects[object].object.name;
                let message = format!("object \"{name}\" is picked twice in a group in free order");
                return Err(source.diagnostic_at(pick.at, message).help("pick it once, or use a group in fixed order"));
            }
            pairs.push([pick, place]);
        }
        Ok(pairs)
    }

    /// Returns the contents of a table: a step, a group, or the steps of a transfer.
    fn nodes(&mut self, table: &Spanned<StepTable>, pace: Pace) -> Result<Vec<Node>, Diagnostic> {
        let step = table.get_ref();
        let pace = self.read_pace(pace, step.speed.as_ref(), step.dwell.as_ref())?;
        self.require_fitting_keys(step)?;
        let one = |at, action| Ok(vec![(at, action)]);
        let wrong_count = || {
            let message = format!(
                "a step needs exactly one of `pick`, `place`, `move`, `follow`, `transfer` and `steps`, but has {}",
                step.actions()
            );
            let help = "pick = \"NAME\", place = { at = [x, y] }, move = { joints = [q1, q2] }, \
                        follow = { points = [[x, y], [x, y]] }, transfer = { objects = \"NAME\", to = \"PALLET\" }, \
                        or [[step.steps]]";
            self.reader.source.diagnostic_at(table.span(), message).help(help)
        };
        if step.actions() != 1 {
            return Err(wrong_count());
        }
        if let Some(follow) = &step.follow {
            return self.follow(follow, pace, table.span());
        }
        let actions = match (&step.pick, &step.place, &step.r#move, &step.transfer, &step.steps) {
            (None, None, None, None, Some(steps)) => {
                let manner = Manner { repeat: step.repeat.as_ref(), order: step.order.as_ref() };
                return self.group(steps, &manner, pace, table.span()).map(|group| vec![Node::Group(group)]);
            }
            (Some(name), None, None, None, None) => one(name.span(), self.pick(step, name)?),
            (None, Some(Table(place)), None, None, None) => {
                self.place(place, table.span()).and_then(|(at, a)| one(at, a))
            }
            (None, None, Some(goal), None, None) => {
                let (goal, at) = self.reader.goal(&goal.get_ref().0, goal.span(), "move")?;
                one(at, LeafAction::Move(goal))
            }
            (None, None, None, Some(Table(transfer)), None) => self.transfer(transfer),
            _ => return Err(wrong_count()),
        }?;
        let of_place = step.place.as_ref().and_then(|Table(place)| place.elbow.as_ref());
        let of_transfer = step.transfer.as_ref().and_then(|Table(transfer)| transfer.elbow.as_ref());
        let elbow = self.reader.elbow(step.elbow.as_ref().or(of_place).or(of_transfer))?;
        let leaves = actions.into_iter().map(|(at, action)| self.leaf(at, (action, elbow), pace, table.span()));
        Ok(leaves.collect())
    }

    /// Returns the next step. `at` is the position of its target in the file, `table` that of its table.
    fn leaf(
        &mut self,
        at: Range<usize>,
        (action, elbow): (LeafAction, Option<Elbow>),
        pace: Pace,
        table: Range<usize>,
    ) -> Node {
        let position = self.cursor.position(table.start);
        let place = format!("{}:{}:{}", self.file, position.line, position.column);
        self.count += 1;
        let (speed, dwell) = (pace.speed, pace.dwell);
        Node::Step(Leaf { number: self.count, place, at, action, speed, dwell, tool: ToolValues::default(), elbow })
    }

    /// Returns the two steps of a line: a move to the beginning of the line, and the line itself.
    fn follow(
        &mut self,
        follow: &Spanned<Table<LineTable>>,
        pace: Pace,
        table: Range<usize>,
    ) -> Result<Vec<Node>, Diagnostic> {
        let line = follow.get_ref().0.read(self.reader, follow.span())?;
        let start = line.path.start().map(|x| (x / PICOMETRE).round() * PICOMETRE);
        let begin = line.elbow.map_or(Goal::Tip(start.into()), |elbow| Goal::TipAndElbow(start.into(), elbow));
        let begin = (LeafAction::Move(begin), None);
        let to_line = self.leaf(follow.span(), begin, Pace { dwell: 0.0, ..pace }, table.clone());
        Ok(vec![to_line, self.leaf(follow.span(), (LeafAction::Follow(line), None), pace, table)])
    }

    /// Checks that all keys of a step apply to its action.
    fn require_fitting_keys(&self, step: &StepTable) -> Result<(), Diagnostic> {
        let refuse = |at: Option<Range<usize>>, message: &str, help: &str| match at {
            Some(at) => Err(self.reader.source.diagnostic_at(at, message).help(help)),
            None => Ok(()),
        };
        if step.pick.is_none() {
            let at = step.grasp.as_ref().map(Spanned::span);
            refuse(at, "only a pick has a `grasp`", "remove the key")?;
            let at = step.at.as_ref().map(Spanned::span).or(step.window.as_ref().map(Spanned::span));
            refuse(
                at,
                "only a pick has `at` and `window`",
                "remove the key; a place has the form place = { at = [x, y] }",
            )?;
            let at = step.supports.as_ref().map(Spanned::span);
            let help = "remove the key; a place has the form place = { at = [x, y], supports = [\"NAME\"] }";
            refuse(at, "only a pick has `supports`", help)?;
            let at = step.elbow.as_ref().map(Spanned::span);
            let help = "write `elbow` into the table of the step: place = { at = [x, y], elbow = \"left\" }, move = { tip = [x, y], elbow = \"left\" }; likewise for follow and transfer";
            refuse(at, "only a pick has `elbow` beside it", help)?;
        }
        if step.steps.is_none() {
            let help = "write a group: [[step]] with this key, then [[step.steps]] for each step of the group";
            refuse(step.repeat.as_ref().map(Spanned::span), "only a group of steps can be repeated", help)?;
            refuse(step.order.as_ref().map(Spanned::span), "only a group of steps has an `order`", help)?;
        }
        Ok(())
    }

    fn pick(&self, step: &StepTable, name: &Spanned<String>) -> Result<LeafAction, Diagnostic> {
        let object = self.names.object(self.reader, name)?;
        let default = &self.objects[object];
        let grasp = step.grasp.as_ref().map(|g| self.reader.point(g, "grasp")).transpose()?;
        let supports = step.supports.as_ref().map(|s| self.names.supports(self.reader, s)).transpose()?;
        Ok(LeafAction::Pick {
            object,
            grasp: grasp.unwrap_or(default.grasp),
            supports: supports.unwrap_or_else(|| default.supports.clone()),
            when: PickTimes { at: step.at.as_ref(), window: step.window.as_ref() }
                .read(self.reader, &default.object)?,
        })
    }

    /// Returns the action of placing an object, with the position of its target in the file. `at` is the position of
    /// the step.
    fn place(&self, place: &PlaceTable, at: Range<usize>) -> Result<(Range<usize>, LeafAction), Diagnostic> {
        let ((to, of_pallet), stated) = match (&place.at, &place.on) {
            (Some(at), None) => ((self.reader.point(at, "place, at")?, None), at.span()),
            (None, Some(name)) => (self.pallets.place(self.reader, name)?, name.span()),
            (point, _) => {
                let found = if point.is_some() { "both" } else { "neither" };
                let message = format!("a place needs either `at` or `on`, but has {found}");
                let help = "place = { at = [x, y] }, or place = { on = \"PALLET 1,1\" }";
                return Err(self.reader.source.diagnostic_at(at, message).help(help));
            }
        };
        let angle = self.angle(place.angle.as_ref())?;
        let supports = place.supports.as_ref().map(|s| self.names.supports(self.reader, s)).transpose()?;
        let height = place.height.as_ref().map(|h| self.reader.source.finite(h, "place, height")).transpose()?;
        Ok((stated, LeafAction::Place { at: to, angle, supports, height: height.or(of_pallet) }))
    }

    fn angle(&self, angle: Option<&Written>) -> Result<Option<(f64, Range<usize>)>, Diagnostic> {
        angle.map(|angle| Ok((self.reader.quantity(angle, "place, angle")?, angle.span()))).transpose()
    }

    /// Returns the steps of a transfer, each with its position in the file.
    fn transfer(&self, transfer: &TransferTable) -> Result<Vec<(Range<usize>, LeafAction)>, Diagnostic> {
        let TransferTable { objects, to, .. } = transfer;
        let family = self.names.family(self.reader, objects)?;
        let pallet = self.pallets.named(self.reader, to)?;
        if family.len() != pallet.count() {
            let (count, places) = (family.len(), pallet.count());
            let message = format!(
                "the numbers differ: there are {count} objects \"{}\", but pallet \"{}\" has {places} places",
                objects.get_ref(),
                to.get_ref()
            );
            let help = "give the pallet one place for each object, or pick and place the objects one by one";
            return Err(self.reader.source.diagnostic_at(to.span(), message).help(help));
        }
        let angle = self.angle(transfer.angle.as_ref())?;
        let supports = transfer.supports.as_ref().map(|s| self.names.supports(self.reader, s)).transpose()?;
        let pair = |(object, (_, pose)): (usize, (String, Pose))| {
            let MovableObject { grasp, supports: resting, .. } = &self.objects[object];
            let pick = LeafAction::Pick { object, grasp: *grasp, supports: resting.clone(), when: None };
            let (angle, supports, height) = (angle.clone(), supports.clone(), pallet.height);
            let place = LeafAction::Place { at: pose.translation, angle, supports, height };
            [(objects.span(), pick), (to.span(), place)]
        };
        Ok(family.zip(pallet.places()).flat_map(pair).collect())
    }

    fn read_pace(&self, default: Pace, speed: Option<&Number>, dwell: Option<&Number>) -> Result<Pace, Diagnostic> {
        let mut pace = default;
        if let Some(number) = speed {
            pace.speed = self.reader.source.finite(number, "speed")?;
            if !(pace.speed > 0.0 && pace.speed <= 1.0) {
                let message = format!("speed must be greater than 0 and at most 1, is {}", pace.speed);
                let help = "write a fraction of the joints' top speeds";
                return Err(self.reader.source.diagnostic_at(number.span(), message).help(help));
            }
        }
        if let Some(number) = dwell {
            pace.dwell = self.reader.not_negative(number, "dwell")?;
        }
        Ok(pace)
    }
}
