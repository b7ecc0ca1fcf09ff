//! What is baked beside the transfer of the vertices, from the same light between surfaces.

use crate::arrival::{Arrivals, Sent, Setting, Shine};
use crate::directions::DirectionBank;
use crate::domain::{Domain, Judge};
use crate::field::Field;
use crate::gather::Gatherer;
use crate::gloss::{Compression, TextureSettings};
use crate::maps::check_sheets;
use crate::passes::Monitor;
use crate::plan::allowed;
use crate::receivers::Receivers;
use crate::repair::Repair;
use crate::{Error, MapSettings, SettingField, VolumeSettings};
use coeff_io::{Bounces, Effect, MapLight, Plan, Prt, Settings};
use scene::Scene;
use scene::lightmap::Texel;
use sh_math::Bands;

/// A corner that takes less than this part of what the brightest takes is hidden.
const HIDDEN: f32 = 0.05;
/// Least share of a lit corner: a texel that lies on a hidden one still takes from the lit.
const FEWEST_SHARE: f32 = 1e-3;

/// What is wanted beside the transfer of the vertices; nothing by default.
#[derive(Debug, Clone, Default)]
pub struct Extras {
    /// Directional light maps.
    pub maps: Option<MapSettings>,
    /// An irradiance volume.
    pub volume: Option<VolumeSettings>,
    /// The light to put into them, and into the bounces of gloss; without one they can be relit.
    pub light: Option<FixedLight>,
    /// Transfer in textures; not beside maps.
    pub textures: Option<TextureSettings>,
    /// How rows of gloss and transfer are compressed.
    pub compression: Compression,
}

impl Extras {
    pub(crate) fn is_empty(&self) -> bool {
        self.maps.is_none() && self.volume.is_none() && self.textures.is_none()
    }

    /// Whether transfer textures can be, beside what else is asked for.
    pub(crate) fn check_textures(&self, scene: &Scene) -> Result<(), Error> {
        let Some(textures) = &self.textures else { return Ok(()) };
        if self.maps.is_some() {
            let value = "light maps and transfer textures".to_owned();
            return Err(Error::Setting { setting: SettingField::Storage, value, allowed: "use one of the two" });
        }
        check_sheets(&textures.sheets, textures.dilation, scene)
    }

    /// Refuses a light that lacks coefficients or holds what is no number.
    pub(crate) fn check_light(&self, bands: u32) -> Result<(), Error> {
        let Some(light) = &self.light else { return Ok(()) };
        let enough = light.coefficients.len() >= (bands * bands) as usize;
        if enough && light.coefficients.as_flattened().iter().all(|v| v.is_finite()) {
            return Ok(());
        }
        let value = format!("{} of {} coefficients", light.name, light.coefficients.len());
        let allowed = "give as many coefficients as the bake has, all finite";
        Err(Error::Setting { setting: SettingField::FixedLight, value, allowed })
    }

    /// Whether diffuse light will be drawn by the normals of normal maps.
    pub(crate) fn is_directional(&self) -> bool {
        self.maps.as_ref().is_some_and(|maps| maps.sheets.iter().any(|sheet| sheet.directional))
    }
}

/// A light that is baked in.
#[derive(Debug, Clone)]
pub struct FixedLight {
    /// The probe as the user named it.
    pub name: String,
    /// Radiance, RGB, as many coefficients as the bake has.
    pub coefficients: Vec<[f32; 3]>,
}

/// A scene whose vertices are done.
pub(crate) struct Done<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) gatherer: &'a Gatherer<'a>,
    pub(crate) receivers: &'a Receivers,
    /// All bounces together, of every receiver.
    pub(crate) transfer: &'a Field,
    /// Of these the bounces that surfaces send on to texels and probes.
    pub(crate) sent: &'a Field,
    pub(crate) settings: &'a Settings,
    pub(crate) plan: &'a Plan,
    pub(crate) light: Option<&'a FixedLight>,
    /// Where surfaces shine: the direct transfer.
    pub(crate) direct: Option<&'a Field>,
    /// Where surfaces shine under a fixed light: the radiance of every receiver for albedo 1, per bounce from none on.
    pub(crate) radiance: &'a [Vec<[f32; 3]>],
    /// Receivers that take the mean of their neighbours.
    pub(crate) repair: &'a Repair,
    pub(crate) monitor: &'a Monitor<'a>,
}

