//! Checks that accepted data is valid: each constructor refuses input that would lead to a false answer, and names it.
//! Before these checks existed, penetrations of a clockwise square were wrong, and problems without goals, or with a
//! start out of range, were reported as infeasible.

use cplan::Outcome;
use cplan::engine::{Method, solve};
use cplan::geometry::{Convex, ConvexError, Orientation, Point, SimplePolygon, Vector, orientation};
use cplan::model::{
    Additions, Arm, AttachedPart, Attachment, Body, Dynamics, Grip, Heights, JointType, MotionProblem,
    MotionProblemError, Preference, Region, Scene, SceneError, Workspace,
};
use cplan::space::{GoalSet, JointRange, Segment};
use cplan_cases::dice::Dice;
use cplan_cases::{seeds, uses_default_cases};
use cplan_testkit::arms::{link, rr};
use cplan_testkit::problems::motion_problem;
use cplan_testkit::scenes::{obstacle, placed, q};
use cplan_testkit::shapes::{disc, rectangle, wall};
use cplan_testkit::world;
use std::f64::consts::PI;

const NAN: f64 = f64::NAN;
const INFINITE: f64 = f64::INFINITY;

type Corners<'a> = &'a [(f64, f64)];

fn points(list: Corners) -> Vec<Point> {
    list.iter().map(|&(x, y)| Point::new(x, y)).collect()
}

#[test]
fn invalid_convex_shapes_are_refused() {
    use ConvexError::*;
    let square = [(0., 0.), (1., 0.), (1., 1.), (0., 1.)];
    let clockwise: Vec<_> = square.iter().rev().copied().collect();
    let pentagram: Vec<_> = (0..5).map(|k| (f64::from(k) * 0.8 * PI).sin_cos()).collect();
    let cases: &[(Corners, f64, ConvexError)] = &[
        (&[], 0.1, NoCorner),
        (&square, -0.1, Radius { radius: -0.1 }),
        (&square, INFINITE, Radius { radius: INFINITE }),
        (&[(0., 0.), (INFINITE, 0.)], 0.0, NotFinite { corner: 1 }),
        (&[(0., 0.), (1., 0.), (1., 0.), (0., 1.)], 0.0, Repeated { corner: 1 }),
        (&[(0., 0.), (1., 0.), (0., 0.)], 0.0, Repeated { corner: 2 }),
        (&clockwise, 0.0, NotConvex { corner: 1 }),
        (&[(0., 0.), (2., 0.), (1., 0.5), (2., 2.)], 0.0, NotConvex { corner: 2 }),
        (&[(0., 0.), (1., 1.), (3., 3.)], 0.0, NotConvex { corner: 0 }),
        // The ring turns left twice around, once back along a side.
        (&[(-2., 0.), (3., 2.), (-3., 0.), (-1., 0.), (-1., 1.)], 0.0, NotConvex { corner: 0 }),
    ];
    for (corners, radius, error) in cases {
        assert_eq!(Convex::new(points(corners), *radius), Err(*error), "{corners:?}");
    }
    assert!(matches!(Convex::new(points(&pentagram), 0.0), Err(NotConvex { .. })), "{pentagram:?}");
    assert!(matches!(Convex::disc(Point::zeros(), NAN), Err(Radius { .. })));
    assert_eq!(Convex::disc(Point::new(NAN, 0.0), 1.0), Err(NotFinite { corner: 0 }));
    assert_eq!(Convex::segment(Point::zeros(), Point::new(0.0, NAN)), Err(NotFinite { corner: 1 }));
}

/// Returns the usual arm of these tests with a change.
fn arm(change: impl Fn(&mut Arm)) -> Arm {
    let mut arm = rr([JointRange::Circle, JointRange::Interval { lower: -2.0, upper: 2.0 }]);
    change(&mut arm);
    arm
}

/// Returns a workspace with one obstacle and a change.
fn workspace(change: impl Fn(&mut Workspace)) -> Workspace {
    let obstacles = vec![obstacle("post", disc(Point::new(0.9, 0.9), 0.1))];
    let mut workspace = Workspace { name: "room".into(), obstacles, clearance: 0.0, preferences: Vec::new() };
    change(&mut workspace);
    workspace
}

