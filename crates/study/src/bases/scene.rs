//! The bases of irradiance normal mapping on one scene under one light: error, bytes and time of each, and which one to take.
//!
//! The truth is one bake of 5 bands over normals ([`bake::directional`]); every basis gets its coefficients from it, so that noise of the
//! bake falls on all alike. What is beyond 5 bands is in no number here.

mod choice;
mod drawn;
mod normals;
mod plot;
mod residual;
mod sheet;
mod write;

pub use choice::{Choice, Goal};
pub use normals::{PICKED, normals};

use super::timing;
use bake::{Directional, SheetSettings};
use coeff_io::Encoding;
use drawn::Views;
use residual::Residual;
use scene::Scene;
use sh_math::hemisphere::Basis;
use sheet::Plate;
use std::f64::consts::TAU;

/// Encodings that are compared.
const ENCODINGS: [Encoding; 4] = [Encoding::F32, Encoding::F16, Encoding::U8, Encoding::Bc6h];

/// What is to be compared.
#[derive(Debug, Clone, Copy)]
pub struct Request<'a> {
    /// The scene, with the light-map coordinates that the sheets were baked by.
    pub scene: &'a Scene,
    /// The name of the light.
    pub light: &'a str,
    /// The options of `relume bake` that make the sheets and, where it is windowed, the light.
    pub sheet_options: &'a str,
    /// The sheets that were baked.
    pub sheets: &'a [SheetSettings],
    /// What arrives at their texels.
    pub found: &'a Directional,
    /// What is wanted.
    pub goal: Goal,
    /// Nanoseconds of one evaluation of each of [`Basis::ALL`]: [`nanoseconds`].
    pub nanoseconds: &'a [f64],
}

/// The bases compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// The scene as the user named it.
    pub scene: String,
    /// The light as the user named it.
    pub light: String,
    /// The options of `relume bake` that make the sheets and, where it is windowed, the light.
    pub sheet_options: String,
    /// Texels that see something.
    pub texels: usize,
    /// Texels of all sheets, covered or not: what bytes are reckoned for.
    pub sheet_texels: u64,
    /// Whether a normal map is in use; where none is, an ordinary light map serves.
    pub has_normal_maps: bool,
    /// Mean of irradiance / pi over the hemisphere, texels and channels.
    pub mean: f64,
    /// Mean of irradiance / pi at the normals that are drawn.
    pub drawn_mean: f64,
    /// Share of the irradiance that is drawn that lies below 0, which no light does: ringing of a light in few bands. Eight bits make it 0.
    pub negative: f64,
    /// One per basis, in the order of [`Basis::ALL`].
    pub rows: Vec<Row>,
    /// What to take.
    pub choice: Choice,
}

/// One basis.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// The functions.
    pub basis: Basis,
    /// Integrated mean square error of irradiance / pi over the hemisphere (eq. 3.1 of \[N\]), solid angle; mean over texels and channels.
    /// Texels of sheets with normal maps where there are any, else all.
    pub imse: f64,
    /// Root of the mean square over the hemisphere against [`Comparison::mean`].
    pub relative: f64,
    /// The texel with the largest error.
    pub worst: Worst,
    /// The same coefficients in each encoding.
    pub stored: Vec<Stored>,
    /// Nanoseconds of one evaluation: functions at a normal times coefficients of three channels, f32, one thread.
    pub nanoseconds: f64,
}

/// A texel with a large error.
#[derive(Debug, Clone, PartialEq)]
pub struct Worst {
    /// Index of the sheet.
    pub sheet: u32,
    /// Row and column.
    pub place: [u32; 2],
    /// World space, metres.
    pub position: [f32; 3],
    /// The mesh that it lies on.
    pub mesh: String,
    /// Root of the mean square over the hemisphere and channels, against [`Comparison::mean`].
    pub relative: f64,
}

/// A basis in an encoding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stored {
    /// How the coefficients are held.
    pub encoding: Encoding,
    /// Bytes of all sheets; those without normal maps hold an ordinary light map.
    pub bytes: u64,
    /// The error at the normals that are drawn, what the encoding loses included.
    pub drawn: Drawn,
}

/// An error at the normals that normal maps hold, against [`Comparison::drawn_mean`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drawn {
    /// Root of the mean square over texels, normals and channels.
    pub rms: f64,
    /// 99 of 100 errors are no larger, but for the 0.2 % that they are told apart by.
    pub p99: f64,
}

/// No texel sees anything, so that there is nothing to compare.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "no texel of the light maps sees anything: use --unwrap or more --texels, and see `relume uv` for light-map coordinates that do not serve"
)]
pub struct Empty;

