//! One path: the light that leaves a diffuse surface, estimated once without bias.

use crate::{Light, Receiver, World};
use glam::Vec3;
use raytrace::offset_origin;
use sampling::frame::Frame;
use sampling::rng::Rng;
use sampling::warp::{cosine_concentric_pdf, square_to_cosine_concentric};
use std::f32::consts::FRAC_1_PI;

/// Bounces after which a path of unlimited length may end by chance.
const SURE_BOUNCES: u32 = 3;
/// Highest chance to go on: paths end even where nothing absorbs.
const MAX_SURVIVAL: f32 = 0.95;

/// Radiance that leaves `surface`, after up to `max_bounces` reflections on other surfaces.
///
/// Each surface on the path adds the light that reaches it straight: from lamps by a direction to each, from the
/// picture by two directions, one drawn by radiance and one by the cosine, weighted by the balance heuristic. The
/// second one carries the path on where it hits something.
pub(crate) fn outgoing(
    world: &World,
    light: &Light,
    surface: Receiver,
    max_bounces: Option<u32>,
    rng: &mut Rng,
) -> Vec3 {
    let mut surface = surface;
    let mut throughput = surface.albedo;
    let mut sum = Vec3::ZERO;
    let mut bounce = 0;
    while throughput.max_element() > 0.0 {
        let origin = offset_origin(surface.position, surface.geometric_normal);
        sum += throughput
            * (from_lamps(world, light, &surface, origin, rng) + from_image(world, light, &surface, origin, rng));

        let local = square_to_cosine_concentric(rng.next_square());
        let direction = Frame::from_normal(surface.normal).to_world(local).normalize();
        let is_last = max_bounces == Some(bounce);
        let next = if is_last { None } else { world.closest(origin, direction) };
        let Some(next) = next else {
            if !(is_last && world.occluded(origin, direction)) {
                let (radiance, light_pdf) = light.image.look(direction);
                let pdf = cosine_concentric_pdf(local);
                sum += throughput * radiance * (pdf / (pdf + light_pdf));
            }
            break;
        };
        throughput *= next.albedo;
        surface = next;
        bounce += 1;
        if max_bounces.is_none() && bounce > SURE_BOUNCES {
            let survival = throughput.max_element().min(MAX_SURVIVAL);
            if rng.next_f32() >= survival {
                break;
            }
            throughput /= survival;
        }
    }
    sum
}

/// Direct light of all lamps that an albedo of 1 would reflect.
fn from_lamps(world: &World, light: &Light, surface: &Receiver, origin: Vec3, rng: &mut Rng) -> Vec3 {
    let mut sum = Vec3::ZERO;
    for lamp in &light.lamps {
        let (direction, flux) = lamp.sample(rng.next_square());
        let cosine = surface.normal.dot(direction);
        if cosine > 0.0 && !world.occluded(origin, direction) {
            sum += flux * (cosine * FRAC_1_PI);
        }
    }
    sum
}

/// The picture's direct light by a direction drawn from it, with its share in the balance heuristic.
fn from_image(world: &World, light: &Light, surface: &Receiver, origin: Vec3, rng: &mut Rng) -> Vec3 {
    let Some(sample) = light.image.sample([rng.next_f64(), rng.next_f64()]) else {
        return Vec3::ZERO;
    };
    let cosine = surface.normal.dot(sample.direction);
    if cosine <= 0.0 || world.occluded(origin, sample.direction) {
        return Vec3::ZERO;
    }
    // radiance * (cosine / pi) / pdf * pdf / (pdf + cosine pdf)
    let cosine_pdf = cosine * FRAC_1_PI;
    sample.radiance * (cosine_pdf / (sample.pdf + cosine_pdf))
}
