// Draws drops and flakes in layers in front of the camera, one instance for each. Their sizes and speeds are measured values; their
// patterns are decorative.

// Distance of the first layer, m; each is twice as far as the one before (visible_weather.rs).
const FIRST_LAYER_M: f32 = 1.5;
const NEAR_PLANE_M: f32 = 0.05;
// Falling speeds, m/s: drops of 2 mm (Gunn and Kinzer 1949: 6.5) and aggregates of flakes (Locatelli and Hobbs 1974: about 1).
const DROP_SPEED_M_S: f32 = 6.5;
const FLAKE_SPEED_M_S: f32 = 1.0;
// Diameters, m (estimates within the ranges of the same papers).
const DROP_M: f32 = 0.002;
const FLAKE_M: f32 = 0.006;
// Time over which a camera and an eye see a drop as a streak, s (estimate: 1/60 s).
const STREAK_TIME_S: f32 = 0.0167;
// Width of the cells that hold one drop or one flake each, m.
const DROP_CELL_M: f32 = 0.06;
const FLAKE_CELL_M: f32 = 0.16;

struct Fragment {
    @builtin(position) clip: vec4<f32>,
    // Position across and up in the layer, m.
    @location(0) at: vec2<f32>,
    @location(1) @interpolate(flat) layer: u32,
}

fn layer_distance(layer: u32) -> f32 {
    return FIRST_LAYER_M * f32(1u << layer);
}

@vertex
fn vs(@builtin(vertex_index) k: u32, @builtin(instance_index) layer: u32) -> Fragment {
    let at = vec2<f32>(f32((k << 1u) & 2u), f32(k & 2u)) * 2.0 - 1.0;
    let distance = layer_distance(layer);
    var out: Fragment;
    // At the depth of its layer, so that nearer objects hide it.
    out.clip = vec4<f32>(at, NEAR_PLANE_M / distance, 1.0);
    out.at = at * vec2<f32>(length(g.right.xyz), length(g.up.xyz)) * distance;
    out.layer = layer;
    return out;
}

// Velocity in the plane of the layer.
fn projected(velocity: vec3<f32>) -> vec2<f32> {
    return vec2<f32>(dot(velocity, normalize(g.right.xyz)), dot(velocity, normalize(g.up.xyz)));
}

// Share of a pixel that drops (or flakes) of a size cover. `chance` is the share of cells with one.
fn covered(at: vec2<f32>, layer: u32, velocity: vec2<f32>, cell_m: f32, size_m: f32, chance: f32) -> f32 {
    let speed = max(length(velocity), 0.2);
    let along = velocity / speed;
    let streak_m = speed * STREAK_TIME_S + size_m;
    let length_m = max(3.0 * streak_m, cell_m);
    let moved = at - velocity * g.eye.w;
    let q = vec2<f32>(dot(moved, vec2<f32>(-along.y, along.x)) / cell_m, dot(moved, along) / length_m);
    // Columns are shifted, so that the drops form no rows.
    let column = floor(q.x);
    let shifted = q.y + 7.0 * hash2(vec2<i32>(i32(column), i32(layer) + 11));
    let cell = vec2<i32>(i32(column), i32(floor(shifted)) * 4 + i32(layer));
    if hash2(cell) > chance {
        return 0.0;
    }
    let place = vec2<f32>(0.2 + 0.6 * hash2(cell + 31), 0.3 + 0.4 * hash2(cell + 57));
    let d = (vec2<f32>(fract(q.x), fract(shifted)) - place) * vec2<f32>(cell_m, length_m);
    let pixel_m = g.forward.w * layer_distance(layer);
    return cover(abs(d.x), size_m, pixel_m) * cover(abs(d.y), streak_m, pixel_m);
}

@fragment
fn fs(in: Fragment) -> @location(0) vec4<f32> {
    let wind = vec3<f32>(g.look.zw * g.look.y, 0.0);
    let rain = g.weather.z;
    let snow = g.weather.w;
    var alpha = 0.0;
    if rain > 0.0 {
        let velocity = projected(wind - vec3<f32>(0.0, 0.0, DROP_SPEED_M_S));
        alpha += 0.45 * covered(in.at, in.layer, velocity, DROP_CELL_M, DROP_M, clamp(0.05 * sqrt(rain), 0.0, 0.5));
    }
    if snow > 0.0 {
        let velocity = projected(wind - vec3<f32>(0.0, 0.0, FLAKE_SPEED_M_S));
        alpha += 0.85 * covered(in.at, in.layer, velocity, FLAKE_CELL_M, FLAKE_M, clamp(0.3 * sqrt(snow), 0.0, 0.7));
    }
    alpha = min(alpha * g.open[in.layer], 1.0);
    // A drop shows the sky behind and above it.
    let bright = 0.5 * (sky_radiance(vec3<f32>(0.0, 0.0, 1.0)) + veil_radiance(-normalize(g.forward.xyz)));
    return vec4<f32>(exposed(bright).rgb * alpha, alpha);
}
