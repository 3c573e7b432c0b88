// Branches on the material are uniform over a triangle, so derivatives inside them are valid.
diagnostic(off, derivative_uniformity);

// Radiance is stored as pi times radiance, in lux, divided by the exposure's white. A white matte surface at white
// illuminance has the value 1.

// Settings of the preset (pipelines.rs): number of sun shadow maps; filter size in texels; lamp shadows; lake
// reflection.
override CASCADES: u32 = 4u;
override TAPS: u32 = 3u;
// Whether shadows of the sun have penumbras.
override PENUMBRA: bool = false;
override LAMP_CASTS: bool = true;
override MIRROR: bool = true;
// Expensive small details: light ripples and the finest waves.
override DETAIL: bool = true;
// Whether the lamp is on.
override LAMP: bool = true;
// Whether the pipeline draws highlights and reflections.
override GLOSSY: bool = true;

// Whether rain or snow changes the surfaces.
override WEATHERED: bool = false;

struct Globals {
    view_proj: mat4x4<f32>,
    // Camera position; time, s.
    eye: vec4<f32>,
    // Right and up, scaled by the half sizes of the picture at distance 1, and forward; w of the last: radians per
    // pixel.
    right: vec4<f32>,
    up: vec4<f32>,
    forward: vec4<f32>,
    // Direction toward the sun; illuminance of the sun.
    sun: vec4<f32>,
    // Color of the sun; cloud cover.
    sun_rgb: vec4<f32>,
    // Color of the sky's light; horizontal illuminance of the sky.
    sky_rgb: vec4<f32>,
    // Factor for the sky's relative radiance; water level; extinction of the air, 1/m; optical depth of the fog up to the sky.
    scene: vec4<f32>,
    // Lamp: position, cosine of the half beam angle; direction, candela.
    lamp: vec4<f32>,
    lamp_dir: vec4<f32>,
    // 1/white; wind speed; direction in which the waves travel, east and north.
    look: vec4<f32>,
    // Layer of the lamp's shadow map; negative if there is none.
    shadow: vec4<f32>,
    // Size of a texel in each map, m.
    texel: vec4<f32>,
    // Picture size, px; half the side of the photograph on the ground, m (0 without one).
    size: vec4<f32>,
    shadow_proj: array<mat4x4<f32>, 5>,
    // Displacement of the air, east and north, m; standard deviation of the wind speed relative to its mean; share of the cells in
    // which a wave breaks.
    air: vec4<f32>,
    // Mean displacement of a tree's top, east and north, m; phase, rad.
    trees: vec4<f32>,
    // Wetness and snow cover of open surfaces; rain and snow, mm/h.
    weather: vec4<f32>,
    // Share of the drops in each layer in front of the camera (precipitation.wgsl).
    open: vec4<f32>,
}

@group(0) @binding(0) var<uniform> g: Globals;
@group(0) @binding(1) var shadow_map: texture_depth_2d_array;
@group(0) @binding(2) var shadow_sampler: sampler_comparison;
// Noise of several octaves, of one octave, distance to the nearest scattered point, random number for that point
// (noise.rs).
@group(0) @binding(3) var noise_map: texture_2d<f32>;
@group(0) @binding(4) var noise_sampler: sampler;

const PI: f32 = 3.14159265;

// ---- noise ----

fn hash2(p: vec2<i32>) -> f32 {
    var h = bitcast<u32>(p.x) * 0x8da6b343u + bitcast<u32>(p.y) * 0xd8163841u;
    h = (h ^ (h >> 15u)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12u)) * 0x297a2d39u;
    h = h ^ (h >> 15u);
    return f32(h >> 8u) / 16777216.0;
}

// Smooth single-octave noise with cells of size 1.
fn noise(p: vec2<f32>) -> f32 {
    return textureSampleLevel(noise_map, noise_sampler, p / 16.0, 0.0).g;
}

// Several octaves, mean 0.5, averaged over the footprint (in the units of p).
fn fbm(p: vec2<f32>, footprint: f32) -> f32 {
    if DETAIL {
        return textureSampleLevel(noise_map, noise_sampler, p / 16.0, log2(max(footprint * 32.0, 1.0))).r;
    }
    // Lets the renderer determine the pixel footprint, which costs a third as much in software.
    return textureSample(noise_map, noise_sampler, p / 16.0).r;
}

// Noise that cheaper presets replace with `instead`.
fn fine(p: vec2<f32>, footprint: f32, instead: f32) -> f32 {
    if DETAIL {
        return fbm(p, footprint);
    }
    return instead;
}

