//! The fourteen modes of BC6H: where in a block the bits of its ends of lines stand.

/// One mode. \[D3D11\] BC6H format; the same as BPTC of Vulkan.
#[derive(Debug)]
pub(crate) struct Mode {
    /// The lowest bits of a block of this mode.
    pub(crate) code: u8,
    /// How many they are.
    pub(crate) width: u32,
    /// Bits of the first end.
    pub(crate) bits: u32,
    /// Bits of the other ends per channel.
    pub(crate) delta: [u32; 3],
    /// Whether the other ends are differences to the first.
    pub(crate) transformed: bool,
    /// Whether there are two lines.
    pub(crate) two: bool,
    /// The bits behind the code, from low to high: channel (r, g, b), end (w, x, y, z) and bit, or the first and last of a run.
    pub(crate) layout: &'static str,
}

/// Every mode, in the order of the description.
pub(crate) const MODES: [Mode; 14] = [
    Mode {
        code: 0b00,
        width: 2,
        bits: 10,
        delta: [5, 5, 5],
        transformed: true,
        two: true,
        layout: "gy4 by4 bz4 rw0-9 gw0-9 bw0-9 rx0-4 gz4 gy0-3 gx0-4 bz0 gz0-3 bx0-4 bz1 by0-3 ry0-4 bz2 rz0-4 bz3",
    },
    Mode {
        code: 0b01,
        width: 2,
        bits: 7,
        delta: [6, 6, 6],
        transformed: true,
        two: true,
        layout: "gy5 gz4 gz5 rw0-6 bz0 bz1 by4 gw0-6 by5 bz2 gy4 bw0-6 bz3 bz5 bz4 rx0-5 gy0-3 gx0-5 gz0-3 bx0-5 \
            by0-3 ry0-5 rz0-5",
    },
    Mode {
        code: 0b00010,
        width: 5,
        bits: 11,
        delta: [5, 4, 4],
        transformed: true,
        two: true,
        layout: "rw0-9 gw0-9 bw0-9 rx0-4 rw10 gy0-3 gx0-3 gw10 bz0 gz0-3 bx0-3 bw10 bz1 by0-3 ry0-4 bz2 rz0-4 bz3",
    },
    Mode {
        code: 0b00110,
        width: 5,
        bits: 11,
        delta: [4, 5, 4],
        transformed: true,
        two: true,
        layout: "rw0-9 gw0-9 bw0-9 rx0-3 rw10 gz4 gy0-3 gx0-4 gw10 gz0-3 bx0-3 bw10 bz1 by0-3 ry0-3 bz0 bz2 rz0-3 gy4 \
            bz3",
    },
    Mode {
        code: 0b01010,
        width: 5,
        bits: 11,
        delta: [4, 4, 5],
        transformed: true,
        two: true,
        layout: "rw0-9 gw0-9 bw0-9 rx0-3 rw10 by4 gy0-3 gx0-3 gw10 bz0 gz0-3 bx0-4 bw10 by0-3 ry0-3 bz1 bz2 rz0-3 bz4 \
            bz3",
    },
    Mode {
        code: 0b01110,
        width: 5,
        bits: 9,
        delta: [5, 5, 5],
        transformed: true,
        two: true,
        layout: "rw0-8 by4 gw0-8 gy4 bw0-8 bz4 rx0-4 gz4 gy0-3 gx0-4 bz0 gz0-3 bx0-4 bz1 by0-3 ry0-4 bz2 rz0-4 bz3",
    },
    Mode {
        code: 0b10010,
        width: 5,
        bits: 8,
        delta: [6, 5, 5],
        transformed: true,
        two: true,
        layout: "rw0-7 gz4 by4 gw0-7 bz2 gy4 bw0-7 bz3 bz4 rx0-5 gy0-3 gx0-4 bz0 gz0-3 bx0-4 bz1 by0-3 ry0-5 rz0-5",
    },
    Mode {
        code: 0b10110,
        width: 5,
        bits: 8,
        delta: [5, 6, 5],
        transformed: true,
        two: true,
        layout: "rw0-7 bz0 by4 gw0-7 gy5 gy4 bw0-7 gz5 bz4 rx0-4 gz4 gy0-3 gx0-5 gz0-3 bx0-4 bz1 by0-3 ry0-4 bz2 \
            rz0-4 bz3",
    },
    Mode {
        code: 0b11010,
        width: 5,
        bits: 8,
        delta: [5, 5, 6],
        transformed: true,
        two: true,
        layout: "rw0-7 bz1 by4 gw0-7 by5 gy4 bw0-7 bz5 bz4 rx0-4 gz4 gy0-3 gx0-4 bz0 gz0-3 bx0-5 by0-3 ry0-4 bz2 \
            rz0-4 bz3",
    },
    Mode {
        code: 0b11110,
        width: 5,
        bits: 6,
        delta: [6, 6, 6],
        transformed: false,
        two: true,
        layout: "rw0-5 gz4 bz0 bz1 by4 gw0-5 gy5 by5 bz2 gy4 bw0-5 gz5 bz3 bz5 bz4 rx0-5 gy0-3 gx0-5 gz0-3 bx0-5 \
            by0-3 ry0-5 rz0-5",
    },
    Mode {
        code: 0b00011,
        width: 5,
        bits: 10,
        delta: [10, 10, 10],
        transformed: false,
        two: false,
        layout: "rw0-9 gw0-9 bw0-9 rx0-9 gx0-9 bx0-9",
    },
    Mode {
        code: 0b00111,
        width: 5,
        bits: 11,
        delta: [9, 9, 9],
        transformed: true,
        two: false,
        layout: "rw0-9 gw0-9 bw0-9 rx0-8 rw10 gx0-8 gw10 bx0-8 bw10",
    },
    Mode {
        code: 0b01011,
        width: 5,
        bits: 12,
        delta: [8, 8, 8],
        transformed: true,
        two: false,
        layout: "rw0-9 gw0-9 bw0-9 rx0-7 rw11 rw10 gx0-7 gw11 gw10 bx0-7 bw11 bw10",
    },
    Mode {
        code: 0b01111,
        width: 5,
        bits: 16,
        delta: [4, 4, 4],
        transformed: true,
        two: false,
        layout: "rw0-9 gw0-9 bw0-9 rx0-3 rw15 rw14 rw13 rw12 rw11 rw10 gx0-3 gw15 gw14 gw13 gw12 gw11 gw10 bx0-3 bw15 \
            bw14 bw13 bw12 bw11 bw10",
    },
];

