//! The cards of an explanation: each shows a change and the path that it opens.

use super::page::{CardView, Edit, EditedShape, ExplanationView};
use super::words::{bounds, evidence, headline, instruction, removal};
use super::{
    BlockedEnd, Bottleneck, Change, ChangeContext, Explanation, FoundExplanation, InfeasibleExplanation, OutOfReach,
    Saving,
};
use cplan_blockers::{BlockingSet, Element, End, MotionQuestion, Side};
use cplan_model::space::{Configuration, Path};
use cplan_model::{Outcome, Scene};
use cplan_planners::cspace::CObstacle;
use cplan_text::{headline_length, joined, length};
use cplan_view::output::contours;
use cplan_view::output::names::{part_name, subject};
use cplan_view::{
    BlockingView, ContourView, ObstacleView, PathView, RoundingSteps, bounding_box, contour_views, listed_number,
};

/// Largest share of the visible workspace by which it grows on a side to include changed obstacles.
const MAX_GROWTH: f64 = 0.35;

/// Distance between a changed obstacle and the border of the workspace, as a share of the visible part.
const MARGIN: f64 = 0.04;

/// Returns the explanation for a page. `frame` is the visible part of the workspace.
pub fn explanation_view(explanation: &Explanation, frame: [[f64; 2]; 2]) -> ExplanationView {
    let question = &explanation.question;
    let maker = CardMaker { question, grain: RoundingSteps::of(question.scene().arm()) };
    let (title, cards) = match &explanation.outcome {
        Outcome::Infeasible(closed) => ("What opens a path", maker.of_infeasible(closed)),
        Outcome::Found(found) => ("What makes it shorter", maker.of_found(found)),
        Outcome::Unknown(_) => ("", Vec::new()),
    };
    ExplanationView {
        headline: headline(explanation),
        evidence: evidence(explanation),
        title,
        frame: extended(frame, &cards),
        cards,
        stuck: blocking(explanation),
    }
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

/// Makes cards for a question.
struct CardMaker<'a> {
    question: &'a MotionQuestion,
    grain: RoundingSteps,
}

