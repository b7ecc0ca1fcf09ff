//! A look with few bands and few rays, by which edges to split are found.

use crate::directions::DirectionBank;
use crate::gather::Gatherer;
use crate::settings;
use crate::world::World;
use coeff_io::{Quality, Settings};
use sh_math::Bands;

/// Bands of the look: what decides is where light can come from, not its detail.
const BANDS: u32 = 3;
/// Rays of the look.
const RAYS: u32 = 64;

/// The directions of the look.
pub(crate) struct QuickLook {
    pub(crate) bank: DirectionBank,
    pub(crate) bands: Bands,
}

impl QuickLook {
    /// The same for any seed that a bake is asked for: seeds are compared receiver by receiver.
    pub(crate) fn new() -> Self {
        let bands = Bands::new(BANDS).expect("a constant in range");
        let quality = Quality::Rays(RAYS);
        let bank = DirectionBank::new(bands, &Settings { bands: BANDS, quality, ..settings::standard() });
        Self { bank, bands }
    }

    /// Looks at the light of the sky among the surfaces of a world.
    pub(crate) fn gatherer<'a>(&'a self, world: &'a World<'a>) -> Gatherer<'a> {
        Gatherer::of_direct_light(world, &self.bank, self.bands, Quality::Rays(RAYS))
    }
}
