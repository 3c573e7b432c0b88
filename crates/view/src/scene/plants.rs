//! Conifers and boulders for visual scale. They have no collision geometry, so they are kept clear of bridges, task
//! paths, and the pad.

use super::super::mesh::{Material, Mesh, SurfaceFinish, Vertex, single};
use super::super::quality::Quality;
use super::item::{Instance, SceneItem, VisibleRange};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::{Scenario, TerrainSource};
use spandrel_model::site::Site;

/// Clearance from every member, m (a tree crown plus space for flying around a bridge).
const BRIDGE_CLEARANCE_M: f64 = 14.0;
/// Clearance from every point of a task path, m.
const PATH_CLEARANCE_M: f64 = 16.0;
/// Clearance from the pad, m.
const PAD_CLEARANCE_M: f64 = 26.0;
/// Minimum height of trees above the water, m.
const MIN_TREE_HEIGHT_ABOVE_WATER_M: f64 = 2.2;
/// Minimum vertical component of the ground normal for trees.
const MIN_NORMAL_UP: f64 = 0.72;
/// Maximum distance of reflected trees for presets that save triangles, m (a tree covers three pixels at that
/// distance).
const MAX_REFLECTED_TREE_DISTANCE_M: f64 = 160.0;
/// Maximum distance of boulders, m: in a view 640 px and 84 degrees wide, the largest cover three pixels, but most
/// cover only one.
const MAX_BOULDER_DISTANCE_M: f64 = 150.0;
/// Minimum distance of trees with fewer branches, m: the tallest are 25 pixels high there. Within the overlap, both
/// variants are drawn.
const FAR_TREE_DISTANCE_M: f64 = 220.0;
const LOD_OVERLAP_M: f64 = 5.0;
/// Branches per whorl of distant trees in presets with many branches.
const FAR_BRANCHES_PER_WHORL: u32 = 5;
/// Size of tree groves, m.
const GROVE_SIZE_M: f64 = 55.0;

const NEEDLES: SurfaceFinish = SurfaceFinish::new(Material::Foliage, [17, 30, 15]);
const BARK: SurfaceFinish = SurfaceFinish::new(Material::Bark, [42, 30, 22]);
const STONE: SurfaceFinish = SurfaceFinish::new(Material::Rock, [74, 70, 64]);

/// Builds the trees and boulders of a site. An aerial photograph already shows the site's own.
pub fn parts(scenario: &Scenario, site: &Site, quality: &Quality) -> Vec<SceneItem> {
    if scenario.terrain.photo.is_some() { Vec::new() } else { generated(scenario, site, quality) }
}

/// Builds trees and boulders whose positions come from the terrain's seed.
fn generated(scenario: &Scenario, site: &Site, quality: &Quality) -> Vec<SceneItem> {
    let seed = match &scenario.terrain.source {
        TerrainSource::Valley { seed, .. } => *seed,
        TerrainSource::Flat { .. } | TerrainSource::File { .. } => 1,
    };
    let mut stream = RandomStream::new(seed, "view.plants");
    let (mut tall, mut slim, mut rocks) = (Vec::new(), Vec::new(), Vec::new());
    let half = 0.49 * scenario.terrain.size_m;
    for _ in 0..40 * quality.trees {
        if tall.len() + slim.len() >= quality.trees {
            break;
        }
        let (east, north) = (stream.range(-half, half), stream.range(-half, half));
        let (size, turn, kind) = (stream.range(6.0, 15.0), stream.range(0.0, math::TAU), stream.uniform());
        if stream.uniform() > tree_density(east, north) {
            continue;
        }
        let Some(foot) = free_ground_point(scenario, site, east, north, MIN_TREE_HEIGHT_ABOVE_WATER_M) else { continue };
        let list = if kind < 0.5 { &mut tall } else { &mut slim };
        list.push(plant_instance(foot, size, turn));
    }
    for _ in 0..20 * quality.trees {
        if rocks.len() >= quality.trees / 2 {
            break;
        }
        let (east, north) = (stream.range(-half, half), stream.range(-half, half));
        let (size, turn) = (0.25 + 1.1 * stream.uniform() * stream.uniform(), stream.range(0.0, math::TAU));
        let shore = site.ground_up_m(east, north) - scenario.terrain.water_level_m;
        if !(-0.5..2.5).contains(&shore) {
            continue;
        }
        let Some(foot) = free_ground_point(scenario, site, east, north, -0.5) else { continue };
        rocks.push(plant_instance(foot, size, turn));
    }
    let on_shore = if quality.sparse {
        VisibleRange { direct_m: VisibleRange::within(MAX_BOULDER_DISTANCE_M), ..VisibleRange::DIRECT_ONLY }
    } else {
        VisibleRange::EVERYWHERE
    };
    let mut parts = if quality.sparse { merged_trees(&tall, &slim, quality) } else { trees(&tall, &slim, quality) };
    parts.push(copies("boulders", boulder(quality.branches_per_whorl), rocks, on_shore));
    parts
}

