//! Radiance pictures (`.hdr`): shared-exponent pixels, plain or in either kind of run lengths.
//!
//! Format: G. Ward, "Real Pixels", Graphics Gems II, 1991, and the Radiance file format notes. A pixel is
//! `mantissa * 2^(e - 136)` per channel, black where e is 0: no half is added, as most tools read it.

use crate::error::Fault;
use crate::picture::{Picture, check_size};
use crate::primaries::{ColorSpace, Primaries, REC_709, XYZ};

/// Longest header that is looked at, in bytes.
const MAX_HEADER: usize = 1 << 16;

/// Widths that new run lengths can describe.
const RUN_WIDTHS: std::ops::RangeInclusive<usize> = 8..=0x7fff;

/// Reads a whole `.hdr` file; nothing is clipped.
pub(crate) fn read(bytes: &[u8]) -> Result<Picture, Fault> {
    let (header, start) = read_header(bytes)?;
    check_size(header.columns, header.rows, bytes.len())?;
    let mut lines = Lines { bytes, at: start };
    let (width, height) = header.size();
    let mut pixels = vec![[0.0f32; 3]; width * height];
    let mut line = vec![[0u8; 4]; header.columns];
    for row in 0..header.rows {
        lines.read(&mut line).map_err(|what| Fault::Invalid(format!("line {row} of {} {what}", header.rows)))?;
        for (column, rgbe) in line.iter().enumerate() {
            pixels[header.target(column, row)] = header.decode(*rgbe);
        }
    }
    Ok(Picture { width, height, pixels, space: header.space, envmap: None, warnings: header.warnings })
}

/// What stands before the pixels.
#[derive(Debug)]
struct Header {
    /// Pixels of a line as stored.
    columns: usize,
    /// Lines as stored.
    rows: usize,
    /// Whether stored lines are columns of the picture.
    transposed: bool,
    /// Whether x grows to the left, and y upwards.
    flipped: (bool, bool),
    /// Radiance of a stored value of 1.
    scale: [f64; 3],
    /// What the three numbers of a pixel are.
    space: ColorSpace,
    /// Notes for the user.
    warnings: Vec<String>,
}

impl Header {
    /// Width and height of the upright picture.
    fn size(&self) -> (usize, usize) {
        if self.transposed { (self.rows, self.columns) } else { (self.columns, self.rows) }
    }

    /// Index in the upright picture of a stored pixel.
    fn target(&self, column: usize, row: usize) -> usize {
        let (width, height) = self.size();
        let (x, y) = if self.transposed { (row, column) } else { (column, row) };
        let x = if self.flipped.0 { width - 1 - x } else { x };
        let y = if self.flipped.1 { height - 1 - y } else { y };
        y * width + x
    }

    /// Radiance of a stored pixel.
    fn decode(&self, [r, g, b, e]: [u8; 4]) -> [f32; 3] {
        if e == 0 {
            return [0.0; 3];
        }
        let unit = libm::ldexp(1.0, i32::from(e) - 136);
        let mantissa = [r, g, b];
        std::array::from_fn(|c| (f64::from(mantissa[c]) * unit * self.scale[c]) as f32)
    }
}

/// Reads the text lines and the size; gives the position of the first pixel byte.
fn read_header(bytes: &[u8]) -> Result<(Header, usize), Fault> {
    if !bytes.starts_with(b"#?") {
        let what = "no '#?RADIANCE' at the start: this is not a Radiance picture";
        return Err(Fault::Invalid(what.to_owned()));
    }
    let mut variables = Variables { scale: [1.0; 3], primaries: None, is_xyz: false, warnings: Vec::new() };
    let mut at = 0;
    loop {
        let line = next_line(bytes, &mut at)?;
        if line.is_empty() {
            break;
        }
        variables.read(&line)?;
    }
    let Variables { scale, primaries, is_xyz, mut warnings } = variables;
    if scale != [1.0; 3] {
        warnings.push(format!("the header's EXPOSURE and COLORCORR were undone: pixels times {scale:?}"));
    }
    let size = next_line(bytes, &mut at)?;
    let mut header = parse_size(&size)?;
    header.scale = scale;
    header.space.primaries = if is_xyz { XYZ } else { primaries.unwrap_or(REC_709) };
    header.warnings = warnings;
    Ok((header, at))
}

/// The next line of the header without its end.
fn next_line(bytes: &[u8], at: &mut usize) -> Result<String, Fault> {
    let rest = &bytes[(*at).min(bytes.len())..bytes.len().min(MAX_HEADER)];
    let Some(length) = rest.iter().position(|b| *b == b'\n') else {
        return Err(Fault::Invalid("the header does not end".to_owned()));
    };
    *at += length + 1;
    let line = String::from_utf8_lossy(&rest[..length]);
    Ok(line.trim_end_matches('\r').to_owned())
}

