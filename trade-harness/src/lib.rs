//! The trade study's command line: Monte Carlo studies of navigation filters, searches for their best parameters, and the
//! papers rerun.
//!
//! What a study is and how it runs is in `study`; statistics are in `stats`, loading and stepping in `fmi2-import` and
//! `cosim`. Here a command line becomes a [`study::Plan`], and results become tables. No filter lives here and no world: the
//! one model of motion in use is the Clohessy-Wiltshire solution of `astro`, which [`reproduce`] holds beside the truth,
//! since a paper quotes its drift.
//!
//! Start reading at [`commands`], which is what the command line offers; [`report`] writes the tables, [`tuning`] searches
//! for a filter's best parameters, [`regret`] holds laws against the best constant, [`claims`] and [`reproduce`] hold what the papers print beside what the studies find, and
//! [`pack`] makes our FMUs, and [`structure`] one system of them and a study of anybody's.

pub mod bound;
pub mod claims;
pub mod cli;
pub mod commands;
pub mod digest;
pub mod error;
pub mod format;
pub mod output;
pub mod pack;
#[cfg_attr(not(feature = "parquet"), path = "no_parquet.rs")]
pub mod parquet;
pub mod regret;
pub mod report;
pub mod reproduce;
pub mod requirements;
pub mod store;
pub mod structure;
pub mod temporary;
pub mod tuning;

pub use error::HarnessError;
