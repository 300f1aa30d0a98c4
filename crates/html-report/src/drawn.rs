//! The figures as files for papers and slides: SVG and PNG.

use std::fs;
use std::ops::Range;
use std::path::Path;
use std::sync::OnceLock;

use plotters::coord::Shift;
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::prelude::*;
use plotters::style::FontStyle;

use crate::ReportError;
use crate::events::Event;
use crate::figures::{self, Figures, FilterFigures, Forest};
use crate::folder::Folder;
use crate::kept::{KeptRuns, Path as TruePath};
use crate::number::significant;
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

/// What the figure of errors draws.
const SAMPLE: (&str, RGBColor) = ("3 sigma of the errors", COLOURS[0]);
const ESTIMATED: (&str, RGBColor) = ("3 sigma as estimated", COLOURS[1]);
const MEAN: (&str, RGBColor) = ("mean error", COLOURS[6]);
const RUNS: (&str, RGBColor) = ("single runs", RGBColor(200, 200, 200));

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
                    to.errors(&figures, series, filter.kept.as_ref())
                })?;
            }
        }
        if figures.filters.iter().any(|f| f.series.is_some()) {
            add("consistency", (1000, 620), &|to| to.consistency(&figures))?;
        }
        if figures.filters.iter().any(|f| f.jerk_root().is_some()) {
            add("process_noise", (1200, 420), &|to| to.jerk_root(&figures))?;
        }
        if let Some(path) = &figures.path {
            let rows = 1 + u32::from(!path.chaser.is_empty());
            add("path", (1100, 420 * rows), &|to| to.path(path))?;
        }
        for (index, [quantity, _]) in figures.errors.iter().enumerate() {
            let pairs = figures.forest.iter().filter(|f| f.quantity == *quantity).count() as u32;
            if pairs > 0 {
                add(&format!("paired_{quantity}"), (900, 120 + 40 * pairs), &|to| {
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
    fn errors(&mut self, figures: &Figures, series: &Series, kept: Option<&KeptRuns>) -> Result<(), ReportError>;
    fn jerk_root(&mut self, figures: &Figures) -> Result<(), ReportError>;
    fn path(&mut self, path: &TruePath) -> Result<(), ReportError>;
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

/// A curve.
struct Line {
    points: Vec<(f64, f64)>,
    colour: RGBColor,
    /// Pixels. Time series have one: the library's mitres of wider lines stick out beyond their points.
    width: u32,
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

/// Names and colours of the filters.
fn filters(figures: &Figures) -> impl Iterator<Item = (&str, RGBColor)> {
    let filters = figures.filters.iter().enumerate();
    filters.map(|(index, filter)| (filter.name.as_str(), colour(index)))
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
            .build_cartesian_2d(Axis::new(&x, panel.powers.0), Axis::new(&y, panel.powers.1))
            .map_err(failed)?;
        let label = |powers: bool| move |v: &f64| tick(if powers { 10.0_f64.powf(*v) } else { *v });
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(RGBColor(225, 225, 225))
            .x_desc(panel.x.1)
            .y_desc(panel.y.1)
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
        for line in panel.lines {
            let style = line.colour.stroke_width(line.width);
            chart.draw_series(LineSeries::new(line.points, style)).map_err(failed)?;
        }
        Ok(())
    }

    /// Writes names beside their colours along the top; returns the room below.
    fn legend<'n>(
        &self,
        entries: impl IntoIterator<Item = (&'n str, RGBColor)>,
    ) -> Result<DrawingArea<B, Shift>, ReportError> {
        self.root.fill(&WHITE).map_err(failed)?;
        let unit = self.scale as i32;
        let (strip, rest) = self.root.split_vertically(26 * unit);
        let mut x = 74 * unit;
        for (name, colour) in entries {
            let style = colour.stroke_width(2 * self.scale);
            let y = 14 * unit;
            strip
                .draw(&PathElement::new([(x, y), (x + 22 * unit, y)], style))
                .map_err(failed)?;
            let text = Text::new(name.to_owned(), (x + 28 * unit, y - 7 * unit), self.font(13));
            strip.draw(&text).map_err(failed)?;
            x += unit * (50 + 7 * name.chars().count() as i32);
        }
        Ok(rest)
    }

    fn axis(
        &self,
        area: &DrawingArea<B, Shift>,
        figures: &Figures,
        t: &[f64],
        quantity: &QuantitySeries,
        axis: &AxisSeries,
        kept: Option<&KeptRuns>,
    ) -> Result<(), ReportError> {
        let kinds: [(&[Option<f64>], f64, RGBColor); 5] = [
            (&axis.sample, 3.0, SAMPLE.1),
            (&axis.sample, -3.0, SAMPLE.1),
            (&axis.estimated, 3.0, ESTIMATED.1),
            (&axis.estimated, -3.0, ESTIMATED.1),
            (&axis.mean, 1.0, MEAN.1),
        ];
        let lines = kinds.map(|(values, factor, colour)| Line {
            points: points(t, values, factor),
            colour,
            width: 1,
        });
        let y = range(&lines, figures.scored_from_s);
        // What is outside of the range of the scored time comes before it.
        let runs = kept.into_iter().flat_map(|kept| {
            let values = kept.columns.get(&axis.column).map_or(&[][..], |c| c.0.as_slice());
            values.chunks(kept.t.len()).map(|run| Line {
                points: points(&kept.t, run, 1.0),
                colour: RUNS.1,
                width: 1,
            })
        });
        let lines = runs.chain(lines).map(|line| Line {
            points: line.points.into_iter().filter(|p| y.contains(&p.1)).collect(),
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

/// A linear axis with places of our own: the library's are not round where numbers are powers of ten.
struct Axis {
    range: Range<f64>,
    places: Vec<f64>,
}

impl Axis {
    fn new(range: &Range<f64>, powers: bool) -> Self {
        Self {
            range: range.clone(),
            places: if powers { decades(range) } else { ticks(range) },
        }
    }
}

impl Ranged for Axis {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let share = (value - self.range.start) / (self.range.end - self.range.start);
        limit.0 + (share * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<H: KeyPointHint>(&self, _hint: H) -> Vec<f64> {
        self.places.clone()
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

/// Some five places of a linear axis: multiples of one, two or five times a power of ten.
fn ticks(range: &Range<f64>) -> Vec<f64> {
    let raw = (range.end - range.start) / 5.0;
    let power = 10.0_f64.powf(raw.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|m| m * power);
    let step = steps.into_iter().find(|s| *s >= raw).unwrap_or(raw);
    let (first, last) = ((range.start / step).ceil() as i64, (range.end / step).floor() as i64);
    (first..=last).map(|k| k as f64 * step).collect()
}

/// Places of an axis of powers of ten: the powers, or also twice and five times these where there are few.
fn decades(range: &Range<f64>) -> Vec<f64> {
    let within: &[f64] = if range.end - range.start > 2.5 {
        &[1.0]
    } else {
        &[1.0, 2.0, 5.0]
    };
    let powers = range.start.floor() as i64..=range.end.floor() as i64;
    let places = powers.flat_map(|k| within.iter().map(move |m| k as f64 + m.log10()));
    places.filter(|v| range.contains(v)).collect()
}

/// A number of an axis.
fn tick(value: f64) -> String {
    if value == 0.0 || (1e-2..1e5).contains(&value.abs()) {
        significant(value, 6).to_string()
    } else {
        format!("{:e}", significant(value, 3))
    }
}

impl<B: DrawingBackend> Draw for Canvas<B>
where
    B::ErrorType: 'static,
{
    fn errors(&mut self, figures: &Figures, series: &Series, kept: Option<&KeptRuns>) -> Result<(), ReportError> {
        let room = self.legend([MEAN, SAMPLE, ESTIMATED].into_iter().chain(kept.map(|_| RUNS)))?;
        let rows = room.split_evenly((series.quantities.len().max(1), 1));
        for (row, quantity) in rows.iter().zip(&series.quantities) {
            let areas = row.split_evenly((1, quantity.axes.len()));
            for (area, axis) in areas.iter().zip(&quantity.axes) {
                self.axis(area, figures, &series.t, quantity, axis, kept)?;
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
        let room = self.legend(filters(figures))?;
        for (area, (name, values, band)) in room.split_evenly((2, 1)).iter().zip(kinds) {
            let lines = figures.filters.iter().enumerate().filter_map(|(index, filter)| {
                let series = filter.series.as_ref()?;
                let mut points = points(&series.t, values(series), 1.0);
                points.retain(|p| p.1 > 0.0);
                points.iter_mut().for_each(|p| p.1 = p.1.log10());
                Some(Line {
                    points,
                    colour: colour(index),
                    width: 1,
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

    fn jerk_root(&mut self, figures: &Figures) -> Result<(), ReportError> {
        let room = self.legend(filters(figures))?;
        for (axis, area) in room.split_evenly((1, 3)).iter().enumerate() {
            let lines = figures.filters.iter().enumerate().filter_map(|(index, filter)| {
                let values = &filter.jerk_root()?[axis].0;
                let t = &filter.series.as_ref()?.t;
                let mut points = points(t, values, 1.0);
                points.retain(|p| p.1 > 0.0);
                points.iter_mut().for_each(|p| p.1 = p.1.log10());
                Some(Line {
                    points,
                    colour: colour(index),
                    width: 1,
                })
            });
            let lines: Vec<Line> = lines.collect();
            let name = ["x", "y", "z"][axis];
            self.panel(
                area,
                Panel {
                    x: (0.0..figures.duration_s, "time [s]".to_owned()),
                    y: (range(&lines, 0.0), format!("root of q, {name} [m/s^2.5]")),
                    powers: (false, true),
                    lines,
                    events: &figures.events,
                    band: None,
                },
            )?;
        }
        self.root.present().map_err(failed)
    }

    fn path(&mut self, path: &TruePath) -> Result<(), ReportError> {
        let room = self.legend([("true path of run 0", COLOURS[6])])?;
        let orbit = !path.chaser.is_empty();
        let areas = room.split_evenly((1 + usize::from(orbit), 2));
        let axes = &path.axes;
        let center = path.body.map_or([0.0; 3], |(_, center)| center);
        let from_body = |(list, c): (&Vec<Option<f64>>, f64)| list.iter().map(|v| v.map(|v| v - c)).collect();
        let about: Vec<Vec<Option<f64>>> = path.chaser.iter().zip(center).map(from_body).collect();
        let mut panels: Vec<_> = [(1, 0), (1, 2)]
            .map(|at| (&path.relative, axes[at.0].as_str(), axes[at.1].as_str(), at))
            .into();
        if orbit {
            panels.extend([(0, 2), (1, 2)].map(|at| (&about, ["x", "y"][at.0], "z", at)));
        }
        for (area, (values, across, up, (a, b))) in areas.iter().zip(panels) {
            let both = values[a].iter().zip(&values[b]);
            let points: Vec<(f64, f64)> = both.filter_map(|(a, b)| Option::zip(*a, *b)).collect();
            let extent = |of: &dyn Fn(&(f64, f64)) -> f64| {
                let line = Line {
                    points: points.iter().map(|p| (0.0, of(p))).collect(),
                    colour: BLACK,
                    width: 1,
                };
                range(&[line], 0.0)
            };
            let (x, y) = (extent(&|p| p.0), extent(&|p| p.1));
            let line = Line {
                points,
                colour: COLOURS[6],
                width: 2,
            };
            self.panel(
                area,
                Panel {
                    x: (x, format!("{across} [m]")),
                    y: (y, format!("{up} [m]")),
                    powers: (false, false),
                    lines: vec![line],
                    events: &[],
                    band: None,
                },
            )?;
        }
        self.root.present().map_err(failed)
    }

    fn forest(&mut self, figures: &Figures, quantity: usize) -> Result<(), ReportError> {
        let [quantity, unit] = figures.errors[quantity];
        let rows: Vec<_> = figures.forest.iter().rev().filter(|f| f.quantity == quantity).collect();
        let ends = rows
            .iter()
            .flat_map(|f| [f.low.unwrap_or(f.mean), f.high.unwrap_or(f.mean), 0.0]);
        let x = range(
            &[Line {
                points: ends.map(|v| (0.0, v)).collect(),
                colour: BLACK,
                width: 1,
            }],
            0.0,
        );
        self.root.fill(&WHITE).map_err(failed)?;
        let mut chart = ChartBuilder::on(&self.root)
            .margin(8 * self.scale)
            .margin_right(30 * self.scale)
            .x_label_area_size(42 * self.scale)
            .y_label_area_size(250 * self.scale)
            .build_cartesian_2d(Axis::new(&x, false), (0..rows.len().saturating_sub(1)).into_segmented())
            .map_err(failed)?;
        let pair = |f: &&Forest| format!("{} − {}", f.filter, f.reference);
        let name = |at: &SegmentValue<usize>| match at {
            SegmentValue::CenterOf(i) => rows.get(*i).map(pair).unwrap_or_default(),
            _ => String::new(),
        };
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(RGBColor(225, 225, 225))
            .disable_y_mesh()
            .x_desc(format!("difference of {quantity} RMSE, 95 % interval [{unit}]"))
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
                width: 2 * self.scale,
            }
        });
        let mut lines: Vec<Line> = lines.collect();
        let turned = |line: &Line| Line {
            points: line.points.iter().map(|p| (0.0, p.0)).collect(),
            colour: line.colour,
            width: line.width,
        };
        let x = range(&lines.iter().map(turned).collect::<Vec<_>>(), 0.0);
        for line in &mut lines {
            line.points.extend(line.points.last().map(|last| (x.end, last.1)));
        }
        let room = self.legend(filters(figures))?;
        self.panel(
            &room,
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_round_and_inside() {
        assert_eq!(ticks(&(-0.9..1.3)), [-0.5, 0.0, 0.5, 1.0]);
        let powers: Vec<f64> = decades(&(-0.8..0.5))
            .iter()
            .map(|v| significant(10.0_f64.powf(*v), 3))
            .collect();
        assert_eq!(powers, [0.2, 0.5, 1.0, 2.0]);
        assert_eq!(decades(&(-3.1..1.2)), [-3.0, -2.0, -1.0, 0.0, 1.0]);
    }
}
