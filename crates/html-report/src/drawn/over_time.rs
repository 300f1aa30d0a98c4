//! Figures over time.

use super::axis::Axis;
use super::sheet::{
    BLUE, FAINT, INK, Key, LEFT, Line, Panel, RIGHT, Sheet, VERMILION, colour, dash, logarithms, points, range,
    range_of,
};
use crate::figures::{Figures, FilterFigures};
use crate::kept::KeptRuns;
use crate::learning::Learning;
use crate::series::{AxisSeries, QuantitySeries, Series};

/// Numbers that a time axis of so many units has room for.
fn times(width: u32) -> f64 {
    (f64::from(width - LEFT - RIGHT) / 60.0).clamp(3.0, 10.0)
}

fn time(figures: &Figures, width: u32) -> Axis {
    Axis::linear(0.0..figures.duration_s, "time", "s", times(width))
}

/// Errors of a filter by quantity and axis.
pub(super) fn errors(figures: &Figures, filter: &FilterFigures, series: &Series) -> Sheet {
    let panel = (300, 205);
    let mut keys = vec![
        Key::line("mean error", INK, None),
        Key::line("3σ of the errors", BLUE, None),
    ];
    let mut axes = series.quantities.iter().flat_map(|q| &q.axes);
    let claims = axes.any(|a| a.estimated.iter().any(Option::is_some));
    keys.extend(claims.then(|| Key::line("3σ as estimated", VERMILION, Some((6, 3)))));
    keys.extend(filter.kept.as_ref().map(|_| Key::line("single runs", FAINT, None)));
    keys.extend(Key::of_events(&figures.events));
    let axes = series
        .quantities
        .iter()
        .flat_map(|q| q.axes.iter().map(move |a| (q, a)));
    Sheet {
        panel,
        across: series.quantities.first().map_or(1, |q| q.axes.len()),
        name: filter.name.clone(),
        keys,
        panels: axes
            .map(|(q, a)| error(figures, series, q, a, filter.kept.as_ref(), panel.0))
            .collect(),
    }
}

fn error(
    figures: &Figures,
    series: &Series,
    quantity: &QuantitySeries,
    axis: &AxisSeries,
    kept: Option<&KeptRuns>,
    width: u32,
) -> Panel {
    let curve = |values: &[Option<f64>], factor, colour, dash| Line {
        points: points(&series.t, values, factor),
        colour,
        width: 0.9,
        dash,
    };
    let dashes = Some((6, 3));
    let lines = [
        curve(&axis.sample, 3.0, BLUE, None),
        curve(&axis.sample, -3.0, BLUE, None),
        curve(&axis.mean, 1.0, INK, None),
        curve(&axis.estimated, 3.0, VERMILION, dashes),
        curve(&axis.estimated, -3.0, VERMILION, dashes),
    ];
    // What is outside of the range of the scored time comes before it.
    let y = range_of(&lines, figures.scored_from_s);
    let runs = kept.into_iter().flat_map(|kept| {
        let values = kept.columns.get(&axis.column).map_or(&[][..], |c| c.0.as_slice());
        values.chunks(kept.t.len()).map(|run| Line {
            points: points(&kept.t, run, 1.0),
            colour: FAINT,
            width: 0.6,
            dash: None,
        })
    });
    let name = format!("{}, {}", quantity.name, axis.axis);
    let mut panel =
        Panel::new(time(figures, width), Axis::linear(y, &name, quantity.unit, 5.0)).during(&figures.events);
    panel.lines = runs.chain(lines).collect();
    panel
}

/// A curve of each filter on an axis of powers of ten; none where there is no value.
fn of_filters<'f>(
    figures: &'f Figures,
    curve: impl Fn(&'f FilterFigures) -> Option<(&'f [f64], &'f [Option<f64>])>,
) -> Vec<Line> {
    let filters = figures.filters.iter().enumerate();
    let lines = filters.filter_map(|(index, filter)| {
        let (t, values) = curve(filter)?;
        Some(Line {
            points: logarithms(t, values),
            colour: colour(index),
            width: 0.9,
            dash: dash(index),
        })
    });
    lines.filter(|line| !line.points.is_empty()).collect()
}

