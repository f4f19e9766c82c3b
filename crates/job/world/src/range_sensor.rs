//! A range sensor on an arm.

use cplan_geometry::{Point, Vector};
use cplan_model::Arm;
use nalgebra::Rotation2;
use serde::Serialize;
use std::f64::consts::TAU;

/// The body to which a sensor is attached.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Mount {
    /// The tip. Straight ahead is the direction from the origin of link 2 to the tip, or link 2's x axis if both coincide.
    Tip,
    /// The base, which does not move. Straight ahead is the robot's x axis.
    Base,
}

/// A range sensor: a fan of rays that measure distances to obstacles. The arm does not block the rays.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Sensor {
    /// The body to which the sensor is attached.
    pub mount: Mount,
    /// Angle of the robot in the world, in radians.
    pub turn: f64,
    /// Number of rays, at least one.
    pub rays: usize,
    /// Angle between the outermost rays, in radians, at most a whole turn. The rays are evenly spaced.
    pub field_of_view: f64,
    /// Length of the rays, in metres.
    pub range: f64,
    /// Distance between readings on a path, in joint space (mixing radians and metres).
    pub step: f64,
    /// Greatest error of a measured distance, in metres. Errors are uniformly distributed between plus and minus this.
    pub noise: f64,
    /// Seed of the random errors.
    pub seed: u64,
    /// Side of a cell of the map, in metres.
    pub cell: f64,
}

impl Sensor {
    /// Default number of map cells along the arm's reach.
    const DEFAULT_CELLS: f64 = 40.0;

    /// Returns the default sensor of an arm. It is mounted at the tip and has no errors; its range is half the arm's reach. It
    /// takes a reading every tenth of a radian or metre. Its 360 rays point in all directions, because the arm mostly moves
    /// sideways, not straight ahead.
    pub fn default_for(arm: &Arm) -> Self {
        let cell = arm.reach() / Self::DEFAULT_CELLS;
        let range = arm.reach() / 2.0;
        Self {
            mount: Mount::Tip,
            turn: 0.0,
            rays: 360,
            field_of_view: TAU,
            range,
            step: 0.1,
            noise: 0.0,
            seed: 0,
            cell,
        }
    }

    /// Returns the position of the sensor, and the angle of its forward direction in radians.
    pub fn pose(&self, arm: &Arm, q: [f64; 2]) -> (Point, f64) {
        match self.mount {
            Mount::Base => (arm.base, self.turn),
            Mount::Tip => {
                let pose = arm.pose(1, q.into());
                let x = Rotation2::new(self.turn) * Vector::x();
                let ahead = if arm.tip == Point::zeros() { x } else { arm.tip };
                let ahead = pose.direction(ahead);
                (pose.point(arm.tip), ahead.y.atan2(ahead.x))
            }
        }
    }

    /// Iterates over the angles of the rays, from right to left, in radians.
    pub fn rays(&self, ahead: f64) -> impl Iterator<Item = f64> + use<> {
        let sensor = *self;
        (0..self.rays).map(move |k| sensor.ray(ahead, k))
    }

    /// Returns the angle of ray `k`, in radians.
    pub fn ray(&self, ahead: f64, k: usize) -> f64 {
        let first = if self.rays == 1 { ahead } else { ahead - self.field_of_view / 2.0 };
        first + self.field_of_view * (k as f64 / self.gaps() as f64)
    }

    /// Returns the number of gaps between rays. A field of view of a whole turn has one more gap, between the last ray and the
    /// first.
    fn gaps(&self) -> usize {
        if self.field_of_view < TAU { self.rays.max(2) - 1 } else { self.rays }
    }

    /// Iterates over the indices of the rays within `angle` of a direction. If the angle is half a turn or more, a ray may occur
    /// twice.
    pub fn rays_about(&self, ahead: f64, direction: f64, angle: f64) -> impl Iterator<Item = usize> + use<> {
        let (rays, gap) = (self.rays, self.field_of_view / self.gaps() as f64);
        let from_first = (direction - self.ray(ahead, 0)).rem_euclid(TAU);
        [-TAU, 0.0, TAU].into_iter().flat_map(move |turn| {
            let middle = from_first + turn;
            let from = ((middle - angle) / gap).ceil().max(0.0) as usize;
            let to = ((middle + angle) / gap).floor() + 1.0;
            from..(to.max(0.0) as usize).min(rays)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_geometry::ConvexError;
    use std::f64::consts::PI;

    #[test]
    fn rays_fan_out_about_straight_ahead() -> Result<(), ConvexError> {
        let arm = Arm::rr([1.0, 0.5], 0.1)?;
        let sensor = Sensor { rays: 3, field_of_view: PI, ..Sensor::default_for(&arm) };
        let (at, ahead) = sensor.pose(&arm, [PI / 2.0, -PI / 2.0]);
        assert!((at - Point::new(0.5, 1.0)).norm() < 1e-12 && ahead.abs() < 1e-12, "{at} {ahead}");
        let rays: Vec<f64> = sensor.rays(ahead).collect();
        assert!(rays.iter().zip([-PI / 2.0, 0.0, PI / 2.0]).all(|(a, b)| (a - b).abs() < 1e-12), "{rays:?}");
        let round = Sensor { field_of_view: TAU, rays: 4, ..sensor };
        let rays: Vec<f64> = round.rays(0.0).collect();
        assert!(rays.windows(2).all(|w| (w[1] - w[0] - TAU / 4.0).abs() < 1e-12), "{rays:?}");
        assert_eq!(Sensor { rays: 1, ..sensor }.rays(0.3).collect::<Vec<_>>(), [0.3]);
        let turned = Sensor { mount: Mount::Base, turn: 0.7, ..sensor };
        assert_eq!(turned.pose(&arm, [1.0, 2.0]), (arm.base, 0.7));
        let (at, ahead) = Sensor { mount: Mount::Base, ..sensor }.pose(&arm, [1.0, 2.0]);
        assert_eq!((at, ahead), (arm.base, 0.0));
        Ok(())
    }

    #[test]
    fn rays_about_a_direction_are_those_no_farther_from_it() -> Result<(), ConvexError> {
        let usual = Sensor::default_for(&Arm::rr([1.0, 0.5], 0.1)?);
        for (rays, field_of_view) in [(1, 1.0), (7, PI), (97, TAU - 0.1), (180, TAU)] {
            let sensor = Sensor { rays, field_of_view, ..usual };
            for k in 0..500 {
                let [ahead, direction] = [0.37, 0.91].map(|step| (f64::from(k) * step) % (3.0 * PI) - PI);
                let angle = f64::from(k % 9) * 0.31 + 0.01;
                let mut about: Vec<usize> = sensor.rays_about(ahead, direction, angle).collect();
                about.sort_unstable();
                about.dedup();
                let apart = |ray: f64| (ray - direction).cos().clamp(-1.0, 1.0).acos();
                let near = (0..rays).filter(|&ray| apart(sensor.ray(ahead, ray)) <= angle);
                assert_eq!(about, near.collect::<Vec<_>>(), "{rays} rays ahead {ahead}, {angle} about {direction}");
            }
        }
        Ok(())
    }
}