/// A bit of an end: `[end][channel]` and its place there.
pub(crate) type Place = (u8, u8, u8);

/// The places of all bits behind the code.
pub(crate) const PLACES: [[Place; 75]; 14] = {
    let mut places = [[(0, 0, 0); 75]; 14];
    let mut mode = 0;
    while mode < 14 {
        places[mode] = parse(MODES[mode].layout.as_bytes());
        mode += 1;
    }
    places
};

/// Reads a layout when the program is compiled.
const fn parse(text: &[u8]) -> [Place; 75] {
    let mut places = [(0, 0, 0); 75];
    let (mut at, mut count) = (0, 0);
    while at < text.len() {
        let channel = match text[at] {
            b'r' => 0,
            b'g' => 1,
            _ => 2,
        };
        let end = text[at + 1] - b'w';
        let (first, after) = number(text, at + 2);
        let (last, after) =
            if after < text.len() && text[after] == b'-' { number(text, after + 1) } else { (first, after) };
        let mut bit = first;
        while bit <= last {
            places[count] = (end, channel, bit);
            (bit, count) = (bit + 1, count + 1);
        }
        at = after + 1;
    }
    places
}

const fn number(text: &[u8], mut at: usize) -> (u8, usize) {
    let mut value = 0;
    while at < text.len() && text[at].is_ascii_digit() {
        (value, at) = (value * 10 + (text[at] - b'0'), at + 1);
    }
    (value, at)
}
