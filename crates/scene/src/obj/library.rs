//! MTL libraries: which files they are, and their statements by material.
//!
//! Statements are read by `tobj` from a text that was made canonical: as they stand in files, one that is odd ends its
//! reading or makes it panic.

use std::collections::HashMap;
use std::path::Path;

use glam::Vec3;

use super::map::Map;
use super::text::{self, before_hash, keyword, name, number, statements, words};
use crate::folder::{Folder, folder_of};
use crate::{Report, Warning};

/// All materials of the libraries that a file names.
#[derive(Debug, Default)]
pub(super) struct Library {
    /// In the order of the files.
    pub(super) materials: Vec<Source>,
    /// By name as it stands, and without what follows a `#`.
    exact: HashMap<String, usize>,
    cut: HashMap<String, usize>,
    /// Folder of the library and name of every picture, read or not.
    pictures: Vec<(String, String)>,
}

/// Keywords of pictures that do not begin with `map_`.
const MAPS: [&str; 6] = ["bump", "norm", "disp", "decal", "refl", "displacement"];
/// Pictures that mean something to the surface and are not read.
const UNREAD: [&str; 10] =
    ["map_ks", "map_ns", "map_pr", "map_pm", "map_tr", "map_opacity", "disp", "displacement", "map_disp", "decal"];

/// The statements of one material.
#[derive(Debug, Default, Clone)]
pub(super) struct Source {
    pub(super) name: String,
    /// Folder of its library below that of the scene.
    pub(super) near: String,
    pub(super) diffuse: Option<Vec3>,
    pub(super) specular: Option<Vec3>,
    pub(super) emissive: Option<Vec3>,
    pub(super) exponent: Option<f32>,
    /// `d` and `Tr`.
    pub(super) opacity: Option<f32>,
    pub(super) transparency: Option<f32>,
    pub(super) roughness: Option<f32>,
    pub(super) metallic: Option<f32>,
    pub(super) illumination: Option<u8>,
    pub(super) color_map: Option<Map>,
    pub(super) coverage_map: Option<Map>,
    pub(super) normal_map: Option<Map>,
    pub(super) emissive_map: Option<Map>,
    pub(super) has_bump: bool,
}

impl Library {
    /// The material that a `usemtl` means: with or without a comment behind either name.
    pub(super) fn find(&self, used: &str) -> Option<usize> {
        let known = |name: &str| self.exact.get(name).or_else(|| self.cut.get(name)).copied();
        let cut = || known(name(used)).or_else(|| known(before_hash(used)?));
        known(used).or_else(cut).or_else(|| known(unquoted(used)))
    }

    fn add(&mut self, text: &str, library: &str, near: &str, report: &mut Report) {
        let mut warn = |object: String, message: String| report.warnings.push(Warning { object, message });
        let mut cleaned = String::new();
        // Statements before the first name, or after one that is missing, belong to nothing.
        let mut named = false;
        let mut material = String::new();
        for (line, statement) in statements(text) {
            let (word, rest) = keyword(&statement);
            let lower = word.to_ascii_lowercase();
            let read = canonical(&lower, rest);
            if let Some(map) = Map::parse(rest).filter(|_| lower.starts_with("map_") || MAPS.contains(&lower.as_str()))
            {
                self.pictures.push((near.to_owned(), map.file));
                if named && UNREAD.contains(&lower.as_str()) {
                    warn(
                        format!("material {material}"),
                        format!("the picture of {word} is not supported and was left out"),
                    );
                }
            }
            if lower == "newmtl" {
                named = read.is_some();
                material = name(rest).to_owned();
            }
            match read {
                Some(read) if named => cleaned.push_str(&read),
                Some(_) => {}
                None => {
                    let object = format!("mtllib {library}, line {line}: {:?}", statement.trim());
                    warn(object, "cannot be read and was ignored".into());
                }
            }
        }
        match tobj::load_mtl_buf(&mut cleaned.as_bytes()) {
            Ok((materials, _)) => materials.into_iter().for_each(|m| self.push(Source::new(m, near))),
            Err(error) => warn(format!("mtllib {library}"), error.to_string()),
        }
    }

