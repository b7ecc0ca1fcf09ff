//! Surfaces that blend or transmit stop the share of light that they cover: closed forms that know nothing of rays.

mod support;

use coeff_io::{Bounces, Effect, Effects, Prt, Quality, Sampler, Settings};
use glam::{Affine2, Vec2, Vec3, Vec4};
use scene::{AlphaMode, Material, Mesh, Scene, Texture, TextureSlot, Wrap, known};
use std::ops::ControlFlow;
use support::volume::{at_normal, bake_volume, boxed, lit, normals, white};
use support::{fixed, grey, quiet};

/// Two facing planes of which the upper one has another material.
fn under(change: impl Fn(&mut Material)) -> Scene {
    let mut scene = grey("facing-planes", 0.5);
    change(&mut scene.materials[1]);
    scene
}

fn blended(alpha: f32) -> impl Fn(&mut Material) {
    move |m| (m.alpha, m.base_color) = (AlphaMode::Blend, Vec4::new(0.0, 0.0, 0.0, alpha))
}

fn glass(transmission: f32) -> impl Fn(&mut Material) {
    move |m| (m.transmission, m.base_color) = (transmission, Vec4::new(0.9, 0.5, 0.1, 1.0))
}

/// Direct light alone.
fn direct(quality: Quality) -> Settings {
    Settings { quality, ..fixed(3, Sampler::OwenSobol, 1, 0) }
}

const MANY: Quality = Quality::Rays(4096);

/// Radiance of white receivers of the lower plane under a white sky, RGB.
fn lower(prt: &Prt) -> Vec<(Vec3, [f64; 3])> {
    let (mesh, t) = (&prt.meshes[0], &prt.transfer);
    let (row, channels) = ((t.bands * t.bands * t.channels) as usize, t.channels as usize);
    let light = (4.0 * std::f64::consts::PI).sqrt();
    let one = |v: usize| {
        let values = &t.values[v * row..][..channels];
        let rgb = std::array::from_fn(|c| light * f64::from(values[c.min(channels - 1)]));
        (Vec3::from_array(prt.geometry.positions[v]), rgb)
    };
    (mesh.first_vertex as usize..(mesh.first_vertex + mesh.vertices) as usize).map(one).collect()
}

/// Largest difference from what the lower plane sees where the upper one passes a share of each channel.
fn furthest(scene: &Scene, quality: Quality, passes: [f64; 3]) -> f64 {
    lower(&quiet(scene, &direct(quality))).into_iter().map(|row| off(row, passes)).fold(0.0, f64::max)
}

/// The same of one receiver.
fn off((p, rgb): (Vec3, [f64; 3]), passes: [f64; 3]) -> f64 {
    let open = known::facing_planes_share(f64::from(p.x), f64::from(p.z));
    (0..3).map(|c| (rgb[c] - open - passes[c] * (1.0 - open)).abs()).fold(0.0, f64::max)
}

/// Bound of 4,096 rays: that of `half_blocked_plane_sees_the_share_beside_the_wall`.
const BOUND: f64 = 3e-3;

#[test]
fn a_pane_passes_what_it_does_not_cover() {
    for alpha in [0.35, 0.8, 1.0] {
        let off = furthest(&under(blended(alpha)), MANY, [1.0 - f64::from(alpha); 3]);
        assert!(off <= BOUND, "alpha {alpha}: {off} off");
    }
    let both = |m: &mut Material| {
        glass(0.5)(m);
        (m.alpha, m.base_color.w) = (AlphaMode::Blend, 0.6);
    };
    let off = furthest(&under(both), MANY, [0.9, 0.5, 0.1].map(|tint| 0.4 + 0.6 * 0.5 * tint));
    assert!(off <= BOUND, "glass that blends: {off} off");
}

/// The transfer of direct light has three channels where glass tints it, whatever bounces.
#[test]
fn glass_tints_what_it_passes() {
    for transmission in [1.0, 0.5] {
        let tints = [0.9, 0.5, 0.1].map(|tint| tint * f64::from(transmission));
        let off = furthest(&under(glass(transmission)), MANY, tints);
        assert!(off <= BOUND, "transmission {transmission}: {off} off");
    }
    let grey = |m: &mut Material| (m.transmission, m.base_color) = (1.0, Vec4::new(0.5, 0.5, 0.5, 1.0));
    assert!(furthest(&under(grey), MANY, [0.5; 3]) <= BOUND, "grey glass");
    assert_eq!(quiet(&under(grey), &direct(MANY)).transfer.channels, 1, "grey glass needs one channel");
}

