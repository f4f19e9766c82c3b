//! Pictures: well-formed, deterministic, finite, and not blank.
//!
//! Set `CPLAN_PICTURES` to a folder to write the pictures there.

mod labels;
pub mod moving;
mod pages;
mod scenes;
mod tasks;

use crate::cli::has;
use cplan::cspace::c_obstacles;
use cplan::engine::Method;
use cplan::geometry::{Point, SimplePolygon};
use cplan::model::{Preference, Region, Scene, Workspace};
use cplan::planner::{CellKind, ChannelPoints, FieldQuantity, GraphKind, Trace};
use cplan::space::{Configuration, JointRange, Path, Segment};
use cplan::view::{Picture, View, svg};
use cplan::{Options, PlanOutput as _, Problem, plan};
use cplan_testkit::problems::motion_problem;
use cplan_testkit::scenes::placed;
use scenes::{TURN, arm, block, capsule, circle, interval, polygon, scene, slide, wall};
use std::f64::consts::PI;

/// Checks the rules for every picture, and returns the picture. Writes it to a file if `CPLAN_PICTURES` is set.
fn checked(name: &str, picture: &Picture) -> String {
    let view = View::of_picture(picture);
    pages::inspected(name, &view);
    inspected(name, &view)
}

/// Checks the picture of a view, of whatever kind. Writes it to a file if `CPLAN_PICTURES` is set.
fn inspected(name: &str, view: &View) -> String {
    let text = svg(view);
    if let Some(folder) = std::env::var_os("CPLAN_PICTURES") {
        let file = |extension: &str| std::path::Path::new(&folder).join(format!("{name}.{extension}"));
        std::fs::write(file("svg"), &text).unwrap();
        #[cfg(feature = "png")]
        std::fs::write(file("png"), cplan::view::figure(view).png(1.0).unwrap()).unwrap();
    }
    let tree = roxmltree::Document::parse(&text).expect("well-formed");
    for node in tree.descendants().filter(|n| n.is_element()) {
        for attribute in node.attributes().filter(|a| !matches!(a.name(), "font-family" | "fill" | "paint-order")) {
            assert!(!attribute.value().contains("NaN") && !attribute.value().contains("inf"), "{attribute:?}");
        }
    }
    assert_eq!(text, svg(view), "drawing twice gives the same bytes");
    text
}

fn words(text: &str) -> String {
    let tree = roxmltree::Document::parse(text).unwrap();
    let all: Vec<&str> = tree.descendants().filter(|n| n.has_tag_name("text")).filter_map(|n| n.text()).collect();
    all.join("\n")
}

fn planar(axes: [JointRange; 2]) -> cplan::model::Arm {
    arm(["shoulder", "elbow"], [TURN; 2], axes, [1.0, 0.8], [block(-0.06, -0.06, 1.06, 0.06), capsule(0.8, 0.05)])
}

fn planar_scene() -> Scene {
    scene(
        planar([interval(-2.8, 2.8), interval(-2.6, 2.6)]),
        vec![
            polygon("shelf", &[(1.15, 0.2), (1.7, 0.2), (1.7, 0.34), (1.15, 0.34)]),
            circle("post <1>", 0.5, -1.2, 0.16),
            wall("fence & gate", &[(-1.2, -2.5), (-1.2, 0.4), (-0.8, 0.9)]),
        ],
    )
}

fn torus() -> Scene {
    scene(
        planar([JointRange::Circle, JointRange::Circle]),
        vec![
            polygon("block", &[(0.9, 0.6), (1.4, 0.6), (1.4, 1.1), (0.9, 1.1)]),
            circle("post", -1.35, 0.1, 0.2),
            circle("pipe", 0.4, -1.3, 0.2),
        ],
    )
}

