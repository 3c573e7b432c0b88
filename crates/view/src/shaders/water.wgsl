// The lake: waves, Fresnel reflection of sky and shore, and the bed where the water is shallow.

// Whether waves break (visible_wind.rs).
override WHITECAPS: bool = true;

// Cells of the gusts' pattern per meter: the largest are as long as gusts near the water (the Dryden model's length scale at 20 ft,
// 44 m, rounded). uniforms.rs has the same number.
const GUST_CELLS_PER_M: f32 = 0.025;
// Standard deviation of the noise with several octaves (noise.rs).
const NOISE_DEVIATION: f32 = 0.124;
// Cell of breaking waves along and across their direction, m, speed of the waves, m/s, and duration of the foam, s (estimates: waves of
// 5 m; crests break over a few meters).
const WHITECAP_CELL_M: vec2<f32> = vec2<f32>(2.0, 4.5);
const WHITECAP_SPEED_M_S: f32 = 2.9;
const WHITECAP_DURATION_S: f32 = 4.0;
// Largest radius of the foam, cells (visible_wind.rs).
const WHITECAP_RADIUS: f32 = 0.28;
// Reflectance that fresh foam adds, and the share that old foam has lost (Koepke 1984: 0.55 fresh, 0.22 with a standard error of 0.11
// on average over its life; here 0.33).
const FOAM_REFLECTANCE: f32 = 0.55;
const FOAM_AGING: f32 = 0.8;
// Darkening of the reflection where the waves are twice as steep (estimate: steep waves reflect higher, darker parts of the sky).
const GUST_DARKENING: f32 = 1.5;

@group(1) @binding(0) var mirror: texture_2d<f32>;
@group(1) @binding(1) var mirror_sampler: sampler;

struct Corner {
    @location(0) position: vec3<f32>,
    // Wind behind piers relative to the undisturbed one; not used.
    @location(2) lee: vec2<f32>,
    @location(3) light: vec2<f32>,
    @location(9) aux: f32,
}

struct Fragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) p: vec3<f32>,
    @location(1) depth: f32,
    @location(2) light: vec2<f32>,
    // Wind relative to the mean: behind piers and, for cheaper presets, in gusts.
    @location(3) local: f32,
}

// Place in the pattern of gusts, which drifts with the air.
fn gust_place(at: vec2<f32>) -> vec2<f32> {
    return (at - g.air.xy) * GUST_CELLS_PER_M;
}

// Wind speed at a place relative to the mean, from the noise there.
fn local_wind(value: f32) -> f32 {
    return max(1.0 + g.air.z / NOISE_DEVIATION * (value - 0.5), 0.0);
}

// Steepness of the waves at a wind speed.
fn wave_steepness(wind_m_s: f32) -> f32 {
    return 0.018 + 0.010 * wind_m_s;
}

// Steepness of the waves in a local wind relative to the mean. Gusts roughen the lake in patches (cat's paws), and lulls smooth it.
fn roughened(local: f32) -> f32 {
    return wave_steepness(g.look.y * local) / wave_steepness(g.look.y);
}

