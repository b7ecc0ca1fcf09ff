//! Parts of the tree that lie under a fan: planes close below its origin that all of its rays leave.
//!
//! Rays leave a surface from just above it, where the widened boxes of what lies in its plane hold their origin. Of slivers, whose boxes
//! overlap, those are hundreds, and no ray meets any of them.

use crate::group::Directions;
use crate::tracer::Tracer;
use crate::tree::{Child, Tree, WIDTH};
use crate::walk::widening;
use glam::Vec3;
use std::sync::atomic::Ordering;

/// Boxes around an origin from which on they are too many. Compact triangles have fewer.
const CROWD: usize = 64;

/// Most boxes around an origin that are counted.
const MOST_BOXES: usize = 512;

/// Of so many origins the boxes around one are counted.
const PART: usize = 8;

/// Such boxes per block of the tree from which on it is worth knowing what lies under fans.
const WORTH: usize = 16;

/// Planes close below an origin that are looked for.
const PLANES: usize = 3;

/// Least rise of a unit direction above a plane that rounding leaves no doubt of.
const LEAST_RISE: f32 = 1e-6;

/// Components of a unit direction stay below this.
const LARGEST_UNIT: f32 = 1.001;

/// Nodes whose answers are kept, by the low bits of their number.
const PLACES: usize = 1024;

/// What lies under the fans from one origin.
#[derive(Debug)]
pub(crate) struct Under {
    origin: Vec3,
    /// Normals of planes close below the origin, and the least rise of the fan's directions along each.
    planes: Vec<(Vec3, f32)>,
    open: Vec<Child>,
    /// Fan and node, and whether it lies under the fan.
    kept: Vec<(u64, bool)>,
    fan: u64,
    origins: usize,
    /// Nodes that were opened.
    pub(crate) visits: usize,
}

impl Under {
    pub(crate) fn new() -> Under {
        let kept = vec![(0, false); PLACES];
        Under { origin: Vec3::ZERO, planes: Vec::new(), open: Vec::new(), kept, fan: 0, origins: 0, visits: 0 }
    }

    /// Looks for planes close below a new origin, once many origins had crowds of boxes around them.
    pub(crate) fn find(&mut self, tracer: &Tracer, origin: Vec3) {
        self.origin = origin;
        self.planes.clear();
        let is_worth = |boxes: usize| boxes > WORTH * tracer.tree.blocks.len();
        if is_worth(tracer.crowds.load(Ordering::Relaxed)) {
            tracer.tree.flats();
            self.boxes_around(&tracer.tree, true, CROWD);
            return;
        }
        self.origins += 1;
        if self.origins.is_multiple_of(PART) {
            let boxes = self.boxes_around(&tracer.tree, false, MOST_BOXES);
            if boxes > CROWD {
                tracer.crowds.fetch_add(PART * boxes, Ordering::Relaxed);
            }
        }
    }

    /// Counts the boxes around the origin up to a limit; notes the planes below it of what they hold.
    fn boxes_around(&mut self, tree: &Tree, note: bool, limit: usize) -> usize {
        let widen = widening(tree, self.origin);
        self.open.clear();
        self.open.push(Child::node(0));
        let mut boxes = 0;
        while let Some(child) = self.open.pop() {
            boxes += 1;
            if boxes == limit || self.planes.len() == PLANES {
                break;
            }
            if child.as_block().is_some() {
                continue;
            }
            let plane = if note { tree.flats().plane_below(child.index(), self.origin) } else { None };
            if let Some(normal) = plane {
                if self.planes.iter().all(|(known, _)| known.distance(normal) > 1e-3) {
                    self.planes.push((normal, 0.0));
                }
                continue;
            }
            let node = &tree.nodes[child.index()];
            let mut inside = [true; WIDTH];
            for axis in 0..3 {
                let (high, low) = (self.origin[axis] + widen, self.origin[axis] - widen);
                let bounds = node.bounds[axis].iter().zip(&node.bounds[axis + 3]);
                inside.iter_mut().zip(bounds).for_each(|(is, (lower, upper))| *is &= *lower <= high && *upper >= low);
            }
            // Empty boxes hold nothing.
            self.open.extend(node.children.iter().zip(inside).filter(|(_, is)| *is).map(|(child, _)| *child));
        }
        boxes
    }

    /// Makes ready for a fan from that origin.
    pub(crate) fn start(&mut self, directions: &Directions<'_>) {
        self.planes.iter_mut().for_each(|(normal, rise)| *rise = least_rise(directions, *normal));
        self.planes.retain(|&(_, rise)| rise > LEAST_RISE);
        self.fan += 1;
        if self.fan >> 32 != 0 {
            self.fan = 1;
            self.kept.fill((0, false));
        }
    }

    /// Whether no ray of the fan meets anything below a node.
    #[inline(always)]
    pub(crate) fn holds(&mut self, tree: &Tree, node: usize) -> bool {
        let held = !self.planes.is_empty() && self.looked_up(tree, node);
        self.visits += usize::from(!held);
        held
    }

    fn looked_up(&mut self, tree: &Tree, node: usize) -> bool {
        let key = self.fan << 32 | node as u64;
        let place = node % PLACES;
        if self.kept[place].0 != key {
            let normal = tree.flats().plane_below(node, self.origin);
            // A unit direction rises above planes that are nearly one alike.
            let all_rise = |normal: Vec3| {
                self.planes.iter().any(|(known, rise)| rise - 2.0 * normal.distance(*known) > LEAST_RISE)
            };
            self.kept[place] = (key, normal.is_some_and(all_rise));
        }
        self.kept[place].1
    }
}

/// The least rise of a fan's directions along a normal; below zero where some are no unit directions.
fn least_rise(directions: &Directions<'_>, normal: Vec3) -> f32 {
    let [xs, ys, zs] = directions.each;
    let (mut least, mut most) = (f32::INFINITY, 0.0f32);
    for ((x, y), z) in xs.iter().zip(ys).zip(zs) {
        least = least.min(normal.x * x + normal.y * y + normal.z * z);
        most = most.max(x.abs().max(y.abs()).max(z.abs()));
    }
    if most > LARGEST_UNIT { -1.0 } else { least }
}
