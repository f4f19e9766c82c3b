//! Torques, compared with bodies that are moved in small steps, with closed forms, with the fastest motion by brute
//! force, and with the motions that controllers execute.

use super::certified;
use cplan::check::certify;
use cplan::geometry::{Point, Pose, Vector};
use cplan::model::{
    Arm, Body, Dynamics, Grip, Heights, Holding, JointType, Object, Payload, Scene, Shape, Task, ToolValues, Torques,
};
use cplan::motion::{Drive, Objective, TimingError, Trajectory};
use cplan::space::{Configuration, Path};
use cplan_cases::dice::Dice;
use cplan_cases::{dice, times};
use cplan_testkit::arms::{self, all_kinds};
use cplan_testkit::scenes::{anywhere, scene};
use cplan_testkit::shapes::rectangle;

/// Returns centre and orientation of a body. Computes them with complex numbers, without the arm's own kinematics.
fn placed(arm: &Arm, link: usize, center: Point, q: [f64; 2]) -> ([f64; 2], f64) {
    let (mut at, mut angle) = ([arm.base.x, arm.base.y], 0.0_f64);
    let mut go = |by: [f64; 2], angle: f64| {
        at[0] += by[0] * angle.cos() - by[1] * angle.sin();
        at[1] += by[0] * angle.sin() + by[1] * angle.cos();
    };
    for (k, value) in q.iter().enumerate().take(link + 1) {
        match arm.joints[k].joint_type {
            JointType::Revolute { sign } => angle += sign * value,
            JointType::Prismatic { direction } => go([direction.x * value, direction.y * value], angle),
        }
        if k < link {
            go([arm.offset.x, arm.offset.y], angle);
        }
    }
    go([center.x, center.y], angle);
    (at, angle)
}

/// Returns the torques that move the bodies as requested, by the principle of virtual work. Uses differences instead of
/// derivatives.
fn by_steps(arm: &Arm, dynamics: &Dynamics, q: [f64; 2], v: [f64; 2], a: [f64; 2]) -> [f64; 2] {
    let (h, small) = (1e-4, 1e-5);
    let moved = |t: f64| [0, 1].map(|k| q[k] + v[k] * t + a[k] * t * t / 2.0);
    let gravity = [dynamics.gravity.x, dynamics.gravity.y];
    let mut torque = [0.0; 2];
    for (link, body) in dynamics.bodies.iter().enumerate() {
        let at = |q: [f64; 2]| {
            let ([x, y], angle) = placed(arm, link, body.center, q);
            [x, y, angle]
        };
        let [before, now, after] = [-h, 0.0, h].map(|t| at(moved(t)));
        let pull = [0, 1, 2].map(|c| (after[c] - 2.0 * now[c] + before[c]) / (h * h));
        for (k, torque) in torque.iter_mut().enumerate() {
            let nudged = |by: f64| at([0, 1].map(|l| q[l] + if l == k { by } else { 0.0 }));
            let (ahead, behind) = (nudged(small), nudged(-small));
            let column = [0, 1, 2].map(|c| (ahead[c] - behind[c]) / (2.0 * small));
            let moved: f64 = (0..2).map(|c| column[c] * (pull[c] - gravity[c])).sum();
            *torque += body.mass * moved + body.inertia * column[2] * pull[2];
        }
    }
    torque
}

/// Draws an arm with bodies of up to some kilograms, and with efforts that can hold them.
fn drawn(dice: &mut Dice, mut arm: Arm, strength: f64) -> Arm {
    let body = |dice: &mut Dice| Body {
        mass: dice.within(0.5, 4.0),
        center: Point::new(dice.within(-0.1, 0.5), dice.within(-0.1, 0.1)),
        inertia: dice.within(0.01, 0.1),
    };
    let bodies = [body(dice), body(dice)];
    let gravity = Vector::new(dice.within(-10.0, 10.0), dice.within(-10.0, 10.0));
    let mut dynamics = Dynamics { bodies, gravity, effort: [1.0; 2], assumed: [true; 2], limits: true };
    // In every configuration, the torque that holds the arm is a fraction of this effort.
    let weight = bodies.map(|body| body.mass * gravity.norm());
    let holding = |k: usize| {
        let turns = arm.joints[k].joint_type.is_revolute();
        let lever = if turns { 3.0 } else { 1.0 };
        lever * (weight[1] + if k == 0 { weight[0] } else { 0.0 })
    };
    dynamics.effort = [strength * holding(0), strength * holding(1)];
    for joint in &mut arm.joints {
        (joint.velocity, joint.acceleration) = (2.0, 1e4);
    }
    arm.dynamics = Some(dynamics);
    arm
}

