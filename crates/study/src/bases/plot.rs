//! The study as one picture: error against time and error against bytes, side by side.

use super::{Fit, Row, Study, label};
use crate::front::front as pareto;
use crate::plot::font;
use plotters::coord::Shift;
use plotters::prelude::*;
use sh_math::hemisphere::Basis;
use std::ops::Range;

/// Columns and rows in pixels.
const SIZE: (u32, u32) = (1200, 620);
/// Errors that the plots show.
const ERRORS: Range<f64> = 0.001..1.0;
/// Pixels of the letters of names and numbers.
const SMALL: i32 = 13;

/// What the marks mean.
const LEGEND: &str =
    "line: what no other basis beats in both; hollow: SH 4 cut from the sphere, SH 9 with signals of 5 bands";

/// A drawn picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// sRGB bytes, three per pixel, rows from the top.
    pub rgb: Vec<u8>,
}

/// The plotting library did not draw.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("cannot draw the plot: {0}; this is a fault of the program")]
pub struct PlotError(String);

impl Study {
    /// The plot as an SVG document; its texts are in the reader's own sans-serif font.
    ///
    /// # Errors
    /// When the plotting library fails.
    pub fn svg(&self) -> Result<String, PlotError> {
        let mut text = String::new();
        self.draw(&SVGBackend::with_string(&mut text, SIZE).into_drawing_area())?;
        Ok(text)
    }

    /// The same as pixels.
    ///
    /// # Errors
    /// When the plotting library fails.
    pub fn picture(&self) -> Result<Picture, PlotError> {
        let (width, height) = SIZE;
        let mut rgb = vec![0; 3 * (width * height) as usize];
        self.draw(&BitMapBackend::with_buffer(&mut rgb, SIZE).into_drawing_area())?;
        Ok(Picture { width, height, rgb })
    }

    fn draw<B: DrawingBackend>(&self, root: &DrawingArea<B, Shift>) -> Result<(), PlotError> {
        font::register().map_err(fault)?;
        root.fill(&WHITE).map_err(fault)?;
        let title = "Irradiance normal mapping: error of each basis against its cost";
        let below = root.titled(title, (font::FAMILY, 20)).map_err(fault)?;
        let below = below.titled(LEGEND, (font::FAMILY, SMALL)).map_err(fault)?;
        let (left, right) = below.split_horizontally(SIZE.0 / 2);
        let rows = self.shown();
        let slowest = rows.iter().map(|row| row.nanoseconds).fold(0.0, f64::max);
        let time = Panel { what: "ns per evaluation (3 channels, f32, one thread)", range: 0.0..1.15 * slowest };
        time.draw(root, &left, &rows, |row| row.nanoseconds)?;
        let bytes = Panel { what: "bytes per texel (3 channels, f16)", range: 0.0..62.0 };
        bytes.draw(root, &right, &rows, |row| row.texel(2) as f64)?;
        root.present().map_err(fault)
    }

    /// What is drawn: the rows, but spherical harmonics with 9 coefficients under signals that they do not hold whole.
    fn shown(&self) -> Vec<Row> {
        let [fitted, _] = self.eleventh_rows();
        self.rows.iter().map(|row| if row.entry == fitted.entry { fitted } else { *row }).collect()
    }
}

/// One half of the picture.
struct Panel {
    what: &'static str,
    range: Range<f64>,
}

