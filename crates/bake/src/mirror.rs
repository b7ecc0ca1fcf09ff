//! Surfaces that shine as senders: what of the light they mirror towards a point that sees them.
//!
//! A mirror's own visibility is known at its vertices before anything else is baked. Of the light that falls on it straight it sends on what
//! its lobe takes (\[T\] section 4.2: apply the light, convolve with the BRDF, evaluate towards the receiver), for every coefficient of the
//! light. What other surfaces send it counts as their mean: the share of the lobe that they fill, times the mean of what they send.

use crate::directions::DirectionBank;
use crate::domain::{Domain, Judge};
use crate::error::Error;
use crate::gather::{Gathered, Gatherer, Worker};
use crate::hit::packed;
use crate::material;
use crate::passes::Monitor;
use crate::progress::Stage;
use crate::receivers::{NONE, Receivers, morton_order};
use crate::world::World;
use coeff_io::Settings;
use glam::Vec3;
use rayon::prelude::*;
use raytrace::Hit;
use scene::Scene;
use sh_math::brdf::{DIELECTRIC, environment_brdf};
use sh_math::lobe::{self, Lobe};
use sh_math::product::{Triple, triples};
use sh_math::{Bands, zonal};

/// Vertices that a thread takes at a time.
const CHUNK: usize = 64;
/// Most bands of gloss: the matrices of bounces have their fourth power.
pub(crate) const MOST_BANDS: u32 = 10;
/// Factor of a lobe, against that of its mean, below which nothing is seen of it.
const LEAST_FACTOR: f32 = 1e-3;
/// Share of what stands around a mirror below which nothing is worth knowing of it.
const LEAST_CLOSED: f32 = 0.02;

/// The surfaces that shine, as far as light on its way needs to know them.
pub(crate) struct Mirrors {
    /// Bands of visibility.
    pub(crate) bands: Bands,
    /// Per function of what arrives: its products of light and visibility.
    terms: Vec<Vec<Term>>,
    light: Bands,
    table: Vec<f32>,
    /// Of each vertex of the scene its row, or [`NONE`].
    row_of: Vec<u32>,
    /// `[row][coefficient]` over the sphere, world axes.
    visibility: Vec<f32>,
    /// Any-hit rays traced for it.
    pub(crate) rays: u64,
}

/// One triple product, small: a bake goes through all of them for every ray that meets a mirror.
#[derive(Debug, Clone, Copy)]
struct Term {
    light: u16,
    visibility: u16,
    value: f32,
}

/// What a mirror sends towards one point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Glance {
    /// Share of the lobe's light that is mirrored, RGB.
    pub(crate) tint: Vec3,
    /// Share of the lobe that other surfaces fill, over the share of the cosine lobe that they fill.
    pub(crate) closed: f32,
}

/// Bands of gloss where transfer has so many.
pub(crate) fn bands(transfer: Bands) -> Bands {
    transfer.min(Bands::new(MOST_BANDS).expect("few bands"))
}

/// Which materials of a scene shine.
pub(crate) fn shining(scene: &Scene) -> Vec<bool> {
    (0..scene.materials.len()).map(|m| material::Facts::of(scene, m).shines).collect()
}

impl Mirrors {
    /// Finds what the vertices of the surfaces that shine see.
    pub(crate) fn find(
        world: &World<'_>,
        receivers: &Receivers,
        settings: &Settings,
        transfer: Bands,
        monitor: &Monitor<'_>,
    ) -> Result<Self, Error> {
        let (scene, bands) = (world.scene, bands(transfer));
        let shines = shining(scene);
        let mut row_of = vec![NONE; receivers.vertices];
        let mut ids = Vec::new();
        let mut first = 0u32;
        for mesh in &scene.meshes {
            let n = mesh.positions.len() as u32;
            if shines[mesh.material as usize] {
                for vertex in first..first + n {
                    row_of[vertex as usize] = ids.len() as u32;
                    ids.push(vertex);
                }
            }
            first += n;
        }
        let judge = Judge::new(transfer, bands);
        let bank = DirectionBank::over(Domain::Hemisphere(judge), bands, settings);
        let gatherer = Gatherer { hits: false, mirrors: None, ..gatherer(world, &bank, bands, settings) };
        let (visibility, rays) = visibilities(&gatherer, receivers, &ids, monitor)?;
        let mut terms = vec![Vec::new(); bands.coefficients()];
        for Triple { a, b, c, value } in triples(bands, transfer, bands) {
            terms[a as usize].push(Term { light: b as u16, visibility: c as u16, value: value as f32 });
        }
        Ok(Self { bands, terms, light: transfer, table: lobe::table(Lobe::Ggx, bands), row_of, visibility, rays })
    }

