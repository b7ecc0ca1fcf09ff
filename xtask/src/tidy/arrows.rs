//! The arrows: which crate may use which, as ARCHITECTURE.md draws them.

/// Crates of the house with the crates of the house that each may use; dev-dependencies are free.
const ARROWS: &[(&str, &[&str])] = &[
    ("sh-math", &[]),
    ("sampling", &[]),
    ("raytrace", &[]),
    ("scene", &[]),
    ("probe-io", &[]),
    ("testkit", &[]),
    ("xtask", &[]),
    ("end-to-end", &[]),
    ("coeff-io", &["sh-math"]),
    ("bake", &["sh-math", "sampling", "raytrace", "scene", "probe-io", "coeff-io"]),
    ("reference", &["sampling", "raytrace", "scene", "probe-io"]),
    ("render-cpu", &["sh-math", "raytrace", "probe-io", "coeff-io"]),
    ("render-wgpu", &["sh-math", "probe-io", "coeff-io"]),
    ("study", EVERYTHING),
    ("relume", LIBRARY),
    ("relume-cli", WITH_STUDY),
];
const EVERYTHING: &[&str] = &[
    "sh-math",
    "sampling",
    "raytrace",
    "scene",
    "probe-io",
    "coeff-io",
    "bake",
    "reference",
    "render-cpu",
    "render-wgpu",
];
/// What the library re-exports and calls: all that a program needs, without the path tracer and the studies.
const LIBRARY: &[&str] = &["sh-math", "scene", "probe-io", "coeff-io", "bake", "render-cpu", "render-wgpu"];
const WITH_STUDY: &[&str] = &[
    "sh-math",
    "sampling",
    "raytrace",
    "scene",
    "probe-io",
    "coeff-io",
    "bake",
    "reference",
    "render-cpu",
    "render-wgpu",
    "study",
    "relume",
];
/// Crates of others that only some crates of the house may use.
const RESERVED: &[(&str, &[&str])] = &[
    ("wgpu", &["render-wgpu"]),
    ("rayon", &["bake", "reference", "render-cpu", "study", "relume-cli"]),
    ("gltf", &["scene"]),
];

/// What cargo is asked: the normal edges that start in the workspace, each line with its depth.
pub(super) const QUESTION: [&str; 10] =
    ["tree", "--workspace", "--edges", "normal", "--depth", "1", "--prefix", "depth", "--no-dedupe", "--target=all"];

/// An edge of the graph: who uses whom.
pub(super) type Edge = (String, String);

/// Edges in cargo's answer: lines such as `0bake v0.1.0 (...)`, each followed by what it uses, `1glam v0.34.2`.
pub(super) fn read(tree: &str) -> Vec<Edge> {
    let mut edges = Vec::new();
    let mut from = "";
    for name in tree.lines().filter_map(|line| line.split_whitespace().next()) {
        match name.split_at_checked(1) {
            Some(("0", name)) => from = name,
            Some(("1", name)) => edges.push((from.to_owned(), name.to_owned())),
            _ => {}
        }
    }
    edges
}

/// What is wrong with the edges, and which of the folders in `crates` the table does not know.
pub(super) fn faults(edges: &[Edge], folders: &[&str]) -> Vec<String> {
    let row = |name: &str| ARROWS.iter().find(|(from, _)| *from == name).map(|(_, to)| *to);
    let unknown = folders.iter().filter(|name| row(name).is_none());
    let mut faults: Vec<String> =
        unknown.map(|name| format!("crate '{name}' is in no row of the arrows in xtask/src/tidy/arrows.rs")).collect();
    for (from, to) in edges {
        let wrong = row(to).is_some() && !row(from).is_some_and(|allowed| allowed.contains(&to.as_str()));
        let reserved = RESERVED.iter().any(|(name, users)| name == to && !users.contains(&from.as_str()));
        if wrong || reserved {
            faults.push(format!("crate '{from}' may not depend on '{to}': see the arrows in ARCHITECTURE.md"));
        }
    }
    faults
}

#[cfg(test)]
mod tests {
    use super::*;

    const TREE: &str = "0sh-math v0.1.0 (/here/crates/sh-math)\n1glam v0.34.2\n\n\
        0bake v0.1.0 (/here/crates/bake)\n1sh-math v0.1.0 (/here/crates/sh-math)\n1rayon v1.12.0\n";

    fn edge(from: &str, to: &str) -> Edge {
        (from.to_owned(), to.to_owned())
    }

    #[test]
    fn answer_of_cargo_is_read() {
        assert_eq!(read(TREE), [edge("sh-math", "glam"), edge("bake", "sh-math"), edge("bake", "rayon")]);
        assert!(faults(&read(TREE), &["sh-math", "bake"]).is_empty());
    }

    #[test]
    fn arrows_can_fail() {
        for (from, to) in [("bake", "render-cpu"), ("sh-math", "scene"), ("reference", "bake"), ("xtask", "scene")] {
            let found = faults(&[edge(from, to)], &[]);
            assert_eq!(found.len(), 1, "{from} -> {to}: {found:?}");
            assert!(found[0].contains(from) && found[0].contains(to), "{found:?}");
        }
    }

    #[test]
    fn reserved_crates_can_fail() {
        assert_eq!(faults(&[edge("relume", "wgpu"), edge("sampling", "rayon")], &[]).len(), 2);
        assert!(faults(&[edge("render-wgpu", "wgpu")], &[]).is_empty());
    }

    #[test]
    fn crate_without_a_row_is_a_fault() {
        assert_eq!(faults(&[], &["bake", "helpers"]).len(), 1);
    }
}
