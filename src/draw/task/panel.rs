//! One configuration space of a task.

use super::states::{PayloadState, describe};
use super::{TaskPicture, motion_pen, tags};
use crate::draw::chart::Chart;
use crate::draw::color::{self, INK, Rgb};
use crate::draw::cspace::{blocked, goal_marker, start_marker};
use crate::draw::figure::{Anchor, Item, Rect, Style, shortened};
use crate::draw::shapes::DASH;
use crate::draw::{page, preferences};
use crate::model::{Scene, Task};
use crate::space::Configuration;
use crate::task::Leg;

/// A world with a payload, and the motions in it.
#[derive(Debug, Clone)]
pub struct Panel<'a> {
    /// Its title.
    pub title: String,
    /// World and payload, with link 2 free of nothing.
    pub scene: Scene,
    /// The obstacles that link 2 may reach into, in some of the motions at least.
    pub spared: Vec<usize>,
    /// The motions.
    pub motions: Vec<&'a Leg>,
    /// Where the arm is at first.
    pub start: Configuration,
}

impl<'a> Panel<'a> {
    /// The panel of a payload state in a task of some rounds; none without motions.
    #[must_use]
    pub fn new(state: &PayloadState<'a>, task: &Task, rounds: usize) -> Option<Self> {
        let first = state.motions.first()?;
        let (workspace, payload) = (&first.scene.workspace, first.scene.payload());
        let scene = Scene::handling(task.arm.clone(), workspace.clone(), payload.cloned(), &[]);
        let pairs = |scene: &Scene, obstacle| scene.pairs().iter().filter(|pair| pair.obstacle == obstacle).count();
        let spared = |obstacle: &usize| {
            let all = pairs(&scene, *obstacle);
            state.motions.iter().any(|leg| pairs(&leg.scene, *obstacle) < all)
        };
        let spared = (0..workspace.obstacles.len()).filter(spared).collect();
        let start = first.timed.curve.curve().path().start();
        Some(Self { title: state.title(rounds), scene, spared, motions: state.motions.clone(), start })
    }

    /// The panel of the world as it is at first, without motions.
    #[must_use]
    pub fn at_start(task: &Task) -> Self {
        let poses: Vec<_> = task.objects.iter().map(|object| Some(object.at)).collect();
        let scene = Scene::new(task.arm.clone(), task.obstacles(&poses));
        Self { title: describe(None), scene, spared: Vec::new(), motions: Vec::new(), start: task.start }
    }

    /// Draws it, without values and titles of the axes.
    #[must_use]
    pub fn items(&self, picture: &TaskPicture, chart: &Chart) -> Vec<Item> {
        let Chart { frame, units, paths, .. } = chart;
        let mut inside = frame.grid(*units);
        inside.extend(self.c_obstacles(picture, chart));
        inside.extend(preferences::in_cspace(&self.scene.workspace.preferences, frame, paths));
        let curves: Vec<_> = self.motions.iter().map(|leg| leg.timed.curve.curve().outline()).collect();
        let pens = self.motions.iter().map(|leg| motion_pen(picture.task, leg));
        inside.extend(page::lines(curves.iter().map(|path| chart.outline(path)).zip(pens)));
        let mut items = vec![Item::Clip(frame.rect, inside)];
        items.extend(frame.sides(chart.seams()));
        items.extend(curves.iter().flat_map(|path| goal_marker(chart.place(path.goal()), true)));
        items.extend(start_marker(chart.place(self.start)));
        let mut numbers = Vec::new();
        for (leg, path) in self.motions.iter().zip(&curves) {
            tags::add(&mut numbers, chart.place(path.goal()), leg.step.number);
        }
        if numbers.len() > 1 {
            items.extend(tags::items(&numbers, frame.rect, &[], &[]));
        }
        items.push(title(&self.title, frame.rect));
        items
    }

    /// What is blocked; of the obstacles that link 2 may reach into, what that would else block is dashed.
    fn c_obstacles(&self, picture: &TaskPicture, chart: &Chart) -> Vec<Item> {
        let whole = (picture.c_obstacles)(&self.scene);
        let mut items = Vec::new();
        let solid = if self.spared.is_empty() {
            whole
        } else {
            let (arm, workspace) = (picture.task.arm.clone(), self.scene.workspace.clone());
            let spares = Scene::handling(arm, workspace, self.scene.payload().cloned(), &self.spared);
            for &obstacle in &self.spared {
                let contours = whole.iter().filter(|c| c.obstacle == obstacle && c.link == 1);
                items.push(chart.c_obstacle(contours, passable(color::obstacle(obstacle))));
            }
            (picture.c_obstacles)(&spares)
        };
        for obstacle in 0..self.scene.workspace.obstacles.len() {
            let contours = solid.iter().filter(|c| c.obstacle == obstacle);
            items.push(chart.c_obstacle(contours, blocked(color::obstacle(obstacle))));
        }
        items
    }
}

/// How the C-obstacle of an obstacle is drawn that link 2 may reach into.
fn passable(color: Rgb) -> Style {
    let style = Style::line(color.darker(0.25), 2.6).dashed(DASH).filled(color.lighter(0.85)).faded(0.85);
    Style { pen_below: true, ..style }
}

/// Above a frame.
fn title(text: &str, frame: Rect) -> Item {
    const SIZE: f64 = 14.0;
    // Somewhat wider than the frame: less than half of what lies between neighbours on each side.
    let text = shortened(text, SIZE, frame.width + 24.0);
    page::label([frame.x + frame.width / 2.0, frame.y - 9.0], text, SIZE, Anchor::Middle, INK)
}
