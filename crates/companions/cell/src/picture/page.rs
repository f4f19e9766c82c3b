//! The page of an answer about a cell.

use super::motions::{ShownMotions, pairs_of_links};
use super::objects::ShownObject;
use super::{ARM_COLORS, Answer, REGION_PALENESS, bases};
use crate::{HandoverTimes, StepTimes};
use cplan_model::Obstacle;
use cplan_motion::Trajectory;
use cplan_theme::{ROBOT, Rgb, UNDECIDED, role_or_hex};
use cplan_view::output::status;
use cplan_view::{ObstacleView, Picture, RoundingSteps, View, drawing, sealed};
use serde_json::{Value, json};

const STYLE: &str = include_str!("../assets/cell.css");

/// Code that draws a cell, after the code of a view.
const SCRIPTS: [&str; 4] = [
    include_str!("../assets/rows.js"),
    include_str!("../assets/diagram.js"),
    include_str!("../assets/objects.js"),
    include_str!("../assets/cell.js"),
];

impl Answer<'_> {
    /// Returns the answer as one self-contained HTML file.
    pub fn page(&self) -> String {
        let pairs = pairs_of_links(self.cell);
        let motions = ShownMotions::of(self, &pairs);
        let views = [0, 1].map(|arm| self.view(arm, motions.as_ref().map(|motions| motions.trajectories[arm])).json());
        let data = self.data(motions.as_ref(), pairs.between([0, 0]).pairs()).to_string();
        // Views have their own serializer, so they become the first entry of the object as text.
        let data = format!("{{\"views\":[{}],{}", views.join(","), &data[1..]);
        sealed(&self.headline(), STYLE, "cell", &data, &(drawing() + &SCRIPTS.concat()))
    }

    /// Returns the view of an arm, with its motion.
    fn view(&self, arm: usize, trajectory: Option<&Trajectory>) -> View {
        let query = self.cell.arms[arm].problem.query();
        View::of_picture(&Picture {
            goals: query.goals().pieces(),
            trajectory,
            ..Picture::new(query.scene(), query.start())
        })
    }

    fn data(&self, motions: Option<&ShownMotions>, pairs: &[[usize; 2]]) -> Value {
        let objects = self.objects(motions);
        let number = |name: &str| objects.iter().position(|object| object.name() == name);
        let step = |step: &StepTimes| {
            let span = [step.begin, step.end].map(short);
            json!({
                "span": span,
                "number": step.number,
                "text": step.action,
                "object": step.object.as_deref().and_then(number),
                "event": step.event.map(short),
                "places": step.released.is_some(),
            })
        };
        let handover = |times: &HandoverTimes| {
            json!({
                "object": number(&times.object),
                "giver": times.giver,
                "placed": short(times.placed),
                "taken": short(times.taken),
            })
        };
        let arm = |arm: usize| {
            let waits = motions.map_or(&[][..], |motions| motions.waits[arm]);
            let waits = waits.iter().map(|wait| [wait.from, wait.to].map(short));
            let steps = motions.map_or(&[][..], |motions| motions.steps[arm]);
            json!({
                "name": self.names()[arm],
                "color": role_or_hex(ARM_COLORS[arm]),
                "waits": waits.collect::<Vec<_>>(),
                "steps": steps.iter().map(step).collect::<Vec<_>>(),
                "end": motions.map(|motions| motions.trajectories[arm].duration()),
            })
        };
        let facts: Vec<[&str; 2]> = self.facts.iter().map(|(name, value)| [*name, value.as_str()]).collect();
        let verdict = self.facts.first().map_or("", |(_, result)| result.as_str());
        let clearance = self.scenes()[0].workspace().clearance;
        json!({
            "title": [self.headline(), format!("{} \u{b7} {verdict}", self.cell.name)],
            "status": status(self.plan.status()),
            "ending": self.plan.status().name(),
            "facts": facts,
            "cards": self.cards(),
            "arms": [arm(0), arm(1)],
            "obstacles": self.obstacle_views(),
            "named": self.obstacles().count(),
            "objects": objects.iter().map(ShownObject::json).collect::<Vec<_>>(),
            "handovers": motions.map_or(&[][..], |motions| motions.handovers).iter().map(handover).collect::<Vec<_>>(),
            "frame": self.extent(motions).map(|(low, high)| [low, high].map(short)),
            "pairs": pairs,
            "clearance": clearance,
            "skew": self.skew,
            "paleness": REGION_PALENESS,
            "motions": motions.map(motion),
        })
    }

    /// Returns the obstacles of the cell, and the bases of the robots.
    fn obstacle_views(&self) -> Vec<ObstacleView> {
        let grain = RoundingSteps::of(self.scenes()[0].arm());
        let colored = |obstacle: &Obstacle, name: String, color: Rgb| {
            let mut view = ObstacleView::new(obstacle, 0, grain);
            (view.name, view.color) = (name, color);
            view
        };
        let mut views: Vec<ObstacleView> =
            self.obstacles().map(|obstacle| colored(obstacle, obstacle.name.clone(), UNDECIDED)).collect();
        let robots = if self.cell.is_one_robot { 1 } else { 2 };
        for (scene, name) in self.scenes().into_iter().zip(self.names()).take(robots) {
            let named = if robots == 1 { "base".to_owned() } else { format!("base of {name}") };
            views.extend(bases(scene).map(|base| colored(base, named.clone(), ROBOT)));
        }
        views
    }
}

/// Returns the motions for the page.
fn motion(motions: &ShownMotions) -> Value {
    let regions = motions.regions().map(|sides| {
        let corners = sides.iter().flat_map(|[x, y]| [x[0], y[0], x[1], y[1]]);
        corners.map(short).collect::<Vec<_>>()
    });
    let signals =
        motions.signals.iter().map(|signal| json!({ "waits": signal.waits, "at": signal.at, "set": signal.set }));
    json!({
        "duration": motions.duration,
        "certified": motions.are_certified,
        "collides": motions.collides,
        "regions": regions,
        "signals": signals.collect::<Vec<_>>(),
    })
}

/// Rounds a time or a length for the page.
pub fn short(value: f64) -> f64 {
    (value * 1e4).round() / 1e4 + 0.0
}
