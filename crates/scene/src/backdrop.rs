//! Sky domes: meshes around a scene that stand for its surroundings, which a light probe takes the place of.

use glam::{DVec3, Vec3};

use crate::{Bounds, Mesh, Scene, Warning};

/// Share of the sphere, seen from the middle of all else, that domes fill at least: half a sphere may end at the horizon.
const DOME: f64 = 0.4;
/// Share that each part of a dome fills at least, such as a side of a box of six meshes.
const PART: f64 = 0.02;
/// A mesh lower than this share of its width is ground, which may go on beyond a dome.
const GROUND: f32 = 0.1;

/// Takes out the meshes that, alone or together, enclose all others and show the same radiance whatever the light, with a
/// warning for each.
pub(crate) fn drop_domes(scene: &mut Scene) {
    let domes = domes(scene);
    let mut index = 0..;
    let report = &mut scene.report;
    scene.meshes.retain(|mesh| {
        let is_dome = index.next().is_some_and(|index| domes.contains(&index));
        if is_dome {
            let message = "encloses the scene and is unlit: a sky dome, which would keep all light out. It was left out; the light probe \
                           is the sky"
                .into();
            report.warnings.push(Warning { object: mesh.name.clone(), message });
        }
        !is_dome
    });
}

/// The meshes of the domes.
fn domes(scene: &Scene) -> Vec<usize> {
    let (own, lit): (Vec<usize>, Vec<usize>) = (0..scene.meshes.len()).partition(|&index| shows_itself(scene, index));
    let bounds = |list: &[usize]| {
        let boxes = list.iter().filter_map(|&index| scene.meshes[index].bounds());
        Bounds::of(boxes.flat_map(|b| [b.min, b.max]))
    };
    let is_ground = |&index: &usize| {
        let size = scene.meshes[index].bounds().map_or(Vec3::ZERO, |b| b.size());
        size.y < GROUND * size.x.max(size.z)
    };
    let standing: Vec<usize> = lit.iter().copied().filter(|index| !is_ground(index)).collect();
    let Some(rest) = bounds(if standing.is_empty() { &lit } else { &standing }) else { return Vec::new() };
    // What is unlit among the other meshes stays.
    let beyond = |index: &usize| {
        let own = scene.meshes[*index].bounds();
        own.is_some_and(|b| b.min.cmplt(rest.min).any() || b.max.cmpgt(rest.max).any())
    };
    let share = |index: &usize| share(&scene.meshes[*index], rest.center());
    let parts: Vec<usize> = own.into_iter().filter(|index| beyond(index) && share(index) > PART).collect();
    let Some(whole) = bounds(&parts) else { return Vec::new() };
    // A dome may stand on the ground that it covers.
    let margin = 0.01 * whole.size();
    let holds = (whole.min - margin).cmple(rest.min).all() && (whole.max + margin).cmpge(rest.max).all();
    if holds && parts.iter().map(share).sum::<f64>() > DOME { parts } else { Vec::new() }
}

/// Whether a mesh shows the same radiance whatever the light.
fn shows_itself(scene: &Scene, index: usize) -> bool {
    let material = scene.material(index);
    material.unlit || material.emissive.max_element() > 0.0 && material.base_color.truncate() == Vec3::ZERO
}

/// Share of the sphere that a mesh fills from a point, whichever side it shows.
fn share(mesh: &Mesh, from: Vec3) -> f64 {
    share_of_sphere(mesh.triangles.iter().map(|t| t.map(|v| mesh.positions[v as usize])), from)
}

/// Share of the sphere that triangles of one orientation fill from a point: 1 where they close around it, 0 where it lies
/// outside of a closed surface (Van Oosterom and Strackee 1983).
pub fn share_of_sphere(triangles: impl IntoIterator<Item = [Vec3; 3]>, from: Vec3) -> f64 {
    let angle = |triangle: [Vec3; 3]| {
        let [a, b, c] = triangle.map(|p| (p.as_dvec3() - from.as_dvec3()).normalize_or(DVec3::X));
        2.0 * libm::atan2(a.dot(b.cross(c)), 1.0 + a.dot(b) + b.dot(c) + c.dot(a))
    };
    triangles.into_iter().map(angle).sum::<f64>().abs() / (4.0 * std::f64::consts::PI)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Material;

    /// A ground of 2 m within a cube of 20 m that has the given material.
    fn within(material: Material) -> Scene {
        let mut scene = crate::builtin("plane").expect("a builtin");
        let mut cube = crate::builtin("closed-room").expect("a builtin").meshes.remove(0);
        cube.positions.iter_mut().for_each(|p| *p *= 20.0);
        cube.material = scene.materials.len() as u32;
        scene.materials.push(material);
        scene.meshes.push(cube);
        scene
    }

    #[test]
    fn unlit_domes_are_left_out() {
        let mut scene = within(Material { unlit: true, ..Material::default() });
        drop_domes(&mut scene);
        assert_eq!((scene.meshes.len(), scene.report.warnings.len()), (1, 1));
        assert_eq!(scene.report.warnings[0].object, "room");
    }

    /// Walls that are lit stay, and so does what is unlit but encloses nothing.
    #[test]
    fn unlit_domes_are_left_out_can_fail() {
        let mut room = within(Material::default());
        drop_domes(&mut room);
        assert_eq!((room.meshes.len(), room.report.warnings.len()), (2, 0));
        let mut beside = within(Material { unlit: true, ..Material::default() });
        beside.meshes[1].positions.iter_mut().for_each(|p| p.x += 30.0);
        drop_domes(&mut beside);
        assert_eq!(beside.meshes.len(), 2);
        // Nothing else is there that a light could fall on.
        let mut scan = within(Material { unlit: true, ..Material::default() });
        scan.materials.iter_mut().for_each(|material| material.unlit = true);
        drop_domes(&mut scan);
        assert_eq!(scan.meshes.len(), 2);
    }
}
