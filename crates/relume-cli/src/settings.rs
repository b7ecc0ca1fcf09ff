//! The options that say how to bake, and the settings that they stand for.

use anyhow::Result;
use bake::settings;
use coeff_io::{BandChoice, Bounces, Effect, Effects, Quality, Refine, Sampler, Settings};

/// How to bake, as typed.
#[derive(Debug, clap::Args)]
pub(crate) struct BakeOptions {
    /// Number of bands: n bands are n*n coefficients per receiver. With auto those whose absence would show, under the light of
    /// --probe where one is given: 5 at most, or auto:MAX.
    #[arg(long, value_name = "N|auto|auto:MAX", default_value_t = BandsOption::standard(), value_parser = bands,
          allow_negative_numbers = true)]
    bands: BandsOption,
    /// Fixed number of rays per receiver.
    #[arg(long, value_name = "N", conflicts_with = "error", allow_negative_numbers = true)]
    rays: Option<u32>,
    /// Relative error of each receiver's transfer to reach, such as 0.01 or 1%, which is the default; a receiver takes 16,384 directions at
    /// most, and the file says what was reached.
    #[arg(long, value_name = "E", value_parser = error, allow_negative_numbers = true)]
    error: Option<f32>,
    /// How often light may bounce: a number, or auto for until it changes nothing.
    #[arg(long, value_name = "N|auto", default_value = "auto", value_parser = bounces, allow_negative_numbers = true)]
    bounces: Bounces,
    /// Splits large triangles, whose vertices alone could not hold shadows: auto (as evenly as the scene's own triangles
    /// allow, and finer where a quick look finds that shadows bend between vertices), off, or the longest edge in metres.
    #[arg(long, value_name = "auto|off|METRES", default_value = "auto", value_parser = refine)]
    refine: Refine,
    /// Effects that may be simulated: auto for those that the scene calls for, all, none, or a list of visibility,
    /// interreflection, color, masks, specular, glossy, normal-maps, emission, transmission. With glossy come visibility and specular, without
    /// which there is none.
    #[arg(long, value_name = "auto|all|none|LIST", default_value = "auto", value_parser = effects)]
    effects: Effects,
    /// Where coefficients are stored.
    #[arg(long, value_enum, default_value_t = Storage::Auto)]
    pub(crate) storage: Storage,
    /// Seed of everything random.
    #[arg(long, value_name = "S", default_value_t = settings::standard().seed)]
    seed: u64,
    /// Which sequence the rays follow; only owen-sobol can go on until an error is reached.
    #[arg(long, value_enum, default_value_t = SamplerName::OwenSobol)]
    sampler: SamplerName,
    /// Memory that coefficients and caches may take; K, M and G stand for powers of 1024.
    #[arg(long, value_name = "BYTES", value_parser = bytes)]
    memory: Option<u64>,
}

/// Where coefficients are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Storage {
    /// At the vertices; in transfer textures where surfaces shine and the triangles are too large for the error asked for.
    Auto,
    /// At the vertices.
    Vertex,
    /// At the vertices, and in textures: transfer textures where the plan calls for glossy, light maps where it does not or options of
    /// theirs are given.
    Texture,
    /// At the vertices, and in transfer textures: what vertices hold, at texels.
    Transfer,
    /// At the vertices, and in light maps that answer to normal maps.
    Maps,
}

/// The sequences by the names that are typed.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum SamplerName {
    /// Owen-scrambled Sobol points.
    OwenSobol,
    /// Fibonacci lattice.
    Fibonacci,
    /// Jittered grid over the sphere.
    Stratified,
}

/// How many bands, as typed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct BandsOption {
    count: u32,
    choice: BandChoice,
}

impl BandsOption {
    fn standard() -> Self {
        Self { count: settings::standard().bands, choice: BandChoice::Exactly }
    }
}

impl std::fmt::Display for BandsOption {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.choice {
            BandChoice::Exactly => write!(f, "{}", self.count),
            BandChoice::Needed => write!(f, "auto:{}", self.count),
        }
    }
}

impl BakeOptions {
    /// The error that was asked for, where one was.
    pub(crate) fn asked_error(&self) -> Option<f32> {
        self.error
    }

