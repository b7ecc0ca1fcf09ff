//! What a texture file holds: texels of a 2-D array or of a 3-D texture, without mip levels.

use crate::{Error, dds, ktx};
use ddsfile::DxgiFormat;
use ktx2::Format;

/// Files that graphics programs read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Container {
    /// Khronos' KTX 2.0, without supercompression.
    Ktx2,
    /// Microsoft's DDS with the header of DirectX 10.
    Dds,
}

impl Container {
    /// The ending of file names.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Ktx2 => "ktx2",
            Self::Dds => "dds",
        }
    }

    /// The bytes of a file.
    pub(crate) fn write(self, texels: &Texels) -> Result<Vec<u8>, Error> {
        texels.check_limits()?;
        match self {
            Self::Ktx2 => ktx::write(texels),
            Self::Dds => Ok(dds::write(texels)),
        }
    }

    /// Reads what [`Container::write`] writes.
    pub(crate) fn read(self, bytes: &[u8]) -> Result<Texels, Error> {
        let texels = match self {
            Self::Ktx2 => ktx::read(bytes),
            Self::Dds => dds::read(bytes),
        }?;
        if texels.expected_length() != Some(texels.bytes.len() as u64) {
            return Err(Error::invalid(0, "the texels are fewer or more than the header says"));
        }
        Ok(texels)
    }
}

/// How a texel is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TexelFormat {
    R16F,
    Rgba16F,
    R32F,
    Rgba32F,
    Bc1,
    Bc6h,
}

impl TexelFormat {
    const ALL: [Self; 6] = [Self::R16F, Self::Rgba16F, Self::R32F, Self::Rgba32F, Self::Bc1, Self::Bc6h];

    /// Side of a block of texels and its bytes.
    pub(crate) fn block(self) -> (u32, u32) {
        match self {
            Self::R16F => (1, 2),
            Self::Rgba16F => (1, 8),
            Self::R32F => (1, 4),
            Self::Rgba32F => (1, 16),
            Self::Bc1 => (4, 8),
            Self::Bc6h => (4, 16),
        }
    }

    pub(crate) fn dxgi(self) -> DxgiFormat {
        match self {
            Self::R16F => DxgiFormat::R16_Float,
            Self::Rgba16F => DxgiFormat::R16G16B16A16_Float,
            Self::R32F => DxgiFormat::R32_Float,
            Self::Rgba32F => DxgiFormat::R32G32B32A32_Float,
            Self::Bc1 => DxgiFormat::BC1_UNorm,
            Self::Bc6h => DxgiFormat::BC6H_UF16,
        }
    }

    pub(crate) fn vulkan(self) -> Format {
        match self {
            Self::R16F => Format::R16_SFLOAT,
            Self::Rgba16F => Format::R16G16B16A16_SFLOAT,
            Self::R32F => Format::R32_SFLOAT,
            Self::Rgba32F => Format::R32G32B32A32_SFLOAT,
            Self::Bc1 => Format::BC1_RGB_UNORM_BLOCK,
            Self::Bc6h => Format::BC6H_UFLOAT_BLOCK,
        }
    }

    pub(crate) fn of_dxgi(format: DxgiFormat) -> Option<Self> {
        Self::ALL.into_iter().find(|known| known.dxgi() == format)
    }

    pub(crate) fn of_vulkan(format: Format) -> Option<Self> {
        Self::ALL.into_iter().find(|known| known.vulkan() == format)
    }
}

/// Whether a texture is an array of pictures or a box.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Extent {
    /// So many pictures.
    Layers(u32),
    /// So many slices.
    Depth(u32),
}

impl Extent {
    pub(crate) fn count(self) -> u32 {
        let (Self::Layers(count) | Self::Depth(count)) = self;
        count
    }
}

/// Most layers of an array, texels along a side of an array and of a box: those of Direct3D 11.
const LIMITS: [u32; 3] = [2048, 16_384, 2048];

/// A texture: `[layer or slice][row][column]` texels or blocks.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Texels {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) extent: Extent,
    pub(crate) format: TexelFormat,
    pub(crate) bytes: Vec<u8>,
}

impl Texels {
    /// Bytes of one layer or slice; none where they overflow.
    pub(crate) fn plane(&self) -> Option<u64> {
        let (side, bytes) = self.format.block();
        let blocks = u64::from(self.width.div_ceil(side)).checked_mul(u64::from(self.height.div_ceil(side)))?;
        blocks.checked_mul(u64::from(bytes))
    }

    fn expected_length(&self) -> Option<u64> {
        self.plane()?.checked_mul(u64::from(self.extent.count()))
    }

    fn check_limits(&self) -> Result<(), Error> {
        let [layers, picture, box_side] = LIMITS;
        let fits = match self.extent {
            Extent::Layers(count) => count <= layers && self.width.max(self.height) <= picture,
            Extent::Depth(depth) => self.width.max(self.height).max(depth) <= box_side,
        };
        if fits {
            return Ok(());
        }
        Err(Error::Unsupported(format!(
            "a texture of {}x{} texels and {} layers is more than graphics hardware reads: bake smaller sheets, fewer bands or a coarser volume",
            self.width,
            self.height,
            self.extent.count()
        )))
    }
}
