//! A match of our own, three robots against three, all guided by fields, in the league of the source (IEEE Very Small Size: 150
//! cm x 130 cm, goals 10 cm deep, 85 x 65 cells of 2 cm, robots of 7.5 cm).
//!
//! Positions are rows (along the field) and columns of cells. Robots roll without slip in the commanded direction, one after the
//! other in each frame. Each blue robot has its own oriented field with its own goal. The red robots share a locally oriented
//! field, whose goal is the ball.

use cplan::field::{
    Boundary, Cell, Difference, Direction, Disc, Factor, Influence, Moment, MovingField, Order, RelaxError, Relaxation,
    STEP_LENGTH, Scan, Solver,
};

/// Cells along the field, with the goals, and across it.
pub const CELLS: [usize; 2] = [85, 65];
/// Depth of a goal, in cells.
pub const DEPTH: f64 = 5.0;
/// Range of a goal's mouth across the field: 40 cm.
pub const MOUTH: [f64; 2] = [22.0, 42.0];
/// Number of cells per centimetre.
pub const PER_CM: f64 = 0.5;
/// Radius of a disc that contains a robot of 7.5 cm x 7.5 cm in every orientation: half a diagonal, in cells.
pub const BODY: f64 = 7.5 * std::f64::consts::FRAC_1_SQRT_2 * PER_CM;
/// Radius of a golf ball, in cells.
pub const BALL: f64 = 2.135 * PER_CM;
/// Number of frames per second.
pub const RATE: f64 = 60.0;
/// Number of steps along its curve that a robot takes per frame, which amounts to 0.96 m/s.
const STEPS: usize = 4;
/// Greatest distance that a robot moves in a frame, in cells.
pub const REACH: f64 = STEPS as f64 * STEP_LENGTH;
/// Distance at which a robot pushes the ball, and radius of the seeker's goal around it, in cells.
const CONTACT: f64 = BODY + BALL + 0.6;
const SOUGHT: f64 = CONTACT - 0.3;
/// Speed of a pushed ball in cells per frame (`PUSHED`), and the factors by which it decreases per frame and at each
/// bounce.
const PUSHED: f64 = 1.6;
const ROLLS: f64 = 0.985;
const BOUNCES: f64 = 0.6;
/// Strength of drifts per cell.
const EPSILON: f64 = 0.5;
/// Radius of the influence of a local drift, in cells: 20 cm.
pub const INFLUENCE: f64 = 10.0;
/// A robot becomes the seeker if it is nearer to the ball than the current one by this, in cells.
const TAKES_OVER: f64 = 6.0;
/// Distance from the ball that red robots keep unless they seek it, in cells.
const KEEPS_OFF: f64 = 14.0;
/// Tolerance of the match's fields, which SOR solves with the source's factor. With this sum of squared changes, directions are
/// correct.
const BELOW: f64 = 1e-12;
const FACTOR: f64 = 1.7;
/// Largest number of sweeps for a field of the match.
pub const MOST: usize = 2000;
/// A ball that stays within a distance (second value, in cells) for a number of frames (first value) is moved to a mark of the
/// field.
const STALE: (usize, f64) = (120, 12.0);
/// The four marks of the field, as in the league: 37.5 cm from the middle and 40 cm from the middle line.
const MARKS: [[f64; 2]; 4] = [[23.25, 12.0], [23.25, 52.0], [60.75, 12.0], [60.75, 52.0]];

/// The state at the beginning of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Positions of three blue robots, then of three red ones.
    pub robots: [[f64; 2]; 6],
    /// Position of the ball.
    pub ball: [f64; 2],
    /// For each team, the index of the robot that seeks the ball.
    pub seekers: [usize; 2],
    /// The input of the field of each blue robot, and of the field that the red ones share.
    pub moments: [Moment; 4],
}

/// A match.
pub struct Match {
    state: State,
    fields: Vec<MovingField>,
    noise: u64,
    /// Goals of the blue team and of the red team.
    pub score: [usize; 2],
    /// For each team, the number of moves that were shortened because of another robot.
    pub refused: [usize; 2],
    /// For each team, the number of times that a robot had no direction in a frame.
    pub lost: [usize; 2],
}

