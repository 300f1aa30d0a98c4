//! Writes a table row by row.

use std::sync::Arc;

use crate::definition::{DefinitionError, check_name, check_row};
use crate::kind::{Boolean, ByElement, Enumeration, Integer, Kind, Real, Text};
use crate::table::Table;
use crate::variable::{
    Access, Causality, Each, EnumerationItem, EnumerationType, Read, Shape, Variability, Variable, Write,
};

/// Collects the rows of a [`Table`]. The order of the calls is the order of the description and of the value references.
///
/// ```
/// # use fmi_model::{Shape, TableBuilder};
/// # struct Nav { gate: f64, r_tc: [f64; 3] }
/// let mut t = TableBuilder::<Nav>::new();
/// t.real("accelerometer.gate")
///     .parameter()
///     .unit("m/s2")
///     .min(0.0)
///     .start(1e-4)
///     .about("readings below this norm observe the bias")
///     .rw(|m| m.gate, |m, v| m.gate = v);
/// t.real("est.r_tc_n")
///     .output()
///     .unit("m")
///     .about("target relative to chaser, inertial axes")
///     .vector(3, |m, i| m.r_tc[i]);
/// let table = t.build();
/// assert_eq!(table.rows()[1].shape, Shape::Vector(3));
/// assert_eq!(table.find("est.r_tc_n[1]"), Some(1));
/// ```
///
/// A mistake in a row (a name used twice, a parameter without a start value, an unknown unit) is kept with the table, see
/// [`Table::defect`]: whoever describes the model or makes an instance of it refuses with that reason.
#[derive(Debug)]
pub struct TableBuilder<M> {
    rows: Vec<Variable<M>>,
    /// Entries of all rows so far.
    entries: u32,
    types: Vec<Arc<EnumerationType>>,
    defect: Option<DefinitionError>,
}

impl<M> Default for TableBuilder<M> {
    fn default() -> Self {
        Self::new()
    }
}

impl<M> TableBuilder<M> {
    /// An empty table.
    pub fn new() -> Self {
        Self {
            rows: Vec::new(),
            entries: 0,
            types: Vec::new(),
            defect: None,
        }
    }

    /// Declares an enumeration: name, a sentence, and the items with a sentence each. Values count from 1.
    pub fn enumeration_type<N, A>(
        &mut self,
        name: impl Into<String>,
        about: impl Into<String>,
        items: impl IntoIterator<Item = (N, A)>,
    ) where
        N: Into<String>,
        A: Into<String>,
    {
        let declared = EnumerationType {
            name: name.into(),
            about: about.into(),
            items: items
                .into_iter()
                .map(|(name, about)| EnumerationItem {
                    name: name.into(),
                    about: about.into(),
                })
                .collect(),
        };
        if let Some(defect) = self.type_defect(&declared) {
            self.defect.get_or_insert(defect);
        }
        self.types.push(Arc::new(declared));
    }

    /// A Real variable, SI.
    pub fn real(&mut self, name: impl Into<String>) -> Row<'_, M, Real> {
        Row::new(self, name, Real::default())
    }

    /// An Integer variable.
    pub fn integer(&mut self, name: impl Into<String>) -> Row<'_, M, Integer> {
        Row::new(self, name, Integer::default())
    }

    /// A Boolean variable.
    pub fn boolean(&mut self, name: impl Into<String>) -> Row<'_, M, Boolean> {
        Row::new(self, name, Boolean)
    }

    /// A String variable.
    pub fn string(&mut self, name: impl Into<String>) -> Row<'_, M, Text> {
        Row::new(self, name, Text)
    }

    /// A variable of the enumeration `type_name`, which has been declared before; read and written as `i32` counted from 1.
    pub fn enumeration(&mut self, name: impl Into<String>, type_name: &str) -> Row<'_, M, Enumeration> {
        let name = name.into();
        let declared = match self.types.iter().find(|declared| declared.name == type_name) {
            Some(declared) => Arc::clone(declared),
            None => {
                self.defect.get_or_insert_with(|| DefinitionError::UnknownEnumeration {
                    name: name.clone(),
                    type_name: type_name.to_owned(),
                });
                Arc::new(EnumerationType {
                    name: type_name.to_owned(),
                    about: String::new(),
                    items: Vec::new(),
                })
            }
        };
        Row::new(self, name, Enumeration { declared })
    }

    /// The finished table.
    pub fn build(self) -> Table<M> {
        Table::new(self.rows, self.types, self.defect)
    }

    fn type_defect(&self, declared: &EnumerationType) -> Option<DefinitionError> {
        let taken = self.types.iter().any(|other| other.name == declared.name);
        let mut items: Vec<_> = declared.items.iter().map(|item| &item.name).collect();
        items.sort();
        let count = items.len();
        items.dedup();
        (taken || count == 0 || items.len() < count).then(|| DefinitionError::BadEnumeration {
            type_name: declared.name.clone(),
        })
    }

    fn push(&mut self, row: Variable<M>) {
        if let Some(defect) = check_name(&row.name).or_else(|| check_row(&row)) {
            self.defect.get_or_insert(defect);
        }
        // More entries than this do not fit into memory.
        self.entries = self
            .entries
            .saturating_add(u32::try_from(row.shape.count()).unwrap_or(u32::MAX));
        self.rows.push(row);
    }
}

