//! The normals that the normal maps of a scene hold.

use glam::Vec3;
use sampling::rng;
use scene::{Scene, TextureSlot};
use std::collections::BTreeSet;

/// Normals that are picked of all.
pub const PICKED: usize = 64;
/// Texels of normal maps that are looked at, one of each of as many runs.
const MOST_READ: usize = 1 << 20;
/// Seed of the places in the runs.
const SEED: u64 = 0x6e6f_726d;

/// [`PICKED`] normals, evenly picked of all texels of the normal maps of `meshes` in the order of their height above the surface; none where
/// no normal map is drawn. Unit, tangent space, as drawn: scaled by the material, and on the horizon where the map points below it.
///
/// Each material counts by the texels of its map, whatever area it is drawn on.
#[must_use]
pub fn normals(scene: &Scene, meshes: impl Iterator<Item = usize>) -> Vec<Vec3> {
    let has_tangents = |&mesh: &usize| !scene.meshes[mesh].tangents.is_empty();
    let materials: BTreeSet<u32> = meshes.filter(has_tangents).map(|mesh| scene.meshes[mesh].material).collect();
    let map = |&index: &u32| {
        let material = &scene.materials[index as usize];
        material
            .normal_texture
            .map(|TextureSlot { texture, .. }| (&scene.textures[texture as usize].rgba[..], material.normal_scale))
    };
    let maps: Vec<(&[[u8; 4]], f32)> = materials.iter().filter_map(map).collect();
    let mut all = sampled(&maps);
    all.sort_by(|a, b| a.z.total_cmp(&b.z).then(a.x.total_cmp(&b.x)).then(a.y.total_cmp(&b.y)));
    match all.len() {
        0 => Vec::new(),
        len => (0..PICKED).map(|i| all[(2 * i + 1) * len / (2 * PICKED)]).collect(),
    }
}

/// One texel of each run of as many as keep to [`MOST_READ`], at a place of the run that follows no pattern of the maps.
fn sampled(maps: &[(&[[u8; 4]], f32)]) -> Vec<Vec3> {
    let total: usize = maps.iter().map(|(texels, _)| texels.len()).sum();
    let run = total.div_ceil(MOST_READ).max(1);
    let (mut out, mut first) = (Vec::with_capacity(total / run + 1), 0);
    for (texels, scale) in maps {
        let from = first / run;
        for number in from..(first + texels.len()).div_ceil(run) {
            let place = number * run + (rng::hash(SEED, number as u64, 0) % run as u64) as usize;
            if let Some(texel) = place.checked_sub(first).and_then(|place| texels.get(place)) {
                out.push(decoded(*texel, *scale));
            }
        }
        first += texels.len();
    }
    out
}

/// The normal of a texel, green up.
fn decoded([r, g, b, _]: [u8; 4], scale: f32) -> Vec3 {
    let [x, y, z] = [r, g, b].map(|byte| f32::from(byte) / 255.0 * 2.0 - 1.0);
    let bent = Vec3::new(scale * x, scale * y, z).try_normalize().unwrap_or(Vec3::Z);
    bent.with_z(bent.z.max(0.0)).try_normalize().unwrap_or(Vec3::Z)
}
