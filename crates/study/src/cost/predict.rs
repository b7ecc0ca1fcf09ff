//! How long a bake will take, from short bakes of the same scene.
//!
//! Three short bakes are measured: a few fixed rays, the coarsest error level, and a level four times that asked for.
//! The coarsest level stops every receiver at the same number of rays and says how large its error was there (median,
//! 95th percentile, worst). An error falls with the rays to the power of -3/4, so each receiver needs
//! `(error / E)^(4/3)` times the rays, rounded up to a doubling; the mean of that over receivers is scaled by what the
//! third bake needed against the same reckoning. Time is then rays times the seconds per ray, plus bounces times the
//! surfaces seen times the seconds that one costs. Bounces go on until a geometric series of the changes seen is
//! below a quarter of E.

use super::bakes::Timed;

/// The power by which an error falls with the number of rays, where visibility is sampled evenly.
const SLOPE: f64 = 0.75;
/// Rays at which a receiver is given up.
const MOST_RAYS: f64 = 16_384.0;
/// Ranks over which a quantile function is averaged.
const RANKS: usize = 400;
/// Surfaces that an error level looks up per receiver at most, in rays.
const MOST_BLOCKERS: f64 = 1024.0;

/// A short bake: what it needed.
#[derive(Debug, Clone, PartialEq)]
pub struct Pilot {
    /// Receivers, and those that something can shadow.
    pub receivers: [u64; 2],
    /// Any-hit and closest-hit rays.
    pub rays: [f64; 2],
    /// Wall-clock seconds, and those spent on tracing and on bounces.
    pub seconds: [f64; 3],
    /// Estimated error over all receivers: median, 95th percentile, worst. Zeros where the rays were fixed.
    pub errors: [f64; 3],
    /// Relative change of each bounce.
    pub changes: Vec<f32>,
    /// Coefficients.
    pub coefficients: f64,
}

impl Pilot {
    pub(super) fn of(timed: &Timed) -> Self {
        let (plan, achieved) = (&timed.prt.plan, &timed.prt.achieved);
        Self {
            receivers: [plan.receivers, plan.shadowed_receivers],
            rays: [achieved.visibility_rays as f64, achieved.bounce_rays as f64],
            seconds: [timed.seconds, timed.tracing, timed.bouncing],
            errors: achieved.error.map(f64::from),
            changes: achieved.bounce_changes.clone(),
            coefficients: f64::from(timed.prt.transfer.bands).powi(2),
        }
    }

    /// Rays per receiver that something can shadow.
    fn rays_per_receiver(&self) -> f64 {
        if self.receivers[1] > 0 { self.rays[0] / self.receivers[1] as f64 } else { 0.0 }
    }
}

/// What a bake will take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prediction {
    /// Wall-clock seconds.
    pub seconds: f64,
    /// Rays per receiver that something can shadow.
    pub rays_per_receiver: f64,
    /// Bounces.
    pub bounces: u32,
}

/// A prediction and what came.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    /// The bake.
    pub name: String,
    /// Before it started.
    pub predicted: Prediction,
    /// After; not known where the budget did not allow it.
    pub came: Option<Prediction>,
}

/// Predicts bakes of one scene.
#[derive(Debug, Clone)]
pub struct Predictor {
    fixed: Pilot,
    coarse: Pilot,
    fine: Pilot,
    /// Measured against reckoned rays of the third bake.
    scale: f64,
}

impl Predictor {
    /// From a bake with a few fixed rays, one of the coarsest error level, and one of the error level `fine_error`.
    #[must_use]
    pub fn new(fixed: Pilot, coarse: Pilot, fine: Pilot, fine_error: f64) -> Self {
        let mut predictor = Self { fixed, coarse, fine, scale: 1.0 };
        let (first, reckoned) = (predictor.coarse.rays_per_receiver(), predictor.level_rays(fine_error, 1.0));
        let measured = predictor.fine.rays_per_receiver();
        if reckoned > 1.02 * first && measured > 1.02 * first {
            predictor.scale = ((measured - first) / (reckoned - first)).clamp(0.25, 4.0);
        }
        predictor
    }

