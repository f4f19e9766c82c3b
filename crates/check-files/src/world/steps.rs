//! Reads objects, pallets and steps of the world file.

use super::task::{Action, Arch, Group, MovingPick, Node, Object, Step, Stroke, Task, Wrist};
use super::{ReadResult, Reader, TOOL_KEYS, Value};
use cplan_check::decimal::Decimal;
use cplan_check::interval::{Interval, Point, both_turns, sum, turned};
use cplan_check::obstacle::{Obstacle, point};
use cplan_check::polygon::Corner;
use cplan_check::world::World;
use num_bigint::Sign;
use std::collections::{BTreeMap, BTreeSet};
use toml::de::{DeTable, DeValue};

/// Maximum number of places on a pallet.
const MAX_PLACES: usize = 10_000;

/// A pallet: places in rows and columns.
struct Pallet {
    /// For each place, its row and column as they appear in names, and its position.
    places: Vec<(String, Point)>,
    turn: Point,
    /// Height of its places, metres.
    height: Option<Decimal>,
}

/// Everything to which steps can refer.
struct Steps<'r, 'w> {
    reader: &'r Reader<'r>,
    world: &'w World,
    first: usize,
    objects: &'w [Object],
    pallets: &'w BTreeMap<String, Pallet>,
    count: usize,
}

