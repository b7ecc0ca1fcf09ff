//! Materials: textures, masks, blending, backs, emission, reflections.

mod handmade;

use coeff_io::{AlphaMode, Material, Prt, Texture, TextureSlot, Wrap};
use glam::Vec3;
use handmade::{add_triangles, camera, distance, quad, wall, white};
use probe_io::Environment;
use render_cpu::{Frame, environment_brdf, render, srgb_decode};
use testkit::quadrature::gauss_legendre;

/// Columns and rows of the test pictures.
const SIZE: u32 = 32;

/// The wall of four by four units fills this view exactly.
fn frame() -> Frame {
    let mut frame = Frame::plain(camera([0.0, 0.0, 2.0], [0.0; 3]), SIZE, SIZE);
    frame.camera.vertical_fov = std::f32::consts::FRAC_PI_2;
    frame.sky = false;
    frame
}

fn draw(prt: &Prt) -> Vec<[f32; 3]> {
    render(prt, &Environment::constant([1.0; 3]), &frame()).expect("a sound scene and frame").linear
}

fn centre(prt: &Prt) -> [f32; 3] {
    draw(prt)[(SIZE / 2 * SIZE + SIZE / 2) as usize]
}

fn slot() -> TextureSlot {
    TextureSlot { texture: 0, uv_set: 0, transform: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] }
}

/// A wall with one picture; u runs from 0 on the left to 1 on the right, v from 0 at the top to 1 at the bottom.
fn textured(material: Material, width: u32, rgba: Vec<[u8; 4]>, wrap: Wrap) -> Prt {
    let mut prt = wall(material);
    let height = rgba.len() as u32 / width;
    prt.textures.push(Texture { name: "test".into(), width, height, rgba, wrap: [wrap; 2] });
    prt.geometry.uv0 = prt.geometry.positions.iter().map(|p| [p[0] / 4.0 + 0.5, 0.5 - p[1] / 4.0]).collect();
    prt
}

/// The wall's centre is at depth 2, and a pixel's centre at these texture coordinates.
fn uv(pixel: usize) -> [f64; 2] {
    [(pixel % SIZE as usize) as f64 + 0.5, (pixel / SIZE as usize) as f64 + 0.5].map(|x| x / f64::from(SIZE))
}

const PICTURE: [[u8; 4]; 6] =
    [[10, 200, 30, 255], [250, 0, 128, 40], [90, 90, 255, 128], [0, 0, 0, 255], [255, 255, 255, 0], [70, 10, 190, 77]];

/// A texel of `PICTURE` (3 x 2), linear, by a plain rule for each wrap.
fn texel(i: i64, j: i64, wrap: Wrap) -> [f64; 3] {
    let index = |mut i: i64, n: i64| {
        if wrap == Wrap::Clamp {
            return i.clamp(0, n - 1);
        }
        let mut flips = 0;
        while i < 0 {
            (i, flips) = (i + n, flips + 1);
        }
        while i >= n {
            (i, flips) = (i - n, flips + 1);
        }
        if wrap == Wrap::Mirror && flips % 2 == 1 { n - 1 - i } else { i }
    };
    let [r, g, b, _] = PICTURE[(index(j, 2) * 3 + index(i, 3)) as usize];
    [r, g, b].map(|x| srgb_decode(f64::from(x) / 255.0))
}

fn bilinear([u, v]: [f64; 2], wrap: Wrap) -> [f32; 3] {
    let (x, y) = (u * 3.0 - 0.5, v * 2.0 - 0.5);
    let mut sum = [0.0; 3];
    for (i, j) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        let (column, row) = (x.floor() + f64::from(i), y.floor() + f64::from(j));
        let weight = (1.0 - (x - column).abs()) * (1.0 - (y - row).abs());
        let color = texel(column as i64, row as i64, wrap);
        sum = std::array::from_fn(|c| sum[c] + weight * color[c]);
    }
    sum.map(|x| x as f32)
}

