// Defects, drawn by kind as patches on their members. Lines cover fractions of pixels, so a crack narrower than a pixel
// fades with the ratio of its width to the ground sampling distance, as on a sensor.

// AASHTO code of the pipeline's defects, or one of the codes below.
override KIND: u32 = 0u;
// Stains that belong to a defect, and patterns of cracks (the same values as in scene/defects.rs).
const LIME_STAIN: u32 = 1u;
const RUST_STAIN: u32 = 2u;
const MAP_CRACKS: u32 = 3u;
// Whether to write the defect ID instead of radiance.
override MASK: bool = false;
// Minimum covered fraction of a labeled pixel. A line half a pixel wide, the minimum for detection
// (docs/src/reference/domain.md, "Resolution"), covers at least a quarter of a pixel even if it straddles two.
const MIN_LABELED_COVERAGE: f32 = 0.25;

struct Patch {
    // Center; AASHTO code.
    @location(0) center: vec4<f32>,
    // Normal; a random number in 0..1.
    @location(1) normal: vec4<f32>,
    // Direction of the longest extent; length, m.
    @location(2) along: vec4<f32>,
    // Width, m; condition state; downward direction in the patch's axes.
    @location(3) size: vec4<f32>,
    // Indirect light; half sizes of the quad.
    @location(4) light: vec4<f32>,
    // Color of the paint on steel; defect ID.
    @location(5) tint: vec4<f32>,
}

struct Fragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) p: vec3<f32>,
    @location(1) q: vec2<f32>,
    @location(3) @interpolate(flat) normal: vec4<f32>,
    @location(4) @interpolate(flat) along: vec4<f32>,
    @location(5) @interpolate(flat) size: vec4<f32>,
    @location(6) @interpolate(flat) light: vec2<f32>,
    @location(7) @interpolate(flat) tint: vec3<f32>,
    @location(8) @interpolate(flat) id: f32,
}

@vertex
fn vs(@builtin(vertex_index) k: u32, d: Patch) -> Fragment {
    var corners = array<vec2<f32>, 6>(
        vec2<f32>(-1.0, -1.0), vec2<f32>(1.0, -1.0), vec2<f32>(1.0, 1.0),
        vec2<f32>(-1.0, -1.0), vec2<f32>(1.0, 1.0), vec2<f32>(-1.0, 1.0),
    );
    let q = corners[k] * d.light.zw;
    let across = cross(d.normal.xyz, d.along.xyz);
    var out: Fragment;
    out.p = d.center.xyz + d.along.xyz * q.x + across * q.y;
    // Offset toward the camera, so that the patch is in front of the surface.
    let shown = out.p + d.normal.xyz * 0.0015;
    out.clip = g.view_proj * vec4<f32>(shown, 1.0);
    out.q = q;
    out.normal = d.normal;
    out.along = d.along;
    out.size = d.size;
    out.light = d.light.xy;
    out.tint = d.tint.rgb;
    out.id = d.tint.w;
    return out;
}

struct Look {
    matter: Matter,
    alpha: f32,
}

fn is_fair(in: Fragment) -> bool {
    return in.size.y < 2.5;
}

fn is_severe(in: Fragment) -> bool {
    return in.size.y > 3.5;
}

// Lateral offset of a crack's center line at x, m: straight segments with kinks, up to 25 mm.
fn crack_offset(x: f32, seed: f32, footprint: f32) -> f32 {
    let s = seed * 91.7;
    var y = 0.016 * (noise(vec2<f32>(x * 4.0 + s, s)) * 2.0 - 1.0);
    y += 0.006 * (noise(vec2<f32>(x * 17.0 + s, s + 7.0)) * 2.0 - 1.0) * (1.0 - smoothstep(0.006, 0.03, footprint));
    y += 0.002 * (noise(vec2<f32>(x * 71.0 + s, s + 3.0)) * 2.0 - 1.0) * (1.0 - smoothstep(0.002, 0.008, footprint));
    return y;
}

// Fraction of the pixel covered by the crack; its width ranges from a quarter of the rated width at its ends to 1.3
// times the rated width.
fn crack(in: Fragment, footprint: f32, off: f32) -> f32 {
    let half = 0.5 * in.along.w;
    let x = in.q.x;
    let taper = smoothstep(0.0, 0.12, 1.0 - abs(x) / half);
    let width = in.size.x * mix(0.35, 1.0, taper) * (0.7 + 0.6 * noise(vec2<f32>(x * 23.0, in.normal.w * 50.0)));
    let inside = smoothstep(-footprint, footprint, half - abs(x));
    return cover(abs(off), width, footprint) * inside;
}

// Ragged outline: below 1 inside, in fractions of the half sizes.
fn outline(q: vec2<f32>, half: vec2<f32>, seed: f32) -> f32 {
    let u = q / half;
    let angle = atan2(u.y, u.x);
    let s = seed * 37.0;
    let ragged = 0.86 + 0.16 * (noise(vec2<f32>(3.0 * cos(angle) + s, 3.0 * sin(angle) + s)) - 0.5)
        + 0.10 * (noise(vec2<f32>(9.0 * cos(angle) + s, 9.0 * sin(angle))) - 0.5);
    // The shape is between an ellipse and a box, because broken edges run straight.
    let e = pow(pow(abs(u.x), 3.0) + pow(abs(u.y), 3.0), 1.0 / 3.0);
    return e / ragged;
}

