//! A baked scene and the receivers of it that are compared.

use bake::{Receiver, Receivers};
use coeff_io::{Bounces, Prt, Quality, Settings};
use raytrace::{Ray, Tracer, offset_origin};
use sampling::frame::Frame;
use sampling::rng::Rng;
use sampling::warp::square_to_cosine_concentric;
use scene::Scene;
use std::ops::ControlFlow;

/// Rays that decide whether a receiver stands inside a body.
const PROBES: u32 = 256;
/// Share of the blocked rays that meet the insides of bodies from which a receiver counts as buried. The bake mends its
/// receivers from a share of one half on; between the two its estimate and this one may differ.
const BURIED: f32 = 0.4;

/// A scene, its bake, and the rows that are compared.
pub(crate) struct Subject {
    /// As loaded: the path tracer sees it before the bake splits large triangles.
    pub(crate) scene: Scene,
    /// The bake.
    pub(crate) prt: Prt,
    /// Row `r` of the transfer belongs to receiver `r`.
    receivers: Vec<Receiver>,
    /// Rows drawn at random from those whose values are their own, without repetition.
    pub(crate) rows: Vec<usize>,
    /// Rows drawn but left out: they stand inside bodies or have no normal.
    pub(crate) left_out: usize,
}

impl Subject {
    /// Bakes a scene and draws `count` receivers.
    pub(crate) fn bake(scene: Scene, bounces: Bounces, quality: Quality, count: usize) -> Self {
        Self::bake_with(scene, &Settings { bounces, quality, ..bake::settings::standard() }, count)
    }

    /// The same with settings of one's own.
    pub(crate) fn bake_with(scene: Scene, settings: &Settings, count: usize) -> Self {
        let prt = bake::bake(&scene, settings, &|_| ControlFlow::Continue(())).expect("the scene bakes");
        let all = Receivers::of(&bake::refine(&scene, settings).expect("the bake has split it before"));
        let receivers = all.list[..all.permanent].to_vec();
        assert_eq!(prt.geometry.positions.len(), receivers.len(), "rows of the transfer are the receivers, in order");
        let (rows, left_out) = draw(&scene, &receivers, count);
        Self { scene, prt, receivers, rows, left_out }
    }

    /// The compared receivers as the path tracer takes them.
    pub(crate) fn points(&self) -> Vec<reference::Receiver> {
        let point = |&row: &usize| {
            let r = &self.receivers[row];
            reference::Receiver {
                position: r.position,
                normal: r.normal,
                geometric_normal: r.geometric_normal,
                albedo: self.prt.transfer.albedo[row].into(),
            }
        };
        self.rows.iter().map(point).collect()
    }

    /// Area that a row stands for, square metres: a third of its triangles'.
    pub(crate) fn area(&self, row: usize) -> f64 {
        let geometry = &self.prt.geometry;
        let of = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| glam::Vec3::from(geometry.positions[v as usize]).as_dvec3());
            (b - a).cross(c - a).length() / 6.0
        };
        geometry.triangles.iter().filter(|t| t.contains(&(row as u32))).map(of).sum()
    }

    /// Outgoing radiance of a row under a light: albedo times transfer times light.
    pub(crate) fn radiance(&self, row: usize, light: &sh_math::Rgb) -> [f64; 3] {
        let transfer = &self.prt.transfer;
        let (n, channels) = ((transfer.bands * transfer.bands) as usize, transfer.channels as usize);
        let values = &transfer.values[row * n * channels..][..n * channels];
        std::array::from_fn(|c| {
            let term = |i: usize| f64::from(values[i * channels + c.min(channels - 1)]) * f64::from(light.values[i][c]);
            f64::from(transfer.albedo[row][c]) * (0..n).map(term).sum::<f64>()
        })
    }
}

/// A random subset of the receivers that can see, and how many were drawn that cannot.
fn draw(scene: &Scene, receivers: &[Receiver], count: usize) -> (Vec<usize>, usize) {
    let mut rng = Rng::new(1, 0);
    let mut order: Vec<usize> = (0..receivers.len()).collect();
    for k in (1..order.len()).rev() {
        order.swap(k, (rng.next_u64() % (k as u64 + 1)) as usize);
    }
    let bodies = Bodies::of(scene);
    let (mut rows, mut left_out) = (Vec::new(), 0);
    for row in order {
        if rows.len() == count {
            break;
        }
        if receivers[row].sound && !bodies.bury(&receivers[row], &mut rng) {
            rows.push(row);
        } else {
            left_out += 1;
        }
    }
    (rows, left_out)
}

/// The surfaces that stop light.
struct Bodies<'a> {
    scene: &'a Scene,
    tracer: Tracer,
    /// Mesh and triangle in it of each traced triangle.
    parts: Vec<[usize; 2]>,
}

impl<'a> Bodies<'a> {
    fn of(scene: &'a Scene) -> Self {
        let (mut positions, mut triangles, mut masked, mut parts) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for (m, mesh) in scene.meshes.iter().enumerate().filter(|(m, _)| scene.material(*m).blocks_rays()) {
            let first = positions.len() as u32;
            positions.extend_from_slice(&mesh.positions);
            triangles.extend(mesh.triangles.iter().map(|t| t.map(|corner| first + corner)));
            masked.extend(mesh.triangles.iter().map(|_| scene.material(m).is_masked()));
            parts.extend((0..mesh.triangles.len()).map(|t| [m, t]));
        }
        Self { scene, tracer: Tracer::build(&positions, &triangles, &masked), parts }
    }

    /// Whether a receiver sees mostly the insides of bodies.
    fn bury(&self, receiver: &Receiver, rng: &mut Rng) -> bool {
        let origin = offset_origin(receiver.position, receiver.geometric_normal);
        let frame = Frame::from_normal(receiver.normal);
        let solid = |t: u32, u: f32, v: f32| {
            let [mesh, triangle] = self.parts[t as usize];
            self.scene.coverage(mesh, triangle, u, v) > 0.0
        };
        let (mut blocked, mut inside) = (0.0, 0.0);
        for _ in 0..PROBES {
            let direction = frame.to_world(square_to_cosine_concentric(rng.next_square()));
            if let Some(hit) = self.tracer.closest(&Ray::new(origin, direction), &solid) {
                let body = !self.scene.material(self.parts[hit.triangle as usize][0]).double_sided;
                blocked += 1.0;
                inside += f32::from(u8::from(body && !hit.front));
            }
        }
        blocked > BURIED * PROBES as f32 && inside > BURIED * blocked
    }
}
