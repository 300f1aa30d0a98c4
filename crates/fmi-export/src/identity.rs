//! What ties a library to its description, computed once for each model of a library.

use std::sync::OnceLock;

use fmi_model::{DefinitionError, Model, Seal};
use uuid::Uuid;

use crate::description::guid;
use crate::version::Version;

/// Room for the GUID of one model.
#[derive(Debug, Default)]
pub struct GuidCell(OnceLock<Uuid>);

impl GuidCell {
    /// An empty cell.
    pub const fn new() -> Self {
        Self(OnceLock::new())
    }
}

/// A model with a place for its GUID in a version of the standard, which generic functions cannot have. The export macro of that
/// version implements it.
pub trait Exported<V: Version>: Model {
    /// The place; one for each type and version.
    fn guid_cell() -> &'static GuidCell;
}

/// The GUID of `M`, rendered and hashed at the first call only.
pub(crate) fn own_guid<V: Version, M: Exported<V>>() -> Result<Uuid, DefinitionError> {
    let cell = &M::guid_cell().0;
    if let Some(guid) = cell.get() {
        return Ok(*guid);
    }
    let guid = guid::<V, M>()?;
    Ok(*cell.get_or_init(|| guid))
}

/// What marks the serialized states of an FMU with this identifier.
pub(crate) fn seal<V: Version>(identity: Uuid) -> Seal {
    Seal {
        magic: [b'F', b'M', b'U', V::DIGIT, b'C', b'S', b's', b't'],
        tool: V::TOOL,
        guid: identity,
    }
}
