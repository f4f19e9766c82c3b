//! The robot's own body: finds the pairs of links that must not collide.

use super::Robot;
use super::layers::cuts;
use super::permanent::ignore_permanent_contacts;
use super::shapes::PlacedShape;
use super::solid::bodies;
use super::tree::ReadResult;
use crate::world::WorldFile;
use cplan_check::interval::{Interval, Point, sum};
use cplan_check::obstacle::Obstacle;
use cplan_check::shapes::{CollisionShape, Outline};
use cplan_check::{CheckError, Input};
use num_bigint::BigInt;
use std::collections::{BTreeMap, BTreeSet};

impl<'a> Robot<'a> {
    /// Finds the last of the two joints that moves a link. `Some(None)` for a static link. `None` if another movable
    /// joint carries the link, so that its position is unknown.
    pub(super) fn group(&self, link: &'a str) -> ReadResult<Option<Option<usize>>> {
        if let Some(last) = self.moving_joint(link)? {
            return Ok(Some(Some(last)));
        }
        let carrying = self.tree.joints_above(self.children[0])?;
        let above = self.tree.joints_above(link)?;
        let is_held = above.iter().all(|joint| joint.attribute("type") == Some("fixed") || carrying.contains(joint));
        Ok(is_held.then_some(None))
    }

    /// Cuts meshes into layers, and stores two lists in the arm: moving shapes, and shapes that are obstacles for other
    /// links.
    ///
    /// # Errors
    /// If the world names a link that the robot does not have.
    pub(super) fn arrange(&mut self, all: Vec<PlacedShape<'a>>, world: &WorldFile) -> ReadResult<()> {
        let ignored = &world.robot.ignore_contact;
        if let Some(odd) = ignored.iter().flatten().find(|link| !self.tree.links.contains_key(link.as_str())) {
            let message = format!("[robot] ignore_contact: the robot has no link \"{odd}\"");
            return Err(CheckError::in_file(Input::World, message));
        }
        let groups: BTreeMap<&'a str, Option<usize>> =
            all.iter().map(|placed| (placed.link, placed.whole.last)).collect();
        let mut apart = BTreeSet::new();
        for (a, of_a) in &groups {
            for (b, _) in groups.iter().filter(|(_, of_b)| world.robot.own_body && *of_b != of_a) {
                let may_meet = ignored.iter().any(|[c, d]| [c, d] == [a, b] || [d, c] == [a, b]);
                if !may_meet {
                    apart.insert((*a, *b));
                }
            }
        }
        let ends = |placed: &PlacedShape| placed.whole.around.heights.iter().flatten().map(|h| h.middle().0).collect();
        let ends: Vec<(&str, Vec<BigInt>)> = all.iter().map(|placed| (placed.link, ends(placed))).collect();
        let wrist = world.task.as_ref().and_then(|task| task.wrist.as_ref()?.joint.as_deref());
        for PlacedShape { link, whole, surface } in all {
            let last = whole.last;
            let others = ends.iter().filter(|(other, _)| apart.contains(&(link, *other)));
            let cuts = cuts(others.flat_map(|(_, ends)| ends.clone()).collect());
            // A disc replaces a link that turns with the wrist. It is not cut.
            let turns =
                self.tree.joints_above(link)?.iter().any(|joint| wrist.is_some() && joint.attribute("name") == wrist);
            let layers = surface.filter(|_| !turns).map_or_else(Vec::new, |surface| surface.layers(&cuts));
            let layer = |(number, (points, heights)): (usize, (Vec<Point>, [Interval; 2]))| {
                let (link, layer) = (whole.link.clone(), Some(number));
                let [around, within] = bodies(last, points.into_iter(), &heights);
                CollisionShape { link, layer, around, within, ignored: BTreeSet::new(), ..whole }
            };
            let mut layers: Vec<CollisionShape> = layers.into_iter().enumerate().map(layer).collect();
            if layers.is_empty() {
                layers.push(whole);
            }
            let is_met = |other: &str, of: Option<usize>| of == Some(1) && apart.contains(&(link, other));
            if last.is_none() || last == Some(0) && groups.iter().any(|(other, of)| is_met(other, *of)) {
                self.arm.bases.extend(layers.iter().map(|own| at_zero(own, &self.arm.base)));
            }
            if last.is_some() {
                self.arm.shapes.append(&mut layers);
            }
        }
        for own in &mut self.arm.shapes {
            let allowed =
                self.arm.bases.iter().filter(|other| !apart.contains(&(own.link.as_str(), other.link.as_str())));
            own.ignored = allowed.map(ToString::to_string).collect();
        }
        ignore_permanent_contacts(&mut self.arm);
        let obstacle = |own: &CollisionShape| {
            let heights = own.around.inset_heights(Outline::Around);
            Obstacle::link(own.to_string(), own.owner(), own.around.shape.clone(), heights)
        };
        self.arm.own = self.arm.bases.iter().map(obstacle).collect();
        Ok(())
    }
}

/// Converts a shape of a static link, or of a link that joint 1 carries, to plane coordinates with joint 1 at zero.
fn at_zero(own: &CollisionShape, base: &Point) -> CollisionShape {
    let mut own = own.clone();
    if own.last.is_some() {
        for point in own.around.shape.points.iter_mut().chain(&mut own.within.shape.points) {
            *point = sum(point, base);
        }
    }
    own
}
