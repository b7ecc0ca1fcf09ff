//! Light probes with pixels that are no light, or with hardly any pixel.

use super::Case;
use super::case::worst;
use glam::{DVec3, Vec3};
use probe_io::{Environment, Layout, LoadOptions, Probe, read_picture, write_exr};
use sh_math::{Bands, Rgb, project};
use std::f64::consts::PI;
use std::path::Path;

pub(crate) fn not_a_number() -> Case {
    Case {
        title: "probes with a pixel that is not a number or infinite",
        bound: "coefficients that are not finite, 25 in each of 3 files: the files are refused, and the pixel is named",
        limit: 0.0,
        ours: || {
            counted([f32::NAN, f32::INFINITY, f32::NEG_INFINITY], |path| {
                let refused = Environment::load(path, &LoadOptions::lenient()).expect_err("no light").to_string();
                if refused.contains("pixel (5, 2)") { 0 } else { 25 }
            })
        },
        naive_method: "to project what the file holds",
        naive: || {
            counted([f32::NAN, f32::INFINITY, f32::NEG_INFINITY], |path| {
                let light = project(bands(5), Environment::from_image("raw", raw(path)).samples());
                light.values.as_flattened().iter().filter(|value| !value.is_finite()).count()
            })
        },
    }
}

pub(crate) fn negative() -> Case {
    Case {
        title: "probe with a pixel of -5",
        bound: "darkest radiance below 0 once it is clamped by choice; infinite where it is not refused or not told",
        limit: 0.0,
        ours: || {
            with_pixel(-5.0, |path| {
                let strict = Environment::load(path, &LoadOptions::strict());
                let (clamped, told) = Environment::load(path, &LoadOptions::lenient()).expect("clamped by choice");
                if strict.is_ok() || told.is_empty() { f64::INFINITY } else { darkness(&clamped.image) }
            })
        },
        naive_method: "to take what the file holds",
        naive: || with_pixel(-5.0, |path| darkness(&raw(path))),
    }
}

pub(crate) fn one_pixel() -> Case {
    Case {
        title: "probes of one pixel (angular, panorama), of two and of six, radiance 1",
        bound: "error of 8 bands against √4π, 0, 0, … over √4π: pixels are cut as fine as those of 256 rows, l²/24 (π/256)² at l = 7 is 3e-4 of a wave of which most cancels",
        limit: 1e-4,
        ours: || worst(shapes().map(|shape| from_constant(&loaded(shape)))),
        naive_method: "one sample at the centre of each pixel",
        naive: || {
            worst(shapes().map(|shape| {
                let texels: Vec<_> = loaded(shape).image.texels().collect();
                let samples =
                    texels.into_iter().map(|t| (t.direction, t.radiance.map(|r| f64::from(r) * t.solid_angle)));
                error_of_constant(&project(bands(8), samples))
            }))
        },
    }
}

pub(crate) fn behind_the_angular_map() -> Case {
    Case {
        title: "angular map looked up straight back",
        bound: "error of the angle from forward over π, which the pixels hold: the rim's pixel is half a pixel of 64 off",
        limit: 1.0 / 32.0,
        ours: || {
            let map = ramp();
            straight_back(|d| map.radiance(d)[0])
        },
        naive_method: "the listing: the centre where x² + y² = 0",
        naive: || {
            let map = ramp();
            straight_back(|d| as_listed(&map, d))
        },
    }
}

/// Worst angle over π that a look-up straight back finds, less 1.
fn straight_back(look: impl Fn(Vec3) -> f32) -> f64 {
    let directions = [Vec3::NEG_Z, Vec3::new(-0.0, 0.0, -1.0), Vec3::new(1e-30, 0.0, -1.0)];
    worst(directions.map(|direction| (f64::from(look(direction)) - 1.0).abs()))
}

/// The listing's way into the map: `r = acos(z) / π / sqrt(x² + y²)`, and 0 where that would divide by 0.
fn as_listed(map: &Probe, Vec3 { x, y, z }: Vec3) -> f32 {
    let sine = (x * x + y * y).sqrt();
    let r = if sine > 0.0 { libm::acosf(z) / std::f32::consts::PI / sine } else { 0.0 };
    let place = |v: f32, side: usize| (((0.5 + 0.5 * v * r) * side as f32) as usize).min(side - 1);
    map.pixels[place(y, map.height) * map.width + place(x, map.width)][0]
}

fn bands(count: u32) -> Bands {
    Bands::new(count).expect("in range")
}

/// Writes a panorama of 1 with one pixel of `value` and hands its path on.
fn with_pixel<T>(value: f32, look: impl Fn(&Path) -> T) -> T {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("probe.exr");
    let mut pixels = vec![[1.0f32; 3]; 16 * 8];
    pixels[2 * 16 + 5] = [1.0, value, 1.0];
    write_exr(&path, 16, 8, &pixels).expect("a written file");
    look(&path)
}

fn counted(values: [f32; 3], count: fn(&Path) -> usize) -> f64 {
    values.into_iter().map(|value| with_pixel(value, count)).sum::<usize>() as f64
}

/// The file's pixels as they stand.
fn raw(path: &Path) -> Probe {
    let (width, height, pixels) = read_picture(path).expect("a readable file");
    Probe { layout: Layout::Equirect, width, height, pixels }
}

fn darkness(probe: &Probe) -> f64 {
    worst(probe.pixels.as_flattened().iter().map(|&value| -f64::from(value)))
}

/// Layout, width and height.
type Shape = (Layout, usize, usize);

fn shapes() -> [Shape; 4] {
    [(Layout::Angular, 1, 1), (Layout::Equirect, 1, 1), (Layout::Equirect, 2, 1), (Layout::Faces, 1, 6)]
}

/// A probe of radiance 1 that went through a file.
fn loaded((layout, width, height): Shape) -> Environment {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("probe.exr");
    write_exr(&path, width, height, &vec![[1.0; 3]; width * height]).expect("a written file");
    let options = LoadOptions { layout: Some(layout), ..LoadOptions::strict() };
    Environment::load(&path, &options).expect("a good probe").0
}

fn from_constant(environment: &Environment) -> f64 {
    error_of_constant(&project(bands(8), environment.samples()))
}

fn error_of_constant(light: &Rgb) -> f64 {
    let expected = |i: usize| if i == 0 { (4.0 * PI).sqrt() } else { 0.0 };
    worst(light.values.iter().enumerate().map(|(i, value)| (f64::from(value[0]) - expected(i)).abs() / expected(0)))
}

/// An angular map whose pixels hold the angle from forward over π.
fn ramp() -> Probe {
    let side = 64;
    let blank = Probe { layout: Layout::Angular, width: side, height: side, pixels: vec![[0.0; 3]; side * side] };
    let mut pixels = blank.pixels.clone();
    for texel in blank.texels() {
        let angle = libm::acos(texel.direction.dot(DVec3::Z)) / PI;
        pixels[blank.texel_index(texel.direction.as_vec3())] = [angle as f32; 3];
    }
    Probe { pixels, ..blank }
}
