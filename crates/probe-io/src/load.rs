//! Light probes from files and folders, checked for what radiance may be.

use crate::error::{Error, Fault};
use crate::nonfinite::{self, NonFinite};
use crate::picture::{self, Picture};
use crate::{Environment, Layout, Probe, detect};
use std::path::{Path, PathBuf};

/// What to do with pixels of negative radiance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Negatives {
    /// The file is refused.
    Refuse,
    /// Their negative channels become 0, with a warning that counts them.
    Clamp,
}

/// How to read a light probe.
#[derive(Debug, Clone)]
pub struct LoadOptions {
    /// Overrides the layout that the file and its shape suggest.
    pub layout: Option<Layout>,
    /// What to do with negative radiance.
    pub negatives: Negatives,
    /// What to do with pixels that are infinite or not a number.
    pub non_finite: NonFinite,
    /// Name of the part or layer of an OpenEXR file; the one that is most likely the picture where nothing is said.
    pub layer: Option<String>,
}

impl LoadOptions {
    /// Layout and layer as detected; what is no radiance is refused.
    pub fn strict() -> LoadOptions {
        LoadOptions { layout: None, negatives: Negatives::Refuse, non_finite: NonFinite::Refuse, layer: None }
    }

    /// Layout and layer as detected; negative radiance becomes 0 with a warning, what is not finite is refused.
    pub fn lenient() -> LoadOptions {
        LoadOptions { negatives: Negatives::Clamp, ..LoadOptions::strict() }
    }
}

impl Environment {
    /// Reads a `.hdr` or `.exr` probe, or a folder of six faces (px, nx, py, ny, pz, nz); the strings are warnings.
    ///
    /// # Errors
    /// Where a file cannot be read or is damaged, its layout cannot be told, or a pixel is negative (unless
    /// clamped), or infinite or not a number (unless clamped).
    pub fn load(path: &Path, options: &LoadOptions) -> Result<(Environment, Vec<String>), Error> {
        let mut warnings = Vec::new();
        let probe = if path.is_dir() {
            load_folder(path, options, &mut warnings)?
        } else {
            load_file(path, options, &mut warnings)?
        };
        let name = path.display().to_string();
        Ok((Environment::from_image(&name, probe), warnings))
    }
}

/// Reads one picture and finds its layout.
fn load_file(path: &Path, options: &LoadOptions, warnings: &mut Vec<String>) -> Result<Probe, Error> {
    let picture = open(path, options, warnings)?;
    let layout = match options.layout {
        Some(layout) => layout,
        None => detect::layout(&picture, path, warnings).map_err(|fault| fault.at(path))?,
    };
    let (width, height) = (picture.width, picture.height);
    let size = layout.check_size(width, height);
    size.map_err(|what| Fault::Invalid(what).at(path))?;
    if picture.envmap.is_some_and(|stated| stated != layout) {
        warnings.push(format!("read as {layout} against the file's envmap attribute"));
    }
    Ok(Probe { layout, width, height, pixels: picture.pixels })
}

/// Names that the files of a face may have, without their endings, in the order of [`Layout::Faces`].
const FACE_NAMES: [[&str; 4]; 6] = [
    ["px", "posx", "positive_x", "right"],
    ["nx", "negx", "negative_x", "left"],
    ["py", "posy", "positive_y", "top"],
    ["ny", "negy", "negative_y", "bottom"],
    ["pz", "posz", "positive_z", "front"],
    ["nz", "negz", "negative_z", "back"],
];

