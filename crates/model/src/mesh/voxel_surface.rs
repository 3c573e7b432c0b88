//! Turns a point cloud into the closed surface of cubic cells: each cell that contains a point is solid.

use super::mesh_file::MAX_TRIANGLES;
use super::vectors::{Point, bounds};
use super::vertex_colors::Color;
use super::voxel_grid::VoxelGrid;
use super::{BOX_FACES, Mesh, fans};

/// Maximum number of cells in the bounding box of the points (estimate: 40 MB).
const MAX_CELLS: usize = 150_000_000;
/// Maximum number of cells along an axis: as many as a key has bits for, less a margin.
const MAX_LENGTH: usize = 1_000_000;
/// Bits of a key for each axis.
const KEY_BITS: u32 = 21;
/// Bounds of the size of a cell, m.
pub const VOXEL_RANGE_M: (f64, f64) = (0.02, 1.0);

/// How a cloud becomes a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CloudLimits {
    /// Size of a cell, m.
    pub voxel_m: f64,
    /// Minimum number of points in a group of cells that touch in a face, an edge or a corner; smaller groups are outliers.
    pub min_points: usize,
}

impl Default for CloudLimits {
    fn default() -> Self {
        Self { voxel_m: 0.1, min_points: 20 }
    }
}

/// Counts of the points and cells of a converted cloud.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct CloudReport {
    /// Number of points that the file marks as no part of a bridge.
    pub left_out: usize,
    /// Number of all other points.
    pub points: usize,
    /// Number of points in groups that are too small.
    pub outliers: usize,
    /// Number of cells with points.
    pub voxels: usize,
    /// Number of cells without points that are solid all the same: voids that nothing connects with the outside, and cells beside others
    /// that would touch in an edge or a corner only.
    pub filled: usize,
}

/// The surface of the cells of a cloud.
#[derive(Debug, Clone, PartialEq)]
pub struct CloudSurface {
    /// Closed triangles.
    pub mesh: Mesh,
    /// Color of each vertex; empty if the points have none.
    pub colors: Vec<Color>,
    /// Numbers of points and cells.
    pub report: CloudReport,
}

/// A cell with points.
#[derive(Debug, Clone, Copy)]
struct Voxel {
    key: u64,
    points: usize,
    /// Sum of the colors of its points.
    color: [u64; 3],
}

impl CloudLimits {
    /// Returns the largest distance of a point of the surface from the nearest point of the cloud, m, except where voids are filled: the
    /// diagonal of a cell.
    #[must_use]
    pub fn deviation_m(&self) -> f64 {
        3.0_f64.sqrt() * self.voxel_m
    }
}

/// Returns the surface of the cells that contain points, without outliers. All lengths are in meters.
///
/// # Errors
/// Returns the number of cells or triangles and the allowed one if there are too many, or if all points are outliers.
pub fn cloud_surface(
    points: impl Iterator<Item = (Point, Color)> + Clone,
    is_colored: bool,
    limits: CloudLimits,
) -> Result<CloudSurface, String> {
    let cell = |p: Point| p.map(|value| (value / limits.voxel_m).floor() as i64);
    let (low, high) = bounds(points.clone().map(|(p, _)| p)).ok_or("no points (allowed: at least one)")?;
    let (first, last) = (cell(low), cell(high));
    if (0..3).any(|k| last[k] - first[k] >= MAX_LENGTH as i64) {
        let length_m = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
        let words = format!("a cloud of {length_m:.0} m with voxels of {} m", limits.voxel_m);
        return Err(format!("{words} (allowed: {MAX_LENGTH} voxels along an axis; set a larger --voxel-size, or --scale)"));
    }
    let key = |p: Point| {
        let own = cell(p);
        (0..3).rev().fold(0, |key, k| key << KEY_BITS | (own[k] - first[k] + 1) as u64)
    };
    let mut keyed: Vec<(u64, Color)> = points.map(|(p, color)| (key(p), color)).collect();
    let mut report = CloudReport { points: keyed.len(), ..CloudReport::default() };
    keyed.sort_unstable();
    let mut voxels: Vec<Voxel> = keyed.chunk_by(|a, b| a.0 == b.0).map(Voxel::of).collect();
    drop(keyed);
    report.outliers = remove_small_groups(&mut voxels, limits.min_points);
    report.voxels = voxels.len();
    if voxels.is_empty() {
        let words = format!("all {} points are in groups of fewer than {}", report.points, limits.min_points);
        return Err(format!("{words} (allowed: at least one larger group; set a smaller --min-points or a larger --voxel-size)"));
    }
    let (grid, lowest) = grid(&voxels, limits.voxel_m)?;
    let corner_m = |[x, y, z]: [usize; 3]| {
        let at = [x, y, z];
        [0, 1, 2].map(|k: usize| (first[k] + lowest[k] as i64 + at[k] as i64 - 2) as f64 * limits.voxel_m)
    };
    let mut grid = grid;
    report.filled = grid.fill_contacts() + grid.fill_voids();
    let (mesh, corners) = surface(&grid, corner_m)?;
    let colors = if is_colored { colors(&grid, &voxels, lowest, &corners) } else { Vec::new() };
    Ok(CloudSurface { mesh, colors, report })
}

