//! Coefficients of a gravity field, those that come with the crate, and truncation.

use serde::{Deserialize, Serialize};

use super::error::FieldError;
use super::format::MAX_DEGREE;

/// Fully normalised coefficients of a gravity field to some degree and order.
///
/// U = mu/r sum over n, m <= n of (R/r)^n P_nm(sin phi) (C_nm cos m lambda + S_nm sin m lambda), phi the geocentric latitude
/// and lambda the east longitude, both of the axes fixed in the body. C_00 is 1.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Raw", into = "Raw")]
pub struct Coefficients {
    mu: f64,
    r_ref: f64,
    degree: usize,
    order: usize,
    /// C_nm and S_nm at n (n + 1) / 2 + m, to m = n also where `order` is less.
    cs: Vec<(f64, f64)>,
}

/// As it is saved: what is in the file, not yet checked.
#[derive(Serialize, Deserialize)]
struct Raw {
    mu: f64,
    r_ref: f64,
    degree: usize,
    order: usize,
    cs: Vec<(f64, f64)>,
}

impl Coefficients {
    /// Field of a point mass, with room to this degree and order.
    ///
    /// * `mu`: gravitational parameter, m3/s2.
    /// * `r_ref`: reference radius R, m.
    ///
    /// # Errors
    /// When `degree` is above [`MAX_DEGREE`], `order` above `degree`, or a constant not positive and finite.
    pub fn point_mass(mu: f64, r_ref: f64, degree: usize, order: usize) -> Result<Self, FieldError> {
        for (name, value) in [("gravitational parameter", mu), ("reference radius", r_ref)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(FieldError::Constant { name, value });
            }
        }
        if degree > MAX_DEGREE {
            return Err(FieldError::Degree { degree });
        }
        if order > degree {
            return Err(FieldError::Order { degree, order });
        }
        let mut cs = vec![(0.0, 0.0); place(degree, degree) + 1];
        cs[0].0 = 1.0;
        Ok(Self {
            mu,
            r_ref,
            degree,
            order,
            cs,
        })
    }

    /// The same field with C_nm and S_nm as given; S_n0 has no effect.
    ///
    /// # Errors
    /// When the field has no such degree or order, for degree 0, and when a value is not finite.
    pub fn with(mut self, n: usize, m: usize, c: f64, s: f64) -> Result<Self, FieldError> {
        if n == 0 || n > self.degree || m > self.order.min(n) {
            return Err(FieldError::NoSuchTerm {
                n,
                m,
                degree: self.degree,
                order: self.order,
            });
        }
        for (name, value) in [("C", c), ("S", s)] {
            if !value.is_finite() {
                return Err(FieldError::Coefficient { name, n, m, value });
            }
        }
        self.cs[place(n, m)] = (c, s);
        Ok(self)
    }

    /// The part of the field to this degree and order.
    ///
    /// # Errors
    /// When the field does not reach so far.
    pub fn truncated(&self, degree: usize, order: usize) -> Result<Self, FieldError> {
        if degree > self.degree || order > self.order {
            return Err(FieldError::Truncation {
                degree,
                order,
                has_degree: self.degree,
                has_order: self.order,
            });
        }
        let mut short = Self::point_mass(self.mu, self.r_ref, degree, order)?;
        for n in 1..=degree {
            for m in 0..=n.min(order) {
                short.cs[place(n, m)] = self.cs[place(n, m)];
            }
        }
        Ok(short)
    }

    /// Gravitational parameter, m3/s2.
    pub fn mu(&self) -> f64 {
        self.mu
    }

    /// Reference radius R, m.
    pub fn r_ref(&self) -> f64 {
        self.r_ref
    }

    /// Highest degree.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Highest order, at most the degree.
    pub fn order(&self) -> usize {
        self.order
    }

    /// C_nm and S_nm; zeros beyond the field.
    pub fn get(&self, n: usize, m: usize) -> (f64, f64) {
        let inside = n <= self.degree && m <= n;
        if inside { self.cs[place(n, m)] } else { (0.0, 0.0) }
    }

    /// Unnormalised J2 = -sqrt(5) C_20; 0 for a field without degree 2.
    pub fn j2(&self) -> f64 {
        -self.get(2, 0).0 * 5.0_f64.sqrt()
    }
}

impl TryFrom<Raw> for Coefficients {
    type Error = FieldError;

    fn try_from(raw: Raw) -> Result<Self, FieldError> {
        let empty = Self::point_mass(raw.mu, raw.r_ref, raw.degree, raw.order)?;
        let mut given = raw.cs.into_iter().skip(1);
        (1..=raw.degree).try_fold(empty, |field, n| {
            (0..=n).try_fold(field, |field, m| match given.next() {
                Some((c, s)) if m <= raw.order => field.with(n, m, c, s),
                Some(_) => Ok(field),
                None => Err(FieldError::Missing { n, m }),
            })
        })
    }
}

impl From<Coefficients> for Raw {
    fn from(field: Coefficients) -> Self {
        let Coefficients {
            mu,
            r_ref,
            degree,
            order,
            cs,
        } = field;
        Self {
            mu,
            r_ref,
            degree,
            order,
            cs,
        }
    }
}

/// Place of a term in a list that runs through the orders of one degree after the other.
fn place(n: usize, m: usize) -> usize {
    n * (n + 1) / 2 + m
}

