//! A baked scene and the receivers of it that are compared.

use super::solids::Solids;
use bake::{Receiver, Receivers};
use coeff_io::{Bounces, Prt, Quality, Settings};
use glam::Vec3;
use sampling::rng::Rng;
use scene::Scene;
use std::ops::ControlFlow;

/// Places at which a row is compared that does not show itself.
const PLACES: usize = 4;
/// Places that are drawn on its triangles before it counts as buried.
const TRIES: usize = 256;

/// A scene, its bake, and the rows that are compared.
pub(crate) struct Subject {
    /// As loaded: the path tracer sees it before the bake splits large triangles.
    pub(crate) scene: Scene,
    /// The bake.
    pub(crate) prt: Prt,
    /// Rows drawn at random, without repetition, with the places where they show.
    pub(crate) spots: Vec<Spot>,
    /// How many of them are hidden, and are compared at what shows of their triangles.
    pub(crate) moved: usize,
    /// Rows drawn beside them that show nowhere: no place on their triangles does.
    pub(crate) buried: usize,
    /// Rows drawn that have no normal, nor their triangles an area.
    pub(crate) flat: usize,
}

/// Where a row of the transfer shows.
pub(crate) struct Spot {
    pub(crate) row: usize,
    /// The row itself, or some places drawn on its triangles; their mean is compared.
    pub(crate) places: Vec<Place>,
}

