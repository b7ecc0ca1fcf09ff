//! A light as a linear map: the product of a function with it, coefficients in and coefficients out.

use crate::product::{Triple, triples};
use crate::{Bands, Rgb};

/// The triple products that turn lights into matrices: made once for a number of bands.
///
/// `M_ik = integral of L Y_i Y_k = sum_j T_ijk L_j` (\[T\] section 5, TPFL). Of a light all bands that can reach the product count, the first
/// `2 n - 1`: with the paper's `n` bands of light the product of peaky lights errs 1.8 to 3.6 times more, at the same cost per fragment.
#[derive(Debug, Clone)]
pub struct LightProduct {
    bands: Bands,
    light_bands: Bands,
    /// `a` and `c` are the functions of the matrix, `b` that of the light.
    terms: Vec<Triple>,
}

impl LightProduct {
    /// For functions of so many bands and lights of all the bands that count, `2 n - 1`.
    #[must_use]
    pub fn new(bands: Bands) -> Self {
        Self::with_light(bands, Self::light_bands(bands))
    }

    /// For lights cut to fewer bands, such as the `n` of the paper.
    #[must_use]
    pub fn with_light(bands: Bands, light_bands: Bands) -> Self {
        let light_bands = light_bands.min(Self::light_bands(bands));
        Self { bands, light_bands, terms: triples(bands, light_bands, bands) }
    }

    /// The bands of a light that can reach a product of functions of so many bands.
    #[must_use]
    pub fn light_bands(bands: Bands) -> Bands {
        let wanted = (2 * bands.count() - 1) as u32;
        Bands::new(wanted.min(Bands::MAX)).unwrap_or(bands)
    }

    /// Bands of the functions.
    #[must_use]
    pub fn bands(&self) -> Bands {
        self.bands
    }

    /// The integrals that are not 0, by function of the product, of the light and of the factor: the tensor of TP.
    #[must_use]
    pub fn terms(&self) -> &[Triple] {
        &self.terms
    }

    /// The matrix of a light, `[row][column]`, RGB, symmetric. Bands that the light lacks count as black.
    #[must_use]
    pub fn matrix(&self, light: &Rgb) -> Vec<[f32; 3]> {
        let light = light.with_bands(self.light_bands);
        let side = self.bands.coefficients();
        let mut sums = vec![[0.0f64; 3]; side * side];
        for term in &self.terms {
            let slot = &mut sums[term.a as usize * side + term.c as usize];
            for (sum, l) in slot.iter_mut().zip(light.values[term.b as usize]) {
                *sum += term.value * f64::from(l);
            }
        }
        sums.into_iter().map(|sum| sum.map(|x| x as f32)).collect()
    }

    /// The product of a function with a light, term by term (TP): what the matrix gives by `M v`.
    #[must_use]
    pub fn product(&self, light: &Rgb, function: &[f32]) -> Vec<[f32; 3]> {
        let light = light.with_bands(self.light_bands);
        let mut sums = vec![[0.0f64; 3]; self.bands.coefficients()];
        for term in &self.terms {
            let factor = term.value * f64::from(function[term.c as usize]);
            for (sum, l) in sums[term.a as usize].iter_mut().zip(light.values[term.b as usize]) {
                *sum += factor * f64::from(l);
            }
        }
        sums.into_iter().map(|sum| sum.map(|x| x as f32)).collect()
    }
}

/// A function times the matrix of a light: `U = M v`, RGB per coefficient.
#[must_use]
pub fn apply(matrix: &[[f32; 3]], function: &[f32]) -> Vec<[f32; 3]> {
    let row = |row: &[[f32; 3]]| {
        let mut sum = [0.0f32; 3];
        for (entry, v) in row.iter().zip(function) {
            sum.iter_mut().zip(entry).for_each(|(sum, m)| *sum += m * v);
        }
        sum
    };
    matrix.chunks_exact(function.len()).map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate_f64;
    use glam::DVec3;
    use testkit::quadrature::sphere_quadrature;

    fn bands(n: u32) -> Bands {
        Bands::new(n).unwrap()
    }

    /// Some light with all of nine bands.
    fn light(n: u32) -> Rgb {
        let value = |i: usize| {
            let x = 0.37 * (i * i % 11) as f32 - 1.1;
            [x / (1.0 + i as f32 * 0.05), 0.5 - 0.01 * i as f32, 0.2 * x * x]
        };
        Rgb { bands: bands(n), values: (0..(n * n) as usize).map(value).collect() }
    }

    /// `int L Y_i Y_k` as a sum over the sphere.
    fn worst(product: &LightProduct, light: &Rgb) -> f64 {
        let side = product.bands().coefficients();
        let mut exact = vec![[0.0f64; 3]; side * side];
        let (mut small, mut large) = (vec![0.0; side], vec![0.0; light.bands.coefficients()]);
        for (direction, weight) in sphere_quadrature(14) {
            evaluate_f64(product.bands(), DVec3::from(direction), &mut small);
            evaluate_f64(light.bands, DVec3::from(direction), &mut large);
            for c in 0..3 {
                let l: f64 = large.iter().zip(&light.values).map(|(y, l)| y * f64::from(l[c])).sum();
                for i in 0..side {
                    for k in 0..side {
                        exact[i * side + k][c] += weight * l * small[i] * small[k];
                    }
                }
            }
        }
        let matrix = product.matrix(light);
        let pairs = matrix.as_flattened().iter().zip(exact.as_flattened());
        pairs.map(|(a, b)| (f64::from(*a) - b).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn the_matrix_is_the_integral_with_all_bands_and_not_with_fewer() {
        let light = light(9);
        let full = worst(&LightProduct::new(bands(5)), &light);
        let cut = worst(&LightProduct::with_light(bands(5), bands(5)), &light);
        assert!(full < 1e-6, "{full:e}");
        assert!(cut > 1e-2, "the paper's n bands must show: {cut:e}");
    }

    #[test]
    fn a_white_light_changes_nothing_and_the_matrix_is_symmetric() {
        let mut white = Rgb::black(bands(9));
        white.values[0] = [(4.0 * std::f32::consts::PI).sqrt(); 3];
        let product = LightProduct::new(bands(5));
        let matrix = product.matrix(&white);
        let colored = product.matrix(&light(9));
        for i in 0..25 {
            for k in 0..25 {
                let one = if i == k { 1.0 } else { 0.0 };
                assert!((matrix[i * 25 + k][1] - one).abs() < 1e-6, "{i} {k}");
                assert!((colored[i * 25 + k][0] - colored[k * 25 + i][0]).abs() < 1e-6, "{i} {k}");
            }
        }
    }

    /// TP, TPFL and the exchange of the two factors agree.
    #[test]
    fn term_by_term_is_the_matrix() {
        let product = LightProduct::with_light(bands(5), bands(5));
        let light = light(5);
        let function: Vec<f32> = (0..25).map(|i| 0.3 - 0.02 * i as f32).collect();
        let terms = product.product(&light, &function);
        let matrix = apply(&product.matrix(&light), &function);
        let as_light = Rgb { bands: bands(5), values: function.iter().map(|&x| [x; 3]).collect() };
        let red: Vec<f32> = light.values.iter().map(|l| l[0]).collect();
        let exchanged = product.product(&as_light, &red);
        for i in 0..25 {
            for c in 0..3 {
                assert!((terms[i][c] - matrix[i][c]).abs() < 1e-5, "{i} {c}");
            }
            assert!((terms[i][0] - exchanged[i][0]).abs() < 1e-5, "{i}");
        }
        assert!((terms[3][0] - matrix[4][0]).abs() > 1e-3, "another row must show");
    }
}
