//! The bodies of a motion, with their names.

use cplan_model::{Pair, Scene};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// A kind of body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum BodyKind {
    /// A static or a moving obstacle.
    Obstacle,
    /// A lying or carried object of a task.
    Object,
    /// A link of the robot.
    Link,
}

impl BodyKind {
    /// Returns the word for the kind.
    pub fn word(self) -> &'static str {
        match self {
            Self::Obstacle => "obstacle",
            Self::Object => "object",
            Self::Link => "link",
        }
    }
}

/// Data that identify the bodies in the scenes of a motion.
#[derive(Debug, Clone, Default)]
pub struct BodyNames {
    /// Number of the world's own static obstacles. Those after them are objects.
    pub fixed: usize,
    /// Names of the objects. They are unique among objects and obstacles.
    pub objects: BTreeSet<String>,
}

/// The bodies in all scenes of a motion, numbered in the order in which they occur.
#[derive(Debug, Default)]
pub(super) struct Bodies {
    names: BodyNames,
    /// The number of a body, by its kind, the number of a static obstacle, and its name. Static obstacles may share names.
    known: BTreeMap<(BodyKind, usize, String), usize>,
    pub all: Vec<(BodyKind, String)>,
}

/// The numbers of a scene's bodies.
pub(super) struct SceneBodies {
    obstacles: Vec<usize>,
    parts: [Vec<usize>; 2],
}

impl Bodies {
    pub fn new(names: BodyNames) -> Self {
        Self { names, ..Self::default() }
    }

    /// Returns the numbers of a scene's bodies, and gives new bodies the next numbers.
    pub fn of(&mut self, scene: &Scene) -> SceneBodies {
        let own = scene.self_obstacles();
        let obstacles = (0..own.end).map(|number| {
            let name = &scene.obstacle(number).name;
            match own.contains(&number) {
                true => self.number(BodyKind::Link, 0, name),
                false => {
                    let is_fixed = number < self.names.fixed;
                    self.number(self.kind(name), if is_fixed { number } else { usize::MAX }, name)
                }
            }
        });
        let obstacles = obstacles.collect();
        let parts = [0, 1].map(|link| {
            let own = scene.own_parts(link).len();
            let parts = scene.arm().links[link].parts.iter().enumerate();
            let number = |(part, p): (usize, &cplan_model::Part)| match part < own {
                true => self.number(BodyKind::Link, 0, &p.body),
                false => self.number(self.kind(&p.body), usize::MAX, &p.body),
            };
            parts.map(number).collect()
        });
        SceneBodies { obstacles, parts }
    }

    fn kind(&self, name: &str) -> BodyKind {
        if self.names.objects.contains(name) { BodyKind::Object } else { BodyKind::Obstacle }
    }

    fn number(&mut self, kind: BodyKind, number: usize, name: &str) -> usize {
        let next = self.all.len();
        let known = *self.known.entry((kind, number, name.to_owned())).or_insert(next);
        if known == next {
            self.all.push((kind, name.to_owned()));
        }
        known
    }
}

impl SceneBodies {
    /// Returns the bodies of a pair: the obstacle, and the part of the arm or the payload.
    pub fn of(&self, pair: Pair) -> [usize; 2] {
        [self.obstacles[pair.obstacle], self.parts[pair.link.min(1)][pair.part]]
    }
}
