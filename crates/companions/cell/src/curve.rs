//! The motion of one arm as a curve in time, for searches over the times of both arms.

use cplan_handling::Piece;
use cplan_judge::Deviation;
use cplan_model::space::Configuration;
use cplan_motion::{Place, Span, Trajectory};

/// A motion of one arm: pieces in the order of time. It may consist of legs, each from rest to rest.
#[derive(Debug, Clone)]
pub(crate) struct Curve {
    pieces: Vec<Piece>,
    /// For each leg, the number of its first piece, and that of the piece after it.
    legs: Vec<[usize; 2]>,
    /// For each leg, the index of its stage.
    stages: Vec<usize>,
}

impl Curve {
    /// Creates the curve of legs that follow each other without rests. The first begins at time 0.
    pub fn of_legs<'a>(legs: impl IntoIterator<Item = &'a Trajectory>) -> Self {
        let (mut pieces, mut ranges, mut begin) = (Vec::new(), Vec::new(), 0.0);
        for leg in legs {
            let first = pieces.len();
            let later = |mut piece: Piece| {
                (piece.from, piece.to) = (begin + piece.from, begin + piece.to);
                piece
            };
            pieces.extend(leg.pieces().into_iter().map(later));
            // A leg without motion has a single sample.
            if pieces.len() == first {
                let q = leg.position.first().copied().unwrap_or_default().into();
                pieces.push(Piece::line(begin, begin, q, q));
            }
            ranges.push([first, pieces.len()]);
            begin += leg.duration();
        }
        Self { pieces, stages: vec![0; ranges.len()], legs: ranges }
    }

    /// Returns the curve with these stages of its legs.
    pub fn with_stages(self, stages: Vec<usize>) -> Self {
        Self { stages, ..self }
    }

    /// Returns the curve with the stage of the first piece of each leg. `stage` returns that of a piece.
    pub fn with_stages_of(self, stage: impl Fn(usize) -> usize) -> Self {
        Self { stages: self.legs.iter().map(|[first, _]| stage(*first)).collect(), ..self }
    }

    /// Returns the curve of one motion, divided at these times into legs with these stages. There is one time less than
    /// stages. Legs without a duration are omitted.
    pub fn divided(self, times: &[f64], stages: &[usize]) -> Self {
        let first = |time: &f64| self.pieces.partition_point(|piece| f64::midpoint(piece.from, piece.to) < *time);
        let bounds: Vec<usize> = [0].into_iter().chain(times.iter().map(first)).chain([self.pieces.len()]).collect();
        let legs = bounds.windows(2).map(|ends| [ends[0], ends[1]]).zip(stages).filter(|([from, to], _)| from < to);
        let (legs, stages) = legs.unzip();
        Self { legs, stages, pieces: self.pieces }
    }

    /// Creates the curve of a motion with one leg.
    pub fn of_pieces(pieces: Vec<Piece>) -> Self {
        let legs = vec![[0, pieces.len()]];
        Self { pieces, legs, stages: vec![0] }
    }

    /// Returns the times at which the curve begins and ends, seconds.
    pub fn ends(&self) -> [f64; 2] {
        [self.pieces[0].from, self.pieces[self.pieces.len() - 1].to]
    }

    /// Returns the same motion as one leg, preceded and followed by rests from `begin` to `end`.
    pub fn resting(self, begin: f64, end: f64) -> Self {
        let Self { mut pieces, .. } = self;
        let (first, last) = (pieces[0].at(0.0), pieces[pieces.len() - 1].at(1.0));
        let (starts, ends) = (pieces[0].from, pieces[pieces.len() - 1].to);
        if begin < starts {
            pieces.insert(0, Piece::line(begin, starts, first, first));
        }
        if end > ends {
            pieces.push(Piece::line(ends, end, last, last));
        }
        Self::of_pieces(pieces)
    }

    /// Returns the curve of straight lines between targets, one in each unit of time. Legs end at the targets `ends`, in
    /// ascending order, and at the last target.
    pub fn of_targets(targets: &[Configuration], ends: impl IntoIterator<Item = usize>) -> Self {
        let lines = targets.windows(2).enumerate();
        let mut pieces: Vec<Piece> =
            lines.map(|(k, line)| Piece::line(k as f64, (k + 1) as f64, line[0], line[1])).collect();
        if pieces.is_empty() {
            let q = targets.first().copied().unwrap_or_default();
            pieces.push(Piece::line(0.0, 0.0, q, q));
        }
        let (mut legs, mut first) = (Vec::new(), 0);
        for end in ends.into_iter().filter(|end| *end < pieces.len()).chain([pieces.len()]) {
            if end > first {
                legs.push([first, end]);
                first = end;
            }
        }
        Self { pieces, stages: vec![0; legs.len()], legs }
    }

    /// Returns the number of legs.
    pub fn legs(&self) -> usize {
        self.legs.len()
    }

    /// Returns the stage of a leg.
    pub fn stage(&self, leg: usize) -> usize {
        self.stages[leg]
    }

    /// Returns the leg to which a time belongs. Before the beginning it is the first one, and after the end the last one.
    pub fn leg_at(&self, time: f64) -> usize {
        let ended = self.legs.partition_point(|[_, end]| self.pieces[end - 1].to < time);
        ended.min(self.legs.len() - 1)
    }

    /// Returns the span of a leg.
    pub fn leg(&self, leg: usize) -> Span {
        let [first, end] = self.legs[leg];
        if end - first == 1 { Span::Part(first, 0.0, 1.0) } else { Span::Pieces(first, end) }
    }

    /// Returns the times at which a span begins and ends, seconds.
    pub fn times(&self, span: Span) -> [f64; 2] {
        span.ends().map(|place| self.time(place))
    }

    fn time(&self, (piece, share): Place) -> f64 {
        self.pieces[piece].time(share)
    }

    /// Returns the configuration in the middle of a span, and the deviations from it in the whole span.
    pub fn deviation(&self, span: Span) -> (Configuration, Deviation) {
        span.deviation(&self.pieces)
    }

    /// Returns the length of the straight pieces up to a time, in joint space.
    pub fn travelled(&self, time: f64) -> f64 {
        let before = self.pieces.partition_point(|piece| piece.to < time);
        let whole: f64 = self.pieces[..before].iter().map(|piece| (piece.at(1.0) - piece.at(0.0)).norm()).sum();
        let last = self.pieces.get(before).map_or(0.0, |piece| (self.at(time) - piece.at(0.0)).norm());
        whole + last
    }

    /// Returns the configuration at a time. Before the beginning and after the end the arm rests.
    pub fn at(&self, time: f64) -> Configuration {
        let next = self.pieces.partition_point(|piece| piece.to < time).min(self.pieces.len() - 1);
        let piece = &self.pieces[next];
        let lasts = piece.to - piece.from;
        let share = if lasts > 0.0 { ((time - piece.from) / lasts).clamp(0.0, 1.0) } else { 0.0 };
        piece.at(share)
    }
}
