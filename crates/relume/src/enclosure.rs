//! Finds a mesh that encloses a scene, so that no light of a probe gets in.

use bake::{Look, Price};
use coeff_io::{Prt, Quality};
use glam::Vec3;
use scene::{Bounds, Scene};
use std::collections::BTreeSet;

/// A mesh that encloses a scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Enclosure {
    /// Name of the mesh; may be empty.
    pub mesh: String,
    /// Receivers that were examined and do not see the sky.
    pub dark_receivers: u64,
}

/// Largest share of the sky that the receivers looked at may see on average where a scene counts as closed.
const CLOSED: f32 = 5e-4;

/// First coefficient of the transfer of a receiver that sees the whole sky: sqrt(1 / (4 pi)).
const OPEN: f32 = 0.282_094_8;

/// Share of the receivers that get no light where a scene counts as closed.
const DARK: f64 = 0.8;
/// The same where each receiver has few rays: in a hall with small openings most of them meet none.
const DARK_BY_FEW_RAYS: f64 = 0.99;
/// Fewer rays than so many are few.
const FEW_RAYS: u32 = 64;

/// A mesh that takes light, with the box around it.
type Lit = (usize, Bounds);

/// The largest mesh, and what it may keep the light from.
struct Around {
    outer: usize,
    inner: Vec<usize>,
    /// The middle of the others, where all of these lie within the box of the largest.
    middle: Option<Vec3>,
}

fn around(lit: &[Lit]) -> Option<Around> {
    // Backs come last.
    let &(outer, bounds) = lit.iter().rev().max_by(|a, b| a.1.radius().total_cmp(&b.1.radius()))?;
    let margin = 0.01 * bounds.size();
    let (low, high) = (bounds.min - margin, bounds.max + margin);
    // Its back is a mesh of its own where it is two-sided.
    let others: Vec<&Lit> = lit.iter().filter(|one| one.1 != bounds).collect();
    let within = others.iter().all(|one| low.cmple(one.1.min).all() && high.cmpge(one.1.max).all());
    let middle = Bounds::of(others.iter().flat_map(|one| [one.1.min, one.1.max])).map(|b| b.center());
    let inner = if within && !others.is_empty() { others } else { lit.iter().collect() };
    Some(Around { outer, inner: inner.iter().map(|one| one.0).collect(), middle: middle.filter(|_| within) })
}

/// The largest mesh of a baked scene, where nearly nothing inside it gets light, whatever its own outside sees.
pub fn find_enclosure(prt: &Prt) -> Option<Enclosure> {
    let lit: Vec<Lit> = prt.meshes.iter().enumerate().filter_map(|(k, mesh)| Some((k, lit(prt, mesh)?))).collect();
    let Around { outer, inner, middle } = around(&lit)?;
    // A bottom in the plane of its floor counts as open, though it gets no light.
    let faces_down = |vertex: usize| prt.geometry.normals[vertex][1] < -0.9;
    let row = (prt.transfer.bands * prt.transfer.bands * prt.transfer.channels) as usize;
    let firsts: Vec<f32> = inner
        .iter()
        .flat_map(|&mesh| vertices(&prt.meshes[mesh]))
        .filter(|&vertex| !faces_down(vertex))
        .filter_map(|vertex| prt.transfer.values.get(vertex * row).map(|value| value.abs()))
        .collect();
    let dark = firsts.iter().filter(|value| **value <= CLOSED * OPEN).count();
    let is_dark = dark > 0 && dark as f64 >= dark_share(prt.settings.quality) * firsts.len() as f64;
    // What is shut into a body counts as buried in it, and is repaired.
    let outer = &prt.meshes[outer];
    let is_shut = middle.is_some_and(|middle| closes(prt, outer, middle));
    (is_dark || is_shut).then(|| Enclosure {
        mesh: outer.name.clone(),
        dark_receivers: if is_shut { firsts.len() } else { dark } as u64,
    })
}

