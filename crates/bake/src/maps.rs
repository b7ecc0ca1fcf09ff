//! Directional light maps: what arrives at the texels of sheets, kept for every normal of a normal map (\[N\] chapter 2).
//!
//! A texel is a receiver like a vertex: the same rays, the same rule for their number. What it sees is kept over world normals until
//! seams are stitched, then turned into the tangent frame and converted to the basis.

mod frame;
mod plate;
mod stitch;

use crate::arrival::{Arrivals, Shape, to_irradiance};
use crate::domain::Domain;
use crate::error::Error;
use crate::extras::Done;
use crate::gather::Worker;
use crate::progress::Stage;
use crate::receivers::{Receiver, morton_order};
use crate::repair::is_inside;
use coeff_io::{Coding, Encoding, Layers, MapLight, Maps, Prt, Sheet, curves};
use frame::{Converter, TangentFrame};
use glam::Vec2;
use plate::{NONE, Plate};
use rayon::prelude::*;
use scene::lightmap::{Charts, Texel, seams, texels};
use sh_math::Bands;
use sh_math::hemisphere::Basis;
use stitch::{Agreement, stitch};

/// Most texels along a side of a sheet.
const MAX_SIDE: u32 = 8192;
/// Most rings around charts.
const MAX_DILATION: u32 = 64;
/// Texels that a thread takes at a time.
const CHUNK: usize = 64;
/// Look-ups to a texel along a seam.
const PER_TEXEL: f32 = 2.0;

/// What maps are wanted.
#[derive(Debug, Clone, PartialEq)]
pub struct MapSettings {
    /// The functions over normals.
    pub basis: Basis,
    /// The sheets; a mesh lies in one at most, by its second texture coordinates.
    pub sheets: Vec<SheetSettings>,
    /// Whether the two sides of seams are made to agree.
    pub stitch: bool,
    /// Rings of texels that are filled around each chart, for filters and mip-maps.
    pub dilation: u32,
    /// How the file holds the numbers.
    pub encoding: Encoding,
}

/// What sheet is wanted.
#[derive(Debug, Clone, PartialEq)]
pub struct SheetSettings {
    /// Indices into the meshes of the scene.
    pub meshes: Vec<usize>,
    /// Texels along u.
    pub width: u32,
    /// Texels along v.
    pub height: u32,
    /// Whether its light is kept for every normal: where a normal map is. Elsewhere the first function is enough, in a basis whose first
    /// function alone is a light map.
    pub directional: bool,
}

/// What was found of one sheet.
struct Gathered {
    plate: Plate,
    /// Of each slot, where a surface is.
    frames: Vec<TangentFrame>,
}

/// Bands over normals that are kept until the conversion: three, as the paper has them, where they can be relit, and five where there is
/// room, since that is what a bent normal can tell of the cosine.
fn functions(done: &Done<'_>) -> Bands {
    Bands::new(if done.light.is_some() { 5 } else { 3 }).expect("few bands")
}

pub(crate) fn bake(done: &Done<'_>, settings: &MapSettings, prt: &mut Prt) -> Result<Maps, Error> {
    check(done, settings)?;
    let functions = functions(done);
    let bank = done.bank(Domain::Hemisphere, functions);
    let arrivals = done.arrivals(&bank, functions);
    let shape = arrivals.shape();
    let mut first_index = 0;
    let mut sheets = Vec::new();
    for sheet in &settings.sheets {
        sheets.push(gather(done, &arrivals, sheet, first_index, prt)?);
        first_index += sheet.width * sheet.height;
    }
    for gathered in &mut sheets {
        gathered.plate.mend();
        (0..settings.dilation.min(1)).for_each(|_| gathered.plate.dilate());
    }
    if settings.stitch && settings.dilation > 0 {
        stitch_all(done, settings, &mut sheets);
    }
    let mut sheet_of_mesh = vec![None; prt.meshes.len()];
    for (index, sheet) in (0..).zip(&settings.sheets) {
        sheet.meshes.iter().for_each(|&mesh| sheet_of_mesh[mesh] = Some(index));
    }
    let light = done.map_light();
    let finish = |(mut gathered, sheet): (Gathered, &SheetSettings)| {
        (1..settings.dilation).for_each(|_| gathered.plate.dilate());
        let held = if sheet.directional { settings.basis } else { settings.basis.cut(1).unwrap_or(settings.basis) };
        let values = layers(&gathered.plate, &gathered.frames, &Converter::new(held, functions), shape);
        Sheet { layers: encoded(&gathered.plate, &values, shape, held, &light, settings.encoding) }
    };
    let sheets = sheets.into_iter().zip(&settings.sheets).map(finish).collect();
    Ok(Maps { basis: settings.basis, light, sheets, sheet_of_mesh })
}

