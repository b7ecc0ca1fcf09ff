//! Runs receivers over the threads: the first pass, and one pass per bounce.

use crate::field::Field;
use crate::gather::{Gathered, Gatherer, Worker};
use crate::hit::{PackedHit, Source};
use crate::progress::{Progress, Stage};
use crate::receivers::{NONE, Receivers, morton_order};
use crate::{Error, ProgressFn};
use rayon::prelude::*;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Receivers that a thread takes at a time.
const CHUNK: usize = 64;
/// Receivers between two calls of the progress callback: a few milliseconds, so that a cancel is quick.
const REPORT: u64 = 8;

/// Counts what is done and passes it on; remembers a wish to stop.
pub(crate) struct Monitor<'a> {
    callback: ProgressFn<'a>,
    cancelled: AtomicBool,
    done: AtomicU64,
    rays: AtomicU64,
}

impl<'a> Monitor<'a> {
    pub(crate) fn new(callback: ProgressFn<'a>) -> Self {
        Self { callback, cancelled: AtomicBool::new(false), done: AtomicU64::new(0), rays: AtomicU64::new(0) }
    }

    pub(crate) fn begin(&self, stage: Stage, total: u64) {
        self.done.store(0, Ordering::Relaxed);
        self.report(stage, 0, total);
    }

    /// Counts one receiver.
    pub(crate) fn receiver_done(&self, stage: Stage, total: u64, rays: u64) {
        self.rays.fetch_add(rays, Ordering::Relaxed);
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        if done.is_multiple_of(REPORT) || done == total {
            self.report(stage, done, total);
        }
    }

    pub(crate) fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    fn report(&self, stage: Stage, done: u64, total: u64) {
        let rays = self.rays.load(Ordering::Relaxed);
        if let ControlFlow::Break(()) = (self.callback)(&Progress { stage, done, total, rays }) {
            self.cancelled.store(true, Ordering::Relaxed);
        }
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        if self.is_cancelled() { Err(Error::Cancelled) } else { Ok(()) }
    }
}

/// Receivers that are worked on together, with what they see where that is kept.
pub(crate) struct Chunk {
    ids: Vec<u32>,
    seen: Option<SeenSurfaces>,
}

impl Chunk {
    /// Receivers with what they were found to see.
    pub(crate) fn of(ids: Vec<u32>, results: &[Gathered]) -> Self {
        Self { ids, seen: Some(SeenSurfaces::of(results)) }
    }
}

/// The surfaces that the receivers of a chunk see.
struct SeenSurfaces {
    ends: Vec<u32>,
    hits: Vec<PackedHit>,
}

/// What the first pass hands on, receiver by receiver.
pub(crate) type Sink<'s> = dyn FnMut(u32, &Gathered) + 's;

/// Gathers for the given receivers; `keep` says whether what they see is kept for the bounces.
pub(crate) fn gather_pass(
    gatherer: &Gatherer<'_>,
    receivers: &Receivers,
    ids: Vec<u32>,
    stage: Stage,
    keep: bool,
    monitor: &Monitor<'_>,
    sink: &mut Sink<'_>,
) -> Result<Vec<Chunk>, Error> {
    let order = morton_order(&receivers.list, ids.into_iter());
    let total = order.len() as u64;
    monitor.begin(stage, total);
    let mut chunks = Vec::new();
    for block in order.chunks(gatherer.receivers_per_block().next_multiple_of(CHUNK)) {
        let gathered: Vec<(Vec<u32>, Vec<Gathered>)> = block
            .par_chunks(CHUNK)
            .map_init(Worker::new, |worker, ids| {
                let mut results = Vec::with_capacity(ids.len());
                for &id in ids {
                    if monitor.is_cancelled() {
                        break;
                    }
                    let result = gatherer.gather(&receivers.list[id as usize], id, worker);
                    monitor.receiver_done(stage, total, result.visibility_rays + result.bounce_rays);
                    results.push(result);
                }
                (ids.to_vec(), results)
            })
            .collect();
        monitor.check()?;
        for (ids, results) in gathered {
            for (&id, result) in ids.iter().zip(&results) {
                sink(id, result);
            }
            let seen = keep.then(|| SeenSurfaces::of(&results));
            chunks.push(Chunk { ids, seen });
        }
    }
    Ok(chunks)
}

