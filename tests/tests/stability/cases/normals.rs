//! Shading normals that point behind their surface, or nowhere.

use super::Case;
use super::baking::{fixed, grey, quiet, values};
use super::case::difference;
use glam::Vec3;
use sh_math::{Bands, zonal};

pub(crate) fn inverted() -> Case {
    Case {
        title: "every third shading normal points behind the surface",
        bound: "change of the transfer of a plane, infinite where they are not counted: the face's normal takes their place",
        limit: 1e-7,
        ours: || mended(|i, normal| if i % 3 == 0 { -normal } else { normal }),
        naive_method: "the cosine about the normal as given",
        naive: || taken_as_given(Vec3::NEG_Y),
    }
}

pub(crate) fn not_a_number() -> Case {
    Case {
        title: "shading normals that are zero, infinite or not a number",
        bound: "change of the transfer of a plane, infinite where they are not counted",
        limit: 1e-7,
        ours: || {
            mended(|i, normal| match i % 12 {
                0 => Vec3::NAN,
                3 => Vec3::ZERO,
                6 => Vec3::INFINITY,
                9 => Vec3::new(f32::NAN, 1.0, 0.0),
                _ => normal,
            })
        },
        naive_method: "the normal over its length",
        naive: || taken_as_given(Vec3::ZERO / Vec3::ZERO.length()),
    }
}

/// Change of a plane's transfer when every third normal is broken in some way.
fn mended(broken: fn(usize, Vec3) -> Vec3) -> f64 {
    let settings = fixed(5, 16, 0);
    let mut scene = grey("plane", 0.5);
    let before = values(&quiet(&scene, &settings));
    for (i, normal) in scene.meshes[0].normals.iter_mut().enumerate() {
        *normal = broken(i, *normal);
    }
    let prt = quiet(&scene, &settings);
    let counted = prt.achieved.repairs.bad_normals as usize == scene.meshes[0].normals.len().div_ceil(3);
    if counted { difference(&before, &values(&prt)) } else { f64::INFINITY }
}

/// Difference that one such normal makes where it is used as it stands.
fn taken_as_given(normal: Vec3) -> f64 {
    let bands = Bands::new(5).expect("in range");
    let transfer = |normal: Vec3| {
        let mut out = vec![0.0f32; bands.coefficients()];
        zonal::cosine_transfer(bands, normal, &mut out);
        out.into_iter().map(f64::from).collect::<Vec<f64>>()
    };
    difference(&transfer(Vec3::Y), &transfer(normal))
}
