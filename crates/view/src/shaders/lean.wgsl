// Solids for cheaper presets (appended to surface.wgsl): light without sun shadows, haze, and reflections are computed
// per vertex, and slow patterns come from precomputed tiles (tiles.rs).

// Ground: patches, blocks, beds, fine detail. Concrete: tone, and fractions of streaks, soot, droppings.
@group(0) @binding(5) var ground_tile: texture_2d<f32>;
@group(0) @binding(6) var concrete_tile: texture_2d<f32>;
const GROUND_M: f32 = 32.0;
const CONCRETE_M: f32 = 38.4;

// Packs values into full vectors, because a software renderer always sets up all four components per triangle.
struct Lean {
    @builtin(position) clip: vec4<f32>,
    // Position; `aux`.
    @location(0) place: vec4<f32>,
    // Normal; depth in the sun's map.
    @location(1) facing: vec4<f32>,
    // Surface coordinates; position in the sun's map.
    @location(2) spot: vec4<f32>,
    // Indirect light, and sunlight before shadowing, both with haze and exposure applied.
    @location(3) light: vec4<f32>,
    // Added light: haze and reflections, with exposure applied; transmittance of the haze.
    @location(4) veil: vec4<f32>,
    // Tint; the alpha channel contains large-scale ground patches instead of opacity.
    @location(5) tint: vec4<f32>,
    @location(6) @interpolate(flat) material: u32,
}

// Smoothness of a reflective material; for painted steel, its mean.
fn gloss(material: u32) -> f32 {
    switch material {
        case 2u: { return 0.4; }
        case 3u: { return 0.45; }
        case 8u, 15u: { return 0.7; }
        case 9u: { return 0.92; }
        default: { return 0.0; }
    }
}

// Reflection of the sky in a surface; same as in `shade`.
fn reflected(v: vec3<f32>, n: vec3<f32>, smooth_by: f32, light: vec2<f32>, indirect: vec3<f32>) -> vec3<f32> {
    let r = reflect(-v, n);
    let away = 1.0 - clamp(dot(n, v), 0.0, 1.0);
    let fresnel = 0.04 + (max(smooth_by, 0.04) - 0.04) * away * away * away * away * away;
    let open = clamp(light.x * 1.2, 0.0, 1.0);
    return select(0.0, fresnel * (0.5 + 0.5 * smooth_by), smooth_by > 0.3) * mix(indirect, reflected_radiance(r), smooth_by * open);
}

@vertex
fn vs_lean(corner: Corner) -> Lean {
    let v = placed(corner);
    let away = g.eye.xyz - v.p;
    let distance = length(away);
    let towards = away / max(distance, 1e-6);
    let clear = exp(-distance * g.scene.z);
    let kept = clear * g.look.x;
    let indirect = v.light.x * g.sky_rgb.w * g.sky_rgb.xyz + v.light.y * g.sun.w * g.sun_rgb.xyz;
    let facing = max(dot(v.normal, g.sun.xyz), 0.0);
    var veil = veil_radiance(towards) * (1.0 - clear) * g.look.x;
    if GLOSSY {
        veil += kept * reflected(towards, v.normal, gloss(v.material), v.light, indirect);
    }
    // Offset from the surface; same as in `sun_visible`.
    let lean = 0.6 + 1.6 * (1.0 - clamp(facing, 0.0, 1.0));
    let at = g.shadow_proj[0] * vec4<f32>(v.p + v.normal * (g.texel.x * lean), 1.0);
    let q = at.xyz / at.w;
    var tint = v.tint;
    if LOOK == 4u {
        // Mip level with two-meter texels and a pattern scale of thirty meters.
        tint.a = textureSampleLevel(noise_map, noise_sampler, v.p.xy * (0.03 / 16.0), 1.0).r;
    }
    var out: Lean;
    out.clip = v.clip;
    out.place = vec4<f32>(v.p, v.aux);
    out.facing = vec4<f32>(v.normal, q.z);
    out.spot = vec4<f32>(v.uv, 0.5 + 0.5 * q.x, 0.5 - 0.5 * q.y);
    out.light = vec4<f32>(kept * indirect, kept * g.sun.w * facing);
    out.veil = vec4<f32>(veil, clear);
    out.tint = tint;
    out.material = v.material;
    return out;
}

