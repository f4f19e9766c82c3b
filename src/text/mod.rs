//! Text for people: what is shown of names, markup, numbers of things, two columns, lines of a width; and infinite numbers in data. Imports nothing, and all may import it.

#[cfg(feature = "live")]
mod base64;
mod columns;
mod markup;
pub mod number;
mod plain;
mod rounded;
mod wrapped;

#[cfg(feature = "live")]
pub use base64::base64;
pub use columns::{Columns, INDENT};
pub use markup::markup;
#[cfg(feature = "program")]
pub use plain::plain_json;
pub use plain::{plain, plain_line};
#[cfg(feature = "program")]
pub use rounded::at_most;
pub use rounded::{at_least, percent, short};
pub use wrapped::wrapped;

/// A number of things: `1 obstacle`, `3 obstacles`, `2 boxes`.
#[must_use]
pub fn counted(count: usize, thing: &str) -> String {
    let ending = match count {
        1 => "",
        _ if thing.ends_with('x') => "es",
        _ => "s",
    };
    format!("{count} {thing}{ending}")
}

#[cfg(test)]
mod tests {
    #[test]
    fn one_thing_is_singular() {
        assert_eq!([0, 1, 2].map(|n| super::counted(n, "row")), ["0 rows", "1 row", "2 rows"]);
        assert_eq!([1, 2].map(|n| super::counted(n, "box")), ["1 box", "2 boxes"]);
    }
}
