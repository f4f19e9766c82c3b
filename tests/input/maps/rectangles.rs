//! Rectangles, compared with the pixels that they cover, and with the least possible number of rectangles.

use cplan::input::{PixelRectangle, rectangles};
use proptest::prelude::*;
use std::collections::HashMap;

fn of(pixels: &[Vec<bool>]) -> Vec<PixelRectangle> {
    let found = rectangles([pixels[0].len(), pixels.len()], |x, y| pixels[y][x], usize::MAX).unwrap();
    let limited = |most| rectangles([pixels[0].len(), pixels.len()], |x, y| pixels[y][x], most);
    assert_eq!(limited(found.len()).as_ref(), Some(&found));
    assert!(found.is_empty() || limited(found.len() - 1).is_none());
    found
}

/// Returns the least number of rectangles that cover the pixels `solid` (bits, row by row) without overlap. Tries every
/// rectangle that begins at the first pixel that is not covered yet.
fn fewest_rectangles(width: usize, height: usize, solid: u32, known: &mut HashMap<u32, u32>) -> u32 {
    if solid == 0 {
        return 0;
    }
    if let Some(&count) = known.get(&solid) {
        return count;
    }
    let first = solid.trailing_zeros() as usize;
    let (x, y) = (first % width, first / width);
    let mut best = u32::MAX;
    for x1 in x + 1..=width {
        for y1 in y + 1..=height {
            let inside = (y..y1).flat_map(|y| (x..x1).map(move |x| 1_u32 << (y * width + x))).fold(0, |a, b| a | b);
            if solid & inside == inside {
                best = best.min(1 + fewest_rectangles(width, height, solid & !inside, known));
            }
        }
    }
    known.insert(solid, best);
    best
}

fn picture() -> impl Strategy<Value = Vec<Vec<bool>>> {
    (1..14_usize, 1..14_usize, 0.0..1.0).prop_flat_map(|(width, height, share)| {
        prop::collection::vec(prop::collection::vec(prop::bool::weighted(share), width), height)
    })
}

proptest! {
    #![proptest_config(cplan_cases::cases(400))]

    #[test]
    fn every_solid_pixel_is_in_one_rectangle_and_no_other_pixel_in_any(pixels in picture()) {
        let mut covered = vec![vec![0; pixels[0].len()]; pixels.len()];
        for r in of(&pixels) {
            prop_assert!(r.rows[0] < r.rows[1] && r.columns[0] < r.columns[1], "{r:?}");
            for row in &mut covered[r.rows[0]..r.rows[1]] {
                row[r.columns[0]..r.columns[1]].iter_mut().for_each(|count| *count += 1);
            }
        }
        for (counts, solids) in covered.iter().zip(&pixels) {
            for (count, solid) in counts.iter().zip(solids) {
                prop_assert_eq!(*count, i32::from(*solid));
            }
        }
    }

    #[test]
    fn random_pictures_need_few_rectangles(width in 3..6_usize, height in 3..6_usize, bits in any::<u32>(), more in any::<u32>()) {
        // The combination of two random numbers fills three quarters, so that there are holes.
        let solid = (bits | more) & ((1_u64 << (width * height)) - 1) as u32;
        let pixels: Vec<Vec<bool>> =
            (0..height).map(|y| (0..width).map(|x| solid >> (y * width + x) & 1 == 1).collect()).collect();
        let least = fewest_rectangles(width, height, solid, &mut HashMap::new());
        let count = of(&pixels).len() as u32;
        prop_assert!(least <= count && count <= 3 * least, "{count} for {least}");
    }
}

#[test]
fn simple_shapes_have_the_least_number_of_rectangles() {
    let parsed = |rows: &[&str]| -> usize {
        of(&rows.iter().map(|r| r.bytes().map(|b| b == b'#').collect()).collect::<Vec<_>>()).len()
    };
    assert_eq!(parsed(&["....", "...."]), 0);
    assert_eq!(parsed(&["####", "####"]), 1);
    assert_eq!(parsed(&["#.#", ".#.", "#.#"]), 5);
    assert_eq!(parsed(&["###", "#.#", "###"]), 4);
    // A comb in any orientation is cut along its back.
    assert_eq!(parsed(&["#####", "#.#.#", "#.#.#"]), 4);
    assert_eq!(parsed(&["###", "#..", "###", "#..", "###"]), 4);
}
