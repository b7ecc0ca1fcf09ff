//! Says so where no light of a probe gets into a scene.

use crate::console::Console;
use bake::Price;
use coeff_io::{Prt, Quality};
use relume::Enclosure;
use scene::Scene;

/// Warns where no light of a probe reaches what was baked, or all of it but the mesh around the rest.
pub(crate) fn tell_of_bake(prt: &Prt, console: &Console) {
    if let Some(enclosure) = relume::find_enclosure(prt) {
        console.notice(&text(&enclosure));
    }
}

/// Warns before a bake where one would.
pub(crate) fn tell(scene: &Scene, price: &Price, quality: Quality, console: &Console) {
    if let Some(enclosure) = relume::predict_enclosure(scene, price, quality) {
        console.notice(&text(&enclosure));
    }
}

/// Warns where a picture shows nothing at all.
pub(crate) fn tell_of_picture(linear: &[[f32; 3]], console: &Console) {
    if linear.as_flattened().iter().all(|value| *value <= 0.0) {
        console.notice(
            "warning: the picture is black: no light of the probe reaches what the camera sees; look from elsewhere with --camera, or \
             open or take out the mesh that encloses the scene, which `relume bake` names",
        );
    }
}

fn text(Enclosure { mesh, dark_receivers }: &Enclosure) -> String {
    let name = if mesh.is_empty() { "the largest mesh".into() } else { scene::printable(mesh) };
    format!(
        "warning: {name}: encloses the scene, and {dark_receivers} receivers that were looked at do not see the sky, so a light probe lights next \
         to nothing; open it, or take it out where it stands for the sky"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn enclosing_mesh_is_told_by_name() {
        let text = text(&Enclosure { mesh: "room".into(), dark_receivers: 8 });
        assert!(text.starts_with("warning: room: encloses the scene, and 8 receivers"), "{text}");
        assert!(self::text(&Enclosure { mesh: String::new(), dark_receivers: 8 }).contains("the largest mesh"));
    }
}
