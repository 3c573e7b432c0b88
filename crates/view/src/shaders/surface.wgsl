// Draws solid surfaces.

// Material group of the pipeline (material_groups.rs): 0 concrete, 1 deck, 2 steel, 3 simple, 4 ground.
override LOOK: u32 = 3u;
// Whether to draw the lake's reflection.
override MIRRORED: bool = false;
// Whether to write the bridge element number instead of radiance.
override MASK: bool = false;

struct Corner {
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    @location(3) light: vec2<f32>,
    @location(4) material: u32,
    @location(5) tint: vec4<f32>,
    @location(9) aux: f32,
    @location(6) row0: vec4<f32>,
    @location(7) row1: vec4<f32>,
    @location(8) row2: vec4<f32>,
    @location(10) paint: vec4<f32>,
    // Indirect light from above (sky, sun) and below (sky, sun).
    @location(11) around: vec4<f32>,
}

struct Fragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) p: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    @location(3) light: vec2<f32>,
    @location(4) @interpolate(flat) material: u32,
    @location(5) tint: vec4<f32>,
    @location(6) aux: f32,
}

// Displacement of a tree in the wind at a height between 0 (foot) and 1 (top): bent like a beam, swaying about its mean. Neighbors sway
// one after the other as a gust passes: 40 m is one period (estimate).
fn swayed(p: vec2<f32>, height: f32) -> vec2<f32> {
    let phase = g.trees.z - 0.157 * dot(p, g.look.zw);
    let bend = g.trees.xy * (height * height);
    return bend * (1.0 + 0.8 * sin(phase)) + 0.4 * vec2<f32>(-bend.y, bend.x) * cos(0.5 * phase + 0.3 * p.x);
}

fn placed(v: Corner) -> Fragment {
    let at = vec4<f32>(v.position, 1.0);
    var out: Fragment;
    out.p = vec3<f32>(dot(v.row0, at), dot(v.row1, at), dot(v.row2, at));
    out.normal = normalize(vec3<f32>(dot(v.row0.xyz, v.normal), dot(v.row1.xyz, v.normal), dot(v.row2.xyz, v.normal)));
    // Only the place in the picture moves: light and shadows stay those of the tree at rest, as its shadow does.
    var shown = out.p;
    if LOOK == 3u {
        let kind = v.material & 0xffu;
        shown += vec3<f32>(swayed(out.p.xy, select(0.0, v.aux, kind == 5u || kind == 6u)), 0.0);
    }
    out.clip = g.view_proj * vec4<f32>(shown, 1.0);
    out.uv = v.uv;
    out.light = v.light * mix(v.around.zw, v.around.xy, 0.5 + 0.5 * out.normal.z);
    // The element number is stored above the material.
    out.material = select(v.material & 0xffu, v.material >> 8u, MASK);
    // The instance's paint applies only to painted parts.
    out.tint = select(v.tint, vec4<f32>(v.paint.rgb, 1.0), v.paint.w > 0.5 && (v.material & 0xffu) == 8u);
    out.aux = v.aux;
    return out;
}

@vertex
fn vs(v: Corner) -> Fragment {
    return placed(v);
}

// Size of the concrete cells that may contain a distractor, m.
const DISTRACTOR_CELL_M: vec2<f32> = vec2<f32>(5.3, 3.7);
// Maximum height of spray paint above the water, m: within reach from the ground, a boat, or a ladder (estimate).
const MAX_SPRAY_PAINT_HEIGHT_M: f32 = 12.0;

