//! The cards of an explanation: each shows a change and the path that it opens.

use super::words::{bounds, evidence, headline, instruction, removal};
use super::{
    BlockedEnd, Bottleneck, Change, ChangeContext, Explanation, FoundExplanation, InfeasibleExplanation, OutOfReach,
    Saving,
};
use cplan_blockers::{BlockingSet, Element, End, MotionQuestion, Side};
use cplan_model::space::{Configuration, Path};
use cplan_model::{Outcome, Scene, Shape};
use cplan_planners::cspace::CObstacle;
use cplan_text::{headline_length, joined, length};
use cplan_view::output::contours;
use cplan_view::output::names::{part_name, subject};
use cplan_view::{
    BlockingView, ContourView, Object, ObstacleView, PathView, RoundingSteps, Section, bounding_box, contour_views,
    listed_number, object,
};

/// Largest extension of the visible workspace on a side to show changed obstacles, as a share of the visible part.
const MAX_GROWTH: f64 = 0.35;

/// Distance between a changed obstacle and the border of the workspace, as a share of the visible part.
const MARGIN: f64 = 0.04;

/// A card of the page, and the obstacle after the change. The card shows a change of the world with the path that it
/// opens, or a configuration.
type Card = (Object, Option<ObstacleView>);

/// Returns the explanation for a page: the reason in a sentence, a sentence about the proof, and the cards. `frame` is
/// the visible part of the workspace.
pub fn explanation_section(explanation: &Explanation, frame: [[f64; 2]; 2]) -> Section {
    let question = &explanation.question;
    let maker = CardMaker { question, grain: RoundingSteps::of(question.scene().arm()) };
    let (title, cards) = match &explanation.outcome {
        Outcome::Infeasible(closed) => ("What opens a path", maker.of_infeasible(closed)),
        Outcome::Found(found) => ("What makes it shorter", maker.of_found(found)),
        Outcome::Unknown(_) => ("", Vec::new()),
    };
    let document = object!(
        "headline": headline(explanation),
        "evidence": evidence(explanation),
        "title": title,
        "cards": cards.iter().map(|(card, _)| card).collect::<Vec<_>>(),
        // The visible part of the workspace, with all changed obstacles.
        "frame": extended(frame, cards.iter().filter_map(|card| card.1.as_ref())),
        "stuck": blocking(explanation),
    );
    Section::of_data("explanation", &document)
}

/// Returns the obstacles in the way and the narrowest place. `None` unless there is no path.
pub fn blocking(explanation: &Explanation) -> Option<BlockingView> {
    let Outcome::Infeasible(closed) = &explanation.outcome else { return None };
    let scene = explanation.question.scene();
    let numbers = closed.sets.iter().flat_map(BlockingSet::elements).filter_map(Element::obstacle);
    let blockers = numbers.map(|number| listed_number(scene, number)).collect();
    let at = closed.bottleneck.as_ref().map(|bottleneck| (bottleneck.at, bottleneck.point));
    Some(BlockingView { blockers, at })
}

struct CardMaker<'a> {
    question: &'a MotionQuestion,
    grain: RoundingSteps,
}

