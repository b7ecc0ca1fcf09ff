//! Windows: the known optimum, kernels and reconstructions that are nowhere negative, and the automatic rule.

use glam::DVec3;
use sh_math::{Bands, Rgb, project, window, zonal};
use std::f64::consts::PI;
use testkit::assert_close;

fn bands(count: u32) -> Bands {
    Bands::new(count).expect("in range")
}

/// Suns of the given directions and irradiances over a constant sky of radiance `sky`.
fn light(bands: Bands, suns: &[(DVec3, f64)], sky: f64) -> Rgb {
    let mut light = project(bands, suns.iter().map(|&(direction, irradiance)| (direction, [irradiance; 3])));
    for channel in &mut light.values[0] {
        *channel += (sky * (4.0 * PI).sqrt()) as f32;
    }
    light
}

/// One sun over a sky: irradiance of the sun by that of the sky, at `n` bands.
fn sun_and_sky(n: u32, ratio: f64) -> Rgb {
    light(bands(n), &[(DVec3::new(2.0, -3.0, 6.0) / 7.0, ratio * PI)], 1.0)
}

fn sun(n: u32) -> Rgb {
    light(bands(n), &[(DVec3::new(2.0, -3.0, 6.0) / 7.0, 1.0)], 0.0)
}

/// The kernel of a window, `sum_l s_l (2l+1)/(4 pi) P_l(z)`.
fn kernel(factors: &[f64], z: f64) -> f64 {
    let (mut before, mut value, mut sum) = (0.0, 1.0, 0.0);
    for (l, factor) in factors.iter().enumerate() {
        sum += factor * (2 * l + 1) as f64 / (4.0 * PI) * value;
        let l = l as f64;
        (before, value) = (value, ((2.0 * l + 1.0) * z * value - l * before) / (l + 1.0));
    }
    sum
}

fn lowest_of_kernel(factors: &[f64]) -> f64 {
    (0..=4000).map(|i| kernel(factors, 1.0 - f64::from(i) / 2000.0)).fold(f64::INFINITY, f64::min)
        / kernel(factors, 1.0)
}

/// Optima found elsewhere, to eight digits.
#[test]
fn non_negative_window_equals_known_optimum() {
    let known: [&[f64]; 5] = [
        &[1.0, 0.571_290_87, 0.228_899_99],
        &[1.0, 0.685_485_50, 0.365_937_12, 0.110_461_30],
        &[1.0, 0.769_739_14, 0.506_065_31, 0.241_679_23, 0.081_334_57],
        &[1.0, 0.819_050_62, 0.591_341_60, 0.347_825_77, 0.161_414_46, 0.047_045_99],
        &[1.0, 0.882_856_99, 0.719_393_75, 0.523_069_22, 0.340_167_12, 0.187_698_53, 0.082_646_28, 0.023_875_68],
    ];
    for known in known {
        let found = window::non_negative(bands(known.len() as u32));
        for (a, b) in found.iter().zip(known) {
            assert_close!(*a, *b, 3e-8, 0.0, "{} bands", known.len());
        }
    }
}

#[test]
fn kernels_are_not_negative() {
    for n in (1..=16).chain([33, 64, 129]) {
        let lowest = lowest_of_kernel(&window::non_negative(bands(n)));
        assert!(lowest >= -1e-12, "{n} bands: the kernel falls to {lowest:e}");
    }
    assert!(lowest_of_kernel(&[1.0; 5]) < -0.1, "no window must be seen to ring");
}

/// The hard case: one sun, 2 to 10 bands; nothing negative, the energy kept.
#[test]
fn sun_never_rings_under_the_kernel() {
    for n in 2..=10 {
        let light = sun(n);
        let factors = window::non_negative(light.bands);
        let highest = light.windowed(&factors).reconstruct(DVec3::new(2.0, -3.0, 6.0).as_vec3() / 7.0)[0];
        let lowest = window::minimum(&light, &factors);
        assert!(lowest >= -1e-6 * f64::from(highest), "{n} bands fall to {lowest:e}");
        assert_eq!(factors[0], 1.0, "the energy stays");
        assert!(window::minimum(&light, &vec![1.0; n as usize]) < -0.05, "{n} bands without a window must ring");
    }
}

/// The printed depths of the ringing: they check the search for the minimum.
#[test]
fn minimum_finds_the_known_depths() {
    for (n, depth) in [(3, -0.200), (4, -0.250), (5, -0.152), (6, -0.167)] {
        let light = sun(n);
        let highest = f64::from((n * n) as u16) / (4.0 * PI);
        let lowest = window::minimum(&light, &vec![1.0; n as usize]);
        assert_close!(lowest / highest, depth, 6e-4, 0.0, "{n} bands");
    }
}