fn copies(name: &'static str, mesh: Mesh, instances: Vec<Instance>, visible_range: VisibleRange) -> SceneItem {
    SceneItem { name, mesh, instances, casts_shadows: true, visible_range, backdrop: false }
}

/// Returns trees as single meshes: software renderers process instances one by one, so a merged mesh is faster.
fn merged_trees(tall: &[Instance], slim: &[Instance], quality: &Quality) -> Vec<SceneItem> {
    let wood = |spruce: &Mesh, fir: &Mesh| {
        let mut wood = merge_instances(spruce, tall);
        wood.append(&merge_instances(fir, slim));
        wood
    };
    let (spruce, fir) = (conifer(0.21, 3, quality.branches_per_whorl), conifer(0.15, 4, quality.branches_per_whorl));
    let near = VisibleRange {
        direct_m: VisibleRange::within(FAR_TREE_DISTANCE_M + LOD_OVERLAP_M),
        in_lake_m: VisibleRange::within(MAX_REFLECTED_TREE_DISTANCE_M),
    };
    let far = VisibleRange { direct_m: VisibleRange::beyond(FAR_TREE_DISTANCE_M), ..VisibleRange::DIRECT_ONLY };
    let distant = SceneItem::here("distant trees", wood(&distant_conifer(0.21), &distant_conifer(0.15)), false);
    vec![
        SceneItem { visible_range: near, ..SceneItem::here("trees", wood(&spruce, &fir), true) },
        SceneItem { visible_range: far, ..distant },
    ]
}

/// Returns trees as copies of their meshes, with fewer branches in the distance.
fn trees(tall: &[Instance], slim: &[Instance], quality: &Quality) -> Vec<SceneItem> {
    let everywhere = |distances_m: [f64; 2]| VisibleRange { direct_m: distances_m, in_lake_m: distances_m };
    let near = everywhere(VisibleRange::within(FAR_TREE_DISTANCE_M + LOD_OVERLAP_M));
    let far = everywhere(VisibleRange::beyond(FAR_TREE_DISTANCE_M));
    let (spruce, fir) = (|branches| conifer(0.21, 3, branches), |branches| conifer(0.15, 4, branches));
    vec![
        copies("spruces", spruce(quality.branches_per_whorl), tall.to_vec(), near),
        copies("distant spruces", spruce(FAR_BRANCHES_PER_WHORL), tall.to_vec(), far),
        copies("firs", fir(quality.branches_per_whorl), slim.to_vec(), near),
        copies("distant firs", fir(FAR_BRANCHES_PER_WHORL), slim.to_vec(), far),
    ]
}

/// Returns the tree density at a point, 0 to 1: groves and clearings.
fn tree_density(east: f64, north: f64) -> f64 {
    let wave =
        math::sin(east / GROVE_SIZE_M + 1.3 * math::sin(north / (1.4 * GROVE_SIZE_M))) * math::cos(north / GROVE_SIZE_M - 0.5);
    (0.25 + 0.75 * wave).clamp(0.03, 1.0)
}

