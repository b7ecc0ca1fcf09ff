//! Says so where no light of a probe gets into a scene.

use crate::console::Console;
use coeff_io::{AlphaMode, Plan, Prt, Quality};
use glam::Vec3;
use scene::{Bounds, Mesh, Scene};

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
/// So many receivers that were looked at tell of the others.
const MANY: u64 = 16;

/// Warns where no light of a probe reaches what was baked, or all of it but the mesh around the rest.
pub(crate) fn tell_of_bake(prt: &Prt, console: &Console) {
    if let Some(text) = shell(prt) {
        console.notice(&text);
    }
}

/// Warns where a picture shows nothing at all.
pub(crate) fn tell_of_picture(linear: &[[f32; 3]], console: &Console) {
    if linear.as_flattened().iter().all(|value| *value <= 0.0) {
        console.notice(
            "warning: the picture is black: no light of the probe reaches what the camera sees; look from elsewhere with --camera, or \
             open or take out the mesh that encloses the scene, which `relume bake` names",
        );
    }
}

/// What is baked, as far as it takes light: its mesh, the box around that, and its vertices.
struct Lit<'a> {
    mesh: &'a coeff_io::Mesh,
    bounds: Bounds,
    vertices: std::ops::Range<usize>,
}

/// Names the largest mesh where nearly nothing in it gets light, whatever its own outside sees.
fn shell(prt: &Prt) -> Option<String> {
    let lit: Vec<Lit<'_>> = prt.meshes.iter().filter_map(|mesh| lit(prt, mesh)).collect();
    // Backs come last.
    let outer = lit.iter().rev().max_by(|a, b| a.bounds.radius().total_cmp(&b.bounds.radius()))?;
    let margin = 0.01 * outer.bounds.size();
    let (low, high) = (outer.bounds.min - margin, outer.bounds.max + margin);
    // Its back is a mesh of its own where it is two-sided.
    let others: Vec<&Lit<'_>> = lit.iter().filter(|one| one.bounds != outer.bounds).collect();
    let within = others.iter().all(|one| low.cmple(one.bounds.min).all() && high.cmpge(one.bounds.max).all());
    let apart = within && !others.is_empty();
    let inner = if apart { others } else { lit.iter().collect() };
    // A bottom in the plane of its floor counts as open, though it gets no light.
    let faces_down = |vertex: usize| prt.geometry.normals[vertex][1] < -0.9;
    let row = (prt.transfer.bands * prt.transfer.bands * prt.transfer.channels) as usize;
    let firsts: Vec<f32> = inner
        .iter()
        .flat_map(|one| one.vertices.clone())
        .filter(|&vertex| !faces_down(vertex))
        .filter_map(|vertex| prt.transfer.values.get(vertex * row).map(|value| value.abs()))
        .collect();
    let dark = firsts.iter().filter(|value| **value <= CLOSED * OPEN).count();
    let is_dark = dark > 0 && dark as f64 >= dark_share(prt.settings.quality) * firsts.len() as f64;
    // What is shut into a body counts as buried in it, and is repaired.
    let middle = Bounds::of(inner.iter().flat_map(|one| [one.bounds.min, one.bounds.max])).map(|b| b.center());
    let is_shut = apart && middle.is_some_and(|middle| closes(prt, outer.mesh, middle));
    (is_dark || is_shut).then(|| text(&outer.mesh.name, if is_shut { firsts.len() } else { dark } as u64))
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
    let material = &prt.materials[mesh.material as usize];
    let (first, count) = (mesh.first_triangle as usize, mesh.triangles as usize);
    let triangles = prt.geometry.triangles.get(first..first + count).unwrap_or_default();
    let corners = triangles.iter().map(|t| t.map(|v| Vec3::from(prt.geometry.positions[v as usize])));
    let opaque = material.alpha == AlphaMode::Opaque && material.transmission == 0.0;
    opaque && scene::share_of_sphere(corners, point) > 0.999
}

/// A mesh that takes light: what is black or unlit is not traced.
fn lit<'a>(prt: &Prt, mesh: &'a coeff_io::Mesh) -> Option<Lit<'a>> {
    let material = prt.materials.get(mesh.material as usize)?;
    let takes_light = !material.unlit && material.base_color[..3].iter().any(|c| *c > 0.0);
    let vertices = mesh.first_vertex as usize..(mesh.first_vertex + mesh.vertices) as usize;
    let points = prt.geometry.positions.get(vertices.clone()).filter(|_| takes_light)?;
    let bounds = Bounds::of(points.iter().map(|&p| p.into()))?;
    Some(Lit { mesh, bounds, vertices })
}

fn text(name: &str, receivers: u64) -> String {
    let name = if name.is_empty() { "the largest mesh".into() } else { scene::printable(name) };
    format!(
        "warning: {name}: encloses the scene, and {receivers} receivers that were looked at do not see the sky, so a light probe lights next to \
         nothing; open it, or take it out where it stands for the sky"
    )
}

/// Warns where no receiver that the plan looked at sees the sky.
pub(crate) fn tell(scene: &Scene, plan: &Plan, console: &Console) {
    if let Some(text) = warning(scene, plan) {
        console.notice(&text);
    }
}

fn warning(scene: &Scene, plan: &Plan) -> Option<String> {
    let survey = &plan.survey;
    // Where some receivers are open without a ray the scene is not closed; what stands on a floor may be.
    let few = survey.receivers < MANY && plan.shadowed_receivers < plan.receivers;
    let open = few || 10 * plan.shadowed_receivers < 9 * plan.receivers;
    if survey.receivers == 0 || open || 1.0 - survey.coverage[0] > CLOSED {
        return None;
    }
    let size = |mesh: &&Mesh| mesh.bounds().map_or(0.0, |bounds| bounds.radius());
    let largest = scene.meshes.iter().max_by(|a, b| size(a).total_cmp(&size(b)))?;
    Some(text(&largest.name, survey.receivers))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(name: &str) -> Option<String> {
        let scene = scene::builtin(name).expect("a builtin");
        let plan = ::bake::plan(&scene, &::bake::settings::preview()).expect("it plans");
        warning(&scene, &plan)
    }

    #[test]
    fn a_closed_room_is_told_by_name() {
        let text = told("closed-room").expect("a warning");
        assert!(text.starts_with("warning: room: encloses the scene"), "{text}");
    }

    #[test]
    fn a_closed_room_is_told_by_name_can_fail() {
        assert_eq!(told("cornell-box"), None, "light comes in through its front");
        assert_eq!(told("plane"), None);
        assert_eq!(told("two-rooms"), None, "one of them is open");
    }
}
