//! CPU twins of the shaders, function by function, what they are held to, and the GPU held to them and to truths.

mod basic;
mod bkb;
mod brdf;
mod brdf_table;
mod curvature;
mod environment;
mod focus;
mod furnace;
mod gpu;
mod impostors;
mod layers;
mod mesh_lines;
mod meshes;
mod occlusion;
mod outline;
mod outline_truth;
mod outlines;
mod output;
mod reference;
mod sampling;
mod shadows;
mod surface;
mod together;
mod toon;
mod truth;
mod unlit;