/// A field that comes with the crate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Embedded {
    /// Name by which a mission asks for it.
    pub name: &'static str,
    /// Gravitational parameter, m3/s2.
    pub mu: f64,
    /// Reference radius, m.
    pub r_ref: f64,
    /// C_nm and S_nm, fully normalised, from C_20 on in the order of degree, then order.
    terms: &'static [(f64, f64)],
}

/// Every field that comes with the crate. To add one: a constant, and its name here.
pub const EMBEDDED: &[Embedded] = &[EGM96];

/// The Earth to degree and order 3.
///
/// Source: EGM96 (Lemoine et al., NASA/TP-1998-206861), tide-free, with its own mu and radius.
pub const EGM96: Embedded = Embedded {
    name: "egm96_3x3",
    mu: 3_986_004.415e8,
    r_ref: 6_378_136.3,
    terms: &[
        (-0.484165371736e-3, 0.0),
        (-0.186987635955e-9, 0.119528012031e-8),
        (0.243914352398e-5, -0.140016683654e-5),
        (0.957254173792e-6, 0.0),
        (0.202998882184e-5, 0.248513158716e-6),
        (0.904627768605e-6, -0.619025944205e-6),
        (0.721072657057e-6, 0.141435626958e-5),
    ],
};

impl Embedded {
    /// The field of this name.
    ///
    /// # Errors
    /// When there is none.
    pub fn find(name: &str) -> Result<&'static Self, FieldError> {
        EMBEDDED
            .iter()
            .find(|field| field.name == name)
            .ok_or_else(|| FieldError::Unknown {
                name: name.to_owned(),
                known: EMBEDDED.iter().map(|field| field.name).collect::<Vec<_>>().join(", "),
            })
    }

    /// Its coefficients, complete to a degree and the same order.
    pub fn coefficients(&self) -> Coefficients {
        let mut cs = vec![(1.0, 0.0), (0.0, 0.0), (0.0, 0.0)];
        cs.extend_from_slice(self.terms);
        let degree = (0..).take_while(|n| place(*n, *n) < cs.len()).count() - 1;
        Coefficients {
            mu: self.mu,
            r_ref: self.r_ref,
            degree,
            order: degree,
            cs,
        }
    }

    /// Unnormalised J2 = -sqrt(5) C_20.
    pub fn j2(&self) -> f64 {
        self.coefficients().j2()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn embedded_fields_are_complete() {
        for field in EMBEDDED {
            let c = field.coefficients();
            assert_eq!(c.cs.len(), place(c.degree, c.degree) + 1, "{}", field.name);
            assert!(c.degree >= 2 && c.degree <= MAX_DEGREE, "{}", field.name);
            assert_eq!(Embedded::find(field.name).unwrap().coefficients(), c);
        }
        let c = EGM96.coefficients();
        assert_eq!((c.degree(), c.order()), (3, 3));
        assert_eq!(c.get(3, 3), (0.721072657057e-6, 0.141435626958e-5));
        assert_eq!(c.get(2, 1), (-0.186987635955e-9, 0.119528012031e-8));
        assert_eq!(
            (c.get(0, 0), c.get(1, 1), c.get(4, 0)),
            ((1.0, 0.0), (0.0, 0.0), (0.0, 0.0))
        );
    }

    #[test]
    fn val_j2_of_egm96() {
        // The value that textbooks print.
        assert!((EGM96.j2() - 1.082_626_68e-3).abs() < 5e-12, "{}", EGM96.j2());
    }

    #[test]
    fn truncation_keeps_the_low_terms_and_nothing_else() {
        let short = EGM96.coefficients().truncated(3, 1).unwrap();
        assert_eq!((short.degree(), short.order()), (3, 1));
        assert_eq!(short.get(3, 1), EGM96.coefficients().get(3, 1));
        assert_eq!(short.get(3, 2), (0.0, 0.0));
        for (degree, order) in [(4, 0), (3, 4), (2, 3)] {
            let error = EGM96.coefficients().truncated(degree, order).unwrap_err().to_string();
            assert!(
                error.contains(&degree.to_string()) && error.contains(&order.to_string()),
                "{error}"
            );
        }
    }

    #[test]
    fn what_is_no_field_is_refused() {
        let earth = |degree, order| Coefficients::point_mass(EGM96.mu, EGM96.r_ref, degree, order);
        assert_eq!(earth(21, 0), Err(FieldError::Degree { degree: 21 }));
        assert_eq!(earth(3, 4), Err(FieldError::Order { degree: 3, order: 4 }));
        for mu in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(Coefficients::point_mass(mu, 1.0, 2, 2).is_err(), "{mu}");
            assert!(Coefficients::point_mass(1.0, mu, 2, 2).is_err(), "{mu}");
        }
        for (n, m) in [(0, 0), (4, 0), (3, 3), (2, 3)] {
            let error = earth(3, 2).unwrap().with(n, m, 0.1, 0.0).unwrap_err();
            assert!(matches!(error, FieldError::NoSuchTerm { .. }), "{n}, {m}: {error}");
        }
        assert!(earth(2, 2).unwrap().with(2, 0, f64::NAN, 0.0).is_err());
        let error = Embedded::find("egm08").unwrap_err().to_string();
        assert!(error.contains("egm08") && error.contains("egm96_3x3"), "{error}");
    }
}
