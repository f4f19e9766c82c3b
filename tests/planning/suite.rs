//! Problems of the suite, judged by a reader that knows nothing except their JSON.

use cplan_check_files::check;
use cplan_testkit::root;
use cplan_testkit::suite::{Answered, V, select};
use serde_json::Value;

/// Classes of five problems with a path, and of five without one.
const FOUND: [(&str, &str); 5] =
    [("RR", "boxes"), ("RP", "polygons"), ("PR", "walls"), ("PP", "slots"), ("RR", "rings")];
const INFEASIBLE: [(&str, &str); 5] =
    [("PP", "rings"), ("PR", "slots"), ("RP", "walls"), ("RR", "slots"), ("PP", "boxes")];

/// Number of lattice points along each joint.
const LATTICE: usize = 160;

/// Number of configurations that are tested between two lattice points.
const BETWEEN: usize = 12;

/// A position and an angle.
type Frame = (V, f64);

fn pair(value: &Value) -> V {
    [0, 1].map(|k| value[k].as_f64().expect("a number"))
}

fn polygon(value: &Value) -> Vec<V> {
    value.as_array().expect("corners").iter().map(pair).collect()
}

fn moved(([x, y], angle): Frame, [u, v]: V) -> V {
    [x + u * angle.cos() - v * angle.sin(), y + u * angle.sin() + v * angle.cos()]
}

/// Returns true if a side of the first polygon separates the two convex polygons.
fn side_separates(a: &[V], b: &[V]) -> bool {
    (0..a.len()).any(|k| {
        let (p, q) = (a[k], a[(k + 1) % a.len()]);
        b.iter().all(|r| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]) < 0.0)
    })
}

/// Reads a problem from its JSON.
struct Reader<'a>(&'a Value);

impl Reader<'_> {
    fn is_free(&self, q: V) -> bool {
        let mut frame: Frame = ([0.0; 2], 0.0);
        for (k, value) in q.into_iter().enumerate() {
            let joint = &self.0["arm"]["joints"][k];
            frame.0 = moved(frame, pair(&joint["origin"]));
            match joint["type"].as_str() {
                Some("revolute") => frame.1 += value,
                _ => frame.0 = moved(frame, pair(&joint["direction"]).map(|d| d * value)),
            }
            let shapes = self.0["arm"]["links"][k].as_array().expect("polygons");
            let placed = |shape: &Value| polygon(shape).into_iter().map(|p| moved(frame, p)).collect::<Vec<_>>();
            let obstacles = self.0["obstacles"].as_array().expect("polygons");
            let touches = |shape: &Vec<V>, obstacle: &Value| {
                let obstacle = polygon(obstacle);
                !side_separates(shape, &obstacle) && !side_separates(&obstacle, shape)
            };
            if shapes.iter().map(placed).any(|shape| obstacles.iter().any(|obstacle| touches(&shape, obstacle))) {
                return false;
            }
        }
        true
    }

    fn limits(&self, k: usize) -> V {
        pair(&self.0["arm"]["joints"][k]["limits"])
    }

    fn is_free_between(&self, from: V, to: V, count: usize) -> bool {
        let at = |t: f64| [0, 1].map(|k| from[k] + t * (to[k] - from[k]));
        (0..=count).all(|k| self.is_free(at(k as f64 / count as f64)))
    }

    /// Returns true if a flood over a lattice of configurations leads from the start to the goal.
    fn is_connected(&self) -> bool {
        let at = |[i, j]: [usize; 2]| {
            [(0, i), (1, j)].map(|(k, i)| {
                let [low, high] = self.limits(k);
                low + (high - low) * i as f64 / (LATTICE - 1) as f64
            })
        };
        let near = |q: V| {
            [0, 1].map(|k| {
                let [low, high] = self.limits(k);
                ((q[k] - low) / (high - low) * (LATTICE - 1) as f64).floor() as usize
            })
        };
        let [start, goal] = ["start", "goal"].map(|key| pair(&self.0[key]));
        let around = |q: V| {
            let [i, j] = near(q);
            let corners = [[i, j], [i + 1, j], [i, j + 1], [i + 1, j + 1]];
            corners.into_iter().filter(move |corner| self.is_free_between(q, at(*corner), BETWEEN))
        };
        let mut reached = vec![false; LATTICE * LATTICE];
        let mut stack: Vec<[usize; 2]> = around(start).collect();
        while let Some([i, j]) = stack.pop() {
            if std::mem::replace(&mut reached[i * LATTICE + j], true) {
                continue;
            }
            let neighbours = [[i.wrapping_sub(1), j], [i + 1, j], [i, j.wrapping_sub(1)], [i, j + 1]];
            for [k, l] in neighbours {
                let is_new = k < LATTICE && l < LATTICE && !reached[k * LATTICE + l];
                if is_new && self.is_free_between(at([i, j]), at([k, l]), BETWEEN) {
                    stack.push([k, l]);
                }
            }
        }
        around(goal).any(|[i, j]| reached[i * LATTICE + j])
    }

    /// Checks the path: its ends, its length, and configurations on it. Returns its length.
    fn check_path(&self) -> f64 {
        let path: Vec<V> = self.0["path"].as_array().expect("a path").iter().map(pair).collect();
        assert_eq!([path[0], path[path.len() - 1]], ["start", "goal"].map(|key| pair(&self.0[key])));
        let length = |a: V, b: V| (b[0] - a[0]).hypot(b[1] - a[1]);
        for w in path.windows(2) {
            assert!(self.is_free_between(w[0], w[1], (length(w[0], w[1]) / 1e-3).ceil() as usize), "{w:?}");
            assert!((0..2).all(|k| w[1][k] >= self.limits(k)[0] && w[1][k] <= self.limits(k)[1]), "{w:?}");
        }
        path.windows(2).map(|w| length(w[0], w[1])).sum()
    }
}

