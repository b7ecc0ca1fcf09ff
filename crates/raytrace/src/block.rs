//! A block of triangles as one origin sees it: the planes through the origin and each edge, ready for any direction.

use crate::exact::volume;
use crate::lanes::Lanes;
use crate::tree::{BLOCK, Block};
use glam::Vec3;

/// Bound on the rounding of an edge product over its largest term (64 units of 2^-24; at most 48 arise).
pub(crate) const SLACK: f32 = 3.814_697_3e-6;

/// Added to every bound for products that vanish below the smallest normal number.
pub(crate) const UNDERFLOW: f32 = 1.0e-40;

/// For each triangle the normals of the planes through the origin and an edge, turned so that a direction meets the
/// triangle where all three products with it are positive, and what rounding can do to a product.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    /// x, y, z of the normal of edge bc, then of ca, then of ab.
    pub(crate) normals: [[f32; BLOCK]; 9],
    /// Bounds for edges bc, ca, ab, for directions of components up to 1.
    pub(crate) slack: [[f32; BLOCK]; 3],
}

impl Seen {
    pub(crate) const NOTHING: Seen = Seen { normals: [[0.0; BLOCK]; 9], slack: [[-1.0; BLOCK]; 3] };
}

/// Three numbers per lane.
pub(crate) type Point<F> = [F; 3];

#[inline(always)]
pub(crate) fn sub<F: Lanes>(a: Point<F>, b: Point<F>) -> Point<F> {
    [a[0].sub(b[0]), a[1].sub(b[1]), a[2].sub(b[2])]
}

#[inline(always)]
pub(crate) fn cross<F: Lanes>(a: Point<F>, b: Point<F>) -> Point<F> {
    [a[1].mul(b[2]).sub(a[2].mul(b[1])), a[2].mul(b[0]).sub(a[0].mul(b[2])), a[0].mul(b[1]).sub(a[1].mul(b[0]))]
}

#[inline(always)]
pub(crate) fn dot<F: Lanes>(a: Point<F>, b: Point<F>) -> F {
    a[0].mul(b[0]).add(a[1].mul(b[1])).add(a[2].mul(b[2]))
}

#[inline(always)]
pub(crate) fn size<F: Lanes>(a: Point<F>) -> F {
    a[0].abs().max(a[1].abs()).max(a[2].abs())
}

/// Normal of the plane through the origin, p and q, and the bound on its products. p × q = p × (q - p) = q × (q - p):
/// the shorter of the two keeps the rounding small beside the edge and not beside the distance.
#[inline(always)]
fn edge<F: Lanes>(p: Point<F>, q: Point<F>) -> (Point<F>, F) {
    let along = sub(q, p);
    let (p_size, q_size) = (size(p), size(q));
    let near = [
        F::where_less(q_size, p_size, q[0], p[0]),
        F::where_less(q_size, p_size, q[1], p[1]),
        F::where_less(q_size, p_size, q[2], p[2]),
    ];
    let bound = q_size.min(p_size).mul(size(along)).mul(F::splat(SLACK)).add(F::splat(UNDERFLOW));
    (cross(near, along), bound)
}

/// Corner `k` of the four triangles, from a point.
#[inline(always)]
fn corner<F: Lanes>(block: &Block, k: usize, from: Point<F>) -> Point<F> {
    let at = [F::load(&block.corners[3 * k]), F::load(&block.corners[3 * k + 1]), F::load(&block.corners[3 * k + 2])];
    sub(at, from)
}

/// The corners from a point.
#[inline(always)]
pub(crate) fn corners<F: Lanes>(block: &Block, origin: Vec3) -> [Point<F>; 3] {
    let from = [F::splat(origin.x), F::splat(origin.y), F::splat(origin.z)];
    [corner(block, 0, from), corner(block, 1, from), corner(block, 2, from)]
}

/// Volume on the corners and the bound on its rounding, from the plane of edge bc.
#[inline(always)]
fn whole<F: Lanes>(a: Point<F>, (normal, bound): (Point<F>, F)) -> (F, F) {
    (dot(a, normal), size(a).mul(bound).add(F::splat(UNDERFLOW)))
}

/// Which triangles of a block one direction from a point may meet, and which of those beyond doubt: for a ray that
/// shares its origin with no other.
#[inline(always)]
pub(crate) fn glance<F: Lanes>(block: &Block, origin: Vec3, direction: Vec3) -> (u32, u32) {
    let [a, b, c] = corners::<F>(block, origin);
    let d = [F::splat(direction.x), F::splat(direction.y), F::splat(direction.z)];
    let zero = F::splat(0.0);
    let first = edge(b, c);
    let (mut ahead, mut behind, mut surely_ahead, mut surely_behind) = (0, 0, u32::MAX, u32::MAX);
    for (normal, bound) in [first, edge(c, a), edge(a, b)] {
        let product = dot(d, normal);
        let (most, least) = (product.add(bound), product.sub(bound));
        let (negative, positive) = (zero.above(most), least.above(zero));
        ahead |= negative;
        behind |= positive;
        surely_ahead &= positive;
        surely_behind &= negative;
    }
    let open = !(ahead & behind) & block.valid;
    if open == 0 {
        return (0, 0);
    }
    let (whole, bound) = whole(a, first);
    let sure = (surely_ahead & whole.above(bound)) | (surely_behind & zero.sub(bound).above(whole));
    (open, open & sure)
}