impl Reader<'_> {
    /// Reads the objects and the steps of a world. Returns `None` if the world has no steps.
    pub(super) fn task(&self, table: &DeTable, world: &mut World) -> ReadResult<Option<Task>> {
        let list = |key: &str| table.get(key).map_or(Ok(Vec::new()), |value| self.list(value));
        let mut pallets = BTreeMap::new();
        for value in list("pallet")? {
            let (name, pallet) = self.pallet(value)?;
            if pallets.insert(name, pallet).is_some() {
                return self.error(value, "two pallets have this name");
            }
        }
        let robot = table.get("robot").map_or(Ok(None), |robot| self.table(robot).map(Some))?;
        let own = |key: &str| robot.and_then(|robot| robot.get(key));
        let is_level = own("payload").map_or(Ok(false), |value| self.is_level(value))?;
        let first = world.obstacles.len();
        let mut taken: BTreeSet<String> = world.all().filter_map(|obstacle| obstacle.name.clone()).collect();
        let mut objects = Vec::new();
        // An object may come earlier in the file than its supports.
        let mut resting = Vec::new();
        for value in list("object")? {
            let of_family = self.object(value, is_level, &pallets, &mut objects)?;
            let family = objects.last().map(|object: &Object| object.family.clone());
            let own: BTreeSet<String> = of_family.iter().filter_map(|one| one.name.clone()).chain(family).collect();
            if own.len() < of_family.len() || own.iter().any(|name| !taken.insert(name.clone())) {
                return self.error(value, "another object or obstacle has this name");
            }
            for obstacle in of_family {
                resting.push(self.table(value)?.get("supports"));
                world.obstacles.push(obstacle);
            }
        }
        for (object, supports) in resting.into_iter().enumerate() {
            if let Some(list) = supports {
                objects[object].supports = self.supports(list, world, first, &objects)?;
            }
        }
        let lowered = [self.lowered(table, "start")?, self.lowered(table, "goal")?];
        let moves_tool = |end: &&str| {
            let keys = table.get(*end).and_then(|end| end.get_ref().as_table());
            keys.is_some_and(|keys| TOOL_KEYS.iter().any(|key| keys.contains_key(*key)))
        };
        let no_steps = match table.get("step") {
            None if ["start", "goal"].iter().any(moves_tool) => Some(world.goal.clone()),
            None => return Ok(None),
            Some(_) => None,
        };
        let manner = table.get("task").map_or(Ok(None), |task| self.table(task).map(Some))?;
        let mut reading = Steps { reader: self, world, first, objects: &objects, pallets: &pallets, count: 0 };
        let dwell = manner.and_then(|task| task.get("dwell"));
        let dwell = dwell.map_or(Ok(Decimal::whole(0)), |dwell| self.number(dwell))?;
        let unknown =
            manner.and_then(|task| task.iter().find(|(key, _)| !SHARED_STEP_KEYS.contains(&&**key.get_ref())));
        if let Some((key, value)) = unknown {
            return self.error(value, &format!("the checker does not know [task] {}", key.get_ref()));
        }
        let is_move = no_steps.is_some();
        let steps = match (no_steps, table.get("step")) {
            (Some(goal), _) => Group::single(goal),
            (None, Some(steps)) => reading.group(steps, manner, &dwell)?,
            (None, None) => return Ok(None),
        };
        let stroke = own("stroke").map(|value| self.stroke(value, own("arch"))).transpose()?;
        let switch = own("arch").map(|arch| arch.get_ref().as_bool());
        if let (None, Some(arch), true) = (&stroke, own("arch"), own("wrist").is_none() || switch == Some(None)) {
            return self.error(arch, "[robot] arch needs a joint that lowers the tool");
        }
        let turns_on_the_way = switch != Some(Some(false));
        let joint = |value| self.table(value)?.get("joint").map(|name| self.text(name)).transpose();
        let wrist = own("wrist").map(|value| Ok(Wrist { joint: joint(value)?, turns_on_the_way })).transpose()?;
        Ok(Some(Task { first, objects, steps, wrist, stroke, is_move, lowered }))
    }

    /// Reads the value of the stroke's joint at an end of the motion.
    fn lowered(&self, table: &DeTable, end: &str) -> ReadResult<Option<Decimal>> {
        let Some(end) = table.get(end) else { return Ok(None) };
        self.table(end)?.get("stroke").map(|value| self.length(value)).transpose()
    }

    /// Reads a whole number from 1 on.
    fn count(&self, value: &Value) -> ReadResult<usize> {
        let count = match value.get_ref() {
            DeValue::Integer(_) => self.number(value)?.to_string().parse().ok(),
            _ => None,
        };
        count.filter(|count| *count > 0).map_or_else(|| self.error(value, "expected a whole number of at least 1"), Ok)
    }

    fn is_level(&self, value: &Value) -> ReadResult<bool> {
        match &*self.text(value)? {
            "level" => Ok(true),
            "rigid" => Ok(false),
            _ => self.error(value, "a payload must be \"rigid\" or \"level\""),
        }
    }

    fn stroke(&self, value: &Value, arch: Option<&Value>) -> ReadResult<Stroke> {
        let table = self.table(value)?;
        let Some(joint) = table.get("joint") else { return self.error(value, "a stroke needs a joint") };
        let travel = table.get("travel").map(|n| self.length(n)).transpose()?;
        Ok(Stroke { joint: self.text(joint)?, travel, arch: self.arch(arch)? })
    }

    /// Reads the least heights for strokes during motions. `None` if the arm must rest during strokes.
    fn arch(&self, value: Option<&Value>) -> ReadResult<Option<Arch>> {
        let mut arch = Arch { rise: Decimal::whole(0), fall: Decimal::whole(0) };
        let Some(value) = value else { return Ok(Some(arch)) };
        if let Some(is_allowed) = value.get_ref().as_bool() {
            return Ok(is_allowed.then_some(arch));
        }
        for (key, value) in self.table(value)? {
            let height = match &**key.get_ref() {
                "rise" => &mut arch.rise,
                "fall" => &mut arch.fall,
                other => {
                    return self.error(value, &format!("the checker does not know the key {other} of [robot] arch"));
                }
            };
            *height = self.length(value)?;
            if height.sign() == Sign::Minus {
                return self.error(value, "the height of an arch is negative");
            }
        }
        Ok(Some(arch))
    }

    fn pallet(&self, value: &Value) -> ReadResult<(String, Pallet)> {
        let table = self.table(value)?;
        let (Some(name), Some(rows), Some(columns), Some(pitch), Some(at)) =
            (table.get("name"), table.get("rows"), table.get("columns"), table.get("pitch"), table.get("at"))
        else {
            return self.error(value, "a pallet needs a name, rows, columns, a pitch and a place");
        };
        let [rows, columns] = [self.count(rows)?, self.count(columns)?];
        if rows.saturating_mul(columns) > MAX_PLACES {
            return self.error(value, "the pallet has too many places");
        }
        let (pitch, at) = (self.pair(pitch, |n| self.length(n))?, point(&self.pair(at, |n| self.length(n))?));
        let turn =
            table.get("angle").map_or(Ok(Interval::whole(0)), |a| Ok(Interval::enclosing(&self.quantity(a)?)))?;
        let turn = turn.sin_cos();
        let place = |row: usize, column: usize| {
            let by = [(column, &pitch[0]), (row, &pitch[1])];
            let by = by.map(|(count, pitch)| Interval::from(&(pitch * &Decimal::whole(count as i32))));
            (format!("{},{}", row + 1, column + 1), sum(&at, &turned(&by, &turn)))
        };
        let places = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
        let places = places.map(|(row, column)| place(row, column)).collect();
        let height = table.get("height").map(|height| self.length(height)).transpose()?;
        Ok((self.text(name)?, Pallet { places, turn, height }))
    }

    /// Reads an object, or one object for each place of a pallet. Adds them to `objects`. Returns them as obstacles at
    /// their initial poses.
    fn object(
        &self,
        value: &Value,
        is_level: bool,
        pallets: &BTreeMap<String, Pallet>,
        objects: &mut Vec<Object>,
    ) -> ReadResult<Vec<Obstacle>> {
        let (table, lying) = (self.table(value)?, self.obstacle(value, true)?);
        let Some(family) = lying.name.clone() else { return self.error(value, "an object needs a name") };
        let lift = table.get("lift").map(|value| self.length(value)).transpose()?;
        let grasp = table.get("grasp").map(|grasp| self.pair(grasp, |n| self.length(n))).transpose()?;
        let is_level = table.get("payload").map_or(Ok(is_level), |value| self.is_level(value))?;
        let renews = table.get("renew").is_some_and(|value| value.get_ref().as_bool() == Some(true));
        let zero = Decimal::whole(0);
        let (lift, grasp) = (lift.unwrap_or(zero.clone()), grasp.unwrap_or([zero.clone(), zero]));
        let places: Vec<Obstacle> = match (table.get("pallet"), table.get("at")) {
            (None, Some(_)) => vec![lying],
            (None, None) if lying.trajectory.is_some() => vec![lying],
            (Some(pallet), None) if lying.trajectory.is_none() => {
                let Some(Pallet { places, turn, .. }) = pallets.get(&self.text(pallet)?) else {
                    return self.error(pallet, "there is no pallet of this name");
                };
                let turn = both_turns(turn, &lying.turn);
                let on = |(place, at): &(String, Point)| Obstacle {
                    trajectory: None,
                    name: Some(format!("{family} {place}")),
                    at: at.clone(),
                    turn: turn.clone(),
                    ..lying.clone()
                };
                places.iter().map(on).collect()
            }
            _ => return self.error(value, "an object needs either `at` or `pallet`"),
        };
        objects.extend(places.iter().map(|_| Object {
            family: family.clone(),
            lift: lift.clone(),
            is_level,
            grasp: grasp.clone(),
            supports: Vec::new(),
            renews,
        }));
        Ok(places)
    }

    /// Returns the indices of the named obstacles and objects. The name of a pallet's objects stands for all of them.
    fn supports(&self, list: &Value, world: &World, first: usize, objects: &[Object]) -> ReadResult<Vec<usize>> {
        let mut all = Vec::new();
        for value in self.list(list)? {
            let (name, before) = (self.text(value)?, all.len());
            let is_named = |(number, obstacle): &(usize, &Obstacle)| {
                let family = objects.get(number.wrapping_sub(first)).map(|object| &object.family);
                [obstacle.name.as_ref(), family].contains(&Some(&name))
            };
            all.extend(world.obstacles.iter().enumerate().filter(is_named).map(|(number, _)| number));
            if all.len() == before {
                return self.error(value, "there is no obstacle and no object of this name");
            }
        }
        Ok(all)
    }
}

