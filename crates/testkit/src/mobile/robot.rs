//! A robot with two driven wheels: a disc that moves forwards and turns.

use super::floor::Floor;
use cplan::Point;
use cplan::nalgebra::Vector2;
use std::f64::consts::{PI, TAU};

/// Position and heading of a robot, counter-clockwise from x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Middle between the wheels, metres.
    pub at: Point,
    /// Heading, in radians.
    pub heading: f64,
}

impl Pose {
    /// Returns the pose after a time at constant linear (m/s) and angular speed (rad/s), on an exact arc of a circle.
    pub fn after(self, speed: f64, turn: f64, seconds: f64) -> Self {
        let half = 0.5 * turn * seconds;
        // The chord of the arc has the arc's length times sin(half) / half.
        let sinc = if half.abs() < 1e-8 { 1.0 } else { half.sin() / half };
        let middle = self.heading + half;
        let chord = speed * seconds * sinc * Vector2::new(middle.cos(), middle.sin());
        Self { at: self.at + chord, heading: self.heading + 2.0 * half }
    }

    /// Returns the point at a distance straight ahead.
    pub fn ahead(self, distance: f64) -> Point {
        self.at + distance * Vector2::new(self.heading.cos(), self.heading.sin())
    }
}

/// Returns an angle between -pi and pi.
pub fn wrapped(angle: f64) -> f64 {
    let turned = (angle + PI).rem_euclid(TAU);
    turned - PI
}

/// Longest part of a motion between two checks for obstacles, in seconds.
const STEP: f64 = 0.02;

/// Distance between body and obstacles that counts as touching, in metres. It is far above rounding errors, and invisible.
const TOUCHING: f64 = 1e-6;

/// A robot that drives over a floor. Its body never enters an obstacle: such a motion only turns the robot, as if its bumpers had
/// stopped it.
pub struct Robot<'a> {
    /// The floor.
    pub floor: &'a Floor,
    /// Current pose.
    pub pose: Pose,
    /// Poses after each step of its motion.
    pub track: Vec<Pose>,
    /// Length of the robot's path, in metres.
    pub length: f64,
    /// Time that has passed, seconds.
    pub time: f64,
    /// Positions at which steps were refused.
    pub refused: Vec<Point>,
}

impl<'a> Robot<'a> {
    /// Creates a robot that has not moved.
    pub fn new(floor: &'a Floor, at: [f64; 2], heading: f64) -> Self {
        let pose = Pose { at: at.into(), heading };
        Self { floor, pose, track: vec![pose], length: 0.0, time: 0.0, refused: Vec::new() }
    }

    /// Drives at constant speeds for this many seconds.
    pub fn drive(&mut self, speed: f64, turn: f64, seconds: f64) {
        let steps = (seconds / STEP).ceil();
        let step = seconds / steps;
        for _ in 0..steps as usize {
            let next = self.pose.after(speed, turn, step);
            self.time += step;
            if speed == 0.0 || self.floor.gap(next.at) > TOUCHING {
                self.length += (speed * step).abs();
                self.pose = next;
            } else {
                self.refused.push(self.pose.at);
                self.pose.heading = next.heading;
            }
            self.track.push(self.pose);
        }
    }

    /// Returns the robot's positions, for pictures.
    pub fn way(&self) -> Vec<Point> {
        self.track.iter().map(|pose| pose.at).collect()
    }
}
