//! Figures that hold filters, runs, phases or candidates beside each other, and the path.

use plotters::style::Color;

use super::axis::Axis;
use super::sheet::{
    Area, BLUE, BOTTOM, Dot, INK, Key, LEFT, Label, Line, Mark, ORANGE, Panel, RIGHT, SKY, SOFT, Sheet, TITLE, TOP,
    VERMILION, colour, dash, range,
};
use crate::figures::{Figures, FilterFigures, Forest};
use crate::kept::Path;
use crate::matrix::Matrix;
use crate::number::short;
use crate::search::{Search, Try};

/// Room for names on the left.
fn room<'a>(names: impl Iterator<Item = &'a str>) -> u32 {
    24 + 7 * names.map(|name| name.chars().count()).max().unwrap_or(0) as u32
}

fn signed(value: Option<f64>) -> String {
    short(value).replace('-', "−")
}

/// Differences of every pair of filters.
///
/// * `quantity`: index into the errors of the figures.
/// * returns: `None` where no pair has a result.
pub(super) fn pairs(figures: &Figures, quantity: usize) -> Option<Sheet> {
    let [name, unit] = figures.errors[quantity];
    let rows: Vec<&Forest> = figures.forest.iter().filter(|f| f.quantity == name).collect();
    let within = figures.linear_within[quantity];
    let place = |v: f64| within.map_or(v, |w| (v / w).asinh());
    let ends = rows
        .iter()
        .flat_map(|f| [f.low.unwrap_or(f.mean), f.high.unwrap_or(f.mean), 0.0]);
    let x = range(ends.map(place));
    let label = format!("difference of {name} RMSE, 95 % interval");
    let x = match within {
        Some(within) => Axis::both_ways(x, within, &label, unit),
        None => Axis::linear(x, &label, unit, 7.0),
    };
    let names: Vec<String> = rows.iter().map(|f| format!("{} − {}", f.filter, f.reference)).collect();
    let mut panel = Panel::new(x, Axis::names(names.iter().cloned(), true));
    let (right, last) = (panel.x.range.end, names.len() as f64 - 0.5);
    panel.sides = (room(names.iter().map(String::as_str)), 200);
    let line = |points: Vec<(f64, f64)>, colour, width| Line {
        points,
        colour,
        width,
        dash: None,
    };
    panel.lines.push(line(vec![(0.0, -0.5), (0.0, last)], INK, 1.0));
    for (i, row) in rows.iter().enumerate() {
        let index = figures.filters.iter().position(|f| f.name == row.filter);
        let (y, colour) = (i as f64, colour(index.unwrap_or(0)));
        let mut told = signed(Some(row.mean));
        if let Some((low, high)) = Option::zip(row.low, row.high) {
            told.push_str(&format!(" ({}, {})", signed(Some(low)), signed(Some(high))));
            panel
                .lines
                .push(line(vec![(place(low), y), (place(high), y)], colour, 2.0));
            for end in [place(low), place(high)] {
                panel
                    .lines
                    .push(line(vec![(end, y - 0.16), (end, y + 0.16)], colour, 2.0));
            }
        }
        panel.dots.push(Dot {
            at: (place(row.mean), y),
            radius: 4.5,
            colour,
            ring: false,
        });
        panel.texts.push(Label {
            at: (right, y),
            text: told,
            bold: false,
            beside: true,
        });
    }
    (!rows.is_empty()).then(|| Sheet {
        panel: (900, TOP + BOTTOM + 30 * rows.len() as u32),
        across: 1,
        name: String::new(),
        keys: Vec::new(),
        panels: vec![panel],
    })
}

/// Share of the runs below each error.
///
/// * returns: `None` where no run has a result.
pub(super) fn runs(figures: &Figures, quantity: usize) -> Option<Sheet> {
    let [name, unit] = figures.errors[quantity];
    let positive = |filter: &FilterFigures| filter.sorted[quantity].iter().copied().filter(|v| *v > 0.0).collect();
    let sorted: Vec<Vec<f64>> = figures.filters.iter().map(positive).collect();
    let all = || sorted.iter().flatten().copied();
    let (low, high) = (all().min_by(f64::total_cmp)?, all().max_by(f64::total_cmp)?);
    let powers = high > 5.0 * low;
    let place = |v: f64| if powers { v.log10() } else { v };
    let x = range(all().map(place));
    let lines = figures
        .filters
        .iter()
        .zip(&sorted)
        .enumerate()
        .map(|(index, (filter, sorted))| {
            let share = |n: usize| n as f64 / f64::from(filter.runs);
            let steps = sorted.iter().enumerate();
            let steps = steps.flat_map(|(i, v)| [(place(*v), share(i)), (place(*v), share(i + 1))]);
            let mut points: Vec<_> = steps.collect();
            points.extend(points.last().map(|last| (x.end, last.1)));
            Line {
                points,
                colour: colour(index),
                width: 2.0,
                dash: dash(index),
            }
        });
    let lines = lines.collect();
    let label = format!("{name} RMSE of a run");
    let x = match powers {
        true => Axis::powers(x, &label, unit, 12.0),
        false => Axis::linear(x, &label, unit, 8.0),
    };
    let mut panel = Panel::new(x, Axis::linear(0.0..1.02, "share of runs", "1", 5.0));
    panel.lines = lines;
    Some(Sheet {
        panel: (900, 400),
        across: 1,
        name: String::new(),
        keys: Key::of_filters(figures, |index| !figures.filters[index].sorted[quantity].is_empty()),
        panels: vec![panel],
    })
}

