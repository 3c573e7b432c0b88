//! Forces and torques of the rotors, four rotors at a time. Each lane computes what one rotor alone would, in the same order, so that
//! the results have the same bits.

use super::inflow::Inflow;
use super::state::MAX_ROTORS;
use nalgebra::{Matrix3, Vector3};
use spandrel_model::frames::{Frd, Ned, Vec3};
use spandrel_model::vehicle::{Rotor, RotorModel};
use wide::f64x4;

/// Number of rotors that are computed together.
pub(super) const LANES: usize = 4;
/// Number of groups that hold all rotors.
pub(super) const GROUPS: usize = MAX_ROTORS.div_ceil(LANES);

/// A vector for each rotor of a group.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LaneVectors {
    x: f64x4,
    y: f64x4,
    z: f64x4,
}

/// Returns the values of a group's rotors.
#[inline]
fn lanes(values: &[f64; MAX_ROTORS], group: usize) -> f64x4 {
    f64x4::from(values.as_chunks::<LANES>().0[group])
}

impl LaneVectors {
    /// Collects the vectors of a group's rotors.
    #[inline]
    fn of(vectors: &[Vector3<f64>; MAX_ROTORS], group: usize) -> Self {
        let four = &vectors.as_chunks::<LANES>().0[group];
        let axis = |k: usize| f64x4::from([four[0][k], four[1][k], four[2][k], four[3][k]]);
        Self { x: axis(0), y: axis(1), z: axis(2) }
    }

    /// Returns the same vector for each rotor.
    #[inline]
    pub(super) fn splat(v: Vector3<f64>) -> Self {
        Self { x: f64x4::splat(v.x), y: f64x4::splat(v.y), z: f64x4::splat(v.z) }
    }

    #[inline]
    fn cross(&self, other: &Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }

    #[inline]
    fn plus(&self, other: &Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }

    #[inline]
    fn minus(&self, other: &Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }

    #[inline]
    fn turned_by(&self, m: &Matrix3<f64>) -> Self {
        let row =
            |k: usize| f64x4::splat(m[(k, 0)]) * self.x + f64x4::splat(m[(k, 1)]) * self.y + f64x4::splat(m[(k, 2)]) * self.z;
        Self { x: row(0), y: row(1), z: row(2) }
    }

    /// Returns the vectors of the first rotors.
    #[inline]
    fn arrays(self, count: usize) -> impl Iterator<Item = Vector3<f64>> {
        let (x, y, z) = (self.x.to_array(), self.y.to_array(), self.z.to_array());
        (0..count).map(move |k| Vector3::new(x[k], y[k], z[k]))
    }
}

/// Constants of the rotors of one group.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RotorGroup {
    position_m: LaneVectors,
    spin: f64x4,
    count: usize,
}

impl RotorGroup {
    /// Returns the groups of an aircraft's rotors.
    pub(super) fn all(rotors: &[Rotor]) -> Vec<Self> {
        let (mut positions, mut spins) = ([Vector3::zeros(); MAX_ROTORS], [0.0; MAX_ROTORS]);
        for (k, rotor) in rotors.iter().enumerate().take(MAX_ROTORS) {
            (positions[k], spins[k]) = (rotor.position_m.raw(), rotor.spin);
        }
        let group = |k: usize| Self {
            position_m: LaneVectors::of(&positions, k),
            spin: lanes(&spins, k),
            count: (rotors.len() - k * LANES).min(LANES),
        };
        (0..rotors.len().div_ceil(LANES).min(GROUPS)).map(group).collect()
    }

    /// Returns the velocities of the hubs relative to the air, from that of the center of mass, m/s.
    #[inline]
    pub(super) fn hub_velocities(&self, air_velocity_m_s: Vec3<Frd>, rates_rad_s: Vec3<Frd>) -> LaneVectors {
        let turning = LaneVectors::splat(rates_rad_s.raw()).cross(&self.position_m);
        LaneVectors::splat(air_velocity_m_s.raw()).plus(&turning)
    }

    /// Returns the forces and torques about the center of mass of the group's rotors, N and N m.
    #[inline]
    pub(super) fn wrenches(
        &self,
        load: &RotorLoad,
        hub_air_m_s: &LaneVectors,
        density_ratio: f64,
    ) -> impl Iterator<Item = (Vector3<f64>, Vector3<f64>)> + use<> {
        let thrust_n = load.thrust_n(hub_air_m_s) * f64x4::splat(density_ratio);
        let force_n = LaneVectors { x: load.drag_n_s_m * hub_air_m_s.x, y: load.drag_n_s_m * hub_air_m_s.y, z: -thrust_n };
        let yaw_n_m = LaneVectors { x: f64x4::ZERO, y: f64x4::ZERO, z: load.yaw_n_m };
        let torque_n_m = self.position_m.cross(&force_n).plus(&yaw_n_m);
        force_n.arrays(self.count).zip(torque_n_m.arrays(self.count))
    }
}

