//! What every loaded mesh goes through before it is a mesh of a scene.

use glam::Vec3;

use crate::{Mesh, Report, Scene, Warning, normals, tangents, vertices};

/// Height over longest edge below which a triangle has no area: less than the rounding of its own corners.
const FLATNESS: f64 = 1e-7;
/// Largest coordinate, metres (2^38): no ray is traced farther away.
const FARTHEST: f32 = 274_877_906_944.0;
/// Cosine of 44 degrees: OBJ meshes without normals are smooth below that angle between faces, so that 45-degree
/// bevels and right angles stay sharp.
pub(crate) const SMOOTH_CREASE: f64 = 0.719_339_800_338_651_1;
/// Cosine of about 0.26 degrees: glTF meshes without normals are flat (glTF 2.0, 3.7.2.1), coplanar triangles joined.
pub(crate) const FLAT_CREASE: f64 = 0.999_99;

/// Mends all meshes and drops those without triangles.
pub(crate) fn finish(scene: &mut Scene) {
    let mut report = std::mem::take(&mut scene.report);
    let crease = if scene.name.to_ascii_lowercase().ends_with(".obj") { SMOOTH_CREASE } else { FLAT_CREASE };
    for mesh in &mut scene.meshes {
        drop_broken_triangles(mesh, &mut report);
        report.unused_vertices += vertices::drop_unused(mesh);
        mend_normals(mesh, crease, &mut report);
        mend_coordinates(mesh, &mut report);
        let material = &scene.materials[mesh.material as usize];
        mend_albedo(mesh, material.base_color.truncate(), &mut report);
        match material.normal_texture {
            Some(slot) => mend_tangents(mesh, slot.uv_set, &mut report),
            None => mesh.tangents.clear(),
        }
        report.duplicate_vertices += vertices::merge_equal(mesh);
    }
    scene.meshes.retain(|mesh| !mesh.triangles.is_empty());
    if report.degenerate_triangles > 0 {
        let message = format!("{} triangles of zero area were dropped", report.degenerate_triangles);
        report.warnings.push(Warning { object: "scene".into(), message });
    }
    scene.report = report;
}

/// Drops triangles with a position that is not finite, or too far away for rays (warnings), and those without area (counted).
fn drop_broken_triangles(mesh: &mut Mesh, report: &mut Report) {
    let before = mesh.triangles.len();
    let positions = &mesh.positions;
    mesh.triangles.retain(|t| t.iter().all(|&i| positions[i as usize].is_finite()));
    let not_finite = before - mesh.triangles.len();
    if not_finite > 0 {
        let message = format!("{not_finite} triangles with positions that are not finite were dropped");
        report.warnings.push(Warning { object: mesh.name.clone(), message });
    }
    let before = mesh.triangles.len();
    mesh.triangles.retain(|t| t.iter().all(|&i| positions[i as usize].abs().max_element() <= FARTHEST));
    let too_far = before - mesh.triangles.len();
    if too_far > 0 {
        let message = format!(
            "{too_far} triangles with coordinates beyond 2.7e11 m were dropped, since no ray goes so far: scale the scene down"
        );
        report.warnings.push(Warning { object: mesh.name.clone(), message });
    }
    let before = mesh.triangles.len();
    mesh.triangles.retain(|t| has_area(t.map(|i| positions[i as usize])));
    report.degenerate_triangles += before - mesh.triangles.len();
}

/// Whether three points span an area beyond rounding.
fn has_area(corners: [Vec3; 3]) -> bool {
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    (b - a).cross(c - a).length() > FLATNESS * longest
}

fn mend_normals(mesh: &mut Mesh, crease: f64, report: &mut Report) {
    if mesh.normals.is_empty() {
        normals::generate(mesh, crease);
        report.generated_normals += mesh.normals.len();
        return;
    }
    let repaired = normals::mend(mesh);
    if repaired > 0 {
        report.generated_normals += repaired;
        let message = format!("{repaired} of {} normals were not unit vectors and were repaired", mesh.normals.len());
        report.warnings.push(Warning { object: mesh.name.clone(), message });
    }
}

/// Texture coordinates and colours that are not finite become 0.
fn mend_coordinates(mesh: &mut Mesh, report: &mut Report) {
    let mut broken = 0;
    for uv in mesh.uv0.iter_mut().chain(&mut mesh.uv1).filter(|uv| !uv.is_finite()) {
        *uv = glam::Vec2::ZERO;
        broken += 1;
    }
    for color in mesh.colors.iter_mut().filter(|c| !c.is_finite()) {
        *color = glam::Vec4::ZERO;
        broken += 1;
    }
    if broken > 0 {
        let message = format!("{broken} texture coordinates or colours were not finite and were set to 0");
        report.warnings.push(Warning { object: mesh.name.clone(), message });
    }
}

/// Vertex colours that would reflect less than nothing or, with the material's factor, more than all are clamped.
fn mend_albedo(mesh: &mut Mesh, factor: Vec3, report: &mut Report) {
    let most = factor.max(Vec3::splat(f32::MIN_POSITIVE)).recip();
    let mut clamped = 0;
    for color in &mut mesh.colors {
        let within = color.truncate().clamp(Vec3::ZERO, most);
        if within != color.truncate() {
            *color = within.extend(color.w);
            clamped += 1;
        }
    }
    if clamped > 0 {
        let message = format!("{clamped} vertex colours make an albedo outside 0 to 1 and were clamped");
        report.warnings.push(Warning { object: mesh.name.clone(), message });
    }
}

fn mend_tangents(mesh: &mut Mesh, uv_set: u8, report: &mut Report) {
    if !mesh.tangents.is_empty() && tangents::accept(mesh) {
        return;
    }
    mesh.tangents.clear();
    if !mesh.triangles.is_empty() && !tangents::generate(mesh, uv_set) {
        // Without coordinates the picture is one texel everywhere; any tangent is as good.
        mesh.tangents = mesh.normals.iter().map(|n| n.any_orthonormal_vector().extend(1.0)).collect();
        let message = format!("a normal map without texture coordinates (set {uv_set}); its bumps are lost");
        report.warnings.push(Warning { object: mesh.name.clone(), message });
    }
}
