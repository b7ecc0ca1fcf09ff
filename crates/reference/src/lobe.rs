//! Lobes about the mirror direction: their density, directions drawn from them, their share above a plane.

use crate::gloss::Lobe;
use glam::Vec3;
use rayon::prelude::*;
use sampling::frame::Frame;
use sampling::rng::Rng;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::LazyLock;

/// Least `alpha`: sharper lobes are drawn as this one, a fifth of the sun's disc wide.
pub(crate) const LEAST_ALPHA: f32 = 1e-3;
/// Rows by roughness and columns by height of [`Shares`].
const ROWS: usize = 65;
const COLUMNS: usize = 129;
/// Directions in the sum of one entry.
const POINTS: usize = 1024;

/// `alpha` of a perceptual roughness.
pub(crate) fn alpha_of(roughness: f32) -> f32 {
    (roughness * roughness).clamp(LEAST_ALPHA, 1.0)
}

/// A lobe of one width, with the integral 1 over the sphere.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Width {
    lobe: Lobe,
    alpha: f64,
}

impl Width {
    pub(crate) fn new(lobe: Lobe, alpha: f32) -> Self {
        Self { lobe, alpha: f64::from(alpha) }
    }

    /// Density per solid angle at `x = sin^2(t / 2)`, t from the axis.
    fn at(&self, x: f64) -> f64 {
        let cosine = 1.0 - 2.0 * x;
        if cosine <= 0.0 {
            return 0.0;
        }
        match self.lobe {
            Lobe::Phong => {
                let s = self.exponent();
                (s + 1.0) / TAU * libm::exp(s * libm::log1p(-2.0 * x))
            }
            Lobe::Ggx => {
                let a = self.alpha * self.alpha;
                // D(t/2) is in proportion to 1 / base^2; dw = 4 pi dx.
                let base = a + (1.0 - a) * x;
                cosine / (base * base * 4.0 * PI * ggx_integral(a))
            }
        }
    }

    /// Density per solid angle of `direction` about `axis`, both unit. The chord keeps what a cosine near 1 rounds off.
    pub(crate) fn density(&self, axis: Vec3, direction: Vec3) -> f32 {
        self.at(0.25 * f64::from((direction - axis).length_squared())) as f32
    }

    /// A direction in proportion to the density.
    pub(crate) fn sample(&self, axis: Vec3, rng: &mut Rng) -> Vec3 {
        let x = loop {
            let (x, keep) = self.place(rng.next_f64());
            if keep >= 1.0 || rng.next_f64() < keep {
                break x;
            }
        };
        let (sin, cos) = libm::sincos(TAU * rng.next_f64());
        let radius = 2.0 * (x * (1.0 - x)).sqrt();
        let local = glam::DVec3::new(radius * cos, radius * sin, 1.0 - 2.0 * x).as_vec3();
        Frame::from_normal(axis).to_world(local).normalize()
    }

    /// `x` by a uniform number, and the share of such draws that is kept.
    fn place(&self, u: f64) -> (f64, f64) {
        match self.lobe {
            // 1 - u^(1 / (s + 1)), halved
            Lobe::Phong => (-0.5 * libm::expm1(libm::log(1.0 - u) / (self.exponent() + 1.0)), 1.0),
            Lobe::Ggx => {
                // dx / (a + b x)^2 is uniform in y = x / (a + b x); the cosine is left to rejection.
                let a = self.alpha * self.alpha;
                let y = u * 0.5 / (a + 0.5 * (1.0 - a));
                let x = (a * y / (1.0 - (1.0 - a) * y)).min(0.5);
                (x, 1.0 - 2.0 * x)
            }
        }
    }

    fn exponent(&self) -> f64 {
        0.5 * (1.0 / (self.alpha * self.alpha) - 1.0)
    }

    /// Share of the lobe above a plane over which its axis stands `height` radians.
    fn share(&self, height: f64) -> f64 {
        let slope = libm::tan(height);
        let (mut sum, mut one) = (0.0, 0.0);
        for k in 0..POINTS {
            let (x, weight) = self.place((k as f64 + 0.5) / POINTS as f64);
            let tangent = 2.0 * (x * (1.0 - x)).sqrt() / (1.0 - 2.0 * x).max(1e-12);
            // Of the circle at t those points are above whose longitude has a cosine of at least -tan(height) / tan(t).
            sum += weight * libm::acos((-slope / tangent.max(1e-12)).max(-1.0)) / PI;
            one += weight;
        }
        sum / one
    }

    /// [`Self::share`] from a table; `cosine` is that of axis and normal, below 0 it counts as 0.
    pub(crate) fn share_above(&self, cosine: f32) -> f32 {
        let table = match self.lobe {
            Lobe::Phong => &*PHONG,
            Lobe::Ggx => &*GGX,
        };
        table.read(self.alpha as f32, libm::asinf(cosine.clamp(0.0, 1.0)))
    }
}

/// `int_0^(1/2) (1 - 2 x) / (a + (1 - a) x)^2 dx`.
fn ggx_integral(a: f64) -> f64 {
    let b = 1.0 - a;
    if b < 1e-3 {
        // To the first power of b: the closed form loses all digits there.
        return 0.25 + b * 5.0 / 12.0;
    }
    ((1.0 + a) / a - 2.0 - 2.0 * libm::log((1.0 + a) / (2.0 * a))) / (b * b)
}

