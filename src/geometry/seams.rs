//! Where the convex pieces of one shape adjoin.

use super::{Convex, Orientation, Point, orientation};

/// What every piece shares with the sides of the others: the ends of each common stretch, moved towards each other by
/// `short`, or where they would meet. None of rounded pieces. `O(n^2)` for `n` sides, most of which a look at their boxes tells
/// apart.
pub(crate) fn seams(pieces: &[Convex], short: f64) -> Vec<Vec<Point>> {
    let mut ends = vec![Vec::new(); pieces.len()];
    for (i, one) in pieces.iter().enumerate() {
        for (j, other) in pieces.iter().enumerate().skip(i + 1) {
            for side in sides(one) {
                for stretch in sides(other).filter_map(|with| common(side, with)) {
                    let [from, to] = shortened(stretch, short);
                    ends[i].extend([from, to]);
                    ends[j].extend([from, to]);
                }
            }
        }
    }
    ends
}

fn sides(shape: &Convex) -> impl Iterator<Item = [Point; 2]> + '_ {
    let core = if shape.radius() == 0.0 { shape.core() } else { &[] };
    (0..core.len()).map(|i| [core[i], core[(i + 1) % core.len()]])
}

/// The stretch that two sides on one line have in common.
fn common([a, b]: [Point; 2], [c, d]: [Point; 2]) -> Option<[Point; 2]> {
    let apart = |k: usize| a[k].max(b[k]) < c[k].min(d[k]) || c[k].max(d[k]) < a[k].min(b[k]);
    let on_line = |p| orientation(a, b, p) == Orientation::Collinear;
    if apart(0) || apart(1) || !on_line(c) || !on_line(d) {
        return None;
    }
    // Along the axis in which they are longer the corners have an order, whatever the rounding.
    let axis = usize::from((b - a).x.abs() < (b - a).y.abs());
    let ordered = |p: Point, q: Point| if p[axis] <= q[axis] { [p, q] } else { [q, p] };
    let ([first, last], [from, to]) = (ordered(a, b), ordered(c, d));
    let (start, end) = (ordered(first, from)[1], ordered(last, to)[0]);
    (start[axis] < end[axis]).then_some([start, end])
}

fn shortened([from, to]: [Point; 2], by: f64) -> [Point; 2] {
    let way = to - from;
    let share = (by / way.norm()).min(0.5);
    if share == 0.5 { [from + way / 2.0; 2] } else { [from + way * share, to - way * share] }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rectangle([x, y]: [f64; 2], [right, top]: [f64; 2]) -> Convex {
        let corners = [(x, y), (right, y), (right, top), (x, top)];
        Convex::trusted(corners.map(|(x, y)| Point::new(x, y)).to_vec(), 0.0)
    }

    #[test]
    fn pieces_share_what_their_sides_have_in_common() {
        // A bar, a smaller one upon it, and one that touches a corner alone.
        let pieces = [
            rectangle([0., 0.], [4., 1.]),
            rectangle([1., 1.], [2., 2.]),
            rectangle([4., 1.], [5., 2.]),
            rectangle([0., 1.], [0.5, 2.]),
        ];
        let ends = seams(&pieces, 0.25);
        let bar = [1.25, 1.75, 0.25, 0.25].map(|x| Point::new(x, 1.0));
        assert_eq!(ends, [bar.to_vec(), bar[..2].to_vec(), Vec::new(), bar[2..].to_vec()]);
        assert_eq!(seams(&pieces.map(|piece| piece.grown(0.1)), 0.25), vec![Vec::new(); 4]);
    }
}
