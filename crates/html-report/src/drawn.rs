//! The figures as files for papers and slides: SVG and PNG.

use std::fs;
use std::ops::Range;
use std::path::Path;
use std::sync::OnceLock;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::FontStyle;

use crate::ReportError;
use crate::events::Event;
use crate::figures::{self, Figures, FilterFigures};
use crate::folder::Folder;
use crate::number::short;
use crate::series::{AxisSeries, QuantitySeries, Series};

/// Kind of picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Lines and text.
    Svg,
    /// Pixels, twice as many as the SVG says.
    Png,
}

/// Okabe and Ito's colours, in the order of the page.
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(27, 27, 27),
];

/// Where systems keep a sans-serif font.
const FONTS: [&str; 6] = [
    "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
    "/usr/share/fonts/TTF/DejaVuSans.ttf",
    "/System/Library/Fonts/Supplemental/Arial.ttf",
    "C:\\Windows\\Fonts\\arial.ttf",
];

/// Every figure of every study of a folder.
///
/// * returns: names and contents, `figures/SCENARIO_CASE_WHAT.svg` or `.png`.
///
/// # Errors
/// [`ReportError`]: those of [`crate::html`], and [`ReportError::NoFont`], [`ReportError::Drawing`].
pub fn drawn(folder: &Path, format: Format) -> Result<Vec<(String, Vec<u8>)>, ReportError> {
    use_a_font()?;
    let folder = Folder::read(folder)?;
    let mut files = Vec::new();
    for (study, figures) in folder.manifest.studies.iter().zip(figures::all(&folder)?) {
        let mut add = |what: &str, size: (u32, u32), draw: &dyn Fn(&mut dyn Draw) -> Result<(), ReportError>| {
            let extension = if format == Format::Svg { "svg" } else { "png" };
            let name = format!("figures/{}_{}_{what}.{extension}", study.scenario, study.case);
            files.push((name, picture(format, size, draw)?));
            Ok::<_, ReportError>(())
        };
        for filter in &figures.filters {
            if let Some(series) = &filter.series {
                add(&format!("error_{}", filter.name), (1200, 780), &|to| {
                    to.errors(&figures, series)
                })?;
            }
        }
        if figures.filters.iter().any(|f| f.series.is_some()) {
            add("consistency", (1000, 620), &|to| to.consistency(&figures))?;
        }
        for (index, [quantity, _]) in figures.errors.iter().enumerate() {
            if figures.forest.iter().any(|f| f.quantity == *quantity) {
                add(&format!("paired_{quantity}"), (900, 360), &|to| {
                    to.forest(&figures, index)
                })?;
            }
            if figures.filters.iter().any(|f| !f.sorted[index].is_empty()) {
                add(&format!("runs_{quantity}"), (900, 460), &|to| to.cdf(&figures, index))?;
            }
        }
    }
    Ok(files)
}

/// Registers the first font of the system that there is.
fn use_a_font() -> Result<(), ReportError> {
    static FONT: OnceLock<Option<Vec<u8>>> = OnceLock::new();
    let found = FONT.get_or_init(|| FONTS.iter().find_map(|path| fs::read(path).ok()));
    let font = found.as_ref().ok_or(ReportError::NoFont)?;
    plotters::style::register_font("sans-serif", FontStyle::Normal, font).map_err(|_| ReportError::NoFont)
}

fn picture(
    format: Format,
    (width, height): (u32, u32),
    draw: &dyn Fn(&mut dyn Draw) -> Result<(), ReportError>,
) -> Result<Vec<u8>, ReportError> {
    match format {
        Format::Svg => {
            let mut text = String::new();
            let root = SVGBackend::with_string(&mut text, (width, height)).into_drawing_area();
            draw(&mut Canvas { root, scale: 1 })?;
            Ok(text.into_bytes())
        }
        Format::Png => {
            // The library encodes into files alone.
            let read = |source| ReportError::Read {
                path: std::env::temp_dir(),
                source,
            };
            let folder = tempfile::tempdir().map_err(read)?;
            let path = folder.path().join("figure.png");
            let root = BitMapBackend::new(&path, (2 * width, 2 * height)).into_drawing_area();
            draw(&mut Canvas { root, scale: 2 })?;
            fs::read(&path).map_err(read)
        }
    }
}

