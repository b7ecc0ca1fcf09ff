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

/// Characters of a line where there is no terminal.
const WITHOUT_TERMINAL: usize = 120;
/// Fewest characters of a line, however narrow a terminal is.
const LEAST: usize = 20;
/// Blanks before what follows the first cell of a row that does not fit beside it.
const INDENT: usize = 2;
/// Fewest characters of a column of words.
const NARROWEST: usize = 9;

/// Characters of a line: what `COLUMNS` says, else those of the terminal.
pub(crate) fn terminal_width() -> usize {
    let told = std::env::var("COLUMNS").ok().and_then(|text| text.trim().parse().ok()).filter(|width| *width > 0);
    let terminal = || terminal_size::terminal_size().map(|(width, _)| usize::from(width.0));
    told.or_else(terminal).unwrap_or(WITHOUT_TERMINAL).max(LEAST)
}

impl Columns {
    /// Width of a whole line.
    pub(crate) fn width(&self) -> usize {
        line(&self.fitted(terminal_width())).min(terminal_width())
    }

    /// Widths of the columns in a line of `most` characters: columns of words give way, those of numbers do not.
    fn fitted(&self, most: usize) -> Vec<usize> {
        let mut widths: Vec<usize> = self.0.iter().map(|(width, _)| *width).collect();
        while line(&widths) > most {
            let words = |index: &usize| self.0[*index].1 == Side::Left && widths[*index] > NARROWEST;
            let Some(widest) = (0..widths.len()).filter(words).max_by_key(|&index| widths[index]) else { break };
            widths[widest] -= 1;
        }
        widths
    }

    /// One row; it takes as many lines as its longest cell, without blanks at the ends of lines.
    pub(crate) fn row(&self, cells: &[&str]) -> String {
        self.row_in(cells, terminal_width())
    }

    /// The same in lines of `most` characters.
    fn row_in(&self, cells: &[&str], most: usize) -> String {
        let widths = self.fitted(most);
        if line(&widths) > most {
            return stacked(cells, most);
        }
        let wrapped: Vec<Vec<String>> = cells.iter().zip(&widths).map(|(cell, width)| wrap(cell, *width)).collect();
        let height = wrapped.iter().map(Vec::len).max().unwrap_or(0);
        let mut text = String::new();
        for line in 0..height {
            let mut out = String::new();
            for ((cell, &width), &(_, side)) in wrapped.iter().zip(&widths).zip(self.0) {
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

/// Width of a line of columns.
fn line(widths: &[usize]) -> usize {
    widths.iter().map(|width| width + GAP).sum::<usize>() - GAP
}

/// A row that does not fit: its first cell, and below it the others one after the other.
fn stacked(cells: &[&str], most: usize) -> String {
    let (first, others) = cells.split_first().map_or(("", [].as_slice()), |(first, others)| (*first, others));
    let others: Vec<&str> = others.iter().copied().filter(|cell| !cell.trim().is_empty()).collect();
    let head = wrap(first, most).into_iter().map(|line| line + "\n");
    let rest = wrap(&others.join("; "), most - INDENT).into_iter().filter(|line| !line.is_empty());
    head.chain(rest.map(|line| format!("{}{line}\n", " ".repeat(INDENT)))).collect()
}

/// A name and what is said of it: beside each other, with the lines of the text below each other.
pub(crate) fn entry(name: &str, column: usize, text: &str) -> String {
    let most = terminal_width();
    // Beside a long column too little is left.
    if name.chars().count() >= column || column + 2 * NARROWEST > most {
        return stacked(&[name, text], most);
    }
    let mut lines = wrap(text, most - column).into_iter();
    let first = format!("{name:<column$}{}", lines.next().unwrap_or_default());
    let rest = lines.map(|line| format!("{}{line}\n", " ".repeat(column)));
    format!("{}\n", first.trim_end()) + &rest.collect::<String>()
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

/// A share in per cent, two digits of it.
pub(crate) fn percent(share: f32) -> String {
    let percent = 100.0 * f64::from(share);
    let text = match percent.abs() {
        0.0 => return "0 %".into(),
        p if p < 0.01 => return "< 0.01 %".into(),
        p if p < 0.995 => format!("{percent:.2}"),
        p if p < 9.95 => format!("{percent:.1}"),
        _ => format!("{percent:.0}"),
    };
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    format!("{text} %")
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
    fn columns_of_words_give_way() {
        let columns = Columns(&[(20, Side::Left), (7, Side::Right), (30, Side::Left)]);
        assert_eq!(columns.fitted(100), [20, 7, 30]);
        assert_eq!(columns.fitted(51), [20, 7, 20]);
        assert_eq!(columns.fitted(10), [NARROWEST, 7, NARROWEST], "what cannot fit stands below");
        let row = columns.row_in(&["one two three", "1234567", "four five six seven"], 20);
        assert_eq!(row, "one two three\n  1234567; four five\n  six seven\n");
        assert!(columns.row_in(&["one", "2", "three"], 29).starts_with("one              2  three"));
    }

    #[test]
    fn numbers_are_short() {
        let shares = [0.0, 0.00001, 0.005, 0.01, 0.0149, 0.0997, 0.5, 2.861].map(percent);
        assert_eq!(shares, ["0 %", "< 0.01 %", "0.5 %", "1 %", "1.5 %", "10 %", "50 %", "286 %"]);
        assert_eq!([0, 999, 1234, 45_678_901].map(count), ["0", "999", "1.2 k", "46 M"]);
        assert_eq!([100, 1536, 3 << 30].map(bytes), ["100 B", "1.5 KiB", "3.0 GiB"]);
        assert_eq!(
            [0.0, 0.0001, 0.25, 3.0, 600.0, 7200.0].map(seconds),
            ["0", "< 1 ms", "250 ms", "3.0 s", "10 min", "2.0 h"]
        );
    }
}
