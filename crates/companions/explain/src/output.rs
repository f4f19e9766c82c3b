//! An explanation for readers, in words and as a picture.

use super::cards::{blocking, explanation_section};
use super::words::{bounds, headline, instruction};
use super::{BlockedEnd, Bottleneck, Explanation, FoundExplanation, InfeasibleExplanation, OutOfReach};
use cplan_blockers::{End, TIME_LIMIT, Target};
use cplan_model::{Elbow, Outcome, Scene, Status};
use cplan_solver::BoundedPath;
use cplan_text::{fixed, length, length_down, length_up, listed, percent, round_down, round_up, short};
use cplan_view::output::names::capitalized;
use cplan_view::output::{Line, configuration, contours, format_columns, goal_lines, status, title_of};
use cplan_view::{Picture, Section, View};

/// Factor for the time limit that cplan suggests if an explanation was stopped early.
const TIME_LIMIT_FACTOR: f64 = 12.0;

/// Returns the verdict, and then the reasons.
pub fn summary(explanation: &Explanation, notes: &[String]) -> String {
    let scene = explanation.question.scene();
    let mut lines = vec![("result", verdict(explanation))];
    let reasons = explanation.failure.iter().flat_map(|failure| &failure.reasons);
    lines.extend(reasons.map(|reason| ("why", reason.clone())));
    lines.extend(facts(explanation));
    lines.extend(time_limit_note(explanation).map(|words| ("stopped", words)));
    lines.push(("start", configuration(scene.arm(), explanation.question.start())));
    match explanation.question.target() {
        Target::Goals(goals) => lines.extend(goal_lines(scene.arm(), goals)),
        Target::Tip(tip, elbow) => {
            lines.push(("goal", format!("tip at ({}, {}) m{}", tip.x, tip.y, Elbow::describe(*elbow))));
        }
    }
    lines.extend(notes.iter().map(|note| ("note", note.clone())));
    let said = format!("{}\n{}\n{}", headline(explanation), title_of(scene), format_columns(&lines));
    said.replace('\u{b0}', " deg")
}

/// Returns the content of the explanation's pictures and pages.
pub fn view(explanation: &Explanation) -> View {
    with_explanation(view_of_question(explanation), explanation)
}

/// Adds an explanation to the view of the same question: its cards, the obstacles in the way and the narrowest place.
pub fn with_explanation(view: View, explanation: &Explanation) -> View {
    let section = explanation_section(explanation, view.frame());
    let view = view.with_section(section);
    match blocking(explanation) {
        Some(stuck) => view.with_blocking(stuck),
        None => view,
    }
}

/// Adds an explanation of the step that fails to the view of its task. The reason becomes the title. The view remains
/// unchanged if no set of elements is known whose removal opens a path.
pub fn with_step_explanation(mut view: View, explanation: &Explanation) -> View {
    let Some(closed) = explanation.outcome.infeasible() else { return view };
    if closed.sets.iter().all(|set| set.blockers.is_empty()) {
        return view;
    }
    let headline = headline(explanation);
    let headline = headline.strip_prefix("The ").map_or(headline.clone(), |rest| format!("the {rest}"));
    let step = view.status.split(':').next().map(capitalized).unwrap_or_default();
    view.title.insert(0, format!("{step}: {}", headline.trim_end_matches('.')));
    with_explanation(view, explanation)
}

/// Returns the section of a page that shows the explanation.
pub fn section(explanation: &Explanation) -> Section {
    explanation_section(explanation, view_of_question(explanation).frame())
}

/// Returns the view of the question and its answer, without the reasons.
fn view_of_question(explanation: &Explanation) -> View {
    let question = &explanation.question;
    let goals = question.ends();
    let (path, proof) = match &explanation.outcome {
        Outcome::Found(FoundExplanation { answer, .. }) => (answer.path(), None),
        Outcome::Infeasible(InfeasibleExplanation { proof, .. }) => (None, proof.as_ref()),
        Outcome::Unknown(_) => (None, None),
    };
    let picture = Picture {
        title: vec![headline(explanation), title_of(question.scene())],
        status: status(explanation.status()).into(),
        ending: Some(explanation.status()),
        facts: facts(explanation).into_iter().map(|(name, value)| [name.to_owned(), value]).collect(),
        goals: &goals,
        paths: path.into_iter().map(|path| ("shortest".to_owned(), path)).collect(),
        proof,
        c_obstacles: &contours(question.scene()),
        ..Picture::new(question.scene(), question.start())
    };
    View::of_picture(&picture)
}

