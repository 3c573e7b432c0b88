// Ambient occlusion in the shaders of surfaces (appended to common.wgsl).

// Whether the pipeline reads it (occlusion.wgsl).
override OCCLUDED: bool = false;

@group(1) @binding(0) var occlusion_map: texture_2d<f32>;

// Share of the indirect light that reaches a pixel's surface past the other surfaces near it.
fn ambient_share(pixel: vec2<f32>) -> f32 {
    if !OCCLUDED {
        return 1.0;
    }
    return textureLoad(occlusion_map, vec2<i32>(pixel), 0).r;
}