/// A row being written: attributes in any order, then one of [`get`](Self::get), [`rw`](Self::rw), [`vector`](Self::vector),
/// [`vector_rw`](Self::vector_rw), [`matrix`](Self::matrix), [`matrix_rw`](Self::matrix_rw), which puts it into the table.
#[must_use = "a row enters the table by get, rw, vector, vector_rw, matrix or matrix_rw"]
pub struct Row<'t, M, K: Kind> {
    builder: &'t mut TableBuilder<M>,
    name: String,
    kind: K,
    causality: Causality,
    discrete: bool,
    about: ByElement<String>,
    start: Option<ByElement<K::Value>>,
    initial_inputs: Vec<&'static str>,
}

impl<'t, M, K: Kind> Row<'t, M, K> {
    fn new(builder: &'t mut TableBuilder<M>, name: impl Into<String>, kind: K) -> Self {
        Self {
            builder,
            name: name.into(),
            kind,
            causality: Causality::Local,
            discrete: false,
            about: ByElement::Same(String::new()),
            start: None,
            initial_inputs: Vec::new(),
        }
    }

    /// Set before the first step, then fixed. Needs a start value and a setter.
    pub fn parameter(mut self) -> Self {
        self.causality = Causality::Parameter;
        self
    }

    /// Read; follows from parameters at initialization, then fixed.
    pub fn calculated_parameter(mut self) -> Self {
        self.causality = Causality::CalculatedParameter;
        self
    }

    /// Set between steps. Needs a setter; starts at 0, false, "" or the first item unless told otherwise.
    pub fn input(mut self) -> Self {
        self.causality = Causality::Input;
        self
    }

    /// Read, meant for connections and result files.
    pub fn output(mut self) -> Self {
        self.causality = Causality::Output;
        self
    }

    /// Read, not offered for connections. This is the default.
    pub fn local(mut self) -> Self {
        self.causality = Causality::Local;
        self
    }

    /// Changes only at communication points. Only a Real needs to say so: every other type is discrete anyway.
    pub fn discrete(mut self) -> Self {
        self.discrete = true;
        self
    }

    /// One sentence about the variable.
    pub fn about(mut self, about: impl Into<String>) -> Self {
        self.about = ByElement::Same(about.into());
        self
    }

    /// One sentence about each element, by its row-major index from 0.
    pub fn about_by(mut self, about: impl Fn(usize) -> String + 'static) -> Self {
        self.about = ByElement::By(Box::new(about));
        self
    }

    /// Start value (of every element).
    pub fn start(mut self, start: impl Into<K::Value>) -> Self {
        self.start = Some(ByElement::Same(start.into()));
        self
    }

    /// Start value of each element, by its row-major index from 0.
    pub fn start_by(mut self, start: impl Fn(usize) -> K::Value + 'static) -> Self {
        self.start = Some(ByElement::By(Box::new(start)));
        self
    }

    /// Says that the value depends on this input (named without indices) already at initialization. The description tells
    /// masters, which then set the input before they read the value. In steps no output depends on an input set at the same time.
    pub fn initially_from(mut self, input: &'static str) -> Self {
        self.initial_inputs.push(input);
        self
    }

    /// A scalar that is only read.
    pub fn get(self, get: impl Fn(&M) -> K::Value + Send + Sync + 'static) {
        self.put(Shape::Scalar, Box::new(move |m, _| get(m)), None);
    }

    /// A scalar that is read and set.
    pub fn rw(
        self,
        get: impl Fn(&M) -> K::Value + Send + Sync + 'static,
        set: impl Fn(&mut M, K::Value) + Send + Sync + 'static,
    ) {
        self.put(
            Shape::Scalar,
            Box::new(move |m, _| get(m)),
            Some(Box::new(move |m, _, value| set(m, value))),
        );
    }

    /// A vector `name[1]`..`name[n]` that is only read; `get` takes the index from 0.
    pub fn vector(self, n: usize, get: impl Fn(&M, usize) -> K::Value + Send + Sync + 'static) {
        self.put(Shape::Vector(n), Box::new(get), None);
    }

