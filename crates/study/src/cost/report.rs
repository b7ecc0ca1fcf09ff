//! What a study found, as plain data.

use super::bakes::Check;
use super::deviation::Spread;
use super::frames::Frames;
use super::gloss::GlossStudy;
use super::recommend::{Advice, Goal, without_own};
use super::resolution::Resolution;
use crate::bases::scene::Comparison;
use crate::plot::chart::Unit;
use crate::plot::pixels::Pixels;
use std::fmt;

/// What a run turns, all else being as asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Knob {
    /// The error that rays are traced for.
    Error,
    /// A fixed number of rays.
    Rays,
    /// The sequence that rays follow.
    Sampler,
    /// How often light may bounce.
    Bounces,
    /// The number of bands.
    Bands,
    /// How a coefficient is stored.
    Format,
    /// How finely the surface is split.
    Resolution,
}

impl Knob {
    /// All knobs, in the order of the report.
    pub const ALL: [Self; 7] =
        [Self::Error, Self::Rays, Self::Sampler, Self::Bounces, Self::Bands, Self::Format, Self::Resolution];

    /// The name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Error => "error level",
            Self::Rays => "rays",
            Self::Sampler => "sampler",
            Self::Bounces => "bounces",
            Self::Bands => "bands",
            Self::Format => "number format",
            Self::Resolution => "resolution",
        }
    }
}

impl fmt::Display for Knob {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// One bake, or one way of storing it, with its price and its error.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// What was turned.
    pub knob: Knob,
    /// The options of `relume bake` that make it, or the number format.
    pub setting: String,
    /// Whether `relume bake` can make it today; the number formats are only reckoned.
    pub can_be_typed: bool,
    /// Bands of the transfer.
    pub bands: u32,
    /// Vertices that hold a transfer vector.
    pub receivers: usize,
    /// Channels of the transfer.
    pub channels: u32,
    /// Bounces that were simulated.
    pub bounces: u32,
    /// Any-hit and closest-hit rays.
    pub rays: [u64; 2],
    /// Wall-clock seconds of the bake.
    pub seconds: f64,
    /// Bytes of the coefficients.
    pub bytes: u64,
    /// Error of the transfer of each receiver, in the unit of `--error`.
    pub transfer: Spread,
    /// Relative error of radiance under the light, in as many bands as the run has.
    pub radiance: f64,
    /// The same in all bands of the reference: what the bands left out cost is inside. Not known for other meshes.
    pub radiance_all_bands: Option<f64>,
}

/// What all runs are compared with.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferenceFacts {
    /// What each of the two bakes was asked for whose mean it is.
    pub level: String,
    /// Its bands.
    pub bands: u32,
    /// Its own estimated error in the transfer.
    pub own: Spread,
    /// Its own estimated relative error of radiance.
    pub own_radiance: f64,
    /// Rays per receiver that something can shadow, both bakes together.
    pub rays_per_receiver: f64,
    /// Bounces.
    pub bounces: u32,
    /// Seconds that it took.
    pub seconds: f64,
}

/// A receiver with a large error.
#[derive(Debug, Clone, PartialEq)]
pub struct WorstReceiver {
    /// Index of the vertex in the file.
    pub index: usize,
    /// World space, metres.
    pub position: [f32; 3],
    /// Error of its transfer.
    pub error: f32,
    /// The mesh that it belongs to.
    pub object: String,
}

/// A picture for the page.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// What is seen.
    pub caption: String,
    /// The pixels.
    pub pixels: Pixels,
}

/// Facts about where the study ran.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Machine {
    /// Threads that a bake may use.
    pub threads: usize,
    /// Processor architecture and system.
    pub system: String,
    /// Version of this program.
    pub version: String,
}

/// A whole study.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// The scene as the user named it.
    pub scene: String,
    /// The light as the user named it.
    pub light: String,
    /// Bands asked for.
    pub bands: u32,
    /// The machine.
    pub machine: Machine,
    /// Seconds that were allowed, and that it took.
    pub budget: [f64; 2],
    /// Receivers, and those of them that something can shadow.
    pub receivers: [u64; 2],
    /// Bytes of the textures, which every run has.
    pub texture_bytes: u64,
    /// What the runs are compared with.
    pub reference: ReferenceFacts,
    /// Every run on the mesh as asked, in the order measured.
    pub runs: Vec<Run>,
    /// Indices into `runs`: no other run is both faster and closer. Error of the transfer, 95th percentile.
    pub fast_front: Vec<usize>,
    /// Indices into `runs`: no other run is both smaller and closer. Error of radiance in all bands.
    pub small_front: Vec<usize>,
    /// What to type.
    pub advice: Vec<Advice>,
    /// Storage at finer and coarser vertices.
    pub resolution: Option<Resolution>,
    /// Bases of light maps, where they were asked for and fitted into the budget.
    pub bases: Option<Comparison>,
    /// Gloss and transfer textures, where the plan calls for them and they fitted into the budget.
    pub gloss: Option<GlossStudy>,
    /// Time per picture.
    pub frames: Vec<Frames>,
    /// Predicted and measured bakes: half of the reference, then the trials.
    pub checks: Vec<Check>,
    /// Receivers with the largest errors in the run named.
    pub worst: Vec<WorstReceiver>,
    /// The bake as asked; `None` where the budget did not allow it.
    pub asked: Option<usize>,
    /// The run that `worst` and the first picture are about: the bake as asked, else the one of few rays.
    pub shown: usize,
    /// The baked picture, then error maps.
    pub views: Vec<View>,
    /// Errors at the dark and at the bright end of the maps.
    pub map_range: [f32; 2],
    /// What the budget did not allow, or what there is not, in sentences.
    pub left_out: Vec<String>,
}

impl Report {
    /// The error of the transfer that 95 of 100 receivers of a run keep, without the reference's own.
    #[must_use]
    pub fn kept(&self, run: &Run) -> f64 {
        without_own(run.transfer.p95, self.reference.own.p95)
    }

    /// What the reader must know before the numbers: that the reference is too coarse for the error asked for.
    #[must_use]
    pub fn warning(&self) -> Option<String> {
        let error = |advice: &Advice| if let Goal::Error(error) = advice.goal { Some(error) } else { None };
        let target = self.advice.iter().find_map(error)?;
        let own = self.reference.own.p95;
        (own > 0.5 * target).then(|| {
            format!(
                "The reference itself errs by {}, more than half of the {} asked for, so whether a run keeps that is uncertain; a \
                 longer --budget allows a closer reference.",
                Unit::Share.write(own),
                Unit::Share.write(target)
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::cost::sample;

    /// The sample asks for an error of 1 %.
    #[test]
    fn a_coarse_reference_is_warned_of() {
        let mut report = sample::report();
        report.reference.own.p95 = 0.0051;
        assert!(report.warning().is_some_and(|text| text.contains("0.51 %") && text.contains("1 % asked")));
    }

    #[test]
    fn a_coarse_reference_is_warned_of_can_fail() {
        let mut report = sample::report();
        report.reference.own.p95 = 0.0049;
        assert_eq!(report.warning(), None);
    }
}
