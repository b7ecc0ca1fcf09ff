//! Irradiance volumes: what arrives at probes in space, for objects that move. \[N\] section 1.9.

mod dilation;
mod grid;
mod layout;
mod octahedron;
mod overlap;
mod settings;
mod sight;
mod tree;

pub use settings::{VolumePlace, VolumeSettings, VolumeSteps};

use crate::Error;
use crate::arrival::{Arrivals, to_irradiance};
use crate::domain::Domain;
use crate::extras::Done;
use crate::gather::Worker;
use crate::plan::allowed;
use crate::progress::Stage;
use crate::receivers::Receiver;
use coeff_io::{Effect, Prt, Volume};
use glam::Vec3;
use layout::{Layout, Room};
use rayon::prelude::*;
use raytrace::FanState;
use sh_math::Bands;
use sight::{Sight, Stand};
use std::sync::atomic::{AtomicU64, Ordering};

pub(crate) use layout::check;

/// Bands over normals.
const BANDS: u32 = 3;
/// Diagonals of a cell of the coarsest level that distances tell.
const REACH: f32 = 1.5;
/// Validity of a probe that shows its neighbours' light: it counts where there is nothing else.
const BORROWED: f32 = 0.01;

/// Bakes a volume; a probe's light is a pure function of the scene, the settings and the probe's number.
pub(crate) fn bake(done: &Done<'_>, settings: &VolumeSettings, prt: &mut Prt) -> Result<Volume, Error> {
    let world = done.gatherer.world;
    let room = Room::of(done.plan, done.settings, done.receivers.list.len(), done.light.is_some());
    let layout = Layout::of(done.scene, world, settings, room)?;
    let functions = Bands::new(BANDS).expect("three bands");
    let bank = done.bank(Domain::Sphere, functions);
    let arrivals = done.arrivals(&bank, functions);
    let mut volume = empty(done, &layout, &arrivals, settings);
    let sight = Sight::new(world, settings.resolution, volume.reach);
    let probes = Probes {
        sight: allowed(done.settings, Effect::Visibility).then_some(&sight),
        arrivals: &arrivals,
        layout: &layout,
        done,
    };
    let [visibility, bounce] = probes.fill(&mut volume)?;
    prt.achieved.visibility_rays += visibility;
    prt.achieved.bounce_rays += bounce;
    dilation::spread(&mut volume);
    Ok(volume)
}

/// A volume without light.
fn empty(done: &Done<'_>, layout: &Layout, arrivals: &Arrivals<'_>, settings: &VolumeSettings) -> Volume {
    let probes = layout.tree.probes.len();
    let texels = settings.resolution as usize * settings.resolution as usize;
    let reach = layout.reach();
    Volume {
        origin: layout.grid.origin.to_array(),
        spacing: layout.grid.spacing.to_array(),
        cells: layout.grid.cells,
        nodes: layout.tree.nodes.clone(),
        light: done.map_light(),
        channels: arrivals.shape().channels as u32,
        values: vec![0.0; probes * arrivals.shape().len()],
        positions: layout.tree.probes.iter().map(|probe| layout.grid.point(probe.place).to_array()).collect(),
        validity: vec![1.0; probes],
        distances: [reach, reach * reach].repeat(probes * texels),
        resolution: settings.resolution,
        reach,
    }
}

/// All that a probe needs.
struct Probes<'a> {
    /// None where nothing blocks light.
    sight: Option<&'a Sight<'a>>,
    arrivals: &'a Arrivals<'a>,
    layout: &'a Layout,
    done: &'a Done<'a>,
}

/// Where the results of a probe go.
struct Slot<'a> {
    values: &'a mut [f32],
    distances: &'a mut [f32],
    position: &'a mut [f32; 3],
    validity: &'a mut f32,
}

impl Probes<'_> {
    /// Fills in all probes; returns the any-hit and the closest-hit rays.
    fn fill(&self, volume: &mut Volume) -> Result<[u64; 2], Error> {
        let total = volume.positions.len() as u64;
        let monitor = self.done.monitor;
        monitor.begin(Stage::Probes, total);
        let texels = (volume.resolution * volume.resolution) as usize;
        let (values, distances) = (&mut volume.values, &mut volume.distances);
        let arrays = values.par_chunks_mut(self.arrivals.shape().len()).zip(distances.par_chunks_mut(2 * texels));
        let places = volume.positions.par_iter_mut().zip(&mut volume.validity);
        let slots = arrays.zip(places).enumerate();
        let all = [AtomicU64::new(0), AtomicU64::new(0)];
        slots.for_each_init(
            || (Worker::new(), FanState::new()),
            |(worker, fan), (number, ((values, distances), (position, validity)))| {
                if !monitor.is_cancelled() {
                    let rays = self.probe(number, Slot { values, distances, position, validity }, worker, fan);
                    all.iter().zip(rays).for_each(|(all, rays)| {
                        all.fetch_add(rays, Ordering::Relaxed);
                    });
                    monitor.receiver_done(Stage::Probes, total, rays[0] + rays[1]);
                }
            },
        );
        monitor.check()?;
        Ok(all.map(AtomicU64::into_inner))
    }

    /// Fills in one probe; returns the any-hit and the closest-hit rays that it took.
    fn probe(&self, number: usize, slot: Slot<'_>, worker: &mut Worker, fan: &mut FanState) -> [u64; 2] {
        let mut rays = 0;
        if let Some(sight) = self.sight {
            let edges = self.layout.grid.edges(self.layout.tree.probes[number].level);
            let Stand { at, view } = sight.stand(Vec3::from_array(*slot.position), edges, fan, &mut rays);
            *slot.position = at.to_array();
            *slot.validity = view.validity();
            slot.distances.copy_from_slice(&view.distances);
            if *slot.validity == 0.0 {
                return [0, rays];
            }
        }
        let arrival = self.arrivals.at(&in_space(Vec3::from_array(*slot.position)), number as u32, worker);
        slot.values.copy_from_slice(&arrival.values);
        to_irradiance(slot.values, self.arrivals.shape());
        [arrival.visibility_rays, rays + arrival.bounce_rays]
    }
}

/// A receiver that belongs to no surface.
fn in_space(at: Vec3) -> Receiver {
    Receiver {
        position: at,
        vertex: at,
        normal: Vec3::Y,
        geometric_normal: Vec3::ZERO,
        sound: true,
        dark: false,
        rounding: 0.0,
    }
}
