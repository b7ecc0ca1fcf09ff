//! The JSON as the crate `gltf` can take it: what glTF 2.0 lets a file leave out is put in, what is not needed at rest
//! goes, and what the crate would round is taken down.

use ::gltf::json::Value;

/// What is known of a document beside what the crate reads.
#[derive(Debug, Default)]
pub(super) struct Aside {
    /// Nodes that some animation moves, reshapes or hides, by index.
    pub(super) animated: Vec<usize>,
    /// `[node]`: its transform as written; the crate rounds it to f32.
    pub(super) transforms: Vec<Transform>,
}

/// Members of a node's transform with all their digits.
#[derive(Debug, Default)]
pub(super) struct Transform {
    /// Column by column.
    pub(super) matrix: Option<[f64; 16]>,
    pub(super) translation: Option<[f64; 3]>,
    /// A quaternion, x y z w.
    pub(super) rotation: Option<[f64; 4]>,
    pub(super) scale: Option<[f64; 3]>,
}

/// Mends a document in place.
///
/// Animations are dropped: a scene is taken as it stands at rest, and channels without a node or with a pointer
/// (KHR_animation_pointer) are more than the crate reads.
pub(super) fn complete(document: &mut Value) -> Aside {
    let Some(root) = document.as_object_mut() else { return Aside::default() };
    for scene in root.get_mut("scenes").and_then(Value::as_array_mut).into_iter().flatten() {
        if let Some(scene) = scene.as_object_mut() {
            scene.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
        }
    }
    let animations = root.remove("animations").unwrap_or_default();
    let channels = list(&animations).flat_map(|animation| list(&animation["channels"]));
    let animated = channels.filter_map(|channel| target(&channel["target"])).collect();
    let transforms = root.get("nodes").map_or_else(Vec::new, |nodes| list(nodes).map(transform).collect());
    Aside { animated, transforms }
}

fn list(value: &Value) -> impl Iterator<Item = &Value> {
    value.as_array().into_iter().flatten()
}

/// The node that a channel animates; none for channels that animate no node.
fn target(target: &Value) -> Option<usize> {
    let pointer = target["extensions"]["KHR_animation_pointer"]["pointer"].as_str();
    let pointed = pointer.and_then(|p| p.strip_prefix("/nodes/")?.split('/').next()?.parse().ok());
    pointed.or_else(|| usize::try_from(target["node"].as_u64()?).ok())
}

fn transform(node: &Value) -> Transform {
    Transform {
        matrix: numbers(&node["matrix"]),
        translation: numbers(&node["translation"]),
        rotation: numbers(&node["rotation"]),
        scale: numbers(&node["scale"]),
    }
}

fn numbers<const N: usize>(value: &Value) -> Option<[f64; N]> {
    let values: Option<Vec<f64>> = value.as_array()?.iter().map(Value::as_f64).collect();
    values?.try_into().ok()
}