// Distractors left by people and spiders (docs/src/reference/domain.md, "Defects"): at most one per cell, and none in
// most cells. Weathering and formwork marks are drawn with the concrete.
fn befriended(color: vec3<f32>, in: Fragment, n: vec3<f32>, f: f32) -> vec3<f32> {
    let at = floor(in.uv / DISTRACTOR_CELL_M);
    // Parallel faces share coordinates but must have different distractors.
    let plane = i32(floor(0.7 * dot(in.p, n) + 0.377));
    let cell = vec2<i32>(at) + plane * vec2<i32>(31, 17);
    let luck = hash2(cell + vec2<i32>(401, 97));
    if luck < 0.70 {
        return color;
    }
    let own = hash2(cell + vec2<i32>(13, 211));
    let q = in.uv - (at + 0.5) * DISTRACTOR_CELL_M;
    if luck < 0.80 {
        if abs(n.z) < 0.5 && in.p.z - q.y - g.scene.y < MAX_SPRAY_PAINT_HEIGHT_M {
            return sprayed(color, q, own, f);
        }
        return color;
    }
    if luck < 0.89 {
        return sealed(color, q, own, f);
    }
    return webbed(color, q - vec2<f32>(1.8, 1.2) * (vec2<f32>(own, fract(own * 7.0)) - 0.5), own, f);
}

// A sealed crack: a band of resin with the round marks of the injection ports.
fn sealed(color: vec3<f32>, q: vec2<f32>, own: f32, f: f32) -> vec3<f32> {
    let turn = 0.9 * (own - 0.5);
    let axis = vec2<f32>(sin(turn), cos(turn));
    let along = dot(q, axis);
    let bent = 0.16 * (noise(vec2<f32>(along * 1.3, own * 50.0)) - 0.5) + 0.04 * (noise(vec2<f32>(along * 6.0, own * 90.0)) - 0.5);
    let across = q.x * axis.y - q.y * axis.x - bent;
    let beyond = max(abs(along) - 0.8 - 0.6 * fract(own * 5.0), 0.0);
    let band = cover(length(vec2<f32>(across, beyond)), 0.030 + 0.014 * noise(vec2<f32>(along * 11.0, own * 20.0)), f);
    let port = length(vec2<f32>(across, (fract(along / 0.28) - 0.5) * 0.28));
    let foot = cover(port, 0.055, f) * step(beyond, 0.0);
    let resin = vec3<f32>(0.45, 0.435, 0.385) * (0.90 + 0.2 * noise(q * 23.0));
    let sealed_over = mix(color, resin, 0.9 * max(band, foot));
    return mix(sealed_over, vec3<f32>(0.17, 0.165, 0.155), cover(port, 0.016, f) * step(beyond, 0.0));
}

// A dusty spider web.
fn webbed(color: vec3<f32>, q: vec2<f32>, own: f32, f: f32) -> vec3<f32> {
    let d = length(q);
    let reach = 0.15 + 0.10 * own;
    if d > reach {
        return color;
    }
    let turns = atan2(q.y, q.x) / (2.0 * PI) * 14.0;
    let spoke = abs(fract(turns) - 0.5) * 2.0 * PI * d / 14.0;
    // Threads sag between spokes.
    let sag = 0.10 * d * (1.0 - 4.0 * (fract(turns) - 0.5) * (fract(turns) - 0.5));
    let threads = max(cover(0.22 * d - min(spoke, 0.22 * d), 0.0014, f), lines(d + sag, 0.014, 0.0010, f));
    let gone = smoothstep(0.68, 0.85, noise(q * 9.0 + own * 40.0)) + smoothstep(0.8 * reach, reach, d);
    let dust = 0.25 * (1.0 - smoothstep(0.0, reach, d));
    return mix(color, vec3<f32>(0.60, 0.59, 0.56), clamp(0.75 * threads + dust, 0.0, 1.0) * (1.0 - min(gone, 1.0)));
}

