//! The radiance that arrives at a point from all its directions: what normals that are known only later are lit by.
//!
//! It is kept as spherical harmonics over directions, for every coefficient of the light: `c_ki = integral of V Y_k Y_i` over the open
//! directions, by triple products of the coefficients of visibility, plus what every surface that blocks sends on (\[N\] eqs. 2.1, 2.2).

use crate::directions::DirectionBank;
use crate::domain::Domain;
use crate::field::Field;
use crate::found::{Found, add_sent};
use crate::gather::{Gatherer, Worker};
use crate::mirror::{MOST_BANDS, Mirrors};
use crate::receivers::{Receiver, Receivers};
use crate::senders::shares;
use crate::world::World;
use coeff_io::Quality;
use glam::Vec3;
use rayon::prelude::*;
use raytrace::Hit;
use sh_math::product::{Triple, triples};
use sh_math::{Bands, zonal};

/// What surfaces send on, for albedo 1.
pub(crate) enum Sent<'a> {
    /// The answer to every coefficient of the light.
    Transfer(&'a Field),
    /// The radiance under one light, RGB, per receiver.
    Radiance(Vec<[f32; 3]>),
}

impl<'a> Sent<'a> {
    /// The radiance of every receiver under a light.
    pub(crate) fn under(transfer: &Field, receivers: usize, light: &[[f32; 3]]) -> Self {
        Self::Radiance(radiance(transfer, receivers, light))
    }
}

/// The radiance of every receiver for albedo 1 under a light, RGB.
pub(crate) fn radiance(transfer: &Field, receivers: usize, light: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let one = |r: u32| {
        std::array::from_fn(|c| {
            let row = transfer.channel(r, c.min(transfer.channels - 1));
            row.iter().zip(light).map(|(t, l)| t * l[c]).sum()
        })
    };
    (0..receivers as u32).into_par_iter().map(one).collect()
}

/// Surfaces that shine, and the direct light that tells what other surfaces send them.
#[derive(Clone, Copy)]
pub(crate) struct Shine<'a> {
    pub(crate) mirrors: &'a Mirrors,
    /// Direct transfer of every receiver.
    pub(crate) direct: &'a Field,
}

/// How open directions become coefficients.
enum Direct {
    /// For every coefficient of the light.
    Terms(Vec<Triple>),
    /// Under one light: `[function][coefficient of visibility]`, RGB.
    Lit(Vec<[f32; 3]>),
}

/// Finds what arrives at points.
pub(crate) struct Arrivals<'a> {
    gatherer: Gatherer<'a>,
    receivers: &'a Receivers,
    sent: Sent<'a>,
    direct: Direct,
    functions: Bands,
    shape: Shape,
    shine: Option<Shine<'a>>,
    light: Option<&'a [[f32; 3]]>,
    /// Whether visibility and what surfaces send are told apart.
    pub(crate) apart: bool,
}

/// Shape of what arrives: `[function][depth][channel]`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shape {
    pub(crate) functions: usize,
    /// Coefficients of the light, or 1 where it is in the numbers.
    pub(crate) depth: usize,
    pub(crate) channels: usize,
}

impl Shape {
    pub(crate) fn len(self) -> usize {
        self.functions * self.depth * self.channels
    }
}

/// What arrives at one point.
pub(crate) struct Arrival {
    /// Radiance in world axes, by [`Shape`].
    pub(crate) values: Vec<f32>,
    /// Share of the directions that is open.
    pub(crate) openness: f32,
    /// Share of the others that meets the inside of a body.
    pub(crate) inside_share: f32,
    /// Share of the others that meets the back of a surface with one side.
    pub(crate) behind_share: f32,
    /// Height of what covers the point; infinite where nothing does.
    pub(crate) cover: f32,
    /// Estimated error of the irradiance in 3 bands, against that of an open point.
    pub(crate) error: f32,
    /// Any-hit rays traced.
    pub(crate) visibility_rays: u64,
    /// Closest-hit rays traced.
    pub(crate) bounce_rays: u64,
    /// Coefficients of visibility over the sphere, and what surfaces send alone, where they are told apart; else empty.
    pub(crate) visibility: Vec<f32>,
    pub(crate) bounced: Vec<f32>,
    /// The surfaces that block, where they are told apart.
    pub(crate) found: Found,
}

