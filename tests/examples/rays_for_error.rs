//! Prints how many rays a fixed number per receiver takes to reach the error that adaptive rays reach:
//! `rays_for_error [SCENE ...]`, after a city and foliage of its own; the last rows hold the receivers of all scenes together.
//!
//! Error: 95th percentile over receivers of |T - truth| against an open receiver's |T|; the truth has 65,536 rays and another seed.
//! "≤": the least number of fixed rays looked at is there already; "more": the largest is not.
//!
//! Below: what an oracle would take that knows beforehand how the error of each receiver falls and gives each the rays that it calls for.

#![expect(clippy::print_stdout, reason = "an example that prints a table")]

mod named;

use bake::{Sampled, sample};
use coeff_io::{Quality, Refine, Sampler, Settings};
use glam::Vec3;
use sampling::rng::Rng;
use scene::{Material, Mesh, Scene};
use std::error::Error;
use std::path::Path;

/// Receivers looked at in each scene.
const RECEIVERS: usize = 360;
/// Errors asked of the adaptive bake.
const ASKED: [f32; 2] = [0.01, 0.008];

fn main() -> Result<(), Box<dyn Error>> {
    let names: Vec<String> = std::env::args().skip(1).collect();
    let mut scenes = vec![city(), foliage()];
    for name in &names {
        let mut scene = named::scene(name)?;
        scene.name = Path::new(name).file_stem().map_or(name.clone(), |stem| stem.to_string_lossy().into_owned());
        scenes.push(scene);
    }
    println!(
        "| scene | asked | 95 % of errors below | rays | fixed Owen-Sobol | ratio | fixed jittered sphere | ratio |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let mut all = Curves::default();
    let mut reached = Vec::new();
    for scene in &scenes {
        let truth = look(scene, Sampler::OwenSobol, Quality::Rays(1 << 16), 1000)?;
        let curves = Curves::of(scene, &truth)?;
        curves.print(&scene.name);
        reached.push((scene, truth, curves.asked[0].summary()[0]));
        all.add(curves);
    }
    all.print("all together");
    println!("\n| scene | 95 % of errors below | oracle, Owen-Sobol | oracle, Fibonacci lattice |");
    println!("|---|---|---|---|");
    for (scene, truth, error) in reached {
        let [sobol, lattice] =
            [Sampler::OwenSobol, Sampler::Fibonacci].map(|sampler| oracle(scene, sampler, &truth, error));
        println!("| {} | {error:.4} | {:.0} | {:.0} |", scene.name, sobol?, lattice?);
    }
    Ok(())
}

/// Receivers judged against the truth, at every quality looked at.
#[derive(Default)]
struct Curves {
    /// For each error asked for.
    asked: Vec<Judged>,
    /// For each power of two of fixed rays.
    sobol: Vec<Judged>,
    stratified: Vec<Judged>,
}

impl Curves {
    fn of(scene: &Scene, truth: &[Sampled]) -> Result<Self, Box<dyn Error>> {
        if truth.is_empty() {
            return Err(format!("{}: no receiver needs rays, so there is nothing to judge", scene.name).into());
        }
        let judge = |sampler, quality| -> Result<Judged, bake::Error> {
            Ok(Judged::of(&look(scene, sampler, quality, 1)?, truth))
        };
        let fixed = |sampler| (7..=16).map(|power| judge(sampler, Quality::Rays(1 << power))).collect::<Result<_, _>>();
        let asked = ASKED.map(|error| judge(Sampler::OwenSobol, Quality::Error(error)));
        Ok(Self {
            asked: asked.into_iter().collect::<Result<_, _>>()?,
            sobol: fixed(Sampler::OwenSobol)?,
            stratified: fixed(Sampler::Stratified)?,
        })
    }

    fn add(&mut self, other: Self) {
        let lists = [(&mut self.asked, other.asked), (&mut self.sobol, other.sobol)];
        for (all, more) in lists.into_iter().chain([(&mut self.stratified, other.stratified)]) {
            all.resize_with(more.len(), Judged::default);
            all.iter_mut().zip(more).for_each(|(all, more)| all.0.extend(more.0));
        }
    }

    fn print(&self, name: &str) {
        for (asked, judged) in ASKED.into_iter().zip(&self.asked) {
            let [error, rays] = judged.summary();
            let tell =
                |curve: &[Judged]| rays_at(&curve.iter().map(Judged::summary).collect::<Vec<_>>(), error).cells(rays);
            let ([a, ra], [b, rb]) = (tell(&self.sobol), tell(&self.stratified));
            println!("| {name} | {asked} | {error:.4} | {rays:.0} | {a} | {ra} | {b} | {rb} |");
        }
    }
}

/// True error and rays of receivers.
#[derive(Default)]
struct Judged(Vec<[f64; 2]>);

impl Judged {
    fn of(judged: &[Sampled], truth: &[Sampled]) -> Self {
        let bands = sh_math::Bands::new(bake::settings::standard().bands).expect("the standard settings are in range");
        let mut lobe = vec![0.0f32; bands.coefficients()];
        sh_math::zonal::cosine_transfer(bands, Vec3::Z, &mut lobe);
        let open = norm(lobe.iter().copied());
        let error = |a: &Sampled, b: &Sampled| norm(a.transfer.iter().zip(&b.transfer).map(|(x, y)| x - y)) / open;
        Self(judged.iter().zip(truth).map(|(a, b)| [error(a, b), a.rays as f64]).collect())
    }

    /// 95th percentile of the error, and mean rays.
    fn summary(&self) -> [f64; 2] {
        let mut errors: Vec<f64> = self.0.iter().map(|j| j[0]).collect();
        errors.sort_by(f64::total_cmp);
        [errors[errors.len() * 95 / 100], self.0.iter().map(|j| j[1]).sum::<f64>() / self.0.len() as f64]
    }
}

fn look(scene: &Scene, sampler: Sampler, quality: Quality, seed: u64) -> Result<Vec<Sampled>, bake::Error> {
    sample(scene, &Settings { sampler, quality, seed, refine: Refine::Off, ..bake::settings::standard() }, RECEIVERS)
}

/// Power of the number of rays by which errors are taken to fall.
const DECAY: f64 = 0.65;

/// Mean rays of receivers that each take what their own errors at twelve fixed numbers call for, where 95 % of the errors come down to
/// `error`.
fn oracle(scene: &Scene, sampler: Sampler, truth: &[Sampled], error: f64) -> Result<f64, bake::Error> {
    let counts: Vec<u32> = (9..=14).flat_map(|power| [1 << power, (1 << power) * 17 / 12]).collect();
    let judge = |&count: &u32| Ok(Judged::of(&look(scene, sampler, Quality::Rays(count), 7)?, truth));
    let judged: Vec<Judged> = counts.iter().map(judge).collect::<Result<_, bake::Error>>()?;
    let scaled = |receiver: usize, k: usize| judged[k].0[receiver][0] * f64::from(counts[k]).powf(DECAY);
    let amplitude = |receiver: usize| {
        let squares: f64 = (0..counts.len()).map(|k| scaled(receiver, k).powi(2)).sum();
        (squares / counts.len() as f64).sqrt()
    };
    let amplitudes: Vec<f64> = (0..truth.len()).map(amplitude).collect();
    let rays =
        |receiver: usize, tolerance: f64| (amplitudes[receiver] / tolerance).powf(1.0 / DECAY).clamp(128.0, 16384.0);
    // The error that was seen at the nearest of the numbers, brought to the one that is taken.
    let at = |receiver: usize, tolerance: f64| {
        let rays = rays(receiver, tolerance);
        let away = |k: usize| (f64::from(counts[k]) / rays).ln().abs();
        let nearest = (0..counts.len()).min_by(|a, b| away(*a).total_cmp(&away(*b))).expect("twelve");
        scaled(receiver, nearest) * rays.powf(-DECAY)
    };
    let worst = |tolerance: f64| {
        let mut errors: Vec<f64> = (0..truth.len()).map(|receiver| at(receiver, tolerance)).collect();
        errors.sort_by(f64::total_cmp);
        errors[errors.len() * 95 / 100]
    };
    let tolerances = (10..400).map(|k| f64::from(k) * 1e-4 * 0.5);
    let loosest = tolerances.filter(|&tolerance| worst(tolerance) <= error).fold(0.0005, f64::max);
    Ok((0..truth.len()).map(|receiver| rays(receiver, loosest)).sum::<f64>() / truth.len() as f64)
}

fn norm(values: impl Iterator<Item = f32>) -> f64 {
    values.map(|x| f64::from(x).powi(2)).sum::<f64>().sqrt()
}

/// Where a curve reaches an error.
enum Reached {
    /// Its first point is there already: as many rays or fewer.
    AtMost(f64),
    At(f64),
    /// No point is.
    More,
}

impl Reached {
    /// The rays, and how many times `rays` they are.
    fn cells(&self, rays: f64) -> [String; 2] {
        match self {
            Self::AtMost(n) => [format!("≤ {n:.0}"), format!("≤ {:.1}", n / rays)],
            Self::At(n) => [format!("{n:.0}"), format!("{:.1}", n / rays)],
            Self::More => ["more".into(), "-".into()],
        }
    }
}

/// Where a curve of [error, rays] comes down to an error, between its points along a power law.
fn rays_at(curve: &[[f64; 2]], error: f64) -> Reached {
    match curve.iter().position(|point| point[0] <= error) {
        None => Reached::More,
        Some(0) => Reached::AtMost(curve[0][1]),
        Some(i) => {
            let [[e0, n0], [e1, n1]] = [curve[i - 1], curve[i]];
            Reached::At(n0 * (n1 / n0).powf((e0 / error).ln() / (e0 / e1).ln()))
        }
    }
}

/// A block of streets: boxes of 10 to 60 m on a ground of 300 m.
fn city() -> Scene {
    let mut rng = Rng::new(7, 0);
    let mut mesh = ground(150.0, 60);
    for i in 0..144 {
        let corner = Vec3::new((i % 12) as f32 * 20.0 - 120.0, 0.0, (i / 12) as f32 * 20.0 - 120.0);
        add_box(&mut mesh, corner, Vec3::new(13.0, 10.0 + 50.0 * rng.next_f32(), 13.0), 4);
    }
    finished("city", mesh)
}

/// 6,000 leaves of 5 cm over a ground of 2 m.
fn foliage() -> Scene {
    let mut rng = Rng::new(8, 0);
    let mut mesh = ground(1.0, 60);
    for _ in 0..6000 {
        let mut vector = || Vec3::new(rng.next_f32(), rng.next_f32(), rng.next_f32()) - 0.5;
        let (middle, a, b) = (vector() * Vec3::new(2.0, 0.8, 2.0) + Vec3::Y * 0.6, vector() * 0.1, vector() * 0.1);
        let first = mesh.positions.len() as u32;
        mesh.positions.extend([middle, middle + a, middle + b]);
        mesh.normals.extend([a.cross(b).normalize_or(Vec3::Y); 3]);
        mesh.triangles.push([first, first + 1, first + 2]);
    }
    finished("foliage", mesh)
}

fn finished(name: &str, mesh: Mesh) -> Scene {
    let material = Material { double_sided: true, ..Material::default() };
    Scene { name: name.into(), meshes: vec![mesh], materials: vec![material], ..Scene::default() }
}

fn ground(half: f32, cells: u32) -> Mesh {
    let mut mesh = Mesh::default();
    add_grid(&mut mesh, Vec3::new(-half, 0.0, half), Vec3::X * 2.0 * half, Vec3::Z * -2.0 * half, cells);
    mesh
}

fn add_box(mesh: &mut Mesh, low: Vec3, size: Vec3, cells: u32) {
    let [x, y, z] = [Vec3::X * size.x, Vec3::Y * size.y, Vec3::Z * size.z];
    for (corner, along, across) in
        [(low, y, x), (low, z, y), (low + size, -x, -y), (low + size, -y, -z), (low + size, -z, -x)]
    {
        add_grid(mesh, corner, along, across, cells);
    }
}

fn add_grid(mesh: &mut Mesh, corner: Vec3, along: Vec3, across: Vec3, cells: u32) {
    let (first, n) = (mesh.positions.len() as u32, cells + 1);
    for i in 0..n * n {
        mesh.positions
            .push(corner + along * ((i % n) as f32 / cells as f32) + across * ((i / n) as f32 / cells as f32));
        mesh.normals.push(along.cross(across).normalize());
    }
    for k in 0..cells * cells {
        let a = first + (k % cells) + (k / cells) * n;
        mesh.triangles.extend([[a, a + 1, a + n + 1], [a, a + n + 1, a + n]]);
    }
}
