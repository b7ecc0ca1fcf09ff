//! One step of a path at a surface that mirrors besides its diffuse part.

use crate::mirror::Mirror;
use crate::path::{Gathered, Step, step};
use crate::world::Surface;
use crate::{Light, World};
use glam::Vec3;
use sampling::frame::Frame;
use sampling::rng::Rng;
use sampling::warp::square_to_cosine_concentric;
use std::f32::consts::FRAC_1_PI;

/// Least chance of either part to be drawn where both are there.
const LEAST_CHANCE: f32 = 0.1;

/// Which of two directions finds the light: one drawn by the light, one by the surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Rule {
    /// Each with its share in the balance heuristic.
    Both,
    /// The light's alone; for tests.
    #[cfg(test)]
    Light,
    /// The surface's alone; for tests. Lamps that are points stay dark.
    #[cfg(test)]
    Surface,
}

impl Rule {
    /// Share of the direction that the light drew, by its density and the surface's.
    fn of_light(self, light: f32, surface: f32) -> f32 {
        match self {
            Self::Both => light / (light + surface),
            #[cfg(test)]
            Self::Light => 1.0,
            #[cfg(test)]
            Self::Surface => 0.0,
        }
    }

    /// Share of the direction that the surface drew.
    fn of_surface(self, light: f32, surface: f32) -> f32 {
        match self {
            Self::Both => surface / (light + surface),
            #[cfg(test)]
            Self::Light => 0.0,
            #[cfg(test)]
            Self::Surface => 1.0,
        }
    }
}

/// Light of a surface that mirrors, and where the path goes on.
///
/// Picture and discs are found by a direction drawn from them and by one drawn from the mixture of the cosine and the
/// mirror, weighted by the balance heuristic of E. Veach 1997; the latter carries the path on where it hits something.
pub(crate) fn reflect(
    world: &World,
    light: &Light,
    surface: (&Surface, &Mirror),
    last: bool,
    rule: Rule,
    path: &mut Gathered,
    rng: &mut Rng,
) -> Option<Surface> {
    let both = Parts::new(surface);
    path.sum += path.throughput * (both.lamps(world, light, rule, rng) + both.image(world, light, rule, rng));

    let direction = both.sample(rng);
    let (reflected, pdf) = both.at(direction);
    if pdf <= 0.0 || reflected.max_element() <= 0.0 {
        return None;
    }
    path.throughput *= reflected / pdf;
    let (next, share) = step(world, both.surface.origin, direction, last, rng);
    path.throughput *= share;
    match next {
        Step::Blocked => None,
        Step::Surface(next) => Some(next),
        Step::Sky => {
            path.sum += path.throughput * sky(light, direction, pdf, rule);
            None
        }
    }
}

/// Radiance of picture and discs in a direction that a surface drew, each by its share.
fn sky(light: &Light, direction: Vec3, pdf: f32, rule: Rule) -> Vec3 {
    let (radiance, light_pdf) = light.image.look(direction);
    let mut sum = radiance * rule.of_surface(light_pdf, pdf);
    for lamp in &light.lamps {
        if let Some(density) = lamp.density().filter(|_| lamp.meets(direction)) {
            sum += lamp.flux * (density * rule.of_surface(density, pdf));
        }
    }
    sum
}

/// The diffuse part and the mirror of a point.
struct Parts<'a> {
    surface: &'a Surface,
    mirror: &'a Mirror,
    /// With which the mirror draws the direction.
    chance: f32,
}

impl<'a> Parts<'a> {
    fn new((surface, mirror): (&'a Surface, &'a Mirror)) -> Self {
        let [matte, shiny] = [surface.albedo, mirror.albedo].map(Vec3::max_element);
        let chance = if matte > 0.0 { (shiny / (matte + shiny)).clamp(LEAST_CHANCE, 1.0 - LEAST_CHANCE) } else { 1.0 };
        Self { surface, mirror, chance }
    }

    fn sample(&self, rng: &mut Rng) -> Vec3 {
        if rng.next_f32() < self.chance {
            return self.mirror.sample(rng);
        }
        let local = square_to_cosine_concentric(rng.next_square());
        Frame::from_normal(self.surface.normal).to_world(local).normalize()
    }

    /// BRDF times cosine, and the density of [`Self::sample`].
    fn at(&self, direction: Vec3) -> (Vec3, f32) {
        let (mirrored, pdf) = self.mirror.at(direction);
        let cosine = self.surface.normal.dot(direction).max(0.0) * FRAC_1_PI;
        let below = self.surface.is_below(direction);
        let matte = if below { 0.0 } else { cosine * self.mirror.transmitted(direction) };
        (self.surface.albedo * matte + mirrored, self.chance * pdf + (1.0 - self.chance) * cosine)
    }

