//! The word that a misspelled one was probably meant to be.

use strsim::osa_distance;

/// Share of a word's letters that may be wrong. With more, any short word would resemble another.
const LETTERS_PER_SLIP: usize = 3;

/// Returns the known word that is nearest to a misspelled one, if a slip of the keyboard explains the difference: one
/// letter in three that is wrong, missing, added or exchanged with its neighbour. Capital and small letters count as
/// equal.
pub fn nearest_word<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word = word.to_lowercase();
    let most = word.chars().count().div_ceil(LETTERS_PER_SLIP);
    let distances = known.into_iter().map(|known| (osa_distance(&word, &known.to_lowercase()), known));
    let near = distances.filter(|(distance, known)| *distance <= most && *distance < known.chars().count());
    near.min_by_key(|(distance, _)| *distance).map(|(_, known)| known)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_have_a_nearest_word() {
        let words = ["polygon", "polyline", "circle", "at", "clearance"];
        let near = |word| nearest_word(word, words);
        assert_eq!(near("poligon"), Some("polygon"));
        assert_eq!(near("ploygon"), Some("polygon"));
        assert_eq!(near("polygons"), Some("polygon"));
        assert_eq!(near("Circle"), Some("circle"));
        assert_eq!(near("clearence"), Some("clearance"));
        assert_eq!(near("ta"), Some("at"));
        for other in ["", "x", "radius", "box", "shape"] {
            assert_eq!(near(other), None, "{other}");
        }
    }
}
