//! Shapes of the robot that can collide.

use super::Robot;
use super::solid::{Solid, Surface};
use super::tree::{ReadResult, child, children};
use crate::world::WorldFile;
use cplan_check::shapes::{CollisionShape, Outline};
use cplan_check::{CheckError, Input};
use roxmltree::Node;
use std::collections::BTreeSet;

/// A shape of a link, projected into the plane.
pub struct PlacedShape<'a> {
    pub link: &'a str,
    pub whole: CollisionShape,
    /// Points and edges of the shape, if it can be cut into layers.
    pub surface: Option<Surface>,
}

impl<'a> Robot<'a> {
    /// Finds all shapes that are checked for collisions: the collision shapes of each link, or its visual shapes if it has no
    /// collision shapes. The world's bar replaces a moving part of the arm that has no shapes, or a mesh that cannot be read.
    ///
    /// # Errors
    /// If a shape cannot be read, even if the certificate does not refer to it. Only two kinds of unreadable shapes are
    /// omitted: shapes of static links, and visual shapes if other links of the same part have collision shapes.
    pub(super) fn count(&mut self, world: &WorldFile) -> ReadResult<()> {
        let mut all = Vec::new();
        let still = world.robot.own_body.then_some(None);
        for last in [Some(0), Some(1)].into_iter().chain(still) {
            let (mut found, mut unread) = (Vec::new(), Vec::new());
            for &link in &self.tree.order {
                if self.group(link)? == Some(last) {
                    self.gather(link, last, &mut found, &mut unread)?;
                }
            }
            let has_collision = found.iter().any(|placed: &PlacedShape| placed.whole.kind == "collision");
            let is_no_matter = |kind: &str| last.is_none() || kind == "visual" && has_collision;
            let (left, unread): (Vec<_>, Vec<_>) = unread.into_iter().partition(|(_, kind, _)| is_no_matter(kind));
            self.arm.notes.extend(
                left.iter().map(|(link, kind, why)| format!("; a {kind} of link \"{link}\" is ignored: {why}")),
            );
            self.arm.notes.extend(unread.iter().map(|(.., why)| format!("; {why}: a bar replaces it")));
            match (last, &world.robot.bar, unread.into_iter().next()) {
                (Some(last), Some(bar), unread) if found.is_empty() || unread.is_some() => {
                    let (link, whole) = (self.children[last], self.bar(last, bar)?);
                    found.push(PlacedShape { link, whole, surface: None });
                }
                (_, None, Some((.., unread))) => return Err(unread),
                _ => {}
            }
            all.append(&mut found);
        }
        self.arrange(all, world)?;
        if self.arm.shapes.is_empty() {
            return Err(CheckError::in_file(Input::Urdf, "the arm has no shape that could collide"));
        }
        Ok(())
    }

    /// Adds the shapes of a link. For each shape that cannot be read, adds the reason.
    fn gather(
        &self,
        link: &'a str,
        last: Option<usize>,
        found: &mut Vec<PlacedShape<'a>>,
        unread: &mut Vec<(&'a str, &'static str, CheckError)>,
    ) -> ReadResult<()> {
        let before = found.len() + unread.len();
        for kind in ["collision", "visual"] {
            let mut number = 0;
            for node in children(self.tree.links[link], kind) {
                let mut geometry = child(node, "geometry").into_iter().flat_map(|all| all.children());
                let mut next = || geometry.by_ref().find(Node::is_element);
                let (Some(geometry), None) = (next(), next()) else {
                    return self.tree.error(node, "<collision> and <visual> need a <geometry> with exactly one shape");
                };
                let solid = match self.tree.solid(geometry)? {
                    Some(Ok(solid)) => solid,
                    Some(Err(why)) => {
                        unread.push((link, kind, why));
                        continue;
                    }
                    None => continue,
                };
                let pose = self.tree.pose(link)?.compose(&self.tree.origin(node)?);
                let surface = match solid {
                    Solid::Hull(ref mesh) => Some(self.surface(last, &pose, mesh)),
                    _ => None,
                };
                let [around, within] = match &surface {
                    Some(surface) => surface.whole(last),
                    None => {
                        [Outline::Around, Outline::Within].map(|outline| self.project(last, &pose, &solid, outline))
                    }
                };
                let (layer, ignored) = (None, BTreeSet::new());
                let whole =
                    CollisionShape { link: link.to_owned(), kind, number, last, layer, around, within, ignored };
                found.push(PlacedShape { link, whole, surface });
                number += 1;
            }
            if found.len() + unread.len() > before {
                break;
            }
        }
        Ok(())
    }
}
