//! Enclosures of real numbers: sums, products, roots, sines and cosines, rounded outward.

use crate::decimal::Decimal;
use num_bigint::{BigInt, Sign};
use std::ops::{Add, Mul, Neg, Sub};
use std::sync::OnceLock;

/// Number of binary digits after the point. The ends of enclosures are multiples of the *unit* `2^-BITS`.
pub const BITS: u32 = 192;

/// An enclosure: all numbers from `lower` to `upper`, in units of `2^-BITS`. The result of an operation on enclosures
/// contains the results of the operation on all numbers in them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Interval {
    /// The least number of the enclosure.
    pub lower: BigInt,
    /// The greatest number of the enclosure.
    pub upper: BigInt,
}

/// A point or a vector in the plane.
pub type Point = [Interval; 2];

/// Returns `a >> bits`, rounded up.
fn shifted_up(a: &BigInt, bits: u32) -> BigInt {
    -(-a >> bits)
}

/// Returns `a / b` for `b > 0`, rounded down.
fn divided_down(a: &BigInt, b: &BigInt) -> BigInt {
    let quotient = a / b;
    if &quotient * b > *a { quotient - 1 } else { quotient }
}

/// Returns `a / b` for `b > 0`, rounded up.
fn divided_up(a: &BigInt, b: &BigInt) -> BigInt {
    -divided_down(&-a, b)
}

impl Interval {
    /// Makes the enclosure of a whole number, which is exact.
    pub fn whole(n: i32) -> Self {
        Self::exact(BigInt::from(n) << BITS)
    }

    /// Returns the enclosure of `n` units, which is exact.
    pub fn exact(n: BigInt) -> Self {
        Self { lower: n.clone(), upper: n }
    }

    /// Makes an enclosure of all numbers from `low` to `high`.
    pub fn enclosing([low, high]: &[Decimal; 2]) -> Self {
        Self { lower: low.floor(BITS), upper: Self::from(high).upper }
    }

    /// Returns true if the enclosure contains the number `n` and no other.
    pub fn is_whole(&self, n: i32) -> bool {
        *self == Self::whole(n)
    }

    /// Returns the greatest absolute value in the enclosure, in units.
    pub fn magnitude(&self) -> BigInt {
        (-&self.lower).max(self.upper.clone())
    }

    /// Returns a number in the middle of the enclosure, and the greater distance of its two ends from there, both in
    /// units.
    pub fn middle(&self) -> (BigInt, BigInt) {
        let middle = (&self.lower + &self.upper) >> 1u32;
        let radius = &self.upper - &middle;
        (middle, radius)
    }

    /// Returns the ends as decimals.
    pub fn ends(&self) -> [Decimal; 2] {
        [&self.lower, &self.upper].map(|end| Decimal::dyadic(end, BITS))
    }

    /// Returns an enclosure of half the value.
    pub fn half(&self) -> Self {
        self.in_halves(1)
    }

    /// Returns an enclosure of the value divided by `2^times`.
    pub fn in_halves(&self, times: u32) -> Self {
        Self { lower: &self.lower >> times, upper: shifted_up(&self.upper, times) }
    }

    /// Returns an enclosure of the absolute value.
    pub fn abs(&self) -> Self {
        match (self.lower.sign(), self.upper.sign()) {
            (Sign::Minus, Sign::Plus) => Self { lower: BigInt::ZERO, upper: self.magnitude() },
            (Sign::Minus, _) => -self,
            _ => self.clone(),
        }
    }

    /// Returns an enclosure of the square root, which is 0 for negative numbers.
    pub fn sqrt(&self) -> Self {
        let root = |n: &BigInt| if n.sign() == Sign::Plus { (n << BITS).sqrt() } else { BigInt::ZERO };
        Self { lower: root(&self.lower), upper: root(&self.upper) + 1 }
    }

    /// Returns an enclosure of the quotient by a positive whole number.
    pub fn over(&self, n: u32) -> Self {
        let n = BigInt::from(n);
        Self { lower: divided_down(&self.lower, &n), upper: divided_up(&self.upper, &n) }
    }