#[test]
fn invalid_arms_make_no_scene() {
    type Change = fn(&mut Arm);
    let long = arm(|arm| {
        arm.joints[1].joint_type = JointType::Prismatic { direction: Vector::y() * 2.0 };
    });
    assert_eq!(Scene::new(long, workspace(|_| ())), Err(SceneError::JointType { joint: "elbow".into() }));
    let cases: &[(Change, &str)] = &[
        (
            |a| a.joints[1].range = JointRange::Interval { lower: 1.0, upper: -1.0 },
            "joint \"elbow\": the range from 1 to -1 is invalid",
        ),
        (
            |a| a.joints[1].range = JointRange::Interval { lower: NAN, upper: 1.0 },
            "joint \"elbow\": the range from NaN to 1 is invalid",
        ),
        (
            |a| a.joints[1].range = JointRange::Interval { lower: 0.0, upper: INFINITE },
            "joint \"elbow\": the range from 0 to inf is invalid",
        ),
        (|a| a.joints[0].joint_type = JointType::Prismatic { direction: Vector::x() }, "joint \"shoulder\" slides"),
        (
            |a| a.joints[0].joint_type = JointType::Revolute { sign: 0.5 },
            "joint \"shoulder\": its sign must be 1 or -1",
        ),
        (|a| a.joints[0].velocity = 0.0, "joint \"shoulder\": its velocity must be positive and finite, is 0"),
        (|a| a.joints[0].acceleration = NAN, "its acceleration must be positive and finite, is NaN"),
        (|a| a.joints[1].jerk = Some(-1.0), "joint \"elbow\": its jerk must be positive and finite, is -1"),
        (|a| a.base.x = NAN, "the arm's base must be finite and within 1e15 m"),
        (|a| a.offset.y = INFINITE, "the arm's offset must be finite"),
        (|a| a.tip.x = NAN, "the arm's tip must be finite"),
        (|a| a.plane.normal = a.plane.u, "must have length 1 and be at right angles"),
        (|a| a.plane.v *= 2.0, "must have length 1 and be at right angles"),
        (
            |a| a.links[0].parts[0].heights = Heights { lower: 1.0, upper: 0.0 },
            "\"upper\": the heights from 1 to 0 are invalid",
        ),
    ];
    for (change, message) in cases {
        let error = Scene::new(arm(change), workspace(|_| ())).expect_err(message).to_string();
        assert!(error.contains(message), "{error}, not {message}");
    }
}

#[test]
fn invalid_workspaces_make_no_scene() {
    type Change = fn(&mut Workspace);
    let region = || Region::Tip(SimplePolygon::new(points(&[(0., 0.), (1., 0.), (0., 1.)])).unwrap());
    let preference = |epsilon, direction| Preference { name: "wish".into(), region: region(), epsilon, direction };
    for (epsilon, direction) in [(NAN, None), (INFINITE, None), (0.5, Some([1.0, 1.0])), (0.5, Some([NAN, 0.0]))] {
        let wishful = workspace(|w| w.preferences = vec![preference(epsilon, direction)]);
        let refused = Scene::new(arm(|_| ()), wishful);
        assert_eq!(refused, Err(SceneError::Preference { name: "wish".into() }), "{epsilon} {direction:?}");
    }
    let cases: &[(Change, &str)] = &[
        (|w| w.clearance = -0.1, "the clearance must be from 0 to 1e15 m, is -0.1"),
        (|w| w.clearance = NAN, "the clearance must be from 0 to 1e15 m, is NaN"),
        (
            |w| w.obstacles[0].heights = Heights { lower: 0.0, upper: NAN },
            "\"post\": the heights from 0 to NaN are invalid",
        ),
    ];
    for (change, message) in cases {
        let error = Scene::new(arm(|_| ()), workspace(change)).expect_err(message).to_string();
        assert!(error.contains(message), "{error}, not {message}");
    }
    let scene = placed(arm(|_| ()), workspace(|_| ()));
    assert!(matches!(scene.with_clearance(INFINITE), Err(SceneError::Clearance { .. })));
}

#[test]
fn negative_masses_are_refused() {
    let body = Body { mass: 2.0, center: Point::new(0.3, 0.0), inertia: 0.1 };
    let sound = Dynamics {
        bodies: [body; 2],
        gravity: Vector::new(0.0, -9.81),
        effort: [50.0, 20.0],
        assumed: [false; 2],
        limits: true,
    };
    let weighing = |dynamics| Scene::new(arm(|arm| arm.dynamics = Some(dynamics)), workspace(|_| ()));
    assert_eq!(weighing(sound).unwrap().arm().dynamics, Some(sound));
    let light = Body { mass: -1.0, ..body };
    let far = Body { center: Point::new(NAN, 0.0), ..body };
    for (dynamics, part) in [
        (Dynamics { bodies: [body, light], ..sound }, "link 2 of -1 kg"),
        (Dynamics { bodies: [Body { inertia: INFINITE, ..body }, body], ..sound }, "link 1 of 2 kg, inf kg m2"),
        (Dynamics { bodies: [far, body], ..sound }, "link 1"),
        (Dynamics { effort: [50.0, 0.0], ..sound }, "an effort of 0"),
        (Dynamics { effort: [NAN, 20.0], ..sound }, "an effort of NaN"),
        (Dynamics { gravity: Vector::new(0.0, NAN), ..sound }, "the gravity"),
    ] {
        let error = weighing(dynamics).expect_err(part).to_string();
        assert!(error.contains(part), "{error}, not {part}");
    }
}

