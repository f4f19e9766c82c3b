//! Recordings whose topics display the scene, decoded by the standard alone. Frames are where trigonometry puts them
//! for the recorded states. Surfaces are closed, and have the right volume.

use crate::mcap::Decoder;
use ::mcap::read::MessageStream;
use cplan::PlanOutput as _;
use cplan::geometry::{Convex, Point, Vector};
use cplan::model::{Heights, MovingObstacle, ObstacleTrajectory, Stop, TimedWorkspace};
use cplan::motion::Format;
use cplan::output::FileFormat;
use cplan::{Arm, Obstacle, Options, Problem, Workspace, plan};
use std::collections::BTreeMap;

type Place = [f64; 3];

/// A marker.
struct Marker {
    frame: String,
    name: String,
    corners: Vec<Place>,
}

/// The content of a file.
#[derive(Default)]
struct Shown {
    /// Position and orientation (x, y, z, w) of each frame, by time and name.
    frames: BTreeMap<(u64, String), (Place, [f64; 4])>,
    markers: Vec<Marker>,
    /// Points of the surfaces in each frame.
    points: BTreeMap<String, Vec<Place>>,
}

impl Shown {
    /// Returns the place of a frame at a time, from its last update.
    fn at(&self, time: u64, frame: &str) -> (Place, [f64; 4]) {
        let before = self.frames.range(..(time + 1, String::new())).rev();
        *before.into_iter().find(|((_, name), _)| name == frame).expect("a frame that was set").1
    }
}

fn places(from: &mut Decoder, count: usize) -> Vec<f64> {
    (0..count).map(|_| f64::from_le_bytes(from.take())).collect()
}

fn number(from: &mut Decoder) -> f64 {
    f32::from_le_bytes(from.take()).into()
}

fn decode_scene(file: &[u8]) -> Shown {
    let mut shown = Shown::default();
    for message in MessageStream::new(file).unwrap() {
        let message = message.unwrap();
        let mut from = Decoder::new(&message.data);
        match message.channel.schema.as_ref().unwrap().name.as_str() {
            "tf2_msgs/msg/TFMessage" => {
                for _ in 0..from.word() {
                    assert_eq!((from.time(), from.string().as_str()), (message.log_time, "world"));
                    let name = from.string();
                    let [at, orientation] = [3, 4].map(|count| places(&mut from, count));
                    let known = shown
                        .frames
                        .insert((message.log_time, name), (at.try_into().unwrap(), orientation.try_into().unwrap()));
                    assert_eq!(known, None);
                }
            }
            "visualization_msgs/msg/MarkerArray" => {
                for id in 0..from.word() {
                    assert_eq!(from.time(), 0);
                    let (frame, name) = (from.string(), from.string());
                    assert_eq!([from.word(), from.word(), from.word()], [id, 11, 0], "triangles to add");
                    assert_eq!(places(&mut from, 10), [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0]);
                    let color: Vec<f64> = (0..4).map(|_| number(&mut from)).collect();
                    assert!(color.iter().all(|part| (0.0..=1.0).contains(part)) && color[3] == 1.0);
                    assert_eq!((from.time(), from.take::<1>()), (0, [1]), "for ever, and with its frame");
                    let corners = (0..from.word()).map(|_| places(&mut from, 3).try_into().unwrap()).collect();
                    assert_eq!(
                        (from.word(), from.string(), from.time(), from.string()),
                        (0, String::new(), 0, String::new())
                    );
                    assert_eq!((from.string(), from.word(), from.word()), (String::new(), 0, 0), "no texture");
                    assert_eq!([from.string(), from.string(), from.string()], [const { String::new() }; 3]);
                    assert_eq!((from.word(), from.take::<1>()), (0, [0]), "no mesh");
                    shown.markers.push(Marker { frame, name, corners });
                }
            }
            "sensor_msgs/msg/PointCloud2" => {
                assert_eq!(from.time(), 0);
                let frame = from.string();
                let (height, width) = (from.word(), from.word());
                let fields: Vec<_> =
                    (0..from.word()).map(|_| (from.string(), from.word(), from.take::<1>()[0], from.word())).collect();
                assert_eq!(fields, [("x".into(), 0, 7, 1), ("y".into(), 4, 7, 1), ("z".into(), 8, 7, 1)]);
                assert_eq!((height, from.take::<1>(), from.word(), from.word()), (1, [0], 12, 12 * width));
                assert_eq!(from.word(), 12 * width);
                let mut value = || f64::from(f32::from_le_bytes([(); 4].map(|()| from.take::<1>()[0])));
                let points = (0..width).map(|_| [value(), value(), value()]).collect();
                assert_eq!(from.take::<1>(), [1]);
                shown.points.insert(frame, points);
            }
            _ => continue,
        }
        from.end();
    }
    shown
}

/// Returns the volume that triangles enclose. Panics unless each side belongs to two triangles that traverse it in
/// opposite directions.
fn volume(corners: &[Place]) -> f64 {
    let mut sides = BTreeMap::new();
    let key = |p: Place| p.map(f64::to_bits);
    let mut volume = 0.0;
    for triangle in corners.chunks_exact(3) {
        for k in 0..3 {
            let (a, b) = (key(triangle[k]), key(triangle[(k + 1) % 3]));
            *sides.entry((a.min(b), a.max(b))).or_insert(0) += if a < b { 1 } else { -1 };
        }
        let [a, b, c] = [triangle[0], triangle[1], triangle[2]];
        let cross = [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]];
        volume += (0..3).map(|k| a[k] * cross[k]).sum::<f64>() / 6.0;
    }
    assert!(sides.values().all(|balance| *balance == 0), "a surface with holes");
    volume
}