fn check(done: &Done<'_>, settings: &MapSettings) -> Result<(), Error> {
    let refuse = |setting, value: String, allowed| Err(Error::Setting { setting, value, allowed });
    for sheet in &settings.sheets {
        if !(1..=MAX_SIDE).contains(&sheet.width) || !(1..=MAX_SIDE).contains(&sheet.height) {
            return refuse(
                "--texels",
                format!("{} x {}", sheet.width, sheet.height),
                "use sheets of 1 to 8192 texels along each side",
            );
        }
    }
    if settings.dilation > MAX_DILATION {
        return refuse("dilation", settings.dilation.to_string(), "use 0 to 64 rings");
    }
    let mut seen = vec![false; done.scene.meshes.len()];
    for &mesh in settings.sheets.iter().flat_map(|sheet| &sheet.meshes) {
        match seen.get_mut(mesh) {
            Some(seen) if !*seen => *seen = true,
            _ => return refuse("sheets", format!("mesh {mesh}"), "a mesh of the scene lies in one sheet at most"),
        }
    }
    Ok(())
}

/// What arrives at the texels of a sheet that a surface touches.
fn gather(
    done: &Done<'_>,
    arrivals: &Arrivals<'_>,
    sheet: &SheetSettings,
    first_index: u32,
    prt: &mut Prt,
) -> Result<Gathered, Error> {
    let touched = texels(done.scene, &sheet.meshes, sheet.width, sheet.height);
    let shape = arrivals.shape();
    check_memory(done, touched.len(), shape)?;
    let points: Vec<Receiver> = touched.iter().map(|texel| receiver(done, texel)).collect();
    let found = arrive(done, arrivals, &points, &|k| first_index + touched[k].row * sheet.width + touched[k].column)?;
    let charts: Vec<Charts> = done.scene.meshes.iter().map(Charts::of).collect();
    let mut first_chart = vec![0; charts.len() + 1];
    for (m, chart) in charts.iter().enumerate() {
        first_chart[m + 1] = first_chart[m] + chart.count;
    }
    let mut plate = Plate::empty([sheet.width as usize, sheet.height as usize], shape.len());
    let mut frames = Vec::new();
    for ((texel, point), arrival) in touched.iter().zip(&points).zip(found) {
        let place = texel.row as usize * plate.width + texel.column as usize;
        let chart = first_chart[texel.mesh as usize] + charts[texel.mesh as usize].of_triangle[texel.triangle as usize];
        prt.achieved.visibility_rays += arrival.visibility_rays;
        prt.achieved.bounce_rays += arrival.bounce_rays;
        if is_inside(arrival.openness, arrival.inside_share) || !point.sound {
            plate.owner[place] = chart;
            continue;
        }
        plate.add_slot(place, chart);
        plate.values.extend_from_slice(&arrival.values);
        let mesh = &done.scene.meshes[texel.mesh as usize];
        frames.push(TangentFrame::at(mesh, texel.triangle as usize, texel.barycentrics, point.normal));
    }
    plate.values.par_chunks_mut(shape.len().max(1)).for_each(|row| to_irradiance(row, shape));
    Ok(Gathered { plate, frames })
}

