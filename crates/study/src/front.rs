//! The Pareto front: what nothing else beats in both price and error.

/// Indices of the points that no other point beats: none costs no more and errs no more, and is better in one of the two.
///
/// Of equal points the first stays. Points with a number that is not finite are never on the front. By rising price.
#[must_use]
pub fn front(points: &[[f64; 2]]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).filter(|&i| points[i].iter().all(|v| v.is_finite())).collect();
    order.sort_by(|&a, &b| points[a][0].total_cmp(&points[b][0]).then(points[a][1].total_cmp(&points[b][1])));
    let mut best = f64::INFINITY;
    order.retain(|&i| {
        let closer = points[i][1] < best;
        best = best.min(points[i][1]);
        closer
    });
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use sampling::rng;

    /// Random points on a coarse grid, so that many are equal in one coordinate or in both.
    fn cloud(seed: u64, count: u64) -> Vec<[f64; 2]> {
        let coordinate = |i: u64, axis: u64| (rng::hash(seed, axis, i) % 9) as f64;
        (0..count).map(|i| [coordinate(i, 1), coordinate(i, 2)]).collect()
    }

    /// By the definition: every pair is looked at.
    fn by_brute_force(points: &[[f64; 2]]) -> Vec<usize> {
        let beats = |j: usize, i: usize| {
            let ([pj, ej], [pi, ei]) = (points[j], points[i]);
            pj <= pi && ej <= ei && (pj < pi || ej < ei || j < i)
        };
        (0..points.len()).filter(|&i| !(0..points.len()).any(|j| j != i && beats(j, i))).collect()
    }

    fn sorted(mut list: Vec<usize>) -> Vec<usize> {
        list.sort_unstable();
        list
    }

    #[test]
    fn the_front_is_that_of_the_definition() {
        for seed in 0..200 {
            let points = cloud(seed, seed % 40);
            assert_eq!(sorted(front(&points)), by_brute_force(&points), "seed {seed}: {points:?}");
        }
    }

    /// Taking the cheapest points, whatever their error, is seen to differ.
    #[test]
    fn the_front_is_that_of_the_definition_can_fail() {
        let differs = |seed: u64| {
            let points = cloud(seed, seed % 40);
            let truth = by_brute_force(&points);
            let mut cheapest: Vec<usize> = (0..points.len()).collect();
            cheapest.sort_by(|&a, &b| points[a][0].total_cmp(&points[b][0]));
            cheapest.truncate(truth.len());
            sorted(cheapest) != truth
        };
        assert!((0..200).any(differs));
    }

    #[test]
    fn what_is_no_number_is_on_no_front() {
        assert_eq!(front(&[[f64::NAN, 0.0], [1.0, f64::INFINITY], [2.0, 1.0]]), [2]);
        assert!(front(&[]).is_empty());
    }
}
