//! A plot of points over two logarithmic axes, with a front and a chosen point.

pub use super::axis::Unit;
use super::axis::{digits, ticks};
use super::words::{LETTER, is_free, is_inside, places};
use super::{Error, font, pixels::Pixels};
use plotters::chart::{ChartBuilder, ChartContext};
use plotters::coord::Shift;
use plotters::coord::cartesian::Cartesian2d;
use plotters::coord::combinators::{IntoLogRange, LogCoord};
use plotters::element::{Circle, EmptyElement, PathElement, Polygon, Rectangle, Text};
use plotters::prelude::{
    BitMapBackend, DrawingArea, DrawingBackend, IntoDrawingArea, IntoFont, LineSeries, SVGBackend,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontTransform, RGBColor, ShapeStyle, TextStyle};

/// Columns and rows of a plot, its legend with it.
pub(super) const SIZE: (u32, u32) = (880, 440);
/// Columns of the legend, which stands beside the plot.
pub(super) const LEGEND: u32 = 212;
/// Rows between two lines of the legend.
const LEGEND_STEP: i32 = 24;
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
            .margin_right(20 + LEGEND)
            .x_label_area_size(46)
            .y_label_area_size(66)
            .build_cartesian_2d((left..right).log_scale(), (low..high).log_scale())
            .map_err(|e| e.to_string())?;
        self.draw_axes(&chart, root)?;
        let front = self.front.iter().map(|&p| self.place(p));
        chart.draw_series(LineSeries::new(front, FRONT.stroke_width(2))).map_err(|e| e.to_string())?;
        for (kind, series) in self.series.iter().enumerate() {
            self.draw_points(&mut chart, kind, series)?;
        }
        if let Some(at) = self.chosen {
            let ring = Circle::new(self.place(at), 11, CHOSEN.stroke_width(3));
            chart.draw_series([ring]).map_err(|e| e.to_string())?;
        }
        self.draw_words(&chart, root)?;
        self.draw_legend(root)
    }

    /// Lines and numbers at 1, 2 and 5 times the powers of ten, in one unit an axis, and the names of the axes.
    fn draw_axes<DB: DrawingBackend>(
        &self,
        chart: &ChartContext<'_, DB, Plane>,
        root: &DrawingArea<DB, Shift>,
    ) -> Result<(), String> {
        let ranges = [self.range(0), self.range(1)];
        let [[left, right], [low, high]] = ranges;
        let line = |ends: [(f64, f64); 2]| {
            let ends = ends.map(|end| chart.backend_coord(&end));
            root.draw(&PathElement::new(ends.to_vec(), FAINT.stroke_width(1))).map_err(|e| e.to_string())
        };
        for (axis, (name, unit)) in [&self.x, &self.y].into_iter().enumerate() {
            let (one, suffix) = unit.of_axis(ranges[axis]);
            for tick in ticks(ranges[axis].map(|end| end / one)) {
                let text = digits(tick);
                let (place, at, side) = if axis == 0 {
                    line([(tick * one, low), (tick * one, high)])?;
                    let (x, y) = chart.backend_coord(&(tick * one, low));
                    (text, (x, y + 16), HPos::Center)
                } else {
                    line([(left, tick * one), (right, tick * one)])?;
                    let (x, y) = chart.backend_coord(&(left, tick * one));
                    (text, (x - 8, y), HPos::Right)
                };
                root.draw(&Text::new(place, at, words(side))).map_err(|e| e.to_string())?;
            }
            let name = if suffix.is_empty() { name.clone() } else { format!("{name} ({suffix})") };
            let (middle, style) = if axis == 0 {
                let plot = (SIZE.0 - LEGEND) as i32;
                ((plot / 2 + 33, SIZE.1 as i32 - 14), words(HPos::Center))
            } else {
                ((14, SIZE.1 as i32 / 2 - 23), words(HPos::Center).transform(FontTransform::Rotate270))
            };
            root.draw(&Text::new(name, middle, style)).map_err(|e| e.to_string())?;
        }
        line([(left, low), (right, low)])?;
        line([(left, low), (left, high)])
    }

    /// What the marks mean, beside the plot.
    fn draw_legend<DB: DrawingBackend>(&self, root: &DrawingArea<DB, Shift>) -> Result<(), String> {
        let left = (SIZE.0 - LEGEND) as i32 + 14;
        let mut y = 24;
        let mut write = |text: &str| {
            let drawn = root.draw(&Text::new(text.to_owned(), (left + 18, y), words(HPos::Left)));
            y += LEGEND_STEP;
            drawn.map_err(|e| e.to_string())
        };
        let row = |index: usize| 24 + LEGEND_STEP * index as i32;
        if !self.front.is_empty() {
            let ends = vec![(left - 7, row(0)), (left + 7, row(0))];
            root.draw(&PathElement::new(ends, FRONT.stroke_width(2))).map_err(|e| e.to_string())?;
            write("front: nothing beats these")?;
        }
        let first = usize::from(!self.front.is_empty());
        for (kind, series) in self.series.iter().enumerate() {
            let (at, style) = ((left, row(first + kind)), COLOURS[kind % COLOURS.len()].filled());
            match kind % 3 {
                0 => root.draw(&Circle::new(at, 5, style)),
                1 => root.draw(&square(at, style)),
                _ => root.draw(&diamond(at, style)),
            }
            .map_err(|e| e.to_string())?;
            write(&series.name)?;
        }
        if self.chosen.is_some() {
            let at = (left, row(first + self.series.len()));
            root.draw(&Circle::new(at, 6, CHOSEN.stroke_width(3))).map_err(|e| e.to_string())?;
            write("recommended")?;
        }
        Ok(())
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
        drawn.map(drop).map_err(|e| e.to_string())
    }

    /// Writes the labels that have room beside their points.
    fn draw_words<DB: DrawingBackend>(
        &self,
        chart: &ChartContext<'_, DB, Plane>,
        root: &DrawingArea<DB, Shift>,
    ) -> Result<(), String> {
        let mut taken = self.marks(chart);
        for label in &self.labels {
            let at = chart.backend_coord(&self.place(label.at));
            let width = LETTER.1 * label.text.chars().count() as i32;
            if let Some(frame) =
                places(at, width).into_iter().find(|frame| is_inside(*frame) && is_free(*frame, &taken))
            {
                taken.push(frame);
                let [left, _, top, bottom] = frame;
                let text = Text::new(label.text.clone(), (left, (top + bottom) / 2), words(HPos::Left));
                root.draw(&text).map_err(|e| e.to_string())?;
            }
        }
        Ok(())
    }

    /// Frames around all points and along the front, on which no word may lie.
    fn marks<DB: DrawingBackend>(&self, chart: &ChartContext<'_, DB, Plane>) -> Vec<[i32; 4]> {
        let around = |(x, y): (i32, i32), size: i32| [x - size, x + size, y - size, y + size];
        let pixel = |p: &[f64; 2]| chart.backend_coord(&self.place(*p));
        let points = self.series.iter().flat_map(|series| &series.points).map(|p| around(pixel(p), 6));
        let ring = self.chosen.iter().map(|p| around(pixel(p), 13));
        let steps = self.front.windows(2).flat_map(|ends| {
            let [a, b] = [pixel(&ends[0]), pixel(&ends[1])];
            let count = ((b.0 - a.0).abs().max((b.1 - a.1).abs()) / 6).max(1);
            (0..=count).map(move |i| around((a.0 + (b.0 - a.0) * i / count, a.1 + (b.1 - a.1) * i / count), 2))
        });
        points.chain(ring).chain(steps).collect()
    }

    /// The range of an axis: all values above 0, with room around them.
    fn range(&self, axis: usize) -> [f64; 2] {
        let all = self.series.iter().flat_map(|s| &s.points).chain(&self.front).map(|p| p[axis]);
        let sound = all.filter(|v| *v > 0.0 && v.is_finite());
        let (low, high) = sound.fold((f64::INFINITY, 0.0f64), |(low, high), v| (low.min(v), high.max(v)));
        if low > high { [1e-3, 1.0] } else { [low / 1.6, high * 1.6] }
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
    fn axes_are_named_with_their_unit() {
        let svg = chart().svg().unwrap();
        assert!(svg.contains("time of the bake (s)") && svg.contains("error (%)"), "{svg}");
    }
}