impl Done<'_> {
    /// What the coefficients of maps and volumes will hold.
    pub(crate) fn map_light(&self) -> MapLight {
        let bands = self.plan.bands;
        match self.light {
            Some(light) => MapLight::Fixed { probe: light.name.clone(), bands },
            None => MapLight::Relightable { bands },
        }
    }

    fn light_bands(&self) -> Bands {
        Bands::new(self.plan.bands).expect("no more than the settings ask for")
    }

    /// The directions to look along for radiance in so many bands over them.
    pub(crate) fn bank(&self, domain: fn(Judge) -> Domain, functions: Bands) -> DirectionBank {
        let bands = Setting::visibility_bands(self.light_bands(), functions);
        let judge = Judge::new(self.light_bands(), bands);
        DirectionBank::over(domain(judge), bands, self.settings)
    }

    /// What arrives at points, along the directions of a bank of [`Done::bank`].
    pub(crate) fn arrivals<'b>(&'b self, bank: &'b DirectionBank, functions: Bands) -> Arrivals<'b> {
        self.arrivals_under(bank, functions, self.fixed_light())
    }

    /// The same for every coefficient of the light, whether one is fixed or not.
    pub(crate) fn relightable<'b>(&'b self, bank: &'b DirectionBank, functions: Bands) -> Arrivals<'b> {
        self.arrivals_under(bank, functions, None)
    }

    /// What arrives at points for the one normal that each has: as vertices take it, with the cosine exact.
    pub(crate) fn arrivals_at_normals<'b>(&'b self, light: Option<&'b [[f32; 3]]>) -> Arrivals<'b> {
        self.arrivals_under(self.gatherer.bank, Bands::new(1).expect("one band"), light)
    }

    /// The coefficients of the light that is baked in.
    pub(crate) fn fixed_light(&self) -> Option<&[[f32; 3]]> {
        self.light.map(|light| &light.coefficients[..self.light_bands().coefficients()])
    }

    fn arrivals_under<'b>(
        &'b self,
        bank: &'b DirectionBank,
        functions: Bands,
        light: Option<&'b [[f32; 3]]>,
    ) -> Arrivals<'b> {
        // Surfaces that see nothing of each other are seen from points in space.
        let in_space = matches!(bank.domain, Domain::Sphere(_));
        let bounces = allowed(self.settings, Effect::Interreflection) && self.settings.bounces != Bounces::Fixed(0);
        let setting = Setting {
            world: self.gatherer.world,
            receivers: self.receivers,
            sent: match light {
                Some(light) => Sent::under(self.sent, self.receivers.list.len(), light),
                None => Sent::Transfer(self.sent),
            },
            quality: self.settings.quality,
            visibility: self.gatherer.visibility || in_space && allowed(self.settings, Effect::Visibility),
            hits: self.gatherer.hits || in_space && bounces,
            light,
            light_bands: self.light_bands(),
            functions,
            shine: self.shine(),
        };
        Arrivals::new(bank, setting)
    }

    /// Surfaces that shine, where what they mirror counts.
    pub(crate) fn shine(&self) -> Option<Shine<'_>> {
        let (mirrors, direct) = (self.gatherer.mirrors?, self.direct?);
        (self.settings.bounces != Bounces::Fixed(0)).then_some(Shine { mirrors, direct })
    }

    /// What a vertex takes of light from all sides, in its brightest channel: between green walls red tells nothing.
    fn brightness(&self, vertex: u32) -> f32 {
        let first = |channel| self.transfer.channel(vertex, channel).first().map_or(0.0, |t| t.abs());
        (0..self.transfer.channels).map(first).fold(0.0, f32::max)
    }

    /// Adds what the vertices around a texel take, times a factor, by `[coefficient of the light][channel]`: under a fixed light one number for
    /// each channel.
    pub(crate) fn add_from_vertices(
        &self,
        texel: &Texel,
        light: Option<&[[f32; 3]]>,
        (factor, channels): (f32, usize),
        row: &mut [f32],
    ) {
        let first: usize = self.scene.meshes[..texel.mesh as usize].iter().map(|mesh| mesh.positions.len()).sum();
        let corners = self.scene.meshes[texel.mesh as usize].triangles[texel.triangle as usize];
        let [u, v] = texel.barycentrics;
        let vertices = corners.map(|corner| first as u32 + corner);
        let shares = shares_of_lit(vertices.map(|vertex| self.brightness(vertex)), [1.0 - u - v, u, v]);
        for (vertex, share) in vertices.into_iter().zip(shares) {
            for channel in 0..channels {
                let own = channel.min(self.transfer.channels - 1);
                let transfer = self.transfer.channel(vertex, own);
                match light {
                    Some(light) => {
                        let lit: f32 = transfer.iter().zip(light).map(|(t, l)| t * l[channel]).sum();
                        row[channel] += factor * share * lit;
                    }
                    None => {
                        let out = row.iter_mut().skip(channel).step_by(channels);
                        out.zip(transfer).for_each(|(sum, t)| *sum += factor * share * t);
                    }
                }
            }
        }
    }

    /// Bakes what is wanted into the file.
    pub(crate) fn add(&self, extras: &Extras, prt: &mut Prt) -> Result<(), Error> {
        if let Some(settings) = &extras.maps {
            let maps = crate::maps::bake(self, settings, prt)?;
            prt.maps = Some(maps);
        }
        if let Some(settings) = &extras.volume {
            prt.volume = Some(crate::volume::bake(self, settings, prt)?);
        }
        crate::gloss::bake(self, extras, prt)?;
        Ok(())
    }
}