fn judge(answered: &Answered, is_found: bool) {
    let (problem, json) = (&answered.problem, answered.json());
    let id = problem.id();
    let schema = std::fs::read_to_string(root().join("docs/suite.schema.json")).unwrap();
    let schema: Value = serde_json::from_str(&schema).unwrap();
    jsonschema::validate(&schema, &json).unwrap_or_else(|error| panic!("{id}: {error}\n{json}"));
    let proven = check(&problem.urdf(), &problem.toml(true), &answered.certificate);
    let proven = proven.unwrap_or_else(|error| panic!("{id}: {error}"));
    let reader = Reader(&json);
    if is_found {
        let (length, bound) = (json["length"].as_f64().unwrap(), json["bound"].as_f64().unwrap());
        assert!((reader.check_path() - length).abs() < 1e-9, "{id}");
        assert!(bound <= length && bound > 0.999 * length, "{id}: {bound} and {length}");
        assert!(proven.contains(&format!("is shorter than {bound}")), "{id}: {proven}");
        assert!(reader.is_connected(), "{id}: the lattice is too coarse");
    } else {
        assert_eq!(json["answer"], "infeasible");
        assert!(!reader.is_connected(), "{id}: the flood finds a path");
    }
}

#[test]
fn another_reader_confirms_ten_problems_of_the_suite() {
    for ((kind, world), is_found) in FOUND.map(|class| (class, true)).into_iter().chain(INFEASIBLE.map(|c| (c, false)))
    {
        let quotas = if is_found { [1, 0] } else { [0, 1] };
        let problems: Vec<Answered> = select(kind, world, quotas).collect();
        assert_eq!(problems.len(), 1, "{kind} {world}");
        judge(&problems[0], is_found);
    }
}

#[test]
fn a_problem_of_the_suite_is_the_same_in_every_run() {
    let texts = || select("RR", "slots", [1, 1]).map(|answered| answered.json().to_string()).collect::<Vec<_>>();
    assert_eq!(texts(), texts());
}
