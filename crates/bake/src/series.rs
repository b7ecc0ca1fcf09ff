//! The series of bounces beyond those that are simulated one by one, summed in closed form.
//!
//! Bounces are the terms `x, A x, A^2 x, ...` of a linear operator, so from some bounce on each is the one before times its largest eigenvalue
//! `q`, and all that follow sum to `q / (1 - q)` of the last. What the last differs from its eigenvector by is no longer a bounce of the
//! series, but it is carried on as if it were one: the sum stays exact, and what is still missing is measured.

use crate::field::Field;

/// Bounces that are simulated before a tail is summed: most scenes end sooner by themselves.
pub(crate) const FIRST: u32 = 24;
/// Bounces that are expected at most where their number is left open.
pub(crate) const EXPECTED: u32 = FIRST + 12;
/// Most bounces where their number is left open; what is missing after them is told.
pub(crate) const MOST: u32 = 2048;
/// Part of a bounce that may differ from the one before times the ratio where a tail is summed. The sum stays exact whatever it is; too
/// small a part waits for ever where light goes to and fro, too large a one leaves much behind.
const SETTLED: f64 = 0.5;

/// A tail that was summed.
pub(crate) struct Tail {
    /// All bounces after the last but for what `rest` and those after it bring.
    pub(crate) sum: Field,
    /// What takes the place of the next bounce.
    pub(crate) rest: Field,
    /// Largest ratio of two bounces, over the channels.
    pub(crate) ratio: f64,
}

/// Sums the tail after `last`, which `next` follows; none where the bounces have not settled to one ratio yet, or do not fade.
///
/// For any factor `f` the sum of `f last` leaves the residual `(1 + f) next - f last`.
pub(crate) fn tail(last: &Field, next: &Field) -> Option<Tail> {
    let mut ratios = Vec::with_capacity(last.channels);
    for channel in 0..last.channels {
        let [own, cross, square] = last.products(next, channel);
        if own <= 0.0 {
            ratios.push(0.0);
            continue;
        }
        let ratio = cross / own;
        // The square of next - ratio last.
        let away = square - ratio * cross;
        if !(0.0..1.0).contains(&ratio) || away > SETTLED * SETTLED * (1.0 - ratio) * square {
            return None;
        }
        ratios.push(ratio);
    }
    let ratio = ratios.iter().copied().fold(0.0, f64::max);
    Some(tail_of(last, next, ratio, &|c| ratios[c] / (1.0 - ratios[c])))
}

/// Half of the last bounce taken back: what alternates between two surfaces that face each other, and hides the ratio, is gone from the
/// residual.
pub(crate) fn smoothed(last: &Field, next: &Field) -> Tail {
    tail_of(last, next, 0.0, &|_| -0.5)
}

fn tail_of(last: &Field, next: &Field, ratio: f64, factor: &dyn Fn(usize) -> f64) -> Tail {
    let sum = last.combined(next, &|c| [factor(c) as f32, 0.0]);
    let rest = last.combined(next, &|c| [-factor(c) as f32, (1.0 + factor(c)) as f32]);
    Tail { sum, rest, ratio }
}

/// What follows a change where each is to the one before as `ratio`.
pub(crate) fn remainder(change: f64, ratio: f64) -> f64 {
    if ratio < 1.0 { change * ratio / (1.0 - ratio) } else { f64::INFINITY }
}