/// What the lines of the header say so far.
#[derive(Debug)]
struct Variables {
    scale: [f64; 3],
    primaries: Option<Primaries>,
    is_xyz: bool,
    warnings: Vec<String>,
}

impl Variables {
    /// Obeys `FORMAT`, `EXPOSURE`, `COLORCORR` and `PRIMARIES`; every other line is a remark.
    ///
    /// So are indented lines: programs that combine pictures copy the headers of their inputs, a tab before each line.
    fn read(&mut self, line: &str) -> Result<(), Fault> {
        let Some((name, value)) = line.split_once('=').filter(|_| !line.starts_with([' ', '\t'])) else {
            return Ok(());
        };
        let numbers = || -> Option<Vec<f64>> { value.split_whitespace().map(|word| word.parse().ok()).collect() };
        let positive = || match numbers() {
            Some(list) if !list.is_empty() && list.iter().all(|v| v.is_finite() && *v > 0.0) => Ok(list),
            _ => Err(Fault::Invalid(format!("header line {line:.60?} is not positive numbers"))),
        };
        match name.trim_end() {
            "FORMAT" => match value.trim() {
                "32-bit_rle_rgbe" => self.is_xyz = false,
                "32-bit_rle_xyze" => self.is_xyz = true,
                other => {
                    let what = format!("pixel format {other:.40?} is not read; convert to 32-bit_rle_rgbe");
                    return Err(Fault::Unsupported(what));
                }
            },
            "EXPOSURE" => {
                let exposure = positive()?[0];
                self.scale = self.scale.map(|s| s / exposure);
            }
            "COLORCORR" => match positive()?[..] {
                [r, g, b] => self.scale = [self.scale[0] / r, self.scale[1] / g, self.scale[2] / b],
                _ => return Err(Fault::Invalid("COLORCORR needs three numbers".to_owned())),
            },
            "PRIMARIES" => match numbers().and_then(|list| <[f64; 8]>::try_from(list).ok()) {
                Some(list) => self.primaries = Some(Primaries::from_numbers(list)),
                None => self.warnings.push(format!("header line {line:.100?} is not eight numbers: read as Rec. 709")),
            },
            _ => {}
        }
        Ok(())
    }
}

/// Reads `-Y rows +X columns` in any of its eight forms: the first axis is the slow one.
fn parse_size(line: &str) -> Result<Header, Fault> {
    let wrong = || Fault::Invalid(format!("size line '{line:.60}' is not like '-Y 512 +X 1024'"));
    let words: Vec<&str> = line.split_whitespace().collect();
    let [slow, rows, fast, columns] = words[..] else {
        return Err(wrong());
    };
    let parse = |text: &str| text.parse::<usize>().map_err(|_| wrong());
    let (rows, columns) = (parse(rows)?, parse(columns)?);
    let left = |axis: &str| axis == "-X";
    let up = |axis: &str| axis == "+Y";
    let is_x = |axis: &str| matches!(axis, "+X" | "-X");
    let is_y = |axis: &str| matches!(axis, "+Y" | "-Y");
    let transposed = is_x(slow) && is_y(fast);
    let upright = is_y(slow) && is_x(fast);
    if !(transposed || upright) {
        return Err(wrong());
    }
    Ok(Header {
        columns,
        rows,
        transposed,
        flipped: (left(slow) || left(fast), up(slow) || up(fast)),
        scale: [1.0; 3],
        space: ColorSpace::rec_709(),
        warnings: Vec::new(),
    })
}

/// Reads stored lines one after the other.
#[derive(Debug)]
struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
}

/// What a line says when the bytes run out.
const CUT: &str = "is cut off: the file ends too early";

