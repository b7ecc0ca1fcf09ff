//! Which layout a picture has: by its attribute, its shape, what is left empty, and its name.

use crate::error::Fault;
use crate::picture::Picture;
use crate::{Layout, Probe};
use std::path::Path;

/// Words in file names that tell a layout where the shape does not.
const WORDS: [(&str, Layout); 8] = [
    ("latlong", Layout::Equirect),
    ("lat_long", Layout::Equirect),
    ("equirect", Layout::Equirect),
    ("panorama", Layout::Equirect),
    ("angular", Layout::Angular),
    ("lightprobe", Layout::Angular),
    ("exrcube", Layout::ExrCube),
    ("faces", Layout::Faces),
];

/// Share of the light that may stand where a layout has no sphere: what lossy compression leaves there.
const STRAY_LIGHT: f64 = 1e-3;

/// Finds the layout of a picture; guesses are told as warnings.
pub(crate) fn layout(picture: &Picture, path: &Path, warnings: &mut Vec<String>) -> Result<Layout, Fault> {
    if let Some(layout) = picture.envmap {
        return Ok(layout);
    }
    let (width, height) = (picture.width, picture.height);
    let named = by_name(path);
    let is = |columns: usize, rows: usize| width * rows == height * columns;
    if is(2, 1) {
        return Ok(Layout::Equirect);
    }
    if is(1, 6) {
        if named == Some(Layout::ExrCube) {
            return Ok(Layout::ExrCube);
        }
        warnings.push(
            "a strip of six squares without an envmap attribute: read as faces px, nx, py, ny, pz, nz \
             (--layout exr-cube for OpenEXR's strip)"
                .to_owned(),
        );
        return Ok(Layout::Faces);
    }
    let candidate = [Layout::Angular, Layout::VerticalCross, Layout::HorizontalCross]
        .into_iter()
        .find(|layout| layout.tiles().is_some_and(|(c, r)| is(c, r)));
    match (candidate, named) {
        (_, Some(Layout::Equirect)) | (None, Some(Layout::Angular)) => named_shape(named, picture, warnings),
        (Some(layout), _) if is_empty_outside(picture, layout) => Ok(layout),
        (Some(layout), Some(name)) if layout == name => Ok(layout),
        (Some(layout), _) => Err(Fault::Unsupported(format!(
            "{width} x {height} pixels have the shape of layout {layout}, but there is light where that leaves \
             the picture empty; state it with --layout"
        ))),
        (None, _) => Err(Fault::Unsupported(format!(
            "{width} x {height} pixels have the shape of no known layout (2:1 equirect, 1:1 angular, 3:4 or 4:3 \
             cross, 1:6 faces); state it with --layout"
        ))),
    }
}

/// Takes the name's word where the shape is unusual.
fn named_shape(named: Option<Layout>, picture: &Picture, warnings: &mut Vec<String>) -> Result<Layout, Fault> {
    let layout = named.unwrap_or(Layout::Equirect);
    let (width, height) = (picture.width, picture.height);
    layout.check_size(width, height).map_err(Fault::Invalid)?;
    warnings.push(format!("{width} x {height} pixels are read as {layout} by the file's name"));
    Ok(layout)
}

/// The layout that the file's name suggests.
fn by_name(path: &Path) -> Option<Layout> {
    let stem = path.file_stem()?.to_string_lossy().to_lowercase();
    let word = WORDS.iter().find(|(word, _)| stem.contains(word));
    word.map(|(_, layout)| *layout)
}

/// Whether the corners of the disc or the tiles beside the cross are black.
fn is_empty_outside(picture: &Picture, layout: Layout) -> bool {
    let (mut inside, mut outside) = (0.0f64, 0.0f64);
    for (index, pixel) in picture.pixels.iter().enumerate() {
        let (x, y) = (index % picture.width, index / picture.width);
        let light: f64 = pixel.iter().map(|v| f64::from(*v)).sum();
        if Probe::covers(layout, picture.width, x, y) {
            inside += light;
        } else {
            outside += light;
        }
    }
    outside <= STRAY_LIGHT * inside
}
