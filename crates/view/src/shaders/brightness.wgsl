// Brightness of radiance in stops from white, within the range of the picture: shared by adapt.wgsl and develop.wgsl.
fn brightness_stops(color: vec3<f32>) -> f32 {
    return log2(clamp(dot(color, vec3<f32>(0.2126, 0.7152, 0.0722)), 0.001, 16.0));
}
