//! Mirrored light of surfaces that know what arrives at them: docs/shading.md, "Gloss".

use crate::lit::{LitSheet, LitSurfaces, Taps, dot};
use crate::texture::{Encoding, read};
use coeff_io::{GlossView, Mesh, Prt};
use glam::{Quat, Vec2, Vec3, Vec4};
use probe_io::reflection::Reflection;
use rayon::prelude::*;
use sh_math::{Bands, Rgb, lobe};

/// How fast the bands take over from the prefiltered light as a lobe closes: from a quarter on they count in full.
const SHARPNESS: f32 = 4.0;
/// How far below the surface the light is read that the part of a lobe below it holds: the sine, and its growth with alpha.
const DIP: [f32; 2] = [0.15, 1.5];
/// What lies below is taken to be at most so many times as bright as the whole lobe.
const BRIGHTEST_BELOW: f32 = 4.0;

/// The lobe of a frame, and the light that its tail is taken against.
#[derive(Debug)]
pub(crate) struct Gloss {
    bands: Bands,
    pub(crate) view: GlossView,
    /// `[roughness][degree]`.
    table: Vec<f32>,
    /// Coefficients of the hemisphere per degree.
    hemisphere: Vec<f64>,
    /// The first `n^2` coefficients of the turned light.
    light: Vec<[f32; 3]>,
}

/// A lobe about one direction.
#[derive(Debug)]
struct Aimed {
    /// `b_l(k) Y_k(R)`.
    weights: Vec<f32>,
    /// What the open hemisphere returns of a white furnace.
    energy: f32,
}

/// Where a place finds what arrives.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Source<'a> {
    /// Looked up here.
    Texels(&'a LitSheet),
    /// Evaluated at the vertices already, `[vertex]`: RGB and visibility.
    Vertices(&'a [Vec4]),
}

/// The mesh of each triangle where receivers are drawn, and what they answer.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Receivers<'a> {
    pub(crate) meshes: &'a [u32],
    pub(crate) lit: &'a LitSurfaces,
    /// `[vertex]`, as [`Source::Vertices`]; empty where no vertex shines.
    pub(crate) vertices: &'a [Vec4],
}

impl<'a> Receivers<'a> {
    /// The transfer texture of a triangle, and where it finds what arrives.
    pub(crate) fn of(&self, prt: &Prt, triangle: u32) -> (Option<&'a LitSheet>, Option<Source<'a>>) {
        let mesh = self.meshes[triangle as usize] as usize;
        let textures = prt.transfer_textures.as_ref();
        let sheet = textures.and_then(|textures| *textures.sheet_of_mesh.get(mesh)?);
        let sheet = sheet.map(|sheet| &self.lit.sheets[sheet as usize]);
        let source = match sheet.filter(|sheet| sheet.shines()) {
            Some(sheet) => Some(Source::Texels(sheet)),
            None => first_row(prt, mesh).map(|_| Source::Vertices(self.vertices)),
        };
        (sheet, source)
    }
}

/// The row of a mesh' first vertex, where its vertices shine.
fn first_row(prt: &Prt, mesh: usize) -> Option<u32> {
    prt.gloss.as_ref()?.vertices.as_ref()?.first_row.get(mesh).copied().flatten()
}

impl Gloss {
    /// For a file that shines, under the turned light.
    pub(crate) fn new(bands: Bands, view: GlossView, light: &Rgb) -> Self {
        let table = lobe::table(view.lobe, bands);
        let hemisphere = lobe::hemisphere(bands.count());
        Self { bands, view, table, hemisphere, light: light.with_bands(bands).values }
    }

