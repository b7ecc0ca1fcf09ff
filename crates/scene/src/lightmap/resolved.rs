//! Light-map coordinates made by the program, with texels enough for every chart.

use super::chart::Charts;
use super::fault::doubled_area;
use super::resolve::{ChartSize, too_small};
use super::unwrap::{Atlas, Density, Unwrap, UnwrapError, check, inputs_of, library, lost};
use crate::vertices::select;
use crate::{Mesh, Scene};
use glam::Vec2;
use std::collections::{BTreeMap, BTreeSet};

/// Times that charts are packed anew before a larger sheet is taken.
const ROUNDS: u32 = 4;
/// A larger sheet has so many times as many texels along a side.
const LARGER: f64 = 1.3;
/// Texels that a chart is grown to: a little more than it needs, since growing makes all others smaller.
const AIM: f64 = 5.0;
/// Times as many pieces as a mesh had charts from which on it is better cut anew.
const MOST_PIECES: usize = 2;
/// Texels along a side of the box around the smallest chart, and the share of a sheet that such boxes fill.
const SMALLEST_BOX: (f64, f64) = (3.0, 0.75);

type Progress<'a> = &'a (dyn Fn(&'static str, u64, u64) + Sync);

/// [`super::unwrap`] into a sheet where each chart has four texels, but for chips: small charts are denser than the rest, and where even
/// that does not do the sheet grows. Of the meshes in `kept` the charts of their own coordinates are kept where they are sound: moved, turned
/// and scaled; a mesh whose charts fall into many pieces is cut anew.
///
/// # Errors
/// As [`super::unwrap`]; [`UnwrapError::TooCoarse`] where the sheet would have more than `most` texels along a side. The scene is then as it was.
pub fn unwrap_resolved(
    scene: &mut Scene,
    sheet: &[usize],
    kept: &[usize],
    options: &Unwrap,
    most: u32,
    progress: Progress<'_>,
) -> Result<Atlas, UnwrapError> {
    check(scene, sheet, options)?;
    let mut options = *options;
    let asked = match options.density {
        Density::Side(side) => side,
        Density::PerMetre(_) => most,
    };
    let mut draft = Draft::first(scene, sheet, kept, &options, progress)?;
    let sound: Vec<usize> = kept.iter().copied().filter(|&mesh| draft.keeps(scene, sheet, mesh)).collect();
    if sound.len() < kept.len() {
        draft = Draft::first(scene, sheet, &sound, &options, progress)?;
    }
    let mut scales: Vec<Vec<f32>> = draft.meshes.iter().map(|mesh| vec![1.0; mesh.triangles.len()]).collect();
    let mut rounds = 0;
    loop {
        let small = too_small(&draft.sizes(scene, sheet));
        let side = match options.density {
            Density::Side(side) => side,
            Density::PerMetre(_) => 0,
        };
        if draft.pages == 1 && (small.is_empty() || side == 0 && rounds > ROUNDS) {
            // The side that does is known only now.
            let needed = draft.width.max(draft.height).max(side);
            return match side > most.max(asked) {
                true => Err(UnwrapError::TooCoarse { charts: draft.charts, needed, side: most.max(asked) }),
                false => Ok(draft.apply(scene, sheet)),
            };
        }
        let fewest = fewest(draft.charts, options.padding);
        rounds += 1;
        if side > 0 && (side < fewest || draft.pages > 1 || rounds > ROUNDS) {
            let larger = (f64::from(side) * LARGER).ceil() as u32;
            options.density = Density::Side(larger.max(fewest));
            check(scene, sheet, &options)?;
            // As if it had been asked for at first.
            scales.iter_mut().flatten().for_each(|scale| *scale = 1.0);
            rounds = 0;
        } else {
            draft.grow(&small, sheet, &mut scales);
        }
        draft = draft.repacked(scene, sheet, &scales, &options, progress)?;
    }
}

/// Texels along the side of a sheet in which so many charts of the smallest size have room.
fn fewest(charts: u32, padding: u32) -> u32 {
    let (side, filled) = SMALLEST_BOX;
    ((side + 2.0 * f64::from(padding)) * (f64::from(charts) / filled).sqrt()).ceil() as u32
}

/// Coordinates that no mesh has yet.
struct Draft {
    width: u32,
    height: u32,
    pages: u32,
    density: f32,
    charts: u32,
    filled: f32,
    meshes: Vec<DraftMesh>,
}

/// One mesh of a draft.
#[derive(Default, Clone)]
struct DraftMesh {
    /// Of each vertex the one of the scene that it came from.
    source: Vec<u32>,
    uv: Vec<Vec2>,
    triangles: Vec<[u32; 3]>,
    /// Of each triangle its chart, if it has one.
    charts: Vec<Option<u32>>,
}

impl Draft {
    fn first(
        scene: &Scene,
        sheet: &[usize],
        kept: &[usize],
        options: &Unwrap,
        progress: Progress<'_>,
    ) -> Result<Self, UnwrapError> {
        let (positions, own) = inputs_of(scene, sheet, kept);
        let inputs: Vec<uvunwrap::MeshInput<'_>> = sheet
            .iter()
            .zip(positions.iter().zip(&own))
            .map(|(&m, (positions, own))| uvunwrap::MeshInput {
                existing_uvs: own.as_deref(),
                ..uvunwrap::MeshInput::new(positions, scene.meshes[m].triangles.as_flattened())
            })
            .collect();
        let atlas = library(&inputs, options, progress)?;
        let mut draft = Self::empty(&atlas, sheet.len());
        for (mesh, output) in draft.meshes.iter_mut().zip(&atlas.meshes) {
            mesh.triangles = vec![[0; 3]; output.indices.len() / 3];
            mesh.charts = vec![None; mesh.triangles.len()];
            mesh.add(output, 0..output.indices.len() / 3, |vertex| vertex);
        }
        Ok(draft)
    }

    fn empty(atlas: &uvunwrap::Atlas, meshes: usize) -> Self {
        Self {
            width: atlas.width,
            height: atlas.height,
            pages: atlas.page_count,
            density: atlas.texels_per_unit,
            charts: atlas.chart_count,
            filled: atlas.utilization,
            meshes: vec![DraftMesh::default(); meshes],
        }
    }

    /// Whether most of the charts that a mesh brought are whole: what folds or lies upon itself falls into many pieces.
    fn keeps(&self, scene: &Scene, sheet: &[usize], mesh: usize) -> bool {
        let Some(index) = sheet.iter().position(|&other| other == mesh) else { return false };
        let made: BTreeSet<u32> = self.meshes[index].charts.iter().flatten().copied().collect();
        made.len() <= MOST_PIECES * Charts::of(&scene.meshes[mesh]).count as usize
    }

    /// The same charts packed anew, those of each triangle with its scale.
    fn repacked(
        &self,
        scene: &Scene,
        sheet: &[usize],
        scales: &[Vec<f32>],
        options: &Unwrap,
        progress: Progress<'_>,
    ) -> Result<Self, UnwrapError> {
        let mut groups: BTreeMap<(usize, u32), Vec<usize>> = BTreeMap::new();
        for (index, scales) in scales.iter().enumerate() {
            for (triangle, scale) in scales.iter().enumerate() {
                groups.entry((index, scale.to_bits())).or_default().push(triangle);
            }
        }
        let texels = Vec2::new(self.width as f32, self.height as f32);
        let positions: Vec<Vec<[f32; 3]>> = sheet
            .iter()
            .zip(&self.meshes)
            .map(|(&m, draft)| draft.source.iter().map(|&v| scene.meshes[m].positions[v as usize].to_array()).collect())
            .collect();
        let uv: Vec<Vec<[f32; 2]>> =
            self.meshes.iter().map(|draft| draft.uv.iter().map(|&uv| (uv * texels).to_array()).collect()).collect();
        let indices: Vec<Vec<u32>> = groups
            .iter()
            .map(|(&(index, _), list)| list.iter().flat_map(|&t| self.meshes[index].triangles[t]).collect())
            .collect();
        let inputs: Vec<uvunwrap::MeshInput<'_>> = groups
            .keys()
            .zip(&indices)
            .map(|(&(index, scale), indices)| uvunwrap::MeshInput {
                existing_uvs: Some(&uv[index]),
                scale: f32::from_bits(scale),
                ..uvunwrap::MeshInput::new(&positions[index], indices)
            })
            .collect();
        let atlas = library(&inputs, options, progress)?;
        let mut draft = Self::empty(&atlas, self.meshes.len());
        for (mesh, old) in draft.meshes.iter_mut().zip(&self.meshes) {
            mesh.triangles = vec![[0; 3]; old.triangles.len()];
            mesh.charts = vec![None; old.triangles.len()];
        }
        for ((&(index, _), list), output) in groups.iter().zip(&atlas.meshes) {
            let source = &self.meshes[index].source;
            draft.meshes[index].add(output, list.iter().copied(), |vertex| source[vertex as usize]);
        }
        Ok(draft)
    }

    /// Sizes of the charts.
    fn sizes(&self, scene: &Scene, sheet: &[usize]) -> Vec<ChartSize> {
        let texels = f64::from(self.width) * f64::from(self.height);
        let mut sizes: BTreeMap<(usize, u32), ChartSize> = BTreeMap::new();
        for (&mesh, draft) in sheet.iter().zip(&self.meshes) {
            for (triangle, (corners, chart)) in draft.triangles.iter().zip(&draft.charts).enumerate() {
                let Some(chart) = chart else { continue };
                let placed = corners.map(|v| draft.uv[v as usize].as_dvec2());
                let none = ChartSize { mesh, triangle, area: 0.0, texels: 0.0 };
                let size = sizes.entry((mesh, *chart)).or_insert(none);
                size.area += scene.meshes[mesh].area(triangle);
                size.texels += 0.5 * doubled_area(placed).abs() * texels;
            }
        }
        sizes.into_values().collect()
    }

    /// Makes small charts larger, in steps, so that few packings differ.
    fn grow(&self, small: &[ChartSize], sheet: &[usize], scales: &mut [Vec<f32>]) {
        for chart in small {
            let Some(index) = sheet.iter().position(|&mesh| mesh == chart.mesh) else { continue };
            // Whole steps of the square root of 2 in length.
            let steps = libm::log2(AIM / chart.texels).ceil().clamp(1.0, 40.0) as i32;
            let factor = (0..steps).fold(1.0f32, |factor, _| factor * std::f32::consts::SQRT_2);
            let draft = &self.meshes[index];
            let own = draft.charts[chart.triangle];
            let of_chart = scales[index].iter_mut().zip(&draft.charts).filter(|(_, other)| **other == own);
            of_chart.for_each(|(scale, _)| *scale *= factor);
        }
    }

    /// Gives the meshes the coordinates.
    fn apply(self, scene: &mut Scene, sheet: &[usize]) -> Atlas {
        for (&m, draft) in sheet.iter().zip(self.meshes) {
            let mesh: &mut Mesh = &mut scene.meshes[m];
            select(mesh, &draft.source);
            mesh.uv1 = draft.uv;
            mesh.triangles = draft.triangles;
        }
        Atlas {
            width: self.width,
            height: self.height,
            texels_per_metre: self.density,
            charts: self.charts,
            filled: self.filled,
            lost: sheet.iter().map(|&m| lost(&scene.meshes[m])).sum(),
        }
    }
}

impl DraftMesh {
    /// Takes over what the library made of some triangles; `source` names the vertex of the scene that one of the input was.
    fn add(
        &mut self,
        output: &uvunwrap::OutputMesh,
        triangles: impl Iterator<Item = usize>,
        source: impl Fn(u32) -> u32,
    ) {
        let first = self.source.len() as u32;
        self.source.extend(output.vertices.iter().map(|vertex| source(vertex.xref)));
        self.uv.extend(output.vertices.iter().map(|vertex| Vec2::from(vertex.uv)));
        for (triangle, corners) in triangles.zip(output.indices.as_chunks::<3>().0) {
            self.triangles[triangle] = corners.map(|v| v + first);
            self.charts[triangle] = output.vertices[corners[0] as usize].chart;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lightmap::{FaultKind, crowding, faults};

    /// A ground of 100 m and a thousand pebbles of 5 mm, all in one mesh, and half as many in another.
    fn pebbles() -> Scene {
        let square = |mesh: &mut Mesh, at: Vec2, side: f32, height: f32| {
            let v = mesh.positions.len() as u32;
            for corner in [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y] {
                let flat = at + side * corner;
                mesh.positions.push(glam::Vec3::new(flat.x, height, flat.y));
                mesh.normals.push(glam::Vec3::Y);
            }
            mesh.triangles.extend([[v, v + 2, v + 1], [v, v + 3, v + 2]]);
        };
        let (mut ground, mut stones) = (Mesh::default(), Mesh::default());
        square(&mut ground, Vec2::splat(-50.0), 100.0, 0.0);
        for k in 0..1000 {
            square(&mut stones, Vec2::new((k % 40) as f32, (k / 40) as f32), 0.005, 0.1);
        }
        Scene { meshes: vec![ground, stones], materials: vec![crate::Material::default()], ..Scene::default() }
    }

    /// Every chart has its four texels and its place, though a sheet as dense as the ground allows would give a pebble none.
    #[test]
    fn small_charts_are_denser() {
        let mut scene = pebbles();
        let options = Unwrap { density: Density::Side(384), padding: 2 };
        let plain = super::super::unwrap(&mut pebbles(), &[0, 1], &options, &|_, _, _| ()).unwrap();
        assert!(plain.texels_per_metre * 0.005 < 0.1, "can fail: {} to a metre", plain.texels_per_metre);
        let atlas = unwrap_resolved(&mut scene, &[0, 1], &[], &options, 384, &|_, _, _| ()).unwrap();
        assert_eq!((atlas.width, atlas.charts), (384, 1001));
        assert_eq!(faults(&scene, &[0, 1]), []);
        let crowded = crowding(&scene, &[0, 1], [atlas.width, atlas.height]);
        assert!(crowded.iter().all(|fault| matches!(fault.kind, FaultKind::Sparse(_))), "{crowded:?}");
    }

    #[test]
    fn a_sheet_too_small_for_all_charts_is_refused_with_the_number() {
        let mut scene = pebbles();
        let tried = |scene: &mut Scene, side| {
            let options = Unwrap { density: Density::Side(side), padding: 2 };
            unwrap_resolved(scene, &[0, 1], &[], &options, side, &|_, _, _| ())
        };
        let Err(UnwrapError::TooCoarse { needed, charts: 1001, .. }) = tried(&mut scene, 64) else { panic!("refused") };
        assert!(scene.meshes[1].uv1.is_empty(), "the scene is as it was");
        assert!(tried(&mut scene, needed / 2).is_err(), "can fail");
        assert!(tried(&mut scene, needed).is_ok(), "{needed}");
    }

    /// Own charts that overlap are kept and moved apart.
    #[test]
    fn own_charts_are_kept() {
        let mut scene = pebbles();
        scene.meshes.truncate(1);
        let square = scene.meshes[0].clone();
        let mesh = &mut scene.meshes[0];
        // A second square upon the first, cut the same way; the coordinates lean, so that kept charts are known again.
        mesh.positions.extend(square.positions.iter().map(|p| *p + glam::Vec3::Y));
        mesh.normals.extend(square.normals.iter());
        mesh.triangles.extend(square.triangles.iter().map(|t| t.map(|v| v + 4)));
        let lean = [Vec2::ZERO, Vec2::new(1.0, 0.5), Vec2::new(1.5, 2.0), Vec2::new(0.5, 1.5)];
        mesh.uv1 = lean.iter().chain(&lean).copied().collect();
        let options = Unwrap { density: Density::Side(64), padding: 2 };
        let atlas = unwrap_resolved(&mut scene, &[0], &[0], &options, 64, &|_, _, _| ()).unwrap();
        let texels = Vec2::new(atlas.width as f32, atlas.height as f32);
        assert_eq!(faults(&scene, &[0]), []);
        let diagonals = |mesh: &Mesh| {
            let [a, b, c] = mesh.triangles[0].map(|v| mesh.uv1[v as usize] * texels);
            (b - a).length() / (c - b).length()
        };
        // The first triangle has the corners 0, 2 and 1.
        let own = (lean[2] - lean[0]).length() / (lean[1] - lean[2]).length();
        assert!((diagonals(&scene.meshes[0]) / own - 1.0).abs() < 0.02, "{} for {own}", diagonals(&scene.meshes[0]));
    }
}
