//! The steps of a cell file: those of each arm, handovers, and steps that either arm may do.

use crate::excerpt::Excerpt;
use crate::file::{CellFile, Reader};
use cplan_engine::Problem;
use cplan_handling::{Action, Holding, Item, Presence, Step, Task};
use cplan_model::Obstacle;
use cplan_robot::{InputError, Source};
use cplan_world::{Overrides, Rules};
use std::collections::BTreeSet;
use std::ops::Range;

/// Greatest number of objects that either arm may move. Each of them doubles the number of assignments.
const MAX_SHARED: usize = 8;

/// Keys of `task` that apply to the steps of the file, but not to a move to the goal.
const GROUP_KEYS: [&str; 2] = ["order", "repeat"];

/// The parts of an arm's world that depend on steps.
#[derive(Debug, Clone, Default)]
pub(crate) struct ArmWorld {
    /// The objects, as the arm finds them.
    pub objects: Option<Excerpt>,
    /// The steps. `None` if the cell has no steps.
    pub steps: Option<Excerpt>,
    /// Defaults of the steps.
    pub defaults: Option<Excerpt>,
    /// For each pair of a pick and a place that either arm may do, its number in the first group of steps.
    pub shared: Vec<Option<usize>>,
    /// Names of the objects that the arm hands over or takes.
    handovers: Vec<(String, Presence)>,
}

/// A handover of the file.
struct FileHandover {
    object: String,
    /// The arm that takes the object, 0 or 1.
    taker: usize,
    /// The place of `from` in the file.
    at: Range<usize>,
}

/// Returns the worlds of both arms.
///
/// # Errors
/// Invalid handovers and shared steps.
pub(crate) fn worlds(reader: &Reader, urdfs: &[Source; 2]) -> Result<[ArmWorld; 2], InputError> {
    let objects = reader.file.object.clone();
    let mut worlds = [0, 1].map(|arm| {
        let defaults = reader.tables[arm].task.clone();
        ArmWorld { objects: objects.clone(), defaults, ..ArmWorld::default() }
    });
    if reader.file.step.is_none() && reader.tables.iter().all(|table| table.step.is_none()) {
        return Ok(worlds);
    }
    let handovers = handovers(reader)?;
    for world in &mut worlds {
        world.defaults = world.defaults.take().map(|task| GROUP_KEYS.iter().fold(task, |task, key| task.without(key)));
    }
    let own = [0, 1].map(|arm| own_steps(reader, arm));
    let picked = |arm: usize| {
        let picks = own[arm].iter().filter_map(|step| step.get("pick"));
        picks.filter(|pick| handovers.iter().all(|handover| Some(handover.object.as_str()) != pick.as_text()))
    };
    let both = picked(1).find(|pick| picked(0).any(|other| other.as_text() == pick.as_text()));
    if let Some(pick) = both {
        return Err(picked_by_both(reader, pick.place(), pick.as_text().unwrap_or_default()));
    }
    for handover in &handovers {
        let giver = 1 - handover.taker;
        let object = handed_object(reader, urdfs, &own[giver], (giver, &worlds[giver]), handover)?;
        worlds[handover.taker].objects = replaced(worlds[handover.taker].objects.take(), object);
        worlds[handover.taker].handovers.push((handover.object.clone(), Presence::FromPick));
        worlds[giver].handovers.push((handover.object.clone(), Presence::UntilPlaced));
    }
    let pairs = shared_pairs(reader)?;
    for arm in 0..2 {
        let group = shared_group(reader, urdfs, arm, &pairs, &mut worlds[arm])?;
        let steps: Vec<Excerpt> = group.into_iter().chain(composed(reader, arm, &own[arm])).collect();
        let at = reader.tables[arm].name.span();
        if steps.is_empty() {
            let message = format!(
                "arm \"{}\" has no goal and no steps, and it can do none of the shared steps",
                reader.tables[arm].name.get_ref()
            );
            return Err(reader.error(at, message, "give the arm a goal, or a step: [[arm.step]]"));
        }
        worlds[arm].steps = Some(Excerpt::of_items(steps, at));
    }
    for (pair, [pick, _]) in pairs.iter().enumerate() {
        if worlds.iter().all(|world| world.shared[pair].is_none()) {
            // The error of the first arm says why.
            let world =
                ArmWorld { steps: Some(Excerpt::of_items(pairs[pair].to_vec(), pick.place())), ..worlds[0].clone() };
            task_of(reader, urdfs, 0, &world)?;
        }
    }
    Ok(worlds)
}

