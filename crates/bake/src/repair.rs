//! Mends receivers that cannot see: inside geometry, or without a normal.

use crate::field::Field;
use crate::receivers::{NONE, Receiver, Receivers};
use crate::world::World;
use coeff_io::RepairCounts;
use glam::Vec3;
use rayon::prelude::*;
use scene::Scene;

/// More than this share of what a receiver sees being the insides of bodies means that it is inside one.
const INSIDE: f32 = 0.5;

/// Which receivers take the mean of which neighbours. In this order, later ones may draw on earlier ones.
#[derive(Debug, Default)]
pub(crate) struct Repair {
    targets: Vec<(u32, Vec<u32>)>,
    pub(crate) counts: RepairCounts,
}

/// What a look from a receiver tells of where it stands.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Finding {
    pub(crate) openness: f32,
    pub(crate) inside_share: f32,
    pub(crate) behind_share: f32,
}

impl Finding {
    /// Whether the receiver stands under a shell that hides it.
    pub(crate) fn is_hidden(self) -> bool {
        is_hidden(self.openness, self.behind_share)
    }

    /// Whether the receiver stands inside a body.
    pub(crate) fn is_inside(self) -> bool {
        is_inside(self.openness, self.inside_share)
    }

    /// Whether either is so: no view shows the receiver.
    pub(crate) fn is_covered(self) -> bool {
        self.is_inside() || self.is_hidden()
    }
}

/// Whether a receiver of this open share, which meets insides of bodies in this share of its blocked directions, stands
/// inside one.
pub(crate) fn is_inside(openness: f32, inside_share: f32) -> bool {
    openness < 0.5 && inside_share > INSIDE
}

/// Open share below which a point may be hidden.
const HIDDEN: f32 = 0.02;
/// More than this share of what a vertex sees being the backs of surfaces with one side means that it is: it is moved, which among leaves,
/// deep in which half of what is seen are backs, brings it into the light.
const BEHIND: f32 = 0.8;
/// The same for a texel: it takes the light of others only beside some that are seen.
const BEHIND_TEXEL: f32 = 0.5;

/// Whether a point of this open share, which meets backs of surfaces with one side in this share of its blocked directions, lies in the dark
/// under a shell that is drawn from its other side alone: no view shows it.
fn is_hidden(openness: f32, behind_share: f32) -> bool {
    openness < HIDDEN && behind_share > BEHIND
}

/// The same of a texel of a light map or a transfer texture.
pub(crate) fn is_hidden_texel(openness: f32, behind_share: f32) -> bool {
    openness < HIDDEN && behind_share > BEHIND_TEXEL
}

/// Share of the way to where an edge meets a body that a receiver is moved: just before it.
const BEFORE: f32 = 0.98;

/// For receivers inside bodies, or hidden under shells, with a sound neighbour: where the edge from there runs into the body. Seen from that
/// point the surface is as dark as it is along the line where it leaves the body, which the mean of the neighbours is not. What is drawn from
/// a hidden vertex to one that is seen would be too dark along the rim of the shell.
pub(crate) fn emerge(
    scene: &Scene,
    world: &World<'_>,
    receivers: &Receivers,
    findings: &[Finding],
) -> Vec<(u32, Vec3)> {
    if !findings.iter().any(|finding| finding.is_covered()) {
        return Vec::new();
    }
    let neighbours = Neighbours::of(scene, receivers);
    let stuck = |id: u32| findings[id as usize].is_covered() || !receivers.list[id as usize].sound;
    let way_out = |id: u32| {
        let sound = neighbours.around(id).iter().copied().filter(|&n| !stuck(n));
        let to = &receivers.list[id as usize];
        let body = |triangle| world.bodies.bound(triangle);
        let shell = |triangle| !world.is_two_sided(triangle);
        let covers: &dyn Fn(u32) -> bool = if findings[id as usize].is_inside() { &body } else { &shell };
        let points = sound.filter_map(|n| {
            let from = &receivers.list[n as usize];
            Some(from.position + entry_into(world, from, to, covers)? * (to.position - from.position))
        });
        let home = receivers.list[id as usize].vertex;
        points.min_by(|a, b| a.distance_squared(home).total_cmp(&b.distance_squared(home)))
    };
    let ids: Vec<u32> = (0..).zip(findings).filter(|(_, finding)| finding.is_covered()).map(|(id, _)| id).collect();
    ids.into_par_iter().filter_map(|id| way_out(id).map(|point| (id, point))).collect()
}

/// Share of the way from one receiver to another just before it runs into a body.
pub(crate) fn entry(world: &World<'_>, from: &Receiver, to: &Receiver) -> Option<f32> {
    entry_into(world, from, to, &|triangle| world.bodies.bound(triangle))
}

