//! The Pareto front: points that no other point beats in both cost and error.

/// Indices of the points `[cost, error]` that are on the front, by rising cost.
pub fn pareto(points: &[[f64; 2]]) -> Vec<usize> {
    let mut order: Vec<usize> =
        (0..points.len()).filter(|&index| points[index].iter().all(|v| v.is_finite())).collect();
    order.sort_by(|&a, &b| points[a][0].total_cmp(&points[b][0]).then(points[a][1].total_cmp(&points[b][1])));
    let mut least = f64::INFINITY;
    order.retain(|&index| {
        let is_better = points[index][1] < least;
        least = least.min(points[index][1]);
        is_better
    });
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_points_that_nothing_beats_are_on_the_front() {
        let points = [[2.0, 2.0], [1.0, 5.0], [3.0, 3.0], [4.0, 1.0], [1.0, 6.0], [4.0, 1.0], [f64::NAN, 0.0]];
        assert_eq!(pareto(&points), [1, 0, 3]);
        assert!(pareto(&[]).is_empty());
    }
}
