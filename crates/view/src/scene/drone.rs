//! Mesh of the aircraft from its parameters: arms, body, legs, gimbal camera, and a cage if it has one. The mesh axes
//! x, y, z are the body axes (forward, right, down).

use super::super::mesh::{Material, Mesh, SurfaceFinish};
use spandrel_model::frames::{Enu, Frd, Vec3};
use spandrel_model::math;
use spandrel_model::vehicle::Vehicle;

const SHELL: SurfaceFinish = SurfaceFinish::new(Material::Enamel, [196, 196, 190]);
const ARM: SurfaceFinish = SurfaceFinish::new(Material::Enamel, [150, 150, 148]);
const DARK: SurfaceFinish = SurfaceFinish::new(Material::Rubber, [14, 14, 15]);
const LENS: SurfaceFinish = SurfaceFinish::new(Material::Glass, [4, 5, 9]);
const BLADE: SurfaceFinish = SurfaceFinish::new(Material::Enamel, [120, 120, 118]);
const CAGE: SurfaceFinish = SurfaceFinish::new(Material::Rubber, [24, 24, 26]);
const RED: SurfaceFinish = SurfaceFinish::new(Material::Enamel, [190, 16, 10]);

/// Converts body coordinates to mesh coordinates.
fn at(v: Vec3<Frd>) -> Vec3<Enu> {
    let [x, y, z] = v.array();
    Vec3::new(x, y, z)
}

/// Builds everything except the propellers.
pub fn body(vehicle: &Vehicle) -> Mesh {
    let mut mesh = Mesh::default();
    let [l, w, h] = vehicle.hull.body_half_extent_m;
    let thin = 0.09 * vehicle.rotor.radius_m.max(0.08);
    // Down is +z, so the block's top face is the belly, which is slightly tapered.
    mesh.block([-l, -w, -h], [l, w, 0.3 * h], [0.0; 3], SHELL);
    mesh.block([-l, -w, 0.3 * h], [l, w, h], [0.25 * l, 0.25 * l, 0.25 * w], SHELL);
    mesh.block([0.92 * l, -0.5 * w, -0.5 * h], [1.01 * l, 0.5 * w, 0.1 * h], [0.0; 3], DARK);
    for (k, rotor) in vehicle.rotors.iter().enumerate() {
        let hub = at(rotor.position_m);
        let root = Vec3::new(hub.east() * 0.25, hub.north() * 0.25, hub.up() + 0.6 * thin);
        let end = hub + Vec3::new(0.0, 0.0, 0.6 * thin);
        mesh.round((root, 1.3 * thin), (end, 0.9 * thin), 8, ARM);
        mesh.round((hub + Vec3::new(0.0, 0.0, 1.8 * thin), 1.5 * thin), (hub, 1.3 * thin), 10, DARK);
        // Red bands on the front arms mark the front.
        if hub.east() > 0.0 && k < 8 {
            let (a, b) = (root.lerp(end, 0.5), root.lerp(end, 0.65));
            mesh.round((a, 1.35 * thin), (b, 1.3 * thin), 8, RED);
        }
    }
    for foot in &vehicle.hull.feet_m {
        let foot = at(*foot);
        let hip = Vec3::new(foot.east() * 0.7, foot.north() * 0.7, 0.5 * h);
        mesh.round((hip, 0.5 * thin), (foot, 0.45 * thin), 6, SHELL);
        let other = Vec3::new(-foot.east(), foot.north(), foot.up());
        if foot.east() > 0.0 {
            mesh.round((foot, 0.45 * thin), (other, 0.45 * thin), 6, SHELL);
        }
    }
    let lens = at(vehicle.camera.position_m);
    mesh.ball(lens - Vec3::new(0.012, 0.0, 0.0), [0.03, 0.028, 0.028], 0.0, DARK);
    mesh.round((lens, 0.017), (lens + Vec3::new(0.02, 0.0, 0.0), 0.015), 12, LENS);
    if vehicle.hull.has_propeller_guard {
        cage(&mut mesh, 0.5 * vehicle.hull.tip_to_tip_m);
    }
    mesh
}

/// Adds the hoops of a spherical cage.
fn cage(mesh: &mut Mesh, radius: f64) {
    const STEPS: u32 = 24;
    let point = |turn: u32, hoop: u32| {
        let (s, c) = math::sin_cos(math::TAU * f64::from(turn) / f64::from(STEPS));
        let (hs, hc) = math::sin_cos(math::PI * f64::from(hoop) / 5.0);
        Vec3::new(radius * c * hc, radius * c * hs, radius * 0.8 * s)
    };
    for hoop in 0..5 {
        for turn in 0..STEPS {
            mesh.round((point(turn, hoop), 0.004), (point(turn + 1, hoop), 0.004), 5, CAGE);
        }
    }
    for (level, share) in [(0.0, 1.0), (0.45, 0.83), (-0.45, 0.83)] {
        let ring = |k: u32| {
            let (s, c) = math::sin_cos(math::TAU * f64::from(k) / f64::from(STEPS));
            Vec3::new(radius * share * c, radius * share * s, radius * level)
        };
        for k in 0..STEPS {
            mesh.round((ring(k), 0.004), (ring(k + 1), 0.004), 5, CAGE);
        }
    }
}

/// Builds a propeller with two twisted blades.
pub fn propeller(vehicle: &Vehicle) -> Mesh {
    let r = vehicle.rotor.radius_m;
    let mut mesh = Mesh::default();
    for side in [1.0, -1.0] {
        let chord = |share: f64| r * (0.055 + 0.12 * share * (1.0 - share) * 2.0) * side;
        let edge = |share: f64, ahead: f64| {
            let pitch = 0.35 * (1.0 - 0.6 * share) * chord(share);
            Vec3::new(side * share * r, ahead * chord(share), -0.012 - ahead * pitch.abs() * 0.5)
        };
        let shares = [0.08, 0.3, 0.55, 0.8, 0.99];
        for pair in shares.windows(2) {
            let corners = [edge(pair[0], -0.5), edge(pair[1], -0.5), edge(pair[1], 0.5), edge(pair[0], 0.5)];
            mesh.polygon(&corners, BLADE);
            let mut back = corners;
            back.reverse();
            mesh.polygon(&back, BLADE);
        }
    }
    mesh.round((Vec3::new(0.0, 0.0, 0.0), 0.1 * r), (Vec3::new(0.0, 0.0, -0.02), 0.07 * r), 10, DARK);
    mesh
}

/// Builds the disk of a fast-spinning propeller, visible from both sides.
pub fn propeller_disk(vehicle: &Vehicle) -> Mesh {
    const SIDES: u32 = 32;
    let mut mesh = Mesh::default();
    let ring: Vec<Vec3<Enu>> = (0..SIDES)
        .map(|k| {
            let (s, c) = math::sin_cos(math::TAU * f64::from(k) / f64::from(SIDES));
            Vec3::new(vehicle.rotor.radius_m * c, vehicle.rotor.radius_m * s, -0.012)
        })
        .collect();
    let finish = SurfaceFinish::new(Material::Blur, [120, 120, 120]);
    mesh.polygon(&ring, finish);
    mesh.polygon(&ring.iter().rev().copied().collect::<Vec<_>>(), finish);
    for v in &mut mesh.vertices {
        v.tint[3] = 26;
    }
    mesh
}
