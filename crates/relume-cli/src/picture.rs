//! Pictures on the way out: their size, their file, their display form.

use anyhow::Result;
use relume::ImageFormat;
use render_cpu::Tonemap;
use std::path::PathBuf;

/// Most columns or rows.
const LARGEST_SIDE: u32 = 16_384;

/// Columns and rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Size {
    pub(crate) width: u32,
    pub(crate) height: u32,
}

/// Parses `WxH`.
pub(crate) fn size(text: &str) -> Result<Size, String> {
    let side = |text: &str| text.parse().ok().filter(|n| (1..=LARGEST_SIDE).contains(n));
    match text.split_once(['x', 'X', '×']).map(|(width, height)| (side(width), side(height))) {
        Some((Some(width), Some(height))) => Ok(Size { width, height }),
        _ => Err(format!("give width and height from 1 to {LARGEST_SIDE}, such as 960x540")),
    }
}

/// A picture file of a kind that can be written.
#[derive(Debug, Clone)]
pub(crate) struct Target {
    pub(crate) path: PathBuf,
    format: ImageFormat,
}

/// Parses a file name that ends in `.png` or `.exr`.
pub(crate) fn target(text: &str) -> Result<Target, String> {
    let path = PathBuf::from(text);
    match ImageFormat::from_path(&path) {
        Ok(format) => Ok(Target { path, format }),
        Err(_) => Err("give a file that ends in .png (for the display) or .exr (linear)".into()),
    }
}

impl Target {
    /// The same file with a number: `a.png` becomes `a-0007.png`.
    pub(crate) fn numbered(&self, number: u32) -> Self {
        let part = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
        let name = format!("{}-{number:04}.{}", part(self.path.file_stem()), part(self.path.extension()));
        Self { path: self.path.with_file_name(name), format: self.format }
    }

    /// Writes a picture given in both forms; the file is there whole or not at all.
    pub(crate) fn write(&self, size: Size, linear: &[[f32; 3]], display: &[[u8; 4]]) -> Result<()> {
        relume::write_image(&self.path, self.format, [size.width, size.height], linear, display)
            .map_err(crate::usage::fault)
    }
}

/// How radiance becomes display values.
#[derive(Debug, clap::Args)]
pub(crate) struct DisplayOptions {
    /// Exposure in stops.
    #[arg(long, value_name = "EV", default_value_t = 0.0, allow_negative_numbers = true, value_parser = stops)]
    pub(crate) exposure: f32,
    /// Tone curve of .png files.
    #[arg(long, value_enum, default_value_t = Curve::None)]
    tonemap: Curve,
}

/// The tone curves by the names that are typed.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum Curve {
    /// Cut at 1.
    #[value(alias = "off")]
    None,
    /// x / (1 + x).
    Reinhard,
    /// With toe and shoulder.
    Filmic,
}

impl DisplayOptions {
    pub(crate) fn tonemap(&self) -> Tonemap {
        match self.tonemap {
            Curve::None => Tonemap::None,
            Curve::Reinhard => Tonemap::Reinhard,
            Curve::Filmic => Tonemap::Filmic,
        }
    }

    /// Exposes linear radiance in place.
    pub(crate) fn expose(&self, linear: &mut [[f32; 3]]) {
        let factor = self.exposure.exp2();
        linear.as_flattened_mut().iter_mut().for_each(|v| *v *= factor);
    }

    /// Display values of exposed linear radiance, as the renderers have them.
    pub(crate) fn display(&self, linear: &[[f32; 3]]) -> Vec<[u8; 4]> {
        let byte = |v: f32| {
            let value = render_cpu::srgb_encode(f64::from(render_cpu::curve(self.tonemap(), v)));
            (255.0 * value + 0.5) as u8
        };
        linear.iter().map(|&[r, g, b]| [byte(r), byte(g), byte(b), 255]).collect()
    }
}

/// Parses an exposure in stops, -64 to 64.
fn stops(text: &str) -> Result<f32, String> {
    let stops: f32 = text.parse().map_err(|_| "give a number of stops, such as 1.5".to_owned())?;
    if stops.abs() <= 64.0 { Ok(stops) } else { Err("give -64 to 64 stops".into()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn words_become_sizes_and_files() {
        assert_eq!(size("960x540"), Ok(Size { width: 960, height: 540 }));
        for wrong in ["960", "0x5", "5x", "x", "16385x1", "-1x1", "1x1x1"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
        assert!(target("a.jpg").is_err() && target("a").is_err());
        assert_eq!(target("b/a.EXR").unwrap().numbered(7).path, Path::new("b/a-0007.EXR"));
    }
}
