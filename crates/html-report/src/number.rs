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

/// The value to so many significant digits.
pub(crate) fn significant(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

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
