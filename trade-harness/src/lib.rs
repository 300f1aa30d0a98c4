//! Monte Carlo trade study of navigation filters, coupled through FMI 2.0.
//!
//! A study couples one truth FMU with one navigation FMU for each filter, repeats that over seeded runs on all cores,
//! and reduces the runs to tables. Truth and filters are known only through FMI and the variable names of the
//! interface, so anyone's FMU can take either place. No filter lives here and no world: the one model of motion in use is
//! the Clohessy-Wiltshire solution of `astro`, which [`reproduce`] holds beside the truth, since a paper quotes its drift.
//! Statistics are in `stats`, loading and stepping in `fmi2-import` and `cosim`.
//!
//! Start reading at [`study::Study`], then [`run::run_once`], which is one run; [`scenarios`] lists the worlds, [`tuning`]
//! searches for a filter's best parameters, [`reproduce`] holds what the papers print beside what the studies find, and
//! [`commands`] is what the command line offers.

pub mod bound;
pub mod cli;
pub mod commands;
pub mod error;
pub mod models;
mod ordered;
pub mod output;
pub mod pack;
mod packed;
pub mod report;
pub mod reproduce;
pub mod run;
pub mod scenarios;
pub mod score;
pub mod signals;
pub mod study;
pub mod tuning;

pub use error::HarnessError;
