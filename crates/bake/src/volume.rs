//! Irradiance volumes.

use crate::Error;
use crate::extras::Done;
use coeff_io::Volume;

/// What volume is wanted.
#[derive(Debug, Clone)]
pub struct VolumeSettings {}

pub(crate) fn bake(_done: &Done<'_>, _settings: &VolumeSettings) -> Result<Volume, Error> {
    Err(Error::Cancelled)
}
