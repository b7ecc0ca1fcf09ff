//! Surfaces that shine against the formulas of glTF 2.0: direction by direction under a sun, and by quadrature under a white sky.

use glam::{Vec3, Vec4};
use probe_io::{Environment, Lamp};
use reference::{Gaze, Gloss, Light, Lobe, Mirroring, Settings, World, radiance_seen};
use scene::{Scene, builtin};
use testkit::gltf::Surface;

const ROUGHNESSES: [f32; 5] = [0.0, 0.2, 0.4, 0.7, 1.0];
const METALLICS: [f32; 3] = [0.0, 0.5, 1.0];

/// The ground, of one material; its factors shine, the roughness is given with [`Gloss`].
fn floor(base: f32, metallic: f32) -> Scene {
    let mut scene = builtin("plane").expect("a built-in scene");
    for material in &mut scene.materials {
        material.base_color = Vec4::new(base, base, base, 1.0);
        (material.base_color_texture, material.metallic_roughness_texture) = (None, None);
        (material.metallic, material.roughness) = (metallic, 0.5);
    }
    scene.meshes.iter_mut().for_each(|mesh| mesh.colors.clear());
    scene
}

/// Mean and standard error of what the floor shows under an angle of that cosine.
fn seen(scene: &Scene, gloss: Gloss, light: &Light, cosine: f32, samples: u32) -> [f64; 2] {
    let view = Vec3::new((1.0 - cosine * cosine).sqrt(), cosine, 0.0);
    let settings = Settings { samples, seed: 21, max_bounces: None };
    let gaze = Gaze { eye: view * 2.0, direction: -view };
    let estimate = radiance_seen(&World::new(scene).with_gloss(gloss), light, &[gaze], &settings)[0];
    [estimate.mean[0], estimate.std_error[0]].map(f64::from)
}

fn rough(mirroring: Mirroring, roughness: f32) -> Gloss {
    Gloss { roughness: Some(roughness), ..Gloss::new(mirroring) }
}

fn surface(base: f32, metallic: f32, roughness: f32) -> Surface {
    Surface { base: f64::from(base), metallic: f64::from(metallic), roughness: f64::from(roughness) }
}

/// Each pair of directions by itself: a sun without width shows the BRDF. Widths of lobes are of `f32`: 1e-3 of each value.
#[test]
fn a_sun_shows_the_brdf() {
    let mut told = 0;
    for metallic in METALLICS {
        let scene = floor(0.6, metallic);
        for roughness in [0.2f32, 0.4, 0.7, 1.0] {
            for (cosine, light) in [(0.9f32, [0.3f32, 0.9, 0.2]), (0.4, [-0.8, 0.5, 0.1]), (0.7, [-0.7, 0.6, -0.3])] {
                let direction = Vec3::from(light).normalize();
                let mut sun = Environment::constant([0.0; 3]);
                sun.lamps.push(Lamp { direction, half_angle: 0.0, irradiance: [2.0; 3] });
                let [found, _] = seen(&scene, rough(Mirroring::Microfacet, roughness), &Light::new(&sun), cosine, 2);
                let view = [f64::from(1.0 - cosine * cosine).sqrt(), 0.0, f64::from(cosine)];
                let [x, y, z] = direction.as_dvec3().to_array();
                let formula = |surface: Surface| 2.0 * y * surface.brdf(view, [x, z, y]);
                let value = formula(surface(0.6, metallic, roughness));
                assert!((found - value).abs() < 1e-3 * value, "{metallic} {roughness} {cosine}: {found} {value}");
                // What stood here before kept all of the diffuse part: 4 % more of a dielectric.
                let kept = value + 2.0 * y * f64::from((1.0 - metallic) * 0.04 * 0.6) / std::f64::consts::PI;
                told += usize::from((found - kept).abs() > 1e-3 * value);
            }
        }
    }
    assert!(told >= 12, "can fail: a diffuse part that gives up nothing shows in {told} of 24");
}

/// All models under a white sky: the microfacets are the formula, a lobe has its integral from a table, to 4e-3.
#[test]
fn a_white_sky_shows_the_integral() {
    let light = Light::new(&Environment::constant([1.0; 3]));
    let models = [Mirroring::Microfacet, Mirroring::Lobe(Lobe::Ggx), Mirroring::Lobe(Lobe::Phong)];
    for (base, metallic) in [(1.0, 0.0), (1.0, 0.5), (1.0, 1.0), (0.3, 0.0)] {
        let scene = floor(base, metallic);
        for roughness in ROUGHNESSES {
            for cosine in [0.3f32, 0.8] {
                let value = surface(base, metallic, roughness).of_white_sky(f64::from(cosine));
                for model in models {
                    let [found, error] = seen(&scene, rough(model, roughness), &light, cosine, 8000);
                    let apart = |value: f64| (found - value).abs() - 4.0 * error;
                    assert!(apart(value) < 4e-3, "{model:?} {base} {metallic} {roughness} {cosine}: {found} {value}");
                    let tells = error < 4e-3;
                    assert!(!tells || apart(value + 0.03) > 4e-3, "can fail: 3 % of the sky more");
                }
            }
        }
    }
}
