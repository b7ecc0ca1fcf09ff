//! What may have been meant where a name leads to nothing, or to a file of another kind.

use std::path::Path;

/// The kinds of files that commands read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Scene,
    Probe,
    Baked,
}

impl Kind {
    /// The kind that a file of this name has.
    fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        match ending.as_str() {
            "gltf" | "glb" | "obj" => Some(Self::Scene),
            "hdr" | "exr" | "pic" => Some(Self::Probe),
            "prt" => Some(Self::Baked),
            _ => None,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Scene => "a scene",
            Self::Probe => "a light probe",
            Self::Baked => "a baked file",
        }
    }

    /// What can be given for it.
    fn choices(self) -> &'static str {
        match self {
            Self::Scene => ".gltf, .glb, .obj or builtin:NAME",
            Self::Probe => ".hdr, .exr, a folder of six faces or builtin:NAME",
            Self::Baked => "a .prt file",
        }
    }
}

/// Why `path` cannot be read as `wanted`, where that shows before it is opened.
pub(crate) fn about(path: &Path, wanted: Kind, builtins: &[&str]) -> Option<String> {
    let shown = path.display();
    if path.is_dir() && wanted != Kind::Probe {
        let hint = if wanted == Kind::Scene { nearest_in(path, wanted) } else { None };
        let hint = hint.unwrap_or_default();
        return Some(format!("{shown} is a folder: give {}{hint}", wanted.choices()));
    }
    if !path.exists() {
        return missing(path, wanted, builtins);
    }
    let found = Kind::of(path).filter(|found| *found != wanted && !path.is_dir())?;
    let next = match (wanted, found) {
        (Kind::Scene, Kind::Baked) => "give the scene that it was baked from, or draw it with `relume render`".into(),
        (Kind::Baked, Kind::Scene) => format!("bake it first: `relume bake {shown} -o {}`", with_prt(path)),
        (Kind::Scene | Kind::Baked, Kind::Probe) => {
            format!("it is light, for --probe; give {}", wanted.choices())
        }
        _ => format!("give {}", wanted.choices()),
    };
    Some(format!("{shown} is {}, not {}: {next}", found.name(), wanted.name()))
}

fn with_prt(path: &Path) -> String {
    path.with_extension("prt").file_name().unwrap_or_default().display().to_string()
}

/// What a name that leads to no file may have meant.
fn missing(path: &Path, wanted: Kind, builtins: &[&str]) -> Option<String> {
    let text = path.to_str()?;
    let bare = text.split(':').next().unwrap_or(text);
    if builtins.contains(&bare) {
        return Some(format!("there is no file {text}; did you mean builtin:{text}?"));
    }
    if let Some(name) = nearest(text, builtins).filter(|_| Kind::of(path).is_none() && !text.contains(['/', '\\'])) {
        return Some(format!("there is no file {text}; did you mean builtin:{name}?"));
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let files = files(folder, wanted);
    let names: Vec<&str> = files.iter().map(String::as_str).collect();
    let name = nearest(path.file_name()?.to_str()?, &names)?;
    let meant = if folder == Path::new(".") { name.into() } else { folder.join(name).display().to_string() };
    Some(format!("there is no file {text}; did you mean {meant}?"))
}

/// A file of the wanted kind in a folder, as a hint.
fn nearest_in(folder: &Path, wanted: Kind) -> Option<String> {
    let mut names = files(folder, wanted);
    names.sort();
    names.first().map(|name| format!(", such as {}", folder.join(name).display()))
}

fn files(folder: &Path, wanted: Kind) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let names = entries.filter(|entry| Kind::of(&entry.path()) == Some(wanted));
    names.filter_map(|entry| entry.file_name().into_string().ok()).collect()
}

/// The name that is typed most like `text`; none where none is near.
pub(crate) fn nearest<'a>(text: &str, names: &[&'a str]) -> Option<&'a str> {
    let likeness = |name: &&str| strsim::jaro_winkler(&text.to_lowercase(), &name.to_lowercase());
    let best = names.iter().copied().max_by(|a, b| likeness(a).total_cmp(&likeness(b)))?;
    (likeness(&best) > 0.85).then_some(best)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_names_are_found() {
        let names = ["atrium", "cornell-box", "teacup"];
        assert_eq!(nearest("atrum", &names), Some("atrium"));
        assert_eq!(nearest("cornell_box", &names), Some("cornell-box"));
        assert_eq!(nearest("sponza", &names), None);
    }

    #[test]
    fn other_kinds_are_told() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["house.glb", "house.prt", "sky.hdr"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let said = |name: &str, wanted| about(&folder.path().join(name), wanted, &["atrium"]).unwrap_or_default();
        assert!(said("house.prt", Kind::Scene).contains("relume render"));
        assert!(said("house.glb", Kind::Baked).contains("relume bake"));
        assert!(said("sky.hdr", Kind::Scene).contains("--probe"));
        assert!(said("house.glb", Kind::Probe).contains("not a light probe"));
        assert!(said("huose.glb", Kind::Scene).contains("did you mean"));
        assert!(said("", Kind::Scene).contains("folder") && said("", Kind::Scene).contains("house.glb"));
        assert_eq!([said("house.glb", Kind::Scene), said("", Kind::Probe)], ["", ""]);
        let builtin = about(Path::new("atrium"), Kind::Scene, &["atrium"]);
        assert!(builtin.unwrap().contains("builtin:atrium"));
    }
}
