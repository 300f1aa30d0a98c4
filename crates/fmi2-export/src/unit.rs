//! Units by their spelling: `m/s2`, `m2/s5`, `rad`, `m/s^2.5`.

use crate::xml::{Element, number};

/// Base units that FMI knows, with the attribute each has in `<BaseUnit>`; both are spelt alike.
const BASE: [&str; 8] = ["kg", "m", "s", "A", "K", "mol", "cd", "rad"];

/// Display units: base unit, name, factor (display value = factor * value).
const DISPLAY: [(&str, &str, f64); 2] = [
    ("rad", "deg", 180.0 / std::f64::consts::PI),
    ("rad/s", "deg/s", 180.0 / std::f64::consts::PI),
];

/// A unit in terms of the SI base units.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Unit {
    name: String,
    /// One exponent for each of [`BASE`].
    exponents: [f64; BASE.len()],
}

impl Unit {
    /// Reads a product of powers with at most one `/`; what follows the `/` divides. Factors are parted by `.`, an exponent
    /// follows its symbol directly or after `^` (`^` also takes decimals), and `1` is no dimension.
    pub(crate) fn parse(name: &str) -> Option<Self> {
        let mut exponents = [0.0; BASE.len()];
        let (over, under) = match name.split_once('/') {
            Some((over, under)) => (over, Some(under)),
            None => (name, None),
        };
        multiply(&mut exponents, over, 1.0)?;
        if let Some(under) = under {
            multiply(&mut exponents, under, -1.0)?;
        }
        Some(Self {
            name: name.to_owned(),
            exponents,
        })
    }

    /// `<Unit>` with the display units in use. A unit with a fractional exponent has no `<BaseUnit>`: FMI has no way to say it.
    pub(crate) fn element(&self, display_units: &[&str]) -> Element {
        let mut unit = Element::new("Unit").attribute("name", &self.name);
        if self
            .exponents
            .iter()
            .all(|exponent| exponent.fract().abs() < f64::EPSILON)
        {
            let mut base_unit = Element::new("BaseUnit");
            for (symbol, exponent) in BASE.iter().zip(self.exponents) {
                if exponent.abs() > 0.0 {
                    base_unit = base_unit.attribute(*symbol, number(exponent));
                }
            }
            unit = unit.child(base_unit);
        }
        for (base, name, factor) in DISPLAY {
            if base == self.name && display_units.contains(&name) {
                unit = unit.child(
                    Element::new("DisplayUnit")
                        .attribute("name", name)
                        .attribute("factor", number(factor)),
                );
            }
        }
        unit
    }
}

/// Whether values in `unit` may be displayed in `display`.
pub(crate) fn displays(unit: &str, display: &str) -> bool {
    DISPLAY.iter().any(|(base, name, _)| *base == unit && *name == display)
}

/// Multiplies the factors of `product`, raised to `sign`, into `exponents`.
fn multiply(exponents: &mut [f64; BASE.len()], product: &str, sign: f64) -> Option<()> {
    let mut rest = product;
    loop {
        if let Some(after) = rest.strip_prefix('1') {
            rest = after;
        } else {
            let (symbol, after) = split_while(rest, |c| c.is_ascii_alphabetic());
            let slot = BASE.iter().position(|base| *base == symbol)?;
            let (exponent, after) = match after.strip_prefix('^') {
                Some(after) => split_while(after, |c| c.is_ascii_digit() || matches!(c, '-' | '.')),
                None => split_while(after, |c| c.is_ascii_digit() || c == '-'),
            };
            let exponent = match exponent {
                "" => 1.0,
                digits => digits.parse::<f64>().ok()?,
            };
            exponents[slot] += sign * exponent;
            rest = after;
        }
        if rest.is_empty() {
            return Some(());
        }
        rest = rest.strip_prefix('.')?;
    }
}

fn split_while(text: &str, belongs: impl Fn(char) -> bool) -> (&str, &str) {
    text.split_at(text.find(|c| !belongs(c)).unwrap_or(text.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exponents(name: &str) -> Option<[f64; 8]> {
        Unit::parse(name).map(|unit| unit.exponents)
    }

    #[test]
    #[allow(clippy::float_cmp, reason = "small integers and halves are exact")]
    fn spellings_give_exponents() {
        //                                 kg    m    s     A    K    mol  cd   rad
        for (name, expected) in [
            ("1", [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
            ("1/s", [0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
            ("m/s2", [0.0, 1.0, -2.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
            ("m2/s5", [0.0, 2.0, -5.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
            ("m/s^2.5", [0.0, 1.0, -2.5, 0.0, 0.0, 0.0, 0.0, 0.0]),
            ("kg.m2/s.rad", [1.0, 2.0, -1.0, 0.0, 0.0, 0.0, 0.0, -1.0]),
            ("m.s-2", [0.0, 1.0, -2.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        ] {
            assert_eq!(exponents(name), Some(expected), "{name}");
        }
    }

    #[test]
    fn misspellings_are_refused() {
        for name in ["", "meter", "m/", "m/s/s", "m s", "2m", "m.", "m2.5", "m^-"] {
            assert_eq!(exponents(name), None, "{name}");
        }
    }

    #[test]
    fn a_fractional_exponent_has_no_base_unit() {
        let element = |name| Unit::parse(name).unwrap().element(&["deg"]);
        let unit = |name: &str| Element::new("Unit").attribute("name", name);
        assert_eq!(element("m/s^2.5"), unit("m/s^2.5"));
        let base = Element::new("BaseUnit").attribute("rad", "1");
        let deg = Element::new("DisplayUnit")
            .attribute("name", "deg")
            .attribute("factor", "57.29577951308232");
        assert_eq!(element("rad"), unit("rad").child(base).child(deg));
    }
}
