//! One path: the light that leaves a diffuse surface, estimated once without bias.

use crate::world::Surface;
use crate::{Light, World};
use glam::Vec3;
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
pub(crate) fn outgoing(world: &World, light: &Light, start: Surface, max_bounces: Option<u32>, rng: &mut Rng) -> Vec3 {
    let mut surface = start;
    let mut throughput = start.albedo;
    let mut sum = Vec3::ZERO;
    let mut bounce = 0;
    while throughput.max_element() > 0.0 {
        sum += throughput * (from_lamps(world, light, &surface, rng) + from_image(world, light, &surface, rng));

        let local = square_to_cosine_concentric(rng.next_square());
        let direction = Frame::from_normal(surface.normal).to_world(local).normalize();
        if surface.is_below(direction) {
            break;
        }
        let step = if max_bounces == Some(bounce) {
            last_step(world, surface.origin, direction)
        } else {
            world.closest(surface.origin, direction).map_or(Step::Sky, Step::Surface)
        };
        match step {
            Step::Blocked => break,
            Step::Sky => {
                let (radiance, light_pdf) = light.image.look(direction);
                let pdf = cosine_concentric_pdf(local);
                sum += throughput * radiance * (pdf / (pdf + light_pdf));
                break;
            }
            Step::Surface(next) => surface = next,
        }
        throughput *= surface.albedo;
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

/// Where a path goes next.
enum Step {
    /// On to another surface.
    Surface(Surface),
    /// Out, to the picture.
    Sky,
    /// To a surface that no longer counts.
    Blocked,
}

/// The step after the last bounce needs only to know whether it leaves the scene.
fn last_step(world: &World, origin: Vec3, direction: Vec3) -> Step {
    if world.occluded(origin, direction) { Step::Blocked } else { Step::Sky }
}

/// Direct light of all lamps that an albedo of 1 would reflect.
fn from_lamps(world: &World, light: &Light, surface: &Surface, rng: &mut Rng) -> Vec3 {
    let mut sum = Vec3::ZERO;
    for lamp in &light.lamps {
        let (direction, flux) = lamp.sample(rng.next_square());
        let cosine = surface.normal.dot(direction);
        if cosine > 0.0 && !surface.is_below(direction) && !world.occluded(surface.origin, direction) {
            sum += flux * (cosine * FRAC_1_PI);
        }
    }
    sum
}

/// The picture's direct light by a direction drawn from it, with its share in the balance heuristic.
fn from_image(world: &World, light: &Light, surface: &Surface, rng: &mut Rng) -> Vec3 {
    let Some(sample) = light.image.sample([rng.next_f64(), rng.next_f64()]) else {
        return Vec3::ZERO;
    };
    let cosine = surface.normal.dot(sample.direction);
    if cosine <= 0.0 || surface.is_below(sample.direction) || world.occluded(surface.origin, sample.direction) {
        return Vec3::ZERO;
    }
    // radiance * (cosine / pi) / pdf * pdf / (pdf + cosine pdf)
    let cosine_pdf = cosine * FRAC_1_PI;
    sample.radiance * (cosine_pdf / (sample.pdf + cosine_pdf))
}
