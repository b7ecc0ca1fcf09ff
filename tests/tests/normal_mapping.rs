//! Light maps in every basis against paths through bent normals: whose error is larger than whose.
//!
//! The bumps of `builtin:bumps` under a low sun. The reference turns its normals by the normal map and knows no basis; the example of the
//! same name prints the figures of all bases.

mod mapped;
#[expect(unused_imports, reason = "only its light is used")]
mod support;

use coeff_io::{Bounces, Prt, Quality};
use glam::Vec3;
use mapped::{Figures, Shot, Truth, baked, drawn, windowed};
use scene::Scene;
use sh_math::Rgb;
use sh_math::hemisphere::Basis;
use std::sync::OnceLock;

/// In the order of their errors, and the least ratio of each to the one before. Found were 0.0 (below what the noise tells), 5.31, 5.86,
/// 9.44 and 40.7 %, ratios of 1.10, 1.61 and 4.3. The reference's noise is 4.24 %; it is the same for all, and in 3,890 pixels it moves
/// their ratios by less than 0.01.
const ORDER: [(Basis, f64); 5] = [
    (Basis::Sh9, 0.0),
    (Basis::ModifiedH6, 2.0),
    (Basis::ModifiedH4, 1.05),
    (Basis::Hl2, 1.4),
    (Basis::ModifiedH1, 3.0),
];
/// Largest error of nine harmonics: less than half of that of modified H 6 and of the noise, of which the square is taken off.
const NINE: f64 = 0.02;

struct Bumps {
    scene: Scene,
    light: Rgb,
    shot: Shot,
    prt: Prt,
    truth: Truth,
}

/// Direct light: what bounces is the same in all bases and would only add noise.
fn bake(scene: &Scene, light: &Rgb) -> Prt {
    baked(scene, light, 128, Quality::Rays(1024), Bounces::Fixed(0))
}

fn bumps() -> &'static Bumps {
    static BUMPS: OnceLock<Bumps> = OnceLock::new();
    BUMPS.get_or_init(|| {
        let scene = scene::builtin("bumps").expect("a built-in scene");
        let light = windowed(&probe_io::builtin("sky:12,60").expect("a built-in probe"), 3);
        let prt = bake(&scene, &light);
        let shot = Shot { camera: prt.cameras[0].clone(), size: [96, 72], samples: 128, max_bounces: Some(0) };
        let truth = Truth::trace(&scene, &light, &shot);
        Bumps { scene, light, shot, prt, truth }
    })
}

/// The errors of the bases of [`ORDER`].
fn errors(bumps: &Bumps, prt: &Prt) -> [Figures; 5] {
    ORDER.map(|(basis, _)| bumps.truth.judge(&drawn(prt, &bumps.light, &bumps.shot, basis)))
}

fn in_order(errors: &[Figures]) -> bool {
    let mut steps = errors.windows(2).zip(&ORDER[1..]);
    errors[0].rms < NINE && steps.all(|(pair, (_, gap))| pair[1].rms > gap * pair[0].rms)
}

#[test]
fn the_larger_the_span_the_smaller_the_error() {
    let bumps = bumps();
    let errors = errors(bumps, &bumps.prt);
    assert!(errors[0].noise < 0.05, "the reference is too noisy: {errors:?}");
    assert!(in_order(&errors), "{errors:?}");
    // Four functions of least squares take the mean light whole; HL2, without a constant, and a map of one function do not.
    let bias = errors.map(|figures| figures.bias);
    assert!(bias[..3].iter().all(|bias| bias.abs() < 2e-3) && bias[3] > 0.01 && bias[4] > 0.1, "{bias:?}");
}

/// The two span 1, x, y, z: one best fit.
#[test]
fn two_bases_of_one_span_show_one_picture() {
    let bumps = bumps();
    let [ours, theirs, other] = [Basis::ModifiedH4, Basis::H4, Basis::Hsh4]
        .map(|basis| drawn(&bumps.prt, &bumps.light, &bumps.shot, basis).pixels);
    let worst = |a: &[[f32; 3]], b: &[[f32; 3]]| {
        a.iter().zip(b).map(|(a, b)| (Vec3::from(*a) - Vec3::from(*b)).abs().max_element()).fold(0.0, f32::max)
    };
    assert!(worst(&ours, &theirs) < 1e-4, "{}", worst(&ours, &theirs));
    assert!(worst(&ours, &other) > 1e-2, "can fail: {}", worst(&ours, &other));
}

/// Drawn with the green of the normal map the other way up, or baked in frames that are turned by a quarter.
#[test]
fn the_order_can_fail() {
    let bumps = bumps();
    let mut flipped = bumps.prt.clone();
    for texture in &mut flipped.textures {
        texture.rgba.iter_mut().for_each(|texel| texel[1] = 255 - texel[1]);
    }
    let mut scene = bumps.scene.clone();
    for mesh in &mut scene.meshes {
        for (tangent, normal) in mesh.tangents.iter_mut().zip(&mesh.normals) {
            *tangent = (normal.cross(tangent.truncate()) * tangent.w).extend(tangent.w);
        }
    }
    for (what, wrong) in [("flipped", flipped), ("turned", bake(&scene, &bumps.light))] {
        let errors = errors(bumps, &wrong);
        // Where the normal does not lie, more functions only err with more force: 0.41 and 0.51 for nine, 0.38 and 0.47 for four.
        assert!(!in_order(&errors) && errors[0].rms > errors[2].rms, "{what}: {errors:?}");
    }
}
