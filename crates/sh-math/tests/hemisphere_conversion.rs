//! Conversions and projections onto the bases of the hemisphere against the constants of the paper, an independent rule
//! and closed forms.

use glam::{DVec3, Vec3};
use sh_math::hemisphere::Basis;
use sh_math::{Bands, Rgb, evaluate_f64};
use std::f64::consts::PI;
use testkit::assert_close;
use testkit::quadrature::{hemisphere_tanh_sinh, sphere_quadrature};

fn bands() -> Bands {
    Bands::new(3).expect("3 bands exist")
}

fn harmonics(direction: DVec3) -> [f64; 9] {
    let mut out = [0.0; 9];
    evaluate_f64(bands(), direction, &mut out);
    out
}

fn values(basis: Basis, direction: DVec3) -> Vec<f64> {
    let mut out = vec![0.0; basis.count()];
    basis.evaluate_f64(direction, &mut out);
    out
}

/// The hemisphere by a rule that shares nothing with Gauss.
fn tanh_sinh() -> impl Iterator<Item = (DVec3, f64)> {
    hemisphere_tanh_sinh().into_iter().map(|(direction, weight)| (DVec3::from(direction), weight))
}

/// `int_hemisphere B_i Y_j`, `[i][j]`.
fn inner_products(basis: Basis) -> Vec<[f64; 9]> {
    let mut products = vec![[0.0; 9]; basis.count()];
    for (direction, weight) in tanh_sinh() {
        for (row, value) in products.iter_mut().zip(values(basis, direction)) {
            row.iter_mut().zip(harmonics(direction)).for_each(|(sum, y)| *sum += weight * value * y);
        }
    }
    products
}

/// Eq. of listing 2.1 without its modification: H from SH, in closed form.
fn h_from_sh() -> Vec<[f64; 9]> {
    let half = 0.5_f64.sqrt();
    let tilted = 0.375 * 2.5_f64.sqrt();
    let mut rows = vec![[0.0; 9]; 6];
    (rows[0][0], rows[0][2]) = (half, 0.375_f64.sqrt());
    (rows[1][1], rows[1][5]) = (half, tilted);
    (rows[2][2], rows[2][6]) = (0.5 * half, (15.0_f64 / 32.0).sqrt());
    (rows[3][3], rows[3][7]) = (half, tilted);
    (rows[4][4], rows[5][8]) = (half, half);
    rows
}

/// Listing 2.1 of the paper: modified H from SH, as printed, in units of its last digit.
fn listing() -> Vec<[f64; 9]> {
    let half = 70_711.0;
    let mut rows = vec![[0.0; 9]; 6];
    (rows[0][0], rows[0][2], rows[0][6]) = (half, 122_470.0, 118_590.0);
    (rows[1][1], rows[1][5]) = (half, 59_293.0);
    (rows[2][2], rows[2][6]) = (-half, -136_930.0);
    (rows[3][3], rows[3][7]) = (half, 59_293.0);
    (rows[4][4], rows[5][8]) = (half, half);
    rows.into_iter().map(|row| row.map(|digits| digits * 1e-5)).collect()
}

