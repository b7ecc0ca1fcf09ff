//! The node tree: instances of meshes, cameras and lights in world space.

use ::gltf::json::camera::Camera as JsonCamera;
use ::gltf::json::extensions::scene::khr_lights_punctual::{Light, Type};
use ::gltf::json::scene::Node;
use ::gltf::json::validation::Checked;
use glam::{DMat3, DMat4, DQuat, DVec3, Vec3};

use super::document::Document;
use super::{MAX_ELEMENTS, warn};
use crate::{Camera, Error, LightKind, Mesh, PunctualLight, Report};

/// Deepest node tree that is followed.
const MAX_DEPTH: usize = 1024;

/// What the nodes of the scene show.
#[derive(Default)]
pub(super) struct Placed {
    pub(super) meshes: Vec<Mesh>,
    pub(super) cameras: Vec<Camera>,
    pub(super) lights: Vec<PunctualLight>,
    pub(super) moving: Vec<String>,
    elements: usize,
}

/// Walks the default scene (else the first, else all root nodes) and places what its nodes show.
pub(super) fn place(document: &Document<'_>, primitives: &[Vec<Mesh>], report: &mut Report) -> Result<Placed, Error> {
    let root = &document.root;
    let parents = parents(document)?;
    let scene = root.scene.map_or(0, |index| index.value());
    let roots: Vec<usize> = match root.scenes.get(scene) {
        Some(scene) => scene.nodes.iter().map(|index| index.value()).collect(),
        None => (0..root.nodes.len()).filter(|&n| parents[n].is_none()).collect(),
    };
    let mut placed = Placed::default();
    let mut stack: Vec<(usize, DMat4, usize)> = roots.into_iter().rev().map(|n| (n, DMat4::IDENTITY, 0)).collect();
    let mut seen = vec![false; root.nodes.len()];
    let mut moved = animated(document);
    while let Some((n, world_from_parent, depth)) = stack.pop() {
        if std::mem::replace(&mut seen[n], true) {
            return Err(document.invalid(format!("nodes[{n}]"), "appears twice in the scene"));
        }
        if depth > MAX_DEPTH {
            return Err(document.invalid(format!("nodes[{n}]"), format!("lies more than {MAX_DEPTH} levels deep")));
        }
        let node = &root.nodes[n];
        let world_from_node = world_from_parent * parent_from_node(document, n, node)?;
        show(document, primitives, n, world_from_node, &mut placed, report)?;
        if node.mesh.is_some() && (moved[n] || node.skin.is_some()) {
            placed.moving.push(name_of(node, n));
        }
        // What hangs on a moved node moves with it.
        node.children.iter().flatten().for_each(|child| moved[child.value()] |= moved[n]);
        let children = node.children.iter().flatten().rev();
        stack.extend(children.map(|child| (child.value(), world_from_node, depth + 1)));
    }
    if root.scenes.is_empty() && root.nodes.is_empty() && !primitives.is_empty() {
        warn(report, "scenes", "no node shows a mesh; all meshes were placed as they are");
        for (m, _) in primitives.iter().enumerate() {
            placed.instance(document, &primitives[m], DMat4::IDENTITY, None)?;
        }
    }
    Ok(placed)
}

/// Which nodes some animation moves or reshapes by itself.
fn animated(document: &Document<'_>) -> Vec<bool> {
    let mut moved = vec![false; document.root.nodes.len()];
    let channels = document.root.animations.iter().flat_map(|animation| &animation.channels);
    channels.for_each(|channel| moved[channel.target.node.value()] = true);
    moved
}

fn name_of(node: &Node, n: usize) -> String {
    node.name.clone().unwrap_or_else(|| format!("nodes[{n}]"))
}

/// The parent of each node; refuses graphs that are not trees.
fn parents(document: &Document<'_>) -> Result<Vec<Option<usize>>, Error> {
    let nodes = &document.root.nodes;
    let mut parents: Vec<Option<usize>> = vec![None; nodes.len()];
    for (n, node) in nodes.iter().enumerate() {
        for child in node.children.iter().flatten().map(|c| c.value()) {
            if let Some(other) = parents[child].replace(n) {
                let what = format!("is a child of both nodes[{other}] and nodes[{n}]");
                return Err(document.invalid(format!("nodes[{child}]"), what));
            }
        }
    }
    // With one parent each, a node that no parentless node reaches lies on a loop or below one.
    let mut reached = vec![false; nodes.len()];
    let mut stack: Vec<usize> = (0..nodes.len()).filter(|&n| parents[n].is_none()).collect();
    while let Some(n) = stack.pop() {
        reached[n] = true;
        stack.extend(nodes[n].children.iter().flatten().map(|c| c.value()));
    }
    match reached.iter().position(|r| !r) {
        Some(n) => Err(document.invalid(format!("nodes[{n}]"), "is its own ancestor: the nodes form a loop")),
        None => Ok(parents),
    }
}

