//! The variables of a model the way FMI 3.0 writes them, arrays as arrays: what a table keeps for whoever renders it.
//!
//! `cargo run -p fmi-model --example arrays`

use std::io::{self, Write};

use fmi_model::{Access, Element, Scalar, Shape, TableBuilder, Typed, Variable, number};

/// An estimate: position and velocity, with their covariance.
#[derive(Default)]
struct Filter {
    gate: f64,
    measured: [f64; 3],
    x: [f64; 6],
    p: [[f64; 6]; 6],
}

fn main() -> io::Result<()> {
    let mut t = TableBuilder::<Filter>::new();
    t.real("gate")
        .parameter()
        .min(0.0)
        .start(9.0)
        .about("largest squared residual that is used, in variances")
        .rw(|m| m.gate, |m, v| m.gate = v);
    t.real("measured")
        .input()
        .unit("m")
        .vector_rw(3, |m, i| m.measured[i], |m, i, v| m.measured[i] = v);
    t.real("x")
        .output()
        .unit_by(|i| if i < 3 { "m" } else { "m/s" })
        .vector(6, |m, i| m.x[i]);
    t.real("p").output().matrix(6, 6, |m, i, j| m.p[i][j]);
    let table = t.build();

    let variables = Element::new("ModelVariables").children(table.rows().iter().map(variable));
    io::stdout().lock().write_all(variables.to_document().as_bytes())
}

/// A row as one variable. Its value reference is the number of its first entry, which no other row has.
fn variable(row: &Variable<Filter>) -> Element {
    let (name, start) = match &row.typed {
        Typed::Real { access, .. } => ("Float64", starts(row, access, |v| number(*v))),
        Typed::Integer { access, .. } => ("Int32", starts(row, access, i32::to_string)),
        Typed::Enumeration { access, .. } => ("Enumeration", starts(row, access, i32::to_string)),
        Typed::Boolean { access } => ("Boolean", starts(row, access, bool::to_string)),
        Typed::String { access } => ("String", starts(row, access, Clone::clone)),
    };
    // An array has one unit in FMI 3.0; where elements differ, none can be stated.
    let unit = match &row.typed {
        Typed::Real { unit: Some(unit), .. } => unit.shared().map_or("", String::as_str),
        _ => "",
    };
    Element::new(name)
        .attribute("name", &row.name)
        .attribute("valueReference", row.first.to_string())
        .attribute_if_any("description", row.about.shared().map_or("", String::as_str))
        .attribute("causality", row.causality.name())
        .attribute("variability", row.variability.name())
        .attribute_if_any("unit", unit)
        .attribute_if_any("start", &start)
        .children(dimensions(row.shape))
}

fn starts<T: Scalar>(row: &Variable<Filter>, access: &Access<Filter, T>, text: impl Fn(&T) -> String) -> String {
    let starts = (0..row.shape.count()).filter_map(|element| access.start(element));
    starts.map(text).collect::<Vec<_>>().join(" ")
}

fn dimensions(shape: Shape) -> Vec<Element> {
    let sizes = match shape {
        Shape::Scalar => vec![],
        Shape::Vector(n) => vec![n],
        Shape::Matrix(rows, columns) => vec![rows, columns],
    };
    let dimension = |size: &usize| Element::new("Dimension").attribute("start", size.to_string());
    sizes.iter().map(dimension).collect()
}
