//! Lobes of surfaces that shine: radially symmetric about the mirror direction, by perceptual roughness.
//!
//! A lobe `B` has the integral 1 over the sphere, so band 0 of its convolution factors is 1 (\[T\] section 3 has no normalisation). What a
//! surface mirrors is `sum_lm b_l U_lm Y_lm(R)`, `U` the radiance that arrives and is not blocked, divided by the same sum over the open
//! hemisphere, [`open_energy`]: of a white furnace it receives 1 for every roughness and every view; [`crate::brdf`] says what it returns of that.

use crate::{Bands, legendre, zonal};

/// A family of lobes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Lobe {
    /// `D(t/2) cos t` of GGX, as prefiltered reflections have it: the lobe taken head-on, t from the mirror direction.
    Ggx,
    /// `(s + 1) / (2 pi) max(0, cos t)^s` with the exponent of [`phong_exponent`].
    Phong,
}

impl Lobe {
    /// Both families.
    pub const ALL: [Self; 2] = [Self::Ggx, Self::Phong];

    /// The name as typed and printed.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Ggx => "ggx",
            Self::Phong => "phong",
        }
    }

    /// Factors of the degrees `0..count` at a perceptual roughness in [0, 1]: `2 pi int B(t) P_l(cos t) sin t dt`; all 1 at roughness 0.
    #[must_use]
    pub fn factors(self, roughness: f64, count: usize) -> Vec<f64> {
        let roughness = roughness.clamp(0.0, 1.0);
        if roughness == 0.0 {
            return vec![1.0; count];
        }
        match self {
            Self::Phong => {
                let exponent = phong_exponent(roughness);
                (0..count).map(|l| zonal::phong(exponent, l)).collect()
            }
            Self::Ggx => ggx_factors(roughness * roughness, count),
        }
    }

    /// Share of the lobe's energy `int B^2` that its first `count` degrees hold: \[T\] shows 5 bands with exponents of which they hold 22 %.
    #[must_use]
    pub fn kept(self, roughness: f64, count: usize) -> f64 {
        let energy = |(l, b): (usize, f64)| (2 * l + 1) as f64 * b * b;
        let all = self.energy(roughness.clamp(1e-3, 1.0));
        let held: f64 = self.factors(roughness.max(1e-3), count).into_iter().enumerate().map(energy).sum();
        (held / all).min(1.0)
    }

    /// `4 pi int B^2` over the sphere: what `sum_l (2 l + 1) b_l^2` tends to.
    fn energy(self, roughness: f64) -> f64 {
        match self {
            Self::Phong => {
                let s = phong_exponent(roughness);
                2.0 * (s + 1.0) * (s + 1.0) / (2.0 * s + 1.0)
            }
            Self::Ggx => {
                let density = |x: f64, alpha: f64| {
                    let base = alpha * alpha + x * (1.0 - alpha * alpha);
                    (1.0 - 2.0 * x) / (base * base)
                };
                let alpha = roughness * roughness;
                let (mut one, mut square) = (0.0, 0.0);
                for (x, weight) in ggx_nodes(alpha) {
                    one += weight;
                    square += weight * density(x, alpha);
                }
                // dw = 4 pi dx, and the weights hold the density once.
                square / (one * one)
            }
        }
    }
}

/// The exponent of a Phong lobe as wide as GGX of that perceptual roughness: `(1 / alpha^2 - 1) / 2`, `alpha = roughness^2`.
///
/// A normal distribution of exponent `2 / alpha^2 - 2` (B. Walter et al. 2007) has a lobe about the mirror direction of a quarter of it.
#[must_use]
pub fn phong_exponent(roughness: f64) -> f64 {
    let alpha = (roughness * roughness).max(1e-6);
    0.5 * (1.0 / (alpha * alpha) - 1.0)
}

/// The perceptual roughness of an exponent: the inverse of [`phong_exponent`].
#[must_use]
pub fn roughness_of_exponent(exponent: f64) -> f64 {
    let alpha = (1.0 / (2.0 * exponent.max(0.0) + 1.0)).sqrt();
    alpha.sqrt()
}

/// `sum_l b_l c_l P_l(cosine)` over the bands that are kept, `c_l = (2 l + 1) / 2 int_0^1 P_l` the coefficients of the hemisphere: what a
/// lobe about a direction, of that cosine with the normal, receives from an open white hemisphere. A cosine below 0 counts as 0.
#[must_use]
pub fn open_energy(factors: &[f32], cosine: f32) -> f32 {
    let x = f64::from(cosine.max(0.0));
    let legendre = legendre::polynomials(factors.len(), x);
    let terms = factors.iter().zip(legendre).zip(hemisphere(factors.len()));
    terms.map(|((b, p), c)| f64::from(*b) * p * c).sum::<f64>() as f32
}