#[test]
fn invalid_payloads_are_refused() {
    let shape = rectangle(-0.1, 0.1, -0.1, 0.1);
    let parts = vec![AttachedPart { shape, number: 0, on_supports: false, is_never_empty: true }];
    let carried =
        |grip, heights, supports| Attachment { name: "part".into(), heights, grip, parts: parts.clone(), supports };
    let level = |angle| Grip::Level { angle, point: Point::zeros() };
    let cases = [
        (carried(level(NAN), Heights::ALL, vec![]), vec![], SceneError::Grip { object: "part".into() }),
        (carried(level(0.0), Heights::ALL, vec![1]), vec![], SceneError::NoObstacle { number: 1, count: 1 }),
        (carried(level(0.0), Heights::ALL, vec![]), vec![7], SceneError::NoObstacle { number: 7, count: 1 }),
        (
            carried(level(0.0), Heights { lower: 1.0, upper: 0.5 }, vec![]),
            vec![],
            SceneError::Heights { of: "part".into(), lower: 1.0, upper: 0.5 },
        ),
    ];
    for (carried, allowed_contacts, error) in cases {
        let made = Scene::with(
            arm(|_| ()),
            workspace(|_| ()),
            Additions { attachment: Some(carried), allowed_contacts, ..Additions::default() },
        );
        assert_eq!(made, Err(error));
    }
}

#[test]
fn problems_without_a_true_answer_are_refused() {
    let scene = || placed(arm(|_| ()), workspace(|_| ()));
    let (free, blocked) = (q(-1.0, 0.5), q(PI / 4.0, 0.3));
    let elbow = |value| ("joint \"elbow\"".to_owned(), value);
    let refused = |start, goals: GoalSet| MotionProblem::new(scene(), start, goals).expect_err("it is refused");
    let (limit, value) = elbow(2.5);
    assert_eq!(refused(q(0.0, 2.5), free.into()), MotionProblemError::StartOutside { limit, value });
    assert!(matches!(refused(q(NAN, 0.0), free.into()), MotionProblemError::StartOutside { .. }));
    assert!(matches!(refused(q(INFINITE, 0.0), free.into()), MotionProblemError::StartOutside { .. }));
    let hit = refused(blocked, free.into()).to_string();
    assert!(hit.starts_with("the start is not free: link \"fore\" hits obstacle \"post\""), "{hit}");
    assert_eq!(refused(free, GoalSet::default()), MotionProblemError::NoGoal);
    let (limit, value) = elbow(-2.1);
    let two: GoalSet = [Segment::point(free), Segment::new(free, q(0.0, -2.1))].into_iter().collect();
    assert_eq!(refused(free, two), MotionProblemError::GoalOutside { goal: 1, limit, value });
    let hit = refused(free, blocked.into()).to_string();
    assert!(hit.starts_with("goal 1 is not free: link \"fore\" hits obstacle \"post\""), "{hit}");
    // Part of a segment of goals may be blocked.
    let through = GoalSet::from(Segment::new(free, q(PI / 4.0, 0.3)));
    let problem = MotionProblem::new(scene(), free, through).expect("some of it is free");
    assert!(matches!(solve(&problem, &Method::Visibility.into(), &mut |_| {}).outcome, Outcome::Found(_)));
    // A configuration nearer than the clearance is not free either.
    let near = scene().with_clearance(0.7).expect("a clearance");
    let touched = MotionProblem::new(near, q(0.0, 0.5), free).expect_err("it is too near").to_string();
    assert!(touched.contains("nearer than the clearance of 700 mm"), "{touched}");
}