/// The same of the first front of a triangle that `covers` names.
fn entry_into(world: &World<'_>, from: &Receiver, to: &Receiver, covers: &dyn Fn(u32) -> bool) -> Option<f32> {
    let hit = world.along(from.way_to(to)).find(|hit| hit.front && covers(hit.triangle))?;
    Some(BEFORE * hit.t)
}

impl Repair {
    /// Finds broken receivers among those that go into the file, and sound neighbours for them.
    pub(crate) fn plan(scene: &Scene, receivers: &Receivers, findings: &[Finding]) -> Self {
        let mut repair = Self::default();
        let mut broken = vec![false; receivers.permanent];
        for (id, flag) in broken.iter_mut().enumerate() {
            let finding = findings[id];
            let inside = finding.is_inside();
            let unsound = !receivers.list[id].sound;
            repair.counts.bad_normals += u32::from(unsound);
            repair.counts.inside += u32::from(inside && !unsound);
            *flag = inside || unsound;
        }
        if broken.iter().any(|&b| b) {
            let neighbours = Neighbours::of(scene, receivers);
            repair.spread(&neighbours, &mut broken);
        }
        repair.counts.bad_normals += receivers.replaced_normals as u32;
        repair.counts.unrepaired = broken.iter().filter(|&&b| b).count() as u32;
        repair
    }

    /// Ring by ring, gives every broken receiver its neighbours that are sound by then.
    fn spread(&mut self, neighbours: &Neighbours, broken: &mut [bool]) {
        loop {
            let ring: Vec<(u32, Vec<u32>)> = (0..broken.len() as u32)
                .filter(|&id| broken[id as usize])
                .map(|id| {
                    let sound = neighbours.around(id).iter().copied().filter(|&n| !broken[n as usize]);
                    (id, sound.collect::<Vec<u32>>())
                })
                .filter(|(_, sources)| !sources.is_empty())
                .collect();
            if ring.is_empty() {
                return;
            }
            for (id, _) in &ring {
                broken[*id as usize] = false;
            }
            self.targets.extend(ring);
        }
    }

    /// Replaces the broken rows of a field.
    pub(crate) fn apply(&self, field: &mut Field) {
        for (target, sources) in &self.targets {
            let mut mean = vec![0.0f32; field.row_len()];
            for &source in sources {
                for (m, x) in mean.iter_mut().zip(field.row(source)) {
                    *m += x / sources.len() as f32;
                }
            }
            field.row_mut(*target).copy_from_slice(&mean);
        }
    }

    /// Replaces the broken ones of rows of so many numbers, which receivers have as `row_of` says.
    pub(crate) fn apply_rows(&self, rows: &mut [f32], len: usize, row_of: &dyn Fn(u32) -> Option<usize>) {
        for (target, sources) in &self.targets {
            let Some(target) = row_of(*target) else { continue };
            let sources: Vec<usize> = sources.iter().filter_map(|&source| row_of(source)).collect();
            if sources.is_empty() {
                continue;
            }
            for k in 0..len {
                let sum: f32 = sources.iter().map(|source| rows[source * len + k]).sum();
                rows[target * len + k] = sum / sources.len() as f32;
            }
        }
    }

    /// Replaces the broken values of one number per receiver.
    pub(crate) fn apply_scalar(&self, values: &mut [f32]) {
        for (target, sources) in &self.targets {
            let sum: f32 = sources.iter().map(|&s| values[s as usize]).sum();
            values[*target as usize] = sum / sources.len() as f32;
        }
    }

    /// Receivers whose values are not their own.
    pub(crate) fn targets(&self) -> impl Iterator<Item = u32> + '_ {
        self.targets.iter().map(|(id, _)| *id)
    }
}

/// Which receivers share an edge, as compressed rows.
struct Neighbours {
    starts: Vec<u32>,
    list: Vec<u32>,
}

impl Neighbours {
    fn of(scene: &Scene, receivers: &Receivers) -> Self {
        let mut edges: Vec<(u32, u32)> = Vec::new();
        let mut first = 0u32;
        for mesh in &scene.meshes {
            for triangle in &mesh.triangles {
                let ids = triangle.map(|v| v + first);
                for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (ids[i], ids[j])) {
                    edges.extend([(a, b), (b, a)]);
                    let (back_a, back_b) = (receivers.back_of[a as usize], receivers.back_of[b as usize]);
                    if back_a != NONE && back_b != NONE && (back_a.max(back_b) as usize) < receivers.permanent {
                        edges.extend([(back_a, back_b), (back_b, back_a)]);
                    }
                }
            }
            first += mesh.positions.len() as u32;
        }
        edges.sort_unstable();
        edges.dedup();
        let mut starts = vec![0u32; receivers.permanent + 1];
        for &(a, _) in &edges {
            starts[a as usize + 1] += 1;
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        Self { starts, list: edges.into_iter().map(|(_, b)| b).collect() }
    }

    fn around(&self, id: u32) -> &[u32] {
        &self.list[self.starts[id as usize] as usize..self.starts[id as usize + 1] as usize]
    }
}