/// Share of a whole lobe of [`Lobe::Ggx`] that lies above a surface of whose normal its direction has the `cosine`: within 0.0065 of the integral.
///
/// `(1 + x sqrt((q + 4 a^2) / (q x^2 + 4 a^2))) / 2`, `a = roughness^2`, `q = (1 - a) (1 + 2.6 a)`: the share of a plane of slopes, which narrow
/// lobes have, and `(1 + x) / 2` of the widest. A cosine below 0 counts as 0: half.
#[must_use]
pub fn above(roughness: f32, cosine: f32) -> f32 {
    let x = cosine.clamp(0.0, 1.0);
    let alpha = roughness * roughness;
    let (slopes, width) = ((1.0 - alpha) * (1.0 + 2.6 * alpha), 4.0 * alpha * alpha);
    0.5 + 0.5 * x * ((slopes + width) / (slopes * x * x + width).max(1e-12)).sqrt()
}

/// The Legendre coefficients of the hemisphere, `(2 l + 1) / 2 int_0^1 P_l`: 1/2, 3/4, 0, -7/16, ...
#[must_use]
pub fn hemisphere(count: usize) -> Vec<f64> {
    (0..count).map(|l| (2 * l + 1) as f64 * 0.5 * zonal::phong(0.0, l)).collect()
}

/// Rows of [`table`].
pub const ROWS: usize = 65;

/// The factors by roughness `k / (ROWS - 1)`, `[row][degree]`: what renderers interpolate linearly between rows.
#[must_use]
pub fn table(lobe: Lobe, bands: Bands) -> Vec<f32> {
    let row = |k: usize| lobe.factors(k as f64 / (ROWS - 1) as f64, bands.count());
    (0..ROWS).flat_map(row).map(|b| b as f32).collect()
}

/// The factors at a roughness, interpolated between the rows of [`table`].
pub fn read(table: &[f32], roughness: f32, out: &mut [f32]) {
    let place = roughness.clamp(0.0, 1.0) * (ROWS - 1) as f32;
    let low = (place as usize).min(ROWS - 2);
    let blend = place - low as f32;
    let (count, start) = (out.len(), low * out.len());
    for (l, value) in out.iter_mut().enumerate() {
        let (a, b) = (table[start + l], table[start + count + l]);
        *value = a + blend * (b - a);
    }
}

/// Points `x = sin^2(t/2)` in [0, 1/2] with weights `D(t/2) cos t dx` of GGX, not normalised.
///
/// `int dx / (alpha^2 + beta x)^2` is uniform in `y = x / (alpha^2 + beta x)`: a Gauss rule there, in two parts, the second for the tail.
fn ggx_nodes(alpha: f64) -> Vec<(f64, f64)> {
    let (square, beta) = (alpha * alpha, 1.0 - alpha * alpha);
    let end = 0.5 / (square + 0.5 * beta);
    // The tail of the lobe lies in the last part of y in proportion to alpha^2.
    let ends = [0.0, 0.5, 0.9, 0.99, 0.999, 0.9999, 0.99999, 1.0].map(|share| share * end);
    let rule = legendre::gauss_rule(24);
    let mut nodes = Vec::new();
    for part in ends.windows(2) {
        let (middle, half) = (0.5 * (part[0] + part[1]), 0.5 * (part[1] - part[0]));
        for (z, weight) in &rule {
            let y = middle + half * z;
            let x = (square * y / (1.0 - beta * y)).min(0.5);
            // dx / (alpha^2 + beta x)^2 = dy / alpha^2
            nodes.push((x, half * weight * (1.0 - 2.0 * x) / square));
        }
    }
    nodes
}

