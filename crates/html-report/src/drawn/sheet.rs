//! What a figure is made of, before it is drawn on anything. Lengths are in units of an SVG's pixels.

use std::ops::Range;

use plotters::style::{Color, RGBAColor, RGBColor};

use super::axis::Axis;
use crate::events::Event;
use crate::figures::Figures;

/// Room around the axes of a panel.
pub(super) const LEFT: u32 = 64;
pub(super) const RIGHT: u32 = 14;
pub(super) const TOP: u32 = 10;
pub(super) const BOTTOM: u32 = 44;
/// Room of a panel's title.
pub(super) const TITLE: u32 = 20;

/// Okabe and Ito's colours and an olive, in the order of the page.
const COLOURS: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(27, 27, 27),
    RGBColor(138, 127, 0),
];
pub(super) const BLUE: RGBColor = COLOURS[0];
pub(super) const VERMILION: RGBColor = COLOURS[1];
pub(super) const ORANGE: RGBColor = COLOURS[4];
pub(super) const SKY: RGBColor = COLOURS[5];
pub(super) const INK: RGBColor = COLOURS[6];
pub(super) const SOFT: RGBColor = RGBColor(92, 92, 92);
pub(super) const FAINT: RGBColor = RGBColor(200, 200, 200);

/// A figure: panels row by row below a line of names.
pub(super) struct Sheet {
    /// Width and height of each panel.
    pub panel: (u32, u32),
    /// Panels in a row.
    pub across: usize,
    /// What all of it shows; may be empty.
    pub name: String,
    pub keys: Vec<Key>,
    pub panels: Vec<Panel>,
}

/// What a colour means.
#[derive(Clone)]
pub(super) struct Key {
    pub name: String,
    pub colour: RGBAColor,
    pub mark: Mark,
}

/// What stands beside a name.
#[derive(Clone, Copy)]
pub(super) enum Mark {
    Line(Option<Dash>),
    Area,
    Dot,
    Ring,
}

/// Lengths of a dash and of the gap after it.
pub(super) type Dash = (u32, u32);

/// One pair of axes.
pub(super) struct Panel {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    /// Rectangles behind all else.
    pub areas: Vec<Area>,
    pub lines: Vec<Line>,
    pub dots: Vec<Dot>,
    pub texts: Vec<Label>,
    /// Room left of and right of the axes.
    pub sides: (u32, u32),
    /// A table has its names on top, and neither grid nor lines of axes.
    pub table: bool,
}

pub(super) struct Area {
    pub x: Range<f64>,
    pub y: Range<f64>,
    pub colour: RGBAColor,
}

#[derive(Clone)]
pub(super) struct Line {
    pub points: Vec<(f64, f64)>,
    pub colour: RGBColor,
    pub width: f64,
    pub dash: Option<Dash>,
}

pub(super) struct Dot {
    pub at: (f64, f64),
    pub radius: f64,
    pub colour: RGBColor,
    /// Hollow.
    pub ring: bool,
}

/// A text in the middle of a place, or to the right of the axes.
pub(super) struct Label {
    pub at: (f64, f64),
    pub text: String,
    pub bold: bool,
    pub beside: bool,
}

impl Panel {
    /// A panel with nothing in it yet.
    pub fn new(x: Axis, y: Axis) -> Self {
        Self {
            title: String::new(),
            x,
            y,
            areas: Vec::new(),
            lines: Vec::new(),
            dots: Vec::new(),
            texts: Vec::new(),
            sides: (LEFT, RIGHT),
            table: false,
        }
    }

    /// Shades the times of burns and vents.
    pub fn during(mut self, events: &[Event]) -> Self {
        let (x, y) = (self.x.range.clone(), self.y.range.clone());
        let inside = |t: f64| t.clamp(x.start, x.end);
        self.areas.extend(events.iter().map(|e| Area {
            x: inside(e.from_s)..inside(e.to_s),
            y: y.clone(),
            colour: shade(e.kind),
        }));
        self
    }

    /// Shades a stretch of values.
    pub fn within(mut self, low: f64, high: f64) -> Self {
        let y = &self.y.range;
        self.areas.push(Area {
            x: self.x.range.clone(),
            y: low.max(y.start)..high.min(y.end),
            colour: BOUNDS.1.mix(0.18),
        });
        self
    }
}

/// Bounds of a consistent filter.
const BOUNDS: (&str, RGBColor) = ("95 % bounds", COLOURS[2]);

fn shade(kind: &str) -> RGBAColor {
    if kind == "burn" { ORANGE.mix(0.3) } else { SKY.mix(0.16) }
}

impl Key {
    pub fn line(name: impl Into<String>, colour: RGBColor, dash: Option<Dash>) -> Self {
        Self {
            name: name.into(),
            colour: colour.to_rgba(),
            mark: Mark::Line(dash),
        }
    }

    pub fn area(name: impl Into<String>, colour: RGBAColor) -> Self {
        Self {
            name: name.into(),
            colour,
            mark: Mark::Area,
        }
    }

    pub fn bounds() -> Self {
        Self::area(BOUNDS.0, BOUNDS.1.mix(0.18))
    }

    /// What is shaded where.
    pub fn of_events(events: &[Event]) -> impl Iterator<Item = Self> {
        let kinds = [("burn", "burns"), ("vent", "vents")];
        let there = kinds.map(|(kind, name)| {
            events
                .iter()
                .any(|e| e.kind == kind)
                .then(|| Self::area(name, shade(kind)))
        });
        there.into_iter().flatten()
    }

    /// The filters for which something is drawn.
    pub fn of_filters(figures: &Figures, drawn: impl Fn(usize) -> bool) -> Vec<Self> {
        let filters = figures.filters.iter().enumerate().filter(|(index, _)| drawn(*index));
        filters
            .map(|(index, f)| Self::line(&f.name, colour(index), dash(index)))
            .collect()
    }
}

pub(super) fn colour(index: usize) -> RGBColor {
    COLOURS[index % COLOURS.len()]
}

/// Filters beyond the eighth repeat a colour with another dash.
pub(super) fn dash(index: usize) -> Option<Dash> {
    [None, Some((8, 3)), Some((2, 3))][index / COLOURS.len() % 3]
}

/// The points of a curve, without those that are absent.
pub(super) fn points(t: &[f64], values: &[Option<f64>], factor: f64) -> Vec<(f64, f64)> {
    t.iter()
        .zip(values)
        .filter_map(|(t, v)| Some((*t, factor * (*v)?)))
        .collect()
}

/// The points of a curve on an axis of powers of ten.
pub(super) fn logarithms(t: &[f64], values: &[Option<f64>]) -> Vec<(f64, f64)> {
    let positive = points(t, values, 1.0).into_iter().filter(|p| p.1 > 0.0);
    positive.map(|p| (p.0, p.1.log10())).collect()
}

/// The range of values, with a margin.
pub(super) fn range(values: impl IntoIterator<Item = f64>) -> Range<f64> {
    let (low, high) = values
        .into_iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
            (low.min(v), high.max(v))
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

/// The range of curves at or after a time, with a margin.
pub(super) fn range_of(lines: &[Line], from: f64) -> Range<f64> {
    let scored = lines.iter().flat_map(|l| &l.points).filter(|p| p.0 >= from);
    range(scored.map(|p| p.1))
}
