//! Transfer in textures: what vertices hold elsewhere, at texels, so that it does not depend on how finely a mesh is cut (\[T\]).

use crate::{Arriving, Prt, Table};

/// Textures of transfer, and which meshes they lie upon by their second texture coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct TransferTextures {
    /// Channels of the diffuse transfer: 1 or 3. Its bands are those of [`crate::Transfer`].
    pub channels: u32,
    /// Whether diffuse transfer is about the normals of normal maps, \[T\] section 6.2.
    pub bent: bool,
    /// Referred to by `sheet_of_mesh`.
    pub sheets: Vec<TransferSheet>,
    /// Of each mesh of the file its sheet; none where the vertices are drawn.
    pub sheet_of_mesh: Vec<Option<u32>>,
}

/// One texture, with its levels of detail.
#[derive(Debug, Clone, PartialEq)]
pub struct TransferSheet {
    /// The finest first; each has half the columns and rows of the one before, rounded up. Never empty.
    pub levels: Vec<TransferLevel>,
}

/// The texels of one level that hold something, rings around charts included.
#[derive(Debug, Clone, PartialEq)]
pub struct TransferLevel {
    /// Texels along u.
    pub width: u32,
    /// Texels along v.
    pub height: u32,
    /// Of each row of the tables its texel, `row * width + column` from v = 0; ascending.
    pub places: Vec<u32>,
    /// `[texel][coefficient][channel]`, as [`crate::Transfer::values`].
    pub diffuse: Table,
    /// For mirrored light; none where no surface of the sheet shines.
    pub arriving: Option<Arriving>,
}

impl TransferTextures {
    /// Texels per metre of a sheet's finest level: the root of the ratio of the areas of its meshes there and in the world; 0 where they have
    /// none.
    #[must_use]
    pub fn density(&self, prt: &Prt, sheet: u32) -> f32 {
        let level = &self.sheets[sheet as usize].levels[0];
        let (mut there, mut here) = (0.0f64, 0.0f64);
        let meshes = prt.meshes.iter().zip(&self.sheet_of_mesh).filter(|(_, s)| **s == Some(sheet));
        for (mesh, _) in meshes {
            let triangles = mesh.first_triangle as usize..(mesh.first_triangle + mesh.triangles) as usize;
            for corners in &prt.geometry.triangles[triangles] {
                let uv = corners.map(|v| glam::Vec2::from(prt.geometry.uv1[v as usize]).as_dvec2());
                let at = corners.map(|v| glam::Vec3::from(prt.geometry.positions[v as usize]).as_dvec3());
                there += (uv[1] - uv[0]).perp_dot(uv[2] - uv[0]).abs();
                here += (at[1] - at[0]).cross(at[2] - at[0]).length();
            }
        }
        let texels = there * f64::from(level.width) * f64::from(level.height);
        if here > 0.0 { (texels / here).sqrt() as f32 } else { 0.0 }
    }

    /// Number of texels of all levels that hold something.
    #[must_use]
    pub fn texels(&self) -> u64 {
        self.sheets.iter().flat_map(|sheet| &sheet.levels).map(|level| level.places.len() as u64).sum()
    }
}
