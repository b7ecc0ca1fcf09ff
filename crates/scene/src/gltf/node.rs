//! The node tree: what the nodes of the scene show, and where it stands.

use ::gltf::json::scene::Node;
use glam::{DMat4, DQuat, DVec3};

use super::document::Document;
use super::{instancing, skin, warn};
use crate::{Error, Report};

/// Deepest node tree that is followed.
const MAX_DEPTH: usize = 1024;

/// With how many digits the transforms of nodes are taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Precision {
    /// Rounded to f32, as the crate reads them.
    Single,
    /// As written.
    Double,
}

/// Where one mesh stands.
pub(super) enum Pose {
    /// `world from mesh`.
    Rigid(DMat4),
    /// `world from mesh` of each joint.
    Skinned(Vec<DMat4>),
}

/// One mesh as a node shows it.
pub(super) struct Shown {
    pub(super) mesh: usize,
    pub(super) node: Option<usize>,
    pub(super) pose: Pose,
}

/// What the nodes of the scene show.
#[derive(Default)]
pub(super) struct Found {
    pub(super) meshes: Vec<Shown>,
    /// Camera or light, by node.
    pub(super) views: Vec<(usize, DMat4)>,
    pub(super) lights: Vec<(usize, DMat4)>,
    /// Names of nodes whose meshes some animation or skin moves.
    pub(super) moving: Vec<String>,
    pub(super) report: Report,
    hidden: Vec<String>,
}

/// A node that waits to be met.
struct Waiting {
    node: usize,
    world_from_parent: DMat4,
    depth: usize,
    visible: bool,
}

/// Walks the default scene (else the first, else all root nodes).
pub(super) fn walk(document: &Document<'_>, precision: Precision) -> Result<Found, Error> {
    let root = &document.root;
    let parents = parents(document)?;
    let mut found = Found::default();
    let roots = roots(document, &parents, &mut found.report);
    let joints = if root.skins.is_empty() { Vec::new() } else { world(document, &parents, precision) };
    let waiting = |&node: &usize| Waiting { node, world_from_parent: DMat4::IDENTITY, depth: 0, visible: true };
    let mut stack: Vec<Waiting> = roots.iter().rev().map(waiting).collect();
    let mut seen = vec![false; root.nodes.len()];
    let mut moved = vec![false; root.nodes.len()];
    for &n in &document.aside.animated {
        moved.get_mut(n).into_iter().for_each(|moved| *moved = true);
    }
    while let Some(Waiting { node: n, world_from_parent, depth, visible }) = stack.pop() {
        if std::mem::replace(&mut seen[n], true) {
            return Err(document.invalid(format!("nodes[{n}]"), "appears twice in the scene"));
        }
        if depth > MAX_DEPTH {
            return Err(document.invalid(format!("nodes[{n}]"), format!("lies more than {MAX_DEPTH} levels deep")));
        }
        let node = &root.nodes[n];
        let visible = visible && is_visible(node);
        let world_from_node = world_from_parent * parent_from_node(document, n, precision)?;
        found.meet(document, n, world_from_node, visible, &joints)?;
        if visible && node.mesh.is_some() && (moved[n] || node.skin.is_some()) {
            found.moving.push(name_of(document, n));
        }
        // What hangs on a moved node moves with it.
        node.children.iter().flatten().for_each(|child| moved[child.value()] |= moved[n]);
        let children = node.children.iter().flatten().rev();
        stack.extend(children.map(|child| Waiting {
            node: child.value(),
            world_from_parent: world_from_node,
            depth: depth + 1,
            visible,
        }));
    }
    for name in std::mem::take(&mut found.hidden) {
        warn(&mut found.report, name, "is hidden (KHR_node_visibility) and was left out");
    }
    Ok(found)
}

/// Where walks begin.
fn roots(document: &Document<'_>, parents: &[Option<usize>], report: &mut Report) -> Vec<usize> {
    let root = &document.root;
    let scene = root.scenes.get(root.scene.map_or(0, |index| index.value()));
    match scene {
        Some(scene) if !scene.nodes.is_empty() => return scene.nodes.iter().map(|index| index.value()).collect(),
        Some(_) if !root.nodes.is_empty() => {
            warn(report, "scenes", "the scene names no nodes; all root nodes were taken")
        }
        _ => {}
    }
    (0..root.nodes.len()).filter(|&n| parents[n].is_none()).collect()
}

