//! Whether the cells, probes and numbers of an irradiance volume agree.

use crate::table::Kind;
use crate::validate::{Check, LARGEST_SIDE};
use crate::volume::{DEEPEST, FUNCTIONS};
use crate::{Error, Node, Volume};

impl Check<'_> {
    /// Everything of a volume.
    pub(crate) fn volume(&self, volume: &Volume) -> Result<(), Error> {
        self.light(&volume.light, "the volume")?;
        self.header(matches!(volume.channels, 1 | 3), || {
            format!("the volume has {} channels: there must be 1 or 3", volume.channels)
        })?;
        self.placement(volume)?;
        self.probes(volume)?;
        self.nodes(volume)
    }

    fn placement(&self, volume: &Volume) -> Result<(), Error> {
        let far = (0..3).all(|i| (volume.origin[i] + volume.spacing[i] * volume.cells[i] as f32).is_finite());
        let sound = volume.origin.iter().all(|v| v.is_finite())
            && volume.spacing.iter().all(|v| v.is_finite() && *v > 0.0)
            && volume.cells.iter().all(|n| (1..=LARGEST_SIDE).contains(n));
        self.header(sound && far, || "the volume has no place, no size or no cells".into())?;
        let told = volume.reach.is_finite() && volume.reach >= 0.0 && volume.resolution <= LARGEST_SIDE;
        self.header(told, || "the distances of the volume have no reach or too many texels".into())
    }

    /// Lengths and numbers of what is held per probe.
    fn probes(&self, volume: &Volume) -> Result<(), Error> {
        let probes = volume.positions.len() as u64;
        // Below 2^32 probes, 2^6 functions and channels, 2^15 coefficients: no overflow.
        let values = (FUNCTIONS as u64) * volume.light.depth() as u64 * u64::from(volume.channels);
        let texels = u64::from(volume.resolution).pow(2) * 2;
        let few = probes > 0 && probes < u64::from(u32::MAX);
        self.require(few, Kind::VolumePositions, 0, || format!("the volume has {probes} probes"))?;
        let lengths = [
            (Kind::VolumeValues, volume.values.len(), values),
            (Kind::VolumeValidity, volume.validity.len(), 1),
            (Kind::VolumeDistances, volume.distances.len(), texels),
        ];
        for (kind, length, each) in lengths {
            self.require(length as u64 == probes * each, kind, 0, || {
                format!("chunk {kind} has {length} numbers for {probes} probes with {each} each")
            })?;
        }
        let finite = |v: &f32| v.is_finite();
        let share = |v: &f32| (0.0..=1.0).contains(v);
        self.each(Kind::VolumePositions, volume.positions.as_flattened(), finite, "no finite position")?;
        self.each(Kind::VolumeValues, &volume.values, finite, "no finite coefficient")?;
        self.each(Kind::VolumeValidity, &volume.validity, share, "no validity between 0 and 1")?;
        self.each(Kind::VolumeDistances, &volume.distances, |v| v.is_finite() && *v >= 0.0, "no distance")
    }

    /// The cells form trees: parts lie behind their parent, every eight have just one, and none is deeper than [`DEEPEST`].
    fn nodes(&self, volume: &Volume) -> Result<(), Error> {
        let nodes = &volume.nodes;
        let coarse: u64 = volume.cells.iter().map(|n| u64::from(*n)).product();
        let total = nodes.len() as u64;
        let sound = coarse <= total && (total - coarse).is_multiple_of(8) && total < u64::from(u32::MAX);
        self.require(sound, Kind::VolumeNodes, 0, || {
            format!("the volume has {total} cells, of which {coarse} are coarse")
        })?;
        let coarse = coarse as usize;
        // Of every eight parts their level; 0 while no cell was split into them.
        let mut levels = vec![0_u8; (nodes.len() - coarse) / 8];
        for (i, node) in nodes.iter().enumerate() {
            let level = i.checked_sub(coarse).map_or(0, |part| levels[part / 8]);
            let fits = (i < coarse || level > 0)
                && match *node {
                    Node::Leaf(probes) => probes.iter().all(|probe| (*probe as usize) < volume.positions.len()),
                    Node::Split(first) => {
                        let first = first as usize;
                        let parts = first.checked_sub(coarse).filter(|from| from % 8 == 0).map(|from| from / 8);
                        let free = first > i && level < DEEPEST;
                        match parts.and_then(|parts| levels.get_mut(parts)).filter(|level| free && **level == 0) {
                            Some(part) => {
                                *part = level + 1;
                                true
                            }
                            None => false,
                        }
                    }
                };
            self.require(fits, Kind::VolumeNodes, i * 32, || {
                format!("cell {i} of the volume belongs to none, has parts that cannot be its own, or a probe that does not exist")
            })?;
        }
        Ok(())
    }
}
