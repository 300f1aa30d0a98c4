//! What a plan says about filters and variables, as text and taken apart.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// Preset that a bare filter name means.
pub const PAPER: &str = "paper";

/// `NAME[@PRESET]`, one of our filters with one of its parameter sets.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct FilterChoice {
    /// As given; stands in the `filter` column.
    pub label: String,
    /// Item of the `filter` enumeration.
    pub name: String,
    /// Name of the parameter set.
    pub preset: String,
}

impl FromStr for FilterChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, preset) = text.split_once('@').unwrap_or((text, PAPER));
        if name.is_empty() || preset.is_empty() || preset.contains('@') {
            return Err(format!("'{text}' is not NAME or NAME@PRESET"));
        }
        Ok(Self {
            label: text.to_owned(),
            name: name.to_owned(),
            preset: preset.to_owned(),
        })
    }
}

/// `MODEL.VARIABLE=VALUE`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Assignment {
    /// `fmu-truth`, `fmu-nav` or the label of a foreign filter.
    pub model: String,
    /// Name of a parameter of that FMU.
    pub variable: String,
    /// Value as text.
    pub value: String,
}

impl FromStr for Assignment {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text
            .split_once('=')
            .and_then(|(left, value)| Some((left.split_once('.')?, value)));
        match parts {
            Some(((model, variable), value)) if !model.is_empty() && !variable.is_empty() && !value.is_empty() => {
                Ok(Self {
                    model: model.to_owned(),
                    variable: variable.to_owned(),
                    value: value.to_owned(),
                })
            }
            _ => Err(format!(
                "'{text}' is not MODEL.VARIABLE=VALUE, as in fmu-truth.vent.scale=10"
            )),
        }
    }
}

/// `LABEL=PATH`, a foreign filter.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct ForeignFilter {
    /// Text of the `filter` column.
    pub label: String,
    /// Its `.fmu` file.
    pub path: PathBuf,
}

impl FromStr for ForeignFilter {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            Some((label, path)) if is_label(label) && !path.is_empty() => Ok(Self {
                label: label.to_owned(),
                path: path.into(),
            }),
            _ => Err(format!(
                "'{text}' is not LABEL=PATH with a LABEL of letters, digits, '-' and '_'"
            )),
        }
    }
}

/// `LABEL.THEIR_NAME=OUR_NAME`, a name mapping for a foreign FMU.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Mapping {
    /// `fmu-truth` or the label of a foreign filter.
    pub model: String,
    /// Name in that FMU: of a scalar, or of a vector or matrix without its indices.
    pub own: String,
    /// Name it stands for.
    pub contract: String,
}

impl FromStr for Mapping {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let Assignment { model, variable, value } = text
            .parse()
            .map_err(|_| format!("'{text}' is not LABEL.THEIR_NAME=OUR_NAME, as in other.x_hat=est.r_tc_n"))?;
        Ok(Self {
            model,
            own: variable,
            contract: value,
        })
    }
}

impl fmt::Display for FilterChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.label)
    }
}

impl fmt::Display for Assignment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}={}", self.model, self.variable, self.value)
    }
}

impl fmt::Display for ForeignFilter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.label, self.path.display())
    }
}

impl fmt::Display for Mapping {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}={}", self.model, self.own, self.contract)
    }
}

/// Files hold these as the text that the command line takes.
macro_rules! as_text {
    ($($type:ty),*) => {$(
        impl TryFrom<String> for $type {
            type Error = String;

            fn try_from(text: String) -> Result<Self, String> {
                text.parse()
            }
        }

        impl From<$type> for String {
            fn from(value: $type) -> Self {
                value.to_string()
            }
        }
    )*};
}
pub(crate) use as_text;

as_text!(FilterChoice, Assignment, ForeignFilter, Mapping);

fn is_label(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn filter_choices() {
        let bare: FilterChoice = "milton".parse().unwrap();
        assert_eq!(
            (bare.label.as_str(), bare.name.as_str(), bare.preset.as_str()),
            ("milton", "milton", "paper")
        );
        let preset: FilterChoice = "milton@consistent".parse().unwrap();
        assert_eq!((preset.name.as_str(), preset.preset.as_str()), ("milton", "consistent"));
        assert_eq!(preset.label, "milton@consistent");
        for bad in ["", "@x", "milton@", "a@b@c"] {
            assert!(bad.parse::<FilterChoice>().is_err(), "{bad}");
        }
    }

    #[test]
    fn assignments_split_at_the_first_dot_and_equals_sign() {
        let a: Assignment = "fmu-truth.target_burn.a_t_n[1]=-1e-3".parse().unwrap();
        let parts = (a.model.as_str(), a.variable.as_str(), a.value.as_str());
        assert_eq!(parts, ("fmu-truth", "target_burn.a_t_n[1]", "-1e-3"));
        for bad in [
            "",
            "fmu-truth",
            "fmu-truth=3",
            "fmu-truth.x",
            "fmu-truth.x=",
            ".x=3",
            "m.=3",
            "a=b.c",
        ] {
            assert!(bad.parse::<Assignment>().is_err(), "{bad}");
        }
    }

    #[test]
    fn foreign_filters_and_mappings() {
        let f: ForeignFilter = "their-ekf=a/b=c.fmu".parse().unwrap();
        assert_eq!((f.label.as_str(), f.path), ("their-ekf", PathBuf::from("a/b=c.fmu")));
        for bad in ["x.fmu", "=x.fmu", "a.b=x.fmu", "a=", "a,b=x.fmu"] {
            assert!(bad.parse::<ForeignFilter>().is_err(), "{bad}");
        }
        let m: Mapping = "their-ekf.x.hat=est.r_tc_n".parse().unwrap();
        assert_eq!(
            (m.model.as_str(), m.own.as_str(), m.contract.as_str()),
            ("their-ekf", "x.hat", "est.r_tc_n")
        );
        assert!("x=y".parse::<Mapping>().unwrap_err().contains("OUR_NAME"));
    }

    #[test]
    fn what_is_written_is_what_was_read() {
        for text in ["milton", "milton@consistent"] {
            assert_eq!(text.parse::<FilterChoice>().unwrap().to_string(), text);
        }
        let text = "fmu-truth.target_burn.a_t_n[1]=-1e-3";
        assert_eq!(text.parse::<Assignment>().unwrap().to_string(), text);
        assert_eq!("a=b/c.fmu".parse::<ForeignFilter>().unwrap().to_string(), "a=b/c.fmu");
        let text = "their-ekf.x.hat=est.r_tc_n";
        assert_eq!(text.parse::<Mapping>().unwrap().to_string(), text);
        let read: Result<FilterChoice, _> = serde_json::from_str("\"a@b@c\"");
        assert!(read.unwrap_err().to_string().contains("NAME@PRESET"));
    }
}