    /// Returns an enclosure of the quotient by a number in a positive enclosure.
    pub fn divided(&self, by: &Self) -> Self {
        assert!(by.lower.sign() == Sign::Plus, "a quotient by a value that may be 0");
        let (lower, upper) = (&self.lower << BITS, &self.upper << BITS);
        let least = if lower.sign() == Sign::Minus { &by.lower } else { &by.upper };
        let most = if upper.sign() == Sign::Minus { &by.upper } else { &by.lower };
        Self { lower: divided_down(&lower, least), upper: divided_up(&upper, most) }
    }

    /// Returns the enclosure widened by `by` units on both sides.
    pub fn widened(&self, by: &BigInt) -> Self {
        Self { lower: &self.lower - by, upper: &self.upper + by }
    }

    /// Cuts the enclosure to the range from -1 to 1.
    fn within_one(self) -> Self {
        let [least, most] = [-1, 1].map(|n| BigInt::from(n) << BITS);
        Self { lower: self.lower.max(least), upper: self.upper.min(most) }
    }

    /// Returns enclosures of sine and cosine.
    ///
    /// Sine and cosine change by at most as much as the angle. So the values at the middle of the enclosure, widened by
    /// its radius, enclose all values. The angle in the middle is halved until it is below 1/16. Taylor's series, whose
    /// terms then alternate and decrease, gives its sine and cosine. Formulas for double angles undo the halvings.
    /// Numbers are truncated after each step, and `error` bounds their deviation in units.
    pub fn sin_cos(&self) -> [Self; 2] {
        let (middle, radius) = self.middle();
        if middle.sign() == Sign::NoSign {
            return [0, 1].map(|n| Self::whole(n).widened(&radius).within_one());
        }
        let (one, none) = (BigInt::from(1) << BITS, BigInt::from(-1) << BITS);
        let angle = BigInt::from(middle.magnitude().clone());
        let halvings = (angle.bits() + 4).saturating_sub(u64::from(BITS)) as u32;
        let x = &angle >> halvings;
        let square = (&x * &x) >> BITS;
        // Each term is the previous one times the truncated square, which is less than 1/256, and is truncated twice. So a term
        // is off by at most about two units. Two extra terms account for the truncated series and for the rounding of the angle.
        let series = |first: &BigInt, from: u32| {
            let (mut sum, mut term, mut terms) = (first.clone(), first.clone(), 2_u32);
            for n in (from..).step_by(2) {
                term = ((term * &square) >> BITS) / (n * (n + 1));
                terms += 1;
                if n / 2 % 2 == from / 2 {
                    sum -= &term
                } else {
                    sum += &term
                }
                if term.bits() <= 1 {
                    break;
                }
            }
            (sum, 2 * terms)
        };
        let ((mut sine, sine_error), (mut cosine, cosine_error)) = (series(&x, 2), series(&one, 1));
        let mut error = BigInt::from(sine_error.max(cosine_error));
        for _ in 0..halvings {
            // Both factors are at most 1, so their product is off by at most the sum of their errors. The product is doubled.
            [sine, cosine] = [(&sine * &cosine) >> (BITS - 1), ((&cosine * &cosine) >> (BITS - 1)) - &one]
                .map(|value| value.clamp(none.clone(), one.clone()));
            error = (error << 2u32) + 1;
        }
        if middle.sign() == Sign::Minus {
            sine = -sine;
        }
        [sine, cosine].map(|value| Self::exact(value).widened(&(&radius + &error)).within_one())
    }

    /// Returns pi, by Machin's formula: `16 atan(1/5) - 4 atan(1/239)`.
    pub fn pi() -> &'static Self {
        static PI: OnceLock<Interval> = OnceLock::new();
        PI.get_or_init(|| {
            let arctangent = |n: u32| {
                let mut power = Self::whole(1).over(n);
                let mut sum = power.clone();
                for k in 1.. {
                    power = power.over(n * n);
                    let term = power.over(2 * k + 1);
                    sum = if k % 2 == 1 { &sum - &term } else { &sum + &term };
                    if term.upper <= BigInt::from(1) {
                        break;
                    }
                }
                sum.widened(&BigInt::from(1))
            };
            &(&arctangent(5) * &Self::whole(16)) - &(&arctangent(239) * &Self::whole(4))
        })
    }
}