    /// Bands of the light.
    pub(crate) fn light(&self) -> Bands {
        self.light
    }

    /// The row of a vertex of the scene, where it shines.
    pub(crate) fn row(&self, vertex: u32) -> Option<usize> {
        let row = self.row_of[vertex as usize];
        (row != NONE).then_some(row as usize)
    }

    /// Number of rows.
    pub(crate) fn rows(&self) -> usize {
        self.visibility.len() / self.bands.coefficients()
    }

    /// Visibility of a row.
    pub(crate) fn visibility(&self, row: usize) -> &[f32] {
        let n = self.bands.coefficients();
        &self.visibility[row * n..][..n]
    }

    /// What the surface that was hit mirrors back along a ray of unit direction: the factors of what arrives there, `n^2` numbers into `lobe`,
    /// and the rows of its corners with their shares; none where it does not shine, or is seen from behind.
    pub(crate) fn meet(&self, world: &World<'_>, hit: &Hit, direction: Vec3, lobe: &mut [f32]) -> Option<Met> {
        let corners = world.corners[hit.triangle as usize];
        if !hit.front || self.row_of[corners[0] as usize] == NONE {
            return None;
        }
        let (mesh, local) = world.locate(hit.triangle);
        let scene = world.scene;
        let normal = scene.meshes[mesh].normal(local, hit.u, hit.v);
        let back = -direction;
        let cosine = normal.dot(back);
        if cosine <= 0.0 {
            return None;
        }
        let mirrored = (2.0 * cosine * normal - back).normalize();
        let [metallic, roughness] = scene.shine(mesh, local, hit.u, hit.v);
        let base = scene.base_color(mesh, local, hit.u, hit.v).truncate();
        let facing = Vec3::splat(DIELECTRIC * (1.0 - metallic)) + base * metallic;
        let [scale, bias] = environment_brdf(roughness, cosine.min(1.0));
        let mut factors = [0.0; MOST_BANDS as usize];
        let factors = &mut factors[..self.bands.count()];
        lobe::read(&self.table, roughness, factors);
        // The mirror direction has the cosine of the view with the normal.
        let energy = lobe::open_energy(factors, cosine);
        sh_math::evaluate(self.bands, mirrored, lobe);
        for l in self.bands.degrees() {
            lobe[l * l..(l + 1) * (l + 1)].iter_mut().for_each(|value| *value *= factors[l] / energy);
        }
        let shares = [1.0 - hit.u - hit.v, hit.u, hit.v];
        Some(Met { tint: facing * scale + bias, normal, rows: corners.map(|c| self.row_of[c as usize]), shares })
    }

    /// Adds what surfaces that shine mirror towards a receiver that sees them, by direction and share.
    pub(crate) fn add_mirrored(
        &self,
        world: &World<'_>,
        (found, filters): (&[(Vec3, Hit, f32)], &[Vec3]),
        out: &mut Gathered,
    ) {
        let n = self.light.coefficients();
        let mut lobe = [0.0; (MOST_BANDS * MOST_BANDS) as usize];
        let lobe = &mut lobe[..self.bands.coefficients()];
        let mut row = vec![0.0f32; n];
        for (k, (direction, hit, weight)) in found.iter().enumerate() {
            let Some(met) = self.meet(world, hit, *direction, lobe) else { continue };
            let mut glance = self.glance(&met, lobe, &mut row);
            if let Some(filter) = filters.get(k) {
                glance.tint *= *filter;
            }
            out.glint.resize(3 * n, 0.0);
            for (sums, tint) in out.glint.chunks_exact_mut(n).zip((glance.tint * *weight).to_array()) {
                sums.iter_mut().zip(&row).for_each(|(sum, x)| *sum += tint * x);
            }
            if glance.closed > 0.0 {
                out.late.push(packed(world, hit, glance.tint * (glance.closed * weight), &out.near));
            }
        }
    }