impl CardMaker<'_> {
    fn scene(&self) -> &Scene {
        self.question.scene()
    }

    fn of_infeasible(&self, closed: &InfeasibleExplanation) -> Vec<CardView> {
        let is_only = closed.sets.iter().map(|set| set.blockers.len()).sum::<usize>() == 1;
        let changes = closed.sets.iter().zip(&closed.changes);
        let changes = changes.flat_map(|(set, all)| all.iter().map(move |change| self.of_change(set, change, is_only)));
        let ends = closed.ends.iter().filter_map(|end| self.of_end(end));
        let reach = closed.out_of_reach.iter().map(|out| self.of_reach(out));
        let stuck = closed.bottleneck.iter().map(|bottleneck| self.of_bottleneck(bottleneck));
        changes.chain(ends).chain(reach).chain(stuck).collect()
    }

    /// Makes the card of a change that opens a path.
    fn of_change(&self, set: &BlockingSet, change: &Change, is_only: bool) -> CardView {
        let changed = change.apply(self.question, set);
        let obstacle = change.changed_obstacle(self.scene());
        let number = self.listed(change.element);
        let removed = match change.among {
            ChangeContext::World => Vec::new(),
            ChangeContext::Set => {
                set.others(self.question).into_iter().filter_map(|other| self.listed(other)).collect()
            }
        };
        let view = obstacle.as_ref().zip(number);
        let [opens, closed] = bounds(self.scene(), set, change);
        CardView {
            title: instruction(self.scene(), change, is_only),
            opens,
            closed,
            obstacle: number,
            changed: view.map(|(obstacle, number)| ObstacleView::new(obstacle, number, self.grain)),
            removed,
            c_obstacles: self.contours(changed.scene(), change.element),
            domains: self.domains(changed.scene(), change.element),
            path: Some(self.path(change.by.path.path())),
            edit: self.edit(&changed, change),
            ..CardView::default()
        }
    }

    fn edit(&self, changed: &MotionQuestion, change: &Change) -> Option<Edit> {
        match change.element {
            Element::Obstacle { number } => {
                let obstacle = change.changed_obstacle(self.scene())?;
                if obstacle.pieces.is_empty() {
                    return Some(Edit::Removal(number));
                }
                EditedShape::new(&obstacle.shape).map(|shape| Edit::Obstacle { number, shape })
            }
            Element::Link { .. } | Element::Motor => None,
            Element::Limit { joint, side } => {
                // The other end does not change.
                let (lower, upper) = self.scene().arm().joints[joint].range.domain();
                let (least, most) = changed.scene().arm().joints[joint].range.domain();
                let range = if side == Side::Lower { [least, upper] } else { [lower, most] };
                Some(Edit::Limits { joint, range })
            }
            Element::Clearance => Some(Edit::Clearance(changed.scene().workspace().clearance)),
        }
    }

    /// Makes the card of an element that makes the path longer.
    fn of_found(&self, found: &FoundExplanation) -> Vec<CardView> {
        let Some(bound) = found.answer.bound() else { return Vec::new() };
        found.savings.iter().map(|saving| self.of_saving(saving, bound.upper)).collect()
    }

    fn of_saving(&self, saving: &Saving, length: f64) -> CardView {
        let [title, note] = removal(self.scene(), saving, length);
        let changed = self.question.without_at_clearance(&[saving.element]);
        let is_limit = matches!(saving.element, Element::Limit { .. });
        CardView {
            title,
            note,
            removed: self.listed(saving.element).into_iter().collect(),
            c_obstacles: if is_limit { self.contours(changed.scene(), saving.element) } else { Vec::new() },
            domains: self.domains(changed.scene(), saving.element),
            path: Some(self.path(&saving.path)),
            ..CardView::default()
        }
    }

    /// Makes the card of the free configuration that is nearest to a blocked start or goal.
    fn of_end(&self, blocked: &BlockedEnd) -> Option<CardView> {
        let nearest = blocked.nearest.as_ref()?;
        let end = if blocked.end == End::Start { "start" } else { "goal" };
        let moves = blocked
            .tip_moves(self.scene().arm())
            .map_or_else(String::new, |by| format!("; the tip moves by {}", length(by)));
        Some(CardView {
            title: format!("Move the {end} to the nearest free configuration"),
            note: format!("{}{moves}", self.configuration(nearest.configuration)),
            at: Some(self.grain.configuration(nearest.configuration)),
            ..CardView::default()
        })
    }

    /// Makes the card of the nearest place that the tip can reach.
    fn of_reach(&self, out: &OutOfReach) -> CardView {
        let off = (out.tip - out.nearest).norm();
        CardView {
            title: format!("Move the goal {} nearer", headline_length(off, true)),
            note: format!(
                "the tip comes as near as ({:.3}, {:.3}) m, if there are no obstacles",
                out.nearest.x, out.nearest.y
            ),
            at: Some(self.grain.configuration(out.at)),
            ..CardView::default()
        }
    }

    /// Makes the card of the narrowest place.
    fn of_bottleneck(&self, bottleneck: &Bottleneck) -> CardView {
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
        CardView {
            title: "Show the narrowest place".into(),
            note: format!("too narrow by {lacking}{between}"),
            is_place: true,
            at: Some(self.grain.configuration(bottleneck.at)),
            ..CardView::default()
        }
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

    /// Returns the C-obstacles that are different in the world with a change.
    fn contours(&self, changed: &Scene, element: Element) -> Vec<ContourView> {
        let only = match element {
            Element::Obstacle { number } => Some(number),
            // Shapes of revolute joints repeat after each turn, for any limits.
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

    /// Returns the values of both joints after a change of a limit. `None` for another change.
    fn domains(&self, changed: &Scene, element: Element) -> Option<[[f64; 2]; 2]> {
        let domain = |k: usize| changed.arm().joints[k].range.domain().into();
        matches!(element, Element::Limit { .. }).then(|| [domain(0), domain(1)])
    }
}

/// Returns the visible part of the workspace, extended to include changed obstacles, unless they are too far away.
fn extended(frame: [[f64; 2]; 2], cards: &[CardView]) -> [[f64; 2]; 2] {
    let shapes = cards.iter().filter_map(|card| card.changed.as_ref()).flat_map(ObstacleView::own);
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