    /// A vector `name[1]`..`name[n]` that is read and set; the closures take the index from 0.
    pub fn vector_rw(
        self,
        n: usize,
        get: impl Fn(&M, usize) -> K::Value + Send + Sync + 'static,
        set: impl Fn(&mut M, usize, K::Value) + Send + Sync + 'static,
    ) {
        self.put(Shape::Vector(n), Box::new(get), Some(Box::new(set)));
    }

    /// A matrix `name[1,1]`..`name[rows,cols]`, row by row, that is only read; `get` takes row and column from 0.
    pub fn matrix(self, rows: usize, cols: usize, get: impl Fn(&M, usize, usize) -> K::Value + Send + Sync + 'static) {
        self.put(
            Shape::Matrix(rows, cols),
            Box::new(move |m, k| get(m, k / cols, k % cols)),
            None,
        );
    }

    /// A matrix `name[1,1]`..`name[rows,cols]`, row by row, that is read and set; the closures take row and column from 0.
    pub fn matrix_rw(
        self,
        rows: usize,
        cols: usize,
        get: impl Fn(&M, usize, usize) -> K::Value + Send + Sync + 'static,
        set: impl Fn(&mut M, usize, usize, K::Value) + Send + Sync + 'static,
    ) {
        self.put(
            Shape::Matrix(rows, cols),
            Box::new(move |m, k| get(m, k / cols, k % cols)),
            Some(Box::new(move |m, k, value| set(m, k / cols, k % cols, value))),
        );
    }

    fn put(self, shape: Shape, read: Read<M, K::Value>, write: Option<Write<M, K::Value>>) {
        let variability = match self.causality {
            Causality::Parameter | Causality::CalculatedParameter => Variability::Fixed,
            _ if K::CONTINUOUS && !self.discrete => Variability::Continuous,
            _ => Variability::Discrete,
        };
        let start = match self.start {
            Some(start) => Some(start.over(shape)),
            None if self.causality == Causality::Input => Some(Each::Same(self.kind.neutral())),
            None => None,
        };
        let access = Access { read, write, start };
        self.builder.push(Variable {
            name: self.name,
            shape,
            first: self.builder.entries,
            about: self.about.over(shape),
            causality: self.causality,
            variability,
            initial_inputs: self.initial_inputs,
            typed: self.kind.typed(shape, access),
        });
    }
}

impl<M> Row<'_, M, Real> {
    /// Unit, spelt like `m/s2`, `m2/s5`, `rad`, `m/s^2.5`, `1`, from the SI base units and `rad`.
    pub fn unit(mut self, unit: impl Into<String>) -> Self {
        self.kind.unit = Some(ByElement::Same(unit.into()));
        self
    }

    /// Unit of each element, by its row-major index from 0.
    pub fn unit_by<U: Into<String>>(mut self, unit: impl Fn(usize) -> U + 'static) -> Self {
        self.kind.unit = Some(ByElement::By(Box::new(move |element| unit(element).into())));
        self
    }

    /// Order of magnitude of each element, by its row-major index from 0.
    pub fn nominal_by(mut self, nominal: impl Fn(usize) -> f64 + 'static) -> Self {
        self.kind.nominal = Some(ByElement::By(Box::new(nominal)));
        self
    }

    /// Infinities and NaN may be set, too: an input that another one says to be of no use at times.
    pub fn any_number(mut self) -> Self {
        self.kind.bounds.any_number = true;
        self
    }

    /// Unit for people: `deg` for `rad`, `deg/s` for `rad/s`. Values stay in the unit.
    pub fn display_unit(mut self, display_unit: &'static str) -> Self {
        self.kind.display_unit = Some(display_unit);
        self
    }
}

/// Rows whose values have an order.
macro_rules! bounded {
    ($kind:ty, $value:ty, $minus_one:expr) => {
        impl<M> Row<'_, M, $kind> {
            /// Least value that may be set.
            pub fn min(mut self, min: $value) -> Self {
                self.kind.bounds.min = Some(min);
                self
            }

            /// Greatest value that may be set.
            pub fn max(mut self, max: $value) -> Self {
                self.kind.bounds.max = Some(max);
                self
            }

            /// Only values above 0 may be set. A description, which has no way to say it, declares min = 0.
            pub fn positive(mut self) -> Self {
                self.kind.bounds.positive = true;
                self
            }

            /// Starts at -1, which is also its declared min and means "the mission's own"; any other value must keep to
            /// the other bounds, of which one must exclude -1.
            pub fn own_default(mut self) -> Self {
                self.kind.bounds.own_default = true;
                self.start($minus_one)
            }
        }
    };
}
bounded!(Real, f64, -1.0);
bounded!(Integer, i32, -1);
