//! Probes inside of bodies take the light of those beside them.

use super::BORROWED;
use coeff_io::{Node, Volume};
use std::collections::BTreeMap;

/// Ring by ring, gives every probe of validity 0 the mean of the values that its neighbours along edges of cells have by then; it counts
/// little.
pub(super) fn spread(volume: &mut Volume) {
    let mut rest = neighbours(volume);
    let len = volume.values.len() / volume.validity.len();
    while !rest.is_empty() {
        let ring: Vec<(u32, Vec<f32>)> = rest
            .iter()
            .filter_map(|(&probe, around)| {
                let sound: Vec<u32> = around.iter().copied().filter(|&n| volume.validity[n as usize] > 0.0).collect();
                (!sound.is_empty()).then(|| (probe, mean(volume, &sound, len)))
            })
            .collect();
        if ring.is_empty() {
            return;
        }
        for (probe, values) in ring {
            rest.remove(&probe);
            volume.validity[probe as usize] = BORROWED;
            volume.values[probe as usize * len..][..len].copy_from_slice(&values);
        }
    }
}

fn mean(volume: &Volume, probes: &[u32], len: usize) -> Vec<f32> {
    let mut mean = vec![0.0f32; len];
    for &probe in probes {
        let values = &volume.values[probe as usize * len..][..len];
        mean.iter_mut().zip(values).for_each(|(sum, value)| *sum += value / probes.len() as f32);
    }
    mean
}

/// Of every probe of validity 0 those at the other ends of the edges of its cells.
fn neighbours(volume: &Volume) -> BTreeMap<u32, Vec<u32>> {
    let mut all: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for node in &volume.nodes {
        let Node::Leaf(corners) = node else { continue };
        for (part, &probe) in corners.iter().enumerate() {
            if volume.validity[probe as usize] == 0.0 {
                all.entry(probe).or_default().extend([1, 2, 4].map(|bit| corners[part ^ bit]));
            }
        }
    }
    for around in all.values_mut() {
        around.sort_unstable();
        around.dedup();
    }
    all
}
