//! Cuts edges where they come out of a body, at vertices inside it whose edges come out on sides that see differently.
//!
//! A vertex inside a body holds what its surface sees where it comes out. On a capital under a wall one edge comes out before the wall, in the
//! light, and another beside it, in the shade of an arch: one value cannot serve both, so each gets a vertex of its own.

use crate::directions::DirectionBank;
use crate::gather::{Gatherer, Worker};
use crate::passes::Monitor;
use crate::receivers::{FaceSums, Receiver};
use crate::repair::{entry, is_inside};
use crate::split::{Edge, EdgePlace as Place, cut, edge_place as place, edges, place_of};
use crate::world::World;
use crate::{Error, settings};
use coeff_io::{Quality, Settings};
use rayon::prelude::*;
use scene::{Mesh, Scene};
use sh_math::Bands;
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Bands and rays of the look from an exit, as those that find bends.
const BANDS: u32 = 3;
const RAYS: u32 = 64;
/// Distance of what two exits see, against an open receiver's, from where each gets a vertex.
const DIFFERENT: f32 = 0.15;
/// Shares along an edge are multiples of this: theirs and what is left of 1 are exact.
const STEPS: f32 = 4096.0;

/// Where an edge is cut: its ends by position, and the share of the way from the first.
type Cuts = HashMap<Place, f32>;

/// The scene with its edges cut at exits of bodies where that matters; `world` holds the same surfaces.
pub(crate) fn cut_at_exits<'a>(
    mut scene: Cow<'a, Scene>,
    world: &World<'_>,
    monitor: &Monitor<'_>,
) -> Result<Cow<'a, Scene>, Error> {
    if !world.bodies.any() {
        return Ok(scene);
    }
    let bands = Bands::new(BANDS).expect("a constant in range");
    let quality = Quality::Rays(RAYS);
    let bank = DirectionBank::new(bands, &Settings { bands: BANDS, quality, ..settings::standard() });
    let gatherer = Gatherer::of_direct_light(world, &bank, bands, quality);
    let mut cuts = Cuts::new();
    for mesh in &scene.meshes {
        add_cuts(mesh, &gatherer, &mut cuts);
        monitor.check()?;
    }
    if !cuts.is_empty() {
        for mesh in &mut scene.to_mut().meshes {
            cut(mesh, |mesh, edge| {
                let share = *cuts.get(&place(mesh, edge))?;
                Some(turned(mesh, edge, share))
            });
        }
    }
    Ok(scene)
}

/// Finds the exits of a mesh that are worth a vertex.
fn add_cuts(mesh: &Mesh, gatherer: &Gatherer<'_>, cuts: &mut Cuts) {
    let faces = FaceSums::of(mesh);
    let receiver = |v: usize| faces.receiver(mesh, v);
    let inside: Vec<bool> = (0..mesh.positions.len())
        .into_par_iter()
        .map_init(Worker::new, |worker, v| is_stuck(gatherer, &receiver(v), worker))
        .collect();
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
            exits(gatherer, &receiver(*from as usize), ends, worker)
                .into_iter()
                .map(|(to, share)| ([to, *from], share))
                .collect()
        })
        .collect();
    for ([to, from], share) in found.into_iter().flatten() {
        let share = (share * STEPS).round().clamp(1.0, STEPS - 1.0) / STEPS;
        cuts.entry(place(mesh, [to, from])).or_insert(turned(mesh, [to, from], share));
    }
}

/// A share of the way along an edge as its place counts it, which has the ends in an order of its own; and back.
fn turned(mesh: &Mesh, edge: Edge, share: f32) -> f32 {
    let [a, b] = edge.map(|v| place_of(mesh.positions[v as usize]));
    if a <= b { share } else { 1.0 - share }
}

/// Whether a receiver stands inside a body: three rays rule out most.
fn is_stuck(gatherer: &Gatherer<'_>, receiver: &Receiver, worker: &mut Worker) -> bool {
    if !receiver.sound || !gatherer.world.surrounds(receiver) {
        return false;
    }
    let seen = gatherer.gather(receiver, 0, worker);
    is_inside(seen.openness, seen.inside_share)
}

/// The ends of ways out of a body with the shares of the ways from there to just before it, where these see differently.
fn exits(
    gatherer: &Gatherer<'_>,
    from: &Receiver,
    ends: impl Iterator<Item = (u32, Receiver)>,
    worker: &mut Worker,
) -> Vec<(u32, f32)> {
    let mut found: Vec<(u32, f32, Vec<f32>)> = Vec::new();
    for (to, end) in ends {
        let Some(share) = entry(gatherer.world, &end, from) else { continue };
        let at = Receiver { position: end.position + share * (from.position - end.position), ..end };
        found.push((to, share, gatherer.direct(&at, 0, worker).0.transfer));
    }
    let differs = |a: &[f32], b: &[f32]| {
        let square: f32 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
        square.sqrt() > DIFFERENT * gatherer.bank.open_norm as f32
    };
    let any = found.iter().any(|one| differs(&one.2, &found[0].2));
    if any { found.into_iter().map(|(to, share, _)| (to, share)).collect() } else { Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// Meshes that share an edge cut it at the same place, also where one has -0 for 0 and has the ends the other way round.
    #[test]
    fn an_edge_is_cut_at_one_place() {
        let mesh = |x: f32| Mesh { positions: vec![Vec3::new(x, 0.0, 0.0), Vec3::X], ..Mesh::default() };
        assert_eq!(place(&mesh(0.0), [0, 1]), place(&mesh(-0.0), [1, 0]));
        let shares = [0.0, -0.0].map(|x| turned(&mesh(x), [0, 1], 0.25));
        assert_eq!(shares, [0.25; 2]);
        assert_eq!(turned(&mesh(-0.0), [1, 0], 0.75), 0.25);
        // Twin: by their bits the ends of the second would be the other way round.
        assert!((-0.0f32).to_bits() > 1.0f32.to_bits());
    }
}
