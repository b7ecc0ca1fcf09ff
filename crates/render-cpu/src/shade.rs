//! The colour of a surface at one sample: docs/shading.md, "Surface, per sample".

use crate::bend::bent_light;
use crate::brdf::reflectance;
use crate::gloss::{Arrived, Gloss, Ray, Reflected, Source};
use crate::lit::{LitSheet, Taps};
use crate::map::Sheet;
use crate::texture::{Encoding, SrgbTable, coordinates, read};
use coeff_io::{AlphaMode, Material, Prt, TextureSlot};
use glam::{Quat, Vec3, Vec4};
use probe_io::Environment;
use probe_io::reflection::Reflection;
use sh_math::brdf::diffuse_loss;
use std::ops::{Add, Mul};

/// Everything that the colour of a sample depends on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shader<'a> {
    pub(crate) prt: &'a Prt,
    pub(crate) environment: &'a Environment,
    /// The prefiltered probe; present where a material calls for it.
    pub(crate) reflection: Option<&'a Reflection>,
    pub(crate) srgb: &'a SrgbTable,
    /// Diffuse radiance for albedo 1, per vertex.
    pub(crate) radiance: &'a [Vec3],
    /// Its luminance times the direction that it comes from; empty where no normal map bends the light of vertices.
    pub(crate) heading: &'a [Vec3],
    /// The lobe; present where the file tells what arrives at surfaces.
    pub(crate) gloss: Option<&'a Gloss>,
    /// The finest level of transfer textures that is shown.
    pub(crate) finest: u32,
    pub(crate) light_from_world: Quat,
    pub(crate) sky: bool,
    /// Whether surfaces have colours of their own.
    pub(crate) albedo: bool,
}

/// A place on a triangle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place<'a> {
    pub(crate) material: &'a Material,
    /// The light map here, if there is one.
    pub(crate) sheet: Option<&'a Sheet>,
    /// The transfer texture here, if there is one.
    pub(crate) texels: Option<&'a LitSheet>,
    /// Where what arrives is found; none where that is not known.
    pub(crate) source: Option<Source<'a>>,
    pub(crate) vertices: [usize; 3],
    pub(crate) weights: [f32; 3],
    /// From the eye, not unit.
    pub(crate) direction: Vec3,
    /// Height of the sample at its view depth, metres.
    pub(crate) footprint: f32,
}

/// What a surface sends to the eye, and how much of what lies behind it covers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Surface {
    /// Light that the body of the surface scatters.
    pub(crate) diffuse: Vec3,
    /// Light that the surface mirrors or emits.
    pub(crate) gloss: Vec3,
    /// Share of the sample that holds the surface.
    pub(crate) coverage: f32,
    /// Share of what lies behind that is hidden.
    pub(crate) opacity: f32,
}

/// How a sample of a surface reflects.
struct Finish {
    color: Vec3,
    metallic: f32,
    roughness: f32,
    /// Diffuse radiance for albedo 1.
    scattered: Vec3,
}

impl Surface {
    /// The sample's colour over what lies behind.
    pub(crate) fn over(&self, behind: Vec3) -> Vec3 {
        self.diffuse * self.opacity + self.gloss * self.coverage + behind * (1.0 - self.opacity)
    }
}

impl Place<'_> {
    /// A vertex attribute at this place.
    fn interpolate<const N: usize>(&self, values: &[[f32; N]]) -> [f32; N] {
        let [a, b, c] = self.vertices.map(|v| values[v]);
        let [wa, wb, wc] = self.weights;
        std::array::from_fn(|k| a[k] * wa + b[k] * wb + c[k] * wc)
    }

    /// What was evaluated per vertex, at this place.
    fn between<T: Copy + Add<Output = T> + Mul<f32, Output = T>>(&self, values: &[T]) -> T {
        let [a, b, c] = self.vertices.map(|v| values[v]);
        let [wa, wb, wc] = self.weights;
        a * wa + b * wb + c * wc
    }
}