fn check_memory(done: &Done<'_>, texels: usize, shape: Shape) -> Result<(), Error> {
    // Once as found, once in the plate, and as much again while they are converted.
    let (needed, allowed) = (3 * 4 * (texels * shape.len()) as u64, done.settings.memory);
    if needed > allowed { Err(Error::MapMemory { texels, needed, allowed }) } else { Ok(()) }
}

/// The point of a surface that a texel stands for.
fn receiver(done: &Done<'_>, texel: &Texel) -> Receiver {
    let mesh = &done.scene.meshes[texel.mesh as usize];
    let triangle = texel.triangle as usize;
    let [u, v] = texel.barycentrics;
    let [a, b, c] = mesh.triangles[triangle].map(|vertex| mesh.positions[vertex as usize]);
    // About the first corner: far from the origin sums of positions would lose digits.
    let centre = a + ((b - a) + (c - a)) / 3.0;
    let at = a + u * (b - a) + v * (c - a);
    Receiver::new(at, Some(mesh.normal(triangle, u, v)), (b - a).cross(c - a), centre).0
}

/// What a texel keeps of what arrives.
struct Kept {
    values: Vec<f32>,
    openness: f32,
    inside_share: f32,
    visibility_rays: u64,
    bounce_rays: u64,
}

fn arrive(
    done: &Done<'_>,
    arrivals: &Arrivals<'_>,
    points: &[Receiver],
    index: &(dyn Fn(usize) -> u32 + Sync),
) -> Result<Vec<Kept>, Error> {
    let total = points.len() as u64;
    done.monitor.begin(Stage::Texels, total);
    let order = morton_order(points, 0..points.len() as u32);
    let chunks: Vec<Vec<(u32, Kept)>> = order
        .par_chunks(CHUNK)
        .map_init(Worker::new, |worker, ids| {
            let mut out = Vec::with_capacity(ids.len());
            for &id in ids {
                if done.monitor.is_cancelled() {
                    break;
                }
                let a = arrivals.at(&points[id as usize], index(id as usize), worker);
                done.monitor.receiver_done(Stage::Texels, total, a.visibility_rays + a.bounce_rays);
                let kept = Kept {
                    values: a.values,
                    openness: a.openness,
                    inside_share: a.inside_share,
                    visibility_rays: a.visibility_rays,
                    bounce_rays: a.bounce_rays,
                };
                out.push((id, kept));
            }
            out
        })
        .collect();
    done.monitor.check()?;
    let mut all: Vec<(u32, Kept)> = chunks.into_iter().flatten().collect();
    all.sort_unstable_by_key(|(id, _)| *id);
    Ok(all.into_iter().map(|(_, kept)| kept).collect())
}

