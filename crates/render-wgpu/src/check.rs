//! Whether a scene is sound: every index in range, every array of the right length.

use crate::Error;
use coeff_io::{Material, Prt};

/// Fails on the first contradiction; what passes can be uploaded and drawn without further looks.
pub(crate) fn check(prt: &Prt) -> Result<(), Error> {
    check_attributes(prt)?;
    check_transfer(prt)?;
    check_meshes(prt)?;
    if let Some(fault) = prt.maps.as_ref().and_then(|maps| maps.fault(prt)) {
        return Err(Error::invalid("the file", format!("{fault}; bake the scene again")));
    }
    if let Some(fault) = prt.surfaces_fault() {
        return Err(Error::invalid("the file", format!("{fault}; bake the scene again")));
    }
    for texture in &prt.textures {
        if texture.rgba.len() as u64 != u64::from(texture.width) * u64::from(texture.height) {
            let problem = format!("{} texels do not fill {}x{}", texture.rgba.len(), texture.width, texture.height);
            return Err(Error::invalid(format!("texture {}", texture.name), problem));
        }
    }
    prt.materials.iter().try_for_each(|material| check_material(prt, material))
}

fn check_attributes(prt: &Prt) -> Result<(), Error> {
    let geometry = &prt.geometry;
    let vertices = geometry.positions.len();
    let lengths = [
        ("tangents", geometry.tangents.len()),
        ("uv0", geometry.uv0.len()),
        ("uv1", geometry.uv1.len()),
        ("colors", geometry.colors.len()),
        ("openness", prt.transfer.openness.len()),
    ];
    if geometry.normals.len() != vertices {
        let problem = format!("{vertices} positions but {} normals; bake the scene again", geometry.normals.len());
        return Err(Error::invalid("the geometry", problem));
    }
    match lengths.iter().find(|(_, length)| *length != 0 && *length != vertices) {
        Some((name, length)) => {
            let problem = format!("{vertices} positions but {length} {name}; bake the scene again");
            Err(Error::invalid("the geometry", problem))
        }
        None => Ok(()),
    }
}

fn check_transfer(prt: &Prt) -> Result<(), Error> {
    let transfer = &prt.transfer;
    let wrong = |problem| Err(Error::invalid("the transfer", problem));
    if transfer.channels != 1 && transfer.channels != 3 {
        return wrong(format!("{} channels, not 1 or 3", transfer.channels));
    }
    let per_vertex = u64::from(transfer.bands).pow(2) * u64::from(transfer.channels);
    let expected = prt.geometry.positions.len() as u64 * per_vertex;
    if transfer.bands == 0 || transfer.values.len() as u64 != expected {
        return wrong(format!("{} values where {expected} are due; bake the scene again", transfer.values.len()));
    }
    Ok(())
}

fn check_meshes(prt: &Prt) -> Result<(), Error> {
    let vertices = prt.geometry.positions.len() as u64;
    let triangles = prt.geometry.triangles.len() as u64;
    if prt.geometry.triangles.as_flattened().iter().any(|&index| u64::from(index) >= vertices) {
        return Err(Error::invalid(
            "the geometry",
            format!("a triangle names a vertex beyond the {vertices} there are"),
        ));
    }
    for mesh in &prt.meshes {
        let wrong = |problem: String| Err(Error::invalid(format!("mesh {}", mesh.name), problem));
        if mesh.material as usize >= prt.materials.len() {
            return wrong(format!("material {} of {}", mesh.material, prt.materials.len()));
        }
        if u64::from(mesh.first_triangle) + u64::from(mesh.triangles) > triangles {
            return wrong(format!("its triangles run past the {triangles} there are"));
        }
    }
    Ok(())
}

fn check_material(prt: &Prt, material: &Material) -> Result<(), Error> {
    let slots = [
        material.base_color_texture,
        material.metallic_roughness_texture,
        material.normal_texture,
        material.emissive_texture,
    ];
    match slots.into_iter().flatten().find(|slot| slot.texture as usize >= prt.textures.len() || slot.uv_set > 1) {
        Some(slot) => {
            let problem = format!("texture {} of {}, coordinates {}", slot.texture, prt.textures.len(), slot.uv_set);
            Err(Error::invalid(format!("material {}", material.name), problem))
        }
        None => Ok(()),
    }
}
