//! The interpolation of ROS 2's `joint_trajectory_controller` between the points of a message, after its
//! `trajectory.cpp` (`interpolate_between_points`): lines through positions, cubics if both points have velocities,
//! quintics if both have accelerations. Times are those of the message, in whole nanoseconds. The code shares nothing
//! with the library.

/// The points of a message: the time of each, and its positions, velocities and accelerations. Each list may be empty.
#[derive(Debug, Clone, Default)]
pub struct Message {
    pub joints: Vec<String>,
    /// Times of the points, in nanoseconds from the start.
    pub since: Vec<u64>,
    pub points: Vec<[Vec<f64>; 3]>,
}

/// Returns the time between two points in seconds. The arguments are nanoseconds.
pub fn seconds(from: u64, to: u64) -> f64 {
    (to - from) as f64 * 1e-9
}

/// Returns position, velocity and acceleration of a joint, `t` seconds after point `k`.
pub fn played(message: &Message, k: usize, joint: usize, t: f64) -> [f64; 3] {
    let duration = seconds(message.since[k], message.since[k + 1]);
    let [a, b] = [&message.points[k], &message.points[k + 1]];
    let both = |of: usize| (!a[of].is_empty() && !b[of].is_empty()).then(|| [a[of][joint], b[of][joint]]);
    let [start, end] = both(0).expect("positions");
    let coefficients = match (both(1), both(2)) {
        (None, None) => vec![start, (end - start) / duration],
        (Some([v0, v1]), None) => vec![
            start,
            v0,
            (-3.0 * start + 3.0 * end - 2.0 * v0 * duration - v1 * duration) / duration.powi(2),
            (2.0 * start - 2.0 * end + v0 * duration + v1 * duration) / duration.powi(3),
        ],
        (velocities, Some([a0, a1])) => {
            let [v0, v1] = velocities.expect("velocities beside accelerations");
            let (h, h2) = (duration, duration.powi(2));
            vec![
                start,
                v0,
                0.5 * a0,
                (-20.0 * start + 20.0 * end - 3.0 * a0 * h2 + a1 * h2 - 12.0 * v0 * h - 8.0 * v1 * h)
                    / (2.0 * h.powi(3)),
                (30.0 * start - 30.0 * end + 3.0 * a0 * h2 - 2.0 * a1 * h2 + 16.0 * v0 * h + 14.0 * v1 * h)
                    / (2.0 * h.powi(4)),
                (-12.0 * start + 12.0 * end - a0 * h2 + a1 * h2 - 6.0 * v0 * h - 6.0 * v1 * h) / (2.0 * h.powi(5)),
            ]
        }
    };
    let mut values = [0.0; 3];
    for (n, c) in coefficients.iter().enumerate() {
        let n = n as i32;
        let term = |factor: i32, power: i32| if factor == 0 { 0.0 } else { f64::from(factor) * c * t.powi(power) };
        values[0] += term(1, n);
        values[1] += term(n, n - 1);
        values[2] += term(n * (n - 1), n - 2);
    }
    values
}

#[test]
fn quintics_and_cubics_meet_their_points() {
    let cubic = Message {
        joints: vec!["a".into()],
        since: vec![0, 500_000_000],
        points: vec![[vec![1.0], vec![-0.5], vec![]], [vec![0.3], vec![2.0], vec![]]],
    };
    let mut quintic = cubic.clone();
    quintic.points[0][2] = vec![4.0];
    quintic.points[1][2] = vec![-7.0];
    for message in [cubic, quintic] {
        for (at, t) in [(0, 0.0), (1, 0.5)] {
            let found = played(&message, 0, 0, t);
            for (of, value) in found.into_iter().enumerate() {
                let expected = message.points[at][of].first();
                assert!(expected.is_none_or(|expected| (value - expected).abs() < 1e-12), "{of} at {t}: {value}");
            }
        }
    }
}