/// What is needed beside the bank.
pub(crate) struct Setting<'a> {
    pub(crate) world: &'a World<'a>,
    pub(crate) receivers: &'a Receivers,
    pub(crate) sent: Sent<'a>,
    pub(crate) quality: Quality,
    /// Whether rays decide what is seen.
    pub(crate) visibility: bool,
    /// Whether what blocks sends light on.
    pub(crate) hits: bool,
    /// Coefficients of the one light, RGB; none for transfer.
    pub(crate) light: Option<&'a [[f32; 3]]>,
    /// Bands of the light.
    pub(crate) light_bands: Bands,
    /// Bands over directions.
    pub(crate) functions: Bands,
    /// Surfaces that shine, where what they mirror counts.
    pub(crate) shine: Option<Shine<'a>>,
}

impl Setting<'_> {
    /// Bands of visibility that its product with a light and with a function needs.
    pub(crate) fn visibility_bands(light: Bands, functions: Bands) -> Bands {
        let count = light.count() + functions.count() - 1;
        Bands::new(count as u32).expect("settings keep bands far below the most")
    }
}

impl<'a> Arrivals<'a> {
    /// The bank is to hold [`Setting::visibility_bands`].
    pub(crate) fn new(bank: &'a DirectionBank, setting: Setting<'a>) -> Self {
        let bands = Setting::visibility_bands(setting.light_bands, setting.functions);
        let terms = triples(setting.functions, setting.light_bands, bands);
        let (depth, channels) = match &setting.sent {
            Sent::Transfer(field) => (setting.light_bands.coefficients(), field.channels),
            Sent::Radiance(_) => (1, 3),
        };
        let direct = match setting.light {
            None => Direct::Terms(terms),
            Some(light) => Direct::Lit(lit(&terms, light, setting.functions, bands)),
        };
        let gatherer = Gatherer {
            world: setting.world,
            bank,
            bands,
            quality: setting.quality,
            visibility: setting.visibility,
            hits: setting.hits,
            permanent: u32::MAX,
            worth: f32::INFINITY,
            mirrors: None,
        };
        let shape = Shape { functions: setting.functions.coefficients(), depth, channels };
        Self {
            gatherer,
            receivers: setting.receivers,
            sent: setting.sent,
            direct,
            functions: setting.functions,
            shape,
            shine: setting.shine,
            light: setting.light,
            apart: false,
        }
    }

    pub(crate) fn shape(&self) -> Shape {
        self.shape
    }

    /// What arrives at a receiver: a pure function of the scene, the settings and the receiver's index.
    pub(crate) fn at(&self, receiver: &Receiver, index: u32, worker: &mut Worker) -> Arrival {
        let (direct, step) = self.gatherer.direct(receiver, index, worker);
        let mut values = vec![0.0; self.shape.len()];
        self.add_open(&direct.transfer, &direct.tinted, &mut values);
        let mut arrival = Arrival {
            values,
            openness: direct.openness,
            inside_share: 0.0,
            behind_share: 0.0,
            cover: f32::INFINITY,
            error: direct.error,
            visibility_rays: direct.visibility_rays,
            bounce_rays: 0,
            visibility: Vec::new(),
            bounced: Vec::new(),
            found: Found::default(),
        };
        let open = self.apart.then(|| arrival.values.clone());
        if direct.openness < 1.0 {
            let blockers = self.gatherer.blockers(index, step, direct.openness, worker);
            arrival.inside_share = blockers.inside_share;
            arrival.behind_share = blockers.behind_share;
            arrival.cover = blockers.cover(receiver.geometric_normal, &self.gatherer.bank.domain);
            arrival.bounce_rays = blockers.rays;
            if self.gatherer.hits && !blockers.found.is_empty() {
                let open = self.gatherer.bank.domain.open_about(self.functions, receiver.normal);
                let closed: Vec<f32> = open.iter().zip(&direct.transfer).map(|(all, open)| all - open).collect();
                let numbers = [self.shape.depth, self.shape.channels];
                let found = (&blockers.found[..], &blockers.filters[..]);
                let mut send = |hit: &Hit, direction, out: &mut [f32]| self.sent(hit, direction, out);
                add_sent(found, &closed, (self.functions, numbers), &mut send, &mut arrival.values);
                if self.apart {
                    let angle = self.measure();
                    arrival.found = Found { hits: blockers.found, filters: blockers.filters, closed, angle };
                }
            }
        }
        let angle = self.measure();
        if let Some(open) = open {
            arrival.visibility = direct.transfer.iter().map(|v| v * angle).collect();
            arrival.bounced = arrival.values.iter().zip(open).map(|(all, open)| angle * (all - open)).collect();
        }
        arrival.values.iter_mut().for_each(|value| *value *= angle);
        arrival
    }

