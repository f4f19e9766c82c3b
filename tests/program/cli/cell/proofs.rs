//! Proofs of infeasible cells: written, verified, and compared with the oracle.

use super::super::{Done, Place, number};
use super::oracle::{Arm, Point, clearance, distance};
use super::set::place_of;
use super::{answer, bars, read, shipped};
use cplan_cases::cells::cell_set;
use cplan_cases::dice::Dice;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::f64::consts::PI;
use std::sync::OnceLock;

/// Greatest size of the proof of the cell "no room", bytes.
const MAX_SIZE: usize = 100_000;

/// Random places per box.
const PLACES: usize = 3;

/// A proof of boxes in four joints, read without cplan.
struct Boxes<'a> {
    proof: &'a Value,
    cells: [usize; 4],
}

impl<'a> Boxes<'a> {
    fn read(proof: &'a Value) -> Self {
        Self { proof, cells: [0, 1, 2, 3].map(|axis| proof["cells"][axis].as_u64().unwrap() as usize) }
    }

    /// Returns the value of a joint at the side of a cell.
    fn side(&self, axis: usize, cell: usize) -> f64 {
        let [lower, upper] = [0, 1].map(|end| number(&self.proof["ranges"][axis][end]));
        lower + (upper - lower) * cell as f64 / self.cells[axis] as f64
    }

    fn rows(&self) -> Vec<[usize; 9]> {
        let row = |row: &Value| {
            let values: Vec<usize> = row.as_array().unwrap().iter().map(|k| k.as_u64().unwrap() as usize).collect();
            <[usize; 9]>::try_from(values).unwrap()
        };
        self.proof["boxes"].as_array().unwrap().iter().map(row).collect()
    }

    /// Returns the cells that contain a place of both arms.
    fn around(&self, [[a, b], [c, d]]: [[f64; 2]; 2]) -> Vec<[usize; 4]> {
        let at = [a, b, c, d];
        let mut around = vec![[0; 4]];
        for axis in 0..4 {
            let has = |k: &usize| self.side(axis, *k) <= at[axis] + 1e-12 && at[axis] <= self.side(axis, k + 1) + 1e-12;
            let along: Vec<usize> = (0..self.cells[axis]).filter(has).collect();
            let with = |cell: [usize; 4], k: usize| {
                let mut cell = cell;
                cell[axis] = k;
                cell
            };
            around = around.iter().flat_map(|cell| along.iter().map(|k| with(*cell, *k))).collect();
        }
        assert!(!around.is_empty());
        around
    }

    /// Returns true if the boxes separate the starts from the goals. No joint turns without end.
    fn separate(&self, starts: [[f64; 2]; 2], goals: [[f64; 2]; 2]) -> bool {
        let rows = self.rows();
        let is_closed = |cell: &[usize; 4]| {
            rows.iter().any(|row| (0..4).all(|k| row[2 * k + 1] <= cell[k] && cell[k] < row[2 * k + 2]))
        };
        let mut known = BTreeSet::new();
        let mut open = self.around(starts);
        while let Some(cell) = open.pop() {
            if is_closed(&cell) || !known.insert(cell) {
                continue;
            }
            for axis in 0..4 {
                for moved in [cell[axis].wrapping_sub(1), cell[axis] + 1] {
                    if moved < self.cells[axis] {
                        let mut next = cell;
                        next[axis] = moved;
                        open.push(next);
                    }
                }
            }
        }
        self.around(goals).iter().all(|goal| !known.contains(goal))
    }
}

/// Checks that the arms collide at random places of each box of a proof.
pub fn check_boxes(proof: &Value, arms: &[Arm; 2], obstacles: &[Vec<Point>], random: &mut Dice) {
    if proof["kind"] == "alone" {
        let arm = if proof["arm"] == "left" { &arms[0] } else { &arms[1] };
        for stated in proof["boxes"].as_array().unwrap() {
            let q = [0, 1].map(|k| random.within(number(&stated["lower"][k]), number(&stated["upper"][k])));
            assert!(clearance(arm, q, obstacles) < 1e-9, "{stated} {q:?}");
        }
        return;
    }
    assert_eq!(proof["kind"], "boxes");
    let boxes = Boxes::read(proof);
    for row in boxes.rows() {
        for _ in 0..PLACES {
            let [a, b, c, d] =
                [0, 1, 2, 3].map(|k| random.within(boxes.side(k, row[2 * k + 1]), boxes.side(k, row[2 * k + 2])));
            let q = [[a, b], [c, d]];
            let contact = &proof["contacts"][row[0]];
            let apart = match contact["obstacle"]["arm"].as_u64() {
                Some(arm) => clearance(&arms[arm as usize], q[arm as usize], obstacles),
                None => distance(arms, q),
            };
            assert!(apart < 1e-9, "{row:?} {contact} {q:?}: {apart}");
        }
    }
}

