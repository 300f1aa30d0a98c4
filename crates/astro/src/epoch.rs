//! Time as the Earth's rotation, the Sun and the Moon ask for it.

use jiff::civil::{DateTime, date};

use crate::AstroError;

/// Julian date of J2000.0.
pub const J2000: f64 = 2_451_545.0;

/// First and last year of which the places of Sun and Moon are given.
const YEARS: [i16; 2] = [1900, 2100];

/// Form of a date.
const FORM: &str = "%Y-%m-%dT%H:%M:%S";

/// Julian date of a date in universal time, days.
///
/// * `text`: as in `2020-01-01T00:00:00`, with a fraction of the second and a `Z` at the end if wanted; Gregorian calendar,
///   1900 to 2100.
///
/// The difference of UTC and the other times is left out, as [`days_since_j2000`] tells; a leap second has no Julian date
/// of its own and is refused.
///
/// # Errors
/// When the text has another form, or no such day or time of day exists, or the year is out of range.
pub fn julian_date(text: &str) -> Result<f64, AstroError> {
    let refuse = |reason: String| AstroError::Epoch {
        text: text.to_owned(),
        reason,
    };
    let plain = text.strip_suffix('Z').unwrap_or(text);
    let instant = DateTime::strptime(format!("{FORM}%.f"), plain).map_err(|error| refuse(format!("({error})")))?;
    // Parsing is lenient about leading zeros, blanks and second 60.
    let whole_seconds = plain.split_once('.').map_or(plain, |(whole, _)| whole);
    if instant.strftime(FORM).to_string() != whole_seconds {
        return Err(refuse("is not of this form".to_owned()));
    }
    let [first, last] = YEARS;
    if !(first..=last).contains(&instant.year()) {
        return Err(refuse(format!("is not in the years {first} to {last}")));
    }
    let since = instant.duration_since(date(2000, 1, 1).at(12, 0, 0, 0));
    Ok(J2000 + since.as_secs_f64() / 86_400.0)
}

/// Days since J2000.0 of the instant `t` seconds after the Julian date `epoch_jd`.
///
/// A Julian date in one `f64` counts in steps of 40 microseconds, in which the Earth turns by 2 cm; days since J2000.0 come
/// in steps of 0.1 microseconds and keep forces smooth in time.
///
/// * `epoch_jd`: start of the simulation, d.
/// * `t`: time since then, s.
///
/// Universal and terrestrial time are one here: their difference, 69 s in 2020, moves the Moon by 38 arcseconds and the Sun
/// by 3, less than the series of [`crate::sun_moon`] leave out.
pub fn days_since_j2000(epoch_jd: f64, t: f64) -> f64 {
    (epoch_jd - J2000) + t / 86_400.0
}

/// Julian centuries of 36525 days.
pub(crate) fn centuries(days: f64) -> f64 {
    days / 36_525.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_microsecond_is_not_lost_in_the_julian_date() {
        let step = days_since_j2000(2_458_849.5, 1e-6) - days_since_j2000(2_458_849.5, 0.0);
        assert!((step * 86_400.0 - 1e-6).abs() < 1e-7, "{step}");
        assert!((days_since_j2000(2_458_849.5, 43_200.0) - 7305.0).abs() < 1e-12);
    }

    #[test]
    fn val_julian_dates_of_printed_examples() {
        // Meeus, Astronomical Algorithms, chapter 7: example 7.a (Sputnik, October 4.81) and the list after it.
        for (text, jd) in [
            ("1957-10-04T19:26:24", 2_436_116.31),
            ("2000-01-01T12:00:00", 2_451_545.0),
            ("1999-01-01T00:00:00", 2_451_179.5),
            ("1987-01-27T00:00:00Z", 2_446_822.5),
            ("1987-06-19T12:00:00.0", 2_446_966.0),
            ("1988-01-27T00:00:00", 2_447_187.5),
            ("1900-01-01T00:00:00", 2_415_020.5),
            ("2020-01-01T00:00:00", 2_458_849.5),
        ] {
            let seen = julian_date(text).unwrap();
            // A Julian date in one number counts in steps of 5e-10 d.
            assert!((seen - jd).abs() < 1e-9, "{text}: {seen} and {jd}");
        }
        let fraction = julian_date("2000-01-01T12:00:43.2").unwrap();
        assert!((fraction - J2000 - 5e-4).abs() < 1e-9, "{fraction}");
    }

    #[test]
    fn dates_of_another_form_are_refused() {
        for text in [
            "",
            "2020-01-01",
            "2020-01-01 00:00:00",
            "20200101T000000",
            "2020-1-1T00:00:00",
            " 2020-01-01T00:00:00",
            "2020-01-01T00:00:00 ",
            "2020-01-01T00:00:00+01:00",
            "2020-01-01T00:00:00ZZ",
            "2020-01-01T00:00",
            "2020-01-01T00:00:00.",
            "2021-02-29T00:00:00",
            "2020-13-01T00:00:00",
            "2020-01-01T24:00:00",
            "2016-12-31T23:59:60",
            "1899-12-31T23:59:59",
            "2101-01-01T00:00:00",
            "-2020-01-01T00:00:00",
            "NaN",
        ] {
            let error = julian_date(text).unwrap_err().to_string();
            assert!(
                error.contains(&format!("\"{text}\"")) && error.contains("2020-01-01T00:00:00"),
                "{error}"
            );
        }
    }
}
