//! Decimal numbers without rounding.

use num_bigint::{BigInt, Sign};
use serde::{Deserialize, Deserializer};
use serde_json::value::RawValue;
use std::cmp::Ordering;
use std::fmt;
use std::ops::{Add, Mul, Neg, Sub};
use std::str::FromStr;

/// Maximum number of digits of a number, and maximum of its decimal exponent. Doubles need fewer digits, and
/// computations with such numbers are still fast.
const MAX_DIGITS: usize = 1100;

/// Maximum number of digits before the point of numbers in robots and worlds. Larger numbers have no meaning, and could
/// make computations slow.
const MAX_NUMBER_DIGITS: u32 = 15;

/// The number `mantissa * 10^-scale`. Every decimal number and every dyadic fraction has this form. Sums and products are exact.
#[derive(Debug, Clone, Default)]
pub struct Decimal {
    mantissa: BigInt,
    scale: u32,
}

impl Decimal {
    /// Makes `mantissa / 2^bits`.
    pub fn dyadic(mantissa: &BigInt, bits: u32) -> Self {
        Self { mantissa: mantissa * BigInt::from(5).pow(bits), scale: bits }
    }

    /// Reads a number from the file of a robot or a world.
    ///
    /// # Errors
    /// If the text is not a number, or if the number is too large.
    pub fn read(text: &str) -> Result<Self, String> {
        let number: Self = text.parse()?;
        let largest = Self { mantissa: BigInt::from(10).pow(MAX_NUMBER_DIGITS), scale: 0 };
        match number < largest && -&number < largest {
            true => Ok(number),
            false => Err(format!("\"{text}\" is not below 1e{MAX_NUMBER_DIGITS}")),
        }
    }

    /// Makes a whole number.
    pub fn whole(n: i32) -> Self {
        Self { mantissa: n.into(), scale: 0 }
    }

    /// Returns the middle of two numbers.
    pub fn middle(a: &Self, b: &Self) -> Self {
        let Self { mantissa, scale } = a + b;
        Self { mantissa: mantissa * 5, scale: scale + 1 }
    }

    /// Makes `10^-digits`.
    pub fn power_of_ten(digits: u32) -> Self {
        Self { mantissa: 1.into(), scale: digits }
    }

    /// Returns the sign.
    pub fn sign(&self) -> Sign {
        self.mantissa.sign()
    }

    /// Returns the number rounded down to a multiple of `2^-bits`, in that unit.
    pub fn floor(&self, bits: u32) -> BigInt {
        let (numerator, denominator) = (&self.mantissa << bits, BigInt::from(10).pow(self.scale));
        let quotient = &numerator / &denominator;
        // Division truncates towards 0.
        if &quotient * denominator > numerator { quotient - 1 } else { quotient }
    }

    /// Returns the mantissas of both numbers at the greater of the two scales.
    fn aligned(&self, other: &Self) -> (BigInt, BigInt) {
        let scale = self.scale.max(other.scale);
        let of = |number: &Self| match scale - number.scale {
            0 => number.mantissa.clone(),
            finer => &number.mantissa * BigInt::from(10).pow(finer),
        };
        (of(self), of(other))
    }
}

impl FromStr for Decimal {
    type Err = String;

    /// Parses digits with an optional sign, point and exponent, as in TOML, JSON and XML.
    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("\"{text}\" is not a decimal number");
        let (number, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
        let (whole, fraction) = number.split_once('.').unwrap_or((number, ""));
        let (sign, whole) = match whole.strip_prefix('-') {
            Some(rest) => (-1, rest),
            None => (1, whole.strip_prefix('+').unwrap_or(whole)),
        };
        let digits = [whole, fraction].concat();
        if digits.is_empty() || !digits.bytes().all(|b| b.is_ascii_digit()) {
            return Err(wrong());
        }
        let exponent: i64 = exponent.parse().map_err(|_| wrong())?;
        let scale = fraction.len() as i64 - exponent.clamp(-1 << 32, 1 << 32);
        if digits.len() > MAX_DIGITS || scale.unsigned_abs() > MAX_DIGITS as u64 {
            return Err(format!("\"{text}\" has more than {MAX_DIGITS} digits"));
        }
        let mantissa = digits.parse::<BigInt>().map_err(|_| wrong())? * sign;
        Ok(match u32::try_from(scale) {
            Ok(scale) => Self { mantissa, scale },
            Err(_) => Self { mantissa: mantissa * BigInt::from(10).pow(scale.unsigned_abs() as u32), scale: 0 },
        })
    }
}

