//! Links in the documents: what they name within the project must stand there.

/// Which links of the document `text` at `path` lead nowhere; `exists` is asked for paths relative to the root.
pub(super) fn faults(path: &str, text: &str, exists: impl Fn(&str) -> bool) -> Vec<String> {
    let folder = path.rsplit_once('/').map_or("", |(folder, _)| folder);
    let broken = targets(text).filter(|target| !exists(&resolve(folder, target)));
    broken.map(|target| format!("{path}: the link to {target} leads nowhere")).collect()
}

/// Targets of the links within the project, without their anchors.
fn targets(text: &str) -> impl Iterator<Item = &str> {
    let ends = text.split("](").skip(1).filter_map(|rest| rest.split([')', ' ']).next());
    let inside = ends.filter(|target| !target.contains("://") && !target.starts_with("mailto:"));
    inside.filter_map(|target| target.split('#').next()).filter(|target| !target.is_empty())
}

/// `target` as seen from `folder`, relative to the root.
fn resolve(folder: &str, target: &str) -> String {
    let mut parts: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
    for part in target.split('/') {
        match part {
            "." | "" => {}
            ".." => drop(parts.pop()),
            name => parts.push(name),
        }
    }
    parts.join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "[a](docs/a.md#here) ![b](../b.png \"title\") [c](https://example.org/c) [d](#d)";

    #[test]
    fn links_are_found_and_resolved() {
        assert_eq!(targets(TEXT).collect::<Vec<_>>(), ["docs/a.md", "../b.png"]);
        assert_eq!(resolve("docs/bench", "../b.png"), "docs/b.png");
        assert_eq!(resolve("", "./docs/bench/"), "docs/bench");
        assert!(faults("README.md", TEXT, |_| true).is_empty());
    }

    #[test]
    fn links_can_fail() {
        let found = faults("docs/math.md", TEXT, |target| target == "b.png");
        assert_eq!(found, ["docs/math.md: the link to docs/a.md leads nowhere"]);
    }
}
