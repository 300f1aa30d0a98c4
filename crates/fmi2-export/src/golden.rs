//! The description as a text, its GUID, and the committed file that must be that text.

use std::path::Path;

use fmi_export::{GoldenError, description};
use fmi_model::{DefinitionError, Model};
use uuid::Uuid;

use crate::version::Fmi2;

/// `modelDescription.xml` of `M`, see [`fmi_export::description::render`].
///
/// # Errors
/// The first mistake in the table or in [`ModelInfo`](fmi_model::ModelInfo).
pub fn render<M: Model>() -> Result<String, DefinitionError> {
    description::render::<Fmi2, M>()
}

/// GUID of `M`, see [`fmi_export::description::guid`].
///
/// # Errors
/// The first mistake in the table or in [`ModelInfo`](fmi_model::ModelInfo).
pub fn guid<M: Model>() -> Result<Uuid, DefinitionError> {
    description::guid::<Fmi2, M>()
}

/// Holds a committed description against that of `M`, see [`fmi_export::golden_check`].
///
/// # Errors
/// A mistake in the definition, a file that cannot be read or written, or what differs.
pub fn golden_check<M: Model>(path: &Path) -> Result<(), GoldenError> {
    fmi_export::golden_check::<Fmi2, M>(path)
}
