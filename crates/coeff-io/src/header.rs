//! The header chunk: every small record of a [`Prt`] in one bincode blob. The only file that knows bincode.

use crate::gloss_header::SurfacesHeader;
use crate::{Achieved, Camera, Error, MapsHeader, Material, Mesh, Plan, Prt, Settings, VolumeHeader, Wrap};
use bincode::config::{self, Configuration, Fixint, Limit, LittleEndian};
use serde::{Deserialize, Serialize};

/// All of a [`Prt`] but its arrays.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// The program and version that wrote the file.
    pub generator: String,
    /// Id of the spherical harmonics convention.
    pub convention: String,
    /// The scene as the user named it.
    pub scene: String,
    /// What was asked for.
    pub settings: Settings,
    /// Which effects were simulated, and why.
    pub plan: Plan,
    /// What was reached.
    pub achieved: Achieved,
    /// Bands of the transfer vectors.
    pub bands: u32,
    /// Channels of the transfer vectors, 1 or 3.
    pub channels: u32,
    /// Ranges of vertices and triangles with one material.
    pub meshes: Vec<Mesh>,
    /// Referred to by the meshes.
    pub materials: Vec<Material>,
    /// Views of the scene.
    pub cameras: Vec<Camera>,
    /// The pictures, whose pixels are chunks of their own.
    pub textures: Vec<TextureHeader>,
    /// Light maps, where there are any.
    pub maps: Option<MapsHeader>,
    /// An irradiance volume, where there is one.
    pub volume: Option<VolumeHeader>,
    /// Gloss, transfer textures and what is clustered.
    pub surfaces: SurfacesHeader,
    /// World position of the coordinates' zero, metres; in the supplement.
    #[serde(skip)]
    pub origin: [f64; 3],
}

/// A texture without its pixels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TextureHeader {
    /// Name or file of the picture.
    pub name: String,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Behaviour outside [0, 1] along u and v.
    pub wrap: [Wrap; 2],
}

/// Fixed-width integers: a claimed element count costs eight bytes of file, and the encoding fits on half a page.
fn encoding() -> Configuration<LittleEndian, Fixint> {
    config::standard().with_little_endian().with_fixed_int_encoding()
}

impl Header {
    /// The small records of `prt`.
    pub(crate) fn of(prt: &Prt) -> Self {
        let texture =
            |t: &crate::Texture| TextureHeader { name: t.name.clone(), width: t.width, height: t.height, wrap: t.wrap };
        Self {
            generator: prt.generator.clone(),
            convention: prt.convention.clone(),
            scene: prt.scene.clone(),
            settings: prt.settings.clone(),
            plan: prt.plan.clone(),
            achieved: prt.achieved.clone(),
            bands: prt.transfer.bands,
            channels: prt.transfer.channels,
            meshes: prt.meshes.clone(),
            materials: prt.materials.clone(),
            cameras: prt.cameras.clone(),
            textures: prt.textures.iter().map(texture).collect(),
            maps: prt.maps.as_ref().map(MapsHeader::of),
            volume: prt.volume.as_ref().map(VolumeHeader::of),
            surfaces: SurfacesHeader::of(prt),
            origin: prt.origin,
        }
    }

    /// The bytes of the header chunk.
    pub(crate) fn encode(&self) -> Result<Vec<u8>, Error> {
        let bytes = bincode::serde::encode_to_vec(self, encoding());
        let bytes = bytes.map_err(|e| Error::Unsupported(format!("the header cannot be encoded: {e}")))?;
        if bytes.len() > LARGEST {
            return Err(Error::Unsupported(format!("the header takes {} bytes, more than {LARGEST}", bytes.len())));
        }
        Ok(bytes)
    }

    /// Reads the bytes of a header chunk that begins at `offset`.
    pub(crate) fn decode(bytes: &[u8], offset: u64) -> Result<Self, Error> {
        let decoded = match bytes.len() {
            0..=0x1000 => decode_within::<0x1000>(bytes),
            0x1001..=0x1_0000 => decode_within::<0x1_0000>(bytes),
            0x1_0001..=0x10_0000 => decode_within::<0x10_0000>(bytes),
            0x10_0001..=LARGEST => decode_within::<LARGEST>(bytes),
            more => {
                return Err(Error::Unsupported(format!("the header takes {more} bytes, more than {LARGEST}")));
            }
        };
        let (header, used) =
            decoded.map_err(|e| Error::invalid(offset, format!("the header cannot be decoded: {e}")))?;
        if used != bytes.len() {
            return Err(Error::invalid(offset + used as u64, "the header goes on after its last record"));
        }
        Ok(header)
    }
}

/// Most bytes of a header: far more than any scene of a million objects needs.
const LARGEST: usize = 0x1000_0000;

/// Decodes with a cap on what lengths inside may claim, near the length of the chunk: bincode allocates a string as
/// soon as its length is known, and its cap is a constant of the type.
fn decode_within<const CAP: usize>(bytes: &[u8]) -> Result<(Header, usize), bincode::error::DecodeError> {
    let capped: Configuration<LittleEndian, Fixint, Limit<CAP>> = encoding().with_limit::<CAP>();
    bincode::serde::decode_from_slice(bytes, capped)
}
