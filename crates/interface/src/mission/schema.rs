//! The JSON schema of the mission file, for editors.

use super::Mission;

/// The schema, as JSON text.
pub fn schema() -> String {
    format!("{:#}\n", schema_value())
}

/// The schema.
pub fn schema_value() -> serde_json::Value {
    schemars::schema_for!(Mission).to_value()
}
