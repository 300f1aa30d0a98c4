//! What can be wrong with a gravity field.

use thiserror::Error;

use super::format::MAX_DEGREE;

/// A gravity field that cannot be built, or a coefficient file that cannot be read.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FieldError {
    /// A constant is not a positive number.
    #[error("{name} {value}: give a positive, finite number in SI units")]
    Constant {
        /// Which one.
        name: &'static str,
        /// Value given, SI.
        value: f64,
    },
    /// The degree is beyond what this crate evaluates.
    #[error("degree {degree}: a field goes to degree {MAX_DEGREE} at most")]
    Degree {
        /// Degree asked for.
        degree: usize,
    },
    /// The order is above the degree.
    #[error("order {order} of a field of degree {degree}: the order is at most the degree")]
    Order {
        /// Degree asked for.
        degree: usize,
        /// Order asked for.
        order: usize,
    },
    /// A term outside the field.
    #[error("term of degree {n} and order {m}: this field has degrees 1 to {degree} and orders to {order} (C_00 is 1)")]
    NoSuchTerm {
        /// Degree of the term.
        n: usize,
        /// Order of the term.
        m: usize,
        /// Degree of the field.
        degree: usize,
        /// Order of the field.
        order: usize,
    },
    /// A coefficient is NaN or infinite.
    #[error("{name} of degree {n} and order {m} is {value}: give a finite number")]
    Coefficient {
        /// "C" or "S".
        name: &'static str,
        /// Degree.
        n: usize,
        /// Order.
        m: usize,
        /// Value given.
        value: f64,
    },
    /// A term that the field ought to have is not there.
    #[error("the term of degree {n} and order {m} is missing: write its zeros if it has none")]
    Missing {
        /// Degree of the first one missing.
        n: usize,
        /// Its order.
        m: usize,
    },
    /// More was asked for than the field has.
    #[error(
        "degree {degree} and order {order} were asked for: the field has degree {has_degree} and order {has_order}"
    )]
    Truncation {
        /// Degree asked for.
        degree: usize,
        /// Order asked for.
        order: usize,
        /// Degree of the field.
        has_degree: usize,
        /// Order of the field.
        has_order: usize,
    },
    /// No field of this name comes with the crate.
    #[error("no gravity field \"{name}\": one of {known}, or a coefficient file")]
    Unknown {
        /// Name asked for.
        name: String,
        /// Names there are.
        known: String,
    },
    /// The file cannot be read.
    #[error("{file}: cannot be read: {reason}")]
    Read {
        /// The file.
        file: String,
        /// What the system says.
        reason: String,
    },
    /// One place in the file is wrong.
    #[error("{file}:{line}:{column}: {fault}")]
    At {
        /// The file.
        file: String,
        /// Line, counted from 1.
        line: usize,
        /// Column of the first character that is wrong, counted from 1.
        column: usize,
        /// What is wrong.
        fault: Fault,
    },
    /// The file ends before its header.
    #[error("{file}: no line \"{}\"", super::format::HEADER)]
    NoHeader {
        /// The file.
        file: String,
    },
    /// A constant is not in the file.
    #[error("{file}: no \"{key} = ...\" before the header")]
    NoConstant {
        /// The file.
        file: String,
        /// Which constant.
        key: &'static str,
    },
    /// The file has no coefficients.
    #[error("{file}: no coefficients after the header")]
    Empty {
        /// The file.
        file: String,
    },
    /// The file goes beyond what this crate evaluates, and nobody asked for less.
    #[error("{file}: goes to degree {degree}: ask for degree {MAX_DEGREE} or less")]
    Beyond {
        /// The file.
        file: String,
        /// Its highest degree.
        degree: usize,
    },
    /// What the file holds is not the field asked for.
    #[error("{file}: {cause}")]
    InFile {
        /// The file.
        file: String,
        /// Why not.
        cause: Box<FieldError>,
    },
}

/// What is wrong with a line of a coefficient file.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Fault {
    /// A line before the header that is none of what may stand there.
    #[error(
        "\"{found}\": {} or the header \"{}\" stand here",
        super::format::constants(),
        super::format::HEADER
    )]
    Preamble {
        /// The line.
        found: String,
    },
    /// A constant for the second time.
    #[error("{key} is given twice")]
    RepeatedConstant {
        /// Which one.
        key: &'static str,
    },
    /// A constant that is not a positive number.
    #[error("{key} is \"{found}\": a positive, finite number such as 3.986e14")]
    Constant {
        /// Which one.
        key: &'static str,
        /// What stands there.
        found: String,
    },
    /// A row with too few or too many columns.
    #[error("{found} columns: a row has the four of \"{}\"", super::format::HEADER)]
    Columns {
        /// How many there are.
        found: usize,
    },
    /// A degree or order that is no whole number.
    #[error("{name} is \"{found}\": a whole number from 0 on")]
    Whole {
        /// "degree" or "order".
        name: &'static str,
        /// What stands there.
        found: String,
    },
    /// A coefficient that is no finite number.
    #[error("{name} is \"{found}\": a finite number such as -4.84e-4")]
    Number {
        /// "c" or "s".
        name: &'static str,
        /// What stands there.
        found: String,
    },
    /// A term that does not exist.
    #[error("order {order} of degree {degree}: the order is at most the degree")]
    Order {
        /// Degree in the row.
        degree: usize,
        /// Order in the row.
        order: usize,
    },
    /// A term for the second time.
    #[error("degree {degree}, order {order} for the second time; first in line {first}")]
    Repeated {
        /// Degree in the row.
        degree: usize,
        /// Order in the row.
        order: usize,
        /// Line of the first one.
        first: usize,
    },
    /// C_00 is not 1.
    #[error("C_00 is {found}: it is 1, and scales nothing; change mu_m3_s2 instead")]
    C00 {
        /// What stands there.
        found: f64,
    },
    /// S_n0 is not 0.
    #[error("S of order 0 is {found}: it multiplies sin 0; write 0")]
    Sn0 {
        /// What stands there.
        found: f64,
    },
}