#[test]
fn any_light_stays_positive_under_the_kernel() {
    let mut state = 17_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    for _ in 0..30 {
        let mut suns = Vec::new();
        for _ in 0..6 {
            let direction = DVec3::new(random() - 0.5, random() - 0.5, random() - 0.5).normalize();
            suns.push((direction, libm::exp(12.0 * random())));
        }
        let light = light(bands(5), &suns, 0.0);
        let lowest = window::minimum(&light, &window::non_negative(bands(5)));
        assert!(lowest >= -1e-6 * f64::from(light.values[0][0]), "{suns:?} falls to {lowest}");
    }
}

/// A bare sun: its windowed reconstruction is the window's own kernel. With 3 bands and lambda 1/4 that is
/// `3 (1 + z)^2 / (16 pi)`, which just touches zero.
#[test]
fn lambda_of_a_sun_just_lifts_the_kernel() {
    for n in 3..=10 {
        let lambda = window::find_lambda(&sun(n)).expect("a sun can be smoothed");
        if n == 3 {
            assert_close!(lambda, 0.25, 1e-6, 0.0);
        }
        let lowest = lowest_of_kernel(&window::laplacian(lambda, bands(n)));
        assert!(lowest > -1e-6, "{n} bands: lambda {lambda} leaves {lowest:e}");
        let lowest = lowest_of_kernel(&window::laplacian(0.99 * lambda, bands(n)));
        assert!(lowest < -1e-6, "{n} bands: less than lambda {lambda} would do");
    }
}

/// Lambdas found elsewhere by trying ever larger ones: up to 4 % above the smallest, never below it.
#[test]
fn lambda_is_just_below_known_search() {
    let below = |light: &Rgb, known: f64| {
        let lambda = window::find_lambda(light).expect("a sun can be smoothed");
        assert!(lambda <= known && lambda >= 0.96 * known, "{lambda} is not just below {known}");
    };
    for (n, known) in [(3, 0.255), (4, 0.373), (5, 0.325), (6, 0.348)] {
        below(&sun(n), known);
    }
    for (ratio, known) in [(10.0, 0.0109), (3.0, 0.0040)] {
        below(&sun_and_sky(5, ratio), known);
    }
    assert_eq!(window::find_lambda(&sun_and_sky(5, 1.0)), Some(0.0), "a weak sun does not ring");
}

#[test]
fn lambda_is_the_smallest() {
    for ratio in [3.0, 10.0, 100.0] {
        let light = sun_and_sky(5, ratio);
        let lambda = window::find_lambda(&light).expect("a sun can be smoothed");
        assert!(window::minimum(&light, &window::laplacian(lambda, bands(5))) >= 0.0, "ratio {ratio} still rings");
        let less = window::minimum(&light, &window::laplacian(0.99 * lambda, bands(5)));
        assert!(less < 0.0, "ratio {ratio}: a smaller lambda would do, minimum {less}");
    }
}

#[test]
fn lambda_needs_a_positive_mean() {
    let mut light = Rgb::black(bands(3));
    assert_eq!(window::find_lambda(&light), Some(0.0), "black does not ring");
    light.values[2] = [1.0; 3];
    assert_eq!(window::find_lambda(&light), None, "a light without mean cannot be lifted");
}

#[test]
fn automatic_rule_chooses_the_better() {
    assert_eq!(window::automatic(&sun_and_sky(5, 1.0)), vec![1.0; 5], "nothing rings: no window");
    for n in 3..=6 {
        assert_eq!(
            window::automatic(&sun(n)),
            window::non_negative(bands(n)),
            "{n} bands: a bare sun takes the kernel"
        );
    }
    let light = sun_and_sky(5, 10.0);
    let chosen = window::automatic(&light);
    assert_ne!(chosen, window::non_negative(bands(5)), "a sky needs less than the kernel");
    assert!(window::minimum(&light, &chosen) >= 0.0, "the chosen window must do");
    let (own, fixed) =
        (window::irradiance_error(&light, &chosen), window::irradiance_error(&light, &window::non_negative(bands(5))));
    assert!(own < fixed, "the searched window errs by {own}, the kernel by {fixed}");
}

/// Error of a sun's irradiance over all degrees, as printed with the optima.
#[test]
fn kernel_errs_as_known() {
    let power = |l: usize| (2 * l + 1) as f64 * zonal::clamped_cosine(l).powi(2);
    let total: f64 = (0..200).map(power).sum();
    for (n, known) in [(3, 0.412), (4, 0.323), (5, 0.249), (6, 0.205)] {
        let factors = window::non_negative(bands(n));
        let lost = |l: usize| power(l) * (1.0 - factors.get(l).copied().unwrap_or(0.0)).powi(2);
        let error = ((0..200).map(lost).sum::<f64>() / total).sqrt();
        assert_close!(error, known, 6e-4, 0.0, "{n} bands");
    }
}
