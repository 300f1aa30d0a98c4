//! Parameters that differ from run to run.

use std::fmt;
use std::str::FromStr;

use numerics::{Source, stream};
use rand::RngExt;
use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, Normal};

use crate::arguments::{Assignment, as_text};

/// How the values of a varied parameter are spread.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Distribution {
    /// Every value between a low and a high end is as likely as any other.
    Uniform(f64, f64),
    /// Every factor between a low and a high end is as likely as any other.
    LogUniform(f64, f64),
    /// Gaussian: mean and sigma.
    Normal(f64, f64),
    /// The logarithm is Gaussian: median, and the factor that is one sigma away from it.
    LogNormal(f64, f64),
    /// Each of these values is as likely as any other.
    Choice(Vec<f64>),
}

/// Sigmas out to which a parameter must be able to take the values of a distribution without ends: one draw in 16,000 lies
/// beyond, and a parameter that refuses it fails that run by name.
const CHECKED_SIGMAS: f64 = 4.0;

/// The forms of a distribution, and what each draws.
pub const DISTRIBUTIONS: [[&str; 2]; 5] = [
    [
        "uniform:LOW:HIGH",
        "every value between the ends is as likely as any other",
    ],
    [
        "loguniform:LOW:HIGH",
        "every factor between the ends is as likely as any other",
    ],
    ["normal:MEAN:SIGMA", "Gaussian"],
    [
        "lognormal:MEDIAN:FACTOR",
        "the logarithm is Gaussian; FACTOR is one sigma away from the median",
    ],
    ["choice:VALUE:VALUE:...", "each of the values is as likely as any other"],
];

/// The forms, for messages.
fn forms() -> String {
    DISTRIBUTIONS.map(|[form, _]| form).join(", ")
}

impl Distribution {
    /// The value below which a share `u` of all values lies, 0 <= u < 1.
    pub fn quantile(&self, u: f64) -> f64 {
        match self {
            Self::Uniform(low, high) => low + u * (high - low),
            Self::LogUniform(low, high) => low * (high / low).powf(u),
            Self::Normal(mean, sigma) => mean + sigma * standard_normal(u),
            Self::LogNormal(median, factor) => median * factor.powf(standard_normal(u)),
            Self::Choice(values) => {
                let place = (u * values.len() as f64) as usize;
                values.get(place).or(values.last()).copied().unwrap_or(f64::NAN)
            }
        }
    }

    /// Values that a parameter must be able to take: the ends, all of a choice, four sigma to both sides.
    pub fn extremes(&self) -> Vec<f64> {
        match self {
            Self::Uniform(low, high) | Self::LogUniform(low, high) => vec![*low, *high],
            Self::Normal(mean, sigma) => vec![mean - CHECKED_SIGMAS * sigma, mean + CHECKED_SIGMAS * sigma],
            Self::LogNormal(median, factor) => {
                let far = factor.powf(CHECKED_SIGMAS);
                vec![median / far, median * far]
            }
            Self::Choice(values) => values.clone(),
        }
    }
}

/// The value below which a share `u` of a standard Gaussian lies; 0 counts as the middle of the first of the 2^53 steps that a
/// draw has, so that the value is finite.
fn standard_normal(u: f64) -> f64 {
    Normal::standard().inverse_cdf(u.max(f64::EPSILON / 4.0))
}

impl fmt::Display for Distribution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, numbers) = match self {
            Self::Uniform(low, high) => ("uniform", vec![*low, *high]),
            Self::LogUniform(low, high) => ("loguniform", vec![*low, *high]),
            Self::Normal(mean, sigma) => ("normal", vec![*mean, *sigma]),
            Self::LogNormal(median, factor) => ("lognormal", vec![*median, *factor]),
            Self::Choice(values) => ("choice", values.clone()),
        };
        f.write_str(name)?;
        numbers.iter().try_for_each(|number| write!(f, ":{number}"))
    }
}

