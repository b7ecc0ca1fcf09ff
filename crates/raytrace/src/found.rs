//! What each ray of a packet has found so far: the nearest triangle, and how far it is within bounds.

use crate::block::Point;
use crate::depth::Depth;
use crate::lanes::Lanes;
use crate::meetings::Meetings;
use crate::nearest::nearer;
use crate::packet::{Many, WIDEST};
use crate::ray::{Hit, Line};
use crate::tree::Tree;
use crate::walk::Solid;
use glam::Vec3;

/// A triangle in the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    pub(crate) block: u32,
    pub(crate) lane: u32,
    /// Its number in the input.
    pub(crate) triangle: u32,
}

impl Place {
    const NOWHERE: Place = Place { block: 0, lane: 0, triangle: u32::MAX };

    pub(crate) fn new(tree: &Tree, block: usize, lane: usize) -> Place {
        Place { block: block as u32, lane: lane as u32, triangle: tree.blocks[block].triangles[lane] }
    }
}

/// The nearest triangle of each ray. Its exact hit is worked out only where that decides between two, or at the end.
#[derive(Debug)]
pub(crate) struct Found {
    /// The nearest hit lies between these; infinite where there is none, and minus infinity beyond the packet.
    near: Many,
    far: Many,
    place: [Place; WIDEST],
    /// Another triangle about as near, where bounds do not tell the two apart.
    rival: [Place; WIDEST],
    /// The exact hit of the one, where it has been worked out.
    hit: [Option<Hit>; WIDEST],
    /// The largest of `far`: no ray of the packet looks beyond it.
    pub(crate) reach: f32,
}

impl Found {
    pub(crate) fn new() -> Found {
        Found {
            near: [f32::INFINITY; WIDEST],
            far: [f32::INFINITY; WIDEST],
            place: [Place::NOWHERE; WIDEST],
            rival: [Place::NOWHERE; WIDEST],
            hit: [None; WIDEST],
            reach: f32::INFINITY,
        }
    }

    /// Makes ready for a packet of which the first `n` rays count.
    pub(crate) fn start(&mut self, n: usize) {
        *self = Found::new();
        self.far[n..].fill(f32::NEG_INFINITY);
    }

    /// Beyond which parameter a ray has nothing to look for.
    #[inline(always)]
    pub(crate) fn far(&self, ray: usize) -> f32 {
        self.far[ray]
    }

    /// The same for all rays.
    #[inline(always)]
    pub(crate) fn all_far<R: Lanes>(&self) -> R {
        R::load(&self.far)
    }

    /// Follows a change of `far`.
    #[inline(always)]
    pub(crate) fn tighten<R: Lanes>(&mut self) {
        self.reach = R::load(&self.far).highest();
    }

    /// Takes a triangle where it is surely the nearest so far. `maybe` and `sure` are the rays that may meet it
    /// and those that do; returns the rays of which the exact meeting has to decide.
    #[inline(always)]
    pub(crate) fn offer<R: Lanes>(
        &mut self,
        place: Place,
        (maybe, sure): (u32, u32),
        depth: &Depth<R>,
        direction: Point<R>,
    ) -> u32 {
        let (near, far) = depth.range(direction);
        let (near_now, far_now) = (R::load(&self.near), R::load(&self.far));
        let open = maybe & !near.above(far_now);
        let nearest = open & sure & near_now.above(far);
        if nearest != 0 {
            R::choose(nearest, near, near_now).store(&mut self.near);
            R::choose(nearest, far, far_now).store(&mut self.far);
            for ray in rays_of(nearest) {
                self.put(ray, place);
            }
        }
        let doubt = open & !nearest;
        if doubt == 0 {
            return 0;
        }
        let (mut nears, mut fars) = ([0.0; WIDEST], [0.0; WIDEST]);
        near.store(&mut nears);
        far.store(&mut fars);
        self.compare(place, doubt, sure, &nears, &fars)
    }

