//! State and inputs of the physics as plain data, without models.

use super::obstacles::MAX_OBJECT_SPEED_M_S;
use nalgebra::Vector3;
use spandrel_model::frames::{Enu, Frd, Ned, Rotation, Vec3};
use spandrel_model::math;
use spandrel_model::site::{ObjectId, Surface};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::SEA_LEVEL_AIR_DENSITY_KG_M3;

/// Maximum number of rotors.
pub const MAX_ROTORS: usize = 8;

/// True motion state of the aircraft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidState {
    /// Position of the center of mass, m, local NED.
    pub position_m: Vec3<Ned>,
    /// Velocity over ground, m/s.
    pub velocity_m_s: Vec3<Ned>,
    /// Attitude: body to NED.
    pub attitude: Rotation<Frd, Ned>,
    /// Angular velocity relative to the ground, rad/s, in body axes.
    pub rates_rad_s: Vec3<Frd>,
    /// Rotor speeds, rad/s.
    pub rotor_rad_s: [f64; MAX_ROTORS],
}

/// Actuator commands from the flight controller.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Actuators {
    /// Motor commands, 0 to 1 of the speed range (idle to maximum), in rotor order. Ignored while disarmed.
    pub motors: [f64; MAX_ROTORS],
    /// Whether the motors are armed.
    pub armed: bool,
}

/// The air around the aircraft, constant over one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AirState {
    /// Wind at the center of mass, m/s.
    pub velocity_m_s: Vec3<Ned>,
    /// Wind at each rotor minus the wind at the center of mass, m/s; `None` if they are equal.
    pub rotors_m_s: Option<[Vec3<Ned>; MAX_ROTORS]>,
    /// Air density, kg/m³.
    pub density_kg_m3: f64,
    /// External force at the center of mass, N (TASBID's wind model).
    pub force_n: Vec3<Ned>,
}

impl AirState {
    /// Still air at sea level.
    pub const STILL: Self =
        Self { velocity_m_s: Vec3::zero(), rotors_m_s: None, density_kg_m3: SEA_LEVEL_AIR_DENSITY_KG_M3, force_n: Vec3::zero() };

    /// Returns the density divided by the one at sea level, at which the coefficients of the rotors apply.
    #[must_use]
    pub fn density_ratio(&self) -> f64 {
        self.density_kg_m3 / SEA_LEVEL_AIR_DENSITY_KG_M3
    }
}

/// Battery model inputs for one step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PowerLoad {
    /// Whether the lamp is on.
    pub lamp_on: bool,
    /// Whether the vehicle has lifted off, which starts the `paper` battery model's clock.
    pub airborne: bool,
}

/// State of charge and terminal readings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BatteryState {
    /// State of charge, 0 to 1.
    pub charge: f64,
    /// Terminal voltage, V; 0 until the first step.
    pub voltage_v: f64,
    /// Current, A.
    pub current_a: f64,
    /// Energy drawn, J.
    pub energy_j: f64,
    /// Fraction of the maximum rotor speed available at the current voltage.
    pub speed_factor: f64,
    /// Failed cells that deliver no voltage, as a bit mask; bit 0 is the first cell.
    pub failed_cells: u16,
}

impl BatteryState {
    /// A fully charged pack.
    pub const FULL: Self =
        Self { charge: 1.0, voltage_v: 0.0, current_a: 0.0, energy_j: 0.0, speed_factor: 1.0, failed_cells: 0 };

    /// Returns true if the pack has no charge left.
    #[must_use]
    pub fn empty(&self) -> bool {
        self.charge <= 0.0
    }

    /// Returns true if the cell with this zero-based index has failed.
    #[must_use]
    pub fn cell_failed(&self, cell: usize) -> bool {
        cell < 16 && self.failed_cells & (1 << cell) != 0
    }

    /// Sets or clears the failure of one cell.
    pub fn fail_cell(&mut self, cell: usize, dead: bool) {
        let bit = if cell < 16 { 1 << cell } else { 0 };
        self.failed_cells = if dead { self.failed_cells | bit } else { self.failed_cells & !bit };
    }

    /// Returns the number of working cells in a pack of `cells` cells.
    #[must_use]
    pub fn working_cells(&self, cells: u32) -> u32 {
        cells.saturating_sub(self.failed_cells.count_ones())
    }

    /// Returns the remaining charge in %.
    #[must_use]
    pub fn remaining_pct(&self) -> f64 {
        self.charge * 100.0
    }
}

