//! Every warp has the density it states and the inverse it states.

use glam::Vec3;
use sampling::{rng::Rng, sequence, warp};
use testkit::chi2::SphereBins;

/// One chance in a hundred that any of the warps fails without fault; the seeds are fixed, so it never flickers.
const ALPHA: f64 = 0.01;
const SAMPLES: usize = 200_000;
/// Coordinates survive the round trip but for roundings, which angles near the poles amplify.
const ROUND_TRIP: f32 = 2e-5;
/// Half angle of the wide cone; the narrow one is the sun.
const CONE: f32 = 0.7;
const SUN: f32 = 0.004_65;

struct Warp {
    name: &'static str,
    /// Upper end is 1.
    z_low: f64,
    warp: fn([f32; 2]) -> Vec3,
    pdf: fn(Vec3) -> f32,
    inverse: fn(Vec3) -> [f32; 2],
}

const WARPS: [Warp; 6] = [
    Warp {
        name: "uniform sphere",
        z_low: -1.0,
        warp: warp::square_to_uniform_sphere,
        pdf: warp::uniform_sphere_pdf,
        inverse: warp::uniform_sphere_to_square,
    },
    Warp {
        name: "uniform hemisphere",
        z_low: 0.0,
        warp: warp::square_to_uniform_hemisphere,
        pdf: warp::uniform_hemisphere_pdf,
        inverse: warp::uniform_hemisphere_to_square,
    },
    Warp {
        name: "cosine hemisphere",
        z_low: 0.0,
        warp: warp::square_to_cosine_hemisphere,
        pdf: warp::cosine_hemisphere_pdf,
        inverse: warp::cosine_hemisphere_to_square,
    },
    Warp {
        name: "cosine concentric",
        z_low: 0.0,
        warp: warp::square_to_cosine_concentric,
        pdf: warp::cosine_concentric_pdf,
        inverse: warp::cosine_concentric_to_square,
    },
    Warp {
        name: "wide cone",
        z_low: 0.764_842_187_284_488_4,
        warp: |u| warp::square_to_cone(u, warp::cone_height(CONE)),
        pdf: |d| warp::cone_pdf(d, warp::cone_height(CONE)),
        inverse: |d| warp::cone_to_square(d, warp::cone_height(CONE)),
    },
    Warp {
        name: "sun",
        z_low: 0.999_989_188_769_475_6,
        warp: |u| warp::square_to_cone(u, warp::cone_height(SUN)),
        pdf: |d| warp::cone_pdf(d, warp::cone_height(SUN)),
        inverse: |d| warp::cone_to_square(d, warp::cone_height(SUN)),
    },
];

fn directions(warp: &Warp) -> Vec<[f64; 3]> {
    let mut rng = Rng::new(11, 0);
    (0..SAMPLES).map(|_| (warp.warp)(rng.next_square()).to_array().map(f64::from)).collect()
}

fn check(warp: &Warp, pdf: impl Fn(Vec3) -> f64) -> Result<(), String> {
    let bins = SphereBins { z_range: [warp.z_low, 1.0], n_z: 20, n_phi: 40 };
    let pdf = |d: [f64; 3]| pdf(Vec3::from_array(d.map(|v| v as f32)));
    bins.test(&directions(warp), pdf, ALPHA, WARPS.len()).map(drop).map_err(|e| format!("{}: {e}", warp.name))
}

#[test]
fn warps_follow_their_densities() {
    // The sun is 1e-5 high: f32 cannot hold its z in 20 steps, so its density is tested by the round trip below.
    for warp in &WARPS[..5] {
        check(warp, |d| f64::from((warp.pdf)(d))).expect("the density is right");
    }
}