impl Voxel {
    fn of(points: &[(u64, Color)]) -> Self {
        let add = |sum: [u64; 3], (_, color): &(u64, Color)| [0, 1, 2].map(|k: usize| sum[k] + u64::from(color[k]));
        Self { key: points[0].0, points: points.len(), color: points.iter().fold([0; 3], add) }
    }

    /// Returns the position along x, y and z.
    const fn cell(&self) -> [usize; 3] {
        let mask = (1 << KEY_BITS) - 1;
        [(self.key & mask) as usize, (self.key >> KEY_BITS & mask) as usize, (self.key >> (2 * KEY_BITS) & mask) as usize]
    }
}

/// Removes the groups of touching voxels with fewer points than `min_points`. Returns the number of their points. The voxels are sorted by
/// their keys.
fn remove_small_groups(voxels: &mut Vec<Voxel>, min_points: usize) -> usize {
    let mut owner: Vec<u32> = (0..voxels.len() as u32).collect();
    let row = 1_u64 << KEY_BITS;
    // The neighbors with larger keys: the next one along x, and three in each of four rows.
    let rows = [row, (row << KEY_BITS) - row, row << KEY_BITS, (row << KEY_BITS) + row];
    let mut next = rows.map(|_| 0_usize);
    for k in 0..voxels.len() {
        let key = voxels[k].key;
        if voxels.get(k + 1).is_some_and(|other| other.key == key + 1) {
            join(&mut owner, k, k + 1);
        }
        for (offset, at) in rows.iter().zip(&mut next) {
            while voxels.get(*at).is_some_and(|other| other.key < key + offset - 1) {
                *at += 1;
            }
            (*at..voxels.len()).take_while(|j| voxels[*j].key <= key + offset + 1).for_each(|j| join(&mut owner, k, j));
        }
    }
    let owners: Vec<usize> = (0..voxels.len()).map(|k| root(&mut owner, k)).collect();
    let mut points = vec![0; voxels.len()];
    owners.iter().zip(voxels.iter()).for_each(|(owner, voxel)| points[*owner] += voxel.points);
    let all: usize = points.iter().sum();
    let mut owners = owners.iter();
    voxels.retain(|_| owners.next().is_some_and(|owner| points[*owner] >= min_points));
    all - voxels.iter().map(|voxel| voxel.points).sum::<usize>()
}

fn root(owner: &mut [u32], k: usize) -> usize {
    let mut at = k;
    while owner[at] as usize != at {
        owner[at] = owner[owner[at] as usize];
        at = owner[at] as usize;
    }
    at
}

fn join(owner: &mut [u32], a: usize, b: usize) {
    let (a, b) = (root(owner, a), root(owner, b));
    owner[a.max(b)] = a.min(b) as u32;
}

/// Returns the grid around the voxels, and the position of its first inner cell.
fn grid(voxels: &[Voxel], voxel_m: f64) -> Result<(VoxelGrid, [usize; 3]), String> {
    let limit = |pick: fn(usize, usize) -> usize, start: usize| {
        voxels.iter().map(Voxel::cell).fold([start; 3], |so_far, cell| [0, 1, 2].map(|k: usize| pick(so_far[k], cell[k])))
    };
    let (low, high) = (limit(usize::min, usize::MAX), limit(usize::max, 0));
    let size = [0, 1, 2].map(|k: usize| high[k] - low[k] + 1);
    let count = size.iter().try_fold(1_usize, |count, own| count.checked_mul(*own)).unwrap_or(usize::MAX);
    if count > MAX_CELLS {
        let [x, y, z] = size;
        let words = format!("{x} x {y} x {z} voxels of {voxel_m} m in the bounding box");
        return Err(format!("{words} (allowed: at most {MAX_CELLS}; set a larger --voxel-size, or --scale, or crop the cloud)"));
    }
    let mut grid = VoxelGrid::new(size);
    for voxel in voxels {
        grid.fill(grid.index(inner(voxel, low)));
    }
    Ok((grid, low))
}