    /// Writes what a mirror sends of light that falls on it straight, for tint 1 and every coefficient of the light; `lobe` is that of
    /// [`Mirrors::meet`].
    pub(crate) fn glance(&self, met: &Met, lobe: &[f32], out: &mut [f32]) -> Glance {
        let n = self.bands.coefficients();
        let mut seen = [0.0f32; (MOST_BANDS * MOST_BANDS) as usize];
        let seen = &mut seen[..n];
        for (row, share) in met.rows.into_iter().zip(met.shares) {
            let own = self.visibility(row as usize);
            seen.iter_mut().zip(own).for_each(|(sum, v)| *sum += share * v);
        }
        out.fill(0.0);
        let least = LEAST_FACTOR * lobe[0].abs();
        for (terms, factor) in self.terms.iter().zip(lobe).filter(|(_, factor)| factor.abs() > least) {
            for term in terms {
                out[term.light as usize] += factor * term.value * seen[term.visibility as usize];
            }
        }
        let open: f32 = lobe.iter().zip(&*seen).map(|(a, v)| a * v).sum();
        let mut cosine = [0.0f32; (MOST_BANDS * MOST_BANDS) as usize];
        zonal::cosine_transfer(self.bands, met.normal, &mut cosine[..n]);
        let diffuse: f32 = cosine.iter().zip(&*seen).map(|(c, v)| c * v).sum();
        let around = 1.0 - diffuse.clamp(0.0, 1.0);
        let closed = if around < LEAST_CLOSED { 0.0 } else { (1.0 - open.clamp(0.0, 1.0)) / around };
        Glance { tint: met.tint, closed }
    }
}

/// A mirror that a ray met.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Met {
    pub(crate) tint: Vec3,
    normal: Vec3,
    /// Of the corners, with their shares.
    pub(crate) rows: [u32; 3],
    pub(crate) shares: [f32; 3],
}

/// A gatherer over the hemisphere.
pub(crate) fn gatherer<'a>(
    world: &'a World<'a>,
    bank: &'a DirectionBank,
    bands: Bands,
    settings: &Settings,
) -> Gatherer<'a> {
    Gatherer {
        world,
        bank,
        bands,
        quality: settings.quality,
        visibility: true,
        hits: true,
        permanent: u32::MAX,
        worth: f32::INFINITY,
        mirrors: None,
    }
}

/// `[id][coefficient]` of what receivers see, and the rays that it took.
fn visibilities(
    gatherer: &Gatherer<'_>,
    receivers: &Receivers,
    ids: &[u32],
    monitor: &Monitor<'_>,
) -> Result<(Vec<f32>, u64), Error> {
    let total = ids.len() as u64;
    monitor.begin(Stage::Gloss, total);
    let (n, angle) = (gatherer.bands.coefficients(), gatherer.bank.domain.solid_angle() as f32);
    let order = morton_order(&receivers.list, ids.iter().copied());
    let chunks: Vec<Vec<(u32, Vec<f32>, u64)>> = order
        .par_chunks(CHUNK)
        .map_init(Worker::new, |worker, ids| {
            let mut out = Vec::with_capacity(ids.len());
            for &id in ids {
                if monitor.is_cancelled() {
                    break;
                }
                let (seen, _) = gatherer.direct(&receivers.list[id as usize], id, worker);
                monitor.receiver_done(Stage::Gloss, total, seen.visibility_rays);
                out.push((id, seen.transfer.iter().map(|v| v * angle).collect(), seen.visibility_rays));
            }
            out
        })
        .collect();
    monitor.check()?;
    let mut all: Vec<(u32, Vec<f32>, u64)> = chunks.into_iter().flatten().collect();
    all.sort_unstable_by_key(|(id, _, _)| *id);
    let rays = all.iter().map(|(_, _, rays)| rays).sum();
    debug_assert!(all.iter().all(|(_, row, _)| row.len() == n));
    Ok((all.into_iter().flat_map(|(_, row, _)| row).collect(), rays))
}
