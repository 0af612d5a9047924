//! Style files as users write them: what loads, what it means, and what is said of what does not load.

mod broken;
mod catalog;
mod explaining;
mod extending;
mod loading;
pub mod mutations;
mod resolving;
mod selectors;
mod source_lines;
mod strays;
mod syntax;
pub mod transfers;
mod warnings;
