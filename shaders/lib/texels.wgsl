// Objects lie in textures, row after row, one texel for each 16 bytes: storage buffers end at 128 MiB on many adapters,
// and a software adapter reads them lane by lane.
const OBJECT_ROW: u32 = 2048u;

fn object_texel(objects: texture_2d<u32>, texel: u32) -> vec4<u32> {
    return textureLoad(objects, vec2<u32>(texel % OBJECT_ROW, texel / OBJECT_ROW), 0);
}
