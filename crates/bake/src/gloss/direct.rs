//! How much of what arrives at a receiver is light that no surface has sent.

use sh_math::Bands;
use sh_math::product::{Triple, triples};

/// Sums of squares of the operators that make what arrives straight of the light.
pub(super) struct Direct {
    /// Entry of the matrix, coefficient of visibility, integral.
    terms: Vec<(u32, u32, f32)>,
    entries: usize,
}

impl Direct {
    pub(super) fn new(gloss: Bands, light: Bands) -> Self {
        let lights = light.coefficients() as u32;
        let term = |Triple { a, b, c, value }: Triple| (a * lights + b, c, value as f32);
        let terms = triples(gloss, light, gloss).into_iter().map(term).collect();
        Self { terms, entries: gloss.coefficients() * light.coefficients() }
    }

    /// Sum of the squares of `A_ij = sum_k T_ijk V_k` for a visibility V: light of random coefficients, of variance 1, arrives with it.
    pub(super) fn energy(&self, visibility: &[f32]) -> f64 {
        let mut matrix = vec![0.0f32; self.entries];
        for &(entry, k, value) in &self.terms {
            matrix[entry as usize] += value * visibility[k as usize];
        }
        matrix.iter().map(|x| f64::from(*x) * f64::from(*x)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An open sphere lets every coefficient through: the matrix is the identity. Half of it, in many bands, half of the squares.
    #[test]
    fn an_open_sphere_passes_all() {
        let bands = Bands::new(4).unwrap();
        let mut open = vec![0.0; 16];
        open[0] = (4.0 * std::f32::consts::PI).sqrt();
        let direct = Direct::new(bands, bands);
        assert!((direct.energy(&open) - 16.0).abs() < 1e-4);
        open[0] *= 0.5;
        assert!((direct.energy(&open) - 4.0).abs() < 1e-4, "can fail");
    }
}