/// Keys that apply to several steps.
const SHARED_STEP_KEYS: [&str; 4] = ["repeat", "order", "speed", "dwell"];

impl Steps<'_, '_> {
    /// Reads a list of steps as one group. The table `manner` states its repetitions and order.
    fn group(&mut self, list: &Value, manner: Option<&DeTable>, dwell: &Decimal) -> ReadResult<Group> {
        let reader = self.reader;
        let mut nodes = Vec::new();
        for value in reader.list(list)? {
            nodes.extend(self.nodes(value, dwell)?);
        }
        if nodes.is_empty() {
            return reader.error(list, "there are no steps");
        }
        let of = |key: &str| manner.and_then(|table| table.get(key));
        let repeat = of("repeat").map_or(Ok(1), |value| reader.count(value))?;
        let is_free = match of("order").map(|value| reader.text(value)).transpose()?.as_deref() {
            None | Some("fixed") => false,
            Some("free") => true,
            _ => return reader.error(list, "an order must be \"free\" or \"fixed\""),
        };
        let is_pair = |pair: &[Node]| {
            let [Node::Step(first), Node::Step(second)] = pair else { return false };
            matches!((&first.action, &second.action), (Action::Pick { .. }, Action::Place { .. }))
        };
        if is_free && !nodes.chunks(2).all(is_pair) {
            return reader.error(list, "steps in free order must be pick, place, pick, place, and so on");
        }
        let mut renewed = Vec::new();
        for node in &nodes {
            match node {
                Node::Step(step) => match step.action {
                    Action::Pick { object, .. } if self.objects[object].renews => renewed.push(object),
                    _ => {}
                },
                Node::Group(group) => renewed.extend(&group.renewed),
            }
        }
        // A group of a single pair has only one order.
        Ok(Group { is_free: is_free && nodes.len() > 2, nodes, repeat, renewed })
    }

