//! `cplan check`: reports whether a configuration is free, and why.

use super::exit::{DONE, REFUTED};
use super::failure::Failure;
use super::files::Files;
use super::outputs::{Outputs, drawn, refuse_to_overwrite_inputs};
use super::sinks;
use super::theme::ThemeArgs;
use super::values::clearance;
use crate::engine::findings::{BasisFinding, ConfigurationFindings, CornerFinding, NearestFinding, PairFinding, check};
use crate::input::{self, CalibrationTable, JointValues, LoadedScene, RobotReport};
use crate::options::number_in;
use crate::output::{checked_words, configuration, contours, range};
use crate::space::{Configuration, JointRange};
use crate::text::{Columns, fixed, length, length_down, length_unlike};
use crate::view::{CheckedView, Picture, View};
use clap::{Args, ValueEnum, ValueHint};
use std::path::PathBuf;

/// Report why a configuration is free or not.
///
/// The report lists violated joint limits, penetrations and crossing sides.
#[derive(Debug, Args)]
#[command(after_help = "\
Depths and distances are in metres. If the configuration is not free, the report
also names the nearest free one.

Examples:
  cplan check robots/planar_2r.urdf workspaces/shelf.toml --at 10deg,45deg
  cplan check robots/planar_2r.urdf workspaces/shelf.toml --at 0.14,0 \\
    --clearance 0.02 --picture why.html
  cplan check robots/scara.urdf workspaces/scara_cell.toml --at=-1,-0.9 --json
  cplan check robots/planar_2r.urdf workspaces/shelf.toml --at 8deg,0deg \\
    --expect blocked

Exit codes: 0 the configuration was checked, free or not, 1 bad input, or a file
cannot be read or written, 2 wrong command line, 3 the answer is not that of
--expect.")]
pub struct CheckArgs {
    #[command(flatten)]
    pub files: Files,
    /// Configuration to check, such as 0.3,-1 or 20deg,-60deg.
    #[arg(long, value_name = "q1,q2", allow_hyphen_values = true)]
    pub at: JointValues,
    /// Time for the positions of moving obstacles, seconds since the motion begins.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = time, allow_hyphen_values = true)]
    pub time: f64,
    /// Least distance to keep from every obstacle, metres or as in 20mm, instead of the world's.
    #[arg(long, value_name = "METRES", value_parser = clearance, allow_hyphen_values = true)]
    pub clearance: Option<f64>,
    /// Errors within which the answer holds, instead of the world's, such as
    /// "base=0.5mm,0.05deg; links=0.2mm; zeros=0.02deg; obstacles=1mm".
    #[arg(long, value_name = "KEY=VALUE,..")]
    pub calibration: Option<CalibrationTable>,
    /// Expected answer: if the configuration is not so, the exit code is 3. For the grading of exercises.
    #[arg(long, value_name = "ANSWER")]
    pub expect: Option<Expected>,
    /// Draw workspace and configuration space with the configuration: .svg, .png or .html. Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub picture: Vec<PathBuf>,
    #[command(flatten)]
    pub theme: ThemeArgs,
    /// Print the findings as JSON.
    #[arg(long)]
    pub json: bool,
}

/// An expected answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Expected {
    /// Free: within the limits, with the clearance from all obstacles
    Free,
    /// Blocked: beyond a limit, or nearer to an obstacle than the clearance
    Blocked,
}

fn time(text: &str) -> Result<f64, String> {
    number_in(text, |x| x.is_finite() && x >= 0.0, "of seconds, finite and not negative")
}

/// Checks a configuration and prints the report.
///
/// # Errors
/// Bad input and I/O. A configuration that is not free is no error, because the report states it. An answer that differs from
/// the expected one has its own exit code.
pub fn run(args: &CheckArgs) -> Result<u8, Failure> {
    let outputs = Outputs::of_pictures(&args.picture, [])?;
    let mut loaded =
        input::load_scene(args.files.robot(), &args.files.world)?.with_margins(args.clearance, args.calibration)?;
    loaded.scene = loaded.timed().frozen(args.time);
    refuse_to_overwrite_inputs(outputs.paths(), &loaded.files())?;
    loaded.robot.warnings.iter().for_each(|w| sinks::print_status(&format!("warning: {w}")));
    let scene = &loaded.scene;
    let q = args.at.resolve(&scene.arm().joints, "--at").map_err(input::InputError::from)?;
    let findings = check(scene, q);
    outputs.write_pictures(vec![], drawn(|| args.theme.apply(view(args, &loaded, q, &findings))))?;
    let is_expected = args.expect.map(|expected| (expected == Expected::Free) == findings.free);
    if args.json {
        sinks::print_json(&sinks::pretty(&findings)?)?;
    } else {
        let mut columns = Columns::default();
        report(&loaded, args.at, q, &findings).iter().for_each(|(key, value)| columns.add(key, value));
        if let Some(is_expected) = is_expected {
            columns.add("expected", if is_expected { "yes" } else { "no" });
        }
        sinks::sum_up(&columns.into_text(), if findings.free { DONE } else { REFUTED })?;
    }
    Ok(if is_expected == Some(false) { REFUTED } else { DONE })
}

fn view(args: &CheckArgs, loaded: &LoadedScene, q: Configuration, findings: &ConfigurationFindings) -> View {
    let scene = &loaded.scene;
    let named = |name: &str| name.rsplit(['/', '\\']).next().unwrap_or(name).trim_end_matches(".toml").to_owned();
    let world = match scene.workspace().name.as_str() {
        "" => args.files.world.file_name().map(|name| named(&name.to_string_lossy())),
        name => Some(name.to_owned()),
    };
    let place: Vec<String> = std::iter::once(scene.arm().name.clone()).chain(world).collect();
    let view = View::of_picture(&Picture {
        title: vec![
            checked_words::title(scene, findings),
            format!("{}: {}", place.join(", "), configuration(scene.arm(), q)),
        ],
        status: outcome(findings).to_owned(),
        facts: page_facts(report(loaded, args.at, q, findings)),
        c_obstacles: &contours(scene),
        ..Picture::new(scene, q)
    });
    view.with_findings(CheckedView::new(scene, findings))
}

