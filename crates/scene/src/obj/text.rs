//! The text of OBJ and MTL files: encodings, ends of lines, statements with their line numbers, words and numbers.

use std::borrow::Cow;

/// The text of a file: UTF-8 with or without a byte order mark, UTF-16 of either order, else Latin-1.
pub(super) fn decode(bytes: &[u8]) -> Cow<'_, str> {
    let wide = |bytes: &[u8], unit: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes.as_chunks::<2>().0.iter().map(|pair| unit(*pair)).collect();
        Cow::Owned(String::from_utf16_lossy(&units))
    };
    match bytes {
        [0xef, 0xbb, 0xbf, rest @ ..] => decode(rest),
        [0xff, 0xfe, rest @ ..] => wide(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => wide(rest, u16::from_be_bytes),
        // Without a mark: every other byte of ASCII text is zero.
        [1..=255, 0, 1..=255, 0, ..] => wide(bytes, u16::from_le_bytes),
        [0, 1..=255, 0, 1..=255, ..] => wide(bytes, u16::from_be_bytes),
        _ => match str::from_utf8(bytes) {
            Ok(text) => Cow::Borrowed(text),
            Err(_) => Cow::Owned(bytes.iter().map(|byte| char::from(*byte)).collect()),
        },
    }
}

/// The statements of a text with the numbers of their first lines, from 1.
///
/// Lines end in LF, CR LF or CR. A backslash at the end of a line that is no comment joins the next one.
pub(super) fn statements(text: &str) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let mut lines = Lines { rest: text, number: 0 };
    std::iter::from_fn(move || {
        let first = lines.next()?;
        let number = lines.number;
        if first.trim_start().starts_with('#') {
            return Some((number, Cow::Borrowed(first)));
        }
        let mut statement = Cow::Borrowed(first);
        while let Some(start) = statement.trim_end().strip_suffix('\\') {
            statement = Cow::Owned(format!("{start} {}", lines.next().unwrap_or_default()));
        }
        Some((number, statement))
    })
}

struct Lines<'a> {
    rest: &'a str,
    /// Of the line given last.
    number: usize,
}

impl<'a> Lines<'a> {
    fn next(&mut self) -> Option<&'a str> {
        if self.rest.is_empty() {
            return None;
        }
        self.number += 1;
        let Some(end) = self.rest.find(['\n', '\r']) else { return Some(std::mem::take(&mut self.rest)) };
        let line = &self.rest[..end];
        let after = &self.rest[end..];
        self.rest = after.strip_prefix("\r\n").unwrap_or(&after[1..]);
        Some(line)
    }
}

/// The words of a statement before a comment. The `#` of numbers that a C library printed (`1.#IND`) begins none.
pub(super) fn words(statement: &str) -> impl Iterator<Item = &str> {
    let mut over = false;
    statement.split_whitespace().map_while(move |word| {
        if over {
            return None;
        }
        match word.find('#') {
            Some(0) => None,
            Some(at) if !word[..at].ends_with('.') => {
                over = true;
                Some(&word[..at])
            }
            _ => Some(word),
        }
    })
}

/// The keyword of a statement, and what follows it up to the end of the line, comments included.
pub(super) fn keyword(statement: &str) -> (&str, &str) {
    // Files that were put together have byte order marks within.
    let statement = statement.trim_matches(|c: char| c.is_whitespace() || c == '\u{feff}');
    let (keyword, rest) = statement.split_once(char::is_whitespace).unwrap_or((statement, ""));
    (keyword, rest.trim())
}

/// A name without the comment after it: what follows a `#` that stands between blanks.
pub(super) fn name(text: &str) -> &str {
    let comment = text.find(" # ").or_else(|| text.find("\t# ")).or_else(|| text.strip_suffix(" #").map(str::len));
    comment.map_or(text, |at| text[..at].trim_end())
}