// A name in spray paint: five handwritten letters, underlined.
fn sprayed(color: vec3<f32>, q: vec2<f32>, own: f32, f: f32) -> vec3<f32> {
    const LETTER_M: f32 = 0.46;
    let slanted = q.x - 0.22 * q.y;
    let k = floor(slanted / LETTER_M + 2.5);
    let v = vec2<f32>(slanted - (k - 2.0) * LETTER_M, q.y - 0.08 * sin(2.1 * q.x + 9.0 * own));
    let letter = i32(floor(own * 4.0) + k) & 3;
    let half = 0.30;
    var d = 0.0;
    if letter == 0 {
        d = abs(length(v * vec2<f32>(1.0, 0.55)) - 0.15);
    } else if letter == 1 {
        d = min(abs(v.x + 0.15), abs(v.x - 0.15 + 0.5 * abs(v.y)));
    } else if letter == 2 {
        d = min(abs(length(vec2<f32>(v.x, v.y - 0.15)) - 0.14), abs(v.x + 0.13));
    } else {
        d = min(abs(v.x), abs(v.y - 0.24 + 0.3 * abs(v.x)));
    }
    let inside = step(abs(k - 2.0), 2.0);
    let body = max(d, abs(v.y) - half) + 2.0 * (1.0 - inside);
    let under = max(abs(q.y + 0.44 - 0.06 * sin(2.4 * q.x)), abs(q.x) - 1.2);
    let nozzle = 0.065 + 0.02 * noise(q * 5.0 + own * 30.0);
    let soft = max(f, 0.014);
    let stroke = cover(min(body, under), nozzle, soft);
    // Runs of excess paint.
    let run = cover(abs(fract(q.x / 0.37 + own) - 0.5) * 0.37, 0.012, f) * step(q.y, -0.44) * step(-0.95 + 0.5 * noise(vec2<f32>(floor(q.x / 0.37 + own) * 3.3, own)), q.y);
    let paint = select(select(vec3<f32>(0.030, 0.030, 0.034), vec3<f32>(0.035, 0.09, 0.34), own > 0.35), vec3<f32>(0.42, 0.035, 0.04), own > 0.7);
    return mix(color, paint, 0.92 * max(stroke, run * step(abs(q.x), 1.1)));
}

// Cast concrete: formwork boards, construction joints, tie holes, blotches, rain streaks, algae near the water.
fn concrete(in: Fragment, n: vec3<f32>, fp: vec2<f32>, m: ptr<function, Matter>) {
    let uv = in.uv;
    let f = max(fp.x, fp.y);
    let wall = 1.0 - smoothstep(0.4, 0.8, abs(n.z));
    let blotch = fbm(uv * 0.45, f * 0.45);
    let grain = fbm(uv * 9.0 + 31.0, f * 9.0);
    let sand = fine(uv * 71.0 + 3.0, f * 71.0, grain);
    var tone = 0.82 + 0.55 * (blotch - 0.5) + 0.22 * (grain - 0.5) + 0.20 * (sand - 0.5);
    // Boards along the member, 0.16 m wide, each with its own tone.
    let board = floor(uv.y / 0.16);
    let board_tone = hash2(vec2<i32>(i32(board), i32(floor(uv.x / 2.4 + 0.37 * (board - 2.0 * floor(0.5 * board))))));
    tone += 0.07 * (board_tone - 0.5) * (1.0 - smoothstep(0.05, 0.2, fp.y));
    // Most lines between boards have weathered away. The remaining lines are straight and fainter than any crack.
    let kept = smoothstep(0.45, 0.7, fine(vec2<f32>(uv.x * 0.9, board * 3.7), fp.x * 0.9, blotch));
    let seams = lines(uv.y, 0.16, 0.003, fp.y) * kept;
    let joints = lines(uv.x + 0.6, 4.8, 0.010, fp.x) + 0.3 * lines(uv.x + 0.2, 2.4, 0.004, fp.x);
    tone *= 1.0 - 0.16 * seams - 0.30 * joints;
    // Form tie holes, 25 mm wide.
    let cell = vec2<f32>(1.2, 0.8);
    let tie = length((fract(uv / cell + vec2<f32>(0.5, 0.25)) - 0.5) * cell);
    tone *= 1.0 - 0.5 * cover(tie, 0.025, f) * (1.0 - smoothstep(0.02, 0.08, f)) * wall;
    // Rain streaks on walls.
    let streak = fbm(vec2<f32>(uv.x * 3.1, uv.y * 0.22 + 3.0), f * 3.1);
    tone *= 1.0 - wall * 0.42 * smoothstep(0.52, 0.78, streak);
    // Air holes left by the formwork, a few millimeters wide.
    if DETAIL {
        let hole = cell_noise(uv * 14.0 + 5.0);
        let bore = 0.03 + 0.09 * fract(hole.y * 7.3);
        tone *= 1.0 - 0.5 * step(0.72, hole.y) * cover(hole.x, bore, f * 14.0) * (1.0 - smoothstep(0.004, 0.012, f));
    }
    var color = vec3<f32>(0.36, 0.345, 0.315) * tone;
    // Soot and lichen in large patches.
    let dark = smoothstep(0.6, 0.8, fbm(uv * 0.17 + 11.0, f * 0.17));
    color = mix(color, vec3<f32>(0.13, 0.127, 0.115), 0.5 * dark);
    // Bird droppings: white splashes that are not defects. Downward faces have none.
    let spot = floor(uv / 1.7);
    let lucky = hash2(vec2<i32>(spot) + vec2<i32>(77, 19));
    if lucky > 0.93 && n.z > -0.3 {
        let center = (spot + 0.3 + 0.4 * vec2<f32>(hash2(vec2<i32>(spot)), hash2(vec2<i32>(spot) + 5))) * 1.7;
        let d = length((uv - center) * vec2<f32>(1.0, mix(1.0, 0.45, wall)));
        let splash = 0.055 * fine(uv * 38.0, 0.0, grain);
        color = mix(color, vec3<f32>(0.72, 0.71, 0.66), 0.75 * (1.0 - smoothstep(splash - 0.5 * f, splash + 0.5 * f + 0.004, d)));
    }
    let over = in.p.z - g.scene.y;
    color = befriended(color, in, n, f);
    // Splash zone: algae and a wet base.
    let reach = 0.8 + 0.5 * fine(uv * 0.8 + 4.0, f * 0.8, blotch);
    let slime = wall * (1.0 - smoothstep(0.15, reach, over));
    color = mix(color, vec3<f32>(0.055, 0.065, 0.04), 0.9 * slime);
    let band = wall * smoothstep(reach, reach + 0.15, over) * (1.0 - smoothstep(reach + 0.2, reach + 1.2, over));
    color = mix(color, vec3<f32>(0.5, 0.48, 0.43), 0.35 * band);
    (*m).albedo = color;
    (*m).roughness = mix(0.92, 0.45, slime);
}

