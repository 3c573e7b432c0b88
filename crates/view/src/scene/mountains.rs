//! The mountains around the field: decorative, as no job extends that far.

use super::super::mesh::{Mesh, Vertex};
use super::ground::{ground_vertex, vertex_normals};
use spandrel_model::frames::Vec3;
use spandrel_model::math;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;

/// Radius of the last ring of mountains, as a fraction of the field's half side.
const OUTERMOST_RING: f64 = 11.0;
/// Rings from the rim outward. Their distances grow by the same factor, about as a picture's resolution on them falls.
const RING_COUNT: usize = 36;
/// Vertices on each side of a ring.
const RIM_SIDE_VERTICES: usize = 72;
/// Every how many vertices and rings are in the mesh of presets that save triangles, and in its reflection.
pub const SPARSE_STEP: usize = 2;
pub const REFLECTED_STEP: usize = 3;
/// Depth below the ground where the mountains start inside the rim, m. Hides the gaps that would appear because the rim
/// has fewer vertices than the ground.
const RIM_OVERLAP_M: f64 = 8.0;
/// Height of the mountains above the rim, m (estimate: a lake in a pre-alpine valley).
const PEAK_HEIGHT_M: f64 = 780.0;
/// Minimum height above the water for the rim to count as land, m.
const LAND_HEIGHT_M: f64 = 45.0;
/// Distance between the largest ridges, m, and octaves of the ridges, each with half the distance and half the height (ridged noise:
/// Musgrave, in Ebert et al. 2003, "Texturing and Modeling").
const RIDGE_SPACING_M: f64 = 1_150.0;
const RIDGE_OCTAVES: u32 = 5;
/// Distance beyond the rim within which the field's color fades out, as a fraction of the field's half side.
const FIELD_FADE: f64 = 0.35;

/// Builds the mountains around the field, which rise from its rim. Where the lake reaches the rim, it continues between
/// the mountains. `every` is the step between the vertices and the rings in use.
pub fn mesh(scenario: &Scenario, site: &Site, every: usize) -> Mesh {
    let half = 0.5 * scenario.terrain.size_m;
    let water = scenario.terrain.water_level_m;
    let around = 4 * RIM_SIDE_VERTICES / every;
    // The first ring is below the ground, the second on its rim.
    let outward = (0..=RING_COUNT).step_by(every).map(|k| math::pow(OUTERMOST_RING, k as f64 / RING_COUNT as f64));
    let rings: Vec<f64> = std::iter::once(0.98).chain(outward).collect();
    let mut vertices: Vec<(Vec3<_>, f64)> = Vec::with_capacity(rings.len() * around);
    for (ring, share) in rings.iter().enumerate() {
        for k in 0..around {
            let (x, y) = rim(k * every);
            let edge = share.min(0.9995) * half;
            let rim_up = site.geometry().terrain.ground.ground(x * edge, y * edge).0;
            let (east, north) = (x * half * share, y * half * share);
            let up = match ring {
                0 => rim_up - RIM_OVERLAP_M,
                1 => rim_up,
                _ => slope_height_m(rim_up - water, *share, east, north) + water,
            };
            vertices.push((Vec3::new(east, north, up), *share));
        }
    }
    let mut triangles = Vec::new();
    for ring in 0..rings.len() - 1 {
        for k in 0..around {
            let i = |ring: usize, k: usize| (ring * around + k % around) as u32;
            // The rim is counterclockwise, so outward is to its right.
            triangles.push([i(ring, k), i(ring + 1, k), i(ring + 1, k + 1)]);
            triangles.push([i(ring, k), i(ring + 1, k + 1), i(ring, k + 1)]);
        }
    }
    let points: Vec<Vec3<_>> = vertices.iter().map(|vertex| vertex.0).collect();
    let normals = vertex_normals(&points, &triangles);
    let vertex = |((p, share), n): (&(Vec3<_>, f64), &Vec3<_>)| {
        let field = (1.0 - (share - 1.0) / FIELD_FADE).clamp(0.0, 1.0);
        let tint = [(255.0 * field) as u8, 255, 255, 255];
        Vertex { tint, ..ground_vertex(*p, *n, [0.6 + 0.4 * n.up() as f32, 0.02], p.up() - water) }
    };
    Mesh { vertices: vertices.iter().zip(&normals).map(vertex).collect(), indices: triangles.into_iter().flatten().collect() }
}

/// Returns the k-th point on the square's rim, in -1..1, counterclockwise from the southwest.
fn rim(k: usize) -> (f64, f64) {
    let t = 2.0 * (k % RIM_SIDE_VERTICES) as f64 / RIM_SIDE_VERTICES as f64 - 1.0;
    match k / RIM_SIDE_VERTICES {
        0 => (t, -1.0),
        1 => (1.0, t),
        2 => (-t, 1.0),
        _ => (-1.0, -t),
    }
}