/// Reads six square faces of one size from a folder.
fn load_folder(folder: &Path, options: &LoadOptions, warnings: &mut Vec<String>) -> Result<Probe, Error> {
    if options.layout.is_some_and(|layout| layout != Layout::Faces) {
        let what = "a folder holds six faces; leave --layout away or choose faces";
        return Err(Fault::Unsupported(what.to_owned()).at(folder));
    }
    let mut side = None;
    let mut pixels = Vec::new();
    let mut told = Vec::new();
    for names in FACE_NAMES {
        let path = find_face(folder, names)?;
        let face = open(&path, options, &mut told)?;
        let wanted = *side.get_or_insert(face.width);
        if face.width != wanted || face.height != wanted {
            let what = format!(
                "the face is {} x {} pixels, not {wanted} x {wanted} as the first one",
                face.width, face.height
            );
            return Err(Fault::Invalid(what).at(&path));
        }
        pixels.extend(face.pixels);
    }
    // What all six say alike is said once.
    for warning in told {
        if !warnings.contains(&warning) {
            warnings.push(warning);
        }
    }
    let width = side.unwrap_or(0);
    Ok(Probe { layout: Layout::Faces, width, height: 6 * width, pixels })
}

/// The file of one face.
fn find_face(folder: &Path, names: [&str; 4]) -> Result<PathBuf, Error> {
    for name in names {
        for ending in ["hdr", "exr"] {
            let path = folder.join(format!("{name}.{ending}"));
            if path.is_file() {
                return Ok(path);
            }
        }
    }
    let what = format!("no face {0}.hdr or {0}.exr in this folder", names[0]);
    Err(Fault::Invalid(what).at(folder))
}

/// Reads a picture as linear Rec. 709, checked for what radiance may be.
fn open(path: &Path, options: &LoadOptions, warnings: &mut Vec<String>) -> Result<Picture, Error> {
    let mut picture = picture::open(path, options.layer.as_deref())?;
    warnings.append(&mut picture.warnings);
    let settled = nonfinite::settle(&mut picture, options.non_finite).map_err(|fault| fault.at(path))?;
    warnings.extend(settled.map(|told| format!("{}: {told}", path.display())));
    picture.space.undo_chroma(&mut picture.pixels);
    check_radiance(path, &mut picture, options.negatives, warnings)?;
    warnings.extend(picture.space.convert(&mut picture.pixels));
    clip_colors(&mut picture, warnings);
    Ok(picture)
}

/// Share of a pixel's brightest channel below which a negative one is rounding of half floats.
const ROUNDING: f32 = 5e-3;

/// Sets channels to 0 that colours outside Rec. 709 would need to be negative.
fn clip_colors(picture: &mut Picture, warnings: &mut Vec<String>) {
    let mut count = 0;
    for pixel in picture.pixels.iter_mut().filter(|pixel| pixel.iter().any(|v| *v < 0.0)) {
        let brightest = pixel.iter().fold(0.0f32, |a, b| a.max(*b));
        count += usize::from(pixel.iter().any(|v| *v < -ROUNDING * brightest));
        *pixel = pixel.map(|v| v.max(0.0));
    }
    if count > 0 {
        warnings.push(format!("{count} pixels have colours outside Rec. 709; their negative channels were set to 0"));
    }
}

/// Refuses or clamps negative radiance.
fn check_radiance(
    path: &Path,
    picture: &mut Picture,
    negatives: Negatives,
    warnings: &mut Vec<String>,
) -> Result<(), Error> {
    let width = picture.width;
    let place = |index: usize| format!("pixel ({}, {})", index % width, index / width);
    let mut lowest = 0.0f32;
    let mut lowest_at = 0;
    let mut count = 0;
    for (index, pixel) in picture.pixels.iter().enumerate() {
        let least = pixel.iter().fold(0.0f32, |a, b| a.min(*b));
        count += usize::from(least < 0.0);
        if least < lowest {
            (lowest, lowest_at) = (least, index);
        }
    }
    if count == 0 {
        return Ok(());
    }
    let found = format!("{count} pixels have negative radiance, the lowest {lowest} at {}", place(lowest_at));
    if negatives == Negatives::Refuse {
        let what = format!("{found}; clamp them to 0 by choice (--negatives clamp) or mend the file");
        return Err(Fault::Invalid(what).at(path));
    }
    for pixel in &mut picture.pixels {
        *pixel = pixel.map(|v| v.max(0.0));
    }
    warnings.push(format!("{}: {found}; set to 0", path.display()));
    Ok(())
}
