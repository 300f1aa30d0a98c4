//! Units by their spelling: `m/s2`, `m2/s5`, `rad`, `m/s^2.5`.

/// Base units that FMI knows; each has an attribute of the same spelling in `<BaseUnit>`.
const BASE: [&str; 8] = ["kg", "m", "s", "A", "K", "mol", "cd", "rad"];

/// Units with a symbol of their own: exponents of [`BASE`].
const DERIVED: [(&str, [f64; BASE.len()]); 1] = [("N", [1.0, 1.0, -2.0, 0.0, 0.0, 0.0, 0.0, 0.0])];

/// Display units: unit, display unit, factor.
const DISPLAY: [(&str, &str, f64); 2] = [
    ("rad", "deg", 180.0 / std::f64::consts::PI),
    ("rad/s", "deg/s", 180.0 / std::f64::consts::PI),
];

/// Units of one quantity alone.
const QUANTITIES: [(&str, &str); 8] = [
    ("m", "Length"),
    ("s", "Time"),
    ("kg", "Mass"),
    ("m/s", "Velocity"),
    ("m/s2", "Acceleration"),
    ("rad", "Angle"),
    ("rad/s", "AngularVelocity"),
    ("N", "Force"),
];

/// A unit in terms of the SI base units.
#[derive(Debug, Clone, PartialEq)]
pub struct Unit {
    name: String,
    /// One exponent for each of [`BASE`].
    exponents: [f64; BASE.len()],
}

impl Unit {
    /// Reads a product of powers with at most one `/`; what follows the `/` divides. Factors are parted by `.`, an exponent
    /// follows its symbol directly or after `^` (`^` also takes decimals), and `1` is no dimension.
    pub fn parse(name: &str) -> Option<Self> {
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

    /// Its spelling.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Symbols and exponents of the base units, zero exponents included.
    pub fn exponents(&self) -> impl Iterator<Item = (&'static str, f64)> {
        BASE.into_iter().zip(self.exponents)
    }

    /// Whether every exponent is a whole number, as FMI needs them to be.
    pub fn is_whole(&self) -> bool {
        self.exponents
            .iter()
            .all(|exponent| exponent.fract().abs() < f64::EPSILON)
    }

    /// Units that values in this unit may be displayed in, with the factor by which a value is multiplied for it.
    pub fn display_units(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let own = DISPLAY.into_iter().filter(|(unit, ..)| *unit == self.name);
        own.map(|(_, name, factor)| (name, factor))
    }
}

/// What is measured in a unit, in the words of the International System of Quantities without spaces; `None` where a unit is that of
/// several quantities or of none with a name.
///
/// * returns: its name and the unit.
pub fn quantity(unit: &str) -> Option<(&'static str, &'static str)> {
    let known = QUANTITIES.iter().find(|(of, _)| *of == unit);
    known.map(|(unit, name)| (*name, *unit))
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
            let of = made_of(symbol)?;
            let (exponent, after) = match after.strip_prefix('^') {
                Some(after) => split_while(after, |c| c.is_ascii_digit() || matches!(c, '-' | '.')),
                None => split_while(after, |c| c.is_ascii_digit() || c == '-'),
            };
            let exponent = match exponent {
                "" => 1.0,
                digits => digits.parse::<f64>().ok()?,
            };
            for (sum, own) in exponents.iter_mut().zip(of) {
                *sum += sign * exponent * own;
            }
            rest = after;
        }
        if rest.is_empty() {
            return Some(());
        }
        rest = rest.strip_prefix('.')?;
    }
}

/// Exponents of the base units in a symbol.
fn made_of(symbol: &str) -> Option<[f64; BASE.len()]> {
    if let Some(slot) = BASE.iter().position(|base| *base == symbol) {
        let mut one = [0.0; BASE.len()];
        one[slot] = 1.0;
        return Some(one);
    }
    DERIVED
        .iter()
        .find(|(derived, _)| *derived == symbol)
        .map(|(_, of)| *of)
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
            ("N", [1.0, 1.0, -2.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
            ("N2.s/kg", [1.0, 2.0, -3.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
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
    fn only_whole_exponents_are_whole() {
        for (name, whole) in [("1", true), ("m2/s5", true), ("m/s^2.5", false)] {
            assert_eq!(Unit::parse(name).unwrap().is_whole(), whole, "{name}");
        }
    }

    #[test]
    #[allow(clippy::float_cmp, reason = "the one rounding of 180 / pi")]
    fn angles_can_be_shown_in_degrees() {
        let displayed = |name| Unit::parse(name).unwrap().display_units().collect::<Vec<_>>();
        assert_eq!(displayed("rad"), [("deg", 57.295_779_513_082_32)]);
        assert_eq!(displayed("m"), []);
    }
}