#[test]
fn textures_are_decoded_then_filtered_and_wrapped() {
    for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
        let mut material = white();
        let transform = [[2.5, 0.25, -0.7], [-0.5, 3.0, 0.1]];
        material.base_color_texture = Some(TextureSlot { transform, ..slot() });
        let image = draw(&textured(material, 3, PICTURE.to_vec(), wrap));
        for (i, &pixel) in image.iter().enumerate() {
            let [u, v] = uv(i);
            let at = transform.map(|[a, b, c]: [f32; 3]| f64::from(a) * u + f64::from(b) * v + f64::from(c));
            assert!(distance(pixel, bilinear(at, wrap)) < 1e-3, "{wrap:?}, pixel {i}: {pixel:?}");
        }
    }
}

#[test]
fn textures_of_another_wrap_can_fail() {
    let mut material = white();
    material.base_color_texture = Some(TextureSlot { transform: [[2.5, 0.0, -0.7], [0.0, 3.0, 0.1]], ..slot() });
    let repeat = draw(&textured(material.clone(), 3, PICTURE.to_vec(), Wrap::Repeat));
    let clamp = draw(&textured(material, 3, PICTURE.to_vec(), Wrap::Clamp));
    assert!(repeat.iter().zip(&clamp).any(|(&a, &b)| distance(a, b) > 0.3));
}

#[test]
fn masks_have_holes_where_coverage_is_below_the_cutoff() {
    let mut material = white();
    material.base_color_texture = Some(slot());
    material.alpha = AlphaMode::Mask(0.5);
    let mut prt = textured(material, 2, vec![[255, 255, 255, 255], [255, 255, 255, 0]], Wrap::Clamp);
    let mut red = white();
    red.base_color = [1.0, 0.0, 0.0, 1.0];
    add_triangles(&mut prt, red, &quad(Vec3::NEG_Z, Vec3::X * 4.0, Vec3::Y * 4.0));
    prt.geometry.uv0.resize(prt.geometry.positions.len(), [0.0; 2]);
    for (i, pixel) in draw(&prt).into_iter().enumerate() {
        let expected = if uv(i)[0] < 0.5 { [1.0; 3] } else { [1.0, 0.0, 0.0] };
        assert!(distance(pixel, expected) < 1e-3, "pixel {i}: {pixel:?}");
    }
}

fn veil(color: [f32; 3], alpha: f32) -> Material {
    let mut material = white();
    material.base_color = [color[0], color[1], color[2], alpha];
    material.alpha = AlphaMode::Blend;
    material
}

#[test]
fn veils_blend_from_back_to_front_whatever_their_order() {
    let veils = [(0.5, [1.0, 0.0, 0.0], 0.5), (1.0, [0.0, 1.0, 0.0], 0.25), (-0.5, [0.0, 0.0, 1.0], 0.9)];
    // Blue is behind the wall; red lies over white, green over both.
    let expected = [0.75, 0.75 * 0.5 + 0.25, 0.75 * 0.5];
    for order in [[0, 1, 2], [2, 1, 0], [1, 2, 0]] {
        let mut prt = wall(white());
        for (z, color, alpha) in order.map(|i| veils[i]) {
            add_triangles(&mut prt, veil(color, alpha), &quad(Vec3::Z * z, Vec3::X * 2.0, Vec3::Y * 2.0));
        }
        assert!(distance(centre(&prt), expected) < 1e-3, "{order:?}: {:?}", centre(&prt));
    }
}

#[test]
fn glass_shows_what_lies_behind_and_keeps_its_own_glow() {
    let mut glass = white();
    glass.transmission = 0.75;
    glass.emissive = [0.0, 0.0, 0.5];
    let mut prt = wall(white());
    prt.materials[0].base_color = [0.2, 0.2, 0.2, 1.0];
    add_triangles(&mut prt, glass, &quad(Vec3::Z, Vec3::X, Vec3::Y));
    let body = 0.25 + 0.75 * 0.2;
    assert!(distance(centre(&prt), [body, body, body + 0.5]) < 1e-3, "{:?}", centre(&prt));
}

#[test]
fn backs_are_not_drawn() {
    let mut prt = wall(white());
    add_triangles(&mut prt, veil([0.0; 3], 1.0), &quad(Vec3::Z, Vec3::NEG_X, Vec3::Y));
    let mut black = white();
    black.base_color = [0.0; 4];
    add_triangles(&mut prt, black, &quad(Vec3::Z * 0.5, Vec3::NEG_X, Vec3::Y));
    assert!(distance(centre(&prt), [1.0; 3]) < 1e-3);
}