// The deck: `aux` is half the deck width; u runs along the bridge, v across it from the center.
fn deck(in: Fragment, fp: vec2<f32>, m: ptr<function, Matter>) {
    let half = in.aux;
    let across = abs(in.uv.y);
    let f = max(fp.x, fp.y);
    let road = 1.0 - smoothstep(0.365 * half * 2.0 - fp.y, 0.365 * half * 2.0 + fp.y, across);
    let worn = exp(-pow((across - 0.19 * half * 2.0) / 0.55, 2.0));
    let stones = fbm(in.uv * 22.0, f * 22.0);
    let patches = fbm(in.uv * vec2<f32>(0.12, 0.7), f * 0.7);
    var asphalt = vec3<f32>(0.062, 0.062, 0.065) * (0.75 + 0.5 * patches + 0.3 * (stones - 0.5)) * (1.0 + 0.25 * worn);
    let dash = smoothstep(0.0, fp.x / 9.0 + 0.001, 0.333 - fract(in.uv.x / 9.0));
    let center = cover(across, 0.15, fp.y) * dash;
    let edge = cover(abs(across - 0.345 * half * 2.0), 0.12, fp.y);
    asphalt = mix(asphalt, vec3<f32>(0.62, 0.61, 0.57) * (0.6 + 0.6 * stones), clamp(center + edge, 0.0, 1.0) * 0.85);
    let kerb = cover(abs(across - 0.372 * half * 2.0), 0.12, fp.y);
    let slabs = lines(in.uv.x, 1.0, 0.01, fp.x);
    let walk = vec3<f32>(0.36, 0.35, 0.33) * (0.75 + 0.5 * patches) * (1.0 - 0.3 * slabs);
    (*m).albedo = mix(mix(walk, asphalt, road), vec3<f32>(0.45, 0.44, 0.42), kerb);
    (*m).roughness = mix(0.9, 0.78, road);
}