    /// Rays per shadowed receiver at an error level; errors are `noisier` times those of the short bakes.
    #[must_use]
    pub fn level_rays(&self, error: f64, noisier: f64) -> f64 {
        let first = self.coarse.rays_per_receiver();
        let needed = |rank: usize| {
            let more = (noisier * self.quantile(rank) / error).max(1.0).powf(1.0 / SLOPE);
            (first * more.log2().ceil().exp2()).min(MOST_RAYS.max(first))
        };
        let mean = (0..RANKS).map(needed).sum::<f64>() / RANKS as f64;
        (first + self.scale * (mean - first)).min(MOST_RAYS.max(first))
    }

    /// Error at the coarsest level of the shadowed receiver of a rank: straight lines between the known quantiles, in logarithms.
    fn quantile(&self, rank: usize) -> f64 {
        let [receivers, shadowed] = self.coarse.receivers.map(|n| n as f64);
        // The others have a closed form and the error 0: they stand first.
        let exact = 1.0 - shadowed / receivers.max(1.0);
        let at = exact + (1.0 - exact) * (rank as f64 + 0.5) / RANKS as f64;
        let [median, most, worst] = self.coarse.errors.map(|e| e.max(1e-9));
        // As far below the median as the 95th percentile is above it.
        let least = if exact < 0.5 { median * median / most } else { most * most / worst };
        let points = [[exact.min(0.49), least], [0.5, median.max(least)], [0.95, most], [1.0, worst]];
        let between = points.windows(2).find(|pair| at <= pair[1][0]).unwrap_or(&points[2..]);
        let ([x0, e0], [x1, e1]) = (between[0], between[1]);
        let share = ((at - x0) / (x1 - x0)).clamp(0.0, 1.0);
        (e0.ln() + share * (e1 / e0).ln()).exp()
    }

    /// The bounces until what is still to come is below a quarter of an error.
    #[must_use]
    pub fn level_bounces(&self, error: f64) -> u32 {
        let changes = &self.fine.changes;
        let (Some(&last), Some(&before)) = (changes.last(), changes.iter().rev().nth(1).or(changes.last())) else {
            return 0;
        };
        let ratio = if changes.len() > 1 { f64::from(last / before) } else { f64::from(last) };
        if !(ratio > 0.0 && ratio < 1.0) {
            return changes.len() as u32;
        }
        let to_come = |change: f64| change * ratio / (1.0 - ratio);
        let known = changes.iter().map(|&c| f64::from(c));
        let further = std::iter::successors(Some(f64::from(last) * ratio), |c| Some(c * ratio)).take(1000);
        known.chain(further).take_while(|&change| to_come(change) > error / 4.0).count() as u32 + 1
    }

    /// Predicts a bake to an error level with so many bands.
    #[must_use]
    pub fn level(&self, error: f64, bands: u32) -> Prediction {
        // Noise is about the same in every coefficient, so the error grows with the number of bands.
        let noisier = f64::from(bands) / self.coarse.coefficients.sqrt();
        let rays = self.level_rays(error, noisier);
        let seen = (rays / 2.0).min(MOST_BLOCKERS) * self.blocked();
        self.price(rays, seen, self.level_bounces(error), bands)
    }

    /// Predicts a bake with a fixed number of rays, bounces and bands.
    #[must_use]
    pub fn fixed(&self, rays: u32, bounces: u32, bands: u32) -> Prediction {
        let seen = if bounces > 0 { f64::from(rays) * self.blocked() } else { 0.0 };
        self.price(f64::from(rays), seen, bounces, bands)
    }

    /// Bytes that the surfaces seen take at a fixed number of rays, at most.
    pub(super) fn seen_bytes(&self, rays: u32) -> f64 {
        24.0 * f64::from(rays) * self.fixed.receivers[1] as f64
    }

    /// Share of rays that are blocked.
    fn blocked(&self) -> f64 {
        if self.fixed.rays[0] > 0.0 { self.fixed.rays[1] / self.fixed.rays[0] } else { 0.0 }
    }