/// Returns a smooth function of a number from 0 to 1, with level ends.
fn smooth(t: f64) -> f64 {
    t * t * (3.0 - 2.0 * t)
}

/// Returns the terrain's height above the water beyond the rim. The terrain starts at the rim's height and continues
/// with ridges; the lake extends for some distance.
fn slope_height_m(rim_height_m: f64, share: f64, east: f64, north: f64) -> f64 {
    // Blends between lake and land along the rim to avoid a vertical wall.
    let wet = smooth(((LAND_HEIGHT_M - rim_height_m) / LAND_HEIGHT_M).clamp(0.0, 1.0));
    let beyond = (share - math::lerp(1.0, 2.2, wet)).max(0.0) / 2.4;
    // The slope starts gently and steepens, like the end of a valley.
    let climb = 1.0 - math::exp(-beyond * beyond / (0.3 + beyond));
    let far = PEAK_HEIGHT_M * climb * (0.25 + 0.95 * ridges(east, north));
    rim_height_m * (1.0 - 0.4 * climb * (1.0 - wet)) + far
}

/// Returns the height of the ridges, 0 to 1: sharp crests with side ridges, and rounded valleys.
fn ridges(east: f64, north: f64) -> f64 {
    let (mut sum, mut weight, mut whole) = (0.0, 1.0, 0.0);
    let mut before = 1.0;
    for octave in 0..RIDGE_OCTAVES {
        let per_m = f64::from(1_u32 << octave) / RIDGE_SPACING_M;
        let crest = 1.0 - (2.0 * value_noise(east * per_m, north * per_m, octave) - 1.0).abs();
        // Valleys are smoother than ridges, because they fill with debris.
        let height = crest * crest * before;
        before = (2.0 * height).min(1.0);
        sum += weight * height;
        whole += weight;
        weight *= 0.5;
    }
    sum / whole
}

/// Returns smooth noise with cells of size 1, 0 to 1.
fn value_noise(x: f64, y: f64, octave: u32) -> f64 {
    let (column, row) = (x.floor(), y.floor());
    let (across, along) = (smooth(x - column), smooth(y - row));
    let corner = |dx: f64, dy: f64| lattice_value((column + dx) as i32, (row + dy) as i32, octave);
    let low = math::lerp(corner(0.0, 0.0), corner(1.0, 0.0), across);
    let high = math::lerp(corner(0.0, 1.0), corner(1.0, 1.0), across);
    math::lerp(low, high, along)
}

/// Returns the random number of a lattice point, 0 to 1; a hash like `hash2` in common.wgsl.
fn lattice_value(column: i32, row: i32, octave: u32) -> f64 {
    let mut hash =
        (column as u32).wrapping_mul(0x8da6_b343) ^ (row as u32).wrapping_mul(0xd816_3841) ^ octave.wrapping_mul(0xcb1a_b31f);
    hash = (hash ^ (hash >> 15)).wrapping_mul(0x2c1b_3c6d);
    hash = (hash ^ (hash >> 12)).wrapping_mul(0x297a_2d39);
    f64::from((hash ^ (hash >> 15)) >> 8) / f64::from(1_u32 << 24)
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::shipped::TWO_BRIDGES;

    #[test]
    fn exact_the_mountains_begin_at_the_rim_of_the_ground() {
        // Coordinates of vertices are single precision.
        const ROUNDING_ERROR_M: f32 = 1e-3;
        let job = spandrel_model::scenario::read("two-bridges.toml", TWO_BRIDGES, &|_| Err("none".into())).unwrap();
        let site = Site::without_defects(&job);
        for step in [1, SPARSE_STEP, REFLECTED_STEP] {
            let around = 4 * RIM_SIDE_VERTICES / step;
            let mesh = mesh(&job, &site, step);
            assert_eq!(mesh.vertices.len(), around * (RING_COUNT / step + 2));
            for vertex in &mesh.vertices[around..2 * around] {
                let [east, north, up] = vertex.position;
                let edge = 0.9995;
                let ground = site.geometry().terrain.ground.ground(f64::from(east) * edge, f64::from(north) * edge).0;
                assert!((up - ground as f32).abs() < ROUNDING_ERROR_M && vertex.tint[0] == 255, "{:?}", vertex.position);
            }
            let last = &mesh.vertices[mesh.vertices.len() - around..];
            assert!(last.iter().all(|vertex| vertex.tint[0] == 0 && vertex.aux > 0.0), "the lake ends before the last ring");
        }
    }
}
