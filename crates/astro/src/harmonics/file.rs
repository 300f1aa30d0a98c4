//! The coefficient file.
//!
//! Text in UTF-8. Blank lines, and lines that begin with `#`, count for nothing. First stand the two constants that the
//! coefficients belong to, in either order, then the header, then one row for each term, in any order of rows:
//!
//! ```text
//! # The Earth's oblateness and the ellipticity of its equator.
//! mu_m3_s2 = 3.986004415e14
//! radius_m = 6378136.3
//! degree,order,c,s
//! 2,0,-4.84165371736e-4,0
//! 2,1,-1.86987635955e-10,1.19528012031e-9
//! 2,2,2.43914352398e-6,-1.40016683654e-6
//! ```
//!
//! * `mu_m3_s2`, `radius_m`: gravitational parameter, m3/s2, and reference radius, m; both are required.
//! * `c`, `s`: C_nm and S_nm, **fully normalised**, as [`Coefficients`] defines them; body-fixed axes.
//! * C_00 may be left out and is 1. Terms of degree 1 may be left out and are 0: the origin is the centre of mass.
//! * From degree 2 on every term is there, to the file's highest order in each degree; a zero is written as zero, since a
//!   hole is more often a damaged file.
//! * The file may go beyond degree [`MAX_DEGREE`] if less is asked for. What is beyond the degree asked for is read as
//!   numbers, and is otherwise not looked at.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use super::coefficients::Coefficients;
use super::error::{Fault, FieldError};
use super::format::{CONSTANTS, HEADER, MAX_DEGREE};

/// How much of a file is used; what is `None` is as much as the file has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Extent {
    /// Highest degree.
    pub degree: Option<usize>,
    /// Highest order.
    pub order: Option<usize>,
}

impl Coefficients {
    /// Reads a coefficient file; the module [`super::file`] describes it.
    ///
    /// # Errors
    /// When the file cannot be read, is malformed or incomplete, or has less than `extent` asks for.
    pub fn read(path: &Path, extent: Extent) -> Result<Self, FieldError> {
        let file = path.display().to_string();
        match text(path) {
            Ok(text) => Self::parse(&text, &file, extent),
            Err(error) => Err(FieldError::Read {
                file,
                reason: error.to_string(),
            }),
        }
    }

    /// Takes the text of a coefficient file.
    ///
    /// * `file`: its name, for messages.
    ///
    /// # Errors
    /// As [`Coefficients::read`].
    pub fn parse(text: &str, file: &str, extent: Extent) -> Result<Self, FieldError> {
        let content = Content::of(text, extent.degree.unwrap_or(MAX_DEGREE)).map_err(|place| FieldError::At {
            file: file.to_owned(),
            line: place.line,
            column: place.column,
            fault: place.fault,
        })?;
        if !content.has_header {
            return Err(FieldError::NoHeader { file: file.to_owned() });
        }
        let constant = |k: usize| {
            content.constants[k].ok_or_else(|| FieldError::NoConstant {
                file: file.to_owned(),
                key: CONSTANTS[k],
            })
        };
        let (mu, r_ref) = (constant(0)?, constant(1)?);
        let degree_of_file = content
            .degree
            .ok_or_else(|| FieldError::Empty { file: file.to_owned() })?;
        if extent.degree.is_none() && degree_of_file > MAX_DEGREE {
            return Err(FieldError::Beyond {
                file: file.to_owned(),
                degree: degree_of_file,
            });
        }
        field(mu, r_ref, degree_of_file, &content.terms, extent).map_err(|cause| FieldError::InFile {
            file: file.to_owned(),
            cause: Box::new(cause),
        })
    }
}

/// Most bytes of a file: twice those of the largest field there is, EGM2008.
const LIMIT: u64 = 512 << 20;

fn text(path: &Path) -> io::Result<String> {
    let mut text = String::new();
    File::open(path)?.take(LIMIT + 1).read_to_string(&mut text)?;
    if text.len() as u64 > LIMIT {
        let what = format!("it has more than {LIMIT} bytes, and is no coefficient file");
        return Err(io::Error::new(io::ErrorKind::InvalidData, what));
    }
    Ok(text)
}

