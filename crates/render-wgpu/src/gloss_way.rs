//! Which way of the product is taken: by what changed more often, the light or the view.

use coeff_io::GlossWay;
use glam::Quat;
use sh_math::Bands;

/// How often the light changed in the frames so far.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct History {
    last: Option<Quat>,
    /// Frames under the light of the last one, that included.
    frames: u32,
    /// Frames under the light before.
    before: u32,
}

impl History {
    /// Takes note of a frame.
    pub(crate) fn frame(&mut self, rotation: Quat) {
        if self.last == Some(rotation) {
            self.frames = self.frames.saturating_add(1);
        } else {
            self.before = self.frames;
            self.frames = 1;
            self.last = Some(rotation);
        }
    }

    /// Takes note that the light itself was changed.
    pub(crate) fn changed(&mut self) {
        self.last = None;
    }

    /// Frames that a light is expected to stay: as long as it has stayed, or as the one before.
    fn frames_per_light(self) -> f64 {
        f64::from(self.frames.max(self.before).max(1))
    }

    /// The way with the least to do.
    pub(crate) fn cheapest(self, bands: Bands, receivers: u64, drawn: u64) -> GlossWay {
        GlossWay::cheapest(bands, receivers, drawn, self.frames_per_light())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_light_that_stays_is_worth_keeping() {
        let bands = Bands::new(5).unwrap();
        let mut history = History::default();
        let turn = |n: u32| Quat::from_rotation_y(n as f32);
        for n in 0..5 {
            history.frame(turn(n));
            assert_eq!(history.cheapest(bands, 1000, 100), GlossWay::Tpfl, "the light turns with every frame");
        }
        for _ in 0..20 {
            history.frame(turn(9));
        }
        assert_eq!(history.cheapest(bands, 1000, 100), GlossWay::Cache, "it stays");
        history.frame(turn(10));
        assert_eq!(history.cheapest(bands, 1000, 100), GlossWay::Cache, "it may stay as long again");
        history.changed();
        history.frame(turn(10));
        assert_eq!(history.cheapest(bands, 1000, 100), GlossWay::Tpfl, "it did not");
    }
}
