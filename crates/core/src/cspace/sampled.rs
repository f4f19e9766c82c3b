//! The grid by collision tests: parry2d's verdict at every centre. Slow. It is an oracle that shares no code with
//! slices, and a space for field planners to compare with. All code that uses parry2d is here.

use super::{Grid, Proves};
use crate::model::Scene;
use crate::space::Configuration;
use cplan_geometry::Convex;
use cplan_interrupt::checkpoint;
use parry2d_f64::math::{Pose, Rotation, Vector};
use parry2d_f64::query::intersection_test;
use parry2d_f64::shape::{Ball, Capsule, ConvexPolygon, RoundShape, Segment, Shape};

/// Computes the grid whose cells are blocked where parry2d finds that the shapes, grown by `clearance`, meet at the
/// cell's centre.
///
/// One check per cell and pair, after a test of the discs around the shapes; the first contact settles the cell.
#[must_use]
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
    grid
}

/// A shape of parry2d and its pose in its link's (or the plane's) frame.
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
                // parry2d refuses a polygon without area; the disc around it keeps the answer on the safe side.
                None => {
                    local = Pose::from_translation(center);
                    Box::new(Ball::new(extent))
                }
            },
        };
        Self { shape, local, center, extent }
    }

    /// Returns true if this solid, moved by `pose`, meets a fixed one.
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