// Same as `concrete`, with precomputed slow patterns.
fn lean_concrete(in: Fragment, fp: vec2<f32>, m: ptr<function, Matter>) {
    let uv = in.uv;
    let f = max(fp.x, fp.y);
    let tile = textureSample(concrete_tile, noise_sampler, uv / CONCRETE_M);
    let grain = fbm(uv * 9.0 + 31.0, f * 9.0);
    let wall = 1.0 - smoothstep(0.4, 0.8, abs(in.normal.z));
    var tone = 0.82 + (tile.r - 0.5) + 0.42 * (grain - 0.5);
    let kept = smoothstep(0.47, 0.61, tile.r);
    let seams = lines(uv.y, 0.16, 0.003, fp.y) * kept;
    let joints = lines(uv.x + 0.6, 4.8, 0.010, fp.x) + 0.3 * lines(uv.x + 0.2, 2.4, 0.004, fp.x);
    tone *= 1.0 - 0.16 * seams - 0.30 * joints;
    let cell = vec2<f32>(1.2, 0.8);
    let tie = length((fract(uv / cell + vec2<f32>(0.5, 0.25)) - 0.5) * cell);
    tone *= 1.0 - 0.5 * cover(tie, 0.025, f) * (1.0 - smoothstep(0.02, 0.08, f)) * wall;
    tone *= 1.0 - wall * 0.42 * tile.g;
    var color = vec3<f32>(0.36, 0.345, 0.315) * tone;
    color = mix(color, vec3<f32>(0.13, 0.127, 0.115), 0.5 * tile.b);
    color = mix(color, vec3<f32>(0.72, 0.71, 0.66), 0.75 * tile.a * step(-0.3, in.normal.z));
    let over = in.p.z - g.scene.y;
    color = befriended(color, in, in.normal, f);
    let reach = 0.8 + 0.5 * tile.r;
    let slime = wall * (1.0 - smoothstep(0.15, reach, over));
    color = mix(color, vec3<f32>(0.055, 0.065, 0.04), 0.9 * slime);
    let band = wall * smoothstep(reach, reach + 0.15, over) * (1.0 - smoothstep(reach + 0.2, reach + 1.2, over));
    (*m).albedo = mix(color, vec3<f32>(0.5, 0.48, 0.43), 0.35 * band);
}

// Same as `ground`, with one tile lookup: level ground by horizontal position, rock by position in the plane of the
// wall.
fn lean_ground(in: Fragment, broad: f32, m: ptr<function, Matter>) {
    let n = in.normal;
    let over = in.aux;
    let wall = vec2<f32>(select(in.p.x, in.p.y, abs(n.x) > abs(n.y)), in.p.z);
    let tile = textureSample(ground_tile, noise_sampler, select(in.p.xy, wall, n.z < 0.74) / GROUND_M);
    let near = tile.r;
    let meadow = mix(vec3<f32>(0.085, 0.105, 0.032), vec3<f32>(0.17, 0.15, 0.065), smoothstep(0.35, 0.7, broad * 0.6 + near * 0.4));
    let rock = mix(vec3<f32>(0.17, 0.158, 0.14), vec3<f32>(0.30, 0.28, 0.255), smoothstep(0.25, 0.75, 0.35 * tile.b + 0.65 * tile.g))
        * (0.6 + 0.8 * tile.a) * (0.9 + 0.2 * smoothstep(0.40, 0.55, tile.b + 0.3 * (tile.a - 0.5)));
    let gravel = mix(vec3<f32>(0.21, 0.195, 0.17), vec3<f32>(0.34, 0.32, 0.28), tile.a);
    let steep = smoothstep(0.22, 0.42, 1.0 - n.z + 0.18 * (near - 0.5));
    var color = meadow * (0.55 + 0.9 * tile.a);
    color = mix(color, rock, steep);
    color = mix(color, gravel, 1.0 - smoothstep(0.4, 1.9, over + 1.2 * (near - 0.5)));
    color = photographed(color, in.p.xy, tile.a);
    color *= mix(0.45, 1.0, smoothstep(-0.1, 0.5, over));
    let wood = wooded(in.p.xy, over, in.tint.r, broad) * (1.0 - 0.4 * steep);
    color = mix(color, forest_color(mix(near, broad, 0.5), broad), wood);
    let snow = wild(in.p.xy) * smoothstep(560.0, 800.0, over + 160.0 * (near - 0.5)) * (1.0 - 0.7 * steep);
    (*m).albedo = mix(color, vec3<f32>(0.8, 0.82, 0.85), snow);
}

@fragment
fn fs_lean(lean: Lean) -> @location(0) vec4<f32> {
    if MIRRORED {
        if lean.place.z < g.scene.y {
            discard;
        }
    }
    let fp = max(fwidth(lean.spot.xy), vec2<f32>(1e-5));
    var in: Fragment;
    in.p = lean.place.xyz;
    in.normal = lean.facing.xyz;
    in.uv = lean.spot.xy;
    in.material = lean.material;
    in.tint = lean.tint;
    in.aux = lean.place.w;
    var m: Matter;
    if LOOK == 0u {
        lean_concrete(in, fp, &m);
    } else if LOOK == 1u {
        deck(in, fp, &m);
    } else if LOOK == 2u {
        steel(in, in.normal, fp, &m);
    } else if LOOK == 4u {
        lean_ground(in, lean.tint.a, &m);
    } else if LOOK == 3u {
        simple(in, in.normal, max(length(dpdx(in.p)), length(dpdy(in.p))), &m);
    }
    // The lean shader keeps no share of the sky; the light that arrives indirectly is nearly proportional to it.
    let open = lean.light.g / max(lean.veil.w * g.look.x * g.sky_rgb.w, 1e-6);
    m.albedo = weathered(m.albedo, lean.facing.z, open);
    let at = lean.spot.zw;
    let depth = lean.facing.w;
    let inside = max(abs(at.x - 0.5), abs(at.y - 0.5)) < 0.4925 && depth > 0.0 && depth < 1.0;
    let seen = select(1.0, shadow_compare(0, at, depth), inside);
    var light = lean.light.rgb + (lean.light.a * seen) * g.sun_rgb.xyz;
    if LAMP {
        light += lamp_lux(in.p, normalize(in.normal)) * lean.veil.w * g.look.x;
    }
    let lit = vec4<f32>(min(m.albedo * light + lean.veil.rgb, vec3<f32>(200.0)), 1.0);
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
