//! The plan in words: one row per effect, with the facts that decided it and what is at stake.

use crate::drawn;
use crate::facts::{Facts, Named};
use crate::plan::{Decisions, allowed, tolerance};
use coeff_io::{BandChoice, Bounces, Effect, PlanRow, Quality, Settings, Survey};

/// Rays per receiver and band that the estimate assumes where an error is asked for: 124 to 156 were seen at 1 % in the atrium and the
/// teacup, with 3 to 16 bands.
const RAYS_PER_BAND: f64 = 130.0;
/// Objects named in a row.
const NAMED: usize = 5;

/// What every row looks at.
pub(crate) struct Table<'a> {
    pub(crate) facts: &'a Facts,
    pub(crate) survey: &'a Survey,
    pub(crate) settings: &'a Settings,
    pub(crate) decisions: &'a Decisions,
}

/// One row per effect, in the order of [`Effect::ALL`].
pub(crate) fn rows(facts: &Facts, survey: &Survey, settings: &Settings, decisions: &Decisions) -> Vec<PlanRow> {
    let table = Table { facts, survey, settings, decisions };
    let row = |effect| match effect {
        Effect::Visibility => table.visibility(),
        Effect::Interreflection => table.interreflection(),
        Effect::Color => table.color(),
        Effect::Bands => table.bands(),
        Effect::Masks => drawn::masks(&table),
        Effect::Specular => drawn::specular(&table),
        Effect::Glossy => drawn::glossy(&table),
        Effect::NormalMaps => drawn::normal_maps(&table),
        Effect::Emission => drawn::emission(&table),
        Effect::Transmission => drawn::transmission(&table),
        Effect::Motion => drawn::motion(&table),
    };
    Effect::ALL.into_iter().map(row).collect()
}

/// What a row says; the table adds who calls for it, and that `--effects` left it out where it did.
pub(crate) struct Words {
    pub(crate) decision: String,
    pub(crate) reason: String,
    /// Share of an open receiver's light.
    pub(crate) stake: f32,
    pub(crate) at_stake: String,
}

