//! What `relume inspect` calls the settings of a bake.

use crate::columns::percent;
use coeff_io::{Bounces, Effects, Quality, Sampler, Settings};

/// Changes of bounces that are listed; of more, the first and the last are.
const LISTED: usize = 6;

/// How finely receivers were traced.
pub(crate) fn quality(settings: &Settings) -> String {
    match (settings.time, settings.quality) {
        (Some(seconds), _) => format!("the least error within {}", crate::columns::seconds(f64::from(seconds))),
        (None, Quality::Error(error)) => format!("error {}", percent(error)),
        (None, Quality::Rays(rays)) => format!("{rays} rays per receiver"),
    }
}

/// How often light might bounce.
pub(crate) fn bounces(bounces: Bounces) -> String {
    match bounces {
        Bounces::Auto => "bounces until they change nothing".into(),
        Bounces::Fixed(0) => "no bounces".into(),
        Bounces::Fixed(1) => "1 bounce".into(),
        Bounces::Fixed(count) => format!("{count} bounces"),
    }
}

/// Which effects might be simulated.
pub(crate) fn effects(effects: &Effects) -> String {
    match effects {
        Effects::Auto => "the effects that the scene calls for".into(),
        Effects::All => "all effects".into(),
        Effects::Only(list) if list.is_empty() => "no effects".into(),
        Effects::Only(list) => {
            let names: Vec<&str> = list.iter().map(|effect| effect.name()).collect();
            format!("the effects {}", names.join(", "))
        }
    }
}

/// Which sequence the rays followed.
pub(crate) fn sampler(sampler: Sampler) -> &'static str {
    match sampler {
        Sampler::OwenSobol => "Owen-scrambled Sobol points",
        Sampler::Fibonacci => "Fibonacci lattice",
        Sampler::Stratified => "jittered grid over the sphere",
    }
}

/// How much each bounce changed.
pub(crate) fn changes(bounces: u32, changes: &[f32]) -> String {
    if changes.is_empty() {
        return bounces.to_string();
    }
    let mut shown: Vec<String> = changes.iter().take(LISTED).map(|&change| percent(change)).collect();
    if let Some(last) = changes.last().filter(|_| changes.len() > LISTED) {
        shown.push(format!("... {}", percent(*last)));
    }
    format!("{bounces}, which changed {}", shown.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_have_words() {
        let standard = bake::settings::standard();
        assert_eq!(quality(&standard), "error 1 %");
        assert_eq!(quality(&Settings { time: Some(90.0), ..standard.clone() }), "the least error within 90.0 s");
        assert_eq!(quality(&Settings { quality: Quality::Rays(64), ..standard }), "64 rays per receiver");
        assert_eq!(bounces(Bounces::Fixed(1)), "1 bounce");
        assert_eq!(effects(&Effects::Only(vec![coeff_io::Effect::Color])), "the effects color");
        assert_eq!(changes(2, &[0.25, 0.01]), "2, which changed 25 %, 1 %");
        assert_eq!(changes(9, &[0.5; 9]).matches("50 %").count(), LISTED + 1);
        assert_eq!(changes(0, &[]), "0");
    }
}
