//! What stands in a coefficient file, and how far a field goes: what reader and messages share.

/// Highest degree and order of a field.
pub const MAX_DEGREE: usize = 20;
/// Header of the rows.
pub(super) const HEADER: &str = "degree,order,c,s";
/// Names of the constants before it.
pub(super) const CONSTANTS: [&str; 2] = ["mu_m3_s2", "radius_m"];

/// The constants, as a message lists them.
pub(super) fn constants() -> String {
    CONSTANTS.map(|key| format!("\"{key} = ...\"")).join(", ")
}
