//! What a thread keeps between the fans it traces, so that nothing is allocated for each.

use crate::found::Found;
use crate::group::Directions;
use crate::meetings::Meetings;
use crate::sight::{Occluders, Sights};
use crate::tracer::Tracer;
use glam::Vec3;

/// The working memory of a fan. It changes how fast answers come, never what they are.
#[derive(Debug)]
pub(crate) struct Scratch {
    pub(crate) found: Found,
    pub(crate) meetings: Meetings,
    pub(crate) sights: Sights,
    pub(crate) occluders: Occluders,
    /// What packets have still to visit.
    pub(crate) waiting: Vec<Visit>,
    /// What a ray that goes on alone has still to visit.
    pub(crate) stack: Vec<u32>,
    /// The tree of the last fan.
    serial: u64,
}

/// A child that some rays of a packet have still to visit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Visit {
    pub(crate) rays: u32,
    /// Bits of the child.
    pub(crate) child: u32,
    /// None of the rays enters its box before this parameter.
    pub(crate) near: f32,
}

impl Scratch {
    pub(crate) fn new() -> Scratch {
        Scratch {
            found: Found::new(),
            meetings: Meetings::new(),
            sights: Sights::new(),
            occluders: Occluders::new(),
            waiting: Vec::new(),
            stack: Vec::new(),
            serial: 0,
        }
    }

    /// Makes ready for a fan.
    pub(crate) fn start(&mut self, tracer: &Tracer, directions: &Directions<'_>) {
        let (tree, origin) = (&tracer.tree, directions.origin);
        let same_tree = self.serial == tree.serial;
        if !same_tree {
            self.serial = tree.serial;
            self.occluders.clear();
        }
        // Rays that go on from the origin of the last fan see what it saw.
        let bits = |p: Vec3| p.to_array().map(f32::to_bits);
        if !same_tree || bits(self.sights.origin) != bits(origin) {
            self.sights.start(origin);
            self.sights.under.find(tracer, origin);
        }
        self.sights.under.start(directions);
    }
}
