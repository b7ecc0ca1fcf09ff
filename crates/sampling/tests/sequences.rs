//! The point sets are what they say: stratified, reproducible, independent of the count where stated.

use sampling::sequence::{Sequence, fill, point};
use testkit::chi2;

const ALL: [Sequence; 3] = [Sequence::OwenSobol, Sequence::Fibonacci, Sequence::Stratified];

fn set(sequence: Sequence, count: u32, seed: u64) -> Vec<[f32; 2]> {
    let mut points = vec![[9.0; 2]];
    fill(sequence, count, seed, &mut points);
    points
}

/// Most points of one cell in a grid of columns by rows.
fn fullest_cell(points: &[[f32; 2]], columns: usize, rows: usize) -> usize {
    let mut cells = vec![0; columns * rows];
    for [x, y] in points {
        cells[(x * columns as f32) as usize + columns * (y * rows as f32) as usize] += 1;
    }
    cells.into_iter().max().unwrap_or(0)
}

#[test]
fn fill_equals_point_and_stays_in_the_square() {
    for sequence in ALL {
        for count in [1, 2, 3, 7, 64, 100, 1000, 70_000] {
            let points = set(sequence, count, 3);
            assert_eq!(points.len(), count as usize, "{sequence:?}");
            assert!(points.iter().flatten().all(|v| (0.0..1.0).contains(v)), "{sequence:?} of {count}");
            for index in [0, count / 2, count - 1] {
                assert_eq!(points[index as usize], point(sequence, index, count, 3), "{sequence:?} {index}/{count}");
            }
        }
    }
}

#[test]
fn seeds_and_blocks_differ() {
    for sequence in ALL {
        assert_ne!(set(sequence, 64, 1), set(sequence, 64, 2), "{sequence:?}");
    }
    let long = set(Sequence::OwenSobol, 1 << 17, 1);
    assert_ne!(long[..1 << 16], long[1 << 16..], "the second block is another scramble");
}

#[test]
fn sobol_prefixes_are_nets() {
    let points = set(Sequence::OwenSobol, 4096, 17);
    assert_eq!(points[..100], set(Sequence::OwenSobol, 100, 17), "a prefix does not know the count");
    for power in 0..=12 {
        for columns in 0..=power {
            let fullest = fullest_cell(&points[..1 << power], 1 << columns, 1 << (power - columns));
            assert_eq!(fullest, 1, "2^{power} points in a grid of 2^{columns} columns");
        }
    }
}

#[test]
fn jittered_points_have_a_cell_each() {
    let points = set(Sequence::Stratified, 4096, 17);
    assert_eq!(fullest_cell(&points, 64, 64), 1, "one point per cell of a square count");
}

#[test]
fn nets_can_fail() {
    let points = set(Sequence::Stratified, 4096, 17);
    assert!(fullest_cell(&points, 4096, 1) > 1, "jittered points are no net");
    assert!(fullest_cell(&set(Sequence::OwenSobol, 4095, 17)[1..], 4096, 1) <= 1, "fewer points fit as well");
    assert!(fullest_cell(&set(Sequence::OwenSobol, 4097, 17), 4096, 1) > 1, "one point too many");
}

/// Each point of one index is uniform over the seeds: what makes the estimates unbiased.
fn uniform_over_seeds(sequence: Sequence, count: u32, index: u32, replicates: u64) -> Result<(), String> {
    let mut observed = vec![0_u64; 64];
    // The stratified point of an index is uniform in its cell only, so count = 1 stands for it there.
    for seed in 0..replicates {
        let [x, y] = point(sequence, index, count, seed);
        observed[(x * 8.0) as usize + 8 * (y * 8.0) as usize] += 1;
    }
    chi2::test(&observed, &[replicates as f64 / 64.0; 64], 0.01, 4).map(drop)
}

#[test]
fn points_are_uniform_over_seeds() {
    uniform_over_seeds(Sequence::OwenSobol, 256, 0, 20_000).expect("first Sobol point");
    uniform_over_seeds(Sequence::OwenSobol, 256, 201, 20_000).expect("some Sobol point");
    uniform_over_seeds(Sequence::Fibonacci, 100, 31, 20_000).expect("Fibonacci");
    uniform_over_seeds(Sequence::Stratified, 1, 0, 20_000).expect("the only cell");
}

#[test]
fn uniformity_can_fail() {
    assert!(uniform_over_seeds(Sequence::Stratified, 4, 0, 20_000).is_err(), "a cell is not the square");
}

#[test]
fn jittered_cells_have_equal_area() {
    // Twelve points of each of 7 cells, over many seeds: the mean of each coordinate over all cells is 1/2.
    for count in [2, 3, 5, 7, 11, 1000] {
        let (mut x, mut y, mut n) = (0.0, 0.0, 0.0);
        for seed in 0..200_000 / u64::from(count) {
            for [a, b] in set(Sequence::Stratified, count, seed) {
                (x, y, n) = (x + f64::from(a), y + f64::from(b), n + 1.0);
            }
        }
        testkit::assert_close!(x / n, 0.5, 3e-3, 0.0, "{count}");
        testkit::assert_close!(y / n, 0.5, 3e-3, 0.0, "{count}");
    }
}
