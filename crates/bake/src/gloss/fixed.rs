//! Bounces under one light, as the paper has them: a table for each, from what the surfaces sent in the bounce before (\[T\] section 4.2).

use crate::arrival::Arrivals;
use crate::error::Error;
use crate::extras::Done;
use crate::found::Found;
use crate::maps::arrive_as;
use crate::mirror::{MOST_BANDS, Mirrors};
use crate::progress::Stage;
use crate::receivers::Receiver;
use crate::senders::shares;
use glam::Vec3;
use raytrace::Hit;
use sh_math::Rgb;
use sh_math::light_matrix::{LightProduct, apply};

/// Most tables. The last holds all that surfaces scatter from there on, and what mirrors send of the bounce before it.
const MOST_TABLES: usize = 4;

/// Adds the radiance of every receiver after a bounce to those before; from the last table on they are one.
pub(crate) fn add_table(tables: &mut Vec<Vec<[f32; 3]>>, own: Vec<[f32; 3]>) {
    match tables.get_mut(MOST_TABLES - 1) {
        Some(last) => last.iter_mut().zip(own).for_each(|(sum, x)| *sum = std::array::from_fn(|c| sum[c] + x[c])),
        None => tables.push(own),
    }
}

/// What surfaces send in each bounce under one light.
pub(crate) struct FixedBounces<'a> {
    done: &'a Done<'a>,
    mirrors: &'a Mirrors,
    /// Per table: radiance of every receiver for albedo 1.
    scattered: Vec<Vec<[f32; 3]>>,
    /// Per table: what arrives at the vertices that shine, `[row][coefficient]`.
    arriving: Vec<Vec<[f32; 3]>>,
}

impl<'a> FixedBounces<'a> {
    /// Follows the light from bounce to bounce over the vertices that shine. `light` has all bands that reach a product.
    pub(crate) fn follow(
        done: &'a Done<'a>,
        mirrors: &'a Mirrors,
        arrivals: &Arrivals<'_>,
        light: &Rgb,
        bounces: u32,
    ) -> Result<Self, Error> {
        let scattered: Vec<Vec<[f32; 3]>> = done.radiance.iter().take(bounces as usize).cloned().collect();
        let matrix = LightProduct::new(mirrors.bands).matrix(light);
        let direct = (0..mirrors.rows()).flat_map(|row| apply(&matrix, mirrors.visibility(row))).collect();
        let mut all = Self { done, mirrors, scattered, arriving: vec![direct] };
        let points = all.mirror_points();
        while all.arriving.len() < all.scattered.len() {
            let table = all.arriving.len() - 1;
            let total = (&points[..], Stage::Gloss);
            let keep = |_: usize, arrival: crate::arrival::Arrival| all.bounce(table, &arrival.found);
            let rows = arrive_as(done, arrivals, total, &|k| k as u32, &keep)?;
            all.arriving.push(rows.into_iter().flatten().collect());
        }
        Ok(all)
    }

    /// Number of tables.
    pub(crate) fn tables(&self) -> usize {
        self.scattered.len()
    }

    /// Appends the rows of all tables, `[coefficient][3]`.
    pub(crate) fn append(&self, found: &Found, row: &mut Vec<f32>) {
        for table in 0..self.tables() {
            row.extend(self.bounce(table, found).into_flattened());
        }
    }

    fn mirror_points(&self) -> Vec<Receiver> {
        let vertices = 0..self.done.receivers.vertices as u32;
        let shining = vertices.filter(|&vertex| self.mirrors.row(vertex).is_some());
        shining.map(|vertex| self.done.receivers.list[vertex as usize]).collect()
    }

    /// What surfaces send to a point in the bounce after that of a table, RGB per coefficient.
    fn bounce(&self, table: usize, found: &Found) -> Vec<[f32; 3]> {
        let mut send = |hit: &Hit, direction: Vec3, out: &mut [f32]| self.send(table, hit, direction, out);
        let flat = found.gather(self.mirrors.bands, [1, 3], &mut send);
        flat.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect()
    }

    fn send(&self, table: usize, hit: &Hit, direction: Vec3, out: &mut [f32]) -> bool {
        let world = self.done.gatherer.world;
        let albedo = world.sent(hit).to_array();
        out.fill(0.0);
        for (corner, share) in shares(world, self.done.receivers, hit.triangle, !hit.front, [hit.u, hit.v]) {
            let radiance = self.scattered[table][corner as usize];
            out.iter_mut().zip(radiance).zip(albedo).for_each(|((sum, x), albedo)| *sum += share * albedo * x);
        }
        let n = self.mirrors.bands.coefficients();
        let mut lobe = [0.0; (MOST_BANDS * MOST_BANDS) as usize];
        let lobe = &mut lobe[..n];
        if let Some(met) = self.mirrors.meet(world, hit, direction, lobe) {
            let mut mirrored = [0.0f32; 3];
            for (row, share) in met.rows.into_iter().zip(met.shares) {
                let arriving = &self.arriving[table][row as usize * n..][..n];
                for (a, u) in lobe.iter().zip(arriving) {
                    mirrored.iter_mut().zip(u).for_each(|(sum, u)| *sum += share * a * u);
                }
            }
            // A lobe cut to few bands rings; what is mirrored is no less than nothing.
            let sent = mirrored.map(|x| x.max(0.0)).into_iter().zip(met.tint.to_array());
            out.iter_mut().zip(sent).for_each(|(sum, (x, tint))| *sum += x * tint);
        }
        true
    }
}