    /// The lobe of a roughness about the unit vector `mirrored`, of cosine `cosine` with the smooth normal.
    fn aim(&self, mirrored: Vec3, roughness: f32, cosine: f32) -> Aimed {
        let count = self.bands.count();
        let mut factors = vec![0.0; count];
        lobe::read(&self.table, roughness, &mut factors);
        let mut weights = vec![0.0; self.bands.coefficients()];
        sh_math::evaluate(self.bands, mirrored, &mut weights);
        for (l, &factor) in factors.iter().enumerate() {
            weights[l * l..(l + 1) * (l + 1)].iter_mut().for_each(|y| *y *= factor);
        }
        Aimed { weights, energy: self.open_energy(&factors, cosine) }
    }

    /// [`lobe::open_energy`] with the coefficients of the hemisphere at hand.
    fn open_energy(&self, factors: &[f32], cosine: f32) -> f32 {
        let x = f64::from(cosine.max(0.0));
        let (mut before, mut now, mut sum) = (0.0, 1.0, 0.0);
        for (l, (&b, &c)) in factors.iter().zip(&self.hemisphere).enumerate() {
            sum += f64::from(b) * c * now;
            let degree = l as f64;
            let next = ((2.0 * degree + 1.0) * x * now - degree * before) / (degree + 1.0);
            (before, now) = (now, next);
        }
        sum as f32
    }

    /// G and v of one receiver or of a sum of them: `raw` is `sum_k a_k U_k`.
    fn received(aimed: &Aimed, raw: Vec4) -> Vec4 {
        let rgb = raw.truncate().max(Vec3::ZERO) / aimed.energy;
        rgb.extend((raw.w / aimed.energy).clamp(0.0, 1.0))
    }

    /// What the bands hold of the whole light, above the surface and below.
    fn held(&self, aimed: &Aimed) -> Vec3 {
        aimed.weights.iter().zip(&self.light).map(|(&a, &l)| Vec3::from(l) * a).sum()
    }

    /// The roughness that counts.
    pub(crate) fn roughness(&self, material: f32) -> f32 {
        self.view.roughness.unwrap_or(material)
    }

    /// G and v of every vertex that shines, `[vertex]`, seen from `eye`; empty where none does.
    pub(crate) fn at_vertices(&self, prt: &Prt, lit: &LitSurfaces, eye: Vec3) -> Vec<Vec4> {
        if lit.rows.is_empty() {
            return Vec::new();
        }
        let mut out = vec![Vec4::ZERO; prt.geometry.positions.len()];
        for (index, mesh) in prt.meshes.iter().enumerate() {
            let Some(first) = first_row(prt, index).filter(|_| prt.materials[mesh.material as usize].specular) else {
                continue;
            };
            let start = mesh.first_vertex as usize;
            let vertices = &mut out[start..start + mesh.vertices as usize];
            vertices.par_iter_mut().enumerate().for_each(|(i, out)| {
                let row = (first as usize + i) * self.bands.coefficients();
                let row = &lit.rows[row..row + self.bands.coefficients()];
                *out = self.at_vertex(prt, mesh, start + i, row, eye);
            });
        }
        out
    }

    fn at_vertex(&self, prt: &Prt, mesh: &Mesh, vertex: usize, row: &[Vec4], eye: Vec3) -> Vec4 {
        let geometry = &prt.geometry;
        let normal = Vec3::from(geometry.normals[vertex]).normalize_or(Vec3::Y);
        let to_eye = (eye - Vec3::from(geometry.positions[vertex])).normalize_or(normal);
        let cosine = normal.dot(to_eye);
        let material = &prt.materials[mesh.material as usize];
        let green = material.metallic_roughness_texture.as_ref().map_or(1.0, |slot| {
            let set = if slot.uv_set == 0 { &geometry.uv0 } else { &geometry.uv1 };
            let uv = set.get(vertex).map_or(Vec2::ZERO, |&uv| Vec2::from(uv));
            read(&prt.textures[slot.texture as usize], slot, uv, Encoding::Linear).y
        });
        let roughness = self.roughness((material.roughness * green).clamp(0.0, 1.0));
        let aimed = self.aim(normal * (2.0 * cosine) - to_eye, roughness, cosine);
        Self::received(&aimed, dot(&aimed.weights, row))
    }

