//! One path: the light that leaves a surface, estimated once without bias.

use crate::shiny::{Rule, reflect};
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

/// What a path has gathered so far.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Gathered {
    /// Radiance at the start of the path per radiance that leaves the present surface; its albedo is in it where it is matte.
    pub(crate) throughput: Vec3,
    /// Radiance.
    pub(crate) sum: Vec3,
}

/// Radiance that leaves `surface`, after up to `max_bounces` reflections on other surfaces.
///
/// Each surface on the path adds the light that reaches it straight: from lamps by a direction to each, from the
/// picture by two directions, one drawn by radiance and one by the cosine, weighted by the balance heuristic. The
/// second one carries the path on where it hits something. What mirrors has another way, [`reflect`].
pub(crate) fn outgoing(world: &World, light: &Light, start: Surface, max_bounces: Option<u32>, rng: &mut Rng) -> Vec3 {
    let mut surface = start;
    let mut path = Gathered { throughput: own_albedo(&start), sum: Vec3::ZERO };
    let mut bounce = 0;
    while path.throughput.max_element() > 0.0 {
        let last = max_bounces == Some(bounce);
        let next = match &surface.mirror {
            None => scatter(world, light, &surface, last, &mut path, rng),
            Some(mirror) => reflect(world, light, (&surface, mirror), last, Rule::Both, &mut path, rng),
        };
        let Some(next) = next else { break };
        surface = next;
        path.throughput *= own_albedo(&surface);
        bounce += 1;
        if max_bounces.is_none() && bounce > SURE_BOUNCES {
            let survival = path.throughput.max_element().min(MAX_SURVIVAL);
            if rng.next_f32() >= survival {
                break;
            }
            path.throughput /= survival;
        }
    }
    path.sum
}

/// The factor of a matte surface for light from anywhere.
fn own_albedo(surface: &Surface) -> Vec3 {
    if surface.mirror.is_some() { Vec3::ONE } else { surface.albedo }
}

/// Light of a matte surface, and where the path goes on.
fn scatter(
    world: &World,
    light: &Light,
    surface: &Surface,
    last: bool,
    path: &mut Gathered,
    rng: &mut Rng,
) -> Option<Surface> {
    path.sum += path.throughput * (from_lamps(world, light, surface, rng) + from_image(world, light, surface, rng));

    let local = square_to_cosine_concentric(rng.next_square());
    let direction = Frame::from_normal(surface.normal).to_world(local).normalize();
    if surface.is_below(direction) {
        return None;
    }
    let (next, share) = step(world, surface.origin, direction, last, rng);
    path.throughput *= share;
    match next {
        Step::Blocked => None,
        Step::Sky => {
            let (radiance, light_pdf) = light.image.look(direction);
            let pdf = cosine_concentric_pdf(local);
            // Along the horizon both densities may be 0.
            if pdf > 0.0 {
                path.sum += path.throughput * radiance * (pdf / (pdf + light_pdf));
            }
            None
        }
        Step::Surface(next) => Some(next),
    }
}

/// Where a path goes next.
pub(crate) enum Step {
    /// On to another surface.
    Surface(Surface),
    /// Out, to the picture.
    Sky,
    /// To a surface that no longer counts.
    Blocked,
}

/// Follows a ray of light back: where it leads, and the share of the light from there that veils on the way pass. The step after the last
/// bounce needs only to know how much leaves the scene.
pub(crate) fn step(world: &World, origin: Vec3, direction: Vec3, last: bool, rng: &mut Rng) -> (Step, Vec3) {
    if !last {
        let (surface, share) = world.closest(origin, direction, rng);
        return (surface.map_or(Step::Sky, Step::Surface), share);
    }
    let share = world.transmittance(origin, direction);
    (if share == Vec3::ZERO { Step::Blocked } else { Step::Sky }, share)
}

/// Direct light of all lamps that an albedo of 1 would reflect.
fn from_lamps(world: &World, light: &Light, surface: &Surface, rng: &mut Rng) -> Vec3 {
    let mut sum = Vec3::ZERO;
    for lamp in &light.lamps {
        let (direction, flux) = lamp.sample(rng.next_square());
        let cosine = surface.normal.dot(direction);
        if cosine > 0.0 && !surface.is_below(direction) {
            sum += flux * (cosine * FRAC_1_PI) * world.transmittance(surface.origin, direction);
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
    if cosine <= 0.0 || surface.is_below(sample.direction) {
        return Vec3::ZERO;
    }
    let share = world.transmittance(surface.origin, sample.direction);
    // radiance * (cosine / pi) / pdf * pdf / (pdf + cosine pdf)
    let cosine_pdf = cosine * FRAC_1_PI;
    sample.radiance * (cosine_pdf / (sample.pdf + cosine_pdf)) * share
}
