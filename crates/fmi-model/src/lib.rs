//! A simulation model, its table of variables and its life cycle, apart from any version of FMI.
//!
//! Here: the [`Model`] trait, the [`Table`] of variables with their shapes, the checks of both, an [`Instance`] that does what
//! the calls of the standard ask for, saved states, the log of a model, and the tree of XML that descriptions are written with.
//! Not here: C functions, the order in which a version of the standard allows them, its `modelDescription.xml`; see
//! `fmi2-export`.
//!
//! Start with [`Model`] and [`TableBuilder`]. An exporter renders [`Table::rows`] or, if its standard has no arrays,
//! [`Table::entries`], and drives an [`Instance`]:
//!
//! ```
//! use std::sync::OnceLock;
//!
//! use fmi_model::{Experiment, Instance, Log, Model, ModelError, ModelInfo, Shape, Table, TableBuilder};
//! use serde::{Deserialize, Serialize};
//!
//! /// Two tanks that fill at the same rate.
//! #[derive(Clone, Default, Serialize, Deserialize)]
//! struct Tanks {
//!     inflow: f64,
//!     level: [f64; 2],
//! }
//!
//! impl Model for Tanks {
//!     fn info() -> &'static ModelInfo {
//!         static INFO: OnceLock<ModelInfo> = OnceLock::new();
//!         INFO.get_or_init(|| ModelInfo {
//!             model_name: "tanks",
//!             model_identifier: "tanks",
//!             default_stop: 60.0,
//!             default_step: 1.0,
//!             ..ModelInfo::default()
//!         })
//!     }
//!
//!     fn table() -> &'static Table<Self> {
//!         static TABLE: OnceLock<Table<Tanks>> = OnceLock::new();
//!         TABLE.get_or_init(|| {
//!             let mut t = TableBuilder::new();
//!             t.real("inflow").input().unit("m3/s").rw(|m: &Tanks| m.inflow, |m, v| m.inflow = v);
//!             t.real("level").output().unit("m").vector(2, |m, i| m.level[i]);
//!             t.build()
//!         })
//!     }
//!
//!     fn blank() -> Self {
//!         Self::default()
//!     }
//!
//!     fn initialise(&mut self, _: &Experiment, _: &mut Log<'_>) -> Result<(), ModelError> {
//!         self.level = [0.0, 1.0];
//!         Ok(())
//!     }
//!
//!     fn do_step(&mut self, _t: f64, h: f64, _: &mut Log<'_>) -> Result<(), ModelError> {
//!         let area_m2 = 2.0;
//!         self.level.iter_mut().for_each(|level| *level += self.inflow / area_m2 * h);
//!         Ok(())
//!     }
//! }
//!
//! // A standard with arrays has two variables, one without has three.
//! assert_eq!(Tanks::table().rows()[1].shape, Shape::Vector(2));
//! let names: Vec<_> = Tanks::table().entries().map(|entry| entry.name()).collect();
//! assert_eq!(names, ["inflow", "level[1]", "level[2]"]);
//!
//! let (mut tanks, mut log) = (Instance::<Tanks>::new(), Log::silent());
//! tanks.setup_experiment(Experiment::default())?;
//! tanks.enter_initialization(&mut log)?;
//! tanks.exit_initialization(&mut log)?;
//! tanks.set(&[0], |_| 0.5)?;
//! tanks.do_step(0.0, 2.0, &mut log)?;
//! let mut levels = Vec::new();
//! tanks.get(&[1, 2], &mut log, |_, level: f64| levels.push(level))?;
//! assert_eq!(levels, [0.5, 1.5]);
//! # Ok::<(), fmi_model::InstanceError>(())
//! ```

mod bounds;
mod builder;
mod check;
mod definition;
mod error;
mod guard;
mod instance;
mod kind;
mod log;
mod model;
mod phase;
mod snapshot;
mod table;
mod unit;
mod variable;
mod xml;

pub use bounds::Bounds;
pub use builder::{Row, TableBuilder};
pub use check::Checked;
pub use definition::DefinitionError;
pub use error::InstanceError;
pub use guard::guarded;
pub use instance::Instance;
pub use kind::{Boolean, Enumeration, Integer, Kind, Real, Text};
pub use log::{Category, Listener, Log, Wanted};
pub use model::{Experiment, Model, ModelError, ModelInfo, VendorAnnotation};
pub use phase::Phase;
pub use snapshot::{Seal, Snapshot, braced};
pub use table::Table;
pub use unit::Unit;
pub use variable::{
    Access, Causality, Each, Entry, EnumerationItem, EnumerationType, Scalar, Shape, Typed, Variability, Variable,
};
pub use xml::{Element, XmlError, number};