    /// Keeps a triangle as the rival of what rays have found where it surely meets them and they have none yet; returns
    /// the rays of which the exact meeting has to decide.
    #[inline(always)]
    fn compare(&mut self, place: Place, rays: u32, sure: u32, near: &Many, far: &Many) -> u32 {
        let mut undecided = 0;
        for ray in rays_of(rays) {
            let decided =
                self.knows(ray, place) || (sure >> ray & 1 == 1 && self.challenge(ray, place, near[ray], far[ray]));
            undecided |= u32::from(!decided) << ray;
        }
        undecided
    }

    /// Whether a ray has the triangle already: parts of one triangle are one.
    #[inline(always)]
    fn knows(&self, ray: usize, place: Place) -> bool {
        self.place[ray].triangle == place.triangle || self.rival[ray].triangle == place.triangle
    }

    /// Makes a triangle that a ray surely meets the rival of its nearest, where it has one and no rival.
    #[inline(always)]
    fn challenge(&mut self, ray: usize, place: Place, near: f32, far: f32) -> bool {
        let free = self.is_open(ray) && self.rival[ray] == Place::NOWHERE;
        if free {
            self.rival[ray] = place;
            self.near[ray] = self.near[ray].min(near);
            self.far[ray] = self.far[ray].min(far);
        }
        free
    }

    /// [`Found::offer`] to one ray of a triangle that it surely meets between two parameters: whether that decided.
    #[inline(always)]
    pub(crate) fn offer_one(&mut self, ray: usize, place: Place, near: f32, far: f32) -> bool {
        let nearest = far < self.near[ray];
        if nearest {
            (self.near[ray], self.far[ray]) = (near, far);
            self.put(ray, place);
        }
        nearest || self.knows(ray, place) || self.challenge(ray, place, near, far)
    }

    #[inline(always)]
    fn put(&mut self, ray: usize, place: Place) {
        self.place[ray] = place;
        self.rival[ray] = Place::NOWHERE;
        self.hit[ray] = None;
    }

    /// Decides exactly whether a triangle is nearer to a ray than what it has found, or as near and of a smaller number.
    #[inline(never)]
    pub(crate) fn decide(&mut self, ray: usize, place: Place, line: &Line, tree: &Tree, solid: Solid<'_>) {
        if self.knows(ray, place) {
            return;
        }
        let best = self.settle(ray, line, tree);
        let block = &tree.blocks[place.block as usize];
        if let Some(hit) = nearer(block, place.lane as usize, line, best.as_ref(), solid) {
            self.place[ray] = place;
            self.hit[ray] = Some(hit);
        }
        if let Some(hit) = self.hit[ray] {
            (self.near[ray], self.far[ray]) = (hit.t, hit.t);
        }
    }

    /// The triangle that a ray meets first, and where.
    #[inline(always)]
    pub(crate) fn settle(&mut self, ray: usize, line: &Line, tree: &Tree) -> Option<Hit> {
        let place = self.place[ray];
        if self.is_open(ray) {
            let block = &tree.blocks[place.block as usize];
            self.hit[ray] = nearer(block, place.lane as usize, line, None, &|_, _, _| true);
        }
        let rival = std::mem::replace(&mut self.rival[ray], Place::NOWHERE);
        if rival != Place::NOWHERE {
            let block = &tree.blocks[rival.block as usize];
            if let Some(hit) = nearer(block, rival.lane as usize, line, self.hit[ray].as_ref(), &|_, _, _| true) {
                self.place[ray] = rival;
                self.hit[ray] = Some(hit);
            }
        }
        self.hit[ray]
    }

