//! `relume render`: a baked file under a light probe becomes a picture.

use crate::console::Console;
use crate::draw::{Backend, Drawer, Window};
use crate::enclosure;
use crate::gloss_look::{self, GlossOptions};
use crate::lens::{self, Lens};
use crate::look::{self, LookOptions};
use crate::output;
use crate::picture::{self, DisplayOptions, Size, Target};
use crate::source::{self, ProbeOptions};
use crate::visitor::VisitorOptions;
use anyhow::Result;
use glam::{EulerRot, Quat};
use render_cpu::Frame;
use std::borrow::Cow;
use std::num::NonZeroU32;
use std::path::PathBuf;
use std::time::{Duration, Instant};

pub(crate) const EXAMPLES: &str = "\
Examples:
  relume render atrium.prt --probe builtin:sky -o atrium.png
  relume render atrium.prt --probe kitchen.hdr --rotate 90,0,0 --tonemap filmic -o kitchen.png
  relume render atrium.prt --probe kitchen.hdr --camera 0,1.6,5,0,1,0,45 -o linear.exr
  relume render atrium.prt --probe kitchen.hdr --frames 36 -o turn.png
  relume render hall.prt --probe builtin:sky --visitor suzanne.prt --at 0,1,0,0.5 --to 4,1,0 --frames 24 -o walk.png
  relume render hall.prt --probe builtin:sky --basis hl2 -o hall-hl2.png
  relume render hall.prt --probe builtin:sky --basis modified-h6 --functions 1 --albedo off -o hall-flat.png
  relume render lobby.prt --probe kitchen.hdr --lobe phong --exponent 20 --way tpfl -o lobby.png

The fourth writes turn-0000.png to turn-0035.png, the light turned by 10 degrees each, and tells the time per \
frame. The fifth moves an object through the scene's irradiance volume. The next two draw light maps: in another \
basis than they were baked in, and one function of six as an ordinary light map, without the surfaces' colours. \
The last mirrors with one Phong lobe.";

#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// The baked file.
    #[arg(value_name = "F.prt")]
    file: PathBuf,
    #[command(flatten)]
    probe: ProbeOptions,
    /// The picture to write: .png for the display, .exr for linear radiance.
    #[arg(short, long, value_name = "FILE", value_parser = picture::target, help_heading = "Image")]
    output: Target,
    /// Columns and rows.
    #[arg(long, value_name = "WxH", default_value = "960x540", value_parser = picture::size, allow_hyphen_values = true, help_heading = "Image")]
    size: Size,
    /// Turns the light, in degrees: yaw about y (upwards), then pitch about the turned x, then roll about the turned z.
    #[arg(long, value_name = "YAW,PITCH,ROLL", default_value = "0,0,0", value_parser = rotation, allow_hyphen_values = true, help_heading = "Light probe")]
    rotate: Quat,
    /// The view: the name of a camera, or eye x,y,z, target x,y,z and vertical angle of view in degrees.
    #[arg(long, value_name = "NAME|EYE,TARGET,FOV", value_parser = lens::parse, allow_hyphen_values = true, help_heading = "Image")]
    camera: Option<Lens>,
    /// Who draws; auto takes the CPU where there is no GPU.
    #[arg(long, value_enum, default_value_t = Backend::Auto, help_heading = "Image")]
    backend: Backend,
    #[command(flatten, next_help_heading = "Exposure and tone")]
    display: DisplayOptions,
    /// Share of glow around bright places, 0 to 1.
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, help_heading = "Image")]
    bloom: f32,
    /// Samples along each side of a pixel, 1 to 8.
    #[arg(long, value_name = "N", default_value_t = 2, help_heading = "Image")]
    supersample: u32,
    /// What is done against ringing under a strong small light; see docs/shading.md.
    #[arg(long, value_enum, default_value_t = Window::Auto, help_heading = "Light probe")]
    window: Window,
    /// What is drawn behind the scene.
    #[arg(long, value_enum, default_value_t = Background::Sky, help_heading = "Image")]
    background: Background,
    #[command(flatten, next_help_heading = "Light maps")]
    look: LookOptions,
    #[command(flatten, next_help_heading = "Gloss")]
    gloss: GlossOptions,
    #[command(flatten, next_help_heading = "Dynamic object")]
    visitor: VisitorOptions,
    /// Draws N pictures, the light turned by 360/N degrees from one to the next; with --to, a visitor on its way instead.
    #[arg(long, value_name = "N", help_heading = "Image")]
    frames: Option<NonZeroU32>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Background {
    /// The light probe.
    Sky,
    /// Nothing.
    Black,
}

