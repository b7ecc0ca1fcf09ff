//! Says so where no light of a probe gets into a scene.

use crate::console::Console;
use coeff_io::Plan;
use scene::{Mesh, Scene};

/// Largest share of the sky that the receivers looked at may see on average where a scene counts as closed.
const CLOSED: f32 = 5e-4;

/// Warns where no receiver that the plan looked at sees the sky.
pub(crate) fn tell(scene: &Scene, plan: &Plan, console: &Console) {
    if let Some(text) = warning(scene, plan) {
        console.notice(&text);
    }
}

fn warning(scene: &Scene, plan: &Plan) -> Option<String> {
    let survey = &plan.survey;
    // Where some receivers are open without a ray the scene is not closed.
    let all = plan.shadowed_receivers >= plan.receivers;
    if survey.receivers == 0 || !all || 1.0 - survey.coverage[0] > CLOSED {
        return None;
    }
    let size = |mesh: &&Mesh| mesh.bounds().map_or(0.0, |bounds| bounds.radius());
    let largest = scene.meshes.iter().max_by(|a, b| size(a).total_cmp(&size(b)))?;
    let name = if largest.name.is_empty() { "the largest mesh" } else { &largest.name };
    Some(format!(
        "warning: {name}: encloses the scene, and none of {} receivers looked at sees the sky, so a light probe lights nothing; open it, \
         or take it out where it stands for the sky",
        survey.receivers
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(name: &str) -> Option<String> {
        let scene = scene::builtin(name).expect("a builtin");
        let plan = ::bake::plan(&scene, &::bake::settings::preview()).expect("it plans");
        warning(&scene, &plan)
    }

    #[test]
    fn a_closed_room_is_told_by_name() {
        let text = told("closed-room").expect("a warning");
        assert!(text.starts_with("warning: room: encloses the scene"), "{text}");
    }

    #[test]
    fn a_closed_room_is_told_by_name_can_fail() {
        assert_eq!(told("cornell-box"), None, "light comes in through its front");
        assert_eq!(told("plane"), None);
        assert_eq!(told("two-rooms"), None, "one of them is open");
    }
}