// Depth below the surface, m.
fn pit(q: vec2<f32>, half: vec2<f32>, seed: f32, deepest: f32) -> f32 {
    let e = outline(q, half, seed);
    // Fracture surface around the aggregate: centimeter-sized lumps and nothing finer.
    let rough = lumps(q * 45.0 + seed * 10.0) - 0.5;
    return deepest * smoothstep(1.0, 0.80, e) * (0.8 + 0.36 * rough);
}

// Noise without its finer octaves, regardless of footprint.
fn lumps(p: vec2<f32>) -> f32 {
    return textureSampleLevel(noise_map, noise_sampler, p / 16.0, 3.5).r;
}

fn frame_normal(in: Fragment, slope: vec2<f32>) -> vec3<f32> {
    let across = cross(in.normal.xyz, in.along.xyz);
    return normalize(in.normal.xyz - in.along.xyz * slope.x - across * slope.y);
}

// Fraction of sunlight that reaches a point inside a pit past its edge.
fn pit_edge_shadow(in: Fragment, q: vec2<f32>, half: vec2<f32>, deepest: f32, towards: vec3<f32>) -> f32 {
    let across = cross(in.normal.xyz, in.along.xyz);
    let l = vec3<f32>(dot(towards, in.along.xyz), dot(towards, across), dot(towards, in.normal.xyz));
    if l.z <= 0.02 {
        return 1.0;
    }
    let here = pit(q, half, in.normal.w, deepest);
    let reach = l.xy / l.z * here;
    var lit = 1.0;
    for (var k = 1; k <= 5; k++) {
        let t = f32(k) / 5.0;
        let depth = pit(q + reach * t, half, in.normal.w, deepest);
        lit = min(lit, 1.0 - smoothstep(0.0, 0.25 * deepest, here * (1.0 - t) - depth));
    }
    return lit;
}

// Aggregate with the given number of stones per meter along and across. `bend_m`, m, distorts the round outlines.
fn stones(q: vec2<f32>, bend_m: f32, per_m: vec2<f32>, f: f32) -> vec2<f32> {
    let bent = q + bend_m * (vec2<f32>(fbm(q * 30.0, f * 30.0), fbm(q * 30.0 + 40.0, f * 30.0)) - 0.5);
    return cell_noise(bent * per_m);
}

// Tilt of the stones' faces.
fn stone_tilt(q: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(noise(q * 42.0), noise(q * 42.0 + 11.0)) - 0.5;
}

// Broken concrete in a pit, with the shadow of its edge.
fn broken(in: Fragment, q: vec2<f32>, half: vec2<f32>, deepest: f32, f: f32, look: ptr<function, Look>) {
    let seed = in.normal.w;
    let e = outline(q, half, seed);
    let step = max(0.002, f);
    let here = pit(q, half, seed, deepest);
    let slope = -vec2<f32>(pit(q + vec2<f32>(step, 0.0), half, seed, deepest) - here, pit(q + vec2<f32>(0.0, step), half, seed, deepest) - here) / step;
    // Stones protrude from the mortar, which is paler where it is broken.
    let stone = stones(q, 0.010, vec2<f32>(38.0, 45.0), f);
    let shown = 1.0 - smoothstep(0.006, 0.03, f);
    let stony = shown * (1.0 - smoothstep(0.30, 0.44, stone.x));
    let knob = 0.7 * stony * stone_tilt(q);
    (*look).matter.normal = frame_normal(in, clamp(slope, vec2<f32>(-2.5), vec2<f32>(2.5)) + knob);
    var color = vec3<f32>(0.36, 0.335, 0.295) * (0.75 + 0.5 * fbm(q * 24.0 + seed, f * 24.0));
    let pebble = mix(vec3<f32>(0.20, 0.18, 0.16), vec3<f32>(0.42, 0.37, 0.31), stone.y);
    color = mix(color, pebble, 0.85 * stony);
    // A dark line between mortar and stone.
    color *= 1.0 - 0.3 * shown * (1.0 - smoothstep(0.0, 0.08, abs(stone.x - 0.40)));
    let shelter = smoothstep(0.6, 1.0, e) * smoothstep(0.0, 0.06, deepest);
    (*look).matter.light *= 1.0 - 0.55 * shelter;
    (*look).matter.sunlit = pit_edge_shadow(in, q, half, deepest, g.sun.xyz);
    // The broken edge is a dark line.
    let edge = fwidth(e);
    color *= 1.0 - 0.55 * (1.0 - smoothstep(0.0, 0.06 + edge, abs(e - 0.96)));
    (*look).matter.albedo = color;
    (*look).matter.roughness = 0.95;
    (*look).alpha = 1.0 - smoothstep(1.0 - 0.5 * edge, 1.0 + 0.5 * edge, e);
}

fn rust(q: vec2<f32>, f: f32) -> vec3<f32> {
    let a = fbm(q * 18.0, f * 18.0);
    let b = fbm(q * 70.0 + 9.0, f * 70.0);
    return mix(vec3<f32>(0.085, 0.034, 0.020), vec3<f32>(0.25, 0.105, 0.042), a) * (0.65 + 0.7 * b);
}

