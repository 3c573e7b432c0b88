//! Ground, the lake's surface, and the landing pad.

use super::super::mesh::{Material, Mesh, Vertex, single};
use super::bake::LightBaker;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;
use spandrel_model::site::wakes::WakeField;
use spandrel_model::site::wind::velocity_at;
use spandrel_model::time::SimTime;

/// Range around a member within which the light on the ground is baked, m.
const BAKED_LIGHT_RANGE_M: f64 = 30.0;
/// Extent of the lake, m.
const LAKE_EXTENT_M: f64 = 9_000.0;
/// Height above the water at which the wind ripples it, m (estimate: between the waves' crests and the lowest eddies).
const RIPPLE_HEIGHT_M: f64 = 1.0;
/// Wind without a visible lee, m/s (estimate), and the largest wind beside a pier, relative to the undisturbed one (estimate).
const MIN_WIND_M_S: f64 = 0.5;
const MAX_WIND_SHARE: f64 = 1.3;
/// Minimum depth that hides the lake bed, m.
const OPAQUE_DEPTH_M: f64 = 30.0;

/// Returns a vertex of the ground. The red part of its tint is the share of the field, beyond which the shader grows the forest of the
/// mountains.
pub fn ground_vertex(p: Vec3<Enu>, normal: Vec3<Enu>, light: [f32; 2], height_over_water_m: f64) -> Vertex {
    Vertex {
        position: single(p),
        normal: single(normal),
        uv: [p.east() as f32, p.north() as f32],
        light,
        material: Material::Ground as u32,
        tint: [255; 4],
        aux: height_over_water_m as f32,
    }
}

/// Builds the ground mesh, which is also the collision geometry, from the selected triangles.
pub fn mesh(scenario: &Scenario, site: &Site, bake: &LightBaker, shown: &[[u32; 3]]) -> Mesh {
    let (points, triangles) = site.geometry().terrain.ground.triangles();
    let normals = vertex_normals(&points, &triangles);
    let vertex = |k: u32| {
        let (p, n) = (&points[k as usize], &normals[k as usize]);
        let near = site.geometry().nearest_member(*p, BAKED_LIGHT_RANGE_M).is_some();
        // On an open slope, light comes from the sky above the slope and, to a small extent, from the ground.
        let open = [0.5 + 0.5 * n.up() as f32, 0.02];
        let light = if near { bake.at(*p + *n * 0.3, *n) } else { open };
        ground_vertex(*p, *n, light, p.up() - scenario.terrain.water_level_m)
    };
    mesh_of_triangles(points.len(), shown.iter().copied(), vertex)
}

/// Builds a mesh of triangles, creating each vertex on first use.
fn mesh_of_triangles(corners: usize, triangles: impl Iterator<Item = [u32; 3]>, vertex: impl Fn(u32) -> Vertex) -> Mesh {
    let mut mesh = Mesh::default();
    let mut placed: Vec<Option<u32>> = vec![None; corners];
    for k in triangles.flatten() {
        let index = placed[k as usize].unwrap_or_else(|| {
            mesh.vertices.push(vertex(k));
            mesh.vertices.len() as u32 - 1
        });
        placed[k as usize] = Some(index);
        mesh.indices.push(index);
    }
    mesh
}

/// Returns the mean normals of the triangles at each point.
pub fn vertex_normals(points: &[Vec3<Enu>], triangles: &[[u32; 3]]) -> Vec<Vec3<Enu>> {
    let mut sums = vec![Vec3::zero(); points.len()];
    for [a, b, c] in triangles {
        let at = |k: &u32| points[*k as usize];
        let normal = (at(b) - at(a)).cross(at(c) - at(a));
        for k in [a, b, c] {
            sums[*k as usize] += normal;
        }
    }
    sums.into_iter().map(Vec3::unit).collect()
}

/// Builds the lake: inside the field, one vertex with depth per ground vertex; outside, a frame around the field.
pub fn water(scenario: &Scenario, site: &Site, bake: &LightBaker, shown: &[[u32; 3]]) -> Mesh {
    let level = scenario.terrain.water_level_m;
    let (points, _) = site.geometry().terrain.ground.triangles();
    let wet = |k: &u32| level - points[*k as usize].up() > -1.5;
    let lee = Lee::new(scenario, site);
    let vertex = |k: u32| {
        let p = points[k as usize];
        let at = Vec3::new(p.east(), p.north(), level);
        let near = site.geometry().nearest_member(at, BAKED_LIGHT_RANGE_M).is_some();
        let light = if near { bake.at(at, Vec3::new(0.0, 0.0, 1.0)) } else { [1.0, 0.0] };
        water_vertex(at, (light, wind_share(lee.as_ref(), at)), level - p.up())
    };
    let mut mesh = mesh_of_triangles(points.len(), shown.iter().filter(|t| t.iter().any(wet)).copied(), vertex);
    let half = 0.5 * scenario.terrain.size_m;
    let frame = [
        (-LAKE_EXTENT_M, -LAKE_EXTENT_M, LAKE_EXTENT_M, -half),
        (-LAKE_EXTENT_M, half, LAKE_EXTENT_M, LAKE_EXTENT_M),
        (-LAKE_EXTENT_M, -half, -half, half),
        (half, -half, LAKE_EXTENT_M, half),
    ];
    for (west, south, east, north) in frame {
        let first = mesh.vertices.len() as u32;
        for (x, y) in [(west, south), (east, south), (east, north), (west, north)] {
            mesh.vertices.push(water_vertex(Vec3::new(x, y, level), ([1.0, 0.0], 1.0), OPAQUE_DEPTH_M));
        }
        mesh.indices.extend([0, 1, 2, 0, 2, 3].map(|k| first + k));
    }
    mesh
}

