//! Warnings as they are shown: alike ones joined, names without control characters.

use std::collections::{HashMap, HashSet};

use crate::{Error, Report, Warning};

/// Most objects that one warning names; the others are counted.
const NAMED: usize = 3;

/// The text with control characters, and characters that turn the direction of text, written as escapes.
///
/// Names come from files of strangers; printed as they are they could move the cursor or hide a line.
pub fn printable(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            c if c.is_control() => shown.extend(c.escape_default()),
            // Line separators, marks and overrides of direction, and the byte order mark.
            '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}' => {
                shown.extend(character.escape_unicode());
            }
            c => shown.push(c),
        }
    }
    shown
}

/// Up to three of the names, and how many more there are.
pub(crate) fn listed<S: AsRef<str>>(names: &[S]) -> String {
    let shown: Vec<&str> = names.iter().take(NAMED).map(AsRef::as_ref).collect();
    let shown = shown.join(", ");
    if names.len() > NAMED { format!("{shown} and {} more", names.len() - NAMED) } else { shown }
}

impl Report {
    /// Joins warnings that say the same of several objects, and makes all of them printable.
    pub(crate) fn join_alike(&mut self) {
        let mut kinds: Vec<(String, Vec<String>)> = Vec::new();
        let (mut place, mut known) = (HashMap::new(), HashSet::new());
        for Warning { object, message } in std::mem::take(&mut self.warnings) {
            let kind = *place.entry(message.clone()).or_insert(kinds.len());
            if kind == kinds.len() {
                kinds.push((message, Vec::new()));
            }
            let object = printable(&object);
            if known.insert((kind, object.clone())) {
                kinds[kind].1.push(object);
            }
        }
        self.warnings = kinds
            .into_iter()
            .map(|(message, objects)| Warning { object: listed(&objects), message: printable(&message) })
            .collect();
    }
}

impl Error {
    /// The same error with printable names.
    pub(crate) fn printable(self) -> Self {
        match self {
            Self::Unsupported { file, object, value, hint } => {
                Self::Unsupported { file, object: printable(&object), value: printable(&value), hint: printable(&hint) }
            }
            Self::Invalid { file, object, what } => {
                Self::Invalid { file, object: printable(&object), what: printable(&what) }
            }
            Self::Io { file, object, source } => Self::Io { file, object: printable(&object), source },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report(warnings: &[(&str, &str)]) -> Vec<(String, String)> {
        let warning = |&(object, message): &(&str, &str)| Warning { object: object.into(), message: message.into() };
        let mut report = Report { warnings: warnings.iter().map(warning).collect(), ..Report::default() };
        report.join_alike();
        report.warnings.into_iter().map(|w| (w.object, w.message)).collect()
    }

    #[test]
    fn three_hundred_lamps_are_one_warning() {
        let lamps: Vec<String> = (0..300).map(|i| format!("lamp {i}")).collect();
        let mut warnings: Vec<(&str, &str)> = lamps.iter().map(|lamp| (lamp.as_str(), "is left out")).collect();
        warnings.insert(7, ("box", "is grey"));
        let joined = report(&warnings);
        let lamps = "lamp 0, lamp 1, lamp 2 and 297 more";
        assert_eq!(joined, [(lamps.into(), "is left out".into()), ("box".into(), "is grey".into())]);
    }

    #[test]
    fn warnings_that_differ_stay_apart() {
        assert_eq!(report(&[("a", "x"), ("a", "y"), ("b", "x"), ("a", "x")]).len(), 2);
        assert_eq!(report(&[("a", "x"), ("b", "x")])[0].0, "a, b");
    }

    #[test]
    fn control_characters_are_escaped() {
        let joined = report(&[("a\u{1b}[2J\nb", "x\u{202e}y")]);
        assert_eq!(joined, [("a\\u{1b}[2J\\nb".into(), "x\\u{202e}y".into())]);
        assert_eq!(printable("Größe 日本 é"), "Größe 日本 é", "letters stay");
    }
}