fn rebar(in: Fragment, f: f32, look: ptr<function, Look>) {
    let half = vec2<f32>(0.5 * in.along.w, 0.5 * in.size.x);
    broken(in, in.q, half, select(0.035, 0.018, is_fair(in)), f, look);
    let seed = in.normal.w;
    // Bars of 22 to 30 mm along the patch, as many as fit across its width.
    let count = max(1.0, floor(in.size.x / 0.11));
    let gap = in.size.x / count;
    let lane = (fract(in.q.y / gap + 0.5 * count) - 0.5) * gap;
    // Section loss: notches and thin stretches, up to a broken bar.
    let whole = 0.011 + 0.004 * seed;
    let eaten = lumps(vec2<f32>(in.q.x * 30.0 + 17.0 * floor(in.q.y / gap + 0.5 * count), seed * 9.0));
    let loss = select(select(0.0, 0.45, !is_fair(in)), 0.8, is_severe(in)) * smoothstep(0.42, 0.62, eaten);
    let radius = whole * (1.0 - loss);
    let t = clamp(lane / radius, -1.0, 1.0);
    let unbroken = 1.0 - select(0.0, 1.0, is_severe(in)) * smoothstep(0.54, 0.56, eaten);
    let bar = unbroken * cover(abs(lane), 2.0 * radius, f) * (1.0 - smoothstep(0.86, 0.94, outline(in.q, half, seed)));
    let rib = lines(in.q.x + 0.6 * lane, 0.012, 0.004, f);
    // Rust stains on the concrete next to the bars.
    let bleed = exp(-pow(lane / (2.6 * radius), 2.0)) * smoothstep(0.3, 0.7, fbm(in.q * 14.0 + seed * 9.0, f * 14.0));
    (*look).matter.albedo = mix((*look).matter.albedo, vec3<f32>(0.34, 0.16, 0.07), select(0.75, 0.25, is_fair(in)) * bleed);
    // A sound bar has a thin film of rust on gray steel.
    let film = mix(rust(in.q + seed, f), vec3<f32>(0.17, 0.145, 0.125), select(0.0, 0.75, is_fair(in)));
    let steel = film * (1.25 + 0.5 * rib);
    (*look).matter.albedo = mix((*look).matter.albedo, steel, bar);
    // Bars are near the surface, out of the shadow of the edge.
    (*look).matter.sunlit = mix((*look).matter.sunlit, 1.0, 0.7 * bar);
    let round = frame_normal(in, vec2<f32>(0.0, -1.3 * t));
    (*look).matter.normal = normalize(mix((*look).matter.normal, round, bar));
    // Shadow next to a bar.
    let under = (1.0 - bar) * (1.0 - smoothstep(radius, 2.2 * radius, abs(lane)));
    (*look).matter.albedo *= 1.0 - 0.5 * under * (1.0 - smoothstep(0.9, 1.0, outline(in.q, half, seed)));
}

// Efflorescence: white deposits that run down from a joint or crack, with rust in worse condition states.
fn lime(in: Fragment, f: f32, look: ptr<function, Look>) {
    let half = vec2<f32>(0.5 * in.along.w, 0.5 * in.size.x);
    let seed = in.normal.w;
    let u = in.q / half;
    let wall = abs(in.size.z) > 0.3;
    var body = 0.0;
    // Irregular paths of the runs.
    let y = in.q.y + 0.05 * (lumps(in.q * 13.0 + seed * 3.0) - 0.5) + 0.018 * (fbm(in.q * 31.0, f * 31.0) - 0.5);
    if wall {
        // x runs downhill: a source at the top, tongues below it.
        let down = 0.5 + 0.5 * u.x * sign(in.size.z);
        let tongue = fbm(vec2<f32>(y * 17.0 + seed * 40.0, in.q.x * 1.2), f * 17.0);
        let drip = fbm(vec2<f32>(y * 55.0 + seed * 11.0, in.q.x * 2.5), f * 55.0);
        let side = 1.0 - smoothstep(0.25, 1.0, abs(u.y) + 0.9 * (tongue - 0.5));
        let reach = (0.15 + 0.95 * tongue + 0.35 * (drip - 0.5)) * (0.55 + 0.75 * side);
        let top = smoothstep(0.0, 0.03 + 0.06 * drip, down - 0.10 * drip);
        body = top * (1.0 - smoothstep(reach - 0.10, reach + 0.12, down)) * smoothstep(0.0, 0.25, side) * (0.65 + 0.5 * drip);
    } else {
        let web = abs(fbm(in.q * 9.0 + seed * 20.0, f * 9.0) - 0.5);
        body = (1.0 - smoothstep(0.02, 0.12, web)) * (1.0 - smoothstep(0.6, 1.0, outline(in.q, half, seed)));
        body = max(body, smoothstep(0.6, 0.72, fbm(in.q * 5.0 + seed * 8.0, f * 5.0)) * (1.0 - smoothstep(0.5, 0.9, length(u))));
    }
    // Crusts: thick ones are white, thin ones are translucent.
    let crust = fbm(in.q * 60.0, f * 60.0);
    let patches = smoothstep(0.30, 0.70, fbm(in.q * vec2<f32>(11.0, 23.0) + seed * 5.0, f * 23.0));
    let thick = clamp(body * (0.25 + 0.75 * patches) + 0.7 * (crust - 0.5), 0.0, 1.0);
    var color = mix(vec3<f32>(0.50, 0.48, 0.44), vec3<f32>(0.80, 0.79, 0.75), smoothstep(0.3, 0.8, thick)) * (0.60 + 0.7 * crust);
    if in.size.y > 2.5 {
        let from_share = select(0.45, 0.30, is_severe(in));
        let stain = smoothstep(from_share, from_share + 0.30, fbm(vec2<f32>(y * 19.0 + 5.0 + seed, in.q.x * 1.2), f * 19.0));
        color = mix(color, vec3<f32>(0.38, 0.17, 0.06), 0.75 * stain);
    }
    (*look).matter.albedo = color;
    (*look).matter.roughness = 0.8;
    let turned = vec2<f32>(0.8 * in.q.x - 0.6 * in.q.y, 0.6 * in.q.x + 0.8 * in.q.y);
    let bump = 0.35 * (vec2<f32>(fbm(turned * 40.0, f * 40.0), fbm(turned * 40.0 + 19.0, f * 40.0)) - 0.5) * (1.0 - smoothstep(0.004, 0.02, f));
    (*look).matter.normal = frame_normal(in, bump);
    (*look).alpha = smoothstep(0.10, 0.60, thick) * min(1.0, 1.6 * body) * 0.94;
    if is_severe(in) {
        // The concrete around the deposits is wet and dark.
        let wet = 0.55 * (1.0 - smoothstep(0.55, 1.0, outline(in.q, half, seed)));
        let crusted = (*look).alpha;
        (*look).matter.albedo = mix(vec3<f32>(0.085, 0.080, 0.070), (*look).matter.albedo, crusted / max(crusted + wet * (1.0 - crusted), 1e-3));
        (*look).alpha = crusted + wet * (1.0 - crusted);
    }
}