impl Table<'_> {
    /// A row; costs are none.
    pub(crate) fn row(&self, effect: Effect, simulate: bool, by: &Named, words: Words) -> PlanRow {
        let left_out = !simulate && by.any() && !allowed(self.settings, effect);
        PlanRow {
            effect,
            simulate,
            decision: words.decision,
            reason: if left_out { format!("left out by --effects; {}", words.reason) } else { words.reason },
            called_for_by: by.names.iter().take(NAMED).cloned().collect(),
            callers: by.count() as u64,
            rays: 0,
            bytes: 0,
            stake: words.stake,
            at_stake: words.at_stake,
        }
    }

    fn visibility(&self) -> PlanRow {
        let (f, d) = (self.facts, self.decisions);
        let by = Named { names: f.meshes.iter().filter(|m| m.shadowed > 0).map(|m| m.name.clone()).collect() };
        let [mean, most] = self.survey.coverage;
        let dark = match f.dark {
            0 => String::new(),
            n => format!(" ({n} of them on surfaces that send nothing on, so nothing is traced there)"),
        };
        let words = Words {
            decision: match (d.visibility, d.traced) {
                (true, n) => format!("rays for {n} of {} receivers", f.receivers),
                (false, _) => "closed form, no rays".into(),
            },
            reason: match f.shadowed {
                0 => format!("nothing stands above any of the {} receivers", f.receivers),
                n if n == f.receivers => format!("something stands above each of the {n} receivers{dark}"),
                n => {
                    let all = f.receivers;
                    format!("something stands above {n} of {all} receivers{dark}; the others have a closed form")
                }
            },
            stake: most,
            at_stake: match (d.traced, self.survey.receivers) {
                (0, _) | (_, 0) => "nothing: where nothing is above, the closed form is exact".into(),
                (n, seen) => format!(
                    "shadows missing: {n} receivers up to {} of an open one's light too bright, {} on average ({seen} looked at)",
                    percent(most),
                    percent(mean)
                ),
            },
        };
        let row = self.row(Effect::Visibility, d.visibility, &by, words);
        let (rays, bytes) = if d.visibility { (self.visibility_rays(), 4 * f.receivers) } else { (0, 0) };
        PlanRow { rays, bytes, ..row }
    }

    fn visibility_rays(&self) -> u64 {
        (self.decisions.traced as f64 * self.rays_of_receiver()) as u64
    }

    /// Rays that tell what a receiver sees.
    pub(crate) fn rays_of_receiver(&self) -> f64 {
        match self.settings.quality {
            Quality::Rays(n) => f64::from(n),
            Quality::Error(e) => RAYS_PER_BAND * f64::from(self.decisions.bands) * f64::from(0.01 / e).max(0.05),
        }
    }

    fn interreflection(&self) -> PlanRow {
        let (f, d) = (self.facts, self.decisions);
        let [mean, most] = d.bounced;
        let words = Words {
            decision: match (d.interreflection, self.settings.bounces) {
                (false, _) => "no bounce pass".into(),
                (true, Bounces::Fixed(n)) => format!("{n} bounces, as asked"),
                (true, Bounces::Auto) => format!("about {} bounces", d.expected_bounces.min(d.bounces)),
            },
            reason: self.bounce_reason(),
            stake: most,
            at_stake: match most {
                0.0 => "nothing: no light is sent on".into(),
                _ => format!(
                    "bounced light missing: up to {} of an open receiver's, {} on average",
                    percent(most),
                    percent(mean)
                ),
            },
        };
        let row = self.row(Effect::Interreflection, d.interreflection, &f.reflecting, words);
        // Of the visibility rays those that are blocked, half of them where rays go on until an error is met.
        let share = match self.settings.quality {
            Quality::Rays(_) => 1.0,
            Quality::Error(_) => 0.5,
        };
        let rays = (self.visibility_rays() as f64 * f64::from(self.survey.coverage[0]) * share) as u64;
        PlanRow { rays: if d.interreflection { rays } else { 0 }, ..row }
    }

    fn bounce_reason(&self) -> String {
        let (f, d) = (self.facts, self.decisions);
        if !f.reflecting.any() {
            return "every surface that blocks light is black".into();
        }
        if f.shadowed == 0 {
            return "no receiver sees a surface".into();
        }
        if !d.visibility {
            return "what blocks is not looked for".into();
        }
        if self.settings.bounces == Bounces::Fixed(0) {
            return "--bounces 0".into();
        }
        let albedo = format!(
            "surfaces reflect {} on average and {} at most, receivers are covered to {} on average",
            percent(f.mean_albedo),
            percent(f.largest_albedo),
            percent(self.survey.coverage[0])
        );
        match (d.interreflection, d.bounces) {
            (false, _) => format!("{albedo}: all bounces together stay below the tolerance"),
            (true, crate::settings::MAX_BOUNCES) => {
                format!("{albedo}; no bound, bounces end where they are measured to")
            }
            (true, n) => {
                format!("{albedo}; more than {n} bounces cannot matter, and they end sooner where measured to")
            }
        }
    }

    fn color(&self) -> PlanRow {
        let (f, d) = (self.facts, self.decisions);
        let spread = f.materials.iter().filter(|m| m.scatters() && m.albedo.colored).map(|m| m.albedo.spread);
        let stake = spread.fold(0.0, f32::max) * self.survey.coverage[1];
        let words = Words {
            decision: if d.color { "3 channels".into() } else { "1 channel, albedo when drawn".into() },
            reason: match (d.interreflection, f.colored.count()) {
                _ if d.color && f.stained.any() => format!("light takes the colour of {} materials", f.stained.count()),
                (false, _) => "no bounces, so colour cannot enter the transfer".into(),
                (true, 0) => "every surface that reflects is grey: one channel holds all".into(),
                (true, n) => format!("light bounces off {n} coloured materials"),
            },
            stake,
            at_stake: match f.colored.any() && d.interreflection {
                false => "nothing: all channels are the same".into(),
                true => format!("bounced light without its tint: channels off by up to {}", percent(stake)),
            },
        };
        let plane = f.receivers * u64::from(d.bands * d.bands) * 4;
        let row = self.row(Effect::Color, d.color, &f.colored, words);
        PlanRow { bytes: if d.color { 2 * plane } else { 0 }, ..row }
    }

    fn bands(&self) -> PlanRow {
        let (d, asked) = (self.decisions, self.settings.bands);
        let (left, fewer) = (d.left_out[d.bands as usize], d.left_out[d.bands as usize - 1]);
        let (few, without_last) = (d.left_out[d.bands_needed as usize], d.left_out[d.bands_needed as usize - 1]);
        let under = if self.settings.light.is_empty() { "of an open receiver's transfer" } else { "under this light" };
        let hint = match self.settings.band_choice {
            BandChoice::Exactly if d.bands_needed < asked => " (--bands auto would take so many)",
            BandChoice::Exactly | BandChoice::Needed => "",
        };
        let tolerance = percent(tolerance(self.settings.quality));
        let words = Words {
            decision: match d.bands {
                n if n < asked => format!("{n} of {asked} bands"),
                n => format!("{n} bands"),
            },
            reason: match d.bands_needed {
                n if n < asked => format!(
                    "{n} bands would leave out {} {under}, within the tolerance of {tolerance}{hint}",
                    percent(few as f32)
                ),
                n => format!(
                    "without band {}, {} {under} would be missing, more than the tolerance of {tolerance}",
                    n - 1,
                    percent(without_last as f32)
                ),
            },
            stake: if left.is_finite() { left as f32 } else { 1.0 },
            at_stake: format!("one band fewer: up to {} {under}", percent(fewer as f32)),
        };
        let row = self.row(Effect::Bands, d.bands == asked, &Named::default(), words);
        PlanRow { bytes: self.facts.receivers * u64::from(d.bands * d.bands) * 4, ..row }
    }
}

/// A share in words.
pub(crate) fn percent(share: f32) -> String {
    match 100.0 * share {
        p if !p.is_finite() => "an unknown share".into(),
        p if p <= 0.0 => "0 %".into(),
        p if p < 0.01 => "less than 0.01 %".into(),
        p if p < 9.95 => format!("{} %", format!("{p:.2}").trim_end_matches('0').trim_end_matches('.')),
        p => format!("{p:.0} %"),
    }
}

#[cfg(test)]
mod tests {
    use super::percent;

    #[test]
    fn shares_read_well() {
        let texts = [0.0, 1e-6, 0.0025, 0.076, 0.5, 1.0, f32::INFINITY].map(percent);
        assert_eq!(texts, ["0 %", "less than 0.01 %", "0.25 %", "7.6 %", "50 %", "100 %", "an unknown share"]);
    }
}