fn gantry() -> Scene {
    let arm = arm(
        ["bridge", "trolley"],
        [slide(1.0, 0.0), slide(0.0, 1.0)],
        [interval(0.0, 2.0), interval(0.0, 1.2)],
        [0.0, 0.0],
        [block(-0.02, -0.1, 0.02, 1.3), block(-0.08, -0.06, 0.08, 0.06)],
    );
    let mut arm = arm;
    arm.links[0].parts.clear();
    scene(
        arm,
        vec![
            polygon("crate", &[(0.5, -0.1), (0.8, -0.1), (0.8, 0.8), (0.5, 0.8)]),
            polygon("wedge", &[(1.1, 1.3), (1.5, 0.45), (1.7, 1.3)]),
        ],
    )
}

fn polar() -> Scene {
    let arm = arm(
        ["swivel", "boom"],
        [TURN, slide(1.0, 0.0)],
        [interval(-1.5 * PI, 1.5 * PI), interval(0.0, 0.6)],
        [0.4, 0.2],
        [block(-0.1, -0.1, 0.4, 0.1), block(-0.3, -0.04, 0.2, 0.04)],
    );
    scene(arm, vec![circle("column", 0.0, 0.9, 0.2), wall("wall", &[(0.7, -0.5), (0.7, -0.1)])])
}

fn configuration(q1: f64, q2: f64) -> Configuration {
    Configuration::new(q1, q2)
}

/// Returns the picture of a plan.
fn planned_picture(name: &str, scene: &Scene, [start, goal]: [Configuration; 2], method: Method) -> String {
    let problem = Problem::from(motion_problem(scene.clone(), start, goal));
    inspected(name, &plan(&problem, &Options::from(method)).unwrap().view())
}

#[test]
fn a_wavefront_between_limits_is_drawn() {
    let ends = [configuration(-1.9, 0.6), configuration(1.4, -1.0)];
    let text = planned_picture("rr_wavefront", &planar_scene(), ends, Method::Wavefront);
    has(&words(&text), &["shoulder", "elbow", "90\u{b0}", "shelf", "post <1>", "fence & gate", "steps to the goal"]);
    has(&text, &["post &lt;1&gt;", "fence &amp; gate"]);
    assert!(text.len() < 600_000, "{} bytes", text.len());
}

#[test]
fn a_field_on_a_torus_is_drawn() {
    let ends = [configuration(2.6, 0.3), configuration(-2.2, -1.6)];
    let text = planned_picture("torus_field", &torus(), ends, Method::Harmonic);
    has(&words(&text), &["shoulder, wraps around", "equipotentials"]);
    assert!(text.contains("stroke-dasharray"), "seams are dashed");
}

#[test]
fn a_channel_of_a_gantry_is_drawn() {
    let ends = [configuration(0.2, 0.15), configuration(1.8, 0.9)];
    let text = planned_picture("gantry_channel", &gantry(), ends, Method::Trapezoid);
    has(&words(&text), &["bridge (m)", "trolley (m)", "channel", "crate"]);
}

#[test]
fn a_roadmap_on_an_interval_longer_than_a_turn_is_drawn() {
    let ends = [configuration(-3.5, 0.3), configuration(3.0, 0.1)];
    planned_picture("polar_roadmap", &polar(), ends, Method::Prm);
}

#[test]
fn a_comparison_distinguishes_paths() {
    let scene = torus();
    let problem = Problem::from(motion_problem(scene.clone(), configuration(2.6, 0.3), configuration(-2.2, -1.6)));
    let planned = |method: Method| {
        let plan = plan(&problem, &Options::from(method)).unwrap();
        (
            method.name().to_owned(),
            Path::new(plan.waypoints().unwrap().iter().copied().map(Configuration::from).collect()),
        )
    };
    let paths = [Method::Visibility, Method::Trapezoid, Method::Wavefront].map(planned);
    let picture = Picture {
        title: vec!["Comparison".to_owned(), "one line".to_owned(), "and another".to_owned()],
        status: "3 of 3 found".to_owned(),
        goals: &[paths[0].1.goal().into()],
        paths: paths.iter().map(|(name, path)| (name.clone(), path)).collect(),
        c_obstacles: &c_obstacles(&scene, 2e-3, 2e-3),
        ..Picture::new(&scene, paths[0].1.start())
    };
    let words = words(&checked("comparison", &picture));
    has(&words, &["Comparison", "and another", "visibility", "trapezoid", "wavefront", "3 of 3 found"]);
}