/// Returns the cell of a voxel in a grid whose first inner cell is at `lowest`.
fn inner(voxel: &Voxel, lowest: [usize; 3]) -> [usize; 3] {
    let cell = voxel.cell();
    [0, 1, 2].map(|k: usize| cell[k] - lowest[k] + 1)
}

/// Returns the faces between solid and empty cells, two triangles each, and the corner of the grid at each vertex: the one between the
/// cell with this index and those below it along each axis. `corner_m` returns the place of the lowest corner of a cell.
fn surface(grid: &VoxelGrid, corner_m: impl Fn([usize; 3]) -> Point) -> Result<(Mesh, Vec<usize>), String> {
    let steps = grid.steps();
    let mut quads: Vec<[u32; 4]> = Vec::new();
    for index in grid.solid() {
        for (side, face) in BOX_FACES.iter().enumerate() {
            let step = steps[AXES[side]];
            let beside = if side % 2 == 0 { index - step } else { index + step };
            if grid.is_solid(beside) {
                continue;
            }
            let corner =
                |k: u32| (index + (0..3).filter(|axis| k >> axis & 1 == 1).map(|axis| steps[axis]).sum::<usize>()) as u32;
            quads.push(face.map(corner));
        }
        if 2 * quads.len() > MAX_TRIANGLES {
            let words = format!("more than {MAX_TRIANGLES} triangles");
            return Err(format!("{words} (allowed: at most {MAX_TRIANGLES}; set a larger --voxel-size, or crop the cloud)"));
        }
    }
    let mut corners: Vec<u32> = quads.iter().flatten().copied().collect();
    corners.sort_unstable();
    corners.dedup();
    // All corners of the quads are among the sorted ones.
    let number = |corner: u32| corners.partition_point(|other| *other < corner) as u32;
    let numbered: Vec<[u32; 4]> = quads.iter().map(|quad| quad.map(number)).collect();
    let corners: Vec<usize> = corners.into_iter().map(|corner| corner as usize).collect();
    let vertices_m = corners.iter().map(|corner| corner_m(grid.cell(*corner))).collect();
    Ok((Mesh { vertices_m, triangles: fans(numbered.iter().map(<[u32; 4]>::as_slice)) }, corners))
}

/// Axis across each of the faces in [`BOX_FACES`], whose even ones are the lower sides.
const AXES: [usize; 6] = [2, 2, 1, 1, 0, 0];

/// Returns the color of each corner: the mean of the points in the cells around it, or of all points if these cells have none.
fn colors(grid: &VoxelGrid, voxels: &[Voxel], lowest: [usize; 3], corners: &[usize]) -> Vec<Color> {
    let steps = grid.steps();
    let mut sums = vec![[0_u64; 4]; corners.len()];
    let mut all = [0_u64; 4];
    for voxel in voxels {
        let own = [voxel.color[0], voxel.color[1], voxel.color[2], voxel.points as u64];
        all.iter_mut().zip(own).for_each(|(sum, value)| *sum += value);
        let index = grid.index(inner(voxel, lowest));
        for bits in 0..8 {
            let corner = index + (0..3).filter(|axis| bits >> axis & 1 == 1).map(|axis| steps[axis]).sum::<usize>();
            if let Ok(k) = corners.binary_search(&corner) {
                sums[k].iter_mut().zip(own).for_each(|(sum, value)| *sum += value);
            }
        }
    }
    let mean = |[red, green, blue, count]: [u64; 4]| [red, green, blue].map(|sum| ((sum + count / 2) / count.max(1)) as u8);
    sums.into_iter().map(|sum| mean(if sum[3] > 0 { sum } else { all })).collect()
}

#[cfg(test)]
mod tests {
    use super::super::surface_mesh::SurfaceMesh;
    use super::*;
    use crate::random::RandomStream;

    const LIMITS: CloudLimits = CloudLimits { voxel_m: 0.5, min_points: 1 };

    fn surface_of(points: &[Point], limits: CloudLimits) -> Result<CloudSurface, String> {
        cloud_surface(points.iter().map(|p| (*p, [200, 100, 0])), true, limits)
    }

    #[test]
    fn exact_one_point_becomes_its_cell() {
        let own = surface_of(&[[1.1, -0.2, 3.0]], LIMITS).unwrap();
        assert_eq!(own.mesh.bounds(), Some(([1.0, -0.5, 3.0], [1.5, 0.0, 3.5])));
        assert!((own.mesh.volume_m3() - 0.125).abs() < 1e-12 && own.mesh.triangles.len() == 12);
        assert_eq!(own.colors, [[200, 100, 0]; 8]);
    }