/// [`Width::share`] of one lobe by roughness and by `height / (height + alpha)`, in which narrow lobes are all alike.
struct Shares(Vec<f32>);

static PHONG: LazyLock<Shares> = LazyLock::new(|| Shares::of(Lobe::Phong));
static GGX: LazyLock<Shares> = LazyLock::new(|| Shares::of(Lobe::Ggx));

impl Shares {
    fn of(lobe: Lobe) -> Self {
        let entry = |i: usize| {
            let alpha = alpha_of((i / COLUMNS) as f32 / (ROWS - 1) as f32);
            let place = (i % COLUMNS) as f64 / (COLUMNS - 1) as f64 * most(alpha);
            let height = f64::from(alpha) * place / (1.0 - place);
            Width::new(lobe, alpha).share(height.min(FRAC_PI_2 - 1e-9)) as f32
        };
        Self((0..ROWS * COLUMNS).into_par_iter().map(entry).collect())
    }

    fn read(&self, alpha: f32, height: f32) -> f32 {
        let place = f64::from(height / (height + alpha)) / most(alpha);
        let (row, down) = cell(f64::from(alpha.sqrt()), ROWS);
        let (column, along) = cell(place, COLUMNS);
        let at = |row: usize, column: usize| self.0[row * COLUMNS + column];
        let line = |row: usize| at(row, column) + along * (at(row, column + 1) - at(row, column));
        line(row) + down * (line(row + 1) - line(row))
    }
}

/// The place of an axis that stands upright.
fn most(alpha: f32) -> f64 {
    FRAC_PI_2 / (FRAC_PI_2 + f64::from(alpha))
}

/// The entry of `count` below a place in [0, 1], and the share of the next.
pub(crate) fn cell(place: f64, count: usize) -> (usize, f32) {
    let place = place.clamp(0.0, 1.0) * (count - 1) as f64;
    let low = (place as usize).min(count - 2);
    (low, (place - low as f64) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean over `n` directions of what `value` says.
    fn mean(width: Width, axis: Vec3, n: u32, value: impl Fn(Vec3) -> f64) -> (f64, f64) {
        let mut rng = Rng::new(4, 2);
        let (mut sum, mut squares) = (0.0, 0.0);
        for _ in 0..n {
            let v = value(width.sample(axis, &mut rng));
            sum += v;
            squares += v * v;
        }
        let mean = sum / f64::from(n);
        (mean, ((squares / f64::from(n) - mean * mean) / f64::from(n)).sqrt())
    }

    /// Over the definition of the lobes, by the midpoint rule in the angle.
    #[test]
    fn lobes_have_the_integral_one_and_their_shape() {
        for lobe in [Lobe::Phong, Lobe::Ggx] {
            for roughness in [0.15f32, 0.4, 0.8, 0.9999, 1.0] {
                let width = Width::new(lobe, alpha_of(roughness));
                let integral = |power: i32| -> f64 {
                    let steps = 400_000;
                    let term = |k: i32| {
                        let t = FRAC_PI_2 * (f64::from(k) + 0.5) / f64::from(steps);
                        width.at((0.5 * t).sin().powi(2)) * t.cos().powi(power) * t.sin()
                    };
                    TAU * FRAC_PI_2 / f64::from(steps) * (0..steps).map(term).sum::<f64>()
                };
                testkit::assert_close!(integral(0), 1.0, 1e-5, 0.0, "{lobe:?} {roughness}");
                let axis = Vec3::new(0.6, 0.0, 0.8);
                let (drawn, error) = mean(width, axis, 100_000, |d| f64::from(axis.dot(d)).powi(3));
                testkit::ttest::z_test(drawn, error, integral(3), 0.01, 10).expect("directions follow the density");
                assert!(testkit::ttest::z_test(drawn, error, integral(2), 0.01, 10).is_err(), "can fail");
            }
        }
    }

    /// A hemisphere of radiance 1, cut off by a plane: the table against counting, and against the lobe that is a hemisphere.
    #[test]
    fn shares_are_what_is_above() {
        for lobe in [Lobe::Phong, Lobe::Ggx] {
            for roughness in [0.1f32, 0.3, 0.55, 0.97] {
                let width = Width::new(lobe, alpha_of(roughness));
                for height in [0.01f32, 0.1, 0.5, 1.4] {
                    let axis = Vec3::new(height.cos(), 0.0, height.sin());
                    let (share, error) = mean(width, axis, 100_000, |d| f64::from(u8::from(d.z > 0.0)));
                    let read = f64::from(width.share_above(axis.z));
                    assert!((read - width.share(f64::from(height))).abs() < 2e-4, "{lobe:?} {roughness} {height}");
                    if error > 1e-4 {
                        testkit::ttest::z_test(share, error, read, 0.01, 32).expect("share");
                    }
                    assert!((width.share_above(0.0) - 0.5).abs() < 1e-5, "half of it on the horizon");
                }
            }
        }
        // Two hemispheres at the angle pi/2 - height share (pi/2 + height) / pi.
        let flat = Width::new(Lobe::Phong, 1.0);
        testkit::assert_close!(flat.share_above(0.5), 2.0 / 3.0, 1e-4, 0.0);
    }
}
