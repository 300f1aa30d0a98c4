//! Time as the Earth's rotation, the Sun and the Moon ask for it.

/// Julian date of J2000.0.
pub const J2000: f64 = 2_451_545.0;

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
}
