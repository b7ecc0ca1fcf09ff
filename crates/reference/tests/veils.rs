//! Surfaces that blend or transmit stop the share of light that they cover: closed forms.

mod ground;

use glam::{Affine2, Vec2, Vec3, Vec4};
use ground::ground;
use probe_io::{Environment, Lamp};
use reference::{Light, Receiver, Settings, World, radiance_at};
use scene::{AlphaMode, Material, Mesh, Scene, Texture, TextureSlot, Wrap, builtin, known};
use testkit::ttest;

/// One chance in a hundred that a right result is refused; seeds are fixed, so it never flickers.
const ALPHA: f64 = 0.01;
const POINTS: [(f32, f32); 4] = [(0.0, 0.0), (0.5, -0.3), (0.9, 0.9), (-0.2, 0.6)];

/// Two facing planes of which the upper one has another material.
fn under(change: impl Fn(&mut Material)) -> Scene {
    let mut scene = builtin("facing-planes").expect("a built-in scene");
    change(&mut scene.materials[1]);
    scene
}

/// What white receivers on the lower plane send under a white sky.
fn sent(scene: &Scene, points: &[(f32, f32)], max_bounces: Option<u32>) -> Vec<reference::Estimate> {
    let light = Light::new(&Environment::constant([1.0; 3]));
    let receivers: Vec<Receiver> = points.iter().map(|&(x, z)| ground(x, z, 1.0)).collect();
    let settings = Settings { samples: 20_000, seed: 11, max_bounces };
    radiance_at(&World::new(scene), &light, &receivers, &settings)
}

/// Tests direct light where the upper plane passes a share of each channel.
fn check(scene: &Scene, passes: [f64; 3]) -> Result<(), String> {
    for (estimate, &(x, z)) in sent(scene, &POINTS, Some(0)).iter().zip(&POINTS) {
        let open = known::facing_planes_share(f64::from(x), f64::from(z));
        for (c, share) in passes.into_iter().enumerate() {
            let (mean, error) = (f64::from(estimate.mean[c]), f64::from(estimate.std_error[c]));
            let expected = open + share * (1.0 - open);
            ttest::z_test(mean, error, expected, ALPHA, 3 * POINTS.len()).map_err(|e| format!("{x} {z}: {e}"))?;
        }
    }
    Ok(())
}

fn blended(alpha: f32) -> impl Fn(&mut Material) {
    move |m| (m.alpha, m.base_color) = (AlphaMode::Blend, Vec4::new(0.8, 0.3, 0.2, alpha))
}

fn glass(transmission: f32) -> impl Fn(&mut Material) {
    move |m| (m.transmission, m.base_color) = (transmission, Vec4::new(0.9, 0.5, 0.1, 1.0))
}

#[test]
fn a_pane_passes_what_it_does_not_cover() {
    for alpha in [0.0, 0.35, 1.0] {
        check(&under(blended(alpha)), [1.0 - f64::from(alpha); 3]).unwrap_or_else(|e| panic!("alpha {alpha}: {e}"));
    }
    check(&under(glass(1.0)), [0.9, 0.5, 0.1]).expect("clear glass");
    check(&under(glass(0.5)), [0.45, 0.25, 0.05]).expect("half clear glass");
    let both = |m: &mut Material| {
        glass(0.5)(m);
        (m.alpha, m.base_color.w) = (AlphaMode::Blend, 0.6);
    };
    check(&under(both), [0.9, 0.5, 0.1].map(|tint| 0.4 + 0.6 * 0.5 * tint)).expect("glass that blends");
}

#[test]
fn other_shares_can_fail() {
    assert!(check(&under(blended(0.35)), [1.0; 3]).is_err(), "no shadow");
    assert!(check(&under(blended(0.35)), [0.0; 3]).is_err(), "a whole shadow");
    assert!(check(&under(glass(1.0)), [0.5; 3]).is_err(), "grey glass");
}

/// A larger pane at twice the height covers the same directions of the point in the middle.
#[test]
fn stacked_panes_multiply() {
    let mut scene = under(blended(0.35));
    let mut above = scene.meshes[1].clone();
    above.positions.iter_mut().for_each(|position| *position *= 2.0);
    scene.meshes.push(above);
    let estimate = sent(&scene, &POINTS[..1], Some(0))[0];
    let open = known::facing_planes_share(0.0, 0.0);
    let test = |share: f64| {
        let expected = open + share * (1.0 - open);
        ttest::z_test(f64::from(estimate.mean[0]), f64::from(estimate.std_error[0]), expected, ALPHA, 1)
    };
    test(0.65 * 0.65).expect("the product");
    assert!(test(0.65).is_err() && test(0.3).is_err(), "one pane, or the sum, can fail");
}