impl Lines<'_> {
    /// The next `N` bytes.
    fn take<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let end = self.at + N;
        let bytes = self.bytes.get(self.at..end).ok_or(CUT)?;
        self.at = end;
        bytes.try_into().map_err(|_| CUT.to_owned())
    }

    /// Fills one line, whichever way it is stored.
    fn read(&mut self, line: &mut [[u8; 4]]) -> Result<(), String> {
        let first: [u8; 4] = self.take()?;
        let marked = first[0] == 2 && first[1] == 2 && first[2] < 128;
        if !marked || !RUN_WIDTHS.contains(&line.len()) {
            return self.read_old(first, line);
        }
        let width = usize::from(first[2]) << 8 | usize::from(first[3]);
        if width != line.len() {
            return Err(format!("claims {width} pixels, not {}", line.len()));
        }
        (0..4).try_for_each(|channel| self.read_runs(channel, line))
    }

    /// New run lengths: one channel of a line; a count above 128 repeats the byte after it.
    fn read_runs(&mut self, channel: usize, line: &mut [[u8; 4]]) -> Result<(), String> {
        let mut x = 0;
        while x < line.len() {
            let [count] = self.take()?;
            let (length, repeats) = match count {
                0 => return Err("has a run of no pixels".to_owned()),
                129.. => (usize::from(count - 128), true),
                _ => (usize::from(count), false),
            };
            let run = line.get_mut(x..x + length).ok_or("has a run past its end")?;
            let mut value = [0];
            for (k, pixel) in run.iter_mut().enumerate() {
                if k == 0 || !repeats {
                    value = self.take()?;
                }
                pixel[channel] = value[0];
            }
            x += length;
        }
        Ok(())
    }

    /// Plain pixels with old run lengths: `1 1 1 n` repeats the pixel before; runs in a row are the bytes
    /// of one count, lowest first.
    fn read_old(&mut self, first: [u8; 4], line: &mut [[u8; 4]]) -> Result<(), String> {
        let mut x = 0;
        let mut shift = 0;
        let mut next = Some(first);
        while x < line.len() {
            let pixel = match next.take() {
                Some(pixel) => pixel,
                None => self.take()?,
            };
            if pixel[..3] != [1, 1, 1] {
                line[x] = pixel;
                x += 1;
                shift = 0;
                continue;
            }
            if x == 0 {
                return Err("starts with a run: there is no pixel to repeat".to_owned());
            }
            let length = usize::from(pixel[3]).checked_shl(shift).unwrap_or(usize::MAX);
            let end = x.saturating_add(length);
            let value = line[x - 1];
            line.get_mut(x..end).ok_or("has a run past its end")?.fill(value);
            x = end;
            // A line is shorter than 2^32, so a longer count is refused as a run past the end.
            shift = (shift + 8).min(usize::BITS - 9);
        }
        Ok(())
    }
}

/// Encodes a picture as `.hdr` with new run lengths; values are rounded to the nearest mantissa.
///
/// Negative and NaN values become 0, values above the largest of the format (1.7e38) become it.
pub(crate) fn encode(width: usize, height: usize, pixels: &[[f32; 3]]) -> Vec<u8> {
    let mut out = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n").into_bytes();
    for line in pixels.chunks_exact(width) {
        let coded: Vec<[u8; 4]> = line.iter().map(|pixel| encode_pixel(*pixel)).collect();
        if !RUN_WIDTHS.contains(&width) {
            out.extend(coded.iter().flatten());
            continue;
        }
        out.extend([2, 2, (width >> 8) as u8, (width & 255) as u8]);
        for channel in 0..4 {
            let values: Vec<u8> = coded.iter().map(|pixel| pixel[channel]).collect();
            write_runs(&values, &mut out);
        }
    }
    out
}

/// One pixel with the exponent of its largest channel.
fn encode_pixel(pixel: [f32; 3]) -> [u8; 4] {
    let largest = pixel.iter().fold(0.0f32, |a, b| a.max(*b)).min(1.7e38);
    if largest < 1e-32 {
        return [0; 4];
    }
    let (_, mut exponent) = libm::frexp(f64::from(largest));
    let mantissa = |value: f32, exponent: i32| {
        let value = f64::from(value.max(0.0).min(largest));
        libm::floor(value * libm::ldexp(1.0, 8 - exponent) + 0.5)
    };
    // Rounding may lift the largest channel to 256.
    if mantissa(largest, exponent) > 255.0 && exponent < 127 {
        exponent += 1;
    }
    let byte = |value: f32| mantissa(value, exponent).min(255.0) as u8;
    [byte(pixel[0]), byte(pixel[1]), byte(pixel[2]), (exponent + 128) as u8]
}

/// Shortest run worth its two bytes.
const SHORTEST_RUN: usize = 4;

/// Writes one channel of a line as runs and literals.
fn write_runs(values: &[u8], out: &mut Vec<u8>) {
    let run_at = |at: usize| {
        let rest = &values[at..];
        rest.iter().take(127).take_while(|v| **v == rest[0]).count()
    };
    let mut at = 0;
    while at < values.len() {
        let run = run_at(at);
        if run >= SHORTEST_RUN {
            out.extend([128 + run as u8, values[at]]);
            at += run;
            continue;
        }
        let start = at;
        while at < values.len() && at - start < 128 && run_at(at) < SHORTEST_RUN {
            at += 1;
        }
        out.push((at - start) as u8);
        out.extend(&values[start..at]);
    }
}
