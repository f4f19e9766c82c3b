//! Rotations and translations.

use cplan_check::interval::Interval;

pub type Vector = [Interval; 3];

/// A rotation, given by its rows, and a translation.
#[derive(Clone)]
pub struct Pose {
    pub rows: [Vector; 3],
    pub at: Vector,
}

pub fn dot(a: &Vector, b: &Vector) -> Interval {
    &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
}

pub fn cross(a: &Vector, b: &Vector) -> Vector {
    let minor = |i: usize, j: usize| &(&a[i] * &b[j]) - &(&a[j] * &b[i]);
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// Returns the length of a vector.
pub fn size(v: &Vector) -> Interval {
    dot(v, v).sqrt()
}

impl Pose {
    pub fn identity() -> Self {
        let whole = |n: [i32; 3]| n.map(Interval::whole);
        Self { rows: [whole([1, 0, 0]), whole([0, 1, 0]), whole([0, 0, 1])], at: whole([0, 0, 0]) }
    }

    /// Makes a rotation by an angle about an axis of unit length (Rodrigues' formula).
    pub fn turn(axis: &Vector, angle: &Interval) -> Self {
        let [sine, cosine] = angle.sin_cos();
        let rest = &Interval::whole(1) - &cosine;
        let entry = |i: usize, j: usize| {
            let product = &axis[i] * &axis[j];
            match (3 + j - i) % 3 {
                // This gives exactly 1 for a coordinate along the axis.
                0 => &Interval::whole(1) - &(&rest * &(&Interval::whole(1) - &product)),
                1 => &(&rest * &product) - &(&sine * &axis[3 - i - j]),
                _ => &(&rest * &product) + &(&sine * &axis[3 - i - j]),
            }
        };
        let rows = [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)));
        Self { rows, at: [0, 0, 0].map(Interval::whole) }
    }

    pub fn direction(&self, v: &Vector) -> Vector {
        [0, 1, 2].map(|i| dot(&self.rows[i], v))
    }

    pub fn point(&self, p: &Vector) -> Vector {
        let turned = self.direction(p);
        [0, 1, 2].map(|i| &turned[i] + &self.at[i])
    }

    pub fn compose(&self, inner: &Self) -> Self {
        let column = |j: usize| [0, 1, 2].map(|k| inner.rows[k][j].clone());
        let rows = [0, 1, 2].map(|i| [0, 1, 2].map(|j| dot(&self.rows[i], &column(j))));
        Self { rows, at: self.point(&inner.at) }
    }
}