    fn price(&self, rays: f64, seen: f64, bounces: u32, bands: u32) -> Prediction {
        let receivers = self.fixed.receivers[1] as f64;
        let bound = [&self.fixed, &self.coarse, &self.fine];
        let most = bound.into_iter().max_by(|a, b| a.rays[0].total_cmp(&b.rays[0])).unwrap_or(&self.fine);
        let setup = bound.iter().map(|p| p.seconds[0] - p.seconds[1] - p.seconds[2]).fold(f64::INFINITY, f64::min);
        let per_ray = ratio(most.seconds[1], most.rays[0] + most.rays[1]);
        let passes = most.changes.len() as f64;
        let per_surface = ratio(most.seconds[2], passes * most.rays[1]);
        let wider = f64::from(bands * bands) / most.coefficients;
        let seconds = setup.max(0.0)
            + receivers * (rays + seen) * per_ray
            + receivers * seen * f64::from(bounces) * per_surface * wider;
        Prediction { seconds, rays_per_receiver: rays, bounces }
    }
}

fn ratio(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bake whose time is 0.1 s, 1 us per ray of either kind and 10 ns per surface, bounce and coefficient.
    fn pilot(rays_per_receiver: f64, bounces: usize) -> Pilot {
        let (receivers, blocked) = (1000.0, 0.5);
        let rays = [receivers * rays_per_receiver, receivers * rays_per_receiver * blocked];
        let tracing = 1e-6 * (rays[0] + rays[1]);
        let bouncing = 1e-8 * rays[1] * bounces as f64 * 25.0;
        Pilot {
            receivers: [1000, 1000],
            rays,
            seconds: [0.1 + tracing + bouncing, tracing, bouncing],
            errors: [0.02; 3],
            changes: (1..=bounces as i32).map(|n| 0.5f32.powi(n)).collect(),
            coefficients: 25.0,
        }
    }

    fn predictor() -> Predictor {
        // Every receiver has the error 0.02 at 256 rays, so 0.02 / 0.04 needs no more.
        Predictor::new(pilot(64.0, 3), pilot(256.0, 3), pilot(256.0, 3), 0.04)
    }

    #[test]
    fn a_bake_of_fixed_rays_is_priced_by_its_parts() {
        let predicted = predictor().fixed(4096, 6, 10);
        let by_hand = 0.1 + 1000.0 * 4096.0 * (1.5e-6 + 0.5 * 6.0 * 1e-8 * 100.0);
        assert!((predicted.seconds / by_hand - 1.0).abs() < 1e-9, "{} against {by_hand}", predicted.seconds);
    }

    /// An error halves with 2^(4/3) times the rays, which a doubling rule rounds up to 4: 1,024.
    #[test]
    fn rays_follow_the_error_in_doublings() {
        let predictor = predictor();
        assert!((predictor.level_rays(0.01, 1.0) - 1024.0).abs() < 1e-6, "{}", predictor.level_rays(0.01, 1.0));
        assert!((predictor.level_rays(1e-4, 1.0) - MOST_RAYS).abs() < 1e-6);
        // Changes halve: 1/2 + 1/4 + ... ; what comes after bounce n is 2^-n, which is below 0.0025 from 9 on.
        assert_eq!(predictor.level_bounces(0.01), 9);
    }

    /// Without the rounding to doublings the count would be 645: the check sees the difference.
    #[test]
    fn rays_follow_the_error_in_doublings_can_fail() {
        let without = 256.0 * 2f64.powf(1.0 / SLOPE);
        assert!((predictor().level_rays(0.01, 1.0) - without).abs() > 300.0);
    }

    #[test]
    fn a_scene_without_shadows_costs_no_rays() {
        let open = Pilot { receivers: [1000, 0], rays: [0.0; 2], errors: [0.0; 3], changes: vec![], ..pilot(0.0, 0) };
        let predicted = Predictor::new(open.clone(), open.clone(), open, 0.04).level(0.01, 5);
        assert!(predicted.rays_per_receiver == 0.0 && predicted.bounces == 0, "{predicted:?}");
        assert!((predicted.seconds - 0.1).abs() < 1e-9, "{predicted:?}");
    }
}