// Lime beside a crack in an underside: it follows the crack, whose course depends on the same number.
fn seam(in: Fragment, f: f32, off: f32, look: ptr<function, Look>) {
    let half = 0.5 * in.along.w;
    let seed = in.normal.w;
    let ends = 1.0 - smoothstep(0.75 * half, half, abs(in.q.x));
    let patches = smoothstep(0.30, 0.62, fbm(vec2<f32>(in.q.x * 7.0 + seed * 21.0, seed * 5.0), f * 7.0));
    let crust = fbm(in.q * 60.0, f * 60.0);
    let reach = 0.003 + 0.016 * patches * crust;
    // The drawing's edges must not show.
    let faded = 1.0 - smoothstep(0.45, 0.95, abs(in.q.y) / (0.5 * in.size.x));
    (*look).matter.albedo = mix(vec3<f32>(0.50, 0.48, 0.44), vec3<f32>(0.80, 0.79, 0.75), patches) * (0.60 + 0.7 * crust);
    (*look).matter.roughness = 0.8;
    (*look).alpha = ends * faded * min(0.92, 1.7 * leakage(off, reach, f)) * (0.30 + 0.70 * patches) * (0.55 + 0.75 * crust);
}

// Rust that runs down a wall from its source at the upper end.
fn rust_run(in: Fragment, f: f32, look: ptr<function, Look>) {
    let half = vec2<f32>(0.5 * in.along.w, 0.5 * in.size.x);
    let seed = in.normal.w;
    let u = in.q / half;
    let y = in.q.y + 0.03 * (lumps(in.q * 13.0 + seed * 3.0) - 0.5);
    let down = 0.5 + 0.5 * u.x * sign(in.size.z);
    let tongue = fbm(vec2<f32>(y * 21.0 + seed * 40.0, in.q.x * 0.9), f * 21.0);
    let drip = fbm(vec2<f32>(y * 70.0 + seed * 11.0, in.q.x * 2.0), f * 70.0);
    let side = (1.0 - smoothstep(0.30, 1.0, abs(u.y) + 0.7 * (tongue - 0.5))) * (1.0 - smoothstep(0.70, 1.0, abs(u.y)));
    let reach = (0.25 + 0.95 * tongue + 0.3 * (drip - 0.5)) * (0.6 + 0.6 * side);
    let body = side * smoothstep(0.0, 0.04, down) * (1.0 - smoothstep(0.2 * reach, reach + 0.05, down));
    (*look).matter.albedo = mix(vec3<f32>(0.30, 0.135, 0.055), vec3<f32>(0.15, 0.062, 0.030), drip);
    (*look).matter.roughness = 0.9;
    (*look).alpha = 0.78 * body * (0.55 + 0.6 * drip);
}

// Distance of a point from the border between the nearest two of the randomly placed cells of size 1.
fn cell_border(p: vec2<f32>) -> f32 {
    let base = vec2<i32>(floor(p));
    var first = 9.0;
    var second = 9.0;
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            let cell = base + vec2<i32>(x, y);
            let spot = vec2<f32>(cell) + 0.5 + 0.72 * (vec2<f32>(hash2(cell), hash2(cell + vec2<i32>(71, 13))) - 0.5);
            let d = distance(p, spot);
            second = min(second, max(first, d));
            first = min(first, d);
        }
    }
    return 0.5 * (second - first);
}

