//! Which parameters of a filter are searched, and over which range.

use std::str::FromStr;

use cosim::Value;
use fmi2_import::ModelDescription;
use interface::annotation::Set;
use study::{Assignment, Model, Participant, check_real_range};

use crate::HarnessError;

/// Share of a range, counted in decades, that is called its edge.
const EDGE: f64 = 0.05;
/// Significant digits of a searched value: finer ones would mean nothing, and tables show them all.
const DIGITS: i32 = 4;

/// `MODEL.VARIABLE=LOW:HIGH`, what a search may vary.
#[derive(Debug, Clone, PartialEq)]
pub struct Range {
    /// `fmu-nav` or the label of a foreign filter.
    pub model: String,
    /// Name of a Real parameter of that FMU.
    pub variable: String,
    /// Smallest value; not checked here.
    pub low: f64,
    /// Largest value.
    pub high: f64,
}

impl FromStr for Range {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("'{text}' is not MODEL.VARIABLE=LOW:HIGH, as in fmu-nav.snc.q=1e-6:1e-3");
        let Assignment { model, variable, value } = text.parse().map_err(|_| wrong())?;
        let number = |text: &str| text.trim().parse().map_err(|_| wrong());
        let (low, high) = value.split_once(':').ok_or_else(wrong)?;
        Ok(Self {
            model,
            variable,
            low: number(low)?,
            high: number(high)?,
        })
    }
}

/// One parameter of a filter and the range it is searched over, on a logarithmic scale.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Name of the parameter in its FMU.
    pub variable: String,
    /// Smallest value.
    pub low: f64,
    /// Largest value.
    pub high: f64,
    /// The value it starts from; `None` where that is not positive, as the -1 of "the mission's own".
    pub start: Option<f64>,
}

impl Axis {
    /// The value at this fraction of the range, in four significant digits.
    pub fn value(&self, fraction: f64) -> f64 {
        let value = self.low * (self.high / self.low).powf(fraction);
        rounded(value).clamp(self.low, self.high)
    }

    /// Where the starting value lies in the range, 0 to 1; outside counts as the nearer end.
    pub fn start_fraction(&self) -> Option<f64> {
        self.start.map(|value| self.fraction(value).clamp(0.0, 1.0))
    }

    /// `low` or `high` when the value lies in the outermost twentieth of the range, or outside.
    pub fn edge(&self, value: f64) -> Option<&'static str> {
        let fraction = self.fraction(value);
        if fraction < EDGE {
            Some("low")
        } else if fraction > 1.0 - EDGE {
            Some("high")
        } else {
            None
        }
    }

    fn fraction(&self, value: f64) -> f64 {
        (value / self.low).ln() / (self.high / self.low).ln()
    }
}

fn rounded(value: f64) -> f64 {
    // Through text, so that the number is the one nearest to its printed digits.
    format!("{value:.*e}", (DIGITS - 1) as usize).parse().unwrap_or(value)
}

/// The parameters of one filter that are searched: those its FMU proposes, as far as they have an effect with the settings that the
/// filter starts from, then those that `--range` adds.
///
/// * `filter`: the filter of fmu-nav; its parameters begin with its name. `None` for a foreign FMU, which is one filter.
/// * `participant`: the filter as it would run without a search, for the values it starts from; what it varies from run
///   to run is not searched, as those values would replace the candidate's.
/// * `fixed`: what `--set` says; that is not searched.
///
/// # Errors
/// [`HarnessError::SearchRange`], [`HarnessError::SetAndSearched`], [`HarnessError::VariedAndSearched`], or those of what
/// is no Real parameter or cannot take an end of its range.
pub fn axes(
    model: &Model,
    filter: Option<&str>,
    participant: &Participant,
    ranges: &[Range],
    fixed: &[Assignment],
) -> Result<Vec<Axis>, HarnessError> {
    let description = model.description();
    let own = |variable: &str| filter.is_none_or(|f| concerns(description, f, variable));
    let is_set = |variable: &str| fixed.iter().any(|a| a.model == model.name && a.variable == variable);
    let asked = || ranges.iter().filter(|r| r.model == model.name && own(&r.variable));
    if let Some(both) = asked().find(|r| is_set(&r.variable)) {
        return Err(HarnessError::SetAndSearched {
            model: model.name.clone(),
            variable: both.variable.clone(),
        });
    }
    if let Some(both) = asked().find(|r| participant.varies(&r.variable)) {
        return Err(HarnessError::VariedAndSearched {
            model: model.name.clone(),
            variable: both.variable.clone(),
        });
    }
    let taken = |variable: &str| is_set(variable) || participant.varies(variable);
    let proposed = model
        .filters
        .searches
        .iter()
        .filter(|s| own(&s.variable) && !taken(&s.variable))
        .filter(|s| {
            let starts_so = |set: &Set| is_start(description, set, participant.start(&set.variable));
            s.only_with.as_ref().is_none_or(starts_so)
        });
    let mut chosen: Vec<(&str, f64, f64)> = proposed.map(|s| (s.variable.as_str(), s.low, s.high)).collect();
    for range in asked() {
        match chosen.iter_mut().find(|(variable, ..)| *variable == range.variable) {
            Some(there) => (there.1, there.2) = (range.low, range.high),
            None => chosen.push((&range.variable, range.low, range.high)),
        }
    }
    chosen
        .into_iter()
        .map(|(variable, low, high)| {
            check(model, variable, low, high)?;
            Ok(Axis {
                variable: variable.to_owned(),
                low,
                high,
                start: start(description, participant, variable),
            })
        })
        .collect()
}

