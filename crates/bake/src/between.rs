//! The error of transfer between receivers, where renderers interpolate it: measured at points of the surfaces.

use crate::Error;
use crate::field::Field;
use crate::gather::{Gathered, Gatherer, Worker};
use crate::passes::Monitor;
use crate::progress::Stage;
use crate::receivers::{Receiver, Receivers};
use crate::world::{World, receiver_on};
use coeff_io::{Achieved, Quality};
use rayon::prelude::*;
use sampling::rng::{Rng, hash};
use scene::AlphaMode;

/// Of so many receivers one point is measured; each is looked from twice, with fewer rays.
const PART: usize = 64;
/// Fewest and most points.
const COUNT: [usize; 2] = [48, 2048];
/// Of so many points, those with the largest errors, one is measured again with the quality of receivers.
const AGAIN: usize = 10;
/// Relative error that suffices to find those.
const COARSE: f32 = 0.02;
/// Stream of random numbers of the points.
const STREAM: u64 = 0xbe73;

/// A point between receivers.
struct Point {
    receiver: Receiver,
    corners: [u32; 3],
    shares: [f32; 3],
    /// Its share of the area over its share of the points.
    weight: f64,
}

/// Measures the direct transfer at random points and enters how far the interpolated one is from it, against an open receiver's.
///
/// Half of the points lie evenly on the surfaces, half evenly in the triangles, so that small ones are looked at too; the median and the
/// percentile count areas. Two looks with different directions err independently, so the product of their differences from the interpolated
/// transfer has the square of its error as its mean, whatever the noise of the looks.
pub(crate) fn measure(
    gatherer: &Gatherer<'_>,
    receivers: &Receivers,
    direct: &Field,
    monitor: &Monitor<'_>,
    seed: u64,
    achieved: &mut Achieved,
) -> Result<(), Error> {
    if !gatherer.visibility {
        return Ok(());
    }
    let count = (receivers.vertices / PART).clamp(COUNT[0], COUNT[1]);
    let points: Vec<Point> = points(gatherer.world, receivers, seed, count);
    let quality = match gatherer.quality {
        Quality::Error(asked) => Quality::Error(asked.max(COARSE)),
        rays @ Quality::Rays(_) => rays,
    };
    let coarse = Gatherer { quality, hits: false, mirrors: None, ..*gatherer };
    let all: Vec<usize> = (0..points.len()).collect();
    let looks = looks(&coarse, &points, &all, direct, u32::MAX, monitor)?;
    let mut found: Vec<(usize, f64)> = looks;
    if quality != gatherer.quality {
        found.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        let again: Vec<usize> = found.iter().take(found.len().div_ceil(AGAIN)).map(|(index, _)| *index).collect();
        let fine = Gatherer { hits: false, mirrors: None, ..*gatherer };
        found.drain(..again.len());
        found.extend(self::looks(&fine, &points, &again, direct, u32::MAX / 2, monitor)?);
    }
    found.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
    let Some(&(worst, most)) = found.last() else { return Ok(()) };
    let total: f64 = found.iter().map(|(index, _)| points[*index].weight).sum();
    let at = |share: f64| {
        let mut sum = 0.0;
        let reaches = |(index, _): &&(usize, f64)| {
            sum += points[*index].weight;
            sum >= share * total
        };
        found.iter().find(reaches).map_or(most, |(_, error)| *error) as f32
    };
    achieved.interpolation = Some([at(0.5), at(0.95), most as f32]);
    achieved.worst_between = Some(points[worst].corners[0]);
    Ok(())
}

/// Random points on the fronts of all surfaces that show light.
fn points(world: &World<'_>, receivers: &Receivers, seed: u64, count: usize) -> Vec<Point> {
    let scene = world.scene;
    let mut ends = Vec::new();
    let mut first = 0;
    let mut total = 0.0;
    for (m, mesh) in scene.meshes.iter().enumerate() {
        for t in 0..mesh.triangles.len() {
            total += mesh.area(t);
            ends.push((total, m, t, first));
        }
        first += mesh.positions.len() as u32;
    }
    if total <= 0.0 {
        return Vec::new();
    }
    let one = |k: usize| {
        let mut random = Rng::new(hash(seed, STREAM, 0), k as u64);
        let place = (k as f64 / 2.0 + random.next_f64()) / (count as f64 / 2.0).max(1.0);
        let index = match k % 2 {
            0 => ends.partition_point(|(end, ..)| *end <= place.fract() * total),
            _ => (place.fract() * ends.len() as f64) as usize,
        };
        let &(end, m, t, first) = ends.get(index)?;
        let area = end - if index > 0 { ends[index - 1].0 } else { 0.0 };
        let (even, single) = (area / total, 1.0 / ends.len() as f64);
        let [mut u, mut v] = random.next_square();
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        let mesh = &scene.meshes[m];
        let solid = match scene.materials[mesh.material as usize].alpha {
            AlphaMode::Mask(_) => scene.coverage(m, t, u, v) > 0.0,
            AlphaMode::Opaque | AlphaMode::Blend => true,
        };
        let corners = mesh.triangles[t].map(|v| v + first);
        let shows = corners.iter().all(|&c| !receivers.list[c as usize].dark && receivers.list[c as usize].sound);
        (solid && shows).then(|| Point {
            receiver: receiver_on(mesh, t, [u, v]).of_extent(world.extents[m]),
            corners,
            shares: [1.0 - u - v, u, v],
            weight: even / (0.5 * even + 0.5 * single),
        })
    };
    (0..count).filter_map(one).collect()
}

/// Of the points of the given indices those that stand outside of bodies, with their errors; `number` tells whose directions they take.
fn looks(
    gatherer: &Gatherer<'_>,
    points: &[Point],
    indices: &[usize],
    direct: &Field,
    number: u32,
    monitor: &Monitor<'_>,
) -> Result<Vec<(usize, f64)>, Error> {
    let total = indices.len() as u64;
    monitor.begin(Stage::Between, total);
    let one = |worker: &mut Worker, &index: &usize| {
        if monitor.is_cancelled() {
            return None;
        }
        let point = &points[index];
        let look = |worker: &mut Worker, k| gatherer.gather(&point.receiver, number - 2 * index as u32 - k, worker);
        let (a, b) = (look(worker, 0), look(worker, 1));
        monitor.receiver_done(Stage::Between, total, a.visibility_rays + b.visibility_rays);
        let is_inside = [&a, &b].iter().any(|look| look.finding().is_inside());
        (!is_inside).then(|| (index, error(point, [&a, &b].map(first_channel), direct)))
    };
    let found = indices.par_iter().map_init(Worker::new, one).collect::<Vec<_>>();
    monitor.check()?;
    let open = gatherer.bank.open_norm;
    Ok(found.into_iter().flatten().map(|(index, error)| (index, error / open)).collect())
}

/// Direct transfer of the first channel.
fn first_channel(look: &Gathered) -> &[f32] {
    if look.tinted.is_empty() { &look.transfer } else { &look.tinted[..look.transfer.len()] }
}

/// The root of the product of two looks' differences from the interpolated transfer; zero where it is negative.
fn error(point: &Point, [a, b]: [&[f32]; 2], direct: &Field) -> f64 {
    let rows = point.corners.map(|corner| direct.channel(corner, 0));
    let product = |k: usize| {
        let between: f64 = rows.iter().zip(point.shares).map(|(row, share)| f64::from(share * row[k])).sum();
        (f64::from(a[k]) - between) * (f64::from(b[k]) - between)
    };
    (0..a.len()).map(product).sum::<f64>().max(0.0).sqrt()
}
