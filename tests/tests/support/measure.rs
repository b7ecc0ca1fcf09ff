//! The figures of a comparison.

use super::subject::Spot;
use super::{BandLight, Subject};
use reference::{Estimate, Settings, World, radiance_at};
use std::fmt::{Display, Formatter};

/// Paths of the first look, which tells how many are needed.
const FIRST_LOOK: u32 = 256;
/// Receivers named among the worst.
const WORST: usize = 4;
/// Most paths per receiver.
const MOST: u32 = 1 << 20;

/// How far a bake is from the path tracer. Shares of the mean radiance, which is the mean of the absolute radiance
/// over all compared receivers and channels.
pub(crate) struct Figures {
    /// Receivers compared.
    pub(crate) receivers: usize,
    /// How many of them are hidden, and are compared at what shows of their triangles.
    pub(crate) moved: usize,
    /// Receivers drawn beside them that show nowhere: wholly inside bodies, or without normal and area.
    pub(crate) hidden: [usize; 2],
    /// Paths per receiver.
    pub(crate) paths: u32,
    /// Mean of |bake - reference| over receivers and channels, as a share of the mean radiance.
    pub(crate) difference: f64,
    /// The same with each receiver weighed by the area that it stands for, over the mean radiance so weighed.
    pub(crate) by_area: f64,
    /// Mean of bake - reference, as a share of the mean radiance: what does not average out.
    pub(crate) bias: f64,
    /// Mean standard error of the reference, as a share of the mean radiance.
    pub(crate) noise: f64,
    /// Median and 95th percentile over receivers brighter than a tenth of the mean of |bake - reference|, summed over
    /// channels, as a share of the receiver's own radiance.
    pub(crate) relative: [f64; 2],
    /// The receivers that differ most, in words.
    pub(crate) worst: String,
}

/// Compares the rows of a subject under a light, with as many paths as bring the noise of the reference to `noise`.
pub(crate) fn measure(subject: &Subject, light: &BandLight, max_bounces: Option<u32>, noise: f64) -> Figures {
    let world = World::new(&subject.scene);
    let points = subject.points();
    let trace = |samples, seed| radiance_at(&world, &light.picture, &points, &Settings { samples, seed, max_bounces });
    let look = figures(subject, rows(subject, light, &trace(FIRST_LOOK, 1)), FIRST_LOOK);
    let needed = f64::from(FIRST_LOOK) * (look.noise / noise).powi(2);
    let paths = (needed.ceil() as u32).clamp(FIRST_LOOK, MOST);
    figures(subject, rows(subject, light, &trace(paths, 2)), paths)
}

/// What both sides say of a receiver.
#[derive(Debug, Clone, Copy)]
struct Row {
    /// Row of the transfer.
    row: usize,
    /// Area that it stands for, square metres.
    area: f64,
    /// Radiance by the bake.
    baked: [f64; 3],
    /// Radiance by the path tracer.
    traced: Estimate,
}

impl Row {
    fn traced(&self) -> [f64; 3] {
        self.traced.mean.map(f64::from)
    }

    /// Sum over the channels of |bake - reference|.
    fn difference(&self) -> f64 {
        self.baked.iter().zip(self.traced()).map(|(a, b)| (a - b).abs()).sum()
    }

    /// Sum over the channels of the reference's absolute radiance.
    fn size(&self) -> f64 {
        self.traced().iter().map(|v| v.abs()).sum()
    }
}

fn rows(subject: &Subject, light: &BandLight, traced: &[Estimate]) -> Vec<Row> {
    let mut rest = traced;
    let row = |spot: &Spot| {
        let (own, later) = rest.split_at(spot.places.len());
        rest = later;
        Row {
            row: spot.row,
            area: subject.area(spot.row),
            baked: subject.radiance(spot, &light.coefficients),
            traced: mean(own),
        }
    };
    subject.spots.iter().map(row).collect()
}

/// The mean of independent estimates.
fn mean(all: &[Estimate]) -> Estimate {
    let share = 1.0 / all.len() as f32;
    let sum = |value: &dyn Fn(&Estimate) -> f32| share * all.iter().map(value).sum::<f32>();
    Estimate {
        mean: [0, 1, 2].map(|c| sum(&|one| one.mean[c])),
        std_error: [0, 1, 2].map(|c| (share * sum(&|one| one.std_error[c].powi(2))).sqrt()),
    }
}

fn figures(subject: &Subject, mut rows: Vec<Row>, paths: u32) -> Figures {
    let sum = |value: &dyn Fn(&Row) -> f64| rows.iter().map(value).sum::<f64>();
    let total = sum(&Row::size);
    let signed = sum(&|r| r.baked.iter().zip(r.traced()).map(|(a, b)| a - b).sum());
    let spread = sum(&|r| r.traced.std_error.iter().map(|&e| f64::from(e)).sum());
    let mean = total / rows.len() as f64;
    let mut relative: Vec<f64> =
        rows.iter().filter(|r| r.size() > 0.1 * mean).map(|r| r.difference() / r.size()).collect();
    relative.sort_by(f64::total_cmp);
    let at = |share: f64| relative.get((relative.len() as f64 * share) as usize).copied().unwrap_or(f64::NAN);
    rows.sort_by(|a, b| b.difference().total_cmp(&a.difference()));
    let told = |r: &Row| format!("  {:?} at {:?}\n", r, subject.prt.geometry.positions[r.row]);
    let worst = rows.iter().take(WORST).map(told).collect();
    let sum = |value: &dyn Fn(&Row) -> f64| rows.iter().map(value).sum::<f64>();
    Figures {
        receivers: rows.len(),
        moved: subject.moved,
        hidden: [subject.buried, subject.flat],
        paths,
        difference: sum(&Row::difference) / total,
        by_area: sum(&|r| r.area * r.difference()) / sum(&|r| r.area * r.size()),
        bias: signed / total,
        noise: spread / total,
        relative: [at(0.5), at(0.95)],
        worst,
    }
}

impl Display for Figures {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let [median, most] = self.relative;
        let shares = [self.difference, self.by_area, self.bias, self.noise, median, most].map(|share| 100.0 * share);
        let [difference, by_area, bias, noise, median, most] = shares;
        let [buried, flat] = self.hidden;
        write!(
            f,
            "{} receivers ({} hidden, at what shows of their triangles; beside them ",
            self.receivers, self.moved
        )?;
        write!(f, "{buried} wholly buried and {flat} without area), {} paths: ", self.paths)?;
        write!(f, "difference {difference:.2} % (by area {by_area:.2} %), bias {bias:+.2} %, noise {noise:.2} %, ")?;
        write!(f, "per receiver median {median:.2} %, 95th percentile {most:.2} %; worst:\n{}", self.worst)
    }
}