    /// The radiance that a place mirrors before it is weighted by `F0 A + B`.
    pub(crate) fn mirrored(&self, ray: &Ray, light: &Reflected<'_>, arriving: Arrived<'_>) -> Vec3 {
        let aimed = self.aim(ray.mirrored, ray.roughness, ray.smooth.dot(ray.mirrored));
        let received = match arriving {
            Arrived::Texels(sheet, taps) => Self::received(&aimed, sheet.arriving(taps, &aimed.weights)),
            Arrived::Interpolated(received) => received,
        };
        if !self.view.tail {
            return received.truncate();
        }
        let [reflected, below] = light.above(ray.mirrored, ray.smooth, ray.roughness);
        let (open, held) = (received.w, (self.held(&aimed) - (1.0 - aimed.energy) * below) / aimed.energy);
        let kept = (SHARPNESS * (1.0 - open)).min(1.0);
        let beyond = received.truncate() - open * held;
        // What surfaces send counts in full; no more than they can be thought to send, lest bands ring about lamps.
        let sent = beyond.clamp(Vec3::ZERO, ray.scattered * (1.0 - open));
        (open * reflected + kept * beyond + (1.0 - kept) * sent).max(Vec3::ZERO)
    }
}

/// Where a sample looks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ray {
    /// Unit mirror direction.
    pub(crate) mirrored: Vec3,
    /// Unit normal without the normal map.
    pub(crate) smooth: Vec3,
    pub(crate) roughness: f32,
    /// Diffuse radiance for albedo 1, not negative: the mean of what arrives.
    pub(crate) scattered: Vec3,
}

/// The prefiltered probe, turned.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reflected<'a> {
    pub(crate) reflection: &'a Reflection,
    pub(crate) light_from_world: Quat,
}

impl Reflected<'_> {
    /// The blurred probe along a unit direction of the world.
    pub(crate) fn along(&self, mirrored: Vec3, roughness: f32) -> Vec3 {
        Vec3::from(self.reflection.sample(self.light_from_world * mirrored, roughness))
    }

    /// The blurred probe along a unit direction of the world, of what lies above a surface of unit normal `smooth`; and of what lies below
    /// it, where the lobe dips in.
    pub(crate) fn above(&self, mirrored: Vec3, smooth: Vec3, roughness: f32) -> [Vec3; 2] {
        let cosine = smooth.dot(mirrored);
        let share = lobe::above(roughness, cosine);
        let whole = self.along(mirrored, roughness);
        let deep = mirrored - smooth * (cosine + DIP[0] + DIP[1] * roughness * roughness);
        // A lamp below must not put out what a lobe that hardly dips sees above.
        let below = self.along(deep.normalize(), roughness).min(BRIGHTEST_BELOW * whole);
        [((whole - (1.0 - share) * below) / share).max(Vec3::ZERO), below]
    }
}

/// What arrives at a sample.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Arrived<'a> {
    Texels(&'a LitSheet, &'a Taps),
    /// G and v between vertices.
    Interpolated(Vec4),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_open_energy_is_that_of_the_lobes() {
        let bands = Bands::new(6).unwrap();
        let gloss = Gloss::new(bands, GlossView::default(), &Rgb::black(bands));
        let factors: Vec<f32> = (0..6).map(|l| 1.0 / (1.0 + l as f32)).collect();
        for cosine in [-0.3, 0.0, 0.2, 0.7, 1.0] {
            let exact = lobe::open_energy(&factors, cosine);
            assert!((gloss.open_energy(&factors, cosine) - exact).abs() < 1e-6, "{cosine}");
        }
        let other = lobe::open_energy(&factors, 0.5) - gloss.open_energy(&factors, 0.7);
        assert!(other.abs() > 1e-2, "another cosine must show: {other}");
    }
}
