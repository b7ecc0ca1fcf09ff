//! A plot of points over two logarithmic axes, with a front and a chosen point.

use super::{Error, font, pixels::Pixels};
use plotters::chart::{ChartBuilder, ChartContext, SeriesLabelPosition};
use plotters::coord::Shift;
use plotters::coord::cartesian::Cartesian2d;
use plotters::coord::combinators::{IntoLogRange, LogCoord};
use plotters::element::{Circle, EmptyElement, PathElement, Polygon, Rectangle, Text};
use plotters::prelude::{
    BitMapBackend, DrawingArea, DrawingBackend, IntoDrawingArea, IntoFont, LineSeries, SVGBackend,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, RGBColor, ShapeStyle, TRANSPARENT, TextStyle};

/// Columns and rows of a plot.
const SIZE: (u32, u32) = (680, 440);
/// Colours that turn in the dark; nothing else is drawn in them.
const INK: RGBColor = RGBColor(0x1b, 0x24, 0x30);
const FAINT: RGBColor = RGBColor(0xdd, 0xe2, 0xe8);
const FRONT: RGBColor = RGBColor(0x5a, 0x67, 0x78);
/// The ring around the chosen point.
const CHOSEN: RGBColor = RGBColor(0xd1, 0x34, 0x5b);
/// Colours of the series: they stand apart on white and on black.
const COLOURS: [RGBColor; 6] = [
    RGBColor(0x2b, 0x7b, 0xd4),
    RGBColor(0xdb, 0x77, 0x18),
    RGBColor(0x25, 0x9b, 0x66),
    RGBColor(0x94, 0x62, 0xcf),
    RGBColor(0xc8, 0x4f, 0x8f),
    RGBColor(0x8c, 0x7a, 0x3c),
];
/// What the colours above become where the reader asks for dark pages.
const DARK: &str = "<style>@media (prefers-color-scheme: dark) {\
    [fill=\"#1B2430\"] { fill: #e4e9f0 } [stroke=\"#1B2430\"] { stroke: #e4e9f0 } \
    [stroke=\"#DDE2E8\"] { stroke: #2b3440 } [stroke=\"#5A6778\"] { stroke: #93a1b3 } }</style>";
/// Letters of labels, in pixels: size, and the mean width of one.
const LETTER: (i32, i32) = (15, 7);

/// What an axis counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// Seconds.
    Seconds,
    /// Bytes.
    Bytes,
    /// A share of one.
    Share,
}

/// Where the legend stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Corner {
    /// Where what is dear and far off would be.
    UpperRight,
    /// Under the front, where nothing is unless the cheapest is the closest too.
    LowerLeft,
}

/// Points of one kind.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// What the legend says.
    pub name: String,
    /// Price and error of each.
    pub points: Vec<[f64; 2]>,
}

/// A point with words beside it.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// Price and error.
    pub at: [f64; 2],
    /// The words.
    pub text: String,
}

/// A plot. Values of 0 stand at the end of their axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// Name and unit of the horizontal axis.
    pub x: (String, Unit),
    /// Name and unit of the vertical axis.
    pub y: (String, Unit),
    /// Up to six kinds of points.
    pub series: Vec<Series>,
    /// Points of the front by rising price.
    pub front: Vec<[f64; 2]>,
    /// Words beside points, the most important first; those without room are left out.
    pub labels: Vec<Label>,
    /// The point with a ring.
    pub chosen: Option<[f64; 2]>,
    /// Where the legend stands.
    pub legend: Corner,
}

type Plane = Cartesian2d<LogCoord<f64>, LogCoord<f64>>;

impl Chart {
    /// The plot as the text of an SVG file; it follows the reader's choice of light or dark.
    ///
    /// # Errors
    /// [`Error`] where the library cannot draw it.
    pub fn svg(&self) -> Result<String, Error> {
        let mut text = String::new();
        self.draw(&SVGBackend::with_string(&mut text, SIZE).into_drawing_area())?;
        let head = text.find("<svg").and_then(|start| Some(start + text[start..].find('>')? + 1));
        text.insert_str(head.unwrap_or(0), DARK);
        Ok(text)
    }

    /// The plot as pixels on white.
    ///
    /// # Errors
    /// [`Error`] where the library cannot draw it.
    pub fn pixels(&self) -> Result<Pixels, Error> {
        let mut buffer = vec![255; (SIZE.0 * SIZE.1 * 3) as usize];
        self.draw(&BitMapBackend::with_buffer(&mut buffer, SIZE).into_drawing_area())?;
        let rgba = buffer.chunks_exact(3).map(|c| [c[0], c[1], c[2], 255]).collect();
        Ok(Pixels { width: SIZE.0, height: SIZE.1, rgba })
    }

    fn draw<DB: DrawingBackend>(&self, root: &DrawingArea<DB, Shift>) -> Result<(), Error> {
        font::register()?;
        self.draw_parts(root).and_then(|()| root.present().map_err(|e| e.to_string())).map_err(fault)
    }