fn ggx_factors(alpha: f64, count: usize) -> Vec<f64> {
    let mut sums = vec![0.0; count];
    for (x, weight) in ggx_nodes(alpha) {
        for (sum, p) in sums.iter_mut().zip(legendre::polynomials(count, 1.0 - 2.0 * x)) {
            *sum += weight * p;
        }
    }
    let one = sums[0];
    sums.into_iter().map(|sum| sum / one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// `2 pi int B P_l sin t dt` by the midpoint rule in the angle, written from the definition of GGX.
    fn by_angle(lobe: Lobe, roughness: f64, l: usize) -> f64 {
        let (mut sum, mut one) = (0.0, 0.0);
        let steps = 400_000;
        for k in 0..steps {
            let t = 0.5 * PI * (k as f64 + 0.5) / steps as f64;
            let weight = match lobe {
                Lobe::Ggx => {
                    let a = roughness.powi(4);
                    let half = (0.5 * t).cos().powi(2);
                    t.cos() * a / (PI * (half * (a - 1.0) + 1.0).powi(2))
                }
                Lobe::Phong => t.cos().powf(phong_exponent(roughness)),
            } * t.sin();
            one += weight;
            sum += weight * legendre::polynomials(l + 1, t.cos())[l];
        }
        sum / one
    }

    #[test]
    fn factors_are_those_of_the_lobes() {
        for lobe in Lobe::ALL {
            for roughness in [0.15, 0.3, 0.5, 0.8, 1.0] {
                let factors = lobe.factors(roughness, 8);
                for (l, factor) in factors.iter().enumerate() {
                    let exact = by_angle(lobe, roughness, l);
                    assert!((factor - exact).abs() < 2e-6, "{lobe:?} {roughness} {l}: {factor} {exact}");
                }
            }
        }
        let wrong = Lobe::Ggx.factors(0.5, 3)[2] - by_angle(Lobe::Ggx, 0.55, 2);
        assert!(wrong.abs() > 1e-3, "another roughness must show: {wrong}");
    }

    /// The lobe's part above a plane, by a sum over angles from its direction and about it.
    fn part_above(roughness: f64, cosine: f64) -> f64 {
        let sine = (1.0 - cosine * cosine).sqrt();
        let a = roughness.powi(4);
        let (mut sum, mut one) = (0.0, 0.0);
        let steps = 40_000;
        for k in 0..steps {
            let t = 0.5 * PI * (k as f64 + 0.5) / steps as f64;
            let half = (0.5 * t).cos().powi(2);
            let weight = t.cos() * t.sin() / (half * (a - 1.0) + 1.0).powi(2);
            let turned = (-cosine * t.cos() / (sine * t.sin()).max(1e-300)).clamp(-1.0, 1.0);
            one += weight;
            sum += weight * turned.acos() / PI;
        }
        sum / one
    }

    #[test]
    fn the_share_above_is_that_of_the_lobe() {
        for roughness in [0.1, 0.3, 0.5, 0.8, 1.0] {
            for cosine in [0.0, 0.02, 0.1, 0.3, 0.6, 1.0] {
                let (fit, exact) = (f64::from(above(roughness as f32, cosine as f32)), part_above(roughness, cosine));
                assert!((fit - exact).abs() < 7e-3, "{roughness} {cosine}: {fit} {exact}");
            }
        }
        assert!((f64::from(above(0.5, 0.3)) - part_above(0.6, 0.3)).abs() > 0.02, "can fail: another roughness");
        assert_eq!([above(0.0, 1e-3), above(0.0, 0.0), above(0.4, -1.0)], [1.0, 0.5, 0.5]);
    }

    /// \[T\] shows 5 bands with several exponents: they keep 99 % of the energy at 5, 91 at 10, 70 at 20, 39 at 50 and 22 at 100.
    #[test]
    fn five_bands_keep_what_was_measured() {
        for (exponent, share) in [(5.0, 0.99), (10.0, 0.91), (20.0, 0.70), (50.0, 0.39), (100.0, 0.22)] {
            let kept = Lobe::Phong.kept(roughness_of_exponent(exponent), 5);
            assert!((kept - share).abs() < 0.006, "{exponent}: {kept}");
        }
        assert!((Lobe::Ggx.kept(0.6, 64) - 1.0).abs() < 1e-3, "{}", Lobe::Ggx.kept(0.6, 64));
        assert!(Lobe::Ggx.kept(0.2, 5) < 0.3, "can fail");
    }

    #[test]
    fn exponents_and_roughness_are_inverse() {
        for s in [0.0, 1.0, 5.0, 100.0, 5000.0] {
            assert!((phong_exponent(roughness_of_exponent(s)) - s).abs() < 1e-6 * (1.0 + s), "{s}");
        }
    }

    /// Against a sum over the hemisphere of the lobe that the kept bands describe.
    #[test]
    fn open_energy_is_a_sum_over_the_hemisphere() {
        let factors: Vec<f32> = Lobe::Phong.factors(0.5, 5).into_iter().map(|b| b as f32).collect();
        for cosine in [1.0f64, 0.7, 0.2, 0.0] {
            let axis = [(1.0 - cosine * cosine).sqrt(), 0.0, cosine];
            let sum: f64 = testkit::quadrature::sphere_quadrature(400)
                .into_iter()
                .filter(|(d, _)| d[2] > 0.0)
                .map(|(d, weight)| {
                    let z: f64 = d.iter().zip(axis).map(|(a, b)| a * b).sum();
                    let terms = legendre::polynomials(5, z).into_iter().zip(&factors).enumerate();
                    let lobe: f64 = terms.map(|(l, (p, b))| (2 * l + 1) as f64 / (4.0 * PI) * f64::from(*b) * p).sum();
                    weight * lobe
                })
                .sum();
            let energy = f64::from(open_energy(&factors, cosine as f32));
            assert!((energy - sum).abs() < 2e-3, "{cosine}: {energy} {sum}");
        }
    }
}