/// Whether a parameter of fmu-nav acts on this filter: one under its own prefix does, and so does one under no filter's.
pub fn concerns(nav: &ModelDescription, filter: &str, variable: &str) -> bool {
    let prefix = variable.split('.').next().unwrap_or(variable);
    prefix == filter || !nav.items("filter").iter().any(|i| i.name == prefix)
}

/// Whether a filter starts with a variable at this value; not so where the FMU has no such variable or value.
///
/// * `given`: what it starts with where that is not the FMU's own start value.
fn is_start(description: &ModelDescription, set: &Set, given: Option<&Value>) -> bool {
    description.get(&set.variable).is_some_and(|variable| {
        let start = given.cloned().or_else(|| variable.start());
        variable.parse_value(&set.value).is_ok_and(|value| start == Some(value))
    })
}

fn check(model: &Model, name: &str, low: f64, high: f64) -> Result<(), HarnessError> {
    if !(low > 0.0 && low < high && high.is_finite()) {
        return Err(HarnessError::SearchRange {
            model: model.name.clone(),
            variable: name.to_owned(),
            low,
            high,
        });
    }
    Ok(check_real_range(model, name, &[low, high])?)
}

fn start(description: &ModelDescription, participant: &Participant, name: &str) -> Option<f64> {
    let value = participant
        .start(name)
        .cloned()
        .or_else(|| description.get(name)?.start())?;
    match value {
        Value::Real(value) if value > 0.0 => Some(value),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use interface::annotation::{Filters, TOOL};

    fn axis(start: Option<f64>) -> Axis {
        Axis {
            variable: "q".to_owned(),
            low: 1e-6,
            high: 1e-2,
            start,
        }
    }

    #[test]
    fn ranges_are_two_numbers() {
        let range: Range = "fmu-nav.snc.q=1e-6:1e-3".parse().unwrap();
        assert_eq!((range.model.as_str(), range.variable.as_str()), ("fmu-nav", "snc.q"));
        assert!((range.low / 1e-6 - 1.0).abs() < 1e-15 && (range.high / 1e-3 - 1.0).abs() < 1e-15);
        for bad in [
            "",
            "fmu-nav.snc.q",
            "fmu-nav.snc.q=1",
            "fmu-nav.snc.q=1:",
            "fmu-nav.snc.q=a:2",
            "snc=1:2",
        ] {
            assert!(bad.parse::<Range>().unwrap_err().contains("LOW:HIGH"), "{bad}");
        }
    }

    #[test]
    fn a_search_is_made_where_its_parameter_has_an_effect() {
        let file = crate::pack::home_workspace().join("modelDescription/fmu-nav/modelDescription.xml");
        let nav = ModelDescription::parse(&std::fs::read(&file).unwrap(), &file).unwrap();
        let set = |variable: &str, value: &str| Set {
            variable: variable.to_owned(),
            value: value.to_owned(),
        };
        let regression = set("constrained_q.law", "regression");
        let number = nav
            .get(&regression.variable)
            .unwrap()
            .parse_value(&regression.value)
            .unwrap();
        assert!(
            !is_start(&nav, &regression, None),
            "it is by likelihood unless told otherwise"
        );
        assert!(is_start(&nav, &regression, Some(&number)));
        assert!(is_start(&nav, &set("constrained_q.law", "likelihood"), None));
        for (variable, value) in [("constrained_q.law", "chance"), ("constrained_q.lore", "regression")] {
            assert!(
                !is_start(&nav, &set(variable, value), Some(&number)),
                "{variable}={value}"
            );
        }
        let told = Filters::read(nav.annotations(TOOL)).unwrap();
        let own = told
            .searches
            .iter()
            .filter(|s| s.variable.starts_with("constrained_q."));
        assert!(own.clone().count() > 0 && own.clone().all(|s| s.only_with.as_ref() == Some(&regression)));
    }

    #[test]
    fn the_scale_is_logarithmic_and_the_digits_few() {
        let a = axis(None);
        // A quarter of four decades is one, an eighth the root of ten.
        for (fraction, value) in [(0.0, 1e-6), (0.25, 1e-5), (0.125, 3.162e-6), (1.0, 1e-2)] {
            assert!(
                (a.value(fraction) / value - 1.0).abs() < 1e-14,
                "{fraction}: {}",
                a.value(fraction)
            );
        }
        // Rounding does not lead out of the range.
        let odd = Axis {
            low: 1.23456e-3,
            high: 9.87654e-3,
            ..axis(None)
        };
        assert!(odd.value(0.0) >= odd.low && odd.value(1.0) <= odd.high);
    }

    #[test]
    fn a_start_beyond_the_range_counts_as_its_end() {
        for (start, fraction) in [(1e-5, 0.25), (1.0, 1.0), (1e-9, 0.0)] {
            assert!((axis(Some(start)).start_fraction().unwrap() - fraction).abs() < 1e-12);
        }
        assert_eq!(axis(None).start_fraction(), None);
    }

    #[test]
    fn edges_are_the_outermost_twentieths() {
        let a = axis(None);
        // 0.05 of four decades is a factor 1.585.
        let told = [1e-6, 1.5e-6, 1.7e-6, 6e-3, 6.5e-3, 1.0].map(|value| a.edge(value));
        assert_eq!(told, [Some("low"), Some("low"), None, None, Some("high"), Some("high")]);
    }
}
