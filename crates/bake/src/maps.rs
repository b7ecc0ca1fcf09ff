//! Directional light maps: what arrives at the texels of sheets, kept for every normal of a normal map (\[N\] chapter 2).
//!
//! A texel is a receiver like a vertex: the same rays, the same rule for their number. What it sees is kept over world normals until
//! seams are stitched, then turned into the tangent frame and converted to the basis.

mod borders;
mod check;
mod directional;
mod frame;
pub(crate) mod hidden;
mod join;
pub(crate) mod plate;
mod stitch;

use crate::arrival::{Arrival, Arrivals, Shape, to_irradiance};
use crate::domain::Domain;
use crate::error::Error;
use crate::extras::Done;
use crate::gather::Worker;
use crate::plan::allowed;
use crate::progress::Stage;
use crate::receivers::{Receiver, morton_order};
use crate::repair::is_inside;
use coeff_io::{Coding, Effect, Effort, Encoded, Encoding, Layers, MapLight, MapRecord, Maps, Prt, Sheet, curves};
use frame::{Converter, TangentFrame};
use glam::Vec2;
use hidden::{Hidden, is_hidden};
use plate::Plate;
use rayon::prelude::*;
use scene::lightmap::{Charts, Texel, texels};
use sh_math::Bands;
use sh_math::hemisphere::Basis;
use std::collections::BTreeMap;

/// Texels that a thread takes at a time.
const CHUNK: usize = 64;

pub(crate) use borders::read_back;
pub(crate) use check::{check, check_sheets};
pub use directional::{Directional, DirectionalTexel, directional};
pub(crate) use join::stitch_all;
pub(crate) use stitch::Part;

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

impl MapSettings {
    /// Bytes that the maps take in the file at most, but for small headers: in three channels, of which transfer may have one.
    /// `light_bands` is none where the light is fixed.
    #[must_use]
    pub fn most_bytes(&self, light_bands: Option<u32>) -> u64 {
        let depth = light_bands.map_or(1, |bands| u64::from(bands) * u64::from(bands));
        let half_bytes = match self.encoding {
            Encoding::F32 => 24,
            Encoding::F16 => 12,
            Encoding::U8 => 6,
            Encoding::Bc6h => 2,
            Encoding::Bc1 => 1,
        };
        let layers = |sheet: &SheetSettings| if sheet.directional { self.basis.count() as u64 } else { 1 } * depth;
        let texels = |sheet: &SheetSettings| u64::from(sheet.width) * u64::from(sheet.height);
        self.sheets.iter().map(|sheet| texels(sheet) * layers(sheet) * half_bytes / 2).sum()
    }
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
    /// The same: estimated error.
    errors: Vec<f32>,
    /// Texels inside of bodies, and hidden ones.
    inside: Vec<Texel>,
    /// Texels that no view shows, with what arrives there.
    hidden: Vec<Hidden>,
    record: MapRecord,
}

impl Gathered {
    /// Gives texels whose chart has nothing to mend them with what the vertices around them take, the same for every normal. Returns how
    /// many there are.
    fn fill_from_vertices(&mut self, done: &Done<'_>, shape: Shape) -> usize {
        // The first function is 1 / sqrt(4 pi) everywhere.
        let constant = (4.0 * std::f32::consts::PI).sqrt();
        let first_frame = self.frames.len() as u32;
        let filled = hidden::fill(&mut self.plate, &self.inside, |texel, _| {
            let mesh = &done.scene.meshes[texel.mesh as usize];
            let normal = receiver(done, texel).normal;
            self.frames.push(TangentFrame::at(mesh, texel.triangle as usize, texel.barycentrics, normal));
            let mut row = vec![0.0; shape.len()];
            let of_first = &mut row[..shape.depth * shape.channels];
            done.add_from_vertices(texel, done.fixed_light(), (constant, shape.channels), of_first);
            row
        });
        let frames = first_frame..;
        filled.clone().zip(frames).for_each(|(slot, frame)| self.plate.model_of[slot as usize] = frame);
        filled.len()
    }
}

