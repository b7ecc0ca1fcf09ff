//! What a thread keeps between receivers.

use crate::foresight::Choice;
use crate::transmittance::Crossings;
use glam::Vec3;
use raytrace::{FanState, Hit};

/// Buffers that a thread keeps between receivers. Contents never change results.
pub(crate) struct Worker {
    pub(super) fan: FanState,
    /// Where the rays of the receiver start.
    pub(super) origin: Vec3,
    /// World directions of the set, and those of them that a step traces.
    pub(super) directions: [Vec<f32>; 3],
    pub(super) traced: [Vec<f32>; 3],
    /// What the traced directions met: a bit each.
    pub(super) met: Vec<u64>,
    pub(super) choice: Choice,
    /// 1 where a direction is blocked, 0 where it is open.
    pub(super) blocked: Vec<u8>,
    /// What each direction adds to the open sum.
    pub(super) open: Vec<f32>,
    pub(super) wanted: Vec<u64>,
    pub(super) nearest: Vec<Option<Hit>>,
    /// What translucent surfaces pass of the traced rays, and of each channel what `open` is of their mean.
    pub(super) passed: Vec<Vec3>,
    pub(super) tints: [Vec<f32>; 3],
    pub(super) crossings: Crossings,
}

impl Worker {
    pub(crate) fn new() -> Self {
        Self {
            fan: FanState::default(),
            origin: Vec3::ZERO,
            directions: Default::default(),
            traced: Default::default(),
            met: Vec::new(),
            choice: Choice::default(),
            blocked: Vec::new(),
            open: Vec::new(),
            wanted: Vec::new(),
            nearest: Vec::new(),
            passed: Vec::new(),
            tints: Default::default(),
            crossings: Crossings::default(),
        }
    }
}
