//! Which triangles bound bodies: only the backs of those are insides.
//!
//! A body is a connected component of opaque, one-sided triangles that is closed and faces outwards. Two more kinds count, since models
//! leave out what nobody sees: a component whose open edges all lie behind or on other surfaces (a crate without a bottom on its floor),
//! and a closed component that faces inwards and lies within a body (the inner wall of a hollow one). Leaves, slats, curtains, open
//! pipes and all that is masked, blended, transmissive or two-sided never count.

mod seam;

use crate::world::World;
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use raytrace::{Hit, Ray};
use seam::{HalfEdge, is_balanced, runs};

/// Least volume of an open component, over the 3/2th power of its area: a sheet has none. A cube has 0.07.
const LEAST_VOLUME: f64 = 1e-3;
/// Share of the length of a component's open edges that may lie free.
const FREE_SHARE: f64 = 0.01;
/// Length of free edges, over the root of the component's area, that is a small hole. A square sheet has 4.
const HOLE: f64 = 0.1;
/// How far beyond an open edge another surface is looked for, over the root of the component's area: what stands on something often
/// hovers a hair above it.
const BEYOND: [f32; 2] = [1e-3, 1e-2];
/// Most triangles of an inward component from which the body around it is looked for.
const WITNESSES: usize = 9;

/// Of each traced triangle whether it bounds a body.
#[derive(Debug, Default)]
pub(crate) struct Bodies {
    bounds: Vec<bool>,
}

/// A connected component of triangles that could bound a body.
#[derive(Debug, Default, Clone)]
struct Component {
    /// Traced triangles.
    triangles: Vec<u32>,
    /// Edges at which the surface ends.
    open: Vec<HalfEdge>,
    /// Square metres.
    area: f64,
    /// Cubic metres, closed by cones over its open edges; negative where it faces inwards.
    volume: f64,
}

impl Bodies {
    /// Looks at all triangles of a world.
    pub(crate) fn of(world: &World<'_>) -> Self {
        let components = components(world);
        let mut bodies = Self { bounds: vec![false; world.corners.len()] };
        let mut found: Vec<bool> = components.par_iter().map(|one| one.is_body(world)).collect();
        bodies.add(&components, &found);
        if found.contains(&true) {
            found = components.par_iter().map(|one| one.is_hollow(world, &bodies)).collect();
            bodies.add(&components, &found);
        }
        bodies
    }

    /// Whether there is any.
    pub(crate) fn any(&self) -> bool {
        self.bounds.contains(&true)
    }

    /// Whether a hit is on the inside of a body.
    pub(crate) fn is_inside(&self, hit: &Hit) -> bool {
        !hit.front && self.bound(hit.triangle)
    }

    /// Whether a triangle bounds a body; those that stop a part of the light never do.
    pub(crate) fn bound(&self, triangle: u32) -> bool {
        self.bounds.get(triangle as usize).is_some_and(|bound| *bound)
    }

    fn add(&mut self, components: &[Component], are: &[bool]) {
        for (component, _) in components.iter().zip(are).filter(|(_, is)| **is) {
            component.triangles.iter().for_each(|&t| self.bounds[t as usize] = true);
        }
    }
}

impl Component {
    fn is_body(&self, world: &World<'_>) -> bool {
        if self.open.is_empty() {
            return self.volume > 0.0;
        }
        self.volume > LEAST_VOLUME * self.area * self.area.sqrt() && self.is_covered(world)
    }

    /// Whether it is the inner side of a body with a hollow: closed, and faces away from what the body is made of.
    fn is_hollow(&self, world: &World<'_>, bodies: &Bodies) -> bool {
        if !self.open.is_empty() || self.volume >= 0.0 {
            return false;
        }
        let step = self.triangles.len().div_ceil(WITNESSES);
        let witnesses: Vec<u32> = self.triangles.iter().copied().step_by(step).collect();
        let within = |&&triangle: &&u32| {
            let [a, b, c] = world.points(triangle);
            let (middle, normal) = ((a + b + c) / 3.0, (b - a).cross(c - a).normalize_or_zero());
            let start = raytrace::offset_origin(middle, -normal);
            world.closest(&Ray::new(start, -normal)).is_some_and(|hit| bodies.is_inside(&hit))
        };
        2 * witnesses.iter().filter(within).count() > witnesses.len()
    }

