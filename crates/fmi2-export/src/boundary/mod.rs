//! The C functions, generic over the model; [`export_fmu!`](crate::export_fmu) forwards to them under their C names.
//!
//! Every function here is `unsafe` for one and the same reason: it trusts the host to keep its side of the FMI standard. That is,
//! a component is null or came from `fmi2Instantiate` of this FMU and has not been freed; a state is null or came from this FMU and has not been freed, and nobody frees it or writes to
//! its place meanwhile; an array has the number of elements that
//! is said; a string ends in NUL; none of that memory is used by anyone else during the call. What can be checked is checked: null
//! and misaligned pointers, and handles that were freed or belong to another FMU, as far as reading them tells.
#![allow(
    unsafe_code,
    reason = "the C boundary: raw pointers come in, slices and references go on"
)]
#![allow(
    clippy::missing_safety_doc,
    reason = "the contract is the same for all functions and stands in the header"
)]
#![allow(missing_docs, reason = "each function is that of the standard with the same name")]

mod lifecycle;
mod model_exchange;
mod states;
mod steps;
mod values;

pub use lifecycle::*;
pub use model_exchange::*;
pub use states::*;
pub use steps::*;
pub use values::*;