    /// Works out the hits of the first `n` rays side by side, but for those that ask for more than double precision.
    #[inline(always)]
    pub(crate) fn settle_all(
        &mut self,
        tree: &Tree,
        origin: Vec3,
        directions: &[Many; 3],
        n: usize,
        meetings: &mut Meetings,
    ) {
        let mut rivals = 0;
        let mut open = 0;
        for ray in 0..n {
            open |= u32::from(self.is_open(ray)) << ray;
            rivals |= u32::from(self.rival[ray] != Place::NOWHERE) << ray;
        }
        meetings.run(tree, origin, directions, &self.place, open);
        for ray in rays_of(open) {
            self.hit[ray] = meetings.hit(ray, self.place[ray].triangle);
        }
        if rivals == 0 {
            return;
        }
        meetings.run(tree, origin, directions, &self.rival, rivals);
        for ray in rays_of(rivals) {
            let (Some(best), Some(hit)) = (self.hit[ray], meetings.hit(ray, self.rival[ray].triangle)) else {
                continue;
            };
            let rival = std::mem::replace(&mut self.rival[ray], Place::NOWHERE);
            if (hit.t, hit.triangle) < (best.t, best.triangle) {
                self.hit[ray] = Some(hit);
                self.place[ray] = rival;
            }
        }
    }

    /// Whether a ray has a triangle of which the exact hit has not been worked out.
    #[inline(always)]
    pub(crate) fn is_open(&self, ray: usize) -> bool {
        self.hit[ray].is_none() && self.place[ray] != Place::NOWHERE
    }

    /// Where that triangle is in the tree; meaningful where there is a hit.
    pub(crate) fn place(&self, ray: usize) -> Place {
        self.place[ray]
    }
}

/// The rays of a mask.
#[inline(always)]
pub(crate) fn rays_of(mut mask: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let ray = mask.trailing_zeros() as usize;
        mask &= mask.wrapping_sub(1);
        (ray < 32).then_some(ray)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::depth::Depths;
    use crate::lanes::Row;
    use crate::tree::{BLOCK, Block};

    /// Four rays along z offered planes at two heights each, so that each triangle is the nearest of some rays and about
    /// as near as another's for the rest; returns the bounds that the last ray is left with.
    fn bounds_of_a_rival(heights: [f32; 2]) -> (f32, f32) {
        let mut found = Found::new();
        found.start(2);
        let direction = [Row::<8>::splat(0.0), Row::splat(0.0), Row::splat(1.0)];
        for (number, height) in heights.into_iter().enumerate() {
            let mut block = Block { corners: [[0.0; BLOCK]; 9], triangles: [0; BLOCK], valid: 15, masked: 0 };
            for (k, (x, y)) in [(-1.0, -1.0), (2.0, -1.0), (-1.0, 2.0)].into_iter().enumerate() {
                (block.corners[3 * k], block.corners[3 * k + 1]) = ([x; BLOCK], [y; BLOCK]);
                block.corners[3 * k + 2] = [height; BLOCK];
            }
            let depth = Depths::of::<Row<4>>(&block, Vec3::ZERO).one::<Row<8>>(0);
            let place = Place { block: 0, lane: 0, triangle: number as u32 };
            // The first triangle is there for the second ray only, the second for both.
            let rays = if number == 0 { 2 } else { 3 };
            assert_eq!(found.offer(place, (rays, rays), &depth, direction), 0, "bounds and rivals decide");
        }
        (found.near[1], found.far[1])
    }

    #[test]
    fn a_rival_lowers_the_bounds_while_others_take_the_triangle() {
        let (alone, _) = bounds_of_a_rival([1.0, 3.0]);
        let (near, far) = bounds_of_a_rival([1.0, 1.0 - f32::EPSILON]);
        assert!(near < alone, "the rival's lower bound counts: {near} against {alone}");
        assert!(far >= 1.0 - f32::EPSILON, "and both lie within: {far}");
    }

    #[test]
    fn lowering_can_fail() {
        assert_eq!(
            bounds_of_a_rival([1.0, 3.0]),
            bounds_of_a_rival([1.0, 1.0 + 1.0e-2]),
            "what is beyond changes nothing"
        );
    }
}
