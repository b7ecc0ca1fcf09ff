//! The study as text: a table for people, comma-separated values for programs.

use super::{Average, Fit, Invariant, Row, Study};
use std::fmt::Write;

/// The names of the columns of the comma-separated values.
const HEAD: &str = "basis,functions,fit,signal_bands,imse,standard_error,expected,printed,\
                    ns_per_evaluation,bytes_f32,bytes_f16,bytes_8bit\n";

impl Study {
    /// The rows as comma-separated values with a head line; what the paper does not print is empty.
    ///
    /// Bytes are those of a texel of three channels; errors are IMSE of irradiance / pi over the hemisphere. Spherical
    /// harmonics with 9 coefficients stand there once more for signals of 5 bands.
    #[must_use]
    pub fn csv(&self) -> String {
        let lines: String = self.rows.iter().map(|row| values(row, 3)).collect();
        let eleventh = self.eleventh_rows().map(|row| values(&row, 5)).concat();
        [HEAD, &lines, &eleventh].concat()
    }

    /// The same for people, with what is said of the eleventh entry and of the invariants.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = format!(
            "{:<13} {:>8} {:>8} {:>8} {:>8} {:>7} {:>7} {:>5} {:>5} {:>5}\n",
            "basis", "IMSE", "+-", "expected", "printed", "ratio", "ns", "f32", "f16", "8 bit"
        );
        for row in &self.rows {
            text += &line(row);
        }
        text += &self.notes();
        text
    }

    fn notes(&self) -> String {
        let (signals, seed) = (self.settings.signals, self.settings.seed);
        let mut text = format!(
            "\nIMSE of irradiance / pi over the hemisphere, {signals} signals, seed {seed}: radiance coefficients uniform in \
             [-1, 1],\n3 bands; fitted by least squares on the hemisphere (cut: the first coefficients of the sphere). ns: one \
             evaluation,\nthree channels, f32, one thread. f32, f16, 8 bit: bytes of a texel of three channels.\n\n"
        );
        let eleventh = self.eleventh;
        let said = |(average, expected): (Average, f64)| {
            format!(
                "{:.5} (expected {expected:.5}, printed / expected {:.3})",
                average.mean,
                eleventh.printed / expected
            )
        };
        // Writing to a string cannot fail.
        let _ = write!(
            text,
            "SH 9 is exact for 3 bands; the paper prints {:.5}. With signals of 5 bands it would be\n  fitted {}\n  cut    {}\n\n",
            eleventh.printed,
            said(eleventh.fitted),
            said(eleventh.cut)
        );
        text += "For every signal:\n";
        for Invariant { smaller, larger, equal, worst } in &self.invariants {
            let relation = if *equal { "=" } else { "<=" };
            let _ = writeln!(text, "  {:<11} {relation:>2} {:<12} worst {worst:.0e}", smaller.name(), larger.name());
        }
        let broken = self.invariants.iter().filter(|invariant| !invariant.holds()).count();
        let _ = writeln!(text, "{} of {} hold.", self.invariants.len() - broken, self.invariants.len());
        text
    }
}

/// One line of comma-separated values.
fn values(row: &Row, signal_bands: u32) -> String {
    let Row { entry, imse: Average { mean, standard_error }, expected, nanoseconds, .. } = row;
    let (name, count) = (entry.basis.name(), entry.basis.count());
    let fit = match entry.fit {
        Fit::LeastSquares => "least squares",
        Fit::Cut => "cut",
    };
    let printed = row.printed.map_or_else(String::new, |printed| printed.to_string());
    let [long, short, byte] = [4, 2, 1].map(|bytes| row.texel(bytes));
    format!(
        "{name},{count},{fit},{signal_bands},{mean:.9},{standard_error:.9},{expected:.9},{printed},\
         {nanoseconds:.3},{long},{short},{byte}\n"
    )
}

fn line(row: &Row) -> String {
    let or_dash = |value: Option<f64>, digits: usize| value.map_or_else(|| "-".to_owned(), |v| format!("{v:.digits$}"));
    format!(
        "{:<13} {:>8.5} {:>8.5} {:>8.5} {:>8} {:>7} {:>7.2} {:>5} {:>5} {:>5}\n",
        row.entry.name(),
        row.imse.mean,
        row.imse.standard_error,
        row.expected,
        or_dash(row.printed, 5),
        or_dash(row.printed.map(|printed| row.imse.mean / printed), 3),
        row.nanoseconds,
        row.texel(4),
        row.texel(2),
        row.texel(1)
    )
}