// Map cracking: a network of cracks with gel and lime on their edges. Worse states have smaller cells and wider cracks.
fn map_cracks(in: Fragment, f: f32, look: ptr<function, Look>) {
    let half = vec2<f32>(0.5 * in.along.w, 0.5 * in.size.x);
    let seed = in.normal.w;
    let cell = select(select(0.15, 0.22, is_fair(in)), 0.11, is_severe(in));
    let width = select(select(0.0028, 0.0012, is_fair(in)), 0.0055, is_severe(in));
    let bent = in.q + 0.035 * (vec2<f32>(lumps(in.q * 16.0 + seed * 7.0), lumps(in.q * 16.0 + 31.0 + seed * 7.0)) - 0.5)
        + 0.012 * (vec2<f32>(fbm(in.q * 33.0, f * 33.0), fbm(in.q * 33.0 + 17.0, f * 33.0)) - 0.5);
    let d = cell * cell_border(bent / cell + seed * 50.0);
    let line = cover(d, width * (0.6 + 0.8 * noise(in.q * 19.0 + seed * 3.0)), f);
    let gel = select(select(0.50, 0.30, is_fair(in)), 0.60, is_severe(in));
    let rim = gel * leakage(d, select(0.006, 0.004, is_fair(in)), f) * smoothstep(0.35, 0.65, fbm(in.q * 9.0 + seed * 13.0, f * 9.0));
    let inside = 1.0 - smoothstep(0.72, 1.0, outline(in.q, half, seed));
    // Damp concrete beside the cracks is darker.
    let damp = select(0.16, 0.08, is_fair(in)) * leakage(d, 0.02, f);
    // In the worst state, pieces between the cracks have come off.
    let own = hash2(vec2<i32>(floor(bent / cell + seed * 50.0)));
    let lost = select(0.0, 1.0, is_severe(in) && own > 0.80) * smoothstep(0.010, 0.016, d);
    let veil = max(rim, damp);
    let pale = mix(vec3<f32>(0.10, 0.095, 0.085), vec3<f32>(0.66, 0.65, 0.62), rim / max(rim + damp, 1e-4));
    var color = mix(pale, vec3<f32>(0.012, 0.011, 0.010), line / max(line + (1.0 - line) * veil, 1e-4));
    color = mix(color, vec3<f32>(0.30, 0.28, 0.245) * (0.6 + 0.7 * fbm(in.q * 30.0, f * 30.0)), lost);
    (*look).matter.albedo = color;
    (*look).matter.roughness = 0.95;
    (*look).alpha = inside * max(line + (1.0 - line) * veil, 0.9 * lost);
}

// Abrasion: the surface layer is missing, which exposes aggregate.
fn worn(in: Fragment, f: f32, look: ptr<function, Look>) {
    let half = vec2<f32>(0.5 * in.along.w, 0.5 * in.size.x);
    let e = outline(in.q, half, in.normal.w) + 0.35 * (fbm(in.q * 12.0, f * 12.0) - 0.5);
    let stone = stones(in.q, 0.012, vec2<f32>(38.0, 47.0), f);
    let shown = 1.0 - smoothstep(0.006, 0.025, f);
    let pebble = mix(vec3<f32>(0.16, 0.15, 0.14), vec3<f32>(0.52, 0.47, 0.40), stone.y);
    let paste = vec3<f32>(0.25, 0.235, 0.21);
    let mask = 1.0 - smoothstep(0.30, 0.46, stone.x);
    (*look).matter.albedo = mix(vec3<f32>(0.27, 0.25, 0.225), mix(paste, pebble, mask), shown) * (0.85 + 0.4 * (fbm(in.q * 5.0, f * 5.0) - 0.5));
    let bump = select(1.2, 0.5, is_fair(in)) * mask * stone_tilt(in.q) * shown;
    (*look).matter.normal = frame_normal(in, bump);
    if !is_fair(in) {
        // Loose stones have fallen out and left dark sockets.
        let gone = smoothstep(select(0.74, 0.52, is_severe(in)), select(0.78, 0.56, is_severe(in)), stone.y) * mask * shown;
        (*look).matter.albedo = mix((*look).matter.albedo, vec3<f32>(0.055, 0.050, 0.045), 0.85 * gone);
        (*look).matter.light *= 1.0 - 0.4 * gone;
    }
    if is_severe(in) {
        let hollow = smoothstep(0.35, 0.75, lumps(in.q * 9.0 + in.normal.w * 6.0));
        (*look).matter.albedo *= 1.0 - 0.55 * hollow;
    }
    // In a fair state, patches of the surface remain.
    let kept = select(0.0, 0.8 * smoothstep(0.50, 0.62, fbm(in.q * 10.0 + in.normal.w * 3.0, f * 10.0)), is_fair(in));
    (*look).alpha = (1.0 - smoothstep(0.78, 1.02, e)) * (1.0 - kept);
}

// Mortar breakdown: joints between the stones of a wall that are open, deep and dark. In worse states, they are wider, and stones are loose.
fn open_joints(in: Fragment, f: f32, look: ptr<function, Look>) {
    let half = vec2<f32>(0.5 * in.along.w, 0.5 * in.size.x);
    let seed = in.normal.w;
    let width = select(select(0.036, 0.022, is_fair(in)), 0.052, is_severe(in)) * (0.75 + 0.5 * fbm(in.q * 13.0 + seed * 9.0, f * 13.0));
    let wall = stones_in_courses(wall_position(in.p, in.normal.xyz), width, f);
    let inside = 1.0 - smoothstep(0.70, 1.0, outline(in.q, half, seed) + 0.3 * (fbm(in.q * 7.0 + seed * 5.0, f * 7.0) - 0.5));
    // Remains of mortar in the joints.
    let kept = select(0.0, smoothstep(0.52, 0.60, fbm(in.q * 9.0 + seed * 17.0, f * 9.0)), is_fair(in));
    let open = wall.x * inside * (1.0 - kept);
    // Washed-out mortar has left a pale veil beside the joints.
    let beside = stones_in_courses(wall_position(in.p, in.normal.xyz), 3.2 * width, f).x * inside * smoothstep(0.35, 0.65, fbm(in.q * 15.0, f * 15.0));
    var color = mix(vec3<f32>(0.33, 0.31, 0.27), vec3<f32>(0.012, 0.011, 0.010), open / max(max(open, 0.3 * beside), 1e-4));
    (*look).alpha = max(open, 0.3 * beside);
    if !is_fair(in) {
        // Stones beside empty joints are loose; the worst have fallen out.
        let gone = select(0.0, 1.0, wall.y > select(1.1, 0.72, is_severe(in))) * (1.0 - wall.x) * smoothstep(0.5, 0.9, inside);
        color = mix(color, vec3<f32>(0.035, 0.031, 0.026) * (0.6 + 0.8 * fbm(in.q * 19.0, f * 19.0)), gone);
        (*look).alpha = max((*look).alpha, 0.96 * gone);
    }
    (*look).matter.albedo = color;
    (*look).matter.roughness = 0.95;
}

