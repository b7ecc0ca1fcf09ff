//! Finds edges along which transfer bends: where what is seen from the middle is not the mean of what is seen from the ends.
//!
//! Interpolation errs there, in pictures and in bounces: a wall whose corners are lit is not lit behind the beam that leans
//! on it. A quick look (few bands, few rays, the same directions at all three points) tells.

use crate::Error;
use crate::gather::{Gatherer, Worker};
use crate::ledge;
use crate::passes::Monitor;
use crate::progress::Stage;
use crate::quick_look::QuickLook;
use crate::receivers::{FaceSums, Receiver};
use crate::split::{Edge, EdgePlace, edge_place, edges, sorted};
use crate::world::World;
use coeff_io::Settings;
use glam::Vec3;
use rayon::prelude::*;
use scene::{Mesh, Scene};
use std::collections::{BTreeMap, BTreeSet, HashSet};

/// Distance of the transfer in the middle from the mean of the ends', against an open receiver's, from where an edge bends:
/// the tenth part of it costs a house three times the receivers and gains no accuracy that bounces need.
const BEND: f32 = 0.15;
/// The same for edges that come out of a gap, under the foot of a cup: what is lit there is little, and a bend of it shows as much.
const BEND_AT_GAP: f32 = 0.08;
/// An end that sees less than this lies in a gap.
const HIDDEN: f32 = 0.02;
/// Ends farther apart than this, in bends that matter, can hide a step: where light ends at the middle of an edge, the middle may see the
/// mean of what the ends see, while a quarter is off by a quarter of their distance.
const STEP: f32 = 4.0;

/// What a point sees: transfer on the front and, for two-sided materials, on the back.
type Look = Vec<f32>;

/// The quick look at points of a scene.
pub(crate) struct Bends<'a> {
    world: &'a World<'a>,
    quick: QuickLook,
    /// Per mesh and vertex; empty where nothing was looked at yet.
    vertices: Vec<Vec<Look>>,
    /// Per mesh: edges that were looked at, with what their middle sees.
    middles: Vec<BTreeMap<Edge, Look>>,
    /// Whether light bounces, and may bend where that of the sky does not.
    bounces: bool,
    /// Per mesh: vertices whose triangles were asked about before.
    known: Vec<u32>,
}

impl<'a> Bends<'a> {
    /// For a scene that lies on the surfaces of `world`; looks at nothing yet.
    pub(crate) fn new(world: &'a World<'a>, scene: &Scene, settings: &Settings) -> Self {
        let bounces = ledge::matters(settings);
        let vertices = scene.meshes.iter().map(|mesh| vec![Look::new(); mesh.positions.len()]).collect();
        let (middles, known) = (vec![BTreeMap::new(); scene.meshes.len()], vec![0; scene.meshes.len()]);
        Self { world, quick: QuickLook::new(), vertices, middles, bounces, known }
    }

    /// The edges that `may_halve` names along which transfer bends, looking only at those that are new. It is told whether the edge is of a
    /// triangle that it was not asked about before.
    pub(crate) fn find(
        &mut self,
        scene: &Scene,
        may_halve: &dyn Fn(&Mesh, Edge, bool) -> bool,
        monitor: &Monitor<'_>,
    ) -> Result<HashSet<EdgePlace>, Error> {
        let mut bent = HashSet::new();
        let unseen: Vec<_> =
            scene.meshes.iter().enumerate().map(|(index, mesh)| self.unseen(index, mesh, may_halve)).collect();
        self.known = scene.meshes.iter().map(|mesh| mesh.positions.len() as u32).collect();
        let ends: Vec<BTreeSet<usize>> = unseen.iter().enumerate().map(|(index, new)| self.ends(index, new)).collect();
        // One count for all meshes: progress runs once from none to all.
        let total = unseen.iter().map(|new| new.len() as u64).chain(ends.iter().map(|e| e.len() as u64)).sum();
        monitor.begin(Stage::Refinement, total);
        for (index, (new, ends)) in unseen.into_iter().zip(ends).enumerate() {
            let mesh = &scene.meshes[index];
            if new.is_empty() {
                continue;
            }
            self.look_from_ends(scene, index, ends, (total, monitor))?;
            let extent = self.world.extents[index];
            let receivers: Vec<Receiver> =
                new.iter().map(|(edge, sums)| sums.receiver(mesh, *edge, 0.5).of_extent(extent)).collect();
            let looks = self.look(&receivers, two_sided(scene, index), (Some(total), monitor))?;
            let bend = self.bending(index, mesh, two_sided(scene, index), &new, (&receivers, &looks));
            let mut steep = Vec::new();
            for (((edge, sums), look), bends) in new.into_iter().zip(looks).zip(bend) {
                let (bend, threshold) = (self.bend(index, edge, 0.5, &look), self.threshold(index, edge));
                if bends {
                    bent.insert(edge_place(mesh, edge));
                } else if bend > threshold || self.rise(index, edge) > STEP * threshold {
                    steep.push(Steep { edge, sums, bend, threshold });
                }
                self.middles[index].insert(edge, look);
            }
            if !steep.is_empty() {
                let steps = self.steps(scene, index, steep, monitor)?;
                bent.extend(steps.into_iter().map(|edge| edge_place(mesh, edge)));
            }
        }
        Ok(bent)
    }