impl Options {
    /// The same light from another side: nothing has to be baked for it.
    fn tell_next(&self, console: &Console) {
        let path = &self.output.path;
        let name = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().display().to_string();
        let turned = format!("{}-turned.{}", name(path.file_stem()), name(path.extension()));
        let (file, probe) = (self.file.display(), self.probe.name());
        console.next(&format!(
            "relume render {file} --probe {probe} --rotate 90,0,0 -o {}",
            path.with_file_name(turned).display()
        ));
    }

    /// Fails where a picture would replace what is read, or a file that is no picture.
    fn check_outputs(&self) -> Result<()> {
        let inputs = [vec![self.file.clone()], self.probe.files()].concat();
        match self.frames {
            None => output::check(&self.output.path, &inputs),
            Some(count) => (0..count.get()).try_for_each(|number| {
                let path = self.output.numbered(number).path;
                // The first tells for all whether the folder can be written.
                if number == 0 || path.exists() { output::check(&path, &inputs) } else { Ok(()) }
            }),
        }
    }
}

pub(crate) fn run(options: &Options, console: &Console) -> Result<()> {
    options.check_outputs()?;
    let scene = source::prt(&options.file)?;
    let visitor = options.visitor.load()?;
    if let Some(visitor) = &visitor {
        visitor.tell(&scene, console);
    }
    let prt = match &visitor {
        Some(visitor) => Cow::Owned(visitor.at(&scene, 0.0)?),
        None => Cow::Borrowed(&scene),
    };
    let frame = Frame {
        camera: lens::of_prt(options.camera.as_ref(), &prt)?,
        width: options.size.width,
        height: options.size.height,
        rotation: options.rotate,
        exposure_ev: options.display.exposure,
        tonemap: options.display.tonemap(),
        bloom: options.bloom,
        supersample: options.supersample,
        sky: options.background == Background::Sky,
        albedo: options.look.albedo(),
        basis: options.look.basis,
        functions: options.look.functions,
        gloss: options.gloss.view(),
    };
    // Of a turn the second frame, too, before anything is written.
    let count = options.frames.map_or(1, NonZeroU32::get);
    for frame in [frame.clone(), turned(&frame, 1, count)] {
        frame.check_for(&prt).map_err(|error| crate::usage::Usage(error.to_string()))?;
    }
    look::tell(&prt, &options.probe.name(), &options.look, console);
    look::tell_left_out(&prt, console);
    gloss_look::tell(&prt, &frame.gloss, console);
    let environment = options.probe.load(console)?;
    if let (Some(count), Some(visitor)) = (options.frames, visitor.as_ref().filter(|visitor| visitor.moves())) {
        drop(prt);
        let draw = |share: f32| -> Result<_> {
            let prt = visitor.at(&scene, share)?;
            Drawer::open(options.backend, &prt, &environment, options.window, console)?.draw(&frame, console)
        };
        return draw_way(options, count.get(), &draw, console);
    }
    let mut drawer = Drawer::open(options.backend, &prt, &environment, options.window, console)?;
    match options.frames {
        Some(count) => draw_turn(options, &frame, count.get(), &mut drawer, console),
        None => draw_one(options, &frame, &mut drawer, console),
    }
}