fn parent_from_node(document: &Document<'_>, n: usize, node: &Node) -> Result<DMat4, Error> {
    let matrix = match node.matrix {
        Some(m) => DMat4::from_cols_array(&m.map(f64::from)),
        None => {
            let vector = |v: Option<[f32; 3]>, default| v.map_or(default, |v| Vec3::from(v).as_dvec3());
            let [x, y, z, w] = node.rotation.unwrap_or_default().0.map(f64::from);
            let rotation = DQuat::from_xyzw(x, y, z, w);
            let length = rotation.length();
            if !(length > 0.5 && length < 2.0) {
                return Err(
                    document.invalid(format!("nodes[{n}].rotation"), format!("has length {length} instead of 1"))
                );
            }
            let scale = vector(node.scale, DVec3::ONE);
            DMat4::from_scale_rotation_translation(scale, rotation.normalize(), vector(node.translation, DVec3::ZERO))
        }
    };
    let bottom = matrix.row(3).to_array();
    if !matrix.is_finite() || bottom != [0.0, 0.0, 0.0, 1.0] {
        let what = format!("last row {bottom:?}; only affine transforms with 0 0 0 1 are allowed");
        return Err(document.invalid(format!("nodes[{n}].matrix"), what));
    }
    Ok(matrix)
}

/// Places what one node shows.
fn show(
    document: &Document<'_>,
    primitives: &[Vec<Mesh>],
    n: usize,
    world_from_node: DMat4,
    placed: &mut Placed,
    report: &mut Report,
) -> Result<(), Error> {
    let node = &document.root.nodes[n];
    let name = name_of(node, n);
    if let Some(mesh) = node.mesh {
        if node.skin.is_some() {
            warn(report, &name, "skinning is not applied; the mesh stands as modelled");
        }
        placed.instance(document, &primitives[mesh.value()], world_from_node, Some(&name))?;
    }
    if let Some(camera) = node.camera {
        match view(&document.root.cameras[camera.value()], &name, world_from_node) {
            Some(view) => placed.cameras.push(view),
            None => warn(report, &name, "only perspective cameras are supported; this one was left out"),
        }
    }
    let light = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref()).map(|l| l.light.value());
    let lights = document.root.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
    if let Some(light) = light.and_then(|l| lights?.lights.get(l)) {
        placed.lights.extend(lamp(light, &name, world_from_node));
        warn(report, &name, "a punctual light was read but is not baked; light comes from the probe");
    }
    Ok(())
}

impl Placed {
    /// Adds one instance of a mesh's primitives.
    fn instance(
        &mut self,
        document: &Document<'_>,
        primitives: &[Mesh],
        world_from_node: DMat4,
        name: Option<&str>,
    ) -> Result<(), Error> {
        for primitive in primitives {
            self.elements += primitive.positions.len().max(primitive.triangles.len());
            if self.elements > MAX_ELEMENTS {
                let what = format!("more than {MAX_ELEMENTS} vertices or triangles with all instances");
                return Err(document.invalid("scene", what));
            }
            let mut mesh = primitive.clone();
            if let Some(name) = name {
                mesh.name = name.into();
            }
            transform(&mut mesh, world_from_node);
            self.meshes.push(mesh);
        }
        Ok(())
    }
}

/// Takes a mesh to world space; a mirrored one keeps its front by turning its triangles round.
fn transform(mesh: &mut Mesh, world_from_node: DMat4) {
    let linear = DMat3::from_mat4(world_from_node);
    let mirrored = linear.determinant() < 0.0;
    for position in &mut mesh.positions {
        *position = world_from_node.transform_point3(position.as_dvec3()).as_vec3();
    }
    // The cofactor matrix is the inverse transpose times the determinant, and exists for flattened meshes too.
    let (x, y, z) = (linear.x_axis, linear.y_axis, linear.z_axis);
    let cofactor = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    let side = if mirrored { -1.0 } else { 1.0 };
    for normal in mesh.normals.iter_mut() {
        let given = normal.as_dvec3();
        let turned = (cofactor * given).normalize_or_zero();
        // The length says whether the file's normal was sound, so it is kept for the repair to judge.
        *normal = (turned * (side * given.length())).as_vec3();
    }
    for tangent in mesh.tangents.iter_mut() {
        let turned = (linear * tangent.truncate().as_dvec3()).normalize_or_zero().as_vec3();
        *tangent = turned.extend(tangent.w * side as f32);
    }
    if mirrored {
        mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
}

/// A perspective camera looks along its node's -z.
fn view(camera: &JsonCamera, name: &str, world_from_node: DMat4) -> Option<Camera> {
    let perspective = camera.perspective.as_ref()?;
    let sound = perspective.yfov > 0.0 && perspective.yfov < std::f32::consts::PI;
    let eye = world_from_node.w_axis.truncate();
    let forward = (-world_from_node.z_axis.truncate()).try_normalize()?;
    let up = world_from_node.y_axis.truncate().try_normalize()?;
    sound.then(|| Camera {
        name: camera.name.clone().unwrap_or_else(|| name.into()),
        eye: eye.as_vec3(),
        target: (eye + forward).as_vec3(),
        up: up.as_vec3(),
        vertical_fov: perspective.yfov,
    })
}

/// A punctual light shines along its node's -z.
fn lamp(light: &Light, name: &str, world_from_node: DMat4) -> Option<PunctualLight> {
    let kind = match (&light.type_, &light.spot) {
        (Checked::Valid(Type::Directional), _) => LightKind::Directional,
        (Checked::Valid(Type::Point), _) => LightKind::Point,
        (Checked::Valid(Type::Spot), Some(spot)) => {
            LightKind::Spot { inner: spot.inner_cone_angle, outer: spot.outer_cone_angle }
        }
        _ => return None,
    };
    Some(PunctualLight {
        name: light.name.clone().unwrap_or_else(|| name.into()),
        kind,
        position: world_from_node.w_axis.truncate().as_vec3(),
        direction: (-world_from_node.z_axis.truncate()).try_normalize()?.as_vec3(),
        intensity: Vec3::from(light.color) * light.intensity,
    })
}