/// Looks at a block from a point.
#[inline(always)]
pub(crate) fn see<F: Lanes>(block: &Block, origin: Vec3) -> Seen {
    let [a, b, c] = corners::<F>(block, origin);
    let edges = [edge(b, c), edge(c, a), edge(a, b)];
    let (whole, whole_bound) = whole(a, edges[0]);
    let sure = whole.abs().above(whole_bound) & block.valid;
    let turn = F::where_less(whole, F::splat(0.0), F::splat(-1.0), F::splat(1.0));
    let mut turn = turn.mul(F::load(&PRESENT[block.valid as usize % 16]));
    if sure != block.valid {
        let mut turns = [0.0; BLOCK];
        turn.store(&mut turns);
        settle(block, origin, sure, &mut turns);
        turn = F::load(&turns);
    }
    let mut seen = Seen::NOTHING;
    let missing = F::where_less(turn.abs(), F::splat(0.5), F::splat(-1.0), F::splat(0.0));
    for (k, (normal, bound)) in edges.into_iter().enumerate() {
        for (axis, component) in normal.into_iter().enumerate() {
            component.mul(turn).store(&mut seen.normals[3 * k + axis]);
        }
        // Where nothing can be hit the bound is -1 and the normal 0: never a candidate.
        F::where_less(missing, F::splat(0.0), missing, bound).store(&mut seen.slack[k]);
    }
    seen
}

/// One for each bit that is set.
const PRESENT: [[f32; BLOCK]; 16] = present();

const fn present() -> [[f32; BLOCK]; 16] {
    let mut table = [[0.0; BLOCK]; 16];
    let mut i = 0;
    while i < 64 {
        if (i / 4) >> (i % 4) & 1 == 1 {
            table[i / 4][i % 4] = 1.0;
        }
        i += 1;
    }
    table
}

/// Decides exactly on which side the origin lies of the triangles that single precision left open.
#[cold]
#[inline(never)]
fn settle(block: &Block, origin: Vec3, sure: u32, turns: &mut [f32; BLOCK]) {
    let mut open = block.valid & !sure;
    while open != 0 {
        let lane = open.trailing_zeros() as usize;
        open &= open - 1;
        let [a, b, c] = block.corners(lane).map(|corner| corner - origin);
        let whole = volume(a, b, c);
        turns[lane] = if whole == 0.0 { 0.0 } else { whole.signum() as f32 };
    }
}

/// Which triangles of a block some direction between two corners of a box may meet.
///
/// Rounding is monotonous, so a triangle that this leaves out is one that `candidates` would for each direction.
#[inline(always)]
pub(crate) fn candidates_between<F: Lanes>(seen: &Seen, least: Vec3, most: Vec3) -> u32 {
    let zero = F::splat(0.0);
    let least = [F::splat(least.x), F::splat(least.y), F::splat(least.z)];
    let most = [F::splat(most.x), F::splat(most.y), F::splat(most.z)];
    let mut out = 0;
    for k in 0..3 {
        let along = |axis: usize| {
            let normal = F::load(&seen.normals[3 * k + axis]);
            normal.mul(least[axis]).max(normal.mul(most[axis]))
        };
        let product = along(0).add(along(1)).add(along(2));
        out |= zero.above(product.add(F::load(&seen.slack[k])));
    }
    !out & ((1 << BLOCK) - 1)
}

/// Which triangles of a block one direction may meet, and which of those beyond doubt; components up to 1.
#[inline(always)]
pub(crate) fn candidates<F: Lanes>(seen: &Seen, direction: Vec3) -> (u32, u32) {
    let d = [F::splat(direction.x), F::splat(direction.y), F::splat(direction.z)];
    let zero = F::splat(0.0);
    let (mut out, mut sure) = (0, u32::MAX);
    for k in 0..3 {
        let normal =
            [F::load(&seen.normals[3 * k]), F::load(&seen.normals[3 * k + 1]), F::load(&seen.normals[3 * k + 2])];
        let product = dot(d, normal);
        let slack = F::load(&seen.slack[k]);
        out |= zero.above(product.add(slack));
        sure &= product.sub(slack).above(zero);
    }
    let open = !out & ((1 << BLOCK) - 1);
    (open, open & sure)
}
