//! The pieces into which the light-map coordinates cut a mesh.

use crate::Mesh;
use crate::weld::weld;
use std::collections::HashMap;

/// Which chart each triangle of a mesh belongs to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Charts {
    /// Of each triangle the number of its chart, from 0 in the order of their first triangles.
    pub of_triangle: Vec<u32>,
    /// Number of charts.
    pub count: u32,
}

impl Charts {
    /// Joins triangles over edges whose two ends have one position and one light-map coordinate on both sides, whether or not they
    /// are the same vertices. A mesh without such coordinates has one chart per triangle.
    #[must_use]
    pub fn of(mesh: &Mesh) -> Self {
        let (_, places) = weld(mesh.positions.iter().copied());
        // With a third coordinate of nothing, places in the sheet can be welded as well.
        let (_, in_sheet) = weld(mesh.uv1.iter().map(|uv| uv.extend(0.0)));
        let corner = |v: u32| (places[v as usize], in_sheet[v as usize]);
        let mut first = HashMap::new();
        let mut joined = Joined((0..mesh.triangles.len() as u32).collect());
        for (t, triangle) in (0u32..).zip(&mesh.triangles).filter(|_| !mesh.uv1.is_empty()) {
            for k in 0..3 {
                let (a, b) = (corner(triangle[k]), corner(triangle[(k + 1) % 3]));
                let edge = if a < b { (a, b) } else { (b, a) };
                let other = *first.entry(edge).or_insert(t);
                joined.join(t, other);
            }
        }
        joined.numbered()
    }
}

/// Sets that grow together: each member points to one that is as small or smaller.
struct Joined(Vec<u32>);

impl Joined {
    fn smallest(&mut self, mut member: u32) -> u32 {
        while self.0[member as usize] != member {
            // Halves the way for the next that asks.
            self.0[member as usize] = self.0[self.0[member as usize] as usize];
            member = self.0[member as usize];
        }
        member
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.smallest(a), self.smallest(b));
        self.0[a.max(b) as usize] = a.min(b);
    }

    fn numbered(mut self) -> Charts {
        let mut count = 0;
        let mut of_triangle = vec![0; self.0.len()];
        for t in 0..self.0.len() as u32 {
            let smallest = self.smallest(t);
            of_triangle[t as usize] = if smallest == t {
                count += 1;
                count - 1
            } else {
                of_triangle[smallest as usize]
            };
        }
        Charts { of_triangle, count }
    }
}

#[cfg(test)]
mod tests {
    use super::Charts;
    use crate::Mesh;
    use glam::{Vec2, Vec3};

    /// A strip of four quads, each of two triangles with vertices of its own; the third quad lies apart in the sheet.
    fn strip() -> Mesh {
        let mut mesh = Mesh::default();
        for quad in 0..4u32 {
            let apart = if quad == 2 { Vec2::new(0.0, 0.5) } else { Vec2::ZERO };
            for (x, y) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                let at = Vec2::new((quad + x) as f32, y as f32);
                mesh.positions.push(at.extend(0.0));
                mesh.uv1.push(at * 0.2 + apart);
            }
            let v = 4 * quad;
            mesh.triangles.extend([[v, v + 1, v + 2], [v, v + 2, v + 3]]);
        }
        mesh
    }

    #[test]
    fn charts_hang_together_across_split_vertices() {
        let charts = Charts::of(&strip());
        assert_eq!(charts, Charts { of_triangle: vec![0, 0, 0, 0, 1, 1, 2, 2], count: 3 });
    }

    #[test]
    fn one_place_in_the_sheet_does_not_join_two_places_in_space() {
        let mut mesh = strip();
        mesh.positions[4..8].iter_mut().for_each(|p| *p += Vec3::Z);
        assert_eq!(Charts::of(&mesh).of_triangle, [0, 0, 1, 1, 2, 2, 3, 3]);
    }

    #[test]
    fn without_coordinates_nothing_hangs_together() {
        let mesh = Mesh { uv1: Vec::new(), ..strip() };
        assert_eq!(Charts::of(&mesh).count, 8);
    }
}