/// Bands over normals that are kept until the conversion: three, as the paper has them, where they can be relit, and five where there is
/// room, since that is what a bent normal can tell of the cosine.
fn functions(has_light: bool) -> Bands {
    Bands::new(if has_light { 5 } else { 3 }).expect("few bands")
}

pub(crate) fn bake(done: &Done<'_>, settings: &MapSettings, prt: &mut Prt) -> Result<Maps, Error> {
    // Left out by --effects, normal maps are not drawn.
    let bends = allowed(done.settings, Effect::NormalMaps);
    let is_bent = |sheet: &SheetSettings| bends && sheet.directional;
    let any_bent = settings.sheets.iter().any(is_bent);
    // Where one normal is enough its cosine is exact; in few bands it would err most where little is open, as dark lines in corners.
    let functions = if any_bent { functions(done.light.is_some()) } else { Bands::new(1).expect("one band") };
    let bank = any_bent.then(|| done.bank(Domain::Hemisphere, functions));
    let arrivals = match &bank {
        Some(bank) => done.arrivals(bank, functions),
        None => done.arrivals_at_normals(done.fixed_light()),
    };
    let shape = arrivals.shape();
    let mut first_index = 0;
    let mut sheets = Vec::new();
    for sheet in &settings.sheets {
        sheets.push(gather(done, &arrivals, sheet, first_index)?);
        first_index += sheet.width * sheet.height;
    }
    let parts = [Part { numbers: 0..shape.len(), means: shape.channels }];
    for gathered in &mut sheets {
        done.monitor.check()?;
        // Where a whole chart is hidden the vertices tell.
        hidden::mend(&mut gathered.plate, std::mem::take(&mut gathered.hidden));
        gathered.record.unfilled = gathered.fill_from_vertices(done, shape) as u64;
        (0..settings.dilation.min(1)).for_each(|_| gathered.plate.dilate());
        if settings.stitch {
            read_back(&mut gathered.plate, &parts);
        }
    }
    let mut sheet_of_mesh = vec![None; prt.meshes.len()];
    for (index, sheet) in (0..).zip(&settings.sheets) {
        sheet.meshes.iter().for_each(|&mesh| sheet_of_mesh[mesh] = Some(index));
    }
    if settings.stitch && settings.dilation > 0 {
        let mut plates: Vec<&mut Plate> = sheets.iter_mut().map(|sheet| &mut sheet.plate).collect();
        stitch_all(done, &sheet_of_mesh, &parts, &mut plates);
    }
    let mut record = summed(&sheets);
    let light = done.map_light();
    done.monitor.check()?;
    let finish = |(mut gathered, sheet): (Gathered, &SheetSettings)| {
        (1..settings.dilation).for_each(|_| gathered.plate.dilate());
        let held = if is_bent(sheet) { settings.basis } else { Basis::ModifiedH1 };
        let values = layers(&gathered.plate, &gathered.frames, &Converter::new(held, functions), shape);
        let encoded = encoded(&gathered.plate, &values, shape, held, &light, settings.encoding);
        record.clipped += encoded.clipped;
        record.negative += encoded.negative;
        Sheet { layers: encoded.layers }
    };
    let sheets: Vec<Sheet> = sheets.into_iter().zip(&settings.sheets).map(finish).collect();
    prt.achieved.visibility_rays += record.rays[0];
    prt.achieved.bounce_rays += record.rays[1];
    prt.achieved.maps = Some(record);
    Ok(Maps { basis: settings.basis, light, sheets, sheet_of_mesh })
}