    /// What a mean over the domain is multiplied by. Of one normal alone, whose cosine is in the domain, what arrives is irradiance over pi: it
    /// is told as if it were the same for all normals, in the first function.
    fn measure(&self) -> f32 {
        match &self.gatherer.bank.domain {
            Domain::Cosine => 4.0 * std::f32::consts::PI,
            other => other.solid_angle() as f32,
        }
    }

    /// Adds what open directions bring. `tinted` is the visibility of each channel where what is passed on the way is tinted, else empty.
    fn add_open(&self, visibility: &[f32], tinted: &[f32], values: &mut [f32]) {
        let channels = self.shape.channels;
        match &self.direct {
            Direct::Terms(terms) if tinted.is_empty() || channels == 1 => {
                let sums = self.products(terms, visibility);
                for (out, sum) in values.chunks_exact_mut(channels).zip(sums) {
                    out.fill(sum as f32);
                }
            }
            Direct::Terms(terms) => {
                for (c, visibility) in tinted.chunks_exact(visibility.len()).enumerate() {
                    let out = values.iter_mut().skip(c).step_by(channels);
                    out.zip(self.products(terms, visibility)).for_each(|(out, sum)| *out = sum as f32);
                }
            }
            Direct::Lit(rows) if !tinted.is_empty() => {
                let n = visibility.len();
                for (out, row) in values.chunks_exact_mut(channels).zip(rows.chunks_exact(n)) {
                    for ((c, out), visibility) in out.iter_mut().enumerate().zip(tinted.chunks_exact(n)) {
                        *out += row.iter().zip(visibility).map(|(factor, v)| factor[c] * v).sum::<f32>();
                    }
                }
            }
            Direct::Lit(rows) => {
                for (out, row) in values.chunks_exact_mut(channels).zip(rows.chunks_exact(visibility.len())) {
                    for (factor, v) in row.iter().zip(visibility) {
                        out.iter_mut().zip(factor).for_each(|(sum, factor)| *sum += factor * v);
                    }
                }
            }
        }
    }

    /// The products of every coefficient of the light with a visibility, by function.
    fn products(&self, terms: &[Triple], visibility: &[f32]) -> Vec<f64> {
        let Shape { functions, depth, .. } = self.shape;
        let mut sums = vec![0.0f64; functions * depth];
        for term in terms {
            sums[term.a as usize * depth + term.b as usize] += term.value * f64::from(visibility[term.c as usize]);
        }
        sums
    }

    /// Writes what a surface sends back along a ray, `[depth][channel]`; whether it sends anything.
    fn sent(&self, hit: &Hit, direction: Vec3, out: &mut [f32]) -> bool {
        out.fill(0.0);
        let world = self.gatherer.world;
        let albedo = world.sent(hit).to_array();
        let scatters = albedo != [0.0; 3];
        if scatters {
            self.add_scattered(hit, albedo, None, out);
        }
        let mirrors = self.shine.is_some_and(|shine| self.add_mirrored(shine, hit, direction, out));
        scatters || mirrors
    }

