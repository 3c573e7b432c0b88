// Draws the sky background.

struct Fragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) direction: vec3<f32>,
}

@vertex
fn vs(@builtin(vertex_index) k: u32) -> Fragment {
    let at = vec2<f32>(f32((k << 1u) & 2u), f32(k & 2u)) * 2.0 - 1.0;
    var out: Fragment;
    // Depth 0 represents infinity.
    out.clip = vec4<f32>(at, 0.0, 1.0);
    out.direction = g.forward.xyz + at.x * g.right.xyz + at.y * g.up.xyz;
    return out;
}

@fragment
fn fs(in: Fragment) -> @location(0) vec4<f32> {
    let d = normalize(in.direction);
    var color = sky_radiance(vec3<f32>(d.xy, max(d.z, 0.0)));
    let cloud = g.sun_rgb.w;
    if d.z > 0.015 && cloud > 0.02 {
        // A cloud layer at 900 m that drifts with the wind.
        let reach = 1.0 / (d.z + 0.06);
        let at = d.xy * reach * 1.4 + g.look.zw * g.eye.w * 0.002;
        let fine = g.forward.w * reach * reach;
        let heap = 0.62 * fbm(at * 0.5, fine * 0.5) + 0.38 * fbm(at * 2.3 + 5.0, fine * 2.3);
        let edge = mix(0.62, 0.30, cloud);
        let cover_at = smoothstep(edge - 0.06, edge + 0.16, heap);
        // Sunlit clouds are brighter than the blue sky between them; full cover is an overcast sky.
        let thick = smoothstep(edge, edge + 0.35, heap);
        let sunny = g.sun.w * max(g.sun.z, 0.0) * (0.55 - 0.35 * thick) * g.sun_rgb.xyz;
        let shaded = (1.0 + 2.0 * d.z) / 3.0 * vec3<f32>(0.97, 1.0, 1.05) * g.sky_rgb.w * (1.15 - 0.45 * thick);
        color = mix(color, shaded + sunny, cover_at * min(1.0, 0.25 + 1.1 * cloud) * smoothstep(0.015, 0.16, d.z));
    }
    // The sun's disk, 0.53 degrees across, dimmed behind clouds. Its edge is between 4 and 6 mrad. The square of a
    // small angle is twice the difference between 1 and its cosine.
    let off = 2.0 - 2.0 * dot(d, g.sun.xyz);
    color += g.sun.w * g.sun_rgb.xyz * 40.0 * (1.0 - smoothstep(16e-6, 36e-6, off));
    // Fog in front of the sky.
    if g.scene.w > 0.0 {
        color = mix(veil_radiance(-d), color, exp(-g.scene.w / max(d.z, 0.02)));
    }
    return exposed(color);
}