fn draw_one(options: &Options, frame: &Frame, drawer: &mut Drawer<'_>, console: &Console) -> Result<()> {
    let began = Instant::now();
    let image = drawer.draw(frame, console)?;
    console.detail(&format!("drew in {:.1} ms", milliseconds(began.elapsed())));
    options.output.write(options.size, &image.linear, &image.display)?;
    enclosure::tell_of_picture(&image.linear, console);
    console.notice(&format!("wrote {}", options.output.path.display()));
    options.tell_next(console);
    Ok(())
}

/// Draws frame after frame under a light that makes one full turn.
fn draw_turn(options: &Options, frame: &Frame, count: u32, drawer: &mut Drawer<'_>, console: &Console) -> Result<()> {
    let mut times = Vec::with_capacity(count.min(100_000) as usize);
    for number in 0..count {
        let frame = turned(frame, number, count);
        let on_gpu = drawer.time(&frame)?;
        let began = Instant::now();
        let image = drawer.draw(&frame, console)?;
        times.push(milliseconds(on_gpu.unwrap_or_else(|| began.elapsed())));
        options.output.numbered(number).write(options.size, &image.linear, &image.display)?;
    }
    // The first frame also builds what the others use again.
    let first = times[0];
    times.sort_by(f64::total_cmp);
    let (least, median, most) = (times[0], times[times.len() / 2], times[times.len() - 1]);
    console.print(&format!(
        "{count} frames: median {median:.2} ms, least {least:.2}, most {most:.2}, the first {first:.2}"
    ))
}

/// Draws frame after frame of an object on its way, from its first place to its last.
fn draw_way(
    options: &Options,
    count: u32,
    draw: &dyn Fn(f32) -> Result<render_cpu::Image>,
    console: &Console,
) -> Result<()> {
    let progress = console.progress();
    progress.expect(&[("frames", 1.0)]);
    for number in 0..count {
        let image = draw((number + u32::from(count == 1)) as f32 / (count - 1).max(1) as f32)?;
        options.output.numbered(number).write(options.size, &image.linear, &image.display)?;
        progress.set("frames", u64::from(number) + 1, u64::from(count));
    }
    drop(progress);
    console.notice(&format!("wrote {count} pictures"));
    Ok(())
}

/// Frame `number` of the `count` of a full turn.
fn turned(frame: &Frame, number: u32, count: u32) -> Frame {
    let turn = Quat::from_rotation_y(std::f32::consts::TAU * (number % count) as f32 / count as f32);
    Frame { rotation: turn * frame.rotation, ..frame.clone() }
}

fn milliseconds(took: Duration) -> f64 {
    took.as_secs_f64() * 1e3
}

/// Parses `YAW,PITCH,ROLL` in degrees into the rotation from light to world.
pub(crate) fn rotation(text: &str) -> Result<Quat, String> {
    let angles: Option<Vec<f32>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    match angles.as_deref() {
        Some(&[yaw, pitch, roll]) if [yaw, pitch, roll].iter().all(|v| v.is_finite()) => {
            Ok(Quat::from_euler(EulerRot::YXZ, yaw.to_radians(), pitch.to_radians(), roll.to_radians()))
        }
        _ => Err("give three angles in degrees, such as 90,0,0".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// A quarter turn of yaw brings the light from ahead (+z) to +x, as seen from above counter-clockwise.
    #[test]
    fn rotations_turn_the_way_that_the_help_says() {
        let turned = |text: &str, from: Vec3| rotation(text).unwrap() * from;
        assert!(turned("90,0,0", Vec3::Z).distance(Vec3::X) < 1e-6);
        assert!(turned("0,90,0", Vec3::Y).distance(Vec3::Z) < 1e-6);
        assert!(turned("0,0,90", Vec3::X).distance(Vec3::Y) < 1e-6);
        // Intrinsic turns: after the yaw the pitch is about -z of the world, after both the roll about -y.
        assert!(turned("90,90,0", Vec3::Y).distance(Vec3::X) < 1e-6);
        assert!(turned("0,90,90", Vec3::X).distance(Vec3::Z) < 1e-6);
        assert!(rotation("1,2").is_err() && rotation("a,b,c").is_err() && rotation("0,0,inf").is_err());
    }
}
