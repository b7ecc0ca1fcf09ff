//! The window with the least error among those whose kernel is nowhere negative.

use crate::legendre::{gauss_rule, polynomials};
use crate::{Bands, zonal};

/// Most steps of the descent. Very many bands (129) stop here short of the optimum; the kernel is a square at every step,
/// so it is never negative.
const MOST_STEPS: usize = 3000;

/// Factors `s_l` per band, `s_0 = 1`, whose kernel `sum_l s_l (2l+1)/(4 pi) P_l` is nowhere negative and which keep the
/// irradiance of a sun as exactly as such factors can.
///
/// Every non-negative light stays non-negative, whatever it looks like. 3 bands: 1, 0.5713, 0.2289; 5 bands: 1, 0.7697,
/// 0.5061, 0.2417, 0.0813. The irradiance of a bare sun then errs by 41 % (3 bands), 25 % (5), 14 % (8).
#[must_use]
pub fn non_negative(bands: Bands) -> Vec<f64> {
    if bands.count() == 1 {
        return vec![1.0];
    }
    let rule = Rule::new(bands);
    let mut root = vec![0.0; rule.basis.len()];
    root[0] = 1.0;
    for _ in 0..MOST_STEPS {
        let factors = rule.factors(&rule.values(&root));
        let step = rule.ascent(&root, &factors);
        root.iter_mut().zip(&step).for_each(|(coefficient, s)| *coefficient += s);
        let length = root.iter().map(|c| c * c).sum::<f64>().sqrt();
        root.iter_mut().for_each(|coefficient| *coefficient /= length);
        if step.iter().all(|s| s.abs() < 1e-15) {
            break;
        }
    }
    let mut factors = rule.factors(&rule.values(&root));
    factors[0] = 1.0;
    factors
}

/// The search space: kernels `p(z)^2`, or `(1 + z) p(z)^2` where the highest degree is odd, over the nodes of a Gauss rule.
struct Rule {
    /// Weight of a node times that factor `1 + z`.
    weights: Vec<f64>,
    /// `[node][degree]`, Legendre polynomials.
    legendre: Vec<Vec<f64>>,
    /// `[function][node]`, orthonormal under the weights; `p` is their sum.
    basis: Vec<Vec<f64>>,
    /// Share of a band's loss in the irradiance error: `(2l + 1) a_l^2`.
    importance: Vec<f64>,
}

impl Rule {
    fn new(bands: Bands) -> Self {
        let n = bands.count();
        let nodes = gauss_rule(n + 1);
        let legendre: Vec<Vec<f64>> = nodes.iter().map(|&(z, _)| polynomials(n, z)).collect();
        let odd = n.is_multiple_of(2);
        let weights: Vec<f64> =
            nodes.iter().map(|&(z, weight)| if odd { weight * (1.0 + z) } else { weight }).collect();
        let basis = orthonormal(n.div_ceil(2), &legendre, &weights);
        let cosine = zonal::clamped_cosine;
        let importance = bands.degrees().map(|l| (2 * l + 1) as f64 * cosine(l) * cosine(l)).collect();
        Self { weights, legendre, basis, importance }
    }

    /// `p` at the nodes.
    fn values(&self, root: &[f64]) -> Vec<f64> {
        let value = |node: usize| root.iter().zip(&self.basis).map(|(c, function)| c * function[node]).sum();
        (0..self.weights.len()).map(value).collect()
    }

    /// The factors of the kernel with the root `p`: its integrals against the Legendre polynomials.
    fn factors(&self, values: &[f64]) -> Vec<f64> {
        let mut factors = vec![0.0; self.importance.len()];
        for ((value, weight), legendre) in values.iter().zip(&self.weights).zip(&self.legendre) {
            let share = weight * value * value;
            factors.iter_mut().zip(legendre).for_each(|(factor, p)| *factor += share * p);
        }
        factors
    }

    /// Direction in which the error falls, along the unit sphere of the coefficients of `p`.
    fn ascent(&self, root: &[f64], factors: &[f64]) -> Vec<f64> {
        let lost: Vec<f64> = self.importance.iter().zip(factors).map(|(weight, s)| weight * (1.0 - s)).collect();
        let pull = |node: usize| -> f64 { lost[1..].iter().zip(&self.legendre[node][1..]).map(|(a, p)| a * p).sum() };
        let values = self.values(root);
        let pulls: Vec<f64> = (0..values.len()).map(|node| self.weights[node] * pull(node) * values[node]).collect();
        let gradient: Vec<f64> = self.basis.iter().map(|function| dot(function, &pulls)).collect();
        let along = dot(root, &gradient);
        root.iter().zip(&gradient).map(|(coefficient, g)| g - along * coefficient).collect()
    }
}

/// The first `count` Legendre polynomials made orthonormal under `weights` (Gram-Schmidt, done twice); `[function][node]`.
fn orthonormal(count: usize, legendre: &[Vec<f64>], weights: &[f64]) -> Vec<Vec<f64>> {
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).zip(weights).map(|((a, b), w)| a * b * w).sum::<f64>();
    let mut basis: Vec<Vec<f64>> = Vec::with_capacity(count);
    for degree in 0..count {
        let mut function: Vec<f64> = legendre.iter().map(|p| p[degree]).collect();
        for earlier in basis.iter().chain(&basis) {
            let share = product(&function, earlier);
            function.iter_mut().zip(earlier).for_each(|(f, e)| *f -= share * e);
        }
        let length = product(&function, &function).sqrt();
        function.iter_mut().for_each(|f| *f /= length);
        basis.push(function);
    }
    basis
}

/// Sum of products.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
