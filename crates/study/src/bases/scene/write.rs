//! The comparison as text: a table for people, comma-separated values for programs.

use super::{Choice, Comparison, Goal, Row, Stored, Worst};
use crate::plot::chart::Unit;
use coeff_io::Encoding;
use sh_math::hemisphere::Basis;
use std::fmt::Write;

/// The names of the columns of the comma-separated values.
const HEAD: &str = "basis,functions,imse,relative_rms,worst_relative,worst_sheet,worst_row,worst_column,worst_x,worst_y,worst_z,worst_mesh,\
    ns_per_evaluation,encoding,bytes,drawn_relative_rms,drawn_relative_p99,chosen\n";

impl Comparison {
    /// One line per basis and encoding, with a head line. Errors are of irradiance / pi.
    #[must_use]
    pub fn csv(&self) -> String {
        let lines = |(r, row): (usize, &Row)| -> String {
            let line =
                |(s, stored): (usize, &Stored)| values(row, stored, (r, s) == (self.choice.row, self.choice.stored));
            row.stored.iter().enumerate().map(line).collect()
        };
        HEAD.to_owned() + &self.rows.iter().enumerate().map(lines).collect::<String>()
    }

    /// The same for people, without the recommendation.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = format!(
            "{:<13} {:>9} {:>7} {:>7} {:>9} {:>9} {:>9}  {:>8} {:>9}  {:>8} {:>7}  {:>8} {:>7} {:>6}\n",
            "basis",
            "IMSE",
            "rms",
            "worst",
            "drawn",
            "99 %",
            "f32",
            "f16",
            "drawn",
            "u8",
            "drawn",
            "bc6h",
            "drawn",
            "ns"
        );
        for row in &self.rows {
            text += &line(row);
        }
        text + &self.notes()
    }

    /// What to take, in a sentence.
    #[must_use]
    pub fn recommendation(&self) -> String {
        let Choice { goal, row, stored, met } = self.choice;
        let (row, stored) = (&self.rows[row], &self.rows[row].stored[stored]);
        let (rms, bytes) = (Unit::Share.write(stored.drawn.rms), Unit::Bytes.write(stored.bytes as f64));
        let taken = format!("{} in {}, error {rms} as drawn, {bytes}", row.basis.name(), stored.encoding.id());
        let only = if self.has_normal_maps { "" } else { " (no normal map is in use: a light map serves)" };
        match (goal, met) {
            (Goal::Error(most), true) => format!("for an error of {}: {taken}{only}", Unit::Share.write(most)),
            (Goal::Error(most), false) => {
                format!("for an error of {}: nothing keeps it; the least is {taken}{only}", Unit::Share.write(most))
            }
            (Goal::Bytes(most), true) => format!("for {}: {taken}{only}", Unit::Bytes.write(most as f64)),
            (Goal::Bytes(most), false) => {
                format!("for {}: nothing fits; the smallest is {taken}{only}", Unit::Bytes.write(most as f64))
            }
        }
    }

    /// What must be said where an ordinary light map is as small as what is recommended and errs no more as drawn: normal maps that hardly
    /// bend, to which least squares over the whole hemisphere are not tuned.
    #[must_use]
    pub fn remark(&self) -> Option<String> {
        let Choice { row, stored, .. } = self.choice;
        let chosen = &self.rows[row].stored[stored];
        let plain = self.rows.iter().find(|row| row.basis == Basis::ModifiedH1).filter(|_| self.has_normal_maps)?;
        let as_good =
            plain.stored.iter().find(|plain| plain.bytes <= chosen.bytes && plain.drawn.rms <= chosen.drawn.rms)?;
        Some(format!(
            "the normal maps hardly bend: an ordinary light map in {} errs by {} in {}, but shows nothing of them",
            as_good.encoding.id(),
            Unit::Share.write(as_good.drawn.rms),
            Unit::Bytes.write(as_good.bytes as f64)
        ))
    }

    /// The options of `relume bake` that make what is recommended, beside those of the light and of the rays.
    #[must_use]
    pub fn options(&self) -> String {
        let row = &self.rows[self.choice.row];
        self.options_of(row.basis, row.stored[self.choice.stored].encoding)
    }

    /// The same for any basis in any encoding.
    pub(crate) fn options_of(&self, basis: Basis, encoding: Encoding) -> String {
        let (basis, encoding) = (typed(basis), encoding.id());
        format!("--storage texture --lighting fixed {} --basis {basis} --encoding {encoding}", self.sheet_options)
    }

    fn notes(&self) -> String {
        let (largest, place) = self.worst();
        let drawn = if self.has_normal_maps {
            format!("at {} normals that the normal maps hold", super::PICKED)
        } else {
            "at the surface's own normal, since no normal map is in use".to_owned()
        };
        let ringing = match self.negative {
            0.0 => String::new(),
            share => format!(
                "{} of the irradiance drawn is below 0, which u8 makes 0: noise, or ringing of a light in few bands (see --window auto).\n",
                Unit::Share.write(share)
            ),
        };
        format!(
            "\n{} texels that see something, mean irradiance / pi {:.4} over the hemisphere, {:.4} as drawn.\nIMSE, rms, worst: irradiance / \
             pi over the hemisphere; rms and worst (of one texel) against the mean.\ndrawn, 99 %: {drawn}, against the mean there.\nf32, \
             f16, u8, bc6h: bytes of {} texels, errors with what the encoding loses.\nns: one evaluation, three channels, f32, one \
             thread.\nThe worst texel of {largest} {place}.\n{ringing}",
            self.texels, self.mean, self.drawn_mean, self.sheet_texels
        )
    }

    /// The worst texel of the basis chosen, in words.
    fn worst(&self) -> (&'static str, String) {
        let row = &self.rows[self.choice.row];
        let Worst { sheet, place: [y, x], position: [a, b, c], mesh, .. } = &row.worst;
        let place = format!("is row {y}, column {x} of sheet {sheet}: ({a:.3}, {b:.3}, {c:.3}) on '{mesh}'");
        (row.basis.name(), place)
    }
}