#[test]
fn frames_follow_the_states_and_surfaces_are_closed() {
    let corners = [[-0.2, -1.7], [0.3, -1.7], [0.3, -1.4]];
    let mut wedge = Obstacle::polygon("wedge", corners).unwrap();
    wedge.heights = Heights { lower: 0.1, upper: 0.4 };
    let workspace = Workspace::new([wedge, Obstacle::circle("post", [1.5, 0.0], 0.1).unwrap()]);
    let arm = Arm::rr([1.0, 0.8], 0.06).unwrap();
    let problem = Problem::new(arm, workspace, [-0.6, 0.2], [0.6, 0.2]).unwrap();
    let made = plan(&problem, &Options::default()).unwrap();
    let file = made.bytes(FileFormat::Result(Format::Mcap)).unwrap().unwrap();
    let shown = decode_scene(&file);

    let (states, motions) = crate::mcap::read(&file);
    assert_eq!(motions.len(), 1);
    let near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
    for state in &states {
        let [q1, q2] = state.position[..] else { panic!("two joints") };
        let turned = |angle: f64| [0.0, 0.0, (angle / 2.0).sin(), (angle / 2.0).cos()];
        let (at, orientation) = shown.at(state.log, "link/link 1");
        assert!(near(&at, &[0.0; 3]) && near(&orientation, &turned(q1)), "{at:?} {orientation:?}");
        let (at, orientation) = shown.at(state.log, "link/link 2");
        assert!(near(&at, &[q1.cos(), q1.sin(), 0.0]) && near(&orientation, &turned(q1 + q2)));
    }
    assert!((states.len()..=2 * states.len() + 1).contains(&shown.frames.len()), "what stands still is left out");
    assert_eq!(shown.frames[&(0, "workspace".to_owned())], ([0.0; 3], [0.0, 0.0, 0.0, 1.0]));

    let named: Vec<_> = shown.markers.iter().map(|m| (m.frame.as_str(), m.name.as_str())).collect();
    assert_eq!(
        named,
        [("workspace", "wedge"), ("workspace", "post"), ("link/link 1", "link 1"), ("link/link 2", "link 2")]
    );
    let volumes: Vec<f64> = shown.markers.iter().map(|marker| volume(&marker.corners)).collect();
    assert!((volumes[0] - 0.5 * 0.5 * 0.3 * 0.3).abs() < 1e-12, "{volumes:?}");
    // Shapes of unlimited height are as high as those with a height. The chords of round ends lie inside them, and lose
    // less than 4 % of the area.
    let round =
        [std::f64::consts::PI * 0.01, 0.06 + std::f64::consts::PI * 0.0009, 0.048 + std::f64::consts::PI * 0.0009];
    for (found, area) in volumes[1..].iter().zip(round) {
        assert!(*found < 0.3 * area && *found > 0.3 * 0.96 * area, "{found} {area}");
    }

    let wedge = Convex::new(corners.map(Point::from).to_vec(), 0.0).unwrap();
    let post = Point::new(1.5, 0.0);
    let on_rim = |&[x, y, z]: &Place| {
        let p = Point::new(x, y);
        let core = wedge.core();
        let beside = |k: usize| {
            let (a, b) = (core[k], core[(k + 1) % 3]);
            let side = (b - a).normalize();
            (side.x * (p - a).y - side.y * (p - a).x).abs()
        };
        let distance = (0..3).map(beside).fold(((p - post).norm() - 0.1).abs(), f64::min);
        distance < 0.1 * (1.0 - (std::f64::consts::PI / 16.0).cos()) + 1e-6
            && ((z - 0.1).abs() < 1e-6 || (z - 0.4).abs() < 1e-6)
    };
    assert_eq!(shown.points.keys().collect::<Vec<_>>(), ["link/link 1", "link/link 2", "workspace"]);
    assert!(shown.points["workspace"].len() > 100 && shown.points["workspace"].iter().all(on_rim));
}

/// Checks a cart that arrives and stops. Its frame moves on the straight line between its stops.
#[test]
fn moving_obstacles_have_moving_frames() {
    let stop = |time: f64, x: f64| Stop { time, at: Point::new(x, 0.2), angle: time / 2.0 };
    let trajectory = ObstacleTrajectory::new(vec![stop(0.0, 3.0), stop(0.5, 2.2)], Vector::zeros()).unwrap();
    let cart = MovingObstacle { obstacle: Obstacle::circle("cart", [0.0, 0.0], 0.1).unwrap(), trajectory };
    let workspace = TimedWorkspace { movers: vec![cart], ..Workspace::new([]).into() };
    let problem = Problem::new(Arm::rr([1.0, 0.8], 0.06).unwrap(), workspace, [-0.6, 0.2], [0.6, 0.2]).unwrap();
    let file = plan(&problem, &Options::default()).unwrap().bytes(FileFormat::Result(Format::Mcap)).unwrap().unwrap();
    let shown = decode_scene(&file);
    let (states, _) = crate::mcap::read(&file);
    assert!(states.len() > 20);
    for state in &states {
        let time = (state.log as f64 * 1e-9).min(0.5);
        let (at, [.., z, w]) = shown.at(state.log, "moving/cart");
        assert!((at[0] - (3.0 - 1.6 * time)).abs() < 1e-12 && (at[1] - 0.2).abs() < 1e-12, "{time}: {at:?}");
        assert!((z - (time / 4.0).sin()).abs() < 1e-12 && (w - (time / 4.0).cos()).abs() < 1e-12);
    }
    assert!(
        shown.markers.iter().any(|marker| (marker.frame.as_str(), marker.name.as_str()) == ("moving/cart", "cart"))
    );
}