    fn draw_parts<DB: DrawingBackend>(&self, root: &DrawingArea<DB, Shift>) -> Result<(), String> {
        let [[left, right], [low, high]] = [self.range(0), self.range(1)];
        let mut chart = ChartBuilder::on(root)
            .margin(12)
            .margin_right(20)
            .x_label_area_size(46)
            .y_label_area_size(66)
            .build_cartesian_2d((left..right).log_scale(), (low..high).log_scale())
            .map_err(|e| e.to_string())?;
        self.draw_mesh(&mut chart)?;
        let front = self.front.iter().map(|&p| self.place(p));
        chart
            .draw_series(LineSeries::new(front, FRONT.stroke_width(2)))
            .map_err(|e| e.to_string())?
            .label("front: nothing beats these")
            .legend(|(x, y)| PathElement::new([(x - 7, y), (x + 7, y)], FRONT.stroke_width(2)));
        for (kind, series) in self.series.iter().enumerate() {
            self.draw_points(&mut chart, kind, series)?;
        }
        if let Some(at) = self.chosen {
            let ring = Circle::new(self.place(at), 11, CHOSEN.stroke_width(3));
            let drawn = chart.draw_series([ring]).map_err(|e| e.to_string())?;
            drawn.label("recommended").legend(|(x, y)| Circle::new((x, y), 6, CHOSEN.stroke_width(3)));
        }
        self.draw_words(&chart, root)?;
        chart
            .configure_series_labels()
            .position(match self.legend {
                Corner::UpperRight => SeriesLabelPosition::UpperRight,
                Corner::LowerLeft => SeriesLabelPosition::LowerLeft,
            })
            .background_style(TRANSPARENT)
            .border_style(TRANSPARENT)
            .label_font(words(HPos::Left))
            .draw()
            .map_err(|e| e.to_string())
    }

    fn draw_mesh<DB: DrawingBackend>(&self, chart: &mut ChartContext<'_, DB, Plane>) -> Result<(), String> {
        let ((x, x_unit), (y, y_unit)) = (&self.x, &self.y);
        chart
            .configure_mesh()
            .x_desc(x)
            .y_desc(y)
            .x_labels(8)
            .y_labels(8)
            .x_label_formatter(&|v| x_unit.write(*v))
            .y_label_formatter(&|v| y_unit.write(*v))
            .bold_line_style(FAINT.stroke_width(1))
            .light_line_style(TRANSPARENT)
            .axis_style(FAINT.stroke_width(1))
            .label_style(words(HPos::Center))
            .axis_desc_style(words(HPos::Center))
            .draw()
            .map_err(|e| e.to_string())
    }

    /// Draws the points of a kind; kinds differ in shape as well as in colour.
    fn draw_points<DB: DrawingBackend>(
        &self,
        chart: &mut ChartContext<'_, DB, Plane>,
        kind: usize,
        series: &Series,
    ) -> Result<(), String> {
        let style = COLOURS[kind % COLOURS.len()].filled();
        let points = series.points.iter().map(|&p| self.place(p));
        let drawn = match kind % 3 {
            0 => chart.draw_series(points.map(|p| Circle::new(p, 5, style))),
            1 => chart.draw_series(points.map(|p| EmptyElement::at(p) + square((0, 0), style))),
            _ => chart.draw_series(points.map(|p| EmptyElement::at(p) + diamond((0, 0), style))),
        };
        let drawn = drawn.map_err(|e| e.to_string())?.label(&series.name);
        match kind % 3 {
            0 => drawn.legend(move |at| Circle::new(at, 5, style)),
            1 => drawn.legend(move |at| square(at, style)),
            _ => drawn.legend(move |at| diamond(at, style)),
        };
        Ok(())
    }

    /// Writes the labels that have room beside their points.
    fn draw_words<DB: DrawingBackend>(
        &self,
        chart: &ChartContext<'_, DB, Plane>,
        root: &DrawingArea<DB, Shift>,
    ) -> Result<(), String> {
        let mut taken: Vec<[i32; 4]> = Vec::new();
        for label in &self.labels {
            let (x, y) = chart.backend_coord(&self.place(label.at));
            let width = LETTER.1 * label.text.chars().count() as i32;
            let places = [(x + 10, y - 12), (x + 10, y + 12), (x - 10 - width, y - 12), (x - 10 - width, y + 12)];
            let free = places.into_iter().find(|&(left, middle)| {
                let inside =
                    left > 70 && left + width < SIZE.0 as i32 - 10 && middle > 12 && middle < SIZE.1 as i32 - 56;
                let apart = |b: &[i32; 4]| {
                    left + width < b[0] || b[1] < left || middle + LETTER.0 / 2 < b[2] || b[3] < middle - LETTER.0 / 2
                };
                inside && taken.iter().all(apart)
            });
            if let Some((left, middle)) = free {
                taken.push([left, left + width, middle - LETTER.0 / 2, middle + LETTER.0 / 2]);
                let text = Text::new(label.text.clone(), (left, middle), words(HPos::Left));
                root.draw(&text).map_err(|e| e.to_string())?;
            }
        }
        Ok(())
    }