/// What can be drawn, on whichever canvas.
trait Draw {
    fn errors(&mut self, figures: &Figures, series: &Series) -> Result<(), ReportError>;
    fn consistency(&mut self, figures: &Figures) -> Result<(), ReportError>;
    fn forest(&mut self, figures: &Figures, quantity: usize) -> Result<(), ReportError>;
    fn cdf(&mut self, figures: &Figures, quantity: usize) -> Result<(), ReportError>;
}

struct Canvas<B: DrawingBackend> {
    root: DrawingArea<B, Shift>,
    /// Pixels of a unit of length.
    scale: u32,
}

fn failed<E: std::error::Error>(error: E) -> ReportError {
    ReportError::Drawing(error.to_string())
}

/// A curve: its points, its colour, its name in the legend if it has one.
struct Line {
    points: Vec<(f64, f64)>,
    colour: RGBColor,
    name: Option<String>,
}

/// One pair of axes.
struct Panel<'a> {
    x: (Range<f64>, String),
    y: (Range<f64>, String),
    /// Whether x and y stand for powers of ten.
    powers: (bool, bool),
    lines: Vec<Line>,
    events: &'a [Event],
    band: Option<[f64; 2]>,
}

fn colour(index: usize) -> RGBColor {
    COLOURS[index % COLOURS.len()]
}

/// The points of a curve, without those that are absent.
fn points(t: &[f64], values: &[Option<f64>], factor: f64) -> Vec<(f64, f64)> {
    t.iter()
        .zip(values)
        .filter_map(|(t, v)| Some((*t, factor * (*v)?)))
        .collect()
}

/// The range of what lies at or after a time, with a margin.
fn range<'a>(lines: impl IntoIterator<Item = &'a Line>, from: f64) -> Range<f64> {
    let scored = lines.into_iter().flat_map(|l| &l.points).filter(|p| p.0 >= from);
    let (low, high) = scored.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
        (low.min(p.1), high.max(p.1))
    });
    if low > high {
        return -1.0..1.0;
    }
    let margin = if high > low {
        0.06 * (high - low)
    } else {
        high.abs().max(1.0)
    };
    low - margin..high + margin
}

impl<B: DrawingBackend> Canvas<B>
where
    B::ErrorType: 'static,
{
    fn font(&self, size: u32) -> (&'static str, u32) {
        ("sans-serif", size * self.scale)
    }

    fn panel(&self, area: &DrawingArea<B, Shift>, panel: Panel<'_>) -> Result<(), ReportError> {
        let (x, y) = (panel.x.0.clone(), panel.y.0.clone());
        let mut chart = ChartBuilder::on(area)
            .margin(8 * self.scale)
            .x_label_area_size(38 * self.scale)
            .y_label_area_size(66 * self.scale)
            .build_cartesian_2d(x.clone(), y.clone())
            .map_err(failed)?;
        let label = |powers: bool| {
            move |v: &f64| {
                if powers {
                    short(Some(10.0_f64.powf(*v)))
                } else {
                    tick(*v)
                }
            }
        };
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(RGBColor(225, 225, 225))
            .x_desc(panel.x.1)
            .y_desc(panel.y.1)
            .x_labels(7)
            .y_labels(6)
            .x_label_formatter(&label(panel.powers.0))
            .y_label_formatter(&label(panel.powers.1))
            .label_style(self.font(12))
            .axis_desc_style(self.font(13))
            .draw()
            .map_err(failed)?;
        let burn = RGBColor(230, 159, 0).mix(0.3).filled();
        let vent = RGBColor(86, 180, 233).mix(0.16).filled();
        let shades = panel.events.iter().map(|e| {
            let style = if e.kind == "burn" { burn } else { vent };
            let inside = |t: f64| t.clamp(x.start, x.end);
            Rectangle::new([(inside(e.from_s), y.start), (inside(e.to_s), y.end)], style)
        });
        chart.draw_series(shades).map_err(failed)?;
        if let Some([low, high]) = panel.band {
            let style = RGBColor(0, 158, 115).mix(0.18).filled();
            let band = Rectangle::new([(x.start, low.max(y.start)), (x.end, high.min(y.end))], style);
            chart.draw_series([band]).map_err(failed)?;
        }
        let mut named = false;
        let length = 20 * self.scale as i32;
        for line in panel.lines {
            let style = line.colour.stroke_width(self.scale);
            let drawn = chart.draw_series(LineSeries::new(line.points, style)).map_err(failed)?;
            if let Some(name) = line.name {
                named = true;
                drawn
                    .label(name)
                    .legend(move |(x, y)| PathElement::new([(x, y), (x + length, y)], style));
            }
        }
        if named {
            chart
                .configure_series_labels()
                .position(SeriesLabelPosition::UpperRight)
                .background_style(WHITE.mix(0.8))
                .legend_area_size(26 * self.scale)
                .label_font(self.font(12))
                .draw()
                .map_err(failed)?;
        }
        Ok(())
    }

    fn axis(
        &self,
        area: &DrawingArea<B, Shift>,
        figures: &Figures,
        t: &[f64],
        quantity: &QuantitySeries,
        axis: &AxisSeries,
    ) -> Result<(), ReportError> {
        let kinds: [(&[Option<f64>], f64, usize, Option<&str>); 5] = [
            (&axis.sample, 3.0, 0, Some("3 sigma sample")),
            (&axis.sample, -3.0, 0, None),
            (&axis.estimated, 3.0, 1, Some("3 sigma estimated")),
            (&axis.estimated, -3.0, 1, None),
            (&axis.mean, 1.0, 6, Some("mean error")),
        ];
        let lines = kinds.map(|(values, factor, index, name)| Line {
            points: points(t, values, factor),
            colour: colour(index),
            name: name.map(str::to_owned),
        });
        let y = range(&lines, figures.scored_from_s);
        // What lies outside before the scored time ends at the frame.
        let lines = lines.into_iter().map(|line| Line {
            points: line.points.iter().map(|p| (p.0, p.1.clamp(y.start, y.end))).collect(),
            ..line
        });
        self.panel(
            area,
            Panel {
                x: (0.0..figures.duration_s, "time [s]".to_owned()),
                y: (
                    y.clone(),
                    format!("{}, {} [{}]", quantity.name, axis.axis, quantity.unit),
                ),
                powers: (false, false),
                lines: lines.collect(),
                events: &figures.events,
                band: None,
            },
        )
    }
}

