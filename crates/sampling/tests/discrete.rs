//! Tables choose by weight, never what has none, and use their random number up evenly.

use sampling::discrete::{Table1d, Table2d};
use sampling::rng::Rng;
use testkit::{assert_close, chi2, ttest};

const WEIGHTS: [f32; 8] = [0.0, 1.0, 0.0, 3.0, 1e-3, 0.5, 2.0, 0.0];

fn counts(table: &Table1d, n: u64) -> Vec<u64> {
    let mut rng = Rng::new(21, 0);
    let mut counts = vec![0; WEIGHTS.len()];
    for _ in 0..n {
        counts[table.sample(rng.next_f64()).index] += 1;
    }
    counts
}

fn expected(weights: &[f32], n: u64) -> Vec<f64> {
    let total: f64 = weights.iter().map(|&w| f64::from(w)).sum();
    weights.iter().map(|&w| n as f64 * f64::from(w) / total).collect()
}

#[test]
fn list_follows_its_weights() {
    let table = Table1d::new(&WEIGHTS).expect("valid weights");
    chi2::test(&counts(&table, 100_000), &expected(&WEIGHTS, 100_000), 0.01, 1).expect("by weight");
    let sum: f64 = (0..WEIGHTS.len()).map(|i| table.probability(i)).sum();
    assert_close!(sum, 1.0, 1e-14, 0.0);
}

#[test]
fn list_with_other_weights_can_fail() {
    let table = Table1d::new(&WEIGHTS).expect("valid weights");
    let mut wrong = WEIGHTS;
    wrong[3] *= 1.05;
    assert!(chi2::test(&counts(&table, 100_000), &expected(&wrong, 100_000), 0.01, 1).is_err(), "5 % more");
}

#[test]
fn ends_of_the_interval_have_weight() {
    let table = Table1d::new(&WEIGHTS).expect("valid weights");
    assert_eq!(table.sample(0.0).index, 1, "the first weight that is not 0");
    assert_eq!(table.sample(1.0_f64.next_down()).index, 6, "the last weight that is not 0");
    for u in [0.0, 0.1538, 0.5, 1.0_f64.next_down()] {
        let choice = table.sample(u);
        assert!(choice.probability > 0.0 && (0.0..1.0).contains(&choice.remapped), "{choice:?}");
        assert_close!(choice.probability, table.probability(choice.index), 0.0, 0.0);
    }
}

/// Entries by a search without a guide.
fn plain_search(weights: &[f32], u: f64) -> usize {
    let target = u * weights.iter().map(|&w| f64::from(w)).sum::<f64>();
    let mut before = 0.0;
    for (i, &weight) in weights.iter().enumerate() {
        before += f64::from(weight);
        if target < before {
            return i;
        }
    }
    weights.iter().rposition(|&w| w > 0.0).expect("some weight")
}

#[test]
fn guided_search_equals_the_plain_one() {
    let mut rng = Rng::new(24, 0);
    for n in [1, 2, 3, 7, 100, 1001] {
        // Mostly zeros and a few weights that differ by many orders of magnitude.
        let weights: Vec<f32> =
            (0..n).map(|i| if i % 3 == 0 { (-30.0 * rng.next_f32()).exp2() } else { 0.0 }).collect();
        let table = Table1d::new(&weights).expect("valid weights");
        let on_guides =
            (0..n).map(|k| f64::from(k) / f64::from(n)).flat_map(|u| [u, u.next_down().max(0.0), u.next_up()]);
        for u in on_guides.chain((0..2000).map(|_| rng.next_f64())) {
            assert_eq!(table.sample(u).index, plain_search(&weights, u), "{n} entries at {u}");
        }
    }
}

#[test]
fn bad_weights_can_fail() {
    for bad in [&[][..], &[0.0, 0.0], &[1.0, -1.0], &[f32::NAN], &[f32::INFINITY, 1.0]] {
        assert!(Table1d::new(bad).is_none(), "{bad:?}");
        assert!(Table2d::new(1, bad).is_none(), "{bad:?}");
    }
    assert!(Table2d::new(0, &[1.0]).is_none(), "no columns");
    assert!(Table2d::new(2, &[1.0; 3]).is_none(), "half a row");
}

/// Tests the integral of f over the unit square, estimated by a picture's density: right only if all probabilities are.
fn integral(probability: impl Fn(f64) -> f64) -> Result<f64, String> {
    let ([width, height], table) = picture();
    let mut rng = Rng::new(22, 0);
    let mut sample = || {
        let cell = table.sample([rng.next_f64(), rng.next_f64()]);
        let x = (cell.position[0] as f64 + cell.remapped[0]) / width as f64;
        let y = (cell.position[1] as f64 + cell.remapped[1]) / height as f64;
        (x * x + 3.0 * x * y) / (probability(cell.probability) * (width * height) as f64)
    };
    let samples: Vec<f64> = (0..1_000_000).map(|_| sample()).collect();
    ttest::test(&samples, 1.0 / 3.0 + 0.75, 0.01, 1)
}

fn picture() -> ([usize; 2], Table2d) {
    let mut rng = Rng::new(23, 0);
    let weights: Vec<f32> = (0..16 * 9).map(|_| 0.1 + rng.next_f32()).collect();
    ([16, 9], Table2d::new(16, &weights).expect("valid weights"))
}

#[test]
fn picture_estimates_an_integral() {
    integral(|p| p).expect("the probabilities are right");
    let (_, table) = picture();
    let sum: f64 = (0..9).flat_map(|y| (0..16).map(move |x| [x, y])).map(|cell| table.probability(cell)).sum();
    assert_close!(sum, 1.0, 1e-13, 0.0);
}

#[test]
fn picture_with_wrong_probabilities_can_fail() {
    assert!(integral(|_| 1.0 / 144.0).is_err(), "uniform probabilities are wrong");
    assert!(integral(|p| p * 1.01).is_err(), "1 % too large");
}

#[test]
fn dark_rows_are_never_chosen() {
    let mut weights = [0.0; 12];
    weights[5] = 2.0;
    weights[7] = 6.0;
    let table = Table2d::new(4, &weights).expect("valid weights");
    assert_eq!(table.sample([0.2, 0.999]).position, [1, 1], "the first quarter");
    assert_eq!(table.sample([0.3, 0.0]).position, [3, 1], "the rest");
    assert_close!(table.probability([3, 1]), 0.75, 1e-15, 0.0);
    assert_close!(table.probability([0, 0]), 0.0, 0.0, 0.0);
    assert_close!(table.total(), 8.0, 0.0, 0.0);
}
