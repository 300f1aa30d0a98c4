//! What ties a library to its description, computed once for each model of a library.

use std::sync::OnceLock;

use fmi_model::{DefinitionError, Model, Seal};
use uuid::Uuid;

use crate::description::guid;

/// Room for the GUID of one model.
#[derive(Debug, Default)]
pub struct GuidCell(OnceLock<Uuid>);

impl GuidCell {
    /// An empty cell.
    pub const fn new() -> Self {
        Self(OnceLock::new())
    }
}

/// A model with a place for its GUID, which generic functions cannot have. [`export_fmu!`](crate::export_fmu) implements it.
pub trait Exported: Model {
    /// The place; one for each type.
    fn guid_cell() -> &'static GuidCell;
}

/// The GUID of `M`, rendered and hashed at the first call only.
pub(crate) fn own_guid<M: Exported>() -> Result<Uuid, DefinitionError> {
    let cell = &M::guid_cell().0;
    if let Some(guid) = cell.get() {
        return Ok(*guid);
    }
    let guid = guid::<M>()?;
    Ok(*cell.get_or_init(|| guid))
}

/// What marks the serialized states of `M`.
pub(crate) fn seal<M: Exported>() -> Result<Seal, DefinitionError> {
    Ok(Seal {
        magic: *b"FMU2CSst",
        tool: env!("CARGO_PKG_NAME"),
        guid: own_guid::<M>()?,
    })
}