    /// Reads a table: a step, a group, or the steps of a transfer.
    fn nodes(&mut self, value: &Value, dwell: &Decimal) -> ReadResult<Vec<Node>> {
        let reader = self.reader;
        let table = reader.table(value)?;
        let dwell = table.get("dwell").map_or(Ok(dwell.clone()), |value| reader.number(value))?;
        let known =
            ["pick", "place", "move", "follow", "transfer", "steps", "grasp", "supports", "at", "window", "elbow"];
        let is_known = |key: &str| known.contains(&key) || SHARED_STEP_KEYS.contains(&key);
        if let Some((key, _)) = table.iter().find(|(key, _)| !is_known(key.get_ref())) {
            return reader.error(value, &format!("the checker does not know the key {} of a step", key.get_ref()));
        }
        let given: Vec<&str> = known[..6].iter().copied().filter(|key| table.get(*key).is_some()).collect();
        let [what] = given[..] else { return reader.error(value, "a step needs exactly one action") };
        if what != "pick" && (table.contains_key("at") || table.contains_key("window")) {
            return reader.error(value, "only a pick has `at` and `window`");
        }
        if what != "pick" && table.contains_key("elbow") {
            return reader.error(value, "only a pick has `elbow` beside it");
        }
        let of = &table[what];
        let actions = match what {
            "steps" => return Ok(vec![Node::Group(self.group(of, Some(table), &dwell)?)]),
            "pick" => {
                let named = Some(reader.text(of)?);
                let object = self.world.obstacles[self.first..].iter().position(|object| object.name == named);
                let Some(object) = object else { return reader.error(of, "there is no object of this name") };
                let grasp = table.get("grasp").map(|grasp| reader.pair(grasp, |n| reader.length(n))).transpose()?;
                let passing = MovingPick {
                    window: table.get("window").map(|w| reader.pair(w, |n| reader.number(n))).transpose()?,
                    at: table.get("at").map(|at| Ok(point(&reader.pair(at, |n| reader.length(n))?))).transpose()?,
                };
                vec![self.pick(object, grasp, self.supports(table)?, passing)]
            }
            "place" => vec![self.place(of)?],
            "move" => vec![Action::Move(reader.place(of)?)],
            "follow" => vec![Action::MoveToLine, Action::Follow(reader.line(of)?)],
            _ => self.transfer(of)?,
        };
        let elbow = match what {
            "pick" => reader.elbow(table)?,
            "place" | "transfer" => reader.elbow(reader.table(of)?)?,
            _ => None,
        };
        let step = |action| {
            self.count += 1;
            // The arm need not rest before it follows a line.
            let dwell = if matches!(action, Action::MoveToLine) { Decimal::whole(0) } else { dwell.clone() };
            Node::Step(Box::new(Step { number: self.count, action, dwell, elbow }))
        };
        Ok(actions.into_iter().map(step).collect())
    }

