//! The statements of an OBJ file as lists of vertices and groups of faces.
//!
//! Statements are read here, not by `tobj`: its positions are f32, its errors name no line, and one index that points
//! nowhere refuses the file. A text made canonical for it would need every check that stands here, and a second copy
//! of a large file.

use std::path::Path;

use glam::{DVec3, Vec2, Vec3};

use super::text::{self, keyword, number, statements, words};
use crate::origin::{self, Extent};
use crate::warnings::listed;
use crate::{Error, Report, Warning};

/// The index of an attribute that a corner does not have.
pub(super) const NONE: u32 = u32::MAX;

/// Position, texture coordinate and normal of a face's corner; the last two may be [`NONE`].
pub(super) type Corner = [u32; 3];

/// What an OBJ file holds.
#[derive(Debug, Default)]
pub(super) struct Content {
    /// Metres, as they stand.
    pub(super) positions: Vec<DVec3>,
    /// Linear, as many as positions, or none.
    pub(super) colors: Vec<Vec3>,
    pub(super) coordinates: Vec<Vec2>,
    pub(super) normals: Vec<Vec3>,
    /// In the order of the file; none is empty.
    pub(super) groups: Vec<Group>,
    /// What follows each `mtllib`, once each.
    pub(super) libraries: Vec<String>,
}

impl Content {
    /// Takes the common origin of far vertices off them, before they are rounded to f32.
    pub(super) fn take_origin(&mut self, report: &mut Report) -> [f64; 3] {
        let mut extent = Extent::new();
        self.positions.iter().for_each(|position| extent.add(*position));
        let origin = extent.common_origin();
        if origin != DVec3::ZERO {
            self.positions.iter_mut().for_each(|position| *position -= origin);
            report.warnings.push(Warning { object: "scene".into(), message: origin::message(origin) });
        }
        origin.to_array()
    }
}

/// Faces with one name and one material.
#[derive(Debug, Default, Clone)]
pub(super) struct Group {
    pub(super) name: String,
    /// What follows `usemtl`.
    pub(super) material: Option<String>,
    /// Of all faces, one after the other.
    pub(super) corners: Vec<Corner>,
    /// Number of corners of each face.
    pub(super) arities: Vec<u32>,
}

/// Names of what the three indices of a corner stand for.
const KINDS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// Reads all statements of a text.
///
/// Refuses, with the line, numbers that are none and vertices that are not there. Indices of coordinates and normals
/// that point nowhere leave the corner without; points, lines and vertex colours of a part of the vertices are
/// dropped. Each is counted in a warning.
///
/// # Errors
/// [`Error::Invalid`] with the line.
pub(super) fn parse(file: &Path, text: &str, report: &mut Report) -> Result<Content, Error> {
    let mut parser = Parser::new(text);
    for (line, statement) in statements(text) {
        parser.read(line, &statement).map_err(|what| Error::invalid(file, format!("line {line}"), what))?;
    }
    Ok(parser.finish(report))
}

/// How often something was met, and where first.
#[derive(Debug, Default)]
struct Tally {
    count: usize,
    first: String,
}

impl Tally {
    fn add(&mut self, place: impl FnOnce() -> String) {
        if self.count == 0 {
            self.first = place();
        }
        self.count += 1;
    }
}

struct Parser {
    content: Content,
    /// The group that grows.
    group: Group,
    /// Numbers of vertices, coordinates and normals in the whole text: indices may point ahead.
    total: [usize; 3],
    colored: usize,
    used: Vec<bool>,
    dropped: usize,
    /// Indices of coordinates and normals that point nowhere.
    nowhere: [Tally; 3],
    /// Statements of curves and free surfaces.
    free: Tally,
}

impl Parser {
    fn new(text: &str) -> Self {
        let mut total = [0; 3];
        for (_, statement) in statements(text) {
            if let Some(kind) = kind_of(keyword(&statement).0) {
                total[kind] += 1;
            }
        }
        Self {
            content: Content { positions: Vec::with_capacity(total[0]), ..Content::default() },
            group: Group { name: "unnamed_object".into(), ..Group::default() },
            total,
            colored: 0,
            used: vec![false; total[0]],
            dropped: 0,
            nowhere: Default::default(),
            free: Tally::default(),
        }
    }

    fn read(&mut self, line: usize, statement: &str) -> Result<(), String> {
        let (keyword, rest) = keyword(statement);
        match keyword {
            "v" => self.vertex(rest)?,
            "vt" => {
                // A coordinate of one number lies on a line.
                let [u, v, _] = numbers(keyword, rest, 1, [0.0; 3])?;
                self.content.coordinates.push(Vec2::new(u as f32, v as f32));
            }
            "vn" => {
                let normal = numbers(keyword, rest, 3, [0.0; 3])?;
                self.content.normals.push(DVec3::from(normal).as_vec3());
            }
            "f" | "fo" => self.face(line, rest)?,
            "l" | "p" => self.dropped += 1,
            "o" | "g" => {
                self.close();
                let name = text::name(rest);
                self.group.name = if name.is_empty() { "unnamed_object".into() } else { name.to_owned() };
            }
            "usemtl" if !rest.is_empty() && self.group.material.as_deref() != Some(rest) => {
                self.close();
                self.group.material = Some(rest.to_owned());
            }
            "mtllib" if !rest.is_empty() && !self.content.libraries.iter().any(|known| known == rest) => {
                self.content.libraries.push(rest.to_owned());
            }
            "curv" | "curv2" | "surf" => self.free.add(|| format!("line {line}")),
            // Comments and everything that has no meaning here.
            _ => {}
        }
        Ok(())
    }

