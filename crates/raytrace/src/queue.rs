//! Puts the rays of a fan together in groups that go into one octant.

use crate::lanes::Lanes;
use crate::packet::{Many, WIDEST};
use crate::ray::Ray;
use glam::Vec3;

/// Directions from one point, by structure of arrays.
#[derive(Clone, Copy)]
pub(crate) struct Directions<'a> {
    pub(crate) origin: Vec3,
    pub(crate) each: [&'a [f32]; 3],
}

impl Directions<'_> {
    pub(crate) fn len(&self) -> usize {
        self.each[0].len()
    }

    pub(crate) fn ray(&self, i: usize) -> Ray {
        Ray::new(self.origin, Vec3::new(self.each[0][i], self.each[1][i], self.each[2][i]))
    }
}

/// Rays of one octant; those past the last alive one repeat the first.
#[derive(Debug)]
pub(crate) struct Group {
    pub(crate) directions: [Many; 3],
    /// Places in the list of directions.
    pub(crate) numbers: [u32; WIDEST],
    pub(crate) alive: u32,
    /// One bit per axis: set where the directions are negative.
    pub(crate) octant: usize,
    /// Whether the rays are neighbours in the list.
    neighbours: bool,
}

impl Group {
    const EMPTY: Group =
        Group { directions: [[1.0; WIDEST]; 3], numbers: [0; WIDEST], alive: 0, octant: 0, neighbours: false };

    /// The direction that stands for the group.
    #[inline(always)]
    pub(crate) fn middle<R: Lanes>(&self) -> [f32; 3] {
        let [x, y, z] = &self.directions;
        [x[R::N / 2], y[R::N / 2], z[R::N / 2]]
    }

    /// Sets the bits of the rays that are stopped.
    #[inline(always)]
    pub(crate) fn mark(&self, stopped: u32, blocked: &mut [u64]) {
        if self.neighbours {
            // Such a group lies within one word: its width divides 64.
            blocked[self.numbers[0] as usize / 64] |= u64::from(stopped) << (self.numbers[0] % 64);
            return;
        }
        let mut left = stopped;
        while left != 0 {
            let number = self.numbers[left.trailing_zeros() as usize];
            left &= left - 1;
            blocked[number as usize / 64] |= 1 << (number % 64);
        }
    }
}

/// Rays of one octant that wait for others: a group of neighbours at most joins those that fill no group yet.
#[derive(Clone, Copy, Debug)]
struct Bin {
    directions: [[f32; 2 * WIDEST]; 3],
    numbers: [u32; 2 * WIDEST],
    n: usize,
}

impl Bin {
    const EMPTY: Bin = Bin { directions: [[0.0; 2 * WIDEST]; 3], numbers: [0; 2 * WIDEST], n: 0 };

    fn put(&mut self, direction: Vec3, number: usize) {
        for axis in 0..3 {
            self.directions[axis][self.n] = direction[axis];
        }
        self.numbers[self.n] = number as u32;
        self.n += 1;
    }

    /// Takes the last rays, as many as a packet holds.
    fn take(&mut self, width: usize, group: &mut Group) {
        let first = self.n.saturating_sub(width);
        let n = self.n - first;
        for axis in 0..3 {
            group.directions[axis][..n].copy_from_slice(&self.directions[axis][first..self.n]);
            group.directions[axis][n..].fill(self.directions[axis][first]);
        }
        group.numbers[..n].copy_from_slice(&self.numbers[first..self.n]);
        group.alive = (1 << n) - 1;
        group.neighbours = false;
        self.n = first;
    }
}

/// The rays of a fan that are still to be traced.
#[derive(Debug)]
pub(crate) struct Queue {
    bins: [Bin; 8],
    next: usize,
    /// The octant whose bin may be full.
    full: Option<usize>,
    /// The group under way, filled in place: it is read at once, and copies would wait for the writes.
    pub(crate) group: Group,
}

impl Queue {
    pub(crate) fn new() -> Queue {
        Queue { bins: [Bin::EMPTY; 8], next: 0, full: None, group: Group::EMPTY }
    }

    pub(crate) fn start(&mut self) {
        self.next = 0;
        self.full = None;
        self.bins.iter_mut().for_each(|bin| bin.n = 0);
    }

    /// Fills the next group: neighbours where they go into one octant, else rays that have come together.
    #[inline(always)]
    pub(crate) fn advance<R: Lanes>(&mut self, directions: &Directions<'_>) -> bool {
        while self.full.is_none() && self.next < directions.len() {
            let first = self.next;
            self.next += R::N;
            if self.next <= directions.len() && self.neighbours::<R>(directions, first) {
                return true;
            }
            self.sort_in(directions, first, R::N);
        }
        self.advance_in_bins(R::N)
    }

    /// Takes as many neighbours as a packet holds, if they go into one octant.
    #[inline(always)]
    fn neighbours<R: Lanes>(&mut self, directions: &Directions<'_>, first: usize) -> bool {
        let zero = R::splat(0.0);
        let all = (1u32 << R::N) - 1;
        let mut octant = 0;
        for axis in 0..3 {
            let row = R::load(&directions.each[axis][first..]);
            let negative = zero.above(row);
            if negative != 0 && negative != all {
                return false;
            }
            octant |= usize::from(negative != 0) << axis;
            row.store(&mut self.group.directions[axis]);
        }
        for (number, i) in self.group.numbers[..R::N].iter_mut().zip(first as u32..) {
            *number = i;
        }
        self.group.alive = all;
        self.group.octant = octant;
        self.group.neighbours = true;
        true
    }

    /// Takes rays that have come together in an octant.
    #[inline(never)]
    fn advance_in_bins(&mut self, width: usize) -> bool {
        let Some(octant) = self.full.take().or_else(|| (0..8).find(|&octant| self.bins[octant].n > 0)) else {
            return false;
        };
        self.bins[octant].take(width, &mut self.group);
        self.group.octant = octant;
        self.full = (0..8).find(|&octant| self.bins[octant].n >= width);
        true
    }

    /// Leaves some neighbours with others of their octants.
    #[inline(never)]
    fn sort_in(&mut self, directions: &Directions<'_>, first: usize, width: usize) {
        for i in first..(first + width).min(directions.len()) {
            let d = directions.ray(i).direction;
            let octant = usize::from(d.x < 0.0) | usize::from(d.y < 0.0) << 1 | usize::from(d.z < 0.0) << 2;
            self.bins[octant].put(d, i);
            if self.bins[octant].n >= width {
                self.full = Some(octant);
            }
        }
    }
}