/// Returns the point on the ground if it has enough clearance for a plant.
fn free_ground_point(scenario: &Scenario, site: &Site, east: f64, north: f64, height_over_water_m: f64) -> Option<Vec3<Enu>> {
    let (up, normal) = site.geometry().terrain.ground.ground(east, north);
    let at = Vec3::new(east, north, up);
    let fits = up - scenario.terrain.water_level_m >= height_over_water_m && normal.up() >= MIN_NORMAL_UP;
    let clear = |p: &Vec3<Enu>, room_m: f64| math::hypot(p.east() - east, p.north() - north) >= room_m;
    let team = &scenario.ground_team;
    let from_inspector = || team.inspector_places_m().all(|place| clear(&place, 12.0));
    let from_team = clear(&team.pad_m, PAD_CLEARANCE_M) && clear(&team.truck_m, 12.0) && from_inspector();
    let from_paths = || scenario.tasks.iter().flat_map(|t| t.path_m.iter().step_by(4)).all(|p| clear(p, PATH_CLEARANCE_M));
    let from_bridges = || {
        let lifted = Vec3::new(east, north, up + 5.0);
        site.geometry().nearest_member(lifted, BRIDGE_CLEARANCE_M).is_none() && !is_near_deck(scenario, at)
    };
    (fits && from_team && from_paths() && from_bridges()).then_some(at)
}

/// Checks whether a point is below or next to a deck or approach.
fn is_near_deck(scenario: &Scenario, at: Vec3<Enu>) -> bool {
    scenario.bridges.iter().any(|bridge| {
        let [x, y, _] = bridge.placement().local(at);
        y.abs() < 0.5 * bridge.deck_width_m() + 9.0 && x.abs() < 0.5 * bridge.deck_length_m() + 90.0
    })
}

fn plant_instance(foot: Vec3<Enu>, size: f64, turn: f64) -> Instance {
    let (s, c) = math::sin_cos(turn);
    let axes = [Vec3::new(c, s, 0.0) * size, Vec3::new(-s, c, 0.0) * size, Vec3::new(0.0, 0.0, size)];
    Instance::placed(foot, axes, [0.8, 0.02, 0.25, 0.06])
}

/// Builds a conifer of height 1: whorls of drooping branches with a ragged edge.
fn conifer(radius: f64, whorls: u32, branches_per_whorl: u32) -> Mesh {
    // More branches per whorl also mean more and lower whorls.
    let (whorls, height) = if branches_per_whorl < 8 { (whorls, 0.34) } else { (4 * whorls, 0.17) };
    let mut mesh = Mesh::default();
    if branches_per_whorl < 8 {
        trunk(&mut mesh);
    } else {
        mesh.round((Vec3::new(0.0, 0.0, -0.05), 0.018), (Vec3::new(0.0, 0.0, 0.3), 0.012), 5, BARK);
    }
    for whorl in 0..whorls {
        let share = f64::from(whorl) / f64::from(whorls);
        let low = 0.10 + 0.80 * share;
        let high = (low + height * (1.0 - 0.45 * share)).min(1.0);
        let wide = radius * (1.0 - 0.82 * share);
        let rim = |k: u32| {
            let (s, c) = math::sin_cos(
                math::TAU * (f64::from(k % branches_per_whorl) + 0.37 * f64::from(whorl)) / f64::from(branches_per_whorl),
            );
            // Branches alternate between long and short.
            let (ragged, droop) = if (k % branches_per_whorl).is_multiple_of(2) { (1.0, -0.035) } else { (0.68, 0.01) };
            Vec3::new(wide * ragged * c, wide * ragged * s, low + droop)
        };
        let top = Vec3::new(0.0, 0.0, high);
        if branches_per_whorl < 8 {
            add_whorl(&mut mesh, &(0..branches_per_whorl).map(rim).collect::<Vec<_>>(), top);
            continue;
        }
        let hollow = Vec3::new(0.0, 0.0, low + 0.05);
        for k in 0..branches_per_whorl {
            mesh.polygon(&[rim(k), rim(k + 1), top], NEEDLES);
            mesh.polygon(&[rim(k + 1), rim(k), hollow], NEEDLES);
        }
    }
    soften_normals(&mut mesh);
    set_heights(&mut mesh);
    mesh
}