#[test]
fn torques_move_the_bodies() {
    let mut dice = dice(71);
    let mut seen = 0;
    for kind in (0..50).flat_map(|_| all_kinds()) {
        let arm = drawn(&mut dice, kind, 1.0);
        let dynamics = arm.dynamics.expect("drawn");
        let q: [f64; 2] = anywhere(&mut dice, &arm).into();
        let [v, a] = [2.0, 5.0].map(|most| [0, 1].map(|_| dice.within(-most, most)));
        let torque = Torques { arm: &arm, dynamics }.torque(q.into(), v.into(), a.into());
        let expected = by_steps(&arm, &dynamics, q, v, a);
        for k in 0..2 {
            assert!(
                (torque[k] - expected[k]).abs() < 1e-4 * (1.0 + expected[k].abs()),
                "{torque} {expected:?} {arm:?}"
            );
        }
        seen += 1;
    }
    assert_eq!(seen, 50 * all_kinds().len());
}

/// Returns position, velocity and acceleration at a fraction `u` of the interval after sample `i`, in two ways. The
/// first is the cubic through positions and velocities. The second is the polynomial of the fourth degree that also has
/// the acceleration.
fn between(trajectory: &Trajectory, i: usize, u: f64) -> [[[f64; 2]; 3]; 2] {
    let h = trajectory.time[i + 1] - trajectory.time[i];
    let of = |k: usize, is_quartic: bool| {
        let ends = |rows: &[[f64; 2]]| [rows[i][k], rows[i + 1][k]];
        let ([a, b], [va, vb]) = (ends(&trajectory.position), ends(&trajectory.velocity));
        let c2 = if is_quartic { trajectory.acceleration[i][k] / 2.0 } else { (3.0 * (b - a) / h - 2.0 * va - vb) / h };
        // Solves a + va h + c2 h2 + c3 h3 + c4 h4 = b, with the derivative vb at the end.
        let (rest, slope) = (b - a - va * h - c2 * h * h, vb - va - 2.0 * c2 * h);
        let c4 = (slope * h - 3.0 * rest) / h.powi(4);
        let c3 = (rest - c4 * h.powi(4)) / h.powi(3);
        let t = u * h;
        [
            a + t * (va + t * (c2 + t * (c3 + t * c4))),
            va + t * (2.0 * c2 + t * (3.0 * c3 + t * 4.0 * c4)),
            2.0 * c2 + t * (6.0 * c3 + t * 12.0 * c4),
        ]
    };
    [false, true].map(|is_quartic| {
        let [first, second] = [of(0, is_quartic), of(1, is_quartic)];
        [0, 1, 2].map(|order| [first[order], second[order]])
    })
}

/// Checks that torques are within the efforts along the whole motion, for both interpolations of the samples. Returns
/// the greatest torque as a fraction of the effort.
fn check_torques(arm: &Arm, dynamics: &Dynamics, trajectory: &Trajectory, what: &str) -> f64 {
    let mut greatest = 0.0_f64;
    for i in 0..trajectory.time.len() - 1 {
        for part in 0..=4 {
            for [q, v, a] in between(trajectory, i, f64::from(part) / 4.0) {
                let torque = by_steps(arm, dynamics, q, v, a);
                for (k, (torque, effort)) in torque.into_iter().zip(dynamics.effort).enumerate() {
                    let share = torque.abs() / effort;
                    assert!(share <= 1.0 + 1e-5, "{what}: joint {k} at sample {i}, part {part}: {share}");
                    greatest = greatest.max(share);
                }
            }
        }
        let stated = trajectory.torque[i];
        let [q, v, a] = [trajectory.position[i], trajectory.velocity[i], trajectory.acceleration[i]];
        let expected = by_steps(arm, dynamics, q, v, a);
        assert!((0..2).all(|k| (stated[k] - expected[k]).abs() < 1e-4 * dynamics.effort[k]), "{what}: sample {i}");
    }
    greatest
}