    /// Which edges of a mesh bend: in what is seen of the sky from their middles, or in the light of surfaces beside them.
    fn bending(
        &self,
        index: usize,
        mesh: &Mesh,
        two_sided: bool,
        new: &[(Edge, EdgeSums)],
        seen: (&[Receiver], &[Look]),
    ) -> Vec<bool> {
        let gatherer = self.gatherer();
        let sides = if two_sided { &[1.0, -1.0][..] } else { &[1.0] };
        let bends = |worker: &mut Worker, (((edge, _), receiver), look): ((&(Edge, EdgeSums), &Receiver), &Look)| {
            let ends = edge.map(|v| mesh.positions[v as usize]);
            let normals = || sides.iter().map(|side| side * receiver.geometric_normal);
            self.bend(index, *edge, 0.5, look) > BEND
                || self.bounces
                    && normals().any(|normal| ledge::fades(&gatherer, ends, (normal, receiver.rounding), worker))
        };
        new.par_iter().zip(seen.0).zip(seen.1).map_init(Worker::new, bends).collect()
    }

    fn gatherer(&self) -> Gatherer<'_> {
        self.quick.gatherer(self.world)
    }

    /// Of steep edges those along which light ends in a step that their middle hides, or that come out of a gap and bend a little.
    fn steps(
        &self,
        scene: &Scene,
        index: usize,
        mut steep: Vec<Steep>,
        monitor: &Monitor<'_>,
    ) -> Result<Vec<Edge>, Error> {
        let mesh = &scene.meshes[index];
        let faces = FaceSums::of(mesh);
        // An end inside a body takes its light from where it is moved to.
        steep.retain(|one| {
            one.threshold == BEND || one.edge.iter().all(|&v| !self.world.surrounds(&faces.receiver(mesh, v as usize)))
        });
        for share in [0.25, 0.75] {
            let unsure: Vec<usize> = (0..steep.len()).filter(|&k| steep[k].bend <= steep[k].threshold).collect();
            let at = |&k: &usize| steep[k].sums.receiver(mesh, steep[k].edge, share).of_extent(faces.extent);
            let receivers: Vec<Receiver> = unsure.iter().map(at).collect();
            let looks = self.look(&receivers, two_sided(scene, index), (None, monitor))?;
            for (k, look) in unsure.into_iter().zip(looks) {
                steep[k].bend = self.bend(index, steep[k].edge, share, &look);
            }
        }
        Ok(steep.into_iter().filter(|one| one.bend > one.threshold).map(|one| one.edge).collect())
    }

    /// Tells of vertices that took the middles of edges, in their order.
    pub(crate) fn halved(&mut self, mesh: usize, middles: impl IntoIterator<Item = (Edge, u32)>) {
        let mut new: Vec<(u32, Edge)> = middles.into_iter().map(|(edge, vertex)| (vertex, edge)).collect();
        new.sort_unstable();
        for (_, edge) in new {
            // Where there was none, one follows when it is asked for.
            let look = self.middles[mesh].remove(&edge).unwrap_or_default();
            self.vertices[mesh].push(look);
        }
    }

    /// The ends of edges from which nothing was looked at yet.
    fn ends(&self, index: usize, edges: &[(Edge, EdgeSums)]) -> BTreeSet<usize> {
        let looks = &self.vertices[index];
        let ends = edges.iter().flat_map(|(edge, _)| *edge).map(|v| v as usize);
        ends.filter(|&v| looks[v].is_empty()).collect()
    }

    /// Looks from vertices of a mesh.
    fn look_from_ends(
        &mut self,
        scene: &Scene,
        index: usize,
        ends: BTreeSet<usize>,
        watched: (u64, &Monitor<'_>),
    ) -> Result<(), Error> {
        let mesh = &scene.meshes[index];
        let faces = FaceSums::of(mesh);
        let receivers: Vec<Receiver> = ends.iter().map(|&v| faces.receiver(mesh, v)).collect();
        let new = self.look(&receivers, two_sided(scene, index), (Some(watched.0), watched.1))?;
        for (v, look) in ends.into_iter().zip(new) {
            self.vertices[index][v] = look;
        }
        Ok(())
    }

    fn unseen(
        &self,
        index: usize,
        mesh: &Mesh,
        may_halve: &dyn Fn(&Mesh, Edge, bool) -> bool,
    ) -> Vec<(Edge, EdgeSums)> {
        let mut sums: BTreeMap<Edge, EdgeSums> = BTreeMap::new();
        for triangle in &mesh.triangles {
            let new = triangle.iter().any(|&v| v >= self.known[index]);
            for edge in edges(triangle).map(sorted) {
                if may_halve(mesh, edge, new) && !self.middles[index].contains_key(&edge) {
                    sums.entry(edge).or_default().add(mesh, triangle);
                }
            }
        }
        sums.into_iter().collect()
    }

    /// How far the look from a share of the way along an edge is from the mean of the looks from its ends; the larger of both sides.
    fn bend(&self, mesh: usize, [a, b]: Edge, share: f32, look: &Look) -> f32 {
        let (a, b) = (&self.vertices[mesh][a as usize], &self.vertices[mesh][b as usize]);
        self.norm(look.iter().zip(a.iter().zip(b)).map(|(m, (a, b))| m - ((1.0 - share) * a + share * b)))
    }

    /// The bend from where an edge is halved.
    fn threshold(&self, mesh: usize, edge: Edge) -> f32 {
        let darker = edge.map(|v| self.norm(self.vertices[mesh][v as usize].iter().copied()));
        if darker[0].min(darker[1]) < HIDDEN { BEND_AT_GAP } else { BEND }
    }

    /// How far apart the looks from the ends of an edge are.
    fn rise(&self, mesh: usize, [a, b]: Edge) -> f32 {
        let (a, b) = (&self.vertices[mesh][a as usize], &self.vertices[mesh][b as usize]);
        self.norm(a.iter().zip(b).map(|(a, b)| a - b))
    }

    /// Norm of a difference of looks, against an open receiver's; the larger of both sides.
    fn norm(&self, difference: impl Iterator<Item = f32>) -> f32 {
        let difference: Vec<f32> = difference.collect();
        let norm = |side: &[f32]| side.iter().map(|x| x * x).sum::<f32>().sqrt();
        difference.chunks_exact(self.quick.bands.coefficients()).map(norm).fold(0.0, f32::max)
            / self.quick.bank.open_norm as f32
    }

    /// Looks from points; progress is told of those that it counts.
    fn look(
        &self,
        receivers: &[Receiver],
        two_sided: bool,
        (total, monitor): (Option<u64>, &Monitor<'_>),
    ) -> Result<Vec<Look>, Error> {
        let gatherer = self.gatherer();
        let one = |worker: &mut Worker, receiver: &Receiver| {
            let mut look = Look::new();
            if monitor.is_cancelled() {
                return look;
            }
            let mut rays = 0;
            for side in [Some(*receiver), two_sided.then(|| receiver.back())].into_iter().flatten() {
                // The same directions everywhere: what is far away shifts nothing from point to point.
                let (seen, _) = gatherer.direct(&side, 0, worker);
                rays += seen.visibility_rays;
                look.extend(seen.transfer);
            }
            if let Some(total) = total {
                monitor.receiver_done(Stage::Refinement, total, rays);
            }
            look
        };
        let looks = receivers.par_iter().map_init(Worker::new, one).collect();
        monitor.check()?;
        Ok(looks)
    }
}

/// An edge between ends that see very different things, or one of which sees next to nothing.
struct Steep {
    edge: Edge,
    sums: EdgeSums,
    bend: f32,
    threshold: f32,
}

fn two_sided(scene: &Scene, mesh: usize) -> bool {
    scene.materials[scene.meshes[mesh].material as usize].double_sided
}

/// Sums over the triangles on an edge.
#[derive(Default)]
struct EdgeSums {
    normal: Vec3,
    /// Area-weighted middle from the first vertex of the edge's first triangle on.
    centre: Vec3,
    area: f32,
    from: Option<Vec3>,
}

impl EdgeSums {
    fn add(&mut self, mesh: &Mesh, triangle: &[u32; 3]) {
        let [a, b, c] = triangle.map(|v| mesh.positions[v as usize]);
        let cross = (b - a).cross(c - a);
        let from = *self.from.get_or_insert(a);
        // Relative to a corner: far from the origin a sum of positions would lose digits.
        self.centre += cross.length() * ((a - from) + (b - from) + (c - from)) / 3.0;
        self.area += cross.length();
        self.normal += cross;
    }

    /// The receiver at a share of the way along the edge.
    fn receiver(&self, mesh: &Mesh, edge: Edge, share: f32) -> Receiver {
        let [a, b] = edge.map(|v| mesh.positions[v as usize]);
        let shares = [1.0 - share, share];
        let at = shares[0] * a + shares[1] * b;
        let shading = match mesh.normals.is_empty() {
            true => None,
            false => Some(edge.iter().zip(shares).map(|(&v, share)| share * mesh.normals[v as usize]).sum()),
        };
        let centre = match self.from {
            Some(from) if self.area > 0.0 => from + self.centre / self.area,
            _ => at,
        };
        Receiver::new(at, shading, self.normal, centre).0
    }
}