impl CardMaker<'_> {
    fn scene(&self) -> &Scene {
        self.question.scene()
    }

    fn of_infeasible(&self, closed: &InfeasibleExplanation) -> Vec<Card> {
        let is_only = closed.sets.iter().map(|set| set.blockers.len()).sum::<usize>() == 1;
        let changes = closed.sets.iter().zip(&closed.changes);
        let changes = changes.flat_map(|(set, all)| all.iter().map(move |change| self.of_change(set, change, is_only)));
        let ends = closed.ends.iter().filter_map(|end| self.of_end(end));
        let reach = closed.out_of_reach.iter().map(|out| self.of_reach(out));
        let stuck = closed.bottleneck.iter().map(|bottleneck| self.of_bottleneck(bottleneck));
        changes.chain(ends).chain(reach).chain(stuck).collect()
    }

    /// Makes the card of a change that opens a path.
    fn of_change(&self, set: &BlockingSet, change: &Change, is_only: bool) -> Card {
        let changed = change.apply(self.question, set);
        let obstacle = change.changed_obstacle(self.scene());
        let number = self.listed(change.element);
        let removed = match change.among {
            ChangeContext::World => Vec::new(),
            ChangeContext::Set => {
                set.others(self.question).into_iter().filter_map(|other| self.listed(other)).collect()
            }
        };
        let view = obstacle.as_ref().zip(number).map(|(obstacle, at)| ObstacleView::new(obstacle, at, self.grain));
        let [opens, closed] = bounds(self.scene(), set, change);
        let card = object!("title": instruction(self.scene(), change, is_only))
            .with_any("opens", &opens)
            .with_any("closed", &closed)
            .with("obstacle", &number)
            .with("changed", &view)
            .with_any("removed", &removed)
            .with_any("c_obstacles", &self.contours(changed.scene(), change.element))
            .with("domains", &self.domains(changed.scene(), change.element))
            .with("path", &self.path(change.by.path.path()))
            .with("edit", &self.edit(&changed, change));
        (card, view)
    }

    /// Returns the change of the world file, for pages that can apply it. Its numbers are not rounded, because the path
    /// is certified only for these numbers.
    fn edit(&self, changed: &MotionQuestion, change: &Change) -> Option<Object> {
        match change.element {
            Element::Obstacle { number } => {
                let obstacle = change.changed_obstacle(self.scene())?;
                if obstacle.pieces.is_empty() {
                    return Some(object!("removal": number));
                }
                Some(object!("obstacle": object!("number": number, "shape": edited_shape(&obstacle.shape)?)))
            }
            Element::Link { .. } | Element::Motor => None,
            Element::Limit { joint, side } => {
                // The other end does not change.
                let (lower, upper) = self.scene().arm().joints[joint].range.domain();
                let (least, most) = changed.scene().arm().joints[joint].range.domain();
                let range = if side == Side::Lower { [least, upper] } else { [lower, most] };
                Some(object!("limits": object!("joint": joint, "range": range)))
            }
            Element::Clearance => Some(object!("clearance": changed.scene().workspace().clearance)),
        }
    }

    /// Makes the card of an element that makes the path longer.
    fn of_found(&self, found: &FoundExplanation) -> Vec<Card> {
        let Some(bound) = found.answer.bound() else { return Vec::new() };
        found.savings.iter().map(|saving| self.of_saving(saving, bound.upper)).collect()
    }

    fn of_saving(&self, saving: &Saving, length: f64) -> Card {
        let [title, note] = removal(self.scene(), saving, length);
        let changed = self.question.without_at_clearance(&[saving.element]);
        let is_limit = matches!(saving.element, Element::Limit { .. });
        let contours = if is_limit { self.contours(changed.scene(), saving.element) } else { Vec::new() };
        let card = object!("title": title)
            .with_any("note", &note)
            .with_any("removed", &self.listed(saving.element).into_iter().collect::<Vec<_>>())
            .with_any("c_obstacles", &contours)
            .with("domains", &self.domains(changed.scene(), saving.element))
            .with("path", &self.path(&saving.path));
        (card, None)
    }

    /// Makes a card that shows a configuration.
    fn at(&self, title: String, note: String, is_place: bool, at: Configuration) -> Card {
        let card = object!("title": title).with_any("note", &note).with_any("is_place", &is_place);
        (card.with("at", &self.grain.configuration(at)), None)
    }

    /// Makes the card of the free configuration that is nearest to a blocked start or goal.
    fn of_end(&self, blocked: &BlockedEnd) -> Option<Card> {
        let nearest = blocked.nearest.as_ref()?;
        let end = if blocked.end == End::Start { "start" } else { "goal" };
        let moves = blocked
            .tip_moves(self.scene().arm())
            .map_or_else(String::new, |by| format!("; the tip moves by {}", length(by)));
        let title = format!("Move the {end} to the nearest free configuration");
        let note = format!("{}{moves}", self.configuration(nearest.configuration));
        Some(self.at(title, note, false, nearest.configuration))
    }

    /// Makes the card of the nearest place that the tip can reach.
    fn of_reach(&self, out: &OutOfReach) -> Card {
        let OutOfReach { tip, nearest, at, .. } = *out;
        let title = format!("Move the goal {} nearer", headline_length((tip - nearest).norm(), true));
        let place = format!("({:.3}, {:.3}) m", nearest.x, nearest.y);
        self.at(title, format!("{place} is the nearest point that the tip can reach without obstacles"), false, at)
    }

    /// Makes the card of the narrowest place.
    fn of_bottleneck(&self, bottleneck: &Bottleneck) -> Card {
        let scene = self.scene();
        let mut parts: Vec<String> = Vec::new();
        let mut obstacles: Vec<String> = Vec::new();
        for hit in &bottleneck.hits {
            let number = hit.contact.pair.obstacle;
            let element = if scene.self_obstacles().contains(&number) {
                Element::Link { number }
            } else {
                Element::Obstacle { number }
            };
            for (name, names) in [(part_name(scene, hit), &mut parts), (subject(scene, element), &mut obstacles)] {
                if !names.contains(&name) {
                    names.push(name);
                }
            }
        }
        let lacking = length(bottleneck.missing_distance(scene.workspace().clearance));
        let between = if parts.is_empty() {
            String::new()
        } else {
            format!(": {} against {}", joined(&parts), joined(&obstacles))
        };
        let note = format!("too narrow by {lacking}{between}");
        self.at("Show the narrowest place".into(), note, true, bottleneck.at)
    }

    /// Returns the index of an obstacle or link in the list of the page.
    fn listed(&self, element: Element) -> Option<usize> {
        element.obstacle().map(|number| listed_number(self.scene(), number))
    }

    fn path(&self, path: &Path) -> PathView {
        PathView::of_several("", path, [0, 1], self.grain)
    }

    fn configuration(&self, q: Configuration) -> String {
        let joints = &self.scene().arm().joints;
        let value = |k: usize| match joints[k].joint_type.is_revolute() {
            true => format!("{} {:.1}\u{b0}", joints[k].name, q[k].to_degrees()),
            false => format!("{} {}", joints[k].name, length(q[k])),
        };
        format!("{}, {}", value(0), value(1))
    }

    /// Returns the C-obstacles that differ in the world after a change.
    fn contours(&self, changed: &Scene, element: Element) -> Vec<ContourView> {
        let only = match element {
            Element::Obstacle { number } => Some(number),
            // C-obstacles of revolute joints repeat after each turn, for any limits.
            Element::Limit { joint, .. } if !changed.arm().joints[joint].joint_type.is_revolute() => None,
            _ => return Vec::new(),
        };
        let reduced = changed.changed(|_, workspace| {
            for (index, obstacle) in workspace.obstacles.iter_mut().enumerate() {
                if only.is_some_and(|only| only != index) {
                    obstacle.pieces.clear();
                }
            }
        });
        let traced = contours(&reduced);
        let shown = traced.into_iter().filter(|contour| only.is_none_or(|only| contour.obstacle == only));
        let shown =
            shown.map(|contour| CObstacle { obstacle: listed_number(self.scene(), contour.obstacle), ..contour });
        contour_views(&shown.collect::<Vec<_>>(), self.grain)
    }

    /// Returns the ranges of both joints after a change of a limit. `None` for other changes.
    fn domains(&self, changed: &Scene, element: Element) -> Option<[[f64; 2]; 2]> {
        let domain = |k: usize| changed.arm().joints[k].range.domain().into();
        matches!(element, Element::Limit { .. }).then(|| [domain(0), domain(1)])
    }
}

