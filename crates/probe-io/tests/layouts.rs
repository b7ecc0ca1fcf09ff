//! One place in every layout is one light: real files, compared by coefficients and by direction.

use glam::Vec3;
use probe_io::{Environment, Layout, LoadOptions, Probe};
use sh_math::{Bands, Rgb};
use std::path::{Path, PathBuf};

/// Bands that the files are compared at.
const BANDS: u32 = 5;

/// Relative distance of coefficients that files of one place may have: what resampling of small bright lamps and
/// the rounding of shared exponents leave.
const SAME_PLACE: f64 = 0.015;

/// The folder of one place in all layouts, or `None` where the outside data is missing.
fn folder() -> Option<PathBuf> {
    let data = testkit::data_dir();
    if data.is_none() {
        testkit::skip("probes of one place in every layout");
    }
    Some(data?.join("probes/layouts"))
}

fn load(path: PathBuf) -> Environment {
    let loaded = Environment::load(&path, &LoadOptions::strict());
    loaded.unwrap_or_else(|error| panic!("{error}")).0
}

fn coefficients(environment: &Environment) -> Rgb {
    sh_math::project(Bands::new(BANDS).unwrap(), environment.samples())
}

/// Length of the difference over the length, over all bands and channels.
fn distance(a: &Rgb, b: &Rgb) -> f64 {
    let square = |v: f32| f64::from(v) * f64::from(v);
    let values = a.values.iter().zip(&b.values);
    let difference: f64 = values.flat_map(|(a, b)| (0..3).map(move |c| square(a[c] - b[c]))).sum();
    let size: f64 = b.values.iter().flatten().map(|v| square(*v)).sum();
    (difference / size).sqrt()
}

/// The other files of the place in `KernerEnvLatLong.exr`, with the layout that must be found.
const SAME: [(&str, Layout); 5] = [
    ("KernerEnvCube.exr", Layout::ExrCube),
    ("kerner_angular_512.hdr", Layout::Angular),
    ("kerner_vertical_cross_128.hdr", Layout::VerticalCross),
    ("kerner_horizontal_cross_128.exr", Layout::HorizontalCross),
    ("kerner_faces_128", Layout::Faces),
];

#[test]
fn every_layout_of_one_place_has_the_same_coefficients() {
    let Some(folder) = folder() else { return };
    let reference = load(folder.join("KernerEnvLatLong.exr"));
    assert_eq!(reference.image.layout, Layout::Equirect);
    let reference = coefficients(&reference);
    for (file, layout) in SAME {
        let environment = load(folder.join(file));
        assert_eq!(environment.image.layout, layout, "{file}");
        let error = distance(&coefficients(&environment), &reference);
        assert!(error < SAME_PLACE, "{file} is {error} away");
    }
}

#[test]
fn every_layout_of_one_place_has_the_same_coefficients_can_fail() {
    let Some(folder) = folder() else { return };
    let reference = coefficients(&load(folder.join("KernerEnvLatLong.exr")));
    for (file, _) in SAME {
        let mut environment = load(folder.join(file));
        environment.image = mirrored(&environment.image);
        let error = distance(&coefficients(&environment), &reference);
        assert!(error > 5.0 * SAME_PLACE, "{file} mirrored is only {error} away");
    }
    // OpenEXR's strip read by the face rules of other tools.
    let mut wrong = load(folder.join("KernerEnvCube.exr"));
    wrong.image.layout = Layout::Faces;
    assert!(distance(&coefficients(&wrong), &reference) > 5.0 * SAME_PLACE);
}

/// The same light with left and right exchanged.
fn mirrored(probe: &Probe) -> Probe {
    let mut panorama = probe.to_equirect(256);
    for line in panorama.pixels.chunks_exact_mut(panorama.width) {
        line.reverse();
    }
    panorama
}

/// How far a panorama of the place is from the angular map that it was made of, as it is and turned over.
fn as_it_is_and_turned(folder: &Path, panorama: &Environment) -> (f64, f64) {
    let right = coefficients(&load(folder.join("kerner_angular_512.hdr")));
    let turned = Environment::from_image("turned", mirrored(&panorama.image));
    (distance(&coefficients(panorama), &right), distance(&coefficients(&turned), &right))
}