/// NEES and NIS of every filter.
pub(super) fn consistency(figures: &Figures) -> Sheet {
    let panel = (900, 260);
    let nees = of_filters(figures, |f| {
        f.series.as_ref().map(|s| (&s.nees.t[..], &s.nees.mean[..]))
    });
    let nis = of_filters(figures, |f| f.series.as_ref().map(|s| (&s.nis.t[..], &s.nis.mean[..])));
    let bounds = [
        figures.filters.iter().find_map(|f| f.nees_bounds),
        figures.filters.iter().find_map(|f| f.nis_bounds),
    ];
    let told = |s: &Series| !s.nees.t.is_empty() || !s.nis.t.is_empty();
    let mut keys = Key::of_filters(figures, |index| {
        figures.filters[index].series.as_ref().is_some_and(told)
    });
    keys.extend(bounds.iter().flatten().next().map(|_| Key::bounds()));
    keys.extend(Key::of_events(&figures.events));
    let kinds = [("NEES / states", nees), ("NIS / rows", nis)].into_iter().zip(bounds);
    let panels = kinds.map(|((name, lines), bounds)| {
        let bounds = bounds.map(|b| b.map(f64::log10));
        let from = figures.scored_from_s;
        let curves = lines
            .iter()
            .flat_map(|l| &l.points)
            .filter(|p| p.0 >= from)
            .map(|p| p.1);
        let y = range(curves.chain(bounds.into_iter().flatten()));
        let mut made = Panel::new(time(figures, panel.0), Axis::powers(y, name, "1", 20.0)).during(&figures.events);
        if let Some([low, high]) = bounds {
            made = made.within(low, high);
        }
        made.lines = lines;
        made
    });
    Sheet {
        panel,
        across: 1,
        name: String::new(),
        keys,
        panels: panels.collect(),
    }
}

/// Root of the jerk density of every filter that tells it.
pub(super) fn process_noise(figures: &Figures) -> Sheet {
    let panel = (300, 270);
    let panels = ["x", "y", "z"].into_iter().enumerate().map(|(axis, name)| {
        let lines = of_filters(figures, |f| {
            let series = f.series.as_ref()?;
            Some((&series.t[..], &f.jerk_root()?[axis].0[..]))
        });
        let y = Axis::powers(range_of(&lines, 0.0), &format!("√q, {name}"), "m/s²·⁵", 12.0);
        let mut made = Panel::new(time(figures, panel.0), y).during(&figures.events);
        made.lines = lines;
        made
    });
    let mut keys = Key::of_filters(figures, |index| figures.filters[index].jerk_root().is_some());
    keys.extend(Key::of_events(&figures.events));
    Sheet {
        panel,
        across: 3,
        name: String::new(),
        keys,
        panels: panels.collect(),
    }
}

/// True acceleration and the error of its estimate, on axes of powers of ten.
pub(super) fn learning(learning: &Learning) -> Sheet {
    let kinds = [("true acceleration", INK), ("error of its estimate", VERMILION)];
    let [from, to] = learning.span_s.map(f64::log10);
    let logarithm: Vec<f64> = learning.t.iter().map(|t| t.log10()).collect();
    let panels = learning.axes.iter().map(|axis| {
        let [low, high] = axis.range.map(f64::log10);
        let y = Axis::powers(low..high, &format!("acceleration, {}", axis.name), "m/s²", 12.0);
        let mut panel = Panel::new(Axis::powers(from..to, "time", "s", 8.0), y);
        let curves = [&axis.truth, &axis.error].into_iter().zip(kinds);
        panel.lines = curves
            .map(|(values, (_, colour))| Line {
                points: logarithms(&logarithm, values),
                colour,
                width: 1.4,
                dash: None,
            })
            .collect();
        panel
    });
    Sheet {
        panel: (300, 280),
        across: learning.axes.len().max(1),
        name: String::new(),
        keys: kinds.map(|(name, colour)| Key::line(name, colour, None)).into(),
        panels: panels.collect(),
    }
}