/// Verifies an answer about a cell.
pub fn verified(place: &Place, cell: &str, answer: &Value, options: &str) -> Done {
    place.write("cell.json", answer.to_string());
    place.run(&["verify", cell, "cell.json"], options)
}

/// Returns a place with a cell of the set, and the answer.
fn of_set(name: &str) -> (Place, Value) {
    let case = cell_set("robots").into_iter().find(|case| case.name == name).expect("a cell of the set");
    let place = place_of(&case);
    let done = place.run(&["cell", "cell.toml", "--json", "--quiet"], "").exits(3);
    (place, answer(&done))
}

#[track_caller]
fn accepts(place: &Place, answer: &Value, parts: &[&str]) {
    verified(place, "cell.toml", answer, "").exits(3).says(&["infeasible: proven"]).says(parts);
    let judged = verified(place, "cell.toml", answer, "--json").json();
    assert_eq!(judged["verdict"], "infeasible", "{judged}");
}

#[track_caller]
fn refuses(place: &Place, answer: &Value, parts: &[&str]) {
    verified(place, "cell.toml", answer, "--quiet").refused(1, &[&["cell.json", "hint: "], parts].concat());
}

/// Returns the cell "no room" as `cell.toml`, with its answer.
fn no_room() -> (Place, Value) {
    let text = read(shipped("workspaces/cells/no_room.toml")).replace("../../robots", &shipped("robots"));
    let place = Place::new().with("cell.toml", text);
    let planned = || {
        place.run(&["cell", "cell.toml", "--quiet", "--output", "answer.json"], "").exits(3);
        place.read("answer.json")
    };
    static ANSWER: OnceLock<String> = OnceLock::new();
    let answer = ANSWER.get_or_init(planned);
    assert!(answer.len() < MAX_SIZE, "{} bytes", answer.len());
    (place, serde_json::from_str(answer).unwrap())
}

const NO_ROOM: [[f64; 2]; 2] = [[-26.0 * PI / 180.0, 0.0]; 2];

#[test]
fn boxes_are_verified_and_collide() {
    let (place, answer) = no_room();
    accepts(&place, &answer, &["in the space of all four joints separate the starts from the goals"]);
    let arms = [bars([-1.2, 0.0], 0.0), bars([1.2, 0.0], PI)];
    check_boxes(&answer["proof"], &arms, &[], &mut cplan_cases::dice(7));
    assert!(Boxes::read(&answer["proof"]).separate(NO_ROOM, NO_ROOM.map(|[a, b]| [-a, b])));
}

#[test]
fn boxes_that_are_missing_or_changed_are_refused() {
    let (place, answer) = no_room();
    let boxes = Boxes::read(&answer["proof"]);
    let (rows, count) = (boxes.rows(), boxes.rows().len());
    let with = |row: [usize; 9], number: usize| {
        let mut changed = answer.clone();
        changed["proof"]["boxes"][number] = json!(row);
        changed
    };
    let mut holes = 0;
    for number in (0..count).step_by(count / 10) {
        let mut changed = answer.clone();
        changed["proof"]["boxes"].as_array_mut().unwrap().remove(number);
        match Boxes::read(&changed["proof"]).separate(NO_ROOM, NO_ROOM.map(|[a, b]| [-a, b])) {
            true => accepts(&place, &changed, &[]),
            false => {
                refuses(&place, &changed, &["the boxes do not separate the starts from all goals"]);
                holes += 1;
            }
        }
        // The cell at the other end of the first joint's range.
        let (mut row, all) = (rows[number], boxes.cells[0]);
        (row[1], row[2]) = (all - row[2], all - row[1]);
        let changed = with(row, number);
        if row != rows[number] && !Boxes::read(&changed["proof"]).separate(NO_ROOM, NO_ROOM.map(|[a, b]| [-a, b])) {
            refuses(&place, &changed, &["the proof does not hold"]);
            holes += 1;
        }
    }
    assert!(holes >= 10, "{holes}");
    // The cell of both starts is free.
    let mut changed = answer.clone();
    let start = boxes.around(NO_ROOM)[0];
    let row: Vec<usize> = [0].into_iter().chain(start.into_iter().flat_map(|k| [k, k + 1])).collect();
    changed["proof"]["boxes"].as_array_mut().unwrap().insert(0, json!(row));
    refuses(&place, &changed, &["box 0: the two shapes overlap by "]);
    let [a, b, c, d] = boxes.cells;
    refuses(&place, &with([0, 0, a, 0, b, 0, c, 0, d], 0), &["box 0: the two shapes overlap by "]);
    for row in [[0, 0, a + 1, 0, b, 0, c, 0, d], [0, 1, 1, 0, b, 0, c, 0, d], [99, 0, a, 0, b, 0, c, 0, d]] {
        refuses(&place, &with(row, 3), &["box 3 is empty, extends beyond the grid, or names a contact"]);
    }
}

