//! The outlines of the two arm links: which of the URDF's geometry makes them up.

use super::chain::Chain;
use super::document::Document;
use super::mesh;
use super::plane::project;
use super::solid::{Solid, capsule};
use super::tree::{Tree, isometry};
use crate::geometry::{Convex, Point, Vector, separation};
use crate::input::error::{Diagnostic, InputError};
use crate::input::world::World;
use crate::model::{Heights, Link, OutlineSource, Part, Plane};
use crate::text::counted;
use nalgebra::{Isometry3, Translation2, Vector3};
use std::ops::Range;
use urdf_rs::Geometry;

/// Corners of the largest outline that stays one shape: what is asked of it takes time that grows with them.
const MOST_CORNERS: usize = 1024;

/// Everything that the outlines are made from.
pub(super) struct Bodies<'a> {
    pub document: &'a Document,
    pub tree: &'a Tree,
    pub chain: &'a Chain,
    pub world: &'a World,
    pub plane: &'a Plane,
    /// Poses of all links in the root frame, the two joints at 0.
    pub poses: &'a [Isometry3<f64>],
}

/// Which of a link's geometry.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Collision,
    Visual,
}

/// What an arm link's geometry of one kind comes to.
#[derive(Default)]
struct Found {
    parts: Vec<Part>,
    /// Bodies with a shape without any size.
    empty: Vec<String>,
    /// Meshes that cannot be used.
    unread: Vec<Diagnostic>,
    /// Shapes of which it is not known what they cover.
    uncertain: Vec<Diagnostic>,
}

/// What a shape covers, whichever way it is turned about a point, and what it covers at all angles; none if that is nothing. `certain` is what is within
/// the shape.
fn all_round(axis: Point, shape: &Convex, certain: &Convex) -> Option<(Convex, Option<Convex>)> {
    let is_disc = |convex: &Convex| convex.core().len() == 1 && (convex.core()[0] - axis).norm() <= OFF_AXIS;
    if is_disc(shape) && is_disc(certain) {
        return Some((shape.clone(), (certain != shape).then(|| certain.clone())));
    }
    let within = -separation(&Convex::point(axis), certain).distance * (1.0 - OFF_AXIS);
    let disc = |radius: f64| Convex::trusted(vec![axis], radius);
    (within > 0.0).then(|| (disc(shape.reach_from(axis)), Some(disc(within))))
}

/// How far from its axis a disc may be that is about it, metres; and a share of what is known of others.
const OFF_AXIS: f64 = 1e-9;

/// Two links, and what the user should know of them.
pub(super) struct Outlines {
    pub links: [Link; 2],
    pub geometry: Vec<String>,
    pub notes: Vec<String>,
    pub warnings: Vec<String>,
}

