//! Light maps under a light and in another basis, against the signal at single normals.

use coeff_io::{Layers, Lit, MapLight, Maps, Sheet};
use glam::{Quat, Vec3};
use sh_math::hemisphere::Basis;
use sh_math::{Bands, Rgb};

const SIZE: [u32; 2] = [3, 2];

fn noise(i: usize) -> f32 {
    (1.0 + 3.7 * i as f32).sin()
}

fn maps(basis: Basis, light: MapLight, channels: u32) -> Maps {
    let count = (basis.count() * light.depth()) as u32;
    let values = (0..(count * SIZE[0] * SIZE[1] * channels) as usize).map(noise).collect::<Vec<_>>();
    let layers = Layers::exact([SIZE[0], SIZE[1], count, channels], &values);
    Maps { basis, light, sheets: vec![Sheet { layers }], sheet_of_mesh: vec![Some(0)] }
}

/// What a texel shows at a normal.
fn shown(lit: &Lit, basis: Basis, texel: usize, normal: Vec3) -> [f32; 3] {
    let coefficients = lit.functions.iter().map(|function| function[texel]).collect::<Vec<_>>();
    basis.reconstruct(&coefficients, normal)
}

/// Normals of the upper hemisphere.
fn normals() -> impl Iterator<Item = Vec3> {
    (0..40).map(|i| Vec3::new(noise(3 * i), noise(3 * i + 1), noise(3 * i + 2).abs()).normalize())
}

fn worst(stored: Basis, drawn: Basis) -> f32 {
    let maps = maps(stored, MapLight::Fixed { probe: "test".into(), bands: 3 }, 3);
    let before = maps.sheets[0].lit(&maps, &[]);
    let after = before.clone().changed(stored, drawn);
    assert_eq!((after.width, after.height, after.functions.len()), (SIZE[0], SIZE[1], drawn.count()));
    let mut worst = 0.0f32;
    for normal in normals() {
        for texel in 0..(SIZE[0] * SIZE[1]) as usize {
            let pairs = shown(&before, stored, texel, normal).into_iter().zip(shown(&after, drawn, texel, normal));
            worst = pairs.map(|(a, b)| (a - b).abs()).fold(worst, f32::max);
        }
    }
    worst
}

#[test]
fn another_basis_shows_the_same_where_it_can() {
    for (stored, drawn) in [(Basis::H6, Basis::ModifiedH6), (Basis::ModifiedH6, Basis::H6), (Basis::H4, Basis::Sh4)] {
        let error = worst(stored, drawn);
        assert!(error < 5e-6, "{} in {}: {error}", stored.name(), drawn.name());
    }
    let error = worst(Basis::H6, Basis::Sh9);
    assert!(error < 1e-4, "coefficients of some tens: {error}");
}

#[test]
fn another_basis_can_fail() {
    let error = worst(Basis::H6, Basis::Makhotkin9);
    assert!(error > 0.1, "a basis that is black at the border must be noticed: {error}");
}

/// A light of one colour per channel against the dot products written out.
#[test]
fn maps_take_the_bands_that_they_answer_to() {
    let maps = maps(Basis::H4, MapLight::Relightable { bands: 2 }, 1);
    let values = (0..9).map(|i| [noise(i), noise(i + 50), noise(i + 100)]).collect();
    let light = Rgb { bands: Bands::new(3).expect("three bands"), values };
    let lit = maps.sheets[0].lit(&maps, &maps.light_of(&light).values);
    let plane = (SIZE[0] * SIZE[1]) as usize;
    for (k, function) in lit.functions.iter().enumerate() {
        for (texel, rgb) in function.iter().enumerate() {
            for (channel, value) in rgb.iter().enumerate() {
                let exact: f64 = (0..4)
                    .map(|i| f64::from(noise((k * 4 + i) * plane + texel)) * f64::from(light.values[i][channel]))
                    .sum();
                assert!((f64::from(*value) - exact).abs() < 1e-6, "function {k}, texel {texel}");
            }
        }
    }
    let dim = Rgb { bands: Bands::new(1).expect("one band"), values: vec![[1.0; 3]] };
    assert_eq!(maps.light_of(&dim).values, [[1.0; 3], [0.0; 3], [0.0; 3], [0.0; 3]], "black above its bands");
}

#[test]
fn a_basis_is_chosen_or_refused() {
    let fixed = maps(Basis::Sh9, MapLight::Fixed { probe: "hall".into(), bands: 3 }, 3);
    let choose = |maps: Option<&Maps>, basis, functions, turn: f32| {
        Maps::drawn_in(maps, basis, functions, Quat::from_rotation_z(turn))
    };
    assert_eq!(choose(Some(&fixed), None, None, 0.0), Ok(Some(Basis::Sh9)));
    assert_eq!(choose(Some(&fixed), Some(Basis::ModifiedH6), Some(1), 0.0), Ok(Some(Basis::ModifiedH1)));
    assert_eq!(choose(None, None, None, 1.0), Ok(None));
    assert!(choose(Some(&fixed), None, None, 0.01).is_err_and(|what| what.contains("`hall`")));
    assert!(choose(Some(&fixed), None, Some(4), 0.0).is_err_and(|what| what.contains("ask for 9")));
    assert!(choose(None, Some(Basis::H4), None, 0.0).is_err());
    let relightable = maps(Basis::Sh9, MapLight::Relightable { bands: 2 }, 1);
    assert_eq!(choose(Some(&relightable), None, None, 0.01), Ok(Some(Basis::Sh9)));
}
