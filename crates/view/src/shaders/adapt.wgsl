// Local adaptation, as of an eye that looks from the sky into a shadow, or of a camera that merges exposures. It divides the
// picture into a smooth base and detail and compresses only the base (Durand and Dorsey 2002, "Fast Bilateral Filtering for the
// Display of High-Dynamic-Range Images"), so that cracks and grain keep their contrast. The base is a guided filter of the
// brightness by itself: in each neighborhood it is a linear function of the brightness, fitted at low resolution (He and Sun 2015,
// "Fast Guided Filter"). `measure` and `fit` draw the coefficients; develop.wgsl applies them.

@group(0) @binding(0) var source: texture_2d<f32>;
@group(0) @binding(1) var source_sampler: sampler;

// Variance above which a difference in brightness is an edge between base regions instead of detail, stops squared (estimate:
// between the contrast of stains and that of a soffit against the sky).
const EDGE_VARIANCE: f32 = 1.0;

// Mean brightness of a cell and mean of its square, in stops from white.
@fragment
fn measure(in: Fragment) -> @location(0) vec4<f32> {
    let cell = vec2<f32>(dpdx(in.uv.x), dpdy(in.uv.y));
    var sum = vec2<f32>(0.0);
    for (var k = 0; k < 16; k++) {
        let at = (vec2<f32>(f32(k % 4), f32(k / 4)) - 1.5) * 0.25;
        let color = textureSampleLevel(source, source_sampler, in.uv + at * cell, 0.0).rgb;
        let stops = brightness_stops(color);
        sum += vec2<f32>(stops, stops * stops);
    }
    return vec4<f32>(sum / 16.0, 0.0, 1.0);
}

// Slope and offset of the base as a function of the brightness, fitted over nine by nine cells.
@fragment
fn fit(in: Fragment) -> @location(0) vec4<f32> {
    let texel = 1.0 / vec2<f32>(textureDimensions(source));
    // Between two texels, the sampler returns the mean of both. Weights: a Gaussian with a standard deviation of two cells.
    var offsets = array<f32, 5>(-3.5, -1.5, 0.0, 1.5, 3.5);
    var weights = array<f32, 5>(0.46, 1.49, 1.0, 1.49, 0.46);
    var sum = vec2<f32>(0.0);
    var whole = 0.0;
    for (var y = 0; y < 5; y++) {
        for (var x = 0; x < 5; x++) {
            let weight = weights[x] * weights[y];
            sum += weight * textureSampleLevel(source, source_sampler, in.uv + vec2<f32>(offsets[x], offsets[y]) * texel, 0.0).rg;
            whole += weight;
        }
    }
    let mean = sum / whole;
    let variance = max(mean.y - mean.x * mean.x, 0.0);
    let slope = variance / (variance + EDGE_VARIANCE);
    return vec4<f32>(slope, (1.0 - slope) * mean.x, 0.0, 1.0);
}