// Painted plates with rows of rivets, chalked and speckled.
fn steel(in: Fragment, n: vec3<f32>, fp: vec2<f32>, m: ptr<function, Matter>) {
    let uv = in.uv;
    let f = max(fp.x, fp.y);
    let wall = 1.0 - smoothstep(0.5, 0.9, abs(n.z));
    let chalk = fbm(uv * 0.6, f * 0.6);
    let skin = fbm(uv * 26.0, f * 26.0);
    var color = in.tint.rgb * (0.72 + 0.44 * chalk + 0.16 * skin);
    let streak = fbm(vec2<f32>(uv.x * 4.0, uv.y * 0.3 + 9.0), f * 4.0);
    color *= 1.0 - wall * 0.3 * smoothstep(0.55, 0.8, streak);
    // A butt strap every 6 m with two rows of rivets on each side.
    let seam = abs(fract(uv.x / 6.0 + 0.5) - 0.5) * 6.0;
    color *= 1.0 - 0.45 * cover(seam, 0.006, fp.x);
    color *= 1.0 - 0.12 * cover(abs(seam - 0.22), 0.008, fp.x);
    let row = min(abs(seam - 0.07), abs(seam - 0.15));
    let along = (fract(uv.y / 0.09) - 0.5) * 0.09;
    let head = length(vec2<f32>(row, along));
    let shown = 1.0 - smoothstep(0.008, 0.03, f);
    let rivet = cover(head, 0.03, f) * shown;
    color = mix(color, color * (1.25 - 0.9 * smoothstep(0.008, 0.016, head)), rivet);
    // Small, dry, superficial rust specks in gaps in the paint.
    let freckle = smoothstep(0.74, 0.82, fbm(uv * 2.3 + 40.0, f * 2.3)) * smoothstep(0.45, 0.7, fbm(uv * 0.3 + 2.0, f * 0.3));
    color = mix(color, vec3<f32>(0.19, 0.085, 0.04), 0.55 * freckle);
    (*m).albedo = color;
    (*m).roughness = mix(0.48, 0.85, max(freckle, 0.6 * chalk));
}

// Aerial photograph on the ground, with its north at the top.
@group(0) @binding(7) var photo_map: texture_2d<f32>;

// Replaces a color of the ground by that of the photograph, where there is one. `detail` is a pattern around 0.5 finer than its pixels.
fn photographed(color: vec3<f32>, at: vec2<f32>, detail: f32) -> vec3<f32> {
    if g.size.z <= 0.0 {
        return color;
    }
    let place = at / g.size.z;
    let seen = textureSample(photo_map, noise_sampler, vec2<f32>(0.5 + 0.5 * place.x, 0.5 - 0.5 * place.y));
    // The last part of the site blends into the surroundings.
    let inside = 1.0 - smoothstep(0.95, 0.995, max(abs(place.x), abs(place.y)));
    return mix(color, seen.rgb * (0.7 + 0.6 * detail), seen.a * inside);
}

// Share of imagined forest and snow: none on the photograph.
fn wild(at: vec2<f32>) -> f32 {
    return select(1.0, smoothstep(0.95, 0.995, max(abs(at.x), abs(at.y)) / max(g.size.z, 1.0)), g.size.z > 0.0);
}

// Share of forest beyond the field. `field` is the share of the field, `stand` slow noise.
fn wooded(at: vec2<f32>, over: f32, field: f32, stand: f32) -> f32 {
    let tree_line = 1.0 - smoothstep(330.0, 520.0, over + 260.0 * (stand - 0.5));
    let pasture = smoothstep(0.30, 0.46, stand + 0.0016 * over);
    return wild(at) * (1.0 - field) * smoothstep(4.0, 18.0, over) * tree_line * pasture;
}

// Crowns and the gaps between them; stands differ slightly in color.
fn forest_color(canopy: f32, stand: f32) -> vec3<f32> {
    let crowns = 0.35 + 1.3 * smoothstep(0.25, 0.75, canopy);
    return mix(vec3<f32>(0.030, 0.044, 0.022), vec3<f32>(0.044, 0.056, 0.024), smoothstep(0.35, 0.65, stand)) * crowns;
}

