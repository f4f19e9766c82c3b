//! Joint values as a structured document: cplan's JSON, or a ROS 2 message in YAML or JSON.

use super::samples::{Samples, Series};
use crate::parsers::{json_diagnostic, yaml_diagnostic};
use cplan_handling::{INTERPOLATION, Interpolation, SMOOTH_INTERPOLATION};
use cplan_robot::{Diagnostic, InputError, Source};
use serde::Deserialize;
use serde::de::IgnoredAny;

/// The members that are read. Other members are ignored.
#[derive(Deserialize)]
struct Document {
    /// The status, which only results of cplan have.
    status: Option<String>,
    joints: Option<Vec<String>>,
    path: Option<Vec<Vec<f64>>>,
    interpolation: Option<String>,
    trajectory: Option<Inner>,
    all_joints: Option<AllJoints>,
    /// The joints of a ROS message, unless the message is a member of the document.
    joint_names: Option<Vec<String>>,
    points: Option<Vec<Point>>,
    joint_trajectory: Option<Inner>,
}

/// The motion of all joints of a robot.
#[derive(Deserialize)]
struct AllJoints {
    joints: Vec<String>,
    time: Vec<f64>,
    position: Vec<Vec<f64>>,
    velocity: Option<Vec<Vec<f64>>>,
}

/// A trajectory of cplan, or a ROS message.
#[derive(Deserialize)]
struct Inner {
    time: Option<Vec<f64>>,
    position: Option<Vec<Vec<f64>>>,
    velocity: Option<Vec<Vec<f64>>>,
    acceleration: Option<Vec<Vec<f64>>>,
    torque: Option<IgnoredAny>,
    joint_names: Option<Vec<String>>,
    points: Option<Vec<Point>>,
}

/// A `trajectory_msgs/msg/JointTrajectoryPoint`.
#[derive(Deserialize)]
struct Point {
    #[serde(default)]
    positions: Vec<f64>,
    #[serde(default)]
    velocities: Vec<f64>,
    #[serde(default)]
    accelerations: Vec<f64>,
    time_from_start: Option<Stamp>,
}

/// A duration: a `builtin_interfaces/msg/Duration`, the same with ROS 1's member names, or a number of seconds.
#[derive(Deserialize)]
#[serde(
    untagged,
    expecting = "write a time as {sec: 1, nanosec: 500000000} with two whole numbers, or as a number of \
                               seconds"
)]
enum Stamp {
    Parts {
        #[serde(alias = "secs", default)]
        sec: i64,
        #[serde(alias = "nsecs", default)]
        nanosec: u32,
    },
    Seconds(f64),
}

impl Stamp {
    /// Returns the duration in seconds, correctly rounded, so that its shortest decimal has at most nine digits after the point.
    fn seconds(&self) -> f64 {
        match *self {
            Stamp::Parts { sec, nanosec } => (sec as f64 * 1e9 + f64::from(nanosec)) / 1e9,
            Stamp::Seconds(seconds) => seconds,
        }
    }
}

/// Reads a result of cplan, or another program's JSON.
pub(super) fn json(source: &Source) -> Result<Samples, InputError> {
    Ok(samples(source, document(source)?)?)
}

/// Reads the motion of all joints, which a result of cplan may state in addition to the arm's motion. `None` if it does not.
pub(super) fn all_joints(source: &Source) -> Result<Option<Samples>, InputError> {
    let Some(AllJoints { joints, time, position, velocity }) = document(source)?.all_joints else { return Ok(None) };
    let what = "all_joints.position";
    let mut samples = Samples { time: Some(time), what: what.into(), ..Samples::default() };
    samples.joints = series(source, named(source, Some(joints), "all_joints.joints")?, &position, what)?;
    samples.add(source, velocity, "all_joints.velocity", |joint| &mut joint.velocity)?;
    Ok(Some(samples))
}

