//! Means and quantiles.

/// The mean; 0 for none.
pub fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let n = values.len();
    if n == 0 { 0.0 } else { values.sum::<f64>() / n as f64 }
}

/// The value below which the share `q` (0 to 1) of the values lies; 0 for none.
pub fn quantile(values: &[f64], q: f64) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let mut sorted = values.to_vec();
    let rank = ((sorted.len() - 1) as f64 * q).round() as usize;
    *sorted.select_nth_unstable_by(rank, f64::total_cmp).1
}

/// `x / mean`; 0 where the mean is 0.
pub fn over(x: f64, mean: f64) -> f64 {
    if mean > 0.0 { x / mean } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_order_statistics() {
        assert_eq!(quantile(&[3.0, 1.0, 2.0], 0.5), 2.0);
        assert_eq!(quantile(&[3.0, 1.0, 2.0], 1.0), 3.0);
        assert_eq!(quantile(&[], 0.5), 0.0);
    }
}