fn ground(in: Fragment, n: vec3<f32>, f: f32, m: ptr<function, Matter>) {
    let at = in.p.xy;
    let over = in.aux;
    let broad = fbm(at * 0.03, f * 0.03);
    let near = fbm(at * 0.5 + 17.0, f * 0.5);
    let fine_at = fbm(at * 4.0 + 3.0, f * 4.0);
    let blades = fine(at * 19.0 + 7.0, f * 19.0, fine_at);
    let meadow = mix(vec3<f32>(0.085, 0.105, 0.032), vec3<f32>(0.17, 0.15, 0.065), smoothstep(0.35, 0.7, broad * 0.6 + near * 0.4));
    // Rock: the pattern is projected on the vertical plane closest to the face, which avoids stretching down the slope.
    let east = abs(n.x) + 0.3 * (near - 0.5) > abs(n.y);
    let wall = vec2<f32>(select(in.p.x, in.p.y, east), in.p.z);
    let bed = fbm(vec2<f32>(wall.x * 0.12, wall.y * 0.7 + wall.x * 0.13 + 1.5 * near), f * 0.7);
    let block = fbm(wall * 0.8 + 9.0, f * 0.8);
    let chip = fine(wall * 6.0 + 3.0, f * 6.0, fine_at);
    let rock = mix(vec3<f32>(0.17, 0.158, 0.14), vec3<f32>(0.30, 0.28, 0.255), smoothstep(0.25, 0.75, 0.35 * bed + 0.65 * block))
        * (0.6 + 0.8 * chip) * (0.9 + 0.2 * smoothstep(0.40, 0.55, bed + 0.3 * (chip - 0.5)));
    let gravel = mix(vec3<f32>(0.21, 0.195, 0.17), vec3<f32>(0.34, 0.32, 0.28), fine_at);
    let steep = smoothstep(0.22, 0.42, 1.0 - n.z + 0.18 * (near - 0.5));
    var color = meadow * (0.55 + 0.55 * fine_at + 0.35 * blades);
    color = mix(color, rock, steep);
    let shore = 1.0 - smoothstep(0.4, 1.9, over + 1.2 * (near - 0.5));
    color = mix(color, gravel, shore);
    color = photographed(color, at, fine_at);
    // Wet at the waterline.
    color *= mix(0.45, 1.0, smoothstep(-0.1, 0.5, over));
    // The forest of the mountains: closed up to the tree line, with pastures at its lower edge.
    let canopy = fbm(at * 0.14 + 5.0, f * 0.14);
    let stand = fbm(at * 0.011, f * 0.011);
    let wood = wooded(at, over, in.tint.r, stand) * (1.0 - 0.4 * steep);
    color = mix(color, forest_color(canopy, stand), wood);
    let snow = wild(at) * smoothstep(560.0, 800.0, over + 160.0 * (near - 0.5)) * (1.0 - 0.7 * steep);
    color = mix(color, vec3<f32>(0.8, 0.82, 0.85), snow);
    (*m).albedo = color;
    (*m).roughness = 0.95;
}

