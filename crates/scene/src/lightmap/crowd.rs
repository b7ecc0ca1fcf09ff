//! What is wrong with light-map coordinates in a sheet of a certain size: charts too near to each other, too few texels, an empty sheet.

use super::chart::Charts;
use super::cover::cover;
use super::fault::{Fault, FaultKind, corners, share};
use super::resolve::{sizes, too_small};
use crate::Scene;
use glam::DVec2;

/// Share of a sheet below which it holds next to nothing.
const SPARSE: f64 = 0.05;
/// No chart.
const NONE: u32 = u32::MAX;

/// The faults of some meshes that share a sheet of `width` by `height` texels, beside those of [`super::faults`]: of each chart the first.
///
/// A chart that has no whole texel between itself and another mixes its light with that of the other, since the filter reads both; one of
/// less than four texels cannot hold what lies on it; a sheet of which less than a twentieth is used wastes what is paid for.
#[must_use]
pub fn crowding(scene: &Scene, sheet: &[usize], size: [u32; 2]) -> Vec<Fault> {
    let placed: Vec<usize> = sheet.iter().copied().filter(|&mesh| !scene.meshes[mesh].uv1.is_empty()).collect();
    let mut faults = Vec::new();
    let used: f64 = placed.iter().map(|&mesh| share(&scene.meshes[mesh])).sum();
    if let Some(&mesh) = placed.first().filter(|_| used < SPARSE) {
        faults.push(Fault { mesh, triangle: 0, kind: FaultKind::Sparse(used) });
    }
    for chart in too_small(&sizes(scene, &placed, f64::from(size[0]) * f64::from(size[1]))) {
        faults.push(Fault { mesh: chart.mesh, triangle: chart.triangle, kind: FaultKind::Tiny(chart.texels) });
    }
    faults.extend(touching(scene, &placed, size));
    faults
}

/// A chart in the sheet.
#[derive(Clone, Copy)]
struct Placed {
    mesh: usize,
    triangle: usize,
}

/// Charts that share a texel with another, or lie in texels side by side.
fn touching(scene: &Scene, sheet: &[usize], size: [u32; 2]) -> Vec<Fault> {
    let [width, height] = size.map(|side| side as usize);
    let scale = DVec2::new(width as f64, height as f64);
    let mut charts: Vec<Placed> = Vec::new();
    let mut owner = vec![NONE; width * height];
    let mut met: Vec<u32> = Vec::new();
    for &mesh in sheet {
        let own = Charts::of(&scene.meshes[mesh]);
        let first = charts.len();
        charts.extend((0..own.count).map(|_| Placed { mesh, triangle: usize::MAX }));
        met.resize(charts.len(), NONE);
        for (triangle, &chart) in own.of_triangle.iter().enumerate() {
            let chart = first + chart as usize;
            charts[chart].triangle = charts[chart].triangle.min(triangle);
            let placed = corners(&scene.meshes[mesh], triangle).map(|corner| corner * scale);
            cover(placed, size, &mut |x, y| {
                let cell = &mut owner[y as usize * width + x as usize];
                if *cell == NONE {
                    *cell = chart as u32;
                } else if *cell != chart as u32 && met[chart] == NONE {
                    met[chart] = *cell;
                }
            });
        }
    }
    for at in 0..owner.len() {
        let steps = [(at % width + 1 < width).then_some(at + 1), (at + width < owner.len()).then_some(at + width)];
        for beside in steps.into_iter().flatten() {
            let (a, b) = (owner[at], owner[beside]);
            if a != NONE && b != NONE && a != b && met[a.max(b) as usize] == NONE {
                met[a.max(b) as usize] = a.min(b);
            }
        }
    }
    let told = charts.iter().zip(&met).filter(|(_, other)| **other != NONE);
    told.map(|(chart, &other)| {
        let Placed { mesh, triangle } = charts[other as usize];
        Fault { mesh: chart.mesh, triangle: chart.triangle, kind: FaultKind::Touches { mesh, triangle } }
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mesh;
    use glam::Vec2;

    /// Two squares of 8 texels in a sheet of 32, `gap` texels apart.
    fn pair(gap: f32) -> Scene {
        let mut mesh = Mesh::default();
        for (k, left) in [2.0, 10.0 + gap].into_iter().enumerate() {
            let v = mesh.positions.len() as u32;
            for at in [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y] {
                mesh.positions.push(at.extend(k as f32));
                mesh.uv1.push((at * 8.0 + Vec2::new(left, 2.0)) / 32.0);
            }
            mesh.triangles.extend([[v, v + 1, v + 2], [v, v + 2, v + 3]]);
        }
        Scene { meshes: vec![mesh], ..Scene::default() }
    }

    #[test]
    fn charts_side_by_side_touch() {
        let touches = |gap| crowding(&pair(gap), &[0], [32, 32]);
        let expected = Fault { mesh: 0, triangle: 2, kind: FaultKind::Touches { mesh: 0, triangle: 0 } };
        assert_eq!(touches(0.0), [expected]);
        assert_eq!(touches(0.5), [expected]);
        assert_eq!(touches(1.0), [], "a whole texel lies between");
    }

    #[test]
    fn a_sheet_of_next_to_nothing_is_told() {
        let mut scene = pair(4.0);
        scene.meshes[0].uv1.iter_mut().for_each(|uv| *uv *= 0.25);
        let kinds: Vec<FaultKind> = crowding(&scene, &[0], [256, 256]).iter().map(|fault| fault.kind).collect();
        let used = 2.0 * 64.0 / (32.0 * 32.0 * 16.0);
        assert!(matches!(kinds[..], [FaultKind::Sparse(share)] if (share - used).abs() < 1e-6), "{kinds:?}");
        let tiny = crowding(&scene, &[0], [16, 16]);
        assert!(
            tiny.iter().any(|fault| matches!(fault.kind, FaultKind::Tiny(n) if (n - 1.0).abs() < 1e-3)),
            "{tiny:?}"
        );
    }
}
