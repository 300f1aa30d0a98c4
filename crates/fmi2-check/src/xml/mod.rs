//! modelDescription.xml as XML: a tree of it, and what the schema says.

pub(crate) mod conform;
pub(crate) mod lexical;
pub(crate) mod schema;
pub(crate) mod tree;
