//! Whether light maps agree with themselves and with the meshes of their file.

use crate::table::Kind;
use crate::validate::{Check, LARGEST_SIDE};
use crate::{Error, MapLight, Maps, Prt, Sheet};
use sh_math::Bands;

impl Check<'_> {
    /// Sheets, the meshes that lie on them, and every number of their layers.
    pub(crate) fn maps(&self, maps: &Maps, prt: &Prt) -> Result<(), Error> {
        self.sheets(maps)?;
        let (meshes, named) = (prt.meshes.len(), maps.sheet_of_mesh.len());
        self.header(meshes == named, || {
            format!("the light maps name sheets of {named} meshes, but there are {meshes}")
        })?;
        let drawn = maps.sheet_of_mesh.iter().any(Option::is_some);
        self.header(!drawn || !prt.geometry.uv1.is_empty(), || {
            "there are light maps but no second texture coordinates".into()
        })
    }

    /// The sheets by themselves, and that each that is named exists.
    pub(crate) fn sheets(&self, maps: &Maps) -> Result<(), Error> {
        self.light(&maps.light, "the light maps")?;
        let exists = |sheet: &u32| (*sheet as usize) < maps.sheets.len();
        self.header(maps.sheet_of_mesh.iter().flatten().all(exists), || {
            "a mesh lies on a sheet that does not exist".into()
        })?;
        maps.sheets.iter().enumerate().try_for_each(|(i, sheet)| self.sheet(i, sheet, maps))
    }

    /// Bands that exist: what [`MapLight::depth`] needs.
    pub(crate) fn light(&self, light: &MapLight, whose: &str) -> Result<(), Error> {
        let (MapLight::Fixed { bands, .. } | MapLight::Relightable { bands }) = light;
        self.header(Bands::new(*bands).is_some(), || format!("{bands} bands of {whose} are not supported"))
    }

    fn sheet(&self, index: usize, sheet: &Sheet, maps: &Maps) -> Result<(), Error> {
        let layers = &sheet.layers;
        let sides = 1..=LARGEST_SIDE;
        self.header(sides.contains(&layers.width) && sides.contains(&layers.height), || {
            format!("sheet {index} has {}x{} texels", layers.width, layers.height)
        })?;
        self.header(maps.holds(layers.count) && matches!(layers.channels, 1 | 3), || {
            let (name, depth) = (maps.basis.name(), maps.light.depth());
            format!(
                "sheet {index} has {} layers of {} channels; {name} takes {depth} layers of 1 or 3 per function",
                layers.count, layers.channels
            )
        })?;
        match layers.fault() {
            None => Ok(()),
            Some((byte, what)) => self.require_part(Kind::Sheet, index, byte, format!("sheet {index}: {what}")),
        }
    }
}
