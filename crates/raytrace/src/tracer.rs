//! The public face: triangles in, answers about rays out.

use crate::build::build;
use crate::lanes::Path;
use crate::level::{Job, Level, dispatch};
use crate::nearest::nearest;
use crate::ray::{Hit, Line, Ray};
use crate::tree::{Child, Tree};
use crate::walk::{Fresh, Solid, Walker, blocked};
use glam::Vec3;
use std::cell::Cell;
use std::sync::atomic::AtomicUsize;

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
    pub(crate) level: Level,
    /// Steps that questions about planes took without knowing how flat the tree is.
    pub(crate) spent: AtomicUsize,
    /// Boxes around origins of fans that had too many.
    pub(crate) crowds: AtomicUsize,
}

impl Tracer {
    /// Builds a tracer; `masked` says which triangles ask the filter, and is empty where none does.
    ///
    /// Triangles with a corner that is missing, not finite or beyond 2^38 units are left out, as are those
    /// with two corners in one place.
    pub fn build(positions: &[Vec3], triangles: &[[u32; 3]], masked: &[bool]) -> Tracer {
        Tracer {
            tree: build(positions, triangles, masked),
            level: Level::best(),
            spent: AtomicUsize::new(0),
            crowds: AtomicUsize::new(0),
        }
    }

    /// The same tracer at another level; None where this processor lacks it.
    pub fn at_level(mut self, level: Level) -> Option<Tracer> {
        self.level = level;
        Level::available().contains(&level).then_some(self)
    }

    /// The level in use.
    pub fn level(&self) -> Level {
        self.level
    }

    /// Bytes that the tree takes.
    pub fn memory(&self) -> usize {
        size_of_val(self.tree.nodes.as_slice()) + size_of_val(self.tree.blocks.as_slice())
    }

    /// The nearest hit; of equally near ones that of the smallest triangle number. `solid` (triangle, u, v) says
    /// whether a masked triangle is there at a point, and is asked about no others.
    pub fn closest(&self, ray: &Ray, solid: &dyn Fn(u32, f32, f32) -> bool) -> Option<Hit> {
        let line = self.line(ray)?;
        with_stack(|stack| dispatch(self.level, Closest { tree: &self.tree, line, stack, solid }))
    }

    /// The hit that comes after one of the same ray: the next of those equally near by triangle number, else the next nearest.
    pub fn closest_after(&self, ray: &Ray, hit: &Hit, solid: &dyn Fn(u32, f32, f32) -> bool) -> Option<Hit> {
        // Hits at the least parameter of a ray do not count.
        let t_min = ray.t_min.max(hit.t.next_down());
        let line = Line { after: (hit.t, hit.triangle), ..self.line(&Ray { t_min, ..*ray })? };
        with_stack(|stack| dispatch(self.level, Closest { tree: &self.tree, line, stack, solid }))
    }

    /// Whether anything lies on the ray; `solid` as for [`Tracer::closest`].
    pub fn occluded(&self, ray: &Ray, solid: &dyn Fn(u32, f32, f32) -> bool) -> bool {
        let Some(line) = self.line(ray) else {
            return false;
        };
        with_stack(|stack| dispatch(self.level, Occluded { tree: &self.tree, line, stack, solid }))
    }

    fn line(&self, ray: &Ray) -> Option<Line> {
        if self.tree.nodes.is_empty() { None } else { Line::new(ray) }
    }
}

fn with_stack<R>(work: impl FnOnce(&mut Vec<u32>) -> R) -> R {
    let mut stack = STACK.take();
    let result = work(&mut stack);
    STACK.set(stack);
    result
}

/// [`Tracer::closest`] at one level.
struct Closest<'a> {
    tree: &'a Tree,
    line: Line,
    stack: &'a mut Vec<u32>,
    solid: Solid<'a>,
}

impl Job for Closest<'_> {
    type Output = Option<Hit>;

    #[inline(always)]
    fn run<P: Path>(self) -> Option<Hit> {
        let walker = Walker::new(self.tree, self.line);
        nearest::<P>(self.tree, &walker, self.stack, self.solid)
    }
}

/// [`Tracer::occluded`] at one level.
struct Occluded<'a> {
    tree: &'a Tree,
    line: Line,
    stack: &'a mut Vec<u32>,
    solid: Solid<'a>,
}

impl Job for Occluded<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<P: Path>(self) -> bool {
        let walker = Walker::new(self.tree, self.line);
        blocked::<P>(self.tree, &walker, Child::node(0), self.stack, self.solid, &mut Fresh).is_some()
    }
}
