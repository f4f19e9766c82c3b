//! The grid from slow collision tests by parry2d at all centres. Tests use it as an oracle that shares no code with
//! slices, and field planners can use it as a space. Only this file uses parry2d.

use super::{Grid, Proves};
use cplan_geometry::Convex;
use cplan_interrupt::checkpoint;
use cplan_model::Scene;
use cplan_model::space::Configuration;
use parry2d_f64::math::{Pose, Rotation, Vector};
use parry2d_f64::query::intersection_test;
use parry2d_f64::shape::{Ball, Capsule, ConvexPolygon, RoundShape, Segment, Shape};

/// Computes a grid by parry2d. A cell is blocked if some pair of shapes meets at its centre, with obstacles grown by
/// `clearance`.
///
/// Each pair is tested once per cell, after a test of the discs around the two shapes. The first contact decides the
/// cell.
pub fn sampled_grid(scene: &Scene, cells: [usize; 2], clearance: f64) -> Grid {
    let pairs: Vec<(usize, Solid, Solid)> = scene
        .pairs()
        .iter()
        .map(|&pair| (pair.link, Solid::new(scene.part(pair), 0.0), Solid::new(scene.piece(pair), clearance)))
        .collect();
    let mut grid = Grid {
        topology: scene.arm().topology(),
        proves: Proves::Sampled,
        cells,
        blocked: vec![false; cells[0] * cells[1]],
    };
    for index in 0..grid.blocked.len() {
        checkpoint();
        let q: Configuration = grid.center(index);
        let poses = scene.arm().pair_poses(q).map(|p| pose(&p));
        grid.blocked[index] = pairs.iter().any(|(link, part, piece)| part.meets(&poses[*link], piece));
    }
    grid.block_sums();
    grid
}

/// A shape of parry2d, with its pose in the frame of its link, or in the plane.
struct Solid {
    shape: Box<dyn Shape>,
    local: Pose,
    center: Vector,
    extent: f64,
}

impl Solid {
    fn new(convex: &Convex, grow: f64) -> Self {
        let core: Vec<Vector> = convex.core().iter().map(|p| Vector::new(p.x, p.y)).collect();
        let radius = convex.radius() + grow;
        let center = core.iter().sum::<Vector>() / core.len() as f64;
        let extent = core.iter().map(|p| p.distance(center)).fold(0.0, f64::max) + radius;
        let mut local = Pose::identity();
        let shape: Box<dyn Shape> = match (&core[..], radius > 0.0) {
            (&[at], _) => {
                local = Pose::from_translation(at);
                Box::new(Ball::new(radius))
            }
            (&[a, b], true) => Box::new(Capsule::new(a, b, radius)),
            (&[a, b], false) => Box::new(Segment::new(a, b)),
            _ => match ConvexPolygon::from_convex_polyline_unmodified(core.clone()) {
                Some(inner_shape) if radius > 0.0 => Box::new(RoundShape { inner_shape, border_radius: radius }),
                Some(polygon) => Box::new(polygon),
                // parry2d refuses polygons without area. The disc around the polygon is a conservative replacement.
                None => {
                    local = Pose::from_translation(center);
                    Box::new(Ball::new(extent))
                }
            },
        };
        Self { shape, local, center, extent }
    }

    /// Returns true if this solid, moved by `pose`, meets a solid in the plane.
    fn meets(&self, pose: &Pose, fixed: &Solid) -> bool {
        let reach = self.extent + fixed.extent;
        if pose.transform_point(self.center).distance_squared(fixed.center) > reach * reach {
            return false;
        }
        intersection_test(&(*pose * self.local), &*self.shape, &fixed.local, &*fixed.shape)
            .expect("parry2d tests all pairs of convex shapes")
            .intersecting
    }
}

/// Converts a nalgebra pose to parry2d's glam pose.
fn pose(pose: &cplan_geometry::Pose) -> Pose {
    let (translation, rotation) = (pose.translation, pose.rotation);
    Pose::from_parts(Vector::new(translation.x, translation.y), Rotation { re: rotation.re, im: rotation.im })
}