/// The wind on the lake behind piers and towers, for the first wind of the scenario.
struct Lee {
    wakes: WakeField,
    /// Direction of the wind.
    along: Vec3<Enu>,
    /// Speed of the wind, m/s.
    speed_m_s: f64,
}

impl Lee {
    /// Returns `None` if the job has no wakes or no wind.
    fn new(scenario: &Scenario, site: &Site) -> Option<Self> {
        let velocity = velocity_at(&scenario.wind, SimTime::ZERO);
        let speed_m_s = velocity.norm();
        if !scenario.has_wakes() || speed_m_s <= MIN_WIND_M_S {
            return None;
        }
        // The phase of the vortices has no effect on the mean wind.
        let mut wakes = WakeField::new(site.members(), &scenario.bridges, 0);
        wakes.advance(velocity, SimTime::ZERO);
        Some(Self { wakes, along: velocity.enu().unit(), speed_m_s })
    }

    /// Returns the mean wind at a position on the water, relative to the undisturbed one.
    fn wind_share(&self, at: Vec3<Enu>) -> f32 {
        let air = self.wakes.air(at + Vec3::new(0.0, 0.0, RIPPLE_HEIGHT_M), at.up());
        (1.0 + air.velocity_m_s.enu().dot(self.along) / self.speed_m_s).clamp(0.0, MAX_WIND_SHARE) as f32
    }
}

/// Returns the mean wind at a position on the water, relative to the undisturbed one.
fn wind_share(lee: Option<&Lee>, at: Vec3<Enu>) -> f32 {
    lee.map_or(1.0, |lee| lee.wind_share(at))
}

/// Returns a vertex of the lake. Its first surface coordinate is the wind there relative to the undisturbed one.
fn water_vertex(p: Vec3<Enu>, (light, wind_share): ([f32; 2], f32), depth_m: f64) -> Vertex {
    Vertex {
        position: single(p),
        normal: [0.0, 0.0, 1.0],
        uv: [wind_share, 0.0],
        light,
        material: Material::Ground as u32,
        tint: [255; 4],
        aux: depth_m as f32,
    }
}

/// Builds the landing pad slightly above its slab to avoid z-fighting.
pub fn pad(site: &Site) -> Mesh {
    let slab = &site.geometry().pad().solid.vertices_m;
    let top = slab.iter().map(|v| v.up()).fold(f64::NEG_INFINITY, f64::max);
    let center = slab.iter().fold(Vec3::zero(), |sum, v| sum + *v) / slab.len() as f64;
    let half = slab.iter().map(|v| (v.east() - center.east()).abs()).fold(0.0, f64::max);
    let mut mesh = Mesh::default();
    for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let p = Vec3::new(center.east() + x * half, center.north() + y * half, top + 0.004);
        mesh.vertices.push(Vertex {
            position: single(p),
            normal: [0.0, 0.0, 1.0],
            uv: [(x * half) as f32, (y * half) as f32],
            light: [1.0, 0.02],
            material: Material::Pad as u32,
            tint: [255; 4],
            aux: 0.0,
        });
    }
    mesh.indices.extend([0, 1, 2, 0, 2, 3]);
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::shipped::TWO_BRIDGES;

    fn job() -> Scenario {
        let mut job = spandrel_model::scenario::read("two-bridges.toml", TWO_BRIDGES, &|_| Err("none".into())).unwrap();
        (job.wind.speed_m_s, job.wind.from_deg) = (6.0, 270.0);
        job.wind.events.clear();
        job.hazards.wakes = true;
        job
    }

    /// Returns the places of the lake in a square grid, with the wind there.
    fn grid(scenario: &Scenario, site: &Site) -> Vec<(Vec3<Enu>, f32)> {
        const SPACING_M: f64 = 4.0;
        let lee = Lee::new(scenario, site);
        let places = (-22..=22).flat_map(|x| (-10..=50).map(move |y| (SPACING_M * f64::from(x), SPACING_M * f64::from(y))));
        let on_lake = places.filter_map(|(east, north)| Some(Vec3::new(east, north, site.water_up_m(east, north)?)));
        on_lake.map(|at| (at, wind_share(lee.as_ref(), at))).collect()
    }

    #[test]
    fn exact_the_lake_is_calmer_behind_piers_and_only_there() {
        /// Distance within which the calmest places must have a pier upwind, m.
        const UPWIND_M: f64 = 200.0;
        let job = job();
        let site = Site::without_defects(&job);
        let grid = grid(&job, &site);
        let calm: Vec<&(Vec3<Enu>, f32)> = grid.iter().filter(|(_, share)| *share < 0.7).collect();
        assert!(!calm.is_empty() && calm.len() < grid.len() / 10, "{} of {} places", calm.len(), grid.len());
        for (at, share) in calm {
            let from = *at + Vec3::new(0.0, 0.0, RIPPLE_HEIGHT_M);
            // A wake is wider than its pier.
            let pier = (-4..=4).any(|k| {
                let beside = from + Vec3::new(0.0, 3.0 * f64::from(k), 0.0);
                site.geometry().ray(beside, Vec3::new(-1.0, 0.0, 0.0), UPWIND_M).is_some()
            });
            assert!(pier, "{at:?}: {share}");
        }
    }

    #[test]
    fn exact_there_is_no_lee_without_wind_or_wakes() {
        let changes: [fn(&mut Scenario); 2] = [|job| job.wind.speed_m_s = 0.0, |job| job.hazards.wakes = false];
        for change in changes {
            let mut job = job();
            change(&mut job);
            let site = Site::without_defects(&job);
            assert!(grid(&job, &site).iter().all(|(_, share)| *share == 1.0));
        }
    }
}
