//! Parts of a cell that see each other along the surface: what stands on a large triangle parts what falls on its two sides.

use super::Divided;
use crate::world::World;
use glam::Vec3;
use rayon::prelude::*;
use raytrace::Ray;

/// Places along an edge of a cell that are told apart.
pub(super) const FINE: u32 = 4;
/// Most fine places of all triangles, each by its share of the area: beyond, its cells stay whole, lest meshes of long slivers take minutes.
/// Compact triangles need the twentieth part.
pub(super) const MOST_PLACES: f64 = (1 << 21) as f64;
/// What is lower than this share of the way between two places does not part them.
const CLEAR: f32 = 0.25;

/// The part of each fine place of a triangle, and the number of parts: cells fall apart where something stands between their places.
/// None where nothing does.
pub(super) fn parts(world: &World<'_>, divided: &Divided) -> Option<(Vec<u32>, u32)> {
    let fine = divided.fine();
    let [a, b, c] = world.points(divided.triangle);
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let places = fine.sides * fine.sides;
    let mut members: Vec<Vec<(u32, Vec3)>> = vec![Vec::new(); (divided.sides * divided.sides) as usize];
    for place in 0..places {
        let [u, v] = fine.middle(place);
        members[divided.place([u, v]) as usize].push((place, a + u * (b - a) + v * (c - a)));
    }
    let joined: Vec<Vec<Vec<u32>>> = members.into_par_iter().map(|places| groups(world, places, normal)).collect();
    let count: usize = joined.iter().map(Vec::len).sum();
    if count == joined.len() {
        return None;
    }
    let mut part_of = vec![0; places as usize];
    for (part, places) in (0..).zip(joined.iter().flatten()) {
        places.iter().for_each(|&place| part_of[place as usize] = part);
    }
    Some((part_of, count as u32))
}

/// Places that are joined by ways along which nothing stands.
fn groups(world: &World<'_>, mut left: Vec<(u32, Vec3)>, normal: Vec3) -> Vec<Vec<u32>> {
    let mut groups = Vec::new();
    while let Some((first, at)) = left.pop() {
        let (mut group, mut reached) = (vec![first], vec![at]);
        while let Some(from) = reached.pop() {
            left.retain(|&(place, to)| {
                let joined = is_clear(world, from, to, normal);
                if joined {
                    group.push(place);
                    reached.push(to);
                }
                !joined
            });
        }
        groups.push(group);
    }
    groups
}

/// Whether nothing stands between two points of a surface, on either of its sides.
fn is_clear(world: &World<'_>, from: Vec3, to: Vec3, normal: Vec3) -> bool {
    let way = to - from;
    [1.0, -1.0].into_iter().all(|side| {
        let origin = from + side * CLEAR * way.length() * normal;
        world.closest(&Ray { t_max: 1.0, ..Ray::new(origin, way) }).is_none()
    })
}