/// Shares of the corners of a triangle at a texel of a chart that shows by less than a texel: it shows beside its lit corners, the others are
/// what hides the rest of it.
fn shares_of_lit(brightness: [f32; 3], shares: [f32; 3]) -> [f32; 3] {
    let brightest = brightness.into_iter().fold(0.0, f32::max);
    let lit = [0, 1, 2].map(|k| if brightness[k] < HIDDEN * brightest { 0.0 } else { shares[k].max(FEWEST_SHARE) });
    let sum: f32 = lit.into_iter().sum();
    if sum > 0.0 && brightest > 0.0 { lit.map(|share| share / sum) } else { shares }
}

#[cfg(test)]
mod tests {
    use super::shares_of_lit;

    /// A corner in the dark takes no part, nor do shares that rounding made negative; in even light all stay.
    #[test]
    fn corners_in_the_dark_take_no_part() {
        assert_eq!(shares_of_lit([0.0, 0.2, 0.3], [0.5, 0.25, 0.25]), [0.0, 0.5, 0.5]);
        assert_eq!(shares_of_lit([0.2, 0.2, 0.3], [0.5, 0.25, 0.25]), [0.5, 0.25, 0.25]);
        let beside = shares_of_lit([0.0, 0.2, 0.3], [1.1, -0.1, 0.0]);
        assert!(beside[1..].iter().all(|share| (share - 0.5).abs() < 1e-6), "{beside:?}");
    }

    /// A channel in which no corner has light tells nothing of the dark of one.
    #[test]
    fn corners_in_the_dark_take_no_part_can_fail() {
        assert_eq!(shares_of_lit([0.0; 3], [0.5, 0.25, 0.25]), [0.5, 0.25, 0.25]);
    }
}
