//! What FMI 3.0 adds to what all versions do.

use fmi_export::Version;
use fmi_export::description::{head, log_categories};
use fmi_model::{DefinitionError, Element, ModelInfo, Table};

use crate::description::sections;
use crate::log::Sink;

/// FMI 3.0.
#[derive(Debug)]
pub enum Fmi3 {}

impl Version for Fmi3 {
    type Sink = Sink;

    const FMI_VERSION: &'static str = "3.0";
    const DIGIT: u8 = b'3';
    const PREFIX: &'static str = "fmi3";
    const TOOL: &'static str = env!("CARGO_PKG_NAME");
    const IDENTIFIER: &'static str = "instantiationToken";
    const IDENTIFIER_NAME: &'static str = "instantiation token";
    const STATE: &'static str = "FMUState";

    fn document<M>(info: &ModelInfo, table: &Table<M>, identifier: &str) -> Result<Element, DefinitionError> {
        let tool = concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION"));
        let head = head::<Self>(info, identifier, tool);
        Ok(head.children(sections(info, table, log_categories::<Self>())?))
    }
}
