//! Light-map coordinates made by the program.

use super::fault::{corners, doubled_area};
use crate::vertices::select;
use crate::{Material, Mesh, Scene};
use glam::Vec2;

/// Most texels along a side of a sheet.
const LARGEST_SIDE: u32 = 16_384;

/// How fine a sheet is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Density {
    /// As many texels to a metre; the sheet grows as it must.
    PerMetre(f32),
    /// A sheet of so many texels along u, as dense as all fits.
    Side(u32),
}

/// How meshes are unwrapped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unwrap {
    /// How fine the sheet is.
    pub density: Density,
    /// Texels around each chart that are left free, so that neither the filter nor the first mip-maps mix charts: `2^k` serve k levels.
    pub padding: u32,
}

impl Default for Unwrap {
    fn default() -> Self {
        Self { density: Density::Side(1024), padding: 2 }
    }
}

/// A sheet that was made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Atlas {
    /// Texels along u.
    pub width: u32,
    /// Texels along v.
    pub height: u32,
    /// Texels to a metre.
    pub texels_per_metre: f32,
    /// Pieces that the meshes were cut into.
    pub charts: u32,
    /// Share of the texels that a surface covers.
    pub filled: f32,
    /// Triangles so thin beside their mesh that they have no place in the sheet; they hold no light to speak of.
    pub lost: usize,
}

/// Why meshes could not be unwrapped.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum UnwrapError {
    /// The sheet would be larger than any picture.
    #[error("the sheet would be larger than {LARGEST_SIDE} x {LARGEST_SIDE} texels; ask for fewer texels to a metre")]
    TooLarge,
    /// Not all charts fit a sheet of the size asked for.
    #[error("{charts} charts do not fit a sheet of {side} texels; ask for a larger sheet or less padding")]
    TooSmall {
        /// Pieces to be placed.
        charts: u32,
        /// Texels along a side.
        side: u32,
    },
    /// Not all charts have enough texels.
    #[error("{charts} charts need a sheet of {needed} texels along a side for four texels each, more than {side}")]
    TooCoarse {
        /// Pieces to be placed.
        charts: u32,
        /// Texels along a side that they need.
        needed: u32,
        /// Most that were allowed.
        side: u32,
    },
    /// A picture of the material hangs on the coordinates that would be replaced.
    #[error(
        "mesh '{mesh}': its pictures use the second texture coordinates, which cannot be replaced then; mend those, or leave the mesh without a light map"
    )]
    InUse {
        /// Name of the mesh.
        mesh: String,
    },
    /// The meshes or the options are not what can be unwrapped.
    #[error("the meshes cannot be unwrapped: {0}")]
    Refused(String),
}

