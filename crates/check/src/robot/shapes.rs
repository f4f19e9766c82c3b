//! The shapes of the arm that count: all that its joints move and that can collide.

use super::solid::Outline;
use super::tree::{Read, child, children, moves};
use super::{Arm, Body, Joint, Motion};
use crate::decimal::Decimal;
use crate::error::{CheckError, Input};
use crate::interval::{Interval, Point, length, minus, sum};
use crate::overlap::{Shape, depth};
use crate::sweep::Axis;
use crate::world::task::Task;
use num_bigint::{BigInt, Sign};
use roxmltree::Node;
use std::fmt;

/// No object presses deeper than this share of the arm's reach into what supports it: `10^-4`.
const PRESSED: u32 = 4;

/// The cosine of the angle between the normal and what counts as along it is no smaller than 1 by more than `10^-9`.
const UPRIGHT: u32 = 9;

/// A disc that is about the wrist's axis is off it by no more than `10^-8`, metres.
const OFF_AXIS: u32 = 8;

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

impl Counted {
    /// What it covers whichever way it is turned about a point, and what it covers at all angles.
    ///
    /// # Errors
    /// A shape that does not hold the point: it covers nothing at all angles.
    fn turn_about(&mut self, axis: &Point) -> Read<()> {
        let off = |point: &Point| length(&minus(point, axis));
        let round = Decimal::power_of_ten(OFF_AXIS);
        let is_disc =
            |body: &Body| matches!(&body.shape.points[..], [one] if off(one).upper <= Interval::from(&round).lower);
        if is_disc(&self.around) && is_disc(&self.within) {
            return Ok(());
        }
        let shape = &self.around.shape;
        let farthest = shape.points.iter().map(|p| off(p).upper).max().expect("a shape has points");
        let deepest = depth(&self.within.shape, axis);
        if deepest.sign() != Sign::Plus {
            let message = format!(
                "{self} turns with the wrist and does not hold its axis: give it a shape that covers it all round"
            );
            return Err(CheckError::in_file(Input::Urdf, message));
        }
        let disc = |radius: BigInt| Shape { points: vec![axis.clone()], radius: Interval::exactly(radius) };
        self.around.shape = disc(farthest + &shape.radius.upper);
        self.within.shape = disc(deepest);
        Ok(())
    }
}

impl<'a> Arm<'a> {
    /// Finds them: collision shapes, or where one of the two parts of the arm has none, its visual ones. Where it has none either, or some
    /// that are meshes which are not read, the bar that the world has for it.
    ///
    /// # Errors
    /// Shapes that the checker does not know. It is no matter here what the certificate says: nothing is left out.
    pub(super) fn count(&mut self, bar: Option<&Decimal>, task: Option<&Task>) -> Read<()> {
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
        let Some(task) = task else { return Ok(()) };
        if let Some(name) = task.wrist.as_ref().and_then(|wrist| wrist.joint.as_deref()) {
            let (joint, carried) = self.of_the_tool(name, "wrist")?;
            let [at, axis] = [&self.base, &self.offset];
            let axis = minus(&self.plane.flat(&self.tree.pose(carried)?.at), &sum(at, axis));
            for k in 0..self.shapes.len() {
                let link = self.tree.order.iter().find(|link| ***link == *self.shapes[k].link);
                if link.map_or(Ok(Vec::new()), |link| self.tree.above(link))?.contains(&joint) {
                    self.shapes[k].turn_about(&axis)?;
                }
            }
        }
        task.stroke.as_ref().map_or(Ok(()), |stroke| self.of_the_tool(&stroke.joint, "stroke").map(|_| ()))
    }

    /// A joint of the tool, and the link that it carries: it moves about the plane's normal or along it, and nothing that counts goes with it.
    fn of_the_tool(&self, name: &str, what: &str) -> Read<(Node<'a, 'a>, &'a str)> {
        let wrong = |why: &str| Err(CheckError::in_file(Input::World, format!("the {what}'s joint \"{name}\" {why}")));
        let found = self.tree.joints.iter().find(|(_, node)| node.attribute("name") == Some(name));
        let Some((&carried, &joint)) = found else { return wrong("is none of the robot's") };
        let along = self.plane.height(&self.tree.pose(carried)?.direction(&self.tree.axis(joint)?)).abs();
        let least = &Decimal::whole(1) - &Decimal::power_of_ten(UPRIGHT);
        let slides = joint.attribute("type") == Some("prismatic");
        let is_of_kind = moves(&joint) && slides == (what == "stroke") && child(joint, "mimic").is_none();
        if !is_of_kind || along.lower < Interval::from(&least).lower || self.moved_by(carried)? != Some(1) {
            return wrong("does not move the tool along the normal of the plane, or about it");
        }
        for (&link, other) in &self.tree.joints {
            let is_below = |body: &str| -> Read<bool> {
                let body = self.tree.order.iter().find(|known| **known == body);
                Ok(body.map_or(Ok(Vec::new()), |body| self.tree.above(body))?.contains(other))
            };
            let follows = self.tree.leader(*other)?.is_some_and(|leader| leader == joint);
            if follows && (link == self.tip_link || is_below(self.tip_link)?) {
                return wrong("is mimicked by one that moves the tip");
            }
            for shape in if follows { &self.shapes[..] } else { &[] } {
                if is_below(&shape.link)? {
                    return wrong("is mimicked by one that moves what could collide");
                }
            }
        }
        Ok((joint, carried))
    }