    /// Bands that are baked at most.
    pub(crate) fn most_bands(&self) -> u32 {
        self.bands.count
    }

    /// The settings that these options stand for, with the norms of the bands of a light where one is known.
    pub(crate) fn settings(&self, light: &[f32]) -> Result<Settings> {
        let standard = settings::standard();
        let settings = Settings {
            bands: self.bands.count,
            band_choice: self.bands.choice,
            light: light.to_vec(),
            quality: self.rays.map(Quality::Rays).or(self.error.map(Quality::Error)).unwrap_or(standard.quality),
            time: None,
            bounces: self.bounces,
            refine: self.refine,
            effects: self.effects.clone(),
            sampler: match self.sampler {
                SamplerName::OwenSobol => Sampler::OwenSobol,
                SamplerName::Fibonacci => Sampler::Fibonacci,
                SamplerName::Stratified => Sampler::Stratified,
            },
            seed: self.seed,
            memory: self.memory.unwrap_or(standard.memory),
        };
        settings::check(&settings).map_err(crate::usage::bake_fault)?;
        Ok(settings)
    }
}

fn bands(text: &str) -> Result<BandsOption, String> {
    let number = |text: &str| text.parse().map_err(|_| "give a number, auto or auto:MAX".to_owned());
    match text.strip_prefix("auto") {
        Some("") => Ok(BandsOption { choice: BandChoice::Needed, ..BandsOption::standard() }),
        Some(most) => {
            Ok(BandsOption { count: number(most.strip_prefix(':').unwrap_or(""))?, choice: BandChoice::Needed })
        }
        None => Ok(BandsOption { count: number(text)?, choice: BandChoice::Exactly }),
    }
}

/// Parses a share: `0.01` or `1%`.
pub(crate) fn share(text: &str) -> Option<f32> {
    let value = match text.trim().strip_suffix('%') {
        Some(percent) => percent.trim_end().parse::<f64>().ok()? / 100.0,
        None => text.trim().parse::<f64>().ok()?,
    };
    value.is_finite().then_some(value as f32)
}

/// Parses a relative error above 0.
pub(crate) fn error(text: &str) -> Result<f32, String> {
    share(text).filter(|&value| value > 0.0).ok_or_else(|| "give a relative error above 0, such as 0.01 or 1%".into())
}

/// Parses a number of bounces; the reference takes the same words.
pub(crate) fn bounces(text: &str) -> Result<Bounces, String> {
    match text {
        "auto" => Ok(Bounces::Auto),
        number => number.parse().map(Bounces::Fixed).map_err(|_| "give a number or auto".into()),
    }
}

/// Parses how large triangles are split.
pub(crate) fn refine(text: &str) -> Result<Refine, String> {
    match text {
        "auto" => Ok(Refine::Auto),
        "off" => Ok(Refine::Off),
        length => length.parse().map(Refine::Edge).map_err(|_| "give auto, off or a length in metres".into()),
    }
}

fn effects(text: &str) -> Result<Effects, String> {
    match text {
        "auto" => Ok(Effects::Auto),
        "all" => Ok(Effects::All),
        "none" => Ok(Effects::Only(Vec::new())),
        list => list.split(',').map(effect).collect::<Result<_, _>>().map(|list| Effects::Only(with_needed(list))),
    }
}

/// Adds what glossy builds on.
fn with_needed(mut list: Vec<Effect>) -> Vec<Effect> {
    if list.contains(&Effect::Glossy) {
        let missing = [Effect::Visibility, Effect::Specular].into_iter().filter(|effect| !list.contains(effect));
        let missing: Vec<Effect> = missing.collect();
        list.extend(missing);
    }
    list
}

fn effect(name: &str) -> Result<Effect, String> {
    match Effect::ALL.into_iter().find(|effect| effect.name() == name) {
        Some(Effect::Bands) => Err("the number of bands is set by --bands".into()),
        Some(Effect::Motion) => Err("moving objects are not simulated".into()),
        Some(effect) => Ok(effect),
        None => {
            let names: Vec<&str> = Effect::ALL.iter().map(|effect| effect.name()).collect();
            let names = &names[..];
            let list = || format!("there are auto, all, none, or a list of {}", names.join(", "));
            let meant = crate::mistake::nearest(name, names).map(|name| format!("did you mean {name}?"));
            Err(format!("'{name}' is no effect; {}", meant.unwrap_or_else(list)))
        }
    }
}

