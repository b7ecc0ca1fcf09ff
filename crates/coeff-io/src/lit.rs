//! Light maps as renderers take them: whether they fit the rest of the file, in which basis they are drawn, and the change to it.

use crate::{Lit, MapLight, Maps, Prt, Sheet};
use glam::Quat;
use sh_math::{Bands, Rgb, hemisphere::Basis};

/// Half the angle of a rotation that counts as none: rounding.
const MOST_TURN: f32 = 1e-6;

impl Maps {
    /// A light with as many bands as the maps answer to: what [`crate::Sheet::lit`] asks for.
    #[must_use]
    pub fn light_of(&self, light: &Rgb) -> Rgb {
        match self.light {
            MapLight::Relightable { bands } => light.with_bands(Bands::new(bands).unwrap_or(light.bands)),
            MapLight::Fixed { .. } => light.clone(),
        }
    }

    /// What in the maps does not fit the rest of `prt`, or each other, in half a sentence; none where they can be drawn.
    ///
    /// What it passes can be decoded.
    #[must_use]
    pub fn fault(&self, prt: &Prt) -> Option<String> {
        if let MapLight::Relightable { bands } = self.light
            && Bands::new(bands).is_none()
        {
            return Some(format!("the light maps answer to {bands} bands of light, which are not supported"));
        }
        if self.sheet_of_mesh.len() != prt.meshes.len() {
            return Some(format!("light maps for {} meshes of {}", self.sheet_of_mesh.len(), prt.meshes.len()));
        }
        for (mesh, sheet) in prt.meshes.iter().zip(&self.sheet_of_mesh) {
            match sheet {
                Some(sheet) if *sheet as usize >= self.sheets.len() => {
                    return Some(format!("mesh `{}` names light map {sheet} of {}", mesh.name, self.sheets.len()));
                }
                Some(_) if mesh.triangles > 0 && prt.geometry.uv1.is_empty() => {
                    return Some(format!("mesh `{}` has a light map but no second texture coordinates", mesh.name));
                }
                _ => {}
            }
        }
        self.sheets.iter().enumerate().find_map(|(i, sheet)| {
            let layers = &sheet.layers;
            let sound = layers.width > 0 && layers.height > 0 && matches!(layers.channels, 1 | 3);
            if !sound || !self.holds(layers.count) {
                let (width, height, channels) = (layers.width, layers.height, layers.channels);
                let (name, depth) = (self.basis.name(), self.light.depth());
                return Some(format!(
                    "light map {i} has {} layers of {width} x {height} texels and {channels} channels; {name} takes {depth} per function",
                    layers.count
                ));
            }
            layers.fault().map(|(_, what)| format!("the layers of light map {i}: {what}"))
        })
    }

    /// Whether a sheet of so many layers holds all functions, as many as the basis can be cut to, or the one of an ordinary light map.
    #[must_use]
    pub fn holds(&self, layers: u32) -> bool {
        let depth = self.light.depth();
        let held = layers as usize / depth;
        layers as usize == held * depth && (held == 1 || self.basis.cut(held).is_some())
    }

    /// The functions that a sheet holds: those of the basis, of its cut, or the one of an ordinary light map, where no normal map is.
    #[must_use]
    pub fn held(&self, sheet: &Sheet) -> Basis {
        let functions = sheet.layers.count as usize / self.light.depth();
        if functions == 1 { Basis::ModifiedH1 } else { self.basis.cut(functions).unwrap_or(self.basis) }
    }

    /// The basis that a sheet which holds `held` is drawn in where `asked` is asked for: an ordinary light map, one function, stays what
    /// it is, as no normal map lies upon it.
    #[must_use]
    pub fn shown(held: Basis, asked: Basis) -> Basis {
        if held.count() == 1 { held } else { asked }
    }

    /// A sheet under a light in the basis that it is drawn in where `asked` is asked for.
    #[must_use]
    pub fn lit_in(&self, sheet: &Sheet, light: &Rgb, asked: Basis) -> (Basis, Lit) {
        let held = self.held(sheet);
        let shown = Self::shown(held, asked);
        (shown, sheet.lit(self, &self.light_of(light).values).changed(held, shown))
    }

    /// Whether any mesh shows a map.
    #[must_use]
    pub fn are_shown(&self) -> bool {
        self.sheet_of_mesh.iter().any(Option::is_some)
    }

