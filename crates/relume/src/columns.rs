//! A table of texts for the console: columns of fixed width whose cells wrap at words.

/// Blank columns between two cells.
const GAP: usize = 2;

/// Which side of its column a cell keeps to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    Left,
    Right,
}

/// Widths and sides of the columns.
#[derive(Debug)]
pub(crate) struct Columns(pub(crate) &'static [(usize, Side)]);

impl Columns {
    /// Width of a whole line.
    pub(crate) fn width(&self) -> usize {
        self.0.iter().map(|(width, _)| width + GAP).sum::<usize>() - GAP
    }

    /// One row; it takes as many lines as its longest cell, without blanks at the ends of lines.
    pub(crate) fn row(&self, cells: &[&str]) -> String {
        let wrapped: Vec<Vec<String>> = cells.iter().zip(self.0).map(|(cell, (width, _))| wrap(cell, *width)).collect();
        let height = wrapped.iter().map(Vec::len).max().unwrap_or(0);
        let mut text = String::new();
        for line in 0..height {
            let mut out = String::new();
            for (cell, &(width, side)) in wrapped.iter().zip(self.0) {
                let part = cell.get(line).map_or("", String::as_str);
                match side {
                    Side::Left => out.push_str(&format!("{part:<width$}")),
                    Side::Right => out.push_str(&format!("{part:>width$}")),
                }
                out.push_str(&" ".repeat(GAP));
            }
            text.push_str(out.trim_end());
            text.push('\n');
        }
        text
    }
}

/// Breaks a text at blanks into lines of at most `width` characters; a longer word is cut.
pub(crate) fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let mut rest: Vec<char> = word.chars().collect();
        let last = lines.last_mut().map_or(0, |line| line.chars().count());
        if last > 0 && last + 1 + rest.len() > width {
            lines.push(String::new());
        } else if last > 0 {
            lines.last_mut().into_iter().for_each(|line| line.push(' '));
        }
        while rest.len() > width {
            let tail = rest.split_off(width);
            lines.last_mut().into_iter().for_each(|line| line.extend(&rest));
            lines.push(String::new());
            rest = tail;
        }
        lines.last_mut().into_iter().for_each(|line| line.extend(&rest));
    }
    lines
}

/// A count in a few characters, such as `12.3 M`.
pub(crate) fn count(n: u64) -> String {
    scaled(n as f64, 1000.0, &["", " k", " M", " G", " T"])
}

/// Bytes in a few characters, such as `1.5 MiB`.
pub(crate) fn bytes(n: u64) -> String {
    scaled(n as f64, 1024.0, &[" B", " KiB", " MiB", " GiB", " TiB"])
}

fn scaled(mut value: f64, step: f64, units: &[&str]) -> String {
    let mut unit = 0;
    while value >= step && unit + 1 < units.len() {
        value /= step;
        unit += 1;
    }
    match unit {
        0 => format!("{value:.0}{}", units[0]),
        _ if value < 9.95 => format!("{value:.1}{}", units[unit]),
        _ => format!("{value:.0}{}", units[unit]),
    }
}

/// A time in a few characters.
pub(crate) fn seconds(s: f64) -> String {
    match s {
        s if s <= 0.0 => "0".into(),
        s if s < 0.001 => "< 1 ms".into(),
        s if s < 1.0 => format!("{:.0} ms", 1000.0 * s),
        s if s < 100.0 => format!("{s:.1} s"),
        s if s < 6000.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_wrap_and_keep_their_side() {
        let columns = Columns(&[(6, Side::Left), (4, Side::Right)]);
        assert_eq!(columns.row(&["one two", "12"]), "one       12\ntwo\n");
        assert_eq!(columns.width(), 12);
        assert_eq!(wrap("abcdefgh ij", 4), ["abcd", "efgh", "ij"]);
        assert_eq!(wrap("", 4), [""]);
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!([0, 999, 1234, 45_678_901].map(count), ["0", "999", "1.2 k", "46 M"]);
        assert_eq!([100, 1536, 3 << 30].map(bytes), ["100 B", "1.5 KiB", "3.0 GiB"]);
        assert_eq!(
            [0.0, 0.0001, 0.25, 3.0, 600.0, 7200.0].map(seconds),
            ["0", "< 1 ms", "250 ms", "3.0 s", "10 min", "2.0 h"]
        );
    }
}