fn document(source: &Source) -> Result<Document, InputError> {
    let help = "write a result with cplan --output NAME.json, or a JointTrajectory; all numbers must be finite";
    // Serde would read a list as the members of an object in their order.
    let begins = source.text().len() - source.text().trim_start().len();
    if source.text()[begins..].starts_with('[') {
        let message = "is a list, but must be an object { ... }";
        return Err(source.diagnostic_at(begins..begins + 1, message).help(help).into());
    }
    Ok(serde_json::from_str(source.text()).map_err(|error| json_diagnostic(source, &error).help(help))?)
}

/// Reads a JointTrajectory as ROS 2 prints it in YAML.
pub(super) fn yaml(source: &Source) -> Result<Samples, InputError> {
    let mut options = serde_saphyr::Options::default();
    // The parser needs no budget, because the size of the file already bounds the number of nodes.
    if let Some(budget) = &mut options.budget {
        budget.max_events = source.text().len().max(budget.max_events);
        budget.max_nodes = source.text().len().max(budget.max_nodes);
        budget.max_total_scalar_bytes = source.text().len().max(budget.max_total_scalar_bytes);
    }
    // `ros2 topic echo` prints three dashes after a message.
    let text = source.text().trim_end();
    let text = text.strip_suffix("\n---").unwrap_or(text);
    let document: Document = serde_saphyr::from_str_with_options(text, options).map_err(|error| {
        let help = "write one trajectory_msgs/msg/JointTrajectory with joint_names and points";
        yaml_diagnostic(source, &error).help(help)
    })?;
    Ok(samples(source, document)?)
}

fn samples(source: &Source, document: Document) -> Result<Samples, Diagnostic> {
    let Document { status, joints, path, interpolation, trajectory, joint_names, points, joint_trajectory, .. } =
        document;
    if let Some(points) = points {
        return message(source, joint_names, points);
    }
    for inner in [joint_trajectory, trajectory].into_iter().flatten() {
        if let Some(points) = inner.points {
            return message(source, inner.joint_names, points);
        }
        if let (Some(time), Some(position)) = (inner.time, inner.position) {
            let names = named(source, joints, "joints")?;
            let mut samples = Samples { time: Some(time), what: "trajectory.position".into(), ..Samples::default() };
            samples.joints = series(source, names, &position, "trajectory.position")?;
            samples.add(source, inner.velocity, "trajectory.velocity", |joint| &mut joint.velocity)?;
            samples.add(source, inner.acceleration, "trajectory.acceleration", |joint| &mut joint.acceleration)?;
            samples.has_torques = inner.torque.is_some();
            samples.joined = own_rule(interpolation.as_deref(), &mut samples.notes);
            return Ok(samples);
        }
    }
    if let Some(path) = path {
        let names = named(source, joints, "joints")?;
        let joints = series(source, names, &path, "path")?;
        return Ok(Samples { joints, what: "path".into(), ..Samples::default() });
    }
    Err(match status {
        Some(status) => source
            .diagnostic(format!("holds no path: the status is \"{status}\""))
            .help("verify a result with the status \"found\""),
        None => source
            .diagnostic("holds neither a path, nor a trajectory, nor the points of a JointTrajectory")
            .help("write the file with cplan --output, or as a ROS 2 JointTrajectory with joint_names and points"),
    })
}

/// Returns the interpolation that the member `interpolation` of a result of cplan states.
fn own_rule(stated: Option<&str>, notes: &mut Vec<String>) -> Option<Interpolation> {
    match stated {
        Some(INTERPOLATION) => Some(Interpolation::Quartic),
        Some(SMOOTH_INTERPOLATION) => Some(Interpolation::Cubic),
        Some(_) => {
            notes.push("this version does not know the file's `interpolation` and ignores it".into());
            None
        }
        None => None,
    }
}

