// What every pass of every post effect has: the whole picture as one triangle, and the background.

struct Output {
    // Premultiplied linear background; alpha 0 for a transparent picture.
    background: vec4<f32>,
}
