//! A configuration space by collision tests at the centres of its cells, as one writes it with parry2d. Values that are
//! constant along a row are computed once per row, discs around the shapes are tested before the exact test, and the
//! first hit decides.

use crate::scenes::Bars;
use parry2d::math::{Pose, Rotation, Vector};
use parry2d::query::details::intersection_test_support_map_support_map as meet;
use parry2d::shape::ConvexPolygon;

/// A polygon, and a disc that contains it.
struct Solid {
    shape: ConvexPolygon,
    center: Vector,
    radius: f32,
}

impl Solid {
    fn new(corners: &[[f64; 2]]) -> Self {
        let points: Vec<Vector> = corners.iter().map(|p| Vector::new(p[0] as f32, p[1] as f32)).collect();
        let center = points.iter().sum::<Vector>() / points.len() as f32;
        let radius = points.iter().map(|p| p.distance(center)).fold(0.0, f32::max);
        let shape = ConvexPolygon::from_convex_polyline_unmodified(points).expect("obstacles and links have an area");
        Self { shape, center, radius }
    }
}

/// Returns the pose of a link whose origin is `at` and which is turned by the angle with this cosine and sine.
fn placed(at: Vector, cos: f32, sin: f32) -> Pose {
    Pose::from_parts(at, Rotation { re: cos, im: sin })
}

pub struct Arm {
    links: [Solid; 2],
    elbow: f32,
    obstacles: Vec<Solid>,
}

impl Arm {
    pub fn new(bars: &Bars, obstacles: &[Vec<[f64; 2]>]) -> Self {
        Self {
            links: [Solid::new(&bars.links[0]), Solid::new(&bars.links[1])],
            elbow: bars.elbow as f32,
            obstacles: obstacles.iter().map(|corners| Solid::new(corners)).collect(),
        }
    }

    /// Returns, row by row, whether the arm collides at the centre of each cell. `first` and `second` are the values of
    /// the joints at the centres.
    pub fn cells(&self, first: &[f64], second: &[f64]) -> Vec<bool> {
        let mut blocked = vec![false; first.len() * second.len()];
        let turns: Vec<(f32, f32)> = second.iter().map(|q| (q.cos() as f32, q.sin() as f32)).collect();
        let [upper, fore] = &self.links;
        let reach = fore.center.length() + fore.radius;
        let mut near: Vec<&Solid> = Vec::new();
        for (q1, row) in first.iter().zip(blocked.chunks_exact_mut(second.len())) {
            let (cos, sin) = (q1.cos() as f32, q1.sin() as f32);
            let pose = placed(Vector::ZERO, cos, sin);
            if self.obstacles.iter().any(|obstacle| hits(upper, &pose, obstacle)) {
                row.fill(true);
                continue;
            }
            let elbow = Vector::new(self.elbow * cos, self.elbow * sin);
            near.clear();
            let reached = self.obstacles.iter().filter(|o| o.center.distance(elbow) <= reach + o.radius);
            near.extend(reached);
            for (&(c, s), blocked) in turns.iter().zip(row) {
                let pose = placed(elbow, cos * c - sin * s, sin * c + cos * s);
                *blocked = near.iter().any(|obstacle| hits(fore, &pose, obstacle));
            }
        }
        blocked
    }
}

fn hits(link: &Solid, pose: &Pose, obstacle: &Solid) -> bool {
    let reach = link.radius + obstacle.radius;
    pose.transform_point(link.center).distance_squared(obstacle.center) <= reach * reach
        && meet(&pose.inverse(), &link.shape, &obstacle.shape)
}
