//! The picture of a program.

use super::Answered;
use crate::cli::follow::resting;
use crate::output::{contours, title_of};
use crate::view::{LineView, MoveMark, Picture, View};
use cplan_gcode::{Failed, Travel};
use cplan_geometry::Point;
use cplan_toolpath::{Curve, Piece, Toolpath};

/// Number of chords of a curve that fails.
const CHORDS: u32 = 48;

/// Returns the picture: the drawing moves, the replaced travels, the moves that fail, and the configuration space.
pub fn view(answered: &Answered) -> View {
    let (scene, answer) = (&answered.loaded.scene, answered.answer);
    let picture = Picture {
        title: vec![answered.result(), title_of(scene)],
        status: answer.status().name().into(),
        ending: Some(answer.status()),
        c_obstacles: &contours(scene),
        ..Picture::new(scene, resting(answered.loaded, None))
    };
    let replaced = answer
        .replaced
        .iter()
        .map(|travel: &Travel| (MoveMark::Replaced, travel.points.iter().map(|point| Point::from(*point)).collect()));
    let failed = answer.failed.iter().map(|failed: &Failed| {
        let points = (0..=CHORDS).map(|k| failed.own.piece.curve.at(f64::from(k) / f64::from(CHORDS)).into());
        (MoveMark::Failed, points.collect())
    });
    let view = View::of_picture(&picture);
    let Some(line) = line(answered) else { return view };
    let marked = replaced.chain(failed).collect();
    view.with_line(LineView::new(scene, &line, answered.args.tolerance).with_marked_moves(marked))
}

/// Returns the moves of the written program, with travels between moves that are not connected.
fn line(answered: &Answered) -> Option<Toolpath> {
    let mut pieces: Vec<Piece> = Vec::new();
    for own in &answered.job.program.moves {
        let (last, to) = (pieces.last().map(|piece| piece.curve.end()), own.piece.curve.start());
        if let Some(from) = last.filter(|from| *from != to) {
            pieces.push(Piece { curve: Curve::Line { from, to }, is_travel: true, ..own.piece });
        }
        match answered.answer.replaced.iter().find(|travel| travel.line == own.piece.source.line) {
            Some(travel) => pieces.extend(travel.points.windows(2).map(|pair| {
                let curve = Curve::Line { from: pair[0], to: pair[1] };
                Piece { curve, ..own.piece }
            })),
            None => pieces.push(own.piece),
        }
    }
    Toolpath::new(pieces).ok()
}
