//! Wrong usage that clap cannot see.

use bake::SettingField;
use std::fmt;

/// Wrong usage that only shows when a file is open; ends with exit code 2, as clap's own complaints do.
#[derive(Debug)]
pub(crate) struct Usage(pub(crate) String);

impl fmt::Display for Usage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Usage {}

/// A number that is out of range is wrong usage; everything else is a failure.
pub(crate) fn fault(error: relume::Error) -> anyhow::Error {
    match error {
        relume::Error::Bands { .. } => Usage(error.to_string()).into(),
        relume::Error::Bake(error) => bake_fault(error),
        other => other.into(),
    }
}

/// A setting out of range is wrong usage and told by its option; everything else is a failure, with the options that help.
pub(crate) fn bake_fault(error: bake::Error) -> anyhow::Error {
    let advice = match &error {
        bake::Error::Setting { setting, value, allowed } => {
            return Usage(format!("setting '{}' is {value}: {allowed}", option(*setting))).into();
        }
        bake::Error::Memory { .. } => "--bands, --memory",
        bake::Error::MapMemory { .. } => "--texels, --bands, --lighting fixed, --memory",
        bake::Error::VolumeMemory { .. } => "--volume, --volume-levels, --memory",
        _ => return error.into(),
    };
    anyhow::anyhow!("{error} ({advice})")
}

/// The option that a setting is typed as.
fn option(setting: SettingField) -> String {
    match setting {
        SettingField::Light => "--probe".into(),
        SettingField::FixedLight => "--lighting fixed".into(),
        SettingField::Dilation => "--padding".into(),
        SettingField::Pages => "--sheets".into(),
        other => format!("--{}", other.to_string().replace(' ', "-")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_told_by_their_options() {
        let told =
            |setting| bake_fault(bake::Error::Setting { setting, value: "0".into(), allowed: "use 1" }).to_string();
        assert_eq!(told(SettingField::Bands), "setting '--bands' is 0: use 1");
        assert_eq!(told(SettingField::VolumeLevels), "setting '--volume-levels' is 0: use 1");
        assert_eq!(told(SettingField::Light), "setting '--probe' is 0: use 1");
        let memory = bake_fault(bake::Error::Memory { receivers: 1, needed: 2, allowed: 1 });
        assert!(memory.to_string().contains("--memory") && !memory.is::<Usage>(), "{memory}");
    }
}
