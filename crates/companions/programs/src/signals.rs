//! Digital signals between the programs of two controllers: points of a motion at which a program waits for a signal, or
//! sets it.

use crate::joint_value::MARK;
use crate::moves::{Move, MoveKind};
use crate::program::Program;
use cplan_model::space::Configuration;
use minijinja::context;
use minijinja::value::{Object, Value};
use std::fmt;
use std::sync::Arc;

/// Length of a path, in joint space, below which a point is at a target.
const SAME_POINT: f64 = 1e-9;

/// The use of a signal. At one point, signals are set before the program waits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum SignalUse {
    /// The program sets the signal.
    Set,
    /// The program waits until the signal is set.
    Wait,
}

impl SignalUse {
    /// Returns the name in templates.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Set => "set",
            Self::Wait => "wait",
        }
    }
}

/// The place in a step at which a program uses a signal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SignalPlace {
    /// On the path of the step, after this length in joint space.
    Along(f64),
    /// At the end of the path, before the tool acts.
    Arrival,
    /// At the end of the step, after the tool has acted.
    End,
}

/// A signal of a program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Signal {
    /// Number of the signal, from 1.
    pub number: usize,
    /// Use of the signal.
    pub usage: SignalUse,
    /// Index of the step; 0 for the program of a single motion.
    pub step: usize,
    /// Place in this step.
    pub place: SignalPlace,
}

impl Program {
    /// Adds signals to the program. A signal that is between two targets adds a target there. `other` is the program that
    /// shares the signals, for the head.
    #[must_use]
    pub fn with_signals(mut self, signals: &[Signal], other: &str) -> Self {
        let placed = |signal: &Signal| (self.signal_line(signal), (signal.number, signal.usage));
        let mut placed: Vec<_> = signals.iter().map(placed).collect();
        placed.sort_by(|((one, a), (m, used)), ((two, b), (n, other))| {
            one.cmp(two).then(a.total_cmp(b)).then(used.cmp(other)).then(m.cmp(n))
        });
        let (mut moves, mut numbers) = (Vec::<Move>::new(), Vec::new());
        let mut left = placed.iter().peekable();
        let old = std::mem::take(&mut self.moves);
        for (index, one) in old.iter().enumerate() {
            while let Some(((_, share), signal)) = left.next_if(|((line, share), _)| *line == index && *share < 1.0) {
                add(&mut moves, &old[index - 1], one, *share, *signal);
            }
            numbers.push(moves.len());
            moves.push(one.clone());
            let here = std::iter::from_fn(|| left.next_if(|((line, _), _)| *line == index));
            moves.last_mut().expect("a move").signals.extend(here.map(|(_, signal)| *signal));
        }
        self.travels.iter_mut().for_each(|travel| travel.moves = travel.moves.map(|index| numbers[index]));
        Self { moves, interlocked_with: Some(other.to_owned()), ..self }
    }

    /// Returns the index of the move in which a signal is used, and the share of its line up to there, at most 1.
    fn signal_line(&self, signal: &Signal) -> (usize, f64) {
        let [first, last] = self.travels[signal.step].moves;
        match signal.place {
            SignalPlace::Arrival => (last, 1.0),
            SignalPlace::End => (self.moves.iter().rposition(|one| one.step == signal.step).unwrap_or(last), 1.0),
            SignalPlace::Along(along) => {
                let mut passed = 0.0;
                for index in first + 1..=last {
                    let length = (place(&self.moves[index]) - place(&self.moves[index - 1])).norm();
                    if along <= passed + SAME_POINT {
                        return (index - 1, 1.0);
                    }
                    if along < passed + length - SAME_POINT {
                        return (index, (along - passed) / length);
                    }
                    passed += length;
                }
                (last, 1.0)
            }
        }
    }

    /// Returns the index of the target at which the program uses a signal.
    pub fn signal_target(&self, number: usize) -> Option<usize> {
        self.moves.iter().position(|one| one.signals.iter().any(|(known, _)| *known == number))
    }
}

/// Adds a signal to the last move if its point is that of the move, or else a move to the point.
fn add(moves: &mut Vec<Move>, from: &Move, to: &Move, share: f64, signal: (usize, SignalUse)) {
    let between = |a: f64, b: f64| a + (b - a) * share;
    let mut point = Move { kind: MoveKind::Travel, signals: Vec::new(), grip: None, dwell: 0.0, ..to.clone() };
    point.values = from.values.iter().zip(&to.values).map(|(a, b)| between(*a, *b)).collect();
    let (a, b) = (from.drives, to.drives);
    point.drives.planned = [0, 1].map(|k| between(a.planned[k], b.planned[k]));
    (point.drives.stroke, point.drives.wrist) = (between(a.stroke, b.stroke), between(a.wrist, b.wrist));
    if moves.last().is_none_or(|last| (place(&point) - place(last)).norm() > SAME_POINT) {
        moves.push(point);
    }
    moves.last_mut().expect("a move").signals.push(signal);
}

fn place(one: &Move) -> Configuration {
    one.drives.planned.into()
}

/// Returns the mark of a signal's number in templates, which names its use and its target.
pub(crate) fn signal_mark(target: usize, (number, usage): (usize, SignalUse)) -> String {
    format!("{},{number},{target}", usage.name())
}

/// Returns true for the mark of a signal's number.
pub(crate) fn is_signal(mark: &str) -> bool {
    mark.starts_with(char::is_alphabetic)
}

/// The number of a signal in templates, with its mark.
#[derive(Debug)]
struct SignalNumber {
    target: usize,
    signal: (usize, SignalUse),
}

impl Object for SignalNumber {
    fn render(self: &Arc<Self>, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [open, middle, close] = MARK;
        write!(f, "{open}{}{middle}{}{close}", signal_mark(self.target, self.signal), self.signal.0)
    }
}

/// Returns the signals of a target for templates.
pub(crate) fn signals_of(target: usize, one: &Move) -> Value {
    let signal = |&(number, usage): &(usize, SignalUse)| {
        let text = match usage {
            SignalUse::Set => format!("set signal {number}"),
            SignalUse::Wait => format!("wait for signal {number}"),
        };
        let number = Value::from_object(SignalNumber { target, signal: (number, usage) });
        context! { number, action => usage.name(), text }
    };
    Value::from(one.signals.iter().map(signal).collect::<Vec<_>>())
}