/// [`find_enclosure`] before a bake, by the receivers of a cost estimate.
pub fn predict_enclosure(scene: &Scene, price: &Price, quality: Quality) -> Option<Enclosure> {
    let takes_light = |mesh: usize| {
        let material = scene.material(mesh);
        !material.unlit && material.base_color.truncate().max_element() > 0.0
    };
    let bounds = |mesh: usize| Some((mesh, scene.meshes[mesh].bounds()?));
    let lit: Vec<Lit> = (0..scene.meshes.len()).filter(|&mesh| takes_light(mesh)).filter_map(bounds).collect();
    let Around { outer, inner, middle } = around(&lit)?;
    let inner: BTreeSet<usize> = inner.into_iter().collect();
    let looks = price.looks.iter().filter(|look| inner.contains(&(look.mesh as usize)));
    let is_dark = |look: &&Look| look.first.abs() <= CLOSED * OPEN;
    let all: f64 = looks.clone().map(|look| look.receivers).sum();
    let dark: f64 = looks.clone().filter(is_dark).map(|look| look.receivers).sum();
    let mesh = &scene.meshes[outer];
    let corners = || mesh.triangles.iter().map(|t| t.map(|v| mesh.positions[v as usize]));
    let is_shut = middle.is_some_and(|middle| is_opaque(scene.material(outer)) && is_closed_around(corners(), middle));
    let told = if is_shut { looks.count() } else { looks.filter(is_dark).count() };
    (is_shut || dark > 0.0 && dark >= dark_share(quality) * all)
        .then(|| Enclosure { mesh: mesh.name.clone(), dark_receivers: told as u64 })
}

/// Share of the receivers that get no light where a scene counts as closed, by how well each looked.
fn dark_share(quality: Quality) -> f64 {
    match quality {
        Quality::Rays(rays) if rays < FEW_RAYS => DARK_BY_FEW_RAYS,
        _ => DARK,
    }
}

/// Whether an opaque mesh is closed around a point.
fn closes(prt: &Prt, mesh: &coeff_io::Mesh, point: Vec3) -> bool {
    let (first, count) = (mesh.first_triangle as usize, mesh.triangles as usize);
    let triangles = prt.geometry.triangles.get(first..first + count).unwrap_or_default();
    let corners = triangles.iter().map(|t| t.map(|v| Vec3::from(prt.geometry.positions[v as usize])));
    let material = &prt.materials[mesh.material as usize];
    let is_opaque = material.alpha == coeff_io::AlphaMode::Opaque && material.transmission == 0.0;
    is_opaque && is_closed_around(corners, point)
}

fn is_opaque(material: &scene::Material) -> bool {
    material.alpha == scene::AlphaMode::Opaque && material.transmission == 0.0
}

fn is_closed_around(triangles: impl Iterator<Item = [Vec3; 3]>, point: Vec3) -> bool {
    scene::share_of_sphere(triangles, point) > 0.999
}

fn vertices(mesh: &coeff_io::Mesh) -> std::ops::Range<usize> {
    mesh.first_vertex as usize..(mesh.first_vertex + mesh.vertices) as usize
}

/// The box around a mesh that takes light: what is black or unlit is not traced.
fn lit(prt: &Prt, mesh: &coeff_io::Mesh) -> Option<Bounds> {
    let material = prt.materials.get(mesh.material as usize)?;
    let takes_light = !material.unlit && material.base_color[..3].iter().any(|c| *c > 0.0);
    let points = prt.geometry.positions.get(vertices(mesh)).filter(|_| takes_light)?;
    Bounds::of(points.iter().map(|&p| p.into()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use bake::Extras;
    use std::time::Duration;

    fn predicted(name: &str) -> Option<Enclosure> {
        let scene = scene::builtin(name).expect("a builtin");
        let settings = bake::settings::preview();
        let price = bake::price(&scene, &settings, &Extras::default(), &|| Duration::ZERO).expect("it plans");
        predict_enclosure(&scene, &price, settings.quality)
    }

    #[test]
    fn closed_room_is_found() {
        let enclosure = predicted("closed-room").expect("an enclosure");
        assert!(enclosure.mesh == "room" && enclosure.dark_receivers > 0, "{enclosure:?}");
    }

    #[test]
    fn closed_room_is_found_can_fail() {
        assert_eq!(predicted("cornell-box"), None, "light comes in through its front");
        assert_eq!(predicted("plane"), None);
        assert_eq!(predicted("two-rooms"), None, "one of them is open");
    }
}
