//! Which basis to take, and in which encoding.

use super::{Row, Stored};
use sh_math::hemisphere::Basis;

/// Share by which times of the same work may differ.
const CLOCK: f64 = 0.1;
/// Share by which errors may differ that count as the same.
const SAME_ERROR: f64 = 0.01;

/// What the user wants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// A relative error as drawn, root of the mean square.
    Error(f64),
    /// Bytes of all sheets.
    Bytes(u64),
}

/// What serves a goal best.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// The goal.
    pub goal: Goal,
    /// Index of the row.
    pub row: usize,
    /// Index of the encoding in [`Row::stored`].
    pub stored: usize,
    /// Whether it meets the goal; else it is what comes nearest.
    pub met: bool,
}

/// For an error: the fewest bytes that keep it, of equal bytes the fastest. For bytes: the least error that fits. Where nothing meets the
/// goal, the least error or the fewest bytes there are.
///
/// An ordinary light map is chosen where no normal map is in use, and only there. Times within a tenth of each other are the same, errors
/// within a hundredth. What is still equal is decided by the error over the hemisphere, then for the last of [`Basis::ALL`], the modified
/// H-basis, which can be cut to a light map.
///
/// # Panics
/// When there is no row to choose.
pub(super) fn choose(rows: &[Row], has_normal_maps: bool, goal: Goal) -> Choice {
    let allowed = |row: &Row| (row.basis == Basis::ModifiedH1) != has_normal_maps;
    let pairs = |(r, row): (usize, &Row)| (0..row.stored.len()).map(move |s| (r, s)).collect::<Vec<_>>();
    let all: Vec<(usize, usize)> = rows.iter().enumerate().filter(|(_, row)| allowed(row)).flat_map(pairs).collect();
    let of = |(row, stored): (usize, usize)| (&rows[row], &rows[row].stored[stored]);
    let bytes = |pair| of(pair).1.bytes as f64;
    let error = |pair| of(pair).1.drawn.rms;
    let time = |pair| of(pair).0.nanoseconds;
    let meets = |stored: &Stored| match goal {
        Goal::Error(most) => stored.drawn.rms <= most,
        Goal::Bytes(most) => stored.bytes <= most,
    };
    let meeting: Vec<(usize, usize)> = all.iter().copied().filter(|&pair| meets(of(pair).1)).collect();
    let met = !meeting.is_empty();
    let left = match (goal, met) {
        (Goal::Error(_), true) => least(least(least(meeting, bytes, 0.0), time, CLOCK), error, SAME_ERROR),
        (Goal::Bytes(_), true) => least(least(least(meeting, error, SAME_ERROR), bytes, 0.0), time, CLOCK),
        (Goal::Error(_), false) => least(least(least(all, error, SAME_ERROR), bytes, 0.0), time, CLOCK),
        (Goal::Bytes(_), false) => least(least(least(all, bytes, 0.0), error, SAME_ERROR), time, CLOCK),
    };
    let left = least(left, |pair| of(pair).0.relative, SAME_ERROR);
    let &(row, stored) = left.last().expect("every comparison has all bases");
    Choice { goal, row, stored, met }
}

/// Those whose key is the least, or larger by no more than the share `slack`.
fn least<T: Copy>(list: Vec<T>, key: impl Fn(T) -> f64, slack: f64) -> Vec<T> {
    let best = list.iter().map(|&item| key(item)).fold(f64::INFINITY, f64::min);
    list.into_iter().filter(|&item| key(item) <= best * (1.0 + slack)).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{Drawn, Worst};
    use super::*;
    use coeff_io::Encoding;

    fn row(basis: Basis, nanoseconds: f64, stored: [(u64, f64); 2]) -> Row {
        let worst = Worst { sheet: 0, place: [0; 2], position: [0.0; 3], mesh: String::new(), relative: 0.0 };
        let stored =
            stored.map(|(bytes, rms)| Stored { encoding: Encoding::F16, bytes, drawn: Drawn { rms, p99: rms } });
        Row { basis, imse: 0.0, relative: 0.0, worst, stored: stored.to_vec(), nanoseconds }
    }

    /// HL2 is small, H and modified H of four functions are alike, SH 9 is the closest and the largest.
    fn rows() -> Vec<Row> {
        vec![
            row(Basis::Sh9, 8.0, [(540, 0.001), (270, 0.004)]),
            row(Basis::Hl2, 3.0, [(180, 0.05), (90, 0.051)]),
            row(Basis::H4, 4.0, [(240, 0.02), (120, 0.03)]),
            row(Basis::ModifiedH1, 1.0, [(60, 0.001), (30, 0.001)]),
            row(Basis::ModifiedH4, 4.2, [(240, 0.02), (120, 0.03)]),
        ]
    }

    fn chosen(goal: Goal) -> (Basis, usize, bool) {
        let Choice { row, stored, met, .. } = choose(&rows(), true, goal);
        (rows()[row].basis, stored, met)
    }

    #[test]
    fn each_goal_finds_its_basis() {
        assert_eq!(chosen(Goal::Error(0.06)), (Basis::Hl2, 1, true));
        assert_eq!(chosen(Goal::Error(0.03)), (Basis::ModifiedH4, 1, true), "as small and as close: the last");
        assert_eq!(chosen(Goal::Error(0.02)), (Basis::ModifiedH4, 0, true));
        assert_eq!(chosen(Goal::Error(0.004)), (Basis::Sh9, 1, true));
        assert_eq!(chosen(Goal::Error(0.0001)), (Basis::Sh9, 0, false), "the least error there is");
        assert_eq!(chosen(Goal::Bytes(269)), (Basis::ModifiedH4, 0, true));
        assert_eq!(chosen(Goal::Bytes(100)), (Basis::Hl2, 1, true));
        assert_eq!(chosen(Goal::Bytes(10)), (Basis::Hl2, 1, false), "the fewest bytes there are");
        let plain = choose(&rows(), false, Goal::Error(0.5));
        assert_eq!((plain.row, plain.stored), (3, 1), "a light map where no normal map is, and there alone");
    }

    /// Of equal bytes the faster is taken where the clock can tell, whatever stands last.
    #[test]
    fn each_goal_finds_its_basis_can_fail() {
        let mut rows = rows();
        rows[4].nanoseconds = 5.0;
        assert_eq!(choose(&rows, true, Goal::Error(0.03)).row, 2);
        rows[4].nanoseconds = 4.2;
        rows[4].relative = 0.1;
        rows[2].relative = 0.05;
        assert_eq!(choose(&rows, true, Goal::Error(0.03)).row, 2, "then the error over the hemisphere");
        rows[4].stored[1].bytes = 119;
        assert_eq!(choose(&rows, true, Goal::Error(0.03)).row, 4, "fewer bytes go before");
    }
}
