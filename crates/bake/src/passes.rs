//! Runs receivers over the threads: the first pass, and one pass per bounce.

use crate::field::Field;
use crate::gather::{Gathered, Gatherer, Worker};
use crate::progress::{Progress, Stage};
use crate::receivers::{Receivers, morton_order};
use crate::reflected::add_reflected;
use crate::senders::{Senders, fill_row};
use crate::wanted::is_wanted;
use crate::world::World;
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

/// Receivers that are worked on together, with those that send light to them where that is kept.
pub(crate) struct Chunk {
    ids: Vec<u32>,
    senders: Option<Kept>,
}

/// Who sends light to the receivers of a chunk.
struct Kept {
    /// What surfaces scatter.
    scattered: Senders,
    /// What surfaces that shine mirror of light from other surfaces: from the second bounce on.
    mirrored: Senders,
}

impl Kept {
    fn of(world: &World<'_>, results: &[Gathered]) -> Self {
        Self {
            scattered: Senders::of(world, results, |result| &result.hits),
            mirrored: Senders::of(world, results, |result| &result.late),
        }
    }

    fn bytes(&self) -> u64 {
        self.scattered.bytes() + self.mirrored.bytes()
    }
}

impl Chunk {
    /// Receivers with what they were found to see.
    pub(crate) fn of(world: &World<'_>, ids: Vec<u32>, results: &[Gathered]) -> Self {
        Self { ids, senders: Some(Kept::of(world, results)) }
    }

    /// Takes the memory of the senders from `room`, or forgets them where it does not suffice.
    pub(crate) fn keep_within(&mut self, room: &mut u64) {
        match room.checked_sub(self.senders.as_ref().map_or(0, Kept::bytes)) {
            Some(rest) => *room = rest,
            None => self.senders = None,
        }
    }
}

/// Forgets what a receiver sees but for what may want receivers of its own: the whole of a block takes more memory than its senders.
fn keep_wanted(world: &World<'_>, result: &mut Gathered) {
    result.hits.retain(|hit| is_wanted(world, hit));
    result.hits.shrink_to_fit();
    result.late = Vec::new();
}

/// What the first pass hands on, receiver by receiver: of what it sees what [`Wanted::note`](crate::wanted::Wanted::note) asks for.
pub(crate) type Sink<'s> = dyn FnMut(u32, &Gathered) + 's;

/// Gathers for the given receivers; what they see is kept for the bounces while `room`, in bytes, lasts.
pub(crate) fn gather_pass(
    gatherer: &Gatherer<'_>,
    receivers: &Receivers,
    ids: Vec<u32>,
    stage: Stage,
    room: &mut u64,
    monitor: &Monitor<'_>,
    sink: &mut Sink<'_>,
) -> Result<Vec<Chunk>, Error> {
    let order = morton_order(&receivers.list, ids.into_iter());
    let total = order.len() as u64;
    monitor.begin(stage, total);
    let mut chunks = Vec::new();
    for block in order.chunks(gatherer.receivers_per_block().next_multiple_of(CHUNK)) {
        let keep = gatherer.hits && *room > 0;
        let gathered: Vec<(Chunk, Vec<Gathered>)> = block
            .par_chunks(CHUNK)
            .map_init(Worker::new, |worker, ids| {
                let mut results: Vec<Gathered> = ids.iter().map(|_| Gathered::default()).collect();
                for k in gatherer.bank.by_set(ids) {
                    if monitor.is_cancelled() {
                        break;
                    }
                    let result = gatherer.gather(&receivers.list[ids[k] as usize], ids[k], worker);
                    monitor.receiver_done(stage, total, result.visibility_rays + result.bounce_rays);
                    results[k] = result;
                }
                let senders = keep.then(|| Kept::of(gatherer.world, &results));
                results.iter_mut().for_each(|result| keep_wanted(gatherer.world, result));
                (Chunk { ids: ids.to_vec(), senders }, results)
            })
            .collect();
        monitor.check()?;
        for (mut chunk, results) in gathered {
            for (&id, result) in chunk.ids.iter().zip(&results) {
                sink(id, result);
            }
            chunk.keep_within(room);
            chunks.push(chunk);
        }
    }
    Ok(chunks)
}

/// One bounce, \[G\] eq. (11), from number 1: every receiver sums what the surfaces that it sees send on of the bounce before. What surfaces
/// mirror of light that falls on them straight is not in the first: it is found with the direct transfer.
pub(crate) fn bounce_pass(
    gatherer: &Gatherer<'_>,
    receivers: &Receivers,
    chunks: &[Chunk],
    last: &Field,
    number: u32,
    monitor: &Monitor<'_>,
) -> Result<Field, Error> {
    let (stage, mirrors) = (Stage::Bounce(number), number > 1);
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
                    match &chunk.senders {
                        Some(kept) => {
                            add_reflected(receivers, id, kept.scattered.row(k), last, row);
                            if mirrors {
                                add_reflected(receivers, id, kept.mirrored.row(k), last, row);
                            }
                        }
                        None => {
                            // Too much to keep: what the receiver sees is found again.
                            let again = gatherer.gather(&receivers.list[id as usize], id, worker);
                            rays = again.visibility_rays + again.bounce_rays;
                            let mut found = Vec::new();
                            fill_row(gatherer.world, &again.hits, &mut found);
                            add_reflected(receivers, id, &found, last, row);
                            if mirrors {
                                fill_row(gatherer.world, &again.late, &mut found);
                                add_reflected(receivers, id, &found, last, row);
                            }
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