#[test]
fn the_converter_that_mirrors_is_found_out() {
    let Some(folder) = folder() else { return };
    let theirs = load(folder.join("kerner_angular_to_latlong_oiio.exr"));
    let (as_it_is, turned) = as_it_is_and_turned(&folder, &theirs);
    // The converter halves the picture, so turned over it comes back to twice the distance of the others.
    assert!(as_it_is > 5.0 * SAME_PLACE && turned < 2.0 * SAME_PLACE, "{as_it_is} as it is, {turned} turned over");
}

#[test]
fn the_converter_that_mirrors_is_found_out_can_fail() {
    let Some(folder) = folder() else { return };
    let ours = load(folder.join("KernerEnvLatLong.exr"));
    let (as_it_is, turned) = as_it_is_and_turned(&folder, &ours);
    assert!(turned > 5.0 * SAME_PLACE && as_it_is < SAME_PLACE, "{as_it_is} as it is, {turned} turned over");
}

/// Mean of the colours in a small cap around a direction.
fn mean_around(environment: &Environment, axis: Vec3, radius: f32) -> Vec3 {
    let (tangent, bitangent) = axis.any_orthonormal_pair();
    let mut sum = Vec3::ZERO;
    for i in 0..400 {
        let r = radius * ((i as f32 + 0.5) / 400.0).sqrt();
        let angle = i as f32 * 2.399_963;
        let d = axis + r * (tangent * angle.cos() + bitangent * angle.sin());
        sum += Vec3::from(environment.radiance(d.normalize()));
    }
    sum / 400.0
}

#[test]
fn orientation_charts_agree_by_direction() {
    let Some(folder) = folder() else { return };
    let panorama = load(folder.join("OrientationLatLong.exr"));
    let cube = load(folder.join("OrientationCube.exr"));
    assert_eq!(cube.image.layout, Layout::ExrCube);
    let mut worst: (f32, Vec3) = (0.0, Vec3::ZERO);
    let mut total = 0.0;
    for i in 0..2000 {
        let z = 1.0 - (2.0 * i as f32 + 1.0) / 2000.0;
        let (s, c) = (i as f32 * 2.399_963).sin_cos();
        let r = (1.0 - z * z).sqrt();
        let d = Vec3::new(r * c, r * s, z);
        let difference = mean_around(&panorama, d, 0.03) - mean_around(&cube, d, 0.03);
        let size = difference.abs().max_element();
        total += size / 2000.0;
        if size > worst.0 {
            worst = (size, d);
        }
    }
    assert!(total < 0.01 && worst.0 < 0.15);
}

/// How dark the chart is on the line from the middle of a face towards a side: the share of steps with black ink.
fn ink(environment: &Environment, face: Vec3, side: Vec3) -> f32 {
    let across = face.cross(side);
    let is_black = |t: f32| {
        (-6..=6).any(|k| {
            let d = face + t * side + 0.003 * k as f32 * across;
            Vec3::from(environment.radiance(d.normalize())).max_element() < 0.35
        })
    };
    let steps = 40;
    (0..steps).filter(|i| is_black(0.04 + 0.2 * *i as f32 / steps as f32)).count() as f32 / steps as f32
}

/// From the middle of each side face the charts draw black arms along the positive axes, and none along the negative.
fn arms_are_right(environment: &Environment, world: impl Fn(Vec3) -> Vec3) -> bool {
    let mut right = true;
    for face in [Vec3::X, -Vec3::X, Vec3::Z, -Vec3::Z] {
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            if face.dot(axis) != 0.0 {
                continue;
            }
            let (with, against) =
                (ink(environment, world(face), world(axis)), ink(environment, world(face), world(-axis)));
            right &= with > 0.9 && against < 0.6;
        }
    }
    right
}

#[test]
fn orientation_charts_draw_their_axes_where_we_look() {
    let Some(folder) = folder() else { return };
    for file in ["OrientationLatLong.exr", "OrientationCube.exr"] {
        assert!(arms_are_right(&load(folder.join(file)), |d| d), "{file}");
    }
}

#[test]
fn orientation_charts_draw_their_axes_where_we_look_can_fail() {
    let Some(folder) = folder() else { return };
    let chart = load(folder.join("OrientationLatLong.exr"));
    assert!(!arms_are_right(&chart, |d| Vec3::new(-d.x, d.y, d.z)), "mirrored");
    assert!(!arms_are_right(&chart, |d| Vec3::new(d.x, -d.y, d.z)), "upside down");
    assert!(!arms_are_right(&chart, |d| Vec3::new(d.z, d.y, -d.x)), "turned by 90 degrees");
}