/// Returns the answer in a sentence.
fn verdict(explanation: &Explanation) -> String {
    let scene = explanation.question.scene();
    let blocking = explanation.outcome.infeasible().and_then(|closed| closed.sets.first());
    let blocking = blocking.filter(|set| !set.blockers.is_empty());
    if let Some(failure) = &explanation.failure
        && (failure.status == Status::Unknown || blocking.is_none())
    {
        return failure.verdict.clone();
    }
    match &explanation.outcome {
        Outcome::Unknown(reason) => format!("unknown: {reason}"),
        Outcome::Found(shaped) => match shaped.savings.len() {
            0 if explanation.is_stopped => {
                "found: a path exists; the time limit ended the search for what makes it longer".into()
            }
            0 => "found: a path exists, and no single obstacle or limit makes the shortest path longer".into(),
            n => format!("found: a path exists; {} the shortest path longer", count_with_makes(n)),
        },
        Outcome::Infeasible(closed) => match blocking {
            Some(set) => format!("infeasible: proven; blocked by {}", set.describe(scene)),
            None if closed.out_of_reach.is_some() => {
                let elbow = closed.out_of_reach.and_then(|out| out.elbow);
                format!("infeasible: the goal is out of reach{}", Elbow::describe(elbow))
            }
            None => "infeasible: there is no path; cplan did not find which obstacles or limits block it".into(),
        },
    }
}

/// Returns a note with an option for more time, if the time limit stopped the explanation.
fn time_limit_note(explanation: &Explanation) -> Option<String> {
    let limit = explanation.question.time_limit().filter(|_| explanation.is_stopped)?.as_secs_f64();
    let more = short((TIME_LIMIT_FACTOR * limit).max(TIME_LIMIT.as_secs_f64()));
    Some(format!("the explanation is incomplete, because its time of {limit} s was up; --time {more} allows more time"))
}

fn count_with_makes(n: usize) -> String {
    if n == 1 { "one thing makes".into() } else { format!("{n} things each make") }
}

/// Returns names and descriptions of the facts that the explanation found.
fn facts(explanation: &Explanation) -> Vec<Line> {
    let scene = explanation.question.scene();
    match &explanation.outcome {
        Outcome::Found(shaped) => found_lines(scene, shaped),
        Outcome::Infeasible(closed) => infeasible(scene, closed),
        Outcome::Unknown(_) => Vec::new(),
    }
}

fn found_lines(scene: &Scene, FoundExplanation { answer, savings }: &FoundExplanation) -> Vec<Line> {
    let mut lines = Vec::new();
    if let Some(bound) = answer.bound() {
        let gap = percent(bound.gap());
        let length = scene.arm().format_length(bound.upper);
        lines.push(("shortest", format!("length {length}; at most {gap} longer than the optimum, proven")));
    }
    for saving in savings {
        let (what, length) = (saving.element.describe(scene), scene.arm().format_length(saving.length));
        let (least, most) = (round_down(saving.at_least, 4), round_up(saving.at_most, 4));
        let by = format!("without {what}, the path has length {length}: at least {least} and at most {most} shorter");
        lines.push(("shaped by", by));
    }
    if let Some(BoundedPath { certified, .. }) = answer.outcome.found()
        && let Some(nearest) = certified.nearest()
    {
        let between = scene.describe(nearest.contact.pair);
        let at = configuration(scene.arm(), nearest.at);
        lines.push(("tightest", format!("at least {}, between {between} at {at}", length_down(certified.clearance()))));
    }
    lines
}