// A split stone: its face has come off along a bed of the stone, which leaves a fresh, stepped surface.
fn split_stone(in: Fragment, f: f32, look: ptr<function, Look>) {
    let half = vec2<f32>(0.5 * in.along.w, 0.5 * in.size.x);
    let seed = in.normal.w;
    broken(in, in.q, half, select(select(0.05, 0.025, is_fair(in)), 0.09, is_severe(in)), f, look);
    let beds = fbm(vec2<f32>(in.q.x * 3.0 + seed * 7.0, in.q.y * 26.0), f * 26.0);
    let grain = fbm(in.q * 55.0 + seed * 3.0, f * 55.0);
    var color = mix(vec3<f32>(0.26, 0.215, 0.155), vec3<f32>(0.46, 0.39, 0.29), smoothstep(0.35, 0.65, beds)) * (0.65 + 0.7 * grain);
    let e = outline(in.q, half, seed);
    color *= 1.0 - 0.5 * (1.0 - smoothstep(0.0, 0.08 + fwidth(e), abs(e - 0.95)));
    if !is_fair(in) {
        // A crack through the stone, which has shifted.
        let crooked = in.q.x - 0.12 * half.x + 0.10 * half.x * (noise(vec2<f32>(in.q.y * 9.0, seed * 31.0)) - 0.5);
        color *= 1.0 - 0.9 * cover(abs(crooked), select(0.004, 0.012, is_severe(in)), f);
    }
    (*look).matter.albedo = color;
}

// Corrosion: missing paint, flaking rust, and a stain that runs down.
fn corrosion(in: Fragment, f: f32, look: ptr<function, Look>) {
    let half = vec2<f32>(0.5 * in.along.w, 0.5 * in.size.x);
    let seed = in.normal.w;
    let e = outline(in.q, half, seed);
    let eaten = e + 0.9 * (fbm(in.q * 11.0 + seed * 30.0, f * 11.0) - 0.5);
    let core = 1.0 - smoothstep(0.72, 0.78 + f * 4.0, eaten);
    let rim = (1.0 - smoothstep(0.0, 0.05 + f, abs(eaten - 0.78)));
    let stain = 1.0 - smoothstep(0.8, 1.15, e);
    var color = rust(in.q + seed * 3.0, f);
    let flake = cell_noise(in.q * vec2<f32>(30.0, 55.0));
    let shown = 1.0 - smoothstep(0.004, 0.02, f);
    color *= 1.0 + 0.7 * shown * (flake.y - 0.5);
    let halo = mix(in.tint, vec3<f32>(0.30, 0.12, 0.04), 0.65);
    (*look).matter.albedo = mix(mix(halo, in.tint * 1.3, 0.6 * rim), color, core);
    let bump = 1.6 * core * shown * (vec2<f32>(noise(in.q * 40.0), noise(in.q * 40.0 + 23.0)) - 0.5);
    (*look).matter.normal = frame_normal(in, bump);
    (*look).matter.roughness = mix(0.6, 0.95, core);
    (*look).alpha = max(core, max(0.85 * rim * stain, 0.55 * stain * smoothstep(0.35, 0.6, fbm(in.q * 6.0 + 4.0, f * 6.0))));
    if is_fair(in) {
        freckles(in, f, e, look);
    } else if is_severe(in) {
        // A hole in the plate, with a ragged edge of thin steel.
        let gone = eaten + 0.25 * (fbm(in.q * 37.0 + seed * 8.0, f * 37.0) - 0.5);
        let hole = 1.0 - smoothstep(0.34, 0.36 + f * 3.0, gone);
        let lip = 1.0 - smoothstep(0.0, 0.04 + f, abs(gone - 0.37));
        (*look).matter.albedo = mix((*look).matter.albedo * (1.0 + 0.8 * lip), vec3<f32>(0.004), hole);
        (*look).alpha = max((*look).alpha, hole);
    }
}

// Freckled rust: spots that break through the paint, which is otherwise in place.
fn freckles(in: Fragment, f: f32, e: f32, look: ptr<function, Look>) {
    let seed = in.normal.w;
    let dense = smoothstep(0.15, 0.55, fbm(in.q * 9.0 + seed * 30.0, f * 9.0));
    let inside = 1.0 - smoothstep(0.75, 1.0, e);
    let small = cell_noise(in.q * 70.0 + seed * 11.0);
    let large = cell_noise(in.q * 26.0 + seed * 5.0);
    let spot = max((1.0 - smoothstep(0.14, 0.30, small.x)) * step(0.25, small.y), (1.0 - smoothstep(0.20, 0.42, large.x)) * step(0.40, large.y));
    let shown = 1.0 - smoothstep(0.003, 0.015, f);
    let halo = 0.30 * dense;
    let rusted = mix(0.30, spot, shown) * (0.35 + 0.65 * dense);
    (*look).matter.albedo = mix(mix(in.tint, vec3<f32>(0.30, 0.12, 0.04), 0.6), rust(in.q * 1.7 + seed * 3.0, f), rusted);
    (*look).matter.normal = in.normal.xyz;
    (*look).matter.roughness = mix(0.6, 0.95, rusted);
    (*look).alpha = inside * max(rusted, halo);
}