    fn push(&mut self, mut material: Source) {
        let index = self.materials.len();
        self.exact.insert(material.name.clone(), index);
        for cut in [Some(name(&material.name)), before_hash(&material.name)].into_iter().flatten() {
            self.cut.entry(cut.to_owned()).or_insert(index);
        }
        material.name = name(&material.name).to_owned();
        self.materials.push(material);
    }
}

impl Source {
    /// What a material says that was read from [`canonical`] statements.
    fn new(material: tobj::Material, near: &str) -> Self {
        let other = |key: &str| material.unknown_param.get(key);
        let number = |key: &str| other(key)?.parse().ok();
        let map = |text: Option<&String>| Map::parse(text?);
        Self {
            near: near.to_owned(),
            diffuse: material.diffuse.map(Vec3::from),
            specular: material.specular.map(Vec3::from),
            emissive: material.emissive.map(Vec3::from),
            exponent: material.shininess,
            opacity: material.dissolve,
            transparency: number("Tr"),
            roughness: number("Pr"),
            metallic: number("Pm"),
            illumination: material.illumination_model,
            color_map: map(material.diffuse_texture.as_ref()),
            coverage_map: map(material.dissolve_texture.as_ref()),
            normal_map: map(other("norm")),
            emissive_map: map(other("map_Ke")),
            has_bump: material.normal_texture.is_some(),
            name: material.name,
        }
    }
}

/// The line of a statement as `tobj` reads it, empty where it has no meaning here; `None` where it cannot be read.
fn canonical(keyword: &str, rest: &str) -> Option<String> {
    let map = |text: &str| Map::parse(text).map(|_| text.to_owned());
    let (spelled, value) = match keyword {
        "newmtl" => ("newmtl", Some(rest.to_owned()).filter(|name| !name.is_empty())),
        "kd" => ("Kd", color(rest)),
        "ks" => ("Ks", color(rest)),
        "ke" => ("Ke", color(rest)),
        "ka" => ("Ka", color(rest)),
        "ns" => ("Ns", scalar(rest)),
        "d" => ("d", scalar(rest)),
        "tr" => ("Tr", scalar(rest)),
        "pr" => ("Pr", scalar(rest)),
        "pm" => ("Pm", scalar(rest)),
        "illum" => ("illum", words(rest).next()?.parse().ok().map(|model: u8| model.to_string())),
        "map_kd" => ("map_Kd", map(rest)),
        "map_d" => ("map_d", map(rest)),
        "norm" => ("norm", map(rest)),
        "map_ke" => ("map_Ke", map(rest)),
        "bump" | "map_bump" => ("bump", map(rest)),
        // Comments and everything that has no meaning here.
        _ => return Some(String::new()),
    };
    value.map(|value| format!("{spelled} {value}\n"))
}

/// Three finite numbers, or one for all three.
fn color(text: &str) -> Option<String> {
    let numbers: Vec<f32> = words(text).map_while(number).take(3).map(|x| x as f32).collect();
    let [r, g, b] = match numbers[..] {
        [grey] => [grey; 3],
        [r, g, b] => [r, g, b],
        _ => return None,
    };
    [r, g, b].iter().all(|x| x.is_finite()).then(|| format!("{r} {g} {b}"))
}

/// The first finite number, after options such as `-halo`.
fn scalar(text: &str) -> Option<String> {
    words(text).find_map(number).map(|x| x as f32).filter(|x| x.is_finite()).map(|x| x.to_string())
}

/// Reads the libraries that `mtllib` statements of `file` name; what is missing becomes a warning.
pub(super) fn read(folder: &Folder, file: &Path, stated: &[String], report: &mut Report) -> Library {
    let mut library = Library::default();
    let mut known = Vec::new();
    for statement in stated {
        let found = find_all(folder, statement, report);
        let found = if found.is_empty() { instead(folder, file, statement, report) } else { found };
        for (path, bytes) in found {
            if !known.contains(&path) {
                library.add(&text::decode(&bytes), &path, folder_of(&path), report);
                known.push(path);
            }
        }
    }
    library.pictures.iter().for_each(|(near, picture)| folder.mention(near, picture));
    library
}