/// The field asked for, from the terms read.
fn field(
    mu: f64,
    r_ref: f64,
    degree_of_file: usize,
    terms: &BTreeMap<(usize, usize), Term>,
    extent: Extent,
) -> Result<Coefficients, FieldError> {
    let degree = extent.degree.unwrap_or(degree_of_file);
    let order_of_file = terms.keys().map(|(_, m)| *m).max().unwrap_or(0);
    let order = extent.order.unwrap_or(order_of_file);
    // What is wrong with the question itself comes first.
    let empty = Coefficients::point_mass(mu, r_ref, degree, order)?;
    if degree > degree_of_file || order > order_of_file {
        return Err(FieldError::Truncation {
            degree,
            order,
            has_degree: degree_of_file,
            has_order: order_of_file,
        });
    }
    (1..=degree).try_fold(empty, |field, n| {
        (0..=n.min(order)).try_fold(field, |field, m| match terms.get(&(n, m)) {
            Some(term) => field.with(n, m, term.c, term.s),
            None if n == 1 => Ok(field),
            None => Err(FieldError::Missing { n, m }),
        })
    })
}

/// One row.
struct Term {
    c: f64,
    s: f64,
    line: usize,
}

/// A fault and where it is.
struct Place {
    line: usize,
    column: usize,
    fault: Fault,
}

/// What stands in a file.
#[derive(Default)]
struct Content {
    constants: [Option<f64>; 2],
    has_header: bool,
    /// Highest degree of any row.
    degree: Option<usize>,
    /// Terms to the degree wanted.
    terms: BTreeMap<(usize, usize), Term>,
}

impl Content {
    fn of(text: &str, degree_wanted: usize) -> Result<Self, Place> {
        let mut content = Self::default();
        // Spreadsheets begin their files with a byte order mark.
        for (line, whole) in (1..).zip(text.trim_start_matches('\u{feff}').lines()) {
            let first = Cell::of(whole, 0, whole.len());
            if first.text.is_empty() || first.text.starts_with('#') {
                continue;
            }
            let result = if content.has_header {
                content.row(whole, line, degree_wanted)
            } else if first.text.split(',').map(str::trim).eq(HEADER.split(',')) {
                content.has_header = true;
                Ok(())
            } else {
                content.constant(whole, first)
            };
            result.map_err(|(column, fault)| Place { line, column, fault })?;
        }
        Ok(content)
    }

    fn constant(&mut self, whole: &str, first: Cell) -> Result<(), (usize, Fault)> {
        let parts = whole.split_once('=').and_then(|(key, _)| {
            let place = CONSTANTS.iter().position(|known| *known == key.trim())?;
            Some((place, Cell::of(whole, key.len() + 1, whole.len())))
        });
        let Some((place, value)) = parts else {
            let found = first.text.to_owned();
            return Err((first.column, Fault::Preamble { found }));
        };
        let key = CONSTANTS[place];
        let number = value.number().filter(|number| *number > 0.0).ok_or_else(|| {
            let found = value.text.to_owned();
            (value.column, Fault::Constant { key, found })
        })?;
        match self.constants[place].replace(number) {
            None => Ok(()),
            Some(_) => Err((first.column, Fault::RepeatedConstant { key })),
        }
    }

    fn row(&mut self, whole: &str, line: usize, degree_wanted: usize) -> Result<(), (usize, Fault)> {
        let cells = Cell::split(whole);
        let [n, m, c, s] = cells.as_slice() else {
            let found = cells.len();
            // Where the fifth column begins, or behind the last there is.
            let column = cells.get(4).map_or(whole.chars().count() + 1, |cell| cell.column);
            return Err((column, Fault::Columns { found }));
        };
        let (degree, order) = (n.whole("degree")?, m.whole("order")?);
        let (c_value, s_value) = (c.coefficient("c")?, s.coefficient("s")?);
        if order > degree {
            return Err((m.column, Fault::Order { degree, order }));
        }
        if degree == 0 && c_value - 1.0 != 0.0 {
            return Err((c.column, Fault::C00 { found: c_value }));
        }
        if order == 0 && s_value != 0.0 {
            return Err((s.column, Fault::Sn0 { found: s_value }));
        }
        self.degree = self.degree.max(Some(degree));
        if degree > degree_wanted {
            return Ok(());
        }
        let term = Term {
            c: c_value,
            s: s_value,
            line,
        };
        match self.terms.insert((degree, order), term) {
            None => Ok(()),
            Some(Term { line: first, .. }) => Err((n.column, Fault::Repeated { degree, order, first })),
        }
    }
}

