// Renders depth as seen from the sun or the lamp.

@group(0) @binding(0) var<uniform> view_proj: mat4x4<f32>;

struct Corner {
    @location(0) position: vec3<f32>,
    @location(6) row0: vec4<f32>,
    @location(7) row1: vec4<f32>,
    @location(8) row2: vec4<f32>,
}

@vertex
fn vs(v: Corner) -> @builtin(position) vec4<f32> {
    let p = vec4<f32>(v.position, 1.0);
    return view_proj * vec4<f32>(dot(v.row0, p), dot(v.row1, p), dot(v.row2, p), 1.0);
}
