//! What there is to say of bounces that faded slowly.

use coeff_io::{Achieved, Prt};
use std::collections::BTreeMap;

/// Albedo from which a material is named where light fades slowly: plaster and snow reflect nine tenths.
const WHITE: f32 = 0.95;
/// Materials named.
const NAMED: usize = 3;

/// That the tail of the bounces was summed, what may be missing, and whose albedo is nearly 1; none where bounces ended by themselves.
pub(crate) fn warning(prt: &Prt) -> Option<String> {
    let text = summed(&prt.achieved)?;
    let white = white(prt);
    let names: Vec<String> =
        white.iter().take(NAMED).map(|(name, albedo)| format!("'{}' ({albedo:.2})", name.escape_debug())).collect();
    let more = white.len().saturating_sub(NAMED);
    Some(match (names.is_empty(), more) {
        (true, _) => format!("warning: light fades slowly between the surfaces: {text}"),
        (false, 0) => format!("warning: materials of albedo near 1 keep light in: {}; {text}", names.join(", ")),
        (false, n) => {
            format!("warning: materials of albedo near 1 keep light in: {} and {n} more; {text}", names.join(", "))
        }
    })
}

/// How many bounces were simulated, and what may be missing; none where bounces ended by themselves.
pub(crate) fn summed(achieved: &Achieved) -> Option<String> {
    let left = achieved.remainder?;
    let missing = match 100.0 * left {
        share if share < 0.01 => "less than 0.01 %".into(),
        share if share < 100.0 => format!("at most {share:.2} %"),
        _ => "an unknown share".into(),
    };
    let bounces = achieved.bounces;
    Some(format!(
        "{bounces} bounces were simulated and the rest summed in closed form; {missing} of an open receiver's light is missing"
    ))
}

/// Materials of which a vertex has an albedo of nearly 1 in some channel, with the largest.
fn white(prt: &Prt) -> Vec<(&str, f32)> {
    let mut largest: BTreeMap<u32, f32> = BTreeMap::new();
    for mesh in &prt.meshes {
        let own = prt.transfer.albedo.iter().skip(mesh.first_vertex as usize).take(mesh.vertices as usize);
        let most = largest.entry(mesh.material).or_insert(0.0);
        *most = own.flatten().copied().fold(*most, f32::max);
    }
    let white = largest.into_iter().filter(|&(_, albedo)| albedo >= WHITE);
    white.filter_map(|(m, albedo)| Some((prt.materials.get(m as usize)?.name.as_str(), albedo))).collect()
}
