//! What a model is to this crate: the [`Model`] trait and the facts around it.

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::log::Log;
use crate::table::Table;
use crate::xml::Element;

/// Why a model could not initialise or step. The host's log shows it with its chain of sources.
pub type ModelError = Box<dyn std::error::Error + Send + Sync>;

/// A simulation model that can be exported as a co-simulation slave.
///
/// A value of the type is the whole state of one instance: cloning it is `fmi2GetFMUstate`, and serde turns it into the
/// bytes of `fmi2SerializeFMUstate`, so nothing that a later output depends on may live outside it or be skipped by serde.
pub trait Model: Clone + Serialize + DeserializeOwned + Send + 'static {
    /// Name, version and defaults of the FMU; kept by the model crate in a `OnceLock`.
    fn info() -> &'static ModelInfo;

    /// The variables; kept by the model crate in a `OnceLock`.
    fn table() -> &'static Table<Self>;

    /// A model whose variables have not been set. The start column of the table is applied to it right after.
    fn blank() -> Self;

    /// Checks the parameters and computes the initial outputs.
    ///
    /// Called at `fmi2EnterInitializationMode`, and once more before a get and at `fmi2ExitInitializationMode` whenever a
    /// variable was set since. It must therefore be repeatable: begin from the variables, never from what an earlier call
    /// left behind.
    ///
    /// # Errors
    /// Any error puts the instance into the failed phase; only a reset or an earlier state brings it back.
    fn initialise(&mut self, experiment: &Experiment, log: &mut Log<'_>) -> Result<(), ModelError>;

    /// Advances from `t` to `t + h` (s, `h > 0`, both finite); `t` agrees with the end of the last step.
    ///
    /// # Errors
    /// Any error puts the instance into the failed phase; only a reset or an earlier state brings it back.
    fn do_step(&mut self, t: f64, h: f64, log: &mut Log<'_>) -> Result<(), ModelError>;

    /// Called once by `fmi2Terminate`. Outputs stay readable after it.
    fn terminate(&mut self, _log: &mut Log<'_>) {}
}

/// What the host said in `fmi2SetupExperiment`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, serde::Deserialize)]
pub struct Experiment {
    /// Start of the simulation, s.
    pub start_time: f64,
    /// End of the simulation, s. Advisory: steps past it are answered.
    pub stop_time: Option<f64>,
    /// Relative tolerance for error-controlled slaves.
    pub tolerance: Option<f64>,
}

/// Facts about an FMU that stand in the head of its `modelDescription.xml`. An empty text is left out there.
#[derive(Debug, Clone, Default)]
pub struct ModelInfo {
    /// Name for people, e.g. `fmu-nav`; also the name of the `.fmu` file.
    pub model_name: &'static str,
    /// Name of the library in `binaries/<platform>/`, a C identifier, e.g. `fmu_nav`.
    pub model_identifier: &'static str,
    /// One sentence.
    pub description: &'static str,
    /// Version of the model, normally `env!("CARGO_PKG_VERSION")`; it is part of the GUID.
    pub version: &'static str,
    /// Who wrote it.
    pub author: &'static str,
    /// Who owns it.
    pub copyright: &'static str,
    /// SPDX expression.
    pub license: &'static str,
    /// Default end of a simulation that starts at 0, s.
    pub default_stop: f64,
    /// Default communication step, s.
    pub default_step: f64,
    /// What particular tools want to know.
    pub vendor_annotations: Vec<VendorAnnotation>,
}

/// One `<Tool>` under `<VendorAnnotations>`.
#[derive(Debug, Clone)]
pub struct VendorAnnotation {
    /// Name of the tool that reads it.
    pub tool: &'static str,
    /// What stands inside: the schema permits one element.
    pub content: Element,
}
