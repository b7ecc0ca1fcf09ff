//! What the header chunk says of light maps: all but the bytes of their sheets.

use crate::{Encoding, Error, Layers, MapLight, Maps, Sheet};
use serde::{Deserialize, Serialize};
use sh_math::hemisphere::Basis;

/// [`Maps`] without the bytes of the sheets.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MapsHeader {
    /// The basis by its id, see [`basis_id`].
    pub basis: String,
    /// Whether light is in the coefficients, or how they answer to it.
    pub light: MapLight,
    /// The sheets, whose bytes are chunks of their own.
    pub sheets: Vec<SheetHeader>,
    /// Of each mesh its sheet.
    pub sheet_of_mesh: Vec<Option<u32>>,
}

/// [`Layers`] without their bytes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SheetHeader {
    /// Texels along u.
    pub width: u32,
    /// Texels along v.
    pub height: u32,
    /// Number of layers.
    pub layers: u32,
    /// 1 or 3.
    pub channels: u32,
    /// How the numbers are held.
    pub encoding: Encoding,
}

/// The name of a basis in files, which never changes: `sh4`, `sh9`, `hl2`, `hsh4`, `hsh9`, `makhotkin4`, `makhotkin9`, `zernike3`,
/// `zernike6`, `h4`, `h6`, `modified-h1`, `modified-h4`, `modified-h6`.
#[must_use]
pub fn basis_id(basis: Basis) -> &'static str {
    match basis {
        Basis::Sh4 => "sh4",
        Basis::Sh9 => "sh9",
        Basis::Hl2 => "hl2",
        Basis::Hsh4 => "hsh4",
        Basis::Hsh9 => "hsh9",
        Basis::Makhotkin4 => "makhotkin4",
        Basis::Makhotkin9 => "makhotkin9",
        Basis::Zernike3 => "zernike3",
        Basis::Zernike6 => "zernike6",
        Basis::H4 => "h4",
        Basis::H6 => "h6",
        Basis::ModifiedH1 => "modified-h1",
        Basis::ModifiedH4 => "modified-h4",
        Basis::ModifiedH6 => "modified-h6",
    }
}

/// The basis of that id, if there is one.
#[must_use]
pub fn basis_of(id: &str) -> Option<Basis> {
    Basis::ALL.into_iter().find(|basis| basis_id(*basis) == id)
}

impl MapsHeader {
    /// The records of `maps`.
    pub(crate) fn of(maps: &Maps) -> Self {
        let sheet = |Sheet { layers }: &Sheet| SheetHeader {
            width: layers.width,
            height: layers.height,
            layers: layers.count,
            channels: layers.channels,
            encoding: layers.encoding,
        };
        Self {
            basis: basis_id(maps.basis).into(),
            light: maps.light.clone(),
            sheets: maps.sheets.iter().map(sheet).collect(),
            sheet_of_mesh: maps.sheet_of_mesh.clone(),
        }
    }

    /// The maps with the bytes of their sheets; `at` is where the header lies.
    ///
    /// # Errors
    /// `Unsupported` for an unknown basis, `Invalid` where there are more or fewer sheets than bytes of them.
    pub(crate) fn join(self, sheets: Vec<Vec<u8>>, at: u64) -> Result<Maps, Error> {
        let basis = basis_of(&self.basis)
            .ok_or_else(|| Error::Unsupported(format!("the light maps are of the unknown basis '{}'", self.basis)))?;
        if self.sheets.len() != sheets.len() {
            let (stated, found) = (self.sheets.len(), sheets.len());
            return Err(Error::invalid(at, format!("the header names {stated} sheets, the file holds {found}")));
        }
        let sheet = |(h, bytes): (SheetHeader, _)| Sheet {
            layers: Layers {
                width: h.width,
                height: h.height,
                count: h.layers,
                channels: h.channels,
                encoding: h.encoding,
                bytes,
            },
        };
        let sheets = self.sheets.into_iter().zip(sheets).map(sheet).collect();
        Ok(Maps { basis, light: self.light, sheets, sheet_of_mesh: self.sheet_of_mesh })
    }
}
