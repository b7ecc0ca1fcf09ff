//! Shadows against closed forms and quadrature that know nothing of rays.

mod support;

use coeff_io::{Prt, Quality, Sampler, Settings};
use glam::{DVec3, Vec3};
use sh_math::Bands;
use support::{fixed, grey, quiet};

fn openness(prt: &Prt) -> impl Iterator<Item = (Vec3, f64)> + '_ {
    prt.geometry.positions.iter().zip(&prt.transfer.openness).map(|(p, o)| (Vec3::from_array(*p), f64::from(*o)))
}

/// Form factor of a long wall, Howell B-4.
#[test]
fn half_blocked_plane_sees_the_share_beside_the_wall() {
    let prt = quiet(&grey("half-blocked-plane", 0.5), &fixed(2, Sampler::OwenSobol, 4096, 0));
    let mesh = &prt.meshes[0];
    let ground = openness(&prt).skip(mesh.first_vertex as usize).take(mesh.vertices as usize);
    for (p, share) in ground {
        let expected = scene::known::half_blocked_plane_share(f64::from(p.x), f64::from(p.z));
        assert!((share - expected).abs() <= 3e-3, "at {p}: {share}, expected {expected}");
    }
}

#[test]
fn sphere_on_plane_hides_its_form_factor() {
    let prt = quiet(&grey("sphere-on-plane", 0.5), &fixed(2, Sampler::OwenSobol, 4096, 0));
    for (p, share) in openness(&prt).filter(|(p, _)| p.y == 0.0 && p.truncate().length() > 0.05) {
        let rho = f64::from(p.x).hypot(f64::from(p.z));
        if rho < 0.3 {
            continue; // under the belly, where the facets of the sphere decide
        }
        let expected = scene::known::sphere_on_plane_share(rho);
        assert!((share - expected).abs() <= 5e-3, "at {p}: {share}, expected {expected}");
    }
}

/// All coefficients of a shadowed receiver against a quadrature over the sphere with an analytic shadow.
#[test]
fn coefficients_match_quadrature() {
    let bands = Bands::new(5).expect("in range");
    let prt = quiet(&grey("sphere-on-plane", 0.5), &fixed(5, Sampler::Fibonacci, 16384, 0));
    let (mut worst, mut worst_unshadowed) = (0.0f64, 0.0f64);
    for (receiver, p) in prt.geometry.positions.iter().enumerate().filter(|(_, p)| p[1] == 0.0).step_by(7) {
        let p = DVec3::from_array(p.map(f64::from));
        if p.length() < 0.3 {
            continue;
        }
        let expected = quadrature(bands, |w| w.y > 0.0 && !meets_sphere(p, w));
        let open = quadrature(bands, |w| w.y > 0.0);
        let row = &prt.transfer.values[receiver * 25..][..25];
        worst = worst.max(distance(row, &expected) / norm(&open));
        worst_unshadowed = worst_unshadowed.max(distance(row, &open) / norm(&open));
    }
    // The mesh is inscribed (0.003), 16,384 rays and the quadrature are each good for about 0.002.
    assert!(worst <= 0.008, "worst relative error {worst}");
    assert!(
        worst_unshadowed > 0.2,
        "coefficients_match_quadrature_can_fail: without the shadow the error is {worst_unshadowed}"
    );
}

/// More rays are traced where shadows are intricate, and the estimate covers the true error.
#[test]
fn error_asked_for_is_the_error_reached() {
    let ask = |error| Settings { quality: Quality::Error(error), ..fixed(5, Sampler::OwenSobol, 1, 0) };
    let scene = grey("cornell-box", 0.5);
    let truth = quiet(&scene, &fixed(5, Sampler::Fibonacci, 8192, 0));
    let open: f64 = 0.43;
    for error in [0.04f32, 0.02] {
        let prt = quiet(&scene, &ask(error));
        let mut errors: Vec<f64> = prt
            .transfer
            .values
            .chunks_exact(25)
            .zip(truth.transfer.values.chunks_exact(25))
            .map(|(a, b)| distance(a, &b.iter().map(|&x| f64::from(x)).collect::<Vec<_>>()) / open)
            .collect();
        errors.sort_by(f64::total_cmp);
        let p95 = errors[errors.len() * 95 / 100];
        assert!(p95 <= 1.2 * f64::from(error), "asked for {error}, p95 is {p95}");
    }
}

fn quadrature(bands: Bands, visible: impl Fn(DVec3) -> bool) -> Vec<f64> {
    let samples = testkit::quadrature::sphere_quadrature(256).into_iter().filter_map(|(w, solid_angle)| {
        let w = DVec3::from_array(w);
        visible(w).then(|| (w, solid_angle * w.y / std::f64::consts::PI))
    });
    sh_math::project_scalar(bands, samples)
}

/// The sphere of `sphere-on-plane`: radius 0.5 m, resting on the origin.
fn meets_sphere(p: DVec3, w: DVec3) -> bool {
    let to = DVec3::new(0.0, 0.5, 0.0) - p;
    let along = to.dot(w);
    along > 0.0 && to.length_squared() - along * along < 0.25
}

fn distance(a: &[f32], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (f64::from(*a) - b).powi(2)).sum::<f64>().sqrt()
}

fn norm(a: &[f64]) -> f64 {
    a.iter().map(|x| x * x).sum::<f64>().sqrt()
}
