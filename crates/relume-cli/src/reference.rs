//! `relume reference`: the ground truth, by path tracing.

use crate::console::Console;
use crate::draw::Window;
use crate::lens::{self, Lens};
use crate::picture::{self, DisplayOptions, Size, Target};
use crate::source::{self, ProbeOptions, SceneOptions};
use crate::usage::Usage;
use crate::{output, settings};
use anyhow::{Context, Result, ensure};
use coeff_io::Bounces;
use glam::Vec3;
use probe_io::Environment;
use reference::{Gloss, Light, Lobe, Mirroring, Picture, Settings, World};
use sh_math::{Bands, lobe};
use std::ops::ControlFlow;

pub(crate) const EXAMPLES: &str = "\
Examples:
  relume reference builtin:cornell-box --probe builtin:sky -o truth.exr
  relume reference house.glb --probe kitchen.hdr --spp 1024 --size 480x270 -o truth.exr
  relume reference house.glb --probe kitchen.hdr --light bands:5 -o what-a-bake-should-give.exr
  relume reference house.glb --probe sun.hdr --light bands:5 --window none -o what-render-window-none-should-give.exr
  relume reference builtin:cornell-box --probe builtin:sky --specular off -o diffuse-alone.exr
  relume reference lobby.glb --probe kitchen.hdr --specular phong --exponent 20 -o what-render-lobe-phong-should-give.exr
  relume reference lobby.glb --probe kitchen.hdr --specular microfacet -o true-ggx.exr

`--light bands:N` lights the scene with what N bands hold of the probe: a bake of N bands should give the same \
picture, but for noise and for what lies between vertices. Surfaces that shine mirror as `render` draws them, \
with a lobe about the mirror direction that no bands cut off; normal maps bend the mirror's normal always, that \
of diffuse light with `--normal-maps`. What is not metal nor smoother than 0.6 anywhere does not shine: a matte \
scene has the same picture whatever `--specular` says.";

/// Columns of the picture that stands for band-limited light: 16 bands change little over one of its pixels.
const LIGHT_WIDTH: usize = 512;

#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    #[command(flatten)]
    scene: SceneOptions,
    #[command(flatten)]
    probe: ProbeOptions,
    /// The picture to write: .exr for linear radiance, .png for the display.
    #[arg(short, long, value_name = "FILE", value_parser = picture::target, help_heading = "Image")]
    output: Target,
    /// Paths per pixel.
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..), help_heading = "Image")]
    spp: u32,
    /// The light: full, or what N bands hold of it.
    #[arg(long, value_name = "full|bands:N", default_value = "full", value_parser = light, help_heading = "Light probe")]
    light: Truth,
    /// What is done against ringing of the light of few bands, as `render` does it; auto where not given.
    #[arg(long, value_enum, help_heading = "Light probe")]
    window: Option<Window>,
    /// What surfaces that shine mirror, besides their diffuse part.
    #[arg(long, value_enum, default_value_t = Specular::Ggx, help_heading = "Surfaces")]
    specular: Specular,
    /// One perceptual roughness for all that shines, 0 to 1.
    #[arg(long, value_name = "R", conflicts_with = "exponent", value_parser = roughness, help_heading = "Surfaces")]
    roughness: Option<f32>,
    /// The same as an exponent of Phong, 0 to 100000.
    #[arg(long, value_name = "S", value_parser = exponent, help_heading = "Surfaces")]
    exponent: Option<f32>,
    /// Lets normal maps bend the normals that diffuse light is taken by, as light maps do.
    #[arg(long, help_heading = "Surfaces")]
    normal_maps: bool,
    /// How often light may bounce: a number, or auto for until paths end by themselves.
    #[arg(long, value_name = "N|auto", default_value = "auto", value_parser = settings::bounces, help_heading = "Image")]
    bounces: Bounces,
    /// Columns and rows.
    #[arg(long, value_name = "WxH", default_value = "960x540", value_parser = picture::size, allow_hyphen_values = true, help_heading = "Image")]
    size: Size,
    /// The view: the name of a camera, or eye x,y,z, target x,y,z and vertical angle of view in degrees.
    #[arg(long, value_name = "NAME|EYE,TARGET,FOV", value_parser = lens::parse, allow_hyphen_values = true, help_heading = "Image")]
    camera: Option<Lens>,
    /// Seed of everything random.
    #[arg(long, value_name = "S", default_value_t = 0, help_heading = "Image")]
    seed: u64,
    #[command(flatten, next_help_heading = "Exposure and tone")]
    display: DisplayOptions,
}

