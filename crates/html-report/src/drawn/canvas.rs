//! A figure drawn through plotters, as SVG or in pixels.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::FontStyle;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::axis::Axis;
use super::sheet::{BOTTOM, INK, Key, Line, Mark, Panel, SOFT, Sheet, TITLE, TOP};
use crate::ReportError;

/// Pixels of a unit, in each direction, that a PNG is drawn with and that it has in the end: the library draws wide lines and
/// areas without shades at their edges, which come from the mean of the finer ones.
const FINE: usize = 4;
const COARSE: usize = 2;
/// Pixels of a PNG per metre: a unit is that of CSS, 96 to the inch.
const PER_METRE: u32 = (96.0 * COARSE as f64 / 0.0254) as u32;

const GRID: RGBColor = RGBColor(225, 225, 225);
/// Height of a line of names.
const LINE: u32 = 20;

pub(super) fn svg(sheet: &Sheet) -> Result<Vec<u8>, ReportError> {
    let mut text = String::new();
    let root = SVGBackend::with_string(&mut text, size(sheet)).into_drawing_area();
    Canvas { root, scale: 1 }.draw(sheet)?;
    Ok(text.into_bytes())
}

pub(super) fn png(sheet: &Sheet) -> Result<Vec<u8>, ReportError> {
    let (width, height) = size(sheet);
    let (across, down) = (FINE * width as usize, FINE * height as usize);
    let mut fine = vec![u8::MAX; 3 * across * down];
    {
        let backend = BitMapBackend::with_buffer(&mut fine, (across as u32, down as u32));
        let root = backend.into_drawing_area();
        let scale = FINE as u32;
        Canvas { root, scale }.draw(sheet)?;
    }
    let step = FINE / COARSE;
    let mut coarse = Vec::with_capacity(3 * (across / step) * (down / step));
    for y in (0..down).step_by(step) {
        for x in (0..across).step_by(step) {
            for channel in 0..3 {
                let pixels = (0..step * step).map(|k| 3 * ((y + k / step) * across + x + k % step) + channel);
                let sum: usize = pixels.filter_map(|at| fine.get(at)).map(|v| usize::from(*v)).sum();
                coarse.push((sum / (step * step)) as u8);
            }
        }
    }
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, (across / step) as u32, (down / step) as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_pixel_dims(Some(png::PixelDimensions {
        xppu: PER_METRE,
        yppu: PER_METRE,
        unit: png::Unit::Meter,
    }));
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(&coarse).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

fn failed<E: std::error::Error>(error: E) -> ReportError {
    ReportError::Drawing(error.to_string())
}

/// About the width of a text.
fn width(text: &str) -> u32 {
    7 * text.chars().count() as u32
}

/// Where the names of a sheet stand, and the height of all.
fn names(sheet: &Sheet) -> (Vec<(u32, u32)>, u32) {
    let full = sheet.panel.0 * sheet.across as u32;
    let left = sheet.panels.first().map_or(0, |p| p.sides.0);
    let (mut x, mut y) = (left, 0);
    if !sheet.name.is_empty() {
        x += width(&sheet.name) + 24;
    }
    let mut places = Vec::new();
    for key in &sheet.keys {
        let length = 44 + width(&key.name);
        if x + length > full && x > left {
            (x, y) = (left, y + LINE);
        }
        places.push((x, y));
        x += length;
    }
    let any = !sheet.keys.is_empty() || !sheet.name.is_empty();
    (places, if any { y + LINE + 6 } else { 0 })
}

fn size(sheet: &Sheet) -> (u32, u32) {
    let rows = sheet.panels.len().div_ceil(sheet.across) as u32;
    (
        sheet.panel.0 * sheet.across as u32,
        names(sheet).1 + rows * sheet.panel.1,
    )
}

/// The stretches of a curve that lie in a range, each cut where it leaves it.
fn clipped(points: &[(f64, f64)], y: &Range<f64>) -> Vec<Vec<(f64, f64)>> {
    let (low, high) = (y.start.min(y.end), y.start.max(y.end));
    let mut found: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut open = false;
    for pair in points.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let at = |level: f64| (level - a.1) / (b.1 - a.1);
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for (level, outside) in [(low, f64::lt as fn(&f64, &f64) -> bool), (high, f64::gt)] {
            match (outside(&a.1, &level), outside(&b.1, &level)) {
                (true, true) => to = -1.0,
                (true, false) => from = from.max(at(level)),
                (false, true) => to = to.min(at(level)),
                (false, false) => {}
            }
        }
        let place = |s: f64| (a.0 + s * (b.0 - a.0), a.1 + s * (b.1 - a.1));
        if from > to {
            open = false;
            continue;
        }
        match found.last_mut().filter(|_| open && from <= 0.0) {
            Some(last) => last.push(place(to)),
            None => found.push(vec![place(from), place(to)]),
        }
        open = to >= 1.0;
    }
    found
}

