//! What a probe sees of surfaces: how far they are, whether it stands inside one, and the way out.

use super::octahedron::{density, direction};
use crate::world::World;
use glam::Vec3;
use raytrace::{FanState, Hit, Ray};

/// Rays along a side of the map of distances, at least; texels share them evenly.
const SIDE: u32 = 32;
/// A probe that sees more than this share of insides of bodies is inside one.
const MOST_INSIDE: f32 = 0.25;
/// Share of the sphere that the backs of ground take from below, and length of the mean of its unit normals.
const GROUND: f32 = 0.45;
const LEVEL: f32 = 0.8;
/// Share of a cell's shortest edge by which a probe is put before a surface.
const MARGIN: f32 = 1.0 / 16.0;
/// The same for how near a surface must be to count as running through the probe, which then may see neither side of it.
const TOUCH: f32 = 1e-3;
/// Longest edges that a probe is moved at most: whatever a cell holds is left.
const FARTHEST: f32 = 1.25;
/// Most moves of a probe: off three surfaces in a corner, and out of bodies within bodies.
const MOVES: usize = 6;

/// Looks from points in all directions.
pub(super) struct Sight<'a> {
    world: &'a World<'a>,
    /// Unit directions: those of a texel after one another.
    directions: [Vec<f32>; 3],
    /// Their shares of the sphere.
    shares: Vec<f32>,
    /// A bit for each: all.
    wanted: Vec<u64>,
    /// Rays per texel.
    rays: usize,
    reach: f32,
}

/// What is seen from a point.
pub(super) struct View {
    /// As [`coeff_io::Volume::distances`].
    pub(super) distances: Vec<f32>,
    /// Share of the sphere in which insides of bodies are.
    inside: f32,
    /// The nearest insides by the six axes that they lie nearest to: directions and distances, nearest first.
    exits: Vec<(Vec3, f32)>,
}

impl View {
    /// The share of the sphere that is as it should be; 0 inside of bodies.
    pub(super) fn validity(&self) -> f32 {
        if self.is_inside() { 0.0 } else { 1.0 - self.inside }
    }

    fn is_inside(&self) -> bool {
        self.inside > MOST_INSIDE
    }
}

/// Where a probe looks from, and what it sees from there.
pub(super) struct Stand {
    pub(super) at: Vec3,
    pub(super) view: View,
}

impl<'a> Sight<'a> {
    pub(super) fn new(world: &'a World<'a>, resolution: u32, reach: f32) -> Self {
        let parts = SIDE.div_ceil(resolution).max(2);
        let side = resolution * parts;
        let mut sight = Self {
            world,
            directions: Default::default(),
            shares: Vec::new(),
            wanted: vec![u64::MAX; ((side * side) as usize).div_ceil(64)],
            rays: (parts * parts) as usize,
            reach,
        };
        let at = |texel: u32, part: u32| (2 * (texel * parts + part) + 1) as f32 / side as f32 - 1.0;
        for texel in 0..resolution * resolution {
            for part in 0..parts * parts {
                let x = at(texel % resolution, part % parts);
                let y = at(texel / resolution, part / parts);
                let direction = direction(x, y).to_array();
                sight.directions.iter_mut().zip(direction).for_each(|(axis, value)| axis.push(value));
                sight.shares.push(density(x, y));
            }
        }
        let total: f64 = sight.shares.iter().copied().map(f64::from).sum();
        sight.shares.iter_mut().for_each(|share| *share = (f64::from(*share) / total) as f32);
        sight
    }

    /// Looks from a corner of cells with such edges, or from beside it where the corner is in or inside of a surface. Where there is no
    /// way out within [`FARTHEST`] it stays at the corner.
    pub(super) fn stand(&self, corner: Vec3, edges: Vec3, fan: &mut FanState, rays: &mut u64) -> Stand {
        let mut look = |at: Vec3| {
            *rays += self.shares.len() as u64;
            Stand { at, view: self.view(at, fan) }
        };
        let mut at = corner;
        for _ in 0..MOVES {
            if let Some(beside) = self.off_surface(at, edges) {
                at = beside;
                continue;
            }
            let stand = look(at);
            if !stand.view.is_inside() {
                return stand;
            }
            match self.way_out(at, &stand.view.exits, corner, edges) {
                Some(outside) => at = outside,
                None => break,
            }
        }
        look(corner)
    }

