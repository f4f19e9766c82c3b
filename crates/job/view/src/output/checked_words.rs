//! A checked configuration in words: the answer in a sentence, and key figures.

use super::names::{joint_name, obstacle_name, part_of_pair};
use cplan_engine::findings::ConfigurationFindings;
use cplan_model::Scene;
use cplan_model::space::{Configuration, JointRange};
use cplan_text::{length, length_unlike};

/// Returns a distance with three significant digits, or with more if it would otherwise look equal to the required one.
pub fn distance(metres: f64, required: f64) -> String {
    let [rounded, required_text] = [metres, required].map(three_digits);
    if metres != required && rounded == required_text { length_unlike(metres, required) } else { rounded }
}

fn three_digits(metres: f64) -> String {
    let (value, unit) = if metres.abs() >= 0.9995 { (metres, "m") } else { (1e3 * metres, "mm") };
    let decimals = if value == 0.0 { 0 } else { (2 - value.abs().log10().floor() as i32).clamp(0, 3) };
    let text = format!("{value:.*}", decimals as usize);
    if value != 0.0 && text.parse() == Ok(0.0) { length(metres) } else { format!("{text} {unit}") }
}

/// Returns the answer as a sentence without full stop: `Free: 72.0 mm from the shelf`.
pub fn title(scene: &Scene, findings: &ConfigurationFindings) -> String {
    let answer = if findings.free { "Free" } else { "Not free" };
    let beyond = (0..2).find(|&k| !findings.within_limits[k]);
    if let Some(k) = beyond {
        return format!("Not free: {} is beyond its limits", joint_name(&scene.arm().joints[k]));
    }
    if findings.motors.as_ref().is_some_and(|motors| !motors.within_limits) {
        return "Not free: the elbow's motor is beyond its limits".into();
    }
    let drawn = scene.drawn();
    let Some(near) = drawn.closest(findings.configuration.into()) else {
        return format!("{answer}: no obstacle within reach");
    };
    let (who, what) = (part_of_pair(scene, near.pair), obstacle_name(scene, near.pair.obstacle));
    let apart = near.separation.distance;
    let touches = findings.contacts.iter().any(|contact| contact.touching);
    match () {
        () if findings.free && apart > 0.0 => format!("Free: {} from {what}", distance(apart, findings.required)),
        () if findings.free => "Free".into(),
        () if touches && apart < 0.0 => format!("Not free: {who} is {} deep in {what}", distance(-apart, 0.0)),
        () if touches => format!("Not free: {who} touches {what}"),
        () => format!(
            "Not free: {who} is {} from {what}, less than {}",
            distance(apart, scene.required(near.pair)),
            scene.describe_required(near.pair)
        ),
    }
}

/// Returns the key figures: name, value and meaning of each.
pub fn cards(scene: &Scene, findings: &ConfigurationFindings) -> Vec<[String; 3]> {
    let q = Configuration::from(findings.configuration);
    let mut cards = Vec::new();
    let mut card = |name: &str, value: String, note: String| cards.push([name.to_owned(), value, note]);
    if let Some(near) = scene.drawn().closest(q) {
        let pair = format!("{} and {}", part_of_pair(scene, near.pair), obstacle_name(scene, near.pair.obstacle));
        match near.separation.distance {
            apart if apart > 0.0 => card("distance", distance(apart, findings.required), pair),
            apart if apart < 0.0 => card("depth", distance(-apart, 0.0), pair),
            _ => {}
        }
    }
    let [x, y] = findings.tip.map(|value| format!("{value:.3}").replace('-', "\u{2212}"));
    card("tip", format!("({x}, {y}) m"), "position in the plane".into());
    let margins = (0..2).filter_map(|k| match scene.arm().joints[k].range {
        JointRange::Interval { lower, upper } => Some((k, (q[k] - lower).min(upper - q[k]))),
        JointRange::Circle => None,
    });
    if let Some((k, margin)) = margins.min_by(|a, b| a.1.total_cmp(&b.1)) {
        let joint = &scene.arm().joints[k];
        let amount = match joint.joint_type.is_revolute() {
            true => format!("{:.1}\u{b0}", margin.abs().to_degrees()),
            false => three_digits(margin.abs()),
        };
        let note = if findings.within_limits[k] { "to the nearest limit" } else { "beyond the limit" };
        card("limits", amount, format!("{note}, of {}", joint_name(joint)));
    }
    if let Some(nearest) = &findings.nearest_free {
        let values = (0..2).map(|k| {
            let (joint, value) = (&scene.arm().joints[k], nearest.configuration[k]);
            match joint.joint_type.is_revolute() {
                true => format!("{:.1}\u{b0}", value.to_degrees()).replace('-', "\u{2212}"),
                false => three_digits(value).replace('-', "\u{2212}"),
            }
        });
        let note = format!("nearest free configuration, {} away", scene.arm().format_length(nearest.distance));
        card("free at", values.collect::<Vec<_>>().join(", "), note);
    }
    cards
}