impl From<&Decimal> for Interval {
    fn from(number: &Decimal) -> Self {
        Self { lower: number.floor(BITS), upper: -(-number).floor(BITS) }
    }
}

impl Add for &Interval {
    type Output = Interval;
    fn add(self, other: Self) -> Interval {
        Interval { lower: &self.lower + &other.lower, upper: &self.upper + &other.upper }
    }
}

impl Neg for &Interval {
    type Output = Interval;
    fn neg(self) -> Interval {
        Interval { lower: -&self.upper, upper: -&self.lower }
    }
}

impl Sub for &Interval {
    type Output = Interval;
    fn sub(self, other: Self) -> Interval {
        Interval { lower: &self.lower - &other.upper, upper: &self.upper - &other.lower }
    }
}

impl Mul for &Interval {
    type Output = Interval;
    fn mul(self, other: Self) -> Interval {
        let is_negative = |n: &BigInt| n.sign() == Sign::Minus;
        // Unless a factor contains 0 in its interior, the signs determine which ends give the least and the greatest product.
        let negative = [self, other].map(|factor| is_negative(&factor.lower));
        if [self, other].map(|factor| is_negative(&factor.upper)) == negative {
            let [(a, b), (c, d)] = [(self, negative[1]), (other, negative[0])].map(|(factor, is_turned)| {
                let Interval { lower, upper } = factor;
                if is_turned { (upper, lower) } else { (lower, upper) }
            });
            return Interval { lower: (a * c) >> BITS, upper: shifted_up(&(b * d), BITS) };
        }
        let products = [
            &self.lower * &other.lower,
            &self.lower * &other.upper,
            &self.upper * &other.lower,
            &self.upper * &other.upper,
        ];
        let [least, most] = [products.iter().min(), products.iter().max()].map(|p| p.expect("four products"));
        Interval { lower: least >> BITS, upper: shifted_up(most, BITS) }
    }
}

/// Returns an enclosure of twice a number.
pub fn double(a: &Interval) -> Interval {
    a + a
}

/// Returns the sum of two vectors.
pub fn sum(a: &Point, b: &Point) -> Point {
    [&a[0] + &b[0], &a[1] + &b[1]]
}

/// Returns the difference of two vectors.
pub fn minus(a: &Point, b: &Point) -> Point {
    [&a[0] - &b[0], &a[1] - &b[1]]
}

/// Returns a vector times a number.
pub fn times(a: &Point, factor: &Interval) -> Point {
    [&a[0] * factor, &a[1] * factor]
}

/// Turns a vector to the left by an angle, given the angle's sine and cosine.
pub fn turned([x, y]: &Point, [sine, cosine]: &[Interval; 2]) -> Point {
    [&(x * cosine) - &(y * sine), &(x * sine) + &(y * cosine)]
}

/// Returns the sine and cosine of the sum of two angles, given the sine and cosine of each.
pub fn both_turns([s, c]: &[Interval; 2], [t, d]: &[Interval; 2]) -> [Interval; 2] {
    [&(s * d) + &(c * t), &(c * d) - &(s * t)]
}

/// Returns the scalar product of two vectors.
pub fn dot(a: &Point, b: &Point) -> Interval {
    &(&a[0] * &b[0]) + &(&a[1] * &b[1])
}

/// Returns the length of a vector.
pub fn length([x, y]: &Point) -> Interval {
    let [x, y] = [x.abs(), y.abs()];
    (&(&x * &x) + &(&y * &y)).sqrt()
}

// The following functions guess in floating point. Checks use guesses as directions to try, and decide nothing by them.

/// Binary digits after the point that a number keeps when it is converted to floating point.
const GUESS_BITS: u32 = 44;

