//! Sky domes: meshes around a scene that stand for its surroundings, which a light probe takes the place of.

use glam::{DVec3, Vec3};

use crate::{Bounds, Mesh, Scene, Warning};

/// Share of the sphere, seen from the middle of all else, that a dome fills at least: half a sphere may end at the horizon.
const DOME: f64 = 0.4;

/// Takes out the meshes that enclose all others and show the same radiance whatever the light, with a warning for each.
pub(crate) fn drop_domes(scene: &mut Scene) {
    let domes: Vec<bool> = (0..scene.meshes.len()).map(|index| is_dome(scene, index)).collect();
    let mut dome = domes.iter();
    let report = &mut scene.report;
    scene.meshes.retain(|mesh| {
        let is_dome = *dome.next().expect("one for each mesh");
        if is_dome {
            let message = "encloses the scene and is unlit: a sky dome, which would keep all light out. It was left out; the light probe \
                           is the sky"
                .into();
            report.warnings.push(Warning { object: mesh.name.clone(), message });
        }
        !is_dome
    });
}

fn is_dome(scene: &Scene, index: usize) -> bool {
    let material = scene.material(index);
    let glows = material.emissive.max_element() > 0.0 && material.base_color.truncate() == Vec3::ZERO;
    if !(material.unlit || glows) {
        return false;
    }
    let others = scene.meshes.iter().enumerate().filter(|(other, _)| *other != index);
    let rest = Bounds::of(others.filter_map(|(_, mesh)| mesh.bounds()).flat_map(|b| [b.min, b.max]));
    let (Some(rest), Some(own)) = (rest, scene.meshes[index].bounds()) else { return false };
    // A dome may stand on the ground that it covers.
    let margin = 0.01 * own.size();
    let holds = (own.min - margin).cmple(rest.min).all() && (own.max + margin).cmpge(rest.max).all();
    holds && share(&scene.meshes[index], rest.center()) > DOME
}

/// Share of the sphere that a mesh fills from a point, whichever side it shows (Van Oosterom and Strackee 1983).
fn share(mesh: &Mesh, from: Vec3) -> f64 {
    let angle = |triangle: &[u32; 3]| {
        let [a, b, c] =
            triangle.map(|v| (mesh.positions[v as usize].as_dvec3() - from.as_dvec3()).normalize_or(DVec3::X));
        2.0 * libm::atan2(a.dot(b.cross(c)), 1.0 + a.dot(b) + b.dot(c) + c.dot(a))
    };
    mesh.triangles.iter().map(angle).sum::<f64>().abs() / (4.0 * std::f64::consts::PI)
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
    }
}