/// Returns the least time along a straight piece, by small steps in the plane of position and squared speed.
fn least_time(arm: &Arm, dynamics: &Dynamics, from: [f64; 2], to: [f64; 2]) -> f64 {
    const STEPS: usize = 4000;
    let offset = [0, 1].map(|k| to[k] - from[k]);
    let length = offset[0].hypot(offset[1]);
    let way = offset.map(|x| x / length);
    let step = length / STEPS as f64;
    let most = (0..2).map(|k| (arm.joints[k].velocity / way[k].abs()).powi(2)).fold(f64::INFINITY, f64::min);
    // Torques are `inertial z' / 2 + bent z + holding`.
    let factors: Vec<[[f64; 2]; 3]> = (0..STEPS)
        .map(|i| {
            let q = [0, 1].map(|k| from[k] + way[k] * (i as f64 + 0.5) * step);
            let holding = by_steps(arm, dynamics, q, [0.0; 2], [0.0; 2]);
            let [inertial, bent] =
                [by_steps(arm, dynamics, q, [0.0; 2], way), by_steps(arm, dynamics, q, way, [0.0; 2])];
            [[0, 1].map(|k| inertial[k] - holding[k]), [0, 1].map(|k| bent[k] - holding[k]), holding]
        })
        .collect();
    let range = |i: usize, z: f64| {
        let [inertial, bent, holding] = factors[i];
        let mut range = [f64::NEG_INFINITY, f64::INFINITY];
        for k in 0..2 {
            let ends = [-1.0, 1.0].map(|s| (s * dynamics.effort[k] - bent[k] * z - holding[k]) / inertial[k]);
            range = [range[0].max(ends[0].min(ends[1])), range[1].min(ends[0].max(ends[1]))];
        }
        range
    };
    let mut back = vec![0.0; STEPS + 1];
    for i in (0..STEPS).rev() {
        back[i] = (back[i + 1] - 2.0 * step * range(i, back[i + 1])[0]).min(most);
    }
    let mut z = 0.0;
    (0..STEPS)
        .map(|i| {
            let next = f64::min(z + 2.0 * step * range(i, z)[1], back[i + 1]);
            let time = 2.0 * step / (z.sqrt() + next.sqrt());
            z = next;
            time
        })
        .sum()
}

#[test]
fn straight_motions_are_as_fast_as_the_torques_allow() {
    let mut dice = dice(72);
    let (mut seen, mut worst) = (0, 0.0_f64);
    for kind in (0..6).flat_map(|_| all_kinds()) {
        let arm = drawn(&mut dice, kind, 1.3);
        let dynamics = arm.dynamics.expect("drawn");
        let [from, to] = [0, 1].map(|_| <[f64; 2]>::from(anywhere(&mut dice, &arm)));
        let scene = scene(arm.clone(), vec![]);
        let path = certified(&scene, &[from, to]);
        let timed = Drive::default().along(&scene, &path, 1.0).expect("the efforts hold it");
        let least = least_time(&arm, &dynamics, from, to);
        let longer = timed.trajectory.duration() / least - 1.0;
        assert!((-1e-3..0.03).contains(&longer), "{longer}: {least} s, {arm:?}, {from:?} to {to:?}");
        assert!(check_torques(&arm, &dynamics, &timed.trajectory, "straight") > 0.9 || longer < 0.01);
        (seen, worst) = (seen + 1, worst.max(longer));
    }
    println!("{seen} motions, at most {:.2} % longer than by brute force", 100.0 * worst);
    assert!(seen >= 24);
}

#[test]
fn motions_with_corners_keep_the_efforts_as_they_are_played() {
    let mut dice = dice(73);
    for (n, kind) in (0..times(2)).flat_map(|_| all_kinds()).enumerate() {
        let mut arm = drawn(&mut dice, kind, 1.2);
        let is_smooth = n % 2 == 1;
        if is_smooth {
            arm.joints.iter_mut().for_each(|joint| (joint.jerk, joint.acceleration) = (Some(300.0), 30.0));
        }
        let dynamics = arm.dynamics.expect("drawn");
        let corners: Vec<Configuration> = (0..4).map(|_| anywhere(&mut dice, &arm)).collect();
        let scene = scene(arm.clone(), vec![]);
        let path = certify(&scene, Path::new(corners)).expect("nothing is in the way");
        let optimize = if n % 3 == 2 { Objective::Time } else { Objective::Length };
        let drive = Drive { optimize, ..Drive::default() };
        let timed = drive.along(&scene, &path, 1.0).expect("the efforts hold it");
        check_torques(&arm, &dynamics, &timed.trajectory, &format!("motion {n}"));
    }
}

/// Returns a gantry with these efforts, masses and gravity.
fn gantry(effort: [f64; 2], mass: [f64; 2], gravity: Vector) -> Arm {
    let mut arm = arms::gantry([-10.0, 10.0], vec![]);
    let bodies = mass.map(|mass| Body { mass, center: Point::zeros(), inertia: 0.0 });
    arm.dynamics = Some(Dynamics { bodies, gravity, effort, assumed: [true; 2], limits: true });
    arm.joints.iter_mut().for_each(|joint| (joint.velocity, joint.acceleration) = (100.0, 1e6));
    arm
}