/// Cells of 2 x 2 over the upper plane, each all of one texel of a texture of two: alpha 0.2 and 0.9.
fn checkered() -> Scene {
    let mut scene = under(blended(1.0));
    let mut mesh = Mesh { name: "checks".into(), material: 1, ..Mesh::default() };
    for (column, row) in (0..4).map(|k| (k % 2, k / 2)) {
        let at = |i: u32, j: u32| Vec3::new((column + i) as f32 - 1.0, 1.0, (row + j) as f32 - 1.0);
        let first = mesh.positions.len() as u32;
        mesh.positions.extend([at(0, 0), at(1, 0), at(1, 1), at(0, 1)]);
        mesh.normals.extend([Vec3::NEG_Y; 4]);
        mesh.uv0.extend([Vec2::new(if (column + row) % 2 == 0 { 0.25 } else { 0.75 }, 0.5); 4]);
        mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    scene.meshes[1] = mesh;
    scene.textures = vec![Texture {
        name: "alpha".into(),
        width: 2,
        height: 1,
        rgba: vec![[255, 255, 255, 51], [255, 255, 255, 230]],
        wrap: [Wrap::Clamp; 2],
    }];
    scene.materials[1].base_color_texture = Some(TextureSlot { texture: 0, uv_set: 0, transform: Affine2::IDENTITY });
    scene
}

/// Share of the sky that a ground point sees through the checks, as a sum over small squares of the plane one metre above.
fn checkered_share(x: f64, z: f64, alphas: [f64; 2]) -> f64 {
    const N: usize = 800;
    let step = 2.0 / N as f64;
    let mut hidden = 0.0;
    for i in 0..N {
        for j in 0..N {
            let (dx, dz) = (-1.0 + (i as f64 + 0.5) * step - x, -1.0 + (j as f64 + 0.5) * step - z);
            let square = dx * dx + dz * dz + 1.0;
            hidden += alphas[(i * 2 / N + j * 2 / N) % 2] * step * step / (std::f64::consts::PI * square * square);
        }
    }
    1.0 - hidden
}

#[test]
fn a_texture_covers_by_texel() {
    let test = |alphas: [f64; 2]| {
        let scene = checkered();
        let pairs = sent(&scene, &POINTS, Some(0)).into_iter().zip(POINTS);
        pairs.into_iter().try_for_each(|(estimate, (x, z))| {
            let expected = checkered_share(f64::from(x), f64::from(z), alphas);
            let (mean, error) = (f64::from(estimate.mean[0]), f64::from(estimate.std_error[0]));
            ttest::z_test(mean, error, expected, ALPHA, POINTS.len()).map(drop)
        })
    };
    test([0.2, 230.0 / 255.0]).expect("by texel");
    assert!(test([230.0 / 255.0, 0.2]).is_err(), "the other texels can fail");
}

/// White surfaces absorb nothing: under a white sky they vanish, however much they let through.
#[test]
fn white_veils_vanish() {
    let white = |albedo: f32| {
        let mut scene = under(|m| m.alpha = AlphaMode::Blend);
        scene.materials[0].base_color = Vec4::ONE;
        scene.materials[1].base_color = Vec4::new(albedo, albedo, albedo, 0.5);
        let test = |estimate: &reference::Estimate| {
            ttest::z_test(f64::from(estimate.mean[0]), f64::from(estimate.std_error[0]), 1.0, ALPHA, POINTS.len())
        };
        sent(&scene, &POINTS, None).iter().try_for_each(|estimate| test(estimate).map(drop))
    };
    white(1.0).expect("no light is lost");
    assert!(white(0.8).is_err(), "grey can fail");
}

/// A lamp right above, through glass: the tint of its share.
#[test]
fn a_lamp_shines_through_tinted() {
    let mut environment = Environment::constant([0.0; 3]);
    environment.lamps.push(Lamp { direction: Vec3::Y, half_angle: 0.0, irradiance: [2.0; 3] });
    let light = Light::new(&environment);
    let settings = Settings { samples: 4, seed: 1, max_bounces: Some(0) };
    let scene = under(glass(1.0));
    let estimate = radiance_at(&World::new(&scene), &light, &[ground(0.1, 0.2, 1.0)], &settings)[0];
    for (value, tint) in estimate.mean.into_iter().zip([0.9, 0.5, 0.1]) {
        testkit::assert_close!(f64::from(value), 2.0 * tint / std::f64::consts::PI, 1e-5, 0.0, "tint {tint}");
    }
}
