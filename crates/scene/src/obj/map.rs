//! The statement of a texture in an MTL file: options, then the name of a file.

use glam::{Affine2, Mat2, Vec2};

use super::text::number;

/// A texture file and how it lies on the surface.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Map {
    /// As the statement names it.
    pub(super) file: String,
    /// `-s` and `-o`: the place in the picture is `uv * scale + offset`, v upwards.
    pub(super) scale: Vec2,
    pub(super) offset: Vec2,
    /// `-clamp on`: the border goes on outside.
    pub(super) clamp: bool,
    /// `-imfchan`: which channel a scalar is taken from; brightness where it is not said.
    pub(super) channel: Option<char>,
    /// `-bm`: the strength of a normal map.
    pub(super) strength: f32,
    /// Options that would change the picture and are not supported.
    pub(super) left_out: Vec<String>,
}

/// Options with their least and greatest numbers of arguments.
const OPTIONS: [(&str, usize, usize); 17] = [
    ("-s", 1, 3),
    ("-o", 1, 3),
    ("-t", 1, 3),
    ("-mm", 1, 2),
    ("-bm", 1, 1),
    ("-boost", 1, 1),
    ("-texres", 1, 1),
    ("-halo", 0, 0),
    ("-clamp", 1, 1),
    ("-blendu", 1, 1),
    ("-blendv", 1, 1),
    ("-cc", 1, 1),
    ("-imfchan", 1, 1),
    ("-colorspace", 1, 1),
    ("-type", 1, 1),
    ("-filter", 1, 1),
    ("-uv", 1, 1),
];

impl Map {
    /// Reads what follows the keyword; `None` where there is no file name. Names may hold blanks and stand in quotes.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let mut map = Self {
            file: String::new(),
            scale: Vec2::ONE,
            offset: Vec2::ZERO,
            clamp: false,
            channel: None,
            strength: 1.0,
            left_out: Vec::new(),
        };
        let rest = map.options(text.trim());
        // Some writers put options behind the name.
        let (name, behind) = match OPTIONS.iter().filter_map(|(option, ..)| place_of(rest, option)).min() {
            Some(at) => rest.split_at(at),
            None => (rest, ""),
        };
        map.options(behind.trim());
        let name = name.trim();
        let quoted = name.strip_prefix('"').and_then(|name| name.split_once('"')).map(|(name, _)| name);
        map.file = quoted.unwrap_or(name).trim().to_owned();
        (!map.file.is_empty()).then_some(map)
    }

    /// Obeys the options at the start of the text; gives what follows them.
    fn options<'a>(&mut self, text: &'a str) -> &'a str {
        let mut rest = text;
        while rest.starts_with('-') {
            let (option, mut after) = first_word(rest);
            let lower = option.to_ascii_lowercase();
            let known = OPTIONS.iter().find(|(name, ..)| *name == lower);
            // Unknown options are taken to have numbers and switches as arguments.
            let (least, most) = known.map_or((0, 3), |(_, least, most)| (*least, *most));
            let mut arguments = Vec::new();
            while arguments.len() < most && !after.is_empty() {
                let (word, next) = first_word(after);
                let is_argument = number(word).is_some() || matches!(word, "on" | "off");
                if !is_argument && arguments.len() >= least {
                    break;
                }
                arguments.push(word);
                after = next;
            }
            self.obey(&lower, &arguments);
            rest = after;
        }
        rest
    }

    fn obey(&mut self, option: &str, arguments: &[&str]) {
        let value = |i: usize, unsaid: f64| {
            let given = arguments.get(i).and_then(|word| number(word)).filter(|x| x.is_finite());
            given.unwrap_or(unsaid) as f32
        };
        let word = arguments.first().map(|word| word.to_ascii_lowercase()).unwrap_or_default();
        // What an option does not change is not missed.
        let missed = match option {
            "-s" => {
                self.scale = Vec2::new(value(0, 1.0), value(1, 1.0));
                false
            }
            "-o" => {
                self.offset = Vec2::new(value(0, 0.0), value(1, 0.0));
                false
            }
            "-clamp" => {
                self.clamp = word == "on";
                false
            }
            "-imfchan" => {
                self.channel = word.chars().next();
                self.channel == Some('z')
            }
            "-bm" => {
                self.strength = value(0, 1.0);
                false
            }
            "-t" => (0..3).any(|i| value(i, 0.0) != 0.0),
            "-mm" => value(0, 0.0) != 0.0 || value(1, 1.0) != 1.0,
            "-boost" => value(0, 0.0) != 0.0,
            "-blendu" | "-blendv" => word == "off",
            "-cc" => word == "on",
            "-colorspace" => !matches!(word.as_str(), "" | "srgb" | "auto" | "default"),
            "-texres" | "-halo" | "-type" | "-filter" => false,
            _ => true,
        };
        if missed {
            self.left_out.push(option.to_owned());
        }
    }

    /// From coordinates whose v runs downwards to those of the picture.
    pub(super) fn transform(&self) -> Affine2 {
        let (s, o) = (self.scale, self.offset);
        // 1 - ((1 - v) s + o) = v s + (1 - s - o).
        Affine2::from_mat2_translation(Mat2::from_diagonal(s), Vec2::new(o.x, 1.0 - s.y - o.y))
    }
}

