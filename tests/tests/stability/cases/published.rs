//! Rays as the papers trace them: Moeller and Trumbore's test in f32 with an absolute least determinant.

use glam::{Vec3, Vec3Swizzles};
use raytrace::{Ray, Tracer, offset_origin};
use sampling::frame::Frame;
use sampling::rng::Rng;
use sampling::warp::square_to_cosine_concentric;
use scene::Mesh;

/// Smallest determinant that counts, as printed.
const LEAST_DETERMINANT: f32 = 1e-5;

/// Parameter of a ray where it meets a triangle, if it does.
pub(crate) fn meets(origin: Vec3, direction: Vec3, [a, b, c]: [Vec3; 3], least: f32) -> Option<f32> {
    let (e1, e2) = (b - a, c - a);
    let p = direction.cross(e2);
    let det = e1.dot(p);
    if det.abs() < least {
        return None;
    }
    let s = origin - a;
    let q = s.cross(e1);
    let (u, v, t) = (s.dot(p) / det, direction.dot(q) / det, e2.dot(q) / det);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0).then_some(t)
}

/// How the papers keep a ray from meeting the surface that it starts on.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Start {
    /// Triangles that share the vertex by its index do not count.
    OtherIndices,
    /// The ray starts this far off the surface, in units of the scene; the determinant may be as small as it likes.
    Off(f32),
}

/// Share of the cosine-weighted hemisphere over a vertex that is open, from `rays` rays.
pub(crate) fn open_share(mesh: &Mesh, vertex: usize, start: Start, rays: u32) -> f64 {
    let (position, normal) = (mesh.positions[vertex], mesh.normals[vertex]);
    let frame = Frame::from_normal(normal);
    let (origin, least) = match start {
        Start::OtherIndices => (position, LEAST_DETERMINANT),
        Start::Off(distance) => (position + distance * normal, 0.0),
    };
    let counts = |t: &&[u32; 3]| matches!(start, Start::Off(_)) || !t.contains(&(vertex as u32));
    let mut rng = Rng::new(7, vertex as u64);
    let open = (0..rays).filter(|_| {
        let direction = frame.to_world(square_to_cosine_concentric(rng.next_square()));
        let mut triangles = mesh.triangles.iter().filter(counts);
        !triangles.any(|t| meets(origin, direction, t.map(|i| mesh.positions[i as usize]), least).is_some())
    });
    open.count() as f64 / f64::from(rays)
}

/// All meshes as one: their triangles are all that the methods here know.
pub(crate) fn merged(meshes: &[Mesh]) -> Mesh {
    let mut all = Mesh::default();
    for mesh in meshes {
        let first = all.positions.len() as u32;
        all.positions.extend(&mesh.positions);
        all.normals.extend(&mesh.normals);
        all.triangles.extend(mesh.triangles.iter().map(|t| t.map(|v| v + first)));
    }
    all
}

/// Rays over a vertex, just above it, as many to each direction as its cosine.
pub(crate) fn rays_over(mesh: &Mesh, vertex: usize) -> [Ray; 64] {
    let normal = mesh.normals[vertex];
    let (origin, frame) = (offset_origin(mesh.positions[vertex], normal), Frame::from_normal(normal));
    let mut rng = Rng::new(5, vertex as u64);
    std::array::from_fn(|_| Ray::new(origin, frame.to_world(square_to_cosine_concentric(rng.next_square()))))
}

/// Radiance of each vertex under a sky of 1, bounce by bounce as it comes: what arrives from the first corner of what a ray
/// meets, times the vertex's factor, whatever that is.
pub(crate) fn bounced(mesh: &Mesh, factors: &[f64], bounces: u32) -> Vec<f64> {
    let tracer = Tracer::build(&mesh.positions, &mesh.triangles, &[]);
    let met = |ray: &Ray| tracer.closest(ray, &|_, _, _| true).map(|hit| mesh.triangles[hit.triangle as usize][0]);
    let seen: Vec<_> = (0..factors.len()).map(|v| rays_over(mesh, v).map(|ray| met(&ray))).collect();
    let bounce = |last: &[f64], sky: f64| -> Vec<f64> {
        let arriving = |met: &[Option<u32>]| {
            met.iter().map(|met| met.map_or(sky, |corner| last[corner as usize])).sum::<f64>() / met.len() as f64
        };
        factors.iter().zip(&seen).map(|(factor, met)| factor * arriving(met)).collect()
    };
    let mut last = bounce(&vec![0.0; factors.len()], 1.0);
    let mut sum = last.clone();
    for _ in 0..bounces {
        last = bounce(&last, 0.0);
        sum.iter_mut().zip(&last).for_each(|(sum, term)| *sum += term);
    }
    sum
}

/// Whether a ray from a point misses all triangles of a mesh.
pub(crate) fn escapes(mesh: &Mesh, origin: Vec3, direction: Vec3) -> bool {
    let corners = |t: &[u32; 3]| t.map(|i| mesh.positions[i as usize]);
    !mesh.triangles.iter().any(|t| meets(origin, direction, corners(t), LEAST_DETERMINANT).is_some())
}

/// A unit vector of a stream of random numbers.
pub(crate) fn random_direction(rng: &mut Rng) -> Vec3 {
    sampling::warp::square_to_uniform_sphere(rng.next_square()).xzy()
}
