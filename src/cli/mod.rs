//! The command line: one file per subcommand; errors are printed once, here, and choose the exit code.

mod check;
mod compare;
mod copy;
mod exact;
mod explain;
mod gallery;
mod info;
mod inputs;
mod manual;
mod measure;
mod messages;
mod render;
mod schema;
mod watch;

use std::fmt::Display;
use std::io::{self, Write};
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::config::Mistakes;
use crate::engine::GpuError;
use messages::clean;

/// Draws molecules and meshes as a JSON style file says.
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
    /// Draw every look on every scene, with a contact sheet
    Gallery(gallery::Args),
    /// Say all that is wrong with style files, and what they mean
    Check(check::Args),
    /// Say what scenes hold: atoms, residues, parts, materials, bounds, and selectors for them
    Info(info::Args),
    /// Say which passes a frame has and why, and which are left out
    Explain(explain::Args),
    /// Say how far two pictures are from each other, and where
    Compare(compare::Args),
    /// Chart what methods cost against how far they are from the truth
    Measure(measure::Args),
    /// Copy a shipped look to a file, to start from
    Copy(copy::Args),
    /// Print the JSON Schema of style files, for editors
    Schema(schema::Args),
}

/// Why a command ended, and with which exit code.
#[derive(Debug)]
pub(crate) struct Failure {
    code: u8,
    /// As a terminal may see it; empty if all is said.
    message: String,
}

impl Failure {
    /// The input is wrong: exit code 1.
    pub(crate) fn input(message: impl Display) -> Failure {
        Failure { code: 1, message: clean(message) }
    }

    /// The command line is wrong: exit code 2.
    pub(crate) fn usage(message: impl Display) -> Failure {
        Failure { code: 2, message: clean(message) }
    }

    /// A comparison is above its limit: exit code 4.
    pub(crate) fn above_limit(message: impl Display) -> Failure {
        Failure { code: 4, message: clean(message) }
    }

    /// The user broke it off: exit code 130, as of a program that an interrupt ends.
    pub(crate) fn interrupted() -> Failure {
        Failure { code: 130, message: "interrupted: no picture was written".to_owned() }
    }

    /// The input is wrong, and each mistake was told.
    pub(crate) fn told() -> Failure {
        Failure { code: 1, message: String::new() }
    }
}

impl From<Mistakes> for Failure {
    /// The style is wrong: exit code 1.
    fn from(mistakes: Mistakes) -> Failure {
        Failure { code: 1, message: messages::of_mistakes(&mistakes) }
    }
}

impl From<GpuError> for Failure {
    /// The machine cannot do it: exit code 3.
    fn from(error: GpuError) -> Failure {
        Failure { code: 3, message: clean(error) }
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
        Command::Check(args) => check::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Explain(args) => explain::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Measure(args) => measure::run(&args),
        Command::Copy(args) => copy::run(&args),
        Command::Schema(args) => schema::run(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            print_message(&failure.message);
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
    print_message(&clean(message));
}

/// The same for a message that is clean already, and may have colours; an empty one is none.
fn print_message(message: &str) {
    if !message.is_empty() {
        let _ = writeln!(io::stderr(), "{message}");
    }
}