/// The number of rays follows the error asked for, foreseen directions and all.
#[test]
fn the_error_asked_for_is_reached() {
    for (scene, passes) in [(under(blended(0.35)), [0.65; 3]), (under(glass(1.0)), [0.9, 0.5, 0.1].map(f64::from))] {
        for error in [0.02f32, 0.005] {
            let prt = quiet(&scene, &direct(Quality::Error(error)));
            let mut errors: Vec<f64> = lower(&prt).into_iter().map(|row| off(row, passes)).collect();
            errors.sort_by(f64::total_cmp);
            // Of the norm of an open receiver's three bands, whose first coefficient is all of a white sky.
            let (p95, open) = (errors[errors.len() * 95 / 100], (1.0f64 + 4.0 / 3.0 + 5.0 / 16.0).sqrt());
            assert!(p95 <= 1.2 * f64::from(error) * open, "asked for {error}, p95 is {p95}");
            assert!(f64::from(prt.achieved.error[1]) <= f64::from(error), "and the estimate says so");
        }
    }
}

#[test]
fn other_shares_can_fail() {
    assert!(furthest(&under(blended(0.35)), MANY, [1.0; 3]) > 0.1, "no shadow");
    assert!(furthest(&under(blended(0.35)), MANY, [0.0; 3]) > 0.1, "a whole shadow");
    assert!(furthest(&under(glass(1.0)), MANY, [0.5; 3]) > 0.1, "grey glass");
    let without = Settings { effects: Effects::Only(vec![Effect::Visibility]), ..direct(MANY) };
    let prt = quiet(&under(blended(0.35)), &without);
    assert!(lower(&prt).iter().any(|(_, rgb)| rgb[0] < 0.5), "without transmission a pane stops all");
}

/// A larger pane at twice the height covers the same directions of the point in the middle.
#[test]
fn stacked_panes_multiply() {
    let mut scene = under(blended(0.35));
    let mut above = scene.meshes[1].clone();
    above.positions.iter_mut().for_each(|position| *position *= 2.0);
    scene.meshes.push(above);
    let prt = quiet(&scene, &direct(MANY));
    let (_, [value, ..]) =
        lower(&prt).into_iter().min_by(|a, b| a.0.length().total_cmp(&b.0.length())).expect("receivers");
    let open = known::facing_planes_share(0.0, 0.0);
    let off = |share: f64| (value - open - share * (1.0 - open)).abs();
    assert!(off(0.65 * 0.65) < BOUND, "{} off", off(0.65 * 0.65));
    assert!(off(0.65) > 0.1 && off(0.3) > 0.05, "one pane, or the sum, can fail");
}

/// Quarters of the upper plane, each all of one texel of a texture of two: alpha 0.2 and 0.9.
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
    let (rgba, wrap) = (vec![[255, 255, 255, 51], [255, 255, 255, 230]], [Wrap::Clamp; 2]);
    scene.textures = vec![Texture { name: "alpha".into(), width: 2, height: 1, rgba, wrap }];
    scene.materials[1].base_color_texture = Some(TextureSlot { texture: 0, uv_set: 0, transform: Affine2::IDENTITY });
    scene
}

/// Share of the sky that a ground point sees through the checks, as a sum over small squares of the plane one metre above.
fn checkered_share(p: Vec3, alphas: [f64; 2]) -> f64 {
    const N: usize = 200;
    let step = 2.0 / N as f64;
    let mut hidden = 0.0;
    for (i, j) in (0..N * N).map(|k| (k / N, k % N)) {
        let at = |k: usize, from: f32| -1.0 + (k as f64 + 0.5) * step - f64::from(from);
        let square = at(i, p.x).powi(2) + at(j, p.z).powi(2) + 1.0;
        hidden += alphas[(i * 2 / N + j * 2 / N) % 2] * step * step / (std::f64::consts::PI * square * square);
    }
    1.0 - hidden
}

#[test]
fn a_texture_covers_by_texel() {
    // Edges between the checks ask for more rays than the border of a pane.
    let rows = lower(&quiet(&checkered(), &direct(Quality::Rays(16_384))));
    let off = |alphas: [f64; 2]| {
        let one = |(p, rgb): &(Vec3, [f64; 3])| (rgb[0] - checkered_share(*p, alphas)).abs();
        rows.iter().map(one).fold(0.0, f64::max)
    };
    let (right, wrong) = (off([0.2, 230.0 / 255.0]), off([230.0 / 255.0, 0.2]));
    assert!(right <= BOUND, "{right} off");
    assert!(wrong > 0.05, "the other texels can fail: {wrong}");
}

