//! OpenEXR files written byte by byte, and probes loaded from bytes.

use exr::compression::Compression;
use exr::meta::BlockDescription;
use exr::meta::attribute::{ChannelDescription, ChannelList, IntegerBounds, SampleType};
use exr::meta::header::Header;
use exr::prelude::{Vec2, f16};
use probe_io::{Environment, Error, LoadOptions};
use std::sync::atomic::{AtomicU32, Ordering};

/// Loads bytes as a file.
pub(crate) fn load(name: &str, bytes: &[u8], options: &LoadOptions) -> Result<(Environment, Vec<String>), Error> {
    // Tests of a file run at the same time: each call has a file of its own.
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let path = std::env::temp_dir().join(format!("relume-probe-{}-{number}-{name}", std::process::id()));
    std::fs::write(&path, bytes).expect("a written file");
    let loaded = Environment::load(&path, options);
    std::fs::remove_file(&path).expect("a removed file");
    loaded
}

/// First pixel, columns and rows of a window.
pub(crate) type Window = [i32; 4];

/// A channel: name, whether halves, pixels per sample along x and y, and its value at an absolute pixel.
pub(crate) struct Channel<'a> {
    pub(crate) name: &'a str,
    pub(crate) is_half: bool,
    pub(crate) sampling: [i32; 2],
    pub(crate) value: &'a dyn Fn(i32, i32) -> f32,
}

/// A picture of lines; channels in the order of their names.
pub(crate) struct Lines<'a> {
    pub(crate) channels: Vec<Channel<'a>>,
    pub(crate) data: Window,
    pub(crate) display: Window,
    pub(crate) chromaticities: Option<[f32; 8]>,
    pub(crate) adopted: Option<[f32; 2]>,
    pub(crate) compression: Compression,
}

fn attribute(out: &mut Vec<u8>, name: &str, kind: &str, value: &[u8]) {
    for text in [name, kind] {
        out.extend(text.as_bytes());
        out.push(0);
    }
    out.extend((value.len() as i32).to_le_bytes());
    out.extend(value);
}

fn numbers(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

impl Lines<'_> {
    /// The file, by the layout that "OpenEXR File Layout" describes.
    pub(crate) fn bytes(&self) -> Vec<u8> {
        let (code, rows) = match self.compression {
            Compression::Uncompressed => (0, 1),
            Compression::RLE => (1, 1),
            Compression::ZIP16 => (3, 16),
            Compression::PIZ => (4, 32),
            other => panic!("{other} is not written here"),
        };
        let mut out = vec![0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0];
        let mut list = Vec::new();
        for channel in &self.channels {
            list.extend(channel.name.as_bytes());
            list.extend([0, if channel.is_half { 1 } else { 2 }, 0, 0, 0, 0, 0, 0, 0]);
            list.extend(channel.sampling.iter().flat_map(|s| s.to_le_bytes()));
        }
        list.push(0);
        let window = |[x, y, w, h]: Window| [x, y, x + w - 1, y + h - 1].iter().flat_map(|v| v.to_le_bytes()).collect();
        let (data, display): (Vec<u8>, Vec<u8>) = (window(self.data), window(self.display));
        attribute(&mut out, "channels", "chlist", &list);
        attribute(&mut out, "compression", "compression", &[code]);
        attribute(&mut out, "dataWindow", "box2i", &data);
        attribute(&mut out, "displayWindow", "box2i", &display);
        attribute(&mut out, "lineOrder", "lineOrder", &[0]);
        attribute(&mut out, "pixelAspectRatio", "float", &numbers(&[1.0]));
        attribute(&mut out, "screenWindowCenter", "v2f", &numbers(&[0.0; 2]));
        attribute(&mut out, "screenWindowWidth", "float", &numbers(&[1.0]));
        if let Some(chromaticities) = self.chromaticities {
            attribute(&mut out, "chromaticities", "chromaticities", &numbers(&chromaticities));
        }
        if let Some(adopted) = self.adopted {
            attribute(&mut out, "adoptedNeutral", "v2f", &numbers(&adopted));
        }
        out.push(0);
        let [_, first, _, height] = self.data;
        let starts: Vec<i32> = (0..height).step_by(rows).collect();
        let blocks: Vec<Vec<u8>> =
            starts.iter().map(|y| self.block(first + y, rows.min((height - y) as usize))).collect();
        let mut at = out.len() + 8 * blocks.len();
        for block in &blocks {
            out.extend((at as u64).to_le_bytes());
            at += 8 + block.len();
        }
        for (y, block) in starts.iter().zip(&blocks) {
            out.extend((first + y).to_le_bytes());
            out.extend((block.len() as i32).to_le_bytes());
            out.extend(block);
        }
        out
    }

    /// The samples of some lines, packed where that makes them shorter.
    fn block(&self, first: i32, rows: usize) -> Vec<u8> {
        let [left, _, width, _] = self.data;
        let mut plain = Vec::new();
        for y in first..first + rows as i32 {
            for channel in self.channels.iter().filter(|c| y.rem_euclid(c.sampling[1]) == 0) {
                for x in (left..left + width).filter(|x| x.rem_euclid(channel.sampling[0]) == 0) {
                    let value = (channel.value)(x, y);
                    match channel.is_half {
                        true => plain.extend(f16::from_f32(value).to_le_bytes()),
                        false => plain.extend(value.to_le_bytes()),
                    }
                }
            }
        }
        let packed = match self.compression {
            Compression::Uncompressed => return plain,
            // The crate's compressors are told the true sizes; deflate and run lengths only ask for their product.
            // What nobody writes: something that is not as long as the samples.
            Compression::PIZ if width % 2 == 1 => return [plain, vec![0]].concat(),
            Compression::PIZ => self.packed(&plain, width as usize, rows),
            _ => {
                let halves = ChannelDescription::new("Y", SampleType::F16, false);
                let length = plain.len() / 2;
                let mut header = Header::new("".into(), Vec2(length, 1), [halves].into_iter().collect());
                (header.compression, header.blocks) = (self.compression, BlockDescription::ScanLines);
                let section = IntegerBounds::new((0, 0), (length, 1));
                self.compression.compress_image_section_to_le(&header, plain.clone(), section).expect("packed")
            }
        };
        if packed.len() < plain.len() { packed } else { plain }
    }

    fn packed(&self, plain: &[u8], width: usize, rows: usize) -> Vec<u8> {
        let channels = self.channels.iter().map(|c| {
            let kind = if c.is_half { SampleType::F16 } else { SampleType::F32 };
            let [x, y] = c.sampling.map(|s| s as usize);
            ChannelDescription { sampling: Vec2(x, y), ..ChannelDescription::new(c.name, kind, false) }
        });
        let mut header = Header::new("".into(), Vec2(width, rows), channels.collect());
        (header.compression, header.blocks) = (self.compression, BlockDescription::ScanLines);
        header.channels = ChannelList { bytes_per_pixel: plain.len() / (width * rows), ..header.channels };
        let section = IntegerBounds::new((0, 0), (width, rows));
        self.compression.compress_image_section_to_le(&header, plain.to_vec(), section).expect("packed")
    }
}