    #[test]
    fn exact_a_scanned_box_is_filled() {
        // Points on the six sides of a box of 4 x 3 x 2 m, 0.1 m apart.
        let mut points = Vec::new();
        for (i, j, k) in (0..=40).flat_map(|i| (0..=30).flat_map(move |j| (0..=20).map(move |k| (i, j, k)))) {
            if [0, 40].contains(&i) || [0, 30].contains(&j) || [0, 20].contains(&k) {
                points.push([i, j, k].map(|steps| 0.1 * f64::from(steps) + 0.05));
            }
        }
        let own = surface_of(&points, LIMITS).unwrap();
        // From 0.05 to 4.05 m: nine cells of 0.5 m along x, seven along y, five along z.
        assert!((own.mesh.volume_m3() - 4.5 * 3.5 * 2.5).abs() < 1e-9, "{}", own.mesh.volume_m3());
        assert_eq!((own.report.voxels, own.report.filled), (9 * 7 * 5 - 7 * 5 * 3, 7 * 5 * 3));
        let open: Vec<Point> = points.into_iter().filter(|p| p[2] < 1.9).collect();
        let own = surface_of(&open, LIMITS).unwrap();
        assert_eq!(own.report.filled, 0, "a drone can fly into it");
    }

    #[test]
    fn exact_thin_members_survive_and_small_groups_are_outliers() {
        // A rod of single points in cells that touch, some of them in a corner only, and two points far away from it.
        let rod: Vec<Point> = (0..30).map(|k| [0.4, 0.4, 0.5].map(|step| step * f64::from(k))).collect();
        let far = [[50.0, 0.0, 0.0], [50.2, 0.2, 0.0]];
        let limits = CloudLimits { min_points: 3, ..LIMITS };
        let own = surface_of(&[&rod[..], &far].concat(), limits).unwrap();
        assert_eq!((own.report.points, own.report.outliers), (32, 2));
        let (low, high) = own.mesh.bounds().unwrap();
        assert!(low == [0.0; 3] && high == [12.0, 12.0, 15.0], "{low:?} {high:?}");
        let all = CloudLimits { min_points: 33, ..LIMITS };
        let error = surface_of(&[&rod[..], &far].concat(), all).unwrap_err();
        assert!(error.starts_with("all 32 points are in groups of fewer than 33 (allowed: "), "{error}");
    }

    #[test]
    fn prop_the_surface_is_closed_contains_each_point_and_is_near_the_points() {
        let mut random = RandomStream::new(9, "cloud");
        for _ in 0..30 {
            let count = 1 + random.below(300);
            let points: Vec<Point> = (0..count).map(|_| [0; 3].map(|_: u8| random.range(-3.0, 3.0))).collect();
            let own = surface_of(&points, LIMITS).unwrap();
            let surface = SurfaceMesh::with_colors(&own.mesh, &own.colors).unwrap();
            assert!(surface.is_closed() && surface.colors().len() == surface.mesh().vertices_m.len());
            let mut edges: Vec<(u32, u32)> =
                surface.mesh().triangles.iter().flat_map(|[a, b, c]| [(*a, *b), (*b, *c), (*c, *a)]).collect();
            edges.sort_unstable();
            assert!(edges.windows(2).all(|pair| pair[0] != pair[1]), "at each edge, the surface has two sides");
            let cells = own.report.voxels + own.report.filled;
            assert!((own.mesh.volume_m3() - 0.125 * cells as f64).abs() < 1e-6);
            let distance = |p: &Point, q: &Point| (0..3).map(|k| (p[k] - q[k]) * (p[k] - q[k])).sum::<f64>().sqrt();
            let near = |vertex: &Point| points.iter().any(|p| distance(vertex, p) <= LIMITS.deviation_m() + 1e-9);
            let far = own.mesh.vertices_m.iter().filter(|vertex| !near(vertex)).count();
            assert!(far <= 8 * own.report.filled, "{far} vertices");
        }
    }

    #[test]
    fn regress_too_many_voxels_or_triangles_name_the_number_and_what_is_allowed() {
        let fine = CloudLimits { voxel_m: 0.02, min_points: 1 };
        let error = surface_of(&[[0.0; 3], [100.0, 100.0, 100.0]], fine).unwrap_err();
        assert!(
            error.starts_with("5001 x 5001 x 5001 voxels of 0.02 m in the bounding box (allowed: at most 150000000;"),
            "{error}"
        );
        let error = surface_of(&[[0.0; 3], [1e6, 0.0, 0.0]], fine).unwrap_err();
        assert!(
            error.starts_with("a cloud of 1000000 m with voxels of 0.02 m (allowed: 1000000 voxels along an axis;"),
            "{error}"
        );
    }
}
