//! Light of vertices upon a normal that a normal map bends: docs/shading.md, "Bent light of vertices".

use glam::Vec3;
use sh_math::LUMINANCE;

/// What keeps the answer of a lamp that grazes the surface finite.
const GRAZING: f32 = 0.05;
/// Cosine of a lamp above which it is believed: lower ones are more and more light that bounced, and comes from elsewhere.
const BELIEVED: f32 = 0.25;

/// The light of a surface with the unit normal `plain` on the unit normal `bent`: `light` is what the vertices take, `heading` its luminance
/// times the direction that it comes from.
///
/// The light is taken as the sum of a sky that is the same everywhere and a lamp: the only such pair with this sum and this heading. Both
/// have closed forms for any normal. With `bent = plain` the light stays as it is.
pub(crate) fn bent_light(light: Vec3, heading: Vec3, plain: Vec3, bent: Vec3) -> Vec3 {
    let whole = light.dot(Vec3::from(LUMINANCE));
    if whole <= 0.0 {
        return light;
    }
    let mean = heading / whole;
    let spread = spread(mean, plain);
    let lamp = mean - plain * (2.0 / 3.0 * spread);
    let length = lamp.length();
    let towards = if length > 1e-6 { lamp / length } else { plain };
    let share = (1.0 - spread) * (towards.dot(plain) / BELIEVED).clamp(0.0, 1.0);
    let of_lamp = (towards.dot(bent).max(0.0) + GRAZING) / (towards.dot(plain).max(0.0) + GRAZING);
    let of_sky = 0.5 * (1.0 + plain.dot(bent));
    light * ((1.0 - share) * of_sky + share * of_lamp)
}

/// The share `s` of the sky: with `2/3 s plain` taken off, what is left of the mean direction is as long as what is left of the light,
/// `|mean - 2/3 s plain| = 1 - s`.
fn spread(mean: Vec3, plain: Vec3) -> f32 {
    // What rings may be longer than it can be.
    let c = (1.0 - mean.length_squared()).max(0.0);
    let b = 2.0 - 4.0 / 3.0 * mean.dot(plain).clamp(-1.0, 1.0);
    (2.0 * c / (b + (b * b - 20.0 / 9.0 * c).max(0.0).sqrt())).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::bent_light;
    use glam::Vec3;
    use std::f32::consts::PI;

    /// Sum over directions of a light and of its heading on one normal, and the exact light on another.
    fn exact(radiance: impl Fn(Vec3) -> f32, plain: Vec3, bent: Vec3) -> (Vec3, Vec3, f32) {
        let (count, golden) = (200_000, PI * (3.0 - 5f32.sqrt()));
        let (mut sum, mut heading, mut on_bent) = (0.0f64, glam::DVec3::ZERO, 0.0f64);
        for i in 0..count {
            let z = 1.0 - (2.0 * i as f32 + 1.0) / count as f32;
            let (sin, cos) = (f64::from(golden) * f64::from(i)).sin_cos();
            let radius = (1.0 - z * z).sqrt();
            let w = Vec3::new(radius * cos as f32, z, radius * sin as f32);
            // Nothing comes from below the surface.
            if w.dot(plain) > 0.0 {
                let weight = f64::from(radiance(w)) * 4.0 / f64::from(count);
                let take = weight * f64::from(w.dot(plain));
                sum += take;
                heading += take * w.as_dvec3();
                on_bent += weight * f64::from(w.dot(bent).max(0.0));
            }
        }
        (Vec3::splat(sum as f32), heading.as_vec3(), on_bent as f32)
    }

    fn tilted(degrees: f32, about: f32) -> Vec3 {
        let (s, c) = degrees.to_radians().sin_cos();
        Vec3::new(s * about.cos(), c, s * about.sin())
    }

    /// A grey sky has the closed form `(1 + cos) / 2`; a lamp, and both together, the cosines.
    #[test]
    fn skies_and_lamps_are_exact() {
        let lamp = tilted(35.0, 1.0);
        let near = |w: Vec3| w.dot(lamp) > 0.9995;
        for tilt in [10.0, 30.0] {
            let bent = tilted(tilt, 2.5);
            let (light, heading, truth) = exact(|_| 1.0, Vec3::Y, bent);
            let found = bent_light(light, heading, Vec3::Y, bent).x;
            assert!((found / truth - 1.0).abs() < 3e-3, "sky, {tilt}: {found} for {truth}");
            let (light, heading, truth) = exact(|w| if near(w) { 4000.0 } else { 1.0 }, Vec3::Y, bent);
            let found = bent_light(light, heading, Vec3::Y, bent).x;
            assert!((found / truth - 1.0).abs() < 0.02, "sky and lamp, {tilt}: {found} for {truth}");
            assert!(tilt < 20.0 || (light.x / truth - 1.0).abs() > 0.05, "can fail: the plain normal is off");
        }
        let (light, heading, _) = exact(|w| 1.0 + w.y, Vec3::Y, Vec3::Y);
        assert!((bent_light(light, heading, Vec3::Y, Vec3::Y) - light).length() < 1e-5, "unbent");
    }

    /// What comes from below the surface has bounced: it counts as a grey sky, whatever it seems to come from.
    #[test]
    fn light_from_behind_is_spread() {
        for heading in [Vec3::new(0.3, -0.8, 0.1), Vec3::NEG_Y, Vec3::X] {
            let bent = tilted(40.0, 0.5);
            let found = bent_light(Vec3::ONE, heading, Vec3::Y, bent).x;
            assert!((found - 0.5 * (1.0 + bent.y)).abs() < 0.02, "{heading}: {found}");
        }
        let lamp = bent_light(Vec3::ONE, tilted(40.0, 0.5), Vec3::Y, tilted(40.0, 0.5)).x;
        assert!(lamp > 1.2, "can fail: a lamp above is one");
    }

    /// Half a sky, and one that is bright above: no such pair, and still nearer than the plain normal.
    #[test]
    fn other_lights_are_nearer_than_the_plain_normal() {
        let skies: [fn(Vec3) -> f32; 3] =
            [|w| if w.x > 0.0 { 1.0 } else { 0.0 }, |w| 0.2 + w.y.powi(4), |w| if w.x > 0.5 { 3.0 } else { 0.3 }];
        for (k, sky) in skies.into_iter().enumerate() {
            let (mut own, mut plain) = (0.0f32, 0.0f32);
            for (tilt, about) in [(15.0, 0.0), (15.0, 2.0), (30.0, 1.0), (30.0, 3.1), (45.0, 0.3)] {
                let bent = tilted(tilt, about);
                let (light, heading, truth) = exact(sky, Vec3::Y, bent);
                own += (bent_light(light, heading, Vec3::Y, bent).x / truth - 1.0).abs();
                plain += (light.x / truth - 1.0).abs();
            }
            assert!(own < 0.5 * plain, "sky {k}: {own} against {plain} without the normal map");
        }
    }
}