// Cellular pattern: distance to the nearest center, and a random number for its cell.
fn cell_noise(p: vec2<f32>) -> vec2<f32> {
    let found = textureSampleLevel(noise_map, noise_sampler, p / 16.0, 0.0);
    return vec2<f32>(found.b * 1.28, found.a);
}

// Fraction of a pixel (`footprint` wide) covered by a line of `width` at distance d.
fn cover(d: f32, width: f32, footprint: f32) -> f32 {
    let f = max(footprint, 1e-6);
    return clamp((0.5 * (width + f) - d) / f, 0.0, min(1.0, width / f));
}

// Mean of exp(-|x| / reach) over a pixel (`footprint` wide) at x. Prevents flicker and steps in the leakage from a line
// narrower than a pixel.
fn leakage(x: f32, reach: f32, footprint: f32) -> f32 {
    let half = 0.5 * max(footprint, 1e-6);
    let ends = vec2<f32>(x - half, x + half);
    let sums = sign(ends) * reach * (1.0 - exp(-abs(ends) / reach));
    return (sums.y - sums.x) / (2.0 * half);
}

// Like `cover`, for lines repeated every `spacing`; approaches their mean at a distance.
fn lines(x: f32, spacing: f32, width: f32, footprint: f32) -> f32 {
    let d = abs(fract(x / spacing) - 0.5) * spacing;
    let mean = width / spacing;
    return mix(cover(0.5 * spacing - d, width, footprint), mean, smoothstep(0.25, 0.6, footprint / spacing));
}

// Courses of cut stone: height of a course and mean length of a stone, and width of the joints, m.
const STONE_M: vec2<f32> = vec2<f32>(0.78, 0.38);
const STONE_JOINT_M: f32 = 0.014;

// Position on a wall, level and up, m. It is the same for a wall and for the defects on it.
fn wall_position(p: vec3<f32>, n: vec3<f32>) -> vec2<f32> {
    let level = normalize(vec3<f32>(-n.y, n.x, 0.0) + vec3<f32>(1e-6, 0.0, 0.0));
    return vec2<f32>(dot(p, level), dot(p, cross(n, level)));
}

// Stones in courses: coverage by joints of the given width, and a random number for each stone.
fn stones_in_courses(at: vec2<f32>, width: f32, f: f32) -> vec2<f32> {
    let course = floor(at.y / STONE_M.y);
    let shifted = at.x + STONE_M.x * (0.5 * course + 0.35 * hash2(vec2<i32>(i32(course), 5)));
    let own = hash2(vec2<i32>(i32(floor(shifted / STONE_M.x)), i32(course)));
    return vec2<f32>(max(lines(at.y, STONE_M.y, width, f), lines(shifted, STONE_M.x, width, f)), own);
}

// ---- sky ----

fn sky_radiance(direction: vec3<f32>) -> vec3<f32> {
    let up = clamp(direction.z, 0.0, 1.0);
    let down = 1.0 - up;
    let fall = down * down * down * down;
    let angle = acos(clamp(dot(direction, g.sun.xyz), -1.0, 1.0));
    let glow = 1.0 + 2.2 * exp(-3.2 * angle) + 5.0 * exp(-22.0 * angle);
    let clear = (0.32 + 0.68 * fall) * glow * mix(vec3<f32>(0.62, 0.97, 2.0), vec3<f32>(0.94, 0.995, 1.24), fall);
    let gray = (1.0 + 2.0 * up) / 3.0 * vec3<f32>(0.97, 1.0, 1.05);
    return g.scene.x * mix(clear, gray, g.sun_rgb.w);
}

// ---- shadows ----

fn shadow_compare(layer: i32, uv: vec2<f32>, depth: f32) -> f32 {
    return textureSampleCompareLevel(shadow_map, shadow_sampler, uv, layer, depth);
}

