//! What may have been meant where a name leads to nothing, or to a file of another kind.

use std::io::Read;
use std::path::Path;

/// The kinds of files that commands read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Scene,
    Probe,
    Baked,
}

impl Kind {
    /// The kind of a file that is there, whatever its name is.
    fn of_bytes(path: &Path) -> Option<Self> {
        let mut head = Vec::new();
        std::fs::File::open(path).ok()?.take(16).read_to_end(&mut head).ok()?;
        let kinds: [(&[u8], Self); 5] = [
            (&coeff_io::MAGIC, Self::Baked),
            (b"glTF", Self::Scene),
            (b"\x76\x2f\x31\x01", Self::Probe),
            (b"#?RADIANCE", Self::Probe),
            (b"#?RGBE", Self::Probe),
        ];
        kinds.into_iter().find(|(magic, _)| head.starts_with(magic)).map(|(_, kind)| kind)
    }

    /// The kind that a file of this name has.
    pub(crate) fn of(path: &Path) -> Option<Self> {
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

    /// What it is called behind "no".
    fn noun(self) -> &'static str {
        match self {
            Self::Scene => "scene",
            Self::Probe => "light probe",
            Self::Baked => ".prt file",
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
    if path.as_os_str().is_empty() {
        return Some(format!("the name is empty: give {}", wanted.choices()));
    }
    if !path.exists() {
        return missing(path, wanted, builtins);
    }
    if path.is_file() && path.metadata().is_ok_and(|metadata| metadata.len() == 0) {
        return Some(format!("{shown} is empty and no {}: give {}", wanted.noun(), wanted.choices()));
    }
    let of_bytes = if path.is_file() { Kind::of_bytes(path) } else { None };
    let found = of_bytes.or(Kind::of(path)).filter(|found| *found != wanted && !path.is_dir())?;
    let next = match (wanted, found) {
        (Kind::Scene, Kind::Baked) => "give the scene that it was baked from, or draw it with `relume render`".into(),
        (Kind::Baked, Kind::Scene) => format!("bake it first: `relume bake {shown} -o {}`", with_prt(path)),
        (Kind::Scene | Kind::Baked, Kind::Probe) => {
            format!("it is light, for --probe; give {}", wanted.choices())
        }
        _ => format!("give {}", wanted.choices()),
    };
    Some(match Kind::of(path) == Some(wanted) {
        true => format!("{shown} holds {} and is no {}: {next}", found.name(), wanted.noun()),
        false => format!("{shown} is {}, not {}: {next}", found.name(), wanted.name()),
    })
}

fn with_prt(path: &Path) -> String {
    path.with_extension("prt").file_name().unwrap_or_default().display().to_string()
}

/// What a name that leads to no file may have meant.
fn missing(path: &Path, wanted: Kind, builtins: &[&str]) -> Option<String> {
    let text = path.to_str()?;
    if let Some(name) = text.strip_prefix("builtin:").filter(|_| wanted == Kind::Baked) {
        return Some(format!("{text} is not baked yet: `relume bake {text} -o {name}.prt`"));
    }
    let text =
        text.strip_prefix("builtin").map_or(text, |rest| rest.trim_start_matches(['-', '_', '/', '.', ' ', '=']));
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
            std::fs::write(folder.path().join(name), "some").unwrap();
        }
        let said = |name: &str, wanted| about(&folder.path().join(name), wanted, &["atrium"]).unwrap_or_default();
        assert!(said("house.prt", Kind::Scene).contains("relume render"));
        assert!(said("house.glb", Kind::Baked).contains("relume bake"));
        assert!(said("sky.hdr", Kind::Scene).contains("--probe"));
        assert!(said("house.glb", Kind::Probe).contains("not a light probe"));
        assert!(said("huose.glb", Kind::Scene).contains("did you mean"));
        assert!(said("", Kind::Scene).contains("folder") && said("", Kind::Scene).contains("house.glb"));
        assert_eq!([said("house.glb", Kind::Scene), said("", Kind::Probe)], ["", ""]);
        std::fs::write(folder.path().join("none.glb"), "").unwrap();
        assert!(said("none.glb", Kind::Scene).contains("is empty"));
        std::fs::write(folder.path().join("odd.glb"), b"#?RADIANCE\n").unwrap();
        assert!(said("odd.glb", Kind::Scene).contains("--probe") && said("odd.glb", Kind::Probe).is_empty());
        let dashed = about(Path::new("builtin-atrium"), Kind::Scene, &["atrium"]);
        assert!(dashed.unwrap().contains("did you mean builtin:atrium?"));
        assert!(about(Path::new("builtin:atrium"), Kind::Baked, &[]).unwrap().contains("relume bake builtin:atrium"));
        assert!(about(Path::new(""), Kind::Scene, &[]).unwrap().contains("empty"));
        let builtin = about(Path::new("atrium"), Kind::Scene, &["atrium"]);
        assert!(builtin.unwrap().contains("builtin:atrium"));
    }
}