impl Panel {
    fn draw<B: DrawingBackend>(
        &self,
        root: &DrawingArea<B, Shift>,
        area: &DrawingArea<B, Shift>,
        rows: &[Row],
        cost: impl Fn(&Row) -> f64,
    ) -> Result<(), PlotError> {
        let mut chart = ChartBuilder::on(area)
            .margin(12)
            .x_label_area_size(44)
            .y_label_area_size(64)
            .build_cartesian_2d(self.range.clone(), ERRORS.log_scale())
            .map_err(fault)?;
        chart
            .configure_mesh()
            .x_desc(self.what)
            .y_desc("IMSE over the hemisphere")
            .label_style((font::FAMILY, SMALL))
            .axis_desc_style((font::FAMILY, SMALL + 1))
            .light_line_style(RGBColor(238, 238, 238))
            .bold_line_style(RGBColor(216, 216, 216))
            .x_label_formatter(&|cost| format!("{cost}"))
            .y_label_formatter(&|error| format!("{error}"))
            .draw()
            .map_err(fault)?;
        let front = front(rows, &cost);
        let line = LineSeries::new(front.iter().copied(), RGBColor(150, 150, 150).stroke_width(2));
        chart.draw_series(line).map_err(fault)?;
        for row in rows {
            let (point, colour) = ((cost(row), row.imse.mean), colour(row.entry.basis));
            let style = if is_hollow(row) { colour.stroke_width(2) } else { colour.filled() };
            chart.draw_series([Circle::new(point, 5, style)]).map_err(fault)?;
        }
        let points: Vec<(i32, i32)> = rows.iter().map(|row| chart.backend_coord(&(cost(row), row.imse.mean))).collect();
        let line: Vec<(i32, i32)> = front.iter().map(|point| chart.backend_coord(point)).collect();
        let (x, y) = chart.plotting_area().get_pixel_range();
        name(root, rows, &points, &line, [x.start, y.start, x.end, y.end])
    }
}

/// What of the row was found in another way than the others: cut, or under other signals.
fn is_hollow(row: &Row) -> bool {
    row.entry.fit == Fit::Cut || row.entry.basis == Basis::Sh9
}

/// The points that no other beats in both cost and error, as steps.
fn front(rows: &[Row], cost: impl Fn(&Row) -> f64) -> Vec<(f64, f64)> {
    let points: Vec<[f64; 2]> = rows.iter().map(|row| [cost(row), row.imse.mean]).collect();
    let mut steps: Vec<(f64, f64)> = Vec::new();
    for [price, error] in pareto(&points).into_iter().map(|i| points[i]) {
        if let Some(&(_, last)) = steps.last() {
            steps.push((price, last));
        }
        steps.push((price, error));
    }
    steps
}

/// Writes the names beside the points; rows at one point share a label.
fn name<B: DrawingBackend>(
    root: &DrawingArea<B, Shift>,
    rows: &[Row],
    points: &[(i32, i32)],
    line: &[(i32, i32)],
    frame: label::Area,
) -> Result<(), PlotError> {
    let mut groups: Vec<((i32, i32), String, RGBColor)> = Vec::new();
    for (row, point) in rows.iter().zip(points) {
        match groups.iter_mut().find(|group| group.0 == *point) {
            Some(group) => group.1 += &format!(" = {}", row.entry.name()),
            None => groups.push((*point, row.entry.name(), colour(row.entry.basis))),
        }
    }
    let style = TextStyle::from((font::FAMILY, SMALL).into_font());
    let measure =
        |text: &str| root.estimate_text_size(text, &style).map(|(width, height)| (width as i32, height as i32));
    let sizes: Vec<(i32, i32)> = groups.iter().map(|g| measure(&g.1)).collect::<Result<_, _>>().map_err(fault)?;
    let places: Vec<(i32, i32)> = groups.iter().map(|g| g.0).collect();
    let corners = label::place(&places, &sizes, line, frame);
    for ((_, text, colour), corner) in groups.iter().zip(corners) {
        root.draw_text(text, &style.color(colour), corner).map_err(fault)?;
    }
    Ok(())
}

/// One colour per family, apart for the colour-blind as well (after Okabe and Ito, darkened for text).
fn colour(basis: Basis) -> RGBColor {
    match basis {
        Basis::Sh4 | Basis::Sh9 => RGBColor(0, 0, 0),
        Basis::Hl2 => RGBColor(140, 80, 110),
        Basis::Hsh4 | Basis::Hsh9 => RGBColor(0, 114, 178),
        Basis::Makhotkin4 | Basis::Makhotkin9 => RGBColor(176, 90, 0),
        Basis::Zernike3 | Basis::Zernike6 => RGBColor(0, 128, 95),
        Basis::H4 | Basis::H6 => RGBColor(190, 30, 30),
        Basis::ModifiedH1 | Basis::ModifiedH4 | Basis::ModifiedH6 => RGBColor(120, 50, 190),
    }
}

fn fault<E: std::fmt::Display>(error: E) -> PlotError {
    PlotError(error.to_string())
}
