//! Command line of the trade study; everything is in the library.

use std::process::ExitCode;

fn main() -> ExitCode {
    trade_harness::commands::run()
}
