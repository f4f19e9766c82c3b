//! Formats text for people: safe names, markup, numbers, counts, long lists, columns, wrapped lines and units of
//! length, and finds the nearest word to a misspelled one. Also reads and writes infinite numbers in data. This crate uses no other crate of the workspace.

mod base64;
mod columns;
mod markup;
mod nearest;
pub mod number;
mod plain;
mod rounded;
mod shell;
mod unit;
mod wrapped;

pub use base64::base64;
pub use columns::{Columns, SECOND_COLUMN};
pub use markup::markup;
pub use nearest::nearest_word;
pub use plain::{plain, plain_json, plain_line};
pub use rounded::{
    chosen_length, fixed, format_distinct, headline_length, headline_number, length, length_down, length_unlike,
    length_up, nonzero, percent, round_down, round_up, short,
};
pub use shell::for_a_shell;
pub use unit::{Unit, UnknownUnit, metres};
pub use wrapped::wrapped;

/// Formats a count with its noun: `1 obstacle`, `3 obstacles`, `2 boxes`.
pub fn counted(count: usize, thing: &str) -> String {
    let ending = match count {
        1 => "",
        _ if thing.ends_with('x') => "es",
        _ => "s",
    };
    format!("{count} {thing}{ending}")
}

/// Largest number of reasons that are listed. Further ones are only counted.
const MAX_LISTED_REASONS: usize = 6;

/// Joins reasons by semicolons. If there are many, lists the first ones: `a; b; and 12 more`.
pub fn listed(reasons: &[String]) -> String {
    let [first, more] =
        [&reasons[..reasons.len().min(MAX_LISTED_REASONS)], &reasons[reasons.len().min(MAX_LISTED_REASONS)..]];
    let rest = (!more.is_empty()).then(|| format!("and {} more", more.len()));
    first.iter().cloned().chain(rest).collect::<Vec<_>>().join("; ")
}

/// Joins names: `a, b and c`.
pub fn joined(names: &[String]) -> String {
    match names {
        [all @ .., before, last] => {
            let all: String = all.iter().map(|one| format!("{one}, ")).collect();
            format!("{all}{before} and {last}")
        }
        _ => names.concat(),
    }
}

/// Returns the lines. If there are many, returns the first ones, and then the line that `more` returns for the number
/// of the others.
pub fn first_lines(lines: Vec<String>, more: impl Fn(usize) -> String) -> Vec<String> {
    let rest = lines.len().saturating_sub(MAX_LISTED_REASONS);
    lines.into_iter().take(MAX_LISTED_REASONS).chain((rest > 0).then(|| more(rest))).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn long_lists_are_cut() {
        let reasons = |count: usize| (0..count).map(|k| k.to_string()).collect::<Vec<_>>();
        assert_eq!(super::listed(&reasons(6)), "0; 1; 2; 3; 4; 5");
        assert_eq!(super::listed(&reasons(8)), "0; 1; 2; 3; 4; 5; and 2 more");
        assert_eq!(super::listed(&[]), "");
        assert_eq!(super::joined(&reasons(3)), "0, 1 and 2");
        assert_eq!(super::joined(&reasons(1)), "0");
        assert_eq!(super::first_lines(reasons(7), |n| format!("{n} others"))[6], "1 others");
        assert_eq!(super::first_lines(reasons(6), |n| format!("{n} others")).len(), 6);
    }

    #[test]
    fn one_thing_is_singular() {
        assert_eq!([0, 1, 2].map(|n| super::counted(n, "row")), ["0 rows", "1 row", "2 rows"]);
        assert_eq!([1, 2].map(|n| super::counted(n, "box")), ["1 box", "2 boxes"]);
    }
}
