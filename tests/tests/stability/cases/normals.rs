//! Shading normals that point behind their surface, or nowhere.

use super::Case;
use super::baking::{fixed, grey, quiet, values};
use super::case::{difference, worst};
use glam::Vec3;
use sh_math::{Bands, zonal};

pub(crate) fn inverted() -> Case {
    Case {
        title: "every third shading normal points behind the surface",
        bound: "change of the transfer of a plane, infinite where they are not counted: the face's normal takes their place",
        limit: 1e-7,
        ours: || mended(turned_round),
        naive_method: "the cosine about the normal as given",
        naive: || taken_as_given(turned_round, |normal| normal),
    }
}

pub(crate) fn not_a_number() -> Case {
    Case {
        title: "shading normals that are zero, infinite or not a number",
        bound: "change of the transfer of a plane, infinite where they are not counted",
        limit: 1e-7,
        ours: || mended(no_direction),
        naive_method: "the normal over its length",
        naive: || taken_as_given(no_direction, |normal| normal / normal.length()),
    }
}

/// What takes the place of the normal of a vertex.
type Broken = fn(usize, Vec3) -> Vec3;

fn turned_round(i: usize, normal: Vec3) -> Vec3 {
    if i.is_multiple_of(3) { -normal } else { normal }
}

fn no_direction(i: usize, normal: Vec3) -> Vec3 {
    match i % 12 {
        0 => Vec3::NAN,
        3 => Vec3::ZERO,
        6 => Vec3::INFINITY,
        9 => Vec3::new(f32::NAN, 1.0, 0.0),
        _ => normal,
    }
}

/// Change of a plane's transfer when every third normal is broken in some way.
fn mended(broken: Broken) -> f64 {
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

/// The same where the cosine of open receivers is taken about what is `made` of each normal as it stands.
fn taken_as_given(broken: Broken, made: fn(Vec3) -> Vec3) -> f64 {
    let bands = Bands::new(5).expect("in range");
    let transfer = |normal: Vec3| {
        let mut out = vec![0.0f32; bands.coefficients()];
        zonal::cosine_transfer(bands, normal, &mut out);
        out.into_iter().map(f64::from).collect::<Vec<f64>>()
    };
    let plane = &grey("plane", 0.5).meshes[0];
    let changes = plane.normals.iter().enumerate();
    worst(changes.map(|(i, &normal)| difference(&transfer(normal), &transfer(made(broken(i, normal))))))
}
