//! Directional light maps.

use crate::Error;
use crate::extras::Done;
use coeff_io::{Maps, Prt};

/// What maps are wanted.
#[derive(Debug, Clone)]
pub struct MapSettings {}

pub(crate) fn bake(_done: &Done<'_>, _settings: &MapSettings, _prt: &Prt) -> Result<Maps, Error> {
    Err(Error::Cancelled)
}
