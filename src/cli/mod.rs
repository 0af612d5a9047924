//! The command line: one file per subcommand; errors are printed once, here, and choose the exit code.

mod copy;
mod gallery;
mod inputs;
mod manual;
mod render;
mod schema;

use std::fmt::Display;
use std::io::{self, Write};
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::engine::GpuError;

/// Draws molecules as a JSON style file says.
#[derive(Debug, Parser)]
#[command(name = "restyle", version, disable_help_subcommand = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Draw one still
    Render(render::Args),
    /// Draw every look on every molecule, with a contact sheet
    Gallery(gallery::Args),
    /// Copy a shipped look to a file, to start from
    Copy(copy::Args),
    /// Print the JSON Schema of style files, for editors
    Schema(schema::Args),
}

/// Why a command ended, and with which exit code.
#[derive(Debug)]
pub(crate) struct Failure {
    code: u8,
    message: String,
}

impl Failure {
    /// The input is wrong: exit code 1.
    pub(crate) fn input(message: impl Display) -> Failure {
        Failure { code: 1, message: message.to_string() }
    }

    /// The command line is wrong: exit code 2.
    pub(crate) fn usage(message: impl Display) -> Failure {
        Failure { code: 2, message: message.to_string() }
    }
}

impl From<GpuError> for Failure {
    /// The machine cannot do it: exit code 3.
    fn from(error: GpuError) -> Failure {
        Failure { code: 3, message: error.to_string() }
    }
}

/// Runs the command that the process was started with.
pub fn run() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            // Help and version also come this way, with exit code 0.
            let code = error.exit_code();
            let _ = error.print();
            return ExitCode::from(code as u8);
        }
    };
    let result = match cli.command {
        Command::Render(args) => render::run(&args),
        Command::Gallery(args) => gallery::run(&args),
        Command::Copy(args) => copy::run(&args),
        Command::Schema(args) => schema::run(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            tell(&failure.message);
            ExitCode::from(failure.code)
        }
    }
}

/// Prints a line of results to stdout. A reader that has gone away, such as `head`, is no failure.
fn answer(line: impl Display) -> Result<(), Failure> {
    match writeln!(io::stdout(), "{line}") {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::input(format!("standard output: cannot be written: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints a message to stderr. Where that cannot be written there is nobody left to tell.
fn tell(message: impl Display) {
    // Names of files may hold what a terminal would obey.
    let shown = message.to_string().replace(|c: char| c.is_control() && c != '\n', "?");
    let _ = writeln!(io::stderr(), "{shown}");
}
