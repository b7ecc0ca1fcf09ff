//! A white sky on surfaces that shine, against the formulas of glTF 2.0 by quadrature.

mod handmade;

use coeff_io::Material;
use handmade::gloss::{SIZE, STORAGES, belt, front, same_everywhere, to_eye};
use handmade::{wall, white};
use probe_io::Environment;
use render_cpu::render;
use testkit::gltf::Surface;

const ROUGHNESSES: [f32; 5] = [0.0, 0.2, 0.4, 0.7, 1.0];
const METALLICS: [f32; 3] = [0.0, 0.5, 1.0];
/// Absolute, of a sky of radiance 1: half of one per cent.
const BOUND: f64 = 5e-3;

fn shiny(base: f32, metallic: f32, roughness: f32) -> Material {
    Material { base_color: [base, base, base, 1.0], metallic, roughness, specular: true, ..white() }
}

/// Largest distance of a picture from the formula of a surface.
fn apart(picture: &[[f32; 3]], surface: Surface) -> f64 {
    let off =
        |(pixel, seen): (usize, &[f32; 3])| (f64::from(seen[1]) - surface.of_white_sky(to_eye(pixel, SIZE).z)).abs();
    // From a corner to the middle: every angle that the wall shows.
    let half = SIZE as usize / 2;
    (0..half).map(|k| k * (SIZE as usize + 1)).map(|pixel| off((pixel, &picture[pixel]))).fold(0.0, f64::max)
}

fn surface(base: f32, metallic: f32, roughness: f32) -> Surface {
    Surface { base: f64::from(base), metallic: f64::from(metallic), roughness: f64::from(roughness) }
}

/// From the probe alone, and from what arrives by direction.
#[test]
fn a_furnace_is_what_gltf_says() {
    let sky = Environment::constant([1.0; 3]);
    for (base, metallic) in METALLICS.map(|metallic| (1.0, metallic)).into_iter().chain([(0.3, 0.0)]) {
        for roughness in ROUGHNESSES {
            let plain = wall(shiny(base, metallic, roughness));
            let glossy =
                STORAGES[..1].iter().map(|storage| same_everywhere(plain.clone(), *storage, &belt(0.0, 1.0), None));
            for prt in glossy.chain([plain.clone()]) {
                let picture = render(&prt, &sky, &front(SIZE)).expect("a picture").linear;
                let off = apart(&picture, surface(base, metallic, roughness));
                assert!(off < BOUND, "{base} {metallic} {roughness}: {off}");
                let other = surface(base * 0.99, metallic, roughness);
                assert!(base < 1.0 || apart(&picture, other) > 0.5 * BOUND, "can fail: one per cent less colour");
            }
        }
    }
}

/// The figure that dielectrics had when the diffuse part kept all: 1.06 and not 1.02.
#[test]
fn a_diffuse_part_that_keeps_all_can_fail() {
    let sky = Environment::constant([1.0; 3]);
    let prt = wall(shiny(1.0, 0.0, 0.4));
    let picture = render(&prt, &sky, &front(SIZE)).expect("a picture").linear;
    let all: Vec<[f32; 3]> = picture.iter().map(|seen| seen.map(|x| x + 0.041)).collect();
    assert!(apart(&all, surface(1.0, 0.0, 0.4)) > 5.0 * BOUND);
}