fn driven(scene: &Scene, waypoints: &[[f64; 2]]) -> Result<f64, TimingError> {
    Drive::default().along(scene, &certified(scene, waypoints), 1.0).map(|timed| timed.trajectory.duration())
}

#[test]
fn the_slide_of_the_book_has_its_torques() {
    // A mass of 6 kg is moved over 4 m by 24 N, which accelerates it with 4 m/s2 over half the distance.
    let along_x = driven(&scene(gantry([24.0, 5.0], [4.0, 2.0], Vector::zeros()), vec![]), &[[0.0, 0.0], [4.0, 0.0]]);
    assert!((along_x.expect("a motion") / 2.0 - 1.0).abs() < 5e-3);
    // A mass of 2 kg is lifted by 30 N against gravity: it is accelerated with 5 m/s2 and braked with 25.
    let lift =
        driven(&scene(gantry([24.0, 30.0], [4.0, 2.0], Vector::new(0.0, -10.0)), vec![]), &[[0.0, 0.0], [0.0, 3.0]]);
    let expected = (2.0 * 3.0 * (1.0 / 5.0 + 1.0 / 25.0_f64)).sqrt();
    assert!((lift.expect("a motion") / expected - 1.0).abs() < 5e-3);
    let heavy =
        driven(&scene(gantry([24.0, 19.0], [4.0, 2.0], Vector::new(0.0, -10.0)), vec![]), &[[0.0, 0.0], [0.0, 3.0]]);
    let Err(TimingError::TooHeavy { drive, torque, effort, .. }) = heavy else { panic!("{heavy:?}") };
    assert_eq!((drive.as_str(), effort), ("joint \"y\"", 19.0));
    assert!((torque - 20.0).abs() < 1e-9);
}

#[test]
fn payload_mass_counts() {
    let block = Object {
        name: "block".into(),
        shape: Shape::Pieces,
        pieces: vec![rectangle(-1.0, 1.0, -0.5, 0.5)],
        heights: Heights::ALL,
        lift: 0.0,
        holding: Holding::Rigid,
        at: Pose::identity(),
        trajectory: None,
        mass: 6.0,
        presence: None,
    };
    let bare = gantry([24.0, 30.0], [4.0, 2.0], Vector::zeros());
    let rigid = Grip::Rigid(Pose::translation(Vector::new(0.5, 0.0)));
    let carrying = |arm: &Arm, grip| {
        let task = Task {
            arm: arm.clone(),
            workspace: scene(arm.clone(), vec![]).workspace().clone().into(),
            objects: vec![block.clone()],
            start: Configuration::zeros(),
            items: vec![],
            wrist: None,
            stroke: None,
            start_tool: ToolValues::default(),
        };
        task.scene(&[None], &[], Some(&Payload { object: 0, grip, supports: vec![] }), [])
    };
    let time = driven(&carrying(&bare, rigid), &[[0.0, 0.0], [4.0, 0.0]]).expect("a motion");
    // The mass is 12 kg instead of 6.
    assert!((time / (2.0 * 2f64.sqrt()) - 1.0).abs() < 5e-3, "{time}");
    // The inertia of a block about its centre is m (a2 + b2) / 12. It is held beside its centre, so Steiner's theorem
    // applies.
    let mut turning = all_kinds().swap_remove(0);
    turning.dynamics = Some(Dynamics { bodies: [Body { mass: 1.0, ..Body::NONE }; 2], ..bare.dynamics.expect("its") });
    let body = |grip| Torques::limited(&carrying(&turning, grip)).expect("limits").dynamics.bodies[1];
    let held = body(rigid);
    let about_joint = held.inertia + held.mass * held.center.norm_squared();
    assert!(
        (held.mass - 7.0).abs() < 1e-12 && (about_joint - (6.0 * 5.0 / 12.0 + 6.0 * 0.25)).abs() < 1e-9,
        "{held:?}"
    );
    // A level payload does not turn, so its whole mass counts at the tip.
    let level = Grip::Level { angle: 0.3, point: Point::new(0.2, 0.1) };
    let held = body(level);
    let about_joint = held.inertia + held.mass * held.center.norm_squared();
    assert!((about_joint - 6.0 * turning.tip.norm_squared()).abs() < 1e-9, "{held:?}");
}
