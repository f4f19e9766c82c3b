//! The best of several values.

/// The better one of two values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Better {
    /// The lesser value.
    Less,
    /// The greater value.
    More,
}

impl Better {
    /// Returns the index of the best value, the first of equals. `None` without values.
    pub fn first_best(self, values: impl IntoIterator<Item = Option<f64>>) -> Option<usize> {
        let known = values.into_iter().enumerate().filter_map(|(index, value)| Some((index, value?)));
        let known = known.filter(|(_, value)| !value.is_nan());
        let is_better = |a: f64, b: f64| if self == Better::Less { a < b } else { a > b };
        known.reduce(|best, next| if is_better(next.1, best.1) { next } else { best }).map(|(index, _)| index)
    }

    /// Returns the indices of the values that look like the best one. Empty if fewer than two values are known, or if all look
    /// alike, because then none stands out. `shown` has the texts of the values.
    pub fn that_stand_out(self, values: &[Option<f64>], shown: &[Option<String>]) -> Vec<usize> {
        let known: Vec<usize> =
            (0..values.len().min(shown.len())).filter(|&i| values[i].is_some() && shown[i].is_some()).collect();
        let of_known = |i: usize| known.contains(&i).then(|| values[i]).flatten();
        let Some(first) = self.first_best((0..values.len()).map(of_known)) else { return Vec::new() };
        let best: Vec<usize> = known.iter().copied().filter(|&i| shown[i] == shown[first]).collect();
        if best.len() < known.len() { best } else { Vec::new() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn standing_out(better: Better, values: &[Option<f64>]) -> Vec<usize> {
        let shown: Vec<Option<String>> = values.iter().map(|value| value.map(|value| format!("{value:.1}"))).collect();
        better.that_stand_out(values, &shown)
    }

    #[test]
    fn values_that_look_like_the_best_stand_out() {
        assert_eq!(standing_out(Better::Less, &[Some(2.0), Some(1.01), None, Some(1.02)]), [1, 3]);
        assert_eq!(standing_out(Better::More, &[Some(2.0), Some(1.0), None, Some(f64::INFINITY)]), [3]);
    }

    #[test]
    fn nothing_stands_out_among_equals() {
        assert!(standing_out(Better::Less, &[Some(1.0), Some(1.0), None]).is_empty());
        assert!(standing_out(Better::Less, &[Some(1.0), None]).is_empty());
        assert!(standing_out(Better::More, &[]).is_empty());
        assert_eq!(Better::Less.first_best([None, Some(f64::NAN), Some(1.0), Some(1.0)]), Some(2));
    }
}
