//! The suite: problems of arms with two joints, drawn from a published seed (docs/suite.md), with answers that the
//! checker can confirm. A problem is stored as numbers of three decimals, from which all its files are written.

mod worlds;

pub use worlds::WORLDS;

use crate::problems::problem_of_texts;
use crate::world::KINDS;
use cplan::input::Overrides;
use cplan::model::Status;
use cplan::{Options, Plan, plan};
use cplan_cases::dice::Dice;
use serde_json::{Value, json};
use std::fmt::Write;

/// A point or a pair of joint values.
pub type V = [f64; 2];

/// Seed of the suite.
pub const SEED: u64 = 20_261_130;

/// Numbers of problems for each kind of arm and of world: with a path, and without one.
pub const QUOTAS: [usize; 2] = [38, 12];

/// Least ratio of a shortest path and the distance of its ends in joint space. Smaller ones hardly need a planner.
const LEAST_DETOUR: f64 = 1.02;

/// Greatest difference of the path and the bound in its certificate, relative to the path.
const GREATEST_GAP: f64 = 1e-3;

/// Number of draws until a configuration is free.
const TRIES: usize = 200;

/// Least distance of the start and the goal from obstacles, metres.
const ROOM: f64 = 0.002;

/// A joint: it turns, or slides in a direction.
#[derive(Debug, Clone, Copy)]
struct SuiteJoint {
    /// Position in the frame of the link before it.
    origin: V,
    /// Direction of a slide in the same frame.
    direction: Option<V>,
    limits: V,
}

/// A problem of the suite.
#[derive(Debug, Clone)]
pub struct SuiteProblem {
    /// Kind of the arm, such as "RP".
    pub kind: &'static str,
    /// Kind of the world, see [`WORLDS`].
    pub world: &'static str,
    /// Number of the draw.
    pub number: u64,
    joints: [SuiteJoint; 2],
    /// Rectangles of each link in its own frame: lower left and upper right corner.
    links: [Vec<[V; 2]>; 2],
    obstacles: Vec<Vec<V>>,
    start: V,
    goal: V,
}

/// A problem with its answer.
pub struct Answered {
    /// The problem.
    pub problem: SuiteProblem,
    /// Plan of the default planner.
    pub plan: Plan,
    /// Certificate of the answer.
    pub certificate: String,
    /// Lower bound on the length in the certificate, if there is a path.
    bound: Option<f64>,
}

/// Reasons for which a draw does not enter the suite.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rejection {
    /// Too few free configurations, a free straight motion, or a path that is hardly longer.
    Easy,
    /// The planner's answer is unknown.
    Unknown,
    /// The certificate has no bound near the length of the path.
    WeakBound,
    /// The suite has enough problems with this answer.
    Full,
}

/// Rounds to three decimals.
fn rounded(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}

/// Returns all pairs of a kind of arm and a kind of world.
pub fn classes() -> impl Iterator<Item = (&'static str, &'static str)> {
    KINDS.into_iter().flat_map(|kind| WORLDS.map(|world| (kind, world)))
}

/// Returns the draws of a class in their order, until both quotas are full: with a path, and without one.
pub fn draws(
    kind: &'static str,
    world: &'static str,
    mut quotas: [usize; 2],
) -> impl Iterator<Item = Result<Answered, Rejection>> {
    (0..).map_while(move |number| {
        if quotas == [0, 0] {
            return None;
        }
        let answered = SuiteProblem::draw(kind, world, number).ok_or(Rejection::Easy).and_then(SuiteProblem::answer);
        Some(answered.and_then(|answered| {
            let quota = &mut quotas[usize::from(answered.bound.is_none())];
            *quota = quota.checked_sub(1).ok_or(Rejection::Full)?;
            Ok(answered)
        }))
    })
}

/// Returns the problems of a class among its draws.
pub fn select(kind: &'static str, world: &'static str, quotas: [usize; 2]) -> impl Iterator<Item = Answered> {
    draws(kind, world, quotas).flatten()
}