    /// Ends the group that grows; the next one has its name and material.
    fn close(&mut self) {
        if !self.group.arities.is_empty() {
            let next = Group { corners: Vec::new(), arities: Vec::new(), ..self.group.clone() };
            self.content.groups.push(std::mem::replace(&mut self.group, next));
        }
    }

    /// `x y z`, `x y z weight` or `x y z red green blue`.
    fn vertex(&mut self, rest: &str) -> Result<(), String> {
        let mut position = DVec3::from(numbers("v", rest, 3, [0.0; 3])?);
        let more: Vec<&str> = words(rest).skip(3).collect();
        let parsed = |word: &str| number(word).ok_or_else(|| format!("{word:?} is not a number"));
        if let [weight] = more[..] {
            let weight = parsed(weight)?;
            if weight == 0.0 {
                return Err("the weight (fourth number) of a vertex is 0".into());
            }
            position /= weight;
        }
        if let [r, g, b, ..] = more[..] {
            let color = DVec3::new(parsed(r)?, parsed(g)?, parsed(b)?);
            self.content.colors.push(color.as_vec3());
            self.colored += 1;
        }
        self.content.positions.push(position);
        Ok(())
    }

    fn face(&mut self, line: usize, rest: &str) -> Result<(), String> {
        let start = self.group.corners.len();
        for word in words(rest) {
            let corner = self.corner(line, word)?;
            self.group.corners.push(corner);
        }
        let arity = self.group.corners.len() - start;
        if arity < 3 {
            self.group.corners.truncate(start);
            self.dropped += 1;
            return Ok(());
        }
        for corner in &self.group.corners[start..] {
            self.used[corner[0] as usize] = true;
        }
        self.group.arities.push(arity as u32);
        Ok(())
    }

    /// `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    fn corner(&mut self, line: usize, word: &str) -> Result<Corner, String> {
        let mut corner = [NONE; 3];
        for (kind, part) in word.split('/').enumerate() {
            let name = KINDS.get(kind).ok_or_else(|| format!("{word:?} has too many parts"))?;
            if part.is_empty() && kind == 0 {
                return Err(format!("{word:?} names no vertex"));
            }
            if part.is_empty() {
                continue;
            }
            let index: i64 = part.parse().map_err(|_| format!("{part:?} in {word:?} is not an index"))?;
            let (so_far, total) = (self.so_far(kind), self.total[kind]);
            // Negative indices count back from the last one given so far.
            let place = if index < 0 { so_far.checked_add(index) } else { Some(index - 1) };
            match place.filter(|place| (0..total as i64).contains(place)) {
                Some(place) => corner[kind] = place as u32,
                None if kind == 0 => return Err(format!("{name} index {index}, but there are {total}")),
                None => self.nowhere[kind].add(|| format!("line {line}: {index} of {total}")),
            }
        }
        Ok(corner)
    }

    fn so_far(&self, kind: usize) -> i64 {
        let content = &self.content;
        [content.positions.len(), content.coordinates.len(), content.normals.len()][kind] as i64
    }

    fn finish(mut self, report: &mut Report) -> Content {
        self.close();
        let mut warn = |object: &str, message: String| {
            report.warnings.push(Warning { object: object.into(), message });
        };
        let vertices = self.content.positions.len();
        if self.colored > 0 && self.colored != vertices {
            warn("vertices", format!("{} of {vertices} have colours; the colours were dropped", self.colored));
            self.content.colors.clear();
        }
        if self.dropped > 0 {
            let dropped = self.dropped;
            warn("faces", format!("{dropped} points, lines or faces of fewer than three corners were dropped"));
        }
        for (kind, Tally { count, first }) in KINDS.iter().zip(&self.nowhere).filter(|(_, tally)| tally.count > 0) {
            let message = format!("{count} {kind} indices point nowhere (first {first}); these corners have none");
            warn("faces", message);
        }
        if self.free.count > 0 {
            let Tally { count, first } = &self.free;
            let message = format!("{count} (first {first}) are not supported and were left out; convert them to faces");
            warn("curves and free-form surfaces", message);
        }
        report.unused_vertices += self.used.iter().filter(|used| !**used).count();
        self.content
    }
}

/// Which of [`KINDS`] a keyword gives.
fn kind_of(keyword: &str) -> Option<usize> {
    ["v", "vt", "vn"].iter().position(|kind| *kind == keyword)
}

/// The first three numbers of a statement; those after the `needed` ones may be missing and stand in `unsaid`.
fn numbers(keyword: &str, rest: &str, needed: usize, unsaid: [f64; 3]) -> Result<[f64; 3], String> {
    let mut values = unsaid;
    let mut count = 0;
    for (value, word) in values.iter_mut().zip(words(rest)) {
        *value = number(word).ok_or_else(|| format!("{word:?} is not a number"))?;
        count += 1;
    }
    if count < needed { Err(format!("{keyword:?} has {count} numbers instead of {needed}")) } else { Ok(values) }
}

/// Warns once of the materials that faces use and no library defines.
pub(super) fn warn_of_unknown(names: &[&str], report: &mut Report) {
    if !names.is_empty() {
        let object = format!("material {}", listed(names));
        report.warnings.push(Warning { object, message: "is used but not defined; grey is used".into() });
    }
}