impl SeenSurfaces {
    fn of(results: &[Gathered]) -> Self {
        let mut seen = Self { ends: Vec::with_capacity(results.len()), hits: Vec::new() };
        seen.hits.reserve_exact(results.iter().map(|r| r.hits.len()).sum());
        for result in results {
            seen.hits.extend_from_slice(&result.hits);
            seen.ends.push(seen.hits.len() as u32);
        }
        seen
    }

    fn of_receiver(&self, k: usize) -> &[PackedHit] {
        let start = if k == 0 { 0 } else { self.ends[k - 1] as usize };
        &self.hits[start..self.ends[k] as usize]
    }
}

/// One bounce, \[G\] eq. (11): every receiver sums what the surfaces that it sees send on of the bounce before.
pub(crate) fn bounce_pass(
    gatherer: &Gatherer<'_>,
    receivers: &Receivers,
    chunks: &[Chunk],
    last: &Field,
    stage: Stage,
    monitor: &Monitor<'_>,
) -> Result<Field, Error> {
    let total = chunks.iter().map(|c| c.ids.len() as u64).sum();
    monitor.begin(stage, total);
    let mut next = Field::zeros(receivers.list.len(), last.coefficients, last.channels);
    for block in chunks.chunks(1024) {
        let rows: Vec<Vec<f32>> = block
            .par_iter()
            .map_init(Worker::new, |worker, chunk| {
                let mut rows = vec![0.0; chunk.ids.len() * last.row_len()];
                for ((k, &id), row) in chunk.ids.iter().enumerate().zip(rows.chunks_exact_mut(last.row_len())) {
                    if monitor.is_cancelled() {
                        break;
                    }
                    let mut rays = 0;
                    match &chunk.seen {
                        Some(seen) => add_reflected(gatherer, receivers, id, seen.of_receiver(k), last, row),
                        None => {
                            // Too much to keep: what the receiver sees is found again.
                            let again = gatherer.gather(&receivers.list[id as usize], id, worker);
                            rays = again.visibility_rays + again.bounce_rays;
                            add_reflected(gatherer, receivers, id, &again.hits, last, row);
                        }
                    }
                    monitor.receiver_done(stage, total, rays);
                }
                rows
            })
            .collect();
        monitor.check()?;
        for (chunk, rows) in block.iter().zip(rows) {
            for (&id, row) in chunk.ids.iter().zip(rows.chunks_exact(last.row_len())) {
                next.row_mut(id).copy_from_slice(row);
            }
        }
    }
    Ok(next)
}

/// Adds albedo times transfer of every surface seen: of near points their own, else interpolated.
fn add_reflected(
    gatherer: &Gatherer<'_>,
    receivers: &Receivers,
    id: u32,
    hits: &[PackedHit],
    last: &Field,
    row: &mut [f32],
) {
    for hit in hits {
        match hit.source() {
            Source::Near(index) => {
                add_scaled(row, last.row(receivers.near_of[id as usize] + index), hit.reflected, 1.0, last.channels);
            }
            Source::Triangle(triangle) => {
                let corners = gatherer.world.corners[triangle as usize];
                let [u, v] = hit.barycentrics.map(|b| f32::from(b) / 65535.0);
                for (corner, share) in corners.into_iter().zip([1.0 - u - v, u, v]) {
                    let back = if hit.is_back() { receivers.back_of[corner as usize] } else { NONE };
                    let from = if back == NONE { corner } else { back };
                    add_scaled(row, last.row(from), hit.reflected, share, last.channels);
                }
            }
        }
    }
}

/// Adds a row times a factor per channel.
fn add_scaled(row: &mut [f32], from: &[f32], reflected: [f32; 3], share: f32, channels: usize) {
    let stride = row.len() / channels;
    for (c, (out, from)) in row.chunks_exact_mut(stride).zip(from.chunks_exact(stride)).enumerate() {
        let factor = share * reflected[c];
        for (o, f) in out.iter_mut().zip(from) {
            *o += factor * f;
        }
    }
}