/// The first word and what follows it.
fn first_word(text: &str) -> (&str, &str) {
    let (word, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    (word, rest.trim_start())
}

/// Where an option stands as a word of its own behind something else.
fn place_of(text: &str, option: &str) -> Option<usize> {
    let is_word = |at: usize| {
        let end = at + option.len();
        text[..at].ends_with(char::is_whitespace) && text[end..].starts_with(char::is_whitespace)
    };
    text.match_indices(option).map(|(at, _)| at).find(|at| is_word(*at))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(text: &str) -> Map {
        Map::parse(text).expect("a file name")
    }

    #[test]
    fn options_come_in_any_order_and_number() {
        let a = map("-o 0.5 -7.0 0.0 -s 2 10.0 1.0 -clamp on my  tex.png");
        let b = map("-clamp on -s 2 10 -blendu on -o 0.5 -7 -boost 0 -texres 512 -mm 0 1 -imfchan l my  tex.png");
        assert_eq!((a.scale, a.offset, a.clamp, a.file.as_str()), (b.scale, b.offset, true, "my  tex.png"));
        assert_eq!((a.scale, a.offset), (Vec2::new(2.0, 10.0), Vec2::new(0.5, -7.0)));
        assert!(a.left_out.is_empty() && b.left_out.is_empty());
        assert_eq!(map("-s 4 4.png").scale, Vec2::new(4.0, 1.0), "v and w may be missing");
        assert_eq!(map("tex.png -s 3 3 3").scale, Vec2::splat(3.0), "behind the name");
        assert_eq!(map("-bm 0.2 -colorspace sRGB -type sphere \"a b.png\" x").file, "a b.png");
    }

    #[test]
    fn what_is_left_out_is_told_and_what_changes_nothing_is_not() {
        let odd = map("-mm 0.1 2 -t 1 0 0 -cc on -blendv off -boost 3 -colorspace linear -wrap 2 x.png");
        assert_eq!(odd.left_out, ["-mm", "-t", "-cc", "-blendv", "-boost", "-colorspace", "-wrap"]);
        assert_eq!(odd.file, "x.png");
        assert!(map("-t 0 0 0 -mm 0 1 x-s.png").left_out.is_empty());
        assert!(Map::parse("-s 1 1 1").is_none() && Map::parse("").is_none());
    }

    #[test]
    fn the_transform_is_that_of_upward_rows() {
        let m = map("-s 3 5 -o 0.25 0.125 x.png");
        for (u, v) in [(0.0f32, 0.0f32), (0.3, 0.9), (1.0, 0.4)] {
            let upward = Vec2::new(3.0 * u + 0.25, 5.0 * v + 0.125);
            let found = m.transform().transform_point2(Vec2::new(u, 1.0 - v));
            assert!(found.distance(Vec2::new(upward.x, 1.0 - upward.y)) < 1e-5, "{found}");
        }
    }
}
