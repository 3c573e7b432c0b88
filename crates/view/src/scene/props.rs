//! Ropes, cars, trucks, and people, the latter each within its collision box (`site::movers`): x forward, y left, z up from the ground.

use super::super::mesh::{Material, Mesh, SurfaceFinish};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::site::movers::MoverKind;

const PAINT: SurfaceFinish = SurfaceFinish::new(Material::Paint, [120, 120, 120]);
const GLASS: SurfaceFinish = SurfaceFinish::new(Material::Glass, [6, 8, 10]);
const TIRE: SurfaceFinish = SurfaceFinish::new(Material::Rubber, [6, 6, 6]);
const RIM: SurfaceFinish = SurfaceFinish::new(Material::Enamel, [90, 90, 92]);
const DARK: SurfaceFinish = SurfaceFinish::new(Material::Rubber, [12, 12, 13]);
const HEADLIGHT: SurfaceFinish = SurfaceFinish::new(Material::Glass, [200, 200, 190]);
const TAIL_LIGHT: SurfaceFinish = SurfaceFinish::new(Material::Glass, [120, 6, 4]);
const BOX: SurfaceFinish = SurfaceFinish::new(Material::Enamel, [150, 150, 146]);
const SKIN: SurfaceFinish = SurfaceFinish::new(Material::Cloth, [120, 72, 50]);
const PANTS: SurfaceFinish = SurfaceFinish::new(Material::Cloth, [16, 20, 34]);
const ROPE: SurfaceFinish = SurfaceFinish::new(Material::Cloth, [150, 62, 12]);
const HAIR: SurfaceFinish = SurfaceFinish::new(Material::Cloth, [22, 14, 8]);

/// Common car colors, linear.
const CAR_COLORS: [[f32; 3]; 8] = [
    [0.62, 0.62, 0.60],
    [0.02, 0.02, 0.022],
    [0.19, 0.20, 0.21],
    [0.32, 0.33, 0.34],
    [0.30, 0.015, 0.012],
    [0.012, 0.045, 0.16],
    [0.55, 0.54, 0.50],
    [0.03, 0.09, 0.05],
];
/// Truck cab colors.
const CAB_COLORS: [[f32; 3]; 4] = [[0.45, 0.02, 0.015], [0.02, 0.08, 0.28], [0.6, 0.6, 0.58], [0.55, 0.25, 0.02]];
/// Jacket colors.
const JACKET_COLORS: [[f32; 3]; 6] =
    [[0.35, 0.03, 0.03], [0.03, 0.07, 0.25], [0.4, 0.3, 0.05], [0.05, 0.2, 0.08], [0.3, 0.3, 0.3], [0.25, 0.05, 0.2]];
/// The inspector's high-visibility vest.
pub const VEST_COLOR: [f32; 3] = [0.85, 0.28, 0.01];
/// Color of the crew's truck: safety yellow, which is visible from a distance and, unlike white, does not look bare
/// without a company logo.
pub const CREW_TRUCK_COLOR: [f32; 3] = [0.75, 0.48, 0.03];

/// Returns the color of the k-th mover.
pub fn color(kind: MoverKind, k: usize) -> [f32; 3] {
    let pick = k.wrapping_mul(7) + 3;
    match kind {
        MoverKind::Car => CAR_COLORS[pick % CAR_COLORS.len()],
        MoverKind::Truck => CAB_COLORS[pick % CAB_COLORS.len()],
        MoverKind::Pedestrian => JACKET_COLORS[pick % JACKET_COLORS.len()],
    }
}

/// Level of detail of round parts such as wheels and limbs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RoundDetail {
    /// All sides, for close views.
    Fine,
    /// Half of the sides, for views across a road.
    Plain,
}

impl RoundDetail {
    /// Returns the number of sides for a part with `finest` sides at full detail.
    fn sides(self, finest: u32) -> u32 {
        match self {
            Self::Fine => finest,
            Self::Plain => finest.div_ceil(2).max(4),
        }
    }

    /// Returns the number of rings and sides of a sphere.
    fn ball(self) -> (u32, u32) {
        match self {
            Self::Fine => (8, 12),
            Self::Plain => (4, 6),
        }
    }
}

