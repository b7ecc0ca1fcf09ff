//! What is done about each extension of a file.

use std::path::Path;

use ::gltf::json::Root;

use super::warn;
use crate::{Error, Report};

/// Extensions that are read.
const READ: &[&str] = &[
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_node_visibility",
    "KHR_texture_basisu",
    "KHR_texture_transform",
];

/// Extensions that say nothing of a scene at rest: motion, sound, behaviour, and notes for other programs.
const IDLE: &[&str] = &[
    "AGI_articulations",
    "AGI_stk_metadata",
    "CESIUM_primitive_outline",
    "EXT_instance_features",
    "EXT_mesh_features",
    "EXT_mesh_manifold",
    "EXT_structural_metadata",
    "FB_geometry_metadata",
    "GODOT_single_root",
    "KHR_animation_pointer",
    "KHR_audio",
    "KHR_audio_emitter",
    "KHR_interactivity",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "KHR_physics_rigid_bodies",
    "KHR_implicit_shapes",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "MOZ_hubs_components",
    "MPEG_audio_spatial",
    "MSFT_lod",
    "OMI_collider",
    "OMI_physics_body",
    "OMI_physics_shape",
    "OMI_seat",
    "OMI_spawn_point",
    "VRM",
    "VRMC_node_constraint",
    "VRMC_springBone",
    "VRMC_vrm",
];

/// Beginnings of extensions that change looks or notes alone: the scene is the same without them.
const LOOKS: &[&str] = &[
    "KHR_materials_",
    "EXT_materials_",
    "ADOBE_materials_",
    "MSFT_materials_",
    "MSFT_packing_",
    "NV_materials_",
    "VRMC_materials_",
    "EXT_lights_",
    "KHR_lights_",
    "KHR_texture_procedurals",
    "EXT_texture_procedurals",
    "ADOBE_texture_procedurals",
];

/// Pictures in a format that is not read: a refusal comes where a texture has no other source.
const PICTURES: &[&str] = &["EXT_texture_avif", "MSFT_texture_dds"];

/// Refuses what a file requires and nobody can leave out, by name; warns of what is left out.
pub(super) fn check(file: &Path, root: &Root, report: &mut Report) -> Result<(), Error> {
    let harmless = |name: &str| {
        READ.contains(&name)
            || IDLE.contains(&name)
            || PICTURES.contains(&name)
            || LOOKS.iter().any(|start| name.starts_with(start))
    };
    if let Some(name) = root.extensions_required.iter().find(|name| !harmless(name)) {
        let hint = "save the scene without it";
        return Err(Error::unsupported(file, "extensionsRequired", name.clone(), hint));
    }
    for name in root.extensions_used.iter().filter(|n| !READ.contains(&n.as_str()) && !IDLE.contains(&n.as_str())) {
        warn(report, "extensionsUsed", format!("{name} is not supported and was ignored"));
    }
    Ok(())
}