/// Gives the meshes of a sheet second texture coordinates that lie side by side in the unit square, as dense everywhere; those that
/// they had are replaced. Vertices on the borders of charts are split: triangles keep their order, vertices do not keep their numbers.
///
/// `progress` is told what is being done, how much is done, and of how much (0 where that is not known); it is called from several threads, but never at once.
///
/// # Errors
/// [`UnwrapError`] where the sheet would be too large or is too small. The scene is then as it was.
pub fn unwrap(
    scene: &mut Scene,
    sheet: &[usize],
    options: &Unwrap,
    progress: &(dyn Fn(&'static str, u64, u64) + Sync),
) -> Result<Atlas, UnwrapError> {
    check(scene, sheet, options)?;
    let (positions, _) = inputs_of(scene, sheet, &[]);
    let inputs: Vec<uvunwrap::MeshInput<'_>> = sheet
        .iter()
        .zip(&positions)
        .map(|(&m, positions)| uvunwrap::MeshInput::new(positions, scene.meshes[m].triangles.as_flattened()))
        .collect();
    let atlas = library(&inputs, options, progress)?;
    if atlas.page_count > 1 {
        return Err(UnwrapError::TooSmall { charts: atlas.chart_count, side: atlas.width });
    }
    for (&m, unwrapped) in sheet.iter().zip(&atlas.meshes) {
        take_over(&mut scene.meshes[m], unwrapped);
    }
    Ok(Atlas {
        width: atlas.width,
        height: atlas.height,
        texels_per_metre: atlas.texels_per_unit,
        charts: atlas.chart_count,
        filled: atlas.utilization,
        lost: sheet.iter().map(|&m| lost(&scene.meshes[m])).sum(),
    })
}

/// Positions of the vertices of each mesh.
pub(super) type Positions = Vec<Vec<[f32; 3]>>;
/// Own coordinates of each mesh whose charts are kept.
pub(super) type OwnCharts = Vec<Option<Vec<[f32; 2]>>>;

/// Meshes as the library takes them.
pub(super) fn inputs_of(scene: &Scene, sheet: &[usize], kept: &[usize]) -> (Positions, OwnCharts) {
    let positions = sheet.iter().map(|&m| scene.meshes[m].positions.iter().map(|p| p.to_array()).collect()).collect();
    let own = |m: &usize| kept.contains(m).then(|| scene.meshes[*m].uv1.iter().map(|uv| uv.to_array()).collect());
    (positions, sheet.iter().map(own).collect())
}

/// Charts and their places, by the library.
pub(super) fn library(
    inputs: &[uvunwrap::MeshInput<'_>],
    options: &Unwrap,
    progress: &(dyn Fn(&'static str, u64, u64) + Sync),
) -> Result<uvunwrap::Atlas, UnwrapError> {
    let density = match options.density {
        Density::PerMetre(texels_per_unit) => uvunwrap::Density::Fixed { texels_per_unit, page_size: None },
        Density::Side(page_size) => uvunwrap::Density::Auto { page_size },
    };
    let library = uvunwrap::Options { density, padding: options.padding, ..uvunwrap::Options::default() };
    let told = |step: uvunwrap::Progress| {
        let stage = match step.stage {
            uvunwrap::Stage::Packing => "placing charts",
            _ => "cutting charts",
        };
        progress(stage, step.done as u64, step.total.unwrap_or(0) as u64);
        true
    };
    let atlas = uvunwrap::generate_with_progress(inputs, &library, told)
        .map_err(|error| UnwrapError::Refused(error.to_string()))?;
    if atlas.width.max(atlas.height) > LARGEST_SIDE { Err(UnwrapError::TooLarge) } else { Ok(atlas) }
}

/// Refuses a density that would fill the memory before the library tries.
pub(super) fn check(scene: &Scene, sheet: &[usize], options: &Unwrap) -> Result<(), UnwrapError> {
    let area = |&m: &usize| {
        let mesh = &scene.meshes[m];
        (0..mesh.triangles.len()).map(|t| mesh.area(t)).sum::<f64>()
    };
    let texels = match options.density {
        Density::PerMetre(density) => sheet.iter().map(area).sum::<f64>() * f64::from(density).powi(2),
        Density::Side(side) => f64::from(side).powi(2),
    };
    if let Some(&m) = sheet.iter().find(|&&m| is_textured_by_uv1(scene, &scene.meshes[m])) {
        return Err(UnwrapError::InUse { mesh: scene.meshes[m].name.clone() });
    }
    // What is no number is too large as well.
    if texels <= f64::from(LARGEST_SIDE).powi(2) { Ok(()) } else { Err(UnwrapError::TooLarge) }
}

/// Triangles whose corners lie upon each other or on a line in the sheet.
pub(super) fn lost(mesh: &Mesh) -> usize {
    (0..mesh.triangles.len()).filter(|&t| doubled_area(corners(mesh, t)) == 0.0).count()
}

fn is_textured_by_uv1(scene: &Scene, mesh: &Mesh) -> bool {
    let Material { base_color_texture, metallic_roughness_texture, normal_texture, emissive_texture, .. } =
        &scene.materials[mesh.material as usize];
    let slots = [base_color_texture, metallic_roughness_texture, normal_texture, emissive_texture];
    slots.into_iter().flatten().any(|slot| slot.uv_set == 1)
}

/// Splits the vertices of a mesh as it was unwrapped, with all that they carry.
fn take_over(mesh: &mut Mesh, unwrapped: &uvunwrap::OutputMesh) {
    let kept: Vec<u32> = unwrapped.vertices.iter().map(|vertex| vertex.xref).collect();
    select(mesh, &kept);
    mesh.uv1 = unwrapped.vertices.iter().map(|vertex| Vec2::from(vertex.uv)).collect();
    mesh.triangles = unwrapped.indices.as_chunks::<3>().0.to_vec();
}

#[cfg(test)]
mod tests {
    use super::{Density, Unwrap, UnwrapError, unwrap};
    use crate::lightmap::{FaultKind, faults, texels};
    use crate::{Mesh, Scene, builtin};

    fn all(scene: &Scene) -> Vec<usize> {
        (0..scene.meshes.len()).collect()
    }

    /// What is unwrapped has no faults, the same triangles in space, and the density that is told.
    #[test]
    fn builtin_scenes_unwrap_without_faults() {
        for name in ["cornell-box", "teacup", "atrium"] {
            let before = builtin(name).expect("a scene of its own");
            let mut scene = before.clone();
            let sheet = all(&scene);
            let kinds: Vec<FaultKind> = faults(&scene, &sheet).iter().map(|fault| fault.kind).collect();
            assert_eq!(kinds, vec![FaultKind::Missing; sheet.len()], "{name}");
            let atlas = unwrap(&mut scene, &sheet, &Unwrap::default(), &|_, _, _| ()).expect("it fits");
            assert_eq!((faults(&scene, &sheet), atlas.lost), (Vec::new(), 0), "{name}");
            let space = |mesh: &Mesh| -> Vec<_> {
                mesh.triangles.iter().map(|t| t.map(|v| mesh.positions[v as usize])).collect()
            };
            for (a, b) in before.meshes.iter().zip(&scene.meshes) {
                assert_eq!(space(a), space(b), "{name}: {}", a.name);
            }
            let area: f64 = scene.meshes.iter().flat_map(|m| (0..m.triangles.len()).map(|t| m.area(t))).sum();
            let middles =
                texels(&scene, &sheet, atlas.width, atlas.height).iter().filter(|t| t.is_middle).count() as f64;
            let expected = area * f64::from(atlas.texels_per_metre).powi(2);
            assert!((middles / expected - 1.0).abs() < 0.1, "{name}: {middles} texels, {expected} by area");
        }
    }

    /// Charts keep the padding between each other: no texel within it of one chart is touched by another.
    #[test]
    fn charts_keep_their_distance() {
        let mut scene = builtin("teacup").expect("a scene of its own");
        let sheet = all(&scene);
        let atlas =
            unwrap(&mut scene, &sheet, &Unwrap { padding: 3, ..Unwrap::default() }, &|_, _, _| ()).expect("it fits");
        let charts: Vec<_> = scene.meshes.iter().map(crate::lightmap::Charts::of).collect();
        let mut owner = std::collections::HashMap::new();
        for texel in texels(&scene, &sheet, atlas.width, atlas.height) {
            let chart = (texel.mesh, charts[texel.mesh as usize].of_triangle[texel.triangle as usize]);
            owner.insert((texel.column as i32, texel.row as i32), chart);
        }
        for (&(x, y), chart) in &owner {
            for (dx, dy) in (-3..=3).flat_map(|dx| (-3..=3).map(move |dy| (dx, dy))) {
                let other = owner.get(&(x + dx, y + dy));
                assert!(other.is_none_or(|other| other == chart), "{chart:?} and {other:?} at {x}, {y}");
            }
        }
    }

    #[test]
    fn sheets_that_cannot_be_are_refused_and_leave_the_scene_alone() {
        let mut scene = builtin("teacup").expect("a scene of its own");
        let sheet = all(&scene);
        let vertices = scene.meshes[0].positions.len();
        let with = |density| Unwrap { density, ..Unwrap::default() };
        for density in [Density::PerMetre(1e9), Density::PerMetre(f32::NAN), Density::Side(1 << 20)] {
            assert!(
                matches!(unwrap(&mut scene, &sheet, &with(density), &|_, _, _| ()), Err(UnwrapError::TooLarge)),
                "{density:?}"
            );
        }
        for density in [Density::PerMetre(-1.0), Density::Side(0), Density::Side(5)] {
            assert!(unwrap(&mut scene, &sheet, &with(density), &|_, _, _| ()).is_err(), "{density:?}");
        }
        assert_eq!(scene.meshes[0].positions.len(), vertices);
        assert!(scene.meshes.iter().all(|mesh| mesh.uv1.is_empty()));
    }
}