/// How a text is written.
#[derive(Clone, Copy)]
struct Script {
    horizontal: HPos,
    bold: bool,
    /// From below to above.
    upward: bool,
    colour: RGBColor,
}

impl Default for Script {
    fn default() -> Self {
        Self {
            horizontal: HPos::Left,
            bold: false,
            upward: false,
            colour: INK,
        }
    }
}

impl From<HPos> for Script {
    fn from(horizontal: HPos) -> Self {
        Self {
            horizontal,
            ..Self::default()
        }
    }
}

/// A text in pieces, each raised or not; raised letters as those that they are raised from.
fn pieces(text: &str) -> Vec<(String, bool)> {
    let letters = "⁰¹²³⁴⁵⁶⁷⁸⁹⁻".chars().zip("0123456789−".chars());
    let letters: Vec<(char, char)> = letters.collect();
    let mut found: Vec<(String, bool)> = Vec::new();
    for c in text.chars() {
        let (letter, raised) = match letters.iter().find(|(raised, _)| *raised == c) {
            Some((_, plain)) => (*plain, true),
            // Between raised digits it is their decimal point.
            None if c == '·' && found.last().is_some_and(|(_, raised)| *raised) => ('.', true),
            None => (c, false),
        };
        match found.last_mut().filter(|last| last.1 == raised) {
            Some(last) => last.0.push(letter),
            None => found.push((letter.to_string(), raised)),
        }
    }
    found
}

struct Canvas<B: DrawingBackend> {
    root: DrawingArea<B, Shift>,
    /// Pixels of a unit of length.
    scale: u32,
}

