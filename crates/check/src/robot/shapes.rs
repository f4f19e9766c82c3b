//! The shapes of the arm that count: all that its joints move and that can collide.

use super::solid::Outline;
use super::tree::{Read, child, children};
use super::{Arm, Body};
use crate::decimal::Decimal;
use crate::error::{CheckError, Input};
use roxmltree::Node;
use std::fmt;

/// A shape of the arm that counts.
pub struct Counted {
    /// The link that it belongs to.
    pub link: String,
    /// `collision`, `visual` or `bar`, ...
    pub kind: &'static str,
    /// ... and its number among those of its kind that the link has, without those that have no size.
    pub number: usize,
    /// At least what it covers, ...
    pub around: Body,
    /// ... and at most.
    pub within: Body,
}

impl fmt::Display for Counted {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { link, kind, number, .. } = self;
        match *kind {
            "bar" => write!(f, "the bar of link \"{link}\""),
            _ => write!(f, "link \"{link}\", {kind} {number}"),
        }
    }
}

impl<'a> Arm<'a> {
    /// Finds them: collision shapes, or where one of the two parts of the arm has none, its visual ones. Where it has none either, or some
    /// that are meshes which are not read, the bar that the world has for it.
    ///
    /// # Errors
    /// Shapes that the checker does not know. It is no matter here what the certificate says: nothing is left out.
    pub(super) fn count(&mut self, bar: Option<&Decimal>) -> Read<()> {
        for last in [0, 1] {
            let (mut found, mut unread) = self.gathered(last, "collision")?;
            if found.is_empty() && unread.is_empty() {
                (found, unread) = self.gathered(last, "visual")?;
            }
            match (bar, unread.first()) {
                (Some(bar), _) if found.is_empty() || !unread.is_empty() => found.push(self.bar(last, bar)?),
                (None, Some(unread)) => return Err(unread.clone()),
                _ => {}
            }
            self.notes.extend(unread.iter().map(|why| format!("; {why}: a bar stands in for it")));
            self.shapes.append(&mut found);
        }
        if self.shapes.is_empty() {
            return Err(CheckError::in_file(Input::Urdf, "the arm has no shape that could collide"));
        }
        Ok(())
    }

    /// Shapes of one kind of all links whose last joint of the two this one is, and why others are not read.
    fn gathered(&self, last: usize, kind: &'static str) -> Read<(Vec<Counted>, Vec<CheckError>)> {
        let (mut found, mut unread) = (Vec::new(), Vec::new());
        for &link in &self.tree.order {
            let mut number = 0;
            let nodes = children(self.tree.links[link], kind);
            for node in if self.moved_by(link)? == Some(last) { nodes.collect() } else { Vec::new() } {
                let mut geometry = child(node, "geometry").into_iter().flat_map(|all| all.children());
                let mut next = || geometry.by_ref().find(Node::is_element);
                let (Some(geometry), None) = (next(), next()) else {
                    return self.tree.error(node, "it has no geometry, or one of several shapes");
                };
                let solid = match self.tree.solid(geometry)? {
                    Some(Ok(solid)) => solid,
                    Some(Err(why)) => {
                        unread.push(why);
                        continue;
                    }
                    None => continue,
                };
                let pose = self.tree.pose(link)?.after(&self.tree.origin(node)?);
                let [around, within] =
                    [Outline::Around, Outline::Within].map(|outline| self.project(last, &pose, &solid, outline));
                found.push(Counted { link: link.to_owned(), kind, number, around, within });
                number += 1;
            }
        }
        Ok((found, unread))
    }

    /// A shape by its link, its kind and its number.
    ///
    /// # Errors
    /// When there is none that counts.
    pub fn shape(&self, link: &str, kind: &str, number: usize) -> Read<&Counted> {
        let found = self.shapes.iter().find(|own| own.link == link && own.kind == kind && own.number == number);
        let none = || CheckError::Fails(format!("link \"{link}\" has no {kind} shape number {number} that counts"));
        found.ok_or_else(none)
    }
}