#[test]
fn a_crowd_without_a_path_is_drawn() {
    let crowd = |k: usize| {
        let (angle, distance) = (k as f64 * 2.4, 0.9 + 0.018 * k as f64);
        circle(&format!("o{k}"), distance * angle.cos(), distance * angle.sin(), 0.05)
    };
    let scene = scene(planar([interval(-2.8, 2.8), interval(-2.6, 2.6)]), (0..60).map(crowd).collect());
    let contours = c_obstacles(&scene, 2e-3, 2e-3);
    let picture = Picture {
        title: vec!["A crowd".to_owned()],
        status: "infeasible: proven".to_owned(),
        goals: &[configuration(1.0, -2.4).into(), configuration(2.0, 2.4).into()],
        c_obstacles: &contours,
        ..Picture::new(&scene, configuration(-2.0, 2.4))
    };
    let words = words(&checked("crowd", &picture));
    assert!(words.contains("infeasible: proven") && !words.contains("o17"));
}

fn plain_picture<'a>(scene: &'a Scene, goals: &'a [Segment]) -> Picture<'a> {
    Picture {
        title: vec!["<&> \"title\"".to_owned()],
        status: "unknown".to_owned(),
        goals,
        ..Picture::new(scene, configuration(0.0, 0.0))
    }
}

#[test]
fn empty_and_degenerate_scenes_have_finite_axes() {
    let tiny = arm(
        ["a", "b"],
        [TURN; 2],
        [interval(0.3, 0.3), interval(-0.001, 0.001)],
        [1e-9, 1e-9],
        [capsule(0.0, 0.0), capsule(0.0, 0.0)],
    );
    let no_goals: [Segment; 0] = [];
    let far = || vec![circle("far", 1e9, -1e9, 1.0), polygon("farther", &[(1e12, 0.0), (1e12, 1.0), (9e11, 1.0)])];
    for (name, scene) in [
        ("empty", scene(planar([JointRange::Circle, interval(-1.0, 1.0)]), Vec::new())),
        ("far", scene(planar([JointRange::Circle, interval(-1.0, 1.0)]), far())),
        ("tiny", scene(tiny.clone(), Vec::new())),
        ("tiny_far", scene(tiny, far())),
    ] {
        let words = words(&checked(name, &plain_picture(&scene, &no_goals)));
        assert!(words.contains("<&> \"title\""));
        assert_eq!(words.contains("2 obstacles lie outside"), name.contains("far"));
    }
}

#[test]
fn a_motion_that_stays_where_it_is_is_drawn() {
    let scene = planar_scene();
    let path = Path::new(vec![configuration(0.0, 0.0)]);
    let goals = [configuration(0.0, 0.0).into()];
    for trace in [
        Trace::Roadmap { edges: Vec::new(), whole: true },
        Trace::Channel {
            kind: CellKind::Trapezoids,
            cells: [].into(),
            channel: Vec::new(),
            points: ChannelPoints::default(),
            expanded: Vec::new(),
        },
        Trace::Roads { edges: Vec::new(), expanded: Vec::new(), kind: GraphKind::Roadmap },
        Trace::Wavefront { cells: [1, 1], labels: vec![0], expanded: Vec::new(), forward: false, estimates: None },
        Trace::Wavefront { cells: [0, 0], labels: Vec::new(), expanded: Vec::new(), forward: false, estimates: None },
        Trace::Wavefront {
            cells: [2, 1],
            labels: vec![u32::MAX; 2],
            expanded: Vec::new(),
            forward: false,
            estimates: None,
        },
        Trace::field([2, 2], FieldQuantity::Logarithm, vec![f64::NEG_INFINITY, 0.0, -1.0, -2.0]),
        Trace::field([0, 0], FieldQuantity::Logarithm, Vec::new()),
    ] {
        let mut picture = plain_picture(&scene, &goals);
        picture.paths = vec![("visibility".to_owned(), &path)];
        picture.trace = Some(&trace);
        assert!(checked("still", &picture).starts_with("<svg"));
    }
}