/// Makes both sides of every seam between the meshes of all sheets agree.
fn stitch_all(done: &Done<'_>, settings: &MapSettings, sheets: &mut [Gathered]) {
    let mut sheet_of = vec![None; done.scene.meshes.len()];
    for (index, sheet) in settings.sheets.iter().enumerate() {
        sheet.meshes.iter().for_each(|&mesh| sheet_of[mesh] = Some(index));
    }
    let meshes: Vec<usize> = (0..sheet_of.len()).filter(|&mesh| sheet_of[mesh].is_some()).collect();
    let mut first_slot = vec![0u32];
    for sheet in sheets.iter() {
        first_slot.push(first_slot[first_slot.len() - 1] + sheet.plate.slots() as u32);
    }
    let look_up = |mesh: u32, uv: Vec2| -> Agreement {
        let sheet = sheet_of[mesh as usize].expect("only meshes with a sheet");
        bilinear(&sheets[sheet].plate, uv)
            .into_iter()
            .map(|(slot, weight)| (slot + first_slot[sheet], weight))
            .collect()
    };
    let mut agreements = Vec::new();
    for seam in seams(done.scene, &meshes) {
        let length = |side: &scene::lightmap::SeamSide| {
            let plate = &sheets[sheet_of[side.mesh as usize].expect("only meshes with a sheet")].plate;
            ((side.ends[1] - side.ends[0]) * Vec2::new(plate.width as f32, plate.height as f32)).length()
        };
        let points =
            (PER_TEXEL * length(&seam.sides[0]).max(length(&seam.sides[1]))).ceil().clamp(1.0, 65_536.0) as u32;
        for point in 0..points {
            let along = (point as f32 + 0.5) / points as f32;
            let [left, right] = seam.sides.map(|side| look_up(side.mesh, side.ends[0].lerp(side.ends[1], along)));
            if !left.is_empty() && !right.is_empty() {
                agreements.push(left.into_iter().chain(right.into_iter().map(|(slot, w)| (slot, -w))).collect());
            }
        }
    }
    let Some(row_len) = sheets.first().map(|sheet| sheet.plate.row_len) else { return };
    let mut values: Vec<f32> = sheets.iter_mut().flat_map(|sheet| std::mem::take(&mut sheet.plate.values)).collect();
    stitch(&agreements, row_len, &mut values);
    let mut rest = &values[..];
    for sheet in sheets {
        let (own, others) = rest.split_at(sheet.plate.slots() * row_len);
        sheet.plate.values = own.to_vec();
        rest = others;
    }
}

/// Slots that the filter reads at a point of a sheet, with weights that sum to 1; none where one is empty.
fn bilinear(plate: &Plate, uv: Vec2) -> Agreement {
    let size = Vec2::new(plate.width as f32, plate.height as f32);
    let at = (uv * size - 0.5).clamp(Vec2::ZERO, size - 1.0);
    let (low, part) = (at.floor(), at - at.floor());
    let mut out = Agreement::new();
    for (dx, wx) in [(0, 1.0 - part.x), (1, part.x)] {
        for (dy, wy) in [(0, 1.0 - part.y), (1, part.y)] {
            if wx * wy > 0.0 {
                let texel = (low.y as usize + dy) * plate.width + low.x as usize + dx;
                match plate.slot_of[texel] {
                    NONE => return Agreement::new(),
                    slot => out.push((slot, wx * wy)),
                }
            }
        }
    }
    out
}

/// The numbers of the file: `[function][coefficient of the light]` pictures.
fn layers(plate: &Plate, frames: &[TangentFrame], converter: &Converter, shape: Shape) -> Vec<f32> {
    let frame = |slot: usize| &frames[plate.model_of[slot] as usize];
    let rows: Vec<Vec<f32>> = (0..plate.slots())
        .into_par_iter()
        .map(|slot| converter.convert(frame(slot), shape, &plate.values[slot * plate.row_len..][..plate.row_len]))
        .collect();
    let (texels, count) = (plate.width * plate.height, converter.count() * shape.depth);
    let mut values = vec![0.0; count * texels * shape.channels];
    for (row, &texel) in rows.iter().zip(&plate.texel_of) {
        for (layer, numbers) in row.chunks_exact(shape.channels).enumerate() {
            let start = (layer * texels + texel as usize) * shape.channels;
            values[start..start + shape.channels].copy_from_slice(numbers);
        }
    }
    values
}

/// The numbers as the file holds them, with a range of its own for each chart where that is asked for.
fn encoded(plate: &Plate, values: &[f32], shape: Shape, basis: Basis, light: &MapLight, encoding: Encoding) -> Layers {
    let count = basis.count() * shape.depth;
    let curves = curves(basis, light);
    let coding = Coding { charts: &plate.owner, curves: &curves, ..Coding::plain(encoding) };
    let shape = [plate.width as u32, plate.height as u32, count as u32, shape.channels as u32];
    Layers::encode(shape, values, &coding).layers
}