fn is_visible(node: &Node) -> bool {
    let visibility = node.extensions.as_ref().and_then(|e| e.others.get("KHR_node_visibility"));
    visibility.is_none_or(|json| json["visible"].as_bool() != Some(false))
}

/// What a node is called.
pub(super) fn name_of(document: &Document<'_>, n: usize) -> String {
    document.root.nodes[n].name.clone().unwrap_or_else(|| format!("nodes[{n}]"))
}

impl Found {
    /// Notes what one node shows; cameras see from hidden nodes too.
    fn meet(
        &mut self,
        document: &Document<'_>,
        n: usize,
        world_from_node: DMat4,
        visible: bool,
        joints: &[Option<DMat4>],
    ) -> Result<(), Error> {
        let node = &document.root.nodes[n];
        if let Some(mesh) = node.mesh.map(|mesh| mesh.value()) {
            if visible {
                self.show(document, n, mesh, world_from_node, joints)?;
            } else {
                self.hidden.push(name_of(document, n));
            }
        }
        if node.camera.is_some() {
            self.views.push((n, world_from_node));
        }
        let lit = node.extensions.as_ref().is_some_and(|e| e.khr_lights_punctual.is_some());
        if visible && lit {
            self.lights.push((n, world_from_node));
        }
        Ok(())
    }

    fn show(
        &mut self,
        document: &Document<'_>,
        n: usize,
        mesh: usize,
        world_from_node: DMat4,
        joints: &[Option<DMat4>],
    ) -> Result<(), Error> {
        let node = &document.root.nodes[n];
        let mut add = |pose| self.meshes.push(Shown { mesh, node: Some(n), pose });
        if let Some(skin) = node.skin {
            add(Pose::Skinned(skin::joints(document, skin.value(), joints)?));
        } else if let Some(copies) = instancing::transforms(document, n, node)? {
            copies.into_iter().for_each(|copy| add(Pose::Rigid(world_from_node * copy)));
        } else {
            add(Pose::Rigid(world_from_node));
        }
        Ok(())
    }
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

/// `[node]`: world transform, in the scene or not; none where it or one above it is broken.
fn world(document: &Document<'_>, parents: &[Option<usize>], precision: Precision) -> Vec<Option<DMat4>> {
    let nodes = &document.root.nodes;
    let mut world = vec![None; nodes.len()];
    let roots = (0..nodes.len()).filter(|&n| parents[n].is_none());
    let mut stack: Vec<(usize, DMat4)> = roots.map(|n| (n, DMat4::IDENTITY)).collect();
    while let Some((n, world_from_parent)) = stack.pop() {
        let Ok(local) = parent_from_node(document, n, precision) else { continue };
        let world_from_node = world_from_parent * local;
        world[n] = Some(world_from_node);
        stack.extend(nodes[n].children.iter().flatten().map(|child| (child.value(), world_from_node)));
    }
    world
}

fn parent_from_node(document: &Document<'_>, n: usize, precision: Precision) -> Result<DMat4, Error> {
    let node = &document.root.nodes[n];
    let exact = document.aside.transforms.get(n).filter(|_| precision == Precision::Double);
    let matrix = node.matrix.map(|m| exact.and_then(|t| t.matrix).unwrap_or(m.map(f64::from)));
    let matrix = match matrix {
        Some(matrix) => DMat4::from_cols_array(&matrix),
        None => {
            let vector = |single: Option<[f32; 3]>, double: Option<[f64; 3]>, default| {
                double.or(single.map(|v| v.map(f64::from))).map_or(default, DVec3::from)
            };
            let rotation = node.rotation.unwrap_or_default().0.map(f64::from);
            let rotation = DQuat::from_array(exact.and_then(|t| t.rotation).unwrap_or(rotation));
            let length = rotation.length();
            if !(length > 0.5 && length < 2.0) {
                return Err(
                    document.invalid(format!("nodes[{n}].rotation"), format!("has length {length} instead of 1"))
                );
            }
            let scale = vector(node.scale, exact.and_then(|t| t.scale), DVec3::ONE);
            let translation = vector(node.translation, exact.and_then(|t| t.translation), DVec3::ZERO);
            DMat4::from_scale_rotation_translation(scale, rotation.normalize(), translation)
        }
    };
    let bottom = matrix.row(3).to_array();
    if !matrix.is_finite() || bottom != [0.0, 0.0, 0.0, 1.0] {
        let what = format!("last row {bottom:?}; only affine transforms with 0 0 0 1 are allowed");
        return Err(document.invalid(format!("nodes[{n}].matrix"), what));
    }
    Ok(matrix)
}
