//! The rays of a fan, as many at a time as a packet holds.

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

/// Directions of the list that are traced together; where there are too few, the first stands in for the rest.
#[derive(Debug)]
pub(crate) struct Group {
    pub(crate) directions: [Many; 3],
    /// Place of the first in the list.
    pub(crate) first: usize,
    /// Places of all in the list, where they are no neighbours.
    pub(crate) members: [usize; WIDEST],
    /// One bit for each member.
    pub(crate) alive: u32,
}

impl Group {
    pub(crate) fn new() -> Group {
        Group { directions: [[1.0; WIDEST]; 3], first: 0, members: [0; WIDEST], alive: 0 }
    }

    /// Fills the group in place with neighbours in the list: it is read at once, and a copy would wait for the writes.
    #[inline(always)]
    pub(crate) fn fill<R: Lanes>(&mut self, directions: &Directions<'_>, first: usize) {
        let n = (directions.len() - first).min(R::N);
        for (row, each) in self.directions.iter_mut().zip(directions.each) {
            if n == R::N {
                R::load(&each[first..]).store(row);
            } else {
                row.fill(each[first]);
                row[..n].copy_from_slice(&each[first..]);
            }
        }
        self.first = first;
        self.alive = (1 << n) - 1;
    }

    /// Fills the group with the next directions of a sequence of places, as many as a packet holds.
    #[inline(always)]
    pub(crate) fn gather<R: Lanes>(&mut self, directions: &Directions<'_>, places: &mut impl Iterator<Item = usize>) {
        let mut n = 0;
        for place in places.take(R::N) {
            self.members[n] = place;
            n += 1;
        }
        self.alive = (1 << n) - 1;
        if n == 0 {
            return;
        }
        self.first = self.members[0];
        self.members[n..].fill(self.first);
        for (row, each) in self.directions.iter_mut().zip(directions.each) {
            for (value, &place) in row[..R::N].iter_mut().zip(&self.members) {
                *value = each[place];
            }
        }
    }

    /// The direction that stands for the group.
    #[inline(always)]
    pub(crate) fn middle<R: Lanes>(&self) -> [f32; 3] {
        let [x, y, z] = &self.directions;
        [x[R::N / 2], y[R::N / 2], z[R::N / 2]]
    }

    /// Sets the bits of the rays that are stopped, of a group of neighbours.
    #[inline(always)]
    pub(crate) fn mark(&self, stopped: u32, blocked: &mut [u64]) {
        // Neighbours lie within one word: a group's width divides 64.
        blocked[self.first / 64] |= u64::from(stopped) << (self.first % 64);
    }
}