// Foam of breaking waves: its share of a pixel, and its reflectance. In each cell of a pattern that travels with the waves, one wave
// after the other can break; its foam grows, thins, and shrinks.
fn whitecaps(at: vec2<f32>, footprint: f32, local: f32) -> vec2<f32> {
    let forward = g.look.zw;
    let along = dot(at, forward) - WHITECAP_SPEED_M_S * g.eye.w;
    let across = dot(at, vec2<f32>(-forward.y, forward.x));
    let q = vec2<f32>(along, across) / WHITECAP_CELL_M;
    let cell = cell_noise(q);
    let age = g.eye.w / WHITECAP_DURATION_S + 13.0 * cell.y;
    let life = fract(age);
    let luck = fract(61.0 * cell.y + 0.618034 * floor(age));
    // The coverage grows with the wind speed to the power of 3.41 (visible_wind.rs).
    let chance = g.air.w * max(1.0 + 3.41 * (local - 1.0), 0.0);
    let radius = WHITECAP_RADIUS * sqrt(4.0 * life * (1.0 - life));
    var ragged = 0.0;
    if DETAIL {
        ragged = 0.3 * (fbm(at * 2.3, footprint * 2.3) - 0.5);
    }
    let soft = 0.15 * radius + 0.5 * footprint / WHITECAP_CELL_M.x + 0.01;
    let foam = step(luck, chance) * (1.0 - smoothstep(radius - soft, radius + soft, cell.x + ragged));
    // Waves that are too small to resolve brighten the water by their mean.
    let mean = 2.0 / 3.0 * PI * WHITECAP_RADIUS * WHITECAP_RADIUS * min(chance, 1.0);
    let share = mix(foam, mean, smoothstep(0.3, 1.0, footprint / WHITECAP_CELL_M.x));
    return vec2<f32>(share, FOAM_REFLECTANCE * (1.0 - FOAM_AGING * life));
}

@vertex
fn vs(v: Corner) -> Fragment {
    var out: Fragment;
    out.p = v.position;
    out.clip = g.view_proj * vec4<f32>(v.position, 1.0);
    out.depth = v.aux;
    out.light = v.light;
    out.local = v.lee.x;
    if !DETAIL {
        out.local *= local_wind(textureSampleLevel(noise_map, noise_sampler, gust_place(v.position.xy) / 16.0, 2.0).r);
    }
    return out;
}

// Slopes of a layer of waves along and across `forward`, which travel with the deep-water speed of their length. Noise has waves of
// many lengths in groups with short crests, as wind waves have; sums of sine waves look like stripes. Crests are twice as long as the
// distance between them (estimate from the spread of 30 degrees of wind waves: Mitsuyasu et al. 1975).
fn wave_layer(at: vec2<f32>, forward: vec2<f32>, length_m: f32, footprint: f32) -> vec2<f32> {
    // A cell is half a wave.
    let speed_m_s = sqrt(9.81 * length_m / (2.0 * PI));
    let along = dot(at, forward) - speed_m_s * g.eye.w;
    let across = dot(at, vec2<f32>(-forward.y, forward.x));
    let q = vec2<f32>(along, 0.5 * across) * (2.0 / length_m);
    if DETAIL {
        return textureSampleLevel(noise_map, noise_sampler, q / 16.0, log2(max(footprint * 64.0 / length_m, 1.0))).rg - 0.5;
    }
    return textureSample(noise_map, noise_sampler, q / 16.0).rg - 0.5;
}

// Slope of the waves from the sum of layers, and slow noise, 0 to 1.
fn waves(at: vec2<f32>, footprint: f32) -> vec3<f32> {
    let wind = g.look.zw;
    let side = vec2<f32>(-wind.y, wind.x);
    let strength = wave_steepness(g.look.y);
    let second = vec2<f32>(0.82 * wind - 0.57 * side);
    let long = wave_layer(at, wind, 6.3, footprint);
    let short = wave_layer(at + 7.0, second, 2.3, footprint);
    // Standard deviations of the noise make the layers as steep as the sum of all waves.
    var s = strength * (wind * (4.0 * long.x) + side * (1.2 * long.y));
    s += strength * (second * (4.5 * short.x) + vec2<f32>(-second.y, second.x) * (1.6 * short.y));
    if DETAIL {
        let third = vec2<f32>(0.77 * wind + 0.64 * side);
        let fine = wave_layer(at - 3.0, third, 0.71, footprint);
        s += strength * (third * (4.0 * fine.x) + vec2<f32>(-third.y, third.x) * (1.5 * fine.y));
    }
    return vec3<f32>(s, long.y + 0.5);
}

