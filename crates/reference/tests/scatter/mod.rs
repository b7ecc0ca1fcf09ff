//! Receivers at random points of a scene's surfaces.

use glam::Vec3;
use reference::Receiver;
use sampling::rng::Rng;
use scene::Scene;

/// `n` points, triangles by turns spread over all, each on the front of its triangle.
pub fn receivers(scene: &Scene, n: usize, seed: u64) -> Vec<Receiver> {
    let triangles: Vec<(usize, usize)> =
        scene.meshes.iter().enumerate().flat_map(|(m, mesh)| (0..mesh.triangles.len()).map(move |t| (m, t))).collect();
    let mut rng = Rng::new(seed, 0);
    (0..n)
        .map(|i| {
            let (m, t) = triangles[(i * triangles.len() + triangles.len() / 2) / n];
            let [a, b] = rng.next_square();
            let (u, v) = if a + b < 1.0 { (a, b) } else { (1.0 - a, 1.0 - b) };
            let mesh = &scene.meshes[m];
            Receiver {
                position: mesh.position(t, u, v),
                normal: mesh.normal(t, u, v),
                geometric_normal: mesh.face_normal(t),
                albedo: scene.albedo(m, t, u, v),
            }
        })
        .collect()
}

/// The ground point (x, 0, z) that faces up.
pub fn ground(x: f32, z: f32, albedo: f32) -> Receiver {
    let position = Vec3::new(x, 0.0, z);
    Receiver { position, normal: Vec3::Y, geometric_normal: Vec3::Y, albedo: Vec3::splat(albedo) }
}
