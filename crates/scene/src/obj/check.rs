//! The statements of an OBJ file, checked line by line before they are parsed.

use std::collections::BTreeSet;
use std::path::Path;

use crate::{Error, Report, Warning};

/// Numbers of vertices, texture coordinates and normals.
type Counts = [i64; 3];

/// A copy of the text in which every vertex and face statement is one that the parser reads rightly.
///
/// Refuses, with the line, numbers that are none and indices that point nowhere. Drops lines, points and faces of
/// fewer than three corners (counted in a warning), and vertex colours that not all vertices have.
pub(super) fn clean(file: &Path, text: &str, report: &mut Report) -> Result<String, Error> {
    // Statements may go on after a backslash at the end of a line.
    let text = text.replace("\\\r\n", " ").replace("\\\n", " ");
    let (total, colored) = count(&text);
    let keep_colors = colored == total[0];
    if colored > 0 && !keep_colors {
        warn(report, "vertices", format!("{colored} of {} have colours; the colours were dropped", total[0]));
    }
    let mut cleaned = String::with_capacity(text.len());
    let mut so_far: Counts = [0; 3];
    let mut used = vec![false; total[0] as usize];
    let mut dropped = 0;
    for (line, statement) in text.lines().enumerate() {
        let invalid = |what: String| Error::invalid(file, format!("line {}", line + 1), what);
        let mut words = words(statement);
        let (keyword, words) = match words.next() {
            Some(keyword) => (keyword, words.collect::<Vec<_>>()),
            None => ("", Vec::new()),
        };
        match keyword {
            "v" | "vt" | "vn" => {
                let kind = ["v", "vt", "vn"].iter().position(|k| *k == keyword).unwrap_or(0);
                so_far[kind] += 1;
                let kept = numbers(keyword, &words, keep_colors).map_err(invalid)?;
                cleaned.push_str(&format!("{keyword} {}", kept.join(" ")));
            }
            "f" | "fo" if words.len() >= 3 => {
                for corner in &words {
                    check_corner(corner, so_far, total, &mut used).map_err(invalid)?;
                }
                cleaned.push_str(&format!("f {}", words.join(" ")));
            }
            "f" | "fo" | "l" | "p" => dropped += 1,
            // The parser stops at these statements where they lack their argument.
            "usemtl" | "mtllib" if words.is_empty() => {}
            "o" | "g" | "usemtl" | "mtllib" => {
                // Names may hold spaces and hashes, so they are taken whole.
                let name = statement.trim_start().get(keyword.len()..).unwrap_or_default().trim();
                cleaned.push_str(&format!("{keyword} {name}"));
            }
            // Comments and everything that has no meaning here.
            _ => {}
        }
        cleaned.push('\n');
    }
    if dropped > 0 {
        warn(report, "faces", format!("{dropped} points, lines or faces of fewer than three corners were dropped"));
    }
    report.unused_vertices += used.iter().filter(|used| !**used).count();
    Ok(cleaned)
}

/// Warns once of each material that is used and not defined.
pub(super) fn warn_of_unknown_materials(text: &str, materials: &[tobj::Material], report: &mut Report) {
    let known: BTreeSet<&str> = materials.iter().map(|m| m.name.as_str()).collect();
    let used: BTreeSet<&str> = text.lines().filter_map(|l| l.strip_prefix("usemtl ")).map(str::trim).collect();
    for name in used.difference(&known) {
        warn(report, format!("material {name}"), "is used but not defined; grey is used".into());
    }
}

fn warn(report: &mut Report, object: impl Into<String>, message: String) {
    report.warnings.push(Warning { object: object.into(), message });
}

/// The words of a statement before a comment.
fn words(statement: &str) -> impl Iterator<Item = &str> {
    statement.split('#').next().unwrap_or_default().split_whitespace()
}

/// Numbers of statements in the whole text, and of vertices with a colour.
fn count(text: &str) -> (Counts, i64) {
    let (mut total, mut colored) = ([0; 3], 0);
    for statement in text.lines() {
        let mut words = words(statement);
        match words.next() {
            Some("v") => {
                total[0] += 1;
                colored += i64::from(words.count() >= 6);
            }
            Some("vt") => total[1] += 1,
            Some("vn") => total[2] += 1,
            _ => {}
        }
    }
    (total, colored)
}

/// The numbers of a vertex statement that the parser needs; says which is none.
fn numbers<'a>(keyword: &str, words: &'a [&'a str], keep_colors: bool) -> Result<Vec<&'a str>, String> {
    let needed = if keyword == "vt" { 2 } else { 3 };
    let kept = match (keyword, words.len()) {
        ("v", 6..) if keep_colors => 6,
        // A fourth number is a weight.
        ("v", 4) => 4,
        // A texture coordinate of one number lies on a line.
        ("vt", 1) => 1,
        _ => needed,
    };
    let Some(words) = words.get(..kept) else {
        return Err(format!("{keyword:?} has {} numbers instead of {needed}", words.len()));
    };
    for word in words {
        word.parse::<f32>().map_err(|_| format!("{word:?} is not a number"))?;
    }
    if keyword == "v" && kept == 4 && words[3].parse() == Ok(0.0f32) {
        return Err("the weight (fourth number) of a vertex is 0".into());
    }
    let mut numbers = words.to_vec();
    if keyword == "vt" && kept == 1 {
        numbers.push("0");
    }
    Ok(numbers)
}

/// Checks the indices of a face's corner (`v`, `v/vt`, `v//vn`, `v/vt/vn`) and marks the vertex as used.
fn check_corner(corner: &str, so_far: Counts, total: Counts, used: &mut [bool]) -> Result<(), String> {
    for (kind, word) in corner.split('/').enumerate() {
        let name =
            ["vertex", "texture coordinate", "normal"].get(kind).ok_or(format!("{corner:?} has too many parts"))?;
        if word.is_empty() {
            if kind == 0 {
                return Err(format!("{corner:?} names no vertex"));
            }
            continue;
        }
        let index: i64 = word.parse().map_err(|_| format!("{word:?} in {corner:?} is not an index"))?;
        // Negative indices count back from the last one given so far.
        let place = if index < 0 { so_far[kind].checked_add(index) } else { Some(index - 1) };
        match place.filter(|place| (0..total[kind]).contains(place)) {
            Some(place) if kind == 0 => used[place as usize] = true,
            Some(_) => {}
            None => return Err(format!("{name} index {index}, but there are {}", total[kind])),
        }
    }
    Ok(())
}