@fragment
fn fs(in: Fragment) -> @location(0) vec4<f32> {
    let f = max(length(dpdx(in.p)), length(dpdy(in.p)));
    let away = g.eye.xyz - in.p;
    let distance = length(away);
    let v = away / distance;
    var local = in.local;
    if DETAIL {
        local *= local_wind(fbm(gust_place(in.p.xy), f * GUST_CELLS_PER_M));
    }
    let gust = roughened(local);
    let surge = waves(in.p.xy, f);
    let s = surge.xy * gust;
    let n = normalize(vec3<f32>(-s, 1.0));
    let facing = clamp(dot(n, v), 0.02, 1.0);
    // Waves that are too small to resolve still blur and brighten the reflection.
    let rough = clamp(f * 0.02 + 0.02, 0.02, 0.22) * gust;
    let away_from = 1.0 - facing;
    let fresnel = 0.02 + 0.98 * (away_from * away_from) * (away_from * away_from) * away_from * (1.0 - rough);
    var r = reflect(-v, n);
    r.z = abs(r.z) + 0.3 * rough;
    var seen = sky_radiance(normalize(r)) * clamp(in.light.x * 1.15, 0.25, 1.0);
    if MIRROR {
        let screen = in.clip.xy / g.size.xy;
        let moved = s * vec2<f32>(0.9, 0.9) / (1.0 + 0.02 * distance);
        let shift = vec2<f32>(dot(moved, g.right.xy / max(length(g.right.xy), 1e-4)), -abs(dot(moved, vec2<f32>(v.x, v.y))) * 1.2);
        let uv = clamp(vec2<f32>(screen.x, screen.y) + shift * 0.35, vec2<f32>(0.002), vec2<f32>(0.998));
        seen = textureSampleLevel(mirror, mirror_sampler, uv, 0.0).rgb / g.look.x;
    }
    seen *= clamp(1.0 - GUST_DARKENING * (gust - 1.0), 0.5, 1.3);
    let sun_seen = sun_visible(in.p, vec3<f32>(0.0, 0.0, 1.0));
    let spread = max(rough * 1.4, 0.045);
    let glint = PI * ggx(n, v, g.sun.xyz, vec3<f32>(0.02), sqrt(spread)) * g.sun.w * max(g.sun.z, 0.0) * sun_seen;
    // Light scattered back from the water: blue-green, and brighter in the sun. Light that enters next to a shadow
    // scatters underneath it, so shadow edges are barely visible from above.
    let within = mix(0.65, 1.0, sun_seen);
    let lux = in.light.x * g.sky_rgb.w * g.sky_rgb.xyz + g.sun.w * max(g.sun.z, 0.0) * within * g.sun_rgb.xyz;
    var lamp = 0.0;
    if LAMP {
        lamp = lamp_lux(in.p, vec3<f32>(0.0, 0.0, 1.0));
    }
    let body = vec3<f32>(0.012, 0.030, 0.032) * (lux + lamp);
    let path = max(in.depth, 0.0) * (1.0 + 0.6 / max(v.z, 0.12));
    let clear = exp(-path * 0.55);
    // A line of foam along the shore.
    var wander = surge.z;
    if DETAIL {
        wander = noise(in.p.xy * 0.7);
    }
    let lap = 0.10 + 0.05 * sin(g.eye.w * 1.3 + 3.0 * wander);
    let foam = (1.0 - smoothstep(0.0, lap, in.depth)) * smoothstep(0.35, 0.7, fbm(in.p.xy * 2.0, f * 2.0)) * 0.5;
    var broken = vec2<f32>(0.0);
    if WHITECAPS {
        broken = whitecaps(in.p.xy, f, local);
    }
    var surface = fresnel * seen + glint * g.sun_rgb.xyz + (1.0 - fresnel) * (1.0 - clear) * body + foam * 0.7 * lux;
    surface += broken.x * broken.y * (lux + lamp);
    let alpha = mix(clamp(1.0 - (1.0 - fresnel) * clear + foam, 0.0, 1.0), 1.0, broken.x);
    let clear_air = exp(-distance * g.scene.z);
    let veil = haze(vec3<f32>(0.0), v, distance);
    return vec4<f32>(exposed(surface * clear_air + veil * alpha).rgb, alpha);
}