/// Winds at all rotors minus the wind at the center of mass, m/s.
#[derive(Debug, Clone, Copy)]
pub(super) struct AddedWinds([LaneVectors; GROUPS]);

impl AddedWinds {
    /// Collects the winds at all rotors.
    #[inline]
    pub(super) fn of(winds_m_s: &[Vec3<Ned>; MAX_ROTORS]) -> Self {
        let raw = winds_m_s.map(Vec3::raw);
        Self(std::array::from_fn(|group| LaneVectors::of(&raw, group)))
    }

    /// Returns the velocities of a group's hubs relative to this air. The matrix turns NED into body axes.
    #[inline]
    pub(super) fn subtract_from(&self, group: usize, hub_air_m_s: &LaneVectors, to_body: &Matrix3<f64>) -> LaneVectors {
        hub_air_m_s.minus(&self.0[group].turned_by(to_body))
    }
}

/// Rotor speeds and conditions of one group that determine its forces, apart from the velocity through the air.
#[derive(Debug, Clone, Copy)]
pub(super) struct RotorConditionLanes {
    pub(super) speed_rad_s: f64x4,
    pub(super) acceleration_rad_s2: f64x4,
    pub(super) effect: f64x4,
}

impl RotorConditionLanes {
    /// Collects the conditions of a group.
    #[inline]
    pub(super) fn of(
        speed: &[f64; MAX_ROTORS],
        acceleration: &[f64; MAX_ROTORS],
        effect: &[f64; MAX_ROTORS],
        group: usize,
    ) -> Self {
        Self { speed_rad_s: lanes(speed, group), acceleration_rad_s2: lanes(acceleration, group), effect: lanes(effect, group) }
    }
}

/// Terms of the forces of one group that depend only on the rotor speeds. One Runge-Kutta step uses them up to twice.
#[derive(Debug, Clone, Copy)]
pub(super) struct RotorLoad {
    static_n: f64x4,
    axial_n_s_m: f64x4,
    max_inflow_n: f64x4,
    max_lift_n: f64x4,
    edgewise_n_s2_m2: f64x4,
    drag_n_s_m: f64x4,
    yaw_n_m: f64x4,
}

impl RotorLoad {
    /// Rotors that do not exist.
    pub(super) const NONE: Self = Self {
        static_n: f64x4::ZERO,
        axial_n_s_m: f64x4::ZERO,
        max_inflow_n: f64x4::ZERO,
        max_lift_n: f64x4::ZERO,
        edgewise_n_s2_m2: f64x4::ZERO,
        drag_n_s_m: f64x4::ZERO,
        yaw_n_m: f64x4::ZERO,
    };

    /// Returns the terms for a group's conditions and the density of the air divided by the one at sea level.
    #[inline]
    pub(super) fn new(
        rotor: &RotorModel,
        inflow: &Inflow,
        group: &RotorGroup,
        at: &RotorConditionLanes,
        density_ratio: f64,
    ) -> Self {
        let splat = f64x4::splat;
        let density_ratio = splat(density_ratio);
        let squared = at.speed_rad_s * at.speed_rad_s;
        let static_n = splat(rotor.thrust_coefficient_n_s2) * squared * at.effect;
        let torque_n_m = splat(rotor.torque_coefficient_n_m_s2) * squared * density_ratio;
        let reaction_n_m = splat(rotor.inertia_kg_m2) * at.acceleration_rad_s2;
        let [max_inflow_n, max_lift_n] = inflow.limits().map(|limit| splat(limit) * static_n);
        Self {
            static_n,
            axial_n_s_m: splat(inflow.axial_n_s2_m()) * at.speed_rad_s,
            max_inflow_n,
            max_lift_n,
            edgewise_n_s2_m2: splat(inflow.edgewise_n_s2_m2()),
            drag_n_s_m: splat(-rotor.drag_coefficient_n_s2_m) * at.speed_rad_s * density_ratio,
            yaw_n_m: group.spin * (torque_n_m + reaction_n_m),
        }
    }

    /// Returns the thrusts at sea-level density, N.
    #[inline]
    fn thrust_n(&self, hub_air_m_s: &LaneVectors) -> f64x4 {
        // A climb through the air is a negative velocity along the body's down axis.
        let axial_n = self.axial_n_s_m * hub_air_m_s.z;
        let squared = hub_air_m_s.x * hub_air_m_s.x + hub_air_m_s.y * hub_air_m_s.y;
        let edgewise_n = self.edgewise_n_s2_m2 * squared;
        let inflow_n = axial_n.fast_max(-self.max_inflow_n).fast_min(self.max_inflow_n);
        self.static_n + (inflow_n + edgewise_n.fast_min(self.max_lift_n))
    }
}