impl<'de> Deserialize<'de> for Decimal {
    /// Reads a JSON number by its text.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = <&RawValue>::deserialize(deserializer)?;
        text.get().parse().map_err(serde::de::Error::custom)
    }
}

impl fmt::Display for Decimal {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let scale = self.scale as usize;
        let digits = format!("{:0>width$}", self.mantissa.magnitude().to_string(), width = scale + 1);
        let (whole, fraction) = digits.split_at(digits.len() - scale);
        let sign = if self.sign() == Sign::Minus { "-" } else { "" };
        let fraction = fraction.trim_end_matches('0');
        write!(f, "{sign}{whole}{}{fraction}", if fraction.is_empty() { "" } else { "." })
    }
}

impl Add for &Decimal {
    type Output = Decimal;
    fn add(self, other: Self) -> Decimal {
        let (a, b) = self.aligned(other);
        Decimal { mantissa: a + b, scale: self.scale.max(other.scale) }
    }
}

impl Neg for &Decimal {
    type Output = Decimal;
    fn neg(self) -> Decimal {
        Decimal { mantissa: -&self.mantissa, scale: self.scale }
    }
}

impl Sub for &Decimal {
    type Output = Decimal;
    fn sub(self, other: Self) -> Decimal {
        self + &-other
    }
}

impl Mul for &Decimal {
    type Output = Decimal;
    fn mul(self, other: Self) -> Decimal {
        Decimal { mantissa: &self.mantissa * &other.mantissa, scale: self.scale + other.scale }
    }
}

impl PartialEq for Decimal {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Decimal {}

impl PartialOrd for Decimal {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Decimal {
    fn cmp(&self, other: &Self) -> Ordering {
        if self.scale == other.scale {
            return self.mantissa.cmp(&other.mantissa);
        }
        let (a, b) = self.aligned(other);
        a.cmp(&b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(text: &str) -> Decimal {
        text.parse().unwrap()
    }

    #[test]
    fn text_is_read_without_rounding() {
        for (text, shown) in [
            ("0.1", "0.1"),
            ("-0.50", "-0.5"),
            ("+12", "12"),
            ("1e-3", "0.001"),
            ("-2.5E+2", "-250"),
            (".5", "0.5"),
            ("5.", "5"),
            ("0.1000000000000000055511151231257827", "0.1000000000000000055511151231257827"),
        ] {
            assert_eq!(number(text).to_string(), shown, "{text}");
        }
        for text in ["", ".", "-", "nan", "inf", "0x10", "1e", "1e1e1", "1 2", "--1", "1e999999999", "1e-99999999999"] {
            assert!(text.parse::<Decimal>().is_err(), "{text}");
        }
    }

    #[test]
    fn arithmetic_is_exact() {
        assert_eq!(&number("0.1") + &number("0.2"), number("0.3"));
        assert_eq!(&number("0.1") * &number("0.1"), number("0.01"));
        assert_eq!(&number("1") - &number("1e-30"), number("0.999999999999999999999999999999"));
        assert_eq!(Decimal::middle(&number("0.1"), &number("0.2")), number("0.15"));
        assert_eq!(Decimal::dyadic(&BigInt::from(-3), 3), number("-0.375"));
        assert!(number("0.1") < number("0.10000000000000000001") && number("-1") < number("0.0"));
        assert_eq!((number("-0.3").floor(2), number("0.3").floor(2)), (BigInt::from(-2), BigInt::from(1)));
        assert_eq!(number("-0.25").floor(2), BigInt::from(-1));
    }
}
