//! Receivers at random points of a scene's surfaces.

use reference::Receiver;
use sampling::rng::Rng;
use scene::Scene;

/// `n` points, triangles by turns spread over all, each on the front of its triangle.
pub(crate) fn receivers(scene: &Scene, n: usize, seed: u64) -> Vec<Receiver> {
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