    /// What is seen from a point.
    fn view(&self, at: Vec3, fan: &mut FanState) -> View {
        let [xs, ys, zs] = &self.directions;
        let mut hits = vec![None; xs.len()];
        let solid = |triangle, u, v| self.world.solid(triangle, u, v);
        self.world.tracer.closest_fan(at, xs, ys, zs, &self.wanted, &solid, fan, &mut hits);
        let covers = self.is_under_ground(&hits);
        let mut inside = 0.0f64;
        let mut exits = [None::<(Vec3, f32)>; 6];
        for (i, hit) in hits.iter().enumerate() {
            let is_inside = |hit: &Hit| self.is_inside(hit) || covers && self.is_sheet(hit);
            let Some(hit) = hit.filter(is_inside) else { continue };
            inside += f64::from(self.shares[i]);
            let direction = Vec3::new(xs[i], ys[i], zs[i]);
            let exit = &mut exits[main_axis(direction)];
            if exit.is_none_or(|(_, t)| hit.t < t) {
                *exit = Some((direction, hit.t));
            }
        }
        let mut exits: Vec<(Vec3, f32)> = exits.into_iter().flatten().collect();
        exits.sort_by(|a, b| a.1.total_cmp(&b.1));
        View { distances: self.distances(&hits), inside: inside as f32, exits }
    }

    /// Mean and mean square over each texel.
    fn distances(&self, hits: &[Option<Hit>]) -> Vec<f32> {
        let texel = |(hits, shares): (&[Option<Hit>], &[f32])| {
            let (mut sum, mut square, mut total) = (0.0f64, 0.0, 0.0);
            for (hit, &share) in hits.iter().zip(shares) {
                let distance = f64::from(hit.map_or(self.reach, |hit| hit.t.min(self.reach)));
                let share = f64::from(share);
                sum += share * distance;
                square += share * distance * distance;
                total += share;
            }
            let mean = (sum / total) as f32;
            // Rounding is no variance below zero.
            [mean, ((square / total) as f32).max(mean * mean)]
        };
        hits.chunks_exact(self.rays).zip(self.shares.chunks_exact(self.rays)).flat_map(texel).collect()
    }

    /// Whether nearly a half space is the backs of one-sided sheets that face the same way: ground seen from below, although it bounds
    /// no body. Leaves face all ways, and slats and awnings are not as wide.
    fn is_under_ground(&self, hits: &[Option<Hit>]) -> bool {
        let (mut share, mut facing) = (0.0f32, Vec3::ZERO);
        for (hit, &part) in hits.iter().zip(&self.shares) {
            let Some(hit) = hit.filter(|hit| self.is_sheet(hit)) else { continue };
            let [a, b, c] = self.world.points(hit.triangle);
            share += part;
            facing += part * (b - a).cross(c - a).normalize_or_zero();
        }
        share > GROUND && facing.length() > LEVEL * share
    }

    /// Whether a hit is on the back of a one-sided surface that bounds no body.
    fn is_sheet(&self, hit: &Hit) -> bool {
        !hit.front && self.world.is_one_sided(hit.triangle)
    }

    fn is_inside(&self, hit: &Hit) -> bool {
        self.world.bodies.is_inside(hit)
    }

    /// A point before the surface that runs through a point, if one does.
    fn off_surface(&self, at: Vec3, edges: Vec3) -> Option<Vec3> {
        let touch = TOUCH * edges.min_element();
        let hits = Vec3::AXES.into_iter().filter_map(|axis| {
            let ray = Ray { t_max: 2.0 * touch, ..Ray::new(at - touch * axis, axis) };
            self.closest(&ray).map(|hit| (hit.triangle, ray.origin + hit.t * axis))
        });
        let (triangle, point) = hits.min_by(|a, b| a.1.distance_squared(at).total_cmp(&b.1.distance_squared(at)))?;
        let [a, b, c] = self.world.points(triangle);
        let normal = (b - a).cross(c - a).try_normalize()?;
        self.beyond(point, normal, touch, edges).map(|margin| point + margin * normal)
    }

    /// A point outside of the body that a point is inside of, not far from the corner.
    fn way_out(&self, at: Vec3, exits: &[(Vec3, f32)], corner: Vec3, edges: Vec3) -> Option<Vec3> {
        let touch = TOUCH * edges.min_element();
        exits.iter().find_map(|&(direction, t)| {
            let surface = at + t * direction;
            let outside = surface + self.beyond(surface, direction, touch, edges)? * direction;
            (outside.distance(corner) <= FARTHEST * edges.max_element()).then_some(outside)
        })
    }

    /// How far beyond a surface a probe is put: a margin, and halfway at most to what is next. None where there is no space.
    fn beyond(&self, surface: Vec3, direction: Vec3, touch: f32, edges: Vec3) -> Option<f32> {
        let next = self.closest(&Ray { t_min: 0.5 * touch, ..Ray::new(surface, direction) });
        let margin = next.map_or(f32::INFINITY, |hit| 0.5 * hit.t).min(MARGIN * edges.min_element());
        (margin > 2.0 * touch).then_some(margin)
    }

    fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.world.closest(ray)
    }
}

/// Which of the six axes a direction lies nearest to.
fn main_axis(direction: Vec3) -> usize {
    let axis = direction.abs().max_position();
    2 * axis + usize::from(direction[axis] < 0.0)
}