fn simple(in: Fragment, n: vec3<f32>, f: f32, m: ptr<function, Matter>) {
    var color = in.tint.rgb;
    var roughness = 0.85;
    switch in.material {
        case 3u: {
            // Wrapped wire of cables.
            color = mix(vec3<f32>(0.30, 0.31, 0.32), color, 0.5) * (0.8 + 0.4 * fbm(in.uv * 3.0, f * 3.0));
            roughness = 0.55;
        }
        case 5u: {
            let tuft = fbm(in.p.xy * 3.0 + in.p.z * 2.3, f * 3.0);
            color *= 0.45 + 1.1 * tuft;
            roughness = 0.9;
            (*m).still = true;
        }
        case 6u: { color *= 0.6 + 0.8 * fbm(in.uv * vec2<f32>(9.0, 2.0), f * 9.0); }
        case 7u: {
            let stone = fbm(in.p.xy * 2.0 + in.p.zz * 1.7, f * 2.0);
            color *= 0.6 + 0.8 * stone;
            color = mix(color, vec3<f32>(0.10, 0.12, 0.04), 0.5 * smoothstep(0.5, 0.7, stone) * clamp(n.z, 0.0, 1.0));
            color *= mix(0.5, 1.0, smoothstep(0.0, 0.35, in.p.z - g.scene.y));
        }
        case 16u: {
            // A voussoir is one stone, with joints across the barrel only; its own tone is in the tint.
            let at = select(wall_position(in.p, n), in.uv.yx, abs(n.z) > 0.94);
            let coursed = stones_in_courses(at, STONE_JOINT_M, f);
            let whole = in.aux > 0.5;
            let under = select(0.0, lines(at.x, 0.9, STONE_JOINT_M, f), n.z < -0.2);
            let joint = select(coursed.x, under, whole);
            let own = select(coursed.y, 0.5, whole);
            let grain = fbm(at * 11.0, f * 11.0);
            let worn = fbm(at * 0.4 + 7.0, f * 0.4);
            color *= (0.72 + 0.42 * own) * (0.70 + 0.34 * grain + 0.26 * worn);
            color = mix(color, vec3<f32>(0.13, 0.125, 0.11), 0.45 * smoothstep(0.55, 0.8, fbm(at * vec2<f32>(0.9, 0.16) + 3.0, f)));
            color = mix(color, vec3<f32>(0.25, 0.235, 0.20) * (0.7 + 0.5 * grain), 0.9 * joint);
            // Moss and algae near the water.
            let over = in.p.z - g.scene.y;
            color = mix(color, vec3<f32>(0.05, 0.062, 0.035), 0.85 * (1.0 - smoothstep(0.15, 0.7 + 0.6 * worn, over)));
            roughness = 0.93;
        }
        case 8u, 15u: { roughness = 0.3; }
        case 9u: { roughness = 0.08; }
        case 10u: { roughness = 0.7; }
        case 13u: {
            let at = max(abs(in.uv.x), abs(in.uv.y));
            let d = length(in.uv);
            let ring = cover(abs(d - 0.72), 0.06, f);
            let h = max(cover(abs(abs(in.uv.x) - 0.25), 0.1, f) * step(abs(in.uv.y), 0.4), cover(abs(in.uv.y), 0.1, f) * step(abs(in.uv.x), 0.3));
            color = mix(vec3<f32>(0.85, 0.25, 0.03), vec3<f32>(0.85), clamp(ring + h, 0.0, 1.0));
            color *= 0.85 + 0.3 * fbm(in.uv * 6.0, f * 6.0) * step(at, 2.0);
        }
        default: {}
    }
    (*m).albedo = color;
    (*m).roughness = roughness;
}

@fragment
fn fs(in: Fragment) -> @location(0) vec4<f32> {
    if MASK {
        return vec4<f32>(f32(in.material), 0.0, 0.0, 1.0);
    }
    let fp = max(fwidth(in.uv), vec2<f32>(1e-5));
    let f = max(length(dpdx(in.p)), length(dpdy(in.p)));
    let n = normalize(in.normal);
    // The lake reflects only objects above the water.
    if MIRRORED {
        if in.p.z < g.scene.y {
            discard;
        }
    }
    var m: Matter;
    m.normal = n;
    m.face = n;
    m.metal = 0.0;
    m.roughness = 0.9;
    m.light = in.light;
    m.sunlit = 1.0;
    if LOOK == 0u {
        concrete(in, n, fp, &m);
    } else if LOOK == 1u {
        deck(in, fp, &m);
    } else if LOOK == 2u {
        steel(in, n, fp, &m);
    } else if LOOK == 4u {
        ground(in, n, f, &m);
    } else if LOOK == 3u {
        simple(in, n, f, &m);
    }
    m.albedo = weathered(m.albedo, n.z, m.light.x);
    if WEATHERED {
        m.roughness = mix(m.roughness, 0.35, 0.7 * g.weather.x * clamp(n.z, 0.0, 1.0) * smoothstep(0.4, 0.75, m.light.x) * (1.0 - g.weather.y));
    }
    m.light *= ambient_share(in.clip.xy);
    let lit = exposed(shade(m, in.p));
    if LOOK == 3u {
        if in.material == 12u {
            return exposed(in.tint.rgb * in.aux);
        }
        if in.material == 14u {
            return vec4<f32>(lit.rgb, in.tint.a);
        }
    }
    return lit;
}
