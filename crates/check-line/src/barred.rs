//! Checks of certificates with the answer "infeasible": no motion follows the line.

use crate::cells::{Cell, MAX_LEVEL, groups};
use crate::chords::{Chord, of_stretch};
use crate::measure::Measure;
use crate::reach::is_out_of_reach;
use crate::text::{Line, index, parameter};
use crate::tip;
use cplan_check::arm::Arm;
use cplan_check::certificate::{Certificate, rectangles};
use cplan_check::contacts::Contacts;
use cplan_check::decimal::Decimal;
use cplan_check::domain::{Rectangle, within};
use cplan_check::elbow::Elbow;
use cplan_check::interval::{Interval, Point, length, minus, rough};
use cplan_check::mover::{self, MovingBody};
use cplan_check::world::World;
use cplan_check::{CheckError, Input};
use num_bigint::BigInt;

/// Level up to which all cells are quartered. At this level, cells are about a hundredth of the domain.
const COARSE_LEVEL: u32 = 7;

/// Number of rounds after which the level rises by one.
const ROUNDS_PER_LEVEL: u32 = 6;

/// Maximum number of cells.
const MAX_CELLS: usize = 6000;

/// Checks that no motion follows the line past a stretch.
pub fn no_motion(arm: &Arm, world: &World, certificate: &Certificate, line: &Line) -> Result<String, CheckError> {
    let clearance = certificate.clearance(world)?;
    let Some([from, to]) = &line.stretch else {
        return Err(CheckError::in_file(Input::Certificate, "\"line\": \"infeasible\" needs a \"stretch\""));
    };
    if *from < Decimal::whole(0) || from > to || *to > Decimal::whole(line.pieces.len() as i32) {
        return CheckError::fails("the stretch is not a part of the line");
    }
    let ends = [from, to].map(|position| place(line, position));
    let [first, second] = arm.joints.each_ref().map(|joint| &joint.name);
    let (tip, tolerance) = (&arm.tip_link, &line.tolerance);
    let [[a, b], [c, d]] = ends.each_ref().map(rough);
    let none = format!("no motion of \"{first}\" and \"{second}\" leads the tip \"{tip}\" along {line}");
    if ends.iter().any(|end| is_out_of_reach(arm, end, &Interval::from(tolerance))) {
        return Ok(format!(
            "{none}: the tip cannot come within {tolerance} of ({a:.6}, {b:.6}), even without limits of the joints"
        ));
    }
    line.elbow.map_or(Ok(()), |elbow| elbow.of_arm(arm))?;
    let stuck = certificate.boxes.as_deref().unwrap_or_default();
    let boxes = rectangles(stuck)?;
    let (chords, measure) = (of_stretch(line, &[from.clone(), to.clone()])?, Measure::new(arm));
    let near = Interval::from(tolerance).upper;
    let measures = chords.iter().map(|chord| chord.measures(&measure, &near)).collect();
    let search = Search { arm, boxes: &boxes, chords, measure, measures, ends, tolerance, elbow: line.elbow };
    search.check_separated()?;
    Contacts::new(arm, world, certificate, clearance)?.check_boxes(arm, stuck, &boxes)?;
    Ok(format!(
        "{none}: from ({a:.6}, {b:.6}) to ({c:.6}, {d:.6}), no motion with clearance {clearance} keeps the tip within {tolerance} of the line"
    ))
}

fn place(line: &Line, position: &Decimal) -> Point {
    let piece = index(position, line.pieces.len());
    line.pieces[piece].at(&Interval::exact(parameter(position, piece)))
}

/// The search for configurations that could connect both ends of the stretch.
struct Search<'a> {
    arm: &'a Arm,
    boxes: &'a [Rectangle],
    chords: Vec<Chord>,
    measure: Measure<'a>,
    /// For each chord, the measures of the points within the tolerance of its part of the line.
    measures: Vec<Interval>,
    /// The places where the stretch begins and ends.
    ends: [Point; 2],
    tolerance: &'a Decimal,
    /// The required side of the elbow.
    elbow: Option<Elbow>,
}