fn p(x: f64, y: f64, z: f64) -> Vec3<Enu> {
    Vec3::new(x, y, z)
}

fn wheel(mesh: &mut Mesh, x: f64, y: f64, (radius, width): (f64, f64), rounds: RoundDetail) {
    let side = y.signum();
    mesh.round((p(x, y - side * width, radius), radius), (p(x, y, radius), radius), rounds.sides(14), TIRE);
    mesh.round((p(x, y, radius), 0.62 * radius), (p(x, y + side * 0.015, radius), 0.55 * radius), rounds.sides(12), RIM);
}

/// Builds a family car, 4.5 m long.
pub fn car(rounds: RoundDetail) -> Mesh {
    let mut mesh = Mesh::default();
    // Sills, waist, hood, and trunk.
    mesh.block([-2.2, -0.86, 0.22], [2.2, 0.86, 0.55], [0.0, 0.0, -0.03], PAINT);
    mesh.block([-2.22, -0.89, 0.55], [2.22, 0.89, 0.86], [0.25, 0.10, 0.07], PAINT);
    mesh.block([0.85, -0.80, 0.84], [2.02, 0.80, 0.94], [0.55, 0.0, 0.06], PAINT);
    // Windows around the cabin below the roof.
    mesh.block([-1.75, -0.80, 0.84], [1.02, 0.80, 1.36], [0.75, 0.55, 0.17], GLASS);
    mesh.block([-1.22, -0.64, 1.35], [0.30, 0.64, 1.45], [0.12, 0.12, 0.10], PAINT);
    // Pillars between the windows.
    mesh.block([-0.40, -0.81, 0.84], [-0.30, 0.81, 1.37], [0.0, 0.0, 0.17], PAINT);
    for x in [1.38, -1.38] {
        for y in [0.88, -0.88] {
            wheel(&mut mesh, x, y, (0.33, 0.22), rounds);
        }
    }
    for y in [0.62, -0.62] {
        mesh.block([2.16, y - 0.18, 0.62], [2.235, y + 0.18, 0.76], [0.0; 3], HEADLIGHT);
        mesh.block([-2.235, y - 0.18, 0.66], [-2.16, y + 0.18, 0.80], [0.0; 3], TAIL_LIGHT);
    }
    mesh.block([2.17, -0.5, 0.36], [2.24, 0.5, 0.50], [0.0; 3], DARK);
    mesh.block([-2.24, -0.26, 0.46], [-2.19, 0.26, 0.57], [0.0; 3], BOX);
    mesh
}

/// Builds a truck, 10 m long: a cab and a box body.
pub fn truck(rounds: RoundDetail) -> Mesh {
    let mut mesh = Mesh::default();
    mesh.block([-5.0, -0.45, 0.55], [4.6, 0.45, 0.85], [0.0; 3], DARK);
    // Cab with a raked windshield.
    mesh.block([2.9, -1.18, 0.55], [4.95, 1.18, 1.55], [0.02, 0.0, 0.0], PAINT);
    mesh.block([2.9, -1.18, 1.55], [4.93, 1.18, 2.55], [0.28, 0.0, 0.08], PAINT);
    mesh.block([3.05, -1.12, 2.55], [4.55, 1.12, 2.78], [0.35, 0.1, 0.12], PAINT);
    mesh.block([4.62, -1.04, 1.62], [4.95, 1.04, 2.40], [0.235, 0.0, 0.06], GLASS);
    mesh.block([3.55, -1.195, 1.66], [4.35, 1.195, 2.30], [0.14, 0.0, 0.06], GLASS);
    mesh.block([4.9, -0.8, 0.75], [4.99, 0.8, 1.25], [0.0; 3], DARK);
    for y in [0.92, -0.92] {
        mesh.block([4.9, y - 0.17, 0.72], [4.985, y + 0.17, 0.92], [0.0; 3], HEADLIGHT);
        mesh.block([-5.0, y - 0.15, 0.72], [-4.96, y + 0.15, 0.86], [0.0; 3], TAIL_LIGHT);
    }
    // Box body with a ribbed frame, door gap, and bars. Avoids coplanar faces, which would cause z-fighting.
    mesh.block([-4.98, -1.22, 0.95], [2.56, 1.22, 3.46], [0.0; 3], BOX);
    mesh.block([-5.0, -1.25, 0.88], [2.58, 1.25, 1.02], [0.0; 3], DARK);
    for x in [-4.92, -2.45, 0.05, 2.5] {
        mesh.block([x - 0.05, -1.245, 0.95], [x + 0.05, 1.245, 3.5], [0.0; 3], DARK);
    }
    mesh.block([-4.99, -0.012, 1.02], [-4.97, 0.012, 3.44], [0.0; 3], DARK);
    for y in [0.35, -0.35] {
        mesh.block([-5.0, y - 0.02, 1.10], [-4.97, y + 0.02, 3.38], [0.0; 3], RIM);
    }
    for x in [3.85, -2.35, -3.5] {
        for y in [1.2, -1.2] {
            wheel(&mut mesh, x, y, (0.5, 0.3), rounds);
        }
    }
    mesh
}

