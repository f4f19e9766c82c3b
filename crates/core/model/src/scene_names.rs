//! The obstacles of a scene by number, and descriptions of its shapes for messages.

use super::{Carrier, Obstacle, Pair, Scene, SelfObstacle};
use cplan_text::{chosen_length, length};
use std::collections::BTreeSet;
use std::ops::Range;

impl Scene {
    /// Returns the obstacle with this index: a static one, a loose one (in its own frame), or a link of the robot.
    ///
    /// # Panics
    /// If there is no obstacle with this index.
    pub fn obstacle(&self, number: usize) -> &Obstacle {
        let static_obstacles = self.workspace().obstacles.len();
        if let Some(obstacle) = self.workspace().obstacles.get(number) {
            return obstacle;
        }
        let loose = self.loose_obstacles().get(number - static_obstacles).map(|loose| &loose.obstacle);
        loose.unwrap_or_else(|| {
            &self.arm().self_obstacles[number - static_obstacles - self.loose_obstacles().len()].obstacle
        })
    }

    /// Returns the arm's self obstacle with this index; `None` for static and loose obstacles.
    pub fn self_obstacle(&self, number: usize) -> Option<&SelfObstacle> {
        self.arm().self_obstacles.get(number.checked_sub(self.self_obstacles().start)?)
    }

    /// Returns the indices of the arm's self obstacles. They follow those of the static and the loose obstacles.
    pub fn self_obstacles(&self) -> Range<usize> {
        let first = self.workspace().obstacles.len() + self.loose_obstacles().len();
        first..first + self.arm().self_obstacles.len()
    }

    /// Returns the self obstacles that pictures and files list among the obstacles, in ascending order: those that have a
    /// fixed place, and those that something can hit.
    pub fn listed_self_obstacles(&self) -> Vec<usize> {
        let hit: BTreeSet<usize> = self.pairs().iter().map(|pair| pair.obstacle).collect();
        let is_fixed = |own: &SelfObstacle| own.carrier != Carrier::FirstJoint;
        let is_listed = |number: &usize| self.self_obstacle(*number).is_some_and(is_fixed) || hit.contains(number);
        self.self_obstacles().filter(is_listed).collect()
    }

    /// Returns the index of a link's first layer if the obstacle is one of several layers of a link of the robot.
    /// Otherwise returns `number`.
    pub fn first_layer(&self, number: usize) -> usize {
        let name = &self.obstacle(number).name;
        let mut layers = self.self_obstacles().filter(|&layer| self.obstacle(layer).name == *name);
        if number < self.self_obstacles().start { number } else { layers.next().unwrap_or(number) }
    }

    /// Describes a pair in words: `link "forearm" and obstacle "shelf"`.
    pub fn describe(&self, pair: Pair) -> String {
        format!("{} and {}", self.describe_part(pair), self.describe_obstacle(pair.obstacle))
    }

    /// States that a part is too near to an obstacle: `link "forearm" hits obstacle "shelf"`, or is nearer than the clearance.
    pub fn explain_contact(&self, pair: Pair) -> String {
        let (part, obstacle) = (self.describe_part(pair), self.describe_obstacle(pair.obstacle));
        match self.required(pair) > 0.0 {
            true => format!("{part} is nearer to {obstacle} than {}", self.describe_required(pair)),
            false => format!("{part} hits {obstacle}"),
        }
    }

    /// Describes the distance that a pair must keep: `the clearance of 10.00 mm`, `the 1.20 mm that errors need`.
    pub fn describe_required(&self, pair: Pair) -> String {
        let growth = self.obstacle(pair.obstacle).growth;
        let clearance = self.workspace().clearance.max(growth.clearance);
        let errors = self.required(pair) - clearance;
        match (clearance > 0.0, errors > 0.0) {
            (_, false) => format!("the clearance of {}", chosen_length(clearance)),
            (false, true) => format!("the {} for the stated errors", length(errors)),
            (true, true) => {
                format!("the clearance of {} plus {} for the stated errors", chosen_length(clearance), length(errors))
            }
        }
    }

    /// Describes an obstacle in words: `obstacle "shelf"`, `link "base_link"`.
    pub fn describe_obstacle(&self, number: usize) -> String {
        let kind = if self.self_obstacles().contains(&number) { "link" } else { "obstacle" };
        format!("{kind} \"{}\"", self.obstacle(number).name)
    }

    /// Returns the name of the obstacle in a pair.
    pub fn obstacle_name(&self, pair: Pair) -> &str {
        &self.obstacle(pair.obstacle).name
    }

    /// Describes the owner of a pair's part in words: `link "forearm" (body "gripper")`, `payload "part"`.
    pub fn describe_part(&self, pair: Pair) -> String {
        let link = self.link(pair);
        let body = &link.parts[pair.part].body;
        if self.is_attached(pair) {
            format!("payload \"{body}\"")
        } else if *body == link.name {
            format!("link \"{}\"", link.name)
        } else {
            format!("link \"{}\" (body \"{body}\")", link.name)
        }
    }
}
