//! Where scenes, light probes and baked files come from: a path or `builtin:NAME`.

use crate::console::Console;
use crate::mistake::{self, Kind};
use crate::usage::Usage;
use anyhow::Result;
use coeff_io::Prt;
use probe_io::{Environment, Layout, LoadOptions, Negatives, NonFinite};
use scene::Scene;
use sh_math::Bands;
use std::path::{Path, PathBuf};

/// A path or the name of something built in.
#[derive(Debug, Clone)]
enum Source {
    Path(PathBuf),
    Builtin(String),
}

/// Tells a path from a built-in name. Never fails; clap wants a parser that could.
fn parse(text: &str) -> Result<Source, std::convert::Infallible> {
    Ok(match text.strip_prefix("builtin:") {
        Some(name) => Source::Builtin(name.into()),
        None => Source::Path(text.into()),
    })
}

impl Source {
    /// As the user typed it.
    fn name(&self) -> String {
        match self {
            Self::Path(path) => path.display().to_string(),
            Self::Builtin(name) => format!("builtin:{name}"),
        }
    }

    /// As the library takes it.
    fn path(&self) -> PathBuf {
        match self {
            Self::Path(path) => path.clone(),
            Self::Builtin(_) => self.name().into(),
        }
    }

    /// The file, or the files of a folder, that this reads.
    fn files(&self) -> Vec<PathBuf> {
        match self {
            Self::Builtin(_) => Vec::new(),
            Self::Path(path) if path.is_dir() => {
                std::fs::read_dir(path).into_iter().flatten().flatten().map(|entry| entry.path()).collect()
            }
            Self::Path(path) => vec![path.clone()],
        }
    }
}

/// Wrong usage: a name that is not built in, or numbers behind it that make no sense.
fn unknown(name: &str, known: &[&[(&str, &str)]]) -> Usage {
    let forms: Vec<&str> = known.iter().copied().flatten().map(|(name, _)| *name).collect();
    let (kind, numbers) = name.split_once(':').map_or((name, None), |(kind, numbers)| (kind, Some(numbers)));
    let form = forms.iter().find(|form| bare_name(form) == kind);
    match (form, numbers) {
        (Some(form), Some(numbers)) if form.contains('[') => {
            let range = range(kind).map_or(String::new(), |range| format!(", {range}"));
            Usage(format!("'{numbers}' does not fit builtin:{kind}: it is typed builtin:{form}{range}"))
        }
        (Some(_), Some(_)) => Usage(format!("builtin:{kind} takes no numbers: give builtin:{kind}")),
        _ => {
            let bare: Vec<&str> = forms.iter().map(|form| bare_name(form)).collect();
            // Numbers may have been set off by something else.
            let kind = kind.trim().split([' ', ',', '=', '(']).next().unwrap_or(kind);
            let meant =
                mistake::nearest(kind, &bare).map_or(String::new(), |name| format!("; did you mean builtin:{name}?"));
            let there_are = if meant.is_empty() { format!("; there are {}", forms.join(", ")) } else { meant };
            Usage(format!("there is no 'builtin:{name}'{there_are}"))
        }
    }
}

/// What the numbers behind the name of a light may be.
fn range(kind: &str) -> Option<&'static str> {
    match kind {
        "constant" | "hemisphere" => Some("radiance from 0 on"),
        "cone" => Some("a half angle from 0 to 90 degrees"),
        "sphere" => Some("a distance from 1 on"),
        "sky" => Some("the sun from 1 to 90 degrees above the horizon"),
        _ => None,
    }
}

/// A built-in name without the numbers that may follow it.
fn bare_name(form: &str) -> &str {
    form.split('[').next().unwrap_or(form)
}

/// Fails where it shows beforehand that `path` is no file of the wanted kind.
fn check_kind(path: &Path, wanted: Kind, known: &[&[(&str, &str)]]) -> Result<()> {
    let names: Vec<&str> = known.iter().copied().flatten().map(|(form, _)| bare_name(form)).collect();
    match mistake::about(path, wanted, &names) {
        // A file that is missing, or not what its name says, is a failure, as it is to every other reader of files.
        Some(text) if !path.exists() || Kind::of(path) == Some(wanted) => anyhow::bail!(text),
        Some(text) => Err(Usage(text).into()),
        None => Ok(()),
    }
}

