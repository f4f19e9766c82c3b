//! The plane that an arm moves in.

use cplan_geometry::{Point, Vector};
use cplan_model::{JointType, Plane};
use nalgebra::Vector3;

/// Largest angle, in radians, between directions that count as parallel, and largest deviation from a right angle of directions
/// that count as perpendicular. Exported files have axes like `-1.19e-5 0 0.9999` and angles like 1.57. Over a metre, this angle
/// is a deviation of a millimetre.
pub(super) const ALIGNMENT_TOLERANCE: f64 = 1e-3;

/// A joint's axis in the root frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct SpatialAxis<'a> {
    pub name: &'a str,
    pub revolute: bool,
    /// Unit direction of the axis.
    pub direction: Vector3<f64>,
}

/// Returns the common plane of motion of two joints.
///
/// Its normal is the axis of the revolute joints, or the cross product of two prismatic axes. A normal within 1e-3 rad of a root
/// axis is replaced by that axis. The plane coordinates are then the root's `(x, y)` for z, `(x, z)` for y and `(y, z)` for x,
/// and heights increase along the positive axis.
///
/// Any other plane has the first revolute axis `n` as its normal. Its `u` is the root's x projected on the plane, or y if x is
/// close to `n`, and `v = n x u`.
///
/// # Errors
/// Joints that do not move in one plane. The message has the directions of their axes.
pub(super) fn common_plane(axes: [SpatialAxis; 2]) -> Result<Plane, String> {
    let [a, b] = axes;
    let cross = a.direction.cross(&b.direction).norm();
    let across = a.direction.dot(&b.direction).abs();
    let normal = match (a.revolute, b.revolute) {
        (true, true) if cross > ALIGNMENT_TOLERANCE.sin() => return Err(refusal(axes, "these axes are not parallel")),
        (true, false) | (false, true) if across > ALIGNMENT_TOLERANCE.sin() => {
            return Err(refusal(axes, "the sliding direction is not perpendicular to the axis of rotation"));
        }
        (false, false) if cross < ALIGNMENT_TOLERANCE.sin() => {
            return Err(refusal(axes, "both joints slide along the same line, so the tip cannot leave this line"));
        }
        (true, _) => a.direction,
        (false, true) => b.direction,
        (false, false) => a.direction.cross(&b.direction).normalize(),
    };
    Ok(basis(normal))
}

/// Describes the deviation of revolute axes from the plane's normal, or of prismatic axes from the plane. `None` if it is
/// negligible.
pub(super) fn deviation(plane: &Plane, axes: [SpatialAxis; 2]) -> Option<String> {
    /// Least deviation that is reported, in radians. It amounts to a micrometre over a metre.
    const NOTICED_DEVIATION: f64 = 1e-6;
    let off = |axis: &SpatialAxis| {
        let [across, along] = [axis.direction.cross(&plane.normal).norm(), axis.direction.dot(&plane.normal).abs()];
        if axis.revolute { across } else { along }
    };
    let off = axes.iter().map(off).fold(0.0, f64::max);
    (off > NOTICED_DEVIATION).then(|| {
        format!(
            "the joints' axes deviate from the assumed plane of motion by up to {off:.1e} rad ({off:.1e} m per metre)"
        )
    })
}

fn refusal(axes: [SpatialAxis; 2], reason: &str) -> String {
    let describe = |axis: SpatialAxis| {
        let d = axis.direction;
        let does = if axis.revolute { "turns about" } else { "slides along" };
        format!("joint \"{}\" {does} {}", axis.name, vector(d))
    };
    let angle = axes[0].direction.dot(&axes[1].direction).clamp(-1.0, 1.0).acos().to_degrees();
    format!(
        "the two joints do not move in one common plane: {}, {} in the root frame ({angle:.2} degrees apart): {reason}",
        describe(axes[0]),
        describe(axes[1])
    )
}

/// Formats a direction for messages.
pub(super) fn vector(d: Vector3<f64>) -> String {
    // Adding 0 turns -0, a possible result of rounding, into 0.
    let [x, y, z] = [d.x, d.y, d.z].map(|c| (c * 1e4).round() / 1e4 + 0.0);
    format!("({x}, {y}, {z})")
}

fn basis(normal: Vector3<f64>) -> Plane {
    let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
    for (axis, u, v) in [(z, x, y), (y, x, z), (x, y, z)] {
        if normal.cross(&axis).norm() <= ALIGNMENT_TOLERANCE.sin() {
            return Plane { u, v, normal: axis };
        }
    }
    let reference = if normal.x.abs() < 0.9 { x } else { y };
    let u = (reference - normal * normal.dot(&reference)).normalize();
    Plane { u, v: normal.cross(&u), normal }
}

/// Returns the plane coordinates of a point of the root frame.
pub(super) fn project(plane: &Plane, x: &Vector3<f64>) -> Point {
    Point::new(x.dot(&plane.u), x.dot(&plane.v))
}

/// Returns a joint's motion in plane coordinates.
pub(super) fn joint_type_in(plane: &Plane, axis: SpatialAxis) -> JointType {
    if axis.revolute {
        let turn = axis.direction.dot(&plane.u.cross(&plane.v));
        return JointType::Revolute { sign: if turn > 0.0 { 1.0 } else { -1.0 } };
    }
    JointType::Prismatic { direction: clean(project(plane, &axis.direction).normalize()) }
}

