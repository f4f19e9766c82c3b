//! An explanation as JSON.

use super::{
    BlockedEnd, Bottleneck, Change, Explanation, FoundExplanation, InfeasibleExplanation, OutOfReach, Saving,
    StepFailure,
};
use cplan_blockers::{Blocker, Element};
use cplan_judge::ProofBox;
use cplan_model::{Obstruction, Outcome, Scene, Status};
use serde_json::{Value, json};

impl Explanation {
    /// Returns the explanation as a JSON object, in the format that the book describes.
    pub fn to_json(&self) -> Value {
        let scene = self.question.scene();
        let mut object = match &self.outcome {
            Outcome::Found(shaped) => of_found(scene, shaped),
            Outcome::Infeasible(closed) => of_closed(scene, closed),
            Outcome::Unknown(reason) => json!({ "reason": reason }),
        };
        object["status"] = json!(self.status());
        object["joints"] = json!(scene.arm().joints.each_ref().map(|joint| &joint.name));
        object["start"] = json!(self.question.start());
        if let Some(StepFailure { status, reasons, .. }) = &self.failure {
            object["reasons"] = json!(reasons);
            if *status == Status::Unknown {
                object["reason"] = json!(reasons.join("; "));
            }
        }
        if let (true, Some(limit)) = (self.is_stopped, self.question.time_limit()) {
            object["stopped_after"] = json!(limit.as_secs_f64());
        }
        object
    }
}

/// Returns kind and name of an element. Obstacles are counted from 1, as for readers of text.
fn of_element(scene: &Scene, element: Element) -> Value {
    match element {
        Element::Obstacle { number } => {
            json!({ "kind": "obstacle", "name": scene.obstacle(number).name, "number": number + 1 })
        }
        Element::Link { number } => {
            json!({ "kind": "link", "name": scene.obstacle(number).name })
        }
        Element::Limit { joint, side } => {
            json!({ "kind": "limit", "joint": scene.arm().joints[joint].name, "side": side })
        }
        Element::Motor => json!({ "kind": "motor" }),
        Element::Clearance => json!({ "kind": "clearance" }),
    }
}

fn of_found(scene: &Scene, FoundExplanation { answer, savings }: &FoundExplanation) -> Value {
    let saving = |saving: &Saving| {
        let mut object = of_element(scene, saving.element);
        object["length"] = json!(saving.length);
        object["shorter_by"] = json!({ "at_least": saving.at_least, "at_most": saving.at_most });
        object
    };
    let mut object = json!({ "shaped_by": savings.iter().map(saving).collect::<Vec<_>>() });
    if let Some(bound) = answer.bound() {
        object["length"] = json!(bound.upper);
        object["lower_bound"] = json!(bound.lower);
    }
    if let Some(path) = answer.outcome.found().map(|path| &path.certified) {
        object["path"] = json!(path.path().waypoints());
        if let Some(nearest) = path.nearest() {
            object["tightest"] = json!({
                "joints": nearest.at,
                "clearance": path.clearance(),
                "between": scene.describe(nearest.contact.pair),
            });
        }
    }
    object
}

fn of_closed(scene: &Scene, closed: &InfeasibleExplanation) -> Value {
    let InfeasibleExplanation { sets, changes, bottleneck, ends, out_of_reach, .. } = closed;
    let change = |Change { cure, among, by, .. }: &Change| {
        let mut object = json!(cure);
        object["opens"] = json!(by.opens);
        object["closed"] = json!(by.closed);
        object["among"] = json!(among);
        object
    };
    let blocker = |Blocker { element, without }: &Blocker, changes: &[Change]| {
        let without = if without.is_some() { "found" } else { "unknown" };
        let changes: Vec<Value> = changes.iter().filter(|change| change.element == *element).map(change).collect();
        let mut object = of_element(scene, *element);
        object["without"] = json!(without);
        object["changes"] = json!(changes);
        object
    };
    let sets: Vec<Value> = sets
        .iter()
        .zip(changes)
        .map(|(set, changes)| {
            let proof: Option<Vec<ProofBox>> =
                set.proof.as_ref().map(|proof| proof.collision_boxes().iter().map(ProofBox::from).collect());
            let blockers: Vec<Value> = set.blockers.iter().map(|one| blocker(one, changes)).collect();
            json!({ "blockers": blockers, "proof": proof, "irreducible": set.is_irreducible() })
        })
        .collect();
    json!({
        "blocking": closed.blocking(scene),
        "sets": sets,
        "bottleneck": bottleneck.as_ref().map(|bottleneck| of_bottleneck(scene, bottleneck)),
        "blocked_ends": ends.iter().map(|end| of_end(scene, end)).collect::<Vec<_>>(),
        "out_of_reach": out_of_reach.as_ref().map(of_out_of_reach),
    })
}

impl InfeasibleExplanation {
    /// Returns the names of the obstacles and links of the robot in the first blocking set.
    pub fn blocking<'a>(&self, scene: &'a Scene) -> Vec<&'a str> {
        let elements = self.sets.first().map(|set| set.elements()).unwrap_or_default();
        let numbers = elements.into_iter().filter_map(Element::obstacle);
        numbers.map(|number| scene.obstacle(number).name.as_str()).collect()
    }
}

fn of_end(scene: &Scene, blocked: &BlockedEnd) -> Value {
    let nearest = blocked.nearest.map(|nearest| {
        let tip_moves = blocked.tip_moves(scene.arm());
        json!({ "joints": nearest.configuration, "distance": nearest.distance, "tip_moves": tip_moves })
    });
    json!({
        "end": blocked.end,
        "joints": blocked.at,
        "beyond_limits": blocked.beyond,
        "when": blocked.standing.as_ref().map(|standing| standing.when),
        "hits": blocked.hits.iter().map(|hit| of_hit(blocked.scene(scene), hit)).collect::<Vec<_>>(),
        "nearest_free": nearest,
    })
}

fn of_out_of_reach(out: &OutOfReach) -> Value {
    let OutOfReach { tip, nearest, at, elbow } = *out;
    let mut object = json!({ "tip": tip, "nearest": nearest, "joints": at, "misses": (tip - nearest).norm() });
    if let Some(elbow) = elbow {
        object["elbow"] = elbow.name().into();
    }
    object
}

fn of_hit(scene: &Scene, hit: &Obstruction) -> Value {
    let lacking = scene.workspace().clearance - hit.contact.separation.distance;
    json!({ "between": scene.describe(hit.contact.pair), "lacking": lacking })
}

fn of_bottleneck(scene: &Scene, bottleneck: &Bottleneck) -> Value {
    let clearance = scene.workspace().clearance;
    let hits = bottleneck.hits.iter().map(|hit| of_hit(scene, hit));
    json!({
        "joints": bottleneck.at,
        "point": bottleneck.point,
        "too_narrow_by": bottleneck.missing_distance(clearance),
        "gives_way": { "opens": bottleneck.by.opens, "closed": bottleneck.by.closed },
        "hits": hits.collect::<Vec<_>>(),
    })
}
