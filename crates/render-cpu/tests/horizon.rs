//! Light from below a surface is not mirrored by it: prefiltered reflections against the whole lobe above the surface, by quadrature.

mod handmade;

use coeff_io::Prt;
use glam::{DVec3, Vec3};
use handmade::gloss::{STORAGES, belt, metal, same_everywhere};
use handmade::{camera, wall};
use probe_io::Environment;
use probe_io::reflection::Reflection;
use render_cpu::{Frame, REFLECTION_LEVELS, REFLECTION_WIDTH, Renderer, environment_brdf};
use testkit::quadrature::sphere_quadrature;

/// Above the wall, which faces +z, and below it: the same, dark below, dark above but for a fifth.
fn halves() -> Environment {
    Environment::from_function("halves", 128, |d| if d.z > 0.0 { [1.0, 1.0, 0.2] } else { [1.0, 0.0, 1.0] })
}

/// Cosines of normal and view.
const COSINES: [f32; 5] = [0.08, 0.2, 0.4, 0.6, 0.9];
const ROUGHNESSES: [f32; 4] = [0.2, 0.35, 0.5, 0.6];
/// How far the light of the whole lobe above the wall is missed, of light up to 1. Below the wall the light is read in one place.
const BOUND: f32 = 0.09;

/// The middle of the wall from under an angle.
fn view(cosine: f32) -> Frame {
    let eye = Vec3::new(0.0, -(1.0 - cosine * cosine).sqrt(), cosine);
    let mut frame = Frame::plain(camera(eye.to_array(), [0.0; 3]), 1, 1);
    frame.camera.vertical_fov = 0.01;
    frame
}

/// Radiance about the mirror direction: GGX's lobe from its definition, cut off at the wall where that is asked for.
fn lobe(roughness: f32, cosine: f32, cut: bool) -> [f32; 3] {
    let cosine = f64::from(cosine);
    let axis = DVec3::new(0.0, (1.0 - cosine * cosine).sqrt(), cosine);
    let square = f64::from(roughness).powi(4);
    let (mut one, mut sum) = (0.0, [0.0; 3]);
    for (direction, weight) in sphere_quadrature(150) {
        let direction = DVec3::from(direction);
        let near = axis.dot(direction);
        if near <= 0.0 || cut && direction.z <= 0.0 {
            continue;
        }
        let half = 0.5 * (1.0 + near);
        let weight = weight * near / (half * (square - 1.0) + 1.0).powi(2);
        let light = if direction.z > 0.0 { [1.0, 1.0, 0.2] } else { [1.0, 0.0, 1.0] };
        one += weight;
        sum.iter_mut().zip(light).for_each(|(sum, x)| *sum += weight * x);
    }
    sum.map(|sum| (sum / one) as f32)
}

/// What a wall of metal mirrors over its share of a white sky, in the middle.
fn mirrored(prt: &Prt, environment: &Environment, roughness: f32, cosine: f32) -> [f32; 3] {
    let renderer = Renderer::without_window(prt, environment).expect("a sound scene");
    let seen = renderer.draw(&view(cosine)).expect("a picture").linear[0];
    let [scale, bias] = environment_brdf(roughness, cosine);
    std::array::from_fn(|c| seen[c] / (handmade::gloss::METAL[c] * scale + bias))
}

fn apart(a: [f32; 3], b: [f32; 3]) -> f32 {
    (0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0, f32::max)
}

#[test]
fn light_from_below_a_surface_is_not_mirrored() {
    let environment = halves();
    for roughness in ROUGHNESSES {
        let plain = wall(metal(roughness));
        let open = STORAGES.map(|storage| same_everywhere(plain.clone(), storage, &belt(0.0, 1.0), None));
        for cosine in COSINES {
            let exact = lobe(roughness, cosine, true);
            for prt in [&plain, &open[0], &open[1]] {
                let error = apart(mirrored(prt, &environment, roughness, cosine), exact);
                assert!(error < BOUND, "roughness {roughness}, cosine {cosine}: {error}");
            }
        }
    }
}

/// The probe as it is prefiltered has the light of both sides.
#[test]
fn light_from_below_a_surface_can_fail() {
    let reflection = Reflection::build(&halves(), REFLECTION_LEVELS, REFLECTION_WIDTH);
    for (roughness, cosine) in [(0.35f32, 0.08f32), (0.5, 0.2), (0.6, 0.2)] {
        let axis = Vec3::new(0.0, (1.0 - cosine * cosine).sqrt(), cosine);
        let whole = reflection.sample(axis, roughness);
        assert!(apart(whole, lobe(roughness, cosine, false)) < 0.02, "it is prefiltered as the lobe says");
        assert!(apart(whole, lobe(roughness, cosine, true)) > 2.0 * BOUND, "{roughness} {cosine}");
    }
}
