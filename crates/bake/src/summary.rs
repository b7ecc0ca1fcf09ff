//! What a bake reached, over all receivers of the file.

use crate::repair::Repair;
use coeff_io::Achieved;

/// Enters the errors of receivers below `permanent`, leaving out those whose values are not their own.
pub(crate) fn summarise(repair: &Repair, permanent: usize, errors: &[f32], achieved: &mut Achieved) {
    let mut own = vec![true; permanent];
    repair.targets().for_each(|id| own[id as usize] = false);
    let mut errors: Vec<(f32, u32)> =
        (0..permanent as u32).filter(|&id| own[id as usize]).map(|id| (errors[id as usize], id)).collect();
    errors.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    if let Some(&(worst, id)) = errors.last() {
        let at = |share: f64| errors[((errors.len() - 1) as f64 * share) as usize].0;
        achieved.error = [at(0.5), at(0.95), worst];
        achieved.worst_receiver = id;
    }
}