/// Measures [`Request::nanoseconds`] (about a second, on the calling thread).
#[must_use]
pub fn nanoseconds() -> Vec<f64> {
    timing::nanoseconds()
}

/// Compares the bases on what arrives at the texels of a scene, and chooses.
///
/// # Errors
/// [`Empty`] where no texel sees anything.
///
/// # Panics
/// When texels lie outside of the sheets, or times are missing.
pub fn compare(request: &Request<'_>) -> Result<Comparison, Empty> {
    let Request { scene, sheets, found, .. } = *request;
    if found.texels.is_empty() {
        return Err(Empty);
    }
    let plates: Vec<Plate> = (0..).zip(sheets).map(|(index, sheet)| Plate::new(scene, index, sheet, found)).collect();
    let bent = sheets.iter().filter(|sheet| sheet.directional).flat_map(|sheet| sheet.meshes.iter().copied());
    let picked = normals(scene, bent);
    let views = Views::new(&plates, found, &picked);
    let judged = judged(sheets, found);
    let mean = residual::mean(judged.iter().map(|&index| &found.texels[index].coefficients));
    let row = |(basis, nanoseconds): (Basis, f64)| {
        let (imse, worst) = over_hemisphere(basis, &judged, found);
        Row {
            basis,
            imse,
            relative: against((imse / TAU).sqrt(), mean),
            worst: worst_texel(scene, &plates, found, worst, mean),
            stored: stored(basis, &plates, &views, found),
            nanoseconds,
        }
    };
    assert_eq!(request.nanoseconds.len(), Basis::ALL.len(), "a time for every basis");
    let rows: Vec<Row> = Basis::ALL.into_iter().zip(request.nanoseconds.iter().copied()).map(row).collect();
    let has_normal_maps = !picked.is_empty();
    Ok(Comparison {
        scene: scene.name.clone(),
        light: request.light.to_owned(),
        sheet_options: request.sheet_options.to_owned(),
        texels: found.texels.len(),
        sheet_texels: sheets.iter().map(|sheet| u64::from(sheet.width) * u64::from(sheet.height)).sum(),
        has_normal_maps,
        mean,
        drawn_mean: views.mean,
        negative: views.negative,
        choice: choice::choose(&rows, has_normal_maps, request.goal),
        rows,
    })
}

/// Indices of the texels that are judged over the hemisphere: those whose light is kept for every normal, else all.
fn judged(sheets: &[SheetSettings], found: &Directional) -> Vec<usize> {
    let bent = |index: &usize| sheets[found.texels[*index].sheet as usize].directional;
    let some: Vec<usize> = (0..found.texels.len()).filter(bent).collect();
    if some.is_empty() { (0..found.texels.len()).collect() } else { some }
}

/// Mean error over the hemisphere of texels and channels, and the texel with the largest with its own.
fn over_hemisphere(basis: Basis, judged: &[usize], found: &Directional) -> (f64, (usize, f64)) {
    let residual = Residual::new(basis);
    let (mut sum, mut worst) = (0.0, (judged[0], 0.0));
    for &index in judged {
        let error = residual.imse(&found.texels[index].coefficients);
        sum += error;
        worst = if error > worst.1 { (index, error) } else { worst };
    }
    (sum / judged.len() as f64, worst)
}

fn worst_texel(scene: &Scene, plates: &[Plate], found: &Directional, (index, imse): (usize, f64), mean: f64) -> Worst {
    let texel = &found.texels[index];
    let (mesh, position) = plates[texel.sheet as usize].point(scene, texel.place);
    Worst { sheet: texel.sheet, place: texel.place, position, mesh, relative: against((imse / TAU).sqrt(), mean) }
}

/// A basis in every encoding.
fn stored(basis: Basis, plates: &[Plate], views: &Views<'_>, found: &Directional) -> Vec<Stored> {
    let exact: Vec<Vec<f32>> = plates.iter().map(|plate| plate.values(plate.held(basis), found)).collect();
    let in_encoding = |encoding| {
        let layers: Vec<_> = plates
            .iter()
            .zip(&exact)
            .map(|(plate, values)| plate.encoded(plate.held(basis), values, encoding))
            .collect();
        let decoded: Vec<Vec<f32>> = layers.iter().map(coeff_io::Layers::decode).collect();
        let bytes = layers.iter().map(|layers| layers.bytes.len() as u64).sum();
        Stored { encoding, bytes, drawn: views.error(basis, plates, &decoded) }
    };
    ENCODINGS.into_iter().map(in_encoding).collect()
}

/// An error against a mean; 0 where nothing differs.
fn against(error: f64, mean: f64) -> f64 {
    if error == 0.0 { 0.0 } else { error / mean.abs() }
}
