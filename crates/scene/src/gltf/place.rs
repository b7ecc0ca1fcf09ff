//! Meshes, cameras and lights in world space, relative to a common origin.

use glam::{DMat3, DMat4, DVec3, Vec3};

use super::document::Document;
use super::node::{Found, Pose, Precision, Shown, name_of, walk};
use super::primitive::Primitive;
use super::{MAX_ELEMENTS, morph, skin, view, warn};
use crate::origin::{self, Extent};
use crate::{Bounds, Camera, Error, Mesh, PunctualLight, Report};

/// Steps of rounding above this share of a mesh's size are told.
const COARSE_STEP: f64 = 5e-3;

/// What the nodes of the scene show.
#[derive(Default)]
pub(super) struct Placed {
    /// World coordinates that all positions are relative to.
    pub(super) origin: DVec3,
    pub(super) meshes: Vec<Mesh>,
    pub(super) cameras: Vec<Camera>,
    pub(super) lights: Vec<PunctualLight>,
    pub(super) moving: Vec<String>,
    elements: usize,
}

/// Places what the nodes of the scene show.
pub(super) fn place(
    document: &Document<'_>,
    primitives: &[Vec<Primitive<'_>>],
    report: &mut Report,
) -> Result<Placed, Error> {
    let mut found = found(document, Precision::Single)?;
    let origin = extent(&found, primitives).common_origin();
    if origin != DVec3::ZERO {
        // The digits that f32 has left out count where the numbers are large.
        found = self::found(document, Precision::Double)?;
        warn(report, "scene", origin::message(origin));
    }
    report.warnings.append(&mut found.report.warnings);
    let mut placed = Placed { origin, moving: std::mem::take(&mut found.moving), ..Placed::default() };
    for shown in &found.meshes {
        placed.mesh(document, &primitives[shown.mesh], shown, report)?;
    }
    placed.views(document, &found, report);
    Ok(placed)
}

/// What nodes show, or, in a file without any, all meshes.
fn found(document: &Document<'_>, precision: Precision) -> Result<Found, Error> {
    let mut found = walk(document, precision)?;
    let meshes = document.root.meshes.len();
    if document.root.nodes.is_empty() && meshes > 0 {
        warn(&mut found.report, "scenes", "no node shows a mesh; all meshes were placed as they are");
        found.meshes = (0..meshes).map(|mesh| Shown { mesh, node: None, pose: Pose::Rigid(DMat4::IDENTITY) }).collect();
    }
    Ok(found)
}

/// The box around everything shown, by the corners of the primitives' own boxes.
fn extent(found: &Found, primitives: &[Vec<Primitive<'_>>]) -> Extent {
    let bounds = |primitive: &Primitive<'_>| primitive.mesh.bounds();
    let bounds: Vec<Vec<Option<Bounds>>> = primitives.iter().map(|mesh| mesh.iter().map(bounds).collect()).collect();
    let mut extent = Extent::new();
    for shown in &found.meshes {
        let matrices = match &shown.pose {
            Pose::Rigid(matrix) => std::slice::from_ref(matrix),
            Pose::Skinned(joints) => joints,
        };
        for Bounds { min, max } in bounds[shown.mesh].iter().flatten() {
            let corners = (0..8).map(|i| Vec3::select(glam::BVec3::new(i & 1 > 0, i & 2 > 0, i & 4 > 0), *max, *min));
            for corner in corners {
                matrices.iter().for_each(|matrix| extent.add(matrix.transform_point3(corner.as_dvec3())));
            }
        }
    }
    extent
}

impl Placed {
    /// Adds one mesh as a node shows it.
    fn mesh(
        &mut self,
        document: &Document<'_>,
        primitives: &[Primitive<'_>],
        shown: &Shown,
        report: &mut Report,
    ) -> Result<(), Error> {
        let node = shown.node.map(|n| &document.root.nodes[n]);
        let name = shown.node.map(|n| name_of(document, n));
        let weights = morph::weights(node, &document.root.meshes[shown.mesh]);
        for primitive in primitives {
            self.elements += primitive.mesh.positions.len().max(primitive.mesh.triangles.len());
            if self.elements > MAX_ELEMENTS {
                let what = format!("more than {MAX_ELEMENTS} vertices or triangles with all instances");
                return Err(document.invalid("scene", what));
            }
            let mut mesh = primitive.morphed(document, weights)?;
            if let Some(name) = &name {
                mesh.name.clone_from(name);
            }
            let local = reach(&mesh);
            match (&shown.pose, &primitive.influences) {
                (Pose::Rigid(matrix), _) => transform(&mut mesh, relative(matrix, self.origin)),
                (Pose::Skinned(joints), Some(influences)) => {
                    let joints: Vec<DMat4> = joints.iter().map(|joint| relative(joint, self.origin)).collect();
                    let posed = skin::pose(&mut mesh, influences, &joints);
                    posed.map_err(|what| document.invalid(mesh.name.as_str(), what))?;
                }
                (Pose::Skinned(_), None) => {
                    warn(report, &mesh.name, "has a skin but no joints and weights; it stands as modelled");
                    transform(&mut mesh, DMat4::from_translation(-self.origin));
                }
            }
            tell_steps(&mesh, local, report);
            self.meshes.push(mesh);
        }
        Ok(())
    }

    /// Adds the cameras and lights.
    fn views(&mut self, document: &Document<'_>, found: &Found, report: &mut Report) {
        let root = &document.root;
        for &(n, world_from_node) in &found.views {
            let Some(camera) = root.nodes[n].camera else { continue };
            let name = name_of(document, n);
            match view::camera(&root.cameras[camera.value()], &name, world_from_node, self.origin) {
                Some(camera) => self.cameras.push(camera),
                None => warn(report, &name, "only perspective cameras are supported; this one was left out"),
            }
        }
        let lights = root.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
        for &(n, world_from_node) in &found.lights {
            let light = root.nodes[n].extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
            let Some(light) = light.and_then(|light| lights?.lights.get(light.light.value())) else { continue };
            let name = name_of(document, n);
            self.lights.extend(view::lamp(light, &name, world_from_node, self.origin));
            warn(report, &name, "a punctual light was read but is not baked; light comes from the probe");
        }
    }
}

/// A transform whose target is relative to an origin.
fn relative(world_from: &DMat4, origin: DVec3) -> DMat4 {
    let mut matrix = *world_from;
    matrix.w_axis -= origin.extend(0.0);
    matrix
}

/// Largest coordinate over the size of a mesh, both in its own units.
fn reach(mesh: &Mesh) -> (f64, f64) {
    mesh.bounds().map_or((0.0, 0.0), |b| {
        let reach = b.min.abs().max(b.max.abs()).max_element();
        (f64::from(reach), f64::from(b.size().length()))
    })
}

/// Says by how much positions are rounded where that is much for the mesh: in the file, or where it stands.
fn tell_steps(mesh: &Mesh, (local_reach, local_size): (f64, f64), report: &mut Report) {
    let (reach, size) = reach(mesh);
    if !(size > 0.0 && local_size > 0.0) {
        return;
    }
    let in_file = origin::step(local_reach) / local_size * size;
    let step = in_file.max(origin::step(reach));
    if step > COARSE_STEP * size {
        let what =
            format!("its positions are in steps of {step} m, so far does it lie from the origin of its coordinates");
        warn(report, &mesh.name, format!("{what}; move it nearer in the program that made it"));
    }
}

/// Takes a mesh to world space; a mirrored one keeps its front by turning its triangles round.
fn transform(mesh: &mut Mesh, world_from_node: DMat4) {
    let linear = DMat3::from_mat4(world_from_node);
    let mirrored = linear.determinant() < 0.0;
    for position in &mut mesh.positions {
        *position = world_from_node.transform_point3(position.as_dvec3()).as_vec3();
    }
    let side = if mirrored { -1.0 } else { 1.0 };
    for normal in mesh.normals.iter_mut() {
        *normal = turned_normal(linear, side, *normal);
    }
    for tangent in mesh.tangents.iter_mut() {
        let turned = (linear * tangent.truncate().as_dvec3()).normalize_or_zero().as_vec3();
        *tangent = turned.extend(tangent.w * side as f32);
    }
    if mirrored {
        mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
}

/// A normal under a linear map; `side` is -1 where that mirrors.
pub(super) fn turned_normal(linear: DMat3, side: f64, normal: Vec3) -> Vec3 {
    // The cofactor matrix is the inverse transpose times the determinant, and exists for flattened meshes too.
    let (x, y, z) = (linear.x_axis, linear.y_axis, linear.z_axis);
    let cofactor = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    let given = normal.as_dvec3();
    let turned = (cofactor * given).normalize_or_zero();
    // The length says whether the file's normal was sound, so it is kept for the repair to judge.
    (turned * (side * given.length())).as_vec3()
}