/// Builds a standing person, 1.75 m tall.
pub fn person(rounds: RoundDetail) -> Mesh {
    let mut mesh = Mesh::default();
    for y in [0.09, -0.09] {
        mesh.round((p(0.02, y, 0.06), 0.055), (p(0.0, y, 0.48), 0.07), rounds.sides(8), PANTS);
        mesh.round((p(0.0, y, 0.48), 0.07), (p(0.0, y, 0.88), 0.09), rounds.sides(8), PANTS);
        mesh.block([-0.08, y - 0.05, 0.0], [0.18, y + 0.05, 0.09], [0.08, 0.0, 0.01], DARK);
    }
    for y in [0.225, -0.225] {
        mesh.round((p(0.04, y * 1.02, 0.82), 0.035), (p(0.0, y * 0.96, 1.12), 0.045), rounds.sides(7), PAINT);
        mesh.round((p(0.0, y * 0.96, 1.12), 0.045), (p(0.0, y * 0.88, 1.42), 0.055), rounds.sides(7), PAINT);
        mesh.sphere_with_detail(rounds.ball(), p(0.05, y * 1.03, 0.78), [0.04, 0.03, 0.05], 0.0, SKIN);
    }
    mesh.block([-0.11, -0.17, 0.84], [0.11, 0.17, 1.46], [0.02, 0.02, -0.03], PAINT);
    mesh.round((p(0.0, 0.0, 1.44), 0.055), (p(0.0, 0.0, 1.54), 0.05), rounds.sides(8), SKIN);
    mesh.sphere_with_detail(rounds.ball(), p(0.01, 0.0, 1.62), [0.095, 0.08, 0.115], 0.0, SKIN);
    mesh.sphere_with_detail(rounds.ball(), p(-0.015, 0.0, 1.665), [0.098, 0.086, 0.085], 0.0, HAIR);
    mesh
}

/// Builds a segment of a rope: a cylinder of length and radius 1.
pub fn rope(rounds: RoundDetail) -> Mesh {
    let mut mesh = Mesh::default();
    mesh.round((p(0.0, 0.0, 0.0), 1.0), (p(1.0, 0.0, 0.0), 1.0), rounds.sides(8), ROPE);
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tolerance for rendered parts outside the collision shape, m.
    const TOLERANCE_M: f64 = 0.03;

    #[test]
    fn exact_meshes_fit_inside_their_collision_boxes() {
        for (mesh, kind, half_width, height) in [
            (car(RoundDetail::Fine), MoverKind::Car, 0.9, 1.5),
            (truck(RoundDetail::Fine), MoverKind::Truck, 1.25, 3.5),
            (person(RoundDetail::Fine), MoverKind::Pedestrian, 0.29, 1.78),
            (person(RoundDetail::Plain), MoverKind::Pedestrian, 0.29, 1.78),
        ] {
            let half_length = kind.half_length_m();
            for v in &mesh.vertices {
                let [x, y, z] = v.position.map(f64::from);
                assert!(x.abs() <= half_length + TOLERANCE_M && y.abs() <= half_width + TOLERANCE_M, "{kind:?} {:?}", v.position);
                assert!((-TOLERANCE_M..=height + TOLERANCE_M).contains(&z), "{kind:?} {:?}", v.position);
            }
        }
    }
}