impl<B: DrawingBackend> Canvas<B>
where
    B::ErrorType: 'static,
{
    fn draw(&self, sheet: &Sheet) -> Result<(), ReportError> {
        self.root.fill(&WHITE).map_err(failed)?;
        let (places, height) = names(sheet);
        let (strip, rest) = self.root.split_vertically(self.units(height));
        let left = sheet.panels.first().map_or(0, |p| p.sides.0);
        if !sheet.name.is_empty() {
            self.text(&strip, &sheet.name, (left, LINE / 2 + 3), HPos::Left, true)?;
        }
        for (key, (x, y)) in sheet.keys.iter().zip(places) {
            self.key(&strip, key, (x, y + LINE / 2 + 3))?;
        }
        let rows = sheet.panels.len().div_ceil(sheet.across);
        for (area, panel) in rest.split_evenly((rows.max(1), sheet.across)).iter().zip(&sheet.panels) {
            self.panel(area, panel)?;
        }
        self.root.present().map_err(failed)
    }

    /// So many units in pixels.
    fn units(&self, length: u32) -> i32 {
        (length * self.scale) as i32
    }

    fn pixels(&self, length: f64) -> u32 {
        (length * f64::from(self.scale)).round().max(1.0) as u32
    }

    /// A text at a place in units, in the middle of its height.
    fn text(
        &self,
        area: &DrawingArea<B, Shift>,
        text: &str,
        (x, y): (u32, u32),
        horizontal: HPos,
        bold: bool,
    ) -> Result<(), ReportError> {
        let script = Script {
            horizontal,
            bold,
            ..Script::default()
        };
        self.write(area, text, (self.units(x), self.units(y)), &script)
    }

    /// A text at a place in pixels. In pixels what is raised is drawn as smaller letters, since fonts lack some of those.
    fn write(
        &self,
        area: &DrawingArea<B, Shift>,
        text: &str,
        at: (i32, i32),
        script: &Script,
    ) -> Result<(), ReportError> {
        let style = |raised: bool| {
            let weight = if script.bold {
                FontStyle::Bold
            } else {
                FontStyle::Normal
            };
            let size = f64::from(12 * self.scale) * if raised { 0.72 } else { 1.0 };
            TextStyle::from(FontDesc::new(FontFamily::SansSerif, size, weight)).color(&script.colour)
        };
        let turned = |raised: bool, horizontal| {
            let turn = if script.upward {
                FontTransform::Rotate270
            } else {
                FontTransform::None
            };
            style(raised).transform(turn).pos(Pos::new(horizontal, VPos::Center))
        };
        let pieces = if self.scale > 1 {
            pieces(text)
        } else {
            vec![(text.to_owned(), false)]
        };
        // In pixels the middle is that of the font's line, below that of its letters.
        let sink = if self.scale > 1 { self.units(1) } else { 0 };
        let at = if script.upward {
            (at.0 + sink, at.1)
        } else {
            (at.0, at.1 + sink)
        };
        if let [(text, false)] = &pieces[..] {
            let style = turned(false, script.horizontal);
            return area.draw(&Text::new(text.as_str(), at, style)).map_err(failed);
        }
        let length = |(text, raised): &(String, bool)| {
            let size = area.estimate_text_size(text, &style(*raised));
            size.map(|(width, _)| width as i32)
        };
        let lengths: Vec<i32> = pieces.iter().map(length).collect::<Result<_, _>>().map_err(failed)?;
        let all: i32 = lengths.iter().sum();
        let mut along = match script.horizontal {
            HPos::Left => 0,
            HPos::Center => -all / 2,
            HPos::Right => -all,
        };
        for ((text, raised), length) in pieces.iter().zip(lengths) {
            let up = if *raised { 4 * self.units(1) } else { 0 };
            let place = if script.upward {
                (at.0 - up, at.1 - along)
            } else {
                (at.0 + along, at.1 - up)
            };
            let style = turned(*raised, HPos::Left);
            area.draw(&Text::new(text.as_str(), place, style)).map_err(failed)?;
            along += length;
        }
        Ok(())
    }

    fn key(&self, strip: &DrawingArea<B, Shift>, key: &Key, (x, y): (u32, u32)) -> Result<(), ReportError> {
        let at = |dx: u32, dy: i32| (self.units(x + dx), self.units(y) + dy * self.units(1));
        match key.mark {
            Mark::Line(dash) => {
                let dash = dash.unwrap_or((22, 0));
                let style = key.colour.stroke_width(self.pixels(2.0));
                let mut from = 0;
                while from < 22 {
                    let ends = [at(from, 0), at((from + dash.0).min(22), 0)];
                    strip.draw(&PathElement::new(ends, style)).map_err(failed)?;
                    from += dash.0 + dash.1;
                }
            }
            Mark::Area => strip
                .draw(&Rectangle::new([at(0, -6), at(22, 6)], key.colour.filled()))
                .map_err(failed)?,
            Mark::Dot => strip
                .draw(&Circle::new(at(14, 0), self.pixels(3.5), key.colour.filled()))
                .map_err(failed)?,
            Mark::Ring => strip
                .draw(&Circle::new(
                    at(14, 0),
                    self.pixels(3.5),
                    key.colour.stroke_width(self.pixels(1.5)),
                ))
                .map_err(failed)?,
        }
        self.text(strip, &key.name, (x + 28, y), HPos::Left, false)
    }

    fn panel(&self, area: &DrawingArea<B, Shift>, panel: &Panel) -> Result<(), ReportError> {
        let title = if panel.title.is_empty() { 0 } else { TITLE };
        if title > 0 {
            self.text(area, &panel.title, (panel.sides.0, TOP + 4), HPos::Left, true)?;
        }
        let mut builder = ChartBuilder::on(area);
        builder
            .margin_top(self.units(TOP + title))
            .margin_right(self.units(panel.sides.1))
            .set_label_area_size(LabelAreaPosition::Left, self.units(panel.sides.0));
        if panel.table {
            builder.set_label_area_size(LabelAreaPosition::Top, self.units(LINE));
        } else {
            builder.set_label_area_size(LabelAreaPosition::Bottom, self.units(BOTTOM));
        }
        let mut chart = builder
            .build_cartesian_2d(panel.x.clone(), panel.y.clone())
            .map_err(failed)?;
        let line = if panel.table { TRANSPARENT } else { INK.to_rgba() };
        let mut mesh = chart.configure_mesh();
        mesh.light_line_style(TRANSPARENT)
            .bold_line_style(GRID.stroke_width(self.scale))
            .axis_style(line.stroke_width(self.scale))
            .set_all_tick_mark_size(self.units(if panel.table { 0 } else { 4 }))
            .x_label_formatter(&|_| String::new())
            .y_label_formatter(&|_| String::new());
        if panel.table {
            mesh.disable_mesh();
        } else if panel.y.label.is_empty() {
            mesh.disable_y_mesh();
        }
        mesh.draw().map_err(failed)?;
        let right = Script::from(HPos::Right);
        for (at, text) in &panel.y.places {
            let (x, y) = chart.backend_coord(&(panel.x.range.start, *at));
            self.write(&self.root, text, (x - self.units(8), y), &right)?;
        }
        let center = Script::from(HPos::Center);
        for (at, text) in &panel.x.places {
            let (x, y) = match panel.table {
                true => chart.backend_coord(&(*at, panel.y.range.end)),
                false => chart.backend_coord(&(*at, panel.y.range.start)),
            };
            let below = if panel.table { -self.units(10) } else { self.units(14) };
            self.write(&self.root, text, (x, y + below), &center)?;
        }
        let middle = |range: &Range<f64>| 0.5 * (range.start + range.end);
        let (x, y) = chart.backend_coord(&(middle(&panel.x.range), middle(&panel.y.range)));
        let (across, down) = (area.get_pixel_range().0, area.get_pixel_range().1);
        self.write(&self.root, &panel.x.label, (x, down.end - self.units(12)), &center)?;
        let upward = Script { upward: true, ..center };
        self.write(&self.root, &panel.y.label, (across.start + self.units(12), y), &upward)?;
        let areas = panel.areas.iter();
        let areas = areas.map(|a| Rectangle::new([(a.x.start, a.y.start), (a.x.end, a.y.end)], a.colour.filled()));
        chart.draw_series(areas).map_err(failed)?;
        for line in &panel.lines {
            for stretch in clipped(&line.points, &panel.y.range) {
                self.stretch(&mut chart, line, stretch)?;
            }
        }
        for dot in &panel.dots {
            let radius = self.pixels(dot.radius);
            if dot.ring {
                let white = Circle::new(dot.at, radius, WHITE.filled());
                let ring = Circle::new(dot.at, radius, dot.colour.stroke_width(self.pixels(1.5)));
                chart.draw_series([white, ring]).map_err(failed)?;
            } else {
                let dot = Circle::new(dot.at, radius, dot.colour.filled());
                chart.draw_series([dot]).map_err(failed)?;
            }
        }
        for label in &panel.texts {
            let (x, y) = chart.backend_coord(&label.at);
            let script = Script {
                horizontal: if label.beside { HPos::Left } else { HPos::Center },
                colour: if label.beside { SOFT } else { INK },
                bold: label.bold,
                upward: false,
            };
            let dx = if label.beside { self.units(12) } else { 0 };
            self.write(&self.root, &label.text, (x + dx, y), &script)?;
        }
        Ok(())
    }

    fn stretch<'a>(
        &self,
        chart: &mut ChartContext<'a, B, Cartesian2d<Axis, Axis>>,
        line: &Line,
        points: Vec<(f64, f64)>,
    ) -> Result<(), ReportError> {
        let width = self.pixels(line.width);
        let style = line.colour.stroke_width(width);
        let drawn = match line.dash {
            Some((dash, gap)) => {
                let series = DashedLineSeries::new(points, self.units(dash), self.units(gap), style);
                chart.draw_series(series).map(drop)
            }
            // In pixels the library's mitres of wide lines stick out beyond their points: piece by piece there are none.
            None if self.scale > 1 => {
                let pieces = points.windows(2).map(|ends| PathElement::new(ends.to_vec(), style));
                chart.draw_series(pieces).map(drop)
            }
            None => chart.draw_series(LineSeries::new(points, style)).map(drop),
        };
        drawn.map_err(failed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn raised_letters_stand_apart() {
        let piece = |text: &str, raised| (text.to_owned(), raised);
        assert_eq!(
            pieces("q [10⁻⁶ m/s²·⁵]"),
            [
                piece("q [10", false),
                piece("−6", true),
                piece(" m/s", false),
                piece("2.5", true),
                piece("]", false)
            ]
        );
        assert!(pieces("").is_empty());
    }

    #[test]
    fn a_curve_is_cut_where_it_leaves() {
        let points = [(0.0, 0.0), (1.0, 2.0), (2.0, 0.0), (3.0, -2.0), (4.0, -2.0), (5.0, 4.0)];
        let cut = clipped(&points, &(-1.0..1.0));
        assert_eq!(
            cut,
            [
                vec![(0.0, 0.0), (0.5, 1.0)],
                vec![(1.5, 1.0), (2.0, 0.0), (2.5, -1.0)],
                vec![(4.0 + 1.0 / 6.0, -1.0), (4.5, 1.0)],
            ]
        );
        assert_eq!(clipped(&points, &(-9.0..9.0)), [points.to_vec()]);
    }
}