/// The largest difference of two matrices.
fn difference(a: &[[f64; 9]], b: &[[f64; 9]]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.as_flattened().iter().zip(b.as_flattened()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn h_has_its_closed_form() {
    let rows = Basis::H6.conversion().rows;
    assert!(difference(&rows, &h_from_sh()) <= 1e-14, "{rows:?}");
}

/// The exact constants behind the listing, by `H3 = sqrt(3) H1 - 2 H3mod`; the print agrees to its last digit.
#[test]
fn modified_h_is_the_listing_of_the_paper() {
    let mut exact = h_from_sh();
    let third = exact[2];
    exact[0].iter_mut().zip(third).for_each(|(first, third)| *first += 3.0_f64.sqrt() * third);
    exact[2] = third.map(|value| -2.0 * value);
    let rows = Basis::ModifiedH6.conversion().rows;
    assert!(difference(&rows, &exact) <= 1e-13, "{rows:?}");
    assert!(difference(&rows, &listing()) <= 5e-5, "{rows:?}");
    for (i, j, known) in [(0, 2, 1.2247448714), (0, 6, 1.1858541226), (1, 5, 0.5929270613), (2, 6, -1.3693063938)] {
        assert_close!(rows[i][j], known, 1e-10, 0.0, "entry {i} {j}");
    }
}

/// Inner products alone, without the Gram matrix, are not the coefficients of a basis that is not orthonormal.
#[test]
fn conversion_by_inner_products_can_fail() {
    let rows = Basis::ModifiedH6.conversion().rows;
    let wrong = difference(&rows, &inner_products(Basis::ModifiedH6));
    assert!((1.0..1.3).contains(&wrong), "rows 1 and 3 must differ, the largest difference is {wrong}");
    let right = difference(&Basis::H6.conversion().rows, &inner_products(Basis::H6));
    assert!(right <= 1e-12, "where the basis is orthonormal they are: {right:e}");
}

/// What a fit leaves over is orthogonal to every function of its basis: nothing better can be had.
#[test]
fn conversions_are_least_squares() {
    for basis in Basis::ALL.into_iter().filter(|basis| *basis != Basis::ModifiedH1) {
        let rows = basis.conversion().rows;
        let mut left_over = vec![[0.0; 9]; basis.count()];
        for (direction, weight) in tanh_sinh() {
            let values = values(basis, direction);
            let mut rest = harmonics(direction);
            for (row, value) in rows.iter().zip(&values) {
                rest.iter_mut().zip(row).for_each(|(rest, factor)| *rest -= factor * value);
            }
            for (sum, value) in left_over.iter_mut().zip(&values) {
                sum.iter_mut().zip(rest).for_each(|(sum, rest)| *sum += weight * value * rest);
            }
        }
        let worst = left_over.as_flattened().iter().fold(0.0_f64, |worst, v| worst.max(v.abs()));
        assert!(worst <= 1e-12, "{}: {worst:e} of the rest lies along a function", basis.name());
    }
}

#[test]
fn nine_harmonics_stay_what_they_are() {
    for (i, row) in Basis::Sh9.conversion().rows.iter().enumerate() {
        for (j, value) in row.iter().enumerate() {
            assert_close!(*value, f64::from(u8::from(i == j)), 1e-12, 0.0, "entry {i} {j}");
        }
    }
}

/// Leaving out the quadratic functions is the best fit of four; one coefficient is the value at the surface's normal.
#[test]
fn level_of_detail_is_a_cut() {
    let [six, four, one] = [Basis::ModifiedH6, Basis::ModifiedH4, Basis::ModifiedH1].map(|b| b.conversion().rows);
    assert!(difference(&six[..4], &four) <= 1e-13, "6 to 4");
    assert!(difference(&six[..1], &one) <= 1e-13, "4 to 1");
    let [six, four] = [Basis::H6, Basis::H4].map(|b| b.conversion().rows);
    assert!(difference(&six[..4], &four) <= 1e-13, "6 to 4 of H");
    for (basis, count) in [(Basis::ModifiedH6, 6), (Basis::ModifiedH4, 4)] {
        let up = values(basis, DVec3::Z);
        assert!(up[1..count].iter().all(|value| value.abs() <= 1e-15), "{}: {up:?}", basis.name());
    }
}

/// Spherical harmonics cannot be cut so: the first 4 of the 9 are not the fit of four.
#[test]
fn cut_of_harmonics_can_fail() {
    let [nine, four] = [Basis::Sh9, Basis::Sh4].map(|basis| basis.conversion().rows);
    let off = difference(&nine[..4], &four);
    assert!(off > 0.5, "the difference is {off}");
}

fn light() -> Rgb {
    let value = |i: usize| [0.3 + i as f32 * 0.1, 1.0 - i as f32 * 0.3, ((i * 5) % 7) as f32 * 0.2 - 0.5];
    Rgb { bands: bands(), values: (0..9).map(value).collect() }
}

/// SH 4, H 4 and modified H 4 all span 1, x, y, z: their fits are one function.
#[test]
fn equal_spans_are_one_fit() {
    let fits = [Basis::Sh4, Basis::H4, Basis::ModifiedH4].map(|basis| (basis, basis.conversion().apply(&light())));
    for i in 0..50 {
        let z = (i as f32 + 0.5) / 50.0;
        let normal = Vec3::new((1.0 - z * z).sqrt() * (i as f32).cos(), (1.0 - z * z).sqrt() * (i as f32).sin(), z);
        let [first, rest @ ..] = fits.each_ref().map(|(basis, coefficients)| basis.reconstruct(coefficients, normal));
        for other in rest {
            // f32 coefficients up to 3
            first.iter().zip(other).for_each(|(a, b)| assert_close!(*a, b, 3e-6, 0.0));
        }
    }
}

/// Samples of the signal give the coefficients that the matrix gives.
#[test]
fn projected_irradiance_is_the_conversion() {
    let signal = light();
    let sample = |(d, w): (DVec3, f64)| {
        let y = harmonics(d);
        (d, [0, 1, 2].map(|c| w * (0..9).map(|i| y[i] * f64::from(signal.values[i][c])).sum::<f64>()))
    };
    for basis in Basis::ALL {
        let projected = basis.project_irradiance(tanh_sinh().map(sample));
        let converted = basis.conversion().apply(&signal);
        for (a, b) in projected.as_flattened().iter().zip(converted.as_flattened()) {
            assert_close!(*a, *b, 1e-6, 1e-6, "{}", basis.name());
        }
    }
}

/// Radiance 1 from everywhere is irradiance / pi of 1 for every normal, in every basis that holds a constant.
#[test]
fn white_sky_shines_alike_on_every_normal() {
    let sky = || sphere_quadrature(8).into_iter().map(|(d, w)| (DVec3::from_array(d), [w, 0.5 * w, 0.0]));
    let hold_a_constant = |basis: &Basis| !matches!(basis, Basis::Hl2 | Basis::Makhotkin4 | Basis::Makhotkin9);
    for basis in Basis::ALL.into_iter().filter(hold_a_constant) {
        let coefficients = basis.project_radiance(sky());
        for normal in [Vec3::Z, Vec3::X, Vec3::new(2.0, -3.0, 6.0) / 7.0] {
            let [full, half, none] = basis.reconstruct(&coefficients, normal);
            assert_close!(full, 1.0, 2e-6, 0.0, "{} at {normal}", basis.name());
            assert_close!(half, 0.5, 2e-6, 0.0, "{} at {normal}", basis.name());
            assert_close!(none, 0.0, 2e-6, 0.0, "{} at {normal}", basis.name());
        }
    }
    let dark = Basis::Makhotkin9.project_radiance(sky());
    assert_eq!(Basis::Makhotkin9.reconstruct(&dark, Vec3::X), [0.0; 3], "Makhotkin is black at the border");
}

/// One lamp of radiance * solid angle 1: what the first coefficient of the modified H-basis makes of `cos / pi`.
///
/// The paper calls that coefficient the traditional light map; it is so only after a cut to 3 bands.
#[test]
fn first_coefficient_is_a_light_map_of_three_bands() {
    for (degrees, known) in [(0.0_f64, 0.313), (85.0, 0.057), (90.0, 0.042)] {
        let angle = degrees.to_radians();
        let lamp = DVec3::new(angle.sin(), 0.0, angle.cos());
        let coefficients = Basis::ModifiedH1.project_radiance([(lamp, [1.0; 3])]);
        let value = f64::from(Basis::ModifiedH1.reconstruct(&coefficients, Vec3::Z)[0]);
        assert_close!(value, known, 5e-4, 0.0, "{degrees} degrees");
        let exact = angle.cos() / PI;
        assert!((value - exact).abs() > 0.004, "{degrees} degrees: it must be off the light map's {exact}");
    }
}
