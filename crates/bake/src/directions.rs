//! Ready-made sets of directions with their spherical harmonics, shared by all receivers.
//!
//! A receiver picks a set and a turn about its normal by a hash of its index. Directions are in the local frame
//! (z along the normal); the local coefficients are rotated into the world once per receiver.

use crate::domain::Domain;
use crate::foresight::Surroundings;
use coeff_io::{Quality, Sampler, Settings};
use rayon::prelude::*;
use sampling::sequence::{self, Sequence};
use sampling::{rng, warp};
use sh_math::Bands;

/// Rays of the first step of a progressive set.
const FIRST_STEP: usize = 128;
/// Most rays of a progressive set.
const LAST_STEP: usize = 1 << 14;
/// Turns about the normal that a set may take.
const TURNS: u64 = 256;

/// One set of directions about +z.
#[derive(Debug)]
pub(crate) struct DirectionSet {
    pub(crate) xs: Vec<f32>,
    pub(crate) ys: Vec<f32>,
    pub(crate) zs: Vec<f32>,
    /// Relative weight of each direction: 1 where directions follow the cosine.
    pub(crate) weights: Vec<f32>,
    /// Step by step `[coefficient][direction of the step]`: basis function times weight. A step lies in one piece, since rows as far apart as
    /// a power of two share the lines of a cache.
    basis: Vec<f32>,
    /// Ends of the steps, in directions.
    pub(crate) steps: Vec<Step>,
    /// Which directions lie around those after the first step.
    pub(crate) surroundings: Surroundings,
}

/// The end of a step of a set, with the sums up to there over all directions.
#[derive(Debug)]
pub(crate) struct Step {
    /// Directions up to here.
    pub(crate) end: usize,
    /// Sum of the weights up to here.
    pub(crate) weight: f64,
    /// Number that sums are divided by; also counts samples below the horizon where the sequence has them.
    pub(crate) samples: f64,
    /// Per coefficient: sum of the basis up to here.
    pub(crate) full: Vec<f64>,
}

/// All sets of a bake.
#[derive(Debug)]
pub(crate) struct DirectionBank {
    sets: Vec<DirectionSet>,
    turns: Vec<[f32; 2]>,
    seed: u64,
    /// Over which directions is gathered, and what of it is judged.
    pub(crate) domain: Domain,
    /// Exact coefficients of an open receiver about +z.
    pub(crate) open: Vec<f64>,
    /// Euclidean norm of what is judged of `open`.
    pub(crate) open_norm: f64,
}

impl DirectionBank {
    /// For the transfer of diffuse receivers.
    pub(crate) fn new(bands: Bands, settings: &Settings) -> Self {
        Self::over(Domain::Cosine, bands, settings)
    }

    pub(crate) fn over(domain: Domain, bands: Bands, settings: &Settings) -> Self {
        let coefficients = bands.coefficients();
        let n_sets = if coefficients <= 64 { 16 } else { 4 };
        let open = domain.open(bands);
        let turns = (0..TURNS).map(|i| {
            let angle = std::f64::consts::TAU * i as f64 / TURNS as f64;
            [libm::cos(angle) as f32, libm::sin(angle) as f32]
        });
        Self {
            sets: (0..n_sets)
                .into_par_iter()
                .map(|k| DirectionSet::new(&domain, bands, settings, rng::hash(settings.seed, 0x5e7, k)))
                .collect(),
            turns: turns.collect(),
            seed: settings.seed,
            open_norm: domain.judged(&open).iter().map(|x| x * x).sum::<f64>().sqrt(),
            open,
            domain,
        }
    }

    /// Which part of the foreseen directions of a step a receiver tries.
    pub(crate) fn part(&self, receiver: u32, step: usize) -> u32 {
        (rng::hash(self.seed, 0xf07e, u64::from(receiver) << 8 | step as u64) >> 32) as u32
    }

    /// The set of a receiver, and the cosine and sine of its turn about the normal.
    pub(crate) fn pick(&self, receiver: u32) -> (&DirectionSet, [f32; 2]) {
        let key = self.key(receiver);
        (&self.sets[self.set(key)], self.turns[(key % TURNS) as usize])
    }

    /// Places of receivers in a list, those of one set together: a set that was read last is still near.
    pub(crate) fn by_set(&self, receivers: &[u32]) -> Vec<usize> {
        let mut places: Vec<usize> = (0..receivers.len()).collect();
        places.sort_by_cached_key(|&k| self.set(self.key(receivers[k])));
        places
    }

    fn key(&self, receiver: u32) -> u64 {
        rng::hash(self.seed, 0xd1c, u64::from(receiver))
    }

    fn set(&self, key: u64) -> usize {
        (key >> 32) as usize % self.sets.len()
    }
}

