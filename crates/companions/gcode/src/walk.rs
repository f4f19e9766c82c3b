//! A program from its first move to its last, with one IK solution.
//!
//! The joints continue from move to move, so the moves form chains. A chain ends where the machine cannot play a travel
//! of the program. A safe travel then leads to the next chain. Within a chain, the joint values are known up to whole
//! turns. If the range of a joint exceeds a turn, several numbers of whole turns may be possible.

use crate::Frame;
use crate::detour::{Detours, Travel};
use crate::fault::{Cause, Fault};
use crate::player::{Player, Swept};
use cplan_geometry::Point;
use cplan_interrupt::checkpoint;
use cplan_model::space::Configuration;
use cplan_toolpath::{Curve, ProgramMove};
use std::f64::consts::TAU;

/// Greatest gap between the end of a move and the beginning of the next one, metres. It covers rounding.
const MAX_GAP: f64 = 1e-9;

/// The chains of a program, and the moves that interrupt them.
pub(crate) struct Walk<'a> {
    player: &'a Player<'a>,
    moves: &'a [ProgramMove],
    chains: Vec<Swept>,
    /// Moves that the machine cannot play, by their index.
    pub failed: Vec<(usize, Fault)>,
    /// Unsafe travels, each between two chains.
    pub broken: Vec<Broken>,
}

/// A travel that the machine cannot play safely.
pub(crate) struct Broken {
    /// Index of the move.
    pub index: usize,
    pub fault: Fault,
    /// The chains before and after the travel.
    chains: [usize; 2],
}

/// A travel that replaces an unsafe one.
pub(crate) struct Replaced {
    /// Index of the move.
    pub index: usize,
    /// The ends of its moves; the last one is the end of the travel.
    pub points: Vec<Point>,
}

impl<'a> Walk<'a> {
    pub fn new(player: &'a Player<'a>, moves: &'a [ProgramMove]) -> Self {
        let mut walk = Self { player, moves, chains: Vec::new(), failed: Vec::new(), broken: Vec::new() };
        let mut chain = None;
        for (index, own) in moves.iter().enumerate() {
            checkpoint();
            let is_joined = index > 0 && distance(&moves[index - 1].piece.curve, &own.piece.curve) <= MAX_GAP;
            chain = walk.add(index, chain.filter(|_| is_joined));
        }
        walk
    }

    /// Walks through other moves with the same player.
    pub fn again<'b>(&'b self, moves: &'b [ProgramMove]) -> Walk<'b> {
        Walk::new(self.player, moves)
    }

    /// Adds a move to a chain. Returns the chain after the move, which may be a new one.
    fn add(&mut self, index: usize, chain: Option<usize>) -> Option<usize> {
        let ProgramMove { piece, modes } = &self.moves[index];
        let played = self.player.play(&piece.curve, modes).and_then(|swept| {
            let Some(before) = chain.map(|chain| self.chains[chain]) else { return Ok(swept) };
            let turns = self.player.kinematics.near(swept.start, before.end) - swept.start;
            let joined = before.then(&swept.turned(turns));
            match self.player.joint_outside(joined.low, joined.high) {
                None => Ok(joined),
                Some(joint) => {
                    let place = piece.curve.end().into();
                    Err(Fault::limit(self.player.scene, place, joint, joined.end, false))
                }
            }
        });
        match (played, chain) {
            (Ok(swept), Some(chain)) => {
                self.chains[chain] = swept;
                Some(chain)
            }
            (Ok(swept), None) => Some(self.begin(swept)),
            (Err(fault), _) if !piece.is_travel => {
                self.failed.push((index, fault));
                None
            }
            (Err(fault), _) => {
                let before = chain.map_or_else(|| self.begin_at(piece.curve.start().into()), Ok);
                match (before, self.begin_at(piece.curve.end().into())) {
                    (Ok(before), Ok(after)) => {
                        self.broken.push(Broken { index, fault, chains: [before, after] });
                        Some(after)
                    }
                    (Err(fault), _) | (_, Err(fault)) => {
                        self.failed.push((index, fault));
                        None
                    }
                }
            }
        }
    }

    fn begin(&mut self, swept: Swept) -> usize {
        self.chains.push(swept);
        self.chains.len() - 1
    }

    /// Begins a chain with the arm at rest.
    fn begin_at(&mut self, point: Point) -> Result<usize, Fault> {
        let q = self.player.at(point)?;
        self.player.check_limits(point, q)?;
        Ok(self.begin(Swept::at_rest(q)))
    }

    /// Returns the whole turns that bring all joint values of a chain within the limits.
    fn turns(&self, chain: usize) -> Vec<Configuration> {
        let Swept { low, high, .. } = self.chains[chain];
        let of = |joint: usize| {
            let [first, last] = self.player.turns(joint, [low[joint], high[joint]]);
            (first as i64..=last as i64).map(|turns| turns as f64 * TAU)
        };
        of(0).flat_map(|one| of(1).map(move |two| Configuration::new(one, two))).collect()
    }

    /// Plans a safe travel for each broken one. Travels without a safe substitute become failed moves. `frame` is that
    /// of the file, which must be able to state the places.
    pub fn repair(&mut self, frame: Frame) -> Vec<Replaced> {
        let mut detours = Detours::new(self.player, frame);
        let mut chosen: Vec<Option<Configuration>> = vec![None; self.chains.len()];
        let mut replaced = Vec::new();
        for Broken { index, fault, chains: [before, after] } in std::mem::take(&mut self.broken) {
            checkpoint();
            let own = &self.moves[index];
            let turns = self.turns(before);
            let nearest = turns.iter().copied().min_by(|a, b| a.norm().total_cmp(&b.norm()));
            let Some(turn) = chosen[before].or(nearest) else { continue };
            chosen[before] = Some(turn);
            let (start, first) = (self.chains[before].end + turn, self.chains[after].start);
            let goals = self.turns(after).into_iter().map(|turn| first + turn).collect();
            match detours.plan(&Travel { own, fault: &fault, start, goals }) {
                Ok((points, goal)) => {
                    chosen[after] = Some(goal - first);
                    replaced.push(Replaced { index, points });
                }
                Err(fault) => {
                    // With another number of whole turns, there might be a safe travel.
                    let is_proven = fault.is_proven && (turns.len() == 1 || fault.cause != Cause::NoTravel);
                    self.failed.push((index, Fault { is_proven, ..fault }));
                }
            }
        }
        self.failed.sort_by_key(|(index, _)| *index);
        replaced
    }

    /// Keeps unsafe travels as failed moves.
    pub fn keep_travels(&mut self) {
        self.failed.extend(std::mem::take(&mut self.broken).into_iter().map(|broken| (broken.index, broken.fault)));
        self.failed.sort_by_key(|(index, _)| *index);
    }
}

fn distance(before: &Curve, after: &Curve) -> f64 {
    (Point::from(before.end()) - Point::from(after.start())).norm()
}
