//! The position of the tip, and its second derivative.

use cplan_check::arm::{Arm, Motion};
use cplan_check::interval::{Interval, Point, double, sum, times, turned};

/// A vector with its first and second derivative.
type Jet = [Point; 3];

fn zero() -> Point {
    [0, 0].map(Interval::whole)
}

fn left([x, y]: &Point) -> Point {
    [-y, x.clone()]
}

/// Returns the jet of a vector after the motion of a joint, whose value has the given derivatives.
fn moved(motion: &Motion, [value, rate, bend]: [&Interval; 3], [at, first, second]: Jet) -> Jet {
    match motion {
        Motion::Slide(along) => {
            [sum(&at, &times(along, value)), sum(&first, &times(along, rate)), sum(&second, &times(along, bend))]
        }
        Motion::Turn(sign) => {
            let sign = Interval::whole(*sign);
            let turn = (&sign * value).sin_cos();
            let (rate, bend) = (&sign * rate, &sign * bend);
            let pushed = sum(&times(&left(&first), &double(&rate)), &times(&left(&at), &bend));
            let pulled = times(&at, &-&(&rate * &rate));
            let inner = [sum(&first, &times(&left(&at), &rate)), sum(&second, &sum(&pushed, &pulled))];
            let [first, second] = inner.map(|v| turned(&v, &turn));
            [turned(&at, &turn), first, second]
        }
    }
}

/// Returns the position of the tip and its first and second derivative, for joint values with these derivatives.
pub fn jet(arm: &Arm, [q, rates, bends]: [&Point; 3]) -> Jet {
    let of = |k: usize| [&q[k], &rates[k], &bends[k]];
    let [at, first, second] = moved(&arm.joints[1].motion, of(1), [arm.tip.shape.points[0].clone(), zero(), zero()]);
    let [at, first, second] = moved(&arm.joints[0].motion, of(0), [sum(&arm.offset, &at), first, second]);
    [sum(&arm.base, &at), first, second]
}

/// Returns the position of the tip.
pub fn at(arm: &Arm, q: &Point) -> Point {
    let [at, ..] = jet(arm, [q, &zero(), &zero()]);
    at
}