/// Errors by filter and phase or case, the darker the larger beside the best.
pub(super) fn matrix(matrix: &Matrix, name: &str) -> Sheet {
    let columns = matrix.columns.iter().map(String::as_str);
    let (left, cell) = (room(matrix.rows.iter().map(String::as_str)), room(columns).max(84));
    let mut panel = Panel::new(
        Axis::names(matrix.columns.iter().cloned(), false),
        Axis::names(matrix.rows.iter().cloned(), true),
    );
    for (r, row) in matrix.values.iter().enumerate() {
        for (c, value) in row.iter().enumerate() {
            let (x, y) = (c as f64, r as f64);
            panel.areas.push(Area {
                x: x - 0.49..x + 0.49,
                y: y - 0.46..y + 0.46,
                colour: VERMILION.mix(0.08 + 0.62 * matrix.shades[r][c]),
            });
            panel.texts.push(Label {
                at: (x, y),
                text: signed(*value),
                bold: matrix.best[r][c],
                beside: false,
            });
        }
    }
    panel.sides = (left, RIGHT);
    panel.table = true;
    let (across, down) = (matrix.columns.len() as u32, matrix.rows.len() as u32);
    let width = (left + RIGHT + cell * across).max(left + 7 * name.chars().count() as u32 + RIGHT);
    Sheet {
        panel: (width, TOP + 20 + 28 * down + 8),
        across: 1,
        name: name.to_owned(),
        keys: Vec::new(),
        panels: vec![panel],
    }
}

/// Candidates of a search over each parameter.
pub(super) fn search(search: &Search) -> Sheet {
    let found = || {
        search
            .tries
            .iter()
            .filter_map(|t| Some((t, t.error.filter(|e| *e > 0.0)?)))
    };
    let y = range(found().map(|(_, error)| error.log10()));
    let [objective, unit] = &search.objective;
    let given = search.given.and_then(|index| search.tries.get(index)?.error);
    // Four stand two by two.
    let across = match search.parameters.len() {
        0 | 1 => 1,
        2 | 4 => 2,
        _ => 3,
    };
    let width = [600, 450, 300][across - 1];
    let panels = search.parameters.iter().enumerate().map(|(i, parameter)| {
        let (low, high) = (parameter.low.log10(), parameter.high.log10());
        let twentieth = 0.05 * (high - low);
        let room = 0.6 * twentieth;
        let x = Axis::powers(low - room..high + room, &parameter.name, "", f64::from(width) / 60.0);
        let mut panel = Panel::new(x, Axis::powers(y.clone(), &format!("{objective} RMSE"), unit, 12.0));
        panel.areas = [low..low + twentieth, high - twentieth..high]
            .map(|x| Area {
                x,
                y: y.clone(),
                colour: EDGE.1.mix(0.3),
            })
            .into();
        panel.lines.extend(given.map(|given| Line {
            points: vec![(low - room, given.log10()), (high + room, given.log10())],
            colour: SOFT,
            width: 1.0,
            dash: Some((4, 3)),
        }));
        let dot = |(at, error): (&Try, f64)| {
            let best = search.best.and_then(|best| search.tries.get(best));
            Some(Dot {
                at: (at.values.get(i)?.log10(), error.log10()),
                radius: if best.is_some_and(|best| std::ptr::eq(best, at)) {
                    6.5
                } else {
                    3.0
                },
                colour: if at.feasible { BLUE } else { SOFT },
                ring: !at.feasible,
            })
        };
        panel.dots = found().filter_map(dot).collect();
        panel
    });
    let marked = |name: &str, colour: plotters::style::RGBColor, mark| Key {
        name: name.to_owned(),
        colour: colour.to_rgba(),
        mark,
    };
    Sheet {
        panel: (width, 270),
        across,
        name: search.filter.clone(),
        keys: vec![
            marked("candidate (large: best)", BLUE, Mark::Dot),
            marked("runs lost or NEES outside", SOFT, Mark::Ring),
            Key::line("as given", SOFT, Some((4, 3))),
            Key::area(EDGE.0, EDGE.1.mix(0.3)),
        ],
        panels: panels.collect(),
    }
}

/// Where a best candidate says that the range was too small.
const EDGE: (&str, plotters::style::RGBColor) = ("edges of the search", ORANGE);

