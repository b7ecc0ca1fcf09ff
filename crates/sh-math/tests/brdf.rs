//! Fits of what glTF's surfaces return of a white sky, against its formulas by quadrature.

use sh_math::brdf::{MEAN_DIFFUSE_LOSS, diffuse_loss, environment_brdf, mean_environment_brdf};
use testkit::quadrature::gauss_legendre;

/// A, B and T of one view: glTF's formulas over directions of light, by half vectors that crowd where the facets do.
fn by_formula(roughness: f64, cosine: f64) -> [f64; 3] {
    let square = roughness.powi(4);
    let lambda = |c: f64| ((1.0 + square * (1.0 / (c * c) - 1.0)).sqrt() - 1.0) / 2.0;
    let view = [(1.0 - cosine * cosine).sqrt(), 0.0, cosine];
    let unit: Vec<(f64, f64)> = gauss_legendre(200).into_iter().map(|(x, w)| ((x + 1.0) / 2.0, w / 2.0)).collect();
    let turns = (0..400).map(|k| std::f64::consts::PI * (f64::from(k) + 0.5) / 400.0).collect::<Vec<_>>();
    let mut sums = [0.0; 3];
    for &(x, weight) in &unit {
        let share = 1.0 - (1.0 - x).powi(3);
        let cos = 1.0 / (1.0 + square * share / (1.0 - share)).sqrt();
        let weight_of_facet = weight * 3.0 * (1.0 - x).powi(2) / 400.0;
        for turn in &turns {
            let facing = view[0] * (1.0 - cos * cos).sqrt() * turn.cos() + cosine * cos;
            let light = 2.0 * facing * cos - cosine;
            if facing > 0.0 && light > 0.0 {
                let value = weight_of_facet * facing / (cosine * cos * (1.0 + lambda(cosine) + lambda(light)));
                let schlick = (1.0 - facing).powi(5);
                sums[0] += value * (1.0 - schlick);
                sums[1] += value * schlick;
            }
            // The diffuse part: light of that height.
            let between = view[0] * (1.0 - x * x).sqrt() * turn.cos() + cosine * x;
            let half = ((1.0 + between) / 2.0).max(0.0).sqrt();
            sums[2] += weight * 2.0 * x / 400.0 * (0.04 + 0.96 * (1.0 - half).powi(5));
        }
    }
    sums
}

/// Largest distances of A F0 + B, of T, and of the means; `bend` changes the roughness that is asked for.
fn apart(bend: fn(f32) -> f32) -> [f64; 3] {
    let mut worst = [0.0f64; 3];
    for roughness in [0.1, 0.2, 0.4, 0.55, 0.7, 0.85, 1.0] {
        let asked = bend(roughness as f32);
        let mut means = [0.0; 3];
        for (x, weight) in gauss_legendre(24) {
            let cosine = (x + 1.0) / 2.0;
            let exact = by_formula(roughness, cosine);
            means.iter_mut().zip(exact).for_each(|(sum, value)| *sum += weight * cosine * value);
            let [a, b] = environment_brdf(asked, cosine as f32).map(f64::from);
            if cosine >= 0.1 {
                for f0 in [0.04, 0.5, 1.0] {
                    worst[0] = worst[0].max((f0 * (a - exact[0]) + b - exact[1]).abs());
                }
            }
            worst[1] = worst[1].max((f64::from(diffuse_loss(cosine as f32)) - exact[2]).abs());
        }
        let [a, b] = mean_environment_brdf(asked).map(f64::from);
        for found in [a - means[0], b - means[1], f64::from(MEAN_DIFFUSE_LOSS) - means[2]] {
            worst[2] = worst[2].max(found.abs());
        }
    }
    worst
}

#[test]
fn fits_are_the_integrals_of_gltf() {
    let [brdf, loss, means] = apart(|roughness| roughness);
    assert!(brdf < 6e-3 && loss < 1e-4 && means < 6e-4, "{brdf} {loss} {means}");
}

#[test]
fn fits_can_fail() {
    let [brdf, _, means] = apart(|roughness| 0.93 * roughness);
    assert!(brdf > 6e-3 && means > 6e-4, "another roughness must show: {brdf} {means}");
}