/// A cell in which the tip may be near the stretch.
struct Candidate {
    cell: Cell,
    /// For each end of the stretch, true if the tip may be near it.
    ends: [bool; 2],
    /// True if the cell touches a collision box.
    is_beside_box: bool,
    /// True if the middle of the cell is in no box, and the tip is then near both ends.
    is_passage: bool,
}

impl Search<'_> {
    /// Checks that free configurations near the stretch do not connect its ends.
    fn check_separated(&self) -> Result<(), CheckError> {
        let mut cells = vec![Cell::whole()];
        for round in 0.. {
            let joined = self.joined(cells);
            if joined.is_empty() {
                return Ok(());
            }
            let coarse = COARSE_LEVEL + round / ROUNDS_PER_LEVEL;
            let is_cut = |c: &Candidate| c.cell.level < coarse || c.is_beside_box || c.ends != [false; 2];
            if joined.len() > MAX_CELLS || joined.iter().any(|c| c.is_passage || c.cell.level >= MAX_LEVEL) {
                break;
            }
            let smaller = |c: Candidate| if is_cut(&c) { c.cell.quarters().to_vec() } else { vec![c.cell] };
            cells = joined.into_iter().flat_map(smaller).collect();
        }
        CheckError::fails("the boxes and the limits do not prove that the tip cannot follow the stretch of the line")
    }

    /// Returns the cells that may lead from one end of the stretch to the other.
    fn joined(&self, cells: Vec<Cell>) -> Vec<Candidate> {
        let tip = MovingBody::new(self.arm, &self.arm.tip);
        let all: Vec<Candidate> = cells.into_iter().filter_map(|cell| self.candidate(&tip, cell)).collect();
        let touches = |a: &Candidate, b: &Candidate| a.cell.touches(&b.cell, &self.arm.domain);
        let connects = |group: &Vec<Candidate>| (0..2).all(|end| group.iter().any(|c| c.ends[end]));
        groups(all, touches).into_iter().filter(connects).flatten().collect()
    }

    /// Relates a cell to the stretch. Returns `None` if a box contains the cell, if the elbow is on the wrong side in
    /// the whole cell, or if the tip stays away from the stretch there.
    fn candidate(&self, tip: &MovingBody, cell: Cell) -> Option<Candidate> {
        let ranges = cell.rectangle(&self.arm.domain);
        let is_excluded = self.elbow.is_some_and(|elbow| elbow.excludes(self.arm, &ranges[1]));
        if is_excluded || self.boxes.iter().any(|other| within(&ranges, other)) {
            return None;
        }
        let middle = ranges.each_ref().map(|[low, high]| Decimal::middle(low, high));
        let at = tip::at(self.arm, &middle.each_ref().map(Interval::from));
        let tolerance = Interval::from(self.tolerance);
        let near: BigInt = &tolerance.upper + tip.farthest(&mover::Cell::from(&ranges));
        let measure = self.measure.of_tip(&Interval::enclosing(&ranges[1]));
        let is_near = |(chord, own): (&Chord, &Interval)| {
            own.lower <= measure.upper && measure.lower <= own.upper && !chord.is_farther(&at, &near)
        };
        if !self.chords.iter().zip(&self.measures).any(is_near) {
            return None;
        }
        let distances = self.ends.each_ref().map(|end| length(&minus(&at, end)));
        let ends = distances.each_ref().map(|distance| distance.lower <= near);
        let meets = |other: &Rectangle| (0..2).all(|k| ranges[k][0] <= other[k][1] && other[k][0] <= ranges[k][1]);
        let beside: Vec<&Rectangle> = self.boxes.iter().filter(|other| meets(other)).collect();
        let point = middle.map(|value| [value.clone(), value]);
        let is_passage = distances.iter().all(|distance| distance.upper <= tolerance.lower)
            && !beside.iter().any(|other| within(&point, other));
        Some(Candidate { cell, ends, is_beside_box: !beside.is_empty(), is_passage })
    }
}
