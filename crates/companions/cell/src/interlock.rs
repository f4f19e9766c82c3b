//! Interlocks: signals between two controllers with which a coordination holds for any skew of their clocks.

use crate::diagram::Rectangle;

/// A signal from one arm to the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interlock {
    /// The arm that waits, 0 or 1. The other arm sets the signal.
    pub waits: usize,
    /// Time on the waiting arm's clock: at this point of its motion it waits, unless the signal is set. Seconds.
    pub at: f64,
    /// Time on the other arm's clock: at this point of its motion it sets the signal. Seconds.
    pub set: f64,
}

/// Returns the fewest interlocks with which two motions hold for any skew. `rectangles` are those of the diagram of both
/// motions; each is passed in the order in which the motions pass it on one clock.
///
/// An interlock is a place on the diagonal of the diagram, where both clocks are equal. It keeps the waiting arm out of all
/// rectangles that it enters after this time and that the other arm leaves before. So each rectangle is an interval of
/// places, and the fewest places that meet all intervals are found greedily. No interlocks can block each other, because
/// the motions without any skew pass all of them.
pub(crate) fn interlocks(rectangles: &[Rectangle]) -> Vec<Interlock> {
    let mut found = Vec::new();
    for waits in 0..2 {
        let intervals = rectangles.iter().map(|rectangle| [rectangle.times[1 - waits][1], rectangle.times[waits][0]]);
        let mut intervals: Vec<[f64; 2]> = intervals.filter(|[leaves, enters]| leaves <= enters).collect();
        intervals.sort_by(|a, b| a[1].total_cmp(&b[1]).then(a[0].total_cmp(&b[0])));
        let mut last: Option<(f64, Interlock)> = None;
        for [leaves, enters] in intervals {
            match &mut last {
                Some((place, interlock)) if leaves <= *place => interlock.set = interlock.set.max(leaves),
                _ => {
                    found.extend(last.map(|(_, interlock)| interlock));
                    last = Some((enters, Interlock { waits, at: enters, set: leaves }));
                }
            }
        }
        found.extend(last.map(|(_, interlock)| interlock));
    }
    found.sort_by(|a, b| a.at.total_cmp(&b.at).then(a.waits.cmp(&b.waits)));
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rectangle(one: [f64; 2], two: [f64; 2]) -> Rectangle {
        Rectangle { times: [one, two], legs: [0, 0], is_collision: true }
    }

    #[test]
    fn one_signal_serves_all_rectangles_around_a_place() {
        // Arm 0 enters two places after arm 1 has left them, and arm 1 enters one after arm 0.
        let rectangles =
            [rectangle([3.0, 4.0], [1.0, 2.0]), rectangle([3.5, 5.0], [2.0, 2.5]), rectangle([5.5, 6.0], [7.0, 8.0])];
        let expected = [Interlock { waits: 0, at: 3.0, set: 2.5 }, Interlock { waits: 1, at: 7.0, set: 6.0 }];
        assert_eq!(interlocks(&rectangles), expected);
    }

    #[test]
    fn places_without_a_common_time_need_two_signals() {
        let rectangles = [rectangle([3.0, 4.0], [1.0, 2.0]), rectangle([8.0, 9.0], [4.0, 5.0])];
        let expected = [Interlock { waits: 0, at: 3.0, set: 2.0 }, Interlock { waits: 0, at: 8.0, set: 5.0 }];
        assert_eq!(interlocks(&rectangles), expected);
        assert!(interlocks(&[]).is_empty());
    }
}