#[test]
fn emission_adds_to_what_is_reflected() {
    let mut lamp = white();
    lamp.emissive = [3.0, 0.5, 0.0];
    lamp.emissive_texture = Some(slot());
    let prt = textured(lamp, 1, vec![[255, 188, 0, 255]], Wrap::Repeat);
    let green = 1.0 + 0.5 * srgb_decode(188.0 / 255.0) as f32;
    assert!(distance(centre(&prt), [4.0, green, 1.0]) < 1e-3, "{:?}", centre(&prt));
}

#[test]
fn metals_shine_without_a_body_and_only_where_the_plan_says_so() {
    let mut metal = white();
    (metal.base_color, metal.metallic, metal.roughness) = ([0.9, 0.6, 0.3, 1.0], 1.0, 0.4);
    assert_eq!(centre(&wall(metal.clone())), [0.0; 3], "no reflection was planned");
    metal.specular = true;
    // A white environment, seen along the normal but for half a pixel.
    let [scale, bias] = environment_brdf(0.4, 1.0);
    let expected = [0.9, 0.6, 0.3].map(|f| f * scale + bias);
    assert!(distance(centre(&wall(metal.clone())), expected) < 2e-3);
    let mut prt = wall(metal);
    prt.transfer.openness = vec![0.5; prt.geometry.positions.len()];
    assert!(distance(centre(&prt), expected.map(|x| 0.5 * x)) < 2e-3, "half of the sky is hidden");
}

#[test]
fn normal_maps_bend_reflections() {
    let mut mirror = white();
    (mirror.metallic, mirror.roughness, mirror.specular) = (1.0, 0.0, true);
    mirror.normal_texture = Some(slot());
    // A normal bent by 45 degrees to the right (or up) sends the view along +x (or +y).
    let bent = 127.5 + 127.5 * std::f32::consts::FRAC_1_SQRT_2;
    let light = Environment::from_function("sides", 128, |d| [d.x.max(0.0), d.y.max(0.0), 0.0]);
    for (texel, bright) in [([bent, 127.5, bent, 255.0], 0), ([127.5, bent, bent, 255.0], 1)] {
        let mut prt = textured(mirror.clone(), 1, vec![texel.map(|x| x as u8)], Wrap::Repeat);
        prt.geometry.tangents = vec![[1.0, 0.0, 0.0, 1.0]; prt.geometry.positions.len()];
        let image = render(&prt, &light, &frame()).expect("a sound scene and frame");
        let seen = image.linear[(SIZE / 2 * SIZE + SIZE / 2) as usize];
        assert!(seen[bright] > 0.9 && seen[1 - bright] < 0.1, "{seen:?}");
    }
}

/// Scale and bias of the split sum by quadrature of the GGX BRDF over directions of the light.
fn integrated_brdf(roughness: f64, cosine: f64) -> [f64; 2] {
    let alpha2 = roughness.powi(4);
    let lambda = |c: f64| ((1.0 + alpha2 * (1.0 / (c * c) - 1.0)).sqrt() - 1.0) / 2.0;
    let view = [(1.0 - cosine * cosine).sqrt(), 0.0, cosine];
    let mut sum = [0.0; 2];
    // Half vectors h by polar angle t and azimuth p; d(light) = 4 (v·h) dh.
    let rule: Vec<(f64, f64)> = gauss_legendre(256).into_iter().map(|(x, w)| ((x + 1.0) / 2.0, w / 2.0)).collect();
    for &(s, weight) in &rule {
        // Half vectors crowd around the normal where the surface is smooth: t = s^3 pi/2.
        let t = s.powi(3) * std::f64::consts::FRAC_PI_2;
        let dt = 3.0 * s * s * std::f64::consts::FRAC_PI_2 * weight;
        let d = alpha2 / (std::f64::consts::PI * (t.cos().powi(2) * (alpha2 - 1.0) + 1.0).powi(2));
        for k in 0..256 {
            let p = std::f64::consts::TAU * (f64::from(k) + 0.5) / 256.0;
            let h = [t.sin() * p.cos(), t.sin() * p.sin(), t.cos()];
            let vh: f64 = (0..3).map(|i| view[i] * h[i]).sum();
            let light = 2.0 * vh * h[2] - view[2];
            if vh <= 0.0 || light <= 0.0 {
                continue;
            }
            let g = 1.0 / (1.0 + lambda(cosine) + lambda(light));
            let f = (1.0 - vh).powi(5);
            let value = d * g * vh / cosine * t.sin() * dt * std::f64::consts::TAU / 256.0;
            sum = [sum[0] + (1.0 - f) * value, sum[1] + f * value];
        }
    }
    sum
}