/// Part of a line without the blanks about it.
#[derive(Clone, Copy)]
struct Cell<'a> {
    text: &'a str,
    /// Counted in characters from 1.
    column: usize,
}

impl<'a> Cell<'a> {
    /// From the bytes `from..to` of a line.
    fn of(line: &'a str, from: usize, to: usize) -> Self {
        let text = line[from..to].trim_start();
        Self {
            text: text.trim_end(),
            column: line[..to - text.len()].chars().count() + 1,
        }
    }

    fn split(line: &'a str) -> Vec<Self> {
        let mut from = 0;
        line.split(',')
            .map(|part| {
                let to = from + part.len();
                let cell = Self::of(line, from, to);
                from = to + 1;
                cell
            })
            .collect()
    }

    fn number(&self) -> Option<f64> {
        self.text.parse().ok().filter(|number: &f64| number.is_finite())
    }

    fn coefficient(&self, name: &'static str) -> Result<f64, (usize, Fault)> {
        self.number().ok_or_else(|| {
            let found = self.text.to_owned();
            (self.column, Fault::Number { name, found })
        })
    }

    fn whole(&self, name: &'static str) -> Result<usize, (usize, Fault)> {
        self.text.parse().map_err(|_| {
            let found = self.text.to_owned();
            (self.column, Fault::Whole { name, found })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::EGM96;
    use super::*;

    const FILE: &str = include_str!("../../data/egm96_3x3.csv");

    fn parse(text: &str) -> Result<Coefficients, FieldError> {
        Coefficients::parse(text, "field.csv", Extent::default())
    }

    fn to(degree: usize, order: usize) -> Extent {
        Extent {
            degree: Some(degree),
            order: Some(order),
        }
    }

    /// A file of all zeros.
    fn zeros(degree: usize) -> String {
        let mut text = String::from("mu_m3_s2 = 1\nradius_m=2\ndegree,order,c,s\n");
        for n in 2..=degree {
            for m in 0..=n {
                text += &format!("{n},{m},0,0\n");
            }
        }
        text
    }

    #[test]
    fn file_and_embedded_field_are_the_same() {
        assert_eq!(parse(FILE).unwrap(), EGM96.coefficients());
        let whole = tempfile::tempdir().unwrap();
        let path = whole.path().join("e.csv");
        std::fs::write(&path, format!("\u{feff}{}", FILE.replace('\n', "\r\n"))).unwrap();
        let read = Coefficients::read(&path, to(2, 1)).unwrap();
        assert_eq!(read, EGM96.coefficients().truncated(2, 1).unwrap());
        let error = Coefficients::read(&path.with_extension("txt"), Extent::default()).unwrap_err();
        assert!(error.to_string().contains("e.txt: cannot be read"), "{error}");
    }

    #[test]
    fn terms_that_may_be_left_out() {
        let field = parse("mu_m3_s2=1\nradius_m=2\n degree, order ,c,s\n0,0,1,0\n2,0,-1e-3,0\n").unwrap();
        assert_eq!((field.degree(), field.order()), (2, 0));
        assert_eq!(
            (field.get(0, 0), field.get(1, 0), field.get(2, 0)),
            ((1.0, 0.0), (0.0, 0.0), (-1e-3, 0.0))
        );
        // A shifted origin is said by degree 1.
        let field = parse("radius_m=2\nmu_m3_s2=1\ndegree,order,c,s\n1,1,0.25,-0.5\n").unwrap();
        assert_eq!((field.get(1, 0), field.get(1, 1)), ((0.0, 0.0), (0.25, -0.5)));
    }

    #[test]
    fn high_fields_are_read_as_far_as_asked() {
        let text = zeros(24);
        let error = parse(&text).unwrap_err().to_string();
        assert!(error.contains("degree 24") && error.contains("20 or less"), "{error}");
        let field = Coefficients::parse(&text, "f", to(20, 20)).unwrap();
        assert_eq!((field.degree(), field.order()), (20, 20));
        let field = Coefficients::parse(&text, "f", to(8, 0)).unwrap();
        assert_eq!((field.degree(), field.order()), (8, 0));
        let only_degree = Extent {
            degree: Some(4),
            order: None,
        };
        assert_eq!(Coefficients::parse(&text, "f", only_degree).unwrap().order(), 4);
        // Nobody asked for the hole.
        let hole = zeros(6).replace("5,3,0,0\n", "");
        assert!(Coefficients::parse(&hole, "f", to(4, 4)).is_ok());
        assert!(Coefficients::parse(&hole, "f", to(6, 2)).is_ok());
        let error = Coefficients::parse(&hole, "f", to(6, 6)).unwrap_err().to_string();
        assert!(
            error.contains("f: ") && error.contains("degree 5 and order 3"),
            "{error}"
        );
        for (extent, said) in [
            (to(21, 21), "20 at most"),
            (to(3, 4), "at most the degree"),
            (to(7, 7), "degree 6"),
        ] {
            let error = Coefficients::parse(&hole, "f", extent).unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
    }

    #[test]
    fn faults_say_where_they_are_and_what_is_allowed() {
        let head = "mu_m3_s2 = 1\nradius_m = 2\ndegree,order,c,s\n";
        for (text, place, said) in [
            ("mu_km3_s2 = 4\n", "1:1:", "\"mu_m3_s2 = ...\", \"radius_m = ...\""),
            ("\n# x\n  n,m,c,s\n", "3:3:", "degree,order,c,s"),
            ("mu_m3_s2 = four\n", "1:12:", "\"four\""),
            ("mu_m3_s2 =  -4\n", "1:13:", "positive"),
            ("radius_m = inf\n", "1:12:", "finite"),
            ("radius_m = 1\nradius_m = 1\n", "2:1:", "twice"),
            (&format!("{head}2,0,1e-3\n"), "4:9:", "3 columns"),
            (&format!("{head}2,0,1e-3,0,7\n"), "4:12:", "5 columns"),
            (
                &format!("{head}2.0,0,1e-3,0\n"),
                "4:1:",
                "degree is \"2.0\": a whole number",
            ),
            (&format!("{head}2,-1,1e-3,0\n"), "4:3:", "order is \"-1\""),
            (&format!("{head}2, 3,1e-3,0\n"), "4:4:", "order 3 of degree 2"),
            (&format!("{head}2,0,-1D-3,0\n"), "4:5:", "c is \"-1D-3\""),
            (&format!("{head}2,1,0,NaN\n"), "4:7:", "s is \"NaN\": a finite number"),
            (&format!("{head}2,0,0,1\n"), "4:7:", "order 0 is 1"),
            (&format!("{head}0,0,1.5,0\n"), "4:5:", "C_00 is 1.5"),
            (&format!("{head}2,0,0,0\n\n2,0,0,0\n"), "6:1:", "first in line 4"),
        ] {
            let error = parse(text).unwrap_err().to_string();
            assert!(error.starts_with(&format!("field.csv:{place}")), "{error}");
            assert!(error.contains(said), "{said}: {error}");
        }
        for (text, said) in [
            ("mu_m3_s2 = 1\n", "no line \"degree,order,c,s\""),
            ("radius_m = 1\ndegree,order,c,s\n2,0,0,0\n", "no \"mu_m3_s2 = ...\""),
            ("mu_m3_s2 = 1\ndegree,order,c,s\n2,0,0,0\n", "no \"radius_m = ...\""),
            (head, "no coefficients"),
            (&format!("{head}3,0,0,0\n"), "degree 2 and order 0 is missing"),
            (&format!("{head}2,0,0,0\n2,2,0,0\n"), "degree 2 and order 1 is missing"),
        ] {
            let error = parse(text).unwrap_err().to_string();
            assert!(
                error.starts_with("field.csv: ") && error.contains(said),
                "{said}: {error}"
            );
        }
    }

    proptest::proptest! {
        #[test]
        fn no_text_is_too_strange(text in "(mu_m3_s2|radius_m|degree,order,c,s|[0-9]{1,2}|[ =,.\n#e\u{e9}-])*") {
            // Columns count characters, slices bytes.
            let _ = parse(&text);
            let _ = parse(&format!("mu_m3_s2=1\nradius_m=1\n{HEADER}\n{text}"));
        }
    }
}