struct State {
    robots: [[f64; 2]; 6],
    ball: [f64; 2],
    rolls: [f64; 2],
    /// A position of the ball, and the frame since which it has stayed nearby.
    left: ([f64; 2], usize),
    seekers: [usize; 2],
    frame: usize,
}

/// Returns, for each cell, true if the centre of a robot must not be there. The free cells form a rectangle.
pub fn walls() -> Vec<bool> {
    let [rows, columns] = CELLS;
    (0..rows * columns).map(|cell| !is_open([(cell / columns) as f64, (cell % columns) as f64])).collect()
}

/// Returns true if a robot whose centre is anywhere in this cell is on the field.
fn is_open([row, column]: [f64; 2]) -> bool {
    let [rows, columns] = CELLS.map(|n| n as f64);
    let within = |at: f64, low: f64, high: f64| at - 0.5 >= low + BODY && at + 0.5 <= high - BODY;
    within(row, DEPTH - 0.5, rows - DEPTH - 0.5) && within(column, -0.5, columns - 0.5)
}

impl Match {
    /// Creates a match. The seed determines positions and pushes.
    pub fn new(seed: u64) -> Result<Self, RelaxError> {
        let mut noise = seed;
        let homes = [[11.0, 32.0], [26.0, 20.0], [33.0, 42.0], [73.0, 32.0], [58.0, 44.0], [51.0, 22.0]];
        let robots = homes.map(|[x, y]| [x + drawn(&mut noise), y + 2.0 * drawn(&mut noise)]);
        let ball = [42.0 + 4.0 * drawn(&mut noise), 32.0 + 8.0 * drawn(&mut noise)];
        let field = MovingField::new(CELLS, walls(), [Boundary::High; 2], Difference::Upwind)?;
        let state = State { robots, ball, rolls: [0.0; 2], left: (ball, 0), seekers: [2, 5], frame: 0 };
        Ok(Self { state, fields: vec![field; 4], noise, score: [0; 2], refused: [0; 2], lost: [0; 2] })
    }

    /// Returns the fields of the last frame: one for each blue robot, and the shared red one.
    pub fn fields(&self) -> &[MovingField] {
        &self.fields
    }

    /// Plays one frame, and returns the state at its beginning.
    pub fn next_frame(&mut self) -> Result<Frame, RelaxError> {
        self.state.choose_seekers();
        let moments = [0, 1, 2, 3].map(|k| if k < 3 { self.state.of_one(k) } else { self.state.of_red() });
        let solver = Solver::Relaxation(Relaxation::sor(Factor::Given(FACTOR), Order::Lines(Scan::ROWS)));
        for (field, moment) in self.fields.iter_mut().zip(&moments) {
            field.next(moment, &solver, BELOW, MOST)?;
        }
        let State { robots, ball, seekers, .. } = self.state;
        // The robot that moves first changes from frame to frame.
        for turn in 0..6 {
            self.go((turn + self.state.frame) % 6);
        }
        self.push();
        self.roll();
        self.state.frame += 1;
        Ok(Frame { robots, ball, seekers, moments })
    }

