//! Precession: from the mean equator and equinox of J2000.0 to those of date.

use nalgebra::{Matrix3, Vector3};
use numerics::rotation;

use crate::epoch::centuries;

/// Direction cosine matrix `dcm_date_j2000`, to the mean equator and equinox of date from those of J2000.0 (which are the
/// axes of the ICRF to 0.02 arcseconds).
///
/// * `days`: days since J2000.0.
///
/// Source: IAU 1976 (Lieske et al.); Meeus, Astronomical Algorithms, Eq. (21.3).
pub fn dcm_date_j2000(days: f64) -> Matrix3<f64> {
    let t = centuries(days);
    let [zeta, z, theta] = [
        [2306.2181, 0.30188, 0.017998],
        [2306.2181, 1.09468, 0.018203],
        [2004.3109, -0.42665, -0.041833],
    ]
    .map(|[a, b, c]| (t * (a + t * (b + t * c)) / 3600.0).to_radians());
    let about = |axis, angle| rotation::about(&axis, angle);
    (about(Vector3::z_axis(), z) * about(Vector3::y_axis(), -theta) * about(Vector3::z_axis(), zeta)).into_inner()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_theta_persei_of_meeus() {
        // Meeus, example 21.b: its place at 2028 November 13.19, equinox of J2000.0, and that of date.
        let place = |longitude: f64, latitude: f64| {
            let (lon, lat) = (longitude.to_radians(), latitude.to_radians());
            Vector3::new(lat.cos() * lon.cos(), lat.cos() * lon.sin(), lat.sin())
        };
        let of_date = dcm_date_j2000(2_462_088.69 - crate::epoch::J2000) * place(41.054_063, 49.227_750);
        let off = (of_date - place(41.547_214, 49.348_483)).norm().to_degrees();
        // Six printed digits of either place.
        assert!(off < 1.5e-6, "{off} deg");
    }
}