#[cfg(feature = "png")]
mod raster {
    use super::*;
    use cplan::view::{DrawError, Figure, figure};
    use std::collections::BTreeSet;

    fn drawn(picture: &Picture) -> Figure {
        figure(&View::of_picture(picture))
    }

    #[test]
    fn a_png_has_its_size_and_is_not_blank() {
        let scene = planar_scene();
        let goals = [configuration(1.0, 1.0).into()];
        let bytes = drawn(&plain_picture(&scene, &goals)).png(0.5).unwrap();
        assert_eq!(&bytes[..8], b"\x89PNG\r\n\x1a\n");
        let pixels = tiny_skia::Pixmap::decode_png(&bytes).unwrap();
        assert_eq!((pixels.width(), pixels.height()), (700, 360));
        let colors: BTreeSet<[u8; 3]> = pixels.pixels().iter().map(|p| [p.red(), p.green(), p.blue()]).collect();
        assert!(colors.len() > 50, "{} colours", colors.len());
    }

    /// Checks that text uses the built-in font: a picture with a longer title has more dark pixels at the top.
    #[test]
    fn text_is_rendered_without_fonts_of_the_machine() {
        let scene = planar_scene();
        let dark = |title: &str| {
            let mut picture = plain_picture(&scene, &[]);
            picture.title = vec![title.to_owned()];
            let pixels = tiny_skia::Pixmap::decode_png(&drawn(&picture).png(1.0).unwrap()).unwrap();
            pixels.pixels()[..1400 * 50].iter().filter(|p| p.red() < 128).count()
        };
        assert!(dark("A title of some length") > dark("") + 300);
    }

    #[test]
    fn invalid_scales_are_refused() {
        let scene = planar_scene();
        for scale in [0.0, -1.0, 1e-9, 1e3, f64::NAN, f64::INFINITY] {
            assert!(matches!(drawn(&plain_picture(&scene, &[])).png(scale), Err(DrawError::Scale(_))), "{scale}");
        }
    }
}

#[test]
fn preference_regions_are_dashed_and_explained() {
    let square = |x: f64| {
        let corners = [(x, x), (x + 0.5, x), (x + 0.5, x + 0.5), (x, x + 0.5)].map(|(x, y)| Point::new(x, y));
        SimplePolygon::new(corners.to_vec()).unwrap()
    };
    let preference = |region: Region, epsilon: f64| Preference { name: "p".into(), region, epsilon, direction: None };
    let with = |preferences: Vec<Preference>| {
        let (arm, workspace) = torus().into_parts();
        let scene = placed(arm, Workspace { preferences, ..workspace });
        let picture = Picture { title: vec!["preferences".into()], ..Picture::new(&scene, configuration(0.0, 0.0)) };
        let text = checked("preferences", &picture);
        let dashes = text.matches("stroke-dasharray=\"7 4\"").count();
        (dashes, words(&text))
    };
    let (none, text) = with(Vec::new());
    assert_eq!(none, 0);
    assert!(!text.contains("region"));
    // Each region has one outline, with its copies on circles, and one line of the legend.
    let (both, text) =
        with(vec![preference(Region::Configurations(square(3.0)), 0.5), preference(Region::Tip(square(-1.0)), -0.5)]);
    assert_eq!(both, 4);
    assert!(text.contains("region, epsilon above 0") && text.contains("region, epsilon below 0"));
}