impl Bodies<'_> {
    /// Both links' outlines, in their frames: origin at the joint.
    ///
    /// # Errors
    /// When a mesh cannot be used and the world asks for no bar instead, or when neither link has an outline.
    pub fn outlines(&self) -> Result<Outlines, InputError> {
        let bar = self.bar()?;
        let (mut notes, mut warnings) = (Vec::new(), Vec::new());
        let links = [self.link(0, bar, &mut notes, &mut warnings)?, self.link(1, bar, &mut notes, &mut warnings)?];
        if links.iter().all(|l| l.source == OutlineSource::None) {
            let message = format!(
                "neither link \"{}\" nor link \"{}\" has collision or visual geometry: nothing of the arm can be hit",
                links[0].name, links[1].name
            );
            let help = "add <collision> geometry to the URDF, or let bars between the joints stand in for the links, in the \
                        world file: [robot] bar = 0.05 (their radius in metres)";
            return Err(self.document.source.diagnostic(message).help(help).into());
        }
        let geometry = links.iter().enumerate().map(|(index, link)| self.described(index, link)).collect();
        Ok(Outlines { links, geometry, notes, warnings })
    }

    fn bar(&self) -> Result<Option<f64>, Diagnostic> {
        let Some(bar) = &self.world.robot.bar else { return Ok(None) };
        let radius = *bar.get_ref();
        if radius.is_finite() && radius > 0.0 {
            return Ok(Some(radius));
        }
        let message = format!("[robot] bar: the radius must be positive, is {radius}");
        Err(self.world.source.diagnostic_at(bar.span(), message).help("bar = 0.05, metres"))
    }

    fn link(
        &self,
        index: usize,
        bar: Option<f64>,
        notes: &mut Vec<String>,
        warnings: &mut Vec<String>,
    ) -> Result<Link, InputError> {
        let name = self.tree.links[self.tree.child[self.chain.joints[index]]].clone();
        let bodies = self.bodies(index);
        let mut source = OutlineSource::Collision;
        let mut found = self.gather(index, &bodies, Kind::Collision);
        if found.parts.is_empty() && found.unread.is_empty() {
            let empty = std::mem::take(&mut found.empty);
            found = self.gather(index, &bodies, Kind::Visual);
            found.empty.extend(empty);
            source = OutlineSource::Visual;
        }
        found.empty.sort();
        found.empty.dedup();
        if !found.empty.is_empty() {
            let bodies = found.empty.join(", ");
            notes.push(format!("link {} \"{name}\": shapes of size zero are ignored (in {bodies})", index + 1));
        }
        let Found { mut parts, unread, uncertain, .. } = found;
        InputError::check(uncertain)?;
        if !unread.is_empty() || parts.is_empty() {
            match bar {
                Some(radius) => {
                    for diagnostic in &unread {
                        warnings.push(format!("{}; the bar stands in for it", diagnostic.message));
                    }
                    parts.push(self.bar_part(index, radius, &name));
                    source = OutlineSource::Bar;
                }
                None => {
                    InputError::check(unread)?;
                    source = OutlineSource::None;
                }
            }
        }
        if source == OutlineSource::None {
            warnings.push(format!(
                "link {} \"{name}\" has no geometry, so it cannot collide ([robot] bar = RADIUS gives it one)",
                index + 1
            ));
        }
        let link = Link { name, parts, source };
        if matches!(source, OutlineSource::Visual | OutlineSource::Bar) {
            notes.push(self.described(index, &link));
        }
        Ok(link)
    }

    fn described(&self, index: usize, Link { name, parts, source }: &Link) -> String {
        format!("link {} \"{name}\": {}", index + 1, self.summary(*source, parts))
    }

    fn summary(&self, source: OutlineSource, parts: &[Part]) -> String {
        let shapes = counted(parts.len(), "shape");
        match source {
            OutlineSource::Collision => format!("outline from the collision geometry ({shapes})"),
            OutlineSource::Visual => {
                format!("outline from the visual geometry, for want of collision geometry ({shapes})")
            }
            OutlineSource::Bar if parts.len() > 1 => {
                format!("outline from the collision geometry and a bar ({shapes})")
            }
            OutlineSource::Bar => "outline is a bar between the joints, as the world file asks".to_owned(),
            OutlineSource::None => "no outline: it has no geometry".to_owned(),
        }
    }

    /// The URDF links that arm link `index` is made of, in the order of the file.
    pub fn bodies(&self, index: usize) -> Vec<usize> {
        let [first, second] = self.chain.joints;
        (0..self.document.robot.links.len())
            .filter(|l| match index {
                0 => self.tree.carries(first, *l) && !self.tree.carries(second, *l),
                _ => self.tree.carries(second, *l),
            })
            .collect()
    }

    fn gather(&self, index: usize, bodies: &[usize], kind: Kind) -> Found {
        let mut found = Found::default();
        let to_link = Translation2::from(-self.joint_at(index).0.coords);
        for body in bodies {
            let link = &self.document.robot.links[*body];
            let place = &self.document.links[*body];
            let mut number = 0;
            let shapes: Vec<(&urdf_rs::Pose, &Geometry, &Range<usize>)> = match kind {
                Kind::Collision => {
                    link.collision.iter().zip(&place.collision).map(|(c, at)| (&c.origin, &c.geometry, at)).collect()
                }
                Kind::Visual => {
                    link.visual.iter().zip(&place.visual).map(|(v, at)| (&v.origin, &v.geometry, at)).collect()
                }
            };
            for (origin, geometry, at) in shapes {
                let solid = match self.solid(geometry) {
                    Ok(solid) if solid.is_nothing() => {
                        found.empty.push(format!("\"{}\"", link.name));
                        continue;
                    }
                    Ok(solid) => solid,
                    Err(mesh::Unread { message, cure }) => {
                        let message = format!("link \"{}\": {message}", link.name);
                        found.unread.push(self.document.diagnostic_at(at, message).help(cure));
                        continue;
                    }
                };
                let pose = self.poses[*body] * isometry(origin);
                let shape = solid.outline(&pose, self.plane).at(&to_link.into());
                let inner = solid.inner(&pose, self.plane).map(|inner| inner.at(&to_link.into()));
                let heights = solid.heights(&pose, self.plane);
                let (shape, inner) = match self.wrist_axis(*body).map(|axis| to_link * axis) {
                    Some(axis) => match all_round(axis, &shape, inner.as_ref().unwrap_or(&shape)) {
                        Some(all_round) => all_round,
                        None => {
                            let message = format!(
                                "link \"{}\" turns with the wrist and is not about its axis, so that what it covers is another thing at each angle",
                                link.name
                            );
                            let help = "give it <collision> geometry that covers it all round: a <cylinder> along the axis of the wrist's joint";
                            found.uncertain.push(self.document.diagnostic_at(at, message).help(help));
                            continue;
                        }
                    },
                    None => (shape, inner),
                };
                let shapes = if shape.core().len() > MOST_CORNERS { shape.cut_up() } else { vec![shape] };
                let part = |shape| Part { shape, inner: inner.clone(), number, heights, body: link.name.clone() };
                found.parts.extend(shapes.into_iter().map(part));
                number += 1;
            }
        }
        found
    }

    /// Where the wrist's axis is that a link turns about while steps are done.
    fn wrist_axis(&self, body: usize) -> Option<Point> {
        let name = self.world.robot.wrist_joint().filter(|_| self.world.steps.is_some())?;
        let joint = self.document.robot.joints.iter().position(|joint| joint.name == *name.get_ref())?;
        self.tree.carries(joint, body).then(|| self.at(self.tree.child[joint]).0)
    }

    fn solid(&self, geometry: &Geometry) -> Result<Solid, mesh::Unread> {
        Ok(match geometry {
            Geometry::Box { size } => Solid::Box { half: Vector3::from(size.0) / 2.0 },
            Geometry::Cylinder { radius, length } => Solid::Cylinder { radius: *radius, half: length / 2.0 },
            Geometry::Capsule { radius, length } => Solid::Capsule { radius: *radius, half: length / 2.0 },
            Geometry::Sphere { radius } => Solid::Sphere { radius: *radius },
            Geometry::Mesh { filename, scale } => {
                let scale = scale.map_or([1.0; 3], |s| s.0);
                Solid::Points(mesh::vertices(filename, scale, &self.document.source)?)
            }
        })
    }

    /// Where a joint is: in the plane, and its height.
    pub fn joint_at(&self, index: usize) -> (Point, f64) {
        self.at(self.tree.child[self.chain.joints[index]])
    }

    fn at(&self, link: usize) -> (Point, f64) {
        let at = self.poses[link].translation.vector;
        (project(self.plane, &at), at.dot(&self.plane.normal))
    }

    /// The capsule from joint 1 to joint 2, or from joint 2 to the tip.
    fn bar_part(&self, index: usize, radius: f64, body: &str) -> Part {
        let (from, low) = self.joint_at(index);
        let (to, high) = if index == 0 { self.joint_at(1) } else { self.at(self.chain.tip) };
        Part {
            inner: None,
            number: 0,
            shape: capsule(Point::origin(), Point::from(Vector::from(to - from)), radius),
            heights: Heights { lower: low.min(high) - radius, upper: low.max(high) + radius },
            body: body.to_owned(),
        }
    }
}