/// Builds a distant conifer of height 1: two whorls of four branches.
fn distant_conifer(radius: f64) -> Mesh {
    const WHORLS: [(f64, f64, f64); 2] = [(0.08, 0.62, 1.0), (0.40, 1.0, 0.62)];
    let mut mesh = Mesh::default();
    for (low, high, share) in WHORLS {
        let rim = |k: u32| {
            let (s, c) = math::sin_cos(math::TAU * (f64::from(k) + low) / 4.0);
            Vec3::new(0.85 * radius * share * c, 0.85 * radius * share * s, low)
        };
        add_whorl(&mut mesh, &(0..4).map(rim).collect::<Vec<_>>(), Vec3::new(0.0, 0.0, high));
    }
    soften_normals(&mut mesh);
    set_heights(&mut mesh);
    mesh
}

/// Adds a whorl with shared vertices, which uses a third as many vertices as separate faces.
fn add_whorl(mesh: &mut Mesh, rim: &[Vec3<Enu>], top: Vec3<Enu>) {
    let (first, count) = (mesh.vertices.len() as u32, rim.len() as u32);
    mesh.polygon(rim, NEEDLES);
    mesh.indices.truncate(mesh.indices.len() - 3 * (rim.len() - 2));
    for (corner, at) in mesh.vertices.iter_mut().skip(first as usize).zip(rim) {
        corner.normal = single((Vec3::new(at.east(), at.north(), 0.0).unit() + Vec3::new(0.0, 0.0, 0.35)).unit());
    }
    let Some(apex) = mesh.vertices.last().map(|corner| Vertex { position: single(top), normal: [0.0, 0.0, 1.0], ..*corner })
    else {
        return;
    };
    mesh.vertices.push(apex);
    mesh.indices.extend((0..count).flat_map(|k| [first + k, first + (k + 1) % count, first + count]));
}

/// Adds a trunk with three faces.
fn trunk(mesh: &mut Mesh) {
    let foot = |k: u32| {
        let (s, c) = math::sin_cos(math::TAU * f64::from(k) / 3.0);
        Vec3::new(0.022 * c, 0.022 * s, -0.05)
    };
    for k in 0..3 {
        mesh.polygon(&[foot(k), foot(k + 1), Vec3::new(0.0, 0.0, 0.5)], BARK);
    }
}

/// Merges all instances into one mesh, including their light.
fn merge_instances(mesh: &Mesh, copies: &[Instance]) -> Mesh {
    let mut all = Mesh::default();
    for copy in copies {
        let first = all.vertices.len() as u32;
        all.vertices.extend(mesh.vertices.iter().map(|v| copy.transformed(v)));
        all.indices.extend(mesh.indices.iter().map(|k| first + k));
    }
    all
}

/// Approximates light scattering by needles: tilts normals outward and up, and darkens the inside.
fn soften_normals(mesh: &mut Mesh) {
    for v in &mut mesh.vertices {
        let [x, y, z] = v.position.map(f64::from);
        let out = Vec3::<Enu>::new(x, y, 0.12 + 0.1 * z);
        let [nx, ny, nz] = v.normal.map(f64::from);
        v.normal = single((Vec3::new(nx, ny, nz) + out.unit() * 0.8).unit());
        let reach = (math::hypot(x, y) / 0.16).min(1.0) as f32;
        v.light = [0.35 + 0.65 * reach, 1.0];
    }
}

/// Stores the height between foot and top, by which the wind moves each vertex.
fn set_heights(mesh: &mut Mesh) {
    for vertex in &mut mesh.vertices {
        vertex.aux = vertex.position[2].clamp(0.0, 1.0);
    }
}

fn boulder(sides: u32) -> Mesh {
    let mut mesh = Mesh::default();
    mesh.sphere_with_detail((sides.min(8), sides + 1), Vec3::new(0.0, 0.0, 0.15), [0.62, 0.5, 0.42], 0.35, STONE);
    mesh
}
