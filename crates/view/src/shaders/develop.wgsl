// Converts radiance on the sensor to a picture: motion blur, noise, vignette, local adaptation, tone curve.

// Whether the preset has motion blur.
override BLUR: bool = true;
// Whether to apply a camera's sensor noise and vignetting, which eyes do not have.
override SENSOR: bool = true;
// Whether blocks of the picture are missing, as on a weak video link.
override LOSSY: bool = false;

// Side of a block, px (H.264 macroblocks).
const BLOCK: u32 = 16u;

struct Develop {
    // Transform from this picture's clip space to clip space at shutter opening.
    reproject: mat4x4<f32>,
    // Noise at mid-gray; picture number; motion blur samples; vignette.
    grain: vec4<f32>,
    // Size of the picture; share of lost blocks; largest brightening of a part of the picture, stops.
    size: vec4<f32>,
}

@group(0) @binding(0) var<uniform> d: Develop;
@group(0) @binding(1) var light: texture_2d<f32>;
@group(0) @binding(2) var light_sampler: sampler;
@group(0) @binding(3) var depth: texture_depth_2d;
// Slope and offset of the base brightness (adapt.wgsl).
@group(0) @binding(4) var adaptation: texture_2d<f32>;

// Base brightness that stays, stops from white: the metered mean (exposure.rs, `METERING_TARGET`).
const METERED_STOPS: f32 = -2.06;
// Share by which the base is compressed towards the metered mean (estimate: what remains shows a soffit and the sky behind it
// together, and a sunlit bridge still differs from its shadows by more than a stop).
const COMPRESSION: f32 = 0.45;

// Four random numbers in 0..1, in steps of 1/255.
fn random(p: vec2<u32>, k: u32) -> vec4<f32> {
    var h = p.x * 0x8da6b343u + p.y * 0xd8163841u + k * 0xcb1ab31fu;
    h = (h ^ (h >> 15u)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12u)) * 0x297a2d39u;
    h = h ^ (h >> 15u);
    return unpack4x8unorm(h);
}

// Contrast of 1.3 around a mid-gray of 0.26 (estimate: standard camera profiles have 1.2 to 1.5). Surfaces two stops
// underexposed look black, consistent with the score. Equals (x / 0.26)^0.3 up to its limit of 1.25, with an error of
// less than 0.2 of the picture's 255 steps.
fn raised_contrast(x: f32) -> f32 {
    let s = sqrt(x);
    return (0.19498184 + 2.25033308 * s) / (1.0 + 0.66570929 * s);
}

// Filmic curve with a soft toe and shoulder (Narkowicz's 2015 fit to the Academy's reference curve). Encodes sRGB with
// a rational function of the square root of radiance, with an error of less than 0.8 of 255 steps. In software
// renderers, square roots and divisions are cheap, but powers are not.
fn encoded(y: vec3<f32>) -> vec3<f32> {
    let s = sqrt(y);
    return ((5.75941549 * s - 0.05775244) * s - 0.00282203) / ((5.80176807 * s - 0.53043618) * s + 1.0);
}

fn developed(x: vec3<f32>) -> vec3<f32> {
    let brightness = dot(x, vec3<f32>(0.2126, 0.7152, 0.0722));
    let y = x * 0.82 * min(raised_contrast(brightness), 1.25);
    // The curve reaches white at 8.1. Far beyond that, the rational function would decrease again.
    return clamp(encoded(min(y, vec3<f32>(12.0))), vec3<f32>(0.0), vec3<f32>(1.0));
}

// Factor by which local adaptation brightens or darkens a part of the picture.
fn adapted(color: vec3<f32>, uv: vec2<f32>) -> f32 {
    let base = textureSampleLevel(adaptation, light_sampler, uv, 0.0).rg;
    let above = base.x * brightness_stops(color) + base.y - METERED_STOPS;
    let stops = min(-above * COMPRESSION, d.size.w);
    return exp2(stops);
}

@fragment
fn fs(in: Fragment) -> @location(0) vec4<f32> {
    let pixel = vec2<u32>(in.uv * d.size.xy);
    var color = textureLoad(light, vec2<i32>(pixel), 0).rgb;
    let taps = select(1, i32(d.grain.z), BLUR);
    if BLUR && taps > 1 {
        let z = textureLoad(depth, vec2<i32>(pixel), 0);
        let clip = vec4<f32>(in.uv.x * 2.0 - 1.0, 1.0 - in.uv.y * 2.0, z, 1.0);
        let was = d.reproject * clip;
        if was.w > 0.0 {
            let opened = vec2<f32>(0.5 + 0.5 * was.x / was.w, 0.5 - 0.5 * was.y / was.w);
            let path = clamp(opened - in.uv, vec2<f32>(-0.06), vec2<f32>(0.06));
            var sum = color;
            for (var k = 1; k < taps; k++) {
                sum += textureSampleLevel(light, light_sampler, in.uv + path * (f32(k) / f32(taps - 1)), 0.0).rgb;
            }
            color = sum / f32(taps);
        }
    }
    if LOSSY {
        // A decoder without data for a block continues with the mean color, here that of the block's center.
        let block = pixel / BLOCK;
        if random(block, u32(d.grain.y)).x < d.size.z {
            let center = min(block * BLOCK + BLOCK / 2u, vec2<u32>(d.size.xy) - 1u);
            color = textureLoad(light, vec2<i32>(center), 0).rgb;
        }
    }
    if SENSOR {
        let out = in.uv - 0.5;
        color *= 1.0 - d.grain.w * dot(out, out);
        // Photon noise grows with the square root of radiance, above a noise floor.
        let grains = random(pixel, u32(d.grain.y));
        let a = grains.x + grains.y + grains.z - 1.5;
        let c = grains.w - 0.5;
        let brightness = max(dot(color, vec3<f32>(0.2126, 0.7152, 0.0722)), 0.0);
        let noise = d.grain.x * (sqrt(brightness * 5.0) + 0.25);
        color += 0.2 * noise * (a + vec3<f32>(0.5, -0.2, -0.5) * c);
    }
    color = max(color, vec3<f32>(0.0));
    return vec4<f32>(developed(color * adapted(color, in.uv)), 1.0);
}