/// White surfaces absorb nothing: under a white sky they vanish, however much they let through.
#[test]
fn white_veils_vanish() {
    let worst = |albedo: f32| {
        let mut scene = grey("facing-planes", 1.0);
        scene.materials[1].alpha = AlphaMode::Blend;
        scene.materials[1].base_color = Vec4::new(albedo, albedo, albedo, 0.5);
        let settings = Settings { bounces: Bounces::Fixed(40), ..fixed(3, Sampler::OwenSobol, 256, 0) };
        lower(&quiet(&scene, &settings)).into_iter().map(|(_, rgb)| (rgb[0] - 1.0).abs()).fold(0.0, f64::max)
    };
    let (white, grey) = (worst(1.0), worst(0.8));
    assert!(white < 2e-3, "{white} is lost or gained");
    assert!(grey > 0.02, "grey can fail: {grey}");
}

/// What a pane sends onto what lies behind it is in its own share of the view, and what lies behind the pane is tinted by it.
#[test]
fn one_bounce_through_glass_is_tinted() {
    // Black glass without diffuse light before a white plane: of the light that the plane sends it passes 0.9, 0.5, 0.1, twice as the
    // lower plane looks up through it and the upper one is lit through nothing from above.
    let mut scene = grey("facing-planes", 1.0);
    let mut pane = scene.meshes[1].clone();
    pane.positions.iter_mut().for_each(|p| *p *= 0.5);
    pane.material = 2;
    scene.meshes.push(pane);
    scene.materials.push(Material {
        transmission: 1.0,
        base_color: Vec4::new(0.9, 0.5, 0.1, 1.0),
        ..Material::default()
    });
    let with = quiet(&scene, &fixed(3, Sampler::OwenSobol, 1024, 1));
    scene.meshes.pop();
    let without = [0, 1].map(|bounces| lower(&quiet(&scene, &fixed(3, Sampler::OwenSobol, 1024, bounces))));
    let middle = |rows: &[(Vec3, [f64; 3])]| {
        rows.iter().min_by(|a, b| a.0.length().total_cmp(&b.0.length())).expect("receivers").1
    };
    // In the middle the pane covers just what the upper plane covers: direct light is that beside both.
    let [open, clear] = without.each_ref().map(|rows| middle(rows)[0]);
    for (value, tint) in middle(&lower(&with)).into_iter().zip([0.9, 0.5, 0.1]) {
        let passed = (value - open) / (clear - open);
        // The upper plane is lit from below, in part through the pane as well.
        assert!(passed < tint && passed > 0.6 * tint, "{passed} of the bounce arrives, {tint} are passed");
    }
}

/// A probe between the planes: half of its sphere is ground, half is the pane and what is beside it.
#[test]
fn probes_see_through_panes() {
    let mut scene = under(blended(0.4));
    scene.meshes.remove(0);
    scene.meshes[0].positions.iter_mut().for_each(|p| *p *= Vec3::new(1000.0, 1.0, 1000.0));
    let around = boxed(Vec3::splat(-0.5), Vec3::splat(0.5), [2; 3]);
    let volume = bake_volume(&scene, &fixed(3, Sampler::OwenSobol, 2048, 0), &around);
    // Above the horizon 0.6 of the sky, below it all of it: no bands above 1.
    let expected = |n: Vec3, share: f64| 0.5 * (1.0 - f64::from(n.y)) + 0.5 * share * (1.0 + f64::from(n.y));
    let off = |share: f64| {
        let probe = |p: usize| {
            let coefficients = lit(&volume, p, &white(3));
            normals().map(|n| (at_normal(&coefficients, n)[0] - expected(n, share)).abs()).fold(0.0, f64::max)
        };
        (0..8).map(probe).fold(0.0, f64::max)
    };
    assert!(off(0.6) < 5e-3, "{} off", off(0.6));
    assert!(off(1.0) > 0.2, "without the pane's shadow it fails");
}

#[test]
fn threads_do_not_matter() {
    let settings = Settings { bounces: Bounces::Fixed(2), ..direct(Quality::Error(0.01)) };
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| bake::bake(&checkered(), &settings, &|_| ControlFlow::Continue(())).expect("it bakes").transfer)
    };
    assert_eq!(on(1), on(3), "the same to the bit");
}
