//! Cuts edges where they come out of a body, at vertices inside it whose edges come out on sides that see differently.
//!
//! A vertex inside a body holds what its surface sees where it comes out. On a capital under a wall one edge comes out before the wall, in the
//! light, and another beside it, in the shade of an arch: one value cannot serve both, so each gets a vertex of its own. So does what comes out
//! between two bodies (a wall between a window frame and the awning above it): no vertex inside either tells how dark it is there.

use crate::Error;
use crate::cuts::Cuts;
use crate::gather::{Gatherer, Worker};
use crate::ledge::{self, sent_to};
use crate::passes::Monitor;
use crate::quick_look::QuickLook;
use crate::receivers::{FaceSums, Receiver};
use crate::repair::entry;
use crate::split::{Edge, edges, sorted};
use crate::world::{MOST_CROSSINGS, World};
use coeff_io::Settings;
use rayon::prelude::*;
use scene::{Mesh, Scene};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

/// Distance of what two exits see, against an open receiver's, from where each gets a vertex.
const DIFFERENT: f32 = 0.15;
/// The same for light of other surfaces at exits in the dark.
const DIM: f32 = 0.05;
/// Shortest part of an edge between two bodies that gets a vertex, over the edge.
const LEAST: f32 = 1.0 / 32.0;

/// What is looked for.
#[derive(Clone, Copy)]
enum Look {
    /// What comes out between two bodies.
    Gaps,
    /// Where edges come out to differing sights.
    Exits,
}

/// The scene with its edges cut at exits of bodies where that matters; `world` holds the same surfaces.
pub(crate) fn cut_at_exits<'a>(
    mut scene: Cow<'a, Scene>,
    world: &World<'_>,
    settings: &Settings,
    monitor: &Monitor<'_>,
) -> Result<Cow<'a, Scene>, Error> {
    if !world.bodies.any() {
        return Ok(scene);
    }
    let look = QuickLook::new();
    let bounces = ledge::matters(settings);
    let gatherer = look.gatherer(world);
    let mut inside = Vec::new();
    for mesh in &scene.meshes {
        inside.push(stuck(mesh, &gatherer));
        monitor.check()?;
    }
    // First what comes out between two bodies: to the vertices inside them that is one more way out.
    for look in [Look::Gaps, Look::Exits] {
        let mut cuts = Cuts::default();
        for (mesh, inside) in scene.meshes.iter().zip(&mut inside) {
            inside.resize(mesh.positions.len(), false);
            match look {
                Look::Gaps => add_gaps(mesh, inside, &gatherer, &mut cuts),
                Look::Exits => add_exits(mesh, inside, (&gatherer, bounces), &mut cuts),
            }
            monitor.check()?;
        }
        if !cuts.is_empty() {
            cuts.apply(scene.to_mut());
        }
    }
    Ok(scene)
}

/// Which vertices of a mesh stand inside bodies.
fn stuck(mesh: &Mesh, gatherer: &Gatherer<'_>) -> Vec<bool> {
    let faces = FaceSums::of(mesh);
    (0..mesh.positions.len())
        .into_par_iter()
        .map_init(Worker::new, |worker, v| is_stuck(gatherer, &faces.receiver(mesh, v), worker))
        .collect()
}

/// Finds edges from inside a body that come out and run into another.
fn add_gaps(mesh: &Mesh, inside: &[bool], gatherer: &Gatherer<'_>, cuts: &mut Cuts) {
    let faces = FaceSums::of(mesh);
    let is_inside = |v: u32| inside[v as usize];
    // An end inside comes first.
    let from_inside = |[a, b]: Edge| if is_inside(a) { [a, b] } else { [b, a] };
    let all = mesh.triangles.iter().flat_map(edges).map(sorted).map(from_inside);
    let ways: Vec<Edge> = all.filter(|edge| is_inside(edge[0])).collect::<BTreeSet<_>>().into_iter().collect();
    let found: Vec<Option<f32>> = ways
        .par_iter()
        .map_init(Worker::new, |worker, edge| {
            let [from, to] = edge.map(|v| faces.receiver(mesh, v as usize));
            let share = gap(gatherer.world, &from, &to, is_inside(edge[1]))?;
            let seen = gatherer.gather(&from.towards(&to, share), 0, worker);
            (!seen.finding().is_covered()).then_some(share)
        })
        .collect();
    ways.into_iter().zip(found).filter_map(|(edge, share)| Some((edge, share?))).for_each(|(edge, share)| {
        cuts.add(mesh, edge, share);
    });
}

