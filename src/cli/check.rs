//! `cplan check`: why a configuration is, or is not, free.

use super::DONE;
use super::args::CheckArgs;
use super::failure::Failure;
use super::sinks::{self, Sink};
use crate::cspace::{NearestFree, nearest_free};
use crate::draw::{Picture, View};
use crate::geometry::{CornerInside, Point, polygon_test, shapes_meet};
use crate::input::{self, LoadedScene};
use crate::model::{Contact, Scene};
use crate::output::{configuration, contours, range, value};
use crate::space::Configuration;
use crate::text::Columns;
use nalgebra::Vector3;
use serde::Serialize;

/// What there is to say about one configuration.
#[derive(Debug, Serialize)]
struct Findings {
    /// Within the limits and nearer to no obstacle than allowed.
    free: bool,
    configuration: [f64; 2],
    within_limits: [bool; 2],
    /// The tip in plane coordinates, metres.
    tip: [f64; 2],
    /// Least signed distance to an obstacle, metres; none if nothing can be hit.
    #[serde(skip_serializing_if = "Option::is_none")]
    clearance: Option<f64>,
    /// The distance to keep, metres.
    required: f64,
    plane: Basis,
    /// Every pair in contact, or nearer than the distance to keep.
    contacts: Vec<PairFinding>,
    /// Where to go instead, if the configuration is not free.
    #[serde(skip_serializing_if = "Option::is_none")]
    nearest_free: Option<NearestFinding>,
}

/// The nearest free configuration, within the limits and with the clearance asked for.
#[derive(Debug, Serialize)]
struct NearestFinding {
    configuration: [f64; 2],
    /// In joint space, radians and metres as they come.
    distance: f64,
    /// Metres; none if nothing can be hit.
    #[serde(skip_serializing_if = "Option::is_none")]
    clearance: Option<f64>,
    /// Spacing of the values of joint 1 that were looked at, before refinement; joint 2 is exact for each.
    resolution: f64,
}

/// The plane's basis in the root frame.
#[derive(Debug, Serialize)]
struct Basis {
    u: [f64; 3],
    v: [f64; 3],
    normal: [f64; 3],
}

#[derive(Debug, Serialize)]
struct PairFinding {
    link: String,
    body: String,
    obstacle: String,
    touching: bool,
    /// Penetration depth, metres; negative is a distance.
    depth: f64,
    /// Corners of the link in the obstacle: plane coordinates and depth. Empty for rounded shapes.
    link_corners_inside: Vec<CornerFinding>,
    obstacle_corners_inside: Vec<CornerFinding>,
    /// Crossing sides, each given by its two corners: the link's and the obstacle's.
    crossing_sides: Vec<[[[f64; 2]; 2]; 2]>,
}

#[derive(Debug, Serialize)]
struct CornerFinding {
    at: [f64; 2],
    depth: f64,
}

/// Checks and reports.
///
/// # Errors
/// Bad input and I/O. A configuration that is not free is no error: saying why is the job.
pub fn run(args: &CheckArgs) -> Result<u8, Failure> {
    let sinks = sinks::sinks(&[], &args.picture)?;
    let loaded = input::load_scene(&args.files.urdf, &args.files.world)?.keeping(args.clearance)?;
    sinks::spare_inputs(sinks.iter().map(Sink::path))?;
    loaded.robot.warnings.iter().for_each(|w| sinks::say(&format!("warning: {w}")));
    let scene = &loaded.scene;
    let q = args.at.resolve(&scene.arm().joints, "--at").map_err(input::InputError::from)?;
    let findings = findings(scene, q);
    for sink in &sinks {
        if let Sink::Picture(format, path) = sink {
            sinks::save_picture(*format, path, &view(scene, q, findings.free))?;
        }
    }
    if args.json {
        sinks::print_json(&sinks::pretty(&findings)?)?;
    } else {
        sinks::tell(&text(&loaded, q, &findings))?;
    }
    Ok(DONE)
}

fn findings(scene: &Scene, q: Configuration) -> Findings {
    let topology = scene.arm().topology();
    let within_limits = [0, 1].map(|k| topology.ranges[k].contains(q[k]));
    let required = scene.workspace().clearance;
    let contacts: Vec<PairFinding> = scene.separations(q).filter_map(|contact| finding(scene, q, contact)).collect();
    let free = within_limits == [true, true] && contacts.is_empty();
    let nearest = if free { None } else { nearest_free(scene, q) };
    let plane = scene.arm().plane;
    let array = |v: Vector3<f64>| [v.x, v.y, v.z];
    Findings {
        free,
        configuration: [q[0], q[1]],
        within_limits,
        tip: pair(scene.arm().tip_at(q)),
        clearance: Some(scene.clearance(q)).filter(|c| c.is_finite()),
        required,
        plane: Basis { u: array(plane.u), v: array(plane.v), normal: array(plane.normal) },
        contacts,
        nearest_free: nearest.map(|found: NearestFree| NearestFinding {
            configuration: [found.configuration[0], found.configuration[1]],
            distance: found.distance,
            clearance: Some(found.clearance).filter(|c| c.is_finite()),
            resolution: found.spacing,
        }),
    }
}