/// Checks the tasks of both arms together.
///
/// # Errors
/// An object that both arms pick without a handover, and a handover of an object that is picked repeatedly.
pub(crate) fn check(reader: &Reader, tasks: [Option<&Task>; 2]) -> Result<(), InputError> {
    let [Some(one), Some(two)] = tasks else { return Ok(()) };
    let shared = shared_names(reader.file);
    let picks = [one, two].map(|task| task.steps().filter_map(|step| step.action.picked()).collect::<Vec<_>>());
    let is_free =
        |object: &&usize| one.objects[**object].presence.is_none() && !shared.contains(&one.objects[**object].name);
    let both = picks[0].iter().filter(is_free).find(|object| picks[1].contains(object));
    let at = || reader.tables[1].step.as_ref().map_or(reader.tables[1].name.span(), Excerpt::place);
    if let Some(object) = both {
        return Err(picked_by_both(reader, at(), &one.objects[*object].name));
    }
    for picks in &picks {
        let mut seen = BTreeSet::new();
        let again = picks.iter().find(|object| !seen.insert(**object) && one.objects[**object].presence.is_some());
        if let Some(object) = again {
            let message =
                format!("\"{}\" is handed over, but an arm picks it more than once", one.objects[*object].name);
            return Err(reader.error(at(), message, "each arm picks an object once that is handed over"));
        }
    }
    Ok(())
}

/// Returns the error about an object that both arms pick.
fn picked_by_both(reader: &Reader, at: Range<usize>, object: &str) -> InputError {
    let giver = reader.tables[0].name.get_ref();
    let hint = format!("if the arms hand it over, write from = \"{giver}\" beside the pick of the arm that takes it");
    reader.error(at, format!("both arms pick \"{object}\""), &hint)
}

/// Returns the names of the objects that either arm may move.
pub(crate) fn shared_names(file: &CellFile) -> Vec<String> {
    let picked = |step: &Excerpt| step.get("pick").and_then(Excerpt::as_text).map(str::to_owned);
    file.step.iter().flat_map(Excerpt::items).filter_map(picked).collect()
}

impl ArmWorld {
    /// Returns the task of a problem of this world, among more obstacles: the base of the other arm. `None` without steps.
    pub fn task(&self, problem: &Problem, others: &[Obstacle]) -> Option<Task> {
        let mut task = problem.task().filter(|_| self.steps.is_some())?.clone();
        for object in &mut task.objects {
            object.presence = self.handovers.iter().find(|(name, _)| *name == object.name).map(|(_, role)| *role);
        }
        // The arm rests during strokes and turns, so it can wait with the tool raised before each motion.
        if let Some(stroke) = &mut task.stroke {
            stroke.arch = None;
        }
        if let Some(wrist) = &mut task.wrist {
            wrist.turns_on_the_way = false;
        }
        Some(with_obstacles(&task, others))
    }
}

/// Returns a task among more static obstacles.
pub(crate) fn with_obstacles(task: &Task, more: &[Obstacle]) -> Task {
    let mut task = task.clone();
    let before = task.workspace.fixed.obstacles.len();
    task.workspace.fixed.obstacles.extend_from_slice(more);
    for step in task.items.iter_mut().flat_map(steps_of) {
        if let Action::Pick { supports, .. } | Action::Place { supports, .. } = &mut step.action {
            // Objects follow the obstacles.
            supports.iter_mut().filter(|support| **support >= before).for_each(|support| *support += more.len());
        }
    }
    task
}

fn steps_of(item: &mut Item) -> Vec<&mut Step> {
    match item {
        Item::Step(step) => vec![step],
        Item::AnyOrder(pairs) => pairs.iter_mut().flatten().collect(),
        Item::Renew(_) => Vec::new(),
    }
}

/// Replaces the positions of the steps in the text of an arm's world by those in the cell file.
pub(crate) fn locate(task: &mut Task, world: &Source, cell: &Source) {
    let text = world.text();
    for step in task.items.iter_mut().flat_map(steps_of) {
        let mut numbers = step.place.rsplit(':').map_while(|number| number.parse::<usize>().ok());
        let Some((column, line)) = numbers.next().zip(numbers.next()) else { continue };
        let lines: Vec<&str> = text.split_inclusive('\n').take(line).collect();
        let Some((own, before)) = lines.split_last() else { continue };
        let in_line: usize = own.chars().take(column.saturating_sub(1)).map(char::len_utf8).sum();
        let offset = before.iter().map(|line| line.len()).sum::<usize>() + in_line;
        if let Some(at) = world.diagnostic_at(offset..offset + 1, "").position {
            step.place = format!("{}:{}:{}", cell.name(), at.line, at.column);
        }
    }
}

