//! What there is to draw: runs of triangles that share pipeline and bindings.

use coeff_io::Prt;
use std::ops::Range;

/// A run of triangles with one material and one light map, or none.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Draw {
    pub(crate) material: u32,
    pub(crate) sheet: Option<u32>,
    /// The transfer texture above it.
    pub(crate) texels: Option<u32>,
    /// Whether its vertices hold gloss.
    pub(crate) rows: bool,
    pub(crate) triangles: Range<u32>,
}

impl Draw {
    /// What decides on pipeline and bindings.
    pub(crate) fn kind(&self) -> Self {
        Self { triangles: 0..0, ..self.clone() }
    }
}

/// The triangles of all meshes; neighbours of one material and light map are drawn together.
pub(crate) fn draws(prt: &Prt) -> Vec<Draw> {
    let mut draws: Vec<Draw> = Vec::new();
    for (index, mesh) in prt.meshes.iter().enumerate().filter(|(_, mesh)| mesh.triangles > 0) {
        let sheet = prt.maps.as_ref().and_then(|maps| maps.sheet_of_mesh[index]);
        let texels = prt.transfer_textures.as_ref().and_then(|textures| textures.sheet_of_mesh[index]);
        let vertices = prt.gloss.as_ref().and_then(|gloss| gloss.vertices.as_ref());
        let rows = vertices.is_some_and(|vertices| vertices.first_row[index].is_some());
        let (material, triangles) = (mesh.material, mesh.first_triangle..mesh.first_triangle + mesh.triangles);
        match draws.last_mut() {
            Some(draw)
                if (draw.material, draw.sheet, draw.texels, draw.rows) == (material, sheet, texels, rows)
                    && draw.triangles.end == triangles.start =>
            {
                draw.triangles.end = triangles.end;
            }
            _ => draws.push(Draw { material, sheet, texels, rows, triangles }),
        }
    }
    draws
}
