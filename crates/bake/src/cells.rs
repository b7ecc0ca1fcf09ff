//! Cells of triangles that are too large to carry bounces: what falls on their far corners says little of what falls in between.
//!
//! Where a ray meets such a triangle, the cell around that place has a receiver of its own for the time of the bake. It stands where a ray
//! met it, so never inside of a body nor beyond a wall that the triangle passes through. A cell through which a wall goes falls into parts,
//! one for each side.

mod parts;

use crate::hit::NearPoint;
use crate::receivers::{NONE, Receivers};
use crate::world::World;

/// Triangles are divided whose edges are longer than if so many lay evenly on the surfaces of the scene: finer meshes carry bounces.
const COARSE_TRIANGLES: f64 = 2000.0;
/// Their cells have the size that so many triangles would have.
const EVEN_TRIANGLES: f64 = 16_000.0;
/// Marks triangles whose cells are whole.
const WHOLE: usize = usize::MAX;
/// Most cells along an edge.
const MOST_SIDES: u32 = 64;
/// Most cells of all triangles, but for one of each: thousands of slivers, each as long as the scene, have fewer along their edges.
const MOST_CELLS: usize = 1 << 22;

/// How large triangles are divided into cells; nothing where none is.
#[derive(Debug, Default)]
pub(crate) struct Cells {
    /// Of each traced triangle its entry in `divided`, or [`NONE`]; empty where none is divided.
    index: Vec<u32>,
    divided: Vec<Divided>,
    /// Of each fine place of the divided triangles its part, among those of the triangle.
    part_of: Vec<u32>,
    /// Parts of all.
    count: u32,
}

/// A triangle of `sides` cells along each edge, whose `parts` parts are numbered from `first`, those of its fine places from `fine`; [`WHOLE`]
/// where each cell is a part.
#[derive(Debug, Clone, Copy)]
struct Divided {
    triangle: u32,
    first: u32,
    sides: u32,
    parts: u32,
    fine: usize,
}

impl Cells {
    /// Divides the triangles whose edges are longer than those of evenly spread ones.
    pub(crate) fn of(world: &World<'_>) -> Self {
        let triangles = world.corners.len() as u32;
        let area = |t: u32| {
            let [a, b, c] = world.points(t);
            0.5 * f64::from((b - a).cross(c - a).length())
        };
        let total: f64 = (0..triangles).map(area).sum();
        let [coarse, longest] =
            [COARSE_TRIANGLES, EVEN_TRIANGLES].map(|count| (2.0 * (4.0 * total / count).sqrt()) as f32);
        let is_coarse = |triangle: &u32| world.extent(*triangle) > coarse;
        let most_sides = most_sides((0..triangles).filter(is_coarse).count());
        let mut cells = Self::default();
        for triangle in (0..triangles).filter(is_coarse) {
            let sides = ((world.extent(triangle) / longest).ceil() as u32).min(most_sides);
            cells.index.resize(triangles as usize, NONE);
            cells.index[triangle as usize] = cells.divided.len() as u32;
            let whole = Divided { triangle, first: cells.count, sides, parts: 0, fine: cells.part_of.len() };
            let places = f64::from(whole.fine().sides).powi(2);
            let found = if are_few(places, area(triangle) / total) { parts::parts(world, &whole) } else { None };
            let divided = match found {
                Some((part_of, parts)) => {
                    cells.part_of.extend(part_of);
                    Divided { parts, ..whole }
                }
                None => Divided { parts: sides * sides, fine: WHOLE, ..whole },
            };
            cells.count += divided.parts;
            cells.divided.push(divided);
        }
        cells
    }

    /// The cell, or the part of one, of a point of a traced triangle, where that is divided.
    pub(crate) fn at(&self, triangle: u32, barycentrics: [f32; 2]) -> Option<u32> {
        let index = *self.index.get(triangle as usize)?;
        let divided = self.divided.get(index as usize)?;
        let part = match divided.fine {
            WHOLE => divided.place(barycentrics),
            fine => self.part_of[fine + divided.fine().place(barycentrics) as usize],
        };
        Some(divided.first + part)
    }

    /// Cells along the edges of a traced triangle.
    pub(crate) fn sides(&self, triangle: u32) -> u32 {
        let index = self.index.get(triangle as usize).copied().unwrap_or(NONE);
        self.divided.get(index as usize).map_or(1, |divided| divided.sides)
    }

    /// How far a point of a divided triangle is from the middle of its cell, squared, in barycentrics.
    pub(crate) fn off_middle(&self, point: &NearPoint) -> f32 {
        let sides = self.sides(point.triangle) as f32;
        let [u, v] = point.barycentrics.map(|x| (x * sides).fract());
        let middle = if u + v > 1.0 { 2.0 / 3.0 } else { 1.0 / 3.0 };
        (u - middle).powi(2) + (v - middle).powi(2)
    }

