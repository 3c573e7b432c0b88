// Ambient occlusion: the share of the surroundings' light that reaches a place in a corner or gap, estimated from the depths of the
// picture (Bavoil and Sainz 2008, "Image-Space Horizon-Based Ambient Occlusion"). The baked light (scene/bake.rs) has one value per
// 1 to 1.5 m; this adds what is finer. `occlude` looks for the horizon in a few directions, others in each pixel of a square of four by four,
// and `average` is the mean over such a square.

// Number of directions per pixel.
override DIRECTIONS: u32 = 4u;
// Number of samples in each direction.
const STEPS: u32 = 4u;

// Distance up to which surfaces darken each other, m (estimate: the spacing of the baked light), and its largest size in the picture, px: nearer
// to the camera, only narrower gaps are darker.
const REACH_M: f32 = 1.0;
const MAX_REACH_PX: f32 = 96.0;
// Smallest size of the reach at which gaps can be seen, px.
const MIN_REACH_PX: f32 = 2.0;
// Sine of the angle to the surface below which nothing darkens it: more than the error of its normal.
const MIN_SINE: f32 = 0.05;
// Reflectance of the surfaces in a gap, between which light bounces (that of concrete and light paint, surface.wgsl).
const GAP_REFLECTANCE: f32 = 0.35;
const TURN: f32 = 6.2831853;
// Difference in distance, relative to the distance, above which a neighbor in the picture is another surface.
const MAX_STEP: f32 = 0.03;

struct Occlusion {
    // Half width and height of the picture at distance 1; near plane, m; 0.
    lens: vec4<f32>,
    // Size of the picture, px; 0; 0.
    size: vec4<f32>,
}

@group(0) @binding(0) var<uniform> o: Occlusion;
@group(0) @binding(1) var depth_map: texture_depth_2d;
// Only for `average`: the result of `occlude`.
@group(0) @binding(2) var found: texture_2d<f32>;

fn in_picture(pixel: vec2<i32>) -> vec2<i32> {
    return clamp(pixel, vec2<i32>(0), vec2<i32>(o.size.xy) - 1);
}

// Distance along the view axis, m; the sky is far away.
fn distance_m(pixel: vec2<i32>) -> f32 {
    return o.lens.z / max(textureLoad(depth_map, in_picture(pixel), 0), 1e-7);
}

// Place that a pixel shows: to the right, down and ahead of the camera, m.
fn place(pixel: vec2<i32>) -> vec3<f32> {
    let at = in_picture(pixel);
    let direction = ((vec2<f32>(at) + 0.5) / o.size.xy * 2.0 - 1.0) * o.lens.xy;
    return vec3<f32>(direction, 1.0) * distance_m(at);
}

// Step to the neighbor that is nearer in depth, so that the normal at an edge is that of one side.
fn smaller_step(p: vec3<f32>, pixel: vec2<i32>, along: vec2<i32>) -> vec3<f32> {
    let ahead = place(pixel + along) - p;
    let behind = p - place(pixel - along);
    let has_ahead = all(in_picture(pixel + along) == pixel + along);
    let has_behind = all(in_picture(pixel - along) == pixel - along);
    return select(behind, ahead, !has_behind || (has_ahead && abs(ahead.z) < abs(behind.z)));
}

@fragment
fn occlude(in: Fragment) -> @location(0) vec4<f32> {
    let pixel = vec2<i32>(in.clip.xy);
    let p = place(pixel);
    let pixels_per_m = 0.5 * o.size.x / (o.lens.x * p.z);
    let reach_px = min(REACH_M * pixels_per_m, MAX_REACH_PX);
    if reach_px < MIN_REACH_PX {
        return vec4<f32>(1.0);
    }
    let reach = reach_px / pixels_per_m;
    let across = normalize(cross(smaller_step(p, pixel, vec2<i32>(1, 0)), smaller_step(p, pixel, vec2<i32>(0, 1))));
    let n = select(across, -across, dot(across, p) > 0.0);
    // Each pixel of the square has a number of its own; neighbors differ by more than one.
    let cell = vec2<u32>(pixel) & vec2<u32>(3u);
    let own = f32(((cell.x + cell.y) & 3u) * 4u + cell.x) / 16.0;
    var sum = 0.0;
    for (var k = 0u; k < DIRECTIONS; k++) {
        let angle = (f32(k) + own) / f32(DIRECTIONS) * TURN;
        let direction = vec2<f32>(cos(angle), sin(angle));
        var horizon = 0.0;
        for (var s = 0u; s < STEPS; s++) {
            let share = (f32(s) + fract(own * 7.0) + 0.25) / (f32(STEPS) + 0.25);
            let v = place(pixel + vec2<i32>(round(direction * max(share * reach_px, 1.0)))) - p;
            let far = dot(v, v) / (reach * reach);
            let sine = dot(v, n) * inverseSqrt(max(dot(v, v), 1e-8));
            horizon = max(horizon, (sine - MIN_SINE) * max(1.0 - far, 0.0));
        }
        sum += horizon;
    }
    let open = 1.0 - sum / f32(DIRECTIONS);
    return vec4<f32>(open / (1.0 - GAP_REFLECTANCE * (1.0 - open)));
}

@fragment
fn average(in: Fragment) -> @location(0) vec4<f32> {
    let pixel = vec2<i32>(in.clip.xy);
    let here = distance_m(pixel);
    var sum = vec2<f32>(0.0);
    for (var k = 0; k < 16; k++) {
        let at = in_picture(pixel + vec2<i32>(k % 4, k / 4) - 2);
        let weight = max(1.0 - abs(distance_m(at) - here) / (MAX_STEP * here), 0.001);
        sum += weight * vec2<f32>(textureLoad(found, at, 0).r, 1.0);
    }
    return vec4<f32>(sum.x / sum.y);
}