/// Returns the visible part of the workspace, extended to include changed obstacles, unless they are too far away.
fn extended<'a>(frame: [[f64; 2]; 2], changed: impl Iterator<Item = &'a ObstacleView>) -> [[f64; 2]; 2] {
    let shapes = changed.flat_map(ObstacleView::own);
    let size = frame.map(|[lower, upper]| upper - lower).into_iter().fold(0.0, f64::max);
    let bounds = bounding_box(shapes).map(|(lower, upper)| (lower - MARGIN * size, upper + MARGIN * size));
    // Obstacles within the frame need no margin.
    let bounds = [0, 1].map(|k| {
        let [lower, upper] = frame[k];
        let is_in = lower <= bounds[k].0 + MARGIN * size && bounds[k].1 - MARGIN * size <= upper;
        if is_in { (lower, upper) } else { bounds[k] }
    });
    [0, 1].map(|k| {
        let [lower, upper] = frame[k];
        [lower.min(bounds[k].0).max(lower - MAX_GROWTH * size), upper.max(bounds[k].1).min(upper + MAX_GROWTH * size)]
    })
}

/// Returns a shape in the form that the live page edits. `None` if world files have no such shape.
fn edited_shape(shape: &Shape) -> Option<Object> {
    match shape {
        Shape::Polygon(corners) => Some(object!("polygon": corners)),
        Shape::Circle { center, radius } => Some(object!("circle": object!("center": center, "radius": radius))),
        Shape::Polyline(points) => Some(object!("polyline": points)),
        Shape::Pieces => None,
    }
}
