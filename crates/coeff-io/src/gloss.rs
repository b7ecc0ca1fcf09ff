//! What surfaces that shine need: which directions they see, and what arrives from the surfaces that block the others.

use crate::{AlphaMode, Codebook, Material, Prt, Table};
use serde::{Deserialize, Serialize};

/// How receivers on surfaces that shine see their surroundings, for mirrored light.
///
/// With `U = M_L V + B L` (the radiance that arrives, `n^2` coefficients in world axes: `M_L` of [`sh_math::light_matrix`], V the visibility,
/// B L what surfaces send), what is mirrored is `sum b_l U_lm Y_lm(R)` over the same for an open hemisphere: `docs/shading.md`, Gloss.
#[derive(Debug, Clone, PartialEq)]
pub struct Gloss {
    /// Number of bands n of visibility and of what arrives.
    pub bands: u32,
    /// What the tables of bounces hold; none where no surface sends light.
    pub bounced: Option<Bounced>,
    /// Rows of vertices; none where texels hold all.
    pub vertices: Option<VertexGloss>,
}

/// Receivers at vertices.
#[derive(Debug, Clone, PartialEq)]
pub struct VertexGloss {
    /// Of each mesh the row of its first vertex, the others follow; none where it does not shine.
    pub first_row: Vec<Option<u32>>,
    /// The rows.
    pub arriving: Arriving,
}

/// What receivers see.
#[derive(Debug, Clone, PartialEq)]
pub struct Arriving {
    /// `[receiver][n^2]`: coefficients of visibility over the sphere, 1 where a direction above the surface is open; without a cosine.
    pub visibility: Table,
    /// What surfaces send by [`Bounced`]: one table, or one per bounce where the light is fixed.
    pub bounces: Vec<Table>,
}

/// What tables of bounces hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Bounced {
    /// Transfer: `[receiver][coefficient of n^2][coefficient of the light][channel]`.
    Relightable {
        /// Bands of the light.
        bands: u32,
        /// 1 or 3.
        channels: u32,
    },
    /// Radiance under one light with one set of materials, `[receiver][coefficient of n^2][3]`, a table per bounce, as the paper has them
    /// (\[T\] section 4.2). They are refused when either changes.
    Fixed {
        /// The probe as the user named it.
        probe: String,
        /// Its coefficients, RGB, as it lay.
        light: Vec<[f32; 3]>,
        /// [`Prt::materials_mark`] of the materials at the bake.
        materials: u32,
        /// Number of tables.
        bounces: u32,
    },
}

/// The codebooks of clustered tables.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Codebooks {
    /// Of diffuse transfer, at vertices and texels.
    pub diffuse: Option<Codebook>,
    /// Of visibility.
    pub visibility: Option<Codebook>,
    /// Of bounces that can be relit.
    pub bounce: Option<Codebook>,
}

impl Codebooks {
    /// Those that there are, in the order of the file.
    pub fn all(&self) -> impl Iterator<Item = &Codebook> {
        [&self.diffuse, &self.visibility, &self.bounce].into_iter().flatten()
    }
}

impl Bounced {
    /// Numbers of a row.
    #[must_use]
    pub fn columns(&self, gloss_bands: u32) -> usize {
        let functions = (gloss_bands * gloss_bands) as usize;
        match self {
            Self::Relightable { bands, channels } => functions * (bands * bands * channels) as usize,
            Self::Fixed { .. } => functions * 3,
        }
    }

    /// Number of tables.
    #[must_use]
    pub fn tables(&self) -> usize {
        match self {
            Self::Relightable { .. } => 1,
            Self::Fixed { bounces, .. } => *bounces as usize,
        }
    }
}

impl Prt {
    /// A checksum of all that decides how surfaces reflect: materials and the pictures that they show.
    #[must_use]
    pub fn materials_mark(&self) -> u32 {
        let mut hasher = crc32fast::Hasher::new();
        for material in &self.materials {
            add(&mut hasher, material);
        }
        for texture in &self.textures {
            hasher.update(&texture.width.to_le_bytes());
            hasher.update(&texture.height.to_le_bytes());
            hasher.update(&texture.wrap.map(|wrap| wrap as u8));
            hasher.update(bytemuck::cast_slice(&texture.rgba));
        }
        self.meshes.iter().for_each(|mesh| hasher.update(&mesh.material.to_le_bytes()));
        self.geometry.colors.iter().flatten().for_each(|x| hasher.update(&x.to_le_bytes()));
        hasher.finalize()
    }
}

fn add(hasher: &mut crc32fast::Hasher, material: &Material) {
    let cutoff = match material.alpha {
        AlphaMode::Opaque => -1.0,
        AlphaMode::Mask(cutoff) => cutoff,
        AlphaMode::Blend => -2.0,
    };
    let own = [material.metallic, material.roughness, material.transmission, material.normal_scale, cutoff];
    material.base_color.iter().chain(&own).for_each(|x| hasher.update(&x.to_le_bytes()));
    let slots = [&material.base_color_texture, &material.metallic_roughness_texture, &material.normal_texture];
    for slot in slots {
        let (texture, set) = slot.as_ref().map_or((u32::MAX, 0), |slot| (slot.texture, slot.uv_set));
        hasher.update(&texture.to_le_bytes());
        hasher.update(&[set, u8::from(material.specular)]);
        let transform = slot.iter().flat_map(|slot| slot.transform.iter().flatten());
        transform.for_each(|x| hasher.update(&x.to_le_bytes()));
    }
}
