//! restyle: molecules drawn as a JSON style file says.
//!
//! `config` reads style files, `scene` reads molecules, `engine` puts them together and draws. The map of the house is
//! in `docs/architecture.md`.

pub mod cli;
pub mod config;
pub mod effects;
pub mod engine;
pub mod frame;
pub mod gpu;
pub mod measure;
pub mod providers;
pub mod reference;
pub mod scene;
pub mod shading;
pub mod shipped;
