//! The command `restyle`.

use std::process::ExitCode;

fn main() -> ExitCode {
    restyle::cli::run()
}
