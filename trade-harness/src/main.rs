//! Command line of the trade study; everything is in the library.

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    trade_harness::commands::execute(trade_harness::cli::Cli::parse())
}
