//! What a model is to an exporter: the [`Model`] trait and the facts around it.

use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;
use uuid::Uuid;

use crate::definition::{DefinitionError, is_identifier};
use crate::log::Log;
use crate::table::Table;
use crate::xml::Element;

/// Why a model could not initialise or step. The host's log shows it with its chain of sources.
pub type ModelError = Box<dyn std::error::Error + Send + Sync>;

/// A simulation model that can be exported as a co-simulation slave.
///
/// A value of the type is the whole state of one instance: cloning it saves the state, and serde turns it into bytes, so
/// nothing that a later output depends on may live outside it or be skipped by serde, except for the folder of
/// [`set_resources`](Self::set_resources). A saved state may be set on several instances, in several threads at once, so it is read by
/// all of them.
pub trait Model: Clone + Serialize + DeserializeOwned + Send + Sync + 'static {
    /// Name, version and defaults of the FMU; kept by the model crate in a `OnceLock`.
    fn info() -> &'static ModelInfo;

    /// The variables; kept by the model crate in a `OnceLock`.
    fn table() -> &'static Table<Self>;

    /// A model whose variables have not been set. The start column of the table is applied to it right after.
    fn blank() -> Self;

    /// Takes note of the folder with the FMU's resources, `None` where there is none: after the start column has been applied, at
    /// creation and at every reset, and after a saved state has been restored. It belongs to the instance, not to its state: serde
    /// should skip it.
    fn set_resources(&mut self, _folder: Option<&Path>) {}

    /// The identifier of an FMU that its resources make another than the one whose identifier is `own`; `None` when they do not.
    fn identifier_with(_own: &str, _resources: &Path) -> Option<String> {
        None
    }

    /// Checks the parameters and computes the initial outputs.
    ///
    /// Called when initialization begins, and once more before a get and when it ends whenever a variable was set since. It
    /// must therefore be repeatable: begin from the variables, never from what an earlier call
    /// left behind.
    ///
    /// # Errors
    /// When initialization begins or ends, any error puts the instance into the failed phase; only a reset or an earlier state brings it
    /// back. Before a get, it refuses the get: a host may set one element of an array after the other and look in between.
    fn initialise(&mut self, experiment: &Experiment, log: &mut Log<'_>) -> Result<(), ModelError>;

    /// Called once when initialization has ended: the place to say what begins.
    fn initialised(&self, _experiment: &Experiment, _log: &mut Log<'_>) {}

    /// Says why a step from `t` to `t + h` (s) cannot be taken, before any is begun: one that is longer than the model can compute
    /// in reasonable time, or one with inputs that make no sense.
    ///
    /// # Errors
    /// Any error refuses the call, and the instance stays as it was.
    fn check_step(&self, _t: f64, _h: f64) -> Result<(), ModelError> {
        Ok(())
    }

    /// Advances from `t` to `t + h` (s, `h > 0`, both finite); `t` agrees with the end of the last step.
    ///
    /// # Errors
    /// Any error puts the instance into the failed phase; only a reset or an earlier state brings it back.
    fn do_step(&mut self, t: f64, h: f64, log: &mut Log<'_>) -> Result<(), ModelError>;

    /// Called once at the end of the simulation. Outputs stay readable after it.
    fn terminate(&mut self, _log: &mut Log<'_>) {}
}

/// What the host said about the simulation to come.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, serde::Deserialize)]
pub struct Experiment {
    /// Start of the simulation, s.
    pub start_time: f64,
    /// End of the simulation, s. Advisory: steps past it are answered.
    pub stop_time: Option<f64>,
    /// Relative tolerance for error-controlled slaves.
    pub tolerance: Option<f64>,
}

/// Facts about an FMU that stand in the head of its description. An empty text is left out there.
#[derive(Debug, Clone)]
pub struct ModelInfo {
    /// Name for people, e.g. `fmu-nav`; also the name of the `.fmu` file.
    pub model_name: &'static str,
    /// Name of the library in `binaries/<platform>/`, a C identifier, e.g. `fmu_nav`.
    pub model_identifier: &'static str,
    /// One sentence.
    pub description: &'static str,
    /// Version of the model, normally `env!("CARGO_PKG_VERSION")`; it is part of what ties a library to its description.
    pub version: &'static str,
    /// GUID made by the build from everything that the library is built from; that of the FMU follows from it and the description,
    /// or with `None` from the description alone.
    pub guid: Option<Uuid>,
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
    /// Relative tolerance that is asked for by default; a model of fixed steps does not look at it.
    pub default_tolerance: f64,
    /// What particular tools want to know.
    pub vendor_annotations: Vec<VendorAnnotation>,
}

impl Default for ModelInfo {
    /// Nothing said, but for a tolerance of 1e-6.
    fn default() -> Self {
        Self {
            model_name: "",
            model_identifier: "",
            description: "",
            version: "",
            guid: None,
            author: "",
            copyright: "",
            license: "",
            default_stop: 0.0,
            default_step: 0.0,
            default_tolerance: 1e-6,
            vendor_annotations: Vec::new(),
        }
    }
}

impl ModelInfo {
    /// Whether an FMU can be made with these facts.
    ///
    /// # Errors
    /// The first fact that is missing or unfit.
    pub fn check(&self) -> Result<(), DefinitionError> {
        if self.model_name.is_empty() {
            return Err(DefinitionError::NoModelName);
        }
        if !is_identifier(self.model_identifier) {
            return Err(DefinitionError::BadIdentifier {
                identifier: self.model_identifier.to_owned(),
            });
        }
        let positive = |seconds: f64| seconds.is_finite() && seconds > 0.0;
        if !positive(self.default_stop) || !positive(self.default_step) {
            return Err(DefinitionError::BadExperiment {
                stop: self.default_stop,
                step: self.default_step,
            });
        }
        self.vendor_annotations
            .iter()
            .try_for_each(|annotation| annotation.content().map(drop))
    }
}

/// What one tool is told; the other tools pass over it.
#[derive(Debug, Clone)]
pub struct VendorAnnotation {
    tool: &'static str,
    content: Result<Element, String>,
}

impl VendorAnnotation {
    /// For the tool of this name, one element.
    pub fn new(tool: &'static str, content: Element) -> Self {
        Self {
            tool,
            content: Ok(content),
        }
    }

    /// For the tool of this name, a value that serde makes one element of, in the way of `quick-xml`: the type's name is
    /// the element's, fields renamed to `@name` are attributes, other fields child elements.
    ///
    /// A value that is no element is a mistake in the definition, which [`ModelInfo::check`] reports.
    pub fn of(tool: &'static str, value: &impl Serialize) -> Self {
        let text = quick_xml::se::to_string(value).map_err(|error| error.to_string());
        let content = text.and_then(|text| Element::parse(&text).map_err(|error| error.to_string()));
        Self { tool, content }
    }

    /// Name of the tool that reads it.
    pub fn tool(&self) -> &'static str {
        self.tool
    }

    /// What stands inside.
    ///
    /// # Errors
    /// [`DefinitionError::BadAnnotation`] if the value it was made of is no element.
    pub fn content(&self) -> Result<&Element, DefinitionError> {
        self.content.as_ref().map_err(|reason| DefinitionError::BadAnnotation {
            tool: self.tool,
            reason: reason.clone(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn facts_are_checked() {
        let good = || ModelInfo {
            model_name: "a b",
            model_identifier: "a_b1",
            default_stop: 1.0,
            default_step: 0.5,
            ..ModelInfo::default()
        };
        assert_eq!(good().check(), Ok(()));
        let nameless = ModelInfo {
            model_name: "",
            ..good()
        };
        assert_eq!(nameless.check(), Err(DefinitionError::NoModelName));
        for model_identifier in ["", "a-b", "1a", "a b", "\u{e4}"] {
            let identifier = model_identifier.to_owned();
            let info = ModelInfo {
                model_identifier,
                ..good()
            };
            assert_eq!(info.check(), Err(DefinitionError::BadIdentifier { identifier }));
        }
        for (default_stop, default_step) in [(0.0, 0.5), (1.0, 0.0), (f64::INFINITY, 1.0)] {
            let info = ModelInfo {
                default_stop,
                default_step,
                ..good()
            };
            let (stop, step) = (default_stop, default_step);
            assert_eq!(info.check(), Err(DefinitionError::BadExperiment { stop, step }));
        }
    }

    #[test]
    fn an_annotation_is_written_by_hand_or_by_serde() {
        #[derive(Serialize)]
        struct Note {
            #[serde(rename = "@text")]
            text: &'static str,
            #[serde(rename = "Line")]
            lines: Vec<Note>,
        }
        let line = |text| Note {
            text,
            lines: Vec::new(),
        };
        let note = Note {
            text: "a < 'b' & \"c\"",
            lines: vec![line("1"), line("2")],
        };
        let by_hand = Element::new("Note").attribute("text", note.text).children([
            Element::new("Line").attribute("text", "1"),
            Element::new("Line").attribute("text", "2"),
        ]);
        let by_serde = VendorAnnotation::of("bench", &note);
        assert_eq!(by_serde.content(), Ok(&by_hand));
        assert_eq!(VendorAnnotation::new("bench", by_hand.clone()).content(), Ok(&by_hand));

        let no_element = VendorAnnotation::of("bench", &7);
        assert!(matches!(
            no_element.content(),
            Err(DefinitionError::BadAnnotation { tool: "bench", .. })
        ));
        let info = ModelInfo {
            model_name: "a",
            model_identifier: "a",
            default_stop: 1.0,
            default_step: 1.0,
            vendor_annotations: vec![by_serde, no_element],
            ..ModelInfo::default()
        };
        assert!(matches!(info.check(), Err(DefinitionError::BadAnnotation { .. })));
    }
}