#[test]
fn other_changes_of_a_proof_of_boxes_are_refused() {
    let (place, answer) = no_room();
    let with = |key: &str, value: Value| {
        let mut changed = answer.clone();
        *changed["proof"].pointer_mut(key).expect(key) = value;
        changed
    };
    let grid = &["the grid does not cover the ranges of all four joints"];
    refuses(&place, &with("/ranges/0/0", json!(-0.3)), grid);
    refuses(&place, &with("/cells/0", json!(0)), grid);
    refuses(&place, &with("/cells/0", json!(1_u64 << 60)), grid);
    refuses(
        &place,
        &with("/contacts/0", json!({ "arms": [{ "link": 0, "part": 0 }, { "link": 1, "part": 5 }] })),
        &["contact 0: "],
    );
    let post = json!({ "obstacle": { "arm": 1, "link": 0, "part": 0, "obstacle": 0, "piece": 0 } });
    refuses(&place, &with("/contacts/0", post), &["contact 0: one of the two shapes does not exist"]);
    refuses(&place, &with("/boxes", json!([])), &["do not separate"]);
    refuses(&place, &with("/kind", json!("guess")), &["has no proof: unknown variant `guess`"]);
    verified(&place, "cell.toml", &answer, "--skew 0.1").refused(2, &["--skew does not apply to the proof of a cell"]);
    let mut clearer = answer.clone();
    clearer["clearance"] = json!(0.02);
    refuses(&place, &clearer, &["the proof is for a clearance of 20 mm, but the cell requires 0", "--clearance 0.02"]);
}

#[test]
fn the_proof_of_another_cell_is_refused() {
    let (place, answer) = no_room();
    let text = place.read("cell.toml");
    for (from, to) in [
        ("at = [1.2, 0.0]", "at = [1.4, 0.0]"),
        ("elbow = [\"-8deg\", \"8deg\"]", "elbow = [\"-20deg\", \"8deg\"]"),
        ("goal = { joints = [\"26deg\", 0.0]", "goal = { joints = [\"-25deg\", 0.0]"),
    ] {
        assert!(text.contains(from), "{from}");
        place.write("cell.toml", text.replace(from, to));
        refuses(&place, &answer, &["the proof does not hold: "]);
    }
    // Narrower ranges leave even less room.
    place.write("cell.toml", text.replace("elbow = [\"-8deg\", \"8deg\"]", "elbow = [\"-7deg\", \"8deg\"]"));
    accepts(&place, &answer, &[]);
}

