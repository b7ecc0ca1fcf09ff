//! A scene with normal maps, as its light maps show it in any basis and as paths through bent normals show it.
#![allow(dead_code, reason = "the test and the example use a part each")]

use crate::support::BandLight;
use bake::{Extras, FixedLight, MapSettings, SheetSettings};
use coeff_io::{Bounces, Camera, Encoding, Prt, Quality, Settings};
use glam::Vec3;
use probe_io::Environment;
use render_cpu::{Frame, Renderer};
use scene::Scene;
use sh_math::hemisphere::Basis;
use sh_math::{Bands, Rgb};
use std::ops::ControlFlow;

/// Samples along each side of a pixel.
const SUPERSAMPLE: u32 = 4;

/// How many bands hold a light, without negative parts.
pub(crate) fn windowed(environment: &Environment, bands: u32) -> Rgb {
    let light = sh_math::project(Bands::new(bands).expect("1 to 32 bands"), environment.samples());
    light.windowed(&sh_math::window::automatic(&light))
}

/// Bakes a scene that brings coordinates for one sheet of `side` texels, with a light in it, in nine harmonics.
pub(crate) fn baked(scene: &Scene, light: &Rgb, side: u32, quality: Quality, bounces: Bounces) -> Prt {
    let meshes = (0..scene.meshes.len()).collect();
    let sheets = vec![SheetSettings { meshes, width: side, height: side, directional: true }];
    let maps = MapSettings { basis: Basis::Sh9, sheets, stitch: true, dilation: 2, encoding: Encoding::F32 };
    let light_inside = FixedLight { name: "windowed".into(), coefficients: light.values.clone() };
    let extras = Extras { maps: Some(maps), light: Some(light_inside), ..Extras::default() };
    let settings = Settings { bands: light.bands.count() as u32, quality, bounces, ..bake::settings::standard() };
    bake::bake_with(scene, &settings, &extras, &|_| ControlFlow::Continue(())).expect("the scene bakes")
}

/// What both sides draw.
#[derive(Debug, Clone)]
pub(crate) struct Shot {
    pub(crate) camera: Camera,
    pub(crate) size: [u32; 2],
    /// Paths per pixel of each half of the reference.
    pub(crate) samples: u32,
    pub(crate) max_bounces: Option<u32>,
}

/// The picture by paths, twice over.
pub(crate) struct Truth {
    /// From different seeds.
    halves: [Vec<[f32; 3]>; 2],
}

impl Truth {
    /// Follows paths through the scene, normal maps bending normals where it has any.
    pub(crate) fn trace(scene: &Scene, light: &Rgb, shot: &Shot) -> Self {
        let world = reference::World::with_normal_maps(scene, true);
        let light = BandLight::new(light).picture.with_sky(&Environment::constant([0.0; 3]));
        let from = &shot.camera;
        let camera = scene::Camera {
            name: from.name.clone(),
            eye: from.eye.into(),
            target: from.target.into(),
            up: from.up.into(),
            vertical_fov: from.vertical_fov,
        };
        let half = |seed| {
            let settings = reference::Settings { samples: shot.samples, seed, max_bounces: shot.max_bounces };
            reference::render(&world, &light, &camera, shot.size, &settings, &|_| ControlFlow::Continue(()))
                .expect("nobody cancels")
                .pixels
        };
        Self { halves: [half(1), half(2)] }
    }

    /// Compares a drawing, over the pixels that show the scene alone.
    pub(crate) fn judge(&self, drawing: &Drawing) -> Figures {
        let mut sums = Sums::default();
        for (pixel, (a, b)) in self.halves[0].iter().zip(&self.halves[1]).enumerate() {
            if drawing.covered[pixel] {
                sums.add(drawing.pixels[pixel], *a, *b);
            }
        }
        sums.figures()
    }
}

/// What light maps show.
pub(crate) struct Drawing {
    /// Linear radiance; nothing behind the scene.
    pub(crate) pixels: Vec<[f32; 3]>,
    /// Whether a sky behind the scene would change nothing there.
    covered: Vec<bool>,
}

impl Drawing {
    /// Root of the mean squared difference from another drawing of the same scene, as a share of the root mean square of that.
    pub(crate) fn apart(&self, other: &Self) -> f64 {
        let (mut squares, mut power) = (0.0, 0.0);
        for (pixel, _) in self.covered.iter().enumerate().filter(|(_, covered)| **covered) {
            let [a, b] = [self, other].map(|drawing| Vec3::from(drawing.pixels[pixel]).as_dvec3());
            squares += (a - b).length_squared();
            power += b.length_squared();
        }
        (squares / power).sqrt()
    }
}

/// Draws the light maps of a diffuse scene in a basis, and what has none, which may be all, under the same light.
pub(crate) fn drawn(prt: &Prt, light: &Rgb, shot: &Shot, basis: impl Into<Option<Basis>>) -> Drawing {
    let basis = basis.into();
    let white = Environment::constant([1.0; 3]);
    let mut renderer = Renderer::without_window(prt, &white).expect("a sound file");
    renderer.set_light(light.clone());
    let draw = |sky| {
        let frame = Frame {
            supersample: SUPERSAMPLE,
            basis,
            sky,
            ..Frame::plain(shot.camera.clone(), shot.size[0], shot.size[1])
        };
        renderer.draw(&frame).expect("a sound frame").linear
    };
    let (pixels, before_sky) = (draw(false), draw(true));
    let covered = pixels.iter().zip(before_sky).map(|(without, with)| *without == with).collect();
    Drawing { pixels, covered }
}

/// How far a drawing is from the reference, as shares of the root mean square (rms, noise) or the mean (bias, p99) of its radiance.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Figures {
    /// Pixels compared.
    pub(crate) pixels: usize,
    /// Root of the mean squared error, that of the reference's own noise taken off.
    pub(crate) rms: f64,
    /// Mean error, with its sign.
    pub(crate) bias: f64,
    /// 99th percentile over pixels of the length of the error, noise included.
    pub(crate) p99: f64,
    /// Root of the mean squared noise of the reference, from the difference of its halves.
    pub(crate) noise: f64,
}

#[derive(Default)]
struct Sums {
    squares: f64,
    noise: f64,
    power: f64,
    difference: f64,
    radiance: f64,
    lengths: Vec<f64>,
}

impl Sums {
    fn add(&mut self, drawn: [f32; 3], a: [f32; 3], b: [f32; 3]) {
        let (a, b) = (Vec3::from(a).as_dvec3(), Vec3::from(b).as_dvec3());
        let (mean, error) = (0.5 * (a + b), Vec3::from(drawn).as_dvec3() - 0.5 * (a + b));
        self.squares += error.length_squared();
        // The mean of two independent halves has a quarter of the variance of their difference.
        self.noise += 0.25 * (a - b).length_squared();
        self.power += mean.length_squared();
        self.difference += error.element_sum();
        self.radiance += mean.element_sum();
        self.lengths.push(error.length());
    }

    fn figures(mut self) -> Figures {
        self.lengths.sort_by(f64::total_cmp);
        let pixels = self.lengths.len();
        assert!(pixels > 0, "no pixel shows the scene");
        let mean = self.radiance / (pixels as f64 * 3f64.sqrt());
        Figures {
            pixels,
            rms: ((self.squares - self.noise).max(0.0) / self.power).sqrt(),
            bias: self.difference / self.radiance,
            p99: self.lengths[(pixels * 99 / 100).min(pixels - 1)] / mean,
            noise: (self.noise / self.power).sqrt(),
        }
    }
}