/// True path of run 0, in two planes, and where two bodies pull the orbit, too.
pub(super) fn path(path: &Path, figures: &Figures) -> Sheet {
    let size = (450, 380);
    let about: Vec<Vec<Option<f64>>> = match path.body {
        Some((_, center)) => {
            let from_body = |(list, c): (&Vec<Option<f64>>, f64)| list.iter().map(|v| v.map(|v| v - c)).collect();
            path.chaser.iter().zip(center).map(from_body).collect()
        }
        None => Vec::new(),
    };
    let axes: Vec<&str> = path.axes.iter().map(String::as_str).collect();
    let mut panels: Vec<Panel> = [(1, 0), (1, 2)]
        .map(|plane| view(&path.relative, &axes, plane, Some((&path.t, figures)), size))
        .into();
    if let (Some((body, _)), false) = (path.body, about.is_empty()) {
        panels.extend([(0, 2), (1, 2)].map(|plane| {
            let mut orbit = view(&about, &["x", "y", "z"], plane, None, size);
            orbit.title = format!("orbit about the {body}");
            orbit
        }));
    }
    let mut keys = vec![
        Key::line("true path of run 0", INK, None),
        Key {
            name: "begin".to_owned(),
            colour: INK.to_rgba(),
            mark: Mark::Ring,
        },
        Key {
            name: "end".to_owned(),
            colour: INK.to_rgba(),
            mark: Mark::Dot,
        },
    ];
    let kinds = [("burn", "burns", ORANGE), ("vent", "vents", SKY)];
    let there = |kind: &str| figures.events.iter().any(|e| e.kind == kind);
    keys.extend(
        kinds
            .into_iter()
            .filter(|k| there(k.0))
            .map(|(_, name, colour)| Key::line(name, colour, None)),
    );
    Sheet {
        panel: size,
        across: 2,
        name: String::new(),
        keys,
        panels,
    }
}

/// * `values`: by axis.
/// * `during`: times of the points, and what happens at them; `None` for an orbit about a body at zero.
fn view(
    values: &[Vec<Option<f64>>],
    axes: &[&str],
    (a, b): (usize, usize),
    during: Option<(&[Option<f64>], &Figures)>,
    size: (u32, u32),
) -> Panel {
    let place = |n: usize| Option::zip(values[a][n], values[b][n]);
    let numbered = (0..values[a].len()).filter_map(|n| Some((n, place(n)?)));
    let numbered: Vec<(usize, (f64, f64))> = numbered.collect();
    let zero = during.is_none().then_some(0.0);
    let mut x = range(numbered.iter().map(|p| p.1.0).chain(zero));
    let mut y = range(numbered.iter().map(|p| p.1.1).chain(zero));
    // The same metres both ways, where that leaves something to see.
    let (width, height) = (size.0 - LEFT - RIGHT, size.1 - TOP - TITLE - BOTTOM);
    let per_unit = (
        (x.end - x.start) / f64::from(width),
        (y.end - y.start) / f64::from(height),
    );
    let ratio = per_unit.0 / per_unit.1;
    let about = |range: &std::ops::Range<f64>, factor: f64| {
        let (middle, half) = (
            0.5 * (range.start + range.end),
            0.5 * factor * (range.end - range.start),
        );
        middle - half..middle + half
    };
    if (1.0..6.0).contains(&ratio) {
        y = about(&y, ratio);
    } else if (1.0 / 6.0..1.0).contains(&ratio) {
        x = about(&x, 1.0 / ratio);
    }
    let line = |points, colour, width| Line {
        points,
        colour,
        width,
        dash: None,
    };
    let dot = |at, radius, colour, ring| Dot {
        at,
        radius,
        colour,
        ring,
    };
    let mut panel = Panel::new(Axis::linear(x, axes[a], "m", 6.0), Axis::linear(y, axes[b], "m", 6.0));
    let ends = [numbered.first(), numbered.last()].map(|end| end.map(|p| p.1));
    panel.dots.extend(ends[0].map(|at| dot(at, 4.5, INK, true)));
    if let Some((t, figures)) = during {
        for event in &figures.events {
            let tint = if event.kind == "burn" { ORANGE } else { SKY };
            let inside = |n: &usize| t[*n].is_some_and(|t| (event.from_s..=event.to_s).contains(&t));
            let points = numbered.iter().filter(|(n, _)| inside(n)).map(|p| p.1);
            panel.lines.push(line(points.collect(), tint, 5.0));
            // What is shorter than the time between points has one of them.
            let away = |n: usize| t[n].map_or(f64::INFINITY, |t| (t - event.from_s).abs());
            let near = numbered.iter().min_by(|p, q| away(p.0).total_cmp(&away(q.0)));
            let burn = near.filter(|_| event.kind == "burn");
            panel.dots.extend(burn.map(|(_, at)| dot(*at, 7.0, tint, false)));
        }
    } else {
        panel.dots.push(dot((0.0, 0.0), 4.5, SOFT, false));
    }
    panel.dots.extend(ends[1].map(|at| dot(at, 4.5, INK, false)));
    panel
        .lines
        .push(line(numbered.into_iter().map(|p| p.1).collect(), INK, 1.5));
    panel
}