impl DirectionSet {
    fn new(domain: &Domain, bands: Bands, settings: &Settings, seed: u64) -> Self {
        let (count, ends) = steps(settings.quality);
        let mut set = Self {
            xs: Vec::new(),
            ys: Vec::new(),
            zs: Vec::new(),
            weights: Vec::new(),
            basis: Vec::new(),
            steps: Vec::new(),
            surroundings: Surroundings::default(),
        };
        set.fill(domain, settings.sampler, count, &ends, seed);
        if ends.len() > 1 {
            let [xs, ys] = domain.feet(&set.xs, &set.ys, &set.zs);
            set.surroundings = Surroundings::new(&xs, &ys, &ends);
        }
        let n = set.xs.len();
        for end in ends {
            // A set over the whole sphere has fewer directions than samples, and a single step.
            let end = if settings.sampler == Sampler::Stratified { n } else { end.min(n) };
            set.add_step(bands, end, if end == n { count } else { end });
        }
        set
    }

    /// Fills in directions; within a step, neighbours in the list point in similar directions, which makes rays cheap.
    fn fill(&mut self, domain: &Domain, sampler: Sampler, count: usize, ends: &[usize], seed: u64) {
        let kind = match sampler {
            Sampler::OwenSobol => Sequence::OwenSobol,
            Sampler::Fibonacci => Sequence::Fibonacci,
            Sampler::Stratified => Sequence::Stratified,
        };
        let mut points = Vec::new();
        sequence::fill(kind, count as u32, seed, &mut points);
        let mut start = 0;
        for &end in ends {
            points[start..end].sort_by_key(|&[x, y]| grid_curve(x, y));
            start = end;
        }
        for point in points {
            let (direction, weight) = match (domain, sampler) {
                (Domain::Cosine, Sampler::OwenSobol | Sampler::Fibonacci) => {
                    (warp::square_to_cosine_hemisphere(point), 1.0)
                }
                // [G] eq. (21): uniform over the sphere, so the cosine is a weight: 4 pi / N * z / pi.
                (Domain::Cosine, Sampler::Stratified) => {
                    let direction = warp::square_to_uniform_sphere(point);
                    (direction, 4.0 * direction.z)
                }
                (Domain::Hemisphere(_), _) => (warp::square_to_uniform_hemisphere(point), 1.0),
                (Domain::Sphere(_), _) => (warp::square_to_uniform_sphere(point), 1.0),
            };
            if direction.z > 0.0 || matches!(domain, Domain::Sphere(_)) {
                self.xs.push(direction.x);
                self.ys.push(direction.y);
                self.zs.push(direction.z);
                self.weights.push(weight);
            }
        }
    }

    /// Evaluates the basis of the directions after the last step, up to `end`.
    fn add_step(&mut self, bands: Bands, end: usize, samples: usize) {
        let (start, mut full) = match self.steps.last() {
            Some(last) => (last.end, last.full.clone()),
            None => (0, vec![0.0; bands.coefficients()]),
        };
        let (range, first) = (start..end, self.basis.len());
        self.basis.resize(bands.coefficients() * end, 0.0);
        let basis = &mut self.basis[first..];
        let [xs, ys, zs] = [&self.xs, &self.ys, &self.zs].map(|axis| &axis[range.clone()]);
        sh_math::evaluate_batch(bands, xs, ys, zs, basis);
        for (row, sum) in basis.chunks_exact_mut(range.len().max(1)).zip(&mut full) {
            for (value, weight) in row.iter_mut().zip(&self.weights[range.clone()]) {
                *value *= weight;
                *sum += f64::from(*value);
            }
        }
        let weight = self.weights[..end].iter().map(|&w| f64::from(w)).sum();
        self.steps.push(Step { end, weight, samples: samples as f64, full });
    }

    /// The directions of a step.
    pub(crate) fn range(&self, step: usize) -> std::ops::Range<usize> {
        let start = step.checked_sub(1).map_or(0, |before| self.steps[before].end);
        start..self.steps[step].end
    }

    /// Basis function times weight of the directions of a step, coefficient by coefficient.
    pub(crate) fn basis(&self, step: usize) -> impl Iterator<Item = &[f32]> {
        let (range, coefficients) = (self.range(step), self.steps[step].full.len());
        self.basis[coefficients * range.start..coefficients * range.end].chunks_exact(range.len().max(1))
    }
}

/// Position along a Morton curve over the unit square.
fn grid_curve(x: f32, y: f32) -> u32 {
    let spread = |v: f32| (0..12).fold(0u32, |key, bit| key | ((v * 4096.0) as u32 >> bit & 1) << (2 * bit));
    spread(x) | spread(y) << 1
}

/// Number of samples of a set and the ends of its steps.
fn steps(quality: Quality) -> (usize, Vec<usize>) {
    match quality {
        Quality::Rays(n) => (n as usize, vec![n as usize]),
        Quality::Error(_) => {
            let ends: Vec<usize> =
                std::iter::successors(Some(FIRST_STEP), |&n| Some(n * 2)).take_while(|&n| n <= LAST_STEP).collect();
            (LAST_STEP, ends)
        }
    }
}