/// Which light the truth is about.
#[derive(Debug, Clone, Copy)]
enum Truth {
    Full,
    Bands(Bands),
}

/// The model of surfaces that shine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Specular {
    /// Nothing: diffuse light alone.
    Off,
    /// A lobe of Phong about the mirror direction, as wide as GGX.
    Phong,
    /// The lobe of GGX seen head-on about the mirror direction, as `render` draws it.
    Ggx,
    /// The microfacets of GGX themselves, which `render` comes near to.
    Microfacet,
}

impl Options {
    /// How surfaces mirror; none where they do not.
    fn gloss(&self) -> Result<Option<Gloss>> {
        let mirroring = match self.specular {
            Specular::Off if self.roughness.is_some() || self.exponent.is_some() => {
                return Err(
                    Usage("--roughness and --exponent are for what shines, and --specular is off".into()).into()
                );
            }
            Specular::Off => return Ok(None),
            Specular::Phong => Mirroring::Lobe(Lobe::Phong),
            Specular::Ggx => Mirroring::Lobe(Lobe::Ggx),
            Specular::Microfacet => Mirroring::Microfacet,
        };
        let of_exponent = self.exponent.map(|s| lobe::roughness_of_exponent(f64::from(s)) as f32);
        Ok(Some(Gloss { roughness: self.roughness.or(of_exponent), ..Gloss::new(mirroring) }))
    }
}

pub(crate) fn roughness(text: &str) -> Result<f32, String> {
    text.parse().ok().filter(|value| (0.0..=1.0).contains(value)).ok_or("give a roughness from 0 to 1".into())
}

fn exponent(text: &str) -> Result<f32, String> {
    text.parse().ok().filter(|value| (0.0..=1e5).contains(value)).ok_or("give an exponent from 0 to 100000".into())
}

fn light(text: &str) -> Result<Truth, String> {
    match text.split_once(':') {
        None if text == "full" => Ok(Truth::Full),
        Some(("bands", count)) => source::bands(count).map(Truth::Bands),
        _ => Err("give full or bands:N".into()),
    }
}

pub(crate) fn run(options: &Options, console: &Console) -> Result<()> {
    let gloss = options.gloss()?;
    output::check(&options.output.path, &[options.scene.files(), options.probe.files()].concat())?;
    let scene = options.scene.load(console)?;
    output::check(&options.output.path, &scene.files)?;
    let camera = lens::of_scene(options.camera.as_ref(), &scene)?;
    let environment = options.probe.load(console)?;
    let light = match options.light {
        Truth::Full if options.window.is_some() => {
            return Err(Usage("--window is for the light of few bands: give --light bands:N too".into()).into());
        }
        Truth::Full => Light::new(&environment),
        Truth::Bands(bands) => band_limited(bands, options.window.unwrap_or(Window::Auto), &environment)?,
    };
    let max_bounces = match options.bounces {
        Bounces::Auto => None,
        Bounces::Fixed(count) => Some(count),
    };
    let settings = Settings { samples: options.spp, seed: options.seed, max_bounces };
    let plain = World::with_normal_maps(&scene, options.normal_maps);
    let world = gloss.into_iter().fold(plain, World::with_gloss);
    let picture = {
        let progress = console.progress();
        let rows = options.size.height;
        progress.expect(&[("rows", 1.0)]);
        progress.set("rows", 0, u64::from(rows));
        reference::render(&world, &light, &camera, [options.size.width, rows], &settings, &|share| {
            progress.set("rows", (share * rows as f32).round() as u64, u64::from(rows));
            // Ctrl-C ends the program as a whole.
            ControlFlow::Continue(())
        })
    };
    let mut picture = picture.context("the reference was cancelled; no file was written")?;
    let noise = noise(&picture);
    crate::enclosure::tell_of_picture(&picture.pixels, console);
    options.display.expose(&mut picture.pixels);
    options.output.write(options.size, &picture.pixels, &options.display.display(&picture.pixels))?;
    console.notice(&format!(
        "wrote {}; noise {:.2}% of the mean radiance",
        options.output.path.display(),
        100.0 * noise
    ));
    console.next(&options.scene.bake_command());
    Ok(())
}