impl FromStr for Distribution {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, rest) = text.split_once(':').unwrap_or((text, ""));
        if !["uniform", "loguniform", "normal", "lognormal", "choice"].contains(&name) {
            return Err(format!("there is no distribution '{name}'; there are: {}", forms()));
        }
        let number = |text: &str| {
            let value = text.parse::<f64>().ok().filter(|v| v.is_finite());
            value.ok_or_else(|| format!("'{text}' is no finite number"))
        };
        let parts: Vec<&str> = if rest.is_empty() {
            Vec::new()
        } else {
            rest.split(':').collect()
        };
        if name == "choice" {
            let values: Vec<f64> = parts.iter().map(|part| number(part)).collect::<Result<_, _>>()?;
            return if values.is_empty() {
                Err(format!("'{text}' chooses from nothing; give choice:VALUE:VALUE:..."))
            } else {
                Ok(Self::Choice(values))
            };
        }
        let [first, second] = parts[..] else {
            return Err(format!("'{text}' has not two numbers; there are: {}", forms()));
        };
        let (first, second) = (number(first)?, number(second)?);
        match name {
            "uniform" | "loguniform" if first >= second => Err(format!(
                "the range {first} to {second} is empty; give the smaller number first"
            )),
            "loguniform" if first <= 0.0 => Err(format!("a logarithmic range starts above 0, not at {first}")),
            "uniform" => Ok(Self::Uniform(first, second)),
            "loguniform" => Ok(Self::LogUniform(first, second)),
            "normal" if second > 0.0 => Ok(Self::Normal(first, second)),
            "normal" => Err(format!("a sigma is above 0, not {second}")),
            _ if first > 0.0 && second > 1.0 => Ok(Self::LogNormal(first, second)),
            _ => Err(format!(
                "lognormal:{first}:{second} needs a median above 0 and a factor above 1, that of one sigma"
            )),
        }
    }
}

as_text!(Distribution);

/// `MODEL.VARIABLE=DISTRIBUTION:LOW:HIGH`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Variation {
    /// `fmu-truth`, `fmu-nav` or the label of a foreign filter.
    pub model: String,
    /// Name of a Real parameter of that FMU.
    pub variable: String,
    /// Where its values come from.
    pub distribution: Distribution,
}

impl FromStr for Variation {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let Assignment { model, variable, value } = text.parse().map_err(|_| {
            format!("'{text}' is not MODEL.VARIABLE=uniform:LOW:HIGH, as in fmu-truth.vent.scale=uniform:0.5:2")
        })?;
        Ok(Self {
            model,
            variable,
            distribution: value.parse()?,
        })
    }
}

impl fmt::Display for Variation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}={}", self.model, self.variable, self.distribution)
    }
}

as_text!(Variation);

/// A start value that is drawn anew in each run.
#[derive(Debug, Clone, PartialEq)]
pub struct Varied {
    /// Contract name of the parameter.
    pub name: String,
    /// Where its values come from.
    pub distribution: Distribution,
    /// Number of the variation in the study: its place in the stream of the run.
    pub draw: usize,
}

