//! The ROS 2 messages for motions and their display: definitions, and contents as bytes.

use super::super::JointMotion;
use super::super::clock::{NANOSECONDS_PER_SECOND, nanoseconds};
use super::cdr::Cdr;
use super::scene::{Body, Place, Stage};

/// A ROS 2 message type.
pub struct Type {
    /// Full name of the type, with its package.
    pub name: &'static str,
    fields: &'static str,
    parts: &'static [Part],
}

/// A type within a message: its name, as definitions refer to it, and its fields.
type Part = (&'static str, &'static str);

const TIME: Part = ("builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n");
const DURATION: Part = ("builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n");
const HEADER: Part = ("std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n");
const POINT: Part = (
    "trajectory_msgs/JointTrajectoryPoint",
    "float64[] positions\nfloat64[] velocities\nfloat64[] accelerations\nfloat64[] effort\n\
     builtin_interfaces/Duration time_from_start\n",
);

const VECTOR: Part = ("geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n");
const POINT3: Part = ("geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n");
const QUATERNION: Part = ("geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n");
const TRANSFORM: Part =
    ("geometry_msgs/Transform", "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n");
const STAMPED: Part = (
    "geometry_msgs/TransformStamped",
    "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n",
);
const POSE: Part = ("geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n");
const COLOR: Part = ("std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n");
const IMAGE: Part = ("sensor_msgs/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n");
const UV: Part = ("visualization_msgs/UVCoordinate", "float32 u\nfloat32 v\n");
const MESH: Part = ("visualization_msgs/MeshFile", "string filename\nuint8[] data\n");
const MARKER: Part = (
    "visualization_msgs/Marker",
    "std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Pose pose\n\
     geometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\nbool frame_locked\n\
     geometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\nstring texture_resource\n\
     sensor_msgs/CompressedImage texture\nvisualization_msgs/UVCoordinate[] uv_coordinates\nstring text\n\
     string mesh_resource\nvisualization_msgs/MeshFile mesh_file\nbool mesh_use_embedded_materials\n",
);
const FIELD: Part = ("sensor_msgs/PointField", "string name\nuint32 offset\nuint8 datatype\nuint32 count\n");

/// Message type for joint values at one time.
pub const JOINT_STATE: Type = Type {
    name: "sensor_msgs/msg/JointState",
    fields: "std_msgs/Header header\n\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n",
    parts: &[HEADER, TIME],
};

/// Message type for a whole motion, as controllers execute it.
pub const JOINT_TRAJECTORY: Type = Type {
    name: "trajectory_msgs/msg/JointTrajectory",
    fields: "std_msgs/Header header\n\nstring[] joint_names\nJointTrajectoryPoint[] points\n",
    parts: &[HEADER, TIME, POINT, DURATION],
};

/// Message type for the poses of frames.
pub const TRANSFORMS: Type = Type {
    name: "tf2_msgs/msg/TFMessage",
    fields: "geometry_msgs/TransformStamped[] transforms\n",
    parts: &[STAMPED, HEADER, TIME, TRANSFORM, VECTOR, QUATERNION],
};

/// Message type for surfaces.
pub const MARKERS: Type = Type {
    name: "visualization_msgs/msg/MarkerArray",
    fields: "visualization_msgs/Marker[] markers\n",
    parts: &[MARKER, HEADER, TIME, DURATION, POSE, POINT3, QUATERNION, VECTOR, COLOR, IMAGE, UV, MESH],
};

/// Message type for points.
pub const POINTS: Type = Type {
    name: "sensor_msgs/msg/PointCloud2",
    fields: "std_msgs/Header header\n\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\nbool is_bigendian\n\
             uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n",
    parts: &[HEADER, TIME, FIELD],
};

impl Type {
    /// Returns the definition in the encoding `ros2msg` (MCAP registry), with which readers can decode messages without ROS. The
    /// type's own fields come first, then those of each nested type, after a line of 80 equals signs and a line with its name.
    pub fn definition(&self) -> String {
        let parts = self.parts.iter().map(|(name, fields)| format!("{}\nMSG: {name}\n{fields}", "=".repeat(80)));
        std::iter::once(self.fields.to_owned()).chain(parts).collect()
    }
}

/// Returns the bytes of a [`JOINT_STATE`] at a time of the recording, nanoseconds, without efforts.
pub fn joint_state(joints: &[String], time: u64, position: &[f64], velocity: &[f64]) -> Vec<u8> {
    let mut cdr = Cdr::new();
    header(&mut cdr, time);
    cdr.strings(joints);
    cdr.f64s(position);
    cdr.f64s(velocity);
    cdr.f64s(&[]);
    cdr.into_bytes()
}

/// Returns the bytes of a [`JOINT_TRAJECTORY`]. As in [`super::super::ros_yaml`], its time stamp is 0, which means "begin now".
pub fn joint_trajectory(motion: &JointMotion) -> Vec<u8> {
    let mut cdr = Cdr::new();
    header(&mut cdr, 0);
    cdr.strings(&motion.joints);
    cdr.length(motion.time.len());
    for (k, &time) in motion.time.iter().enumerate() {
        cdr.f64s(&motion.position[k]);
        cdr.f64s(&motion.velocity[k]);
        cdr.f64s(motion.acceleration.as_ref().map_or(&[], |acceleration| &acceleration[k]));
        cdr.f64s(&[]);
        write_time(&mut cdr, nanoseconds(time));
    }
    cdr.into_bytes()
}