    /// Adds what surfaces that shine mirror: of light that falls on them straight by direction, of what other surfaces send the mean.
    fn add_mirrored(&self, shine: Shine<'_>, hit: &Hit, direction: Vec3, out: &mut [f32]) -> bool {
        let mirrors = shine.mirrors;
        let mut lobe = [0.0; (MOST_BANDS * MOST_BANDS) as usize];
        let lobe = &mut lobe[..mirrors.bands.coefficients()];
        let Some(met) = mirrors.meet(self.gatherer.world, hit, direction, lobe) else { return false };
        let mut row = vec![0.0; mirrors.light().coefficients()];
        let glance = mirrors.glance(&met, lobe, &mut row);
        let (tint, channels) = (glance.tint.to_array(), self.shape.channels);
        match self.light {
            None => {
                for (out, x) in out.chunks_exact_mut(channels).zip(&row) {
                    out.iter_mut().zip(tint).for_each(|(sum, tint)| *sum += tint * x);
                }
            }
            Some(light) => {
                for (c, (sum, tint)) in out.iter_mut().zip(tint).enumerate() {
                    *sum += tint * row.iter().zip(light).map(|(x, l)| x * l[c]).sum::<f32>();
                }
            }
        }
        if glance.closed > 0.0 {
            self.add_scattered(hit, (glance.tint * glance.closed).to_array(), Some(shine.direct), out);
        }
        true
    }

    /// Adds what the corners of a triangle, or its cell, send, times a factor; without the direct light where that is given.
    fn add_scattered(&self, hit: &Hit, factors: [f32; 3], without: Option<&Field>, out: &mut [f32]) {
        let world = self.gatherer.world;
        let channels = self.shape.channels;
        for (corner, share) in shares(world, self.receivers, hit.triangle, !hit.front, [hit.u, hit.v]) {
            for (channel, factor) in factors.iter().enumerate().take(channels) {
                let factor = share * factor;
                match &self.sent {
                    Sent::Transfer(field) => {
                        let mut add = |row: &[f32], factor: f32| {
                            let out = out.iter_mut().skip(channel).step_by(channels);
                            out.zip(row).for_each(|(sum, t)| *sum += factor * t);
                        };
                        add(field.channel(corner, channel), factor);
                        if let Some(direct) = without {
                            add(direct.channel(corner, channel), -factor);
                        }
                    }
                    Sent::Radiance(radiance) => {
                        let direct = match (without, self.light) {
                            (Some(direct), Some(light)) => {
                                dot(direct.channel(corner, channel.min(direct.channels - 1)), light, channel)
                            }
                            _ => 0.0,
                        };
                        out[channel] += factor * (radiance[corner as usize][channel] - direct);
                    }
                }
            }
        }
    }
}

fn dot(row: &[f32], light: &[[f32; 3]], channel: usize) -> f32 {
    row.iter().zip(light).map(|(t, l)| t * l[channel]).sum()
}

/// The products of one light with every coefficient of visibility.
fn lit(terms: &[Triple], light: &[[f32; 3]], functions: Bands, visibility: Bands) -> Vec<[f32; 3]> {
    let mut sums = vec![[0.0f64; 3]; functions.coefficients() * visibility.coefficients()];
    for term in terms {
        let slot = &mut sums[term.a as usize * visibility.coefficients() + term.c as usize];
        for (sum, l) in slot.iter_mut().zip(light[term.b as usize]) {
            *sum += term.value * f64::from(l);
        }
    }
    sums.into_iter().map(|sum| sum.map(|x| x as f32)).collect()
}

/// Turns radiance over directions into irradiance / pi over normals, \[N\] eqs. 2.3 and 2.4.
pub(crate) fn to_irradiance(values: &mut [f32], shape: Shape) {
    for (k, row) in values.chunks_exact_mut(shape.depth * shape.channels).enumerate() {
        let factor = zonal::clamped_cosine(k.isqrt()) as f32;
        row.iter_mut().for_each(|value| *value *= factor);
    }
}
