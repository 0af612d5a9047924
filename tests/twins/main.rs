//! CPU twins of the shaders, function by function, and what they are held to.

mod basic;
mod brdf;
mod brdf_table;
mod environment;
mod unlit;
