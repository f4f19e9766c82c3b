//! Compares texts up to the last digit of each number, which may differ on a machine whose sine differs in the last
//! bit.

/// Splits a text into numbers and the text between them. The second value is true for numbers.
fn parts(text: &str) -> Vec<(bool, &str)> {
    let in_number = |c: char| c.is_ascii_digit() || c == '.' || c == '-';
    let mut parts = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let numeric = in_number(first);
        let (part, after) = rest.split_at(rest.find(|c| in_number(c) != numeric).unwrap_or(rest.len()));
        // Dots and hyphens in words are not numbers.
        parts.push((numeric && part.parse::<f64>().is_ok(), part));
        rest = after;
    }
    parts
}

/// Returns the number of digits behind the point.
fn decimals(number: &str) -> i32 {
    number.split_once('.').map_or(0, |(_, digits)| i32::try_from(digits.len()).expect("a short number"))
}

/// Returns true if two numbers differ by at most one unit of the last decimal of either of them. Integers must be
/// equal.
fn near(a: &str, b: &str) -> bool {
    let unit = match decimals(a).max(decimals(b)) {
        0 => 0.0,
        digits => 1.01 * 10f64.powi(-digits),
    };
    let value = |text: &str| text.parse::<f64>().expect("a number");
    (value(a) - value(b)).abs() <= unit
}

/// Returns true if two texts are equal up to rounding.
pub fn same(a: &str, b: &str) -> bool {
    let (a, b) = (parts(a), parts(b));
    a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| if a.0 && b.0 { near(a.1, b.1) } else { a == b })
}

#[test]
fn only_the_last_digit_may_differ() {
    assert_eq!(parts("x=-1.5 a-b"), [(false, "x="), (true, "-1.5"), (false, " a"), (false, "-"), (false, "b")]);
    for (a, b) in [("a-b 1.23 m", "a-b 1.24 m"), ("20", "19.99"), ("1.000 x", "1.001 x"), ("12 rows", "12 rows")] {
        assert!(same(a, b), "{a}, {b}");
    }
    for (a, b) in [("1.23", "1.25"), ("12 rows", "13 rows"), ("1.0 m", "1.0 s"), ("1.0", "1.0 "), ("a-b", "a.b")] {
        assert!(!same(a, b), "{a}, {b}");
    }
}