/// Checks corners that are in convex position by construction: on an ellipse, in the order of their angles. Also checks
/// integer corners, whose convexity an exact determinant decides.
#[test]
fn valid_input_is_accepted() {
    let (mut refused, mut taken) = (0, 0);
    for seed in seeds(300) {
        let mut dice = Dice::new(seed ^ 0x5EED);
        let count = 3 + dice.below(20);
        let [a, b] = [0, 1].map(|_| dice.within(0.05, 2.0));
        let shift = Vector::new(dice.within(-3.0, 3.0), dice.within(-3.0, 3.0));
        let share = |k: u64, dice: &mut Dice| (k as f64 + dice.within(0.1, 0.9)) / count as f64;
        let angles: Vec<f64> = (0..count).map(|k| 2.0 * PI * share(k, &mut dice)).collect();
        let core: Vec<Point> = angles.iter().map(|t| Point::new(a * t.cos(), b * t.sin()) + shift).collect();
        let radius = if dice.below(2) == 0 { 0.0 } else { dice.within(0.0, 0.5) };
        let shape = Convex::new(core.clone(), radius).unwrap_or_else(|error| panic!("seed {seed}: {error} {core:?}"));
        assert_eq!((shape.core(), shape.radius()), (&core[..], radius));
        let backwards: Vec<Point> = core.iter().rev().copied().collect();
        assert!(matches!(Convex::new(backwards.clone(), radius), Err(ConvexError::NotConvex { .. })), "seed {seed}");
        let [one, other] =
            [backwards, core].map(|corners| SimplePolygon::new(corners).expect("either direction").area());
        assert!((one - other).abs() < 1e-12, "seed {seed}: {one} {other}");

        let corners: Vec<(i64, i64)> =
            (0..3 + dice.below(3)).map(|_| [0, 1].map(|_| dice.below(7) as i64 - 3).into()).collect();
        let made = Convex::new(corners.iter().map(|&(x, y)| Point::new(x as f64, y as f64)).collect(), 0.0);
        assert_eq!(made.is_ok(), is_convex(&corners), "seed {seed}: {corners:?}, {made:?}");
        *if made.is_ok() { &mut taken } else { &mut refused } += 1;
    }
    assert!(taken > 10 && refused > 10, "{taken} {refused}");
}

/// Decides by brute force whether corners form a convex polygon. Every corner must be to the left of every side, or on
/// it between its ends, and no two corners may be equal. Corners must be in the order of the angle about their mean,
/// once round.
fn is_convex(corners: &[(i64, i64)]) -> bool {
    let n = corners.len() as i64;
    let (x, y) = corners.iter().fold((0, 0), |(x, y), c| (x + c.0, y + c.1));
    // The corners are relative to the mean, times the number of corners.
    let about: Vec<(i64, i64)> = corners.iter().map(|c| (n * c.0 - x, n * c.1 - y)).collect();
    let cross = |a: (i64, i64), b: (i64, i64)| a.0 * b.1 - a.1 * b.0;
    let less = |a: (i64, i64), b: (i64, i64)| (a.0 - b.0, a.1 - b.1);
    let next = |i: usize| (i + 1) % about.len();
    let distinct = (0..about.len()).all(|i| (0..i).all(|k| about[i] != about[k]));
    let left =
        (0..about.len()).all(|i| about.iter().all(|&c| cross(less(about[next(i)], about[i]), less(c, about[i])) >= 0));
    let has_area =
        (0..about.len()).any(|i| cross(less(about[next(i)], about[i]), less(about[next(next(i))], about[i])) > 0);
    // As seen from the mean, which is inside, each side turns left, and together they turn once.
    let turns = (0..about.len()).all(|i| cross(about[i], about[next(i)]) > 0);
    let total: f64 = (0..about.len())
        .map(|i| {
            let (a, b) = (about[i], about[next(i)]);
            (cross(a, b) as f64).atan2((a.0 * b.0 + a.1 * b.1) as f64)
        })
        .sum();
    distinct && left && has_area && turns && (total - 2.0 * PI).abs() < 1e-6
}

/// Checks that the library accepts scenes and problems of random worlds, and that taking them apart and building them
/// again changes nothing.
#[test]
fn random_problems_are_accepted() {
    let mut made = 0;
    for seed in seeds(300) {
        let kind = world::KINDS[seed as usize % world::KINDS.len()];
        // `asked` and `placed` panic if the library refuses.
        let Some(problem) = world::world(kind, seed) else { continue };
        made += 1;
        let (arm, workspace) = problem.scene().clone().into_parts();
        assert_eq!(&placed(arm, workspace), problem.scene());
        let again = motion_problem(problem.scene().clone(), problem.start(), problem.goals().clone());
        assert_eq!(again, problem);
    }
    assert!(!uses_default_cases() || made > 250, "{made}");
}

/// Checks corners that differ from a straight line by the last bit. They are judged exactly.
#[test]
fn rounding_decides_at_the_limit() {
    let tip = 1.0 / 3.0;
    for (y, convex) in [(tip - f64::EPSILON, true), (tip + f64::EPSILON, false)] {
        let corners = points(&[(0., 0.), (1., y), (3., 1.), (0., 3.)]);
        assert_eq!(orientation(corners[0], corners[1], corners[2]) == Orientation::CounterClockwise, convex);
        assert_eq!(Convex::new(corners, 0.0).is_ok(), convex, "{y}");
    }
    let thin = wall(Point::zeros(), Point::new(5e-324, 0.0));
    assert_eq!(thin.core().len(), 2);
    assert_eq!(link("thin", vec![thin]).parts.len(), 1);
}
