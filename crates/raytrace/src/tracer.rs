//! The public face: triangles in, answers about rays out.

use crate::block::see;
use crate::build::build;
use crate::lanes::{Path, Portable};
use crate::ray::{Hit, Line, Ray};
use crate::tree::{Child, Tree};
use crate::walk::{Solid, Walker, blocked, nearest};
use glam::Vec3;
use std::cell::Cell;

thread_local! {
    /// The stack of this thread's walks: taken while one is under way, so that a filter may trace rays too.
    static STACK: Cell<Vec<u32>> = const { Cell::new(Vec::new()) };
}

/// Triangles made ready for rays.
///
/// Answers do not depend on the processor, on the shape of the tree or on the order of the rays: a ray meets a triangle
/// if it does so exactly, for corners translated to its origin in single precision.
#[derive(Debug, Default)]
pub struct Tracer {
    pub(crate) tree: Tree,
}

impl Tracer {
    /// Builds a tracer; `masked` says which triangles ask the filter, and is empty where none does.
    ///
    /// Triangles with a corner that is missing, not finite or beyond 2^40 units are left out, as are those
    /// with two corners in one place.
    pub fn build(positions: &[Vec3], triangles: &[[u32; 3]], masked: &[bool]) -> Tracer {
        Tracer {
            tree: build(positions, triangles, masked),
        }
    }

    /// Bytes that the tree takes.
    pub fn memory(&self) -> usize {
        size_of_val(self.tree.nodes.as_slice()) + size_of_val(self.tree.blocks.as_slice())
    }

    /// The nearest hit; of equally near ones that of the smallest triangle number. `solid` (triangle, u, v) says
    /// whether a masked triangle is there at a point, and is asked about no others.
    pub fn closest(&self, ray: &Ray, solid: &dyn Fn(u32, f32, f32) -> bool) -> Option<Hit> {
        let line = self.line(ray)?;
        with_stack(|stack| closest_on::<Portable>(&self.tree, line, stack, solid))
    }

    /// Whether anything lies on the ray; `solid` as for [`Tracer::closest`].
    pub fn occluded(&self, ray: &Ray, solid: &dyn Fn(u32, f32, f32) -> bool) -> bool {
        let Some(line) = self.line(ray) else {
            return false;
        };
        with_stack(|stack| occluded_on::<Portable>(&self.tree, line, stack, solid))
    }

    fn line(&self, ray: &Ray) -> Option<Line> {
        if self.tree.nodes.is_empty() {
            None
        } else {
            Line::new(ray)
        }
    }
}

fn with_stack<R>(work: impl FnOnce(&mut Vec<u32>) -> R) -> R {
    let mut stack = STACK.take();
    let result = work(&mut stack);
    STACK.set(stack);
    result
}

#[inline(always)]
fn closest_on<P: Path>(
    tree: &Tree,
    line: Line,
    stack: &mut Vec<u32>,
    solid: Solid<'_>,
) -> Option<Hit> {
    nearest::<P>(tree, &Walker::new(tree, line), stack, solid)
}

#[inline(always)]
fn occluded_on<P: Path>(tree: &Tree, line: Line, stack: &mut Vec<u32>, solid: Solid<'_>) -> bool {
    let view = |index: usize| see::<P::Four>(&tree.blocks[index], line.origin);
    blocked::<P>(
        tree,
        &Walker::new(tree, line),
        Child::node(0),
        stack,
        solid,
        view,
    )
    .is_some()
}