    /// The range of an axis: all values above 0, with room around them.
    fn range(&self, axis: usize) -> [f64; 2] {
        let all = self.series.iter().flat_map(|s| &s.points).chain(&self.front).map(|p| p[axis]);
        let sound = all.filter(|v| *v > 0.0 && v.is_finite());
        let (low, high) = sound.fold((f64::INFINITY, 0.0f64), |(low, high), v| (low.min(v), high.max(v)));
        // A legend below the front has room of its own.
        let below = if axis == 1 && self.legend == Corner::LowerLeft { 5.0 } else { 1.6 };
        if low > high { [1e-3, 1.0] } else { [low / below, high * 1.6] }
    }

    /// A point within the ranges; what is 0 stands at the end.
    fn place(&self, at: [f64; 2]) -> (f64, f64) {
        let within = |axis: usize| {
            let [low, high] = self.range(axis);
            at[axis].max(low).min(high)
        };
        (within(0), within(1))
    }
}

fn square((x, y): (i32, i32), style: ShapeStyle) -> Rectangle<(i32, i32)> {
    Rectangle::new([(x - 4, y - 4), (x + 5, y + 5)], style)
}

fn diamond((x, y): (i32, i32), style: ShapeStyle) -> Polygon<(i32, i32)> {
    Polygon::new([(x - 6, y), (x, y - 6), (x + 6, y), (x, y + 6)], style)
}

fn words(side: HPos) -> TextStyle<'static> {
    (font::FAMILY, LETTER.0).into_font().color(&INK).pos(Pos::new(side, VPos::Center))
}

fn fault(reason: String) -> Error {
    Error { what: "a plot", reason }
}

impl Unit {
    /// A value as people write it.
    #[must_use]
    pub fn write(self, value: f64) -> String {
        match self {
            Self::Seconds if value > 0.0 && value < 1.0 => format!("{} ms", digits(1e3 * value)),
            Self::Seconds => format!("{} s", digits(value)),
            Self::Share => format!("{} %", digits(100.0 * value)),
            Self::Bytes => {
                let units = ["B", "KiB", "MiB", "GiB", "TiB"];
                let power = if value >= 1.0 { ((value.log2() / 10.0) as usize).min(units.len() - 1) } else { 0 };
                format!("{} {}", digits(value / 1024f64.powi(power as i32)), units[power])
            }
        }
    }
}

/// A number with three digits that count, without zeros at its end.
fn digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let places = (2 - value.abs().log10().floor() as i32).max(0) as usize;
    let text = format!("{value:.places$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart() -> Chart {
        Chart {
            x: ("time of the bake".into(), Unit::Seconds),
            y: ("error".into(), Unit::Share),
            series: vec![
                Series { name: "rays".into(), points: vec![[0.1, 0.1], [1.0, 0.02], [9.0, 0.0]] },
                Series { name: "error <level>".into(), points: vec![[0.3, 0.05]] },
            ],
            front: vec![[0.1, 0.1], [1.0, 0.02], [9.0, 0.0]],
            labels: vec![Label { at: [1.0, 0.02], text: "--rays 256".into() }],
            chosen: Some([1.0, 0.02]),
            legend: Corner::UpperRight,
        }
    }

    #[test]
    fn a_plot_is_drawn_in_both_forms() {
        let svg = chart().svg().unwrap();
        for part in ["<svg", "</svg>", "prefers-color-scheme", "--rays 256", "&lt;level&gt;", "#D1345B"] {
            assert!(svg.contains(part), "{part} is missing: {svg}");
        }
        let pixels = chart().pixels().unwrap();
        let coloured =
            |colour: RGBColor| pixels.rgba.iter().filter(|p| p[..3] == [colour.0, colour.1, colour.2]).count();
        assert!(coloured(CHOSEN) > 50, "the ring must show: {}", coloured(CHOSEN));
        assert!(coloured(COLOURS[0]) > 100 && coloured(COLOURS[1]) > 50, "the points must show");
        assert!(coloured(INK) > 100, "text must show: {}", coloured(INK));
    }

    /// Without a chosen point there is no ring: the count above sees it.
    #[test]
    fn a_plot_is_drawn_in_both_forms_can_fail() {
        let without = Chart { chosen: None, ..chart() };
        assert!(!without.svg().unwrap().contains("#D1345B"));
    }

    #[test]
    fn a_plot_of_nothing_is_empty_but_a_plot() {
        let empty = Chart { series: vec![], front: vec![], labels: vec![], chosen: None, ..chart() };
        assert!(empty.svg().unwrap().contains("</svg>"));
    }

    #[test]
    fn numbers_are_written_for_people() {
        let cases = [
            (Unit::Seconds, 0.0123, "12.3 ms"),
            (Unit::Seconds, 75.04, "75 s"),
            (Unit::Share, 0.0105, "1.05 %"),
            (Unit::Share, 0.0, "0 %"),
            (Unit::Bytes, 1536.0, "1.5 KiB"),
            (Unit::Bytes, 0.0, "0 B"),
            (Unit::Bytes, 96.0 * 1048576.0, "96 MiB"),
        ];
        for (unit, value, text) in cases {
            assert_eq!(unit.write(value), text);
        }
    }
}
