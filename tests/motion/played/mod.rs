//! Our files, interpolated by the formula of a controller. The result is the certified motion, within all limits, and
//! at rest where it stops.

mod controller;
mod files;
mod joints;
mod strokes;
mod worlds;

use controller::{Message, played, seconds};
use cplan::model::Joint;
use cplan::motion::Trajectory;
use cplan_testkit::moving::state_between;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Fraction of a limit by which an interpolated motion may exceed it, as in `cplan verify`. It allows for the rounding
/// of doubles within a millisecond.
const OVER: f64 = 1e-6;

/// Largest distance of an interpolated motion from that in the result, in radians or metres. It allows for rounding,
/// and for the tolerance around blends within which the certificate holds (for radii of at most one).
const OFF: f64 = 1e-6;

/// Formats that the program writes and that `verify` reads.
#[cfg(feature = "mcap")]
pub const FORMATS: [&str; 4] = ["json", "csv", "yaml", "mcap"];
#[cfg(not(feature = "mcap"))]
pub const FORMATS: [&str; 3] = ["json", "csv", "yaml"];

/// A run of the program and its files.
pub struct Run {
    pub code: i32,
    pub errors: String,
    folder: tempfile::TempDir,
}

pub fn root(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(file)
}

impl Run {
    /// Plans and writes `plan.json` and the other files.
    pub fn of(robot: &Path, world: &Path, options: &[&str]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_cplan"));
        command.current_dir(folder.path()).args([robot, world]).arg("--quiet").args(options);
        for format in FORMATS {
            command.args(["--output", &format!("plan.{format}")]);
        }
        let output = command.output().unwrap();
        let code = output.status.code().expect("no signal");
        Self { code, errors: String::from_utf8(output.stderr).unwrap(), folder }
    }

    pub fn bytes(&self, format: &str) -> Vec<u8> {
        std::fs::read(self.folder.path().join(format!("plan.{format}"))).unwrap()
    }

    pub fn text(&self, format: &str) -> String {
        String::from_utf8(self.bytes(format)).unwrap()
    }

    pub fn json(&self) -> Value {
        serde_json::from_str(&self.text("json")).unwrap()
    }

    /// Returns the exit code and the output of `verify` for one of the files.
    pub fn verified(&self, robot: &Path, world: &Path, format: &str) -> (i32, String) {
        let mut command = Command::new(env!("CARGO_BIN_EXE_cplan"));
        command.current_dir(self.folder.path()).arg("verify").args([robot, world]).arg(format!("plan.{format}"));
        let output = command.output().unwrap();
        (output.status.code().unwrap(), String::from_utf8(output.stdout).unwrap())
    }
}

/// The motion of a result, interpolated as its `interpolation` states.
pub struct Certified(Trajectory);

impl Certified {
    pub fn of(result: &Value) -> Self {
        let rows = |name: &str| serde_json::from_value(result["trajectory"][name].clone()).unwrap();
        Self(Trajectory {
            time: serde_json::from_value(result["trajectory"]["time"].clone()).unwrap(),
            position: rows("position"),
            velocity: rows("velocity"),
            acceleration: rows("acceleration"),
            ..Trajectory::default()
        })
    }

    /// Returns true if both joints are at rest from sample `k` to the next.
    fn is_at_rest(&self, k: usize) -> bool {
        let Trajectory { position, velocity, .. } = &self.0;
        position[k] == position[k + 1] && [velocity[k], velocity[k + 1]] == [[0.0; 2]; 2]
    }

    fn sample_before(&self, time: f64) -> usize {
        let times = &self.0.time;
        times.partition_point(|t| *t <= time + 1e-10).saturating_sub(1).min(times.len().saturating_sub(2))
    }

    fn at(&self, time: f64, joint: usize) -> f64 {
        let k = self.sample_before(time);
        match self.0.position[..] {
            [at] => at[joint],
            _ => state_between(&self.0, k, time - self.0.time[k])[0][joint],
        }
    }
}

/// Greatest values of an interpolated motion: fractions of the limits, and the distance from the certified motion.
#[derive(Debug, Default, Clone, Copy)]
pub struct Extremes {
    pub velocity: f64,
    pub acceleration: f64,
    pub off: f64,
    pub dwells: usize,
}

/// Interpolates a message densely, and asserts everything that a certificate guarantees. `begin` is the time in the
/// certified motion at which the message begins.
pub fn judge(what: &str, message: &Message, begin: u64, certified: &Certified, joints: &[Joint; 2]) -> Extremes {
    let mut found = Extremes::default();
    for (k, joint) in joints.iter().enumerate() {
        let named = message.joints.iter().position(|name| *name == joint.name).expect("the joint is named");
        for i in 0..message.since.len().saturating_sub(1) {
            assert!(message.since[i] < message.since[i + 1], "{what}: time stands still at point {i}");
            let duration = seconds(message.since[i], message.since[i + 1]);
            let time = seconds(0, begin + message.since[i]);
            let stands = certified.is_at_rest(certified.sample_before(time))
                && certified.is_at_rest(certified.sample_before(time + 0.999 * duration));
            let first = message.points[i][0][named];
            for share in 0..=16 {
                let t = duration * f64::from(share) / 16.0;
                let [p, v, a] = played(message, i, named, t);
                let at = format!("{what}: {} at {:.6} s", joint.name, time + t);
                assert!(v.abs() <= joint.velocity * (1.0 + OVER), "{at}: speed {v}, limit {}", joint.velocity);
                assert!(
                    a.abs() <= joint.acceleration * (1.0 + OVER),
                    "{at}: acceleration {a}, limit {}",
                    joint.acceleration
                );
                let (lower, upper) = match joint.range {
                    cplan::space::JointRange::Interval { lower, upper } => (lower, upper),
                    cplan::space::JointRange::Circle => (f64::NEG_INFINITY, f64::INFINITY),
                };
                assert!(p >= lower - 1e-9 && p <= upper + 1e-9, "{at}: position {p}");
                let off = (p - certified.at(time + t, k)).abs();
                assert!(off <= OFF, "{at}: {off} off the certified motion");
                if stands {
                    assert!(p == first && v.abs() < 1e-12, "{at}: moves while it should stand, {p} {first} {v}");
                }
                found.velocity = found.velocity.max(v.abs() / joint.velocity);
                found.acceleration = found.acceleration.max(a.abs() / joint.acceleration);
                found.off = found.off.max(off);
            }
            found.dwells += usize::from(stands && k == 0);
        }
        let (Some(points), Some(last)) = (message.points.first(), message.points.last()) else {
            panic!("{what}: empty")
        };
        for point in [points, last] {
            assert_eq!(point[1][named], 0.0, "{what}: {} does not begin and end at rest", joint.name);
        }
    }
    found
}