impl Varied {
    /// The value in one run. It depends on study, run and place alone, so every filter of a run gets the same.
    pub fn value(&self, seed: i32, run: u32) -> f64 {
        let mut generator = stream(seed.unsigned_abs().into(), run.into(), Source::Variation);
        for _ in 0..self.draw {
            generator.random::<f64>();
        }
        self.distribution.quantile(generator.random())
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_taken_apart_and_written_back() {
        let text = "fmu-nav.off_nominal=uniform:0.1:10";
        let v: Variation = text.parse().unwrap();
        assert_eq!(v.distribution, Distribution::Uniform(0.1, 10.0));
        assert_eq!((v.model.as_str(), v.variable.as_str()), ("fmu-nav", "off_nominal"));
        assert_eq!(v.to_string(), text);
        let log: Variation = "other.k=loguniform:1e-3:1e3".parse().unwrap();
        assert_eq!(log.distribution, Distribution::LogUniform(1e-3, 1e3));
        for (bad, says) in [
            ("k=uniform:0:1", "MODEL.VARIABLE"),
            ("m.k", "MODEL.VARIABLE"),
            ("m.k=uniform:0", "LOW:HIGH"),
            ("m.k=triangle:0:1", "'triangle'"),
            ("m.k=normal:0:0", "above 0"),
            ("m.k=lognormal:1:1", "factor above 1"),
            ("m.k=choice", "nothing"),
            ("m.k=choice:1:x", "'x'"),
            ("m.k=uniform:0:1:2", "LOW:HIGH"),
            ("m.k=uniform:1:1", "empty"),
            ("m.k=uniform:2:1", "2 to 1"),
            ("m.k=uniform:a:1", "'a'"),
            ("m.k=uniform:0:inf", "'inf'"),
            ("m.k=loguniform:0:1", "above 0"),
        ] {
            let error = bad.parse::<Variation>().unwrap_err();
            assert!(error.contains(says), "{bad}: {error}");
        }
    }

    /// Shares of a standard Gaussian from a printed table; the first draw of all is finite.
    #[test]
    fn quantiles_of_every_kind() {
        let normal: Distribution = "normal:1:2".parse().unwrap();
        for (share, z) in [(0.5, 0.0), (0.841_344_746, 1.0), (0.022_750_132, -2.0)] {
            assert!((normal.quantile(share) - (1.0 + 2.0 * z)).abs() < 1e-7, "{share}");
        }
        assert!(normal.quantile(0.0).is_finite());
        let log: Distribution = "lognormal:5:3".parse().unwrap();
        assert!((log.quantile(0.841_344_746) - 15.0).abs() < 1e-6);
        assert!((log.extremes()[1] - 5.0 * 81.0).abs() < 1e-9);
        let choice: Distribution = "choice:1:4:9".parse().unwrap();
        assert_eq!(
            [0.0, 0.3, 0.34, 0.67, 0.999].map(|u| choice.quantile(u)),
            [1.0, 1.0, 4.0, 9.0, 9.0]
        );
        for text in ["normal:1:2", "lognormal:5:3", "choice:1:4:9"] {
            assert_eq!(text.parse::<Distribution>().unwrap().to_string(), text);
        }
    }

    /// Mean and spread of many draws against those of the distributions, within 4 sigma of 4000 runs.
    #[test]
    fn values_are_spread_as_told_and_the_same_when_asked_again() {
        let moments = |distribution: Distribution, of: fn(f64) -> f64| {
            let varied = |draw| Varied {
                name: "k".to_owned(),
                distribution: distribution.clone(),
                draw,
            };
            let (first, second) = (varied(0), varied(1));
            let values: Vec<f64> = (0..4000).map(|run| of(first.value(7, run))).collect();
            assert_eq!(first.value(7, 3), first.value(7, 3));
            assert!((0..4000).all(|run| first.value(7, run) != second.value(7, run)));
            assert_ne!(first.value(7, 3), first.value(8, 3));
            let mean = values.iter().sum::<f64>() / 4000.0;
            (
                mean,
                (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 4000.0).sqrt(),
            )
        };
        // Uniform on 0.1 to 10: mean 5.05, sigma 9.9 / sqrt(12) = 2.858, known to 0.045 and 0.02.
        let (mean, sigma) = moments(Distribution::Uniform(0.1, 10.0), |v| v);
        assert!(
            (mean - 5.05).abs() < 0.18 && (sigma - 2.858).abs() < 0.08,
            "{mean} {sigma}"
        );
        // Its decades: uniform on -3 to 3.
        let (mean, sigma) = moments(Distribution::LogUniform(1e-3, 1e3), f64::log10);
        assert!(mean.abs() < 0.11 && (sigma - 1.732).abs() < 0.05, "{mean} {sigma}");
        // Sigma over root N is 0.032 and over root 2 N 0.022 of a standard Gaussian.
        let (mean, sigma) = moments(Distribution::Normal(3.0, 2.0), |v| (v - 3.0) / 2.0);
        assert!(mean.abs() < 0.064 * 2.0 && (sigma - 1.0).abs() < 0.09, "{mean} {sigma}");
        let (mean, sigma) = moments(Distribution::LogNormal(8.0, 2.0), f64::log2);
        assert!(
            (mean - 3.0).abs() < 0.13 && (sigma - 1.0).abs() < 0.09,
            "{mean} {sigma}"
        );
    }
}
