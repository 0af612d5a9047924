//! The built command as its own test rig: what it writes, what it refuses, with which words and exit codes.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on should stop there")]

mod bad_commands;
mod bad_outputs;
mod bad_scenes;
mod bad_styles;
mod check;
mod compare;
mod explain;
mod extremes;
mod info;
mod measure;
mod pictures;
mod reference;
mod rig;
mod schema;
mod shipped;
mod watch;
