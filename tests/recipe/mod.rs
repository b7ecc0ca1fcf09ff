//! How the files of `assets/` are made.

pub(crate) mod scene;
pub(crate) mod sky;
