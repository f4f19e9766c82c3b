//! The spacing of control points along a stretch. It is dense where the line bends, and changes gradually.

/// Greatest change of the spacing per distance. If the spacing changes gradually, so does the rate at which a motion
/// passes the control points.
const GRADIENT: f64 = 0.15;

/// Number of neighbours on each side that enter an average. Spacings are averaged twice.
const SMOOTHING: usize = 4;

/// Factor by which the spacing is reduced where a curve is too far from the line.
const REFINEMENT: f64 = 0.6;

/// The spacing as a function of the distance along a stretch, piecewise linear.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Spacing {
    /// The wanted spacing, as pairs of a distance and the spacing there. Distances increase from 0 to the length of the stretch.
    wanted: Vec<[f64; 2]>,
    /// The smooth spacing, in the same form.
    smooth: Vec<[f64; 2]>,
}

impl Spacing {
    /// Creates a smooth spacing with a limited gradient. It never exceeds the wanted one. The places are pairs of a
    /// distance and a spacing, both positive except the first distance. Distances increase.
    pub fn new(mut places: Vec<[f64; 2]>) -> Self {
        let limit = |before: [f64; 2], place: &mut [f64; 2]| {
            place[1] = place[1].min(before[1] + GRADIENT * (place[0] - before[0]).abs());
        };
        for i in 1..places.len() {
            let before = places[i - 1];
            limit(before, &mut places[i]);
        }
        for i in (1..places.len()).rev() {
            let after = places[i];
            limit(after, &mut places[i - 1]);
        }
        let smooth = smoothed(&places);
        Self { wanted: places, smooth }
    }

    /// Returns the distances of control points with this spacing, from 0 to the length of the stretch.
    pub fn distances(&self) -> Vec<f64> {
        distances(&self.smooth)
    }

    /// Returns a smaller spacing around the marked points of [`Spacing::distances`].
    pub fn finer(&self, distances: &[f64], is_marked: &[bool]) -> Self {
        let [wanted, smooth] = [&self.wanted, &self.smooth].map(|places| spacings(places, distances));
        let own = |k: usize| if is_marked[k] { REFINEMENT * smooth[k] } else { wanted[k] };
        let places = distances.iter().enumerate().map(|(k, &distance)| [distance, own(k)]).collect();
        Self::new(places)
    }
}

/// Returns the distances of points with a spacing, from 0 to the length of the stretch.
fn distances(places: &[[f64; 2]]) -> Vec<f64> {
    let segments: Vec<Segment> = places.windows(2).map(Segment::new).collect();
    let total: f64 = segments.iter().map(|segment| segment.count).sum();
    let count = total.ceil().max(1.0);
    let mut distances = Vec::with_capacity(count as usize + 1);
    let (mut segment, mut before) = (0, 0.0);
    for k in 0..count as usize {
        let number = k as f64 * total / count;
        while segment + 1 < segments.len() && before + segments[segment].count < number {
            before += segments[segment].count;
            segment += 1;
        }
        distances.push(segments[segment].distance(number - before));
    }
    distances.push(places[places.len() - 1][0]);
    distances
}

/// Returns a smoother spacing that never exceeds the given one: the least spacing among neighbours, averaged over the
/// same neighbours.
fn smoothed(places: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let distances = distances(places);
    let own = spacings(places, &distances);
    let around = |k: usize, half: usize| k.saturating_sub(half)..(k + half + 1).min(own.len());
    let least = |k: usize| own[around(k, 2 * SMOOTHING)].iter().copied().fold(f64::INFINITY, f64::min);
    let mut spacings: Vec<f64> = (0..own.len()).map(least).collect();
    for _ in 0..2 {
        let mean = |k: usize| {
            let near = &spacings[around(k, SMOOTHING)];
            near.iter().sum::<f64>() / near.len() as f64
        };
        spacings = (0..own.len()).map(mean).collect();
    }
    distances.into_iter().zip(spacings).map(|(distance, spacing)| [distance, spacing]).collect()
}

/// Interpolates the spacings at increasing distances.
fn spacings(places: &[[f64; 2]], distances: &[f64]) -> Vec<f64> {
    let mut segment = 0;
    let spacing = |&distance: &f64| {
        while segment + 2 < places.len() && places[segment + 1][0] < distance {
            segment += 1;
        }
        Segment::new(&places[segment..segment + 2]).spacing(distance)
    };
    distances.iter().map(spacing).collect()
}

/// A part of a stretch on which the spacing is linear.
struct Segment {
    from: f64,
    spacing: f64,
    gradient: f64,
    /// Number of spacings on the part.
    count: f64,
}

impl Segment {
    fn new(ends: &[[f64; 2]]) -> Self {
        let ([from, spacing], [to, end]) = (ends[0], ends[1]);
        let growth = (end - spacing) / spacing;
        let share = if growth.abs() < 1e-9 { 1.0 } else { growth.ln_1p() / growth };
        Self { from, spacing, gradient: (end - spacing) / (to - from), count: (to - from) / spacing * share }
    }

    fn spacing(&self, distance: f64) -> f64 {
        self.spacing + self.gradient * (distance - self.from)
    }

    /// Returns the distance that is `number` spacings from the beginning.
    fn distance(&self, number: f64) -> f64 {
        let growth = self.gradient * number;
        let share = if growth.abs() < 1e-9 { 1.0 } else { growth.exp_m1() / growth };
        self.from + self.spacing * number * share
    }
}
