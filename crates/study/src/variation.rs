//! Parameters that differ from run to run.

use std::fmt;
use std::str::FromStr;

use numerics::{Source, stream};
use rand::RngExt;
use serde::{Deserialize, Serialize};

use crate::arguments::{Assignment, as_text};

/// How the values of a varied parameter are spread, low end and high end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Distribution {
    /// Every value is as likely as any other.
    Uniform(f64, f64),
    /// Every factor is as likely as any other.
    LogUniform(f64, f64),
}

impl Distribution {
    /// The value below which a share `u` of all values lies, 0 <= u < 1.
    pub fn quantile(&self, u: f64) -> f64 {
        match *self {
            Self::Uniform(low, high) => low + u * (high - low),
            Self::LogUniform(low, high) => low * (high / low).powf(u),
        }
    }

    /// Low end and high end.
    pub fn ends(&self) -> [f64; 2] {
        match *self {
            Self::Uniform(low, high) | Self::LogUniform(low, high) => [low, high],
        }
    }
}

impl fmt::Display for Distribution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = match self {
            Self::Uniform(..) => "uniform",
            Self::LogUniform(..) => "loguniform",
        };
        let [low, high] = self.ends();
        write!(f, "{name}:{low}:{high}")
    }
}

impl FromStr for Distribution {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts: Vec<&str> = text.split(':').collect();
        let [name, low, high] = parts[..] else {
            return Err(format!("'{text}' is not uniform:LOW:HIGH or loguniform:LOW:HIGH"));
        };
        let number = |text: &str| {
            let value = text.parse::<f64>().ok().filter(|v| v.is_finite());
            value.ok_or_else(|| format!("'{text}' is no finite number"))
        };
        let (low, high) = (number(low)?, number(high)?);
        if low >= high {
            return Err(format!(
                "the range {low} to {high} is empty; give the smaller number first"
            ));
        }
        match name {
            "uniform" => Ok(Self::Uniform(low, high)),
            "loguniform" if low > 0.0 => Ok(Self::LogUniform(low, high)),
            "loguniform" => Err(format!("a logarithmic range starts above 0, not at {low}")),
            _ => Err(format!(
                "there is no distribution '{name}'; there are: uniform, loguniform"
            )),
        }
    }
}

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
            ("m.k=uniform:0:1:2", "LOW:HIGH"),
            ("m.k=normal:0:1", "'normal'"),
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

    /// Mean and spread of many draws against those of the distributions, within 4 sigma of 4000 runs.
    #[test]
    fn values_are_spread_as_told_and_the_same_when_asked_again() {
        let moments = |distribution, of: fn(f64) -> f64| {
            let varied = |draw| Varied {
                name: "k".to_owned(),
                distribution,
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
    }
}