/// A number of an axis.
fn tick(value: f64) -> String {
    if value == 0.0 || (1e-2..1e5).contains(&value.abs()) {
        format!("{}", crate::number::significant(value, 6))
    } else {
        format!("{:e}", crate::number::significant(value, 3))
    }
}

impl<B: DrawingBackend> Draw for Canvas<B>
where
    B::ErrorType: 'static,
{
    fn errors(&mut self, figures: &Figures, series: &Series) -> Result<(), ReportError> {
        self.root.fill(&WHITE).map_err(failed)?;
        let rows = self.root.split_evenly((series.quantities.len().max(1), 1));
        for (row, quantity) in rows.iter().zip(&series.quantities) {
            let areas = row.split_evenly((1, quantity.axes.len()));
            for (area, axis) in areas.iter().zip(&quantity.axes) {
                self.axis(area, figures, &series.t, quantity, axis)?;
            }
        }
        self.root.present().map_err(failed)
    }

    fn consistency(&mut self, figures: &Figures) -> Result<(), ReportError> {
        type Values = fn(&Series) -> &[Option<f64>];
        type Band = fn(&FilterFigures) -> Option<[f64; 2]>;
        let kinds: [(&str, Values, Band); 2] = [
            ("NEES / states [1]", |s| &s.nees, |f| f.nees_bounds),
            ("NIS / rows [1]", |s| &s.nis, |f| f.nis_bounds),
        ];
        self.root.fill(&WHITE).map_err(failed)?;
        for (area, (name, values, band)) in self.root.split_evenly((2, 1)).iter().zip(kinds) {
            let lines = figures.filters.iter().enumerate().filter_map(|(index, filter)| {
                let series = filter.series.as_ref()?;
                let mut points = points(&series.t, values(series), 1.0);
                points.retain(|p| p.1 > 0.0);
                points.iter_mut().for_each(|p| p.1 = p.1.log10());
                Some(Line {
                    points,
                    colour: colour(index),
                    name: Some(filter.name.clone()),
                })
            });
            let lines: Vec<Line> = lines.collect();
            self.panel(
                area,
                Panel {
                    x: (0.0..figures.duration_s, "time [s]".to_owned()),
                    y: (range(&lines, 0.0), name.to_owned()),
                    powers: (false, true),
                    lines,
                    events: &figures.events,
                    band: figures.filters.iter().find_map(band).map(|b| b.map(f64::log10)),
                },
            )?;
        }
        self.root.present().map_err(failed)
    }

    fn forest(&mut self, figures: &Figures, quantity: usize) -> Result<(), ReportError> {
        let [quantity, unit] = figures.errors[quantity];
        let rows: Vec<_> = figures.forest.iter().filter(|f| f.quantity == quantity).collect();
        let ends = rows
            .iter()
            .flat_map(|f| [f.low.unwrap_or(f.mean), f.high.unwrap_or(f.mean), 0.0]);
        let x = range(
            &[Line {
                points: ends.map(|v| (0.0, v)).collect(),
                colour: BLACK,
                name: None,
            }],
            0.0,
        );
        self.root.fill(&WHITE).map_err(failed)?;
        let mut chart = ChartBuilder::on(&self.root)
            .margin(8 * self.scale)
            .margin_right(30 * self.scale)
            .x_label_area_size(42 * self.scale)
            .y_label_area_size(170 * self.scale)
            .build_cartesian_2d(x, (0..rows.len().saturating_sub(1)).into_segmented())
            .map_err(failed)?;
        let name = |at: &SegmentValue<usize>| match at {
            SegmentValue::CenterOf(i) => rows.get(*i).map(|f| f.filter.clone()).unwrap_or_default(),
            _ => String::new(),
        };
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(RGBColor(225, 225, 225))
            .disable_y_mesh()
            .x_desc(format!(
                "{quantity} RMSE of a run minus that of {}, 95 % interval [{unit}]",
                figures.reference
            ))
            .x_label_formatter(&|v| tick(*v))
            .y_label_formatter(&name)
            .y_labels(rows.len() + 1)
            .label_style(self.font(13))
            .axis_desc_style(self.font(13))
            .draw()
            .map_err(failed)?;
        let zero = [(0.0, SegmentValue::Exact(0)), (0.0, SegmentValue::Last)];
        chart.draw_series([PathElement::new(zero, BLACK)]).map_err(failed)?;
        for (i, row) in rows.iter().enumerate() {
            let index = figures.filters.iter().position(|f| f.name == row.filter);
            let style = colour(index.unwrap_or(0)).stroke_width(2 * self.scale);
            let at = |v: f64| (v, SegmentValue::CenterOf(i));
            if let Some((low, high)) = Option::zip(row.low, row.high) {
                chart
                    .draw_series([PathElement::new([at(low), at(high)], style)])
                    .map_err(failed)?;
            }
            let dot = Circle::new(at(row.mean), 5 * self.scale, style.filled());
            chart.draw_series([dot]).map_err(failed)?;
        }
        self.root.present().map_err(failed)
    }

    fn cdf(&mut self, figures: &Figures, quantity: usize) -> Result<(), ReportError> {
        let [name, unit] = figures.errors[quantity];
        let lines = figures.filters.iter().enumerate().map(|(index, filter)| {
            let share = |n: usize| n as f64 / f64::from(filter.runs);
            let steps = filter.sorted[quantity].iter().filter(|v| **v > 0.0).enumerate();
            let steps = steps.flat_map(|(i, v)| [(v.log10(), share(i)), (v.log10(), share(i + 1))]);
            Line {
                points: steps.collect(),
                colour: colour(index),
                name: Some(filter.name.clone()),
            }
        });
        let mut lines: Vec<Line> = lines.collect();
        let turned = |line: &Line| Line {
            points: line.points.iter().map(|p| (0.0, p.0)).collect(),
            colour: line.colour,
            name: None,
        };
        let x = range(&lines.iter().map(turned).collect::<Vec<_>>(), 0.0);
        for line in &mut lines {
            line.points.extend(line.points.last().map(|last| (x.end, last.1)));
        }
        self.root.fill(&WHITE).map_err(failed)?;
        let root = self.root.clone();
        self.panel(
            &root,
            Panel {
                x: (x, format!("{name} RMSE of a run [{unit}]")),
                y: (0.0..1.02, "share of runs [1]".to_owned()),
                powers: (true, false),
                lines,
                events: &[],
                band: None,
            },
        )?;
        self.root.present().map_err(failed)
    }
}