/// The files of one statement: one name that may hold blanks, or several.
fn find_all(folder: &Folder, statement: &str, report: &mut Report) -> Vec<(String, Vec<u8>)> {
    for whole in [Some(statement), Some(name(statement)), before_hash(statement)].into_iter().flatten() {
        if let Ok(found) = folder.find("", unquoted(whole)) {
            return vec![found];
        }
    }
    let mut found = Vec::new();
    for part in names(before_hash(statement).unwrap_or(statement)) {
        match folder.find("", unquoted(&part)) {
            Ok(file) => found.push(file),
            Err(missing) => {
                let parts: Vec<_> = part.split_whitespace().filter_map(|word| folder.find("", word).ok()).collect();
                if parts.is_empty() {
                    let warning = Warning { object: format!("mtllib {part}"), message: missing.to_string() };
                    report.warnings.push(warning);
                }
                found.extend(parts);
            }
        }
    }
    found
}

/// The library that is called as the scene file, where the one named is not there: files are renamed together.
fn instead(folder: &Folder, file: &Path, statement: &str, report: &mut Report) -> Vec<(String, Vec<u8>)> {
    let Some(stem) = file.file_stem().map(|stem| stem.to_string_lossy()) else { return Vec::new() };
    let Ok((path, bytes)) = folder.find("", &format!("{stem}.mtl")) else { return Vec::new() };
    let message = format!("is not there; {path} was read instead");
    report.warnings.push(Warning { object: format!("mtllib {statement}"), message });
    vec![(path, bytes)]
}

/// Names of which each ends in `.mtl`; the words of a name are joined.
fn names(statement: &str) -> Vec<String> {
    let mut names = Vec::new();
    let mut name = String::new();
    for word in statement.split_whitespace() {
        name = if name.is_empty() { word.to_owned() } else { format!("{name} {word}") };
        if name.to_ascii_lowercase().trim_end_matches('"').ends_with(".mtl") {
            names.push(std::mem::take(&mut name));
        }
    }
    names.extend(Some(name).filter(|name| !name.is_empty()));
    names
}

fn unquoted(name: &str) -> &str {
    name.trim_matches('"')
}

#[cfg(test)]
mod tests {
    use super::*;

    const ODD: &str = "Kd 1 1 1\nd\nnewmtl\nNs 7\nnewmtl a b #1\nkd 0,5 # grey\nKs 1 2\nKe 1.#IND 0 0\nTR -halo 0.25\n\
        illum 300\nillum 2 x\nmap_kd -s 2 2\nMAP_KD -s 2 my tex.png\nPr 0.1\nd 1e39\nd 0.1\nmap_Bump b.png\n#Kd 1\n";

    #[test]
    fn odd_statements_are_mended_or_told() {
        let (mut library, mut report) = (Library::default(), Report::default());
        library.add(ODD, "odd.mtl", "looks/", &mut report);
        let [a] = &library.materials[..] else { panic!("one has a name: {library:?}") };
        assert_eq!((a.name.as_str(), a.near.as_str()), ("a b #1", "looks/"));
        assert_eq!((a.diffuse, a.specular, a.emissive), (Some(Vec3::splat(0.5)), None, None));
        assert_eq!((a.opacity, a.transparency, a.roughness), (Some(0.1), Some(0.25), Some(0.1)));
        assert_eq!((a.illumination, a.exponent, a.has_bump), (Some(2), None, true));
        assert_eq!(a.color_map, Map::parse("-s 2 my tex.png"));
        let line = |w: &Warning| w.object.split([' ', ':']).nth(3).and_then(|line| line.parse().ok()).unwrap_or(0);
        assert_eq!(report.warnings.iter().map(line).collect::<Vec<_>>(), [2, 3, 7, 8, 10, 12, 15]);
    }

    #[test]
    fn odd_statements_as_they_stand_can_fail() {
        let read = |text: &'static str| std::panic::catch_unwind(|| tobj::load_mtl_buf(&mut text.as_bytes()).is_ok());
        assert!(matches!(read(ODD), Ok(false)) && read("Ks 1 2\n").is_err());
    }
}
