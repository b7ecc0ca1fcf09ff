//! Where the light of sheets has to agree: look-ups on both sides of every seam.

use super::plate::{NONE, Plate};
use super::stitch::{Agreement, Part, stitch};
use crate::extras::Done;
use glam::Vec2;
use scene::lightmap::seams;
use std::collections::BTreeSet;

/// Look-ups to a texel along a seam.
const PER_TEXEL: f32 = 2.0;
/// Look-ups to a texel that holds something, over all seams: sound coordinates stay far below.
const MOST_PER_SLOT: usize = 32;

/// Makes both sides of every seam between the meshes of all sheets agree, whose rows have these parts.
pub(crate) fn stitch_all(done: &Done<'_>, sheet_of_mesh: &[Option<u32>], parts: &[Part], plates: &mut [&mut Plate]) {
    let meshes: Vec<usize> = (0..sheet_of_mesh.len()).filter(|&mesh| sheet_of_mesh[mesh].is_some()).collect();
    let sheet_of = |mesh: u32| sheet_of_mesh[mesh as usize].expect("only meshes with a sheet") as usize;
    let mut first_slot = vec![0u32];
    for plate in plates.iter() {
        first_slot.push(first_slot[first_slot.len() - 1] + plate.slots() as u32);
    }
    let look_up = |mesh: u32, uv: Vec2| -> Agreement {
        let sheet = sheet_of(mesh);
        bilinear(plates[sheet], in_texels(plates[sheet], uv))
            .into_iter()
            .map(|(slot, weight)| (slot + first_slot[sheet], weight))
            .collect()
    };
    let mut agreements: Vec<Agreement> = Vec::new();
    for seam in seams(done.scene, &meshes) {
        let length = |side: &scene::lightmap::SeamSide| {
            let plate = &plates[sheet_of(side.mesh)];
            ((side.ends[1] - side.ends[0]) * Vec2::new(plate.width as f32, plate.height as f32)).length()
        };
        let points =
            (PER_TEXEL * length(&seam.sides[0]).max(length(&seam.sides[1]))).ceil().clamp(1.0, 65_536.0) as u32;
        // Coordinates that make no sheet could ask for any number.
        if agreements.len() > MOST_PER_SLOT * first_slot[first_slot.len() - 1] as usize {
            break;
        }
        for point in 0..points {
            let along = (point as f32 + 0.5) / points as f32;
            let [left, right] = seam.sides.map(|side| look_up(side.mesh, side.ends[0].lerp(side.ends[1], along)));
            if !left.is_empty() && !right.is_empty() {
                agreements.push(left.into_iter().chain(right.into_iter().map(|(slot, w)| (slot, -w))).collect());
            }
        }
    }
    let Some(row_len) = plates.first().map(|plate| plate.row_len) else { return };
    let unseen: BTreeSet<u32> = (plates.iter().zip(&first_slot))
        .flat_map(|(plate, first)| plate.unseen.iter().map(move |slot| slot + first))
        .collect();
    // Rows along seams alone are taken out: all together would be there twice.
    let mut place_of = vec![NONE; first_slot[first_slot.len() - 1] as usize];
    agreements.iter().flatten().for_each(|&(slot, _)| place_of[slot as usize] = 0);
    let slots: Vec<u32> = (0..place_of.len() as u32).filter(|&slot| place_of[slot as usize] != NONE).collect();
    (0..).zip(&slots).for_each(|(place, &slot)| place_of[slot as usize] = place);
    agreements.iter_mut().flatten().for_each(|(slot, _)| *slot = place_of[*slot as usize]);
    let unseen = (0..).zip(&slots).filter(|(_, slot)| unseen.contains(slot)).map(|(place, _)| place).collect();
    let sheet = |slot: u32| first_slot.partition_point(|&first| first <= slot) - 1;
    let range = |slot: u32| {
        let start = (slot - first_slot[sheet(slot)]) as usize * row_len;
        start..start + row_len
    };
    let row = |&slot: &u32| &plates[sheet(slot)].values[range(slot)];
    let mut values: Vec<f32> = slots.iter().flat_map(row).copied().collect();
    stitch(&agreements, &unseen, (parts, row_len), &mut values);
    for (&slot, row) in slots.iter().zip(values.chunks_exact(row_len)) {
        plates[sheet(slot)].values[range(slot)].copy_from_slice(row);
    }
}

fn in_texels(plate: &Plate, uv: Vec2) -> Vec2 {
    uv * Vec2::new(plate.width as f32, plate.height as f32)
}

/// Slots that the filter reads at a point of a sheet, in texels, with weights that sum to 1; none where one is empty.
pub(super) fn bilinear(plate: &Plate, at: Vec2) -> Agreement {
    let most = Vec2::new(plate.width as f32, plate.height as f32) - 1.0;
    let at = (at - 0.5).clamp(Vec2::ZERO, most);
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
