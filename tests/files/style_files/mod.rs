//! Style files as users write them: what loads, what it means, and what is said of what does not load.

mod broken;
mod catalog;
mod extending;
mod loading;
pub mod mutations;