/// The name of a basis as `--basis` takes it.
fn typed(basis: Basis) -> String {
    match basis {
        // Its name ends in the number of its functions, which nobody types.
        Basis::Hl2 => "hl2".into(),
        _ => basis.name().to_lowercase().replace("modified ", "modified-").replace(' ', ""),
    }
}

/// A share for a column: what is rounding is not told digit by digit.
fn share(value: f64) -> String {
    if value > 0.0 && value < 1e-5 { "< 0.001 %".into() } else { Unit::Share.write(value) }
}

fn line(row: &Row) -> String {
    let exact = row.stored[0].drawn;
    let mut text = format!(
        "{:<13} {:>9.3e} {:>7} {:>7} {:>9} {:>9} {:>9}",
        row.basis.name(),
        row.imse,
        share(row.relative),
        share(row.worst.relative),
        share(exact.rms),
        share(exact.p99),
        Unit::Bytes.write(row.stored[0].bytes as f64)
    );
    for (stored, width) in row.stored[1..].iter().zip([9, 7, 7]) {
        let (bytes, rms) = (Unit::Bytes.write(stored.bytes as f64), share(stored.drawn.rms));
        // Writing to a string cannot fail.
        let _ = write!(text, "  {bytes:>8} {rms:>width$}");
    }
    text + &format!(" {:>6.2}\n", row.nanoseconds)
}

fn values(row: &Row, stored: &Stored, is_chosen: bool) -> String {
    let Worst { sheet, place: [y, x], position: [a, b, c], mesh, relative } = &row.worst;
    let mesh =
        if mesh.contains([',', '"', '\n', '\r']) { format!("\"{}\"", mesh.replace('"', "\"\"")) } else { mesh.clone() };
    format!(
        "{},{},{:.9e},{:.9},{relative:.9},{sheet},{y},{x},{a},{b},{c},{mesh},{:.3},{},{},{:.9},{:.9},{is_chosen}\n",
        row.basis.name(),
        row.basis.count(),
        row.imse,
        row.relative,
        row.nanoseconds,
        stored.encoding.id(),
        stored.bytes,
        stored.drawn.rms,
        stored.drawn.p99
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_can_be_typed() {
        for basis in Basis::ALL {
            assert_eq!(Basis::named(&typed(basis)), Some(basis), "{}", typed(basis));
        }
        assert_eq!([typed(Basis::ModifiedH6), typed(Basis::Hl2)], ["modified-h6", "hl2"]);
    }
}