    /// Shapes of one kind of all links whose last joint of the two this one is, and why others are not read.
    fn gathered(&self, last: usize, kind: &'static str) -> Read<(Vec<Counted>, Vec<CheckError>)> {
        let (mut found, mut unread) = (Vec::new(), Vec::new());
        for &link in &self.tree.order {
            let mut number = 0;
            let nodes = children(self.tree.links[link], kind);
            for node in if self.moved_by(link)? == Some(last) { nodes.collect() } else { Vec::new() } {
                let geometry = child(node, "geometry").and_then(|geometry| geometry.first_element_child());
                let Some(geometry) = geometry else { return self.tree.error(node, "it has no geometry") };
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

    /// All within a radius of the segment from a joint to the next, or to the tip.
    fn bar(&self, last: usize, radius: &Decimal) -> Read<Counted> {
        if radius.sign() != Sign::Plus {
            return Err(CheckError::in_file(Input::World, "the radius of a bar is positive"));
        }
        let link = self.children[last];
        let (next, end) = match last {
            0 => (self.children[1], self.offset.clone()),
            _ => (self.tip_link, self.tip.shape.points[0].clone()),
        };
        let radius = Interval::from(radius);
        let [a, b] = [self.tree.pose(link)?, self.tree.pose(next)?].map(|pose| self.plane.height(&pose.at));
        let least = Interval { lower: (&a.lower).min(&b.lower).clone(), upper: (&a.upper).min(&b.upper).clone() };
        let most = Interval { lower: a.lower.max(b.lower), upper: a.upper.max(b.upper) };
        let heights = Some([&least - &radius, &most + &radius]);
        let body =
            Body { link: last, shape: Shape { points: vec![[0, 0].map(Interval::whole), end], radius }, heights };
        Ok(Counted { link: link.to_owned(), kind: "bar", number: 0, around: body.clone(), within: body })
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

    /// Whether a joint that lowers the tool carries a link.
    ///
    /// # Errors
    /// A joint that is not there, or does not slide along the plane's normal.
    pub fn lowers(&self, joint: &str, link: &str) -> Read<bool> {
        let (node, _) = self.of_the_tool(joint, "stroke")?;
        let link = self.tree.order.iter().find(|name| **name == link);
        Ok(link.map_or(Ok(Vec::new()), |link| self.tree.above(link))?.contains(&node))
    }

    /// How far from the first joint's origin the tip gets at most.
    pub fn tip_reach(&self) -> BigInt {
        let slide = |joint: &Joint| match (&joint.motion, &joint.axis) {
            (Motion::Slide(_), Axis::Line(range)) => Interval::around(range).magnitude(),
            _ => BigInt::ZERO,
        };
        let links = &length(&self.offset) + &length(&self.tip.shape.points[0]);
        self.joints.iter().map(slide).sum::<BigInt>() + links.upper
    }

    /// By how much objects may press into what supports them: a share of how far the arm reaches, from the first joint to the second, and on
    /// to where its shapes or the tip are.
    pub fn pressed(&self) -> Interval {
        let greatest = |link: usize, first: Interval| {
            let own = self.shapes.iter().map(|shape| &shape.around).filter(|body| body.link == link);
            let all = own.flat_map(|body| body.shape.points.iter().map(|p| &length(p) + &body.shape.radius));
            all.fold(first, |a, b| if b.lower > a.lower { b } else { a })
        };
        let out = &length(&self.offset) + &greatest(1, length(&self.tip.shape.points[0]));
        let near = greatest(0, Interval::whole(0));
        &(if near.lower > out.lower { near } else { out }) * &Interval::from(&Decimal::power_of_ten(PRESSED))
    }
}
