//! The rays of a packet, each with the triangle that it surely meets: `meet` side by side, with the same results.

use crate::exact::{Wide, is_certain, quick_volume};
use crate::found::{Place, rays_of};
use crate::packet::{Many, WIDEST};
use crate::ray::Hit;
use crate::tree::Tree;
use glam::Vec3;

/// Triangles, one for each ray, and where the rays meet them.
#[derive(Debug)]
pub(crate) struct Meetings {
    /// a.x a.y a.z b.x ... c.z from the origin.
    corners: [Many; 9],
    t: Many,
    u: Many,
    v: Many,
    /// Sum of the weights of the corners, whose sign tells the side; 0 where double precision was not enough.
    sum: [f64; WIDEST],
}

impl Meetings {
    pub(crate) fn new() -> Meetings {
        let [t, u, v] = [[0.0; WIDEST]; 3];
        Meetings { corners: [[0.0; WIDEST]; 9], t, u, v, sum: [0.0; WIDEST] }
    }

    /// Works out where rays of a mask, of directions that are unit or nearly so, each meet the triangle at its place.
    #[inline(always)]
    pub(crate) fn run(
        &mut self,
        tree: &Tree,
        origin: Vec3,
        directions: &[Many; 3],
        places: &[Place; WIDEST],
        rays: u32,
    ) {
        for ray in rays_of(rays) {
            let corners = tree.blocks[places[ray].block as usize].corners(places[ray].lane as usize);
            for (rows, corner) in self.corners.chunks_exact_mut(3).zip(corners) {
                let from_origin = corner - origin;
                (rows[0][ray], rows[1][ray], rows[2][ray]) = (from_origin.x, from_origin.y, from_origin.z);
            }
        }
        self.meet(directions);
    }

    /// A plain loop over structures of arrays, which compilers make wide by themselves.
    #[expect(clippy::needless_range_loop, reason = "one index into nine rows and more")]
    #[inline(always)]
    fn meet(&mut self, directions: &[Many; 3]) {
        for ray in 0..WIDEST {
            let corner = |k: usize| std::array::from_fn(|axis| f64::from(self.corners[3 * k + axis][ray]));
            let [a, b, c]: [Wide; 3] = [corner(0), corner(1), corner(2)];
            let d: Wide = std::array::from_fn(|axis| f64::from(directions[axis][ray]));
            let volumes = [quick_volume(d, b, c), quick_volume(d, c, a), quick_volume(d, a, b)];
            let certain = is_certain(volumes[0]) & is_certain(volumes[1]) & is_certain(volumes[2]);
            let sum = volumes[0].0 + volumes[1].0 + volumes[2].0;
            let [wa, wb, wc] = volumes.map(|(volume, _)| volume / sum);
            let point: Wide = std::array::from_fn(|axis| wa * a[axis] + wb * b[axis] + wc * c[axis]);
            let along = point[0] * d[0] + point[1] * d[1] + point[2] * d[2];
            let t = along / (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
            self.t[ray] = (t as f32).max(0.0);
            self.u[ray] = wb as f32;
            self.v[ray] = wc as f32;
            self.sum[ray] = if certain { sum } else { 0.0 };
        }
    }

    /// The hit of a ray on a triangle of some number; None where double precision was not enough.
    #[inline(always)]
    pub(crate) fn hit(&self, ray: usize, triangle: u32) -> Option<Hit> {
        let hit = Hit { triangle, t: self.t[ray], u: self.u[ray], v: self.v[ray], front: self.sum[ray] < 0.0 };
        (self.sum[ray] != 0.0).then_some(hit)
    }
}
