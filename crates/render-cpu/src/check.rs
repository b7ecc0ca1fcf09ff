//! Whether the parts of a baked scene fit each other, before a sample indexes them.

use crate::Error;
use coeff_io::{Geometry, Material, Prt};

/// Checks lengths and indices of everything that drawing reads.
///
/// # Errors
/// [`Error::Prt`] with the part that does not fit.
pub(crate) fn check(prt: &Prt) -> Result<(), Error> {
    let refuse = |what: String| Err(Error::Prt(what));
    check_geometry(&prt.geometry)?;
    let vertices = prt.geometry.positions.len();
    let transfer = &prt.transfer;
    if !(transfer.channels == 1 || transfer.channels == 3) {
        return refuse(format!("the transfer has {} channels, not 1 or 3", transfer.channels));
    }
    let row = (u64::from(transfer.bands).pow(2)).saturating_mul(u64::from(transfer.channels));
    if transfer.values.len() as u64 != row.saturating_mul(vertices as u64) {
        return refuse(format!("{} transfer values for {vertices} vertices of {row}", transfer.values.len()));
    }
    if !(transfer.openness.is_empty() || transfer.openness.len() == vertices) {
        return refuse(format!("openness of {} vertices of {vertices}", transfer.openness.len()));
    }
    check_meshes(prt)?;
    if let Some(fault) = prt.maps.as_ref().and_then(|maps| maps.fault(prt)) {
        return refuse(fault);
    }
    if let Some(fault) = prt.surfaces_fault() {
        return refuse(fault);
    }
    prt.materials.iter().try_for_each(|material| check_slots(material, prt.textures.len()))?;
    match prt.textures.iter().find(|t| t.rgba.len() as u64 != u64::from(t.width) * u64::from(t.height)) {
        Some(t) => refuse(format!("texture `{}` of {} x {} has {} texels", t.name, t.width, t.height, t.rgba.len())),
        None => Ok(()),
    }
}

fn check_geometry(geometry: &Geometry) -> Result<(), Error> {
    let vertices = geometry.positions.len();
    let optional = [
        ("tangents", geometry.tangents.len()),
        ("uv0", geometry.uv0.len()),
        ("uv1", geometry.uv1.len()),
        ("colors", geometry.colors.len()),
    ];
    if geometry.normals.len() != vertices {
        return Err(Error::Prt(format!("{} normals for {vertices} vertices", geometry.normals.len())));
    }
    if let Some((name, length)) = optional.into_iter().find(|&(_, length)| length != 0 && length != vertices) {
        return Err(Error::Prt(format!("{length} {name} for {vertices} vertices")));
    }
    match geometry.triangles.iter().position(|t| t.iter().any(|&v| v as usize >= vertices)) {
        Some(i) => Err(Error::Prt(format!("triangle {i} names a vertex beyond the {vertices} that there are"))),
        None => Ok(()),
    }
}

fn check_meshes(prt: &Prt) -> Result<(), Error> {
    let triangles = prt.geometry.triangles.len() as u64;
    for mesh in &prt.meshes {
        if mesh.material as usize >= prt.materials.len() {
            return Err(Error::Prt(format!(
                "mesh `{}` names material {} of {}",
                mesh.name,
                mesh.material,
                prt.materials.len()
            )));
        }
        if u64::from(mesh.first_triangle) + u64::from(mesh.triangles) > triangles {
            return Err(Error::Prt(format!("mesh `{}` ends beyond the {triangles} triangles", mesh.name)));
        }
    }
    Ok(())
}

fn check_slots(material: &Material, textures: usize) -> Result<(), Error> {
    let slots = [
        &material.base_color_texture,
        &material.metallic_roughness_texture,
        &material.normal_texture,
        &material.emissive_texture,
    ];
    match slots.into_iter().flatten().find(|slot| slot.texture as usize >= textures) {
        Some(slot) => {
            Err(Error::Prt(format!("material `{}` names texture {} of {textures}", material.name, slot.texture)))
        }
        None => Ok(()),
    }
}
