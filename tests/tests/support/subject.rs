//! A baked scene and the receivers of it that are compared.

use super::solids::Solids;
use bake::{Receiver, Receivers};
use coeff_io::{Bounces, Prt, Quality, Settings};
use sampling::rng::Rng;
use scene::Scene;
use std::collections::BTreeMap;
use std::ops::ControlFlow;

/// Halvings by which the place is found where a surface comes out of a body.
const HALVINGS: u32 = 10;

/// A scene, its bake, and the rows that are compared.
pub(crate) struct Subject {
    /// As loaded: the path tracer sees it before the bake splits large triangles.
    pub(crate) scene: Scene,
    /// The bake.
    pub(crate) prt: Prt,
    /// Rows drawn at random, without repetition, with the places where they show.
    pub(crate) spots: Vec<Spot>,
    /// How many of them stand inside bodies, and are compared where their surface comes out.
    pub(crate) moved: usize,
    /// Rows drawn beside them that show nowhere: neither they nor any neighbour stands outside of bodies.
    pub(crate) buried: usize,
    /// Rows drawn that have no normal, nor their triangles an area.
    pub(crate) flat: usize,
}

/// A place where a row of the transfer shows.
pub(crate) struct Spot {
    pub(crate) row: usize,
    /// Rows between which the renderers interpolate there, with their shares.
    shares: Vec<(usize, f64)>,
    at: Receiver,
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
        assert_eq!(prt.geometry.positions.len(), all.permanent, "rows of the transfer are the receivers, in order");
        let mut subject = Self { scene, prt, spots: Vec::new(), moved: 0, buried: 0, flat: 0 };
        subject.draw(&all, count);
        subject
    }

    /// The compared receivers as the path tracer takes them.
    pub(crate) fn points(&self) -> Vec<reference::Receiver> {
        let point = |Spot { row, at, .. }: &Spot| reference::Receiver {
            position: at.position,
            normal: at.normal,
            geometric_normal: at.geometric_normal,
            albedo: self.prt.transfer.albedo[*row].into(),
        };
        self.spots.iter().map(point).collect()
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

    /// Outgoing radiance at a place under a light: albedo of its row times transfer times light.
    pub(crate) fn radiance(&self, spot: &Spot, light: &sh_math::Rgb) -> [f64; 3] {
        let transfer = &self.prt.transfer;
        let (n, channels) = ((transfer.bands * transfer.bands) as usize, transfer.channels as usize);
        let of_row = |row: usize, c: usize| {
            let values = &transfer.values[row * n * channels..][..n * channels];
            let term = |i: usize| f64::from(values[i * channels + c.min(channels - 1)]) * f64::from(light.values[i][c]);
            (0..n).map(term).sum::<f64>()
        };
        let albedo = transfer.albedo[spot.row].map(f64::from);
        [0, 1, 2].map(|c| albedo[c] * spot.shares.iter().map(|&(row, share)| share * of_row(row, c)).sum::<f64>())
    }

    /// Draws a random subset of all receivers.
    fn draw(&mut self, all: &Receivers, count: usize) {
        let mut rng = Rng::new(1, 0);
        let mut order: Vec<usize> = (0..all.permanent).collect();
        for k in (1..order.len()).rev() {
            order.swap(k, (rng.next_u64() % (k as u64 + 1)) as usize);
        }
        let neighbours = neighbours(all.permanent, &self.prt.geometry.triangles);
        let solids = Solids::of(&self.scene);
        for row in order {
            if self.spots.len() == count {
                break;
            }
            let receiver = all.list[row];
            if !receiver.sound {
                self.flat += 1;
            } else if !solids.bury(&receiver, &mut rng) {
                self.spots.push(Spot { row, shares: vec![(row, 1.0)], at: receiver });
            } else if let Some(spot) = come_out(&solids, all, row, &neighbours[row], &mut rng) {
                self.spots.push(spot);
                self.moved += 1;
            } else {
                self.buried += 1;
            }
        }
    }
}

/// The rows that share an edge with each.
fn neighbours(rows: usize, triangles: &[[u32; 3]]) -> Vec<Vec<usize>> {
    let mut found = vec![Vec::new(); rows];
    for &[a, b, c] in triangles {
        for [a, b] in [[a, b], [b, c], [c, a]].map(|edge| edge.map(|row| row as usize)) {
            found[a].push(b);
            found[b].push(a);
        }
    }
    for list in &mut found {
        list.sort_unstable();
        list.dedup();
    }
    found
}

/// The place nearest to a row inside a body where an edge to a neighbour outside comes out of it.
fn come_out(solids: &Solids<'_>, all: &Receivers, row: usize, around: &[usize], rng: &mut Rng) -> Option<Spot> {
    let inside = all.list[row];
    let mut places: BTreeMap<u32, Spot> = BTreeMap::new();
    for &other in around {
        let end = all.list[other];
        if !end.sound || solids.bury(&end, rng) {
            continue;
        }
        let way = inside.position - end.position;
        let at = |share: f32| Receiver { position: end.position + share * way, ..end };
        let (mut free, mut buried) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (free + buried);
            if solids.bury(&at(middle), rng) { buried = middle } else { free = middle }
        }
        let shares = vec![(other, 1.0 - f64::from(free)), (row, f64::from(free))];
        // Distances are not negative, so that their bits are in their order.
        let distance = (1.0 - free) * way.length();
        places.entry(distance.to_bits()).or_insert(Spot { row, shares, at: at(free) });
    }
    places.into_values().next()
}
