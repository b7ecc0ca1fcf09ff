//! The axes of a plot: what they count, in which unit, and where their ticks stand.

/// Most ticks of an axis: of more, only whole powers of ten stay.
const MOST_TICKS: usize = 10;

/// What an axis counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// Seconds.
    Seconds,
    /// Bytes.
    Bytes,
    /// A share of one.
    Share,
}

impl Unit {
    /// The one unit of an axis of that range, and how it is called.
    pub(super) fn of_axis(self, [low, high]: [f64; 2]) -> (f64, &'static str) {
        match self {
            Self::Seconds if high < 1.0 => (1e-3, "ms"),
            Self::Seconds if low > 120.0 => (60.0, "min"),
            Self::Seconds => (1.0, "s"),
            Self::Share => (0.01, "%"),
            Self::Bytes => {
                let middle = (low * high).sqrt();
                let power = ((middle.max(1.0).log2() / 10.0) as usize).min(4);
                (1024f64.powi(power as i32), ["B", "KiB", "MiB", "GiB", "TiB"][power])
            }
        }
    }

    /// A value as people write it.
    #[must_use]
    pub fn write(self, value: f64) -> String {
        match self {
            Self::Seconds if value > 0.0 && value < 1.0 => format!("{} ms", digits(1e3 * value)),
            Self::Seconds => format!("{} s", digits(value)),
            Self::Share => format!("{} %", digits(100.0 * value)),
            Self::Bytes => {
                let units = ["B", "KiB", "MiB", "GiB", "TiB"];
                let power = if value >= 1.0 { ((value.log2() / 10.0) as usize).min(units.len() - 1) } else { 0 };
                format!("{} {}", digits(value / 1024f64.powi(power as i32)), units[power])
            }
        }
    }
}

/// 1, 2 and 5 times the powers of ten within a range above 0.
pub(super) fn ticks([low, high]: [f64; 2]) -> Vec<f64> {
    let powers = (low.log10().floor() as i32)..=(high.log10().ceil() as i32);
    let of = |factors: &[f64]| -> Vec<f64> {
        let all = powers.clone().flat_map(|power| factors.iter().map(move |factor| factor * 10f64.powi(power)));
        all.filter(|tick| (low..=high).contains(tick)).collect()
    };
    let fine = of(&[1.0, 2.0, 5.0]);
    if fine.len() <= MOST_TICKS { fine } else { of(&[1.0]) }
}

/// A number with three digits that count, without zeros at its end.
pub(super) fn digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let places = (2 - value.abs().log10().floor() as i32).max(0) as usize;
    let text = format!("{value:.places$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_have_one_unit_and_ticks_of_1_2_5() {
        assert_eq!(ticks([0.4, 12.0]), [0.5, 1.0, 2.0, 5.0, 10.0]);
        assert_eq!(ticks([1e-3, 1e3]), [1e-3, 1e-2, 1e-1, 1.0, 10.0, 100.0, 1000.0]);
        assert_eq!(Unit::Seconds.of_axis([0.01, 0.5]), (1e-3, "ms"));
        assert_eq!(Unit::Seconds.of_axis([0.5, 500.0]), (1.0, "s"));
        assert_eq!(Unit::Bytes.of_axis([1e5, 1e6]), (1024.0, "KiB"));
    }

    #[test]
    fn numbers_are_written_for_people() {
        let cases = [
            (Unit::Seconds, 0.0123, "12.3 ms"),
            (Unit::Seconds, 75.04, "75 s"),
            (Unit::Share, 0.0105, "1.05 %"),
            (Unit::Share, 0.0, "0 %"),
            (Unit::Bytes, 1536.0, "1.5 KiB"),
            (Unit::Bytes, 0.0, "0 B"),
            (Unit::Bytes, 96.0 * 1048576.0, "96 MiB"),
        ];
        for (unit, value, text) in cases {
            assert_eq!(unit.write(value), text);
        }
    }
}
