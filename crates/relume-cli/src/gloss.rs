//! The options of transfer textures and gloss.

use bake::Compression;

/// How transfer textures and gloss are baked, as typed.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct GlossOptions {
    /// Whether each object has a transfer texture of its own, or all share what their coordinates allow.
    #[arg(long, value_enum, default_value_t = SheetSet::Object)]
    pub(crate) sheets: SheetSet,
    /// Leaves out the lower levels of detail of transfer textures.
    #[arg(long)]
    pub(crate) no_levels: bool,
    /// Puts rows of transfer and visibility into clusters (clustered PCA), with this relative error at most; none keeps them as they are.
    #[arg(long, value_name = "E", value_parser = share, allow_negative_numbers = true)]
    pub(crate) compress: Option<f32>,
    /// Error allowed to the clusters of glossy bounces that can be relit, relative to all that is mirrored; 0 keeps them whole.
    #[arg(long, value_name = "E", default_value_t = Compression::default().bounces, value_parser = share_or_none,
          allow_negative_numbers = true)]
    pub(crate) bounce_error: f32,
}

/// How many sheets there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum SheetSet {
    /// One for each mesh, by its share of the area.
    Object,
    /// As few as the coordinates allow.
    Scene,
}

impl GlossOptions {
    /// The compression asked for.
    pub(crate) fn compression(&self) -> Compression {
        Compression { rows: self.compress, bounces: self.bounce_error }
    }

    /// The first option of transfer textures alone that was typed.
    pub(crate) fn typed_of_textures(&self) -> Option<&'static str> {
        let options = [("--sheets", self.sheets != SheetSet::Object), ("--no-levels", self.no_levels)];
        options.into_iter().find(|(_, is_typed)| *is_typed).map(|(name, _)| name)
    }
}

fn share_or_none(text: &str) -> Result<f32, String> {
    if crate::settings::share(text) == Some(0.0) {
        Ok(0.0)
    } else {
        share(text).map_err(|what| format!("{what}, or 0"))
    }
}

fn share(text: &str) -> Result<f32, String> {
    match crate::settings::share(text) {
        Some(value) if (1e-4..=1.0).contains(&value) => Ok(value),
        _ => Err("give a relative error from 0.0001 to 1, such as 0.02 or 2%".into()),
    }
}
