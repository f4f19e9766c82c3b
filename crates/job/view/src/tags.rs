//! Numbers of steps at the places where the steps end.

use super::labels::centered_rect;
use super::named::Named;
use super::view::ranges;

/// Places nearer than this, in pixels, share one name with all their numbers.
const SHARED_NAME_DISTANCE: f64 = 4.0;

/// Steps that end at one place.
#[derive(Debug, Clone, PartialEq)]
pub struct Tag {
    /// The place at which the steps end.
    pub at: [f64; 2],
    /// Their numbers, each once.
    pub numbers: Vec<usize>,
}

/// Adds the number of a step at a place, unless it is already there.
pub fn add(tags: &mut Vec<Tag>, at: [f64; 2], number: usize) {
    match tags.iter_mut().find(|tag| (tag.at[0] - at[0]).hypot(tag.at[1] - at[1]) < SHARED_NAME_DISTANCE) {
        Some(tag) if tag.numbers.contains(&number) => {}
        Some(tag) => tag.numbers.push(number),
        None => tags.push(Tag { at, numbers: vec![number] }),
    }
}

/// Returns the numbers as names for the placer. `half` is half the width of the markers there, in pixels.
pub fn names(tags: &[Tag], half: f64) -> Vec<Named> {
    tags.iter().map(|tag| Named::of_box(ranges(&tag.numbers), centered_rect(tag.at, [2.0 * half; 2]))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_place_has_a_single_name() {
        let mut tags = Vec::new();
        for (x, number) in [(50.0, 1), (51.0, 2), (50.0, 1), (90.0, 3), (50.5, 7)] {
            add(&mut tags, [x, 50.0], number);
        }
        let names: Vec<String> = names(&tags, 4.0).into_iter().map(|name| name.text).collect();
        assert_eq!(names, ["1\u{2013}2, 7", "3"]);
    }
}
