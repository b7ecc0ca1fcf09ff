//! What a file says of the error between receivers, in words.

use crate::columns::percent;
use coeff_io::{Prt, Refine};

/// Error between receivers from where a mesh that was baked as it is counts as too coarse: 95th percentile, worst.
const COARSE: [f32; 2] = [0.1, 0.3];

/// The error between receivers, and where it is worst; nothing where it was not measured.
pub(crate) fn text(prt: &Prt) -> Option<String> {
    let [median, most, worst] = prt.achieved.interpolation?;
    let place = match prt.achieved.worst_between {
        Some(id) if worst > 0.0 => format!(" {}", crate::bake::place(prt, id)),
        _ => String::new(),
    };
    let [median, most, worst] = [median, most, worst].map(percent);
    Some(format!("median {median}, 95 % below {most}, worst {worst}{place}"))
}

/// A warning where a mesh was baked with triangles too large for its light.
pub(crate) fn warning(prt: &Prt) -> Option<String> {
    let [_, most, worst] = prt.achieved.interpolation?;
    if prt.settings.refine == Refine::Auto || most < COARSE[0] && worst < COARSE[1] {
        return None;
    }
    let mesh = crate::bake::mesh_of(prt, prt.achieved.worst_between?);
    Some(format!(
        "warning: the triangles of '{mesh}' are too large for its light: between its vertices the transfer is off by up to {}; \
         bake with --refine auto (with --time, allow more), or divide it",
        percent(worst)
    ))
}