/// What follows the last of three changes where each is to the one before the one before it as the last to the first: also where light goes
/// to and fro between two surfaces, so that every other change is small. Where changes fade evenly it is [`remainder`].
pub(crate) fn remainder_of_pairs([first, second, last]: [f64; 3]) -> f64 {
    match last / first {
        ratio if ratio < 1.0 => (second + last) * ratio / (1.0 - ratio),
        _ if last == 0.0 => 0.0,
        _ => f64::INFINITY,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 0.9, 0.1, 0.45, 0.05, ...: each pair is half of the one before.
    #[test]
    fn what_alternates_leaves_its_pairs() {
        assert!((remainder_of_pairs([0.1, 0.45, 0.05]) - 0.5).abs() < 1e-12);
        assert!(remainder(0.05, 0.05 / 0.45) < 0.01, "can fail: one ratio misses it");
        let even = [0.4, 0.2, 0.1];
        assert!((remainder_of_pairs(even) - remainder(0.1, 0.5)).abs() < 1e-12);
        assert_eq!((remainder_of_pairs([0.0; 3]), remainder_of_pairs([0.1, 0.1, 0.1])), (0.0, f64::INFINITY));
    }

    /// Rows of one number each.
    fn field(values: [f32; 3]) -> Field {
        let mut field = Field::zeros(3, 1, 1);
        (0..3).zip(values).for_each(|(row, value)| field.set(row, &[value]));
        field
    }

    fn values(field: &Field) -> [f64; 3] {
        [0, 1, 2].map(|row| f64::from(field.channel(row, 0)[0]))
    }

    /// A symmetric operator with rows that sum to 0.99 and eigenvalues 0.99, 0.3 and 0.
    fn operator(x: [f64; 3]) -> [f64; 3] {
        let mean = 0.99 * (x[0] + x[1] + x[2]) / 3.0;
        let turn = 0.3 * (x[0] - x[1]) / 2.0;
        [mean + turn, mean - turn, mean]
    }

    fn sum_of_series(mut x: [f64; 3], terms: u32) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for _ in 0..terms {
            x = operator(x);
            sum = [0, 1, 2].map(|i| sum[i] + x[i]);
        }
        sum
    }

    /// Against thousands of terms: the tail, and what the rest brings, are all that follows.
    #[test]
    fn a_tail_is_the_sum_of_what_follows() {
        let last = [1.004, 0.997, 1.0];
        let next = operator(last);
        let tail = tail(&field(last.map(|x| x as f32)), &field(next.map(|x| x as f32))).expect("settled");
        assert!((tail.ratio - 0.99).abs() < 1e-4);
        let (sum, rest) = (values(&tail.sum), values(&tail.rest));
        let after = sum_of_series(rest, 5000);
        let all = sum_of_series(last, 5000);
        for i in 0..3 {
            let found = sum[i] + rest[i] + after[i];
            assert!((found / all[i] - 1.0).abs() < 1e-4, "{found}, not {}", all[i]);
            assert!((sum[i] / all[i] - 1.0).abs() > 1e-5 || i == 2, "can fail: the rest is a part of it");
        }
    }

    /// Light that goes to and fro between two surfaces, one of them brighter in each bounce: no ratio, until half a bounce is taken back.
    #[test]
    fn what_alternates_is_smoothed() {
        let swap = |x: [f64; 3]| [0.99 * x[1], 0.99 * x[0], 0.0];
        let fields = |x: [f64; 3]| [field(x.map(|x| x as f32)), field(swap(x).map(|x| x as f32))];
        let [last, next] = fields([1.0, 0.2, 0.0]);
        assert!(tail(&last, &next).is_none(), "it alternates");
        let smooth = smoothed(&last, &next);
        let rest = values(&smooth.rest);
        let settled = tail(&smooth.rest, &field(swap(rest).map(|x| x as f32))).expect("settled");
        let (sums, more) = ([&smooth.sum, &settled.sum].map(values), values(&settled.rest));
        let after = (0..5000).fold(([0.0; 3], more), |(sum, x), _| ([0, 1, 2].map(|i| sum[i] + x[i]), swap(x))).0;
        let found = [0, 1].map(|i| sums[0][i] + rest[i] + sums[1][i] + after[i]);
        // (I - A)^-1 A (1, 0.2), by hand.
        let exact = [0.99 * (0.2 + 0.99), 0.99 * (1.0 + 0.99 * 0.2)].map(|x| x / (1.0 - 0.99 * 0.99));
        (0..2).for_each(|i| assert!((found[i] / exact[i] - 1.0).abs() < 1e-3, "{found:?}, not {exact:?}"));
    }

    #[test]
    fn bounces_that_have_not_settled_have_no_tail() {
        let last = [1.0, 0.0, 0.0];
        assert!(tail(&field([1.0, 0.0, 0.0]), &field(operator(last).map(|x| x as f32))).is_none());
        assert!(tail(&field([1.0; 3]), &field([1.0; 3])).is_none(), "what does not fade has no sum");
    }
}