/// The scene that a command works on.
#[derive(Debug, clap::Args)]
pub(crate) struct SceneOptions {
    /// A scene: .gltf, .glb, .obj, or builtin:NAME.
    #[arg(value_name = "SCENE", value_parser = scene)]
    scene: SceneSource,
}

impl SceneOptions {
    /// What is typed to bake this scene.
    pub(crate) fn bake_command(&self) -> String {
        let name = self.scene.name();
        format!("relume bake {name} -o {}.prt", self.scene.stem())
    }

    /// Loads the scene and tells what was mended.
    pub(crate) fn load(&self, console: &Console) -> Result<Scene> {
        self.scene.load(console)
    }

    /// The files that this reads.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        self.scene.files()
    }
}

/// A scene that is not loaded yet.
#[derive(Debug, Clone)]
pub(crate) struct SceneSource(Source);

/// Parses the name of a scene.
pub(crate) fn scene(text: &str) -> Result<SceneSource, std::convert::Infallible> {
    parse(text).map(SceneSource)
}

impl SceneSource {
    /// The scene as the user named it.
    pub(crate) fn name(&self) -> String {
        self.0.name()
    }

    /// A name for what is made of it.
    pub(crate) fn stem(&self) -> String {
        let name = Path::new(match &self.0 {
            Source::Path(path) => path.as_os_str(),
            Source::Builtin(name) => name.as_ref(),
        });
        name.file_stem().unwrap_or_default().display().to_string()
    }

    /// The files that this reads.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        self.0.files()
    }

    /// Loads the scene and tells what was mended.
    pub(crate) fn load(&self, console: &Console) -> Result<Scene> {
        let known = [scene::BUILTINS, scene::PAPER_SCENES];
        if let Source::Path(path) = &self.0 {
            check_kind(path, Kind::Scene, &known)?;
        }
        let scene = relume::load_scene(self.0.path()).map_err(|error| explained(error, &known))?;
        for warning in &scene.report.warnings {
            console.notice(&format!("warning: {}: {}", warning.object, warning.message));
        }
        let triangles: usize = scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum();
        console.detail(&format!("{}: {} meshes, {triangles} triangles", scene.name, scene.meshes.len()));
        Ok(scene)
    }
}

/// How a light probe is read.
#[derive(Debug, clap::Args)]
pub(crate) struct ReadOptions {
    /// How the probe's picture is unrolled; found out by default.
    #[arg(long, value_enum)]
    layout: Option<LayoutName>,
    /// What to do with negative pixels.
    #[arg(long, value_enum, default_value_t = NegativesName::Refuse)]
    negatives: NegativesName,
    /// What to do with pixels that are infinite or not a number.
    #[arg(long, value_enum, value_name = "CHOICE", default_value_t = NonFiniteName::Refuse)]
    nonfinite: NonFiniteName,
    /// The part or layer of an OpenEXR file; the plain colours, or the layer called as them, by default.
    #[arg(long, value_name = "NAME")]
    layer: Option<String>,
}

/// The light of a command that draws.
#[derive(Debug, clap::Args)]
pub(crate) struct ProbeOptions {
    /// The light: .hdr, .exr, a folder of six faces, or builtin:NAME.
    #[arg(long, value_name = "PROBE", value_parser = probe, help_heading = "Light probe")]
    probe: ProbeSource,
    #[command(flatten, next_help_heading = "Light probe")]
    read: ReadOptions,
}

impl ProbeOptions {
    pub(crate) fn load(&self, console: &Console) -> Result<Environment> {
        self.probe.load(&self.read, console)
    }

    /// The files that this reads.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        self.probe.files()
    }

    /// The probe as the user named it.
    pub(crate) fn name(&self) -> String {
        self.probe.name()
    }
}

/// A light probe that is not loaded yet.
#[derive(Debug, Clone)]
pub(crate) struct ProbeSource(Source);

