//! Which meshes can be lit by the second texture coordinates that they bring, and in what sheets.

use super::crowd::crowding;
use super::resolve::growth;
use super::{Fault, FaultKind, faults};
use crate::Scene;

/// Fewest texels along a side of a sheet.
const SMALLEST: u32 = 16;
/// Most sheets that hold one mesh each; charts of more meshes are better packed together.
const MOST_PAGES: usize = 16;
/// Times as many texels along a side as its area asks for that a sheet may have for the sake of small charts.
const MOST_GROWTH: u32 = 2;
/// Share of a mesh that may have no area in its sheet: triangles too thin for a place there.
const LOST: f64 = 1e-3;

/// The sheets that the coordinates of a scene make.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Layouts {
    /// Sheets of coordinates that serve as they are: the meshes on each, and texels along its sides.
    pub pages: Vec<(Vec<usize>, u32)>,
    /// Meshes that are to be unwrapped, whose own charts can be kept.
    pub charts: Vec<usize>,
    /// Meshes that are to be unwrapped anew.
    pub none: Vec<usize>,
    /// Why the coordinates of a mesh do not serve as they are: the first fault of each that has any coordinates.
    pub faults: Vec<Fault>,
}

/// Looks for sheets of `texels` along a side in all and `most` at most, which meshes share by their area: one for all meshes with coordinates where they lie
/// side by side, else one for each, as engines have them. Where charts lie upon each other, have too few texels or none between them, the
/// charts can still be kept; coordinates without area or that are no numbers serve for nothing.
#[must_use]
pub fn layouts(scene: &Scene, meshes: &[usize], texels: u32, most: u32) -> Layouts {
    let (with, without): (Vec<usize>, Vec<usize>) =
        meshes.iter().partition(|&&mesh| !scene.meshes[mesh].uv1.is_empty());
    let mut out = Layouts { none: without, ..Layouts::default() };
    if with.is_empty() {
        return out;
    }
    let all = area(scene, meshes);
    let side = |sheet: &[usize]| {
        let side = f64::from(texels) * (area(scene, sheet) / all.max(f64::MIN_POSITIVE)).sqrt();
        (side.round() as u32).clamp(SMALLEST.min(texels), texels)
    };
    if let Ok(side) = fitted(scene, &with, side(&with), most) {
        out.pages.push((with, side));
        return out;
    }
    let found: Vec<Result<u32, Fault>> = with.iter().map(|&mesh| fitted(scene, &[mesh], side(&[mesh]), most)).collect();
    let are_few = found.iter().filter(|page| page.is_ok()).count() <= MOST_PAGES;
    for (mesh, page) in with.into_iter().zip(found) {
        match page {
            Ok(side) if are_few => out.pages.push((vec![mesh], side)),
            Ok(_) => out.charts.push(mesh),
            Err(fault) => {
                out.faults.push(fault);
                let keeps = !matches!(fault.kind, FaultKind::Flat | FaultKind::NotFinite | FaultKind::Missing);
                if keeps { &mut out.charts } else { &mut out.none }.push(mesh);
            }
        }
    }
    out
}

/// The side at which the meshes of a sheet are lit as they lie, `side` or more but neither twice as much nor `most`; else what stands in the way.
fn fitted(scene: &Scene, sheet: &[usize], side: u32, most: u32) -> Result<u32, Fault> {
    let lost: f64 = sheet.iter().map(|&mesh| LOST * area(scene, &[mesh])).sum();
    let found = faults(scene, sheet);
    let flat = found.iter().filter(|fault| fault.kind == FaultKind::Flat);
    let flat: f64 = flat.map(|fault| scene.meshes[fault.mesh].area(fault.triangle)).sum();
    if let Some(fault) = found.into_iter().find(|fault| fault.kind != FaultKind::Flat || flat > lost) {
        return Err(fault);
    }
    let most = most.min(MOST_GROWTH * side);
    let grown = f64::from(side) * growth(scene, sheet, [side; 2]).max(1.0);
    let mut side = (grown.ceil() as u32).min(most);
    loop {
        // A growing sheet may bring charts apart.
        match crowding(scene, sheet, [side; 2]).into_iter().next() {
            None => return Ok(side),
            Some(Fault { kind: FaultKind::Touches { .. }, .. }) if side < most => side = (2 * side).min(most),
            Some(fault) => return Err(fault),
        }
    }
}

fn area(scene: &Scene, meshes: &[usize]) -> f64 {
    let of_mesh = |&mesh: &usize| {
        let mesh = &scene.meshes[mesh];
        (0..mesh.triangles.len()).map(|triangle| mesh.area(triangle)).sum::<f64>()
    };
    meshes.iter().map(of_mesh).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mesh;
    use glam::Vec2;

    /// A unit square whose coordinates are `to` of those from 0.1 to 0.9.
    fn square(to: impl Fn(Vec2) -> Vec2) -> Mesh {
        let corners = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
        Mesh {
            positions: corners.map(|at| at.extend(0.0)).to_vec(),
            uv1: corners.map(|at| to(0.1 + 0.8 * at)).to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Mesh::default()
        }
    }

    fn sorted(meshes: Vec<Mesh>) -> Layouts {
        let all: Vec<usize> = (0..meshes.len()).collect();
        layouts(&Scene { meshes, ..Scene::default() }, &all, 64, 64)
    }

    #[test]
    fn one_atlas_stays_one_sheet() {
        let beside = |x: f32| square(move |uv| Vec2::new(0.5 * uv.x + x, uv.y));
        assert_eq!(sorted(vec![beside(0.0), beside(0.5)]).pages, [(vec![0, 1], 64)]);
        let bare = Mesh { uv1: Vec::new(), ..beside(0.0) };
        let mixed = sorted(vec![beside(0.0), bare]);
        assert_eq!((&mixed.pages[..], &mixed.none[..]), (&[(vec![0], 45)][..], &[1][..]), "by its share of the area");
    }

    #[test]
    fn a_layout_for_each_mesh_makes_pages() {
        let mirrored = square(|uv| Vec2::new(1.0 - uv.x, uv.y));
        let found = sorted(vec![square(|uv| uv), mirrored, square(|uv| uv)]);
        assert_eq!(found.pages.iter().map(|(sheet, _)| &sheet[..]).collect::<Vec<_>>(), [[0], [1], [2]]);
        let many = sorted((0..40).map(|_| square(|uv| uv)).collect());
        assert_eq!((many.pages.len(), many.charts.len(), many.faults.len()), (0, 40, 0));
    }

    #[test]
    fn charts_outlive_a_layout_that_does_not_serve() {
        let outside = sorted(vec![square(|uv| uv + 3.0)]);
        assert!(outside.pages.is_empty() && outside.charts == [0], "{outside:?}");
        assert!(matches!(outside.faults[0].kind, FaultKind::Outside(_)));
        let tiny = sorted(vec![square(|uv| uv * 0.01)]);
        assert!(tiny.charts == [0] && matches!(tiny.faults[0].kind, FaultKind::Sparse(_)), "{tiny:?}");
        for flat in [square(|_| Vec2::splat(0.5)), square(|uv| Vec2::new(uv.x, 0.5)), square(|_| Vec2::NAN)] {
            let found = sorted(vec![square(|uv| uv), flat]);
            assert_eq!((&found.none[..], found.pages.len()), (&[1][..], 1), "{found:?}");
        }
    }
}