// Mean visibility over a square of texels around a point in a shadow map.
fn map_visible(layer: i32, q: vec3<f32>) -> f32 {
    let uv = vec2<f32>(0.5 + 0.5 * q.x, 0.5 - 0.5 * q.y);
    let s = 1.0 / f32(textureDimensions(shadow_map).x);
    let a = 0.5 * s * (f32(TAPS) - 1.0);
    if TAPS < 2u {
        return shadow_compare(layer, uv, q.z);
    }
    var sum = shadow_compare(layer, uv + vec2<f32>(-a, -a), q.z) + shadow_compare(layer, uv + vec2<f32>(a, -a), q.z)
        + shadow_compare(layer, uv + vec2<f32>(-a, a), q.z) + shadow_compare(layer, uv + vec2<f32>(a, a), q.z);
    if TAPS < 3u {
        return 0.25 * sum;
    }
    sum += shadow_compare(layer, uv + vec2<f32>(-a, 0.0), q.z) + shadow_compare(layer, uv + vec2<f32>(a, 0.0), q.z)
        + shadow_compare(layer, uv + vec2<f32>(0.0, -a), q.z) + shadow_compare(layer, uv + vec2<f32>(0.0, a), q.z) + shadow_compare(layer, uv, q.z);
    return sum / 9.0;
}

fn in_map(layer: i32, p: vec3<f32>) -> vec4<f32> {
    let clip = g.shadow_proj[layer] * vec4<f32>(p, 1.0);
    let q = clip.xyz / clip.w;
    let inside = clip.w > 0.0 && max(abs(q.x), abs(q.y)) < 0.985 && q.z > 0.0 && q.z < 1.0;
    return vec4<f32>(q, select(0.0, 1.0, inside));
}

// Width of the sun's disk, rad: the penumbra of an edge is this wide at a distance of 1 m.
const SUN_RAD: f32 = 0.0093;
// Distance of the farthest caster whose penumbra is drawn in full, m (estimate: the height of a high deck).
const MAX_CASTER_M: f32 = 60.0;
const SEARCHES: u32 = 12u;
const DISK_TAPS: u32 = 24u;

// Offset of a sample in a disk of radius 1, evenly spread; the first one is the center.
fn disk(k: u32, count: u32, turn: f32) -> vec2<f32> {
    let angle = f32(k) * 2.39996323 + turn;
    return sqrt(f32(k) / f32(count)) * vec2<f32>(cos(angle), sin(angle));
}

// Share of the sun's disk that a place sees (Fernando 2005, "Percentage-Closer Soft Shadows"): the mean distance of the casters around it
// determines the width of the penumbra.
fn disk_visible(layer: i32, q: vec3<f32>, n: vec3<f32>) -> f32 {
    let side = f32(textureDimensions(shadow_map).x);
    let projection = g.shadow_proj[layer];
    let depth_per_m = length(vec3<f32>(projection[0].z, projection[1].z, projection[2].z));
    let right = normalize(vec3<f32>(projection[0].x, projection[1].x, projection[2].x));
    let up = normalize(vec3<f32>(projection[0].y, projection[1].y, projection[2].y));
    // The surface rises towards the sun across the disk, and must not shade itself.
    let slope = -vec2<f32>(dot(n, right), dot(n, up)) / max(dot(n, g.sun.xyz), 0.15) * depth_per_m;
    let uv = vec2<f32>(0.5 + 0.5 * q.x, 0.5 - 0.5 * q.y);
    let turn = 6.2831853 * hash2(vec2<i32>(uv * side));
    let texel_m = g.texel[layer];
    // Within the margin that `in_map` leaves.
    let search_m = clamp(0.5 * SUN_RAD * MAX_CASTER_M, 1.5 * texel_m, 0.0075 * side * texel_m);
    let flip = vec2<f32>(1.0, -1.0) / (side * texel_m);
    var casters = vec2<f32>(0.0);
    for (var k = 0u; k < SEARCHES; k++) {
        let at_m = disk(k, SEARCHES, turn) * search_m;
        let texel = vec2<i32>((uv + at_m * flip) * side);
        let above = textureLoad(shadow_map, clamp(texel, vec2<i32>(0), vec2<i32>(i32(side) - 1)), layer, 0) - (q.z + dot(slope, at_m));
        if above > 0.02 * depth_per_m {
            casters += vec2<f32>(above / depth_per_m, 1.0);
        }
    }
    if casters.y < 0.5 {
        return 1.0;
    }
    let radius_m = clamp(0.5 * SUN_RAD * casters.x / casters.y, texel_m, search_m);
    var sum = 0.0;
    for (var k = 0u; k < DISK_TAPS; k++) {
        let at_m = disk(k, DISK_TAPS, turn) * radius_m;
        sum += shadow_compare(layer, uv + at_m * flip, q.z + dot(slope, at_m));
    }
    return sum / f32(DISK_TAPS);
}

