//! What FMI 2.0 adds to what all versions do.

use fmi_export::Version;
use fmi_export::description::{head, log_categories};
use fmi_model::{DefinitionError, Element, ModelInfo, Table};

use crate::description::sections;
use crate::log::Sink;

/// FMI 2.0.
#[derive(Debug)]
pub enum Fmi2 {}

impl Version for Fmi2 {
    type Sink = Sink;

    const FMI_VERSION: &'static str = "2.0";
    const DIGIT: u8 = b'2';
    const PREFIX: &'static str = "fmi2";
    const TOOL: &'static str = env!("CARGO_PKG_NAME");
    const IDENTIFIER: &'static str = "guid";
    const IDENTIFIER_NAME: &'static str = "GUID";
    const STATE: &'static str = "FMUstate";

    fn document<M>(info: &ModelInfo, table: &Table<M>, identifier: &str) -> Result<Element, DefinitionError> {
        let tool = concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION"));
        let head = head::<Self>(info, identifier, tool);
        Ok(head.children(sections(info, table, log_categories::<Self>())?))
    }
}
