//! The supplement: records that came after version 4 of the format, as JSON, so that a later one needs no new version.

use crate::{Error, Header};
use serde::{Deserialize, Serialize};

/// What the header of version 4 has no place for. A field that a file lacks has its default.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Supplement {
    /// [`crate::Prt::origin`].
    pub origin: [f64; 3],
    /// Indices of the materials that are [`crate::Material::unlit`].
    pub unlit: Vec<u32>,
    /// [`crate::Achieved::interpolation`].
    pub interpolation: Option<[f32; 3]>,
    /// [`crate::Achieved::remainder`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub remainder: Option<f32>,
    /// [`crate::Achieved::worst_between`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub worst_between: Option<u32>,
}

impl Supplement {
    /// What of `header` belongs into the supplement.
    pub(crate) fn from_header(header: &Header) -> Self {
        let unlit = (0..).zip(&header.materials).filter(|(_, material)| material.unlit).map(|(index, _)| index);
        Self {
            origin: header.origin,
            unlit: unlit.collect(),
            interpolation: header.achieved.interpolation,
            remainder: header.achieved.remainder,
            worst_between: header.achieved.worst_between,
        }
    }

    /// The bytes of the chunk; empty where everything has its default.
    pub(crate) fn encode(header: &Header) -> Result<Vec<u8>, Error> {
        let supplement = Self::from_header(header);
        if supplement == Self::default() {
            return Ok(Vec::new());
        }
        // JSON writes what is no number as null, so nothing but numbers may come here.
        let numbers = supplement.origin.iter().all(|x| x.is_finite())
            && supplement.interpolation.is_none_or(|errors| errors.iter().all(|x| x.is_finite()))
            && supplement.remainder.is_none_or(f32::is_finite);
        if !numbers {
            return Err(Error::invalid(0, "the origin or the interpolation error is not a number"));
        }
        serde_json::to_vec(&supplement)
            .map_err(|e| Error::Unsupported(format!("the supplement of the header cannot be encoded: {e}")))
    }

    /// Puts what the bytes of a chunk at `offset` say into `header`.
    pub(crate) fn decode_into(header: &mut Header, bytes: &[u8], offset: u64) -> Result<(), Error> {
        let supplement: Self = serde_json::from_slice(bytes)
            .map_err(|e| Error::invalid(offset, format!("the supplement of the header cannot be decoded: {e}")))?;
        header.origin = supplement.origin;
        header.achieved.interpolation = supplement.interpolation;
        header.achieved.remainder = supplement.remainder;
        header.achieved.worst_between = supplement.worst_between;
        let materials = header.materials.len();
        for index in supplement.unlit {
            let material = header.materials.get_mut(index as usize).ok_or_else(|| {
                Error::invalid(offset, format!("material {index} is said to be unlit, but there are {materials}"))
            })?;
            material.unlit = true;
        }
        Ok(())
    }
}