/// Returns the steps of an arm as written.
fn own_steps(reader: &Reader, arm: usize) -> Vec<Excerpt> {
    reader.tables[arm].step.iter().flat_map(|steps| steps.items().iter().cloned()).collect()
}

/// Returns steps of an arm as steps of its world: in a group if its `task` has keys of groups, and followed by a move to the
/// goal.
fn composed(reader: &Reader, arm: usize, steps: &[Excerpt]) -> Vec<Excerpt> {
    let table = reader.tables[arm];
    let mut steps: Vec<Excerpt> = steps.iter().map(|step| step.clone().without("from")).collect();
    let keys: Vec<_> = GROUP_KEYS.iter().filter_map(|key| Some((*key, table.task.as_ref()?.get(key)?))).collect();
    if let Some(first) = steps.first().filter(|_| !keys.is_empty()) {
        let at = first.place();
        let group = keys
            .into_iter()
            .fold(Excerpt::empty_table(at.clone()), |group, (key, value)| group.with(key, value.clone()));
        steps = vec![group.with("steps", Excerpt::of_items(steps, at))];
    }
    steps.extend(table.goal.iter().map(|goal| Excerpt::empty_table(goal.place()).with("move", goal.clone())));
    steps
}

/// Returns the handovers of the file: picks with the key `from`.
fn handovers(reader: &Reader) -> Result<Vec<FileHandover>, InputError> {
    let mut found: Vec<FileHandover> = Vec::new();
    for taker in 0..2 {
        for step in own_steps(reader, taker) {
            let Some((from, at)) = step.get("from").zip(step.key("from")) else { continue };
            let giver = reader.tables[1 - taker].name.get_ref();
            if from.as_text() != Some(giver) {
                let hint = format!("write from = \"{giver}\"");
                return Err(reader.error(at, "`from` must be the name of the other arm".into(), &hint));
            }
            let Some(object) = step.get("pick").and_then(Excerpt::as_text) else {
                let hint = "write `from` beside a pick: pick = \"part\"";
                return Err(reader.error(at, "`from` needs the object that is taken".into(), hint));
            };
            if found.iter().any(|known| known.object == object) {
                let message = format!("\"{object}\" is handed over more than once");
                return Err(reader.error(at, message, "hand each object over once"));
            }
            found.push(FileHandover { object: object.to_owned(), taker, at });
        }
    }
    Ok(found)
}

/// Returns the table of an object at the place where the giver leaves it.
fn handed_object(
    reader: &Reader,
    urdfs: &[Source; 2],
    steps: &[Excerpt],
    (giver, of_giver): (usize, &ArmWorld),
    FileHandover { object, at, .. }: &FileHandover,
) -> Result<Excerpt, InputError> {
    let name = reader.tables[giver].name.get_ref();
    let is_named = |table: &&Excerpt| table.get("name").and_then(Excerpt::as_text) == Some(object);
    let table = reader.file.object.iter().flat_map(Excerpt::items).find(is_named);
    let Some(table) = table.filter(|table| table.get("pallet").is_none()) else {
        let message = format!("\"{object}\" is handed over, but no [[object]] outside pallets has this name");
        return Err(reader.error(at.clone(), message, "write an [[object]] with this name and `at`"));
    };
    // The objects that the giver takes itself do not lie at their initial places.
    let (mut kept, mut is_taken) = (Vec::new(), false);
    for step in steps {
        is_taken |= step.get("from").is_some();
        if !is_taken {
            kept.push(step.clone());
        }
        is_taken &= step.get("place").is_none();
    }
    let world = ArmWorld {
        objects: reader.file.object.clone(),
        steps: Some(Excerpt::of_items(composed(reader, giver, &kept), at.clone())),
        defaults: of_giver.defaults.clone(),
        ..ArmWorld::default()
    };
    let task = if kept.is_empty() { None } else { Some(task_of(reader, urdfs, giver, &world)?) };
    let mut carried = None;
    let place = task.iter().flat_map(Task::steps).find_map(|step| {
        carried = step.action.picked().or(carried);
        let number = carried?;
        let task = task.as_ref()?;
        match step.action {
            Action::Place { at, angle, .. } if task.objects[number].name == *object => {
                Some((at, angle, step.elevation, &task.objects[number]))
            }
            _ => None,
        }
    });
    let Some((to, angle, elevation, found)) = place else {
        let message = format!("arm \"{name}\" does not pick and place \"{object}\", which the other arm takes from it");
        return Err(reader.error(at.clone(), message, "add a pick and a place to its steps, or remove `from`"));
    };
    if found.holding == Holding::Rigid {
        let message = format!("\"{object}\" is held rigidly, so its angle at the handover is not known");
        return Err(reader.error(at.clone(), message, "write payload = \"level\" for the object"));
    }
    if elevation != 0.0 {
        let message = format!("\"{object}\" is handed over at another height than its own");
        return Err(reader.error(at.clone(), message, "place it at the height at which it was picked"));
    }
    let angle = angle.unwrap_or(found.at.rotation.angle());
    let numbers = [to.x, to.y].map(|x| Excerpt::of_number(x, at.clone())).to_vec();
    let table = table.clone().with("at", Excerpt::of_items(numbers, at.clone()));
    Ok(table.with("angle", Excerpt::of_number(angle, at.clone())))
}

