//! Closed boxes near to the origin and far from it: no receiver on their inside sees the sky.

mod support;

use coeff_io::{Refine, Sampler, Settings};
use glam::Vec3;
use scene::{Material, Mesh, Scene};
use support::{fixed, quiet};

/// A box of 4 m by 2 m by 3 m seen from within, its low corner at a place whose coordinates are eighths.
fn closed_box(at: Vec3) -> Scene {
    let [x, y, z] = [Vec3::X * 4.0, Vec3::Y * 2.0, Vec3::Z * 3.0];
    let faces = [[at, x, y], [at, y, z], [at, z, x], [at + z, y, x], [at + x, z, y], [at + y, x, z]];
    let face = |[corner, along, up]: [Vec3; 3]| Mesh {
        positions: vec![corner, corner + along, corner + along + up, corner + up],
        normals: vec![along.cross(up).normalize(); 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    Scene { meshes: faces.map(face).to_vec(), materials: vec![Material::default()], ..Scene::default() }
}

/// The most of the sky that a receiver sees, with edges split so that many lie along those of the box.
fn most_open(scene: &Scene) -> f32 {
    let settings = Settings { refine: Refine::Edge(0.12), ..fixed(2, Sampler::OwenSobol, 64, 0) };
    quiet(scene, &settings).transfer.openness.into_iter().fold(0.0, f32::max)
}

#[test]
fn nothing_inside_of_a_closed_box_sees_the_sky() {
    for at in [Vec3::ZERO, Vec3::new(310.0, -290.0, 170.0), Vec3::new(-20.0, 0.0, 1300.0)] {
        let open = most_open(&closed_box(at));
        assert!(open < 1e-6, "{open} at {at}");
    }
}

/// Without one of its walls it does.
#[test]
fn nothing_inside_of_a_closed_box_sees_the_sky_can_fail() {
    let mut scene = closed_box(Vec3::new(310.0, -290.0, 170.0));
    scene.meshes.pop();
    assert!(most_open(&scene) > 0.5);
}
