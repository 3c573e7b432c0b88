// A triangle that covers the picture, and the brightness of radiance: shared by adapt.wgsl, develop.wgsl and occlusion.wgsl.

struct Fragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) uv: vec2<f32>,
}

@vertex
fn vs(@builtin(vertex_index) k: u32) -> Fragment {
    let at = vec2<f32>(f32((k << 1u) & 2u), f32(k & 2u));
    var out: Fragment;
    out.clip = vec4<f32>(at * 2.0 - 1.0, 0.0, 1.0);
    out.uv = vec2<f32>(at.x, 1.0 - at.y);
    return out;
}

// Stops from white, within the range of the picture.
fn brightness_stops(color: vec3<f32>) -> f32 {
    return log2(clamp(dot(color, vec3<f32>(0.2126, 0.7152, 0.0722)), 0.001, 16.0));
}
