// Group 0 of every pass that reads the scene: the view, what is drawn, its materials and the order in which it is drawn.

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var atoms: texture_2d<u32>;
@group(0) @binding(2) var connectors: texture_2d<u32>;
@group(0) @binding(3) var<uniform> materials: array<Material, 512>;
@group(0) @binding(4) var<storage, read> atom_order: array<u32>;
@group(0) @binding(5) var<storage, read> connector_order: array<u32>;
@group(0) @binding(6) var mesh_vertices: texture_2d<u32>;
@group(0) @binding(7) var mesh_triangles: texture_2d<u32>;
@group(0) @binding(8) var mesh_parts: texture_2d<u32>;
@group(0) @binding(9) var mesh_runs: texture_2d<u32>;
@group(0) @binding(10) var mesh_pages: texture_2d<u32>;