/// Removes rounding errors from a unit direction: within 1e-12 of an axis, it becomes the axis.
fn clean(direction: Vector) -> Vector {
    const ROUNDING: f64 = 1e-12;
    let snapped = direction.map(|c| if c.abs() < ROUNDING { 0.0 } else { c });
    snapped.normalize()
}

/// Describes the plane.
pub(super) fn describe(plane: &Plane, root: &str) -> String {
    let axis = |d: Vector3<f64>| match d {
        d if d == Vector3::x() => Some("x"),
        d if d == Vector3::y() => Some("y"),
        d if d == Vector3::z() => Some("z"),
        _ => None,
    };
    match (axis(plane.u), axis(plane.v), axis(plane.normal)) {
        (Some(u), Some(v), Some(n)) => {
            format!("plane: coordinates are ({u}, {v}) of the root frame \"{root}\", heights along {n}")
        }
        _ => format!(
            "plane: coordinates along {} and {} of the root frame \"{root}\", heights along {}",
            vector(plane.u),
            vector(plane.v),
            vector(plane.normal)
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turn(name: &str, direction: [f64; 3]) -> SpatialAxis<'_> {
        SpatialAxis { name, revolute: true, direction: Vector3::from(direction).normalize() }
    }

    fn slide(name: &str, direction: [f64; 3]) -> SpatialAxis<'_> {
        SpatialAxis { revolute: false, ..turn(name, direction) }
    }

    #[test]
    fn root_axes_give_root_coordinates() {
        for (axis, u, v) in [
            ([0.0, 0.0, -1.0], Vector3::x(), Vector3::y()),
            ([0.0, 1.0, 0.0], Vector3::x(), Vector3::z()),
            ([-1.19e-5, 0.0, 0.9999], Vector3::x(), Vector3::y()),
            ([1.0, 9e-4, 0.0], Vector3::y(), Vector3::z()),
        ] {
            let plane = common_plane([turn("a", axis), turn("b", axis)]).unwrap();
            assert_eq!((plane.u, plane.v), (u, v), "{axis:?}");
            assert!(plane.normal.iter().all(|c| *c >= 0.0));
        }
        let plane = common_plane([slide("a", [1.0, 0.0, 0.0]), slide("b", [0.0, 0.0, 1.0])]).unwrap();
        assert_eq!((plane.u, plane.v, plane.normal), (Vector3::x(), Vector3::z(), Vector3::y()));
    }

    #[test]
    fn any_other_plane_has_a_right_handed_orthonormal_basis() {
        for n in [[0.0, 1.0, 1.0], [1.0, 0.1, 0.0], [-1.0, 2.0, 3.0]] {
            let plane = common_plane([slide("a", [n[1], -n[0], 0.0]), turn("b", n)]).unwrap();
            let n = Vector3::from(n).normalize();
            assert!((plane.u.cross(&plane.v) - n).norm() < 1e-12 && (plane.normal - n).norm() < 1e-12);
            assert!((plane.u.norm() - 1.0).abs() < 1e-12 && plane.u.dot(&n).abs() < 1e-12);
        }
    }

    #[test]
    fn deviating_axes_are_reported() {
        let deviation_of = |a, b| deviation(&common_plane([a, b]).unwrap(), [a, b]);
        assert_eq!(deviation_of(turn("a", [0.0, 0.0, 1.0]), turn("b", [0.0, 1e-7, -1.0])), None);
        assert_eq!(deviation_of(turn("a", [0.0, 1.0, 1.0]), slide("b", [0.0, 1.0, -1.0])), None);
        for b in [turn("b", [0.0, 5e-4, 1.0]), slide("b", [1.0, 0.0, -5e-4])] {
            let deviation_of = deviation_of(turn("a", [0.0, 0.0, 1.0]), b).unwrap();
            assert!(deviation_of.contains("up to 5.0e-4 rad"), "{deviation_of}");
        }
    }

    #[test]
    fn sign_follows_the_axis_in_plane_coordinates() {
        for (axis, sign) in
            [([0.0, 0.0, 1.0], 1.0), ([0.0, 0.0, -1.2], -1.0), ([0.0, 1.0, 0.0], -1.0), ([1.0, 0.0, 0.0], 1.0)]
        {
            let plane = common_plane([turn("a", axis), turn("b", axis)]).unwrap();
            assert_eq!(joint_type_in(&plane, turn("a", axis)), JointType::Revolute { sign }, "{axis:?}");
        }
    }

    #[test]
    fn joints_without_a_common_plane_are_refused() {
        let pan_tilt = common_plane([turn("pan", [0.0, 0.0, 1.0]), turn("tilt", [0.0, 1.0, 0.0])]).unwrap_err();
        for part in ["\"pan\" turns about (0, 0, 1)", "\"tilt\" turns about (0, 1, 0)", "90.00 degrees", "not parallel"]
        {
            assert!(pan_tilt.contains(part), "{pan_tilt}");
        }
        assert!(common_plane([turn("a", [0.0, 0.0, 1.0]), turn("b", [0.0, 1.1e-3, 1.0])]).is_err());
        assert!(
            common_plane([turn("a", [0.0, 0.0, 1.0]), slide("b", [0.0, 0.0, 1.0])])
                .unwrap_err()
                .contains("slides along")
        );
        assert!(
            common_plane([slide("a", [1.0, 0.0, 0.0]), slide("b", [-1.0, 0.0, 0.0])])
                .unwrap_err()
                .contains("same line")
        );
    }
}
