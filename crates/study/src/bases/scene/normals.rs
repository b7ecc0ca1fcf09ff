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

#[cfg(test)]
mod tests {
    use super::*;
    use scene::Texture;

    /// A sphere with one material and a normal map of 64 x 64 texels.
    fn bumped(scale: f32, texel: impl Fn(u32) -> [u8; 4]) -> Scene {
        let mut scene = scene::builtin("sphere").unwrap();
        let rgba = (0..64 * 64).map(texel).collect();
        scene.textures = vec![Texture { width: 64, height: 64, rgba, ..Texture::white("bumps") }];
        let mesh = &mut scene.meshes[0];
        mesh.tangents = vec![glam::Vec4::X; mesh.positions.len()];
        let material = &mut scene.materials[mesh.material as usize];
        material.normal_texture = Some(TextureSlot { texture: 0, uv_set: 0, transform: glam::Affine2::IDENTITY });
        material.normal_scale = scale;
        scene
    }

    /// A slope that grows over the map: 255 along z, and x from 128 on.
    fn slope(i: u32) -> [u8; 4] {
        [128 + (i / 64) as u8, 128, 255, 255]
    }

    fn mean_z(normals: &[Vec3]) -> f32 {
        normals.iter().map(|n| n.z).sum::<f32>() / normals.len() as f32
    }

    #[test]
    fn normals_are_those_of_the_map() {
        let picked = normals(&bumped(1.0, slope), [0].into_iter());
        assert_eq!(picked.len(), PICKED);
        assert!(picked.windows(2).all(|pair| pair[0].z <= pair[1].z), "in the order of height");
        let all: Vec<Vec3> = (0..64 * 64).map(|i| decoded(slope(i), 1.0)).collect();
        assert!((mean_z(&picked) - mean_z(&all)).abs() < 1e-3, "{} {}", mean_z(&picked), mean_z(&all));
        let steep = normals(&bumped(3.0, slope), [0].into_iter());
        assert!(mean_z(&steep) < mean_z(&picked) - 0.1, "can fail: the scale of the material counts");
        let below = normals(&bumped(1.0, |_| [255, 128, 0, 255]), [0].into_iter());
        assert!(below.iter().all(|n| n.z == 0.0 && (n.length() - 1.0).abs() < 1e-6), "{below:?}");
    }

    #[test]
    fn what_draws_no_normal_map_has_no_normals() {
        let scene = scene::builtin("sphere").unwrap();
        assert!(normals(&scene, [0].into_iter()).is_empty());
        let mut bare = bumped(1.0, slope);
        assert!(normals(&bare, std::iter::empty()).is_empty(), "no mesh, no normals");
        bare.meshes[0].tangents.clear();
        assert!(normals(&bare, [0].into_iter()).is_empty(), "without tangents nothing is bent");
    }

    /// More texels than are read: one of each run, so that every part of every map has its share.
    #[test]
    fn large_maps_are_read_in_part() {
        let one = |b: u8, len: usize| vec![[128, 128, b, 255]; len];
        let (a, b) = (one(255, 3 * MOST_READ / 2), one(0, MOST_READ / 2 + 1));
        let read = sampled(&[(&a, 1.0), (&b, 1.0)]);
        let up = read.iter().filter(|n| n.z > 0.9).count() as f64 / read.len() as f64;
        assert!(read.len() <= MOST_READ && read.len() > MOST_READ / 2, "{}", read.len());
        assert!((up - 0.75).abs() < 1e-3, "{up}");
    }
}