    /// The basis that `maps` are drawn in when `basis` is asked for (their own where it is none), cut to `functions`, under a light turned
    /// by `rotation`; none where no mesh shows a map. Reads no sheet.
    ///
    /// # Errors
    /// Half a sentence about what cannot be shown: a basis where there are no maps, a number of functions that is no best fit
    /// ([`Basis::cut`]), another light than that of fixed maps.
    pub fn drawn_in(
        maps: Option<&Self>,
        basis: Option<Basis>,
        functions: Option<u32>,
        rotation: Quat,
    ) -> Result<Option<Basis>, String> {
        let Some(maps) = maps.filter(|maps| maps.are_shown()) else {
            return match (basis, functions) {
                (None, None) => Ok(None),
                _ => Err("a basis is asked for, but the file holds no light maps; bake it with light maps".into()),
            };
        };
        if let MapLight::Fixed { probe, .. } = &maps.light
            && rotation.xyz().length() > MOST_TURN
        {
            return Err(format!(
                "the light is turned, but the light maps hold that of `{probe}` as it lay; leave it, or bake light maps that can be relit"
            ));
        }
        let basis = basis.unwrap_or(maps.basis);
        functions.map_or(Ok(basis), |functions| cut(basis, functions)).map(Some)
    }
}

impl Prt {
    /// Whether a normal map bends the light of some vertices: of a mesh that neither a light map nor a transfer texture lights.
    #[must_use]
    pub fn bends_vertices(&self) -> bool {
        let of_maps = self.maps.as_ref().map(|maps| &maps.sheet_of_mesh);
        let of_textures = self.transfer_textures.as_ref().map(|textures| &textures.sheet_of_mesh);
        let is_on_sheet = |mesh: usize| {
            [of_maps, of_textures].into_iter().flatten().any(|sheets| sheets.get(mesh).copied().flatten().is_some())
        };
        let bends = |mesh: &crate::Mesh| {
            let material = &self.materials[mesh.material as usize];
            material.normal_texture.is_some() && !material.unlit
        };
        !self.geometry.tangents.is_empty()
            && self.meshes.iter().enumerate().any(|(index, mesh)| bends(mesh) && !is_on_sheet(index))
    }

    /// Bands of light that transfer, light maps and gloss answer to, whichever has most; none where that is not supported.
    #[must_use]
    pub fn light_bands(&self) -> Option<Bands> {
        let of_maps = match self.maps.as_ref().map(|maps| &maps.light) {
            Some(MapLight::Relightable { bands }) => *bands,
            _ => 0,
        };
        // All that reach a product with visibility: 2 n - 1.
        let of_gloss = self.gloss.as_ref().map_or(0, |gloss| (2 * gloss.bands).saturating_sub(1).min(Bands::MAX));
        Bands::new(self.transfer.bands.max(of_maps).max(of_gloss))
    }
}

fn cut(basis: Basis, functions: u32) -> Result<Basis, String> {
    basis.cut(functions as usize).ok_or_else(|| {
        let possible = (1..=basis.count()).filter(|&n| basis.cut(n).is_some());
        let possible = possible.map(|n| n.to_string()).collect::<Vec<_>>().join(" or ");
        let name = basis.name();
        format!("{functions} functions of {name}: a cut there is no best fit; ask for {possible}, or for another basis")
    })
}

impl Lit {
    /// The coefficients in basis `to` of what these describe in basis `from`: the least square error over the hemisphere, nothing lost
    /// where `to` spans `from`. Sums are in f64.
    #[must_use]
    pub fn changed(mut self, from: Basis, to: Basis) -> Self {
        if from.cut(to.count()) == Some(to) {
            self.functions.truncate(to.count());
            return self;
        }
        let entry = |row: &[f64; Basis::MAX_COUNT], texel: usize| {
            let mut sum = [0.0; 3];
            for (factor, function) in row.iter().zip(&self.functions) {
                sum.iter_mut().zip(function[texel]).for_each(|(sum, value)| *sum += factor * f64::from(value));
            }
            sum.map(|value| value as f32)
        };
        let texels = self.functions.first().map_or(0, Vec::len);
        let rows = to.matrix_from(from);
        let functions = rows.iter().map(|row| (0..texels).map(|texel| entry(row, texel)).collect()).collect();
        Self { functions, ..self }
    }
}
