//! Bilinear look-up against values by hand, and albedo and coverage made of it.

use glam::{Affine2, Vec2, Vec3, Vec4};
use scene::{AlphaMode, Material, Mesh, Scene, Texture, TextureSlot, Wrap};
use testkit::assert_close;

const WRAPS: [Wrap; 3] = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp];

/// 4 x 2 texels; red is the texel's number times 10.
fn ramp(wrap: Wrap) -> Texture {
    let rgba = (0..8u8).map(|i| [10 * i, 0, 0, 255]).collect();
    Texture { name: "ramp".into(), width: 4, height: 2, rgba, wrap: [wrap; 2] }
}

fn red(texture: &Texture, u: f32, v: f32) -> f64 {
    f64::from(texture.sample(Vec2::new(u, v), false).x) * 255.0
}

#[test]
fn texel_centres_give_the_texels() {
    for wrap in WRAPS {
        let texture = ramp(wrap);
        for (i, j) in [(0, 0), (3, 0), (1, 1), (3, 1)] {
            let (u, v) = ((i as f32 + 0.5) / 4.0, (j as f32 + 0.5) / 2.0);
            assert_close!(red(&texture, u, v), 10.0 * f64::from(4 * j + i), 1e-4, 0.0, "{wrap:?} {i} {j}");
        }
    }
}

#[test]
fn between_centres_it_is_bilinear() {
    // (u, v) = (0.4, 0.6): column 1.1, row 0.7 -> rows 10 + 1 and 50 + 1, 11 * 0.3 + 51 * 0.7 = 39.
    for wrap in WRAPS {
        assert_close!(red(&ramp(wrap), 0.4, 0.6), 39.0, 1e-3, 0.0, "{wrap:?}");
    }
}

#[test]
fn wrapping_follows_the_mode() {
    // Table by hand in row 0: texels 0 10 20 30; u = 0 lies midway between texel 0 and the one before it.
    let cases = [
        (Wrap::Repeat, 0.0, 15.0),
        (Wrap::Mirror, 0.0, 0.0),
        (Wrap::Clamp, 0.0, 0.0),
        (Wrap::Repeat, 1.125, 0.0),
        (Wrap::Mirror, 1.125, 30.0),
        (Wrap::Clamp, 1.125, 30.0),
        (Wrap::Repeat, -0.375, 20.0),
        (Wrap::Mirror, -0.375, 10.0),
        (Wrap::Clamp, -0.375, 0.0),
        (Wrap::Repeat, 7.375, 10.0),
        (Wrap::Mirror, 7.375, 20.0),
        (Wrap::Mirror, 6.375, 10.0),
    ];
    for (wrap, u, expected) in cases {
        assert_close!(red(&ramp(wrap), u, 0.25), expected, 1e-3, 0.0, "{wrap:?} at {u}");
    }
}

#[test]
fn wrapping_can_fail() {
    assert!(!testkit::close(red(&ramp(Wrap::Clamp), 1.125, 0.25), red(&ramp(Wrap::Repeat), 1.125, 0.25), 1e-3, 0.0));
}

#[test]
fn strange_coordinates_stay_inside() {
    for wrap in WRAPS {
        for u in [f32::NAN, f32::INFINITY, f32::MAX, -f32::MAX, 1e9, -1e-30] {
            assert!(ramp(wrap).sample(Vec2::new(u, u), true).is_finite(), "{wrap:?} {u}");
        }
    }
}

#[test]
fn colours_are_decoded_before_they_are_filtered() {
    let rgba = vec![[0, 0, 0, 0], [255, 255, 255, 255]];
    let texture = Texture { name: "edge".into(), width: 2, height: 1, rgba, wrap: [Wrap::Clamp; 2] };
    let middle = texture.sample(Vec2::new(0.5, 0.5), true);
    assert_close!(middle.x, 0.5, 1e-6, 0.0, "linear mean of black and white");
    assert_close!(middle.w, 0.5, 1e-6, 0.0, "coverage is not encoded");
    // IEC 61966-2-1 at 188: ((188/255 + 0.055)/1.055)^2.4.
    assert_close!(scene::linear_from_srgb(188), 0.502_886, 1e-6, 0.0);
    assert_close!(scene::linear_from_srgb(5), 5.0 / 255.0 / 12.92, 1e-9, 0.0);
}

/// One triangle with uv = barycentrics, under `material` and a 2 x 1 picture: opaque red, then clear green.
fn one_triangle(material: Material) -> Scene {
    let mesh = Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        normals: vec![Vec3::Z; 3],
        uv0: vec![Vec2::ZERO, Vec2::X, Vec2::Y],
        colors: vec![Vec4::new(0.5, 1.0, 1.0, 1.0); 3],
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    };
    let rgba = vec![[255, 0, 0, 255], [0, 255, 0, 0]];
    let texture = Texture { name: "two".into(), width: 2, height: 1, rgba, wrap: [Wrap::Clamp; 2] };
    Scene { meshes: vec![mesh], materials: vec![material], textures: vec![texture], ..Scene::default() }
}

fn slot() -> Option<TextureSlot> {
    Some(TextureSlot { texture: 0, uv_set: 0, transform: Affine2::IDENTITY })
}

#[test]
fn albedo_is_factor_times_texture_times_vertex_colour_less_metal() {
    let material = Material {
        base_color: Vec4::new(0.8, 0.6, 0.4, 1.0),
        base_color_texture: slot(),
        metallic: 0.25,
        ..Material::default()
    };
    let scene = one_triangle(material);
    let left = scene.albedo(0, 0, 0.1, 0.1);
    assert!((left - Vec3::new(0.8 * 0.5 * 0.75, 0.0, 0.0)).abs().max_element() < 1e-6, "{left}");
    let right = scene.albedo(0, 0, 0.9, 0.05);
    assert!((right - Vec3::new(0.0, 0.6 * 0.75, 0.0)).abs().max_element() < 1e-6, "{right}");
}

#[test]
fn coverage_follows_the_alpha_mode() {
    let covered = |alpha| {
        let scene = one_triangle(Material { base_color_texture: slot(), alpha, ..Material::default() });
        [scene.coverage(0, 0, 0.1, 0.1), scene.coverage(0, 0, 0.5, 0.1), scene.coverage(0, 0, 0.9, 0.05)]
    };
    assert_eq!(covered(AlphaMode::Opaque), [1.0, 1.0, 1.0]);
    assert_eq!(covered(AlphaMode::Mask(0.4)), [1.0, 1.0, 0.0]);
    assert_eq!(covered(AlphaMode::Mask(0.6)), [1.0, 0.0, 0.0]);
    assert_eq!(covered(AlphaMode::Blend), [1.0, 0.5, 0.0]);
}