/// What arrives at the texels of a sheet that a surface touches.
fn gather(
    done: &Done<'_>,
    arrivals: &Arrivals<'_>,
    sheet: &SheetSettings,
    first_index: u32,
) -> Result<Gathered, Error> {
    let touched = texels(done.scene, &sheet.meshes, sheet.width, sheet.height);
    let shape = arrivals.shape();
    let points: Vec<Receiver> = touched.iter().map(|texel| receiver(done, texel)).collect();
    let found = arrive(done, arrivals, &points, &|k| first_index + touched[k].row * sheet.width + touched[k].column)?;
    let charts: BTreeMap<usize, Charts> =
        sheet.meshes.iter().map(|&mesh| (mesh, Charts::of(&done.scene.meshes[mesh]))).collect();
    let mut first_chart = BTreeMap::new();
    let mut count = 0;
    for (m, chart) in &charts {
        first_chart.insert(*m as u32, count);
        count += chart.count;
    }
    let mut plate = Plate::empty([sheet.width as usize, sheet.height as usize], shape.len());
    let (mut frames, mut errors, mut record) = (Vec::new(), Vec::new(), MapRecord::default());
    let (mut inside, mut hidden) = (Vec::new(), Vec::new());
    for ((texel, point), arrival) in touched.iter().zip(&points).zip(found) {
        let place = texel.row as usize * plate.width + texel.column as usize;
        let chart = first_chart[&texel.mesh] + charts[&(texel.mesh as usize)].of_triangle[texel.triangle as usize];
        record.rays[0] += arrival.visibility_rays;
        record.rays[1] += arrival.bounce_rays;
        if is_inside(arrival.openness, arrival.inside_share) || !point.sound {
            plate.owner[place] = chart;
            record.inside += 1;
            inside.push(*texel);
            continue;
        }
        if is_hidden(&arrival, extent(done, texel, [sheet.width, sheet.height])) {
            plate.owner[place] = chart;
            hidden.push(Hidden { place, row: arrival.values });
            inside.push(*texel);
            continue;
        }
        let slot = plate.add_slot(place, chart);
        plate.aside.extend(aside(done, texel, sheet).map(|at| (slot, at)));
        errors.push(arrival.error);
        plate.values.extend_from_slice(&arrival.values);
        let mesh = &done.scene.meshes[texel.mesh as usize];
        frames.push(TangentFrame::at(mesh, texel.triangle as usize, texel.barycentrics, point.normal));
    }
    plate.values.par_chunks_mut(shape.len().max(1)).for_each(|row| to_irradiance(row, shape));
    record.texels = touched.len() as u64;
    hidden.iter_mut().for_each(|one| to_irradiance(&mut one.row, shape));
    Ok(Gathered { plate, frames, errors, inside, hidden, record })
}

/// What all sheets took and reached.
fn summed(sheets: &[Gathered]) -> MapRecord {
    let mut all = MapRecord::default();
    for MapRecord { texels, inside, unfilled, rays, .. } in sheets.iter().map(|sheet| sheet.record) {
        all.texels += texels;
        all.inside += inside;
        all.unfilled += unfilled;
        all.rays = [all.rays[0] + rays[0], all.rays[1] + rays[1]];
    }
    let mut errors: Vec<f32> = sheets.iter().flat_map(|sheet| &sheet.errors).copied().collect();
    errors.sort_by(f32::total_cmp);
    let at = |share: f64| errors.get((errors.len().saturating_sub(1) as f64 * share) as usize).copied().unwrap_or(0.0);
    all.error = [at(0.5), at(0.95), at(1.0)];
    all
}

/// The point of a surface that a texel stands for.
pub(crate) fn receiver(done: &Done<'_>, texel: &Texel) -> Receiver {
    let mesh = &done.scene.meshes[texel.mesh as usize];
    let triangle = texel.triangle as usize;
    let [u, v] = texel.barycentrics;
    let [a, b, c] = mesh.triangles[triangle].map(|vertex| mesh.positions[vertex as usize]);
    // About the first corner: far from the origin sums of positions would lose digits.
    let centre = a + ((b - a) + (c - a)) / 3.0;
    let at = a + u * (b - a) + v * (c - a);
    let receiver = Receiver::new(at, Some(mesh.normal(triangle, u, v)), (b - a).cross(c - a), centre).0;
    receiver.of_extent(done.gatherer.world.extents[texel.mesh as usize])
}