#[test]
fn wrong_densities_can_fail() {
    for warp in &WARPS[..5] {
        let pdf = |d| f64::from((warp.pdf)(d));
        assert!(check(warp, |d| 1.02 * pdf(d)).is_err(), "{}: 2 % too large", warp.name);
        assert!(check(warp, |d| pdf(d) * f64::from(1.0 + 0.1 * d.x)).is_err(), "{}: tilted by 10 %", warp.name);
    }
    let cosine = &WARPS[2];
    assert!(check(cosine, |d| f64::from(warp::uniform_hemisphere_pdf(d))).is_err(), "uniform is not cosine");
}

/// Largest error of a coordinate after the way there and back; the longitude wraps around.
fn round_trip_error(warp: &Warp, inverse: fn(Vec3) -> [f32; 2]) -> f32 {
    let mut rng = Rng::new(12, 0);
    let mut worst = 0.0_f32;
    for _ in 0..20_000 {
        // Away from the poles and the rim, where a coordinate has no influence or infinite slope.
        let u = rng.next_square().map(|v| 0.02 + 0.96 * v);
        let back = inverse((warp.warp)(u));
        assert!(back.iter().all(|v| (0.0..1.0).contains(v)), "{}: {back:?} leaves the square", warp.name);
        worst = (0..2).map(|k| (back[k] - u[k]).abs()).fold(worst, f32::max);
    }
    worst
}

#[test]
fn inverses_return_the_square() {
    for warp in &WARPS {
        let error = round_trip_error(warp, warp.inverse);
        assert!(error < ROUND_TRIP, "{}: {error}", warp.name);
    }
}

#[test]
fn wrong_inverses_can_fail() {
    for (warp, other) in WARPS.iter().zip(WARPS.iter().cycle().skip(1)) {
        assert!(round_trip_error(warp, other.inverse) > ROUND_TRIP, "{} against {}", warp.name, other.name);
    }
}

#[test]
fn corners_and_poles_are_unit_and_finite() {
    let below_one = 1.0 - f32::EPSILON / 2.0;
    for warp in &WARPS {
        for u in [[0.0, 0.0], [0.0, below_one], [below_one, 0.0], [below_one, below_one], [0.5, 0.5]] {
            let direction = (warp.warp)(u);
            assert!((direction.length() - 1.0).abs() < 1e-6, "{} at {u:?}: {direction}", warp.name);
            assert!((warp.pdf)(direction) >= 0.0, "{} at {u:?}", warp.name);
        }
        for pole in [Vec3::Z, -Vec3::Z, Vec3::X, -Vec3::X, -Vec3::Y] {
            let u = (warp.inverse)(pole);
            assert!(u.iter().all(|v| (0.0..1.0).contains(v)), "{} at {pole}: {u:?}", warp.name);
        }
    }
}

#[test]
fn uniform_sphere_is_equation_21() {
    let mut rng = Rng::new(13, 0);
    for _ in 0..1000 {
        let [x, y] = rng.next_square();
        let theta = 2.0 * libm::acos((1.0 - f64::from(x)).sqrt());
        let (sin_phi, cos_phi) = libm::sincos(2.0 * std::f64::consts::PI * f64::from(y));
        let expected = [theta.sin() * cos_phi, theta.sin() * sin_phi, theta.cos()];
        let direction = warp::square_to_uniform_sphere([x, y]).to_array();
        for k in 0..3 {
            testkit::assert_close!(direction[k], expected[k], 1e-6, 0.0);
        }
    }
}

#[test]
fn lattices_follow_the_cosine_too() {
    use sequence::Sequence::{Fibonacci, OwenSobol, Stratified};
    for sequence in [OwenSobol, Fibonacci, Stratified] {
        let mut points = Vec::new();
        sequence::fill(sequence, 10_000, 5, &mut points);
        let mean_z = points.iter().map(|&u| f64::from(warp::square_to_cosine_hemisphere(u).z)).sum::<f64>() / 1e4;
        testkit::assert_close!(mean_z, 2.0 / 3.0, 1e-3, 0.0, "{sequence:?}");
    }
}