fn infeasible(scene: &Scene, closed: &InfeasibleExplanation) -> Vec<Line> {
    let mut lines: Vec<Line> = closed.ends.iter().flat_map(|end| end_lines(scene, end)).collect();
    lines.extend(closed.out_of_reach.iter().map(|out| ("reach", misses(scene, out))));
    for (number, set) in closed.sets.iter().enumerate() {
        let elements = set.elements();
        if elements.is_empty() {
            continue;
        }
        let boxes = set.proof.as_ref().map_or_else(
            || match closed.ends.iter().any(|end| !end.hits.is_empty()) {
                true => "the start or the goal collides".into(),
                false => "the start or the goal is outside the limits".into(),
            },
            |proof| match proof.collision_boxes().len() {
                1 => "proven by 1 collision box, even if nothing else is in the way".into(),
                n => format!("proven by {n} collision boxes, even if nothing else is in the way"),
            },
        );
        let also = if number == 0 { "" } else { ", which also suffices alone" };
        let proven = if set.is_irreducible() { "" } else { "; not proven irreducible" };
        lines.push(("blocked", format!("{}{also}; {boxes}{proven}", set.describe(scene))));
        for blocker in &set.blockers {
            let what = blocker.element.describe(scene);
            let known =
                if blocker.without.is_some() { "a path is certified" } else { "it is unknown whether a path exists" };
            let others = if elements.len() == 1 { "" } else { " past the others" };
            lines.push(("", format!("  without {what}, {known}{others}")));
        }
    }
    let is_only = closed.sets.iter().map(|set| set.blockers.len()).sum::<usize>() == 1;
    for (set, changes) in closed.sets.iter().zip(&closed.changes) {
        let line =
            |change| format!("{}: {}", instruction(scene, change, is_only), bounds(scene, set, change).join("; "));
        lines.extend(changes.iter().map(|change| ("opens", line(change))));
    }
    lines.extend(closed.bottleneck.iter().map(|bottleneck| ("stuck", bottleneck_line(scene, bottleneck))));
    lines
}

/// Describes the defects of a start or goal, and the nearest free configuration.
fn end_lines(scene: &Scene, blocked: &BlockedEnd) -> Vec<Line> {
    let (arm, scene) = (scene.arm(), blocked.scene(scene));
    let key = if blocked.end == End::Start { "bad start" } else { "bad goal" };
    let beyond = (0..2).filter(|&k| blocked.beyond[k] > 0.0);
    let beyond = beyond.map(|k| {
        format!(
            "joint \"{}\" is {} beyond its limits",
            arm.joints[k].name,
            arm.joints[k].format_value(blocked.beyond[k])
        )
    });
    let motor = blocked.beyond_motor(arm).map(|angle| {
        format!("the angle of the elbow's motor is {:.2} deg ({angle:.4} rad) beyond its range", angle.to_degrees())
    });
    let reasons: Vec<String> = beyond.chain(motor).chain(blocked.hits.iter().map(|hit| scene.explain(hit))).collect();
    let when = blocked.standing.as_ref().map_or_else(String::new, |standing| format!("{}, ", standing.when));
    let mut lines = vec![(key, format!("{}: {when}{}", configuration(arm, blocked.at), listed(&reasons)))];
    if blocked.standing.is_some() {
        return lines;
    }
    lines.push(match (&blocked.nearest, blocked.tip_moves(arm)) {
        (Some(nearest), Some(tip)) => {
            let (at, far) = (configuration(arm, nearest.configuration), nearest.distance);
            ("", format!("  nearest free: {at}; {} away, the tip moves by {}", arm.format_length(far), length(tip)))
        }
        _ => ("", "  the search found no free configuration nearby (not proven)".into()),
    });
    lines
}

/// Describes the distance of a tip goal from the reach.
fn misses(scene: &Scene, out: &OutOfReach) -> String {
    let OutOfReach { tip, nearest, at, elbow } = out;
    format!(
        "within the limits{}, the tip cannot come nearer to ({:.4}, {:.4}) m than {}: at ({:.4}, {:.4}) m, with {}",
        Elbow::describe(*elbow).replace(" with", " and with"),
        tip.x,
        tip.y,
        length((tip - nearest).norm()),
        nearest.x,
        nearest.y,
        configuration(scene.arm(), *at)
    )
}

fn bottleneck_line(scene: &Scene, bottleneck: &Bottleneck) -> String {
    let clearance = scene.workspace().clearance;
    let lacking = bottleneck.missing_distance(clearance);
    let at = configuration(scene.arm(), bottleneck.at);
    let point = bottleneck.point;
    let between: Vec<String> = bottleneck.hits.iter().map(|hit| scene.describe(hit.contact.pair)).collect();
    let between = listed(&between);
    let (open, shut) = (length_up(bottleneck.by.opens), length_down(bottleneck.by.closed));
    format!(
        "at {at}, near ({}, {}) m: too narrow by {} ({between}); if all shapes shrink by {open}, a path opens; by {shut}, none does",
        fixed(point.x, 4),
        fixed(point.y, 4),
        length(lacking)
    )
}