    /// Whether other surfaces close what is open: from just beyond an open edge along the surface one comes out of their backs.
    fn is_covered(&self, world: &World<'_>) -> bool {
        let length = |half: &HalfEdge| {
            let [a, b, _] = half.corners(world);
            f64::from(a.distance(b))
        };
        let most = (FREE_SHARE * self.open.iter().map(length).sum::<f64>()).max(HOLE * self.area.sqrt());
        let mut free = 0.0;
        self.open.iter().filter(|half| !self.is_behind(world, half)).all(|half| {
            free += length(half);
            free <= most
        })
    }

    fn is_behind(&self, world: &World<'_>, half: &HalfEdge) -> bool {
        let [a, b, c] = half.corners(world);
        let middle = 0.5 * (a + b);
        let (Some(along), Some(normal)) = ((b - a).try_normalize(), (b - a).cross(c - a).try_normalize()) else {
            return true;
        };
        let inwards = normal.cross(along);
        BEYOND.iter().any(|beyond| {
            let step = beyond * (self.area as f32).sqrt();
            self.comes_out(world, middle - step * inwards + 0.1 * step * normal, inwards)
        })
    }

    /// Whether a ray leaves something that it has not entered before. A surface that curves outwards stands in its own way.
    fn comes_out(&self, world: &World<'_>, start: Vec3, direction: Vec3) -> bool {
        let ray = Ray { t_max: (self.area as f32).sqrt(), ..Ray::new(start, direction) };
        let mut entered = 0u32;
        for hit in world.along(ray) {
            let other = self.triangles.binary_search(&hit.triangle).is_err();
            match (other, hit.front) {
                (true, false) if entered == 0 => return true,
                (true, false) => entered -= 1,
                (true, true) => entered += 1,
                (false, _) => {}
            }
        }
        false
    }
}

/// The components of the triangles that could bound bodies; triangles rise in each.
fn components(world: &World<'_>) -> Vec<Component> {
    let triangles: Vec<u32> = (0..world.corners.len() as u32).filter(|&t| world.is_one_sided(t)).collect();
    let halves = seam::half_edges(world, &triangles);
    let mut sets = Sets::new(world.corners.len());
    let mut open = Vec::new();
    for run in runs(&halves) {
        if is_balanced(run) {
            run.iter().for_each(|half| sets.join(run[0].triangle, half.triangle));
        } else {
            open.extend_from_slice(run);
        }
    }
    let open = seam::close_lines(world, open, &mut |a, b| sets.join(a, b));
    let mut number = vec![u32::MAX; world.corners.len()];
    let mut all: Vec<Component> = Vec::new();
    for &triangle in &triangles {
        let slot = &mut number[sets.root(triangle) as usize];
        if *slot == u32::MAX {
            *slot = all.len() as u32;
            all.push(Component::default());
        }
        all[*slot as usize].triangles.push(triangle);
    }
    for half in open {
        all[number[sets.root(half.triangle) as usize] as usize].open.push(half);
    }
    all.par_iter_mut().for_each(|one| one.measure(world));
    all
}

impl Component {
    fn measure(&mut self, world: &World<'_>) {
        let ends: Vec<Vec3> = self.open.iter().map(|half| half.corners(world)[0]).collect();
        let near = world.points(self.triangles[0])[0].as_dvec3();
        // Open edges are closed by cones to their middle.
        let middle = ends.iter().map(|end| end.as_dvec3() - near).sum::<DVec3>() / ends.len().max(1) as f64 + near;
        for &triangle in &self.triangles {
            let [a, b, c] = world.points(triangle).map(|p| p.as_dvec3() - middle);
            self.area += 0.5 * (b - a).cross(c - a).length();
            self.volume += a.dot(b.cross(c)) / 6.0;
        }
    }
}

/// Disjoint sets of triangles.
struct Sets {
    parent: Vec<u32>,
}

impl Sets {
    fn new(count: usize) -> Self {
        Self { parent: (0..count as u32).collect() }
    }

    fn root(&mut self, mut one: u32) -> u32 {
        while self.parent[one as usize] != one {
            let above = self.parent[self.parent[one as usize] as usize];
            self.parent[one as usize] = above;
            one = above;
        }
        one
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b) as usize] = a.min(b);
    }
}
