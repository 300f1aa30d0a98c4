//! Numbers for people and for figures.

/// Three significant digits; a dash for what is absent or not finite.
pub fn short(value: Option<f64>) -> String {
    let Some(v) = value.filter(|v| v.is_finite()) else {
        return "–".to_owned();
    };
    if v == 0.0 {
        return "0".to_owned();
    }
    // Rounding first: 9.996 has three digits as 10.0.
    let rounded = significant(v, 3);
    let magnitude = rounded.abs();
    if (1e-3..1e5).contains(&magnitude) {
        let digits = (2.0 - magnitude.log10().floor()).max(0.0) as usize;
        format!("{rounded:.digits$}")
    } else {
        format!("{rounded:.2e}")
    }
}

/// A value with its standard error: the error with two significant digits, the value with as many decimals.
pub(crate) fn with_error(value: f64, error: Option<f64>) -> String {
    let Some(error) = error.filter(|e| e.is_finite() && *e > 0.0) else {
        return short(Some(value));
    };
    // Rounding first: 0.0996 is 0.10.
    let exponent = |v: f64| significant(v, 2).log10().floor() as i32;
    let (place, largest) = (exponent(error), exponent(value.abs().max(error)));
    let decimals = |places: i32| usize::try_from(places).unwrap_or(0);
    if (-3..=4).contains(&largest) {
        let decimals = decimals(1 - place);
        format!("{value:.decimals$}\u{a0}±\u{a0}{error:.decimals$}")
    } else {
        let unit = 10.0_f64.powi(largest);
        let decimals = decimals(1 + largest - place);
        format!(
            "({:.decimals$}\u{a0}±\u{a0}{:.decimals$})e{largest}",
            value / unit,
            error / unit
        )
    }
}

/// The value to so many significant digits.
pub(crate) fn significant(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1))
        .parse()
        .unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_gives_the_decimals() {
        for (value, error, text) in [
            (0.24491, Some(0.00577), "0.2449 ± 0.0058"),
            (-1.0, Some(0.0996), "-1.00 ± 0.10"),
            (1234.5, Some(120.0), "1234 ± 120"),
            (1.234e-5, Some(4.2e-7), "(1.234 ± 0.042)e-5"),
            (1.7e-3, Some(4.1e-5), "0.001700 ± 0.000041"),
            (0.5, None, "0.500"),
        ] {
            assert_eq!(with_error(value, error).replace('\u{a0}', " "), text);
        }
    }

    #[test]
    fn three_digits_at_any_magnitude() {
        for (value, text) in [
            (None, "–"),
            (Some(f64::NAN), "–"),
            (Some(0.0), "0"),
            (Some(9.996), "10.0"),
            (Some(-0.24149), "-0.241"),
            (Some(12345.0), "12300"),
            (Some(9.254e-6), "9.25e-6"),
        ] {
            assert_eq!(short(value), text);
        }
    }
}
