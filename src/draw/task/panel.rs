//! One configuration space of a task.

use super::states::{PayloadState, describe};
use super::{TaskPicture, motion_pen, tags};
use crate::draw::chart::Chart;
use crate::draw::color::{self, INK, Rgb};
use crate::draw::cspace::{blocked, goal_marker, start_marker};
use crate::draw::figure::{Anchor, Item, Rect, Style, shortened};
use crate::draw::shapes::DASH;
use crate::draw::{boxes, page, preferences};
use crate::engine::task::{Impossible, Leg};
use crate::model::{Scene, Task};
use crate::space::Configuration;

/// A world with a payload, and the motions in it.
#[derive(Debug, Clone)]
pub struct Panel<'a> {
    /// The line of text above it.
    pub title: String,
    /// World and payload, with link 2 free of nothing.
    pub scene: Scene,
    /// The obstacles that link 2 may reach into, in some of the motions at least.
    pub allowed_contacts: Vec<usize>,
    /// The motions that take place in this world.
    pub motions: Vec<&'a Leg>,
    /// Where the arm is at first.
    pub start: Configuration,
    /// The step that fails here, if one does.
    pub fails: Option<&'a Impossible>,
}

impl<'a> Panel<'a> {
    /// The panel of a payload state in a task of some rounds; none without motions.
    #[must_use]
    pub fn new(state: &PayloadState<'a>, task: &Task, rounds: usize) -> Option<Self> {
        let first = state.motions.first()?;
        let scenes: Vec<&Scene> = state.motions.iter().map(|leg| &*leg.scene).collect();
        let (scene, allowed_contacts) = without_allowed_contacts(task, &first.scene, &scenes);
        let start = first.timed.curve.curve().path().start();
        Some(Self {
            title: state.title(rounds),
            scene,
            allowed_contacts,
            motions: state.motions.clone(),
            start,
            fails: None,
        })
    }

    /// The panel of the motion that fails: where the arm stands and where it cannot go.
    #[must_use]
    pub fn failing(fails: &'a Impossible, task: &Task) -> Self {
        let (scene, allowed_contacts) = without_allowed_contacts(task, &fails.scene, &[&*fails.scene]);
        let payload = describe(scene.payload().map(|payload| payload.object.as_str()));
        let (number, cycle) = (fails.step.number, fails.step.cycle);
        let round = if cycle > 1 { format!(", round {cycle}") } else { String::new() };
        let title = format!("{number} fails: {payload}{round}");
        Self { title, scene, allowed_contacts, motions: Vec::new(), start: fails.from, fails: Some(fails) }
    }

    /// The panel of the world as it is at first, without motions.
    #[must_use]
    pub fn at_start(task: &Task) -> Self {
        let poses: Vec<_> = task.objects.iter().map(|object| Some(object.at)).collect();
        let scene = Scene::trusted(task.arm.clone(), task.obstacles(&poses));
        Self {
            title: describe(None),
            scene,
            allowed_contacts: Vec::new(),
            motions: Vec::new(),
            start: task.start,
            fails: None,
        }
    }

    /// Draws it, without values and titles of the axes.
    #[must_use]
    pub fn items(&self, picture: &TaskPicture, chart: &Chart) -> Vec<Item> {
        let Chart { frame, units, paths, .. } = chart;
        let mut inside = frame.grid(*units);
        inside.extend(self.c_obstacles(picture, chart));
        inside.extend(preferences::in_cspace(&self.scene.workspace().preferences, frame, paths));
        let curves: Vec<_> = self.motions.iter().map(|leg| leg.timed.curve.curve().outline()).collect();
        let pens = self.motions.iter().map(|leg| motion_pen(picture.task, leg));
        inside.extend(page::lines(curves.iter().map(|path| chart.outline(path)).zip(pens)));
        let unreached = || self.fails.iter().flat_map(|fails| &fails.ik_solutions);
        let proofs = unreached().filter_map(|unreached| unreached.proof.as_ref());
        inside.extend(proofs.map(|proof| boxes::proof(proof.stuck(), frame)));
        let mut items = vec![Item::Clip(frame.rect, inside)];
        items.extend(frame.sides(chart.seams()));
        items.extend(curves.iter().flat_map(|path| goal_marker(chart.place(path.goal()), true)));
        items.extend(unreached().flat_map(|unreached| goal_marker(chart.place(unreached.ik_solution), false)));
        items.extend(start_marker(chart.place(self.start)));
        let mut numbers = Vec::new();
        for (leg, path) in self.motions.iter().zip(&curves) {
            tags::add(&mut numbers, chart.place(path.goal()), leg.step.number);
        }
        if let Some(fails) = self.fails {
            unreached().for_each(|to| tags::add(&mut numbers, chart.place(to.ik_solution), fails.step.number));
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
        let solid = if self.allowed_contacts.is_empty() {
            whole
        } else {
            let (arm, workspace) = (picture.task.arm.clone(), self.scene.workspace().clone());
            let with_allowed_contacts =
                Scene::handling_trusted(arm, workspace, self.scene.payload().cloned(), &self.allowed_contacts);
            for &obstacle in &self.allowed_contacts {
                let contours = whole.iter().filter(|c| c.obstacle == obstacle && c.link == 1);
                items.push(chart.c_obstacle(contours, passable(color::obstacle(obstacle))));
            }
            (picture.c_obstacles)(&with_allowed_contacts)
        };
        for obstacle in 0..self.scene.workspace().obstacles.len() {
            let contours = solid.iter().filter(|c| c.obstacle == obstacle);
            items.push(chart.c_obstacle(contours, blocked(color::obstacle(obstacle))));
        }
        items
    }
}

/// World and payload of a scene with link 2 free of nothing, and the obstacles that it may reach into in some of these
/// scenes, which differ in nothing else.
fn without_allowed_contacts(task: &Task, scene: &Scene, scenes: &[&Scene]) -> (Scene, Vec<usize>) {
    let all = Scene::handling_trusted(task.arm.clone(), scene.workspace().clone(), scene.payload().cloned(), &[]);
    let pairs = |scene: &Scene, obstacle| scene.pairs().iter().filter(|pair| pair.obstacle == obstacle).count();
    let allowed_contacts = |obstacle: &usize| {
        let most = pairs(&all, *obstacle);
        scenes.iter().any(|scene| pairs(scene, *obstacle) < most)
    };
    let allowed_contacts = (0..all.workspace().obstacles.len()).filter(allowed_contacts).collect();
    (all, allowed_contacts)
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
