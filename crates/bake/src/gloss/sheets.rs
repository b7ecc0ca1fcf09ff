//! Texels as receivers: transfer textures (\[T\] sections 4.1 and 4.3), a sheet for each object or for several.

use super::levels;
use super::row::{Bouncing, Layout, RowMaker};
use super::settings::TextureSettings;
use crate::arrival::{Arrival, Arrivals};
use crate::error::Error;
use crate::extras::Done;
use crate::maps::hidden::{self, Hidden, is_hidden};
use crate::maps::plate::Plate;
use crate::maps::{SheetSettings, arrive_as, aside, extent, read_back, receiver, stitch_all};
use crate::progress::Stage;
use crate::receivers::Receiver;
use crate::repair::is_inside;
use coeff_io::GlossRecord;
use glam::Vec3;
use scene::lightmap::{Charts, Texel, texels};
use sh_math::Bands;
use std::collections::BTreeMap;

/// A sheet with what its rows hold.
pub(crate) struct SheetPlan {
    pub(crate) settings: SheetSettings,
    pub(crate) layout: Layout,
    pub(crate) texels: Vec<Texel>,
}

/// A sheet while it is worked on: the finest level first.
pub(crate) struct BakedSheet {
    pub(crate) layout: Layout,
    pub(crate) levels: Vec<Plate>,
}

/// Where it is written down what texels took and reached.
struct Told<'a> {
    record: &'a mut GlossRecord,
    /// Of each texel.
    errors: &'a mut Vec<f32>,
    /// Sums of squares: what a sketch left out of bounces, and all of them.
    lost: &'a mut [f64; 2],
}

/// What is kept of a texel.
struct Kept {
    row: Vec<f32>,
    is_inside: bool,
    is_hidden: bool,
    error: f32,
    rays: [u64; 2],
    lost: [f64; 2],
}

/// The texels that surfaces touch, and what is kept of them.
pub(crate) fn plan(done: &Done<'_>, settings: &TextureSettings, layout: &dyn Fn(bool) -> Layout) -> Vec<SheetPlan> {
    let shines = crate::mirror::shining(done.scene);
    let of = |sheet: &SheetSettings| {
        let shiny = sheet.meshes.iter().any(|&mesh| shines[done.scene.meshes[mesh].material as usize]);
        let texels = texels(done.scene, &sheet.meshes, sheet.width, sheet.height);
        SheetPlan { settings: sheet.clone(), layout: layout(shiny), texels }
    };
    settings.sheets.iter().map(of).collect()
}

/// Bakes all sheets.
pub(crate) fn bake(
    done: &Done<'_>,
    arrivals: &Arrivals<'_>,
    maker: &RowMaker<'_>,
    settings: &TextureSettings,
    plans: &[SheetPlan],
    record: &mut GlossRecord,
    lost: &mut [f64; 2],
) -> Result<Vec<BakedSheet>, Error> {
    let at_normals = done.arrivals_at_normals(None);
    let plain = RowMaker { functions: Bands::new(1).expect("one band"), bouncing: Bouncing::None, ..*maker };
    let mut plates = Vec::new();
    let mut errors = Vec::new();
    let mut first_index = 0u32;
    for plan in plans {
        let told = Told { record, errors: &mut errors, lost };
        let (arrivals, maker) =
            if is_at_normals(done, settings, plan) { (&at_normals, &plain) } else { (arrivals, maker) };
        let mut plate = gather(done, arrivals, maker, settings, plan, first_index, told)?;
        first_index = first_index.wrapping_add(plan.settings.width * plan.settings.height);
        (0..settings.dilation.min(1)).for_each(|_| plate.dilate());
        if settings.stitch {
            read_back(&mut plate, &maker.parts(plan.layout));
        }
        plates.push(plate);
    }
    if settings.stitch && settings.dilation > 0 {
        stitch(done, maker, plans, &mut plates);
    }
    errors.sort_by(f32::total_cmp);
    let at = |share: f64| errors.get((errors.len().saturating_sub(1) as f64 * share) as usize).copied().unwrap_or(0.0);
    record.error = [at(0.5), at(0.95), at(1.0)];
    let finish = |(mut plate, plan): (Plate, &SheetPlan)| {
        (1..settings.dilation).for_each(|_| plate.dilate());
        let below = if settings.levels { levels::below(&plate, settings.dilation) } else { Vec::new() };
        BakedSheet { layout: plan.layout, levels: std::iter::once(plate).chain(below).collect() }
    };
    Ok(plates.into_iter().zip(plans).map(finish).collect())
}

/// Whether the texels of a sheet need what arrives for one normal alone, that of the surface: they take it as vertices do, with the cosine exact.
/// In few bands it would err most where little is open.
fn is_at_normals(done: &Done<'_>, settings: &TextureSettings, plan: &SheetPlan) -> bool {
    let is_bent = |&mesh: &usize| settings.bent && done.scene.material(mesh).normal_texture.is_some();
    plan.layout.len() == plan.layout.diffuse && !plan.settings.meshes.iter().any(is_bent)
}

