//! Animated pictures: first how the planner came to its answer, then the motion.

use cplan::PlanOutput as _;
use cplan::engine::Method;
use cplan::view::{View, moving, svg};
use cplan::{Options, Plan, Problem, plan};
use std::path::Path;

fn plan_shipped(robot: &str, world: &str, method: Method) -> Plan {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let [robot, world] = [root.join(format!("robots/{robot}.urdf")), root.join(format!("workspaces/{world}.toml"))];
    plan(&Problem::load(robot, world).unwrap(), &Options::from(method)).unwrap()
}

/// Returns the pictures, each with its time.
fn frames(view: &View) -> Vec<(String, u16)> {
    let frames: Vec<_> = moving(view).collect();
    let seconds: f64 = frames.iter().map(|frame| f64::from(frame.1) / 100.0).sum();
    assert!((2.0..14.0).contains(&seconds), "{seconds} s");
    assert_eq!(frames.last().unwrap().0, svg(view), "at the end all is as in the still picture");
    frames
}

#[test]
fn each_phase_has_a_caption_and_adds_to_the_picture() {
    for method in [Method::Trapezoid, Method::Wavefront, Method::Subdivision, Method::Prm, Method::Shortest] {
        let plan = plan_shipped("planar_2r", "shelf", method);
        let frames = frames(&plan.view_with_replay());
        for phase in plan.replay().unwrap().phases {
            let of_phase: Vec<&String> = frames
                .iter()
                .map(|frame| &frame.0)
                .filter(|text| super::words(text).contains(&phase.caption))
                .collect();
            assert!(of_phase.len() > 10, "{method}: {}", phase.caption);
            let distinct = of_phase.windows(2).filter(|pair| pair[0] != pair[1]).count();
            assert!(distinct > 5, "{method}: {distinct} of {} differ: {}", of_phase.len(), phase.caption);
        }
    }
}

#[test]
fn without_a_motion_the_proof_is_the_end_and_without_a_replay_there_is_the_motion_alone() {
    let proven = plan_shipped("planar_2r_continuous", "no_path", Method::First);
    assert!(frames(&proven.view_with_replay()).len() > 20);
    let found = plan_shipped("planar_2r", "shelf", Method::First);
    assert!(frames(&found.view()).len() < frames(&found.view_with_replay()).len());
}

/// Checks that pictures state the time for which they draw the C-obstacles of moving obstacles.
#[test]
fn the_title_of_a_configuration_space_states_its_time() {
    let plan = plan_shipped("planar_2r", "moving/crossing", Method::Shortest);
    let still = svg(&plan.view());
    assert!(super::words(&still).contains("Configuration space at 0 s; dashed: stops of moving obstacles"));
    let frames = frames(&plan.view());
    let times: Vec<f64> = (frames.iter())
        .filter_map(|(text, _)| {
            let words = super::words(text);
            let (_, rest) = words.split_once("Configuration space at ")?;
            rest.split(' ').next()?.parse().ok()
        })
        .collect();
    assert_eq!(times.len(), frames.len());
    assert!(
        times[..times.len() - 1].is_sorted() && times[times.len() - 2] > 0.9 * plan.duration().unwrap(),
        "{times:?}"
    );
    let fixed = svg(&plan_shipped("planar_2r", "shelf", Method::Shortest).view());
    assert!(super::words(&fixed).contains("Configuration space") && !fixed.contains("Configuration space at"));
}

/// Checks the last picture of a GIF. The crate's own reader decodes the file, and the test puts the frames together as
/// viewers do.
#[cfg(feature = "png")]
#[test]
fn the_last_picture_of_a_gif_is_the_still_one() {
    let view = plan_shipped("planar_2r", "shelf", Method::First).view_with_replay();
    let (mut heard, width) = ((0, 0), 480);
    let bytes = cplan::view::gif(&view, f64::from(width), &mut |done, all| heard = (done, all)).unwrap();
    assert_eq!(bytes, cplan::view::gif(&view, f64::from(width), &mut |_, _| ()).unwrap(), "the same bytes each time");
    assert!(heard.0 == heard.1 && heard.1 == moving(&view).count());
    let (count, pixels) = last_picture(&bytes, width);
    assert!(count > 40 && bytes.len() < 2_000_000);
    let still = cplan::view::figure(&view).png(f64::from(width) / 1400.0).unwrap();
    let still = tiny_skia::Pixmap::decode_png(&still).unwrap();
    assert_eq!(still.pixels().len(), pixels.len());
    // A palette has 255 colours, so shades between two of them differ slightly.
    let off = still.pixels().iter().zip(&pixels).map(|(a, b)| {
        [(a.red(), b[0]), (a.green(), b[1]), (a.blue(), b[2])].map(|(a, b)| a.abs_diff(b)).into_iter().max().unwrap()
    });
    let off: Vec<u8> = off.collect();
    assert!(off.iter().filter(|&&off| off > 24).count() < pixels.len() / 200, "{}", off.iter().max().unwrap());
}

/// Returns the number of pictures of a GIF, and the last one.
#[cfg(feature = "png")]
pub fn last_picture(bytes: &[u8], width: u16) -> (usize, Vec<[u8; 3]>) {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(bytes).unwrap();
    assert_eq!(decoder.width(), width);
    let (width, mut count) = (usize::from(width), 0);
    let mut pixels = vec![[0; 3]; width * usize::from(decoder.height())];
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        count += 1;
        for (k, rgba) in frame.buffer.chunks_exact(4).enumerate().filter(|(_, rgba)| rgba[3] > 0) {
            let [x, y] = [k % usize::from(frame.width), k / usize::from(frame.width)];
            pixels[(usize::from(frame.top) + y) * width + usize::from(frame.left) + x] = [rgba[0], rgba[1], rgba[2]];
        }
    }
    (count, pixels)
}
