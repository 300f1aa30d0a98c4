//! `regret`: how much worse a law is than the best constant, chosen in hindsight for each level of disturbance.
//!
//! Laws, and filters of constant noise, fly the same runs. Of those of constant noise the best counts whose NEES of position and
//! velocity says that it is honest; nobody could have flown it without knowing the level. A law's ratio is its RMSE over that of
//! this filter. Bounds fly beside them: filters that the truth tells what no filter knows, of each family the best of its values in
//! hindsight. No law can pass the one that is told all that pushes the target (`clairvoyant`); one that is told when, never how hard
//! (`times_known`), can be passed.

pub mod levels;
mod row;
mod shown;
mod trial;

pub use row::{COLUMNS, Kind, Row, render, told};
pub use shown::{LEGEND, markdown, table};
pub use trial::{MOST_NEES, Options, Trial, Tried};