/// What is to say of a pair, if its shapes touch or are nearer than the distance to keep.
fn finding(scene: &Scene, q: Configuration, contact: Contact) -> Option<PairFinding> {
    let Contact { pair: indices, separation } = contact;
    let part = scene.part(indices).at(&scene.arm().pose(indices.link, q));
    let piece = scene.piece(indices);
    let touching = shapes_meet(&part, piece);
    if !touching && separation.distance >= scene.workspace().clearance {
        return None;
    }
    let (a, b) = (part.core(), piece.core());
    // Corners and sides are those of polygons; of rounded shapes the depth says it all.
    let sharp = part.radius() == 0.0 && piece.radius() == 0.0;
    let test = sharp.then(|| polygon_test(&part, piece));
    let inside = |corners: &[Point], found: &[CornerInside]| {
        found.iter().map(|c| CornerFinding { at: pair(corners[c.corner]), depth: c.depth }).collect()
    };
    let side = |corners: &[Point], i: usize| [pair(corners[i]), pair(corners[(i + 1) % corners.len()])];
    let link = &scene.arm().links[indices.link];
    Some(PairFinding {
        link: link.name.clone(),
        body: link.parts[indices.part].body.clone(),
        obstacle: scene.workspace().obstacles[indices.obstacle].name.clone(),
        touching,
        depth: -separation.distance,
        link_corners_inside: test.as_ref().map_or_else(Vec::new, |t| inside(a, &t.a_inside)),
        obstacle_corners_inside: test.as_ref().map_or_else(Vec::new, |t| inside(b, &t.b_inside)),
        crossing_sides: test
            .map_or_else(Vec::new, |t| t.crossings.iter().map(|&(i, k)| [side(a, i), side(b, k)]).collect()),
    })
}

fn pair(p: Point) -> [f64; 2] {
    [p.x, p.y]
}

fn view(scene: &Scene, q: Configuration, free: bool) -> View {
    View::of_picture(&Picture {
        title: vec![scene.arm().name.clone(), configuration(scene.arm(), q)],
        status: if free { "free".into() } else { "not free".into() },
        c_obstacles: &contours(scene),
        ..Picture::new(scene, q)
    })
}

fn text(loaded: &LoadedScene, q: Configuration, findings: &Findings) -> String {
    let scene = &loaded.scene;
    let arm = scene.arm();
    let mut columns = Columns::default();
    let mut line = |key: &str, value: String| columns.add(key, &value);
    line("arm", format!("{} ({})", arm.name, arm.kind()));
    let axis = |v: [f64; 3]| format!("({:.4}, {:.4}, {:.4})", v[0], v[1], v[2]);
    let Basis { u, v, normal } = &findings.plane;
    line("plane", format!("u = {}, v = {}, heights along {}; root frame", axis(*u), axis(*v), axis(*normal)));
    loaded.robot.notes.iter().chain(&loaded.world.notes).for_each(|note| line("", note.clone()));
    line("at", configuration(arm, q));
    line("tip", format!("({:.4}, {:.4}) m", findings.tip[0], findings.tip[1]));
    for (k, joint) in arm.joints.iter().enumerate() {
        let verdict = if findings.within_limits[k] { "within" } else { "OUTSIDE" };
        line("limits", format!("{}: {} is {verdict} {}", joint.name, value(joint, q[k]), range(joint)));
    }
    for contact in &findings.contacts {
        let PairFinding { link, body, obstacle, touching, depth, .. } = contact;
        let link = if body == link { format!("\"{link}\"") } else { format!("\"{link}\" (body \"{body}\")") };
        let how = match (touching, *depth > 0.0) {
            (true, true) => format!("penetrates by {depth:.6} m"),
            (true, false) => "touches".into(),
            (false, _) => format!("is {:.6} m away, less than the clearance of {} m", -depth, findings.required),
        };
        line("contact", format!("link {link}, obstacle \"{obstacle}\": {how}"));
        for (whose, corners) in [("link", &contact.link_corners_inside), ("obstacle", &contact.obstacle_corners_inside)]
        {
            for CornerFinding { at, depth } in corners {
                line("", format!("  {whose} corner ({:.4}, {:.4}) is {depth:.6} m inside", at[0], at[1]));
            }
        }
        for [mine, other] in &contact.crossing_sides {
            let side = |s: &[[f64; 2]; 2]| format!("({:.4}, {:.4})-({:.4}, {:.4})", s[0][0], s[0][1], s[1][0], s[1][1]);
            line("", format!("  link side {} crosses obstacle side {}", side(mine), side(other)));
        }
    }
    if let Some(clearance) = findings.clearance.filter(|c| *c > 0.0) {
        let nearest = scene.closest(q).map(|c| scene.describe(c.pair)).unwrap_or_default();
        line("distance", format!("{clearance:.6} m to the nearest obstacle: {nearest}"));
    }
    match &findings.nearest_free {
        Some(NearestFinding { configuration: at, distance, resolution, .. }) => {
            let at = configuration(arm, Configuration::from(*at));
            line("nearest", format!("free: {at}; {distance:.4} away in joint space"));
            let [first, second] = &arm.joints;
            let step = format!("{resolution:.2e} {}", first.unit());
            line("", format!("(looked at values of {} every {step}; {} exact for each)", first.name, second.name));
        }
        None if !findings.free => line("nearest", "no free configuration was found anywhere".into()),
        None => {}
    }
    line("result", if findings.free { "free".into() } else { "not free".into() });
    columns.into_text()
}
