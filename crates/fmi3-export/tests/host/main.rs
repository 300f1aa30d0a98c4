//! An example FMU, driven through its C functions exactly as a C host would.

#![allow(clippy::float_cmp, reason = "the probe's numbers are exact in binary")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that fails shall say where")]

mod both;
mod creation;
mod description;
mod host;
mod life_cycle;
mod logging;
mod probe;
mod random_calls;
mod states;
mod values;