// Rows of bolts on a splice plate; some are missing, and rust bleeds from their holes.
fn bolts(in: Fragment, f: f32, look: ptr<function, Look>) {
    let half = vec2<f32>(0.5 * in.along.w, 0.5 * in.size.x);
    let inside = max(abs(in.q.x) / half.x, abs(in.q.y) / half.y);
    let pitch = max(0.032, min(0.07, in.size.x * 0.45));
    // Shows only complete bolts, in centered rows; a narrow plate has one row.
    let count = max(vec2<f32>(1.0), floor(2.0 * half / pitch));
    let cell = clamp(floor(in.q / pitch + 0.5 * count), vec2<f32>(0.0), count - 1.0);
    let at = in.q - (cell + 0.5 - 0.5 * count) * pitch;
    let d = length(at);
    let radius = 0.3 * pitch;
    let luck = hash2(vec2<i32>(cell) + vec2<i32>(i32(in.normal.w * 1000.0), 3));
    let first = all(cell == floor(0.5 * count));
    // In a fair state, bolts are loose; in worse ones, they are missing.
    let worst = select(0.88, 0.50, is_severe(in));
    let affected = select(0.0, 1.0, luck > select(worst, 0.75, is_fair(in)) || first);
    let missing = select(affected, 0.0, is_fair(in));
    let loose = affected - missing;
    let head = cover(d, 2.0 * radius, f);
    var color = in.tint * 0.92;
    let hole = cover(d, 1.3 * radius, f);
    let ring = cover(abs(d - 0.95 * radius), 0.35 * radius, f);
    let gone = mix(mix(color, vec3<f32>(0.45, 0.42, 0.38), ring), vec3<f32>(0.008), hole);
    let bolt = mix(color, in.tint * (1.25 - 0.8 * smoothstep(0.6 * radius, radius, d)), head);
    color = mix(bolt, gone, missing);
    // A loose head has turned: a bright crescent of bare steel beside it, and a dark gap below it.
    let slid = cover(abs(length(at - vec2<f32>(0.35, 0.2) * radius) - 1.05 * radius), 0.28 * radius, f) * loose * (1.0 - head);
    color = mix(color, vec3<f32>(0.50, 0.47, 0.43), 0.8 * slid);
    color *= 1.0 - 0.65 * loose * cover(abs(d - 1.02 * radius), 0.22 * radius, f);
    let bleed = smoothstep(0.2, 0.6, fbm(in.q * 25.0 + in.normal.w * 9.0, f * 25.0)) * max(missing, 0.7 * loose) * (1.0 - smoothstep(radius, 0.5 * pitch, d));
    color = mix(color, rust(in.q, f), 0.8 * bleed * (1.0 - max(hole * missing, 0.75 * head * loose)));
    if is_severe(in) {
        // Pack rust bursts out at the plate's edge.
        let swollen = smoothstep(0.62, 0.90, inside + 0.35 * (fbm(in.q * 21.0 + in.normal.w * 5.0, f * 21.0) - 0.5));
        color = mix(color, rust(in.q * 1.4 + 2.0, f), 0.9 * swollen * (1.0 - hole * missing));
    }
    let plate = cover(abs(inside - 0.97) * min(half.x, half.y), 0.004, f);
    (*look).matter.albedo = color * (1.0 - 0.6 * plate);
    (*look).matter.normal = frame_normal(in, -at / radius * 0.8 * head * (1.0 - missing));
    (*look).matter.roughness = 0.5;
    (*look).alpha = 1.0 - smoothstep(0.98, 1.0, inside);
}

// Fatigue crack: a line in steel that bleeds rust, along the toe of a weld.
fn fatigue(in: Fragment, f: f32, off: f32, look: ptr<function, Look>) {
    let line = crack(in, f, off);
    let half = 0.5 * in.along.w;
    let near = leakage(off, 0.006, f) * (1.0 - smoothstep(half * 0.95, half * 1.05 + f, abs(in.q.x)));
    var bleed = 0.95 * near * (0.45 + 0.55 * fbm(vec2<f32>(in.q.x * 60.0, in.q.y * 9.0), f * 60.0));
    if is_severe(in) {
        // An open crack bleeds far.
        bleed = max(bleed, 0.9 * leakage(off, 0.014, f) * (1.0 - smoothstep(half * 0.9, half * 1.05 + f, abs(in.q.x))) * smoothstep(0.25, 0.6, fbm(in.q * 40.0, f * 40.0)));
    }
    // An arrested crack ends in holes that were drilled at its tips, and no longer bleeds.
    let tip = length(vec2<f32>(abs(in.q.x) - half, off));
    let arrested = select(0.0, 1.0, is_fair(in));
    let drilled = arrested * cover(tip, 0.022, f);
    let bare = arrested * cover(abs(tip - 0.013), 0.004, f);
    bleed *= 1.0 - 0.75 * arrested;
    let sick = max(max(line, bleed), max(drilled, bare));
    (*look).matter.albedo = mix(vec3<f32>(0.30, 0.12, 0.045), vec3<f32>(0.012), line);
    (*look).matter.albedo = mix(mix((*look).matter.albedo, vec3<f32>(0.50, 0.48, 0.45), bare), vec3<f32>(0.006), drilled);
    (*look).alpha = sick;
    // The weld itself is sound and is not labeled.
    if !MASK {
        let bead = weld(in, f, half, look);
        (*look).matter.albedo = mix(in.tint * bead.y, (*look).matter.albedo, sick);
        (*look).alpha = max(sick, bead.x);
    }
}

const WELD_M: f32 = 0.009;
const RIPPLE_M: f32 = 0.0045;