    /// Gives cells without a receiver that of the nearest cell of their side, or of the other side, or a corner: what is met there was
    /// met by no ray before.
    pub(crate) fn complete(&self, world: &World<'_>, receivers: &mut Receivers) {
        receivers.cell_of.resize(2 * self.count as usize, NONE);
        for divided in &self.divided {
            let corner = world.corners[divided.triangle as usize][0];
            let cells = divided.first..divided.first + divided.parts;
            let middles = self.middles(divided);
            for side in [0, 1] {
                let slot = |cell: u32| (2 * cell + side) as usize;
                let (of, middle) = (&receivers.cell_of, |cell: u32| middles[(cell - divided.first) as usize]);
                let known: Vec<(u32, [f32; 2])> =
                    cells.clone().filter(|&c| of[slot(c)] != NONE).map(|c| (of[slot(c)], middle(c))).collect();
                let nearest = |cell: u32| {
                    let [u, v] = middle(cell);
                    let away = |[x, y]: [f32; 2]| (x - u).powi(2) + (y - v).powi(2);
                    known.iter().min_by(|a, b| away(a.1).total_cmp(&away(b.1))).map(|(receiver, _)| *receiver)
                };
                let missing: Vec<u32> = cells.clone().filter(|&c| of[slot(c)] == NONE).collect();
                let found: Vec<(usize, u32)> =
                    missing.into_iter().filter_map(|c| nearest(c).map(|r| (slot(c), r))).collect();
                found.into_iter().for_each(|(slot, receiver)| receivers.cell_of[slot] = receiver);
            }
            for cell in cells {
                let [front, back] = [2 * cell, 2 * cell + 1].map(|slot| receivers.cell_of[slot as usize]);
                let either = if front != NONE { front } else { back };
                let either = if either != NONE { either } else { corner };
                for (slot, own) in [(2 * cell, front), (2 * cell + 1, back)] {
                    receivers.cell_of[slot as usize] = if own != NONE { own } else { either };
                }
            }
        }
    }
}

impl Cells {
    /// Of each part of a triangle a place in it, barycentrics.
    fn middles(&self, divided: &Divided) -> Vec<[f32; 2]> {
        if divided.fine == WHOLE {
            return (0..divided.parts).map(|cell| divided.middle(cell)).collect();
        }
        let (fine, mut middles) = (divided.fine(), vec![[0.0; 2]; divided.parts as usize]);
        for place in 0..fine.sides * fine.sides {
            middles[self.part_of[divided.fine + place as usize] as usize] = fine.middle(place);
        }
        middles
    }
}

/// Most cells along an edge where so many triangles are divided.
fn most_sides(triangles: usize) -> u32 {
    let even = (MOST_CELLS / triangles.max(1)).isqrt() as u32;
    even.clamp(1, MOST_SIDES)
}

/// Whether so many fine places are no more than a triangle's share of the area allows: slivers have many, and nothing stands between them.
fn are_few(places: f64, share: f64) -> bool {
    places <= parts::MOST_PLACES * share
}

impl Divided {
    /// The same triangle in fine places.
    fn fine(&self) -> Self {
        Self { sides: self.sides * parts::FINE, ..*self }
    }

    /// Number of the cell of a point within its triangle. Row `j` has `2 (sides - j) - 1` cells.
    fn place(&self, [u, v]: [f32; 2]) -> u32 {
        let n = self.sides;
        let j = ((v * n as f32) as u32).min(n - 1);
        let i = ((u * n as f32) as u32).min(n - 1 - j);
        let beyond = (u + v) * n as f32 > (i + j + 1) as f32 && i + j + 1 < n;
        j * (2 * n - j) + 2 * i + u32::from(beyond)
    }

    /// The middle of a cell of this triangle, barycentrics.
    fn middle(&self, place: u32) -> [f32; 2] {
        let n = self.sides;
        let j = (0..n).rev().find(|j| j * (2 * n - j) <= place).unwrap_or(0);
        let rest = place - j * (2 * n - j);
        let inset = if rest % 2 == 1 { 2.0 / 3.0 } else { 1.0 / 3.0 };
        [(rest / 2) as f32, j as f32].map(|x| (x + inset) / n as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::{Divided, MOST_CELLS, MOST_SIDES, are_few, most_sides, parts};

    /// Few triangles have all the cells that they call for; however many there are, the number of cells stays within its bound.
    #[test]
    fn cells_stay_within_their_bound() {
        assert_eq!([0, 12, 1000].map(most_sides), [MOST_SIDES; 3]);
        for triangles in [2000, 100_000, 1_000_000, (1 << 30) - 1] {
            let cells = triangles * (most_sides(triangles) as usize).pow(2);
            assert!(cells <= MOST_CELLS.max(triangles), "{cells} cells of {triangles}");
        }
        // Of twelve triangles of a box all are looked at, of thousands of slivers as long as the scene none.
        let places = |sides: u32| f64::from(parts::FINE * sides).powi(2);
        assert!(are_few(places(37), 1.0 / 12.0) && !are_few(places(MOST_SIDES), 1.0 / 2000.0));
        // Twin: all that they call for would be too many to be counted.
        assert!(u32::try_from(1_100_000 * u64::from(MOST_SIDES).pow(2)).is_err());
    }

    /// Every cell is found from its middle, cells have the same area, and a point is nearest to the middle of its own.
    #[test]
    fn cells_divide_a_triangle() {
        for sides in [1, 2, 5, 64] {
            let divided = Divided { triangle: 0, first: 0, sides, parts: 0, fine: 0 };
            for cell in 0..sides * sides {
                assert_eq!(divided.place(divided.middle(cell)), cell, "of {sides} sides");
            }
            let mut count = vec![0u32; (sides * sides) as usize];
            let fine = 12 * sides;
            for k in 0..fine * fine {
                let [u, v] = [k % fine, k / fine].map(|x| (x as f32 + 0.5) / fine as f32);
                if u + v < 1.0 {
                    count[divided.place([u, v]) as usize] += 1;
                }
            }
            // Of 144 points of a square of two cells, those of the diagonal may fall on either side.
            assert!(count.iter().all(|n| (60..=78).contains(n)), "{count:?}");
        }
        assert_eq!(
            Divided { triangle: 0, first: 0, sides: 3, parts: 0, fine: 0 }.place([0.0, 1.0]),
            8,
            "the far corner has a cell"
        );
    }
}
