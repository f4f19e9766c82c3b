//! Text for people: what is shown of names, markup, numbers of things, two columns; and infinite numbers in data. Imports nothing, and all may import it.

#[cfg(feature = "live")]
mod base64;
mod columns;
mod markup;
pub mod number;
mod plain;

#[cfg(feature = "live")]
pub use base64::base64;
pub use columns::Columns;
pub use markup::markup;
#[cfg(feature = "program")]
pub use plain::plain_json;
pub use plain::{plain, plain_line};

/// A number of things: `1 obstacle`, `3 obstacles`.
#[must_use]
pub fn counted(count: usize, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    #[test]
    fn one_thing_is_singular() {
        assert_eq!([0, 1, 2].map(|n| super::counted(n, "row")), ["0 rows", "1 row", "2 rows"]);
    }
}
