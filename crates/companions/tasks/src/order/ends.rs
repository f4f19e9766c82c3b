//! Conditions that follow from the ends of motions: there, the arm or its payload must not hit an object that another
//! pair has not yet removed, or has already placed.

use super::super::state::State;
use super::Group;
use super::condition::{Condition, Precedence};
use cplan_geometry::Pose;
use cplan_handling::{Action, Item, Placement, Step, Task};
use cplan_model::Scene;
use cplan_model::space::Configuration;
use std::sync::Arc;

/// Poses of all objects; `None` for a carried object. If the orientation of an object depends on IK solutions, its
/// initial orientation is assumed.
type Poses = Arc<[Option<Placement>]>;

/// Returns the poses of all objects before an item of a task.
fn poses_before(task: &Task, item: usize) -> Poses {
    let mut poses: Vec<Option<Placement>> = task.objects.iter().map(|object| Some(object.at.into())).collect();
    let mut held = None;
    for before in &task.items[..item] {
        match before {
            Item::Step(step) => follow(task, step, &mut poses, &mut held),
            Item::AnyOrder(pairs) => pairs.iter().flatten().for_each(|step| follow(task, step, &mut poses, &mut held)),
            Item::Renew(objects) => {
                objects.iter().for_each(|&object| poses[object] = Some(task.objects[object].at.into()))
            }
        }
    }
    poses.into()
}

fn follow(task: &Task, step: &Step, poses: &mut [Option<Placement>], held: &mut Option<(usize, Option<Placement>)>) {
    match step.action {
        Action::Pick { object, .. } => *held = Some((object, poses[object].take())),
        Action::Place { at, angle, .. } => {
            if let Some((object, pose)) = held.take() {
                let turned = angle.or(pose.map(|lies| lies.pose.rotation.angle())).unwrap_or(0.0);
                let placement = Placement { pose: Pose::new(at, turned), elevation: step.elevation };
                poses[object] = task.objects[object].left_at(placement);
            }
        }
        Action::Move(_) | Action::Follow(_) => {}
    }
}

/// Returns the conditions on the order that follow from the ends of a group's motions. There is one for each pick and
/// each place that could collide with objects of other pairs.
pub(super) fn conditions(task: &Task, group: &Group) -> Vec<Condition> {
    let before = poses_before(task, group.item);
    let after = poses_before(task, group.item + 1);
    let own = || task.arm.links.iter().flat_map(|link| &link.parts).map(|part| part.heights);
    let objects = || group.objects().map(|object| &task.objects[object]);
    let heights = || own().chain(objects().map(|object| object.carried_heights()));
    // If all objects are carried above all others, there are no conditions.
    let lying = |object: usize| [&before, &after].map(|poses| poses[object].map_or(0.0, |lies| lies.elevation));
    let is_met = |object: usize| {
        lying(object).iter().any(|&elevation| heights().any(|h| h.meet(task.objects[object].heights_at(elevation))))
    };
    if !group.objects().any(is_met) {
        return Vec::new();
    }
    (0..group.pairs.len())
        .flat_map(|pair| Ends { task, group, pair, before: &before, after: &after }.conditions())
        .collect()
}

/// The ends of one pair's motions.
struct Ends<'a> {
    task: &'a Task,
    group: &'a Group<'a>,
    pair: usize,
    before: &'a Poses,
    after: &'a Poses,
}

impl Ends<'_> {
    fn conditions(&self) -> Vec<Condition> {
        let [pick, place] = &self.group.pairs[self.pair];
        let items = [pick, place, place].map(|step| Item::Step(step.clone()));
        let task = Task { items: items.into(), ..self.task.clone() };
        let Action::Pick { object, .. } = pick.action else { return Vec::new() };
        let mut goals = self.after.clone();
        Arc::make_mut(&mut goals)[object] = self.before[object];
        let worlds = [self.before, &goals].map(|poses| State {
            poses: poses.clone(),
            held: None,
            released: None,
            ..State::at_start(&task)
        });
        let [source, goal] = &worlds;
        let mut picks = Vec::new();
        let mut places = Vec::new();
        let mut grips = Vec::new();
        let scenes = worlds.each_ref().map(|world| world.scene(&task, Some(object)));
        for candidate in source.candidates(&task).into_iter().flat_map(|candidates| candidates.ways) {
            let lifted = [source, goal].map(|world| world.after(&task, &candidate, candidate.to));
            let carrying = lifted.each_ref().map(|world| world.scene(&task, None));
            let at_pick = self.alternative(&scenes, candidate.to);
            picks.extend(at_pick.zip(self.alternative(&carrying, candidate.to)).map(|(a, b)| [a, b].concat()));
            let grip = lifted[0].held.as_ref().map(|held| held.grip);
            if grips.contains(&grip) {
                continue;
            }
            grips.push(grip);
            for candidate in lifted[0].candidates(&task).into_iter().flat_map(|candidates| candidates.ways) {
                let released =
                    lifted.each_ref().map(|world| world.after(&task, &candidate, candidate.to).scene(&task, None));
                let at_place = self.alternative(&carrying, candidate.to);
                places.extend(at_place.zip(self.alternative(&released, candidate.to)).map(|(a, b)| [a, b].concat()));
            }
        }
        // If there is no alternative at all, no order is possible. The search will find this.
        let made = [picks, places].into_iter().filter(|alternatives| !alternatives.is_empty());
        made.filter_map(Condition::of).collect()
    }

    /// Returns the requirements for the arm to be at `q`: which pairs must come before or after. The two scenes are the
    /// worlds before and after the group. `None` if no order of the group makes `q` free.
    fn alternative(&self, [before, after]: &[Scene; 2], q: Configuration) -> Option<Vec<Precedence>> {
        let hit = |scene: &Scene, ahead: bool| {
            let others = scene.obstructions(q).into_iter().map(move |hit| {
                let other = self.group.pair_of(self.task, hit.contact.pair.obstacle)?;
                let before = if ahead { Precedence(other, self.pair) } else { Precedence(self.pair, other) };
                (other != self.pair).then_some(before)
            });
            others.collect::<Option<Vec<Precedence>>>()
        };
        Some([hit(before, true)?, hit(after, false)?].concat())
    }
}