/// Returns the facts that the title and the key figures of a page do not state, with those about the arm last.
fn page_facts(report: Vec<(&'static str, String)>) -> Vec<[String; 2]> {
    let mut facts: [Vec<[String; 2]>; 2] = Default::default();
    let mut current = "";
    for (key, value) in report {
        current = if key.is_empty() { current } else { key };
        if !matches!(current, "result" | "at" | "tip" | "distance") {
            facts[usize::from(matches!(current, "arm" | "plane"))].push([key.to_owned(), value]);
        }
    }
    facts.concat()
}

fn outcome(findings: &ConfigurationFindings) -> &'static str {
    if findings.free { "free" } else { "not free" }
}

/// Returns the lines of the report, with their keys. The key of a continuation line is empty. `at` holds the values as written.
fn report(
    loaded: &LoadedScene,
    at: JointValues,
    q: Configuration,
    findings: &ConfigurationFindings,
) -> Vec<(&'static str, String)> {
    let scene = &*loaded.scene.drawn();
    let arm = scene.arm();
    let mut lines = Vec::new();
    let mut line = |key: &'static str, value: String| lines.push((key, value));
    let apart = findings.clearance.filter(|apart| findings.free && *apart > 0.0);
    let apart = apart
        .zip(scene.closest(q))
        .map(|(apart, near)| format!(", {} from {}", length_down(apart), scene.describe_obstacle(near.pair.obstacle)));
    line("result", format!("{}{}", outcome(findings), apart.unwrap_or_default()));
    line("at", configuration(arm, q));
    let [x, y] = findings.tip.map(|c| fixed(c, 4));
    line("tip", format!("({x}, {y}) m"));
    for (k, joint) in arm.joints.iter().enumerate() {
        let (name, value) = (&joint.name, joint.format_value(q[k]));
        line(
            "limits",
            match joint.range {
                JointRange::Interval { lower, upper } if !findings.within_limits[k] => {
                    let [value, lower, upper] = joint.format_distinct([q[k], lower, upper]);
                    format!("{name}: {value} is OUTSIDE {lower} to {upper}")
                }
                _ => format!("{name}: {value} is within {}", range(joint)),
            },
        );
    }
    if let Some(motors) = &findings.motors {
        let [first, second] = motors.angles.map(|angle| format!("{:.2} deg", angle.to_degrees()));
        let beyond = if motors.within_limits { "" } else { "; the elbow's motor is OUTSIDE its limits" };
        line("motors", format!("{first}, {second}{beyond}"));
    }
    for contact in &findings.contacts {
        let PairFinding { link, body, obstacle, touching, depth, required, least, .. } = contact;
        let link = if body == link { format!("\"{link}\"") } else { format!("\"{link}\" (body \"{body}\")") };
        let how = match (touching, *depth > 0.0) {
            (true, true) => format!("penetrates by {}", length(*depth)),
            (true, false) => "touches".into(),
            (false, _) => {
                format!("is {} away, less than {least}", length_unlike(-depth, *required))
            }
        };
        line("contact", format!("link {link}, obstacle \"{obstacle}\": {how}"));
        for (whose, corners) in [("link", &contact.link_corners_inside), ("obstacle", &contact.obstacle_corners_inside)]
        {
            for CornerFinding { at, depth } in corners {
                line("", format!("  {whose} corner ({:.4}, {:.4}) is {} inside", at[0], at[1], length(*depth)));
            }
        }
        for [mine, other] in &contact.crossing_sides {
            let side = |s: &[[f64; 2]; 2]| format!("({:.4}, {:.4})-({:.4}, {:.4})", s[0][0], s[0][1], s[1][0], s[1][1]);
            line("", format!("  link side {} crosses obstacle side {}", side(mine), side(other)));
        }
    }
    if let Some(clearance) = findings.clearance.filter(|c| *c > 0.0) {
        let nearest = scene.closest(q).map(|c| scene.describe(c.pair)).unwrap_or_default();
        line("distance", format!("{} to the nearest obstacle: {nearest}", length_down(clearance)));
    }
    match &findings.nearest_free {
        Some(NearestFinding { configuration: at, distance, resolution, .. }) => {
            let at = configuration(arm, Configuration::from(*at));
            line("nearest", format!("free: {at}; {} away", arm.format_length(*distance)));
            let [first, second] = &arm.joints;
            let step = format!("{resolution:.2e} {}", first.unit());
            line(
                "",
                format!(
                    "(nearest for values of {} in steps of {step}; all values of {} are considered)",
                    first.name, second.name
                ),
            );
        }
        None if !findings.free => line("nearest", "the search found no free configuration (not proven)".into()),
        None => {}
    }
    line("arm", format!("{} ({})", arm.name, arm.kind()));
    let axis = |v: [f64; 3]| format!("({})", v.map(|c| fixed(c, 4)).join(", "));
    let BasisFinding { u, v, normal } = &findings.plane;
    line("plane", format!("u = {}, v = {}, heights along {}; root frame", axis(*u), axis(*v), axis(*normal)));
    let RobotReport { geometry, notes, .. } = &loaded.robot;
    geometry.iter().for_each(|fact| line("", fact.clone()));
    notes.iter().chain(&loaded.world.notes).for_each(|note| line("note", note.clone()));
    at.hint_for_degrees(scene, q).into_iter().for_each(|hint| line("hint", hint));
    lines
}
