//! The JSON schema of the mission file, for editors.

use super::Mission;

/// The schema, as JSON text.
pub fn schema() -> String {
    let schema = schemars::schema_for!(Mission);
    format!("{:#}\n", schema.to_value())
}
