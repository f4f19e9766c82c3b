//! The shapes of URDF links at their poses: collision geometry, or visual geometry of links without any.

use super::bodies::Bodies;
use super::mesh;
use super::solid::Solid;
use super::tree::isometry;
use crate::error::Diagnostic;
use cplan_model::Heights;
use nalgebra::{Isometry3, Vector3};
use std::ops::Range;
use urdf_rs::Geometry;

/// A shape at its pose, with the two arm joints at 0.
pub(super) struct PlacedShape {
    /// The URDF link.
    pub link: usize,
    /// Index among the link's shapes of the same kind that have a size.
    pub number: usize,
    /// True for visual geometry.
    pub is_visual: bool,
    pub solid: Solid,
    /// Pose in the root frame.
    pub pose: Isometry3<f64>,
    pub heights: Heights,
    /// Place in the file.
    pub at: Range<usize>,
}

/// The shapes of some URDF links, and the problems that occurred in reading them.
#[derive(Default)]
pub(super) struct GatheredShapes {
    pub shapes: Vec<PlacedShape>,
    /// Links that have a shape of size zero.
    pub empty: Vec<String>,
    /// Collision meshes that cannot be used.
    pub unread: Vec<Diagnostic>,
    /// Visual meshes, of links without collision geometry, that cannot be used.
    pub unseen: Vec<Diagnostic>,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Collision,
    Visual,
}

impl Bodies<'_> {
    /// Collects the shapes of these URDF links. Visual geometry represents a link without collision geometry.
    pub fn gather(&self, links: impl IntoIterator<Item = usize>) -> GatheredShapes {
        let mut gathered = GatheredShapes::default();
        for link in links {
            let before = gathered.shapes.len() + gathered.unread.len();
            self.gather_kind(link, Kind::Collision, &mut gathered);
            if gathered.shapes.len() + gathered.unread.len() == before {
                self.gather_kind(link, Kind::Visual, &mut gathered);
            }
        }
        gathered.empty.sort();
        gathered.empty.dedup();
        gathered
    }

    fn gather_kind(&self, index: usize, kind: Kind, gathered: &mut GatheredShapes) {
        let (link, place) = (&self.document.robot.links[index], &self.document.links[index]);
        let shapes: Vec<(&urdf_rs::Pose, &Geometry, &Range<usize>)> = match kind {
            Kind::Collision => {
                link.collision.iter().zip(&place.collision).map(|(c, at)| (&c.origin, &c.geometry, at)).collect()
            }
            Kind::Visual => link.visual.iter().zip(&place.visual).map(|(v, at)| (&v.origin, &v.geometry, at)).collect(),
        };
        let mut number = 0;
        for (origin, geometry, at) in shapes {
            match self.solid(geometry) {
                Ok(solid) if solid.has_no_size() => gathered.empty.push(format!("\"{}\"", link.name)),
                Ok(solid) => {
                    let pose = self.poses[index] * isometry(origin);
                    let (heights, is_visual) = (solid.heights(&pose, self.plane), kind == Kind::Visual);
                    let at = at.clone();
                    gathered.shapes.push(PlacedShape { link: index, number, is_visual, solid, pose, heights, at });
                    number += 1;
                }
                Err(mesh::UnreadableMesh { message, cure }) => {
                    let message = format!("link \"{}\": {message}", link.name);
                    let diagnostic = self.document.diagnostic_at(at, message).help(cure);
                    match kind {
                        Kind::Collision => gathered.unread.push(diagnostic),
                        Kind::Visual => gathered.unseen.push(diagnostic),
                    }
                }
            }
        }
    }

    fn solid(&self, geometry: &Geometry) -> Result<Solid, mesh::UnreadableMesh> {
        Ok(match geometry {
            Geometry::Box { size } => Solid::Box { half: Vector3::from(size.0) / 2.0 },
            Geometry::Cylinder { radius, length } => Solid::Cylinder { radius: *radius, half: length / 2.0 },
            Geometry::Capsule { radius, length } => Solid::Capsule { radius: *radius, half: length / 2.0 },
            Geometry::Sphere { radius } => Solid::Sphere { radius: *radius },
            Geometry::Mesh { filename, scale } => {
                let scale = scale.map_or([1.0; 3], |s| s.0);
                Solid::Mesh(mesh::read(filename, scale, self.document)?)
            }
        })
    }
}