/// Name of the frame of the robot's root. All other frames are given relative to it.
const WORLD_FRAME: &str = "world";

/// Returns the bytes of [`TRANSFORMS`]: names of frames, and their poses from `time` on.
pub fn transforms(time: u64, frames: &[(&str, (Place, [f64; 4]))]) -> Vec<u8> {
    let mut cdr = Cdr::new();
    cdr.length(frames.len());
    for (name, (at, orientation)) in frames {
        write_time(&mut cdr, time);
        cdr.string(WORLD_FRAME);
        cdr.string(name);
        at.iter().chain(orientation).for_each(|&value| cdr.f64(value));
    }
    cdr.into_bytes()
}

/// Returns the bytes of [`MARKERS`]. Each solid of a body is a list of triangles, which moves with the body's frame.
pub fn markers(stage: &Stage) -> Vec<u8> {
    /// Value of `TRIANGLE_LIST` in the definition of markers.
    const TRIANGLE_LIST: i32 = 11;
    let mut cdr = Cdr::new();
    cdr.length(stage.bodies.iter().map(|body| body.solids.len()).sum());
    let solids = stage.bodies.iter().flat_map(|body| body.solids.iter().map(move |solid| (body, solid)));
    for (number, (body, solid)) in (0..).zip(solids) {
        write_time(&mut cdr, 0);
        cdr.string(&body.name);
        cdr.string(&solid.name);
        cdr.i32(number);
        cdr.i32(TRIANGLE_LIST);
        // Action "add".
        cdr.i32(0);
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0].iter().chain(&[1.0; 3]).for_each(|&value| cdr.f64(value));
        solid.color.iter().chain(&[1.0]).for_each(|&value| cdr.f32(value));
        // The marker has no end, and moves with its frame.
        write_time(&mut cdr, 0);
        cdr.u8(1);
        let corners = stage.triangles(solid);
        cdr.length(corners.len());
        corners.iter().flatten().for_each(|&value| cdr.f64(value));
        // No colours of corners; no texture: its name, image and coordinates; no text.
        cdr.length(0);
        cdr.string("");
        header(&mut cdr, 0);
        cdr.string("");
        cdr.length(0);
        cdr.length(0);
        cdr.string("");
        // No mesh: its name, file and materials.
        cdr.string("");
        cdr.string("");
        cdr.length(0);
        cdr.u8(0);
    }
    cdr.into_bytes()
}

/// Returns the bytes of [`POINTS`]: points along the rims of a body.
pub fn points(stage: &Stage, body: &Body) -> Vec<u8> {
    /// Value of `FLOAT32` in the definition of points, and the size of such a number in bytes.
    const FLOAT32_FIELD: (u8, u32) = (7, 4);
    let points = stage.rims(body);
    let step = 3 * FLOAT32_FIELD.1;
    let count = u32::try_from(points.len()).expect("fewer than 2^32 points");
    let mut cdr = Cdr::new();
    write_time(&mut cdr, 0);
    cdr.string(&body.name);
    cdr.u32(1);
    cdr.u32(count);
    cdr.length(3);
    for (name, place) in ["x", "y", "z"].into_iter().zip(0..) {
        cdr.string(name);
        cdr.u32(place * FLOAT32_FIELD.1);
        cdr.u8(FLOAT32_FIELD.0);
        cdr.u32(1);
    }
    cdr.u8(0);
    cdr.u32(step);
    cdr.u32(count * step);
    cdr.length((count * step) as usize);
    points.iter().flatten().flat_map(|&value| (value as f32).to_le_bytes()).for_each(|byte| cdr.u8(byte));
    cdr.u8(1);
    cdr.into_bytes()
}

/// Writes a header with an empty frame, because joint values belong to no frame.
fn header(cdr: &mut Cdr, time: u64) {
    write_time(cdr, time);
    cdr.string("");
}

/// Writes a `Time` or a `Duration`.
fn write_time(cdr: &mut Cdr, nanoseconds: u64) {
    // The message can express up to 68 years. Motions last at most eleven days.
    cdr.i32(i32::try_from(nanoseconds / NANOSECONDS_PER_SECOND).unwrap_or(i32::MAX));
    cdr.u32((nanoseconds % NANOSECONDS_PER_SECOND) as u32);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn message_definitions_include_all_types_that_they_use() {
        for kind in [JOINT_STATE, JOINT_TRAJECTORY, TRANSFORMS, MARKERS, POINTS] {
            let text = kind.definition();
            let defined: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("MSG: ")).collect();
            let separators = text.lines().filter(|line| *line == "=".repeat(80)).count();
            assert_eq!(separators, defined.len());
            for line in text.lines().filter(|line| line.contains('/') && !line.starts_with("MSG: ")) {
                let (used, _) = line.split_once(' ').expect("a type and a name");
                assert!(defined.contains(&used.trim_end_matches("[]")), "{used}");
            }
        }
        assert!(
            JOINT_TRAJECTORY.definition().contains("MSG: trajectory_msgs/JointTrajectoryPoint\nfloat64[] positions\n")
        );
    }
}