/// The light that `bands` bands hold; without a window it may be negative in places. The view behind the scene stays as it is.
fn band_limited(bands: Bands, window: Window, environment: &Environment) -> Result<Light> {
    let coefficients = window.apply(&sh_math::project(bands, environment.samples()));
    let (width, height) = (LIGHT_WIDTH, LIGHT_WIDTH / 2);
    let pixel = |i: usize| {
        let phi = std::f64::consts::TAU * (((i % width) as f64 + 0.5) / width as f64 - 0.5);
        let theta = std::f64::consts::PI * ((i / width) as f64 + 0.5) / height as f64;
        let direction = [-phi.sin() * theta.sin(), theta.cos(), phi.cos() * theta.sin()];
        coefficients.reconstruct(Vec3::from(direction.map(|v| v as f32)))
    };
    let pixels: Vec<[f32; 3]> = (0..width * height).map(pixel).collect();
    ensure!(pixels.as_flattened().iter().all(|v| v.is_finite()), "the light is too bright for {} bands", bands.count());
    let light = Light::from_equirect(width, pixels).context("the light of few bands is no light")?;
    Ok(light.with_sky(environment))
}

/// Mean standard error over mean radiance.
fn noise(picture: &Picture) -> f64 {
    let sum = |pixels: &[[f32; 3]]| pixels.as_flattened().iter().map(|v| f64::from(*v)).sum::<f64>();
    let radiance = sum(&picture.pixels);
    if radiance > 0.0 { sum(&picture.std_error) / radiance } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use reference::directional_albedo;
    use sh_math::brdf;

    /// The polynomials of the renderers against the integral that the reference sums up by itself.
    #[test]
    fn renderers_mirror_as_much_as_the_reference() {
        let apart = |scale: f32| {
            let mut most = 0.0f32;
            for k in 0..400 {
                let (roughness, cosine) = (0.05 + 0.05 * (k % 20) as f32, 0.05 + 0.05 * (k / 20) as f32);
                let [a, b] = brdf::environment_brdf((roughness * scale).min(1.0), cosine.min(1.0));
                for f0 in [0.04, 0.5, 1.0] {
                    let truth = directional_albedo(Vec3::splat(f0), roughness.min(1.0), cosine.min(1.0)).x;
                    most = most.max((f0 * a + b - truth).abs());
                }
            }
            most
        };
        // At a cosine of 0.05 the fit is worst; from 0.1 on it is within 0.006.
        assert!(apart(1.0) < 0.02, "{}", apart(1.0));
        assert!(apart(0.9) > 0.02, "another roughness must show: {}", apart(0.9));
    }

    #[test]
    fn roughness_and_exponents_have_their_ranges() {
        assert_eq!((roughness("0.3"), exponent("20")), (Ok(0.3), Ok(20.0)));
        assert!(["-0.1", "1.1", "nan", "x"].iter().all(|text| roughness(text).is_err()));
        assert!(["-1", "1e6", "nan", "x"].iter().all(|text| exponent(text).is_err()));
    }
}