    /// Moves one robot.
    fn go(&mut self, robot: usize) {
        let team = robot / 3;
        let at = self.state.robots[robot];
        let field = &self.fields[robot.min(3)];
        let kind = field.domain().cell_at(at.map(|x| x.round() as i64)).map(|cell| field.domain().kinds()[cell]);
        let others = self.state.other_positions(robot);
        let holds_back =
            team == 1 && robot != self.state.seekers[1] && distance_between(at, self.state.ball) < KEEPS_OFF;
        let to = match kind {
            Some(Cell::Goal) => return,
            Some(Cell::Free) if holds_back => return,
            Some(Cell::Free) => {
                self.lost[team] += usize::from(field.direction(at).is_none());
                field.advance(at, STEPS)
            }
            // Another robot has come so near that this cell is blocked, so the robot moves back by half a step.
            _ => {
                let nearest =
                    others.iter().min_by(|a, b| distance_between(**a, at).total_cmp(&distance_between(**b, at)));
                let away = nearest.and_then(|nearest| Direction::of([0, 1].map(|k| at[k] - nearest[k])));
                let away = away.map_or([0.0; 2], Direction::components);
                [0, 1].map(|k| at[k] + 0.5 * REACH * away[k])
            }
        };
        // The field has the positions of other robots at the beginning of the frame, except those of team mates that share it. So
        // a step is shortened if it would lead too near to another robot.
        let shorter = [1.0, 0.5, 0.25].map(|part| [0, 1].map(|k| at[k] + part * (to[k] - at[k])));
        let fits = |to: &[f64; 2]| {
            let apart = others
                .iter()
                .all(|&other| distance_between(*to, other) >= (2.0 * BODY + CLOSE).min(distance_between(at, other)));
            apart && is_open(to.map(f64::round))
        };
        self.refused[team] += usize::from(!fits(&to));
        if let Some(&to) = shorter.iter().find(|to| fits(to)) {
            self.state.robots[robot] = to;
        }
    }

    /// Makes a robot that touches the ball push it, towards the other goal.
    fn push(&mut self) {
        let ball = self.state.ball;
        let nearest = (0..6).min_by(|&a, &b| {
            distance_between(self.state.robots[a], ball).total_cmp(&distance_between(self.state.robots[b], ball))
        });
        let Some(robot) = nearest.filter(|&robot| distance_between(self.state.robots[robot], ball) <= CONTACT) else {
            return;
        };
        let at = self.state.robots[robot];
        let target = if robot < 3 { [CELLS[0] as f64, 31.5] } else { [-1.0, 31.5] };
        let unit = |a: [f64; 2], b: [f64; 2]| {
            Direction::of([0, 1].map(|k| b[k] - a[k])).map_or([0.0; 2], Direction::components)
        };
        let (away, towards) = (unit(at, ball), unit(ball, target));
        let turned = 0.9 * drawn(&mut self.noise);
        let [x, y] = [0, 1].map(|k| away[k] + towards[k]);
        let turned = [x * turned.cos() - y * turned.sin(), x * turned.sin() + y * turned.cos()];
        let push = Direction::of(turned).map_or(away, Direction::components);
        self.state.rolls = push.map(|x| PUSHED * x);
    }

    /// Rolls the ball, which may bounce or enter a goal.
    fn roll(&mut self) {
        let [rows, columns] = CELLS.map(|n| n as f64);
        let State { ball, rolls, .. } = &mut self.state;
        *ball = [0, 1].map(|k| ball[k] + rolls[k]);
        *rolls = rolls.map(|x| ROLLS * x);
        let in_mouth = ball[1] - BALL >= MOUTH[0] - 0.5 && ball[1] + BALL <= MOUTH[1] - 0.5;
        let ends = [(DEPTH - 0.5 + BALL, rows - DEPTH - 0.5 - BALL), (BALL - 0.5, columns - 0.5 - BALL)];
        if in_mouth && !(ends[0].0..=ends[0].1).contains(&ball[0]) {
            self.score[usize::from(ball[0] < ends[0].0)] += 1;
            (*ball, *rolls) = ([42.0, 32.0 + 8.0 * drawn(&mut self.noise)], [0.0; 2]);
            return;
        }
        for (k, (low, high)) in ends.into_iter().enumerate() {
            if !(low..=high).contains(&ball[k]) {
                (ball[k], rolls[k]) = (ball[k].clamp(low, high), -BOUNCES * rolls[k]);
            }
        }
        let (ball, State { left, frame, .. }) = (self.state.ball, &mut self.state);
        if distance_between(ball, left.0) > STALE.1 {
            *left = (ball, *frame);
        } else if *frame - left.1 >= STALE.0 {
            self.free_ball();
        }
    }

