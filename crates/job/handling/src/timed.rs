//! Workspaces and scenes with moving obstacles.

use super::{MovingObstacle, ObstacleTrajectory, Piece};
use cplan_geometry::Pose;
use cplan_judge::Drift;
use cplan_model::space::Configuration;
use cplan_model::{Additions, Arm, Obstacle, Obstruction, Pair, Scene, SceneError, Workspace};
use serde::{Deserialize, Serialize};

/// A workspace with moving obstacles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TimedWorkspace {
    /// The workspace without its moving obstacles.
    #[serde(flatten)]
    pub fixed: Workspace,
    /// Moving obstacles.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub movers: Vec<MovingObstacle>,
}

impl From<Workspace> for TimedWorkspace {
    fn from(fixed: Workspace) -> Self {
        Self { fixed, movers: Vec::new() }
    }
}

impl TimedWorkspace {
    /// Returns the workspace with all obstacles grown as their [growth](cplan_model::Growth) requires.
    #[must_use]
    pub fn grown(mut self) -> Self {
        let clearance = self.fixed.clearance;
        self.fixed.set_clearance(clearance);
        self.movers.iter_mut().for_each(|mover| mover.obstacle.grow(clearance));
        self
    }

    /// Splits the workspace into its static part, and its moving obstacles as additions to a scene.
    pub fn into_parts(self) -> (Workspace, Additions) {
        let loose = self.movers.iter().map(MovingObstacle::to_loose_obstacle).collect();
        (self.fixed, Additions { loose, ..Additions::default() })
    }

    /// Returns the scene of an arm in this workspace.
    ///
    /// # Errors
    /// Same as for [`Scene::with`].
    pub fn scene(self, arm: Arm) -> Result<Scene, SceneError> {
        let (workspace, additions) = self.into_parts();
        Scene::with(arm, workspace, additions)
    }

    /// Does the same as [`TimedWorkspace::scene`], without checks.
    #[doc(hidden)]
    pub fn scene_trusted(self, arm: Arm) -> Scene {
        let (workspace, additions) = self.into_parts();
        Scene::with_trusted(arm, workspace, additions)
    }

    /// Returns the trajectories of the moving obstacles.
    pub fn trajectories(&self) -> Vec<ObstacleTrajectory> {
        self.movers.iter().map(|mover| mover.trajectory.clone()).collect()
    }

    /// Returns all obstacles in the order of their numbers in a scene: static ones, then moving ones in their own frames.
    pub fn all(&self) -> impl Iterator<Item = &Obstacle> {
        self.fixed.obstacles.iter().chain(self.movers.iter().map(|mover| &mover.obstacle))
    }

    /// Replaces the displayed shapes by the convex pieces that collision checks use. For deserialised workspaces, in which the
    /// two may differ.
    pub fn restrict_shapes(&mut self) {
        let moving = self.movers.iter_mut().map(|mover| &mut mover.obstacle);
        self.fixed.obstacles.iter_mut().chain(moving).for_each(Obstacle::derive_shape_from_pieces);
    }
}

/// A scene with the trajectories of its loose obstacles.
#[derive(Debug, Clone, Copy)]
pub struct TimedScene<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The trajectory of each loose obstacle. If it is empty, loose obstacles are ignored.
    pub trajectories: &'a [ObstacleTrajectory],
}

impl<'a> From<&'a Scene> for TimedScene<'a> {
    fn from(scene: &'a Scene) -> Self {
        Self { scene, trajectories: &[] }
    }
}

impl<'a> TimedScene<'a> {
    /// Returns the pairs of a part and a moving obstacle that can meet.
    pub fn moving_pairs(self) -> &'a [Pair] {
        if self.trajectories.is_empty() { &[] } else { self.scene.loose_pairs() }
    }

    /// Returns the trajectory of a pair's obstacle. `None` for a static obstacle.
    pub fn trajectory(self, pair: Pair) -> Option<&'a ObstacleTrajectory> {
        self.trajectories.get(self.scene.loose_index(pair)?)
    }

    /// Returns the motion of a pair's obstacle between two places of the arm's motion, which begins at the same time as the
    /// trajectories. `None` for a static obstacle.
    pub fn drift(self, pair: Pair, pieces: &[Piece], places: [(usize, f64); 2]) -> Option<Drift> {
        let [from, to] = places.map(|(piece, share)| pieces[piece].time(share) - pieces[0].from);
        self.trajectory(pair).map(|trajectory| trajectory.drift(from, to))
    }

    /// Returns the obstacle of a pair at its place at a time. `None` for a static obstacle.
    pub fn obstacle(self, pair: Pair, time: f64) -> Option<Obstacle> {
        self.trajectory(pair).map(|trajectory| self.scene.obstacle(pair.obstacle).at(&trajectory.pose(time)))
    }

    /// Returns the poses of the moving obstacles at a time.
    fn poses(self, time: f64) -> impl Iterator<Item = Pose> {
        self.trajectories.iter().map(move |trajectory| trajectory.pose(time))
    }

    /// Returns the scene at a time. Moving obstacles become static obstacles at their places of that time, after all others.
    pub fn frozen(self, time: f64) -> Scene {
        self.scene.with_loose_at(self.poses(time))
    }

    /// Returns the reasons why `q` is not free of static and moving obstacles at a time.
    pub fn obstructions(self, q: Configuration, time: f64) -> Vec<Obstruction> {
        self.scene.obstructions_among(q, &self.poses(time).collect::<Vec<_>>())
    }
}
