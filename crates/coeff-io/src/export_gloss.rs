//! Gloss and transfer textures as `.npy`.

use crate::export::{array, indices};
use crate::{Arriving, Bounced, Codebook, Error, Prt, Table, replace};
use std::io::Write;
use std::path::Path;

/// Writes what surfaces that shine see and what texels hold into `folder`; nothing where the file holds neither.
///
/// For vertices: `gloss_vertices.npy` `[G]` u32, the vertex of each row, and the arrays of rows below as `gloss_*`. For level L of sheet S of transfer
/// textures: `sheet_S_L_places.npy` `[T]` u32, `row * width + column` of each texel from v = 0, `sheet_S_L_transfer.npy` `[T, N*N, C]`, without
/// albedo, and the arrays of rows as `sheet_S_L_*`; `sheets.json` has the sides of levels and the sheet of each mesh.
///
/// Arrays of rows: `*_visibility.npy` `[rows, n*n]`; bounces that can be relit as `*_bounces.npy` `[rows, n*n, N*N, C]`, or, in clusters,
/// `*_clusters.npy` `[rows]` u32 and `*_weights.npy` `[rows, K]` with the book `bounce_book.npy` `[clusters, 1 + K, n*n, N*N, C]`, so that a row
/// is `book[cluster, 0] + sum weight_k book[cluster, 1 + k]`; under a fixed light `*_bounce_B.npy` `[rows, n*n, 3]`. All else is little-endian f32.
///
/// # Errors
/// `Io`.
pub(crate) fn gloss_npy(prt: &Prt, folder: &Path) -> Result<(), Error> {
    let out = Out { prt, folder };
    out.vertices()?;
    out.book()?;
    out.sheets()
}

struct Out<'a> {
    prt: &'a Prt,
    folder: &'a Path,
}

impl Out<'_> {
    fn vertices(&self) -> Result<(), Error> {
        let Some(vertices) = self.prt.gloss.as_ref().and_then(|gloss| gloss.vertices.as_ref()) else { return Ok(()) };
        let mut of_row = vec![0; vertices.arriving.visibility.rows as usize];
        for (mesh, first) in self.prt.meshes.iter().zip(&vertices.first_row) {
            let Some(first) = *first else { continue };
            for k in 0..mesh.vertices {
                of_row[(first + k) as usize] = mesh.first_vertex + k;
            }
        }
        indices(&self.folder.join("gloss_vertices.npy"), &[of_row.len() as u64], &of_row)?;
        self.arriving("gloss", &vertices.arriving)
    }

    fn book(&self) -> Result<(), Error> {
        let numbers = self.bounce_shape().into_iter().product::<u64>();
        let Some(book) = self.prt.codebooks.bounce.as_ref().filter(|book| u64::from(book.columns) == numbers) else {
            return Ok(());
        };
        let shape = [u64::from(book.clusters), 1 + u64::from(book.rank)];
        let shape: Vec<u64> = shape.into_iter().chain(self.bounce_shape()).collect();
        array(&self.folder.join("bounce_book.npy"), &shape, book.values().into_iter())
    }

    fn sheets(&self) -> Result<(), Error> {
        let Some(textures) = &self.prt.transfer_textures else { return Ok(()) };
        let coefficients = u64::from(self.prt.transfer.bands).pow(2);
        for (s, sheet) in textures.sheets.iter().enumerate() {
            for (l, level) in sheet.levels.iter().enumerate() {
                let name = format!("sheet_{s}_{l}");
                let rows = level.places.len() as u64;
                indices(&self.folder.join(format!("{name}_places.npy")), &[rows], &level.places)?;
                let shape = [rows, coefficients, u64::from(textures.channels)];
                self.table(&format!("{name}_transfer"), &shape, &level.diffuse, self.prt.codebooks.diffuse.as_ref())?;
                if let Some(arriving) = &level.arriving {
                    self.arriving(&name, arriving)?;
                }
            }
        }
        let sides = |sheet: &crate::TransferSheet| sheet.levels.iter().map(|l| [l.width, l.height]).collect::<Vec<_>>();
        let value = serde_json::json!({
            "sheets": textures.sheets.iter().map(sides).collect::<Vec<_>>(),
            "sheet_of_mesh": textures.sheet_of_mesh,
            "meshes": self.prt.meshes.iter().map(|mesh| &mesh.name).collect::<Vec<_>>(),
            "bent": textures.bent,
        });
        Ok(replace(&self.folder.join("sheets.json"), |file| writeln!(file, "{value:#}"))?)
    }

    fn arriving(&self, name: &str, arriving: &Arriving) -> Result<(), Error> {
        let visibility = &arriving.visibility;
        let shape = [u64::from(visibility.rows), u64::from(visibility.columns)];
        self.table(&format!("{name}_visibility"), &shape, visibility, self.prt.codebooks.visibility.as_ref())?;
        for (index, table) in arriving.bounces.iter().enumerate() {
            match (&self.prt.codebooks.bounce, table.form) {
                (Some(book), crate::Form::Clustered) => self.weights(name, table, book)?,
                _ => {
                    let end = if self.is_fixed() { format!("bounce_{index}") } else { "bounces".into() };
                    let shape: Vec<u64> = std::iter::once(u64::from(table.rows)).chain(self.bounce_shape()).collect();
                    self.table(&format!("{name}_{end}"), &shape, table, None)?;
                }
            }
        }
        Ok(())
    }

    fn weights(&self, name: &str, table: &Table, book: &Codebook) -> Result<(), Error> {
        let clusters: Vec<u32> = (0..table.rows).map(|row| u32::from(table.cluster(row))).collect();
        indices(&self.folder.join(format!("{name}_clusters.npy")), &[u64::from(table.rows)], &clusters)?;
        let shape = [u64::from(table.rows), u64::from(book.rank)];
        let weights = (0..table.rows).flat_map(|row| table.weights(book.rank, row));
        array(&self.folder.join(format!("{name}_weights.npy")), &shape, weights)
    }

    fn table(&self, name: &str, shape: &[u64], table: &Table, book: Option<&Codebook>) -> Result<(), Error> {
        array(&self.folder.join(format!("{name}.npy")), shape, table.decode(book).into_iter())
    }

    fn is_fixed(&self) -> bool {
        self.prt.gloss.as_ref().is_some_and(|gloss| matches!(gloss.bounced, Some(Bounced::Fixed { .. })))
    }

    /// Shape of a row of bounces.
    fn bounce_shape(&self) -> Vec<u64> {
        let Some(gloss) = &self.prt.gloss else { return Vec::new() };
        let functions = u64::from(gloss.bands).pow(2);
        match &gloss.bounced {
            Some(Bounced::Relightable { bands, channels }) => {
                vec![functions, u64::from(*bands).pow(2), u64::from(*channels)]
            }
            Some(Bounced::Fixed { .. }) => vec![functions, 3],
            None => Vec::new(),
        }
    }
}
