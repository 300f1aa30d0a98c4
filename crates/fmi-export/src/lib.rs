#![doc = include_str!("../README.md")]
//!
//! # Where to start
//!
//! With [`Version`], which says what a standard adds. Then [`call()`], through which every C function goes, and [`Instance`], what it
//! goes to. [`lifecycle`] and [`states`] hold the functions that are the same in every standard but for their names, [`memory`]
//! makes slices of pointers, [`description`] renders what two descriptions have in common.

mod call;
pub mod description;
mod error;
mod golden;
mod handle;
mod identity;
mod instance;
pub mod lifecycle;
mod log;
pub mod memory;
mod order;
pub mod states;
mod status;
mod version;

pub use call::call;
pub use error::CallError;
pub use golden::{GoldenError, golden_check};
pub use identity::{Exported, GuidCell};
pub use instance::{Answer, Instance};
pub use order::{ALIVE, Function};
pub use status::Status;
pub use version::{Sink, Version};
