//! Splits large triangles, since a vertex is all that can hold a shadow.

use crate::receivers::Receivers;
use crate::world::World;
use crate::{Error, settings};
use coeff_io::{Refine, Settings};
use glam::{Vec3, Vec4};
use rayon::prelude::*;
use scene::{Mesh, Scene};
use std::borrow::Cow;
use std::collections::HashMap;

/// Triangles that a scene of few, large ones is split into at least.
const LEAST_TRIANGLES: f64 = 20_000.0;
/// Most triangles that a mesh may be split into.
const MOST_TRIANGLES: usize = 1 << 23;
/// Rounds of halving; each halves the longest edges, so that these reach 1/4096 of the first.
const ROUNDS: usize = 12;

/// The scene with every edge at most as long as the settings say; borrowed where nothing is to be split.
///
/// [`Refine::Auto`] takes the edge that triangles would have if as many as the scene has (or 20,000 where it has fewer) lay evenly over
/// its surfaces, and leaves a scene alone in which nothing casts a shadow. Edges are split by their length alone, so neighbours stay
/// joined, across meshes too. The surface stays the same; vertices of a mesh keep their indices, new ones follow.
///
/// # Errors
/// [`Error`] as in [`crate::bake`], where the scene is too large or a setting out of range.
pub fn refine<'a>(scene: &'a Scene, settings: &Settings) -> Result<Cow<'a, Scene>, Error> {
    settings::check(settings)?;
    let longest = match settings.refine {
        Refine::Off => return Ok(Cow::Borrowed(scene)),
        Refine::Edge(length) => length,
        Refine::Auto => even_edge(scene),
    };
    let even = !scene.meshes.iter().any(|mesh| has_longer(mesh, longest));
    if even || settings.refine == Refine::Auto && !has_shadows(scene)? {
        return Ok(Cow::Borrowed(scene));
    }
    let mut refined = scene.clone();
    for mesh in &mut refined.meshes {
        split(mesh, longest, &scene.name)?;
    }
    Ok(Cow::Owned(refined))
}

/// Whether anything in the scene can cast a shadow on a receiver.
fn has_shadows(scene: &Scene) -> Result<bool, Error> {
    let world = World::new(scene, false)?;
    Ok(Receivers::of(scene).list.par_iter().any(|receiver| world.can_shadow(receiver)))
}

/// Longest edge of triangles spread evenly over all surfaces: half a square of that diagonal has the mean area; twice
/// the length leaves alone what is about even.
fn even_edge(scene: &Scene) -> f32 {
    let (mut area, mut count) = (0.0, 0.0);
    for mesh in &scene.meshes {
        area += (0..mesh.triangles.len()).map(|t| mesh.area(t)).sum::<f64>();
        count += mesh.triangles.len() as f64;
    }
    (2.0 * (4.0 * area / f64::max(count, LEAST_TRIANGLES)).sqrt()) as f32
}

fn has_longer(mesh: &Mesh, longest: f32) -> bool {
    mesh.triangles.iter().any(|t| edges(t).iter().any(|&[a, b]| is_longer(mesh, a, b, longest)))
}

fn is_longer(mesh: &Mesh, a: u32, b: u32, longest: f32) -> bool {
    mesh.positions[a as usize].distance_squared(mesh.positions[b as usize]) > longest * longest
}

fn edges(&[a, b, c]: &[u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

fn split(mesh: &mut Mesh, longest: f32, scene: &str) -> Result<(), Error> {
    for _ in 0..ROUNDS {
        if !has_longer(mesh, longest) {
            break;
        }
        let mut middles = HashMap::new();
        let mut triangles = Vec::with_capacity(2 * mesh.triangles.len());
        for triangle in std::mem::take(&mut mesh.triangles) {
            let cut = edges(&triangle).map(|[a, b]| {
                is_longer(mesh, a, b, longest)
                    .then(|| *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| add_middle(mesh, a, b)))
            });
            triangles.extend(pieces(mesh, triangle, cut));
        }
        mesh.triangles = triangles;
        if mesh.triangles.len() > MOST_TRIANGLES {
            return Err(too_fine(scene, mesh.triangles.len()));
        }
    }
    if has_longer(mesh, longest) { Err(too_fine(scene, mesh.triangles.len())) } else { Ok(()) }
}

fn too_fine(scene: &str, count: usize) -> Error {
    let what = "triangles after splitting (use a larger --refine)";
    Error::TooLarge { scene: scene.to_owned(), what, count, limit: MOST_TRIANGLES }
}

/// The parts of a triangle whose edges ab, bc, ca are cut at the given vertices.
fn pieces(mesh: &Mesh, [a, b, c]: [u32; 3], cut: [Option<u32>; 3]) -> Vec<[u32; 3]> {
    match cut {
        [None, None, None] => vec![[a, b, c]],
        [Some(ab), None, None] => vec![[a, ab, c], [ab, b, c]],
        [None, Some(bc), None] => vec![[b, bc, a], [bc, c, a]],
        [None, None, Some(ca)] => vec![[c, ca, b], [ca, a, b]],
        [Some(ab), Some(bc), None] => corner_cut(mesh, [b, c, a], bc, ab),
        [None, Some(bc), Some(ca)] => corner_cut(mesh, [c, a, b], ca, bc),
        [Some(ab), None, Some(ca)] => corner_cut(mesh, [a, b, c], ab, ca),
        [Some(ab), Some(bc), Some(ca)] => vec![[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]],
    }
}

/// Cuts corner `a` off at `ab` and `ca`; the rest is halved along its shorter diagonal.
fn corner_cut(mesh: &Mesh, [a, b, c]: [u32; 3], ab: u32, ca: u32) -> Vec<[u32; 3]> {
    let length = |p: u32, q: u32| mesh.positions[p as usize].distance_squared(mesh.positions[q as usize]);
    let mut parts = vec![[a, ab, ca]];
    if length(ab, c) <= length(b, ca) {
        parts.extend([[ab, b, c], [ab, c, ca]]);
    } else {
        parts.extend([[ab, b, ca], [b, c, ca]]);
    }
    parts
}

/// Adds the vertex half-way between two others, the same whichever comes first.
fn add_middle(mesh: &mut Mesh, a: u32, b: u32) -> u32 {
    let (a, b) = (a.min(b) as usize, a.max(b) as usize);
    let index = mesh.positions.len() as u32;
    mesh.positions.push(0.5 * (mesh.positions[a] + mesh.positions[b]));
    if !mesh.normals.is_empty() {
        let normal: Vec3 = mesh.normals[a] + mesh.normals[b];
        mesh.normals.push(normal.try_normalize().unwrap_or(mesh.normals[a]));
    }
    if !mesh.tangents.is_empty() {
        let (ta, tb): (Vec4, Vec4) = (mesh.tangents[a], mesh.tangents[b]);
        let tangent = (ta + tb).truncate().try_normalize().unwrap_or(ta.truncate());
        mesh.tangents.push(tangent.extend(ta.w));
    }
    if !mesh.uv0.is_empty() {
        mesh.uv0.push(0.5 * (mesh.uv0[a] + mesh.uv0[b]));
    }
    if !mesh.uv1.is_empty() {
        mesh.uv1.push(0.5 * (mesh.uv1[a] + mesh.uv1[b]));
    }
    if !mesh.colors.is_empty() {
        mesh.colors.push(0.5 * (mesh.colors[a] + mesh.colors[b]));
    }
    index
}