/// Converts a number of units to floating point, approximately. Returns NaN if it is too large.
pub fn roughly(n: &BigInt) -> f64 {
    i64::try_from(n >> (BITS - GUESS_BITS)).map_or(f64::NAN, |n| n as f64 / (1u64 << GUESS_BITS) as f64)
}

/// Converts a point to floating point, approximately.
pub fn rough(p: &Point) -> [f64; 2] {
    p.each_ref().map(|c| roughly(&c.lower))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Interval {
        Interval::from(&text.parse::<Decimal>().unwrap())
    }

    /// Returns true if the enclosure contains the number that begins with these digits, and is no wider than `2^-155`.
    fn encloses_digits(interval: &Interval, digits: &str) -> bool {
        let [low, high] = interval.ends();
        let from: Decimal = digits.parse().unwrap();
        let last = Decimal::dyadic(&BigInt::from(1), 150);
        &high - &low < Decimal::dyadic(&BigInt::from(1), 155) && low < &from + &last && high > &from - &last
    }

    // Digits from published tables (A000796, A049469, A049470), and for other angles from the addition theorems.
    #[test]
    fn known_digits_are_enclosed() {
        assert!(encloses_digits(Interval::pi(), "3.14159265358979323846264338327950288419716939937510582097494459"));
        let [sine, cosine] = of("1").sin_cos();
        assert!(encloses_digits(&sine, "0.84147098480789650665250232163029899962256306079837106567275171"));
        assert!(encloses_digits(&cosine, "0.54030230586813971740093660744297660373231042061792222767009725"));
    }

    #[test]
    fn special_angles_have_their_closed_forms() {
        let pi = Interval::pi();
        let [sine, cosine] = pi.over(6).sin_cos();
        assert!(encloses_digits(&sine, "0.5") && encloses_digits(&(&(&cosine * &cosine) * &Interval::whole(4)), "3"));
        let [sine, cosine] = pi.sin_cos();
        assert!(encloses_digits(&sine, "0") && encloses_digits(&cosine, "-1"));
        let [sine, cosine] = (-&pi.over(4)).sin_cos();
        assert!(encloses_digits(&(&sine * &cosine), "-0.5") && encloses_digits(&(&sine + &cosine), "0"));
        // The enclosure of a huge angle contains no information about its sine.
        let [sine, _] = Interval::exact(BigInt::from(-7).pow(1100)).sin_cos();
        assert_eq!(sine.abs().upper, Interval::whole(1).upper);
        let turns = &(pi * &Interval::whole(200)) + &pi.half();
        assert!(encloses_digits(&turns.sin_cos()[0], "1"));
        let [sine, cosine] = Interval::whole(0).sin_cos();
        assert!(sine.is_whole(0) && cosine.is_whole(1));
    }

    #[test]
    fn every_operation_encloses_the_exact_result() {
        let third = Interval::whole(1).over(3);
        assert!(third.lower < third.upper && encloses_digits(&(&third * &Interval::whole(3)), "1"));
        assert!(encloses_digits(
            &Interval::whole(2).sqrt(),
            "1.41421356237309504880168872420969807856967187537694807317667973"
        ));
        assert!(encloses_digits(
            &Interval::whole(-2).divided(&Interval::whole(7)),
            "-0.2857142857142857142857142857142857142857142857142857"
        ));
        assert!(encloses_digits(&(&of("-0.1") * &of("0.1")), "-0.01") && encloses_digits(&of("-0.3").abs(), "0.3"));
        let wide = Interval { lower: Interval::whole(-2).lower, upper: Interval::whole(3).upper };
        let product = &wide * &wide;
        assert_eq!(product, Interval { lower: Interval::whole(-6).lower, upper: Interval::whole(9).upper });
        assert_eq!(wide.abs(), Interval { lower: BigInt::ZERO, upper: Interval::whole(3).upper });
        assert!(encloses_digits(&length(&[of("-0.3"), of("0.4")]), "0.5"));
    }
}
