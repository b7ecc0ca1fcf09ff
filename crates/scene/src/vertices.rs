//! Vertices as records: dropping unused ones, merging equal ones, copying.

use std::collections::HashMap;

use crate::Mesh;

/// Keeps the listed vertices in the listed order (repeats allowed); triangles are left as they are.
pub(crate) fn select(mesh: &mut Mesh, kept: &[u32]) {
    fn pick<T: Copy>(values: &mut Vec<T>, kept: &[u32]) {
        if !values.is_empty() {
            *values = kept.iter().map(|&i| values[i as usize]).collect();
        }
    }
    pick(&mut mesh.positions, kept);
    pick(&mut mesh.normals, kept);
    pick(&mut mesh.tangents, kept);
    pick(&mut mesh.uv0, kept);
    pick(&mut mesh.uv1, kept);
    pick(&mut mesh.colors, kept);
}

/// Drops vertices that no triangle uses; returns how many.
pub(crate) fn drop_unused(mesh: &mut Mesh) -> usize {
    let mut place = vec![u32::MAX; mesh.positions.len()];
    for &i in mesh.triangles.iter().flatten() {
        place[i as usize] = 0;
    }
    let kept: Vec<u32> = (0..place.len() as u32).filter(|&i| place[i as usize] == 0).collect();
    let dropped = place.len() - kept.len();
    if dropped > 0 {
        for (new, &old) in kept.iter().enumerate() {
            place[old as usize] = new as u32;
        }
        select(mesh, &kept);
        mesh.triangles.iter_mut().flatten().for_each(|i| *i = place[*i as usize]);
    }
    dropped
}

/// Merges vertices that are equal bit for bit in every attribute; returns how many disappeared.
pub(crate) fn merge_equal(mesh: &mut Mesh) -> usize {
    let mut first_of: HashMap<Vec<u32>, u32> = HashMap::with_capacity(mesh.positions.len());
    let mut kept = Vec::new();
    let mut place = Vec::with_capacity(mesh.positions.len());
    for i in 0..mesh.positions.len() {
        let next = kept.len() as u32;
        let new = *first_of.entry(bits(mesh, i)).or_insert(next);
        if new == next {
            kept.push(i as u32);
        }
        place.push(new);
    }
    let merged = place.len() - kept.len();
    if merged > 0 {
        select(mesh, &kept);
        mesh.triangles.iter_mut().flatten().for_each(|i| *i = place[*i as usize]);
    }
    merged
}

/// All attributes of one vertex as bits; zero of either sign is one value.
fn bits(mesh: &Mesh, i: usize) -> Vec<u32> {
    let mut record = Vec::with_capacity(18);
    let mut push = |values: &[f32]| record.extend(values.iter().map(|v| (v + 0.0).to_bits()));
    push(&mesh.positions[i].to_array());
    if let Some(normal) = mesh.normals.get(i) {
        push(&normal.to_array());
    }
    if let Some(tangent) = mesh.tangents.get(i) {
        push(&tangent.to_array());
    }
    if let Some(color) = mesh.colors.get(i) {
        push(&color.to_array());
    }
    for uv in [mesh.uv0.get(i), mesh.uv1.get(i)].into_iter().flatten() {
        push(&uv.to_array());
    }
    record
}
