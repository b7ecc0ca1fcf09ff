//! Prints how many rays per second one thread traces, beside obvhs' own traversal on the same rays.
//!
//! `cargo run --release -p raytrace --example rates [SCENE...]`: files, or nothing for the scenes of the test data.
//! Work: any hit, then the nearest hit of those blocked, along 1,024 cosine-distributed directions from each of up to 1,024 vertices, in eight runs along
//! a Morton curve through them as a bake takes them. Times are CPU time where the system tells it.

#![expect(clippy::print_stdout, reason = "printing is its purpose")]

use glam::{Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::cwbvh::{CwBvh, builder::build_cwbvh_from_tris};
use obvhs::rt_triangle::RtTriangle;
use obvhs::triangle::Triangle;
use raytrace::{FanState, Level, Ray, Tracer, offset_origin};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Rounds of each kind; the median counts.
const ROUNDS: usize = 5;
const RECEIVERS: usize = 1_024;
const RUNS: usize = 8;
const SIDE: u32 = 32;
const PER_FAN: usize = (SIDE * SIDE) as usize;

/// Triangles, and vertices to trace from with their normals.
struct Soup {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

fn main() {
    let named: Vec<PathBuf> = std::env::args().skip(1).map(PathBuf::from).collect();
    let scenes = if named.is_empty() { data_scenes() } else { named };
    println!("levels {:?}, million rays per second on one thread, medians of {ROUNDS}", Level::available());
    println!("*any* and *nearest* are fans at each level, *one* is ray by ray, obvhs is its CWBVH");
    println!("| scene | triangles | build s | blocked | any | any, one | obvhs | nearest | nearest, one | obvhs |");
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for path in scenes {
        match scene::load(&path) {
            Ok(scene) => report(&path.file_stem().unwrap_or_default().to_string_lossy(), &Soup::of(&scene)),
            Err(error) => println!("{error}"),
        }
    }
}

/// Scenes of the test data: an open mesh, interiors, and a handful of triangles.
fn data_scenes() -> Vec<PathBuf> {
    let names = [
        "stanford-bunny/stanford-bunny.obj",
        "sponza/sponza.gltf",
        "house-lightmap-uv/house.glb",
        "pandora-level/pandora.obj",
        "teapot/teapot.obj",
        "cornell-box-lightmap-uv/CornellBox.glb",
    ];
    let folder = testkit::data_dir();
    folder.into_iter().flat_map(|folder| names.map(|name| folder.join("scenes").join(name))).collect()
}

impl Soup {
    fn of(scene: &scene::Scene) -> Soup {
        let mut soup = Soup { positions: vec![], normals: vec![], triangles: vec![] };
        for mesh in &scene.meshes {
            let first = soup.positions.len() as u32;
            soup.positions.extend(&mesh.positions);
            soup.normals.extend(&mesh.normals);
            soup.triangles.extend(mesh.triangles.iter().map(|corners| corners.map(|i| i + first)));
        }
        soup
    }

    /// Origins and normals of the receivers.
    fn receivers(&self) -> Vec<(Vec3, Vec3)> {
        let lower = self.positions.iter().copied().fold(Vec3::MAX, Vec3::min);
        let upper = self.positions.iter().copied().fold(Vec3::MIN, Vec3::max);
        let scale = 1_023.0 / (upper - lower).max_element();
        let mut order: Vec<usize> = (0..self.positions.len()).collect();
        order.sort_by_key(|&i| {
            let at = ((self.positions[i] - lower) * scale).as_uvec3();
            (0..10).fold(0u64, |key, bit| {
                let of = |x: u32| u64::from(x >> bit & 1);
                key | (of(at.x) | of(at.y) << 1 | of(at.z) << 2) << (3 * bit)
            })
        });
        let length = (RECEIVERS / RUNS).min(order.len() / RUNS + 1);
        let runs = (0..RUNS).flat_map(|run| order.iter().skip(order.len() * run / RUNS).take(length));
        let taken: Vec<usize> = runs.copied().collect();
        // Small scenes go round again, so that there is something to time.
        let round = taken.iter().cycle().take(RECEIVERS);
        round.map(|&i| (offset_origin(self.positions[i], self.normals[i]), self.normals[i])).collect()
    }
}

/// Cosine-distributed directions about +z by the concentric map, neighbours near each other.
fn hemisphere() -> Vec<Vec3> {
    let mut cells: Vec<(u32, u32)> = (0..SIDE * SIDE).map(|i| (i % SIDE, i / SIDE)).collect();
    let spread = |x: u32| (0..5).fold(0, |key, bit| key | (x >> bit & 1) << (2 * bit));
    cells.sort_by_key(|&(x, y)| spread(x) | spread(y) << 1);
    let direction = |&(x, y): &(u32, u32)| {
        let square = [(x as f32 + 0.37) / SIDE as f32, (y as f32 + 0.61) / SIDE as f32];
        sampling::warp::square_to_cosine_concentric(square)
    };
    cells.iter().map(direction).collect()
}

/// The directions of each receiver in world space.
fn rays(receivers: &[(Vec3, Vec3)]) -> [Vec<f32>; 3] {
    let local = hemisphere();
    let mut each = [vec![], vec![], vec![]];
    for &(_, normal) in receivers {
        let (x, y) = normal.any_orthonormal_pair();
        for d in &local {
            let world = (x * d.x + y * d.y + normal * d.z).normalize().to_array();
            each.iter_mut().zip(world).for_each(|(row, value)| row.push(value));
        }
    }
    each
}

/// Rays from receivers with the directions that are blocked.
struct Work {
    receivers: Vec<(Vec3, Vec3)>,
    directions: [Vec<f32>; 3],
    blocked: Vec<u64>,
}

impl Work {
    fn new(soup: &Soup, tracer: &Tracer) -> Work {
        let receivers = soup.receivers();
        let directions = rays(&receivers);
        let blocked = vec![0; directions[0].len() / 64];
        let mut work = Work { receivers, directions, blocked };
        let mut blocked = Vec::new();
        work.any(tracer, |bits| blocked.extend_from_slice(bits));
        work.blocked = blocked;
        work
    }

    fn ray(&self, i: usize) -> Ray {
        let [xs, ys, zs] = &self.directions;
        Ray::new(self.receivers[i / PER_FAN].0, Vec3::new(xs[i], ys[i], zs[i]))
    }

    /// Numbers of the rays that are blocked.
    fn blocked_rays(&self) -> Vec<usize> {
        (0..self.directions[0].len()).filter(|i| self.blocked[i / 64] >> (i % 64) & 1 == 1).collect()
    }

    fn fans(&self) -> impl Iterator<Item = (Vec3, [&[f32]; 3], &[u64])> {
        self.receivers.iter().enumerate().map(|(r, &(origin, _))| {
            let each = [0, 1, 2].map(|axis| &self.directions[axis][r * PER_FAN..(r + 1) * PER_FAN]);
            (origin, each, &self.blocked[r * PER_FAN / 64..(r + 1) * PER_FAN / 64])
        })
    }

    fn any(&self, tracer: &Tracer, mut take: impl FnMut(&[u64])) {
        let (mut state, mut bits) = (FanState::new(), vec![0u64; PER_FAN / 64]);
        for (origin, [xs, ys, zs], _) in self.fans() {
            tracer.occluded_fan(origin, xs, ys, zs, &|_, _, _| true, &mut state, &mut bits);
            take(&bits);
        }
    }

    fn nearest(&self, tracer: &Tracer) {
        let (mut state, mut hits) = (FanState::new(), vec![None; PER_FAN]);
        for (origin, [xs, ys, zs], wanted) in self.fans() {
            tracer.closest_fan(origin, xs, ys, zs, wanted, &|_, _, _| true, &mut state, &mut hits);
            std::hint::black_box(&hits);
        }
    }
}

fn report(name: &str, soup: &Soup) {
    let start = Instant::now();
    let tracer = Tracer::build(&soup.positions, &soup.triangles, &[]);
    let built = start.elapsed().as_secs_f64();
    let work = Work::new(soup, &tracer);
    let (bvh, corners) = peer(soup);
    let at = |level| Tracer::build(&soup.positions, &soup.triangles, &[]).at_level(level);
    let tracers: Vec<Tracer> = Level::available().into_iter().filter_map(at).collect();
    let (all, blocked): (Vec<usize>, _) = ((0..work.directions[0].len()).collect(), work.blocked_rays());
    let solid = |_, _, _| true;
    let mut any = vec![Vec::new(); tracers.len() + 2];
    let mut nearest = any.clone();
    for _ in 0..ROUNDS {
        for (k, tracer) in tracers.iter().enumerate() {
            any[k].push(timed(|| work.any(tracer, |bits| _ = std::hint::black_box(bits[0]))));
            nearest[k].push(timed(|| work.nearest(tracer)));
        }
        let k = tracers.len();
        any[k].push(timed(|| count(&all, |i| tracer.occluded(&work.ray(i), &solid))));
        any[k + 1].push(timed(|| count(&all, |i| peer_blocked(&bvh, &corners, &work.ray(i)))));
        nearest[k].push(timed(|| count(&blocked, |i| tracer.closest(&work.ray(i), &solid).is_some())));
        nearest[k + 1].push(timed(|| count(&blocked, |i| peer_nearest(&bvh, &corners, &work.ray(i)))));
    }
    println!(
        "| {name} | {} | {built:.2} | {:.0} % | {} | {} |",
        soup.triangles.len(),
        100.0 * blocked.len() as f64 / all.len() as f64,
        rates(any, all.len()),
        rates(nearest, blocked.len()),
    );
}

/// Million rays per second from the seconds of each kind: the levels in one cell, then the others.
fn rates(seconds: Vec<Vec<f64>>, rays: usize) -> String {
    let rate = |mut s: Vec<f64>| {
        s.sort_by(f64::total_cmp);
        format!("{:.2}", rays as f64 * 1.0e-6 / s[ROUNDS / 2])
    };
    let rates: Vec<String> = seconds.into_iter().map(rate).collect();
    let (levels, others) = rates.split_at(rates.len() - 2);
    format!("{} | {}", levels.join(" / "), others.join(" | "))
}

/// obvhs' best tree and its triangles in the tree's sequence.
fn peer(soup: &Soup) -> (CwBvh, Vec<RtTriangle>) {
    let corner = |i: u32| Vec3A::from(soup.positions[i as usize]);
    let triangle = |c: &[u32; 3]| Triangle { v0: corner(c[0]), v1: corner(c[1]), v2: corner(c[2]) };
    let triangles: Vec<Triangle> = soup.triangles.iter().map(triangle).collect();
    let bvh = build_cwbvh_from_tris(&triangles, BvhBuildParams::very_slow_build(), &mut Duration::default());
    let corners = bvh.primitive_indices.iter().map(|&i| RtTriangle::from(&triangles[i as usize])).collect();
    (bvh, corners)
}

fn peer_blocked(bvh: &CwBvh, corners: &[RtTriangle], ray: &Ray) -> bool {
    let ray = obvhs::ray::Ray::new_inf(ray.origin.into(), ray.direction.into());
    !bvh.ray_traverse_miss(ray, |ray, i| corners[i].intersect(ray))
}

fn peer_nearest(bvh: &CwBvh, corners: &[RtTriangle], ray: &Ray) -> bool {
    let ray = obvhs::ray::Ray::new_inf(ray.origin.into(), ray.direction.into());
    let mut hit = obvhs::ray::RayHit::none();
    bvh.ray_traverse(ray, &mut hit, |ray, i| corners[i].intersect(ray))
}

fn count(rays: &[usize], hit: impl Fn(usize) -> bool) {
    std::hint::black_box(rays.iter().filter(|&&i| hit(i)).count());
}

/// Seconds of CPU that this thread takes for some work.
fn timed(work: impl FnOnce()) -> f64 {
    let cpu = || {
        let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
        text.split(' ').next()?.parse::<f64>().ok()
    };
    let (wall, before) = (Instant::now(), cpu());
    work();
    match (before, cpu()) {
        (Some(before), Some(after)) => (after - before) * 1.0e-9,
        _ => wall.elapsed().as_secs_f64(),
    }
}