impl Shader<'_> {
    /// Whether the surface is there: an alpha mask has holes.
    pub(crate) fn exists(&self, place: &Place<'_>) -> bool {
        match place.material.alpha {
            AlphaMode::Mask(cutoff) => self.base(place).w >= cutoff,
            AlphaMode::Opaque | AlphaMode::Blend => true,
        }
    }

    /// The light that leaves a place towards the eye.
    pub(crate) fn surface(&self, place: &Place<'_>) -> Surface {
        let material = place.material;
        let base = self.base(place);
        let coverage = if material.alpha == AlphaMode::Blend { base.w.clamp(0.0, 1.0) } else { 1.0 };
        let opacity = coverage * (1.0 - material.transmission.clamp(0.0, 1.0));
        let color = if self.albedo { base.truncate() } else { Vec3::ONE };
        if material.unlit {
            return Surface { diffuse: color, gloss: Vec3::ZERO, coverage, opacity };
        }
        let shine = self.texel(material.metallic_roughness_texture.as_ref(), place, Encoding::Linear);
        let metallic = if self.albedo { (material.metallic * shine.z).clamp(0.0, 1.0) } else { 0.0 };
        let roughness = (material.roughness * shine.y).clamp(0.0, 1.0);
        let taps = self.taps(place);
        let scattered = self.light(place, taps.as_ref()).max(Vec3::ZERO);
        let glow = self.texel(material.emissive_texture.as_ref(), place, Encoding::Srgb(self.srgb)).truncate();
        let emission = Vec3::from(material.emissive) * glow;
        let (specular, kept) = match self.reflection {
            Some(reflection) if material.specular => {
                let finish = Finish { color, metallic, roughness, scattered };
                self.specular(place, reflection, &finish, taps.as_ref())
            }
            _ => (Vec3::ZERO, 1.0),
        };
        let diffuse = scattered * color * ((1.0 - metallic) * kept);
        Surface { diffuse, gloss: specular + emission, coverage, opacity }
    }

    /// What is seen along a world direction, not unit, where nothing stands.
    pub(crate) fn sky(&self, direction: Vec3) -> Vec3 {
        if self.sky {
            Vec3::from(self.environment.radiance(self.light_from_world * direction.normalize()))
        } else {
            Vec3::ZERO
        }
    }

    /// The texels around a place, where there is a transfer texture.
    fn taps(&self, place: &Place<'_>) -> Option<Taps> {
        let sheet = place.texels?;
        let uv = coordinates(&self.prt.geometry, 1, place.vertices, place.weights);
        Some(sheet.taps(uv, sheet.detail(place.footprint, self.finest)))
    }

    /// Diffuse radiance for albedo 1, not clamped: from the texture or light map where there is one, else from the vertices.
    fn light(&self, place: &Place<'_>, taps: Option<&Taps>) -> Vec3 {
        if let (Some(sheet), Some(taps)) = (place.texels, taps) {
            return sheet.diffuse(taps);
        }
        match place.sheet {
            Some(sheet) => {
                let uv = coordinates(&self.prt.geometry, 1, place.vertices, place.weights);
                sheet.radiance(uv, self.bend(place).and_then(unit).unwrap_or(Vec3::Z))
            }
            None if self.heading.is_empty() || self.bend(place).is_none() => place.between(self.radiance),
            None => {
                let (light, heading) = (place.between(self.radiance), place.between(self.heading));
                bent_light(light, heading, self.smooth(place), self.normal(place))
            }
        }
    }

    fn base(&self, place: &Place<'_>) -> Vec4 {
        let factor = Vec4::from(place.material.base_color);
        let texel = self.texel(place.material.base_color_texture.as_ref(), place, Encoding::Srgb(self.srgb));
        let colors = &self.prt.geometry.colors;
        let color = if colors.is_empty() { Vec4::ONE } else { Vec4::from(place.interpolate(colors)) };
        factor * texel * color
    }

    /// A texture at a place; white where the material has none.
    fn texel(&self, slot: Option<&TextureSlot>, place: &Place<'_>, encoding: Encoding<'_>) -> Vec4 {
        slot.map_or(Vec4::ONE, |slot| {
            let uv = coordinates(&self.prt.geometry, slot.uv_set, place.vertices, place.weights);
            read(&self.prt.textures[slot.texture as usize], slot, uv, encoding)
        })
    }

    /// What is mirrored, and the share of diffuse light that the mirror leaves.
    fn specular(
        &self,
        place: &Place<'_>,
        reflection: &Reflection,
        finish: &Finish,
        taps: Option<&Taps>,
    ) -> (Vec3, f32) {
        let normal = self.normal(place);
        let to_eye = -place.direction.normalize();
        let cosine = normal.dot(to_eye);
        let mirrored = normal * (2.0 * cosine) - to_eye;
        let arrived = match place.source {
            Some(Source::Texels(sheet)) => taps.map(|taps| Arrived::Texels(sheet, taps)),
            Some(Source::Vertices(vertices)) => Some(Arrived::Interpolated(place.between(vertices))),
            None => None,
        };
        let light = Reflected { reflection, light_from_world: self.light_from_world };
        let (radiance, roughness) = match (self.gloss, arrived) {
            (Some(gloss), Some(arrived)) => {
                let roughness = gloss.roughness(finish.roughness);
                let ray = Ray { mirrored, smooth: self.smooth(place), roughness, scattered: finish.scattered };
                (gloss.mirrored(&ray, &light, arrived), roughness)
            }
            _ => {
                let [above, _] = light.above(mirrored, self.smooth(place), finish.roughness);
                (above * self.occlusion(place), finish.roughness)
            }
        };
        let cosine = cosine.abs().min(1.0);
        (radiance * reflectance(finish.color, finish.metallic, roughness, cosine), 1.0 - diffuse_loss(cosine))
    }

    fn occlusion(&self, place: &Place<'_>) -> f32 {
        let openness = &self.prt.transfer.openness;
        if openness.is_empty() {
            return 1.0;
        }
        place.vertices.iter().zip(place.weights).map(|(&v, w)| openness[v] * w).sum::<f32>().clamp(0.0, 1.0)
    }

    /// The unit normal that mirrors: from the normal map where there is one.
    fn normal(&self, place: &Place<'_>) -> Vec3 {
        let geometry = &self.prt.geometry;
        let smooth = Vec3::from(place.interpolate(&geometry.normals));
        let bent = match self.bend(place) {
            Some(bend) => {
                let [x, y, z, w] = place.interpolate(&geometry.tangents);
                let tangent = Vec3::new(x, y, z);
                let bitangent = smooth.cross(tangent) * if w < 0.0 { -1.0 } else { 1.0 };
                tangent * bend.x + bitangent * bend.y + smooth * bend.z
            }
            None => smooth,
        };
        unit(bent).or_else(|| unit(smooth)).unwrap_or_else(|| self.geometric_normal(place))
    }

    /// The unit normal without the normal map.
    fn smooth(&self, place: &Place<'_>) -> Vec3 {
        let smooth = Vec3::from(place.interpolate(&self.prt.geometry.normals));
        unit(smooth).unwrap_or_else(|| self.geometric_normal(place))
    }

    /// What the normal map says in the tangent frame, not unit; none where there is no map or no tangents.
    fn bend(&self, place: &Place<'_>) -> Option<Vec3> {
        let slot = place.material.normal_texture.as_ref().filter(|_| !self.prt.geometry.tangents.is_empty())?;
        let map = self.texel(Some(slot), place, Encoding::Linear).truncate() * 2.0 - 1.0;
        let scale = place.material.normal_scale;
        Some(map * Vec3::new(scale, scale, 1.0))
    }

    fn geometric_normal(&self, place: &Place<'_>) -> Vec3 {
        let [a, b, c] = place.vertices.map(|v| Vec3::from(self.prt.geometry.positions[v]));
        unit((b - a).cross(c - a)).unwrap_or(Vec3::Y)
    }
}

/// The direction of a vector that is long enough to have one.
fn unit(v: Vec3) -> Option<Vec3> {
    let length = v.length();
    (length >= 1e-12 && length.is_finite()).then(|| v / length)
}