    /// What a direction drawn with the density `pdf` shows of `radiance / pdf`, weighted; nothing where it is blocked.
    fn shown(&self, world: &World, direction: Vec3, per_density: Vec3, share: impl Fn(f32) -> f32) -> Vec3 {
        let (reflected, pdf) = self.at(direction);
        if reflected.max_element() <= 0.0 {
            return Vec3::ZERO;
        }
        per_density * reflected * share(pdf) * world.transmittance(self.surface.origin, direction)
    }

    fn lamps(&self, world: &World, light: &Light, rule: Rule, rng: &mut Rng) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for lamp in &light.lamps {
            let (direction, flux) = lamp.sample(rng.next_square());
            let share = |pdf| lamp.density().map_or(1.0, |density| rule.of_light(density, pdf));
            sum += self.shown(world, direction, flux, share);
        }
        sum
    }

    fn image(&self, world: &World, light: &Light, rule: Rule, rng: &mut Rng) -> Vec3 {
        let Some(sample) = light.image.sample([rng.next_f64(), rng.next_f64()]) else { return Vec3::ZERO };
        let share = |pdf| rule.of_light(sample.pdf, pdf);
        self.shown(world, sample.direction, sample.radiance / sample.pdf, share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::receiver::average;
    use crate::{Estimate, Gloss, Lobe, Mirroring};
    use glam::Vec4;
    use probe_io::{Environment, Lamp};
    use testkit::ttest::normal_p_value;

    /// Largest |z| between estimates of one value, over the channels.
    fn apart(a: &Estimate, b: &Estimate) -> f64 {
        let z = |c: usize| {
            let error = f64::from(a.std_error[c]).hypot(f64::from(b.std_error[c]));
            (f64::from(a.mean[c]) - f64::from(b.mean[c])).abs() / error
        };
        (0..3).map(z).fold(0.0, f64::max)
    }

    /// A picture with a bright spot, and a lamp 0.3 radians wide.
    fn spotted() -> Light {
        let mut environment = Environment::constant([0.5; 3]);
        let mut pixels = vec![[0.5, 0.4, 0.3]; 512];
        pixels[4 * 32 + 20] = [20.0, 10.0, 30.0];
        let direction = Vec3::new(-0.5, 0.8, 0.2).normalize();
        environment.lamps.push(Lamp { direction, half_angle: 0.3, irradiance: [1.0, 2.0, 0.5] });
        let mut light = Light::from_equirect(32, pixels).expect("a full picture");
        light.lamps = Light::new(&environment).lamps;
        light
    }

    /// The floor as seen along a direction, by one rule.
    fn seen(gloss: Gloss, metallic: f32, rule: Rule, samples: u32) -> Estimate {
        let mut scene = scene::builtin("plane").expect("a built-in scene");
        scene.materials.iter_mut().for_each(|material| {
            (material.metallic, material.roughness) = (metallic, 0.5);
            material.base_color = Vec4::new(0.8, 0.6, 0.4, 1.0);
        });
        let (world, light) = (World::new(&scene).with_gloss(gloss), spotted());
        let mut rng = Rng::new(17, rule as u64);
        let direction = Vec3::new(0.5, -0.7, 0.1).normalize();
        average(samples, || {
            let seen = world.seen(-direction, direction, &mut rng).expect("the floor").surface;
            let mirror = seen.mirror.expect("it shines");
            let mut path = Gathered { throughput: Vec3::ONE, sum: Vec3::ZERO };
            reflect(&world, &light, (&seen, &mirror), true, rule, &mut path, &mut rng);
            path.sum
        })
    }

    #[test]
    fn both_ways_to_the_light_agree() {
        let mut worst: f64 = 0.0;
        for mirroring in [Mirroring::Lobe(Lobe::Phong), Mirroring::Lobe(Lobe::Ggx), Mirroring::Microfacet] {
            for (metallic, roughness) in [(0.0, 0.3), (0.7, 0.5), (1.0, 1.0)] {
                let gloss = Gloss { roughness: Some(roughness), ..Gloss::new(mirroring) };
                let [both, light, surface] =
                    [Rule::Both, Rule::Light, Rule::Surface].map(|rule| seen(gloss, metallic, rule, 100_000));
                worst = worst.max(apart(&both, &light)).max(apart(&both, &surface)).max(apart(&light, &surface));
                let other = seen(Gloss { roughness: Some(roughness * 0.9), ..gloss }, metallic, Rule::Both, 100_000);
                assert!(metallic == 0.0 || apart(&both, &other) > 5.0, "another roughness must show: {mirroring:?}");
            }
        }
        // 27 pairs in three channels: one chance in a hundred that right results are refused.
        assert!(normal_p_value(worst) > 0.01 / 81.0, "{worst} standard errors apart");
    }
}