/// What stands before the first word that begins with `#`: a comment without a blank, or a part of the name.
pub(super) fn before_hash(text: &str) -> Option<&str> {
    let at = text.char_indices().find(|(at, c)| *c == '#' && text[..*at].ends_with(char::is_whitespace))?.0;
    Some(text[..at].trim_end()).filter(|name| !name.is_empty())
}

/// A number as OBJ writers print it: also what C libraries print for those that are none (`1.#IND`, `-nan(ind)`,
/// `1.#INF`), and a comma instead of the point.
pub(super) fn number(word: &str) -> Option<f64> {
    if let Ok(number) = word.parse() {
        return Some(number);
    }
    let (sign, digits) = word.strip_prefix('-').map_or((1.0, word.trim_start_matches('+')), |rest| (-1.0, rest));
    let lower = digits.to_ascii_lowercase();
    let printed = lower.split_once(".#").filter(|(head, _)| head.parse::<u32>().is_ok()).map(|(_, tail)| tail);
    match printed {
        Some(tail) if tail.starts_with("inf") => return Some(sign * f64::INFINITY),
        Some(_) => return Some(f64::NAN),
        None if lower.starts_with("nan") => return Some(f64::NAN),
        None => {}
    }
    let (whole, fraction) = word.split_once(',')?;
    format!("{whole}.{fraction}").parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encodings_are_told_by_their_marks_or_zeros() {
        let text = "v 1 2 3\nusemtl Größe\n";
        let le: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let be: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
        let latin: Vec<u8> = text.chars().map(|c| c as u8).collect();
        let utf8 = text.as_bytes().to_vec();
        let marked = |mark: &[u8], rest: &[u8]| [mark, rest].concat();
        for bytes in [
            utf8.clone(),
            marked(b"\xef\xbb\xbf", &utf8),
            marked(b"\xef\xbb\xbf", &latin),
            le.clone(),
            be.clone(),
            marked(b"\xff\xfe", &le),
            marked(b"\xfe\xff", &be),
            latin,
        ] {
            assert_eq!(decode(&bytes), text, "{bytes:?}");
        }
    }

    #[test]
    fn statements_know_their_lines() {
        let text = "a\r\nb\rc \\\n d\\\r\ne\n\n# no \\\nf";
        let found: Vec<(usize, String)> = statements(text).map(|(line, s)| (line, s.into_owned())).collect();
        let expected = [(1, "a"), (2, "b"), (3, "c   d e"), (6, ""), (7, "# no \\"), (8, "f")];
        assert_eq!(found, expected.map(|(line, s)| (line, s.to_owned())));
        assert_eq!(statements("a \\").count(), 1, "a backslash at the end of the file joins nothing");
    }

    #[test]
    fn comments_and_printed_numbers_are_told_apart() {
        assert_eq!(words("v 1 -1.#IND 3#x 4").collect::<Vec<_>>(), ["v", "1", "-1.#IND", "3"]);
        assert_eq!(words("f 1 # 2").collect::<Vec<_>>(), ["f", "1"]);
        assert_eq!((name("red # of the box"), name("wall #2"), name("a#b")), ("red", "wall #2", "a#b"));
        assert_eq!((before_hash("wall #2"), before_hash("a#b"), before_hash("#2")), (Some("wall"), None, None));
    }

    #[test]
    fn numbers_of_c_libraries_are_read() {
        for word in ["1.#IND", "-1.#IND00", "1.#QNAN0", "1.#J", "nan", "-nan(ind)", "NaN"] {
            assert!(number(word).is_some_and(f64::is_nan), "{word}");
        }
        assert_eq!(number("-1.#INF00"), Some(f64::NEG_INFINITY));
        assert_eq!(number("0,25"), Some(0.25));
        for word in ["x", "1,2,3", "1.5,2", "", "#", "3.1+e2", "a.#b"] {
            assert_eq!(number(word), None, "{word}");
        }
    }
}