/// A place on a surface.
pub(crate) struct Place {
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
        let (mut subject, all) = Self::bake_all(scene, settings);
        subject.draw(&all, (0..all.permanent).collect(), count);
        subject
    }

    /// Bakes a scene and takes all receivers within a box, and one place on each triangle that has a corner there.
    pub(crate) fn bake_within(scene: Scene, settings: &Settings, [low, high]: [Vec3; 2]) -> Self {
        let (mut subject, all) = Self::bake_all(scene, settings);
        let is_within = |&row: &usize| all.list[row].vertex.cmpge(low).all() && all.list[row].vertex.cmple(high).all();
        let rows: Vec<usize> = (0..all.permanent).filter(is_within).collect();
        let count = rows.len();
        subject.draw(&all, rows, count);
        subject.spots.extend(subject.between(&is_within));
        subject
    }

    fn bake_all(scene: Scene, settings: &Settings) -> (Self, Receivers) {
        let prt = bake::bake(&scene, settings, &|_| ControlFlow::Continue(())).expect("the scene bakes");
        let all = Receivers::of(&bake::refine(&scene, settings).expect("the bake has split it before"));
        assert_eq!(prt.geometry.positions.len(), all.permanent, "rows of the transfer are the receivers, in order");
        (Self { scene, prt, spots: Vec::new(), moved: 0, buried: 0, flat: 0 }, all)
    }

    /// The compared places as the path tracer takes them, spot after spot.
    pub(crate) fn points(&self) -> Vec<reference::Receiver> {
        let points = |spot: &Spot| {
            let albedo = self.prt.transfer.albedo[spot.row].into();
            let point = |Place { at, .. }: &Place| reference::Receiver {
                position: at.position,
                normal: at.normal,
                geometric_normal: at.geometric_normal,
                albedo,
            };
            spot.places.iter().map(point).collect::<Vec<_>>()
        };
        self.spots.iter().flat_map(points).collect()
    }

    /// Area that a row stands for, square metres: a third of its triangles'.
    pub(crate) fn area(&self, row: usize) -> f64 {
        let geometry = &self.prt.geometry;
        let of = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| Vec3::from(geometry.positions[v as usize]).as_dvec3());
            (b - a).cross(c - a).length() / 6.0
        };
        geometry.triangles.iter().filter(|t| t.contains(&(row as u32))).map(of).sum()
    }

    /// Outgoing radiance of a spot under a light, as drawn: albedo of its row times transfer times light.
    pub(crate) fn radiance(&self, spot: &Spot, light: &sh_math::Rgb) -> [f64; 3] {
        let transfer = &self.prt.transfer;
        let (n, channels) = ((transfer.bands * transfer.bands) as usize, transfer.channels as usize);
        let of_row = |row: usize, c: usize| {
            let values = &transfer.values[row * n * channels..][..n * channels];
            let term = |i: usize| f64::from(values[i * channels + c.min(channels - 1)]) * f64::from(light.values[i][c]);
            (0..n).map(term).sum::<f64>()
        };
        let albedo = transfer.albedo[spot.row].map(f64::from);
        let at = |place: &Place, c| place.shares.iter().map(|&(row, share)| share * of_row(row, c)).sum::<f64>();
        let mean = |c| spot.places.iter().map(|place| at(place, c)).sum::<f64>() / spot.places.len() as f64;
        [0, 1, 2].map(|c| albedo[c] * mean(c))
    }

    /// Draws a random subset of receivers.
    fn draw(&mut self, all: &Receivers, mut order: Vec<usize>, count: usize) {
        let mut rng = Rng::new(1, 0);
        for k in (1..order.len()).rev() {
            order.swap(k, (rng.next_u64() % (k as u64 + 1)) as usize);
        }
        let solids = Solids::of(&self.scene);
        for row in order {
            if self.spots.len() == count {
                break;
            }
            let receiver = all.list[row];
            if !receiver.sound {
                self.flat += 1;
            } else if solids.shows(&receiver, &mut rng) {
                let places = vec![Place { shares: vec![(row, 1.0)], at: receiver }];
                self.spots.push(Spot { row, places });
            } else {
                let places = self.showing(&solids, row, &mut rng);
                if places.is_empty() {
                    self.buried += 1;
                } else {
                    self.moved += 1;
                    self.spots.push(Spot { row, places });
                }
            }
        }
    }

    /// Places on the triangles of a row that show, drawn as often as the row weighs there in the picture.
    fn showing(&self, solids: &Solids<'_>, row: usize, rng: &mut Rng) -> Vec<Place> {
        let triangles = self.prt.geometry.triangles.iter().map(|t| t.map(|v| v as usize));
        let around: Vec<[usize; 3]> = triangles.filter(|t| t.contains(&row)).collect();
        let mut sums: Vec<f32> = around.iter().map(|t| self.corners(*t).1.length()).collect();
        (1..sums.len()).for_each(|k| sums[k] += sums[k - 1]);
        let mut places = Vec::new();
        for _ in 0..TRIES {
            let at = rng.next_f32() * sums.last().unwrap_or(&0.0);
            let (u, v) = rng.next_square().into();
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let Some(&triangle) = around.get(sums.partition_point(|&end| end <= at)) else { continue };
            let shares = [1.0 - u - v, u, v];
            let own = triangle.iter().position(|&corner| corner == row).map_or(0.0, |corner| shares[corner]);
            let place = self.place(triangle, shares);
            if rng.next_f32() < own && solids.shows(&place.at, rng) {
                places.push(place);
            }
            if places.len() == PLACES {
                break;
            }
        }
        places
    }

    /// A random place that shows on each triangle with a corner that is asked for.
    fn between(&self, is_asked: &dyn Fn(&usize) -> bool) -> Vec<Spot> {
        let (mut rng, solids) = (Rng::new(2, 0), Solids::of(&self.scene));
        let triangles = self.prt.geometry.triangles.iter().map(|t| t.map(|v| v as usize));
        let around: Vec<[usize; 3]> = triangles.filter(|t| t.iter().any(is_asked)).collect();
        let mut spots = Vec::new();
        for triangle in around {
            let (u, v) = rng.next_square().into();
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let place = self.place(triangle, [1.0 - u - v, u, v]);
            if solids.shows(&place.at, &mut rng) {
                spots.push(Spot { row: triangle[0], places: vec![place] });
            }
        }
        spots
    }

    /// Corners of a triangle, and its normal with twice its area as length.
    fn corners(&self, triangle: [usize; 3]) -> ([Vec3; 3], Vec3) {
        let [a, b, c] = triangle.map(|v| Vec3::from(self.prt.geometry.positions[v]));
        ([a, b, c], (b - a).cross(c - a))
    }

    /// A place on a triangle, as renderers interpolate between its corners.
    fn place(&self, triangle: [usize; 3], shares: [f32; 3]) -> Place {
        let (corners, across) = self.corners(triangle);
        let normals = triangle.map(|v| Vec3::from(self.prt.geometry.normals[v]));
        let mix = |of: [Vec3; 3]| of.into_iter().zip(shares).map(|(x, share)| share * x).sum::<Vec3>();
        let position = mix(corners);
        let geometric_normal = across.normalize_or_zero();
        let normal = mix(normals).try_normalize().unwrap_or(geometric_normal);
        let (vertex, rounding) = (position, 0.0);
        let at = Receiver { position, vertex, normal, geometric_normal, rounding, sound: true, dark: false };
        Place { shares: triangle.into_iter().zip(shares.map(f64::from)).collect(), at }
    }
}
