// Draws egui's meshes, and rendered pictures. Colors are in sRGB.

// Whether the target converts from linear values to sRGB.
override SRGB_TARGET: bool = false;

struct Corner {
    @builtin(position) position: vec4<f32>,
    // Everything is flat on the screen.
    @location(0) @interpolate(linear) uv: vec2<f32>,
    @location(1) @interpolate(linear) color: vec4<f32>,
}

// Size of the target in points.
@group(0) @binding(0) var<uniform> size: vec2<f32>;
@group(1) @binding(0) var image: texture_2d<f32>;
@group(1) @binding(1) var image_sampler: sampler;

@vertex
fn mesh_corner(@location(0) position: vec2<f32>, @location(1) uv: vec2<f32>, @location(2) color: vec4<f32>) -> Corner {
    let clip = vec2<f32>(2.0, -2.0) * position / size + vec2<f32>(-1.0, 1.0);
    return Corner(vec4<f32>(clip, 0.0, 1.0), uv, color);
}

// Fills the viewport with two triangles.
@vertex
fn picture_corner(@builtin(vertex_index) index: u32) -> Corner {
    // Corners 0, 1, 2, then 1, 2, 3.
    let corner = index - 2u * (index / 3u);
    let uv = vec2<f32>(f32(corner & 1u), f32(corner >> 1u));
    let clip = vec2<f32>(2.0, -2.0) * uv + vec2<f32>(-1.0, 1.0);
    return Corner(vec4<f32>(clip, 0.0, 1.0), uv, vec4<f32>(1.0));
}

fn to_target(color: vec4<f32>) -> vec4<f32> {
    if SRGB_TARGET {
        let linear = select(pow((color.rgb + 0.055) / 1.055, vec3<f32>(2.4)), color.rgb / 12.92, color.rgb <= vec3<f32>(0.04045));
        return vec4<f32>(linear, color.a);
    }
    return color;
}

@fragment
fn mesh(in: Corner) -> @location(0) vec4<f32> {
    return to_target(in.color * textureSampleLevel(image, image_sampler, in.uv, 0.0));
}

@fragment
fn picture(in: Corner) -> @location(0) vec4<f32> {
    return to_target(textureSampleLevel(image, image_sampler, in.uv, 0.0));
}