/// Contacts of one step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContactReport {
    /// The most severe surface in contact and its object.
    pub surface: Option<(Surface, ObjectId)>,
    /// Largest approach speed stopped in this step, m/s.
    pub impact_m_s: f64,
    /// Sum of normal forces, N.
    pub normal_force_n: f64,
}

impl ContactReport {
    /// Returns true if any surface is in contact.
    #[must_use]
    pub fn touching(&self) -> bool {
        self.surface.is_some()
    }
}

/// Impulses of the last step, used as the initial guess.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct WarmStart {
    pub(super) impulses: Vec<(ContactKey, Vector3<f64>)>,
}

/// Probe index, object ID and the number of earlier contacts between the two in this step.
pub(super) type ContactKey = (usize, u32, usize);

/// Complete physical state. It is plain data, so a clone is a snapshot.
#[derive(Debug, Clone, PartialEq)]
pub struct PhysicsState {
    /// Rigid body and rotors.
    pub rigid: RigidState,
    /// Battery state.
    pub battery: BatteryState,
    /// Specific force of the last step, m/s²: non-gravitational force per unit mass, as measured by an accelerometer.
    pub specific_force_m_s2: Vec3<Frd>,
    /// Contacts of the last step.
    pub contact: ContactReport,
    /// Change of the velocity by contacts with other vehicles since the last step, m/s, which the accelerometer measures in the next.
    pub(super) pushed_m_s: Vec3<Ned>,
    pub(super) initial_guess: WarmStart,
    pub(super) effect: [f64; MAX_ROTORS],
    /// Force of walls as a fraction of the thrust.
    pub(super) wall_pull: Vec3<Ned>,
    pub(super) effect_due: SimTime,
    pub(super) clear_sphere: ClearSphere,
}

/// A sphere that was free of obstacles at a known time. For a while after that, contacts well inside the sphere are
/// impossible.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ClearSphere {
    pub(super) center_m: Vec3<Enu>,
    pub(super) radius_m: f64,
    pub(super) since: SimTime,
}

impl ClearSphere {
    /// Returns the radius around `position_m`, in meters, that is guaranteed to be free of obstacles now.
    pub(super) fn remaining_radius_m(&self, position_m: Vec3<Enu>, now: SimTime) -> f64 {
        self.radius_m - (position_m - self.center_m).norm() - MAX_OBJECT_SPEED_M_S * (now - self.since).s()
    }
}

impl PhysicsState {
    /// Returns the state at rest at a position and heading, with the motors off and a full battery.
    #[must_use]
    pub fn at_rest(position_m: Vec3<Ned>, yaw_rad: f64) -> Self {
        Self {
            rigid: RigidState {
                position_m,
                velocity_m_s: Vec3::zero(),
                attitude: Rotation::from_euler(0.0, 0.0, yaw_rad),
                rates_rad_s: Vec3::zero(),
                rotor_rad_s: [0.0; MAX_ROTORS],
            },
            battery: BatteryState::FULL,
            specific_force_m_s2: Vec3::new(0.0, 0.0, -math::GRAVITY_M_S2),
            contact: ContactReport::default(),
            pushed_m_s: Vec3::zero(),
            initial_guess: WarmStart::default(),
            effect: [1.0; MAX_ROTORS],
            wall_pull: Vec3::zero(),
            effect_due: SimTime::ZERO,
            clear_sphere: ClearSphere { center_m: Vec3::zero(), radius_m: -1.0, since: SimTime::ZERO },
        }
    }

    /// Puts the aircraft and its battery back into an earlier state. Failed battery cells stay failed.
    pub fn restore(&mut self, earlier: &Self) {
        let fresh = Self::at_rest(earlier.rigid.position_m, 0.0);
        let battery = BatteryState { failed_cells: self.battery.failed_cells, ..earlier.battery };
        // What the earlier state knows about obstacles may be out of date.
        *self = Self { battery, effect_due: fresh.effect_due, clear_sphere: fresh.clear_sphere, ..earlier.clone() };
    }

    /// Moves the aircraft to a position, level and at rest. The rotor speeds do not change.
    pub fn place(&mut self, position_m: Vec3<Ned>, yaw_rad: f64) {
        let fresh = Self::at_rest(position_m, yaw_rad);
        let rotor_rad_s = self.rigid.rotor_rad_s;
        self.rigid = RigidState { rotor_rad_s, ..fresh.rigid };
        self.clear_sphere = fresh.clear_sphere;
        self.initial_guess = fresh.initial_guess;
        self.contact = fresh.contact;
        self.pushed_m_s = fresh.pushed_m_s;
    }
}