fn sun_visible(p: vec3<f32>, n: vec3<f32>) -> f32 {
    if g.sun.w <= 0.0 {
        return 0.0;
    }
    // Offset from the surface, larger at grazing sun angles, to prevent self-shadowing.
    let lean = 0.6 + 1.6 * (1.0 - clamp(dot(n, g.sun.xyz), 0.0, 1.0));
    var layer = 0;
    var q = in_map(0, p + n * (g.texel.x * lean));
    if CASCADES > 1u {
        if q.w < 0.5 {
            layer = 1;
            q = in_map(1, p + n * (g.texel.y * lean));
        }
        if q.w < 0.5 {
            layer = 2;
            q = in_map(2, p + n * (g.texel.z * lean));
        }
    }
    if CASCADES > 3u {
        if q.w < 0.5 {
            layer = 3;
            q = in_map(3, p + n * (g.texel.w * lean));
        }
    }
    if q.w < 0.5 {
        return 1.0;
    }
    if PENUMBRA {
        return disk_visible(layer, q.xyz, n);
    }
    return map_visible(layer, q.xyz);
}

// ---- shading ----

struct Matter {
    albedo: vec3<f32>,
    roughness: f32,
    metal: f32,
    normal: vec3<f32>,
    // Normal of the surface without its relief.
    face: vec3<f32>,
    // Fractions of sky and sun illuminance that arrive indirectly.
    light: vec2<f32>,
    // Fraction of direct sunlight that the surface's own relief does not block.
    sunlit: f32,
    // Whether the surface shows no light ripples from the water.
    still: bool,
}

fn ggx(n: vec3<f32>, v: vec3<f32>, l: vec3<f32>, f0: vec3<f32>, roughness: f32) -> vec3<f32> {
    let h = normalize(v + l);
    let a = roughness * roughness;
    let nh = clamp(dot(n, h), 0.0, 1.0);
    let nv = max(dot(n, v), 1e-3);
    let nl = max(dot(n, l), 1e-3);
    let d = nh * nh * (a * a - 1.0) + 1.0;
    let distribution = a * a / (PI * d * d);
    let visible = 0.5 / (nl * sqrt(nv * nv * (1.0 - a * a) + a * a) + nv * sqrt(nl * nl * (1.0 - a * a) + a * a));
    let f = pow(1.0 - clamp(dot(v, h), 0.0, 1.0), 5.0);
    return distribution * visible * (f0 + (1.0 - f0) * f);
}

fn lamp_lux(p: vec3<f32>, n: vec3<f32>) -> f32 {
    let to = p - g.lamp.xyz;
    let distance = length(to);
    if g.lamp_dir.w <= 0.0 || distance < 1e-3 {
        return 0.0;
    }
    let ray = to / distance;
    let edge = g.lamp.w;
    let beam = smoothstep(edge - 0.02, edge + 0.02, dot(ray, g.lamp_dir.xyz));
    if beam <= 0.0 {
        return 0.0;
    }
    var seen = 1.0;
    if LAMP_CASTS {
        let layer = i32(g.shadow.x);
        if layer >= 0 {
            let q = in_map(layer, p + n * 0.03 - ray * 0.03);
            if q.w > 0.5 {
                seen = map_visible(layer, q.xyz);
            }
        }
    }
    return g.lamp_dir.w * beam * seen * max(-dot(ray, n), 0.0) / max(distance * distance, 0.01);
}

// Light ripples that waves reflect onto surfaces above the water. They also appear above land, because the shader does
// not know the surface below.
fn caustics(p: vec3<f32>) -> f32 {
    let t = g.eye.w;
    let q = p.xy * 0.55;
    let a = noise(q + vec2<f32>(0.35 * t, 0.2 * t));
    let b = noise(q * 1.9 - vec2<f32>(0.3 * t, -0.4 * t) + 7.3);
    let ridge = 1.0 - abs(a + b - 1.0) * 2.2;
    return clamp(ridge, 0.0, 1.0);
}

// Radiance along a reflected ray: the sky, or the mean of land and lake.
fn reflected_radiance(ray: vec3<f32>) -> vec3<f32> {
    if ray.z < 0.0 {
        return 0.12 * (g.sky_rgb.w * g.sky_rgb.xyz + g.sun.w * max(g.sun.z, 0.0) * g.sun_rgb.xyz);
    }
    return sky_radiance(ray);
}

