//! Axes: their ranges, places and labels, as the page has them.

use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};

use crate::number::significant;

/// An axis with places of our own: the library's are not round where numbers are powers of ten.
#[derive(Clone)]
pub(super) struct Axis {
    /// From and to in the coordinate of what is drawn, which is the decimal logarithm on an axis of powers. Either way round.
    pub range: Range<f64>,
    /// Where a number stands, and the number.
    pub places: Vec<(f64, String)>,
    /// What it shows, with the unit.
    pub label: String,
}

impl Axis {
    /// * `most`: numbers that there is room for, about.
    pub fn linear(range: Range<f64>, name: &str, unit: &str, most: f64) -> Self {
        let exponent = exponent(range.start.abs().max(range.end.abs()));
        let number = |v: f64| (v, plain(v / 10.0_f64.powi(exponent)));
        let unit = match exponent {
            0 => unit.to_owned(),
            e => format!("10{} {unit}", superscript(e)),
        };
        Self {
            places: ticks(&range, most).into_iter().map(number).collect(),
            label: labelled(name, &unit),
            range,
        }
    }

    /// * `range`: decimal logarithms.
    pub fn powers(range: Range<f64>, name: &str, unit: &str, most: f64) -> Self {
        let number = |v: f64| (v, power(10.0_f64.powf(v)));
        Self {
            places: decades(&range, most).into_iter().map(number).collect(),
            label: labelled(name, unit),
            range,
        }
    }

    /// Linear within so much of zero and logarithmic beyond: what is drawn is the inverse hyperbolic sine.
    pub fn both_ways(range: Range<f64>, within: f64, name: &str, unit: &str) -> Self {
        let largest = within * range.start.abs().max(range.end.abs()).sinh();
        let powers = (2.0 * within).log10().floor() as i32..=largest.log10().ceil() as i32;
        let sizes = powers.flat_map(|k| [10.0_f64.powi(k), -10.0_f64.powi(k)]);
        let room = (range.end - range.start) / 12.0;
        let mut places: Vec<(f64, String)> = Vec::new();
        for v in std::iter::once(0.0).chain(sizes) {
            let at = (v / within).asinh();
            if range.contains(&at) && places.iter().all(|(other, _)| (other - at).abs() > room) {
                let sign = if v < 0.0 { "−" } else { "" };
                places.push((at, format!("{sign}{}", power(v.abs()))));
            }
        }
        Self {
            places,
            label: labelled(name, unit),
            range,
        }
    }

    /// Names at 0, 1, 2, ..., the first at the top or on the left.
    pub fn names(names: impl Iterator<Item = String>, upright: bool) -> Self {
        let places: Vec<_> = names.enumerate().map(|(i, name)| (i as f64, name)).collect();
        let (low, high) = (-0.5, places.len() as f64 - 0.5);
        Self {
            range: if upright { high..low } else { low..high },
            places,
            label: String::new(),
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
        self.places.iter().map(|(at, _)| *at).collect()
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

fn labelled(name: &str, unit: &str) -> String {
    if unit.is_empty() {
        name.to_owned()
    } else {
        format!("{name} [{unit}]")
    }
}

/// Exponent, a multiple of three, that leaves numbers of this size between 1 and 1000; none where they are short anyway.
fn exponent(size: f64) -> i32 {
    if size > 0.0 && !(1e-1..1e5).contains(&size) {
        3 * (size.log10() / 3.0 + 1e-9).floor() as i32
    } else {
        0
    }
}

fn superscript(exponent: i32) -> String {
    let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |c: char| c.to_digit(10).map_or('⁻', |d| digits[d as usize]);
    exponent.to_string().chars().map(raised).collect()
}

fn plain(value: f64) -> String {
    significant(value, 6).to_string().replace('-', "−")
}

/// A number of an axis of powers of ten.
fn power(value: f64) -> String {
    let exponent = significant(value, 3).log10();
    if value == 0.0 || exponent.abs() < 3.5 {
        return plain(significant(value, 3));
    }
    let whole = exponent.floor();
    let factor = significant(value / 10.0_f64.powf(whole), 3);
    let raised = format!("10{}", superscript(whole as i32));
    if (factor - 1.0).abs() < 1e-9 {
        raised
    } else {
        format!("{factor}·{raised}")
    }
}

/// So many places of a linear axis at most: multiples of one, two or five times a power of ten.
fn ticks(range: &Range<f64>, most: f64) -> Vec<f64> {
    let raw = (range.end - range.start) / most;
    let power = 10.0_f64.powf(raw.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|m| m * power);
    let step = steps.into_iter().find(|s| *s >= raw).unwrap_or(raw);
    let (first, last) = ((range.start / step).ceil() as i64, (range.end / step).floor() as i64);
    (first..=last).map(|k| k as f64 * step).collect()
}

/// Places of an axis of powers of ten: every so many powers, or the powers with more between them where there are few.
fn decades(range: &Range<f64>, most: f64) -> Vec<f64> {
    let span = range.end - range.start;
    let within: &[f64] = match span {
        s if s > 2.5 => &[1.0],
        s if s > 0.9 => &[1.0, 2.0, 5.0],
        s if s > 0.35 => &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0],
        _ => &[
            1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.8, 2.0, 2.2, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 6.0, 7.0, 8.0, 9.0,
        ],
    };
    let every = (span / most).ceil().max(1.0) as i64;
    let powers = range.start.floor() as i64..=range.end.floor() as i64;
    let places = powers
        .filter(|k| k % every == 0)
        .flat_map(|k| within.iter().map(move |m| k as f64 + m.log10()));
    places.filter(|v| range.contains(v)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(axis: &Axis) -> Vec<&str> {
        axis.places.iter().map(|(_, text)| text.as_str()).collect()
    }

    #[test]
    fn places_are_round_and_inside() {
        assert_eq!(ticks(&(-0.9..1.3), 5.0), [-0.5, 0.0, 0.5, 1.0]);
        assert_eq!(texts(&Axis::powers(-0.8..0.5, "", "", 20.0)), ["0.2", "0.5", "1", "2"]);
        assert_eq!(decades(&(-3.1..1.2), 20.0), [-3.0, -2.0, -1.0, 0.0, 1.0]);
        assert_eq!(decades(&(-10.1..0.2), 4.0), [-9.0, -6.0, -3.0, 0.0]);
    }

    #[test]
    fn small_numbers_move_their_power_into_the_unit() {
        let axis = Axis::linear(-2.5e-4..2.5e-4, "acceleration", "m/s²", 5.0);
        assert_eq!(axis.label, "acceleration [10⁻⁶ m/s²]");
        assert_eq!(texts(&axis), ["−200", "−100", "0", "100", "200"]);
        assert_eq!(Axis::linear(0.0..5680.0, "time", "s", 5.0).label, "time [s]");
    }

    #[test]
    fn differences_of_many_magnitudes_stand_apart() {
        let within: f64 = 0.5e-3;
        let axis = Axis::both_ways((-1.0_f64 / within).asinh()..(2.0_f64 / within).asinh(), within, "", "");
        let mut found = texts(&axis);
        found.sort_unstable();
        assert_eq!(
            found,
            ["0", "0.001", "0.01", "0.1", "1", "−0.001", "−0.01", "−0.1", "−1"]
        );
    }
}