/// What arrives at the texels of one sheet, those mended that are inside of bodies or hidden.
fn gather(
    done: &Done<'_>,
    arrivals: &Arrivals<'_>,
    maker: &RowMaker<'_>,
    settings: &TextureSettings,
    plan: &SheetPlan,
    first_index: u32,
    Told { record, errors, lost }: Told<'_>,
) -> Result<Plate, Error> {
    let sheet = &plan.settings;
    let points: Vec<Receiver> = plan.texels.iter().map(|texel| receiver(done, texel)).collect();
    let index = |k: usize| seed(first_index, plan, k);
    let keep = |k: usize, arrival: Arrival| {
        let row = maker.make(plan.layout, &arrival, lit_about(done, settings, &plan.texels[k], points[k].normal));
        Kept {
            lost: maker.lost(plan.layout, &arrival, &row),
            row,
            is_inside: is_inside(arrival.openness, arrival.inside_share) || !points[k].sound,
            is_hidden: is_hidden(&arrival, extent(done, &plan.texels[k], [sheet.width, sheet.height])),
            error: arrival.error,
            rays: [arrival.visibility_rays, arrival.bounce_rays],
        }
    };
    let found = arrive_as(done, arrivals, (&points, Stage::Texels), &index, &keep)?;
    let mut plate = Plate::empty([sheet.width as usize, sheet.height as usize], plan.layout.len());
    let chart = charts(done, sheet);
    let mut hidden = Vec::new();
    record.texels += plan.texels.len() as u64;
    for (texel, kept) in plan.texels.iter().zip(found) {
        let place = texel.row as usize * plate.width + texel.column as usize;
        record.rays = [record.rays[0] + kept.rays[0], record.rays[1] + kept.rays[1]];
        *lost = [lost[0] + kept.lost[0], lost[1] + kept.lost[1]];
        if kept.is_inside || kept.is_hidden {
            plate.owner[place] = chart(texel);
            record.inside += u64::from(kept.is_inside);
            hidden.extend((!kept.is_inside).then_some(Hidden { place, row: kept.row }));
            continue;
        }
        let slot = plate.add_slot(place, chart(texel));
        plate.aside.extend(aside(done, texel, sheet).map(|at| (slot, at)));
        plate.values.extend(kept.row);
        errors.push(kept.error);
    }
    let hidden = hidden::mend(&mut plate, hidden);
    record.unfilled += fill_from_vertices(done, maker, plan, hidden, &mut plate) as u64;
    Ok(plate)
}

/// The seed of the rays of a texel of a sheet.
pub(crate) fn seed(first_index: u32, plan: &SheetPlan, texel: usize) -> u32 {
    let Texel { row, column, .. } = plan.texels[texel];
    first_index.wrapping_add(row * plan.settings.width + column)
}

/// The normal that diffuse transfer is about: bent by the normal map where that is asked for.
fn lit_about(done: &Done<'_>, settings: &TextureSettings, texel: &Texel, normal: Vec3) -> Vec3 {
    if !settings.bent {
        return normal;
    }
    let [u, v] = texel.barycentrics;
    done.scene.bent_normal(texel.mesh as usize, texel.triangle as usize, u, v)
}

/// The chart of a texel, counted over all meshes of a sheet.
fn charts(done: &Done<'_>, sheet: &SheetSettings) -> impl Fn(&Texel) -> u32 + use<> {
    let mut of_mesh: BTreeMap<u32, (u32, Charts)> = BTreeMap::new();
    let mut first = 0;
    for &mesh in &sheet.meshes {
        let charts = Charts::of(&done.scene.meshes[mesh]);
        let count = charts.count;
        of_mesh.insert(mesh as u32, (first, charts));
        first += count;
    }
    move |texel| {
        let (first, charts) = &of_mesh[&texel.mesh];
        first + charts.of_triangle[texel.triangle as usize]
    }
}

/// Gives texels whose chart has nothing to mend them with the diffuse transfer of the vertices around them; the rest of what hidden ones keep
/// is their own. Returns how many there are.
fn fill_from_vertices(
    done: &Done<'_>,
    maker: &RowMaker<'_>,
    plan: &SheetPlan,
    hidden: Vec<Hidden>,
    plate: &mut Plate,
) -> usize {
    let mut own: BTreeMap<usize, Vec<f32>> = hidden.into_iter().map(|one| (one.place, one.row)).collect();
    let row = |texel: &Texel, place: usize| {
        let mut row = own.remove(&place).unwrap_or_else(|| vec![0.0; plan.layout.len()]);
        let diffuse = &mut row[..plan.layout.diffuse];
        diffuse.fill(0.0);
        done.add_from_vertices(texel, None, (1.0, maker.channels), diffuse);
        row
    };
    hidden::fill(plate, &plan.texels, row).len()
}

/// Makes both sides of seams agree, sheets of one layout among each other.
fn stitch(done: &Done<'_>, maker: &RowMaker<'_>, plans: &[SheetPlan], plates: &mut [Plate]) {
    let mut layouts: Vec<Layout> = Vec::new();
    for plan in plans {
        if !layouts.contains(&plan.layout) {
            layouts.push(plan.layout);
        }
    }
    for layout in layouts {
        let mut sheet_of_mesh = vec![None; done.scene.meshes.len()];
        let mut own: Vec<&mut Plate> = Vec::new();
        for (plan, plate) in plans.iter().zip(plates.iter_mut()).filter(|(plan, _)| plan.layout == layout) {
            plan.settings.meshes.iter().for_each(|&mesh| sheet_of_mesh[mesh] = Some(own.len() as u32));
            own.push(plate);
        }
        stitch_all(done, &sheet_of_mesh, &maker.parts(layout), &mut own);
    }
}