fn shade(m: Matter, p: vec3<f32>) -> vec3<f32> {
    let away = g.eye.xyz - p;
    let distance = length(away);
    let v = away / max(distance, 1e-6);
    let n = m.normal;
    let f0 = mix(vec3<f32>(0.04), m.albedo, m.metal);
    let matte = m.albedo * (1.0 - m.metal);
    let facing = max(dot(n, g.sun.xyz), 0.0);
    var direct = 0.0;
    if facing > 0.0 {
        direct = g.sun.w * facing * m.sunlit * sun_visible(p, select(n, m.face, PENUMBRA));
    }
    var bounce = m.light.y * g.sun.w;
    if DETAIL {
        if n.z < -0.3 && !m.still && bounce > 0.0 && p.z < g.scene.y + 60.0 {
            bounce *= 0.86 + 0.45 * caustics(p);
        }
    }
    let indirect = m.light.x * g.sky_rgb.w * g.sky_rgb.xyz + bounce * g.sun_rgb.xyz;
    let sun = direct * g.sun_rgb.xyz;
    let lamp = lamp_lux(p, n);
    var out = matte * (indirect + sun + lamp);
    if !GLOSSY {
        return haze(out, v, distance);
    }
    if direct > 0.0 && m.roughness < 0.85 {
        out += PI * ggx(n, v, g.sun.xyz, f0, m.roughness) * sun;
    }
    if lamp > 0.0 {
        out += PI * ggx(n, v, normalize(g.lamp.xyz - p), f0, m.roughness) * lamp;
    }
    if m.roughness < 0.7 {
        let r = reflect(-v, n);
        let open = clamp(m.light.x * 1.2, 0.0, 1.0);
        let fresnel = f0 + (max(vec3<f32>(1.0 - m.roughness), f0) - f0) * pow(1.0 - clamp(dot(n, v), 0.0, 1.0), 5.0);
        out += fresnel * mix(indirect, reflected_radiance(r), (1.0 - m.roughness) * open) * (1.0 - 0.5 * m.roughness);
    }
    return haze(out, v, distance);
}

// Haze: distant objects fade into the horizon.
fn haze(color: vec3<f32>, v: vec3<f32>, distance: f32) -> vec3<f32> {
    return mix(veil_radiance(v), color, exp(-distance * g.scene.z));
}

// Brightness of thick air relative to the sky at the horizon (sky.rs).
const VEIL_SHARE: f32 = 0.85;

// Fog scatters light so often that it loses the color and the glow of the sky behind it.
fn grayed(veil: vec3<f32>) -> vec3<f32> {
    let gray = dot(veil, vec3<f32>(0.2126, 0.7152, 0.0722)) * vec3<f32>(0.97, 1.0, 1.04);
    return mix(veil, gray, min(g.scene.w, 1.0));
}

// Radiance of thick air in the direction `v` toward the camera.
fn veil_radiance(v: vec3<f32>) -> vec3<f32> {
    if !DETAIL {
        return grayed(horizon_radiance(v) * VEIL_SHARE);
    }
    return grayed(sky_radiance(normalize(vec3<f32>(-v.x, -v.y, 0.04))) * VEIL_SHARE);
}

// Surface in rain and snow. Water in the pores of a matte surface halves its reflectance (Twomey et al. 1986); snow lies where the
// surface is level. `open` is the share of the sky that the surface sees.
fn weathered(albedo: vec3<f32>, up: f32, open: f32) -> vec3<f32> {
    if !WEATHERED {
        return albedo;
    }
    let exposed_to = smoothstep(0.25, 0.6, open) * (0.5 + 0.5 * smoothstep(-0.2, 0.4, up));
    let wet = albedo * (1.0 - 0.5 * g.weather.x * exposed_to);
    let snow = g.weather.y * smoothstep(0.55, 0.85, up) * smoothstep(0.4, 0.75, open);
    return mix(wet, vec3<f32>(0.80, 0.82, 0.85), snow);
}

// Radiance of the sky just above the horizon in the view direction, a cheap approximation for haze. Powers model the
// sun's glow.
fn horizon_radiance(v: vec3<f32>) -> vec3<f32> {
    let q = 0.5 - 0.5 * dot(v, g.sun.xyz);
    let q4 = q * q * q * q;
    let clear = (1.0 + 2.2 * q4 * q4 * q4 * q4) * vec3<f32>(0.85, 0.90, 1.20);
    return g.scene.x * mix(clear, vec3<f32>(0.34, 0.35, 0.36), g.sun_rgb.w);
}

fn exposed(color: vec3<f32>) -> vec4<f32> {
    return vec4<f32>(min(color * g.look.x, vec3<f32>(200.0)), 1.0);
}