    /// Moves a blocked ball to the mark that is farthest from all robots.
    fn free_ball(&mut self) {
        let room = |mark: &[f64; 2]| {
            self.state.robots.iter().map(|&at| distance_between(at, *mark)).fold(f64::INFINITY, f64::min)
        };
        let mark = MARKS.into_iter().max_by(|a, b| room(a).total_cmp(&room(b)));
        let State { ball, rolls, left, frame, .. } = &mut self.state;
        (*ball, *rolls) = (mark.unwrap_or(*ball), [0.0; 2]);
        *left = (*ball, *frame);
    }
}

/// Least distance between robots at the end of a step, in cells. On straight lines, two robots may come slightly nearer in
/// between.
const CLOSE: f64 = 0.25;

impl State {
    fn other_positions(&self, robot: usize) -> Vec<[f64; 2]> {
        (0..6).filter(|&other| other != robot).map(|other| self.robots[other]).collect()
    }

    /// Chooses the seeker of each team: the robot nearest to the ball, except the keeper. The current seeker changes only if
    /// another robot is much nearer.
    fn choose_seekers(&mut self) {
        for (team, first) in [(0, 1), (1, 3)] {
            let distance = |robot: usize| {
                let goes_on = if robot == self.seekers[team] { TAKES_OVER } else { 0.0 };
                distance_between(self.robots[robot], self.ball) - goes_on
            };
            let nearest = (first..3 * team + 3).min_by(|&a, &b| distance(a).total_cmp(&distance(b)));
            self.seekers[team] = nearest.unwrap_or(first);
        }
    }

    /// Returns discs that the centre of a robot must avoid, whichever way the other robots move within the frame.
    fn obstacles(&self, robots: impl Iterator<Item = usize>) -> Vec<Disc> {
        robots.map(|k| Disc { center: self.robots[k], radius: BODY + REACH + CLOSE }.grown_for(BODY)).collect()
    }

    /// Returns the input of a blue robot's own field. The other robots are obstacles, and the drift applies everywhere. The
    /// seeker approaches the ball in the direction of the intended push. Another robot's goal is halfway between ball and goal,
    /// and the keeper guards the goal.
    fn of_one(&self, robot: usize) -> Moment {
        let keeps = [10.0, self.ball[1].clamp(MOUTH[0], MOUTH[1])];
        let (goal, heading) = match robot {
            0 => (Disc { center: keeps, radius: 1.5 }, [1.0, 0.0]),
            _ if robot == self.seekers[0] => {
                (Disc { center: self.ball, radius: SOUGHT }, [CELLS[0] as f64 - self.ball[0], 31.5 - self.ball[1]])
            }
            _ => {
                let middle = [0, 1].map(|k| 0.5 * (self.ball[k] + [4.0, 31.5][k]));
                (Disc { center: [middle[0].max(16.0), middle[1]], radius: 1.5 }, [1.0, 0.0])
            }
        };
        Moment {
            obstacles: self.obstacles((0..6).filter(|&other| other != robot)),
            goals: vec![goal],
            robots: self.influence(robot, heading, f64::INFINITY).into_iter().collect(),
        }
    }

    /// Returns the input of the field that red robots share. Blue robots are obstacles, the ball is the goal, and each red robot
    /// has a drift around it: that of the seeker is in the direction of the intended push, and those of the others pull them
    /// back.
    fn of_red(&self) -> Moment {
        let robots = (3..6).filter_map(|robot| {
            let heading = match robot == self.seekers[1] {
                true => [-1.0 - self.ball[0], 31.5 - self.ball[1]],
                false => [1.0, 0.0],
            };
            self.influence(robot, heading, INFLUENCE)
        });
        let robots = robots.collect();
        let goals = vec![Disc { center: self.ball, radius: SOUGHT }];
        Moment { obstacles: self.obstacles(0..3), goals, robots }
    }

    fn influence(&self, robot: usize, heading: [f64; 2], radius: f64) -> Option<Influence> {
        let drift = Direction::of(heading)?.drift(EPSILON);
        Some(Influence { center: self.robots[robot], radius, drift })
    }
}

/// Returns a uniform number from -1 to 1 (SplitMix64; Steele, Lea, Flood 2014).
fn drawn(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (*state ^ (*state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    2.0 * ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64 - 1.0
}

fn distance_between(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
