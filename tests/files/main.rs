//! Files as users have them: molecules, styles, and what is said of those that do not load.

mod outcome;
mod scene_cif;
mod scene_data;
mod scene_gltf;
mod scene_mol;
mod scene_mutations;
mod scene_shipped;
mod scene_tri;
mod style_files;
mod style_manual;
mod style_schema;
