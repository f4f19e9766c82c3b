//! A view in motion: first how the planner came to its answer, then what the arm does.

use super::figure::Figure;
use super::legend;
use super::page;
use super::view::View;

/// Time between two pictures, in hundredths of a second: nearly 17 a second.
pub const DELAY: u16 = 6;

/// Shortest and longest time in which the motion is shown, seconds: what is shorter is slowed down.
const MOTION: [f64; 2] = [2.0, 3.5];

/// How long the end of a phase, and of all, is to be seen, hundredths of a second.
const REST: u16 = 36;
const END: u16 = 200;

/// A moment, and how long it is shown, in hundredths of a second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    what: What,
    pub delay: u16,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum What {
    /// A phase of the planner's run, and how much of it has been shown.
    Thinking(usize, f64),
    /// A time of the motion.
    Moving(f64),
    /// All at rest.
    Still,
}

/// The moments of a view, one after the other; the last one is the view as it is.
#[must_use]
pub fn moments(view: &View) -> Vec<Moment> {
    let mut moments = Vec::new();
    let frames = |seconds: f64| (seconds * 100.0 / f64::from(DELAY)).round().max(1.0) as usize;
    for (phase, now) in view.replay.iter().enumerate() {
        let count = frames(now.seconds);
        let shown = (1..=count).map(|k| What::Thinking(phase, k as f64 / count as f64));
        moments.extend(shown.map(|what| Moment { what, delay: DELAY }));
        moments.last_mut().into_iter().for_each(|moment| moment.delay = REST);
    }
    if let Some(duration) = view.duration() {
        let count = frames(duration.clamp(MOTION[0], MOTION[1]));
        let shown = (0..=count).map(|k| What::Moving(duration * k as f64 / count as f64));
        moments.extend(shown.map(|what| Moment { what, delay: DELAY }));
    }
    moments.push(Moment { what: What::Still, delay: END });
    moments
}

/// The picture of a moment.
#[must_use]
pub fn figure(view: &View, moment: Moment) -> Figure {
    let shown = match moment.what {
        What::Thinking(phase, part) => &view.thinking(phase, part),
        What::Moving(time) => &view.moving(time),
        What::Still => view,
    };
    page::explained(shown, legend::keys(view))
}
