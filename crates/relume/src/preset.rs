//! Bake settings by name.

use coeff_io::Settings;

/// Bake settings by name, from fast to accurate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Preset {
    /// 3 bands to a relative error of 5 %: a first look.
    Draft,
    /// 5 bands to a relative error of 1 %: what the command line bakes by default.
    Standard,
    /// 8 bands to a relative error of 0.3 %: sharper shadows, about ten times the time of [`Preset::Standard`].
    Fine,
}

impl Preset {
    /// The settings; single fields can be replaced.
    #[must_use]
    pub fn settings(self) -> Settings {
        match self {
            Self::Draft => bake::settings::preview(),
            Self::Standard => bake::settings::standard(),
            Self::Fine => bake::settings::fine(),
        }
    }
}

impl From<Preset> for Settings {
    fn from(preset: Preset) -> Self {
        preset.settings()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coeff_io::Quality;

    #[test]
    fn presets_are_valid_and_ordered_by_error() {
        let error = |preset: Preset| match preset.settings().quality {
            Quality::Error(error) => error,
            Quality::Rays(rays) => panic!("{preset:?} asks for {rays} rays, not for an error"),
        };
        let presets = [Preset::Draft, Preset::Standard, Preset::Fine];
        assert!(presets.iter().all(|preset| bake::settings::check(&preset.settings()).is_ok()));
        assert!(presets.windows(2).all(|pair| error(pair[1]) < error(pair[0])));
        assert!(presets.windows(2).all(|pair| pair[0].settings().bands < pair[1].settings().bands));
    }
}