/// Draws the joints and the links of an arm, and the rectangle in which obstacles are drawn.
fn arm(dice: &mut Dice, kind: &str) -> ([SuiteJoint; 2], [Vec<[V; 2]>; 2], [V; 2]) {
    let mut length = |low, high| rounded(dice.within(low, high));
    let (inner, outer, width) = (length(0.6, 1.0), length(0.5, 0.9), length(0.02, 0.06));
    let turn = |origin: V| SuiteJoint { origin, direction: None, limits: [-2.9, 2.9] };
    let slide = |direction, limits| SuiteJoint { origin: [0.0; 2], direction: Some(direction), limits };
    let bar = |from: f64, to: f64| [[from, -width], [to, width]];
    let mut tool = vec![bar(0.0, outer)];
    if dice.chance(0.4) {
        tool.push([[rounded(outer - 0.05), -0.15], [outer, 0.15]]);
    }
    match kind {
        "RR" => {
            let reach = inner + outer;
            ([turn([0.0; 2]), turn([inner, 0.0])], [vec![bar(0.0, inner)], tool], [[-reach; 2], [reach; 2]])
        }
        "RP" => {
            let reach = outer + 0.8;
            let joints = [turn([0.0; 2]), slide([1.0, 0.0], [0.0, 0.8])];
            (joints, [vec![bar(-0.1, inner)], tool], [[-reach; 2], [reach; 2]])
        }
        "PR" => {
            let joints = [slide([1.0, 0.0], [-1.0, 1.0]), turn([0.0; 2])];
            (joints, [vec![[[-0.1, -0.1], [0.1, 0.1]]], tool], [[-1.0 - outer, -outer], [1.0 + outer, outer]])
        }
        _ => {
            let joints = [slide([1.0, 0.0], [0.0, 2.0]), slide([0.0, 1.0], [0.0, 2.0])];
            let head = vec![[[-0.1, -width], [0.1, width]], [[-width, -0.1], [width, rounded(outer / 4.0)]]];
            (joints, [Vec::new(), head], [[-0.1; 2], [2.1; 2]])
        }
    }
}

