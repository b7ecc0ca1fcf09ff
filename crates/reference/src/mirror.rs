//! What one point of a surface mirrors towards one eye.

use crate::directional_albedo;
use crate::gloss::Mirroring;
use crate::lobe::{Width, alpha_of};
use crate::microfacet::{Facets, schlick};
use glam::Vec3;
use sampling::frame::Frame;
use sampling::rng::Rng;

/// Reflectance of dielectrics at normal incidence.
const DIELECTRIC: f32 = 0.04;

/// What a mirror is made from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Polish {
    pub(crate) mirroring: Mirroring,
    /// Unit shading normal on the lit side, bent or not.
    pub(crate) normal: Vec3,
    /// The same, not bent: only what is above its plane is mirrored.
    pub(crate) facing: Vec3,
    /// Base colour, each channel in [0, 1].
    pub(crate) base: Vec3,
    /// In [0, 1].
    pub(crate) metallic: f32,
    /// Perceptual, in [0, 1].
    pub(crate) roughness: f32,
}

/// The mirroring of one point towards one eye.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mirror {
    facing: Vec3,
    /// Unit, to the eye.
    view: Vec3,
    /// Share of a white sky that is mirrored, of a table.
    pub(crate) albedo: Vec3,
    shape: Shape,
}

#[derive(Debug, Clone, Copy)]
enum Shape {
    /// A lobe about `axis`, times `scale`.
    Lobe {
        width: Width,
        axis: Vec3,
        scale: Vec3,
    },
    Microfacet {
        facets: Facets,
        frame: Frame,
        f0: Vec3,
    },
}

impl Mirror {
    /// `view` is unit and points to the eye.
    pub(crate) fn new(polish: &Polish, view: Vec3) -> Self {
        let Polish { normal, facing, base, metallic, roughness, .. } = *polish;
        let cosine = normal.dot(view);
        // A normal bent away from the eye counts as its reverse.
        let normal = if cosine < 0.0 { -normal } else { normal };
        let f0 = DIELECTRIC * (1.0 - metallic) + base * metallic;
        let albedo = directional_albedo(f0, roughness, cosine.abs().min(1.0));
        let alpha = alpha_of(roughness);
        let shape = match polish.mirroring {
            Mirroring::Lobe(lobe) => {
                let axis = (normal * (2.0 * cosine.abs()) - view).normalize_or(normal);
                let width = Width::new(lobe, alpha);
                Shape::Lobe { width, axis, scale: albedo / width.share_above(facing.dot(axis)) }
            }
            Mirroring::Microfacet => {
                let frame = Frame::from_normal(normal);
                Shape::Microfacet { facets: Facets::new(alpha, frame.to_local(view)), frame, f0 }
            }
        };
        Self { facing, view, albedo, shape }
    }

    /// BRDF times cosine for light from a unit direction, and the density with which [`Self::sample`] draws it. Nothing comes from
    /// below the surface, but such directions are drawn.
    pub(crate) fn at(&self, direction: Vec3) -> (Vec3, f32) {
        let (reflected, pdf) = match self.shape {
            Shape::Lobe { width, axis, scale } => {
                let density = width.density(axis, direction);
                (scale * density, density)
            }
            Shape::Microfacet { facets, frame, f0 } => {
                let [reflected, pdf, cosine] = facets.at(frame.to_local(direction));
                ((f0 + (1.0 - f0) * schlick(cosine)) * reflected, pdf)
            }
        };
        if self.facing.dot(direction) > 0.0 { (reflected, pdf) } else { (Vec3::ZERO, pdf) }
    }

    /// Share of light from a unit direction that is left for the diffuse part below: glTF 2.0, appendix B, mixes by Schlick's term of a
    /// dielectric at the half vector. A metal has no such part.
    pub(crate) fn transmitted(&self, direction: Vec3) -> f32 {
        let half = (self.view + direction).normalize_or(self.facing);
        (1.0 - DIELECTRIC) * (1.0 - schlick(self.view.dot(half)))
    }

    /// A direction of light, unit.
    pub(crate) fn sample(&self, rng: &mut Rng) -> Vec3 {
        match self.shape {
            Shape::Lobe { width, axis, .. } => width.sample(axis, rng),
            Shape::Microfacet { facets, frame, .. } => frame.to_world(facets.sample(rng.next_square())).normalize(),
        }
    }
}