impl Samples {
    /// Adds rows of velocities or accelerations, if there are any, to the joints.
    fn add(
        &mut self,
        source: &Source,
        rows: Option<Vec<Vec<f64>>>,
        what: &str,
        place: fn(&mut Series) -> &mut Option<Vec<f64>>,
    ) -> Result<(), Diagnostic> {
        let Some(rows) = rows else { return Ok(()) };
        let columns = transposed(source, &rows, self.joints.len(), what)?;
        self.joints.iter_mut().zip(columns).for_each(|(joint, column)| *place(joint) = Some(column));
        Ok(())
    }
}

fn named(source: &Source, names: Option<Vec<String>>, member: &str) -> Result<Vec<String>, Diagnostic> {
    let names = names.filter(|n| !n.is_empty()).ok_or_else(|| {
        source
            .diagnostic(format!("\"{member}\" is missing, so it is unknown which value belongs to which joint"))
            .help(format!("add \"{member}\" with the joints' names in the order of the values"))
    })?;
    match names.iter().enumerate().find(|(i, name)| names[..*i].contains(name)) {
        Some((_, twice)) => {
            Err(source.diagnostic(format!("\"{member}\" names joint \"{twice}\" twice")).help("remove one of them"))
        }
        None => Ok(names),
    }
}

/// Reads a ROS message.
fn message(source: &Source, names: Option<Vec<String>>, points: Vec<Point>) -> Result<Samples, Diagnostic> {
    let names = named(source, names, "joint_names")?;
    let count = points.len();
    let (mut time, mut positions) = (Vec::new(), Vec::new());
    let (mut velocities, mut accelerations) = (Vec::new(), Vec::new());
    for point in points {
        time.extend(point.time_from_start.map(|stamp| stamp.seconds()));
        positions.push(point.positions);
        velocities.extend(Some(point.velocities).filter(|row| !row.is_empty()));
        accelerations.extend(Some(point.accelerations).filter(|row| !row.is_empty()));
    }
    let found =
        [(velocities.len(), "velocities"), (accelerations.len(), "accelerations"), (time.len(), "time_from_start")];
    if let Some((found, what)) = found.into_iter().find(|(found, _)| *found != 0 && *found != count) {
        return Err(source
            .diagnostic(format!("{found} of {count} points have {what}"))
            .help(format!("give all points their {what}, or none")));
    }
    let mut samples = Samples { what: "points".into(), joined: Some(Interpolation::Quintic), ..Samples::default() };
    // The controller moves to the first point from any configuration, so the motion is known only from this point on.
    if let Some(first) = time.first().filter(|first| **first > 0.0) {
        samples
            .notes
            .push(format!("the motion until the first point, at {first} s, is not judged, because it depends on the arm's position at that time"));
    }
    samples.time = Some(time).filter(|time| !time.is_empty());
    samples.joints = series(source, names, &positions, "positions of points")?;
    let any = |rows: Vec<Vec<f64>>| Some(rows).filter(|rows| !rows.is_empty());
    samples.add(source, any(velocities), "velocities of points", |joint| &mut joint.velocity)?;
    samples.add(source, any(accelerations), "accelerations of points", |joint| &mut joint.acceleration)?;
    Ok(samples)
}

/// Converts rows of positions to one series per joint.
fn series(source: &Source, names: Vec<String>, rows: &[Vec<f64>], what: &str) -> Result<Vec<Series>, Diagnostic> {
    let columns = transposed(source, rows, names.len(), what)?;
    Ok(names.into_iter().zip(columns).map(|(name, position)| Series { name, position, ..Series::default() }).collect())
}

/// Converts rows to columns.
fn transposed(source: &Source, rows: &[Vec<f64>], width: usize, what: &str) -> Result<Vec<Vec<f64>>, Diagnostic> {
    if let Some(k) = rows.iter().position(|row| row.len() != width) {
        let message = format!("{what}[{k}] has {} values, but {width} joints are named", rows[k].len());
        return Err(source.diagnostic(message).help("give every sample one value for each joint"));
    }
    Ok((0..width).map(|joint| rows.iter().map(|row| row[joint]).collect()).collect())
}