/// The left arm may turn around, but a post is behind it.
#[test]
fn an_arm_that_turns_without_end_is_enclosed() {
    let post = vec![[-2.2, -0.15], [-1.6, -0.15], [-1.6, 0.15], [-2.2, 0.15]];
    let text = read(shipped("workspaces/cells/no_room.toml"))
        .replacen("planar_2r.urdf", "planar_2r_continuous.urdf", 1)
        .replacen("shoulder = [\"-30deg\", \"30deg\"], ", "", 1)
        .replace("../../robots", &shipped("robots"));
    let place = Place::new().with("cell.toml", format!("{text}\n[[obstacle]]\nname = \"post\"\npolygon = {post:?}\n"));
    let done = place.run(&["cell", "cell.toml", "--json", "--quiet"], "").exits(3);
    let answer = answer(&done);
    accepts(&place, &answer, &["in the space of all four joints separate the starts from the goals"]);
    let arms = [bars([-1.2, 0.0], 0.0), bars([1.2, 0.0], PI)];
    let proof = &answer["proof"];
    check_boxes(proof, &arms, &[post], &mut cplan_cases::dice(8));
    // Without the post, the left arm turns around, across the seam of its range.
    let mut changed = answer.clone();
    let is_of_arms = |row: &Value| proof["contacts"][row[0].as_u64().unwrap() as usize]["arms"].is_array();
    changed["proof"]["boxes"].as_array_mut().unwrap().retain(is_of_arms);
    assert_ne!(changed, answer);
    refuses(&place, &changed, &["the boxes do not separate the starts from all goals"]);
}

#[test]
fn starts_are_verified() {
    let (place, answer) = of_set("007_crossing");
    accepts(&place, &answer, &["left and right collide at their starts"]);
    let mut changed = answer.clone();
    changed["proof"]["parts"][0] = json!({ "link": 7, "part": 0 });
    refuses(&place, &changed, &["the starts: one of the two shapes does not exist"]);
    let (other, _) = of_set("012_crossing");
    changed["proof"]["parts"] = json!([{ "link": 0, "part": 0 }, { "link": 0, "part": 0 }]);
    refuses(&other, &changed, &["the starts: the two shapes overlap by -"]);
}

#[test]
fn goals_are_verified() {
    let (place, answer) = of_set("079_same_goal");
    let count = answer["proof"]["pairs"].as_array().unwrap().len();
    assert!(count > 1, "{answer}");
    accepts(&place, &answer, &[&format!("the arms collide at all {count} pairs of goals")]);
    let mut changed = answer.clone();
    changed["proof"]["pairs"].as_array_mut().unwrap().remove(count - 1);
    refuses(&place, &changed, &["the proof has no contact for the goals ("]);
    changed = answer.clone();
    changed["proof"]["pairs"][0]["parts"] = json!([{ "link": 0, "part": 0 }, { "link": 0, "part": 0 }]);
    refuses(&place, &changed, &["the goals [", "the two shapes overlap by -"]);
    let (other, _) = of_set("080_same_goal");
    refuses(&other, &answer, &["the proof has no contact for the goals ("]);
}

#[test]
fn an_arm_alone_is_verified() {
    let (place, answer) = of_set("095_walled");
    accepts(&place, &answer, &["separate the start of left from every goal, even without the other arm"]);
    let mut changed = answer.clone();
    let boxes = changed["proof"]["boxes"].as_array_mut().unwrap();
    boxes.truncate(boxes.len() / 2);
    refuses(&place, &changed, &["left: the collision boxes do not separate the start from goal"]);
    changed = answer.clone();
    changed["proof"]["boxes"][0]["obstacle"] = json!(50);
    refuses(&place, &changed, &["left: collision box 0: one of the two shapes does not exist"]);
    changed["proof"]["arm"] = json!("middle");
    refuses(&place, &changed, &["the cell has no arm \"middle\""]);
    let (other, _) = of_set("096_walled");
    refuses(&other, &answer, &["the proof does not hold: left: "]);
}

#[test]
fn errors_of_the_links_prove_no_collision() {
    let text = read(shipped("workspaces/cells/no_room.toml"))
        .replace("../../robots", &shipped("robots"))
        .replace("joints = [\"-26deg\", 0.0]", "joints = [0.0, 0.0]")
        .replace("at = [1.2, 0.0]", "at = [2.403, 0.0]")
        .replace("{ limits", "{ calibration = { links = \"5 mm\" }, limits");
    // Straight arms end 3 mm apart, and each link may be longer than in the file. This may be so, or not.
    let place = Place::new().with("cell.toml", text.clone());
    let done = place.run(&["cell", "cell.toml", "--json", "--quiet"], "").exits(4);
    let reason = answer(&done)["reason"].to_string();
    assert!(reason.contains("not proven that the arms do not touch at their starts"), "{reason}");
    place.write("cell.toml", text.replace("2.403", "2.35"));
    let done = place.run(&["cell", "cell.toml", "--json", "--quiet"], "").exits(3);
    accepts(&place, &answer(&done), &["left and right collide at their starts"]);
}