impl SuiteProblem {
    /// Draws a problem. Returns `None` if the arm is nowhere free, or the straight motion is free.
    pub fn draw(kind: &'static str, world: &'static str, number: u64) -> Option<Self> {
        let class = classes().position(|class| class == (kind, world)).expect("a class") as u64;
        let mut dice = Dice::new(SEED ^ (class << 32) ^ number.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        let (joints, links, area) = arm(&mut dice, kind);
        let obstacles = worlds::obstacles(&mut dice, world, area);
        let mut problem = Self { kind, world, number, joints, links, obstacles, start: [0.0; 2], goal: [0.0; 2] };
        let scene = crate::problems::scene_of_texts(&problem.urdf(), &problem.toml(false)).ok()?.scene;
        let mut free = || {
            (0..TRIES).find_map(|_| {
                let q = joints.map(|joint| rounded(dice.within(joint.limits[0], joint.limits[1])));
                (scene.clearance(q.into()) > ROOM).then_some(q)
            })
        };
        (problem.start, problem.goal) = (free()?, free()?);
        let is_free = |step: i32| {
            let part = f64::from(step) / 100.0;
            let at = |k: usize| problem.start[k] + (problem.goal[k] - problem.start[k]) * part;
            scene.clearance([at(0), at(1)].into()) > 0.0
        };
        (!(0..=100).all(is_free)).then_some(problem)
    }

    /// Returns the name of the problem and of its files.
    pub fn id(&self) -> String {
        format!("{}_{}_{:04}", self.kind, self.world, self.number)
    }

    /// Returns the robot as URDF. The links are at heights of their own, so that they cannot touch each other.
    pub fn urdf(&self) -> String {
        let mut text = "<robot name=\"suite\">\n<link name=\"link_0\"/>\n".to_owned();
        for (k, joint) in self.joints.iter().enumerate() {
            let kind = if joint.direction.is_some() { "prismatic" } else { "revolute" };
            let axis = joint.direction.map_or("0 0 1".to_owned(), |[x, y]| format!("{x} {y} 0"));
            let ([x, y], [lower, upper]) = (joint.origin, joint.limits);
            let _ = write!(
                text,
                "<joint name=\"joint_{0}\" type=\"{kind}\"><parent link=\"link_{k}\"/><child link=\"link_{0}\"/>\
                 <origin xyz=\"{x} {y} 0\"/><axis xyz=\"{axis}\"/><limit lower=\"{lower}\" upper=\"{upper}\" \
                 velocity=\"1\" effort=\"1\"/></joint>\n<link name=\"link_{0}\">",
                k + 1
            );
            for [low, high] in &self.links[k] {
                let [x, y] = [0, 1].map(|i| (low[i] + high[i]) / 2.0);
                let [length, width] = [0, 1].map(|i| high[i] - low[i]);
                let z = 0.05 + 0.2 * k as f64;
                let _ = write!(
                    text,
                    "<collision><origin xyz=\"{x:.4} {y:.4} {z}\"/><geometry><box size=\"{length:.3} {width:.3} 0.1\"/>\
                     </geometry></collision>"
                );
            }
            text += "</link>\n";
        }
        text + "</robot>\n"
    }

    /// Returns the world file, with the start and the goal if `has_ends`.
    pub fn toml(&self, has_ends: bool) -> String {
        let mut text = format!("name = \"{}\"\n", self.id());
        if has_ends {
            let _ = write!(text, "\n[start]\njoints = {:?}\n\n[goal]\njoints = {:?}\n", self.start, self.goal);
        }
        for corners in &self.obstacles {
            let _ = write!(text, "\n[[obstacle]]\npolygon = {corners:?}\n");
        }
        text
    }

    /// Plans, and makes the certificate.
    ///
    /// # Errors
    /// If the problem is too easy, or its answer or its optimum is not proven.
    ///
    /// # Panics
    /// If a file of the problem is invalid.
    pub fn answer(self) -> Result<Answered, Rejection> {
        let problem = problem_of_texts(&self.urdf(), &self.toml(true)).expect("a valid problem");
        let plan = plan(&problem, &Options::default()).expect("a plan");
        if plan.status() == Status::Unknown {
            return Err(Rejection::Unknown);
        }
        let certificate = plan.certificate(&Overrides::default(), None).expect("a certificate");
        let mut bound = None;
        if let Some(length) = plan.length() {
            let read: Value = serde_json::from_str(&certificate).expect("a certificate is JSON");
            let straight = (self.goal[0] - self.start[0]).hypot(self.goal[1] - self.start[1]);
            if length <= LEAST_DETOUR * straight {
                return Err(Rejection::Easy);
            }
            let proven = read["bound"]["length"].as_f64();
            bound = Some(proven.filter(|proven| *proven >= length * (1.0 - GREATEST_GAP)).ok_or(Rejection::WeakBound)?);
        }
        Ok(Answered { problem: self, plan, certificate, bound })
    }
}

impl Answered {
    /// Returns the problem and its answer as one line of `suite.jsonl`.
    pub fn json(&self) -> Value {
        let problem = &self.problem;
        let joint = |joint: &SuiteJoint| {
            let kind = if joint.direction.is_some() { "prismatic" } else { "revolute" };
            json!({"type": kind, "origin": joint.origin, "direction": joint.direction, "limits": joint.limits})
        };
        let polygon = |[low, high]: &[V; 2]| json!([low, [high[0], low[1]], high, [low[0], high[1]]]);
        let link = |rectangles: &Vec<[V; 2]>| rectangles.iter().map(polygon).collect::<Value>();
        let path = self
            .plan
            .motion()
            .and_then(|(_, answer)| answer.path())
            .map(|path| path.waypoints().iter().map(|q| json!([q[0], q[1]])).collect::<Value>());
        json!({
            "id": problem.id(),
            "arm": {"kind": problem.kind, "joints": problem.joints.each_ref().map(joint), "links": problem.links.each_ref().map(link)},
            "world": problem.world,
            "obstacles": problem.obstacles,
            "start": problem.start,
            "goal": problem.goal,
            "answer": if self.bound.is_some() { "found" } else { "infeasible" },
            "length": self.plan.length(),
            "bound": self.bound,
            "path": path,
        })
    }
}