/// Most seconds that may be asked for: far beyond any bake, and small enough to count with.
const MOST_SECONDS: f32 = 30.0 * 24.0 * 3600.0;

/// Parses a time in seconds, minutes or hours.
pub(crate) fn seconds(text: &str) -> Result<f32, String> {
    let (digits, unit) = match text.char_indices().next_back() {
        Some((at, 's')) => (&text[..at], 1.0),
        Some((at, 'm')) => (&text[..at], 60.0),
        Some((at, 'h')) => (&text[..at], 3600.0),
        _ => (text, 1.0),
    };
    let wrong = || "give a time above 0, such as 90, 90s, 5m or 2h".to_owned();
    let number: f32 = digits.parse().map_err(|_| wrong())?;
    let seconds = number * unit;
    match seconds {
        s if s > MOST_SECONDS => Err("give at most 30 days (720h)".into()),
        s if s > 0.0 => Ok(s),
        _ => Err(wrong()),
    }
}

/// Parses a number of bytes with K, M, G or T, which may be written KB or KiB too.
pub(crate) fn bytes(text: &str) -> Result<u64, String> {
    let lower = text.trim().to_ascii_lowercase();
    let bare = lower.strip_suffix('b').map_or(lower.as_str(), |rest| rest.strip_suffix('i').unwrap_or(rest));
    let units = [('k', 1u64 << 10), ('m', 1 << 20), ('g', 1 << 30), ('t', 1 << 40)];
    let unit = units.into_iter().find_map(|(letter, unit)| Some((bare.strip_suffix(letter)?, unit)));
    let (digits, unit) = unit.unwrap_or((bare, 1));
    let number: u64 = digits.trim_end().parse().map_err(|_| "give a number of bytes, such as 500M or 4G".to_owned())?;
    number.checked_mul(unit).ok_or_else(|| "that is more than any machine has".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_become_settings() {
        assert_eq!(["0.01", "1%", "1 %", "x%", "nan"].map(share), [Some(0.01), Some(0.01), Some(0.01), None, None]);
        assert!(error("5%") == Ok(0.05) && error("0").is_err() && error("-1").is_err());
        assert_eq!(bytes("4G"), Ok(4 << 30));
        assert_eq!(["4GB", "4 GiB", "4g", "4096M"].map(bytes), [const { Ok(4 << 30) }; 4]);
        assert_eq!(["100", "100B"].map(bytes), [const { Ok(100) }; 2]);
        assert!(["iB", "4X", "10%", "1.5G", ""].iter().all(|text| bytes(text).is_err()));
        assert!(bytes("G").is_err() && bytes("-1").is_err() && bytes("99999999999G").is_err());
        assert_eq!(seconds("90"), Ok(90.0));
        assert_eq!(seconds("1.5m"), Ok(90.0));
        assert!(seconds("1e30h").is_err() && seconds("1e19").is_err() && seconds("NaN").is_err());
        assert!(seconds("0").is_err() && seconds("-1s").is_err() && seconds("m").is_err() && seconds("infh").is_err());
        assert_eq!(bounces("2"), Ok(Bounces::Fixed(2)));
        assert!(bounces("many").is_err());
        assert_eq!(effects("color,masks"), Ok(Effects::Only(vec![Effect::Color, Effect::Masks])));
        let glossy = vec![Effect::Glossy, Effect::Specular, Effect::Visibility];
        assert_eq!(effects("glossy,specular"), Ok(Effects::Only(glossy)), "what gloss needs comes with it");
        assert!(effects("colour").is_err() && effects("").is_err() && effects("motion").is_err());
        assert_eq!(bands("7"), Ok(BandsOption { count: 7, choice: BandChoice::Exactly }));
        assert_eq!(bands("auto"), Ok(BandsOption { count: 5, choice: BandChoice::Needed }));
        assert_eq!(bands("auto:8"), Ok(BandsOption { count: 8, choice: BandChoice::Needed }));
        assert!(bands("auto8").is_err() && bands("auto:").is_err() && bands("many").is_err());
    }
}