/// The point of a sheet that a texel stands for, in texels, where that is not its middle.
pub(crate) fn aside(done: &Done<'_>, texel: &Texel, sheet: &SheetSettings) -> Option<Vec2> {
    if texel.is_middle {
        return None;
    }
    let mesh = &done.scene.meshes[texel.mesh as usize];
    let corners = mesh.triangles[texel.triangle as usize].map(|vertex| mesh.uv1[vertex as usize]);
    let [a, b, c] = corners.map(|uv| uv * Vec2::new(sheet.width as f32, sheet.height as f32));
    let [u, v] = texel.barycentrics;
    Some(a + u * (b - a) + v * (c - a))
}

/// How large a texel is on its surface: the side of a square.
pub(crate) fn extent(done: &Done<'_>, texel: &Texel, [width, height]: [u32; 2]) -> f32 {
    let mesh = &done.scene.meshes[texel.mesh as usize];
    let corners = mesh.triangles[texel.triangle as usize].map(|vertex| vertex as usize);
    let [a, b, c] = corners.map(|vertex| mesh.positions[vertex]);
    let [p, q, r] = corners.map(|vertex| mesh.uv1[vertex] * Vec2::new(width as f32, height as f32));
    ((b - a).cross(c - a).length() / (q - p).perp_dot(r - p).abs()).sqrt()
}

/// What arrives at every point, in their order.
fn arrive(
    done: &Done<'_>,
    arrivals: &Arrivals<'_>,
    points: &[Receiver],
    index: &(dyn Fn(usize) -> u32 + Sync),
) -> Result<Vec<Arrival>, Error> {
    arrive_as(done, arrivals, (points, Stage::Texels), index, &|_, arrival| arrival)
}

/// [`arrive`], each turned into what is kept of it as soon as it is there; `index` is the seed of a point's rays.
pub(crate) fn arrive_as<T: Send>(
    done: &Done<'_>,
    arrivals: &Arrivals<'_>,
    (points, stage): (&[Receiver], Stage),
    index: &(dyn Fn(usize) -> u32 + Sync),
    keep: &(dyn Fn(usize, Arrival) -> T + Sync),
) -> Result<Vec<T>, Error> {
    let total = points.len() as u64;
    done.monitor.begin(stage, total);
    let order = morton_order(points, 0..points.len() as u32);
    let chunks: Vec<Vec<(u32, T)>> = order
        .par_chunks(CHUNK)
        .map_init(Worker::new, |worker, ids| {
            let mut out = Vec::with_capacity(ids.len());
            for &id in ids {
                if done.monitor.is_cancelled() {
                    break;
                }
                let arrival = arrivals.at(&points[id as usize], index(id as usize), worker);
                done.monitor.receiver_done(stage, total, arrival.visibility_rays + arrival.bounce_rays);
                out.push((id, keep(id as usize, arrival)));
            }
            out
        })
        .collect();
    done.monitor.check()?;
    let mut all: Vec<(u32, T)> = chunks.into_iter().flatten().collect();
    all.sort_unstable_by_key(|(id, _)| *id);
    Ok(all.into_iter().map(|(_, kept)| kept).collect())
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
fn encoded(plate: &Plate, values: &[f32], shape: Shape, basis: Basis, light: &MapLight, encoding: Encoding) -> Encoded {
    let count = basis.count() * shape.depth;
    let curves = curves(basis, light);
    // Transfer has so many layers that a thorough search would take longer than the rays.
    let effort = if shape.depth > 1 { Effort::Fast } else { Effort::Basic };
    let coding = Coding { charts: &plate.owner, curves: &curves, effort, ..Coding::plain(encoding) };
    let shape = [plate.width as u32, plate.height as u32, count as u32, shape.channels as u32];
    Layers::encode(shape, values, &coding)
}
