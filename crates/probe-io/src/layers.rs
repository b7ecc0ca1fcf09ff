//! The pictures in an OpenEXR file: parts, and layers of channels within them.

use crate::error::Fault;
use exr::meta::attribute::SampleType;
use exr::meta::header::Header;

/// What the channels of a layer are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Three colours.
    Rgb,
    /// Y, RY and BY.
    LuminanceChroma,
    /// X, Y and Z of CIE.
    Xyz,
    /// Luminance alone.
    Grey,
}

/// Channels of one part that are a picture.
#[derive(Debug, Clone)]
pub(crate) struct PictureLayer {
    /// Index of the header.
    pub(crate) part: usize,
    pub(crate) kind: Kind,
    /// Indices of the channels; the same three times where there is one.
    pub(crate) channels: [usize; 3],
    /// Name of the part, and what stands before the last point of the channels; either may be empty.
    part_name: String,
    prefix: String,
}

/// Names that programs give to the picture itself among many layers, as the last word of a layer's name.
const MAIN: [&str; 8] = ["rgba", "rgb", "beauty", "combined", "color", "colour", "image", "composite"];

/// Most names that a message lists.
const LISTED: usize = 64;

impl PictureLayer {
    /// The name by which a user chooses it.
    pub(crate) fn name(&self) -> String {
        let (part, prefix) = (&self.part_name, &self.prefix);
        if prefix.is_empty() || part.ends_with(prefix.as_str()) {
            return part.clone();
        }
        if part.is_empty() || prefix.starts_with(part.as_str()) { prefix.clone() } else { format!("{part}.{prefix}") }
    }

    /// Whether a user may mean it: by its name, its part or its prefix.
    fn is_called(&self, name: &str, same: impl Fn(&str, &str) -> bool) -> bool {
        let full = format!("{}.{}", self.part_name, self.prefix);
        [&self.name(), &self.prefix, &self.part_name, &full].iter().any(|own| !own.is_empty() && same(own, name))
    }

    /// Which layer is taken where none is named: colours before grey, the plain channels of the first part that has
    /// them before named layers, and of these one that is called as the picture itself.
    fn rank(&self) -> (bool, bool, bool) {
        let name = self.name().to_ascii_lowercase();
        let last = name.rsplit(['.', ' ', '/']).next().unwrap_or_default();
        (self.kind == Kind::Grey, !self.prefix.is_empty(), !MAIN.contains(&last))
    }
}

/// All layers of flat parts that are pictures.
fn layers(headers: &[Header]) -> Vec<PictureLayer> {
    let mut layers = Vec::new();
    for (part, header) in headers.iter().enumerate().filter(|(_, header)| !header.deep) {
        let part_name = header.own_attributes.layer_name.as_ref().map(ToString::to_string).unwrap_or_default();
        let mut groups: Vec<(String, Vec<(String, usize)>)> = Vec::new();
        for (index, channel) in header.channels.list.iter().enumerate() {
            let name = channel.name.to_string();
            let (prefix, component) = name.rsplit_once('.').unwrap_or(("", &name));
            let entry = (component.to_ascii_lowercase(), index);
            match groups.iter_mut().find(|(known, _)| known == prefix) {
                Some((_, channels)) => channels.push(entry),
                None => groups.push((prefix.to_owned(), vec![entry])),
            }
        }
        for (prefix, channels) in groups {
            if let Some((kind, channels)) = picture(&channels, prefix.is_empty()) {
                layers.push(PictureLayer { part, kind, channels, part_name: part_name.clone(), prefix });
            }
        }
    }
    layers
}

/// What a group of channels is, if it is a picture. Prefixed X, Y and Z are as a rule a place or a normal.
fn picture(channels: &[(String, usize)], is_plain: bool) -> Option<(Kind, [usize; 3])> {
    let find = |names: [&str; 2]| channels.iter().find(|(name, _)| names.contains(&name.as_str())).map(|(_, i)| *i);
    let three = |a: [&str; 2], b: [&str; 2], c: [&str; 2]| Some([find(a)?, find(b)?, find(c)?]);
    if let Some(rgb) = three(["r", "red"], ["g", "green"], ["b", "blue"]) {
        return Some((Kind::Rgb, rgb));
    }
    if let Some(chroma) = three(["y"; 2], ["ry"; 2], ["by"; 2]) {
        return Some((Kind::LuminanceChroma, chroma));
    }
    if let Some(xyz) = three(["x"; 2], ["y"; 2], ["z"; 2]) {
        return is_plain.then_some((Kind::Xyz, xyz));
    }
    let is_vector = find(["x"; 2]).is_some() || find(["z"; 2]).is_some() && !is_plain;
    find(["y"; 2]).filter(|_| !is_vector).map(|y| (Kind::Grey, [y; 3]))
}

/// The layer of this name, or the one that is most likely the picture; the string is a warning.
pub(crate) fn choose(headers: &[Header], name: Option<&str>) -> Result<(PictureLayer, Option<String>), Fault> {
    let layers = layers(headers);
    let names = listed(layers.iter().map(PictureLayer::name));
    let chosen = match name {
        Some(name) => {
            let exact = layers.iter().find(|layer| layer.is_called(name, |a, b| a == b));
            exact.or_else(|| layers.iter().find(|layer| layer.is_called(name, str::eq_ignore_ascii_case)))
        }
        // The first of equals.
        None => layers.iter().min_by_key(|layer| layer.rank()),
    };
    let chosen = match (chosen, name) {
        (Some(chosen), _) => chosen.clone(),
        (None, Some(name)) if !layers.is_empty() => {
            return Err(Fault::Invalid(format!("there is no layer {name:?} with colours; there are {names}")));
        }
        _ => {
            let channels = headers.iter().flat_map(|header| &header.channels.list);
            let found = listed(channels.map(|channel| channel.name.to_string()));
            let deep = if headers.iter().any(|header| header.deep) { " (deep parts are not read)" } else { "" };
            return Err(Fault::Unsupported(format!("no flat layer with channels R, G, B or Y; found: {found}{deep}")));
        }
    };
    check_types(&headers[chosen.part], &chosen)?;
    let told = (name.is_none() && layers.len() > 1).then(|| {
        let count = layers.len();
        format!("layer {:?} was read of {count}; another can be chosen by name: {names}", shown(&chosen.name()))
    });
    Ok((chosen, told))
}

fn check_types(header: &Header, layer: &PictureLayer) -> Result<(), Fault> {
    let mut channels = layer.channels.iter().map(|i| &header.channels.list[*i]);
    match channels.find(|channel| channel.sample_type == SampleType::U32) {
        Some(channel) => {
            Err(Fault::Unsupported(format!("channel {} holds integers; save as half or float", channel.name)))
        }
        None => Ok(()),
    }
}

fn shown(name: &str) -> &str {
    if name.is_empty() { "(unnamed)" } else { name }
}

/// The names with their control characters escaped, up to as many as a message may list.
fn listed(names: impl Iterator<Item = String>) -> String {
    let names: Vec<String> = names.map(|name| shown(&name).escape_debug().to_string()).collect();
    let more = names.len().saturating_sub(LISTED);
    let list = names[..names.len() - more].join(", ");
    if more > 0 { format!("{list} and {more} more") } else { list }
}