/// Largest distance of a fit (scale and bias) from the integral, for plastic and for metal.
fn worst_of_fit(fit: impl Fn(f32, f32) -> [f32; 2]) -> f64 {
    let mut worst = 0.0_f64;
    for roughness in [0.1, 0.3, 0.5, 0.7, 1.0] {
        for cosine in [0.1, 0.3, 0.5, 0.8, 1.0] {
            let exact = integrated_brdf(roughness, cosine);
            let fitted = fit(roughness as f32, cosine as f32).map(f64::from);
            for f0 in [0.04, 0.9] {
                worst = worst.max(((fitted[0] - exact[0]) * f0 + fitted[1] - exact[1]).abs());
            }
        }
    }
    worst
}

#[test]
fn the_fit_of_the_environment_brdf_follows_its_integral() {
    let worst = worst_of_fit(environment_brdf);
    assert!(worst < 0.006, "off by {worst}");
}

#[test]
fn a_fit_of_linear_roughness_can_fail() {
    assert!(worst_of_fit(|roughness, cosine| environment_brdf(roughness * roughness, cosine)) > 0.1);
}

/// A file without reflections costs no blurred probe; masks, emission and normal maps alone call for none either.
#[test]
fn only_what_mirrors_blurs_the_probe() {
    let sky = Environment::constant([1.0; 3]);
    let levels = |material: Material| {
        let prt = wall(material);
        render_cpu::Renderer::without_window(&prt, &sky).expect("a sound scene").reflection_levels()
    };
    assert_eq!(levels(white()), 0);
    assert_eq!(levels(Material { alpha: AlphaMode::Mask(0.5), emissive: [1.0; 3], metallic: 1.0, ..white() }), 0);
    assert_eq!(levels(Material { specular: true, ..white() }), render_cpu::REFLECTION_LEVELS, "can fail");
}

/// An unlit wall sends its base colour times texture and vertex colour under any light; its mask and coverage stay.
#[test]
fn unlit_surfaces_show_their_base_colour() {
    let unlit = |alpha| Material {
        base_color: [0.8, 0.1, 0.4, 0.25],
        metallic: 1.0,
        emissive: [3.0; 3],
        specular: true,
        unlit: true,
        alpha,
        ..white()
    };
    for radiance in [0.0, 1.0, 7.0] {
        let environment = Environment::constant([radiance; 3]);
        let draw = |prt: &Prt| render(prt, &environment, &frame()).expect("a sound scene and frame").linear[100];
        assert_eq!(draw(&wall(unlit(AlphaMode::Opaque))), [0.8, 0.1, 0.4]);
        // Coverage 1/4 before black.
        assert_eq!(draw(&wall(unlit(AlphaMode::Blend))), [0.2, 0.025, 0.1]);
        assert_eq!(draw(&wall(unlit(AlphaMode::Mask(0.5)))), [0.0; 3], "a hole");
        let bare = Material { base_color_texture: Some(slot()), ..unlit(AlphaMode::Opaque) };
        let half = textured(bare, 1, vec![[255, 0, 188, 255]], Wrap::Clamp);
        let expected = [0.8, 0.0, 0.4 * ((188.0f32 / 255.0 + 0.055) / 1.055).powf(2.4)];
        assert!(distance(draw(&half), expected) < 1e-6, "{:?}", draw(&half));
    }
}

#[test]
fn unlit_can_fail() {
    let lit = wall(Material { base_color: [0.8, 0.1, 0.4, 1.0], ..white() });
    let drawn = render(&lit, &Environment::constant([7.0; 3]), &frame()).expect("a sound scene and frame").linear[100];
    assert!(drawn[0] > 2.0, "the same wall lit is bright: {drawn:?}");
}
