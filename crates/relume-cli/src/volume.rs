//! The options that say what irradiance volume to bake.

use anyhow::Result;
use bake::{VolumePlace, VolumeSettings, VolumeSteps};
use glam::Vec3;

/// A volume, as typed.
#[derive(Debug, clap::Args)]
pub(crate) struct VolumeOptions {
    /// Bake an irradiance volume too, which lights what moves: so many probes along x, y and z, the distance of probes in metres, or
    /// auto for a sixteenth of the longest edge.
    #[arg(long, value_name = "auto|NXxNYxNZ|STEPm", value_parser = steps, conflicts_with = "time")]
    volume: Option<VolumeSteps>,
    /// How often cells of the volume that surfaces come near are split into eight, 6 times at most; 0 for an even grid.
    #[arg(long, value_name = "N", requires = "volume")]
    volume_levels: Option<u32>,
    /// Where the volume lies: its lowest and its highest corner in metres; just inside of the scene by default.
    #[arg(long, value_name = "X,Y,Z,X,Y,Z", requires = "volume", value_parser = place, allow_hyphen_values = true)]
    volume_box: Option<VolumePlace>,
    /// Directions along a side of the map in which each probe keeps how far it sees: with fewer than 32, light leaks through thin walls
    /// near edges of rooms.
    #[arg(long, value_name = "N", requires = "volume")]
    volume_distances: Option<u32>,
}

impl VolumeOptions {
    /// The volume that is asked for, if one is.
    pub(crate) fn settings(&self) -> Result<Option<VolumeSettings>> {
        let Some(steps) = self.volume else { return Ok(None) };
        let standard = VolumeSettings::standard();
        let settings = VolumeSettings {
            steps,
            place: self.volume_box.unwrap_or(standard.place),
            levels: self.volume_levels.unwrap_or(standard.levels),
            resolution: self.volume_distances.unwrap_or(standard.resolution),
        };
        settings.check().map_err(crate::usage::bake_fault)?;
        Ok(Some(settings))
    }
}

fn steps(text: &str) -> Result<VolumeSteps, String> {
    let wrong = || "give auto, probes along each axis such as 16x8x16, or a distance such as 0.5m".to_owned();
    if text == "auto" {
        return Ok(VolumeSteps::Auto);
    }
    if let Some(metres) = text.strip_suffix('m') {
        return metres.parse().map(VolumeSteps::Spacing).map_err(|_| wrong());
    }
    let counts: Vec<u32> = text.split('x').map(|count| count.parse().map_err(|_| wrong())).collect::<Result<_, _>>()?;
    counts.try_into().map(VolumeSteps::Probes).map_err(|_| wrong())
}

fn place(text: &str) -> Result<VolumePlace, String> {
    let wrong = || "give six numbers, such as -2,0,-2,2,3,2".to_owned();
    let numbers: Vec<f32> = text.split(',').map(|n| n.parse().map_err(|_| wrong())).collect::<Result<_, _>>()?;
    let [a, b, c, d, e, f] = numbers.try_into().map_err(|_| wrong())?;
    Ok(VolumePlace::Box { min: Vec3::new(a, b, c), max: Vec3::new(d, e, f) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Debug, Parser)]
    struct Line {
        #[command(flatten)]
        volume: VolumeOptions,
        #[arg(long)]
        time: Option<f32>,
    }

    fn typed(arguments: &[&str]) -> Result<Option<VolumeSettings>, String> {
        let line = Line::try_parse_from([&["relume"], arguments].concat()).map_err(|error| error.to_string())?;
        line.volume.settings().map_err(|error| error.to_string())
    }

    #[test]
    fn words_become_a_volume() {
        assert_eq!(typed(&[]), Ok(None));
        let standard = VolumeSettings::standard();
        assert_eq!(typed(&["--volume", "auto"]), Ok(Some(standard.clone())));
        let counted = VolumeSettings { steps: VolumeSteps::Probes([16, 16, 8]), ..standard.clone() };
        assert_eq!(typed(&["--volume", "16x16x8"]), Ok(Some(counted)));
        let place = VolumePlace::Box { min: Vec3::new(-1.0, 0.0, -2.5), max: Vec3::new(1.0, 2.0, 3.0) };
        let all = VolumeSettings { place, steps: VolumeSteps::Spacing(0.5), levels: 2, resolution: 16 };
        let line = ["--volume", "0.5m", "--volume-box", "-1,0,-2.5,1,2,3", "--volume-levels", "2"];
        assert_eq!(typed(&[&line[..], &["--volume-distances", "16"]].concat()), Ok(Some(all)));
    }

    #[test]
    fn what_is_no_volume_is_refused() {
        for text in ["", "16", "16x16", "16x16x8x2", "axbxc", "m", "0.5", "-1x2x2"] {
            assert!(typed(&[&format!("--volume={text}")]).is_err(), "{text}");
        }
        let refused = |arguments: &[&str], why: &str| {
            let said = typed(arguments).expect_err("refused");
            assert!(said.contains(why), "{said}");
        };
        refused(&["--volume", "1x4x4"], "2 to 1024");
        refused(&["--volume=-1m"], "above 0");
        refused(&["--volume", "auto", "--volume-levels", "7"], "0 to 6");
        refused(&["--volume", "auto", "--volume-distances", "1"], "2 to 64");
        refused(&["--volume", "auto", "--volume-box", "0,0,0,1,1"], "six numbers");
        refused(&["--volume", "auto", "--volume-box", "0,0,0,1,-1,1"], "below the second");
        refused(&["--volume-levels", "1"], "--volume");
        refused(&["--volume", "auto", "--time", "5"], "--time");
    }
}