// Weld bead next to the crack, rippled and painted: pixel coverage and brightness of its paint.
fn weld(in: Fragment, f: f32, half: f32, look: ptr<function, Look>) -> vec2<f32> {
    let across = in.q.y + 0.5 * WELD_M + 0.002;
    let round = max(abs(in.q.x) - half - 0.012, 0.0);
    let d = length(vec2<f32>(across, round));
    let t = clamp(across / (0.5 * WELD_M), -1.0, 1.0);
    // Fades out before a ripple shrinks to two pixels.
    let near = 1.0 - smoothstep(0.25 * RIPPLE_M, 0.5 * RIPPLE_M, f);
    // The ripples of the bead are curved.
    let scale = (fract((in.q.x - 0.35 * t * t * WELD_M) / RIPPLE_M) - 0.5) * near;
    (*look).matter.normal = frame_normal(in, vec2<f32>(0.30 * scale, -0.40 * t * near));
    return vec2<f32>(cover(d, WELD_M, f), 1.0 - 0.2 * abs(scale) - 0.1 * abs(t));
}

fn cracked(in: Fragment, f: f32, off: f32, look: ptr<function, Look>) {
    let line = crack(in, f, off);
    // Some cracks have lime deposits.
    let half = 0.5 * in.along.w;
    let limed = select(0.0, 1.0, fract(in.normal.w * 7.0) > 0.55);
    let rim = limed * leakage(off, 0.007, f) * smoothstep(0.45, 0.7, noise(vec2<f32>(in.q.x * 9.0, in.normal.w * 31.0)))
        * (1.0 - smoothstep(0.85 * half, half, abs(in.q.x)));
    // The gap is in the lime, not below it.
    let veil = (1.0 - line) * 0.35 * rim;
    (*look).matter.albedo = mix(vec3<f32>(0.66, 0.65, 0.62), vec3<f32>(0.012, 0.011, 0.010), line / max(line + veil, 1e-4));
    (*look).matter.roughness = 0.95;
    (*look).alpha = line + veil;
    if is_severe(in) {
        // The edges of a severe crack crumble.
        let side = select(11.0, 53.0, off > 0.0) + in.normal.w * 40.0;
        let chipped = smoothstep(0.52, 0.62, noise(vec2<f32>(in.q.x * 21.0 + side, side)));
        let ragged = 0.002 + 0.016 * chipped * (0.5 + noise(vec2<f32>(in.q.x * 110.0, side)));
        let crumbled = (1.0 - smoothstep(ragged - f, ragged + f, abs(off))) * (1.0 - smoothstep(0.85 * half, half, abs(in.q.x))) * (1.0 - line);
        let depth = 1.0 - abs(off) / ragged;
        let paste = vec3<f32>(0.36, 0.335, 0.295) * (0.35 + 0.9 * fbm(in.q * 90.0, f * 90.0)) * (1.0 - 0.5 * clamp(depth, 0.0, 1.0));
        (*look).matter.albedo = mix((*look).matter.albedo, paste, crumbled);
        (*look).alpha = max((*look).alpha, 0.9 * crumbled);
    }
}

@fragment
fn fs(in: Fragment) -> @location(0) vec4<f32> {
    let f = max(length(vec2<f32>(dpdx(in.q.x), dpdy(in.q.x))), length(vec2<f32>(dpdx(in.q.y), dpdy(in.q.y))));
    // A crack along a weld is nearly straight.
    let off = in.q.y - select(1.0, 0.15, KIND == 1010u) * crack_offset(in.q.x, in.normal.w, f);
    // Size of a pixel across the line.
    let across = length(vec2<f32>(dpdx(in.q.y), dpdy(in.q.y)));
    var look: Look;
    look.matter.normal = in.normal.xyz;
    look.matter.face = in.normal.xyz;
    look.matter.roughness = 0.9;
    look.matter.metal = 0.0;
    look.matter.light = in.light;
    look.matter.sunlit = 1.0;
    look.matter.albedo = vec3<f32>(0.4);
    look.alpha = 0.0;
    let half = vec2<f32>(0.5 * in.along.w, 0.5 * in.size.x);
    if KIND == 1000u {
        corrosion(in, f, &look);
    } else if KIND == 1010u {
        fatigue(in, across, off, &look);
    } else if KIND == 1020u {
        bolts(in, f, &look);
    } else if KIND == 1080u {
        broken(in, in.q, half, select(select(0.018, 0.05, in.size.y > 2.5), 0.09, is_severe(in)), f, &look);
    } else if KIND == 1090u {
        rebar(in, f, &look);
    } else if KIND == 1110u || KIND == 1130u {
        cracked(in, across, off, &look);
    } else if KIND == 1610u {
        open_joints(in, f, &look);
    } else if KIND == 1620u {
        split_stone(in, f, &look);
    } else if KIND == MAP_CRACKS {
        map_cracks(in, f, &look);
    } else if KIND == RUST_STAIN {
        rust_run(in, f, &look);
    } else if KIND == LIME_STAIN && abs(in.size.z) <= 0.3 {
        seam(in, across, off, &look);
    } else if KIND == 1120u || KIND == LIME_STAIN {
        lime(in, f, &look);
    } else {
        worn(in, f, &look);
    }
    if MASK {
        if look.alpha < MIN_LABELED_COVERAGE {
            discard;
        }
        return vec4<f32>(0.0, in.id, 0.0, 1.0);
    }
    if look.alpha <= 0.002 {
        discard;
    }
    look.matter.light *= ambient_share(in.clip.xy);
    let alpha = clamp(look.alpha, 0.0, 1.0);
    return vec4<f32>(exposed(shade(look.matter, in.p)).rgb * alpha, alpha);
}