/// The middle of the longest part of the way between two receivers that lies in the open, in shares of it, where the first is inside a body
/// and the part ends at bodies on both sides. Whether the last is inside one too is told.
fn gap(world: &World<'_>, from: &Receiver, to: &Receiver, is_to_inside: bool) -> Option<f32> {
    // Places where surfaces are met, and in how many more bodies the way is from there on than at its start.
    let (mut met, mut depth, mut crossings) = (Vec::new(), 0, 0);
    for hit in world.along(from.way_to(to)) {
        crossings += 1;
        if world.bodies.bound(hit.triangle) {
            depth += if hit.front { 1 } else { -1 };
            met.push((hit.t, depth));
        }
    }
    if crossings == MOST_CROSSINGS {
        return None;
    }
    let least = met.iter().map(|(_, depth)| *depth).min()?;
    if least >= 0 || !is_to_inside && depth != least {
        return None;
    }
    let parts = met.windows(2).filter(|pair| pair[0].1 == least).map(|pair| [pair[0].0, pair[1].0]);
    let [low, high] = parts.max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])))?;
    (high - low > LEAST).then_some(0.5 * (low + high))
}

/// Finds the exits of a mesh that are worth a vertex.
fn add_exits(mesh: &Mesh, inside: &[bool], (gatherer, bounces): (&Gatherer<'_>, bool), cuts: &mut Cuts) {
    let faces = FaceSums::of(mesh);
    let receiver = |v: usize| faces.receiver(mesh, v);
    let mut ways: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
    for [a, b] in mesh.triangles.iter().flat_map(edges) {
        for [from, to] in [[a, b], [b, a]] {
            if inside[from as usize] && !inside[to as usize] {
                ways.entry(from).or_default().insert(to);
            }
        }
    }
    let ways: Vec<(u32, BTreeSet<u32>)> = ways.into_iter().filter(|(_, out)| out.len() > 1).collect();
    let found: Vec<Vec<(Edge, f32)>> = ways
        .par_iter()
        .map_init(Worker::new, |worker, (from, out)| {
            let ends = out.iter().map(|&to| (to, receiver(to as usize)));
            exits(gatherer, &receiver(*from as usize), ends, bounces, worker)
                .into_iter()
                .map(|(to, share)| ([to, *from], share))
                .collect()
        })
        .collect();
    found.into_iter().flatten().for_each(|(edge, share)| cuts.add(mesh, edge, share));
}

/// Whether a receiver stands inside a body: three rays rule out most.
fn is_stuck(gatherer: &Gatherer<'_>, receiver: &Receiver, worker: &mut Worker) -> bool {
    if !receiver.sound || !gatherer.world.surrounds(receiver) {
        return false;
    }
    gatherer.gather(receiver, 0, worker).finding().is_inside()
}

/// The ends of ways out of a body with the shares of the ways from there to just before it, where these see differently.
fn exits(
    gatherer: &Gatherer<'_>,
    from: &Receiver,
    ends: impl Iterator<Item = (u32, Receiver)>,
    bounces: bool,
    worker: &mut Worker,
) -> Vec<(u32, f32)> {
    let mut found: Vec<(u32, f32, Receiver)> = Vec::new();
    for (to, end) in ends {
        let Some(share) = entry(gatherer.world, &end, from) else { continue };
        found.push((to, share, end.towards(from, share)));
    }
    if found.len() < 2 {
        return Vec::new();
    }
    let open = gatherer.bank.open_norm as f32;
    let looks: Vec<Vec<f32>> = found.iter().map(|one| gatherer.direct(&one.2, 0, worker).0.transfer).collect();
    let mut differ = differ(looks.iter().cloned(), DIFFERENT * open);
    if !differ && bounces && looks.iter().all(|look| norm(look.iter().copied()) < DIFFERENT * open) {
        // Where hardly any sky is seen, light of other surfaces is all there is.
        differ = self::differ(found.iter().map(|one| sent_to(gatherer, &one.2, worker)), DIM * open);
    }
    if differ { found.into_iter().map(|(to, share, _)| (to, share)).collect() } else { Vec::new() }
}

fn norm(look: impl Iterator<Item = f32>) -> f32 {
    look.map(|x| x * x).sum::<f32>().sqrt()
}

/// Whether some look is farther than that from the first; no more are taken than that asks for.
fn differ(mut looks: impl Iterator<Item = Vec<f32>>, least: f32) -> bool {
    let Some(first) = looks.next() else { return false };
    looks.any(|look| norm(look.iter().zip(&first).map(|(a, b)| a - b)) > least)
}
