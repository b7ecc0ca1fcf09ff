//! References inside a glTF file: data in place or the name of a file.

/// What a URI refers to.
#[derive(Debug)]
pub(crate) enum Uri {
    /// Bytes written into the URI itself.
    Data(Vec<u8>),
    /// A relative path with its percent escapes undone.
    Relative(String),
}

/// Reads a URI; says what is wrong with it.
pub(crate) fn parse(uri: &str) -> Result<Uri, String> {
    let Some(rest) = uri.strip_prefix("data:") else {
        let bytes = percent_decoded(uri)?;
        return String::from_utf8(bytes).map(Uri::Relative).map_err(|_| format!("uri {uri:?} is not UTF-8"));
    };
    let (kind, data) = rest.split_once(',').ok_or("data URI without a comma")?;
    if kind.ends_with(";base64") { from_base64(data).map(Uri::Data) } else { percent_decoded(data).map(Uri::Data) }
}

/// RFC 3986 section 2.1.
fn percent_decoded(text: &str) -> Result<Vec<u8>, String> {
    let mut decoded = Vec::with_capacity(text.len());
    let mut bytes = text.bytes();
    while let Some(byte) = bytes.next() {
        if byte == b'%' {
            let digits = [bytes.next(), bytes.next()].map(|d| d.and_then(|d| char::from(d).to_digit(16)));
            let [Some(high), Some(low)] = digits else { return Err("uri with a broken percent escape".into()) };
            decoded.push((high * 16 + low) as u8);
        } else {
            decoded.push(byte);
        }
    }
    Ok(decoded)
}

/// RFC 4648 section 4 (and the URL alphabet of section 5); padding may be missing.
fn from_base64(text: &str) -> Result<Vec<u8>, String> {
    let mut decoded = Vec::with_capacity(text.len() / 4 * 3 + 3);
    let (mut group, mut bits) = (0u32, 0);
    for (at, byte) in text.bytes().enumerate() {
        let value = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            b'=' if text[at..].bytes().all(|b| b == b'=') => break,
            _ => return Err(format!("data URI with a byte at {at} that is not base64")),
        };
        group = group << 6 | u32::from(value);
        bits += 6;
        if bits >= 8 {
            bits -= 8;
            decoded.push((group >> bits) as u8);
        }
    }
    Ok(decoded)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn data(uri: &str) -> Vec<u8> {
        match parse(uri) {
            Ok(Uri::Data(bytes)) => bytes,
            other => panic!("{uri}: {other:?}"),
        }
    }

    #[test]
    fn base64_agrees_with_the_vectors_of_rfc_4648() {
        for (plain, coded) in [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")] {
            assert_eq!(data(&format!("data:application/octet-stream;base64,{coded}")), plain.as_bytes());
        }
        assert!(parse("data:;base64,Zm9v!").is_err());
        assert!(parse("data:;base64").is_err());
    }

    #[test]
    fn percent_escapes_are_undone() {
        assert!(matches!(parse("a%20b.png"), Ok(Uri::Relative(name)) if name == "a b.png"));
        assert!(parse("a%2").is_err());
        assert!(parse("%ff").is_err());
        assert_eq!(data("data:,A%42"), b"AB");
    }
}