    fn pick(&self, object: usize, grasp: Option<Corner>, supports: Option<Vec<usize>>, passing: MovingPick) -> Action {
        let own = &self.objects[object];
        let (grasp, supports) = (grasp.unwrap_or(own.grasp.clone()), supports.unwrap_or(own.supports.clone()));
        Action::Pick { object, grasp, supports, passing: Box::new(passing) }
    }

    fn supports(&self, table: &DeTable) -> ReadResult<Option<Vec<usize>>> {
        let list = table.get("supports");
        list.map(|list| self.reader.supports(list, self.world, self.first, self.objects)).transpose()
    }

    fn angle(&self, table: &DeTable) -> ReadResult<Option<Interval>> {
        table.get("angle").map(|angle| Ok(Interval::enclosing(&self.reader.quantity(angle)?))).transpose()
    }

    fn place(&self, value: &Value) -> ReadResult<Action> {
        let (reader, table) = (self.reader, self.reader.table(value)?);
        let (at, of_pallet) = match (table.get("at"), table.get("on")) {
            (Some(at), None) => (point(&reader.pair(at, |n| reader.length(n))?), None),
            (None, Some(on)) => {
                let wanted = reader.text(on)?;
                let mut places =
                    self.pallets.iter().flat_map(|named| named.1.places.iter().map(move |place| (named, place)));
                let found = places.find(|((name, _), (place, _))| wanted == format!("{name} {place}"));
                let Some(((_, pallet), (_, at))) = found else { return reader.error(on, "no pallet has this place") };
                (at.clone(), pallet.height.clone())
            }
            _ => return reader.error(value, "a place needs either `at` or `on`"),
        };
        let height = table.get("height").map(|height| reader.length(height)).transpose()?.or(of_pallet);
        Ok(Action::Place { at, angle: self.angle(table)?, supports: self.supports(table)?, height })
    }

    /// Reads a transfer: returns pairs of a pick and a place, one for each object of a pallet.
    fn transfer(&self, value: &Value) -> ReadResult<Vec<Action>> {
        let (reader, table) = (self.reader, self.reader.table(value)?);
        let (Some(name), Some(to)) = (table.get("objects"), table.get("to")) else {
            return reader.error(value, "a transfer needs `objects` and `to`, a pallet");
        };
        let (family, pallet) = (reader.text(name)?, self.pallets.get(&reader.text(to)?));
        let objects: Vec<usize> = (0..self.objects.len()).filter(|k| self.objects[*k].family == family).collect();
        let Some(pallet) = pallet.filter(|pallet| pallet.places.len() == objects.len()) else {
            return reader.error(value, "a transfer needs a pallet with exactly one place for each object");
        };
        let (angle, supports) = (self.angle(table)?, self.supports(table)?);
        let pair = |(object, (_, at)): (usize, &(String, Point))| {
            let (at, angle, supports, height) = (at.clone(), angle.clone(), supports.clone(), pallet.height.clone());
            [self.pick(object, None, None, MovingPick::default()), Action::Place { at, angle, supports, height }]
        };
        Ok(objects.into_iter().zip(&pallet.places).flat_map(pair).collect())
    }
}