/// Returns the objects with another table of one of them.
fn replaced(objects: Option<Excerpt>, object: Excerpt) -> Option<Excerpt> {
    let name = |table: &Excerpt| table.get("name").and_then(|name| name.as_text().map(str::to_owned));
    objects.map(|objects| {
        let other = |table: &Excerpt| if name(table) == name(&object) { object.clone() } else { table.clone() };
        Excerpt::of_items(objects.items().iter().map(other).collect(), objects.place())
    })
}

/// Returns the pairs of a pick and a place that either arm may do.
fn shared_pairs(reader: &Reader) -> Result<Vec<[Excerpt; 2]>, InputError> {
    let steps: Vec<&Excerpt> = reader.file.step.iter().flat_map(Excerpt::items).collect();
    let hint = "write pairs of a step with `pick` and a step with `place`; write other steps as [[arm.step]]";
    let mut pairs = Vec::new();
    for pair in steps.chunks(2) {
        match pair {
            [pick, place] if pick.get("pick").is_some() && place.get("place").is_some() => {
                pairs.push([(*pick).clone(), (*place).clone()]);
            }
            _ => {
                let message = "the steps of either arm must be pairs of a pick and a place".into();
                return Err(reader.error(pair[0].place(), message, hint));
            }
        }
    }
    if let Some([pick, _]) = pairs.get(MAX_SHARED) {
        let message = format!("either arm may move at most {MAX_SHARED} objects, but the file has {}", pairs.len());
        return Err(reader.error(pick.place(), message, "give some of the steps to an arm: [[arm.step]]"));
    }
    Ok(pairs)
}

/// Returns the group of the pairs that an arm can do. `None` without such pairs.
fn shared_group(
    reader: &Reader,
    urdfs: &[Source; 2],
    arm: usize,
    pairs: &[[Excerpt; 2]],
    world: &mut ArmWorld,
) -> Result<Option<Excerpt>, InputError> {
    let mut steps = Vec::new();
    for pair in pairs {
        let alone = Excerpt::of_items(pair.to_vec(), pair[0].place());
        let alone = ArmWorld { steps: Some(alone), ..world.clone() };
        let can_do = task_of(reader, urdfs, arm, &alone).is_ok();
        world.shared.push(can_do.then_some(steps.len() / 2));
        if can_do {
            steps.extend(pair.iter().cloned());
        }
    }
    let Some(first) = steps.first() else { return Ok(None) };
    let at = first.place();
    let group = Excerpt::empty_table(at.clone()).with("order", Excerpt::of_text("free", at.clone()));
    Ok(Some(group.with("steps", Excerpt::of_items(steps, at))))
}

/// Reads the task of an arm's world.
fn task_of(reader: &Reader, urdfs: &[Source; 2], arm: usize, world: &ArmWorld) -> Result<Task, InputError> {
    let loaded = reader.scene(arm, &urdfs[arm], world)?.resolve(&Overrides::default(), Rules::Plan)?;
    Ok(loaded.task.expect("a world with steps is a task"))
}