/// Parses the name of a light probe.
pub(crate) fn probe(text: &str) -> Result<ProbeSource, std::convert::Infallible> {
    parse(text).map(ProbeSource)
}

impl ProbeSource {
    /// The probe as the user named it.
    pub(crate) fn name(&self) -> String {
        self.0.name()
    }

    /// The files that this reads.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        self.0.files()
    }

    /// Loads the probe and tells what was changed in it.
    pub(crate) fn load(&self, read: &ReadOptions, console: &Console) -> Result<Environment> {
        let known = [probe_io::BUILTINS];
        if let Source::Path(path) = &self.0 {
            check_kind(path, Kind::Probe, &known)?;
        }
        let negatives = match read.negatives {
            NegativesName::Refuse => Negatives::Refuse,
            NegativesName::Clamp => Negatives::Clamp,
        };
        let non_finite = match read.nonfinite {
            NonFiniteName::Refuse => NonFinite::Refuse,
            NonFiniteName::Clamp => NonFinite::Clamp,
        };
        let layout = read.layout.map(Layout::from);
        let options = LoadOptions { layout, negatives, non_finite, layer: read.layer.clone() };
        let (environment, warnings) =
            relume::load_light_probe_with(self.0.path(), &options).map_err(|error| explained(error, &known))?;
        for warning in warnings {
            console.notice(&format!("warning: {warning}"));
        }
        Ok(environment)
    }
}

/// The error with the names that there are, or with the option that helps.
fn explained(error: relume::Error, known: &[&[(&str, &str)]]) -> anyhow::Error {
    match error {
        relume::Error::UnknownBuiltin { name, .. } => unknown(&name, known).into(),
        relume::Error::LightProbe(error @ probe_io::Error::NotFinite { .. }) => {
            anyhow::anyhow!("{error} (--nonfinite clamp)")
        }
        other => other.into(),
    }
}

/// The layouts by the names that are typed.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum LayoutName {
    /// Longitude by latitude, twice as wide as high.
    Equirect,
    /// Debevec's angular map.
    Angular,
    /// OpenEXR's strip of six faces.
    ExrCube,
    /// Cross of 3 by 4 tiles.
    VerticalCross,
    /// Cross of 4 by 3 tiles.
    HorizontalCross,
    /// Six faces px, nx, py, ny, pz, nz from top to bottom.
    Faces,
}

impl From<LayoutName> for Layout {
    fn from(name: LayoutName) -> Self {
        match name {
            LayoutName::Equirect => Self::Equirect,
            LayoutName::Angular => Self::Angular,
            LayoutName::ExrCube => Self::ExrCube,
            LayoutName::VerticalCross => Self::VerticalCross,
            LayoutName::HorizontalCross => Self::HorizontalCross,
            LayoutName::Faces => Self::Faces,
        }
    }
}

/// What to do with negative pixels.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum NegativesName {
    /// End with an error.
    Refuse,
    /// Set them to 0 and say so.
    Clamp,
}

/// What to do with pixels that are infinite or not a number.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum NonFiniteName {
    /// End with an error.
    Refuse,
    /// Infinite ones become the largest finite value, NaN the mean of its neighbours; say so.
    Clamp,
}

/// Fails where it shows beforehand that `path` is no baked file.
pub(crate) fn check_baked(path: &Path) -> Result<()> {
    check_kind(path, Kind::Baked, &[])
}

/// What is typed to draw a baked file under a light.
pub(crate) fn render_command(path: &Path, probe: &str) -> String {
    format!("relume render {} --probe {probe} -o {}", path.display(), path.with_extension("png").display())
}

/// Reads a baked file.
pub(crate) fn prt(path: &Path) -> Result<Prt> {
    check_baked(path)?;
    Ok(relume::load_prt(path)?)
}

/// Parses a number of bands that the harmonics support.
pub(crate) fn bands(text: &str) -> Result<Bands, String> {
    let bands = text.parse().ok().and_then(Bands::new);
    bands.ok_or_else(|| format!("give a number of bands from 1 to {}", Bands::MAX))
}
