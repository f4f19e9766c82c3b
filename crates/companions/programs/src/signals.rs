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

/// A signal of a program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Signal {
    /// Number of the signal, from 1.
    pub number: usize,
    /// Use of the signal.
    pub usage: SignalUse,
    /// Length of the path up to the point of the signal, in joint space.
    pub along: f64,
}

impl Program {
    /// Adds signals to the program of a single motion. A signal that is between two targets adds a target there. `other` is
    /// the program that shares the signals, for the head.
    #[must_use]
    pub fn with_signals(mut self, signals: &[Signal], other: &str) -> Self {
        let mut signals = signals.to_vec();
        signals.sort_by(|a, b| a.along.total_cmp(&b.along).then(a.usage.cmp(&b.usage)).then(a.number.cmp(&b.number)));
        let (mut moves, mut passed) = (Vec::new(), 0.0);
        let mut left = signals.iter().peekable();
        for one in std::mem::take(&mut self.moves) {
            if let Some(last) = moves.last().cloned() {
                let leg = place(&one) - place(&last);
                let length = leg.norm();
                while let Some(signal) = left.next_if(|signal| signal.along < passed + length - SAME_POINT) {
                    let share = ((signal.along - passed) / length).clamp(0.0, 1.0);
                    add(&mut moves, &last, &one, share, signal);
                }
                passed += length;
            }
            moves.push(one);
            while let Some(signal) = left.next_if(|signal| signal.along <= passed + SAME_POINT) {
                moves.last_mut().expect("a move").signals.push((signal.number, signal.usage));
            }
        }
        if let Some(last) = moves.last_mut() {
            last.signals.extend(left.map(|signal| (signal.number, signal.usage)));
        }
        let last = moves.len() - 1;
        self.travels.iter_mut().for_each(|travel| travel.moves[1] = last);
        Self { moves, interlocked_with: Some(other.to_owned()), ..self }
    }

    /// Returns the index of the target at which the program uses a signal.
    pub fn signal_target(&self, number: usize) -> Option<usize> {
        self.moves.iter().position(|one| one.signals.iter().any(|(known, _)| *known == number))
    }
}

/// Adds a signal to the last move if its point is that of the move, or else a move to the point.
fn add(moves: &mut Vec<Move>, from: &Move, to: &Move, share: f64, signal: &Signal) {
    let between = |a: f64, b: f64| a + (b - a) * share;
    let mut point = Move { kind: MoveKind::Travel, signals: Vec::new(), grip: None, dwell: 0.0, ..to.clone() };
    point.values = from.values.iter().zip(&to.values).map(|(a, b)| between(*a, *b)).collect();
    let (a, b) = (from.drives, to.drives);
    point.drives.planned = [0, 1].map(|k| between(a.planned[k], b.planned[k]));
    (point.drives.stroke, point.drives.wrist) = (between(a.stroke, b.stroke), between(a.wrist, b.wrist));
    if moves.last().is_none_or(|last| (place(&point) - place(last)).norm() > SAME_POINT) {
        moves.push(point);
    }
    moves.last_mut().expect("a move").signals.push((signal.number, signal.usage));
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
