//! One hard case: a number that must stay below its bound, and the method that does not.

/// What is hard, what must hold, and by how much it does.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Case {
    /// The case in a few words.
    pub(crate) title: &'static str,
    /// What is measured, its bound and the reason for it.
    pub(crate) bound: &'static str,
    /// Most that is allowed.
    pub(crate) limit: f64,
    /// Worst value of the project's own code.
    pub(crate) ours: fn() -> f64,
    /// The method that breaks.
    pub(crate) naive_method: &'static str,
    /// Its worst value.
    pub(crate) naive: fn() -> f64,
}

impl Case {
    /// Asserts the bound.
    pub(crate) fn holds(&self) {
        let value = (self.ours)();
        assert!(value <= self.limit, "{}: {value:e}, but at most {:e}: {}", self.title, self.limit, self.bound);
    }

    /// Asserts that the naive method is outside the bound; what is no number is.
    pub(crate) fn naive_fails(&self) {
        let value = (self.naive)();
        let holds = value <= self.limit;
        assert!(!holds, "{}: '{}' passes with {value:e} of {:e}", self.title, self.naive_method, self.limit);
    }

    /// The beginning of the case's row in the table, and its cell of the naive method.
    pub(crate) fn lead_cells(&self) -> [String; 2] {
        let Case { title, bound, naive_method, .. } = self;
        [format!("| {title} | {bound} | {} |", shown(self.limit)), format!(" | {naive_method} | ")]
    }

    /// The whole row, measured now.
    pub(crate) fn row(&self) -> String {
        let [start, naive] = self.lead_cells();
        format!("{start} {}{naive}{} |", shown((self.ours)()), shown((self.naive)()))
    }
}

/// Three digits, as people write them.
fn shown(value: f64) -> String {
    match value {
        0.0 => "0".into(),
        v if v.is_nan() => "not a number".into(),
        v if v.is_infinite() => "infinite".into(),
        v if (0.001..1000.0).contains(&v.abs()) => {
            let digits = (2 - v.abs().log10().floor() as i32).max(0) as usize;
            trimmed(&format!("{v:.digits$}")).into()
        }
        v => {
            let text = format!("{v:.2e}");
            let (mantissa, exponent) = text.split_once('e').expect("the format has an exponent");
            format!("{}e{exponent}", trimmed(mantissa))
        }
    }
}

/// Without zeros at the end of a fraction.
fn trimmed(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

/// The larger value; not a number where either is none.
pub(crate) fn worse(a: f64, b: f64) -> f64 {
    if a >= b || a.is_nan() { a } else { b }
}

/// The largest of some errors, at least 0; not a number where one is none, infinite where there are no errors: a case that
/// looks at nothing must not pass.
pub(crate) fn worst(errors: impl IntoIterator<Item = f64>) -> f64 {
    errors.into_iter().fold(None, |most, error| Some(worse(most.unwrap_or(0.0), error))).unwrap_or(f64::INFINITY)
}

/// Largest difference between two lists, infinite where their lengths differ.
pub(crate) fn difference(a: &[f64], b: &[f64]) -> f64 {
    if a.len() != b.len() {
        return f64::INFINITY;
    }
    worst(a.iter().zip(b).map(|(a, b)| (a - b).abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOUND: Case =
        Case { title: "t", bound: "b", limit: 1.0, ours: || 0.5, naive_method: "n", naive: || f64::NAN };

    #[test]
    fn row_shows_three_digits() {
        assert_eq!(SOUND.row(), "| t | b | 1 | 0.5 | n | not a number |");
        let texts = [0.0, 12.345, 100.0, 123_456.0, 0.000_1].map(shown);
        assert_eq!(texts, ["0", "12.3", "100", "1.23e5", "1e-4"]);
    }

    #[test]
    fn worst_hides_nothing() {
        assert_eq!(worst([-1.0, 0.5, 0.25]), 0.5);
        assert!([[f64::NAN, 0.5], [0.5, f64::NAN]].iter().all(|errors| worst(*errors).is_nan()));
        assert_eq!([worst([]), difference(&[], &[]), difference(&[0.0], &[])], [f64::INFINITY; 3]);
    }

    #[test]
    #[should_panic(expected = "at most")]
    fn bound_can_fail() {
        Case { ours: || f64::NAN, ..SOUND }.holds();
    }

    #[test]
    #[should_panic(expected = "passes")]
    fn naive_that_holds_can_fail() {
        Case { naive: || 0.5, ..SOUND }.naive_fails();
    }
}
