//! MTL libraries: which files they are, and their statements by material.

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
}

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
        known(used).or_else(|| known(name(used))).or_else(|| known(before_hash(used)?))
    }

    fn add(&mut self, text: &str, library: &str, near: &str, report: &mut Report) {
        // Statements before the first name belong to nothing.
        let mut current: Option<Source> = None;
        for (line, statement) in statements(text) {
            let (word, rest) = keyword(&statement);
            let lower = word.to_ascii_lowercase();
            let read = if lower == "newmtl" {
                self.finish(current.take());
                let new = || Source { name: rest.to_owned(), near: near.to_owned(), ..Source::default() };
                current = (!rest.is_empty()).then(new);
                current.is_some()
            } else {
                current.as_mut().unwrap_or(&mut Source::default()).read(&lower, rest).is_some()
            };
            if !read {
                let object = format!("mtllib {library}, line {line}: {:?}", statement.trim());
                report.warnings.push(Warning { object, message: "cannot be read and was ignored".into() });
            }
        }
        self.finish(current);
    }

    fn finish(&mut self, material: Option<Source>) {
        let Some(mut material) = material else { return };
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
    /// Obeys one statement; `None` where it cannot be read.
    fn read(&mut self, keyword: &str, rest: &str) -> Option<()> {
        match keyword {
            "kd" => self.diffuse = Some(color(rest)?),
            "ks" => self.specular = Some(color(rest)?),
            "ke" => self.emissive = Some(color(rest)?),
            "ka" => drop(color(rest)?),
            "ns" => self.exponent = Some(scalar(rest)?),
            "d" => self.opacity = Some(scalar(rest)?),
            "tr" => self.transparency = Some(scalar(rest)?),
            "pr" => self.roughness = Some(scalar(rest)?),
            "pm" => self.metallic = Some(scalar(rest)?),
            "illum" => self.illumination = Some(words(rest).next()?.parse().ok()?),
            "map_kd" => self.color_map = Some(Map::parse(rest)?),
            "map_d" => self.coverage_map = Some(Map::parse(rest)?),
            "norm" => self.normal_map = Some(Map::parse(rest)?),
            "map_ke" => self.emissive_map = Some(Map::parse(rest)?),
            "bump" | "map_bump" => self.has_bump = Map::parse(rest).map(|_| true)?,
            // Comments and everything that has no meaning here.
            _ => {}
        }
        Some(())
    }
}

/// Three finite numbers, or one for all three.
fn color(text: &str) -> Option<Vec3> {
    let numbers: Vec<f32> = words(text).map_while(number).take(3).map(|x| x as f32).collect();
    let color = match numbers[..] {
        [grey] => Vec3::splat(grey),
        [r, g, b] => Vec3::new(r, g, b),
        _ => return None,
    };
    color.is_finite().then_some(color)
}

/// The first finite number, after options such as `-halo`.
fn scalar(text: &str) -> Option<f32> {
    words(text).find_map(number).map(|x| x as f32).filter(|x| x.is_finite())
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
